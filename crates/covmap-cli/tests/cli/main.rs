//! The program as a user types it.
#![allow(clippy::unwrap_used, reason = "tests")]

/// The tested program.
const PROGRAM: &str = env!("CARGO_BIN_EXE_covmap");

mod bad_input;
mod bad_maps;
mod beside;
mod campaign;
mod explain;
mod explore;
mod fit;
mod interrupt;
mod logs_as_they_are;
mod map;
mod maps;
mod no_worlds;
mod readings;
mod tables;
mod typed;
mod writing;
