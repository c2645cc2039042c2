//! Segments in one scan: split and merge.

use super::SurveyParameters;
use super::line::{Line, Moments};
use super::view::{Echo, View};
use nalgebra::Point2;
use std::ops::Range;

/// The largest number of beams in a row without an echo on one surface.
const MISSING: usize = 3;

/// A straight piece of surface in one scan.
#[derive(Debug, Clone)]
pub(super) struct Segment {
    pub(super) moments: Moments,
    /// The line, seen from its left.
    pub(super) line: Line,
    /// The echoes of the view that lie on it.
    pub(super) echoes: Range<usize>,
}

/// Returns the segments of a view, in the order of its beams.
///
/// Echoes in a row are a run if no two neighbours are farther apart than the beams explain. A run
/// is split at the echo farthest from the line between its ends until all echoes are near.
/// Neighbours are merged again if all their echoes are near their common line by total least
/// squares.
pub(super) fn segments(view: &View, parameters: &SurveyParameters) -> Vec<Segment> {
    let mut found = Vec::new();
    let mut start = 0;
    for end in 1..=view.len() {
        if end == view.len() || breaks(&view[end - 1], &view[end], parameters) {
            let pieces = split(view, start..end, parameters.split_distance);
            let pieces = merge(view, pieces, parameters.split_distance);
            found.extend(pieces.into_iter().filter_map(|piece| segment(view, piece, parameters)));
            start = end;
        }
    }
    found
}

/// Returns whether two neighbouring echoes lie on different surfaces.
///
/// The distance of two echoes on one surface that the beams meet at the angle λ is
///
/// ```text
/// r · sin Δ / sin(λ − Δ)
/// ```
///
/// with r the nearer range and Δ the angle between the beams.
fn breaks(before: &Echo, after: &Echo, parameters: &SurveyParameters) -> bool {
    if after.beam - before.beam > 1 + MISSING {
        return true;
    }
    let (a, b) = (before.at - before.eye, after.at - after.eye);
    let (near, product) = (a.norm().min(b.norm()), a.norm() * b.norm());
    let (sin, cos) = (a.perp(&b).abs() / product, a.dot(&b) / product);
    let (sin_grazing, cos_grazing) = libm::sincos(parameters.grazing);
    let slant = (sin_grazing * cos - cos_grazing * sin).max(0.2 * sin_grazing);
    (after.at - before.at).norm() > parameters.jump.max(near * sin / slant)
}

/// Returns the farthest of some echoes from a line.
fn farthest(view: &View, echoes: Range<usize>, line: &Line) -> (usize, f64) {
    echoes
        .map(|i| (i, line.height(view[i].at).abs()))
        .fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best })
}

fn split(view: &View, run: Range<usize>, distance: f64) -> Vec<Range<usize>> {
    let mut pieces = Vec::new();
    // The order from right to left yields pieces from left to right.
    let mut open = vec![run];
    while let Some(piece) = open.pop() {
        if piece.len() < 3 {
            pieces.push(piece);
            continue;
        }
        let (first, last) = (view[piece.start].at, view[piece.end - 1].at);
        let inner = piece.start + 1..piece.end - 1;
        let (at, height) = match Line::through(first, last) {
            Some(chord) => farthest(view, inner, &chord),
            None => (piece.start + piece.len() / 2, f64::INFINITY),
        };
        if height <= distance {
            pieces.push(piece);
        } else {
            open.push(at..piece.end);
            open.push(piece.start..at);
        }
    }
    pieces
}

/// Merges neighbours whose echoes are all near to one line.
fn merge(view: &View, pieces: Vec<Range<usize>>, distance: f64) -> Vec<Range<usize>> {
    let mut merged: Vec<Range<usize>> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let one = merged.last().map(|last| last.start..piece.end);
        match one.filter(|one| is_straight(view, one.clone(), distance)) {
            Some(one) => {
                merged.pop();
                merged.push(one);
            }
            None => merged.push(piece),
        }
    }
    merged
}

fn is_straight(view: &View, echoes: Range<usize>, distance: f64) -> bool {
    let line = moments(view, echoes.clone()).line();
    line.is_some_and(|line| farthest(view, echoes, &line).1 <= distance)
}

fn moments(view: &View, echoes: Range<usize>) -> Moments {
    Moments::of(view[echoes].iter().map(|echo| echo.at))
}

fn segment(view: &View, echoes: Range<usize>, parameters: &SurveyParameters) -> Option<Segment> {
    if echoes.len() < parameters.min_echoes.max(2) {
        return None;
    }
    let moments = moments(view, echoes.clone());
    let eye = view[echoes.start].eye;
    let line = moments.line()?.seen_from(eye);
    let (from, to) = line.span(view[echoes.clone()].iter().map(|echo| echo.at));
    let middle: Point2<f64> = line.point(0.5 * (from + to));
    let sight = middle - eye;
    let grazes = line.along.perp(&sight).abs() < libm::sin(parameters.grazing) * sight.norm();
    (to - from >= parameters.min_length && !grazes).then_some(Segment { moments, line, echoes })
}
