//! [`covmap_model::Causes`] of one beam from a group of view-points, side by side.

use super::at;
use super::beam::{CauseBeam, CauseCell, End, Surface};
use crate::belief::lanes_at;
use crate::numbers::{as_f64, to_f32};
use covmap::lanes::{LANES, Lanes, exp, ln, map};
use covmap_model::CauseParameters;

/// The largest number of bearings.
const MOST: usize = 16;

/// The causes of a beam's outcomes, which the caller asks for in order of their range.
pub(super) struct GroupCauses<'a> {
    parameters: &'a CauseParameters,
    /// Novelty of a reading.
    novelty: &'a Lanes,
    /// The number of cells that are passed.
    passed: usize,
    /// v_m, and whether any is below 1.
    clear: [Lanes; MOST],
    is_hidden: bool,
    /// c_m.
    ended: [Lanes; MOST],
    /// L.
    pub(super) any: Lanes,
}

impl<'a> GroupCauses<'a> {
    #[inline(always)]
    pub(super) fn new(parameters: &'a CauseParameters, novelty: &'a Lanes) -> Self {
        let (clear, none) = ([[1.0; LANES]; MOST], [0.0; LANES]);
        let (passed, is_hidden) = (0, false);
        Self { parameters, novelty, passed, clear, is_hidden, ended: [none; MOST], any: none }
    }

    /// Returns c_m of the bearing of a cell.
    #[inline(always)]
    pub(super) fn ended(&self, cell: &CauseCell) -> &Lanes {
        &self.ended[cell.bearing]
    }

    /// Takes the first cells of a beam, `cells`, as passed: the clear view is as they leave it.
    #[inline(always)]
    pub(super) fn pass(&mut self, clear: &[f32], cells: &[CauseCell], here: usize) {
        for cell in cells.get(self.passed..).unwrap_or_default() {
            let clear = at(clear, here, cell);
            if clear.iter().any(|clear| *clear < 1.0) {
                self.is_hidden = true;
                let view = &mut self.clear[cell.bearing];
                for lane in 0..LANES {
                    view[lane] *= clear[lane];
                }
            }
        }
        self.passed = self.passed.max(cells.len());
    }

    /// S.
    #[inline(always)]
    fn first(&self) -> Lanes {
        let bearings = self.parameters.bearings;
        if !self.is_hidden {
            return [1.0; LANES];
        }
        let mut mean = [0.0; LANES];
        for clear in &self.clear[..bearings] {
            for lane in 0..LANES {
                mean[lane] += clear[lane];
            }
        }
        let (each, power) = (to_f32(1.0 / as_f64(bearings)), to_f32(self.parameters.first_echo));
        let log = ln(&map(&mean, |mean| (mean * each).max(1e-30)));
        exp(&map(&log, |log| (log * power).max(-80.0)))
    }

    /// Finds c_m and L of an echo.
    #[inline(always)]
    pub(super) fn explain(&mut self, surface: &[f32], beam: &CauseBeam, end: &End, here: usize) {
        let bearings = self.parameters.bearings;
        let ended = &mut self.ended[..bearings];
        ended.fill([0.0; LANES]);
        let (begin, after) = end.surfaces;
        for of_bearing in beam.surfaces[begin..after].chunk_by(|a, b| a.bearing == b.bearing) {
            let mut likeliest = [0.0; LANES];
            for Surface { offset, nearness, .. } in of_bearing {
                let surface = lanes_at(surface, here.wrapping_add_signed(*offset));
                for lane in 0..LANES {
                    let surface = nearness * surface[lane];
                    likeliest[lane] =
                        if surface > likeliest[lane] { surface } else { likeliest[lane] };
                }
            }
            ended[of_bearing[0].bearing] = likeliest;
        }
        let (first, mut sum) = (self.first(), [0.0; LANES]);
        let ended = &mut self.ended[..bearings];
        for (ended, clear) in ended.iter_mut().zip(&self.clear) {
            for lane in 0..LANES {
                ended[lane] *= first[lane] * clear[lane];
                sum[lane] += ended[lane];
            }
        }
        let chance = to_f32(self.parameters.chance);
        let mut share = map(&sum, |sum| 1.0 / (sum + chance));
        share.iter_mut().zip(self.novelty).for_each(|(share, novelty)| *share *= novelty);
        for lane in 0..LANES {
            self.any[lane] = sum[lane] * share[lane];
        }
        for ended in ended {
            for lane in 0..LANES {
                ended[lane] *= share[lane];
            }
        }
    }

    /// Returns L without an echo.
    #[inline(always)]
    pub(super) fn of_no_echo(&self) -> Lanes {
        let share = to_f32(self.parameters.no_echo.share);
        let mut any = self.first();
        any.iter_mut().zip(self.novelty).for_each(|(any, novelty)| *any *= share * novelty);
        any
    }
}
