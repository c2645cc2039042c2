//! The program as a user types it.
#![allow(clippy::unwrap_used, reason = "tests")]

mod bad_input;
mod bad_maps;
mod bench;
mod beside;
mod campaign;
mod explain;
mod explore;
mod figures;
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
