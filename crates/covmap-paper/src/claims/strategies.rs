//! Section 5.2, Fig. 7: scans and paths of the strategies. Claims 10–14 and 19.

use super::explored;
use crate::runs::{Runs, mean};
use crate::techniques::{PATH, SCANS};
use crate::trial::{Bound, Finding, LEVEL, Trial};
use covmap_plan::Strategy;
use covmap_statistics::Estimate;

const IG_CL_1: Strategy = Strategy::IgCl { alpha: 1.0 };

/// Returns the strategies of Fig. 7 except one, each with the ratio of its mean to that of the one.
fn against(runs: &Runs, metric: &str, one: Strategy) -> Vec<(Strategy, Option<Estimate>)> {
    let others = runs.strategies().into_iter().filter(|s| *s != one && s.counting().is_none());
    others.map(|other| (other, runs.paired(&[other, one], metric).ratio(0, 1))).collect()
}

/// Returns a test for each strategy; without strategies, a test without data.
fn trials(
    ratios: Vec<(Strategy, Option<Estimate>)>,
    (what, one): (&str, Strategy),
    bound: Bound,
) -> Vec<Trial> {
    if ratios.is_empty() {
        return vec![Trial::new(format!("{what} of the strategies / {one}"), None, bound)];
    }
    let trial = |(other, ratio)| Trial::new(format!("{what}, {other} / {one}"), ratio, bound);
    ratios.into_iter().map(trial).collect()
}

fn with_condition(runs: &Runs, trials: Vec<Trial>) -> Vec<Trial> {
    with_condition_on(runs, &runs.strategies(), trials)
}

/// Adds to tests that compare strategies the condition that these explored their world.
fn with_condition_on(runs: &Runs, compared: &[Strategy], mut trials: Vec<Trial>) -> Vec<Trial> {
    trials.insert(0, explored(runs, compared));
    trials
}

/// What counts as fewer scans: a smaller difference could not be read off Fig. 7.
const MARGIN: f64 = 0.1;
/// IG_CL(1.0) is as good as IG if it is no farther from it than this share of the way from IG to CL.
const SPAN_SHARE: f64 = 0.2;

/// Tests claim 10 (Fig. 7 (a)): IG needs the fewest measurements. Other strategies may need as few, within a
/// margin: the paper draws IG_CL with a large α beside it.
pub fn claim_10(runs: &Runs) -> Finding {
    let ratios = against(runs, SCANS, Strategy::Ig);
    let strategies: Vec<Strategy> = ratios.iter().map(|(strategy, _)| *strategy).collect();
    let trials = trials(ratios, ("scans", Strategy::Ig), Bound::Above(1.0 - MARGIN));
    let note = by_strategy(&strategies, &trials);
    Finding::new(
        10,
        "Fig. 7a: no strategy needs fewer scans than IG, by more than a tenth",
        with_condition(runs, trials),
    )
    .note(note)
}

/// Names the strategies for which their test alone holds, those for which it fails, and those for which neither
/// is known. The tests are not corrected for their number.
fn by_strategy(strategies: &[Strategy], trials: &[Trial]) -> String {
    let names = |is: &dyn Fn(&Trial) -> bool| -> String {
        let of = strategies.iter().zip(trials).filter(|(_, trial)| is(trial));
        let names: Vec<String> = of.map(|(strategy, _)| strategy.to_string()).collect();
        if names.is_empty() { "none".to_owned() } else { names.join(", ") }
    };
    let half = 0.5 * LEVEL;
    format!(
        "strategy by strategy: true for {}; false for {}; open for {}",
        names(&|t| t.p_holds < half),
        names(&|t| t.p_holds >= half && t.p_fails < half),
        names(&|t| t.p_holds >= half && t.p_fails >= half)
    )
}

/// Tests claim 11 (Fig. 7 (a)): IG_CL(1.0) needs about as many as IG.
pub fn claim_11(runs: &Runs) -> Finding {
    let three = [IG_CL_1, Strategy::Ig, Strategy::Cl];
    let units = runs.paired(&three, SCANS);
    let share = units.estimate(|units| {
        let [one, ig, cl] = [0, 1, 2].map(|place| mean(units, place));
        Some((one - ig) / (cl - ig))
    });
    let what = "scans, (IG_CL:1 − IG) / (CL − IG) (two one-sided tests)";
    let bound = Bound::Between(-SPAN_SHARE, SPAN_SHARE);
    Finding::new(
        11,
        "Fig. 7a: IG_CL(1.0) needs as many scans as IG, within a fifth of the paper's own span from IG to CL",
        with_condition_on(runs, &three, vec![Trial::new(what, share, bound)]),
    )
    .figure("scans, IG_CL:1 / IG", units.ratio(0, 1))
}

/// Tests claim 12 (Fig. 7 (a)): CL needs the most.
pub fn claim_12(runs: &Runs) -> Finding {
    let ratios = against(runs, SCANS, Strategy::Cl);
    Finding::new(
        12,
        "Fig. 7a: CL needs the most scans",
        with_condition(runs, trials(ratios, ("scans", Strategy::Cl), Bound::Below(1.0))),
    )
}

/// Tests claim 13 (Fig. 7 (b)): CL drives the shortest path.
pub fn claim_13(runs: &Runs, driving: &Runs) -> Finding {
    let ratios = against(runs, PATH, Strategy::Cl);
    let strategies: Vec<Strategy> = ratios.iter().map(|(strategy, _)| *strategy).collect();
    let trials = trials(ratios, ("path", Strategy::Cl), Bound::Above(1.0));
    let note = by_strategy(&strategies, &trials);
    let finding = Finding::new(
        13,
        "Fig. 7b: CL drives the shortest path (at view-points only)",
        with_condition(runs, trials),
    )
    .note(note);
    while_driving(finding, against(driving, PATH, Strategy::Cl), Strategy::Cl)
}

/// Tests claim 14 (Fig. 7 (b)): IG drives by far the longest path.
pub fn claim_14(runs: &Runs, driving: &Runs) -> Finding {
    let ratios = against(runs, PATH, Strategy::Ig);
    let mut trials = trials(ratios, ("path", Strategy::Ig), Bound::Below(1.0));
    let far = runs.paired(&[Strategy::Ig, Strategy::Cl], PATH).ratio(0, 1);
    trials.push(Trial::new("by far: path, IG / CL", far, Bound::Above(2.0)));
    let finding = Finding::new(
        14,
        "Fig. 7b: IG drives the longest path, by far (at least twice that of CL)",
        with_condition(runs, trials),
    );
    while_driving(finding, against(driving, PATH, Strategy::Ig), Strategy::Ig)
}

/// Adds the same ratios for measuring while driving, as figures.
fn while_driving(
    finding: Finding,
    ratios: Vec<(Strategy, Option<Estimate>)>,
    one: Strategy,
) -> Finding {
    ratios.into_iter().fold(finding, |finding, (other, ratio)| {
        finding.figure(&format!("while driving: path, {other} / {one}"), ratio)
    })
}

/// Tests claim 19 (section 5.2): with integration while driving, CL is better than IG.
pub fn claim_19(runs: &Runs, speed: f64) -> Finding {
    let both = [Strategy::Ig, Strategy::Cl];
    let units = runs.paired(&both, PATH);
    // Integration takes no time.
    let time = runs.paired_by(&both, |run| run.value(PATH) / speed).difference(0, 1);
    Finding::new(
        19,
        "section 5.2: if measurements are integrated while driving, CL outperforms IG in path and time",
        with_condition_on(
            runs,
            &both,
            vec![
                Trial::new("path, IG / CL", units.ratio(0, 1), Bound::Above(1.0)),
                Trial::new(format!("time at {speed} m/s, IG less CL [s]"), time, Bound::Above(0.0)),
            ],
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::series;
    use crate::trial::{Verdict, check};

    /// Returns runs with the scans and paths of CL, IG, IG_WIN(2), IG_CL(.3) and IG_CL(1).
    fn runs(scans: [f64; 5], path: [f64; 5]) -> Runs {
        let row =
            |i: usize| [("completeness", 0.99), ("scans", scans[i]), ("path_length_m", path[i])];
        let rows = [0, 1, 2, 3, 4].map(row);
        let names = ["CL", "IG", "IG_WIN:2", "IG_CL:0.3", "IG_CL:1"];
        let rows: Vec<(&str, &[(&str, f64)])> =
            names.iter().zip(&rows).map(|(name, row)| (*name, &row[..])).collect();
        series(&rows)
    }

    const SCANS: [f64; 5] = [400.0, 200.0, 300.0, 280.0, 205.0];
    const PATH: [f64; 5] = [80.0, 900.0, 400.0, 100.0, 300.0];

    #[test]
    fn claim_10_ig_needs_the_fewest() {
        check(claim_10(&runs(SCANS, PATH)), Verdict::Reproduced);
        check(claim_10(&runs([400.0, 200.0, 150.0, 280.0, 205.0], PATH)), Verdict::NotReproduced);
        check(claim_10(&runs([400.0, 200.0, 180.0, 280.0, 205.0], PATH)), Verdict::Undecided);
        // As few, within the margin.
        check(claim_10(&runs([400.0, 200.0, 300.0, 280.0, 195.0], PATH)), Verdict::Reproduced);
        check(claim_10(&runs([400.0, 200.0, 300.0, 280.0, 150.0], PATH)), Verdict::NotReproduced);
    }

    #[test]
    fn claim_11_is_an_equivalence() {
        check(claim_11(&runs(SCANS, PATH)), Verdict::Reproduced);
        check(claim_11(&runs([400.0, 200.0, 300.0, 280.0, 260.0], PATH)), Verdict::NotReproduced);
        check(claim_11(&Runs::default()), Verdict::Undecided);
    }

    #[test]
    fn claim_12_cl_needs_the_most() {
        check(claim_12(&runs(SCANS, PATH)), Verdict::Reproduced);
        check(claim_12(&runs([250.0, 200.0, 300.0, 280.0, 205.0], PATH)), Verdict::NotReproduced);
        check(claim_12(&runs([300.0, 200.0, 300.0, 280.0, 205.0], PATH)), Verdict::Undecided);
    }

    #[test]
    fn claims_13_and_14_are_about_paths() {
        let good = runs(SCANS, PATH);
        check(claim_13(&good, &good), Verdict::Reproduced);
        check(claim_14(&good, &Runs::default()), Verdict::Reproduced);
        let longer = runs(SCANS, [120.0, 900.0, 400.0, 100.0, 300.0]);
        check(claim_13(&longer, &good), Verdict::NotReproduced);
        let note = &claim_13(&longer, &good).notes[0];
        assert!(
            note.contains("true for IG, IG_WIN:2, IG_CL:1; false for IG_CL:0.3; open for none"),
            "{note}"
        );
        let not_far = runs(SCANS, [80.0, 120.0, 110.0, 100.0, 90.0]);
        check(claim_14(&not_far, &good), Verdict::NotReproduced);
        check(claim_13(&Runs::default(), &good), Verdict::Undecided);
        check(claim_14(&Runs::default(), &good), Verdict::Undecided);
    }

    #[test]
    fn claim_19_is_about_driving() {
        check(claim_19(&runs(SCANS, PATH), 0.5), Verdict::Reproduced);
        let other = runs(SCANS, [80.0, 60.0, 400.0, 100.0, 300.0]);
        check(claim_19(&other, 0.5), Verdict::NotReproduced);
        check(claim_19(&Runs::default(), 0.5), Verdict::Undecided);
    }

    #[test]
    fn the_time_of_claim_19_is_that_of_the_robot() {
        let seconds = |speed: f64| claim_19(&runs(SCANS, PATH), speed).trials[2].value.unwrap();
        assert!((seconds(0.25) / seconds(0.5) - 2.0).abs() < 1e-9);
    }
}
