//! What the planner keeps of the map, laid out for the beams of many view-points.

use crate::{PlannerParameters, Stencil};
use covmap::{Cell, CoverageMap, Grid, MAX_BINS, bin_coverage};

/// The planner's copy of the map.
///
/// Codes and limits have a border as wide as the stencil, so that a stencil's cell is at a
/// constant offset from every view-point, inside the grid or not.
#[derive(Debug, Clone)]
pub(crate) struct Cells {
    grid: Grid,
    bins: usize,
    border: usize,
    /// Bordered: the bin of the mode, or one of the three codes past all bins.
    codes: Vec<u8>,
    /// Bordered: the distance up to which the cell is a reason to measure; 0 if it is none.
    limits: Vec<f32>,
    /// ρ by code.
    reflections: Vec<f64>,
    /// For each cell of the grid h_1 … h_n, then h_1·log h_1 … h_n·log h_n.
    rows: Vec<f32>,
    entropies: Vec<f32>,
}

/// Codes past the last bin.
const UNKNOWN: usize = 0;
const PINNED: usize = 1;
const OUTSIDE: usize = 2;

/// Where a beam's cells lie from a view-point, in the planner's layout.
#[derive(Debug, Clone)]
pub(crate) struct Offsets {
    /// In the bordered rasters.
    pub(crate) bordered: Vec<isize>,
    /// In the grid.
    pub(crate) plain: Vec<isize>,
    /// d^l [m].
    pub(crate) distance: Vec<f32>,
}

impl Cells {
    pub(crate) fn new(
        grid: Grid,
        bins: usize,
        stencil: &Stencil,
        parameters: &PlannerParameters,
    ) -> Self {
        let border = usize::try_from(stencil.radius).unwrap_or(0);
        let bordered = (grid.width() + 2 * border) * (grid.height() + 2 * border);
        let mut reflections: Vec<f64> = (0..bins).map(|k| bin_coverage(k, bins)).collect();
        reflections.extend([parameters.unknown_reflection, 0.0, 0.0]);
        #[allow(clippy::cast_possible_truncation, reason = "at most 67 codes")]
        let outside = (bins + OUTSIDE) as u8;
        let mut cells = Self {
            grid,
            bins,
            border,
            codes: vec![outside; bordered],
            limits: vec![0.0; bordered],
            reflections,
            rows: vec![0.0; grid.len() * 2 * bins],
            entropies: vec![0.0; grid.len()],
        };
        if let Ok(unknown) = CoverageMap::new(grid, bins) {
            grid.cells().for_each(|cell| {
                cells.update(&unknown, cell);
            });
        }
        cells
    }

    pub(crate) fn offsets(&self, stencil: &Stencil) -> Vec<Offsets> {
        let beam = |beam: &crate::BeamStencil| {
            let offset = |width: usize| {
                let width = isize::try_from(width).unwrap_or(0);
                beam.cells.iter().map(move |c| c.dy as isize * width + c.dx as isize).collect()
            };
            #[allow(clippy::cast_possible_truncation, reason = "limits are f32")]
            let distance = beam.cells.iter().map(|c| c.cell_distance as f32).collect();
            Offsets {
                bordered: offset(self.grid.width() + 2 * self.border),
                plain: offset(self.grid.width()),
                distance,
            }
        };
        stencil.beams.iter().map(beam).collect()
    }

    /// The place of a cell in the bordered rasters, by its row-major index.
    #[inline(always)]
    pub(crate) fn bordered(&self, index: usize) -> usize {
        let (x, y) = (index % self.grid.width(), index / self.grid.width());
        (y + self.border) * (self.grid.width() + 2 * self.border) + x + self.border
    }

    /// Takes over a cell's posterior. Returns whether what it reflects, or whether it can
    /// change at all, is different now.
    pub(crate) fn update(&mut self, map: &CoverageMap, cell: Cell) -> bool {
        let Some(index) = self.grid.index(cell) else { return false };
        let mut posterior = [0.0; MAX_BINS];
        let posterior = &mut posterior[..self.bins];
        map.read_posterior(cell, posterior);
        let (h, u) =
            self.rows[2 * self.bins * index..2 * self.bins * (index + 1)].split_at_mut(self.bins);
        for ((h, u), p) in h.iter_mut().zip(u).zip(posterior.iter()) {
            #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
            ((*h, *u) = (*p as f32, (p * libm::log(*p)) as f32));
        }
        #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
        (self.entropies[index] = map.entropy(cell) as f32);
        let code = if map.is_pinned(cell) {
            self.bins + PINNED
        } else if map.is_known(cell) {
            self.reflections[..self.bins].partition_point(|c| *c < map.mode(cell))
        } else {
            self.bins + UNKNOWN
        };
        let bordered = self.bordered(index);
        #[allow(clippy::cast_possible_truncation, reason = "at most 67 codes")]
        let old = std::mem::replace(&mut self.codes[bordered], code as u8);
        usize::from(old) != code
    }

    /// ρ of the cell at a place in the bordered rasters.
    #[inline(always)]
    pub(crate) fn reflection(&self, bordered: usize) -> f64 {
        self.reflections[usize::from(self.codes[bordered])]
    }

    /// Whether a measurement can change the cell at a place in the bordered rasters.
    #[inline(always)]
    pub(crate) fn is_changeable(&self, bordered: usize) -> bool {
        usize::from(self.codes[bordered]) <= self.bins + UNKNOWN
    }

    /// Whether the cell at a place in the bordered rasters is a reason to measure from so far
    /// away \[m\].
    #[inline(always)]
    pub(crate) fn is_reason(&self, bordered: usize, distance: f32) -> bool {
        distance <= self.limits[bordered]
    }

    /// Sets a cell's limit; returns whether it is another one now.
    pub(crate) fn set_limit(&mut self, index: usize, limit: f32) -> bool {
        let bordered = self.bordered(index);
        let old = std::mem::replace(&mut self.limits[bordered], limit);
        old.to_bits() != limit.to_bits()
    }

    /// h and h·log h of a cell by its row-major index.
    #[inline(always)]
    pub(crate) fn row(&self, index: usize) -> (&[f32], &[f32]) {
        self.rows[2 * self.bins * index..2 * self.bins * (index + 1)].split_at(self.bins)
    }

    /// A cell's entropy by its row-major index \[nats\].
    #[inline(always)]
    pub(crate) fn entropy(&self, index: usize) -> f32 {
        self.entropies[index]
    }

    pub(crate) fn bins(&self) -> usize {
        self.bins
    }
}
