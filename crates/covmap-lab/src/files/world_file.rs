//! Worlds from files, and remarks on the files.

use super::kind;
use crate::error::{Fault, Result, about};
use covmap_io::{MAX_FILE, MapServerMap, load_map_server, read_bytes, read_ron};
use covmap_world::{Scenario, Surface, World};
use std::path::Path;

/// A world, and remarks on its file.
#[derive(Debug)]
pub struct WorldFile {
    /// The world.
    pub world: World,
    /// Remarks on the file.
    pub remarks: Remarks,
    /// Bytes that tell the world from others: the file of a scenario, or a byte for each cell of a map,
    /// 1 if the cell is solid.
    pub bytes: Vec<u8>,
}

/// Remarks on a map of map_server; empty for a scenario.
#[derive(Debug, Default)]
pub struct Remarks {
    /// The free, occupied and unknown areas of the map, in words.
    pub areas: Option<String>,
    /// Warnings to the owner of the map.
    pub warnings: Vec<String>,
}

/// Reads the world in a scenario or in a map of map_server. `surface` is the surface of everything
/// without one in the file.
///
/// # Errors
/// If the file is no world; the error says what else it is, and which command reads it.
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

/// Reads the scenario in a file.
///
/// # Errors
/// If the file is no scenario.
pub fn scenario(file: &Path) -> Result<Scenario> {
    read_ron(file).map_err(|error| kind::explained(file, error.into()))
}

/// Reads the map of map_server in a file.
///
/// # Errors
/// If the file is no map, or no area of the map is free.
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

/// Returns remarks on a map.
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
             perhaps were never seen are free in this world; with `mode: trinary` and \
             `free_thresh: 0.196` they are unknown"
        ));
    }
    Remarks { areas: Some(line), warnings }
}
