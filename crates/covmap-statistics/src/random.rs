//! Random numbers that are the same on every machine.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use std::f64::consts::TAU;

/// Returns an independent generator for each (seed, purpose, counter).
///
/// The three are hashed (FNV-1a, then SplitMix64's finaliser) into state and stream of a PCG64. The
/// generator does not depend on the platform.
pub fn stream(seed: u64, purpose: &str, counter: u64) -> Pcg64 {
    let hash = |salt: u64| {
        let words = [salt, seed, counter].map(u64::to_le_bytes);
        let bytes = words.iter().flatten().chain(purpose.as_bytes());
        let fnv = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |h, &byte| {
            (h ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        u128::from(mixed(fnv))
    };
    Pcg64::new(hash(1) << 64 | hash(2), hash(3) << 64 | hash(4))
}

fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Draws a uniform number in \[0, 1\).
pub fn uniform(rng: &mut Pcg64) -> f64 {
    let bits = (rng.next_u64() >> 11) as f64;
    bits * (1.0 / 9_007_199_254_740_992.0)
}

/// Draws a standard normal variate (Box–Muller), from exactly two uniform ones.
pub fn normal(rng: &mut Pcg64) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - uniform(rng))).sqrt();
    radius * libm::cos(TAU * uniform(rng))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_in_seed_purpose_and_counter() {
        let first = |seed, purpose, counter| stream(seed, purpose, counter).next_u64();
        let all =
            [first(1, "fire", 0), first(2, "fire", 0), first(1, "drive", 0), first(1, "fire", 1)];
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a != b));
        }
        assert_eq!(first(1, "fire", 0), first(1, "fire", 0));
    }

    #[test]
    fn a_normal_variate_has_mean_0_and_variance_1() {
        let mut rng = stream(7, "normal", 0);
        let draws: Vec<f64> = (0..100_000).map(|_| normal(&mut rng)).collect();
        let mean = draws.iter().sum::<f64>() / 1e5;
        let variance = draws.iter().map(|v| v * v).sum::<f64>() / 1e5;
        assert!(mean.abs() < 0.015 && (variance - 1.0).abs() < 0.02, "{mean} {variance}");
    }
}
