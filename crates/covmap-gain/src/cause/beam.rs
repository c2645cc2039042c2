//! What is the same of a beam from all view-points.

use crate::numbers::to_f32;
use crate::{BeamStencil, Stencil};
use covmap_model::{CauseParameters, Outcome, gaussian};

/// A cell of a beam.
#[derive(Debug, Clone, Copy)]
pub(super) struct CauseCell {
    /// Columns and rows from the view-point.
    pub(super) dx: isize,
    pub(super) dy: isize,
    /// From the view-point in the bordered rasters.
    pub(super) offset: isize,
    /// m.
    pub(super) bearing: usize,
    /// f(d^l, θ).
    pub(super) free: f32,
}

/// How an echo from one range divides the beam's cells, which are in order of their distance.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    /// The first so many cells are in front of the end,
    pub(super) front: usize,
    /// up to here it may lie in them,
    pub(super) ended: usize,
    /// up to here they may have caused it,
    pub(super) near: usize,
    /// and up to here they are behind it.
    pub(super) reach: usize,
    /// Where those from `front` on begin among the beam's `near`.
    pub(super) first: usize,
}

/// A cell as an echo may have ended in it.
#[derive(Debug, Clone)]
pub(super) struct NearEnd {
    /// w(δ)^p.
    pub(super) nearness: f32,
    /// f(d^l, θ) if the cell's centre is before the end, else 0.
    pub(super) free: f32,
    /// N(μ, σ) of every bin; none of a cell that is behind the end.
    pub(super) ended: Vec<f32>,
}

/// A beam from any view-point.
#[derive(Debug, Clone)]
pub(super) struct CauseBeam {
    pub(super) cells: Vec<CauseCell>,
    /// By the outcome's index.
    pub(super) ends: Vec<End>,
    pub(super) near: Vec<NearEnd>,
    /// The first so many cells are passed if there is no echo.
    pub(super) no_echo: usize,
    /// b.
    pub(super) behind_weight: f32,
}

impl CauseBeam {
    pub(super) fn new(
        (parameters, resolution, bins): (&CauseParameters, f64, usize),
        beam: &BeamStencil,
        stencil: &Stencil,
        raster_width: usize,
    ) -> Self {
        let width = raster_width.cast_signed();
        let cell = |c: &crate::StencilCell| CauseCell {
            dx: c.dx as isize,
            dy: c.dy as isize,
            offset: c.dy as isize * width + c.dx as isize,
            bearing: parameters.bearing(c.across),
            free: to_f32(parameters.passed(c.met())),
        };
        let mut all_near = Vec::new();
        let end = |(k, range): (usize, &f64)| {
            let delta = |c: &crate::StencilCell| c.cell_distance - range;
            let nearness = |c: &crate::StencilCell| parameters.nearness(resolution, delta(c));
            let up_to = |is_before: &dyn Fn(&crate::StencilCell) -> bool| {
                beam.cells.partition_point(|c| is_before(c))
            };
            let front = up_to(&|c| delta(c) < 0.0 && nearness(c) <= 0.0);
            let ended = up_to(&|c| delta(c) <= 0.5 * resolution);
            let near = up_to(&|c| delta(c) < 0.0 || nearness(c) > 0.0);
            let first = all_near.len();
            for (i, c) in beam.cells.iter().enumerate().take(near).skip(front) {
                let role = parameters.role(resolution, c.met(), Outcome::Echo(*range));
                let mut ended_in = vec![0.0; if i < ended { bins } else { 0 }];
                if i < ended {
                    gaussian(role.mu, role.sigma, &mut ended_in);
                }
                all_near.push(NearEnd {
                    nearness: to_f32(libm::pow(nearness(c), parameters.sharpness)),
                    free: to_f32(role.free),
                    ended: ended_in.into_iter().map(to_f32).collect(),
                });
            }
            End { front, ended, near, reach: beam.echo_reach[k], first }
        };
        Self {
            ends: stencil.ranges.iter().enumerate().map(end).collect(),
            cells: beam.cells.iter().map(cell).collect(),
            near: all_near,
            no_echo: beam.no_echo_reach,
            behind_weight: to_f32(parameters.behind_weight),
        }
    }
}
