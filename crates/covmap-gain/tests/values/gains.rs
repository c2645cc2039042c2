//! Eq. (13) and (14) in numbers.
//!
//! The robot stands in the middle of five cells and looks to both sides, 2 m far. Its posteriors
//! over the coverages 0, ½ and 1 are
//!
//! ```text
//! cell 0  unknown   1  [.1 .2 .7]   2  the robot   3  [.8 .15 .05]   4  [.2 .5 .3]
//! ```
//!
//! so that cell 1 reflects everything, cell 3 nothing and cell 4 one half. With Eq. (9) as
//!
//! ```python
//! def N(m, s, x): return exp(-((x - m) / s)**2 / 2) / (s * sqrt(2 * pi))
//! def evidence(dl, d):                   # d is None without an echo
//!     if d is None: m, s, g = 0, .25 + .01 * dl + .03 * 2, 2.0
//!     else:
//!         m, g = min(max(.5 + dl - d, 0), 1), .1 + .05 * dl + .02 * d
//!         s = .6 if abs(dl - d) <= .5 else .25 + .01 * dl + .03 * d
//!     return normalised(g + N(m, s, x) for x in (0, .5, 1))
//! def I(h, dl, d): return H(h) - H(normalised(h * evidence(dl, d)))
//! ```
//!
//! the information gains of Eq. (13) are
//!
//! ```text
//! I(h_3 | 2 m) = .320093   I(h_4 | 2 m) =  .047961
//! I(h_3 | ∅)   = .112740   I(h_4 | ∅)   = −.017216   I(h_1 | 1 m) = −.040143
//! ```

use super::close;
use super::corridor::{Corridor, PLAIN};
use covmap_gain::{InformationGain, RangePrediction, Upkeep};
use covmap_model::{
    FootprintRule, Linear, ModelParameters, NoEchoParameters, ProductParameters, Update,
};

fn model() -> ModelParameters {
    ModelParameters {
        bins: 3,
        usable_range: 2.0,
        footprint: FootprintRule::Cones { half_angle: 0.0 },
        update: Update::Product(ProductParameters {
            sigma_out: Linear { base: 0.25, per_cell_distance: 0.01, per_range: 0.03 },
            sigma_in: 0.6,
            gamma: Linear { base: 0.1, per_cell_distance: 0.05, per_range: 0.02 },
            behind: 0.0,
            no_echo: NoEchoParameters { range: 2.0, gamma: 2.0 },
            tempering: 1.0,
        }),
    }
}

fn posteriors(corridor: &mut Corridor) {
    corridor.know(1, &[0.1, 0.2, 0.7]);
    corridor.know(3, &[0.8, 0.15, 0.05]);
    corridor.know(4, &[0.2, 0.5, 0.3]);
}

/// E[I] of the robot's cell by the literal equations and by the cache.
#[track_caller]
fn check(
    directions: &[f64],
    prediction: RangePrediction,
    tell: impl Fn(&mut Corridor),
    expected: f64,
) {
    for upkeep in [Upkeep::Kept, Upkeep::OnDemand] {
        let mut corridor = Corridor::new(5, directions, &model(), prediction, upkeep);
        tell(&mut corridor);
        close(corridor.literal_gain(2), expected, 1e-6);
        close(corridor.gain(2), expected, 1e-5);
    }
}

#[test]
fn the_expected_gain_weighs_every_outcome_by_its_likelihood() {
    // Cell 4 answers with ½: ½ (.320093 + .047961) + ½ (.112740 − .017216).
    check(&[0.0], PLAIN, posteriors, 0.231_789_17);
}

#[test]
fn the_expected_gain_is_the_mean_over_all_beams() {
    // To the left 1 m is sure: −.040143. ½ (.231789 − .040143)
    check(&[0.0, 180.0], PLAIN, posteriors, 0.095_823_30);
    // A third ray, to the side, leaves the grid and gains nothing.
    check(&[0.0, 90.0, 180.0], PLAIN, posteriors, 2.0 / 3.0 * 0.095_823_30);
}

#[test]
fn a_uniform_share_makes_every_outcome_possible() {
    // η = .4 over 0 m, 1 m, 2 m and ∅: .1 each, and .6 of what it was; the unknown cell 0 counts.
    // To the right .180325, to the left −.064316.
    let prediction = RangePrediction { uniform_share: 0.4, ..PLAIN };
    check(&[0.0, 180.0], prediction, posteriors, 0.058_004_47);
}

#[test]
fn unknown_cells_reflect_as_much_as_they_are_said_to() {
    // Both cells to the left are unknown: P(1 m) = .3, P(2 m) = .7 · .3, P(∅) = .49, which is
    // worth .076902.
    let tell = |corridor: &mut Corridor| {
        corridor.know(3, &[0.8, 0.15, 0.05]);
        corridor.know(4, &[0.2, 0.5, 0.3]);
    };
    let prediction =
        RangePrediction { gain: InformationGain::Eq14, unknown_reflection: 0.3, ..PLAIN };
    check(&[0.0, 180.0], prediction, tell, 0.154_345_70);
}

#[test]
fn nothing_is_gained_in_a_pinned_cell() {
    let tell = |corridor: &mut Corridor| {
        posteriors(corridor);
        corridor.pin(3);
    };
    // ½ (.047961 − .017216)
    check(&[0.0], PLAIN, tell, 0.015_372_55);
}
