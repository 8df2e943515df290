//! Repeated formulas, shifted along the coordinates: in a chain, every spring has the same force.
//!
//! In: a function. Out: families of its operations,
//!
//! ```text
//! member k:  op(a_(k + i), b_(k + j), c)      k = 0 … length − 1
//! ```
//!
//! with the same operation and the same i, j for all k. a and b are components of input vectors or families; c depends
//! on neither. A loop computes a family. The operands of members are members of families, inputs, or the same for all
//! members.

use super::{Function, Operation, OperationId};
use crate::symbol::Symbol;
use std::collections::BTreeMap;
use vi_expr::{Distinct, Table};

/// Minimum number of members in a loop.
const LEAST: usize = 8;

/// The common part of the members of a family.
#[derive(PartialEq, Eq, Hash)]
enum Shape {
    /// The component of a vector.
    Input(Symbol),
    /// An operation and its operands.
    Operation(Operation, Vec<Relative>),
}

/// An operand relative to the position of its operation.
#[derive(PartialEq, Eq, Hash)]
enum Relative {
    /// The same operation for all members.
    Fixed(OperationId),
    /// The operation of this shape that is `on` places later, or `back` places earlier.
    Shifted { shape: usize, on: usize, back: usize },
}

/// The family of a member and its position there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Membership {
    /// Index into the families.
    pub family: usize,
    /// Position in the family, from 0.
    pub place: usize,
}

/// The families of a function.
pub struct Families {
    /// The members of each family in order; a family comes after the families of its operands.
    pub members: Vec<Vec<OperationId>>,
    of: Table<OperationId, Membership>,
}

impl Families {
    /// The membership of an operation, if it has one.
    #[must_use]
    pub fn of(&self, id: OperationId) -> Option<Membership> {
        self.of.get(id).copied()
    }
}

impl Function {
    /// The families among its operations.
    #[must_use]
    pub fn families(&self) -> Families {
        let (mut shapes, mut placed) = (Distinct::<Shape>::default(), Table::default());
        let mut rows: Vec<BTreeMap<usize, OperationId>> = Vec::new();
        for id in self.needed() {
            let Some((shape, place)) = shape(self.operations.get(id), &placed) else { continue };
            let number = shapes.insert_full(shape).0;
            placed.insert(id, (number, place));
            rows.resize_with(shapes.len(), BTreeMap::new);
            rows[number].insert(place, id);
        }
        // Shapes are numbered after the shapes of their operands.
        let is_work = |run: &Vec<OperationId>| self.operations.get(run[0]).is_work();
        let members: Vec<_> = rows.iter().flat_map(runs).filter(is_work).collect();
        let of = members
            .iter()
            .zip(0..)
            .flat_map(|(run, family)| run.iter().zip(0..).map(move |(id, place)| (*id, Membership { family, place })));
        Families { of: of.collect(), members }
    }
}

/// The shape of an operation and the position of its first placed operand; `None` if no operand is placed.
fn shape(operation: &Operation, placed: &Table<OperationId, (usize, usize)>) -> Option<(Shape, usize)> {
    if let Operation::Input(symbol) = operation {
        return symbol.component().map(|(vector, place)| (Shape::Input(vector), place));
    }
    let start = operation.operands().find_map(|operand| placed.get(operand).map(|(_, place)| *place))?;
    let relative = operation.operands().map(|operand| match placed.get(operand) {
        Some(&(shape, place)) => {
            Relative::Shifted { shape, on: place.saturating_sub(start), back: start.saturating_sub(place) }
        }
        None => Relative::Fixed(operand),
    });
    Some((Shape::Operation(operation.form(), relative.collect()), start))
}

/// Runs of adjacent members of sufficient length. Their operands have the same neighbours.
fn runs(row: &BTreeMap<usize, OperationId>) -> Vec<Vec<OperationId>> {
    let entries: Vec<(&usize, &OperationId)> = row.iter().collect();
    let runs = entries.chunk_by(|(left, _), (right, _)| **left + 1 == **right);
    runs.filter(|run| run.len() >= LEAST).map(|run| run.iter().map(|(_, id)| **id).collect()).collect()
}
