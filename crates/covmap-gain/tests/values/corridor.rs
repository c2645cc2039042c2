//! A corridor that is one cell wide, and a cache that is told of it cell by cell.

use covmap::{Cell, CoverageMap, Grid};
use covmap_gain::{
    GainCache, InformationGain, RangePrediction, Upkeep, ViewPoints, expected_information_gain,
};
use covmap_model::{ModelParameters, SensorModel};
use covmap_sonar::{Beam, SonarRing};
use nalgebra::{Isometry2, Point2};

/// Unknown cells reflect nothing.
pub(crate) const PLAIN: RangePrediction = RangePrediction {
    gain: InformationGain::Eq14,
    unknown_reflection: 0.0,
    uniform_share: 0.0,
    novelty: 1.0,
};

/// Cells of 1 m. The sensors are rays from the centre of the robot.
pub(crate) struct Corridor {
    pub(crate) map: CoverageMap,
    model: SensorModel,
    prediction: RangePrediction,
    pub(crate) cache: GainCache,
}

impl Corridor {
    /// Creates a corridor of unknown `cells`. `directions` are those of the rays [degrees].
    pub(crate) fn new(
        cells: usize,
        directions: &[f64],
        model: &ModelParameters,
        prediction: RangePrediction,
        upkeep: Upkeep,
    ) -> Self {
        let beam = |degrees: &f64| Beam {
            pose: Isometry2::rotation(degrees.to_radians()),
            half_angle: 0.1,
            min_range: 0.0,
            max_range: 10.0,
        };
        let ring = SonarRing::new(directions.iter().map(beam).collect()).unwrap();
        let model = SensorModel::new(model, &ring, 1.0).unwrap();
        let grid = Grid::new(Point2::origin(), 1.0, cells, 1).unwrap();
        let map = CoverageMap::new(grid, model.parameters().bins).unwrap();
        let cache = GainCache::new(&model, 0.0, grid, prediction, upkeep).unwrap();
        Self { map, model, prediction, cache }
    }

    /// Gives a cell this posterior, and tells the cache.
    pub(crate) fn know(&mut self, x: i32, posterior: &[f64]) {
        let cell = Cell::new(x, 0);
        let mut before = vec![0.0; posterior.len()];
        self.map.read_posterior(cell, &mut before);
        let evidence: Vec<f64> = posterior.iter().zip(before).map(|(p, b)| p / b).collect();
        self.map.multiply(cell, &evidence);
        self.cache.update(&self.map, cell);
    }

    /// Frees a cell for good, and tells the cache.
    pub(crate) fn pin(&mut self, x: i32) {
        self.map.pin_free(Cell::new(x, 0));
        self.cache.update(&self.map, Cell::new(x, 0));
    }

    fn one(&self, x: i32) -> (usize, ViewPoints) {
        let index = self.map.grid().index(Cell::new(x, 0)).unwrap();
        (index, ViewPoints::one(self.map.grid(), index))
    }

    /// Returns E[I] of a cell by the literal equations.
    pub(crate) fn literal_gain(&self, x: i32) -> f64 {
        let (map, model, stencil) = (&self.map, &self.model, self.cache.stencil());
        expected_information_gain(map, model, stencil, self.prediction, Cell::new(x, 0))
    }

    /// Returns E[I] of a cell from the cache.
    pub(crate) fn gain(&mut self, x: i32) -> f64 {
        let (index, one) = self.one(x);
        self.cache.refresh_gains(&one);
        self.cache.gain(index)
    }

    /// Returns V(l): columns and distances.
    pub(crate) fn in_sight(&mut self, x: i32) -> Vec<(i32, f32)> {
        let (index, one) = self.one(x);
        self.cache.refresh_sight(&one);
        let cells = self.cache.cells_in_sight(index);
        cells.iter().map(|&(x, distance)| (i32::try_from(x).unwrap(), distance)).collect()
    }
}
