//! The limits of a log.

/// The longest line that is read \[bytes\]: 4096 sonars with their places take half of it.
pub(super) const LONGEST_LINE: usize = 1 << 20;
/// A packed file may unpack to this many times its size, and always to [`ALWAYS_UNPACKED`].
///
/// Logs of a robot that stands still reach a ratio of about 100; files made to fill a disk reach
/// 1000.
pub(super) const MOST_RATIO: u64 = 300;
/// The largest number of poses in a file: the reader holds them all, in some 130 MB.
pub(super) const MOST_POSES: usize = 2_000_000;
