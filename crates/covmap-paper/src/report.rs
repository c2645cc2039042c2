//! The page with the result of each claim, and the same results for machines.

use crate::claims::Evidence;
use crate::error::Result;
use crate::experiments::QUICK_SCANS;
use crate::figures::fig5;
use crate::html::Page;
use crate::session::{RAN, Series};
use crate::tables::{self, Table};
use crate::trial::{Judged, Trial, Verdict, digits, shown};
use covmap_campaign::VERSION;
use covmap_draw::FigureFolder;
use covmap_io::{MAX_FILE, read_text};
use serde::Serialize;
use std::env::consts::{ARCH, OS};

/// All results.
#[derive(Debug)]
pub(super) struct Report {
    pub(super) quick: bool,
    /// The verdicts with paper.ron, which decide, and with b21r.ron.
    pub(super) columns: [Vec<Judged>; 2],
    pub(super) paper: Evidence,
    pub(super) b21r: Evidence,
    pub(super) ablation: Series,
    /// The runs, a row for each setting of each campaign.
    pub(super) ran: Vec<Vec<String>>,
    /// The duration \[s\], without earlier runs.
    pub(super) seconds: f64,
}

/// A line of `claims.json`.
#[derive(Serialize)]
struct Line<'a> {
    claim: u32,
    statement: &'a str,
    verdict: Verdict,
    figures: Vec<String>,
    test: Test<'a>,
    /// The same with b21r.ron, which decides nothing.
    b21r: Second<'a>,
}

#[derive(Serialize)]
struct Test<'a> {
    rule: &'static str,
    /// The p-value, adjusted by Holm over all claims; none for an exact claim.
    p: Option<f64>,
    trials: &'a [Trial],
}

#[derive(Serialize)]
struct Second<'a> {
    verdict: Verdict,
    figures: Vec<String>,
    test: Test<'a>,
}

const RULE: &str = "all trials must hold; Student's t on the standard error of a bootstrap over starts \
                    (2000 resamples; claims 1 and 2: Agresti–Coull over seeds; 4: over scenarios; 8: \
                    the mean over starts; 21: over walls), 95 %; what rests on fewer than three groups, or on \
                    groups that are all alike, decides nothing; Holm over all claims of the \
                    configuration at .05";

/// The figures in the order of the paper; the report shows the figures that exist.
const FIGURES: [(&str, &[&str]); 7] = [
    ("Fig. 1: occupancy and coverage of a cell that is covered 20 %", &["figure1"]),
    ("Fig. 2: its posterior", &["figure2"]),
    ("Fig. 3: the sensor model", &["figure3"]),
    (
        "Fig. 5: maps of the corridor: (a) counting once, (b) CL on coverage maps, (c) extended counting",
        &["figure5a", "figure5b", "figure5c", "figure5a-b21r", "figure5b-b21r", "figure5c-b21r"],
    ),
    ("Fig. 6: scan counting up to n", &["figure6"]),
    (
        "Fig. 7: the strategies; (c) path of IG, (d) path of CL",
        &["figure7", "figure7c", "figure7d", "figure7-b21r", "figure7c-b21r", "figure7d-b21r"],
    ),
    ("Claim 17: other worlds", &["worlds", "worlds-b21r"]),
];

/// Removes the files of an earlier report from the folder, which keeps the report from showing old
/// figures.
pub(super) fn clear(output: &FigureFolder) -> Result<()> {
    let figures = FIGURES.iter().flat_map(|(_, names)| names.iter());
    let kinds = |name: &&str| ["svg", "png", "csv"].map(|kind| format!("{name}.{kind}"));
    let rest = ["table1.csv", "claims.json", "report.html"].map(str::to_owned);
    for name in figures.flat_map(kinds).chain(rest) {
        output.remove(&name)?;
    }
    Ok(())
}

impl Report {
    /// Writes `claims.json` and `report.html`.
    pub(super) fn write(&self, output: &FigureFolder) -> Result<()> {
        let claims = serde_json::to_string_pretty(&self.lines())?;
        output.write("claims.json", claims + "\n")?;
        Ok(output.write("report.html", self.html(output))?)
    }

    fn lines(&self) -> Vec<Line<'_>> {
        let [first, second] = &self.columns;
        first.iter().zip(second).map(|(first, second)| line(first, second)).collect()
    }

    fn html(&self, output: &FigureFolder) -> String {
        let title = "The paper's experiments, claim by claim";
        let mut page = Page::default();
        page.heading(1, title);
        self.introduce(&mut page);
        self.verdicts(&mut page);
        self.details(&mut page);
        for (heading, names) in FIGURES {
            page.heading(2, heading);
            for name in names {
                let svg = read_text(output.path(&format!("{name}.svg")), MAX_FILE);
                svg.into_iter().for_each(|svg| page.drawing(&svg));
            }
            if heading.starts_with("Fig. 5") {
                self.table_1(&mut page);
            }
        }
        self.beyond(&mut page);
        page.heading(2, "What was run");
        page.table(&RAN, &self.ran);
        page.finish(title)
    }

    fn introduce(&self, page: &mut Page) {
        page.paragraph(&format!(
            "Stachniss & Burgard, Exploring Unknown Environments with Mobile Robots using Coverage Maps (2003). \
             covmap {VERSION}, on {OS} {ARCH}. Made by `cargo xtask paper{}` in {:.0} s (runs that were recorded before not \
             counted).",
            if self.quick { " --quick" } else { "" },
            self.seconds
        ));
        if self.quick {
            page.paragraph(&format!(
                "A quick look: small worlds, coarse cells, few seeds, and runs that end after {QUICK_SCANS} scans. Most \
                 claims must stay undecided so; this is no result."
            ));
        }
        page.paragraph(
            "configs/paper.ron decides the verdicts; configs/b21r.ron, with our additions, is a second column. What the \
             campaigns set otherwise, such as the side of a cell, stands under What was run; σ and γ were fitted at .1 m. \
             Nothing was tuned for a claim, and thresholds were written before results were seen. The unit is a paired (start, \
             seed). Tests: Student's t on the standard error of a bootstrap that draws whole starts; a claim needs all its \
             tests, and pays for the others by Holm's correction. What rests on fewer than three groups, or on groups that \
             are all alike, decides nothing. Where the robot did not explore its world in more than one of ten of the runs \
             that a claim compares, nothing is decided, and these runs are named.",
        );
    }

    fn verdicts(&self, page: &mut Page) {
        page.heading(2, "Verdicts");
        let row = |(paper, b21r): (&Judged, &Judged)| {
            vec![
                paper.finding.claim.to_string(),
                paper.finding.statement.to_owned(),
                paper.verdict.to_string(),
                b21r.verdict.to_string(),
            ]
        };
        let rows: Vec<Vec<String>> =
            self.columns[0].iter().zip(&self.columns[1]).map(row).collect();
        page.table(&["claim", "statement", "paper.ron", "b21r.ron"], &rows);
        page.paragraph(
            "Claim 18, that every run ends, is a test of the planner and has no verdict.",
        );
    }

    fn details(&self, page: &mut Page) {
        page.heading(2, "Tests and figures");
        for (paper, b21r) in self.columns[0].iter().zip(&self.columns[1]) {
            page.heading(3, &format!("Claim {}: {}", paper.finding.claim, paper.verdict));
            page.paragraph(paper.finding.statement);
            for (name, judged) in [("paper.ron", paper), ("b21r.ron", b21r)] {
                let p =
                    judged.p.map_or("no chance in it".to_owned(), |p| format!("p = {}", digits(p)));
                page.paragraph(&format!("{name}: {} ({p})", judged.verdict));
                let row = |trial: &Trial| {
                    let value = shown(trial.value, trial.interval);
                    let p = [trial.p_holds, trial.p_fails].map(digits);
                    let [holds, fails] =
                        if trial.exact { ["–", "–"].map(str::to_owned) } else { p };
                    let what = [Some(&trial.what), trial.reason.as_ref()];
                    let what = what.into_iter().flatten().cloned().collect::<Vec<_>>().join(": ");
                    vec![what, value, trial.bound.clone(), holds, fails]
                };
                let rows: Vec<Vec<String>> = judged.finding.trials.iter().map(row).collect();
                page.table(&["test", "value [95 %]", "must be", "p it is not", "p it is"], &rows);
                page.list(&judged.finding.notes);
            }
        }
    }

    fn table_1(&self, page: &mut Page) {
        page.heading(3, "Table 1");
        page.paragraph(
            "Paper: coverage maps 89.1 m, 0 %; counting 26.6 m, 21 %; extended counting 90.6 m, 1.5 %. The cells are the same \
             for all techniques: those that can be seen from where the robot can stand.",
        );
        for (name, evidence) in [("paper.ron", &self.paper), ("b21r.ron", &self.b21r)] {
            page.paragraph(name);
            let rows: Vec<Vec<String>> =
                fig5::table_1(&evidence.corridor).into_iter().map(|(_, row)| row.into()).collect();
            let columns =
                ["technique", "path [m]", "share of cells with H > .65", "scans", "cut short"];
            page.table(&columns, &rows);
        }
    }

    fn beyond(&self, page: &mut Page) {
        page.heading(2, "Beyond the paper");
        page.paragraph(
            "Maps are compared over one set of cells for all runs in a world: what can be seen from where the robot \
             can stand, without the free cells that its body may be over. What a map does not know is uniform.",
        );
        let mut table = |heading: &str, (columns, rows): Table| {
            page.heading(3, heading);
            page.table(&columns, &rows);
        };
        for (name, evidence) in [("paper.ron", &self.paper), ("b21r.ron", &self.b21r)] {
            let runs = &evidence.at_view_points;
            let heading = |what: &str| format!("{what}, measuring at view-points, {name}");
            table(&heading("Accuracy of the final map"), tables::accuracy(runs));
            table(&heading("What it costs, and the time of a decision"), tables::cost(runs));
        }
        table("One reading changed at a time, on a small world", tables::ablation(&self.ablation));
    }
}

/// Returns the line of a claim with both configurations; `claims::all` gives both in the same
/// order.
fn line<'a>(first: &'a Judged, second: &'a Judged) -> Line<'a> {
    let test =
        |judged: &'a Judged| Test { rule: RULE, p: judged.p, trials: &judged.finding.trials };
    Line {
        claim: first.finding.claim,
        statement: first.finding.statement,
        verdict: first.verdict,
        figures: figures(first),
        test: test(first),
        b21r: Second { verdict: second.verdict, figures: figures(second), test: test(second) },
    }
}

/// Describes the measurements of a claim in words.
fn figures(judged: &Judged) -> Vec<String> {
    let trial = |trial: &Trial| {
        let value =
            if trial.exact { trial.bound.clone() } else { shown(trial.value, trial.interval) };
        let reason = trial.reason.as_ref().map(|reason| format!(" ({reason})"));
        format!("{}: {value}{}", trial.what, reason.unwrap_or_default())
    };
    judged.finding.trials.iter().map(trial).chain(judged.finding.notes.iter().cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_io::Replace;

    #[test]
    fn what_an_earlier_report_left_is_removed_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let output = FigureFolder::create(dir.path(), Replace::Same).unwrap();
        for name in ["figure5b-b21r.svg", "figure7.png", "worlds.csv", "report.html", "mine.svg"] {
            output.write(name, "old").unwrap();
        }
        clear(&output).unwrap();
        let left = std::fs::read_dir(dir.path()).unwrap().flatten();
        let mut left: Vec<_> = left.map(|entry| entry.file_name()).collect();
        left.sort();
        assert_eq!(left, [".covmap-files", "mine.svg"]);
        // A changed file is not removed.
        output.write("worlds.csv", "new").unwrap();
        std::fs::write(output.path("worlds.csv"), "corrected").unwrap();
        assert!(clear(&output).is_err() && output.path("worlds.csv").exists());
    }
}
