//! Eigenvalues and null vectors of matrices of a size known at run time. Entries are finite.

use alloc::vec::Vec;
use nalgebra::linalg::{Schur, SymmetricEigen, balancing};
use nalgebra::{Complex, DMatrix, DVector};

/// Iterations of a decomposition for each row. Two or three are typical.
const ITERATIONS: usize = 100;

/// Multiples of the norm of a matrix that are added to its diagonal. Without exceptional shifts the QR iteration does
/// not change some orthogonal matrices, as that of a cyclic permutation; with an added diagonal it does.
const SHIFTS: [f64; 3] = [0.0, 0.37, -0.61];

/// The eigenvalues of a matrix, in the order of [`Linearization::eigenvalues`](super::Linearization::eigenvalues).
/// `None` if the QR iteration does not converge.
pub(super) fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let mut balanced = matrix.clone();
    balancing::balance_parlett_reinsch(&mut balanced);
    let size = balanced.nrows();
    let mut values = SHIFTS.into_iter().find_map(|shift| {
        let shift = shift * balanced.norm();
        let shifted = &balanced + DMatrix::from_diagonal_element(size, size, shift);
        let schur = Schur::try_new(shifted, f64::EPSILON, ITERATIONS * size)?;
        Some(schur.complex_eigenvalues().iter().map(|value| value - shift).collect::<Vec<_>>())
    })?;
    sort(&mut values);
    Some(values)
}

/// The squared frequencies ω² with `K x = ω² M x`, for a symmetric K and M, ascending. `None` if M is not positive
/// definite, or if the iteration does not converge.
pub(super) fn squared_frequencies(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Option<Vec<f64>> {
    let lower = m.clone().cholesky()?.unpack();
    // L⁻¹ K L⁻ᵀ
    let half = lower.solve_lower_triangular(k)?.transpose();
    let symmetric = lower.solve_lower_triangular(&half)?;
    let found = SymmetricEigen::try_new(symmetric, f64::EPSILON, ITERATIONS * m.nrows())?;
    let mut squares: Vec<f64> = found.eigenvalues.iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    Some(squares)
}

/// Sorts by the size of the imaginary part, then by the real part, then by the imaginary part.
pub(super) fn sort(values: &mut [Complex<f64>]) {
    let by = |f: fn(&Complex<f64>) -> f64| move |a: &Complex<f64>, b: &Complex<f64>| f(a).total_cmp(&f(b));
    values.sort_by(|a, b| by(|z| z.im.abs())(a, b).then_with(|| by(|z| z.re)(a, b)).then_with(|| by(|z| z.im)(a, b)));
}

/// A vector that a matrix maps to zero, to rounding; `None` for a regular matrix. `rows` and `columns` scale the matrix
/// so that its units do not matter.
pub(super) fn null_vector(matrix: &DMatrix<f64>, rows: &[f64], columns: &[f64]) -> Option<DVector<f64>> {
    let size = matrix.nrows();
    let scaled = DMatrix::from_fn(size, size, |i, j| matrix[(i, j)] * rows[i] * columns[j]);
    let found = scaled.try_svd(false, true, f64::EPSILON, ITERATIONS * size)?;
    let (index, smallest) = found.singular_values.argmin();
    // The entries themselves carry a few roundings.
    #[allow(clippy::cast_precision_loss)] // at most some hundred
    let is_singular = smallest <= 8.0 * f64::EPSILON * size as f64 * found.singular_values.max();
    let vector = found.v_t?.row(index).transpose();
    is_singular.then_some(vector)
}
