//! Why a verdict is as it is: the number that decided it, in a sentence.

use crate::trial::{Judged, Trial, Verdict, shown};

impl Judged {
    /// Returns the test on which the verdict rests: the condition that is not met, the test that speaks most
    /// against a refuted claim, or the one that speaks least for any other.
    pub fn deciding(&self) -> Option<&Trial> {
        let trials = || self.finding.trials.iter();
        if let Some(unmet) = trials().find(|trial| trial.is_unmet_condition()) {
            return Some(unmet);
        }
        match self.verdict {
            Verdict::NotReproduced => trials().min_by(|a, b| a.p_fails.total_cmp(&b.p_fails)),
            Verdict::Reproduced | Verdict::Undecided => {
                trials().max_by(|a, b| a.p_holds.total_cmp(&b.p_holds))
            }
        }
    }

    /// Returns one sentence that tells why the verdict is as it is.
    pub fn why(&self) -> String {
        let Some(trial) = self.deciding() else { return "There is no test.".to_owned() };
        let found = if trial.exact {
            format!("{}: {}", trial.what, trial.bound)
        } else {
            let value = shown(trial.value, trial.interval);
            format!("{}: {value}; it must be {}", trial.what, trial.bound)
        };
        let others = self.finding.trials.len() - 1;
        match self.verdict {
            Verdict::Reproduced if others == 0 => format!("{found}."),
            Verdict::Reproduced => {
                format!("All {} tests hold; the closest is: {found}.", others + 1)
            }
            Verdict::NotReproduced => format!("{found}."),
            Verdict::Undecided if trial.is_unmet_condition() => {
                format!("Nothing is compared, for a condition is not met: {}.", trial.what)
            }
            Verdict::Undecided => match &trial.reason {
                Some(reason) => format!("{found} ({reason})."),
                None => format!("{found}. {}", missing(trial)),
            },
        }
    }
}

/// Tells what it would take to decide a test.
fn missing(trial: &Trial) -> String {
    match (trial.groups, trial.groups_needed) {
        (Some(groups), Some(needed)) if needed > groups as f64 => format!(
            "With {groups} independent groups that is too near to the limit: if the number is as measured, about \
             {:.0} would decide.",
            needed.min(1e9)
        ),
        (Some(groups), _) => {
            format!("{groups} independent groups do not decide at the level that Holm leaves.")
        }
        (None, _) => "There are no data.".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use crate::trial::{Bound, Finding, Trial, judge};
    use covmap_statistics::Estimate;

    fn why(trials: Vec<Trial>) -> String {
        judge(vec![Finding::new(1, "a claim", trials)])[0].why()
    }

    fn at(what: &str, value: f64) -> Trial {
        let estimate = Estimate { value, standard_error: 0.05, groups: 6 };
        Trial::new(what, Some(estimate), Bound::Below(1.0))
    }

    #[test]
    fn a_sentence_names_the_number_that_decides() {
        let good = why(vec![at("scans", 0.5), at("path", 0.7)]);
        assert_eq!(
            good,
            "All 2 tests hold; the closest is: path: 0.7000 [0.5715, 0.8285]; it must be ≤ 1."
        );
        let bad = why(vec![at("scans", 0.5), at("path", 1.7), at("time", 1.5)]);
        assert_eq!(bad, "path: 1.70 [1.57, 1.83]; it must be ≤ 1.");
    }

    #[test]
    fn what_is_undecided_says_what_is_missing() {
        // ((z(.99875) + z(.8)) · .05 / .05)² · 6 = (3.02334 + .84162)² · 6 = 89.6.
        let near = why(vec![at("scans", 0.5), at("path", 0.95)]);
        assert!(near.ends_with("With 6 independent groups that is too near to the limit: if the number is as measured, about 90 would decide."), "{near}");
        let void =
            why(vec![at("path", 1.7), Trial::condition("all runs came to their end", false)]);
        assert_eq!(
            void,
            "Nothing is compared, for a condition is not met: all runs came to their end."
        );
        let none = why(vec![Trial::new("path", None, Bound::Above(0.0))]);
        assert_eq!(none, "path: –; it must be ≥ 0 (no data).");
        assert_eq!(why(vec![Trial::fact("so", false)]), "so: it is not so.");
    }
}
