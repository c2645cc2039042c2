//! Logarithms and exponentials of many numbers at once.
//!
//! Loops over arrays of [`LANES`] numbers become vector instructions wherever they are compiled for
//! a processor that has them. The operations and their order are the same everywhere, and products
//! are added only by [`fused`]: the results are the same to the last bit. The polynomials are those
//! of the Cephes library's `logf` and `expf`.

/// Number of values that are computed side by side.
pub const LANES: usize = 16;

/// [`LANES`] numbers.
pub type Lanes = [f32; LANES];

/// Number of [`Lanes`] that are computed together where possible: a long chain of operations on a
/// single one would leave the processor waiting.
pub const TOGETHER: usize = 4;

/// [`TOGETHER`] [`Lanes`].
pub type Wide = [f32; LANES * TOGETHER];

/// Joins [`Lanes`] into one array.
#[inline(always)]
pub fn flat(rows: &[Lanes; TOGETHER]) -> Wide {
    let mut out = [0.0; LANES * TOGETHER];
    for i in 0..LANES * TOGETHER {
        out[i] = rows[i / LANES][i % LANES];
    }
    out
}

/// Splits one array into [`Lanes`].
#[inline(always)]
pub fn rows(flat: &Wide) -> [Lanes; TOGETHER] {
    let mut out = [[0.0; LANES]; TOGETHER];
    for i in 0..LANES * TOGETHER {
        out[i / LANES][i % LANES] = flat[i];
    }
    out
}

/// Returns a·b + c, rounded once.
///
/// IEEE 754 defines this result, so all processors agree on it; those without the instruction are
/// slow at it. With the instruction, decisions take about a third less time.
#[inline(always)]
#[allow(clippy::disallowed_methods, reason = "the one place")]
pub fn fused(a: f32, b: f32, c: f32) -> f32 {
    a.mul_add(b, c)
}

/// Returns the natural logarithms of positive, normal numbers, each to within 1e-7·(1 + |ln x|).
///
/// The mantissa is brought to m in [√½, √2); then `ln x = e·ln 2 + ln(1 + (m − 1))`, with a
/// polynomial of degree 9, and ln 2 in two parts.
#[inline(always)]
pub fn ln<const N: usize>(x: &[f32; N]) -> [f32; N] {
    // Shifts the borders of the binades to √½·2^e, so that e rounds to the nearest.
    let shifted = map(x, |x| x.to_bits().wrapping_sub(0x3f35_04f3));
    let exponent = map(&shifted, |s| (s.cast_signed() >> 23) as f32);
    let z = map(&shifted, |s| f32::from_bits((s & 0x007f_ffff) + 0x3f35_04f3) - 1.0);
    let square = map(&z, |z| z * z);
    // Pairs of coefficients: short chains of operations, many of them at a time.
    let pair = |high: f32, low: f32| map(&z, |z| fused(high, z, low));
    let mut p = scaled_plus(&square, 7.037_683_6e-2, &pair(-1.151_461e-1, 1.167_699_9e-1));
    for low in [
        pair(-1.242_014_1e-1, 1.424_932_3e-1),
        pair(-1.666_805_8e-1, 2.000_071_5e-1),
        pair(-2.499_999_4e-1, 3.333_333e-1),
    ] {
        p = product_plus(&p, &square, &low);
    }
    let cube = multiply(&z, &square);
    let rest = scaled_plus(&square, -0.5, &map(&exponent, |e| e * -2.121_944_4e-4));
    let small = product_plus(&p, &cube, &rest);
    scaled_plus(&exponent, 0.693_359_4, &add(&z, &small))
}

/// Returns the exponentials of numbers of at most 88, each to within 2e-7 of itself. Below −87 the
/// result is that of −87, which is 1.6e-38.
///
/// With n the whole number nearest to x/ln 2, `exp x = 2^n · exp(x − n·ln 2)`, with a
/// polynomial of degree 7, and ln 2 in two parts.
#[inline(always)]
pub fn exp<const N: usize>(x: &[f32; N]) -> [f32; N] {
    /// Added to a number below 2^22, this leaves a whole number in the mantissa's last bits.
    const TO_WHOLE: f32 = 12_582_912.0;
    let x = map(x, |x| if x > -87.0 { x } else { -87.0 });
    let shifted = map(&x, |x| fused(x, std::f32::consts::LOG2_E, TO_WHOLE));
    let whole = map(&shifted, |s| s - TO_WHOLE);
    let z = scaled_plus(&whole, 2.121_944_4e-4, &scaled_plus(&whole, -0.693_359_4, &x));
    let square = map(&z, |z| z * z);
    let pair = |high: f32, low: f32| map(&z, |z| fused(high, z, low));
    let mut p = pair(1.987_569_2e-4, 1.398_199_9e-3);
    for low in [pair(8.333_452e-3, 4.166_579_6e-2), pair(1.666_666_5e-1, 5.0e-1)] {
        p = product_plus(&p, &square, &low);
    }
    let mantissa = map(&product_plus(&p, &square, &z), |m| m + 1.0);
    // The sign of the exponent is shifted out.
    let power = map(&shifted, |s| f32::from_bits((s.to_bits() << 23).wrapping_add(0x3f80_0000)));
    multiply(&mantissa, &power)
}

/// Adds a·b to `sum`, lane by lane.
#[inline(always)]
pub fn add_product(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for lane in 0..LANES {
        sum[lane] = fused(a[lane], b[lane], sum[lane]);
    }
}

/// Adds `factor`·a to `sum`, lane by lane.
#[inline(always)]
pub fn add_scaled(sum: &mut Lanes, a: &Lanes, factor: f32) {
    for lane in 0..LANES {
        sum[lane] = fused(a[lane], factor, sum[lane]);
    }
}

/// Applies a function to each number.
#[inline(always)]
pub fn map<T: Copy, U: Copy + Default, const N: usize>(x: &[T; N], f: impl Fn(T) -> U) -> [U; N] {
    let mut out = [U::default(); N];
    for i in 0..N {
        out[i] = f(x[i]);
    }
    out
}

#[inline(always)]
fn add<const N: usize>(a: &[f32; N], b: &[f32; N]) -> [f32; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = a[i] + b[i];
    }
    out
}

#[inline(always)]
fn multiply<const N: usize>(a: &[f32; N], b: &[f32; N]) -> [f32; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = a[i] * b[i];
    }
    out
}

#[inline(always)]
fn product_plus<const N: usize>(a: &[f32; N], b: &[f32; N], c: &[f32; N]) -> [f32; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = fused(a[i], b[i], c[i]);
    }
    out
}

#[inline(always)]
fn scaled_plus<const N: usize>(a: &[f32; N], factor: f32, c: &[f32; N]) -> [f32; N] {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = fused(a[i], factor, c[i]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[allow(clippy::cast_possible_truncation, reason = "any f32 will do")]
    fn single(x: f64) -> f32 {
        x as f32
    }

    proptest! {
        #[test]
        fn the_logarithm_keeps_its_bound(exponent in -80.0..80.0f64, near in 0.9..1.1f64) {
            for x in [single(libm::exp2(exponent)), single(near)] {
                let y = ln(&[x; LANES])[3];
                let exact = libm::log(f64::from(x));
                prop_assert!((f64::from(y) - exact).abs() < 1e-7 * (1.0 + exact.abs()), "{} {} {}", x, y, exact);
            }
        }

        #[test]
        fn the_exponential_keeps_its_bound(x in -87.0..88.0f64, near in -1.0..1.0f64) {
            for x in [single(x), single(near)] {
                let y = exp(&[x; LANES])[3];
                let exact = libm::exp(f64::from(x));
                prop_assert!((f64::from(y) - exact).abs() < 2e-7 * exact, "{} {} {}", x, y, exact);
            }
        }
    }
}
