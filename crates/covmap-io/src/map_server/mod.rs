//! The maps of ROS: a YAML file that describes an image.

mod description;
mod image;
mod load;
mod map;
mod save;

pub use load::load_map_server;
pub use map::{MapAreas, MapCell, MapServerMap};
pub use save::{MapCounts, MapThresholds, save_map_server};

use crate::map_error::{ImageError, MapServerError};
