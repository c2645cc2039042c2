//! The copy of the map from which sight and gains are computed, laid out for the beams of many
//! view-points. It does not depend on how they are computed.
//!
//! Values along beams lie in *bordered rasters*: rasters of the grid with a border as wide as a
//! stencil, so that a stencil's cell is at a constant offset from every view-point, inside of the
//! grid or not. Values that are read cell by cell lie in blocks of [`LANES`] neighbouring cells of
//! a row: histograms bin by bin, so that a bin of all cells of a block is one vector.

use crate::memory::Size;
use crate::numbers::{PAD, to_f32};
use crate::view_points::{group_and_lane, groups_per_row};
use crate::{InformationGain, RangePrediction, Stencil};
use covmap::lanes::{LANES, Lanes};
use covmap::{Cell, CoverageMap, Grid, MAX_BINS, bin_coverage};

/// The copy of the map, and the limits of the cells that are reasons to measure.
#[derive(Debug, Clone)]
pub(crate) struct Belief {
    grid: Grid,
    bins: usize,
    border: usize,
    /// Reflection of a cell, by its code.
    reflection_of: Vec<f64>,
    /// Bordered: the bin of the cell's mode, or one of the three codes past all bins.
    codes: Vec<u8>,
    /// Bordered: ρ, the reflection of the cell.
    reflections: Vec<f64>,
    /// Bordered: the number of the [`LANES`] cells from here on that reflect anything.
    reflecting: Vec<u8>,
    /// Bordered: the expected coverage, where gains are predicted by it; else empty.
    means: Vec<f64>,
    unknown_coverage: f64,
    /// Bordered: the distance up to which the cell is a reason to measure \[m\]; 0 if it is none.
    limits: Vec<f32>,
    /// By block: entropies \[nats\].
    entropies: Vec<Lanes>,
    /// By block: 1 for a cell that a measurement can change, else 0.
    changeable: Vec<Lanes>,
    /// By row, bin and column, with [`PAD`] columns on either side: h and ĥ of [`Prior`]; 0 where
    /// nothing can change.
    h: Vec<f32>,
    h_hat: Vec<f32>,
    /// Bordered: the expected coverage of a known cell, [`NOT_KNOWN`] of another one of the grid.
    expected: Vec<f32>,
    /// The blocks with changes since the last [`take_changed`](Self::take_changed), and a mark for
    /// each block.
    changed: Vec<usize>,
    is_changed: Vec<bool>,
}

/// Value in place of an expected coverage: no reading has touched the cell.
pub(crate) const NOT_KNOWN: f32 = -1.0;

/// The histograms of [`LANES`] neighbouring cells of a row, before a reading.
#[derive(Clone, Copy)]
pub(crate) struct Prior<'a> {
    h: &'a [f32],
    h_hat: &'a [f32],
    stride: usize,
}

impl<'a> Prior<'a> {
    /// Returns h of a bin, of each cell.
    #[inline(always)]
    pub(crate) fn h(&self, bin: usize) -> &'a Lanes {
        lanes_at(self.h, bin * self.stride)
    }

    /// Returns ĥ = h·(log h + H) of a bin, with the entropy H of h, of each cell.
    #[inline(always)]
    pub(crate) fn h_hat(&self, bin: usize) -> &'a Lanes {
        lanes_at(self.h_hat, bin * self.stride)
    }
}

/// The histograms of a block of cells, before a reading.
pub(crate) struct BlockPrior<'a> {
    prior: Prior<'a>,
    /// 1 for a cell that a measurement can change, else 0.
    pub(crate) changeable: &'a Lanes,
}

impl<'a> BlockPrior<'a> {
    /// Creates the prior of histograms that lie bin by bin, one `stride` from the next; all can
    /// change.
    pub(crate) fn of(h: &'a [f32], h_hat: &'a [f32], stride: usize) -> Self {
        Self { prior: Prior { h, h_hat, stride }, changeable: &[1.0; LANES] }
    }

    /// Returns [`Prior::h`].
    #[inline(always)]
    pub(crate) fn h(&self, bin: usize) -> &'a Lanes {
        self.prior.h(bin)
    }

    /// Returns [`Prior::h_hat`].
    #[inline(always)]
    pub(crate) fn h_hat(&self, bin: usize) -> &'a Lanes {
        self.prior.h_hat(bin)
    }
}

/// Returns the [`LANES`] numbers from a place on.
#[inline(always)]
pub(crate) fn lanes_at(numbers: &[f32], place: usize) -> &Lanes {
    let Some(lanes) = numbers[place..].first_chunk() else { panic!("rows are padded") };
    lanes
}

/// Codes past the last bin.
const UNKNOWN: usize = 0;
const PINNED: usize = 1;
const OUTSIDE: usize = 2;

impl Belief {
    pub(crate) fn new(
        grid: Grid,
        bins: usize,
        stencil: &Stencil,
        prediction: RangePrediction,
        unknown_coverage: f64,
    ) -> Self {
        let border = usize::try_from(stencil.radius).unwrap_or(0);
        let bordered = (grid.width() + 2 * border) * (grid.height() + 2 * border);
        let mut reflection_of: Vec<f64> = (0..bins).map(|k| bin_coverage(k, bins)).collect();
        reflection_of.extend([prediction.unknown_reflection, 0.0, 0.0]);
        #[allow(clippy::cast_possible_truncation, reason = "at most 67 codes")]
        let outside = (bins + OUTSIDE) as u8;
        let by_means = prediction.gain == InformationGain::MutualInformation;
        // Lanes past the last cell of a row read on.
        let bordered = bordered + LANES;
        let blocks = grid.height() * groups_per_row(&grid);
        let none = [0.0; LANES];
        let mut belief = Self {
            grid,
            bins,
            border,
            codes: vec![outside; bordered],
            means: vec![0.0; if by_means { bordered } else { 0 }],
            unknown_coverage,
            limits: vec![0.0; bordered],
            reflection_of,
            reflections: vec![0.0; bordered],
            reflecting: vec![0; bordered],
            entropies: vec![none; blocks],
            changeable: vec![none; blocks],
            h: vec![0.0; grid.height() * bins * padded(grid.width())],
            h_hat: vec![0.0; grid.height() * bins * padded(grid.width())],
            expected: vec![0.0; bordered],
            changed: Vec::new(),
            is_changed: vec![false; blocks],
        };
        if let Ok(unknown) = CoverageMap::new(grid, bins) {
            grid.cells().for_each(|cell| {
                belief.update(&unknown, cell);
            });
        }
        belief
    }

    /// Estimates the bytes of the belief.
    pub(crate) fn bytes(size: &Size) -> f64 {
        // Codes, limits, reflections, how many reflect, and expected coverages, perhaps twice.
        const BORDERED: f64 = 1.0 + 4.0 + 8.0 + 1.0 + 4.0 + 8.0;
        // Of a block: entropies, whether its cells are changeable, and whether it changed.
        const BLOCK: f64 = 128.0 + 9.0;
        let histograms = 8.0 * size.bins * size.padded();
        BORDERED * size.bordered() + BLOCK * size.blocks() + histograms
    }

    /// Returns the index of a cell in the bordered rasters, by its row-major index.
    #[inline(always)]
    pub(crate) fn bordered(&self, index: usize) -> usize {
        let (x, y) = (index % self.grid.width(), index / self.grid.width());
        (y + self.border) * self.raster_width() + x + self.border
    }

    /// Returns the row and column of a cell of the grid, by its index in the bordered rasters.
    #[inline(always)]
    pub(crate) fn place(&self, bordered: usize) -> (usize, usize) {
        let width = self.raster_width();
        (bordered / width - self.border, bordered % width - self.border)
    }

    /// Takes over a cell's posterior. Returns whether the cell's reflection, or its ability to
    /// change, is different now.
    pub(crate) fn update(&mut self, map: &CoverageMap, cell: Cell) -> bool {
        let Some(index) = self.grid.index(cell) else { return false };
        let mut posterior = [0.0; MAX_BINS];
        let posterior = &mut posterior[..self.bins];
        map.read_posterior(cell, posterior);
        let (block, lane) = self.block_of(index);
        if !std::mem::replace(&mut self.is_changed[block], true) {
            self.changed.push(block);
        }
        let code = if map.is_pinned(cell) {
            self.bins + PINNED
        } else if map.is_known(cell) {
            self.reflection_of[..self.bins].partition_point(|c| *c < map.mode(cell))
        } else {
            self.bins + UNKNOWN
        };
        let changeable = code <= self.bins + UNKNOWN;
        self.write_histogram(index, posterior, changeable);
        self.changeable[block][lane] = f32::from(u8::from(changeable));
        #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
        (self.entropies[block][lane] = map.entropy(cell) as f32);
        let bordered = self.bordered(index);
        let rho = self.reflection_of[code];
        #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
        let expected = if code == self.bins + UNKNOWN { NOT_KNOWN } else { map.mean(cell) as f32 };
        self.expected[bordered] = expected;
        if let Some(mean) = self.means.get_mut(bordered) {
            let is_known = code != self.bins + UNKNOWN;
            *mean = if is_known { map.mean(cell) } else { self.unknown_coverage };
        }
        let old = std::mem::replace(&mut self.reflections[bordered], rho);
        if (old > 0.0) != (rho > 0.0) {
            // At the very beginning of the raster there are fewer.
            for count in &mut self.reflecting[(bordered + 1).saturating_sub(LANES)..=bordered] {
                *count = if rho > 0.0 { *count + 1 } else { *count - 1 };
            }
        }
        #[allow(clippy::cast_possible_truncation, reason = "at most 67 codes")]
        let old = std::mem::replace(&mut self.codes[bordered], code as u8);
        usize::from(old) != code
    }

    fn write_histogram(&mut self, index: usize, posterior: &[f64], changeable: bool) {
        let (x, y) = (index % self.grid.width(), index / self.grid.width());
        let (first, stride) = (self.row(y) + PAD + x, padded(self.grid.width()));
        let entropy = -posterior.iter().map(|p| p * libm::log(*p)).sum::<f64>();
        for (bin, p) in posterior.iter().enumerate() {
            let at = first + bin * stride;
            let tilted = p * (libm::log(*p) + entropy);
            // The relative entropy is the fall of the entropy without this term.
            let tilted = if self.means.is_empty() { tilted } else { 0.0 };
            let numbers = if changeable { (*p, tilted) } else { (0.0, 0.0) };
            (self.h[at], self.h_hat[at]) = (to_f32(numbers.0), to_f32(numbers.1));
        }
    }

    /// Returns the place at which the histograms of a row begin.
    fn row(&self, y: usize) -> usize {
        y * self.bins * padded(self.grid.width())
    }

    /// Returns the histograms of the cells from column `x` of row `y` on. They may begin up to
    /// [`PAD`] columns before the first one, and end as far past the last.
    #[inline(always)]
    pub(crate) fn prior_at(&self, y: usize, x: isize) -> Prior<'_> {
        let place = self.row(y) + PAD.wrapping_add_signed(x);
        let stride = padded(self.grid.width());
        Prior { h: &self.h[place..], h_hat: &self.h_hat[place..], stride }
    }

    /// Returns the expected coverages, a bordered raster.
    pub(crate) fn expected(&self) -> &[f32] {
        &self.expected
    }

    /// Returns the blocks with changes since the last call, in ascending order.
    pub(crate) fn take_changed(&mut self) -> Vec<usize> {
        let mut changed = std::mem::take(&mut self.changed);
        changed.iter().for_each(|block| self.is_changed[*block] = false);
        changed.sort_unstable();
        changed
    }

    /// Returns ρ of all cells, a bordered raster.
    pub(crate) fn reflections(&self) -> &[f64] {
        &self.reflections
    }

    /// Returns the reflections of cells where gains are predicted by expected coverages, a bordered
    /// raster; empty where they are not.
    pub(crate) fn means(&self) -> &[f64] {
        &self.means
    }

    /// Returns whether any of the [`LANES`] cells from an index of the bordered rasters on
    /// reflects.
    #[inline(always)]
    pub(crate) fn any_reflects(&self, bordered: usize) -> bool {
        self.reflecting[bordered] > 0
    }

    /// Returns the distances up to which cells are reasons to measure \[m\], a bordered raster.
    pub(crate) fn limits(&self) -> &[f32] {
        &self.limits
    }

    /// Returns whether a cell is a reason to measure from a distance \[m\], by its row-major index.
    #[inline(always)]
    pub(crate) fn is_reason(&self, index: usize, distance: f32) -> bool {
        distance <= self.limits[self.bordered(index)]
    }

    /// Sets a cell's limit; returns whether it changed.
    pub(crate) fn set_limit(&mut self, index: usize, limit: f32) -> bool {
        let bordered = self.bordered(index);
        let old = std::mem::replace(&mut self.limits[bordered], limit);
        old.to_bits() != limit.to_bits()
    }

    /// Returns a cell's entropy by its row-major index \[nats\].
    pub(crate) fn entropy(&self, index: usize) -> f32 {
        let (block, lane) = self.block_of(index);
        self.entropies[block][lane]
    }

    /// Returns the block that holds a cell, and the cell's lane.
    fn block_of(&self, index: usize) -> (usize, usize) {
        group_and_lane(self.grid.width(), index)
    }

    /// Returns the histograms of a block.
    #[inline(always)]
    pub(crate) fn prior(&self, block: usize) -> BlockPrior<'_> {
        let per_row = groups_per_row(&self.grid);
        let x = (block % per_row * LANES).cast_signed();
        let prior = self.prior_at(block / per_row, x);
        BlockPrior { prior, changeable: &self.changeable[block] }
    }

    /// Returns the number of columns and rows around the grid in the bordered rasters.
    pub(crate) fn border(&self) -> usize {
        self.border
    }

    /// Returns the distance of two rows in the bordered rasters.
    pub(crate) fn raster_width(&self) -> usize {
        self.grid.width() + 2 * self.border
    }
}

/// Returns the number of columns of a padded row with a number of cells.
pub(crate) fn padded(width: usize) -> usize {
    width.next_multiple_of(LANES) + 2 * PAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_model::{ModelParameters, SensorModel, integrate, integrate_body};
    use covmap_sonar::{Range, Scan, SonarRing};
    use nalgebra::{Isometry2, Point2, Vector2};

    #[test]
    fn what_reflects_is_counted() {
        let model = SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.1).unwrap();
        let stencil = Stencil::new(&model, 0.0);
        let grid = Grid::new(Point2::new(-2.0, -1.0), 0.1, 41, 23).unwrap();
        for unknown_reflection in [0.0, 0.3] {
            let gain = InformationGain::Eq14;
            let prediction =
                RangePrediction { gain, unknown_reflection, uniform_share: 0.0, novelty: 1.0 };
            let mut map = CoverageMap::new(grid, 11).unwrap();
            let mut belief = Belief::new(grid, 11, &stencil, prediction, 0.0);
            for turn in 0..6u32 {
                let at = Vector2::new(0.3 * f64::from(turn) - 1.0, 0.0);
                let range = |i: u32| Range::Echo(0.4 + 0.05 * f64::from((i * 7 + turn) % 24));
                let pose = Isometry2::new(at, 0.0);
                let scan = Scan { pose, time: 0.0, ranges: (0..24).map(range).collect() };
                let changes = integrate(&model, &mut map, &scan).into_iter();
                let body = integrate_body(&mut map, at.into(), at.into(), 0.27);
                for change in changes.chain(body) {
                    belief.update(&map, change.cell);
                }
                let windows = belief.reflections.windows(LANES).enumerate();
                for (bordered, reflections) in windows {
                    let any = reflections.iter().any(|rho| *rho > 0.0);
                    assert_eq!(belief.any_reflects(bordered), any);
                }
            }
        }
    }
}
