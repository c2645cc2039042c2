//! Eq. (16): the trade-off of IG_CL, and its ends. Claims 15 and 16.

use super::explored;
use crate::limits::Limits;
use crate::ranking::mean_tau;
use crate::runs::{RecordedRun, Runs, Units};
use crate::techniques::{PATH, SCANS};
use crate::trial::{Bound, Finding, Trial};
use covmap_plan::Strategy;
use covmap_statistics::Estimate;
use std::collections::BTreeMap;

const IG_CL_3: Strategy = Strategy::IgCl { alpha: 0.3 };
/// The weights of a scan against the path, both as shares of CL's.
const WEIGHTS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// Tests claim 15 (section 5.2): IG_CL(.3) is a good trade-off, better than IG_WIN.
pub fn claim_15(runs: &Runs, driving: &Runs) -> Finding {
    let compared: Vec<Strategy> =
        [Strategy::Cl, IG_CL_3].into_iter().chain(windows(runs)).collect();
    let mut trials = vec![explored(runs, &compared)];
    trials.extend(WEIGHTS.iter().map(|weight| {
        let what = format!("cost for w = {weight}, IG_CL(.3) less the best IG_WIN");
        Trial::new(what, advantage(runs, *weight), Bound::Below(0.0))
    }));
    let finding = Finding::new(
        15,
        "section 5.2: IG_CL(.3) is a good trade-off: path/path_CL + w·scans/scans_CL is below that of the best IG_WIN (its radius chosen from other starts) for w = .25 to 4",
        trials,
    );
    WEIGHTS.iter().fold(finding, |finding, weight| {
        finding.figure(&format!("while driving, w = {weight}"), advantage(driving, *weight))
    })
}

/// Returns IG_WIN with all its radii.
fn windows(runs: &Runs) -> Vec<Strategy> {
    runs.strategies().into_iter().filter(|s| matches!(s, Strategy::IgWin { .. })).collect()
}

/// Returns the mean cost of IG_CL(.3) less that of the best IG_WIN.
///
/// The radius is the best from the other starts (from the same start, if there is only one).
fn advantage(runs: &Runs, weight: f64) -> Option<Estimate> {
    let windows = windows(runs);
    if windows.is_empty() {
        return None;
    }
    let cl = |metric: &str| {
        let values = runs.values(Strategy::Cl, metric);
        let n = values.len() as f64;
        values.iter().sum::<f64>() / n
    };
    let (path, scans) = (cl(PATH), cl(SCANS));
    let cost = |run: &RecordedRun| run.value(PATH) / path + weight * run.value(SCANS) / scans;
    let mut starts: BTreeMap<usize, Runs> = BTreeMap::new();
    for run in &runs.runs {
        starts.entry(run.start).or_default().runs.push(run.clone());
    }
    let mut groups: BTreeMap<usize, Vec<Vec<f64>>> = BTreeMap::new();
    for (start, own) in &starts {
        let is_other = |run: &&RecordedRun| run.start != *start || starts.len() == 1;
        let others = Runs { runs: runs.runs.iter().filter(is_other).cloned().collect() };
        let units = own.paired_by(&[IG_CL_3, best_window(&others, &windows, &cost)?], cost);
        groups.entry(*start).or_default().extend(units.0.into_iter().flatten());
    }
    Units(groups.into_values().collect()).difference(0, 1)
}

fn best_window(
    runs: &Runs,
    windows: &[Strategy],
    cost: &impl Fn(&RecordedRun) -> f64,
) -> Option<Strategy> {
    let mean_cost = |window: &Strategy| {
        let costs: Vec<f64> = runs.with(*window).map(cost).filter(|c| c.is_finite()).collect();
        let n = costs.len() as f64;
        (!costs.is_empty()).then(|| (costs.iter().sum::<f64>() / n, *window))
    };
    windows
        .iter()
        .filter_map(mean_cost)
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, window)| window)
}

/// Tests claim 16 (Eq. (16)): IG_CL goes from CL to IG as α grows.
pub fn claim_16(limits: &Limits, runs: &Runs) -> Finding {
    Finding::new(
        16,
        "Eq. (16): α = 0 gives the trace of CL exactly, α = 10⁹ that of IG, and between them scans fall and paths grow with α (Kendall's τ of each start and seed, at least .6 on average)",
        vec![
            Trial::fact("IG_CL(0) makes the same scans at the same places as CL", limits.zero_is_cl),
            Trial::fact("IG_CL(10⁹) makes those of IG", limits.huge_is_ig),
            explored(runs, &with_alpha(runs).0),
            Trial::new("mean τ of α and the path", trend(runs, PATH, 1.0), Bound::Above(0.6)),
            Trial::new("mean τ of α and the scans, negative", trend(runs, SCANS, -1.0), Bound::Above(0.6)),
        ],
    )
    .note(limits.what.clone())
}

/// Returns the trend of a metric with α in each unit, from CL (0) over all IG_CL to IG (∞).
fn trend(runs: &Runs, metric: &str, sign: f64) -> Option<Estimate> {
    let (strategies, alphas) = with_alpha(runs);
    mean_tau(&alphas, &runs.paired_by(&strategies, |run| sign * run.value(metric)))
}

/// Returns CL, all IG_CL and IG, with their α.
fn with_alpha(runs: &Runs) -> (Vec<Strategy>, Vec<f64>) {
    let alpha = |strategy: &Strategy| match strategy {
        Strategy::Cl => Some(0.0),
        Strategy::IgCl { alpha } => Some(*alpha),
        Strategy::Ig => Some(f64::INFINITY),
        _ => None,
    };
    let with_alpha =
        runs.strategies().into_iter().filter_map(|s| alpha(&s).map(|alpha| (s, alpha)));
    with_alpha.unzip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::series;
    use crate::trial::{Verdict, check};

    fn runs(rows: &[(&str, f64, f64)]) -> Runs {
        let row = |(_, scans, path): &(&str, f64, f64)| {
            [("completeness", 0.99), ("scans", *scans), ("path_length_m", *path)]
        };
        let values: Vec<[(&str, f64); 3]> = rows.iter().map(row).collect();
        let rows: Vec<(&str, &[(&str, f64)])> =
            rows.iter().zip(&values).map(|((name, ..), row)| (*name, &row[..])).collect();
        series(&rows)
    }

    fn trade(ig_cl: (f64, f64)) -> Runs {
        runs(&[
            ("CL", 400.0, 80.0),
            ("IG_CL:0.3", ig_cl.0, ig_cl.1),
            ("IG_WIN:1", 350.0, 200.0),
            ("IG_WIN:3", 300.0, 300.0),
        ])
    }

    #[test]
    fn claim_15_compares_with_the_best_window() {
        check(claim_15(&trade((280.0, 100.0)), &Runs::default()), Verdict::Reproduced);
        check(claim_15(&trade((300.0, 400.0)), &Runs::default()), Verdict::NotReproduced);
        check(claim_15(&Runs::default(), &Runs::default()), Verdict::Undecided);
    }

    fn ends(same: bool) -> Limits {
        Limits { zero_is_cl: same, huge_is_ig: true, what: String::new() }
    }

    #[test]
    fn claim_16_needs_the_ends_and_a_trend() {
        let good = [
            ("CL", 400.0, 80.0),
            ("IG_CL:0.1", 380.0, 90.0),
            ("IG_CL:0.3", 300.0, 100.0),
            ("IG_CL:1", 210.0, 300.0),
            ("IG", 200.0, 900.0),
        ];
        check(claim_16(&ends(true), &runs(&good)), Verdict::Reproduced);
        check(claim_16(&ends(false), &runs(&good)), Verdict::NotReproduced);
        let reversed: Vec<_> =
            good.iter().map(|(name, scans, path)| (*name, *path, *scans)).collect();
        check(claim_16(&ends(true), &runs(&reversed)), Verdict::NotReproduced);
        check(claim_16(&ends(true), &Runs::default()), Verdict::Undecided);
    }
}
