//! The fast evaluation of E\[I\] for the update by the product, Eq. (9).
//!
//! An *imagined reading* is an outcome d, seen from a distance d^l. Its evidence about a cell is
//! p(c | d), the [`evidence`](crate::evidence), and the gain of the cell by it depends on nothing
//! else but the cell's histogram. The cells are therefore taken ring by ring of distance
//! ([`sweep`]): within a ring all view-points and all beams imagine the same readings. Similar
//! readings have similar gains, so that few are evaluated ([`tables`]): each is interpolated
//! between a few nodes of range and distance, and the nodes are mixtures of a few readings that are
//! kept for every cell.
//!
//! Upper bounds ([`bound`]) put families of readings together, with one number for each cell.

mod bound;
mod sweep;
mod tables;

use crate::Stencil;
use crate::belief::Belief;
use crate::layout::PlaneLayout;
use crate::memory::Size;
use crate::outcomes::{AskedRow, RowGains};
use crate::sight::{GroupLikelihood, RasterBeam};
use bound::Ceilings;
use covmap::Grid;
use covmap::lanes::Lanes;
use covmap_model::SensorModel;
use pulp::Arch;
use sweep::Sweep;
pub use tables::probed::{RangeInterpolation, TableErrors};

/// Evaluates E\[I\] of many beams, and bounds it.
#[derive(Debug, Clone)]
pub(crate) struct Product {
    sweep: Sweep,
    ceilings: Option<Ceilings>,
}

impl Product {
    pub(crate) fn new(
        model: &SensorModel,
        stencil: &Stencil,
        grid: Grid,
        belief: &Belief,
        with_bounds: bool,
    ) -> Self {
        Self {
            sweep: Sweep::new(model, stencil, grid),
            ceilings: with_bounds.then(|| Ceilings::new(model, stencil, grid, belief)),
        }
    }

    /// Estimates the bytes of the evaluation, with those that its tables need while they are made.
    pub(crate) fn bytes(size: &Size, with_bounds: bool) -> f64 {
        Sweep::bytes(size) + if with_bounds { Ceilings::bytes(size) } else { 0.0 }
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(crate) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        self.sweep.update(arch, belief, changed);
        if let Some(ceilings) = &mut self.ceilings {
            ceilings.update(arch, belief, changed);
        }
    }

    /// Returns the number of rows of cells on either side of a row of view-points that matter to
    /// its gains.
    pub(crate) fn border(&self) -> usize {
        self.sweep.border()
    }

    /// Returns the layout of the planes of gains.
    pub(crate) fn planes(&self) -> PlaneLayout {
        self.sweep.planes()
    }

    /// Returns the gains of all beams of some rows, which are given in ascending order of y.
    pub(crate) fn gains(
        &mut self,
        arch: Arch,
        belief: &Belief,
        rows: &[AskedRow],
    ) -> Vec<RowGains> {
        self.sweep.gains(arch, belief, rows)
    }

    pub(crate) fn has_bound(&self) -> bool {
        self.ceilings.is_some()
    }

    /// Returns an upper bound, as far as is probed, of the gain of a beam from each view-point of a
    /// group.
    #[inline(always)]
    pub(crate) fn bound(
        &self,
        beam: &RasterBeam,
        here: usize,
        likelihood: &GroupLikelihood,
    ) -> Option<Lanes> {
        Some(self.ceilings.as_ref()?.bound(beam, here, likelihood))
    }
}
