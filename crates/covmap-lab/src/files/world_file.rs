//! Worlds from files, and what there is to say about them.

use super::kind;
use crate::error::{Fault, Result, about};
use covmap_io::{MAX_FILE, MapServerMap, load_map_server, read_bytes, read_ron};
use covmap_world::{Scenario, Surface, World};
use std::path::Path;

/// A world, and what there is to say about the file that it was read from.
#[derive(Debug)]
pub struct WorldFile {
    /// The world.
    pub world: World,
    /// What there is to say about its file.
    pub remarks: Remarks,
    /// What tells it from others: a scenario's file, or which cells of a map are solid.
    pub bytes: Vec<u8>,
}

/// What there is to say about a map of map_server; nothing about a scenario.
#[derive(Debug, Default)]
pub struct Remarks {
    /// How much of it is free, occupied, unknown.
    pub areas: Option<String>,
    /// What its owner may not know.
    pub warnings: Vec<String>,
}

/// The world in a scenario or in a map of map_server. What a file does not say about
/// surfaces is `surface`.
///
/// # Errors
/// If the file is no world; what else it is, and what reads it, is said.
pub fn read(file: &Path, surface: Surface) -> Result<WorldFile> {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match extension.as_str() {
        "ron" => {
            let world = World::from_scenario(&scenario(file)?, surface).map_err(about(file))?;
            let bytes = read_bytes(file, MAX_FILE)?;
            Ok(WorldFile { world, remarks: Remarks::default(), bytes })
        }
        "yaml" | "yml" => {
            let map = map(file)?;
            let name = file.file_stem().unwrap_or_default().to_string_lossy();
            let (solid, pose) = (map.solid(), &map.world_from_map);
            let world = World::from_turned_raster(&name, &solid, pose, surface);
            let bytes = solid.values().iter().map(|solid| u8::from(*solid)).collect();
            let remarks = remarks(file, &map);
            Ok(WorldFile { world: world.map_err(about(file))?, remarks, bytes })
        }
        _ => Err(kind::no_world(file)),
    }
}

/// The scenario in a file.
///
/// # Errors
/// If there is none.
pub fn scenario(file: &Path) -> Result<Scenario> {
    read_ron(file).map_err(|error| kind::explained(file, error.into()))
}

/// The map of map_server in a file.
///
/// # Errors
/// If there is none, or nothing in it is free.
pub fn map(file: &Path) -> Result<MapServerMap> {
    let map = load_map_server(file).map_err(|error| kind::explained(file, error.into()))?;
    if map.areas.free <= 0.0 {
        return Err(about(file)(Fault::NothingFree(areas(&map))));
    }
    Ok(map)
}

fn areas(map: &MapServerMap) -> String {
    let areas = &map.areas;
    format!(
        "{:.2} m² free, {:.2} m² occupied, {:.2} m² unknown",
        areas.free, areas.occupied, areas.unknown
    )
}

/// What there is to say about a map.
pub fn remarks(file: &Path, map: &MapServerMap) -> Remarks {
    let (name, size, image) = (file.display(), &map.grid, map.image_size);
    let mut line = format!("{name}: {}", areas(map));
    if (size.width(), size.height()) != image && (size.height(), size.width()) != image {
        line += &format!(
            "; all that is known lies in {} × {} of its {} × {} cells",
            size.width(),
            size.height(),
            image.0,
            image.1
        );
    }
    let turn = map.world_from_map.rotation.angle();
    if turn.abs() > 0.0 {
        line += &format!("; turned by {:.4}°", turn.to_degrees());
    }
    let mut warnings = Vec::new();
    if let Some(image) = &map.image_beside {
        warnings.push(format!(
            "{name}: its image is not where it says; {} is read instead",
            image.display()
        ));
    }
    let free = map.areas.unknown_grey_is_free;
    if free > 0.0 {
        warnings.push(format!(
            "{name}: its thresholds make the grey of unknown cells (205) free: {free:.2} m² that \
             perhaps nobody has seen are free in this world; with `mode: trinary` and \
             `free_thresh: 0.196` they are unknown"
        ));
    }
    Remarks { areas: Some(line), warnings }
}
