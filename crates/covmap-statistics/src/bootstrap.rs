//! Resampling starts: runs from the same start are not independent.

use crate::{Estimate, resample, stream, uniform};

/// Observations in groups; the groups are independent of each other, their members need not be.
pub type Grouped<T> = Vec<Vec<T>>;

/// The largest number of resamples that are drawn.
const MOST: usize = 1_000_000;
/// The smallest number of resamples with a value from which the error is estimated.
const FEWEST: usize = 20;

/// Returns the statistic of all observations with its standard error; `None` if the statistic has
/// no value for them. Whole groups are drawn with replacement, `times` times, at most a million.
///
/// The spread of a mean over k groups that are drawn so is too small by the factor √((k − 1)/k),
/// which is corrected. Resamples for which the statistic has no value are left out. The same seed
/// gives the same numbers.
pub fn bootstrap<T>(
    groups: &[Vec<T>],
    times: usize,
    seed: u64,
    statistic: impl Fn(&[&T]) -> Option<f64>,
) -> Option<Estimate> {
    let groups: Vec<&Vec<T>> = groups.iter().filter(|group| !group.is_empty()).collect();
    let all: Vec<&T> = groups.iter().flat_map(|group| group.iter()).collect();
    let value = statistic(&all).filter(|value| value.is_finite())?;
    let certain = Estimate { value, standard_error: f64::INFINITY, groups: groups.len() };
    if groups.len() < 2 {
        return Some(certain);
    }
    let mut random = stream(seed, "bootstrap", 0);
    let times = times.min(MOST);
    let mut resampled = Vec::with_capacity(times);
    for _ in 0..times {
        let drawn = resample(groups.len(), || uniform(&mut random));
        let drawn: Vec<&T> = drawn.into_iter().flat_map(|group| groups[group]).collect();
        resampled.extend(statistic(&drawn).filter(|value| value.is_finite()));
    }
    if resampled.len() < FEWEST.min(times).max(1) {
        return Some(certain);
    }
    let (n, k) = (resampled.len() as f64, groups.len() as f64);
    let mean = resampled.iter().sum::<f64>() / n;
    let variance = resampled.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
    let standard_error = (variance * k / (k - 1.0)).sqrt();
    Some(Estimate { standard_error, ..certain })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(values: &[&f64]) -> Option<f64> {
        let n = values.len() as f64;
        (!values.is_empty()).then(|| values.iter().copied().sum::<f64>() / n)
    }

    #[test]
    fn the_error_of_a_mean_of_independent_values_is_the_usual_one() {
        let values: Vec<f64> = (0..12).map(|i| f64::from(i * i % 7)).collect();
        let groups: Grouped<f64> = values.iter().map(|v| vec![*v]).collect();
        let resampled = bootstrap(&groups, 20_000, 1, mean).unwrap();
        let usual = Estimate::of_mean(&values).unwrap();
        assert!((resampled.value - usual.value).abs() < 1e-12);
        let ratio = resampled.standard_error / usual.standard_error;
        assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    }

    #[test]
    fn members_of_a_group_that_are_alike_count_once() {
        let groups = |members: usize| -> Grouped<f64> {
            [1.0, 2.0, 4.0, 7.0].iter().map(|v| vec![*v; members]).collect()
        };
        let (one, many) = (groups(1), groups(50));
        assert_eq!(bootstrap(&one, 2000, 3, mean), bootstrap(&many, 2000, 3, mean));
    }

    #[test]
    fn the_same_seed_gives_the_same_numbers() {
        let groups: Grouped<f64> = vec![vec![1.0, 3.0], vec![2.0], vec![9.0, 4.0]];
        assert_eq!(bootstrap(&groups, 500, 7, mean), bootstrap(&groups, 500, 7, mean));
        assert_ne!(bootstrap(&groups, 500, 7, mean), bootstrap(&groups, 500, 8, mean));
    }

    #[test]
    fn more_resamples_than_can_be_drawn_are_a_million() {
        // Each costs nothing: the statistic gives up.
        let groups: Grouped<f64> = vec![vec![1.0], vec![2.0]];
        let first = std::cell::Cell::new(true);
        let once = |_: &[&f64]| first.replace(false).then_some(1.0);
        let estimate = bootstrap(&groups, usize::MAX, 1, once).unwrap();
        assert!(estimate.standard_error.is_infinite());
        let none = bootstrap(&groups, 0, 1, mean).unwrap();
        assert!(none.standard_error.is_infinite());
    }

    #[test]
    fn a_single_group_has_no_error_and_none_has_no_value() {
        let single = bootstrap(&[vec![1.0, 5.0]], 100, 1, mean).unwrap();
        assert!((single.value - 3.0).abs() < 1e-12 && single.interval(0.95).is_none());
        assert_eq!(bootstrap(&[], 100, 1, mean), None);
        assert_eq!(bootstrap(&[vec![]], 100, 1, mean), None);
    }
}
