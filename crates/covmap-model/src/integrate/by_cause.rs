//! The update by cause of a whole scan: the causes of all its beams by the map before it.

use crate::cause::{Clues, Met};
use crate::{CauseParameters, Causes, Outcome, SensorModel};
use covmap::{CoverageMap, Grid};
use covmap_sonar::Scan;

/// Returns the meaning of every beam's reading and its causes by the map as it is, or `None` for a
/// reading that says nothing. The map before the scan explains all beams, so that their order does
/// not matter. `novelty` has a number for each reading.
pub(crate) fn explain(
    model: &SensorModel,
    parameters: &CauseParameters,
    map: &CoverageMap,
    (scan, novelty): (&Scan, &[f64]),
) -> Vec<Option<(Outcome, Causes)>> {
    let cause = |(beam, range): (usize, &covmap_sonar::Range)| {
        let outcome = model.outcome(*range)?;
        let causes = explain_beam(model, parameters, map, scan, beam, outcome);
        Some((outcome, causes.by_as_much(novelty[beam])))
    };
    scan.ranges.iter().enumerate().map(cause).collect()
}

fn explain_beam(
    model: &SensorModel,
    parameters: &CauseParameters,
    map: &CoverageMap,
    scan: &Scan,
    beam: usize,
    outcome: Outcome,
) -> Causes {
    let grid: &Grid = map.grid();
    let (end, reach) = match outcome {
        Outcome::Echo(d) => (d, d + 0.5 * model.resolution() + parameters.range_tolerance),
        _ => (f64::INFINITY, model.reach(outcome)),
    };
    let mut clues = Clues::new(parameters, model.resolution(), end);
    model.footprint().for_each_cell(grid, &scan.pose, beam, reach, |covered| {
        let expected = map.is_known(covered.cell).then(|| map.mean(covered.cell));
        clues.add(Met { cell_distance: covered.cell_distance, across: covered.across }, expected);
    });
    clues.of(outcome)
}
