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

/// The largest yaw, some 160,000 turns \[rad\]: the sine of a larger yaw is no longer exact.
const MAX_YAW: f64 = 1e6;

/// Rule by which samples become occupancy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Trinary,
    Scale,
    Raw,
}

/// A description that is valid, apart from the image.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Description {
    pub(crate) image: String,
    /// The length of a cell's side \[m\].
    pub(crate) resolution: f64,
    /// The lower left corner of the lower left pixel \[m\].
    pub(crate) lower_left: Point2<f64>,
    /// Angle by which the map is turned about that corner, counter-clockwise \[rad\].
    pub(crate) yaw: f64,
    pub(crate) negate: bool,
    pub(crate) occupied: f64,
    pub(crate) free: f64,
    pub(crate) mode: Mode,
}

/// The keys as they stand in the file. Other keys are ignored: users add their own.
#[derive(serde::Deserialize)]
struct Keys {
    image: Option<String>,
    resolution: Option<f64>,
    origin: Option<Vec<f64>>,
    negate: Option<Negate>,
    occupied_thresh: Option<f64>,
    free_thresh: Option<f64>,
    mode: Option<String>,
}

/// `0`, `1`, or a truth value: maps in the field have all of them.
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
            fn visit_str<E: Error>(self, value: &str) -> Result<Negate, E> {
                match value.to_ascii_lowercase().as_str() {
                    "1" | "true" | "yes" | "on" => Ok(Negate(true)),
                    "0" | "false" | "no" | "off" => Ok(Negate(false)),
                    _ => Err(E::invalid_value(Unexpected::Str(value), &self)),
                }
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
        let origin = required(keys.origin, "origin")?;
        let [x, y, yaw] = *origin else { return Err(MapServerError::Origin(origin.len())) };
        let Negate(negate) = required(keys.negate, "negate")?;
        let occupied = required(keys.occupied_thresh, "occupied_thresh")?;
        let free = required(keys.free_thresh, "free_thresh")?;
        let lower_left = Point2::new(x, y);
        // A grid of one cell stands for any image: the numbers are checked before the image is read.
        Grid::new(lower_left, resolution, 1, 1)?;
        if yaw.is_nan() || yaw.abs() > MAX_YAW {
            return Err(MapServerError::Yaw(yaw));
        }
        if !(0.0 <= free && free <= occupied && occupied <= 1.0) {
            return Err(MapServerError::Thresholds { free, occupied });
        }
        let mode = keys.mode.unwrap_or_else(|| "trinary".into());
        let mode = match mode.to_ascii_lowercase().as_str() {
            "trinary" => Mode::Trinary,
            "scale" => Mode::Scale,
            "raw" => Mode::Raw,
            _ => return Err(MapServerError::Mode(mode)),
        };
        Ok(Self { image, resolution, lower_left, yaw, negate, occupied, free, mode })
    }
}

fn parse<T: serde::de::DeserializeOwned>(path: &Path, text: &str) -> Result<T, FileError> {
    let options = serde_saphyr::options! {
        with_snippet: false,
        budget: serde_saphyr::budget! { max_aliases: 100, max_depth: 32, max_nodes: 10_000 },
    };
    let fail = |error: &serde_saphyr::Error, field: String| {
        let (line, column) = error.location().map_or((1, 1), |at| (at.line(), at.column()));
        FileError::Syntax {
            path: path.to_path_buf(),
            line: usize::try_from(line).unwrap_or(usize::MAX).max(1),
            column: usize::try_from(column).unwrap_or(usize::MAX).max(1),
            field,
            message: in_words(error),
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

/// Words an error for the author of the file: the parser's own words are for its caller.
fn in_words(error: &serde_saphyr::Error) -> String {
    use serde_saphyr::Error;
    match error {
        Error::DuplicateMappingKey { key: Some(key), .. } => {
            format!("the key `{key}` stands there twice")
        }
        Error::MultipleDocuments { .. } => "a second document begins here: a map has one".into(),
        Error::NullIntoString { .. } => "has no value".into(),
        Error::InvalidScalar { .. } => "expected a number".into(),
        Error::NonFiniteFloat { value, .. } => format!("{value} is no finite number"),
        Error::SerdeInvalidType { unexpected, expected, .. } => {
            one_line(&format!("invalid type: {unexpected}, expected {expected}"))
        }
        Error::SerdeInvalidValue { unexpected, expected, .. } => {
            one_line(&format!("invalid value: {unexpected}, expected {expected}"))
        }
        Error::Unexpected { expected, .. } => format!("expected {expected}"),
        Error::ExternalMessage { msg, .. } => format!("is not YAML: {}", one_line(msg)),
        Error::Budget { .. } => "is nested too deeply, or too long, for a map".into(),
        _ => "is not valid YAML".into(),
    }
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

    /// Checks the sentence that refuses the good description with one line replaced.
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
        for (word, mode) in [
            ("trinary", Mode::Trinary),
            ("Trinary", Mode::Trinary),
            ("\"SCALE\"", Mode::Scale),
            ("raw", Mode::Raw),
        ] {
            assert_eq!(load(&format!("{GOOD}mode: {word}")).unwrap().mode, mode);
        }
    }

    #[test]
    fn negate_may_be_a_number_or_a_word() {
        for (word, negate) in [
            ("0", false),
            ("1", true),
            ("true", true),
            ("False", false),
            ("yes", true),
            ("off", false),
        ] {
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
        refuse("origin", "origin: [0, 0, .nan]", "a yaw of NaN, which must be");
        refuse("origin", "origin: [0, 0, -.inf]", "a yaw of -inf, which must be");
        refuse("origin", "origin: [0, 0]", "three numbers, not 2");
        refuse("origin", "origin: [0, 0, 0, 0]", "three numbers, not 4");
        refuse("origin", "origin: 3", "map.yaml:3:9: origin: ");
        refuse("origin", "origin: [.inf, 0, 0]", "must be finite");
        refuse(
            "negate",
            "negate: 2",
            "map.yaml:4:1: negate: invalid value: integer `2`, expected 0 or 1",
        );
        refuse("free_thresh", "free_thresh: 0.9", "must be in order");
        refuse("occupied_thresh", "occupied_thresh: .nan", "must be in order");
        refuse("negate", "negate: 0\nmode: color", "the mode `color` is none of");
        refuse("occupied_thresh", "occupied_thresh: 65", "must be in order");
    }

    #[test]
    fn the_parser_gives_no_advice_about_itself() {
        refuse("image", "image: a\nimage: b", "map.yaml:2:1: the key `image` stands there twice");
        refuse("image", "image: a\n---\nimage: b", "a second document begins here");
        refuse("resolution", "resolution: fine", "map.yaml:2:13: resolution: expected a number");
        refuse("negate", "negate: .nan", "map.yaml:4:9: negate: .nan is no finite number");
        refuse(
            "negate",
            "negate: maybe",
            "negate: invalid value: string \"maybe\", expected 0 or 1",
        );
        refuse("negate", "\tnegate: 0", "map.yaml:4:");
        for line in [
            "image: [",
            "image: \"C:\\maps\"",
            "image: {a",
            "image: *none",
            "image: !!binary aGk=x",
            "image: ~",
            "image: [a, b]",
            "image: a: b",
            "<<: 3",
            "image: !include x.yaml",
            "%YAML 9",
            "image: &a [*a]",
        ] {
            let text = GOOD.replace("image: map.pgm", line);
            let Err(error) = load(&text) else { continue };
            for word in ["Option", "olicy", "from_str", "serde", "configured", "parser"] {
                assert!(!error.contains(word), "{line}: {error}");
            }
        }
    }

    #[test]
    fn integers_byte_order_marks_and_line_ends_of_windows_are_read() {
        let text = GOOD.replace("0.65", "1").replace("0.196", "0").replace("0.05", "1");
        let text = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        let description = load(&text).unwrap();
        assert_eq!((description.occupied, description.free), (1.0, 0.0));
        assert_eq!((description.resolution, description.image.as_str()), (1.0, "map.pgm"));
        let text = GOOD.replace("map.pgm", r"C:\maps\room.pgm");
        assert_eq!(load(&text).unwrap().image, r"C:\maps\room.pgm");
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
