//! Resampling blocks of the trajectory: intervals that know that near cells err together.

use crate::Example;
use rayon::prelude::*;

/// The block of every cell of an example's truth, in its order, from 0 to below `blocks`:
/// the trajectory is cut into so many pieces of as many consecutive scans each, and a cell
/// belongs to the piece that has the pose nearest to its centre; of equally near ones, to the
/// first. Without scans all belong to block 0.
pub fn trajectory_blocks(example: &Example, blocks: usize) -> Vec<usize> {
    let scans = &example.scans;
    let block = |cell| {
        let center = example.grid.center(cell);
        let distance = |scan: &covmap_sonar::Scan| {
            (scan.pose.translation.vector - center.coords).norm_squared()
        };
        let nearest = scans.iter().map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map_or(0, |(scan, _)| scan * blocks.max(1) / scans.len())
    };
    example.truth.par_iter().map(|(cell, _)| block(*cell)).collect()
}

/// How often each block is drawn in each resample: as many draws with replacement as there
/// are blocks.
pub(crate) fn resamples(
    blocks: usize,
    times: usize,
    mut uniform: impl FnMut() -> f64,
) -> Vec<Vec<f64>> {
    let mut resample = || {
        let mut drawn = vec![0.0; blocks];
        for _ in 0..blocks {
            #[allow(clippy::cast_precision_loss, reason = "few blocks")]
            let place = uniform() * blocks as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few")]
            let block = place as usize;
            drawn[block.min(blocks - 1)] += 1.0;
        }
        drawn
    };
    (0..times).map(|_| resample()).collect()
}

/// The central 95 % interval of the values of resamples that have one; `None` if none has.
pub(crate) fn interval(values: impl Iterator<Item = Option<f64>>) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = values.flatten().filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let outside = values.len() / 40;
    let last = values.len().checked_sub(1)?;
    Some((values[outside], values[last - outside]))
}
