//! Section 5.1: coverage maps against scan counting. Claims 5–7, 9 and 20.

use super::explored;
use crate::runs::{MOST_COUNTS, Runs, measured_until_explored};
use crate::techniques::{EXTENDED, ONCE, PATH};
use crate::trial::{Bound, Finding, Trial};
use covmap_plan::Strategy;

const UNCERTAIN: &str = "share_uncertain";
const EXPLORED: &str = "share_explored";

/// Returns extended counting with n*, in the corridor: the other count with a discount.
pub(crate) fn with_n_star(runs: &Runs) -> Option<Strategy> {
    let is = |s: &Strategy| {
        matches!(s, Strategy::Count { half_distance: Some(_), .. }) && *s != EXTENDED
    };
    runs.strategies().into_iter().find(is)
}

/// Tests claim 5 (Table 1): the share of uncertain cells.
pub fn claim_5(runs: &Runs) -> Finding {
    let units = runs.paired(&[Strategy::Cl, ONCE, EXTENDED], UNCERTAIN);
    Finding::new(
        5,
        "Table 1, cells with H > .65: coverage maps at most .5 %, counting (n = 1) at least 10 %, extended counting between them",
        vec![
            explored(runs, &[Strategy::Cl, ONCE, EXTENDED]),
            Trial::new("coverage maps: share with H > .65", units.mean(0), Bound::Below(0.005)),
            Trial::new("counting, n = 1", units.mean(1), Bound::Above(0.10)),
            Trial::new("extended counting less coverage maps", units.difference(2, 0), Bound::Above(0.0)),
            Trial::new("extended counting less counting", units.difference(2, 1), Bound::Below(0.0)),
        ],
    )
    .figure("extended counting, n = 50", units.mean(2))
}

/// Tests claim 6 (Table 1): the ratios of the paths.
pub fn claim_6(runs: &Runs) -> Finding {
    let units = runs.paired(&[Strategy::Cl, ONCE, EXTENDED], PATH);
    let finding = Finding::new(
        6,
        "Table 1, path against that of coverage maps (paper: .30, 1.02): counting (n = 1) in [.15, .6], extended counting (n = 50) in [.8, 1.25]",
        vec![
            explored(runs, &[Strategy::Cl, ONCE, EXTENDED]),
            Trial::new("counting, n = 1", units.ratio(1, 0), Bound::Between(0.15, 0.6)),
            Trial::new("extended counting, n = 50", units.ratio(2, 0), Bound::Between(0.8, 1.25)),
        ],
    );
    let n_star = with_n_star(runs).map(|s| (s, runs.paired(&[Strategy::Cl, s], PATH).ratio(1, 0)));
    n_star.into_iter().fold(finding, |f, (s, ratio)| f.figure(&format!("{s}, n*"), ratio))
}

/// Tests claim 7 (section 5.1): some cells are measured too often, others not often enough.
pub fn claim_7(runs: &Runs) -> Finding {
    let metric = |name: &str| runs.paired(&[EXTENDED], name);
    let spread = runs.paired_by(&[EXTENDED], |run| {
        run.value("measurements.sd") / run.value("measurements.mean")
    });
    let missed = runs.paired_by(&[EXTENDED], |run| 1.0 - run.value(EXPLORED));
    Finding::new(
        7,
        "section 5.1: extended counting measures some cells too often and others not often enough",
        vec![
            explored(runs, &[EXTENDED]),
            Trial::new(
                "n = 50: standard deviation of the counts of a cell over their mean",
                spread.mean(0),
                Bound::Above(0.5),
            ),
            Trial::new(
                "n = 50: share of cells that are not explored well enough",
                missed.mean(0),
                Bound::Above(0.01),
            ),
        ],
    )
    .figure("mean number of measurements of a cell", metric("measurements.mean").mean(0))
    .figure("largest", metric("measurements.max").mean(0))
    .figure("smallest", metric("measurements.min").mean(0))
}

/// Describes n* in words.
fn n_star_in_words(runs: &Runs) -> String {
    let [count, weight] = measured_until_explored(runs);
    let clipped = if weight > MOST_COUNTS {
        format!("; n* is clipped to {MOST_COUNTS}")
    } else {
        format!("; below the cap of {MOST_COUNTS}, so not clipped")
    };
    let capped = runs.with(Strategy::Cl).filter(|run| run.value("capped_cells") > 0.0).count();
    let capped = match capped {
        0 => String::new(),
        runs => format!("; in {runs} runs the planner's own cap gave up cells before"),
    };
    format!(
        "when it first fulfilled H ≤ ε, a cell had been measured up to {count:.0} times, with a discounted weight of \
         up to {weight:.1}, which is what n* counts{clipped}{capped}"
    )
}

/// Tests claim 9 (footnote 2): counting with n* explores nearly all cells.
pub fn claim_9(runs: &Runs) -> Finding {
    let n_star = with_n_star(runs);
    let compared: Vec<Strategy> = [Strategy::Cl].into_iter().chain(n_star).collect();
    let share = n_star.and_then(|strategy| runs.paired(&[strategy], EXPLORED).mean(0));
    Finding::new(
        9,
        "footnote 2: counting up to n*, the largest number of measurements that a cell had when it first fulfilled H ≤ ε, explores nearly all cells (at least 95 %)",
        vec![
            explored(runs, &compared),
            Trial::new(
                n_star.map_or("n*".to_owned(), |s| format!("{s}: share of cells with H ≤ ε")),
                share,
                Bound::Above(0.95),
            ),
        ],
    )
    .figure("share that CL explores", runs.paired(&[Strategy::Cl], EXPLORED).mean(0))
    .note(n_star_in_words(runs))
}

/// Tests claim 20 (section 5.1): the map of CL is more accurate than that of counting once.
pub fn claim_20(runs: &Runs) -> Finding {
    let both = [Strategy::Cl, ONCE];
    let difference = |metric: &str| runs.paired(&both, metric).difference(0, 1);
    Finding::new(
        20,
        "section 5.1: the map of CL on coverage maps is more accurate than that of counting with n = 1",
        vec![
            explored(runs, &both),
            Trial::new(
                "mean absolute error of the most likely coverage over the same cells, CL less counting",
                difference("mae_observable"),
                Bound::Below(0.0),
            ),
        ],
    )
    .figure("mean log-likelihood of the truth, CL less counting [nats]", difference("log_likelihood_observable"))
    .figure("CRPS, CL less counting", difference("crps_observable"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::series;
    use crate::trial::{Verdict, check};

    fn table_1(uncertain: [f64; 3], path: [f64; 3]) -> Runs {
        let row = |i: usize| {
            vec![
                ("completeness", 0.99),
                ("share_uncertain", uncertain[i]),
                ("path_length_m", path[i]),
            ]
        };
        let rows = [row(0), row(1), row(2)];
        series(&[("CL", &rows[0]), ("COUNT:1", &rows[1]), ("COUNT:50:2", &rows[2])])
    }

    #[test]
    fn claim_5_is_table_1() {
        let path = [90.0, 27.0, 91.0];
        check(claim_5(&table_1([0.001, 0.21, 0.015], path)), Verdict::Reproduced);
        check(claim_5(&table_1([0.02, 0.21, 0.05], path)), Verdict::NotReproduced);
        check(claim_5(&Runs::default()), Verdict::Undecided);
    }

    #[test]
    fn claim_6_is_confirmed_or_refuted() {
        let shares = [0.0, 0.2, 0.01];
        check(claim_6(&table_1(shares, [90.0, 27.0, 91.0])), Verdict::Reproduced);
        check(claim_6(&table_1(shares, [90.0, 27.0, 300.0])), Verdict::NotReproduced);
    }

    #[test]
    fn claim_7_needs_both_ends() {
        let runs = |sd: f64, explored: f64| {
            let row = [
                ("completeness", 0.99),
                ("measurements.sd", sd),
                ("measurements.mean", 100.0),
                ("share_explored", explored),
            ];
            series(&[("COUNT:50:2", &row)])
        };
        check(claim_7(&runs(80.0, 0.9)), Verdict::Reproduced);
        check(claim_7(&runs(20.0, 0.9)), Verdict::NotReproduced);
        check(claim_7(&Runs::default()), Verdict::Undecided);
    }

    #[test]
    fn claim_9_is_about_the_other_count() {
        let runs = |share: f64| {
            let cl = [("completeness", 0.99), ("share_explored", 1.0)];
            let n_star = [("completeness", 0.99), ("share_explored", share)];
            series(&[("CL", &cl), ("COUNT:50:2", &cl), ("COUNT:93:2", &n_star)])
        };
        check(claim_9(&runs(0.99)), Verdict::Reproduced);
        check(claim_9(&runs(0.80)), Verdict::NotReproduced);
        check(claim_9(&runs(0.951)), Verdict::Undecided);
    }

    #[test]
    fn claim_9_says_the_count_the_weight_and_the_cap() {
        let note = |weight: f64| {
            let cl = [
                ("completeness", 0.99),
                ("measurements.until_explored", 1000.0),
                ("measurements.until_explored_discounted", weight),
            ];
            claim_9(&series(&[("CL", &cl)])).notes.concat()
        };
        // The largest of a series is slightly above its mean.
        assert!(note(300.0).contains("measured up to 10"), "{}", note(300.0));
        assert!(note(300.0).contains("weight of up to 30") && note(300.0).contains("not clipped"));
        assert!(note(600.0).contains("clipped to 520"));
    }

    #[test]
    fn claim_20_is_void_if_the_runs_explored_nothing() {
        let runs = |completeness: f64, cl: f64| {
            let row = |error: f64| [("completeness", completeness), ("mae_observable", error)];
            series(&[("CL", &row(cl)), ("COUNT:1", &row(0.2))])
        };
        check(claim_20(&runs(0.99, 0.1)), Verdict::Reproduced);
        check(claim_20(&runs(0.99, 0.3)), Verdict::NotReproduced);
        check(claim_20(&runs(0.10, 0.1)), Verdict::Undecided);
    }
}
