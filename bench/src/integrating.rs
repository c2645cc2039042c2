//! Integrating scans with entropies, against plain f64.

use crate::clock::race;
use crate::decisions::explored;
use crate::literal::LiteralMap;
use crate::table::{RatioRow, RatioTable};
use crate::{Measuring, tiles};
use anyhow::Result;
use covmap::CoverageMap;
use covmap_model::integrate;

pub(crate) fn compare(bench: &Measuring<'_>, table: &mut RatioTable) -> Result<()> {
    let Measuring { config, extent, progress } = bench;
    progress.say("integrating scans …");
    let world = tiles::office(config.sonar.surface)?;
    let (mission, run) = explored(&world, config, extent.scans.min(40))?;
    let grid = mission.grid;
    for (bins, target) in [(11, 10.0), (16, 12.0)] {
        // The plain map knows the update by Eq. (9) only.
        let mut config = (*config).clone();
        config.model = config.model.with_product(|_| ());
        config.model.bins = bins;
        let (_, model) = config.build()?;
        let empty = CoverageMap::new(grid, bins)?;
        let (mut map, mut literal) = (empty.clone(), LiteralMap::new(grid, bins));
        let ours = || {
            map = empty.clone();
            run.scans.iter().map(|scan| integrate(&model, &mut map, scan).len()).sum::<usize>()
        };
        let other = || {
            literal = LiteralMap::new(grid, bins);
            run.scans.iter().for_each(|scan| literal.integrate(&model, scan));
        };
        let (ours, other) = race(extent.rounds, ours, other);
        let scans = run.scans.len() as f64;
        table.row(RatioRow {
            what: format!("integrate a scan of 24 beams by Eq. (9), {bins} bins, with entropies"),
            ours: ours / scans,
            against: "plain f64, without tables".into(),
            other: other / scans,
            target,
        });
        let worst =
            grid.cells().zip(&literal.entropy).map(|(cell, h)| (map.entropy(cell) - h).abs());
        table.note(format!(
            "{bins} bins: largest difference of an entropy from plain f64: {:.1e} nats",
            worst.fold(0.0, f64::max)
        ));
    }
    Ok(())
}
