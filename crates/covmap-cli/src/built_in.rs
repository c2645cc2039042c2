//! The configurations that the program has built in, so that it works in any folder.

use covmap_lab::files::BuiltIn;

/// The default.
pub(crate) const B21R: BuiltIn =
    BuiltIn { name: "configs/b21r.ron", text: include_str!("../../../configs/b21r.ron") };
/// The robot of the logs in three files.
pub(crate) const SONAR8: BuiltIn =
    BuiltIn { name: "configs/sonar8.ron", text: include_str!("../../../configs/sonar8.ron") };
/// Lasers.
pub(crate) const LASER: BuiltIn =
    BuiltIn { name: "configs/laser.ron", text: include_str!("../../../configs/laser.ron") };
