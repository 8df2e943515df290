//! Midpoint steps of point masses in a uniform field, in the impulses alone.
//!
//! With a constant diagonal M and a force F(t), the velocity is affine in the impulses λ, and k equations remain:
//!
//! ```text
//! v = M⁻¹(p0 + (h/2) F + A0ᵀλ)        g(t1, q0 + h v)/h = 0        S = A1 M⁻¹ A0ᵀ
//! p1 = p0 + h F + A0ᵀλ + A1ᵀμ         A1 M⁻¹ p1 + a1 = 0           S = A1 M⁻¹ A1ᵀ
//! ```
//!
//! S couples constraints that share a coordinate: three diagonals for a chain. Its pivots are positive for short steps,
//! in any order of elimination; the fewest couplings come first. The general solver takes steps with
//! a pivot that is not positive, a residual above the floor, or rows that fill S.

use super::diagonal;
use super::equations::Configuration;
use super::solved::{SETTLED, Solved, contracted};
use crate::kind::Multipliers;
use crate::linear::{Rectangular, Row};
use crate::motion::Motion;
use crate::newton::FLOOR;
use crate::node::Node;
use crate::vector::worse;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;
use nalgebra::SVector;

/// Largest number of entries of S for each constraint, those of its elimination included.
const FILLED: usize = 12;
/// Smallest part of a diagonal entry that elimination may leave.
const KEPT: f64 = 1e-8;
/// The factors of S serve a further iteration if the residual fell by this factor.
const FALLEN: f64 = 0.1;
const ITERATIONS: u32 = 12;

/// Buffers and patterns of the solver. No result depends on them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reduced {
    /// Coordinates of a point: a row of A has entries at all of them, or at none.
    dimension: usize,
    pattern: Pattern,
    schur: Schur,
    /// The diagonal of M⁻¹.
    inverse: Vec<f64>,
    /// A at the start of the step, and M⁻¹Aᵀ.
    first: Vec<f64>,
    weighted: Vec<f64>,
    /// A and a at the end of the step.
    last: Vec<f64>,
    rates: Vec<f64>,
    /// Coordinates of `last`.
    end: Vec<f64>,
    known: Vec<f64>,
    /// The terms of each row.
    scales: Vec<f64>,
}

/// The nonzeros of A.
#[derive(Clone, Debug, Default)]
struct Pattern {
    /// Row by row.
    parts: Vec<Part>,
    /// Whether the first row has point 0 alone, and row r the points r − 1 and r: loops then need no list.
    is_chain: bool,
}

/// The entries of a row of A at a point.
#[derive(Clone, Copy, Debug)]
struct Part {
    row: usize,
    point: usize,
}

impl Pattern {
    fn new(parts: Vec<Part>) -> Self {
        let is_next = |(index, part): (usize, &Part)| part.row == index.div_ceil(2) && part.point == index / 2;
        let is_chain = parts.len() % 2 == 1 && parts.iter().enumerate().all(is_next);
        Self { parts, is_chain }
    }

    /// Adds the products of the rows of A and x, as `f` adds a product of two entries.
    #[inline(always)]
    fn add_products<const D: usize>(&self, a: &[f64], x: &[f64], rows: &mut [f64], f: impl Fn(f64, f64) -> f64) {
        let ((a, _), (x, _)) = (a.as_chunks::<D>(), x.as_chunks::<D>());
        let add =
            |row: &mut f64, a: &[f64; D], x: &[f64; D]| *row = a.iter().zip(x).fold(*row, |sum, (a, x)| f(sum, a * x));
        match (a, &mut *rows) {
            ([first, pairs @ ..], [row, rows @ ..]) if self.is_chain => {
                add(row, first, &x[0]);
                let (pairs, _) = pairs.as_chunks::<2>();
                for ((row, [before, own]), points) in rows.iter_mut().zip(pairs).zip(x.windows(2)) {
                    add(row, before, &points[0]);
                    add(row, own, &points[1]);
                }
            }
            _ => {
                for (Part { row, point }, a) in self.parts.iter().zip(a) {
                    add(&mut rows[*row], a, &x[*point]);
                }
            }
        }
    }

    /// Adds the terms of `AᵀΛ`, as `f` adds a term.
    #[inline(always)]
    fn add_terms<const D: usize>(&self, a: &[f64], multipliers: &[f64], sums: &mut [f64], f: impl Fn(f64, f64) -> f64) {
        let ((a, _), (sums, _)) = (a.as_chunks::<D>(), sums.as_chunks_mut::<D>());
        let add = |sums: &mut [f64; D], a: &[f64; D], multiplier: f64| {
            sums.iter_mut().zip(a).for_each(|(sum, a)| *sum = f(*sum, a * multiplier));
        };
        if self.is_chain {
            let (pairs, last) = a.as_chunks::<2>();
            for ((sums, [own, next]), multipliers) in sums.iter_mut().zip(pairs).zip(multipliers.windows(2)) {
                add(sums, own, multipliers[0]);
                add(sums, next, multipliers[1]);
            }
            add(&mut sums[pairs.len()], &last[0], multipliers[pairs.len()]);
        } else {
            for (Part { row, point }, a) in self.parts.iter().zip(a) {
                add(&mut sums[*point], a, multipliers[*row]);
            }
        }
    }
}

/// S and its factors.
#[derive(Clone, Debug, Default)]
struct Schur {
    values: Vec<f64>,
    reciprocals: Vec<f64>,
    /// Entries of S, with two parts of A whose product adds to them.
    products: Vec<[u32; 3]>,
    /// The pivots in order.
    pivots: Vec<Pivot>,
    /// For each pivot its later rows, and the entries of S in its column and in its row.
    later: Vec<[u32; 3]>,
    /// For each pivot, the entries of S in these rows and columns, by rows.
    targets: Vec<u32>,
    /// Whether S has three diagonals: the values are those of one row after the other, with the entry below the diagonal
    /// after the one above it.
    is_tridiagonal: bool,
}

/// A step of the elimination.
#[derive(Clone, Copy, Debug)]
struct Pivot {
    unknown: u32,
    entry: u32,
    /// End of its later rows, and of its targets.
    later: u32,
    targets: u32,
}

impl Schur {
    /// The pattern of S for the parts of A; `None` if elimination fills it.
    fn new(Pattern { parts, .. }: &Pattern, count: usize) -> Option<Self> {
        let index = |index: usize| u32::try_from(index).ok();
        let mut at_point: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
        for (part, Part { row, point }) in parts.iter().enumerate() {
            at_point.entry(*point).or_default().push([*row, part]);
        }
        let mut pairs: BTreeMap<[usize; 2], Vec<[u32; 2]>> = BTreeMap::new();
        for parts in at_point.values() {
            for [row, left] in parts {
                for [column, right] in parts {
                    pairs.entry([*row, *column]).or_default().push([index(*left)?, index(*right)?]);
                }
            }
            if pairs.len() > FILLED * count.max(4) {
                return None;
            }
        }
        let mut coupled: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); count];
        for [row, column] in pairs.keys().filter(|[row, column]| row != column) {
            coupled[*row].insert(*column);
        }
        let mut places: BTreeMap<[usize; 2], u32> = BTreeMap::new();
        let place = |at: [usize; 2], places: &mut BTreeMap<[usize; 2], u32>| {
            let next = index(places.len())?;
            Some(*places.entry(at).or_insert(next))
        };
        let mut schur = Self::default();
        for (at, products) in &pairs {
            let entry = place(*at, &mut places)?;
            schur.products.extend(products.iter().map(|[left, right]| [entry, *left, *right]));
        }
        let mut left: BTreeSet<usize> = (0..count).collect();
        while let Some(pivot) = left.iter().copied().min_by_key(|row| coupled[*row].len()) {
            left.remove(&pivot);
            let later: Vec<usize> = core::mem::take(&mut coupled[pivot]).into_iter().collect();
            for row in &later {
                let [column, upper] = [[*row, pivot], [pivot, *row]].map(|at| place(at, &mut places));
                schur.later.push([index(*row)?, column?, upper?]);
                coupled[*row].remove(&pivot);
                coupled[*row].extend(later.iter().filter(|other| *other != row));
                for other in &later {
                    schur.targets.push(place([*row, *other], &mut places)?);
                }
            }
            let entry = place([pivot, pivot], &mut places)?;
            let (later, targets) = (index(schur.later.len())?, index(schur.targets.len())?);
            schur.pivots.push(Pivot { unknown: index(pivot)?, entry, later, targets });
            if places.len() > FILLED * count.max(4) {
                return None;
            }
        }
        schur.is_tridiagonal =
            pairs.len() + 2 == 3 * count && pairs.keys().all(|[row, column]| row.abs_diff(*column) < 2);
        schur.values = vec![0.0; places.len()];
        schur.reciprocals = vec![0.0; count];
        Some(schur)
    }

    /// Forms S from A and M⁻¹Aᵀ with D coordinates of a point, and factors it. False if a pivot is not positive.
    fn factor<const D: usize>(&mut self, is_chain: bool, left: &[f64], right: &[f64]) -> bool {
        let Self { values, products, .. } = self;
        let ((left, _), (right, _)) = (left.as_chunks::<D>(), right.as_chunks::<D>());
        let product = |sum: f64, a: &[f64; D], b: &[f64; D]| a.iter().zip(b).fold(sum, |sum, (a, b)| sum + a * b);
        if is_chain {
            tridiagonal::write(values, left, right, product);
        } else {
            values.fill(0.0);
            for [entry, a, b] in products.iter() {
                let value = &mut values[*entry as usize];
                *value = product(*value, &left[*a as usize], &right[*b as usize]);
            }
        }
        if self.is_tridiagonal {
            return tridiagonal::factor(&mut self.values, &mut self.reciprocals);
        }
        let Self { values, reciprocals, pivots, later, targets, .. } = self;
        let (mut start, mut first_target) = (0, 0);
        let mut is_positive = true;
        for pivot in pivots.iter() {
            let diagonal = values[pivot.entry as usize];
            let reciprocal = diagonal.recip();
            is_positive &= diagonal > 0.0;
            reciprocals[pivot.unknown as usize] = reciprocal;
            let rows = &later[start..pivot.later as usize];
            let targets = &targets[first_target..pivot.targets as usize];
            for (place, [_, column, _]) in rows.iter().enumerate() {
                let multiplier = values[*column as usize] * reciprocal;
                values[*column as usize] = multiplier;
                for ([_, _, upper], target) in rows.iter().zip(&targets[place * rows.len()..]) {
                    let eliminated = multiplier * values[*upper as usize];
                    values[*target as usize] -= eliminated;
                }
                // A small rest of the diagonal has lost its digits.
                let own = targets[place * rows.len() + place] as usize;
                is_positive &= values[own] > KEPT * (multiplier * values[rows[place][2] as usize]).abs();
            }
            (start, first_target) = (pivot.later as usize, pivot.targets as usize);
        }
        is_positive
    }

    /// Replaces b by the x with `S x = b`.
    fn solve(&self, b: &mut [f64]) {
        let Self { values, reciprocals, pivots, later, is_tridiagonal, .. } = self;
        if *is_tridiagonal {
            return tridiagonal::solve(values, reciprocals, b);
        }
        let mut start = 0;
        for pivot in pivots {
            let known = b[pivot.unknown as usize];
            for [row, column, _] in &later[start..pivot.later as usize] {
                b[*row as usize] -= values[*column as usize] * known;
            }
            start = pivot.later as usize;
        }
        for (index, pivot) in pivots.iter().enumerate().rev() {
            let start = if index == 0 { 0 } else { pivots[index - 1].later as usize };
            let rows = &later[start..pivot.later as usize];
            let known = b[pivot.unknown as usize];
            let rest =
                rows.iter().fold(known, |rest, [row, _, upper]| rest - values[*upper as usize] * b[*row as usize]);
            b[pivot.unknown as usize] = rest * reciprocals[pivot.unknown as usize];
        }
    }
}

/// S of a chain, in three diagonals.
mod tridiagonal {
    use super::KEPT;

    /// Diagonal, above it and below it, in a row and below the diagonal of this row.
    const WIDTH: usize = 3;

    /// S of a chain: row r has the parts 2r − 1 and 2r.
    #[inline(always)]
    pub(super) fn write<const D: usize>(
        values: &mut [f64],
        left: &[[f64; D]],
        right: &[[f64; D]],
        product: impl Fn(f64, &[f64; D], &[f64; D]) -> f64,
    ) {
        values[0] = product(0.0, &left[0], &right[0]);
        let rows = values[1..].as_chunks_mut::<WIDTH>().0.iter_mut();
        for (([upper, lower, diagonal], left), right) in
            rows.zip(left.windows(3).step_by(2)).zip(right.windows(3).step_by(2))
        {
            *upper = product(0.0, &left[0], &right[1]);
            *lower = product(0.0, &left[1], &right[0]);
            *diagonal = product(product(0.0, &left[1], &right[1]), &left[2], &right[2]);
        }
    }

    /// As [`Schur::factor`](super::Schur::factor).
    pub(super) fn factor(values: &mut [f64], reciprocals: &mut [f64]) -> bool {
        let (mut diagonal, mut is_positive) = (values[0], true);
        let (rows, _) = values[1..].as_chunks_mut::<WIDTH>();
        for ([upper, lower, next], reciprocal) in rows.iter_mut().zip(&mut *reciprocals) {
            *reciprocal = diagonal.recip();
            is_positive &= diagonal > 0.0;
            *lower *= *reciprocal;
            let eliminated = *lower * *upper;
            *next -= eliminated;
            // A small rest of the diagonal has lost its digits.
            is_positive &= *next > KEPT * eliminated.abs();
            diagonal = *next;
        }
        if let Some(reciprocal) = reciprocals.last_mut() {
            *reciprocal = diagonal.recip();
        }
        is_positive && diagonal > 0.0
    }

    /// As [`Schur::solve`](super::Schur::solve).
    pub(super) fn solve(values: &[f64], reciprocals: &[f64], b: &mut [f64]) {
        let (rows, _) = values[1..].as_chunks::<WIDTH>();
        let mut known = b[0];
        for ([_, lower, _], b) in rows.iter().zip(&mut b[1..]) {
            *b -= lower * known;
            known = *b;
        }
        let last = b.len() - 1;
        known *= reciprocals[last];
        b[last] = known;
        for (([upper, ..], reciprocal), b) in rows.iter().zip(reciprocals).zip(b).rev() {
            *b = (*b - upper * known) * reciprocal;
            known = *b;
        }
    }
}

impl Reduced {
    /// Allocates; `None` if the system needs the general solver.
    pub(crate) fn new<S: Motion<N>, const N: usize>(system: &S, node: &Node<N>) -> Option<Self> {
        let count = system.constraint_names().len();
        if !system.has_point_masses() || system.holonomic() < count {
            return None;
        }
        let (gradients, _) = system.constraint_gradients(node.t, &node.q);
        let (dimension, parts) = [3, 2, 1].into_iter().find_map(|d| Some((d, parts(&gradients, d)?)))?;
        let pattern = Pattern::new(parts);
        let schur = Schur::new(&pattern, count)?;
        let zeros = vec![0.0; pattern.parts.len() * dimension];
        let [first, weighted, last] = [zeros.clone(), zeros.clone(), zeros];
        let (inverse, end) = (vec![0.0; N], vec![f64::NAN; N]);
        let [rates, known, scales] = core::array::from_fn(|_| vec![0.0; count]);
        Some(Self { dimension, pattern, schur, inverse, first, weighted, last, rates, end, known, scales })
    }

    /// A and M⁻¹ at the start of a step. `is_next` if the step follows the last one of the same system. False if a mass
    /// is not positive.
    fn begin<S: Motion<N>, const N: usize, const D: usize>(
        &mut self,
        system: &S,
        node: &Node<N>,
        is_next: bool,
    ) -> bool {
        let is_known = is_next && node.q.as_slice() == self.end;
        self.end.fill(f64::NAN);
        if is_known {
            // Its end has divided A by the masses.
            core::mem::swap(&mut self.first, &mut self.last);
            return true;
        }
        let masses = diagonal(&system.point(node.t, &node.q, &SVector::zeros()).mass);
        for (inverse, mass) in self.inverse.iter_mut().zip(&masses) {
            *inverse = mass.recip();
        }
        let (gradients, _) = system.constraint_gradients(node.t, &node.q);
        write(&gradients, &mut self.first);
        weigh::<D>(&self.pattern, &self.inverse, &self.first, &mut self.weighted);
        self.inverse.iter().all(|inverse| *inverse > 0.0)
    }

    /// The velocity M⁻¹ p.
    #[inline(always)]
    fn velocity<const N: usize>(&self, p: &SVector<f64, N>) -> SVector<f64, N> {
        let mut v = *p;
        v.iter_mut().zip(&self.inverse).for_each(|(v, inverse)| *v *= inverse);
        v
    }

    /// Writes `A1 v + a1` to `known`.
    #[inline(always)]
    fn rate<const N: usize, const D: usize>(&mut self, v: &SVector<f64, N>) {
        self.known.copy_from_slice(&self.rates);
        self.pattern.add_products::<D>(&self.last, v.as_slice(), &mut self.known, |sum, term| sum + term);
    }

    /// Writes the sizes of the terms of `A1 x` to `scales`.
    #[inline(always)]
    fn scale<const N: usize, const D: usize>(&mut self, x: &SVector<f64, N>) {
        self.scales.fill(0.0);
        self.pattern.add_products::<D>(&self.last, x.as_slice(), &mut self.scales, |sum, term| sum + term.abs());
    }

    /// The largest of the known rows over its rounding. Its scale is that of the terms of `A1 x` and of a1.
    #[inline(always)]
    fn largest(&self, scale: impl Fn(f64, f64) -> f64) -> f64 {
        let scales = self.scales.iter().zip(&self.rates).map(|(terms, rate)| scale(*terms, rate.abs()));
        largest(self.known.iter().copied().zip(scales))
    }
}

/// The largest row over a rounding of its scale. NaN if a row is NaN or a scale is not finite.
#[inline(always)]
fn largest(rows: impl Iterator<Item = (f64, f64)>) -> f64 {
    let worst = rows.fold(0.0, |worst, (row, scale)| {
        // No branch: a row without terms is zero, and 0 ∞ is NaN.
        worse(row.abs() / scale.max(f64::MIN_POSITIVE) + 0.0 * scale, worst)
    });
    worst / f64::EPSILON
}

/// The parts of A with points of this number of coordinates; `None` if one of these alone is in a row.
fn parts<const N: usize>(gradients: &impl Rectangular<N, f64>, dimension: usize) -> Option<Vec<Part>> {
    let mut parts = Vec::new();
    for (row, Row { columns, .. }) in gradients.rows().enumerate() {
        for columns in columns.chunks(dimension) {
            let point = columns[0] / dimension;
            if !columns.iter().copied().eq(point * dimension..(point + 1) * dimension) {
                return None;
            }
            parts.push(Part { row, point });
        }
    }
    N.is_multiple_of(dimension).then_some(parts)
}

/// Writes the entries of A.
#[inline(always)]
fn write<const N: usize>(gradients: &impl Rectangular<N, f64>, entries: &mut [f64]) {
    let mut start = 0;
    for Row { values, .. } in gradients.rows() {
        for (entry, value) in entries[start..].iter_mut().zip(values) {
            *entry = *value;
        }
        start += values.len();
    }
}

/// Writes M⁻¹Aᵀ.
#[inline(always)]
fn weigh<const D: usize>(Pattern { parts, .. }: &Pattern, inverse: &[f64], a: &[f64], weighted: &mut [f64]) {
    let ((a, _), (inverse, _), (weighted, _)) =
        (a.as_chunks::<D>(), inverse.as_chunks::<D>(), weighted.as_chunks_mut::<D>());
    for ((Part { point, .. }, a), weighted) in parts.iter().zip(a).zip(weighted) {
        let inverse = &inverse[*point];
        *weighted = core::array::from_fn(|k| a[k] * inverse[k]);
    }
}

/// Adds `AᵀΛ`.
#[inline(always)]
fn add<const N: usize, const D: usize>(pattern: &Pattern, a: &[f64], multipliers: &[f64], sum: &mut SVector<f64, N>) {
    pattern.add_terms::<D>(a, multipliers, sum.as_mut_slice(), |sum, term| sum + term);
}

/// `A0ᵀλ`, and the sizes of its terms.
#[inline(always)]
fn reaction<const N: usize, const D: usize>(pattern: &Pattern, a: &[f64], lambda: &[f64]) -> [SVector<f64, N>; 2] {
    let (mut reaction, mut sizes) = (SVector::<f64, N>::zeros(), SVector::<f64, N>::zeros());
    add::<N, D>(pattern, a, lambda, &mut reaction);
    pattern.add_terms::<D>(a, lambda, sizes.as_mut_slice(), |sum, term| sum + term.abs());
    [reaction, sizes]
}

/// Solves the step of length h from `node`, with the guess of the impulses in `u`; writes there velocities and
/// impulses, and returns the contraction as [`solve::unprojected`](super::solve::unprojected). `None` if the general
/// solver has to.
pub(crate) fn step<S: Motion<N>, const N: usize>(
    system: &S,
    of: (&Node<N>, f64, bool),
    u: &mut [f64],
    reduced: &mut Reduced,
) -> Option<(Solved<N, Multipliers<S, N>>, f64)> {
    match reduced.dimension {
        3 => step_of_points::<S, N, 3>(system, of, u, reduced),
        2 => step_of_points::<S, N, 2>(system, of, u, reduced),
        _ => step_of_points::<S, N, 1>(system, of, u, reduced),
    }
}

/// The same for points of D coordinates.
fn step_of_points<S: Motion<N>, const N: usize, const D: usize>(
    system: &S,
    (node, h, is_next): (&Node<N>, f64, bool),
    u: &mut [f64],
    reduced: &mut Reduced,
) -> Option<(Solved<N, Multipliers<S, N>>, f64)> {
    if !reduced.begin::<S, N, D>(system, node, is_next) {
        return None;
    }
    let (velocity, lambda) = u.split_at_mut(N);
    let (middle, t1) = (node.t + (node.t_low + h * 0.5), node.t + (node.t_low + h));
    let force = system.point(middle, &node.q, &SVector::zeros()).force;
    let mut v = reduced.velocity(&(node.p + (node.p_low + force * (h * 0.5))));
    add::<N, D>(&reduced.pattern, &reduced.weighted, lambda, &mut v);

    let (mut iterations, mut before, mut is_factored, mut contraction) = (0, f64::INFINITY, false, 0.0);
    let residual = loop {
        let end: Configuration<N, f64> = (t1, node.q + (node.q_low + v * h));
        let residual = constraints::<S, N, D>(system, &end, (h, before), reduced);
        contraction = contracted(contraction, [before, residual]);
        if !is_factored || residual > FLOOR && residual > FALLEN * before {
            is_factored = reduced.schur.factor::<D>(reduced.pattern.is_chain, &reduced.last, &reduced.weighted);
        }
        if !is_factored || residual.is_nan() || iterations == ITERATIONS {
            return None;
        }
        if residual <= 1.0 || residual <= FLOOR && iterations > 0 {
            reduced.end.copy_from_slice(end.1.as_slice());
            break residual;
        }
        reduced.schur.solve(&mut reduced.known);
        for (lambda, correction) in lambda.iter_mut().zip(&mut reduced.known) {
            *correction = -*correction;
            *lambda += *correction;
        }
        add::<N, D>(&reduced.pattern, &reduced.weighted, &reduced.known, &mut v);
        (before, iterations) = (residual, iterations + 1);
    };
    velocity.copy_from_slice(v.as_slice());
    let [reaction, sizes] = reaction::<N, D>(&reduced.pattern, &reduced.first, lambda);
    let residual = worse(momenta(system, (node, h, &v), &reaction, &sizes), residual);
    let (end, mu, of_velocity) = projected::<S, N, D>(system, (node, h, &v), force * h + reaction, reduced)?;
    let residual = worse(of_velocity, residual);
    // False for NaN.
    (residual <= FLOOR).then_some((Solved { end, mu, residual, iterations }, contraction))
}

/// g/h at the end of a step, in `known`, and A and a there. Returns the largest row over its rounding. The scales are
/// those of the residual `before` if it is settled.
#[inline(always)]
fn constraints<S: Motion<N>, const N: usize, const D: usize>(
    system: &S,
    (t, q): &Configuration<N, f64>,
    (h, before): (f64, f64),
    reduced: &mut Reduced,
) -> f64 {
    let (gradients, rates) = system.constraint_gradients(*t, q);
    write(&gradients, &mut reduced.last);
    reduced.rates.copy_from_slice(rates.as_ref());
    for (known, value) in reduced.known.iter_mut().zip(system.constraints(*t, q).as_ref()) {
        *known = value / h;
    }
    // True at the first residual.
    if before > SETTLED {
        reduced.scale::<N, D>(q);
    }
    reduced.largest(|terms, rate| terms / h.abs() + rate)
}

/// The largest momentum row over its rounding.
#[inline(always)]
fn momenta<S: Motion<N>, const N: usize>(
    system: &S,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    reaction: &SVector<f64, N>,
    sizes: &SVector<f64, N>,
) -> f64 {
    let (t, q) = node.midpoint(h, v);
    let point = system.point(t, &q, v);
    largest((0..N).map(|i| {
        let of_force = point.force[i] * (h * 0.5);
        let row = ((point.momentum[i] - node.p[i]) - node.p_low[i]) - (of_force + reaction[i]);
        // M v is the only term of its row.
        let scale = node.p[i].abs() + 2.0 * point.momentum[i].abs() + of_force.abs() + sizes[i];
        (row, scale)
    }))
}

/// The end of a step with consistent momenta, the impulse for that, and the residual of `A v + a`.
#[inline(always)]
fn projected<S: Motion<N>, const N: usize, const D: usize>(
    system: &S,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    mut increment: SVector<f64, N>,
    reduced: &mut Reduced,
) -> Option<(Node<N>, Multipliers<S, N>, f64)> {
    weigh::<D>(&reduced.pattern, &reduced.inverse, &reduced.last, &mut reduced.weighted);
    if !reduced.schur.factor::<D>(reduced.pattern.is_chain, &reduced.last, &reduced.weighted) {
        return None;
    }
    let mut mu = system.constraints(node.t, &node.q);
    reduced.rate::<N, D>(&reduced.velocity(&(node.p + (node.p_low + increment))));
    reduced.schur.solve(&mut reduced.known);
    for (mu, rate) in mu.as_mut().iter_mut().zip(&reduced.known) {
        *mu = -rate;
    }
    add::<N, D>(&reduced.pattern, &reduced.last, mu.as_ref(), &mut increment);
    let mut end = *node;
    end.advance(h, v, &increment);
    // The increment of the momenta was rounded. Its part across the constraints goes into a second, tiny impulse.
    reduced.rate::<N, D>(&reduced.velocity(&(end.p + end.p_low)));
    reduced.schur.solve(&mut reduced.known);
    let mut rest = SVector::zeros();
    for (mu, rate) in mu.as_mut().iter_mut().zip(&mut reduced.known) {
        *rate = -*rate;
        *mu += *rate;
    }
    add::<N, D>(&reduced.pattern, &reduced.last, &reduced.known, &mut rest);
    end.add_momentum(&rest);
    let v = reduced.velocity(&(end.p + end.p_low));
    reduced.rate::<N, D>(&v);
    reduced.scale::<N, D>(&v);
    // p and v are rounded too.
    let residual = reduced.largest(|terms, rate| 3.0 * (terms + rate));
    end.is_finite().then_some((end, mu, residual))
}

#[cfg(test)]
mod tests {
    use super::{Part, Pattern, Schur};

    /// A chain of four points on a line, the first one at a fixed end.
    fn chain() -> Pattern {
        let of = |row: usize, point: usize| Part { row, point };
        Pattern::new(vec![of(0, 0), of(1, 0), of(1, 1), of(2, 1), of(2, 2), of(3, 2), of(3, 3)])
    }

    const LEFT: [f64; 7] = [1.1, -0.9, 1.2, -0.8, 1.3, -0.7, 1.4];

    #[test]
    fn a_chain_has_the_bits_of_its_list() {
        let chain = chain();
        assert!(chain.is_chain);
        let list = Pattern { is_chain: false, ..chain.clone() };
        let of = |pattern: &Pattern| {
            // The last point is in no row.
            let (mut rows, mut sums) = ([0.1, 0.2, 0.3, 0.4], [0.5, 0.6, 0.7, 0.8, 0.9]);
            pattern.add_products::<1>(&LEFT, &[1.7, -0.3, 0.9, 2.1, 4.0], &mut rows, |sum, term| sum + term);
            pattern.add_terms::<1>(&LEFT, &[0.7, -1.3, 0.6, 1.9], &mut sums, |sum, term| sum + term.abs());
            (rows.map(f64::to_bits), sums.map(f64::to_bits))
        };
        assert_eq!(of(&chain), of(&list));
        assert_eq!(of(&chain).1[4], 0.9_f64.to_bits());
    }

    #[test]
    fn three_diagonals_have_the_bits_of_any_order() {
        let right = [0.9, -1.1, 1.0, -1.2, 0.8, -0.6, 1.5];
        let solved = |is_tridiagonal: bool, is_chain: bool| {
            let chain = chain();
            let mut schur = Schur::new(&chain, 4).expect("no fill");
            assert!(schur.is_tridiagonal && chain.is_chain);
            schur.is_tridiagonal = is_tridiagonal;
            assert!(schur.factor::<1>(is_chain, &LEFT, &right));
            let mut b = [1.0, -2.0, 3.0, 0.5];
            schur.solve(&mut b);
            b.map(f64::to_bits)
        };
        assert_eq!(solved(true, true), solved(false, false));
        assert_eq!(solved(true, false), solved(false, false));
        // A star has no three diagonals.
        let of = |row: usize, point: usize| Part { row, point };
        let star = Pattern::new(vec![of(0, 0), of(1, 0), of(1, 1), of(2, 0), of(2, 2)]);
        assert!(!Schur::new(&star, 3).expect("no fill").is_tridiagonal && !star.is_chain);
    }
}
