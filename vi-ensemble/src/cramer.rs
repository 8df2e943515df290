//! Up to three linear equations, in line.
//!
//! In: A in any of the forms of [`vi_core::linear`], and r. Out: the x with `A x = r`, by Cramer's rule; by the form of A
//! where there are more equations. Not finite where A is singular.
//!
//! `vi_core` has the same formulas for every kind of number, too long for the compiler to write them into the loops, which
//! become vector instructions only without a call.

use crate::lane::Lane;
use crate::sweep::Vector;
use nalgebra::SMatrix;
use vi_core::MomentumEquation;
use vi_core::linear::Matrix;

/// The solution for the Jacobian and the residual of a momentum equation.
#[inline(always)]
pub(crate) fn solve<const N: usize, const FUSED: bool, J: Matrix<N, Lane<FUSED>>>(
    equation: &MomentumEquation<N, Lane<FUSED>, J>,
) -> Vector<N, FUSED> {
    let (a, r) = (equation.jacobian.dense(), &equation.residual);
    let mut x = *r;
    match N {
        1 => x[0] = Lane::new(r[0].get() * a[(0, 0)].get().recip()),
        2 => {
            let ([[a00, a01], [a10, a11]], [r0, r1]) = numbers(&a, r);
            let reciprocal = difference::<FUSED>(a00, a11, a01, a10).recip();
            x[0] = Lane::new(difference::<FUSED>(a11, r0, a01, r1) * reciprocal);
            x[1] = Lane::new(difference::<FUSED>(a00, r1, a10, r0) * reciprocal);
        }
        3 => {
            let ([[a00, a01, a02], [a10, a11, a12], [a20, a21, a22]], [r0, r1, r2]) = numbers(&a, r);
            // The rows of the adjugate.
            let first = [(a11, a22, a12, a21), (a02, a21, a01, a22), (a01, a12, a02, a11)].map(minor::<FUSED>);
            let second = [(a12, a20, a10, a22), (a00, a22, a02, a20), (a02, a10, a00, a12)].map(minor::<FUSED>);
            let third = [(a10, a21, a11, a20), (a01, a20, a00, a21), (a00, a11, a01, a10)].map(minor::<FUSED>);
            let reciprocal = product::<FUSED>(first, [a00, a10, a20]).recip();
            for (entry, row) in x.iter_mut().zip([first, second, third]) {
                *entry = Lane::new(product::<FUSED>(row, [r0, r1, r2]) * reciprocal);
            }
        }
        _ => x = equation.jacobian.solve(r),
    }
    x
}

/// The first M rows and columns of A, and as many entries of r.
#[inline(always)]
fn numbers<const N: usize, const FUSED: bool, const M: usize>(
    a: &SMatrix<Lane<FUSED>, N, N>,
    r: &Vector<N, FUSED>,
) -> ([[f64; M]; M], [f64; M]) {
    let (mut rows, mut right) = ([[0.0; M]; M], [0.0; M]);
    for i in 0..M {
        for j in 0..M {
            rows[i][j] = a[(i, j)].get();
        }
        right[i] = r[i].get();
    }
    (rows, right)
}

/// `a b + c`.
#[inline(always)]
fn multiply_add<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// `a b − c d`.
#[inline(always)]
fn difference<const FUSED: bool>(a: f64, b: f64, c: f64, d: f64) -> f64 {
    multiply_add::<FUSED>(a, b, -(c * d))
}

#[inline(always)]
fn minor<const FUSED: bool>((a, b, c, d): (f64, f64, f64, f64)) -> f64 {
    difference::<FUSED>(a, b, c, d)
}

/// The scalar product.
#[inline(always)]
fn product<const FUSED: bool>([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> f64 {
    multiply_add::<FUSED>(a, x, multiply_add::<FUSED>(b, y, c * z))
}
