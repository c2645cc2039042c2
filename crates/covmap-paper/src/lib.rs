//! Section 5 of Stachniss & Burgard (2003), from runs to verdicts.
//!
//! [`paper`] runs the experiments in a [`Session`], with the paper's parameters and with ours,
//! judges the [claims](claims::all) of section 5 by their [`Evidence`], and writes a report.
//! [`drawing`] makes its figures one by one.
//!
//! Both read `configs` and `scenarios` of the repository, and must be run from there.

mod built_in;
pub mod claims;
mod crossing;
pub mod drawing;
mod echo;
mod error;
mod experiments;
mod figures;
mod fitting;
mod html;
mod limits;
mod oblique;
mod partial_cells;
mod ranking;
mod report;
mod runs;
mod sections;
mod session;
mod tables;
mod techniques;
pub mod trial;
mod why;

pub use error::{PaperError, Result};
pub use figures::gain::write as gain_figures;
pub use fitting::Fitting;
pub use limits::Limits;
pub use oblique::Oblique;
pub use partial_cells::PartialCell;
pub use runs::Runs;
pub use session::{Audience, Series, Session, Steps};

use claims::Evidence;
use covmap_draw::FigureFolder;
use covmap_lab::{Config, FitPlan};
use experiments::{B21R, PAPER, ablation, campaigns};
use report::Report;
use std::path::PathBuf;
use trial::judge;

/// The number of seeds of each oblique wall.
const SEEDS: u64 = 4;

/// Runs all experiments, draws all figures, judges all claims, and writes the report.
///
/// # Errors
/// If any experiment is invalid: then none has run. If a result cannot be written, or the audience
/// stopped the experiments: finished runs stay, and the next call continues with them.
pub fn paper(
    session: &Session<'_>,
    output: &FigureFolder,
    seconds: &dyn Fn() -> f64,
) -> Result<()> {
    check(session)?;
    report::power().iter().for_each(|text| session.tell(text));
    report::clear(output)?;
    let [paper, b21r] = evidence(session, output)?;
    let ablation = ablation(session)?;
    let columns = [judge(claims::all(&paper)), judge(claims::all(&b21r))];
    let (quick, ran) = (session.quick, session.ran());
    let report = Report { quick, columns, paper, b21r, ablation, ran, seconds: seconds() };
    report.write(output)?;
    tell(&report, session);
    Ok(())
}

/// Returns the file that defines the fit of a configuration.
fn fit_file(name: &str) -> PathBuf {
    format!("configs/fit/{name}.ron").into()
}

/// Checks every experiment before the first one runs.
fn check(session: &Session<'_>) -> Result<()> {
    for campaign in campaigns(session)? {
        session.check()?;
        covmap_campaign::check(&campaign, &session.folder(&campaign))?;
    }
    [PAPER, B21R].into_iter().try_for_each(|name| Ok(FitPlan::read(&fit_file(name)).map(drop)?))
}

/// Runs every experiment with both configurations, and draws every figure.
fn evidence(session: &Session<'_>, output: &FigureFolder) -> Result<[Evidence; 2]> {
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
    evidence.try_into().map_err(|_| PaperError::Missing("the data of an experiment"))
}

fn tell(report: &Report, session: &Session<'_>) {
    for (paper, b21r) in report.columns[0].iter().zip(&report.columns[1]) {
        session.tell(&format!(
            "  {:>2}  {:<15} (b21r.ron: {})  {}",
            paper.finding.claim,
            paper.verdict.to_string(),
            b21r.verdict,
            paper.finding.statement
        ));
    }
}
