//! Worlds of any size: the shipped office, repeated.

use anyhow::Result;
use covmap_io::parse_ron;
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use std::path::Path;

const OFFICE: &str = include_str!("../../scenarios/office.ron");

/// The margin of a grid of .1 m around its world \[cells\].
const MARGIN: u32 = 3;

/// Returns the shipped office.
pub(crate) fn office(outside: Surface) -> Result<World> {
    Ok(World::from_scenario(&scenario()?, outside)?)
}

fn scenario() -> Result<Scenario> {
    Ok(parse_ron(Path::new("scenarios/office.ron"), OFFICE)?)
}

/// Returns offices side by side, without walls between them, cut off for a grid with a number of
/// cells of .1 m along a side.
pub(crate) fn offices(cells: u32, outside: Surface) -> Result<World> {
    let tile = scenario()?;
    let side = 0.1 * f64::from(cells - 2 * MARGIN);
    let (dx, dy) = (tile.extent.width, tile.extent.height);
    let along =
        |step: f64| (0u32..).map(move |i| f64::from(i) * step).take_while(move |s| *s < side);
    let corners = along(dy).flat_map(|y| along(dx).map(move |x| (x, y)));
    let obstacles = corners.flat_map(|by| tile.obstacles.iter().map(move |o| moved(o, by)));
    // An obstacle entirely outside is not part of this world.
    let obstacles = obstacles.filter(|o| starts_below(&o.shape, side)).collect();
    let extent = Extent { width: side, height: side };
    let scenario = Scenario { name: "offices".into(), extent, start: tile.start, obstacles };
    Ok(World::from_scenario(&scenario, outside)?)
}

fn moved(obstacle: &Obstacle, (dx, dy): (f64, f64)) -> Obstacle {
    let shape = obstacle.shape.moved(0.0, &|(x, y)| (x + dx, y + dy));
    Obstacle { shape, surface: obstacle.surface }
}

/// Returns whether a part of a shape may lie left of and below a line.
fn starts_below(shape: &Shape, side: f64) -> bool {
    let points = match shape {
        Shape::Rectangle { center: (x, y), size: (w, h), .. } => vec![(x - w - h, y - w - h)],
        Shape::Polygon(points) => points.clone(),
        Shape::Wall { from, to, .. } => vec![*from, *to],
        Shape::Circle { center: (x, y), radius } => vec![(x - radius, y - radius)],
    };
    let least = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).fold(f64::INFINITY, f64::min);
    least(|p| p.0) < side && least(|p| p.1) < side
}
