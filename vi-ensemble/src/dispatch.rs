//! Copies of a loop for the instruction sets of a processor.
//!
//! In: a [`Loop`]. Out: what it computes, by the widest vector instructions that this processor has. The compiler makes
//! each copy of the same source; a build for one processor (`-C target-cpu=native`) needs none of them.

/// A loop over numbers, inlined with all that it calls.
pub(crate) trait Loop {
    /// What it computes.
    type Output;

    /// Runs it; `FUSED` where the processor adds products in one instruction.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// What a processor can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instructions {
    /// What every processor of this architecture has.
    Baseline,
    /// Vectors of four numbers, with fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// Vectors of eight numbers, with fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    /// The most that this processor has.
    pub(crate) fn detected() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
            let wide = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl");
            if avx2 && wide && is_x86_feature_detected!("avx512dq") {
                return Self::Avx512;
            }
            if avx2 {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// Runs a loop by these instructions.
    #[allow(unsafe_code)]
    pub(crate) fn run<L: Loop>(self, of: L) -> L::Output {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2,fma")]
        fn avx2<L: Loop>(of: L) -> L::Output {
            of.run::<true>()
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
        fn avx512<L: Loop>(of: L) -> L::Output {
            of.run::<true>()
        }
        match self {
            Self::Baseline => of.run::<{ cfg!(target_feature = "fma") }>(),
            // SAFETY: `Instructions::detected` saw that the processor has these instructions.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { avx2(of) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { avx512(of) },
        }
    }
}
