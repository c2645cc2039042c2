//! The kind of a file that was given as a world and is none, and the command that reads it.

use crate::error::{Fault, LabError, about};
use covmap_io::{Signature, read_beginning, read_ron, signature};
use covmap_log::is_of_a_log;
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::Path;

/// Length of a file's beginning that tells its kind \[bytes\].
const BEGINNING: usize = 4096;
const NEITHER: &str = "a world is a scenario (.ron) or a map of map_server (.yaml)";

/// The error for a file that could be a world by its name, and is none: the kind of the file and the
/// command that reads it, if the kind can be told.
pub(super) fn explained(file: &Path, fault: LabError) -> LabError {
    in_words(file, of_ron(file).or_else(|| of_content(file))).unwrap_or(fault)
}

/// The error for a file or folder whose name does not have the ending of a world.
pub(super) fn no_world(file: &Path) -> LabError {
    if let Some(error) = in_words(file, of_folder(file)) {
        return error;
    }
    match read_beginning(file, 1) {
        Err(error) => Fault::NoWorld(format!("{error}; {NEITHER}")).into(),
        Ok(_) => explained(file, no_world_at(file, NEITHER.to_owned())),
    }
}

fn in_words(file: &Path, kind: Option<Kind>) -> Option<LabError> {
    let Kind { what, reader } = kind?;
    Some(no_world_at(file, format!("is {what}, and no world: {reader}")))
}

fn no_world_at(file: &Path, why: String) -> LabError {
    about(file)(Fault::NoWorld(why))
}

struct Kind {
    what: &'static str,
    reader: String,
}

fn kind(what: &'static str, reader: impl Into<String>) -> Option<Kind> {
    Some(Kind { what, reader: reader.into() })
}

/// The fields at the top of our own files.
#[derive(Deserialize)]
struct Fields {
    extent: Option<IgnoredAny>,
    obstacles: Option<IgnoredAny>,
    walls: Option<IgnoredAny>,
    posts: Option<IgnoredAny>,
    robot: Option<IgnoredAny>,
    planner: Option<IgnoredAny>,
    worlds: Option<IgnoredAny>,
    settings: Option<IgnoredAny>,
    training: Option<IgnoredAny>,
    axes: Option<IgnoredAny>,
}

fn of_ron(file: &Path) -> Option<Kind> {
    let name = file.display();
    let fields: Fields = has_ending(file, &["ron"]).then(|| read_ron(file).ok())??;
    match fields {
        Fields { extent: Some(_), .. } | Fields { obstacles: Some(_), .. } => None,
        Fields { walls: Some(_), .. } | Fields { posts: Some(_), .. } => kind(
            "a survey of a building, by `cargo xtask survey`",
            format!(
                "`cargo xtask readings LOG --truth {name}` and the recorded examples of \
                 `cargo xtask fit` read it; a scenario has `extent` and `obstacles`, whose shapes \
                 its walls can be"
            ),
        ),
        Fields { robot: Some(_), .. } | Fields { planner: Some(_), .. } => kind(
            "a configuration of robot, sensor model and planner",
            format!("give a world, and it as `--config {name}`"),
        ),
        Fields { worlds: Some(_), .. } | Fields { settings: Some(_), .. } => {
            kind("a campaign", format!("`cargo xtask campaign {name}` runs it"))
        }
        Fields { training: Some(_), .. } | Fields { axes: Some(_), .. } => {
            kind("what a sensor model is fitted to", format!("`cargo xtask fit {name}` reads it"))
        }
        _ => None,
    }
}

fn of_folder(folder: &Path) -> Option<Kind> {
    let has = |name: &str| folder.join(name).exists();
    let name = folder.display();
    match folder.is_dir() {
        false => None,
        true if has("od.txt") => {
            kind("a folder with a log", format!("`cargo xtask map {name}` makes the map of it"))
        }
        true if has("map.yaml") => kind(
            "a folder of results",
            format!("give its map, {}", folder.join("map.yaml").display()),
        ),
        true if has("metadata.yaml") => kind("a folder with a bag of ROS 2", BAGS),
        true => kind("a folder", NEITHER),
    }
}

const BAGS: &str = "no world; `cargo xtask map` makes a map of a bag in an MCAP file, which the Python \
                    package `rosbags` makes of any other bag";
const PLANS: &str = "nothing here reads it; draw it as a PNG or PGM image, and describe that in a \
                     YAML file as map_server does, or write its walls as a scenario (.ron)";

/// Endings that tell the kind of a file when its content does not.
const ENDINGS: [(&[&str], &str, &str); 8] = [
    (&["bag"], "a bag of ROS 1", BAGS),
    (&["db3", "mcap"], "a bag of ROS 2", BAGS),
    (&["world", "inc", "cfg"], "a world of Stage", PLANS),
    (&["sdf", "urdf", "xacro"], "a model of Gazebo", PLANS),
    (&["dxf", "dwg", "svg", "pdf"], "a drawing", PLANS),
    (&["bt", "ot"], "a map of OctoMap", PLANS),
    (&["pbstream"], "a state of Cartographer", PLANS),
    (&["json"], "a file of JSON", PLANS),
];

fn of_content(file: &Path) -> Option<Kind> {
    let bytes = read_beginning(file, BEGINNING).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let name = file.display();
    match signature(&bytes) {
        Some(Signature::RosBag) => return kind("a bag of ROS 1", BAGS),
        Some(Signature::Sqlite | Signature::Mcap) => return kind("a bag of ROS 2", BAGS),
        Some(Signature::CarmenMap) => return kind("a map of CARMEN", PLANS),
        Some(Signature::Gzip) if has_ending(file, &["map"]) => {
            return kind("a packed map of CARMEN", PLANS);
        }
        Some(Signature::Gzip) => {
            let reader = format!("if it is a log of CARMEN, `cargo xtask map {name}` reads it");
            return kind("packed with gzip", reader);
        }
        Some(Signature::MapImage) => return image(file),
        Some(Signature::Jpeg | Signature::Gif) => {
            return kind(
                "an image",
                "make it PNG, and describe it in a YAML file as map_server does",
            );
        }
        None if bytes.starts_with(b"COVMAP") => {
            return kind("the posterior of a map", "give the map.yaml beside it");
        }
        Some(Signature::Archive | Signature::Packed) | None => {}
    }
    for (word, what, reader) in [
        ("\"verts\"", "a house of HouseExpo", PLANS),
        ("\"covmap_trace\"", "the trace of a run", "`cargo xtask explain` reads its folder"),
        ("rosbag2_bagfile_information", "the description of a bag of ROS 2", BAGS),
        ("<sdf", "a world of Gazebo", PLANS),
    ] {
        if text.contains(word) {
            return kind(what, reader);
        }
    }
    if bytes.split(|byte| *byte == b'\n').any(is_of_a_log) {
        return kind("a log of CARMEN", format!("`cargo xtask map {name}` makes the map of it"));
    }
    let known = ENDINGS.iter().find(|(endings, ..)| has_ending(file, endings));
    known.and_then(|(_, what, reader)| kind(what, *reader))
}

/// An image, which a YAML file beside it may describe.
fn image(file: &Path) -> Option<Kind> {
    let yaml = file.with_extension("yaml");
    if yaml.exists() {
        return kind(
            "an image",
            format!("give the YAML file that describes it, {}", yaml.display()),
        );
    }
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let reader = format!(
        "describe it in a YAML file as map_server does, and give that: `image: {name}`, \
         `resolution` [m], `origin: [0, 0, 0]`, `negate: 0`, `occupied_thresh: 0.65`, \
         `free_thresh: 0.196`"
    );
    kind("an image", reader)
}

fn has_ending(file: &Path, endings: &[&str]) -> bool {
    let found = file.extension().unwrap_or_default();
    endings.iter().any(|ending| found.eq_ignore_ascii_case(ending))
}
