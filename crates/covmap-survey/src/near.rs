//! The primitives that explain an echo.

use super::Survey;
use super::line::Line;
use covmap_world::WorldError;
use covmap_world::geometry::{Bounds, Face, Index, Outline};
use nalgebra::{Point2, Vector2};

/// A possible source of an echo.
enum Source {
    /// A front, its length and the thickness behind it.
    Front(Line, f64, f64),
    /// A filled outline.
    Solid(Outline),
}

/// A spatial index of the primitives of a survey.
pub(super) struct Near {
    sources: Vec<Source>,
    index: Index,
}

impl Near {
    /// # Errors
    /// If a primitive has an impossible number.
    pub(super) fn new(survey: &Survey) -> Result<Self, WorldError> {
        // This checks all numbers, and gives the outlines of the primitives without a front.
        let mut solids = survey.outlines()?.split_off(survey.walls.len());
        solids.truncate(survey.posts.len() + survey.solids.len());
        let front = |wall: &super::WallSegment| {
            let (line, length) = wall.front()?;
            Some(Source::Front(line, length, wall.thickness))
        };
        let fronts = survey.walls.iter().filter_map(front);
        let sources: Vec<Source> = fronts.chain(solids.into_iter().map(Source::Solid)).collect();
        let boxes: Vec<Bounds> = sources.iter().map(Source::bounds).collect();
        let origin = boxes.first().map_or(Point2::origin(), |(low, _)| *low);
        Ok(Self { sources, index: Index::new(origin, &boxes) })
    }

    /// Returns whether a primitive lies within a distance of a point.
    pub(super) fn explains(&self, point: Point2<f64>, distance: f64) -> bool {
        self.around(point, distance).any(|source| source.is_near(point, distance))
    }

    /// Returns the front nearest to a point within a distance, with its length and the thickness
    /// behind it.
    pub(super) fn front(&self, point: Point2<f64>, distance: f64) -> Option<(Line, f64, f64)> {
        let mut best = None;
        let mut smallest = f64::INFINITY;
        for source in self.around(point, distance).filter(|s| s.is_near(point, distance)) {
            if let Source::Front(line, length, thickness) = source
                && line.height(point).abs() < smallest
            {
                smallest = line.height(point).abs();
                best = Some((*line, *length, *thickness));
            }
        }
        best
    }

    fn around(&self, point: Point2<f64>, distance: f64) -> impl Iterator<Item = &Source> {
        let reach = Vector2::repeat(distance);
        let mut near: Vec<usize> = self.index.meeting((point - reach, point + reach)).collect();
        near.sort_unstable();
        near.into_iter().map(|i| &self.sources[i])
    }
}

impl Source {
    fn bounds(&self) -> Bounds {
        match self {
            Self::Front(line, length, _) => {
                let (from, to) = (line.at, line.point(*length));
                (from.inf(&to), from.sup(&to))
            }
            Self::Solid(outline) => outline.bounds(),
        }
    }

    fn is_near(&self, point: Point2<f64>, distance: f64) -> bool {
        match self {
            Self::Front(line, length, _) => {
                line.height(point).abs() <= distance
                    && (-distance..=length + distance).contains(&line.place(point))
            }
            Self::Solid(outline) => {
                let next = outline.points.iter().cycle().skip(1);
                let mut inside = false;
                for (&a, &b) in outline.points.iter().zip(next) {
                    let face = Face::new(a, b, outline.surface);
                    if (face.nearest(point) - point).norm() <= distance {
                        return true;
                    }
                    let crosses = (a.y <= point.y) != (b.y <= point.y);
                    inside ^= crosses && ((b - a).perp(&(point - a)) > 0.0) == (b.y > a.y);
                }
                inside
            }
        }
    }
}
