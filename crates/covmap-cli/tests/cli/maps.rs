//! Maps of map_server from real users.

use crate::typed::{Shell, Typed};

/// 4 × 3 m in cells of .1 m: free, with walls of one cell, and unknown around in a wide margin.
const WIDTH: usize = 60;
const HEIGHT: usize = 50;

fn grey(x: usize, y: usize) -> u8 {
    match (x, y) {
        (10..50, 10..40) if x == 10 || x == 49 || y == 10 || y == 39 => 0,
        (10..50, 10..40) => 254,
        _ => 205,
    }
}

fn image() -> Vec<u8> {
    let mut image = format!("P5\n{WIDTH} {HEIGHT}\n255\n").into_bytes();
    image.extend((0..WIDTH * HEIGHT).map(|i| grey(i % WIDTH, i / WIDTH)));
    image
}

/// Returns the same image as text.
fn text_image() -> String {
    let numbers: Vec<String> =
        (0..WIDTH * HEIGHT).map(|i| grey(i % WIDTH, i / WIDTH).to_string()).collect();
    format!("P2\n{WIDTH} {HEIGHT} # a room\n255\n{}\n", numbers.join("\n"))
}

const YAML: &str = "image: map.pgm\nresolution: 0.1\norigin: [-3.0, -2.5, 0.0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// Runs `truth` on the room with another line in its description, and returns its output and its
/// table.
fn truth(image: &[u8], from: &str, to: &str) -> (Typed, Vec<[f64; 3]>) {
    let shell = Shell::new();
    shell.write("map.yaml", YAML.replace(from, to));
    shell.write("map.pgm", image);
    let typed = shell.expect("truth map.yaml --out t.csv", 0);
    let table = std::fs::read_to_string(shell.path("t.csv")).unwrap();
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        [numbers[0], numbers[1], numbers[2]]
    };
    (typed, table.lines().skip(1).map(row).collect())
}

fn free_area(table: &[[f64; 3]]) -> f64 {
    table.iter().map(|[_, _, coverage]| (1.0 - coverage) * 0.01).sum()
}

#[test]
fn unknown_margins_cost_nothing_and_areas_are_said() {
    let (typed, table) = truth(&image(), "", "");
    let said = "map.yaml: 10.64 m² free, 1.36 m² occupied, 18.00 m² unknown; all that is known \
                lies in 40 × 30 of its 60 × 50 cells";
    assert!(typed.out.contains(said), "{typed:?}");
    assert_eq!(typed.err, "");
    // There are three more cells on each side, as around any world.
    assert!(typed.out.contains("t.csv: 46 × 36 cells"), "{typed:?}");
    assert!((free_area(&table) - 10.64).abs() < 1e-9);
    // The room lies where the file says: free from −1.9 to 1.9 and from −1.4 to 1.4.
    let inside = |[x, y, _]: &[f64; 3]| x.abs() < 1.9 && y.abs() < 1.4;
    assert!(table.iter().all(|row| inside(row) == (row[2] < 0.5)));
}

#[test]
fn the_same_map_in_other_words_is_the_same_world() {
    let (_, expected) = truth(&image(), "", "");
    let same = |image: &[u8], from: &str, to: &str| {
        let (typed, table) = truth(image, from, to);
        assert_eq!(table, expected, "{to}");
        assert_eq!(typed.err, "", "{to}");
    };
    same(text_image().as_bytes(), "", "");
    same(&image(), "negate: 0", "negate: false\nmode: Trinary");
    for yaw in ["6.283185", "6.2832", "-0.0", "1e-7", "-6.2831853"] {
        same(&image(), "-2.5, 0.0]", &format!("-2.5, {yaw}]"));
    }
    let header = format!("P5\n{WIDTH} {HEIGHT}\n255\n");
    let crlf = [header.replace('\n', "\r\n").as_bytes(), &image()[header.len()..]].concat();
    same(&crlf, "", "");
}

#[test]
fn a_yaw_turns_the_world_about_the_origin() {
    // A quarter turn to the left about (−3, −2.5): the room's centre goes from (0, 0), which
    // is (3, 2.5) away, to (−3 − 2.5, −2.5 + 3).
    let (_, table) = truth(&image(), "-2.5, 0.0]", "-2.5, 1.5708]");
    let inside = |[x, y, _]: &[f64; 3]| (x + 5.5).abs() < 1.4 && (y - 0.5).abs() < 1.9;
    assert!(table.iter().all(|row| inside(row) == (row[2] < 0.5)));
    assert!((free_area(&table) - 10.64).abs() < 1e-9);
    // By 30°: the centre is 3 cos 30° − 2.5 sin 30° = 1.348 and 3 sin 30° + 2.5 cos 30° =
    // 3.665 from the origin.
    let (typed, table) = truth(&image(), "-2.5, 0.0]", "-2.5, 0.5235988]");
    assert!(typed.out.contains("turned by 30.0000°"), "{typed:?}");
    assert!((free_area(&table) - 10.64).abs() < 1e-6);
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    for [x, y, coverage] in table {
        let (dx, dy) = (x + 1.651_924, y - 1.165_064);
        let (along, across) = ((dx * cos + dy * sin).abs(), (dy * cos - dx * sin).abs());
        if along < 1.8 && across < 1.3 {
            assert!(coverage < 1e-9, "({x}, {y}) is {coverage}");
        }
        if along > 2.0 || across > 1.5 {
            assert!(coverage > 1.0 - 1e-9, "({x}, {y}) is {coverage}");
        }
    }
}

#[test]
fn what_the_owner_may_not_know_is_said() {
    let (typed, _) = truth(&image(), "free_thresh: 0.196", "free_thresh: 0.25");
    assert!(typed.err.starts_with("note: map.yaml: "), "{typed:?}");
    assert!(typed.err.contains("(205) free: 18.00 m²"), "{typed:?}");
    assert!(typed.out.contains("28.64 m² free, 1.36 m² occupied, 0.00 m² unknown"), "{typed:?}");
    for elsewhere in ["/home/robot/maps/map.pgm", r"C:\robot\map.pgm"] {
        let (typed, _) = truth(&image(), "image: map.pgm", &format!("image: {elsewhere}"));
        let said = "map.yaml: its image is not where it says; map.pgm is read instead";
        assert!(typed.err.contains(said), "{typed:?}");
    }
}

#[test]
fn a_room_in_a_huge_image_is_explored_as_a_room() {
    let shell = Shell::new();
    let side = 4000;
    let mut image = format!("P5\n{side} {side}\n255\n").into_bytes();
    let room = |x: usize, y: usize| (1000..1160).contains(&x) && (3000..3120).contains(&y);
    image.extend((0..side * side).map(|i| if room(i % side, i / side) { 254 } else { 205 }));
    shell.write("map.pgm", image);
    shell.write("map.yaml", YAML.replace("resolution: 0.1", "resolution: 0.05"));
    let typed = shell.expect("explore map.yaml --resolution 0.2 --max-scans 1 --out run", 3);
    let said = "48.00 m² free, 0.00 m² occupied, 39952.00 m² unknown; all that is known lies in \
                160 × 120 of its 4000 × 4000 cells";
    assert!(typed.out.contains(said), "{typed:?}");
    // 40 × 30 cells, and two more on each side.
    let summary = shell.json("run/summary.json");
    let counts = summary["cells"].as_object().unwrap().values();
    assert_eq!(counts.map(|count| count.as_u64().unwrap()).sum::<u64>(), 44 * 34);
}

#[test]
fn quiet_is_quiet_about_maps() {
    let shell = Shell::new();
    shell.write("map.pgm", image());
    shell.write("map.yaml", YAML.replace("0.196", "0.25"));
    let typed = shell.expect("explore map.yaml --max-scans 1 --quiet --out run", 3);
    assert_eq!((typed.out.as_str(), typed.err.as_str()), ("", ""));
}
