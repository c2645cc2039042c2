//! A few of many vectors, whose sums are nearly all others.

/// Some of many vectors, and their weights in all.
pub(crate) struct SpanningSet {
    /// The places of the chosen vectors.
    pub(crate) members: Vec<usize>,
    /// For each vector the weight of every member.
    pub(crate) weights: Vec<Vec<f64>>,
}

impl SpanningSet {
    /// Chooses as few vectors as leave no number of any vector farther off than the tolerance. Each
    /// step adds the vector that is farthest from the span of those before it.
    pub(crate) fn of(vectors: &[Vec<f64>], tolerance: f64) -> Self {
        let mut rest = vectors.to_vec();
        let mut parts = vec![Vec::new(); vectors.len()];
        let mut members: Vec<usize> = Vec::new();
        loop {
            let far = |rest: &Vec<f64>| rest.iter().fold(0.0, |far: f64, x| far.max(x.abs()));
            let farthest = rest.iter().map(far).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((member, _)) = farthest.filter(|(_, far)| *far > tolerance) else { break };
            members.push(member);
            let length = dot(&rest[member], &rest[member]).sqrt();
            let direction: Vec<f64> = rest[member].iter().map(|x| x / length).collect();
            for (rest, parts) in rest.iter_mut().zip(&mut parts) {
                let part = dot(rest, &direction);
                rest.iter_mut().zip(&direction).for_each(|(x, d)| *x -= part * d);
                parts.push(part);
            }
        }
        let of_members: Vec<&Vec<f64>> = members.iter().map(|member| &parts[*member]).collect();
        let weights = parts.iter().map(|parts| weights(&of_members, parts)).collect();
        Self { members, weights }
    }
}

/// Returns the weight of every member in a vector, by their parts along the directions that the
/// members brought in one after the other: a member has no part along later ones.
fn weights(members: &[&Vec<f64>], wanted: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; members.len()];
    for direction in (0..members.len()).rev() {
        let later = direction + 1..members.len();
        let taken: f64 = later.map(|n| weights[n] * members[n][direction]).sum();
        weights[direction] = (wanted[direction] - taken) / members[direction][direction];
    }
    weights
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a polynomial.
    fn samples(coefficients: &[f64]) -> Vec<f64> {
        let at = |x: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
        (0..20).map(|i| at(0.1 * f64::from(i))).collect()
    }

    #[test]
    fn three_of_many_parabolas_span_all() {
        let vectors: Vec<Vec<f64>> = (0..30)
            .map(|i| samples(&[f64::from(i), f64::from(i % 7) - 3.0, f64::from(i % 5)]))
            .collect();
        let SpanningSet { members, weights } = SpanningSet::of(&vectors, 1e-9);
        assert_eq!(members.len(), 3);
        for (vector, weights) in vectors.iter().zip(&weights) {
            for (i, x) in vector.iter().enumerate() {
                let sum: f64 = members.iter().zip(weights).map(|(m, w)| w * vectors[*m][i]).sum();
                assert!((sum - x).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn what_is_within_the_tolerance_needs_no_member() {
        let small = SpanningSet::of(&[vec![0.1, -0.2], vec![0.0, 0.2]], 0.3);
        assert!(small.members.is_empty() && small.weights == [vec![], vec![]]);
    }
}
