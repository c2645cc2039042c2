//! The maximum of the likelihood, by local search from many starts.

use crate::search::{SearchSettings, higher, maximise, random_start};
use crate::{
    Axis, AxisError, ByClass, Class, Example, ExampleScore, Method, Parameter, Update, score_method,
};
use covmap_model::{ModelError, ModelParameters};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// What the objective is the mean of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Weighting {
    /// All cells alike.
    Cells,
    /// The classes alike: cells that are free, partly covered, and solid, as far as there are
    /// any. Indoors most cells are free, and few are solid and in sight: alike, cells let a fit
    /// buy a better likelihood of the others with walls that are not there.
    Classes,
}

/// How the parameters are sought.
#[derive(Debug, Clone, PartialEq)]
pub struct FitSettings {
    /// What the likelihood is the mean of.
    pub weighting: Weighting,
    /// The free parameters. All others stay as they are.
    pub axes: Vec<Axis>,
    /// How many local searches: the first from the given parameters, the others from places
    /// drawn at random. The best result counts.
    pub starts: usize,
    /// Each search.
    pub search: SearchSettings,
}

/// One evaluation of the objective.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// Which search it belongs to, from 0.
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

/// What a fit came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The best parameters.
    pub parameters: ModelParameters,
    /// Their objective \[nats\].
    pub log_likelihood: f64,
    /// Every evaluation, in order.
    pub path: Vec<Evaluation>,
    /// One for each axis.
    pub profiles: Vec<Profile>,
}

/// Why nothing can be fitted.
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

impl Weighting {
    /// The mean log-likelihood \[nats\].
    pub fn objective(self, score: &ExampleScore) -> f64 {
        let is_there = |class| score.get(Some(class)).cells > 0;
        let mean = self.mean(is_there, |class| Some(score.get(class).log_likelihood));
        mean.unwrap_or(0.0)
    }

    /// What each cell weighs, by its class; all of them together 1.
    pub(crate) fn weights(
        self,
        cells: impl ExactSizeIterator<Item = Class> + Clone,
    ) -> impl Iterator<Item = f64> {
        let share = |count: usize| 1.0 / count.max(1) as f64;
        let of_class = ByClass::from_fn(|class| match (self, class) {
            (_, None) => 0.0,
            (Self::Cells, Some(_)) => share(cells.len()),
            (Self::Classes, Some(class)) => share(cells.clone().filter(|c| *c == class).count()),
        });
        let each = move |class| *of_class.get(Some(class));
        let total: f64 = cells.clone().map(each).sum();
        cells.map(move |class| each(class) / total)
    }

    /// The mean of what `of` says of all cells (`None`) or of the classes that are there;
    /// `None` if it says nothing of one of them, or there are none.
    pub(crate) fn mean(
        self,
        is_there: impl Fn(Class) -> bool,
        of: impl Fn(Option<Class>) -> Option<f64>,
    ) -> Option<f64> {
        match self {
            Self::Cells => of(None),
            Self::Classes => {
                let classes = [Class::Free, Class::Partial, Class::Solid].into_iter();
                let there = classes.filter(|class| is_there(*class)).map(Some);
                let means: Vec<f64> = there.map(of).collect::<Option<_>>()?;
                let mean = means.iter().sum::<f64>() / means.len() as f64;
                (!means.is_empty()).then_some(mean)
            }
        }
    }
}

/// The points of a profile.
const PROFILE_POINTS: u32 = 11;

/// Fits the free parameters to examples: the largest mean log-likelihood of the true
/// coverage of their cells under the maps that the model builds from their scans.
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

/// How well the maps that a model builds explain all examples together, cell by cell.
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
