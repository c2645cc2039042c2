//! What a bag has: topics, times, and frames.

use crate::messages::{RosMessage, TfMessage};
use crate::{BagError, BagMessage, BagReader, CutOff, Transforms};
use std::collections::BTreeMap;

/// The largest number of topics that are told.
const MOST_TOPICS: usize = 10_000;

/// Whether the transforms of a topic hold for all times.
pub fn is_static(topic: &str) -> bool {
    topic.ends_with("tf_static")
}

/// A topic of a bag.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Topic {
    /// The name of its type; empty if the bag does not tell.
    pub type_name: String,
    /// The number of its messages.
    pub messages: usize,
    /// The number of messages that cannot be read as what they are said to be, of the types that matter.
    pub unreadable: usize,
}

/// What a bag has.
#[derive(Debug, Clone, Default)]
pub struct BagInfo {
    /// The topics by their names.
    pub topics: BTreeMap<String, Topic>,
    /// When the first message was recorded \[ns\].
    pub first: Option<u64>,
    /// When the last message was recorded \[ns\].
    pub last: Option<u64>,
    /// The frames, with their last places.
    pub transforms: Transforms,
    /// Where the bag is cut off or damaged, if it is.
    pub cut_off: Option<CutOff>,
}

impl BagInfo {
    /// Reads the messages of a bag to their end.
    ///
    /// # Errors
    /// If the file cannot be read, or is no bag.
    pub fn read(mut reader: BagReader) -> Result<Self, BagError> {
        let mut info = Self::default();
        for message in &mut reader {
            info.add(&message?);
        }
        info.cut_off = reader.cut_off().cloned();
        Ok(info)
    }

    /// Takes note of the next message of a bag.
    pub fn add(&mut self, message: &BagMessage) {
        let time = message.log_time;
        self.first = Some(self.first.map_or(time, |first| first.min(time)));
        self.last = Some(self.last.map_or(time, |last| last.max(time)));
        if self.topics.len() == MOST_TOPICS && !self.topics.contains_key(&message.topic) {
            return;
        }
        let topic = self.topics.entry(message.topic.clone()).or_default();
        topic.type_name.clone_from(&message.type_name);
        topic.messages += 1;
        if message.is::<TfMessage>() {
            match TfMessage::from_cdr(&message.data) {
                Ok(tf) => {
                    let is_static = is_static(&message.topic);
                    for transform in &tf.transforms {
                        self.transforms.add(transform, is_static);
                    }
                }
                Err(_) => topic.unreadable += 1,
            }
        }
    }

    /// Returns the duration of the bag \[s\].
    pub fn seconds(&self) -> f64 {
        let (first, last) = (self.first.unwrap_or(0), self.last.unwrap_or(0));
        last.saturating_sub(first) as f64 * 1e-9
    }

    /// Returns the topics with their types and the numbers of their messages, in words.
    pub fn topics_in_words(&self) -> String {
        let topic = |(name, topic): (&String, &Topic)| {
            format!("{name} ({}, {})", topic.type_name, topic.messages)
        };
        self.topics.iter().map(topic).collect::<Vec<_>>().join(", ")
    }
}
