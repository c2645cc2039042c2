//! The body as a contact sensor: where it was nothing is; where it stopped something is.

mod event;
mod front;

pub use event::BodyEvent;

use crate::integrate::{integrate_body, is_under_body, merge};
use covmap::{Cell, Change, CoverageMap, Grid, MAX_BINS, PROBABILITY_FLOOR, bin_coverage};
use front::front;
use nalgebra::{Point2, Vector2};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

/// Each side of a cell is divided into 8 parts: all parts of a cell, a bit each, are a u64.
const PARTS: i32 = 8;

/// What is touched is looked for so far under the front of the body \[sides of a part\]: half of a
/// part's diagonal, so that the part in which it lies is none whose centre the body was over.
const DEPTH: f64 = FRAC_1_SQRT_2;

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
        let all = PROBABILITY_FLOOR * bins as f64;
        normalise_above(&mut p[..bins], all);
        p
    }
}

/// Raises the bins of a histogram to those of a uniform one of weight `least`, and normalises it.
fn normalise_above(p: &mut [f64], least: f64) {
    let sum: f64 = p.iter().sum();
    let floor = least / p.len() as f64;
    p.iter_mut().for_each(|p| *p = (*p / sum).max(floor));
    let sum: f64 = p.iter().sum();
    p.iter_mut().for_each(|p| *p /= sum);
}

/// The bit of a part of a cell.
fn bit(part: Cell) -> u64 {
    1 << (part.y.rem_euclid(PARTS) * PARTS + part.x.rem_euclid(PARTS))
}

#[cfg(test)]
mod tests;
