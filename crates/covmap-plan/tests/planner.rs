//! The planner on random maps: its caches agree with the literal equations.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

use covmap::{Cell, CoverageMap, Grid, Raster};
use covmap_gain::{BeamError, GAIN_TOLERANCE, Stencil, expected_information_gain};
use covmap_model::{
    FootprintRule, Linear, ModelParameters, SensorModel, integrate, integrate_body,
};
use covmap_plan::{CellStatus, Planner, PlannerError, PlannerParameters, Reason, Strategy};
use covmap_sonar::{Beam, Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};
use proptest::prelude::*;
use proptest::strategy::Strategy as Generator;
use std::f64::consts::PI;

#[path = "planner/promises.rs"]
mod promises;

const RADIUS: f64 = 0.27;

struct Setting {
    model: SensorModel,
    parameters: PlannerParameters,
    map: CoverageMap,
    planner: Planner,
}

/// Parameters with which every open cell in sight is a reason, whatever its expected change.
fn in_sight() -> PlannerParameters {
    PlannerParameters { reason: Reason::InSight, ..PlannerParameters::standard() }
}

fn setting(strategy: Strategy, bins: usize, change: impl Fn(&mut PlannerParameters)) -> Setting {
    let mut model_parameters =
        ModelParameters { bins, usable_range: 1.5, ..ModelParameters::by_hand() };
    if bins < 11 {
        // Few bins cannot show a narrow Gaussian.
        model_parameters = model_parameters.with_product(|product| {
            (product.sigma_out.base, product.sigma_in) = (0.12, 0.3);
        });
    }
    let mut parameters = PlannerParameters { strategy, ..in_sight() };
    change(&mut parameters);
    setting_of(&model_parameters, &SonarRing::b21r(), parameters)
}

fn setting_of(model: &ModelParameters, ring: &SonarRing, parameters: PlannerParameters) -> Setting {
    let model = SensorModel::new(model, ring, 0.1).unwrap();
    let bins = model.parameters().bins;
    let grid = Grid::new(Point2::new(-2.0, -1.5), 0.1, 40, 30).unwrap();
    let map = CoverageMap::new(grid, bins).unwrap();
    let outside = Raster::filled(grid, false);
    let planner = Planner::new(&parameters, &model, &outside, RADIUS, 0.0).unwrap();
    Setting { model, parameters, map, planner }
}

impl Setting {
    fn scan(&mut self, x: f64, y: f64, ranges: &[Range]) {
        let here = self.map.grid().center(self.map.grid().cell_at(Point2::new(x, y)).unwrap());
        let scan =
            Scan { pose: Isometry2::new(here.coords, 0.0), time: 0.0, ranges: ranges.to_vec() };
        let changes = integrate(&self.model, &mut self.map, &scan);
        self.planner.observe(&self.map, &scan, &changes);
    }

    fn stand(&mut self, x: f64, y: f64) {
        let at = Point2::new(x, y);
        let changes = integrate_body(&mut self.map, at, at, RADIUS);
        self.planner.body_moved(&self.map, at, at, &changes);
        self.planner.stand_on(self.map.grid().cell_at(at).unwrap());
    }
}

fn some_ranges() -> impl Generator<Value = Vec<Range>> {
    let range = prop_oneof![
        5 => (0.2..2.0f64).prop_map(Range::Echo),
        1 => Just(Range::NoEcho),
        1 => Just(Range::Missing),
    ];
    prop::collection::vec(range, 24)
}

/// Models that differ in every property that the fast evaluation uses.
fn some_models() -> impl Generator<Value = ModelParameters> {
    let gamma = (0.02..0.4f64, 0.0..0.4f64, prop_oneof![Just(0.0), 0.0..0.3f64]);
    let evidence = (gamma, prop::sample::select(vec![0.0, 0.1, 0.15, 0.35]), 0.4..=1.0f64);
    (evidence, prop_oneof![Just(0.0), 0.1..1.5f64], any::<bool>()).prop_map(
        |(((base, per_cell_distance, per_range), behind, tempering), range, cones_wanted)| {
            let by_hand = ModelParameters::by_hand();
            let half_angle = 0.13;
            let cones = FootprintRule::Cones { half_angle };
            let sectors = FootprintRule::Sectors { half_angle };
            ModelParameters {
                usable_range: 1.5,
                footprint: if cones_wanted { cones } else { sectors },
                ..by_hand
            }
            .with_product(|product| {
                product.gamma = Linear { base, per_cell_distance, per_range };
                product.behind = behind;
                product.tempering = tempering;
                product.no_echo.range = range;
            })
        },
    )
}

/// Sensors around the robot, at this distance from its centre \[m\].
fn ring(offset: f64) -> SonarRing {
    let beam = |i: u32| {
        let angle = 2.0 * PI * f64::from(i) / 24.0;
        let pose = Isometry2::rotation(angle) * Isometry2::translation(offset, 0.0);
        Beam { pose, half_angle: 0.13, min_range: 0.0, max_range: 5.0 }
    };
    SonarRing::new((0..24).map(beam).collect()).unwrap()
}

fn some_scans() -> impl Generator<Value = Vec<(f64, f64, Vec<Range>)>> {
    prop::collection::vec((-1.0..1.0f64, -0.7..0.7f64, some_ranges()), 1..6)
}

fn strategies() -> impl Generator<Value = Strategy> {
    prop::sample::select(vec![
        Strategy::Cl,
        Strategy::Ig,
        Strategy::IgWin { radius: 0.8 },
        Strategy::IgCl { alpha: 0.3 },
        Strategy::Count { times: 2.0, half_distance: Some(2.0) },
    ])
}

/// Compares the five best of a decision, which evaluates the candidates that may be among them, with
/// the five best of all candidates.
fn check_decision(s: &mut Setting, from: Cell) -> Result<(), TestCaseError> {
    let decision = s.planner.clone().choose(&s.map, from);
    let mut table = s.planner.candidate_table(&s.map, from);
    prop_assert_eq!(decision.is_none(), table.is_empty());
    let largest = table.iter().map(|r| r.gain.abs()).fold(0.0, f64::max);
    table.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.cell.cmp(&b.cell)));
    for (ours, one) in decision.iter().flat_map(|d| &d.best).zip(&table) {
        prop_assert!((ours.score - one.score).abs() <= 2.0 * GAIN_TOLERANCE * largest);
    }
    Ok(())
}

/// Compares every seventh candidate's gain with the literal equations.
fn check_gains(s: &mut Setting, stencil: &Stencil, from: Cell) -> Result<(), TestCaseError> {
    let table = s.planner.candidate_table(&s.map, from);
    let largest = table.iter().map(|r| r.gain.abs()).fold(0.0, f64::max);
    for record in table.iter().step_by(7) {
        let prediction = s.parameters.range_prediction();
        let exact = expected_information_gain(&s.map, &s.model, stencil, prediction, record.cell);
        prop_assert!(
            (record.gain - exact).abs() <= GAIN_TOLERANCE * largest,
            "{:?}: {} is not {}",
            record.cell,
            record.gain,
            exact
        );
    }
    Ok(())
}

/// Compares decisions and gains at the origin after each of some scans.
fn check_gains_after_every_scan(
    mut s: Setting,
    scans: Vec<(f64, f64, Vec<Range>)>,
) -> Result<(), TestCaseError> {
    s.stand(0.0, 0.0);
    let stencil = Stencil::new(&s.model, 0.0);
    let home = s.map.grid().cell_at(Point2::origin()).unwrap();
    for (x, y, ranges) in scans {
        s.scan(x, y, &ranges);
        check_decision(&mut s, home)?;
        check_gains(&mut s, &stencil, home)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_fast_gain_is_the_literal_one_after_every_scan(
        scans in some_scans(), bins in prop::sample::select(vec![6, 11, 16, 33]),
        share in prop_oneof![3 => Just(0.0), 1 => 0.0..0.2f64], unknown in prop_oneof![Just(0.0), 0.0..0.5f64]
    ) {
        let s = setting(Strategy::Ig, bins, |p| (p.uniform_share, p.unknown_reflection) = (share, unknown));
        check_gains_after_every_scan(s, scans)?;
    }

    #[test]
    fn the_fast_gain_is_the_literal_one_for_all_models_and_rings(
        model in some_models(), offset in prop::sample::select(vec![0.0, 0.05, 0.1, 0.2]), scans in some_scans()
    ) {
        // With an offset of half a cell there are cells exactly where two rings meet.
        let parameters = PlannerParameters { strategy: Strategy::Ig, ..in_sight() };
        let s = setting_of(&model, &ring(offset), parameters);
        check_gains_after_every_scan(s, scans)?;
    }

    #[test]
    fn the_fast_gain_is_the_literal_one_where_readings_say_little(
        scans in some_scans(), tempering in 0.05..0.3f64
    ) {
        let model = ModelParameters { usable_range: 1.5, ..ModelParameters::b21r() }.with_product(|product| { product.tempering = tempering; });
        let parameters = PlannerParameters { strategy: Strategy::Ig, ..in_sight() };
        let s = setting_of(&model, &SonarRing::b21r(), parameters);
        check_gains_after_every_scan(s, scans)?;
    }

    #[test]
    fn the_fast_gain_is_the_literal_one_for_long_ranges(
        model in some_models(), usable_range in prop::sample::select(vec![3.0, 4.05]),
        scans in prop::collection::vec((-1.0..1.0f64, -0.7..0.7f64, some_ranges()), 1..3)
    ) {
        let model = ModelParameters { usable_range, ..model }.with_product(|product| { product.sigma_in = 0.3; });
        let parameters = PlannerParameters { strategy: Strategy::Ig, ..in_sight() };
        let s = setting_of(&model, &SonarRing::b21r(), parameters);
        check_gains_after_every_scan(s, scans)?;
    }

    #[test]
    fn what_is_kept_equals_what_a_fresh_planner_computes(scans in some_scans(), strategy in strategies()) {
        let mut s = setting(strategy, 11, |_| ());
        s.stand(0.0, 0.0);
        let home = s.map.grid().cell_at(Point2::origin()).unwrap();
        for (x, y, ranges) in scans {
            s.scan(x, y, &ranges);
            s.planner.candidate_table(&s.map, home);
            let mut fresh = setting(strategy, 11, |_| ());
            fresh.stand(0.0, 0.0);
            let all: Vec<covmap::Change> = s.map.grid().cells().map(|cell| {
                let after = s.map.entropy(cell);
                covmap::Change { cell, before: after, after }
            }).collect();
            fresh.planner.body_moved(&s.map, Point2::origin(), Point2::origin(), &all);
            for cell in s.map.grid().cells().step_by(11) {
                prop_assert_eq!(s.planner.cells_in_sight(cell), fresh.planner.cells_in_sight(cell));
            }
        }
    }

    #[test]
    fn what_decisions_leave_out_is_not_better(
        scans in some_scans(), strategy in strategies(),
        share in prop_oneof![2 => Just(0.0), 1 => 0.0..0.2f64]
    ) {
        let mut s = setting(strategy, 11, |p| p.uniform_share = share);
        s.stand(0.0, 0.0);
        let home = s.map.grid().cell_at(Point2::origin()).unwrap();
        for (x, y, ranges) in scans {
            // The planner keeps the gains and bounds of earlier decisions.
            s.scan(x, y, &ranges);
            let decision = s.planner.choose(&s.map, home);
            let mut table = s.planner.clone().candidate_table(&s.map, home);
            if matches!(strategy, Strategy::IgWin { .. }) {
                continue;
            }
            prop_assert_eq!(decision.is_none(), table.is_empty());
            table.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.cell.cmp(&b.cell)));
            for (ours, one) in decision.iter().flat_map(|d| &d.best).zip(&table) {
                prop_assert!((ours.score - one.score).abs() <= 1e-4 * (1.0 + one.score.abs()));
            }
        }
    }

    #[test]
    fn a_decision_is_the_argmax_of_the_table(scans in some_scans(), strategy in strategies()) {
        let mut s = setting(strategy, 11, |_| ());
        s.stand(0.0, 0.0);
        let home = s.map.grid().cell_at(Point2::origin()).unwrap();
        for (x, y, ranges) in scans {
            s.scan(x, y, &ranges);
        }
        let unprepared = s.planner.clone().choose(&s.map, home);
        let table = s.planner.candidate_table(&s.map, home);
        let certificate = s.planner.certificate(&s.map, home);
        let open = certificate.values().iter().filter(|c| **c == CellStatus::Open).count();
        let decision = s.planner.choose(&s.map, home);
        prop_assert_eq!(unprepared.map(|d| d.target), decision.as_ref().map(|d| d.target));
        prop_assert_eq!(open > 0, decision.as_ref().is_some_and(|d| d.passage.is_empty()));
        prop_assert_eq!(table.is_empty(), decision.is_none());
        if let Some(decision) = decision {
            let chosen = table.iter().find(|r| r.cell == decision.target).unwrap();
            prop_assert!(decision.best.iter().any(|r| r.cell == decision.target));
            let top = table.iter().map(|r| r.score).fold(f64::NEG_INFINITY, f64::max);
            if !matches!(strategy, Strategy::IgWin { .. }) {
                prop_assert!(chosen.score >= top - 1e-4 * (1.0 + top.abs()));
                prop_assert_eq!(decision.candidates, table.len());
            }
            prop_assert!(decision.path.is_empty() || *decision.path.last().unwrap() == decision.target);
        }
    }
}

#[test]
fn nothing_known_offers_nothing_to_do_from_afar() {
    let mut s = setting(Strategy::Cl, 11, |_| ());
    s.stand(0.0, 0.0);
    let home = s.map.grid().cell_at(Point2::origin()).unwrap();
    // The robot sees the unknown around it and measures where it stands.
    let decision = s.planner.choose(&s.map, home).unwrap();
    assert_eq!((decision.target, decision.path.len()), (home, 0));
    assert_eq!(s.planner.cells_in_sight(home).len(), {
        let p = s.map.grid().center(home);
        let near = |c: &Cell| {
            let d = s.map.grid().center(*c) - p;
            // No echo is free space up to one metre from the sensors at .25 m.
            (0.26..1.24).contains(&d.norm())
        };
        s.map.grid().cells().filter(near).count()
    });
}

#[test]
fn a_wall_hides_what_is_behind_it() {
    let mut s = setting(Strategy::Ig, 11, |_| ());
    s.stand(0.0, 0.0);
    let ranges = vec![Range::Echo(0.75); 24];
    (0..8).for_each(|_| s.scan(0.0, 0.0, &ranges));
    let home = s.map.grid().cell_at(Point2::origin()).unwrap();
    let center = s.map.grid().center(home);
    for (index, _) in s.planner.cells_in_sight(home) {
        let distance = (s.map.grid().center(s.map.grid().cell(index)) - center).norm();
        assert!(distance < 1.0 + 0.25 + 0.1, "{distance}");
    }
}

/// A robot that measured all that it can from the left of a strip of unknown cells .6 m wide,
/// and knows a free room to the right of it.
fn cut_off(passage_length: f64) -> (Setting, Cell) {
    let mut s = setting(Strategy::Cl, 11, |p| {
        (p.passage_length, p.scan_spacing) = (passage_length, 0.7);
    });
    let mut sweep = |x: f64, to: f64, y: f64| {
        let (from, to) = (Point2::new(x, y), Point2::new(to, y));
        let changes = integrate_body(&mut s.map, from, to, RADIUS);
        s.planner.body_moved(&s.map, from, to, &changes);
    };
    (-8..=8).for_each(|y| sweep(-1.25, -1.15, 0.1 * f64::from(y)));
    (-8..=8).for_each(|y| sweep(0.05, 1.3, 0.1 * f64::from(y)));
    [-0.6, 0.0, 0.6].into_iter().for_each(|y| s.scan(-1.2, y, &[Range::Missing; 24]));
    let home = s.map.grid().cell_at(Point2::new(-1.2, 0.0)).unwrap();
    (s, home)
}

#[test]
fn a_passage_that_looks_blocked_is_tried_when_nothing_else_is_left() {
    let (mut s, home) = cut_off(0.8);
    let open = |s: &mut Setting| {
        let certificate = s.planner.certificate(&s.map, home);
        certificate.values().contains(&CellStatus::Open)
    };
    assert!(!open(&mut s));
    let mut tries = 0;
    while let Some(decision) = s.planner.choose(&s.map, home) {
        assert!(!decision.passage.is_empty() && decision.passage.len() <= 8);
        assert!(decision.passage.iter().all(|cell| decision.path.contains(cell)));
        assert!(s.map.grid().center(decision.target).x > -0.3);
        let first = decision.path.iter().position(|cell| *cell == decision.passage[0]).unwrap();
        let before = if first == 0 { home } else { decision.path[first - 1] };
        s.planner.bump(before, decision.passage[0], s.map.grid().center(before));
        tries += 1;
    }
    assert!((2..=300).contains(&tries), "{tries}");
}

#[test]
fn a_passage_that_is_too_long_is_not_tried() {
    for length in [0.0, 0.3] {
        let (mut s, home) = cut_off(length);
        assert!(s.planner.choose(&s.map, home).is_none());
    }
}

#[test]
fn open_cells_are_the_known_ones_that_are_neither_resolved_nor_given_up() {
    let mut s = setting(Strategy::Cl, 11, |_| {});
    assert_eq!(s.planner.open_cells(&s.map), 0, "nothing is known");
    for (x, range) in [(-0.4, 1.2), (0.0, 1.3), (0.4, 0.9)] {
        s.stand(x, 0.0);
        s.scan(x, 0.0, &[Range::Echo(range); 24]);
        let from = s.map.grid().cell_at(Point2::new(x, 0.0)).unwrap();
        let certificate = s.planner.certificate(&s.map, from);
        let count = |statuses: &[CellStatus]| {
            let known = certificate.iter().filter(|(cell, _)| s.map.is_known(*cell));
            known.filter(|(_, status)| statuses.contains(status)).count()
        };
        let open = s.planner.open_cells(&s.map);
        let sure = count(&[CellStatus::Open]);
        let unseen = count(&[CellStatus::Unreachable, CellStatus::NotSeen]);
        // Nothing was given up yet, so what is exhausted is in sight of spent places only.
        assert!(sure > 0);
        assert_eq!(open, sure + unseen + count(&[CellStatus::Exhausted]));
    }
}

#[test]
fn beams_of_too_many_cells_are_refused() {
    let planner = |r: f64| {
        let ring = SonarRing::b21r();
        let model = SensorModel::new(&ModelParameters::by_hand(), &ring, r).unwrap();
        let outside = Raster::filled(Grid::new(Point2::origin(), r, 4, 4).unwrap(), false);
        let parameters = PlannerParameters::standard();
        Planner::new(&parameters, &model, &outside, RADIUS, 0.0).map(|_| ()).unwrap_err()
    };
    assert!(
        matches!(planner(0.001), PlannerError::Beam(BeamError::TooLong(cells)) if cells > 3000.0)
    );
    assert!(
        matches!(planner(0.0035), PlannerError::Beam(BeamError::TooFine(cells)) if cells > 65_534)
    );
}

#[test]
fn absurd_arguments_are_answered() {
    let Setting { model, parameters, map, .. } = setting(Strategy::Cl, 11, |_| ());
    let outside = Raster::filled(*map.grid(), false);
    for (radius, heading) in [
        (f64::NAN, 0.0),
        (-1.0, 0.0),
        (f64::INFINITY, 0.0),
        (1e300, 0.0),
        (0.27, f64::NAN),
        (0.27, f64::INFINITY),
        (0.27, 1e300),
    ] {
        let refused = Planner::new(&parameters, &model, &outside, radius, heading);
        assert!(matches!(refused, Err(PlannerError::OutOfRange { .. })), "{radius}, {heading}");
    }
    let far = Cell::new(i32::MAX, i32::MIN);
    let stencil = Stencil::new(&model, 0.0);
    let prediction = parameters.range_prediction();
    assert_eq!(expected_information_gain(&map, &model, &stencil, prediction, far), 0.0);
    let grid = *map.grid();
    let steps = covmap::Steps::between(&grid, |_| true);
    let costs = covmap_plan::travel_costs(steps, Cell::new(0, 0));
    assert!(costs.cost(grid.len() - 1).is_some());
    assert_eq!((costs.cost(grid.len()), costs.cost(usize::MAX)), (None, None));
    assert_eq!(costs.path_to(far), None);
}

#[test]
#[should_panic(expected = "outside the grid")]
fn a_planner_does_not_choose_from_outside_of_its_grid() {
    let Setting { map, mut planner, .. } = setting(Strategy::Cl, 11, |_| ());
    planner.choose(&map, Cell::new(-1, 0));
}
