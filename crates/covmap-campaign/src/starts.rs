//! Places to start from.

use crate::error::StartsFault;
use crate::file::Starts;
use covmap_explore::ParameterError;
use covmap_lab::{Config, drawn_starts};
use covmap_world::World;
use nalgebra::{Isometry2, Vector2};

/// The most starts that are drawn.
const MOST: usize = 1000;
/// Starts are drawn among the centres of cells of this side \[m\], whatever the map's are.
const SPACING: f64 = 0.1;
/// So much room there is around a robot at a start that is drawn \[m\].
const ROOM: f64 = 0.15;

impl Starts {
    /// How many there are; of more than can be drawn, [`Starts::poses`] says so.
    pub fn count(&self) -> usize {
        match self {
            Self::Given => 1,
            Self::Poses(poses) => poses.len(),
            Self::Drawn { count, .. } => (*count).min(MOST),
        }
    }

    /// The poses, `world_from_robot`.
    ///
    /// Drawn are those that can be reached from the start that the world gives, or from its
    /// roomiest place.
    pub fn poses(
        &self,
        world: &World,
        config: &Config,
    ) -> Result<Vec<Isometry2<f64>>, StartsFault> {
        let radius = config.robot.radius;
        match self {
            Self::Given => Ok(vec![given(world, radius, config.resolution)?]),
            Self::Poses(poses) if poses.is_empty() => Err(StartsFault::Empty),
            Self::Poses(poses) => {
                let pose = |&(x, y, angle): &(f64, f64, f64)| {
                    Isometry2::new(Vector2::new(x, y), angle.to_radians())
                };
                Ok(poses.iter().map(pose).collect())
            }
            Self::Drawn { count, .. } if !(1..=MOST).contains(count) => {
                Err(StartsFault::Count { count: *count, most: MOST })
            }
            Self::Drawn { count, seed } => {
                let grid = world.grid(SPACING).map_err(ParameterError::from)?;
                let home = given(world, radius, SPACING)?;
                let starts = drawn_starts(world, &grid, &home, (radius, ROOM), (*count, *seed));
                starts.map_err(|there| StartsFault::Room { count: *count, there })
            }
        }
    }
}

/// The world's own start, or the one that `explore` takes on cells of a side \[m\].
fn given(world: &World, radius: f64, resolution: f64) -> Result<Isometry2<f64>, StartsFault> {
    if let Some(start) = world.given_start() {
        return Ok(start);
    }
    let grid = world.grid(resolution).map_err(ParameterError::from)?;
    let start = world.default_start(&world.coverage(&grid), radius);
    start.ok_or(StartsFault::Nowhere(radius))
}
