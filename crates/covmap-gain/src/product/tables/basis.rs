//! The few readings that stand for others as mixtures, and their gains, which are kept for every
//! cell.
//!
//! The evidence of a reading about a cell in front of its end depends on σ_out and γ only, whatever
//! the ring; so does its evidence about a cell behind, and that of no echo. Its gain is nearly a
//! mixture of the gains of a few readings, with the same weights for every histogram: the fitted
//! default needs 13 in front, 9 behind, and one without an echo. These few are evaluated when a
//! cell changes, and kept; a mixture takes a fifth of the time of an evaluation.

use super::spanning::SpanningSet;
use crate::belief::{Belief, BlockPrior};
use crate::evidence::{BinEvidence, BlockGains, ExcessEvidence};
use crate::numbers::to_f32;
use crate::probes::ProbeHistograms;
use covmap::lanes::{LANES, Lanes};
use pulp::Arch;
use rayon::prelude::*;
use std::ops::Range;

/// Largest error of the gain of a mixture, in units of the allowed error of an interpolated gain,
/// where the readings are those that tell most.
pub(super) const MIXTURE_TOLERANCE: f64 = 0.5;
/// Sample size used to estimate the size of the basis.
const SAMPLE: usize = 512;
/// The number of blocks of cells for one thread.
const BLOCKS: usize = 64;

/// Evaluation of the gain of an imagined reading.
#[derive(Debug, Clone)]
pub(crate) enum ReadingGain {
    /// Direct evaluation.
    Evaluated(ExcessEvidence),
    /// Mixture of the basis, from its `first` reading on.
    Mixed { first: usize, weights: Vec<f32> },
}

/// Many readings as mixtures of a part of the basis. They are taken from the front, one after the
/// other.
pub(crate) struct MixtureQueue {
    first: usize,
    /// For each reading the weight of every member.
    weights: Vec<Vec<f64>>,
    /// For each reading the gains of all probes, in units of their allowed errors.
    gains: Vec<Vec<f64>>,
    /// The number of readings that were taken.
    taken: usize,
}

/// The readings that stand for others as mixtures, and their gains.
#[derive(Debug, Clone, Default)]
pub(crate) struct Basis {
    readings: Vec<ExcessEvidence>,
    /// For every block of cells the gains of all readings, from one reading to the next.
    gains: Vec<Lanes>,
}

impl Basis {
    /// Takes some of these readings into the basis, as many as all of them need.
    pub(crate) fn extend(
        &mut self,
        readings: &[&BinEvidence],
        probes: &ProbeHistograms,
    ) -> MixtureQueue {
        let gains = probes.in_tolerances(readings);
        let SpanningSet { members, weights } = SpanningSet::of(&gains, MIXTURE_TOLERANCE);
        let first = self.readings.len();
        self.readings.extend(members.iter().map(|member| readings[*member].excess()));
        MixtureQueue { first, weights, gains, taken: 0 }
    }

    /// Extends the basis as [`extend`](Self::extend) does, unless a sample of the readings needs
    /// more than `most`.
    pub(crate) fn extend_by_few(
        &mut self,
        readings: &[&BinEvidence],
        probes: &ProbeHistograms,
        most: usize,
    ) -> Option<MixtureQueue> {
        let some: Vec<&BinEvidence> =
            readings.iter().step_by(readings.len() / SAMPLE + 1).copied().collect();
        let needed = SpanningSet::of(&probes.in_tolerances(&some), MIXTURE_TOLERANCE).members.len();
        (needed <= most).then(|| self.extend(readings, probes))
    }

    /// Makes room for the gains of a number of blocks of cells.
    pub(crate) fn make_room(&mut self, blocks: usize) {
        self.gains = vec![[0.0; LANES]; blocks * self.readings.len()];
    }

    /// Evaluates the basis in blocks of cells that changed, given in ascending order.
    pub(crate) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        let Self { readings, gains } = self;
        let portions = gains.par_chunks_mut((readings.len() * BLOCKS).max(1)).enumerate();
        portions.for_each(|(portion, gains)| {
            let place = |block: usize| changed.partition_point(|changed| *changed < block);
            let first = portion * BLOCKS;
            for block in &changed[place(first)..place(first + BLOCKS)] {
                let gains = &mut gains[(block - first) * readings.len()..];
                arch.dispatch(BlockGains { readings, prior: belief.prior(*block), gains });
            }
        });
    }

    /// Returns the gain of a reading in every cell of a block.
    #[inline(always)]
    pub(crate) fn gain(
        &self,
        reading: &ReadingGain,
        prior: &BlockPrior<'_>,
        block: usize,
    ) -> Lanes {
        match reading {
            ReadingGain::Evaluated(reading) => reading.gain(prior),
            ReadingGain::Mixed { first, weights } => {
                let mut gain = [0.0; LANES];
                for (gains, weight) in
                    self.gains[block * self.readings.len() + first..].iter().zip(weights)
                {
                    for lane in 0..LANES {
                        gain[lane] += gains[lane] * weight;
                    }
                }
                gain
            }
        }
    }
}

impl MixtureQueue {
    /// Takes the next readings, and returns their places.
    pub(crate) fn take(&mut self, count: usize) -> Range<usize> {
        self.taken += count;
        self.taken - count..self.taken
    }

    /// Takes the next reading, and returns its mixture.
    pub(crate) fn mix_next(&mut self) -> ReadingGain {
        let place = self.take(1).start;
        self.sum(&[(1.0, place)])
    }

    /// Returns the gains of all probes by a sum of readings, each times a factor, in units of their
    /// allowed errors.
    pub(crate) fn gains(&self, terms: &[(f64, usize)]) -> Vec<f64> {
        sum(&self.gains, terms)
    }

    /// Returns a sum of readings, each times a factor.
    pub(crate) fn sum(&self, terms: &[(f64, usize)]) -> ReadingGain {
        let weights = sum(&self.weights, terms).into_iter().map(to_f32).collect();
        ReadingGain::Mixed { first: self.first, weights }
    }
}

/// Returns a sum of vectors, each times a factor.
fn sum(vectors: &[Vec<f64>], terms: &[(f64, usize)]) -> Vec<f64> {
    let mut sum = vec![0.0; vectors.first().map_or(0, Vec::len)];
    for (factor, place) in terms {
        sum.iter_mut().zip(&vectors[*place]).for_each(|(sum, x)| *sum += factor * x);
    }
    sum
}
