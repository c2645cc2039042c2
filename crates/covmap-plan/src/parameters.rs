//! The parameters of planning.

use crate::{Strategy, StrategyError};
use covmap::short;
use covmap_gain::{BeamError, InformationGain, RangePrediction, Upkeep};
use serde::{Deserialize, Serialize};

/// When a cell is given up whose entropy does not fall any longer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum StallRule {
    /// Ours: the lowest entropy within a distance band must fall. When it stalls, only scans
    /// from half the distance count; below `closest` \[m\] the cell is exhausted. A cell at a
    /// border jitters between two bins for ever, and looks from afar say little: with bands
    /// runs end, provably, and no cell is given up for having been looked at from afar.
    Banded {
        /// The first band: a cell is a reason to measure from no farther than this \[m\], and
        /// never farther than the usable range. Below that, a robot does not measure again and
        /// again from afar what a few scans from nearby settle, and settle better.
        first: f64,
        /// The distance below which there is no further band \[m\].
        closest: f64,
    },
    /// As `Banded`, but the first stall exhausts the cell.
    Unbanded,
    /// The paper's words: the change of entropy is below the limit for five consecutive
    /// measurements. Cells that jitter end by the cap on counted scans only.
    Literal,
}

/// When a cell that is not resolved is a reason to go to a view-point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Reason {
    /// When it is in sight from there: the paper counts, for each cell, the measurements that did
    /// not change it, after they were made.
    InSight,
    /// When it is in sight, and its entropy is expected to fall by one of the beams:
    /// Σ_d p(d | c) · I(h_i | d) is at least so much \[nats\]. "Unable to reduce the entropy of a
    /// cell", foreseen instead of waited for.
    ExpectedChange(f64),
}

/// How much is measured before nothing is worth it: the least expected change and how far scans keep
/// apart, together. ε stays: what is resolved, and free in the map for other software, is as sure with
/// any effort. (From .6 to 1.6 nats ε changed the scans in the office by no more than 5 %.)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Effort {
    /// The floor plan, with a third of the scans of `Thorough`.
    Quick,
    /// The default: half of the scans.
    Standard,
    /// The best map.
    Thorough,
}

impl Effort {
    /// The least expected change \[nats\], and the spacing of scans \[m\]. What they buy stands in
    /// docs/results.md.
    fn demands(self) -> (f64, f64) {
        match self {
            Self::Quick => (0.2, 0.65),
            Self::Standard => (0.1, 0.5),
            Self::Thorough => (0.02, 0.35),
        }
    }
}

/// Which cells must be explored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scope {
    /// All that can be seen from where the robot can stand: walls, too.
    Observable,
    /// Only those where the robot can stand, or might: the paper's words.
    Reachable,
}

/// What is made of the fact that the robot's body fits where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BodyEvidence {
    /// Nothing, but that a step that the robot has driven can be driven again.
    Off,
    /// Also, a view-point that the robot stood on stays traversable from all sides.
    PlannerOnly,
    /// Also, cells entirely under the body are free in the map.
    Belief,
}

/// The parameters of the planner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannerParameters {
    /// How the next view-point is chosen.
    pub strategy: Strategy,
    /// What a view-point is expected to gain: the paper's Eq. (14), or mutual information.
    pub gain: InformationGain,
    /// When a cell is a reason to measure.
    pub reason: Reason,
    /// ε: a cell with an entropy up to this is explored \[nats\].
    pub entropy_threshold: f64,
    /// A smaller fall of a cell's entropy is a stall \[nats\]: the paper's .001.
    pub min_entropy_change: f64,
    /// Stalls in a row after which a cell is given up: the paper's five.
    pub stall_limit: u32,
    /// When a cell is given up.
    pub stall_rule: StallRule,
    /// A view-point nearer than this to where a scan was taken tells nothing new \[m\]; 0 is
    /// the paper. Counting strategies, which count just that, do not ask.
    pub scan_spacing: f64,
    /// A practical cap on the scans counted for one cell; reported whenever it fires.
    pub max_counted_scans: u32,
    /// Which cells must be explored.
    pub scope: Scope,
    /// The largest most likely coverage of a cell that the robot may drive over.
    pub traversable_coverage: f64,
    /// c_u: how much an unknown cell reflects when ranges are predicted.
    pub unknown_reflection: f64,
    /// η: share of every predicted range's probability that is spread over all ranges.
    pub uniform_share: f64,
    /// What is made of where the robot's body was.
    pub body_evidence: BodyEvidence,
    /// When nothing is open in reach, but something is beyond a passage that looks blocked,
    /// the robot tries it with its body, if it is no longer than this \[m\]; 0, the paper,
    /// tries none.
    pub passage_length: f64,
}

/// Why parameters make no planner.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlannerError {
    /// A parameter is not in its interval.
    #[error("planner.{name}: {} must lie in [{min}, {max}]", short(value))]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
    },
    /// A beam covers too many cells.
    #[error(transparent)]
    Beam(#[from] BeamError),
    /// The strategy has an impossible number.
    #[error("planner.strategy: {0}")]
    Strategy(#[from] StrategyError),
}

impl PlannerError {
    /// Checks that a number lies in an interval; what is no number does not.
    pub(crate) fn within(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), Self> {
        let good = (min..=max).contains(&value);
        good.then_some(()).ok_or(Self::OutOfRange { name, value, min, max })
    }
}

impl PlannerParameters {
    /// The defaults: IG_CL(.1), ε = .6, walls are targets, [`Effort::Standard`], the paper's .001 and
    /// five.
    pub fn standard() -> Self {
        let (least_change, scan_spacing) = Effort::Standard.demands();
        Self {
            strategy: Strategy::IgCl { alpha: 0.1 },
            gain: InformationGain::Eq14,
            reason: Reason::ExpectedChange(least_change),
            entropy_threshold: 0.6,
            min_entropy_change: 0.001,
            stall_limit: 5,
            stall_rule: StallRule::Banded { first: 1.0, closest: 0.5 },
            scan_spacing,
            max_counted_scans: 520,
            scope: Scope::Observable,
            traversable_coverage: 0.2,
            unknown_reflection: 0.0,
            uniform_share: 0.0,
            body_evidence: BodyEvidence::Belief,
            passage_length: 0.8,
        }
    }

    /// The same with another effort.
    #[must_use]
    pub fn with_effort(self, effort: Effort) -> Self {
        let (least_change, scan_spacing) = effort.demands();
        Self { reason: Reason::ExpectedChange(least_change), scan_spacing, ..self }
    }

    /// Checks every parameter.
    pub(crate) fn validate(&self) -> Result<(), PlannerError> {
        let within = PlannerError::within;
        self.strategy.validate()?;
        within("entropy_threshold", self.entropy_threshold, 0.0, 5.0)?;
        within("min_entropy_change", self.min_entropy_change, 1e-6, 1.0)?;
        within("stall_limit", f64::from(self.stall_limit), 1.0, 1000.0)?;
        if let StallRule::Banded { first, closest } = self.stall_rule {
            within("stall_rule.first", first, closest, 100.0)?;
            within("stall_rule.closest", closest, 1e-2, 100.0)?;
        }
        if let Reason::ExpectedChange(least) = self.reason {
            within("reason.ExpectedChange", least, 1e-6, 5.0)?;
        }
        within("scan_spacing", self.scan_spacing, 0.0, 100.0)?;
        within("max_counted_scans", f64::from(self.max_counted_scans), 1.0, 1e6)?;
        within("traversable_coverage", self.traversable_coverage, 0.0, 0.999)?;
        within("unknown_reflection", self.unknown_reflection, 0.0, 1.0)?;
        within("uniform_share", self.uniform_share, 0.0, 1.0)?;
        within("passage_length", self.passage_length, 0.0, 100.0)
    }

    /// How ranges are predicted.
    pub fn range_prediction(&self) -> RangePrediction {
        let Self { gain, unknown_reflection, uniform_share, .. } = *self;
        RangePrediction { gain, unknown_reflection, uniform_share, novelty: 1.0 }
    }

    /// Strategies that weigh gains keep them; the others report some few.
    pub(crate) fn upkeep(&self) -> Upkeep {
        let keeps = self.strategy.uses_gain() || self.least_change().is_some();
        if keeps { Upkeep::Kept } else { Upkeep::OnDemand }
    }

    /// What the entropy of a cell must be expected to fall by; `None` if that does not matter, as for
    /// strategies that count.
    pub(crate) fn least_change(&self) -> Option<f64> {
        match self.reason {
            Reason::ExpectedChange(least) if self.strategy.counting().is_none() => Some(least),
            _ => None,
        }
    }

    /// The longest passage that is tried, in cells; `None` if none is.
    pub(crate) fn longest_passage(&self, resolution: f64) -> Option<usize> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1e6")]
        let cells = (self.passage_length / resolution + 1e-9).min(1e6) as usize;
        (self.passage_length > 0.0).then_some(cells)
    }
}
