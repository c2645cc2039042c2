//! `bench` prints every row; no time is asserted.
#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(dead_code, reason = "what types commands is shared")]

#[path = "../../crates/covmap-cli/tests/cli/typed.rs"]
mod typed;

/// The tested program.
const PROGRAM: &str = env!("CARGO_BIN_EXE_covmap-bench");

use typed::Shell;

#[test]
fn every_comparison_is_printed() {
    let shell = Shell::new();
    let typed = shell.expect("--quick", 0);
    let rows: Vec<Vec<&str>> = typed
        .out
        .lines()
        .filter(|line| line.starts_with("| "))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows[0], ["what", "ours", "against", "ratio", "target", ""]);
    let expected = [
        "E[I] at every reachable cell of 100 × 100 cells by cause",
        "the whole IG decision on 100 × 100 cells by cause",
        "the next decision on 100 × 100 cells by cause",
        "the next decision on 200 × 200 cells by cause",
        "E[I] at every reachable cell of 100 × 100 cells by Eq. (9)",
        "the whole IG decision on 100 × 100 cells by Eq. (9)",
        "the next decision on 100 × 100 cells by Eq. (9)",
        "the next decision on 200 × 200 cells by Eq. (9)",
        "integrate a scan of 24 beams by Eq. (9), 11 bins",
        "integrate a scan of 24 beams by Eq. (9), 16 bins",
        "a distance field",
        "a distance field",
        "fire 24 sonars among 5000 segments",
    ];
    assert_eq!(rows.len(), 1 + expected.len(), "{}", typed.out);
    for (row, expected) in rows[1..].iter().zip(expected) {
        assert!(row.len() == 6 && row[0].starts_with(expected), "{row:?}");
        assert!(row[3].ends_with(" ×") && row[4].ends_with(" ×"), "{row:?}");
        assert!(["", "falls short"].contains(&row[5]), "{row:?}");
    }
    assert!(typed.out.contains("99th percentile"), "{}", typed.out);
    assert!(typed.out.contains("below 1e-5: it does)"), "{}", typed.out);
    assert!(typed.err.is_empty(), "no progress where nobody looks: {}", typed.err);
    assert!(shell.files().is_empty());
}
