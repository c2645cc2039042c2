//! RON files: worlds and configurations.

use crate::FileError;
use crate::error::{field_name, one_line};
use crate::escaped;
use crate::new_file::{Replace, write_file};
use crate::read::{MAX_FILE, read_text};
use ron::extensions::Extensions;
use ron::ser::PrettyConfig;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// The deepest nesting that is read: no file of covmap comes near, and the stack holds.
const MAX_DEPTH: usize = 64;

/// Reads the value of a RON file. `Some(…)` may be left out (`implicit_some`).
///
/// # Errors
/// If the file cannot be read, has more than 64 MB, or does not hold such a value. The error names
/// file, line, column, and field.
pub fn read_ron<T: DeserializeOwned>(path: impl AsRef<Path>) -> Result<T, FileError> {
    let path = path.as_ref();
    parse_ron(path, &read_text(path, MAX_FILE)?)
}

/// Reads the value of RON text; `path` names the text in errors.
///
/// # Errors
/// If the text does not hold such a value. The error names line, column, and field.
pub fn parse_ron<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, FileError> {
    let options = ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_recursion_limit(MAX_DEPTH);
    let fail = |error: ron::error::SpannedError, field: String| FileError::Syntax {
        path: path.to_path_buf(),
        line: error.span.end.line,
        column: error.span.end.col,
        field,
        message: one_line(&error.code.to_string()),
    };
    let mut deserializer = ron::Deserializer::from_str_with_options(text, &options)
        .map_err(|error| fail(error, String::new()))?;
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let field = field_name(error.path());
        fail(deserializer.span_error(error.into_inner()), field)
    })?;
    let end = deserializer.end();
    end.map_err(|error| fail(deserializer.span_error(error), String::new()))?;
    Ok(value)
}

/// Returns a value as RON, a field a line, below a comment of one or more lines; `path` names it in errors.
///
/// # Errors
/// If the value has no form in RON.
pub fn to_ron<T: Serialize>(
    path: &Path,
    value: &T,
    comment: Option<&str>,
) -> Result<String, FileError> {
    let body = ron::Options::default()
        .with_recursion_limit(MAX_DEPTH)
        .to_string_pretty(value, PrettyConfig::default())
        .map_err(|error| FileError::Unwritable {
            path: path.to_path_buf(),
            message: one_line(&error.to_string()),
        })?;
    let mut text = String::new();
    for line in comment.unwrap_or_default().lines() {
        text.push_str(format!("// {}", escaped(line)).trim_end());
        text.push('\n');
    }
    text.push_str(&body);
    text.push('\n');
    Ok(text)
}

/// Writes a value as [`to_ron`] shows it. An old file is replaced.
///
/// # Errors
/// If the value has no form in RON, or the file cannot be written.
pub fn write_ron<T: Serialize>(
    path: impl AsRef<Path>,
    value: &T,
    comment: Option<&str>,
) -> Result<(), FileError> {
    let path = path.as_ref();
    write_file(path, to_ron(path, value, comment)?.as_bytes(), Replace::Any)
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct World {
        name: String,
        obstacles: Vec<Obstacle>,
        limit: Option<u32>,
    }

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Obstacle {
        shape: Shape,
    }

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    enum Shape {
        Circle { radius: f64 },
        Wall((f64, f64), f64),
        Group(Vec<Shape>),
    }

    fn parse(text: &str) -> Result<World, String> {
        parse_ron(Path::new("worlds/x.ron"), text).map_err(|e| e.to_string())
    }

    #[track_caller]
    fn refuse(text: &str, expected: &str) {
        assert_eq!(parse(text).unwrap_err(), expected);
    }

    #[test]
    fn some_may_be_left_out() {
        let with = |limit: &str| format!("(name: \"a\", obstacles: [], limit: {limit})");
        assert_eq!(parse(&with("3")).unwrap().limit, Some(3));
        assert_eq!(parse(&with("Some(3)")).unwrap().limit, Some(3));
        assert_eq!(parse(&with("None")).unwrap().limit, None);
    }

    #[test]
    fn an_error_names_file_line_column_and_field() {
        refuse(
            "(\n    name: \"a\",\n    obstacles: [\n        (shape: Circle(radius: \"wide\")),\n    ],\n)",
            "worlds/x.ron:4:32: obstacles[0].shape.Circle.radius: expected float",
        );
        refuse(
            "(name: \"a\", colour: 3)",
            "worlds/x.ron:1:19: colour: unexpected field named `colour` in `World`, \
             expected one of `name`, `obstacles`, or `limit` instead",
        );
        refuse(
            "(name: \"a\", limit: 3)",
            "worlds/x.ron:1:21: unexpected missing field named `obstacles` in `World`",
        );
        refuse("", "worlds/x.ron:1:1: expected opening `(` for struct `World`");
    }

    #[test]
    fn what_follows_the_value_is_refused() {
        refuse(
            "(name: \"a\", obstacles: [], limit: None) 3",
            "worlds/x.ron:1:41: non-whitespace trailing characters",
        );
    }

    #[test]
    fn deep_nesting_is_refused_and_overflows_no_stack() {
        let deep = |open: &str, close: &str| {
            format!(
                "(name: \"a\", obstacles: [(shape: {}{}",
                open.repeat(100_000),
                close.repeat(100_000)
            )
        };
        for (open, close) in
            [("Group([", "])"), ("[", "]"), ("(", ")"), ("Some(", ")"), ("{1:", "}")]
        {
            assert!(parse(&deep(open, close)).is_err());
            assert!(parse(&format!("(unknown: {}", open.repeat(100_000))).is_err());
        }
        assert!(parse(&"/*".repeat(100_000)).is_err());
        assert!(parse(&"#![enable(implicit_some)]".repeat(10_000)).is_err());
    }

    #[test]
    fn a_value_comes_back_below_its_comment() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("w.ron");
        let world = World {
            name: "a \"b\"".into(),
            obstacles: vec![
                Obstacle { shape: Shape::Circle { radius: 0.1 } },
                Obstacle { shape: Shape::Group(vec![Shape::Wall((0.5, -1e-9), 2.0)]) },
            ],
            limit: Some(7),
        };
        write_ron(&path, &world, Some("A world.\n\nFor tests.")).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("// A world.\n//\n// For tests.\n("), "{text}");
        assert_eq!(read_ron::<World>(&path).unwrap(), world);
    }

    #[test]
    fn a_file_that_is_missing_too_large_or_no_text_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let refuse = |path: &Path| read_ron::<World>(path).unwrap_err().to_string();
        let missing = folder.path().join("missing.ron");
        assert!(refuse(&missing).contains("missing.ron: cannot be read: No such file"));
        assert!(refuse(folder.path()).contains("cannot be read"));
        let binary = folder.path().join("binary.ron");
        std::fs::write(&binary, b"(\xff)").unwrap();
        assert!(refuse(&binary).ends_with("binary.ron: is not a text file: byte 1 is not UTF-8"));
        let huge = folder.path().join("huge.ron");
        std::fs::File::create(&huge).unwrap().set_len(MAX_FILE + 1).unwrap();
        assert!(matches!(read_ron::<World>(&huge), Err(FileError::TooLarge { .. })));
    }

    proptest! {
        #[test]
        fn arbitrary_text_never_panics(text in r#"[\PC\n]{0,80}|[()\[\]{}:,"a-z0-9#!r'/*. ]{0,80}"#) {
            let _ = parse(&text);
            let _ = parse(&format!("(name: {text}, obstacles: [(shape: {text})], limit: {text})"));
        }
    }
}
