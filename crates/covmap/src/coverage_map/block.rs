//! Multiplying evidence into many cells side by side.

use super::EvidenceKind;
use crate::CoverageMap;
use crate::histogram::{MAX_BINS, PROBABILITY_FLOOR, TIE};
use crate::lanes::{LANES, Lanes, TOGETHER, flat, ln};

/// Evidence for up to [`LANES`] different cells, side by side, to be multiplied into a map.
#[derive(Debug, Clone)]
pub struct EvidenceBlock {
    /// For each bin the weights of all cells; after [`Self::multiply`] their posteriors. Padding
    /// fills the last [`TOGETHER`] bins and does not matter.
    weights: Vec<[Lanes; TOGETHER]>,
    prior: Vec<Lanes>,
}

impl EvidenceBlock {
    /// Index of a lane without a cell.
    pub const NO_CELL: u32 = u32::MAX;

    /// Creates a block for maps with a number of bins, at most [`MAX_BINS`].
    pub fn new(bins: usize) -> Self {
        let bins = bins.min(MAX_BINS);
        let ones = [1.0; LANES];
        let weights = vec![[ones; TOGETHER]; bins.div_ceil(TOGETHER)];
        Self { weights, prior: vec![ones; bins] }
    }

    /// Returns a row for each bin.
    #[inline(always)]
    fn rows(&self) -> &[Lanes] {
        &self.weights.as_flattened()[..self.prior.len()]
    }

    /// Returns for each bin the weights of all lanes, in proportion to p(c_l | d). The caller fills them in
    /// before the block is multiplied. Weights must be finite and not negative, and the largest weight of a
    /// cell must lie between 1e-3 and 1e3. Bins past the last one do not matter.
    #[inline(always)]
    pub fn weights(&mut self) -> &mut [[Lanes; TOGETHER]] {
        &mut self.weights
    }

    /// Copies the cells' posteriors, transposed. Not inlined: with wide registers the compiler
    /// would gather, in twice the time.
    #[inline(never)]
    fn load(&mut self, posterior: &[f32], cells: &[u32; LANES]) {
        let bins = self.prior.len();
        for (lane, index) in cells.iter().enumerate() {
            if *index != Self::NO_CELL {
                let start = *index as usize * bins;
                let row = &posterior[start..start + bins];
                self.prior.iter_mut().zip(row).for_each(|(to, from)| to[lane] = *from);
            }
        }
    }

    /// Replaces the weights by the product of prior and evidence, Eq. (8), normalised over the floor.
    #[inline(always)]
    fn multiply(&mut self) {
        #[allow(clippy::cast_possible_truncation, reason = "posteriors are stored as f32")]
        const FLOOR: f32 = PROBABILITY_FLOOR as f32;
        let (rows, beyond) = self.weights.as_flattened_mut().split_at_mut(self.prior.len());
        let mut z = [0.0f32; LANES];
        for (w, h) in rows.iter_mut().zip(&self.prior) {
            for lane in 0..LANES {
                w[lane] *= h[lane];
                z[lane] += w[lane];
            }
        }
        let mut sum = [0.0f32; LANES];
        z.iter_mut().for_each(|z| *z = 1.0 / *z);
        for w in rows.iter_mut() {
            for lane in 0..LANES {
                w[lane] = (w[lane] * z[lane]).max(FLOOR);
                sum[lane] += w[lane];
            }
        }
        sum.iter_mut().for_each(|sum| *sum = 1.0 / *sum);
        for w in rows.iter_mut() {
            for lane in 0..LANES {
                w[lane] *= sum[lane];
            }
        }
        // Their logarithms are 0.
        beyond.fill([1.0; LANES]);
    }

    /// Returns the bins of the modes; a tie goes to the first bin, as in [`crate::mode_bin`].
    #[inline(always)]
    fn modes(&self) -> Lanes {
        let rows = self.rows();
        let (mut least, mut mode) = (rows[0], [0.0f32; LANES]);
        for w in &rows[1..] {
            for lane in 0..LANES {
                least[lane] = least[lane].max(w[lane]);
            }
        }
        least.iter_mut().for_each(|largest| *largest *= 1.0 - TIE);
        let mut bin = rows.len() as f32;
        for w in rows.iter().rev() {
            bin -= 1.0;
            for lane in 0..LANES {
                mode[lane] = if w[lane] >= least[lane] { bin } else { mode[lane] };
            }
        }
        mode
    }

    /// Copies the posteriors back. Returns for each lane whether any bit changed. Not inlined, as
    /// [`Self::load`].
    #[inline(never)]
    fn store(&self, posterior: &mut [f32], cells: &[u32; LANES]) -> [bool; LANES] {
        let bins = self.prior.len();
        let mut changed = [false; LANES];
        for (lane, index) in cells.iter().enumerate() {
            if *index != Self::NO_CELL {
                let start = *index as usize * bins;
                let mut difference = 0;
                for (to, from) in posterior[start..start + bins].iter_mut().zip(self.rows()) {
                    difference |= to.to_bits() ^ from[lane].to_bits();
                    *to = from[lane];
                }
                changed[lane] = difference != 0;
            }
        }
        changed
    }
}

/// Returns the entropies of [`LANES`] normalised distributions, Eq. (11) \[nats\]: with 11 bins
/// each to within 2e-6, with 64 to within 1e-5.
#[inline(always)]
fn entropies(probabilities: &[[Lanes; TOGETHER]]) -> Lanes {
    let mut sum = [0.0f32; LANES];
    for p in probabilities {
        let logs = ln(&flat(p));
        let terms = p.as_flattened().iter().zip(&logs);
        for (i, (p, log)) in terms.enumerate() {
            sum[i % LANES] -= p * log;
        }
    }
    sum.iter_mut().for_each(|h| *h = h.max(0.0));
    sum
}

/// Returns the entropy of one stored posterior, with the same bits as [`entropies`].
pub(crate) fn entropy(probabilities: &[f32]) -> f32 {
    let minus = |sum: f32, p: &f32| sum - p * ln(&[*p])[0];
    probabilities.iter().fold(0.0, minus).max(0.0)
}

impl CoverageMap {
    /// Returns whether a measurement can change the cell with a row-major index: not if it is pinned.
    ///
    /// # Panics
    /// If there is no such cell.
    #[inline(always)]
    pub fn is_changeable(&self, index: usize) -> bool {
        self.evidence[index] != EvidenceKind::Pinned
    }

    /// Multiplies evidence into many cells at once, as [`Self::multiply`] does, but in f32. `cells`
    /// has the row-major index of the cell in each lane; no cell may appear twice or be pinned.
    /// Calls `changed` for every cell that was unknown or whose stored posterior changed, in the
    /// order of the lanes, with its lane and its entropies before and after \[nats\].
    ///
    /// For one measurement a posterior differs from that of f64 by less than 2e-6 of itself.
    ///
    /// # Panics
    /// If a cell lies outside the map, or the block is for another number of bins.
    #[inline(always)]
    pub fn multiply_block(
        &mut self,
        block: &mut EvidenceBlock,
        cells: &[u32; LANES],
        mut changed: impl FnMut(usize, f64, f64),
    ) {
        assert_eq!(block.prior.len(), self.bins, "one weight for each bin");
        block.load(&self.posterior, cells);
        block.multiply();
        let (entropy, mode) = (entropies(&block.weights), block.modes());
        let changed_lanes = block.store(&mut self.posterior, cells);
        for (lane, index) in cells.iter().enumerate() {
            if *index == EvidenceBlock::NO_CELL {
                continue;
            }
            let index = *index as usize;
            if changed_lanes[lane] || self.evidence[index] == EvidenceKind::Unknown {
                self.evidence[index] = EvidenceKind::Measured;
                let before = std::mem::replace(&mut self.entropy[index], entropy[lane]);
                #[allow(clippy::cast_possible_truncation, reason = "at most 64 bins")]
                (self.mode_bin[index] = mode[lane] as u8);
                changed(lane, f64::from(before), f64::from(entropy[lane]));
            }
        }
    }
}
