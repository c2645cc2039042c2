//! The condition that runs explored their world.
//!
//! A run that ended early needs few scans and a short path, and must not win by that.

use crate::runs::{RecordedRun, Runs};
use crate::techniques::COMPLETENESS;
use crate::trial::Trial;
use covmap_plan::Strategy;

/// A run explored its world if the robot knows this share of the cells that it could reach.
const COMPLETE: f64 = 0.9;
/// The largest number of failed runs that are named.
const MOST_NAMES: usize = 12;

/// Returns the condition on the runs that a claim compares.
///
/// Nine in ten of all runs explored their world, and more than half of the runs of each strategy.
/// The others are named.
pub(super) fn explored(runs: &Runs, strategies: &[Strategy]) -> Trial {
    let all: Vec<&RecordedRun> =
        strategies.iter().flat_map(|strategy| runs.with(*strategy)).collect();
    let failed: Vec<&RecordedRun> = all.iter().copied().filter(|run| !is_explored(run)).collect();
    let most = |strategy: &Strategy| {
        let all = runs.with(*strategy).count();
        2 * runs.with(*strategy).filter(|run| is_explored(run)).count() > all
    };
    let holds = !all.is_empty() && 10 * failed.len() <= all.len() && strategies.iter().all(most);
    let what = format!(
        "condition: nine in ten of all runs explored their world (completeness ≥ {COMPLETE}), and of \
         each strategy more than half; {} of {} did",
        all.len() - failed.len(),
        all.len()
    );
    let condition = Trial::condition(what, holds);
    if all.is_empty() {
        return condition.saying(Some("not measured: there are no such runs".to_owned()));
    }
    let cut_short = all.iter().filter(|run| run.cut_short).count();
    let cut_short = (cut_short > 0).then(|| {
        format!(
            "{cut_short} were cut short, and would have more scans and a longer path at their end"
        )
    });
    condition.saying(names(&failed)).saying(cut_short)
}

fn is_explored(run: &RecordedRun) -> bool {
    run.value(COMPLETENESS) >= COMPLETE
}

/// Returns the names of the failed runs, if any.
fn names(failed: &[&RecordedRun]) -> Option<String> {
    let name = |run: &&RecordedRun| {
        let RecordedRun { world, strategy, start, seed, .. } = run;
        let completeness = run.value(COMPLETENESS);
        format!("{world}, {strategy}, start {start}, seed {seed} ({completeness:.2})")
    };
    let mut names: Vec<String> = failed.iter().take(MOST_NAMES).map(name).collect();
    if let Some(more @ 1..) = failed.len().checked_sub(MOST_NAMES) {
        names.push(format!("{more} more"));
    }
    (!names.is_empty()).then(|| format!("did not, with their completeness: {}", names.join("; ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::made_up;

    /// Returns the condition for ten runs each of CL and IG, and the numbers of failed runs.
    fn condition(failed: [u64; 2]) -> Trial {
        let mut runs = Runs::default();
        for (strategy, failed) in ["CL", "IG"].into_iter().zip(failed) {
            for seed in 1..=10 {
                let completeness = if seed <= failed { 0.5 } else { 0.95 };
                let row = [("completeness", completeness)];
                runs.runs.extend(made_up(&[(strategy, 0, seed, &row)]).runs);
            }
        }
        explored(&runs, &[Strategy::Cl, Strategy::Ig])
    }

    #[track_caller]
    fn check(failed: [u64; 2], holds: bool) -> Option<String> {
        let trial = condition(failed);
        assert_eq!(trial.p_holds <= 0.0, holds, "{trial:?}");
        trial.reason
    }

    #[test]
    fn nine_in_ten_of_all_runs_are_enough_and_the_others_are_named() {
        assert_eq!(check([0, 0], true), None);
        let named = check([0, 2], true).unwrap();
        assert!(named.contains("apartment, IG, start 0, seed 2 (0.50)"), "{named}");
        assert!(check([0, 3], false).unwrap().contains("seed 3"));
        assert!(check([10, 10], false).unwrap().ends_with("8 more"));
    }

    #[test]
    fn more_than_half_of_each_strategy_must_explore() {
        // Two of thirty runs failed: all runs of one strategy.
        let mut runs = Runs::default();
        for (strategy, seeds, completeness) in [("CL", 28, 0.95), ("IG", 2, 0.5)] {
            for seed in 1..=seeds {
                let row = [("completeness", completeness)];
                runs.runs.extend(made_up(&[(strategy, 0, seed, &row)]).runs);
            }
        }
        assert!(explored(&runs, &[Strategy::Cl]).p_holds <= 0.0);
        assert!(explored(&runs, &[Strategy::Cl, Strategy::Ig]).p_holds >= 1.0);
        assert!(explored(&runs, &[Strategy::Cl, Strategy::IgCl { alpha: 1.0 }]).p_holds >= 1.0);
    }

    #[test]
    fn without_runs_nothing_was_measured() {
        let trial = explored(&Runs::default(), &[Strategy::Cl]);
        assert!(trial.p_holds >= 1.0 && trial.reason.unwrap().starts_with("not measured"));
    }
}
