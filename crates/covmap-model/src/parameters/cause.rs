//! The parameters of the update by cause.

use super::{Linear, ModelError};
use serde::{Deserialize, Serialize};

/// Evidence about a cell that sound has passed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeSpace {
    /// f_0: the share of "free" at the sensor and on the beam's axis, at most 1.
    pub share: f64,
    /// d_f: distance on the axis at which 1/e of it is left \[m\]. Far away the cone is wide.
    pub range: f64,
    /// Standard deviation of its decrease with the bearing, in half-widths of the beam.
    pub width: f64,
    /// σ of "free".
    pub sigma: f64,
}

/// Evidence of a beam without an echo.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoEchoShare {
    /// Distance up to which such a beam passed the cells \[m\]; 0 ignores such beams.
    pub range: f64,
    /// Certainty that it passed them: a smooth wall does not answer either.
    pub share: f64,
}

/// Repetition among readings from one place; [`Looks`](crate::Looks) has the equations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeats {
    /// ρ_0: the probability that a second reading from the same place repeats the first.
    pub share: f64,
    /// λ: distance over which ρ falls to .61 of that \[m\].
    pub distance: f64,
    /// ψ: angle between two axes over which ρ falls as much \[rad\].
    pub bearing: f64,
}

/// The parameters of the update by cause; [`Causes`](crate::Causes) has the equations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CauseParameters {
    /// M: number of bearings into which a beam is divided.
    pub bearings: usize,
    /// τ: largest distance from a cell's border of an echo that may come from the cell \[m\].
    pub range_tolerance: f64,
    /// ℓ/r: depth of a cell along a beam, in sides of a cell: 1 along the axes of the grid, 4/π on
    /// average over all directions.
    pub cell_depth: f64,
    /// Expected coverage of a cell that no reading has touched.
    pub unknown_coverage: f64,
    /// p: exponent on the expected coverage of a surface that may have answered.
    pub sharpness: f64,
    /// a_0: weight of chance against the surfaces; a certain surface has weight 1.
    pub chance: f64,
    /// κ: exponent on the clear part of the view; the nearest surface answers first.
    pub first_echo: f64,
    /// σ_in(d^l, d): standard deviation from μ of the coverage of a cell in which the echo began.
    pub sigma_in: Linear,
    /// Distance behind the end of a measurement up to which cells are taken to be covered \[m\].
    pub behind: f64,
    /// b: share of the cause that counts for these cells, at most 1.
    pub behind_weight: f64,
    /// σ of "covered" behind the end.
    pub sigma_behind: f64,
    /// Evidence about a cell that sound has passed.
    pub free: FreeSpace,
    /// Certainty that an echo from beyond the usable range passed the cells before it.
    pub beyond: f64,
    /// Evidence of a beam without an echo.
    pub no_echo: NoEchoShare,
    /// Repetition among readings from one place.
    pub repeats: Repeats,
}

/// The largest number of bearings.
pub(crate) const MOST_BEARINGS: usize = 16;

impl CauseParameters {
    /// Returns the result of a fit to whole explorations of simulated worlds.
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
