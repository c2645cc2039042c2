//! `explain`.

use crate::typed::{Shell, short_run};

/// Returns a short run with a strategy, in the folder `run`.
fn explored(strategy: &str) -> Shell {
    let shell = Shell::new();
    shell.expect(&format!("{} --strategy {strategy} --quiet", short_run()), 3);
    shell
}

#[test]
fn a_decision_is_explained_in_words_and_in_a_picture() {
    for (strategy, word) in [
        ("CL", "Eq. (12)"),
        ("IG", "Eq. (15)"),
        ("IG_WIN:1", "window"),
        ("IG_CL:0.3", "Eq. (16)"),
        ("COUNT:9", "COUNT"),
    ] {
        let shell = explored(strategy);
        let typed = shell.expect("explain run --step 9", 0);
        assert!(typed.out.contains(word) && typed.out.contains("rank"), "{typed:?}");
        let png = std::fs::read(shell.path("run/explain-9.png")).unwrap();
        assert_eq!(&png[1..4], b"PNG");
    }
}

#[test]
fn a_decision_that_was_not_taken_is_refused() {
    let shell = explored("IG");
    let decisions = shell.json("run/summary.json")["decisions"].as_u64().unwrap();
    shell.expect(&format!("explain run --step {}", decisions - 1), 0);
    let count = format!("the trace has {decisions}, numbered 0 to {}", decisions - 1);
    shell.refuse(&format!("explain run --step {decisions}"), &["run/trace.jsonl", &count]);
    shell.refuse("explain nowhere --step 0", &["nowhere/trace.jsonl: cannot be read"]);
}

#[test]
fn a_trace_whose_last_line_was_cut_is_still_explained() {
    let shell = explored("IG");
    let trace = std::fs::read(shell.path("run/trace.jsonl")).unwrap();
    std::fs::create_dir(shell.path("cut.partial")).unwrap();
    shell.write("cut.partial/trace.jsonl", &trace[..trace.len() / 2]);
    shell.expect("explain cut.partial --step 3", 0);
}

/// Returns the text with another number after the first occurrence of `before`.
fn number_after(text: &str, before: &str, number: &str) -> String {
    let (head, tail) = text.split_once(before).unwrap();
    let end = tail.find([',', ']', '}']).unwrap();
    format!("{head}{before}{number}{}", &tail[end..])
}

#[test]
fn traces_that_lie_are_refused() {
    let shell = explored("IG_CL:0.3");
    let good = std::fs::read_to_string(shell.path("run/trace.jsonl")).unwrap();
    let first_scan = good.lines().nth(1).unwrap();
    let refuse = |lie: &str, expected: &str| {
        assert!(lie != good, "{expected}");
        shell.write("run/trace.jsonl", lie);
        shell.refuse("explain run --step 3", &["run/trace.jsonl", expected]);
    };
    let instead = |from: &str, to: &str| good.replacen(from, to, 1);
    refuse("", "the trace is empty");
    refuse("{}\n", "trace.jsonl:1:");
    refuse("[1, 2\n", "trace.jsonl:1:");
    refuse(&instead("\"covmap_trace\":5", "\"covmap_trace\":99"), "version 99");
    let width = "\"resolution\":0.2,\"width\":";
    refuse(&number_after(&good, width, "999999999"), "20000000 cells");
    refuse(&number_after(&good, width, "1"), "trace.jsonl");
    refuse(&instead("\"inside\":[[", "\"inside\":[[9,3],["), "inside[0]");
    refuse(&instead("\"inside\":[[", "\"inside\":[[0,99999999],["), "inside[0]");
    let (before, inside) = good.split_once("\"inside\":").unwrap();
    let after = inside.split_once("]],").unwrap().1;
    refuse(&format!("{before}\"inside\":[],{after}"), "differs");
    refuse(&number_after(&good, "\"bins\":", "1000000000"), "model.bins");
    refuse(&number_after(&good, "\"usable_range\":", "1000"), "model");
    refuse(&number_after(&good, "\"translation\":[", "null"), "trace.jsonl:1:");
    refuse(&number_after(&good, "\"translation\":[", "1e300"), "the start (1e300");
    for step in ["0", "-1", "1e-12", "1e300"] {
        let every = format!("measuring while driving every {step} m");
        refuse(&number_after(&good, "\"while_driving\":", step), &every);
    }
    refuse(&number_after(&good, "\"max_scans\":", "0"), "max_scans is 0");
    refuse(&instead("IG_CL:0.3", "IG_CL:1e308"), "the weight α of IG_CL is 1e308");
    refuse(
        &instead(first_scan, &first_scan.replace("\"ranges\":[", "\"ranges\":[\"NoEcho\",")),
        "25 ranges",
    );
    refuse(&instead("\"ranges\":[", "\"ranges\":[7,"), "trace.jsonl:2:");
    let (scans, decisions) = good.split_once("{\"Decision\"").unwrap();
    let decisions = decisions.replacen("\"gain\":", "\"gain\":1", 1);
    refuse(&format!("{scans}{{\"Decision\"{decisions}"), "differs");
}

#[test]
fn what_became_of_a_cell_is_told() {
    let shell = explored("IG");
    let typed = shell.expect("explain run --cell 3,2", 0);
    assert!(typed.out.contains("H = ") && typed.out.contains("scans counted"), "{}", typed.out);
    // The place is in the middle of a wall that the robot has seen.
    let table = std::fs::read_to_string(shell.path("run/certificate.csv")).unwrap();
    let told = table.lines().skip(1).find(|line| {
        let row: Vec<&str> = line.split(',').collect();
        row[2] != "Resolved" && row[5].parse::<f64>().is_ok_and(|change| change > 0.01)
    });
    let row: Vec<&str> = told.unwrap().split(',').collect();
    let typed = shell.expect(&format!("explain run --cell {},{}", row[0], row[1]), 0);
    let expected =
        format!("expected to lower H by {} nats at most, from ({}, {})", row[5], row[6], row[7]);
    assert!(typed.out.contains(&expected), "{} {expected}", typed.out);
    shell.refuse("explain run --cell 999,2", &["(999, 2) is not in the map"]);
    let typed = shell.expect("explain run --cell 3", 2);
    assert!(typed.err.contains("two finite numbers are needed"), "{}", typed.err);
    assert!(shell.expect("explain run", 2).err.contains("--step"));
    shell.write("run/certificate.csv", "x,y\n1,2\n");
    shell.refuse("explain run --cell 3,2", &["certificate.csv: another version wrote it"]);
}
