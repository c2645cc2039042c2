//! The fast evaluation of E\[I\] for the update by the product, Eq. (9).

pub(crate) mod bound;
pub(crate) mod sweep;
mod tables;
