//! Sums of gains over the cells of a beam, [`LANES`] view-points side by side.

use super::rings::{Front, Shares, Source};
use covmap::lanes::{LANES, Lanes, TOGETHER};

/// How much each of some nodes weighs in all of a unit's outcomes from the `first` on together.
#[inline(always)]
pub(super) fn mix_outcomes<'a>(
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

impl Front {
    /// Adds the gains of a beam's cells, given the shares of the ranges.
    #[inline(always)]
    pub(super) fn add(
        &self,
        gain: &mut Lanes,
        shares: &[[Lanes; TOGETHER]],
        beam: usize,
        cells: &[isize],
        planes: &[f32],
        (here, stride): (usize, usize),
    ) {
        let of_cells = &self.of_cells[beam];
        let per_range = self.distances * stride;
        for (some, shares) in shares.iter().enumerate() {
            let first = here + some * TOGETHER * per_range;
            let ranges = (self.ranges - some * TOGETHER).min(TOGETHER);
            let strides = (stride, per_range);
            let sums = match (self.distances, ranges) {
                (1, 1) => mix_ranges::<1, 1>(of_cells, cells, planes, first, strides),
                (1, 2) => mix_ranges::<1, 2>(of_cells, cells, planes, first, strides),
                (1, 3) => mix_ranges::<1, 3>(of_cells, cells, planes, first, strides),
                (1, _) => mix_ranges::<1, 4>(of_cells, cells, planes, first, strides),
                (2, 1) => mix_ranges::<2, 1>(of_cells, cells, planes, first, strides),
                (2, 2) => mix_ranges::<2, 2>(of_cells, cells, planes, first, strides),
                (2, 3) => mix_ranges::<2, 3>(of_cells, cells, planes, first, strides),
                (2, _) => mix_ranges::<2, 4>(of_cells, cells, planes, first, strides),
                (3, 1) => mix_ranges::<3, 1>(of_cells, cells, planes, first, strides),
                (3, 2) => mix_ranges::<3, 2>(of_cells, cells, planes, first, strides),
                (3, 3) => mix_ranges::<3, 3>(of_cells, cells, planes, first, strides),
                (3, _) => mix_ranges::<3, 4>(of_cells, cells, planes, first, strides),
                (distances, ranges) => {
                    let mut sums = [[0.0; LANES]; TOGETHER];
                    for (offset, weights) in cells.iter().zip(of_cells.chunks_exact(distances)) {
                        let at = first.wrapping_add_signed(*offset);
                        for (range, sum) in sums.iter_mut().enumerate().take(ranges) {
                            for (i, weight) in weights.iter().enumerate() {
                                let at = at + range * per_range + i * stride;
                                add(sum, lanes(planes, at), *weight);
                            }
                        }
                    }
                    sums
                }
            };
            for (share, sum) in shares.iter().zip(&sums) {
                add_product(gain, share, sum);
            }
        }
    }
}

/// Σ of the gains of some cells at each of R ranges, with D weights for each cell; 0 for the
/// ranges from R on.
#[inline(always)]
fn mix_ranges<const D: usize, const R: usize>(
    of_cells: &[f32],
    cells: &[isize],
    planes: &[f32],
    first: usize,
    (stride, per_range): (usize, usize),
) -> [Lanes; TOGETHER] {
    let mut sums = [[0.0; LANES]; R];
    for (offset, weights) in cells.iter().zip(of_cells.as_chunks::<D>().0) {
        let at = first.wrapping_add_signed(*offset);
        for (range, sum) in sums.iter_mut().enumerate() {
            for (i, weight) in weights.iter().enumerate() {
                add(sum, lanes(planes, at + range * per_range + i * stride), *weight);
            }
        }
    }
    std::array::from_fn(|range| if range < R { sums[range] } else { [0.0; LANES] })
}

impl Source {
    /// The gains of a beam's cells, summed.
    #[inline(always)]
    pub(super) fn sum(
        &self,
        beam: usize,
        cells: &[isize],
        planes: &[f32],
        (here, stride): (usize, usize),
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
pub(super) fn add_product(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * b[lane];
    }
}
