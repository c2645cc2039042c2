//! The methods that are compared: the coverage map, three baselines, and constants.

mod beta;
mod crm;

pub use beta::BetaCounting;
pub use crm::Crm;

use crate::example::truths;
use crate::{Class, Example};
use beta::beta_posterior;
use covmap::{Cell, CoverageMap, Histogram};
use covmap_model::{ModelError, ModelParameters, OccupancyGrid, OccupancyParameters, SensorModel};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Weights of the log-odds grid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogOdds {
    /// Probability of "occupied" for a cell in which a beam ends.
    pub hit: f64,
    /// Probability of "occupied" for a cell that a beam passes through.
    pub miss: f64,
    /// Probability of "occupied" for a cell that a beam without an echo passes through.
    pub no_echo: f64,
    /// The smallest probability of "occupied": the lower clamp.
    pub clamp_low: f64,
    /// 1 − the largest probability of "occupied": the upper clamp.
    pub clamp_high: f64,
}

impl Default for LogOdds {
    /// Hit .7, miss .4 with or without an echo, clamps .12 and .97.
    fn default() -> Self {
        Self { hit: 0.7, miss: 0.4, no_echo: 0.4, clamp_low: 0.12, clamp_high: 0.03 }
    }
}

impl LogOdds {
    fn parameters(&self) -> Result<OccupancyParameters, ModelError> {
        let (min, max) = (1e-6, 1.0 - 1e-6);
        let within = |name, value, max| ModelError::within(name, value, min, max);
        within("log_odds.hit", self.hit, max)?;
        within("log_odds.miss", self.miss, max)?;
        within("log_odds.no_echo", self.no_echo, max)?;
        within("log_odds.clamp_low", self.clamp_low, 0.5)?;
        within("log_odds.clamp_high", self.clamp_high, 0.5)?;
        let Self { hit, miss, no_echo, clamp_low, clamp_high } = *self;
        Ok(OccupancyParameters { hit, miss, no_echo, clamp: Some((clamp_low, 1.0 - clamp_high)) })
    }
}

/// Update of a method by a reading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Update {
    /// The coverage map: Eq. (8) to (10).
    Coverage,
    /// An occupancy grid \[Moravec & Elfes 1985\]: p(occupied) stands at coverage 1, the
    /// rest at 0.
    LogOdds(LogOdds),
    /// Counts of hits and passes, with a Beta posterior.
    BetaCounting(BetaCounting),
    /// The forward update of confidence-rich mapping \[Agha-mohammadi et al. 2019\].
    Crm(Crm),
    /// The coverage map, read with a prior that is not uniform: this share of it is, and the rest
    /// is coverage 0. The map is built with the uniform one, Eq. (6), but the reader may know that
    /// most of the world is free.
    CoverageWithPrior(f64),
    /// A constant, whatever the readings: all mass at this coverage or, if it is between two bins,
    /// divided among them with this mean.
    Constant(f64),
}

/// A method that turns the scans of an example into posteriors of its cells.
///
/// All methods see the same scans and cells, by the same `footprint`, `usable_range`,
/// `no_echo.range` and `behind` of `model`. Methods whose cells depend on others see the same body
/// evidence as well. Of the rest of `model` every method uses `bins`, and the coverage map uses
/// all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// The sensor model; the baselines use its footprint.
    pub model: ModelParameters,
    /// Update by a reading.
    pub update: Update,
}

impl Method {
    /// Creates the constant that is the mean true coverage of the partial cells of some examples;
    /// .5 if there are none.
    pub fn training_mean(model: ModelParameters, examples: &[Example]) -> Self {
        let partial = || truths(examples).filter(|c| Class::of(*c) == Class::Partial);
        let mean = partial().sum::<f64>() / partial().count() as f64;
        Self { model, update: Update::Constant(if mean.is_finite() { mean } else { 0.5 }) }
    }

    /// Returns the sensor model of an example, if this method is one for it.
    ///
    /// # Errors
    /// If a parameter is out of its interval or does not fit the example.
    pub fn check(&self, example: &Example) -> Result<SensorModel, ModelError> {
        match &self.update {
            Update::Coverage => {}
            Update::LogOdds(odds) => drop(odds.parameters()?),
            Update::BetaCounting(beta) => beta.validate()?,
            Update::Crm(crm) => crm.validate()?,
            Update::CoverageWithPrior(share) => ModelError::within("prior", *share, 1e-3, 1.0)?,
            Update::Constant(value) => ModelError::within("constant", *value, 0.0, 1.0)?,
        }
        SensorModel::new(&self.model, &example.ring, example.grid.resolution())
    }

    /// Returns the posterior over the bins of every cell of the truth, in its order. Each posterior
    /// sums to 1. A cell that no reading touched is uniform (but for the constants), and so is one
    /// outside of the grid.
    ///
    /// # Errors
    /// As [`Method::check`].
    ///
    /// # Panics
    /// If a scan does not fit the ring.
    pub fn posteriors(&self, example: &Example) -> Result<Vec<Vec<f64>>, ModelError> {
        let model = self.check(example)?;
        let bins = self.model.bins;
        let uniform = || Histogram::uniform(bins).probabilities().to_vec();
        let of_map = |map: &CoverageMap, cell: Cell| match map.grid().index(cell) {
            Some(_) => map.histogram(cell).probabilities().to_vec(),
            None => uniform(),
        };
        let cells = example.truth.iter().map(|(cell, _)| *cell);
        Ok(match &self.update {
            Update::Coverage => {
                let map = example.map_of(&model)?;
                cells.map(|cell| of_map(&map, cell)).collect()
            }
            &Update::CoverageWithPrior(share) => {
                let map = example.map_of(&model)?;
                let read = |cell| match of_map(&map, cell) {
                    posterior if map.is_known(cell) => with_prior(posterior, share),
                    uniform => uniform,
                };
                cells.map(read).collect()
            }
            Update::Crm(crm) => {
                let map = example.map_by(bins, |map, scan| crm.integrate(&model, map, scan))?;
                cells.map(|cell| of_map(&map, cell)).collect()
            }
            Update::LogOdds(odds) => {
                let mut occupancy = OccupancyGrid::new(example.grid, odds.parameters()?);
                example.scans.iter().for_each(|scan| occupancy.integrate(&model, scan));
                let occupied = occupancy.probabilities();
                let of = |cell| occupied.get(cell).copied().flatten();
                cells.map(|cell| of(cell).map_or_else(uniform, |p| split(p, 2, bins))).collect()
            }
            Update::BetaCounting(beta) => {
                let counts = beta.counts(&model, example.grid, &example.scans);
                let of = |cell| counts.get(cell).copied().flatten();
                let posterior = |(a, b)| beta_posterior(a, b, bins);
                cells.map(|cell| of(cell).map_or_else(uniform, posterior)).collect()
            }
            &Update::Constant(level) => cells.map(|_| split(level, bins, bins)).collect(),
        })
    }

    /// Returns [`Method::posteriors`] of some examples, which are evaluated in parallel.
    pub(crate) fn posteriors_of(
        &self,
        examples: &[Example],
    ) -> Result<Vec<Vec<Vec<f64>>>, ModelError> {
        examples.par_iter().map(|example| self.posteriors(example)).collect()
    }
}

/// Returns the prior probability of a bin: `share` is uniform over the bins, the rest is
/// coverage 0.
fn prior_probability(share: f64, bin: usize, bins: usize) -> f64 {
    let even = share / bins as f64;
    if bin == 0 { 1.0 - share + even } else { even }
}

/// Converts a posterior with a uniform prior to one with that of [`prior_probability`].
fn with_prior(mut posterior: Vec<f64>, share: f64) -> Vec<f64> {
    let bins = posterior.len();
    posterior.iter_mut().enumerate().for_each(|(b, p)| *p *= prior_probability(share, b, bins));
    let sum: f64 = posterior.iter().sum();
    posterior.iter_mut().for_each(|p| *p /= sum);
    posterior
}

/// Returns a distribution with the mean `coverage`, on the two nearest of `levels` evenly spaced
/// coverages from 0 to 1. The levels are bins: 2, the ends, or all `bins`.
fn split(coverage: f64, levels: usize, bins: usize) -> Vec<f64> {
    let step = (bins - 1) / (levels - 1);
    let mut p = vec![0.0; bins];
    let (below, t) = covmap::lower_bin(coverage, levels);
    p[below * step] = 1.0 - t;
    p[(below + 1) * step] = t;
    p
}
