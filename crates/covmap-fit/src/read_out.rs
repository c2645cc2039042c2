//! The read-out that explains the truth best.

use crate::ascent::{Objective, climb};
use crate::{Class, Weighting};
use covmap::{MAX_BINS, ReadOut, lower_bin};
use rayon::prelude::*;

/// λ: penalty of weights that differ from those of the plain read-out \[nats\].
const SHRINKAGE: f64 = 1e-3;

/// Largest number of cells in use: of more cells every second, third … is enough, and memory is
/// finite.
const MOST_CELLS: usize = 400_000;

/// The number of cells that one thread sums up. It is fixed, so that the sum is a function of the
/// cells.
const CHUNK: usize = 1024;

/// Fits a read-out to posteriors of `bins` bins, each with the true coverage of its cell:
///
/// ```text
/// max  Σ_i w_i Σ_j y_ij · log p'_j(i)  −  λ·‖W − I‖²          w_i by `weighting`, Σ w = 1
/// ```
///
/// y_i is the truth, divided among two bins where it lies between them. λ = .001 keeps the read-out
/// as the map has it where the data say nothing. The likelihood of a multinomial logistic
/// regression is concave, so that there is one maximum, wherever the search begins. Few truths lead
/// to nearly the plain read-out, and no cells to exactly this.
///
/// # Panics
/// Unless `bins` is in 2..=64 and the posteriors have as many.
pub fn fit_read_out(cells: &[(Vec<f64>, f64)], bins: usize, weighting: Weighting) -> ReadOut {
    let plain = ReadOut::plain(bins);
    let stride = cells.len().div_ceil(MOST_CELLS).max(1);
    let cells: Vec<&(Vec<f64>, f64)> = cells.iter().step_by(stride).collect();
    if cells.is_empty() {
        return plain;
    }
    let regression = Regression::new(&cells, bins, weighting);
    let found = climb(&regression, regression.plain());
    let (bias, weights) = found.split_at(bins);
    let rows = weights.chunks(bins).map(<[f64]>::to_vec).collect();
    ReadOut::new(bias.to_vec(), rows).unwrap_or(plain)
}

/// The likelihood of truths as a function of b, and of W row by row.
struct Regression {
    bins: usize,
    /// log p̃ of every cell.
    clues: Vec<f64>,
    cells: Vec<Truth>,
}

/// The truth of a cell: (1 − t) of it in a bin, t in the next; and its weight.
#[derive(Clone, Copy)]
struct Truth {
    bin: usize,
    t: f64,
    weight: f64,
}

impl Regression {
    fn new(cells: &[&(Vec<f64>, f64)], bins: usize, weighting: Weighting) -> Self {
        let mut clues = vec![0.0; cells.len() * bins];
        for (clues, (posterior, _)) in clues.chunks_mut(bins).zip(cells) {
            ReadOut::clues(posterior, clues);
        }
        let weights = weighting.weights(cells.iter().map(|(_, truth)| Class::of(*truth)));
        let truth = |((_, truth), weight): (&&(Vec<f64>, f64), f64)| {
            let (bin, t) = lower_bin(*truth, bins);
            Truth { bin, t, weight }
        };
        Self { bins, clues, cells: cells.iter().zip(weights).map(truth).collect() }
    }

    /// Returns the start of the search: b = 0, W = I.
    fn plain(&self) -> Vec<f64> {
        let mut place = vec![0.0; self.bins * (self.bins + 1)];
        (0..self.bins).for_each(|j| place[self.bins + j * (self.bins + 1)] = 1.0);
        place
    }

    /// Returns the likelihood of some cells, and its gradient.
    fn of_cells(&self, place: &[f64], clues: &[f64], cells: &[Truth]) -> (f64, Vec<f64>) {
        let n = self.bins;
        let (bias, weights) = place.split_at(n);
        let (mut value, mut gradient) = (0.0, vec![0.0; place.len()]);
        let mut q = [0.0; MAX_BINS];
        let q = &mut q[..n];
        for (clues, truth) in clues.chunks(n).zip(cells) {
            for ((q, b), row) in q.iter_mut().zip(bias).zip(weights.chunks(n)) {
                *q = b + row.iter().zip(clues).map(|(w, c)| w * c).sum::<f64>();
            }
            let largest = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let at = (1.0 - truth.t) * q[truth.bin] + truth.t * q[truth.bin + 1];
            q.iter_mut().for_each(|q| *q = libm::exp(*q - largest));
            let sum: f64 = q.iter().sum();
            value += truth.weight * (at - largest - libm::log(sum));
            q.iter_mut().for_each(|q| *q *= -truth.weight / sum);
            q[truth.bin] += truth.weight * (1.0 - truth.t);
            q[truth.bin + 1] += truth.weight * truth.t;
            let (of_bias, of_weights) = gradient.split_at_mut(n);
            of_bias.iter_mut().zip(&*q).for_each(|(g, q)| *g += q);
            for (row, q) in of_weights.chunks_mut(n).zip(&*q) {
                row.iter_mut().zip(clues).for_each(|(g, c)| *g += q * c);
            }
        }
        (value, gradient)
    }
}

impl Objective for Regression {
    fn at(&self, place: &[f64]) -> (f64, Vec<f64>) {
        let chunks = self.clues.par_chunks(CHUNK * self.bins).zip(self.cells.par_chunks(CHUNK));
        let parts: Vec<_> =
            chunks.map(|(clues, cells)| self.of_cells(place, clues, cells)).collect();
        let (mut value, mut gradient) = (0.0, vec![0.0; place.len()]);
        for (part, slope) in parts {
            value += part;
            gradient.iter_mut().zip(slope).for_each(|(g, s)| *g += s);
        }
        for (i, (at, plain)) in place.iter().zip(self.plain()).enumerate().skip(self.bins) {
            let off = at - plain;
            value -= SHRINKAGE * off * off;
            gradient[i] -= 2.0 * SHRINKAGE * off;
        }
        (value, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap::bin_coverage;
    use proptest::prelude::*;

    fn read(read_out: &ReadOut, posterior: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; posterior.len()];
        read_out.read(posterior, &mut out);
        out
    }

    #[test]
    fn a_map_that_counts_everything_twice_is_read_once() {
        // A cell is covered with probability u; the map is told p ∝ (1 − u, u)², so that it is too
        // sure. What comes back is u: logarithms weigh ½.
        let mut cells = Vec::new();
        for percent in 1..100 {
            let u = f64::from(percent) / 100.0;
            let (a, b) = ((1.0 - u) * (1.0 - u), u * u);
            let posterior = vec![a / (a + b), b / (a + b)];
            // Of 100 cells as many are covered.
            (0..100)
                .for_each(|i| cells.push((posterior.clone(), f64::from(u8::from(i < percent)))));
        }
        let read_out = fit_read_out(&cells, 2, Weighting::Cells);
        for percent in [10, 30, 50, 90] {
            let (posterior, _) = &cells[100 * (percent - 1)];
            let found = read(&read_out, posterior)[1];
            let truth = percent as f64 / 100.0;
            assert!((found - truth).abs() < 0.02, "{found} {truth}");
        }
    }

    #[test]
    fn classes_weigh_alike_if_that_is_wanted() {
        // The map knows nothing; of ten cells nine are free.
        let cells: Vec<_> =
            (0..10).map(|i| (vec![0.5, 0.5], f64::from(u8::from(i == 0)))).collect();
        let free = |weighting| read(&fit_read_out(&cells, 2, weighting), &[0.5, 0.5])[0];
        assert!((free(Weighting::Cells) - 0.9).abs() < 1e-3);
        assert!((free(Weighting::Classes) - 0.5).abs() < 1e-3);
    }

    #[test]
    fn without_cells_the_plain_one_comes_out() {
        assert_eq!(fit_read_out(&[], 11, Weighting::Classes), ReadOut::plain(11));
    }

    fn cells() -> impl Strategy<Value = Vec<(Vec<f64>, f64)>> {
        let cell = (prop::collection::vec(1e-6..1.0f64, 4), 0.0..=1.0f64).prop_map(|(p, truth)| {
            let sum: f64 = p.iter().sum();
            (p.iter().map(|p| p / sum).collect(), truth)
        });
        prop::collection::vec(cell, 1..40)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn the_gradient_is_that_of_the_likelihood(cells in cells(), at in prop::collection::vec(-2.0..2.0f64, 20)) {
            let cells: Vec<_> = cells.iter().collect();
            let regression = Regression::new(&cells, 4, Weighting::Classes);
            let (_, gradient) = regression.at(&at);
            for (i, slope) in gradient.iter().enumerate() {
                let moved = |by: f64| {
                    let mut place = at.clone();
                    place[i] += by;
                    regression.at(&place).0
                };
                let measured = (moved(1e-5) - moved(-1e-5)) / 2e-5;
                prop_assert!((measured - slope).abs() < 1e-5 * (1.0 + slope.abs()));
            }
        }

        #[test]
        fn reading_makes_the_training_truths_no_less_likely(cells in cells()) {
            let all = |read_out: &ReadOut| -> f64 {
                let likelihood = |(p, truth): &(Vec<f64>, f64)| {
                    covmap_statistics::log_likelihood(&read(read_out, p), *truth, 0.0)
                };
                cells.iter().map(likelihood).sum()
            };
            let fitted = fit_read_out(&cells, 4, Weighting::Cells);
            prop_assert!(all(&fitted) >= all(&ReadOut::plain(4)) - 1e-6);
        }

        #[test]
        fn what_the_map_gets_right_stays(seed in 0..50u32) {
            // Truths drawn in proportion to the posteriors: nothing to correct.
            let mut cells = Vec::new();
            for i in 0..40 {
                let weight = |k: u32| f64::from((seed + 7 * i + 3 * k * (i + 1)) % 11 + 1);
                let p: Vec<f64> = (0..4).map(weight).collect();
                let sum: f64 = p.iter().sum();
                let p: Vec<f64> = p.iter().map(|p| p / sum).collect();
                for k in 0..4 {
                    #[allow(clippy::cast_possible_truncation, reason = "small")]
                    let times = (400.0 * p[k]).round() as usize;
                    cells.extend(std::iter::repeat_n((p.clone(), bin_coverage(k, 4)), times));
                }
            }
            let read_out = fit_read_out(&cells, 4, Weighting::Cells);
            for (p, _) in cells.iter().step_by(100) {
                for (a, b) in read(&read_out, p).iter().zip(p) {
                    prop_assert!((a - b).abs() < 5e-3, "{a} {b}");
                }
            }
        }
    }
}
