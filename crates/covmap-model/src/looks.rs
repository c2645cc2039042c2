//! Earlier looks, and the novelty of a reading after them.

use crate::parameters::Repeats;
use crate::{SensorModel, integrate_new};
use covmap::{Change, CoverageMap};
use covmap_sonar::Scan;
use nalgebra::{Isometry2, Vector2};

/// Distance of two looks beyond which they share no errors, in units of λ.
const FARTHEST: f64 = 3.0;

/// The looks so far, which decide the novelty of the next one.
///
/// Readings of one wall from one place share their errors: the wall does not answer at that angle,
/// or a post in the cone answers for it. Eq. (8) multiplies them as if they were independent, so
/// that a robot that stands still becomes ever more certain. Here a reading repeats an earlier one
/// with the probability
///
/// ```text
/// ρ = ρ_0 · exp(−½ (Δ/λ)²) · exp((cos Δφ − 1)/ψ²)
/// ```
///
/// with the distance Δ between both sensors and the angle Δφ between their axes. A reading that
/// repeats another says nothing: its shares of "ended" and "passed" ([`crate::Causes`]) are
/// multiplied by
///
/// ```text
/// novelty = Π_j (1 − max_b ρ)         over the earlier scans j and their beams b
/// ```
///
/// Thus n looks from one place count as 1 + (1 − ρ_0) + (1 − ρ_0)² + …, at most 1/ρ_0. The mixture
/// is Bayes, given that a reading either repeats an earlier one or is independent of all; the
/// product of the chances of repeating is an approximation. With the product of Eq. (9), and with
/// ρ_0 = 0, every reading is new, as in the paper.
#[derive(Debug, Clone)]
pub struct Looks {
    repeats: Repeats,
    taken: Vec<Isometry2<f64>>,
}

impl Looks {
    /// Creates an empty record with a model's parameters.
    pub fn new(model: &SensorModel) -> Self {
        Self { repeats: model.repeats(), taken: Vec::new() }
    }

    /// Integrates a scan, weighted by its novelty, and records the look. Returns the changes, in
    /// row-major order, each cell once.
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

    /// Returns the novelty of each beam's reading at a pose, in \[0, 1\].
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
    /// Parameters under which every reading is new.
    pub const NONE: Self = Self { share: 0.0, distance: 1.0, bearing: 1.0 };

    /// Returns ρ, by the distance between two sensors \[m\] and the cosine of the angle between
    /// their axes.
    fn alike(&self, apart: f64, cos: f64) -> f64 {
        if apart > FARTHEST * self.distance {
            return 0.0;
        }
        let z = apart / self.distance;
        self.share * libm::exp(-0.5 * z * z + (cos - 1.0) / (self.bearing * self.bearing))
    }

    /// Returns 1 − ρ of a look with the same heading at a distance \[m\]: the novelty that it
    /// leaves.
    pub fn left(&self, apart: f64) -> f64 {
        1.0 - self.alike(apart, 1.0)
    }

    /// Returns the largest distance of looks that share errors \[m\].
    pub fn reach(&self) -> f64 {
        if self.share > 0.0 { FARTHEST * self.distance } else { 0.0 }
    }
}
