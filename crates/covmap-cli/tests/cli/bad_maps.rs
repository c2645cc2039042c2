//! Invalid maps of map_server.

use crate::typed::Shell;

const YAML: &str = "image: map.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// Returns a free room of 20 × 20 cells.
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
    // Every sentence names the description and its image.
    let refuse = |image: Option<&[u8]>, expected: &str| {
        refuse(YAML, image, &["map.yaml: image: map.pgm: ", expected]);
    };
    refuse(None, "cannot be read");
    refuse(Some(b""), "is empty");
    refuse(Some(&image()[..300]), "need 400 bytes and there are 287");
    refuse(Some(&image()[..7]), "no valid maxval");
    let header = |header: &str| [header.as_bytes(), &[254; 400]].concat();
    refuse(Some(&header("P5\n21 20\n255\n")), "need 420 bytes and there are 400");
    refuse(Some(&header("P5\n99999999 99999999\n255\n")), "pixels are no map");
    refuse(Some(&header("P5\n0 20\n255\n")), "pixels are no map");
    refuse(Some(&header("P5\n20 20\n0\n")), "maxval of 0");
    refuse(Some(&header("P5\n20 20\n70000\n")), "maxval of 70000");
    refuse(Some(b"P2\n2 2\n255\n0 0 0\n"), "does not hold the numbers of 2 × 2 pixels");
    refuse(Some(b"\xff\xd8\xff\xe0 JFIF"), "is a JPEG image");
    refuse(Some(b"\x89PNG\r\n\x1a\n"), "the PNG image is damaged or ends early");
}

#[test]
fn descriptions_that_lie_are_refused() {
    let changed = |from: &str, to: &str| YAML.replace(from, to);
    let image = image();
    let image = Some(image.as_slice());
    refuse("", image, &["map.yaml"]);
    refuse("image: [", image, &["map.yaml"]);
    refuse(&changed("image: map.pgm\n", ""), image, &["map.yaml", "image"]);
    let none = &changed("image: map.pgm", "image: none.pgm");
    refuse(none, image, &["map.yaml: ", "none.pgm: cannot be read"]);
    let none = &changed("image: map.pgm", "image: /home/robot/none.pgm");
    refuse(none, image, &["map.yaml: ", "/home/robot/none.pgm", "not beside the YAML file either"]);
    for resolution in ["0", "-0.1", ".nan", ".inf", "wide"] {
        let yaml = changed("resolution: 0.1", &format!("resolution: {resolution}"));
        refuse(&yaml, image, &["map.yaml"]);
    }
    refuse(&changed("[0.0, 0.0, 0.0]", "[0.0, .nan, 0.0]"), image, &["map.yaml"]);
    refuse(&changed("[0.0, 0.0, 0.0]", "[0.0]"), image, &["map.yaml", "three numbers, not 1"]);
    refuse(&changed("[0.0, 0.0, 0.0]", "[0.0, 0.0, .nan]"), image, &["map.yaml", "yaw of NaN"]);
    refuse(
        &changed("negate: 0", "negate: 0\nnegate: 0"),
        image,
        &["map.yaml:5:1: the key `negate`"],
    );
    refuse(&changed("free_thresh: 0.196", "free_thresh: 0.9"), image, &["map.yaml"]);
}

#[test]
fn a_map_without_free_space_is_refused() {
    let all = |grey: u8| [b"P5\n20 20\n255\n".as_slice(), &[grey; 400]].concat();
    let black =
        "map.yaml: nothing of the map is free (0.00 m² free, 4.00 m² occupied, 0.00 m² unknown)";
    refuse(YAML, Some(&all(0)), &[black, "negate"]);
    refuse(YAML, Some(&all(205)), &["map.yaml: all of its 20 × 20 pixels are unknown"]);
    // One free cell makes a map, but has no room for a robot.
    let mut one = all(205);
    one[13 + 210] = 254;
    let shell = Shell::new();
    shell.write("map.yaml", YAML);
    shell.write("map.pgm", one);
    shell.refuse("explore map.yaml", &["map.yaml", "fits nowhere"]);
    let typed = shell.expect("truth map.yaml --out t.csv", 0);
    assert!(typed.out.contains("0.01 m² free, 0.00 m² occupied, 3.99 m² unknown"), "{typed:?}");
}
