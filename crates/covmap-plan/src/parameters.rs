//! The parameters of planning.

use crate::{Strategy, StrategyError};
use covmap::short;
use covmap_gain::{BeamError, InformationGain, RangePrediction, Upkeep};
use serde::{Deserialize, Serialize};

/// Rule for giving up a cell whose entropy does not fall any longer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum StallRule {
    /// Our rule: the lowest entropy within a distance band must fall. When it stalls, only scans
    /// from half the distance count; below `closest` \[m\] the cell is exhausted. A cell at a
    /// border jitters between two bins for ever, and scans from afar say little: with bands,
    /// runs end provably, and no cell is given up because of scans from afar.
    Banded {
        /// Outer limit of the first band \[m\]: a cell is a reason to measure from at most this distance,
        /// and from at most the usable range. With a limit below the usable range, the robot does not
        /// measure again and again from afar what a few scans from nearby settle better.
        first: f64,
        /// The distance below which there is no further band \[m\].
        closest: f64,
    },
    /// Like `Banded`, but the first stall exhausts the cell.
    Unbanded,
    /// The paper's words: the change of entropy is below the limit for five consecutive
    /// measurements. Only the cap on counted scans ends a cell that jitters.
    Literal,
}

/// Condition under which unresolved cells are a reason to go to a view-point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Reason {
    /// One such cell is in sight from there. The paper counts, for each cell, the measurements that did
    /// not change it, after they were made.
    InSight,
    /// Enough cells are in sight whose entropy is expected to fall: the planner foresees the paper's
    /// "unable to reduce the entropy of a cell" instead of waiting for it.
    ExpectedChange {
        /// δ: the least expected fall of a cell's entropy with which the cell counts,
        /// Σ_d p(d | c) · I(h_i | d) \[nats\].
        cell: f64,
        /// The least expected fall of all these cells together with which a scan is worth taking,
        /// times the area of a cell, so that it holds for coarse grids as for fine ones:
        /// r² · Σ_i Σ_d p(d | c) · I(h_i | d) \[nats · m²\].
        scan: f64,
    },
}

/// The effort of a run: how certain a cell must be, together with what a scan must be expected to tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Effort {
    /// The floor plan, with two thirds of the scans of `Standard`.
    Quick,
    /// The default.
    Standard,
    /// The best map.
    Thorough,
}

impl Effort {
    /// ε \[nats\], and what a scan must be expected to tell \[nats · m²\]. docs/results.md shows their
    /// effect.
    fn demands(self) -> (f64, f64) {
        match self {
            Self::Quick => (1.2, 0.3),
            Self::Standard => (0.6, 0.06),
            Self::Thorough => (0.6, 0.03),
        }
    }
}

/// Least expected fall of a cell's entropy with which the cell counts, for any effort \[nats\]: the
/// paper's .001. In open space, where echoes come from afar, each cell promises little, and all cells
/// together promise enough.
const LEAST_OF_CELL: f64 = 0.001;

/// Least expected changes with which a scan is worth taking \[nats\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeastChange {
    /// Least change of one cell with which it counts.
    pub(crate) cell: f64,
    /// Least change of all cells that count.
    pub(crate) scan: f64,
}

/// The cells that must be explored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scope {
    /// All cells in sight of a place where the robot can stand, including walls.
    Observable,
    /// Only the cells where the robot can stand, and unknown ones next to them: the paper's words.
    Reachable,
}

/// Whether the robot may measure again where it stands, which costs no way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum InPlace {
    /// Its own cell is a candidate like any other.
    #[default]
    Always,
    /// The robot measures in place at view-points only. A robot that measures on the way has its targets as
    /// far from its last scan as its scans are from each other; if all are nearer, in another cell; and its
    /// own cell is a candidate only if there is no other.
    AtViewPoints,
}

/// Use of the fact that the robot's body fits where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BodyEvidence {
    /// Only that a step the robot has driven can be driven again.
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
    /// Strategy that chooses the next view-point.
    pub strategy: Strategy,
    /// The gain expected of a view-point: the paper's Eq. (14), or mutual information.
    pub gain: InformationGain,
    /// Condition under which cells are a reason to measure.
    pub reason: Reason,
    /// ε: a cell with an entropy up to this is explored \[nats\].
    pub entropy_threshold: f64,
    /// A smaller fall of a cell's entropy is a stall \[nats\]: the paper's .001.
    pub min_entropy_change: f64,
    /// The number of consecutive stalls after which a cell is given up: the paper's five.
    pub stall_limit: u32,
    /// Rule for giving up a cell.
    pub stall_rule: StallRule,
    /// Least distance of a candidate from the places where scans were taken \[m\]; 0 for none. For models
    /// that treat readings from one place as independent. Counting strategies, which count repeated scans,
    /// ignore it.
    pub scan_spacing: f64,
    /// Whether the robot may measure again where it stands. Files of versions that did not have this
    /// parameter are read as `Always`, which is what those versions did.
    #[serde(default)]
    pub in_place: InPlace,
    /// Cap on the number of scans counted for one cell; the planner counts the cells that it gives up.
    pub max_counted_scans: u32,
    /// Cost of a turn of one radian for IG_CL \[m/rad\]: d(l, x) of Eq. (16) is the length of the path
    /// plus the cost of all turns on it. In the paper turns cost nothing: 0.
    pub turn_cost: f64,
    /// The cells that must be explored.
    pub scope: Scope,
    /// Which cells a counting strategy must cover by its scans. The paper stops counting when "all reachable
    /// locations were covered by a measurement": `Reachable`. Files of versions that did not have this
    /// parameter are read as `Observable`, which is what those versions did.
    #[serde(default = "observable")]
    pub count_scope: Scope,
    /// The robot may drive over a cell whose most likely coverage is at most this.
    pub traversable_coverage: f64,
    /// c_u: reflection of an unknown cell when ranges are predicted.
    pub unknown_reflection: f64,
    /// η: share of every predicted range's probability that is spread over all ranges.
    pub uniform_share: f64,
    /// Use of the places where the robot's body was.
    pub body_evidence: BodyEvidence,
    /// Length up to which the robot tries a passage that looks blocked with its body \[m\], when cells
    /// are open beyond the passage and none in reach. 0, as in the paper: the robot tries none.
    pub passage_length: f64,
}

/// Error in the parameters of a planner.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlannerError {
    /// A parameter is outside its interval.
    #[error("planner.{name}: {} must lie in [{min}, {max}]", short(value))]
    OutOfRange {
        /// Name of the parameter.
        name: &'static str,
        /// Value of the parameter.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
    },
    /// A beam covers too many cells.
    #[error(transparent)]
    Beam(#[from] BeamError),
    /// A number of the strategy is out of its range.
    #[error("planner.strategy: {0}")]
    Strategy(#[from] StrategyError),
}

impl PlannerError {
    /// Checks that a number lies in an interval; NaN does not.
    pub(crate) fn within(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), Self> {
        let good = (min..=max).contains(&value);
        good.then_some(()).ok_or(Self::OutOfRange { name, value, min, max })
    }
}

fn observable() -> Scope {
    Scope::Observable
}

impl PlannerParameters {
    /// Returns the defaults: IG_CL(.1), walls are targets, [`Effort::Standard`], the paper's .001 and five.
    pub fn standard() -> Self {
        let (entropy_threshold, scan) = Effort::Standard.demands();
        Self {
            strategy: Strategy::IgCl { alpha: 0.1 },
            gain: InformationGain::Eq14,
            reason: Reason::ExpectedChange { cell: LEAST_OF_CELL, scan },
            entropy_threshold,
            min_entropy_change: 0.001,
            stall_limit: 5,
            stall_rule: StallRule::Banded { first: 1.0, closest: 0.5 },
            scan_spacing: 0.0,
            in_place: InPlace::Always,
            max_counted_scans: 520,
            turn_cost: 0.0,
            scope: Scope::Observable,
            count_scope: Scope::Reachable,
            traversable_coverage: 0.2,
            unknown_reflection: 0.0,
            uniform_share: 0.0,
            body_evidence: BodyEvidence::Belief,
            passage_length: 0.8,
        }
    }

    /// Returns the same parameters with another effort.
    #[must_use]
    pub fn with_effort(self, effort: Effort) -> Self {
        let (entropy_threshold, scan) = effort.demands();
        let reason = Reason::ExpectedChange { cell: LEAST_OF_CELL, scan };
        Self { reason, entropy_threshold, ..self }
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
        if let Reason::ExpectedChange { cell, scan } = self.reason {
            within("reason.cell", cell, 1e-6, 5.0)?;
            within("reason.scan", scan, 0.0, 100.0)?;
        }
        within("scan_spacing", self.scan_spacing, 0.0, 100.0)?;
        within("turn_cost", self.turn_cost, 0.0, 100.0)?;
        within("max_counted_scans", f64::from(self.max_counted_scans), 1.0, 1e6)?;
        within("traversable_coverage", self.traversable_coverage, 0.0, 0.999)?;
        within("unknown_reflection", self.unknown_reflection, 0.0, 1.0)?;
        within("uniform_share", self.uniform_share, 0.0, 1.0)?;
        within("passage_length", self.passage_length, 0.0, 100.0)
    }

    /// Returns the parameters of the range prediction.
    pub fn range_prediction(&self) -> RangePrediction {
        let Self { gain, unknown_reflection, uniform_share, .. } = *self;
        RangePrediction { gain, unknown_reflection, uniform_share, novelty: 1.0 }
    }

    /// Which cells the strategy must explore, or cover by its scans.
    pub(crate) fn scope_of_strategy(&self) -> Scope {
        match self.strategy.counting() {
            None => self.scope,
            Some(_) => self.count_scope,
        }
    }

    /// The gains are kept for strategies that weigh gains or ask for an expected change, and evaluated on
    /// demand for the others, which only report a few.
    pub(crate) fn upkeep(&self) -> Upkeep {
        let keeps = self.strategy.uses_gain() || self.least_change(1.0).is_some();
        if keeps { Upkeep::Kept } else { Upkeep::OnDemand }
    }

    /// The least expected changes, in cells of this side \[m\]; `None` if the parameters ask for none, and
    /// for strategies that count.
    pub(crate) fn least_change(&self, resolution: f64) -> Option<LeastChange> {
        match self.reason {
            Reason::ExpectedChange { cell, scan } if self.strategy.counting().is_none() => {
                let scan = (scan / (resolution * resolution)).max(cell);
                Some(LeastChange { cell, scan })
            }
            _ => None,
        }
    }

    /// The length of the longest passage that is tried, in cells; `None` if none is.
    pub(crate) fn longest_passage(&self, resolution: f64) -> Option<usize> {
        #[allow(clippy::cast_possible_truncation, reason = "at most 1e6")]
        let cells = (self.passage_length / resolution + 1e-9).min(1e6) as usize;
        (self.passage_length > 0.0).then_some(cells)
    }
}
