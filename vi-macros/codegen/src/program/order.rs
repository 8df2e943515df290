//! An order of the operations in which few values are held at a time.
//!
//! In: a function. Out: the operations that its results need, operands before results. Vectors and the rows of matrices
//! go side by side, their first components before the second ones: in a chain neighbours share most of their operations.
//! What is left is needed by single numbers only, as the sum of all energies is; each part of it comes as soon as its
//! operands are there.

use super::{Function, OperationId};
use vi_expr::Index;

impl Function {
    /// The operations that the results need, in an order in which few values are held at a time.
    #[must_use]
    pub fn local_order(&self) -> Vec<OperationId> {
        let (mut place, mut operations) = (vec![None; self.operations.len()], Vec::new());
        for id in self.depth_first(&self.side_by_side()) {
            place[id.index()] = Some(operations.len());
            operations.push((operations.len(), false, id));
        }
        for id in self.needed() {
            if place[id.index()].is_none() {
                let operands = self.operations.get(id).operands();
                let last = operands.filter_map(|operand| place[operand.index()]).max().unwrap_or(0);
                place[id.index()] = Some(last);
                operations.push((last, true, id));
            }
        }
        // Ascending indices keep operands before results among those of one place.
        operations.sort_unstable();
        operations.into_iter().map(|(_, _, id)| id).collect()
    }

    /// The components of all vectors, ordered by how far along their vector they are; all results where there is none.
    fn side_by_side(&self) -> Vec<OperationId> {
        let vectors = || self.results.rows().filter(|row| row.len() > 1);
        let longest = vectors().map(<[OperationId]>::len).max().unwrap_or(0);
        let mut placed: Vec<(usize, OperationId)> = vectors()
            .flat_map(|row| row.iter().zip(1..).map(|(id, place)| (place * longest / row.len(), *id)))
            .collect();
        if placed.is_empty() {
            return self.results.entries().copied().collect();
        }
        placed.sort_by_key(|(place, _)| *place);
        placed.into_iter().map(|(_, id)| id).collect()
    }

    /// These operations and all that they need, each right after its operands.
    fn depth_first(&self, roots: &[OperationId]) -> Vec<OperationId> {
        let (mut seen, mut order) = (vec![false; self.operations.len()], Vec::new());
        let mut open: Vec<(OperationId, bool)> = roots.iter().rev().map(|root| (*root, false)).collect();
        while let Some((id, operands_done)) = open.pop() {
            if operands_done {
                order.push(id);
            } else if !core::mem::replace(&mut seen[id.index()], true) {
                open.push((id, true));
                let first = open.len();
                open.extend(self.operations.get(id).operands().map(|operand| (operand, false)));
                open[first..].reverse();
            }
        }
        order
    }
}
