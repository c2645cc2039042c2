//! All candidates of a planner, and one distance field.
#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark")]

use covmap::{CoverageMap, Grid, Raster, Steps};
use covmap_model::{ModelParameters, SensorModel, integrate, integrate_body};
use covmap_plan::{Planner, PlannerParameters, Strategy, travel_costs};
use covmap_sonar::{Range, Scan, SonarRing};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry2, Point2};

fn bench(c: &mut Criterion) {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
    let grid = Grid::new(Point2::new(-5.0, -5.0), 0.1, 100, 100).unwrap();
    let mut map = CoverageMap::new(grid, 11).unwrap();
    let parameters = PlannerParameters { strategy: Strategy::Ig, ..PlannerParameters::standard() };
    let outside = Raster::filled(grid, false);
    let mut planner = Planner::new(&parameters, &model, &outside, 0.27, 0.0).unwrap();
    let home = grid.cell_at(Point2::origin()).unwrap();
    let body = integrate_body(&mut map, Point2::origin(), Point2::origin(), 0.27);
    planner.body_moved(&map, Point2::origin(), Point2::origin(), &body);
    planner.stand_on(home);
    for turn in 0..10 {
        let pose = Isometry2::new(grid.center(home).coords, 0.0);
        let range = |i| Range::Echo(1.0 + 0.08 * f64::from((i + turn) % 24));
        let scan = Scan { pose, time: 0.0, ranges: (0..24).map(range).collect() };
        let changes = integrate(&model, &mut map, &scan);
        planner.observe(&map, &scan, &changes);
    }

    let candidates = planner.clone().candidate_table(&map, home).len();
    c.bench_function(&format!("{candidates} candidates with their gains, nothing cached"), |b| {
        b.iter_batched_ref(
            || planner.clone(),
            |planner| planner.candidate_table(&map, home),
            BatchSize::LargeInput,
        );
    });

    let grid = Grid::new(Point2::origin(), 0.1, 1000, 1000).unwrap();
    let middle = grid.cell(500_500);
    c.bench_function("distance field, 1000 × 1000 cells", |b| {
        b.iter(|| travel_costs(Steps::between(&grid, |i| i % 17 != 0), middle));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = bench
}
criterion_main!(benches);
