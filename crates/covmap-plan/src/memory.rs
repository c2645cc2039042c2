//! How much memory a planner will take, before it takes any.

use crate::PlannerParameters;
use crate::beam_cache::BeamCache;
use crate::cells::Cells;
use crate::look_ahead::as_f64;
use covmap::lanes::LANES;
use covmap::{CoverageMap, Grid};
use covmap_model::SensorModel;

/// What the memory of a planner depends on: counts, as f64, because those of absurd inputs are
/// larger than integers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Size {
    /// Columns and rows of the grid.
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) bins: f64,
    /// How far the cells of a stencil lie from its view-point, in cells.
    pub(crate) border: f64,
    pub(crate) beams: f64,
    /// The cells of all beams of a stencil.
    pub(crate) stencil: f64,
    /// The cells of all beams at one distance: so many distances are told apart, but for the
    /// symmetry of a ring that looks the same after a quarter turn.
    pub(crate) ring: f64,
    /// How many ranges there are.
    pub(crate) ranges: f64,
    pub(crate) uses_gain: bool,
}

impl Size {
    fn new(parameters: &PlannerParameters, model: &SensorModel, grid: &Grid) -> Self {
        let (footprint, reach) = (model.footprint(), model.max_reach());
        let (r, beams) = (model.resolution(), footprint.beams());
        let stencil: f64 = (0..beams).map(|beam| footprint.cells_about(beam, reach, r)).sum();
        let ranges = reach / r + 1.0;
        let [width, height, bins, beams] =
            [grid.width(), grid.height(), model.parameters().bins, beams].map(as_f64);
        Self {
            width,
            height,
            bins,
            border: footprint.farthest(reach) / r + 1.0,
            beams,
            stencil,
            ring: stencil / ranges,
            ranges,
            uses_gain: parameters.strategy.uses_gain(),
        }
    }

    /// How many cells the grid has.
    pub(crate) fn cells(&self) -> f64 {
        self.width * self.height
    }

    /// How many groups of neighbouring view-points, or blocks of cells.
    pub(crate) fn blocks(&self) -> f64 {
        (self.width / as_f64(LANES)).ceil() * self.height
    }

    /// How many cells a raster with a border has.
    pub(crate) fn bordered(&self) -> f64 {
        (self.width + 2.0 * self.border) * (self.height + 2.0 * self.border)
    }
}

/// About how many bytes a [`Planner`](crate::Planner) on a grid takes at most while it is made and
/// decides: an estimate, mostly too large, to be asked for before there is one.
pub fn planner_bytes(parameters: &PlannerParameters, model: &SensorModel, grid: &Grid) -> u64 {
    let size = Size::new(parameters, model, grid);
    // Ways and costs, what is explored, where it can stand, where it measured.
    const BY_CELL: f64 = 80.0;
    // A stencil's cell with its weight, and as a cone's: capacities grow by doubling.
    const BY_STENCIL_CELL: f64 = 100.0;
    // An unknown map, to begin with.
    let unknown = CoverageMap::bytes(grid, model.parameters().bins);
    let own = BY_CELL * size.cells() + BY_STENCIL_CELL * size.stencil;
    whole(own + Cells::bytes(&size) + BeamCache::bytes(&size)).saturating_add(unknown)
}

/// A number of bytes.
fn whole(bytes: f64) -> u64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let bytes = bytes as u64;
    bytes
}
