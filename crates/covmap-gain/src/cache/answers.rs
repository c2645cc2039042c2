//! What a cache answers, once it was refreshed.

use super::GainCache;
use crate::belief::padded;
use crate::numbers::PAD;
use crate::view_points::group_and_lane;
use crate::{MemoryLayout, Stencil, ViewPoints};
use covmap::lanes::LANES;

impl GainCache {
    /// The cells around a view-point.
    pub fn stencil(&self) -> &Stencil {
        &self.stencil
    }

    /// Whether a cell is a reason to measure from so far away \[m\].
    pub fn is_reason(&self, index: usize, distance: f32) -> bool {
        self.belief.is_reason(index, distance)
    }

    /// A cell's entropy \[nats\].
    pub fn entropy(&self, index: usize) -> f32 {
        self.belief.entropy(index)
    }

    /// E\[I(l)\] of a view-point, or an upper bound of it \[nats\]: see
    /// [`is_exact`](Self::is_exact).
    pub fn gain(&self, view_point: usize) -> f64 {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        self.mean_gain[group][lane]
    }

    /// Whether E\[I(l)\] of a view-point is up to date, not only a bound of it.
    pub fn is_exact(&self, view_point: usize) -> bool {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        self.groups[group].gain >> lane & 1 == 1
    }

    /// How many cells of a beam, in order of their distance, decide what the beam sees and gains from
    /// the view-points of a group that were refreshed, of which this is one: a change of any other
    /// cell leaves all of them as they are.
    pub fn horizon(&self, view_point: usize, beam: usize) -> usize {
        let (group, _) = group_and_lane(self.grid.width(), view_point);
        usize::from(self.states[group * self.beams.len() + beam].horizon)
    }

    /// How what the cache keeps lies in memory.
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

    /// The shares of "passed" at which the gain of a cell is interpolated, with the update by cause;
    /// none with that of Eq. (9), or where all cells are evaluated as they are.
    pub fn interpolated_shares(&self) -> Vec<f64> {
        self.evaluator.shares()
    }

    /// Whether a gain was met since this was last asked that is above its bound.
    pub fn take_exceeded(&mut self) -> bool {
        std::mem::take(&mut self.exceeded)
    }

    /// Whether a view-point holds a reason to measure in sight: a cell that is no farther away than
    /// its limit.
    pub fn has_reason(&self, view_point: usize) -> bool {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        self.groups[group].has_reason >> lane & 1 == 1
    }

    /// What a scan from a view-point is expected to tell about the cells that are reasons to measure,
    /// no farther away than their limits \[nats\]: over all beams and those cells i of each whose
    /// entropy is expected to fall by the least change or more,
    ///
    /// ```text
    /// Σ_i Σ_d p(d | c) · I(h_i | d)
    /// ```
    ///
    /// It is this where the gain [is exact](Self::is_exact), an upper bound where there is a bound
    /// of the gain, and infinite where there is neither. With the product of Eq. (9) it is infinite: its evaluation does not tell the cells
    /// apart.
    pub fn promise(&self, view_point: usize) -> f64 {
        let (group, lane) = group_and_lane(self.grid.width(), view_point);
        if self.groups[group].bound >> lane & 1 == 0 {
            return f64::INFINITY;
        }
        let beams = &self.answers[group * self.beams.len()..(group + 1) * self.beams.len()];
        beams.iter().map(|beam| f64::from(beam.promise[lane])).sum()
    }

    /// Whether [`promise`](Self::promise) says something.
    pub fn tells_cells_apart(&self) -> bool {
        self.evaluator.tells_cells_apart()
    }

    /// Those of some view-points which hold a reason to measure in sight, in row-major order.
    pub fn with_reason(&self, view_points: &ViewPoints) -> Vec<usize> {
        view_points.indices(|group| self.groups[group].has_reason)
    }

    /// V(l) of a view-point: cells by their row-major index, with their distance from the sensor
    /// \[m\], in row-major order; a cell in two beams once, with the shorter distance.
    pub fn cells_in_sight(&self, view_point: usize) -> Vec<(usize, f32)> {
        let mut seen: Vec<(usize, f32)> = self.beam_by_beam(view_point).collect();
        seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        seen.dedup_by_key(|(index, _)| *index);
        seen
    }

    /// Whether a view-point holds a cell in sight that `is_wanted`, by its row-major index and its
    /// distance from the sensor \[m\].
    pub fn sees(&self, view_point: usize, is_wanted: impl Fn(&(usize, f32)) -> bool) -> bool {
        self.beam_by_beam(view_point).any(|cell| is_wanted(&cell))
    }

    /// The cells in sight of a view-point, beam by beam.
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
