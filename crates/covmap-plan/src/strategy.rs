//! The strategies of section 4, by name.

use covmap::short;
use covmap_model::Counting;
use serde::de::{Error, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// A strategy that chooses the next view-point.
///
/// Files, the command line and tables spell a strategy alike: `CL`, `IG`, `IG_WIN:RADIUS`,
/// `IG_CL:ALPHA`, `COUNT:N`, `COUNT:N:D0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strategy {
    /// The closest location, Eq. (12).
    Cl,
    /// The largest expected information gain, Eq. (15).
    Ig,
    /// The largest gain within a local window until the window is explored (section 4.2).
    IgWin {
        /// Radius of the window \[m\].
        radius: f64,
    },
    /// Gain against travel cost, Eq. (16).
    IgCl {
        /// Weight of the gain.
        alpha: f64,
    },
    /// The closest location with a cell in sight that was not yet scanned `times` times (section 5.1);
    /// this strategy reads no entropy.
    Count {
        /// The number of scans that each cell needs.
        times: f64,
        /// Distance at which a beam counts half \[m\]; if none, every beam counts fully.
        half_distance: Option<f64>,
    },
}

impl Strategy {
    /// Whether the choice depends on the expected information gain.
    pub fn uses_gain(&self) -> bool {
        matches!(self, Strategy::Ig | Strategy::IgWin { .. } | Strategy::IgCl { .. })
    }

    /// Returns the rule for counting scans and the weight that finishes a cell, if the strategy counts.
    pub fn counting(&self) -> Option<(Counting, f64)> {
        let Strategy::Count { times, half_distance } = *self else { return None };
        let counting = half_distance
            .map_or(Counting::Plain, |half_distance| Counting::Discounted { half_distance });
        Some((counting, times))
    }

    /// Returns a short name for files: letters, digits, dots, hyphens and underscores.
    pub fn file_name(&self) -> String {
        match self {
            Strategy::Cl => "CL".into(),
            Strategy::Ig => "IG".into(),
            Strategy::IgWin { radius } => format!("IG_WIN-{radius}"),
            Strategy::IgCl { alpha } => format!("IG_CL-{alpha}"),
            Strategy::Count { times, half_distance: None } => format!("COUNT-{times}"),
            Strategy::Count { times, half_distance: Some(d) } => format!("COUNT-{times}-{d}"),
        }
    }

    /// Checks the numbers. With larger numbers a run would not end, or its choices would no longer depend
    /// on them.
    ///
    /// # Errors
    /// If a number is out of its range.
    pub fn validate(&self) -> Result<(), StrategyError> {
        let number = |name: &'static str, value: f64, min: f64, max: f64| {
            let good = (min..=max).contains(&value);
            good.then_some(()).ok_or(StrategyError::Number { name, value, min, max })
        };
        match *self {
            Strategy::Cl | Strategy::Ig => Ok(()),
            Strategy::IgWin { radius } => number("the radius of IG_WIN", radius, 0.1, 1e4),
            Strategy::IgCl { alpha } => number("the weight α of IG_CL", alpha, 0.0, 1e9),
            Strategy::Count { times, half_distance } => {
                number("the count of COUNT", times, 1e-3, 1e4)?;
                number("the half distance of COUNT", half_distance.unwrap_or(1.0), 0.1, 1e3)
            }
        }
    }
}

/// Error in the spelling or in the numbers of a strategy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StrategyError {
    /// Not one of the names, or the wrong number of parameters.
    #[error(
        "`{0}` is no strategy: use CL, IG, IG_WIN:RADIUS, IG_CL:ALPHA, COUNT:N or COUNT:N:D0, as in IG_CL:0.3"
    )]
    Unknown(String),
    /// Not a text, in a file.
    #[error(
        "a strategy is spelled in quotes: \"CL\", \"IG\", \"IG_WIN:RADIUS\", \"IG_CL:ALPHA\", \"COUNT:N\" or \"COUNT:N:D0\""
    )]
    Unspelled,
    /// A number out of range.
    #[error("{name} is {}; it must lie in [{min}, {max}]", short(value))]
    Number {
        /// Name of the number.
        name: &'static str,
        /// Value of the number.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
    },
}

impl FromStr for Strategy {
    type Err = StrategyError;

    fn from_str(text: &str) -> Result<Self, StrategyError> {
        let unknown = || StrategyError::Unknown(text.to_owned());
        // `COUNT:50:2`, or `COUNT(50, 2)` as earlier versions printed it.
        let printed = text.strip_suffix(')').and_then(|text| text.split_once('('));
        let typed = printed.map(|(name, numbers)| {
            format!("{name}:{}", numbers.replace(',', ":").replace(' ', ""))
        });
        let mut parts = typed.as_deref().unwrap_or(text).split(':');
        let name = parts.next().unwrap_or_default().to_ascii_uppercase();
        let numbers: Vec<f64> =
            parts.map(str::parse).collect::<Result<_, _>>().map_err(|_| unknown())?;
        let strategy = match (name.as_str(), numbers.as_slice()) {
            ("CL", []) => Strategy::Cl,
            ("IG", []) => Strategy::Ig,
            ("IG_WIN", &[radius]) => Strategy::IgWin { radius },
            ("IG_CL", &[alpha]) => Strategy::IgCl { alpha },
            ("COUNT", &[times]) => Strategy::Count { times, half_distance: None },
            ("COUNT", &[times, d0]) => Strategy::Count { times, half_distance: Some(d0) },
            _ => return Err(unknown()),
        };
        strategy.validate()?;
        Ok(strategy)
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Strategy::Cl => write!(f, "CL"),
            Strategy::Ig => write!(f, "IG"),
            Strategy::IgWin { radius } => write!(f, "IG_WIN:{radius}"),
            Strategy::IgCl { alpha } => write!(f, "IG_CL:{alpha}"),
            Strategy::Count { times, half_distance: None } => write!(f, "COUNT:{times}"),
            Strategy::Count { times, half_distance: Some(d) } => write!(f, "COUNT:{times}:{d}"),
        }
    }
}

impl Serialize for Strategy {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A strategy in a file: as spelled now, or as earlier versions wrote it.
#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Spelled(String),
    Earlier(Earlier),
    Other(IgnoredAny),
}

/// `IgCl(alpha: 0.3)`, and so on. `Cl` and `Ig` read like texts.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum Earlier {
    IgWin { radius: f64 },
    IgCl { alpha: f64 },
    Count { times: f64, half_distance: Option<f64> },
}

impl<'de> Deserialize<'de> for Strategy {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let strategy = match Written::deserialize(deserializer)? {
            Written::Spelled(text) => return text.parse().map_err(D::Error::custom),
            Written::Earlier(Earlier::IgWin { radius }) => Self::IgWin { radius },
            Written::Earlier(Earlier::IgCl { alpha }) => Self::IgCl { alpha },
            Written::Earlier(Earlier::Count { times, half_distance }) => {
                Self::Count { times, half_distance }
            }
            Written::Other(_) => return Err(D::Error::custom(StrategyError::Unspelled)),
        };
        strategy.validate().map_err(D::Error::custom)?;
        Ok(strategy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_printed_is_read_back() {
        for text in ["CL", "IG", "IG_WIN:2.5", "IG_CL:0.3", "IG_CL:1e9", "COUNT:7", "COUNT:50:2.5"]
        {
            let strategy: Strategy = text.parse().unwrap();
            assert_eq!(strategy.to_string().parse(), Ok(strategy), "{strategy}");
        }
        for text in ["IG_CL(", "IG_CL()", "IG_CL(.3", "CL(1)", "COUNT(1, 2, 3)", "IG_CL((1))"] {
            assert!(text.parse::<Strategy>().is_err(), "{text}");
        }
    }

    #[test]
    fn what_earlier_versions_printed_is_read() {
        for (earlier, now) in [
            ("cl", "CL"),
            ("IG_CL(.3)", "IG_CL:0.3"),
            ("IG_CL(1.0)", "IG_CL:1"),
            ("IG_WIN(2.0)", "IG_WIN:2"),
            ("COUNT(50, 2)", "COUNT:50:2"),
        ] {
            assert_eq!(earlier.parse::<Strategy>().unwrap().to_string(), now);
        }
    }

    #[test]
    fn what_is_no_strategy_is_refused() {
        for text in [
            "",
            "FBE",
            "IG:1",
            "IG_CL",
            "IG_CL:x",
            "IG_CL:-1",
            "IG_WIN:0",
            "COUNT:nan",
            "COUNT:1e308",
            "COUNT:10001",
            "COUNT:5:1e-12",
            "COUNT:5:inf",
            "IG_CL:1e300",
            "IG_WIN:1e300",
            "COUNT:1:2:3",
        ] {
            assert!(text.parse::<Strategy>().is_err(), "{text}");
        }
    }
}
