//! Kinds of files, by their first bytes.

/// A kind of file that its first bytes tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signature {
    /// A bag of ROS 1.
    RosBag,
    /// An SQLite database, such as rosbag2 writes.
    Sqlite,
    /// A recording in MCAP, such as rosbag2 writes.
    Mcap,
    /// A map of CARMEN.
    CarmenMap,
    /// An image that a map of map_server may name: PNG or PGM.
    MapImage,
    /// A JPEG image.
    Jpeg,
    /// A GIF image.
    Gif,
    /// An archive of several files, packed or not.
    Archive,
    /// A file packed with gzip.
    Gzip,
    /// A file packed with bzip2, xz or Zstandard.
    Packed,
}

use Signature::{Archive, CarmenMap, Gif, Gzip, Jpeg, MapImage, Mcap, Packed, RosBag, Sqlite};

const BEGINNINGS: [(&[u8], Signature); 15] = [
    (b"#ROSBAG", RosBag),
    (b"SQLite format 3\0", Sqlite),
    (b"\x89MCAP0", Mcap),
    (b"CARMENMAPFILE", CarmenMap),
    (b"\x89PNG", MapImage),
    (b"P5", MapImage),
    (b"P2", MapImage),
    (b"\xff\xd8\xff", Jpeg),
    (b"GIF8", Gif),
    (b"PK\x03\x04", Archive),
    (b"7z\xbc\xaf\x27\x1c", Archive),
    (b"\x1f\x8b", Gzip),
    (b"BZh", Packed),
    (b"\xfd7zXZ", Packed),
    (b"\x28\xb5\x2f\xfd", Packed),
];

/// Returns the kind of a file by its first bytes, some 300 of them; `None` if they do not tell the kind.
pub fn signature(head: &[u8]) -> Option<Signature> {
    let begins = |(beginning, _): &&(&[u8], Signature)| head.starts_with(beginning);
    let found = BEGINNINGS.iter().find(begins).map(|(_, kind)| *kind);
    found.or_else(|| (head.get(257..262) == Some(b"ustar")).then_some(Archive))
}
