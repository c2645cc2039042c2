//! The update by cause as a whole: as it runs against the literal equations, and in any order of
//! the sensors.
#![allow(clippy::unwrap_used, reason = "tests")]

use covmap::{Cell, CoverageMap, Grid};
use covmap_model::{
    CauseParameters, FootprintRule, FreeSpace, Linear, Looks, ModelParameters, NoEchoShare,
    Repeats, SensorModel, Update, integrate, integrate_new_literally,
};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2, Vector2};
use proptest::prelude::*;

fn a_cause() -> impl Strategy<Value = CauseParameters> {
    let free = (0.0..=1.0f64, 0.1..3.0f64, 0.2..9.0f64, 0.5..0.9f64)
        .prop_map(|(share, range, width, sigma)| FreeSpace { share, range, width, sigma });
    let end =
        (0.5..0.9f64, 0.0..0.2f64, 0.0..0.2f64).prop_map(|(base, per_cell_distance, per_range)| {
            Linear { base, per_cell_distance, per_range }
        });
    let surface = (1..=16usize, 0.001..0.1f64, 0.8..1.5f64, 0.0..=1.0f64);
    let answers = (0.1..3.0f64, 0.05..10.0f64, 0.0..8.0f64);
    let behind = (0.1..0.3f64, 0.0..=1.0f64, 0.5..0.9f64);
    let passing = (0.0..=1.0f64, 0.0..1.5f64, 0.0..=1.0f64);
    (free, end, surface, answers, behind, passing).prop_map(
        |(free, sigma_in, surface, answers, behind, passing)| CauseParameters {
            bearings: surface.0,
            range_tolerance: surface.1,
            cell_depth: surface.2,
            unknown_coverage: surface.3,
            sharpness: answers.0,
            chance: answers.1,
            first_echo: answers.2,
            sigma_in,
            behind: behind.0,
            behind_weight: behind.1,
            sigma_behind: behind.2,
            free,
            beyond: passing.0,
            no_echo: NoEchoShare { range: passing.1, share: passing.2 },
            repeats: Repeats { share: passing.2, distance: surface.2, bearing: answers.0 },
        },
    )
}

/// Sigmas in units of what the bins can show.
fn a_model() -> impl Strategy<Value = ModelParameters> {
    let rule = prop_oneof![
        (0.05..0.2f64).prop_map(|half_angle| FootprintRule::Sectors { half_angle }),
        (0.0..0.4f64).prop_map(|half_angle| FootprintRule::Cones { half_angle }),
    ];
    (2..=64usize, a_cause(), rule).prop_map(|(bins, mut cause, footprint)| {
        let bin = 1.0 / (bins - 1) as f64;
        for sigma in [&mut cause.sigma_in.base, &mut cause.sigma_behind, &mut cause.free.sigma] {
            *sigma *= bin.max(0.1);
        }
        ModelParameters { bins, usable_range: 1.5, footprint, update: Update::Cause(cause) }
    })
}

fn scans(most: usize) -> impl Strategy<Value = Vec<Scan>> {
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
    prop::collection::vec(scan, 1..most)
}

fn empty_map(bins: usize) -> CoverageMap {
    let grid = Grid::new(Point2::new(-1.5, -1.45), 0.1, 31, 29).unwrap();
    let mut map = CoverageMap::new(grid, bins).unwrap();
    map.pin_free(Cell::new(14, 15));
    map
}

#[track_caller]
fn same(a: &CoverageMap, b: &CoverageMap, tolerance: f64) -> Result<(), TestCaseError> {
    for cell in a.grid().cells() {
        prop_assert_eq!(a.is_known(cell), b.is_known(cell));
        let (a, b) = (a.histogram(cell), b.histogram(cell));
        for (a, b) in a.probabilities().iter().zip(b.probabilities()) {
            prop_assert!((a - b).abs() < tolerance, "{:?}: {} {}", cell, a, b);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn posteriors_are_those_of_the_literal_equations(model in a_model(), scans in scans(5)) {
        let model = SensorModel::new(&model, &SonarRing::b21r(), 0.1).unwrap();
        let bins = model.parameters().bins;
        let (mut fast, mut literal) = (empty_map(bins), empty_map(bins));
        let mut looks = Looks::new(&model);
        for scan in &scans {
            let novelty = looks.novelty(&model, &scan.pose);
            looks.integrate(&model, &mut fast, scan);
            integrate_new_literally(&model, &mut literal, scan, &novelty);
        }
        same(&fast, &literal, 2e-5)?;
    }

    #[test]
    fn the_order_of_the_sensors_does_not_matter(
        model in a_model(), scans in scans(4), order in Just((0..24).collect::<Vec<usize>>()).prop_shuffle()
    ) {
        let ring = SonarRing::b21r();
        let permuted = SonarRing::new(order.iter().map(|i| ring.beams()[*i]).collect()).unwrap();
        let bins = model.bins;
        let build = |ring: &SonarRing, turn: &dyn Fn(&Scan) -> Scan| {
            let model = SensorModel::new(&model, ring, 0.1).unwrap();
            let mut map = empty_map(bins);
            scans.iter().for_each(|scan| drop(integrate(&model, &mut map, &turn(scan))));
            map
        };
        let shuffled = |scan: &Scan| Scan {
            ranges: order.iter().map(|i| scan.ranges[*i]).collect(),
            ..scan.clone()
        };
        same(&build(&ring, &Scan::clone), &build(&permuted, &shuffled), 2e-5)?;
    }
}

/// A known wall 1 m ahead: an echo from there is believed, an echo from behind it is not, and
/// nothing is ruled out in an unknown room.
#[test]
fn a_known_wall_explains_its_echo_and_hides_what_is_behind_it() {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
    let grid = Grid::new(Point2::new(-2.0, -2.0), 0.1, 60, 40).unwrap();
    let scan = |d: f64| {
        let mut ranges = vec![Range::Missing; 24];
        ranges[0] = Range::Echo(d);
        Scan { pose: Isometry2::identity(), time: 0.0, ranges }
    };
    let at = |map: &CoverageMap, d: f64| {
        let (sin, cos) = libm::sincos(7.5f64.to_radians());
        map.mean(map.grid().cell_at(Point2::new((0.25 + d) * cos, (0.25 + d) * sin)).unwrap())
    };
    let mut known = CoverageMap::new(grid, 11).unwrap();
    (0..40).for_each(|_| drop(integrate(&model, &mut known, &scan(1.0))));
    assert!(at(&known, 0.5) < 0.15 && at(&known, 1.05) > 0.5, "{}", at(&known, 1.05));
    // From then on echoes from 2 m do not wash it away.
    let wall = at(&known, 1.05);
    let mut mirrored = known.clone();
    (0..40).for_each(|_| drop(integrate(&model, &mut mirrored, &scan(2.0))));
    assert!(at(&mirrored, 1.05) > wall - 0.05, "{} {wall}", at(&mirrored, 1.05));
}

/// ρ_0 = .6 and λ = .2 m: from the same place .4 is new, from λ away 1 − .6·e^−½, and of a third look
/// from the first place the product of both.
#[test]
fn a_second_look_from_one_place_tells_less() {
    let model = ModelParameters::b21r()
        .with_cause(|cause| cause.repeats = Repeats { share: 0.6, distance: 0.2, bearing: 0.1 });
    let model = SensorModel::new(&model, &SonarRing::b21r(), 0.1).unwrap();
    let mut looks = Looks::new(&model);
    let pose = |x: f64, heading: f64| Isometry2::new(Vector2::new(x, 0.0), heading);
    let novelty = |looks: &Looks, x, heading| looks.novelty(&model, &pose(x, heading))[5];
    let look = |looks: &mut Looks, x: f64| {
        let scan = Scan { pose: pose(x, 0.0), time: 0.0, ranges: vec![Range::Missing; 24] };
        looks.integrate(&model, &mut empty_map(11), &scan);
    };
    let is = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}");
    is(novelty(&looks, 0.0, 0.0), 1.0);
    look(&mut looks, 0.0);
    is(novelty(&looks, 0.0, 0.0), 0.4);
    is(novelty(&looks, 0.2, 0.0), 1.0 - 0.6 * libm::exp(-0.5));
    is(novelty(&looks, 0.61, 0.0), 1.0);
    // A turn by one sensor's spacing looks along the same axes; half of it along none of them.
    is(novelty(&looks, 0.0, 15f64.to_radians()), 0.4);
    assert!(novelty(&looks, 0.0, 7.5f64.to_radians()) > 0.7);
    look(&mut looks, 0.2);
    is(novelty(&looks, 0.0, 0.0), 0.4 * (1.0 - 0.6 * libm::exp(-0.5)));
}
