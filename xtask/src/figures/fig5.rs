//! Fig. 5: maps and trajectories in the corridor; and Table 1.

use super::map_figure;
use super::output::Output;
use crate::campaign::Setting;
use crate::input;
use crate::paper::claims::{EXTENDED, ONCE};
use crate::paper::runs::Runs;
use crate::paper::session::Series;
use crate::pictures::Pictures;
use anyhow::Result;
use covmap_explore::{Limits, Mission, SimulatedRobot, Summary, Truth, explore};
use covmap_plan::Strategy;
use rayon::prelude::*;
use std::ops::ControlFlow;

/// The maps of Fig. 5: counting once, CL on coverage maps, extended counting; whether the
/// occupancy is shown, as in the paper.
const MAPS: [(char, Strategy, bool); 3] =
    [('a', ONCE, true), ('b', Strategy::Cl, false), ('c', EXTENDED, true)];

/// Repeats one run of each technique, and draws its map.
pub(crate) fn write(
    output: &Output,
    series: &Series,
    setting: &Setting,
    suffix: &str,
) -> Result<()> {
    let draw = |(letter, strategy, occupancy): (char, Strategy, bool)| {
        let name = format!("figure5{letter}{suffix}");
        draw(output, series, setting, (&name, strategy, occupancy))
    };
    MAPS.into_par_iter().map(draw).collect()
}

fn draw(
    output: &Output,
    series: &Series,
    setting: &Setting,
    (name, strategy, occupancy): (&str, Strategy, bool),
) -> Result<()> {
    let Some(named) = series.campaign.worlds.first() else { return Ok(()) };
    let (config, _) = input::config(Some(&setting.config))?;
    let set = |config: covmap_explore::Config, (path, value): (&String, &_)| {
        config.overridden(path, value)
    };
    let mut config = setting.overrides.iter().try_fold(config, set)?;
    config.planner.strategy = strategy;
    config.resolution = named.resolution.unwrap_or(config.resolution);
    let world = map_figure::world(named)?;
    let Setting { while_driving, max_scans, .. } = *setting;
    let mission = Mission::new(&world, &config, None, Limits { while_driving, max_scans })?;
    let mut robot = SimulatedRobot::new(&world, &config, 1)?;
    let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(()))?;
    let truth = Truth::new(&world, &mission);
    let score = truth.score(&run.map, &truth.scored_cells(&world, &mission, &run));
    let summary = Summary::new(world.name(), &strategy, 1, &run, &score, 0.0, String::new());
    let pictures = Pictures { mission: &mission, run: &run, truth: &truth, summary: &summary };
    let picture = if occupancy { pictures.occupancy()? } else { pictures.coverage() };
    map_figure::write_picture(output, name, &picture)
}

/// The rows of Table 1: technique, path, share of uncertain cells, each with its interval.
pub(crate) fn table_1(runs: &Runs) -> Vec<[String; 4]> {
    let row = |strategy: &Strategy| {
        let mean = |metric: &str| {
            let mean = runs.paired(&[*strategy], metric).mean(0);
            mean.map_or("–".to_owned(), |m| {
                crate::paper::trial::shown(Some(m.value), m.interval(0.95))
            })
        };
        let technique = match strategy {
            Strategy::Cl => "coverage maps (CL)".to_owned(),
            other => format!("counting: {other}"),
        };
        [technique, mean("path_length_m"), mean("share_uncertain"), mean("scans")]
    };
    runs.strategies().iter().map(row).collect()
}
