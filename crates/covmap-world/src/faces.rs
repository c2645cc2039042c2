//! Faces, and how to find them.

mod face;
mod index;

pub use face::Face;
pub use index::{Bounds, Index};
