//! The survey of a building: its walls, from posed laser scans.
//!
//! A survey is the truth about a place that only a robot has seen. [`survey`] finds the fronts of
//! walls, and posts, in the scans of a laser (a ring of beams without width). The result, a
//! [`Survey`], is a list of primitives that a user can look at and correct by hand.
//! [`Survey::coverage`] gives its exact coverage; [`Survey::seen`] says where that coverage is
//! known.
//!
//! # Algorithm
//! 1. Scans between which the robot moved are views (`view`).
//! 2. The echoes of each view are split into straight segments, and merged (`split`).
//! 3. Segments of all views that lie on one line, and are seen from the same side, are merged to
//!    fronts. Lines are drawn by total least squares; merging is exact, because the moments of the
//!    echoes are kept (`front`).
//! 4. A front is wall where it has echoes and few beams went through; gaps stay open. Of two fronts
//!    that would hide each other, the one with more echoes stays (`wall`).
//! 5. Corners are closed, and walls are no thicker than the views behind them allow (`finish`).
//! 6. Small groups of echoes that no wall explains, seen from many views, are posts (`post`).
//!
//! The algorithm works in the order of scans and beams: equal scans give an equal survey.

mod evidence;
mod finish;
mod front;
mod line;
mod near;
mod parameters;
mod post;
mod solid;
mod split;
mod view;
mod wall;

pub use evidence::EchoEvidence;
pub use parameters::SurveyParameters;

use covmap_sonar::{Scan, SonarRing};
use covmap_world::Shape;
use covmap_world::WorldError;
use nalgebra::Point2;
use near::Near;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use wall::Wall;

/// The solids of a building, as a laser saw them or as corrected by hand.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Survey {
    /// Straight walls.
    pub walls: Vec<WallSegment>,
    /// Small round objects.
    pub posts: Vec<Post>,
    /// Other solids. The laser finds none of these; they are for corrections.
    pub solids: Vec<Shape>,
}

/// A straight wall, known by its front.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallSegment {
    /// One end of the front \[m\].
    pub from: (f64, f64),
    /// The other end of the front \[m\].
    pub to: (f64, f64),
    /// The side from which the front was seen, looking from `from` to `to`.
    pub seen_from: Side,
    /// Depth of the solid behind the front \[m\]: assumed, unless the laser saw something behind
    /// it.
    pub thickness: f64,
}

/// A side of a directed line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// The left.
    Left,
    /// The right.
    Right,
}

/// A small round object: a post, or the leg of a chair.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Post {
    /// Centre \[m\].
    pub center: (f64, f64),
    /// Radius \[m\].
    pub radius: f64,
}

/// The support for a wall of a survey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// The number of views from which the wall was seen.
    pub views: usize,
    /// The number of the wall's echoes.
    pub echoes: usize,
    /// Root mean square of the echoes' distances from the front \[m\].
    pub residual: f64,
}

/// A survey, and the support for its walls.
#[derive(Debug, Clone, PartialEq)]
pub struct Surveyed {
    /// The survey.
    pub survey: Survey,
    /// The support of each wall.
    pub support: Vec<Support>,
    /// The number of scans used.
    pub views: usize,
}

/// Why a survey cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// A parameter has an impossible value.
    #[error("the survey's {0} {1} must be a number up to 1000, not negative, and not too small")]
    Parameter(&'static str, f64),
    /// There are too many echoes.
    #[error("more than {} echoes; raise min_move and min_turn", view::MAX_ECHOES)]
    TooManyEchoes,
    /// There are too many surfaces.
    #[error(
        "more than {} surfaces that do not fit together; are the poses right?",
        front::MAX_FRONTS
    )]
    TooManyFronts,
    /// The surveyed solids do not make a world.
    #[error(transparent)]
    World(#[from] WorldError),
}

/// Finds the walls and posts that the posed scans of a laser show.
///
/// Each scan comes with its ring, whose beams are in order of their direction. Scans whose pose is
/// not finite are passed over. Without echoes the survey is empty. The work is linear in the echoes
/// for each surface; the number of surfaces is bounded.
///
/// # Errors
/// If a parameter is impossible, or there are too many echoes or surfaces.
pub fn survey<'a>(
    scans: impl IntoIterator<Item = (&'a SonarRing, &'a Scan)>,
    parameters: &SurveyParameters,
) -> Result<Surveyed, SurveyError> {
    parameters.check()?;
    let views = view::views(scans, parameters)?;
    let segments: Vec<_> = views.par_iter().map(|v| split::segments(v, parameters)).collect();
    let fronts = front::fronts(&views, &segments, parameters)?;
    let mut walls = wall::walls(&views, fronts, parameters);
    finish::close_corners(&mut walls, parameters);
    let thicknesses = finish::thicknesses(&views, &walls, parameters);
    let mut survey = Survey::default();
    survey.walls =
        walls.iter().zip(thicknesses).map(|(wall, t)| WallSegment::new(wall, t)).collect();
    survey.posts = post::posts(&views, &Near::new(&survey)?, parameters);
    let support = |wall: &Wall| {
        let Wall { views, echoes, residual, .. } = *wall;
        Support { views, echoes, residual }
    };
    Ok(Surveyed { support: walls.iter().map(support).collect(), survey, views: views.len() })
}

/// Rounds a point to a tenth of a millimetre, which keeps files readable.
fn rounded(point: Point2<f64>) -> (f64, f64) {
    // The sum turns −0 into 0.
    let round = |v: f64| (v * 1e4).round() / 1e4 + 0.0;
    (round(point.x), round(point.y))
}

impl WallSegment {
    fn new(wall: &Wall, thickness: f64) -> Self {
        let (from, to) = (rounded(wall.ends.0), rounded(wall.ends.1));
        let thickness = (thickness * 1e4).round() / 1e4;
        Self { from, to, seen_from: Side::Left, thickness }
    }
}
