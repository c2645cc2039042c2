//! Eq. (8) as it runs: the cells of a scan in blocks, side by side.

use super::by_cause::explain;
use super::cause_terms::CauseTerms;
use super::evidence::Terms;
use crate::{FootprintCell, Met, ModelParameters, Outcome, SensorModel, Update};
use covmap::lanes::LANES;
use covmap::{Cell, Change, CoverageMap, EvidenceBlock, Grid};
use covmap_sonar::{Range, Scan};
use pulp::{Simd, WithSimd};

/// Integrates a scan into a map, Eq. (8): the posterior of every covered cell is multiplied by
/// p(c_l | d) of Eq. (9). Returns the changes, in row-major order, each cell once.
///
/// The results are computed in f32 and are the same on every processor. Posteriors differ from
/// those of [`crate::integrate_literally`] by less than 1e-5 for a scan.
///
/// # Panics
/// If the model does not fit the map ([`SensorModel::fits`]), or the scan not the ring.
pub fn integrate(model: &SensorModel, map: &mut CoverageMap, scan: &Scan) -> Vec<Change> {
    integrate_new(model, map, scan, &vec![1.0; scan.ranges.len()])
}

/// Integrates a scan with the novelty of each beam's reading, in \[0, 1\] ([`crate::Looks`]). The
/// product of Eq. (9) ignores it and takes all of each reading as new.
///
/// # Panics
/// As [`integrate`], or if there is not one number for each reading.
pub fn integrate_new(
    model: &SensorModel,
    map: &mut CoverageMap,
    scan: &Scan,
    novelty: &[f64],
) -> Vec<Change> {
    integrate_on(model.registers(), model, map, (scan, novelty))
}

fn integrate_on(
    registers: pulp::Arch,
    model: &SensorModel,
    map: &mut CoverageMap,
    (scan, novelty): (&Scan, &[f64]),
) -> Vec<Change> {
    assert!(model.fits(map), "the model is for other bins or another resolution");
    assert_eq!(scan.ranges.len(), model.footprint().beams(), "one reading for each beam");
    assert_eq!(scan.ranges.len(), novelty.len(), "one novelty for each reading");
    registers.dispatch(Integration::new(model, map, (scan, novelty)))
}

/// A scan that is being integrated. Compiled for each kind of vector registers.
struct Integration<'a> {
    model: &'a SensorModel,
    map: &'a mut CoverageMap,
    scan: &'a Scan,
    novelty: &'a [f64],
    grid: Grid,
    touched: Touched,
    /// The cells of all beams: their row-major index, their place in `touched`, and how their beams
    /// meet them. They are in blocks of [`LANES`], no cell twice in a block.
    cells: Vec<u32>,
    places: Vec<u32>,
    met: Vec<Met>,
}

/// Evidence of a scan about its cells, by one of the updates.
enum Said {
    Product(Terms),
    Cause(CauseTerms),
}

impl WithSimd for Integration<'_> {
    type Output = Vec<Change>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> Vec<Change> {
        let said = self.collect();
        self.multiply(&said);
        self.touched.changes()
    }
}

impl<'a> Integration<'a> {
    fn new(
        model: &'a SensorModel,
        map: &'a mut CoverageMap,
        (scan, novelty): (&'a Scan, &'a [f64]),
    ) -> Self {
        let grid = *map.grid();
        let outcomes = scan.ranges.iter().filter_map(|range| model.outcome(*range));
        let reach = outcomes.map(|outcome| model.reach(outcome)).fold(0.0, f64::max);
        let (low, high) = model.footprint().extent(&grid, &scan.pose, reach);
        let touched = Touched::new(low, high);
        let room = touched.slots.len();
        let (cells, places) = (Vec::with_capacity(room), Vec::with_capacity(room));
        let met = Vec::with_capacity(room);
        Self { model, map, scan, novelty, grid, touched, cells, places, met }
    }

    /// Collects all cells that the scan changes, and the evidence about each.
    #[inline(always)]
    fn collect(&mut self) -> Said {
        let (model, resolution) = (self.model, self.model.resolution());
        let ModelParameters { bins, usable_range, update, .. } = model.parameters();
        match update {
            Update::Product(parameters) => {
                let mut terms = Terms::default();
                let outcome = |(beam, range): (usize, &Range)| Some((beam, model.outcome(*range)?));
                for (beam, outcome) in self.scan.ranges.iter().enumerate().filter_map(outcome) {
                    let first = self.cells.len();
                    self.for_each_met(beam, outcome, |this, cell, met| {
                        this.add(cell, met);
                    });
                    let reading = parameters.reading(outcome, *usable_range);
                    let distances = self.met[first..].iter().map(|met| met.cell_distance);
                    terms.extend((parameters, resolution), &reading, distances);
                }
                self.fill_block();
                terms.fill(self.cells.len());
                Said::Product(terms)
            }
            Update::Cause(parameters) => {
                let mut terms = CauseTerms::new(parameters, *bins);
                let explained = explain(model, parameters, self.map, (self.scan, self.novelty));
                for (beam, explained) in explained.iter().enumerate() {
                    let Some((outcome, causes)) = explained else { continue };
                    self.for_each_met(beam, *outcome, |this, covered, met| {
                        let role = parameters.role(resolution, met, *outcome);
                        let shares = role.shares(causes, parameters.bearing(met.across));
                        if !shares.are_nothing() && this.add(covered, met) {
                            terms.fill(this.cells.len() - 1);
                            terms.push(&role, &shares);
                        }
                    });
                }
                self.fill_block();
                terms.fill(self.cells.len());
                Said::Cause(terms)
            }
        }
    }

    /// Visits the cells that a beam covers.
    #[inline(always)]
    fn for_each_met(
        &mut self,
        beam: usize,
        outcome: Outcome,
        mut visit: impl FnMut(&mut Self, Cell, Met),
    ) {
        let (model, grid, pose) = (self.model, self.grid, self.scan.pose);
        let reach = model.reach(outcome);
        model.footprint().for_each_cell(&grid, &pose, beam, reach, |covered| {
            let FootprintCell { cell, cell_distance, across } = covered;
            visit(self, cell, Met { cell_distance, across });
        });
    }

    /// Adds a cell to the present block, or to the next one if another beam has put it into this
    /// one. Returns whether the cell was added: a cell that nothing can change is not.
    #[inline(always)]
    fn add(&mut self, cell: Cell, met: Met) -> bool {
        let index = self.grid.index(cell).filter(|index| self.map.is_changeable(*index));
        let Some(index) = index else { return false };
        let place = self.touched.place(cell);
        let block = |count: usize| 1 + count / LANES;
        let last_block = &mut self.touched.slots[place].block;
        if *last_block as usize == block(self.cells.len()) {
            self.fill_block();
        }
        #[allow(clippy::cast_possible_truncation, reason = "at most 2e7 cells, of 64 beams")]
        {
            self.touched.slots[place].block = block(self.cells.len()) as u32;
            self.cells.push(index as u32);
            self.places.push(place as u32);
        }
        self.met.push(met);
        true
    }

    /// Leaves the rest of the present block empty.
    fn fill_block(&mut self) {
        let count = self.cells.len().next_multiple_of(LANES);
        self.cells.resize(count, EvidenceBlock::NO_CELL);
        self.places.resize(count, 0);
        self.met.resize(count, Met { cell_distance: 0.0, across: 0.5 });
    }

    #[inline(always)]
    fn multiply(&mut self, said: &Said) {
        let ModelParameters { bins, update, .. } = self.model.parameters();
        let tempering = update.product().map_or(1.0, |product| product.tempering);
        let Self { map, touched, cells, places, .. } = self;
        let mut block = EvidenceBlock::new(map.bins());
        let (cells, places) = (cells.as_chunks::<LANES>().0, places.as_chunks::<LANES>().0);
        for (number, (cells, places)) in cells.iter().zip(places).enumerate() {
            match said {
                Said::Product(terms) => terms.evidence(number, (*bins, tempering), block.weights()),
                Said::Cause(terms) => terms.evidence(number, block.weights()),
            }
            map.multiply_block(&mut block, cells, |lane, before, after| {
                touched.note(places[lane] as usize, before, after);
            });
        }
    }
}

/// Changes of the cells around the robot.
struct Touched {
    low: Cell,
    width: usize,
    /// Row by row.
    slots: Vec<Slot>,
    entropies: Vec<(f64, f64)>,
}

#[derive(Clone, Copy)]
struct Slot {
    /// The last block with this cell, counted from 1.
    block: u32,
    /// One more than the place of its entropies; 0 if it did not change.
    change: u32,
}

impl Touched {
    fn new(low: Cell, high: Cell) -> Self {
        let side = |from: i32, to: i32| usize::try_from(to - from + 1).unwrap_or(0);
        let (width, height) = (side(low.x, high.x), side(low.y, high.y));
        let slots = vec![Slot { block: 0, change: 0 }; width * height];
        Self { low, width, slots, entropies: Vec::new() }
    }

    #[inline(always)]
    fn place(&self, cell: Cell) -> usize {
        let along = |from: i32, to: i32| (to - from).cast_unsigned() as usize;
        along(self.low.y, cell.y) * self.width + along(self.low.x, cell.x)
    }

    #[inline(always)]
    fn note(&mut self, place: usize, before: f64, after: f64) {
        let slot = &mut self.slots[place];
        if slot.change == 0 {
            self.entropies.push((before, after));
            #[allow(clippy::cast_possible_truncation, reason = "at most 2e7 cells")]
            (slot.change = self.entropies.len() as u32);
        } else {
            self.entropies[slot.change as usize - 1].1 = after;
        }
    }

    /// Returns one change for each cell, in row-major order.
    fn changes(&self) -> Vec<Change> {
        let mut changes = Vec::with_capacity(self.entropies.len());
        for (y, row) in (self.low.y..).zip(self.slots.chunks(self.width.max(1))) {
            for (x, slot) in (self.low.x..).zip(row) {
                if slot.change != 0 {
                    let (before, after) = self.entropies[slot.change as usize - 1];
                    changes.push(Change { cell: Cell::new(x, y), before, after });
                }
            }
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FootprintRule, Linear, NoEchoParameters, ProductParameters, integrate_literally};
    use covmap_sonar::{Range, SonarRing};
    use nalgebra::{Isometry2, Point2, Vector2};
    use proptest::prelude::*;

    fn linear(base: impl Strategy<Value = f64>, slope: f64) -> impl Strategy<Value = Linear> {
        (base, 0.0..slope, 0.0..slope).prop_map(|(base, per_cell_distance, per_range)| Linear {
            base,
            per_cell_distance,
            per_range,
        })
    }

    /// A model of any kind for cells of .1 m.
    fn a_model() -> impl Strategy<Value = SensorModel> {
        let gamma = prop_oneof![4 => 0.02..2.0f64, 1 => 1e-12..1e-6f64, 1 => 100.0..1e3f64];
        let rule = prop_oneof![
            (0.05..0.2f64).prop_map(|half_angle| FootprintRule::Sectors { half_angle }),
            (0.0..0.4f64).prop_map(|half_angle| FootprintRule::Cones { half_angle }),
        ];
        let tempering = prop_oneof![Just(1.0), 0.05..1.0f64];
        let rest = (0.0..0.3f64, 0.3..1.5f64, 0.01..20.0f64, tempering, rule);
        (2..=64usize, linear(0.05..0.25, 0.05), 0.01..0.3f64, linear(gamma, 1.0), rest).prop_map(
            |(
                bins,
                mut sigma_out,
                above,
                gamma,
                (behind, range, no_echo, tempering, footprint),
            )| {
                let half_bin = 0.5 / (bins - 1) as f64;
                sigma_out.base = sigma_out.base.max(half_bin);
                let parameters = ModelParameters {
                    bins,
                    usable_range: 1.5,
                    footprint,
                    update: Update::Product(ProductParameters {
                        sigma_in: sigma_out.at(1.8, 1.5) + above,
                        sigma_out,
                        gamma,
                        behind,
                        no_echo: NoEchoParameters { range, gamma: no_echo },
                        tempering,
                    }),
                };
                SensorModel::new(&parameters, &SonarRing::b21r(), 0.1).unwrap()
            },
        )
    }

    fn scans() -> impl Strategy<Value = Vec<Scan>> {
        let range = prop_oneof![
            6 => (0.0..1.7f64).prop_map(Range::Echo),
            1 => Just(Range::NoEcho),
            1 => Just(Range::Missing),
        ];
        let pose = (-1.2..1.2f64, -1.2..1.2f64, -7.0..7.0f64)
            .prop_map(|(x, y, heading)| Isometry2::new(Vector2::new(x, y), heading));
        let scan = (pose, prop::collection::vec(range, 24)).prop_map(|(pose, ranges)| Scan {
            pose,
            time: 0.0,
            ranges,
        });
        prop::collection::vec(scan, 1..4)
    }

    fn empty_map(model: &SensorModel) -> CoverageMap {
        let grid = Grid::new(Point2::new(-1.5, -1.45), 0.1, 31, 29).unwrap();
        let mut map = CoverageMap::new(grid, model.parameters().bins).unwrap();
        map.pin_free(Cell::new(14, 15));
        map
    }

    proptest! {
        #[test]
        fn posteriors_are_those_of_the_literal_equations(model in a_model(), scans in scans()) {
            let (mut fast, mut literal) = (empty_map(&model), empty_map(&model));
            for scan in &scans {
                let changes = integrate(&model, &mut fast, scan);
                let expected = integrate_literally(&model, &mut literal, scan);
                let cells = |changes: &[Change]| changes.iter().map(|c| c.cell).collect::<Vec<_>>();
                prop_assert_eq!(cells(&changes), cells(&expected));
                for (ours, expected) in changes.iter().zip(&expected) {
                    prop_assert!((ours.before - expected.before).abs() < 1e-4, "{:?} {:?}", ours, expected);
                    prop_assert!((ours.after - expected.after).abs() < 1e-4, "{:?} {:?}", ours, expected);
                }
            }
            for cell in fast.grid().cells() {
                let (ours, expected) = (fast.histogram(cell), literal.histogram(cell));
                for (a, b) in ours.probabilities().iter().zip(expected.probabilities()) {
                    prop_assert!((a - b).abs() < 1e-5, "{:?}: {} {}", cell, a, b);
                }
                prop_assert!((fast.entropy(cell) - ours.entropy()).abs() < 1e-5);
                // The first of all bins that are as probable as the largest, to within 1e-4.
                let largest = ours.probabilities().iter().copied().fold(0.0, f64::max);
                let first_above = |share: f64| {
                    let bin = ours.probabilities().iter().position(|p| *p >= share * largest);
                    covmap::bin_coverage(bin.unwrap(), ours.probabilities().len())
                };
                let mode = fast.mode(cell);
                prop_assert!(
                    first_above(1.0 - 1.01e-4) <= mode && mode <= first_above(1.0 - 0.99e-4),
                    "{:?}: {} of {:?}", cell, mode, ours.probabilities()
                );
            }
        }

        #[test]
        fn every_kind_of_registers_gives_the_same_bits(model in a_model(), scans in scans()) {
            let map_on = |registers: pulp::Arch| {
                let mut map = empty_map(&model);
                let changes: Vec<_> =
                    scans.iter().map(|scan| integrate_on(registers, &model, &mut map, (scan, &[1.0; 24]))).collect();
                (map, changes)
            };
            let scalar = map_on(pulp::Arch::Scalar);
            for registers in kinds_of_registers() {
                prop_assert_eq!(&map_on(registers), &scalar, "{:?}", registers);
            }
        }
    }

    /// Returns the kinds that this processor has.
    fn kinds_of_registers() -> Vec<pulp::Arch> {
        let mut kinds = vec![pulp::Arch::new()];
        #[cfg(target_arch = "x86_64")]
        kinds.extend(pulp::x86::V3::try_new().map(pulp::Arch::V3));
        kinds
    }
}
