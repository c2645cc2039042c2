//! Simulated sonars: their physics, what answers them, and what they report.

mod echo;
mod fire;
mod physics;
mod random;

pub use physics::{Blanking, PhysicsError, SonarPhysics};
pub use random::{stream, uniform};
