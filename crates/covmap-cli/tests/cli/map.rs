//! `map` and `log`.

use crate::typed::{Shell, shipped};
use covmap::CoverageMap;
use covmap_explore::Event;
use covmap_io::{MapCell, load_map_server, read_json_lines};
use covmap_lab::TraceHeader;
use covmap_log::{BagOptions, LogOptions, LogReader, Sensor};
use covmap_sonar::{Range, Scan, SonarRing};
use std::fmt::Write;
use std::path::Path;

const FILES: [&str; 8] = [
    "summary.json",
    "readings.csv",
    "belief.bin",
    "map.pgm",
    "map.yaml",
    "coverage.png",
    "entropy.png",
    "occupancy.png",
];
const KEYS: [&str; 15] = [
    "world",
    "sensor",
    "resolution",
    "frames",
    "skipped",
    "standing",
    "scans",
    "jumps",
    "path_length_m",
    "cells",
    "share_entropy_above_0_65",
    "seconds",
    "readings",
    "taken_from",
    "remarks",
];

/// Returns the log of two sonars that face ahead and to the left; the robot stands, then drives for
/// a metre.
fn drive() -> String {
    let mut log = String::new();
    for i in 0..30u32 {
        let (t, x) = (0.2 * f64::from(i), 0.05 * f64::from(i.saturating_sub(9)));
        writeln!(log, "ODOM {x} 0 0 0 0 0 {t} h {t}").unwrap();
        let ahead = 2.0 - x;
        writeln!(log, "SONAR 0.3 2 {ahead} 1.0 0.2 0 0 0 0.2 1.5707963 {t} h {t}").unwrap();
    }
    log
}

#[test]
fn a_log_becomes_a_map_with_all_its_files() {
    let shell = Shell::new();
    shell.write("drive.log", drive());
    let typed = shell.expect("map drive.log --resolution 0.1 --every 0.08", 0);
    assert!(typed.out.contains("30 frames") && typed.out.contains(", 0 skipped"), "{typed:?}");
    assert!(!typed.out.contains("skipped 0 of"), "{typed:?}");
    assert_eq!(typed.err, "", "nothing of the progress when piped");
    let folder = shell.path("out/drive-sonar-every0.08");
    for name in FILES {
        assert!(std::fs::metadata(folder.join(name)).unwrap().len() > 0, "{name}");
    }
    let summary = shell.json("out/drive-sonar-every0.08/summary.json");
    let fields = summary.as_object().unwrap();
    for key in KEYS {
        assert!(fields.get(key).is_some_and(|value| !value.is_null()), "{key}");
    }
    assert_eq!(fields.len(), KEYS.len());
    // The first, and every second of the 20 steps of .05 m.
    assert_eq!((&summary["scans"], &summary["standing"]), (&11.into(), &19.into()));
    assert!((summary["path_length_m"].as_f64().unwrap() - 1.0).abs() < 1e-9);

    let belief = std::fs::read(folder.join("belief.bin")).unwrap();
    let map = CoverageMap::from_bytes(&belief).unwrap();
    let mode = |x, y| map.mode(map.grid().cell_at(nalgebra::Point2::new(x, y)).unwrap());
    assert!(mode(1.0, 0.05) < 0.1 && mode(0.5, 0.05) < 0.1, "free on the way");
    assert!(mode(2.25, 0.05) > 0.9 && mode(0.45, 1.25) > 0.9, "covered where the echoes are from");
    let saved = load_map_server(folder.join("map.yaml")).unwrap();
    let driven = saved.grid.cell_at(nalgebra::Point2::new(1.0, 0.05)).unwrap();
    assert_eq!(saved.cells.get(driven), Some(&MapCell::Occupancy(0.0)));
    let image = std::fs::read(folder.join("map.pgm")).unwrap();
    let greys = &image[image.len() - map.grid().len()..];
    let count = |grey: u8| greys.iter().filter(|g| **g == grey).count();
    let line =
        format!("map.pgm: {} free, {} occupied, {} unknown", count(254), count(0), count(205));
    assert!(typed.out.contains(&line), "{typed:?}");
}

#[test]
fn every_frame_can_be_used_and_quiet_is_quiet() {
    let shell = Shell::new();
    shell.write("drive.log", drive());
    let typed = shell.expect("map drive.log --every 0 --out all --quiet", 0);
    assert_eq!((typed.out.as_str(), typed.err.as_str()), ("", ""));
    assert_eq!(shell.json("all/summary.json")["scans"], 30);
}

#[test]
fn what_is_lost_of_a_log_is_said() {
    let shell = Shell::new();
    let cut = drive().replace("1.15 1.0 0.2", "1.15 x 0.2");
    assert_ne!(cut, drive());
    shell.write("cut.log", cut.trim_end().trim_end_matches("h 5.800000000000001"));
    let typed = shell.expect("map cut.log --out cut", 0);
    let words = "skipped 2 of 30 frames: 2 cut short or unreadable (the first: cut.log:";
    assert!(typed.out.contains(words) && typed.out.contains("range 1: `x`"), "{typed:?}");
    let summary = shell.json("cut/summary.json");
    assert_eq!(summary["skipped"], 2);
    assert!(summary["warning"].as_str().unwrap().starts_with("skipped 2 of 30"));
}

#[test]
fn a_jump_of_the_poses_is_not_driven() {
    let shell = Shell::new();
    shell.write("drive.log", drive());
    let pose = |i: u32| format!("{} {} 0 0\n", 200 * i, if i < 15 { 0.0 } else { 4.0 });
    shell.write("poses.txt", (0..30).map(pose).collect::<String>());
    let typed = shell.expect("map drive.log --poses poses.txt --out jump", 0);
    assert!(typed.out.contains("1 jumps") && typed.out.contains("0.0 m driven"), "{typed:?}");
}

#[test]
fn bad_logs_are_refused() {
    let shell = Shell::new();
    shell.refuse("map none.log", &["none.log: cannot be read"]);
    shell.write("empty.log", "");
    shell.refuse("map empty.log", &["empty.log: has no scan", "there is no line SONAR"]);
    shell.refuse("map empty.log --sensor laser", &["no line FLASER, ROBOTLASER or RAWLASER"]);
    shell.write("binary.log", [0xff, 0xfe, 0x00]);
    shell.refuse("map binary.log", &["binary.log: has no scan"]);
    shell.write("packed.log", [0x1f, 0x8b, 8, 0, 1, 2]);
    shell.refuse("map packed.log", &["packed.log:1: the gzip data are damaged or cut short"]);
    shell.write("long.log", vec![b'1'; 2 << 20]);
    shell.refuse("map long.log", &["long.log:1: the line has more than 1048576 bytes"]);
    let unposed = drive().lines().filter(|l| !l.starts_with("ODOM")).collect::<Vec<_>>().join("\n");
    shell.write("unposed.log", unposed);
    shell.refuse("map unposed.log", &["skipped 30 of 30 frames: 30 without a pose", "log:1:"]);
    shell.write("poses.txt", "a,b\n1,2\n");
    shell.refuse("map unposed.log --poses none.txt", &["none.txt: cannot be read"]);
    shell.refuse("map unposed.log --poses poses.txt", &["30 without a pose", "poses.txt:1: time"]);
    shell.refuse("map /dev/zero", &["/dev/zero: is no file"]);
    shell.write("far.log", drive() + "ODOM 9e6 9e6 0 0 0 0 6 h 6\n" + SONAR_AT_6);
    shell.refuse("map far.log", &["far.log: the robot was between", "20000000 cells"]);
    shell.write("config.ron", "");
    shell.refuse("map far.log --config config.ron", &["config.ron:1:"]);
    for wrong in
        ["--every -1", "--every nan", "--every-degrees x", "--sensor radar", "--resolution 0"]
    {
        let typed = shell.expect(&format!("map far.log {wrong}"), 2);
        assert!(typed.err.starts_with("error: "), "{typed:?}");
    }
}

const SONAR_AT_6: &str = "SONAR 0.3 2 1.0 1.0 0.2 0 0 0 0.2 1.5707963 6 h 6\n";

#[test]
fn bad_folders_are_refused() {
    let shell = Shell::new();
    std::fs::create_dir(shell.path("log")).unwrap();
    shell.refuse("map log", &["log: is a folder without sonar.txt"]);
    shell.write("log/sonar.txt", "1000 500 500 500\n2000 500 500 500\n");
    shell.refuse("map log", &["log: is a folder without od.txt"]);
    shell.write("log/od.txt", "1000 0 0 0\n2000 9 0 0\n");
    let few = "2 with a wrong number of ranges (the first: log/sonar.txt:1: ranges: there are 3, but the ring has 8)";
    shell.refuse("map log", &["sonar.txt: has no scan", few]);
    shell.refuse("map log --sensor laser", &["log: is a folder without laser.txt"]);
}

/// Returns the scans of a run's trace.
fn scans(trace: &Path) -> Vec<Scan> {
    let events = read_json_lines::<Event>(trace).unwrap().skip(1);
    let scan = |event| match event {
        Event::Scan { scan, .. } => Some(scan),
        _ => None,
    };
    events.filter_map(|event| scan(event.unwrap())).collect()
}

#[test]
fn the_log_of_a_run_is_read_back_as_the_same_scans() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    shell.expect(&format!("explore {lab} --resolution 0.2 --max-scans 12 --out run"), 3);
    let typed = shell.expect("log run --out run.log", 0);
    assert!(typed.out.contains("12 scans"), "{typed:?}");
    let trace = shell.path("run/trace.jsonl");
    let header: TraceHeader = read_json_lines(&trace).unwrap().next().unwrap().unwrap();
    let ring = SonarRing::from_specification(&header.config.robot.ring).unwrap();
    // The log states everything about the ring.
    let other = SonarRing::new(ring.beams()[..1].to_vec()).unwrap();
    let options =
        LogOptions { sensor: Sensor::Sonar, ring: other, poses: None, bag: BagOptions::default() };
    let mut log = LogReader::open(shell.path("run.log"), &options).unwrap();
    let expected = scans(&trace);
    assert_eq!(expected.len(), 12);
    for scan in &expected {
        let frame = log.next().unwrap().unwrap();
        assert_eq!(&frame.scan.ranges, &scan.ranges);
        assert_eq!(frame.scan.time.to_bits(), scan.time.to_bits());
        assert_eq!(frame.scan.pose.translation, scan.pose.translation);
        assert!(frame.scan.pose.rotation.angle_to(&scan.pose.rotation).abs() < 1e-15);
        for (a, b) in frame.ring.beams().iter().zip(ring.beams()) {
            assert!((a.pose.translation.vector - b.pose.translation.vector).norm() < 1e-15);
            assert!((a.half_angle - b.half_angle).abs() < 1e-15);
        }
    }
    assert!(log.next().is_none() && log.skipped().is_empty());
    assert!(expected.iter().flat_map(|scan| &scan.ranges).any(|range| *range == Range::NoEcho));

    let typed = shell.expect("map run.log --resolution 0.2 --every 0 --out map", 0);
    assert!(typed.out.contains("a map of 12 scans"), "{typed:?}");
    assert!(!typed.out.contains("instead of sectors"), "{typed:?}");
    // The robot drove for metres between two scans, and round corners.
    let driven = |name: &str| shell.json(name)["path_length_m"].as_f64().unwrap();
    let lost = driven("run/summary.json") - driven("map/summary.json");
    assert!(lost.abs() < 0.03 && driven("run/summary.json") > 1.0, "{lost}");
    assert_eq!(shell.json("map/summary.json")["jumps"], 0);
    shell.refuse("log nowhere --out a.log", &["nowhere/trace.jsonl: cannot be read"]);
    shell.refuse("log run --out run", &["run: cannot be written: it is a folder"]);
}

#[test]
fn a_run_whose_trace_is_damaged_has_no_log() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    shell.expect(&format!("explore {lab} --resolution 0.2 --max-scans 2 --out run"), 3);
    let trace = std::fs::read_to_string(shell.path("run/trace.jsonl")).unwrap();
    shell.write("run/trace.jsonl", trace.replacen("\"NoEcho\"", "\"Nothing\"", 1));
    shell.refuse("log run --out run.log", &["run/trace.jsonl:", "Nothing"]);
}

#[test]
#[allow(clippy::print_stdout, reason = "a test that is skipped says so")]
fn real_logs_become_maps() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let data = root.join("../shared/data/sonar8");
    let Ok(data) = data.canonicalize() else {
        println!("skipped: there are no logs in {}", data.display());
        return;
    };
    let shell = Shell::new();
    let log = data.join("test1").to_str().unwrap().to_owned();
    let poses = data.join("test1_poses_corrected.txt").to_str().unwrap().to_owned();
    for (sensor, most) in [("sonar", 0.4), ("laser", 0.1)] {
        let line =
            format!("map {log} --poses {poses} --sensor {sensor} --resolution 0.2 --out {sensor}");
        shell.expect(&line, 0);
        let summary = shell.json(&format!("{sensor}/summary.json"));
        assert_eq!((&summary["frames"], &summary["skipped"]), (&413.into(), &0.into()));
        assert!((summary["path_length_m"].as_f64().unwrap() - 25.0).abs() < 0.3, "{summary}");
        assert!(summary["share_entropy_above_0_65"].as_f64().unwrap() < most, "{summary}");
    }
}
