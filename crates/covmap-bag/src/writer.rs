//! A bag that is written message by message.

use crate::BagError;
use crate::messages::{RosMessage, Stamp};
use crate::schemas::definition;
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Compression, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::io::Write;

/// The size of a chunk before it is compressed \[bytes\].
const CHUNK: u64 = 256 << 10;

/// Writer of a bag as `ros2 bag` has it: profile `ros2`, messages in CDR, chunks packed with zstd.
///
/// Equal calls write equal bytes.
pub struct BagWriter<W: Write> {
    writer: Writer<NoSeek<W>>,
    /// The number of each topic, and of its next message.
    topics: BTreeMap<String, (u16, u32)>,
}

fn failed(error: mcap::McapError) -> BagError {
    match error {
        mcap::McapError::Io(error) => BagError::Write(error.to_string()),
        error => BagError::Write(error.to_string()),
    }
}

/// The quality of service of a topic that a late subscriber gets as well, as rosbag2 writes it.
const LATCHED: &str = "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n";
const VOLATILE: &str = "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n";
/// Topics whose last message is for late subscribers as well.
const LATCHED_TOPICS: [&str; 5] = ["/tf_static", "/map", "/entropy", "/certificate", "/path"];

impl<W: Write> BagWriter<W> {
    /// Begins a bag.
    ///
    /// # Errors
    /// If its beginning cannot be written.
    pub fn new(output: W) -> Result<Self, BagError> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(concat!("covmap-bag ", env!("CARGO_PKG_VERSION")))
            .chunk_size(Some(CHUNK))
            // A chunk is written once it is whole, so that a bag that is cut off ends with a whole one.
            .disable_seeking(true)
            .compression(Some(Compression::Zstd))
            .compression_threads(0);
        let writer = options.create(NoSeek::new(output)).map_err(failed)?;
        Ok(Self { writer, topics: BTreeMap::new() })
    }

    /// Adds a message to a topic, recorded at this time.
    ///
    /// # Errors
    /// If it cannot be written, or the type's definition is not known.
    pub fn write<M: RosMessage>(
        &mut self,
        topic: &str,
        time: Stamp,
        message: &M,
    ) -> Result<(), BagError> {
        if !self.topics.contains_key(topic) {
            let schema = definition(M::TYPE).ok_or(BagError::Type(M::TYPE))?;
            let schema = self.writer.add_schema(M::TYPE, "ros2msg", schema.as_bytes());
            let quality = if LATCHED_TOPICS.contains(&topic) { LATCHED } else { VOLATILE };
            let quality = ("offered_qos_profiles".to_owned(), quality.to_owned());
            let channel = self
                .writer
                .add_channel(schema.map_err(failed)?, topic, "cdr", &BTreeMap::from([quality]))
                .map_err(failed)?;
            self.topics.insert(topic.to_owned(), (channel, 0));
        }
        let Some((channel_id, sequence)) = self.topics.get_mut(topic) else { return Ok(()) };
        let log_time = u64::try_from(time.nanos()).unwrap_or(0);
        let header = MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time,
            publish_time: log_time,
        };
        *sequence = sequence.wrapping_add(1);
        self.writer.write_to_known_channel(&header, &message.to_cdr()).map_err(failed)
    }

    /// Writes the index and the end of the bag.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(mut self) -> Result<(), BagError> {
        self.writer.finish().map(drop).map_err(failed)
    }
}

impl<W: Write> std::fmt::Debug for BagWriter<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BagWriter").field("topics", &self.topics).finish_non_exhaustive()
    }
}
