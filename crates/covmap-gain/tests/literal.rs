//! The cache on random maps: its gains are those of the literal equations and below their bounds,
//! and kept values are those of a fresh cache.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

use covmap::{CoverageMap, Grid};
use covmap_gain::{
    BeamError, GAIN_TOLERANCE, GainCache, InformationGain, RangePrediction, Upkeep, ViewPoints,
    expected_changes, expected_information_gain,
};
use covmap_model::{
    CauseParameters, FootprintRule, FreeSpace, Linear, ModelParameters, NoEchoShare, Repeats,
    SensorModel, Update, integrate, integrate_body,
};
use covmap_sonar::{Beam, Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};
use proptest::prelude::*;
use std::f64::consts::PI;

const PLAIN: RangePrediction = RangePrediction {
    gain: InformationGain::Eq14,
    unknown_reflection: 0.0,
    uniform_share: 0.0,
    novelty: 1.0,
};

/// One view-point in this number is compared with the literal equations, which are slow.
const SAMPLED: usize = 37;

struct Setting {
    model: SensorModel,
    prediction: RangePrediction,
    map: CoverageMap,
    cache: GainCache,
}

impl Setting {
    fn new(model: &ModelParameters, ring: &SonarRing, prediction: RangePrediction) -> Self {
        let model = SensorModel::new(model, ring, 0.1).unwrap();
        let grid = Grid::new(Point2::new(-2.0, -1.5), 0.1, 40, 30).unwrap();
        let mut map = CoverageMap::new(grid, model.parameters().bins).unwrap();
        let mut cache = GainCache::new(&model, 0.0, grid, prediction, Upkeep::Kept).unwrap();
        for change in integrate_body(&mut map, Point2::origin(), Point2::origin(), 0.27) {
            cache.update(&map, change.cell);
        }
        let mut setting = Self { model, prediction, map, cache };
        setting.set_novelties();
        setting
    }

    fn set_novelties(&mut self) {
        for index in 0..self.map.grid().len() {
            self.cache.set_novelty(index, self.novelty(index));
        }
    }

    /// Some view-points tell less that is new, as if the robot had been near; with the product
    /// every reading is new, everywhere.
    fn novelty(&self, view_point: usize) -> f64 {
        let shares = [1.0, 0.3, 1.0, 0.85, 0.0];
        if self.cache.tells_cells_apart() { shares[view_point / 3 % shares.len()] } else { 1.0 }
    }

    fn scan(&mut self, (x, y, ranges): &(f64, f64, Vec<Range>)) {
        let pose = Isometry2::translation(*x, *y);
        let scan = Scan { pose, time: 0.0, ranges: ranges.clone() };
        for change in integrate(&self.model, &mut self.map, &scan) {
            self.cache.update(&self.map, change.cell);
        }
    }

    fn all(&self) -> ViewPoints {
        ViewPoints::of(self.map.grid(), 0..self.map.grid().len())
    }

    /// Returns all gains of the cache.
    fn gains(&mut self) -> Vec<f64> {
        let all = self.all();
        self.cache.refresh_gains(&all);
        (0..self.map.grid().len()).map(|index| self.cache.gain(index)).collect()
    }

    /// Returns a cache that is told of the whole map at once.
    fn fresh(&self) -> Setting {
        let grid = *self.map.grid();
        let mut cache =
            GainCache::new(&self.model, 0.0, grid, self.prediction, Upkeep::Kept).unwrap();
        for cell in grid.cells() {
            cache.update(&self.map, cell);
        }
        let mut fresh = Self { model: self.model.clone(), map: self.map.clone(), cache, ..*self };
        fresh.set_novelties();
        fresh
    }
}

fn some_scans() -> impl Strategy<Value = Vec<(f64, f64, Vec<Range>)>> {
    let range = prop_oneof![
        5 => (0.2..2.0f64).prop_map(Range::Echo),
        1 => Just(Range::NoEcho),
        1 => Just(Range::Missing),
    ];
    let ranges = prop::collection::vec(range, 24);
    prop::collection::vec((-1.0..1.0f64, -0.7..0.7f64, ranges), 1..4)
}

/// Models of the update by cause that differ in all parameters that the fast evaluation uses.
fn some_causes() -> impl Strategy<Value = ModelParameters> {
    let free = (0.05..=1.0f64, 0.3..3.0f64, 0.3..9.0f64, 0.5..0.9f64);
    let answers = (1..=16usize, 0.3..2.0f64, 0.3..6.0f64, 0.0..6.0f64);
    let end = (0.005..0.08f64, 0.5..1.5f64, 0.0..0.1f64);
    let behind = (0.1..0.3f64, 0.05..=1.0f64, 0.6..2.0f64);
    let rest = (0.0..=1.0f64, 0.0..=1.0f64, prop_oneof![Just(0.0), 0.1..1.5f64], any::<bool>());
    let bins = prop::sample::select(vec![6, 11, 16]);
    (bins, free, answers, end, behind, rest).prop_map(|(bins, free, answers, end, behind, rest)| {
        let bin = 1.0 / (bins - 1) as f64;
        let cause = CauseParameters {
            bearings: answers.0,
            range_tolerance: end.0,
            cell_depth: end.1.max(0.8),
            unknown_coverage: rest.0,
            sharpness: answers.1,
            chance: answers.2,
            first_echo: answers.3,
            sigma_in: Linear { base: end.1 * bin, per_cell_distance: end.2, per_range: end.2 },
            behind: behind.0,
            behind_weight: behind.1,
            sigma_behind: behind.2 * bin,
            free: FreeSpace { share: free.0, range: free.1, width: free.2, sigma: free.3 * bin },
            beyond: 0.3,
            no_echo: NoEchoShare { range: rest.2, share: rest.1 },
            repeats: Repeats::NONE,
        };
        let half_angle = 0.13;
        let cones = FootprintRule::Cones { half_angle };
        let footprint = if rest.3 { cones } else { FootprintRule::Sectors { half_angle } };
        ModelParameters { bins, usable_range: 1.5, footprint, update: Update::Cause(cause) }
    })
}

/// Models that differ in all parameters that the fast evaluation uses.
fn some_models() -> impl Strategy<Value = ModelParameters> {
    let gamma = (0.02..0.4f64, 0.0..0.4f64, prop_oneof![Just(0.0), 0.0..0.3f64]);
    let evidence = (gamma, prop::sample::select(vec![0.0, 0.1, 0.15, 0.35]), 0.1..=1.0f64);
    let usable_range = prop::sample::select(vec![1.5, 1.5, 3.0, 4.05]);
    (evidence, prop_oneof![Just(0.0), 0.1..1.5f64], any::<bool>(), usable_range).prop_map(
        |(((base, per_cell_distance, per_range), behind, tempering), no_echo, cones, range)| {
            let by_hand = ModelParameters::by_hand();
            let half_angle = 0.13;
            ModelParameters {
                usable_range: range,
                footprint: if cones {
                    FootprintRule::Cones { half_angle }
                } else {
                    FootprintRule::Sectors { half_angle }
                },
                ..by_hand
            }
            .with_product(|product| {
                product.sigma_in = if range < 2.0 { product.sigma_in } else { 0.3 };
                product.gamma = Linear { base, per_cell_distance, per_range };
                product.behind = behind;
                product.tempering = tempering;
                product.no_echo.range = no_echo;
            })
        },
    )
}

/// Returns sensors around the robot at an `offset` from its centre \[m\].
fn ring(offset: f64) -> SonarRing {
    let beam = |i: u32| {
        let angle = 2.0 * PI * f64::from(i) / 24.0;
        let pose = Isometry2::rotation(angle) * Isometry2::translation(offset, 0.0);
        Beam { pose, half_angle: 0.13, min_range: 0.0, max_range: 5.0 }
    };
    SonarRing::new((0..24).map(beam).collect()).unwrap()
}

/// Compares some gains with the literal equations, and all with those of a fresh cache.
fn check(mut s: Setting, scans: Vec<(f64, f64, Vec<Range>)>) -> Result<(), TestCaseError> {
    for scan in scans {
        s.scan(&scan);
        let gains = s.gains();
        // Where less than a ten-thousandth of a nat is gained anywhere, rounding is what is left.
        let largest = gains.iter().map(|gain| gain.abs()).fold(1e-4, f64::max);
        for (index, gain) in gains.iter().enumerate().step_by(SAMPLED) {
            let cell = s.map.grid().cell(index);
            let stencil = s.cache.stencil();
            let prediction = RangePrediction { novelty: s.novelty(index), ..s.prediction };
            let exact = expected_information_gain(&s.map, &s.model, stencil, prediction, cell);
            let off = (gain - exact).abs();
            prop_assert!(off <= GAIN_TOLERANCE * largest, "{cell:?}: {gain} is not {exact}");
        }
        prop_assert_eq!(gains, s.fresh().gains());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn the_cached_gain_is_the_literal_one_for_all_predictions(
        scans in some_scans(), bins in prop::sample::select(vec![6, 11, 16, 33]),
        share in prop_oneof![3 => Just(0.0), 1 => 0.0..0.2f64],
        unknown in prop_oneof![Just(0.0), 0.0..0.5f64]
    ) {
        let mut model = ModelParameters { bins, usable_range: 1.5, ..ModelParameters::by_hand() };
        if bins < 11 {
            model = model.with_product(|product| {
                (product.sigma_out.base, product.sigma_in) = (0.12, 0.3);
            });
        }
        let prediction = RangePrediction { gain: InformationGain::Eq14, unknown_reflection: unknown, uniform_share: share, novelty: 1.0 };
        check(Setting::new(&model, &SonarRing::b21r(), prediction), scans)?;
    }

    #[test]
    fn the_cached_gain_is_the_literal_one_for_all_models_and_rings(
        model in some_models(), scans in some_scans(),
        offset in prop::sample::select(vec![0.0, 0.05, 0.1, 0.2])
    ) {
        // With an offset of half a cell there are cells exactly where two rings meet.
        check(Setting::new(&model, &ring(offset), PLAIN), scans)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_cached_gain_is_the_literal_one_for_all_causes_and_rings(
        model in some_causes(), scans in some_scans(),
        offset in prop::sample::select(vec![0.0, 0.05, 0.1, 0.2]),
        share in prop_oneof![3 => Just(0.0), 1 => 0.0..0.2f64],
        unknown in prop_oneof![Just(0.0), 0.0..0.5f64]
    ) {
        let prediction = RangePrediction { gain: InformationGain::Eq14, unknown_reflection: unknown, uniform_share: share, novelty: 1.0 };
        check(Setting::new(&model, &ring(offset), prediction), scans)?;
    }

    #[test]
    fn mutual_information_is_the_literal_one_and_never_negative(
        model in some_causes(), scans in some_scans(), share in prop_oneof![Just(0.0), 0.0..0.2f64]
    ) {
        let gain = InformationGain::MutualInformation;
        let prediction = RangePrediction { gain, unknown_reflection: 0.0, uniform_share: share, novelty: 1.0 };
        let mut s = Setting::new(&model, &SonarRing::b21r(), prediction);
        scans.iter().for_each(|scan| s.scan(scan));
        let gains = s.gains();
        let largest = gains.iter().copied().fold(1e-4, f64::max);
        prop_assert!(gains.iter().all(|gain| *gain >= -GAIN_TOLERANCE * largest));
        check(s, scans)?;
    }

    #[test]
    fn the_cached_gain_is_the_literal_one_by_cause_by_default(scans in some_scans()) {
        let model = ModelParameters { usable_range: 1.5, ..ModelParameters::b21r() };
        check(Setting::new(&model, &SonarRing::b21r(), PLAIN), scans)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn what_cells_promise_is_what_the_literal_equations_expect(
        model in some_causes(), scans in some_scans(), least in 0.001..0.3f64
    ) {
        let mut s = Setting::new(&model, &SonarRing::b21r(), PLAIN);
        s.cache = s.cache.with_least_change(least);
        scans.iter().for_each(|scan| s.scan(scan));
        let grid = *s.map.grid();
        let limit = |index: usize| [0.0, 0.6, 3.0][index % 3];
        (0..grid.len()).for_each(|index| s.cache.set_limit(index, limit(index)));
        s.cache.refresh_bounds(&s.all());
        let bounds: Vec<f64> = (0..grid.len()).map(|index| s.cache.promise(index)).collect();
        s.gains();
        let mut largest = vec![f64::NEG_INFINITY; grid.len()];
        let sampled: Vec<usize> = (0..grid.len()).step_by(SAMPLED).collect();
        for &index in &sampled {
            let (at, stencil) = (grid.cell(index), s.cache.stencil());
            let prediction = RangePrediction { novelty: s.novelty(index), ..PLAIN };
            let (mut promise, mut doubtful) = (0.0, false);
            for beam in &stencil.beams {
                let changes = expected_changes(&s.map, &s.model, stencil, beam, prediction, at);
                for (met, change) in beam.cells.iter().zip(changes) {
                    let Some(cell) = grid.index(at.offset(met.dx, met.dy)) else { continue };
                    largest[cell] = largest[cell].max(change);
                    if met.cell_distance < f64::from(limit(cell)) - 1e-6 {
                        promise += if change >= least { change } else { 0.0 };
                        doubtful |= (change - least).abs() < 1e-4;
                    }
                }
            }
            let found = s.cache.promise(index);
            prop_assert!(doubtful || (found - promise).abs() < 1e-3, "{found} {promise}");
            prop_assert!(found <= bounds[index] + 1e-3, "{found} {}", bounds[index]);
        }
        let asked = ViewPoints::of(&grid, sampled.iter().copied());
        for (found, expected) in s.cache.largest_changes(&asked).iter().zip(&largest) {
            let found = found.map_or(f64::NEG_INFINITY, |(change, _)| change);
            prop_assert!(found == *expected || (found - expected).abs() < 1e-4, "{found} {expected}");
        }
    }
}

#[test]
fn beams_of_too_many_cells_are_refused() {
    let refused = |r: f64| {
        let model = SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), r).unwrap();
        let grid = Grid::new(Point2::origin(), r, 4, 4).unwrap();
        GainCache::new(&model, 0.0, grid, PLAIN, Upkeep::OnDemand).map(|_| ()).unwrap_err()
    };
    assert!(matches!(refused(0.001), BeamError::TooLong(cells) if cells > 3000.0));
    assert!(matches!(refused(0.0035), BeamError::TooFine(cells) if cells > 65_534));
}
