//! The cells around a view-point, beam by beam: view-points are cell centres and the
//! heading is fixed, so they are the same everywhere.

use covmap::{Cell, Grid};
use covmap_model::{Met, Outcome, SensorModel};
use nalgebra::{Isometry2, Point2, Vector2};
use std::ops::Range;

/// A cell as a beam sees it from a view-point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StencilCell {
    /// Columns from the view-point.
    pub dx: i32,
    /// Rows from the view-point.
    pub dy: i32,
    /// d^l, distance from the sensor \[m\].
    pub cell_distance: f64,
    /// Position across the beam: 0 at the right border, 1 at the left.
    pub across: f64,
}

impl StencilCell {
    /// Returns the cell as its beam meets it.
    pub fn met(&self) -> Met {
        Met { cell_distance: self.cell_distance, across: self.across }
    }
}

/// One beam's cells in order of their distance from the sensor, so that the cells C(l, d)
/// of every outcome are a prefix of them.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamStencil {
    /// The cells.
    pub cells: Vec<StencilCell>,
    /// w_i, each cell's share of the angular width of its ring; those of a ring sum to 1.
    pub weights: Vec<f64>,
    /// S_k: the cells at the range d_k = k·r, |d^l − d_k| ≤ r/2.
    pub rings: Vec<Range<usize>>,
    /// Number of cells that an echo from d_k covers.
    pub echo_reach: Vec<usize>,
    /// Number of cells that no echo covers.
    pub no_echo_reach: usize,
}

/// All beams' cells around a view-point.
#[derive(Debug, Clone, PartialEq)]
pub struct Stencil {
    /// One for each beam.
    pub beams: Vec<BeamStencil>,
    /// The ranges d_k = k·r that a beam may measure \[m\].
    pub ranges: Vec<f64>,
    /// Largest distance of a cell from the view-point, in columns or rows.
    pub radius: i32,
}

/// Largest length of a beam in cells: two hundred metres in cells of 0.1 m.
pub(crate) const FARTHEST: f64 = 2000.0;

/// Error of beams whose gains cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BeamError {
    /// A beam covers more cells than can be numbered.
    #[error(
        "a beam covers {0} cells, 65535 are too many: use a coarser resolution, a shorter usable range or a narrower footprint"
    )]
    TooFine(usize),
    /// The update does not predict ranges.
    #[error(
        "planner.gain: MutualInformation needs the update by cause, which predicts the ranges that it explains; with Eq. (9) take Eq14"
    )]
    NoPrediction,
    /// A beam reaches too far, in cells.
    #[error(
        "a beam reaches {0:.0} cells far, {FARTHEST} are too many: use a coarser resolution or a shorter usable range"
    )]
    TooLong(f64),
}

/// Distances are rounded to multiples of this, 2⁻³⁶ m, so that beams that are rotations of
/// each other by a quarter turn see the same distances, to the last bit.
const DISTANCE_STEP: f64 = 1.0 / (1u64 << 36) as f64;

impl Stencil {
    /// Creates the stencil of a model's ring at a heading \[rad\], with the cells up to 2200 from
    /// the view-point.
    pub fn new(model: &SensorModel, heading: f64) -> Self {
        let r = model.resolution();
        let usable = model.parameters().usable_range;
        #[allow(clippy::cast_possible_truncation, reason = "some hundred")]
        let count = (usable / r + 1e-9).floor() as u32;
        let ranges: Vec<f64> = (0..=count).map(|k| f64::from(k) * r).collect();
        let beams = beams_around(model, heading, &ranges);
        let distance = |c: &StencilCell| c.dx.abs().max(c.dy.abs());
        let radius = beams.iter().flat_map(|b| &b.cells).map(distance).max().unwrap_or(0);
        Self { beams, ranges, radius }
    }

    /// Returns the outcome of index `k`: an echo from d_k, or, one past them all, no echo.
    pub fn outcome(&self, k: usize) -> Outcome {
        self.ranges.get(k).map_or(Outcome::NoEcho, |d| Outcome::Echo(*d))
    }

    /// Returns the number of outcomes: K + 1 ranges and no echo.
    pub fn outcomes(&self) -> usize {
        self.ranges.len() + 1
    }
}

impl BeamStencil {
    /// Returns the number of cells that an outcome covers, by [`Stencil::outcome`]'s index.
    pub fn reach(&self, k: usize) -> usize {
        self.echo_reach.get(k).copied().unwrap_or(self.no_echo_reach)
    }
}

fn beams_around(model: &SensorModel, heading: f64, ranges: &[f64]) -> Vec<BeamStencil> {
    let r = model.resolution();
    // A grid with the view-point in the centre of its middle cell.
    #[allow(clippy::cast_possible_truncation, reason = "a sensor's reach is some hundred cells")]
    let half = ((model.max_reach() + 10.0) / r).ceil().min(1.1 * FARTHEST) as i32;
    let side = usize::try_from(2 * half + 1).unwrap_or(1);
    let corner = Point2::from(Vector2::repeat(-(f64::from(half) + 0.5) * r));
    let Ok(grid) = Grid::new(corner, r, side, side) else { return Vec::new() };
    let pose = Isometry2::new(Vector2::zeros(), heading);
    let beam = |beam| {
        let mut cells = Vec::new();
        model.footprint().for_each_cell(&grid, &pose, beam, model.max_reach(), |c| {
            let Cell { x, y } = c.cell;
            let cell_distance = (c.cell_distance / DISTANCE_STEP).round() * DISTANCE_STEP;
            cells.push(StencilCell { dx: x - half, dy: y - half, cell_distance, across: c.across });
        });
        beam_stencil(model, cells, ranges)
    };
    (0..model.footprint().beams()).map(beam).collect()
}

fn beam_stencil(model: &SensorModel, mut cells: Vec<StencilCell>, ranges: &[f64]) -> BeamStencil {
    let r = model.resolution();
    cells.sort_by(|a, b| {
        a.cell_distance.total_cmp(&b.cell_distance).then((a.dy, a.dx).cmp(&(b.dy, b.dx)))
    });
    let nearer_than = |d: f64| cells.partition_point(|c| c.cell_distance < d);
    let within = |d: f64| cells.partition_point(|c| c.cell_distance <= d + 1e-9);
    let rings: Vec<Range<usize>> =
        ranges.iter().map(|d| nearer_than(d - 0.5 * r)..nearer_than(d + 0.5 * r)).collect();
    let echo_reach = ranges.iter().map(|d| within(model.reach(Outcome::Echo(*d)))).collect();
    let no_echo_reach = within(model.reach(Outcome::NoEcho));
    // A cell's angular width is its side over its distance.
    let mut weights: Vec<f64> = cells.iter().map(|c| 1.0 / c.cell_distance.max(r)).collect();
    for ring in &rings {
        let sum: f64 = weights[ring.clone()].iter().sum();
        weights[ring.clone()].iter_mut().for_each(|w| *w /= sum);
    }
    BeamStencil { cells, weights, rings, echo_reach, no_echo_reach }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_model::ModelParameters;
    use covmap_sonar::SonarRing;

    #[test]
    fn a_quarter_turn_of_the_ring_sees_the_same_distances() {
        let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
        let stencil = Stencil::new(&model, 0.3);
        let distances =
            |b: &BeamStencil| b.cells.iter().map(|c| c.cell_distance.to_bits()).collect::<Vec<_>>();
        assert_eq!(stencil.ranges.len(), 31);
        for beam in 0..6 {
            for turn in 1..4 {
                assert_eq!(
                    distances(&stencil.beams[beam]),
                    distances(&stencil.beams[beam + 6 * turn])
                );
            }
        }
    }

    #[test]
    fn the_weights_of_a_ring_sum_to_one() {
        let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.2).unwrap();
        for beam in Stencil::new(&model, 0.0).beams {
            for ring in beam.rings.iter().filter(|ring| !ring.is_empty()) {
                let sum: f64 = beam.weights[ring.clone()].iter().sum();
                assert!((sum - 1.0).abs() < 1e-12);
            }
            assert!(
                beam.echo_reach.is_sorted() && *beam.echo_reach.last().unwrap() == beam.cells.len()
            );
        }
    }
}
