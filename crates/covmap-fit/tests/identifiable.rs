//! Truths that are drawn from the maps of a known model give its parameters back.

#![allow(clippy::unwrap_used, reason = "a test that fails must fail")]

use covmap::{Grid, bin_coverage};
use covmap_fit::{
    Axis, BodyRecord, Example, FitSettings, Parameter, SearchSettings, Weighting, fit,
};
use covmap_model::ModelParameters;
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};
use std::ops::ControlFlow;

/// Returns uniform numbers in \[0, 1): SplitMix64.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let bits = ((z ^ (z >> 31)) >> 11) as f64;
        bits / 9_007_199_254_740_992.0
    }
}

/// Returns a scan of random ranges, and truths drawn from the posteriors of a model for it.
fn drawn_example(known: &ModelParameters, uniform: &mut impl FnMut() -> f64) -> Example {
    let grid = Grid::new(Point2::new(-3.45, -3.45), 0.1, 69, 69).unwrap();
    let ranges = (0..24).map(|_| Range::Echo(0.4 + 2.5 * uniform())).collect();
    let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges };
    let mut example = Example {
        name: "drawn".into(),
        ring: SonarRing::b21r(),
        scans: vec![scan.clone(), scan],
        body: BodyRecord::default(),
        grid,
        truth: Vec::new(),
    };
    let map = example.map(known).unwrap();
    for cell in grid.cells().filter(|cell| map.is_known(*cell)) {
        let (u, mut sum, mut bin) = (uniform(), 0.0, 0);
        for p in map.histogram(cell).probabilities() {
            sum += p;
            bin += usize::from(u >= sum);
        }
        example.truth.push((cell, bin_coverage(bin.min(10), 11)));
    }
    example
}

/// Fits some parameters, each with its known value and its bounds, and compares.
#[track_caller]
fn check(searched: &[(Parameter, f64, f64, f64)]) {
    let mut known = ModelParameters::by_hand();
    searched.iter().for_each(|(parameter, value, ..)| parameter.set(&mut known, *value));
    let mut uniform = random(5);
    let examples: Vec<Example> = (0..24).map(|_| drawn_example(&known, &mut uniform)).collect();

    let begin = ModelParameters::by_hand();
    let axis =
        |&(parameter, _, from, to): &(Parameter, f64, f64, f64)| Axis { parameter, from, to };
    let settings = FitSettings {
        weighting: Weighting::Cells,
        axes: searched.iter().map(axis).collect(),
        starts: 1,
        search: SearchSettings { last_step: 0.004, evaluations: 400, ..SearchSettings::default() },
    };
    let go_on = |_: &_| ControlFlow::Continue(());
    let fitted = fit(&examples, &begin, &settings, &mut uniform, go_on).unwrap();
    let at_known = covmap_fit::score(&examples, &known).unwrap().all.log_likelihood;
    assert!(fitted.log_likelihood > at_known - 1e-3, "{} {at_known}", fitted.log_likelihood);
    for &(parameter, value, from, to) in searched {
        let found = parameter.get(&fitted.parameters).unwrap();
        assert!((found - value).abs() < 0.1 * (to - from), "{parameter:?}: {found}, not {value}");
    }
}

// γ's base and slopes, and γ and the tempering exponent, can stand in for each other: along
// such a ridge the likelihood is flat, so they are not sought together.

#[test]
fn gamma_and_sigma_are_found_again() {
    check(&[
        (Parameter::GammaBase, 0.2, 0.02, 1.0),
        (Parameter::SigmaOutBase, 0.09, 0.05, 0.14),
        (Parameter::SigmaIn, 0.3, 0.2, 0.6),
    ]);
}

#[test]
fn the_tempering_and_the_slopes_of_sigma_are_found_again() {
    check(&[
        (Parameter::Tempering, 0.45, 0.2, 1.0),
        (Parameter::SigmaOutPerCellDistance, 0.015, 0.0, 0.03),
    ]);
}
