//! The built-in configurations, with which the program works in any folder.

use covmap_lab::files::BuiltIn;
use std::path::Path;

/// The default configuration.
pub(crate) const B21R: BuiltIn =
    BuiltIn { name: "configs/b21r.ron", text: include_str!("../../../configs/b21r.ron") };
/// The configuration of the robot whose logs are three files.
pub(crate) const SONAR8: BuiltIn =
    BuiltIn { name: "configs/sonar8.ron", text: include_str!("../../../configs/sonar8.ron") };
/// The configuration for lasers.
pub(crate) const LASER: BuiltIn =
    BuiltIn { name: "configs/laser.ron", text: include_str!("../../../configs/laser.ron") };

/// The configuration of the sonars of a log.
pub(crate) fn of_sonars(log: &Path) -> BuiltIn {
    if log.is_dir() { SONAR8 } else { B21R }
}
