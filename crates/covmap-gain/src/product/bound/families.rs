//! Families of imagined readings, and the members that bound all others.
//!
//! The distances up to the usable range are cut into [`BANDS`]. There is a family of the cells in
//! front of the end for each band of the cell and each band of the end; one of the cells at the end
//! and behind it for each band of the end; and one of no echo.

use crate::belief::BlockPrior;
use crate::evidence::{BinEvidence, ExcessEvidence};
use crate::numbers::to_f32;
use crate::probes::ProbeHistograms;
use covmap::lanes::{LANES, Lanes};
use covmap_model::{Outcome, SensorModel};

/// The number of bands into which distances up to the usable range are put.
pub(super) const BANDS: usize = 4;
/// Largest gain of a member of a family in any probe, in units of the largest gain of the members
/// that are evaluated. With 1.05 a histogram was met whose gain is above its bound.
const MARGIN: f64 = 1.15;
/// Histograms that were not probed may exceed that by this factor.
const CAUTION: f64 = 1.02;
/// Addition to every ceiling, in units of a gain that matters: where gains nearly cancel, a factor
/// is no margin.
const SLACK: f64 = 4e-3;

/// Returns the family of cells in front of the end, by the bands of both. It is empty if the cell's
/// band is farther away.
pub(super) fn in_front(cell: usize, end: usize) -> usize {
    cell * BANDS + end
}

/// Returns the family of cells at the end or behind it, by the band of the end.
pub(super) fn near_end(end: usize) -> usize {
    BANDS * BANDS + end
}

/// The family of no echo.
pub(super) const NO_ECHO: usize = BANDS * BANDS + BANDS;

/// Readings that have one ceiling.
#[derive(Debug, Clone)]
pub(super) struct ReadingFamily {
    /// The members that are evaluated.
    pub(super) readings: Vec<ExcessEvidence>,
    margin: f32,
    slack: f32,
}

impl ReadingFamily {
    /// Returns the ceiling of each cell of a block.
    #[inline(always)]
    pub(super) fn ceiling(&self, prior: &BlockPrior<'_>) -> Lanes {
        let mut ceiling = [0.0; LANES];
        for reading in &self.readings {
            let gain = reading.gain(prior);
            for lane in 0..LANES {
                ceiling[lane] = if gain[lane] > ceiling[lane] { gain[lane] } else { ceiling[lane] };
            }
        }
        for (ceiling, changeable) in ceiling.iter_mut().zip(prior.changeable) {
            *ceiling = changeable * (*ceiling * self.margin + self.slack);
        }
        ceiling
    }

    /// Creates a family of its corners and as few of the other members as the margin allows. Each
    /// step adds the member that exceeds the ceiling by most.
    pub(super) fn new(members: FamilyMembers, probes: &ProbeHistograms) -> Self {
        let FamilyMembers { corners, others: members } = members;
        let gains: Vec<Vec<f64>> = members.iter().map(|member| probes.gains(member)).collect();
        let slack = SLACK * probes.scale();
        let count = gains.first().map_or(0, Vec::len);
        let mut largest = vec![0.0f64; count];
        let mut readings = Vec::new();
        for corner in &corners {
            readings.push(corner.excess());
            largest.iter_mut().zip(probes.gains(corner)).for_each(|(l, gain)| *l = l.max(gain));
        }
        loop {
            // The gain of a member in units of the allowed one, for the worst probe.
            let excess = |gains: &Vec<f64>| {
                let one =
                    |(gain, largest): (&f64, &f64)| (gain - slack) / (MARGIN * largest).max(1e-12);
                gains.iter().zip(&largest).map(one).fold(0.0, f64::max)
            };
            let worst = gains.iter().map(excess).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((member, _)) = worst.filter(|(_, excess)| *excess > 1.0) else { break };
            readings.push(members[member].excess());
            largest.iter_mut().zip(&gains[member]).for_each(|(l, gain)| *l = l.max(*gain));
        }
        Self { readings, margin: to_f32(MARGIN * CAUTION), slack: to_f32(CAUTION * slack) }
    }
}

/// Some members of a family, near enough to each other to stand for those between them.
#[derive(Debug, Clone, Default)]
pub(super) struct FamilyMembers {
    /// The members at its edges: a gain that changes little within the family is largest at one of
    /// them, also where it is next to nothing.
    corners: Vec<BinEvidence>,
    others: Vec<BinEvidence>,
}

impl FamilyMembers {
    fn add(&mut self, member: BinEvidence, is_corner: bool) {
        if is_corner { &mut self.corners } else { &mut self.others }.push(member);
    }
}

/// Returns the members of all families. `bands` has the band of every range.
pub(super) fn families(model: &SensorModel, ranges: &[f64], bands: &[usize]) -> Vec<FamilyMembers> {
    let (half, behind) = (0.5 * model.resolution(), model.parameters().update.behind());
    // Shifted by a quarter of its width, a Gaussian gains about the same.
    let sigma_in = model.parameters().update.product().map_or(1.0, |product| product.sigma_in);
    #[allow(clippy::cast_possible_truncation, reason = "below 257")]
    let shifts = (2.0 / sigma_in).ceil().clamp(8.0, 256.0) as i32;
    let mut families = vec![FamilyMembers::default(); NO_ECHO + 1];
    let echo =
        |distance: f64, k: usize| BinEvidence::new(model, distance, Outcome::Echo(ranges[k]));
    // The first, second, middle and last ring of a band. The second counts because half of the
    // first ring, at the sensor itself, has no distance.
    let band = |band: usize| {
        let rings: Vec<usize> = (0..ranges.len()).filter(|k| bands[*k] == band).collect();
        let (first, last) = (rings.first().copied(), rings.last().copied());
        let middle = rings.get(rings.len() / 2).copied();
        let second = rings.get(1).copied();
        let mut some: Vec<usize> = [first, second, middle, last].into_iter().flatten().collect();
        some.sort_unstable();
        some.dedup();
        some
    };
    for end in 0..BANDS {
        let ends = band(end);
        let is_edge = |rings: &[usize], i: usize| i == 0 || i + 1 == rings.len();
        for cell in 0..=end {
            let rings = band(cell);
            for (i, k) in ends.iter().enumerate() {
                for (j, ring) in rings.iter().enumerate() {
                    // Just below the border of what ends there.
                    for side in [-1.0, 0.0, 1.0 - 1e-6] {
                        let distance = (ranges[*ring] + half * side).max(0.0);
                        if distance < ranges[*k] - half {
                            let outermost = if j == 0 { side < 0.0 } else { side > 0.0 };
                            let is_corner = is_edge(&ends, i) && is_edge(&rings, j) && outermost;
                            families[in_front(cell, end)].add(echo(distance, *k), is_corner);
                        }
                    }
                }
            }
        }
        for (i, k) in ends.iter().enumerate() {
            // On either side of both borders rounding decides whether a cell is at the end.
            let borders =
                [-1.0 - 1e-6, 1.0 + 1e-6].map(|side| (ranges[*k] + half * side, is_edge(&ends, i)));
            let at_end = (-shifts..=shifts).map(|step| {
                let distance = ranges[*k] + half * f64::from(step) / f64::from(shifts);
                (distance, step % 6 == 0 && (is_edge(&ends, i) || *k == 1))
            });
            let behind = (1..=4).map(|step| {
                (ranges[*k] + half + behind * f64::from(step) / 4.0, step == 4 && is_edge(&ends, i))
            });
            for (distance, is_corner) in borders.into_iter().chain(at_end).chain(behind) {
                if distance >= 0.0 {
                    families[near_end(end)].add(echo(distance, *k), is_corner);
                }
            }
        }
    }
    for step in 0..=8 {
        let distance = model.reach(Outcome::NoEcho) * f64::from(step) / 8.0;
        let evidence = BinEvidence::new(model, distance, Outcome::NoEcho);
        families[NO_ECHO].add(evidence, step % 4 == 0);
    }
    families
}
