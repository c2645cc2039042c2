//! The work for one row of groups of view-points, compiled for each kind of vector registers.
//!
//! `here` is always the index of the row's first view-point in the bordered rasters, and `wanted` has
//! a bit for each view-point of each group.

use super::staleness::{BeamState, GroupState};
use crate::belief::Belief;
use crate::evaluator::Evaluator;
use crate::numbers::as_f64;
use crate::outcomes::{AskedRow, BeamAnswer, GroupBeam};
use crate::sight::{GroupLikelihood, RasterBeam};
use covmap::lanes::LANES;
use pulp::{Simd, WithSimd};

/// Brings sight and reasons of a row's groups up to date.
pub(super) struct RefreshSight<'a> {
    pub(super) beams: &'a [RasterBeam],
    pub(super) belief: &'a Belief,
    pub(super) here: usize,
    pub(super) wanted: &'a [u16],
    pub(super) groups: &'a mut [GroupState],
    pub(super) states: &'a mut [BeamState],
    pub(super) in_sight: &'a mut [[u16; LANES]],
    pub(super) likelihood: &'a mut GroupLikelihood,
}

impl WithSimd for RefreshSight<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { beams, belief, here, wanted, groups, states, in_sight, likelihood } = self;
        let count = beams.len();
        let stale = |i: &usize| wanted[*i] & !groups[*i].sight != 0;
        let all: Vec<usize> = (0..wanted.len()).filter(stale).collect();
        for (number, beam) in beams.iter().enumerate() {
            for &i in &all {
                let (here, wanted) = (here + i * LANES, wanted[i]);
                let (state, in_sight) =
                    (&mut states[i * count + number], &mut in_sight[i * count + number]);
                if wanted & !state.sight != 0 {
                    beam.predict(belief, here, likelihood);
                    *in_sight = beam.in_sight(likelihood);
                    let before = if state.sight == 0 { 0 } else { state.horizon };
                    state.horizon = before.max(beam.horizon(belief, likelihood, wanted));
                    state.sight |= wanted;
                    state.reason = 0;
                }
                if wanted & !state.reason != 0 {
                    state.has_reason = beam.reasons(belief, here, in_sight, state.sight);
                    state.reason = state.sight;
                }
            }
        }
        for i in all {
            let states = &states[i * count..(i + 1) * count];
            groups[i].sight = states.iter().fold(u16::MAX, |all, s| all & s.sight & s.reason);
            groups[i].has_reason = states.iter().fold(0, |any, s| any | s.has_reason);
        }
    }
}

/// Asks for the gains of a row's beams that are stale, with their likely outcomes.
pub(super) struct AskOutcomes<'a> {
    pub(super) beams: &'a [RasterBeam],
    pub(super) belief: &'a Belief,
    pub(super) here: usize,
    pub(super) wanted: &'a [u16],
    pub(super) states: &'a [BeamState],
    pub(super) y: usize,
    pub(super) likelihood: &'a mut GroupLikelihood,
}

impl WithSimd for AskOutcomes<'_> {
    type Output = AskedRow;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> AskedRow {
        let Self { beams, belief, here, wanted, states, y, likelihood } = self;
        let mut row = AskedRow { y, ..AskedRow::default() };
        for (number, beam) in beams.iter().enumerate() {
            for (group, wanted) in wanted.iter().enumerate() {
                let known = states[group * beams.len() + number].gain;
                if wanted & !known == 0 {
                    continue;
                }
                beam.predict_gain(belief, here + group * LANES, likelihood);
                let first = row.outcomes.len();
                likelihood.for_each_likely(*wanted, |k, p| {
                    row.outcomes.push(k);
                    row.probabilities.push(p);
                });
                let outcomes = first..row.outcomes.len();
                row.beams.push(GroupBeam { group, beam: number, outcomes });
            }
        }
        row
    }
}

/// Brings the bounds of a row's groups up to date where the gains are not.
pub(super) struct RefreshBounds<'a> {
    pub(super) beams: &'a [RasterBeam],
    pub(super) belief: &'a Belief,
    pub(super) evaluator: &'a Evaluator,
    pub(super) here: usize,
    pub(super) wanted: &'a [u16],
    pub(super) groups: &'a mut [GroupState],
    pub(super) states: &'a mut [BeamState],
    pub(super) answers: &'a mut [BeamAnswer],
    pub(super) mean: &'a mut [[f64; LANES]],
    pub(super) likelihood: &'a mut GroupLikelihood,
}

impl WithSimd for RefreshBounds<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            beams,
            belief,
            evaluator,
            here,
            wanted,
            groups,
            states,
            answers,
            mean,
            likelihood,
        } = self;
        let count = beams.len();
        let stale = |i: &usize| wanted[*i] & !groups[*i].bound != 0;
        let all: Vec<usize> = (0..wanted.len()).filter(stale).collect();
        for (number, beam) in beams.iter().enumerate() {
            for &i in &all {
                let (state, kept) =
                    (&mut states[i * count + number], &mut answers[i * count + number]);
                if wanted[i] & !state.bound == 0 {
                    continue;
                }
                let here = here + i * LANES;
                beam.predict_gain(belief, here, likelihood);
                let bound = evaluator.bound(belief, (number, beam), here, likelihood);
                for lane in 0..LANES {
                    let exact = state.gain >> lane & 1 == 1;
                    kept.gain[lane] = if exact { kept.gain[lane] } else { bound.gain[lane] };
                    kept.promise[lane] =
                        if exact { kept.promise[lane] } else { bound.promise[lane] };
                }
                state.bound |= wanted[i];
            }
        }
        for i in all {
            mean[i] = average(&answers[i * count..(i + 1) * count]);
            up_to_date(&mut groups[i], &states[i * count..(i + 1) * count]);
        }
    }
}

/// Records for which view-points of a group the gains, and the bounds, of all beams are up to date.
pub(super) fn up_to_date(group: &mut GroupState, states: &[BeamState]) {
    group.gain = states.iter().fold(u16::MAX, |all, state| all & state.gain);
    group.bound = states.iter().fold(u16::MAX, |all, state| all & state.bound);
}

/// Returns the average over the beams, of each view-point of a group.
pub(super) fn average(answers: &[BeamAnswer]) -> [f64; LANES] {
    let mut sum = [0.0; LANES];
    for answer in answers {
        for (sum, gain) in sum.iter_mut().zip(&answer.gain) {
            *sum += f64::from(*gain);
        }
    }
    sum.map(|gain| gain / as_f64(answers.len()))
}
