//! A baseline: a forward update of the same histograms, as confidence-rich mapping does it.
//!
//! Its maps serve comparison only: the robot's own belief changes in `covmap-model` alone.

use super::prior_probability;
use covmap::{Cell, Change, CoverageMap, Grid, bin_coverage};
use covmap_model::{ModelError, Outcome, SensorModel};
use covmap_sonar::Scan;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The parameters of the forward update.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crm {
    /// Standard deviation of an echo's range about the distance of its cause \[m\].
    pub range_noise: f64,
    /// The share of echoes that come from anywhere, uniform over the usable range.
    pub outlier: f64,
    /// The probability that a surface that stops the beam is not heard: the sound is turned away,
    /// and the reading is no echo or one from beyond the usable range.
    pub lost: f64,
    /// The prior of a cell: this share is uniform over the bins, the rest is coverage 0.
    pub prior: f64,
    /// Exponent on a cell's share of its ring: with 0 any full cell of a ring stops the beam, with
    /// 1 it does so with the cell's share of the ring's width.
    pub spread: f64,
    /// Exponent ≤ 1 on the evidence of one reading, as that of Eq. (9).
    pub tempering: f64,
}

impl Default for Crm {
    /// 5 cm, 5 % outliers, 20 % lost; a prior with half of its mass at 0; spread and tempering ½.
    fn default() -> Self {
        Self {
            range_noise: 0.05,
            outlier: 0.05,
            lost: 0.2,
            prior: 0.5,
            spread: 0.5,
            tempering: 0.5,
        }
    }
}

impl Crm {
    /// # Errors
    /// If a parameter is not in its interval: noise [1e-3, 10] m, outlier and lost
    /// [1e-6, 1], prior [1e-3, 1], spread [0, 1], tempering [1e-3, 1].
    pub(crate) fn validate(&self) -> Result<(), ModelError> {
        let within = ModelError::within;
        within("crm.range_noise", self.range_noise, 1e-3, 10.0)?;
        within("crm.outlier", self.outlier, 1e-6, 1.0)?;
        within("crm.lost", self.lost, 1e-6, 1.0)?;
        within("crm.prior", self.prior, 1e-3, 1.0)?;
        within("crm.spread", self.spread, 0.0, 1.0)?;
        within("crm.tempering", self.tempering, 1e-3, 1.0)
    }

    /// Integrates a scan into a map. The map before a beam explains the beam, so that their order
    /// matters. Returns the changes.
    ///
    /// # Panics
    /// If the scan does not fit the model's ring.
    pub(crate) fn integrate(
        &self,
        model: &SensorModel,
        map: &mut CoverageMap,
        scan: &Scan,
    ) -> Vec<Change> {
        assert_eq!(scan.ranges.len(), model.footprint().beams(), "one reading for each beam");
        let (mut changes, mut rings) = (Vec::new(), Rings::default());
        for (beam, range) in scan.ranges.iter().enumerate() {
            let Some(outcome) = model.outcome(*range) else { continue };
            rings.gather(model, map.grid(), scan, beam, outcome);
            changes.extend(self.update(model, map, &mut rings, outcome));
        }
        changes
    }

    /// Multiplies one reading z into the cells of its beam: the sensor cause model of
    /// Agha-mohammadi et al. (2019), for a cone.
    ///
    /// ```text
    /// q_k = 1 − Π_i (1 − s_i ρ_i)     the beam ends in ring k, having come there
    /// p(z | c) = A_k + S_k·L_k + S_k·o·(1 − s·c)·(T_k − L_k)
    /// ```
    ///
    /// for a cell of ring k. It is linear in the cell's coverage c, with all other cells at their
    /// means ρ. s is the cell's share of its ring to the power `spread`; o is Π (1 − s_i ρ_i) of
    /// the ring's other cells; `A_k` is the likelihood of z being caused before the ring, `S_k` the
    /// probability that the beam comes to it, `L_k` the likelihood of z if it is caused there,
    /// `T_k` that of z if the beam goes on. An echo adds a uniform share of outliers to p.
    ///
    /// Choice: any cell of a ring can stop the beam; with a sum of weights, as in the range
    /// likelihood of the planner, a wide ring could hardly be free in one cell only.
    fn update(
        &self,
        model: &SensorModel,
        map: &mut CoverageMap,
        rings: &mut Rings,
        outcome: Outcome,
    ) -> Vec<Change> {
        let (bins, tempering) = (map.bins(), self.tempering);
        let keep = self.keep(map, rings);
        let heard = |k: usize| self.heard(outcome, ring_distance(k, model.resolution()));
        let onwards = self.onwards(&keep, outcome, heard);
        let outlier = match outcome {
            Outcome::Echo(_) => self.outlier,
            Outcome::Beyond(_) | Outcome::NoEcho => 0.0,
        };
        let background = outlier / model.parameters().usable_range;
        let (mut evidence, mut changes) = (vec![0.0; bins], Vec::new());
        let (mut before, mut survival, mut first) = (0.0, 1.0, 0);
        for (k, keep) in keep.iter().enumerate() {
            let end = first + rings.cells[first..].iter().take_while(|c| c.ring == k).count();
            let (l, t) = (heard(k), onwards[k]);
            for cell in &rings.cells[first..end] {
                let others = keep / (1.0 - cell.stops);
                for (bin, e) in evidence.iter_mut().enumerate() {
                    let passes = others * (1.0 - cell.share * bin_coverage(bin, bins));
                    let p = before + survival * (l + passes * (t - l));
                    let p = ((1.0 - outlier) * p + background).max(f64::MIN_POSITIVE);
                    *e = if tempering < 1.0 { libm::exp(tempering * libm::log(p)) } else { p };
                }
                if !map.is_known(cell.cell) {
                    evidence
                        .iter_mut()
                        .enumerate()
                        .for_each(|(b, e)| *e *= prior_probability(self.prior, b, bins));
                }
                let largest = evidence.iter().fold(f64::MIN_POSITIVE, |a, e| a.max(*e));
                evidence.iter_mut().for_each(|e| *e /= largest);
                changes.extend(map.multiply(cell.cell, &evidence));
            }
            before += survival * (1.0 - keep) * l;
            survival *= keep;
            first = end;
        }
        changes
    }

    /// Sets the probability with which each cell stops the beam, and returns 1 − q of every ring.
    fn keep(&self, map: &CoverageMap, rings: &mut Rings) -> Vec<f64> {
        let bins = map.bins();
        let unknown: f64 =
            (0..bins).map(|k| prior_probability(self.prior, k, bins) * bin_coverage(k, bins)).sum();
        let mut keep = vec![1.0; rings.cells.last().map_or(0, |c| c.ring + 1)];
        let mut width = vec![0_u32; keep.len()];
        rings.cells.iter().for_each(|c| width[c.ring] += 1);
        let mut posterior = vec![0.0; bins];
        for c in &mut rings.cells {
            let mean = if map.is_known(c.cell) {
                map.read_posterior(c.cell, &mut posterior);
                crate::class_score::mean(&posterior)
            } else {
                unknown
            };
            c.share = libm::pow(1.0 / f64::from(width[c.ring]), self.spread);
            // Below 1, so that one cell can be taken out of its ring by dividing.
            c.stops = (c.share * mean).min(1.0 - 1e-9);
            keep[c.ring] *= 1.0 - c.stops;
        }
        keep
    }

    /// Returns the likelihood of z if the beam goes on beyond each ring.
    fn onwards(&self, keep: &[f64], outcome: Outcome, heard: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut onwards = vec![0.0; keep.len()];
        let mut value = match outcome {
            Outcome::Echo(_) => 0.0,
            Outcome::Beyond(_) | Outcome::NoEcho => 1.0,
        };
        for k in (0..keep.len()).rev() {
            onwards[k] = value;
            value = (1.0 - keep[k]) * heard(k) + keep[k] * value;
        }
        onwards
    }

    /// Returns the likelihood of z if the beam is stopped at a distance \[m\]; for echoes a
    /// density \[1/m\].
    fn heard(&self, outcome: Outcome, distance: f64) -> f64 {
        match outcome {
            Outcome::Echo(d) => {
                let z = (d - distance) / self.range_noise;
                let density = libm::exp(-0.5 * z * z) / (self.range_noise * (2.0 * PI).sqrt());
                (1.0 - self.lost) * density
            }
            Outcome::Beyond(_) | Outcome::NoEcho => self.lost,
        }
    }
}

/// A cell of a beam, in the ring of its distance.
#[derive(Debug, Clone, Copy)]
struct RingCell {
    ring: usize,
    cell: Cell,
    /// s: the probability that it stops the beam if it is full.
    share: f64,
    /// s·ρ: the probability that it stops the beam, as far as is known.
    stops: f64,
}

/// The cells of a beam, by rings `|d^l − k·r| ≤ r/2`; kept to save allocations.
#[derive(Debug, Default)]
struct Rings {
    cells: Vec<RingCell>,
}

impl Rings {
    fn gather(
        &mut self,
        model: &SensorModel,
        grid: &Grid,
        scan: &Scan,
        beam: usize,
        outcome: Outcome,
    ) {
        self.cells.clear();
        let reach = model.reach(outcome);
        model.footprint().for_each_cell(grid, &scan.pose, beam, reach, |covered| {
            let place = (covered.cell_distance / model.resolution()).round();
            #[allow(clippy::cast_possible_truncation, reason = "in range")]
            let ring = place as usize;
            self.cells.push(RingCell { ring, cell: covered.cell, share: 0.0, stops: 0.0 });
        });
        self.cells.sort_by_key(|c| (c.ring, c.cell));
    }
}

/// Returns the distance of a ring \[m\].
fn ring_distance(ring: usize, resolution: f64) -> f64 {
    ring as f64 * resolution
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_model::ModelParameters;
    use covmap_sonar::{Range, SonarRing};
    use nalgebra::{Isometry2, Point2};

    fn map_after(range: Range, times: usize) -> CoverageMap {
        let model = SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.1).unwrap();
        let grid = Grid::new(Point2::new(-3.0, -3.0), 0.1, 60, 60).unwrap();
        let mut ranges = vec![Range::Missing; 24];
        ranges[0] = range;
        let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges };
        let mut map = CoverageMap::new(grid, 11).unwrap();
        (0..times).for_each(|_| drop(Crm::default().integrate(&model, &mut map, &scan)));
        map
    }

    #[test]
    fn an_echo_empties_what_is_before_it_and_fills_where_it_ends() {
        let map = map_after(Range::Echo(1.0), 20);
        let at = |x, y| map.mean(map.grid().cell_at(Point2::new(x, y)).unwrap());
        let axis = |d: f64| {
            let angle = 7.5_f64.to_radians();
            at((0.25 + d) * libm::cos(angle), (0.25 + d) * libm::sin(angle))
        };
        assert!(axis(0.5) < 0.1, "{}", axis(0.5));
        assert!(axis(1.0) > 2.0 * axis(0.5), "{} {}", axis(1.0), axis(0.5));
        let behind = |m: &CoverageMap| m.mean(m.grid().cell_at(Point2::new(2.0, 0.26)).unwrap());
        assert!((behind(&map) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn no_echo_empties_cells() {
        let map = map_after(Range::NoEcho, 5);
        let cell = map.grid().cell_at(Point2::new(0.75, 0.1)).unwrap();
        assert!(map.is_known(cell) && map.mean(cell) < 0.25);
        assert!(map.grid().cells().filter(|c| map.is_known(*c)).all(|c| map.mean(c) < 0.25));
    }
}
