//! `paper`: section 5 of the paper, from runs to verdicts.

pub(crate) mod claims;
pub(crate) mod crossing;
pub(crate) mod drawing;
mod experiments;
mod fitting;
mod html;
mod limits;
mod oblique;
pub(crate) mod ranking;
mod report;
pub(crate) mod runs;
pub(crate) mod session;
mod tables;
pub(crate) mod trial;

pub(crate) use session::Session;

use crate::arguments::Paper;
use crate::campaign;
use crate::figure::draw;
use crate::figures::Output;
use crate::fit_file::FitPlan;
use crate::say;
use anyhow::Result;
use claims::Evidence;
use covmap_lab::Config;
use experiments::{B21R, PAPER, ablation, campaigns};
use fitting::Fitting;
use limits::Limits;
use oblique::Oblique;
use report::Report;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use trial::judge;

/// Seeds of each oblique wall.
const SEEDS: u64 = 4;

pub(crate) fn run(arguments: &Paper) -> Result<ExitCode> {
    draw(&arguments.common, &arguments.worlds, |session, output| {
        let begun = Instant::now();
        check(session)?;
        report::clear(output)?;
        let [paper, b21r] = evidence(session, output)?;
        let ablation = ablation(session)?;
        let columns = [judge(claims::all(&paper)), judge(claims::all(&b21r))];
        let seconds = begun.elapsed().as_secs_f64();
        let (quick, ran) = (session.quick, session.ran());
        let report = Report { quick, columns, paper, b21r, ablation, ran, seconds };
        report.write(output)?;
        if !session.quiet {
            tell(&report);
        }
        Ok(())
    })
}

/// The file that says what is fitted to what for a configuration.
fn fit_file(name: &str) -> PathBuf {
    format!("configs/fit/{name}.ron").into()
}

/// Finds what is wrong with any experiment before the first one is run.
fn check(session: &Session<'_>) -> Result<()> {
    for campaign in campaigns(session)? {
        session.check()?;
        campaign::check(&campaign, &session.folder(&campaign))?;
    }
    [PAPER, B21R].into_iter().try_for_each(|name| FitPlan::read(&fit_file(name)).map(|_| ()))
}

/// Runs every experiment with both configurations, and draws every figure.
fn evidence(session: &Session<'_>, output: &Output) -> Result<[Evidence; 2]> {
    let cells = drawing::cells(session, output)?;
    let models = drawing::models(output)?;
    let corridor = drawing::corridor(session, output)?;
    let counting = drawing::counting(session, output)?;
    let strategies = drawing::strategies(session, output)?;
    let (places, maps) = drawing::places(session, output)?;
    let mut evidence = Vec::new();
    let mut parts = cells.into_iter().zip(models).zip(corridor).zip(counting);
    let mut rest = strategies.into_iter().zip(places);
    for name in [PAPER, B21R] {
        session.check()?;
        let Some((((cells, model), corridor), counting)) = parts.next() else { break };
        let Some(([at_view_points, while_driving], places)) = rest.next() else { break };
        session.tell(&format!("{name}.ron: a fit, oblique walls, and the ends of IG_CL"));
        let (config, _): (Config, _) = drawing::config(name)?;
        evidence.push(Evidence {
            cells,
            model,
            fitting: Fitting::measure(&fit_file(name), session)?,
            oblique: Oblique::measure(&config, if session.quick { 1 } else { SEEDS })?,
            corridor,
            counting,
            at_view_points,
            while_driving,
            places,
            maps: maps.clone(),
            limits: Limits::measure(&config, session)?,
            speed: config.robot.speed,
        });
    }
    evidence.try_into().map_err(|_| anyhow::anyhow!("an experiment has no data"))
}

fn tell(report: &Report) {
    for (paper, b21r) in report.columns[0].iter().zip(&report.columns[1]) {
        say::line(format!(
            "  {:>2}  {:<15} (b21r.ron: {})  {}",
            paper.finding.claim,
            paper.verdict.to_string(),
            b21r.verdict,
            paper.finding.statement
        ));
    }
}
