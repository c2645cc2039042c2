//! Files that users take for logs: their kinds, and the programs that read them.

use super::carmen_line::TAGS;
use covmap_io::{Signature, signature};
use std::path::Path;

const ROSBAG: &str = "a bag of ROS 1; the Python package `rosbags` makes an MCAP file of it";
const DB3: &str = "an SQLite database, such as rosbag2 writes (.db3); `ros2 bag convert` and the Python \
                   package `rosbags` make an MCAP file of it";
const ROSBAG2: &str = "the folder of a rosbag2 recording; name the .mcap file in it. One with .db3 files is \
                       converted by `ros2 bag convert`, or by the Python package `rosbags`";
const CARMEN_MAP: &str = "a map of CARMEN, which its own tools read";
const IMAGE: &str = "an image; a map of map_server is a world for `explore`, by its YAML file";
const ARCHIVE: &str = "an archive; unpack it first";
const PACKED: &str = "packed by something other than gzip; unpack it first";
const YAML: &str = "a YAML file; a map of map_server is a world for `explore`";
const RON: &str = "a RON file; a scenario is a world for `explore`";
const JSON: &str = "a JSON file, and no log; `log` makes one of the folder that `explore` wrote";
const RUN: &str = "the folder of a run; `log` makes a log of it";
const MAP: &str = "the folder of a map that `map` or `explore` wrote";

/// The endings of names, for contents that say nothing.
const ENDINGS: [(&str, &str); 11] = [
    ("bag", ROSBAG),
    ("db3", DB3),
    ("map", CARMEN_MAP),
    ("png", IMAGE),
    ("pgm", IMAGE),
    ("yaml", YAML),
    ("yml", YAML),
    ("ron", RON),
    ("json", JSON),
    ("tar", ARCHIVE),
    ("zip", ARCHIVE),
];

/// Returns the kind of a file that is not a log, by its beginning.
pub(super) fn kind(head: &[u8]) -> Option<&'static str> {
    match signature(head) {
        Some(Signature::RosBag) => Some(ROSBAG),
        Some(Signature::Sqlite) => Some(DB3),
        // A bag is opened before.
        Some(Signature::Mcap) => None,
        Some(Signature::CarmenMap) => Some(CARMEN_MAP),
        Some(Signature::MapImage | Signature::Jpeg) => Some(IMAGE),
        Some(Signature::Archive) => Some(ARCHIVE),
        Some(Signature::Packed) => Some(PACKED),
        Some(Signature::Gif | Signature::Gzip) => None,
        None if head.starts_with(b"{\"covmap_trace\"") => Some(RUN),
        None => head.starts_with(b"{").then_some(JSON),
    }
}

/// Returns the kind of a file without any line of a log, by its name.
pub(super) fn named<'a>(
    path: &Path,
    mut lines: impl Iterator<Item = &'a [u8]>,
) -> Option<&'static str> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let (_, kind) = ENDINGS.iter().find(|(ending, _)| *ending == extension)?;
    (!lines.any(is_of_a_log)).then_some(kind)
}

/// Returns the kind of a folder that holds no log.
pub(super) fn folder_kind(folder: &Path) -> Option<&'static str> {
    let has = |name: &str| folder.join(name).exists();
    if has("metadata.yaml") {
        return Some(ROSBAG2);
    }
    if has("trace.jsonl") {
        return Some(RUN);
    }
    has("belief.bin").then_some(MAP)
}

/// Returns whether the first word of a line is a tag of CARMEN's logs.
pub fn is_of_a_log(line: &[u8]) -> bool {
    let word = line.split(u8::is_ascii_whitespace).find(|word| !word.is_empty());
    word.is_some_and(|word| TAGS.iter().any(|tag| tag.as_bytes() == word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(name: &str, head: &[u8], part: &str) {
        let lines = head.split(|byte| *byte == b'\n');
        let kind = kind(head).or_else(|| named(Path::new(name), lines)).unwrap_or("a log");
        assert!(kind.contains(part), "{name}: {kind}");
    }

    #[test]
    fn a_file_is_known_by_how_it_begins_and_by_its_name() {
        check("a", b"#ROSBAG V2.0\n", "ROS 1");
        check("a.log", b"SQLite format 3\0....", "rosbag2");
        check("a.log", b"CARMENMAPFILEv020", "a map of CARMEN");
        check("a.log", b"{\"covmap_trace\":1", "the folder of a run");
        check("a.log", &[&[0; 257], &b"ustar"[..]].concat(), "an archive");
        check("A.BAG", b"", "ROS 1");
        check("a.ron", b"(name: 1)", "RON");
        check("a.bag", b"# text\nODOM 1 2 3 0 0 0 1 h 1\n", "a log");
        check("a.log", b"anything else", "a log");
    }
}
