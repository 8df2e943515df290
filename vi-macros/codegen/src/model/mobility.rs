//! Whether as many constraints as coordinates, or more, leave a motion.
//!
//! In: the constraints. Out: whether a mechanism with the default parameters moves. Counting does not decide: the
//! constraints of a parallelogram with three cranks are independent everywhere but where all of them hold. So damped
//! Gauss–Newton iteration (Levenberg and Marquardt) looks for coordinates at which they hold, from points of a fixed
//! sequence:
//!
//! ```text
//! (JᵀJ + λ diag JᵀJ) δ = −Jᵀ g        J = ∂g/∂q
//! ```
//!
//! The mechanism moves if the rank of A is below the number of coordinates at one of these places.

use super::probe::MARGIN;
use super::{Constraint, Parameter, probe};
use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Pool};

/// Starts of the iteration, and trial steps of each.
const STARTS: u32 = 16;
const TRIALS: u32 = 200;
/// Damping λ at a start, and the one at which a place counts as stationary.
const DAMPING: f64 = 1e-2;
const LARGEST_DAMPING: f64 = 1e12;
/// Rows of A of length 1 whose part across the others is below this are dependent: at a place where constraints depend
/// on each other, coordinates are known to half of the digits.
const DEPENDENT: f64 = 1e-5;
/// Most coordinates: beyond, a run decides.
const COORDINATES: usize = 60;

/// The end of an iteration.
enum End {
    /// The constraints hold at a place where A has this rank.
    Rank(usize),
    /// They come no nearer to holding.
    Stationary,
    /// Unknown.
    Lost,
}

/// Whether these constraints, with the rows of A, leave a motion at default parameters, or may.
pub(super) fn leave_motion(
    pool: &Pool<Symbol>,
    (constraints, rows): (&[Constraint], &[Vec<Expr>]),
    dimension: usize,
    parameters: &[Parameter],
) -> bool {
    if dimension > COORDINATES {
        return true;
    }
    let holonomic = constraints.iter().filter(|constraint| constraint.is_holonomic);
    let mut exprs: Vec<Expr> = holonomic.map(|constraint| constraint.value).collect();
    let values = exprs.len();
    // Holonomic constraints come first.
    exprs.extend(rows.iter().flatten());
    let linkage = Linkage { pool, exprs, values, dimension, parameters };
    let mut is_rigid = true;
    for start in 0..STARTS {
        match linkage.closed(start) {
            End::Rank(rank) if rank < dimension => return true,
            End::Lost => is_rigid = false,
            End::Rank(_) | End::Stationary => {}
        }
    }
    !is_rigid
}

/// g of the holonomic constraints and the rows A of all.
struct Linkage<'a> {
    pool: &'a Pool<Symbol>,
    exprs: Vec<Expr>,
    /// The number of holonomic constraints.
    values: usize,
    dimension: usize,
    parameters: &'a [Parameter],
}

/// The numbers at a place: g, whether each is zero to rounding, and A.
struct Numbers {
    g: Vec<f64>,
    holds: bool,
    rows: Vec<Vec<f64>>,
}

impl Linkage<'_> {
    /// `None` if a number has no value.
    fn at(&self, q: &[f64]) -> Option<Numbers> {
        let numbers = self.pool.evaluate_rounded(&self.exprs, &mut |symbol| match symbol {
            Symbol::Continuous(Variable::Coordinate(index)) => q[*index],
            Symbol::Parameter { index, .. } => self.parameters.get(*index).map_or(0.0, |parameter| parameter.default),
            _ => 0.0,
        });
        let (g, rows) = numbers.split_at(self.values);
        let numbers = Numbers {
            holds: g.iter().all(|value| value.value.abs() <= MARGIN * value.error.max(f64::EPSILON)),
            g: g.iter().map(|value| value.value).collect(),
            rows: rows.chunks(self.dimension).map(|row| row.iter().map(|entry| entry.value).collect()).collect(),
        };
        let is_finite = numbers.rows.iter().chain([&numbers.g]).flatten().all(|number| number.is_finite());
        is_finite.then_some(numbers)
    }

    /// The end of the iteration from a start.
    fn closed(&self, start: u32) -> End {
        let mut q: Vec<f64> = (0..self.dimension).map(|index| probe::near_one(start, index)).collect();
        let Some(mut now) = self.at(&q) else { return End::Lost };
        let mut damping = DAMPING;
        for _ in 0..TRIALS {
            if now.holds {
                return End::Rank(rank(now.rows));
            }
            if damping > LARGEST_DAMPING {
                return End::Stationary;
            }
            let next: Option<(Vec<f64>, Numbers)> = self.step(&now, damping).and_then(|step| {
                let next: Vec<f64> = q.iter().zip(step).map(|(entry, change)| entry + change).collect();
                let there = self.at(&next)?;
                (square(&there.g) < square(&now.g)).then_some((next, there))
            });
            match next {
                Some(next) => {
                    (q, now) = next;
                    damping /= 8.0;
                }
                None => damping *= 4.0,
            }
        }
        End::Lost
    }

    /// The damped step, by elimination without pivoting: the matrix is positive definite.
    fn step(&self, Numbers { g, rows, .. }: &Numbers, damping: f64) -> Option<Vec<f64>> {
        let (n, rows) = (self.dimension, &rows[..self.values]);
        let mut matrix = vec![vec![0.0; n]; n];
        let mut right = vec![0.0; n];
        for (row, value) in rows.iter().zip(g) {
            for (i, entry) in row.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                right[i] -= entry * value;
                row.iter().zip(&mut matrix[i]).for_each(|(other, sum)| *sum += entry * other);
            }
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            // A coordinate without a slope stays.
            row[i] = if row[i] > 0.0 { row[i] * (1.0 + damping.max(f64::EPSILON)) } else { 1.0 };
        }
        for pivot in 0..n {
            let (above, below) = matrix.split_at_mut(pivot + 1);
            let row = &above[pivot];
            for (other, index) in below.iter_mut().zip(pivot + 1..) {
                let factor = other[pivot] / row[pivot];
                other.iter_mut().zip(row).skip(pivot).for_each(|(entry, by)| *entry -= factor * by);
                right[index] -= factor * right[pivot];
            }
        }
        for pivot in (0..n).rev() {
            let known: f64 = (pivot + 1..n).map(|column| matrix[pivot][column] * right[column]).sum();
            right[pivot] = (right[pivot] - known) / matrix[pivot][pivot];
        }
        right.iter().all(|entry| entry.is_finite()).then_some(right)
    }
}

fn square(vector: &[f64]) -> f64 {
    vector.iter().map(|entry| entry * entry).sum()
}

/// The rank of rows, by orthogonalization with pivoting.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    for row in &mut rows {
        let length = square(row).sqrt();
        for entry in row.iter_mut() {
            *entry /= if length > 0.0 { length } else { 1.0 };
        }
    }
    let mut rank = 0;
    loop {
        let largest = (0..rows.len()).max_by(|one, other| square(&rows[*one]).total_cmp(&square(&rows[*other])));
        let Some(index) = largest.filter(|index| square(&rows[*index]).sqrt() > DEPENDENT) else { return rank };
        let chosen = rows.swap_remove(index);
        for row in &mut rows {
            let shadow = row.iter().zip(&chosen).map(|(a, b)| a * b).sum::<f64>() / square(&chosen);
            row.iter_mut().zip(&chosen).for_each(|(entry, by)| *entry -= shadow * by);
        }
        rank += 1;
    }
}
