//! The last steps: corners are closed, and no wall is thicker than the views behind it allow.

use super::SurveyParameters;
use super::line::Line;
use super::view::View;
use super::wall::{Wall, passed, pieces};
use rayon::prelude::*;

/// The number of steps in the search for the thickness.
const STEPS: u32 = 5;
/// The least thickness of a wall [m].
const THINNEST: f64 = 0.02;
/// Walls meet in a corner if they turn by more than this (the sine).
const TURN: f64 = 0.3;
/// A beam that went through behind a wall ended at least this far beyond [m].
const CLEAR: f64 = 0.05;
/// Walls face opposite directions from this cosine on.
const OPPOSITE: f64 = -0.9;
/// If beams went through behind this share of a wall's pieces, the wall is thinner.
const SHARE: f64 = 0.1;

/// Moves the ends of walls that nearly meet to the point where the walls meet.
pub(super) fn close_corners(walls: &mut [Wall], parameters: &SurveyParameters) {
    let snapshot = walls.to_vec();
    for (i, wall) in walls.iter_mut().enumerate() {
        let mut best = [(parameters.corner, None), (parameters.corner, None)];
        for (j, other) in snapshot.iter().enumerate() {
            let sine = wall.line.along.perp(&other.line.along);
            if i == j || sine.abs() < TURN {
                continue;
            }
            let place = (other.line.at - wall.line.at).perp(&other.line.along) / sine;
            let meeting = wall.line.point(place);
            let near = |end: nalgebra::Point2<f64>| (end - meeting).norm();
            let theirs = near(other.ends.0).min(near(other.ends.1));
            let own = [snapshot[i].ends.0, snapshot[i].ends.1].map(near);
            for (end, best) in own.iter().zip(&mut best) {
                if theirs <= parameters.corner && *end < best.0 {
                    *best = (*end, Some(meeting));
                }
            }
        }
        let (from, to) = (best[0].1.unwrap_or(wall.ends.0), best[1].1.unwrap_or(wall.ends.1));
        if wall.line.place(to) - wall.line.place(from) > THINNEST {
            wall.ends = (from, to);
        }
    }
}

/// Returns the depth of the solid behind each wall.
///
/// The depth is the assumed one, or less where the wall's other side or the free space behind it
/// requires.
pub(super) fn thicknesses(
    views: &[View],
    walls: &[Wall],
    parameters: &SurveyParameters,
) -> Vec<f64> {
    let thickness = |wall: &Wall| {
        let other = walls.iter().filter_map(|other| depth_of(wall, other));
        let nearest = other.fold(parameters.thickness, f64::min);
        free_depth(views, wall, nearest).max(THINNEST)
    };
    walls.par_iter().map(thickness).collect()
}

/// Returns the depth behind a wall of another wall that is seen from the other side.
fn depth_of(wall: &Wall, other: &Wall) -> Option<f64> {
    let (from, to) = wall.line.span([wall.ends.0, wall.ends.1]);
    let (low, high) = wall.line.span([other.ends.0, other.ends.1]);
    let opposite = wall.line.along.dot(&other.line.along) < OPPOSITE;
    let (low, high) = (low.max(from), high.min(to));
    if !opposite || high - low < 0.5 * other.length().min(wall.length()) {
        return None;
    }
    let depth = -wall.line.height(
        other.line.at + other.line.along * other.line.place(wall.line.point(0.5 * (low + high))),
    );
    (depth > 0.0).then_some(depth)
}

/// Returns the depth behind a wall up to which no beams went through.
fn free_depth(views: &[View], wall: &Wall, thickness: f64) -> f64 {
    let (from, to) = wall.line.span([wall.ends.0, wall.ends.1]);
    // The ends may be slightly off.
    let (start, length) = (from + CLEAR, to - from - 2.0 * CLEAR);
    if length <= 0.0 {
        return thickness;
    }
    let mut free = thickness;
    for step in (1..=STEPS).rev() {
        let depth = thickness * f64::from(step) / f64::from(STEPS);
        let line = Line { at: wall.line.at + wall.line.back() * depth, along: wall.line.along };
        let passed = passed(views, &line, start, pieces(length), CLEAR);
        let open = passed.iter().filter(|&&count| count >= 2).count();
        let share = open as f64 / passed.len() as f64;
        if share < SHARE {
            break;
        }
        free = thickness * (f64::from(step) - 1.0) / f64::from(STEPS);
    }
    free
}
