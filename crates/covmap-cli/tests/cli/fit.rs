//! `fit` and `survey`.

use crate::typed::{Shell, shipped};
use covmap_lab::Config;

/// Writes a file for a fit that takes moments: a small room, few scans, coarse cells, two
/// parameters.
fn small_fit(shell: &Shell, change: impl Fn(String) -> String) {
    shell.write("room.ron", "(name: \"room\", extent: (width: 3.0, height: 2.4), obstacles: [])");
    let source = |turn, seed| {
        format!(
            "Simulated((scenario: \"room.ron\", turn: {turn}, shift: (0.02, 0.05), \
             strategy: Cl, scans: 6, seed: {seed}))"
        )
    };
    let fit = format!(
        "(\n config: {:?}, resolution: 0.2, seed: 3, starts: 2, evaluations: 12,\n \
         weighting: Classes,\n axes: [(parameter: SigmaIn, from: 0.15, to: 0.5),\n \
         (parameter: Tempering, from: 0.1, to: 1.0)],\n training: [{}, {}],\n held_out: [{}, {}],\n)",
        shipped("configs/fit/product-begin.ron"),
        source(0.2, 1),
        source(0.4, 2),
        source(0.1, 3),
        source(0.7, 4)
    );
    shell.write("fit.ron", change(fit));
}

#[test]
fn a_fit_writes_a_configuration_that_explores() {
    let shell = Shell::new();
    small_fit(&shell, |fit| fit);
    let typed = shell.expect("fit fit.ron --out fitted", 0);
    assert!(typed.out.contains("training") && typed.out.contains("held out"), "{typed:?}");
    for name in ["search", "profiles", "reliability"] {
        for kind in ["svg", "png"] {
            let path = shell.path("fitted").join(format!("{name}.{kind}"));
            assert!(std::fs::metadata(path).unwrap().len() > 0, "{name}");
        }
    }
    let report = shell.json("fitted/fit.json");
    let objective = |which: &str| {
        ["free", "partial", "solid"]
            .map(|class| report["training"][which][class]["log_likelihood"].as_f64().unwrap())
            .iter()
            .sum::<f64>()
    };
    assert!(objective("after") >= objective("before"));
    assert_eq!(report["path"].as_array().unwrap().len(), 24);
    assert_eq!(report["profiles"].as_array().unwrap().len(), 2);
    // The read-out is fitted to the same cells, and makes them likelier still.
    let mean = |which: &str| report["training"][which].clone();
    assert!(objective("read_out") > objective("after"), "{:?}", mean("read_out"));
    let held_out = report["held_out"].as_array().unwrap();
    assert_eq!(held_out.len(), 2);
    for figure in ["error_of_mode", "between", "found", "central_90", "held_90"] {
        assert!(held_out[0]["after"]["partial"][figure].as_f64().is_some(), "{figure}");
    }
    assert!(typed.out.contains("room turned 5.7°, CL, r = 0.2 m, seed 3"), "{typed:?}");
    let config: Config = covmap_io::read_ron(shell.path("fitted/config.ron")).unwrap();
    let tempering = config.model.update.product().unwrap().tempering;
    let reported = &report["after"]["update"]["Product"]["tempering"];
    assert!((tempering - reported.as_f64().unwrap()).abs() < 1e-12);
    let explore = "explore room.ron --config fitted/config.ron --resolution 0.2 --max-scans 2";
    shell.expect(explore, 3);
    // The same file gives the same fit.
    shell.expect("fit fit.ron --out again", 0);
    let read = |name: &str| std::fs::read(shell.path(name)).unwrap();
    assert!(read("fitted/config.ron") == read("again/config.ron"));
    assert!(read("fitted/read_out.ron") == read("again/read_out.ron"));
    assert!(read("fitted/fit.json") == read("again/fit.json"));
}

#[test]
fn a_map_is_read_through_a_read_out_and_its_belief_stays() {
    let shell = Shell::new();
    small_fit(&shell, |fit| fit);
    shell.expect("fit fit.ron --out fitted", 0);
    let explore = "explore room.ron --config fitted/config.ron --resolution 0.2 --max-scans 6";
    shell.expect(&format!("{explore} --out plain"), 3);
    let typed = shell.expect(&format!("{explore} --read-out fitted/read_out.ron --out read"), 3);
    assert!(typed.out.contains("read through fitted/read_out.ron"), "{typed:?}");
    let bytes = |name: &str| std::fs::read(shell.path(name)).unwrap();
    for same in ["belief.bin", "trace.jsonl", "truth.png", "certificate.png"] {
        assert!(bytes(&format!("plain/{same}")) == bytes(&format!("read/{same}")), "{same}");
    }
    for other in ["coverage.png", "entropy.png", "map.pgm", "reliability.png"] {
        assert!(bytes(&format!("plain/{other}")) != bytes(&format!("read/{other}")), "{other}");
    }
    let (plain, read) = (shell.json("plain/summary.json"), shell.json("read/summary.json"));
    assert!(plain.get("read_out").is_none() && read["read_out"] == "fitted/read_out.ron");
    assert_eq!(plain["trace_hash"], read["trace_hash"]);
    let cells = |summary: &serde_json::Value| summary["measured"]["all"]["cells"].as_u64();
    assert!(cells(&plain) > Some(50) && cells(&plain) == cells(&read));
    let likelihood = |summary: &serde_json::Value| summary["mean_log_likelihood"].as_f64().unwrap();
    assert!(likelihood(&read) > likelihood(&plain));
    // Without --out, the folder's name states the read-out.
    shell.expect(&format!("{explore} --read-out fitted/read_out.ron"), 3);
    assert!(shell.path("out/room-IG_CL-0.3-1-config-max6-read_out").is_dir());
}

#[test]
fn files_that_are_no_read_out_are_refused() {
    let shell = Shell::new();
    shell.write("room.ron", "(name: \"room\", extent: (width: 3.0, height: 2.4), obstacles: [])");
    let refuse = |text: &str, parts: &[&str]| {
        shell.write("read_out.ron", text);
        shell.refuse("explore room.ron --read-out read_out.ron --max-scans 1", parts);
    };
    refuse("(bias: [0.0, 0.0], weights: [[1.0, 0.0]])", &["read_out.ron:1:", "1 rows for 2 bins"]);
    refuse("(bias: [0.0, NaN], weights: [[1.0, 0.0], [0.0, 1.0]])", &["bias[1]: NaN must lie in"]);
    let rows = "(bias: [0.0, 0.0],\n weights: [[1.0, 0.0], [1.0]])";
    refuse(rows, &["read_out.ron:2:", "weights[1]: 1 numbers for 2 bins"]);
    let other = "(bias: [0.0, 0.0], weights: [[1.0, 0.0], [0.0, 1.0]])";
    refuse(other, &["read_out.ron: the read-out is for maps of 2 bins, and this one has 11"]);
    refuse("(bias: [0.0, 0.0], tables: [])", &["read_out.ron:1:", "tables"]);
    shell.refuse("explore room.ron --read-out nowhere.ron", &["nowhere.ron", "cannot be read"]);
    shell.refuse("map nowhere.log --read-out nowhere.ron", &["nowhere"]);
}

#[test]
fn whole_runs_of_every_kind_are_trained_on() {
    let shell = Shell::new();
    small_fit(&shell, |fit| {
        let whole = "surface: Smooth, resolution: 0.3, strategy: Cl";
        fit.replace("strategy: Cl, scans: 6, seed: 3", &format!("{whole}, seed: 3"))
            .replace("evaluations: 12", "evaluations: 3")
            .replace("starts: 2", "starts: 1")
            .replace(
                "resolution: 0.2",
                &format!("explorer: {:?}, resolution: 0.2", shipped("configs/fit/b21r-begin.ron")),
            )
    });
    let typed = shell.expect("fit fit.ron --out fitted", 0);
    assert!(typed.out.contains("smooth, CL, r = 0.3 m, seed 3"), "{typed:?}");
    let report = shell.json("fitted/fit.json");
    let cells = |i: usize| report["held_out"][i]["after"]["all"]["cells"].as_u64().unwrap();
    assert!(cells(0) > 50 && cells(0) < cells(1), "{report}");
}

#[test]
fn impossible_fits_are_refused() {
    let shell = Shell::new();
    let refuse = |from: &str, to: &str, parts: &[&str]| {
        small_fit(&shell, |fit| {
            assert!(fit.contains(from), "{from}");
            fit.replace(from, to)
        });
        shell.refuse("fit fit.ron --out fitted", parts);
    };
    refuse("room.ron", "nowhere.ron", &["nowhere.ron", "cannot be read"]);
    refuse("to: 0.5", "to: 0.1", &["SigmaIn", "from 0.15"]);
    refuse("parameter: SigmaIn", "parameter: Tempering", &["Tempering has two axes"]);
    refuse("from: 0.1,", "from: NaN,", &["Tempering", "finite"]);
    refuse("scans: 6", "scans: 0", &["scans: 0"]);
    refuse("scans: 6", "surface: Soft", &["fit.ron:", "surface"]);
    refuse("scans: 6", "resolution: 0.0", &["resolution"]);
    refuse("parameter: SigmaIn", "parameter: Chance", &["Chance is no parameter", "update"]);
    let other = format!("explorer: {:?}, resolution: 0.2, seed", shipped("configs/sonar8.ron"));
    refuse("resolution: 0.2, seed", &other, &["explorer", "another robot"]);
    refuse("starts: 2", "starts: 0", &["starts"]);
    refuse("turn: 0.2", "turn: inf", &["turn and shift must be finite"]);
    refuse("weighting: Classes", "weighting: Votes", &["fit.ron:", "weighting"]);
    refuse("room.ron\", turn: 0.4", "fit.ron\", turn: 0.4", &["fit.ron"]);
}

#[test]
fn a_log_without_a_laser_is_no_survey() {
    let shell = Shell::new();
    shell.write("empty.log", "# nothing\n");
    shell.refuse("survey empty.log --out truth.ron", &["empty.log"]);
    shell.refuse("survey missing.log --out truth.ron", &["missing.log"]);
}

/// Checks the survey of a recorded building, and a fit to it; skipped without the recording.
#[test]
fn a_recorded_robot_is_surveyed_and_fitted() {
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/sonar8");
    if !data.is_dir() {
        eprintln!("skipped: {} is not there", data.display());
        return;
    }
    let shell = Shell::new();
    let (log, poses) = (data.join("test2"), data.join("test2_poses_corrected.txt"));
    let (log, poses) = (log.display(), poses.display());
    shell.expect(&format!("survey {log} --poses {poses} --out truth.ron"), 0);
    assert!(std::fs::metadata(shell.path("truth.png")).unwrap().len() > 0);
    let source = format!(
        "Recorded((log: \"{log}\", poses: \"{poses}\", truth: {:?}, every: 0.2, every_angle: 0.2))",
        shell.path("truth.ron")
    );
    let fit = format!(
        "(config: {:?}, resolution: 0.2, seed: 1, starts: 1, evaluations: 8, weighting: Cells, \
         axes: [(parameter: Tempering, from: 0.1, to: 1.0)], training: [{source}], held_out: [])",
        shipped("configs/sonar8.ron")
    );
    shell.write("fit.ron", fit);
    shell.expect("fit fit.ron --out fitted", 0);
    let report = shell.json("fitted/fit.json");
    assert!(report["training"]["after"]["all"]["cells"].as_u64().unwrap() > 500);
}
