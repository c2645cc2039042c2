//! The data of a fit: scans, and the truth of a fixed set of cells.

use covmap::{Cell, Change, CoverageMap, Grid, Histogram};
use covmap_model::{Body, BodyEvent, Looks, ModelError, ModelParameters, SensorModel};
use covmap_sonar::{Scan, SonarRing};

/// The scans of one trajectory, and the true coverage of some cells.
///
/// The cells are fixed before any of the maps that are compared is built: a model cannot make
/// itself look better by leaving cells unknown. A cell that a map does not know counts with
/// a uniform posterior.
#[derive(Debug, Clone)]
pub struct Example {
    /// Its name in reports.
    pub name: String,
    /// The sensors that made the scans.
    pub ring: SonarRing,
    /// The scans, in order.
    pub scans: Vec<Scan>,
    /// Events of the robot's body between the scans.
    pub body: BodyRecord,
    /// The grid of the map.
    pub grid: Grid,
    /// The cells that count, with their true coverage.
    pub truth: Vec<(Cell, f64)>,
}

/// Events of a robot's body between its scans; none by default.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BodyRecord {
    /// Radius of its disc \[m\].
    pub radius: f64,
    /// The events in order, each with the number of scans before it.
    pub events: Vec<(usize, BodyEvent)>,
}

impl BodyRecord {
    /// Creates the record of a body that stood without contact where each scan was made.
    pub fn standing(radius: f64, scans: &[Scan]) -> Self {
        let at = |scan: &Scan| scan.pose.translation.vector.into();
        let stood = |scan| BodyEvent::Moved { from: at(scan), to: at(scan) };
        Self { radius, events: scans.iter().map(stood).enumerate().collect() }
    }
}

impl Example {
    /// Builds the map of a model from the scans and the body, as the loop does.
    ///
    /// # Errors
    /// If the parameters make no model for the ring and the grid.
    pub fn map(&self, parameters: &ModelParameters) -> Result<CoverageMap, ModelError> {
        self.map_of(&SensorModel::new(parameters, &self.ring, self.grid.resolution())?)
    }

    pub(crate) fn map_of(&self, model: &SensorModel) -> Result<CoverageMap, ModelError> {
        let mut looks = Looks::new(model);
        self.map_by(model.parameters().bins, |map, scan| looks.integrate(model, map, scan))
    }

    /// Returns the posterior of a map for each cell of the truth, with the truth. The posterior is
    /// uniform for an unknown cell and outside of the map.
    pub fn cells_of(&self, map: &CoverageMap) -> Vec<(Vec<f64>, f64)> {
        let posterior = |cell: Cell| match map.grid().index(cell) {
            Some(_) => map.histogram(cell),
            None => Histogram::uniform(map.bins()),
        };
        let cell =
            |(cell, truth): &(Cell, f64)| (posterior(*cell).probabilities().to_vec(), *truth);
        self.truth.iter().map(cell).collect()
    }

    /// Builds the map after all scans and events of the body, in their order. `take_in` integrates
    /// a scan and returns its changes.
    pub(crate) fn map_by(
        &self,
        bins: usize,
        mut take_in: impl FnMut(&mut CoverageMap, &Scan) -> Vec<Change>,
    ) -> Result<CoverageMap, ModelError> {
        let mut map = CoverageMap::new(self.grid, bins).map_err(|_| ModelError::Bins(bins))?;
        let mut body = Body::new(self.grid, self.body.radius);
        let mut events = self.body.events.iter().peekable();
        for number in 0..=self.scans.len() {
            while let Some((_, event)) = events.next_if(|(before, _)| *before <= number) {
                body.happened(&mut map, event);
            }
            if let Some(scan) = self.scans.get(number) {
                let changes = take_in(&mut map, scan);
                body.hold(&mut map, changes);
            }
        }
        Ok(map)
    }
}

/// Returns the true coverages of the cells of some examples, in their order.
pub(crate) fn truths(examples: &[Example]) -> impl Iterator<Item = f64> {
    examples.iter().flat_map(|e| &e.truth).map(|(_, coverage)| *coverage)
}
