//! Kept values are those of a fresh cache, and bounds hold.

use super::*;
use covmap::Raster;
use covmap_model::{ModelParameters, integrate};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2, Vector2};

/// Returns every kind of registers that this machine has.
fn kinds() -> Vec<Arch> {
    let mut kinds = vec![Arch::Scalar];
    #[cfg(target_arch = "x86_64")]
    {
        kinds.extend(pulp::x86::V3::try_new().map(Arch::V3));
        kinds.extend(pulp::x86::V4::try_new().map(Arch::V4));
    }
    kinds.push(Arch::new());
    kinds
}

/// Creates a cache of an unknown map.
fn kept(model: &SensorModel, grid: Grid) -> GainCache {
    let prediction = RangePrediction {
        gain: InformationGain::Eq14,
        unknown_reflection: 0.0,
        uniform_share: 0.0,
        novelty: 1.0,
    };
    GainCache::new(model, 0.1, grid, prediction, Upkeep::Kept).unwrap()
}

/// Takes over a cell, and forgets all values that may depend on it.
fn see(cache: &mut GainCache, map: &CoverageMap, cell: Cell) {
    cache.update(map, cell);
    cache.onlookers.mark(cache.grid.index(cell).unwrap(), CellChange::Reflection);
}

/// Returns all kept values after some scans, with one kind of registers.
fn values(arch: Arch) -> (Vec<u64>, Vec<[u16; LANES]>, Vec<u16>) {
    let model = SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.1).unwrap();
    let grid = Grid::new(Point2::new(-2.0, -2.0), 0.1, 43, 37).unwrap();
    let mut map = CoverageMap::new(grid, 11).unwrap();
    let mut cache = kept(&model, grid);
    cache.arch = arch;
    let all = Raster::filled(grid, ());
    let wanted = ViewPoints::of(&grid, 0..all.values().len());
    for turn in 0..4 {
        let pose = Isometry2::new(Vector2::new(0.1 * f64::from(turn), 0.0), 0.1);
        let range = |i| Range::Echo(0.5 + 0.07 * f64::from((i * 7 + turn) % 24));
        let scan = Scan { pose, time: 0.0, ranges: (0..24).map(range).collect() };
        for change in integrate(&model, &mut map, &scan) {
            see(&mut cache, &map, change.cell);
            cache.set_limit(grid.index(change.cell).unwrap(), 1.0);
        }
        cache.refresh_gains(&wanted);
    }
    let gains = (0..grid.len()).map(|index| cache.gain(index).to_bits()).collect();
    let reasons = cache.groups.iter().map(|group| group.has_reason).collect();
    (gains, cache.in_sight, reasons)
}

#[test]
fn gains_that_are_kept_are_those_of_a_fresh_cache() {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1).unwrap();
    for (width, height) in [(1, 1), (1, 20), (17, 3), (43, 90)] {
        let grid = Grid::new(Point2::new(-0.05, -0.05), 0.1, width, height).unwrap();
        let mut map = CoverageMap::new(grid, 11).unwrap();
        let mut cache = kept(&model, grid);
        let last = height - 1;
        // Rows are first outside of the evaluated part, then inside, and then outside again.
        for (turn, rows) in
            [0..1, last..height, height / 2..height / 2 + 1, 0..height, last..height, 0..1]
                .into_iter()
                .enumerate()
        {
            let pose = Isometry2::new(Vector2::new(0.0, 0.2 * turn as f64), 0.1);
            let range = |i: usize| Range::Echo(0.5 + 0.07 * ((i * 7 + turn) % 24) as f64);
            let scan = Scan { pose, time: 0.0, ranges: (0..24).map(range).collect() };
            for change in integrate(&model, &mut map, &scan) {
                see(&mut cache, &map, change.cell);
            }
            let wanted = ViewPoints::of(&grid, rows.start * width..rows.end * width);
            cache.refresh_gains(&wanted);
            let mut fresh = kept(&model, grid);
            for cell in grid.cells() {
                fresh.update(&map, cell);
            }
            fresh.refresh_gains(&wanted);
            for index in rows.start * width..rows.end * width {
                assert_eq!(cache.gain(index).to_bits(), fresh.gain(index).to_bits());
            }
        }
    }
}

#[test]
fn no_gain_exceeds_its_bound() {
    for model in [ModelParameters::b21r(), ModelParameters::product(), ModelParameters::by_hand()] {
        let model = SensorModel::new(&model, &SonarRing::b21r(), 0.1).unwrap();
        let grid = Grid::new(Point2::new(-2.0, -2.0), 0.1, 43, 37).unwrap();
        let mut map = CoverageMap::new(grid, 11).unwrap();
        let mut cache = kept(&model, grid);
        let wanted = ViewPoints::of(&grid, 0..grid.len());
        let (mut loose, mut all) = (0.0, 0.0);
        for turn in 0..12u32 {
            let pose = Isometry2::new(Vector2::new(0.1 * f64::from(turn), 0.0), 0.1);
            let range = |i: u32| Range::Echo(0.5 + 0.07 * f64::from((i * 7 + turn) % 24));
            let scan = Scan { pose, time: 0.0, ranges: (0..24).map(range).collect() };
            for change in integrate(&model, &mut map, &scan) {
                see(&mut cache, &map, change.cell);
            }
            cache.refresh_bounds(&wanted);
            let bounds: Vec<f64> = (0..grid.len()).map(|index| cache.gain(index)).collect();
            let bounded = |index: &usize| !cache.is_exact(*index);
            let bounded: Vec<usize> = (0..grid.len()).filter(bounded).collect();
            assert!(!bounded.is_empty());
            cache.refresh_gains(&wanted);
            for index in bounded {
                assert!(cache.is_exact(index) && cache.gain(index) <= bounds[index]);
                loose += bounds[index] - cache.gain(index);
                all += cache.gain(index).max(0.0);
            }
        }
        assert!(loose < all, "bounds are some {} times as large", 1.0 + loose / all);
    }
}

#[test]
fn rows_far_apart_are_not_evaluated_together() {
    let rows = [0, 1, 2, 3, 40, 49, 50, 2000].map(|y| (y, ()));
    let portions = portions(&rows, 3, 10);
    let firsts: Vec<Vec<usize>> =
        portions.iter().map(|portion| portion.iter().map(|(y, ())| *y).collect()).collect();
    assert_eq!(firsts, [vec![0, 1, 2], vec![3], vec![40, 49], vec![50], vec![2000]]);
}

#[test]
fn all_vector_registers_give_the_same_bits() {
    let all: Vec<_> = kinds().into_iter().map(values).collect();
    assert!(all.len() > 1 && all.iter().all(|values| *values == all[0]));
    assert!(all[0].0.iter().any(|gain| f64::from_bits(*gain) > 0.1));
}
