//! Nodes: a few values of a variable at which a gain is evaluated, and their weights at all others.
//!
//! The gain of a cell by a reading, Eq. (13), is a smooth function of the cell's distance and of
//! the range as long as the cell lies on one side of the end: σ and γ of Eq. (9) are linear in
//! both. It is therefore interpolated by polynomials. The least sufficient number of nodes is
//! measured on [`ProbeHistograms`] when the tables are made.

use crate::evidence::BinEvidence;
use crate::numbers::as_f64;
use crate::probes::ProbeHistograms;
use std::f64::consts::PI;

/// Points at which a function is evaluated, and their weights at each of the points asked for.
#[derive(Debug, Clone)]
pub(crate) struct Nodes {
    pub(crate) at: Vec<f64>,
    /// For each point a weight for each node.
    pub(crate) weights: Vec<Vec<f64>>,
}

impl Nodes {
    /// Takes the points themselves as nodes.
    fn all(points: &[f64]) -> Self {
        let weight = |i, j| f64::from(u8::from(i == j));
        let row = |i| (0..points.len()).map(|j| weight(i, j)).collect();
        Self { at: points.to_vec(), weights: (0..points.len()).map(row).collect() }
    }

    /// Creates a number of nodes; the points themselves if there are no more of them.
    pub(crate) fn new(points: &[f64], count: usize, shift: Option<f64>) -> Self {
        if count < points.len() { Self::chebyshev(points, count, shift) } else { Self::all(points) }
    }

    /// Creates `count` Chebyshev nodes over the span of the points, equally good in the variable
    /// `ln(x + shift)`; in x itself if there is no shift.
    fn chebyshev(points: &[f64], count: usize, shift: Option<f64>) -> Self {
        let to = |x: f64| shift.map_or(x, |shift| libm::log(x + shift));
        let back = |y: f64| shift.map_or(y, |shift| libm::exp(y) - shift);
        let low = points.iter().copied().fold(f64::INFINITY, f64::min);
        let high = points.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half) = (0.5 * (to(low) + to(high)), 0.5 * (to(high) - to(low)));
        let angle = |i: usize| PI * (as_f64(i) + 0.5) / as_f64(count);
        let nodes: Vec<f64> = (0..count).map(|i| middle + half * libm::cos(angle(i))).collect();
        let weights = points.iter().map(|x| lagrange(&nodes, to(*x))).collect();
        Self { at: nodes.into_iter().map(|y| back(y).clamp(low, high)).collect(), weights }
    }

    /// Returns the weights of the nodes, which were found with this shift, at other points of their
    /// span.
    pub(crate) fn like_at(&self, points: &[f64], shift: Option<f64>) -> Vec<Vec<f64>> {
        let to = |x: f64| shift.map_or(x, |shift| libm::log(x + shift));
        let nodes: Vec<f64> = self.at.iter().map(|x| to(*x)).collect();
        points.iter().map(|x| lagrange(&nodes, to(*x))).collect()
    }

    /// Creates the fewest nodes that keep the errors of all probes' entropies within the allowed
    /// ones, times `leniency`; all points if that is not fewer. `evidence` makes a reading of a
    /// point.
    pub(crate) fn few(
        points: &[f64],
        shift: Option<f64>,
        (probes, leniency): (&ProbeHistograms, f64),
        evidence: impl Fn(f64) -> BinEvidence,
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

/// Returns the weights of polynomial interpolation.
fn lagrange(nodes: &[f64], x: f64) -> Vec<f64> {
    let factor = |i: usize, j: usize| (x - nodes[j]) / (nodes[i] - nodes[j]);
    let weight = |i| (0..nodes.len()).filter(|j| *j != i).map(|j| factor(i, j)).product();
    (0..nodes.len()).map(weight).collect()
}
