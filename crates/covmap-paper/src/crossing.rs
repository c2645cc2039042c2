//! The crossing of the curve of scan counting with the cross of CL in Fig. 6.

/// A run in Fig. 6.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Length of the path \[m\].
    pub path: f64,
    /// The share of cells that are explored well enough.
    pub share: f64,
}

/// The share at which the curves meet, as far as the runs tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Crossing {
    /// The curves meet at this share.
    At(f64),
    /// Every counting run drives more than CL. If the curves meet, then below the smallest share
    /// that counting reached.
    Below(f64),
    /// CL drives more than every counting run. If the curves meet at all, then above the largest
    /// share that counting reached.
    Above(f64),
}

impl Crossing {
    /// Returns the smallest and the largest share at which the curves may meet; curves that never
    /// meet count as meeting at 1.
    pub(crate) fn ends(self) -> [f64; 2] {
        match self {
            Self::At(share) => [share, share],
            Self::Below(share) => [0.0, share],
            Self::Above(share) => [share, 1.0],
        }
    }
}

/// Returns the share of cells that counting explores with the mean path of CL.
///
/// For a larger share CL drives less. The curve is the monotone one nearest to the counting runs
/// (isotonic regression of the share on the path). The result is `None` without runs of both.
pub(crate) fn crossing(counting: &[Point], cl: &[Point]) -> Option<Crossing> {
    let mean = cl.iter().map(|point| point.path).sum::<f64>() / cl.len() as f64;
    let curve = curve(counting);
    let (first, last) = (curve.first()?, curve.last()?);
    if cl.is_empty() {
        None
    } else if mean < first.path {
        Some(Crossing::Below(first.share))
    } else if mean > last.path {
        Some(Crossing::Above(last.share))
    } else {
        let Some(next) = curve.iter().position(|point| point.path > mean) else {
            return Some(Crossing::At(last.share));
        };
        let (a, b) = (curve[next - 1], curve[next]);
        let along = (mean - a.path) / (b.path - a.path);
        Some(Crossing::At(a.share + along * (b.share - a.share)))
    }
}

/// Returns the monotone curve nearest to some runs, by pooling neighbours that fall.
pub(crate) fn curve(points: &[Point]) -> Vec<Point> {
    let mut points: Vec<Point> =
        points.iter().copied().filter(|p| p.path.is_finite() && p.share.is_finite()).collect();
    points.sort_by(|a, b| a.path.total_cmp(&b.path).then(a.share.total_cmp(&b.share)));
    // Pools of neighbours: the sum of their shares, and their number.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for point in &points {
        pools.push((point.share, 1));
        while let [.., (a, m), (b, n)] = pools[..] {
            if a / m as f64 <= b / n as f64 {
                break;
            }
            pools.truncate(pools.len() - 2);
            pools.push((a + b, m + n));
        }
    }
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
        let ends = |path: f64| at(path).ends();
        for (path, share) in [(15.0, 0.4), (30.0, 0.7)] {
            assert!(ends(path).iter().all(|end| (end - share).abs() < 1e-12));
        }
        assert!(ends(5.0)[0] <= 0.0 && ends(50.0)[1] >= 1.0);
        assert_eq!((at(5.0), at(50.0)), (Crossing::Below(0.2), Crossing::Above(0.8)));
        assert_eq!(at(40.0), Crossing::At(0.8));
        assert_eq!(crossing(&counting, &[]), None);
        assert_eq!(crossing(&[], &counting), None);
    }
}
