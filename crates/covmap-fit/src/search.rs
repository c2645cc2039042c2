//! Local search over the unit cube.

use std::ops::ControlFlow;

/// Steps and end of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// The first step along every axis, as a share of its interval.
    pub first_step: f64,
    /// The search ends when the steps along all axes are below this.
    pub last_step: f64,
    /// The largest number of evaluations.
    pub evaluations: usize,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self { first_step: 0.2, last_step: 0.01, evaluations: 400 }
    }
}

/// One evaluation of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Its place in the unit cube.
    pub place: Vec<f64>,
    /// The value there; `None` if the place is not allowed.
    pub value: Option<f64>,
}

/// Returns the higher of two results; the first, if they are equal.
pub(crate) fn higher(
    best: Option<(Vec<f64>, f64)>,
    found: Option<(Vec<f64>, f64)>,
) -> Option<(Vec<f64>, f64)> {
    match (best, found) {
        (Some(best), Some(found)) => Some(if found.1 > best.1 { found } else { best }),
        (best, found) => best.or(found),
    }
}

/// The largest number of places that are drawn at random, since one may not be allowed.
const DRAWS: usize = 1000;

/// Returns a place in the unit cube that is allowed, drawn at random; `given` if none is found.
pub(crate) fn random_start(
    given: &[f64],
    uniform: &mut impl FnMut() -> f64,
    is_allowed: impl Fn(&[f64]) -> bool,
) -> Vec<f64> {
    let mut draw = || given.iter().map(|_| uniform()).collect::<Vec<f64>>();
    let drawn = (0..DRAWS).map(|_| draw()).find(|place| is_allowed(place));
    drawn.unwrap_or_else(|| given.to_vec())
}

/// Climbs to a local maximum of `value` over the unit cube, from `start`. Returns the best
/// place and its value, or `None` if not even the start is allowed.
///
/// # Algorithm
/// Pattern search with a step for each axis (Hooke and Jeeves, 1961). Axis by axis the search tries
/// a step to one side, then to the other. It takes a step that improves, and the next one along
/// this axis is half as long again; if neither side improves, it is half as long. After all axes
/// the search repeats the way of the whole round, as long as that improves: parameters that can
/// stand in for each other make narrow ridges, along no axis. The method needs no gradient, and
/// keeps to bounds and to constraints that are only known by asking. It also tolerates parameters
/// such as the distance behind, which act in steps, cell by cell. For these reasons it is used
/// instead of a simplex or a quasi-Newton method.
///
/// Every evaluation is reported to `report`, which may end the search.
pub fn maximise(
    start: &[f64],
    settings: &SearchSettings,
    mut value: impl FnMut(&[f64]) -> Option<f64>,
    mut report: impl FnMut(Step) -> ControlFlow<()>,
) -> Option<(Vec<f64>, f64)> {
    let mut left = settings.evaluations;
    let mut evaluate = |place: &[f64], left: &mut usize| {
        *left = left.saturating_sub(1);
        let value = value(place).filter(|v| v.is_finite());
        if report(Step { place: place.to_vec(), value }).is_break() {
            *left = 0;
        }
        value
    };
    let mut best = start.to_vec();
    let mut highest = evaluate(&best, &mut left)?;
    // Signed: the side that is tried first is the one that improved last.
    let mut steps = vec![settings.first_step; start.len()];
    while steps.iter().any(|step| step.abs() >= settings.last_step) && left > 0 {
        let before = best.clone();
        for axis in 0..steps.len() {
            if steps[axis].abs() < settings.last_step {
                continue;
            }
            let sides = [steps[axis], -steps[axis]];
            let improved = sides.into_iter().find_map(|step| {
                let mut place = best.clone();
                place[axis] = (place[axis] + step).clamp(0.0, 1.0);
                let moved = (place[axis] - best[axis]).abs() > 1e-12;
                let value = (moved && left > 0).then(|| evaluate(&place, &mut left)).flatten()?;
                (value > highest).then_some((step, place, value))
            });
            steps[axis] = match improved {
                Some((step, place, value)) => {
                    (best, highest) = (place, value);
                    (1.5 * step).clamp(-0.5, 0.5)
                }
                None => 0.5 * steps[axis],
            };
        }
        let round: Vec<f64> = best.iter().zip(&before).map(|(to, from)| to - from).collect();
        while left > 0 && round.iter().any(|way| way.abs() > 1e-12) {
            let place: Vec<f64> =
                best.iter().zip(&round).map(|(at, way)| (at + way).clamp(0.0, 1.0)).collect();
            match evaluate(&place, &mut left).filter(|value| *value > highest) {
                Some(value) => (best, highest) = (place, value),
                None => break,
            }
        }
    }
    Some((best, highest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn go_on(_: Step) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    proptest! {
        #[test]
        fn the_top_of_a_hill_is_found(a in 0.0..1.0f64, b in 0.0..1.0f64, start in 0.0..1.0f64) {
            let hill = |p: &[f64]| {
                let (x, y) = (p[0] - a, p[1] - b);
                Some(-(x * x + 3.0 * y * y + x * y))
            };
            let settings = SearchSettings { last_step: 1e-4, ..SearchSettings::default() };
            let (place, _) = maximise(&[start, 0.5], &settings, hill, go_on).unwrap();
            prop_assert!((place[0] - a).abs() < 2e-3 && (place[1] - b).abs() < 2e-3);
        }

        #[test]
        fn it_never_goes_where_it_may_not(edge in 0.3..0.9f64) {
            let value = |p: &[f64]| (p[0] <= edge).then_some(p[0]);
            let settings = SearchSettings { last_step: 1e-4, ..SearchSettings::default() };
            let (place, _) = maximise(&[0.1], &settings, value, go_on).unwrap();
            prop_assert!(place[0] <= edge && place[0] > edge - 1e-3);
        }
    }

    #[test]
    fn the_budget_is_kept_and_a_forbidden_start_is_said() {
        let mut asked = 0;
        let settings = SearchSettings { evaluations: 7, ..SearchSettings::default() };
        let count = |_| {
            asked += 1;
            ControlFlow::Continue(())
        };
        maximise(&[0.5; 5], &settings, |p| Some(p[0]), count);
        assert_eq!(asked, 7);
        assert_eq!(maximise(&[0.5], &settings, |_| None, go_on), None);
    }
}
