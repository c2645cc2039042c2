//! How simulated sonars behave.

use crate::scenario::Surface;
use covmap::short;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// The most rays across a cone.
pub(super) const MOST_RAYS: usize = 1001;
/// The most mirrors that an echo goes by.
pub(super) const MOST_BOUNCES: u8 = 8;

/// What a sonar reports when the echo comes back before it can listen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Blanking {
    /// An echo at its minimum range.
    ReportMinimum,
    /// No reading at all.
    Missing,
}

/// The physics of simulated sonars; each effect is a parameter.
///
/// The cone's half-angle near the sensor, the minimum and the maximum range belong to the
/// [`Beam`](covmap_sonar::Beam) of each sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SonarPhysics {
    /// The surface of everything outside of a scenario's extent, and of all of a world that
    /// is made from a map.
    pub surface: Surface,
    /// A rough surface answers up to this angle from its normal \[rad\], in [0, π/2).
    pub critical_angle_rough: f64,
    /// A smooth surface answers up to this angle from its normal \[rad\], in [0, π/2).
    pub critical_angle_smooth: f64,
    /// How many rays are cast across a cone, 11 to 1001; an even number is rounded up, so
    /// that both sides and the axis get theirs. Rays at the nearest points of surfaces, past
    /// their ends, and at corners come on top.
    pub cone_rays: usize,
    /// By how much a cone's half-angle shrinks with the range \[rad/m\].
    pub cone_shrink_per_metre: f64,
    /// A shrinking cone stops at this half-angle \[rad\], or at its first if that is smaller.
    pub cone_min_half_angle: f64,
    /// How many mirrors a sound may meet on its way to what answers it, at most 8.
    pub max_bounces: u8,
    /// Convex edges answer up to this range \[m\]; concave corners always answer.
    pub edge_range: f64,
    /// What is reported for an echo below the minimum range.
    pub blanking: Blanking,
    /// Standard deviation of a range is the larger of this \[m\] …
    pub noise_min: f64,
    /// … and of this share of the range.
    pub noise_relative: f64,
    /// Probability that an echo is lost.
    pub p_spurious_no_echo: f64,
    /// Probability of a range that is uniform over all that the sensor can measure.
    pub p_uniform: f64,
    /// Probability that the sound of another sensor arrives first: a range that is uniform
    /// between the minimum and what would have been measured.
    pub p_crosstalk: f64,
    /// Time between the firing of one sensor and the next \[s\]; matters to a ring that moves.
    pub firing_interval: f64,
}

/// What is wrong with the physics.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PhysicsError {
    /// A number is out of its range.
    #[error("sonar physics: {name} {} must lie in [{low}, {high}]", short(value))]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The smallest that is possible.
        low: f64,
        /// The largest that is possible.
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
    /// The B21r's Polaroid 6500 sonars among rough surfaces: critical angles of 60° (rough)
    /// and 20° (smooth), 1 % or 1 cm of noise, edges that answer within 2 m, two bounces,
    /// a constant cone, no crosstalk, and all sensors fired at once.
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

    /// The same physics without noise and without false readings.
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
    /// If one is not finite or out of its range.
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

    /// The critical angle of a surface \[rad\].
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
