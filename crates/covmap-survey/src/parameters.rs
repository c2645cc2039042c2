//! The parameters of a survey.

use super::SurveyError;
use serde::{Deserialize, Serialize};

/// The parameters that tell walls from noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurveyParameters {
    /// A scan is used if the robot moved by this much since the last used scan \[m\] …
    pub min_move: f64,
    /// … or turned by this much \[rad\]. A robot that stands still gives no further view.
    pub min_turn: f64,
    /// Largest range of an echo that is used \[m\].
    pub max_range: f64,
    /// Largest distance between neighbouring echoes on one surface \[m\]. The distance may be
    /// larger if the spacing of the beams on a surface at `grazing` explains it.
    pub jump: f64,
    /// Smallest angle at which beams meet a surface \[rad\]. Flatter rows of echoes mix the near
    /// and the far object, and are not a surface.
    pub grazing: f64,
    /// Largest distance of a scan's echoes on one wall from the wall's line \[m\].
    pub split_distance: f64,
    /// The smallest number of echoes of a segment in a scan …
    pub min_echoes: usize,
    /// … and its least length \[m\].
    pub min_length: f64,
    /// Segments of one wall differ by at most this angle \[rad\] …
    pub merge_angle: f64,
    /// … this distance across \[m\]: the error of the poses …
    pub merge_distance: f64,
    /// … and this gap along it \[m\]. A wall is also closed over such a gap if no beam went
    /// through.
    pub merge_gap: f64,
    /// The smallest number of views from which a wall, or a post, must be seen.
    pub min_views: usize,
    /// A wall or post is rejected if more than this share of the beams that could meet it went
    /// through.
    pub max_passed: f64,
    /// An end of a wall this near to the point where two walls meet is moved there \[m\].
    pub corner: f64,
    /// Assumed depth of the solid behind a front \[m\].
    pub thickness: f64,
    /// The largest radius of a post \[m\].
    pub max_post_radius: f64,
    /// A wall or post explains an echo this near to it \[m\].
    pub explained: f64,
    /// A cell is not scored if more than this share of the beams that reached it ended in
    /// unexplained echoes.
    pub max_unexplained: f64,
    /// Free space that a beam without an echo shows, at most \[m\]; 0 if a surface may also fail to
    /// answer.
    pub free_without_echo: f64,
}

impl SurveyParameters {
    /// Returns the parameters for an indoor laser of 1 cm noise and 0.5° between beams, and for
    /// poses good to some centimetres.
    pub fn indoor() -> Self {
        Self {
            min_move: 0.05,
            min_turn: 0.05,
            max_range: 10.0,
            jump: 0.08,
            grazing: 0.12,
            split_distance: 0.03,
            min_echoes: 6,
            min_length: 0.15,
            merge_angle: 0.2,
            merge_distance: 0.05,
            merge_gap: 0.25,
            min_views: 4,
            max_passed: 0.5,
            corner: 0.12,
            thickness: 0.15,
            max_post_radius: 0.2,
            explained: 0.05,
            max_unexplained: 0.1,
            free_without_echo: 0.0,
        }
    }

    pub(super) fn check(&self) -> Result<(), SurveyError> {
        let positive = [
            ("max_range", self.max_range),
            ("jump", self.jump),
            ("grazing", self.grazing),
            ("split_distance", self.split_distance),
            ("min_length", self.min_length),
            ("merge_angle", self.merge_angle),
            ("merge_distance", self.merge_distance),
            ("thickness", self.thickness),
            ("max_post_radius", self.max_post_radius),
            ("explained", self.explained),
        ];
        let others = [
            ("min_move", self.min_move),
            ("min_turn", self.min_turn),
            ("merge_gap", self.merge_gap),
            ("max_passed", self.max_passed),
            ("corner", self.corner),
            ("max_unexplained", self.max_unexplained),
            ("free_without_echo", self.free_without_echo),
        ];
        // NaN compares as false.
        let good = |value: f64, lowest: f64| (lowest..=1000.0).contains(&value);
        let bad = positive.iter().find(|(_, value)| !good(*value, 1e-3));
        match bad.or_else(|| others.iter().find(|(_, value)| !good(*value, 0.0))) {
            Some(&(name, value)) => Err(SurveyError::Parameter(name, value)),
            None => Ok(()),
        }
    }
}
