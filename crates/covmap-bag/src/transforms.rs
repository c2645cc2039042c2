//! The frames of a robot, and where each was at which time.

use crate::messages::{Stamp, TransformStamped};
use crate::planar::in_space;
use nalgebra::Isometry3;
use std::collections::{BTreeMap, VecDeque};

/// The number of transforms that are remembered of each frame: 10 s at 400 Hz.
const REMEMBERED: usize = 4096;
/// The longest time between two transforms that allows one in between \[s\].
pub const LONGEST_GAP: f64 = 2.0;
/// The largest number of frames, and of frames between a frame and the root.
const MOST_FRAMES: usize = 4096;

/// Why a transform between two frames is not known.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TransformError {
    /// There is no transform to or from a frame.
    #[error("there is no frame `{0}`")]
    Unknown(String),
    /// The frames are of different trees, or of a circle.
    #[error("no transforms lead from `{from}` to `{to}`")]
    NotConnected {
        /// The frame that is sought.
        from: String,
        /// The frame in which it is sought.
        to: String,
    },
    /// The first transform of a frame is later.
    #[error("the place of `{frame}` is known only from {first} s on, not at {time} s")]
    TooEarly {
        /// The frame.
        frame: String,
        /// The time of its first transform \[s\].
        first: f64,
        /// The time in question \[s\].
        time: f64,
    },
    /// The last transform of a frame is earlier: a later one may still come.
    #[error("the place of `{frame}` is known only until {last} s, not at {time} s")]
    TooLate {
        /// The frame.
        frame: String,
        /// The time of its last transform \[s\].
        last: f64,
        /// The time in question \[s\].
        time: f64,
    },
    /// The frame moves against the other one.
    #[error("`{0}` is not fixed: its place changes")]
    Moves(String),
    /// The transforms around the time are too far apart.
    #[error("the place of `{frame}` is not known for more than {LONGEST_GAP} s around {time} s")]
    Gap {
        /// The frame.
        frame: String,
        /// The time in question \[s\].
        time: f64,
    },
}

/// The place of a frame in its parent.
#[derive(Debug, Clone)]
struct Link {
    parent: String,
    is_static: bool,
    /// The times \[ns\] and places, in the order of time.
    places: VecDeque<(i64, Isometry3<f64>)>,
}

/// A tree of frames, with the last places of each.
///
/// Between two times a place is interpolated: on a straight line, with a turn of constant speed. Nothing
/// is extrapolated.
#[derive(Debug, Clone, Default)]
pub struct Transforms {
    links: BTreeMap<String, Link>,
}

impl Transforms {
    /// Adds a transform; `false` if it is none: its numbers are none of a motion, a frame is its own
    /// parent or has no name, or there are too many frames.
    pub fn add(&mut self, transform: &TransformStamped, is_static: bool) -> bool {
        let (parent, child) = (&transform.header.frame_id, &transform.child_frame_id);
        let Some(place) = in_space(&transform.transform) else { return false };
        let is_full = self.links.len() >= MOST_FRAMES && !self.links.contains_key(child);
        if parent.is_empty() || child.is_empty() || parent == child || is_full {
            return false;
        }
        let time = transform.header.stamp.nanos();
        let fresh = Link { parent: parent.clone(), is_static, places: VecDeque::new() };
        let link = self.links.entry(child.clone()).or_insert_with(|| fresh.clone());
        if link.parent != *parent || link.is_static != is_static {
            *link = fresh;
        }
        if is_static {
            link.places.clear();
        }
        let at = link.places.partition_point(|(known, _)| *known < time);
        match link.places.get_mut(at) {
            // The same message again.
            Some(known) if known.0 == time => known.1 = place,
            _ => link.places.insert(at, (time, place)),
        }
        if link.places.len() > REMEMBERED {
            link.places.pop_front();
        }
        true
    }

    /// Forgets all places that change, after the clock started anew.
    pub fn start_anew(&mut self) {
        self.links.retain(|_, link| link.is_static);
    }

    /// Whether there is a frame of this name.
    pub fn has(&self, frame: &str) -> bool {
        self.links.contains_key(frame) || self.links.values().any(|link| link.parent == frame)
    }

    /// Returns all frames, each with its parent and whether it is fixed to it.
    pub fn frames(&self) -> impl Iterator<Item = (&str, &str, bool)> {
        self.links
            .iter()
            .map(|(child, link)| (child.as_str(), link.parent.as_str(), link.is_static))
    }

    /// Whether a frame hangs on another one, at whatever times.
    pub fn is_below(&self, frame: &str, above: &str) -> bool {
        self.ancestors(frame).any(|ancestor| ancestor == above)
    }

    /// Whether a frame has a parent.
    pub fn has_parent(&self, frame: &str) -> bool {
        self.links.contains_key(frame)
    }

    /// Returns the frame above a frame that hangs on no other.
    pub fn root<'a>(&'a self, frame: &'a str) -> &'a str {
        self.ancestors(frame).last().unwrap_or(frame)
    }

    /// Returns the lowest of a frame and the frames above it that moves in its parent.
    pub fn moving<'a>(&'a self, frame: &'a str) -> Option<&'a str> {
        self.ancestors(frame).find(|frame| self.links.get(*frame).is_some_and(|l| !l.is_static))
    }

    /// Returns the place of a frame that is fixed to another one, `target_from_source`.
    ///
    /// # Errors
    /// If the frame is not fixed to it, or not connected with it.
    pub fn fixed(&self, target: &str, source: &str) -> Result<Isometry3<f64>, TransformError> {
        let above_target: Vec<&str> = self.ancestors(target).collect();
        let below = |frame: &&str| !above_target.contains(frame);
        let from_source = self.ancestors(source).take_while(below);
        let common = self.ancestors(source).find(|frame| !below(frame));
        let from_target = above_target.iter().copied().take_while(|frame| Some(*frame) != common);
        for frame in from_source.chain(from_target.filter(|_| common.is_some())) {
            if self.links.get(frame).is_some_and(|link| !link.is_static) {
                return Err(TransformError::Moves(frame.to_owned()));
            }
        }
        self.lookup(target, source, Stamp::default())
    }

    /// Returns where a frame was in another one, `target_from_source`.
    ///
    /// # Errors
    /// If the transforms do not tell.
    pub fn lookup(
        &self,
        target: &str,
        source: &str,
        time: Stamp,
    ) -> Result<Isometry3<f64>, TransformError> {
        for frame in [target, source] {
            if !self.has(frame) {
                return Err(TransformError::Unknown(frame.to_owned()));
            }
        }
        let above_target: Vec<&str> = self.ancestors(target).collect();
        let Some(common) = self.ancestors(source).find(|frame| above_target.contains(frame)) else {
            return Err(TransformError::NotConnected {
                from: source.to_owned(),
                to: target.to_owned(),
            });
        };
        let source = self.place(source, common, time)?;
        if common == target {
            return Ok(source);
        }
        Ok(self.place(target, common, time)?.inverse() * source)
    }

    /// Returns a frame and all frames above it, from below.
    fn ancestors<'a>(&'a self, frame: &'a str) -> impl Iterator<Item = &'a str> {
        let parent = |frame: &&'a str| self.links.get(*frame).map(|link| link.parent.as_str());
        // A circle of frames has no end.
        std::iter::successors(Some(frame), parent).take(MOST_FRAMES)
    }

    /// Returns where a frame was in one of the frames above it.
    fn place(
        &self,
        frame: &str,
        above: &str,
        time: Stamp,
    ) -> Result<Isometry3<f64>, TransformError> {
        let mut place: Option<Isometry3<f64>> = None;
        for (frame, link) in self
            .ancestors(frame)
            .take_while(|frame| *frame != above)
            .filter_map(|frame| Some((frame, self.links.get(frame)?)))
        {
            let own = link.at(frame, time)?;
            // A product with the identity may round.
            place = Some(place.map_or(own, |below| own * below));
        }
        Ok(place.unwrap_or_default())
    }
}

impl Link {
    fn at(&self, frame: &str, time: Stamp) -> Result<Isometry3<f64>, TransformError> {
        let (wanted, frame) = (time.nanos(), frame.to_owned());
        let seconds = |nanos: i64| nanos as f64 * 1e-9;
        let (Some(first), Some(last)) = (self.places.front(), self.places.back()) else {
            return Err(TransformError::Unknown(frame));
        };
        if self.is_static {
            return Ok(last.1);
        }
        let at = self.places.partition_point(|(known, _)| *known < wanted);
        let Some(&(after, place)) = self.places.get(at) else {
            let (last, time) = (seconds(last.0), time.seconds());
            return Err(TransformError::TooLate { frame, last, time });
        };
        if after == wanted {
            return Ok(place);
        }
        let Some(&(before, earlier)) = at.checked_sub(1).and_then(|at| self.places.get(at)) else {
            let (first, time) = (seconds(first.0), time.seconds());
            return Err(TransformError::TooEarly { frame, first, time });
        };
        let gap = seconds(after.saturating_sub(before));
        if gap > LONGEST_GAP {
            return Err(TransformError::Gap { frame, time: time.seconds() });
        }
        let share = seconds(wanted - before) / gap;
        let between = earlier.try_lerp_slerp(&place, share, 1e-9);
        Ok(between.unwrap_or(if share < 0.5 { earlier } else { place }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{Header, Transform};
    use std::f64::consts::PI;

    fn transform(time: f64, parent: &str, child: &str, x: f64, angle: f64) -> TransformStamped {
        let (z, w) = libm::sincos(0.5 * angle);
        TransformStamped {
            header: Header { stamp: Stamp::from_seconds(time), frame_id: parent.into() },
            child_frame_id: child.into(),
            transform: Transform { translation: [x, 0.0, 0.0], rotation: [0.0, 0.0, z, w] },
        }
    }

    fn robot() -> Transforms {
        let mut transforms = Transforms::default();
        for (time, x) in [(10.0, 1.0), (10.5, 2.0), (20.0, 3.0)] {
            assert!(transforms.add(&transform(time, "odom", "base_link", x, 0.0), false));
        }
        assert!(transforms.add(&transform(0.0, "map", "odom", 5.0, 0.5 * PI), true));
        assert!(transforms.add(&transform(0.0, "base_link", "sonar", 0.2, 0.0), true));
        transforms
    }

    fn place(target: &str, source: &str, time: f64) -> Result<(f64, f64), TransformError> {
        let found = robot().lookup(target, source, Stamp::from_seconds(time))?;
        let round = |v: f64| (v * 1e6).round() / 1e6 + 0.0;
        Ok((round(found.translation.x), round(found.translation.y)))
    }

    #[test]
    fn a_place_is_found_through_all_frames_and_between_two_times() {
        assert_eq!(place("odom", "base_link", 10.5), Ok((2.0, 0.0)));
        assert_eq!(place("odom", "sonar", 10.25), Ok((1.7, 0.0)));
        // A quarter turn: odom's x axis is map's y axis.
        assert_eq!(place("map", "sonar", 10.25), Ok((5.0, 1.7)));
        assert_eq!(place("sonar", "base_link", 0.0), Ok((-0.2, 0.0)));
        assert_eq!(place("map", "map", 0.0), Ok((0.0, 0.0)));
    }

    #[test]
    fn what_is_not_known_is_said() {
        let early = place("map", "sonar", 9.0).unwrap_err().to_string();
        assert_eq!(early, "the place of `base_link` is known only from 10 s on, not at 9 s");
        let late = place("map", "sonar", 21.0).unwrap_err().to_string();
        assert_eq!(late, "the place of `base_link` is known only until 20 s, not at 21 s");
        assert!(matches!(place("map", "sonar", 15.0), Err(TransformError::Gap { .. })));
        assert_eq!(place("map", "laser", 10.0), Err(TransformError::Unknown("laser".into())));
    }

    #[test]
    fn a_sensor_is_fixed_to_the_robot_and_the_robot_to_nothing() {
        let transforms = robot();
        let mount = transforms.fixed("base_link", "sonar").unwrap();
        assert!((mount.translation.x - 0.2).abs() < 1e-12);
        let moves = |frame: &str| Err(TransformError::Moves(frame.into()));
        assert_eq!(transforms.fixed("odom", "sonar"), moves("base_link"));
        assert_eq!(transforms.fixed("sonar", "odom"), moves("base_link"));
        assert_eq!(
            (transforms.moving("sonar"), transforms.root("sonar")),
            (Some("base_link"), "map")
        );
    }

    #[test]
    fn circles_and_other_trees_are_not_connected() {
        let mut transforms = robot();
        transforms.add(&transform(0.0, "a", "b", 0.0, 0.0), true);
        transforms.add(&transform(0.0, "b", "a", 0.0, 0.0), true);
        let found = transforms.lookup("map", "a", Stamp::default());
        assert!(matches!(found, Err(TransformError::NotConnected { .. })));
        assert!(!transforms.add(&transform(0.0, "c", "c", 0.0, 0.0), true));
    }

    #[test]
    fn late_and_doubled_transforms_are_put_where_they_belong() {
        let mut transforms = Transforms::default();
        for (time, x) in [(3.0, 3.0), (1.0, 1.0), (2.0, 9.0), (2.0, 2.0)] {
            transforms.add(&transform(time, "odom", "base_link", x, 0.0), false);
        }
        let found = transforms.lookup("odom", "base_link", Stamp::from_seconds(1.5)).unwrap();
        assert!((found.translation.x - 1.5).abs() < 1e-9);
        transforms.start_anew();
        assert!(!transforms.has("base_link"));
    }
}
