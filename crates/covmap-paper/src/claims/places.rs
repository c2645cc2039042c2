//! Section 5.2, other worlds: claim 17.

use super::explored;
use crate::ranking::mean_tau;
use crate::runs::Runs;
use crate::techniques::{PATH, SCANS};
use crate::trial::{Bound, Finding, Trial};
use covmap_plan::Strategy;
use covmap_statistics::Estimate;

/// The least mean τ: of ten pairs of five strategies, eight are in the same order.
const LEAST_TAU: f64 = 0.6;

/// Tests claim 17: "Further experiments in alternative environments showed similar results."
pub fn claim_17(runs: &Runs, places: &Runs) -> Finding {
    let reference = runs.worlds();
    let worlds = places.worlds().into_iter().filter(|world| !reference.contains(world));
    let worlds: Vec<String> = worlds.collect();
    let mut conditions = Vec::new();
    for world in &worlds {
        let there = places.in_world(world);
        conditions.push(explored(&there, &there.strategies()).of(world));
    }
    let pooled = |(name, metric): (&str, &str)| {
        let of_world = |world: &String| agreement(runs, &places.in_world(world), metric);
        let taus: Vec<Estimate> = worlds.iter().filter_map(of_world).collect();
        let what = format!("mean τ of the rankings by {name}, over {} worlds", taus.len());
        Trial::new(what, over_worlds(&taus), Bound::Above(LEAST_TAU))
    };
    let trials = [("scans", SCANS), ("path", PATH)].map(pooled);
    let finding = Finding::new(
        17,
        "section 5.2: the ranking of the strategies by scans and by path holds in other worlds (Kendall's τ of each start and seed, at least .6 on average over worlds)",
        conditions.into_iter().chain(trials).collect(),
    );
    worlds.iter().fold(finding, |finding, world| {
        let there = places.in_world(world);
        let tau = |metric| agreement(runs, &there, metric);
        finding
            .figure(&format!("{world}: τ by scans"), tau(SCANS))
            .figure(&format!("{world}: τ by path"), tau(PATH))
    })
}

/// The mean over worlds, which are what is drawn: their number is that of the groups.
fn over_worlds(taus: &[Estimate]) -> Option<Estimate> {
    let values: Vec<f64> = taus.iter().map(|tau| tau.value).collect();
    let mean = Estimate::of_mean(&values)?;
    // What is not known of the single worlds is not known of their mean.
    let n = taus.len() as f64;
    let within =
        taus.iter().map(|tau| tau.standard_error * tau.standard_error).sum::<f64>().sqrt() / n;
    Some(Estimate { standard_error: mean.standard_error.max(within), ..mean })
}

/// Says in words whether a real building was among the worlds.
pub(crate) fn buildings(maps: &[String]) -> String {
    if maps.is_empty() {
        "no real building was among the worlds: `--world building=FILE` names a map of one"
            .to_owned()
    } else {
        format!("maps of map_server, as of real buildings, among the worlds: {}", maps.join(", "))
    }
}

/// Returns Kendall's τ between the mean ranking in the world of Fig. 7 and the ranking of each unit
/// in another world.
fn agreement(reference: &Runs, there: &Runs, metric: &str) -> Option<Estimate> {
    let known = reference.strategies();
    let common: Vec<Strategy> =
        there.strategies().into_iter().filter(|s| known.contains(s)).collect();
    let mean_of = |place: usize| reference.paired(&common, metric).mean(place).map(|e| e.value);
    let ranking: Vec<f64> = (0..common.len()).map(mean_of).collect::<Option<_>>()?;
    mean_tau(&ranking, &there.paired(&common, metric))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::series;
    use crate::trial::{Verdict, check};

    fn runs(world: &str, numbers: [f64; 4]) -> Runs {
        let names = ["CL", "IG", "IG_CL:0.3", "IG_CL:1"];
        let rows =
            numbers.map(|n| [("completeness", 0.99), ("scans", n), ("path_length_m", 1e4 / n)]);
        let rows: Vec<(&str, &[(&str, f64)])> =
            names.iter().zip(&rows).map(|(name, row)| (*name, &row[..])).collect();
        let mut runs = series(&rows);
        runs.runs.iter_mut().for_each(|run| world.clone_into(&mut run.world));
        runs
    }

    #[test]
    fn claim_17_compares_rankings() {
        let here = runs("apartment", [400.0, 200.0, 300.0, 220.0]);
        let worlds = |numbers: [f64; 4]| {
            let of = |world: &&str| runs(world, numbers).runs;
            Runs { runs: ["hall", "office", "lab", "ward", "flat"].iter().flat_map(of).collect() }
        };
        check(claim_17(&here, &worlds([900.0, 500.0, 700.0, 600.0])), Verdict::Reproduced);
        check(claim_17(&here, &worlds([200.0, 400.0, 220.0, 300.0])), Verdict::NotReproduced);
        // One world decides nothing.
        check(claim_17(&here, &runs("hall", [900.0, 500.0, 700.0, 600.0])), Verdict::Undecided);
        check(claim_17(&here, &Runs::default()), Verdict::Undecided);
    }

    #[test]
    fn claim_17_says_whether_there_was_a_real_building() {
        assert!(buildings(&[]).starts_with("no real building"));
        assert!(buildings(&["museum".to_owned()]).ends_with("among the worlds: museum"));
    }

    #[test]
    fn one_start_with_large_numbers_does_not_decide_claim_17() {
        let here = runs("apartment", [400.0, 200.0, 300.0, 220.0]);
        let mut there = runs("hall", [200.0, 400.0, 220.0, 300.0]);
        let mut large = runs("hall", [90_000.0, 50_000.0, 70_000.0, 60_000.0]);
        large.runs.retain(|run| run.start == 0);
        there.runs.retain(|run| run.start != 0);
        there.runs.extend(large.runs);
        let tau = claim_17(&here, &there).trials[1].value.unwrap();
        assert!(tau < 0.0, "{tau}");
    }
}
