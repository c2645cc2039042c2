//! What is found once for a model and a ring of sensors: which imagined readings are evaluated, and
//! what each weighs in all others.

pub(crate) mod asks;
pub(crate) mod basis;
pub(crate) mod evidence;
pub(crate) mod front;
pub(crate) mod interpolation;
pub(crate) mod rings;
pub(crate) mod span;
