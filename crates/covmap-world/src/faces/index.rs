//! An index of boxes near a point or along a ray: parry's tree of boxes.
//!
//! The tree is f32 and only narrows down the search; the caller computes in f64 from the exact
//! geometry. The tree's boxes are relative to the world's corner, and wider than the true boxes
//! by more than the rounding of f32: no box is missed.

use nalgebra::{Point2, Vector2};
use parry2d::bounding_volume::Aabb;
use parry2d::math::Vec2;
use parry2d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use std::cell::Cell;

/// Boxes are widened by this share of the farthest coordinate.
const WIDENING: f64 = 1e-6;

/// A spatial index of boxes.
#[derive(Debug, Clone)]
pub struct Index {
    tree: Bvh,
    origin: Point2<f64>,
    widening: f64,
}

/// The corners of a box \[m\].
pub type Bounds = (Point2<f64>, Point2<f64>);

impl Index {
    /// Makes an index of boxes; the index names a box by its place in the list.
    pub fn new(origin: Point2<f64>, boxes: &[Bounds]) -> Self {
        let reach = boxes.iter().flat_map(|(low, high)| [low - origin, high - origin]);
        let widening = WIDENING * (1.0 + reach.map(|v| v.amax()).fold(0.0, f64::max));
        let margin = Vector2::repeat(widening);
        let leaf = |&(low, high): &Bounds| {
            Aabb::new(single(low - origin - margin), single(high - origin + margin))
        };
        let leaves: Vec<Aabb> = boxes.iter().map(leaf).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves);
        Self { tree, origin, widening }
    }

    /// Returns the members whose boxes meet a box.
    pub fn meeting(&self, (low, high): Bounds) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (low - self.origin, high - self.origin);
        let meets = move |node: &BvhNode| {
            let (mins, maxs) = (double(node.mins()), double(node.maxs()));
            mins.x <= high.x && mins.y <= high.y && low.x <= maxs.x && low.y <= maxs.y
        };
        self.tree.leaves(meets).map(|member| member as usize)
    }

    /// Returns the member with the smallest cost below `limit`.
    ///
    /// No cost may be below the distance of the member's box along the ray.
    pub fn first_along(
        &self,
        origin: Point2<f64>,
        direction: Vector2<f64>,
        limit: f64,
        cost: impl Fn(usize) -> Option<f64>,
    ) -> Option<(usize, f64)> {
        let start = origin - self.origin;
        let inverse = Vector2::new(1.0 / direction.x, 1.0 / direction.y);
        let entry = |node: &BvhNode| {
            let near = (double(node.mins()) - start).component_mul(&inverse);
            let far = (double(node.maxs()) - start).component_mul(&inverse);
            // 0 · ∞ is NaN, which min and max pass over.
            let enter = near.x.min(far.x).max(near.y.min(far.y)).max(0.0);
            let leave = near.x.max(far.x).min(near.y.max(far.y));
            (enter <= leave).then_some(enter)
        };
        self.best(limit, entry, cost)
    }

    /// Returns the member with the smallest cost below `limit`.
    ///
    /// No cost may be below the distance of the member's box from the point.
    pub fn nearest_to(
        &self,
        point: Point2<f64>,
        limit: f64,
        cost: impl Fn(usize) -> Option<f64>,
    ) -> Option<(usize, f64)> {
        let point = point - self.origin;
        let distance = |node: &BvhNode| {
            let (below, above) = (double(node.mins()) - point, point - double(node.maxs()));
            Some(below.sup(&above).sup(&Vector2::zeros()).norm())
        };
        self.best(limit, distance, cost)
    }

    /// Returns the best in f64. The tree's own order of costs is f32, and gets a little slack.
    fn best(
        &self,
        limit: f64,
        bound: impl Fn(&BvhNode) -> Option<f64>,
        cost: impl Fn(usize) -> Option<f64>,
    ) -> Option<(usize, f64)> {
        let best: Cell<Option<(usize, f64)>> = Cell::new(None);
        let smallest = Cell::new(limit);
        let node_cost = |node: &BvhNode, _: f32| match bound(node) {
            Some(bound) if bound <= smallest.get() => lower(bound),
            _ => f32::MAX,
        };
        let leaf_cost = |member: u32, _: f32| {
            let found = cost(member as usize).filter(|&c| c < smallest.get())?;
            smallest.set(found);
            best.set(Some((member as usize, found)));
            Some(lower(found + self.widening))
        };
        // The result is in `best`; the tree only walks.
        let _ = self.tree.find_best(f32::MAX, node_cost, leaf_cost);
        best.get()
    }
}

#[allow(clippy::cast_possible_truncation, reason = "boxes are widened by more than this loses")]
fn single(v: Vector2<f64>) -> Vec2 {
    Vec2::new(v.x as f32, v.y as f32)
}

#[allow(clippy::cast_possible_truncation, reason = "the caller leaves slack")]
fn lower(v: f64) -> f32 {
    v as f32
}

fn double(v: Vec2) -> Vector2<f64> {
    Vector2::new(f64::from(v.x), f64::from(v.y))
}
