//! Maps and decisions as messages that a viewer draws.

use covmap::{Cell, CoverageMap, Grid, Raster};
use covmap_bag::messages::{
    ColorRgba, Header, MapMetaData, Marker, MarkerAction, MarkerArray, MarkerShape, OccupancyGrid,
    Transform,
};
use covmap_plan::{CellStatus, Decision};

/// The largest number of a cell.
const MOST: f64 = 100.0;
/// The value of a cell that is not known.
const UNKNOWN: i8 = -1;
/// The height at which things are drawn above the map \[m\].
const ABOVE: f64 = 0.1;

const BLUE: [f32; 4] = [0.13, 0.35, 0.72, 0.8];
const ORANGE: [f32; 4] = [0.9, 0.45, 0.05, 1.0];
const BLACK: [f32; 4] = [0.05, 0.05, 0.05, 1.0];

/// Returns the map and its entropy, each with its topic.
pub(super) fn maps(header: &Header, map: &CoverageMap) -> [(&'static str, OccupancyGrid); 2] {
    let largest = libm::log(map.bins() as f64);
    let of = |value: &dyn Fn(Cell) -> f64| {
        let cell = |cell| if map.is_known(cell) { percent(value(cell)) } else { UNKNOWN };
        grid(header, &Raster::from_fn(*map.grid(), cell))
    };
    [("/map", of(&|cell| map.mean(cell))), ("/entropy", of(&|cell| map.entropy(cell) / largest))]
}

#[allow(clippy::cast_possible_truncation, reason = "from 0 to 100")]
fn percent(share: f64) -> i8 {
    (MOST * share).round().clamp(0.0, MOST) as i8
}

/// Returns the certificate as a grid.
pub(super) fn certificate(header: &Header, certificate: &Raster<CellStatus>) -> OccupancyGrid {
    let value = |cell| match certificate.get(cell) {
        None | Some(CellStatus::Outside) => UNKNOWN,
        Some(CellStatus::Resolved) => 0,
        Some(CellStatus::Exhausted) => 25,
        Some(CellStatus::Unreachable) => 50,
        Some(CellStatus::NotSeen) => 75,
        Some(CellStatus::Open) => 100,
    };
    grid(header, &Raster::from_fn(*certificate.grid(), value))
}

#[allow(clippy::cast_possible_truncation, reason = "messages have single precision")]
fn grid(header: &Header, cells: &Raster<i8>) -> OccupancyGrid {
    let grid = cells.grid();
    let corner = grid.lower_left();
    let origin = Transform { translation: [corner.x, corner.y, 0.0], ..Transform::default() };
    let info = MapMetaData {
        map_load_time: header.stamp,
        resolution: grid.resolution() as f32,
        width: u32::try_from(grid.width()).unwrap_or(u32::MAX),
        height: u32::try_from(grid.height()).unwrap_or(u32::MAX),
        origin,
    };
    OccupancyGrid { header: header.clone(), info, data: cells.values().to_vec() }
}

/// Returns the best candidates of a decision, the chosen one, the way there, and the reason.
pub(super) fn decision(header: Header, grid: &Grid, decision: &Decision) -> MarkerArray {
    let at = |cell: Cell| {
        let place = grid.center(cell);
        [place.x, place.y, ABOVE]
    };
    let mut markers = vec![Marker {
        header: header.clone(),
        action: MarkerAction::RemoveAll,
        ..Marker::default()
    }];
    let mut add = |ns: &str, shape, cell: Cell, size: f64, color, text: String| {
        markers.push(Marker {
            header: header.clone(),
            ns: ns.to_owned(),
            id: i32::try_from(markers.len()).unwrap_or(i32::MAX),
            shape,
            pose: Transform { translation: at(cell), ..Transform::default() },
            scale: [size; 3],
            color: ColorRgba(color),
            text,
            ..Marker::default()
        });
    };
    for (rank, candidate) in decision.best.iter().enumerate() {
        let size = 0.3 - 0.04 * rank as f64;
        add("candidates", MarkerShape::Sphere, candidate.cell, size, BLUE, String::new());
    }
    add("target", MarkerShape::Sphere, decision.target, 0.35, ORANGE, String::new());
    add("reason", MarkerShape::Text, decision.target, 0.25, BLACK, reason(decision));
    let points = decision.path.iter().map(|cell| at(*cell)).collect();
    markers.push(Marker {
        header: header.clone(),
        ns: "way".to_owned(),
        shape: MarkerShape::LineStrip,
        scale: [0.04; 3],
        color: ColorRgba(ORANGE),
        points,
        ..Marker::default()
    });
    MarkerArray { markers }
}

/// Returns the reason of a decision as a sentence.
fn reason(decision: &Decision) -> String {
    let of = decision.candidates;
    let why = match decision.best.first() {
        Some(best) => format!(
            "E[I] {:.3} nats, {:.1} m away, score {:.3}: the best of {of}",
            best.gain, best.cost, best.score
        ),
        None => format!("chosen among {of}"),
    };
    match (decision.passage.is_empty(), decision.towards_ground) {
        (false, _) => format!("{why}; tries a passage that looks blocked"),
        (_, true) => format!("{why}; for the ground that may be behind"),
        _ => why,
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are exact")]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn a_cell_is_its_expected_coverage_in_percent() {
        let grid = Grid::new(Point2::new(-1.0, 2.0), 0.5, 2, 1).unwrap();
        let mut map = CoverageMap::new(grid, 3).unwrap();
        map.multiply(Cell::new(1, 0), &[0.5, 0.25, 0.25]).unwrap();
        let header = Header::default();
        let [(_, coverage), (_, entropy)] = maps(&header, &map);
        // .25 · .5 + .25 · 1 = .375; H = 1.0397 of ln 3 = 1.0986: 94.6 %.
        assert_eq!((coverage.data, entropy.data), (vec![-1, 38], vec![-1, 95]));
        assert_eq!(coverage.info.origin.translation, [-1.0, 2.0, 0.0]);
        assert_eq!((coverage.info.width, coverage.info.height), (2, 1));
    }
}
