//! A layout for the viewer Foxglove: what it shows of a bag when it opens it.

use anyhow::Result;
use covmap_io::{NewFile, Replace};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes the layout beside a bag, `FILE.foxglove.json`; returns its name.
pub(super) fn write(bag: &Path, replace: Replace) -> Result<PathBuf> {
    let path = bag.with_extension("foxglove.json");
    let mut file = NewFile::create(&path, replace)?;
    file.write_all(serde_json::to_string_pretty(&layout())?.as_bytes())?;
    file.write_all(b"\n")?;
    file.finish()?;
    Ok(path)
}

/// A view from above of the map, the path, the robot's frames and its candidates; the entropy is there to be
/// switched on.
fn layout() -> Value {
    let map = |visible: bool, colors: &str| json!({ "visible": visible, "colorMode": colors });
    json!({
        "configById": {
            "3D!map": {
                "cameraState": {
                    "perspective": false, "distance": 20, "phi": 0, "thetaOffset": 90,
                    "targetOffset": [5, 5, 0], "target": [0, 0, 0], "targetOrientation": [0, 0, 0, 1],
                    "fovy": 45, "near": 0.5, "far": 5000
                },
                "followMode": "follow-none",
                "followTf": "map",
                "scene": {},
                "transforms": {},
                "topics": {
                    "/map": map(true, "map"),
                    "/entropy": map(false, "costmap"),
                    "/certificate": map(false, "costmap"),
                    "/path": { "visible": true },
                    "/candidates": { "visible": true }
                },
                "layers": {}
            }
        },
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": { "speed": 5 },
        "layout": "3D!map"
    })
}
