//! `explore`.

use crate::typed::{Shell, shipped, short_run};
use covmap::CoverageMap;
use covmap_io::{MapCell, MapServerMap, load_map_server};

const FILES: [&str; 16] = [
    "summary.json",
    "trace.jsonl",
    "belief.bin",
    "map.pgm",
    "map.yaml",
    "coverage.png",
    "entropy.png",
    "truth.png",
    "errors.png",
    "occupancy.png",
    "partial.png",
    "partial.svg",
    "certificate.png",
    "certificate.csv",
    "reliability.svg",
    "reliability.png",
];
const KEYS: [&str; 27] = [
    "world",
    "strategy",
    "update",
    "seed",
    "resolution",
    "ending",
    "scans",
    "decisions",
    "bumps",
    "path_length_m",
    "turns_rad",
    "cells",
    "completeness",
    "wall_recall",
    "wall_recall_rough",
    "wall_recall_smooth",
    "phantom",
    "mae_mode",
    "mae_mean",
    "mean_log_likelihood",
    "share_entropy_above_0_65",
    "cut_off",
    "negative_gains",
    "capped_cells",
    "seconds",
    "trace_hash",
    "measured",
];

#[test]
fn the_version_names_the_commit_or_a_hash_of_the_sources() {
    let typed = Shell::new().expect("--version", 0);
    let version = typed.out.trim().strip_prefix("covmap ").unwrap();
    let (cargo, build) = version.split_once('+').unwrap();
    assert_eq!(cargo, env!("CARGO_PKG_VERSION"));
    let is_hash = |text: &str| text.len() == 12 && text.bytes().all(|b| b.is_ascii_hexdigit());
    let is_build = match &build.split('.').collect::<Vec<_>>()[..] {
        [commit] => is_hash(commit),
        ["sources", hash] => is_hash(hash),
        [commit, "dirty", hash] => is_hash(commit) && is_hash(hash),
        _ => false,
    };
    assert!(is_build, "{version}");
}

#[test]
fn a_run_writes_every_file_and_ends_when_its_budget_is_spent() {
    let shell = Shell::new();
    let typed = shell.expect(&short_run(), 3);
    assert!(typed.out.contains("budget") && typed.out.contains("run"), "{typed:?}");
    assert_eq!(typed.err, "", "nothing of the progress when piped");
    for word in ["(exhausted: ", "wall recall: ", "docs/guide.md#reading-the-summary"] {
        assert!(typed.out.contains(word), "{word} is explained where it is printed: {typed:?}");
    }
    for name in FILES {
        assert!(std::fs::metadata(shell.path("run").join(name)).unwrap().len() > 0, "{name}");
    }
    assert!(!shell.path("run.partial").exists());
    let summary = shell.json("run/summary.json");
    let fields = summary.as_object().unwrap();
    for key in KEYS {
        let may_be_null = key.starts_with("wall_recall_");
        assert!(fields.get(key).is_some_and(|value| may_be_null || !value.is_null()), "{key}");
    }
    assert_eq!(fields.len(), KEYS.len());
    assert_eq!(summary["ending"], "BudgetSpent");
    assert_eq!(summary["scans"], 30);
    assert_eq!(summary["strategy"], "IG_CL:0.1");
}

#[test]
fn more_effort_takes_more_scans() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    let scans = ["quick", "standard", "thorough"].map(|effort| {
        shell.expect(&format!("explore {lab} --resolution 0.2 --quiet --effort {effort}"), 0);
        let summary = format!("out/lab-IG_CL-0.1-1-{effort}-r0.2/summary.json");
        shell.json(&summary)["scans"].as_u64().unwrap()
    });
    assert!(scans.is_sorted_by(|a, b| a < b), "{scans:?}");
    let typed = shell.expect(&format!("explore {lab} --effort lazy"), 2);
    assert!(typed.err.contains("quick, standard, thorough"), "{}", typed.err);
}

#[test]
fn a_small_room_is_explored_to_its_end() {
    let shell = Shell::new();
    shell.write("room.ron", "(name: \"room\", extent: (width: 2.4, height: 2.0), obstacles: [])");
    let typed = shell.expect("explore room.ron --resolution 0.2 --strategy CL --seed 3", 0);
    assert!(typed.out.contains("explored: nothing is open"), "{typed:?}");
    let summary = shell.json("out/room-CL-3-r0.2/summary.json");
    assert_eq!(summary["ending"], "Explored");
    assert_eq!(summary["cells"]["open"], 0);
}

#[test]
fn a_robot_that_cannot_leave_its_start_says_so() {
    let shell = Shell::new();
    let wall = |from, to| {
        format!("(shape: Wall(from: {from}, to: {to}, thickness: 0.1), surface: Rough),")
    };
    let closet = [
        wall("(0.0, 0.6)", "(2.0, 0.6)"),
        wall("(0.0, 1.4)", "(2.0, 1.4)"),
        wall("(0.6, 0.0)", "(0.6, 2.0)"),
        wall("(1.4, 0.0)", "(1.4, 2.0)"),
    ];
    let start = "start: (x: 1.0, y: 1.0, heading: 0.0)";
    let extent = "extent: (width: 2.0, height: 2.0)";
    let world = format!("(name: \"closet\", {extent}, {start}, obstacles: [{}])", closet.concat());
    shell.write("closet.ron", world);
    let typed = shell.expect("explore closet.ron --resolution 0.2 --out run", 4);
    assert!(typed.out.contains("could not leave its start"), "{typed:?}");
    assert_eq!(shell.json("run/summary.json")["ending"], "StartBlocked");
}

#[test]
fn quiet_is_quiet() {
    let shell = Shell::new();
    let typed = shell.expect(&format!("{} --quiet", short_run()), 3);
    assert_eq!((typed.out.as_str(), typed.err.as_str()), ("", ""));
}

/// Registers narrower than the processor's are used as requested; wider ones are not available.
#[test]
fn an_exploration_is_the_same_run_with_every_kind_of_vector_registers() {
    let shell = Shell::new();
    let hash = |kind: &str| {
        shell.expect(&format!("{} --strategy IG --registers {kind} --quiet", short_run()), 3);
        shell.json("run/summary.json")["trace_hash"].as_str().unwrap().to_owned()
    };
    let all = ["scalar", "avx2", "avx512"].map(hash);
    assert!(all.iter().all(|hash| *hash == all[0]), "{all:?}");
}

#[test]
fn the_same_command_is_the_same_run_on_any_number_of_threads() {
    let shell = Shell::new();
    let hash = |threads: &str, seed: &str| {
        let mut command = shell.command(&format!("{} --seed {seed} --quiet --force", short_run()));
        if !threads.is_empty() {
            command.env("RAYON_NUM_THREADS", threads);
        }
        assert_eq!(command.status().unwrap().code(), Some(3));
        let files = ["trace.jsonl", "belief.bin", "map.pgm", "coverage.png"];
        let files = files.map(|name| std::fs::read(shell.path("run").join(name)).unwrap());
        (shell.json("run/summary.json")["trace_hash"].as_str().unwrap().to_owned(), files)
    };
    let first = hash("", "1");
    assert_eq!(first.0.len(), 64);
    for threads in ["", "1", "2"] {
        assert!(hash(threads, "1") == first, "{threads} threads");
    }
    assert_ne!(hash("", "2").0, first.0);
}

#[test]
fn a_foreign_folder_is_refused_and_one_of_ours_is_replaced() {
    let shell = Shell::new();
    std::fs::create_dir(shell.path("run")).unwrap();
    shell.write("run/thesis.txt", "years of work");
    shell.refuse(&short_run(), &["run: was not written by covmap"]);
    std::fs::remove_file(shell.path("run/thesis.txt")).unwrap();
    shell.expect(&short_run(), 3);
    shell.write("run/note.txt", "mine");
    shell.expect(&short_run(), 3);
    assert!(shell.path("run/note.txt").exists());
    assert_eq!(shell.json("run/summary.json")["scans"], 30);
    // Another run does not replace the folder without --force.
    let other = short_run().replace("30", "5");
    shell.refuse(&other, &["run: holds another run (explore lab, IG_CL:0.1, seed 1", "--force"]);
    shell.expect(&format!("{other} --force"), 3);
    assert!(!shell.path("run/note.txt").exists());
    assert_eq!(shell.json("run/summary.json")["scans"], 5);
    // A map corrected by hand is kept, too.
    shell.write("run/map.yaml", "image: map.pgm");
    shell.refuse(&other, &["run/map.yaml: is not as covmap wrote it"]);
}

#[test]
fn the_names_of_folders_tell_runs_apart() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    let sonar8 = shipped("configs/sonar8.ron");
    let b21r = shipped("configs/b21r.ron");
    let mut names = Vec::new();
    for (typed, name) in [
        ("".to_owned(), "lab-IG_CL-0.1-1-max1"),
        (format!("--config {b21r} --resolution 0.1"), "lab-IG_CL-0.1-1-max1"),
        ("--resolution 0.2".to_owned(), "lab-IG_CL-0.1-1-r0.2-max1"),
        ("--start 1,1,-90".to_owned(), "lab-IG_CL-0.1-1-at1_1_-90-max1"),
        ("--while-driving 0.5".to_owned(), "lab-IG_CL-0.1-1-every0.5-max1"),
        (format!("--config {sonar8}"), "lab-IG_CL-0.3-1-sonar8-max1"),
    ] {
        shell.expect(&format!("explore {lab} --max-scans 1 --quiet {typed}"), 3);
        names.push(name);
        let mut entries: Vec<_> = std::fs::read_dir(shell.path("out"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        entries.sort();
        names.sort_unstable();
        names.dedup();
        assert_eq!(entries, names, "{typed}");
    }
}

#[test]
fn a_folder_that_holds_an_input_is_not_replaced() {
    let shell = Shell::new();
    // After few scans, too few cells are certain for a robot to fit into the map.
    shell.expect(&short_run().replace("--max-scans 30", ""), 0);
    let line = "explore run/map.yaml --resolution 0.2 --max-scans 1 --out run --force";
    shell.refuse(line, &["run: holds run/map.yaml, which this command reads"]);
}

/// Returns the map that a run wrote, its belief, and the counts of map.pgm's cells as in the
/// report: free, occupied, unknown.
fn written(shell: &Shell) -> (MapServerMap, CoverageMap, [usize; 3]) {
    let map = load_map_server(shell.path("run/map.yaml")).unwrap();
    let belief = std::fs::read(shell.path("run/belief.bin")).unwrap();
    let belief = CoverageMap::from_bytes(&belief).unwrap();
    let image = std::fs::read(shell.path("run/map.pgm")).unwrap();
    let greys = &image[image.len() - belief.grid().len()..];
    let counts = [254, 0, 205].map(|grey| greys.iter().filter(|g| **g == grey).count());
    (map, belief, counts)
}

#[test]
fn what_leaves_for_other_software_is_safe() {
    let shell = Shell::new();
    let lab = shipped("scenarios/lab.ron");
    let typed = shell.expect(&format!("explore {lab} --resolution 0.2 --out run"), 0);
    let (map, belief, [free, occupied, unknown]) = written(&shell);
    assert!(
        typed
            .out
            .contains(&format!("  map.pgm: {free} free, {occupied} occupied, {unknown} unknown\n"))
    );
    assert!(free > 0 && occupied > 0 && free + occupied + unknown == belief.grid().len());
    let (mut found, mut unsure) = ([0; 3], 0);
    for (cell, read) in map.cells.iter() {
        let here = belief.grid().cell_at(map.grid.center(cell)).unwrap();
        let (mode, entropy) = (belief.mode(here), belief.entropy(here));
        let at = map.grid.center(cell);
        let is_inside = (0.0..6.0).contains(&at.x) && (0.0..4.5).contains(&at.y);
        let resolved = belief.is_known(here) && entropy <= 0.6;
        unsure += usize::from(belief.is_known(here) && !resolved);
        let expected = match *read {
            MapCell::Occupancy(p) if p < 0.5 => (0, resolved && mode <= 0.2 && is_inside),
            // A cell that is most likely an obstacle is occupied, unless its belief says next to
            // nothing.
            MapCell::Occupancy(_) => (1, belief.is_known(here) && mode >= 0.5 && entropy <= 2.28),
            // Beyond the lab, 6 m × 4.5 m, nothing is free.
            MapCell::Unknown if mode >= 0.5 => (2, !belief.is_known(here) || entropy > 2.27),
            MapCell::Unknown => (2, !resolved || mode > 0.2 || !is_inside),
        };
        found[expected.0] += 1;
        assert!(expected.1, "{here:?} is {read:?}: {mode} {entropy}");
    }
    assert_eq!(found[..2], [free, occupied], "all that is not unknown is read back");
    assert!(unsure > 0, "there are cells that are known, but not well");
}

#[test]
fn thresholds_of_the_map_are_options_and_the_files_name_them() {
    let shell = Shell::new();
    let yaml = || std::fs::read_to_string(shell.path("run/map.yaml")).unwrap();
    let counts = |options: &str| {
        shell.expect(&format!("{} {options}", short_run()), 3);
        written(&shell).2
    };
    let usual = counts("");
    let default = "# free (254): known, entropy <= 0.6 nats, most likely coverage <= 0.2\n";
    assert!(yaml().contains(default), "{}", yaml());
    let loose = counts("--map-entropy 1.1");
    // A required entropy holds for obstacles, too.
    assert!(loose[0] > usual[0] && loose[1] < usual[1], "{loose:?}");
    let strict = counts("--map-entropy 0.3 --map-free 0.1 --map-occupied 0.9");
    assert!(strict[0] < usual[0] && strict[2] > usual[2], "{strict:?}");
    for line in [
        "# free (254): known, entropy <= 0.3 nats, most likely coverage <= 0.1\n",
        "# occupied (0): known, entropy <= 0.3 nats, most likely coverage >= 0.9\n",
    ] {
        assert!(yaml().contains(line), "{}", yaml());
    }
    for wrong in ["--map-entropy=-1", "--map-free 1.5", "--map-occupied wide"] {
        let typed = shell.expect(&format!("{} {wrong}", short_run()), 2);
        assert!(typed.err.contains("it must lie in") || typed.err.contains("not a number"));
    }
}

#[test]
fn the_map_of_a_run_is_a_world_whose_unknown_cells_are_solid() {
    let shell = Shell::new();
    shell.expect(&short_run(), 3);
    let free = written(&shell).2[0];
    let again = "explore run/map.yaml --resolution 0.2 --max-scans 3 --out again";
    let typed = shell.expect(again, 3);
    let area = format!("run/map.yaml: {:.2} m² free", 0.04 * free as f64);
    assert!(typed.out.starts_with(&area), "{area}: {typed:?}");
}

#[test]
fn a_map_of_map_server_is_a_world() {
    let shell = Shell::new();
    let (width, height) = (40, 30);
    let mut image = format!("P5\n{width} {height}\n255\n").into_bytes();
    let inside = |i: usize, n: usize| (2..n - 2).contains(&i);
    let free = |x, y| inside(x, width) && inside(y, height);
    image.extend((0..width * height).map(|i| 254 * u8::from(free(i % width, i / width))));
    shell.write("cellar.pgm", image);
    let yaml = "image: cellar.pgm\nresolution: 0.1\norigin: [-2.0, -1.0, 0.0]\nnegate: 0\n\
                occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    shell.write("cellar.yaml", yaml);
    let typed = "explore cellar.yaml --resolution 0.2 --start -0.5,0.5,90 --max-scans 4 \
                 --strategy COUNT:5:2 --while-driving 0.3";
    shell.expect(typed, 3);
    let first = std::fs::read_to_string(
        shell.path("out/cellar-COUNT-5-2-1-r0.2-at-0.5_0.5_90-every0.3-max4/trace.jsonl"),
    )
    .unwrap();
    assert!(first.contains("[-0.5,0.5]"), "the start is the one that was typed");
}

#[test]
fn the_configuration_is_the_one_that_was_named() {
    let shell = Shell::new();
    let config = shipped("configs/sonar8.ron");
    shell.expect(&format!("{} --config {config}", short_run()), 3);
    let summary = shell.json("run/summary.json");
    assert_eq!(summary["resolution"], 0.2);
}

#[test]
fn help_names_all_options() {
    let shell = Shell::new();
    let help = shell.expect("explore --help", 0).out;
    for option in [
        "--config",
        "--strategy",
        "--seed",
        "--resolution",
        "--while-driving",
        "--max-scans",
        "--start",
        "--out",
        "--quiet",
        "130",
        "summary.json",
    ] {
        assert!(help.contains(option), "{option}");
    }
    let help = shell.expect("--help", 0).out;
    for command in ["explore", "explain", "map", "log", "truth", "model"] {
        assert!(help.contains(command), "{command}");
    }
}

#[test]
fn a_parameter_is_set_without_a_file_of_ones_own() {
    let shell = Shell::new();
    let line = |rest: &str| {
        let lab = shipped("scenarios/lab.ron");
        format!("explore {lab} --resolution 0.2 --max-scans 2 --quiet {rest}")
    };
    shell.expect(&line("--set planner.scope=Reachable --set planner.entropy_threshold=1.5"), 3);
    let run = "out/lab-IG_CL-0.1-1-scope_Reachable-entropy_threshold_1.5-r0.2-max2";
    let trace = std::fs::read_to_string(shell.path(&format!("{run}/trace.jsonl"))).unwrap();
    assert!(
        trace.contains(r#""scope":"Reachable""#) && trace.contains(r#""entropy_threshold":1.5"#)
    );
    shell.refuse(&line("--set planner.scoop=1"), &["--set planner.scoop=1: ", "is no parameter"]);
    shell.refuse(&line("--set planner.entropy_threshold=9"), &["entropy_threshold: 9 must lie in"]);
    shell.refuse(&line("--set resolution=fine"), &["--set resolution=fine", "invalid type"]);
}
