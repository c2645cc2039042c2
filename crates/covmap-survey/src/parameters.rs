//! What a survey takes for a wall.

use super::SurveyError;
use serde::{Deserialize, Serialize};

/// What a survey takes for a wall, and what for noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurveyParameters {
    /// A scan is used if the robot moved by this much since the last one that was \[m\] …
    pub min_move: f64,
    /// … or turned by this much \[rad\]. Standing still is no further view.
    pub min_turn: f64,
    /// Echoes from farther away are not used \[m\].
    pub max_range: f64,
    /// Neighbouring echoes on one surface are at most this far apart \[m\], and farther only
    /// as the spacing of the beams on a surface at `grazing` explains.
    pub jump: f64,
    /// A surface that the beams meet at a smaller angle is not a surface, but echoes that mix
    /// what is near and what is behind it \[rad\].
    pub grazing: f64,
    /// Echoes of a scan that are on one wall are at most this far from its line \[m\].
    pub split_distance: f64,
    /// The fewest echoes of a segment in a scan …
    pub min_echoes: usize,
    /// … and its least length \[m\].
    pub min_length: f64,
    /// Segments of one wall differ at most by this angle \[rad\] …
    pub merge_angle: f64,
    /// … this distance across \[m\]: the error of the poses …
    pub merge_distance: f64,
    /// … and this gap along it \[m\]. A wall is also closed over such a gap where no beam went
    /// through.
    pub merge_gap: f64,
    /// The fewest views from which a wall, or a post, is seen.
    pub min_views: usize,
    /// A wall or post is not there if more than this share of the beams that could meet it
    /// went through.
    pub max_passed: f64,
    /// Ends of walls that are this near to where the walls meet are moved there \[m\].
    pub corner: f64,
    /// How far the solid is assumed to reach behind a front \[m\].
    pub thickness: f64,
    /// The largest radius of a post \[m\].
    pub max_post_radius: f64,
    /// An echo this near to a wall or post is explained by it \[m\].
    pub explained: f64,
    /// A cell is not scored if more than this share of the beams that came there ended in
    /// echoes that nothing explains.
    pub max_unexplained: f64,
    /// A beam without an echo shows at most so much free space \[m\]: 0 if that may also be a
    /// surface that does not answer.
    pub free_without_echo: f64,
}

impl SurveyParameters {
    /// For an indoor laser of 1 cm noise and 0.5° between beams, and poses that are good to
    /// some centimetres.
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
        // What is not a number compares as false.
        let good = |value: f64, lowest: f64| (lowest..=1000.0).contains(&value);
        let bad = positive.iter().find(|(_, value)| !good(*value, 1e-3));
        match bad.or_else(|| others.iter().find(|(_, value)| !good(*value, 0.0))) {
            Some(&(name, value)) => Err(SurveyError::Parameter(name, value)),
            None => Ok(()),
        }
    }
}
