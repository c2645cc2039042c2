//! The configurations that the experiments are made with, as shipped.

use covmap_lab::files::BuiltIn;

/// The paper's, without our additions.
pub(crate) const PAPER: BuiltIn =
    BuiltIn { name: "configs/paper.ron", text: include_str!("../../../configs/paper.ron") };
/// The default.
pub(crate) const B21R: BuiltIn =
    BuiltIn { name: "configs/b21r.ron", text: include_str!("../../../configs/b21r.ron") };
/// That of a robot with eight sonars.
pub(crate) const SONAR8: BuiltIn =
    BuiltIn { name: "configs/sonar8.ron", text: include_str!("../../../configs/sonar8.ron") };
