//! Arrays of stage values: N rows, one per coordinate, of S numbers, one per stage.
//!
//! A loop over the stages of a row, or over all stages of a point, vectorizes. Functions that take `n` leave out the rows
//! of coordinates at rest ([`Motion::moving`](crate::motion::Motion::moving)).

use super::points::{EquationForm, Points};
use super::tableau::Tableau;
use crate::linear::row_by_row;
use crate::node::Node;
use crate::real::{Lane, Lanes, Number, Real};
use nalgebra::SVector;

/// N vectors of S stages.
pub(crate) type Stages<const N: usize, const S: usize> = [[f64; S]; N];

/// Up to this number of coordinates the compiler vectorizes loops over the stages. Longer equations evaluate all stages
/// at once.
pub(crate) const LOOPED: usize = 3;

/// A number type of stage evaluations: one stage, or all stages at once.
pub(crate) trait AtStages<const S: usize>: Real {
    /// Number of evaluations for all stages.
    const EVALUATIONS: usize;
    /// Loads the number of an evaluation.
    fn of(row: &[f64; S], evaluation: usize) -> Self;
    /// Stores the number of an evaluation.
    fn put(self, row: &mut [f64; S], evaluation: usize);
}

macro_rules! one_at_a_time {
    ($([$($parameter:tt)*] $number:ty),*) => {$(
        impl<const S: usize $($parameter)*> AtStages<S> for $number {
            const EVALUATIONS: usize = S;
            #[inline(always)]
            fn of(row: &[f64; S], evaluation: usize) -> Self { Self::real(row[evaluation]) }
            #[inline(always)]
            fn put(self, row: &mut [f64; S], evaluation: usize) { row[evaluation] = self.to_f64(); }
        }
    )*};
}

one_at_a_time!([] f64, [, const FUSED: bool] Lane<FUSED>);

impl<const S: usize, const FUSED: bool> AtStages<S> for Lanes<S, FUSED> {
    const EVALUATIONS: usize = 1;
    #[inline(always)]
    fn of(row: &[f64; S], _evaluation: usize) -> Self {
        Self(*row)
    }
    #[inline(always)]
    fn put(self, row: &mut [f64; S], _evaluation: usize) {
        *row = self.0;
    }
}

/// Loads the vector of an evaluation.
#[inline(always)]
pub(crate) fn gathered<const N: usize, const S: usize, T: AtStages<S>>(
    n: usize,
    of: &Stages<N, S>,
    evaluation: usize,
) -> SVector<T, N> {
    let mut vector = [T::zero(); N];
    for k in 0..n {
        vector[k] = T::of(&of[k], evaluation);
    }
    vector.into()
}

/// Stores the vector of an evaluation.
#[inline(always)]
pub(crate) fn scatter<const N: usize, const S: usize, T: AtStages<S>>(
    n: usize,
    stages: &mut Stages<N, S>,
    evaluation: usize,
    vector: &SVector<T, N>,
) {
    for k in 0..n {
        vector[k].put(&mut stages[k], evaluation);
    }
}

/// The times of all stages of the step of length h from `node`.
#[inline(always)]
pub(crate) fn times<const N: usize, const S: usize, const FUSED: bool>(node: &Node<N>, h: f64) -> [f64; S] {
    let mut times = [0.0; S];
    for (i, t) in times.iter_mut().enumerate() {
        *t = time::<N, S, FUSED, f64>(node, h, i);
    }
    times
}

/// The vector of one stage.
#[inline(always)]
pub(crate) fn stage<const N: usize, const S: usize, T: Real>(of: &Stages<N, S>, i: usize) -> SVector<T, N> {
    let mut vector = [T::zero(); N];
    for k in 0..N {
        vector[k] = T::real(of[k][i]);
    }
    vector.into()
}

/// Sets the vector of one stage.
#[inline(always)]
pub(crate) fn set<const N: usize, const S: usize, T: Real>(
    stages: &mut Stages<N, S>,
    i: usize,
    vector: &SVector<T, N>,
) {
    for k in 0..N {
        stages[k][i] = vector[k].to_f64();
    }
}

/// The time of a stage of the step of length h from `node`.
#[inline(always)]
pub(crate) fn time<const N: usize, const S: usize, const FUSED: bool, T: Real>(node: &Node<N>, h: f64, i: usize) -> T {
    let c = const { &Tableau::<S>::VALUES.c };
    T::real(node.t + Lane::<FUSED>::multiply_add(h, c[i], node.t_low))
}

/// The mass matrix of a system at a node.
#[inline(always)]
pub(crate) fn mass<const N: usize, T: Real, Y: Points<N, T>>(system: &Y, node: &Node<N>) -> Y::Mass {
    system.at(T::real(node.t), &node.q.map(T::real), &SVector::zeros()).mass
}

/// The mass matrix of a system, if it is constant.
#[inline(always)]
pub(crate) fn constant_mass<const N: usize, T: Real, Y: Points<N, T>>(system: &Y, node: &Node<N>) -> Option<Y::Mass> {
    matches!(system.form(), EquationForm::Separable | EquationForm::ConstantMass).then(|| mass(system, node))
}

/// `base_i + Σ_j matrix_ij x_j` at the stages i. Two sums, because additions form a dependency chain.
#[inline(always)]
pub(crate) fn product<const S: usize, const FUSED: bool>(
    matrix: &[[f64; S]; S],
    x: &[f64; S],
    base: &[f64; S],
) -> [f64; S] {
    row_by_row();
    let mut even = *base;
    let mut odd = [0.0; S];
    for j in 0..S {
        let sum = if j % 2 == 0 { &mut even } else { &mut odd };
        for i in 0..S {
            sum[i] = Lane::<FUSED>::multiply_add(matrix[j][i], x[j], sum[i]);
        }
    }
    for i in 0..S {
        even[i] += odd[i];
    }
    even
}

/// Adds `matrix_i x_i` at the stages i.
#[inline(always)]
pub(crate) fn add_products<const N: usize, const S: usize, const FUSED: bool>(
    n: usize,
    to: &mut Stages<N, S>,
    matrix: &[Stages<N, S>; N],
    x: &Stages<N, S>,
) {
    for k in 0..n {
        for l in 0..n {
            for i in 0..S {
                to[k][i] = Lane::<FUSED>::multiply_add(matrix[k][l][i], x[l][i], to[k][i]);
            }
        }
    }
}

/// Extrapolates the polynomials through the stages of a step to the stages of the next one.
#[inline(always)]
pub(crate) fn extrapolated<const N: usize, const S: usize, const FUSED: bool>(
    n: usize,
    of: &Stages<N, S>,
) -> Stages<N, S> {
    let next = const { &Tableau::<S>::VALUES.next };
    let mut stages = [[0.0; S]; N];
    for k in 0..n {
        stages[k] = product::<S, FUSED>(next, &of[k], &[0.0; S]);
    }
    stages
}

/// `h b_j` for each stage.
#[inline(always)]
pub(crate) fn weights<const S: usize>(h: f64) -> [f64; S] {
    let b = const { &Tableau::<S>::VALUES.b };
    let mut weights = [0.0; S];
    for j in 0..S {
        weights[j] = h * b[j];
    }
    weights
}

/// `weights_j x_j` for each stage.
#[inline(always)]
pub(crate) fn scaled<const S: usize>(weights: &[f64; S], x: &[f64; S]) -> [f64; S] {
    let mut scaled = [0.0; S];
    for j in 0..S {
        scaled[j] = weights[j] * x[j];
    }
    scaled
}

/// Inverse scale of each row. A change times that, over ε, is in ulps.
pub(crate) type Roundings<const N: usize> = [f64; N];

/// The inverse of the largest entry of each row, and of `start`.
#[inline(always)]
pub(crate) fn roundings<const N: usize, const S: usize>(
    n: usize,
    of: &Stages<N, S>,
    start: &SVector<f64, N>,
) -> Roundings<N> {
    let mut scales = [0.0; N];
    for k in 0..n {
        row_by_row();
        let mut sizes = [0.0; S];
        for i in 0..S {
            sizes[i] = of[k][i].abs();
        }
        scales[k] = larger(maximum(&sizes), start[k].abs());
    }
    // Vector divisions.
    let mut roundings = [0.0; N];
    for k in 0..n {
        // Never zero, so that an infinite change stays infinite.
        roundings[k] = 1.0 / (scales[k] + f64::MIN_POSITIVE).min(f64::MAX);
    }
    roundings
}

/// The accuracy of stages that are solved to rounding, in ulps.
pub(crate) const EXACT: f64 = 1.0;

/// The units of stages that are solved to an accuracy: this number of ulps of the largest entry of each row, or a
/// rounding if that is larger.
#[inline(always)]
pub(crate) fn relaxed<const N: usize, const S: usize>(
    n: usize,
    mut roundings: Roundings<N>,
    of: &Stages<N, S>,
    accuracy: f64,
) -> Roundings<N> {
    if accuracy > EXACT {
        for k in 0..n {
            let unit = accuracy * maximum(&of[k].map(f64::abs));
            roundings[k] = roundings[k].min(1.0 / (unit + f64::MIN_POSITIVE).min(f64::MAX));
        }
    }
    roundings
}

/// The same for positions: this number of ulps of their distance from the node, or a rounding.
#[inline(always)]
pub(crate) fn relaxed_positions<const N: usize, const S: usize>(
    n: usize,
    roundings: Roundings<N>,
    x: &Stages<N, S>,
    (node, accuracy): (&Node<N>, f64),
) -> Roundings<N> {
    if accuracy > EXACT {
        let mut distances = *x;
        for k in 0..n {
            distances[k] = x[k].map(|entry| entry - node.q[k]);
        }
        return relaxed(n, roundings, &distances, accuracy);
    }
    roundings
}

/// Largest growth of a change in the units `after` relative to those `before`.
#[inline(always)]
pub(crate) fn growth<const N: usize>(n: usize, before: &Roundings<N>, after: &Roundings<N>) -> f64 {
    let mut growths = [0.0; N];
    for k in 0..n {
        growths[k] = after[k] / before[k];
    }
    maximum(&growths)
}

/// The largest change of an entry from `before` to `after`, in ulps. Sets `before` to `after`.
///
/// Unspecified if a stage is not finite: the [`StageIncrement`](super::fixed_point::StageIncrement) of the step then is not finite
/// either.
#[inline(always)]
pub(crate) fn change<const N: usize, const S: usize>(
    n: usize,
    before: &mut Stages<N, S>,
    after: &Stages<N, S>,
    roundings: &Roundings<N>,
) -> f64 {
    if const { N > LOOPED } {
        return change_of_many(n, before, after, roundings);
    }
    let mut changes = [0.0; N];
    for k in 0..n {
        let mut distances = [0.0; S];
        for i in 0..S {
            distances[i] = (after[k][i] - before[k][i]).abs();
        }
        changes[k] = maximum(&distances) * roundings[k];
    }
    *before = *after;
    maximum(&changes) / f64::EPSILON
}

/// The largest change as [`change`], computed for many rows: first of each stage, then of all.
#[inline(always)]
fn change_of_many<const N: usize, const S: usize>(
    n: usize,
    before: &mut Stages<N, S>,
    after: &Stages<N, S>,
    roundings: &Roundings<N>,
) -> f64 {
    let mut changes = [0.0; S];
    for k in 0..n {
        row_by_row();
        for i in 0..S {
            changes[i] = larger((after[k][i] - before[k][i]).abs() * roundings[k], changes[i]);
            before[k][i] = after[k][i];
        }
    }
    // Forces a store: otherwise LLVM narrows the loop to pairs of numbers.
    maximum(&core::hint::black_box(changes)) / f64::EPSILON
}

/// The larger of two numbers.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The largest of W numbers that are not negative.
#[inline(always)]
pub(crate) fn maximum<const W: usize>(of: &[f64; W]) -> f64 {
    by_pairs(of, larger)
}

/// The sum of W numbers.
#[inline(always)]
pub(crate) fn sum<const W: usize>(of: &[f64; W]) -> f64 {
    by_pairs(of, |a, b| a + b)
}

/// Reduces W numbers to one by pairs, which shortens the dependency chain.
#[inline(always)]
fn by_pairs<const W: usize>(of: &[f64; W], one: impl Fn(f64, f64) -> f64) -> f64 {
    let mut left = *of;
    let mut length = W;
    while length > 1 {
        let half = length.div_ceil(2);
        for i in 0..length - half {
            left[i] = one(left[i], left[i + half]);
        }
        length = half;
    }
    left[0]
}

/// The coefficients `u_k = (2k + 1) Σ_i b_i P_k(x_i) V_i` of values at the stages, in Legendre polynomials.
pub(crate) fn coefficients<const N: usize, const S: usize>(values: &Stages<N, S>) -> Stages<N, S> {
    let Tableau { to_legendre, .. } = const { &Tableau::<S>::VALUES };
    let mut coefficients = [[0.0; S]; N];
    for (row, values) in coefficients.iter_mut().zip(values) {
        for k in 0..S {
            for i in 0..S {
                row[k] += to_legendre[k][i] * values[i];
            }
        }
    }
    coefficients
}

/// Extrapolates the polynomials through the stages of a step to `place(c_i)`, in units of its length.
#[inline(always)]
pub(crate) fn at<const N: usize, const S: usize>(stages: &Stages<N, S>, place: impl Fn(f64) -> f64) -> Stages<N, S> {
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
