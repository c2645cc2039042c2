//! Existing files, links, pipes and full disks.

use crate::readings::room;
use crate::typed::{Shell, shipped, short_run};
use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};

/// Checks that a line is refused, and leaves a file as it is.
#[track_caller]
fn keep(shell: &Shell, file: &str, line: &str, parts: &[&str]) {
    let before = fs::read(shell.path(file)).unwrap();
    shell.refuse(line, parts);
    assert_eq!(fs::read(shell.path(file)).unwrap(), before, "{line}");
}

fn lab() -> String {
    shipped("scenarios/lab.ron")
}

#[test]
fn a_file_that_is_there_is_replaced_only_if_that_is_meant() {
    let shell = Shell::new();
    let truth = format!("truth {} --resolution 0.5 --out t.csv", lab());
    shell.write("t.csv", "mine");
    keep(&shell, "t.csv", &truth, &["t.csv: is there already", "--force"]);
    shell.expect(&format!("{truth} --force"), 0);
    shell.expect(&truth, 0);
    shell.write("m.csv", "mine");
    keep(&shell, "m.csv", "model --range 1 --out m.csv", &["m.csv: is there already"]);
    assert_eq!(shell.files().len(), 2);
}

#[test]
fn a_survey_that_was_corrected_by_hand_stays() {
    let shell = Shell::new();
    room(&shell);
    shell.expect("survey room --out truth.ron --quiet", 0);
    shell.expect("survey room --out truth.ron --quiet", 0);
    let corrected = fs::read_to_string(shell.path("truth.ron")).unwrap() + "// corrected\n";
    shell.write("truth.ron", corrected);
    keep(&shell, "truth.ron", "survey room --out truth.ron", &["truth.ron: is there already"]);
    shell.refuse("survey room --out truth.png", &["truth.png: --out names the survey, a .ron"]);
    shell.refuse("survey room --out other.PNG", &["other.PNG: --out names the survey"]);
    shell.write("mine.png", "mine");
    keep(&shell, "mine.png", "survey room --out mine.ron", &["mine.png: is there already"]);
}

#[test]
fn no_command_replaces_what_it_reads() {
    let shell = Shell::new();
    room(&shell);
    let is_input = ["is an input of this command"];
    fs::copy(lab(), shell.path("lab.ron")).unwrap();
    keep(&shell, "lab.ron", "truth lab.ron --out ./lab.ron --force", &is_input);
    fs::copy(shipped("configs/b21r.ron"), shell.path("c.ron")).unwrap();
    keep(&shell, "c.ron", "model --config c.ron --range 1 --out c.ron --force", &is_input);
    keep(&shell, "room/od.txt", "survey room --out room/od.txt --force", &is_input);
    shell.expect(&format!("{} --quiet", short_run().replace("30", "2")), 3);
    keep(&shell, "run/trace.jsonl", "log run --out run/trace.jsonl", &is_input);
    keep(&shell, "run/trace.jsonl", "log run --out run/trace.jsonl --force", &is_input);
    keep(&shell, "run/map.pgm", "log run --out run/map.pgm", &["run/map.pgm: is there already"]);
    keep(&shell, "room/od.txt", "map room --out room --force", &["holds room"]);
    shell.expect("map room --out room/map --quiet", 0);
    // An input in a folder that would be replaced is kept.
    shell.expect("survey room --out room/map/truth.ron --quiet", 0);
    let line = "readings room --truth room/map/truth.ron --out room/map --force";
    keep(&shell, "room/map/truth.ron", line, &["room/map: holds room/map/truth.ron"]);
}

#[test]
fn a_map_has_no_decisions_and_other_folders_have_no_trace() {
    let shell = Shell::new();
    room(&shell);
    shell.expect("map room --out m --quiet", 0);
    shell.refuse("explain m --step 3", &["m: `map` wrote it: a map has no decisions"]);
    shell.refuse("log m --out m.log", &["m: `map` wrote it"]);
    shell.refuse("explain room --step 0", &["room: holds no trace.jsonl", "`explore`"]);
    shell.refuse("explain room/od.txt --step 0", &["room/od.txt: is no folder"]);
}

#[test]
fn pictures_of_explain_stay_when_the_same_run_is_repeated() {
    let shell = Shell::new();
    let run = format!("{} --quiet", short_run().replace("30", "3"));
    shell.expect(&run, 3);
    shell.expect("explain run --step 0", 0);
    shell.expect("explain run --step 0", 0);
    shell.write("run/explain-1.png", "mine");
    keep(&shell, "run/explain-1.png", "explain run --step 1", &["run/explain-1.png: is there"]);
    shell.expect(&run, 3);
    assert!(shell.path("run/explain-0.png").exists());
    assert_eq!(fs::read(shell.path("run/explain-1.png")).unwrap(), b"mine");
}

#[test]
fn names_do_not_rule_the_terminal_and_numbers_are_short() {
    let shell = Shell::new();
    let campaign = |file: &str| {
        format!(
            "(name: \"a\", worlds: [(name: \"w\", file: \"{file}\")], settings: [(name: \"b\", \
             config: {:?})], strategies: [Cl], starts: Given, seeds: (first: 1, count: 1), \
             metrics: [\"scans\"])",
            shipped("configs/b21r.ron")
        )
    };
    shell.write("c.ron", campaign(r"no\u{1b}[31m\nsuch.ron"));
    shell.refuse("campaign c.ron --check", &[r"no\u{1b}[31m\nsuch.ron: cannot be read"]);
    let typed = shell.command("explore c.ron --seed").arg("\u{1b}[2J").output().unwrap();
    let err = String::from_utf8(typed.stderr).unwrap();
    assert!(err.contains(r"invalid value '\u{1b}[2J'") && !err.contains('\u{1b}'), "{err}");
    shell.write("far.ron", "(name: \"far\", extent: (width: 6, height: 6), start: (x: 5.73, y: 5.73, heading: 1e300), obstacles: [])");
    let typed = shell.expect("explore far.ron --max-scans 1 --start 1e6,1e6,0", 2);
    assert!(typed.err.len() < 300, "{typed:?}");
    let typed = shell.type_in("truth far.ron --out t.csv");
    assert!(typed.err.len() < 300, "{typed:?}");
}

/// Makes a pipe.
#[cfg(unix)]
fn pipe(shell: &Shell, name: &str) {
    assert!(Command::new("mkfifo").arg(shell.path(name)).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn pipes_devices_and_folders_are_no_input() {
    let shell = Shell::new();
    pipe(&shell, "p.ron");
    pipe(&shell, "p.yaml");
    fs::create_dir_all(shell.path("t")).unwrap();
    pipe(&shell, "t/trace.jsonl");
    pipe(&shell, "t/campaign.json");
    std::os::unix::fs::symlink("/dev/zero", shell.path("zero.ron")).unwrap();
    let lab = lab();
    for (line, part) in [
        ("explore p.ron", "p.ron: cannot be read: it is a pipe, not a file"),
        ("truth p.yaml --out t.csv", "p.yaml: cannot be read: it is a pipe"),
        (&format!("explore {lab} --config p.ron"), "p.ron: cannot be read: it is a pipe"),
        ("campaign p.ron --check", "p.ron: cannot be read: it is a pipe"),
        ("campaign zero.ron --check", "zero.ron: cannot be read: it is a device"),
        ("fit p.ron --out o", "p.ron: cannot be read: it is a pipe"),
        ("explain t --step 0", "t/trace.jsonl: cannot be read: it is a pipe"),
        ("log t --out o.log", "t/trace.jsonl: cannot be read: it is a pipe"),
        ("collect t", "t/campaign.json: cannot be read: it is a pipe"),
    ] {
        shell.refuse(line, &[part]);
    }
}

#[cfg(unix)]
#[test]
fn links_in_the_folder_of_a_campaign_are_not_followed() {
    let shell = Shell::new();
    shell.write("room.ron", "(name: \"room\", extent: (width: 3.0, height: 2.4), obstacles: [])");
    shell.write(
        "c.ron",
        format!(
            "(name: \"c\", worlds: [(name: \"room\", file: \"room.ron\", resolution: 0.2)], \
             settings: [(name: \"b\", config: {:?}, max_scans: 2)], strategies: [Cl], \
             starts: Drawn(count: 1, seed: 1), seeds: (first: 1, count: 1), metrics: [\"scans\"])",
            shipped("configs/b21r.ron")
        ),
    );
    shell.write("mine", "mine");
    let link = |to: &str, at: &str| std::os::unix::fs::symlink(to, shell.path(at)).unwrap();
    let mine = || assert_eq!(fs::read(shell.path("mine")).unwrap(), b"mine");
    fs::create_dir(shell.path("a")).unwrap();
    link("../mine", "a/lock");
    shell.refuse("campaign c.ron --out a", &["a/lock: is no lock"]);
    mine();
    shell.expect("campaign c.ron --out c", 0);
    let run = fs::read_dir(shell.path("c/runs")).unwrap().next().unwrap().unwrap().file_name();
    let run = format!("c/runs/{}", run.to_str().unwrap());
    fs::remove_file(shell.path(&run)).unwrap();
    for name in ["c/lock", "c/campaign.partial", "c/campaign.json.partial", "c/runs.csv.partial"] {
        let _ = fs::remove_file(shell.path(name));
    }
    // The lock may have another name, which does not matter.
    fs::hard_link(shell.path("mine"), shell.path("c/lock")).unwrap();
    link("../mine", "c/campaign.json.partial");
    link("../mine", "c/runs.csv.partial");
    link("../../mine", &format!("{run}.partial"));
    link("../../mine", &run.replace(".run", ".partial"));
    fs::write(shell.path("c/runs/notes.partial"), "mine").unwrap();
    let typed = shell.expect("campaign c.ron --out c", 0);
    assert!(!typed.err.contains("damaged"), "{typed:?}");
    mine();
    assert!(shell.path("c/runs/notes.partial").exists());
    // An endless record is damaged; of a link to one, only the link is replaced.
    for endless in ["sparse", "/dev/zero", "../../mine"] {
        fs::remove_file(shell.path(&run)).unwrap();
        match endless {
            "sparse" => {
                fs::File::create(shell.path(&run)).unwrap().set_len(5 << 30).unwrap();
            }
            _ => link(endless, &run),
        }
        let typed = shell.expect("campaign c.ron --out c", 0);
        assert!(typed.err.contains("is damaged; the run is done again"), "{typed:?}");
        assert!(fs::symlink_metadata(shell.path(&run)).unwrap().is_file());
    }
    mine();
    fs::rename(shell.path("c/runs"), shell.path("elsewhere")).unwrap();
    link("../elsewhere", "c/runs");
    shell.refuse("campaign c.ron --out c", &["c/runs: is a symbolic link"]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_is_an_error_and_a_closed_pipe_is_quiet() {
    let shell = Shell::new();
    shell.expect(&format!("{} --quiet", short_run().replace("30", "3")), 3);
    for line in ["explain run --step 0", "model --range 1 --out m.csv", "--help", "--version"] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = shell.command(line).stdout(full).output().unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {err}");
        assert!(err.contains("the standard output cannot be written: No space left"), "{err}");
        assert_eq!(err.lines().count(), 1, "{err}");
        let (read, write) = std::io::pipe().unwrap();
        drop(read);
        let output = shell.command(line).stdout(write).output().unwrap();
        assert_eq!((output.status.code(), &output.stderr[..]), (Some(141), &[][..]), "{line}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_log_that_cannot_be_written_is_what_the_error_names() {
    let shell = Shell::new();
    shell.expect(&format!("{} --quiet", short_run().replace("30", "3")), 3);
    shell.refuse("log run --out nowhere/l.log", &["nowhere/l.log: cannot be written"]);
    shell.refuse("log run --out /dev/full", &["/dev/full: cannot be written: it is a device"]);
    // A limit on the size of files acts like a full disk.
    let covmap = env!("CARGO_BIN_EXE_covmap");
    shell.write("l.log", "mine");
    let limited = format!("trap '' XFSZ; ulimit -f 0; exec {covmap} log run --out l.log --force");
    let mut child = Command::new("sh")
        .args(["-c", &limited])
        .current_dir(shell.path(""))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut err = String::new();
    child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(2), "{err}");
    assert!(err.contains("l.log: cannot be written: File too large"), "{err}");
    assert_eq!(fs::read(shell.path("l.log")).unwrap(), b"mine");
    assert!(!shell.path("l.log.partial").exists());
}
