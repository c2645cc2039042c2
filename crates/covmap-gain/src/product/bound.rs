//! Upper bounds of E\[I\], as far as is probed: what a decision need not evaluate.
//!
//! Imagined readings are put into families: in front of the end, by the band of distance of the
//! cell and that of the end; at the end and behind it, by that of the end; and no echo. For each
//! family every cell keeps its *potential*: a gain that no reading of the family exceeds, as far as
//! that is probed. The bound of a beam is Eq. (14) with potentials in place of gains, and has a
//! tenth of its terms.
//!
//! A potential is the largest gain of a few members of the family, with a margin. Members and
//! margin are found when the tables are built, on histograms of all kinds, as the nodes of an
//! interpolation are ([`Probes`]). That is no proof: of a histogram that no probe is like a gain may
//! be above its bound, and on coarse grids, of few ranges, some are. A decision that meets one
//! evaluates all of its candidates.

use super::sweep::add_product;
use super::tables::evidence::{Evidence, Reading, to_f32};
use super::tables::interpolation::Probes;
use crate::Stencil;
use crate::belief::{Cells, Prior};
use crate::memory::Size;
use crate::sight::{Ahead, Cone, Wide, as_f64, lanes};
use crate::view_points::groups;
use covmap::Grid;
use covmap::lanes::{LANES, Lanes};
use covmap_model::{Outcome, SensorModel};
use pulp::Arch;
use rayon::prelude::*;

/// Distances up to the usable range are put into so many bands.
const BANDS: usize = 4;
/// No member of a family gains more than this times the largest of those that are evaluated, in
/// any of the probes. With 1.05 a histogram was met whose gain is above its bound.
const MARGIN: f64 = 1.15;
/// Histograms that were not probed may exceed that by this factor.
const CAUTION: f64 = 1.02;
/// What is added to every potential, in units of a gain that matters: where gains nearly cancel, a
/// factor is no margin.
const SLACK: f64 = 4e-3;

/// Readings that have one potential.
#[derive(Debug, Clone)]
struct Family {
    readings: Vec<Reading>,
    margin: f32,
    slack: f32,
}

/// The potentials of all cells.
#[derive(Debug, Clone)]
pub(crate) struct Potentials {
    grid: Grid,
    /// Front, by bands of cell and end, those without members too; near, by band of the end; no
    /// echo.
    families: Vec<Family>,
    /// The band of every range.
    bands: Vec<usize>,
    /// For each family the cells, with a border as in [`Cells`].
    rasters: Vec<Vec<f32>>,
}

/// The place of a family.
fn front(cell: usize, end: usize) -> usize {
    cell * BANDS + end
}
fn near(end: usize) -> usize {
    BANDS * BANDS + end
}
const NO_ECHO: usize = BANDS * BANDS + BANDS;

impl Potentials {
    pub(crate) fn new(model: &SensorModel, stencil: &Stencil, grid: Grid, cells: &Cells) -> Self {
        let ranges = &stencil.ranges;
        let band = |k: usize| (k * BANDS / ranges.len()).min(BANDS - 1);
        let bands: Vec<usize> = (0..ranges.len()).map(band).collect();
        let probes = Probes::of_model(model);
        let families = families(model, ranges, &bands);
        let families: Vec<Family> =
            families.into_iter().map(|members| Family::new(members, &probes)).collect();
        let raster = |family: &Family| {
            let cells = if family.readings.is_empty() { 0 } else { cells.limits().len() };
            vec![0.0; cells]
        };
        let rasters = families.iter().map(raster).collect();
        Self { grid, families, bands, rasters }
    }

    /// About how many bytes this takes: of the bands in front only those that end farther away
    /// than the cell have members.
    pub(crate) fn bytes(size: &Size) -> f64 {
        const FAMILIES: usize = BANDS * (BANDS + 1) / 2 + BANDS + 1;
        4.0 * as_f64(FAMILIES) * size.bordered()
    }

    /// Computes the potentials of blocks of cells that changed.
    pub(crate) fn update(&mut self, arch: Arch, cells: &Cells, changed: &[usize]) {
        let (width, per_row) = (self.grid.width(), groups(&self.grid));
        let families = self.families.par_iter().zip(&mut self.rasters);
        families.filter(|(family, _)| !family.readings.is_empty()).for_each(|(family, raster)| {
            for block in changed {
                let (x, y) = (block % per_row * LANES, block / per_row);
                let (at, count) = (cells.bordered(y * width + x), LANES.min(width - x));
                let potential = arch.dispatch(
                    #[inline(always)]
                    || family.potential(&cells.block(*block)),
                );
                raster[at..at + count].copy_from_slice(&potential[..count]);
            }
        });
    }

    /// An upper bound, as far as is probed, of a beam's part of E\[I\] from neighbouring view-points.
    #[inline(always)]
    pub(crate) fn bound(&self, cone: &Cone, here: usize, ahead: &Ahead) -> Lanes {
        let mut bound = [0.0; LANES];
        let beam = cone.beam();
        // What ends beyond the present ring, by band.
        let mut beyond = [[0.0; LANES]; BANDS];
        let mut is_beyond = [false; BANDS];
        let mut echoes = ahead.echoes().iter().rev().peekable();
        let farthest = ahead.echoes().last().map_or(0, |(k, _)| *k);
        for ring in (0..farthest).rev() {
            while let Some((k, p)) = echoes.next_if(|(k, _)| *k > ring) {
                is_beyond[self.bands[*k]] = true;
                let (beyond, p) = (&mut beyond[self.bands[*k]], narrow(p));
                for lane in 0..LANES {
                    beyond[lane] += p[lane];
                }
            }
            let cells = beam.rings[ring].start..beam.rings[ring + 1].start;
            for band in (0..BANDS).filter(|band| is_beyond[*band]) {
                let raster = &self.rasters[front(self.bands[ring], band)];
                let sum = sum(raster, cone, cells.clone(), here);
                add_product(&mut bound, &beyond[band], &sum);
            }
        }
        for (k, p) in ahead.echoes() {
            let cells = beam.rings[*k].start..beam.echo_reach[*k].max(beam.rings[*k].start);
            let sum = sum(&self.rasters[near(self.bands[*k])], cone, cells, here);
            add_product(&mut bound, &narrow(p), &sum);
        }
        if beam.no_echo_reach > 0 {
            let sum = sum(&self.rasters[NO_ECHO], cone, 0..beam.no_echo_reach, here);
            add_product(&mut bound, &narrow(ahead.no_echo()), &sum);
        }
        bound
    }
}

impl Family {
    /// The potential of the cells of a block.
    #[inline(always)]
    fn potential(&self, prior: &Prior<'_>) -> Lanes {
        let mut potential = [0.0; LANES];
        for reading in &self.readings {
            let gain = reading.gain(prior);
            for lane in 0..LANES {
                potential[lane] =
                    if gain[lane] > potential[lane] { gain[lane] } else { potential[lane] };
            }
        }
        for (potential, changeable) in potential.iter_mut().zip(prior.changeable) {
            *potential = changeable * (*potential * self.margin + self.slack);
        }
        potential
    }

    /// The corners of the family, and as few of the other members as the margin allows: one after
    /// the other the one that exceeds the potential by most.
    fn new(members: Members, probes: &Probes) -> Self {
        let Members { corners, others: members } = members;
        let gains: Vec<Vec<f64>> = members.iter().map(|member| probes.gains(member)).collect();
        let slack = SLACK * probes.scale();
        let count = gains.first().map_or(0, Vec::len);
        let mut largest = vec![0.0f64; count];
        let mut readings = Vec::new();
        for corner in &corners {
            readings.push(corner.reading());
            largest.iter_mut().zip(probes.gains(corner)).for_each(|(l, gain)| *l = l.max(gain));
        }
        loop {
            // How many times as large as allowed the gain of a member is, for the worst probe.
            let excess = |gains: &Vec<f64>| {
                let one =
                    |(gain, largest): (&f64, &f64)| (gain - slack) / (MARGIN * largest).max(1e-12);
                gains.iter().zip(&largest).map(one).fold(0.0, f64::max)
            };
            let worst = gains.iter().map(excess).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((member, _)) = worst.filter(|(_, excess)| *excess > 1.0) else { break };
            readings.push(members[member].reading());
            largest.iter_mut().zip(&gains[member]).for_each(|(l, gain)| *l = l.max(*gain));
        }
        Self { readings, margin: to_f32(MARGIN * CAUTION), slack: to_f32(CAUTION * slack) }
    }
}

/// Some members of a family, near enough to each other to stand for those between them.
#[derive(Debug, Clone, Default)]
struct Members {
    /// Those at its edges: a gain that changes little within the family is largest at one of them,
    /// also where it is next to nothing.
    corners: Vec<Evidence>,
    others: Vec<Evidence>,
}

impl Members {
    fn add(&mut self, member: Evidence, is_corner: bool) {
        if is_corner { &mut self.corners } else { &mut self.others }.push(member);
    }
}

/// Members of all families.
fn families(model: &SensorModel, ranges: &[f64], bands: &[usize]) -> Vec<Members> {
    let (half, behind) = (0.5 * model.resolution(), model.parameters().update.behind());
    // Shifted by a quarter of its width, a Gaussian gains about the same.
    let sigma_in = model.parameters().update.product().map_or(1.0, |product| product.sigma_in);
    #[allow(clippy::cast_possible_truncation, reason = "below 257")]
    let shifts = (2.0 / sigma_in).ceil().clamp(8.0, 256.0) as i32;
    let mut families = vec![Members::default(); NO_ECHO + 1];
    let echo = |distance: f64, k: usize| Evidence::new(model, distance, Outcome::Echo(ranges[k]));
    // In a band, its first, last and middle ring; and the second: at the sensor itself half of what
    // ends there is no distance.
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
                            families[front(cell, end)].add(echo(distance, *k), is_corner);
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
                    families[near(end)].add(echo(distance, *k), is_corner);
                }
            }
        }
    }
    for step in 0..=8 {
        let distance = model.reach(Outcome::NoEcho) * f64::from(step) / 8.0;
        let evidence = Evidence::new(model, distance, Outcome::NoEcho);
        families[NO_ECHO].add(evidence, step % 4 == 0);
    }
    families
}

/// Σ of the potentials of some of a beam's cells.
#[inline(always)]
fn sum(raster: &[f32], cone: &Cone, cells: std::ops::Range<usize>, here: usize) -> Lanes {
    let mut sum = [0.0; LANES];
    for offset in &cone.offsets()[cells] {
        let potential: &Lanes = lanes(raster, here, *offset);
        for lane in 0..LANES {
            sum[lane] += potential[lane];
        }
    }
    sum
}

/// Probabilities, as gains are kept.
#[inline(always)]
fn narrow(probabilities: &Wide) -> Lanes {
    let mut narrow = [0.0; LANES];
    for lane in 0..LANES {
        #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
        (narrow[lane] = probabilities[lane] as f32);
    }
    narrow
}
