//! The vector registers with which many numbers are computed side by side.
//!
//! All kinds give the same bits; they differ in speed. The kind is therefore a setting of the
//! process, not of a model or a planner. It serves comparisons: by default the process takes the
//! fastest.

use pulp::Arch;
use std::sync::atomic::{AtomicU8, Ordering};

/// A kind of registers, narrower ones first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Registers {
    /// One number at a time.
    Scalar,
    /// 256 bits (AVX2).
    Avx2,
    /// 512 bits (AVX-512).
    Avx512,
}

static WIDEST: AtomicU8 = AtomicU8::new(Registers::Avx512 as u8);

impl Registers {
    /// Limits everything that is built from now on to these registers or narrower ones.
    pub fn limit(self) {
        WIDEST.store(self as u8, Ordering::Relaxed);
    }

    /// Returns these registers, or the widest below them that the processor has and the limit
    /// allows.
    ///
    /// On a processor without AVX it returns the native ones, unless the limit is
    /// [`Registers::Scalar`].
    pub fn or_narrower(self) -> Arch {
        let widest = WIDEST.load(Ordering::Relaxed).min(self as u8);
        if widest == Registers::Scalar as u8 {
            return Arch::Scalar;
        }
        #[cfg(target_arch = "x86_64")]
        if widest < Registers::Avx512 as u8
            && let Some(registers) = pulp::x86::V3::try_new()
        {
            return Arch::V3(registers);
        }
        Arch::new()
    }
}
