//! The parameters of the sensor model.

use crate::{FootprintError, FootprintRule};
use covmap::{MAX_BINS, MIN_BINS, short};
use serde::{Deserialize, Serialize};

/// A function that grows with the distance of a cell and with the measured range:
///
/// ```text
/// f(d^l, d) = base + per_cell_distance · d^l + per_range · d
/// ```
///
/// Choice: the paper asks for functions that increase monotonously in d^l and d; we take
/// linear ones with slopes ≥ 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Value at distance and range 0.
    pub base: f64,
    /// Slope in the cell's distance d^l \[1/m\].
    pub per_cell_distance: f64,
    /// Slope in the measured range d \[1/m\].
    pub per_range: f64,
}

impl Linear {
    /// The function that is the same everywhere.
    pub(crate) fn constant(base: f64) -> Self {
        Self { base, per_cell_distance: 0.0, per_range: 0.0 }
    }

    /// The value for a cell at `cell_distance` \[m\] and a measured `range` \[m\].
    #[inline(always)]
    pub fn at(&self, cell_distance: f64, range: f64) -> f64 {
        self.base + self.per_cell_distance * cell_distance + self.per_range * range
    }

    fn is_monotone(&self) -> bool {
        [self.base, self.per_cell_distance, self.per_range]
            .iter()
            .all(|v| v.is_finite() && *v >= 0.0)
    }
}

/// What a beam without an echo says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoEchoParameters {
    /// Cells up to this distance are taken to be free \[m\]; 0 ignores such beams.
    pub range: f64,
    /// The uniform share γ for these cells: larger than for an echo, because a smooth wall
    /// does not answer either.
    pub gamma: f64,
}

/// The parameters of Eq. (9) and of what the paper leaves open around it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelParameters {
    /// Number of bins of each histogram, n.
    pub bins: usize,
    /// Cells farther than this from the sensor are not updated \[m\].
    pub usable_range: f64,
    /// σ(d^l, d) of Eq. (9) where |d^l − d| > r/2.
    pub sigma_out: Linear,
    /// σ of Eq. (9) where |d^l − d| ≤ r/2: larger than every `sigma_out` in range.
    pub sigma_in: f64,
    /// γ(d^l, d) of Eq. (9), a density level.
    pub gamma: Linear,
    /// How far behind the end of a measurement cells are taken to be covered \[m\]:
    /// the paper's 20 cm.
    pub behind: f64,
    /// What a beam without an echo says.
    pub no_echo: NoEchoParameters,
    /// Exponent ≤ 1 on the evidence of one measurement: 1 is the paper. Readings that are
    /// not independent, as many from one pose, make the product of Eq. (8) overconfident.
    pub tempering: f64,
    /// Which cells a beam covers.
    pub footprint: FootprintRule,
}

/// Why parameters make no model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The number of bins is out of range.
    #[error("model.bins: {0} is not in {MIN_BINS}..={MAX_BINS}")]
    Bins(usize),
    /// A parameter is not in its interval.
    #[error("model.{name}: {} must lie in [{min}, {max}]", short(value))]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
    },
    /// A slope or a base is negative or not finite.
    #[error(
        "model.{0}: base and slopes must be finite and not negative, so that it never falls with distance"
    )]
    NotMonotone(&'static str),
    /// σ_in does not exceed every σ_out.
    #[error(
        "model.sigma_in: σ_in {} must exceed σ_out {} at range {range} m (the end cell is the least certain)",
        short(sigma_in),
        short(sigma_out)
    )]
    SigmaIn {
        /// σ_in.
        sigma_in: f64,
        /// The largest σ_out.
        sigma_out: f64,
        /// Where it is reached \[m\].
        range: f64,
    },
    /// σ_out is narrower than half a bin.
    #[error(
        "model.sigma_out: σ {} is below half a bin's width {half_bin}: the histogram cannot show it; use more bins or a larger base",
        short(sigma)
    )]
    SigmaBelowHalfBin {
        /// The smallest σ_out.
        sigma: f64,
        /// Half the distance of two bins.
        half_bin: f64,
    },
    /// Nothing but zeros: γ and the Gaussian must leave every bin possible.
    #[error("model.gamma: γ must be positive at distance 0, so that no reading is impossible")]
    NoUniformShare,
    /// The footprint does not fit the ring.
    #[error(transparent)]
    Footprint(#[from] FootprintError),
}

impl ModelError {
    /// Checks that a parameter lies in an interval.
    ///
    /// # Errors
    /// If it does not, or is not a number.
    pub fn within(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), Self> {
        let good = (min..=max).contains(&value);
        good.then_some(()).ok_or(Self::OutOfRange { name, value, min, max })
    }
}

impl ModelParameters {
    /// A B21r's sonars: 11 bins, 3 m usable range, and what a fit on simulated worlds came to
    /// (`configs/b21r.ron`).
    pub fn b21r() -> Self {
        Self {
            bins: 11,
            usable_range: 3.0,
            sigma_out: Linear { base: 0.0523, per_cell_distance: 0.0, per_range: 0.0119 },
            sigma_in: 0.15,
            gamma: Linear { base: 0.613, per_cell_distance: 0.33, per_range: 0.33 },
            behind: 0.085,
            no_echo: NoEchoParameters { range: 0.5, gamma: 20.0 },
            tempering: 0.199,
            footprint: FootprintRule::Sectors { half_angle: 7.5 * std::f64::consts::PI / 180.0 },
        }
    }

    /// The same sonars with parameters that were chosen by hand on small worlds: each reading
    /// says much more, and maps are surer than they ought to be.
    pub fn by_hand() -> Self {
        Self {
            sigma_out: Linear { base: 0.06, per_cell_distance: 0.02, per_range: 0.02 },
            sigma_in: 0.22,
            gamma: Linear { base: 0.05, per_cell_distance: 0.4, per_range: 0.2 },
            behind: 0.10,
            no_echo: NoEchoParameters { range: 1.0, gamma: 1.0 },
            tempering: 0.7,
            ..Self::b21r()
        }
    }

    /// Checks everything but the footprint.
    pub(crate) fn validate(&self) -> Result<(), ModelError> {
        if !(MIN_BINS..=MAX_BINS).contains(&self.bins) {
            return Err(ModelError::Bins(self.bins));
        }
        let within = ModelError::within;
        within("usable_range", self.usable_range, 0.1, 100.0)?;
        within("sigma_in", self.sigma_in, 1e-3, 10.0)?;
        within("behind", self.behind, 0.0, 2.0)?;
        within("no_echo.range", self.no_echo.range, 0.0, self.usable_range)?;
        within("no_echo.gamma", self.no_echo.gamma, 1e-9, 1e3)?;
        within("tempering", self.tempering, 1e-3, 1.0)?;
        for (name, f) in [("sigma_out", &self.sigma_out), ("gamma", &self.gamma)] {
            if !f.is_monotone() {
                return Err(ModelError::NotMonotone(name));
            }
        }
        if self.gamma.base <= 0.0 {
            return Err(ModelError::NoUniformShare);
        }
        within("gamma.base", self.gamma.base, 1e-12, 1e3)?;
        within("gamma.per_cell_distance", self.gamma.per_cell_distance, 0.0, 1e3)?;
        within("gamma.per_range", self.gamma.per_range, 0.0, 1e3)?;
        #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
        let half_bin = 0.5 / (self.bins - 1) as f64;
        if self.sigma_out.base < half_bin {
            return Err(ModelError::SigmaBelowHalfBin { sigma: self.sigma_out.base, half_bin });
        }
        let range = self.usable_range;
        let farthest = range + self.behind;
        let sigma_out = self.sigma_out.at(farthest, range);
        if self.sigma_in <= sigma_out {
            return Err(ModelError::SigmaIn { sigma_in: self.sigma_in, sigma_out, range });
        }
        Ok(())
    }
}
