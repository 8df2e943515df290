//! A table of two arguments on a rectangular grid.

use super::axis::{Axis, Outside};
use super::slopes::{Arrays, Buffers};
use super::{ascend, distance, polynomial, slopes, undefined_along};
use crate::function::{Gradient, Hessian, Jets, ThirdDerivatives};
use crate::lagrangian::Undefined;
use crate::real::{Number, Real};

/// A function of two numbers x and y, through M × N points.
///
/// The knots of both axes must ascend, and all numbers must be finite; otherwise the function is NaN. Outside of its
/// range it is NaN, unless [`hold`](Grid::hold), [`extend`](Grid::extend) or [`outside`](Grid::outside) says otherwise.
///
/// ```
/// use vi_core::function::Jets;
/// use vi_core::table::Grid;
///
/// // x y at x = 0, 1, 3 (rows) and y = 1, 2 (columns).
/// static AREA: Grid<3, 2> = Grid::cubic([0.0, 1.0, 3.0], [1.0, 2.0], [[0.0, 0.0], [1.0, 2.0], [3.0, 6.0]]);
/// let (value, gradient) = AREA.jet_1([2.0, 1.5]);
/// assert_eq!((value, gradient), (3.0, [1.5, 2.0]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Grid<const M: usize, const N: usize> {
    x: Axis<[f64; M]>,
    y: Axis<[f64; N]>,
    /// Value, slope along x, slope along y and mixed second derivative at each knot.
    nodes: [[[f64; 4]; N]; M],
    is_linear: bool,
}

impl<const M: usize, const N: usize> Grid<M, N> {
    /// The bicubic spline with continuous second derivatives, "not-a-knot" at every edge: it reproduces products of
    /// cubic polynomials. `values[i][j]` is the value at `(x[i], y[j])`.
    #[must_use]
    pub const fn cubic(x: [f64; M], y: [f64; N], values: [[f64; N]; M]) -> Self {
        Self::joined(x, y, &values, [Outside::Undefined; 2])
    }

    /// Bilinear pieces, continuous but with kinks. `values[i][j]` is the value at `(x[i], y[j])`.
    #[must_use]
    pub const fn linear(x: [f64; M], y: [f64; N], values: [[f64; N]; M]) -> Self {
        let mut grid = Self::joined(x, y, &values, [Outside::Undefined; 2]);
        grid.is_linear = true;
        grid
    }

    /// The values of the edge beyond it.
    #[must_use]
    pub const fn hold(self) -> Self {
        self.outside([Outside::Hold; 2])
    }

    /// Straight continuations with the slopes at the edge beyond it.
    #[must_use]
    pub const fn extend(self) -> Self {
        self.outside([Outside::Extend; 2])
    }

    /// Sets the continuation of the function beyond the edges, along x and along y. Along a periodic axis the last
    /// values must be the first ones.
    #[must_use]
    pub const fn outside(mut self, outside: [Outside; 2]) -> Self {
        let is_joined_in_x = self.x.is_periodic() == matches!(outside[0], Outside::Periodic);
        let is_joined_in_y = self.y.is_periodic() == matches!(outside[1], Outside::Periodic);
        if is_joined_in_x && is_joined_in_y {
            [self.x.outside, self.y.outside] = outside;
            return self;
        }
        let mut values = [[0.0; N]; M];
        let mut i = 0;
        while i < M {
            let mut j = 0;
            while j < N {
                values[i][j] = self.nodes[i][j][0];
                j += 1;
            }
            i += 1;
        }
        let mut grid = Self::joined(self.x.knots, self.y.knots, &values, outside);
        grid.is_linear = self.is_linear;
        grid
    }

    const fn joined(x: [f64; M], y: [f64; N], values: &[[f64; N]; M], outside: [Outside; 2]) -> Self {
        const { assert!(M >= 2 && N >= 2, "a grid needs two points on each axis") };
        let mut nodes = [[[0.0; 4]; N]; M];
        let (mut along_x, mut along_y) = (Arrays::new([0.0; M]), Arrays::new([0.0; N]));
        let (along_x, along_y) = (&mut along_x.buffers(), &mut along_y.buffers());
        joined([&x, &y], values.as_flattened(), outside, nodes.as_flattened_mut(), along_x, along_y);
        if !(ascend(&x) && ascend(&y)) {
            nodes = [[[f64::NAN; 4]; N]; M];
        }
        let (to_x, to_y) = (x[M - 1], y[N - 1]);
        Self { x: Axis::new(x, to_x, outside[0]), y: Axis::new(y, to_y, outside[1]), nodes, is_linear: false }
    }

    /// The first and the last knot of both axes.
    #[must_use]
    pub const fn ranges(&self) -> [[f64; 2]; 2] {
        [self.x.range, self.y.range]
    }

    /// The value at (x, y), in the numbers of a function `fn cl<T: Number>(a: T, b: T) -> T`. NaN for NaN.
    #[inline]
    pub fn at<T: Number>(&self, x: T, y: T) -> T {
        self.piece([x, y]).derivative(0, 0)
    }

    /// The reason why the function is NaN at (x, y): the first argument that is outside of its range, with this range.
    pub fn undefined<T: Real>(&self, function: &'static str, [x, y]: [T; 2]) -> Option<Undefined> {
        undefined_along(&self.x, function, x.to_f64()).or_else(|| undefined_along(&self.y, function, y.to_f64()))
    }

    #[inline(always)]
    fn piece<T: Number>(&self, arguments: [T; 2]) -> Piece<T> {
        Piece::at((&self.x, &self.y), self.nodes.as_flattened(), self.is_linear, arguments)
    }
}

/// Value, slope along x, slope along y and mixed second derivative at each knot, row by row.
pub(super) const fn joined(
    [x, y]: [&[f64]; 2],
    values: &[f64],
    outside: [Outside; 2],
    nodes: &mut [[f64; 4]],
    along_x: &mut Buffers,
    along_y: &mut Buffers,
) {
    let (m, n) = (x.len(), y.len());
    let mut j = 0;
    while j < n {
        let mut i = 0;
        while i < m {
            along_x.values[i] = values[i * n + j];
            i += 1;
        }
        along_x.spline(x, outside[0]);
        i = 0;
        while i < m {
            nodes[i * n + j] = [along_x.values[i], along_x.slopes[i], 0.0, 0.0];
            i += 1;
        }
        j += 1;
    }
    // Slopes along y: of the values, then of the slopes along x.
    let mut of = 0;
    while of < 2 {
        let mut i = 0;
        while i < m {
            j = 0;
            while j < n {
                along_y.values[j] = nodes[i * n + j][of];
                j += 1;
            }
            along_y.spline(y, outside[1]);
            j = 0;
            while j < n {
                nodes[i * n + j][2 + of] = along_y.slopes[j];
                j += 1;
            }
            i += 1;
        }
        of += 1;
    }
}

impl<T: Number> Piece<T> {
    /// The piece at (x, y) of a grid with these nodes.
    #[inline(always)]
    pub(super) fn at(
        axes: (&Axis<impl AsRef<[f64]>>, &Axis<impl AsRef<[f64]>>),
        nodes: &[[f64; 4]],
        is_linear: bool,
        [x, y]: [T; 2],
    ) -> Self {
        let [x0, x1, y0, y1, coefficients @ ..]: [T; 20] =
            T::lookup([x, y], |arguments| constants(axes, nodes, is_linear, arguments));
        let row = |a: usize| core::array::from_fn(|b| coefficients[4 * a + b]);
        Self {
            u: distance(axes.0, x, [x0, x1]),
            w: distance(axes.1, y, [y0, y1]),
            coefficients: core::array::from_fn(row),
        }
    }
}

/// The bases of the piece at (x, y), and its coefficients of `u^a w^b` in the order of a, then b.
#[inline]
fn constants(
    axes: (&Axis<impl AsRef<[f64]>>, &Axis<impl AsRef<[f64]>>),
    nodes: &[[f64; 4]],
    is_linear: bool,
    [x, y]: [f64; 2],
) -> [f64; 20] {
    let (at_x, at_y) = (axes.0.segment(x), axes.1.segment(y));
    let ([i, i_other], hx) = piece(axes.0.knots.as_ref(), at_x.index);
    let ([j, j_other], hy) = piece(axes.1.knots.as_ref(), at_y.index);
    let n = axes.1.knots.as_ref().len();
    let join = |h: f64, [y0, s0]: [f64; 2], [y1, s1]: [f64; 2]| {
        if is_linear { [y0, (y1 - y0) / h, 0.0, 0.0] } else { slopes::hermite(h, [y0, s0], [y1, s1]) }
    };
    // Along y: of the value, and of the slope along x.
    let along_y = |i: usize| {
        let ([f, fx, fy, fxy], [g, gx, gy, gxy]) = (nodes[i * n + j], nodes[i * n + j_other]);
        [join(hy, [f, fy], [g, gy]), join(hy, [fx, fxy], [gx, gxy])].map(|along| at_y.kept(along))
    };
    let ([values, by_x], [others, others_by_x]) = (along_y(i), along_y(i_other));
    let mut constants = [0.0; 20];
    constants[..4].copy_from_slice(&[at_x.base[0], at_x.base[1], at_y.base[0], at_y.base[1]]);
    for b in 0..4 {
        let along_x = at_x.kept(join(hx, [values[b], by_x[b]], [others[b], others_by_x[b]]));
        for (a, coefficient) in along_x.into_iter().enumerate() {
            constants[4 + 4 * a + b] = coefficient;
        }
    }
    constants
}

/// A knot and the other end of its piece, and their distance; from the last knot the piece goes back.
#[inline]
fn piece(knots: &[f64], index: usize) -> ([usize; 2], f64) {
    let other = if index + 1 < knots.len() { index + 1 } else { index - 1 };
    ([index, other], knots[other] - knots[index])
}

/// A polynomial in u and w.
pub(super) struct Piece<T> {
    u: T,
    w: T,
    /// The coefficient of `u^a w^b`.
    coefficients: [[T; 4]; 4],
}

impl<T: Number> Piece<T> {
    /// The derivative of these orders along x and y.
    #[inline(always)]
    pub(super) fn derivative(&self, along_x: usize, along_y: usize) -> T {
        let rows: [T; 4] = core::array::from_fn(|a| polynomial::<_, 4>(&self.coefficients[a], self.w, along_y));
        polynomial::<_, 4>(&rows, self.u, along_x)
    }

    #[inline(always)]
    fn gradient(&self) -> Gradient<T, 2> {
        [self.derivative(1, 0), self.derivative(0, 1)]
    }

    #[inline(always)]
    fn hessian(&self) -> Hessian<T, 2> {
        let mixed = self.derivative(1, 1);
        [[self.derivative(2, 0), mixed], [mixed, self.derivative(0, 2)]]
    }
}

impl<T: Real, const M: usize, const N: usize> Jets<T, 2> for Grid<M, N> {
    #[inline]
    fn jet_0(&self, [x, y]: [T; 2]) -> T {
        self.at(x, y)
    }

    #[inline]
    fn jet_1(&self, arguments: [T; 2]) -> (T, Gradient<T, 2>) {
        let piece = self.piece(arguments);
        (piece.derivative(0, 0), piece.gradient())
    }

    #[inline]
    fn jet_2(&self, arguments: [T; 2]) -> (T, Gradient<T, 2>, Hessian<T, 2>) {
        let piece = self.piece(arguments);
        (piece.derivative(0, 0), piece.gradient(), piece.hessian())
    }

    #[inline]
    fn jet_3(&self, arguments: [T; 2]) -> (T, Gradient<T, 2>, Hessian<T, 2>, ThirdDerivatives<T, 2>) {
        let piece = self.piece(arguments);
        let [xxx, xxy, xyy, yyy] = [[3, 0], [2, 1], [1, 2], [0, 3]].map(|[a, b]| piece.derivative(a, b));
        let third = [[[xxx, xxy], [xxy, xyy]], [[xxy, xyy], [xyy, yyy]]];
        (piece.derivative(0, 0), piece.gradient(), piece.hessian(), third)
    }
}
