//! An axis: its values, their places on it, and the labels beside it.

use super::ChartAxis;
use crate::picture::furniture::{round_down, short};

/// Numbers farther from 0 than this are not drawn: their differences overflow.
const LARGEST: f64 = 1e300;
/// Numbers nearer to 0 than this have no place on a logarithmic axis.
const SMALLEST: f64 = 1e-300;
/// The white between the outermost values and the ends of the axis, as a share of it.
const PADDING: f64 = 0.04;
/// The most ticks that are considered.
const MOST: usize = 200;

/// The values that an axis shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    from: f64,
    to: f64,
    logarithmic: bool,
}

/// A tick; a small one has no label.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    /// The share of the way along the axis.
    pub(super) share: f64,
    pub(super) label: String,
}

impl Scale {
    /// Returns the scale of an axis that is to show these values. `padded` leaves some white at
    /// ends that the axis does not fix.
    pub(super) fn new(axis: &ChartAxis, values: impl Iterator<Item = f64>, padded: bool) -> Self {
        let logarithmic = axis.logarithmic;
        let usable = |value: &f64| is_drawable(*value, logarithmic);
        let (low, high) = values
            .filter(usable)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let (fixed_from, fixed_to) = (axis.from.filter(usable), axis.to.filter(usable));
        let (low, high) = match (low <= high, fixed_from, fixed_to) {
            (true, ..) => (low, high),
            (false, Some(value), None) | (false, None, Some(value)) => (value, value),
            (false, ..) if logarithmic => (0.1, 10.0),
            (false, ..) => (0.0, 1.0),
        };
        let (from, to) = (fixed_from.unwrap_or(low), fixed_to.unwrap_or(high));
        let (from, to) = if from <= to { (from, to) } else { (from.min(to), from.max(to)) };
        let mut scale = Self { from, to, logarithmic };
        scale.widen();
        if padded {
            scale.pad(fixed_from.is_none(), fixed_to.is_none());
        }
        scale
    }

    /// Gives an axis on which all values are the same, or nearly so, a length.
    fn widen(&mut self) {
        if self.logarithmic {
            if self.decades() < 1e-6 {
                (self.from, self.to) = (self.from / 1.5, self.to * 1.5);
            }
            return;
        }
        let size = self.from.abs().max(self.to.abs());
        if self.to - self.from <= 1e-9 * size {
            let by = if size > SMALLEST { 0.1 * size } else { 0.5 };
            (self.from, self.to) = (self.from - by, self.to + by);
        } else if self.to - self.from < SMALLEST {
            // Around zero, but with a span whose inverse overflows; or no span at all.
            (self.from, self.to) = (-0.5, 0.5);
        }
    }

    /// Leaves white at the ends, but not beyond zero if no value lies there.
    fn pad(&mut self, low: bool, high: bool) {
        let (from, to) = (self.from, self.to);
        if self.logarithmic {
            let ratio = libm::pow(10.0, PADDING * self.decades());
            self.from = if low { (from / ratio).max(SMALLEST) } else { from };
            self.to = if high { (to * ratio).min(LARGEST) } else { to };
            return;
        }
        let by = PADDING * (to - from);
        if low {
            self.from = if from >= 0.0 { (from - by).max(0.0) } else { from - by };
        }
        if high {
            self.to = if to <= 0.0 { (to + by).min(0.0) } else { to + by };
        }
    }

    /// Returns the share of the way along the axis at which a value lies, outside \[0, 1\] for a
    /// value beyond the axis; `None` for a value that can have no place.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        is_drawable(value, self.logarithmic).then(|| {
            let share = if self.logarithmic {
                (libm::log10(value) - libm::log10(self.from)) / self.decades()
            } else {
                (value - self.from) / (self.to - self.from)
            };
            // Far enough not to be seen, near enough to compute with.
            if share.is_nan() { 0.0 } else { share.clamp(-1e6, 1e6) }
        })
    }

    /// Returns the share at which the edge of a cell is drawn, in \[0, 1\]; a logarithmic axis has
    /// zero at its beginning.
    pub(super) fn edge(&self, value: f64) -> Option<f64> {
        let share = self.share(value);
        let below = self.logarithmic && value < SMALLEST;
        share.or(below.then_some(0.0)).map(|share| share.clamp(0.0, 1.0))
    }

    /// Returns the value at a share of the way along the axis.
    #[cfg(test)]
    fn value(&self, share: f64) -> f64 {
        self.from + share * (self.to - self.from)
    }

    /// Returns round values on an axis of a length: as many as fit side by side if a label takes
    /// `room` of the length.
    pub(super) fn ticks(&self, length: f32, room: impl Fn(&str) -> f32) -> Vec<Tick> {
        if self.logarithmic && self.decades() >= 0.7 {
            self.decade_ticks(f64::from(length), room)
        } else {
            self.step_ticks(f64::from(length), room)
        }
    }

    fn decades(&self) -> f64 {
        libm::log10(self.to) - libm::log10(self.from)
    }

    /// Returns the multiples of a round step.
    fn step_ticks(&self, length: f64, room: impl Fn(&str) -> f32) -> Vec<Tick> {
        let span = self.to - self.from;
        let mut step = round_down(span / 5.0);
        loop {
            let ticks: Vec<Tick> = self.multiples(step).collect();
            if ticks.len() < 2 || fits(&ticks, length, &room) {
                return ticks;
            }
            step = round_down(step * 2.6);
        }
    }

    fn multiples(&self, step: f64) -> impl Iterator<Item = Tick> {
        let first = libm::ceil(self.from / step - 1e-6);
        let size = self.from.abs().max(self.to.abs());
        (0..MOST).map(move |i| (first + i as f64) * step).map_while(move |value| {
            let share = self.share(value)?;
            let label = number(value, step, size);
            (share <= 1.0 + 1e-6).then(|| Tick { share: share.clamp(0.0, 1.0), label })
        })
    }

    /// Returns powers of ten and round numbers between them.
    fn decade_ticks(&self, length: f64, room: impl Fn(&str) -> f32) -> Vec<Tick> {
        let dense: [&[i32]; 4] = [&[1, 2, 3, 4, 5, 6, 7, 8, 9], &[1, 2, 5], &[1, 3], &[1]];
        let dense = dense.into_iter().map(|digits| (digits, 1));
        let sparse = [2, 3, 5, 10, 20, 50, 100, 200].map(|stride| (&[1][..], stride));
        for (digits, stride) in dense.chain(sparse) {
            let mut ticks = self.powers(digits, stride);
            if !fits(&ticks, length, &room) {
                continue;
            }
            let per_decade = length / self.decades();
            let small = if stride > 1 { &[1][..] } else { &[2, 3, 4, 5, 6, 7, 8, 9] };
            if digits.len() < 9 && per_decade > if stride > 1 { 6.0 } else { 40.0 } {
                let unlabelled = |tick: Tick| Tick { label: String::new(), ..tick };
                ticks.extend(self.powers(small, 1).into_iter().map(unlabelled));
            }
            return ticks;
        }
        Vec::new()
    }

    fn powers(&self, digits: &[i32], stride: usize) -> Vec<Tick> {
        #[allow(clippy::cast_possible_truncation, reason = "the exponent of an f64")]
        let (first, last) =
            (libm::floor(libm::log10(self.from)) as i32, libm::ceil(libm::log10(self.to)) as i32);
        #[allow(clippy::cast_possible_truncation, reason = "≤ 200")]
        let stride = stride as i32;
        (first..=last)
            .filter(|exponent| exponent % stride == 0)
            .flat_map(|exponent| digits.iter().map(move |digit| (*digit, exponent)))
            .filter_map(|(digit, exponent)| {
                let power = libm::pow(10.0, f64::from(exponent));
                let share = self.share(f64::from(digit) * power)?;
                let label = match exponent {
                    -4..=5 => short(f64::from(digit) * power, power.min(1.0)),
                    _ => format!("{digit}e{}", with_minus(&exponent.to_string())),
                };
                (-1e-9..=1.0 + 1e-9).contains(&share).then_some(Tick { share, label })
            })
            .take(MOST * 9)
            .collect()
    }
}

/// Returns whether a value can lie on an axis at all.
fn is_drawable(value: f64, logarithmic: bool) -> bool {
    value.abs() <= LARGEST && (!logarithmic || value >= SMALLEST)
}

/// Returns whether the labels stand side by side with room around each.
fn fits(ticks: &[Tick], length: f64, room: impl Fn(&str) -> f32) -> bool {
    ticks.windows(2).all(|pair| {
        let needed = room(&pair[0].label).midpoint(room(&pair[1].label));
        (pair[1].share - pair[0].share) * length >= f64::from(needed)
    })
}

fn with_minus(number: &str) -> String {
    number.replace('-', "−")
}

/// Formats a number with the digits that its steps need, among numbers up to a size.
fn number(value: f64, step: f64, size: f64) -> String {
    if (1e-4..1e7).contains(&size) && step > 1e-9 {
        return short(value, step);
    }
    if value.abs() < step / 2.0 {
        return "0".to_string();
    }
    let digits =
        libm::floor(libm::log10(value.abs()) + 1e-9) - libm::floor(libm::log10(step) + 1e-9);
    #[allow(clippy::cast_possible_truncation, reason = "0 to 12")]
    let digits = digits.clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = match digits.split_once('.') {
        Some(_) => digits.trim_end_matches('0').trim_end_matches('.'),
        None => digits,
    };
    with_minus(&format!("{digits}e{exponent}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn axis(from: Option<f64>, to: Option<f64>, logarithmic: bool) -> ChartAxis {
        ChartAxis { from, to, logarithmic, ..ChartAxis::default() }
    }

    fn labels(from: f64, to: f64, logarithmic: bool) -> Vec<String> {
        let scale = Scale::new(&axis(Some(from), Some(to), logarithmic), [].into_iter(), true);
        let ticks = scale.ticks(400.0, |label| 20.0 + 7.0 * label.len() as f32);
        ticks.into_iter().map(|tick| tick.label).filter(|label| !label.is_empty()).collect()
    }

    #[test]
    fn ticks_are_round_and_have_room() {
        assert_eq!(labels(0.0, 1.0, false), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-3.0, 12.0, false), ["−2", "0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(labels(0.0, 2e8, false), ["0", "5e7", "1e8", "1.5e8", "2e8"]);
        assert_eq!(labels(0.0, 4e-9, false), ["0", "1e−9", "2e−9", "3e−9", "4e−9"]);
        assert_eq!(labels(1e6, 1e6 + 1.0, false), ["1000000.0", "1000000.5", "1000001.0"]);
        assert_eq!(labels(1.0, 1.0 + 2e-7, false)[1], "1.00000005");
        assert_eq!(labels(1e-200, 1e200, true)[0], "1e−200");
        assert_eq!(labels(0.001, 10.0, true), ["0.001", "0.01", "0.1", "1", "10"]);
        assert_eq!(labels(1.0, 20.0, true), ["1", "2", "5", "10", "20"]);
        assert_eq!(labels(1e-9, 1e9, true), ["1e−9", "1e−6", "0.001", "1", "1000", "1e6", "1e9"]);
        assert_eq!(labels(2.0, 4.0, true), ["2.0", "2.5", "3.0", "3.5", "4.0"]);
    }

    #[test]
    fn an_axis_without_a_length_is_given_one() {
        for value in [0.0, 3.0, -7e9, 1e300, 1e-310, f64::NAN] {
            let scale = Scale::new(&axis(None, None, false), [value; 3].into_iter(), true);
            assert!(scale.from < scale.to && scale.value(0.5).is_finite(), "{value}: {scale:?}");
        }
    }

    #[test]
    fn white_at_the_ends_does_not_reach_beyond_zero() {
        let scale = Scale::new(&axis(None, None, false), [0.0, 10.0].into_iter(), true);
        assert!(scale.from == 0.0 && scale.to > 10.0);
        let fixed = Scale::new(&axis(Some(-1.0), None, false), [0.0, 10.0].into_iter(), true);
        assert!((fixed.from + 1.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn every_value_shown_lies_on_the_axis(
            values in proptest::collection::vec(proptest::num::f64::ANY, 0..6),
            from in proptest::option::of(proptest::num::f64::ANY),
            logarithmic: bool,
        ) {
            let free = Scale::new(&axis(None, None, logarithmic), values.iter().copied(), true);
            for value in &values {
                if let Some(share) = free.share(*value) {
                    prop_assert!((-1e-6..=1.0 + 1e-6).contains(&share), "{share} {free:?}");
                }
            }
            let fixed = Scale::new(&axis(from, None, logarithmic), values.iter().copied(), false);
            for scale in [free, fixed] {
                let ticks = scale.ticks(300.0, |label| 7.0 * label.len() as f32);
                prop_assert!(ticks.iter().all(|tick| (-1e-6..=1.0 + 1e-6).contains(&tick.share)));
            }
        }
    }
}
