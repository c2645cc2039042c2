//! Section 5.1, Fig. 6: the share at which the curves of scan counting and CL meet. Claim 8.

use super::explored;
use crate::crossing::{Crossing, Point, crossing};
use crate::runs::Runs;
use crate::techniques::PATH;
use crate::trial::{Finding, Trial, digits, shown};
use covmap_plan::Strategy;
use covmap_statistics::Estimate;
use std::collections::BTreeMap;

const EXPLORED: &str = "share_explored";
/// The largest share at which the curves may meet.
const LIMIT: f64 = 0.90;

/// Tests claim 8 (Fig. 6): the share of explored cells from which CL's path is shorter.
pub fn claim_8(runs: &Runs) -> Finding {
    let [discounted, plain] = [true, false].map(|discounted| meetings(runs, discounted));
    let what = "share of explored cells where the curves meet, discounted counts, mean over starts";
    let trial = Trial::between_ends(what, ends(&discounted), LIMIT).saying(unmet(&discounted));
    Finding::new(
        8,
        "Fig. 6: if more than 85 % of the cells are to be explored well enough, CL's path is shorter than that of extended counting (the share where the curves meet is at most .90)",
        vec![explored(runs, &[Strategy::Cl]), trial],
    )
    .note(format!("the same, every beam counting fully: {}", in_words(&plain)))
    .figure("share that CL explores", runs.paired(&[Strategy::Cl], EXPLORED).mean(0))
}

/// Returns, for each start, the crossing of the counting runs' curve with the path of CL.
fn meetings(runs: &Runs, discounted: bool) -> Vec<Crossing> {
    let mut starts: BTreeMap<usize, [Vec<Point>; 2]> = BTreeMap::new();
    for run in &runs.runs {
        let point = Point { path: run.value(PATH), share: run.value(EXPLORED) };
        let place = match run.strategy {
            Strategy::Cl => 1,
            Strategy::Count { half_distance, .. } if half_distance.is_some() == discounted => 0,
            _ => continue,
        };
        starts.entry(run.start).or_default()[place].push(point);
    }
    starts.into_values().filter_map(|[counting, cl]| crossing(&counting, &cl)).collect()
}

/// Returns the means over starts of the smallest and the largest shares at which the curves may
/// meet.
fn ends(meetings: &[Crossing]) -> Option<[Estimate; 2]> {
    let mean = |end: usize| {
        let values: Vec<f64> = meetings.iter().map(|meeting| meeting.ends()[end]).collect();
        Estimate::of_mean(&values)
    };
    Some([mean(0)?, mean(1)?])
}

/// Returns the number of starts in which the curves did not meet, in words, if there are any.
fn unmet(meetings: &[Crossing]) -> Option<String> {
    let shares = |of: &dyn Fn(&Crossing) -> Option<f64>| -> Vec<String> {
        meetings.iter().filter_map(of).map(digits).collect()
    };
    let above = shares(&|m| if let Crossing::Above(share) = m { Some(*share) } else { None });
    let below = shares(&|m| if let Crossing::Below(share) = m { Some(*share) } else { None });
    let all = meetings.len();
    let told = |list: &[String], what: &str| {
        let starts = format!("in {} of {all} starts {what} ({})", list.len(), list.join(", "));
        (!list.is_empty()).then_some(starts)
    };
    let above = told(
        &above,
        "CL drives more than every counting run, so the curves do not meet below the largest share measured",
    );
    let below = told(
        &below,
        "CL drives less than every counting run, so they do not meet above the smallest share measured",
    );
    let parts: Vec<String> = above.into_iter().chain(below).collect();
    (!parts.is_empty()).then(|| {
        format!(
            "{}; not decided there, and each end counts for the side that it does not favour",
            parts.join("; ")
        )
    })
}

fn in_words(meetings: &[Crossing]) -> String {
    let Some([low, high]) = ends(meetings) else { return "no data".to_owned() };
    let told = [low, high].map(|end| shown(Some(end.value), end.interval(0.95)));
    let number = if low == high { told[0].clone() } else { told.join(" to ") };
    [Some(number), unmet(meetings)].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::made_up;
    use crate::trial::{Verdict, check};

    /// Returns counts up to a share of `most` from four starts, and CL with a path of its own.
    fn fig_6(cl: (f64, f64), most: f64) -> Runs {
        let mut runs = Runs::default();
        for start in 0..4usize {
            let name = |n: u32| format!("COUNT:{n}:2");
            let add = |runs: &mut Runs, strategy: &str, path: f64, share: f64| {
                let values =
                    [("path_length_m", path), ("share_explored", share), ("completeness", 0.99)];
                runs.runs.extend(made_up(&[(strategy, start, 1, &values)]).runs);
            };
            for n in 1..=10u32 {
                let path = 10.0 * f64::from(n) + start as f64;
                add(&mut runs, &name(n), path, most * f64::from(n) / 10.0);
            }
            add(&mut runs, "CL", cl.0 + 1.2 * start as f64, cl.1);
        }
        runs
    }

    #[test]
    fn claim_8_is_where_the_curves_meet() {
        check(claim_8(&fig_6((60.0, 0.99), 1.0)), Verdict::Reproduced);
        check(claim_8(&fig_6((99.0, 0.99), 1.0)), Verdict::NotReproduced);
        check(claim_8(&Runs::default()), Verdict::Undecided);
    }

    #[test]
    fn curves_that_do_not_meet_are_not_taken_for_any_share() {
        // CL drives more than every count, and the counts reached only .5 of the cells.
        let finding = claim_8(&fig_6((150.0, 0.99), 0.5));
        let reason = finding.trials[1].reason.clone().unwrap_or_default();
        assert!(reason.contains("in 4 of 4 starts CL drives more"), "{reason}");
        check(finding, Verdict::Undecided);
        // From three starts of four the curves meet early, which does not make up for the fourth.
        let mut runs = fig_6((20.0, 0.99), 1.0);
        let cl =
            |run: &&mut crate::runs::RecordedRun| run.strategy == Strategy::Cl && run.start == 3;
        for run in runs.runs.iter_mut().filter(cl) {
            run.values.insert(PATH.to_owned(), 500.0);
        }
        let finding = claim_8(&runs);
        assert!(finding.trials[1].reason.clone().is_some_and(|r| r.contains("in 1 of 4 starts")));
        check(finding, Verdict::Undecided);
    }
}
