//! The parts of a beam that are the same from all view-points.

use super::ceilings::Bands;
use super::ends::{AtEnd, Kernel};
use crate::numbers::to_f32;
use crate::{BeamStencil, Stencil};
use covmap_model::{CauseParameters, Outcome};

/// A cell of a beam.
#[derive(Debug, Clone, Copy)]
pub(super) struct CauseCell {
    /// Columns and rows from the view-point.
    pub(super) dx: isize,
    pub(super) dy: isize,
    /// Offset from the view-point in the bordered rasters.
    pub(super) offset: isize,
    /// m.
    pub(super) bearing: usize,
    /// d^l \[m\].
    pub(super) distance: f32,
    /// f(d^l, θ).
    pub(super) free: f32,
}

/// Division of the beam's cells, in order of their distance, by an echo from one range.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    /// The number of cells in front of the end, the first ones.
    pub(super) front: usize,
    /// End of the cells in which the echo may have ended.
    pub(super) ended: usize,
    /// End of the cells behind the end of the echo.
    pub(super) reach: usize,
    /// Start of those from `front` on among the beam's `near`.
    pub(super) first: usize,
    /// Start and end of those that may have caused the echo among the beam's `surfaces`.
    pub(super) surfaces: (usize, usize),
}

/// A cell in which an echo may have ended.
#[derive(Debug, Clone)]
pub(super) struct NearEnd {
    /// f(d^l, θ) if the cell's centre is before the end, else 0.
    pub(super) free: f32,
    /// N(μ, σ) of every bin.
    pub(super) ended: Vec<f32>,
    /// Band of σ in the ceilings.
    pub(super) band: usize,
    /// A bit for every bin with much evidence: [`Kernel::large`].
    pub(super) large: u64,
}

impl NearEnd {
    /// Returns the evidence of the echo about it.
    pub(super) fn kernel(&self) -> Kernel<'_> {
        Kernel { ended: &self.ended, weight: 1.0, free: self.free, large: self.large }
    }
}

/// A cell that may have caused an echo.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    /// m.
    pub(super) bearing: usize,
    /// From the view-point in the bordered rasters.
    pub(super) offset: isize,
    /// w(δ)^p.
    pub(super) nearness: f32,
}

/// A beam from any view-point.
#[derive(Debug, Clone)]
pub(super) struct CauseBeam {
    pub(super) cells: Vec<CauseCell>,
    /// By the outcome's index.
    pub(super) ends: Vec<End>,
    pub(super) near: Vec<NearEnd>,
    /// For each end, by their bearing.
    pub(super) surfaces: Vec<Surface>,
    /// The number of cells, the first ones, that are passed if there is no echo.
    pub(super) no_echo: usize,
    /// b.
    pub(super) behind_weight: f32,
}

impl CauseBeam {
    pub(super) fn new(
        (parameters, resolution, at_end): (&CauseParameters, f64, &AtEnd),
        (bands, beam, stencil): (&Bands, &BeamStencil, &Stencil),
        raster_width: usize,
    ) -> Self {
        let width = raster_width.cast_signed();
        let cell = |c: &crate::StencilCell| CauseCell {
            dx: c.dx as isize,
            dy: c.dy as isize,
            offset: c.dy as isize * width + c.dx as isize,
            bearing: parameters.bearing(c.across),
            distance: to_f32(c.cell_distance),
            free: to_f32(parameters.passed(c.met())),
        };
        let cells: Vec<CauseCell> = beam.cells.iter().map(cell).collect();
        let (mut all_near, mut all_surfaces) = (Vec::new(), Vec::new());
        let end = |(k, range): (usize, &f64)| {
            let delta = |c: &crate::StencilCell| c.cell_distance - range;
            let nearness = |c: &crate::StencilCell| parameters.nearness(resolution, delta(c));
            let up_to = |is_before: &dyn Fn(&crate::StencilCell) -> bool| {
                beam.cells.partition_point(|c| is_before(c))
            };
            let front = up_to(&|c| delta(c) < 0.0 && nearness(c) <= 0.0);
            let ended = up_to(&|c| delta(c) <= 0.5 * resolution);
            let near = up_to(&|c| delta(c) < 0.0 || nearness(c) > 0.0);
            let (first, first_surface) = (all_near.len(), all_surfaces.len());
            for c in &beam.cells[front..ended.max(front)] {
                let role = parameters.role(resolution, c.met(), Outcome::Echo(*range));
                let (free, band) = (to_f32(role.free), bands.of(role.sigma));
                let ended = at_end.kernel(role.mu, role.sigma);
                let large = at_end.large(&ended, free);
                all_near.push(NearEnd { free, ended, band, large });
            }
            for (c, cell) in beam.cells.iter().zip(&cells).take(near).skip(front) {
                let nearness = to_f32(libm::pow(nearness(c), parameters.sharpness));
                let CauseCell { bearing, offset, .. } = *cell;
                all_surfaces.push(Surface { bearing, offset, nearness });
            }
            all_surfaces[first_surface..].sort_by_key(|surface| surface.bearing);
            let surfaces = (first_surface, all_surfaces.len());
            End { front, ended, reach: beam.echo_reach[k], first, surfaces }
        };
        let ends = stencil.ranges.iter().enumerate().map(end).collect();
        Self {
            ends,
            cells,
            near: all_near,
            surfaces: all_surfaces,
            no_echo: beam.no_echo_reach,
            behind_weight: to_f32(parameters.behind_weight),
        }
    }
}
