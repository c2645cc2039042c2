//! A map of five cells against the truth.
//!
//! ```text
//! cell            0              1            2         3            4
//! posterior       [.9 .05 .05]   [.1 .2 .7]   unknown   [.2 .6 .2]   [.6 .2 .2]
//! mode, mean      0, .075        1, .8        ½, ½      ½, ½         0, .3
//! true coverage   0              0            .2        1            1
//! ```

use super::{all_close, close, map_of, mission};
use covmap::{Cell, CoverageMap, Raster, Steps};
use covmap_explore::{Limits, explore};
use covmap_lab::{Accuracy, CellCounts, Config, SimulatedRobot, Truth};
use covmap_plan::CellStatus;
use covmap_world::{Extent, Scenario, World};
use std::ops::ControlFlow;

fn map() -> CoverageMap {
    map_of(&[
        Some(vec![0.9, 0.05, 0.05]),
        Some(vec![0.1, 0.2, 0.7]),
        None,
        Some(vec![0.2, 0.6, 0.2]),
        Some(vec![0.6, 0.2, 0.2]),
    ])
}

/// The first three cells can be reached, the others are the first solid cells.
fn truth(map: &CoverageMap) -> Truth {
    let grid = *map.grid();
    let coverage = vec![0.0, 0.0, 0.2, 1.0, 1.0];
    Truth {
        coverage: Raster::from_values(grid, coverage).unwrap(),
        reachable: Raster::from_fn(grid, |cell| cell.x < 3),
        first_solid: Raster::from_fn(grid, |cell| cell.x >= 3),
        first_smooth: Raster::from_fn(grid, |cell| cell.x == 4),
        steps: Steps::between(&grid, |_| true),
        observable: Raster::filled(grid, true),
    }
}

#[test]
fn a_map_is_scored_against_the_truth() {
    let map = map();
    let cells: Vec<Cell> = map.grid().cells().collect();
    let score = truth(&map).score(&map, &cells);
    // Of three reachable cells one is known to be free, one is a phantom, one is unknown.
    close(score.completeness, 1.0 / 3.0, 1e-12);
    close(score.phantom, 1.0 / 3.0, 1e-12);
    close(score.wall_recall, 0.5, 1e-12);
    // The rough wall is found, the smooth one is not.
    assert_eq!((score.wall_recall_rough, score.wall_recall_smooth), (Some(1.0), Some(0.0)));
    // (0 + 1 + .3 + .5 + 1)/5 and (.075 + .8 + .3 + .5 + .7)/5
    close(score.mae_mode, 0.56, 1e-12);
    close(score.mae_mean, 0.475, 1e-6);
    // With p' = .999 p + .001/3: log p' is −.105990, −2.300254, −1.098612, −1.608771 and −1.608771.
    close(score.mean_log_likelihood, -1.344_480_0, 1e-6);
    // Entropies of .394, .802, 1.099, .950 and .950.
    close(score.share_entropy_above_0_65, 0.8, 1e-12);
    // Over a cell with the right mode.
    close(truth(&map).score(&map, &cells[..1]).mae_mode, 0.0, 0.0);
}

#[test]
fn a_cell_is_free_up_to_a_fifth_and_a_wall_from_one_half() {
    // Eleven bins, modes .2, .3, .4, .5.
    let sure = |bin| Some((0..11).map(|k| if k == bin { 0.9 } else { 0.01 }).collect());
    let map = map_of(&[sure(2), sure(3), sure(4), sure(5)]);
    let everywhere = Raster::filled(*map.grid(), true);
    let truth = Truth {
        coverage: Raster::filled(*map.grid(), 0.0),
        reachable: everywhere.clone(),
        first_solid: everywhere.clone(),
        first_smooth: Raster::filled(*map.grid(), false),
        steps: Steps::between(map.grid(), |_| true),
        observable: everywhere,
    };
    let score = truth.score(&map, &[]);
    all_close(&[score.completeness, score.phantom, score.wall_recall], &[0.25; 3], 1e-12);
    assert_eq!((score.wall_recall_rough, score.wall_recall_smooth), (Some(0.25), None));
    assert_eq!((score.mae_mode, score.mean_log_likelihood), (0.0, 0.0));
}

#[test]
fn errors_are_told_by_the_class_of_the_cells() {
    let map = map();
    let cells: Vec<Cell> = map.grid().cells().collect();
    let mission = mission(5, &[0.0], 3.0, Limits::default());
    let accuracy = Accuracy::new(&truth(&map), &mission, &map, &cells);
    let scored = accuracy.scored;
    // Free: (.075 + .8)/2; partial: .3; solid: (.5 + .7)/2.
    let errors = [scored.mae_free, scored.mae_partial, scored.mae_solid];
    all_close(&errors, &[0.437_5, 0.3, 0.6], 1e-6);
    // .00625, .65, .211111, .34 and .5: of cell 0, ½ · .1² + ½ · .05²; and so on.
    close(scored.crps, 0.341_472_2, 1e-6);
    // The body may pin the free cells 0 and 1, and not 2, which is covered in part.
    close(accuracy.compared_cells, 3.0, 0.0);
    close(accuracy.mae_observable, (0.3 + 0.5 + 1.0) / 3.0, 1e-6);
    close(accuracy.log_likelihood_observable, -1.438_718_4, 1e-6);
    close(accuracy.compared.crps, 0.350_370_4, 1e-6);
    // Only cell 0 is known with an entropy of at most .6; the other four are above .65.
    close(accuracy.share_explored, 0.2, 1e-12);
    close(accuracy.share_uncertain, 0.8, 1e-12);
    close(accuracy.observable_cells, 5.0, 0.0);
}

#[test]
fn the_certificate_is_counted_word_by_word() {
    use CellStatus::{Exhausted, NotSeen, Open, Outside, Resolved, Unreachable};
    let words =
        [Open, Resolved, Resolved, Outside, Exhausted, Exhausted, Exhausted, Unreachable, NotSeen];
    let counts = CellCounts::of(&words);
    assert_eq!((counts.open, counts.resolved, counts.exhausted), (1, 2, 3));
    assert_eq!((counts.unreachable, counts.not_seen, counts.outside), (1, 1, 1));
}

#[test]
fn the_scored_cells_are_what_a_run_could_see_and_one_solid_layer_but_not_what_its_body_pinned() {
    let extent = Extent { width: 3.6, height: 2.8 };
    let scenario = Scenario { name: "room".into(), extent, start: None, obstacles: vec![] };
    let config = Config { resolution: 0.2, ..Config::b21r() };
    let world = World::from_scenario(&scenario, config.sonar.surface).unwrap();
    let limits = Limits { max_scans: Some(3), ..Limits::default() };
    let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap();
    let truth = Truth::new(&world, &mission);
    let scored = truth.scored_cells(&world, &mission, &run);
    let pinned = mission.grid.cells().filter(|cell| run.map.is_pinned(*cell)).count();
    let coverage = |cell: &Cell| *truth.coverage.get(*cell).unwrap();
    let count = |solid: f64| scored.iter().filter(|cell| coverage(cell) == solid).count();
    // 18 × 14 cells are free, and 2 · (18 + 14) solid cells around them can be seen.
    assert!(pinned > 0 && scored.iter().all(|cell| !run.map.is_pinned(*cell)));
    assert_eq!((count(0.0), count(1.0)), (18 * 14 - pinned, 2 * (18 + 14)));
}
