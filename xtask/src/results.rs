//! What a run leaves behind.

use crate::explore::Task;
use crate::partial;
use crate::pictures::Pictures;
use anyhow::Result;
use covmap::{Cell, CoverageMap};
use covmap_explore::{CutOff, Run, Summary, Truth};
use covmap_io::{
    MapCounts, MapThresholds, OutputFolder, Replace, save_map_server, write_file, write_json,
};

/// Writes a map: the whole posterior, and what is safe to know of it for map_server.
pub(crate) fn write_map(
    folder: &OutputFolder,
    map: &CoverageMap,
    thresholds: &MapThresholds,
    may_be_free: impl Fn(Cell) -> bool,
) -> Result<MapCounts> {
    let belief = folder.path("belief.bin");
    write_file(belief, &map.to_bytes(), Replace::Any)?;
    Ok(save_map_server(folder.partial(), "map", map, thresholds, may_be_free)?)
}

/// A line of the report: what other software is told.
pub(crate) fn map_line(counts: &MapCounts) -> String {
    let MapCounts { free, occupied, unknown } = counts;
    format!("map.pgm: {free} free, {occupied} occupied, {unknown} unknown")
}

/// Writes everything but the trace, and returns the numbers, also those of the map.
pub(crate) fn write(
    folder: &OutputFolder,
    task: &Task,
    run: &Run,
    seconds: f64,
    hash: String,
) -> Result<(Summary, MapCounts)> {
    let Task { world, mission, seed, thresholds } = task;
    let truth = Truth::new(world, mission);
    let score = truth.score(&run.map, &truth.scored_cells(world, mission, run));
    let summary = Summary::new(
        world.name(),
        &mission.config,
        *seed,
        run,
        (&score, CutOff::new(&truth, mission, run)),
        seconds,
        hash,
    );

    let is_inside = |cell| mission.outside.get(cell) == Some(&false);
    let counts = write_map(folder, &run.map, thresholds, is_inside)?;
    let pictures = Pictures { mission, run, truth: &truth, summary: &summary };
    pictures.coverage().save(folder.path("coverage.png"))?;
    pictures.entropy().save(folder.path("entropy.png"))?;
    pictures.truth().save(folder.path("truth.png"))?;
    pictures.errors(&run.bumped_at).save(folder.path("errors.png"))?;
    pictures.occupancy()?.save(folder.path("occupancy.png"))?;
    pictures.certificate().save(folder.path("certificate.png"))?;
    partial::figure(mission, run, &truth, &summary)?
        .save(folder.path("partial.svg"), folder.path("partial.png"))?;
    // Last: whoever finds it finds all the others.
    write_json(folder.path("summary.json"), &summary)?;
    Ok((summary, counts))
}
