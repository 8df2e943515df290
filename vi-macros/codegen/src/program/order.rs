//! An order of the operations in which few values are held at a time.
//!
//! In: a function. Out: the operations that its results need, operands before results. Vectors and the rows of matrices
//! go side by side, their first components before the second ones: in a chain neighbours share most of their operations.
//! What is left is needed by single numbers only, as the sum of all energies is; each part of it comes as soon as its
//! operands are there.

use super::{Function, OperationId};
use std::collections::{BTreeMap, BTreeSet};

impl Function {
    /// The operations that the results need, in an order in which few values are held at a time.
    #[must_use]
    pub fn local_order(&self) -> Vec<OperationId> {
        let vectors = self.depth_first(&self.side_by_side());
        let mut rank: BTreeMap<OperationId, (usize, bool)> = BTreeMap::new();
        rank.extend(vectors.into_iter().zip(0..).map(|(id, place)| (id, (place, false))));
        let mut order = self.operations.needed(&self.results);
        for id in &order {
            if !rank.contains_key(id) {
                let operands = self.operations.get(*id).operands();
                let last = operands.filter_map(|operand| rank.get(&operand)).map(|(place, _)| *place).max();
                rank.insert(*id, (last.unwrap_or(0), true));
            }
        }
        // Ascending indices keep operands before results among those of one place.
        order.sort_by_key(|id| (rank.get(id).copied(), *id));
        order
    }

    /// The components of all vectors, ordered by how far along their vector they are; all results where there is none.
    fn side_by_side(&self) -> Vec<OperationId> {
        let vectors = || self.results.iter().filter(|group| group.len() > 1);
        let longest = vectors().map(Vec::len).max().unwrap_or(0);
        let mut placed: Vec<(usize, OperationId)> = vectors()
            .flat_map(|group| group.iter().zip(1..).map(|(id, place)| (place * longest / group.len(), *id)))
            .collect();
        if placed.is_empty() {
            return self.results.iter().flatten().copied().collect();
        }
        placed.sort_by_key(|(place, _)| *place);
        placed.into_iter().map(|(_, id)| id).collect()
    }

    /// These operations and all that they need, each right after its operands.
    fn depth_first(&self, roots: &[OperationId]) -> Vec<OperationId> {
        let (mut seen, mut order) = (BTreeSet::new(), Vec::new());
        let mut open: Vec<(OperationId, bool)> = roots.iter().rev().map(|root| (*root, false)).collect();
        while let Some((id, operands_done)) = open.pop() {
            if operands_done {
                order.push(id);
            } else if seen.insert(id) {
                open.push((id, true));
                let operands: Vec<OperationId> = self.operations.get(id).operands().collect();
                open.extend(operands.into_iter().rev().map(|operand| (operand, false)));
            }
        }
        order
    }
}
