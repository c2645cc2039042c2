//! `figure`, `table` and `paper`.
#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(dead_code, reason = "what types commands is shared")]

#[path = "../../crates/covmap-cli/tests/cli/typed.rs"]
mod typed;

/// The tested program.
const PROGRAM: &str = env!("CARGO_BIN_EXE_xtask");

use typed::{Shell, shipped};

#[test]
fn figures_are_drawn_with_the_numbers_behind_them() {
    let shell = Shell::new();
    for number in [1, 2, 3] {
        shell.expect(&format!("figure {number} --quick --quiet --out f"), 0);
    }
    for (table, heading) in [
        ("f/figure1.csv", "case,measurements,method,mean,low,high"),
        ("f/figure2.csv", "config,case,coverage,mean,low,high"),
        ("f/figure3-paper.csv", "cell_distance,coverage,probability"),
        ("f/figure3-b21r.csv", "cell_distance,coverage,probability"),
    ] {
        let text = std::fs::read_to_string(shell.path(table)).unwrap();
        assert_eq!(text.lines().next(), Some(heading), "{table}");
        assert!(text.lines().count() > 80, "{table}");
    }
    for number in [1, 2, 3] {
        let svg = std::fs::read_to_string(shell.path(&format!("f/figure{number}.svg"))).unwrap();
        assert!(svg.contains(&format!("Fig. {number}: ")));
        let png = std::fs::read(shell.path(&format!("f/figure{number}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG"));
    }
}

#[test]
fn the_figures_of_gains_are_drawn_from_a_run_and_repeat() {
    let shell = Shell::new();
    for folder in ["f", "g"] {
        shell.expect(&format!("figure gain --quick --quiet --out {folder}"), 0);
    }
    let read = |path: String| std::fs::read(shell.path(&path)).unwrap();
    for figure in ["beam", "nodes", "memory", "decision", "errors", "sums"] {
        for end in ["svg", "png"] {
            let [first, second] = ["f", "g"].map(|dir| read(format!("{dir}/gain-{figure}.{end}")));
            assert!(first == second, "{figure}.{end}");
        }
        let svg = String::from_utf8(read(format!("f/gain-{figure}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"), "{figure}");
    }
    let errors = String::from_utf8(read("f/gain-errors.svg".into())).unwrap();
    assert_eq!(errors.matches("0: the same bits").count(), 2);
}

#[test]
fn occupancy_goes_to_one_where_a_fifth_is_covered() {
    let shell = Shell::new();
    shell.expect("figure 1 --quick --quiet --out f", 0);
    let text = std::fs::read_to_string(shell.path("f/figure1.csv")).unwrap();
    let last: Vec<&str> = text.lines().filter(|l| l.contains(",100,occupancy,")).collect();
    assert_eq!(last.len(), 4);
    for line in last {
        let mean: f64 = line.split(',').nth(3).unwrap().parse().unwrap();
        assert!(mean > 0.99, "{line}");
    }
}

#[test]
fn what_is_no_figure_of_ours_and_what_has_no_campaign_is_refused() {
    let shell = Shell::new();
    let error = |line: &str| shell.expect(line, 2).err;
    assert!(error("figure 4").contains("possible values: 1, 2, 3, 5, 6, 7, gain"));
    assert!(error("table 2").contains("possible values: 1"));
    assert!(error("figure 7 --quiet --out f").contains("configs/fig7.ron"));
    shell.write("file", "");
    shell.refuse("paper --out file/x", &["file/x: cannot be made"]);
}

/// Makes a folder with quick campaigns of Table 1 and Fig. 7 in a small room, from drawn starts.
fn small(keep_paths: bool) -> Shell {
    let shell = Shell::new();
    std::fs::create_dir(shell.path("configs")).unwrap();
    shell.write("room.ron", "(name: \"room\", extent: (width: 3.0, height: 2.4), obstacles: [])");
    for (name, driving, strategies) in [
        (
            "table1",
            "while_driving: 0.25",
            "Cl, Count(times: 1.0, half_distance: None), Count(times: 50.0, half_distance: 2.0)",
        ),
        ("fig7", "", "Cl, Ig"),
    ] {
        let campaign = format!(
            "(
    name: \"{name}-quick\",
    worlds: [(name: \"room\", file: \"../room.ron\", resolution: 0.2)],
    settings: [(name: \"paper\", config: {:?}, {driving})],
    strategies: [{strategies}],
    starts: Drawn(count: 2, seed: 1),
    seeds: (first: 3, count: 1),
    metrics: [\"scans\"],
    keep_paths: {keep_paths},
)",
            shipped("configs/paper.ron")
        );
        shell.write(&format!("configs/{name}-quick.ron"), campaign);
    }
    shell
}

#[test]
fn fig_5_repeats_the_recorded_runs_and_fig_7_draws_their_paths() {
    let shell = small(true);
    shell.expect("figure 5 --quick --quiet --out f", 0);
    shell.expect("figure 7 --quick --quiet --out f", 0);
    for figure in ["5a", "5b", "5c", "7c", "7d"] {
        assert!(shell.path(&format!("f/figure{figure}.svg")).exists(), "{figure}");
    }
    let column = |name: &str| column(&shell, "f/table1.csv", name);
    assert_eq!(column("times")[..3], ["", "1", "50"]);
    assert!(column("cut_short").iter().all(|told| told.ends_with(" of 2")));
    // The names of the campaigns contain the counts of n*.
    let names: Vec<String> = std::fs::read_dir(shell.path("f/campaigns"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.starts_with("table1-quick-n-star-"))
        .collect();
    assert!(
        matches!(&names[..], [name] if name.rsplit('-').next().unwrap().parse::<u32>().is_ok())
    );
}

/// Returns the fields of a column of a table.
fn column(shell: &Shell, table: &str, name: &str) -> Vec<String> {
    let text = std::fs::read_to_string(shell.path(table)).unwrap();
    let row = |line: &str| -> Vec<String> {
        line.replace(", ", ";").split(',').map(|field| field.trim_matches('"').into()).collect()
    };
    let mut lines = text.lines().map(row);
    let columns = lines.next().unwrap();
    let at = columns.iter().position(|column| column == name).unwrap();
    lines.map(|line| line[at].clone()).collect()
}

#[test]
fn runs_that_were_cut_short_are_told_in_tables_and_drawings() {
    let shell = small(true);
    let fig7 = std::fs::read_to_string(shell.path("configs/fig7-quick.ron")).unwrap();
    let cut = fig7.replace("configs/paper.ron\", ", "configs/paper.ron\", max_scans: 2, ");
    shell.write("configs/fig7.ron", cut.replace("fig7-quick", "fig7"));
    let counts = fig7.replace("Cl, Ig", "Cl, Count(times: 2.0, half_distance: 3.0)");
    let driving = counts.replace("paper.ron\", ", "paper.ron\", while_driving: 0.25, ");
    shell.write("configs/fig6-quick.ron", driving.replace("fig7-quick", "fig6-quick"));
    shell.expect("figure 7 --quick --quiet --out whole", 0);
    shell.expect("figure 7 --quiet --out cut", 0);
    shell.expect("figure 6 --quick --quiet --out whole", 0);
    let column = |table: &str, name: &str| column(&shell, table, name);
    assert_eq!(column("whole/figure7.csv", "cut_short"), ["0"; 4]);
    assert_eq!(column("cut/figure7.csv", "cut_short"), ["2"; 4]);
    assert_eq!(column("whole/figure6.csv", "cut_short"), ["0"; 4]);
    assert_eq!(column("whole/figure6.csv", "times"), ["", "", "2", "2"]);
    assert_eq!(column("whole/figure6.csv", "half_distance"), ["", "", "3", "3"]);
    for figure in ["figure7", "figure7c"] {
        let read = |dir: &str| std::fs::read(shell.path(&format!("{dir}/{figure}.svg"))).unwrap();
        assert!(read("whole") != read("cut"), "{figure}");
    }
    let svg = std::fs::read_to_string(shell.path("cut/figure7.svg")).unwrap();
    assert!(svg.contains("hollow"), "the drawing says what hollow marks are");
}

#[test]
fn paths_that_were_not_kept_are_missed_aloud() {
    let shell = small(false);
    for figure in [5, 7] {
        let typed = shell.expect(&format!("figure {figure} --quick --quiet --out f"), 2);
        assert!(
            typed.err.contains("start 0, seed 3; the campaign needs `keep_paths: true`"),
            "{typed:?}"
        );
    }
}

#[test]
fn all_experiments_are_checked_before_the_first_run_and_an_old_report_is_not_touched() {
    let shell = small(true);
    std::fs::create_dir(shell.path("p")).unwrap();
    shell.write("p/figure1.svg", "old");
    // The campaign of Fig. 6 is missing.
    let typed = shell.expect("paper --quick --quiet --out p", 2);
    assert!(typed.err.contains("configs/fig6-quick.ron: cannot be read"), "{typed:?}");
    assert!(!shell.path("p/campaigns").exists() && shell.path("p/figure1.svg").exists());
    for name in ["fig6", "worlds", "ablation"] {
        let campaign = std::fs::read_to_string(shell.path("configs/fig7-quick.ron")).unwrap();
        let file = if name == "ablation" { name.to_owned() } else { format!("{name}-quick") };
        shell.write(&format!("configs/{file}.ron"), campaign.replace("fig7", name));
    }
    let line = "paper --quick --quiet --out p --world museum=museum.yaml";
    let typed = shell.expect(line, 2);
    assert!(typed.err.contains("no world called \"museum\""), "{typed:?}");
    let typed = shell.expect("paper --quick --quiet --out p --world room=museum.yaml", 2);
    assert!(typed.err.contains("museum.yaml: "), "{typed:?}");
    assert!(!shell.path("p/campaigns").exists());
}
