//! p(d | c) and V(l) of one beam from a group of view-points, side by side.
//!
//! The values are those of [`range_likelihood`](crate::range_likelihood()) and
//! [`RangeLikelihood::cells_in_sight`](crate::RangeLikelihood::cells_in_sight), to the last bit;
//! outcomes that are impossible from all view-points of the group are left out.

use crate::BeamStencil;
use crate::belief::Belief;
use crate::numbers::as_f64;
use covmap::lanes::{LANES, Lanes};

/// [`LANES`] numbers in double precision.
pub(crate) type Lanes64 = [f64; LANES];

/// Probability below which an outcome is left out of E\[I\]. Of some hundred outcomes, all of them
/// together are less than a hundredth of the tolerance of a decision.
pub const NEGLIGIBLE: f64 = 1e-9;

/// A beam over the bordered rasters of a [`Belief`]: the same from all view-points.
#[derive(Debug, Clone)]
pub(crate) struct RasterBeam {
    stencil: BeamStencil,
    /// Offsets from a view-point to each of the cells in the bordered rasters.
    offsets: Vec<isize>,
    /// d^l \[m\].
    distances: Vec<f32>,
    uniform_share: f64,
}

/// p(d | c) of one beam from a group of view-points.
#[derive(Debug, Clone)]
pub(crate) struct GroupLikelihood {
    /// k and P(k) of the echoes that are possible from any of the view-points.
    echoes: Vec<(usize, Lanes64)>,
    /// The outcome past all echoes.
    no_echo: (usize, Lanes64),
    /// Number of rings of the beam that decide: see
    /// [`RangeLikelihood::traced`](crate::RangeLikelihood).
    traced: Lanes64,
}

impl GroupLikelihood {
    pub(crate) fn new() -> Self {
        Self { echoes: Vec::new(), no_echo: (0, [0.0; LANES]), traced: [0.0; LANES] }
    }

    /// Returns k and P(k) of the possible echoes, in order.
    pub(crate) fn echoes(&self) -> &[(usize, Lanes64)] {
        &self.echoes
    }

    /// Returns the probability of no echo.
    pub(crate) fn no_echo(&self) -> &Lanes64 {
        &self.no_echo.1
    }

    /// Visits the outcomes that matter to any of some view-points, with their probabilities: 0 for
    /// the other view-points, and for those to which an outcome does not matter.
    #[inline(always)]
    pub(crate) fn for_each_likely(&self, view_points: u16, mut take: impl FnMut(usize, Lanes)) {
        let least: Lanes64 = std::array::from_fn(|lane| {
            if view_points >> lane & 1 == 1 { NEGLIGIBLE } else { f64::INFINITY }
        });
        for (k, p) in self.echoes.iter().chain([&self.no_echo]) {
            let mut likely = [0.0; LANES];
            for lane in 0..LANES {
                #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
                let narrow = p[lane] as f32;
                likely[lane] = if p[lane] > least[lane] { narrow } else { 0.0 };
            }
            if likely.iter().fold(0.0, |a: f32, b| a.max(*b)) > 0.0 {
                take(*k, likely);
            }
        }
    }
}

impl RasterBeam {
    pub(crate) fn new(beam: &BeamStencil, belief: &Belief, uniform_share: f64) -> Self {
        let width = isize::try_from(belief.raster_width()).unwrap_or(0);
        let offset = |c: &crate::StencilCell| c.dy as isize * width + c.dx as isize;
        #[allow(clippy::cast_possible_truncation, reason = "limits are f32")]
        let distances = beam.cells.iter().map(|c| c.cell_distance as f32).collect();
        Self {
            stencil: beam.clone(),
            offsets: beam.cells.iter().map(offset).collect(),
            distances,
            uniform_share,
        }
    }

    /// Returns the number of outcomes.
    pub(crate) fn outcomes(&self) -> usize {
        self.stencil.rings.len() + 1
    }

    /// Returns the cells of the beam from a view-point.
    pub(crate) fn stencil(&self) -> &BeamStencil {
        &self.stencil
    }

    /// Returns the offsets from a view-point to each of the beam's cells in the bordered rasters.
    pub(crate) fn offsets(&self) -> &[isize] {
        &self.offsets
    }

    /// Writes the likelihood of every outcome by the most likely map to `out`. This likelihood
    /// decides the sight. `here` is the index of the group's first view-point in the bordered
    /// rasters.
    #[inline(always)]
    pub(crate) fn predict(&self, belief: &Belief, here: usize, out: &mut GroupLikelihood) {
        let reflects = |offset: &isize| belief.any_reflects(here.wrapping_add_signed(*offset));
        self.predict_by(belief.reflections(), reflects, here, out);
    }

    /// Writes the likelihood of every outcome by which gains are predicted to `out`.
    #[inline(always)]
    pub(crate) fn predict_gain(&self, belief: &Belief, here: usize, out: &mut GroupLikelihood) {
        match belief.means() {
            [] => self.predict(belief, here, out),
            means => self.predict_by(means, |_| true, here, out),
        }
    }

    #[inline(always)]
    fn predict_by(
        &self,
        reflections: &[f64],
        reflects: impl Fn(&isize) -> bool,
        here: usize,
        out: &mut GroupLikelihood,
    ) {
        let rings = self.stencil.rings.len();
        let even = self.uniform_share / (as_f64(rings) + 1.0);
        let keep = 1.0 - self.uniform_share;
        let GroupLikelihood { echoes, no_echo, traced } = out;
        echoes.clear();
        *traced = [as_f64(rings); LANES];
        let mut survival = [1.0; LANES];
        for (k, ring) in self.stencil.rings.iter().enumerate() {
            let offsets = &self.offsets[ring.clone()];
            let mut q = [0.0; LANES];
            if offsets.iter().any(&reflects) {
                for (offset, weight) in offsets.iter().zip(&self.stencil.weights[ring.clone()]) {
                    let rho: &Lanes64 = at_offset(reflections, here, *offset);
                    for lane in 0..LANES {
                        q[lane] += weight * rho[lane];
                    }
                }
            }
            // In free space most rings reflect nothing: no echo from there.
            if even == 0.0 && all_zero(&q) {
                continue;
            }
            let mut p = [0.0; LANES];
            for lane in 0..LANES {
                // The weights sum to 1 but for rounding.
                let q = if q[lane] > 1.0 - 1e-12 { 1.0 } else { q[lane] };
                p[lane] = keep * survival[lane] * q + even;
                let left = survival[lane] * (1.0 - q);
                let ends = survival[lane] > 0.0 && left <= 0.0;
                traced[lane] = if ends { as_f64(k + 1) } else { traced[lane] };
                survival[lane] = left;
            }
            echoes.push((k, p));
            if even == 0.0 && all_zero(&survival) {
                break;
            }
        }
        *no_echo = (rings, survival.map(|s| keep * s + even));
    }

    /// Returns V(l) of the beam: the number of its cells in sight. An impossible echo changes no
    /// sum, and an echo from farther away covers its cells, too.
    #[inline(always)]
    pub(crate) fn in_sight(&self, likelihood: &GroupLikelihood) -> [u16; LANES] {
        const LIKELY: f64 = 0.5 - 1e-12;
        let (mut tail, mut seen) = ([0.0; LANES], [0.0; LANES]);
        let (_, no_echo) = &likelihood.no_echo;
        let mut with_no_echo = *no_echo;
        let last = self.stencil.no_echo_reach;
        for (k, p) in likelihood.echoes.iter().rev() {
            let reach = self.stencil.echo_reach[*k];
            let cells = as_f64(reach);
            for lane in 0..LANES {
                tail[lane] += p[lane];
                let total = if reach <= last { tail[lane] + no_echo[lane] } else { tail[lane] };
                let here = if total >= LIKELY { cells } else { 0.0 };
                seen[lane] = if here > seen[lane] { here } else { seen[lane] };
            }
            if reach >= last {
                for lane in 0..LANES {
                    with_no_echo[lane] = tail[lane] + no_echo[lane];
                }
            }
        }
        let mut out = [0; LANES];
        for lane in 0..LANES {
            let none = if with_no_echo[lane] >= LIKELY { as_f64(last) } else { 0.0 };
            let seen = if none > seen[lane] { none } else { seen[lane] };
            #[allow(clippy::cast_possible_truncation, reason = "a rank")]
            (out[lane] = seen as u16);
        }
        out
    }

    /// Returns the number of the beam's cells that decide the sight and the gain of some
    /// view-points: the cells that may reflect, and the cells that a possible outcome covers.
    #[inline(always)]
    pub(crate) fn horizon(
        &self,
        belief: &Belief,
        likelihood: &GroupLikelihood,
        view_points: u16,
    ) -> u16 {
        #[allow(clippy::cast_possible_truncation, reason = "longer beams are refused")]
        let all = self.offsets.len() as u16;
        if !belief.means().is_empty() {
            // Hardly any expected coverage is 0 or 1: any range is possible.
            return all;
        }
        let mut farthest = [0.0; LANES];
        for (k, p) in likelihood.echoes.iter().chain([&likelihood.no_echo]) {
            let reach = as_f64(self.stencil.reach(*k));
            for lane in 0..LANES {
                let covered = if p[lane] > 0.0 { reach } else { 0.0 };
                farthest[lane] = if covered > farthest[lane] { covered } else { farthest[lane] };
            }
        }
        let mut cells = 0;
        for lane in (0..LANES).filter(|lane| view_points >> lane & 1 == 1) {
            #[allow(clippy::cast_possible_truncation, reason = "counts")]
            let (covered, traced) = (farthest[lane] as usize, likelihood.traced[lane] as usize);
            let traced = self.stencil.rings[..traced].last().map_or(0, |ring| ring.end);
            cells = cells.max(covered).max(traced);
        }
        #[allow(clippy::cast_possible_truncation, reason = "longer beams are refused")]
        let cells = cells as u16;
        cells
    }

    /// Returns the view-points that have a reason to measure in sight, as far as the beam sees from
    /// each of them.
    #[inline(always)]
    pub(crate) fn reasons(
        &self,
        belief: &Belief,
        here: usize,
        in_sight: &[u16; LANES],
        view_points: u16,
    ) -> u16 {
        let limits = belief.limits();
        let farthest = in_sight.iter().copied().max().unwrap_or(0);
        let mut found = [0u16; LANES];
        let all = self.offsets.iter().zip(&self.distances).zip(0..farthest);
        for ((offset, distance), i) in all {
            let limit: &Lanes = at_offset(limits, here, *offset);
            for lane in 0..LANES {
                found[lane] |= u16::from(*distance <= limit[lane]) & u16::from(i < in_sight[lane]);
            }
            if i % 8 == 7 && view_points & !bits(&found) == 0 {
                break;
            }
        }
        bits(&found)
    }

    /// Returns the cells of the beam that are in sight, with their distances.
    pub(crate) fn cells_in_sight(
        &self,
        in_sight: u16,
    ) -> impl Iterator<Item = (&crate::StencilCell, f32)> {
        self.stencil.cells[..usize::from(in_sight)].iter().zip(self.distances.iter().copied())
    }
}

/// Returns whether no lane is above 0, where none is below. The lanes are compared as bits, side by
/// side.
#[inline(always)]
fn all_zero(lanes: &Lanes64) -> bool {
    let mut bits = 0;
    for lane in lanes {
        bits |= lane.to_bits();
    }
    bits == 0
}

fn bits(lanes: &[u16; LANES]) -> u16 {
    lanes.iter().enumerate().fold(0, |bits, (lane, set)| bits | (set << lane))
}

/// Returns the values of a bordered raster at an offset from a group of view-points.
#[inline(always)]
pub(crate) fn at_offset<T>(raster: &[T], here: usize, offset: isize) -> &[T; LANES] {
    let at = here.wrapping_add_signed(offset);
    let Some(lanes) = raster[at..].first_chunk() else { panic!("rasters have a border") };
    lanes
}
