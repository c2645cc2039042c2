//! `map` of logs from real users: their clocks, keyframes and longest ranges.

use crate::typed::{Shell, Typed, shipped};
use covmap::CoverageMap;
use nalgebra::Point2;
use std::fmt::Write;

/// Makes the map of a log, into the folder `out`.
#[track_caller]
fn map(log: &str, more: &str) -> (Shell, Typed, serde_json::Value) {
    let shell = Shell::new();
    shell.write("a.log", log);
    let typed = shell.expect(&format!("map a.log --out out {more}"), 0);
    let summary = shell.json("out/summary.json");
    (shell, typed, summary)
}

/// Returns the most likely coverage at a place, if it is known.
fn coverage(shell: &Shell, x: f64, y: f64) -> Option<f64> {
    let map =
        CoverageMap::from_bytes(&std::fs::read(shell.path("out/belief.bin")).unwrap()).unwrap();
    let cell = map.grid().cell_at(Point2::new(x, y)).unwrap();
    map.is_known(cell).then(|| map.mode(cell))
}

/// Returns the number of cells that are more covered than not.
fn covered(shell: &Shell) -> usize {
    let map =
        CoverageMap::from_bytes(&std::fs::read(shell.path("out/belief.bin")).unwrap()).unwrap();
    map.grid().cells().filter(|cell| map.is_known(*cell) && map.mode(*cell) > 0.5).count()
}

/// Returns the log of a robot in a corridor 2 m wide, at 0.2 m/s, with four sonars.
///
/// The robot's clock shows what `shown` makes of the time.
fn corridor(shown: impl Fn(u32) -> String) -> String {
    let mut log = String::new();
    for i in 0..40u32 {
        let (x, t) = (0.1 * f64::from(i), 0.5 * f64::from(i));
        let [ahead, back] = [7.8 - x, 0.8 + x];
        let at = "0.2 0 0 0 0.2 1.5708 -0.2 0 3.1416 0 -0.2 -1.5708";
        writeln!(log, "ODOM {x:.3} 0 0 0.2 0 0 {} robot {t:.3}", shown(i)).unwrap();
        write!(log, "SONAR 0.2618 4 {ahead:.2} 0.80 {back:.2} 0.80 {at} ").unwrap();
        writeln!(log, "{} robot {t:.3}", shown(i)).unwrap();
    }
    log
}

#[test]
fn coarse_times_and_clocks_that_leap_or_start_anew_lose_nothing_else() {
    let fine = |i: u32| format!("{}", 1_134_864_000.0 + 0.5 * f64::from(i));
    let (_, typed, summary) = map(&corridor(fine), "");
    assert_eq!((&summary["scans"], &summary["remarks"]), (&40.into(), &serde_json::json!([])));
    assert!(typed.out.contains("3.9 m driven"), "{typed:?}");

    let (_, typed, summary) = map(&corridor(|_| "1.13486e+09".into()), "");
    assert_eq!((&summary["scans"], &summary["jumps"]), (&40.into(), &0.into()));
    assert!(typed.out.contains("too coarse") && typed.out.contains("3.9 m driven"), "{typed:?}");

    let leaps = |i: u32| if i == 5 { "1134950402.5".into() } else { fine(i) };
    let (_, typed, summary) = map(&corridor(leaps), "");
    assert_eq!((&summary["scans"], &summary["skipped"]), (&39.into(), &1.into()));
    assert!(typed.out.contains("the clock leapt") && typed.out.contains("3.9 m"), "{typed:?}");

    let anew = |i: u32| if i < 20 { fine(i) } else { format!("{}", 0.5 * f64::from(i - 20)) };
    let (_, typed, summary) = map(&corridor(anew), "");
    assert_eq!((&summary["scans"], &summary["skipped"]), (&40.into(), &0.into()));
    assert!(typed.out.contains("starts anew 1 time"), "{typed:?}");
}

/// Returns a line FLASER of a robot at x, in an endless corridor 2 m wide.
fn keyframe(x: f64, time: f64) -> String {
    let range = |i: i32| (1.0 / f64::from(i - 90).to_radians().sin().abs()).min(20.0);
    let ranges: Vec<String> = (0..181).map(|i| format!("{:.2}", range(i))).collect();
    format!("FLASER 181 {} {x:.3} 0 0 {x:.3} 0 0 {time:.3} robot {time:.3}\n", ranges.join(" "))
}

#[test]
fn keyframes_a_metre_apart_are_driven() {
    let log = |seconds: f64| -> String {
        (0..16).map(|i| keyframe(1.05 * f64::from(i), 10.0 + seconds * f64::from(i))).collect()
    };
    let (shell, typed, summary) = map(&log(2.1), "--sensor laser");
    assert!(typed.out.contains("15.8 m driven") && !typed.out.contains("jumps"), "{typed:?}");
    assert_eq!((&summary["scans"], &summary["jumps"]), (&16.into(), &0.into()));
    assert_eq!(coverage(&shell, 8.0, 0.05), Some(0.0), "the body was there");
    let (_, typed, _) = map(&log(0.1), "--sensor laser");
    assert!(typed.out.contains("15 jumps"), "{typed:?}");
}

#[test]
fn where_nothing_answers_there_is_no_phantom() {
    let silent = |parameter: &str, range: &str| {
        let ranges = [range; 4].join(" ");
        let mut log = format!("{parameter}\n");
        for i in 0..6u32 {
            let (x, t) = (0.2 * f64::from(i), 100.0 + 0.5 * f64::from(i));
            writeln!(log, "ODOM {x:.3} 0 0 0 0 0 {t:.3} robot {t:.3}").unwrap();
            write!(log, "SONAR 0.2618 4 {ranges} 0.2 0 0 0 0.2 1.5708 -0.2 0 3.1416 0 -0.2 ")
                .unwrap();
            writeln!(log, "-1.5708 {t:.3} robot {t:.3}").unwrap();
        }
        let (shell, typed, _) = map(&log, "");
        (covered(&shell), typed.out)
    };
    for parameter in
        ["PARAM robot_max_sonar 2.0 99 h 99", "PARAM covmap_sonar_max_range 2.004 99 h 99"]
    {
        let (phantoms, out) = silent(parameter, "2.00");
        assert_eq!(phantoms, 0, "{parameter}");
        assert!(out.contains("0 echoes, 24 no echoes"), "{out}");
    }
    let (phantoms, out) = silent("# nothing says so", "2.00");
    assert!(phantoms > 0 && out.contains("24 of 24 echoes are 2 m"), "{out}");
    // The log has centimetres instead of metres.
    let (_, out) = silent("# nothing says so", "180");
    assert!(out.contains("0 echoes, 24 no echoes") && out.contains("not in metres?"), "{out}");
}

#[test]
fn what_is_taken_from_where_is_said() {
    let fan: Vec<&str> = vec!["2.50"; 101];
    let log = format!(
        "PARAM laser_front_laser_fov 1.745329 0 h 0\nFLASER 101 {} 0 0 0 0 0 0 5 h 5\n",
        fan.join(" ")
    );
    let (shell, typed, summary) = map(&log, "--sensor laser");
    let said = "FLASER: 101 beams from -50° in steps of 1° (PARAM laser_front_laser_fov)";
    assert!(typed.out.contains(said), "{typed:?}");
    assert_eq!(summary["taken_from"][0], said);
    assert_eq!(summary["readings"]["FLASER"]["echoes"], 101);
    assert_eq!(coverage(&shell, 0.0, 2.4), None, "nothing looks to the side");
    let table = std::fs::read_to_string(shell.path("out/readings.csv")).unwrap();
    assert!(table.starts_with("lines,sensor,echoes,no_echoes,missing,skipped\nFLASER,0,1,0,0,0\n"));
}

#[test]
fn a_log_of_another_sensor_or_kind_says_what_it_is() {
    let shell = Shell::new();
    shell.write("laser.log", keyframe(0.0, 1.0).repeat(16));
    shell.refuse("map laser.log", &["but 16 lines FLASER; try --sensor laser"]);
    shell.write("sonar.log", corridor(|i| i.to_string()));
    shell.refuse("map sonar.log --sensor laser", &["but 40 lines SONAR; try --sensor sonar"]);
    shell.refuse("survey sonar.log --out s.ron", &["no line FLASER", "but 40 lines SONAR"]);
    shell.write("a.bag", b"#ROSBAG V2.0\n\x45\0\0\0");
    shell.refuse("map a.bag", &["a.bag: is a bag of ROS 1", "`rosbags`"]);
    shell.write("a.db3", b"SQLite format 3\0\x10\0");
    shell.refuse("map a.db3", &["a.db3: is an SQLite database", "rosbag2"]);
    shell.write("a.mcap", b"\x89MCAP0\r\n");
    shell.refuse("survey a.mcap --out s.ron", &["a.mcap: is not an MCAP recording"]);
    shell.write("log.txt", b"CARMENMAPFILEv020");
    shell.refuse("map log.txt", &["log.txt: is a map of CARMEN"]);
}

#[test]
fn a_run_becomes_a_bag_that_is_listed_and_mapped() {
    let shell = Shell::new();
    shell.expect(
        &format!(
            "explore {} --resolution 0.2 --max-scans 12 --quiet --out run",
            shipped("scenarios/lab.ron")
        ),
        3,
    );
    let told = shell.expect("log run --out run.mcap", 0).out;
    assert!(told.contains("12 scans, run.mcap") && told.contains("run.foxglove.json"), "{told}");
    let listed = shell.expect("bag run.mcap", 0).out;
    for part in [
        "/sonar_23     sensor_msgs/msg/Range",
        "/candidates",
        "base_link moves in odom",
        "sonar_00 fixed to base_link",
    ] {
        assert!(listed.contains(part), "{part}: {listed}");
    }
    shell.expect("map run.mcap --resolution 0.2 --every 0 --quiet --out map", 0);
    assert_eq!(shell.json("map/summary.json")["scans"], 12);
    shell.refuse("map run.mcap --sensor laser --out m", &["no message of type", "/sonar_00 ("]);
    shell.refuse("map run.mcap --base-frame robot --out m", &["no pose of the frame `robot`"]);
    shell.refuse("bag run.foxglove.json", &["run.foxglove.json: is not an MCAP recording"]);
    shell
        .refuse("log run.mcap --out run.log", &["run.mcap: ", "run.mcap, and a log becomes a bag"]);
    let again = shell.expect("log run.mcap --out again.mcap", 0).out;
    assert!(again.contains("12 scans"), "{again}");
}
