//! Agreement of two rankings.

use std::cmp::Ordering;

/// Returns Kendall's τ_b of two equally long lists: 1 if they rank alike, −1 if the other way
/// round; `None` if a list has no order (fewer than two different values).
///
/// # Formula
/// ```text
/// τ_b = (concordant − discordant) / √((pairs − tied in a) · (pairs − tied in b))
/// ```
pub fn kendall_tau(a: &[f64], b: &[f64]) -> Option<f64> {
    let (mut agreement, mut ordered_a, mut ordered_b) = (0i64, 0i64, 0i64);
    let n = a.len().min(b.len());
    for i in 0..n {
        for j in 0..i {
            let sign = |list: &[f64]| match list[i].total_cmp(&list[j]) {
                Ordering::Less => -1,
                Ordering::Equal => 0,
                Ordering::Greater => 1,
            };
            let (sa, sb) = (sign(a), sign(b));
            agreement += sa * sb;
            ordered_a += sa * sa;
            ordered_b += sb * sb;
        }
    }
    let [agreement, a, b] = [agreement, ordered_a, ordered_b].map(|pairs| pairs as f64);
    let scale = (a * b).sqrt();
    (scale > 0.0).then(|| agreement / scale)
}

#[cfg(test)]
mod tests {
    use super::kendall_tau;

    #[test]
    fn rankings_that_agree_have_one_and_reversed_ones_minus_one() {
        assert_eq!(kendall_tau(&[1.0, 2.0, 3.0], &[10.0, 20.0, 30.0]), Some(1.0));
        assert_eq!(kendall_tau(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), Some(-1.0));
    }

    #[test]
    fn one_exchanged_pair_of_four_costs_a_third() {
        let tau = kendall_tau(&[1.0, 2.0, 3.0, 4.0], &[1.0, 3.0, 2.0, 4.0]).unwrap();
        assert!((tau - 2.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn ties_are_taken_out_of_the_scale() {
        // Five ordered pairs of six in the first, all six in the second; five agree.
        let tau = kendall_tau(&[1.0, 1.0, 2.0, 3.0], &[1.0, 2.0, 3.0, 4.0]).unwrap();
        assert!((tau - 5.0 / 30f64.sqrt()).abs() < 1e-12);
        assert_eq!(kendall_tau(&[1.0, 1.0], &[1.0, 2.0]), None);
        assert_eq!(kendall_tau(&[], &[]), None);
    }
}
