//! The techniques that the experiments compare, and the numbers of a run that compare them.

use covmap_plan::Strategy;

/// Extended counting with n = 50, as in Table 1.
pub(crate) const EXTENDED: Strategy = Strategy::Count { times: 50.0, half_distance: Some(2.0) };
/// Counting with n = 1.
pub(crate) const ONCE: Strategy = Strategy::Count { times: 1.0, half_distance: None };

/// The number of scans.
pub(crate) const SCANS: &str = "scans";
/// The length of the path \[m\].
pub(crate) const PATH: &str = "path_length_m";
/// The known share of the cells that could be seen.
pub(crate) const COMPLETENESS: &str = "completeness";
