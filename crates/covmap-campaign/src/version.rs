//! The version of the program.

/// Version of Cargo and the commit; also a hash of the sources if they differ from the commit or there
/// is none. Results of different versions are never mixed; `--version` prints the version.
pub const VERSION: &str = env!("COVMAP_VERSION");
