//! The Hamiltonian: an input in place of L.
//!
//! In: the lines `momentum p of q;` and `H = …;`. Out: L, by the Legendre transformation; each momentum becomes a name for
//! L_v in every other expression. An H that has no L in closed form gives `L = p·q' − H`, linear in the velocities, and its
//! momenta are further coordinates.

use super::closed::Closed;
use super::context::Context;
use super::legendre::transform;
use super::lets;
use super::scope::Meaning;
use super::value::Value;
use super::{Coordinate, Parameter, Space, slope};
use crate::limits::bounded;
use crate::messages::{HamiltonianMistake, Message};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Defining, Momentum, System};
use proc_macro2::Span;
use vi_expr::Expr;

/// Declares the momenta, whose values are symbols until [`lagrangian`].
pub(super) fn momenta(context: &mut Context, system: &System, coordinates: &[Coordinate]) {
    let mut of_coordinate: Vec<Option<&Momentum>> = vec![None; coordinates.len()];
    for momentum in &system.momenta {
        let of = momentum.of.to_string();
        let places: Vec<usize> = (0..coordinates.len()).filter(|place| coordinates[*place].name == of).collect();
        let lengths = match context.scope.meaning(&of) {
            Some(Meaning::Coordinate(_)) => Some(Vec::new()),
            Some(Meaning::Coordinates { lengths, .. }) => Some(lengths.clone()),
            Some(Meaning::Wrong) => None,
            _ => {
                let near = context.scope.near_of(context.pool, &of, |known| context.scope.is_coordinate(known));
                report(context, momentum.of.span(), HamiltonianMistake::OfOther { name: of.clone(), near });
                None
            }
        };
        let Some(lengths) = lengths else {
            context.declare(&momentum.name, Meaning::Wrong);
            continue;
        };
        let is_second = places.iter().any(|place| of_coordinate[*place].replace(momentum).is_some());
        if is_second {
            report(context, momentum.of.span(), HamiltonianMistake::Second { name: of.clone() });
        }
        if places.iter().any(|place| coordinates[*place].space == Space::Rotation) {
            report(context, momentum.of.span(), HamiltonianMistake::OfRotation { name: of });
        }
        let symbols = places.into_iter().map(|place| context.pool.symbol(Symbol::Momentum(place))).collect();
        let meaning = lets::meaning(&Value::of_shape(&lengths, symbols));
        context.declare(&momentum.name, meaning);
    }
    check_clauses(context, system, coordinates, &of_coordinate);
}

/// Reports momenta without H, H with L, and H without a momentum of each coordinate.
fn check_clauses(context: &mut Context, system: &System, coordinates: &[Coordinate], given: &[Option<&Momentum>]) {
    let [first, others @ ..] = system.all(Defining::Hamiltonian) else {
        if let Some(momentum) = system.momenta.first() {
            let (name, of) = (momentum.name.to_string(), momentum.of.to_string());
            report(context, momentum.name.span(), HamiltonianMistake::Missing { name, of });
        }
        return;
    };
    for other in others {
        report(context, other.name.span(), HamiltonianMistake::SecondHamiltonian);
    }
    if !system.all(Defining::Lagrangian).is_empty() {
        report(context, first.name.span(), HamiltonianMistake::Both);
    }
    let is_known = system.momenta.iter().all(|momentum| context.scope.is_coordinate(&momentum.of.to_string()));
    let missing = coordinates.iter().zip(given).find(|(_, momentum)| momentum.is_none());
    if let Some((coordinate, _)) = missing.filter(|_| is_known) {
        let name = coordinate.name.to_string();
        let mistake = if coordinate.space == Space::Rotation {
            HamiltonianMistake::OfRotation { name }
        } else {
            HamiltonianMistake::MissingMomentum { name }
        };
        report(context, coordinate.name.span(), mistake);
    }
}

fn report(context: &mut Context, span: Span, mistake: HamiltonianMistake) {
    context.errors.at(span, &Message::Hamiltonian(mistake));
}

/// L of a Hamiltonian, and its momenta that are coordinates, after those of the system.
pub(super) struct Transformed {
    pub(super) lagrangian: Expr,
    pub(super) momenta: Vec<Coordinate>,
}

/// L of the system's H, and the values of the momenta: L_v, or coordinates. `None` without H or after a report.
pub(super) fn lagrangian(
    context: &mut Context,
    system: &System,
    (coordinates, parameters): (&[Coordinate], &[Parameter]),
) -> Option<Transformed> {
    let written = system.all(Defining::Hamiltonian).first()?;
    let mut scope = context.scope.without_velocities(context.pool, "H");
    let value = scope.expression(context.pool, &written.value);
    let value = context.report(value)?;
    let hamiltonian = with_momenta(context, value);
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)) | Symbol::LetRate(_));
    if context.pool.depends_on(hamiltonian, &moves) {
        let name = context.scope.array_in(context.pool, value).unwrap_or_default();
        context.errors.at(written.value.span, &Message::VelocityIn { name, clause: "H" });
    }
    if !context.errors.is_empty() {
        return None;
    }
    let variables: [fn(usize) -> Symbol; 2] = [Symbol::Momentum, |index| Symbol::Continuous(Variable::Velocity(index))];
    let made = transform(context.pool, hamiltonian, variables, parameters, coordinates.len());
    if let Err(size) = bounded(context.pool) {
        context.errors.at(written.name.span(), &Message::TooLarge { size });
        return None;
    }
    match made {
        Some(lagrangian) => {
            let momenta: Vec<Expr> = (0..coordinates.len())
                .map(|index| {
                    let momentum = slope(context.pool, lagrangian, Variable::Velocity(index));
                    context.closed(momentum)
                })
                .collect();
            context.scope.substitute_momenta(context.pool, &momenta);
            Some(Transformed { lagrangian, momenta: Vec::new() })
        }
        None if system.is_constrained => {
            report(context, written.name.span(), HamiltonianMistake::NoLagrangian);
            None
        }
        None => Some(canonical(context, system, coordinates, hamiltonian)),
    }
}

/// `L = p·q' − H`, with momenta that are coordinates.
fn canonical(context: &mut Context, system: &System, coordinates: &[Coordinate], hamiltonian: Expr) -> Transformed {
    let dimension = coordinates.len();
    let momentum = |(Coordinate { name, indices, .. }, place): (&Coordinate, usize)| {
        let of = system.momenta.iter().find(|momentum| momentum.of == *name);
        let name = of.map_or(name, |momentum| &momentum.name).clone();
        (Coordinate { name, indices: indices.clone(), space: Space::Line }, dimension + place)
    };
    let (momenta, places): (Vec<Coordinate>, Vec<usize>) = coordinates.iter().zip(0..).map(momentum).unzip();
    let values: Vec<Expr> =
        places.iter().map(|place| context.pool.symbol(Symbol::Continuous(Variable::Coordinate(*place)))).collect();
    context.scope.substitute_momenta(context.pool, &values);
    let pool = &mut *context.pool;
    let hamiltonian = pool.substitute(hamiltonian, &mut |_, symbol| match symbol {
        Symbol::Momentum(index) => values.get(*index).copied(),
        _ => None,
    });
    let mut terms = vec![pool.neg(hamiltonian)];
    for (index, momentum) in values.iter().enumerate() {
        let velocity = pool.symbol(Symbol::Continuous(Variable::Velocity(index)));
        terms.push(pool.mul(*momentum, velocity));
    }
    Transformed { lagrangian: pool.sum(&terms), momenta }
}

/// H with the entries of arrays of `let`s that contain momenta replaced: the others stay symbols, so that loops over them do.
fn with_momenta(context: &mut Context, value: Expr) -> Expr {
    let Context { pool, scope, .. } = context;
    let arrays = scope.kept.as_deref().unwrap_or_default();
    let closed = Closed::of(pool, arrays);
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Momentum(_));
    pool.substitute(value, &mut |pool, symbol| {
        let entry = pool.symbol(symbol.clone());
        let by_coordinates = closed.expression(pool, entry);
        pool.depends_on(by_coordinates, &moves).then_some(by_coordinates)
    })
}
