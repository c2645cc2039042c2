//! Maps of ROS, written here byte by byte.
#![allow(clippy::float_cmp, reason = "tests compare exact values")]

use super::*;
use covmap::Cell;
use nalgebra::Point2;
use png::{BitDepth, ColorType};
use proptest::prelude::*;

const YAML: &str = "image: sub/map.pgm\nresolution: 0.5\norigin: [-1, 2, 0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// Loads a map whose image has these bytes, and whose description has these lines in place of its own.
fn load(image: &[u8], lines: &str) -> Result<MapServerMap, String> {
    let key = |line: &str| line.split(':').next().unwrap_or_default().to_owned();
    let instead: Vec<String> = lines.lines().map(key).collect();
    let rest = YAML.lines().filter(|line| !instead.contains(&key(line)));
    let text: Vec<&str> = rest.chain(lines.lines()).collect();
    let folder = tempfile::tempdir().unwrap();
    let yaml = folder.path().join("map.yaml");
    std::fs::write(&yaml, text.join("\n")).unwrap();
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::write(folder.path().join("sub/map.pgm"), image).unwrap();
    load_map_server(&yaml).map_err(|error| error.to_string())
}

/// Returns the map as a picture, the top row first: `.` free, `#` occupied, `?` unknown, and a
/// digit for tenths in between.
fn picture(map: &MapServerMap) -> String {
    let show = |cell: &MapCell| match cell {
        MapCell::Unknown => '?',
        MapCell::Occupancy(0.0) => '.',
        MapCell::Occupancy(1.0) => '#',
        MapCell::Occupancy(p) => (p * 10.0).floor().to_string().chars().next().unwrap(),
    };
    let rows = map.cells.values().chunks(map.grid.width()).rev();
    let rows: Vec<String> = rows.map(|row| row.iter().map(show).collect()).collect();
    rows.join("/")
}

#[track_caller]
fn check(image: &[u8], lines: &str, expected: &str) {
    assert_eq!(picture(&load(image, lines).unwrap()), expected);
}

#[track_caller]
fn refuse(image: &[u8], lines: &str, expected: &str) {
    let error = load(image, lines).unwrap_err();
    assert!(error.contains("map.yaml: ") && error.contains(expected), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
}

/// Returns a PNG image, with a palette and its transparency.
fn png_file(
    (width, height): (u32, u32),
    (color, depth): (ColorType, BitDepth),
    (palette, transparent): (&[u8], &[u8]),
    samples: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if !palette.is_empty() {
        encoder.set_palette(palette.to_vec());
    }
    if !transparent.is_empty() {
        encoder.set_trns(transparent.to_vec());
    }
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    bytes
}

/// Returns a grey image of 8 bits in PGM.
fn grey(width: usize, samples: &[u8]) -> Vec<u8> {
    crate::pgm::pgm_bytes(width, samples.len() / width, "", samples)
}

const IMAGE: &[u8] = b"P5\n4 2\n255\n\x00\xcd\xfe\xff\x80\x59\x5a\xce";

#[test]
fn trinary_takes_what_is_between_the_thresholds_as_unknown() {
    check(IMAGE, "", "#?../?#?.");
    check(IMAGE, "negate: 1\nmode: trinary", ".###/??\u{3f}#");
}

#[test]
fn scale_grades_what_is_between_the_thresholds() {
    check(IMAGE, "mode: scale", "#0../6#9.");
}

#[test]
fn raw_is_a_percentage_and_above_100_unknown() {
    check(b"P5 6 1 255 \x00\x64\x65\xff\x1e\x00", "mode: raw", ".#??3.");
    check(b"P5 6 1 255 \xff\x9b\x9a\x00\xe1\xff", "negate: 1\nmode: RAW", ".#??3.");
}

#[test]
fn thresholds_that_are_met_exactly_decide() {
    // p = (255 − x)/255: .6 for 102, .2 for 204, and one grey beyond each.
    let image = grey(4, &[102, 103, 203, 204]);
    for mode in ["trinary", "Scale"] {
        let lines = format!("occupied_thresh: 0.6\nfree_thresh: 0.2\nmode: {mode}");
        let between = if mode == "trinary" { "??" } else { "90" };
        check(&image, &lines, &format!("#{between}."));
    }
    check(&image, "occupied_thresh: 0.2\nfree_thresh: 0.2", "###\u{23}");
    check(&grey(3, &[0, 128, 255]), "occupied_thresh: 1\nfree_thresh: 0", "#?.");
    check(&grey(3, &[0, 128, 255]), "occupied_thresh: 0\nfree_thresh: 0", "###");
}

#[test]
fn other_largest_samples_mean_the_same() {
    check(b"P5 3 1 1 \x00\x01\x00", "", "#.#");
    check(b"P5 3 1 65535 \x00\x00\xcd\xcd\xff\xff", "", "#?.");
    check(b"P5 4 1 100 \x00\x50\x51\x64", "", "#?..");
    check(b"P2 # text\n4 1 100\n0 80 81 100", "", "#?..");
}

#[test]
fn a_png_image_may_be_of_any_kind() {
    let none: (&[u8], &[u8]) = (&[], &[]);
    let kinds = [
        (ColorType::Grayscale, BitDepth::Eight, vec![0, 205, 254, 255]),
        (ColorType::Grayscale, BitDepth::Sixteen, vec![0, 0, 205, 205, 254, 254, 255, 255]),
        (
            ColorType::Rgb,
            BitDepth::Eight,
            vec![0, 0, 0, 205, 205, 205, 253, 254, 255, 255, 255, 255],
        ),
        (ColorType::Grayscale, BitDepth::Four, vec![0x0c, 0xef]),
        (ColorType::Grayscale, BitDepth::Two, vec![0b00_10_11_11]),
        (ColorType::GrayscaleAlpha, BitDepth::Eight, vec![0, 255, 254, 254, 254, 255, 255, 255]),
        (
            ColorType::Rgba,
            BitDepth::Eight,
            [[0, 0, 0, 255], [0, 0, 0, 0], [254; 4], [255; 4]].concat(),
        ),
    ];
    for (color, depth, samples) in kinds {
        let expected = if color == ColorType::Rgba { "#??." } else { "#?.." };
        check(&png_file((4, 1), (color, depth), none, &samples), "", expected);
    }
    // One bit a pixel, from the highest: 0, 1, 1, 0.
    let bits = png_file((4, 1), (ColorType::Grayscale, BitDepth::One), none, &[0b0110_0000]);
    check(&bits, "", "#..#");
    check(&bits, "negate: 1", ".##.");
    check(&png_file((1, 2), (ColorType::Grayscale, BitDepth::Eight), none, &[0, 255]), "", "#/.");
}

#[test]
fn a_palette_and_a_transparent_colour_are_read() {
    let palette = [0, 0, 0, 254, 254, 254, 205, 205, 205, 255, 0, 0];
    let indexed = (ColorType::Indexed, BitDepth::Two);
    // 0, 1, 2, 3, 1: red is a third as white as white.
    let samples = [0b00_01_10_11, 0b01_00_00_00];
    check(&png_file((5, 1), indexed, (&palette, &[]), &samples), "", "#.?#.");
    check(&png_file((5, 1), indexed, (&palette, &[0, 255]), &samples), "", ".?#.");
    // Grey 254 is transparent: the last pixels are cut away with it.
    let transparent = (ColorType::Grayscale, BitDepth::Eight);
    check(&png_file((4, 1), transparent, (&[], &[0, 254]), &[0, 255, 254, 254]), "", "#.");
}

#[test]
fn the_last_row_of_the_image_is_the_lowest_of_the_map() {
    let map = load(IMAGE, "").unwrap();
    assert_eq!(map.grid.lower_left(), Point2::new(-1.0, 2.0));
    assert_eq!((map.grid.resolution(), map.grid.width(), map.grid.height()), (0.5, 4, 2));
    assert_eq!(map.cells.get(Cell::new(1, 0)), Some(&MapCell::Occupancy(1.0)));
    assert_eq!(map.cells.get(Cell::new(0, 1)), Some(&MapCell::Occupancy(1.0)));
}

#[test]
fn occupied_and_unknown_cells_are_solid() {
    let solid = load(IMAGE, "").unwrap().solid();
    assert_eq!(solid.values(), [true, true, true, false, true, true, false, false]);
}

#[test]
fn what_is_unknown_around_the_known_is_cut_away() {
    let mut samples = [205; 7 * 5];
    // Columns 2 to 4 and rows 1 to 3 of the image.
    for (column, row, sample) in [(2, 1, 0), (4, 2, 254), (3, 3, 0)] {
        samples[row * 7 + column] = sample;
    }
    let map = load(&grey(7, &samples), "").unwrap();
    assert_eq!(picture(&map), "#??/??./?#?");
    assert_eq!(map.grid.lower_left(), Point2::new(0.0, 2.5));
    assert_eq!(map.image_size, (7, 5));
    let areas = MapAreas { free: 0.25, occupied: 0.5, unknown: 8.0, unknown_grey_is_free: 0.0 };
    assert_eq!(map.areas, areas);
    let one = load(&grey(7, &[&[205; 20][..], &[254], &[205; 14]].concat()), "").unwrap();
    assert_eq!((picture(&one).as_str(), one.grid.lower_left()), (".", Point2::new(2.0, 3.0)));
}

#[test]
fn a_map_of_which_nothing_is_known_is_refused() {
    refuse(&grey(3, &[205; 6]), "", "all of its 3 × 2 pixels are unknown");
    refuse(&grey(3, &[101; 6]), "mode: raw", "all of its 3 × 2 pixels are unknown");
}

#[test]
fn unknown_grey_that_the_thresholds_make_free_is_measured() {
    let image = grey(4, &[205, 205, 254, 0]);
    let free = |lines| load(&image, lines).unwrap().areas.unknown_grey_is_free;
    assert_eq!(free(""), 0.0);
    assert_eq!(free("free_thresh: 0.25"), 0.5);
    assert_eq!(free("mode: scale"), 0.5);
    assert_eq!(free("mode: raw"), 0.0);
    // With black and white exchanged, unknown is 50.
    let image = grey(4, &[50, 50, 1, 255]);
    assert_eq!(load(&image, "negate: 1").unwrap().areas.unknown_grey_is_free, 0.0);
    let negated = load(&image, "negate: 1\nfree_thresh: 0.25").unwrap();
    assert_eq!(negated.areas.unknown_grey_is_free, 0.5);
    let wide = b"P5 2 1 65535 \xcd\xcd\x00\x00";
    assert_eq!(load(wide, "free_thresh: 0.2").unwrap().areas.unknown_grey_is_free, 0.25);
}

/// Returns the cells, the lower left corner of the grid, and the pose of the map turned by a yaw.
fn turned(yaw: &str) -> (String, Point2<f64>, Isometry2<f64>) {
    let map = load(IMAGE, &format!("origin: [-1, 2, {yaw}]")).unwrap();
    (picture(&map), map.grid.lower_left(), map.world_from_map)
}

#[test]
fn a_yaw_of_quarter_turns_moves_cells() {
    let corner = Point2::new(-1.0, 2.0);
    // 4 × 2 cells of .5 m about the corner: "#?../?#?." to the left, upside down, to the right.
    let (left, back, right) = ("../.?/?#/#?", ".?#?/..?#", "?#/#?/?./..");
    for (yaws, expected, low) in [
        (["0", "-0.0", "6.2831853", "6.2831", "6.28", "-12.566", "1e-9"], "#?../?#?.", (0.0, 0.0)),
        (["1.5707963", "1.5708", "1.57", "-4.7124", "7.854", "1.571", "1.5708"], left, (-1.0, 0.0)),
        (["3.1415927", "3.14159", "3.1416", "-3.14", "9.42", "3.142", "3.14"], back, (-2.0, -1.0)),
        (
            ["-1.5707963", "-1.5708", "4.712", "-1.57", "4.71", "4.7124", "-7.854"],
            right,
            (0.0, -2.0),
        ),
    ] {
        for yaw in yaws {
            let (picture, lower_left, pose) = turned(yaw);
            assert_eq!((picture.as_str(), pose), (expected, Isometry2::identity()), "{yaw}");
            assert_eq!(lower_left, corner + Vector2::new(low.0, low.1), "{yaw}");
        }
    }
}

#[test]
fn any_other_yaw_turns_the_map_about_its_origin() {
    for yaw in ["1", "-0.1", "0.1", "1.4", "100"] {
        let (picture, lower_left, pose) = turned(yaw);
        assert_eq!((picture.as_str(), lower_left), ("#?../?#?.", Point2::new(-1.0, 2.0)));
        assert!((pose * lower_left - lower_left).norm() < 1e-12, "the origin stays");
        let (sin, cos) = libm::sincos(yaw.parse().unwrap());
        let along = pose * Point2::new(1.0, 2.0) - Point2::new(-1.0 + 2.0 * cos, 2.0 + 2.0 * sin);
        assert!(along.norm() < 1e-12, "{yaw}");
    }
    // The same small angle is rounding for a small map, and a turn for a large one.
    let wide = [&[254], &[205; 998][..], &[254]].concat();
    let turn = |yaw: &str| load(&grey(1000, &wide), &format!("origin: [0, 0, {yaw}]")).unwrap();
    assert_eq!(turn("0.0002").world_from_map, Isometry2::identity());
    assert_eq!(turn("0.0003").world_from_map, Isometry2::rotation(0.0003));
}

#[test]
fn what_was_cut_away_moves_the_corner_of_a_turned_map() {
    let samples = [&[205; 9][..], &[254, 0, 205, 205, 205]].concat();
    let map = load(&grey(7, &samples), "origin: [-1, 2, 1.5708]").unwrap();
    // Columns 2 and 3 of the lowest row, from 1 to 2 m from the corner, now upwards.
    assert_eq!(picture(&map), "#/.");
    assert_eq!(map.grid.lower_left(), Point2::new(-1.5, 3.0));
}

/// Returns a folder with a description that names an image, and an image beside it.
fn beside(named: &str) -> (tempfile::TempDir, Result<MapServerMap, String>) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.pgm"), IMAGE).unwrap();
    let yaml = folder.path().join("map.yaml");
    std::fs::write(&yaml, YAML.replace("sub/map.pgm", named)).unwrap();
    let map = load_map_server(&yaml).map_err(|error| error.to_string());
    (folder, map)
}

#[test]
fn an_image_that_is_nowhere_else_is_looked_for_beside_its_description() {
    let foreign =
        ["/home/robot/maps/room.pgm", r"C:\maps\room.pgm", r"..\room.pgm", "maps/room.pgm"];
    for named in foreign {
        let (folder, map) = beside(named);
        let expected = Some(folder.path().join("room.pgm"));
        assert_eq!(map.unwrap().image_beside, expected, "{named}");
    }
    for named in ["room.pgm", "./room.pgm"] {
        assert_eq!(beside(named).1.unwrap().image_beside, None);
    }
    let error = beside("/home/robot/maps/hall.pgm").1.unwrap_err();
    assert!(
        error.contains("map.yaml: image: /home/robot/maps/hall.pgm: cannot be read"),
        "{error}"
    );
    assert!(error.ends_with("is not beside the YAML file either"), "{error}");
    let error = beside("hall.pgm").1.unwrap_err();
    assert!(error.contains("hall.pgm: cannot be read: No such file"), "{error}");
    assert!(!error.contains("beside"), "{error}");
}

#[test]
fn an_absolute_path_of_this_machine_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let (there, decoy) = (folder.path().join("there"), folder.path().join("map.pgm"));
    std::fs::create_dir(&there).unwrap();
    std::fs::write(there.join("map.pgm"), IMAGE).unwrap();
    std::fs::write(decoy, grey(1, &[0])).unwrap();
    let yaml = folder.path().join("map.yaml");
    let image = there.join("map.pgm");
    std::fs::write(&yaml, YAML.replace("sub/map.pgm", image.to_str().unwrap())).unwrap();
    let map = load_map_server(&yaml).unwrap();
    assert_eq!((map.grid.width(), map.image_beside), (4, None));
}

#[test]
fn a_bad_image_is_named_with_its_description() {
    refuse(b"", "", "sub/map.pgm: the image is empty");
    refuse(b"P6 1 1 255 abc", "", "sub/map.pgm: is a pixmap (PPM); the image of a map is PNG or");
    refuse(b"\xff\xd8\xff\xe0", "", "sub/map.pgm: is a JPEG image");
    refuse(b"GIF89a", "", "sub/map.pgm: is a GIF image");
    refuse(b"hello", "", "sub/map.pgm: is no image that is known here");
    refuse(b"P5 2 2 255 abc", "", "sub/map.pgm: the image ends early");
    let png = png_file((3, 2), (ColorType::Grayscale, BitDepth::Eight), (&[], &[]), &[9; 6]);
    for end in 0..png.len() - 12 {
        if let Err(error) = load(&png[..end], "") {
            assert!(error.contains("map.yaml: ") && error.contains("sub/map.pgm: "), "{error}");
        } else {
            panic!("{end} bytes of the image are one");
        }
    }
    let mut damaged = png.clone();
    damaged[45] ^= 0x55;
    refuse(&damaged, "", "sub/map.pgm: the PNG image is damaged or ends early");
}

#[test]
fn a_huge_image_is_refused_before_it_is_unpacked() {
    let mut huge = png_file((1, 1), (ColorType::Grayscale, BitDepth::Eight), (&[], &[]), &[9]);
    huge[16..24].copy_from_slice(&[0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff]);
    // The checksum of the header, which comes first.
    let mut crc = flate2::Crc::new();
    crc.update(&huge[12..29]);
    huge[29..33].copy_from_slice(&crc.sum().to_be_bytes());
    refuse(&huge, "", "65535 × 65535 pixels are no map");
    refuse(b"P5 8193 8192 255 ", "", "8193 × 8192 pixels are no map");
}

proptest! {
    #[test]
    fn every_occupancy_lies_in_its_range(
        sample in any::<u16>(), max_value in 1..=u16::MAX, negate in any::<bool>(),
        free in 0.0..=1.0f64, over in 0.0..=1.0f64, mode in 0..3usize,
    ) {
        let description = Description {
            image: String::new(),
            resolution: 1.0,
            lower_left: Point2::origin(),
            yaw: 0.0,
            negate,
            occupied: free + over * (1.0 - free),
            free,
            mode: [Mode::Trinary, Mode::Scale, Mode::Raw][mode],
        };
        let white = Some(sample.min(max_value).into());
        match Pixel::new(&description, white, max_value.into()).cell {
            MapCell::Unknown => prop_assert!(mode != 1),
            MapCell::Occupancy(p) => prop_assert!((0.0..=1.0).contains(&p)),
        }
    }

    #[test]
    fn damaged_png_images_never_panic(
        at in any::<prop::sample::Index>(), value in any::<u8>(), wide in any::<bool>(),
    ) {
        let depth = if wide { BitDepth::Sixteen } else { BitDepth::Eight };
        let samples = vec![100; if wide { 48 } else { 24 }];
        let mut png = png_file((3, 2), (ColorType::Rgba, depth), (&[], &[]), &samples);
        let at = at.index(png.len());
        png[at] = value;
        let _ = load(&png, "");
    }
}
