//! The column of Fig. 3: the answer of the sensor model to an echo from 1 m.

use covmap_model::{Outcome, SensorModel};

/// The measured range of the figure \[m\].
pub(crate) const RANGE: f64 = 1.0;

/// Returns p(c = x | d) of a cell at a distance.
pub(crate) fn column(model: &SensorModel, cell_distance: f64) -> Vec<f64> {
    let mut column = vec![0.0; model.parameters().bins];
    if cell_distance <= model.reach(Outcome::Echo(RANGE)) {
        model.evidence(cell_distance, Outcome::Echo(RANGE), &mut column);
    } else {
        // Beyond its reach, a reading says nothing.
        column.fill(f64::NAN);
    }
    column
}
