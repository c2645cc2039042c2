//! The starts of a campaign.

use crate::error::StartsFault;
use crate::file::Starts;
use covmap_explore::ParameterError;
use covmap_lab::{Config, drawn_starts};
use covmap_world::World;
use nalgebra::{Isometry2, Vector2};

/// Largest number of starts that are drawn.
const MOST: usize = 1000;
/// Side of the cells whose centres starts are drawn from \[m\], whatever the cells of the map.
const SPACING: f64 = 0.1;
/// Room around a robot at a drawn start \[m\].
const ROOM: f64 = 0.15;

impl Starts {
    /// Returns the number of starts. [`Starts::poses`] reports a number that is too large to draw.
    pub fn count(&self) -> usize {
        match self {
            Self::Given => 1,
            Self::Poses(poses) => poses.len(),
            Self::Drawn { count, .. } => (*count).min(MOST),
        }
    }

    /// Returns the poses, `world_from_robot`.
    ///
    /// Drawn starts can be reached from the start that the world gives, or from its roomiest place.
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

/// The world's own start, or the one that `explore` takes on cells with the side `resolution` \[m\].
fn given(world: &World, radius: f64, resolution: f64) -> Result<Isometry2<f64>, StartsFault> {
    if let Some(start) = world.given_start() {
        return Ok(start);
    }
    let grid = world.grid(resolution).map_err(ParameterError::from)?;
    let start = world.default_start(&world.coverage(&grid), radius);
    start.ok_or(StartsFault::Nowhere(radius))
}
