//! `truth`: the exact coverage of every cell.

use crate::arguments::Truth;
use crate::input::about;
use crate::world_file::{self, WorldFile};
use crate::{csv_file, output, say};
use anyhow::Result;
use covmap_world::Surface;
use std::io::Write;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Truth) -> Result<ExitCode> {
    let Truth { world: file, resolution, out, force } = arguments;
    let replace = output::replace(out, *force, &[file])?;
    // Coverage does not depend on how a surface answers.
    let WorldFile { world, remarks, .. } = world_file::read(file, Surface::Rough)?;
    let grid = world.grid(*resolution).map_err(about(file))?;
    let coverage = world.coverage(&grid);
    csv_file::write_to(out, replace, |table| {
        writeln!(table, "x,y,coverage")?;
        for (cell, coverage) in coverage.iter() {
            let center = grid.center(cell);
            // Rust prints as many digits as bring the number back.
            writeln!(table, "{:?},{:?},{coverage:?}", center.x, center.y)?;
        }
        Ok(())
    })?;
    remarks.say();
    say::line(format!("{}: {} × {} cells", out.display(), grid.width(), grid.height()));
    Ok(ExitCode::SUCCESS)
}
