//! What no log is larger than.

/// The longest line that is read \[bytes\]: 4096 sonars with their places take half of it.
pub(super) const LONGEST_LINE: usize = 1 << 20;
/// A packed file may unpack to this many times its size, and always to [`ALWAYS_UNPACKED`].
/// Logs of a robot that stands still come to about 100; what is made to fill a disk, to 1000.
pub(super) const MOST_RATIO: u64 = 300;
/// The most poses that a file may have: they are held at the same time, in some 130 MB.
pub(super) const MOST_POSES: usize = 2_000_000;
