//! The rectangle in which data are drawn: its frame, its grid, and how it cuts lines off.

use super::scale::{Scale, Tick};
use super::scene::{Anchor, Scene};
use crate::picture::{Rgb, text::text_width};

pub(super) const TICK_SIZE: f32 = 12.0;
/// The length of a tick; `TICK_GAP` is the gap to its label.
const TICK: f32 = 5.0;
const TICK_GAP: f32 = 4.0;
const GRID: Rgb = Rgb(228, 232, 237);

/// The rectangle in which data are drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) at: [f32; 2],
    pub(super) size: [f32; 2],
    pub(super) x: Scale,
    pub(super) y: Scale,
}

/// Returns the length of the x axis that a label takes.
pub(super) fn room_across(label: &str) -> f32 {
    text_width(label, TICK_SIZE) + 16.0
}

/// Returns the length of the y axis that a label takes.
pub(super) fn room_upwards(_: &str) -> f32 {
    TICK_SIZE * 2.2
}

/// Returns the width of the widest label.
pub(super) fn widest(ticks: &[Tick]) -> f32 {
    let lines = ticks.iter().flat_map(|tick| tick.label.lines());
    lines.map(|line| text_width(line, TICK_SIZE)).fold(0.0, f32::max)
}

/// Returns the distance from an axis upwards to the far end of its labels.
pub(super) fn reach(ticks: &[Tick]) -> f32 {
    TICK + TICK_GAP + widest(ticks)
}

/// Distance from one line of a label to the next.
const LINE: f32 = TICK_SIZE * 1.25;

/// Returns the distance from the x axis to the lower end of its labels.
pub(super) fn reach_below(ticks: &[Tick]) -> f32 {
    let lines = ticks.iter().map(|tick| tick.label.lines().count()).max().unwrap_or(1).max(1);
    TICK + TICK_GAP + TICK_SIZE + (lines - 1) as f32 * LINE
}

impl Area {
    /// Returns the place of a point, given the share of each axis.
    #[allow(clippy::cast_possible_truncation, reason = "points of the drawing")]
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let ([left, top], [width, height]) = (self.at, self.size);
        [left + x as f32 * width, top + (1.0 - y as f32) * height]
    }

    /// Returns the share of each axis at which a point lies, if the point can be drawn at all.
    pub(super) fn shares(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        Some([self.x.share(x)?, self.y.share(y)?])
    }

    /// Draws the frame, the ticks, and, if `grid` is set, the grid.
    pub(super) fn draw_frame(
        &self,
        scene: &mut Scene,
        (x_ticks, y_ticks): (&[Tick], &[Tick]),
        grid: bool,
    ) {
        let ([left, top], [width, height]) = (self.at, self.size);
        let (right, bottom) = (left + width, top + height);
        for tick in x_ticks {
            let x = self.place([tick.share, 0.0])[0];
            if grid && !tick.label.is_empty() {
                scene.rule([x, top], [x, bottom], GRID);
            }
        }
        for tick in y_ticks.iter().filter(|tick| grid && !tick.label.is_empty()) {
            let y = self.place([0.0, tick.share])[1];
            scene.rule([left, y], [right, y], GRID);
        }
        for tick in x_ticks {
            let x = self.place([tick.share, 0.0])[0];
            scene.rule([x, bottom], [x, bottom + tick_length(tick)], Rgb::FRAME);
            let mut y = bottom + TICK + TICK_GAP + 0.78 * TICK_SIZE;
            for line in tick.label.lines() {
                scene.text(line, TICK_SIZE, [x, y], Anchor::Middle, Rgb::INK);
                y += LINE;
            }
        }
        self.draw_side_ticks(scene, left, -1.0, y_ticks);
        scene.frame(self.at, self.size, Rgb::FRAME);
    }

    /// Draws the ticks of an axis upwards at `x`, to the left (−1) or to the right (1) of it.
    pub(super) fn draw_side_ticks(&self, scene: &mut Scene, x: f32, side: f32, ticks: &[Tick]) {
        for tick in ticks {
            let y = self.place([0.0, tick.share])[1];
            scene.rule([x, y], [x + side * tick_length(tick), y], Rgb::FRAME);
            let at = [x + side * (TICK + TICK_GAP), y + 0.36 * TICK_SIZE];
            let anchor = if side < 0.0 { Anchor::End } else { Anchor::Start };
            if !tick.label.is_empty() {
                scene.text(&tick.label, TICK_SIZE, at, anchor, Rgb::INK);
            }
        }
    }
}

/// Returns the length of a tick: short without a label.
fn tick_length(tick: &Tick) -> f32 {
    if tick.label.is_empty() { TICK * 0.6 } else { TICK }
}

/// Returns whether a point, by the shares of the axes, lies in the frame.
pub(super) fn is_inside(point: [f64; 2]) -> bool {
    point.iter().all(|share| (-1e-6..=1.0 + 1e-6).contains(share))
}

/// Returns the pieces of a line that lie in the frame, by the shares of the axes.
pub(super) fn clip(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let Some((from, to)) = clip_segment(pair[0], pair[1]) else {
            open = false;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if open => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
        // The next segment goes on where this one ended, unless the frame cut it off.
        open = is_inside(pair[1]);
    }
    pieces
}

/// Returns the part of a segment in the unit square, after Liang and Barsky.
fn clip_segment(a: [f64; 2], b: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let along = b[axis] - a[axis];
        for (run, room) in [(-along, a[axis]), (along, 1.0 - a[axis])] {
            if run.abs() < 1e-12 {
                if room < -1e-6 {
                    return None;
                }
            } else if run < 0.0 {
                enter = enter.max(room / run);
            } else {
                leave = leave.min(room / run);
            }
        }
    }
    let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
    (enter <= leave).then(|| (at(enter), at(leave)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_off_at_the_frame() {
        let through = clip(&[[-1.0, 0.5], [2.0, 0.5]]);
        assert_eq!(through.len(), 1);
        let ends = [through[0][0], through[0][1]];
        assert!(ends[0][0].abs() < 1e-12 && (ends[1][0] - 1.0).abs() < 1e-12, "{ends:?}");
        let out_and_in = clip(&[[0.2, 0.5], [0.4, 3.0], [0.6, 0.5], [0.8, 0.5]]);
        assert_eq!(out_and_in.iter().map(Vec::len).collect::<Vec<_>>(), [2, 3]);
        assert!(clip(&[[-1.0, 2.0], [2.0, 2.0]]).is_empty());
    }
}
