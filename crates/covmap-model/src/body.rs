//! The body as a contact sensor: where it was nothing is; where it stopped something is.

use crate::integrate::{integrate_body, is_under_body, merge};
use covmap::{Cell, Change, CoverageMap, Grid, MAX_BINS, PROBABILITY_FLOOR, bin_coverage};
use nalgebra::{Point2, Vector2};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A cell has so many parts along each side: as a bit each they are a u64.
const PARTS: i32 = 8;

/// What is touched is looked for so far under the front of the body \[sides of a part\]: half of a
/// part's diagonal, so that the part in which it lies is none whose centre the body was over.
const DEPTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// However surely one cell alone explains a contact, so much of its share is left for what is not
/// in the map: what readings say of the cell is not lost.
const ELSEWHERE: f64 = 1e-3;

/// Of a cell that the body may have touched, readings leave at least this probability, spread over
/// all coverages: where one thing can be touched and not be heard, others can.
const DOUBT: f64 = 0.1;

/// What the robot's body tells of the map: where it was, and where it touched something.
///
/// Choice: the paper has no contact sensor. A disc that drives on and stops at something touches
/// it with its **front**: the half of its rim that looks ahead. What touched it lies where the
/// body has never been. Of the front's width, as it is seen along the way, cell i holds the share
/// w_i where the body has not been yet; and the body meets matter first in a cell in proportion
/// to the share and to the coverage:
///
/// ```text
/// p(contact | c_1 … c_m) ∝ Σ w_i · c_i            w_i = ∫ cos φ dφ / 2 over those parts of i
/// p(contact | c_j)       ∝ w_j · c_j + Σ_(i≠j) w_i · E[c_i]
/// ```
///
/// The second line is exact Bayes where the cells are independent, as Eq. (3) has it; the
/// expectations are those without this contact. So a wall that is known explains a bump; where all
/// seems free, each cell of the front may be it; and the more of
/// the front the body has passed through at other times, the surer it is which. What has been
/// passed through is kept in parts of an eighth of a cell, by their centres.
///
/// A contact remains true when later readings speak against it, as those of a mirroring wall do
/// again and again. So it is kept as a condition on the posterior, and not multiplied in once:
/// [`hold`](Self::hold) renews the shares and the expectations after each scan (expectation
/// propagation with one factor a contact, one turn a scan). Readings that contradict a contact
/// share their error, which their product does not know. Choice: of a cell that may have been
/// touched they leave about a tenth of the probability, spread over all coverages: an entropy of .48
/// nats with 11 bins, which is resolved by default, and enough for the neighbours of a wall that
/// was found to be wall as well. Of a cell that nobody measured a contact says something only if
/// the cell explains half of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    grid: Grid,
    radius: f64,
    /// The parts of each cell in which the body was.
    passed: Vec<u64>,
    contacts: Vec<Contact>,
    /// The contacts at whose front a cell is.
    at: BTreeMap<Cell, Vec<usize>>,
}

/// Something was touched.
#[derive(Debug, Clone, PartialEq)]
struct Contact {
    /// The parts of cells at the front, and the shares of its width.
    parts: Vec<(Cell, u64, f64)>,
    touched: Vec<Touched>,
}

/// A cell at the front of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Touched {
    cell: Cell,
    /// w_j
    share: f64,
    /// Σ_(i≠j) w_i · E\[c_i\]; `None` where the contact says nothing of the cell.
    others: Option<f64>,
}

impl Body {
    /// A disc of `radius` \[m\] that was nowhere yet on the grid of a map.
    pub fn new(grid: Grid, radius: f64) -> Self {
        let (passed, contacts) = (vec![0; grid.len()], Vec::new());
        Self { grid, radius, passed, contacts, at: BTreeMap::new() }
    }

    /// Integrates that the body was all the way between two points \[m\] and touched nothing, as
    /// [`integrate_body`]. Returns what changed, in row-major order.
    ///
    /// # Panics
    /// This and the others: if the map is on another grid.
    pub fn moved(
        &mut self,
        map: &mut CoverageMap,
        from: Point2<f64>,
        to: Point2<f64>,
    ) -> Vec<Change> {
        let changes = integrate_body(map, from, to, self.radius);
        let concerned = self.pass(from, to);
        self.renew_all(map, changes, concerned)
    }

    /// Integrates that the body, with its centre `at` \[m\], touched something when it drove on in
    /// a `direction`. Returns what changed, in row-major order.
    ///
    /// A direction or a place that is not finite is no contact.
    pub fn touched(
        &mut self,
        map: &mut CoverageMap,
        at: Point2<f64>,
        direction: Vector2<f64>,
    ) -> Vec<Change> {
        let step = self.grid.resolution() / f64::from(PARTS);
        let rim = front(self.grid.lower_left(), step, at, direction, self.radius + DEPTH * step);
        let part = |(part, share): (Cell, f64)| {
            let cell = Cell::new(part.x.div_euclid(PARTS), part.y.div_euclid(PARTS));
            self.grid.index(cell).map(|_| (cell, bit(part), share))
        };
        let parts: Vec<(Cell, u64, f64)> = rim.into_iter().filter_map(part).collect();
        let mut cells: Vec<Cell> = parts.iter().map(|(cell, ..)| *cell).collect();
        cells.sort_unstable();
        cells.dedup();
        let number = self.contacts.len();
        cells.iter().for_each(|cell| self.at.entry(*cell).or_default().push(number));
        let touched = |cell: &Cell| Touched { cell: *cell, share: 0.0, others: None };
        let touched = cells.iter().map(touched).collect();
        self.contacts.push(Contact { parts, touched });
        self.renew_all(map, Vec::new(), vec![number])
    }

    /// Renews what follows from the contacts at whose fronts a scan changed something. Returns all
    /// changes, those given and its own, in row-major order, each cell once.
    pub fn hold(&mut self, map: &mut CoverageMap, changes: Vec<Change>) -> Vec<Change> {
        let at = changes.iter().filter_map(|change| self.at.get(&change.cell));
        let concerned = at.flatten().copied().collect();
        self.renew_all(map, changes, concerned)
    }

    fn renew_all(
        &mut self,
        map: &mut CoverageMap,
        mut changes: Vec<Change>,
        mut concerned: Vec<usize>,
    ) -> Vec<Change> {
        concerned.sort_unstable();
        concerned.dedup();
        if concerned.is_empty() {
            return changes;
        }
        for number in concerned {
            changes.extend(self.contacts[number].renew(map, &self.grid, &self.passed));
        }
        merge(changes)
    }

    /// Takes note of where the body was. Returns the contacts of which that says more.
    fn pass(&mut self, from: Point2<f64>, to: Point2<f64>) -> Vec<usize> {
        let mut concerned = Vec::new();
        let step = self.grid.resolution() / f64::from(PARTS);
        let margin = Vector2::repeat(self.radius + self.grid.resolution());
        let (low, high) = (from.inf(&to) - margin, from.sup(&to) + margin);
        for cell in self.grid.cells_between(low, high) {
            let index = self.grid.index(cell).filter(|i| self.passed[*i] != u64::MAX);
            let Some(index) = index else { continue };
            let corner = self.grid.lower_corner(cell);
            let before = self.passed[index];
            for (i, j) in (0..PARTS).flat_map(|j| (0..PARTS).map(move |i| (i, j))) {
                let part = bit(Cell::new(i, j));
                let center = corner + Vector2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * step;
                if self.passed[index] & part == 0 && is_under_body(center, from, to, self.radius) {
                    self.passed[index] |= part;
                }
            }
            if self.passed[index] != before {
                concerned.extend(self.at.get(&cell).into_iter().flatten());
            }
        }
        concerned
    }
}

impl Contact {
    /// Replaces what the contact said of its cells by what it says now.
    fn renew(&mut self, map: &mut CoverageMap, grid: &Grid, passed: &[u64]) -> Vec<Change> {
        let bins = map.bins();
        let mut without: Vec<[f64; MAX_BINS]> =
            self.touched.iter().map(|t| t.without(map)).collect();
        self.touched.iter_mut().for_each(|t| t.share = 0.0);
        for (cell, part, share) in &self.parts {
            let is_new = grid.index(*cell).is_some_and(|i| passed[i] & part == 0);
            let at = self.touched.binary_search_by_key(cell, |t| t.cell);
            if let Some(touched) = at.ok().filter(|_| is_new && !map.is_pinned(*cell)) {
                self.touched[touched].share += share;
            }
        }
        for (_, p) in self.touched.iter().zip(&mut without).filter(|(t, _)| t.share > 0.0) {
            normalise_above(&mut p[..bins], DOUBT);
        }
        let mean = |p: &[f64; MAX_BINS]| -> f64 {
            p[..bins].iter().enumerate().map(|(k, p)| p * bin_coverage(k, bins)).sum()
        };
        let expected: Vec<f64> =
            self.touched.iter().zip(&without).map(|(t, p)| t.share * mean(p)).collect();
        let sum: f64 = expected.iter().sum();
        let mut changes = Vec::new();
        for ((touched, without), own) in self.touched.iter_mut().zip(without).zip(expected) {
            // What nobody measured is a wall for its likeliness alone, not for a small share.
            let says = own > 0.0 && (map.is_known(touched.cell) || own >= 0.5 * sum);
            let others = says.then_some((sum - own).max(ELSEWHERE * touched.share));
            if touched.others.is_none() && others.is_none() {
                continue;
            }
            touched.others = others;
            let mut now = [0.0; MAX_BINS];
            map.read_posterior(touched.cell, &mut now[..bins]);
            let evidence: Vec<f64> = (0..bins)
                .map(|k| without[k] * touched.likelihood(bin_coverage(k, bins)) / now[k])
                .collect();
            changes.extend(map.multiply(touched.cell, &evidence));
        }
        changes
    }
}

impl Touched {
    /// p(contact | c) of this cell; where it says nothing, 1.
    fn likelihood(&self, coverage: f64) -> f64 {
        self.others.map_or(1.0, |others| self.share * coverage + others)
    }

    /// The posterior of the cell without this contact.
    fn without(&self, map: &CoverageMap) -> [f64; MAX_BINS] {
        let bins = map.bins();
        let mut p = [0.0; MAX_BINS];
        map.read_posterior(self.cell, &mut p[..bins]);
        for (k, p) in p[..bins].iter_mut().enumerate() {
            *p /= self.likelihood(bin_coverage(k, bins)).max(f64::MIN_POSITIVE);
        }
        #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
        let all = PROBABILITY_FLOOR * bins as f64;
        normalise_above(&mut p[..bins], all);
        p
    }
}

/// Raises the bins of a histogram to those of a uniform one of weight `least`, and normalises it.
fn normalise_above(p: &mut [f64], least: f64) {
    let sum: f64 = p.iter().sum();
    #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
    let floor = least / p.len() as f64;
    p.iter_mut().for_each(|p| *p = (*p / sum).max(floor));
    let sum: f64 = p.iter().sum();
    p.iter_mut().for_each(|p| *p /= sum);
}

/// The bit of a part of a cell.
fn bit(part: Cell) -> u64 {
    1 << (part.y.rem_euclid(PARTS) * PARTS + part.x.rem_euclid(PARTS))
}

/// The squares of side `step` \[m\], from a corner on, under the front of a disc that drives in a
/// direction, in row-major order, with their shares of its width: all of them together 1.
fn front(
    corner: Point2<f64>,
    step: f64,
    at: Point2<f64>,
    direction: Vector2<f64>,
    radius: f64,
) -> Vec<(Cell, f64)> {
    let ahead = libm::atan2(direction.y, direction.x);
    let is_finite = at.coords.iter().chain(&direction).all(|v| v.is_finite());
    // Farther away, parts could not be told apart.
    let is_near = (at - corner).amax() <= 1e9 * step;
    if !is_finite || !is_near || direction.norm() <= 0.0 || !(0.0..=1e4 * step).contains(&radius) {
        return Vec::new();
    }
    let mut ends = vec![-FRAC_PI_2, FRAC_PI_2];
    let offset = at - corner;
    for (along, turn) in [(offset.x, 0.0), (offset.y, FRAC_PI_2)] {
        // Where the rim crosses the line between two columns, or two rows.
        let line = |k: f64| (k * step - along) / radius;
        let first = ((along - radius) / step).ceil();
        let lines = std::iter::successors(Some(first), |k| Some(k + 1.0));
        for cosine in lines.map(line).take_while(|cosine| *cosine <= 1.0) {
            let angle = libm::acos(cosine.clamp(-1.0, 1.0));
            ends.extend([turn + angle, turn - angle].map(|angle| around(angle - ahead)));
        }
    }
    ends.retain(|end| end.abs() <= FRAC_PI_2);
    ends.sort_by(f64::total_cmp);
    let mut shares: BTreeMap<Cell, f64> = BTreeMap::new();
    for part in ends.windows(2) {
        let (sin, cos) = libm::sincos(ahead + 0.5 * (part[0] + part[1]));
        let share = 0.5 * (libm::sin(part[1]) - libm::sin(part[0]));
        let square = (offset + Vector2::new(cos, sin) * radius) / step;
        #[allow(clippy::cast_possible_truncation, reason = "saturates outside of every grid")]
        let square = Cell::new(square.x.floor() as i32, square.y.floor() as i32);
        if share > 0.0 {
            *shares.entry(square).or_default() += share;
        }
    }
    shares.into_iter().collect()
}

/// An angle in [−π, π).
fn around(angle: f64) -> f64 {
    angle - TAU * ((angle + PI) / TAU).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(width: usize, height: usize) -> CoverageMap {
        let grid = Grid::new(Point2::origin(), 0.1, width, height).unwrap();
        CoverageMap::new(grid, 11).unwrap()
    }

    /// Makes a cell free, or solid, as sure as `weight` against 1.
    fn believe(map: &mut CoverageMap, cell: Cell, coverage: usize, weight: f64) {
        let mut evidence = [1.0; 11];
        evidence[coverage] = weight;
        map.multiply(cell, &evidence);
    }

    #[test]
    fn the_front_is_the_half_of_the_rim_ahead() {
        // A disc of .2 m around the middle of cell (10, 10), driving to the right: its front
        // crosses y = ±.05 and ±.15 around the centre, so the rows have ¼ each of its .4 m and
        // the outermost two ⅛ each.
        let shares = front(Point2::origin(), 0.1, Point2::new(1.05, 1.05), Vector2::x(), 0.2);
        let row = |y: i32| shares.iter().filter(|(c, _)| c.y == y).map(|(_, w)| w).sum::<f64>();
        for (y, share) in [(8, 0.125), (9, 0.25), (10, 0.25), (11, 0.25), (12, 0.125)] {
            assert!((row(y) - share).abs() < 1e-12, "{y}: {}", row(y));
        }
        assert!(shares.iter().all(|(cell, _)| cell.x >= 10));
        // Right ahead .2 m: cell (12, 10), and no other of its row.
        assert!(shares.iter().any(|(c, w)| *c == Cell::new(12, 10) && (w - 0.25).abs() < 1e-12));
    }

    #[test]
    fn the_front_turns_with_the_direction() {
        let corner = Point2::new(-1.0, -1.0);
        let turned = |cell: Cell| Cell::new(19 - cell.y, cell.x);
        let shares = |direction| front(corner, 0.1, Point2::origin(), direction, 0.27);
        let mut expected: Vec<(Cell, f64)> =
            shares(Vector2::new(0.6, 0.8)).into_iter().map(|(c, w)| (turned(c), w)).collect();
        expected.sort_by_key(|(cell, _)| *cell);
        let found = shares(Vector2::new(-0.8, 0.6));
        assert_eq!(found.len(), expected.len());
        for ((a, v), (b, w)) in found.iter().zip(&expected) {
            assert!(a == b && (v - w).abs() < 1e-9, "{a:?} {v} {b:?} {w}");
        }
        assert!((found.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-12);
        for direction in [Vector2::zeros(), Vector2::new(f64::NAN, 1.0)] {
            assert!(shares(direction).is_empty());
        }
    }

    #[test]
    fn what_alone_can_have_been_touched_was() {
        // A body of .1 m in a corridor that is one cell wide: of its front only cell 3 may be
        // covered.
        let mut map = map(5, 1);
        let mut body = Body::new(*map.grid(), 0.05);
        map.pin_free(Cell::new(2, 0));
        let changes = body.touched(&mut map, Point2::new(0.26, 0.05), Vector2::x());
        assert_eq!(changes.iter().map(|c| c.cell).collect::<Vec<_>>(), [Cell::new(3, 0)]);
        // Of a uniform prior p(c) ∝ c + .001, and 0 + .1 + … + 1 = 5.5.
        for (k, p) in (0u32..).zip(map.histogram(Cell::new(3, 0)).probabilities()) {
            let expected = (0.1 * f64::from(k) + 0.001) / 5.511;
            assert!((p - expected).abs() < 1e-7, "{k}: {p}");
        }
        assert!(body.touched(&mut map, Point2::new(0.05, 9.0), Vector2::x()).is_empty());
        assert!(body.touched(&mut map, Point2::new(f64::NAN, 0.0), Vector2::x()).is_empty());
    }

    /// Two cells, one above the other, ahead of a wide body that is in the cells before them.
    fn two_cells() -> (CoverageMap, Body, [Cell; 2]) {
        let mut map = map(3, 2);
        let body = Body::new(*map.grid(), 0.09);
        [0, 1].into_iter().for_each(|y| {
            map.pin_free(Cell::new(0, y));
        });
        (map, body, [Cell::new(1, 0), Cell::new(1, 1)])
    }

    fn touch_both(map: &mut CoverageMap, body: &mut Body) {
        body.touched(map, Point2::new(0.049, 0.1), Vector2::x());
    }

    #[test]
    fn each_cell_may_be_it_by_its_share_and_its_coverage() {
        let (mut map, mut body, [low, high]) = two_cells();
        believe(&mut map, low, 0, 10.0);
        believe(&mut map, high, 10, 10.0);
        let mean = [map.mean(low), map.mean(high)];
        let before = map.histogram(low);
        touch_both(&mut map, &mut body);
        // Their shares are equal: p(c) ∝ h(c) · (c + E[c of the other]).
        let factor = |c: f64| c + mean[1];
        let weights: Vec<f64> = before
            .probabilities()
            .iter()
            .enumerate()
            .map(|(k, p)| p * factor(bin_coverage(k, 11)))
            .collect();
        let sum: f64 = weights.iter().sum();
        let after = map.histogram(low);
        for k in [0, 5, 10] {
            let expected = weights[k] / sum;
            let found = after.probabilities()[k];
            assert!((found - expected).abs() < 1e-6, "{k}: {found} {expected}");
        }
        // The wall explains the contact.
        assert!(map.mode(low) < 0.1 && map.mode(high) > 0.9);
    }

    #[test]
    fn a_contact_stays_true_when_readings_speak_against_it() {
        let (mut map, mut body, cells) = two_cells();
        touch_both(&mut map, &mut body);
        let free = [3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        for _ in 0..200 {
            let changes = cells.iter().filter_map(|cell| map.multiply(*cell, &free)).collect();
            body.hold(&mut map, changes);
        }
        // Both look free, and one of them is not: half each, but that both may be, whatever the
        // readings say.
        for cell in cells {
            let p = 1.0 - map.histogram(cell).probabilities()[0];
            assert!((0.5..0.6).contains(&p), "{p}");
            assert!(map.entropy(cell) > 0.6);
        }
        // The body gets to one of them: then it was the other.
        let changes = map.pin_free(cells[0]).into_iter().collect();
        let changes = body.hold(&mut map, changes);
        assert_eq!(changes.iter().map(|c| c.cell).collect::<Vec<_>>(), cells);
        // p(0) of a tenth in doubt: .909 · .001 against .0091 · 5.5.
        let p = map.histogram(cells[1]).probabilities()[0];
        assert!((p - 0.018).abs() < 0.003, "{p}");
    }

    /// A wall at some x, of which all readings say a hundred times what they say; bumped into in
    /// each row from 4 to 15.
    fn bumped_wall(wall: f64, says: impl Fn(Cell) -> [f64; 11]) -> CoverageMap {
        let mut map = map(20, 20);
        let mut body = Body::new(*map.grid(), 0.27);
        let all: Vec<Cell> = map.grid().cells().collect();
        let hear = |map: &mut CoverageMap, body: &mut Body| {
            let changes = all.iter().filter_map(|cell| map.multiply(*cell, &says(*cell))).collect();
            body.hold(map, changes);
        };
        (0..50).for_each(|_| hear(&mut map, &mut body));
        for y in 4..16 {
            let home = Point2::new(0.65, 0.1 * f64::from(y) + 0.05);
            let at = Point2::new(wall - 0.27 - 1e-6, home.y);
            body.moved(&mut map, home, at);
            body.touched(&mut map, at, Vector2::x());
            body.moved(&mut map, at, home);
            hear(&mut map, &mut body);
        }
        map
    }

    const FREE: [f64; 11] = [3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
    const SOLID: [f64; 11] = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 3.0];

    #[test]
    fn a_wall_that_mirrors_every_sound_is_not_free_where_it_was_touched() {
        for step in 0..20 {
            let wall = 1.0 + 0.005 * f64::from(step);
            let map = bumped_wall(wall, |_| FREE);
            // But at its ends, where another cell beside may have been it as well.
            for y in 6..14 {
                let (at, behind) = (Cell::new(10, y), Cell::new(11, y));
                let p = 1.0 - map.histogram(at).probabilities()[0];
                assert!(map.entropy(at) > 0.6 && p > 0.2, "{wall} {y}: {:?}", map.histogram(at));
                // What is touched may be as deep as a part of a cell.
                if wall < 1.09 {
                    assert!(map.mode(behind) < 0.1 && map.entropy(behind) < 0.6, "{wall} {y}");
                }
            }
        }
    }

    #[test]
    fn a_wall_that_is_heard_is_not_forgotten_where_it_was_touched() {
        let map = bumped_wall(1.0, |cell| if cell.x >= 10 { SOLID } else { FREE });
        for y in 5..15 {
            let (before, wall) = (Cell::new(9, y), Cell::new(10, y));
            assert!(map.mode(wall) > 0.9 && map.entropy(wall) < 0.6, "{y}");
            assert!(map.mode(before) < 0.1 && map.entropy(before) < 0.6, "{y}");
        }
    }

    #[test]
    fn what_nobody_measured_is_no_wall_for_a_small_share() {
        let mut map = map(20, 20);
        let mut body = Body::new(*map.grid(), 0.27);
        body.moved(&mut map, Point2::new(0.65, 1.05), Point2::new(0.73, 1.05));
        let known = |map: &CoverageMap| {
            let cells = map.grid().cells();
            cells.filter(|c| map.is_known(*c) && !map.is_pinned(*c)).count()
        };
        let changes = body.touched(&mut map, Point2::new(0.73, 1.05), Vector2::x());
        assert_eq!((changes.len(), known(&map)), (0, 0));
    }

    #[test]
    fn absurd_places_are_no_contact() {
        let mut map = map(4, 4);
        let grid = *map.grid();
        for (radius, x) in [(-1.0, 0.2), (f64::NAN, 0.2), (1e9, 0.2), (0.2, 1e30)] {
            let at = Point2::new(x, 0.2);
            assert!(Body::new(grid, radius).touched(&mut map, at, Vector2::x()).is_empty());
        }
    }
}
