//! E[I] and V(l) of view-points: the literal equations beside the cache.
#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark")]

use covmap::{CoverageMap, Grid};
use covmap_gain::{
    GainCache, InformationGain, RangePrediction, Upkeep, ViewPoints, expected_information_gain,
};
use covmap_model::{ModelParameters, SensorModel, integrate};
use covmap_sonar::{Range, Scan, SonarRing};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry2, Point2};

fn bench(c: &mut Criterion) {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
    let grid = Grid::new(Point2::new(-5.0, -5.0), 0.1, 100, 100).unwrap();
    let mut map = CoverageMap::new(grid, 11).unwrap();
    let prediction = RangePrediction {
        gain: InformationGain::Eq14,
        unknown_reflection: 0.0,
        uniform_share: 0.0,
        novelty: 1.0,
    };
    let mut cache = GainCache::new(&model, 0.0, grid, prediction, Upkeep::Kept).unwrap();
    let home = grid.cell_at(Point2::origin()).unwrap();
    for turn in 0..10 {
        let pose = Isometry2::new(grid.center(home).coords, 0.0);
        let range = |i| Range::Echo(1.0 + 0.08 * f64::from((i + turn) % 24));
        let scan = Scan { pose, time: 0.0, ranges: (0..24).map(range).collect() };
        for change in integrate(&model, &mut map, &scan) {
            cache.update(&map, change.cell);
        }
    }

    c.bench_function("E[I] of one view-point, literal, f64", |b| {
        let stencil = cache.stencil();
        b.iter(|| expected_information_gain(&map, &model, stencil, prediction, home));
    });
    let mut all = ViewPoints::new(&grid);
    (0..grid.len()).for_each(|index| all.insert(index));
    for (what, refresh) in [
        ("V(l)", GainCache::refresh_sight as fn(&mut GainCache, &ViewPoints)),
        ("bounds and V(l)", GainCache::refresh_bounds),
        ("E[I] and V(l)", GainCache::refresh_gains),
    ] {
        c.bench_function(&format!("{what} of {} view-points, nothing cached", grid.len()), |b| {
            b.iter_batched_ref(
                || cache.clone(),
                |cache| refresh(cache, &all),
                BatchSize::LargeInput,
            );
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = bench
}
criterion_main!(benches);
