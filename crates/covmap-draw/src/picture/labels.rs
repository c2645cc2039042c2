//! Placement of legible labels.

use super::text::{CAP_HEIGHT, text_width};

/// The distance of a label from its point \[pixels\].
const GAP: f32 = 16.0;
/// The free space around a label \[pixels\].
const PADDING: f32 = 4.0;

/// A rectangle of pixels: left, top, right, bottom.
type Area = [f32; 4];

/// Returns the beginning of the baseline of each label. A label stands beside its point, inside the
/// map, where it covers the least of points and of earlier labels.
pub(super) fn place_labels<'a>(
    labels: &[(&'a str, [f32; 2])],
    size: f32,
    width: u32,
    height: u32,
) -> Vec<(&'a str, [f32; 2])> {
    let (width, height) = (width as f32, height as f32);
    let is_visible = |[x, y]: &[f32; 2]| (0.0..=width).contains(x) && (0.0..=height).contains(y);
    let visible: Vec<_> = labels.iter().filter(|(_, at)| is_visible(at)).copied().collect();
    let around = |[x, y]: [f32; 2]| [x - GAP / 2.0, y - GAP / 2.0, x + GAP / 2.0, y + GAP / 2.0];
    let mut taken: Vec<Area> = visible.iter().map(|(_, at)| around(*at)).collect();
    let mut placed = Vec::with_capacity(visible.len());
    for (text, at) in visible {
        let (w, h) = (text_width(text, size), size * CAP_HEIGHT);
        let mut best: Option<(f32, Area)> = None;
        for corner in corners(at, w, h) {
            let x = corner[0].clamp(PADDING, (width - w - PADDING).max(PADDING));
            let y = corner[1].clamp(PADDING, (height - h - 2.0 * PADDING).max(PADDING));
            let area = [x - PADDING, y - PADDING, x + w + PADDING, y + h + 2.0 * PADDING];
            let covered: f32 = taken.iter().map(|other| common(&area, other)).sum();
            if best.is_none_or(|(least, _)| covered < least) {
                best = Some((covered, area));
            }
        }
        if let Some((_, area)) = best {
            taken.push(area);
            placed.push((text, [area[0] + PADDING, area[1] + PADDING + h]));
        }
    }
    placed
}

/// Returns the top left corners that a label of a size may have: right of its point first, then the
/// others round it.
fn corners([x, y]: [f32; 2], w: f32, h: f32) -> [[f32; 2]; 8] {
    let (right, left, middle) = (x + GAP, x - GAP - w, x - w / 2.0);
    let (above, below, level) = (y - GAP - h, y + GAP, y - h / 2.0);
    [
        [right, level],
        [left, level],
        [middle, above],
        [middle, below],
        [right, above],
        [right, below],
        [left, above],
        [left, below],
    ]
}

/// Returns the area that two rectangles have in common \[square pixels\].
fn common(a: &Area, b: &Area) -> f32 {
    let width = a[2].min(b[2]) - a[0].max(b[0]);
    let height = a[3].min(b[3]) - a[1].max(b[1]);
    width.max(0.0) * height.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area((text, [x, baseline]): &(&str, [f32; 2])) -> Area {
        [*x, baseline - 16.0 * CAP_HEIGHT, x + text_width(text, 16.0), *baseline]
    }

    #[test]
    fn labels_of_neighbouring_points_do_not_meet() {
        let points = [[100.0, 100.0], [104.0, 100.0], [100.0, 106.0], [96.0, 98.0], [103.0, 95.0]];
        let labels: Vec<_> = points.iter().map(|at| ("view-point", *at)).collect();
        let placed = place_labels(&labels, 16.0, 400, 300);
        for (i, one) in placed.iter().enumerate() {
            for other in &placed[..i] {
                assert!(common(&area(one), &area(other)) == 0.0);
            }
        }
    }

    #[test]
    fn a_label_outside_the_map_is_left_out() {
        let labels = [("a", [-5.0, 10.0]), ("b", [f32::NAN, 0.0]), ("c", [5.0, 5.0])];
        assert_eq!(place_labels(&labels, 16.0, 50, 50).len(), 1);
    }

    proptest! {
        #[test]
        fn no_label_is_clipped(x in 0.0..400.0f32, y in 0.0..300.0f32) {
            let placed = place_labels(&[("a long label", [x, y])], 16.0, 400, 300);
            let [left, top, right, bottom] = area(&placed[0]);
            prop_assert!(left >= 0.0 && top >= 0.0 && right <= 400.0 && bottom <= 300.0);
        }
    }
}
