//! Clocks that are coarse, leap, start anew or are out of order; and the way between frames.

use super::tests::{carmen, files, options};
use super::*;
use std::fmt::Write;
use std::io::Cursor;

/// Returns a line `ODOM` at x \[m\] with a time by the sensor's clock and one by the logger's.
fn odom(x: f64, time: impl std::fmt::Display, logger: f64) -> String {
    format!("ODOM {x:.3} 0 0 0 0 0 {time} h {logger:.3}\n")
}

fn sonar(time: impl std::fmt::Display, logger: f64) -> String {
    format!("SONAR 0.2 2 1.5 2.5 0.2 0 0 0 0.2 1.5 {time} h {logger:.3}\n")
}

fn flaser(x: f64, time: f64) -> String {
    let ranges = ["2.5"; 181].join(" ");
    format!("FLASER 181 {ranges} {x} 0 0 {x} 0 0 {time:.3} h {time:.3}\n")
}

/// Returns the lines of a robot that drives at 0.2 m/s and measures twice a second, 40 times.
///
/// Its clocks show what `shown` makes of the true time.
fn drive(shown: impl Fn(usize, f64) -> String, logger: impl Fn(f64) -> f64) -> String {
    let step = |i: usize| {
        let (t, show) = (time(i), shown(i, time(i)));
        odom(0.2 * t, &show, logger(t)) + &sonar(&show, logger(t))
    };
    (0..40).map(step).collect()
}

/// Returns the time of a frame \[s\].
fn time(frame: usize) -> f64 {
    0.5 * f64::from(u32::try_from(frame).unwrap())
}

fn places(frames: &[LogFrame]) -> Vec<f64> {
    frames.iter().map(|frame| frame.scan.pose.translation.x).collect()
}

/// Checks that all frames are used, and each is within `most` \[m\] of its true pose.
#[track_caller]
fn all_are_placed(log: &str, most: f64) {
    let (frames, skipped, error) = carmen(Sensor::Sonar, log);
    assert!(error.is_none() && skipped.is_empty(), "{skipped}");
    let places = places(&frames);
    assert_eq!(places.len(), 40, "{places:?}");
    for (i, x) in places.iter().enumerate() {
        assert!((x - 0.2 * time(i)).abs() <= most, "frame {i}: {places:?}");
    }
}

#[test]
fn where_times_are_too_coarse_the_order_of_lines_decides() {
    let six_digits = |_, _| "1.13486e+09".to_owned();
    all_are_placed(&drive(six_digits, |t| t), 1e-9);
    all_are_placed(&drive(six_digits, |_| 0.0), 1e-9);
    let seconds = |_, t: f64| format!("{:.0}", 1000.0 + t.floor());
    all_are_placed(&drive(seconds, |t| t), 1e-9);
    all_are_placed(&drive(seconds, |_| 7.0), 1e-9);
}

/// Returns a log at 10 Hz, with each scan 0.04 s after its odometry, and separate clocks.
fn mixed(odometry: fn(f64) -> f64, scans: fn(f64) -> f64, has_logger: bool) -> String {
    let mut log = String::new();
    for i in 0..40 {
        for part in 0..5u32 {
            let t = 100.0 + time(i) + 0.1 * f64::from(part);
            let logger = |t: f64| if has_logger { t } else { 0.0 };
            log += &odom(0.2 * (t - 100.0), odometry(t), logger(t));
            if part == 0 {
                log += &sonar(scans(t + 0.04), logger(t + 0.04));
            }
        }
    }
    log
}

#[test]
fn one_coarse_clock_is_enough_to_follow_the_lines() {
    all_are_placed(&mixed(f64::floor, |t| t, true), 0.0081);
    all_are_placed(&mixed(f64::floor, |t| t, false), 0.0081);
    all_are_placed(&mixed(|t| t, f64::floor, true), 0.0081);
    // The logger's time places the scan between two fixes, not at the one before.
    let log = mixed(f64::floor, f64::floor, true);
    let places = places(&carmen(Sensor::Sonar, log).0);
    assert!((places[20] - 0.2 * (time(20) + 0.04)).abs() < 1e-6, "{places:?}");
}

#[test]
fn that_times_are_too_coarse_is_said() {
    let account = |log: String| {
        let log = Cursor::new(log.into_bytes());
        let mut reader = LogReader::carmen("a.log", log, &options(Sensor::Sonar)).unwrap();
        assert_eq!(reader.by_ref().count(), 40);
        reader.account().clone()
    };
    let coarse = account(drive(|_, _| "5".to_owned(), |t| t));
    assert_eq!(coarse.placed_by_order, 39);
    assert!(coarse.remarks()[0].contains("39 frames are too coarse"), "{:?}", coarse.remarks());
    let fine = account(drive(|_, t| t.to_string(), |t| t));
    assert_eq!((fine.placed_by_order, fine.restarts), (0, 0));
    let anew = account(drive(|i, t| if i < 20 { t + 50.0 } else { t - 10.0 }.to_string(), |t| t));
    assert_eq!((anew.placed_by_order, anew.restarts), (0, 1));
    assert!(anew.remarks()[0].contains("starts anew 1 time"), "{:?}", anew.remarks());
}

/// Checks that all frames but one are used, each at its true pose.
#[track_caller]
fn one_is_lost(log: &str, lost: usize) {
    let (frames, skipped, error) = carmen(Sensor::Sonar, log);
    assert!(error.is_none());
    assert_eq!((skipped.frames(), skipped.total()), (40, 1), "{skipped}");
    let expected = (0..40).filter(|i| *i != lost).map(|i| 0.2 * time(i));
    for (x, expected) in places(&frames).iter().zip(expected) {
        assert!((x - expected).abs() < 1e-9, "{x} for {expected}");
    }
}

#[test]
fn one_wrong_reading_of_the_clock_loses_one_frame() {
    for day in [86_400.0, -86_400.0, 1e9] {
        for at in [1, 5, 38] {
            let leaping = |i, t: f64| (1000.0 + t + if i == at { day } else { 0.0 }).to_string();
            one_is_lost(&drive(leaping, |t| t), at);
        }
    }
    // The clock of the scan leaps alone, or that of the odometry does.
    let good = drive(|_, t| t.to_string(), |t| t);
    let line = sonar(time(7), time(7));
    one_is_lost(&good.replace(&line, &sonar(86_400, time(7))), 7);
    let line = odom(0.2 * time(7), time(7), time(7));
    let (frames, skipped, _) =
        carmen(Sensor::Sonar, good.replace(&line, &odom(1.4, 86_400, time(7))));
    assert_eq!((frames.len(), skipped.poses()), (40, 1), "{skipped}");
}

#[test]
fn clocks_of_two_hosts_may_differ() {
    for ahead in [3600.0, -3600.0, 3.0] {
        let made = |i: usize| {
            let t = 5000.0 + time(i);
            odom(0.2 * time(i), t, time(i)) + &sonar(t + ahead, time(i))
        };
        let log: String = (0..40).map(made).collect();
        let (frames, skipped, _) = carmen(Sensor::Sonar, log);
        assert!(frames.len() >= 39, "{ahead}: {skipped}");
        let right = |frame: &LogFrame| {
            let since = frame.scan.time - 5000.0 - ahead;
            (frame.scan.pose.translation.x - 0.2 * since).abs() < 1e-9
        };
        assert!(frames.iter().all(right), "{ahead}");
    }
}

#[test]
fn a_clock_that_starts_anew_is_followed() {
    let anew = |first: f64| move |i, t: f64| if i < 23 { first + t } else { t }.to_string();
    all_are_placed(&drive(anew(5000.0), |t| t), 1e-9);
    all_are_placed(&drive(anew(0.3), |t| t), 1e-9);
    all_are_placed(&drive(|i, t| (t - 8.0 * (i / 15) as f64).to_string(), |t| t), 1e-9);
    // The clock is set ahead, and not set back.
    all_are_placed(&drive(|i, t| if i < 9 { t } else { t + 86_400.0 }.to_string(), |t| t), 1e-9);
}

#[test]
fn frames_with_poses_of_their_own_are_used_in_any_order() {
    let ordered = |order: &[u32]| -> (Vec<f64>, Skipped) {
        let line = |i: &u32| flaser(1.1 * f64::from(*i), 2.0 * f64::from(*i));
        let (frames, skipped, error) =
            carmen(Sensor::Laser, order.iter().map(line).collect::<String>());
        assert!(error.is_none());
        (frames.iter().map(|frame| (frame.scan.time / 2.0).round()).collect(), skipped)
    };
    let (times, skipped) = ordered(&[0, 1, 3, 2, 5, 6, 4, 7, 8, 9, 10, 11, 13, 12]);
    assert!(skipped.is_empty() && times.is_sorted() && times.len() == 14, "{times:?}");
    let backwards: Vec<u32> = (0..40).rev().collect();
    assert_eq!(ordered(&backwards).0.len(), 40);
    // A clock that starts anew is not sorted in.
    let anew: Vec<u32> = (200..220).chain(0..20).collect();
    let (times, _) = ordered(&anew);
    assert!(times[..20].is_sorted() && times[20..].is_sorted() && times[0] > times[20]);
}

#[test]
fn odometry_may_be_fast_and_scans_may_be_late() {
    let mut log = String::new();
    for i in 0..2000u32 {
        let t = 0.001 * f64::from(i);
        log += &odom(t, t, t);
        if i % 50 == 0 && i > 200 {
            // The scan was measured 0.2 s ago.
            log += &sonar(format!("{:.4}", t - 0.2), t);
        }
    }
    let (frames, skipped, _) = carmen(Sensor::Sonar, log);
    assert!(skipped.is_empty() && frames.len() == 35, "{skipped}");
    let right = |frame: &LogFrame| (frame.scan.pose.translation.x - frame.scan.time).abs() < 1e-6;
    assert!(frames.iter().all(right));
}

#[test]
fn logs_that_are_sorted_by_their_tags_are_read() {
    let odometry: String = (0..40).map(|i| odom(0.2 * time(i), time(i), 0.0)).collect();
    let scans: String = (0..40).map(|i| sonar(time(i), 0.0)).collect();
    all_are_placed(&format!("{odometry}{scans}"), 1e-9);
}

#[test]
fn a_robot_that_stands_is_where_it_is() {
    let log: String = (0..40).map(|_| odom(1.0, 5, 5.0) + &sonar(5, 5.0)).collect();
    let (frames, skipped, _) = carmen(Sensor::Sonar, log);
    assert!(skipped.is_empty() && frames.len() == 40);
    assert!(places(&frames).iter().all(|x| (x - 1.0).abs() < 1e-12));
}

#[test]
fn the_way_between_frames_is_that_of_the_odometry() {
    let mut log = odom(0.0, 0, 0.0) + &sonar(0, 0.0);
    for (t, y) in [(1, 1.0), (2, 2.0), (3, 3.0)] {
        writeln!(log, "ODOM 3 {y} 0 0 0 0 {t} h {t}").unwrap();
    }
    log += &(odom(3.0, 4, 4.0) + &sonar(4, 4.0) + &odom(9.0, 5, 5.0));
    let log = Cursor::new(log.into_bytes());
    let mut reader = LogReader::carmen("a.log", log, &options(Sensor::Sonar)).unwrap();
    let frames: Vec<LogFrame> = reader.by_ref().map(Result::unwrap).collect();
    let rest = reader.rest();
    assert_eq!(rest.len(), 1);
    assert!((rest[0].pose.translation.x - 9.0).abs() < 1e-12);
    let way: Vec<(f64, f64, f64)> = frames[1]
        .way
        .iter()
        .map(|passed| (passed.pose.translation.x, passed.pose.translation.y, passed.seconds))
        .collect();
    let expected = [(3.0, 1.0, 1.0), (3.0, 2.0, 1.0), (3.0, 3.0, 1.0), (3.0, 0.0, 1.0)];
    assert_eq!(way[..4], expected);
    // The last pose is that of the scan.
    assert_eq!(way[4..], [(3.0, 0.0, 0.0)]);
    assert_eq!(frames[0].way.len(), 2);
}

#[test]
fn of_a_long_way_every_second_pose_is_enough() {
    let many: String = (0..30_000u32).map(|i| odom(f64::from(i), i, 0.0)).collect();
    let log = odom(-1.0, -1, 0.0) + &sonar(-1, 0.0) + &many + &sonar(29_999, 0.0);
    let (frames, ..) = carmen(Sensor::Sonar, log);
    let way = &frames[1].way;
    assert!(way.len() <= 4097, "{}", way.len());
    let x = |passed: &Passed| passed.pose.translation.x;
    assert!(x(&way[0]) < 1.0 && way.windows(2).all(|two| x(&two[0]) <= x(&two[1])));
}

#[test]
fn files_have_clocks_like_that_too() {
    let made = |shown: fn(i32) -> i32| {
        let [mut poses, mut scans] = [const { String::new() }; 2];
        for i in 0..40 {
            writeln!(poses, "{} {} 0 0", shown(i), 100 * i).unwrap();
            writeln!(scans, "{} 500 700", shown(i)).unwrap();
        }
        let (frames, skipped, error) = files(Sensor::Sonar, scans, poses);
        assert!(error.is_none());
        let right = |frame: &&LogFrame| {
            let expected = 0.1 * f64::from(u32::try_from(frame.line).unwrap() - 1);
            (frame.scan.pose.translation.x - expected).abs() < 1e-9
        };
        assert_eq!(frames.iter().filter(right).count(), frames.len());
        (frames.len(), skipped.total())
    };
    assert_eq!(made(|i| 500 * i), (40, 0));
    assert_eq!(made(|i| 500 * i + if i == 5 { 86_400_000 } else { 0 }), (39, 1));
    assert_eq!(made(|i| if i < 20 { 90_000 + 500 * i } else { 500 * i }), (40, 0));
    assert_eq!(made(|_| 7000), (40, 0));
    assert_eq!(made(|i| 1000 * (i / 4)), (40, 0));
}
