//! Setting parameters by their paths.

use crate::Config;
use serde_json::Value;

/// Error in the path or the value of a parameter.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OverrideError {
    /// The path leads to no parameter.
    #[error("{0:?} is no parameter of a configuration")]
    NoParameter(String),
    /// The value is of another kind.
    #[error("{path:?}: {message}")]
    Value {
        /// Path of the parameter.
        path: String,
        /// The fault of the value.
        message: String,
    },
}

impl Config {
    /// Returns the configuration with another value of one parameter, such as
    /// `"model.update.Cause.no_echo.range"`.
    ///
    /// A variant without fields is a string, `"Off"`; one with fields is a map from its name,
    /// `{"Banded": {"first": 1.0, "closest": 0.5}}`.
    ///
    /// # Errors
    /// If there is no such parameter, or the value is of another kind. [`Config::build`] checks whether
    /// the value is in its interval.
    pub fn overridden(&self, path: &str, value: &Value) -> Result<Self, OverrideError> {
        let fail = |error: serde_json::Error| OverrideError::Value {
            path: path.to_owned(),
            message: error.to_string(),
        };
        let none = || OverrideError::NoParameter(path.to_owned());
        if path.contains(['/', '~']) {
            // In a JSON pointer these characters have a meaning of their own.
            return Err(none());
        }
        let mut tree = serde_json::to_value(self).map_err(fail)?;
        let place = tree.pointer_mut(&format!("/{}", path.replace('.', "/")));
        *place.ok_or_else(none)? = value.clone();
        serde_json::from_value(tree).map_err(fail)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_plan::{BodyEvidence, StallRule};
    use serde_json::json;

    #[test]
    #[allow(clippy::float_cmp, reason = "a written number comes back")]
    fn a_parameter_is_set_by_its_path() {
        let set = |path, value: Value| Config::b21r().overridden(path, &value).unwrap();
        assert_eq!(set("resolution", json!(0.15)).resolution, 0.15);
        assert_eq!(
            set("model.update.Cause.no_echo.range", json!(0)).model.update.no_echo_range(),
            0.0
        );
        let off = set("planner.body_evidence", json!("Off"));
        assert_eq!(off.planner.body_evidence, BodyEvidence::Off);
        let rule = json!({"Banded": {"first": 2.0, "closest": 0.7}});
        let rule = set("planner.stall_rule", rule).planner.stall_rule;
        assert_eq!(rule, StallRule::Banded { first: 2.0, closest: 0.7 });
    }

    #[test]
    fn what_is_no_parameter_is_refused() {
        for (path, value, expected) in [
            ("planner.scan_spaceing", json!(0.3), "\"planner.scan_spaceing\" is no parameter"),
            ("planner.scope", json!("Everything"), "\"planner.scope\": unknown variant"),
            ("model.bins", json!(1.5), "\"model.bins\": invalid type"),
            ("", json!(1.5), "is no parameter"),
            ("model/bins", json!(12), "\"model/bins\" is no parameter"),
            ("model.no~0echo", json!(12), "\"model.no~0echo\" is no parameter"),
        ] {
            let error = Config::b21r().overridden(path, &value).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
