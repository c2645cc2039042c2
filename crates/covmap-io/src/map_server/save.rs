//! A map of coverage as a map of ROS.

use crate::FileError;
use crate::new_file::{Replace, write_file};
use crate::pgm::pgm_bytes;
use covmap::Raster;
use std::path::Path;

/// From which coverage on a cell is free or occupied for ROS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoverageThresholds {
    /// Up to this coverage a cell is free.
    pub free: f64,
    /// From this coverage on a cell is occupied.
    pub occupied: f64,
}

impl Default for CoverageThresholds {
    /// Free up to 0.2, occupied from 0.5 on.
    fn default() -> Self {
        Self { free: 0.2, occupied: 0.5 }
    }
}

const OCCUPIED: u8 = 0;
const UNKNOWN: u8 = 205;
const FREE: u8 = 254;
/// The greys between: their p = (255 − grey)/255 lies in .25..=.6, safely between the
/// thresholds that are written, .196 and .65.
const NEARLY_FREE: f64 = 191.0;
const NEARLY_OCCUPIED: f64 = 102.0;

/// Writes `STEM.pgm` and `STEM.yaml` into a folder, such that map_server, and
/// [`load_map_server`](crate::load_map_server), read the map of a robot that knows `coverage`
/// of each cell, and nothing of the cells with `None`.
///
/// ```text
/// coverage ≤ free       grey 254          read as free
/// coverage ≥ occupied   grey 0            read as occupied
/// between               grey 191 … 102    read as unknown, so that no robot drives there
/// None                  grey 205          read as unknown: (255 − 205)/255 = .196078 > .196
/// ```
///
/// The mode is trinary and says so: read in mode `scale`, grey 205 would be nearly free.
///
/// # Errors
/// If a file cannot be written, or the stem has characters that would need quotes in YAML.
pub fn save_map_server(
    folder: impl AsRef<Path>,
    stem: &str,
    coverage: &Raster<Option<f64>>,
    thresholds: CoverageThresholds,
) -> Result<(), FileError> {
    let folder = folder.as_ref();
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    if stem.is_empty() || !stem.chars().all(plain) || stem.starts_with(['-', '.']) {
        return Err(FileError::Unwritable {
            path: folder.join(stem),
            message: "the name of a map is made of a–z, A–Z, 0–9, `-`, `_` and `.`".into(),
        });
    }
    let grid = coverage.grid();
    let rows = coverage.values().chunks_exact(grid.width()).rev();
    let greys: Vec<u8> = rows.flatten().map(|coverage| grey(*coverage, thresholds)).collect();
    let comment = format!("covmap, {} m/pixel", grid.resolution());
    let image = pgm_bytes(grid.width(), grid.height(), &comment, &greys);
    write_file(folder.join(format!("{stem}.pgm")), &image, Replace::Any)?;
    let corner = grid.lower_left();
    let yaml = format!(
        "image: {stem}.pgm\nmode: trinary\nresolution: {:?}\norigin: [{:?}, {:?}, 0.0]\n\
         negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
        grid.resolution(),
        corner.x,
        corner.y,
    );
    write_file(folder.join(format!("{stem}.yaml")), yaml.as_bytes(), Replace::Any)
}

fn grey(coverage: Option<f64>, thresholds: CoverageThresholds) -> u8 {
    let CoverageThresholds { free, occupied } = thresholds;
    match coverage.filter(|coverage| !coverage.is_nan()) {
        None => UNKNOWN,
        Some(coverage) if coverage >= occupied => OCCUPIED,
        Some(coverage) if coverage <= free => FREE,
        Some(coverage) => {
            let t = (coverage - free) / (occupied - free);
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "t is in 0..1"
            )]
            let grey = (NEARLY_FREE + t * (NEARLY_OCCUPIED - NEARLY_FREE)).round() as u8;
            grey
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MapCell, load_map_server};
    use covmap::Grid;
    use nalgebra::Point2;
    use proptest::prelude::*;

    fn round_trip(coverage: &Raster<Option<f64>>) -> crate::MapServerMap {
        let folder = tempfile::tempdir().unwrap();
        save_map_server(folder.path(), "map", coverage, CoverageThresholds::default()).unwrap();
        load_map_server(folder.path().join("map.yaml")).unwrap()
    }

    #[test]
    fn unknown_stays_unknown_when_read_back() {
        let grid = Grid::new(Point2::new(-3.25, 1.0 / 3.0), 0.1, 3, 2).unwrap();
        let coverage = vec![None, Some(0.0), Some(0.2), Some(0.3), Some(0.5), Some(1.0)];
        let map = round_trip(&Raster::from_values(grid, coverage).unwrap());
        assert_eq!(map.grid, grid);
        use MapCell::{Occupancy, Unknown};
        let (free, occupied) = (Occupancy(0.0), Occupancy(1.0));
        assert_eq!(map.cells.values(), [Unknown, free, free, Unknown, occupied, occupied]);
    }

    #[test]
    fn a_name_that_leaves_the_folder_is_refused() {
        let grid = Grid::new(Point2::origin(), 0.1, 1, 1).unwrap();
        let map = Raster::filled(grid, None);
        for stem in ["", "../map", "a: b", ".hidden", "-"] {
            let saved = save_map_server("nowhere", stem, &map, CoverageThresholds::default());
            assert!(matches!(saved, Err(FileError::Unwritable { .. })));
        }
    }

    proptest! {
        #[test]
        fn a_cell_of_middle_coverage_is_neither_free_nor_unknown_grey(coverage in 0.2001..0.4999f64) {
            let grey = grey(Some(coverage), CoverageThresholds::default());
            prop_assert!((102..=191).contains(&grey));
        }

        #[test]
        fn every_map_comes_back_as_its_thresholds_say(
            values in prop::collection::vec(prop::option::of(0.0..=1.0f64), 12),
            x in -1e6..1e6f64, r in 1e-3..10.0f64,
        ) {
            let grid = Grid::new(Point2::new(x, -x / 3.0), r, 4, 3).unwrap();
            let coverage = Raster::from_values(grid, values).unwrap();
            let map = round_trip(&coverage);
            prop_assert_eq!(map.grid, grid);
            for (cell, coverage) in map.cells.values().iter().zip(coverage.values()) {
                let expected = match coverage {
                    Some(c) if *c >= 0.5 => MapCell::Occupancy(1.0),
                    Some(c) if *c <= 0.2 => MapCell::Occupancy(0.0),
                    _ => MapCell::Unknown,
                };
                prop_assert_eq!(*cell, expected);
            }
        }
    }
}
