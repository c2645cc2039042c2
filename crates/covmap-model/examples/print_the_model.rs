//! Prints the evidence of an echo from 1 m, as in Fig. 3 of the paper: for each distance of a cell
//! the probability of each coverage, in percent.
//!
//! ```text
//! cargo run -p covmap-model --example print_the_model
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap::bin_coverage;
use covmap_model::{ModelParameters, Outcome, SensorModel};
use covmap_sonar::SonarRing;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let resolution = 0.1;
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), resolution)?;
    let bins = model.parameters().bins;
    let echo = Outcome::Echo(1.0);

    let heads: String = (0..bins).map(|bin| format!("{:>6.1}", bin_coverage(bin, bins))).collect();
    println!("d^l [m]  c ={heads}   H [nats]");
    for tenths in 5..=13 {
        let cell_distance = f64::from(tenths) * resolution;
        if cell_distance > model.reach(echo) {
            println!("{cell_distance:>7.2}    not touched: the evidence ends behind the echo");
            continue;
        }
        let column = model.evidence_histogram(cell_distance, echo);
        let row: String =
            column.probabilities().iter().map(|p| format!("{:>6.1}", 100.0 * p)).collect();
        println!("{cell_distance:>7.2}     {row} {:>10.3}", column.entropy());
    }
    Ok(())
}
