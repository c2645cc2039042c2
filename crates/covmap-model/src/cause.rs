//! The update by cause: the surface of the map that answered, and the evidence about each cell.

use crate::parameters::MOST_BEARINGS;
use crate::{CauseParameters, Outcome};
use covmap::bin_coverage;

/// A cell as a beam meets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Met {
    /// d^l, the distance from the sensor to the cell's centre \[m\].
    pub cell_distance: f64,
    /// Position across the beam: from 0 at its right border to 1 at its left.
    pub across: f64,
}

/// Least share of "passed" that counts: a cell far away stays unknown, and does not become free by
/// a millionth of its probability.
const LEAST_PASSED: f64 = 1e-3;

/// Least sum of the shares that touches a cell.
const LEAST_SHARES: f64 = 1e-6;

/// The causes of a reading, by the map before the scan.
///
/// Eq. (9) treats every cell of a cone as if it were alone: one echo makes a whole arc half
/// covered, though one surface caused it. The paper's first footnote says so. This update keeps the
/// paper's form, a mixture of a Gaussian and a uniform distribution over coverages, and takes the
/// share of each from the map. A beam is divided into M bearings. With δ = d^l − z and E\[c\] the
/// expected coverage of a cell before the scan, an echo from z has the causes
///
/// ```text
/// o_i = max(0, 2·E[c_i] − 1)                                        how opaque a known cell is
/// v_m = Π (1 − o_i)      over the known cells of bearing m, δ_i < −(r/2 + τ)     its clear view
/// S   = (Σ_m v_m / M)^κ                     the nearest surface of the whole beam answers first
/// a_m = S · v_m · (max_i w(δ_i)·E[c_i])^p   over the cells of bearing m, |δ_i| ≤ r/2 + τ
/// w(δ) = 1 for |δ| ≤ r/2, else exp(−½ ((|δ| − r/2) / (τ/2))²)
/// c_m = a_m / (Σ a + a_0)            L = Σ a / (Σ a + a_0)
/// ```
///
/// c_m is the probability that the surface in bearing m answered, L that any surface of the map
/// did; 1 − L is left to chance: a mirrored sound, another robot, an object that is not in the map.
/// [`Causes::evidence`] is the evidence of the reading about one cell.
///
/// An echo from beyond the usable range, and no echo, have no cause in the map: L = β·S and
/// L = ν·S, with S over all the cells that the beam passed.
///
/// This is Bayes in part: given the cause, the mixture is the posterior of one cell, and the shares
/// are the posterior probabilities of the causes, if each is as likely as its surface is covered,
/// to the power p, and in clear view. The rest is approximation: the causes follow from the means
/// of the cells and not jointly with them (one step of assumed-density filtering); the power p and
/// the constant a_0 are fitted; and S stands for the joint event that no nearer surface answered. A
/// cell's own mean is a part of its bearing's a_m. Without it, so that only the other bearings and
/// chance compete, the update explains whole explorations by .02 nats a cell worse, and would need
/// a cause for every cell.
///
/// Relatives: Thrun's forward models \[2001\]; Konolige's redundant and mirrored readings
/// \[MURIEL, 1997\]; the sensor cause model of Agha-mohammadi et al. \[2019\], whose update is
/// linear in the coverage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Causes {
    /// c_m.
    pub ended: [f64; MOST_BEARINGS],
    /// L.
    pub any: f64,
}

/// Possible evidence of an outcome about a cell, whatever its cause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Role {
    /// Weight of the cause in its bearing for N(μ, σ): 1 at the end, b behind it, else 0.
    pub weight: f64,
    /// μ.
    pub mu: f64,
    /// σ.
    pub sigma: f64,
    /// f(d^l, θ), weight of all other causes for N(0, σ_free); 0 behind the end.
    pub free: f64,
}

/// Evidence of a reading about one cell: the shares of N(μ, σ) and of N(0, σ_free).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shares {
    pub(crate) ended: f64,
    pub(crate) passed: f64,
}

/// Clues of the cells that a beam meets to the causes of its reading. The caller adds each cell
/// once, in any order, and then asks for the [`Causes`].
#[derive(Debug, Clone)]
pub struct Clues<'a> {
    parameters: &'a CauseParameters,
    /// r \[m\]
    resolution: f64,
    /// z, or the distance up to which a beam without a cause passed \[m\].
    end: f64,
    /// v_m
    clear: [f64; MOST_BEARINGS],
    /// max w·E\[c\]
    surface: [f64; MOST_BEARINGS],
}

impl Shares {
    /// Returns whether the reading says nothing about the cell.
    #[inline(always)]
    pub(crate) fn are_nothing(&self) -> bool {
        self.ended + self.passed < LEAST_SHARES
    }
}

impl<'a> Clues<'a> {
    /// Creates clues without a cell. `end` is z, or the distance up to which the beam passed if
    /// nothing answered \[m\].
    pub fn new(parameters: &'a CauseParameters, resolution: f64, end: f64) -> Self {
        let (clear, surface) = ([1.0; MOST_BEARINGS], [0.0; MOST_BEARINGS]);
        Self { parameters, resolution, end, clear, surface }
    }

    /// Adds a cell with its expected coverage before the scan, `None` if no reading touched it.
    #[inline(always)]
    pub fn add(&mut self, met: Met, expected: Option<f64>) {
        let p = self.parameters;
        let delta = met.cell_distance - self.end;
        let (near, bearing) = (p.nearness(self.resolution, delta), p.bearing(met.across));
        if near > 0.0 {
            let surface = near * expected.unwrap_or(p.unknown_coverage);
            self.surface[bearing] = self.surface[bearing].max(surface);
        } else if let Some(expected) = expected.filter(|_| delta < 0.0) {
            self.clear[bearing] *= 1.0 - opaque(expected);
        }
    }

    /// S.
    fn first(&self) -> f64 {
        let clear = &self.clear[..self.parameters.bearings];
        let mean = clear.iter().sum::<f64>() / clear.len() as f64;
        libm::pow(mean, self.parameters.first_echo)
    }

    /// Returns the causes of an echo.
    fn of_echo(&self) -> Causes {
        let (p, first) = (self.parameters, self.first());
        let mut ended = [0.0; MOST_BEARINGS];
        let views = self.clear.iter().zip(&self.surface).take(p.bearings);
        for (a, (clear, surface)) in ended.iter_mut().zip(views) {
            // A bearing without a cell, or with a cell that is surely free, answers nothing.
            *a =
                if *surface > 0.0 { first * clear * libm::pow(*surface, p.sharpness) } else { 0.0 };
        }
        let sum: f64 = ended.iter().sum();
        ended.iter_mut().for_each(|a| *a /= sum + p.chance);
        Causes { ended, any: sum / (sum + p.chance) }
    }

    /// Returns the causes of an outcome: of an echo, or of a beam that no surface in range
    /// answered.
    pub fn of(&self, outcome: Outcome) -> Causes {
        let p = self.parameters;
        let passed = |share| Causes { ended: [0.0; MOST_BEARINGS], any: share * self.first() };
        match outcome {
            Outcome::Echo(_) => self.of_echo(),
            Outcome::Beyond(_) => passed(p.beyond),
            Outcome::NoEcho => passed(p.no_echo.share),
        }
    }
}

/// Returns the opacity of a cell of an expected coverage.
#[inline(always)]
pub fn opaque(expected: f64) -> f64 {
    (2.0 * expected - 1.0).max(0.0)
}

impl CauseParameters {
    /// Returns the bearing of a cell by its position across the beam.
    #[inline(always)]
    pub fn bearing(&self, across: f64) -> usize {
        #[allow(clippy::cast_possible_truncation, reason = "at most 16; saturates")]
        let bearing = (across * self.bearings as f64) as usize;
        bearing.min(self.bearings - 1)
    }

    /// Returns w(δ), the likelihood that an echo from z comes from a cell, by δ = d^l − z \[m\].
    #[inline(always)]
    pub fn nearness(&self, resolution: f64, delta: f64) -> f64 {
        let border = delta.abs() - 0.5 * resolution;
        let z = border / (0.5 * self.range_tolerance);
        match border {
            border if border <= 0.0 => 1.0,
            border if border <= self.range_tolerance => libm::exp(-0.5 * z * z),
            _ => 0.0,
        }
    }

    /// Returns f(d^l, θ), the share of "passed" that reaches a cell:
    ///
    /// ```text
    /// f = f_0 · exp(−(d^l/d_f)² − ½ ((2·across − 1)/width)²)      0 where that is below .001
    /// ```
    pub fn passed(&self, met: Met) -> f64 {
        let along = met.cell_distance / self.free.range;
        let across = (2.0 * met.across - 1.0) / self.free.width;
        let f = self.free.share * libm::exp(-along * along - 0.5 * across * across);
        if f < LEAST_PASSED { 0.0 } else { f }
    }

    /// Returns the role of a cell for an outcome.
    pub fn role(&self, resolution: f64, met: Met, outcome: Outcome) -> Role {
        let passed = Role { weight: 0.0, mu: 0.0, sigma: 1.0, free: self.passed(met) };
        let Outcome::Echo(end) = outcome else { return passed };
        let delta = met.cell_distance - end;
        if delta > 0.5 * resolution {
            return Role {
                weight: self.behind_weight,
                mu: 1.0,
                sigma: self.sigma_behind,
                free: 0.0,
            };
        }
        let mu = (0.5 + delta / (self.cell_depth * resolution)).clamp(0.0, 1.0);
        match self.nearness(resolution, delta) {
            near if near > 0.0 => Role {
                weight: 1.0,
                mu,
                sigma: self.sigma_in.at(met.cell_distance, end),
                free: if delta < 0.0 { passed.free } else { 0.0 },
            },
            _ => passed,
        }
    }
}

impl Role {
    /// Returns the shares that causes give a cell of a bearing.
    #[inline(always)]
    pub(crate) fn shares(&self, causes: &Causes, bearing: usize) -> Shares {
        let own = if self.weight > 0.0 { causes.ended[bearing] } else { 0.0 };
        Shares { ended: self.weight * own, passed: self.free * (causes.any - own) }
    }
}

impl Causes {
    /// Returns the causes of a reading of this novelty. The rest of it repeats earlier readings and
    /// tells nothing.
    #[must_use]
    pub fn by_as_much(self, novelty: f64) -> Self {
        Self { ended: self.ended.map(|share| novelty * share), any: novelty * self.any }
    }

    /// Returns the causes of an echo in an unknown map: M bearings of unknown cells, all in clear
    /// view.
    pub fn in_an_unknown_map(parameters: &CauseParameters) -> Self {
        let mut clues = Clues::new(parameters, 1.0, 1.0);
        clues.surface[..parameters.bearings].fill(parameters.unknown_coverage);
        clues.of_echo()
    }

    /// Evaluates the evidence of an outcome with these causes about the coverage x of a cell, at
    /// every bin:
    ///
    /// ```text
    /// p(c_l = x | d) = (1 − s − g)·U + s·N(μ, σ, x) + g·N(0, σ_free, x)
    ///
    /// before the end, δ < −(r/2 + τ)   s = 0              g = f(d^l, θ)·L
    /// at the end, |δ| ≤ r/2 or within  s = c_m            g = f(d^l, θ)·(L − c_m) if δ < 0
    ///   τ of that                      μ = ½ + δ/ℓ        σ = σ_in
    /// behind it, δ > r/2               s = b·c_m, μ = 1   σ = σ_behind
    /// ```
    ///
    /// All three are normalised over the bins, U uniform; μ is Eq. (10) with ℓ for the depth of the
    /// cell, cut off at 0 and 1. The evidence is a posterior of the cell under a uniform prior, as
    /// Eq. (9) is, and never 0. Returns whether the reading touches the cell: shares that sum to
    /// less than 1e-6 do not.
    pub fn evidence(
        &self,
        parameters: &CauseParameters,
        resolution: f64,
        met: Met,
        outcome: Outcome,
        out: &mut [f64],
    ) -> bool {
        let role = parameters.role(resolution, met, outcome);
        let shares = role.shares(self, parameters.bearing(met.across));
        let mut ended = vec![0.0; out.len()];
        gaussian(role.mu, role.sigma, &mut ended);
        gaussian(0.0, parameters.free.sigma, out);
        let even = (1.0 - shares.ended - shares.passed) / out.len() as f64;
        for (o, ended) in out.iter_mut().zip(&ended) {
            *o = even + shares.ended * ended + shares.passed * *o;
        }
        !shares.are_nothing()
    }
}

/// Evaluates N(μ, σ, x) at the coverage x of every bin, normalised over the bins.
pub fn gaussian(mu: f64, sigma: f64, out: &mut [f64]) {
    let bins = out.len();
    for (bin, o) in out.iter_mut().enumerate() {
        let z = (bin_coverage(bin, bins) - mu) / sigma;
        *o = libm::exp(-0.5 * z * z);
    }
    let sum: f64 = out.iter().sum();
    out.iter_mut().for_each(|o| *o /= sum);
}
