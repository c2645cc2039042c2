//! Decisions by information gain, against the equations as printed and against themselves.

use crate::clock::{Clock, median, quantile, timed};
use crate::situation::{SEED, Situation};
use crate::table::{RatioRow, RatioTable, duration};
use crate::{Measuring, tiles};
use anyhow::{Context, Result};
use covmap_explore::{Limits, Mission, Run, explore};
use covmap_lab::{Config, SimulatedRobot};
use covmap_plan::{CandidateRecord, Decision, Reason, StallRule, Strategy};
use covmap_world::World;
use nalgebra::Point2;
use std::ops::ControlFlow;

/// The spacing of the places of measurement in the large map \[m\] …
const SPACING: f64 = 1.5;
/// … which lie in this lower part of the map.
const EXPLORED: f64 = 0.7;

/// Returns the configuration with each of the updates, each with its name. The parameters of the
/// other update are the fitted ones.
pub(crate) fn updates(config: &Config) -> [(&'static str, Config); 2] {
    let with = |model| Config { model, ..config.clone() };
    let model = || config.model.clone();
    let by_cause = with(model().with_cause(|_| ()));
    let mut by_product = with(model().with_product(|_| ()));
    // The expected change was fitted for the update by cause.
    by_product.planner.reason = Reason::InSight;
    [("by cause", by_cause), ("by Eq. (9)", by_product)]
}

/// Returns the configuration with the strategy IG.
fn with_gain(config: &Config) -> Config {
    let mut config = config.clone();
    config.planner.strategy = Strategy::Ig;
    config
}

/// Returns the configuration for IG with every cell always a reason to measure: every reachable
/// cell is a candidate.
pub(crate) fn for_ever(config: &Config) -> Config {
    let mut config = with_gain(config);
    config.planner.reason = Reason::InSight;
    config.planner.entropy_threshold = 0.0;
    config.planner.stall_rule = StallRule::Literal;
    (config.planner.stall_limit, config.planner.max_counted_scans) = (1000, 1_000_000);
    config
}

/// Explores a world up to a number of scans.
pub(crate) fn explored(world: &World, config: &Config, scans: usize) -> Result<(Mission, Run)> {
    let limits = Limits { while_driving: None, max_scans: Some(scans) };
    let mission = covmap_lab::mission(world, config, None, limits)?;
    let mut robot = SimulatedRobot::new(world, config, SEED)?;
    let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(()))?;
    Ok((mission, run))
}

/// Measures every E\[I\] of the small map, and the decisions from them, for a named update.
pub(crate) fn small(
    bench: &Measuring<'_>,
    (update, config): &(&str, Config),
    table: &mut RatioTable,
) -> Result<()> {
    let Measuring { extent, progress, .. } = bench;
    let side = extent.small;
    progress.say(&format!("{side} × {side} cells {update}: exploring a part of it …"));
    let world = tiles::offices(side, config.sonar.surface)?;
    let (mission, run) = explored(&world, &with_gain(config), extent.scans)?;
    let for_ever = for_ever(config);
    let mut situation = Situation::new(&world, &mission, &for_ever, Clock::Core)?;
    situation.follow(&run);

    progress.say("every E[I], nothing cached …");
    let (mut all, mut choosing) = (Vec::new(), Vec::new());
    let mut records = Vec::new();
    for _ in 0..extent.rounds.min(3) {
        let mut cold = situation.planner.clone();
        let (seconds, found) = timed(|| cold.candidate_table(&situation.map, situation.at));
        all.push(seconds);
        records = found;
        let mut cold = situation.planner.clone();
        choosing.push(timed(|| cold.choose(&situation.map, situation.at)).0);
    }
    progress.say("E[I] by the equations as printed …");
    let before = compare(&situation, &records, extent.sample)?;
    let oracle = before.seconds * count(records.len());

    let (_, decision) = situation.choose();
    progress.say("the next decisions …");
    let next =
        decide(&mut situation, decision.context("nothing to decide")?, extent.small_decisions)?;
    let records = situation.planner.clone().candidate_table(&situation.map, situation.at);
    let after = compare(&situation, &records, extent.sample.min(20))?;

    let cells = format!("{side} × {side} cells {update}");
    let against = format!("literal f64, {} of {} cells", before.sample, before.of);
    let mut row = |what: String, ours: f64, target: f64| {
        table.row(RatioRow { what, ours, against: against.clone(), other: oracle, target });
    };
    row(format!("E[I] at every reachable cell of {cells}, nothing cached"), median(&all), 1e3);
    row(format!("the whole IG decision on {cells}, nothing cached"), median(&choosing), 1e3);
    row(format!("the next decision on {cells}, after one more scan"), median(&next.seconds), 5e3);
    table.note(format!(
        "{cells}: largest difference from the literal E[I], in units of the largest |E[I]|: {:.1e} \
         before, {:.1e} after {} decisions, by the literal equations at {:.1} view-points each \
         (it must stay below 1e-5: {})",
        before.difference,
        after.difference,
        next.seconds.len(),
        next.literal,
        if before.difference.max(after.difference) < 1e-5 { "it does" } else { "IT DOES NOT" }
    ));
    Ok(())
}

/// Measures the cold decision of the large map, and the next decisions.
pub(crate) fn large(
    bench: &Measuring<'_>,
    (update, config): &(&str, Config),
    table: &mut RatioTable,
) -> Result<()> {
    let Measuring { extent, progress, .. } = bench;
    let side = extent.large;
    progress.say(&format!("{side} × {side} cells {update}: measuring in a part of it …"));
    let world = tiles::offices(side, config.sonar.surface)?;
    let limits = Limits { while_driving: None, max_scans: None };
    let mission = covmap_lab::mission(&world, config, None, limits)?;
    let for_ever = for_ever(config);
    let mut situation = Situation::new(&world, &mission, &for_ever, Clock::Core)?;
    for point in places(&world, config.robot.radius) {
        situation.visit(point);
    }
    situation.visit(mission.start.translation.vector.into());
    progress.say(&format!("{side} × {side} cells {update}: deciding …"));
    let (cold, decision) = situation.choose();
    let decision = decision.context("nothing to decide")?;
    let candidates = decision.candidates;
    let next = decide(&mut situation, decision, extent.large_decisions)?;
    table.row(RatioRow {
        what: format!("the next decision on {side} × {side} cells {update}, after one more scan"),
        ours: median(&next.seconds),
        against: format!("its own cold one, {candidates} cells"),
        other: cold,
        target: 20.0,
    });
    Ok(())
}

/// Returns the places where a robot fits, on a lattice over the explored part.
pub(crate) fn places(world: &World, radius: f64) -> Vec<Point2<f64>> {
    let (low, size) = (world.lower_left(), world.size());
    let along = |first: f64, length: f64| {
        let steps = (0u32..).map(move |i| f64::from(i) * SPACING + 0.5 * SPACING);
        steps.take_while(move |s| *s < length).map(move |s| first + s)
    };
    let rows = along(low.y, EXPLORED * size.y);
    let points = rows.flat_map(|y| along(low.x, size.x).map(move |x| Point2::new(x, y)));
    points.filter(|p| world.clearance(*p) > radius + 0.1).collect()
}

/// A series of decisions.
pub(crate) struct Decisions {
    /// The duration of each decision, from noting the changes to choosing \[s\].
    pub(crate) seconds: Vec<f64>,
    /// The mean number of view-points that the literal equations decided.
    literal: f64,
}

pub(crate) fn decide(
    situation: &mut Situation<'_>,
    first: Decision,
    many: usize,
) -> Result<Decisions> {
    let (mut seconds, mut literal, mut decision) = (Vec::new(), 0, first);
    for _ in 0..many {
        let noted = situation.go(&decision);
        let (chosen, next) = situation.choose();
        seconds.push(noted + chosen);
        let Some(next) = next else { break };
        literal += next.decided_by_oracle;
        decision = next;
    }
    Ok(Decisions { literal: count(literal) / count(seconds.len().max(1)), seconds })
}

/// The comparison over a sample of view-points.
struct Comparison {
    sample: usize,
    of: usize,
    /// The duration of the literal evaluation of one view-point \[s\].
    seconds: f64,
    /// The largest difference, in units of the largest |E\[I\]|.
    difference: f64,
}

fn compare(
    situation: &Situation<'_>,
    records: &[CandidateRecord],
    sample: usize,
) -> Result<Comparison> {
    let largest = records.iter().map(|r| r.gain.abs()).fold(0.0, f64::max);
    let step = (records.len() / sample).max(1);
    let picked: Vec<&CandidateRecord> = records.iter().skip(step / 2).step_by(step).collect();
    let evaluate = |r: &&CandidateRecord| (situation.literal_gain(r.cell) - r.gain).abs();
    let (seconds, worst) = timed(|| picked.iter().map(evaluate).fold(0.0, f64::max));
    let of = records.len();
    anyhow::ensure!(!picked.is_empty() && largest > 0.0, "no view-point to compare");
    let (sample, difference) = (picked.len(), worst / largest);
    Ok(Comparison { sample, of, seconds: seconds / count(sample), difference })
}

/// Measures the duration of decisions in the shipped office, on all threads.
pub(crate) fn office(
    bench: &Measuring<'_>,
    (update, config): &(&str, Config),
    table: &mut RatioTable,
) -> Result<()> {
    let Measuring { extent, progress, .. } = bench;
    progress.say(&format!("decisions in the office {update} …"));
    let world = tiles::office(config.sonar.surface)?;
    let (mission, run) = explored(&world, config, extent.scans.min(40))?;
    let config = with_gain(config);
    let mut situation = Situation::new(&world, &mission, &config, Clock::Wall)?;
    situation.follow(&run);
    let (_, decision) = situation.choose();
    let decision = decision.context("nothing to decide")?;
    let next = decide(&mut situation, decision, extent.office_decisions)?;
    table.note(format!(
        "an IG decision in the office {update} at r = 0.1 m, after a scan, on {} threads: median {}, 99th \
         percentile {} ({} decisions; {:.1} view-points each by the literal equations)",
        rayon::current_num_threads(),
        duration(median(&next.seconds)),
        duration(quantile(&next.seconds, 0.99)),
        next.seconds.len(),
        next.literal,
    ));
    Ok(())
}

fn count(number: usize) -> f64 {
    number as f64
}
