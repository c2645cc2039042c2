//! The page with the result of each claim, and the same results for machines.

use crate::claims::Evidence;
use crate::error::Result;
use crate::experiments::QUICK_SCANS;
use crate::figures::fig5;
use crate::html::Page;
use crate::sections::{SECTIONS, Section, of_the_paper};
use crate::session::{RAN, Series};
use crate::tables::{self, Table};
use crate::trial::{FIRST_LEVEL, Judged, LEVEL, POWER, Trial, Verdict, digits, shown};
use covmap_campaign::VERSION;
use covmap_draw::FigureFolder;
use covmap_io::{MAX_FILE, read_text};
use covmap_statistics::detectable;
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
    /// The number or the words of the paper.
    paper: &'static str,
    /// Why the verdict is as it is.
    why: String,
    figures: Vec<String>,
    test: Test<'a>,
    /// The same with b21r.ron, which decides nothing.
    b21r: Second<'a>,
}

#[derive(Serialize)]
struct Test<'a> {
    rule: &'static str,
    /// The p-value by itself; none for an exact claim.
    raw_p: Option<f64>,
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

/// Removes the files of an earlier report from the folder, which keeps the report from showing old
/// figures.
pub(super) fn clear(output: &FigureFolder) -> Result<()> {
    let figures = SECTIONS.iter().flat_map(|section| section.figures);
    let figures = figures.flat_map(|name| ["svg", "png"].map(|kind| format!("{name}.{kind}")));
    let numbers = SECTIONS.iter().flat_map(|section| section.numbers);
    let rest = ["claims.json", "report.html"].map(str::to_owned);
    for name in figures.chain(numbers.map(|name| format!("{name}.csv"))).chain(rest) {
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
        contents(&mut page);
        self.verdicts(&mut page);
        for section in &SECTIONS {
            page.anchor(section.id);
            page.heading(2, section.heading);
            self.part(&mut page, section, output);
        }
        self.beyond(&mut page);
        self.methods(&mut page);
        page.finish(title)
    }

    fn part(&self, page: &mut Page, section: &Section, output: &FigureFolder) {
        let numbers = section.numbers.iter().map(|name| format!("{name}.csv"));
        let numbers = numbers.filter(|file| output.path(file).exists());
        let numbers: Vec<_> = numbers.map(|file| (file.clone(), file)).collect();
        page.paragraph(&format!("Made by: {}", section.command));
        page.links("Numbers: ", &numbers);
        for name in section.figures {
            let svg = read_text(output.path(&format!("{name}.svg")), MAX_FILE);
            svg.into_iter().for_each(|svg| page.drawing(&svg));
        }
        match section.id {
            "table-1" => self.table_1(page),
            "ablation" => {
                page.paragraph(ABLATION);
                let (columns, rows) = tables::ablation(&self.ablation);
                page.table(&columns, &rows);
            }
            _ => {}
        }
        for (paper, b21r) in self.columns[0].iter().zip(&self.columns[1]) {
            if section.claims.contains(&paper.finding.claim) {
                claim(page, paper, b21r);
            }
        }
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
        let of = |verdict| self.columns[0].iter().filter(|j| j.verdict == verdict).count();
        page.paragraph(&format!(
            "Of {} claims {} are reproduced, {} are not, and {} are undecided, with configs/paper.ron, which decides. \
             configs/b21r.ron, the default of covmap, is a second column: it updates the map by cause and has other \
             additions of ours.",
            self.columns[0].len(),
            of(Verdict::Reproduced),
            of(Verdict::NotReproduced),
            of(Verdict::Undecided),
        ));
    }

    fn verdicts(&self, page: &mut Page) {
        page.anchor("verdicts");
        page.heading(2, "Verdicts");
        let row = |(paper, b21r): (&Judged, &Judged)| {
            let ours = paper.deciding().map_or("–".to_owned(), |trial| {
                if trial.exact { trial.bound.clone() } else { shown(trial.value, trial.interval) }
            });
            vec![
                format!("#claim-{}", paper.finding.claim),
                paper.finding.statement.to_owned(),
                of_the_paper(paper.finding.claim).to_owned(),
                ours,
                paper.verdict.to_string(),
                paper.why(),
                b21r.verdict.to_string(),
            ]
        };
        let rows: Vec<Vec<String>> =
            self.columns[0].iter().zip(&self.columns[1]).map(row).collect();
        let columns = [
            "claim",
            "statement",
            "the paper",
            "ours, with 95 % interval",
            "paper.ron",
            "why",
            "b21r.ron",
        ];
        page.table(&columns, &rows);
        page.paragraph(
            "Ours is the number on which the verdict rests; each claim's part has all of them. Claim 18, that every run ends, \
             is a test of the planner and has no verdict.",
        );
    }

    fn methods(&self, page: &mut Page) {
        page.anchor("methods");
        page.heading(2, "How it was tested");
        page.paragraph(
            "Nothing was tuned for a claim, and thresholds were written before results were seen. The unit is a paired run: \
             all strategies from one start. Tests: Student's t on the standard error of a bootstrap over starts; a claim \
             needs all its tests, and pays for the others by Holm's correction. What rests on fewer than three groups, or on \
             groups that are all alike, decides nothing. Where the robot did not explore its world in more than one of ten \
             of the runs that a claim compares, nothing is decided, and these runs are named. Each claim shows both p-values: \
             its own, and the one after Holm's correction, which decides at .05.",
        );
        page.list(&power());
        page.heading(3, "What was run");
        page.table(&RAN, &self.ran);
    }

    fn table_1(&self, page: &mut Page) {
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
        page.anchor("beyond");
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
    }
}

/// Text above the ablation.
const ABLATION: &str = "The first row is configs/paper.ron, the last are configs/b21r.ron. Each row between changes one thing; together they \
     are what differs between the two columns of verdicts. Errors are of the most likely coverage (mode), as the paper's \
     maps show it, and of the expected coverage (mean).";

/// Returns what the starts of the campaigns can find, as it is known before any run.
pub(super) fn power() -> Vec<String> {
    let of = |(starts, what): (usize, &str)| {
        let level = |level: f64| detectable(starts, level, POWER).map_or("–".to_owned(), digits);
        format!(
            "{starts} starts ({what}) find a mean that is {} standard deviations of a start off its limit in {:.0} % of all \
             cases at the strictest step of Holm's correction, {} at .05 alone",
            level(FIRST_LEVEL),
            100.0 * POWER,
            level(0.5 * LEVEL)
        )
    };
    [(20, "Fig. 7, Table 1"), (5, "Fig. 6, other worlds")].map(of).to_vec()
}

/// Adds links to the parts of the page.
fn contents(page: &mut Page) {
    let link = |text: &str, id: &str| (text.to_owned(), format!("#{id}"));
    let short = |section: &Section| {
        let name = section.heading.split(':').next().unwrap_or(section.heading);
        link(name, section.id)
    };
    let mut links = vec![link("Verdicts", "verdicts")];
    links.extend(SECTIONS.iter().map(short));
    links.extend([link("Beyond the paper", "beyond"), link("How it was tested", "methods")]);
    page.links("", &links);
}

/// Adds a claim with its tests, with both configurations.
fn claim(page: &mut Page, paper: &Judged, b21r: &Judged) {
    page.anchor(&format!("claim-{}", paper.finding.claim));
    page.heading(3, &format!("Claim {}: {}", paper.finding.claim, paper.verdict));
    page.paragraph(paper.finding.statement);
    page.paragraph(&format!("The paper: {}.", of_the_paper(paper.finding.claim)));
    for (name, judged) in [("paper.ron", paper), ("b21r.ron", b21r)] {
        let p = match (judged.raw_p, judged.p) {
            (Some(raw), Some(p)) => format!("p = {}, corrected {}", digits(raw), digits(p)),
            _ => "no chance in it".to_owned(),
        };
        page.paragraph(&format!("{name}: {} ({p}). {}", judged.verdict, judged.why()));
        let row = |trial: &Trial| {
            let value = shown(trial.value, trial.interval);
            let p = [trial.p_holds, trial.p_fails].map(digits);
            let [holds, fails] = if trial.exact { ["–", "–"].map(str::to_owned) } else { p };
            let what = [Some(&trial.what), trial.reason.as_ref()];
            let what = what.into_iter().flatten().cloned().collect::<Vec<_>>().join(": ");
            let groups = trial.groups.map_or("–".to_owned(), |groups| groups.to_string());
            let needed = trial.groups_needed.map_or("–".to_owned(), |n| digits(n.ceil()));
            vec![what, value, trial.bound.clone(), holds, fails, groups, needed]
        };
        let rows: Vec<Vec<String>> = judged.finding.trials.iter().map(row).collect();
        let columns = [
            "test",
            "value [95 %]",
            "must be",
            "p it is not",
            "p it is",
            "groups",
            "groups for 80 %",
        ];
        page.table(&columns, &rows);
        page.list(&judged.finding.notes);
    }
}

/// Returns the line of a claim with both configurations; `claims::all` gives both in the same
/// order.
fn line<'a>(first: &'a Judged, second: &'a Judged) -> Line<'a> {
    let test = |judged: &'a Judged| Test {
        rule: RULE,
        raw_p: judged.raw_p,
        p: judged.p,
        trials: &judged.finding.trials,
    };
    Line {
        claim: first.finding.claim,
        statement: first.finding.statement,
        verdict: first.verdict,
        paper: of_the_paper(first.finding.claim),
        why: first.why(),
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
