//! The answers to files that are not worlds.

use crate::typed::{Shell, shipped};

/// Checks that both commands refuse the file with these words.
#[track_caller]
fn refuse(name: &str, content: impl AsRef<[u8]>, expected: &[&str]) {
    let shell = Shell::new();
    shell.write(name, content);
    for command in [format!("explore {name}"), format!("truth {name} --out t.csv")] {
        shell.refuse(&command, expected);
        shell.refuse(&command, &[&format!("{name}: is "), "no world"]);
    }
}

#[test]
fn our_own_files_are_told_from_worlds() {
    let survey = "(walls: [(from: (0.0, 0.0), to: (1.0, 0.0), seen_from: Left, thickness: 0.1)], \
                  posts: [], solids: [Circle(center: (1.0, 1.0), radius: 0.2)])";
    refuse("truth.ron", survey, &["a survey of a building", "readings LOG --truth truth.ron"]);
    let config = std::fs::read(shipped("configs/b21r.ron")).unwrap();
    refuse("robot.ron", config, &["a configuration", "--config robot.ron"]);
    let campaign = std::fs::read(shipped("configs/fig7.ron")).unwrap();
    refuse("fig7.ron", campaign, &["a campaign", "cargo xtask campaign fig7.ron"]);
    let fit = std::fs::read(shipped("configs/fit/b21r.ron")).unwrap();
    refuse("fit.ron", fit, &["fitted to", "cargo xtask fit fit.ron"]);
    refuse("trace.jsonl", "{\"covmap_trace\":1}", &["the trace of a run", "cargo xtask explain"]);
    refuse("belief.bin", "COVMAP\u{1}", &["the posterior of a map", "map.yaml"]);
}

#[test]
fn files_of_others_are_named() {
    let bags = "makes a map of a bag in an MCAP file";
    refuse("drive.bag", "#ROSBAG V2.0\n", &["a bag of ROS 1", bags, "cargo xtask map"]);
    refuse("drive_0.db3", "SQLite format 3\0....", &["a bag of ROS 2", bags]);
    refuse("drive.mcap", b"\x89MCAP0\r\n\x01", &["a bag of ROS 2", bags]);
    refuse("metadata.yaml", "rosbag2_bagfile_information:\n  version: 5\n", &["a bag of ROS 2"]);
    refuse("freiburg.map", "CARMENMAPFILEv020\u{10}", &["a map of CARMEN", "map_server"]);
    refuse("packed.map", b"\x1f\x8b\x08\0", &["a packed map of CARMEN"]);
    refuse("house.json", "{\n \"verts\": [[0.1, 0.2]]}", &["a house of HouseExpo", "scenario"]);
    refuse("other.json", "[1, 2]", &["a file of JSON"]);
    refuse("simple.world", "# a world\ninclude \"map.inc\"\n", &["a world of Stage", "PNG"]);
    refuse(
        "gazebo.world",
        "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\">",
        &["a world of Gazebo"],
    );
    let log = "# CARMEN Logfile\nPARAM robot_front_laser_max 80 0 host 0\n";
    refuse("corridor.log", log, &["a log of CARMEN", "cargo xtask map corridor.log"]);
    refuse("corridor.log.gz", b"\x1f\x8b\x08\0", &["packed with gzip", "cargo xtask map"]);
    refuse("plan.dxf", "0\nSECTION\n", &["a drawing"]);
}

#[test]
fn an_image_wants_its_description() {
    let png = b"\x89PNG\r\n\x1a\n";
    refuse("room.png", png, &["an image", "`image: room.png`", "free_thresh", "YAML"]);
    refuse("room.pgm", "P5 1 1 255 a", &["an image", "`image: room.pgm`"]);
    refuse("room.jpg", b"\xff\xd8\xff\xe0", &["an image", "make it PNG"]);
    let shell = Shell::new();
    shell.write("room.png", png);
    shell.write("room.yaml", "image: room.png\n");
    shell.refuse("explore room.png", &["give the YAML file that describes it, room.yaml"]);
}

#[test]
fn folders_are_told_apart() {
    let shell = Shell::new();
    for (folder, file, expected) in [
        ("log", "od.txt", "cargo xtask map log"),
        ("run", "map.yaml", "give its map, run/map.yaml"),
        ("bag", "metadata.yaml", "a bag of ROS 2"),
        ("some", "thing", "a scenario (.ron) or a map of map_server (.yaml)"),
    ] {
        std::fs::create_dir(shell.path(folder)).unwrap();
        shell.write(&format!("{folder}/{file}"), "");
        shell.refuse(&format!("explore {folder}"), &[&format!("{folder}: is a folder"), expected]);
    }
}

#[test]
fn what_is_nothing_known_or_not_there_is_said_so() {
    let shell = Shell::new();
    shell.write("notes.txt", "to do");
    let neither = "notes.txt: a world is a scenario (.ron) or a map of map_server (.yaml)";
    shell.refuse("explore notes.txt", &[neither]);
    shell.refuse("explore none.png", &["none.png: cannot be read: No such file"]);
    shell.refuse("explore none.ron", &["none.ron: cannot be read: No such file"]);
    // A scenario with a fault is recognised as a scenario.
    shell.write("room.ron", "(name: \"a\", extent: (width: 3, height: 2), walls: [])");
    shell.refuse("explore room.ron", &["room.ron:1:", "walls"]);
}
