//! The fitted parameters of the simulated sonars.

use covmap_lab::Config;
use covmap_sonar::RingSpecification;

/// A number of the physics, with its search interval.
pub(super) struct Knob {
    from: f64,
    to: f64,
    get: fn(&Config) -> f64,
    set: fn(&mut Config, f64),
}

/// The knobs of the fit.
///
/// A table of coarse kinds does not show the number of rays and of mirrors, the blanking and the
/// noise of a good echo; these and the surface stay as they are.
pub(super) const KNOBS: [Knob; 6] = [
    Knob { from: 0.05, to: 0.4, get: half_angle, set: set_half_angle },
    Knob {
        from: 0.05,
        to: 1.4,
        get: |c| c.sonar.critical_angle_rough,
        set: |c, v| c.sonar.critical_angle_rough = v,
    },
    Knob { from: 0.0, to: 5.0, get: |c| c.sonar.edge_range, set: |c, v| c.sonar.edge_range = v },
    Knob {
        from: 0.0,
        to: 0.4,
        get: |c| c.sonar.p_spurious_no_echo,
        set: |c, v| c.sonar.p_spurious_no_echo = v,
    },
    Knob { from: 0.0, to: 0.3, get: |c| c.sonar.p_uniform, set: |c, v| c.sonar.p_uniform = v },
    Knob { from: 0.0, to: 0.3, get: |c| c.sonar.p_crosstalk, set: |c, v| c.sonar.p_crosstalk = v },
];

impl Knob {
    /// Returns the setting of the knob, from 0 to 1.
    pub(super) fn place(&self, config: &Config) -> f64 {
        (((self.get)(config) - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// Sets the knob to a place from 0 to 1.
    pub(super) fn set(&self, config: &mut Config, place: f64) {
        // Four digits are enough, and readable.
        let value = self.from + place * (self.to - self.from);
        (self.set)(config, (value * 1e4).round() / 1e4);
    }
}

/// Returns the half-angle of the first sensor's cone; all sensors get the same.
fn half_angle(config: &Config) -> f64 {
    let RingSpecification::Sensors(sensors) = &config.robot.ring else { return 0.0 };
    sensors.first().map_or(0.0, |sensor| sensor.half_angle)
}

/// Sets the half-angle of all cones; a named ring keeps its own.
fn set_half_angle(config: &mut Config, half_angle: f64) {
    if let RingSpecification::Sensors(sensors) = &mut config.robot.ring {
        sensors.iter_mut().for_each(|sensor| sensor.half_angle = half_angle);
        config.sonar.cone_min_half_angle = config.sonar.cone_min_half_angle.min(half_angle);
    }
}
