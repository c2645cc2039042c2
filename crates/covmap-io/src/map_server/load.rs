//! Reading a map of ROS.

use super::description::{Description, Mode};
use super::image::Image;
use super::map::{MapAreas, MapCell, MapServerMap};
use super::{ImageError, MapServerError};
use crate::FileError;
use crate::read::{MAX_FILE, read_bytes};
use covmap::{Grid, Raster};
use nalgebra::{Isometry2, Vector2};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Reads a map as map_server of Nav2 does: the YAML file, and the PNG or PGM image that it names,
/// relative to its folder. An image that is not there is read from beside the YAML file, if it is
/// there: absolute paths come from other machines.
///
/// With x the mean of a pixel's colours over that of white, `negate` taking x to 1 − x, and
/// p = 1 − x:
///
/// ```text
/// trinary   p ≥ occupied_thresh: 1;   p ≤ free_thresh: 0;   else unknown
/// scale     the same, but else .01 + .98 · (p − free_thresh)/(occupied_thresh − free_thresh)
/// raw       255 · x, rounded, is the occupancy in percent; unknown above 100
/// ```
///
/// A pixel that is not fully opaque is unknown. Keys that map_server does not know are ignored.
///
/// The unknown border around all known pixels is cut away, since a map of ROS is unknown beyond its
/// image as well. The origin's yaw turns the map.
///
/// # Errors
/// If the description or the image is missing, cut short, too large, or says something impossible;
/// or if all pixels are unknown. Every error names the YAML file.
pub fn load_map_server(yaml: impl AsRef<Path>) -> Result<MapServerMap, FileError> {
    let path = yaml.as_ref();
    let description = Description::load(path)?;
    let (image, found) = find_image(path, &description.image);
    let of_image = |reason| FileError::MapImage {
        path: path.to_path_buf(),
        reason: Box::new(reason),
        missing: found == Found::Nowhere,
    };
    let file = read_bytes(&image, MAX_FILE).map_err(of_image)?;
    let source = Source { description: &description, file: &file };
    let damaged = |reason| of_image(FileError::Image { path: image.clone(), reason });
    let known = source.known().map_err(damaged)?;
    let wrong = |reason| FileError::MapServer { path: path.to_path_buf(), reason };
    let grid = known.grid(&description).map_err(wrong)?;
    let mut map = MapServerMap {
        grid,
        cells: source.cells(&known, grid).map_err(damaged)?,
        world_from_map: Isometry2::identity(),
        areas: known.areas,
        image_size: known.image_size,
        image_beside: (found == Found::Beside).then(|| image.clone()),
    };
    map.turn(description.lower_left, description.yaw);
    Ok(map)
}

/// Place of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    /// Where the description says; a name without a folder always counts as this.
    There,
    /// Beside the YAML file.
    Beside,
    /// Neither in the folder that the description names nor beside the YAML file.
    Nowhere,
}

/// Returns the place of the image that a YAML file names, with path separators of any system.
fn find_image(yaml: &Path, named: &str) -> (PathBuf, Found) {
    let folder = yaml.parent().unwrap_or(Path::new(""));
    let there = folder.join(named);
    let name = named.rsplit(['/', '\\']).next().unwrap_or_default();
    if there.exists() || name == named || name.is_empty() {
        return (there, Found::There);
    }
    let beside = folder.join(name);
    if beside.exists() { (beside, Found::Beside) } else { (there, Found::Nowhere) }
}

/// A description and its image.
struct Source<'a> {
    description: &'a Description,
    file: &'a [u8],
}

/// The results of a pass over all pixels.
#[derive(Default)]
struct Known {
    image_size: (usize, usize),
    /// The columns and the rows of the known pixels, from the lower left; empty at first.
    columns: Range<usize>,
    rows: Range<usize>,
    areas: MapAreas,
}

impl Known {
    /// Returns the grid of the known pixels.
    fn grid(&self, description: &Description) -> Result<Grid, MapServerError> {
        let Self { columns, rows, image_size, .. } = self;
        if rows.is_empty() {
            return Err(MapServerError::Unknown(image_size.0, image_size.1));
        }
        let cut = Vector2::new(columns.start as f64, rows.start as f64);
        let corner = description.lower_left + cut * description.resolution;
        Ok(Grid::new(corner, description.resolution, columns.len(), rows.len())?)
    }
}

impl Source<'_> {
    /// Calls `each` with the number of every row, counted from the lowest, and its pixels. The rows
    /// come from the top. Returns the numbers of columns and rows.
    fn each_row(
        &self,
        each: &mut dyn FnMut(usize, &[Pixel]),
    ) -> Result<(usize, usize), ImageError> {
        let mut image = Image::new(self.file)?;
        let (mut whites, mut pixels) = (Vec::new(), Vec::new());
        for row in (0..image.height).rev() {
            image.next_row(&mut whites)?;
            pixels.clear();
            let pixel = |white: &Option<u32>| Pixel::new(self.description, *white, image.white);
            pixels.extend(whites.iter().map(pixel));
            each(row, &pixels);
        }
        let size = (image.width, image.height);
        image.finish()?;
        Ok(size)
    }

    fn known(&self) -> Result<Known, ImageError> {
        let mut known = Known::default();
        let area = self.description.resolution * self.description.resolution;
        let (mut free, mut occupied, mut unknown, mut grey) = (0usize, 0usize, 0usize, 0usize);
        let image_size = self.each_row(&mut |row, pixels| {
            for (column, Pixel { cell, is_unknown_grey }) in pixels.iter().enumerate() {
                if *cell == MapCell::Unknown {
                    unknown += 1;
                    continue;
                }
                include(&mut known.columns, column);
                include(&mut known.rows, row);
                occupied += usize::from(cell.is_solid());
                free += usize::from(!cell.is_solid());
                grey += usize::from(!cell.is_solid() && *is_unknown_grey);
            }
        })?;
        let of = |count: usize| count as f64 * area;
        let areas = MapAreas {
            free: of(free),
            occupied: of(occupied),
            unknown: of(unknown),
            unknown_grey_is_free: of(grey),
        };
        Ok(Known { image_size, areas, ..known })
    }

    fn cells(&self, known: &Known, grid: Grid) -> Result<Raster<MapCell>, ImageError> {
        let mut raster = Raster::filled(grid, MapCell::Unknown);
        self.each_row(&mut |row, pixels| {
            if known.rows.contains(&row) {
                let begin = (row - known.rows.start) * grid.width();
                let out = &mut raster.values_mut()[begin..begin + grid.width()];
                let pixels = &pixels[known.columns.clone()];
                out.iter_mut().zip(pixels).for_each(|(out, pixel)| *out = pixel.cell);
            }
        })?;
        Ok(raster)
    }
}

/// Widens a range, empty at first, to hold a number.
fn include(range: &mut Range<usize>, number: usize) {
    *range = if range.start >= range.end {
        number..number + 1
    } else {
        range.start.min(number)..range.end.max(number + 1)
    };
}

/// The p of the grey that programs give to unknown cells, 205 of 255 \[1/255\].
const UNKNOWN_GREY: u32 = 50;

/// The content of a pixel.
struct Pixel {
    cell: MapCell,
    /// Whether the pixel is as grey as unknown cells are.
    is_unknown_grey: bool,
}

impl Pixel {
    /// Returns the pixel with `white` of `full` white; `None` is a pixel that is not opaque.
    fn new(description: &Description, white: Option<u32>, full: u32) -> Self {
        let Some(white) = white else {
            return Self { cell: MapCell::Unknown, is_unknown_grey: false };
        };
        let Description { occupied, free, .. } = *description;
        // Integers first, so that p is exact where the thresholds are met exactly.
        let white = if description.negate { full - white } else { white };
        let dark = full - white;
        let p = f64::from(dark) / f64::from(full);
        let cell = match description.mode {
            Mode::Raw => {
                let percent = (255.0 * f64::from(white) / f64::from(full)).round();
                if percent > 100.0 { MapCell::Unknown } else { MapCell::Occupancy(percent / 100.0) }
            }
            _ if p >= occupied => MapCell::Occupancy(1.0),
            _ if p <= free => MapCell::Occupancy(0.0),
            Mode::Trinary => MapCell::Unknown,
            Mode::Scale => MapCell::Occupancy(0.01 + 0.98 * (p - free) / (occupied - free)),
        };
        let is_unknown_grey = description.mode != Mode::Raw && dark * 255 == full * UNKNOWN_GREY;
        Self { cell, is_unknown_grey }
    }
}

#[cfg(test)]
mod tests;
