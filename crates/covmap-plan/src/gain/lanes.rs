//! The natural logarithm of many numbers at once.

/// How many numbers are computed side by side.
pub(crate) const LANES: usize = 16;

/// [`LANES`] numbers.
pub(crate) type Lanes = [f32; LANES];

/// The natural logarithm of positive, normal numbers, to within 1e-7·(1 + |ln x|).
///
/// The mantissa is brought to m in [√½, √2); then `ln x = e·ln 2 + ln(1 + (m − 1))`, with the
/// polynomial of degree 9 that the Cephes library gives for `logf`, and ln 2 in two parts.
/// The same operations in the same order on every processor, and nothing fused.
#[inline(always)]
pub(crate) fn ln(x: &Lanes) -> Lanes {
    let mut out = [0.0; LANES];
    for (o, x) in out.iter_mut().zip(x) {
        let bits = x.to_bits();
        // Shifts the borders of the binades to √½·2^e, so that e rounds to the nearest.
        let shifted = bits.wrapping_sub(0x3f35_04f3);
        let exponent = (shifted.cast_signed() >> 23) as f32;
        let mantissa = f32::from_bits((shifted & 0x007f_ffff) + 0x3f35_04f3);
        let z = mantissa - 1.0;
        let mut p = 7.037_683_6e-2;
        for coefficient in [
            -1.151_461e-1,
            1.167_699_9e-1,
            -1.242_014_1e-1,
            1.424_932_3e-1,
            -1.666_805_8e-1,
            2.000_071_5e-1,
            -2.499_999_4e-1,
            3.333_333e-1,
        ] {
            p = p * z + coefficient;
        }
        let square = z * z;
        let small = p * z * square + exponent * -2.121_944_4e-4 - 0.5 * square;
        *o = (z + small) + exponent * 0.693_359_4;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_logarithm_keeps_its_bound(exponent in -80.0..80.0f64, near in 0.9..1.1f32) {
            #[allow(clippy::cast_possible_truncation, reason = "any f32 will do")]
            let x = libm::exp2(exponent) as f32;
            let mut lanes = [x; LANES];
            lanes[1] = near;
            let y = ln(&lanes);
            for i in 0..2 {
                let exact = libm::log(f64::from(lanes[i]));
                prop_assert!((f64::from(y[i]) - exact).abs() < 1e-7 * (1.0 + exact.abs()), "{} {} {}", lanes[i], y[i], exact);
            }
        }
    }
}
