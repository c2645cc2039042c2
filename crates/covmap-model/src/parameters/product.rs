//! The parameters of Eq. (9).

use super::{Linear, ModelError};
use serde::{Deserialize, Serialize};

/// Evidence of a beam without an echo.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoEchoParameters {
    /// Distance up to which cells are taken to be free \[m\]; 0 ignores such beams.
    pub range: f64,
    /// The uniform share γ for these cells: larger than for an echo, because a smooth wall
    /// does not answer either.
    pub gamma: f64,
}

/// Parameters of Eq. (9), and of the details that the paper leaves open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProductParameters {
    /// σ(d^l, d) of Eq. (9) where |d^l − d| > r/2.
    pub sigma_out: Linear,
    /// σ of Eq. (9) where |d^l − d| ≤ r/2: larger than every `sigma_out` in range.
    pub sigma_in: f64,
    /// γ(d^l, d) of Eq. (9), a density level.
    pub gamma: Linear,
    /// Distance behind the end of a measurement up to which cells are taken to be covered \[m\]:
    /// the paper's 20 cm.
    pub behind: f64,
    /// Evidence of a beam without an echo.
    pub no_echo: NoEchoParameters,
    /// Exponent ≤ 1 on the evidence of one measurement: 1 in the paper. Readings that are not
    /// independent, such as many from one pose, make the product of Eq. (8) overconfident.
    pub tempering: f64,
}

impl ProductParameters {
    /// Returns the result of a fit to the first 200 scans of explorations.
    pub fn fitted() -> Self {
        Self {
            sigma_out: Linear { base: 0.0523, per_cell_distance: 0.0, per_range: 0.0119 },
            sigma_in: 0.15,
            gamma: Linear { base: 0.613, per_cell_distance: 0.33, per_range: 0.33 },
            behind: 0.085,
            no_echo: NoEchoParameters { range: 0.5, gamma: 20.0 },
            tempering: 0.199,
        }
    }

    /// Returns parameters that were chosen by hand.
    pub(super) fn by_hand() -> Self {
        Self {
            sigma_out: Linear { base: 0.06, per_cell_distance: 0.02, per_range: 0.02 },
            sigma_in: 0.22,
            gamma: Linear { base: 0.05, per_cell_distance: 0.4, per_range: 0.2 },
            behind: 0.10,
            no_echo: NoEchoParameters { range: 1.0, gamma: 1.0 },
            tempering: 0.7,
        }
    }

    pub(super) fn validate(&self, range: f64, half_bin: f64) -> Result<(), ModelError> {
        let within = ModelError::within;
        within("sigma_in", self.sigma_in, 1e-3, 10.0)?;
        within("behind", self.behind, 0.0, 2.0)?;
        within("no_echo.range", self.no_echo.range, 0.0, range)?;
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
        if self.sigma_out.base < half_bin {
            return Err(ModelError::SigmaBelowHalfBin { sigma: self.sigma_out.base, half_bin });
        }
        let sigma_out = self.sigma_out.at(range + self.behind, range);
        if self.sigma_in <= sigma_out {
            return Err(ModelError::SigmaIn { sigma_in: self.sigma_in, sigma_out, range });
        }
        Ok(())
    }
}
