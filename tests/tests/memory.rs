//! The estimate of a planner's memory, compared with the memory taken.
//!
//! The test is a program of its own, because other tests take memory at the same time.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test")]

use covmap::{CoverageMap, Grid, Raster};
use covmap_lab::Config;
use covmap_plan::{Planner, Strategy, planner_bytes};
use covmap_sonar::RingSpecification;
use nalgebra::Point2;

/// Returns the largest memory of the program so far \[bytes\].
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

/// Makes a planner with `side` cells a side, and returns its memory, taken and estimated.
fn taken(side: usize, resolution: f64, sensors: usize, strategy: Strategy) -> [u64; 2] {
    let mut config = Config::b21r();
    (config.resolution, config.planner.strategy) = (resolution, strategy);
    config.robot.ring = RingSpecification::Circle {
        count: sensors,
        radius: 0.25,
        half_angle: 0.2,
        min_range: 0.1,
        max_range: 10.0,
    };
    let (_, model) = config.build().unwrap();
    let grid = Grid::new(Point2::origin(), resolution, side, side).unwrap();
    let outside = Raster::filled(grid, false);
    let estimate = planner_bytes(&config.planner, &model, &grid);
    let before = peak();
    let mut planner =
        Planner::new(&config.planner, &model, &outside, config.robot.radius, 0.0).unwrap();
    let map = CoverageMap::new(grid, config.model.bins).unwrap();
    let middle = grid.cell(grid.len() / 2 + side / 2);
    planner.stand_on(middle);
    // Without measurements no cell promises anything, but all candidates are evaluated.
    drop(planner.choose(&map, middle));
    [peak() - before, estimate]
}

/// Each planner takes more than all before it.
#[test]
fn the_estimate_of_memory_is_near_to_what_is_taken() {
    for (side, resolution, sensors, strategy) in [
        (300, 0.1, 24, Strategy::Cl),
        (700, 0.1, 24, Strategy::Ig),
        (1200, 0.2, 24, Strategy::IgCl { alpha: 0.3 }),
    ] {
        let [taken, estimate] = taken(side, resolution, sensors, strategy);
        let what = format!("{side} cells, {sensors} sensors: {taken}, estimated {estimate}");
        assert!(taken < estimate + (8 << 20), "{what}");
        assert!(estimate < 12 * taken, "{what}");
    }
}
