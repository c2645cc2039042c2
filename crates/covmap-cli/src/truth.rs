//! `truth`: the exact coverage of every cell.

use crate::about::about;
use crate::arguments::Truth;
use crate::output;
use crate::terminal::say;
use anyhow::Result;
use covmap_io::csv;
use covmap_lab::files::{self, WorldFile};
use covmap_world::Surface;
use std::io::Write;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Truth) -> Result<ExitCode> {
    let Truth { world: file, resolution, out, force } = arguments;
    let replace = output::replace(out, *force, &[file])?;
    // Coverage does not depend on the answer of a surface.
    let WorldFile { world, remarks, .. } = files::read(file, Surface::Rough)?;
    let grid = world.grid(*resolution).map_err(about(file))?;
    let coverage = world.coverage(&grid);
    csv::write_to(out, replace, |table| {
        writeln!(table, "x,y,coverage")?;
        for (cell, coverage) in coverage.iter() {
            let center = grid.center(cell);
            // Rust prints enough digits to recover the number.
            writeln!(table, "{:?},{:?},{coverage:?}", center.x, center.y)?;
        }
        Ok(())
    })?;
    say::remarks(&remarks);
    say::line(format!("{}: {} × {} cells", out.display(), grid.width(), grid.height()));
    Ok(ExitCode::SUCCESS)
}
