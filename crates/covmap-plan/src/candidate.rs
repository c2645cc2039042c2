//! Candidates, and the decision between them.

use covmap::Cell;
use serde::{Deserialize, Serialize};

/// A candidate view-point with its gain, cost and score.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CandidateRecord {
    /// The view-point l.
    pub cell: Cell,
    /// E\[I(l)\] \[nats\].
    pub gain: f64,
    /// d_c(l, x) \[m\]; for IG_CL including the cost of turns, `planner.turn_cost`.
    pub cost: f64,
    /// The first term of Eq. (16); for other strategies with α = 1.
    pub gain_term: f64,
    /// The second term of Eq. (16), without its sign.
    pub cost_term: f64,
    /// Score that the strategy maximises: the negative cost for CL, the gain for IG and IG_WIN,
    /// the bracket of Eq. (16) for IG_CL.
    pub score: f64,
}

/// A decision that explains itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// The chosen view-point.
    pub target: Cell,
    /// The corners of the path, including the target and excluding the robot's cell; the path leads
    /// straight from the centre of one corner to that of the next. Empty if the robot stays in its cell.
    pub path: Vec<Cell>,
    /// The cells of the passage that the robot tries although they look blocked, because all
    /// candidates lie beyond them; usually empty.
    pub passage: Vec<Cell>,
    /// Whether the scan is for cells that keep the robot off more ground, as no other scan is worth taking.
    pub towards_ground: bool,
    /// The number of candidates, |L(c)|.
    pub candidates: usize,
    /// The number of candidates with E\[I\] < 0 among those that were evaluated; an upper bound rules
    /// out most candidates without evaluation.
    pub negative_gains: usize,
    /// The number of candidates so close to the best that the literal equations decided between them.
    pub decided_by_oracle: usize,
    /// The best candidates, at most five.
    pub best: Vec<CandidateRecord>,
}
