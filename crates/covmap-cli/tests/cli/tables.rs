//! `truth` and `model`.

use crate::typed::{Shell, shipped};

/// Returns the rows of a table with a heading.
fn rows(shell: &Shell, name: &str, heading: &str) -> Vec<[f64; 3]> {
    let text = std::fs::read_to_string(shell.path(name)).unwrap();
    let (first, rest) = text.split_once('\n').unwrap();
    assert_eq!(first, heading);
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    rest.lines().map(row).collect()
}

#[test]
fn the_coverage_of_all_cells_sums_to_the_area_of_the_obstacles() {
    let shell = Shell::new();
    let text = "(name: \"areas\", extent: (width: 4.0, height: 3.0), obstacles: [
        (shape: Rectangle(center: (1.0, 1.5), size: (1.0, 0.5), angle: 0.3), surface: Rough),
        (shape: Circle(center: (3.0, 1.5), radius: 0.4), surface: Smooth),
    ])";
    shell.write("areas.ron", text);
    let circle = 32.0 * 0.4 * 0.4 * (std::f64::consts::TAU / 64.0).sin();
    for (resolution, margin) in [(0.1, 3.0), (0.25, 2.0)] {
        shell.expect(&format!("truth areas.ron --resolution {resolution} --out t.csv --force"), 0);
        let rows = rows(&shell, "t.csv", "x,y,coverage");
        let shown: f64 =
            rows.iter().map(|[_, _, coverage]| coverage * resolution * resolution).sum();
        let border = 2.0 * margin * resolution;
        let outside = (4.0 + border) * (3.0 + border) - 4.0 * 3.0;
        assert!((shown - outside - 0.5 - circle).abs() < 1e-7, "{shown}");
        let sorted = rows.windows(2).all(|w| (w[0][1], w[0][0]) < (w[1][1], w[1][0]));
        assert!(sorted, "row by row from the lower left");
        let first = 0.5 * resolution - margin * resolution;
        assert!((rows[0][0] - first).abs() < 1e-12 && (rows[0][1] - first).abs() < 1e-12);
    }
    assert!(!shell.path("t.csv.partial").exists());
}

#[test]
fn every_column_of_figure_3_sums_to_one() {
    let shell = Shell::new();
    for config in ["b21r", "paper", "sonar8"] {
        let config = shipped(&format!("configs/{config}.ron"));
        let loaded: covmap_lab::Config = covmap_io::read_ron(&config).unwrap();
        let behind = loaded.model.update.behind().max(0.2);
        shell.expect(&format!("model --config {config} --range 1 --out m.csv --force"), 0);
        let rows = rows(&shell, "m.csv", "cell_distance,coverage,probability");
        let columns: Vec<&[[f64; 3]]> =
            rows.chunk_by(|a, b| a[0].total_cmp(&b[0]).is_eq()).collect();
        for column in &columns {
            assert!((column.iter().map(|row| row[2]).sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(
                column[0][1].abs() < 1e-12 && (column[column.len() - 1][1] - 1.0).abs() < 1e-12
            );
        }
        let step = columns[1][0][0] - columns[0][0][0];
        let last = columns[columns.len() - 1][0][0];
        assert!((columns[0][0][0] - 5.0 * step).abs() < 1e-12, "from r/2 in steps of r/10");
        assert!(
            (last - (1.0 + 5.0 * step + behind)).abs() < step,
            "to d + r/2 + .20, or farther: {last}"
        );
    }
}

#[test]
fn the_shipped_default_needs_no_file() {
    let shell = Shell::new();
    shell.expect("model --range 1 --out a.csv", 0);
    let config = shipped("configs/b21r.ron");
    shell.expect(&format!("model --config {config} --range 1 --out b.csv"), 0);
    let read = |name| std::fs::read(shell.path(name)).unwrap();
    assert_eq!(read("a.csv"), read("b.csv"));
}

#[test]
fn a_table_that_cannot_be_written_leaves_nothing() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    std::fs::create_dir(shell.path("folder")).unwrap();
    shell
        .refuse(&format!("truth {lab} --out nowhere/t.csv"), &["nowhere/t.csv: cannot be written"]);
    shell.refuse(
        &format!("truth {lab} --out folder"),
        &["folder: cannot be written: it is a folder"],
    );
    shell.refuse("model --range 1 --out nowhere/m.csv", &["nowhere/m.csv: cannot be written"]);
    shell.refuse("model --range 7 --out m.csv", &["--range 7", "configs/b21r.ron", "usable range"]);
}
