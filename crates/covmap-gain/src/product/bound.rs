//! Upper bounds of E\[I\], as far as is probed, with which a decision need not evaluate all gains.
//!
//! Imagined readings are put into [`mod@families`], and for each family every cell has a *ceiling*: a gain
//! that no reading of the family exceeds, as far as that is probed. The bound of a beam is Eq. (14)
//! with ceilings in place of gains:
//!
//! ```text
//! Σ_ring Σ_band P(echo beyond the ring in the band) · Σ_i ceiling(in front, band of ring and end)
//!   + Σ_k P(k) · Σ_i ceiling(at the end of k or behind)  +  P(no echo) · Σ_i ceiling(no echo)
//! ```
//!
//! Each sum is over the cells i that the outcomes cover. There are a tenth as many terms as in
//! Eq. (14).
//!
//! A ceiling is the largest gain of a few members of the family, with a margin. The members are
//! chosen on [`ProbeHistograms`] when the tables are made. That is no proof: a histogram unlike all
//! probes may have a gain above its bound, and on coarse grids, of few ranges, some do. A caller
//! that relies on bounds therefore has to ask whether one was exceeded.

mod families;

use crate::Stencil;
use crate::belief::{Belief, BlockPrior};
use crate::memory::Size;
use crate::numbers::as_f64;
use crate::probes::ProbeHistograms;
use crate::sight::{GroupLikelihood, Lanes64, RasterBeam, at_offset};
use crate::view_points::groups_per_row;
use covmap::Grid;
use covmap::lanes::{LANES, Lanes, add_product};
use covmap_model::SensorModel;
use families::{BANDS, NO_ECHO, ReadingFamily, families, in_front, near_end};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// The ceilings of all cells.
#[derive(Debug, Clone)]
pub(super) struct Ceilings {
    grid: Grid,
    families: Vec<ReadingFamily>,
    /// The band of every range.
    bands: Vec<usize>,
    /// For each family a bordered raster; empty if the family has no members.
    rasters: Vec<Vec<f32>>,
}

impl Ceilings {
    pub(super) fn new(model: &SensorModel, stencil: &Stencil, grid: Grid, belief: &Belief) -> Self {
        let ranges = &stencil.ranges;
        let band = |k: usize| (k * BANDS / ranges.len()).min(BANDS - 1);
        let bands: Vec<usize> = (0..ranges.len()).map(band).collect();
        let probes = ProbeHistograms::of_model(model);
        let families = families(model, ranges, &bands);
        let families: Vec<ReadingFamily> =
            families.into_iter().map(|members| ReadingFamily::new(members, &probes)).collect();
        let raster = |family: &ReadingFamily| {
            let cells = if family.readings.is_empty() { 0 } else { belief.limits().len() };
            vec![0.0; cells]
        };
        let rasters = families.iter().map(raster).collect();
        Self { grid, families, bands, rasters }
    }

    /// Estimates the bytes of the ceilings: of the bands in front only those that end farther away
    /// than the cell have members.
    pub(super) fn bytes(size: &Size) -> f64 {
        const FAMILIES: usize = BANDS * (BANDS + 1) / 2 + BANDS + 1;
        4.0 * as_f64(FAMILIES) * size.bordered()
    }

    /// Computes the ceilings of blocks of cells that changed.
    pub(super) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        let (width, per_row) = (self.grid.width(), groups_per_row(&self.grid));
        let families = self.families.par_iter().zip(&mut self.rasters);
        families.filter(|(family, _)| !family.readings.is_empty()).for_each(|(family, raster)| {
            for block in changed {
                let (x, y) = (block % per_row * LANES, block / per_row);
                let (at, count) = (belief.bordered(y * width + x), LANES.min(width - x));
                let ceiling = arch.dispatch(Ceiling { family, prior: belief.prior(*block) });
                raster[at..at + count].copy_from_slice(&ceiling[..count]);
            }
        });
    }

    /// Returns an upper bound, as far as is probed, of the gain of a beam from each view-point of a
    /// group.
    #[inline(always)]
    pub(super) fn bound(
        &self,
        beam: &RasterBeam,
        here: usize,
        likelihood: &GroupLikelihood,
    ) -> Lanes {
        let mut bound = [0.0; LANES];
        let stencil = beam.stencil();
        // The probability of an echo from beyond the present ring, by band.
        let mut beyond = [[0.0; LANES]; BANDS];
        let mut is_beyond = [false; BANDS];
        let mut echoes = likelihood.echoes().iter().rev().peekable();
        let farthest = likelihood.echoes().last().map_or(0, |(k, _)| *k);
        for ring in (0..farthest).rev() {
            while let Some((k, p)) = echoes.next_if(|(k, _)| *k > ring) {
                is_beyond[self.bands[*k]] = true;
                let (beyond, p) = (&mut beyond[self.bands[*k]], narrow(p));
                for lane in 0..LANES {
                    beyond[lane] += p[lane];
                }
            }
            let cells = stencil.rings[ring].start..stencil.rings[ring + 1].start;
            for band in (0..BANDS).filter(|band| is_beyond[*band]) {
                let raster = &self.rasters[in_front(self.bands[ring], band)];
                let sum = sum(raster, beam, cells.clone(), here);
                add_product(&mut bound, &beyond[band], &sum);
            }
        }
        for (k, p) in likelihood.echoes() {
            let start = stencil.rings[*k].start;
            let cells = start..stencil.echo_reach[*k].max(start);
            let sum = sum(&self.rasters[near_end(self.bands[*k])], beam, cells, here);
            add_product(&mut bound, &narrow(p), &sum);
        }
        if stencil.no_echo_reach > 0 {
            let sum = sum(&self.rasters[NO_ECHO], beam, 0..stencil.no_echo_reach, here);
            add_product(&mut bound, &narrow(likelihood.no_echo()), &sum);
        }
        bound
    }
}

/// Returns Σ of the ceilings of some of a beam's cells.
#[inline(always)]
fn sum(raster: &[f32], beam: &RasterBeam, cells: std::ops::Range<usize>, here: usize) -> Lanes {
    let mut sum = [0.0; LANES];
    for offset in &beam.offsets()[cells] {
        let ceiling: &Lanes = at_offset(raster, here, *offset);
        for lane in 0..LANES {
            sum[lane] += ceiling[lane];
        }
    }
    sum
}

/// Converts probabilities to the precision of gains.
#[inline(always)]
fn narrow(probabilities: &Lanes64) -> Lanes {
    let mut narrow = [0.0; LANES];
    for lane in 0..LANES {
        #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
        (narrow[lane] = probabilities[lane] as f32);
    }
    narrow
}

/// The ceiling of a family in a block of cells, compiled for each kind of vector registers.
struct Ceiling<'a> {
    family: &'a ReadingFamily,
    prior: BlockPrior<'a>,
}

impl WithSimd for Ceiling<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Lanes {
        self.family.ceiling(&self.prior)
    }
}
