//! An order of the operations that keeps few values live.
//!
//! In: a function. Out: the operations that its results need, operands before results. The order visits vectors and
//! rows of matrices in parallel, first components first: in a chain, neighbours share most operations. Operations that
//! only scalars need, such as a total energy, follow as soon as their operands exist.

use super::{Function, OperationId};
use vi_expr::Index;

impl Function {
    /// The operations that the results need, in an order that keeps few values live.
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
        // Ascending indices keep operands before results within one position.
        operations.sort_unstable();
        operations.into_iter().map(|(_, _, id)| id).collect()
    }

    /// The components of all vectors, ordered by relative position; all results if there is no vector.
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

    /// These operations and all that they need, each directly after its operands.
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
