//! Firing a ring, against the same number of ray casts.

use crate::Measuring;
use crate::clock::race;
use crate::table::{RatioRow, RatioTable};
use anyhow::Result;
use covmap_sonar::Beam;
use covmap_statistics::stream;
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use nalgebra::{Isometry2, Point2, Vector2};

const COLUMNS: u32 = 50;
const ROWS: u32 = 25;
/// The number of places in a round at which the ring is fired.
const PLACES: u32 = 40;

/// Returns 1250 turned boxes of four sides each on a lattice of 1 m.
fn boxes() -> Result<World> {
    let shape = |k: u32| Shape::Rectangle {
        center: (f64::from(k % COLUMNS) + 0.5, f64::from(k / COLUMNS) + 0.5),
        size: (0.35, 0.3),
        angle: f64::from(k),
    };
    let obstacle = |k| Obstacle { shape: shape(k), surface: Surface::Rough };
    let scenario = Scenario {
        name: "boxes".into(),
        extent: Extent { width: f64::from(COLUMNS), height: f64::from(ROWS) },
        start: None,
        obstacles: (0..COLUMNS * ROWS).map(obstacle).collect(),
    };
    Ok(World::from_scenario(&scenario, Surface::Rough)?)
}

/// Returns places without a box.
fn places() -> impl Iterator<Item = Isometry2<f64>> {
    (0..PLACES).map(|k| {
        let (x, y) = (5 + k, 3 + (7 * k) % (ROWS - 6));
        Isometry2::new(Vector2::new(f64::from(x), f64::from(y)), 0.1 * f64::from(k))
    })
}

/// Returns the origins, directions and lengths of the rays across all cones.
fn rays(
    beams: &[Beam],
    pose: Isometry2<f64>,
    across: u32,
) -> impl Iterator<Item = (Point2<f64>, Vector2<f64>, f64)> {
    beams.iter().flat_map(move |beam| {
        let sensor = pose * beam.pose;
        (0..across).map(move |k| {
            let share = 2.0 * f64::from(k) / f64::from(across - 1) - 1.0;
            let angle = sensor.rotation.angle() + share * beam.half_angle;
            let direction = Vector2::new(angle.cos(), angle.sin());
            (sensor.translation.vector.into(), direction, beam.max_range)
        })
    })
}

pub(crate) fn compare(bench: &Measuring<'_>, table: &mut RatioTable) -> Result<()> {
    bench.progress.say("firing …");
    let (world, physics) = (boxes()?, bench.config.sonar);
    let (ring, _) = bench.config.build()?;
    let mut noise = stream(1, "bench", 0);
    let across = u32::try_from(physics.cone_rays)?;
    let all: Vec<_> = places().flat_map(|pose| rays(ring.beams(), pose, across)).collect();
    let ours =
        || places().map(|p| world.fire(&ring, &p, &physics, &mut noise).len()).sum::<usize>();
    let other =
        || all.iter().filter(|(at, to, max)| world.cast_ray(*at, *to, *max).is_some()).count();
    let (ours, other) = race(3 * bench.extent.rounds, ours, other);
    table.row(RatioRow {
        what: "fire 24 sonars among 5000 segments".into(),
        ours: ours / f64::from(PLACES),
        against: format!("{} ray casts", ring.beams().len() * physics.cone_rays),
        other: other / f64::from(PLACES),
        target: 1.0 / 1.1,
    });
    Ok(())
}
