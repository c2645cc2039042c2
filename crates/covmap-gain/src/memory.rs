//! Estimates of the memory of a cache, before it takes any.

use crate::Upkeep;
use crate::numbers::PAD;
use crate::numbers::as_f64;
use covmap::Grid;
use covmap::lanes::LANES;
use covmap_model::SensorModel;

/// Counts on which the memory of a cache depends. They are f64, because those of absurd inputs are
/// larger than integers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Size {
    /// Columns and rows of the grid.
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) bins: f64,
    /// Largest distance of the cells of a stencil from its view-point, in cells.
    pub(crate) border: f64,
    pub(crate) beams: f64,
    /// The cells of all beams of a stencil.
    pub(crate) stencil: f64,
    /// The cells of all beams at one distance: the number of different distances, but for the
    /// symmetry of a ring of sensors that looks the same after a quarter turn.
    pub(crate) cells_per_ring: f64,
    /// The number of ranges.
    pub(crate) ranges: f64,
    pub(crate) upkeep: Upkeep,
}

impl Size {
    pub(crate) fn new(model: &SensorModel, grid: &Grid, upkeep: Upkeep) -> Self {
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
            cells_per_ring: stencil / ranges,
            ranges,
            upkeep,
        }
    }

    /// Returns the number of groups of neighbouring view-points, or blocks of cells.
    pub(crate) fn blocks(&self) -> f64 {
        (self.width / as_f64(LANES)).ceil() * self.height
    }

    /// Returns the number of cells in rows with a padding.
    pub(crate) fn padded(&self) -> f64 {
        (self.width + as_f64(LANES) + 2.0 * as_f64(PAD)) * self.height
    }

    /// Returns the number of cells in a raster with a border.
    pub(crate) fn bordered(&self) -> f64 {
        (self.width + 2.0 * self.border) * (self.height + 2.0 * self.border)
    }
}

/// Converts a number of bytes.
pub(crate) fn whole(bytes: f64) -> u64 {
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    let bytes = bytes as u64;
    bytes
}
