//! The maximum of a smooth concave function.

use std::collections::VecDeque;

/// A concave function with its gradient.
pub(crate) trait Objective {
    /// The value and the gradient at a place.
    fn at(&self, place: &[f64]) -> (f64, Vec<f64>);
}

/// The number of last steps from which the curvature is estimated.
const MEMORY: usize = 12;
/// The largest number of steps.
const STEPS: usize = 400;
/// Slope below which the maximum is found.
const FLAT: f64 = 1e-6;
/// Least gain of a step, as a share of the promise of its slope.
const SUFFICIENT: f64 = 1e-4;
/// The largest number of halvings of a step.
const HALVINGS: usize = 40;

/// Climbs from a place to the maximum: limited-memory BFGS \[Nocedal, 1980\] with a line search
/// that halves. The result is a function of the arguments.
pub(crate) fn climb(objective: &impl Objective, mut place: Vec<f64>) -> Vec<f64> {
    let (mut value, mut gradient) = objective.at(&place);
    let mut memory: VecDeque<Curvature> = VecDeque::new();
    for _ in 0..STEPS {
        if gradient.iter().all(|g| g.abs() < FLAT) {
            break;
        }
        let mut direction = uphill(&memory, &gradient);
        let mut slope = dot(&direction, &gradient);
        if slope <= 0.0 {
            memory.clear();
            direction.clone_from(&gradient);
            slope = dot(&gradient, &gradient);
        }
        // Nothing is known of the scale of the first step.
        let first = if memory.is_empty() { 1.0 / slope.sqrt().max(1.0) } else { 1.0 };
        let step = (0..HALVINGS).find_map(|halvings| {
            let length = first * libm::exp2(-f64::from(u32::try_from(halvings).unwrap_or(0)));
            let there: Vec<f64> =
                place.iter().zip(&direction).map(|(at, way)| at + length * way).collect();
            let (higher, steepness) = objective.at(&there);
            let enough = higher >= value + SUFFICIENT * length * slope;
            enough.then_some((there, higher, steepness))
        });
        let Some((there, higher, steepness)) = step else { break };
        let moved: Vec<f64> = there.iter().zip(&place).map(|(to, from)| to - from).collect();
        // The change of the function turned upside down, so that curvature is positive.
        let change: Vec<f64> =
            steepness.iter().zip(&gradient).map(|(to, from)| from - to).collect();
        let product = dot(&moved, &change);
        if product > 1e-12 * dot(&change, &change) {
            if memory.len() == MEMORY {
                memory.pop_front();
            }
            memory.push_back(Curvature { moved, change, product });
        }
        (place, value, gradient) = (there, higher, steepness);
    }
    place
}

/// The curvature along a step.
struct Curvature {
    moved: Vec<f64>,
    change: Vec<f64>,
    product: f64,
}

/// Returns the direction of the quasi-Newton step: two loops over the memory.
fn uphill(memory: &VecDeque<Curvature>, gradient: &[f64]) -> Vec<f64> {
    let mut direction = gradient.to_vec();
    let mut shares = Vec::new();
    for Curvature { moved, change, product } in memory.iter().rev() {
        let share = dot(moved, &direction) / product;
        add(&mut direction, -share, change);
        shares.push(share);
    }
    if let Some(Curvature { change, product, .. }) = memory.back() {
        let scale = product / dot(change, change);
        direction.iter_mut().for_each(|d| *d *= scale);
    }
    for (Curvature { moved, change, product }, share) in memory.iter().zip(shares.iter().rev()) {
        let back = dot(change, &direction) / product;
        add(&mut direction, share - back, moved);
    }
    direction
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(to: &mut [f64], factor: f64, what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(to, what)| *to += factor * what);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A hill with a narrow ridge: −Σ k⁴·(x_k − k)² − (x_0 + x_1)⁴.
    struct Hill;

    impl Objective for Hill {
        fn at(&self, place: &[f64]) -> (f64, Vec<f64>) {
            let bend = place[0] + place[1];
            let cube = bend * bend * bend;
            let (mut value, mut gradient) = (-cube * bend, vec![0.0; place.len()]);
            for (k, (x, g)) in (1u32..).zip(place.iter().zip(&mut gradient)) {
                let k = f64::from(k);
                let steepness = k * k * k * k;
                value -= steepness * (x - k) * (x - k);
                *g = -2.0 * steepness * (x - k);
            }
            gradient[0] -= 4.0 * cube;
            gradient[1] -= 4.0 * cube;
            (value, gradient)
        }
    }

    proptest! {
        #[test]
        fn the_top_is_found_from_anywhere(start in prop::collection::vec(-5.0..5.0f64, 6)) {
            let top = climb(&Hill, start);
            let (_, slope) = Hill.at(&top);
            prop_assert!(slope.iter().all(|s| s.abs() < 1e-5), "{:?}", slope);
            for (k, x) in (1u32..).zip(&top).skip(2) {
                prop_assert!((x - f64::from(k)).abs() < 1e-5);
            }
        }
    }
}
