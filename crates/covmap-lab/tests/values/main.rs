//! Scores and counts worked out by hand, with their derivation; and the rules of the loop, one by
//! one, with a robot that does as it is told.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

mod rules;
mod scores;
mod strategies;
mod tallies;

use covmap::{CoverageMap, Grid, Raster};
use covmap_explore::{Limits, Mission, RobotParameters};
use covmap_lab::Config;
use covmap_model::{
    FootprintRule, Linear, ModelParameters, NoEchoParameters, ProductParameters, Update,
};
use covmap_plan::{PlannerParameters, StallRule, Strategy};
use covmap_sonar::{RingSpecification, SensorSpecification};
use nalgebra::{Isometry2, Point2};

#[track_caller]
fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} is not {expected}");
}

#[track_caller]
fn all_close(actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len(), "{actual:?}");
    actual.iter().zip(expected).for_each(|(a, e)| close(*a, *e, tolerance));
}

/// A robot of radius .3 m in a corridor of cells of 1 m, with rays of `range` [m] in these
/// directions [degrees]; three bins, Closest Location, ε = .6.
fn mission(cells: usize, directions: &[f64], range: f64, limits: Limits) -> Mission {
    let sensor = |degrees: &f64| SensorSpecification {
        x: 0.0,
        y: 0.0,
        angle: degrees.to_radians(),
        half_angle: 0.1,
        min_range: 0.0,
        max_range: 10.0,
    };
    let sensors = directions.iter().map(sensor).collect();
    let config = Config {
        resolution: 1.0,
        robot: RobotParameters {
            radius: 0.3,
            speed: 0.5,
            ring: RingSpecification::Sensors(sensors),
        },
        model: ModelParameters {
            bins: 3,
            usable_range: range,
            footprint: FootprintRule::Cones { half_angle: 0.0 },
            update: Update::Product(ProductParameters {
                sigma_out: Linear { base: 0.25, per_cell_distance: 0.0, per_range: 0.0 },
                sigma_in: 0.6,
                gamma: Linear { base: 0.1, per_cell_distance: 0.0, per_range: 0.0 },
                behind: 0.0,
                no_echo: NoEchoParameters { range, gamma: 0.1 },
                tempering: 1.0,
            }),
        },
        planner: PlannerParameters {
            strategy: Strategy::Cl,
            reason: covmap_plan::Reason::InSight,
            scan_spacing: 0.0,
            turn_cost: 0.0,
            passage_length: 0.0,
            stall_rule: StallRule::Unbanded,
            ..PlannerParameters::standard()
        },
        ..Config::b21r()
    };
    let grid = Grid::new(Point2::origin(), 1.0, cells, 1).unwrap();
    let start = Isometry2::new([1.5, 0.5].into(), 0.0);
    Mission {
        config: config.parameters(),
        grid,
        outside: Raster::filled(grid, false),
        start,
        limits,
        explains: true,
    }
}

/// A map of these posteriors; cells without one are unknown.
fn map_of(posteriors: &[Option<Vec<f64>>]) -> CoverageMap {
    let grid = Grid::new(Point2::origin(), 1.0, posteriors.len(), 1).unwrap();
    let bins = posteriors.iter().flatten().map(Vec::len).next().unwrap();
    let mut map = CoverageMap::new(grid, bins).unwrap();
    for (cell, posterior) in grid.cells().zip(posteriors) {
        posterior.iter().for_each(|posterior| {
            map.multiply(cell, posterior);
        });
    }
    map
}
