//! The maps of ROS: a YAML file that describes an image.

mod description;
mod load;
mod save;

pub use load::{MapCell, MapServerMap, load_map_server};
pub use save::{CoverageThresholds, save_map_server};

use covmap::GridError;

/// What is wrong with the description of a map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapServerError {
    /// A key is missing.
    #[error("the key `{0}` is missing")]
    Missing(&'static str),
    /// The map is turned.
    #[error("the origin has a yaw of {0} rad; only maps that are not turned (yaw 0) are read")]
    Yaw(f64),
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
