//! Ctrl-C.
#![cfg(unix)]

use crate::typed::{Shell, shipped};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[test]
fn ctrl_c_writes_what_there_is() {
    let shell = Shell::new();
    let line =
        format!("explore {} --resolution 0.2 --seed 5 --out run", shipped("scenarios/office.ron"));
    let mut command = shell.command(&line);
    let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    let trace = shell.path("run.partial/trace.jsonl");
    let decisions =
        || std::fs::read_to_string(&trace).unwrap_or_default().matches("Decision").count();
    while decisions() < 3 {
        assert!(begun.elapsed() < Duration::from_secs(60), "no decision in a minute");
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    assert!(String::from_utf8(ended.stdout).unwrap().contains("interrupted"));
    assert_eq!(shell.json("run/summary.json")["ending"], "Interrupted");
    for name in ["belief.bin", "map.yaml", "coverage.png", "certificate.png"] {
        assert!(shell.path("run").join(name).exists(), "{name}");
    }
    let trace = std::fs::read_to_string(shell.path("run/trace.jsonl")).unwrap();
    assert!(trace.lines().next_back().unwrap().contains("Interrupted"));
}

#[test]
fn ctrl_c_ends_while_a_world_is_built() {
    use std::os::unix::process::ExitStatusExt;
    let shell = Shell::new();
    let wall = |from: (f64, f64), to: (f64, f64)| {
        format!("(shape: Wall(from: {from:?}, to: {to:?}, thickness: 0.0015), surface: Rough)")
    };
    let at = |i: u32| f64::from(i) * 0.01 + 0.1;
    let walls =
        (0..900).flat_map(|i| [wall((at(i), 0.1), (at(i), 9.5)), wall((0.1, at(i)), (9.5, at(i)))]);
    let walls = walls.collect::<Vec<_>>().join(",\n");
    let scenario =
        format!("(name: \"grid\", extent: (width: 10, height: 10), obstacles: [{walls}])");
    shell.write("grid.ron", scenario);
    let line = "explore grid.ron --resolution 0.05 --max-scans 1 --out run";
    let mut child = shell.command(line).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(400));
    assert!(child.try_wait().unwrap().is_none(), "it ended before it was interrupted");
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let status = child.wait().unwrap();
    // The signal is the system's own if the program did not listen yet.
    assert!(status.code() == Some(130) || status.signal() == Some(2), "{status}");
    assert!(!shell.path("run").exists());
}
