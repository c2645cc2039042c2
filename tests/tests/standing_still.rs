//! A robot that stands still becomes no more certain than its errors allow.

use crate::root;
use covmap::CoverageMap;
use covmap_explore::Limits;
use covmap_fit::{ExampleScore, Weighting};
use covmap_io::read_ron;
use covmap_lab::{Config, SimulatedRobot, Truth};
use covmap_model::{Looks, Repeats, SensorModel};
use covmap_sonar::Scan;
use covmap_world::{Scenario, Surface, World};

/// Returns the class mean of the log-likelihood of the measured cells, after each number of scans
/// from one place.
fn score(scenario: &str, seed: u64, share: f64, scans: [usize; 2]) -> [f64; 2] {
    let path = root().join("scenarios").join(scenario).with_extension("ron");
    let scenario: Scenario = read_ron(&path).unwrap();
    let world = World::from_scenario(&scenario, Surface::Rough).unwrap();
    let mut config = Config::b21r();
    config.model =
        config.model.with_cause(|cause| cause.repeats = Repeats { share, ..cause.repeats });
    let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, seed).unwrap();
    let (ring, _) = config.build().unwrap();
    let model = SensorModel::new(&config.model, &ring, config.resolution).unwrap();
    let (mut map, mut looks) =
        (CoverageMap::new(mission.grid, config.model.bins).unwrap(), Looks::new(&model));
    let truth = Truth::new(&world, &mission);
    let mut taken = 0;
    scans.map(|scans| {
        while taken < scans {
            let scan = Scan { pose: mission.start, time: 0.0, ranges: robot.fire(&mission.start) };
            looks.integrate(&model, &mut map, &scan);
            taken += 1;
        }
        let of = |cell| {
            let histogram = map.histogram(cell);
            (histogram.probabilities().to_vec(), truth.coverage.get(cell).copied().unwrap_or(1.0))
        };
        let cells: Vec<_> = truth.measured_cells(&map).into_iter().map(of).collect();
        Weighting::Classes.objective(&ExampleScore::of(cells.iter().map(|(p, truth)| (p, *truth))))
    })
}

#[test]
fn three_hundred_scans_from_one_place_are_no_worse_than_ten() {
    for (scenario, seed) in [("lab", 1), ("office", 2), ("hall", 3)] {
        let share = Config::b21r().model.update.cause().unwrap().repeats.share;
        let [few, many] = score(scenario, seed, share, [10, 300]);
        assert!(many > few - 0.02, "{scenario}: {few} {many}");
        // The result if every look were independent.
        let [_, independent] = score(scenario, seed, 0.0, [10, 300]);
        assert!(independent < many - 0.2, "{scenario}: {independent} {many}");
    }
}
