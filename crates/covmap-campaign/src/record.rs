//! The record of a run.

use covmap_lab::Summary;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Key of a run in a campaign.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunKey {
    /// Name of the world.
    pub world: String,
    /// Name of the setting.
    pub setting: String,
    /// Spelling of the strategy, such as `IG_CL:0.3`.
    pub strategy: String,
    /// Number of the start in the world, counted from 0.
    pub start: usize,
    /// Seed of the noise.
    pub seed: u64,
}

/// Record of a run. Everything but the times is a function of the campaign and the program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunRecord {
    /// Key of the run.
    pub key: RunKey,
    /// Results by name, in the order of the columns of `runs.csv`.
    pub values: IndexMap<String, Value>,
    /// Times by name \[s\].
    pub times: IndexMap<String, f64>,
}

/// A number or a text.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl RunRecord {
    /// Whether the run ended before everything was explored, such as at the largest number of scans of its
    /// setting: to the end it would have taken more scans and a longer path.
    pub fn is_cut_short(&self) -> bool {
        matches!(self.values.get("ending"), Some(Value::Text(ending)) if ending != "Explored")
    }
}

impl fmt::Display for RunKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { world, setting, strategy, start, seed } = self;
        write!(f, "{world}, {setting}, {strategy}, start {start}, seed {seed}")
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Rust prints the digits that bring the number back.
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => write!(f, "{text}"),
        }
    }
}

/// Fields that are no values: those of the key, the time, and those that not every world has.
const NOT_VALUES: [&str; 6] =
    ["world", "strategy", "seed", "seconds", "wall_recall_rough", "wall_recall_smooth"];

/// All values of a summary by their names; those of a group as `group.name`.
pub(crate) fn values(summary: &Summary) -> serde_json::Result<IndexMap<String, Value>> {
    let text = serde_json::to_string(summary)?;
    let fields: IndexMap<String, serde_json::Value> = serde_json::from_str(&text)?;
    let mut values = IndexMap::new();
    for (name, field) in fields {
        match field {
            _ if NOT_VALUES.contains(&name.as_str()) => {}
            serde_json::Value::Object(group) => {
                let named = |(inner, value)| Some((format!("{name}.{inner}"), one(&value)?));
                values.extend(group.into_iter().filter_map(named));
            }
            field => values.extend(one(&field).map(|value| (name, value))),
        }
    }
    Ok(values)
}

fn one(field: &serde_json::Value) -> Option<Value> {
    let text = || field.as_str().map(|text| Value::Text(text.to_owned()));
    field.as_f64().map(Value::Number).or_else(text)
}
