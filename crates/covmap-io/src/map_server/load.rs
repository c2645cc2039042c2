//! A map of ROS as a raster.

use super::MapServerError;
use super::description::{Description, Mode};
use crate::FileError;
use crate::pgm::Pgm;
use crate::read::{MAX_FILE, read_bytes};
use covmap::{Grid, Raster};
use std::path::Path;

/// What a map says of one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MapCell {
    /// Nothing.
    Unknown,
    /// How occupied it is, in [0, 1]: free 0, occupied 1.
    Occupancy(f64),
}

/// A map of ROS: what map_server would publish of it.
#[derive(Debug, Clone, PartialEq)]
pub struct MapServerMap {
    /// The geometry: one cell for each pixel, the origin of the file as lower left corner.
    pub grid: Grid,
    /// What the map says of each cell.
    pub cells: Raster<MapCell>,
}

impl MapServerMap {
    /// Where a robot cannot be: in occupied and in unknown cells.
    ///
    /// Reading: a cell of graded occupancy (`scale`, `raw`) is occupied from one half on.
    pub fn solid(&self) -> Raster<bool> {
        self.cells.map(|cell| match cell {
            MapCell::Unknown => true,
            MapCell::Occupancy(occupancy) => *occupancy >= 0.5,
        })
    }
}

/// Reads a map as map_server does: the YAML file, and the P5 image that it names, relative
/// to its folder.
///
/// With x a sample over the image's maxval, `negate` taking x to 1 − x, and p = 1 − x:
///
/// ```text
/// trinary   p > occupied_thresh: 1;   p < free_thresh: 0;   else unknown
/// scale     the same, but else .01 + .98 · (p − free_thresh)/(occupied_thresh − free_thresh)
/// raw       255 · x, rounded, is the occupancy in percent; unknown above 100
/// ```
///
/// An image has no transparency, so no cell of a `scale` map is unknown. Keys that
/// map_server does not know are passed over.
///
/// # Errors
/// If the description or the image is missing, cut short, too large, or says something
/// impossible; or if the map is turned (a yaw other than 0).
pub fn load_map_server(yaml: impl AsRef<Path>) -> Result<MapServerMap, FileError> {
    let yaml = yaml.as_ref();
    let description = Description::load(yaml)?;
    let image = yaml.parent().unwrap_or(Path::new("")).join(&description.image);
    let pgm = Pgm::from_bytes(&read_bytes(&image, MAX_FILE)?)
        .map_err(|reason| FileError::Pgm { path: image, reason })?;
    let grid = Grid::new(description.lower_left, description.resolution, pgm.width, pgm.height)
        .map_err(|error| FileError::MapServer {
            path: yaml.to_path_buf(),
            reason: MapServerError::Grid(error),
        })?;
    let top = pgm.height - 1;
    let mut cells = Raster::filled(grid, MapCell::Unknown);
    for (from_top, row) in pgm.samples.chunks_exact(pgm.width).enumerate() {
        let start = (top - from_top) * pgm.width;
        let out = &mut cells.values_mut()[start..start + pgm.width];
        for (cell, sample) in out.iter_mut().zip(row) {
            *cell = interpret(&description, *sample, pgm.max_value);
        }
    }
    Ok(MapServerMap { grid, cells })
}

fn interpret(description: &Description, sample: u16, max_value: u16) -> MapCell {
    let Description { occupied, free, .. } = *description;
    // Integers first, so that p is exact where the thresholds are met exactly.
    let white = if description.negate { max_value - sample } else { sample };
    let p = f64::from(max_value - white) / f64::from(max_value);
    match description.mode {
        Mode::Raw => {
            let percent = (255.0 * f64::from(white) / f64::from(max_value)).round();
            if percent > 100.0 { MapCell::Unknown } else { MapCell::Occupancy(percent / 100.0) }
        }
        _ if p > occupied => MapCell::Occupancy(1.0),
        _ if p < free => MapCell::Occupancy(0.0),
        Mode::Trinary => MapCell::Unknown,
        // The thresholds may be one: then p is that one, and as near to free as to occupied.
        Mode::Scale if occupied <= free => MapCell::Occupancy(0.5),
        Mode::Scale => MapCell::Occupancy(0.01 + 0.98 * (p - free) / (occupied - free)),
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use covmap::Cell;
    use proptest::prelude::*;

    /// Loads a map whose image has these bytes and whose description has these lines more.
    fn load(image: &[u8], lines: &str) -> Result<MapServerMap, String> {
        let folder = tempfile::tempdir().unwrap();
        let yaml = folder.path().join("map.yaml");
        let text = format!(
            "image: sub/map.pgm\nresolution: 0.5\norigin: [-1, 2, 0]\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n{lines}\n"
        );
        std::fs::write(&yaml, text).unwrap();
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        std::fs::write(folder.path().join("sub/map.pgm"), image).unwrap();
        load_map_server(&yaml).map_err(|error| error.to_string())
    }

    /// The map as a picture, the first row the top: `.` free, `#` occupied, `?` unknown, and
    /// a digit for tenths in between.
    #[track_caller]
    fn check(image: &[u8], lines: &str, expected: &str) {
        let map = load(image, lines).unwrap();
        let show = |cell: &MapCell| match cell {
            MapCell::Unknown => '?',
            MapCell::Occupancy(0.0) => '.',
            MapCell::Occupancy(1.0) => '#',
            MapCell::Occupancy(p) => (p * 10.0).floor().to_string().chars().next().unwrap(),
        };
        let rows = map.cells.values().chunks(map.grid.width()).rev();
        let rows: Vec<String> = rows.map(|row| row.iter().map(show).collect()).collect();
        assert_eq!(rows.join("/"), expected);
    }

    const IMAGE: &[u8] = b"P5\n4 2\n255\n\x00\xcd\xfe\xff\x80\x59\x5a\xce";

    #[test]
    fn trinary_takes_what_is_between_the_thresholds_as_unknown() {
        check(IMAGE, "negate: 0", "#?../?#?.");
        check(IMAGE, "negate: 1\nmode: trinary", ".###/??\u{3f}#");
    }

    #[test]
    fn scale_grades_what_is_between_the_thresholds() {
        check(IMAGE, "negate: 0\nmode: scale", "#0../6#9.");
    }

    #[test]
    fn raw_is_a_percentage_and_above_100_unknown() {
        check(b"P5 5 1 255 \x00\x64\x65\xff\x1e", "negate: 0\nmode: raw", ".#??3");
        check(b"P5 5 1 255 \xff\x9b\x9a\x00\xe1", "negate: 1\nmode: raw", ".#??3");
    }

    #[test]
    fn other_largest_samples_mean_the_same() {
        check(b"P5 3 1 1 \x00\x01\x00", "negate: 0", "#.#");
        check(b"P5 3 1 65535 \x00\x00\xcd\xcd\xff\xff", "negate: 0", "#?.");
    }

    #[test]
    fn the_last_row_of_the_image_is_the_lowest_of_the_map() {
        let map = load(IMAGE, "negate: 0").unwrap();
        assert_eq!(map.grid.lower_left(), nalgebra::Point2::new(-1.0, 2.0));
        assert_eq!((map.grid.resolution(), map.grid.width(), map.grid.height()), (0.5, 4, 2));
        assert_eq!(map.cells.get(Cell::new(1, 0)), Some(&MapCell::Occupancy(1.0)));
        assert_eq!(map.cells.get(Cell::new(0, 1)), Some(&MapCell::Occupancy(1.0)));
    }

    #[test]
    fn occupied_and_unknown_cells_are_solid() {
        let solid = load(IMAGE, "negate: 0").unwrap().solid();
        assert_eq!(solid.values(), [true, true, true, false, true, true, false, false]);
    }

    #[test]
    fn a_bad_image_is_named() {
        let error = load(b"P2 1 1 255 0", "negate: 0").unwrap_err();
        assert!(error.contains("sub/map.pgm: a PGM image in text form (P2)"), "{error}");
        let folder = tempfile::tempdir().unwrap();
        let yaml = folder.path().join("map.yaml");
        let text = "image: none.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";
        std::fs::write(&yaml, text).unwrap();
        let error = load_map_server(&yaml).unwrap_err().to_string();
        assert!(error.contains("none.pgm: cannot be read: No such file"), "{error}");
    }

    #[test]
    fn maps_of_real_buildings_load() {
        let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/maps");
        for (name, width, height) in [("carmen_freiburg", 300, 300), ("brsu-c069", 576, 544)] {
            let here = |ending: &str| maps.join(format!("{name}.{ending}"));
            if !here("pgm").exists() || !here("yaml").exists() {
                println!("skipped: {name} is not here");
                continue;
            }
            // One of them names its image `map.pgm`.
            let folder = tempfile::tempdir().unwrap();
            let yaml = folder.path().join("map.yaml");
            std::fs::copy(here("yaml"), &yaml).unwrap();
            for image in ["map.pgm".to_string(), format!("{name}.pgm")] {
                std::fs::copy(here("pgm"), folder.path().join(image)).unwrap();
            }
            let map = load_map_server(&yaml).unwrap();
            assert_eq!((map.grid.width(), map.grid.height()), (width, height));
            let solid = map.solid().values().iter().filter(|solid| **solid).count();
            assert!(solid > 0 && solid < map.grid.len());
        }
    }

    proptest! {
        #[test]
        fn every_occupancy_lies_in_its_range(
            sample in any::<u16>(), max_value in 1..=u16::MAX, negate in any::<bool>(),
            free in 0.0..=1.0f64, over in 0.0..=1.0f64, mode in 0..3usize,
        ) {
            let description = Description {
                image: String::new(),
                resolution: 1.0,
                lower_left: nalgebra::Point2::origin(),
                negate,
                occupied: free + over * (1.0 - free),
                free,
                mode: [Mode::Trinary, Mode::Scale, Mode::Raw][mode],
            };
            match interpret(&description, sample.min(max_value), max_value) {
                MapCell::Unknown => prop_assert!(mode != 1),
                MapCell::Occupancy(p) => prop_assert!((0.0..=1.0).contains(&p)),
            }
        }
    }
}
