//! Strategies in files: the present spelling, and those of earlier versions.

use covmap_plan::Strategy;

fn in_ron(text: &str) -> Result<Strategy, String> {
    let options =
        ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| error.to_string())
}

#[track_caller]
fn check(text: &str, expected: &str) {
    assert_eq!(in_ron(text).unwrap().to_string(), expected, "{text}");
}

#[test]
fn a_strategy_is_spelled_in_a_file_as_it_is_typed() {
    for text in ["CL", "IG", "IG_WIN:2.5", "IG_CL:0.3", "COUNT:7", "COUNT:50:2"] {
        check(&format!("{text:?}"), text);
        let json = serde_json::to_string(&text.parse::<Strategy>().unwrap()).unwrap();
        assert_eq!(json, format!("{text:?}"));
        assert_eq!(serde_json::from_str::<Strategy>(&json).unwrap().to_string(), text);
    }
}

#[test]
fn what_earlier_versions_wrote_is_read() {
    check("Cl", "CL");
    check("Ig", "IG");
    check("IgWin(radius: 2.0)", "IG_WIN:2");
    check("IgCl(alpha: 0.3)", "IG_CL:0.3");
    check("Count(times: 50.0, half_distance: 2.0)", "COUNT:50:2");
    check("Count(times: 50.0, half_distance: None)", "COUNT:50");
    let json = r#"{"IgCl":{"alpha":0.3}}"#;
    assert_eq!(serde_json::from_str::<Strategy>(json).unwrap().to_string(), "IG_CL:0.3");
}

#[test]
fn what_is_no_strategy_is_refused_with_the_names_of_all() {
    for (text, part) in [
        ("\"FBE\"", "IG_CL:ALPHA"),
        ("\"IG_CL:-1\"", "the weight α of IG_CL is -1"),
        ("IgCl(alpha: -1.0)", "the weight α of IG_CL is -1"),
        ("IgCl(beta: 0.3)", "\"IG_CL:ALPHA\""),
        ("IgCl", "IG_CL:ALPHA"),
        ("7", "\"IG_CL:ALPHA\""),
        ("(((", ""),
    ] {
        let error = in_ron(text).unwrap_err();
        assert!(error.contains(part), "{text}: {error}");
    }
}
