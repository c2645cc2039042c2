//! `model`: the answer of the sensor model to one echo, Fig. 3.

use crate::arguments::Model;
use crate::built_in;
use crate::output;
use crate::terminal::say;
use anyhow::{Result, bail};
use covmap_io::write_file;
use covmap_lab::{echo_table, files};
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Model) -> Result<ExitCode> {
    let (config, name) = files::config(arguments.config.as_deref(), built_in::B21R)?;
    let model = files::check(&config, &name)?;
    let range = arguments.range;
    let usable = model.parameters().usable_range;
    if range > usable {
        bail!("--range {range}: {} has a usable range of {usable} m", name.display());
    }
    let inputs: Vec<&Path> = arguments.config.as_deref().into_iter().collect();
    let replace = output::replace(&arguments.out, arguments.force, &inputs)?;
    let (table, distances) = echo_table(&model, range);
    write_file(&arguments.out, table.as_bytes(), replace)?;
    let bins = model.parameters().bins;
    say::line(format!("{}: {distances} distances, {bins} bins", arguments.out.display()));
    Ok(ExitCode::SUCCESS)
}
