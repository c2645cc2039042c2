//! Drawing groups with replacement.

/// Draws as many groups as there are, with replacement, and returns their numbers in the order of the draws.
///
/// `uniform` draws uniform numbers in \[0, 1).
pub fn resample(groups: usize, mut uniform: impl FnMut() -> f64) -> Vec<usize> {
    let mut draw = || {
        let place = uniform() * groups as f64;
        #[allow(clippy::cast_possible_truncation, reason = "few groups")]
        let group = place as usize;
        group.min(groups - 1)
    };
    (0..groups).map(|_| draw()).collect()
}

/// Returns the central 95 % interval of the values of resamples; `None` if no resample has a value.
pub fn central_interval(values: impl Iterator<Item = Option<f64>>) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = values.flatten().filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let outside = values.len() / 40;
    let last = values.len().checked_sub(1)?;
    Some((values[outside], values[last - outside]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_drawn_by_uniform_numbers() {
        let mut numbers = [0.0, 0.34, 0.999].into_iter();
        assert_eq!(resample(3, || numbers.next().unwrap_or(0.0)), [0, 1, 2]);
        assert!(resample(0, || 0.5).is_empty());
    }

    #[test]
    fn the_central_interval_leaves_out_a_fortieth_at_each_end() {
        let values = (0..80).map(|i| Some(f64::from(79 - i)));
        let with_gaps = values.chain([None, Some(f64::NAN)]);
        assert_eq!(central_interval(with_gaps), Some((2.0, 77.0)));
        assert_eq!(central_interval(std::iter::once(None)), None);
    }
}
