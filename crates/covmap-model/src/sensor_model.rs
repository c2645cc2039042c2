//! The sensor model: the meaning of readings, and the evidence of one about one cell.

use crate::cause::Clues;
use crate::parameters::Repeats;
use crate::product::mu;
use crate::{Causes, Footprint, Met, ModelError, ModelParameters, Outcome, Registers, Update};
use covmap::{CoverageMap, Histogram};
use covmap_sonar::{Range, SonarRing};

/// The sensor model: for every cell and every reading a distribution over coverages.
///
/// Valid by construction: the constraints of section 3 hold for every instance.
#[derive(Debug, Clone)]
pub struct SensorModel {
    parameters: ModelParameters,
    resolution: f64,
    footprint: Footprint,
    /// Vector registers with which scans are integrated.
    registers: pulp::Arch,
}

impl SensorModel {
    /// Creates the model of a ring on a grid of cells of side `resolution` \[m\].
    ///
    /// # Errors
    /// If a parameter is out of its interval, σ_in does not exceed every σ_out in range, a
    /// σ is below half a bin's width, or the footprint does not fit the ring.
    pub fn new(
        parameters: &ModelParameters,
        ring: &SonarRing,
        resolution: f64,
    ) -> Result<Self, ModelError> {
        parameters.validate()?;
        ModelError::within("resolution", resolution, 1e-3, 10.0)?;
        let footprint = Footprint::new(ring, &parameters.footprint)?;
        // Integrating takes a fifth longer with wider ones.
        let registers = Registers::Avx2.or_narrower();
        Ok(Self { parameters: parameters.clone(), resolution, footprint, registers })
    }

    /// Returns the parameters.
    pub fn parameters(&self) -> &ModelParameters {
        &self.parameters
    }

    /// Returns the side of a cell, r \[m\].
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// Returns the repetition among readings from one place.
    pub fn repeats(&self) -> Repeats {
        self.parameters.update.cause().map_or(Repeats::NONE, |cause| cause.repeats)
    }

    pub(crate) fn registers(&self) -> pulp::Arch {
        self.registers
    }

    /// Returns the footprints of the beams.
    pub fn footprint(&self) -> &Footprint {
        &self.footprint
    }

    /// Returns whether this model can update a map: as many bins, the same resolution.
    pub fn fits(&self, map: &CoverageMap) -> bool {
        map.bins() == self.parameters.bins
            && (map.grid().resolution() - self.resolution).abs() < 1e-12
    }

    /// Returns the meaning of a reading; `None` for one that says nothing.
    pub fn outcome(&self, range: Range) -> Option<Outcome> {
        match range {
            Range::Echo(d) if !d.is_finite() || d < 0.0 => None,
            Range::Echo(d) if d > self.parameters.usable_range => Some(Outcome::Beyond(d)),
            Range::Echo(d) => Some(Outcome::Echo(d)),
            Range::NoEcho => Some(Outcome::NoEcho),
            Range::Missing => None,
        }
    }

    /// Returns the farthest cell distance \[m\] at which an outcome updates a cell: C(l, d) of
    /// Eq. (14) ends there.
    ///
    /// Reading: "up to 20cm behind a cell, in which the measurement ends" are cells with
    /// `d^l − d ≤ r/2 + 0.20`; the cells beyond stay as they are. Choice: no echo marks cells up to
    /// a range of its own, and an echo from beyond the usable range marks those before it.
    pub fn reach(&self, outcome: Outcome) -> f64 {
        let half = 0.5 * self.resolution;
        match outcome {
            Outcome::Echo(d) => d + half + self.parameters.update.behind(),
            Outcome::Beyond(d) => (d - half).min(self.parameters.usable_range),
            Outcome::NoEcho => self.parameters.update.no_echo_range(),
        }
    }

    /// Returns the largest [`Self::reach`] of all outcomes \[m\].
    pub fn max_reach(&self) -> f64 {
        self.reach(Outcome::Echo(self.parameters.usable_range))
    }

    /// Returns the mean coverage of a cell, Eq. (10): with δ = d^l − d,
    ///
    /// ```text
    /// μ(δ) = 0          δ < −r/2     the beam passed through
    ///        1/2 + δ/r  |δ| ≤ r/2    the beam ended here
    ///        1          δ > r/2      just behind
    /// ```
    pub fn mu(&self, delta: f64) -> f64 {
        mu(self.resolution, delta)
    }

    /// Evaluates p(c_l = x | d) at the coverage x of every bin. With the paper's update, Eq. (9):
    ///
    /// ```text
    /// p(c_l = x | d) ∝ (γ(d^l, d) + N(μ(d^l − d), σ(d^l, d), x))^κ
    /// ```
    ///
    /// normalised over the bins. `cell_distance` is d^l \[m\]; κ is the tempering exponent,
    /// 1 in the paper. Reading: γ is a density level added to the Gaussian's density.
    ///
    /// The evidence of the update by cause depends on the map ([`Causes`]); this is the evidence
    /// about a cell on the beam's axis in an unknown map.
    ///
    /// # Panics
    /// If `out` has not one place for each bin.
    pub fn evidence(&self, cell_distance: f64, outcome: Outcome, out: &mut [f64]) {
        let p = &self.parameters;
        assert_eq!(out.len(), p.bins, "one place for each bin");
        match &p.update {
            Update::Product(product) => {
                let reading = product.reading(outcome, p.usable_range);
                product.evidence(self.resolution, &reading, cell_distance, out);
            }
            Update::Cause(cause) => {
                let causes = match outcome {
                    Outcome::Echo(_) => Causes::in_an_unknown_map(cause),
                    _ => Clues::new(cause, self.resolution, 0.0).of(outcome),
                };
                let met = Met { cell_distance, across: 0.5 };
                causes.evidence(cause, self.resolution, met, outcome, out);
            }
        }
    }

    /// Returns [`Self::evidence`] as a histogram: a column of Fig. 3.
    pub fn evidence_histogram(&self, cell_distance: f64, outcome: Outcome) -> Histogram {
        let mut weights = vec![0.0; self.parameters.bins];
        self.evidence(cell_distance, outcome, &mut weights);
        Histogram::from_weights(&weights).unwrap_or_else(|| Histogram::uniform(weights.len()))
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use crate::{Linear, ProductParameters};
    use proptest::prelude::*;

    fn model() -> SensorModel {
        SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.1).unwrap()
    }

    fn refuse(change: impl Fn(&mut ProductParameters)) -> ModelError {
        let parameters = ModelParameters::by_hand().with_product(change);
        SensorModel::new(&parameters, &SonarRing::b21r(), 0.1).unwrap_err()
    }

    #[test]
    fn the_mean_is_inverse_to_the_traversed_part_of_the_cell() {
        let model = model();
        assert_eq!(model.mu(-0.2), 0.0);
        assert!((model.mu(-0.05)).abs() < 1e-12 && (model.mu(0.05) - 1.0).abs() < 1e-12);
        assert!((model.mu(0.02) - 0.7).abs() < 1e-12);
        assert_eq!(model.mu(0.2), 1.0);
    }

    #[test]
    fn cells_in_front_are_free_and_cells_behind_are_covered() {
        let column = |distance| model().evidence_histogram(distance, Outcome::Echo(1.0));
        assert_eq!(column(0.5).mode(), 0.0);
        assert_eq!(column(1.1).mode(), 1.0);
        assert!(column(0.5).probabilities()[0] > 0.2 && column(1.1).probabilities()[10] > 0.2);
        let broadest = column(1.0).entropy();
        assert!([0.3, 0.6, 0.9, 1.06, 1.2].iter().all(|d| column(*d).entropy() < broadest));
    }

    #[test]
    fn evidence_ends_twenty_centimetres_behind() {
        let parameters = ModelParameters::by_hand().with_product(|product| {
            product.behind = 0.2;
        });
        let model = SensorModel::new(&parameters, &SonarRing::b21r(), 0.1).unwrap();
        assert!((model.reach(Outcome::Echo(1.0)) - 1.25).abs() < 1e-12);
        assert_eq!(model.reach(Outcome::NoEcho), 1.0);
        assert_eq!(model.reach(Outcome::Beyond(7.0)), 3.0);
    }

    #[test]
    fn readings_that_say_nothing_have_no_outcome() {
        let model = model();
        assert_eq!(model.outcome(Range::Missing), None);
        assert_eq!(model.outcome(Range::Echo(f64::NAN)), None);
        assert_eq!(model.outcome(Range::Echo(-1.0)), None);
        assert_eq!(model.outcome(Range::Echo(3.5)), Some(Outcome::Beyond(3.5)));
    }

    #[test]
    fn a_model_that_breaks_the_papers_constraints_is_refused() {
        assert!(matches!(refuse(|p| p.sigma_in = 0.15), ModelError::SigmaIn { .. }));
        assert!(matches!(
            refuse(|p| p.sigma_out.base = 0.03),
            ModelError::SigmaBelowHalfBin { .. }
        ));
        assert_eq!(refuse(|p| p.gamma.per_range = -0.1), ModelError::NotMonotone("gamma"));
        assert_eq!(refuse(|p| p.gamma.base = 0.0), ModelError::NoUniformShare);
        let one_bin = ModelParameters { bins: 1, ..ModelParameters::by_hand() };
        let refused = SensorModel::new(&one_bin, &SonarRing::b21r(), 0.1).unwrap_err();
        assert_eq!(refused, ModelError::Bins(1));
        let nan = Linear { base: f64::NAN, per_cell_distance: 0.0, per_range: 0.0 };
        assert_eq!(refuse(|p| p.sigma_out = nan), ModelError::NotMonotone("sigma_out"));
        assert!(matches!(refuse(|p| p.no_echo.range = 9.0), ModelError::OutOfRange { .. }));
    }

    proptest! {
        #[test]
        fn evidence_is_a_distribution_and_never_rules_anything_out(
            distance in 0.0..3.5f64, range in 0.0..3.0f64, tempering in 0.1..=1.0f64
        ) {
            let parameters = ModelParameters::by_hand().with_product(|product| { product.tempering = tempering; });
            let model = SensorModel::new(&parameters, &SonarRing::b21r(), 0.1).unwrap();
            for outcome in [Outcome::Echo(range), Outcome::Beyond(range + 3.0), Outcome::NoEcho] {
                let mut p = [0.0; 11];
                model.evidence(distance, outcome, &mut p);
                prop_assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                prop_assert!(p.iter().all(|p| *p > 0.0));
            }
        }
    }
}
