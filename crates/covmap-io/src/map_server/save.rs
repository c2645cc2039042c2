//! A coverage map as a map of ROS.

use crate::FileError;
use crate::new_file::{Replace, write_file};
use crate::pgm::pgm_bytes;
use covmap::{Cell, CoverageMap};
use std::path::Path;

/// Thresholds by which a cell is free or occupied to other software; all other cells are unknown to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapThresholds {
    /// Above this entropy a cell is not free \[nats\].
    pub entropy: f64,
    /// Above this entropy a cell is not occupied \[nats\]. Infinite, unless the user sets it: a
    /// cell that is most likely occupied is better taken for an obstacle, however uncertain it is.
    pub occupied_entropy: f64,
    /// Up to this most likely coverage a cell is free.
    pub free: f64,
    /// From this most likely coverage on a cell is occupied, even if the coverage is not above `free`.
    pub occupied: f64,
}

/// Numbers of free, occupied and unknown cells to other software.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MapCounts {
    /// Cells where a robot may drive.
    pub free: usize,
    /// Cells where a robot may not drive.
    pub occupied: usize,
    /// All other cells.
    pub unknown: usize,
}

const OCCUPIED: u8 = 0;
const UNKNOWN: u8 = 205;
const FREE: u8 = 254;

impl MapThresholds {
    /// Returns the largest entropy of a free cell, in a map of n bins \[nats\]: `entropy`, but at
    /// most ½ ln n. At ½ ln n a posterior is as wide as a uniform one over √n bins: a cell above
    /// that rests on next to nothing, whatever `entropy` says.
    pub fn largest_entropy(&self, bins: usize) -> f64 {
        let next_to_nothing = 0.5 * libm::log(bins as f64);
        self.entropy.min(next_to_nothing)
    }

    /// Returns the largest entropy of an occupied cell \[nats\]: `occupied_entropy`, but at most
    /// .95 ln n, since a posterior that is all but uniform says nothing.
    pub fn largest_occupied_entropy(&self, bins: usize) -> f64 {
        let all_but_uniform = 0.95 * libm::log(bins as f64);
        self.occupied_entropy.min(all_but_uniform)
    }

    fn grey(&self, map: &CoverageMap, cell: Cell, may_be_free: bool) -> u8 {
        let is_resolved = map.entropy(cell) <= self.largest_entropy(map.bins());
        match map.mode(cell) {
            _ if !map.is_known(cell) => UNKNOWN,
            mode if mode >= self.occupied => {
                if map.entropy(cell) <= self.largest_occupied_entropy(map.bins()) {
                    OCCUPIED
                } else {
                    UNKNOWN
                }
            }
            mode if mode <= self.free && may_be_free && is_resolved => FREE,
            _ => UNKNOWN,
        }
    }

    /// Describes the rules for free, occupied and unknown cells, a line each.
    fn in_words(&self, map: &CoverageMap) -> String {
        let rounded = |entropy: f64| (1e4 * entropy).round() / 1e4;
        let entropy = rounded(self.largest_entropy(map.bins()));
        let occupied = rounded(self.largest_occupied_entropy(map.bins()));
        format!(
            "covmap, {} m a pixel\n\
             free (254): known, entropy <= {entropy} nats, most likely coverage <= {}\n\
             occupied (0): known, entropy <= {occupied} nats, most likely coverage >= {}\n\
             unknown (205): all else",
            map.grid().resolution(),
            self.free,
            self.occupied,
        )
    }
}

/// Writes `STEM.pgm` and `STEM.yaml` into a folder. From them map_server, and
/// [`load_map_server`](crate::load_map_server), read a map that is safe to drive by. Returns the
/// numbers of free, occupied and unknown cells.
///
/// ```text
/// free       grey 254   the cell is known, its entropy at most `entropy` (and ½ ln n),
///                       its most likely coverage at most `free`, and it `may_be_free`:
///                       beyond the extent of what was explored nothing is
/// occupied   grey 0     the cell is known, its entropy at most `occupied_entropy`, and its most
///                       likely coverage at least `occupied`
/// unknown    grey 205   all else: (255 − 205)/255 = .196078 > .196, the `free_thresh`
/// ```
///
/// Comments in both files name the thresholds. The YAML file says that the mode is trinary: read in
/// mode `scale`, grey 205 would be nearly free.
///
/// # Errors
/// If a file cannot be written, or the stem has characters that would need quotes in YAML.
pub fn save_map_server(
    folder: impl AsRef<Path>,
    stem: &str,
    map: &CoverageMap,
    thresholds: &MapThresholds,
    may_be_free: impl Fn(Cell) -> bool,
) -> Result<MapCounts, FileError> {
    let folder = folder.as_ref();
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    if stem.is_empty() || !stem.chars().all(plain) || stem.starts_with(['-', '.']) {
        return Err(FileError::Unwritable {
            path: folder.join(stem),
            message: "the name of a map is made of a–z, A–Z, 0–9, `-`, `_` and `.`".into(),
        });
    }
    let grid = map.grid();
    let grey = |cell| thresholds.grey(map, cell, may_be_free(cell));
    let greys: Vec<u8> = grid.cells().map(grey).collect();
    let from_top: Vec<u8> = greys.chunks_exact(grid.width()).rev().flatten().copied().collect();
    let comment = thresholds.in_words(map);
    let image = pgm_bytes(grid.width(), grid.height(), &comment, &from_top);
    write_file(folder.join(format!("{stem}.pgm")), &image, Replace::Any)?;
    let comment: String = comment.lines().map(|line| format!("# {line}\n")).collect();
    let corner = grid.lower_left();
    let yaml = format!(
        "{comment}image: {stem}.pgm\nmode: trinary\nresolution: {:?}\n\
         origin: [{:?}, {:?}, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
        grid.resolution(),
        corner.x,
        corner.y,
    );
    write_file(folder.join(format!("{stem}.yaml")), yaml.as_bytes(), Replace::Any)?;
    let count = |grey| greys.iter().filter(|g| **g == grey).count();
    Ok(MapCounts { free: count(FREE), occupied: count(OCCUPIED), unknown: count(UNKNOWN) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MapCell, load_map_server};
    use covmap::Grid;
    use nalgebra::Point2;
    use proptest::prelude::*;

    const THRESHOLDS: MapThresholds =
        MapThresholds { entropy: 0.6, occupied_entropy: 0.6, free: 0.2, occupied: 0.5 };

    /// Returns a row of cells of 11 bins, each with this share of its probability in one bin and
    /// the rest spread over all others; `None` is a cell that nothing touched.
    fn row_of(cells: &[Option<(usize, f64)>]) -> CoverageMap {
        let grid = Grid::new(Point2::new(-3.25, 1.0 / 3.0), 0.1, cells.len(), 1).unwrap();
        let mut map = CoverageMap::new(grid, 11).unwrap();
        for (cell, content) in grid.cells().zip(cells) {
            let Some((bin, share)) = content else { continue };
            let mut evidence = [(1.0 - share) / 10.0; 11];
            evidence[*bin] = *share;
            map.multiply(cell, &evidence);
        }
        map
    }

    /// Returns the greys of the image, and the counts.
    fn save(map: &CoverageMap, thresholds: &MapThresholds) -> (Vec<u8>, MapCounts) {
        let folder = tempfile::tempdir().unwrap();
        let counts = save_map_server(folder.path(), "map", map, thresholds, |_| true).unwrap();
        let image = std::fs::read(folder.path().join("map.pgm")).unwrap();
        (image[image.len() - map.grid().len()..].to_vec(), counts)
    }

    #[test]
    fn only_what_is_known_well_is_free_or_occupied() {
        // With p in one bin and (1 − p)/10 in each other, H = −p ln p − (1 − p) ln((1 − p)/10):
        // .5553 for p = .9, .6432 for p = .88.
        let cells = [
            None,
            Some((0, 0.9)),
            Some((0, 0.88)),
            Some((2, 0.95)),
            Some((3, 0.95)),
            Some((4, 0.95)),
            Some((5, 0.95)),
            Some((10, 0.9)),
            Some((10, 0.88)),
        ];
        let map = row_of(&cells);
        let entropies = [1, 2].map(|x| map.entropy(Cell::new(x, 0)));
        assert!((entropies[0] - 0.5553).abs() < 1e-3 && (entropies[1] - 0.6432).abs() < 1e-3);
        let (greys, counts) = save(&map, &THRESHOLDS);
        assert_eq!(greys, [205, 254, 205, 254, 205, 205, 0, 0, 205]);
        assert_eq!(counts, MapCounts { free: 2, occupied: 2, unknown: 5 });
        let loose = MapThresholds { entropy: 0.7, occupied_entropy: 0.7, free: 0.3, occupied: 1.0 };
        assert_eq!(save(&map, &loose).0, [205, 254, 254, 254, 254, 205, 205, 0, 0]);
    }

    #[test]
    fn a_cell_that_rests_on_next_to_nothing_is_unknown_whatever_the_threshold() {
        // ½ ln 11 = 1.199; H is 1.172 for p = .74 and 1.270 for p = .71.
        let map = row_of(&[None, Some((0, 0.1)), Some((0, 0.71)), Some((0, 0.74))]);
        let all = MapThresholds { entropy: 5.0, ..THRESHOLDS };
        assert!((all.largest_entropy(11) - 1.19895).abs() < 1e-5);
        assert!(map.is_known(Cell::new(1, 0)));
        assert_eq!(save(&map, &all).0, [205, 205, 205, 254]);
    }

    #[test]
    fn what_is_both_is_occupied() {
        let map = row_of(&[Some((6, 0.99)), Some((4, 0.99))]);
        let both = MapThresholds { free: 0.9, ..THRESHOLDS };
        assert_eq!(save(&map, &both).0, [0, 254]);
    }

    #[test]
    fn both_files_say_which_thresholds_were_used() {
        let folder = tempfile::tempdir().unwrap();
        let thresholds =
            MapThresholds { entropy: 0.45, occupied_entropy: 0.45, free: 0.1, occupied: 0.75 };
        save_map_server(folder.path(), "map", &row_of(&[None]), &thresholds, |_| true).unwrap();
        for name in ["map.pgm", "map.yaml"] {
            let file = std::fs::read(folder.path().join(name)).unwrap();
            let text = String::from_utf8_lossy(&file);
            for line in [
                "# free (254): known, entropy <= 0.45 nats, most likely coverage <= 0.1\n",
                "# occupied (0): known, entropy <= 0.45 nats, most likely coverage >= 0.75\n",
                "# unknown (205): all else\n",
            ] {
                assert!(text.contains(line), "{text}");
            }
        }
    }

    #[test]
    fn a_name_that_leaves_the_folder_is_refused() {
        for stem in ["", "../map", "a: b", ".hidden", "-"] {
            let saved = save_map_server("nowhere", stem, &row_of(&[None]), &THRESHOLDS, |_| true);
            assert!(matches!(saved, Err(FileError::Unwritable { .. })));
        }
    }

    proptest! {
        #[test]
        fn what_is_saved_is_read_back_cell_by_cell(
            values in prop::collection::vec(prop::option::of((0..11usize, 0.5..1.0f64)), 12),
            x in -1e6..1e6f64, r in 1e-3..10.0f64,
        ) {
            let grid = Grid::new(Point2::new(x, -x / 3.0), r, 4, 3).unwrap();
            let row = row_of(&values);
            let mut map = CoverageMap::new(grid, 11).unwrap();
            for (cell, from) in grid.cells().zip(row.grid().cells()) {
                if row.is_known(from) {
                    map.multiply(cell, row.histogram(from).probabilities());
                }
            }
            let folder = tempfile::tempdir().unwrap();
            let counts = save_map_server(folder.path(), "map", &map, &THRESHOLDS, |_| true).unwrap();
            let read = load_map_server(folder.path().join("map.yaml"));
            if counts.unknown == 12 {
                prop_assert!(read.unwrap_err().to_string().contains("are unknown"));
                return Ok(());
            }
            let read = read.unwrap();
            let found = |wanted| read.cells.values().iter().filter(|c| **c == wanted).count();
            prop_assert_eq!(found(MapCell::Occupancy(0.0)), counts.free);
            prop_assert_eq!(found(MapCell::Occupancy(1.0)), counts.occupied);
            for (cell, said) in read.cells.iter() {
                let here = grid.cell_at(read.grid.center(cell)).unwrap();
                let (mode, entropy) = (map.mode(here), map.entropy(here));
                match said {
                    MapCell::Unknown => {
                        prop_assert!(!map.is_known(here) || entropy > 0.6 || (mode > 0.2 && mode < 0.5));
                    }
                    MapCell::Occupancy(p) => {
                        prop_assert!(entropy <= 0.6 && map.is_known(here));
                        let agrees = if *p > 0.5 { mode >= 0.5 } else { mode <= 0.2 };
                        prop_assert!(agrees);
                    }
                }
            }
        }
    }
}
