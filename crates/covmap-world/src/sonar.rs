//! Simulated sonars: their physics, their echoes, and their readings.

mod echo;
mod fire;
mod physics;

pub use physics::{Blanking, PhysicsError, SonarPhysics};
