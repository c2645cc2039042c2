//! Whole runs in small worlds: they end, they repeat, and their certificates hold.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

use covmap_explore::{
    Ending, Event, Limits, Mission, RecordedRobot, Run, TraceHasher, View, explore, explore_by,
};
use covmap_lab::{Accuracy, Config, SetupError, SimulatedRobot, TraceHeader, Truth};
use covmap_plan::{CandidateRecord, CellStatus, Reason, Strategy};
use covmap_statistics::{stream, uniform};
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use proptest::prelude::*;
use proptest::strategy::Strategy as Generator;
use std::ops::ControlFlow;

fn config(strategy: Strategy) -> Config {
    let mut config = Config::b21r();
    config.resolution = 0.2;
    config.planner.strategy = strategy;
    config
}

fn world(obstacles: Vec<Obstacle>) -> World {
    let extent = Extent { width: 3.6, height: 2.8 };
    let scenario = Scenario { name: "room".into(), extent, start: None, obstacles };
    World::from_scenario(&scenario, Surface::Rough).unwrap()
}

fn run(world: &World, config: &Config, seed: u64, limits: Limits) -> (Run, Vec<Event>, String) {
    let mission = covmap_lab::mission(world, config, None, limits).unwrap();
    let mut robot = SimulatedRobot::new(world, config, seed).unwrap();
    let (mut events, mut hash) = (Vec::new(), TraceHasher::default());
    let run = explore(&mission, &mut robot, &mut |event, _| {
        hash.add(event);
        events.push(event.clone());
        ControlFlow::Continue(())
    });
    (run.unwrap(), events, hash.finish())
}

fn some_obstacles() -> impl Generator<Value = Vec<Obstacle>> {
    let place = (0.0..3.6f64, 0.0..2.8f64);
    let shape = prop_oneof![
        (place.clone(), 0.05..0.3f64).prop_map(|(center, radius)| Shape::Circle { center, radius }),
        (place.clone(), 0.1..0.8f64, 0.1..0.8f64, 0.0..3.0f64)
            .prop_map(|(center, w, h, angle)| Shape::Rectangle { center, size: (w, h), angle }),
        (place.clone(), place, 0.05..0.2f64).prop_map(|(from, to, thickness)| Shape::Wall {
            from,
            to,
            thickness
        }),
    ];
    let surface = prop_oneof![Just(Surface::Rough), Just(Surface::Smooth)];
    prop::collection::vec(
        (shape, surface).prop_map(|(shape, surface)| Obstacle { shape, surface }),
        0..5,
    )
}

fn strategies() -> [Strategy; 5] {
    [
        Strategy::Cl,
        Strategy::Ig,
        Strategy::IgWin { radius: 1.0 },
        Strategy::IgCl { alpha: 0.3 },
        Strategy::Count { times: 3.0, half_distance: None },
    ]
}

/// Explores a world; the setup is refused if the robot cannot stand in it.
fn check_that_it_ends(
    obstacles: Vec<Obstacle>,
    strategy: Strategy,
    seed: u64,
    while_driving: Option<f64>,
) -> Result<(), TestCaseError> {
    let is_short = |o: &Obstacle| match o.shape {
        Shape::Wall { from, to, .. } => libm::hypot(from.0 - to.0, from.1 - to.1) < 0.2,
        _ => false,
    };
    prop_assume!(!obstacles.iter().any(is_short));
    let world = world(obstacles);
    let config = config(strategy);
    let limits = Limits { while_driving, max_scans: Some(20_000) };
    prop_assume!(covmap_lab::mission(&world, &config, None, limits).is_ok());
    let (run, events, _) = run(&world, &config, seed, limits);
    prop_assert!(matches!(run.ending, Ending::Explored | Ending::StartBlocked), "{:?}", run.ending);
    prop_assert!(run.certificate.values().iter().all(|s| *s != CellStatus::Open));
    let scans = events.iter().filter(|e| matches!(e, Event::Scan { .. })).count();
    prop_assert_eq!(scans, run.scans.len());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_run_ends_and_nothing_is_open_then(
        obstacles in some_obstacles(), strategy in prop::sample::select(strategies().to_vec()),
        seed in 0..1000u64, while_driving in prop::option::of(0.1..0.5f64)
    ) {
        check_that_it_ends(obstacles, strategy, seed, while_driving)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "minutes: cargo test --release -p covmap-lab --test runs -- --ignored"]
    fn each_of_300_worlds_is_explored_by_every_strategy(
        obstacles in some_obstacles(), seed in 0..1000u64, while_driving in prop::option::of(0.1..0.5f64)
    ) {
        for strategy in strategies() {
            check_that_it_ends(obstacles.clone(), strategy, seed, while_driving)?;
        }
    }
}

#[test]
fn the_same_run_twice_is_the_same_to_the_last_bit() {
    let (world, config) = (world(vec![]), config(Strategy::IgCl { alpha: 0.3 }));
    let (a, _, first) = run(&world, &config, 7, Limits::default());
    let (b, _, second) = run(&world, &config, 7, Limits::default());
    assert_eq!(first, second);
    assert_eq!(a.map.to_bytes(), b.map.to_bytes());
    assert_ne!(first, run(&world, &config, 8, Limits::default()).2);
}

#[test]
fn alpha_zero_gives_the_trace_of_closest_location() {
    let world = world(vec![]);
    let targets = |strategy| {
        let (_, events, _) = run(&world, &config(strategy), 3, Limits::default());
        let target = |e: Event| match e {
            Event::Decision { decision, .. } => Some(decision.target),
            _ => None,
        };
        events.into_iter().filter_map(target).collect::<Vec<_>>()
    };
    assert_eq!(targets(Strategy::IgCl { alpha: 0.0 }), targets(Strategy::Cl));
}

#[test]
fn a_run_that_explains_less_is_the_same_run() {
    let world = world(Vec::new());
    for strategy in [Strategy::Cl, Strategy::IgCl { alpha: 0.3 }] {
        let mut config = config(strategy);
        config.planner.reason = Reason::InSight;
        let mut gains = 0.0;
        let [told, untold] = [true, false].map(|explains| {
            let limits = Limits { max_scans: Some(30), ..Limits::default() };
            let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
            let mission = Mission { explains, ..mission };
            let mut robot = SimulatedRobot::new(&world, &config, 3).unwrap();
            let mut hash = TraceHasher::default();
            explore(&mission, &mut robot, &mut |event, _| {
                hash.add_event(event);
                if let Event::Decision { decision, .. } = event {
                    gains = decision.best[0].gain;
                }
                ControlFlow::Continue(())
            })
            .unwrap();
            (hash.finish(), gains)
        });
        assert_eq!(told.0, untold.0, "{strategy}");
        assert!(told.1 > 0.0);
        // IG_CL needs the gains.
        assert_eq!(untold.1 > 0.0, strategy != Strategy::Cl);
    }
}

#[test]
fn a_recorded_run_repeats_itself() {
    let shape = Shape::Circle { center: (0.9, 0.9), radius: 0.2 };
    let world = world(vec![Obstacle { shape, surface: Surface::Rough }]);
    let config = config(Strategy::Ig);
    let limits = Limits { while_driving: Some(0.3), max_scans: None };
    let (first, events, hash) = run(&world, &config, 5, limits);
    let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
    let mut robot = RecordedRobot::new(events, 24);
    let mut again = TraceHasher::default();
    let replayed = explore(&mission, &mut robot, &mut |event, _| {
        again.add(event);
        ControlFlow::Continue(())
    });
    assert_eq!(again.finish(), hash);
    assert_eq!(replayed.unwrap().map.to_bytes(), first.map.to_bytes());
}

#[test]
fn a_budget_and_an_interruption_end_a_run() {
    let (world, config) = (world(vec![]), config(Strategy::Cl));
    let limits = Limits { while_driving: None, max_scans: Some(4) };
    let (spent, ..) = run(&world, &config, 1, limits);
    assert_eq!((spent.ending, spent.scans.len()), (Ending::BudgetSpent, 4));
    let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    let stopped = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Break(())).unwrap();
    assert_eq!((stopped.ending, stopped.scans.len()), (Ending::Interrupted, 1));
}

#[test]
fn a_robot_that_is_walled_in_says_so() {
    let wall = |center, size| Obstacle {
        shape: Shape::Rectangle { center, size, angle: 0.0 },
        surface: Surface::Rough,
    };
    let world = world(vec![
        wall((0.9, 1.4), (1.6, 2.8)),
        wall((2.7, 1.4), (1.6, 2.8)),
        wall((1.8, 0.5), (0.4, 1.4)),
        wall((1.8, 2.3), (0.4, 1.4)),
    ]);
    // A cell of free space is left that no robot fits into.
    let refused = covmap_lab::mission(&world, &config(Strategy::Cl), None, Limits::default());
    assert!(refused.is_err());
}

#[test]
fn an_empty_room_is_mapped_completely() {
    let (world, config) = (world(vec![]), config(Strategy::IgCl { alpha: 0.3 }));
    let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let (run, ..) = run(&world, &config, 1, Limits::default());
    let truth = Truth::new(&world, &mission);
    let score = truth.score(&run.map, &truth.scored_cells(&world, &mission, &run));
    assert_eq!(run.ending, Ending::Explored);
    assert!(score.completeness > 0.97, "{score:?}");
    assert!(score.wall_recall > 0.8, "{score:?}");
    assert!(score.mean_log_likelihood.is_finite() && score.mae_mode >= 0.0);
}

#[test]
fn maps_of_different_runs_are_compared_over_the_same_cells_and_the_body_pins_none_of_them() {
    let obstacle = Shape::Rectangle { center: (2.6, 1.1), size: (0.5, 0.7), angle: 0.3 };
    let world = world(vec![Obstacle { shape: obstacle, surface: Surface::Rough }]);
    let mut scored = Vec::new();
    let mut compared = Vec::new();
    for (strategy, scans) in [(Strategy::Cl, 2), (Strategy::Ig, 60)] {
        let config = config(strategy);
        let limits = Limits { max_scans: Some(scans), ..Limits::default() };
        let (run, ..) = run(&world, &config, 1, limits);
        let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
        let truth = Truth::new(&world, &mission);
        let cells = truth.compared_cells(config.robot.radius);
        assert!(cells.len() > 50 && cells.iter().all(|cell| !run.map.is_pinned(*cell)));
        let own = truth.scored_cells(&world, &mission, &run);
        let accuracy = Accuracy::new(&truth, &mission, &run.map, &own);
        assert_eq!(accuracy.compared_cells, f64::from(u32::try_from(cells.len()).unwrap()));
        // Unknown cells are uniform: they are off by half a coverage at either end.
        let nothing = covmap::CoverageMap::new(mission.grid, config.model.bins).unwrap();
        let unknown = Accuracy::new(&truth, &mission, &nothing, &own);
        assert!((unknown.compared.mae_solid - 0.5).abs() < 1e-6);
        assert!(accuracy.mae_observable < unknown.mae_observable);
        scored.push(own);
        compared.push(cells);
    }
    assert_eq!(compared[0], compared[1]);
    assert_ne!(scored[0], scored[1], "what a run could see differs");
}

#[test]
fn a_mission_that_anybody_put_together_is_checked() {
    let (world, config) = (world(vec![]), config(Strategy::Cl));
    let good = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let header = TraceHeader::new(&good, &config.sonar, "room", 1);
    assert_eq!(header.mission(), Ok(good.clone()));
    let refuse = |mission: Mission, expected: &str| {
        let header = TraceHeader::new(&mission, &config.sonar, "room", 1);
        let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
        let explored = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(()));
        for error in [header.mission().unwrap_err(), SetupError::from(explored.unwrap_err())] {
            assert!(error.to_string().contains(expected), "{error}");
        }
    };
    for step in [0.0, -1.0, 1e-12, f64::NAN, f64::INFINITY, 1e300] {
        let limits = Limits { while_driving: Some(step), max_scans: None };
        refuse(Mission { limits, ..good.clone() }, "measuring while driving every");
        assert!(covmap_lab::mission(&world, &config, None, limits).is_err(), "{step}");
    }
    let limits = Limits { while_driving: None, max_scans: Some(0) };
    refuse(Mission { limits, ..good.clone() }, "max_scans is 0");
    let mut far = good.clone();
    far.start.translation.vector.x = 1e300;
    refuse(far, "the start (1e300, ");
    let mut coarse = good.clone();
    coarse.config.resolution = 0.3;
    refuse(coarse, "resolution of 0.3 m");
    for inside in [(5, 5), (0, 1_000_000), (9, 3)] {
        let header = TraceHeader { inside: vec![(0, 1), inside], ..header.clone() };
        let error = header.mission().unwrap_err().to_string();
        assert!(error.starts_with("inside[1]: ("), "{error}");
    }
}

#[test]
fn a_run_by_a_strategy_from_outside_ends_as_well() {
    let (world, config) = (world(vec![]), config(Strategy::Cl));
    let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    let mut random = stream(1, "strategy", 0);
    let mut any = |_: &CandidateRecord| uniform(&mut random);
    let mut on = |_: &Event, _: &View<'_>| ControlFlow::Continue(());
    let run = explore_by(&mission, &mut robot, &mut on, &mut any).unwrap();
    assert_eq!(run.ending, Ending::Explored);
    assert!(run.certificate.values().iter().all(|status| *status != CellStatus::Open));
}
