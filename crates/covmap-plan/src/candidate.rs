//! Candidates, and what is decided between them.

use covmap::Cell;
use serde::{Deserialize, Serialize};

/// A candidate view-point with all that speaks for and against it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CandidateRecord {
    /// The view-point l.
    pub cell: Cell,
    /// E\[I(l)\] \[nats\].
    pub gain: f64,
    /// d_c(l, x) \[m\]; for IG_CL with what turns cost, `planner.turn_cost`.
    pub cost: f64,
    /// The first term of Eq. (16); for other strategies with α = 1.
    pub gain_term: f64,
    /// The second term of Eq. (16), without its sign.
    pub cost_term: f64,
    /// What the strategy maximises: the negative cost for CL, the gain for IG and IG_WIN,
    /// the bracket of Eq. (16) for IG_CL.
    pub score: f64,
}

/// A decision that explains itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// The chosen view-point.
    pub target: Cell,
    /// The corners of the way there, cells between whose centres it leads straight, without the one the
    /// robot is in, with the target; empty if the robot stays in its cell.
    pub path: Vec<Cell>,
    /// The cells of the passage that the robot tries, though they look blocked: it can reach
    /// no candidate but beyond them. Mostly none.
    pub passage: Vec<Cell>,
    /// No scan is worth its while: this one looks at what keeps the robot off more ground.
    pub towards_ground: bool,
    /// The number of candidates, |L(c)|.
    pub candidates: usize,
    /// How many of them have E\[I\] < 0, of those that were evaluated: of most candidates an upper
    /// bound tells that others are better.
    pub negative_gains: usize,
    /// How many were so close to the best that the literal equations decided between them.
    pub decided_by_oracle: usize,
    /// The five best.
    pub best: Vec<CandidateRecord>,
}
