//! Angles whose sines and cosines are computed at once.
//!
//! In: the operations of a function. Out: groups of its angles that no sine or cosine has to wait for, and an order of the
//! operations in which these angles are there before the first of them is needed. What is computed at once becomes vector
//! instructions: two angles take as long as one.

use crate::program::{Function, Operation, OperationId};
use std::collections::{BTreeMap, BTreeSet};
use vi_expr::Function as Elementary;

/// Angles of one group: as many as the widest registers of a common processor hold, and no more in one place.
const TOGETHER: usize = 4;

/// The groups of a function.
#[derive(Default)]
pub(super) struct Angles {
    groups: Vec<Vec<OperationId>>,
    /// The group of each angle that is in one.
    of: BTreeMap<OperationId, usize>,
}

impl Angles {
    /// Of a function that needs these operations, operands before results.
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
            angles.chunks(TOGETHER).filter(|group| group.len() > 1).map(<[OperationId]>::to_vec).collect();
        let of = groups.iter().zip(0..).flat_map(|(group, number)| group.iter().map(move |angle| (*angle, number)));
        Self { of: of.collect(), groups }
    }

    /// The group of an angle; the angle alone where it is in none.
    pub(super) fn with(&self, angle: OperationId) -> Vec<OperationId> {
        self.of.get(&angle).map_or_else(|| vec![angle], |group| self.groups[*group].clone())
    }

    /// The operations in an order in which all that a group is computed from comes before it.
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
