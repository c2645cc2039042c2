//! The messages of a bag, one after the other.

use crate::BagError;
use crate::messages::RosMessage;
use mcap::sans_io::{LinearReaderOptions, MessageReadEvent, MessageReader};
use std::io::Read;
use std::path::PathBuf;

/// The largest chunk, and the largest message outside of one, that is read \[bytes\].
const MOST_BYTES: usize = 64 << 20;
/// The largest piece that is read at once \[bytes\].
const PIECE: usize = 1 << 20;

/// A message of a bag as it is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct BagMessage {
    /// The topic.
    pub topic: String,
    /// The name of its type, such as `sensor_msgs/msg/Range`; empty if the bag does not tell.
    pub type_name: String,
    /// The encoding, which is `cdr` for all messages of ROS 2.
    pub encoding: String,
    /// When it was recorded \[ns\].
    pub log_time: u64,
    /// The encoded message.
    pub data: Vec<u8>,
}

impl BagMessage {
    /// Whether the message is of a type, and in CDR.
    pub fn is<M: RosMessage>(&self) -> bool {
        self.type_name == M::TYPE && self.encoding == "cdr"
    }
}

/// Why the reading of a bag ended before the bag's own end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CutOff {
    /// The number of messages before.
    pub messages: usize,
    /// What is wrong there.
    pub fault: String,
}

/// The messages of a bag, in the order in which they stand in the file.
///
/// The reader holds one chunk at a time. A chunk counts as a whole: if it is cut off or damaged, the bag
/// ends before it, and [`BagReader::cut_off`] tells so. An index is not needed.
pub struct BagReader {
    path: PathBuf,
    input: Box<dyn Read + Send>,
    reader: MessageReader,
    messages: usize,
    cut_off: Option<CutOff>,
    ended: bool,
}

impl BagReader {
    /// Reads a bag from `input`; errors name it by `path`.
    pub fn new(path: impl Into<PathBuf>, input: impl Read + Send + 'static) -> Self {
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(MOST_BYTES);
        Self {
            path: path.into(),
            input: Box::new(input),
            reader: MessageReader::new_with_options(options),
            messages: 0,
            cut_off: None,
            ended: false,
        }
    }

    /// Returns where the bag is cut off or damaged, if the reader got there.
    pub fn cut_off(&self) -> Option<&CutOff> {
        self.cut_off.as_ref()
    }

    /// Returns the number of messages so far.
    pub fn messages(&self) -> usize {
        self.messages
    }

    fn advance(&mut self) -> Result<Option<BagMessage>, BagError> {
        loop {
            match self.reader.next_event() {
                None => return Ok(None),
                Some(Ok(MessageReadEvent::ReadRequest(wanted))) => self.fill(wanted)?,
                Some(Ok(MessageReadEvent::Message(message))) => {
                    self.messages += 1;
                    let schema = message.channel.schema.as_ref();
                    return Ok(Some(BagMessage {
                        topic: message.channel.topic.clone(),
                        type_name: schema.map(|schema| schema.name.clone()).unwrap_or_default(),
                        encoding: message.channel.message_encoding.clone(),
                        log_time: message.log_time,
                        data: message.data.into_owned(),
                    }));
                }
                Some(Err(fault)) => {
                    let (messages, fault) = (self.messages, fault.to_string());
                    if messages == 0 {
                        return Err(BagError::NoBag { path: self.path.clone(), fault });
                    }
                    self.cut_off = Some(CutOff { messages, fault });
                    return Ok(None);
                }
            }
        }
    }

    fn fill(&mut self, wanted: usize) -> Result<(), BagError> {
        let buffer = self.reader.insert(wanted.clamp(1, PIECE));
        let read = self.input.read(buffer);
        let read = read.map_err(|source| BagError::Io { path: self.path.clone(), source })?;
        self.reader.notify_read(read);
        Ok(())
    }
}

impl Iterator for BagReader {
    type Item = Result<BagMessage, BagError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let next = self.advance().transpose();
        self.ended = !matches!(next, Some(Ok(_)));
        next
    }
}

impl std::fmt::Debug for BagReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { path, messages, cut_off, .. } = self;
        f.debug_struct("BagReader")
            .field("path", path)
            .field("messages", messages)
            .field("cut_off", cut_off)
            .finish_non_exhaustive()
    }
}
