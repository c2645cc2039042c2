//! Errors of worlds.

use covmap::short;

/// The longest side of a world \[m\].
pub const MAX_EXTENT: f64 = 1e4;
/// The largest heading of a start, either way \[rad\].
pub(crate) const MAX_HEADING: f64 = 1e6;
/// The shortest length of anything in a world \[m\].
pub const MIN_LENGTH: f64 = 1e-4;
/// The largest number of obstacles.
pub const MAX_OBSTACLES: usize = 100_000;
/// The largest number of points of one polygon.
pub(crate) const MAX_POLYGON_POINTS: usize = 10_000;
/// The largest number of points of all outlines; a circle has 64.
pub(crate) const MAX_POINTS: usize = 1_000_000;
/// The largest number of pairs of a face and an outline that may bury it.
pub(crate) const MAX_BURIALS: usize = 10_000_000;
/// The largest number of pairs of neighbouring faces that are searched for corners.
pub(crate) const MAX_PAIRS: usize = 20_000_000;

/// Why a world cannot be made.
///
/// Obstacles are counted from 0, in the order of the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// The name cannot name a file.
    #[error("the name {0:?} must have 1 to 100 characters, none of them a slash or a control")]
    Name(String),
    /// The extent has an impossible size.
    #[error(
        "the extent of {} × {} m must lie between {MIN_LENGTH} and {MAX_EXTENT} m a side",
        short(.0),
        short(.1)
    )]
    Extent(f64, f64),
    /// There are too many obstacles.
    #[error("{0} obstacles are more than {MAX_OBSTACLES}; merge some")]
    TooManyObstacles(usize),
    /// The outlines have too many points in all.
    #[error("the outlines have {0} points in all, more than {MAX_POINTS}; simplify them")]
    TooManyPoints(usize),
    /// The obstacles lie too densely on top of each other.
    #[error("too many obstacles lie on top of each other; merge those that overlap")]
    TooDense,
    /// An obstacle has a number that is not finite or lies absurdly far out.
    #[error(
        "obstacle {obstacle} ({kind}): {} must be a finite number within ±{limit}",
        short(value),
        limit = 2.0 * MAX_EXTENT
    )]
    Number {
        /// The obstacle.
        obstacle: usize,
        /// The obstacle's shape.
        kind: &'static str,
        /// The number.
        value: f64,
    },
    /// An obstacle has a length that is not positive, or too small.
    #[error(
        "obstacle {obstacle} ({kind}): its {what} of {} m must be at least {MIN_LENGTH} m",
        short(value)
    )]
    Length {
        /// The obstacle.
        obstacle: usize,
        /// The obstacle's shape.
        kind: &'static str,
        /// The name of the length.
        what: &'static str,
        /// The length \[m\].
        value: f64,
    },
    /// A polygon has too few points that differ.
    #[error("obstacle {obstacle} (Polygon): {points} different points; a polygon needs at least 3")]
    TooFewPoints {
        /// The obstacle.
        obstacle: usize,
        /// The number of points that differ from the point before.
        points: usize,
    },
    /// A polygon has too many points.
    #[error(
        "obstacle {obstacle} (Polygon): {points} points are more than {MAX_POLYGON_POINTS}; simplify it"
    )]
    TooManyPolygonPoints {
        /// The obstacle.
        obstacle: usize,
        /// The number of points.
        points: usize,
    },
    /// A polygon crosses or touches itself.
    #[error(
        "obstacle {obstacle} (Polygon): the sides from points {first} and {second} cross or touch near ({x:.3}, {y:.3}); split it into simple polygons"
    )]
    SelfCrossing {
        /// The obstacle.
        obstacle: usize,
        /// The point, counted from 0, at which one side starts.
        first: usize,
        /// The point at which the other side starts.
        second: usize,
        /// Approximate x of the contact \[m\].
        x: f64,
        /// Approximate y of the contact \[m\].
        y: f64,
    },
    /// A polygon encloses nothing.
    #[error("obstacle {obstacle} (Polygon): its points lie on a line and enclose no area")]
    Flat {
        /// The obstacle.
        obstacle: usize,
    },
    /// A polygon encloses next to nothing.
    #[error("obstacle {obstacle} (Polygon): its area of {} m² is too small", short(area))]
    TooSmall {
        /// The obstacle.
        obstacle: usize,
        /// The polygon's area \[m²\].
        area: f64,
    },
    /// The start is not inside the extent.
    #[error("the start ({}, {}) must lie inside the extent", short(.0), short(.1))]
    StartOutside(f64, f64),
    /// The start's heading is not an angle.
    #[error("the start's heading of {} rad must lie within ±{MAX_HEADING} rad", short(.0))]
    StartHeading(f64),
    /// The start lies inside an obstacle.
    #[error("the start ({}, {}) lies inside an obstacle; move it to a free place", short(.0), short(.1))]
    StartInObstacle(f64, f64),
}
