//! Tables of any length, computed at run time.

use super::axis::{Axis, Outside};
use super::grid::{self, Piece};
use super::quintic::{self, Row};
use super::slopes::Buffers;
use super::{ascend, cubics, lines, piece, polynomial, undefined_along, uniform};
use crate::lagrangian::Undefined;
use crate::real::{Number, Real};
use alloc::vec;
use alloc::vec::Vec;

/// The interpolation of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubic pieces without overshoot.
    Monotone,
    /// The cubic spline.
    Cubic,
    /// The quintic spline.
    Quintic,
}

/// A [`Table`](super::Table), a [`Grid`](super::Grid) or a [`Uniform`](super::Uniform) table, with the same bits.
#[derive(Clone, Debug)]
pub struct AnyTable(Contents);

#[derive(Clone, Debug)]
enum Contents {
    /// The coefficients of each piece, and their number.
    Points { axis: Axis<Vec<f64>>, pieces: Vec<[f64; 6]>, count: usize },
    /// The nodes row by row.
    Grid { x: Axis<Vec<f64>>, y: Axis<Vec<f64>>, nodes: Vec<[f64; 4]>, is_linear: bool },
    /// The slopes of the cardinal functions at each knot, row by row; none of straight lines.
    Uniform { axis: Axis<Vec<f64>>, slopes: Option<Vec<f64>>, is_invalid: bool },
}

/// The axis of a list of knots.
fn axis(knots: &[f64], to: f64, outside: Outside) -> Axis<Vec<f64>> {
    Axis::measured(knots, to, outside).owned()
}

/// Calls `use_of` with buffers for `count` knots.
fn with_buffers<Y>(count: usize, use_of: impl FnOnce(&mut Buffers) -> Y) -> Y {
    use_of(&mut Buffers {
        values: &mut vec![0.0; count],
        slopes: &mut vec![0.0; count],
        rows: &mut vec![[0.0; 4]; count],
        others: &mut vec![[0.0; 2]; count],
    })
}

/// Zeros after the coefficients.
fn padded<const C: usize>(pieces: &[[f64; C]]) -> Vec<[f64; 6]> {
    pieces.iter().map(|piece| core::array::from_fn(|k| piece.get(k).copied().unwrap_or(0.0))).collect()
}

impl AnyTable {
    /// The function through two or more points: `knots` and `values` have one length. The last value of a periodic table
    /// is the first one.
    #[must_use]
    pub fn points(knots: &[f64], values: &[f64], of: Interpolation, outside: Outside) -> Self {
        let n = knots.len();
        let (mut pieces, count) = match of {
            Interpolation::Linear => {
                let mut pieces = vec![[0.0; 2]; n];
                lines(knots, values, &mut pieces);
                (padded(&pieces), 2)
            }
            Interpolation::Cubic | Interpolation::Monotone => {
                let mut pieces = vec![[0.0; 4]; n];
                with_buffers(n, |buffers| {
                    buffers.values.copy_from_slice(values);
                    if of == Interpolation::Cubic {
                        buffers.spline(knots, outside);
                    } else {
                        buffers.monotone(knots, outside);
                    }
                    cubics(knots, values, buffers.slopes, &mut pieces);
                });
                (padded(&pieces), 4)
            }
            Interpolation::Quintic => {
                let mut pieces = vec![[0.0; 6]; n];
                let mut buffers = quintic::Buffers {
                    rows: &mut vec![Row::ZERO; n],
                    known: &mut vec![[0.0; 2]; n],
                    above: &mut vec![quintic::ZERO; n],
                    by_last: &mut vec![quintic::ZERO; n],
                };
                quintic::pieces_of(knots, values, outside == Outside::Periodic, &mut pieces, &mut buffers);
                (pieces, 6)
            }
        };
        if !ascend(knots) {
            pieces.fill([f64::NAN; 6]);
        }
        Self(Contents::Points { axis: axis(knots, knots[n - 1], outside), pieces, count })
    }

    /// The function through the points of a grid, whose values are row by row: one row for each knot of x. Cubic or
    /// linear.
    #[must_use]
    pub fn grid([x, y]: [&[f64]; 2], values: &[f64], of: Interpolation, outside: Outside) -> Self {
        let (m, n) = (x.len(), y.len());
        let mut nodes = vec![[0.0; 4]; m * n];
        with_buffers(m, |along_x| {
            with_buffers(n, |along_y| grid::joined([x, y], values, [outside; 2], &mut nodes, along_x, along_y));
        });
        if !(ascend(x) && ascend(y)) {
            nodes.fill([f64::NAN; 4]);
        }
        let [x, y] = [x, y].map(|knots| axis(knots, knots[knots.len() - 1], outside));
        Self(Contents::Grid { x, y, nodes, is_linear: of == Interpolation::Linear })
    }

    /// The function of `count` values at equal distances of a range, which are given when it is evaluated. Cubic or
    /// linear. A periodic one has no value at the end of the range.
    #[must_use]
    pub fn uniform(ends: [f64; 2], count: usize, of: Interpolation, outside: Outside) -> Self {
        let mut knots = vec![0.0; count];
        let is_periodic = outside == Outside::Periodic;
        uniform::spread(ends, if is_periodic { count } else { count - 1 }, &mut knots);
        if !is_periodic {
            knots[count - 1] = ends[1];
        }
        let slopes = (of != Interpolation::Linear).then(|| {
            let mut slopes = vec![0.0; count * count];
            with_buffers(count, |buffers| {
                if is_periodic {
                    uniform::periodic_slopes(ends, &mut slopes, buffers);
                } else {
                    uniform::cardinal_slopes(&knots, &mut slopes, buffers);
                }
            });
            slopes
        });
        let is_invalid = !ascend(&knots);
        Self(Contents::Uniform { axis: axis(&knots, ends[1], outside), slopes, is_invalid })
    }

    /// The derivative of these orders, up to three together, with respect to x and y, at (x, y). Only grids use y and
    /// its order, only tables of parameters use `values`.
    #[inline]
    pub fn derivative<T: Number>(&self, [along_x, along_y]: [usize; 2], [x, y]: [T; 2], values: &[T]) -> T {
        match &self.0 {
            Contents::Points { axis, pieces, count } => {
                let (u, coefficients) = piece(axis, pieces, x);
                match count {
                    2 => polynomial::<_, 2>(&coefficients, u, along_x),
                    4 => polynomial::<_, 4>(&coefficients, u, along_x),
                    _ => polynomial::<_, 6>(&coefficients, u, along_x),
                }
            }
            Contents::Grid { x: of_x, y: of_y, nodes, is_linear } => {
                Piece::at((of_x, of_y), nodes, *is_linear, [x, y]).derivative(along_x, along_y)
            }
            Contents::Uniform { axis, slopes, is_invalid } => {
                let (u, coefficients) = uniform::piece(axis, (slopes.as_deref(), *is_invalid), x, values);
                polynomial::<_, 4>(&coefficients, u, along_x)
            }
        }
    }

    /// The number of values that are given when the function is evaluated.
    #[must_use]
    #[inline]
    pub fn parameters(&self) -> usize {
        match &self.0 {
            Contents::Uniform { axis, .. } => axis.knots.len(),
            Contents::Points { .. } | Contents::Grid { .. } => 0,
        }
    }

    /// The reason why the function is NaN at these arguments, as [`Table::undefined`](super::Table::undefined).
    pub fn undefined<T: Real>(&self, function: &'static str, [x, y]: [T; 2]) -> Option<Undefined> {
        match &self.0 {
            Contents::Points { axis, .. } | Contents::Uniform { axis, .. } => {
                undefined_along(axis, function, x.to_f64())
            }
            Contents::Grid { x: of_x, y: of_y, .. } => {
                undefined_along(of_x, function, x.to_f64()).or_else(|| undefined_along(of_y, function, y.to_f64()))
            }
        }
    }
}
