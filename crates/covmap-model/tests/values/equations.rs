//! Eq. (8), (9) and (10) in numbers.
//!
//! The numbers are those of the following, where the comments give σ and γ:
//!
//! ```python
//! def N(m, s, x): return exp(-((x - m) / s)**2 / 2) / (s * sqrt(2 * pi))
//! def p(m, s, g): w = [g + N(m, s, x) for x in (0, .5, 1)]; return [v / sum(w) for v in w]
//! ```

use super::{all_close, at, close, grid, model, parameters, scan};
use covmap::CoverageMap;
use covmap_model::{
    ModelError, NoEchoParameters, Outcome, ProductParameters, SensorModel, integrate,
    integrate_literally,
};
use covmap_sonar::Range;

#[track_caller]
fn check(model: &SensorModel, cell_distance: f64, outcome: Outcome, expected: [f64; 3]) {
    let mut p = [0.0; 3];
    model.evidence(cell_distance, outcome, &mut p);
    all_close(&p, &expected, 1e-8);
}

#[test]
fn a_cell_that_the_beam_passes_is_free() {
    // d^l = 2, d = 4: μ = 0, σ = .25 + .02 + .12 = .39, γ = .1 + .1 + .08 = .28.
    let expected = [0.554_238_04, 0.310_401_97, 0.135_359_99];
    check(&model(&parameters()), 2.0, Outcome::Echo(4.0), expected);
}

#[test]
fn a_cell_in_which_the_beam_ends_is_covered_in_part() {
    // d^l = 4.1, d = 4: μ = ½ + .1 = .6, σ = .6, γ = .1 + .205 + .08 = .385.
    let expected = [0.287_021_45, 0.378_940_14, 0.334_038_40];
    check(&model(&parameters()), 4.1, Outcome::Echo(4.0), expected);
}

#[test]
fn a_cell_behind_the_end_is_covered() {
    // d^l = 5.5, d = 4: μ = 1, σ = .25 + .055 + .12 = .425, γ = .1 + .275 + .08 = .455.
    let expected = [0.181_441_08, 0.326_520_74, 0.492_038_18];
    check(&model(&parameters()), 5.5, Outcome::Echo(4.0), expected);
}

#[test]
fn half_a_cell_from_the_end_is_still_inside() {
    // |δ| = r/2: σ = .6 with γ = .1 + .225 + .08 = .405 and .1 + .175 + .08 = .355.
    let model = model(&parameters());
    check(&model, 4.5, Outcome::Echo(4.0), [0.226_906_54, 0.347_777_77, 0.425_315_69]);
    check(&model, 3.5, Outcome::Echo(4.0), [0.431_148_30, 0.348_693_70, 0.220_158_00]);
    close(model.mu(0.5), 1.0, 1e-12);
    close(model.mu(-0.5), 0.0, 1e-12);
    close(model.mu(-0.2), 0.3, 1e-12);
}

#[test]
fn no_echo_has_a_uniform_share_of_its_own_and_no_end() {
    // d = 3, the range of no echo: σ = .25 + .02 + .09 = .36, γ = 2; at its very end as well.
    let model = model(&parameters());
    check(&model, 2.0, Outcome::NoEcho, [0.411_462_19, 0.320_679_57, 0.267_858_25]);
    let mut end = [0.0; 3];
    model.evidence(3.0, Outcome::NoEcho, &mut end);
    assert!(end[0] > end[1] && end[1] > end[2], "{end:?}");
}

#[test]
fn an_echo_from_beyond_the_usable_range_passes_all_before_it() {
    // d = 5, the usable range: σ = .25 + .02 + .15 = .42, γ = .1 + .1 + .1 = .3.
    let expected = [0.526_633_19, 0.323_447_67, 0.149_919_15];
    check(&model(&parameters()), 2.0, Outcome::Beyond(7.0), expected);
}

#[test]
fn tempering_is_an_exponent() {
    // The square roots of the densities of the first test.
    let model = model(&parameters().with_product(|product| {
        product.tempering = 0.5;
    }));
    check(&model, 2.0, Outcome::Echo(4.0), [0.445_919_05, 0.333_710_67, 0.220_370_28]);
}

#[test]
fn readings_mean_what_they_say_up_to_the_usable_range() {
    let model = model(&parameters());
    assert_eq!(model.outcome(Range::Echo(5.0)), Some(Outcome::Echo(5.0)));
    assert_eq!(model.outcome(Range::Echo(5.01)), Some(Outcome::Beyond(5.01)));
    // r/2 + 2 m behind the end; half a cell before an echo from beyond, or the usable range.
    let reaches = [Outcome::Echo(4.0), Outcome::Beyond(5.2), Outcome::Beyond(7.0), Outcome::NoEcho];
    all_close(&reaches.map(|outcome| model.reach(outcome)), &[6.5, 4.7, 5.0, 3.0], 1e-12);
    close(model.max_reach(), 7.5, 1e-12);
}

/// Evidence of a ray of 4 m, and then of one of 3 m, about the cells 1, 2, … m ahead.
///
/// By Eq. (9) with δ = d^l − d: passed, where δ < −½; ended in, at δ = 0, with μ = ½; behind, up to
/// δ = 2; and nothing beyond. By Eq. (8) the second is the product of both.
const AFTER_ONE: [[f64; 3]; 6] = [
    [0.577_937_0, 0.303_341_2, 0.118_721_8],
    [0.554_238_0, 0.310_402_0, 0.135_360_0],
    [0.533_546_2, 0.316_192_2, 0.150_261_6],
    [0.309_644_4, 0.380_711_2, 0.309_644_4],
    [0.175_805_3, 0.324_842_9, 0.499_351_8],
    [0.186_815_3, 0.328_039_4, 0.485_145_3],
];
const AFTER_TWO: [[f64; 3]; 6] = [
    [0.783_516_1, 0.189_149_6, 0.027_334_3],
    [0.751_922_4, 0.210_039_8, 0.038_037_8],
    [0.494_443_8, 0.366_306_9, 0.139_249_3],
    [0.140_902_8, 0.353_507_5, 0.505_589_7],
    [0.073_395_7, 0.260_123_9, 0.666_480_4],
    [0.186_815_3, 0.328_039_4, 0.485_145_3],
];
/// −Σ p log p of [`AFTER_TWO`].
const ENTROPIES: [f64; 6] =
    [0.604_517_5, 0.666_500_3, 0.990_652_1, 0.988_547_4, 0.812_404_3, 1.029_956_6];

#[test]
fn a_map_is_the_product_of_what_all_readings_say() {
    let model = model(&parameters());
    for integrate in [integrate, integrate_literally] {
        let mut map = CoverageMap::new(grid(), 3).unwrap();
        for (range, expected) in [(4.0, AFTER_ONE), (3.0, AFTER_TWO)] {
            integrate(&model, &mut map, &scan(Range::Echo(range)));
            for (x, expected) in (1..).zip(&expected) {
                let mut p = [0.0; 3];
                map.read_posterior(at(x, 0), &mut p);
                all_close(&p, expected, 2e-6);
            }
        }
        for (x, entropy) in (1..).zip(ENTROPIES) {
            close(map.entropy(at(x, 0)), entropy, 5e-6);
        }
        let known: Vec<_> = map.grid().cells().filter(|c| map.is_known(*c)).collect();
        assert_eq!(known, (1..=6).map(|x| at(x, 0)).collect::<Vec<_>>());
    }
}

#[test]
fn the_end_cell_must_be_the_least_certain() {
    // The largest σ outside is that of 5 + 2 m and 5 m: .25 + .07 + .15 = .47.
    let ring = covmap_sonar::SonarRing::new(vec![super::beam(0.0, 0.0, 0.0)]).unwrap();
    let with = |change: fn(&mut ProductParameters)| {
        let parameters = parameters().with_product(change);
        SensorModel::new(&parameters, &ring, 1.0).map(|_| ())
    };
    assert!(matches!(with(|p| p.sigma_in = 0.469), Err(ModelError::SigmaIn { .. })));
    assert_eq!(with(|p| p.sigma_in = 0.471), Ok(()));
    // Half of the distance of two bins is .25.
    let narrow = with(|p| p.sigma_out.base = 0.249);
    assert!(matches!(narrow, Err(ModelError::SigmaBelowHalfBin { .. })));
    let silent = with(|p| p.no_echo = NoEchoParameters { range: 5.1, gamma: 1.0 });
    assert!(matches!(silent, Err(ModelError::OutOfRange { name: "no_echo.range", .. })));
}

#[test]
fn a_model_fits_maps_of_its_bins_and_its_resolution() {
    let model = model(&parameters());
    let map = |r: f64, bins| {
        let grid = covmap::Grid::new(nalgebra::Point2::origin(), r, 2, 2).unwrap();
        CoverageMap::new(grid, bins).unwrap()
    };
    assert!(model.fits(&map(1.0, 3)) && !model.fits(&map(1.0, 4)) && !model.fits(&map(0.5, 3)));
}
