//! Draws a small office as a robot might know it: coverage, path, and remaining view-points.
//!
//! ```text
//! cargo run -p covmap-draw --example draw_a_map -- office.png
//! ```

use covmap::{Grid, Raster};
use covmap_draw::{Key, Marker, Picture, Rgb, coverage_color};
use nalgebra::Point2;
use std::process::ExitCode;

/// Returns the coverage of a cell around a point by walls and desks; `None` where the robot has not looked.
fn coverage(p: Point2<f64>) -> Option<f64> {
    let wall = |from: (f64, f64), to: (f64, f64)| {
        let (a, b) = (Point2::new(from.0, from.1), Point2::new(to.0, to.1));
        let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (1.3 - nalgebra::distance(&p, &(a + (b - a) * t)) / 0.1).clamp(0.0, 1.0)
    };
    let disc = |x: f64, y: f64, r: f64| {
        (0.5 + (r - nalgebra::distance(&p, &Point2::new(x, y))) / 0.1).clamp(0.0, 1.0)
    };
    let things = [
        wall((0.5, 0.5), (17.5, 0.5)),
        wall((0.5, 9.5), (17.5, 9.5)),
        wall((0.5, 0.5), (0.5, 9.5)),
        wall((17.5, 0.5), (17.5, 9.5)),
        wall((0.5, 4.0), (2.6, 4.0)),
        wall((3.8, 4.0), (9.0, 4.0)),
        wall((10.2, 4.0), (13.0, 4.0)),
        wall((6.3, 0.5), (6.3, 4.0)),
        wall((11.8, 0.5), (11.8, 4.0)),
        wall((12.5, 6.1), (15.4, 9.4)),
        disc(3.0, 1.9, 0.5),
        disc(8.6, 7.6, 0.35),
        disc(9.4, 1.7, 0.6),
    ];
    let seen = nalgebra::distance(&p, &Point2::new(8.0, 5.0)) < 7.6 || p.x < 9.0;
    let behind = p.x > 12.6 && p.y > 6.2 && p.y - 6.1 < (p.x - 12.5) * 1.1 && p.x > 13.0;
    let outside = !(0.3..=17.7).contains(&p.x) || !(0.3..=9.7).contains(&p.y);
    (seen && !outside && !behind).then(|| things.into_iter().fold(0.0, f64::max))
}

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("usage: draw_a_map FILE.png");
        return ExitCode::from(2);
    };
    let drawn = draw().and_then(|picture| Ok(picture.save(&path)?));
    match drawn {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn draw() -> Result<Picture, Box<dyn std::error::Error>> {
    let grid = Grid::new(Point2::origin(), 0.1, 180, 100)?;
    let map = Raster::from_fn(grid, |cell| coverage(grid.center(cell)));
    let driven = [
        (1.5, 6.5),
        (3.2, 5.2),
        (3.2, 3.0),
        (4.4, 2.4),
        (3.2, 3.2),
        (3.3, 5.2),
        (6.4, 6.2),
        (9.6, 5.1),
        (9.6, 3.4),
        (8.2, 2.6),
        (9.6, 3.5),
        (10.4, 5.4),
        (12.9, 5.2),
    ];
    let driven: Vec<Point2<f64>> = driven.map(|(x, y)| Point2::new(x, y)).to_vec();
    let (start, end) = (driven[0], driven[driven.len() - 1]);

    let mut picture = Picture::new(grid);
    picture
        .title("Office: most likely coverage")
        .subtitle("IG_CL:0.3, seed 1: 13 scans, 31.4 m driven, 84.7 % of the cells finished")
        .cells(&map, |coverage| coverage_color(*coverage))
        .polyline(&driven, Rgb::BLUE, 3.0);
    for point in &driven[1..driven.len() - 1] {
        picture.marker(*point, Marker::Disc, Rgb::BLUE, 8.0);
    }
    picture
        .marker(Point2::new(15.2, 2.6), Marker::Ring, Rgb::ORANGE, 18.0)
        .marker(Point2::new(15.2, 5.4), Marker::Cross, Rgb::RED, 16.0)
        .marker(start, Marker::Disc, Rgb::GREEN, 16.0)
        .marker(end, Marker::Arrow { heading: -0.2 }, Rgb::RED, 22.0)
        .label("start", start)
        .label("end", end)
        .label("next: 12.4 nats", Point2::new(15.2, 2.6))
        .label("stalled", Point2::new(15.2, 5.4))
        .scale_bar()
        .color_bar("coverage", 0.0, 1.0, |c| coverage_color(Some(c)))
        .legend(&[(Rgb::UNKNOWN, "unknown")])
        .key(Key::Line(Rgb::BLUE), "trajectory")
        .key(Key::Marker(Marker::Disc, Rgb::BLUE), "view-point")
        .key(Key::Marker(Marker::Ring, Rgb::ORANGE), "best candidate")
        .key(Key::Marker(Marker::Cross, Rgb::RED), "view-point given up");
    Ok(picture)
}
