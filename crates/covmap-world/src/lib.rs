//! The truth: simulated worlds, their echoes, driving, and the exact coverage of every cell.
//!
//! A [`World`] stands in for the building and the robot of Stachniss & Burgard (2003), section 5.
//! This crate knows nothing of sensor models.
//!
//! # Units
//! Metres, radians counter-clockwise, seconds; coverage in [0, 1].
//!
//! ```
//! use covmap_statistics::stream;
//! use covmap_world::{Scenario, SonarPhysics, Surface, World};
//! let scenario: Scenario = ron::from_str("(name: \"pillar\", extent: (width: 5.0, height: 4.0),
//!     obstacles: [(shape: Circle(center: (3.0, 2.0), radius: 0.4), surface: Smooth)],
//! )")?;
//! let world = World::from_scenario(&scenario, Surface::Rough)?;
//! let coverage = world.coverage(&world.grid(0.1)?);
//! let pose = world.default_start(&coverage, 0.27).expect("the robot fits");
//! let ring = covmap_sonar::SonarRing::b21r();
//! let ranges = world.fire(&ring, &pose, &SonarPhysics::b21r(), &mut stream(1, "fire", 0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod coverage;
mod drive;
mod error;
mod exposed;
mod faces;
mod feature;
pub mod geometry;
mod moved;
mod outline;
mod raster_world;
mod scenario;
mod sight;
mod sonar;
mod world;

pub use error::{MAX_EXTENT, MAX_OBSTACLES, MIN_LENGTH, WorldError};
pub use scenario::{Extent, Obstacle, Scenario, Shape, Start, Surface};
pub use sight::Seen;
pub use sonar::{Blanking, PhysicsError, SonarPhysics};
pub use world::World;
