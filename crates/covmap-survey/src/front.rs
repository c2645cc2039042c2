//! Fronts: segments of many scans that lie on one line.

use super::line::{Line, Moments};
use super::split::Segment;
use super::view::View;
use super::{SurveyError, SurveyParameters};
use nalgebra::Point2;
use std::collections::BTreeMap;
use std::ops::Range;

/// The largest number of fronts: far more than any building has.
pub(super) const MAX_FRONTS: usize = 20_000;
/// The side of the squares that index the fronts [m].
const SQUARE: f64 = 1.0;
/// The largest number of rounds in which fronts are merged with each other.
const ROUNDS: usize = 6;

/// Segments on one line, seen from its left.
#[derive(Debug, Clone)]
pub(super) struct Front {
    pub(super) moments: Moments,
    pub(super) line: Line,
    /// Start and end on the line.
    pub(super) ends: (Point2<f64>, Point2<f64>),
    /// The echoes: the index of a view, and the range of its echoes.
    pub(super) echoes: Vec<(usize, Range<usize>)>,
}

impl Front {
    fn new(number: usize, view: &View, segment: &Segment) -> Self {
        let Segment { moments, line, echoes } = segment.clone();
        let (from, to) = line.span(view[echoes.clone()].iter().map(|echo| echo.at));
        let ends = (line.point(from), line.point(to));
        Self { moments, line, ends, echoes: vec![(number, echoes)] }
    }

    fn length(&self) -> f64 {
        (self.ends.1 - self.ends.0).norm()
    }

    /// Returns the distance between two fronts, if they may be one wall.
    ///
    /// The distance is the largest of an end of the shorter from the line of the longer.
    fn distance(&self, other: &Self, parameters: &SurveyParameters) -> Option<f64> {
        if self.line.along.dot(&other.line.along) < libm::cos(parameters.merge_angle) {
            return None;
        }
        let (long, short) =
            if self.length() >= other.length() { (self, other) } else { (other, self) };
        let height = |p| long.line.height(p).abs();
        let distance = height(short.ends.0).max(height(short.ends.1));
        let (from, to) = long.line.span([long.ends.0, long.ends.1]);
        let (low, high) = long.line.span([short.ends.0, short.ends.1]);
        let gap = (low - to).max(from - high);
        (distance <= parameters.merge_distance && gap <= parameters.merge_gap).then_some(distance)
    }

    /// Takes over the echoes of another front.
    fn absorb(&mut self, other: Front) {
        self.moments = self.moments.with(&other.moments);
        if let Some(line) = self.moments.line() {
            let forward = line.along.dot(&self.line.along) >= 0.0;
            self.line = if forward { line } else { Line { along: -line.along, ..line } };
        }
        let (from, to) = self.line.span([self.ends.0, self.ends.1, other.ends.0, other.ends.1]);
        self.ends = (self.line.point(from), self.line.point(to));
        self.echoes.extend(other.echoes);
    }
}

/// Merges the segments of all views to fronts, in the order of the views; then merges the fronts
/// with each other.
pub(super) fn fronts(
    views: &[View],
    segments: &[Vec<Segment>],
    parameters: &SurveyParameters,
) -> Result<Vec<Front>, SurveyError> {
    let mut merged = Merged::default();
    for (number, (view, segments)) in views.iter().zip(segments).enumerate() {
        for segment in segments {
            merged.add(Front::new(number, view, segment), parameters)?;
        }
    }
    for _ in 0..ROUNDS {
        let before = merged.fronts.len();
        let mut fronts = merged.fronts;
        fronts.sort_by(|f, g| g.moments.count.total_cmp(&f.moments.count));
        merged = Merged::default();
        for front in fronts {
            merged.add(front, parameters)?;
        }
        if merged.fronts.len() == before {
            break;
        }
    }
    Ok(merged.fronts)
}

/// Fronts, and the squares that they cross.
#[derive(Default)]
struct Merged {
    fronts: Vec<Front>,
    squares: BTreeMap<(i64, i64), Vec<usize>>,
}

impl Merged {
    fn add(&mut self, front: Front, parameters: &SurveyParameters) -> Result<(), SurveyError> {
        let mut near: Vec<usize> = squares(front.ends, 1)
            .into_iter()
            .filter_map(|square| self.squares.get(&square))
            .flatten()
            .copied()
            .collect();
        near.sort_unstable();
        near.dedup();
        let mut best: Option<(usize, f64)> = None;
        for number in near {
            if let Some(distance) = self.fronts[number].distance(&front, parameters)
                && best.is_none_or(|(_, smallest)| distance < smallest)
            {
                best = Some((number, distance));
            }
        }
        let number = match best {
            Some((number, _)) => {
                self.fronts[number].absorb(front);
                number
            }
            None if self.fronts.len() == MAX_FRONTS => return Err(SurveyError::TooManyFronts),
            None => {
                self.fronts.push(front);
                self.fronts.len() - 1
            }
        };
        for square in squares(self.fronts[number].ends, 0) {
            let here = self.squares.entry(square).or_default();
            if !here.contains(&number) {
                here.push(number);
            }
        }
        Ok(())
    }
}

/// Returns the squares along a segment, and a margin of squares around them.
fn squares((from, to): (Point2<f64>, Point2<f64>), around: i64) -> Vec<(i64, i64)> {
    let steps = ((to - from).norm() / (0.5 * SQUARE)).ceil().clamp(1.0, 1e4);
    #[allow(clippy::cast_possible_truncation, reason = "clamped")]
    let count = steps as u32;
    let mut squares = Vec::new();
    for step in 0..=count {
        let point = from + (to - from) * (f64::from(step) / f64::from(count));
        #[allow(clippy::cast_possible_truncation, reason = "poses are within 1e5 m")]
        let (x, y) = ((point.x / SQUARE).floor() as i64, (point.y / SQUARE).floor() as i64);
        let rows = y - around..=y + around;
        squares.extend(rows.flat_map(|y| (x - around..=x + around).map(move |x| (y, x))));
    }
    squares.sort_unstable();
    squares.dedup();
    squares
}
