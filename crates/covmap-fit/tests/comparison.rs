//! Methods compared on a toy: a rectangular room, seen by a ring of ideal sonars.

#![allow(missing_docs, reason = "a test")]

use covmap::{Cell, Grid};
use covmap_fit::{
    Axis, BetaCounting, BodyRecord, CellMean, ComparisonRow, ComparisonSettings, Contender, Crm,
    Example, LogOdds, Method, MethodParameter, TuneError, TuneSettings, Update, Weighting, compare,
    trajectory_blocks, tune,
};
use covmap_model::ModelParameters;
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2, Vector2};
use proptest::prelude::*;
use std::ops::ControlFlow;

/// Returns a generator of uniform numbers, good enough for tests (splitmix64).
fn uniform(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);

        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns the range of a cone in an empty room: the nearest point of its walls that one of some
/// rays meets, with noise.
fn range(room: (Point2<f64>, Point2<f64>), sensor: &Isometry2<f64>, u: f64) -> Range {
    let ray = |i: i32| {
        let angle = sensor.rotation.angle() + 0.02 * f64::from(i);
        let along = Vector2::new(libm::cos(angle), libm::sin(angle));
        let from = sensor.translation.vector;
        let wall = |axis: usize| {
            let end = if along[axis] > 0.0 { room.1[axis] } else { room.0[axis] };
            (end - from[axis]) / along[axis]
        };
        wall(0).min(wall(1))
    };
    Range::Echo((-8..=8).map(ray).fold(f64::INFINITY, f64::min) + 0.06 * (u - 0.5))
}

/// Returns the example of a robot that crosses a room whose walls cut cells.
fn example(size: (f64, f64), seed: u64) -> Example {
    let room = (Point2::new(0.53, 0.57), Point2::new(0.53 + size.0, 0.57 + size.1));
    let extent = Vector2::new(size.0, size.1).add_scalar(1.0);
    let grid = Grid::covering(Point2::origin(), extent, 0.1, 0).expect("a grid");
    let (ring, mut random) = (SonarRing::b21r(), uniform(seed));
    let scan = |i: i32| {
        let x = 1.0 + (size.0 - 1.0) * f64::from(i) / 30.0;
        let pose = Isometry2::new(Vector2::new(x, 0.57 + 0.5 * size.1), 0.1);
        let ranges = ring.beams().iter().map(|b| range(room, &(pose * b.pose), random()));
        Scan { pose, time: f64::from(i), ranges: ranges.collect() }
    };
    let scans: Vec<Scan> = (0..30).map(scan).collect();
    let covered = |cell: Cell| {
        let (low, high) = (grid.lower_corner(cell), grid.lower_corner(cell.offset(1, 1)));
        let free = |i: usize| ((high[i].min(room.1[i]) - low[i].max(room.0[i])) / 0.1).max(0.0);
        let coverage = 1.0 - free(0) * free(1);
        if coverage < 1e-9 { 0.0 } else { coverage }
    };
    let near = |cell: &Cell| (-1..=1).any(|x| (-1..=1).any(|y| covered(cell.offset(x, y)) < 1.0));
    let truth = grid.cells().filter(near).map(|cell| (cell, covered(cell))).collect();
    let body = BodyRecord::standing(0.27, &scans);
    Example { name: "room".to_owned(), ring, scans, body, grid, truth }
}

fn methods() -> Vec<Contender> {
    let contender = |(name, update): (&str, Update)| {
        let method = Method { model: ModelParameters::by_hand(), update };
        Contender { name: name.to_owned(), raw: method.clone(), calibrated: method }
    };
    let updates = [
        ("constant", Update::Constant(0.5)),
        ("coverage", Update::Coverage),
        ("log-odds", Update::LogOdds(LogOdds::default())),
        ("beta", Update::BetaCounting(BetaCounting::default())),
        ("crm", Update::Crm(Crm::default())),
    ];
    updates.into_iter().map(contender).collect()
}

fn rows() -> Vec<ComparisonRow> {
    let training = [example((4.0, 3.0), 1), example((3.1, 2.4), 2)];
    let test = [example((4.4, 2.7), 3)];
    compare(&methods(), &training, &test, &ComparisonSettings::default(), uniform(4))
        .expect("methods")
}

#[test]
fn every_method_knows_more_than_a_constant() {
    let rows = rows();
    assert_eq!(rows.len(), 10);
    for row in &rows[2..] {
        let gain = row.objective.difference.unwrap();
        assert!(gain.value > 0.1 && gain.interval.unwrap().0 > 0.0, "{} {gain:?}", row.name);
        assert_eq!(row.classes.all.cells, rows[0].classes.all.cells);
    }
    assert!(rows[0].objective.difference.is_none() && !rows[0].calibrated && rows[1].calibrated);
}

#[test]
fn an_interval_holds_its_mean() {
    let holds = |e: &CellMean| {
        let rounding = 1e-9;
        e.interval
            .is_some_and(|(low, high)| low - rounding <= e.value && e.value <= high + rounding)
    };
    for row in rows() {
        let c = &row.classes;
        for class in [&c.all, &c.free, &c.partial, &c.solid] {
            assert!(class.cells > 20);
            for estimate in [class.log_likelihood, class.crps, class.error, class.central_90] {
                assert!(holds(&estimate), "{} {estimate:?}", row.name);
            }
        }
        assert!(holds(&row.objective));
    }
}

#[test]
fn the_same_seed_gives_the_same_rows_and_a_method_does_not_differ_from_itself() {
    assert_eq!(rows(), rows());
    let twice = [methods().swap_remove(1), methods().swap_remove(1)];
    let examples = [example((3.0, 2.0), 5)];
    let settings = ComparisonSettings { resamples: 50, ..ComparisonSettings::default() };
    let rows = compare(&twice, &examples, &examples, &settings, uniform(6)).unwrap();
    let difference = rows[2].classes.all.crps.difference.unwrap();
    assert!(difference.value.abs() < 1e-15 && difference.interval == Some((0.0, 0.0)));
}

#[test]
fn a_table_brings_the_transform_of_training_data_to_what_it_should_be() {
    let examples = [example((4.0, 3.0), 1), example((3.1, 2.4), 2)];
    let settings = ComparisonSettings::default();
    for row in compare(&methods(), &examples, &examples, &settings, uniform(7)).unwrap() {
        if row.calibrated {
            let all = row.classes.all;
            let off = (all.central_50.value - 0.5).abs() + (all.central_90.value - 0.9).abs();
            assert!(off < 0.08, "{} {all:?}", row.name);
        }
    }
}

#[test]
fn tuning_spends_its_budget_and_does_no_harm() {
    let examples = [example((3.1, 2.4), 2)];
    for (contender, calibrated) in methods()[2..].iter().flat_map(|c| [(c, false), (c, true)]) {
        let settings = TuneSettings { weighting: Weighting::Classes, calibrated, evaluations: 60 };
        let begin = &contender.raw;
        let mut values = Vec::new();
        let tuned = tune(begin, &begin.update.axes(), &examples, &settings, uniform(8), |value| {
            values.push(value);
            ControlFlow::Continue(())
        });
        let tuned = tuned.unwrap();
        assert_eq!((tuned.evaluations, values.len()), (60, 60));
        assert!(tuned.log_likelihood > values[0].unwrap(), "{}", contender.name);
        let again = covmap_fit::score_method(&examples, &tuned.method, calibrated).unwrap();
        let again = settings.weighting.objective(&again);
        assert!((again - tuned.log_likelihood).abs() < 1e-12);
    }
}

#[test]
fn every_axis_of_a_method_is_another_parameter() {
    for Contender { mut raw, .. } in methods() {
        let axes = raw.update.axes();
        for (i, axis) in (1..).zip(&axes) {
            axis.parameter.set(&mut raw, f64::from(i));
        }
        for (i, axis) in (1..).zip(&axes) {
            assert!(axis.parameter.get(&raw).is_some_and(|v| (v - f64::from(i)).abs() < 1e-12));
        }
    }
}

#[test]
fn parameters_that_a_method_does_not_have_are_refused() {
    let examples = [example((2.0, 2.0), 2)];
    let settings = TuneSettings { weighting: Weighting::Cells, calibrated: false, evaluations: 5 };
    let axis = Axis { parameter: MethodParameter::Lost, from: 0.1, to: 0.9 };
    let go_on = |_| ControlFlow::Continue(());
    let method = &methods()[2].raw;
    let refused = tune(method, &[axis], &examples, &settings, uniform(1), go_on);
    assert_eq!(refused, Err(TuneError::NotItsParameter(MethodParameter::Lost)));
    let nothing = tune(method, &[], &[], &settings, uniform(1), go_on);
    assert_eq!(nothing, Err(TuneError::NoCells));
    let bad = Method { update: Update::Constant(2.0), ..method.clone() };
    assert!(bad.posteriors(&examples[0]).is_err());
}

#[test]
fn cells_belong_to_the_piece_of_the_trajectory_that_is_nearest() {
    let example = example((4.0, 3.0), 1);
    let blocks = trajectory_blocks(&example, 5);
    for ((cell, _), block) in example.truth.iter().zip(&blocks) {
        let x = example.grid.center(*cell).x;
        assert!((x > 1.5 || *block == 0) && (x < 3.5 || *block == 4));
    }
    assert!((0..5).all(|block| blocks.contains(&block)));
}

fn a_range() -> impl Strategy<Value = Range> {
    let echo = prop_oneof![0.0..12.0f64, Just(f64::NAN), Just(-1.0), Just(f64::INFINITY)];
    prop_oneof![4 => echo.prop_map(Range::Echo), 1 => Just(Range::NoEcho), 1 => Just(Range::Missing)]
}

fn a_hostile_example() -> impl Strategy<Value = Example> {
    let number = || prop_oneof![8 => -2.0..4.0f64, 1 => Just(f64::NAN), 1 => Just(1e300)];
    let scan = (number(), number(), number(), prop::collection::vec(a_range(), 24));
    let scan = scan.prop_map(|(x, y, heading, ranges)| {
        let pose = Isometry2::new(Vector2::new(x, y), heading);
        Scan { pose, time: 0.0, ranges }
    });
    let cell = (-3..25i32, -3..25i32, prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0f64]);
    let cell = cell.prop_map(|(x, y, coverage)| (Cell::new(x, y), coverage));
    let parts = (prop::collection::vec(scan, 0..6), prop::collection::vec(cell, 0..30));
    parts.prop_map(|(scans, truth)| Example {
        name: "hostile".to_owned(),
        ring: SonarRing::b21r(),
        body: BodyRecord::standing(0.27, &scans),
        scans,
        grid: Grid::new(Point2::origin(), 0.1, 20, 15).expect("a grid"),
        truth,
    })
}

proptest! {
    #[test]
    fn posteriors_are_distributions_whatever_was_measured(
        example in a_hostile_example(),
        spread in 0.0..=1.0f64, prior in 0.001..=1.0f64, lost in 1e-6..=1.0f64, outlier in 1e-6..=1.0f64
    ) {
        let mut methods = methods();
        let crm = Crm { range_noise: 0.01, outlier, lost, prior, spread, tempering: 0.7 };
        methods[0].raw.update = Update::Crm(crm);
        for Contender { raw: method, name, .. } in methods {
            let posteriors = method.posteriors(&example).unwrap();
            prop_assert_eq!(posteriors.len(), example.truth.len());
            for p in posteriors {
                prop_assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{} {:?}", name, p);
                prop_assert!(p.iter().all(|p| *p >= 0.0));
            }
        }
    }

    #[test]
    fn hostile_examples_are_compared(
        training in prop::collection::vec(a_hostile_example(), 0..3),
        test in prop::collection::vec(a_hostile_example(), 0..3),
        (blocks, resamples, reference) in (0..4usize, 0..5usize, 0..9usize)
    ) {
        let settings =
            ComparisonSettings { weighting: Weighting::Classes, blocks, resamples, reference };
        let rows = compare(&methods(), &training, &test, &settings, uniform(1)).unwrap();
        prop_assert_eq!(rows.len(), 10);
        for row in rows {
            prop_assert!(row.objective.value.is_finite() && row.classes.all.crps.value.is_finite());
        }
    }
}
