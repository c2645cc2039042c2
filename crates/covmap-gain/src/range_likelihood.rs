//! p(d | c): the likelihood of the ranges of a beam, by ray-tracing the most likely map.

use crate::BeamStencil;
use covmap::{Cell, CoverageMap};
use serde::{Deserialize, Serialize};

/// Measure of the gain of a view-point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum InformationGain {
    /// The paper's measure: the expected fall of the entropies, Eq. (14), with ranges that are
    /// predicted from the most likely map. It may be negative: a surprise makes a histogram wider.
    Eq14,
    /// The expected information of Lindley \[1956\], which is never negative: the relative entropy
    /// of the histograms after the reading to those before it. The ranges are predicted from the
    /// map that explains them, by expected coverages. This measure needs the update by cause:
    /// Eq. (9) has no prediction of its own.
    MutualInformation,
}

/// Prediction of ranges, and the measure of their gain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangePrediction {
    /// Measure of the gain of a view-point.
    pub gain: InformationGain,
    /// c_u: reflection of an unknown cell, in \[0, 1\].
    pub unknown_reflection: f64,
    /// η: the share of every predicted range's probability that is spread over all ranges, in
    /// \[0, 1\].
    pub uniform_share: f64,
    /// Novelty of a reading, in \[0, 1\] ([`covmap_model::Looks`]). It belongs to a view-point, and
    /// [`crate::GainCache`] has one for each.
    pub novelty: f64,
}

/// The probability of each range d_k, and of no echo.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RangeLikelihood {
    /// P(k), the probability of an echo from d_k = k·r.
    pub echo: Vec<f64>,
    /// The probability of no echo.
    pub no_echo: f64,
    /// Number of rings that decide: a ring that surely reflects hides all behind it.
    pub traced: usize,
}

/// Returns the reflection of a cell: its most likely coverage, `unknown` where the map is unknown,
/// and 0 outside the grid.
pub fn reflection(map: &CoverageMap, cell: Cell, unknown: f64) -> f64 {
    match map.grid().index(cell) {
        None => 0.0,
        Some(_) if map.is_known(cell) => map.mode(cell),
        Some(_) => unknown,
    }
}

/// Writes the likelihood of every outcome of a beam, p(d | c) of Eq. (14), to `out`.
///
/// ```text
/// q_k = Σ w_i ρ_i over the ring S_k      P(k) = q_k · Π_{j<k} (1 − q_j)
/// P(no echo) = Π (1 − q_j)
/// ```
///
/// A share η of all is then spread evenly. `reflection(i)` is ρ of the stencil's i-th cell,
/// `uniform_share` is η. Reading: the paper says "a ray-tracing technique similar to Moravec and
/// Elfes using the current maximum likelihood coverage map"; on a map of zeros and ones along one
/// ray this is its first hit.
#[inline]
pub fn range_likelihood(
    beam: &BeamStencil,
    uniform_share: f64,
    reflection: impl Fn(usize) -> f64,
    out: &mut RangeLikelihood,
) {
    let even = uniform_share / (beam.rings.len() + 1) as f64;
    let keep = 1.0 - uniform_share;
    let mut survival = 1.0;
    out.echo.clear();
    out.traced = 0;
    for ring in &beam.rings {
        let mut q = 0.0;
        if survival > 0.0 {
            out.traced += 1;
            for (i, weight) in ring.clone().zip(&beam.weights[ring.clone()]) {
                q += weight * reflection(i);
            }
            // The weights sum to 1 but for rounding.
            q = if q > 1.0 - 1e-12 { 1.0 } else { q };
        }
        out.echo.push(keep * survival * q + even);
        survival *= 1.0 - q;
    }
    out.no_echo = keep * survival + even;
}

impl RangeLikelihood {
    /// Returns the probability of an outcome by its index: an echo from d_k, or, past them, no
    /// echo.
    pub fn probability(&self, k: usize) -> f64 {
        self.echo.get(k).copied().unwrap_or(self.no_echo)
    }

    /// Returns V(l) of one beam, the one predicate of sight: the number of the beam's cells, in
    /// order of distance, that are in the footprint of its outcome with a total probability ≥ ½.
    pub fn cells_in_sight(&self, beam: &BeamStencil) -> usize {
        let likely = |p: f64| p >= 0.5 - 1e-12;
        let mut tail = 0.0;
        let mut in_sight = 0;
        let mut with_no_echo = self.no_echo;
        for (p, reach) in self.echo.iter().zip(&beam.echo_reach).rev() {
            tail += p;
            if *reach >= beam.no_echo_reach {
                with_no_echo = tail + self.no_echo;
            }
            let total = if *reach <= beam.no_echo_reach { tail + self.no_echo } else { tail };
            if likely(total) {
                in_sight = *reach;
                break;
            }
        }
        if likely(with_no_echo) { in_sight.max(beam.no_echo_reach) } else { in_sight }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use crate::Stencil;
    use covmap_model::{ModelParameters, SensorModel};
    use covmap_sonar::SonarRing;
    use proptest::prelude::*;

    fn beam() -> BeamStencil {
        let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
        Stencil::new(&model, 0.0).beams.swap_remove(0)
    }

    fn likelihood(beam: &BeamStencil, share: f64, rho: impl Fn(usize) -> f64) -> RangeLikelihood {
        let mut out = RangeLikelihood::default();
        range_likelihood(beam, share, rho, &mut out);
        out
    }

    #[test]
    fn on_a_map_of_zeros_and_ones_it_is_the_first_hit() {
        let beam = beam();
        let wall = beam.rings[17].clone();
        let p = likelihood(&beam, 0.0, |i| if i >= wall.start { 1.0 } else { 0.0 });
        assert_eq!((p.echo[17], p.no_echo), (1.0, 0.0));
        assert_eq!(p.cells_in_sight(&beam), beam.echo_reach[17]);
    }

    #[test]
    fn nothing_reflects_in_open_space() {
        let beam = beam();
        let p = likelihood(&beam, 0.0, |_| 0.0);
        assert_eq!(p.no_echo, 1.0);
        assert_eq!(p.cells_in_sight(&beam), beam.no_echo_reach);
    }

    proptest! {
        #[test]
        fn the_likelihood_sums_to_one_and_sight_is_its_median(
            rho in prop::collection::vec(prop_oneof![3 => Just(0.0), 1 => 0.0..=1.0f64], 200),
            share in prop_oneof![Just(0.0), 0.0..=1.0f64]
        ) {
            let beam = beam();
            let p = likelihood(&beam, share, |i| rho[i]);
            prop_assert!((p.echo.iter().sum::<f64>() + p.no_echo - 1.0).abs() < 1e-9);
            let total = |i: usize| -> f64 {
                (0..=p.echo.len()).filter(|k| beam.reach(*k) > i).map(|k| p.probability(k)).sum()
            };
            let in_sight = (0..beam.cells.len()).filter(|i| total(*i) >= 0.5 - 1e-12).count();
            let near_half = (0..beam.cells.len()).any(|i| (total(i) - 0.5).abs() < 1e-9);
            prop_assert!(near_half || in_sight == p.cells_in_sight(&beam));
        }
    }
}
