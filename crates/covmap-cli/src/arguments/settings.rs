//! Parameters of the configuration that are set one by one.

use crate::names;
use anyhow::{Result, anyhow};
use clap::Args;
use covmap_lab::Config;
use serde_json::Value;

/// Parameters of the configuration, by their paths.
#[derive(Debug, Clone, Args)]
pub(crate) struct Settings {
    /// Set one parameter of the configuration by its path, as in planner.entropy_threshold=0.5 or
    /// planner.body_evidence=Off; repeat it for more parameters [default: from the configuration]
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = setting)]
    set: Vec<Setting>,
}

/// One parameter and its value.
#[derive(Debug, Clone)]
struct Setting {
    path: String,
    value: Value,
    typed: String,
}

/// Parses one setting; its value is JSON, or else a word.
fn setting(text: &str) -> Result<Setting, String> {
    let (path, value) = text.split_once('=').ok_or("expected PATH=VALUE, as in model.bins=21")?;
    let value = serde_json::from_str(value).unwrap_or_else(|_| Value::String(value.to_owned()));
    Ok(Setting { path: path.to_owned(), value, typed: text.to_owned() })
}

impl Settings {
    /// Returns the configuration with these parameters. The later check of the configuration covers
    /// their intervals.
    pub(crate) fn apply(&self, config: Config) -> Result<Config> {
        self.set.iter().try_fold(config, |config, Setting { path, value, typed }| {
            config.overridden(path, value).map_err(|error| anyhow!("--set {typed}: {error}"))
        })
    }

    /// Returns the parameters for the name of a folder; `None` without any.
    pub(crate) fn in_name(&self) -> Option<String> {
        let last = |setting: &Setting| {
            let from = setting.path.rfind('.').map_or(0, |dot| dot + 1);
            names::plain(&setting.typed[from..])
        };
        let names: Vec<String> = self.set.iter().map(last).collect();
        (!names.is_empty()).then(|| names.join("-"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_set_by_their_paths() {
        let parsed = |texts: &[&str]| Settings {
            set: texts.iter().map(|text| setting(text).unwrap()).collect(),
        };
        let set = parsed(&["planner.entropy_threshold=0.5", "planner.body_evidence=Off"]);
        let config = set.apply(Config::b21r()).unwrap();
        assert!((config.planner.entropy_threshold - 0.5).abs() < 1e-12);
        assert_eq!(set.in_name().as_deref(), Some("entropy_threshold_0.5-body_evidence_Off"));
        let rule = r#"planner.stall_rule={"Banded":{"first":2.0,"closest":0.7}}"#;
        assert!(parsed(&[rule]).apply(Config::b21r()).is_ok());
        assert_eq!(parsed(&[]).in_name(), None);
        assert!(setting("planner.scope").is_err());
        for (text, expected) in [
            ("planner.scoop=Reachable", "is no parameter"),
            ("model.bins=1.5", "--set model.bins=1.5: \"model.bins\": invalid type"),
            ("=3", "is no parameter"),
        ] {
            let error = parsed(&[text]).apply(Config::b21r()).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
