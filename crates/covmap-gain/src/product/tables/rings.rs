//! Which imagined readings are evaluated for the cells of a ring, and what each counts.
//!
//! A ring is what the beams see at about one distance δ. For an outcome d its cells are in
//! *front* of the end, or *near* it: at the end or behind. In front the gain of a cell is
//! smooth in δ and in d, so that a few readings stand for all ranges ([`Nodes`]); behind it is
//! smooth in δ; at the end every distance has a reading of its own.

use super::basis::{Basis, Imagined, Mixtures};
use super::evidence::{Evidence, to_f32};
use super::front::{Front, Lattice};
use super::interpolation::{Nodes, Probes};
use crate::sight::as_f64;
use crate::{BeamStencil, Stencil};
use covmap_model::{Linear, Outcome, SensorModel};
use std::collections::BTreeSet;
use std::ops::Range;

/// Fewer readings in front may leave a gain off by so much of what an interpolated one may.
const REDUCED: f64 = 0.3;
/// If readings of the end are mixtures of more than this, they are evaluated: to keep the gains of
/// so many for every cell would take more memory than it is worth.
const MOST_AT_END: usize = 24;
/// See [`Builder::leniency`].
const MOST_LENIENT: f64 = 10.0;

/// The readings of one ring.
#[derive(Debug, Clone)]
pub(crate) struct Ring {
    pub(crate) readings: Vec<Imagined>,
    pub(crate) front: Option<Front>,
    /// By outcome.
    pub(crate) near: Vec<(usize, Source)>,
    pub(crate) no_echo: Option<Source>,
    /// The cells of each beam.
    pub(crate) cells: Vec<Range<usize>>,
}

/// From which readings the gains of a ring's cells are taken.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    /// The first of the readings.
    pub(crate) first: usize,
    /// How many there are.
    pub(crate) count: usize,
    pub(crate) shares: Shares,
}

#[derive(Debug, Clone)]
pub(crate) enum Shares {
    /// For each beam, for each of its cells, the weight of every reading.
    Weights(Vec<Vec<f32>>),
    /// For each beam: the cells that are covered, counted within the ring, and the reading of
    /// each.
    Own(Vec<Vec<(usize, usize)>>),
}

/// All rings, nearest first, and the readings that those of theirs are mixtures of.
pub(crate) fn rings(model: &SensorModel, stencil: &Stencil) -> (Vec<Ring>, Basis) {
    let probes = Probes::of_model(model);
    let count = (0..).find(|ring| {
        stencil
            .beams
            .iter()
            .all(|beam| members(beam, *ring, model.resolution()).start == beam.cells.len())
    });
    let build = |ring| Builder::new(model, stencil, &probes, ring).build();
    let built: Vec<Built> = (0..count.unwrap_or(0)).map(build).collect();
    let mut basis = Basis::default();
    let of_side = |side| {
        let readings = built.iter().flat_map(|built| &built.readings);
        readings.filter(|(s, _)| *s == side).map(|(_, e)| e).collect::<Vec<&Evidence>>()
    };
    let mut front = basis.extend(&of_side(Side::Front), &probes);
    let mut end = basis.extend_by_few(&of_side(Side::End), &probes, MOST_AT_END);
    let mut behind = basis.extend(&of_side(Side::Behind), &probes);
    let mut nowhere = basis.extend(&of_side(Side::Nowhere), &probes);
    let ring = |Built { mut ring, readings, lattice }: Built| {
        for (side, evidence) in &readings {
            let evaluated = || Imagined::Evaluated(evidence.reading());
            ring.readings.push(match side {
                Side::Front => continue,
                Side::End => end.as_mut().map_or_else(evaluated, Mixtures::mix_next),
                Side::Behind => behind.mix_next(),
                Side::Nowhere => nowhere.mix_next(),
            });
        }
        ring.front = lattice.map(|lattice| lattice.reduce(&mut front, &mut ring.readings));
        ring
    };
    (built.into_iter().map(ring).collect(), basis)
}

/// A ring before the readings of all rings are known.
struct Built {
    ring: Ring,
    /// With where they end from the ring's cells.
    readings: Vec<(Side, Evidence)>,
    lattice: Option<Lattice>,
}

/// A beam's cells in a ring: every cell is in one, also where rounding leaves it out of the rings
/// of the stencil or puts it in two. Beyond the last range that may be measured rings go on.
fn members(beam: &BeamStencil, ring: usize, resolution: f64) -> Range<usize> {
    let last = beam.rings.last().map_or(0, |r| r.end);
    let end = |ring: usize| match beam.rings.get(ring) {
        Some(cells) => cells.end,
        None => {
            #[allow(clippy::cast_precision_loss, reason = "some hundred rings")]
            let edge = (ring as f64 + 0.5) * resolution;
            beam.cells.partition_point(|c| c.cell_distance < edge).max(last)
        }
    };
    ring.checked_sub(1).map_or(0, end)..end(ring)
}

/// Where the end of a measurement lies from a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Front,
    End,
    Behind,
    /// No echo.
    Nowhere,
}

struct Builder<'a> {
    model: &'a SensorModel,
    stencil: &'a Stencil,
    probes: &'a Probes,
    /// A ring of few cells may be less exact: what counts is the sum over all.
    leniency: f64,
    cells: Vec<Range<usize>>,
    /// All distances of the ring's cells, in order.
    distances: Vec<f64>,
    /// With where they end from the ring's cells.
    readings: Vec<(Side, Evidence)>,
}

impl<'a> Builder<'a> {
    fn new(model: &'a SensorModel, stencil: &'a Stencil, probes: &'a Probes, ring: usize) -> Self {
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
        #[allow(clippy::cast_precision_loss, reason = "some thousand cells")]
        let leniency = all as f64 / (stencil.ranges.len() * here.max(1)) as f64;
        let leniency = leniency.clamp(1.0, MOST_LENIENT);
        Self { leniency, model, stencil, probes, cells, distances, readings: Vec::new() }
    }

    fn build(mut self) -> Built {
        let ranges = self.stencil.ranges.len();
        let is_near = |k: &usize| self.any_cell(*k, |d| self.side(d, *k) != Side::Front);
        let near: Vec<usize> = (0..ranges).filter(is_near).collect();
        let first = near.last().map_or(0, |k| k + 1);
        let near = near.into_iter().map(|k| (k, self.near(k))).collect();
        let reaches_no_echo = self.any_cell(ranges, |_| true);
        let no_echo = reaches_no_echo.then(|| {
            let model = self.model;
            self.smooth(ranges, Side::Nowhere, |d| Evidence::new(model, d, Outcome::NoEcho))
        });
        let reaches_cells = first < ranges && self.any_cell(ranges - 1, |_| true);
        let lattice = reaches_cells.then(|| self.front(first));
        let ring = Ring { readings: Vec::new(), front: None, near, no_echo, cells: self.cells };
        Built { ring, readings: self.readings, lattice }
    }

    fn side(&self, cell_distance: f64, k: usize) -> Side {
        let delta = cell_distance - self.stencil.ranges[k];
        if delta.abs() <= 0.5 * self.model.resolution() {
            Side::End
        } else if delta < 0.0 {
            Side::Front
        } else {
            Side::Behind
        }
    }

    /// The ring's cells that an outcome covers, by beam and rank.
    fn covered(&self, k: usize) -> impl Iterator<Item = (usize, usize)> {
        let beams = self.cells.iter().enumerate();
        beams.flat_map(move |(beam, cells)| {
            let end = cells.end.min(self.stencil.beams[beam].reach(k)).max(cells.start);
            (cells.start..end).map(move |i| (beam, i))
        })
    }

    /// Whether any cell that an outcome covers is at such a distance.
    fn any_cell(&self, k: usize, is_wanted: impl Fn(f64) -> bool) -> bool {
        self.covered(k).any(|(beam, i)| is_wanted(self.stencil.beams[beam].cells[i].cell_distance))
    }

    /// All outcomes from the `first` on.
    fn front(&mut self, first: usize) -> Lattice {
        let (model, probes) = (self.model, (self.probes, self.leniency));
        let ranges = &self.stencil.ranges[first..];
        let (nearest, farthest) = (self.distances[0], self.distances[self.distances.len() - 1]);
        let middle = 0.5 * (nearest + farthest);
        let at = |distance, range| Evidence::new(model, distance, Outcome::Echo(range));
        let gamma = model.parameters().update.product().map(|product| product.gamma);
        let shift = gamma.and_then(|gamma| shift(&gamma, middle));
        let in_range = Nodes::few(ranges, shift, probes, |range| at(middle, range));
        let needed = |range: &f64| {
            Nodes::few(&self.distances, None, probes, |distance| at(distance, *range)).at.len()
        };
        let distances = in_range.at.iter().map(needed).max().unwrap_or(1);
        let in_distance = Nodes::new(&self.distances, distances, None);
        for range in &in_range.at {
            for distance in &in_distance.at {
                self.readings.push((Side::Front, at(*distance, *range)));
            }
        }
        Lattice {
            first,
            of_outcomes: in_range.weights,
            of_cells: self.of_cells(&in_distance, first),
            distances,
            tolerance: REDUCED * self.leniency / as_f64(distances),
        }
    }

    /// One outcome that ends in the ring, or before it.
    fn near(&mut self, k: usize) -> Source {
        let (model, outcome) = (self.model, self.stencil.outcome(k));
        if !self.any_cell(k, |d| self.side(d, k) != Side::Behind) {
            return self.smooth(k, Side::Behind, |d| Evidence::new(model, d, outcome));
        }
        let first = self.readings.len();
        let distances = self.distances.clone();
        for d in &distances {
            self.readings.push((Side::End, Evidence::new(model, *d, outcome)));
        }
        let mut own = vec![Vec::new(); self.cells.len()];
        for (beam, i) in self.covered(k) {
            let distance = self.stencil.beams[beam].cells[i].cell_distance;
            let reading = distances.partition_point(|d| *d < distance);
            own[beam].push((i - self.cells[beam].start, reading));
        }
        Source { first, count: distances.len(), shares: Shares::Own(own) }
    }

    /// An outcome whose gain is smooth in the distance, for the cells that it covers.
    fn smooth(&mut self, k: usize, side: Side, evidence: impl Fn(f64) -> Evidence) -> Source {
        let nodes = Nodes::few(&self.distances, None, (self.probes, self.leniency), &evidence);
        let (first, count) = (self.readings.len(), nodes.at.len());
        for at in &nodes.at {
            self.readings.push((side, evidence(*at)));
        }
        let narrow = |weights: Vec<Vec<f64>>| weights.into_iter().flatten().map(to_f32).collect();
        let weights = self.of_cells(&nodes, k).into_iter().map(narrow).collect();
        Source { first, count, shares: Shares::Weights(weights) }
    }

    /// For each beam and each of its cells what every node weighs; nothing in cells that the
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

/// γ over the range is `slope · (range + shift)`: gains are smooth in its logarithm.
fn shift(gamma: &Linear, distance: f64) -> Option<f64> {
    (gamma.per_range > 0.0).then(|| gamma.at(distance, 0.0) / gamma.per_range)
}
