//! Bags of ROS 2 in MCAP files, read and written without ROS.
//!
//! [`BagReader`] gives the messages of a bag one after the other, [`BagWriter`] writes one. The messages are
//! in [`messages`], and [`Transforms`] tells where a frame was at a time. Nothing here knows of maps or of
//! robots.
//!
//! ```
//! use covmap_bag::messages::{Header, RangeMessage, RosMessage, Stamp};
//! use covmap_bag::{BagReader, BagWriter};
//! use std::io::Cursor;
//!
//! let mut file = Cursor::new(Vec::new());
//! let mut bag = BagWriter::new(&mut file)?;
//! let stamp = Stamp::from_seconds(1.5);
//! let header = Header { stamp, frame_id: "sonar_0".into() };
//! bag.write("/sonar", stamp, &RangeMessage { header, range: 2.5, ..RangeMessage::default() })?;
//! bag.finish()?;
//!
//! for message in BagReader::new("a.mcap", Cursor::new(file.into_inner())) {
//!     let message = message?;
//!     let range = RangeMessage::from_cdr(&message.data)?;
//!     assert_eq!((message.topic.as_str(), range.range), ("/sonar", 2.5));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cdr;
mod error;
mod info;
pub mod messages;
pub mod planar;
mod reader;
pub mod schemas;
mod transforms;
mod writer;

pub use cdr::{CdrError, CdrReader, CdrWriter};
pub use error::BagError;
pub use info::{BagInfo, Topic, is_static};
pub use reader::{BagMessage, BagReader, CutOff};
pub use transforms::{LONGEST_GAP, TransformError, Transforms};
pub use writer::BagWriter;
