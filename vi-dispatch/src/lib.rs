//! Compiles a loop for several instruction sets and selects one at run time.
//!
//! In: a [`Loop`]. Out: its result, computed with the widest vector instructions of this processor. All copies come
//! from one source. The feature `std` detects the instructions of the processor; without it, all loops run with the
//! baseline. A build for one processor (`-C target-cpu=native`) needs no copies. Builds with debug assertions omit the
//! copy for vectors of eight: it computes the same numbers as the copy for four and takes as long to compile.

#![no_std]

#[cfg(feature = "std")]
extern crate std;

/// A numeric loop, inlined with everything that it calls.
pub trait Loop {
    /// The result of the loop.
    type Output;

    /// Runs the loop. `FUSED` is true if the processor has fused multiply-add.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// Runs a loop with the baseline instructions of the architecture: one copy, for loops that do not profit from more.
#[inline]
pub fn by_baseline<L: Loop>(of: L) -> L::Output {
    of.run::<{ cfg!(target_feature = "fma") }>()
}

/// A vector instruction set that this processor has; no other can be constructed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instructions(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    /// The baseline of the architecture.
    Baseline,
    /// Vectors of four numbers, with fused multiply-add.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    Avx2,
    /// Vectors of eight numbers, with fused multiply-add.
    #[cfg(all(feature = "std", target_arch = "x86_64", not(debug_assertions)))]
    Avx512,
}

impl Instructions {
    /// The baseline of the architecture.
    pub const BASELINE: Self = Self(Set::Baseline);

    /// The widest set that this processor has.
    #[must_use]
    pub fn detected() -> Self {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        {
            use std::is_x86_feature_detected;
            let avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
            #[cfg(not(debug_assertions))]
            {
                let wide = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl");
                if avx2 && wide && is_x86_feature_detected!("avx512dq") {
                    return Self(Set::Avx512);
                }
            }
            if avx2 {
                return Self(Set::Avx2);
            }
        }
        Self::BASELINE
    }

    /// Runs a loop with these instructions.
    #[inline]
    #[allow(unsafe_code)]
    pub fn run<L: Loop>(self, of: L) -> L::Output {
        #[cfg(all(feature = "std", target_arch = "x86_64", not(debug_assertions)))]
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
        fn avx512<L: Loop>(of: L) -> L::Output {
            of.run::<true>()
        }
        match self.0 {
            Set::Baseline => by_baseline(of),
            // SAFETY: `Instructions::detected` checked that the processor has these instructions.
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            Set::Avx2 => unsafe { avx2(of) },
            // SAFETY: as above.
            #[cfg(all(feature = "std", target_arch = "x86_64", not(debug_assertions)))]
            Set::Avx512 => unsafe { avx512(of) },
        }
    }

    /// Runs a loop that is not worth several copies: with vectors of four numbers. Gives it back on x86-64 without them.
    ///
    /// # Errors
    /// The loop.
    #[inline]
    #[allow(unsafe_code)]
    pub fn run_once<L: Loop>(self, of: L) -> Result<L::Output, L> {
        match self.0 {
            Set::Baseline if cfg!(all(feature = "std", target_arch = "x86_64", not(target_feature = "avx2"))) => {
                Err(of)
            }
            Set::Baseline => Ok(by_baseline(of)),
            // SAFETY: `Instructions::detected` checked that the processor has these instructions.
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            _ => Ok(unsafe { avx2(of) }),
        }
    }
}

/// A loop with vectors of four numbers.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma")]
fn avx2<L: Loop>(of: L) -> L::Output {
    of.run::<true>()
}
