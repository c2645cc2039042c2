//! Faces, outlines, solids and their index, for crates that estimate a world from measurements.

pub use crate::coverage::Solids;
pub use crate::faces::{Bounds, Face, Index};
pub use crate::outline::{Outline, outlines};
pub use crate::sight::cells_along;
