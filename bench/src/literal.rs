//! Integrating a scan in plain f64: Eq. (8)–(11), number by number.
//!
//! The reference for the library's code, with which it shares only the footprint.

use covmap::{Grid, PROBABILITY_FLOOR};
use covmap_model::{Outcome, ProductParameters, SensorModel};
use covmap_sonar::Scan;
use std::f64::consts::PI;

/// A map with its posteriors in f64.
pub(crate) struct LiteralMap {
    grid: Grid,
    bins: usize,
    posterior: Vec<f64>,
    pub(crate) entropy: Vec<f64>,
}

impl LiteralMap {
    pub(crate) fn new(grid: Grid, bins: usize) -> Self {
        let n = bins as f64;
        let (posterior, entropy) = (vec![1.0 / n; grid.len() * bins], vec![n.ln(); grid.len()]);
        Self { grid, bins, posterior, entropy }
    }

    pub(crate) fn integrate(&mut self, model: &SensorModel, scan: &Scan) {
        let grid = self.grid;
        let mut evidence = vec![0.0; self.bins];
        for (beam, range) in scan.ranges.iter().enumerate() {
            let Some(outcome) = model.outcome(*range) else { continue };
            let reach = model.reach(outcome);
            model.footprint().for_each_cell(&grid, &scan.pose, beam, reach, |covered| {
                let Some(index) = grid.index(covered.cell) else { return };
                evaluate(model, covered.cell_distance, outcome, &mut evidence);
                self.multiply(index, &evidence);
            });
        }
    }

    fn multiply(&mut self, index: usize, evidence: &[f64]) {
        let posterior = &mut self.posterior[index * self.bins..(index + 1) * self.bins];
        posterior.iter_mut().zip(evidence).for_each(|(p, e)| *p *= e);
        let z: f64 = posterior.iter().sum();
        posterior.iter_mut().for_each(|p| *p = (*p / z).max(PROBABILITY_FLOOR));
        let sum: f64 = posterior.iter().sum();
        posterior.iter_mut().for_each(|p| *p /= sum);
        self.entropy[index] = -posterior.iter().map(|p| p * p.ln()).sum::<f64>();
    }
}

/// Computes p(c_l = x | d), Eq. (9), not normalised; the product with the posterior is normalised.
fn evaluate(model: &SensorModel, cell_distance: f64, outcome: Outcome, evidence: &mut [f64]) {
    let Some(p) = model.parameters().update.product() else {
        return model.evidence(cell_distance, outcome, evidence);
    };
    let (mu, sigma, gamma) = in_cell(model, p, cell_distance, outcome);
    let bins = evidence.len();
    for (bin, e) in evidence.iter_mut().enumerate() {
        let z = (covmap::bin_coverage(bin, bins) - mu) / sigma;
        let density = gamma + (-0.5 * z * z).exp() / (sigma * (2.0 * PI).sqrt());
        *e = if p.tempering < 1.0 { density.powf(p.tempering) } else { density };
    }
}

/// Returns μ, σ and γ of Eq. (9).
fn in_cell(
    model: &SensorModel,
    p: &ProductParameters,
    cell_distance: f64,
    outcome: Outcome,
) -> (f64, f64, f64) {
    let free = |d: f64| p.sigma_out.at(cell_distance, d);
    match outcome {
        Outcome::Echo(d) => {
            let delta = cell_distance - d;
            let inside = delta.abs() <= 0.5 * model.resolution();
            let sigma = if inside { p.sigma_in } else { free(d) };
            (model.mu(delta), sigma, p.gamma.at(cell_distance, d))
        }
        Outcome::Beyond(_) => {
            let range = model.parameters().usable_range;
            (0.0, free(range), p.gamma.at(cell_distance, range))
        }
        Outcome::NoEcho => (0.0, free(p.no_echo.range), p.no_echo.gamma),
    }
}
