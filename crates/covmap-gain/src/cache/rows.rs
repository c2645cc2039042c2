//! What is done for one row of groups of view-points, for each kind of vector registers.

use super::{Group, State};
use crate::belief::Cells;
use crate::product::bound::Potentials;
use crate::product::sweep::{Row, Unit};
use crate::sight::{Ahead, Cone, as_f64};
use covmap::lanes::{LANES, Lanes};
use pulp::{Simd, WithSimd};

/// Looks ahead from the groups of a row whose sight or reasons are stale.
pub(super) struct Sight<'a> {
    pub(super) cones: &'a [Cone],
    pub(super) cells: &'a Cells,
    pub(super) here: usize,
    pub(super) wanted: &'a [u16],
    pub(super) groups: &'a mut [Group],
    pub(super) states: &'a mut [State],
    pub(super) in_sight: &'a mut [[u16; LANES]],
    pub(super) ahead: &'a mut Ahead,
}

impl WithSimd for Sight<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { cones, cells, here, wanted, groups, states, in_sight, ahead } = self;
        let beams = cones.len();
        let stale = |i: &usize| wanted[*i] & !groups[*i].sight != 0;
        let all: Vec<usize> = (0..wanted.len()).filter(stale).collect();
        for (beam, cone) in cones.iter().enumerate() {
            for &i in &all {
                let (here, wanted) = (here + i * LANES, wanted[i]);
                let (state, in_sight) =
                    (&mut states[i * beams + beam], &mut in_sight[i * beams + beam]);
                if wanted & !state.sight != 0 {
                    cone.look(cells, here, ahead);
                    *in_sight = cone.in_sight(ahead);
                    let before = if state.sight == 0 { 0 } else { state.horizon };
                    state.horizon = before.max(cone.dependency(ahead, wanted));
                    state.sight |= wanted;
                    state.reason = 0;
                }
                if wanted & !state.reason != 0 {
                    state.has_reason = cone.reasons(cells, here, in_sight, state.sight);
                    state.reason = state.sight;
                }
            }
        }
        for i in all {
            let states = &states[i * beams..(i + 1) * beams];
            groups[i].sight = states.iter().fold(u16::MAX, |all, s| all & s.sight & s.reason);
            groups[i].has_reason = states.iter().fold(0, |any, s| any | s.has_reason);
        }
    }
}

/// Looks ahead along the beams of a row whose gains are stale.
pub(super) struct Likely<'a> {
    pub(super) cones: &'a [Cone],
    pub(super) cells: &'a Cells,
    pub(super) here: usize,
    pub(super) wanted: &'a [u16],
    pub(super) states: &'a [State],
    pub(super) y: usize,
    pub(super) ahead: &'a mut Ahead,
}

impl WithSimd for Likely<'_> {
    type Output = Row;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Row {
        let Self { cones, cells, here, wanted, states, y, ahead } = self;
        let mut row = Row { y, ..Row::default() };
        for (beam, cone) in cones.iter().enumerate() {
            for (group, wanted) in wanted.iter().enumerate() {
                let known = states[group * cones.len() + beam].gain;
                if wanted & !known == 0 {
                    continue;
                }
                cone.look(cells, here + group * LANES, ahead);
                let first = row.outcomes.len();
                ahead.likely(*wanted, |k, p| {
                    row.outcomes.push(k);
                    row.probabilities.push(p);
                });
                row.units.push(Unit { group, beam, likely: first..row.outcomes.len() });
            }
        }
        row
    }
}

/// Bounds the gains of the beams of a row that are stale.
pub(super) struct Bounds<'a> {
    pub(super) cones: &'a [Cone],
    pub(super) cells: &'a Cells,
    pub(super) potentials: &'a Potentials,
    pub(super) here: usize,
    pub(super) wanted: &'a [u16],
    pub(super) groups: &'a mut [Group],
    pub(super) states: &'a mut [State],
    pub(super) gain: &'a mut [Lanes],
    pub(super) mean: &'a mut [[f64; LANES]],
    pub(super) ahead: &'a mut Ahead,
}

impl WithSimd for Bounds<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { cones, cells, potentials, here, wanted, groups, states, gain, mean, ahead } =
            self;
        let beams = cones.len();
        let stale = |i: &usize| wanted[*i] & !groups[*i].bound != 0;
        let all: Vec<usize> = (0..wanted.len()).filter(stale).collect();
        for (beam, cone) in cones.iter().enumerate() {
            for &i in &all {
                let (state, gain) = (&mut states[i * beams + beam], &mut gain[i * beams + beam]);
                if wanted[i] & !state.bound == 0 {
                    continue;
                }
                let here = here + i * LANES;
                cone.look(cells, here, ahead);
                let bound = potentials.bound(cone, here, ahead);
                for lane in 0..LANES {
                    let exact = state.gain >> lane & 1 == 1;
                    gain[lane] = if exact { gain[lane] } else { bound[lane] };
                }
                state.bound |= wanted[i];
            }
        }
        for i in all {
            mean[i] = average(&gain[i * beams..(i + 1) * beams]);
            (groups[i].gain, groups[i].bound) = up_to_date(&states[i * beams..(i + 1) * beams]);
        }
    }
}

/// For which view-points the gains of all beams are up to date, and the bounds.
pub(super) fn up_to_date(states: &[State]) -> (u16, u16) {
    let both = |(gain, bound), state: &State| (gain & state.gain, bound & state.bound);
    states.iter().fold((u16::MAX, u16::MAX), both)
}

/// The average over the beams.
pub(super) fn average(gains: &[Lanes]) -> [f64; LANES] {
    let mut sum = [0.0; LANES];
    for gains in gains {
        for lane in 0..LANES {
            sum[lane] += f64::from(gains[lane]);
        }
    }
    sum.map(|gain| gain / as_f64(gains.len()))
}
