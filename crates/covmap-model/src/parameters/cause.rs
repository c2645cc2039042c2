//! The parameters of the update by cause.

use super::{Linear, ModelError};
use serde::{Deserialize, Serialize};

/// What it says of a cell that sound passed through it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeSpace {
    /// f_0: the share of "free" at the sensor and on the beam's axis, at most 1.
    pub share: f64,
    /// d_f: where 1/e of it is left, on the axis \[m\]. Far away the cone is wide.
    pub range: f64,
    /// How fast it falls with the bearing: the standard deviation, in half-widths of the beam.
    pub width: f64,
    /// σ of "free".
    pub sigma: f64,
}

/// What a beam without an echo says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoEchoShare {
    /// Cells up to this distance were passed \[m\]; 0 ignores such beams.
    pub range: f64,
    /// How surely: a smooth wall does not answer either.
    pub share: f64,
}

/// How much readings from one place repeat each other; [`Looks`](crate::Looks) has the equations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeats {
    /// ρ_0: the probability that a second reading from the same place repeats the first.
    pub share: f64,
    /// λ: how far one must move \[m\] until ρ has fallen to .61 of that.
    pub distance: f64,
    /// ψ: the same for the angle between two axes \[rad\].
    pub bearing: f64,
}

/// The parameters of the update by cause; [`Causes`](crate::Causes) has the equations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CauseParameters {
    /// M: into how many bearings a beam is divided.
    pub bearings: usize,
    /// τ: how far from a cell's border an echo may come from it \[m\].
    pub range_tolerance: f64,
    /// ℓ/r: how deep a cell is along a beam, in sides of a cell: 1 along the axes of the grid,
    /// 4/π on average over all directions.
    pub cell_depth: f64,
    /// Expected coverage of a cell that no reading has touched.
    pub unknown_coverage: f64,
    /// p: exponent on the expected coverage of what may have answered.
    pub sharpness: f64,
    /// a_0: how much chance competes with the surfaces; one that is certain counts 1.
    pub chance: f64,
    /// κ: exponent on the view that was clear; the nearest surface answers first.
    pub first_echo: f64,
    /// σ_in(d^l, d): how far the coverage of a cell in which the echo began may be from μ.
    pub sigma_in: Linear,
    /// How far behind the end of a measurement cells are taken to be covered \[m\].
    pub behind: f64,
    /// b: share of the cause that counts for these cells, at most 1.
    pub behind_weight: f64,
    /// σ of "covered" behind the end.
    pub sigma_behind: f64,
    /// What it says of a cell that sound passed through it.
    pub free: FreeSpace,
    /// How surely an echo from beyond the usable range passed the cells before it.
    pub beyond: f64,
    /// What a beam without an echo says.
    pub no_echo: NoEchoShare,
    /// How much readings from one place repeat each other.
    pub repeats: Repeats,
}

/// The most bearings.
pub(crate) const MOST_BEARINGS: usize = 16;

impl CauseParameters {
    /// What a fit to whole explorations of simulated worlds came to.
    pub fn fitted() -> Self {
        Self {
            bearings: 8,
            range_tolerance: 0.044,
            cell_depth: 1.3,
            unknown_coverage: 0.094,
            sharpness: 1.0,
            chance: 0.8,
            first_echo: 4.9,
            sigma_in: Linear { base: 0.1, per_cell_distance: 0.068, per_range: 0.0 },
            behind: 0.29,
            behind_weight: 0.27,
            sigma_behind: 0.21,
            free: FreeSpace { share: 0.42, range: 0.8, width: 0.8, sigma: 0.06 },
            beyond: 0.1,
            no_echo: NoEchoShare { range: 0.3, share: 0.2 },
            repeats: Repeats { share: 0.75, distance: 0.2, bearing: 0.13 },
        }
    }

    pub(super) fn validate(&self, range: f64, half_bin: f64) -> Result<(), ModelError> {
        if !(1..=MOST_BEARINGS).contains(&self.bearings) {
            return Err(ModelError::Bearings(self.bearings));
        }
        let within = ModelError::within;
        within("range_tolerance", self.range_tolerance, 1e-4, 1.0)?;
        within("cell_depth", self.cell_depth, 0.5, 2.0)?;
        within("unknown_coverage", self.unknown_coverage, 0.0, 1.0)?;
        within("sharpness", self.sharpness, 0.01, 10.0)?;
        within("chance", self.chance, 0.01, 1e3)?;
        within("first_echo", self.first_echo, 0.0, 100.0)?;
        if !self.sigma_in.is_monotone() {
            return Err(ModelError::NotMonotone("sigma_in"));
        }
        within("sigma_in.per_cell_distance", self.sigma_in.per_cell_distance, 0.0, 10.0)?;
        within("sigma_in.per_range", self.sigma_in.per_range, 0.0, 10.0)?;
        within("behind", self.behind, self.range_tolerance, 2.0)?;
        within("behind_weight", self.behind_weight, 0.0, 1.0)?;
        within("free.share", self.free.share, 0.0, 1.0)?;
        within("free.range", self.free.range, 1e-3, 1e3)?;
        within("free.width", self.free.width, 1e-3, 1e3)?;
        within("beyond", self.beyond, 0.0, 1.0)?;
        within("no_echo.range", self.no_echo.range, 0.0, range)?;
        within("no_echo.share", self.no_echo.share, 0.0, 1.0)?;
        within("repeats.share", self.repeats.share, 0.0, 1.0)?;
        within("repeats.distance", self.repeats.distance, 1e-3, 10.0)?;
        within("repeats.bearing", self.repeats.bearing, 1e-3, 10.0)?;
        for (name, sigma) in [
            ("sigma_in", self.sigma_in.base),
            ("sigma_behind", self.sigma_behind),
            ("free.sigma", self.free.sigma),
        ] {
            within(name, sigma, half_bin, 10.0)?;
        }
        Ok(())
    }
}
