//! The rules of the planner, one by one, in a corridor that is one cell wide, with values worked out
//! by hand and their derivation.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

mod certificates;
mod corridor;
mod counting;
mod decisions;
mod outside;
mod passages;
mod stalls;
mod travel;
mod windows;

#[track_caller]
fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} is not {expected}");
}

#[track_caller]
fn all_close(actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len(), "{actual:?}");
    actual.iter().zip(expected).for_each(|(a, e)| close(*a, *e, tolerance));
}
