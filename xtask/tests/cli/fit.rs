//! `fit` and `survey`.

use crate::typed::{Shell, shipped};
use covmap_explore::Config;

/// A fit that takes moments: a small room, few scans, coarse cells, two parameters.
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
        shipped("configs/b21r.ron"),
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
    for name in ["search.svg", "search.png", "profiles.svg", "profiles.png"] {
        assert!(std::fs::metadata(shell.path("fitted").join(name)).unwrap().len() > 0, "{name}");
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
    assert!(read("fitted/fit.json") == read("again/fit.json"));
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

/// The walls of a recorded building, and a fit to it; skipped where the record is absent.
#[test]
fn a_recorded_robot_is_surveyed_and_fitted() {
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/sonar8");
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
