//! The gain of every cell as a function of one share, as a polynomial.
//!
//! For a kernel K the evidence of a cell is (1 − x)·U + x·K. Its gain is an analytic function of
//! the share x that is 0 at x = 0, where the slope of a relative entropy is 0 as well. It is
//! interpolated in Chebyshev's nodes of \[0, x_max\]. Their number is what the gains of histograms
//! of all kinds need.

use super::fronts::FrontSums;
use crate::InformationGain;
use crate::belief::{Belief, lanes_at, padded};
use crate::evidence::{BinEvidence, BlockGains, ExcessEvidence};
use crate::memory::Size;
use crate::numbers::PAD;
use crate::numbers::{as_f64, to_f32};
use crate::probes::ProbeHistograms;
use crate::view_points::groups_per_row;
use covmap::Grid;
use covmap::lanes::{LANES, Lanes, fused};
use pulp::Arch;
use rayon::prelude::*;

/// The largest degree.
pub(super) const MOST: usize = 12;

/// Largest error of an interpolated gain, in about the units of the largest gain of its histogram.
const TOLERANCE: f64 = 2e-6;

/// The polynomials of all cells.
#[derive(Debug, Clone)]
pub(super) struct Polynomials {
    grid: Grid,
    largest: f64,
    /// The lowest power.
    first: usize,
    /// The readings at the nodes.
    readings: Vec<ExcessEvidence>,
    /// From gains at the nodes to the coefficients of x/x_max, (x/x_max)², …: a row each.
    to_coefficients: Vec<Vec<f64>>,
    /// By row, power and column, padded as histograms are.
    coefficients: Vec<f32>,
}

/// S_q, of each power.
pub(super) struct PowerSums<'a> {
    polynomials: &'a Polynomials,
    sums: [Lanes; MOST],
}

impl Polynomials {
    /// Creates polynomials of shares up to the `largest`; `evidence` makes the evidence of a share.
    /// Returns `None` if the polynomials would need too many terms: for shares near to 1, or for
    /// kernels that are narrow among many bins.
    pub(super) fn new(
        grid: Grid,
        gain: InformationGain,
        largest: f64,
        evidence: impl Fn(f64) -> BinEvidence,
    ) -> Option<Self> {
        let largest = largest.max(1e-9);
        let probes = ProbeHistograms::new(&evidence(largest));
        let first = match gain {
            InformationGain::Eq14 => 1,
            InformationGain::MutualInformation => 2,
        };
        let gains = |share: f64| match gain {
            InformationGain::Eq14 => probes.gains(&evidence(share * largest)),
            InformationGain::MutualInformation => {
                probes.relative_entropies(&evidence(share * largest))
            }
        };
        let fits = |degree: &usize| error(*degree, first, gains) <= TOLERANCE;
        let degree = (2..=MOST).find(fits)?;
        let nodes = nodes(degree);
        let readings = nodes.iter().map(|t| evidence(t * largest).excess()).collect();
        Some(Self {
            grid,
            largest,
            first,
            readings,
            to_coefficients: inverse(&nodes, first),
            coefficients: vec![0.0; grid.height() * degree * padded(grid.width())],
        })
    }

    /// Estimates the bytes of the polynomials.
    pub(super) fn bytes(size: &Size) -> f64 {
        4.0 * as_f64(MOST) * size.padded()
    }

    /// Returns the shares at which gains are interpolated.
    pub(super) fn shares(&self) -> Vec<f64> {
        nodes(self.degree()).iter().map(|t| t * self.largest).collect()
    }

    fn degree(&self) -> usize {
        self.readings.len()
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(super) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        let (per_row, stride) = (groups_per_row(&self.grid), padded(self.grid.width()));
        let (degree, width) = (self.degree(), self.grid.width());
        let Self { readings, to_coefficients, coefficients, .. } = self;
        let of_row = |y: usize| {
            let place = |block: usize| changed.partition_point(|changed| *changed < block);
            &changed[place(y * per_row)..place((y + 1) * per_row)]
        };
        let rows = coefficients.par_chunks_mut(degree * stride).enumerate().with_min_len(8);
        rows.for_each(|(y, row)| {
            for block in of_row(y) {
                let x = block % per_row * LANES;
                let mut gains = [[0.0; LANES]; MOST];
                let prior = belief.prior(*block);
                arch.dispatch(BlockGains { readings, prior, gains: &mut gains });
                for (power, weights) in to_coefficients.iter().enumerate() {
                    let out = &mut row[power * stride + PAD + x..][..LANES.min(width - x)];
                    for (lane, out) in out.iter_mut().enumerate() {
                        // The weights are large, of either sign, and nearly cancel.
                        let terms = weights.iter().zip(&gains);
                        *out = to_f32(terms.map(|(w, gain)| w * f64::from(gain[lane])).sum());
                    }
                }
            }
        });
    }

    /// Returns the coefficients of the cells from a column of a row on.
    #[inline(always)]
    fn coefficients(&self, (y, x): (usize, isize)) -> &[f32] {
        let stride = padded(self.grid.width());
        &self.coefficients[y * self.degree() * stride + PAD.wrapping_add_signed(x)..]
    }

    /// Returns the gains by the shares `weight`·x.
    #[inline(always)]
    pub(super) fn gain(&self, place: (usize, isize), x: &Lanes, weight: f32) -> Lanes {
        let (stride, coefficients) = (padded(self.grid.width()), self.coefficients(place));
        let scale = weight / to_f32(self.largest);
        let mut gain = [0.0; LANES];
        for power in (0..self.degree()).rev() {
            let coefficient = lanes_at(coefficients, power * stride);
            for lane in 0..LANES {
                gain[lane] = (gain[lane] + coefficient[lane]) * (x[lane] * scale);
            }
        }
        for _ in 1..self.first {
            for lane in 0..LANES {
                gain[lane] *= x[lane] * scale;
            }
        }
        gain
    }

    /// Creates sums to which nothing is added yet.
    #[inline(always)]
    pub(super) fn no_sums(&self) -> PowerSums<'_> {
        PowerSums { polynomials: self, sums: [[0.0; LANES]; MOST] }
    }
}

impl FrontSums for PowerSums<'_> {
    /// Adds p·x^q to every sum.
    #[inline(always)]
    fn add(&mut self, probability: &Lanes, x: &Lanes) {
        let mut term = *probability;
        for _ in 1..self.polynomials.first {
            for lane in 0..LANES {
                term[lane] *= x[lane];
            }
        }
        for sum in &mut self.sums[..self.polynomials.degree()] {
            for lane in 0..LANES {
                term[lane] *= x[lane];
                sum[lane] += term[lane];
            }
        }
    }

    /// Returns the gains by the shares `weight`·x for all the x that were added to the sums.
    #[inline(always)]
    fn of_cell(&self, place: (usize, isize), weight: f32) -> Lanes {
        let Self { polynomials, sums } = self;
        let stride = padded(polynomials.grid.width());
        let coefficients = polynomials.coefficients(place);
        let scale = weight / to_f32(polynomials.largest);
        let mut gain = [0.0; LANES];
        let mut factor = (1..polynomials.first).fold(1.0, |factor, _| factor * scale);
        for (power, sum) in sums[..polynomials.degree()].iter().enumerate() {
            factor *= scale;
            let coefficient = lanes_at(coefficients, power * stride);
            for lane in 0..LANES {
                gain[lane] = fused(coefficient[lane], factor * sum[lane], gain[lane]);
            }
        }
        gain
    }
}

/// Returns Chebyshev's nodes of \[0, 1\].
fn nodes(degree: usize) -> Vec<f64> {
    let node =
        |j: usize| 0.5 - 0.5 * libm::cos(std::f64::consts::PI * (as_f64(j) + 0.5) / as_f64(degree));
    (0..degree).map(node).collect()
}

/// Returns the inverse of the matrix of t_j^q, q from the `first` power on: from values at the
/// nodes to coefficients.
fn inverse(nodes: &[f64], first: usize) -> Vec<Vec<f64>> {
    let n = nodes.len();
    let power = |t: f64, q: usize| (0..q + first).fold(1.0, |power, _| power * t);
    let matrix = nalgebra::DMatrix::from_fn(n, n, |j, q| power(nodes[j], q));
    let inverse = matrix.try_inverse().unwrap_or_else(|| nalgebra::DMatrix::zeros(n, n));
    (0..n).map(|q| inverse.row(q).iter().copied().collect()).collect()
}

/// Returns the largest error of an interpolation by a number of nodes. Its units are the largest
/// gain of its probe plus a twentieth of the largest gain of all.
fn error(degree: usize, first: usize, gains: impl Fn(f64) -> Vec<f64>) -> f64 {
    let nodes = nodes(degree);
    let (inverse, at_nodes) =
        (inverse(&nodes, first), nodes.iter().map(|t| gains(*t)).collect::<Vec<_>>());
    let most: Vec<f64> = (0..=8)
        .map(|i| gains(f64::from(i) / 8.0))
        .fold(vec![1e-12; at_nodes[0].len()], |most, gains| {
            most.iter().zip(&gains).map(|(m, g)| m.max(g.abs())).collect()
        });
    let overall = most.iter().copied().fold(0.0, f64::max);
    let between = (0..4 * degree).map(|i| (as_f64(i) + 0.5) / as_f64(4 * degree));
    let off = between.flat_map(|t| {
        let exact = gains(t);
        let value = |probe: usize| {
            let coefficient =
                |q: usize| inverse[q].iter().zip(&at_nodes).map(|(w, g)| w * g[probe]).sum::<f64>();
            let value = (0..degree).rev().fold(0.0, |value, q| (value + coefficient(q)) * t);
            (1..first).fold(value, |value, _| value * t)
        };
        let off = |(probe, exact): (usize, &f64)| {
            (value(probe) - exact).abs() / (most[probe] + 0.05 * overall)
        };
        exact.iter().enumerate().map(off).collect::<Vec<_>>()
    });
    off.fold(0.0, f64::max)
}
