//! Turned and shifted worlds: the same geometry, cut by the grid in another way.

use crate::{Extent, Obstacle, Scenario, Shape, Start, Surface};
use nalgebra::{Point2, Rotation2, Vector2};

impl Scenario {
    /// Returns the scenario turned by `angle` \[rad\], counter-clockwise, and shifted by `shift`
    /// ≥ 0 \[m\].
    ///
    /// The extent becomes the bounding box of the turned one, larger by the shift at its left and
    /// lower border. Everything outside of the turned extent is solid, and rough. The name states
    /// the angle.
    #[must_use]
    pub fn moved(&self, angle: f64, shift: Vector2<f64>) -> Self {
        let Extent { width, height } = self.extent;
        let turn = Rotation2::new(angle);
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        let turned = corners.map(|(x, y)| turn * Point2::new(x, y));
        let low = turned.iter().fold(turned[0], |low, corner| low.inf(corner));
        let place = |point: (f64, f64)| turn * Point2::new(point.0, point.1) - low.coords + shift;
        let pair = |point| {
            let placed = place(point);
            (placed.x, placed.y)
        };
        let high = corners.map(place).into_iter().fold(Point2::origin(), |high, c| high.sup(&c));
        let obstacles = self.obstacles.iter().map(|obstacle| Obstacle {
            shape: obstacle.shape.moved(angle, &pair),
            surface: obstacle.surface,
        });
        let start = self.start.map(|start| {
            let (x, y) = pair((start.x, start.y));
            Start { x, y, heading: start.heading + angle }
        });
        Self {
            name: format!("{} turned {:.1}°", self.name, angle.to_degrees()),
            extent: Extent { width: high.x, height: high.y },
            start,
            obstacles: obstacles.chain(fillings(corners.map(place), shift, high)).collect(),
        }
    }
}

impl Scenario {
    /// Returns the scenario with the same surface on every obstacle.
    ///
    /// The surface of the outside is given when the world is made.
    #[must_use]
    pub fn with_surface(&self, surface: Surface) -> Self {
        let mut scenario = self.clone();
        scenario.obstacles.iter_mut().for_each(|obstacle| obstacle.surface = surface);
        scenario
    }
}

impl Shape {
    /// Returns the shape turned by `angle` \[rad\]; `place` gives the new positions of its points
    /// \[m\].
    #[must_use]
    pub fn moved(&self, angle: f64, place: &impl Fn((f64, f64)) -> (f64, f64)) -> Self {
        match self {
            Self::Rectangle { center, size, angle: own } => {
                Self::Rectangle { center: place(*center), size: *size, angle: own + angle }
            }
            Self::Polygon(points) => Self::Polygon(points.iter().map(|p| place(*p)).collect()),
            Self::Wall { from, to, thickness } => {
                Self::Wall { from: place(*from), to: place(*to), thickness: *thickness }
            }
            Self::Circle { center, radius } => {
                Self::Circle { center: place(*center), radius: *radius }
            }
        }
    }
}

/// A filling thinner than this is left out \[m\].
const THIN: f64 = 1e-6;

/// Returns the triangles, counter-clockwise, between a turned rectangle and its bounding box.
///
/// The box reaches from `low` to `high`. The rectangle's corners are counter-clockwise.
pub(crate) fn beyond_sides(
    corners: [Point2<f64>; 4],
    low: Point2<f64>,
    high: Point2<f64>,
) -> impl Iterator<Item = [Point2<f64>; 3]> {
    (0..4).filter_map(move |i| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        // The outside is to the right of a → b.
        let outwards = Vector2::new(b.y - a.y, a.x - b.x);
        let corner = Point2::new(
            if outwards.x > 0.0 { high.x } else { low.x },
            if outwards.y > 0.0 { high.y } else { low.y },
        );
        (outwards.x.abs().min(outwards.y.abs()) > THIN).then_some([b, a, corner])
    })
}

/// Returns the solids around the turned extent.
///
/// These are a triangle beyond each of the extent's sides, up to the corner of the bounding box,
/// and the two strips of the shift.
fn fillings(
    corners: [Point2<f64>; 4],
    shift: Vector2<f64>,
    high: Point2<f64>,
) -> impl Iterator<Item = Obstacle> {
    let triangles = beyond_sides(corners, Point2::from(shift), high);
    let triangles = triangles.map(|points| Shape::Polygon(points.map(|p| (p.x, p.y)).to_vec()));
    // A polygon, because a rectangle may not be as thin as a strip.
    let strip = |x: f64, y: f64| {
        let shape = Shape::Polygon(vec![(0.0, 0.0), (x, 0.0), (x, y), (0.0, y)]);
        (x.min(y) > THIN).then_some(shape)
    };
    let strips = [strip(shift.x, high.y), strip(high.x, shift.y)].into_iter().flatten();
    triangles.chain(strips).map(|shape| Obstacle { shape, surface: Surface::Rough })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::World;
    use proptest::prelude::*;

    fn free_area(scenario: &Scenario) -> f64 {
        let world = World::from_scenario(scenario, Surface::Rough).unwrap();
        let coverage = world.coverage(&world.grid(0.1).unwrap());
        coverage.iter().map(|(_, c)| (1.0 - c) * 0.01).sum()
    }

    /// Shifts of every size, most of them below the least thickness of a rectangle.
    fn shift() -> impl Strategy<Value = f64> {
        prop_oneof![0.0..0.1, (-9.0..-1.0f64).prop_map(libm::exp10)]
    }

    #[test]
    fn a_surface_is_that_of_every_obstacle_also_of_what_turning_adds() {
        let scenario = Scenario {
            name: "room".into(),
            extent: Extent { width: 3.0, height: 2.0 },
            start: None,
            obstacles: vec![Obstacle {
                shape: Shape::Circle { center: (1.0, 1.0), radius: 0.2 },
                surface: Surface::Rough,
            }],
        };
        let moved = scenario.moved(0.3, Vector2::zeros());
        let smooth = moved.with_surface(Surface::Smooth);
        assert!(smooth.obstacles.len() > 1 && smooth.obstacles.len() == moved.obstacles.len());
        assert!(smooth.obstacles.iter().all(|obstacle| obstacle.surface == Surface::Smooth));
        assert_eq!(smooth.with_surface(Surface::Rough), moved);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn a_moved_world_has_the_same_free_area(
            angle in -3.2..3.2f64, dx in shift(), dy in shift()
        ) {
            let shape = |shape| Obstacle { shape, surface: Surface::Smooth };
            let scenario = Scenario {
                name: "room".into(),
                extent: Extent { width: 3.0, height: 2.0 },
                start: Some(Start { x: 0.5, y: 0.5, heading: 0.0 }),
                obstacles: vec![
                    shape(Shape::Rectangle { center: (2.0, 1.0), size: (0.4, 0.7), angle: 0.3 }),
                    shape(Shape::Polygon(vec![(0.0, 1.5), (0.6, 1.6), (0.1, 1.9)])),
                    shape(Shape::Wall { from: (1.2, 1.0), to: (1.5, 0.4), thickness: 0.1 }),
                ],
            };
            let moved = scenario.moved(angle, Vector2::new(dx, dy));
            prop_assert!((free_area(&moved) - free_area(&scenario)).abs() < 1e-5);
            prop_assert!(World::from_scenario(&moved, Surface::Rough).is_ok());
        }
    }
}
