//! A fit, checked on unseen worlds (claim 4).

use crate::error::Result;
use crate::session::Session;
use covmap_fit::{Example, score};
use covmap_lab::{FitPlan, Source};
use covmap_statistics::{Estimate, Grouped, bootstrap};
use std::collections::BTreeMap;
use std::path::Path;

/// The number of evaluations in the one search.
const EVALUATIONS: usize = 60;
/// The number of evaluations in a quick search.
const QUICK_EVALUATIONS: usize = 12;
const QUICK_SCANS: usize = 15;
const QUICK_SIDE: f64 = 0.2;

/// The number of resamples of scenarios, and their seed.
const RESAMPLES: usize = 2000;
const SEED: u64 = 4;

/// The result of a fit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fitting {
    /// The objective on each held-out world, fitted less unfitted \[nats\].
    ///
    /// Each scenario has a group, because another pose of the same scenario is not an independent
    /// world.
    pub by_scenario: Grouped<f64>,
    /// The description of the fit.
    pub what: String,
}

impl Fitting {
    /// Runs the fit of a file for `fit`, with one short search.
    pub fn measure(path: &Path, session: &Session<'_>) -> Result<Self> {
        let mut plan = FitPlan::read(path)?;
        let file = &mut plan.file;
        file.starts = 1;
        file.evaluations = if session.quick { QUICK_EVALUATIONS } else { EVALUATIONS };
        if session.quick {
            plan.begin.config.resolution = QUICK_SIDE;
            plan.explorer.config.resolution = QUICK_SIDE;
            let shorten = |source: &mut Source| {
                if let Source::Simulated(simulated) = source {
                    let scans = simulated.scans.unwrap_or(QUICK_SCANS);
                    simulated.scans = Some(scans.min(QUICK_SCANS));
                    simulated.resolution = None;
                }
            };
            file.training.iter_mut().chain(&mut file.held_out).for_each(shorten);
        }
        let (file, config) = (&plan.file, &plan.begin.config);
        let made = |sources: &[Source]| plan.examples(sources, session.watch());
        let (training, held_out) = (made(&file.training)?, made(&file.held_out)?);
        let fitted = plan.search(&training, session.watch())?;
        let difference = |example: &Example| -> Result<f64> {
            let example = std::slice::from_ref(example);
            let after = file.weighting.objective(&score(example, &fitted.parameters)?);
            Ok(after - file.weighting.objective(&score(example, &config.model)?))
        };
        let mut by_scenario: BTreeMap<&Path, Vec<f64>> = BTreeMap::new();
        for (source, example) in file.held_out.iter().zip(&held_out) {
            by_scenario.entry(source.file()).or_default().push(difference(example)?);
        }
        Ok(Self {
            by_scenario: by_scenario.into_values().collect(),
            what: format!(
                "{}: one search of at most {} evaluations on {} worlds, r = {} m",
                path.display(),
                file.evaluations,
                training.len(),
                config.resolution
            ),
        })
    }
    /// Returns the number of held-out worlds.
    pub fn worlds(&self) -> usize {
        self.by_scenario.iter().map(Vec::len).sum()
    }

    /// Returns the mean difference over held-out worlds, with its error by resampling scenarios.
    pub fn mean_difference(&self) -> Option<Estimate> {
        bootstrap(&self.by_scenario, RESAMPLES, SEED, |drawn| {
            let n = drawn.len() as f64;
            (!drawn.is_empty()).then(|| drawn.iter().copied().sum::<f64>() / n)
        })
    }
}
