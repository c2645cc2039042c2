//! Fig. 5: maps and trajectories in the corridor; and Table 1.

use super::map_figure;
use crate::error::{PaperError, Result};
use crate::runs::Runs;
use crate::session::Series;
use crate::session::Session;
use crate::techniques::{EXTENDED, ONCE};
use covmap_campaign::{Job, Plan, RunKey, Setting, driven, load_paths};
use covmap_draw::FigureFolder;
use covmap_draw::Picture;
use covmap_explore::Run;
use covmap_lab::{Experiment, Truth, results::Pictures};
use covmap_plan::Strategy;
use covmap_world::World;
use nalgebra::Point2;
use rayon::prelude::*;
use std::path::Path;

/// The maps of Fig. 5: counting once, CL on coverage maps, extended counting; and whether each
/// shows the occupancy, as in the paper.
const MAPS: [(char, Strategy, bool); 3] =
    [('a', ONCE, true), ('b', Strategy::Cl, false), ('c', EXTENDED, true)];

/// Repeats the first recorded run of each technique, and draws its map with the recorded path.
///
/// The run is repeated because maps are not recorded.
pub(crate) fn write(
    output: &FigureFolder,
    session: &Session<'_>,
    series: &Series,
    setting: &Setting,
    suffix: &str,
) -> Result<()> {
    let plan = Plan::new(&series.campaign)?;
    let draw = |(letter, strategy, occupancy): (char, Strategy, bool)| {
        let name = strategy.to_string();
        let is_first =
            |key: &RunKey| key.setting == setting.name && key.strategy == name && key.start == 0;
        let Some(job) = plan.jobs.iter().find(|job| is_first(&job.planned.key)) else {
            return Ok(());
        };
        let (run, experiment) = repeat(&plan, job, session, &series.dir)?;
        let pictured = Pictured { world: &plan.cases[job.case].world, experiment, run };
        let picture = pictured.picture(strategy, occupancy)?;
        map_figure::write_picture(output, &format!("figure5{letter}{suffix}"), &picture)
    };
    MAPS.into_par_iter().map(draw).collect()
}

/// Repeats a run, with its recorded path.
fn repeat(plan: &Plan, job: &Job, session: &Session<'_>, dir: &Path) -> Result<(Run, Experiment)> {
    let key = &job.planned.key;
    let recorded = load_paths(dir, key)?;
    let (world, experiment) = (&plan.cases[job.case].world, plan.experiment(job)?);
    let mut run = experiment.explore(world, &mut |_, _| session.watch().flow())?;
    session.check()?;
    if driven(&run.trajectory) != recorded.driven {
        return Err(PaperError::OtherRun { dir: dir.to_owned(), key: Box::new(key.clone()) });
    }
    run.trajectory = recorded.driven.iter().map(|(x, y)| Point2::new(*x, *y)).collect();
    Ok((run, experiment))
}

/// A run with its world and its experiment.
struct Pictured<'a> {
    world: &'a World,
    experiment: Experiment,
    run: Run,
}

impl Pictured<'_> {
    fn picture(&self, strategy: Strategy, occupancy: bool) -> Result<Picture> {
        let Self { world, experiment, run } = self;
        let truth = Truth::new(world, &experiment.mission);
        let mut experiment = experiment.clone();
        experiment.mission.config.planner.strategy = strategy;
        let summary = experiment.summary((world, &truth), (run, &run.map), (0.0, String::new()));
        let mission = &experiment.mission;
        let pictures =
            Pictures { mission, run, map: &run.map, how: "", truth: &truth, summary: &summary };
        if occupancy { Ok(pictures.occupancy()?) } else { Ok(pictures.coverage()) }
    }
}

/// Returns the rows of Table 1.
///
/// A row has the technique, path, share of uncertain cells and scans, each with its interval, and
/// the number of runs that were cut short, out of all.
pub(crate) fn table_1(runs: &Runs) -> Vec<(Strategy, [String; 5])> {
    let row = |strategy: &Strategy| {
        let mean = |metric: &str| {
            let mean = runs.paired(&[*strategy], metric).mean(0);
            mean.map_or("–".to_owned(), |m| crate::trial::shown(Some(m.value), m.interval(0.95)))
        };
        let technique = match strategy {
            Strategy::Cl => "coverage maps (CL)".to_owned(),
            other => format!("counting: {other}"),
        };
        let numbers = ["path_length_m", "share_uncertain", "scans"].map(mean);
        let [path, uncertain, scans] = numbers;
        (*strategy, [technique, path, uncertain, scans, runs.cut_short_of(*strategy)])
    };
    runs.strategies().iter().map(row).collect()
}
