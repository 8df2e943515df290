//! Copies of the loops of [`sweep`] for the instruction sets of a processor.
//!
//! In: what a sweep takes. Out: the same, by the widest vector instructions that this processor has. The compiler makes
//! each copy of the same source; a build for one processor (`-C target-cpu=native`) needs none of them.

use crate::ensemble::HALF;
use crate::rows::{Nodes, Rows};
use crate::sweep::{self, Clock, Fixed, Verdict};
use vi_core::Batch;

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
}

/// For a loop of [`sweep`] the function of its name that takes [`Instructions`] before its arguments.
macro_rules! copies {
    ($($name:ident($($argument:ident: $kind:ty),*);)*) => {$(
        #[doc = concat!("`sweep::", stringify!($name), "` by the instructions of this processor.")]
        #[allow(unsafe_code, clippy::too_many_arguments)]
        pub(crate) fn $name<S: Batch<N>, const N: usize>(instructions: Instructions, $($argument: $kind),*) -> bool {
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2,fma")]
            fn avx2<S: Batch<N>, const N: usize>($($argument: $kind),*) -> bool {
                sweep::$name::<S, N, true>($($argument),*)
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
            fn avx512<S: Batch<N>, const N: usize>($($argument: $kind),*) -> bool {
                sweep::$name::<S, N, true>($($argument),*)
            }
            match instructions {
                Instructions::Baseline => sweep::$name::<S, N, { cfg!(target_feature = "fma") }>($($argument),*),
                // SAFETY: `Instructions::detected` saw that the processor has these instructions.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => unsafe { avx2::<S, N>($($argument),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx512 => unsafe { avx512::<S, N>($($argument),*) },
            }
        }
    )*};
}

copies! {
    foretold(fixed: &Fixed<[S::Rows<HALF>; 2]>, clock: Clock, start: &Nodes<N>, end: &mut Nodes<N>, velocity: &mut Rows<N>,
        verdict: &mut Verdict, v1: &Rows<N>, v2: &Rows<N>, v3: &Rows<N>, v4: &Rows<N>, v5: &Rows<N>, v6: &Rows<N>,
        v7: &Rows<N>, v8: &Rows<N>, v9: &Rows<N>, v10: &Rows<N>);
    again(fixed: &Fixed<[S::Rows<HALF>; 2]>, clock: Clock, start: &Nodes<N>, end: &mut Nodes<N>, velocity: &mut Rows<N>,
        verdict: &mut Verdict);
    lesson(fixed: &Fixed<[S::Rows<HALF>; 2]>, clock: Clock, start: &Nodes<N>, end: &mut Nodes<N>, velocity: &mut Rows<N>,
        verdict: &mut Verdict, v1: &Rows<N>);
}
