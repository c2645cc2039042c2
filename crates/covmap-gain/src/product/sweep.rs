//! Eq. (14) for many view-points at once, ring by ring.
//!
//! What a cell may gain depends on where it is seen from by its distance only. So for each ring
//! of distance the gains of the imagined readings are mixed from those that are kept for every
//! cell, or evaluated, and then summed over the cells of each beam of each view-point, [`LANES`]
//! neighbours of a row side by side.

mod sums;

use super::tables::asks::{Ask, Asks};
use super::tables::basis::Basis;
use super::tables::rings::{Ring, rings};
use crate::belief::Cells;
use crate::memory::Size;
use crate::sight::as_f64;
use crate::view_points::groups;
use crate::{Stencil, StencilCell};
use covmap::Grid;
use covmap::lanes::{LANES, Lanes, TOGETHER};
use covmap_model::SensorModel;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;
pub(crate) use sums::add_product;
use sums::mix_outcomes;

/// The places of a unit's outcomes by where they end from a ring.
#[derive(Debug, Clone, Default)]
struct Sides {
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
    /// Which of the row's outcomes are its own.
    pub(crate) likely: Range<usize>,
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
}

/// E\[I\] of every unit of a row. Summed ring by ring: gains of either sign nearly cancel.
pub(crate) type Gains = Vec<[f64; LANES]>;

/// A row at one ring after the other.
struct Turn<'a> {
    row: &'a Row,
    units: Vec<Progress>,
}

/// A unit at one ring after the other.
struct Progress {
    /// Its outcomes but for those that end before the present ring.
    left: Range<usize>,
    /// Those of the present ring.
    sides: Sides,
    gain: [f64; LANES],
}

impl<'a> Turn<'a> {
    fn new(row: &'a Row) -> Self {
        let begin = |unit: &Unit| Progress {
            left: unit.likely.clone(),
            sides: Sides::default(),
            gain: [0.0; LANES],
        };
        Self { row, units: row.units.iter().map(begin).collect() }
    }
}

/// The gains of the cells around some rows at one ring, and which of them are asked for.
#[derive(Debug, Default)]
struct Room {
    /// For each row of cells the planes of all readings; 0 outside of the grid.
    planes: Vec<f32>,
    /// The rows that were inside of the grid when it was last used.
    inside: Range<usize>,
    /// For each block of cells bit by bit.
    asked: Vec<u64>,
}

impl Clone for Room {
    /// An empty room: what is in one is never needed again.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Room {
    /// Makes room for so many rows of planes, so many numbers each, some of them inside of the
    /// grid, and for blocks of cells. Memory that is asked for as zeros costs nothing until it is
    /// used, and most rows outside were outside before.
    fn prepare(&mut self, (rows, row): (usize, usize), inside: Range<usize>, blocks: usize) {
        if self.planes.len() < rows * row {
            *self = Self { planes: vec![0.0; rows * row], ..Self::default() };
        }
        for outside in self.inside.clone().filter(|y| !inside.contains(y)) {
            self.planes[outside * row..(outside + 1) * row].fill(0.0);
        }
        self.inside = inside;
        self.asked.resize(rows * blocks, 0);
    }
}

/// So many units of a row are prepared and then summed.
const AT_ONCE: usize = 16;

/// Fewer units than this are worked at by one thread for each half of the rings: for each ring
/// others are woken up twice, which took more than half of the time of an exploration by CL, whose
/// reports have few units.
const SHARED: usize = 160;

/// So many readings are kept for every cell, if the estimate of memory is right.
const BASIS: f64 = 40.0;

/// A room of more numbers than this, 16 MB, is not kept: decisions that need it are slow anyway.
const KEPT: usize = 1 << 22;

/// Computes E\[I\] of many beams.
#[derive(Debug, Clone)]
pub(crate) struct Sweep {
    grid: Grid,
    rings: Vec<Ring>,
    /// To be kept up to date with the cells.
    pub(crate) basis: Basis,
    /// For each ring.
    asks: Vec<Asks>,
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
    /// Kept, because fresh memory is slow: one for the even rings and one for the odd ones, which
    /// take about the same time.
    rooms: [Room; 2],
}

impl Sweep {
    pub(crate) fn new(model: &SensorModel, stencil: &Stencil, grid: Grid) -> Self {
        let (rings, mut basis) = rings(model, stencil);
        basis.make_room(grid.height() * groups(&grid));
        let border = usize::try_from(stencil.radius).unwrap_or(0).next_multiple_of(LANES);
        let stride = grid.width().next_multiple_of(LANES) + 2 * border;
        let row = stride * rings.iter().map(|ring| ring.readings.len()).max().unwrap_or(0).max(1);
        let width = isize::try_from(row).unwrap_or(0);
        let offset = |c: &StencilCell| c.dy as isize * width + c.dx as isize;
        Self {
            grid,
            asks: rings.iter().map(|ring| Asks::new(ring, stencil)).collect(),
            rings,
            basis,
            offsets: stencil.beams.iter().map(|b| b.cells.iter().map(offset).collect()).collect(),
            no_echo: stencil.ranges.len(),
            border,
            stride,
            row,
            rooms: [Room::default(), Room::default()],
        }
    }

    /// About how many bytes this takes, with what its tables need while they are made.
    pub(crate) fn bytes(size: &Size) -> f64 {
        // A quarter turn of a ring mostly sees the same distances; each has a reading of its own
        // for every outcome that ends there: one, and on the border between two the other as well.
        let own = 2.0 * size.ring / 4.0;
        let readings = size.ranges * (own + 64.0);
        // A reading with its evidence, and its gains for all probes.
        let tables = readings * (32.0 * size.bins + 2500.0);
        // Weights, factors and asks of a cell of the stencil, by the outcomes that end nearby.
        let stencil = 500.0 * size.stencil + 100.0 * size.beams * size.ranges;
        let basis = 64.0 * BASIS * size.blocks();
        // Two rooms for a portion of rows and its border.
        let columns = size.width + 2.0 * (size.border + as_f64(LANES));
        let rows = (size.height + 2.0 * size.border).min(4.0 * size.border + 64.0);
        let rooms = 2.0 * 4.0 * rows * columns * (own + 32.0);
        tables + stencil + basis + rooms
    }

    /// Around a row so many rows of cells matter.
    pub(crate) fn border(&self) -> usize {
        self.border
    }

    /// Computes the gains of all units of some rows, in order of y.
    pub(crate) fn run(&mut self, arch: Arch, cells: &Cells, rows: &[Row]) -> Vec<Gains> {
        let mut rooms = std::mem::take(&mut self.rooms);
        let [even, odd] = &mut rooms;
        let (mut gains, more) = rayon::join(
            || self.half(arch, cells, rows, 0, even),
            || self.half(arch, cells, rows, 1, odd),
        );
        for (gain, more) in gains.iter_mut().flatten().zip(more.iter().flatten()) {
            for lane in 0..LANES {
                gain[lane] += more[lane];
            }
        }
        let small = |room: Room| if room.planes.len() <= KEPT { room } else { Room::default() };
        self.rooms = rooms.map(small);
        gains
    }

    /// What every second ring from the `first` on contributes to the gains.
    fn half(
        &self,
        arch: Arch,
        cells: &Cells,
        rows: &[Row],
        first: usize,
        room: &mut Room,
    ) -> Vec<Gains> {
        let Some((low, high)) = rows.first().zip(rows.last()).map(|(l, h)| (l.y, h.y)) else {
            return Vec::new();
        };
        let units: usize = rows.iter().map(|row| row.units.len()).sum();
        let together = if units < SHARED { usize::MAX } else { 1 };
        let mut turns: Vec<Turn> = rows.iter().map(Turn::new).collect();
        let blocks = groups(&self.grid);
        // Rows of planes from `low` − border on.
        let count = high - low + 1 + 2 * self.border;
        let above = (self.grid.height() + self.border - low).min(count);
        let inside = self.border.saturating_sub(low)..above;
        room.prepare((count, self.row), inside.clone(), blocks);
        for (ring, asks) in self.rings.iter().zip(&self.asks).skip(first).step_by(2) {
            room.asked.fill(0);
            self.ask(ring, asks, &mut turns, low, &mut room.asked);
            let filled = room.planes.par_chunks_mut(self.row).zip(room.asked.par_chunks(blocks));
            filled.enumerate().with_min_len(together).for_each(|(y, (planes, asked))| {
                if inside.contains(&y) {
                    let y = y + low - self.border;
                    arch.dispatch(Fill { sweep: self, ring, cells, y, asked, planes });
                }
            });
            let planes = &room.planes;
            turns.par_iter_mut().with_min_len(together).for_each(|turn| {
                arch.dispatch(Sum { sweep: self, ring, planes, low, turn });
            });
        }
        let gains = |turn: Turn| turn.units.iter().map(|progress| progress.gain).collect();
        turns.into_iter().map(gains).collect()
    }

    /// For every block of cells from the first row's on, which readings of a ring the units need.
    fn ask(&self, ring: &Ring, asks: &Asks, turns: &mut [Turn], low: usize, asked: &mut [u64]) {
        let blocks = groups(&self.grid);
        let nearest = ring.near.first().map_or(0, |(k, _)| *k);
        for Turn { row: Row { y, units, outcomes, .. }, units: progress } in turns {
            for (unit, Progress { left, sides, .. }) in units.iter().zip(progress) {
                let passed = outcomes[left.clone()].iter().take_while(|k| **k < nearest);
                left.start += passed.count();
                *sides = self.sides(ring, left.clone(), outcomes);
                let mut ask = |asks: &[Ask], readings: u64| {
                    for ask in asks {
                        let y = (*y + self.border - low).wrapping_add_signed(ask.dy);
                        for block in ask.blocks(unit.group, blocks) {
                            asked[(y * blocks).wrapping_add_signed(block)] |=
                                ask.readings | readings;
                        }
                    }
                };
                let mut of_all = if sides.front.is_empty() { 0 } else { asks.front };
                for k in &outcomes[sides.near.clone()] {
                    let place = ring.near.iter().position(|(near, _)| near == k);
                    if let Some((readings, own)) = place.map(|place| &asks.near[place]) {
                        of_all |= readings;
                        own.get(unit.beam).into_iter().for_each(|own| ask(own, 0));
                    }
                }
                if sides.no_echo.is_some() {
                    of_all |= asks.no_echo;
                }
                if of_all != 0 {
                    ask(&asks.cells[unit.beam], of_all);
                }
            }
        }
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

/// Evaluates the readings of a ring for one row of cells.
struct Fill<'a> {
    sweep: &'a Sweep,
    ring: &'a Ring,
    cells: &'a Cells,
    y: usize,
    asked: &'a [u64],
    planes: &'a mut [f32],
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sweep, ring, cells, y, asked, planes } = self;
        for (x, asked) in asked.iter().enumerate().filter(|(_, asked)| **asked != 0) {
            let block = y * groups(&sweep.grid) + x;
            let prior = cells.block(block);
            let column = sweep.border + x * LANES;
            // Bit by bit: to ask reading by reading, a processor would guess wrong too often.
            let mut left = *asked;
            while left != 0 {
                let first = left.trailing_zeros() as usize;
                left &= left - 1;
                for (i, reading) in ring.readings.iter().enumerate().skip(first).step_by(64) {
                    let at = i * sweep.stride + column;
                    planes[at..at + LANES]
                        .copy_from_slice(&sweep.basis.gain(reading, &prior, block));
                }
            }
        }
    }
}

/// Adds what the cells of a ring contribute to every unit of a row.
struct Sum<'a, 'b> {
    sweep: &'a Sweep,
    ring: &'a Ring,
    planes: &'a [f32],
    low: usize,
    turn: &'a mut Turn<'b>,
}

impl WithSimd for Sum<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sweep, ring, planes, low, turn } = self;
        let Turn { row: Row { y, units, outcomes, probabilities }, units: progress } = turn;
        let start = (y - low + sweep.border) * sweep.row + sweep.border;
        let mixtures = ring.front.as_ref().map_or(&[][..], |front| &front.weights);
        let mut shares = vec![[[0.0; LANES]; TOGETHER]; AT_ONCE * mixtures.len()];
        for (units, progress) in units.chunks(AT_ONCE).zip(progress.chunks_mut(AT_ONCE)) {
            // First all that lies scattered in memory.
            for (i, Progress { sides, .. }) in progress.iter().enumerate() {
                let first = ring.front.as_ref().map_or(0, |front| front.first);
                let likely = sides.front.clone();
                let likely = outcomes[likely.clone()].iter().zip(&probabilities[likely]);
                for (mixture, weights) in mixtures.iter().enumerate() {
                    shares[i * mixtures.len() + mixture] =
                        mix_outcomes(likely.clone(), first, weights);
                }
            }
            for (i, (unit, Progress { sides, gain: total, .. })) in
                units.iter().zip(progress).enumerate()
            {
                let mut of_ring = [0.0; LANES];
                let gain = &mut of_ring;
                let cells = &sweep.offsets[unit.beam][ring.cells[unit.beam].clone()];
                let here = start + unit.group * LANES;
                let place = (here, sweep.stride);
                if let Some(front) = ring.front.as_ref().filter(|_| !sides.front.is_empty()) {
                    let shares = &shares[i * mixtures.len()..(i + 1) * mixtures.len()];
                    front.add(gain, shares, unit.beam, cells, planes, place);
                }
                let near = sides.near.clone();
                for (k, p) in outcomes[near.clone()].iter().zip(&probabilities[near]) {
                    if let Some((_, source)) = ring.near.iter().find(|(near, _)| near == k) {
                        add_product(gain, p, &source.sum(unit.beam, cells, planes, place));
                    }
                }
                if let Some((source, k)) = ring.no_echo.as_ref().zip(sides.no_echo) {
                    let sum = source.sum(unit.beam, cells, planes, place);
                    add_product(gain, &probabilities[k], &sum);
                }
                for lane in 0..LANES {
                    total[lane] += f64::from(of_ring[lane]);
                }
            }
        }
    }
}
