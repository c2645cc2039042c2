//! Maps of map_server that are wrong.

use crate::typed::Shell;

const YAML: &str = "image: map.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// A free room of 20 × 20 cells.
fn image() -> Vec<u8> {
    [b"P5\n20 20\n255\n".as_slice(), &[254; 400]].concat()
}

#[track_caller]
fn refuse(yaml: &str, image: Option<&[u8]>, expected: &[&str]) {
    let shell = Shell::new();
    shell.write("map.yaml", yaml);
    if let Some(image) = image {
        shell.write("map.pgm", image);
    }
    for command in ["explore map.yaml", "truth map.yaml --out t.csv"] {
        shell.refuse(command, expected);
    }
}

#[test]
fn the_good_map_is_good() {
    let shell = Shell::new();
    shell.write("map.yaml", YAML);
    shell.write("map.pgm", image());
    shell.expect("explore map.yaml --max-scans 1 --resolution 0.2", 3);
}

#[test]
fn images_that_lie_are_refused() {
    refuse(YAML, None, &["map.pgm: cannot be read"]);
    refuse(YAML, Some(b""), &["map.pgm"]);
    refuse(YAML, Some(&image()[..300]), &["map.pgm"]);
    refuse(YAML, Some(&image()[..7]), &["map.pgm"]);
    let header = |header: &str| [header.as_bytes(), &[254; 400]].concat();
    refuse(YAML, Some(&header("P5\n21 20\n255\n")), &["map.pgm"]);
    refuse(YAML, Some(&header("P5\n99999999 99999999\n255\n")), &["map.pgm"]);
    refuse(YAML, Some(&header("P5\n0 20\n255\n")), &["map.pgm"]);
    refuse(YAML, Some(&header("P5\n20 20\n0\n")), &["map.pgm"]);
    refuse(YAML, Some(&header("P5\n20 20\n70000\n")), &["map.pgm"]);
    refuse(YAML, Some(b"P2\n2 2\n255\n0 0 0 0\n"), &["map.pgm", "P2"]);
}

#[test]
fn descriptions_that_lie_are_refused() {
    let changed = |from: &str, to: &str| YAML.replace(from, to);
    let image = image();
    let image = Some(image.as_slice());
    refuse("", image, &["map.yaml"]);
    refuse("image: [", image, &["map.yaml"]);
    refuse(&changed("image: map.pgm\n", ""), image, &["map.yaml", "image"]);
    refuse(&changed("image: map.pgm", "image: none.pgm"), image, &["none.pgm: cannot be read"]);
    for resolution in ["0", "-0.1", ".nan", ".inf", "wide"] {
        let yaml = changed("resolution: 0.1", &format!("resolution: {resolution}"));
        refuse(&yaml, image, &["map.yaml"]);
    }
    refuse(&changed("[0.0, 0.0, 0.0]", "[0.0, .nan, 0.0]"), image, &["map.yaml"]);
    refuse(&changed("[0.0, 0.0, 0.0]", "[0.0]"), image, &["map.yaml", "origin"]);
    refuse(&changed("free_thresh: 0.196", "free_thresh: 0.9"), image, &["map.yaml"]);
}

#[test]
fn a_map_without_free_space_is_refused() {
    let black = [b"P5\n20 20\n255\n".as_slice(), &[0; 400]].concat();
    let shell = Shell::new();
    shell.write("map.yaml", YAML);
    shell.write("map.pgm", black);
    shell.refuse("explore map.yaml", &["map.yaml", "fits nowhere"]);
}
