//! Tuning of any method, with the same budget for all.

use crate::compare::table_of;
use crate::search::{SearchSettings, higher, maximise, random_start};
use crate::{Axis, AxisError, Example, ExampleScore, Method, Parameter, Update, Weighting};
use covmap_model::ModelError;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// A parameter of a method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum MethodParameter {
    /// One of the sensor model: of the footprint, for baselines.
    Model(Parameter),
    /// [`crate::LogOdds::hit`].
    Hit,
    /// [`crate::LogOdds::miss`].
    Miss,
    /// [`crate::LogOdds::no_echo`].
    NoEchoMiss,
    /// [`crate::LogOdds::clamp_low`].
    ClampLow,
    /// [`crate::LogOdds::clamp_high`].
    ClampHigh,
    /// [`crate::BetaCounting::prior_hits`].
    PriorHits,
    /// [`crate::BetaCounting::prior_passes`].
    PriorPasses,
    /// [`crate::BetaCounting::hit`].
    HitCount,
    /// [`crate::BetaCounting::behind`].
    BehindCount,
    /// [`crate::BetaCounting::pass`].
    PassCount,
    /// [`crate::BetaCounting::no_echo`].
    NoEchoCount,
    /// [`crate::Crm::range_noise`] \[m\].
    RangeNoise,
    /// [`crate::Crm::outlier`].
    Outlier,
    /// [`crate::Crm::lost`].
    Lost,
    /// [`crate::Crm::prior`], or that of [`Update::CoverageWithPrior`].
    Prior,
    /// [`crate::Crm::spread`].
    Spread,
    /// [`crate::Crm::tempering`].
    CrmTempering,
}

impl MethodParameter {
    /// Returns the place of the parameter; `None` if the method has no such parameter.
    fn place(self, update: &mut Update) -> Option<&mut f64> {
        match (self, update) {
            (Self::Hit, Update::LogOdds(odds)) => Some(&mut odds.hit),
            (Self::Miss, Update::LogOdds(odds)) => Some(&mut odds.miss),
            (Self::NoEchoMiss, Update::LogOdds(odds)) => Some(&mut odds.no_echo),
            (Self::ClampLow, Update::LogOdds(odds)) => Some(&mut odds.clamp_low),
            (Self::ClampHigh, Update::LogOdds(odds)) => Some(&mut odds.clamp_high),
            (Self::PriorHits, Update::BetaCounting(beta)) => Some(&mut beta.prior_hits),
            (Self::PriorPasses, Update::BetaCounting(beta)) => Some(&mut beta.prior_passes),
            (Self::HitCount, Update::BetaCounting(beta)) => Some(&mut beta.hit),
            (Self::BehindCount, Update::BetaCounting(beta)) => Some(&mut beta.behind),
            (Self::PassCount, Update::BetaCounting(beta)) => Some(&mut beta.pass),
            (Self::NoEchoCount, Update::BetaCounting(beta)) => Some(&mut beta.no_echo),
            (Self::RangeNoise, Update::Crm(crm)) => Some(&mut crm.range_noise),
            (Self::Outlier, Update::Crm(crm)) => Some(&mut crm.outlier),
            (Self::Lost, Update::Crm(crm)) => Some(&mut crm.lost),
            (Self::Prior, Update::Crm(crm)) => Some(&mut crm.prior),
            (Self::Prior, Update::CoverageWithPrior(prior)) => Some(prior),
            (Self::Spread, Update::Crm(crm)) => Some(&mut crm.spread),
            (Self::CrmTempering, Update::Crm(crm)) => Some(&mut crm.tempering),
            _ => None,
        }
    }

    /// Returns its value; `None` if the method has no such parameter.
    pub fn get(self, method: &Method) -> Option<f64> {
        match self {
            Self::Model(parameter) => parameter.get(&method.model),
            _ => self.place(&mut method.update.clone()).map(|value| *value),
        }
    }

    /// Sets its value; does nothing if the method has no such parameter.
    pub fn set(self, method: &mut Method, value: f64) {
        match self {
            Self::Model(parameter) => parameter.set(&mut method.model, value),
            _ => {
                if let Some(place) = self.place(&mut method.update) {
                    *place = value;
                }
            }
        }
    }
}

impl Update {
    /// Returns the axes of a baseline: all its own parameters, and those of the footprint that the
    /// coverage map's fit moves as well, in the same intervals.
    ///
    /// A constant has none. The coverage map has none but its prior, since its axes stand in the
    /// file of its fit.
    pub fn axes(&self) -> Vec<Axis<MethodParameter>> {
        use MethodParameter as P;
        let own: &[(P, f64, f64)] = match self {
            Self::Coverage | Self::Constant(_) => return Vec::new(),
            Self::CoverageWithPrior(_) => {
                return vec![Axis { parameter: P::Prior, from: 0.01, to: 1.0 }];
            }
            Self::LogOdds(_) => &[
                (P::Hit, 0.5, 0.99),
                (P::Miss, 0.05, 0.5),
                (P::NoEchoMiss, 0.05, 0.5),
                (P::ClampLow, 1e-4, 0.4),
                (P::ClampHigh, 1e-4, 0.4),
            ],
            Self::BetaCounting(_) => &[
                (P::PriorHits, 0.01, 10.0),
                (P::PriorPasses, 0.01, 10.0),
                (P::HitCount, 0.01, 10.0),
                (P::BehindCount, 0.0, 5.0),
                (P::PassCount, 0.001, 10.0),
                (P::NoEchoCount, 0.0, 5.0),
                (P::Model(Parameter::Behind), 0.0, 0.3),
            ],
            Self::Crm(_) => &[
                (P::RangeNoise, 0.01, 0.5),
                (P::Outlier, 0.001, 0.5),
                (P::Lost, 0.01, 0.9),
                (P::Prior, 0.01, 1.0),
                (P::Spread, 0.0, 1.0),
                (P::CrmTempering, 0.05, 1.0),
                (P::Model(Parameter::Behind), 0.0, 0.3),
            ],
        };
        let no_echo = (P::Model(Parameter::NoEchoRange), 0.5, 3.0);
        let axis = |&(parameter, from, to): &(P, f64, f64)| Axis { parameter, from, to };
        own.iter().chain([&no_echo]).map(axis).collect()
    }
}

/// Settings of the tuning of a method.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneSettings {
    /// Weighting of the cells in the mean likelihood.
    pub weighting: Weighting,
    /// Whether the likelihood is that of the output after a calibration table, fitted to the
    /// same examples at every evaluation: for a method that will have such a table.
    pub calibrated: bool,
    /// The budget: the exact number of evaluations. When a search ends before, another one begins
    /// at a place drawn at random.
    pub evaluations: usize,
}

/// Result of a tuning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tuned {
    /// The best method.
    pub method: Method,
    /// Its objective on the examples: mean log-likelihood by the settings' weighting
    /// \[nats\].
    pub log_likelihood: f64,
    /// Number of evaluations: the budget, or 0 without axes, or fewer if the caller ended the
    /// tuning.
    pub evaluations: usize,
}

/// Error of a method that cannot be tuned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TuneError {
    /// There is nothing to tune to.
    #[error("there are no cells to tune to")]
    NoCells,
    /// An axis is impossible.
    #[error(transparent)]
    Axis(#[from] AxisError<MethodParameter>),
    /// The method has no such parameter.
    #[error("the method has no parameter {0:?}")]
    NotItsParameter(MethodParameter),
    /// The given parameters, moved into the bounds, make no method.
    #[error("the parameters to begin with, moved into the bounds of the axes: {0}")]
    Begin(ModelError),
}

/// Tunes a method to examples, as [`crate::fit`] fits the sensor model.
///
/// The tuning seeks the largest mean log-likelihood of the true coverage of their cells. The first
/// search begins at the given parameters; `uniform` draws uniform numbers in \[0, 1) for the starts
/// of the others.
///
/// `report` sees the objective at each evaluation, and may end the tuning: the best so far is then
/// the result. The examples are evaluated in parallel; the result is a function of the arguments.
///
/// # Errors
/// If there are no cells, an axis is impossible or not one of the method's, or the parameters
/// to begin with make no method within the bounds.
///
/// # Panics
/// If a scan does not fit the ring of its example.
pub fn tune(
    begin: &Method,
    axes: &[Axis<MethodParameter>],
    examples: &[Example],
    settings: &TuneSettings,
    mut uniform: impl FnMut() -> f64,
    mut report: impl FnMut(Option<f64>) -> ControlFlow<()>,
) -> Result<Tuned, TuneError> {
    Axis::check(axes)?;
    if examples.iter().all(|example| example.truth.is_empty()) {
        return Err(TuneError::NoCells);
    }
    let place = |axis: &Axis<MethodParameter>| match axis.parameter.get(begin) {
        Some(value) => Ok(axis.place_of(value)),
        None => Err(TuneError::NotItsParameter(axis.parameter)),
    };
    let given: Vec<f64> = axes.iter().map(place).collect::<Result<_, _>>()?;
    let method = |place: &[f64]| {
        let mut method = begin.clone();
        axes.iter().zip(place).for_each(|(a, place)| a.parameter.set(&mut method, a.value(*place)));
        method
    };
    let objective = |place: &[f64]| {
        let score = score_method(examples, &method(place), settings.calibrated)?;
        Ok(settings.weighting.objective(&score))
    };
    let is_allowed = |place: &[f64]| {
        let method = method(place);
        examples.iter().try_for_each(|example| method.check(example).map(drop))
    };
    is_allowed(&given).map_err(TuneError::Begin)?;
    let value = |place: &[f64]| objective(place).ok();

    let mut best: Option<(Vec<f64>, f64)> = None;
    let (mut made, mut stopped) = (0, axes.is_empty());
    while !stopped && made < settings.evaluations {
        let start = match made {
            0 => given.clone(),
            _ => random_start(&given, &mut uniform, |place| is_allowed(place).is_ok()),
        };
        let left = settings.evaluations - made;
        let search = SearchSettings { evaluations: left, ..SearchSettings::default() };
        let found = maximise(&start, &search, value, |step| {
            made += 1;
            let next = report(step.value);
            stopped = next.is_break();
            next
        });
        best = higher(best, found);
    }
    let (place, log_likelihood) = match best {
        Some(best) => best,
        None => {
            let value = objective(&given).map_err(TuneError::Begin)?;
            (given, value)
        }
    };
    Ok(Tuned { method: method(&place), log_likelihood, evaluations: made })
}

/// Scores a method on all examples together, cell by cell: by its own posteriors or, if
/// `calibrated`, after a table that is fitted to these examples.
///
/// # Errors
/// If a parameter is out of its interval or does not fit an example.
///
/// # Panics
/// If a scan does not fit the ring of its example.
pub fn score_method(
    examples: &[Example],
    method: &Method,
    calibrated: bool,
) -> Result<ExampleScore, ModelError> {
    let posteriors = method.posteriors_of(examples)?;
    let table = calibrated.then(|| table_of(&posteriors, examples, method.model.bins));
    let score = |(example, posteriors): (&Example, &Vec<Vec<f64>>)| {
        let output = |p| table.as_ref().map_or(p, |table| table.apply(p));
        let truths = example.truth.iter().map(|(_, coverage)| *coverage);
        ExampleScore::of(posteriors.iter().map(|p| output(p.as_slice())).zip(truths))
    };
    let scores: Vec<_> = examples.par_iter().zip(&posteriors).map(score).collect();
    Ok(ExampleScore::pooled(&scores))
}
