//! The maximum of the likelihood, by local search from many starts.

use crate::search::{SearchSettings, higher, maximise, random_start};
use crate::{
    Axis, AxisError, Example, ExampleScore, Method, Parameter, Update, Weighting, score_method,
};
use covmap_model::{ModelError, ModelParameters};
use serde::Serialize;
use std::ops::ControlFlow;

/// Settings of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct FitSettings {
    /// Weighting of the cells in the mean likelihood.
    pub weighting: Weighting,
    /// The free parameters. All others stay as they are.
    pub axes: Vec<Axis>,
    /// Number of local searches: the first from the given parameters, the others from places drawn
    /// at random. The best result counts.
    pub starts: usize,
    /// Settings of each search.
    pub search: SearchSettings,
}

/// One evaluation of the objective.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// Number of its search, from 0.
    pub start: usize,
    /// The values of the free parameters, in the order of the axes.
    pub values: Vec<f64>,
    /// The objective: mean log-likelihood by the settings' weighting \[nats\]; `None` where
    /// the parameters make no model.
    pub log_likelihood: Option<f64>,
}

/// The likelihood along one axis through the fitted parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Profile {
    /// The parameter that varies.
    pub parameter: Parameter,
    /// Its values, and the mean log-likelihood at each \[nats\].
    pub points: Vec<(f64, Option<f64>)>,
}

/// Result of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The best parameters.
    pub parameters: ModelParameters,
    /// Their objective \[nats\].
    pub log_likelihood: f64,
    /// Every evaluation, in order.
    pub path: Vec<Evaluation>,
    /// One for each axis; none if the fit was ended early.
    pub profiles: Vec<Profile>,
}

/// Error of a fit that cannot begin.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// There is nothing to fit to.
    #[error("there are no cells to fit to")]
    NoCells,
    /// An axis is impossible.
    #[error(transparent)]
    Axis(#[from] AxisError),
    /// The given parameters, moved into the bounds, make no model.
    #[error("the parameters to begin with, moved into the bounds of the axes, make no model: {0}")]
    Begin(ModelError),
}

/// The number of points of a profile.
const PROFILE_POINTS: u32 = 11;

/// Fits the free parameters to examples.
///
/// The fit seeks the largest mean log-likelihood of the true coverage of their cells under the maps
/// that the model builds from their scans.
///
/// `uniform` draws uniform numbers in \[0, 1), for the starts; `report` sees every evaluation
/// when it is made, and may end the search: the best so far is then the result, and there are
/// no profiles. The examples are evaluated in parallel; the result is a function of the
/// arguments.
///
/// # Errors
/// If there are no cells, an axis is impossible, or the parameters to begin with make no
/// model within the bounds.
pub fn fit(
    examples: &[Example],
    begin: &ModelParameters,
    settings: &FitSettings,
    mut uniform: impl FnMut() -> f64,
    mut report: impl FnMut(&Evaluation) -> ControlFlow<()>,
) -> Result<Fitted, FitError> {
    let axes = &settings.axes;
    Axis::check(axes)?;
    if examples.iter().all(|example| example.truth.is_empty()) {
        return Err(FitError::NoCells);
    }
    let parameters = |place: &[f64]| {
        let mut parameters = begin.clone();
        axes.iter().zip(place).for_each(|(axis, place)| axis.set(&mut parameters, *place));
        parameters
    };
    let value = |place: &[f64]| {
        Some(settings.weighting.objective(&score(examples, &parameters(place)).ok()?))
    };
    let given: Vec<f64> = axes.iter().map(|axis| axis.place(begin)).collect::<Result<_, _>>()?;
    let is_allowed = |place: &[f64]| {
        let method = Method { model: parameters(place), update: Update::Coverage };
        examples.iter().try_for_each(|example| method.check(example).map(drop))
    };
    is_allowed(&given).map_err(FitError::Begin)?;

    let (mut path, mut best) = (Vec::new(), None);
    let mut stopped = false;
    for start in 0..settings.starts.max(1) {
        if stopped {
            break;
        }
        let place = if start == 0 {
            given.clone()
        } else {
            random_start(&given, &mut uniform, |place| is_allowed(place).is_ok())
        };
        let found = maximise(&place, &settings.search, value, |step| {
            let values = axes.iter().zip(&step.place).map(|(axis, place)| axis.value(*place));
            let evaluation =
                Evaluation { start, values: values.collect(), log_likelihood: step.value };
            let next = report(&evaluation);
            stopped = next.is_break();
            path.push(evaluation);
            next
        });
        best = higher(best, found);
    }
    let (place, log_likelihood) = best.unwrap_or((given, f64::NEG_INFINITY));
    let profiled = if stopped { 0 } else { axes.len() };
    let profiles = (0..profiled).map(|axis| profile(axis, axes, &place, &value)).collect();
    Ok(Fitted { parameters: parameters(&place), log_likelihood, path, profiles })
}

/// Scores the maps that a model builds on all examples together, cell by cell.
///
/// # Errors
/// If the parameters make no model.
pub fn score(
    examples: &[Example],
    parameters: &ModelParameters,
) -> Result<ExampleScore, ModelError> {
    let method = Method { model: parameters.clone(), update: Update::Coverage };
    score_method(examples, &method, false)
}

fn profile(
    axis: usize,
    axes: &[Axis],
    place: &[f64],
    value: &impl Fn(&[f64]) -> Option<f64>,
) -> Profile {
    let point = |i: u32| {
        let mut place = place.to_vec();
        place[axis] = f64::from(i) / f64::from(PROFILE_POINTS - 1);
        (axes[axis].value(place[axis]), value(&place))
    };
    Profile { parameter: axes[axis].parameter, points: (0..PROFILE_POINTS).map(point).collect() }
}
