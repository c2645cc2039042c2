//! Firing a ring of sonars.

use super::echo::Echoes;
use crate::sonar::{Blanking, SonarPhysics};
use crate::world::World;
use covmap_sonar::{Beam, Range, SonarRing};
use covmap_statistics::{normal, uniform};
use nalgebra::{Isometry2, Translation2, Vector2};
use rand_pcg::Pcg64;

impl World {
    /// Returns the ranges that the sensors of a ring measure, fired at one pose
    /// (`world_from_robot`).
    ///
    /// Each sensor draws the same number of random variates, whatever its range.
    pub fn fire(
        &self,
        ring: &SonarRing,
        pose: &Isometry2<f64>,
        physics: &SonarPhysics,
        rng: &mut Pcg64,
    ) -> Vec<Range> {
        self.fire_while_moving(ring, pose, Vector2::zeros(), physics, rng)
    }

    /// Returns the ranges of a ring that moves with a velocity \[m/s\], without turning.
    ///
    /// Each sensor is fired `firing_interval` after the one before it.
    pub fn fire_while_moving(
        &self,
        ring: &SonarRing,
        pose: &Isometry2<f64>,
        velocity: Vector2<f64>,
        physics: &SonarPhysics,
        rng: &mut Pcg64,
    ) -> Vec<Range> {
        let mut moved = *pose;
        let step = Translation2::from(velocity * physics.firing_interval);
        let reading = |beam: &Beam| {
            let distance = Echoes::new(self, beam, &moved, physics).nearest();
            moved = step * moved;
            measured(distance, beam, physics, rng)
        };
        ring.beams().iter().map(reading).collect()
    }

    /// Returns the distance at which a sensor of a robot at `pose` would be answered \[m\],
    /// without noise and false readings, if a surface answers within its maximum range.
    pub fn echo(&self, beam: &Beam, pose: &Isometry2<f64>, physics: &SonarPhysics) -> Option<f64> {
        Echoes::new(self, beam, pose, physics).nearest()
    }
}

/// Returns the reading of a sensor, given the exact distance.
fn measured(distance: Option<f64>, beam: &Beam, physics: &SonarPhysics, rng: &mut Pcg64) -> Range {
    let noise = normal(rng);
    let [kind, place] = [uniform(rng), uniform(rng)];
    let span = beam.max_range - beam.min_range;
    let lost = physics.p_spurious_no_echo;
    let anywhere = lost + physics.p_uniform;
    let early = anywhere + physics.p_crosstalk;
    let noisy = distance.map(|d| d + noise * physics.noise_min.max(physics.noise_relative * d));
    let range = if kind < lost {
        None
    } else if kind < anywhere {
        Some(beam.min_range + span * place)
    } else if kind < early {
        let end = noisy.unwrap_or(beam.max_range).max(beam.min_range);
        Some(beam.min_range + (end - beam.min_range) * place)
    } else {
        noisy
    };
    match range {
        Some(range) if range < beam.min_range => match physics.blanking {
            Blanking::ReportMinimum => Range::Echo(beam.min_range),
            Blanking::Missing => Range::Missing,
        },
        Some(range) if range <= beam.max_range => Range::Echo(range),
        _ => Range::NoEcho,
    }
}
