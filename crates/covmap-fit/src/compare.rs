//! The comparison: methods tuned on some examples, measured on others.

mod blocks;
mod calibration;

pub use blocks::trajectory_blocks;
pub use calibration::{CALIBRATION_LEVELS, CalibrationTable};

use crate::example::truths;
use crate::{ByClass, Class, ClassScore, Example, Method, Weighting};
use blocks::resamples;
use covmap_model::ModelError;
use covmap_statistics::{central_interval, randomised_pit};
use rayon::prelude::*;
use serde::Serialize;

/// A method with its name, ready to be compared: tuned, if it is to be.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contender {
    /// Its name in the rows.
    pub name: String,
    /// The method whose posteriors count as they are.
    pub raw: Method,
    /// The method whose posteriors go through the table: the same, or one that was tuned for it.
    /// Parameters that make the best of raw posteriors, by leaving walls unknown rather than being
    /// too certain of them, need not tell the table most.
    pub calibrated: Method,
}

/// Settings of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonSettings {
    /// Weighting of the cells in the objective of a row.
    pub weighting: Weighting,
    /// Number of blocks of each trajectory.
    pub blocks: usize,
    /// Number of resamples of the blocks.
    pub resamples: usize,
    /// The contender to which the others are compared, cell by cell; raw to raw, calibrated
    /// to calibrated.
    pub reference: usize,
}

impl Default for ComparisonSettings {
    /// Classes alike, 10 blocks a trajectory, 1000 resamples; compared to the first.
    fn default() -> Self {
        Self { weighting: Weighting::Classes, blocks: 10, resamples: 1000, reference: 0 }
    }
}

/// A mean over cells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct CellMean {
    /// The mean; 0 if there are no such cells.
    pub value: f64,
    /// Its 95 % interval by resampling blocks of the trajectories; `None` if fewer than two
    /// blocks have such cells.
    pub interval: Option<(f64, f64)>,
    /// This method − the reference on the same cells; `None` for the reference itself.
    pub difference: Option<Difference>,
}

/// A mean of paired differences over cells.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Difference {
    /// The mean.
    pub value: f64,
    /// Its 95 % interval, from the same resamples for both methods.
    pub interval: Option<(f64, f64)>,
}

/// Scores of a method on the cells of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ClassComparison {
    /// Number of cells.
    pub cells: usize,
    /// Mean log-likelihood of the truth, with the floor of `covmap` \[nats\].
    pub log_likelihood: CellMean,
    /// Mean continuous ranked probability score.
    pub crps: CellMean,
    /// Mean absolute error of the expected coverage.
    pub error: CellMean,
    /// The share of cells whose randomised probability integral transform lies in the central half,
    /// \[.25, .75\]: ½ for a calibrated method, over all cells. (Within a class even the true
    /// posterior need not meet it: the truth chooses the class. And mass at both ends puts every
    /// partial truth in the middle: compare it with the CRPS.)
    pub central_50: CellMean,
    /// The same share for \[.05, .95\], and .9 for a calibrated method.
    pub central_90: CellMean,
}

/// One method, raw or calibrated, on the test examples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparisonRow {
    /// The contender's name.
    pub name: String,
    /// Whether its output went through the calibration table of the training examples.
    pub calibrated: bool,
    /// Mean log-likelihood by the settings' weighting \[nats\].
    pub objective: CellMean,
    /// Scores of all cells and of each class.
    pub classes: ByClass<ClassComparison>,
}

/// Compares methods on `test`, with calibration tables from `training`: for every contender,
/// in their order, a raw row and a calibrated one.
///
/// `uniform` draws uniform numbers in \[0, 1): first two for every cell of `test`, which
/// randomise its transform alike for all methods, then the blocks of all resamples, which
/// are the same for all methods too. Methods are evaluated in parallel; the result is a
/// function of the arguments.
///
/// # Errors
/// If a parameter of a method is out of its interval or does not fit an example.
///
/// # Panics
/// If a scan does not fit the ring of its example.
pub fn compare(
    contenders: &[Contender],
    training: &[Example],
    test: &[Example],
    settings: &ComparisonSettings,
    mut uniform: impl FnMut() -> f64,
) -> Result<Vec<ComparisonRow>, ModelError> {
    let cells = TestCells::new(test, settings.blocks, &mut uniform);
    let resamples = resamples(cells.blocks, settings.resamples, &mut uniform);
    let both = |contender: &Contender| -> Result<[Vec<Sums>; 2], ModelError> {
        let raw = cells.sums(&contender.raw.posteriors_of(test)?, |p| p);
        let table = table(&contender.calibrated, training)?;
        let posteriors = contender.calibrated.posteriors_of(test)?;
        Ok([raw, cells.sums(&posteriors, |p| table.apply(p))])
    };
    let sums: Vec<[Vec<Sums>; 2]> = contenders.par_iter().map(both).collect::<Result<_, _>>()?;
    let rows = contenders.iter().enumerate().flat_map(|(i, contender)| {
        let row = |calibrated: bool| {
            let own = &sums[i][usize::from(calibrated)];
            let reference = sums.get(settings.reference).filter(|_| i != settings.reference);
            let estimates = CellMeans {
                own,
                reference: reference.map(|sums| &sums[usize::from(calibrated)][..]),
                resamples: &resamples,
            };
            estimates.row(&contender.name, calibrated, settings.weighting)
        };
        [false, true].map(row)
    });
    Ok(rows.collect())
}

/// Returns the calibration table of a method from training examples.
///
/// # Errors
/// If a parameter is out of its interval or does not fit an example.
///
/// # Panics
/// If a scan does not fit the ring of its example.
pub fn table(method: &Method, training: &[Example]) -> Result<CalibrationTable, ModelError> {
    Ok(table_of(&method.posteriors_of(training)?, training, method.model.bins))
}

/// Returns the calibration table of the posteriors of some examples.
pub(crate) fn table_of(
    posteriors: &[Vec<Vec<f64>>],
    examples: &[Example],
    bins: usize,
) -> CalibrationTable {
    let cells = posteriors.iter().flatten().map(Vec::as_slice);
    CalibrationTable::fit(cells.zip(truths(examples)), bins)
}

/// A cell of the test examples.
struct TestCell {
    truth: f64,
    /// Index among the blocks of all examples.
    block: usize,
    /// Random numbers of the transform.
    chance: (f64, f64),
}

struct TestCells {
    cells: Vec<TestCell>,
    /// The number of blocks with cells.
    blocks: usize,
}

/// The measures of a cell: log-likelihood, CRPS, error, in the central half, in the central
/// nine tenths.
const MEASURES: usize = 5;
const LOG_LIKELIHOOD: usize = 0;

/// The sum of each measure over the cells of a block, and their number.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    cells: usize,
    measures: [f64; MEASURES],
}

impl Sum {
    fn add(&mut self, measures: [f64; MEASURES]) {
        self.cells += 1;
        self.measures.iter_mut().zip(measures).for_each(|(sum, value)| *sum += value);
    }
}

/// The sums of a block for all cells and for each class.
type Sums = ByClass<Sum>;

impl TestCells {
    fn new(test: &[Example], blocks: usize, uniform: &mut impl FnMut() -> f64) -> Self {
        let mut cells = Vec::new();
        for (i, example) in test.iter().enumerate() {
            let of_cells = trajectory_blocks(example, blocks);
            for ((_, truth), block) in example.truth.iter().zip(of_cells) {
                let block = i * blocks.max(1) + block;
                cells.push(TestCell { truth: *truth, block, chance: (uniform(), uniform()) });
            }
        }
        // Blocks without cells do not count.
        let mut used: Vec<usize> = cells.iter().map(|cell| cell.block).collect();
        used.sort_unstable();
        used.dedup();
        for cell in &mut cells {
            cell.block = used.partition_point(|block| *block < cell.block);
        }
        Self { cells, blocks: used.len() }
    }

    /// Returns the sums of every block, of the `output` for each posterior.
    fn sums<'a>(
        &self,
        posteriors: &'a [Vec<Vec<f64>>],
        output: impl Fn(&'a [f64]) -> &'a [f64],
    ) -> Vec<Sums> {
        let mut sums = vec![Sums::default(); self.blocks];
        for (cell, posterior) in self.cells.iter().zip(posteriors.iter().flatten()) {
            let p = output(posterior);
            let pit = randomised_pit(p, cell.truth, cell.chance.0, cell.chance.1);
            let central = |level: f64| f64::from(u8::from((pit - 0.5).abs() <= 0.5 * level));
            let score = ClassScore::of_cell(p, cell.truth);
            let measures =
                [score.log_likelihood, score.crps, score.error, central(0.5), central(0.9)];
            let block = &mut sums[cell.block];
            block.of_class_mut(Class::of(cell.truth)).add(measures);
            block.all.add(measures);
        }
        sums
    }
}

/// The data of the estimates of a row: sums of every block of one method and of the reference, and
/// the number of draws of each block.
struct CellMeans<'a> {
    own: &'a [Sums],
    reference: Option<&'a [Sums]>,
    resamples: &'a [Vec<f64>],
}

impl CellMeans<'_> {
    fn row(&self, name: &str, calibrated: bool, weighting: Weighting) -> ComparisonRow {
        let objective = self.estimate(self.own.len() >= 2, |sums, drawn| {
            let is_there = |class| sums.iter().any(|s| s.get(Some(class)).cells > 0);
            weighting.mean(is_there, |class| average(sums, drawn, class, LOG_LIKELIHOOD))
        });
        let classes = ByClass::from_fn(|class| {
            let estimate = |measure: usize| {
                let with = self.own.iter().filter(|sums| sums.get(class).cells > 0).count();
                self.estimate(with >= 2, |sums, drawn| average(sums, drawn, class, measure))
            };
            ClassComparison {
                cells: self.own.iter().map(|sums| sums.get(class).cells).sum(),
                log_likelihood: estimate(LOG_LIKELIHOOD),
                crps: estimate(1),
                error: estimate(2),
                central_50: estimate(3),
                central_90: estimate(4),
            }
        });
        ComparisonRow { name: name.to_owned(), calibrated, objective, classes }
    }

    /// Returns an estimate, without intervals if there are not enough blocks.
    fn estimate(
        &self,
        enough: bool,
        of: impl Fn(&[Sums], Option<&[f64]>) -> Option<f64>,
    ) -> CellMean {
        let interval = |of: &dyn Fn(Option<&[f64]>) -> Option<f64>| {
            let values = self.resamples.iter().map(|drawn| of(Some(drawn)));
            if enough { central_interval(values) } else { None }
        };
        let own = |drawn: Option<&[f64]>| of(self.own, drawn);
        let difference = self.reference.and_then(|reference| {
            let difference =
                |drawn: Option<&[f64]>| Some(of(self.own, drawn)? - of(reference, drawn)?);
            Some(Difference { value: difference(None)?, interval: interval(&difference) })
        });
        CellMean { value: own(None).unwrap_or(0.0), interval: interval(&own), difference }
    }
}

/// Returns the mean of a measure over the cells of a class, blocks counted as often as they are
/// drawn; `None` if no such cell is drawn.
fn average(
    sums: &[Sums],
    drawn: Option<&[f64]>,
    class: Option<Class>,
    measure: usize,
) -> Option<f64> {
    let (mut cells, mut total) = (0.0, 0.0);
    for (block, sums) in sums.iter().enumerate() {
        let times = drawn.map_or(1.0, |drawn| drawn[block]);
        let sum = sums.get(class);
        let count = sum.cells as f64;
        cells += times * count;
        total += times * sum.measures[measure];
    }
    (cells > 0.0).then(|| total / cells)
}
