//! Rotations of bodies: unit quaternions R = (R[0], …, R[3]), scalar first, with their functions and torques.
//!
//! In: the clauses `rotation R;`, `torque R = T;`, `space_torque R = τ;` and calls of the functions. Out, with ∘ the
//! product of quaternions, * the conjugate and Im the last three components:
//!
//! ```text
//! constraint R     R·R − 1 = 0
//! rate(R)          2 Im(R* ∘ Ṙ)           angular velocity in the axes of the body
//! spin(R)          2 Im(Ṙ ∘ R*)           angular velocity in space
//! turn(R, r)       Im(R ∘ r ∘ R*)         a vector of the body, in space
//! forces on R      2 R ∘ T + 2 τ ∘ R
//! L                2 J (R·Ṙ)² is added    inertia along R, which no motion has: M becomes regular
//! ```
//!
//! J is the mean of the principal moments of inertia, from the trace of M at R = (1, 0, 0, 0). It changes no motion.

use super::array::part;
use super::closed::{Closed, LetArray};
use super::context::Context;
use super::force::{over, path};
use super::probe::vanish;
use super::scope::{Meaning, Scope};
use super::value::Value;
use super::{Constraint, Coordinate, Parameter, Role, Space, slope};
use crate::messages::{ArrayMistake, ConstraintMistake, Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, Expression};
use proc_macro2::Ident;
use std::collections::BTreeSet;
use syn::Result;
use vi_expr::{Expr, Pool, Rational};

/// The functions of rotations. Their names are not reserved.
pub(super) const FUNCTIONS: [&str; 3] = ["rate", "spin", "turn"];

/// The number of components of a quaternion.
pub(crate) const COMPONENTS: usize = 4;

/// A quaternion, scalar first.
type Quaternion = [Expr; COMPONENTS];

/// The product of two quaternions.
fn product(pool: &mut Pool<Symbol>, [a, b, c, d]: Quaternion, [e, f, g, h]: Quaternion) -> Quaternion {
    let mut sum = |terms: [(bool, Expr, Expr); 4]| {
        let terms = terms.map(|(is_negative, left, right)| {
            let product = pool.mul(left, right);
            if is_negative { pool.neg(product) } else { product }
        });
        pool.sum(&terms)
    };
    [
        sum([(false, a, e), (true, b, f), (true, c, g), (true, d, h)]),
        sum([(false, a, f), (false, b, e), (false, c, h), (true, d, g)]),
        sum([(false, a, g), (false, c, e), (false, d, f), (true, b, h)]),
        sum([(false, a, h), (false, d, e), (false, b, g), (true, c, f)]),
    ]
}

fn conjugate(pool: &mut Pool<Symbol>, [a, b, c, d]: Quaternion) -> Quaternion {
    [a, pool.neg(b), pool.neg(c), pool.neg(d)]
}

/// A vector as a quaternion.
fn pure(pool: &Pool<Symbol>, vector: &[Expr]) -> Option<Quaternion> {
    let [a, b, c] = *vector else { return None };
    Some([pool.zero(), a, b, c])
}

/// Twice these components.
fn doubled<const N: usize>(pool: &mut Pool<Symbol>, of: [Expr; N]) -> Vec<Expr> {
    let two = Rational::from_integer(2.into());
    of.map(|entry| pool.scale(entry, &two)).into()
}

impl Scope {
    /// A function of a rotation; `None` for other names.
    ///
    /// # Errors
    /// A wrong number of arguments, or arguments of other shapes.
    pub(super) fn of_rotation(
        &mut self,
        pool: &mut Pool<Symbol>,
        function: &Ident,
        arguments: &[Expression],
    ) -> Result<Option<Value>> {
        let Some(name) = FUNCTIONS.into_iter().find(|name| function == name) else { return Ok(None) };
        let takes = if name == "turn" { 2 } else { 1 };
        let values = self.arguments(pool, function, takes, arguments)?;
        if let Some(wrong) = values.iter().find(|value| matches!(value, Value::Wrong(_))) {
            return Ok(Some(wrong.clone()));
        }
        let given = || values.iter().map(|value| value.shape().to_vec()).collect();
        let mistake =
            || error(function.span(), &Message::Array(ArrayMistake::OfVectors { function: name, given: given() }));
        let entries = |place: usize| values.get(place).filter(|value| value.shape().len() == 1).map(Value::entries);
        let rotation = entries(0).and_then(|entries| Quaternion::try_from(entries).ok()).ok_or_else(mistake)?;
        if name == "turn" {
            let body = entries(1).and_then(|entries| pure(pool, entries)).ok_or_else(mistake)?;
            let back = conjugate(pool, rotation);
            let half = product(pool, rotation, body);
            let [_, a, b, c] = product(pool, half, back);
            let spatial = [a, b, c].map(|entry| pool.expand(entry).unwrap_or(entry));
            return Ok(Some(Value::vector_of(spatial.into())));
        }
        let moved = self.rate(pool, function.span(), arguments)?;
        let moved = Quaternion::try_from(moved.entries()).map_err(|_| mistake())?;
        let back = conjugate(pool, rotation);
        let [_, a, b, c] = if name == "rate" { product(pool, back, moved) } else { product(pool, moved, back) };
        Ok(Some(Value::vector_of(doubled(pool, [a, b, c]))))
    }
}

/// The indices of the first components of the rotations.
pub(super) fn rotations(coordinates: &[Coordinate]) -> impl Iterator<Item = (usize, &Coordinate)> {
    coordinates.iter().enumerate().filter(|(_, of)| of.component() == Some(0))
}

/// The symbols of a rotation, or of its rate of change.
fn symbols(pool: &mut Pool<Symbol>, first: usize, of: fn(usize) -> Variable) -> Quaternion {
    [0, 1, 2, 3].map(|place| pool.symbol(Symbol::Continuous(of(first + place))))
}

/// The inner product.
fn inner(pool: &mut Pool<Symbol>, left: Quaternion, right: Quaternion) -> Expr {
    let products: Vec<Expr> = left.iter().zip(right).map(|(left, right)| pool.mul(*left, right)).collect();
    pool.sum(&products)
}

/// The unit constraints of all rotations, each with the name of its rotation.
pub(super) fn constraints(pool: &mut Pool<Symbol>, coordinates: &[Coordinate]) -> Vec<Constraint> {
    let of = |(first, of): (usize, &Coordinate)| {
        let components = symbols(pool, first, Variable::Coordinate);
        let (square, one) = (inner(pool, components, components), pool.one());
        let indices = of.indices.split_last().map(|(_, array)| array).unwrap_or_default();
        let value = pool.sub(square, one);
        Constraint {
            name: of.name.clone(),
            indices: indices.iter().filter_map(|index| i64::try_from(*index).ok()).collect(),
            value,
            written: value,
            is_holonomic: true,
        }
    };
    rotations(coordinates).map(of).collect()
}

/// Adds the forces of the lines `torque R = T;`, or of `space_torque R = τ;` if `in_space`.
pub(super) fn torques(
    context: &mut Context,
    lines: &[Definition],
    in_space: bool,
    coordinates: &[Coordinate],
    forces: &mut [Expr],
) {
    let mut given = BTreeSet::new();
    for line in lines {
        let name = line.name.to_string();
        let lengths = match context.scope.meaning(&name) {
            Some(Meaning::Coordinates { first, lengths }) if coordinates[*first].space == Space::Rotation => {
                Some((*first, lengths.clone()))
            }
            Some(Meaning::Wrong) => continue,
            _ => None,
        };
        let Some((first, lengths)) = lengths else {
            // Reports errors in the value too.
            context.shaped(&line.value);
            context.errors.at(line.name.span(), &Message::Constraint(ConstraintMistake::Torque { name }));
            continue;
        };
        let made = of_line(context, line, first, &lengths, in_space);
        let made = context.report(made).unwrap_or_default();
        let exprs = made.iter().map(|(_, force)| *force).collect();
        context.defines(Role::Force, format!("the torque on `{name}`"), line.name.span(), exprs);
        for (place, force) in made {
            if !given.insert(place) {
                context.errors.at(line.name.span(), &Message::Constraint(ConstraintMistake::SecondTorque { name }));
                break;
            }
            forces[place] = context.pool.add(forces[place], force);
        }
    }
}

/// The forces of a line: pairs of a coordinate and the force on it.
fn of_line(
    context: &mut Context,
    line: &Definition,
    first: usize,
    lengths: &[usize],
    in_space: bool,
) -> Result<Vec<(usize, Expr)>> {
    let Context { scope, pool, .. } = context;
    let name = line.name.to_string();
    let mut made = Vec::new();
    over(scope, pool, &line.indices, &mut Vec::new(), &mut |scope, pool, at| {
        let value = scope.value(pool, &line.value)?;
        let path = path(scope, pool, &line.indices, at)?;
        let (range, rest) = part(&name, lengths, &path)?;
        if rest != [COMPONENTS] {
            return Err(error(
                line.name.span(),
                &Message::Constraint(ConstraintMistake::TorqueIndex { name: name.clone() }),
            ));
        }
        let values = value.fitting(pool, &[3]).map_err(|value| {
            let (needs, given) = (vec![3], value.shape().to_vec());
            error(line.value.span, &Message::Array(ArrayMistake::ShapeNeeded { needs, given, name: name.clone() }))
        })?;
        let Some(torque) = pure(pool, &values) else { return Ok(()) };
        let rotation = symbols(pool, first + range.start, Variable::Coordinate);
        let force = if in_space { product(pool, torque, rotation) } else { product(pool, rotation, torque) };
        made.extend(range.map(|place| first + place).zip(doubled(pool, force)));
        Ok(())
    })?;
    Ok(made)
}

/// L with inertia along each rotation whose M has none there. `lets` are the arrays that stay symbols in L.
pub(super) fn with_inertia(
    pool: &mut Pool<Symbol>,
    lagrangian: Expr,
    lets: &[LetArray],
    (coordinates, parameters): (&[Coordinate], &[Parameter]),
) -> Expr {
    if rotations(coordinates).next().is_none() {
        return lagrangian;
    }
    let closed = Closed::of(pool, lets).expression(pool, lagrangian);
    let mut whole = lagrangian;
    for (first, _) in rotations(coordinates) {
        let (place, moved) = (symbols(pool, first, Variable::Coordinate), symbols(pool, first, Variable::Velocity));
        let (mut along, mut trace) = (Vec::new(), Vec::new());
        for row in 0..COMPONENTS {
            let momentum = slope(pool, closed, Variable::Velocity(first + row));
            for column in 0..COMPONENTS {
                let mass = slope(pool, momentum, Variable::Velocity(first + column));
                along.push(pool.product(&[place[row], mass, place[column]]));
                trace.extend((row == column).then_some(mass));
            }
        }
        let (along, trace) = (pool.sum(&along), pool.sum(&trace));
        if !vanish(pool, &[along], parameters) {
            continue;
        }
        let at_identity = pool.substitute(trace, &mut |pool, symbol| match symbol {
            Symbol::Continuous(Variable::Coordinate(index)) if *index == first => Some(pool.one()),
            Symbol::Continuous(Variable::Coordinate(index)) if (first..first + COMPONENTS).contains(index) => {
                Some(pool.zero())
            }
            _ => None,
        });
        let depends = pool.depends_on(at_identity, &|symbol| matches!(symbol, Symbol::Continuous(_)));
        let sixth = Rational::new(1.into(), 6.into());
        let factor = if depends { pool.integer(2) } else { pool.scale(at_identity, &sixth) };
        let growth = inner(pool, place, moved);
        let inertia = pool.product(&[factor, growth, growth]);
        whole = pool.add(whole, inertia);
    }
    whole
}
