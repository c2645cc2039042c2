//! The outcomes that end beyond a ring, and the sum of their gains in a cell of the ring.
//!
//! The gains are interpolated between a few ranges and a few distances. Along the distance they are
//! decomposed into polynomials: the change of a gain within a ring is much smaller than the gain,
//! so that its coefficients need fewer ranges. (Cosines are orthogonal whatever the distances are:
//! the decomposition by itself changes nothing.)

use super::basis::{MixtureQueue, ReadingGain};
use super::spanning::SpanningSet;
use crate::numbers::{as_f64, to_f32};
use covmap::lanes::TOGETHER;
use std::f64::consts::PI;

/// The gain of each outcome in each cell, as a sum over some of the ring's readings: the gain of the
/// reading, times its weight in the outcome, times its factor in the cell.
#[derive(Debug, Clone)]
pub(crate) struct BeyondOutcomes {
    /// The nearest of the outcomes.
    pub(crate) nearest: usize,
    /// The first of the readings, and their number.
    pub(crate) first: usize,
    pub(crate) count: usize,
    /// For [`TOGETHER`] readings their weights in every outcome from the nearest on; 0 past the
    /// last one.
    pub(crate) weights: Vec<Vec<[f32; TOGETHER]>>,
    /// For each beam, for [`TOGETHER`] readings, their factors in each of its cells.
    pub(crate) factors: Vec<Vec<Vec<[f32; TOGETHER]>>>,
}

/// The same outcomes before they are reduced: interpolated between a lattice of ranges and distances.
pub(crate) struct Lattice {
    /// The nearest of the outcomes.
    pub(crate) nearest: usize,
    /// For each outcome the weight of every range.
    pub(crate) of_outcomes: Vec<Vec<f64>>,
    /// For each beam, for each of its cells, the weight of every distance.
    pub(crate) of_cells: Vec<Vec<Vec<f64>>>,
    /// The number of distances.
    pub(crate) distances: usize,
    /// Allowed error of a gain for each distance, in units of that of an interpolated gain.
    pub(crate) tolerance: f64,
}

impl Lattice {
    /// Takes the lattice's readings, one for each range and distance, from the queue of all
    /// readings in front. Adds as few as allowed in place of them to the ring's `readings`.
    pub(crate) fn reduce(
        self,
        queue: &mut MixtureQueue,
        readings: &mut Vec<ReadingGain>,
    ) -> BeyondOutcomes {
        let Self { nearest, of_outcomes, of_cells, distances, tolerance } = self;
        let first = readings.len();
        let ranges = of_outcomes.first().map_or(0, Vec::len);
        let places = queue.take(ranges * distances);
        let mut weights: Vec<Vec<f64>> = vec![Vec::new(); of_outcomes.len()];
        let mut factors: Vec<Vec<Vec<f64>>> =
            of_cells.iter().map(|cells| vec![Vec::new(); cells.len()]).collect();
        for degree in 0..distances {
            let cosines = cosines(degree, distances);
            let coefficient = |range: usize| {
                let scale = if degree == 0 { 1.0 } else { 2.0 } / as_f64(distances);
                let at = places.start + range * distances;
                cosines.iter().zip(at..).map(|(c, at)| (scale * c, at)).collect::<Vec<_>>()
            };
            let vector = |range| queue.gains(&coefficient(range));
            let vectors: Vec<Vec<f64>> = (0..ranges).map(vector).collect();
            let span = SpanningSet::of(&vectors, tolerance);
            for (i, member) in span.members.iter().enumerate() {
                readings.push(queue.sum(&coefficient(*member)));
                for (weights, of_ranges) in weights.iter_mut().zip(&of_outcomes) {
                    let of_range = |(weight, of): (&f64, &Vec<f64>)| weight * of[i];
                    weights.push(of_ranges.iter().zip(&span.weights).map(of_range).sum());
                }
                let of_cells = of_cells.iter().flatten();
                for (factors, of_distances) in factors.iter_mut().flatten().zip(of_cells) {
                    factors.push(of_distances.iter().zip(&cosines).map(|(w, c)| w * c).sum());
                }
            }
        }
        let count = readings.len() - first;
        let factors = factors.iter().map(|of_cells| together(of_cells, count)).collect();
        BeyondOutcomes { nearest, first, count, weights: together(&weights, count), factors }
    }
}

/// Returns the Chebyshev polynomial of a degree at a number of nodes.
fn cosines(degree: usize, nodes: usize) -> Vec<f64> {
    let cosine = |node| libm::cos(PI * as_f64(degree) * (as_f64(node) + 0.5) / as_f64(nodes));
    (0..nodes).map(cosine).collect()
}

/// Cuts rows of numbers into pieces of [`TOGETHER`].
fn together(rows: &[Vec<f64>], count: usize) -> Vec<Vec<[f32; TOGETHER]>> {
    let number = |row: &Vec<f64>, i: usize| row.get(i).map_or(0.0, |x| to_f32(*x));
    let piece =
        |first| rows.iter().map(|row| std::array::from_fn(|i| number(row, first + i))).collect();
    (0..count).step_by(TOGETHER).map(piece).collect()
}
