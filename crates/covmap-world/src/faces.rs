//! Faces, and the index that finds them.

mod face;
mod index;

pub use face::Face;
pub use index::{Bounds, Index};
