//! `survey`: the walls of a building, from the laser scans of a log.

use crate::about::about;
use crate::arguments::Survey as Arguments;
use crate::map_report::taken_from;
use crate::output;
use crate::terminal::say;
use anyhow::{Result, bail};
use covmap::{Grid, Raster};
use covmap_draw::{Marker, Picture, Rgb, coverage_color};
use covmap_io::{to_ron, write_file};
use covmap_lab::{Frames, frames};
use covmap_log::Sensor;
use covmap_sonar::{Range, SonarRing};
use covmap_survey::{EchoEvidence, Survey, SurveyParameters, survey};
use nalgebra::Point2;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The side of a picture's cell \[m\], and the largest number of cells along one side.
const PICTURE_CELL: f64 = 0.05;
const PICTURE_CELLS: f64 = 1200.0;

pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let Arguments { log, poses, out, force, quiet } = arguments;
    let image = picture_of(out)?;
    let inputs: Vec<&Path> =
        [Some(log), poses.as_ref()].into_iter().flatten().map(PathBuf::as_path).collect();
    let replace = output::replace(out, *force, &inputs)?;
    output::replace(&image, *force, &inputs)?;
    let found_in = frames(log, poses.as_deref(), Sensor::Laser, SonarRing::b21r())?;
    let parameters = SurveyParameters::indoor();
    let scans = || found_in.scans.iter().map(|(ring, scan)| (&**ring, scan));
    let found = survey(scans(), &parameters).map_err(about(log))?;
    let survey = found.survey;
    let Some([low, high]) = survey.bounds()? else {
        bail!("{}: its laser scans show no wall", log.display());
    };
    let comment = format!(
        "The walls and posts that the laser of {} saw: {} walls, {} posts, from {} scans.\n\
         Correct it by hand: a wall is solid from its front, `from` to `to`, away from the side\n\
         that it was seen from, as far as its thickness. Metres.",
        log.file_name().unwrap_or_default().to_string_lossy(),
        survey.walls.len(),
        survey.posts.len(),
        found.views
    );
    let size = high - low;
    let cell = PICTURE_CELL.max(size.max() / PICTURE_CELLS);
    let grid = Grid::covering(low, size, cell, 4).map_err(about(log))?;
    let evidence = survey.evidence(&grid, scans(), &parameters)?;
    let png = picture(&grid, &survey, &found_in, &evidence, &parameters, log)?.to_png();
    write_file(&image, &png.map_err(about(&image))?, replace)?;
    // The survey comes last: a survey corrected by hand is the most likely to be refused, and its
    // picture is then the same.
    write_file(out, to_ron(out, &survey, Some(&comment))?.as_bytes(), replace)?;
    if !quiet {
        say::line(format!("{} walls, {} posts", survey.walls.len(), survey.posts.len()));
        let account = &found_in.account;
        let lost = (!account.skipped.is_empty()).then(|| account.skipped.to_string());
        for line in taken_from(account).into_iter().chain(account.remarks()).chain(lost) {
            say::line(format!("  {line}"));
        }
        say::line(format!("  {}, {}", out.display(), image.display()));
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns the file of the picture beside a survey.
fn picture_of(out: &Path) -> Result<PathBuf> {
    let extension = out.extension().unwrap_or_default();
    if extension.eq_ignore_ascii_case("png") {
        bail!(
            "{}: --out names the survey, a .ron; its picture has the same name with .png",
            out.display()
        );
    }
    Ok(out.with_extension("png"))
}

/// Draws the picture for the review: the survey over the echoes of the laser.
fn picture(
    grid: &Grid,
    survey: &Survey,
    frames: &Frames,
    evidence: &Raster<EchoEvidence>,
    parameters: &SurveyParameters,
    log: &Path,
) -> Result<Picture> {
    let coverage = survey.coverage(grid)?;
    let both = Raster::from_fn(*grid, |cell| {
        (
            evidence.get(cell).copied().unwrap_or_default(),
            coverage.get(cell).copied().unwrap_or_default(),
        )
    });
    let mut picture = Picture::new(*grid);
    picture.cells(&both, |(evidence, covered)| {
        let base = coverage_color(Some(*covered)).mix(Rgb(255, 255, 255), 0.45);
        if evidence.is_seen(parameters) {
            base
        } else if evidence.unexplained > 0 {
            Rgb(240, 160, 150)
        } else {
            base.mix(Rgb(120, 160, 210), 0.5)
        }
    });
    for (ring, scan) in &frames.scans {
        for (beam, range) in ring.beams().iter().zip(&scan.ranges) {
            let Range::Echo(range) = *range else { continue };
            let at = scan.pose * beam.pose * Point2::new(range, 0.0);
            if grid.cell_at(at).is_some() {
                picture.polyline(&[at], Rgb(40, 120, 60), 1.6);
            }
        }
    }
    for wall in &survey.walls {
        let ends = [wall.from, wall.to].map(|(x, y)| Point2::new(x, y));
        picture.polyline(&ends, Rgb::RED, 2.0);
    }
    for post in &survey.posts {
        let center = Point2::new(post.center.0, post.center.1);
        picture.marker(center, Marker::Ring, Rgb::ORANGE, 10.0);
    }
    let path: Vec<Point2<f64>> =
        frames.scans.iter().map(|(_, scan)| scan.pose.translation.vector.into()).collect();
    picture.polyline(&path, Rgb::BLUE, 2.0);
    let name = log.file_name().unwrap_or_default().to_string_lossy();
    picture
        .title(&format!("{name}: {} walls, {} posts", survey.walls.len(), survey.posts.len()))
        .subtitle(
            "red: fronts; orange: posts; green: echoes; pink: unexplained, not scored; \
             light blue: not seen",
        )
        .scale_bar();
    Ok(picture)
}
