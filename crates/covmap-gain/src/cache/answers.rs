//! The answers of a cache after a refresh.

use super::GainCache;
use crate::belief::padded;
use crate::numbers::PAD;
use crate::view_points::group_and_lane;
use crate::{MemoryLayout, Stencil, ViewPoints};
use covmap::lanes::LANES;

impl GainCache {
    /// Returns the cells around a view-point.
    pub fn stencil(&self) -> &Stencil {
        &self.stencil
    }

    /// Returns whether a cell is a reason to measure from a distance \[m\].
    pub fn is_reason(&self, index: usize, distance: f32) -> bool {
        self.belief.is_reason(index, distance)
    }

    /// Returns a cell's entropy \[nats\].
    pub fn entropy(&self, index: usize) -> f32 {
        self.belief.entropy(index)
    }

    /// Returns E\[I(l)\] of a view-point, or an upper bound of it \[nats\]: see
    /// [`is_exact`](Self::is_exact).
    pub fn gain(&self, view_point: usize) -> f64 {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        self.mean_gain[group][lane]
    }

    /// Returns whether E\[I(l)\] of a view-point is up to date and not only bounded.
    pub fn is_exact(&self, view_point: usize) -> bool {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        self.groups[group].gain >> lane & 1 == 1
    }

    /// Returns the number of nearest cells of a beam that decide its sight and its gain.
    ///
    /// The number holds for all refreshed view-points of the group of this one: a change of any
    /// other cell leaves their values as they are.
    pub fn horizon(&self, view_point: usize, beam: usize) -> usize {
        let (group, _) = group_and_lane(self.grid.width(), view_point);
        usize::from(self.states[group * self.beams.len() + beam].horizon)
    }

    /// Returns the layout of the cache in memory.
    pub fn layout(&self) -> MemoryLayout {
        MemoryLayout {
            lanes: LANES,
            border: self.belief.border(),
            raster_width: self.belief.raster_width(),
            padding: PAD,
            padded_width: padded(self.grid.width()),
            planes: self.evaluator.planes(),
        }
    }

    /// Returns the shares of "passed" at which the update by cause interpolates the gain of a cell.
    /// There are none with Eq. (9), or where all cells are evaluated as they are.
    pub fn interpolated_shares(&self) -> Vec<f64> {
        self.evaluator.shares()
    }

    /// Returns whether a gain was above its bound since the last call.
    pub fn take_exceeded(&mut self) -> bool {
        std::mem::take(&mut self.exceeded)
    }

    /// Returns whether a view-point has a reason to measure in sight: a cell no farther away than
    /// its limit.
    pub fn has_reason(&self, view_point: usize) -> bool {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        self.groups[group].has_reason >> lane & 1 == 1
    }

    /// Returns the expected gain of a scan from a view-point in the cells that are reasons to
    /// measure \[nats\].
    ///
    /// The sum is over all beams, and over those cells i of each that are no farther away than
    /// their limits and whose entropy is expected to fall by the least change or more:
    ///
    /// ```text
    /// Σ_i Σ_d p(d | c) · I(h_i | d)
    /// ```
    ///
    /// The value is exact where the gain [is exact](Self::is_exact), an upper bound where there is
    /// a bound of the gain, and infinite where there is neither. With the product of Eq. (9) it is
    /// infinite: its evaluation does not tell the cells apart.
    pub fn promise(&self, view_point: usize) -> f64 {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        if self.groups[group].bound >> lane & 1 == 0 {
            return f64::INFINITY;
        }
        let beams = &self.answers[group * self.beams.len()..(group + 1) * self.beams.len()];
        beams.iter().map(|beam| f64::from(beam.promise[lane])).sum()
    }

    /// Returns whether [`promise`](Self::promise) can be finite.
    pub fn tells_cells_apart(&self) -> bool {
        self.evaluator.tells_cells_apart()
    }

    /// Returns those of some view-points that have a reason to measure in sight, in row-major
    /// order.
    pub fn with_reason(&self, view_points: &ViewPoints) -> Vec<usize> {
        view_points.indices(|group| self.groups[group].has_reason)
    }

    /// Returns V(l) of a view-point: cells by their row-major index, with their distance from the
    /// sensor \[m\], in row-major order. A cell in two beams appears once, with the shorter
    /// distance.
    pub fn cells_in_sight(&self, view_point: usize) -> Vec<(usize, f32)> {
        let mut seen: Vec<(usize, f32)> = self.beam_by_beam(view_point).collect();
        seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        seen.dedup_by_key(|(index, _)| *index);
        seen
    }

    /// Returns whether a view-point has a cell in sight that `is_wanted`, by its row-major index
    /// and its distance from the sensor \[m\].
    pub fn sees(&self, view_point: usize, is_wanted: impl Fn(&(usize, f32)) -> bool) -> bool {
        self.beam_by_beam(view_point).any(|cell| is_wanted(&cell))
    }

    /// Returns the cells in sight of a view-point, beam by beam.
    fn beam_by_beam(&self, view_point: usize) -> impl Iterator<Item = (usize, f32)> {
        let from = self.grid.cell(view_point);
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        let in_sight = &self.in_sight[group * self.beams.len()..];
        self.beams.iter().zip(in_sight).flat_map(move |(beam, in_sight)| {
            beam.cells_in_sight(in_sight[lane]).filter_map(move |(cell, distance)| {
                Some((self.grid.index(from.offset(cell.dx, cell.dy))?, distance))
            })
        })
    }
}
