//! `figure`, `table` and `paper`.

use crate::typed::Shell;

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
    assert!(error("figure 4").contains("possible values: 1, 2, 3, 5, 6, 7"));
    assert!(error("table 2").contains("possible values: 1"));
    assert!(error("figure 7 --quiet --out f").contains("configs/fig7.ron"));
    shell.write("file", "");
    shell.refuse("paper --out file/x", &["file/x: cannot be made"]);
}
