//! Sums of gains over the cells of a beam in a ring, from all view-points of a group side by side.
//!
//! `cells` are the offsets of the cells from a view-point in the planes of gains, `here` is the
//! group's first view-point there, and `stride` leads from one reading's plane to the next one's.

use crate::product::tables::beyond::BeyondOutcomes;
use crate::product::tables::rings::{CellReadings, OutcomeReadings, OwnReading};
use covmap::lanes::{LANES, Lanes, TOGETHER, add_product, add_scaled};

/// Returns the weight of each of some readings in all of a beam's outcomes beyond a ring together:
/// Σ_d p(d | c) · weight(d). The `nearest` outcome has the first weights.
#[inline(always)]
pub(crate) fn mix_outcomes<'a>(
    likely: impl Iterator<Item = (&'a usize, &'a Lanes)>,
    nearest: usize,
    weights: &[[f32; TOGETHER]],
) -> [Lanes; TOGETHER] {
    let [mut a, mut b, mut c, mut d] = [[0.0; LANES]; TOGETHER];
    for (k, p) in likely {
        let weights = &weights[k - nearest];
        add_scaled(&mut a, p, weights[0]);
        add_scaled(&mut b, p, weights[1]);
        add_scaled(&mut c, p, weights[2]);
        add_scaled(&mut d, p, weights[3]);
    }
    [a, b, c, d]
}

impl BeyondOutcomes {
    /// Adds the gains of a beam's cells by all outcomes together, given the weight of each reading
    /// in them.
    #[inline(always)]
    pub(crate) fn add(
        &self,
        gain: &mut Lanes,
        reading_weights: &[[Lanes; TOGETHER]],
        beam: usize,
        cells: &[isize],
        planes: &[f32],
        (here, stride): (usize, usize),
    ) {
        for (some, (factors, weights)) in self.factors[beam].iter().zip(reading_weights).enumerate()
        {
            let first = here + (self.first + some * TOGETHER) * stride;
            let sums = match self.count - some * TOGETHER {
                1 => sum_some::<1>(factors, cells, planes, first, stride),
                2 => sum_some::<2>(factors, cells, planes, first, stride),
                3 => sum_some::<3>(factors, cells, planes, first, stride),
                _ => sum_some::<TOGETHER>(factors, cells, planes, first, stride),
            };
            for (weights, sum) in weights.iter().zip(&sums) {
                add_product(gain, weights, sum);
            }
        }
    }
}

/// Returns Σ of the gains of some cells by each of R readings, with a factor for each; 0 for the
/// readings from R on.
#[inline(always)]
fn sum_some<const R: usize>(
    factors: &[[f32; TOGETHER]],
    cells: &[isize],
    planes: &[f32],
    first: usize,
    stride: usize,
) -> [Lanes; TOGETHER] {
    let mut sums = [[0.0; LANES]; R];
    for (offset, factors) in cells.iter().zip(factors) {
        let at = first.wrapping_add_signed(*offset);
        for (reading, sum) in sums.iter_mut().enumerate() {
            add_scaled(sum, gains_at(planes, at + reading * stride), factors[reading]);
        }
    }
    std::array::from_fn(|reading| if reading < R { sums[reading] } else { [0.0; LANES] })
}

impl OutcomeReadings {
    /// Returns Σ of the gains of a beam's cells by the outcome.
    #[inline(always)]
    pub(crate) fn sum(
        &self,
        beam: usize,
        cells: &[isize],
        planes: &[f32],
        (here, stride): (usize, usize),
    ) -> Lanes {
        let first = here + self.first * stride;
        match &self.cells {
            CellReadings::Weighted(weights) => {
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
                                add_scaled(&mut sum, gains_at(planes, at), *weight);
                                at += stride;
                            }
                        }
                        sum
                    }
                }
            }
            CellReadings::Own(own) => {
                let mut sum = [0.0; LANES];
                for OwnReading { cell, reading } in &own[beam] {
                    let at = first.wrapping_add_signed(cells[*cell]) + reading * stride;
                    add_scaled(&mut sum, gains_at(planes, at), 1.0);
                }
                sum
            }
        }
    }
}

/// Returns Σ of M readings over some cells, with M weights for each cell.
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
            add_scaled(&mut sum, gains_at(planes, at + i * stride), *weight);
        }
    }
    sum
}

#[inline(always)]
fn gains_at(plane: &[f32], at: usize) -> &Lanes {
    plane[at..].first_chunk().unwrap_or(&[0.0; LANES])
}
