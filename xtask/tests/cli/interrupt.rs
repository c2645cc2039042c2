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
