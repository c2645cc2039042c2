//! Tables of the report beyond the paper's: accuracy, cost, and the effect of each reading.

use crate::runs::Runs;
use crate::session::Series;
use crate::trial::{digits, shown};
use covmap_plan::Strategy;

/// A table with its columns.
pub(super) type Table = (Vec<&'static str>, Vec<Vec<String>>);

/// Returns the accuracy of the final maps against the exact truth, over the same cells for all runs
/// in a world.
pub(super) fn accuracy(runs: &Runs) -> Table {
    let metrics = [
        ("log-likelihood [nats]", "log_likelihood_observable"),
        ("CRPS", "crps_observable"),
        ("error of the mode", "mae_observable"),
        ("error, free", "mae_free_observable"),
        ("error, partial", "mae_partial_observable"),
        ("error, solid", "mae_solid_observable"),
        ("completeness", "completeness"),
        ("wall recall", "wall_recall"),
        ("phantoms", "phantom"),
        ("explored", "share_explored"),
        ("bumps", "bumps"),
    ];
    of_metrics(runs, &metrics)
}

/// Returns the cost of a run, and the gain of a scan and of a metre.
pub(super) fn cost(runs: &Runs) -> Table {
    let columns = [
        "strategy",
        "runs",
        "cut short",
        "scans",
        "path [m]",
        "cells explored per scan",
        "cells explored per metre",
        "decision [ms]",
        "run [s]",
    ];
    let row = |strategy: &Strategy| {
        let number = |of: &dyn Fn(&crate::runs::RecordedRun) -> f64| {
            let mean = runs.paired_by(&[*strategy], of).mean(0);
            mean.map_or("–".to_owned(), |mean| digits(mean.value))
        };
        let cells = |run: &crate::runs::RecordedRun| {
            run.value("share_explored") * run.value("observable_cells")
        };
        vec![
            strategy.to_string(),
            runs.with(*strategy).count().to_string(),
            runs.cut_short(*strategy).to_string(),
            number(&|run| run.value("scans")),
            number(&|run| run.value("path_length_m")),
            number(&|run| cells(run) / run.value("scans")),
            number(&|run| cells(run) / run.value("path_length_m")),
            number(&|run| 1e3 * run.value("deciding_seconds") / run.value("decisions")),
            number(&|run| run.value("seconds")),
        ]
    };
    (columns.to_vec(), runs.strategies().iter().map(row).collect())
}

/// Returns the changes of the runs when one reading changes.
pub(super) fn ablation(series: &Series) -> Table {
    let columns = [
        "setting",
        "strategy",
        "cut short",
        "scans",
        "path [m]",
        "completeness",
        "wall recall",
        "explored",
        "H > .65",
        "error of the mode",
        "error of the mean",
    ];
    let metrics = [
        "scans",
        "path_length_m",
        "completeness",
        "wall_recall",
        "share_explored",
        "share_uncertain",
        "mae_mode",
        "mae_mean",
    ];
    let rows = series.campaign.settings.iter().flat_map(|setting| {
        let runs = Runs::of(&series.campaign, &setting.name, &series.records);
        let row = |strategy: Strategy| {
            let mean = |metric: &&str| {
                let mean = runs.paired(&[strategy], metric).mean(0);
                mean.map_or("–".to_owned(), |mean| digits(mean.value))
            };
            let names = [setting.name.clone(), strategy.to_string(), runs.cut_short_of(strategy)];
            names.into_iter().chain(metrics.iter().map(mean)).collect()
        };
        runs.strategies().into_iter().map(row).collect::<Vec<Vec<String>>>()
    });
    (columns.to_vec(), rows.collect())
}

fn of_metrics(runs: &Runs, metrics: &[(&'static str, &str)]) -> Table {
    let names = metrics.iter().map(|(name, _)| *name);
    let columns = ["strategy", "cut short"].into_iter().chain(names).collect();
    let row = |strategy: &Strategy| {
        let mean = |(_, metric): &(&str, &str)| {
            let mean = runs.paired(&[*strategy], metric).mean(0);
            mean.map_or("–".to_owned(), |mean| shown(Some(mean.value), mean.interval(0.95)))
        };
        let names = [strategy.to_string(), runs.cut_short_of(*strategy)];
        names.into_iter().chain(metrics.iter().map(mean)).collect()
    };
    (columns, runs.strategies().iter().map(row).collect())
}
