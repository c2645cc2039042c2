//! The statements of a log about its sensors, and the account of a log.

use super::tests::{carmen, options, pack, two_sonars};
use super::*;
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::Isometry2;
use std::io::Cursor;

fn read(sensor: Sensor, log: &str) -> (Vec<LogFrame>, Account) {
    let input = Cursor::new(log.as_bytes().to_vec());
    let mut reader = LogReader::carmen("a.log", input, &options(sensor)).unwrap();
    let frames = reader.by_ref().map(Result::unwrap).collect();
    (frames, reader.account().clone())
}

const ODOM: [&str; 2] = ["ODOM 1 2 0 0 0 0 10 h 10\n", "ODOM 3 2 0 0 0 0 11 h 11\n"];

/// Returns a log with one scan of two sonars between two lines of odometry.
fn sonars(head: &str, ranges: &str) -> String {
    format!("{head}{}SONAR 0.2 2 {ranges} 0.2 0 0 0 0.2 1.5 10.5 h 10.5\n{}", ODOM[0], ODOM[1])
}

#[test]
fn the_longest_range_that_the_log_states_is_no_echo() {
    for (name, stated, written) in [
        ("robot_max_sonar", "2.0", "2.00"),
        ("covmap_sonar_max_range", "2.0", "2.00"),
        ("robot_max_sonar", "2.0033", "2.00"),
        ("robot_max_sonar", "1.9967", "2.0"),
    ] {
        let head = format!("PARAM {name} {stated} 0 h 0\n");
        let (frames, account) = read(Sensor::Sonar, &sonars(&head, &format!("{written} 1.5")));
        assert_eq!(frames[0].scan.ranges, [Range::NoEcho, Range::Echo(1.5)], "{head}");
        let taken = &account.sensors[0].taken;
        assert!(taken.iter().any(|taken| taken.source == format!("PARAM {name}")), "{taken:?}");
    }
    // One range is stated after the first scan, and one changes on the way.
    let late = sonars("", "2.00 1.5") + "PARAM robot_max_sonar 2.0 0 h 0\n";
    assert_eq!(read(Sensor::Sonar, &late).0[0].scan.ranges[0], Range::NoEcho);
    let both = sonars("PARAM robot_max_sonar 4 0 h 0\n", "2.00 4.00")
        + &sonars("PARAM robot_max_sonar 2 0 h 0\n", "2.00 4.00");
    let frames = read(Sensor::Sonar, &both).0;
    assert_eq!(frames[0].scan.ranges, [Range::Echo(2.0), Range::NoEcho]);
    assert_eq!(frames[1].scan.ranges, [Range::NoEcho, Range::NoEcho]);
    assert!((frames[1].ring.beams()[0].max_range - 2.0).abs() < 1e-12);
}

/// Angles of the first and the last beam \[degrees\].
fn angles(frame: &LogFrame) -> (f64, f64) {
    let angle = |beam: &covmap_sonar::Beam| beam.pose.rotation.angle().to_degrees();
    let beams = frame.ring.beams();
    (angle(&beams[0]), angle(&beams[beams.len() - 1]))
}

fn near(a: (f64, f64), b: (f64, f64)) -> bool {
    (a.0 - b.0).abs() < 1e-3 && (a.1 - b.1).abs() < 1e-3
}

#[test]
fn the_field_of_view_that_the_log_states_wins() {
    let ranges = ["2.5"; 101].join(" ");
    let head = "PARAM laser_front_laser_resolution 1.0 0 h 0\nPARAM laser_front_laser_fov 1.745329 0 h 0\n";
    let log = format!("{head}FLASER 101 {ranges} 0 0 0 0 0 0 5 h 5\n");
    let (frames, account) = read(Sensor::Laser, &log);
    assert!(near(angles(&frames[0]), (-50.0, 50.0)), "{:?}", angles(&frames[0]));
    let said = &account.sensors[0].taken[0];
    assert_eq!(said.what, "101 beams from -50° in steps of 1°");
    assert!(said.source.contains("PARAM laser_front_laser_fov"), "{said:?}");
    assert_eq!(account.poses, "lines FLASER");
}

#[test]
fn raw_and_rear_lasers_are_read() {
    let raw = |number: u8, time: f64| {
        format!("RAWLASER{number} 0 -1.0 2.0 1.0 20.0 0.01 0 3 1.0 25.0 0 2 7 8 {time} h {time}\n")
    };
    for number in 1..=5 {
        let log = format!("{}{}{}", ODOM[0], raw(number, 10.5), ODOM[1]);
        let (frames, account) = read(Sensor::Laser, &log);
        assert!((frames[0].scan.pose.translation.x - 2.0).abs() < 1e-12, "by odometry");
        assert_eq!(frames[0].scan.ranges, [Range::Echo(1.0), Range::NoEcho, Range::Missing]);
        assert_eq!(account.poses, "lines ODOM");
    }
    // The second laser faces back; both lasers have rings of their own.
    let offset = "PARAM robot_rearlaser_offset -0.2 0 h 0\n";
    let log = format!("{offset}{}{}{}{}", ODOM[0], raw(1, 10.5), raw(2, 10.5), ODOM[1]);
    let (frames, account) = read(Sensor::Laser, &log);
    assert_eq!((frames.len(), account.sensors.len()), (2, 2));
    let middle = frames[1].ring.beams()[1].pose;
    assert!((middle.translation.x + 0.2).abs() < 1e-9);
    assert!((middle.rotation.angle().abs().to_degrees() - 180.0).abs() < 1e-9);

    let robot = |number: u8, x: f64| {
        format!("ROBOTLASER{number} 0 -1 2 1 20 0.01 0 3 1 2 3 0 {x} 0 0 1 0 0 0 0 .3 .3 9 6 h 6\n")
    };
    let (frames, account) = read(Sensor::Laser, &format!("{}{}", robot(2, 0.8), robot(2, 0.8)));
    assert!((frames[1].ring.beams()[1].pose.translation.x + 0.2).abs() < 1e-9);
    assert!((frames[1].scan.pose.translation.x - 1.0).abs() < 1e-9);
    assert_eq!(account.sensors[0].lines, "ROBOTLASER2");
    // Of two lines for one scan, the one with a pose of its own is used.
    let log = format!("{}{}{}", raw(1, 6.0), robot(1, 1.1), raw(1, 6.0));
    let (frames, account) = read(Sensor::Laser, &log);
    assert_eq!((frames.len(), account.left_out), (1, vec![("RAWLASER1", 2)]));
}

#[test]
fn true_poses_win_over_odometry() {
    let truth = |x: f64, time: f64| format!("TRUEPOS {x} 7 0 1 2 0 {time} h {time}\n");
    let log = truth(4.0, 10.0) + &sonars("", "1.5 1.5") + &truth(5.0, 11.0);
    let (frames, account) = read(Sensor::Sonar, &log);
    let place = frames[0].scan.pose.translation.vector;
    assert!((place.x - 4.5).abs() < 1e-12 && (place.y - 7.0).abs() < 1e-12);
    assert_eq!((account.poses.as_str(), &account.left_out), ("lines TRUEPOS", &vec![("ODOM", 2)]));

    let ranges = ["2.5"; 181].join(" ");
    let laser = format!("FLASER 181 {ranges} 1.1 2 0 1 2 0 10.5 h 10.5\n");
    let log = truth(4.0, 10.0) + ODOM[0] + &laser + &truth(5.0, 11.0);
    let (frames, _) = read(Sensor::Laser, &log);
    assert!((frames[0].scan.pose.translation.x - 4.5).abs() < 1e-12);
    assert!((frames[0].ring.beams()[0].pose.translation.x - 0.1).abs() < 1e-9, "its mounting");
    // A localisation that reports now and then does not have all poses.
    let odometry: String = (0..9).map(|i| format!("ODOM {i} 2 0 0 0 0 {i} h {i}\n")).collect();
    let log = truth(4.0, 0.0) + &odometry + &sonars("", "1.5 1.5");
    let (frames, account) = read(Sensor::Sonar, &log);
    assert!((frames[0].scan.pose.translation.x - 2.0).abs() < 1e-12);
    assert_eq!(account.left_out, [("TRUEPOS", 1)]);
}

#[test]
fn a_log_of_another_sensor_says_which_it_has() {
    let ranges = ["2.5"; 181].join(" ");
    let laser = format!("FLASER 181 {ranges} 0 0 0 0 0 0 5 h 5\n").repeat(3);
    let error = carmen(Sensor::Sonar, &laser).2.unwrap();
    assert!(error.to_string().ends_with("there is no line SONAR, but 3 lines FLASER"), "{error}");
    assert_eq!(error.other_sensor(), Some(Sensor::Laser));
    let error = carmen(Sensor::Laser, sonars("", "1 1")).2.unwrap();
    assert!(error.to_string().contains("but 1 line SONAR"), "{error}");
    assert_eq!(error.other_sensor(), Some(Sensor::Sonar));
    assert_eq!(carmen(Sensor::Sonar, "").2.unwrap().other_sensor(), None);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("laser.txt"), "").unwrap();
    let error = LogReader::open(folder.path(), &options(Sensor::Sonar)).unwrap_err();
    assert_eq!(error.other_sensor(), Some(Sensor::Laser), "{error}");
}

#[test]
fn files_of_other_kinds_are_named() {
    let sentence = |head: &[u8]| carmen(Sensor::Sonar, head).2.unwrap().to_string();
    assert!(sentence(b"#ROSBAG V2.0\n\x45\0").contains("a.log: is a bag of ROS 1"));
    assert!(sentence(b"SQLite format 3\0\x10").contains("rosbag2"));
    assert!(sentence(&pack(b"#ROSBAG V2.0\n")).contains("a bag of ROS 1"), "packed, too");
    let folder = tempfile::tempdir().unwrap();
    let open = || LogReader::open(folder.path(), &options(Sensor::Sonar)).unwrap_err().to_string();
    std::fs::write(folder.path().join("trace.jsonl"), "").unwrap();
    assert!(open().contains("the folder of a run; `log` makes a log of it"), "{}", open());
    std::fs::write(folder.path().join("metadata.yaml"), "").unwrap();
    assert!(open().contains("rosbag2 recording"), "{}", open());
}

#[test]
fn readings_are_counted_for_each_sensor() {
    let log = sonars("PARAM robot_max_sonar 5 0 h 0\n", "1.5 5.0")
        + "SONAR 0.2 2 nan 0.01 0.2 0 0 0 0.2 1.5 10.6 h 10.6\n"
        + "SONAR 0.2 2 1.5 1.5 0.2 0 0 0 0.2 1.5 99 h 99\n"
        + "ODOM 3 2 0 0 0 0 11.5 h 11.5\n";
    let (frames, account) = read(Sensor::Sonar, &log);
    assert_eq!(frames.len(), 2, "{}", account.skipped);
    let counts = |r: &Readings| [r.echoes, r.no_echoes, r.missing, r.skipped];
    let all: Vec<_> = account.sensors[0].readings.iter().map(counts).collect();
    assert_eq!(all, [[1, 0, 0, 2], [0, 1, 1, 1]]);
}

#[test]
fn an_echo_that_is_written_is_read_as_one() {
    let mut beams = two_sonars().beams().to_vec();
    beams.iter_mut().for_each(|beam| beam.max_range = 10.65);
    let ring = SonarRing::new(beams).unwrap();
    let ranges = vec![Range::Echo(10.6), Range::NoEcho];
    let scan = Scan { pose: Isometry2::identity(), time: 3.0, ranges };
    let mut bytes = Vec::new();
    let mut writer = CarmenWriter::new(&ring, &mut bytes).unwrap();
    writer.write(&scan).unwrap();
    writer.pass(4.0, &Isometry2::translation(1.0, 2.0)).unwrap();
    assert!(writer.pass(3.5, &Isometry2::identity()).is_err(), "time does not run back");
    let later = Scan { time: 5.0, pose: Isometry2::translation(1.0, 3.0), ..scan.clone() };
    writer.write(&later).unwrap();
    writer.finish().unwrap();
    let (frames, ..) = carmen(Sensor::Sonar, bytes);
    assert_eq!(frames[0].scan, scan);
    assert_eq!(frames[1].way.len(), 2, "with where it passed");
}
