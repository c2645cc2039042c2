//! Where the curve of scan counting meets the cross of CL in Fig. 6.

/// A run in Fig. 6.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Length of the path \[m\].
    pub(crate) path: f64,
    /// The share of cells that are explored well enough.
    pub(crate) share: f64,
}

/// The share of cells that counting explores with the mean path of CL; whoever needs a larger
/// share drives less with CL. `None` without runs of both.
///
/// The curve is the monotone one that is nearest to the counting runs (isotonic regression of
/// the share on the path). It is 0 if every counting run is longer than CL's, and 1 if none is:
/// then CL is shorter nowhere.
pub(crate) fn crossing(counting: &[Point], cl: &[Point]) -> Option<f64> {
    #[allow(clippy::cast_precision_loss, reason = "a series of runs")]
    let mean = cl.iter().map(|point| point.path).sum::<f64>() / cl.len() as f64;
    let curve = curve(counting);
    let (first, last) = (curve.first()?, curve.last()?);
    if cl.is_empty() {
        None
    } else if mean < first.path {
        Some(0.0)
    } else if mean >= last.path {
        Some(1.0)
    } else {
        let next = curve.iter().position(|point| point.path > mean)?;
        let (a, b) = (curve[next - 1], curve[next]);
        let along = (mean - a.path) / (b.path - a.path);
        Some(a.share + along * (b.share - a.share))
    }
}

/// The monotone curve that is nearest to some runs, by pooling neighbours that fall.
pub(crate) fn curve(points: &[Point]) -> Vec<Point> {
    let mut points: Vec<Point> =
        points.iter().copied().filter(|p| p.path.is_finite() && p.share.is_finite()).collect();
    points.sort_by(|a, b| a.path.total_cmp(&b.path).then(a.share.total_cmp(&b.share)));
    // Pools of neighbours: the sum of their shares, and how many they are.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for point in &points {
        pools.push((point.share, 1));
        while let [.., (a, m), (b, n)] = pools[..] {
            #[allow(clippy::cast_precision_loss, reason = "a series of runs")]
            if a / m as f64 <= b / n as f64 {
                break;
            }
            pools.truncate(pools.len() - 2);
            pools.push((a + b, m + n));
        }
    }
    #[allow(clippy::cast_precision_loss, reason = "a series of runs")]
    let shares = pools.iter().flat_map(|(sum, n)| std::iter::repeat_n(sum / *n as f64, *n));
    points.iter().zip(shares).map(|(point, share)| Point { share, ..*point }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<Point> {
        list.iter().map(|(path, share)| Point { path: *path, share: *share }).collect()
    }

    #[test]
    fn neighbours_that_fall_are_pooled() {
        let curve = curve(&points(&[(3.0, 0.4), (1.0, 0.2), (2.0, 0.6)]));
        let expected = points(&[(1.0, 0.2), (2.0, 0.5), (3.0, 0.5)]);
        assert!(curve.iter().zip(&expected).all(|(a, b)| (a.share - b.share).abs() < 1e-12));
    }

    #[test]
    fn the_curves_meet_where_the_paths_are_equal() {
        let counting = points(&[(10.0, 0.2), (20.0, 0.6), (40.0, 0.8)]);
        let at = |path: f64| crossing(&counting, &points(&[(path, 0.99)])).unwrap();
        assert!((at(15.0) - 0.4).abs() < 1e-12 && (at(30.0) - 0.7).abs() < 1e-12);
        assert!(at(5.0) <= 0.0 && at(50.0) >= 1.0);
        assert_eq!(crossing(&counting, &[]), None);
        assert_eq!(crossing(&[], &counting), None);
    }
}
