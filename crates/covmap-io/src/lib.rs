//! Files: RON, JSON lines, the maps of ROS, and folders of results.
//!
//! This crate holds nothing of Stachniss & Burgard (2003): [`read_ron`] and [`read_json_lines`]
//! read any value that serde can read, [`load_map_server`] reads floor plans, and [`OutputFolder`]
//! holds whole results.
//!
//! This crate knows nothing of worlds, models or planners.
//!
//! # Units
//! Metres and radians; coverage in \[0, 1\].
//!
//! ```no_run
//! use covmap_io::{OutputFolder, Replace, load_map_server, write_json};
//! let building = load_map_server("maps/building.yaml")?;
//! let results = OutputFolder::create("out/building", "building.yaml", Replace::Same)?;
//! write_json(results.path("grid.json"), &building.grid)?;
//! results.finish()?;
//! # Ok::<(), covmap_io::FileError>(())
//! ```
pub mod csv;
mod digest;
mod error;
mod escaped;
mod json;
mod json_lines;
mod ledger;
mod map_error;
mod map_server;
mod new_file;
mod output_folder;
mod pgm;
mod read;
mod ron_file;
mod shared_folder;
mod signature;
pub use digest::{Digest, checksum};
pub use error::FileError;
pub use escaped::{escaped, shown};
pub use json::{read_json, write_json};
pub use json_lines::{JsonLines, JsonLinesReader, read_json_lines};
pub use map_error::{ImageError, MapServerError};
pub use map_server::{MapAreas, MapCell, MapServerMap};
pub use map_server::{MapCounts, MapThresholds, load_map_server, save_map_server};
pub use new_file::{NewFile, Replace, write_file};
pub use output_folder::OutputFolder;
pub use read::{MAX_FILE, find, open_file, open_input, read_beginning, read_bytes, read_text};
pub use ron_file::{parse_ron, read_ron, to_ron, write_ron};
pub use shared_folder::SharedFolder;
pub use signature::{Signature, signature};
