//! Charts of series and heat maps, and pictures of rasters, as SVG and PNG.
//!
//! [`Picture`] draws a raster of cells with lines, markers and words on it; [`Chart`] draws series of
//! points, and [`Figure`] puts several charts side by side.
//!
//! This crate knows nothing of worlds, models or planners.
//!
//! # Units
//! Metres in the world; pixels in drawings; coverage in \[0, 1\].
//!
//! ```no_run
//! use covmap_draw::{Picture, Rgb};
//! use covmap_io::load_map_server;
//! let building = load_map_server("maps/building.yaml")?;
//! Picture::new(building.grid)
//!     .cells(&building.solid(), |solid| if *solid { Rgb::INK } else { Rgb::WHITE })
//!     .save("truth.png")?;
//! # Ok::<(), covmap_io::FileError>(())
//! ```
mod chart;
mod folder;
mod picture;
mod trail;
pub use chart::{Chart, ChartAxis, ChartPoint, Figure, HeatMap, Panel, Series};
pub use chart::{Drawing, TextAnchor};
pub use folder::FigureFolder;
pub use picture::{ColorMap, Key, Marker, Picture, Rgb, coverage_color};
pub use trail::Trail;
