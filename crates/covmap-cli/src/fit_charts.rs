//! The charts of a fit: the course of the search, and the likelihood along each axis.

use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_fit::{Evaluation, Parameter, Profile};
use covmap_model::ModelParameters;

/// Returns the chart of the objective of every evaluation, and of the best so far, search by
/// search.
pub(crate) fn search(path: &[Evaluation]) -> Chart {
    let mut tried = Series { name: "tried".into(), marks: true, ..Series::default() };
    let mut best = Series { name: "best of its search".into(), line: true, ..Series::default() };
    let (mut highest, mut start) = (f64::NEG_INFINITY, None);
    for (number, evaluation) in (1u32..).zip(path) {
        let x = f64::from(number);
        if start.replace(evaluation.start) != Some(evaluation.start) {
            highest = f64::NEG_INFINITY;
            best.points.push(ChartPoint::new(x, f64::NAN));
        }
        if let Some(value) = evaluation.log_likelihood {
            highest = highest.max(value);
            tried.points.push(ChartPoint::new(x, value));
            best.points.push(ChartPoint::new(x, highest));
        }
    }
    // The worst values at the beginning of a search would squeeze the others together.
    let mut values: Vec<f64> = tried.points.iter().map(|point| point.y).collect();
    values.sort_by(f64::total_cmp);
    let from = values.get(values.len() / 10).copied();
    Chart {
        title: "The search".into(),
        subtitle: "the worst tenth of the evaluations lies below".into(),
        x: ChartAxis::new("evaluation"),
        y: ChartAxis { from, ..ChartAxis::new("mean log-likelihood [nats]") },
        series: vec![tried, best],
    }
}

/// Returns a panel for each free parameter.
pub(crate) fn profiles(profiles: &[Profile], fitted: &ModelParameters) -> Figure {
    let panel = |profile: &Profile| {
        let points = profile.points.iter();
        let line = Series {
            name: "profile".into(),
            points: points.filter_map(|(value, y)| Some(ChartPoint::new(*value, (*y)?))).collect(),
            line: true,
            marks: true,
        };
        let value = profile.parameter.get(fitted).unwrap_or(f64::NAN);
        Chart {
            title: format!("{:?} = {value:.3}", profile.parameter),
            subtitle: String::new(),
            x: ChartAxis::new(format!("{:?}{}", profile.parameter, unit(profile.parameter))),
            y: ChartAxis::new("log-likelihood [nats]"),
            series: vec![line],
        }
        .into()
    };
    Figure {
        title: "The likelihood along each axis through the fitted parameters".into(),
        subtitle: "where the parameters make no model the line ends".into(),
        panels: profiles.iter().map(panel).collect(),
        columns: 3,
    }
}

fn unit(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::GammaPerCellDistance
        | Parameter::GammaPerRange
        | Parameter::SigmaOutPerCellDistance
        | Parameter::SigmaOutPerRange => " [1/m]",
        Parameter::Behind | Parameter::UsableRange | Parameter::NoEchoRange => " [m]",
        Parameter::HalfAngle => " [rad]",
        _ => "",
    }
}
