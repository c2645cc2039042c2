//! Eq. (14) for many view-points at once, ring by ring.
//!
//! For each distance ring, nearest first:
//!
//! 1. *Need:* every beam that is asked for names the readings that each cell of the ring needs.
//! 2. *Fill:* the gains of these cells by these readings are found, [`LANES`] neighbouring cells of
//!    a row side by side. They serve all view-points and beams that see the cells in this ring.
//! 3. *Sum:* for each beam of each group, the part of the ring in E\[I\] is summed over the
//!    beam's cells and the likely outcomes, [`LANES`] neighbouring view-points side by side.
//!
//! The part of a ring is summed in f32, the rings in f64: gains of either sign nearly cancel.

mod planes;
mod sums;
mod swept;

use super::tables::basis::Basis;
use super::tables::needs::{NeededRun, OutcomeNeeds, RingNeeds};
use super::tables::rings::{DistanceRing, rings};
use crate::belief::Belief;
use crate::layout::PlaneLayout;
use crate::memory::Size;
use crate::numbers::as_f64;
use crate::outcomes::{AskedRow, RowGains};
use crate::view_points::groups_per_row;
use crate::{Stencil, StencilCell};
use covmap::Grid;
use covmap::lanes::LANES;
use covmap_model::SensorModel;
use planes::{FillRow, GainPlanes, Layout};
use pulp::Arch;
use rayon::prelude::*;
use swept::{SumRing, SweptRow};

/// Number of beams below which one thread works at each half of the rings. More threads are woken
/// up twice for each ring, which took more than half of the time of an exploration by CL, whose
/// reports have few beams.
const SHARED: usize = 160;

/// The number of readings that are kept for every cell, as the estimate of memory assumes.
const KEPT_READINGS: f64 = 40.0;

/// Largest number of gains in planes that are kept, 16 MB: decisions that need more are slow
/// anyway.
const KEPT_GAINS: usize = 1 << 22;

/// Computes E\[I\] of many beams.
#[derive(Debug, Clone)]
pub(super) struct Sweep {
    grid: Grid,
    basis: Basis,
    rings: Vec<DistanceRing>,
    /// For each ring.
    needs: Vec<RingNeeds>,
    /// For each beam the offsets from a view-point to its cells in the planes.
    offsets: Vec<Vec<isize>>,
    /// The outcome that is no echo.
    no_echo: usize,
    layout: Layout,
    /// Planes of the even rings and of the odd ones, which take about the same time. They are kept,
    /// because fresh memory is slow.
    planes: [GainPlanes; 2],
}

impl Sweep {
    pub(super) fn new(model: &SensorModel, stencil: &Stencil, grid: Grid) -> Self {
        let (rings, mut basis) = rings(model, stencil);
        basis.make_room(grid.height() * groups_per_row(&grid));
        let readings = rings.iter().map(|ring| ring.readings.len()).max().unwrap_or(0);
        let layout = Layout::new(&grid, stencil.radius, readings);
        let row = isize::try_from(layout.row).unwrap_or(0);
        let offset = |c: &StencilCell| c.dy as isize * row + c.dx as isize;
        Self {
            grid,
            needs: rings.iter().map(|ring| RingNeeds::new(ring, stencil)).collect(),
            rings,
            basis,
            offsets: stencil.beams.iter().map(|b| b.cells.iter().map(offset).collect()).collect(),
            no_echo: stencil.ranges.len(),
            layout,
            planes: [GainPlanes::default(), GainPlanes::default()],
        }
    }

    /// Estimates the bytes of the sweep, with those that its tables need while they are made.
    pub(super) fn bytes(size: &Size) -> f64 {
        // A quarter turn of a ring mostly sees the same distances; each has a reading of its own
        // for every outcome that ends there: one, and on the border between two the other as well.
        let own = 2.0 * size.cells_per_ring / 4.0;
        let readings = size.ranges * (own + 64.0);
        // A reading with its evidence, and its gains for all probes.
        let tables = readings * (32.0 * size.bins + 2500.0);
        // Weights, factors and needs of a cell of the stencil, by the outcomes that end nearby.
        let stencil = 500.0 * size.stencil + 100.0 * size.beams * size.ranges;
        let basis = 64.0 * KEPT_READINGS * size.blocks();
        // Two times the planes for a portion of rows and its border.
        let columns = size.width + 2.0 * (size.border + as_f64(LANES));
        let rows = (size.height + 2.0 * size.border).min(4.0 * size.border + 64.0);
        let planes = 2.0 * 4.0 * rows * columns * (own + 32.0);
        tables + stencil + basis + planes
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(super) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        self.basis.update(arch, belief, changed);
    }

    /// Returns the number of rows of cells on either side of a row of view-points that matter.
    pub(super) fn border(&self) -> usize {
        self.layout.border
    }

    /// Returns the layout of the planes of gains.
    pub(super) fn planes(&self) -> PlaneLayout {
        let Layout { border, stride, row } = self.layout;
        PlaneLayout { border, stride, row }
    }

    /// Returns the gains of all beams of some rows, which are given in ascending order of y.
    pub(super) fn gains(
        &mut self,
        arch: Arch,
        belief: &Belief,
        rows: &[AskedRow],
    ) -> Vec<RowGains> {
        let mut planes = std::mem::take(&mut self.planes);
        let [even, odd] = &mut planes;
        let (mut gains, more) = rayon::join(
            || self.every_second_ring(arch, belief, rows, 0, even),
            || self.every_second_ring(arch, belief, rows, 1, odd),
        );
        for (gain, more) in gains.iter_mut().flatten().zip(more.iter().flatten()) {
            for lane in 0..LANES {
                gain.gain[lane] += more.gain[lane];
            }
        }
        let is_small = |planes: &GainPlanes| planes.gains.len() <= KEPT_GAINS;
        self.planes = planes.map(|p| if is_small(&p) { p } else { GainPlanes::default() });
        gains
    }

    /// Returns the part of every second ring from the `first` on in the gains.
    fn every_second_ring(
        &self,
        arch: Arch,
        belief: &Belief,
        rows: &[AskedRow],
        first: usize,
        planes: &mut GainPlanes,
    ) -> Vec<RowGains> {
        let Some((low, high)) = rows.first().zip(rows.last()).map(|(l, h)| (l.y, h.y)) else {
            return Vec::new();
        };
        let beams: usize = rows.iter().map(|row| row.beams.len()).sum();
        let together = if beams < SHARED { usize::MAX } else { 1 };
        let mut swept: Vec<SweptRow> = rows.iter().map(SweptRow::new).collect();
        let Self { grid, basis, layout, .. } = self;
        let (blocks, border) = (groups_per_row(grid), layout.border);
        // The planes begin with the row `low` − border.
        let count = high - low + 1 + 2 * border;
        let above = (grid.height() + border - low).min(count);
        let inside = border.saturating_sub(low)..above;
        planes.prepare(*layout, count, inside.clone(), blocks);
        for (ring, needs) in self.rings.iter().zip(&self.needs).skip(first).step_by(2) {
            planes.needed.fill(0);
            self.note_needs(ring, needs, &mut swept, low, &mut planes.needed);
            let gains = planes.gains.par_chunks_mut(layout.row);
            let filled = gains.zip(planes.needed.par_chunks(blocks));
            filled.enumerate().with_min_len(together).for_each(|(y, (gains, needed))| {
                if inside.contains(&y) {
                    let (y, layout) = (y + low - border, *layout);
                    arch.dispatch(FillRow { grid, basis, layout, ring, belief, y, needed, gains });
                }
            });
            let (gains, offsets) = (&planes.gains, &self.offsets);
            swept.par_iter_mut().with_min_len(together).for_each(|row| {
                arch.dispatch(SumRing { layout: *layout, ring, offsets, gains, low, row });
            });
        }
        swept.into_iter().map(SweptRow::gains).collect()
    }

    /// Moves all beams on to a ring. Notes the readings of the ring that they need for every block
    /// of cells, from the row `low` − border on.
    fn note_needs(
        &self,
        ring: &DistanceRing,
        needs: &RingNeeds,
        rows: &mut [SweptRow],
        low: usize,
        needed: &mut [u64],
    ) {
        let blocks = groups_per_row(&self.grid);
        for SweptRow { asked, beams: swept } in rows {
            let AskedRow { y, beams, outcomes, .. } = asked;
            for (beam, swept) in beams.iter().zip(swept) {
                swept.advance(ring, outcomes, self.no_echo);
                let split = &swept.split;
                let mut need = |runs: &[NeededRun], readings: u64| {
                    for run in runs {
                        let y = (*y + self.layout.border - low).wrapping_add_signed(run.dy);
                        for block in run.blocks(beam.group, blocks) {
                            needed[(y * blocks).wrapping_add_signed(block)] |=
                                run.readings | readings;
                        }
                    }
                };
                let mut of_all = if split.beyond.is_empty() { 0 } else { needs.beyond };
                for k in &outcomes[split.near.clone()] {
                    let place = ring.near.iter().position(|(near, _)| near == k);
                    if let Some(OutcomeNeeds { of_all: readings, own }) =
                        place.map(|place| &needs.near[place])
                    {
                        of_all |= readings;
                        own.get(beam.beam).into_iter().for_each(|own| need(own, 0));
                    }
                }
                if split.no_echo.is_some() {
                    of_all |= needs.no_echo;
                }
                if of_all != 0 {
                    need(&needs.cells[beam.beam], of_all);
                }
            }
        }
    }
}
