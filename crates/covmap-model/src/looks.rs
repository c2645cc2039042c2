//! From where it was looked before: how much of a reading is new.

use crate::parameters::Repeats;
use crate::{SensorModel, integrate_new};
use covmap::{Change, CoverageMap};
use covmap_sonar::Scan;
use nalgebra::{Isometry2, Vector2};

/// Looks that are more than this many λ apart share no errors.
const FARTHEST: f64 = 3.0;

/// The looks that were taken so far, and how much of another one would be new.
///
/// Readings of one wall from one place share their errors: the wall does not answer at that angle, or
/// a post in the cone answers for it. Eq. (8) multiplies them as if they were independent, and a
/// robot that stands still grows surer for ever. Here a reading repeats an earlier one with the
/// probability
///
/// ```text
/// ρ = ρ_0 · exp(−½ (Δ/λ)²) · exp((cos Δφ − 1)/ψ²)
/// ```
///
/// by the distance Δ between both sensors and the angle Δφ between their axes, and says nothing then:
/// its shares of "ended" and "passed" ([`crate::Causes`]) are multiplied by
///
/// ```text
/// novelty = Π_j (1 − max_b ρ)         over the earlier scans j and their beams b
/// ```
///
/// So n looks from one place count as 1 + (1 − ρ_0) + (1 − ρ_0)² + …, never more than 1/ρ_0. The
/// mixture is Bayes, given that a reading either repeats an earlier one or is independent of all; that
/// the chances of repeating multiply is an approximation. With the product of Eq. (9), and with ρ_0 = 0,
/// everything is new, as in the paper.
#[derive(Debug, Clone)]
pub struct Looks {
    repeats: Repeats,
    taken: Vec<Isometry2<f64>>,
}

impl Looks {
    /// No look yet, with a model's parameters.
    pub fn new(model: &SensorModel) -> Self {
        Self { repeats: model.repeats(), taken: Vec::new() }
    }

    /// Integrates a scan by as much as is new of it, and takes note of the look. Returns what
    /// changed, in row-major order, each cell once.
    ///
    /// # Panics
    /// As [`crate::integrate`].
    pub fn integrate(
        &mut self,
        model: &SensorModel,
        map: &mut CoverageMap,
        scan: &Scan,
    ) -> Vec<Change> {
        let novelty = self.novelty(model, &scan.pose);
        if self.repeats.share > 0.0 {
            self.taken.push(scan.pose);
        }
        integrate_new(model, map, scan, &novelty)
    }

    /// How much of each beam's reading at a pose would be new, in \[0, 1\].
    pub fn novelty(&self, model: &SensorModel, pose: &Isometry2<f64>) -> Vec<f64> {
        let sensors: Vec<_> = model.footprint().sensors().collect();
        let ring = sensors.iter().map(|(at, _)| at.coords.norm()).fold(0.0, f64::max);
        let farthest = self.repeats.reach() + 2.0 * ring;
        let mut novelty = vec![1.0; sensors.len()];
        for taken in &self.taken {
            let apart = (taken.translation.vector - pose.translation.vector).norm();
            // A log has many looks, and few are near.
            if apart > farthest {
                continue;
            }
            let turned = taken.rotation.rotation_to(&pose.rotation);
            let is_same_heading = turned.angle().abs() < 1e-9;
            if is_same_heading {
                let left = self.repeats.left(apart);
                novelty.iter_mut().for_each(|n| *n *= left);
                continue;
            }
            for ((at, axis), novelty) in sensors.iter().zip(&mut novelty) {
                let (at, axis) = (pose * at, pose * axis);
                let alike = |(earlier, looks): &(nalgebra::Point2<f64>, Vector2<f64>)| {
                    let cos = (taken * looks).dot(&axis);
                    self.repeats.alike((taken * earlier - at).norm(), cos)
                };
                *novelty *= 1.0 - sensors.iter().map(alike).fold(0.0, f64::max);
            }
        }
        novelty
    }
}

impl Repeats {
    /// Everything is new.
    pub const NONE: Self = Self { share: 0.0, distance: 1.0, bearing: 1.0 };

    /// ρ, by the distance between two sensors \[m\] and the cosine of the angle between their axes.
    fn alike(&self, apart: f64, cos: f64) -> f64 {
        if apart > FARTHEST * self.distance {
            return 0.0;
        }
        let z = apart / self.distance;
        self.share * libm::exp(-0.5 * z * z + (cos - 1.0) / (self.bearing * self.bearing))
    }

    /// 1 − ρ of a look with the same heading from so far away \[m\]: what it leaves to learn.
    pub fn left(&self, apart: f64) -> f64 {
        1.0 - self.alike(apart, 1.0)
    }

    /// How far apart looks may be that share errors \[m\].
    pub fn reach(&self) -> f64 {
        if self.share > 0.0 { FARTHEST * self.distance } else { 0.0 }
    }
}
