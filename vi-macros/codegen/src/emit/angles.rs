//! Groups of angles whose sines and cosines are computed together.
//!
//! In: the operations of a function. Out: groups of angles that do not depend on each other's sines, and an order of
//! the operations that computes these angles before the first sine is needed. LLVM vectorizes a group: two angles take
//! as long as one.

use crate::program::{Function, Operation, OperationId};
use std::collections::{BTreeMap, BTreeSet};
use vi_expr::Function as Elementary;

/// Maximum number of angles in a group: the `f64` lanes of a 256-bit register, the widest of common processors.
const GROUP: usize = 4;

/// The groups of angles of a function.
#[derive(Default)]
pub(super) struct Angles {
    groups: Vec<Vec<OperationId>>,
    /// The group of each grouped angle.
    of: BTreeMap<OperationId, usize>,
}

impl Angles {
    /// The groups of a function that needs these operations, operands before results.
    pub(super) fn of(function: &Function, needed: &[OperationId]) -> Self {
        let (mut late, mut known, mut angles) = (BTreeSet::new(), BTreeSet::new(), Vec::new());
        for id in needed {
            let operation = function.operations.get(*id);
            let waits = operation.operands().any(|operand| late.contains(&operand));
            let angle = match operation {
                Operation::Call(Elementary::Sin | Elementary::Cos, angle) => Some(*angle),
                _ => None,
            };
            angles.extend(angle.filter(|angle| !waits && known.insert(*angle)));
            if waits || angle.is_some() {
                late.insert(*id);
            }
        }
        let groups: Vec<Vec<OperationId>> =
            angles.chunks(GROUP).filter(|group| group.len() > 1).map(<[OperationId]>::to_vec).collect();
        let of = groups.iter().zip(0..).flat_map(|(group, number)| group.iter().map(move |angle| (*angle, number)));
        Self { of: of.collect(), groups }
    }

    /// The group of an angle, or the angle alone.
    pub(super) fn with(&self, angle: OperationId) -> Vec<OperationId> {
        self.of.get(&angle).map_or_else(|| vec![angle], |group| self.groups[*group].clone())
    }

    /// Reorders the operations so that all inputs of a group come before it.
    pub(super) fn first(&self, function: &Function, needed: Vec<OperationId>) -> Vec<OperationId> {
        let mut open: Vec<OperationId> = self.groups.iter().flatten().copied().collect();
        let mut early = BTreeSet::new();
        while let Some(id) = open.pop() {
            if early.insert(id) {
                open.extend(function.operations.get(id).operands());
            }
        }
        let (mut order, late): (Vec<_>, Vec<_>) = needed.into_iter().partition(|id| early.contains(id));
        order.extend(late);
        order
    }
}
