//! The planner: the owner of the exploration, the stalls and the gain cache.

mod cost;
mod driving;
mod search;

use crate::decision::{Contest, REPORTED, Score};
use crate::exploration::{CountedScan, Exploration};
use crate::measured::Measured;
use crate::parameters::LeastChange;
use crate::traversable::Traversable;
use crate::turning::straight;
use crate::window::Window;
use crate::{
    BodyEvidence, CandidateRecord, Decision, PlannerError, PlannerParameters, Scope, Strategy,
    TravelCosts, travel_costs,
};
use crate::{Scoring, Situation};
use covmap::{Cell, Change, CoverageMap, Grid, Raster};
use covmap_gain::{
    GAIN_TOLERANCE, GainCache, RangePrediction, Stencil, ViewPoints, expected_information_gain,
};
use covmap_model::{SensorModel, cells_under_body, intercepted};
use covmap_sonar::Scan;
use nalgebra::{Point2, Vector2};
use rayon::prelude::*;
use search::Search;

/// Planner that chooses view-points by the strategies of section 4, and knows when all is explored.
///
/// All maps must be on the grid of `outside` in [`Planner::new`], and all scans must have one reading
/// for each beam; the planner panics if they do not fit.
///
/// The caller reports every event ([`observe`], [`body_moved`], [`stand_on`], [`drove`], [`bump`]), then
/// asks the planner to [`choose`].
///
/// [`observe`]: Planner::observe
/// [`body_moved`]: Planner::body_moved
/// [`stand_on`]: Planner::stand_on
/// [`drove`]: Planner::drove
/// [`bump`]: Planner::bump
/// [`choose`]: Planner::choose
#[derive(Debug, Clone)]
pub struct Planner {
    pub(crate) parameters: PlannerParameters,
    pub(crate) model: SensorModel,
    pub(crate) grid: Grid,
    pub(crate) radius: f64,
    pub(crate) traversable: Traversable,
    pub(crate) exploration: Exploration,
    pub(crate) gains: GainCache,
    pub(crate) measured: Measured,
    /// The share of a reading from each view-point that would be new.
    novelty: Vec<f64>,
    /// What a scan must be expected to change, if the parameters ask for it.
    pub(crate) least_change: Option<LeastChange>,
    pub(crate) window: Option<Window>,
    /// While driving, the least distance of a target from the last scan \[m\], if there is such a target.
    apart: Option<f64>,
    last_scan: Option<Point2<f64>>,
    /// Whether decisions tell the gains of their best candidates in any case.
    explains: bool,
    /// The direction in which the robot drove last.
    pub(crate) ahead: Option<Vector2<f64>>,
    /// The chosen view-point, and the cells in sight of it when it was chosen.
    target: Option<(Cell, Vec<(usize, f32)>)>,
}

/// L(c): the candidates, with the way to each.
pub(crate) struct Candidates {
    pub(crate) indices: Vec<usize>,
    pub(crate) costs: TravelCosts,
    /// The cells that look blocked on the way to all of them.
    pub(crate) passage: Vec<usize>,
}

impl Planner {
    /// Returns a planner that knows nothing yet.
    ///
    /// `outside` marks the cells outside of the environment's extent, which need not be explored; `radius`
    /// is the robot's radius \[m\], `heading` the direction that its ring keeps \[rad\].
    ///
    /// # Errors
    /// If a parameter, the radius or the heading is outside its interval.
    pub fn new(
        parameters: &PlannerParameters,
        model: &SensorModel,
        outside: &Raster<bool>,
        radius: f64,
        heading: f64,
    ) -> Result<Self, PlannerError> {
        parameters.validate()?;
        PlannerError::within("radius", radius, 0.0, 1e3)?;
        PlannerError::within("heading", heading, -1e9, 1e9)?;
        let grid = *outside.grid();
        let least_change = parameters.least_change(grid.resolution());
        let (prediction, upkeep) = (parameters.range_prediction(), parameters.upkeep());
        let gains = GainCache::new(model, heading, grid, prediction, upkeep)?
            .with_least_change(least_change.map_or(0.0, |least| least.cell));
        let window = match parameters.strategy {
            Strategy::IgWin { radius } => Some(Window::new(grid, radius)),
            _ => None,
        };
        let usable_range = model.parameters().usable_range;
        let counts = parameters.strategy.counting().is_some();
        let scan_spacing = if counts { 0.0 } else { parameters.scan_spacing };
        let mut planner = Self {
            exploration: Exploration::new(parameters, usable_range, outside),
            traversable: Traversable::new(grid, radius),
            parameters: parameters.clone(),
            model: model.clone(),
            grid,
            radius,
            gains,
            measured: Measured::new(grid, scan_spacing),
            apart: None,
            last_scan: None,
            explains: true,
            novelty: vec![1.0; grid.len()],
            least_change,
            window,
            ahead: None,
            target: None,
        };
        if let Ok(unknown) = CoverageMap::new(grid, model.parameters().bins) {
            (0..grid.len()).for_each(|index| planner.update_limit(&unknown, index));
        }
        Ok(planner)
    }

    /// Takes note of a scan that was integrated into the map, and of its changes.
    ///
    /// The scan counts for the unfinished cells that it should have seen: V(l) before the scan, where l
    /// is the view-point whose cell holds the scan's pose. If l is the chosen view-point, V(l) is as it was
    /// at the decision.
    pub fn observe(&mut self, map: &CoverageMap, scan: &Scan, changes: &[Change]) {
        let at = self.grid.cell_at(scan.pose.translation.vector.into());
        let in_sight = match (self.target.take(), at) {
            (Some((target, in_sight)), Some(at)) if target == at => in_sight,
            (target, at) => {
                self.target = target;
                at.map_or_else(Vec::new, |at| self.cells_in_sight(at))
            }
        };
        let expected: Vec<CountedScan> = in_sight
            .iter()
            .filter(|(index, distance)| self.is_reason(*index, *distance))
            .map(|&(index, distance)| {
                let before = self.gains.entropy(index);
                CountedScan { index, distance, before, after: before }
            })
            .collect();
        let weights: Vec<f64> = expected.iter().map(|s| self.exploration.weight(s.index)).collect();
        self.exploration.add_counts(|| intercepted(&self.model, &self.grid, scan));
        self.note_look(scan.pose.translation.vector.into());
        self.take_over(map, changes);
        for (scan, weight) in expected.into_iter().zip(weights) {
            let touched = self.exploration.weight(scan.index) > weight;
            let after = self.gains.entropy(scan.index);
            self.exploration.count(CountedScan { after, ..scan }, touched);
            self.update_limit(map, scan.index);
        }
        if self.parameters.strategy.counting().is_some() {
            self.update_limits(map);
        }
    }

    /// Takes note of the place of a scan: less of another scan from near there would be new.
    fn note_look(&mut self, at: Point2<f64>) {
        self.measured.note(at);
        self.last_scan = Some(at);
        let repeats = self.model.repeats();
        let around = Vector2::repeat(repeats.reach());
        for cell in self.grid.cells_between(at - around, at + around) {
            let Some(index) = self.grid.index(cell) else { continue };
            let left = repeats.left((self.grid.center(cell) - at).norm());
            if left < 1.0 {
                self.novelty[index] *= left;
                self.gains.set_novelty(index, self.novelty[index]);
            }
        }
    }

    /// Returns the parameters of the range prediction at a view-point, including the novelty of its readings.
    pub fn prediction_at(&self, view_point: Cell) -> RangePrediction {
        let novelty = self.grid.index(view_point).map_or(1.0, |index| self.novelty[index]);
        RangePrediction { novelty, ..self.parameters.range_prediction() }
    }

    /// Takes note that the robot's body moved straight between two points, and of the changes of the map
    /// that follow from that, if any.
    pub fn body_moved(
        &mut self,
        map: &CoverageMap,
        from: Point2<f64>,
        to: Point2<f64>,
        changes: &[Change],
    ) {
        if self.parameters.body_evidence != BodyEvidence::Off {
            let under = cells_under_body(&self.grid, from, to, self.radius);
            under.into_iter().for_each(|cell| self.traversable.cover(cell));
        }
        self.take_over(map, changes);
    }

    /// Sets whether decisions tell the gains of their five best candidates even if the strategy does not weigh
    /// gains; at first they do.
    pub fn explain(&mut self, explains: bool) {
        self.explains = explains;
    }

    /// Takes note that the robot stands in a cell, and so can stand there again.
    pub fn stand_on(&mut self, cell: Cell) {
        if self.parameters.body_evidence != BodyEvidence::Off {
            self.traversable.stand_on(cell);
        }
    }

    /// Takes note that the robot drove straight from the centre of one cell to that of another, where it
    /// stands now. If the cells are neighbours, the step is possible both ways, until a bump closes it.
    pub fn drove(&mut self, from: Cell, to: Cell) {
        self.traversable.drive(from, to);
        self.ahead = (from != to).then(|| straight(from, to)).or(self.ahead);
        self.stand_on(to);
    }

    /// Takes note that the robot bumped into something at a place \[m\] as it drove straight from the centre
    /// of one cell to that of another.
    ///
    /// This closes the step at that place. If the step is not diagonal, it also blocks the cell to which
    /// the step leads, unless the robot stood there before.
    pub fn bump(&mut self, from: Cell, to: Cell, at: Point2<f64>) {
        let (from, to) = self.traversable.step_at(from, to, at);
        self.traversable.bump(from, to);
        self.target = None;
    }

    fn take_over(&mut self, map: &CoverageMap, changes: &[Change]) {
        let mut ground_changes = false;
        for change in changes {
            let Some(index) = self.grid.index(change.cell) else { continue };
            let reflects_anew = self.gains.update(map, change.cell);
            if reflects_anew {
                let known = map.is_known(change.cell);
                let free = map.mode(change.cell) <= self.parameters.traversable_coverage + 1e-9;
                self.traversable.update(index, known.then_some(free));
                ground_changes = true;
            }
            self.update_limit(map, index);
        }
        if ground_changes && self.parameters.scope_of_strategy() == Scope::Reachable {
            self.update_limits(map);
        }
    }

    fn update_limits(&mut self, map: &CoverageMap) {
        (0..self.grid.len()).for_each(|index| self.update_limit(map, index));
    }

    /// Sets the distance up to which a cell is a reason to measure.
    pub(crate) fn update_limit(&mut self, map: &CoverageMap, index: usize) {
        let cell = self.grid.cell(index);
        let known = map.is_known(cell);
        let in_scope = match self.parameters.scope_of_strategy() {
            Scope::Observable => true,
            Scope::Reachable => self.traversable.may_be_at(index),
        };
        let is_closed = self.window.as_ref().is_some_and(|w| w.is_closed(index));
        let limit = if in_scope && !is_closed {
            self.exploration.limit(index, known, map.entropy(cell))
        } else {
            0.0
        };
        self.gains.set_limit(index, limit);
    }

    /// Whether a cell is a reason to measure from this distance \[m\].
    pub(crate) fn is_reason(&self, index: usize, distance: f32) -> bool {
        self.gains.is_reason(index, distance)
    }

    /// Returns V(l): the row-major indices of the cells in sight of a view-point, with their distances
    /// from the sensor \[m\].
    ///
    /// A cell is in sight if it is in the footprints of a beam's outcomes with a total probability of at
    /// least ½.
    pub fn cells_in_sight(&mut self, view_point: Cell) -> Vec<(usize, f32)> {
        let Some(index) = self.grid.index(view_point) else { return Vec::new() };
        self.gains.refresh_sight(&ViewPoints::one(&self.grid, index));
        self.gains.cells_in_sight(index)
    }

    /// L(c) and the ways there, for a robot in the cell `from`.
    ///
    /// Spent view-points are left out, unless a scan from `from` would spend all that the robot can reach:
    /// then the robot measures again until it can leave, or no reason is left.
    pub(crate) fn candidates(&mut self, from: Cell) -> Candidates {
        let costs = travel_costs(self.traversable.steps(), from);
        let reached = ViewPoints::of(&self.grid, costs.reached());
        self.gains.refresh_sight(&reached);
        let trapped = costs.reached().all(|i| self.measured.is_near(i, from));
        let mut indices = self.gains.with_reason(&reached);
        indices.retain(|i| trapped || !self.measured.is_spent(*i));
        self.leave_the_last_scan(&mut indices, from);
        Candidates { indices, costs, passage: Vec::new() }
    }

    /// The candidates with their costs for a robot in the cell `from`, without gains and scores.
    pub(crate) fn records(&self, candidates: &Candidates, from: Cell) -> Vec<CandidateRecord> {
        let record = |&index: &usize| CandidateRecord {
            cell: self.grid.cell(index),
            gain: 0.0,
            cost: self.cost(candidates, from, index),
            gain_term: 0.0,
            cost_term: 0.0,
            score: 0.0,
        };
        candidates.indices.par_iter().map(record).collect()
    }

    pub(crate) fn view_points(&self, records: &[CandidateRecord]) -> ViewPoints {
        ViewPoints::of(&self.grid, records.iter().filter_map(|r| self.grid.index(r.cell)))
    }

    /// Fills in the gains of all records.
    pub(crate) fn fill_gains(&mut self, records: &mut [CandidateRecord]) {
        let wanted = self.view_points(records);
        self.gains.refresh_gains(&wanted);
        for record in records {
            record.gain = self.grid.index(record.cell).map_or(0.0, |index| self.gains.gain(index));
        }
    }

    /// Returns all candidates of the next decision for a robot in the cell `from`, with gains and scores, in
    /// row-major order; for IG_WIN those of the whole map.
    ///
    /// # Panics
    /// If the robot's cell lies outside of the grid.
    pub fn candidate_table(&mut self, map: &CoverageMap, from: Cell) -> Vec<CandidateRecord> {
        let mut candidates = self.candidates(from);
        if candidates.indices.is_empty() {
            candidates = self.candidates_beyond_a_passage(map, from).unwrap_or(candidates);
        }
        let mut records = self.records(&candidates, from);
        self.fill_gains(&mut records);
        self.score().fill(&mut records);
        records
    }

    pub(crate) fn score(&self) -> Score {
        match self.parameters.strategy {
            Strategy::Cl | Strategy::Count { .. } => Score::Closest,
            Strategy::Ig | Strategy::IgWin { .. } => Score::Gain,
            Strategy::IgCl { alpha } => Score::Weighted(alpha),
        }
    }

    /// Chooses the next view-point for a robot in the cell `from` by the strategy of the parameters.
    ///
    /// `None` if there is no candidate: no cell is open, and no passage is left to try.
    ///
    /// # Panics
    /// If the robot's cell lies outside of the grid.
    pub fn choose(&mut self, map: &CoverageMap, from: Cell) -> Option<Decision> {
        let mut score = self.score();
        // On a thread of the pool, code that shares its work out need not wait for other threads.
        rayon::scope(|_| self.choose_by(map, from, &mut score))
    }

    /// Chooses the next view-point by the caller's own strategy.
    ///
    /// The strategy scores all view-points with a reason to measure there, by their gains and costs.
    /// View-points from which a scan is not worth taking are passed over, whatever their score.
    ///
    /// # Panics
    /// If the robot's cell lies outside of the grid.
    pub fn choose_by(
        &mut self,
        map: &CoverageMap,
        from: Cell,
        strategy: &mut dyn Scoring,
    ) -> Option<Decision> {
        Search::IN_ORDER.into_iter().find_map(|search| {
            let (candidates, least) = self.searched(map, from, search)?;
            let decision = self.choose_among((map, from), &candidates, least, strategy)?;
            Some(Decision { towards_ground: search == Search::TowardsGround, ..decision })
        })
    }

    /// Chooses one of some candidates; `None` if all of them would measure in vain.
    fn choose_among(
        &mut self,
        (map, from): (&CoverageMap, Cell),
        candidates: &Candidates,
        least: Option<LeastChange>,
        strategy: &mut dyn Scoring,
    ) -> Option<Decision> {
        let uses_gain = strategy.uses_gain();
        let situation = Situation { map, from, ways: &candidates.costs };
        let mut contest = Contest::new(self.records(candidates, from), strategy, situation);
        self.fill_and_pass_over(map, &mut contest, least);
        let decided_by_oracle = if uses_gain { self.decide_ties(map, &mut contest) } else { 0 };
        let target = contest.records[contest.best()?].cell;
        let records: Vec<_> = contest.left().map(|place| contest.records[place]).collect();
        let negative_gains = records.iter().filter(|r| r.gain < 0.0).count();
        let best = self.report(records, uses_gain);
        let mut path = candidates.costs.path_to(target)?;
        if candidates.passage.is_empty() {
            path = self.traversable.pulled_tight(from, &path);
        }
        let passage = candidates.passage.iter().map(|i| self.grid.cell(*i)).collect();
        let candidates = candidates.indices.len();
        self.target = Some((target, self.cells_in_sight(target)));
        Some(Decision {
            target,
            path,
            passage,
            towards_ground: false,
            candidates,
            negative_gains,
            decided_by_oracle,
            best,
        })
    }

    /// The five best candidates; if the strategy needs no gains, only theirs are evaluated.
    fn report(
        &mut self,
        mut records: Vec<CandidateRecord>,
        uses_gain: bool,
    ) -> Vec<CandidateRecord> {
        let better = |a: &CandidateRecord, b: &CandidateRecord| {
            b.score.total_cmp(&a.score).then(a.cell.cmp(&b.cell))
        };
        if records.len() > REPORTED {
            records.select_nth_unstable_by(REPORTED, better);
            records.truncate(REPORTED);
        }
        records.sort_by(better);
        if self.explains && !uses_gain {
            self.fill_gains(&mut records);
            let largest = records.iter().map(|r| r.gain).fold(0.0, f64::max);
            let share = |gain: f64| if largest > 0.0 { gain / largest } else { 0.0 };
            records.iter_mut().for_each(|r| r.gain_term = share(r.gain));
        }
        records
    }

    /// Replaces the gains that could decide by those of the literal equations, and scores anew. Returns
    /// the number of contenders; 0 if there was only one.
    fn decide_ties(&self, map: &CoverageMap, contest: &mut Contest<'_>) -> usize {
        let doubt = 2.0 * contest.uncertainty();
        let records = &mut contest.records;
        let top = |f: fn(&CandidateRecord) -> f64, records: &[CandidateRecord]| {
            records.iter().map(f).fold(f64::NEG_INFINITY, f64::max)
        };
        let best_score = top(|r| r.score, records);
        let contends = |r: &CandidateRecord| r.score >= best_score - doubt;
        let contenders = records.iter().filter(|r| contends(r)).count();
        if contenders < 2 || best_score == f64::NEG_INFINITY {
            return 0;
        }
        // Eq. (16) divides by the largest gain, so that one must be exact as well.
        let largest = records.iter().map(|r| r.gain.abs()).fold(0.0, f64::max);
        let near_max = top(|r| r.gain, records) - 2.0 * GAIN_TOLERANCE * largest;
        let (model, stencil) = (&self.model, self.stencil());
        let doubtful = records.par_iter_mut().filter(|r| contends(r) || r.gain >= near_max);
        doubtful.for_each(|r| {
            let prediction = self.prediction_at(r.cell);
            r.gain = expected_information_gain(map, model, stencil, prediction, r.cell);
        });
        contest.apply();
        contenders
    }

    /// Returns the cells around a view-point, as the planner's beams see them.
    pub fn stencil(&self) -> &Stencil {
        self.gains.stencil()
    }

    /// Returns the gain cache: after a decision, the gains that were evaluated for it or kept, and bounds of
    /// the others.
    pub fn gains(&self) -> &GainCache {
        &self.gains
    }

    /// Returns the parameters.
    pub fn parameters(&self) -> &PlannerParameters {
        &self.parameters
    }
}
