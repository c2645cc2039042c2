//! The seam between the cache, which knows what is stale, and the fast evaluations of E\[I\], which
//! know how an imagined reading changes a histogram.
//!
//! The cache tells an evaluator which blocks of the belief changed. Asked for the gains of some
//! beams, given p(d | c) of their likely outcomes, the evaluator returns
//! Σ_d p(d | c) · Σ_i I(h(c_i) | d) for each. It may have a cheaper upper bound of this; without
//! one, the cache has all gains evaluated that it needs.

use crate::belief::Belief;
use crate::cause::Cause;
use crate::largest::Largest;
use crate::layout::PlaneLayout;
use crate::memory::Size;
use crate::outcomes::{AskedRow, BeamAnswer, RowGains};
use crate::product::Product;
use crate::sight::{GroupLikelihood, RasterBeam};
use crate::{InformationGain, Stencil, Upkeep};
use covmap::Grid;
use covmap_model::{SensorModel, Update};
use pulp::Arch;

/// Fast evaluation of E\[I\], by the update of the imagined readings.
#[derive(Debug, Clone)]
pub(crate) enum Evaluator {
    /// The product of Eq. (9).
    Product(Box<Product>),
    /// The update by cause.
    Cause(Box<Cause>),
}

impl Evaluator {
    /// Creates the evaluator of a model. Bounds are worth their memory only where gains are kept.
    pub(crate) fn new(
        model: &SensorModel,
        stencil: &Stencil,
        grid: Grid,
        belief: &Belief,
        (gain, upkeep): (InformationGain, Upkeep),
    ) -> Self {
        let with_bounds = upkeep == Upkeep::Kept;
        match &model.parameters().update {
            Update::Product(_) => {
                Self::Product(Box::new(Product::new(model, stencil, grid, belief, with_bounds)))
            }
            Update::Cause(parameters) => Self::Cause(Box::new(Cause::new(
                model,
                parameters,
                stencil,
                grid,
                belief,
                (gain, with_bounds),
            ))),
        }
    }

    /// Estimates the bytes of the evaluator, with those that its tables need while they are made.
    pub(crate) fn bytes(size: &Size) -> f64 {
        // Of the update that needs more.
        Product::bytes(size, size.upkeep == Upkeep::Kept).max(Cause::bytes(size))
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(crate) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        match self {
            Self::Product(product) => product.update(arch, belief, changed),
            Self::Cause(cause) => cause.update(arch, belief, changed),
        }
    }

    /// Returns the number of rows of cells on either side of a row of view-points that matter to
    /// its gains.
    pub(crate) fn border(&self) -> usize {
        match self {
            Self::Product(product) => product.border(),
            Self::Cause(_) => 0,
        }
    }

    /// Sets the novelty of a reading from a view-point, by row and column. With the product every
    /// reading is new.
    pub(crate) fn set_novelty(&mut self, place: (usize, usize), novelty: f32) {
        if let Self::Cause(cause) = self {
            cause.set_novelty(place, novelty);
        }
    }

    /// Returns the shares at which gains are interpolated, if they are.
    pub(crate) fn shares(&self) -> Vec<f64> {
        match self {
            Self::Product(_) => Vec::new(),
            Self::Cause(cause) => cause.shares(),
        }
    }

    /// Returns the layout of the planes of gains, if there are any.
    pub(crate) fn planes(&self) -> Option<PlaneLayout> {
        match self {
            Self::Product(product) => Some(product.planes()),
            Self::Cause(_) => None,
        }
    }

    /// Returns the gains of all beams of some rows, which are given in ascending order of y, and
    /// their promises: the gains of the cells that are expected to gain at least `least`. With the
    /// product promises are infinite.
    pub(crate) fn gains(
        &mut self,
        arch: Arch,
        belief: &Belief,
        rows: &[AskedRow],
        least: f32,
    ) -> Vec<RowGains> {
        match self {
            Self::Product(product) => product.gains(arch, belief, rows),
            Self::Cause(cause) => cause.gains(arch, belief, rows, least),
        }
    }

    /// Returns the largest expected change of every cell from some rows of view-points; `None` with
    /// the product, which does not tell the cells apart.
    pub(crate) fn largest_changes(
        &self,
        arch: Arch,
        belief: &Belief,
        rows: &[(AskedRow, &[u16])],
    ) -> Option<Largest> {
        match self {
            Self::Product(_) => None,
            Self::Cause(cause) => Some(cause.largest_changes(arch, belief, rows)),
        }
    }

    /// Returns whether the gain of each cell is known.
    pub(crate) fn tells_cells_apart(&self) -> bool {
        matches!(self, Self::Cause(_))
    }

    /// Returns whether [`bound`](Self::bound) is worth asking.
    pub(crate) fn has_bound(&self) -> bool {
        match self {
            Self::Product(product) => product.has_bound(),
            Self::Cause(cause) => cause.has_bound(),
        }
    }

    /// Returns upper bounds of the expected gain of a beam from each view-point of a group;
    /// infinite if there are none. `here` is the index of the group's first view-point in the
    /// bordered rasters.
    #[inline(always)]
    pub(crate) fn bound(
        &self,
        belief: &Belief,
        (number, beam): (usize, &RasterBeam),
        here: usize,
        likelihood: &GroupLikelihood,
    ) -> BeamAnswer {
        let mut answer = BeamAnswer::all(f32::INFINITY, f32::INFINITY);
        match self {
            Self::Product(product) => {
                if let Some(gain) = product.bound(beam, here, likelihood) {
                    answer.gain = gain;
                }
                answer
            }
            Self::Cause(cause) => cause.bound(belief, number, here, likelihood),
        }
    }
}
