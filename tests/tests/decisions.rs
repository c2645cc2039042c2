//! A decision by bounds, compared with a decision by all gains.

use crate::{files, root};
use covmap_explore::{Event, Limits, explore};
use covmap_gain::GAIN_TOLERANCE;
use covmap_io::read_ron;
use covmap_lab::{Config, SimulatedRobot};
use covmap_plan::{Reason, Strategy};
use covmap_world::{Scenario, Surface, World};
use std::ops::ControlFlow;
use std::path::Path;

/// Returns the number of decisions of a run, and the number of those that all gains would change.
fn decisions(scenario: &Path, resolution: f64, strategy: Strategy, scans: usize) -> [usize; 2] {
    let scenario: Scenario = read_ron(scenario).unwrap();
    let world = World::from_scenario(&scenario, Surface::Rough).unwrap();
    let mut config = Config::b21r();
    (config.resolution, config.planner.strategy) = (resolution, strategy);
    let limits = Limits { max_scans: Some(scans), ..Limits::default() };
    let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    let (mut all, mut others) = (0, 0);
    explore(&mission, &mut robot, &mut |event, view| {
        if let Event::Decision { from, decision, .. } = event {
            let mut planner = view.planner.clone();
            let table = planner.candidate_table(view.map, *from);
            // Candidates without a promise are passed over.
            let Reason::ExpectedChange { scan, .. } = config.planner.reason else { panic!() };
            let least = scan / (resolution * resolution);
            let promises = |cell| {
                view.map.grid().index(cell).is_some_and(|i| planner.gains().promise(i) >= least)
            };
            if decision.towards_ground {
                return ControlFlow::Continue(());
            }
            assert!(promises(decision.target));
            let score = |cell| table.iter().find(|r| r.cell == cell).map(|record| record.score);
            let promising = table.iter().filter(|r| promises(r.cell));
            let best = promising.map(|r| r.score).fold(f64::NEG_INFINITY, f64::max);
            // The literal equations decide ties.
            let off = 4.0 * GAIN_TOLERANCE * best.abs().max(1.0);
            all += 1;
            others += usize::from(score(decision.target).is_none_or(|score| score < best - off));
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    [all, others]
}

#[test]
fn what_bounds_decide_on_coarse_grids_is_what_all_gains_would() {
    for (name, strategy) in [
        ("hall", Strategy::IgCl { alpha: 0.3 }),
        ("office", Strategy::Ig),
        ("corridor", Strategy::IgCl { alpha: 0.3 }),
    ] {
        let scenario = root().join("scenarios").join(name).with_extension("ron");
        let [all, others] = decisions(&scenario, 0.3, strategy, 40);
        assert!(all >= 30 && others == 0, "{name}: {others} of {all} differ");
    }
}

#[test]
#[allow(clippy::print_stdout, reason = "a figure to be looked at")]
#[ignore = "takes many minutes: the figure in docs/architecture.md"]
fn all_scenarios() {
    let mut sum = [0, 0];
    for scenario in files("scenarios", "ron") {
        for resolution in [0.1, 0.2, 0.3] {
            for strategy in [Strategy::Ig, Strategy::IgCl { alpha: 0.3 }] {
                let [all, others] = decisions(&scenario, resolution, strategy, 100);
                println!("{} {resolution} {strategy}: {others} of {all}", scenario.display());
                sum = [sum[0] + all, sum[1] + others];
            }
        }
    }
    println!("{} of {} decisions differ", sum[1], sum[0]);
}
