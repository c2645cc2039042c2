//! The figures of `docs/gain.md`: the computation of the expected information gain.
//!
//! All of them show numbers of a run in a small laboratory, up to one of its decisions.

mod beam;
mod decision;
mod errors;
mod memory;
mod moment;
mod nodes;
mod one_cell;
mod style;
mod suffix;

use crate::built_in;
use crate::error::Result;
use covmap_draw::FigureFolder;
use covmap_lab::{Config, files};
use covmap_plan::Strategy;
use moment::Moment;

/// The decision in the figures, counted from 0.
const DECISION: usize = 28;
const QUICK_DECISION: usize = 3;

/// The side of cells in quick figures \[m\].
const COARSE: f64 = 0.2;

/// Draws all six.
pub fn write(output: &FigureFolder, quick: bool) -> Result<()> {
    let by_cause = configuration(files::config(None, built_in::B21R)?.0, quick);
    // Eq. (9) with the same robot, because configs/sonar8.ron has parameters that depend on the
    // range.
    let mut by_product = by_cause.clone();
    by_product.model.update = files::config(None, built_in::SONAR8)?.0.model.update;
    let decision = if quick { QUICK_DECISION } else { DECISION };
    let moment = Moment::reach(&by_cause, decision)?;
    let of_product = Moment::reach(&by_product, decision)?;
    let seen = moment.telling_beam();
    output.drawing("gain-beam", &beam::draw(&moment, seen))?;
    output.figure("gain-nodes", &nodes::figure(&moment.config, &of_product, quick)?)?;
    output.drawing("gain-memory", &memory::draw(&of_product)?)?;
    output.drawing("gain-decision", &decision::draw(&moment)?)?;
    output.drawing("gain-errors", &errors::draw(&moment, &of_product, quick)?)?;
    Ok(output.drawing("gain-sums", &suffix::draw(&moment, seen))?)
}

/// Returns a configuration that explores by IG.
fn configuration(config: Config, quick: bool) -> Config {
    let mut config = config;
    config.planner.strategy = Strategy::Ig;
    if quick {
        config.resolution = COARSE;
    }
    config
}
