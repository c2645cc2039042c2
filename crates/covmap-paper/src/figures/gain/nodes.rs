//! The interpolation of a cell's gain: over the range, and over the share of "passed".

use super::moment::Moment;
use super::one_cell::{Gained, at_nodes, gains, kinds};
use crate::error::{PaperError, Result};
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_gain::RangeInterpolation;
use covmap_lab::Config;

/// The ring of the cells in the figure.
const RING: usize = 6;

/// Returns the figure of both evaluators side by side, each with its interpolation error.
pub(super) fn figure(by_cause: &Config, of_product: &Moment, quick: bool) -> Result<Figure> {
    let bins = of_product.map.bins();
    let uniform = vec![1.0 / bins as f64; bins];
    let ring = if quick { RING / 2 } else { RING };
    let over = RangeInterpolation::of(&of_product.model, 0.0, ring, &uniform, 241)
        .ok_or(PaperError::Missing("a ring beyond which outcomes end"))?;
    let of_share: Vec<(&str, Vec<Gained>)> = kinds(bins)
        .into_iter()
        .map(|kind| Ok((kind.name, gains(by_cause, &kind, if quick { 12 } else { 120 })?)))
        .collect::<Result<_>>()?;
    let nodes: Vec<Gained> = kinds(bins)
        .iter()
        .map(|kind| at_nodes(by_cause, kind))
        .collect::<Result<Vec<_>>>()?
        .concat();
    let title = format!("Eq. (9): an untouched cell at d^l = {:.2} m", over.cell_distance);
    Ok(Figure {
        title: "The gain of a cell is smooth, and a few values of it are enough".into(),
        subtitle: format!(
            "left: Eq. (9), over the range of an echo from beyond the cell; right: the update by cause, \
             over the share x of “passed”; r = {} m, {bins} bins",
            by_cause.resolution
        ),
        panels: vec![
            gain_over_range(&over, title).into(),
            gain_over_share(&of_share, &nodes).into(),
            off_over_range(&over).into(),
            off_over_share(&of_share).into(),
        ],
        columns: 2,
    })
}

fn line(name: &str, points: impl Iterator<Item = (f64, f64)>) -> Series {
    let points = points.map(|(x, y)| ChartPoint::new(x, y)).collect();
    Series { name: name.into(), points, line: true, marks: false }
}

fn marks(name: &str, points: impl Iterator<Item = (f64, f64)>) -> Series {
    Series { line: false, marks: true, ..line(name, points) }
}

fn gain_over_range(over: &RangeInterpolation, title: String) -> Chart {
    Chart {
        title,
        subtitle: format!("{} nodes of Chebyshev, in ln(d + shift)", over.nodes.len()),
        x: ChartAxis::new("range d of the echo [m]"),
        y: ChartAxis::new("gain [nats]"),
        series: vec![
            line("Eq. (13)", over.curve.iter().map(|(d, gain, _)| (*d, *gain))),
            line("interpolated", over.curve.iter().map(|(d, _, found)| (*d, *found))),
            marks("nodes", over.nodes.iter().copied()),
        ],
    }
}

fn off_over_range(over: &RangeInterpolation) -> Chart {
    Chart {
        title: "Interpolated less exact".into(),
        subtitle: format!(
            "in billionths of a nat; {:.0} millionths are allowed: other histograms need as many nodes",
            1e6 * over.allowed
        ),
        x: ChartAxis::new("range d of the echo [m]"),
        y: ChartAxis::new("off by [1e-9 nats]"),
        series: vec![
            line("off", over.curve.iter().map(|(d, gain, found)| (*d, 1e9 * (found - gain)))),
            line("", std::iter::empty()),
            marks("nodes", over.nodes.iter().map(|(d, _)| (*d, 0.0))),
        ],
    }
}

fn gain_over_share(of_share: &[(&str, Vec<Gained>)], nodes: &[Gained]) -> Chart {
    let curves = of_share
        .iter()
        .map(|(name, gained)| line(name, gained.iter().map(|g| (g.share, g.literal))));
    let answers = marks("nodes", nodes.iter().map(|g| (g.share, g.fast)));
    Chart {
        title: "By cause: three cells next to the sensor".into(),
        subtitle: format!(
            "lines: Eq. (13) as printed; marks: the evaluator’s answers at its {} nodes",
            nodes.len() / of_share.len()
        ),
        x: ChartAxis { from: Some(0.0), ..ChartAxis::new("share x of “passed”") },
        y: ChartAxis::new("gain [nats]"),
        series: curves.chain([answers]).collect(),
    }
}

fn off_over_share(of_share: &[(&str, Vec<Gained>)]) -> Chart {
    let off = |(name, gained): &(&str, Vec<Gained>)| {
        let largest = gained.iter().map(|g| g.literal.abs()).fold(0.0, f64::max);
        let off = gained.iter().map(|g| (g.share, 1e6 * (g.fast - g.literal) / largest));
        line(name, off)
    };
    Chart {
        title: "The evaluator less Eq. (13)".into(),
        subtitle:
            "in millionths of the largest gain of each cell: little more than single precision"
                .into(),
        x: ChartAxis { from: Some(0.0), ..ChartAxis::new("share x of “passed”") },
        y: ChartAxis::new("off by [1e-6]"),
        series: of_share.iter().map(off).collect(),
    }
}
