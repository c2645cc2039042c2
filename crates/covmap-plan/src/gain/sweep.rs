//! Eq. (14) for many view-points at once, ring by ring.
//!
//! What a cell may gain depends on where it is seen from by its distance only. So for each ring
//! of distance the gains of the imagined readings are computed once for every cell, and then
//! summed over the cells of each beam of each view-point, [`LANES`] neighbours of a row side by
//! side.

use super::rings::{Ring, Shares, Source, TOGETHER, rings};
use crate::Stencil;
use crate::cells::Cells;
use crate::view_points::groups;
use covmap::Grid;
use covmap::lanes::{LANES, Lanes};
use covmap_model::SensorModel;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// The places of a unit's outcomes by where they end from a ring.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sides {
    near: Range<usize>,
    front: Range<usize>,
    no_echo: Option<usize>,
}

/// One beam of a group of neighbouring view-points.
#[derive(Debug, Clone)]
pub(crate) struct Unit {
    /// The group's place in its row.
    pub(crate) group: usize,
    pub(crate) beam: usize,
    /// Which of the row's outcomes are its own. While it is worked at those are dropped from the
    /// front that end before the present ring.
    pub(crate) likely: Range<usize>,
    /// Those of the present ring.
    pub(crate) sides: Sides,
}

/// The units of one row of view-points.
#[derive(Debug, Clone, Default)]
pub(crate) struct Row {
    pub(crate) y: usize,
    pub(crate) units: Vec<Unit>,
    /// The outcomes of some probability, unit by unit in order …
    pub(crate) outcomes: Vec<usize>,
    /// … and their probabilities.
    pub(crate) probabilities: Vec<Lanes>,
    /// E\[I\] of every unit: the result. Summed ring by ring: gains of either sign nearly cancel.
    pub(crate) gains: Vec<[f64; LANES]>,
}

/// So many units of a row are prepared and then summed.
const AT_ONCE: usize = 16;

/// Fewer units than this are worked at by one thread: for each ring another one is woken up twice,
/// which took more than half of the time of an exploration by CL, whose reports have few units.
const SHARED: usize = 1024;

/// Which readings of a block of cells are asked for.
const FRONT: u8 = 1;
const NEAR: u8 = 2;
const NO_ECHO: u8 = 4;

/// Computes E\[I\] of many beams.
#[derive(Debug, Clone)]
pub(crate) struct Sweep {
    grid: Grid,
    rings: Vec<Ring>,
    /// The runs of cells of each ring and beam: row, first and last column from the view-point.
    runs: Vec<Vec<Vec<(isize, isize, isize)>>>,
    /// For each beam where its cells lie in the planes from the view-point.
    offsets: Vec<Vec<isize>>,
    /// The outcome that is no echo.
    no_echo: usize,
    /// Rows and columns around the cells in the planes.
    border: usize,
    /// From one reading's row to the next one's.
    stride: usize,
    /// From one row of cells to the next.
    row: usize,
}

impl Sweep {
    pub(crate) fn new(model: &SensorModel, stencil: &Stencil, grid: Grid) -> Self {
        let rings = rings(model, stencil);
        let border = usize::try_from(stencil.radius).unwrap_or(0).next_multiple_of(LANES);
        let stride = grid.width().next_multiple_of(LANES) + 2 * border;
        let row = stride * rings.iter().map(|ring| ring.readings.len()).max().unwrap_or(0);
        let width = isize::try_from(row).unwrap_or(0);
        let offset = |c: &crate::StencilCell| c.dy as isize * width + c.dx as isize;
        Self {
            grid,
            runs: rings.iter().map(|ring| runs(ring, stencil)).collect(),
            rings,
            offsets: stencil.beams.iter().map(|b| b.cells.iter().map(offset).collect()).collect(),
            no_echo: stencil.ranges.len(),
            border,
            stride,
            row,
        }
    }

    /// Computes the gains of all units of some rows, in order of y.
    pub(crate) fn run(&self, arch: Arch, cells: &Cells, rows: &mut [Row]) {
        let Some((low, high)) = rows.first().zip(rows.last()).map(|(l, h)| (l.y, h.y)) else {
            return;
        };
        rows.iter_mut().for_each(|row| row.gains = vec![[0.0; LANES]; row.units.len()]);
        let units: usize = rows.iter().map(|row| row.units.len()).sum();
        let together = if units < SHARED { usize::MAX } else { 1 };
        // Rows of planes from `low` − border on; those outside of the grid stay 0.
        let mut planes = vec![0.0f32; (high - low + 1 + 2 * self.border) * self.row];
        for (ring, runs) in self.rings.iter().zip(&self.runs) {
            let asked = self.asked(ring, runs, rows, low, high);
            let blocks = groups(&self.grid);
            let filled = planes.par_chunks_mut(self.row).zip(asked.par_chunks(blocks)).enumerate();
            filled.with_min_len(together).for_each(|(y, (planes, asked))| {
                let y = (y + low).checked_sub(self.border);
                if let Some(y) = y.filter(|y| *y < self.grid.height()) {
                    arch.dispatch(Fill { sweep: self, ring, cells, y, asked, planes });
                }
            });
            rows.par_iter_mut().with_min_len(together).for_each(|row| {
                arch.dispatch(Sum { sweep: self, ring, planes: &planes, low, row });
            });
        }
    }

    /// For every block of cells, which readings of a ring the units need.
    fn asked(
        &self,
        ring: &Ring,
        runs: &[Vec<(isize, isize, isize)>],
        rows: &mut [Row],
        low: usize,
        high: usize,
    ) -> Vec<u8> {
        let (blocks, border) = (groups(&self.grid), self.border);
        let mut asked = vec![0; (high - low + 1 + 2 * border) * blocks];
        let lanes = LANES.cast_signed();
        let nearest = ring.near.first().map_or(0, |(k, _)| *k);
        for row in rows {
            for unit in &mut row.units {
                while unit.likely.start < unit.likely.end
                    && row.outcomes[unit.likely.start] < nearest
                {
                    unit.likely.start += 1;
                }
                unit.sides = self.sides(ring, unit.likely.clone(), &row.outcomes);
                let wanted = if unit.sides.front.is_empty() { 0 } else { FRONT }
                    | if unit.sides.near.is_empty() { 0 } else { NEAR }
                    | if unit.sides.no_echo.is_some() { NO_ECHO } else { 0 };
                if wanted == 0 {
                    continue;
                }
                let x = (unit.group * LANES).cast_signed();
                for (dy, first, last) in &runs[unit.beam] {
                    let y = (row.y + border - low).wrapping_add_signed(*dy);
                    let from = ((x + first) >> LANES.ilog2()).max(0);
                    let to =
                        ((x + last + lanes - 1) >> LANES.ilog2()).min(blocks.cast_signed() - 1);
                    for block in from..=to {
                        asked[(y * blocks).wrapping_add_signed(block)] |= wanted;
                    }
                }
            }
        }
        asked
    }

    /// Which of a unit's outcomes end near a ring, beyond it, and nowhere.
    fn sides(&self, ring: &Ring, likely: Range<usize>, outcomes: &[usize]) -> Sides {
        let (start, own) = (likely.start, &outcomes[likely]);
        let first = ring.front.as_ref().map_or(self.no_echo, |front| front.first);
        let echoes = own.len() - usize::from(own.last() == Some(&self.no_echo));
        let near = own[..echoes].iter().take_while(|k| **k < first).count();
        let no_echo = (echoes < own.len() && ring.no_echo.is_some()).then_some(start + echoes);
        Sides { near: start..start + near, front: start + near..start + echoes, no_echo }
    }
}

/// The runs of neighbouring cells of a ring, for each beam.
fn runs(ring: &Ring, stencil: &Stencil) -> Vec<Vec<(isize, isize, isize)>> {
    let beams = stencil.beams.iter().zip(&ring.cells);
    let runs = |(beam, cells): (&crate::BeamStencil, &Range<usize>)| {
        let mut places: Vec<(isize, isize)> =
            beam.cells[cells.clone()].iter().map(|c| (c.dy as isize, c.dx as isize)).collect();
        places.sort_unstable();
        let mut runs: Vec<(isize, isize, isize)> = Vec::new();
        for (dy, dx) in places {
            match runs.last_mut() {
                Some((y, _, last)) if *y == dy && dx - *last < LANES.cast_signed() => *last = dx,
                _ => runs.push((dy, dx, dx)),
            }
        }
        runs
    };
    beams.map(runs).collect()
}

/// Evaluates the readings of a ring for one row of cells.
struct Fill<'a> {
    sweep: &'a Sweep,
    ring: &'a Ring,
    cells: &'a Cells,
    y: usize,
    asked: &'a [u8],
    planes: &'a mut [f32],
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sweep, ring, cells, y, asked, planes } = self;
        let no_echo = ring.no_echo.as_ref().map_or(ring.readings.len(), |source| source.first);
        let near = ring.near.first().map_or(no_echo, |(_, source)| source.first);
        // The order of the readings: in front, near, no echo.
        let kinds =
            [(FRONT, 0..near), (NEAR, near..no_echo), (NO_ECHO, no_echo..ring.readings.len())];
        for (x, asked) in asked.iter().enumerate().filter(|(_, asked)| **asked != 0) {
            let prior = cells.block(y * groups(&sweep.grid) + x);
            let column = sweep.border + x * LANES;
            for (_, readings) in kinds.iter().filter(|(kind, _)| asked & kind != 0) {
                for i in readings.clone() {
                    let at = i * sweep.stride + column;
                    planes[at..at + LANES].copy_from_slice(&prior.gain(&ring.readings[i]));
                }
            }
        }
    }
}

/// Adds what the cells of a ring contribute to every unit of a row.
struct Sum<'a> {
    sweep: &'a Sweep,
    ring: &'a Ring,
    planes: &'a [f32],
    low: usize,
    row: &'a mut Row,
}

impl WithSimd for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sweep, ring, planes, low, row } = self;
        let start = (row.y - low + sweep.border) * sweep.row + sweep.border;
        let Row { units, outcomes, probabilities, gains, .. } = row;
        let mixtures = ring.front.as_ref().map_or(&[][..], |front| &front.weights);
        let mut shares = vec![[[0.0; LANES]; TOGETHER]; AT_ONCE * mixtures.len()];
        for (units, gains) in units.chunks(AT_ONCE).zip(gains.chunks_mut(AT_ONCE)) {
            // First all that lies scattered in memory.
            for (i, unit) in units.iter().enumerate() {
                let first = ring.front.as_ref().map_or(0, |front| front.first);
                let likely = unit.sides.front.clone();
                let likely = outcomes[likely.clone()].iter().zip(&probabilities[likely]);
                for (mixture, weights) in mixtures.iter().enumerate() {
                    shares[i * mixtures.len() + mixture] =
                        mix_outcomes(likely.clone(), first, weights);
                }
            }
            for (i, (unit, total)) in units.iter().zip(gains).enumerate() {
                let mut of_ring = [0.0; LANES];
                let gain = &mut of_ring;
                let cells = &sweep.offsets[unit.beam][ring.cells[unit.beam].clone()];
                let here = start + unit.group * LANES;
                let sum =
                    |source: &Source| source.sum(unit.beam, cells, planes, here, sweep.stride);
                if !unit.sides.front.is_empty() {
                    let shares = shares[i * mixtures.len()..].as_flattened();
                    for (source, share) in ring.front.iter().flat_map(|f| &f.sources).zip(shares) {
                        add_product(gain, share, &sum(source));
                    }
                }
                let near = unit.sides.near.clone();
                for (k, p) in outcomes[near.clone()].iter().zip(&probabilities[near]) {
                    if let Some((_, source)) = ring.near.iter().find(|(near, _)| near == k) {
                        add_product(gain, p, &sum(source));
                    }
                }
                if let Some((source, place)) = ring.no_echo.as_ref().zip(unit.sides.no_echo) {
                    add_product(gain, &probabilities[place], &sum(source));
                }
                for lane in 0..LANES {
                    total[lane] += f64::from(of_ring[lane]);
                }
            }
        }
    }
}

/// How much each of some nodes weighs in all of a unit's outcomes from the `first` on together.
#[inline(always)]
fn mix_outcomes<'a>(
    likely: impl Iterator<Item = (&'a usize, &'a Lanes)>,
    first: usize,
    weights: &[[f32; TOGETHER]],
) -> [Lanes; TOGETHER] {
    let [mut a, mut b, mut c, mut d] = [[0.0; LANES]; TOGETHER];
    for (k, p) in likely {
        let weights = &weights[k - first];
        add(&mut a, p, weights[0]);
        add(&mut b, p, weights[1]);
        add(&mut c, p, weights[2]);
        add(&mut d, p, weights[3]);
    }
    [a, b, c, d]
}

impl Source {
    /// The gains of a beam's cells, summed.
    #[inline(always)]
    fn sum(
        &self,
        beam: usize,
        cells: &[isize],
        planes: &[f32],
        here: usize,
        stride: usize,
    ) -> Lanes {
        let first = here + self.first * stride;
        match &self.shares {
            Shares::Weights(weights) => {
                let weights = &weights[beam];
                match self.count {
                    1 => mix::<1>(weights, cells, planes, first, stride),
                    2 => mix::<2>(weights, cells, planes, first, stride),
                    3 => mix::<3>(weights, cells, planes, first, stride),
                    4 => mix::<4>(weights, cells, planes, first, stride),
                    count => {
                        let mut sum = [0.0; LANES];
                        for (offset, weights) in cells.iter().zip(weights.chunks_exact(count)) {
                            let mut at = first.wrapping_add_signed(*offset);
                            for weight in weights {
                                add(&mut sum, lanes(planes, at), *weight);
                                at += stride;
                            }
                        }
                        sum
                    }
                }
            }
            Shares::Own(own) => {
                let mut sum = [0.0; LANES];
                for (cell, reading) in &own[beam] {
                    let at = first.wrapping_add_signed(cells[*cell]) + reading * stride;
                    add(&mut sum, lanes(planes, at), 1.0);
                }
                sum
            }
        }
    }
}

/// Σ of M readings over some cells, with M weights for each cell.
#[inline(always)]
fn mix<const M: usize>(
    weights: &[f32],
    cells: &[isize],
    planes: &[f32],
    first: usize,
    stride: usize,
) -> Lanes {
    let mut sum = [0.0; LANES];
    for (offset, weights) in cells.iter().zip(weights.as_chunks::<M>().0) {
        let at = first.wrapping_add_signed(*offset);
        for (i, weight) in weights.iter().enumerate() {
            add(&mut sum, lanes(planes, at + i * stride), *weight);
        }
    }
    sum
}

#[inline(always)]
fn lanes(plane: &[f32], at: usize) -> &Lanes {
    plane[at..].first_chunk().unwrap_or(&[0.0; LANES])
}

#[inline(always)]
fn add(sum: &mut Lanes, values: &Lanes, weight: f32) {
    for lane in 0..LANES {
        sum[lane] += values[lane] * weight;
    }
}

#[inline(always)]
fn add_product(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * b[lane];
    }
}
