//! Figures that are maps: pictures, and drawings that embed them.

use crate::error::Result;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use covmap_campaign::{NamedWorld, Paths};
use covmap_draw::FigureFolder;
use covmap_draw::{Key, Marker, Picture, Rgb, coverage_color};
use covmap_io::read_ron;
use covmap_lab::{files, results::mark_cut_short};
use covmap_world::{Surface, World};
use nalgebra::Point2;

const PATH_WIDTH: f64 = 2.0;
const SCAN_SIZE: f64 = 5.0;
const START_SIZE: f64 = 16.0;
/// The side of the cells of the truth behind a path \[m\].
const SIDE: f64 = 0.05;

/// A driven path with its title.
#[derive(Debug, Clone)]
pub(crate) struct Trajectory {
    pub title: String,
    pub subtitle: String,
    pub paths: Paths,
    /// Whether the run ended before its world was explored.
    pub cut_short: bool,
}

/// Draws a path in its world.
pub(crate) fn write_trajectory(
    output: &FigureFolder,
    name: &str,
    world: &NamedWorld,
    trajectory: &Trajectory,
) -> Result<()> {
    let world = self::world(world)?;
    let coverage = world.coverage(&world.grid(SIDE)?);
    let points = |list: &[(f64, f64)]| -> Vec<Point2<f64>> {
        list.iter().map(|(x, y)| Point2::new(*x, *y)).collect()
    };
    let (driven, scans) = (points(&trajectory.paths.driven), points(&trajectory.paths.scans));
    let mut picture = Picture::new(*coverage.grid());
    let cut_short = if trajectory.cut_short { "; cut short, and not the whole path" } else { "" };
    picture
        .title(&trajectory.title)
        .subtitle(&format!("{}{cut_short}", trajectory.subtitle))
        .scale_bar()
        .cells(&coverage, |coverage| coverage_color(Some(*coverage)))
        .polyline(&driven, Rgb::BLUE, PATH_WIDTH)
        .key(Key::Line(Rgb::BLUE), "trajectory")
        .key(Key::Marker(Marker::Disc, Rgb::ORANGE), "measurement")
        .key(Key::Marker(Marker::Disc, Rgb::GREEN), "start");
    for scan in &scans {
        picture.marker(*scan, Marker::Disc, Rgb::ORANGE, SCAN_SIZE);
    }
    if let Some(start) = driven.first() {
        picture.marker(*start, Marker::Disc, Rgb::GREEN, START_SIZE);
    }
    if let Some(end) = driven.last().filter(|_| trajectory.cut_short) {
        mark_cut_short(&mut picture, *end);
    }
    write_picture(output, name, &picture)
}

/// Returns the world of a campaign.
pub(crate) fn world(named: &NamedWorld) -> Result<World> {
    // Coverage does not depend on the answer of a surface.
    if named.file.extension().is_some_and(|extension| extension == "ron") {
        let scenario = read_ron(&named.file)?;
        let (turn, shift) = (named.turn.to_radians(), named.shift);
        return Ok(files::moved(&scenario, turn, shift, (&named.file, Surface::Rough))?);
    }
    Ok(files::world(&named.file, Surface::Rough)?)
}

/// Writes a picture as `NAME.png`, and embedded in a drawing, `NAME.svg`.
pub(crate) fn write_picture(output: &FigureFolder, name: &str, picture: &Picture) -> Result<()> {
    let png = output.image(name, picture.to_png())?;
    Ok(output.write(&format!("{name}.svg"), holding(&png))?)
}

/// Returns a drawing of the size of a PNG that embeds it.
fn holding(png: &[u8]) -> String {
    // Width and height stand at fixed places in the header of every PNG.
    let side = |at: usize| {
        let bytes = png.get(at..at + 4).and_then(|b| b.try_into().ok()).unwrap_or([0; 4]);
        u32::from_be_bytes(bytes)
    };
    let (width, height) = (side(16), side(20));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{}\" height=\"{}\">\
         <image width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{}\"/></svg>\n",
        width / 2,
        height / 2,
        STANDARD.encode(png)
    )
}
