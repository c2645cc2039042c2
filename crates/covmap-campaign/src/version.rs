//! Which program this is.

/// The version of Cargo and the commit, and a hash of the sources where they differ from it
/// or there is none. Results of different versions are never mixed; `--version` prints it.
pub const VERSION: &str = env!("COVMAP_VERSION");
