//! Dependence of a large system on time, coordinates and velocities.
//!
//! In: its recursions and sums. Out: the recursions on which sums depend, and the properties of L and f that follow from
//! the numbers that these read.

use super::{Body, Nest, Part, Read, Recursion, Sum, Value};
use crate::symbol::{Symbol, Variable};
use std::collections::BTreeSet;
use vi_expr::Pool;

/// The arrays of entries, and of rates, on which sums depend.
pub(crate) fn needed(recursions: &[Recursion], sums: &[&[Sum]]) -> BTreeSet<Read> {
    let entries = |body: &Body, value: &Value| {
        let reads = value.states.iter().map(|place| body.reads[*place]);
        reads.filter(Read::is_entry).collect::<Vec<_>>()
    };
    let bodies = sums.iter().flat_map(|sums| sums.iter().map(|sum| &sum.body));
    let mut found: BTreeSet<Read> =
        bodies.flat_map(|body| body.values.iter().flat_map(|value| entries(body, value))).collect();
    loop {
        let values = definitions(recursions, &found);
        let read: Vec<Read> = values.flat_map(|(_, part, value)| entries(&part.body, value)).collect();
        let before = found.len();
        found.extend(read);
        if found.len() == before {
            return found;
        }
    }
}

/// The definitions of the entries of these arrays, with their loops.
fn definitions<'a>(
    recursions: &'a [Recursion],
    arrays: &'a BTreeSet<Read>,
) -> impl Iterator<Item = (&'a Nest, &'a Part, &'a Value)> {
    recursions.iter().flat_map(move |Recursion { parts, nest }| {
        parts.iter().flat_map(move |part| {
            let values = part.body.values.iter().zip(&part.of).filter(|(_, array)| arrays.contains(array));
            values.map(move |(value, _)| (nest, part, value))
        })
    })
}

/// Calls `see` with each row that defines an entry on which sums depend, and the columns that its body reads.
fn each_row(recursions: &[Recursion], sums: &[Sum], see: &mut dyn FnMut(&Body, &Value, &[usize])) {
    for (nest, part, value) in definitions(recursions, &needed(recursions, &[sums])) {
        nest.each(&mut |all| see(&part.body, value, &all[part.first + part.of.len()..]));
    }
}

/// Whether L, f and the constraints are independent of time. Terms of R without a velocity are no part of f.
pub(super) fn is_autonomous(
    pool: &Pool<Symbol>,
    recursions: &[Recursion],
    [lagrangian, force, dissipation, constraints]: [&[Sum]; 4],
) -> bool {
    let time = |symbol: &Symbol| *symbol == Symbol::Continuous(Variable::Time);
    let arrays = needed(recursions, &[lagrangian, force, dissipation, constraints]);
    let lost = dissipation.iter().filter(|sum| sum.body.moves());
    let sums = lagrangian.iter().chain(force).chain(constraints).chain(lost);
    let entries = definitions(recursions, &arrays).map(|(_, _, value)| value);
    let mut values = sums.flat_map(|sum| &sum.body.values).chain(entries);
    values.all(|value| !pool.depends_on(value.expr, &time))
}

/// Whether L is quadratic in the velocities: each term is quadratic, and rates are linear in the velocities.
pub(super) fn has_mass_of_position(pool: &mut Pool<Symbol>, recursions: &[Recursion], lagrangian: &[Sum]) -> bool {
    let of_lagrangian = needed(recursions, &[lagrangian]);
    let mut parts = recursions.iter().flat_map(|recursion| &recursion.parts);
    let degree = |of: &Read| of_lagrangian.contains(of).then(|| usize::from(of.is_rate()));
    parts.all(|part| part.body.is_at_most(pool, &Read::is_rate, &|value| degree(&part.of[value])))
        && lagrangian.iter().all(|sum| sum.body.is_at_most(pool, &Read::is_rate, &|_| Some(2)))
}

/// Whether velocities appear in terms `m v²` of L only, with constant m.
pub(super) fn is_separable(
    pool: &mut Pool<Symbol>,
    recursions: &[Recursion],
    lagrangian: &[Sum],
    force: &[Sum],
) -> bool {
    let acting = needed(recursions, &[lagrangian, force]);
    let rates = definitions(recursions, &acting).any(|(_, part, _)| part.body.moves());
    if rates || force.iter().any(|sum| sum.body.moves()) {
        return false;
    }
    lagrangian.iter().filter(|sum| sum.body.moves()).all(|Sum { body, .. }| {
        let of_velocity = body.reads.iter().filter(|read| read.is_of_state()).all(|read| *read == Read::Velocity);
        of_velocity && body.is_square(pool)
    })
}

/// Whether the velocity of each coordinate is in `known` or has a second derivative of L, itself or through a rate.
/// Straight lines report coordinates without one.
pub(super) fn has_masses(known: Vec<bool>, recursions: &[Recursion], lagrangian: &[Sum]) -> bool {
    let mut has_mass = known;
    let mut see = |body: &Body, place: usize, columns: &[usize]| {
        if body.reads[place] == Read::Velocity {
            has_mass[columns[place]] = true;
        }
    };
    each_row(recursions, lagrangian, &mut |body, value, columns| {
        value.states.iter().for_each(|place| see(body, *place, columns));
    });
    for Sum { body, nests } in lagrangian {
        for value in &body.values {
            for place in value.pairs.iter().flatten() {
                for nest in nests {
                    nest.each(&mut |all| see(body, value.states[*place], all));
                }
            }
        }
    }
    has_mass.into_iter().all(|has_mass| has_mass)
}

/// For each coordinate, whether L does not read it, and no force and no reaction acts on it.
pub(super) fn cyclic(
    reacts: &[bool],
    recursions: &[Recursion],
    lagrangian: &[Sum],
    (force, dissipation): (&[Sum], &[Sum]),
) -> Vec<bool> {
    let mut cyclic: Vec<bool> = reacts.iter().map(|reacts| !reacts).collect();
    let mut see = |wanted: Read, body: &Body, value: &Value, columns: &[usize]| {
        let read = value.states.iter().filter(|place| body.reads[**place] == wanted);
        read.for_each(|place| cyclic[columns[*place]] = false);
    };
    for (wanted, sums) in [(Read::Coordinate, lagrangian), (Read::Velocity, dissipation)] {
        each_row(recursions, sums, &mut |body, value, columns| see(wanted, body, value, columns));
        for Sum { body, nests } in sums {
            for nest in nests {
                nest.each(&mut |all| see(wanted, body, &body.values[0], all));
            }
        }
    }
    for nest in force.iter().flat_map(|sum| &sum.nests) {
        nest.each(&mut |all| cyclic[all[0]] = false);
    }
    cyclic
}
