//! Campaigns: worlds × settings × strategies × starts × seeds, run in parallel and recorded run by run.
//!
//! A [`Campaign`] is read from its file, [`run`] does the runs that are not recorded yet, and [`collect()`]
//! joins the runs of several machines. Every run is a function of its [`RunKey`], the files that it names,
//! and the program, [`VERSION`]. Runs with different files or programs are never mixed.
//!
//! This crate does not depend on terminals or arguments.
//!
//! # Units
//! Metres and seconds; degrees in files.
//!
//! ```no_run
//! use covmap_campaign::{Campaign, Options, Shard, run};
//! use std::num::NonZeroUsize;
//! use std::path::Path;
//!
//! let campaign = Campaign::read(Path::new("configs/fig7.ron"))?;
//! let out = Path::new("out/fig7");
//! let options = Options { jobs: NonZeroUsize::MIN, shard: Shard::WHOLE, out, stop: &|| false };
//! for record in run(&campaign, &options, &|step| println!("{step:?}"))? {
//!     println!("{}: {:?} scans", record.key, record.values.get("scans"));
//! }
//! # Ok::<(), covmap_campaign::CampaignError>(())
//! ```

mod collect;
mod error;
mod execute;
mod file;
mod folder;
mod numbers;
mod parameters;
mod paths;
mod plan;
mod pool;
mod record;
mod starts;
mod tables;
mod version;

pub use collect::{Collected, collect};
pub use error::{CampaignError, FolderFault, Result, StartsFault};
pub use file::{Campaign, NamedWorld, Seeds, Setting, Starts};
pub use folder::{Manifest, Planned, load_paths};
pub use numbers::NUMBERS;
pub use parameters::{PARAMETERS, parameters};
pub use paths::{Paths, driven};
pub use plan::{Case, Job, Plan, Shard};
pub use pool::{Options, Step, check, run};
pub use record::{RunKey, RunRecord, Value};
pub use version::VERSION;
