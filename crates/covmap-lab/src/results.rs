//! The results of a run: files and pictures.

pub mod certificate;
mod partial;
mod pictures;
pub mod reliability;

pub use pictures::{
    Pictures, certain_coverage, draw_coverage, draw_entropy, draw_occupancy, draw_path,
    mark_cut_short,
};

use crate::Experiment;
use crate::error::Result;
use crate::read_out::Reader;
use crate::{Summary, Truth};
use covmap::{Cell, CoverageMap};
use covmap_explore::Run;
use covmap_fit::{ExampleScore, Reliability};
use covmap_io::{
    MapCounts, MapThresholds, OutputFolder, Replace, save_map_server, write_file, write_json,
};
use covmap_world::World;
use serde::Serialize;
use std::path::PathBuf;

/// An exploration: a world, the experiment in it, and the parameters for reading and writing its map.
#[derive(Debug)]
pub struct Task {
    /// The world.
    pub world: World,
    /// The mission in it, and the seed.
    pub experiment: Experiment,
    /// Thresholds of free and occupied cells in the map for other software.
    pub thresholds: MapThresholds,
    /// Reader of the map.
    pub reader: Reader,
}

/// The content of `summary.json` for an exploration.
#[derive(Debug, Serialize)]
pub struct Written {
    /// The numbers of the run.
    #[serde(flatten)]
    pub summary: Summary,
    /// Score of the map over the measured cells, class by class; of the solid cells, only the first
    /// layer counts.
    pub measured: ExampleScore,
    /// File of the read-out for all scores, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub read_out: Option<PathBuf>,
}

/// Writes a map: the whole posterior of `map` as it is, and for map_server the certain cells of `read`, the
/// map as it is read.
///
/// # Errors
/// If a file cannot be written.
pub fn write_map(
    folder: &OutputFolder,
    (map, read): (&CoverageMap, &CoverageMap),
    thresholds: &MapThresholds,
    may_be_free: impl Fn(Cell) -> bool,
) -> Result<MapCounts> {
    let belief = folder.path("belief.bin");
    write_file(belief, &map.to_bytes(), Replace::Any)?;
    Ok(save_map_server(folder.partial(), "map", read, thresholds, may_be_free)?)
}

/// Returns a line of the report on the map for other software.
pub fn map_line(counts: &MapCounts) -> String {
    let MapCounts { free, occupied, unknown } = counts;
    format!("map.pgm: {free} free, {occupied} occupied, {unknown} unknown")
}

/// Writes all results except the trace; returns the numbers of the run and of the map.
///
/// # Errors
/// If a file cannot be written.
pub fn write(
    folder: &OutputFolder,
    task: &Task,
    run: &Run,
    seconds: f64,
    hash: String,
) -> Result<(Written, MapCounts)> {
    let Task { world, experiment, thresholds, reader } = task;
    let mission = &experiment.mission;
    let truth = Truth::new(world, mission);
    let map = &*reader.read(&run.map)?;
    let summary = experiment.summary((world, &truth), (run, map), (seconds, hash));

    let is_inside = |cell| mission.outside.get(cell) == Some(&false);
    let counts = write_map(folder, (&run.map, map), thresholds, is_inside)?;
    let how = reader.in_words();
    let pictures = Pictures { mission, run, map, how: &how, truth: &truth, summary: &summary };
    pictures.coverage().save(folder.path("coverage.png"))?;
    pictures.entropy().save(folder.path("entropy.png"))?;
    pictures.truth().save(folder.path("truth.png"))?;
    pictures.errors(&run.bumped_at).save(folder.path("errors.png"))?;
    pictures.occupancy()?.save(folder.path("occupancy.png"))?;
    pictures.certificate().save(folder.path("certificate.png"))?;
    certificate::write(&folder.path("certificate.csv"), run)?;
    partial::figure(mission, (run, map), &truth, &summary)?
        .save(folder.path("partial.svg"), folder.path("partial.png"))?;
    let measured = measured(map, &truth);
    let of = format!("{}, {} measured cells{how}", pictures.of(), measured.len());
    reliability::figure(&of, &[("", &Reliability::of(&measured))], map.bins())
        .save(folder.path("reliability.svg"), folder.path("reliability.png"))?;
    let measured = ExampleScore::of(measured.iter().map(|(p, truth)| (p, *truth)));
    let written = Written { summary, measured, read_out: reader.file.clone() };
    // Last: if this file is there, all others are.
    write_json(folder.path("summary.json"), &written)?;
    Ok((written, counts))
}

/// The posteriors of the measured cells, and their true coverages.
fn measured(map: &CoverageMap, truth: &Truth) -> Vec<(Vec<f64>, f64)> {
    let coverage = |cell| truth.coverage.get(cell).copied().unwrap_or(1.0);
    let cells = truth.measured_cells(map).into_iter();
    cells.map(|cell| (map.histogram(cell).probabilities().to_vec(), coverage(cell))).collect()
}
