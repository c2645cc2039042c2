//! `beside`: runs side by side.

use crate::typed::{Shell, shipped};
use std::fs;

#[test]
fn runs_are_laid_side_by_side_with_their_accuracy() {
    let shell = Shell::new();
    for (strategy, scans) in [("CL", 3), ("CL", 9), ("COUNT:2", 5)] {
        let lab = shipped("scenarios/lab.ron");
        let run = format!("--strategy {strategy} --max-scans {scans} --out run-{scans} --quiet");
        shell.expect(&format!("explore {lab} --resolution 0.2 {run}"), 3);
    }
    let typed = shell.expect("beside run-3 run-9 run-5 --out both", 0);
    let lines: Vec<&str> = typed.out.lines().collect();
    assert!(lines[0].starts_with("run ") && lines[0].contains("class_mean"), "{}", typed.out);
    assert!(lines[1].starts_with("run-3 ") && lines[1].contains("  3  "), "{}", typed.out);
    assert_eq!(lines[4..], ["both"]);
    let table = fs::read_to_string(shell.path("both/runs.csv")).unwrap();
    assert_eq!(table.lines().count(), 4);
    assert!(table.contains("run-5,lab,0.2,COUNT:2,1,5,"), "{table}");
    // One line for CL, one for COUNT.
    let svg = fs::read_to_string(shell.path("both/runs.svg")).unwrap();
    assert!(svg.contains(">CL<") && svg.contains(">COUNT<"));
    assert!(fs::read(shell.path("both/runs.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_class_without_a_cell_has_no_numbers_and_no_part_in_the_mean() {
    let shell = Shell::new();
    // Walls run along the borders of cells: no cell is partly covered.
    shell.write("room.ron", r#"(name: "room", extent: (width: 4.0, height: 3.0), obstacles: [])"#);
    shell.expect("explore room.ron --resolution 0.2 --max-scans 9 --out run --quiet", 3);
    shell.expect("beside run --out both", 0);
    let measured = &shell.json("run/summary.json")["measured"];
    assert_eq!(measured["partial"]["cells"], 0);
    let of = |class: &str| measured[class]["log_likelihood"].as_f64().unwrap();
    let mean = 0.5 * (of("free") + of("solid"));
    let table = fs::read_to_string(shell.path("both/runs.csv")).unwrap();
    let fields: Vec<&str> = table.lines().nth(1).unwrap().split(',').collect();
    assert_eq!((fields[8], fields[9]), (format!("{mean:.3}").as_str(), ""), "{table}");
}

#[test]
fn what_is_no_run_is_refused() {
    let shell = Shell::new();
    shell.refuse("beside nowhere", &["nowhere: no summary.json"]);
    fs::create_dir(shell.path("other")).unwrap();
    shell.write("other/summary.json", "{\"world\": 1}");
    shell.refuse("beside other", &["other/summary.json:1:11: world: invalid type"]);
    shell.write("other/summary.json", "[]");
    shell.refuse("beside other", &["other/summary.json:1:"]);
}
