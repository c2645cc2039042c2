//! A fit, checked on worlds that it has not seen (claim 4).

use super::session::Session;
use crate::fit;
use crate::fit_file::{FitFile, Source, examples};
use crate::progress::Progress;
use anyhow::Result;
use covmap_fit::{Example, score};
use std::path::Path;

/// Evaluations of the one search.
const EVALUATIONS: usize = 60;
/// What is enough for a look.
const QUICK_EVALUATIONS: usize = 12;
const QUICK_SCANS: usize = 15;
const QUICK_SIDE: f64 = 0.2;

/// What a fit came to.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Fitting {
    /// The objective on each held-out world, fitted less unfitted \[nats\].
    pub(crate) differences: Vec<f64>,
    /// How it was fitted.
    pub(crate) what: String,
}

impl Fitting {
    /// Fits what a file for `fit` says, with one short search.
    pub(crate) fn measure(path: &Path, session: &Session<'_>) -> Result<Self> {
        let (mut file, mut config, name) = FitFile::read(path)?;
        file.starts = 1;
        file.evaluations = if session.quick { QUICK_EVALUATIONS } else { EVALUATIONS };
        if session.quick {
            config.resolution = QUICK_SIDE;
            let shorten = |source: &mut Source| {
                if let Source::Simulated(simulated) = source {
                    simulated.scans = simulated.scans.min(QUICK_SCANS);
                }
            };
            file.training.iter_mut().chain(&mut file.held_out).for_each(shorten);
        }
        let mut progress = Progress::new(session.quiet);
        let made = |sources: &[Source]| {
            examples(sources, path, (&config, &name), (&progress, session.interrupt))
        };
        let (training, held_out) = (made(&file.training)?, made(&file.held_out)?);
        let fitted = fit::search(&file, &config, &training, &mut progress, session.interrupt)?;
        progress.finish();
        let difference = |example: &Example| -> Result<f64> {
            let example = std::slice::from_ref(example);
            let after = file.weighting.objective(&score(example, &fitted.parameters)?);
            Ok(after - file.weighting.objective(&score(example, &config.model)?))
        };
        Ok(Self {
            differences: held_out.iter().map(difference).collect::<Result<_>>()?,
            what: format!(
                "{}: one search of at most {} evaluations on {} worlds, r = {} m",
                path.display(),
                file.evaluations,
                training.len(),
                config.resolution
            ),
        })
    }
}
