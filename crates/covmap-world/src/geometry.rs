//! Faces, where they meet, outlines and solids, and how to find them. For a world, and for who estimates
//! one from measurements.

mod exposed;
mod face;
mod feature;
mod index;

pub use crate::coverage::Solids;
pub use crate::outline::{Outline, outlines};
pub use crate::sight::cells_along;
pub(crate) use exposed::Exposed;
pub use face::Face;
pub(crate) use feature::{Feature, Kind, between, of_joint};
pub use index::{Bounds, Index};
