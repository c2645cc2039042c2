//! Eq. (9) as it runs: many cells side by side, in f32.

use crate::ProductParameters;
use crate::product::ProductReading;
use covmap::bin_coverage;
use covmap::lanes::{LANES, Lanes, TOGETHER, exp, flat, ln, map, rows};

/// Least density, in units of the largest one: a posterior's floor is far above.
const LEAST: f32 = 1e-30;

/// μ, σ and γ of many cells, in blocks of [`LANES`].
#[derive(Debug, Clone, Default)]
pub(crate) struct Terms {
    mu: Vec<f32>,
    sigma: Vec<f32>,
    gamma: Vec<f32>,
}

impl Terms {
    /// Adds cells to which the same reading applies, by their distances \[m\].
    #[inline(always)]
    pub(crate) fn extend(
        &mut self,
        (parameters, resolution): (&ProductParameters, f64),
        reading: &ProductReading,
        distances: impl Iterator<Item = f64>,
    ) {
        for distance in distances {
            let (mu, sigma, gamma) = parameters.terms(resolution, reading, distance);
            #[allow(clippy::cast_possible_truncation, reason = "computed in f32 for speed")]
            {
                self.mu.push(mu as f32);
                self.sigma.push(sigma as f32);
                self.gamma.push(gamma.clamp(1e-30, 1e30) as f32);
            }
        }
    }

    /// Adds cells with arbitrary evidence, until there are `count` in all.
    pub(crate) fn fill(&mut self, count: usize) {
        [&mut self.mu, &mut self.sigma, &mut self.gamma]
            .into_iter()
            .for_each(|terms| terms.resize(count, 1.0));
    }

    /// Evaluates [`crate::SensorModel::evidence`] of a block, not normalised: the largest weight of
    /// a cell lies between ½ and 2. Each weight is within 1e-5 of the literal one, in units of
    /// itself, where that is more than 1e-12 of the largest.
    #[inline(always)]
    pub(crate) fn evidence(
        &self,
        block: usize,
        (bins, tempering): (usize, f64),
        out: &mut [[Lanes; TOGETHER]],
    ) {
        let block = |terms: &[f32]| terms.as_chunks::<LANES>().0[block];
        let (mus, sigmas, gammas) = (block(&self.mu), block(&self.sigma), block(&self.gamma));
        const PEAK: f32 = 0.398_942_3; // 1/√(2π)
        let (mut narrow, mut gamma, mut peak) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            narrow[lane] = 1.0 / sigmas[lane];
            let top = narrow[lane] * PEAK;
            let scale = 1.0 / top.max(gammas[lane]);
            gamma[lane] = (gammas[lane] * scale).max(LEAST);
            peak[lane] = top * scale;
        }
        #[allow(clippy::cast_possible_truncation, reason = "computed in f32 for speed")]
        let tempering = tempering as f32;
        for (first, o) in (0..).step_by(TOGETHER).zip(out) {
            let mut z = [[0.0; LANES]; TOGETHER];
            for (bin, z) in (first..).zip(&mut z) {
                #[allow(clippy::cast_possible_truncation, reason = "computed in f32 for speed")]
                let x = bin_coverage(bin, bins) as f32;
                for lane in 0..LANES {
                    z[lane] = (x - mus[lane]) * narrow[lane];
                }
            }
            let gauss = exp(&map(&flat(&z), |z| (-0.5 * z * z).max(-60.0)));
            let mut density = rows(&gauss);
            for density in &mut density {
                for lane in 0..LANES {
                    density[lane] = gamma[lane] + peak[lane] * density[lane];
                }
            }
            if tempering < 1.0 {
                density = rows(&exp(&map(&ln(&flat(&density)), |log| log * tempering)));
            }
            *o = density;
        }
    }
}
