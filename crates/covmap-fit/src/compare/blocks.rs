//! Blocks of the trajectory, which are resampled: cells that are near each other err together.

use crate::Example;
use covmap_statistics::resample;
use rayon::prelude::*;

/// Returns the block of every cell of an example's truth, in its order, from 0 to below `blocks`.
///
/// The trajectory is cut into `blocks` pieces of equally many consecutive scans, and a cell belongs
/// to the piece that has the pose nearest to its centre; of equally near ones, to the first.
/// Without scans all cells belong to block 0.
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

/// Returns the number of draws of each block in each resample.
pub(crate) fn resamples(
    blocks: usize,
    times: usize,
    mut uniform: impl FnMut() -> f64,
) -> Vec<Vec<f64>> {
    let mut drawn = || {
        let mut counts = vec![0.0; blocks];
        resample(blocks, &mut uniform).into_iter().for_each(|block| counts[block] += 1.0);
        counts
    };
    (0..times).map(|_| drawn()).collect()
}
