//! The map: a posterior over the coverage of every cell.

mod block;

pub use block::EvidenceBlock;

use crate::histogram::{MAX_BINS, MIN_BINS, PROBABILITY_FLOOR, mode_bin, product};
use crate::{Cell, Grid, Histogram, Raster, bin_coverage};
use block::entropy;

/// Reason why a map cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The number of bins is out of range.
    #[error("{0} bins: a histogram has {MIN_BINS} to {MAX_BINS}")]
    Bins(usize),
}

/// The change of one cell by one measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The cell whose posterior changed.
    pub cell: Cell,
    /// Entropy of the posterior before \[nats\].
    pub before: f64,
    /// Entropy of the posterior after \[nats\].
    pub after: f64,
}

/// The kind of evidence on a cell so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EvidenceKind {
    /// No measurement touched the cell: its posterior is the uniform prior.
    Unknown,
    /// A measurement touched the cell.
    Measured,
    /// The robot's body filled the cell: the cell is free, for good.
    Pinned,
}

/// A coverage map: for each cell of a grid a posterior over n coverages.
///
/// All cells start UNKNOWN, with a uniform posterior: the only prior that the step to Eq. (6) allows.
/// [`is_known`] tells whether a cell is still unknown, since the mode of a uniform posterior is a tie.
///
/// Posteriors are stored as f32; [`multiply`] computes in f64, [`multiply_block`] in f32.
///
/// [`is_known`]: CoverageMap::is_known
/// [`multiply`]: CoverageMap::multiply
/// [`multiply_block`]: CoverageMap::multiply_block
#[derive(Debug, Clone, PartialEq)]
pub struct CoverageMap {
    pub(crate) grid: Grid,
    pub(crate) bins: usize,
    pub(crate) posterior: Vec<f32>,
    pub(crate) evidence: Vec<EvidenceKind>,
    // Derived from the posterior, and kept because every caller asks for them:
    pub(crate) entropy: Vec<f32>,
    pub(crate) mode_bin: Vec<u8>,
}

impl CoverageMap {
    /// Creates a map in which every cell is unknown.
    ///
    /// # Errors
    /// If the number of bins is not in 2..=64.
    pub fn new(grid: Grid, bins: usize) -> Result<Self, MapError> {
        if !(MIN_BINS..=MAX_BINS).contains(&bins) {
            return Err(MapError::Bins(bins));
        }
        let uniform = Histogram::uniform(bins);
        #[allow(clippy::cast_possible_truncation, reason = "probabilities are stored as f32")]
        let p = uniform.probabilities()[0] as f32;
        Ok(Self {
            grid,
            bins,
            posterior: vec![p; grid.len() * bins],
            evidence: vec![EvidenceKind::Unknown; grid.len()],
            entropy: vec![entropy(&vec![p; bins]); grid.len()],
            mode_bin: vec![0; grid.len()],
        })
    }

    /// Creates the map with given posteriors, and computes the derived values.
    pub(crate) fn from_parts(
        grid: Grid,
        bins: usize,
        posterior: Vec<f32>,
        evidence: Vec<EvidenceKind>,
    ) -> Result<Self, MapError> {
        let mut map = Self::new(grid, bins)?;
        map.posterior = posterior;
        map.evidence = evidence;
        for index in 0..grid.len() {
            if map.evidence[index] != EvidenceKind::Unknown {
                map.refresh(index);
            }
        }
        Ok(map)
    }

    /// Returns the number of bytes of a map.
    pub fn bytes(grid: &Grid, bins: usize) -> u64 {
        // A posterior in f32, and one evidence, one entropy and one mode.
        let by_cell = bins.saturating_mul(size_of::<f32>()).saturating_add(1 + 4 + 1);
        u64::try_from(grid.len().saturating_mul(by_cell)).unwrap_or(u64::MAX)
    }

    /// Returns the geometry of the map.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the number of bins, n.
    pub fn bins(&self) -> usize {
        self.bins
    }

    fn index(&self, cell: Cell) -> usize {
        self.grid.index(cell).unwrap_or_else(|| panic!("{cell:?} lies outside the map"))
    }

    /// Returns whether a measurement or the robot's body has touched the cell.
    ///
    /// # Panics
    /// This and the methods below panic if the cell lies outside the grid.
    pub fn is_known(&self, cell: Cell) -> bool {
        self.evidence[self.index(cell)] != EvidenceKind::Unknown
    }

    /// Returns whether the cell is free for good, because the robot stood there.
    pub fn is_pinned(&self, cell: Cell) -> bool {
        self.evidence[self.index(cell)] == EvidenceKind::Pinned
    }

    /// Returns the posterior p(c_l) of a cell: uniform if the cell is unknown.
    pub fn histogram(&self, cell: Cell) -> Histogram {
        let mut weights = [0.0; MAX_BINS];
        self.read_posterior(cell, &mut weights[..self.bins]);
        Histogram::from_weights(&weights[..self.bins])
            .unwrap_or_else(|| Histogram::uniform(self.bins))
    }

    /// Writes the stored probability of each bin of a cell to `out`.
    ///
    /// # Panics
    /// Also if `out` does not have one place for each bin.
    pub fn read_posterior(&self, cell: Cell, out: &mut [f64]) {
        let start = self.index(cell) * self.bins;
        assert_eq!(out.len(), self.bins, "one place for each bin");
        for (o, p) in out.iter_mut().zip(&self.posterior[start..start + self.bins]) {
            *o = f64::from(*p);
        }
    }

    /// Returns the entropy of a cell's posterior, Eq. (11) \[nats\].
    pub fn entropy(&self, cell: Cell) -> f64 {
        f64::from(self.entropy[self.index(cell)])
    }

    /// Returns the most likely coverage of a cell: the maximum likelihood map of section 3. A tie goes to the
    /// lower coverage, so the mode of an unknown cell is 0; [`Self::is_known`] tells the two apart.
    pub fn mode(&self, cell: Cell) -> f64 {
        bin_coverage(usize::from(self.mode_bin[self.index(cell)]), self.bins)
    }

    /// Returns the expected coverage of a cell.
    pub fn mean(&self, cell: Cell) -> f64 {
        self.histogram(cell).mean()
    }

    /// Returns the central interval of a cell's coverage with probability `level`.
    pub fn credible_interval(&self, cell: Cell, level: f64) -> (f64, f64) {
        self.histogram(cell).credible_interval(level)
    }

    /// Returns the most likely coverage of every cell; `None` for an unknown cell.
    pub fn maximum_likelihood(&self) -> Raster<Option<f64>> {
        Raster::from_fn(self.grid, |cell| self.is_known(cell).then(|| self.mode(cell)))
    }

    /// Returns the entropy of every cell \[nats\].
    pub fn entropy_map(&self) -> Raster<f64> {
        Raster::from_fn(self.grid, |cell| self.entropy(cell))
    }

    /// Multiplies the evidence of one measurement into the posterior of a cell, Eq. (8), and normalises the
    /// posterior over the floor [`PROBABILITY_FLOOR`]. The evidence has one weight for each bin.
    ///
    /// Returns the change; `None` if the cell is pinned, or the stored posterior of a known cell
    /// stays the same to the last bit, or the evidence is impossible (no bin is left with any
    /// weight). Impossible evidence is ignored.
    ///
    /// # Panics
    /// Also if there is not one weight for each bin.
    pub fn multiply(&mut self, cell: Cell, evidence: &[f64]) -> Option<Change> {
        let index = self.index(cell);
        if self.evidence[index] == EvidenceKind::Pinned {
            return None;
        }
        let (mut prior, mut posterior) = ([0.0; MAX_BINS], [0.0; MAX_BINS]);
        let (prior, posterior) = (&mut prior[..self.bins], &mut posterior[..self.bins]);
        self.read_posterior(cell, prior);
        let z = product(prior, evidence, posterior);
        if !(z.is_finite() && z > 0.0) {
            return None;
        }
        posterior.iter_mut().for_each(|p| *p /= z);
        self.store(cell, index, posterior, EvidenceKind::Measured)
    }

    /// Declares that a cell is free, for good: the body of the robot was there and touched nothing.
    /// All of the cell's probability but the floor goes to coverage 0, and no later measurement
    /// changes the cell. Returns the change, if there is one.
    pub fn pin_free(&mut self, cell: Cell) -> Option<Change> {
        let index = self.index(cell);
        let mut free = [0.0; MAX_BINS];
        free[0] = 1.0;
        self.store(cell, index, &mut free[..self.bins], EvidenceKind::Pinned)
    }

    fn store(
        &mut self,
        cell: Cell,
        index: usize,
        posterior: &mut [f64],
        evidence: EvidenceKind,
    ) -> Option<Change> {
        posterior.iter_mut().for_each(|p| *p = p.max(PROBABILITY_FLOOR));
        let sum: f64 = posterior.iter().sum();
        let stored = &mut self.posterior[index * self.bins..(index + 1) * self.bins];
        let mut changed = self.evidence[index] != evidence;
        for (s, p) in stored.iter_mut().zip(posterior.iter()) {
            #[allow(clippy::cast_possible_truncation, reason = "probabilities are stored as f32")]
            let new = (p / sum) as f32;
            changed |= s.to_bits() != new.to_bits();
            *s = new;
        }
        if !changed {
            return None;
        }
        self.evidence[index] = evidence;
        let before = f64::from(self.entropy[index]);
        self.refresh(index);
        Some(Change { cell, before, after: f64::from(self.entropy[index]) })
    }

    pub(crate) fn refresh(&mut self, index: usize) {
        let p = &self.posterior[index * self.bins..(index + 1) * self.bins];
        self.entropy[index] = entropy(p);
        #[allow(clippy::cast_possible_truncation, reason = "at most 64 bins")]
        (self.mode_bin[index] = mode_bin(p) as u8);
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use nalgebra::Point2;
    use proptest::prelude::*;

    fn map(bins: usize) -> CoverageMap {
        CoverageMap::new(Grid::new(Point2::origin(), 0.1, 3, 2).unwrap(), bins).unwrap()
    }

    #[test]
    fn all_cells_start_unknown_and_uniform() {
        let map = map(11);
        assert!(map.grid().cells().all(|c| !map.is_known(c) && map.mode(c) == 0.0));
        assert!((map.entropy(Cell::new(2, 1)) - libm::log(11.0)).abs() < 1e-6);
        assert_eq!(map.maximum_likelihood().values(), &[None; 6]);
    }

    #[test]
    fn evidence_can_turn_a_cell_round() {
        let mut map = map(11);
        let cell = Cell::new(1, 1);
        let ramp: Vec<f64> = (0..11).map(|k| 1.0 + f64::from(k)).collect();
        let fall: Vec<f64> = ramp.iter().rev().copied().collect();
        for _ in 0..10_000 {
            map.multiply(cell, &ramp);
        }
        assert_eq!(map.mode(cell), 1.0);
        for _ in 0..20 {
            map.multiply(cell, &fall);
        }
        assert_eq!(map.mode(cell), 0.0);
    }

    #[test]
    fn a_cell_where_the_robot_stood_stays_free() {
        let mut map = map(11);
        let cell = Cell::new(0, 0);
        let change = map.pin_free(cell).unwrap();
        assert!(change.before > 2.0 && change.after < 1e-3);
        assert_eq!(map.multiply(cell, &[1.0; 11]), None);
        assert_eq!(map.pin_free(cell), None);
        assert!(map.is_pinned(cell) && map.is_known(cell) && map.mode(cell) == 0.0);
    }

    #[test]
    fn impossible_evidence_counts_for_nothing() {
        let mut map = map(3);
        assert_eq!(map.multiply(Cell::new(0, 0), &[0.0; 3]), None);
        assert_eq!(map.multiply(Cell::new(0, 0), &[f64::NAN, 1.0, 1.0]), None);
        assert!(!map.is_known(Cell::new(0, 0)));
    }

    proptest! {
        #[test]
        fn posteriors_sum_to_one_and_keep_their_floor(
            updates in prop::collection::vec(prop::collection::vec(1e-9..1.0f64, 7), 1..40)
        ) {
            let mut map = map(7);
            let cell = Cell::new(2, 0);
            for evidence in &updates {
                map.multiply(cell, evidence);
                let mut p = [0.0; 7];
                map.read_posterior(cell, &mut p);
                prop_assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-6);
                prop_assert!(p.iter().all(|p| *p >= PROBABILITY_FLOOR * (1.0 - 1e-6)));
                prop_assert!((map.entropy(cell) - map.histogram(cell).entropy()).abs() < 1e-6);
            }
        }

        #[test]
        fn the_order_of_measurements_does_not_matter(
            mut updates in prop::collection::vec(prop::collection::vec(0.2..1.0f64, 5), 2..8)
        ) {
            let integrate = |updates: &[Vec<f64>]| {
                let mut map = map(5);
                for evidence in updates {
                    map.multiply(Cell::new(1, 0), evidence);
                }
                map.histogram(Cell::new(1, 0))
            };
            let forth = integrate(&updates);
            updates.reverse();
            for (a, b) in forth.probabilities().iter().zip(integrate(&updates).probabilities()) {
                prop_assert!((a - b).abs() < 1e-5);
            }
        }
    }
}
