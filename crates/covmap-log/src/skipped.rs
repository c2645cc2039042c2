//! The parts of a log that were passed over, and the reasons.

use std::fmt;
use std::path::Path;

/// Why a frame was passed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkipReason {
    /// A field is missing, or is not a possible number.
    Unreadable,
    /// The number of ranges differs from the announced one, or from the number of the ring's
    /// sensors.
    Count,
    /// The clock leapt for this frame, ahead or back.
    Clock,
    /// No poses are known shortly before and after the frame.
    NoPose,
    /// The frame comes from another sensor than the first frame, or from one mounted elsewhere.
    Geometry,
}

const REASONS: [(SkipReason, &str); 5] = [
    (SkipReason::Unreadable, "cut short or unreadable"),
    (SkipReason::Count, "with a wrong number of ranges"),
    (SkipReason::Clock, "for which the clock leapt"),
    (SkipReason::NoPose, "without a pose"),
    (SkipReason::Geometry, "of another sensor than the first"),
];

/// Counts of the parts that were passed over.
///
/// The display is a sentence such as `skipped 3 of 413 frames: 2 with a wrong number of ranges, 1
/// for which the clock leapt`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Skipped {
    frames: usize,
    counts: [usize; REASONS.len()],
    poses: usize,
    readings: usize,
    first: Option<String>,
}

impl Skipped {
    /// Returns the number of frames found so far, good or not.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Returns the number of frames that were passed over.
    pub fn total(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Returns the number of frames that were passed over for a reason.
    pub fn count(&self, reason: SkipReason) -> usize {
        self.counts[reason as usize]
    }

    /// Returns the number of lines with poses or parameters that were passed over.
    pub fn poses(&self) -> usize {
        self.poses
    }

    /// Returns the number of readings of good frames that are NaN or negative, and count as
    /// missing.
    pub fn readings(&self) -> usize {
        self.readings
    }

    /// Returns file, line, field and fault of the first of all these.
    pub fn first(&self) -> Option<&str> {
        self.first.as_deref()
    }

    /// Returns whether nothing was lost.
    pub fn is_empty(&self) -> bool {
        self.total() + self.poses + self.readings == 0
    }

    pub(super) fn add_frame(&mut self) {
        self.frames += 1;
    }

    pub(super) fn add(&mut self, path: &Path, line: usize, damage: Damage) {
        self.counts[damage.reason as usize] += 1;
        self.remember(path, line, &damage.message);
    }

    pub(super) fn add_pose(&mut self, path: &Path, line: usize, damage: &Damage) {
        self.poses += 1;
        self.remember(path, line, &damage.message);
    }

    pub(super) fn add_readings(&mut self, path: &Path, line: usize, count: usize) {
        self.readings += count;
        if count > 0 {
            self.remember(path, line, "a range is NaN or negative");
        }
    }

    fn remember(&mut self, path: &Path, line: usize, message: &str) {
        self.first.get_or_insert_with(|| format!("{}:{line}: {message}", path.display()));
    }
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "skipped {} of {}", self.total(), plural(self.frames, "frame"))?;
        let some = REASONS.iter().filter(|(reason, _)| self.count(*reason) > 0);
        for (i, (reason, words)) in some.enumerate() {
            write!(f, "{} {} {words}", if i == 0 { ":" } else { "," }, self.count(*reason))?;
        }
        if self.poses > 0 {
            write!(f, "; passed over {} of poses or parameters", plural(self.poses, "line"))?;
        }
        if self.readings > 0 {
            let some = plural(self.readings, "reading");
            write!(f, "; took {some} that are NaN or negative for missing")?;
        }
        self.first.as_ref().map_or(Ok(()), |first| write!(f, " (the first: {first})"))
    }
}

/// Returns a number with its noun, in the plural if needed.
pub(super) fn plural(n: usize, word: &str) -> String {
    format!("{n} {word}{}", if n == 1 { "" } else { "s" })
}

/// Why a line cannot be used.
#[derive(Debug)]
pub(super) struct Damage {
    pub(super) reason: SkipReason,
    /// The field and its fault.
    pub(super) message: String,
}

impl Damage {
    pub(super) fn new(reason: SkipReason, message: impl Into<String>) -> Self {
        Self { reason, message: message.into() }
    }
}

/// Returns the fault of a line for which the clock leapt.
pub(super) fn leapt(time: f64) -> Damage {
    let fault = format!("time: {time} s is not between those before and after");
    Damage::new(SkipReason::Clock, fault)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_skipped_is_one_sentence() {
        let mut skipped = Skipped::default();
        assert!(skipped.is_empty());
        (0..413).for_each(|_| skipped.add_frame());
        assert_eq!(skipped.to_string(), "skipped 0 of 413 frames");
        let path = Path::new("a.log");
        skipped.add(path, 7, Damage::new(SkipReason::Clock, "time: 3 s after 4 s"));
        skipped.add(path, 8, Damage::new(SkipReason::Count, "8 ranges"));
        skipped.add(path, 9, Damage::new(SkipReason::Count, "8 ranges"));
        assert_eq!(
            skipped.to_string(),
            "skipped 3 of 413 frames: 2 with a wrong number of ranges, 1 for which the clock \
             leapt (the first: a.log:7: time: 3 s after 4 s)"
        );
        assert_eq!((skipped.total(), skipped.count(SkipReason::Count)), (3, 2));
    }
}
