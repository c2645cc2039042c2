//! A map in which only one cell can gain anything, and only one beam sees it.
//!
//! All other cells are free for good, and reflect nothing. Therefore no echo is the only outcome,
//! the sum of Eq. (14) has one term, and the evaluator's answer is the gain of this cell by one
//! share of "passed". This measures the evaluator's treatment of a share from outside, as it is.

use crate::error::{PaperError, Result};
use covmap::{CoverageMap, Grid};
use covmap_gain::{
    GainCache, RangePrediction, Stencil, Upkeep, ViewPoints, expected_information_gain,
};
use covmap_lab::Config;
use covmap_model::{ModelParameters, SensorModel};
use covmap_sonar::SonarRing;
use nalgebra::Point2;

/// No echo is the only outcome.
const PREDICTION: RangePrediction = RangePrediction {
    gain: covmap_gain::InformationGain::Eq14,
    unknown_reflection: 0.0,
    uniform_share: 0.0,
    novelty: 1.0,
};

/// A histogram with its name.
#[derive(Debug, Clone)]
pub(super) struct Kind {
    pub(super) name: &'static str,
    /// The evidence of a cell; `None` for a cell that no reading touched.
    evidence: Option<Vec<f64>>,
}

/// The gain of a cell by a share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gained {
    /// The share x.
    pub(super) share: f64,
    /// The gain by the equations as printed, and by the evaluator \[nats\].
    pub(super) literal: f64,
    pub(super) fast: f64,
}

/// Returns three kinds of cells: untouched, nearly free, and either free or covered.
///
/// All are most likely free, or unknown: nothing reflects.
pub(super) fn kinds(bins: usize) -> Vec<Kind> {
    let peak = |center: f64, bin: usize| {
        let z = (covmap::bin_coverage(bin, bins) - center) / 0.12;
        libm::exp(-0.5 * z * z)
    };
    let of = |weight: &dyn Fn(usize) -> f64| Some((0..bins).map(weight).collect());
    vec![
        Kind { name: "untouched", evidence: None },
        Kind { name: "nearly free", evidence: of(&|bin| peak(0.0, bin) + 0.03) },
        Kind {
            name: "free or covered",
            evidence: of(&|bin| peak(0.0, bin) + 0.8 * peak(1.0, bin) + 0.01),
        },
    ]
}

/// Returns the gains of a kind of cell by `samples` shares above 0.
///
/// The largest share is the largest that the evaluator is made for, apart from the cell's distance
/// from the sensor.
pub(super) fn gains(config: &Config, kind: &Kind, samples: usize) -> Result<Vec<Gained>> {
    let (ring, _) = config.build()?;
    let cause = config
        .model
        .update
        .cause()
        .ok_or(PaperError::Missing("it has no shares but with the cause"))?;
    let all = f64::from(u32::try_from(cause.bearings)?);
    let largest = all / (all + cause.chance);
    let sample = |i: usize| {
        let part = f64::from(u32::try_from(i).unwrap_or(0)) / f64::from(u32::try_from(samples)?);
        sample(config, &ring, kind, part * largest)
    };
    (1..=samples).map(sample).collect()
}

/// Returns the gains of a kind of cell by the shares at which the evaluator interpolates.
pub(super) fn at_nodes(config: &Config, kind: &Kind) -> Result<Vec<Gained>> {
    let (ring, _) = config.build()?;
    let model = SensorModel::new(&config.model, &ring, config.resolution)?;
    let grid = Grid::new(Point2::origin(), config.resolution, 1, 1)?;
    let nodes = GainCache::new(&model, 0.0, grid, PREDICTION, Upkeep::OnDemand)?;
    let most = config
        .model
        .update
        .cause()
        .ok_or(PaperError::Missing("it has no shares but with the cause"))?
        .free
        .share;
    let of_share = |share: f64| sample(config, &ring, kind, share / most);
    nodes.interpolated_shares().into_iter().map(of_share).collect()
}

/// Returns the gain by one share: ν of a model without an echo sets the share of "passed".
fn sample(config: &Config, ring: &SonarRing, kind: &Kind, share: f64) -> Result<Gained> {
    let r = config.resolution;
    let parameters: ModelParameters = config.model.clone().with_cause(|cause| {
        cause.no_echo.share = share;
        cause.no_echo.range = config.model.usable_range;
    });
    let model = SensorModel::new(&parameters, ring, r)?;
    let cause = parameters.update.cause().ok_or(PaperError::Missing("by cause"))?;
    let stencil = Stencil::new(&model, 0.0);
    // The cell of the first beam with the largest share of "passed".
    let said = |i: &usize| cause.passed(stencil.beams[0].cells[*i].met());
    let cells = 0..stencil.beams[0].cells.len();
    let seen = cells
        .max_by(|a, b| said(a).total_cmp(&said(b)))
        .ok_or(PaperError::Missing("a beam without cells"))?;
    let met = stencil.beams[0].cells[seen];
    let half = f64::from(stencil.radius.min(8)) + 0.5;
    let side = usize::try_from(2 * stencil.radius.min(8) + 1)?;
    let grid = Grid::new(Point2::new(-half * r, -half * r), r, side, side)?;
    let home = grid.cell_at(Point2::origin()).ok_or(PaperError::Missing("a view-point"))?;
    let target = home.offset(met.dx, met.dy);
    let mut map = CoverageMap::new(grid, parameters.bins)?;
    for cell in grid.cells().filter(|cell| *cell != target) {
        map.pin_free(cell);
    }
    if let Some(evidence) = &kind.evidence {
        map.multiply(target, evidence);
    }
    let mut cache = GainCache::new(&model, 0.0, grid, PREDICTION, Upkeep::OnDemand)?;
    for cell in grid.cells() {
        cache.update(&map, cell);
    }
    let index = grid.index(home).ok_or(PaperError::Missing("a view-point"))?;
    cache.refresh_gains(&ViewPoints::one(&grid, index));
    let beams = f64::from(u32::try_from(stencil.beams.len())?);
    let literal = expected_information_gain(&map, &model, &stencil, PREDICTION, home);
    Ok(Gained {
        share: said(&seen) * share,
        literal: beams * literal,
        fast: beams * cache.gain(index),
    })
}
