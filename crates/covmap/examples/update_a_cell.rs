//! Makes a map, multiplies evidence into one of its cells, and stores the whole belief.
//!
//! ```text
//! cargo run -p covmap --example update_a_cell
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap::{CoverageMap, Grid, bin_coverage};
use nalgebra::Point2;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // 4 m × 3 m in cells of 0.1 m, and 11 bins: coverage 0, 0.1, … 1.
    let grid = Grid::new(Point2::origin(), 0.1, 40, 30)?;
    let mut map = CoverageMap::new(grid, 11)?;
    let cell = grid.cell_at(Point2::new(1.23, 0.45)).ok_or("outside the grid")?;

    // The same weak evidence for a coverage of 0.2, again and again.
    let evidence: Vec<f64> = (0..11)
        .map(|bin| {
            let off = (bin_coverage(bin, 11) - 0.2) / 0.3;
            0.2 + libm::exp(-0.5 * off * off)
        })
        .collect();
    println!("{:>8} {:>8} {:>8} {:>14}", "updates", "mode", "H [nats]", "90 % interval");
    for updates in 0..=30 {
        if updates % 5 == 0 {
            let (low, high) = map.credible_interval(cell, 0.9);
            let (mode, entropy) = (map.mode(cell), map.entropy(cell));
            println!("{updates:>8} {mode:>8.1} {entropy:>8.3} {low:>8.1} – {high:.1}");
        }
        map.multiply(cell, &evidence);
    }

    // A cell that the robot's body filled is free, and stays so.
    let under_the_robot = grid.cell_at(Point2::new(2.0, 2.0)).ok_or("outside the grid")?;
    map.pin_free(under_the_robot);
    println!(
        "pinned: {}, {:?}",
        map.is_pinned(under_the_robot),
        map.multiply(under_the_robot, &evidence)
    );

    // The belief as bytes, and back, to the last bit.
    let file = std::env::temp_dir().join(format!("belief-{}.bin", std::process::id()));
    std::fs::write(&file, map.to_bytes())?;
    let again = CoverageMap::from_bytes(&std::fs::read(&file)?)?;
    std::fs::remove_file(&file)?;
    println!("{} cells came back unchanged: {}", again.grid().len(), again == map);
    Ok(())
}
