//! Large systems as statements in loops.
//!
//! In: a [`Model`] whose arrays of `let`s are symbols. Out: an [`Indexed`] system: recursions of `let`s and sums of L and
//! f, each with one body and the numbers that its instances read. Their count and the text that they become do not
//! depend on the lengths of the arrays. No expression of the result contains a coordinate or an entry of an array. It
//! contains [`Symbol::Access`](crate::symbol::Symbol) instead: the number that an instance reads at this place.
//!
//! | file | content |
//! |---|---|
//! | `lets` | which `let`s are recursions, and their rates |
//! | `body` | one expression for all instances, with its derivatives as operations |
//! | `dependence` | dependence of L and f on recursions, time, coordinates and velocities |
//! | `nest` | the loops over instances |
//! | `named` | the bodies with the names of their functions |
//! | `scale` | the time scale as a function of sums |
//! | `properties` | the properties found by the generator, in words |

mod body;
mod dependence;
mod lets;
mod named;
mod nest;
mod properties;
mod scale;

pub use body::{Body, Read, Value};
pub(crate) use dependence::needed;
#[cfg(feature = "inspect")]
pub(crate) use named::{NamedBody, Quantity};
pub(crate) use named::{PART, SCALE, named, part_name, sum_name};
pub use nest::{Affine, Nest};
pub use properties::documentation;
pub(crate) use properties::of_steps;
#[cfg(feature = "inspect")]
pub(crate) use properties::properties;
pub use scale::Scale;

use crate::limits::bounded;
use crate::messages::{Message, error};
use crate::model::{LetArray, Model, Role, Space};
use crate::program::Function;
use crate::rules::NamedRule;
use crate::symbol::Symbol;
use body::{Instance, Shape};
use dependence::{cyclic, has_mass_of_position, has_masses, is_autonomous, is_separable};
use lets::Lets;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive};
use std::collections::{BTreeMap, BTreeSet};
use syn::Result;
use vi_expr::{Expr, Node, Pool, Rational};

/// Maximum number of bodies: a system without repetition has as many as terms.
const BODIES: usize = 64;
/// Maximum number of derivatives of entries of recursions: half a megabyte of the stack.
const TANGENTS: usize = 65_536;
/// Maximum number of coordinates and velocities in one term, whose second derivatives are all written out.
const STATES: usize = 32;
/// Maximum number of loops for one array of `let`s.
const SEQUENCES: usize = 4;
/// Number of coordinates and velocities in a sum above which a product distributes over it.
const NUMBERS: usize = 6;

/// A large system.
#[allow(clippy::struct_excessive_bools, reason = "each is a finding of its own")]
pub struct Indexed {
    /// The checked system.
    pub model: Model,
    /// The declared rules; the first is the system's own.
    pub rules: Vec<&'static NamedRule>,
    /// Whether L and f are independent of time.
    pub autonomous: bool,
    /// For each coordinate, whether it is absent from L and has no force.
    pub cyclic: Vec<bool>,
    /// Whether no velocity appears in second derivatives with respect to velocities.
    pub has_mass_of_position: bool,
    /// Whether `L = Σ m_i v_i²/2 − V(t, q)` with constant m_i, and no force depends on a velocity.
    pub separable: bool,
    /// Recursions, in the order of evaluation.
    pub recursions: Vec<Recursion>,
    /// The terms of L.
    pub lagrangian: Vec<Sum>,
    /// The terms of f; the first number of an instance is the coordinate.
    pub force: Vec<Sum>,
    /// The terms of Rayleigh's function R.
    pub dissipation: Vec<Sum>,
    /// The time scale.
    pub scale: Option<Scale>,
    /// The terms of the constraints; the first number of an instance is the constraint.
    pub constraints: Vec<Sum>,
    /// Whether a constraint on velocities has a part without velocities: it does work.
    pub driven: bool,
}

/// Entries of arrays of `let`s, and their rates, in one loop.
pub struct Recursion {
    /// The bodies of a row, in order.
    pub parts: Vec<Part>,
    /// The loop over the rows.
    pub nest: Nest,
}

/// A body of a row.
pub struct Part {
    /// The body.
    pub body: Body,
    /// The array of each value.
    pub of: Vec<Read>,
    /// The first of the columns of the nest that belong to this body: the entries of the values, then the numbers that
    /// the body reads.
    pub first: usize,
}

/// Terms with one body.
pub struct Sum {
    /// The body, with one value.
    pub body: Body,
    /// The loops over the terms.
    pub nests: Vec<Nest>,
}

/// The statements of a large system, or `None` if its terms do not repeat.
///
/// # Errors
/// Recursions with too many entries, at the name of the system.
pub fn indexed(pool: &mut Pool<Symbol>, model: Model, rules: Vec<&'static NamedRule>) -> Result<Option<Indexed>> {
    let name = model.name.clone();
    let Some(found) = statements(pool, model, rules) else { return Ok(None) };
    match found.tangents() {
        Some(message) => Err(error(name.span(), &message)),
        None => Ok(Some(found)),
    }
}

fn statements(pool: &mut Pool<Symbol>, model: Model, rules: Vec<&'static NamedRule>) -> Option<Indexed> {
    if model.rule.as_ref().is_some_and(|rule| rule.named.is_none()) {
        return None;
    }
    let lets = Lets::of(pool, &model)?;
    let opened: Vec<(Role, Expr)> = model.expressions().map(|(role, expr)| (role, lets.opened(pool, expr))).collect();
    let all: Vec<Expr> = opened.iter().map(|(_, expr)| *expr).collect();
    let recursions = recursions(pool, &lets, &all)?;
    let of =
        |wanted: Role| opened.iter().filter(|(role, _)| *role == wanted).map(|(_, expr)| *expr).collect::<Vec<_>>();
    let lagrangian = sums_of(pool, &of(Role::Lagrangian))?;
    let dissipation = sums_of(pool, &of(Role::Dissipation))?;
    let scale = match of(Role::TimeScale).first() {
        Some(g) => Some(Scale::of(pool, *g)?),
        None => None,
    };
    let force = sums_of_each(pool, &of(Role::Force), false)?;
    let constraints = sums_of_each(pool, &of(Role::Constraint), true)?;
    let autonomous = is_autonomous(pool, &recursions, [&lagrangian, &force, &dissipation, &constraints]);
    let has_mass_of_position = has_mass_of_position(pool, &recursions, &lagrangian);
    let reacts = |index: usize| model.constraints.iter().any(|constraint| constraint.acts_on(pool, index));
    let reacts: Vec<bool> = (0..model.dimension()).map(reacts).collect();
    if !has_masses(reacts.clone(), &recursions, &lagrangian) {
        return None;
    }
    let of_velocities = model.constraints.iter().filter(|constraint| !constraint.is_holonomic);
    let rests: Vec<Expr> = of_velocities.map(|constraint| constraint.rest(pool)).collect();
    let driven = rests.iter().any(|rest| !pool.is_zero(*rest));
    let cyclic = cyclic(&reacts, &recursions, &lagrangian, (&force, &dissipation));
    let separable = dissipation.is_empty() && is_separable(pool, &recursions, &lagrangian, &force);
    bounded(pool).ok()?;
    Some(Indexed {
        model,
        rules,
        autonomous,
        cyclic,
        has_mass_of_position,
        separable,
        recursions,
        lagrangian,
        force,
        dissipation,
        scale,
        constraints,
        driven,
    })
}

impl Indexed {
    /// The message for recursions whose tangents are too large for the stack.
    fn tangents(&self) -> Option<Message> {
        let parts = self.recursions.iter().flat_map(|recursion| &recursion.parts);
        let arrays: BTreeSet<Read> = parts.flat_map(|part| part.of.iter().copied()).collect();
        let array = |read: &Read| match read {
            Read::Let(array) | Read::LetRate(array) => Some(&self.model.lets[*array]),
            _ => None,
        };
        let entries: usize = arrays.iter().filter_map(array).map(|array| array.definitions.len()).sum();
        let numbers = entries * self.model.dimension();
        if numbers <= TANGENTS {
            return None;
        }
        let kept: Vec<&LetArray> = arrays.iter().filter_map(array).collect();
        // Entries and coordinates grow with the rows.
        let rows = kept.iter().map(|array| array.definitions.len() / array.width).max().unwrap_or(1);
        let most = (1..=rows).take_while(|most| numbers * most * most <= TANGENTS * rows * rows).last().unwrap_or(1);
        let arrays: Vec<String> = kept.iter().map(|array| array.name.clone()).collect();
        let names: BTreeSet<String> = arrays.into_iter().collect();
        Some(Message::Tangents { arrays: names.into_iter().collect(), bytes: 8 * numbers, most })
    }

    /// The indices of the angles.
    pub(crate) fn angles(&self) -> Vec<usize> {
        (0..self.model.dimension()).filter(|index| self.model.coordinates[*index].space == Space::Circle).collect()
    }

    /// Whether steps by a rule are explicit, with a diagonal matrix.
    pub(crate) fn is_explicit(&self, rule: &NamedRule) -> bool {
        self.separable && rule.at_ends
    }

    /// Whether at least a quarter of the second derivatives are not zero. Straight lines have solvers for fewer.
    #[must_use]
    pub fn is_dense(&self) -> bool {
        let dimension = self.model.dimension();
        let mut coupled = vec![false; dimension * dimension];
        for Sum { body, nests } in &self.lagrangian {
            if body.reads_entries() {
                return true;
            }
            for [row, column] in
                body.values.iter().flat_map(|value| value.pairs.iter().map(|pair| pair.map(|at| value.states[at])))
            {
                for nest in nests {
                    nest.each(&mut |all| {
                        coupled[all[row] * dimension + all[column]] = true;
                        coupled[all[column] * dimension + all[row]] = true;
                    });
                }
            }
        }
        4 * coupled.iter().filter(|is_coupled| **is_coupled).count() >= dimension * dimension
    }

    /// Operations of second derivatives, if they were written out. A system with many of them is large.
    #[must_use]
    pub fn operations(&self) -> usize {
        let dimension = self.model.dimension();
        let of = |body: &Body| {
            let own = body.curvatures.as_ref().map_or(0, Function::operation_count);
            let of_value = |value: &Value| {
                let is_entry = |place: &usize| body.reads[value.states[*place]].is_entry();
                let entries = (0..value.states.len()).filter(is_entry).count();
                let pairs = value.pairs.iter().filter(|pair| pair.iter().any(is_entry)).count();
                2 * value.pairs.len() + 2 * dimension * (entries + pairs)
            };
            own + body.values.iter().map(of_value).sum::<usize>()
        };
        let sums = self.lagrangian.iter().chain(&self.constraints);
        let sums = sums.flat_map(|sum| sum.nests.iter().map(|nest| nest.rows() * of(&sum.body)));
        let rows = self.recursions.iter().flat_map(|Recursion { parts, nest }| {
            parts.iter().map(|part| nest.rows() * (of(&part.body) + 2 * dimension * part.of.len()))
        });
        sums.chain(rows).sum()
    }
}

/// An array of `let`s, or of their rates, in runs of rows with the same shapes.
struct Defined {
    of: Read,
    width: usize,
    /// The first row of each run, with its rows.
    runs: Vec<(usize, Vec<Vec<Instance>>)>,
}

impl Defined {
    fn of(pool: &mut Pool<Symbol>, of: Read, width: usize, definitions: &[Expr]) -> Self {
        let mut runs: Vec<(usize, Vec<Vec<Instance>>)> = Vec::new();
        for (row, definitions) in definitions.chunks(width).enumerate() {
            let instances: Vec<Instance> = definitions.iter().map(|expr| Instance::of(pool, *expr)).collect();
            let shapes = |row: &[Instance]| row.iter().map(|instance| instance.shape.clone()).collect::<Vec<_>>();
            match runs.last_mut() {
                Some((_, rows)) if shapes(&rows[0]) == shapes(&instances) => rows.push(instances),
                _ => runs.push((row, vec![instances])),
            }
        }
        Self { of, width, runs }
    }

    /// Whether both have runs of the same rows, and this one reads only earlier rows of the other.
    fn joins(&self, other: &Self) -> bool {
        let rows = |of: &Self| of.runs.iter().map(|(first, rows)| (*first, rows.len())).collect::<Vec<_>>();
        let reads_earlier = self.runs.iter().all(|(first, rows)| {
            (*first..).zip(rows).all(|(row, instances)| {
                let mut reads = instances.iter().flat_map(|of| of.shape.reads.iter().zip(&of.columns));
                reads.all(|(read, column)| *read != other.of || column / other.width < row)
            })
        });
        rows(self) == rows(other) && reads_earlier
    }
}

/// The loops that define the entries that these expressions read; `None` if their rows do not repeat.
fn recursions(pool: &mut Pool<Symbol>, lets: &Lets, exprs: &[Expr]) -> Option<Vec<Recursion>> {
    let mut groups: Vec<Vec<Defined>> = Vec::new();
    for (of, width, definitions) in lets.used(pool, exprs) {
        let defined = Defined::of(pool, of, width, &definitions);
        let states = |instance: &Instance| instance.shape.reads.iter().filter(|read| read.is_of_state()).count();
        let reads_many = |row: &Vec<Instance>| row.iter().any(|instance| states(instance) > STATES);
        if defined.runs.len() > SEQUENCES || defined.runs.iter().any(|(_, rows)| reads_many(&rows[0])) {
            return None;
        }
        match groups.last_mut() {
            Some(group) if group.iter().all(|other| defined.joins(other)) => group.push(defined),
            _ => groups.push(vec![defined]),
        }
    }
    let mut made = Vec::new();
    for group in &groups {
        for run in 0..group[0].runs.len() {
            made.push(joined(pool, group, run)?);
        }
    }
    Some(made)
}

/// An array of a group, and the number of a value in its rows.
type Member = (usize, usize);

/// One run of several arrays as one loop.
fn joined(pool: &mut Pool<Symbol>, group: &[Defined], run: usize) -> Option<Recursion> {
    let (first, rows) = &group[0].runs[run];
    // Parts of a row, with the arrays that their values read; no part reads a value of its own.
    let mut parts: Vec<(Vec<Read>, Vec<Member>)> = Vec::new();
    for (place, Defined { of, width, runs }) in group.iter().enumerate() {
        for (index, Instance { shape, columns }) in runs[run].1[0].iter().enumerate() {
            let mut own = shape.reads.iter().zip(columns);
            let is_of_row = own.any(|(read, column)| read == of && column / width == *first);
            match parts.last_mut() {
                Some((of, members)) if !is_of_row => {
                    of.push(group[place].of);
                    members.push((place, index));
                }
                _ => parts.push((vec![group[place].of], vec![(place, index)])),
            }
        }
    }
    let mut numbers = vec![Vec::new(); rows.len()];
    let mut made = Vec::new();
    let mut start = 0;
    for (of, members) in parts {
        // The numbers that several values read are one number if they agree in every row.
        let instance = |row: usize, (place, index): Member| &group[place].runs[run].1[row][index];
        let mut union: Vec<(Read, Vec<usize>)> = Vec::new();
        let mut exprs = Vec::new();
        for member in &members {
            let Instance { shape, .. } = instance(0, *member);
            let column = |place: usize| (0..rows.len()).map(|row| instance(row, *member).columns[place]).collect();
            let places: Vec<usize> = (0..shape.reads.len())
                .map(|place| {
                    let number = (shape.reads[place], column(place));
                    union.iter().position(|known| *known == number).unwrap_or_else(|| {
                        union.push(number);
                        union.len() - 1
                    })
                })
                .collect();
            exprs.push(pool.substitute(shape.value, &mut |pool, symbol| match symbol {
                Symbol::Access(place) => Some(pool.symbol(Symbol::Access(places[*place]))),
                _ => None,
            }));
        }
        for (row, numbers) in numbers.iter_mut().enumerate() {
            numbers.extend(members.iter().map(|(place, index)| (first + row) * group[*place].width + index));
            numbers.extend(union.iter().map(|(_, column)| column[row]));
        }
        let reads: Vec<Read> = union.into_iter().map(|(read, _)| read).collect();
        let width = members.len() + reads.len();
        made.push(Part { body: Body::of(pool, reads, &exprs, true)?, of, first: start });
        start += width;
    }
    Nest::single(&numbers).map(|nest| Recursion { parts: made, nest })
}

/// Terms with one shape.
struct Group {
    shape: Shape,
    /// The numbers before those that a term reads, and these; with its coefficient.
    rows: Vec<(Vec<usize>, Rational)>,
}

/// The terms of these expressions together.
fn sums_of(pool: &mut Pool<Symbol>, exprs: &[Expr]) -> Option<Vec<Sum>> {
    let terms = exprs.iter().flat_map(|expr| summands(pool, *expr)).map(|term| (Vec::new(), term)).collect();
    sums(pool, terms, true)
}

/// The terms of several sums; the first number of an instance is the place of its sum.
fn sums_of_each(pool: &mut Pool<Symbol>, exprs: &[Expr], twice: bool) -> Option<Vec<Sum>> {
    let mut terms = Vec::new();
    for (place, expr) in exprs.iter().enumerate() {
        terms.extend(summands(pool, *expr).into_iter().map(|term| (vec![place], term)));
    }
    sums(pool, terms, twice)
}

/// The terms grouped by their shapes, in the order of their first terms; each with the numbers before those that it
/// reads. `None` if they do not repeat.
fn sums(pool: &mut Pool<Symbol>, terms: Vec<(Vec<usize>, Expr)>, twice: bool) -> Option<Vec<Sum>> {
    let mut places: BTreeMap<(Shape, bool), usize> = BTreeMap::new();
    let mut groups: Vec<Group> = Vec::new();
    for (first, term) in terms {
        let multiple = match pool.node(term) {
            Node::Sum(sum) => sum.as_multiple().map(|(coefficient, term)| (coefficient.clone(), term)),
            _ => None,
        };
        let (coefficient, term) = multiple.unwrap_or((Rational::one(), term));
        let Instance { shape, columns } = Instance::of(pool, term);
        if shape.reads.iter().filter(|read| read.is_of_state()).count() > STATES {
            return None;
        }
        let place = *places.entry((shape.clone(), coefficient.is_negative())).or_insert(groups.len());
        if place == groups.len() {
            groups.push(Group { shape, rows: Vec::new() });
        }
        groups[place].rows.push((first.into_iter().chain(columns).collect(), coefficient));
        if groups.len() > BODIES {
            return None;
        }
    }
    let mut sums = Vec::new();
    for group in groups {
        let (shape, rows) = group.with_coefficients(pool)?;
        let Shape { value, reads } = shape;
        sums.push(Sum { body: Body::of(pool, reads, &[value], twice)?, nests: Nest::of(rows) });
    }
    Some(sums)
}

impl Group {
    /// The shape with the coefficient of all terms. If they differ, it is one more number that a term reads: its numerator
    /// over their common denominator. `None` if a numerator is no index.
    fn with_coefficients(self, pool: &mut Pool<Symbol>) -> Option<(Shape, Vec<Vec<usize>>)> {
        let Self { mut shape, rows } = self;
        let (_, first) = rows.first()?;
        if rows.iter().all(|(_, coefficient)| coefficient == first) {
            shape.value = pool.scale(shape.value, first);
            return Some((shape, rows.into_iter().map(|(row, _)| row).collect()));
        }
        let denominator = rows.iter().fold(One::one(), |common, (_, coefficient)| coefficient.denom().lcm(&common));
        let factor = Rational::new(if first.is_negative() { (-1).into() } else { One::one() }, denominator);
        let number = pool.symbol(Symbol::Access(shape.reads.len()));
        let value = pool.mul(number, shape.value);
        shape.value = pool.scale(value, &factor);
        shape.reads.push(Read::Number);
        let with_number = |(mut row, coefficient): (Vec<usize>, Rational)| {
            // A literal without a type has 32 bits.
            row.push((coefficient / &factor).to_usize().filter(|number| i32::try_from(*number).is_ok())?);
            Some(row)
        };
        Some((shape, rows.into_iter().map(with_number).collect::<Option<_>>()?))
    }
}

/// The terms of a sum. A product distributes over a long sum.
fn summands(pool: &mut Pool<Symbol>, expr: Expr) -> Vec<Expr> {
    let mut open = vec![expr];
    let mut terms = Vec::new();
    while let Some(expr) = open.pop() {
        match pool.node(expr).clone() {
            _ if pool.is_zero(expr) => {}
            Node::Sum(sum) if sum.as_multiple().is_none() => {
                open.push(pool.number(sum.constant));
                open.extend(sum.terms.into_iter().map(|(term, coefficient)| pool.scale(term, &coefficient)));
            }
            Node::Sum(sum) => match sum.as_multiple().and_then(|(_, term)| distributed(pool, term)) {
                Some(inner) => {
                    let coefficient = sum.terms[0].1.clone();
                    open.extend(inner.into_iter().map(|term| pool.scale(term, &coefficient)));
                }
                None => terms.push(expr),
            },
            _ => match distributed(pool, expr) {
                Some(inner) => open.extend(inner),
                None => terms.push(expr),
            },
        }
    }
    terms.reverse();
    terms
}

/// The terms of a product whose only long factor is a sum: of many terms, or of many numbers of the state.
fn distributed(pool: &mut Pool<Symbol>, expr: Expr) -> Option<Vec<Expr>> {
    let Node::Product(product) = pool.node(expr).clone() else { return None };
    let is_long = |(base, exponent): &&(Expr, Rational)| {
        let is_sum = exponent.is_one() && matches!(pool.node(*base), Node::Sum(sum) if sum.terms.len() > 1);
        let of_state = |symbol: &Symbol| Read::of(symbol).is_some_and(|(read, _)| read.is_of_state());
        is_sum && pool.symbols(*base).iter().filter(|symbol| of_state(symbol)).count() > NUMBERS
    };
    let long: Vec<Expr> = product.factors.iter().filter(is_long).map(|(base, _)| *base).collect();
    let [long] = long[..] else { return None };
    let others = product.factors.iter().filter(|(base, _)| *base != long);
    let others: Vec<Expr> = others.map(|(base, exponent)| pool.power(*base, exponent)).collect();
    let others = pool.product(&others);
    Some(summands(pool, long).into_iter().map(|term| pool.mul(others, term)).collect())
}
