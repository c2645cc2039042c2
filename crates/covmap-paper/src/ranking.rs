//! The agreement of the order of strategies in single units with a ranking.

use crate::runs::Units;
use covmap_statistics::{Estimate, kendall_tau};

/// Returns the mean over units of Kendall's τ between a ranking and the numbers of the unit, with
/// its error by resampling starts. A unit without any order has a τ of 0.
///
/// τ changes in steps, one for each pair of strategies that changes places. A number rounded to
/// steps has a standard deviation of at least step/√12. A unit has at least this deviation, too;
/// otherwise units that are all alike would be certain.
pub(crate) fn mean_tau(ranking: &[f64], units: &Units) -> Option<Estimate> {
    let taus = units.each(|numbers| kendall_tau(ranking, numbers).unwrap_or(0.0));
    let mean = taus.mean(0)?;
    let (n, groups) = (ranking.len() as f64, mean.groups as f64);
    let step = 4.0 / (n * (n - 1.0));
    let least = step / 12f64.sqrt() / groups.sqrt();
    let standard_error = mean.standard_error.max(least);
    (n > 1.0).then_some(Estimate { standard_error, ..mean })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_counts_alike_however_large_its_numbers_are() {
        // The mean of the numbers follows the order of the ranking; three starts of four do not.
        let unit = |numbers: [f64; 3]| vec![numbers.to_vec()];
        let large = unit([100.0, 200.0, 300.0]);
        let small = || unit([3.0, 2.0, 1.0]);
        let units = Units(vec![large, small(), small(), small()]);
        let tau = mean_tau(&[1.0, 2.0, 3.0], &units).unwrap();
        assert!((tau.value + 0.5).abs() < 1e-12, "{tau:?}");
    }

    #[test]
    fn units_that_are_all_alike_are_sure_to_half_a_step_only() {
        let units = Units(vec![vec![vec![1.0, 2.0, 3.0]]; 4]);
        let tau = mean_tau(&[1.0, 2.0, 3.0], &units).unwrap();
        assert!((tau.value - 1.0).abs() < 1e-12);
        assert!((tau.standard_error - 2.0 / 3.0 / 12f64.sqrt() / 2.0).abs() < 1e-12);
        assert!(mean_tau(&[1.0], &Units(vec![vec![vec![1.0]]])).is_none());
        assert!(mean_tau(&[1.0, 2.0], &Units::default()).is_none());
    }
}
