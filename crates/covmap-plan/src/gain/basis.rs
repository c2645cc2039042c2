//! The few readings that others are mixtures of.
//!
//! What a reading tells of a cell in front of its end depends on σ_out and γ only, whatever the
//! ring; so does what it tells of one behind. Its gain is nearly a mixture of those of some ten
//! readings, with the same weights for every histogram. These few are evaluated when a cell changes,
//! and kept; a mixture of them takes a fifth of the time that an evaluation does.

use super::evidence::{Evidence, Prior, Reading};
use super::interpolation::Probes;
use crate::cells::Cells;
use covmap::lanes::{LANES, Lanes};
use pulp::Arch;
use rayon::prelude::*;

/// The gain of a mixture may be off by so much of what an interpolated one may.
const SHARE: f64 = 0.5;
/// With more readings than this a mixture takes more memory than it is worth.
const MOST: usize = 24;
/// So many blocks of cells are looked through by one thread.
const BLOCKS: usize = 64;

/// An imagined reading: how its gain is found.
#[derive(Debug, Clone)]
pub(crate) enum Imagined {
    /// By evaluating it.
    Evaluated(Reading),
    /// As a mixture of the basis from its `first` reading on.
    Mixed { first: usize, weights: Vec<f32> },
}

/// The readings that others are mixtures of, and their gains.
#[derive(Debug, Clone, Default)]
pub(crate) struct Basis {
    readings: Vec<Reading>,
    /// For every block of cells the gains of all readings.
    gains: Vec<Lanes>,
}

impl Basis {
    /// Finds how the gains of many readings are to be found: as mixtures of a few, which join the
    /// basis, if the gains of all probes allow it.
    ///
    /// One after the other that reading joins whose gain is farthest from what those before it
    /// span.
    pub(super) fn imagine(&mut self, readings: &[&Evidence], probes: &Probes) -> Vec<Imagined> {
        let mut rest = probes.in_tolerances(readings);
        let mut parts = vec![Vec::new(); readings.len()];
        let mut members: Vec<usize> = Vec::new();
        loop {
            let far = |rest: &Vec<f64>| rest.iter().fold(0.0, |far: f64, x| far.max(x.abs()));
            let farthest = rest.iter().map(far).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((member, _)) = farthest.filter(|(_, far)| *far > SHARE) else { break };
            if members.len() == MOST {
                return readings.iter().map(|e| Imagined::Evaluated(e.reading())).collect();
            }
            members.push(member);
            let length = dot(&rest[member], &rest[member]).sqrt();
            let direction: Vec<f64> = rest[member].iter().map(|x| x / length).collect();
            for (rest, parts) in rest.iter_mut().zip(&mut parts) {
                let part = dot(rest, &direction);
                rest.iter_mut().zip(&direction).for_each(|(x, d)| *x -= part * d);
                parts.push(part);
            }
        }
        let first = self.readings.len();
        self.readings.extend(members.iter().map(|member| readings[*member].reading()));
        let of_members: Vec<&Vec<f64>> = members.iter().map(|member| &parts[*member]).collect();
        let mixed =
            |parts: &Vec<f64>| Imagined::Mixed { first, weights: weights(&of_members, parts) };
        parts.iter().map(mixed).collect()
    }

    /// Makes room for the gains of so many blocks of cells.
    pub(super) fn make_room(&mut self, blocks: usize) {
        self.gains = vec![[0.0; LANES]; blocks * self.readings.len()];
    }

    /// Evaluates the basis in blocks of cells that changed, given in order.
    pub(crate) fn update(&mut self, arch: Arch, cells: &Cells, changed: &[usize]) {
        let Self { readings, gains } = self;
        let portions = gains.par_chunks_mut((readings.len() * BLOCKS).max(1)).enumerate();
        portions.for_each(|(portion, gains)| {
            let place = |block: usize| changed.partition_point(|changed| *changed < block);
            let first = portion * BLOCKS;
            for block in &changed[place(first)..place(first + BLOCKS)] {
                let gains = &mut gains[(block - first) * readings.len()..];
                arch.dispatch(
                    #[inline(always)]
                    || {
                        let prior = cells.block(*block);
                        let all = gains.iter_mut().zip(readings.iter());
                        all.for_each(|(gain, reading)| *gain = prior.gain(reading));
                    },
                );
            }
        });
    }

    /// The gain of a reading in every cell of a block.
    #[inline(always)]
    pub(super) fn gain(&self, reading: &Imagined, prior: &Prior<'_>, block: usize) -> Lanes {
        match reading {
            Imagined::Evaluated(reading) => prior.gain(reading),
            Imagined::Mixed { first, weights } => {
                let mut gain = [0.0; LANES];
                for (gains, weight) in
                    self.gains[block * self.readings.len() + first..].iter().zip(weights)
                {
                    for lane in 0..LANES {
                        gain[lane] += gains[lane] * weight;
                    }
                }
                gain
            }
        }
    }
}

/// What every member weighs in a reading, by their parts along the directions that the members
/// brought in one after the other: a member has no part along later ones.
fn weights(members: &[&Vec<f64>], wanted: &[f64]) -> Vec<f32> {
    let mut weights = vec![0.0; members.len()];
    for direction in (0..members.len()).rev() {
        let later = direction + 1..members.len();
        let taken: f64 = later.map(|n| weights[n] * members[n][direction]).sum();
        weights[direction] = (wanted[direction] - taken) / members[direction][direction];
    }
    #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
    weights.into_iter().map(|w: f64| w as f32).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
