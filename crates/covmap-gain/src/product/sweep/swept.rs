//! Rows of view-points on their way from ring to ring.

use super::planes::Layout;
use super::sums::mix_outcomes;
use crate::numbers::to_f32;
use crate::outcomes::{AskedRow, BeamAnswer, GroupBeam, RowGains};
use crate::product::tables::rings::DistanceRing;
use covmap::lanes::{LANES, TOGETHER, add_product};
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// The number of beams of a row that are prepared together and then summed.
const BEAMS_TOGETHER: usize = 16;

/// A row that is asked for, at one ring after the other.
pub(super) struct SweptRow<'a> {
    pub(super) asked: &'a AskedRow,
    /// The beams of the row, in its order.
    pub(super) beams: Vec<SweptBeam>,
}

/// A beam of a group at one ring after the other.
pub(super) struct SweptBeam {
    /// Its outcomes but for those that end before the present ring.
    left: Range<usize>,
    /// Its outcomes at the present ring.
    pub(super) split: OutcomeSplit,
    /// Sum of all rings so far.
    gain: [f64; LANES],
}

/// A beam's outcomes, by the position of their end relative to a ring: places in its row's
/// outcomes.
#[derive(Debug, Clone, Default)]
pub(super) struct OutcomeSplit {
    pub(super) near: Range<usize>,
    pub(super) beyond: Range<usize>,
    pub(super) no_echo: Option<usize>,
}

impl<'a> SweptRow<'a> {
    pub(super) fn new(asked: &'a AskedRow) -> Self {
        let begin = |beam: &GroupBeam| SweptBeam {
            left: beam.outcomes.clone(),
            split: OutcomeSplit::default(),
            gain: [0.0; LANES],
        };
        Self { asked, beams: asked.beams.iter().map(begin).collect() }
    }

    pub(super) fn gains(self) -> RowGains {
        // The gain of a single cell by all outcomes together is unknown: any cell may gain enough.
        let answer = |beam: SweptBeam| BeamAnswer {
            gain: beam.gain.map(to_f32),
            promise: [f32::INFINITY; LANES],
        };
        self.beams.into_iter().map(answer).collect()
    }
}

impl SweptBeam {
    /// Moves on to a ring. `outcomes` are the row's; `no_echo` is the outcome without an echo.
    pub(super) fn advance(&mut self, ring: &DistanceRing, outcomes: &[usize], no_echo: usize) {
        let nearest = ring.near.first().map_or(0, |(k, _)| *k);
        let passed = outcomes[self.left.clone()].iter().take_while(|k| **k < nearest);
        self.left.start += passed.count();
        let (start, own) = (self.left.start, &outcomes[self.left.clone()]);
        let first_beyond = ring.beyond.as_ref().map_or(no_echo, |beyond| beyond.nearest);
        let echoes = own.len() - usize::from(own.last() == Some(&no_echo));
        let near = own[..echoes].iter().take_while(|k| **k < first_beyond).count();
        let reaches = echoes < own.len() && ring.no_echo.is_some();
        self.split = OutcomeSplit {
            near: start..start + near,
            beyond: start + near..start + echoes,
            no_echo: reaches.then_some(start + echoes),
        };
    }
}

/// Adds the part of the cells of a ring to every beam of a row.
pub(super) struct SumRing<'a, 'b> {
    pub(super) layout: Layout,
    pub(super) ring: &'a DistanceRing,
    /// For each beam of the stencil the offsets from a view-point to its cells in the planes.
    pub(super) offsets: &'a [Vec<isize>],
    pub(super) gains: &'a [f32],
    /// The row of the grid with which the planes begin, but for their border.
    pub(super) low: usize,
    pub(super) row: &'a mut SweptRow<'b>,
}

impl WithSimd for SumRing<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { layout, ring, offsets, gains, low, row } = self;
        let SweptRow { asked, beams: swept } = row;
        let AskedRow { y, beams, outcomes, probabilities } = asked;
        let start = (y - low + layout.border) * layout.row + layout.border;
        let tables = ring.beyond.as_ref().map_or(&[][..], |beyond| &beyond.weights);
        let mut reading_weights = vec![[[0.0; LANES]; TOGETHER]; BEAMS_TOGETHER * tables.len()];
        for (beams, swept) in beams.chunks(BEAMS_TOGETHER).zip(swept.chunks_mut(BEAMS_TOGETHER)) {
            // First all that lies scattered in memory.
            for (i, SweptBeam { split, .. }) in swept.iter().enumerate() {
                let nearest = ring.beyond.as_ref().map_or(0, |beyond| beyond.nearest);
                let beyond = split.beyond.clone();
                let likely = outcomes[beyond.clone()].iter().zip(&probabilities[beyond]);
                for (table, weights) in tables.iter().enumerate() {
                    reading_weights[i * tables.len() + table] =
                        mix_outcomes(likely.clone(), nearest, weights);
                }
            }
            for (i, (beam, SweptBeam { split, gain: total, .. })) in
                beams.iter().zip(swept).enumerate()
            {
                let mut of_ring = [0.0; LANES];
                let gain = &mut of_ring;
                let cells = &offsets[beam.beam][ring.cells[beam.beam].clone()];
                let place = (start + beam.group * LANES, layout.stride);
                if let Some(beyond) = ring.beyond.as_ref().filter(|_| !split.beyond.is_empty()) {
                    let weights = &reading_weights[i * tables.len()..(i + 1) * tables.len()];
                    beyond.add(gain, weights, beam.beam, cells, gains, place);
                }
                let near = split.near.clone();
                for (k, p) in outcomes[near.clone()].iter().zip(&probabilities[near]) {
                    if let Some((_, readings)) = ring.near.iter().find(|(near, _)| near == k) {
                        add_product(gain, p, &readings.sum(beam.beam, cells, gains, place));
                    }
                }
                if let Some((readings, k)) = ring.no_echo.as_ref().zip(split.no_echo) {
                    let sum = readings.sum(beam.beam, cells, gains, place);
                    add_product(gain, &probabilities[k], &sum);
                }
                for lane in 0..LANES {
                    total[lane] += f64::from(of_ring[lane]);
                }
            }
        }
    }
}
