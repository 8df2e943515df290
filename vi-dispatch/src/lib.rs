//! Copies of a loop for the instruction sets of a processor.
//!
//! In: a [`Loop`]. Out: what it computes, by the widest vector instructions that this processor has. The compiler makes
//! each copy of the same source; a build for one processor (`-C target-cpu=native`) needs none of them. Builds with debug assertions
//! leave out the copy for vectors of eight: it computes the same numbers as that for four, and takes as long to compile.

/// A loop over numbers, inlined with all that it calls.
pub trait Loop {
    /// What it computes.
    type Output;

    /// Runs it; `FUSED` where the processor adds products in one instruction.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// Runs a loop by what every processor of this architecture has: one copy, where a loop is not worth more.
#[inline]
pub fn by_baseline<L: Loop>(of: L) -> L::Output {
    of.run::<{ cfg!(target_feature = "fma") }>()
}

/// The vector instructions that a loop is run by. There is no way to one that the processor does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instructions(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    /// What every processor of this architecture has.
    Baseline,
    /// Vectors of four numbers, with fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// Vectors of eight numbers, with fused multiply-add.
    #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
    Avx512,
}

impl Instructions {
    /// What every processor of this architecture has.
    pub const BASELINE: Self = Self(Set::Baseline);

    /// The most that this processor has.
    #[must_use]
    pub fn detected() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
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

    /// Runs a loop by these instructions.
    #[inline]
    #[allow(unsafe_code)]
    pub fn run<L: Loop>(self, of: L) -> L::Output {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2,fma")]
        fn avx2<L: Loop>(of: L) -> L::Output {
            of.run::<true>()
        }
        #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
        fn avx512<L: Loop>(of: L) -> L::Output {
            of.run::<true>()
        }
        match self.0 {
            Set::Baseline => by_baseline(of),
            // SAFETY: `Instructions::detected` saw that the processor has these instructions.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(of) },
            // SAFETY: as above.
            #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
            Set::Avx512 => unsafe { avx512(of) },
        }
    }
}
