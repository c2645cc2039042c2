//! Posts: objects that many views see and that are not walls.

use super::SurveyParameters;
use super::near::Near;
use super::view::{Echo, View};
use super::{Post, rounded};
use nalgebra::{Point2, Vector2};
use std::collections::{BTreeMap, BTreeSet};

/// The side of the squares in which echoes are counted [m].
const SQUARE: f64 = 0.04;
/// The least radius of a post [m].
const THINNEST: f64 = 0.015;
/// A beam passes through a post if it ends this far behind the post [m].
const CLEAR: f64 = 0.1;
/// An object is free-standing if beams went by this near on both sides of it [m].
const BESIDE: f64 = 0.15;

type Square = (i64, i64);

/// Returns the posts among the echoes that no wall explains.
///
/// A post is a small group of squares. Each square is seen from enough views, at most the share
/// `max_passed` of the beams passes through the post, and beams pass on both sides. The last
/// condition tells a post from the far end of a wall, where the wall's echoes are sparse.
pub(super) fn posts(views: &[View], walls: &Near, parameters: &SurveyParameters) -> Vec<Post> {
    let mut squares: BTreeMap<Square, Vec<(usize, Point2<f64>)>> = BTreeMap::new();
    for (number, view) in views.iter().enumerate() {
        for Echo { at, .. } in view {
            if !walls.explains(*at, parameters.explained) {
                squares.entry(square_of(*at)).or_default().push((number, *at));
            }
        }
    }
    squares.retain(|_, echoes| views_of(echoes) >= parameters.min_views);
    let mut left: BTreeSet<Square> = squares.keys().copied().collect();
    let mut found = Vec::new();
    while let Some(first) = left.pop_first() {
        let mut group = vec![first];
        let mut next = 0;
        while next < group.len() {
            let (y, x) = group[next];
            next += 1;
            for near in (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (y, x))) {
                if left.remove(&near) {
                    group.push(near);
                }
            }
        }
        let echoes: Vec<(usize, Point2<f64>)> =
            group.iter().flat_map(|square| squares[square].iter().copied()).collect();
        found.extend(post(&echoes, views, parameters));
    }
    found
}

#[allow(clippy::cast_possible_truncation, reason = "poses are within 1e5 m")]
fn square_of(at: Point2<f64>) -> Square {
    ((at.y / SQUARE).floor() as i64, (at.x / SQUARE).floor() as i64)
}

fn views_of(echoes: &[(usize, Point2<f64>)]) -> usize {
    let mut views: Vec<usize> = echoes.iter().map(|(view, _)| *view).collect();
    views.sort_unstable();
    views.dedup();
    views.len()
}

/// Returns a post around the mean of its echoes, with their scatter as its radius.
fn post(
    echoes: &[(usize, Point2<f64>)],
    views: &[View],
    parameters: &SurveyParameters,
) -> Option<Post> {
    let count = echoes.len() as f64;
    let mean = echoes.iter().map(|(_, at)| at.coords).sum::<Vector2<f64>>() / count;
    let center = Point2::from(mean);
    let farthest = echoes.iter().map(|(_, at)| (at - center).norm()).fold(0.0, f64::max);
    let scatter = echoes.iter().map(|(_, at)| (at - center).norm_squared()).sum::<f64>() / count;
    let radius = scatter.sqrt().max(THINNEST);
    if farthest > parameters.max_post_radius {
        return None;
    }
    let (mut passed, mut left, mut right) = (0, 0, 0);
    for echo in views.iter().flatten() {
        let (sight, to_center) = (echo.at - echo.eye, center - echo.eye);
        let range = sight.norm();
        // The distance by which the beam passed to the left of the centre.
        let aside = -sight.perp(&to_center) / range;
        let beyond = sight.dot(&to_center) > 0.0 && range > to_center.norm() + radius + CLEAR;
        match aside {
            _ if !beyond => {}
            a if a.abs() <= 0.5 * radius => passed += 1,
            a if a > radius && a < radius + BESIDE => left += 1,
            a if a < -radius && a > -radius - BESIDE => right += 1,
            _ => {}
        }
    }
    if left.min(right) < parameters.min_views {
        return None;
    }
    let passed = passed as f64;
    let stands = passed <= parameters.max_passed * (count + passed);
    stands.then(|| Post { center: rounded(center), radius: rounded(Point2::new(radius, 0.0)).0 })
}
