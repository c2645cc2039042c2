//! Histograms of all kinds, on which the errors of tables are measured.
//!
//! No table is proved to be exact enough: its error is measured for the worst of these histograms.
//! They are single and paired peaks of many places and widths on floors of many heights, as few and
//! many readings leave them.

use crate::belief::BlockPrior;
use crate::evidence::BinEvidence;
use crate::numbers::to_f32;
use covmap::bin_coverage;
use covmap::lanes::LANES;
use covmap_model::{Outcome, SensorModel};

/// Largest error of an interpolated gain of a cell, in units of the largest gain of its histogram
/// plus one that matters in a decision: a decision tolerates as much for the worst of histograms.
/// Errors of many cells cancel: E\[I\] is off by some hundredth of it. With four times as much,
/// random models were found whose error is larger than a decision tolerates.
pub(crate) const TOLERANCE: f64 = 1e-5;
/// A gain that matters in a decision, as a part of the largest that a reading can give.
const MATTERING: f64 = 0.1;

/// Widths of the peaks of the probes, and the floors under them, which are high after few readings.
const WIDTHS_AND_FLOORS: [(f64, f64); 10] = [
    (0.04, 1e-6),
    (0.04, 1e-2),
    (0.04, 0.5),
    (0.12, 1e-6),
    (0.12, 1e-3),
    (0.12, 0.2),
    (0.12, 5.0),
    (0.12, 30.0),
    (0.4, 1e-3),
    (0.4, 5.0),
];

/// [`LANES`] probes as a block of cells, in single precision.
struct ProbeBlock {
    h: Vec<f32>,
    h_hat: Vec<f32>,
}

impl ProbeBlock {
    /// Creates a block of at most [`LANES`] probes from h and h·log h of each; the other lanes
    /// are 0.
    fn new(probes: &[(Vec<f64>, Vec<f64>)]) -> Self {
        let bins = probes.first().map_or(0, |(h, _)| h.len());
        let (mut h, mut h_hat) = (vec![0.0; bins * LANES], vec![0.0; bins * LANES]);
        for (lane, (of, u)) in probes.iter().enumerate() {
            let entropy = -u.iter().sum::<f64>();
            for bin in 0..bins {
                h[bin * LANES + lane] = to_f32(of[bin]);
                h_hat[bin * LANES + lane] = to_f32(u[bin] + of[bin] * entropy);
            }
        }
        Self { h, h_hat }
    }

    fn prior(&self) -> BlockPrior<'_> {
        BlockPrior::of(&self.h, &self.h_hat, LANES)
    }
}

/// The probe histograms of a model.
#[derive(Debug, Clone)]
pub(crate) struct ProbeHistograms {
    /// h and h·log h of every bin.
    histograms: Vec<(Vec<f64>, Vec<f64>)>,
    /// A gain that matters in a decision \[nats\].
    scale: f64,
}

impl ProbeHistograms {
    /// Creates the probes of a model, whose strongest evidence is that about a cell near the
    /// sensor.
    pub(crate) fn of_model(model: &SensorModel) -> Self {
        let near = 2.0 * model.resolution();
        Self::new(&BinEvidence::new(model, near, Outcome::Echo(2.0 * near)))
    }

    /// Creates a uniform probe, and narrow and wide ones around many coverages, alone and in pairs.
    /// `strongest` is the evidence that tells most.
    pub(crate) fn new(strongest: &BinEvidence) -> Self {
        let bins = strongest.bins();
        let mut probes = vec![vec![1.0; bins]];
        for center in [0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0] {
            for (width, floor) in WIDTHS_AND_FLOORS {
                let peak = |center: f64, bin: usize| {
                    let z = (bin_coverage(bin, bins) - center) / width;
                    libm::exp(-0.5 * z * z)
                };
                probes.push((0..bins).map(|b| peak(center, b) + floor).collect());
                let other = if center < 0.5 { 1.0 } else { 0.0 };
                probes.push(
                    (0..bins).map(|b| peak(center, b) + 0.5 * peak(other, b) + floor).collect(),
                );
            }
        }
        let probe = |weights: Vec<f64>| {
            let sum: f64 = weights.iter().sum();
            let h: Vec<f64> = weights.iter().map(|w| w / sum).collect();
            let u = h.iter().map(|h| h * libm::log(*h)).collect();
            (h, u)
        };
        let mut found = Self { histograms: probes.into_iter().map(probe).collect(), scale: 0.0 };
        let gains = found.largest_gains(&[found.after(strongest)]);
        found.scale = MATTERING * gains.into_iter().fold(0.0, f64::max);
        found
    }

    /// Returns a gain that matters in a decision \[nats\].
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns the gain of every probe by a reading, Eq. (13) \[nats\].
    pub(crate) fn gains(&self, evidence: &BinEvidence) -> Vec<f64> {
        self.gained(self.after(evidence))
    }

    /// Returns the relative entropy of every probe by a reading \[nats\].
    pub(crate) fn relative_entropies(&self, evidence: &BinEvidence) -> Vec<f64> {
        self.histograms.iter().map(|(h, _)| evidence.relative_entropy(h)).collect()
    }

    /// Returns the gains of all probes by each of some readings, in units of the allowed error of
    /// an interpolated gain.
    pub(crate) fn in_tolerances(&self, readings: &[&BinEvidence]) -> Vec<Vec<f64>> {
        let after: Vec<Vec<f64>> = readings.iter().map(|reading| self.after(reading)).collect();
        let allowed = self.allowed(&after, 1.0);
        after.into_iter().map(|after| self.in_units(after, &allowed)).collect()
    }

    /// Returns the gains of all probes, given their entropies after a reading, in units of each.
    pub(crate) fn in_units(&self, after: Vec<f64>, units: &[f64]) -> Vec<f64> {
        self.gained(after).into_iter().zip(units).map(|(gain, unit)| gain / unit).collect()
    }

    /// Returns the largest error of the gains by some readings in single precision, in units of
    /// each probe.
    pub(crate) fn single_precision(&self, readings: &[&BinEvidence], units: &[f64]) -> f64 {
        let mut worst = 0.0f64;
        for (some, units) in self.histograms.chunks(LANES).zip(units.chunks(LANES)) {
            let block = ProbeBlock::new(some);
            for reading in readings {
                let found = reading.excess().gain(&block.prior());
                for (((h, u), found), unit) in some.iter().zip(found).zip(units) {
                    let gain = -u.iter().sum::<f64>() - reading.entropy_after(h, u);
                    worst = worst.max((f64::from(found) - gain).abs() / unit);
                }
            }
        }
        worst
    }

    /// Returns the entropy of every probe \[nats\].
    fn before(&self) -> impl Iterator<Item = f64> {
        self.histograms.iter().map(|(_, u)| -u.iter().sum::<f64>())
    }

    /// Returns the gain of every probe, given its entropy after a reading \[nats\].
    fn gained(&self, after: Vec<f64>) -> Vec<f64> {
        self.before().zip(after).map(|(before, after)| before - after).collect()
    }

    /// Returns the entropy of every probe after a reading \[nats\].
    pub(crate) fn after(&self, evidence: &BinEvidence) -> Vec<f64> {
        self.histograms.iter().map(|(h, u)| evidence.entropy_after(h, u)).collect()
    }

    /// Returns the allowed error of an interpolated entropy of each probe, given exact ones, times
    /// `leniency`.
    pub(crate) fn allowed(&self, exact: &[Vec<f64>], leniency: f64) -> Vec<f64> {
        let gains = self.largest_gains(exact).into_iter();
        gains.map(|gain| leniency * TOLERANCE * (gain + self.scale)).collect()
    }

    /// Returns the largest change of every probe's entropy, given those after some
    /// readings \[nats\].
    fn largest_gains(&self, after: &[Vec<f64>]) -> Vec<f64> {
        let largest = |(probe, before): (usize, f64)| {
            after.iter().map(|after| (before - after[probe]).abs()).fold(0.0, f64::max)
        };
        self.before().enumerate().map(largest).collect()
    }
}
