//! Bags: what was written is read, and what others write is read or refused with a reason.

use super::*;
use covmap_bag::BagWriter;
use covmap_bag::messages::{
    Header, LaserScan, Odometry, RangeMessage, Stamp, TfMessage, Transform, TransformStamped,
};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::Isometry2;
use std::path::PathBuf;

fn options(sensor: Sensor) -> LogOptions {
    LogOptions { sensor, ring: SonarRing::b21r(), poses: None, bag: BagOptions::default() }
}

/// A file in a folder of its own.
fn file(dir: &tempfile::TempDir, bytes: &[u8]) -> PathBuf {
    let path = dir.path().join("a.mcap");
    std::fs::write(&path, bytes).unwrap();
    path
}

fn read(bytes: &[u8], options: &LogOptions) -> (Vec<LogFrame>, Account) {
    let dir = tempfile::tempdir().unwrap();
    let mut reader = LogReader::open(file(&dir, bytes), options).unwrap();
    let frames = reader.by_ref().map(Result::unwrap).collect();
    (frames, reader.account().clone())
}

fn refused(bytes: &[u8], options: &LogOptions) -> String {
    let dir = tempfile::tempdir().unwrap();
    let mut reader = match LogReader::open(file(&dir, bytes), options) {
        Ok(reader) => reader,
        Err(error) => return error.to_string(),
    };
    reader.find_map(Result::err).unwrap().to_string()
}

fn scan(time: f64, x: f64, angle: f64, range: Range) -> Scan {
    let ranges = (0..24).map(|i| if i % 5 == 0 { range } else { Range::Echo(1.234) }).collect();
    Scan { pose: Isometry2::new([x, -x].into(), angle), time, ranges }
}

/// A robot that drives along a line with a scan each second.
fn drive() -> Vec<Scan> {
    let ranges = [Range::NoEcho, Range::Missing, Range::Echo(0.5), Range::Echo(10.25)];
    let scan = |(i, range): (usize, &Range)| {
        let i = i as f64;
        scan(1.0 + i, 0.125 * i, 0.3 * i, *range)
    };
    ranges.iter().enumerate().map(scan).collect()
}

fn written(scans: &[Scan]) -> Vec<u8> {
    let (ring, mut bytes) = (SonarRing::b21r(), Vec::new());
    let mut bag = RosBagWriter::new(&ring, &mut bytes).unwrap();
    for scan in scans {
        bag.write(scan).unwrap();
    }
    assert_eq!(bag.finish().unwrap(), scans.len());
    bytes
}

#[test]
fn a_bag_holds_the_scans_that_were_written() {
    let (frames, account) = read(&written(&drive()), &options(Sensor::Sonar));
    assert_eq!(frames.len(), drive().len());
    for (frame, scan) in frames.iter().zip(drive()) {
        assert_eq!((&frame.scan.ranges, frame.scan.time), (&scan.ranges, scan.time));
        assert_eq!(frame.scan.pose.translation, scan.pose.translation);
        assert!(frame.scan.pose.rotation.angle_to(&scan.pose.rotation).abs() < 1e-12);
        let beams = frame.ring.beams().iter().zip(SonarRing::b21r().beams().to_vec());
        for (beam, configured) in beams {
            let off = beam.pose.translation.vector - configured.pose.translation.vector;
            assert!(off.norm() < 1e-12);
            assert_eq!(
                (beam.min_range, beam.max_range),
                (configured.min_range, configured.max_range)
            );
        }
    }
    assert_eq!(account.poses, "/tf, base_link in map");
    assert!(account.skipped.is_empty() && account.notes.is_empty(), "{account:?}");
}

#[test]
fn scans_of_one_place_and_time_stay_apart() {
    let stands = |range| scan(1.0, 0.5, 0.0, Range::Echo(range));
    let (frames, account) =
        read(&written(&[stands(1.0), stands(2.0), stands(3.0)]), &options(Sensor::Sonar));
    let first: Vec<Range> = frames.iter().map(|frame| frame.scan.ranges[0]).collect();
    assert_eq!(first, [1.0, 2.0, 3.0].map(Range::Echo));
    assert!(account.notes.is_empty(), "{:?}", account.notes);
}

#[test]
fn a_bag_that_is_cut_off_is_read_to_its_last_whole_chunk() {
    let scans: Vec<Scan> =
        (0..400).map(|i| scan(f64::from(i), 0.01 * f64::from(i), 0.0, Range::NoEcho)).collect();
    let whole = written(&scans);
    let (frames, account) = read(&whole[..whole.len() / 2], &options(Sensor::Sonar));
    assert!(frames.len() > 100 && frames.len() < 400, "{}", frames.len());
    assert!(account.notes[0].contains("cut off or damaged after"), "{:?}", account.notes);
    // A flipped bit in a chunk ends it as well; one in the index harms nothing.
    let dir = tempfile::tempdir().unwrap();
    let mut ended_early = 0;
    for at in (0..whole.len()).step_by(whole.len() / 50) {
        let mut damaged = whole.clone();
        damaged[at] ^= 1;
        let reader = LogReader::open(file(&dir, &damaged), &options(Sensor::Sonar));
        let Ok(mut reader) = reader else { continue };
        let (good, bad): (Vec<_>, Vec<_>) = reader.by_ref().partition(Result::is_ok);
        let (frames, is_said) = (good.len(), !bad.is_empty() || !reader.account().notes.is_empty());
        assert!(frames == 400 || is_said, "{at}: {frames} frames");
        ended_early += usize::from(frames < 400);
    }
    assert!(ended_early > 5, "{ended_early}");
    assert!(refused(&whole[..100], &options(Sensor::Sonar)).contains("is not an MCAP recording"));
}

fn stamped(time: f64, frame: &str) -> Header {
    Header { stamp: Stamp::from_seconds(time), frame_id: frame.into() }
}

fn placed(time: f64, frame: &str, child: &str, x: f64) -> TransformStamped {
    let transform = Transform { translation: [x, 0.0, 0.0], ..Transform::default() };
    TransformStamped { header: stamped(time, frame), child_frame_id: child.into(), transform }
}

fn range(time: f64, frame: &str, range: f32) -> RangeMessage {
    RangeMessage {
        header: stamped(time, frame),
        field_of_view: 0.5,
        min_range: 0.25,
        max_range: 5.0,
        range,
        ..RangeMessage::default()
    }
}

/// Writes a bag of ranges and poses, by another hand than the writer of logs.
fn made(fill: impl FnOnce(&mut BagWriter<&mut Vec<u8>>)) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut bag = BagWriter::new(&mut bytes).unwrap();
    fill(&mut bag);
    bag.finish().unwrap();
    bytes
}

fn mounted(bag: &mut BagWriter<&mut Vec<u8>>) {
    let transforms =
        vec![placed(0.0, "base_link", "left", 0.1), placed(0.0, "base_link", "right", -0.1)];
    bag.write("/tf_static", Stamp::default(), &TfMessage { transforms }).unwrap();
}

fn moved(bag: &mut BagWriter<&mut Vec<u8>>, time: f64, x: f64) {
    let transforms = vec![placed(time, "odom", "base_link", x)];
    bag.write("/tf", Stamp::from_seconds(time), &TfMessage { transforms }).unwrap();
}

#[test]
fn ranges_of_one_time_are_a_scan_whose_pose_lies_between_two_transforms() {
    let bytes = made(|bag| {
        mounted(bag);
        moved(bag, 1.0, 0.0);
        for (time, sensor, metres) in [(1.25, "left", 1.5), (1.26, "right", f32::INFINITY)] {
            bag.write("/us", Stamp::from_seconds(time), &range(time, sensor, metres)).unwrap();
        }
        moved(bag, 2.0, 1.0);
        // Alone, too near, and doubled.
        for _ in 0..2 {
            bag.write("/us", Stamp::from_seconds(1.75), &range(1.75, "right", 0.125)).unwrap();
        }
        moved(bag, 3.0, 2.0);
    });
    let (frames, account) = read(&bytes, &options(Sensor::Sonar));
    let found: Vec<(f64, f64, Vec<Range>)> = frames
        .iter()
        .map(|f| (f.scan.time, f.scan.pose.translation.x, f.scan.ranges.clone()))
        .collect();
    let first = (1.25, 0.25, vec![Range::Echo(1.5), Range::NoEcho]);
    let second = (1.75, 0.75, vec![Range::Missing, Range::Missing]);
    assert_eq!(found, [first, second]);
    assert_eq!(account.poses, "/tf, base_link in odom");
    assert_eq!(account.notes, ["1 readings were recorded twice, and count once"]);
}

#[test]
fn odometry_takes_the_place_of_transforms() {
    let bytes = made(|bag| {
        mounted(bag);
        for (time, x) in [(1.0, 0.0), (2.0, 1.0)] {
            let pose = Transform { translation: [x, 0.0, 0.0], ..Transform::default() };
            let (header, child_frame_id) = (stamped(time, "odom"), "base_link".into());
            let odometry = Odometry { header, child_frame_id, pose, twist: [0.0; 6] };
            bag.write("/wheels", Stamp::from_seconds(time), &odometry).unwrap();
        }
        bag.write("/us", Stamp::from_seconds(1.5), &range(1.5, "left", 1.5)).unwrap();
    });
    let (frames, account) = read(&bytes, &options(Sensor::Sonar));
    assert_eq!((frames.len(), frames[0].scan.pose.translation.x), (1, 0.5));
    assert_eq!(account.poses, "/wheels, base_link in odom");
}

#[test]
fn a_laser_is_a_ring_of_lines() {
    let bytes = made(|bag| {
        mounted(bag);
        moved(bag, 1.0, 0.0);
        let scan = LaserScan {
            header: stamped(1.5, "left"),
            angle_min: -0.5,
            angle_increment: 0.5,
            range_min: 0.25,
            range_max: 8.0,
            ranges: vec![1.0, 8.0, f32::NAN],
            ..LaserScan::default()
        };
        bag.write("/scan", Stamp::from_seconds(1.5), &scan).unwrap();
        moved(bag, 2.0, 1.0);
    });
    let (frames, account) = read(&bytes, &options(Sensor::Laser));
    assert_eq!(frames[0].scan.ranges, [Range::Echo(1.0), Range::NoEcho, Range::Missing]);
    let beam = frames[0].ring.beams()[2];
    assert!((beam.pose.rotation.angle() - 0.5).abs() < 1e-12 && beam.half_angle <= 0.0);
    assert!((beam.pose.translation.x - 0.1).abs() < 1e-12);
    assert_eq!(account.skipped.readings(), 1);
    let lacks = refused(&bytes, &options(Sensor::Sonar));
    assert!(lacks.contains("no message of type sensor_msgs/msg/Range"), "{lacks}");
    assert!(lacks.contains("/scan (sensor_msgs/msg/LaserScan, 1)"), "{lacks}");
}

#[test]
fn what_a_bag_lacks_is_said_by_name() {
    let no_poses = made(|bag| {
        mounted(bag);
        bag.write("/us", Stamp::default(), &range(1.5, "left", 1.5)).unwrap();
    });
    let text = refused(&no_poses, &options(Sensor::Sonar));
    assert!(
        text.contains("no pose of the frame `base_link`") && text.contains("--base-frame"),
        "{text}"
    );
    let good = written(&drive());
    let with = |bag: BagOptions| refused(&good, &LogOptions { bag, ..options(Sensor::Sonar) });
    let text = with(BagOptions { map_frame: Some("world".into()), ..BagOptions::default() });
    assert!(
        text.contains("lead from `world` to `base_link`") && text.contains("such as `map`"),
        "{text}"
    );
    let text = with(BagOptions { topics: vec!["/us".into()], ..BagOptions::default() });
    assert!(text.contains("of the topics /us"), "{text}");
    let nowhere = made(|bag| {
        moved(bag, 1.0, 0.0);
        bag.write("/us", Stamp::default(), &range(1.0, "roof", 1.5)).unwrap();
    });
    let text = refused(&nowhere, &options(Sensor::Sonar));
    assert!(
        text.contains("no sensor with a known place") && text.contains("no frame `roof`"),
        "{text}"
    );
}

#[test]
fn hostile_messages_are_counted_and_passed_over() {
    let bytes = made(|bag| {
        mounted(bag);
        moved(bag, 1.0, 0.0);
        // No motion, a frame that is its own parent, a stamp of 1970, and ranges that are none.
        let mut broken = placed(1.2, "odom", "base_link", f64::NAN);
        broken.transform.rotation = [0.0; 4];
        let transforms = vec![broken, placed(1.2, "odom", "odom", 0.0)];
        bag.write("/tf", Stamp::default(), &TfMessage { transforms }).unwrap();
        for (time, metres) in [(0.0, 1.5), (1.3, f32::NAN), (1.6, -7.0), (1.9, 1.5)] {
            bag.write("/us", Stamp::default(), &range(time, "left", metres)).unwrap();
        }
        bag.write("/us", Stamp::default(), &range(1.9, "", 1.5)).unwrap();
        moved(bag, 2.0, 1.0);
    });
    let (frames, account) = read(&bytes, &options(Sensor::Sonar));
    assert_eq!(frames.len(), 3, "the one of 1970 has no pose");
    assert_eq!(account.skipped.count(SkipReason::NoPose), 1);
    assert_eq!((account.skipped.poses(), account.skipped.readings()), (2, 2));
}
