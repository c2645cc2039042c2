//! Simulated sonars: their physics, what answers them, and what they report.

mod echo;
mod fire;
mod physics;

pub use physics::{Blanking, PhysicsError, SonarPhysics};
