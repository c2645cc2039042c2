//! Faces, outlines and solids, and how to find them, for who estimates a world from measurements.

pub use crate::coverage::Solids;
pub use crate::faces::{Bounds, Face, Index};
pub use crate::outline::{Outline, outlines};
pub use crate::sight::cells_along;
