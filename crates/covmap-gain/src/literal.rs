//! E\[I(l)\]: how much a view-point is expected to tell. Eq. (13) and (14).
//!
//! This file is the equations as printed, in f64: the oracle. [`crate::product`] holds what runs.

use crate::{BeamStencil, RangeLikelihood, RangePrediction, Stencil, range_likelihood, reflection};
use covmap::{Cell, CoverageMap, Histogram, product};
use covmap_model::{Outcome, SensorModel};

/// The expected information gain of a view-point, Eq. (14), averaged over the beams \[nats\]:
///
/// ```text
/// E\[I(l)\] = Σ_d p(d | c) · Σ_{c_i ∈ C(l,d)} I(h(c_i) | d)
/// ```
///
/// `view_point` is l; d runs over the ranges of the stencil and "no echo". I may be negative
/// for a surprising d. This is the literal evaluation that the fast one is tested against.
pub fn expected_information_gain(
    map: &CoverageMap,
    model: &SensorModel,
    stencil: &Stencil,
    prediction: RangePrediction,
    view_point: Cell,
) -> f64 {
    let gain = |beam| beam_gain(map, model, stencil, beam, prediction, view_point);
    let sum: f64 = stencil.beams.iter().map(gain).sum();
    #[allow(clippy::cast_precision_loss, reason = "few beams")]
    let beams = stencil.beams.len() as f64;
    sum / beams
}

fn beam_gain(
    map: &CoverageMap,
    model: &SensorModel,
    stencil: &Stencil,
    beam: &BeamStencil,
    prediction: RangePrediction,
    view_point: Cell,
) -> f64 {
    let cell = |i: usize| view_point.offset(beam.cells[i].dx, beam.cells[i].dy);
    let mut likelihood = RangeLikelihood::default();
    let rho = |i| reflection(map, cell(i), prediction.unknown_reflection);
    range_likelihood(beam, prediction.uniform_share, rho, &mut likelihood);
    let mut expected = 0.0;
    for k in 0..stencil.outcomes() {
        let p = likelihood.probability(k);
        if p > 0.0 {
            let gain = |i: usize| {
                information_gain(
                    map,
                    model,
                    cell(i),
                    beam.cells[i].cell_distance,
                    stencil.outcome(k),
                )
            };
            expected += p * (0..beam.reach(k)).map(gain).sum::<f64>();
        }
    }
    expected
}

/// The information gain of one outcome in one cell, Eq. (13): `I(h | d) = H(h) − H(h'_d)`.
/// Nothing is gained outside the map and in cells that nothing can change.
fn information_gain(
    map: &CoverageMap,
    model: &SensorModel,
    cell: Cell,
    cell_distance: f64,
    outcome: Outcome,
) -> f64 {
    if map.grid().index(cell).is_none() || map.is_pinned(cell) {
        return 0.0;
    }
    let bins = map.bins();
    let (mut prior, mut evidence, mut posterior) =
        (vec![0.0; bins], vec![0.0; bins], vec![0.0; bins]);
    map.read_posterior(cell, &mut prior);
    model.evidence(cell_distance, outcome, &mut evidence);
    product(&prior, &evidence, &mut posterior);
    // The entropy that the map keeps is rounded: too coarse where a reading says little.
    let entropy = |weights: &[f64]| Histogram::from_weights(weights).map_or(0.0, |h| h.entropy());
    entropy(&prior) - entropy(&posterior)
}
