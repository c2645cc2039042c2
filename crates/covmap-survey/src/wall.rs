//! Walls: the stretches of a front that are truly solid.

use super::SurveyParameters;
use super::front::Front;
use super::line::{Line, Moments};
use super::view::{Echo, View};
use nalgebra::Point2;
use rayon::prelude::*;

/// The length of the pieces in which a front is judged [m].
const PIECE: f64 = 0.05;
/// A beam went through if it started this far in front and ended this far behind, or vice versa
/// [m].
const CLEAR: f64 = 0.1;
/// A piece without enough echoes is open if this many beams went through.
const OPEN: u32 = 2;
/// The smallest number of echoes of a piece of wall.
const HITS: u32 = 2;
/// Fronts of one direction are the same if they are nearer than this many merge distances [1].
const HIDDEN: f64 = 2.0;
/// The number of a wall's echoes that are checked for beams through another wall.
const SAMPLE: usize = 200;
/// Echoes farther than this many residuals from the line are left out of it [1].
const OUTLIER: f64 = 2.5;

/// A wall, and the support for it.
#[derive(Debug, Clone)]
pub(super) struct Wall {
    /// The line, seen from its left.
    pub(super) line: Line,
    pub(super) ends: (Point2<f64>, Point2<f64>),
    pub(super) views: usize,
    pub(super) echoes: usize,
    pub(super) residual: f64,
}

impl Wall {
    pub(super) fn length(&self) -> f64 {
        (self.ends.1 - self.ends.0).norm()
    }

    /// Returns whether a beam went through the wall, from its front to well behind it.
    fn is_crossed_by(&self, echo: &Echo) -> bool {
        let (before, behind) = (self.line.height(echo.eye), self.line.height(echo.at));
        if before < CLEAR || behind > -CLEAR {
            return false;
        }
        let at = echo.eye + (echo.at - echo.eye) * (before / (before - behind));
        let (from, to) = self.line.span([self.ends.0, self.ends.1]);
        (from + PIECE..=to - PIECE).contains(&self.line.place(at))
    }

    /// Returns whether a point seen from the same side belongs to this wall, or is hidden by it.
    fn hides(&self, line: &Line, point: Point2<f64>, parameters: &SurveyParameters) -> bool {
        let (from, to) = self.line.span([self.ends.0, self.ends.1]);
        line.along.dot(&self.line.along) > libm::cos(2.0 * parameters.merge_angle)
            && self.line.height(point).abs() <= HIDDEN * parameters.merge_distance
            && (from..=to).contains(&self.line.place(point))
    }
}

/// Counts the beams that went through each of `count` pieces of a line, from `start` on.
///
/// The work is one pass over all echoes, with a few products for each.
pub(super) fn passed(
    views: &[View],
    line: &Line,
    start: f64,
    count: usize,
    clear: f64,
) -> Vec<u32> {
    let mut passed = vec![0; count];
    for Echo { eye, at, .. } in views.iter().flatten() {
        let (before, behind) = (line.height(*eye), line.height(*at));
        if before * behind < 0.0 && before.abs() >= CLEAR && behind.abs() >= clear {
            let share = before / (before - behind);
            let place = line.place(eye + (at - eye) * share);
            if let Some(piece) = piece_at(place - start, count) {
                passed[piece] += 1;
            }
        }
    }
    passed
}

fn piece_at(place: f64, count: usize) -> Option<usize> {
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    let piece = (place / PIECE).floor().max(0.0) as usize;
    (place >= 0.0 && piece < count).then_some(piece)
}

/// Returns the number of pieces of a length.
pub(super) fn pieces(length: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, reason = "clamped")]
    let count = (length / PIECE).ceil().clamp(1.0, 1e6) as usize;
    count
}

/// The evidence for and against the pieces of a front.
struct Profile {
    start: f64,
    /// The place of each echo, with the indices of its view and its echo.
    echoes: Vec<(f64, usize, usize)>,
    hits: Vec<u32>,
    passed: Vec<u32>,
}

impl Profile {
    fn new(front: &Front, views: &[View]) -> Self {
        let line = &front.line;
        let (start, end) = line.span([front.ends.0, front.ends.1]);
        let count = pieces(end - start);
        let members = front.echoes.iter().flat_map(|(view, echoes)| {
            echoes.clone().map(|i| (line.place(views[*view][i].at), *view, i))
        });
        let echoes: Vec<(f64, usize, usize)> = members.collect();
        let mut hits = vec![0; count];
        for (place, ..) in &echoes {
            hits[piece_at((place - start).max(0.0), count).unwrap_or(count - 1)] += 1;
        }
        let passed = passed(views, line, start, count, CLEAR);
        Self { start, echoes, hits, passed }
    }

    fn middle(&self, piece: usize) -> f64 {
        self.start + (piece as f64 + 0.5) * PIECE
    }

    /// Returns the stretches that are wall, by their first and last piece.
    fn stretches(
        &self,
        is_taken: impl Fn(f64) -> bool,
        parameters: &SurveyParameters,
    ) -> Vec<(usize, usize)> {
        let mut stretches: Vec<(usize, usize)> = Vec::new();
        let mut open = true;
        for piece in 0..self.hits.len() {
            let (hits, passed) = (self.hits[piece], self.passed[piece]);
            let goes_through = f64::from(passed) > parameters.max_passed * f64::from(hits + passed);
            if is_taken(self.middle(piece)) || (passed >= OPEN && goes_through) {
                open = true;
            } else if hits >= HITS {
                let gap = |last: usize| (piece - last - 1) as f64 * PIECE;
                match stretches.last_mut() {
                    Some((_, last)) if !open && gap(*last) <= parameters.merge_gap => *last = piece,
                    _ => stretches.push((piece, piece)),
                }
                open = false;
            }
        }
        stretches
    }

    /// Returns the wall over a stretch of pieces, with its line drawn anew through its own echoes.
    ///
    /// There is no wall if most of the echoes came through other walls.
    fn wall(
        &self,
        (first, last): (usize, usize),
        front: &Front,
        views: &[View],
        others: &[Wall],
        parameters: &SurveyParameters,
    ) -> Option<Wall> {
        let (low, high) = (self.middle(first) - 0.5 * PIECE, self.middle(last) + 0.5 * PIECE);
        let inside = self.echoes.iter().filter(|(place, ..)| (low..=high).contains(place));
        let echoes: Vec<(usize, &Echo)> =
            inside.map(|&(_, view, i)| (view, &views[view][i])).collect();
        let rough = Moments::of(echoes.iter().map(|(_, echo)| echo.at));
        let line = rough.line()?;
        let limit = OUTLIER * rough.residual();
        let fine = Moments::of(
            echoes.iter().map(|(_, echo)| echo.at).filter(|at| line.height(*at).abs() <= limit),
        );
        let fine = if fine.line().is_some() { fine } else { rough };
        let mut line = fine.line()?;
        if line.along.dot(&front.line.along) < 0.0 {
            line.along = -line.along;
        }
        let (from, to) = line.span(echoes.iter().map(|(_, echo)| echo.at));
        let mut seen: Vec<usize> = echoes.iter().map(|(view, _)| *view).collect();
        seen.dedup();
        seen.sort_unstable();
        seen.dedup();
        let wall = Wall {
            line,
            ends: (line.point(from), line.point(to)),
            views: seen.len(),
            echoes: echoes.len(),
            residual: fine.residual(),
        };
        let enough = wall.views >= parameters.min_views
            && wall.echoes >= parameters.min_views.saturating_mul(parameters.min_echoes)
            && wall.length() >= parameters.min_length;
        let sample = || echoes.iter().step_by(echoes.len().div_ceil(SAMPLE).max(1));
        let through = |(_, echo): &&(usize, &Echo)| others.iter().any(|o| o.is_crossed_by(echo));
        let hidden = sample().filter(through).count();
        (enough && 2 * hidden <= sample().count()).then_some(wall)
    }
}

/// Returns the walls of all fronts. Fronts with the most echoes come first; parts that they hide
/// are dropped.
pub(super) fn walls(
    views: &[View],
    mut fronts: Vec<Front>,
    parameters: &SurveyParameters,
) -> Vec<Wall> {
    let least = parameters.min_views as f64;
    fronts.retain(|front| front.moments.count >= least);
    fronts.sort_by(|f, g| g.moments.count.total_cmp(&f.moments.count));
    let profiles: Vec<Profile> = fronts.par_iter().map(|f| Profile::new(f, views)).collect();
    let mut walls: Vec<Wall> = Vec::new();
    for (front, profile) in fronts.iter().zip(&profiles) {
        let is_taken = |place: f64| {
            let point = front.line.point(place);
            walls.iter().any(|wall| wall.hides(&front.line, point, parameters))
        };
        let stretches = profile.stretches(is_taken, parameters);
        let wall = |stretch| profile.wall(stretch, front, views, &walls, parameters);
        let found: Vec<Wall> = stretches.into_iter().filter_map(wall).collect();
        walls.extend(found);
    }
    walls
}
