//! The bodies of a large system with the names of their functions, and their rows in the user's names.

use super::{Body, Indexed, Nest, Part, Read, Recursion, Scale, Sum, Value};
use crate::model::Model;
use crate::program::Function;
use crate::symbol::{LetEntry, Symbol, Variable};
use vi_expr::Pool;

/// Characters of the expression of a loop that are shown.
const CHARACTERS: usize = 160;

/// Functions of the parts of the time scale, and of the whole one.
pub(crate) const PART: &str = "time_scale_part";
pub(crate) const SCALE: &str = "time_scale";

/// The quantity that a body computes.
#[derive(Clone, Copy)]
pub(crate) enum Quantity<'a> {
    /// Entries of these arrays of `let`s, or their rates.
    Entries(&'a [Read]),
    /// Terms of L.
    Lagrangian,
    /// Terms of components of f.
    Force,
    /// Terms of Rayleigh's function.
    Dissipation,
    /// Terms of constraints.
    Constraint,
    /// Terms of the parts of the time scale.
    Part,
    /// The time scale.
    Scale,
}

/// A body with the name of its function and its loops.
pub(crate) struct NamedBody<'a> {
    /// The name of the emitted function.
    pub(crate) name: String,
    pub(crate) quantity: Quantity<'a>,
    pub(crate) body: &'a Body,
    pub(crate) nests: &'a [Nest],
    /// The first of its columns: the entries, the component or the constraint that a row computes, then the numbers
    /// that it reads.
    pub(crate) first: usize,
}

/// All bodies of a large system, in the order of emission.
pub(crate) fn named(of: &Indexed) -> Vec<NamedBody<'_>> {
    let mut named = Vec::new();
    for (place, Recursion { parts, nest }) in of.recursions.iter().enumerate() {
        named.extend(parts.iter().enumerate().map(|(index, Part { body, of, first })| NamedBody {
            name: part_name(parts, place, index),
            quantity: Quantity::Entries(of),
            body,
            nests: core::slice::from_ref(nest),
            first: *first,
        }));
    }
    let [parts, whole]: [&[Sum]; 2] = match &of.scale {
        Some(Scale { parts, whole, .. }) => [parts, core::slice::from_ref(whole)],
        None => [&[], &[]],
    };
    let sums = [
        ("lagrangian", Quantity::Lagrangian, &of.lagrangian[..]),
        ("force", Quantity::Force, &of.force[..]),
        ("dissipation", Quantity::Dissipation, &of.dissipation[..]),
        ("constraint", Quantity::Constraint, &of.constraints[..]),
        (PART, Quantity::Part, parts),
        (SCALE, Quantity::Scale, whole),
    ];
    for (name, quantity, sums) in sums {
        named.extend(sums.iter().enumerate().map(|(index, Sum { body, nests })| NamedBody {
            name: sum_name(name, index),
            quantity,
            body,
            nests,
            first: 0,
        }));
    }
    named
}

/// The name of the function of a body of a recursion.
pub(crate) fn part_name(parts: &[Part], recursion: usize, part: usize) -> String {
    let name = format!("row_{}", recursion + 1);
    if parts.len() == 1 { name } else { format!("{name}_{}", part + 1) }
}

/// The name of the function of a sum of L, f or the constraints.
pub(crate) fn sum_name(of: &str, sum: usize) -> String {
    format!("{of}_{}", sum + 1)
}

impl NamedBody<'_> {
    /// What its loops run over; `None` for entries, whose bodies may share a loop, and for a single row.
    pub(super) fn terms(&self) -> Option<&'static str> {
        match self.quantity {
            Quantity::Lagrangian => Some("terms of `L`"),
            Quantity::Force => Some("terms of `f`"),
            Quantity::Dissipation => Some("terms of the dissipation"),
            Quantity::Constraint => Some("terms of constraints"),
            Quantity::Part => Some("terms of the time scale"),
            Quantity::Entries(_) | Quantity::Scale => None,
        }
    }

    /// Number of rows in all loops.
    pub(crate) fn rows(&self) -> usize {
        self.nests.iter().map(Nest::rows).sum()
    }

    /// The arrays of the numbers that a row computes, by column: entries, the component of a force, or a constraint.
    pub(crate) fn computed(&self) -> &[Read] {
        match self.quantity {
            Quantity::Entries(of) => of,
            Quantity::Lagrangian | Quantity::Dissipation | Quantity::Scale => &[],
            Quantity::Force => &[Read::Coordinate],
            Quantity::Constraint => &[Read::Constraint],
            Quantity::Part => &[Read::Part],
        }
    }

    /// The arrays of the columns of a row, from the first one on.
    pub(crate) fn columns(&self) -> impl Iterator<Item = (usize, Read)> {
        (self.first..).zip(self.computed().iter().chain(&self.body.reads).copied())
    }

    /// Operations of a row for its values and first derivatives.
    pub(crate) fn first_operations(&self) -> usize {
        self.body.slopes.operation_count()
    }

    /// Operations of a row for first and second derivatives; `-` for a force, which needs no second ones.
    pub(crate) fn second_operations(&self) -> String {
        let count = self.body.curvatures.as_ref().map(Function::operation_count);
        count.map_or_else(|| "-".to_owned(), |count| count.to_string())
    }

    /// The first row in the user's names: `x[1] = x[0] + l*cos(q[1])`.
    pub(crate) fn first_row(&self, pool: &Pool<Symbol>, model: &Model) -> String {
        let mut row: Option<Vec<usize>> = None;
        if let Some(nest) = self.nests.first() {
            nest.each(&mut |columns| {
                row.get_or_insert_with(|| columns.to_vec());
            });
        }
        let row = row.unwrap_or_default();
        let names: Vec<String> = self.columns().map(|(column, read)| spell(model, read, row[column])).collect();
        let (computed, reads) = names.split_at(self.computed().len());
        let value = |value: &Value| {
            pool.render_within(CHARACTERS, value.expr, &|symbol| match symbol {
                Symbol::Access(place) => reads[*place].clone(),
                _ => model.spell(symbol),
            })
        };
        let values = self.body.values.iter().map(value);
        match self.quantity {
            Quantity::Lagrangian => format!("term of L: {}", values.collect::<String>()),
            Quantity::Dissipation => format!("term of the dissipation R: {}", values.collect::<String>()),
            Quantity::Force => format!("term of f_{}: {}", computed.concat(), values.collect::<String>()),
            Quantity::Constraint => {
                format!("term of the constraint {}: {}", computed.concat(), values.collect::<String>())
            }
            Quantity::Part => format!("term of {}: {}", computed.concat(), values.collect::<String>()),
            Quantity::Scale => format!("g = {}", values.collect::<String>()),
            Quantity::Entries(_) => {
                let entries = computed.iter().zip(values).map(|(entry, value)| format!("{entry} = {value}"));
                entries.collect::<Vec<_>>().join("; ")
            }
        }
    }
}

/// A number that a row reads, in the user's names.
fn spell(model: &Model, read: Read, column: usize) -> String {
    match read {
        Read::Coordinate => model.spell(&Symbol::Continuous(Variable::Coordinate(column))),
        Read::Velocity => model.spell(&Symbol::Continuous(Variable::Velocity(column))),
        Read::Let(array) => model.spell(&Symbol::Let(LetEntry { array, entry: column })),
        Read::LetRate(array) => model.spell(&Symbol::LetRate(LetEntry { array, entry: column })),
        Read::Parameter(first) => model.spell(&Symbol::Parameter { index: first + column, array: Some(first) }),
        Read::Number => column.to_string(),
        Read::Constraint => model.constraints[column].text(),
        Read::Part => format!("g_{}", column + 1),
    }
}
