//! Files: RON, JSON lines, the maps of ROS, logs, pictures of rasters, and charts.
//!
//! Nothing of Stachniss & Burgard (2003) is in here: [`Picture`] and [`Chart`] draw,
//! [`log::LogReader`] reads scans, [`OutputFolder`] holds whole results.
//!
//! This crate knows nothing of worlds, models and planners: it reads what serde can.
//!
//! # Units
//! Metres and radians in the world; pixels for what is drawn; coverage in \[0, 1\].
//!
//! ```no_run
//! use covmap_io::{OutputFolder, Picture, Replace, Rgb, load_map_server};
//! let building = load_map_server("maps/building.yaml")?;
//! let results = OutputFolder::create("out/building", "building.yaml", Replace::Same)?;
//! Picture::new(building.grid)
//!     .cells(&building.solid(), |solid| if *solid { Rgb::INK } else { Rgb::WHITE })
//!     .save(results.path("truth.png"))?;
//! results.finish()?;
//! # Ok::<(), covmap_io::FileError>(())
//! ```
mod chart;
mod error;
mod escaped;
mod json;
mod json_lines;
mod ledger;
pub mod log;
mod map_server;
mod new_file;
mod output_folder;
mod pgm;
mod picture;
mod read;
mod ron_file;
mod shared_folder;
mod signature;
pub use chart::{Chart, ChartAxis, ChartPoint, Figure, HeatMap, Panel, Series};
pub use chart::{Drawing, TextAnchor};
pub use error::FileError;
pub use escaped::{escaped, shown};
pub use json::{read_json, write_json};
pub use json_lines::{JsonLines, JsonLinesReader, read_json_lines};
pub use map_server::{ImageError, MapAreas, MapCell, MapServerError, MapServerMap};
pub use map_server::{MapCounts, MapThresholds, load_map_server, save_map_server};
pub use new_file::{NewFile, Replace, write_file};
pub use output_folder::OutputFolder;
pub use picture::{ColorMap, Key, Marker, Picture, Rgb, coverage_color};
pub use read::{MAX_FILE, open_input, read_beginning, read_bytes, read_text};
pub use ron_file::{parse_ron, read_ron, to_ron, write_ron};
pub use shared_folder::SharedFolder;
pub use signature::{Signature, signature};
