//! The body as a contact sensor: the cells that it passed are free, and something that stopped it
//! is covered.

mod event;
mod front;

pub use event::BodyEvent;

use crate::integrate::{integrate_body, is_under_body, merge};
use covmap::{Cell, Change, CoverageMap, Grid, MAX_BINS, PROBABILITY_FLOOR, bin_coverage};
use front::front;
use nalgebra::{Point2, Vector2};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

/// Number of parts along each side of a cell: all parts of a cell, a bit each, are a u64.
const PARTS: i32 = 8;

/// Distance from the body to the point where the touched object is sought \[sides of a part\]: half
/// of a part's diagonal, so that the centre of the part around this point was not under the body.
const DEPTH: f64 = FRAC_1_SQRT_2;

/// Least weight of the other causes if one cell alone explains a contact, in units of its share. It
/// stands for objects that are not in the map, and keeps the evidence of readings about the cell.
const ELSEWHERE: f64 = 1e-3;

/// Least probability, spread over all coverages, that readings leave to a cell that the body may
/// have touched: where one object can be touched and not heard, others can be as well.
const DOUBT: f64 = 0.1;

/// The robot's body as a contact sensor: the places that it passed, and its contacts.
///
/// Choice: the paper has no contact sensor. A disc that drives on and stops at an object touches it
/// with its **front**: the half of its rim that looks ahead. The object lies where the body has
/// never been. Cell i holds the share w_i of the front's width, as seen along the way, in places
/// that the body has not passed yet. The body meets matter first in a cell in proportion to the
/// cell's share and to its coverage:
///
/// ```text
/// p(contact | c_1 … c_m) ∝ Σ w_i · c_i            w_i = ∫ cos φ dφ / 2 over those parts of i
/// p(contact | c_j)       ∝ w_j · c_j + Σ_(i≠j) w_i · E[c_i]
/// ```
///
/// The second line is exact Bayes where the cells are independent, as Eq. (3) has it; the
/// expectations are those without this contact. A known wall therefore explains a contact; where
/// all cells seem free, each cell of the front may be the cause; and the more of the front the body
/// passes at other times, the more certain the cause becomes. The parts that the body has passed,
/// of an eighth of a cell each, are kept by their centres.
///
/// A contact remains true when later readings contradict it, as those of a mirroring wall do again
/// and again. It is therefore a condition on the posterior and is not multiplied in once:
/// [`hold`](Self::hold) renews the shares and the expectations after each scan (expectation
/// propagation with one factor per contact, one turn per scan). Readings that contradict a contact
/// share their error, which their product ignores. Choice: such readings leave about a tenth of the
/// probability of a cell that may have been touched, spread over all coverages. With 11 bins this
/// is an entropy of .48 nats, which is resolved by default, and it suffices for the neighbours of a
/// detected wall to be found as wall as well. A contact changes a cell without readings only if the
/// cell explains half of the contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    grid: Grid,
    radius: f64,
    /// The parts of each cell that the body has passed.
    passed: Vec<u64>,
    contacts: Vec<Contact>,
    /// The contacts that have a cell at their front.
    at: BTreeMap<Cell, Vec<usize>>,
}

/// One contact of the body.
#[derive(Debug, Clone, PartialEq)]
struct Contact {
    /// The parts of cells at the front, with their shares of its width.
    parts: Vec<(Cell, u64, f64)>,
    touched: Vec<Touched>,
}

/// A cell at the front of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Touched {
    cell: Cell,
    /// w_j
    share: f64,
    /// Σ_(i≠j) w_i · E\[c_i\]; `None` where the contact says nothing about the cell.
    others: Option<f64>,
}

impl Body {
    /// Creates a disc of `radius` \[m\] that has not been anywhere yet on the grid of a map.
    pub fn new(grid: Grid, radius: f64) -> Self {
        let (passed, contacts) = (vec![0; grid.len()], Vec::new());
        Self { grid, radius, passed, contacts, at: BTreeMap::new() }
    }

    /// Integrates a way between two points \[m\] on which the body touched nothing, as
    /// [`integrate_body`] does. Returns the changes, in row-major order.
    ///
    /// # Panics
    /// If the map is on another grid; this holds for all methods.
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

    /// Integrates a contact of the body, with its centre `at` \[m\], while it drove on in a
    /// `direction`. Returns the changes, in row-major order.
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

    /// Renews the contacts that have a changed cell at their front. Returns all changes, those
    /// given and its own, in row-major order, each cell once.
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

    /// Records the way of the body. Returns the contacts that this concerns.
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
    /// Replaces the old evidence of the contact about its cells by the present one.
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
            // A contact changes a cell without readings only if the cell explains half of it, not
            // for a small share.
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
    /// Returns p(contact | c) of this cell; 1 if the contact says nothing about it.
    fn likelihood(&self, coverage: f64) -> f64 {
        self.others.map_or(1.0, |others| self.share * coverage + others)
    }

    /// Returns the posterior of the cell without this contact.
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

/// Raises the bins of a histogram to at least those of a uniform one of weight `least`, and
/// normalises it.
fn normalise_above(p: &mut [f64], least: f64) {
    let sum: f64 = p.iter().sum();
    let floor = least / p.len() as f64;
    p.iter_mut().for_each(|p| *p = (*p / sum).max(floor));
    let sum: f64 = p.iter().sum();
    p.iter_mut().for_each(|p| *p /= sum);
}

/// Returns the bit of a part of a cell.
fn bit(part: Cell) -> u64 {
    1 << (part.y.rem_euclid(PARTS) * PARTS + part.x.rem_euclid(PARTS))
}

#[cfg(test)]
mod tests;
