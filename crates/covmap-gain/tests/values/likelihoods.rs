//! p(d | c), the weights of a ring, and V(l) in numbers.

use super::corridor::{Corridor, PLAIN};
use super::{all_close, close};
use covmap::{Cell, CoverageMap, Grid};
use covmap_gain::{
    BeamStencil, GainCache, RangeLikelihood, Stencil, StencilCell, Upkeep, ViewPoints,
    range_likelihood, reflection,
};
use covmap_model::{
    FootprintRule, Linear, ModelParameters, NoEchoParameters, ProductParameters, SensorModel,
    Update,
};
use covmap_sonar::{Beam, SonarRing};
use nalgebra::{Isometry2, Point2};

/// A beam of two rings, of two cells each, with unequal weights. No echo covers all cells, and an
/// echo all up to its ring.
fn beam() -> BeamStencil {
    let cell = |dx, cell_distance| StencilCell { dx, dy: 0, cell_distance, across: 0.5 };
    BeamStencil {
        cells: vec![cell(1, 0.9), cell(1, 1.1), cell(2, 1.9), cell(2, 2.1)],
        weights: vec![0.75, 0.25, 0.6, 0.4],
        rings: vec![0..2, 2..4],
        echo_reach: vec![2, 4],
        no_echo_reach: 4,
    }
}

fn likelihood(rho: [f64; 4], share: f64) -> RangeLikelihood {
    let mut out = RangeLikelihood::default();
    range_likelihood(&beam(), share, |i| rho[i], &mut out);
    out
}

#[test]
fn a_ring_reflects_the_weighted_mean_of_its_cells() {
    // q_0 = .75 · .4 + .25 · .8 = .5, q_1 = .4 · .5 = .2:
    // P(0) = .5, P(1) = .5 · .2 = .1, P(∅) = .5 · .8 = .4.
    let p = likelihood([0.4, 0.8, 0.0, 0.5], 0.0);
    all_close(&p.echo, &[0.5, 0.1], 1e-12);
    close(p.no_echo, 0.4, 1e-12);
    all_close(&[0, 1, 2].map(|k| p.probability(k)), &[0.5, 0.1, 0.4], 1e-12);
    // A share of .3 over three outcomes: .7 of each and .1.
    let p = likelihood([0.4, 0.8, 0.0, 0.5], 0.3);
    all_close(&[0, 1, 2].map(|k| p.probability(k)), &[0.45, 0.17, 0.38], 1e-12);
}

#[test]
fn a_ring_that_surely_reflects_hides_what_is_behind() {
    let p = likelihood([1.0, 1.0, 0.3, 0.5], 0.0);
    all_close(&p.echo, &[1.0, 0.0], 1e-12);
    assert_eq!((p.no_echo, p.traced), (0.0, 1));
}

#[test]
fn cells_are_in_sight_of_a_beam_with_a_probability_of_at_least_one_half() {
    let in_sight = |rho| likelihood(rho, 0.0).cells_in_sight(&beam());
    // Beyond the first ring: .5 of all outcomes, and then .45.
    assert_eq!(in_sight([0.4, 0.8, 0.0, 0.5]), 4);
    assert_eq!(in_sight([0.4, 1.0, 0.0, 0.5]), 2);
}

#[test]
fn no_echo_sees_as_far_as_it_reaches() {
    // q_0 and q_1 of the two rings; how many cells both echoes and no echo cover.
    let in_sight = |q: [f64; 2], echo_reach: [usize; 2], no_echo_reach| {
        let beam = BeamStencil { echo_reach: echo_reach.to_vec(), no_echo_reach, ..beam() };
        likelihood([q[0], q[0], q[1], q[1]], 0.0).cells_in_sight(&beam)
    };
    // P(1) = .6, or .4 and P(∅) = .6, which does not reach so far.
    assert_eq!(in_sight([0.0, 0.6], [2, 4], 2), 4);
    assert_eq!(in_sight([0.0, 0.4], [2, 4], 2), 2);
    // P(1) = .28 and P(∅) = .42, which reaches farther, are .7 together.
    assert_eq!(in_sight([0.3, 0.4], [2, 4], 5), 4);
    // P(1) = .4 passes the two cells of no echo, with P(∅) = .4.
    assert_eq!(in_sight([0.2, 0.5], [1, 4], 2), 2);
}

/// Four beams in cells of 1 m; the first covers [−45°, 45°).
fn four_beams() -> (ModelParameters, SonarRing) {
    let angles = [0.0, 90.0, 180.0, 270.0f64];
    let beams = angles.map(|degrees| Beam {
        pose: Isometry2::rotation(degrees.to_radians()),
        half_angle: 0.8,
        min_range: 0.0,
        max_range: 9.0,
    });
    let parameters = ModelParameters {
        usable_range: 3.0,
        footprint: FootprintRule::Sectors { half_angle: 45f64.to_radians() },
        ..ModelParameters::by_hand()
    }
    .with_product(|product| {
        product.behind = 0.2;
        product.sigma_out = Linear { base: 0.1, per_cell_distance: 0.0, per_range: 0.0 };
        product.no_echo = NoEchoParameters { range: 2.0, gamma: 1.0 };
    });
    let ring = SonarRing::new(beams.to_vec()).unwrap();
    (parameters, ring)
}

#[test]
fn the_weights_of_a_ring_are_the_angular_widths_of_its_cells() {
    let (parameters, ring) = four_beams();
    let stencil = Stencil::new(&SensorModel::new(&parameters, &ring, 1.0).unwrap(), 0.0);
    assert_eq!((stencil.ranges.as_slice(), stencil.outcomes()), (&[0.0, 1.0, 2.0, 3.0][..], 5));
    let beam = &stencil.beams[0];
    // Ring 1, from ½ m to 1½ m: (1, 0) at 1 and (1, −1) at √2. Widths 1 and .707107.
    // Ring 2, to 2½ m: (2, 0) at 2 and (2, ±1) at √5. Widths .5 and twice .447214.
    let places: Vec<(i32, i32)> = beam.cells.iter().map(|c| (c.dx, c.dy)).collect();
    assert_eq!(places[..5], [(1, 0), (1, -1), (2, 0), (2, -1), (2, 1)]);
    assert_eq!(beam.rings[..3], [0..0, 0..2, 2..5]);
    let expected = [0.585_786_4, 0.414_213_6, 0.358_570_2, 0.320_714_9, 0.320_714_9];
    all_close(&beam.weights[..5], &expected, 1e-6);
    close(beam.cells[1].cell_distance, 2f64.sqrt(), 1e-9);
    // An echo from 1 m covers what is nearer than 1 + ½ + .2 m; no echo what is within 2 m.
    assert_eq!(beam.echo_reach[..3], [0, 2, 5]);
    assert_eq!(beam.no_echo_reach, 3);
}

#[test]
fn what_reflects_is_the_most_likely_coverage() {
    let mut corridor = corridor(4.0);
    corridor.know(1, &posterior(4));
    let cell = |x| Cell::new(x, 0);
    assert_eq!(reflection(&corridor.map, cell(1), 0.3), 0.4);
    assert_eq!(reflection(&corridor.map, cell(2), 0.3), 0.3);
    assert_eq!(reflection(&corridor.map, cell(9), 0.3), 0.0);
}

/// Five cells of eleven bins, and a ray of 4 m to the right, or of `no_echo` [m] without an echo.
fn corridor(no_echo: f64) -> Corridor {
    let constant = |base| Linear { base, per_cell_distance: 0.0, per_range: 0.0 };
    let model = ModelParameters {
        bins: 11,
        usable_range: 4.0,
        footprint: FootprintRule::Cones { half_angle: 0.0 },
        update: Update::Product(ProductParameters {
            sigma_out: constant(0.1),
            sigma_in: 0.2,
            gamma: constant(0.1),
            behind: 0.0,
            no_echo: NoEchoParameters { range: no_echo, gamma: 0.2 },
            tempering: 1.0,
        }),
    };
    Corridor::new(5, &[0.0], &model, PLAIN, Upkeep::OnDemand)
}

/// Almost sure of one bin.
fn posterior(bin: usize) -> Vec<f64> {
    (0..11).map(|k| if k == bin { 0.9 } else { 0.01 }).collect()
}

#[test]
fn the_cache_sees_through_what_reflects_up_to_one_half() {
    // The cell 2 m ahead reflects .5, .6 or .7: beyond it .5, .4 or .3 of all outcomes are left.
    for (bin, farthest) in [(5, 4), (6, 2), (7, 2)] {
        let mut corridor = corridor(4.0);
        corridor.know(2, &posterior(bin));
        let expected: Vec<(i32, f32)> =
            [(1, 1.0), (2, 2.0), (3, 3.0), (4, 4.0)][..farthest].to_vec();
        assert_eq!(corridor.in_sight(0), expected, "{bin}");
    }
    // Two cells of .3: .7 · .7 = .49 are left behind the second.
    let mut corridor = corridor(4.0);
    corridor.know(1, &posterior(3));
    corridor.know(2, &posterior(3));
    assert_eq!(corridor.in_sight(0), [(1, 1.0), (2, 2.0)]);
}

#[test]
fn the_cache_sees_without_an_echo_as_far_as_that_reaches() {
    // As in `no_echo_sees_as_far_as_it_reaches`, an echo from k m covers k cells.
    let in_sight = |no_echo, bins: &[(i32, usize)]| {
        let mut corridor = corridor(no_echo);
        bins.iter().for_each(|&(x, bin)| corridor.know(x, &posterior(bin)));
        corridor.in_sight(0).len()
    };
    assert_eq!(in_sight(1.0, &[(3, 6)]), 3);
    assert_eq!(in_sight(1.0, &[(3, 4)]), 1);
    assert_eq!(in_sight(4.0, &[(2, 3), (3, 4)]), 3);
    assert_eq!(in_sight(2.0, &[(1, 2), (3, 5)]), 2);
}

#[test]
fn the_cache_weighs_the_cells_of_a_ring_by_their_angular_width() {
    // Of the first ring, (1, 0) and (1, −1), one cell is a wall: .585786 or .414214 of the beam
    // are hidden, which of equal weights would be ½.
    let (parameters, stencil_ring) = four_beams();
    let model = SensorModel::new(&parameters, &stencil_ring, 1.0).unwrap();
    let in_sight = |wall: (i32, i32)| {
        let grid = Grid::new(Point2::origin(), 1.0, 9, 9).unwrap();
        let mut map = CoverageMap::new(grid, 11).unwrap();
        let mut cache = GainCache::new(&model, 0.0, grid, PLAIN, Upkeep::OnDemand).unwrap();
        let wall = Cell::new(4, 4).offset(wall.0, wall.1);
        map.multiply(wall, &posterior(10));
        cache.update(&map, wall);
        let [here, beyond] = [(4, 4), (6, 4)].map(|(x, y)| grid.index(Cell::new(x, y)).unwrap());
        cache.refresh_sight(&ViewPoints::one(&grid, here));
        cache.sees(here, |(index, _)| *index == beyond)
    };
    assert_eq!([(1, 0), (1, -1)].map(in_sight), [false, true]);
}
