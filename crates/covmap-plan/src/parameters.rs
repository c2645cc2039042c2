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

/// When cells that are not resolved are a reason to go to a view-point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Reason {
    /// When one is in sight from there: the paper counts, for each cell, the measurements that did
    /// not change it, after they were made.
    InSight,
    /// When one is in sight whose entropy is expected to fall, and there are enough of them. "Unable to
    /// reduce the entropy of a cell", foreseen instead of waited for.
    ExpectedChange {
        /// What a cell's entropy must be expected to fall by to count, δ:
        /// Σ_d p(d | c) · I(h_i | d) \[nats\].
        cell: f64,
        /// What all of them together must be expected to fall by if a scan is to be worth its while,
        /// times the area of a cell, which makes it the same in coarse grids and in fine ones:
        /// r² · Σ_i Σ_d p(d | c) · I(h_i | d) \[nats · m²\].
        scan: f64,
    },
}

/// How much is measured before nothing is worth it: how sure of a cell is sure enough, and what a scan
/// must be expected to tell, together.
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
    /// ε \[nats\], and what a scan must be expected to tell \[nats · m²\]. What they buy stands in
    /// docs/results.md.
    fn demands(self) -> (f64, f64) {
        match self {
            Self::Quick => (1.2, 0.3),
            Self::Standard => (0.6, 0.06),
            Self::Thorough => (0.6, 0.03),
        }
    }
}

/// With any effort, what a cell's entropy must be expected to fall by to count \[nats\]: the paper's .001.
/// In open space, where echoes come from afar, each cell promises little, and all together enough.
const LEAST_OF_CELL: f64 = 0.001;

/// What a scan is expected to change if it is worth its while \[nats\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeastChange {
    /// About one cell, if it is to count.
    pub(crate) cell: f64,
    /// About all cells that count.
    pub(crate) scan: f64,
}

/// Which cells must be explored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scope {
    /// All that can be seen from where the robot can stand: walls, too.
    Observable,
    /// Only those where the robot can stand, or might: the paper's words.
    Reachable,
}

/// Whether the robot may measure again where it stands, which costs no way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum InPlace {
    /// Its own cell is a candidate like any other.
    #[default]
    Always,
    /// Not while it measures on the way: then scans are made every so many metres of way, and a target is
    /// another cell. Its own cell is a candidate only if there is no other.
    AtViewPoints,
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
    /// When cells are a reason to measure.
    pub reason: Reason,
    /// ε: a cell with an entropy up to this is explored \[nats\].
    pub entropy_threshold: f64,
    /// A smaller fall of a cell's entropy is a stall \[nats\]: the paper's .001.
    pub min_entropy_change: f64,
    /// Stalls in a row after which a cell is given up: the paper's five.
    pub stall_limit: u32,
    /// When a cell is given up.
    pub stall_rule: StallRule,
    /// A view-point nearer than this to where a scan was taken is no candidate \[m\]: for models that
    /// take readings from one place for independent. 0 asks for no distance. Counting strategies, which
    /// count just that, do not ask.
    pub scan_spacing: f64,
    /// Whether the robot may measure again where it stands. Files of versions that did not have this
    /// parameter are read as `Always`, which is what those versions did.
    #[serde(default)]
    pub in_place: InPlace,
    /// A practical cap on the scans counted for one cell; reported whenever it fires.
    pub max_counted_scans: u32,
    /// The cost of a turn of one radian to IG_CL, in metres of way \[m/rad\]: d(l, x) of
    /// Eq. (16) is the length of the way and this for all turns on it. 0, the paper: turns cost nothing.
    pub turn_cost: f64,
    /// Which cells must be explored.
    pub scope: Scope,
    /// Which cells a counting strategy must cover by its scans. The paper stops counting when "all reachable
    /// locations were covered by a measurement": `Reachable`. Files of versions that did not have this
    /// parameter are read as `Observable`, which is what those versions did.
    #[serde(default = "observable")]
    pub count_scope: Scope,
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

fn observable() -> Scope {
    Scope::Observable
}

impl PlannerParameters {
    /// The defaults: IG_CL(.1), walls are targets, [`Effort::Standard`], the paper's .001 and five.
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

    /// The same with another effort.
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

    /// How ranges are predicted.
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

    /// Strategies that weigh gains keep them; the others report some few.
    pub(crate) fn upkeep(&self) -> Upkeep {
        let keeps = self.strategy.uses_gain() || self.least_change(1.0).is_some();
        if keeps { Upkeep::Kept } else { Upkeep::OnDemand }
    }

    /// What is expected at least, in cells of this side \[m\]; `None` if that does not matter, as for
    /// strategies that count.
    pub(crate) fn least_change(&self, resolution: f64) -> Option<LeastChange> {
        match self.reason {
            Reason::ExpectedChange { cell, scan } if self.strategy.counting().is_none() => {
                let scan = (scan / (resolution * resolution)).max(cell);
                Some(LeastChange { cell, scan })
            }
            _ => None,
        }
    }

    /// The longest passage that is tried, in cells; `None` if none is.
    pub(crate) fn longest_passage(&self, resolution: f64) -> Option<usize> {
        #[allow(clippy::cast_possible_truncation, reason = "at most 1e6")]
        let cells = (self.passage_length / resolution + 1e-9).min(1e6) as usize;
        (self.passage_length > 0.0).then_some(cells)
    }
}
