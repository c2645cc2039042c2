//! The maps of ROS: a YAML file that describes an image.

mod description;
mod image;
mod load;
mod map;
mod save;

pub use image::ImageError;
pub use load::load_map_server;
pub use map::{MapAreas, MapCell, MapServerMap};
pub use save::{MapCounts, MapThresholds, save_map_server};

use covmap::GridError;

/// What is wrong with the description of a map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapServerError {
    /// A key is missing.
    #[error("the key `{0}` is missing")]
    Missing(&'static str),
    /// The origin has another number of values than three.
    #[error("the origin is [x, y, yaw], in metres and radians: three numbers, not {0}")]
    Origin(usize),
    /// The yaw is no angle.
    #[error("the origin has a yaw of {0}, which must be a finite number of radians")]
    Yaw(f64),
    /// Nothing is known.
    #[error("all of its {0} × {1} pixels are unknown, so there is no map; look at the thresholds")]
    Unknown(usize, usize),
    /// The thresholds are no thresholds.
    #[error("free_thresh {free} and occupied_thresh {occupied} must be in order, and in 0..=1")]
    Thresholds {
        /// `free_thresh`.
        free: f64,
        /// `occupied_thresh`.
        occupied: f64,
    },
    /// A mode that map_server does not have.
    #[error("the mode `{0}` is none of trinary, scale, raw")]
    Mode(String),
    /// Resolution or origin are no numbers for a map.
    #[error(transparent)]
    Grid(#[from] GridError),
}
