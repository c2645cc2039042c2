//! Files of poses.

use super::fields::Fields;
use super::limits::MOST_POSES;
use super::lines::Lines;
use super::skipped::{Damage, leapt};
use super::track::{Fix, Middle, Place, Stamp, Ties, middle, pose_between};
use super::{LogError, SkipReason, Skipped};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// The number of runs of time, before and after the last used one, that a search covers.
const RUNS_AROUND: usize = 8;

/// The units of a file of poses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    per_metre: f64,
    per_radian: f64,
}

impl Units {
    /// The units of `od.txt`: millimetres and tenths of a degree.
    pub(super) const ODOMETRY: Self = Self { per_metre: 1e3, per_radian: 1800.0 / PI };
    /// The units of corrected poses: metres and radians.
    pub(super) const CORRECTED: Self = Self { per_metre: 1.0, per_radian: 1.0 };
}

/// A file with a time in milliseconds and a pose in each line.
pub(super) struct PoseFile {
    path: PathBuf,
    /// The file's lines, until they are read.
    lines: Option<Lines>,
    units: Units,
    fixes: Vec<Fix>,
    /// The starts of the runs in which time does not go back.
    runs: Vec<usize>,
    /// The run that was used last.
    run: usize,
    ties: Ties,
}

impl PoseFile {
    pub(super) fn open(path: &Path, units: Units) -> Result<Self, LogError> {
        Ok(Self::new(Lines::open(path)?, units))
    }

    pub(super) fn new(lines: Lines, units: Units) -> Self {
        let path = lines.path().to_owned();
        let (fixes, runs, ties) = (Vec::new(), Vec::new(), Ties::default());
        Self { path, lines: Some(lines), units, fixes, runs, run: 0, ties }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the number of times that the file's clock starts anew.
    pub(super) fn restarts(&self) -> usize {
        self.runs.len().saturating_sub(1)
    }

    /// Returns whether the file's clock is too coarse to tell its lines apart.
    pub(super) fn is_coarse(&self) -> bool {
        self.ties.is_coarse()
    }

    /// Returns the fixes from one place to another.
    pub(super) fn part(&self, first: usize, end: usize) -> &[Fix] {
        self.fixes.get(first..end).unwrap_or_default()
    }

    /// Reads the whole file, unless that is done.
    pub(super) fn read(&mut self, skipped: &mut Skipped) -> Result<(), LogError> {
        let Some(mut lines) = self.lines.take() else { return Ok(()) };
        while lines.advance()? {
            match parse(&lines, self.units) {
                Ok(fix) => self.push(fix, skipped),
                Err(damage) => skipped.add_pose(&self.path, lines.line(), &damage),
            }
            if self.fixes.len() > MOST_POSES {
                let (path, line) = (self.path.clone(), lines.line());
                return Err(LogError::TooManyPoses { path, line });
            }
        }
        let time = |i: usize| self.fixes[i].stamp.time;
        let begins = |i: &usize| *i == 0 || time(*i) < time(*i - 1);
        self.runs = (0..self.fixes.len()).filter(begins).collect();
        Ok(())
    }

    fn push(&mut self, fix: Fix, skipped: &mut Skipped) {
        if self.fixes.last().is_none_or(|last| last.pose != fix.pose) {
            self.ties.add(fix.stamp.time);
        }
        let mut at = self.fixes.len();
        if let [.., a, b] = *self.fixes {
            match middle(a.stamp.time, b.stamp.time, fix.stamp.time) {
                Middle::Good => {}
                Middle::Late => at -= 1,
                Middle::Glitch => {
                    self.fixes.pop();
                    at -= 1;
                    skipped.add_pose(&self.path, b.line, &leapt(b.stamp.time));
                }
            }
        }
        self.fixes.insert(at, fix);
    }

    /// Returns the pose at a time \[s\], if known.
    pub(super) fn at(&mut self, time: f64) -> Option<Place> {
        let (later, earlier) = (self.run..self.runs.len(), (0..self.run).rev());
        let around = later.take(RUNS_AROUND).chain(earlier.take(RUNS_AROUND));
        let (run, place) =
            around.into_iter().find_map(|run| Some((run, self.in_run(run, time)?)))?;
        self.run = run;
        Some(place)
    }

    #[allow(clippy::float_cmp, reason = "a recorded time is found by its digits")]
    fn in_run(&self, run: usize, time: f64) -> Option<Place> {
        let first = self.runs[run];
        let end = self.runs.get(run + 1).copied().unwrap_or(self.fixes.len());
        let fixes = &self.fixes[first..end];
        let after = fixes.partition_point(|fix| fix.stamp.time < time);
        let b = fixes.get(after)?;
        let pose = if b.stamp.time == time {
            Some(b.pose)
        } else {
            let before = after.checked_sub(1).map(|before| &fixes[before]);
            before.and_then(|a| pose_between(a, b, time))
        };
        Some((pose?, first + after))
    }

    /// Returns the pose in a line.
    pub(super) fn at_line(&self, line: usize) -> Option<Place> {
        let found = self.fixes.binary_search_by_key(&line, |fix| fix.line).ok()?;
        Some((self.fixes[found].pose, found))
    }
}

fn parse(lines: &Lines, units: Units) -> Result<Fix, Damage> {
    let text = lines.text();
    let mut fields = Fields::new(&text);
    let Units { per_metre, per_radian } = units;
    let time = fields.time("time", 1e3)?;
    let pose = fields.pose(["x", "y", "theta"], per_metre, per_radian)?;
    if fields.left() > 0 {
        let fault = format!("theta: is followed by {} fields more", fields.left());
        return Err(Damage::new(SkipReason::Unreadable, fault));
    }
    Ok(Fix { stamp: Stamp { time, logger: None }, line: lines.line(), pose })
}
