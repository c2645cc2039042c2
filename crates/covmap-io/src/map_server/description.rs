//! The YAML file of a map.

use super::MapServerError;
use crate::FileError;
use crate::error::{field_name, one_line};
use crate::read::read_text;
use covmap::Grid;
use nalgebra::Point2;
use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use std::path::Path;

/// The largest description that is read \[bytes\].
const MAX_YAML: u64 = 64 << 10;

/// How samples become occupancy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Trinary,
    Scale,
    Raw,
}

/// A valid description, but for the image.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Description {
    pub(crate) image: String,
    /// The length of a cell's side \[m\].
    pub(crate) resolution: f64,
    /// The lower left corner of the lower left pixel \[m\].
    pub(crate) lower_left: Point2<f64>,
    pub(crate) negate: bool,
    pub(crate) occupied: f64,
    pub(crate) free: f64,
    pub(crate) mode: Mode,
}

/// The keys as they stand in the file. Others are passed over: people add their own.
#[derive(serde::Deserialize)]
struct Keys {
    image: Option<String>,
    resolution: Option<f64>,
    origin: Option<[f64; 3]>,
    negate: Option<Negate>,
    occupied_thresh: Option<f64>,
    free_thresh: Option<f64>,
    mode: Option<String>,
}

/// `0`, `1`, `true` or `false`: all are found in the field.
struct Negate(bool);

impl<'de> Deserialize<'de> for Negate {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ZeroOrOne;
        impl Visitor<'_> for ZeroOrOne {
            type Value = Negate;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("0 or 1")
            }
            fn visit_bool<E: Error>(self, value: bool) -> Result<Negate, E> {
                Ok(Negate(value))
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Negate, E> {
                match value {
                    0 | 1 => Ok(Negate(value == 1)),
                    _ => Err(E::invalid_value(Unexpected::Unsigned(value), &self)),
                }
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Negate, E> {
                match value {
                    0 | 1 => Ok(Negate(value == 1)),
                    _ => Err(E::invalid_value(Unexpected::Signed(value), &self)),
                }
            }
        }
        deserializer.deserialize_any(ZeroOrOne)
    }
}

impl Description {
    /// Reads the YAML file of a map.
    pub(crate) fn load(path: &Path) -> Result<Self, FileError> {
        let keys: Keys = parse(path, &read_text(path, MAX_YAML)?)?;
        Self::new(keys).map_err(|reason| FileError::MapServer { path: path.to_path_buf(), reason })
    }

    fn new(keys: Keys) -> Result<Self, MapServerError> {
        fn required<T>(value: Option<T>, key: &'static str) -> Result<T, MapServerError> {
            value.ok_or(MapServerError::Missing(key))
        }
        let image = required(keys.image.filter(|name| !name.is_empty()), "image")?;
        let resolution = required(keys.resolution, "resolution")?;
        let [x, y, yaw] = required(keys.origin, "origin")?;
        let Negate(negate) = required(keys.negate, "negate")?;
        let occupied = required(keys.occupied_thresh, "occupied_thresh")?;
        let free = required(keys.free_thresh, "free_thresh")?;
        let lower_left = Point2::new(x, y);
        // A map of one cell stands for all that the image can be: the numbers are checked
        // before the image is read.
        Grid::new(lower_left, resolution, 1, 1)?;
        if yaw != 0.0 {
            return Err(MapServerError::Yaw(yaw));
        }
        if !(0.0 <= free && free <= occupied && occupied <= 1.0) {
            return Err(MapServerError::Thresholds { free, occupied });
        }
        let mode = match keys.mode.as_deref() {
            None | Some("trinary") => Mode::Trinary,
            Some("scale") => Mode::Scale,
            Some("raw") => Mode::Raw,
            Some(other) => return Err(MapServerError::Mode(other.to_string())),
        };
        Ok(Self { image, resolution, lower_left, negate, occupied, free, mode })
    }
}

fn parse<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, FileError> {
    let options = serde_saphyr::options! {
        with_snippet: false,
        budget: serde_saphyr::budget! { max_aliases: 100, max_depth: 32, max_nodes: 10_000 },
    };
    let fail = |error: &serde_saphyr::Error, field: String| {
        let (line, column) = error.location().map_or((1, 1), |at| (at.line(), at.column()));
        let message = one_line(&error.to_string());
        // The parser ends its sentence with a place, which the error already begins with.
        let place = format!(" at line {line}, column {column}");
        let message = message.strip_suffix(&place).unwrap_or(&message).to_string();
        FileError::Syntax {
            path: path.to_path_buf(),
            line: usize::try_from(line).unwrap_or(usize::MAX).max(1),
            column: usize::try_from(column).unwrap_or(usize::MAX).max(1),
            field,
            message,
        }
    };
    let mut field = String::new();
    let value = serde_saphyr::with_deserializer_from_str_with_options(text, options, |yaml| {
        serde_path_to_error::deserialize(yaml).map_err(|error| {
            field = field_name(error.path());
            error.into_inner()
        })
    });
    value.map_err(|error| fail(&error, field))
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GOOD: &str = "image: map.pgm\nresolution: 0.05\norigin: [-8.0, 2, 0.0]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    fn load(text: &str) -> Result<Description, String> {
        let describe = |keys| Description::new(keys).map_err(|error| error.to_string());
        parse(Path::new("map.yaml"), text).map_err(|error| error.to_string()).and_then(describe)
    }

    /// The sentence with which the good description is refused when a line is replaced.
    #[track_caller]
    fn refuse(key: &str, line: &str, expected: &str) {
        let replaced: Vec<&str> =
            GOOD.lines().map(|old| if old.starts_with(key) { line } else { old }).collect();
        let error = load(&replaced.join("\n")).unwrap_err();
        assert!(error.contains(expected), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }

    #[test]
    fn the_keys_of_map_server_are_read() {
        let description = load(GOOD).unwrap();
        assert_eq!(description.image, "map.pgm");
        assert_eq!(description.lower_left, Point2::new(-8.0, 2.0));
        assert_eq!((description.occupied, description.free), (0.65, 0.196));
        assert_eq!((description.mode, description.negate), (Mode::Trinary, false));
        for (word, mode) in [("trinary", Mode::Trinary), ("scale", Mode::Scale), ("raw", Mode::Raw)]
        {
            assert_eq!(load(&format!("{GOOD}mode: {word}")).unwrap().mode, mode);
        }
    }

    #[test]
    fn negate_may_be_a_number_or_a_word() {
        for (word, negate) in [("0", false), ("1", true), ("true", true), ("false", false)] {
            let text = GOOD.replace("negate: 0", &format!("negate: {word}"));
            assert_eq!(load(&text).unwrap().negate, negate);
        }
    }

    #[test]
    fn keys_of_others_are_passed_over() {
        assert!(load(&format!("{GOOD}author: someone\ntags: [a, {{b: c}}]\n")).is_ok());
    }

    #[test]
    fn a_wrong_description_is_refused_in_one_clear_sentence() {
        for key in ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"] {
            refuse(key, "", &format!("the key `{key}` is missing"));
        }
        refuse("image", "image: ''", "the key `image` is missing");
        refuse("resolution", "resolution: 0", "the resolution 0 m must be a positive");
        refuse("resolution", "resolution: -0.1", "the resolution -0.1 m");
        refuse("resolution", "resolution: .nan", "the resolution NaN m");
        refuse("resolution", "resolution: fine", "map.yaml:2:13: resolution: ");
        refuse("origin", "origin: [0, 0, 0.1]", "a yaw of 0.1 rad");
        refuse("origin", "origin: [0, 0, .nan]", "a yaw of NaN rad");
        refuse("origin", "origin: [0, 0]", "map.yaml:3:");
        refuse("origin", "origin: [.inf, 0, 0]", "must be finite");
        refuse(
            "negate",
            "negate: 2",
            "map.yaml:4:1: negate: invalid value: integer `2`, expected 0 or 1",
        );
        refuse("free_thresh", "free_thresh: 0.9", "must be in order");
        refuse("occupied_thresh", "occupied_thresh: .nan", "must be in order");
        refuse("negate", "negate: 0\nmode: color", "the mode `color` is none of");
        refuse("image", "image: [", "map.yaml:");
        refuse("image", "image: a\nimage: b", "map.yaml:2:");
    }

    #[test]
    fn an_empty_file_misses_its_first_key() {
        for text in ["", "# nothing\n", "\u{feff}"] {
            assert!(load(text).is_err());
        }
    }

    #[test]
    fn aliases_are_no_bomb() {
        let mut bomb = String::from("a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n");
        for level in 1..12 {
            let inner = vec![format!("*a{}", level - 1); 9].join(", ");
            bomb.push_str(&format!("a{level}: &a{level} [{inner}]\n"));
        }
        assert!(load(&format!("{bomb}{GOOD}")).is_err());
        assert!(load(&format!("{GOOD}deep: {}", "[".repeat(30_000))).is_err());
        assert!(load(&format!("{GOOD}deep: {}", "- ".repeat(30_000))).is_err());
    }

    proptest! {
        #[test]
        fn arbitrary_text_never_panics(text in r#"[\PC\n]{0,80}|[-\[\]{}:,&*"'|>?!%@#\na-c0-9. ]{0,80}"#) {
            let _ = load(&text);
            let _ = load(&format!("{GOOD}extra: {text}"));
        }
    }
}
