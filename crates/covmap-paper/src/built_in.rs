//! The shipped configurations of the experiments.

use covmap_lab::files::BuiltIn;

/// The configuration of the paper, without our additions.
pub(crate) const PAPER: BuiltIn =
    BuiltIn { name: "configs/paper.ron", text: include_str!("../../../configs/paper.ron") };
/// The default configuration.
pub(crate) const B21R: BuiltIn =
    BuiltIn { name: "configs/b21r.ron", text: include_str!("../../../configs/b21r.ron") };
/// The configuration of a robot with eight sonars.
pub(crate) const SONAR8: BuiltIn =
    BuiltIn { name: "configs/sonar8.ron", text: include_str!("../../../configs/sonar8.ron") };
