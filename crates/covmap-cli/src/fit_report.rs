//! The report of a fit: the likelihood of the truth by the maps before, after, and through the
//! read-out.

use crate::terminal::say;
use anyhow::Result;
use covmap::{CoverageMap, ReadOut};
use covmap_fit::{
    Evaluation, Example, ExampleScore, Fitted, Profile, Reliability, Weighting, fit_read_out,
};
use covmap_model::{ModelError, ModelParameters};
use covmap_statistics::Spread;
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// The remark on a search that Ctrl-C ended.
pub(crate) const INTERRUPTED: &str = "; INTERRUPTED, the best that was found so far";

/// The scored cells of a map: posterior and truth.
type Cells = Vec<(Vec<f64>, f64)>;

/// The maps of an example.
pub(crate) struct Maps<'a> {
    example: &'a Example,
    before: CoverageMap,
    after: CoverageMap,
}

/// The content of `fit.json`.
#[derive(Serialize)]
pub(crate) struct Report<'a> {
    pub(crate) file: &'a Path,
    pub(crate) seed: u64,
    pub(crate) weighting: Weighting,
    /// Whether Ctrl-C ended the search early: the result is the best so far.
    pub(crate) interrupted: bool,
    pub(crate) training: Compared,
    pub(crate) held_out: Vec<Compared>,
    /// Differences of the objective on the held-out examples, after − before.
    pub(crate) held_out_difference: Option<Paired>,
    /// Differences of the objective on the held-out examples, read out − after.
    pub(crate) read_out_difference: Option<Paired>,
    /// Reliability of the fitted model on the held-out examples; on the training examples if there
    /// are none.
    pub(crate) reliability: Reliability,
    /// The same reliability through the read-out.
    pub(crate) reliability_read_out: Reliability,
    pub(crate) before: &'a ModelParameters,
    pub(crate) after: &'a ModelParameters,
    #[serde(skip)]
    pub(crate) read_out: ReadOut,
    pub(crate) path: &'a [Evaluation],
    pub(crate) profiles: &'a [Profile],
}

/// The scores of one example, or of all together: before and after the fit, and after it through
/// the read-out.
#[derive(Serialize)]
pub(crate) struct Compared {
    pub(crate) name: String,
    pub(crate) before: ExampleScore,
    pub(crate) after: ExampleScore,
    pub(crate) read_out: ExampleScore,
}

/// A mean of paired differences with its 95 % interval by Student's t.
#[derive(Serialize)]
pub(crate) struct Paired {
    pub(crate) n: usize,
    pub(crate) mean: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl<'a> Maps<'a> {
    /// Builds the maps of some examples with the parameters before and after a fit.
    pub(crate) fn of(
        examples: &'a [Example],
        (before, after): (&ModelParameters, &ModelParameters),
    ) -> Result<Vec<Self>, ModelError> {
        let maps = |example: &'a Example| {
            Ok(Self { example, before: example.map(before)?, after: example.map(after)? })
        };
        examples.par_iter().map(maps).collect()
    }

    fn after(&self) -> Cells {
        self.example.cells_of(&self.after)
    }

    fn read_by(&self, read_out: &ReadOut) -> Result<Cells> {
        Ok(self.example.cells_of(&self.after.read_by(read_out)?))
    }
}

/// Returns the read-out that best explains the truth of some examples.
pub(crate) fn read_out(training: &[Maps<'_>], bins: usize, weighting: Weighting) -> ReadOut {
    let cells: Cells = training.iter().flat_map(Maps::after).collect();
    fit_read_out(&cells, bins, weighting)
}

impl<'a> Report<'a> {
    /// Compares the maps before and after a fit, and through its read-out.
    pub(crate) fn new(
        (file, seed, weighting): (&'a Path, u64, Weighting),
        (before, fitted, interrupted): (&'a ModelParameters, &'a Fitted, bool),
        (training, held_out): (&[Maps<'_>], &[Maps<'_>]),
        read_out: ReadOut,
    ) -> Result<Self> {
        let each = |maps: &Maps<'_>| {
            Compared::new(maps.example.name.clone(), std::slice::from_ref(maps), &read_out)
        };
        let compared: Vec<Compared> = held_out.iter().map(each).collect::<Result<_>>()?;
        let checked = if held_out.is_empty() { training } else { held_out };
        let after: Cells = checked.iter().flat_map(Maps::after).collect();
        let read: Vec<Cells> =
            checked.iter().map(|maps| maps.read_by(&read_out)).collect::<Result<_>>()?;
        let paired = |of: fn(&Compared) -> (&ExampleScore, &ExampleScore)| {
            Paired::of(compared.iter().map(of), weighting)
        };
        Ok(Self {
            file,
            seed,
            weighting,
            interrupted,
            training: Compared::new("training".to_owned(), training, &read_out)?,
            held_out_difference: paired(|c| (&c.before, &c.after)),
            read_out_difference: paired(|c| (&c.after, &c.read_out)),
            held_out: compared,
            reliability: Reliability::of(&after),
            reliability_read_out: Reliability::of(read.iter().flatten()),
            before,
            after: &fitted.parameters,
            read_out,
            path: &fitted.path,
            profiles: &fitted.profiles,
        })
    }

    /// Describes the examples behind the reliability.
    pub(crate) fn checked_on(&self) -> String {
        match self.held_out.len() {
            0 => format!("training, {} cells", self.training.after.all.cells),
            n => {
                let cells: usize = self.held_out.iter().map(|c| c.after.all.cells).sum();
                format!("held out: {}, {cells} cells", of_examples(n))
            }
        }
    }

    /// Describes the origin of the fitted configuration.
    pub(crate) fn provenance(&self) -> String {
        let mean = |score: &ExampleScore| self.weighting.objective(score);
        let Compared { before, after, read_out, .. } = &self.training;
        let held_out = |what: &str, paired: &Option<Paired>| {
            paired.as_ref().map_or_else(String::new, |d| {
                format!(
                    "\nheld out, {what}: {:+.4}, 95 % interval [{:+.4}, {:+.4}] of {} examples",
                    d.mean, d.low, d.high, d.n
                )
            })
        };
        format!(
            "Fitted by `cargo xtask fit {}`, seed {}{}.\n\
             Mean log-likelihood of the true coverage of a cell, {} alike [nats]:\n\
             training {:.4} → {:.4}, through the read-out {:.4} ({} cells){}{}",
            self.file.display(),
            self.seed,
            if self.interrupted { INTERRUPTED } else { "" },
            match self.weighting {
                Weighting::Cells => "cells",
                Weighting::Classes => "classes",
            },
            mean(before),
            mean(after),
            mean(read_out),
            after.all.cells,
            held_out("fitted − begun with", &self.held_out_difference),
            held_out("through the read-out − fitted", &self.read_out_difference),
        )
    }
}

impl Compared {
    fn new(name: String, maps: &[Maps<'_>], read_out: &ReadOut) -> Result<Self> {
        let score =
            |cells: &[Cells]| ExampleScore::of(cells.iter().flatten().map(|(p, t)| (p, *t)));
        let before: Vec<Cells> = maps.iter().map(|m| m.example.cells_of(&m.before)).collect();
        let after: Vec<Cells> = maps.iter().map(Maps::after).collect();
        let read: Vec<Cells> = maps.iter().map(|m| m.read_by(read_out)).collect::<Result<_>>()?;
        Ok(Self { name, before: score(&before), after: score(&after), read_out: score(&read) })
    }
}

impl Paired {
    /// Returns the differences of pairs of scores, the second less the first; `None` for fewer than
    /// two.
    fn of<'a>(
        pairs: impl Iterator<Item = (&'a ExampleScore, &'a ExampleScore)>,
        weighting: Weighting,
    ) -> Option<Self> {
        let of = |score| weighting.objective(score);
        let differences: Vec<f64> = pairs.map(|(from, to)| of(to) - of(from)).collect();
        let Spread { n, mean, interval, .. } = Spread::of(&differences)?;
        interval.map(|(low, high)| Self { n, mean, low, high })
    }
}

/// Returns a number of examples, in words.
fn of_examples(n: usize) -> String {
    format!("{n} {}", if n == 1 { "example" } else { "examples" })
}

/// The legend of the columns of [`row`].
pub(crate) const COLUMNS: &str = "mean log-likelihood [nats], of classes alike and of each class, \
     with the mean error of the mode;\n  of partly covered cells the share of modes in between, and \
     of truths in the central 90 %; of walls\n  (the first layer of solid cells) the share found:";

/// Returns the figures of a score in one line.
pub(crate) fn row(name: &str, score: &ExampleScore) -> String {
    let of = |class: &covmap_fit::ClassScore| {
        if class.cells == 0 {
            return "—".to_owned();
        }
        format!("{:.2} / {:.3}", class.log_likelihood, class.error_of_mode)
    };
    format!(
        "    {name:9} {:6.3}   free {}   partial {} between {:.2} held {:.2}   wall {} found {:.2}",
        Weighting::Classes.objective(score),
        of(&score.free),
        of(&score.partial),
        score.partial.between,
        score.partial.central_90,
        of(&score.solid),
        score.solid.found
    )
}

/// Prints the report.
pub(crate) fn tell(report: &Report<'_>, written: &Path) {
    say::line(COLUMNS);
    for Compared { name, before, after, read_out } in
        std::iter::once(&report.training).chain(&report.held_out)
    {
        say::line(format!("  {name}, {} cells", after.all.cells));
        for (name, score) in [("before", before), ("after", after), ("read out", read_out)] {
            say::line(row(name, score));
        }
    }
    let differences =
        [("fitted", &report.held_out_difference), ("read out", &report.read_out_difference)];
    for (name, difference) in differences {
        if let Some(Paired { n, mean, low, high }) = difference {
            say::line(format!(
                "  held out, {name}: {mean:+.4} [{low:+.4}, {high:+.4}], {n} examples"
            ));
        }
    }
    say::line(format!("  {} evaluations; {}", report.path.len(), written.display()));
}
