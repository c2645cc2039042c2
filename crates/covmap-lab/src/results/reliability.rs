//! Charts of the reliability of a map.

use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Panel, Series};
use covmap_fit::Reliability;

/// Number of cells below which a band is drawn hollow.
const FEW: usize = 50;

/// Draws two panels for each of some maps: the shares of truths in the intervals of every class, and
/// the error of cells by their entropy.
///
/// `of` describes the cells; the maps have `bins` bins.
pub fn figure(of: &str, maps: &[(&str, &Reliability)], bins: usize) -> Figure {
    let panels = maps.iter().flat_map(|(name, reliability)| {
        [Panel::from(intervals(name, reliability)), errors(name, reliability, bins).into()]
    });
    Figure {
        title: "Does the map know how right it is?".into(),
        subtitle: of.to_owned(),
        panels: panels.collect(),
        columns: 2,
    }
}

/// Predicted and observed shares of truths in central intervals.
fn intervals(name: &str, reliability: &Reliability) -> Chart {
    let point = |(x, y): &(f64, f64)| ChartPoint::new(*x, *y);
    let curve = |name: &str, points: &[(f64, f64)]| Series {
        name: name.into(),
        points: points.iter().map(point).collect(),
        line: true,
        marks: false,
    };
    let central = &reliability.central;
    Chart {
        title: titled(name, "What central intervals hold"),
        subtitle: "a class is chosen by its truth: only all cells together must be on the line"
            .into(),
        x: ChartAxis {
            from: Some(0.0),
            to: Some(1.0),
            ..ChartAxis::new("predicted share of truths")
        },
        y: ChartAxis { from: Some(0.0), to: Some(1.0), ..ChartAxis::new("observed share") },
        series: vec![
            curve("as predicted", &[(0.0, 0.0), (1.0, 1.0)]),
            curve("free cells", &central.free),
            curve("partly covered cells", &central.partial),
            curve("first layer of solid cells", &central.solid),
            curve("all of them", &central.all),
        ],
    }
}

/// Error against entropy.
fn errors(name: &str, reliability: &Reliability, bins: usize) -> Chart {
    let series = |name: &str, value: fn(&covmap_fit::EntropyBand) -> f64| Series {
        name: name.into(),
        points: reliability
            .by_entropy
            .iter()
            .map(|band| ChartPoint {
                hollow: band.cells < FEW,
                ..ChartPoint::new(band.entropy, value(band))
            })
            .collect(),
        line: true,
        marks: true,
    };
    let most = libm::log(bins as f64);
    Chart {
        title: titled(name, "Error against entropy"),
        subtitle: format!("mean of the cells in a band of entropy; hollow: fewer than {FEW} cells"),
        x: ChartAxis {
            from: Some(0.0),
            to: Some(most),
            ..ChartAxis::new("entropy of the cell [nats]")
        },
        y: ChartAxis { from: Some(0.0), ..ChartAxis::new("absolute error of the mode") },
        series: vec![
            series("measured", |band| band.error),
            series("what the posteriors expect", |band| band.expected_error),
        ],
    }
}

fn titled(name: &str, what: &str) -> String {
    if name.is_empty() { what.to_owned() } else { format!("{what}: {name}") }
}
