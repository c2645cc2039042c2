//! The update by cause, by hand: one ray along the x axis over cells of 1 m, three bins.

use super::{all_close, beam, close};
use covmap::{Cell, CoverageMap, Grid};
use covmap_model::{
    CauseParameters, FootprintRule, FreeSpace, Linear, ModelError, ModelParameters, NoEchoShare,
    Repeats, SensorModel, Update, integrate, integrate_literally,
};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};

fn cause() -> CauseParameters {
    CauseParameters {
        bearings: 1,
        range_tolerance: 0.25,
        cell_depth: 1.0,
        unknown_coverage: 0.5,
        sharpness: 1.0,
        chance: 1.0,
        first_echo: 1.0,
        sigma_in: Linear { base: 0.5, per_cell_distance: 0.0, per_range: 0.0 },
        behind: 1.0,
        behind_weight: 0.5,
        sigma_behind: 0.5,
        free: FreeSpace { share: 0.5, range: 4.0, width: 1.0, sigma: 0.5 },
        beyond: 0.5,
        no_echo: NoEchoShare { range: 3.0, share: 0.25 },
        repeats: Repeats::NONE,
    }
}

fn model_of(cause: CauseParameters) -> Result<SensorModel, ModelError> {
    let parameters = ModelParameters {
        bins: 3,
        usable_range: 5.0,
        footprint: FootprintRule::Cones { half_angle: 0.0 },
        update: Update::Cause(cause),
    };
    SensorModel::new(&parameters, &SonarRing::new(vec![beam(0.0, 0.0, 0.0)]).unwrap(), 1.0)
}

/// The sensor looks along the x axis from the centre of cell 0.
fn empty() -> CoverageMap {
    CoverageMap::new(Grid::new(Point2::new(-0.5, -0.5), 1.0, 9, 1).unwrap(), 3).unwrap()
}

/// The posteriors of cells after a reading, by the literal equations and as they run.
#[track_caller]
fn check(map: &CoverageMap, range: Range, cells: &[(i32, [f64; 3])]) {
    let model = model_of(cause()).unwrap();
    let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges: vec![range] };
    for integrate in [integrate, integrate_literally] {
        let mut map = map.clone();
        integrate(&model, &mut map, &scan);
        for (x, expected) in cells {
            let histogram = map.histogram(Cell::new(*x, 0));
            all_close(histogram.probabilities(), expected, 2e-6);
        }
    }
}

/// In an unknown map one surface may have answered, in the cell 3 m ahead: a = ½, c = L =
/// ½/(½ + 1) = ⅓. With σ = ½ the Gaussians over the bins are (1, e^−½, e^−2)/1.741 866 =
/// (.574 097, .348 207, .077 695) at 0, and (e^−½, 1, e^−½)/2.213 061 = (.274 069, .451 863,
/// .274 069) at ½.
#[test]
fn an_echo_is_shared_by_what_may_have_caused_it() {
    // 1 m ahead, in front: f = ½·exp(−1/16) = .469 707, g = f·L = .156 569;
    // (1 − g)/3 = .281 144, and g times the Gaussian at 0.
    let passed = [0.371_030, 0.335_662, 0.293_309];
    // 3 m ahead, at the end: μ = ½, (1 − ⅓)/3 = .222 222, and ⅓ of the Gaussian at ½.
    let ended = [0.313_579, 0.372_843, 0.313_579];
    // 4 m ahead, behind: s = ½·⅓, (1 − s)/3 = .277 778, and s times the Gaussian at 1.
    let behind = [0.290_727, 0.335_812, 0.373_461];
    check(&empty(), Range::Echo(3.0), &[(1, passed), (3, ended), (4, behind), (5, [1.0 / 3.0; 3])]);
}

#[test]
fn what_stands_before_it_did_not_let_an_echo_through() {
    let mut map = empty();
    map.multiply(Cell::new(2, 0), &[0.0, 0.2, 0.8]);
    // E = .9, o = .8, v = S = .2: a = .2·.2·½ = .02, c = L = .02/1.02 = .019 608.
    // (1 − c)/3 = .326 797, and c times the Gaussian at ½.
    let ended = [0.332_171, 0.335_657, 0.332_171];
    // g = .469 707·L = .009 210.
    let passed = [0.335_551, 0.333_470, 0.330_979];
    check(&map, Range::Echo(3.0), &[(3, ended), (1, passed)]);
}

#[test]
fn without_a_cause_a_beam_passed_as_far_as_the_view_was_clear() {
    // An echo from beyond: L = ½·S = ½. 1 m ahead g = .469 707/2 = .234 854.
    check(&empty(), Range::Echo(7.0), &[(1, [0.389_877, 0.336_827, 0.273_296])]);
    // No echo: L = ¼, up to 3 m. g = .117 427, and nothing 4 m ahead.
    let passed = [0.361_605, 0.335_080, 0.303_315];
    check(&empty(), Range::NoEcho, &[(1, passed), (4, [1.0 / 3.0; 3])]);
    // Behind the cell of E = .9 an echo from beyond passed with L = ½·.2 = .1.
    let mut map = empty();
    map.multiply(Cell::new(2, 0), &[0.0, 0.2, 0.8]);
    check(&map, Range::Echo(7.0), &[(1, [0.344_643, 0.334_032, 0.321_325])]);
}

#[test]
fn parameters_outside_their_domain_are_refused_with_numbers() {
    let refuse = |change: fn(&mut CauseParameters)| {
        let mut cause = cause();
        change(&mut cause);
        model_of(cause).map(|_| ()).unwrap_err().to_string()
    };
    assert_eq!(refuse(|p| p.bearings = 0), "model.bearings: 0 is not in 1..=16");
    assert_eq!(refuse(|p| p.bearings = 17), "model.bearings: 17 is not in 1..=16");
    let message = refuse(|p| p.free.share = 1.5);
    assert_eq!(message, "model.free.share: 1.5 must lie in [0, 1]");
    assert_eq!(refuse(|p| p.behind = 0.2), "model.behind: 0.2 must lie in [0.25, 2]");
    assert!(refuse(|p| p.free.sigma = 0.2).starts_with("model.free.sigma: 0.2 must lie in [0.25"));
    assert!(refuse(|p| p.chance = f64::NAN).starts_with("model.chance: NaN"));
    assert!(refuse(|p| p.sigma_in.per_range = -1.0).contains("model.sigma_in"));
    assert!(refuse(|p| p.no_echo.range = 5.5).contains("no_echo.range: 5.5 must lie in [0, 5]"));
    close(cause().no_echo.range, 3.0, 0.0);
}
