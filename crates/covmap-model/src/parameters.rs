//! The parameters of the sensor model.

mod cause;
mod product;

pub use cause::{CauseParameters, FreeSpace, NoEchoShare, Repeats};
pub use product::{NoEchoParameters, ProductParameters};

pub(crate) use cause::MOST_BEARINGS;

use crate::{FootprintError, FootprintRule};
use covmap::{MAX_BINS, MIN_BINS, short};
use serde::{Deserialize, Serialize};

/// A function that grows with the distance of a cell and with the measured range:
///
/// ```text
/// f(d^l, d) = base + per_cell_distance · d^l + per_range · d
/// ```
///
/// Choice: the paper asks for functions that increase monotonically in d^l and d; this model takes
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
    /// Creates a function that is the same everywhere.
    pub(crate) fn constant(base: f64) -> Self {
        Self { base, per_cell_distance: 0.0, per_range: 0.0 }
    }

    /// Returns the value for a cell at `cell_distance` \[m\] and a measured `range` \[m\].
    #[inline(always)]
    pub fn at(&self, cell_distance: f64, range: f64) -> f64 {
        self.base + self.per_cell_distance * cell_distance + self.per_range * range
    }

    pub(crate) fn is_monotone(&self) -> bool {
        [self.base, self.per_cell_distance, self.per_range]
            .iter()
            .all(|v| v.is_finite() && *v >= 0.0)
    }
}

/// Update of the belief by a reading: one of two, by name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Update {
    /// The paper's update: every cell of the cone by itself, Eq. (9) and (10).
    Product(ProductParameters),
    /// Our update: the map tells which surface may have caused the echo.
    Cause(CauseParameters),
}

/// Parameters of the sensor model, section 3, and of the details that the paper leaves open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelParameters {
    /// Number of bins of each histogram, n.
    pub bins: usize,
    /// Range beyond which an echo has no end in the map \[m\]: such an echo only frees the cells
    /// before it.
    pub usable_range: f64,
    /// Rule for the cells that a beam covers.
    pub footprint: FootprintRule,
    /// Update of these cells by a reading.
    pub update: Update,
}

/// Error of parameters that make no model.
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
        /// Range at which it is reached \[m\].
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
    /// The number of bearings is out of range.
    #[error("model.bearings: {0} is not in 1..={MOST_BEARINGS}")]
    Bearings(usize),
    /// γ is not positive: γ and the Gaussian must leave every bin possible.
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
    /// If the parameter is out of the interval, or is not a number.
    pub fn within(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), Self> {
        let good = (min..=max).contains(&value);
        good.then_some(()).ok_or(Self::OutOfRange { name, value, min, max })
    }
}

impl Update {
    /// Returns the update's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Product(_) => "Product",
            Self::Cause(_) => "Cause",
        }
    }

    /// Returns the parameters of Eq. (9), if this is the update.
    pub fn product(&self) -> Option<&ProductParameters> {
        match self {
            Self::Product(product) => Some(product),
            Self::Cause(_) => None,
        }
    }

    /// Returns the parameters of the update by cause, if this is the update.
    pub fn cause(&self) -> Option<&CauseParameters> {
        match self {
            Self::Product(_) => None,
            Self::Cause(cause) => Some(cause),
        }
    }

    /// Returns the distance behind the end of a measurement up to which cells are taken to be
    /// covered \[m\].
    pub fn behind(&self) -> f64 {
        match self {
            Self::Product(product) => product.behind,
            Self::Cause(cause) => cause.behind,
        }
    }

    /// Returns the distance up to which a beam without an echo frees cells \[m\].
    pub fn no_echo_range(&self) -> f64 {
        match self {
            Self::Product(product) => product.no_echo.range,
            Self::Cause(cause) => cause.no_echo.range,
        }
    }
}

impl ModelParameters {
    /// Returns the default, a B21r's sonars: 11 bins, 3 m usable range, and the update by cause,
    /// fitted to whole explorations of simulated worlds (`configs/b21r.ron`).
    pub fn b21r() -> Self {
        Self {
            bins: 11,
            usable_range: 3.0,
            footprint: FootprintRule::Sectors { half_angle: 7.5 * std::f64::consts::PI / 180.0 },
            update: Update::Cause(CauseParameters::fitted()),
        }
    }

    /// Returns the same sonars with Eq. (9), fitted to the first 200 scans of explorations.
    pub fn product() -> Self {
        Self { update: Update::Product(ProductParameters::fitted()), ..Self::b21r() }
    }

    /// Returns the same sonars with Eq. (9) and parameters that were chosen by hand on small
    /// worlds: each reading says much more, and maps are more certain than they ought to be.
    pub fn by_hand() -> Self {
        Self { update: Update::Product(ProductParameters::by_hand()), ..Self::b21r() }
    }

    /// Returns these parameters with others of Eq. (9).
    #[must_use]
    pub fn with_product(self, change: impl FnOnce(&mut ProductParameters)) -> Self {
        let mut product = match self.update {
            Update::Product(product) => product,
            Update::Cause(_) => ProductParameters::fitted(),
        };
        change(&mut product);
        Self { update: Update::Product(product), ..self }
    }

    /// Returns these parameters with others of the update by cause.
    #[must_use]
    pub fn with_cause(self, change: impl FnOnce(&mut CauseParameters)) -> Self {
        let mut cause = match self.update {
            Update::Cause(cause) => cause,
            Update::Product(_) => CauseParameters::fitted(),
        };
        change(&mut cause);
        Self { update: Update::Cause(cause), ..self }
    }

    /// Checks everything but the footprint.
    pub(crate) fn validate(&self) -> Result<(), ModelError> {
        if !(MIN_BINS..=MAX_BINS).contains(&self.bins) {
            return Err(ModelError::Bins(self.bins));
        }
        ModelError::within("usable_range", self.usable_range, 0.1, 100.0)?;
        let half_bin = 0.5 / (self.bins - 1) as f64;
        match &self.update {
            Update::Product(product) => product.validate(self.usable_range, half_bin),
            Update::Cause(cause) => cause.validate(self.usable_range, half_bin),
        }
    }
}
