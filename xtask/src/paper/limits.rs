//! The ends of Eq. (16): IG_CL with α = 0 and α = 10⁹ against CL and IG (claim 16).

use anyhow::Result;
use covmap_explore::{Config, Event, Limits as Budget, Mission, SimulatedRobot, explore};
use covmap_io::parse_ron;
use covmap_plan::Strategy;
use covmap_sonar::Scan;
use covmap_world::{Scenario, World};
use std::ops::ControlFlow;
use std::path::Path;

/// A run is compared up to so many scans.
const SCANS: usize = 150;
/// Cells of this side \[m\], so that it is quick.
const SIDE: f64 = 0.2;

/// Whether the ends are those of CL and IG.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Limits {
    pub(crate) zero_is_cl: bool,
    pub(crate) huge_is_ig: bool,
    /// How they were compared.
    pub(crate) what: String,
}

impl Limits {
    /// Explores a small world with all four.
    pub(crate) fn measure(config: &Config) -> Result<Self> {
        let text = include_str!("../../../scenarios/lab.ron");
        let scenario: Scenario = parse_ron(Path::new("scenarios/lab.ron"), text)?;
        let world = World::from_scenario(&scenario, config.sonar.surface)?;
        let trace = |strategy| trace(&world, config, strategy);
        let (zero, cl) = (trace(Strategy::IgCl { alpha: 0.0 })?, trace(Strategy::Cl)?);
        let (huge, ig) = (trace(Strategy::IgCl { alpha: 1e9 })?, trace(Strategy::Ig)?);
        Ok(Self {
            zero_is_cl: zero == cl,
            huge_is_ig: huge == ig,
            what: format!(
                "compared on lab.ron, r = {SIDE} m, seed 1, up to {SCANS} scans (CL made {}, IG {})",
                cl.len(),
                ig.len()
            ),
        })
    }
}

/// All scans of a run: places, times and ranges to the last bit.
fn trace(world: &World, config: &Config, strategy: Strategy) -> Result<Vec<Scan>> {
    let mut config = Config { resolution: SIDE, ..config.clone() };
    config.planner.strategy = strategy;
    let budget = Budget { max_scans: Some(SCANS), ..Budget::default() };
    let mission = Mission::new(world, &config, None, budget)?;
    let mut robot = SimulatedRobot::new(world, &config, 1)?;
    let on = &mut |_: &Event, _: &covmap_explore::View<'_>| ControlFlow::Continue(());
    Ok(explore(&mission, &mut robot, on)?.scans)
}
