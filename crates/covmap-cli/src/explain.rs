//! `explain`: the reasons of a decision.

use crate::about::about;
use crate::arguments::Explain;
use crate::explain_picture;
use crate::terminal::say;
use anyhow::Result;
use covmap_io::write_file;
use covmap_lab::{Moment, Trace, in_folder, read_header, replay, results::certificate};
use covmap_plan::{CandidateRecord, Strategy};
use std::process::ExitCode;

pub(crate) fn run(arguments: &Explain) -> Result<ExitCode> {
    let Explain { dir, step, cell, force } = arguments;
    let path = in_folder(dir)?;
    let step = &step.unwrap_or(0);
    if let Some(cell) = cell {
        let grid = read_header(&path)?.grid;
        say::line(certificate::why(&dir.join("certificate.csv"), &grid, *cell)?);
        return Ok(ExitCode::SUCCESS);
    }
    let trace = Trace::read(&path, *step)?;
    let moment = replay(&trace, &path)?;
    let reason = reason(&moment);
    let picture = dir.join(format!("explain-{step}.png"));
    let png = explain_picture::draw(&moment, (&trace.header.world, *step), &reason).to_png();
    write_file(&picture, &png.map_err(about(&picture))?, force.replace())?;
    let config = &moment.mission.config;
    let (strategy, update) = (&config.planner.strategy, config.model.update.name());
    say::line(format!("{}, {strategy}, update {update}: decision {step}", trace.header.world));
    facts(&moment).iter().for_each(|fact| say::line(format!("  {fact}")));
    table(&moment).iter().for_each(say::line);
    say::line(&reason);
    say::line(picture.display());
    Ok(ExitCode::SUCCESS)
}

fn facts(moment: &Moment) -> Vec<String> {
    let Moment { mission, scans, from, decision, candidates, .. } = moment;
    let (at, to) = (mission.grid.center(*from), mission.grid.center(decision.target));
    let gains = || candidates.iter().map(|c| c.gain);
    let range = (gains().fold(f64::INFINITY, f64::min), gains().fold(f64::NEG_INFINITY, f64::max));
    let farthest = candidates.iter().map(|c| c.cost).fold(0.0, f64::max);
    let mut facts = vec![
        format!("after {scans} scans, in the cell at ({:.2}, {:.2})", at.x, at.y),
        format!("{} candidates, up to {farthest:.2} m away", candidates.len()),
        format!(
            "E[I] from {:.4} to {:.4} nats, {} negative",
            range.0,
            range.1,
            negative(candidates)
        ),
        format!("chosen: ({:.2}, {:.2})", to.x, to.y),
    ];
    if decision.candidates != candidates.len() {
        facts.push(format!("{} of the candidates lie in the window", decision.candidates));
    }
    if decision.towards_ground {
        facts.push(
            "no scan is worth its cost: this one looks at the cells that keep the robot off more ground".into(),
        );
    }
    if !decision.passage.is_empty() {
        facts.push(format!(
            "nothing is open in reach: the robot tries a passage of {} cells that look blocked",
            decision.passage.len()
        ));
    }
    if decision.decided_by_oracle > 0 {
        facts.push(format!(
            "{} candidates were so close that the literal equations decided",
            decision.decided_by_oracle
        ));
    }
    facts
}

fn negative(candidates: &[CandidateRecord]) -> usize {
    candidates.iter().filter(|c| c.gain < 0.0).count()
}

/// Returns the table of the five best candidates, the best first.
fn table(moment: &Moment) -> Vec<String> {
    let heading = format!(
        "{:>4} {:>8} {:>8} {:>11} {:>8} {:>10} {:>8} {:>10}",
        "rank", "x [m]", "y [m]", "E[I] [nats]", "d_c [m]", "α·E/max E", "d/max d", "score"
    );
    let row = |(i, c): (usize, &CandidateRecord)| {
        let at = moment.mission.grid.center(c.cell);
        format!(
            "{:>4} {:>8.2} {:>8.2} {:>11.4} {:>8.2} {:>10.4} {:>8.4} {:>10.4}",
            i + 1,
            at.x,
            at.y,
            c.gain,
            c.cost,
            c.gain_term,
            c.cost_term,
            c.score
        )
    };
    std::iter::once(heading).chain(moment.decision.best.iter().enumerate().map(row)).collect()
}

/// Explains in words why the first candidate is the best.
fn reason(moment: &Moment) -> String {
    let Some(best) = moment.decision.best.first() else { return "nothing to choose".into() };
    let CandidateRecord { gain, cost, gain_term, cost_term, score, .. } = best;
    match moment.mission.config.planner.strategy {
        Strategy::Cl => format!("CL takes the closest candidate, Eq. (12): {cost:.2} m away"),
        Strategy::Count { .. } => format!("COUNT takes the closest candidate: {cost:.2} m away"),
        Strategy::Ig => {
            format!("IG takes the largest expected gain, Eq. (15): {gain:.4} nats")
        }
        Strategy::IgWin { .. } => {
            format!("IG_WIN takes the largest expected gain in its window: {gain:.4} nats")
        }
        Strategy::IgCl { .. } => format!(
            "IG_CL takes the largest α·E/max E − d/max d, Eq. (16): \
             {gain_term:.4} − {cost_term:.4} = {score:.4}"
        ),
    }
}
