//! Errors of the tables, part by part, on the histograms with which they were made.

use super::basis::{Basis, MIXTURE_TOLERANCE, ReadingGain};
use super::beyond::{BeyondOutcomes, Lattice};
use super::rings::{CellPosition, MOST_LENIENT, RingBuilder, UnmixedRing, unmixed};
use super::spanning::SpanningSet;
use crate::Stencil;
use crate::evidence::BinEvidence;
use crate::numbers::as_f64;
use crate::probes::{ProbeHistograms, TOLERANCE};
use covmap::lanes::TOGETHER;
use covmap_model::{Outcome, SensorModel};

/// Errors of the tables of the update by the product, Eq. (9), for the outcomes that end beyond a
/// ring.
///
/// These are most of the outcomes. Each step is measured for the worst of the probed histograms,
/// outcomes and cells.
///
/// An error is that of the gain of one cell, in units of the largest gain of its histogram plus a
/// gain that matters in a decision. It is measured, and no proof for other histograms.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TableErrors {
    /// Error of the interpolation between some ranges and distances.
    pub interpolation: f64,
    /// Error of the mixtures of a few readings that stand for those at the nodes.
    pub mixtures: f64,
    /// Error of the fewer sums that stand for the nodes.
    pub fewer_sums: f64,
    /// Error of the three together.
    pub all: f64,
    /// Error of a single reading in single precision, instead of double.
    pub single_precision: f64,
    /// Allowed error of an interpolated gain.
    pub allowed: f64,
    /// Allowed error in the rings of fewest cells.
    pub allowed_in_small_rings: f64,
    /// Number of probed histograms.
    pub probes: usize,
    /// Number of readings at nodes.
    pub readings: usize,
    /// Number of readings that stand for [those at nodes](Self::readings) as mixtures.
    pub basis: usize,
}

/// The gain of a cell over the range of an echo from beyond it, exact and as the tables of the
/// update by the product interpolate it.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeInterpolation {
    /// d^l of the cell, in the middle of its ring \[m\].
    pub cell_distance: f64,
    /// Range \[m\], gain, and interpolated gain \[nats\].
    pub curve: Vec<(f64, f64, f64)>,
    /// Range \[m\] and gain \[nats\] at the nodes.
    pub nodes: Vec<(f64, f64)>,
    /// Allowed error of an interpolated gain \[nats\].
    pub allowed: f64,
}

impl RangeInterpolation {
    /// Interpolates the gain of a cell of a distance ring with a histogram, at a number of ranges.
    ///
    /// Returns `None` for another update, and for a ring with fewer than two ranges beyond it.
    pub fn of(
        model: &SensorModel,
        heading: f64,
        ring: usize,
        histogram: &[f64],
        points: usize,
    ) -> Option<Self> {
        model.parameters().update.product()?;
        let (stencil, probes) = (Stencil::new(model, heading), ProbeHistograms::of_model(model));
        let builder = RingBuilder::new(model, &stencil, &probes, ring);
        let ranges = stencil.ranges.get(ring + 1..).filter(|ranges| ranges.len() > 1)?;
        let (nodes, shift, cell_distance) = builder.in_range(ring + 1);
        let u: Vec<f64> = histogram.iter().map(|h| h * libm::log(h.max(1e-300))).collect();
        let before = -u.iter().sum::<f64>();
        let gain = |range: f64| {
            let evidence = BinEvidence::new(model, cell_distance, Outcome::Echo(range));
            before - evidence.entropy_after(histogram, &u)
        };
        let (low, high) = (ranges[0], ranges[ranges.len() - 1]);
        let at = |i: usize| low + (high - low) * as_f64(i) / as_f64(points.max(2) - 1);
        let between: Vec<f64> = (0..points.max(2)).map(at).collect();
        let weights = nodes.like_at(&between, shift);
        let at_nodes: Vec<f64> = nodes.at.iter().map(|range| gain(*range)).collect();
        let interpolated =
            |weights: &Vec<f64>| weights.iter().zip(&at_nodes).map(|(w, g)| w * g).sum::<f64>();
        let curve: Vec<(f64, f64, f64)> = between
            .iter()
            .zip(&weights)
            .map(|(range, weights)| (*range, gain(*range), interpolated(weights)))
            .collect();
        let largest = curve.iter().map(|(_, gain, _)| gain.abs()).fold(0.0, f64::max);
        let allowed = builder.leniency * TOLERANCE * (largest + probes.scale());
        let nodes = nodes.at.iter().copied().zip(at_nodes).collect();
        Some(Self { cell_distance, curve, nodes, allowed })
    }
}

impl TableErrors {
    /// Measures the errors of a model's tables, which are made for it. Returns `None` for another
    /// update.
    pub fn probed(model: &SensorModel, heading: f64) -> Option<Self> {
        model.parameters().update.product()?;
        let (stencil, probes) = (Stencil::new(model, heading), ProbeHistograms::of_model(model));
        let built = unmixed(model, &stencil, &probes);
        let in_front: Vec<&BinEvidence> = built.iter().flat_map(UnmixedRing::in_front).collect();
        let after: Vec<Vec<f64>> = in_front.iter().map(|reading| probes.after(reading)).collect();
        let units = probes.allowed(&after, 1.0);
        let gains: Vec<Vec<f64>> =
            after.into_iter().map(|after| probes.in_units(after, &units)).collect();
        let SpanningSet { members, weights } = SpanningSet::of(&gains, MIXTURE_TOLERANCE);
        let of_members: Vec<&Vec<f64>> = members.iter().map(|member| &gains[*member]).collect();
        let mixtures =
            gains.iter().zip(&weights).map(|(gains, w)| far(gains, &sum(w, &of_members)));
        let mut errors = Self {
            mixtures: TOLERANCE * mixtures.fold(0.0, f64::max),
            single_precision: TOLERANCE * probes.single_precision(&in_front, &units),
            allowed: TOLERANCE,
            allowed_in_small_rings: MOST_LENIENT * TOLERANCE,
            probes: gains.first().map_or(0, Vec::len),
            readings: in_front.len(),
            basis: members.len(),
            ..Self::default()
        };
        let mut basis = Basis::default();
        let mut queue = basis.extend(&in_front, &probes);
        let mut first = 0;
        for UnmixedRing { ring, lattice, .. } in built {
            let Some(lattice) = lattice else { continue };
            let nodes = lattice.of_outcomes.first().map_or(0, Vec::len) * lattice.distances;
            let (exact, mixed) = (&gains[first..first + nodes], &weights[first..first + nodes]);
            first += nodes;
            let mixed: Vec<Vec<f64>> = mixed.iter().map(|w| sum(w, &of_members)).collect();
            let places = lattice.cells(&ring.cells, &stencil);
            let (nearest, of_outcomes) = (lattice.nearest, lattice.of_outcomes.clone());
            let of_cells = lattice.of_cells.clone();
            let mut readings = Vec::new();
            let reduced = lattice.reduce(&mut queue, &mut readings);
            let reduced_gains: Vec<Vec<f64>> =
                readings.iter().map(|reading| mixture(reading, &of_members)).collect();
            for (beam, cell, distance) in places {
                for (k, in_range) in of_outcomes.iter().enumerate() {
                    let range = stencil.ranges[nearest + k];
                    let evidence = BinEvidence::new(model, distance, Outcome::Echo(range));
                    let wanted = probes.in_units(probes.after(&evidence), &units);
                    let of_node = product(in_range, &of_cells[beam][cell]);
                    let interpolated = sum(&of_node, &refs(exact));
                    let in_mixtures = sum(&of_node, &refs(&mixed));
                    let weights = reduced.weights_of(k, beam, cell);
                    let found = sum(&weights, &refs(&reduced_gains));
                    let worst = |so_far: &mut f64, a: &[f64], b: &[f64]| {
                        *so_far = so_far.max(TOLERANCE * far(a, b));
                    };
                    worst(&mut errors.interpolation, &wanted, &interpolated);
                    worst(&mut errors.fewer_sums, &in_mixtures, &found);
                    worst(&mut errors.all, &wanted, &found);
                }
            }
        }
        Some(errors)
    }
}

impl UnmixedRing {
    /// Returns the readings of cells in front of the end, which are those of the lattice.
    fn in_front(&self) -> impl Iterator<Item = &BinEvidence> {
        let all = self.readings.iter();
        all.filter(|(position, _)| *position == CellPosition::InFront).map(|(_, evidence)| evidence)
    }
}

impl Lattice {
    /// Returns one cell of each distance: its beam, its place in the ring, and the distance \[m\].
    fn cells(
        &self,
        cells: &[std::ops::Range<usize>],
        stencil: &Stencil,
    ) -> Vec<(usize, usize, f64)> {
        let mut places: Vec<(usize, usize, f64)> = Vec::new();
        for (beam, cells) in cells.iter().enumerate() {
            for (place, i) in cells.clone().enumerate() {
                places.push((beam, place, stencil.beams[beam].cells[i].cell_distance));
            }
        }
        places.sort_by(|a, b| a.2.total_cmp(&b.2));
        places.dedup_by(|a, b| a.2.to_bits() == b.2.to_bits());
        places
    }
}

impl BeyondOutcomes {
    /// Returns the weight of every reading in an outcome, from the nearest on, times its factor in
    /// a cell.
    fn weights_of(&self, outcome: usize, beam: usize, cell: usize) -> Vec<f64> {
        let weight = |i: usize| {
            let (some, one) = (i / TOGETHER, i % TOGETHER);
            let factor = self.factors[beam][some][cell][one];
            f64::from(self.weights[some][outcome][one]) * f64::from(factor)
        };
        (0..self.count).map(weight).collect()
    }
}

/// Returns the gains of a mixture, of all probes.
fn mixture(reading: &ReadingGain, of_members: &[&Vec<f64>]) -> Vec<f64> {
    match reading {
        ReadingGain::Evaluated(_) => Vec::new(),
        ReadingGain::Mixed { weights, .. } => {
            let weights: Vec<f64> = weights.iter().copied().map(f64::from).collect();
            sum(&weights, of_members)
        }
    }
}

/// Returns all products of a number of one list and one of another.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().flat_map(|a| b.iter().map(move |b| a * b)).collect()
}

fn refs(vectors: &[Vec<f64>]) -> Vec<&Vec<f64>> {
    vectors.iter().collect()
}

/// Returns a sum of vectors, each times a weight.
fn sum(weights: &[f64], vectors: &[&Vec<f64>]) -> Vec<f64> {
    let mut sum = vec![0.0; vectors.first().map_or(0, |vector| vector.len())];
    for (weight, vector) in weights.iter().zip(vectors) {
        sum.iter_mut().zip(*vector).for_each(|(sum, x)| *sum += weight * x);
    }
    sum
}

/// Returns the largest difference of two numbers in the same place.
fn far(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_model::ModelParameters;
    use covmap_sonar::SonarRing;

    fn model() -> SensorModel {
        SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.2).unwrap()
    }

    #[test]
    fn every_step_is_within_what_it_may_be_off() {
        let errors = TableErrors::probed(&model(), 0.0).unwrap();
        assert!(errors.basis < errors.readings && errors.probes > 100, "{errors:?}");
        assert!(errors.mixtures > 0.0 && errors.mixtures <= 0.51 * errors.allowed, "{errors:?}");
        assert!(errors.interpolation > errors.single_precision, "{errors:?}");
        // Over the range and over the distance, each as much.
        assert!(errors.interpolation < 2.0 * errors.allowed_in_small_rings, "{errors:?}");
        assert!(errors.all < 3.0 * errors.allowed_in_small_rings, "{errors:?}");
        let by_cause = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.2).unwrap();
        assert!(TableErrors::probed(&by_cause, 0.0).is_none());
    }

    #[test]
    fn a_gain_is_met_at_its_nodes_and_nearly_met_between_them() {
        let histogram = [1.0 / 11.0; 11];
        let over = RangeInterpolation::of(&model(), 0.0, 4, &histogram, 101).unwrap();
        assert!(over.nodes.len() < 12 && over.curve.len() == 101, "{over:?}");
        for (_, gain, interpolated) in &over.curve {
            assert!((gain - interpolated).abs() < over.allowed, "{gain} {interpolated}");
        }
        assert!(RangeInterpolation::of(&model(), 0.0, 99, &histogram, 101).is_none());
    }
}
