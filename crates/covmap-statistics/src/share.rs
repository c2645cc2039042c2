//! Shares of successes.

use crate::Estimate;

/// Returns the share of successes among independent trials as an estimate, after Agresti and Coull.
/// Two successes and two failures are added, so "always" is not certain. `None` without trials, and
/// for more successes than trials.
///
/// # Formula
/// ```text
/// value p̃ = (successes + 2) / (trials + 4)    standard error = √(p̃ (1 − p̃) / (trials + 4))
/// ```
pub fn share_estimate(successes: usize, trials: usize) -> Option<Estimate> {
    let (k, n) = (successes as f64, trials as f64);
    let p = (k + 2.0) / (n + 4.0);
    let standard_error = (p * (1.0 - p) / (n + 4.0)).sqrt();
    (trials > 0 && successes <= trials).then_some(Estimate {
        value: p,
        standard_error,
        groups: trials,
    })
}

#[cfg(test)]
mod tests {
    use super::share_estimate;

    #[test]
    fn the_interval_of_a_share_is_that_of_agresti_and_coull() {
        // 50 of 100: p̃ = 52/104, standard error .04903.
        let half = share_estimate(50, 100).unwrap();
        assert!((half.value - 0.5).abs() < 1e-12 && (half.standard_error - 0.049_029).abs() < 1e-6);
    }

    #[test]
    fn always_is_not_certain() {
        let always = share_estimate(100, 100).unwrap();
        assert!(always.p_above(0.9) < 0.01 && always.interval(0.95).unwrap().0 < 0.99);
        let few = share_estimate(5, 5).unwrap();
        assert!(few.p_above(0.9) > 0.05);
        assert_eq!(share_estimate(0, 0), None);
    }
}
