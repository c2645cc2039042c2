//! Few imagined readings that stand for many: how a gain between them is interpolated.
//!
//! What a reading tells about a cell, Eq. (13), is a smooth function of the cell's distance
//! and of the range as long as the beam passed through the cell: σ and γ of Eq. (9) are linear
//! in both. So it is evaluated at a few nodes and interpolated by polynomials; how few is
//! measured when the tables are built, on histograms of all kinds.

use super::evidence::Evidence;
use covmap::bin_coverage;
use covmap_model::{Outcome, SensorModel};
use std::f64::consts::PI;

/// An interpolated gain of a cell may be off by this, in units of the largest gain of its
/// histogram and of one that matters in a decision: what a decision tolerates, for the worst of
/// histograms. Errors of many cells cancel: E\[I\] is off by some hundredth of it, but with four
/// times as much random models were found for which it is off by more than a decision tolerates.
const TOLERANCE: f64 = 1e-5;
/// A gain that matters in a decision is so much of the largest that a reading can give.
const SHARE: f64 = 0.1;

/// Where a function is evaluated, and what each value weighs at each of the points asked for.
#[derive(Debug, Clone)]
pub(crate) struct Nodes {
    pub(crate) at: Vec<f64>,
    /// For each point a weight for each node.
    pub(crate) weights: Vec<Vec<f64>>,
}

impl Nodes {
    /// The points themselves.
    fn all(points: &[f64]) -> Self {
        let weight = |i, j| f64::from(u8::from(i == j));
        let row = |i| (0..points.len()).map(|j| weight(i, j)).collect();
        Self { at: points.to_vec(), weights: (0..points.len()).map(row).collect() }
    }

    /// So many nodes; the points themselves if that is as many.
    pub(crate) fn new(points: &[f64], count: usize, shift: Option<f64>) -> Self {
        if count < points.len() { Self::chebyshev(points, count, shift) } else { Self::all(points) }
    }

    /// `count` Chebyshev nodes over the span of the points, equally good in the variable
    /// `ln(x + shift)`; in x itself if there is no shift.
    fn chebyshev(points: &[f64], count: usize, shift: Option<f64>) -> Self {
        let to = |x: f64| shift.map_or(x, |shift| libm::log(x + shift));
        let back = |y: f64| shift.map_or(y, |shift| libm::exp(y) - shift);
        let low = points.iter().copied().fold(f64::INFINITY, f64::min);
        let high = points.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half) = (0.5 * (to(low) + to(high)), 0.5 * (to(high) - to(low)));
        #[allow(clippy::cast_precision_loss, reason = "few nodes")]
        let angle = |i: usize| PI * (i as f64 + 0.5) / count as f64;
        let nodes: Vec<f64> = (0..count).map(|i| middle + half * libm::cos(angle(i))).collect();
        let weights = points.iter().map(|x| lagrange(&nodes, to(*x))).collect();
        Self { at: nodes.into_iter().map(|y| back(y).clamp(low, high)).collect(), weights }
    }

    /// As few nodes as the entropies of all `probes` allow, times `leniency`, after the readings that `evidence`
    /// makes of a point; all points if that is not less.
    pub(crate) fn few(
        points: &[f64],
        shift: Option<f64>,
        (probes, leniency): (&Probes, f64),
        evidence: impl Fn(f64) -> Evidence,
    ) -> Self {
        let exact: Vec<Vec<f64>> = points.iter().map(|x| probes.after(&evidence(*x))).collect();
        let allowed = probes.allowed(&exact, leniency);
        for count in 1..points.len() {
            let nodes = Self::new(points, count, shift);
            let at: Vec<Vec<f64>> = nodes.at.iter().map(|x| probes.after(&evidence(*x))).collect();
            let good = |(weights, exact): (&Vec<f64>, &Vec<f64>)| {
                (0..exact.len()).all(|probe| {
                    let value: f64 = weights.iter().zip(&at).map(|(w, v)| w * v[probe]).sum();
                    (value - exact[probe]).abs() <= allowed[probe]
                })
            };
            if nodes.weights.iter().zip(&exact).all(good) {
                return nodes;
            }
        }
        Self::all(points)
    }
}

/// The weights of polynomial interpolation.
fn lagrange(nodes: &[f64], x: f64) -> Vec<f64> {
    let factor = |i: usize, j: usize| (x - nodes[j]) / (nodes[i] - nodes[j]);
    let weight = |i| (0..nodes.len()).filter(|j| *j != i).map(|j| factor(i, j)).product();
    (0..nodes.len()).map(weight).collect()
}

/// How wide the peaks of the probes are, and what they stand on: much after few readings.
const WIDTHS_AND_FLOORS: [(f64, f64); 10] = [
    (0.04, 1e-6),
    (0.04, 1e-2),
    (0.04, 0.5),
    (0.12, 1e-6),
    (0.12, 1e-3),
    (0.12, 0.2),
    (0.12, 5.0),
    (0.12, 30.0),
    (0.4, 1e-3),
    (0.4, 5.0),
];

/// Histograms of all kinds: the errors of an interpolation are measured on them.
#[derive(Debug, Clone)]
pub(crate) struct Probes {
    /// h and h·log h.
    probes: Vec<(Vec<f64>, Vec<f64>)>,
    /// A gain that matters in a decision \[nats\].
    scale: f64,
}

impl Probes {
    /// Those of a model, whose strongest evidence is that of a cell near to the sensor.
    pub(crate) fn of_model(model: &SensorModel) -> Self {
        let near = 2.0 * model.resolution();
        Self::new(&Evidence::new(model, near, Outcome::Echo(2.0 * near)))
    }

    /// The uniform one, and narrow and wide ones around many coverages, alone and in pairs.
    /// `strongest` is the evidence that tells most.
    fn new(strongest: &Evidence) -> Self {
        let bins = strongest.bins();
        let mut probes = vec![vec![1.0; bins]];
        for center in [0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0] {
            for (width, floor) in WIDTHS_AND_FLOORS {
                let peak = |center: f64, bin: usize| {
                    let z = (bin_coverage(bin, bins) - center) / width;
                    libm::exp(-0.5 * z * z)
                };
                probes.push((0..bins).map(|b| peak(center, b) + floor).collect());
                let other = if center < 0.5 { 1.0 } else { 0.0 };
                probes.push(
                    (0..bins).map(|b| peak(center, b) + 0.5 * peak(other, b) + floor).collect(),
                );
            }
        }
        let probe = |weights: Vec<f64>| {
            let sum: f64 = weights.iter().sum();
            let h: Vec<f64> = weights.iter().map(|w| w / sum).collect();
            let u = h.iter().map(|h| h * libm::log(*h)).collect();
            (h, u)
        };
        let mut found = Self { probes: probes.into_iter().map(probe).collect(), scale: 0.0 };
        let gains = found.largest_gains(&[found.after(strongest)]);
        found.scale = SHARE * gains.into_iter().fold(0.0, f64::max);
        found
    }

    /// A gain that matters in a decision \[nats\].
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// The gain of every probe by a reading, Eq. (13) \[nats\].
    pub(crate) fn gains(&self, evidence: &Evidence) -> Vec<f64> {
        self.gained(self.after(evidence))
    }

    /// The gains of all probes by each of some readings, in units of what an interpolated one may be
    /// off.
    pub(crate) fn in_tolerances(&self, readings: &[&Evidence]) -> Vec<Vec<f64>> {
        let after: Vec<Vec<f64>> = readings.iter().map(|reading| self.after(reading)).collect();
        let allowed = self.allowed(&after, 1.0);
        let scaled = |after| {
            let gains = self.gained(after).into_iter().zip(&allowed);
            gains.map(|(gain, allowed)| gain / allowed).collect()
        };
        after.into_iter().map(scaled).collect()
    }

    /// The entropy of every probe \[nats\].
    fn before(&self) -> impl Iterator<Item = f64> {
        self.probes.iter().map(|(_, u)| -u.iter().sum::<f64>())
    }

    /// What every probe gained, given its entropy after a reading \[nats\].
    fn gained(&self, after: Vec<f64>) -> Vec<f64> {
        self.before().zip(after).map(|(before, after)| before - after).collect()
    }

    /// The entropy of every probe after a reading \[nats\].
    fn after(&self, evidence: &Evidence) -> Vec<f64> {
        self.probes.iter().map(|(h, u)| evidence.entropy_after(h, u)).collect()
    }

    /// How much an interpolated entropy of each probe may be off, where these are exact; more
    /// by a factor.
    fn allowed(&self, exact: &[Vec<f64>], leniency: f64) -> Vec<f64> {
        let gains = self.largest_gains(exact).into_iter();
        gains.map(|gain| leniency * TOLERANCE * (gain + self.scale)).collect()
    }

    /// The largest change of every probe's entropy, given those after some readings \[nats\].
    fn largest_gains(&self, after: &[Vec<f64>]) -> Vec<f64> {
        let largest = |(probe, before): (usize, f64)| {
            after.iter().map(|after| (before - after[probe]).abs()).fold(0.0, f64::max)
        };
        self.before().enumerate().map(largest).collect()
    }
}
