//! Many tests at once.

/// Returns the p-values of a family of tests, adjusted by Holm's step-down procedure, in the same
/// order. Rejecting all hypotheses below .05 rejects a true one in at most one of twenty families.
///
/// # Formula
/// ```text
/// p₍₁₎ ≤ … ≤ p₍m₎    adjusted₍ᵢ₎ = max over j ≤ i of min(1, (m − j + 1) · p₍ⱼ₎)
/// ```
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|a, b| p_values[*a].total_cmp(&p_values[*b]));
    let mut adjusted = vec![1.0; p_values.len()];
    let mut largest = 0.0f64;
    for (rank, index) in order.into_iter().enumerate() {
        let left = (p_values.len() - rank) as f64;
        largest = largest.max((left * p_values[index]).min(1.0));
        adjusted[index] = largest;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::holm;

    #[track_caller]
    fn check(given: &[f64], expected: &[f64]) {
        let adjusted = holm(given);
        let near = adjusted.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near && adjusted.len() == expected.len(), "{adjusted:?}");
    }

    #[test]
    fn the_smallest_pays_for_all_the_next_for_one_less() {
        check(&[0.01, 0.04, 0.03, 0.005], &[0.03, 0.06, 0.06, 0.02]);
    }

    #[test]
    fn nothing_exceeds_one_and_one_test_stays_as_it_is() {
        check(&[0.6, 0.9], &[1.0, 1.0]);
        check(&[0.04], &[0.04]);
        check(&[], &[]);
    }
}
