//! The tally of measurements, and the setup of a mission.

use super::{close, map_of, mission};
use covmap::Raster;
use covmap_explore::{Limits, MissionError};
use covmap_lab::{Config, SetupError, Tally, TraceHeader};
use covmap_sonar::{Range, Scan};
use covmap_world::{Extent, Scenario, World};
use nalgebra::Isometry2;

#[test]
fn measurements_are_counted_until_a_cell_is_explored_and_in_all() {
    // A ray from cell 0 intercepts the cells 1, 2 and 3, in each of three scans.
    let mission = mission(5, &[0.0], 3.0, Limits::default());
    let mut tally = Tally::new(&mission).unwrap();
    let pose = Isometry2::new([0.5, 0.5].into(), 0.0);
    let scan = Scan { pose, time: 0.0, ranges: vec![Range::NoEcho] };
    // ε = .6. Cell 1 is explored after the first scan, cell 2 after the second, cell 3 never.
    let (sure, vague) = (Some(vec![0.9, 0.05, 0.05]), Some(vec![0.5, 0.3, 0.2]));
    let first = map_of(&[None, sure.clone(), vague.clone(), vague.clone(), None]);
    let second = map_of(&[None, sure.clone(), sure, vague, None]);
    [&first, &second, &second].into_iter().for_each(|map| tally.add(map, &scan));
    let m = tally.finish(&Raster::from_fn(mission.grid, |cell| cell.x >= 1));
    // Discounted by 1/(1 + d/2): ⅔ once for cell 1, ½ twice for cell 2.
    close(m.until_explored, 2.0, 0.0);
    close(m.until_explored_discounted, 1.0, 1e-12);
    // 3, 3, 3 and 0: mean 9/4, variance (3 · (¾)² + (9/4)²)/4 = 27/16.
    close(m.mean, 2.25, 1e-12);
    close(m.deviation, 1.299_038_1, 1e-6);
    assert_eq!((m.least, m.most), (0.0, 3.0));
}

#[test]
fn a_header_tells_what_is_outside() {
    let mut mission = mission(9, &[0.0], 3.0, Limits::default());
    mission.outside = Raster::from_fn(mission.grid, |cell| [0, 3, 4, 8].contains(&cell.x));
    let header = TraceHeader::new(&mission, &Config::b21r().sonar, "corridor", 7);
    assert_eq!(header.inside, [(1, 3), (5, 8)]);
    assert_eq!((header.seed, header.mission().unwrap()), (7, mission));
}

#[test]
fn a_mission_starts_where_the_robot_fits_and_ends_at_the_extent() {
    let extent = Extent { width: 4.0, height: 3.0 };
    let scenario = Scenario { name: "room".into(), extent, start: None, obstacles: vec![] };
    let config = Config { resolution: 0.5, ..Config::b21r() };
    let world = World::from_scenario(&scenario, config.sonar.surface).unwrap();
    let at = |x: f64| {
        let start = Isometry2::new([x, 1.0].into(), 0.0);
        covmap_lab::mission(&world, &config, Some(start), Limits::default())
    };
    // The robot's radius is .27 m, the wall is at 0.
    assert!(matches!(at(0.26), Err(SetupError::StartOccupied { .. })));
    assert!(matches!(at(-0.1), Err(SetupError::Mission(MissionError::StartOutside(..)))));
    // 8 × 6 cells of the grid, which has a margin, lie inside.
    let outside = at(0.28).unwrap().outside;
    assert_eq!(outside.values().iter().filter(|outside| !**outside).count(), 48);
    assert!(outside.values().len() > 48);
}
