//! One scan of 24 sonars into a map of 11 bins.
#![allow(missing_docs, clippy::unwrap_used, reason = "a benchmark")]

use covmap::{CoverageMap, Grid};
use covmap_model::{ModelParameters, SensorModel, integrate};
use covmap_sonar::{Range, Scan, SonarRing};
use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry2, Point2};

fn bench(c: &mut Criterion) {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
    let grid = Grid::new(Point2::new(-5.0, -5.0), 0.1, 100, 100).unwrap();
    let mut map = CoverageMap::new(grid, 11).unwrap();
    let ranges = (0..24).map(|i| Range::Echo(1.0 + 0.08 * f64::from(i))).collect();
    let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges };
    c.bench_function("integrate one scan", |b| b.iter(|| integrate(&model, &mut map, &scan)));
}

criterion_group!(benches, bench);
criterion_main!(benches);
