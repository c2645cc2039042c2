//! Multiplying evidence into many cells side by side.

use super::Evidence;
use crate::CoverageMap;
use crate::histogram::{MAX_BINS, PROBABILITY_FLOOR, TIE};
use crate::lanes::{LANES, Lanes, TOGETHER, flat, ln};

/// Evidence for up to [`LANES`] different cells, side by side, to be multiplied into a map.
#[derive(Debug, Clone)]
pub struct EvidenceBlock {
    /// For each bin the weights of all cells; then their posteriors. And up to a multiple of
    /// [`TOGETHER`] bins that do not matter.
    weights: Vec<[Lanes; TOGETHER]>,
    prior: Vec<Lanes>,
}

impl EvidenceBlock {
    /// A lane without a cell.
    pub const NO_CELL: u32 = u32::MAX;

    /// A block for maps with a number of bins, at most [`MAX_BINS`].
    pub fn new(bins: usize) -> Self {
        let bins = bins.min(MAX_BINS);
        let ones = [1.0; LANES];
        let weights = vec![[ones; TOGETHER]; bins.div_ceil(TOGETHER)];
        Self { weights, prior: vec![ones; bins] }
    }

    /// For each bin a row.
    #[inline(always)]
    fn rows(&self) -> &[Lanes] {
        &self.weights.as_flattened()[..self.prior.len()]
    }

    /// For each bin the weights of all lanes, in proportion to p(c_l | d): to be filled in
    /// before the block is multiplied. They must be finite, not negative, and the largest of
    /// a cell must lie between 1e-3 and 1e3. Some bins past the last one do not matter.
    #[inline(always)]
    pub fn weights(&mut self) -> &mut [[Lanes; TOGETHER]] {
        &mut self.weights
    }

    /// Copies the cells' posteriors, transposed. Not inlined: with wide registers the compiler
    /// would gather, at twice the time.
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

    /// The product of prior and evidence, Eq. (8), normalised over the floor; in place of the
    /// weights.
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

    /// The bins of the modes, the first of several: see [`crate::mode_bin`].
    #[inline(always)]
    fn modes(&self) -> Lanes {
        let (mut best, mut mode) = (self.rows()[0], [0.0f32; LANES]);
        let mut bin = 0.0;
        for w in &self.rows()[1..] {
            bin += 1.0;
            for lane in 0..LANES {
                let larger = w[lane] > best[lane] * (1.0 + TIE);
                mode[lane] = if larger { bin } else { mode[lane] };
                best[lane] = if larger { w[lane] } else { best[lane] };
            }
        }
        mode
    }

    /// Copies the posteriors back. Returns for each lane whether a bit of it is different. Not
    /// inlined, as [`Self::load`].
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

/// The entropies of [`LANES`] normalised distributions, Eq. (11) \[nats\]: with 11 bins each
/// to within 2e-6, with 64 to within 1e-5.
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

/// The entropy of one stored posterior: the same bits as [`entropies`] gives.
pub(crate) fn entropy(probabilities: &[f32]) -> f32 {
    let minus = |sum: f32, p: &f32| sum - p * ln(&[*p])[0];
    probabilities.iter().fold(0.0, minus).max(0.0)
}

impl CoverageMap {
    /// Whether a measurement can change the cell with a row-major index: not if it is pinned.
    ///
    /// # Panics
    /// If there is no such cell.
    #[inline(always)]
    pub fn is_changeable(&self, index: usize) -> bool {
        self.evidence[index] != Evidence::Pinned
    }

    /// [`Self::multiply`] for many cells at once, in f32: those with the given row-major
    /// indices, each in its lane, no cell twice and none that is pinned. Calls `changed` for every cell whose
    /// stored posterior changed, in the order of the lanes, with its lane and its entropies
    /// before and after \[nats\].
    ///
    /// A posterior differs from that of f64 by less than 2e-6 of itself for a measurement.
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
            if changed_lanes[lane] || self.evidence[index] == Evidence::Unknown {
                self.evidence[index] = Evidence::Measured;
                let before = std::mem::replace(&mut self.entropy[index], entropy[lane]);
                #[allow(clippy::cast_possible_truncation, reason = "at most 64 bins")]
                (self.mode_bin[index] = mode[lane] as u8);
                changed(lane, f64::from(before), f64::from(entropy[lane]));
            }
        }
    }
}
