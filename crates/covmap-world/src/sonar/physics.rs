//! The behaviour of simulated sonars.

use crate::scenario::Surface;
use covmap::short;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// The largest number of rays across a cone.
pub(super) const MOST_RAYS: usize = 1001;
/// The largest number of mirrors on the way of an echo.
pub(super) const MOST_BOUNCES: u8 = 8;

/// A sonar's report when the echo comes back before the sonar can listen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Blanking {
    /// An echo at its minimum range.
    ReportMinimum,
    /// No reading at all.
    Missing,
}

/// The physics of simulated sonars; each effect is a parameter.
///
/// The cone's half-angle near the sensor, the minimum range and the maximum range belong to the
/// [`Beam`](covmap_sonar::Beam) of each sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SonarPhysics {
    /// The surface of everything outside of a scenario's extent, and of the whole of a world made
    /// from a map.
    pub surface: Surface,
    /// Largest angle from its normal at which a rough surface answers \[rad\], in [0, π/2).
    pub critical_angle_rough: f64,
    /// Largest angle from its normal at which a smooth surface answers \[rad\], in [0, π/2).
    pub critical_angle_smooth: f64,
    /// The number of rays cast across a cone, 11 to 1001. An even number is rounded up: both
    /// sides and the axis get a ray. Rays at the nearest points of surfaces, past their ends, and
    /// at corners are additional.
    pub cone_rays: usize,
    /// Decrease of a cone's half-angle with the range \[rad/m\].
    pub cone_shrink_per_metre: f64,
    /// Least half-angle of a shrinking cone \[rad\]; a cone that starts narrower keeps its own.
    pub cone_min_half_angle: f64,
    /// The largest number of mirrors between the sonar and the surface that answers, at most 8.
    pub max_bounces: u8,
    /// Range up to which convex edges answer \[m\]; concave corners always answer.
    pub edge_range: f64,
    /// The report for an echo below the minimum range.
    pub blanking: Blanking,
    /// The standard deviation of a range is the larger of this \[m\] …
    pub noise_min: f64,
    /// … and of this share of the range.
    pub noise_relative: f64,
    /// Probability that an echo is lost.
    pub p_spurious_no_echo: f64,
    /// Probability of a range that is uniform over the sensor's interval.
    pub p_uniform: f64,
    /// Probability that the sound of another sensor arrives first. The range is then uniform
    /// between the minimum and the range otherwise measured.
    pub p_crosstalk: f64,
    /// Time between the firing of one sensor and the next \[s\]; it matters to a ring that moves.
    pub firing_interval: f64,
}

/// Why the physics are impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PhysicsError {
    /// A number is out of its range.
    #[error("sonar physics: {name} {} must lie in [{low}, {high}]", short(value))]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// The parameter's value.
        value: f64,
        /// The smallest possible value.
        low: f64,
        /// The largest possible value.
        high: f64,
    },
    /// The probabilities of the kinds of false readings exceed one.
    #[error(
        "sonar physics: the probabilities p_spurious_no_echo, p_uniform and p_crosstalk sum to {}, more than 1",
        short(.0)
    )]
    Probabilities(f64),
}

impl SonarPhysics {
    /// Returns the physics of the B21r's Polaroid 6500 sonars among rough surfaces.
    ///
    /// Critical angles of 60° (rough) and 20° (smooth), 1 % or 1 cm of noise, edges that answer
    /// within 2 m, two bounces, a constant cone, no crosstalk, and all sensors fired at once.
    pub fn b21r() -> Self {
        Self {
            surface: Surface::Rough,
            critical_angle_rough: 60.0_f64.to_radians(),
            critical_angle_smooth: 20.0_f64.to_radians(),
            cone_rays: 11,
            cone_shrink_per_metre: 0.0,
            cone_min_half_angle: 7.5_f64.to_radians(),
            max_bounces: 2,
            edge_range: 2.0,
            blanking: Blanking::ReportMinimum,
            noise_min: 0.01,
            noise_relative: 0.01,
            p_spurious_no_echo: 0.01,
            p_uniform: 0.005,
            p_crosstalk: 0.0,
            firing_interval: 0.0,
        }
    }

    /// Returns the same physics without noise and without false readings.
    #[must_use]
    pub fn without_noise(self) -> Self {
        Self {
            noise_min: 0.0,
            noise_relative: 0.0,
            p_spurious_no_echo: 0.0,
            p_uniform: 0.0,
            p_crosstalk: 0.0,
            ..self
        }
    }

    /// Checks every parameter.
    ///
    /// # Errors
    /// If a parameter is not finite or out of its range.
    pub fn validate(&self) -> Result<(), PhysicsError> {
        let [rays, most_rays] = [self.cone_rays, MOST_RAYS].map(|rays| rays as f64);
        // A wall never answers along itself: 89.99°.
        let grazing = FRAC_PI_2 - 1e-4;
        let ranges = [
            ("critical_angle_rough", self.critical_angle_rough, 0.0, grazing),
            ("critical_angle_smooth", self.critical_angle_smooth, 0.0, grazing),
            ("cone_rays", rays, 11.0, most_rays),
            ("cone_shrink_per_metre", self.cone_shrink_per_metre, 0.0, FRAC_PI_2),
            ("cone_min_half_angle", self.cone_min_half_angle, 0.0, FRAC_PI_2),
            ("max_bounces", f64::from(self.max_bounces), 0.0, f64::from(MOST_BOUNCES)),
            ("edge_range", self.edge_range, 0.0, 1000.0),
            ("noise_min", self.noise_min, 0.0, 10.0),
            ("noise_relative", self.noise_relative, 0.0, 1.0),
            ("p_spurious_no_echo", self.p_spurious_no_echo, 0.0, 1.0),
            ("p_uniform", self.p_uniform, 0.0, 1.0),
            ("p_crosstalk", self.p_crosstalk, 0.0, 1.0),
            ("firing_interval", self.firing_interval, 0.0, 10.0),
        ];
        for (name, value, low, high) in ranges {
            if !(low..=high).contains(&value) {
                return Err(PhysicsError::OutOfRange { name, value, low, high });
            }
        }
        let sum = self.p_spurious_no_echo + self.p_uniform + self.p_crosstalk;
        if sum > 1.0 {
            return Err(PhysicsError::Probabilities(sum));
        }
        Ok(())
    }

    /// Returns the critical angle of a surface \[rad\].
    pub fn critical_angle(&self, surface: Surface) -> f64 {
        match surface {
            Surface::Rough => self.critical_angle_rough,
            Surface::Smooth => self.critical_angle_smooth,
        }
    }
}

impl Default for SonarPhysics {
    fn default() -> Self {
        Self::b21r()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_physics_are_refused() {
        assert_eq!(SonarPhysics::b21r().validate(), Ok(()));
        let refuse = |physics: SonarPhysics| physics.validate().unwrap_err().to_string();
        let few = refuse(SonarPhysics { cone_rays: 10, ..SonarPhysics::b21r() });
        assert_eq!(few, "sonar physics: cone_rays 10 must lie in [11, 1001]");
        let nan = refuse(SonarPhysics { noise_min: f64::NAN, ..SonarPhysics::b21r() });
        assert_eq!(nan, "sonar physics: noise_min NaN must lie in [0, 10]");
        let sum = refuse(SonarPhysics { p_uniform: 0.6, p_crosstalk: 0.6, ..SonarPhysics::b21r() });
        assert!(sum.contains("more than 1"), "{sum}");
    }

    #[test]
    fn physics_survive_a_file() {
        let text = ron::to_string(&SonarPhysics::b21r()).unwrap();
        assert_eq!(ron::from_str::<SonarPhysics>(&text).unwrap(), SonarPhysics::b21r());
        assert!(ron::from_str::<SonarPhysics>(&text.replace("noise_min", "noise_max")).is_err());
    }
}
