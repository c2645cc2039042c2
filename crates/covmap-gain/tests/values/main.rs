//! Values worked out by hand, or by a few lines of Python, with their derivation: the fast and the
//! literal formulas share code, and would be wrong alike.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

mod corridor;
mod gains;
mod likelihoods;

#[track_caller]
fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} is not {expected}");
}

#[track_caller]
fn all_close(actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len(), "{actual:?}");
    actual.iter().zip(expected).for_each(|(a, e)| close(*a, *e, tolerance));
}
