//! What is read from a bag.

/// The wanted parts of a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BagOptions {
    /// Topics of the sensors; all of the wanted kind if there are none here.
    pub topics: Vec<String>,
    /// The frame of the map; `map` if the robot's frame hangs on it, else the root of the robot's frame.
    pub map_frame: Option<String>,
    /// The frame of the robot's centre.
    pub base_frame: String,
}

impl Default for BagOptions {
    fn default() -> Self {
        Self { topics: Vec::new(), map_frame: None, base_frame: "base_link".to_owned() }
    }
}
