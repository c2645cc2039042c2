//! Promises of pictures.

use super::*;

fn some_grid(width: usize, height: usize) -> Grid {
    Grid::new(Point2::new(-3.0, 2.0), 0.1, width, height).unwrap()
}

/// Returns the colour of a pixel.
fn at((width, _, pixels): &(u32, u32, Vec<u8>), x: usize, y: usize) -> Rgb {
    let start = (y * *width as usize + x) * 3;
    Rgb(pixels[start], pixels[start + 1], pixels[start + 2])
}

#[test]
fn the_map_of_a_picture_is_neither_tiny_nor_huge() {
    for (columns, rows) in [(1, 1), (30, 20), (204, 124), (300, 300), (576, 544), (1100, 40)] {
        let (width, _, _) = Picture::new(some_grid(columns, rows)).pixels();
        assert!((900..=1500).contains(&width), "{columns} columns make {width} pixels");
    }
    for (columns, rows) in [(20_000, 1000), (4000, 5000), (1, 3_000_000), (20, 400), (1401, 9)] {
        let (width, height, pixels) = Picture::new(some_grid(columns, rows)).pixels();
        assert!(width <= 4000 && height <= 4000, "{width} × {height}");
        assert_eq!(pixels.len(), width as usize * height as usize * 3);
    }
    for pixels_per_cell in [0, 3, 1_000_000] {
        let mut picture = Picture::new(some_grid(500, 4000));
        let (width, height, _) = picture.pixels_per_cell(pixels_per_cell).pixels();
        assert!(width <= 4000 && height <= 4000, "{width} × {height}");
    }
}

#[test]
fn the_first_row_of_cells_is_at_the_bottom() {
    let grid = some_grid(2, 2);
    let colors = vec![Rgb::RED, Rgb::GREEN, Rgb::BLUE, Rgb::BLACK];
    let raster = Raster::from_values(grid, colors).unwrap();
    let image = Picture::new(grid).pixels_per_cell(300).cells(&raster, |c| *c).pixels();
    let margin = 32;
    let center = |x: usize, y: usize| at(&image, margin + 150 + 300 * x, margin + 150 + 300 * y);
    assert_eq!([center(0, 0), center(1, 0)], [Rgb::BLUE, Rgb::BLACK]);
    assert_eq!([center(0, 1), center(1, 1)], [Rgb::RED, Rgb::GREEN]);
}

#[test]
fn a_line_lies_where_its_points_are_in_the_world() {
    let mut picture = Picture::new(some_grid(10, 10));
    let line = [Point2::new(-3.0, 2.25), Point2::new(-2.0, 2.25)];
    let image = picture.pixels_per_cell(100).polyline(&line, Rgb::RED, 4.0).pixels();
    assert_eq!(at(&image, 32 + 500, 32 + 750), Rgb::RED);
    assert_eq!(at(&image, 32 + 500, 32 + 740), Rgb::WHITE);
    assert_eq!(at(&image, 20, 32 + 750), Rgb::WHITE, "the line ends with the map");
}

#[test]
fn a_raster_of_another_grid_colours_the_cells_that_it_covers() {
    let mut picture = Picture::new(some_grid(2, 1));
    let coarse = Grid::new(Point2::new(-2.95, 1.0), 5.0, 1, 1).unwrap();
    let raster = Raster::filled(coarse, ());
    picture.cells(&raster, |()| Rgb::BLACK);
    assert_eq!(picture.colors, [Rgb::BLACK, Rgb::BLACK]);
    picture.overlay(&raster, 0.5, |()| Some(Rgb::WHITE));
    assert_eq!(picture.colors[0], Rgb(128, 128, 128));
    let elsewhere = Raster::filled(some_grid(1, 1), ());
    picture.overlay(&elsewhere, 1.0, |()| Some(Rgb::RED));
    assert_eq!(picture.colors, [Rgb::RED, Rgb(128, 128, 128)]);
}

#[test]
fn what_is_not_finite_or_far_away_is_not_drawn() {
    let grid = some_grid(6, 6);
    let blank = Picture::new(grid).pixels();
    let far = [f64::NAN, f64::INFINITY, -1e300, 1e12];
    let mut picture = Picture::new(grid);
    for value in far {
        let point = Point2::new(value, value);
        picture
            .polyline(&[point, point], Rgb::RED, 3.0)
            .polyline(&[point], Rgb::RED, value)
            .marker(point, Marker::Cross, Rgb::RED, 12.0)
            .marker(point, Marker::Arrow { heading: value }, Rgb::RED, value)
            .label("far", point);
    }
    assert!(picture.pixels() == blank);
    picture
        .marker(Point2::new(-2.8, 2.2), Marker::Arrow { heading: f64::NAN }, Rgb::RED, f64::NAN)
        .marker(Point2::new(-2.8, 2.2), Marker::Disc, Rgb::RED, -7.0)
        .color_bar("nothing", f64::NAN, 1.0, |_| Rgb::RED)
        .pixels();
}

#[test]
fn a_saved_picture_is_a_png_of_its_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.png");
    let mut picture = Picture::new(some_grid(30, 20));
    picture.title("A map").scale_bar().legend(&[(Rgb::UNKNOWN, "unknown")]);
    picture.save(&path).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert!((info.width, info.height, bytes) == picture.pixels());
    let error = picture.save(folder.path().join("none/map.png")).unwrap_err().to_string();
    assert!(error.contains("none/map.png: cannot be written"), "{error}");
}

#[test]
fn a_long_legend_is_wrapped_and_makes_the_picture_higher() {
    let mut picture = Picture::new(some_grid(60, 20));
    let (width, low, _) = picture.pixels();
    for _ in 0..30 {
        picture.key(Key::Line(Rgb::BLUE), "one of many entries");
    }
    let (same, high, pixels) = picture.pixels();
    assert_eq!(width, same);
    assert!(high > low + 90);
    let right = (0..high as usize)
        .flat_map(|y| &pixels[(y * width as usize + width as usize - 31) * 3..][..90]);
    assert!(right.into_iter().all(|byte| *byte == 255), "nothing runs into the margin");
}

#[test]
fn a_line_of_no_width_that_is_a_number_is_not_seen() {
    let plain = Picture::new(some_grid(30, 20)).pixels();
    let points = [Point2::new(0.1, 0.1), Point2::new(1.0, 1.0)];
    for width in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        let mut picture = Picture::new(some_grid(30, 20));
        picture.polyline(&points, Rgb::BLUE, width);
        assert!(picture.pixels() == plain, "{width}");
    }
    for width in [1e300, f64::INFINITY] {
        let mut picture = Picture::new(some_grid(30, 20));
        picture.polyline(&points, Rgb::BLUE, width);
        assert!(picture.pixels() != plain, "{width}");
    }
}
