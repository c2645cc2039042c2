//! Which imagined readings are evaluated for the cells of a ring, and what each counts.
//!
//! A ring is what the beams see at about one distance δ. For an outcome d its cells are in
//! *front* of the end, or *near* it: at the end or behind. In front the gain of a cell is
//! smooth in δ and in d, so that a few readings stand for all ranges ([`Nodes`]); behind it is
//! smooth in δ; at the end every distance is evaluated by itself.

use super::basis::{Basis, Imagined};
use super::evidence::Evidence;
use super::interpolation::{Nodes, Probes};
use crate::{BeamStencil, Stencil};
use covmap::lanes::TOGETHER;
use covmap_model::{Linear, Outcome, SensorModel};
use std::collections::BTreeSet;
use std::ops::Range;

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

/// The outcomes from beyond the ring: the gain of each is a mixture of those at some ranges,
/// each of these of the gains at the same few distances. Its readings are the ring's first,
/// range by range.
#[derive(Debug, Clone)]
pub(crate) struct Front {
    /// The nearest of the outcomes.
    pub(crate) first: usize,
    /// How many ranges, and how many distances.
    pub(crate) ranges: usize,
    pub(crate) distances: usize,
    /// For [`TOGETHER`] ranges their weights in every outcome from the nearest on; 0 past the
    /// last range.
    pub(crate) weights: Vec<Vec<[f32; TOGETHER]>>,
    /// For each beam, for each of its cells, the weight of every distance.
    pub(crate) of_cells: Vec<Vec<f32>>,
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
    let (mut rings, readings): (Vec<Ring>, Vec<_>) = (0..count.unwrap_or(0)).map(build).unzip();
    let mut basis = Basis::default();
    let mut imagined = SIDES.map(|side| {
        let of_side = readings.iter().flatten().filter(|(s, _)| *s == side);
        let of_side: Vec<&Evidence> = of_side.map(|(_, evidence)| evidence).collect();
        basis.imagine(&of_side, &probes).into_iter()
    });
    for (ring, readings) in rings.iter_mut().zip(&readings) {
        let imagined = readings.iter().filter_map(|(side, _)| imagined[*side as usize].next());
        ring.readings = imagined.collect();
    }
    (rings, basis)
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
    Nowhere,
}

/// All sides, in order.
const SIDES: [Side; 4] = [Side::Front, Side::End, Side::Behind, Side::Nowhere];

struct Builder<'a> {
    model: &'a SensorModel,
    stencil: &'a Stencil,
    probes: &'a Probes,
    /// A ring of few cells may be less exact: what counts is the sum over all.
    leniency: f64,
    cells: Vec<Range<usize>>,
    /// All distances of the ring's cells, in order.
    distances: Vec<f64>,
    /// With where they end.
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

    fn build(mut self) -> (Ring, Vec<(Side, Evidence)>) {
        let ranges = self.stencil.ranges.len();
        let is_near = |k: &usize| self.any_cell(*k, |d| self.side(d, *k) != Side::Front);
        let near: Vec<usize> = (0..ranges).filter(is_near).collect();
        let first = near.last().map_or(0, |k| k + 1);
        let front = (first < ranges && !self.distances.is_empty()).then(|| self.front(first));
        let near = near.into_iter().map(|k| (k, self.near(k))).collect();
        let reaches_no_echo = self.any_cell(ranges, |_| true);
        let no_echo = reaches_no_echo.then(|| {
            let model = self.model;
            self.smooth(ranges, Side::Nowhere, |d| Evidence::new(model, d, Outcome::NoEcho))
        });
        (Ring { readings: Vec::new(), front, near, no_echo, cells: self.cells }, self.readings)
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
    fn front(&mut self, first: usize) -> Front {
        let (model, probes) = (self.model, (self.probes, self.leniency));
        let ranges = &self.stencil.ranges[first..];
        let (nearest, farthest) = (self.distances[0], self.distances[self.distances.len() - 1]);
        let middle = 0.5 * (nearest + farthest);
        let at = |distance, range| Evidence::new(model, distance, Outcome::Echo(range));
        let shift = shift(&model.parameters().gamma, middle);
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
        let weight = |row: &[f64], node: usize| row.get(node).map_or(0.0, |w| to_f32(*w));
        let mixed = |first: usize| {
            let row = |row: &Vec<f64>| std::array::from_fn(|i| weight(row, first + i));
            in_range.weights.iter().map(row).collect()
        };
        let weights = (0..in_range.at.len()).step_by(TOGETHER).map(mixed).collect();
        let of_cells = self.of_cells(&in_distance, first);
        Front { first, ranges: in_range.at.len(), distances, weights, of_cells }
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
        Source { first, count, shares: Shares::Weights(self.of_cells(&nodes, k)) }
    }

    /// For each beam and each of its cells what every node weighs; nothing in cells that the
    /// outcome does not cover.
    fn of_cells(&self, nodes: &Nodes, k: usize) -> Vec<Vec<f32>> {
        let count = nodes.at.len();
        let mut weights: Vec<Vec<f32>> =
            self.cells.iter().map(|cells| vec![0.0; cells.len() * count]).collect();
        for (beam, i) in self.covered(k) {
            let distance = self.stencil.beams[beam].cells[i].cell_distance;
            let point = self.distances.partition_point(|d| *d < distance);
            let at = (i - self.cells[beam].start) * count;
            let row = nodes.weights[point].iter().map(|w| to_f32(*w));
            weights[beam][at..at + count].iter_mut().zip(row).for_each(|(to, w)| *to = w);
        }
        weights
    }
}

/// γ over the range is `slope · (range + shift)`: gains are smooth in its logarithm.
fn shift(gamma: &Linear, distance: f64) -> Option<f64> {
    (gamma.per_range > 0.0).then(|| gamma.at(distance, 0.0) / gamma.per_range)
}

fn to_f32(x: f64) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
    let x = x as f32;
    x
}
