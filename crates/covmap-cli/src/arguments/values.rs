//! The values of arguments: numbers with their bounds, and poses.

use nalgebra::{Isometry2, Point2, Vector2};
use std::path::PathBuf;

fn number(text: &str, min: f64, max: f64, unit: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| "not a number".to_owned())?;
    let good = (min..=max).contains(&value);
    good.then_some(value).ok_or_else(|| format!("it must lie in [{min}, {max}]{unit}"))
}

pub(super) fn resolution(text: &str) -> Result<f64, String> {
    number(text, 1e-3, 10.0, " m")
}

pub(super) fn while_driving(text: &str) -> Result<f64, String> {
    number(text, 0.01, 1e6, " m")
}

pub(super) fn every(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e3, " m")
}

pub(super) fn every_degrees(text: &str) -> Result<f64, String> {
    number(text, 0.0, 360.0, " degrees")
}

pub(super) fn range(text: &str) -> Result<f64, String> {
    number(text, 1e-3, 100.0, " m")
}

pub(super) fn gib(text: &str) -> Result<f64, String> {
    number(text, 0.01, 1e6, " GiB")
}

pub(super) fn entropy(text: &str) -> Result<f64, String> {
    number(text, 0.0, 5.0, " nats")
}

pub(super) fn coverage(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1.0, "")
}

pub(super) fn start(text: &str) -> Result<Isometry2<f64>, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, degrees]) if [x, y, degrees].iter().all(|v| v.is_finite() && v.abs() < 1e7) => {
            Ok(Isometry2::new(Vector2::new(x, y), degrees.to_radians()))
        }
        _ => Err("three finite numbers are needed, as in 1.5,6,90".to_owned()),
    }
}

pub(super) fn place(text: &str) -> Result<Point2<f64>, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y]) if [x, y].iter().all(|v| v.is_finite() && v.abs() < 1e7) => {
            Ok(Point2::new(x, y))
        }
        _ => Err("two finite numbers are needed, as in 1.5,6".to_owned()),
    }
}

/// Parses a name and its file, NAME=FILE.
///
/// # Errors
/// If there is no name.
pub fn named_file(text: &str) -> Result<(String, PathBuf), String> {
    let (name, file) = text.split_once('=').ok_or("expected NAME=FILE")?;
    Ok((name.to_owned(), file.into()))
}
