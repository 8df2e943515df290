//! A step of some length.
//!
//! In: a step, its stages solved to rounding. Out: by how much its energy differs from the one to preserve, and a guess of the stages of another
//! step: by the polynomial through these, wherever its nodes are.

use crate::gauss;
use crate::gauss::stages::Stages;
use crate::gauss::tableau::Tableau;

/// A step of some length, solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial<const N: usize, const S: usize> {
    /// The run after it.
    pub(super) after: gauss::Run<N, S>,
    /// `E0(h) − C_s h^2s D_* − E'`.
    pub(super) residual: f64,
    /// `E1 − E0`.
    pub(super) work: f64,
    /// The size of the terms of E0.
    pub(super) size: f64,
}

impl<const N: usize, const S: usize> Trial<N, S> {
    pub(super) fn h(&self) -> f64 {
        self.after.h
    }

    /// The residual in roundings of the terms of E0.
    pub(super) fn roundings(&self) -> f64 {
        self.residual.abs() / (f64::EPSILON * self.size + f64::MIN_POSITIVE)
    }

    /// The stages of the step of length h from the same node, so far as this one tells.
    pub(super) fn stages_for(&self, h: f64) -> Stages<N, S> {
        let ratio = h / self.h();
        at(&self.after.stages.data.0, |c| ratio * c)
    }
}

/// What the polynomials through the stages of a step are elsewhere: at `place(c_i)` in units of its length.
#[inline(always)]
pub(super) fn at<const N: usize, const S: usize>(stages: &Stages<N, S>, place: impl Fn(f64) -> f64) -> Stages<N, S> {
    let c = const { &Tableau::<S>::VALUES.c };
    let scales = const { &scales::<S>() };
    let mut values = [[0.0; S]; N];
    for i in 0..S {
        for j in 0..S {
            let mut basis = scales[j];
            for k in 0..S {
                if k != j {
                    basis *= place(c[i]) - c[k];
                }
            }
            for k in 0..N {
                values[k][i] += basis * stages[k][j];
            }
        }
    }
    values
}

/// `Π_{k ≠ j} 1/(c_j − c_k)`.
const fn scales<const S: usize>() -> [f64; S] {
    let c = &Tableau::<S>::VALUES.c;
    let mut scales = [1.0; S];
    let mut j = 0;
    while j < S {
        let mut k = 0;
        while k < S {
            if k != j {
                scales[j] /= c[j] - c[k];
            }
            k += 1;
        }
        j += 1;
    }
    scales
}
