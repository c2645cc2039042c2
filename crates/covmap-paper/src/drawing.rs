//! From experiments to figures: `figure N` draws one of them, `paper` all.

use crate::built_in;
use crate::error::Result;
use crate::experiments::{B21R, PAPER, campaign, n_star, worlds};
use crate::figures::{fig1, fig2, fig3, fig5, fig6, fig7};
use crate::partial_cells::{self, PartialCell};
use crate::runs::Runs;
use crate::session::{Series, Session};
use covmap_campaign::{PARAMETERS, parameters};
use covmap_draw::FigureFolder;
use covmap_lab::{Config, files};
use covmap_model::SensorModel;
use covmap_plan::Strategy;
use std::path::PathBuf;

/// The number of seeds of Fig. 1 and 2.
const SEEDS: u64 = 100;
const QUICK_SEEDS: u64 = 20;

/// Returns one of the two configurations, as shipped, by its name.
pub fn config(name: &str) -> Result<(Config, PathBuf)> {
    let built_in = if name == PAPER { built_in::PAPER } else { built_in::B21R };
    Ok(files::config(None, built_in)?)
}

/// Makes Fig. 1 and 2: the cell with a coverage of 20 %, with both configurations.
pub fn cells(session: &Session<'_>, output: &FigureFolder) -> Result<[Vec<PartialCell>; 2]> {
    let seeds = if session.quick { QUICK_SEEDS } else { SEEDS };
    let measure = |name| partial_cells::measure(&config(name)?.0, seeds);
    let (paper, b21r) = (measure(PAPER)?, measure(B21R)?);
    fig1::write(output, &paper, "paper.ron")?;
    fig2::write(output, &[("paper.ron", &paper), ("b21r.ron", &b21r)])?;
    Ok([paper, b21r])
}

/// Makes Fig. 3: both sensor models.
pub fn models(output: &FigureFolder) -> Result<[SensorModel; 2]> {
    let model = |name| -> Result<SensorModel> {
        let (config, file) = config(name)?;
        Ok(files::check(&config, &file)?)
    };
    let (paper, b21r) = (model(PAPER)?, model(B21R)?);
    fig3::write(output, &[("paper", &paper), ("b21r", &b21r)])?;
    Ok([paper, b21r])
}

/// Makes Fig. 5 and Table 1: the corridor, with extended counting up to n* as well.
pub fn corridor(session: &Session<'_>, output: &FigureFolder) -> Result<[Runs; 2]> {
    let table_1 = session.run(campaign("table1", session.quick)?)?;
    let extended = n_star(session, &table_1)?;
    let runs = |name: &str| {
        let mut runs = table_1.runs(name, true);
        runs.runs.extend(extended.runs(name, true).runs);
        runs
    };
    let both = [runs(PAPER), runs(B21R)];
    let mut rows = Vec::new();
    for (name, runs) in [PAPER, B21R].into_iter().zip(&both) {
        if let Some(setting) = table_1.setting(name, true) {
            fig5::write(output, session, &table_1, setting, &suffix(name))?;
        }
        let row = |(strategy, cells): (Strategy, [String; 5])| -> Vec<String> {
            let [technique, numbers @ ..] = cells.map(|cell| format!("\"{cell}\""));
            [name.to_owned(), technique]
                .into_iter()
                .chain(parameters(&strategy))
                .chain(numbers)
                .collect()
        };
        rows.extend(fig5::table_1(runs).into_iter().map(row));
    }
    let numbers = ["path_m", "share_with_h_above_0.65", "scans", "cut_short"];
    let columns = [&["config", "technique"], &PARAMETERS[..], &numbers].concat();
    output.table("table1", &columns, &rows)?;
    Ok(both)
}

/// Makes Fig. 6: scan counting up to n.
pub fn counting(session: &Session<'_>, output: &FigureFolder) -> Result<[Runs; 2]> {
    let series = session.run(campaign("fig6", session.quick)?)?;
    let both = [series.runs(PAPER, true), series.runs(B21R, true)];
    let columns: Vec<(&str, &Runs)> =
        [PAPER, B21R].into_iter().zip(&both).filter(|(_, runs)| !runs.runs.is_empty()).collect();
    fig6::write(output, &columns)?;
    Ok(both)
}

/// Makes Fig. 7: all strategies, at view-points only and while driving.
pub fn strategies(session: &Session<'_>, output: &FigureFolder) -> Result<[[Runs; 2]; 2]> {
    let series = session.run(campaign("fig7", session.quick)?)?;
    let one = |name: &str| -> Result<[Runs; 2]> {
        let (still, driving) = (series.runs(name, false), series.runs(name, true));
        let title = format!("Fig. 7: the strategies, with {name}.ron");
        let columns: [(&str, &Runs); 2] =
            [("measuring at view-points only", &still), ("measuring while driving", &driving)];
        let there: Vec<(&str, &Runs)> =
            columns.into_iter().filter(|(_, runs)| !runs.runs.is_empty()).collect();
        fig7::write(output, &format!("figure7{}", suffix(name)), &title, &there)?;
        if let Some(setting) = series.setting(name, false) {
            fig7::write_trajectories(output, &series, &setting.name, &suffix(name))?;
        }
        Ok([still, driving])
    };
    Ok([one(PAPER)?, one(B21R)?])
}

/// Runs some strategies in other worlds (claim 17), and returns the names of the maps of map_server
/// among these worlds.
pub fn places(session: &Session<'_>, output: &FigureFolder) -> Result<([Runs; 2], Vec<String>)> {
    let series: Series = session.run(worlds(session)?)?;
    let there = series.campaign.worlds.iter().filter(|world| !world.is_left_out());
    let maps = there.filter(|world| world.is_map()).map(|world| world.name.clone()).collect();
    let both = [series.runs(PAPER, false), series.runs(B21R, false)];
    for (name, runs) in [PAPER, B21R].into_iter().zip(&both) {
        let worlds: Vec<(String, Runs)> =
            runs.worlds().into_iter().map(|world| (world.clone(), runs.in_world(&world))).collect();
        let columns: Vec<(&str, &Runs)> =
            worlds.iter().map(|(world, runs)| (world.as_str(), runs)).collect();
        let title = format!("The strategies in other worlds, with {name}.ron");
        fig7::write(output, &format!("worlds{}", suffix(name)), &title, &columns)?;
    }
    Ok((both, maps))
}

/// Returns the suffix of a figure's name: none for the configuration that decides.
fn suffix(name: &str) -> String {
    if name == PAPER { String::new() } else { format!("-{name}") }
}
