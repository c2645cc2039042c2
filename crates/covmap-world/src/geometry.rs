//! Faces, where they meet, and how to find them.

mod exposed;
mod face;
pub(crate) mod feature;
mod index;

pub(crate) use exposed::Exposed;
pub(crate) use face::Face;
pub(crate) use feature::{Feature, Kind};
pub(crate) use index::{Bounds, Index};
