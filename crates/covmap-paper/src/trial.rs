//! A number against its threshold, and the verdict on a claim.

use covmap_statistics::{Estimate, holm};
use serde::Serialize;
use std::fmt;

/// The bound on a number for a claim to hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// At most a number.
    Below(f64),
    /// At least a number.
    Above(f64),
    /// Between two numbers.
    Between(f64, f64),
}

/// One test of a claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// The name of the number.
    pub what: String,
    /// The number; `None` if there are no data, or the test is of a fact.
    pub value: Option<f64>,
    /// The 95 % interval of the number.
    pub interval: Option<(f64, f64)>,
    /// The bound on the number.
    pub bound: String,
    /// The p-value of data like these if the number violates the bound; a small value supports the
    /// claim.
    pub p_holds: f64,
    /// The p-value of data like these if the number keeps the bound; a small value contradicts the
    /// claim.
    pub p_fails: f64,
    /// The number of independent groups it rests on; none for a fact.
    pub groups: Option<usize>,
    /// The number of groups at which the test would decide with a power of 80 %, at the level of the first
    /// step of Holm's correction over 20 claims, if the number is as it was measured.
    pub groups_needed: Option<f64>,
    /// Whether the test involves no chance.
    pub exact: bool,
    /// Why the number decides nothing, or a further remark.
    pub reason: Option<String>,
}

/// A claim with all its tests.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The claim's number in the list.
    pub claim: u32,
    /// The claim's statement.
    pub statement: &'static str,
    /// The tests, which must all hold.
    pub trials: Vec<Trial>,
    /// Figures beside the tests, which decide nothing.
    pub notes: Vec<String>,
}

/// The result of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Verdict {
    #[serde(rename = "reproduced")]
    /// The claim holds.
    Reproduced,
    #[serde(rename = "not reproduced")]
    /// The claim does not hold.
    NotReproduced,
    #[serde(rename = "undecided")]
    /// The data do not decide the claim.
    Undecided,
}

/// A claim with its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The finding.
    pub finding: Finding,
    /// The verdict.
    pub verdict: Verdict,
    /// The p-value of the verdict by itself, two-sided; `None` for an exact claim.
    pub raw_p: Option<f64>,
    /// The p-value of the verdict, adjusted by Holm over all claims of the column; `None` for an
    /// exact claim.
    pub p: Option<f64>,
}

/// At this level a claim is decided.
pub(crate) const LEVEL: f64 = 0.05;
/// The probability with which a test is to find what there is.
pub(crate) const POWER: f64 = 0.8;
/// The level of each side of a test in Holm's first step, over the 20 claims of a column.
pub(crate) const FIRST_LEVEL: f64 = 0.5 * LEVEL / 20.0;
/// A number that rests on fewer independent groups than this decides nothing.
const FEWEST_GROUPS: usize = 3;
/// A standard error below this share of the number is rounding.
const ROUNDING: f64 = 1e-12;

impl Trial {
    /// Makes a test of a number with its error. Without data nothing is decided.
    pub fn new(what: impl Into<String>, estimate: Option<Estimate>, bound: Bound) -> Self {
        let reason = estimate.map_or(Some("no data".to_owned()), |e| says_nothing(&e));
        let p = |e: Estimate| match bound {
            Bound::Below(limit) => (e.p_below(limit), e.p_above(limit)),
            Bound::Above(limit) => (e.p_above(limit), e.p_below(limit)),
            Bound::Between(low, high) => (e.p_between(low, high), e.p_outside(low, high)),
        };
        let (p_holds, p_fails) = estimate.filter(|_| reason.is_none()).map_or((1.0, 1.0), p);
        Self {
            what: what.into(),
            value: estimate.map(|e| e.value),
            interval: estimate.and_then(|e| e.interval(0.95)).filter(|_| reason.is_none()),
            bound: bound.to_string(),
            p_holds,
            p_fails,
            groups: estimate.map(|e| e.groups),
            groups_needed: estimate.and_then(|e| needed(&e, bound)),
            exact: false,
            reason,
        }
    }

    /// Makes a test of a number between known ends, which must not exceed a limit.
    ///
    /// The upper end speaks for the claim, the lower end against it.
    pub fn between_ends(what: impl Into<String>, ends: Option<[Estimate; 2]>, limit: f64) -> Self {
        let end = |at: usize| Self::new("", ends.map(|ends| ends[at]), Bound::Below(limit));
        Self { what: what.into(), p_fails: end(0).p_fails, ..end(1) }
    }

    /// Adds a remark.
    pub fn saying(self, reason: Option<String>) -> Self {
        let reasons: Vec<String> = self.reason.into_iter().chain(reason).collect();
        Self { reason: (!reasons.is_empty()).then(|| reasons.join("; ")), ..self }
    }

    /// The same, of one of several worlds.
    pub fn of(self, world: &str) -> Self {
        Self { what: format!("{world}: {}", self.what), ..self }
    }

    /// Makes a test of a fact.
    pub fn fact(what: impl Into<String>, holds: bool) -> Self {
        Self {
            what: what.into(),
            value: None,
            interval: None,
            bound: (if holds { "it is so" } else { "it is not so" }).to_owned(),
            p_holds: f64::from(u8::from(!holds)),
            p_fails: f64::from(u8::from(holds)),
            groups: None,
            groups_needed: None,
            exact: true,
            reason: None,
        }
    }

    /// Makes a condition without which the runs say nothing about the claim: it can leave a claim
    /// undecided, but not refute it.
    pub fn condition(what: impl Into<String>, holds: bool) -> Self {
        Self { p_fails: 1.0, ..Self::fact(what, holds) }
    }

    pub(crate) fn is_unmet_condition(&self) -> bool {
        self.exact && self.p_holds >= 1.0 && self.p_fails >= 1.0
    }

    /// Returns a test that cannot speak against the claim: a claim that is not confirmed is
    /// undecided.
    pub fn confirming(self) -> Self {
        Self { p_fails: 1.0, ..self }
    }
}

impl Finding {
    /// Makes a finding of a claim whose tests must all hold.
    pub fn new(claim: u32, statement: &'static str, trials: Vec<Trial>) -> Self {
        Self { claim, statement, trials, notes: Vec::new() }
    }

    /// Adds a figure that decides nothing.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds a number with its interval, which decides nothing.
    pub fn figure(self, what: &str, estimate: Option<Estimate>) -> Self {
        let text =
            estimate.map_or("no data".to_owned(), |e| shown(Some(e.value), e.interval(0.95)));
        self.note(format!("{what}: {text}"))
    }

    /// Returns the p-value for the claim: all tests must hold, and the largest p-value counts.
    fn p_holds(&self) -> f64 {
        self.trials.iter().map(|trial| trial.p_holds).fold(0.0, f64::max)
    }

    /// Returns the p-value against the claim: one failed test is enough, at the price of as many
    /// chances as there are tests.
    fn p_fails(&self) -> f64 {
        let chances = self.trials.iter().filter(|trial| !trial.exact).count().max(1) as f64;
        let p = |trial: &Trial| if trial.exact { trial.p_fails } else { chances * trial.p_fails };
        self.trials.iter().map(p).fold(1.0, f64::min)
    }

    fn is_exact(&self) -> bool {
        self.trials.iter().all(|trial| trial.exact)
    }

    /// Returns whether a condition is not met: then nothing is decided, whatever the other tests
    /// say.
    fn is_void(&self) -> bool {
        self.trials.iter().any(Trial::is_unmet_condition)
    }
}

/// Judges all claims of a column.
///
/// A claim is *reproduced* if the hypothesis that one of its tests does not hold is rejected, and
/// *not reproduced* if the hypothesis that all of them hold is rejected. Both use Holm's correction
/// over all claims that involve chance. Any other claim is *undecided*.
pub fn judge(findings: Vec<Finding>) -> Vec<Judged> {
    let two_sided = |f: &Finding| {
        let p = 2.0 * f.p_holds().min(f.p_fails());
        if f.is_void() { 1.0 } else { p.min(1.0) }
    };
    let by_chance: Vec<usize> = (0..findings.len()).filter(|i| !findings[*i].is_exact()).collect();
    let raw: Vec<f64> = by_chance.iter().map(|index| two_sided(&findings[*index])).collect();
    let mut of: Vec<[Option<f64>; 2]> = vec![[None; 2]; findings.len()];
    for (index, ps) in by_chance.into_iter().zip(raw.iter().zip(holm(&raw))) {
        of[index] = [Some(*ps.0), Some(ps.1)];
    }
    let one = |(finding, [raw_p, p]): (Finding, [Option<f64>; 2])| {
        let decided = p.unwrap_or_else(|| two_sided(&finding)) < LEVEL;
        let verdict = match (decided, finding.p_holds() < finding.p_fails()) {
            (false, _) => Verdict::Undecided,
            (true, true) => Verdict::Reproduced,
            (true, false) => Verdict::NotReproduced,
        };
        Judged { finding, verdict, raw_p, p }
    };
    findings.into_iter().zip(of).map(one).collect()
}

/// The number of groups that would decide whether a number keeps within a bound: the nearest end counts.
fn needed(estimate: &Estimate, bound: Bound) -> Option<f64> {
    let of = |limit: f64| estimate.groups_needed(limit, FIRST_LEVEL, POWER);
    match bound {
        Bound::Below(limit) | Bound::Above(limit) => of(limit),
        Bound::Between(low, high) => Some(of(low)?.max(of(high)?)),
    }
}

/// Returns why an estimate must not decide: it rests on too few groups, or its groups are all
/// alike, and its error is unknown.
fn says_nothing(estimate: &Estimate) -> Option<String> {
    let Estimate { value, standard_error, groups } = *estimate;
    if groups < FEWEST_GROUPS {
        return Some(format!(
            "decides nothing: it rests on {groups} independent group{}, and {FEWEST_GROUPS} are needed",
            if groups == 1 { "" } else { "s" }
        ));
    }
    let known = standard_error.is_finite() && standard_error > ROUNDING * (1.0 + value.abs());
    (!known).then(|| {
        format!("decides nothing: its error is not known, for all {groups} groups are alike")
    })
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Below(limit) => write!(f, "≤ {limit}"),
            Self::Above(limit) => write!(f, "≥ {limit}"),
            Self::Between(low, high) => write!(f, "in [{low}, {high}]"),
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::Undecided => "undecided",
        })
    }
}

/// Returns a number with its interval, as shown to a reader.
pub fn shown(value: Option<f64>, interval: Option<(f64, f64)>) -> String {
    match (value, interval) {
        (Some(value), Some((low, high))) => {
            format!("{} [{}, {}]", digits(value), digits(low), digits(high))
        }
        (Some(value), None) => digits(value),
        (None, _) => "–".to_owned(),
    }
}

/// Returns a number to three or four digits.
pub fn digits(value: f64) -> String {
    match value.abs() {
        size if !size.is_finite() => "–".to_owned(),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        size if size >= 1.0 => format!("{value:.2}"),
        size if size >= 1e-4 || size <= 0.0 => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// Judges a single claim, for tests.
#[cfg(test)]
#[track_caller]
pub fn check(finding: Finding, expected: Verdict) {
    let text = format!("{finding:#?}");
    assert_eq!(judge(vec![finding])[0].verdict, expected, "{text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(trials: Vec<Trial>) -> Finding {
        Finding::new(1, "a claim", trials)
    }

    fn at(value: f64, standard_error: f64) -> Trial {
        let estimate = Estimate { value, standard_error, groups: 6 };
        Trial::new("x", Some(estimate), Bound::Below(1.0))
    }

    #[test]
    fn all_tests_must_hold_and_one_that_fails_is_enough() {
        check(finding(vec![at(0.5, 0.05), at(0.7, 0.05)]), Verdict::Reproduced);
        check(finding(vec![at(0.5, 0.05), at(1.5, 0.05)]), Verdict::NotReproduced);
        check(finding(vec![at(0.5, 0.05), at(0.99, 0.05)]), Verdict::Undecided);
        check(
            finding(vec![at(0.5, 0.05), Trial::new("y", None, Bound::Above(0.0))]),
            Verdict::Undecided,
        );
    }

    #[test]
    fn few_groups_and_groups_that_are_all_alike_decide_nothing() {
        let trial = |value: f64, standard_error: f64, groups: usize| {
            let estimate = Estimate { value, standard_error, groups };
            Trial::new("x", Some(estimate), Bound::Below(1.0))
        };
        for value in [0.5, 1.5] {
            check(finding(vec![trial(value, 0.0, 6)]), Verdict::Undecided);
            check(finding(vec![trial(value, 1e-17, 6)]), Verdict::Undecided);
            check(finding(vec![trial(value, 1e-6, 2)]), Verdict::Undecided);
        }
        check(finding(vec![trial(0.5, 0.01, 3)]), Verdict::Reproduced);
        assert!(trial(0.5, 0.0, 6).reason.unwrap().contains("all 6 groups are alike"));
        assert!(trial(0.5, 0.1, 2).reason.unwrap().contains("rests on 2 independent groups"));
        assert_eq!(trial(0.5, 0.01, 3).reason, None);
    }

    #[test]
    fn of_a_number_between_two_ends_the_worse_one_counts() {
        let end = |value| Estimate { value, standard_error: 0.01, groups: 5 };
        let trial = |low, high| Trial::between_ends("x", Some([end(low), end(high)]), 0.9);
        check(finding(vec![trial(0.5, 0.6)]), Verdict::Reproduced);
        check(finding(vec![trial(0.95, 1.0)]), Verdict::NotReproduced);
        check(finding(vec![trial(0.5, 1.0)]), Verdict::Undecided);
    }

    #[test]
    fn facts_need_no_chance_and_conditions_refute_nothing() {
        check(finding(vec![Trial::fact("so", true)]), Verdict::Reproduced);
        check(finding(vec![Trial::fact("so", false)]), Verdict::NotReproduced);
        check(finding(vec![at(0.5, 0.05), Trial::condition("ran", true)]), Verdict::Reproduced);
        check(finding(vec![at(0.5, 0.05), Trial::condition("ran", false)]), Verdict::Undecided);
        check(finding(vec![at(1.5, 0.05), Trial::condition("ran", false)]), Verdict::Undecided);
        check(finding(vec![at(1.5, 0.05).confirming()]), Verdict::Undecided);
    }

    #[test]
    fn many_claims_pay_for_each_other() {
        // p = .013 each, two-sided .026: a single claim is decided, twenty are not.
        let weak = || finding(vec![at(0.85, 0.048)]);
        assert_eq!(judge(vec![weak()])[0].verdict, Verdict::Reproduced);
        let many = judge((0..20).map(|_| weak()).collect());
        assert!(many.iter().all(|judged| judged.verdict == Verdict::Undecided));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(shown(Some(0.123_456), Some((0.1, 2.5))), "0.1235 [0.1000, 2.50]");
        assert_eq!(
            (digits(1234.5), digits(0.0), digits(2e-6)),
            ("1234".into(), "0.0000".into(), "2.0e-6".into())
        );
    }
}
