//! Decisions in the office: ten more scans and choices, half a minute into its exploration.
#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark")]

use covmap_explore::{Limits, explore};
use covmap_lab::{Config, SimulatedRobot};
use covmap_world::{Scenario, World};
use criterion::{Criterion, criterion_group, criterion_main};
use std::ops::ControlFlow;

const OFFICE: &str = include_str!("../../../scenarios/office.ron");

fn bench(c: &mut Criterion) {
    let config = Config::b21r();
    let scenario: Scenario = ron::from_str(OFFICE).unwrap();
    let world = World::from_scenario(&scenario, config.sonar.surface).unwrap();
    let mut group = c.benchmark_group("office, r = .1, IG_CL:0.3");
    for scans in [100, 110] {
        let limits = Limits { while_driving: None, max_scans: Some(scans) };
        let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
        group.bench_function(format!("{scans} scans and decisions"), |b| {
            b.iter(|| {
                let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
                explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap()
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = bench
}
criterion_main!(benches);
