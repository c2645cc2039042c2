//! Invalid scenarios, configurations, arguments and folders.

use crate::typed::{Shell, shipped};

/// Refuses a scenario in which a part of a good one is replaced.
#[track_caller]
fn refuse(part: &str, instead: &str, expected: &[&str]) {
    let good = "(
    name: \"room\",
    extent: (width: 4.0, height: 3.0),
    start: (x: 1.0, y: 1.0, heading: 0.0),
    obstacles: [
        (shape: Rectangle(center: (3.0, 2.0), size: (0.5, 0.5), angle: 0.0), surface: Rough),
    ],
)";
    assert!(good.contains(part));
    let shell = Shell::new();
    shell.write("room.ron", good.replace(part, instead));
    shell.refuse("explore room.ron --max-scans 1", &[&["room.ron"], expected].concat());
}

/// Refuses the shipped configuration with one line, that of a field, replaced.
#[track_caller]
fn refuse_config(field: &str, instead: &str, expected: &[&str]) {
    refuse_config_of("configs/b21r.ron", field, instead, expected);
}

#[track_caller]
fn refuse_config_of(config: &str, field: &str, instead: &str, expected: &[&str]) {
    let good = std::fs::read_to_string(shipped(config)).unwrap();
    let is_field = |line: &str| line.trim_start().starts_with(&format!("{field}:"));
    assert_eq!(good.lines().filter(|line| is_field(line)).count(), 1, "{field}");
    let lines = good.lines().map(|line| if is_field(line) { instead } else { line });
    let shell = Shell::new();
    shell.write("robot.ron", lines.collect::<Vec<_>>().join("\n"));
    let lab = shipped("scenarios/lab.ron");
    let line = format!("explore {lab} --config robot.ron --max-scans 1");
    shell.refuse(&line, &[&["robot.ron"], expected].concat());
}

#[test]
fn an_error_in_a_scenario_names_file_line_column_and_field() {
    refuse("surface: Rough", "surface: Rouhg", &["room.ron:6:", "obstacles[0].surface", "Rouhg"]);
    refuse("width: 4.0", "widht: 4.0", &["room.ron:3:", "extent", "widht"]);
    refuse("width: 4.0, ", "", &["room.ron:3:", "extent", "width"]);
    refuse("height: 3.0", "height: \"3\"", &["room.ron:3:", "extent.height"]);
    refuse("],\n)", "", &["room.ron:"]);
    refuse("Rectangle(", "Blob(", &["room.ron:6:", "obstacles[0].shape", "Blob"]);
}

#[test]
fn absurd_worlds_are_refused() {
    refuse("width: 4.0", "width: NaN", &["NaN"]);
    refuse("width: 4.0", "width: -4.0", &["-4"]);
    refuse("width: 4.0, height: 3.0", "width: 9000.0, height: 9000.0", &["20000000 cells"]);
    refuse("size: (0.5, 0.5)", "size: (0.5, -0.5)", &["obstacle 0", "-0.5"]);
    refuse("size: (0.5, 0.5)", "size: (inf, 0.5)", &["obstacle 0", "inf"]);
    refuse("\"room\"", "\"a/b\"", &["name"]);
    refuse("\"room\"", "\"\"", &["name"]);
}

#[test]
fn impossible_starts_are_refused() {
    refuse("x: 1.0, y: 1.0", "x: 3.0, y: 2.0", &["start (3, 2)", "inside an obstacle"]);
    refuse("x: 1.0, y: 1.0", "x: 0.1, y: 1.0", &["start (0.1, 1)", "0.27"]);
    refuse("x: 1.0, y: 1.0", "x: 9.0, y: 1.0", &["start (9, 1"]);
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    shell.refuse(&format!("explore {lab} --start 1.9,2.4,0"), &["lab.ron", "(1.9, 2.4)"]);
    shell.refuse(&format!("explore {lab} --start -1,2,0"), &["lab.ron", "(-1, 2)"]);
}

#[test]
fn polygons_that_are_none_are_refused() {
    let rectangle = "Rectangle(center: (3.0, 2.0), size: (0.5, 0.5), angle: 0.0)";
    let polygon = |points: &str| format!("Polygon([{points}])");
    refuse(rectangle, &polygon("(2.0, 2.0), (3.0, 2.0)"), &["obstacle 0", "at least 3"]);
    let crossing = polygon("(2.0, 1.0), (3.0, 2.0), (3.0, 0.5), (2.0, 2.0)");
    refuse(rectangle, &crossing, &["obstacle 0", "cross"]);
    refuse(rectangle, &polygon("(2.0, 1.0), (3.0, 1.0), (2.5, 1.0)"), &["obstacle 0"]);
}

#[test]
fn an_error_in_a_configuration_names_file_line_column_and_field() {
    refuse_config("speed", "sped: 0.5,", &["robot.ron:", "robot", "sped"]);
    refuse_config("chance", "", &["robot.ron:", "model", "chance"]);
    refuse_config("update", "update: Guess((", &["robot.ron:", "model.update", "Guess"]);
    let paper = "configs/paper.ron";
    refuse_config_of(paper, "tempering", "", &["robot.ron:", "model", "tempering"]);
    refuse_config("strategy", "strategy: Fbe,", &["robot.ron:", "planner.strategy", "Fbe"]);
}

#[test]
fn impossible_configurations_are_refused() {
    let sigmas = ["model.sigma_in", "σ_in 0.01", "σ_out"];
    refuse_config_of("configs/paper.ron", "sigma_in", "sigma_in: 0.01,", &sigmas);
    let unpredicted = ["planner.gain", "MutualInformation", "Eq14"];
    refuse_config_of("configs/paper.ron", "gain", "gain: MutualInformation,", &unpredicted);
    refuse_config("sigma_behind", "sigma_behind: 0.01,", &["model.sigma_behind", "0.01", "0.05"]);
    refuse_config("bearings", "bearings: 99,", &["model.bearings", "99", "1..=16"]);
    refuse_config("radius", "radius: -0.27,", &["robot.radius", "-0.27"]);
    refuse_config("bins", "bins: 1,", &["model.bins", "1"]);
    let name = "planner.entropy_threshold";
    refuse_config("entropy_threshold", "entropy_threshold: NaN,", &[name, "NaN"]);
    refuse_config("resolution", "resolution: 0.0,", &["resolution", "0"]);
    refuse_config("usable_range", "usable_range: 1000.0,", &["model.usable_range", "1000"]);
    refuse_config("noise_min", "noise_min: -1.0,", &["noise_min", "-1"]);
    refuse_config("ring", "ring: Sensors([]),", &["robot.ring", "0 sensors"]);
}

#[test]
fn files_that_are_no_worlds_are_refused() {
    let shell = Shell::new();
    shell.refuse("explore none.ron", &["none.ron: cannot be read"]);
    shell.write("empty.ron", "");
    shell.refuse("explore empty.ron", &["empty.ron:1:"]);
    shell.write("binary.ron", [0xff, 0xfe, 0x00]);
    shell.refuse("explore binary.ron", &["binary.ron: is not a text file"]);
    shell.write("world.txt", "");
    for world in ["world.txt", "world", "."] {
        shell.refuse(&format!("explore {world}"), &[world, "a scenario (.ron)", "(.yaml)"]);
    }
    shell.refuse("truth none.ron --out t.csv", &["none.ron: cannot be read"]);
    shell.refuse("model --config none.ron --range 1 --out m.csv", &["none.ron: cannot be read"]);
    std::fs::create_dir(shell.path("folder.ron")).unwrap();
    shell.refuse("explore folder.ron", &["folder.ron: cannot be read"]);
}

#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    shell.write("file", "");
    shell.refuse(&format!("explore {lab} --out file"), &["file: is a file"]);
    shell.refuse(&format!("explore {lab} --out file/run"), &["file/run"]);
    shell.refuse(&format!("explore {lab} --out /proc/none/run"), &["/proc/none"]);
    // If the test runs in a folder that also holds the repository, the repository is the reason.
    let typed = shell.expect(&format!("explore {lab} --out .."), 2);
    let reasons = ["is no name for an output folder", "which this command reads"];
    assert!(reasons.iter().any(|reason| typed.err.contains(reason)), "{typed:?}");
}

#[test]
fn wrong_arguments_are_refused() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    for wrong in [
        "--strategy FBE",
        "--strategy IG_CL:-1",
        "--resolution 0",
        "--resolution nan",
        "--resolution 1e-9",
        "--while-driving 0",
        "--max-scans 0",
        "--seed -1",
        "--start 1,2",
        "--start 1,2,inf",
        "--seeds 3",
    ] {
        let typed = shell.expect(&format!("explore {lab} {wrong}"), 2);
        assert!(typed.err.starts_with("error: ") && !typed.err.contains("panicked"), "{typed:?}");
        assert!(shell.files().is_empty());
    }
    shell.expect("", 2);
    shell.expect("model --range -1 --out m.csv", 2);
}

#[test]
fn what_would_take_too_much_memory_is_refused_before_it_does() {
    let (shell, lab) = (Shell::new(), shipped("scenarios/lab.ron"));
    let room = |side: &str| {
        format!("(name: \"room\", extent: (width: {side}, height: {side}), obstacles: [])")
    };
    shell.write("plain.ron", room("1000"));
    let more = |allowed: &str| format!("of memory, more than {allowed}; use a coarser resolution");
    let parts = &["plain.ron", "4004 × 4004 cells", "GiB", &more("4.0 GiB")];
    shell.refuse("explore plain.ron --resolution 0.25", parts);
    shell.refuse(&format!("explore {lab} --memory 0.01"), &["24 sensors", &more("10 MiB")]);
    let config = std::fs::read_to_string(shipped("configs/b21r.ron")).unwrap();
    let ring =
        "ring: Circle(count: 4096, radius: 0.25, half_angle: 0.2, min_range: 0.1, max_range: 10)";
    let fine = config
        .replace("ring: B21r", ring)
        .replace("footprint: Sectors", "footprint: Cones")
        .replace("resolution: 0.1", "resolution: 0.02");
    assert!(fine != config);
    shell.write("fine.ron", fine);
    shell.refuse(
        &format!("explore {lab} --config fine.ron"),
        &["fine.ron", "4096 sensors", &more("4.0 GiB")],
    );
    let typed = shell.expect(&format!("explore {lab} --memory 0"), 2);
    assert!(typed.err.contains("--memory"), "{typed:?}");
}

#[test]
fn what_is_wrong_with_a_scenario_is_said_for_its_true_reason() {
    let bow = "Polygon([(1,1), (1,1), (3,3), (3,1), (1,3)])";
    let good = "Rectangle(center: (3.0, 2.0), size: (0.5, 0.5), angle: 0.0)";
    refuse(good, bow, &["obstacle 0", "points 0 and 3 cross or touch near (2.000, 2.000)"]);
    let line = "Polygon([(1,1), (3,3), (2,2)])";
    refuse(good, line, &["obstacle 0", "lie on a line"]);
    refuse("heading: 0.0", "heading: 1e300", &["heading of 1e300 rad must lie within ±1000000"]);
    refuse("x: 1.0", "x: 1e300", &["the start (1e300, 1) must lie inside the extent"]);
    refuse("width: 4.0", "width: 1e300", &["the extent of 1e300 × 3 m"]);
    refuse("(0.5, 0.5)", "(1e300, 0.5)", &["1e300 must be a finite number"]);
    refuse_config("radius", "radius: 1e300,", &["robot.radius: 1e300 must lie"]);
    refuse_config("usable_range", "usable_range: 1e300,", &["model.usable_range: 1e300 must"]);
}
