//! The ends of Eq. (16): IG_CL with α = 0 and α = 10⁹ against CL and IG (claim 16).

use crate::error::{PaperError, Result};
use crate::session::Session;
use covmap_explore::{Ending, Limits as Budget};
use covmap_io::parse_ron;
use covmap_lab::{Config, Experiment};
use covmap_plan::Strategy;
use covmap_sonar::Scan;
use covmap_world::{Scenario, World};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::path::Path;

/// The largest number of scans up to which runs are compared.
const SCANS: usize = 2000;
const QUICK_SCANS: usize = 400;
/// The side of the cells \[m\], large to be quick.
const SIDE: f64 = 0.2;

/// Whether the ends of IG_CL are CL and IG.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// Whether α = 0 is CL, scan by scan.
    pub zero_is_cl: bool,
    /// Whether α = 10⁹ is IG, scan by scan.
    pub huge_is_ig: bool,
    /// The description of the comparison.
    pub what: String,
}

/// The measurements of a run, in order.
#[derive(Debug, Clone, PartialEq)]
struct Trace {
    scans: Vec<Scan>,
    ending: Ending,
}

impl Limits {
    /// Explores a small world with all four strategies.
    pub fn measure(config: &Config, session: &Session<'_>) -> Result<Self> {
        let text = include_str!("../../../scenarios/lab.ron");
        let scenario: Scenario = parse_ron(Path::new("scenarios/lab.ron"), text)?;
        let world = World::from_scenario(&scenario, config.sonar.surface)?;
        let most = if session.quick { QUICK_SCANS } else { SCANS };
        let four = [
            Strategy::IgCl { alpha: 0.0 },
            Strategy::Cl,
            Strategy::IgCl { alpha: 1e9 },
            Strategy::Ig,
        ];
        let trace = |strategy| trace(&world, config, strategy, most, session);
        let traces: Vec<Trace> = four.into_par_iter().map(trace).collect::<Result<_>>()?;
        session.check()?;
        let [zero, cl, huge, ig] = &traces[..] else {
            return Err(PaperError::Missing("a run"));
        };
        Ok(Self {
            zero_is_cl: zero == cl,
            huge_is_ig: huge == ig,
            what: format!(
                "compared on lab.ron, r = {SIDE} m, seed 1, up to {most} scans: {}, {}",
                cl.in_words("CL"),
                ig.in_words("IG")
            ),
        })
    }
}

impl Trace {
    fn in_words(&self, name: &str) -> String {
        let whole = if self.ending == Ending::BudgetSpent { "was cut" } else { "ended" };
        let place = |scan: &Scan| {
            let at = scan.pose.translation.vector;
            [at.x.to_bits(), at.y.to_bits()]
        };
        let places: BTreeSet<[u64; 2]> = self.scans.iter().map(place).collect();
        format!("{name} {whole} after {} in {} places", self.scans.len(), places.len())
    }
}

/// Returns all scans of a run: places, times and ranges to the last bit.
fn trace(
    world: &World,
    config: &Config,
    strategy: Strategy,
    most: usize,
    session: &Session<'_>,
) -> Result<Trace> {
    let mut config = Config { resolution: SIDE, ..config.clone() };
    config.planner.strategy = strategy;
    let budget = Budget { max_scans: Some(most), ..Budget::default() };
    let experiment = Experiment::new(world, &config, None, budget, 1)?;
    let run = experiment.explore(world, &mut |_, _| session.watch().flow())?;
    Ok(Trace { scans: run.scans, ending: run.ending })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Audience;
    use covmap_lab::Watch;
    use std::fmt::Display;
    use std::num::NonZeroUsize;

    /// Stops the work at once.
    struct Stopped;

    impl Watch for Stopped {
        fn tell(&self, _: &dyn Display) {}
        fn begin(&self, _: &str) {}
        fn is_stopped(&self) -> bool {
            true
        }
    }

    impl Audience for Stopped {
        fn watch(&self) -> &dyn Watch {
            self
        }
        fn line(&self, _: &str) {}
        fn campaign(&self, _: &str, run: &mut dyn FnMut(&crate::Steps<'_>)) {
            run(&|_| {});
        }
    }

    #[test]
    fn ctrl_c_ends_the_comparison_of_traces() {
        let session = Session::new("out".into(), NonZeroUsize::MIN, true, &[], &Stopped);
        let error = Limits::measure(&Config::b21r(), &session).unwrap_err();
        assert!(error.to_string().starts_with("interrupted"), "{error}");
    }
}
