//! The evidence of one echo by a sensor model, Fig. 3.

use covmap_model::{Outcome, SensorModel};
use std::fmt::Write;

/// Returns a table of the model's evidence of an echo, and its number of distances.
pub fn echo_table(model: &SensorModel, range: f64) -> (String, usize) {
    let distances = echo_distances(model, range);
    let bins = model.parameters().bins;
    let mut table = "cell_distance,coverage,probability\n".to_owned();
    let mut column = vec![0.0; bins];
    for distance in &distances {
        model.evidence(*distance, Outcome::Echo(range), &mut column);
        for (bin, probability) in column.iter().enumerate() {
            let coverage = covmap::bin_coverage(bin, bins);
            let _ = writeln!(table, "{distance:?},{coverage:?},{probability:?}");
        }
    }
    (table, distances.len())
}

/// Returns the distances from r/2 to .20 m behind the end cell, as in Fig. 3, in steps of r/10 \[m\];
/// farther if the echo updates cells farther behind.
pub fn echo_distances(model: &SensorModel, range: f64) -> Vec<f64> {
    let resolution = model.resolution();
    let behind = model.parameters().update.behind().max(0.20);
    let last = range + 0.5 * resolution + behind + 1e-9 * resolution;
    (5u32..).map(|i| f64::from(i) * resolution / 10.0).take_while(|d| *d <= last).collect()
}
