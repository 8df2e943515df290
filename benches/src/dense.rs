//! A general solver for the chain: the Jacobian as in the step by hand, solved by nalgebra's dense LU.

use crate::chain::Springs;
use crate::hand::chain::Solver;
use nalgebra::{Const, DimMin, SMatrix, SVector, ToTypenum};

/// LU with partial pivoting.
#[derive(Clone, Debug)]
pub enum Lu {}

impl<const N: usize, const M: usize> Solver<N, M> for Lu
where
    Const<N>: ToTypenum + DimMin<Const<N>, Output = Const<N>>,
{
    #[inline]
    fn solve(springs: &Springs, s: f64, stiffness: &[f64; M], b: &[f64; M]) -> [f64; M] {
        let mut jacobian = SMatrix::<f64, N, N>::zeros();
        for i in 0..N {
            jacobian[(i, i)] = springs.m + s * s * (stiffness[i] + stiffness[i + 1]);
            if i > 0 {
                jacobian[(i, i - 1)] = -s * s * stiffness[i];
                jacobian[(i - 1, i)] = -s * s * stiffness[i];
            }
        }
        let b = SVector::<f64, N>::from_fn(|i, _| b[i]);
        let solution = jacobian.lu().solve(&b).expect("a diagonal that dominates");
        let mut x = [0.0; M];
        x[..N].copy_from_slice(solution.as_slice());
        x
    }
}
