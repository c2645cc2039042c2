//! The natural logarithm of many numbers at once.

pub(crate) use covmap::lanes::{LANES, Lanes, ln};
