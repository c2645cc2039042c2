//! The update by cause as it runs: many cells side by side, in f32.

use crate::CauseParameters;
use crate::cause::{Role, Shares, gaussian};
use covmap::bin_coverage;
use covmap::lanes::{LANES, Lanes, TOGETHER, exp, flat, map, rows};

/// The shares of many cells, in blocks of [`LANES`].
#[derive(Debug, Clone)]
pub(crate) struct CauseTerms {
    bins: usize,
    /// N(0, σ_free) at every bin.
    free: Vec<f32>,
    ended: Vec<f32>,
    mu: Vec<f32>,
    sigma: Vec<f32>,
    passed: Vec<f32>,
}

impl CauseTerms {
    pub(crate) fn new(parameters: &CauseParameters, bins: usize) -> Self {
        let mut free = vec![0.0; bins];
        gaussian(0.0, parameters.free.sigma, &mut free);
        let free = free.into_iter().map(single).collect();
        let none = Vec::new;
        Self { bins, free, ended: none(), mu: none(), sigma: none(), passed: none() }
    }

    /// Adds a cell.
    #[inline(always)]
    pub(crate) fn push(&mut self, role: &Role, shares: &Shares) {
        self.ended.push(single(shares.ended));
        self.mu.push(single(role.mu));
        self.sigma.push(single(role.sigma));
        self.passed.push(single(shares.passed));
    }

    /// Adds cells without evidence, until there are `count` in all.
    pub(crate) fn fill(&mut self, count: usize) {
        for (terms, value) in [
            (&mut self.ended, 0.0),
            (&mut self.mu, 0.0),
            (&mut self.sigma, 1.0),
            (&mut self.passed, 0.0),
        ] {
            terms.resize(count, value);
        }
    }

    /// Evaluates [`crate::Causes::evidence`] of a block. Each weight is within 1e-6 of the literal
    /// one, in units of the largest.
    #[inline(always)]
    pub(crate) fn evidence(&self, block: usize, out: &mut [[Lanes; TOGETHER]]) {
        let block = |terms: &[f32]| terms.as_chunks::<LANES>().0[block];
        let (mut ended, passed) = (block(&self.ended), block(&self.passed));
        let each = 1.0 / self.bins as f32;
        let mut even = [0.0; LANES];
        for lane in 0..LANES {
            even[lane] = (1.0 - ended[lane] - passed[lane]) * each;
        }
        let ends = ended.iter().any(|share| *share > 0.0);
        if ends {
            let (mus, sigmas) = (block(&self.mu), block(&self.sigma));
            let narrow = sigmas.map(|sigma| 1.0 / sigma);
            let mut sum = [0.0; LANES];
            for (first, o) in (0..).step_by(TOGETHER).zip(out.iter_mut()) {
                *o = gauss(first, self.bins, &mus, &narrow);
                for w in o.iter().take(self.bins - first) {
                    for lane in 0..LANES {
                        sum[lane] += w[lane];
                    }
                }
            }
            for lane in 0..LANES {
                ended[lane] /= sum[lane];
            }
        }
        for (w, free) in out.as_flattened_mut().iter_mut().zip(&self.free) {
            for lane in 0..LANES {
                let from_end = if ends { ended[lane] * w[lane] } else { 0.0 };
                w[lane] = even[lane] + from_end + passed[lane] * free;
            }
        }
    }
}

/// Returns exp(−½((x − μ)/σ)²) at some bins.
#[inline(always)]
fn gauss(first: usize, bins: usize, mus: &Lanes, narrow: &Lanes) -> [Lanes; TOGETHER] {
    let mut z = [[0.0; LANES]; TOGETHER];
    for (bin, z) in (first..).zip(&mut z) {
        let x = single(bin_coverage(bin, bins));
        for lane in 0..LANES {
            z[lane] = (x - mus[lane]) * narrow[lane];
        }
    }
    rows(&exp(&map(&flat(&z), |z| (-0.5 * z * z).max(-60.0))))
}

fn single(x: f64) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "computed in f32 for speed")]
    let single = x as f32;
    single
}
