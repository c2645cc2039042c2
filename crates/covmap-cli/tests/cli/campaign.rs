//! `campaign` and `collect`: the same bytes, whatever happens during the runs.

use crate::typed::{Shell, shipped};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Returns a shell with twelve runs of a few milliseconds each.
fn tiny() -> Shell {
    let shell = Shell::new();
    shell.write("room.ron", "(name: \"room\", extent: (width: 3.0, height: 2.4), obstacles: [])");
    shell.write("tiny.ron", campaign(&[]));
    shell
}

/// Returns the tiny campaign, with parts of it replaced.
fn campaign(replaced: &[(&str, &str)]) -> String {
    let good = format!(
        "(
    name: \"tiny\",
    worlds: [(name: \"room\", file: \"room.ron\", resolution: 0.2, turn: 7.0, shift: (0.05, 0.0))],
    settings: [(name: \"b21r\", config: {:?}, max_scans: 12)],
    strategies: [\"CL\", \"IG_CL:0.3\", \"COUNT:3:2\"],
    starts: Drawn(count: 2, seed: 1),
    seeds: (first: 5, count: 2),
    metrics: [\"scans\", \"path_length_m\", \"cells.resolved\"],
    keep_paths: true,
)",
        shipped("configs/b21r.ron")
    );
    replaced.iter().fold(good, |text, (part, instead)| {
        assert!(text.contains(part), "{part}");
        text.replace(part, instead)
    })
}

/// Returns everything that the campaign determines: the tables without the times, and the list.
fn bytes(shell: &Shell, dir: &str) -> Vec<Vec<u8>> {
    let files = ["runs.csv", "summary.csv", "campaign.json"];
    files.map(|name| fs::read(shell.path(dir).join(name)).unwrap()).to_vec()
}

fn run_files(shell: &Shell, dir: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(shell.path(dir).join("runs")).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Returns the names of the tables of a kind in a folder.
fn tables(shell: &Shell, dir: &str, kind: &str) -> Vec<String> {
    let entries = fs::read_dir(shell.path(dir)).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| name.starts_with(kind) && name.ends_with(".csv"));
    names.sort();
    names
}

/// Returns the lines of a run's file without clock times.
fn timeless(file: &Path) -> [String; 2] {
    let text = fs::read_to_string(file).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 3);
    [lines[0], lines[2]].map(str::to_owned)
}

#[test]
fn one_job_two_jobs_and_merged_shards_write_the_same_bytes() {
    let shell = tiny();
    let typed = shell.expect("campaign tiny.ron --jobs 1", 0);
    assert_eq!((typed.out.as_str(), typed.err.as_str()), ("out/tiny: 12 runs of tiny\n", ""));
    let expected = bytes(&shell, "out/tiny");
    shell.expect("campaign tiny.ron --jobs 2 --out two", 0);
    assert_eq!(bytes(&shell, "two"), expected);
    for (shard, count) in [(1, 3), (2, 3), (3, 2), (4, 2), (5, 2)] {
        let typed = shell.expect(&format!("campaign tiny.ron --shard {shard}/5 --out s{shard}"), 0);
        assert_eq!(typed.out, format!("s{shard}: {count} runs of tiny\n"));
    }
    let typed = shell.expect("collect s3 s1 s2 --out merged", 0);
    assert_eq!(typed.out, "merged: 8 of 12 runs of tiny\n");
    shell.expect("collect merged s5 s4 s5", 0);
    assert_eq!(bytes(&shell, "merged"), expected);
    let files = |dir: &str| run_files(&shell, dir).iter().map(|f| timeless(f)).collect::<Vec<_>>();
    assert_eq!(files("merged"), files("out/tiny"));
    assert_eq!(files("two"), files("out/tiny"));
}

#[test]
fn a_line_holds_what_the_summary_of_the_same_run_does() {
    let shell = tiny();
    let given = [("Drawn(count: 2, seed: 1)", "Given"), ("turn: 7.0, shift: (0.05, 0.0)", "")];
    shell.write("tiny.ron", campaign(&given));
    shell.expect("campaign tiny.ron --quiet", 0);
    let table = fs::read_to_string(shell.path("out/tiny/runs.csv")).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let columns = lines.next().unwrap();
    let run = lines.find(|run| run[2] == "IG_CL:0.3" && run[4] == "6").unwrap();
    let line = "explore room.ron --strategy IG_CL:0.3 --resolution 0.2 --seed 6 --max-scans 12 --out one --quiet";
    shell.expect(line, 3);
    let summary = shell.json("one/summary.json");
    for (name, value) in summary.as_object().unwrap() {
        // Groups have a column for each number, though some worlds lack walls of either surface.
        let elsewhere = ["world", "strategy", "seed", "seconds"].contains(&name.as_str());
        if elsewhere || value.is_object() || name.starts_with("wall_recall_") {
            continue;
        }
        let column = columns.iter().position(|column| column == name);
        let told = run[column.unwrap_or_else(|| panic!("no column {name}"))];
        match value.as_f64() {
            Some(number) => assert_eq!(told.parse(), Ok(number), "{name}"),
            None => assert_eq!(Some(told), value.as_str(), "{name}"),
        }
    }
    let resolved = columns.iter().position(|column| *column == "cells.resolved").unwrap();
    assert_eq!(summary["cells"]["resolved"].to_string(), run[resolved]);
}

#[test]
fn a_campaign_that_is_killed_at_any_moment_ends_with_the_same_bytes() {
    let shell = tiny();
    shell.expect("campaign tiny.ron --out whole", 0);
    let mut random = 12345_u64;
    for _ in 0..20 {
        let mut child = shell.command("campaign tiny.ron --jobs 2 --out killed").spawn().unwrap();
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        // The whole campaign takes about as long as the longest delay.
        std::thread::sleep(Duration::from_micros((random >> 32) % 60_000));
        child.kill().unwrap();
        child.wait().unwrap();
        // A removed file leaves work for every kill.
        if let Some(file) = killed_files(&shell).first() {
            fs::remove_file(file).unwrap();
        }
    }
    let typed = shell.expect("campaign tiny.ron --jobs 2 --out killed", 0);
    assert_eq!(typed.err, "", "nothing is damaged");
    assert_eq!(bytes(&shell, "killed"), bytes(&shell, "whole"));
    let files = |dir: &str| run_files(&shell, dir).iter().map(|f| timeless(f)).collect::<Vec<_>>();
    assert_eq!(files("killed"), files("whole"));
}

/// Returns the files of the finished runs; the folder may be missing.
fn killed_files(shell: &Shell) -> Vec<PathBuf> {
    let entries = fs::read_dir(shell.path("killed/runs")).into_iter().flatten();
    let files = entries.map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some_and(|extension| extension == "run")).collect()
}

#[test]
fn what_is_done_is_not_done_again_but_what_is_damaged_is() {
    let shell = tiny();
    shell.expect("campaign tiny.ron --jobs 2", 0);
    let expected = bytes(&shell, "out/tiny");
    let files = run_files(&shell, "out/tiny");
    let before: Vec<Vec<u8>> = files.iter().map(|file| fs::read(file).unwrap()).collect();
    // The damage: a digit, the end, the whole file, and the paths only.
    let text = String::from_utf8(before[1].clone()).unwrap();
    fs::write(&files[1], text.replacen("\"scans\":1", "\"scans\":2", 1)).unwrap();
    fs::write(&files[3], &before[3][..before[3].len() / 2]).unwrap();
    fs::write(&files[5], "").unwrap();
    fs::write(&files[7], &before[7][..before[7].len() - 9]).unwrap();
    fs::copy(&files[8], &files[9]).unwrap();
    // A file that a killed process left half-written is removed.
    fs::write(files[0].with_extension("partial"), "cut").unwrap();
    let typed = shell.expect("campaign tiny.ron --jobs 2", 0);
    assert_eq!(typed.err.lines().count(), 5, "{typed:?}");
    for damaged in [1, 3, 5, 7, 9] {
        let name = files[damaged].file_name().unwrap().to_str().unwrap();
        assert!(typed.err.contains(&format!("{name}: is damaged")), "{typed:?}");
    }
    assert_eq!(bytes(&shell, "out/tiny"), expected);
    assert_eq!(run_files(&shell, "out/tiny"), files);
    for (i, file) in files.iter().enumerate() {
        let same = fs::read(file).unwrap() == before[i];
        // The times show that a run was repeated.
        assert_eq!(same, ![1, 3, 5, 7, 9].contains(&i), "run {i}");
    }
}

#[test]
fn tables_do_not_outlive_the_runs_that_they_tell_of() {
    let shell = tiny();
    shell.expect("campaign tiny.ron --jobs 2", 0);
    let expected = bytes(&shell, "out/tiny");
    let tables = || {
        let names = ["runs.csv", "summary.csv", "timings.csv"];
        names.map(|name| shell.path("out/tiny").join(name).exists())
    };
    // A folder stands in the place of a missing run's result.
    let file = run_files(&shell, "out/tiny")[4].clone();
    fs::remove_file(&file).unwrap();
    fs::create_dir_all(file.join("in the way")).unwrap();
    shell.expect("campaign tiny.ron", 2);
    assert_eq!(tables(), [false; 3]);
    fs::remove_dir_all(&file).unwrap();
    shell.expect("campaign tiny.ron", 0);
    assert_eq!(bytes(&shell, "out/tiny"), expected);
}

#[test]
fn tables_of_a_part_say_of_how_many_until_nothing_is_missing() {
    let shell = tiny();
    let kinds = ["runs", "timings", "summary"];
    let named = |suffix: &str| kinds.map(|kind| vec![format!("{kind}{suffix}.csv")]);
    let found = |dir: &str| kinds.map(|kind| tables(&shell, dir, kind));
    shell.expect("campaign tiny.ron --shard 1/4 --out part", 0);
    assert_eq!(found("part"), named("-3-of-12"));
    shell.expect("campaign tiny.ron --shard 2/4 --out other", 0);
    shell.expect("collect part other", 0);
    assert_eq!(found("part"), named("-6-of-12"));
    shell.expect("campaign tiny.ron --out part", 0);
    assert_eq!(found("part"), named(""));
}

#[test]
fn the_numbers_of_a_strategy_and_the_runs_cut_short_have_columns() {
    let shell = tiny();
    let strategies = "strategies: [IgWin(radius: 2.5), Count(times: 3.0, half_distance: None), "; // as earlier versions wrote it
    shell.write("tiny.ron", campaign(&[("strategies: [", strategies)]));
    shell.expect("campaign tiny.ron --quiet", 0);
    let rows = |name: &str| -> Vec<(String, Vec<String>)> {
        let text = fs::read_to_string(shell.path("out/tiny").join(name)).unwrap();
        let mut lines = text.lines().map(fields);
        let columns = lines.next().unwrap();
        let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
        let wanted = ["alpha", "radius", "times", "half_distance"].map(at);
        let row = |line: Vec<String>| {
            (line[2].clone(), wanted.map(|column| line[column].clone()).to_vec())
        };
        lines.map(row).collect()
    };
    for name in ["runs.csv", "timings.csv", "summary.csv"] {
        let rows = rows(name);
        for (strategy, numbers) in [
            ("CL", ["", "", "", ""]),
            ("IG_CL:0.3", ["0.3", "", "", ""]),
            ("IG_WIN:2.5", ["", "2.5", "", ""]),
            ("COUNT:3", ["", "", "3", ""]),
            ("COUNT:3:2", ["", "", "3", "2"]),
        ] {
            let mut mine = rows.iter().filter(|(name, _)| name == strategy).peekable();
            assert!(mine.peek().is_some(), "{name}: {strategy}");
            assert!(mine.all(|(_, found)| *found == numbers), "{name}: {strategy}");
        }
    }
    // The runs that used up their twelve scans.
    let runs = fs::read_to_string(shell.path("out/tiny/runs.csv")).unwrap();
    let summary = fs::read_to_string(shell.path("out/tiny/summary.csv")).unwrap();
    assert!(summary.starts_with(
        "world,setting,strategy,alpha,radius,times,half_distance,metric,n,cut_short,mean,sd,low,high\n"
    ));
    let mut all = 0;
    for line in summary.lines().skip(1).map(fields).filter(|line| line[7] == "scans") {
        let mine = runs.lines().map(fields).filter(|run| run[2] == line[2]);
        let cut = mine.filter(|run| run.contains(&"BudgetSpent".to_owned())).count();
        assert_eq!((&line[8], &line[9]), (&"4".to_owned(), &cut.to_string()), "{line:?}");
        all += cut;
    }
    assert!(all > 0, "some are cut short");
}

/// Returns the fields of a line, some of them quoted.
fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            letter => fields.last_mut().unwrap().push(letter),
        }
    }
    fields
}

#[test]
fn results_of_another_version_are_not_mixed_in() {
    let shell = tiny();
    shell.expect("campaign tiny.ron --shard 1/2 --out a", 0);
    shell.expect("campaign tiny.ron --shard 2/2 --out b", 0);
    let list = fs::read_to_string(shell.path("b/campaign.json")).unwrap();
    let version = shell.json("b/campaign.json")["version"].as_str().unwrap().to_owned();
    assert!(version.starts_with(concat!(env!("CARGO_PKG_VERSION"), "+")), "{version}");
    shell.write("b/campaign.json", list.replace(&version, "0.0.9+other"));
    shell.refuse("collect a b --out c", &["b: was made by covmap 0.0.9+other", &version]);
    // Nor may the folder for the results be of another version.
    shell.refuse("collect a --out b", &["b: was made by covmap 0.0.9+other", &version]);
    let stray = run_files(&shell, "a")[0].clone();
    fs::rename(&stray, stray.with_file_name("0123.run")).unwrap();
    let typed = shell.expect("campaign tiny.ron --shard 1/2 --out a", 0);
    assert!(typed.err.contains("a: 1 file that this version of covmap did not write"), "{typed:?}");
    assert_eq!(run_files(&shell, "a").len(), 7);
}

#[test]
fn bad_campaigns_are_refused_before_any_run() {
    let refuse = |part: &str, instead: &str, expected: &[&str]| {
        let shell = tiny();
        shell.write("tiny.ron", campaign(&[(part, instead)]));
        shell.refuse("campaign tiny.ron --out new", expected);
    };
    refuse("\"room.ron\"", "\"rom.ron\"", &["rom.ron: cannot be read"]);
    refuse("[\"CL\", ", "[\"CL\", \"CL\", ", &["strategies: CL stands there twice"]);
    refuse("\"IG_CL:0.3\"", "\"IG_CL:-0.3\"", &["strategies", "-0.3"]);
    refuse("\"path_length_m\"", "\"path\"", &["metrics: \"path\" is none", "path_length_m"]);
    refuse("count: 2)", "count: 0)", &["must lie in 1..="]);
    refuse("first: 5, count: 2", "first: 5, count: 1000000000", &["1000000000", "1..=100000"]);
    refuse("first: 5, count: 2", "first: 5, count: 100000", &["more than 100000 runs"]);
    refuse("count: 2, seed: 1", "count: 1000000000, seed: 1", &["room.ron: starts: 1000000000"]);
    refuse("Drawn(count: 2, seed: 1)", "Poses([])", &["room.ron: starts: at least one"]);
    refuse("Drawn(count: 2, seed: 1)", "Poses([(9.0, 1.0, 0.0)])", &["room.ron: the start (9, 1)"]);
    refuse("max_scans: 12", "while_driving: 0.0", &["every 0 m"]);
    refuse("max_scans: 12", "overrides: {\"planner.sped\": 1}", &["b21r", "\"planner.sped\""]);
    refuse("max_scans: 12", "overrides: {\"model.bins\": 1}", &["b21r.ron", "bins"]);
    refuse("turn: 7.0", "turn: inf", &["worlds: room: turn"]);
    for path in ["planner.strategy", "planner.strategy.alpha"] {
        let overrides = format!("overrides: {{\"{path}\": \"Ig\"}}");
        refuse("max_scans: 12", &overrides, &["settings: b21r: overrides", path, "`strategies`"]);
    }
    refuse("max_scans: 12", "overrides: {\"model/bins\": 9}", &["\"model/bins\" is no parameter"]);
    refuse("max_scans: 12", "max_scans: 0", &["settings: b21r: max_scans", "at least 1"]);
    for name in ["", ".", "..", "a/b", "../tiny", "a\\\\b"] {
        refuse("name: \"tiny\"", &format!("name: \"{name}\""), &["name: \""]);
    }
    refuse(
        "count: 2, seed: 1),\n    seeds: (first: 5, count: 2)",
        "count: 1000, seed: 1),\n    seeds: (first: 5, count: 100000)",
        &["more than 100000 runs (300000000)"],
    );
    refuse("metrics:", "meters:", &["tiny.ron:8:", "meters"]);
    let twice =
        "[(name: \"a\", file: \"room.ron\"), (name: \"b\", file: \"room.ron\")],\n    settings";
    let one = campaign(&[]);
    let worlds =
        &one[one.find("[(name: \"room\"").unwrap()..one.find(": [(name: \"b21r\"").unwrap()];
    refuse(worlds, twice, &["a run stands there twice", "a, b21r, CL", "b, b21r, CL"]);
    let shell = tiny();
    shell.refuse("campaign nothing.ron", &["nothing.ron: cannot be read"]);
    shell.refuse("collect nothing", &["nothing: is no folder of a campaign"]);
    for shard in ["3/2", "0/2", "2", "a/b", "1/0"] {
        let typed = shell.type_in(&format!("campaign tiny.ron --shard {shard}"));
        assert_eq!(typed.code, Some(2));
        assert!(typed.err.contains("a shard is I/N with 1 ≤ I ≤ N"), "{typed:?}");
    }
}

#[test]
fn a_folder_of_something_else_is_left_alone() {
    let shell = tiny();
    shell.expect("campaign tiny.ron --out done", 0);
    shell.write("other.ron", campaign(&[("first: 5", "first: 6")]));
    shell.refuse("campaign other.ron --out done", &["done: holds", "another campaign", "--out"]);
    shell.expect("campaign other.ron --out other", 0);
    shell.refuse("collect done other --out c", &["other: holds another campaign"]);
    fs::create_dir(shell.path("thesis")).unwrap();
    shell.write("thesis/chapter.txt", "years of work");
    shell.refuse("campaign tiny.ron --out thesis", &["thesis: is no folder of a campaign"]);
    shell.refuse("campaign tiny.ron --out tiny.ron", &["tiny.ron"]);
    shell.refuse("campaign tiny.ron --out tiny.ron/deeper", &["tiny.ron/deeper"]);
}

#[test]
fn a_result_that_cannot_be_written_stops_the_campaign_and_leaves_what_is_done() {
    let shell = tiny();
    shell.expect("campaign tiny.ron --shard 1/2", 0);
    let done = run_files(&shell, "out/tiny");
    let before: Vec<_> = done.iter().map(|file| fs::read(file).unwrap()).collect();
    // Folders stand in the places of files.
    shell.expect("campaign tiny.ron --out all", 0);
    for file in run_files(&shell, "all") {
        let name = Path::new("out/tiny/runs").join(file.file_name().unwrap());
        let place = shell.path(name.with_extension("run").to_str().unwrap());
        if !place.exists() {
            fs::create_dir_all(place.join("in the way")).unwrap();
        }
    }
    let typed = shell.expect("campaign tiny.ron", 2);
    assert!(typed.err.contains(".run: cannot be written: "), "{typed:?}");
    for (file, bytes) in done.iter().zip(before) {
        assert_eq!(fs::read(file).unwrap(), bytes);
    }
}

#[test]
#[cfg(unix)]
fn ctrl_c_ends_a_campaign_and_it_goes_on() {
    let shell = tiny();
    shell.write("tiny.ron", campaign(&[("count: 2)", "count: 400)")]));
    let mut child = shell.command("campaign tiny.ron --jobs 2 --out run").spawn().unwrap();
    let runs = shell.path("run/runs");
    let done = || fs::read_dir(&runs).map_or(0, Iterator::count);
    while done() < 8 {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(1));
    }
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let files = run_files(&shell, "run");
    assert!(files.len() >= 8 && files.iter().all(|file| timeless(file)[0].len() > 99));
    // 2 starts, 400 seeds and 3 strategies.
    let names = [format!("runs-{}-of-2400.csv", files.len())];
    let table = fs::read_to_string(shell.path("run").join(&names[0])).unwrap();
    assert_eq!(table.lines().count(), files.len() + 1);
    assert_eq!(tables(&shell, "run", "runs"), names);
}

#[test]
fn every_shipped_campaign_is_sound() {
    let shell = Shell::new();
    for (name, runs) in [("fig6", 135), ("fig7", 660), ("table1", 120), ("worlds", 250)] {
        for variant in ["", "-quick"] {
            let file = shipped(&format!("configs/{name}{variant}.ron"));
            let typed = shell.expect(&format!("campaign {file} --check"), 0);
            let building = typed.err.lines().all(|line| line.ends_with("is left out"));
            assert!(building, "{typed:?}");
            let count: usize = typed.out.trim().split(' ').nth(1).unwrap().parse().unwrap();
            assert!(count > 0 && (count == runs || !variant.is_empty()), "{typed:?}");
        }
    }
    let file = shipped("configs/ablation.ron");
    assert!(shell.expect(&format!("campaign {file} --check"), 0).out.contains("62 runs"));
}
