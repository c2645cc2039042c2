//! The imagined readings that give the gains of a distance ring's cells, and their weights.
//!
//! In front of the end the gain of a cell is smooth in its distance and in the range, so that a few
//! readings stand for all ranges ([`Nodes`]); behind the end it is smooth in the distance; at the end
//! every distance has a reading of its own.

use super::basis::{Basis, MixtureQueue, ReadingGain};
use super::beyond::{BeyondOutcomes, Lattice};
use super::interpolation::Nodes;
use crate::evidence::BinEvidence;
use crate::numbers::{as_f64, to_f32};
use crate::probes::ProbeHistograms;
use crate::{BeamStencil, Stencil};
use covmap_model::{Linear, Outcome, SensorModel};
use std::collections::BTreeSet;
use std::ops::Range;

/// Error of a gain that the reduction of the readings in front may cause, in units of the allowed
/// error of an interpolated gain.
const REDUCED: f64 = 0.3;
/// Largest basis of the readings at the end. If they need a larger one, they are evaluated instead:
/// keeping its gains for every cell would take more memory than it is worth.
const MOST_AT_END: usize = 24;
/// Largest [`RingBuilder::leniency`].
pub(super) const MOST_LENIENT: f64 = 10.0;

/// The cells of all beams at about one distance.
#[derive(Debug, Clone)]
pub(crate) struct DistanceRing {
    /// The cells of each beam, by their rank in its stencil.
    pub(crate) cells: Vec<Range<usize>>,
    /// The readings that give the gains of these cells.
    pub(crate) readings: Vec<ReadingGain>,
    /// The outcomes that end beyond the ring, together.
    pub(crate) beyond: Option<BeyondOutcomes>,
    /// Each outcome that ends in the ring or before it, and covers some of its cells.
    pub(crate) near: Vec<(usize, OutcomeReadings)>,
    /// No echo, if that covers some of the cells.
    pub(crate) no_echo: Option<OutcomeReadings>,
}

/// The readings of a ring that give the gains of one outcome.
#[derive(Debug, Clone)]
pub(crate) struct OutcomeReadings {
    /// The first of the readings.
    pub(crate) first: usize,
    /// The number of readings.
    pub(crate) count: usize,
    pub(crate) cells: CellReadings,
}

/// Weights of the readings in each cell.
#[derive(Debug, Clone)]
pub(crate) enum CellReadings {
    /// For each beam, for each of its cells, the weight of every reading.
    Weighted(Vec<Vec<f32>>),
    /// For each beam, for each of its cells that the outcome covers, a reading of its own.
    Own(Vec<Vec<OwnReading>>),
}

/// A cell with a reading of its own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OwnReading {
    /// Its place among the beam's cells in the ring.
    pub(crate) cell: usize,
    /// The reading's place among those of the outcome.
    pub(crate) reading: usize,
}

/// Returns all rings, nearest first, and the basis of their readings.
pub(crate) fn rings(model: &SensorModel, stencil: &Stencil) -> (Vec<DistanceRing>, Basis) {
    let probes = ProbeHistograms::of_model(model);
    let built = unmixed(model, stencil, &probes);
    let mut basis = Basis::default();
    let of_position = |position| {
        let readings = built.iter().flat_map(|built| &built.readings);
        readings.filter(|(p, _)| *p == position).map(|(_, e)| e).collect::<Vec<&BinEvidence>>()
    };
    let mut in_front = basis.extend(&of_position(CellPosition::InFront), &probes);
    let mut at_end = basis.extend_by_few(&of_position(CellPosition::AtEnd), &probes, MOST_AT_END);
    let mut behind = basis.extend(&of_position(CellPosition::Behind), &probes);
    let mut no_end = basis.extend(&of_position(CellPosition::NoEnd), &probes);
    let ring = |UnmixedRing { mut ring, readings, lattice }: UnmixedRing| {
        for (position, evidence) in &readings {
            let evaluated = || ReadingGain::Evaluated(evidence.excess());
            ring.readings.push(match position {
                // The lattice takes these.
                CellPosition::InFront => continue,
                CellPosition::AtEnd => {
                    at_end.as_mut().map_or_else(evaluated, MixtureQueue::mix_next)
                }
                CellPosition::Behind => behind.mix_next(),
                CellPosition::NoEnd => no_end.mix_next(),
            });
        }
        ring.beyond = lattice.map(|lattice| lattice.reduce(&mut in_front, &mut ring.readings));
        ring
    };
    (built.into_iter().map(ring).collect(), basis)
}

/// Returns all rings, nearest first, before their readings are mixtures.
pub(super) fn unmixed(
    model: &SensorModel,
    stencil: &Stencil,
    probes: &ProbeHistograms,
) -> Vec<UnmixedRing> {
    let count = (0..).find(|ring| {
        stencil
            .beams
            .iter()
            .all(|beam| members(beam, *ring, model.resolution()).start == beam.cells.len())
    });
    let build = |ring| RingBuilder::new(model, stencil, probes, ring).build();
    (0..count.unwrap_or(0)).map(build).collect()
}

/// A ring before the readings of all rings are known, and with them the basis.
pub(super) struct UnmixedRing {
    /// The ring without its readings and without the outcomes beyond it.
    pub(super) ring: DistanceRing,
    /// The readings, with those of the lattice among them, and the position of the ring's cells for
    /// each.
    pub(super) readings: Vec<(CellPosition, BinEvidence)>,
    pub(super) lattice: Option<Lattice>,
}

/// Returns a beam's cells in a ring, by their rank. Every cell is in one ring, also where rounding
/// leaves it out of the rings of the stencil or puts it in two. Rings go on beyond the last range
/// that may be measured.
fn members(beam: &BeamStencil, ring: usize, resolution: f64) -> Range<usize> {
    let last = beam.rings.last().map_or(0, |r| r.end);
    let end = |ring: usize| match beam.rings.get(ring) {
        Some(cells) => cells.end,
        None => {
            let edge = (as_f64(ring) + 0.5) * resolution;
            beam.cells.partition_point(|c| c.cell_distance < edge).max(last)
        }
    };
    ring.checked_sub(1).map_or(0, end)..end(ring)
}

/// Position of a cell from the end of an outcome.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum CellPosition {
    InFront,
    AtEnd,
    Behind,
    /// Without an echo.
    NoEnd,
}

pub(super) struct RingBuilder<'a> {
    model: &'a SensorModel,
    stencil: &'a Stencil,
    probes: &'a ProbeHistograms,
    /// Factor on the allowed error: a ring of few cells may be less exact, because the sum over all
    /// cells counts.
    pub(super) leniency: f64,
    /// The ring's cells of each beam.
    cells: Vec<Range<usize>>,
    /// All distances of these cells, in ascending order.
    distances: Vec<f64>,
    /// The readings so far, with the position of the ring's cells for each.
    readings: Vec<(CellPosition, BinEvidence)>,
}

impl<'a> RingBuilder<'a> {
    pub(super) fn new(
        model: &'a SensorModel,
        stencil: &'a Stencil,
        probes: &'a ProbeHistograms,
        ring: usize,
    ) -> Self {
        let cells: Vec<Range<usize>> =
            stencil.beams.iter().map(|b| members(b, ring, model.resolution())).collect();
        let distances = |(b, cells): (&BeamStencil, &Range<usize>)| {
            b.cells[cells.clone()].iter().map(|c| c.cell_distance.to_bits()).collect::<Vec<_>>()
        };
        // Distances are not negative: they are ordered as their bits are.
        let distances: BTreeSet<u64> =
            stencil.beams.iter().zip(&cells).flat_map(distances).collect();
        let distances = distances.into_iter().map(f64::from_bits).collect();
        let all: usize = stencil.beams.iter().map(|b| b.cells.len()).sum();
        let here: usize = cells.iter().map(Range::len).sum();
        let leniency = as_f64(all) / as_f64(stencil.ranges.len() * here.max(1));
        let leniency = leniency.clamp(1.0, MOST_LENIENT);
        Self { leniency, model, stencil, probes, cells, distances, readings: Vec::new() }
    }

    fn build(mut self) -> UnmixedRing {
        let ranges = self.stencil.ranges.len();
        let is_near =
            |k: &usize| self.any_cell(*k, |d| self.position(d, *k) != CellPosition::InFront);
        let near: Vec<usize> = (0..ranges).filter(is_near).collect();
        let nearest_beyond = near.last().map_or(0, |k| k + 1);
        let near = near.into_iter().map(|k| (k, self.near(k))).collect();
        let reaches_no_echo = self.any_cell(ranges, |_| true);
        let no_echo = reaches_no_echo.then(|| {
            let model = self.model;
            self.smooth(ranges, CellPosition::NoEnd, |d| {
                BinEvidence::new(model, d, Outcome::NoEcho)
            })
        });
        let reaches_cells = nearest_beyond < ranges && self.any_cell(ranges - 1, |_| true);
        let lattice = reaches_cells.then(|| self.beyond(nearest_beyond));
        let cells = self.cells;
        let ring = DistanceRing { cells, readings: Vec::new(), beyond: None, near, no_echo };
        UnmixedRing { ring, readings: self.readings, lattice }
    }

    fn position(&self, cell_distance: f64, k: usize) -> CellPosition {
        let delta = cell_distance - self.stencil.ranges[k];
        if delta.abs() <= 0.5 * self.model.resolution() {
            CellPosition::AtEnd
        } else if delta < 0.0 {
            CellPosition::InFront
        } else {
            CellPosition::Behind
        }
    }

    /// Returns the ring's cells that an outcome covers, by beam and rank.
    fn covered(&self, k: usize) -> impl Iterator<Item = (usize, usize)> {
        let beams = self.cells.iter().enumerate();
        beams.flat_map(move |(beam, cells)| {
            let end = cells.end.min(self.stencil.beams[beam].reach(k)).max(cells.start);
            (cells.start..end).map(move |i| (beam, i))
        })
    }

    /// Returns whether any cell that an outcome covers is at a wanted distance.
    fn any_cell(&self, k: usize, is_wanted: impl Fn(f64) -> bool) -> bool {
        self.covered(k).any(|(beam, i)| is_wanted(self.stencil.beams[beam].cells[i].cell_distance))
    }

    /// Returns the nodes of the ranges from the `nearest` beyond the ring on, their shift, and the
    /// distance of cells for which they are chosen \[m\].
    pub(super) fn in_range(&self, nearest: usize) -> (Nodes, Option<f64>, f64) {
        let (model, probes) = (self.model, (self.probes, self.leniency));
        let (low, high) = (self.distances[0], self.distances[self.distances.len() - 1]);
        let middle = 0.5 * (low + high);
        let gamma = model.parameters().update.product().map(|product| product.gamma);
        let shift = gamma.and_then(|gamma| shift(&gamma, middle));
        let ranges = &self.stencil.ranges[nearest..];
        let at = |range| BinEvidence::new(model, middle, Outcome::Echo(range));
        (Nodes::few(ranges, shift, probes, at), shift, middle)
    }

    /// Makes the lattice of all outcomes from the `nearest` beyond the ring on.
    fn beyond(&mut self, nearest: usize) -> Lattice {
        let (model, probes) = (self.model, (self.probes, self.leniency));
        let at = |distance, range| BinEvidence::new(model, distance, Outcome::Echo(range));
        let (in_range, ..) = self.in_range(nearest);
        let needed = |range: &f64| {
            Nodes::few(&self.distances, None, probes, |distance| at(distance, *range)).at.len()
        };
        let distances = in_range.at.iter().map(needed).max().unwrap_or(1);
        let in_distance = Nodes::new(&self.distances, distances, None);
        for range in &in_range.at {
            for distance in &in_distance.at {
                self.readings.push((CellPosition::InFront, at(*distance, *range)));
            }
        }
        Lattice {
            nearest,
            of_outcomes: in_range.weights,
            of_cells: self.of_cells(&in_distance, nearest),
            distances,
            tolerance: REDUCED * self.leniency / as_f64(distances),
        }
    }

    /// Makes the readings of one outcome that ends in the ring or before it.
    fn near(&mut self, k: usize) -> OutcomeReadings {
        let (model, outcome) = (self.model, self.stencil.outcome(k));
        if !self.any_cell(k, |d| self.position(d, k) != CellPosition::Behind) {
            return self.smooth(k, CellPosition::Behind, |d| BinEvidence::new(model, d, outcome));
        }
        let first = self.readings.len();
        let distances = self.distances.clone();
        for d in &distances {
            self.readings.push((CellPosition::AtEnd, BinEvidence::new(model, *d, outcome)));
        }
        let mut own = vec![Vec::new(); self.cells.len()];
        for (beam, i) in self.covered(k) {
            let distance = self.stencil.beams[beam].cells[i].cell_distance;
            let reading = distances.partition_point(|d| *d < distance);
            own[beam].push(OwnReading { cell: i - self.cells[beam].start, reading });
        }
        OutcomeReadings { first, count: distances.len(), cells: CellReadings::Own(own) }
    }

    /// Makes the readings of an outcome whose gain is smooth in the distance, for the cells that it
    /// covers.
    fn smooth(
        &mut self,
        k: usize,
        position: CellPosition,
        evidence: impl Fn(f64) -> BinEvidence,
    ) -> OutcomeReadings {
        let nodes = Nodes::few(&self.distances, None, (self.probes, self.leniency), &evidence);
        let (first, count) = (self.readings.len(), nodes.at.len());
        for at in &nodes.at {
            self.readings.push((position, evidence(*at)));
        }
        let narrow = |weights: Vec<Vec<f64>>| weights.into_iter().flatten().map(to_f32).collect();
        let weights = self.of_cells(&nodes, k).into_iter().map(narrow).collect();
        OutcomeReadings { first, count, cells: CellReadings::Weighted(weights) }
    }

    /// Returns the weight of every node for each beam and each of its cells; 0 in cells that the
    /// outcome does not cover.
    fn of_cells(&self, nodes: &Nodes, k: usize) -> Vec<Vec<Vec<f64>>> {
        let none = vec![0.0; nodes.at.len()];
        let mut weights: Vec<Vec<Vec<f64>>> =
            self.cells.iter().map(|cells| vec![none.clone(); cells.len()]).collect();
        for (beam, i) in self.covered(k) {
            let distance = self.stencil.beams[beam].cells[i].cell_distance;
            let point = self.distances.partition_point(|d| *d < distance);
            weights[beam][i - self.cells[beam].start].clone_from(&nodes.weights[point]);
        }
        weights
    }
}

/// Returns the shift in γ = `slope · (range + shift)`: gains are smooth in the logarithm of γ.
fn shift(gamma: &Linear, distance: f64) -> Option<f64> {
    (gamma.per_range > 0.0).then(|| gamma.at(distance, 0.0) / gamma.per_range)
}
