//! Tables that are made once for a model and a ring of sensors: the imagined readings that are
//! evaluated, and their weights in all others.
//!
//! The tables are made from the bottom up, as the modules are listed. A *distance ring* holds the
//! cells of all beams at about one distance from a view-point ([`rings`]). An outcome is *near* a
//! ring if it ends in it or before it, and *beyond* it if it ends farther away than all its cells.
//! A cell lies *in front* of an end, *at* it or *behind* it; without an echo there is no end.
//!
//! | outcome | cells | the gain of a cell is |
//! |---|---|---|
//! | beyond the ring | all are in front | interpolated over range and distance ([`beyond`]) |
//! | near, ends before the ring | all are behind | interpolated over the distance |
//! | near, ends in the ring | in front, at the end and behind | that of its own distance |
//! | no echo | all are free | interpolated over the distance |
//!
//! An interpolation needs some readings at nodes; the readings at the nodes of all rings are
//! mixtures of a few that are kept for every cell ([`basis`]).

pub(super) mod interpolation;
pub(super) mod spanning;

pub(super) mod basis;

pub(super) mod beyond;
pub(super) mod rings;

pub(super) mod needs;

pub(super) mod probed;
