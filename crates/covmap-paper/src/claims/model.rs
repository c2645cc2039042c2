//! Sections 2 and 3: maps of partly covered cells, and the sensor model. Claims 1–4 and 21.

use crate::echo::{RANGE, column};
use crate::fitting::Fitting;
use crate::oblique::Oblique;
use crate::partial_cells::{COVERAGE, FIG_2, MEASUREMENTS, PartialCell};
use crate::trial::{Bound, Finding, Trial};
use covmap::{Histogram, bin_coverage};
use covmap_model::SensorModel;
use covmap_statistics::{Estimate, share_estimate};

/// The smallest share of the seeds in which a claim must hold.
const MOST_SEEDS: f64 = 0.9;

/// The case that decides: the slab at the far side of the cell, where Eq. (10) implies a coverage
/// of .2.
const DECIDING: char = 'a';

/// Tests claim 1 (Fig. 1): occupancy goes to 1 while coverage stays at .2.
///
/// The case of Eq. (10) decides; the other ways to cover the cell are figures.
pub fn claim_1(cells: &[PartialCell]) -> Finding {
    let (deciding, others): (Vec<_>, Vec<_>) = cells.iter().partition(|cell| cell.case == DECIDING);
    let mut trials: Vec<Trial> = deciding
        .into_iter()
        .flat_map(fig_1)
        .map(|(what, share)| Trial::new(what, share, Bound::Above(MOST_SEEDS)))
        .collect();
    if trials.is_empty() {
        trials.push(Trial::new("share of seeds", None, Bound::Above(MOST_SEEDS)));
    }
    let finding = Finding::new(
        1,
        "Fig. 1: a cell that is covered 20 %, by a slab at the far side, detected again and again: its occupancy exceeds .99, its most likely coverage is .2",
        trials,
    );
    let figures = others.into_iter().flat_map(fig_1);
    figures.fold(finding, |finding, (what, share)| finding.figure(&what, share))
}

/// Returns the shares of the seeds in which each half of Fig. 1 holds, for one way to cover the
/// cell.
fn fig_1(cell: &PartialCell) -> [(String, Option<Estimate>); 2] {
    let last = MEASUREMENTS - 1;
    let name = format!("({}) {}: share of seeds (Agresti–Coull)", cell.case, cell.what);
    let occupied = share(cell, |series| series.occupancy[last] > 0.99);
    let right = share(cell, |series| (series.mode[last] - COVERAGE).abs() < 1e-6);
    [
        (format!("{name} with an occupancy > .99"), occupied),
        (format!("{name} whose most likely coverage is .2"), right),
    ]
}

/// Tests claim 2 (Fig. 2): the posterior of that cell has one peak, near .2.
pub fn claim_2(cells: &[PartialCell]) -> Finding {
    let statement = "Fig. 2: after 30 measurements the posterior of that cell has one peak, at .2 ± .1, in at least 90 % of the seeds";
    let peaked = |cell: &PartialCell| {
        share(
            cell,
            |s| matches!(peaks(&s.posterior)[..], [at] if (at - COVERAGE).abs() < 0.1 + 1e-6),
        )
    };
    let what = format!(
        "(a), the case of Eq. 10: share of seeds (Agresti–Coull) with one peak there after {FIG_2}"
    );
    let trial = Trial::new(what, cells.first().and_then(peaked), Bound::Above(MOST_SEEDS));
    let finding = Finding::new(2, statement, vec![trial]);
    cells.iter().skip(1).fold(finding, |finding, cell| {
        finding.figure(&format!("({}) {}", cell.case, cell.what), peaked(cell))
    })
}

fn share(
    cell: &PartialCell,
    is: impl Fn(&crate::partial_cells::Series) -> bool,
) -> Option<Estimate> {
    let seeds = cell.series.len();
    share_estimate(cell.series.iter().filter(|series| is(series)).count(), seeds)
}

/// Returns the coverages of the peaks of a posterior.
///
/// A peak is a bin, or a run of equal bins (its first bin counts), that is above its neighbours and
/// holds at least 1 %.
fn peaks(posterior: &[f64]) -> Vec<f64> {
    let bins = posterior.len();
    let (mut peaks, mut first) = (Vec::new(), 0);
    for run in posterior.chunk_by(|a, b| a.total_cmp(b).is_eq()) {
        let next = first + run.len();
        let beside = |bin: Option<usize>| bin.and_then(|b| posterior.get(b)).copied();
        let lower = |bin| beside(bin).is_none_or(|p| p < run[0]);
        if run[0] >= 0.01 && lower(first.checked_sub(1)) && lower(Some(next)) {
            peaks.push(bin_coverage(first, bins));
        }
        first = next;
    }
    peaks
}

/// Tests claim 3 (Fig. 3): mass near 0 in front, near 1 just behind, broadest in the end cell.
pub fn claim_3(model: &SensorModel) -> Finding {
    let r = model.resolution();
    let front = (1..).map(|i| f64::from(i) * r).take_while(|d| *d < RANGE - r);
    let behind = [RANGE + 0.6 * r, RANGE + r];
    let near = |distance: f64, to: f64| {
        let column = column(model, distance);
        let bins = column.len();
        let mass = (0..bins).filter(|b| (bin_coverage(*b, bins) - to).abs() < 0.3);
        mass.map(|bin| column[bin]).sum::<f64>()
    };
    let entropy = |distance: f64| {
        Histogram::from_weights(&column(model, distance)).map_or(0.0, |column| column.entropy())
    };
    let all_front: Vec<f64> = front.collect();
    let outside = all_front.iter().chain(&behind);
    let widest = outside.map(|d| entropy(*d)).fold(0.0, f64::max);
    Finding::new(
        3,
        "Fig. 3 (d = 1 m): mass near 0 in front, near 1 just behind, broadest in the end cell",
        vec![
            Trial::fact(
                "in front, more than half of the mass lies below a coverage of .3",
                all_front.iter().all(|d| near(*d, 0.0) > 0.5),
            ),
            Trial::fact(
                "just behind, more than half of the mass lies above .7",
                behind.iter().all(|d| near(*d, 1.0) > 0.5),
            ),
            Trial::fact(
                "the entropy is largest in the cell in which the measurement ends",
                entropy(RANGE) > widest,
            ),
        ],
    )
    .note(format!(
        "entropy in the end cell {:.3}, elsewhere at most {widest:.3} nats",
        entropy(RANGE)
    ))
}

/// Tests claim 4 (section 3): fitted parameters explain the truth better than unfitted ones.
pub fn claim_4(fitting: &Fitting) -> Finding {
    let trial = Trial::new(
        "mean difference of the log-likelihood of a cell on held-out worlds, by scenarios, fitted − unfitted [nats]",
        fitting.mean_difference(),
        Bound::Above(0.0),
    );
    let (worlds, scenarios) = (fitting.worlds(), fitting.by_scenario.len());
    let enough = Trial::condition(
        format!(
            "condition: held-out worlds of at least 6 scenarios ({worlds}, of {scenarios} scenarios)"
        ),
        scenarios >= 6,
    );
    Finding::new(
        4,
        "section 3: fitted parameters explain the truth better than unfitted ones, on held-out worlds of at least six scenarios",
        vec![enough, trial],
    )
    .note(fitting.what.clone())
}

/// Tests claim 21 (section 2): on the cells of an oblique wall, occupancy goes to 1, and coverage
/// is nearer to the truth.
pub fn claim_21(oblique: &Oblique) -> Finding {
    Finding::new(
        21,
        "section 2: on the cells of an oblique wall the occupancy goes to 1, and the coverage is closer to the truth",
        vec![
            Trial::new(
                "mean occupancy of the partly covered cells",
                oblique.0.mean(Oblique::OCCUPANCY),
                Bound::Above(0.9),
            ),
            Trial::new(
                "mean absolute error of the coverage less that of the occupancy",
                oblique.0.difference(Oblique::COVERAGE_ERROR, Oblique::OCCUPANCY_ERROR),
                Bound::Below(0.0),
            ),
        ],
    )
    .figure("error of the expected coverage", oblique.0.mean(Oblique::COVERAGE_ERROR))
    .figure("error of the occupancy", oblique.0.mean(Oblique::OCCUPANCY_ERROR))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::partial_cells::Series;
    use crate::runs::Units;
    use crate::trial::{Verdict, check};
    use covmap_model::{ModelParameters, ProductParameters};
    use covmap_sonar::SonarRing;

    fn cell(good: usize, of: usize, peak: usize) -> PartialCell {
        let series = |right: bool| Series {
            occupancy: vec![1.0; MEASUREMENTS],
            mode: vec![if right { 0.2 } else { 0.5 }; MEASUREMENTS],
            posterior: (0..11)
                .map(|b| if b == if right { peak } else { 7 } { 0.9 } else { 0.01 })
                .collect(),
        };
        let series = (0..of).map(|seed| series(seed < good)).collect();
        PartialCell { case: 'a', what: "a slab", series }
    }

    #[test]
    fn claims_1_and_2_count_seeds() {
        check(claim_1(&[cell(100, 100, 2)]), Verdict::Reproduced);
        check(claim_1(&[cell(100, 100, 2), cell(10, 100, 2)]), Verdict::NotReproduced);
        check(claim_1(&[cell(5, 5, 2)]), Verdict::Undecided);
        check(claim_2(&[cell(100, 100, 3)]), Verdict::Reproduced);
        check(claim_2(&[cell(100, 100, 4)]), Verdict::NotReproduced);
        check(claim_2(&[cell(89, 100, 2)]), Verdict::Undecided);
    }

    #[test]
    fn two_peaks_are_not_one() {
        assert_eq!(peaks(&[0.1, 0.2, 0.1, 0.5, 0.1]).len(), 2);
        assert_eq!(peaks(&[0.0, 0.4, 0.4, 0.2]).len(), 1);
    }

    #[test]
    fn claim_3_looks_at_the_model() {
        let model = |change: fn(&mut ProductParameters)| {
            let parameters = ModelParameters::product().with_product(|product| {
                product.tempering = 1.0;
                product.behind = 0.2;
                change(product);
            });
            SensorModel::new(&parameters, &SonarRing::b21r(), 0.1).unwrap()
        };
        check(claim_3(&model(|_| ())), Verdict::Reproduced);
        check(claim_3(&model(|p| p.gamma.base = 50.0)), Verdict::NotReproduced);
    }

    #[test]
    fn claim_4_needs_eight_worlds() {
        let fitting = |differences: &[f64]| Fitting {
            by_scenario: differences.iter().map(|d| vec![*d]).collect(),
            what: String::new(),
        };
        let good = [0.1, 0.12, 0.09, 0.11, 0.1, 0.13, 0.08, 0.1];
        check(claim_4(&fitting(&good)), Verdict::Reproduced);
        check(claim_4(&fitting(&good.map(|d| -d))), Verdict::NotReproduced);
        check(claim_4(&fitting(&good[..4])), Verdict::Undecided);
    }

    #[test]
    fn poses_of_one_scenario_are_one_group_for_claim_4() {
        let by_scenario = |groups: &[&[f64]]| Fitting {
            by_scenario: groups.iter().map(|group| group.to_vec()).collect(),
            what: String::new(),
        };
        // There are eight worlds, but only two scenarios.
        let poses: &[f64] = &[0.1, 0.12, 0.09, 0.11];
        check(claim_4(&by_scenario(&[poses, poses])), Verdict::Undecided);
        let good: [&[f64]; 6] =
            [&[0.1, 0.12], &[0.09, 0.1], &[0.12, 0.11], &[0.1, 0.13], &[0.11], &[0.1]];
        check(claim_4(&by_scenario(&good)), Verdict::Reproduced);
        check(claim_4(&by_scenario(&good[..5])), Verdict::Undecided);
    }

    #[test]
    fn the_slab_at_the_far_side_decides_claim_1() {
        let other = PartialCell { case: 'b', what: "another slab", ..cell(0, 100, 2) };
        let finding = claim_1(&[cell(100, 100, 2), other.clone()]);
        assert_eq!((finding.trials.len(), finding.notes.len()), (2, 2));
        check(finding, Verdict::Reproduced);
        check(claim_1(&[other]), Verdict::Undecided);
    }

    #[test]
    fn claim_21_compares_errors() {
        let oblique = |occupancy: f64, coverage: f64| {
            let unit = |s: f64| vec![vec![occupancy + s, 0.4 + s, coverage + 2.0 * s]];
            Oblique(Units([0.0, 0.001, -0.001, 0.002].map(unit).to_vec()))
        };
        check(claim_21(&oblique(0.97, 0.2)), Verdict::Reproduced);
        check(claim_21(&oblique(0.97, 0.5)), Verdict::NotReproduced);
        check(claim_21(&oblique(0.97, 0.4)), Verdict::Undecided);
    }
}
