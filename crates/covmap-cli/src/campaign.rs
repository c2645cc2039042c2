//! Campaigns: worlds × settings × strategies × starts × seeds, run in parallel and recorded
//! run by run.

mod collect;
mod command;
mod digest;
mod execute;
mod file;
mod folder;
mod parameters;
mod paths;
mod plan;
mod pool;
mod record;
mod starts;
mod tables;
mod version;

pub(crate) use collect::run as collect;
pub(crate) use command::run as command;
pub(crate) use digest::Digest;
pub(crate) use file::{Campaign, NamedWorld, Seeds, Setting, Starts};
pub(crate) use folder::load_paths;
pub(crate) use parameters::{PARAMETERS, parameters};
pub(crate) use paths::{Paths, driven};
pub(crate) use plan::{Job, Plan, Shard};
pub(crate) use pool::{Options, Step, check, run};
pub(crate) use record::{RunKey, RunRecord, Value};
pub(crate) use version::VERSION;
