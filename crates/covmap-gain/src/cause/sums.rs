//! A beam's sums over its outcomes and cells, from a group of view-points side by side.

use super::beam::{CauseBeam, CauseCell, End};
use super::causes::GroupCauses;
use super::ceilings::Ceilings;
use super::fronts::{Front, FrontSums};
use super::{Cause, at};
use crate::belief::{Belief, lanes_at, padded};
use crate::largest::Largest;
use crate::outcomes::{AskedRow, BeamAnswer, RowGains};
use covmap::lanes::{LANES, Lanes, add_product};
use pulp::{Simd, WithSimd};

/// The gains and promises of one row.
pub(super) struct GainsOfRow<'a> {
    pub(super) cause: &'a Cause,
    pub(super) belief: &'a Belief,
    pub(super) row: &'a AskedRow,
    pub(super) least: f32,
}

impl WithSimd for GainsOfRow<'_> {
    type Output = RowGains;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> RowGains {
        let Self { cause, belief, row, least } = self;
        let (mut fronts, mut answers) = (Vec::new(), Vec::with_capacity(row.beams.len()));
        let mut cells = EachCell::default();
        // A closure would be compiled for narrower registers.
        for asked in &row.beams {
            let group = GroupSum { cause, belief, y: row.y, x: asked.group * LANES };
            let outcomes = &row.outcomes[asked.outcomes.clone()];
            let probabilities = &row.probabilities[asked.outcomes.clone()];
            cells.clear(cause.beams[asked.beam].cells.len());
            group.sum::<true>(asked.beam, (outcomes, probabilities), &mut fronts, &mut cells);
            answers.push(BeamAnswer {
                gain: cells.total(),
                promise: group.promise(asked.beam, &cells, least),
            });
        }
        answers
    }
}

/// The largest expected changes of the cells from the view-points of one row, compared with those
/// found so far.
pub(super) struct LargestOfRow<'a> {
    pub(super) cause: &'a Cause,
    pub(super) belief: &'a Belief,
    pub(super) row: &'a AskedRow,
    /// The view-points that are asked for, a bit for each of a group.
    pub(super) wanted: &'a [u16],
    pub(super) largest: &'a mut Largest,
}

impl WithSimd for LargestOfRow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { cause, belief, row, wanted, largest } = self;
        let (width, mut fronts, mut cells) = (cause.grid.width(), Vec::new(), EachCell::default());
        for asked in &row.beams {
            let group = GroupSum { cause, belief, y: row.y, x: asked.group * LANES };
            let outcomes = &row.outcomes[asked.outcomes.clone()];
            let probabilities = &row.probabilities[asked.outcomes.clone()];
            let beam = &cause.beams[asked.beam];
            cells.clear(beam.cells.len());
            group.sum::<true>(asked.beam, (outcomes, probabilities), &mut fronts, &mut cells);
            for (cell, changes) in beam.cells.iter().zip(&cells.0) {
                let Some((y, x)) = group.place(cell) else { continue };
                for lane in (0..LANES).filter(|lane| wanted[asked.group] >> lane & 1 == 1) {
                    let Some(x) = x.checked_add_unsigned(lane).filter(|x| *x >= 0) else {
                        continue;
                    };
                    if x.cast_unsigned() < width {
                        let from = row.y * width + group.x + lane;
                        largest.take(y * width + x.cast_unsigned(), (changes[lane], from));
                    }
                }
            }
        }
    }
}

/// Sums of the gains of a beam's cells by its outcomes.
pub(super) trait CellSums {
    /// Adds the gain of a cell by outcomes of a probability.
    fn add(&mut self, cell: usize, probability: &Lanes, gain: &Lanes);
}

/// Sums over all cells, and over those that are reasons to measure.
pub(super) struct AllAndReasons<'a> {
    cells: &'a [CauseCell],
    limits: &'a [f32],
    /// The first view-point in the bordered rasters.
    here: usize,
    pub(super) answer: BeamAnswer,
}

impl<'a> AllAndReasons<'a> {
    pub(super) fn of(cells: &'a [CauseCell], (limits, here): (&'a [f32], usize)) -> Self {
        Self { cells, limits, here, answer: BeamAnswer::all(0.0, 0.0) }
    }
}

impl CellSums for AllAndReasons<'_> {
    #[inline(always)]
    fn add(&mut self, cell: usize, probability: &Lanes, gain: &Lanes) {
        add_product(&mut self.answer.gain, probability, gain);
        let cell = &self.cells[cell];
        let limit = at(self.limits, self.here, cell);
        let mut counts = [0.0; LANES];
        for lane in 0..LANES {
            counts[lane] = if cell.distance <= limit[lane] { probability[lane] } else { 0.0 };
        }
        add_product(&mut self.answer.promise, &counts, gain);
    }
}

/// A sum for each cell.
#[derive(Default)]
struct EachCell(Vec<Lanes>);

impl CellSums for EachCell {
    #[inline(always)]
    fn add(&mut self, cell: usize, probability: &Lanes, gain: &Lanes) {
        add_product(&mut self.0[cell], probability, gain);
    }
}

impl EachCell {
    fn clear(&mut self, cells: usize) {
        self.0.clear();
        self.0.resize(cells, [0.0; LANES]);
    }

    #[inline(always)]
    fn total(&self) -> Lanes {
        let mut total = [0.0; LANES];
        for cell in &self.0 {
            for lane in 0..LANES {
                total[lane] += cell[lane];
            }
        }
        total
    }
}

/// Probability of one outcome that is sure.
const SURE: Lanes = [1.0; LANES];

/// A beam's sums over its outcomes from a group of view-points. The first view-point is in column
/// `x` of row `y`.
pub(super) struct GroupSum<'a> {
    pub(super) cause: &'a Cause,
    pub(super) belief: &'a Belief,
    pub(super) y: usize,
    pub(super) x: usize,
}

impl GroupSum<'_> {
    /// Adds the expected gains of the cells of a beam, or upper bounds of them.
    #[inline(always)]
    pub(super) fn sum<const EXACT: bool>(
        &self,
        beam: usize,
        (outcomes, probabilities): (&[usize], &[Lanes]),
        fronts: &mut Vec<Front>,
        sums: &mut impl CellSums,
    ) {
        let cause = self.cause;
        let beam = &cause.beams[beam];
        let here = self.here();
        let novelty = lanes_at(&cause.novelty, self.y * padded(cause.grid.width()) + self.x);
        let mut causes = GroupCauses::new(&cause.parameters, novelty);
        fronts.clear();
        for (k, probability) in outcomes.iter().zip(probabilities) {
            let (cells, any) = if let Some(end) = beam.ends.get(*k) {
                causes.pass(&cause.clear, &beam.cells[..end.front], here);
                causes.explain(&cause.surface, beam, end, here);
                self.add_ends::<EXACT>(sums, (beam, end), &causes, probability);
                (end.front, causes.any)
            } else {
                let mut silent = GroupCauses::new(&cause.parameters, novelty);
                silent.pass(&cause.clear, &beam.cells[..beam.no_echo], here);
                (beam.no_echo, silent.of_no_echo())
            };
            fronts.push(Front { cells, probability: *probability, any });
        }
        match (self.bounds::<EXACT>(), &cause.front) {
            (Some(ceilings), _) => self.add_fronts(sums, beam, (fronts, ceilings.no_sums())),
            (_, Some(front)) => self.add_fronts(sums, beam, (fronts, front.no_sums())),
            _ => fronts.iter().for_each(|front| self.add_each_front(sums, beam, front)),
        }
    }

    /// Returns the expected gains of the cells that are reasons to measure and gain at least
    /// `least`.
    #[inline(always)]
    fn promise(&self, beam: usize, gains: &EachCell, least: f32) -> Lanes {
        let (limits, here) = (self.belief.limits(), self.here());
        let mut promise = [0.0; LANES];
        for (cell, gain) in self.cause.beams[beam].cells.iter().zip(&gains.0) {
            let limit = at(limits, here, cell);
            for lane in 0..LANES {
                let counts = gain[lane] >= least && cell.distance <= limit[lane];
                promise[lane] += if counts { gain[lane] } else { 0.0 };
            }
        }
        promise
    }

    /// Returns the index of the first view-point in the bordered rasters.
    #[inline(always)]
    fn here(&self) -> usize {
        self.belief.bordered(self.y * self.cause.grid.width()) + self.x
    }

    /// Adds the gains, or their bounds, of the cells at the end and behind it.
    #[inline(always)]
    fn add_ends<const EXACT: bool>(
        &self,
        sums: &mut impl CellSums,
        (beam, end): (&CauseBeam, &End),
        causes: &GroupCauses<'_>,
        probability: &Lanes,
    ) {
        let (at_end, bounds) = (&self.cause.at_end, self.bounds::<EXACT>());
        let near = beam.near[end.first..].iter().zip(end.front..end.ended);
        for (near, i) in near {
            let cell = &beam.cells[i];
            let Some((y, x)) = self.place(cell) else { continue };
            let ended = causes.ended(cell);
            let gain = if let Some(ceilings) = bounds {
                ceilings.of_end((y, x), (ended, &causes.any), (near.band, near.free))
            } else {
                at_end.gain(&self.belief.prior_at(y, x), near.kernel(), ended, &causes.any)
            };
            sums.add(i, probability, &gain);
        }
        for i in end.ended..end.reach {
            let cell = &beam.cells[i];
            let Some((y, x)) = self.place(cell) else { continue };
            let ended = causes.ended(cell);
            let gain = if let Some(ceilings) = bounds {
                ceilings.of_behind((y, x), ended, beam.behind_weight)
            } else if let Some(behind) = &self.cause.behind {
                behind.gain((y, x), ended, beam.behind_weight)
            } else {
                let (prior, kernel) =
                    (self.belief.prior_at(y, x), at_end.behind(beam.behind_weight));
                at_end.gain(&prior, kernel, ended, &causes.any)
            };
            sums.add(i, probability, &gain);
        }
    }

    /// Returns the ceilings, unless gains are asked for.
    #[inline(always)]
    fn bounds<const EXACT: bool>(&self) -> Option<&Ceilings> {
        self.cause.ceilings.as_ref().filter(|_| !EXACT)
    }

    /// Adds the gains, or their bounds, of the cells in front of the ends of all outcomes: from the
    /// farthest cell inwards, each for all outcomes at once.
    #[inline(always)]
    fn add_fronts(
        &self,
        sums: &mut impl CellSums,
        beam: &CauseBeam,
        (fronts, mut outcomes): (&mut [Front], impl FrontSums),
    ) {
        fronts.sort_by_key(|front| std::cmp::Reverse(front.cells));
        for number in 0..fronts.len() {
            let Front { cells, probability, any } = &fronts[number];
            outcomes.add(probability, any);
            let next = fronts.get(number + 1).map_or(0, |next| next.cells);
            for i in next..*cells {
                let cell = &beam.cells[i];
                let Some(place) = self.place(cell).filter(|_| cell.free > 0.0) else { continue };
                sums.add(i, &SURE, &outcomes.of_cell(place, cell.free));
            }
        }
    }

    /// Adds the gains of one outcome cell by cell.
    #[inline(always)]
    fn add_each_front(&self, sums: &mut impl CellSums, beam: &CauseBeam, front: &Front) {
        let at_end = &self.cause.at_end;
        for (i, cell) in beam.cells[..front.cells].iter().enumerate() {
            let Some((y, x)) = self.place(cell).filter(|_| cell.free > 0.0) else { continue };
            let (prior, kernel) = (self.belief.prior_at(y, x), at_end.passed(cell.free));
            let gain = at_end.gain(&prior, kernel, &[0.0; LANES], &front.any);
            sums.add(i, &front.probability, &gain);
        }
    }

    /// Returns row and column of a cell as the first view-point sees it; `None` if it is outside of
    /// the grid for the whole group.
    #[inline(always)]
    fn place(&self, cell: &CauseCell) -> Option<(usize, isize)> {
        let grid = &self.cause.grid;
        let y = self.y.wrapping_add_signed(cell.dy);
        let x = self.x.cast_signed() + cell.dx;
        let is_inside =
            y < grid.height() && x > -LANES.cast_signed() && x < grid.width().cast_signed();
        is_inside.then_some((y, x))
    }
}
