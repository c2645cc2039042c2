//! E\[I(l)\]: the expected information gain of a view-point, Eq. (13) and (14).
//!
//! This file holds the equations as printed, in f64: the oracle. [`crate::product`] and
//! [`crate::cause`] are the code that runs.

use crate::{BeamStencil, InformationGain, RangeLikelihood, RangePrediction, Stencil, StencilCell};
use crate::{range_likelihood, reflection};
use covmap::{Cell, CoverageMap, Histogram, product};
use covmap_model::{CauseParameters, Causes, Clues, Outcome, SensorModel};

/// Returns the expected information gain of a view-point, Eq. (14), averaged over the
/// beams \[nats\]:
///
/// ```text
/// E[I(l)] = Σ_d p(d | c) · Σ_{c_i ∈ C(l,d)} I(h(c_i) | d)
/// ```
///
/// With [`InformationGain::MutualInformation`] I is Σ h'·log(h'/h), the relative entropy, and
/// p(d | c) is predicted from expected coverages. `view_point` is l; d runs over the ranges of the
/// stencil and "no echo". I may be negative for a surprising d. Tests compare the fast evaluation
/// with this literal one.
pub fn expected_information_gain(
    map: &CoverageMap,
    model: &SensorModel,
    stencil: &Stencil,
    prediction: RangePrediction,
    view_point: Cell,
) -> f64 {
    let changes = |beam| expected_changes(map, model, stencil, beam, prediction, view_point);
    let sum: f64 = stencil.beams.iter().flat_map(changes).sum();
    let beams = stencil.beams.len() as f64;
    sum / beams
}

/// Returns the expected fall of the entropy of each cell of a beam, in the beam's order \[nats\]:
///
/// ```text
/// Σ_d p(d | c) · I(h_i | d)
/// ```
///
/// This is Eq. (14) without its sum over the cells.
pub fn expected_changes(
    map: &CoverageMap,
    model: &SensorModel,
    stencil: &Stencil,
    beam: &BeamStencil,
    prediction: RangePrediction,
    view_point: Cell,
) -> Vec<f64> {
    let cell = |i: usize| view_point.offset(beam.cells[i].dx, beam.cells[i].dy);
    let mut likelihood = RangeLikelihood::default();
    let rho = |i| match (prediction.gain, model.parameters().update.cause()) {
        (InformationGain::MutualInformation, Some(cause)) => expected(map, cell(i), cause),
        _ => reflection(map, cell(i), prediction.unknown_reflection),
    };
    range_likelihood(beam, prediction.uniform_share, rho, &mut likelihood);
    let mut changes = vec![0.0; beam.cells.len()];
    for k in 0..stencil.outcomes() {
        let p = likelihood.probability(k);
        if p > 0.0 {
            let of = (map, model, beam, view_point);
            let imagined = Imagined::new(of, stencil.outcome(k), prediction.novelty);
            for (i, change) in changes.iter_mut().enumerate().take(beam.reach(k)) {
                let gain = imagined.information_gain(map, cell(i), &beam.cells[i], prediction.gain);
                *change += p * gain;
            }
        }
    }
    changes
}

/// Returns the expected coverage of a cell; 0 outside of the grid.
fn expected(map: &CoverageMap, cell: Cell, parameters: &CauseParameters) -> f64 {
    match map.grid().index(cell) {
        None => 0.0,
        Some(_) if map.is_known(cell) => map.mean(cell),
        Some(_) => parameters.unknown_coverage,
    }
}

/// An imagined reading: its meaning and, with the update by cause, its causes.
struct Imagined<'a> {
    model: &'a SensorModel,
    outcome: Outcome,
    causes: Option<(&'a CauseParameters, Causes)>,
}

/// Returns the causes that an outcome of a beam from a view-point would have by the map as it is;
/// `None` with the product of Eq. (9), which has no causes.
pub fn imagined_causes(
    map: &CoverageMap,
    model: &SensorModel,
    beam: &BeamStencil,
    view_point: Cell,
    outcome: Outcome,
) -> Option<Causes> {
    let parameters = model.parameters().update.cause()?;
    let (end, reach) = match outcome {
        Outcome::Echo(d) => (d, f64::INFINITY),
        _ => (f64::INFINITY, model.reach(outcome) + 1e-9),
    };
    let mut clues = Clues::new(parameters, model.resolution(), end);
    for met in beam.cells.iter().take_while(|c| c.cell_distance <= reach) {
        let cell = view_point.offset(met.dx, met.dy);
        if map.grid().index(cell).is_some() {
            clues.add(met.met(), map.is_known(cell).then(|| map.mean(cell)));
        }
    }
    Some(clues.of(outcome))
}

impl<'a> Imagined<'a> {
    fn new(
        (map, model, beam, view_point): (&CoverageMap, &'a SensorModel, &BeamStencil, Cell),
        outcome: Outcome,
        novelty: f64,
    ) -> Self {
        let causes = imagined_causes(map, model, beam, view_point, outcome);
        let causes = causes.map(|causes| causes.by_as_much(novelty));
        let causes = model.parameters().update.cause().zip(causes);
        Self { model, outcome, causes }
    }

    /// Returns the information gain in one cell, Eq. (13): `I(h | d) = H(h) − H(h'_d)`. It is 0
    /// outside the map and in cells that nothing can change.
    fn information_gain(
        &self,
        map: &CoverageMap,
        cell: Cell,
        met: &StencilCell,
        gain: InformationGain,
    ) -> f64 {
        if map.grid().index(cell).is_none() || map.is_pinned(cell) {
            return 0.0;
        }
        let bins = map.bins();
        let (mut prior, mut evidence, mut posterior) =
            (vec![0.0; bins], vec![0.0; bins], vec![0.0; bins]);
        map.read_posterior(cell, &mut prior);
        match &self.causes {
            None => self.model.evidence(met.cell_distance, self.outcome, &mut evidence),
            Some((parameters, causes)) => {
                let r = self.model.resolution();
                causes.evidence(parameters, r, met.met(), self.outcome, &mut evidence);
            }
        }
        let z = product(&prior, &evidence, &mut posterior);
        if gain == InformationGain::MutualInformation {
            // The histogram of the map is rounded, and sums to 1 but for that.
            let sum: f64 = prior.iter().sum();
            let terms = posterior.iter().zip(&prior);
            let of_bin =
                |(after, before): (&f64, &f64)| after / z * libm::log((after / z) / (before / sum));
            return terms.map(of_bin).sum();
        }
        // The entropy that the map keeps is rounded: too coarse where a reading says little.
        let entropy =
            |weights: &[f64]| Histogram::from_weights(weights).map_or(0.0, |h| h.entropy());
        entropy(&prior) - entropy(&posterior)
    }
}
