//! Small logs, good and bad.

use super::lines::Lines;
use super::poses::{PoseFile, Units};
use super::*;
use covmap_sonar::{Range, RingSpecification, Scan, SensorSpecification, SonarRing};
use flate2::Compression;
use flate2::write::GzEncoder;
use nalgebra::Isometry2;
use proptest::prelude::*;
use std::io::{Cursor, Read, Write};
use std::path::Path;

/// Two sonars, ahead and to the left, .2 to 5 m.
pub(super) fn two_sonars() -> SonarRing {
    let sonar = |x, y, angle| SensorSpecification {
        x,
        y,
        angle,
        half_angle: 0.1,
        min_range: 0.2,
        max_range: 5.0,
    };
    let sonars = vec![sonar(0.2, 0.0, 0.0), sonar(0.0, 0.2, 1.5)];
    SonarRing::from_specification(&RingSpecification::Sensors(sonars)).unwrap()
}

pub(super) fn options(sensor: Sensor) -> LogOptions {
    LogOptions { sensor, ring: two_sonars(), poses: None, bag: BagOptions::default() }
}

/// All frames, the skipped ones, and the error at the end.
pub(super) type Outcome = (Vec<LogFrame>, Skipped, Option<LogError>);

pub(super) fn drain(mut reader: LogReader) -> Outcome {
    let (mut frames, mut error) = (Vec::new(), None);
    for frame in &mut reader {
        match frame {
            Ok(frame) => frames.push(frame),
            Err(e) => error = Some(e),
        }
    }
    assert!(reader.next().is_none());
    (frames, reader.skipped().clone(), error)
}

pub(super) fn carmen(sensor: Sensor, bytes: impl AsRef<[u8]>) -> Outcome {
    let input = Cursor::new(bytes.as_ref().to_vec());
    match LogReader::carmen("a.log", input, &options(sensor)) {
        Ok(reader) => drain(reader),
        Err(error) => (Vec::new(), Skipped::default(), Some(error)),
    }
}

pub(super) fn files(sensor: Sensor, frames: impl AsRef<[u8]>, poses: impl AsRef<[u8]>) -> Outcome {
    let lines = |name: &str, bytes: &[u8]| Lines::new(Path::new(name), Cursor::new(bytes.to_vec()));
    let (frames, poses) = match (lines("f.txt", frames.as_ref()), lines("od.txt", poses.as_ref())) {
        (Ok(frames), Ok(poses)) => (frames, poses),
        (Err(error), _) | (_, Err(error)) => return (Vec::new(), Skipped::default(), Some(error)),
    };
    let poses = PoseFile::new(poses, Units::ODOMETRY);
    drain(LogReader::of_files(frames, poses, &options(sensor)))
}

pub(super) fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(bytes).unwrap();
    packed.finish().unwrap()
}

const ODOM_1: &str = "ODOM 1.0 2.0 0.0 0 0 0 10.0 host 10.0\n";
const ODOM_2: &str = "ODOM 3.0 2.0 1.0 0 0 0 11.0 host 11.0\n";
const SONAR: &str = "SONAR 0.2 2 1.5 6.0 0.2 0 0 0 0.2 1.5 10.5 host 10.5\n";

/// Checks that a log of one scan is refused with this line in place of its sonar line.
#[track_caller]
fn refused(line: &str, reason: SkipReason, fault: &str) {
    let log = format!("{ODOM_1}{SONAR}{line}\n{ODOM_2}");
    let (frames, skipped, error) = carmen(Sensor::Sonar, log);
    assert_eq!(frames.len(), 1, "{skipped}");
    assert!(error.is_none());
    assert_eq!((skipped.frames(), skipped.total(), skipped.count(reason)), (2, 1, 1), "{skipped}");
    let first = skipped.first().unwrap();
    assert!(first.starts_with("a.log:3: ") && first.contains(fault), "{first}");
}

#[test]
fn a_sonar_line_gets_the_pose_between_two_odometry_lines() {
    let log = format!("# a comment\n\nSYNC whatever\nPARAM x y 0 h 0\n{ODOM_1}{SONAR}{ODOM_2}");
    let (frames, skipped, error) = carmen(Sensor::Sonar, log);
    assert!(error.is_none() && skipped.is_empty(), "{skipped}");
    let [LogFrame { scan, ring, line, .. }] = frames.as_slice() else { panic!("{frames:?}") };
    assert_eq!(*line, 6);
    assert_eq!(scan.ranges, [Range::Echo(1.5), Range::NoEcho]);
    assert!((scan.pose.translation.x - 2.0).abs() < 1e-12);
    assert!((scan.pose.rotation.angle() - 0.5).abs() < 1e-12);
    assert_eq!(**ring, two_sonars());
}

#[test]
fn the_geometry_that_the_log_records_wins() {
    let log = format!(
        "PARAM covmap_sonar_max_range 9.0 0 h 0\n{ODOM_1}{}{ODOM_2}",
        "SONAR 0.5 3 1.5 6.0 0.1 0.3 0 0 0 0.2 1.5 0 0.1 2.5 10.5 host 10.5\n"
    );
    let (frames, ..) = carmen(Sensor::Sonar, log);
    let beams = frames[0].ring.beams();
    assert_eq!(beams.len(), 3);
    assert!((beams[0].pose.translation.x - 0.3).abs() < 1e-12);
    assert!((beams[0].half_angle - 0.25).abs() < 1e-12);
    assert!((beams[2].max_range - 9.0).abs() < 1e-12 && (beams[2].min_range - 0.2).abs() < 1e-12);
    assert_eq!(frames[0].scan.ranges, [Range::Echo(1.5), Range::Echo(6.0), Range::Missing]);
}

#[test]
fn lasers_are_rings_of_lines_and_keep_their_own_poses() {
    let ranges = vec!["2.5"; 180].join(" ");
    let flaser = |x: f64| format!("FLASER 180 {ranges} {x} 0 0 1.0 0 0 5.0 h 5.0\n");
    let (frames, skipped, error) = carmen(Sensor::Laser, format!("{}{}", flaser(1.1), flaser(4.1)));
    assert!(error.is_none() && skipped.is_empty(), "{skipped}");
    let beams = frames[0].ring.beams();
    assert!((beams[0].pose.rotation.angle().to_degrees() + 90.0).abs() < 1e-9);
    assert!((beams[179].pose.rotation.angle().to_degrees() - 89.0).abs() < 1e-9);
    assert!((beams[0].pose.translation.x - 0.1).abs() < 1e-9);
    // A correction moves the laser, and moves the robot with the laser.
    assert!((frames[0].scan.pose.translation.x - 1.0).abs() < 1e-9);
    assert!((frames[1].scan.pose.translation.x - 4.0).abs() < 1e-9);

    let robot = "ROBOTLASER1 0 -1.0 2.0 1.0 20.0 0.01 0 3 1.0 25.0 nan 2 7 8 1 0 0 0.9 0 0 0 0 .3 .3 9 6.0 h 6";
    let (frames, skipped, error) = carmen(Sensor::Laser, robot);
    assert!(error.is_none(), "{skipped}");
    assert_eq!(frames[0].scan.ranges, [Range::Echo(1.0), Range::NoEcho, Range::Missing]);
    assert_eq!(skipped.readings(), 1);
    assert!((frames[0].ring.beams()[2].pose.rotation.angle() - 1.0).abs() < 1e-9);
}

#[test]
fn damaged_frames_are_counted_with_file_line_and_field() {
    use SkipReason::{Count, Geometry, NoPose, Unreadable};
    refused("SONAR 0.2 2 1.5 6.0 0.2 0 0", Unreadable, "cut short");
    refused("SONAR 0.2 2", Unreadable, "cut short");
    refused("SONAR", Unreadable, "cone_angle: is missing");
    refused("SONAR 0.2 99999999999 1.5", Unreadable, "cut short");
    refused("SONAR 0.2 -2 1.5", Unreadable, "number of ranges: `-2`");
    refused("SONAR 0.2 2 1.5 x 0.2 0 0 0 0.2 1.5 10.5 h 1", Unreadable, "range 1: `x`");
    refused("SONAR 0.2 2 1.5 6 0.2 0 0 0 inf 1.5 10.5 h 1", Unreadable, "y of sensor 1: inf");
    refused("SONAR 0.2 2 1.5 6 0.2 0 0 0 0.2 1.5 nan h 1", Unreadable, "ipc_timestamp: NaN");
    refused("SONAR 0.2 2 1.5 0.2 0 0 0 0.2 1.5 10.5 h 1", Count, "ranges: 2");
    refused("SONAR 0.2 2 1 2 3 0.2 0 0 0 0.2 1.5 10.5 h 1", Count, "ranges: 2");
    refused("SONAR 0.2 2 1.5 6.0 0.2 0 0 0 0.2 1.5 9.5 h 1", NoPose, "no pose around the time 9.5");
    refused("SONAR 0.2 1 1.5 0.2 0 0 10.5 h 1", Geometry, "first frame");
    refused("SONAR 0.2 2 1.5 6.0 0.3 0 0 0 0.2 1.5 10.5 h 1", Geometry, "first frame");
    refused("SONAR 0.2 2 1.5 6.0 0.2 0 0 0 0.2 1.5 17.5 h 1", NoPose, "no pose");
}

#[test]
fn readings_that_are_none_are_missing_and_counted() {
    let sonar = "SONAR 0.2 2 nan -1 0.2 0 0 0 0.2 1.5 10.5 host 10.5\n";
    let (frames, skipped, _) = carmen(Sensor::Sonar, format!("{ODOM_1}{sonar}{ODOM_2}"));
    assert_eq!(frames[0].scan.ranges, [Range::Missing, Range::Missing]);
    assert_eq!((skipped.total(), skipped.readings()), (0, 2));
    assert!(skipped.to_string().contains("2 readings"), "{skipped}");
}

#[test]
fn damaged_odometry_is_counted() {
    let log = format!("{ODOM_1}ODOM 1 2 nan 0 0 0 10.2 h 1\nODOM 1 2\n{SONAR}{ODOM_2}{ODOM_1}");
    let (frames, skipped, _) = carmen(Sensor::Sonar, log);
    assert_eq!((frames.len(), skipped.total(), skipped.poses()), (1, 0, 2));
    assert!(skipped.first().unwrap().starts_with("a.log:2: theta: NaN"), "{skipped}");
}

#[test]
fn a_log_without_a_scan_is_an_error() {
    let sentence = |log: &str| carmen(Sensor::Sonar, log).2.unwrap().to_string();
    assert_eq!(sentence(""), "a.log: has no scan that can be used: there is no line SONAR");
    assert!(sentence("\0\u{1}\u{fffd}\n\n").contains("no line SONAR"));
    let none = sentence(SONAR);
    assert!(none.contains("skipped 1 of 1 frame: 1 without a pose (the first: a.log:1:"), "{none}");
    assert!(carmen(Sensor::Laser, SONAR).2.unwrap().to_string().contains("FLASER"));
}

#[test]
fn scans_that_wait_for_a_pose_do_not_fill_the_memory() {
    let scan = |i: u32| SONAR.replace("10.5", &format!("10.5{i:04}"));
    let log = format!("{ODOM_1}{}", (0..1000).map(scan).collect::<String>());
    let (frames, skipped, error) = carmen(Sensor::Sonar, log);
    assert!(frames.is_empty() && error.is_some());
    assert_eq!((skipped.total(), skipped.count(SkipReason::NoPose)), (1000, 1000));
}

#[test]
fn a_packed_log_is_known_by_its_content() {
    let log = format!("{ODOM_1}{SONAR}{ODOM_2}");
    assert_eq!(carmen(Sensor::Sonar, pack(log.as_bytes())).0, carmen(Sensor::Sonar, &log).0);
    // Two, one after the other.
    let two = [pack(log.as_bytes()), pack(b"# end\n")].concat();
    assert_eq!(carmen(Sensor::Sonar, two).0.len(), 1);
}

#[test]
fn a_packed_log_that_is_cut_is_an_error_after_its_scans() {
    let mut text = String::new();
    for i in 0..2000 {
        let t = f64::from(i) * 0.1;
        let odom = format!("ODOM {t} 0 {} 0 0 0 {t} h {t}\n", (t * 7.0).fract());
        text += &format!("{odom}SONAR 0.2 2 1.{i} 2.5 0.2 0 0 0 0.2 1.5 {t} h {t}\n");
    }
    let packed = pack(text.as_bytes());
    let (frames, skipped, error) = carmen(Sensor::Sonar, &packed[..packed.len() / 2]);
    assert!(frames.len() > 100 && frames.len() < 2000 && skipped.total() == 0);
    let error = error.unwrap();
    assert!(matches!(error, LogError::Gzip { .. }), "{error}");
    assert!(error.to_string().contains("a.log:") && error.to_string().contains("cut short"));
    assert_eq!(carmen(Sensor::Sonar, &packed).0.len(), 2000);
}

#[test]
fn what_unpacks_without_end_is_an_error() {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    let blanks = vec![b'\n'; 1 << 20];
    (0..64).for_each(|_| packed.write_all(&blanks).unwrap());
    let error = carmen(Sensor::Sonar, packed.finish().unwrap()).2.unwrap();
    assert!(matches!(error, LogError::Unpacked { .. }), "{error}");
    let endless = LogReader::carmen("z.log", std::io::repeat(0), &options(Sensor::Sonar)).unwrap();
    assert!(matches!(drain(endless).2, Some(LogError::LongLine { line: 1, .. })));
}

#[test]
fn three_files_are_one_log() {
    let poses = "1000 0 0 0\n2000 1000 0 900\n";
    let sonar = "1000 500 5110\n1500 100 4990\n2000 2000 0\n";
    let (frames, skipped, error) = files(Sensor::Sonar, sonar, poses);
    assert!(error.is_none() && skipped.is_empty(), "{skipped}");
    assert_eq!(frames[0].scan.ranges, [Range::Echo(0.5), Range::NoEcho]);
    assert_eq!(frames[1].scan.ranges, [Range::Missing, Range::Echo(4.99)]);
    assert!((frames[1].scan.pose.translation.x - 0.5).abs() < 1e-12);
    assert!((frames[2].scan.pose.rotation.angle().to_degrees() - 90.0).abs() < 1e-9);
    assert!((frames[2].scan.time - 2.0).abs() < 1e-12);

    let laser = format!("1000 {}\n1500 12 13\n", vec!["2000"; 361].join(" "));
    let (frames, skipped, _) = files(Sensor::Laser, laser, poses);
    assert_eq!((frames.len(), skipped.count(SkipReason::Count)), (1, 1));
    let beams = frames[0].ring.beams();
    assert!((beams[0].pose.rotation.angle().to_degrees() + 90.0).abs() < 1e-9);
    assert!((beams[360].pose.rotation.angle().to_degrees() - 90.0).abs() < 1e-9);
}

#[test]
fn damaged_lines_of_three_files_are_counted() {
    let poses = "1000 0 0 0\nx 0 0 0\n2000 1000 0 900 7\n3000 1000 0 900\n";
    let sonar = "1000 1 2\n900 1 2\n1000 1 2 3\n1000 1\n1000\nx 1 2\n1500 x 2\n9000 1 2\n";
    let (frames, skipped, error) = files(Sensor::Sonar, sonar, poses);
    assert!(error.is_none());
    assert_eq!((frames.len(), skipped.total(), skipped.poses()), (1, 7, 2), "{skipped}");
    assert_eq!(skipped.count(SkipReason::Count), 3);
    assert_eq!(skipped.count(SkipReason::Unreadable), 2);
    assert_eq!(skipped.count(SkipReason::NoPose), 2);
    assert!(files(Sensor::Sonar, "", poses).2.is_some());
    assert!(files(Sensor::Sonar, sonar, "").2.is_some());
}

#[test]
fn files_that_are_not_there_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let open = |name: &str, sensor| {
        LogReader::open(folder.path().join(name), &options(sensor)).unwrap_err().to_string()
    };
    assert!(open("none.log", Sensor::Sonar).contains("none.log: cannot be read"));
    assert!(open("", Sensor::Laser).contains("is a folder without laser.txt"));
    std::fs::write(folder.path().join("sonar.txt"), "").unwrap();
    assert!(open("", Sensor::Sonar).contains("is a folder without od.txt"));
    let poses = Some(folder.path().join("poses.txt"));
    let options = LogOptions { poses, ..options(Sensor::Sonar) };
    let error = LogReader::open(folder.path(), &options).unwrap_err().to_string();
    assert!(error.contains("poses.txt: cannot be read"), "{error}");
    std::fs::write(folder.path().join("poses.txt"), "1000 1.5 2 0.25\n").unwrap();
    std::fs::write(folder.path().join("sonar.txt"), "1000 700 800\n").unwrap();
    let (frames, ..) = drain(LogReader::open(folder.path(), &options).unwrap());
    assert!((frames[0].scan.pose.translation.x - 1.5).abs() < 1e-12);
}

#[test]
fn a_hundred_thousand_scans_stream() {
    /// A log that is made while it is read.
    struct Made {
        scan: u32,
        rest: Cursor<Vec<u8>>,
    }
    impl Read for Made {
        fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
            if self.rest.position() == self.rest.get_ref().len() as u64 && self.scan < 100_000 {
                let t = f64::from(self.scan) * 0.2;
                self.scan += 1;
                let odom = format!("ODOM {t} 0 0 0 0 0 {t} h {t}\n");
                let sonar = format!("SONAR 0.2 2 1.5 2.5 0.2 0 0 0 0.2 1.5 {t} h {t}\n");
                self.rest = Cursor::new((odom + &sonar).into_bytes());
            }
            self.rest.read(out)
        }
    }
    let made = Made { scan: 0, rest: Cursor::new(Vec::new()) };
    let mut log = LogReader::carmen("long.log", made, &options(Sensor::Sonar)).unwrap();
    assert_eq!(log.by_ref().map(Result::unwrap).count(), 100_000);
    assert!(log.skipped().is_empty());
}

fn written(ring: &SonarRing, scans: &[Scan]) -> Result<Vec<u8>, CarmenWriterError> {
    let mut bytes = Vec::new();
    let mut writer = CarmenWriter::new(ring, &mut bytes)?;
    scans.iter().try_for_each(|scan| writer.write(scan))?;
    assert_eq!(writer.finish()?, scans.len());
    Ok(bytes)
}

#[test]
fn what_a_log_cannot_say_is_not_written() {
    let scan = |time, ranges| Scan { pose: Isometry2::identity(), time, ranges };
    let good = scan(1.0, vec![Range::Missing; 2]);
    let refuse = |bad: Scan| {
        written(&two_sonars(), &[good.clone(), bad]).map(|_| ()).unwrap_err().to_string()
    };
    assert!(refuse(scan(2.0, vec![Range::Missing])).contains("scan 1 has 1 ranges"));
    assert!(refuse(scan(0.5, vec![Range::Missing; 2])).contains("backwards"));
    assert!(refuse(scan(f64::NAN, vec![Range::Missing; 2])).contains("finite"));
    assert!(refuse(scan(2.0, vec![Range::Echo(5.0); 2])).contains("5 m is out of"));
    let mut beams = two_sonars().beams().to_vec();
    beams[1].max_range = 4.0;
    let unequal = SonarRing::new(beams).unwrap();
    assert!(matches!(written(&unequal, &[]), Err(CarmenWriterError::Unequal(1))));
}

fn a_scan() -> impl Strategy<Value = (f64, Scan)> {
    let range = prop_oneof![
        (0.26..10.6f64).prop_map(Range::Echo),
        Just(Range::NoEcho),
        Just(Range::Missing)
    ];
    let pose = (-50.0..50.0f64, -50.0..50.0f64, -3.1..3.1f64);
    (0.0..9.0f64, pose, prop::collection::vec(range, 24)).prop_map(
        |(step, (x, y, theta), ranges)| {
            (step, Scan { pose: Isometry2::new([x, y].into(), theta), time: 0.0, ranges })
        },
    )
}

proptest! {
    #[test]
    fn a_written_log_is_read_as_the_same_scans(scans in prop::collection::vec(a_scan(), 1..6)) {
        let mut time = 0.0;
        let in_time = |(step, scan): (f64, Scan)| {
            time += step;
            Scan { time, ..scan }
        };
        let scans: Vec<Scan> = scans.into_iter().map(in_time).collect();
        let ring = SonarRing::b21r();
        let (frames, skipped, error) = carmen(Sensor::Sonar, written(&ring, &scans).unwrap());
        prop_assert!(error.is_none() && skipped.is_empty(), "{}", skipped);
        prop_assert_eq!(frames.len(), scans.len());
        for (LogFrame { scan: read, ring: seen, .. }, scan) in frames.iter().zip(&scans) {
            prop_assert_eq!(&read.ranges, &scan.ranges);
            prop_assert_eq!(read.time.to_bits(), scan.time.to_bits());
            prop_assert_eq!(read.pose.translation, scan.pose.translation);
            prop_assert!(read.pose.rotation.angle_to(&scan.pose.rotation).abs() < 1e-15);
            for (a, b) in seen.beams().iter().zip(ring.beams()) {
                prop_assert_eq!(a.pose.translation, b.pose.translation);
                prop_assert!(a.pose.rotation.angle_to(&b.pose.rotation).abs() < 1e-15);
                prop_assert_eq!(a.half_angle.to_bits(), b.half_angle.to_bits());
                prop_assert_eq!((a.min_range, a.max_range), (b.min_range, b.max_range));
            }
        }
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300),
                                   gzip in any::<bool>()) {
        let head: &[u8] = if gzip { &[0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3] } else { b"" };
        let bytes = [head, &bytes].concat();
        for sensor in [Sensor::Sonar, Sensor::Laser] {
            carmen(sensor, &bytes);
            files(sensor, &bytes, "1000 0 0 0\n");
            files(sensor, "1000 1 2\n", &bytes);
        }
    }

    #[test]
    fn arbitrary_words_and_damaged_logs_never_panic(
        words in prop::collection::vec("SONAR|FLASER|ROBOTLASER1|ODOM|PARAM|robot_front_laser_max|\n|0|1|2|3|180|-1|nan|inf|1e308|0.5|h|18446744073709551615", 0..120),
        at in 0..400usize, byte in any::<u8>(), pack_it in any::<bool>(),
    ) {
        let mut damaged = format!("{ODOM_1}{SONAR}{SONAR}{ODOM_2}").into_bytes();
        if pack_it {
            damaged = pack(&damaged);
        }
        let length = damaged.len();
        damaged[at % length] = byte;
        for sensor in [Sensor::Sonar, Sensor::Laser] {
            for bytes in [damaged.clone(), words.join(" ").into_bytes()] {
                let (frames, skipped, error) = carmen(sensor, &bytes);
                // Nothing is lost in silence.
                let whole = frames.len() + skipped.total() == skipped.frames();
                let broken = matches!(error, Some(LogError::Gzip { .. }));
                prop_assert!(whole || broken, "{}", skipped);
                files(sensor, &bytes, &bytes);
            }
        }
    }
}
