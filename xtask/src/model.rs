//! `model`: what the sensor model makes of one echo, Fig. 3.

use crate::arguments::Model;
use crate::{csv_file, input, say};
use anyhow::{Result, bail};
use covmap_model::{Outcome, SensorModel};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Model) -> Result<ExitCode> {
    let (config, name) = input::config(arguments.config.as_deref())?;
    let model = input::check(&config, &name)?;
    let range = arguments.range;
    let usable = model.parameters().usable_range;
    if range > usable {
        bail!("--range {range}: {} has a usable range of {usable} m", name.display());
    }
    let distances = write_table(&arguments.out, &model, range)?;
    let bins = model.parameters().bins;
    say::line(format!("{}: {distances} distances, {bins} bins", arguments.out.display()));
    Ok(ExitCode::SUCCESS)
}

/// Writes what the model makes of an echo, and returns for how many distances.
pub(crate) fn write_table(out: &Path, model: &SensorModel, range: f64) -> Result<usize> {
    let distances = cell_distances(model, range);
    let bins = model.parameters().bins;
    csv_file::write(out, |table| {
        writeln!(table, "cell_distance,coverage,probability")?;
        let mut column = vec![0.0; bins];
        for distance in &distances {
            model.evidence(*distance, Outcome::Echo(range), &mut column);
            for (bin, probability) in column.iter().enumerate() {
                let coverage = covmap::bin_coverage(bin, bins);
                writeln!(table, "{distance:?},{coverage:?},{probability:?}")?;
            }
        }
        Ok(())
    })?;
    Ok(distances.len())
}

/// From r/2 to .20 m behind the end cell, as in Fig. 3, in steps of r/10 \[m\]; farther if
/// the echo updates cells farther behind.
pub(crate) fn cell_distances(model: &SensorModel, range: f64) -> Vec<f64> {
    let resolution = model.resolution();
    let behind = model.parameters().behind.max(0.20);
    let last = range + 0.5 * resolution + behind + 1e-9 * resolution;
    (5u32..).map(|i| f64::from(i) * resolution / 10.0).take_while(|d| *d <= last).collect()
}
