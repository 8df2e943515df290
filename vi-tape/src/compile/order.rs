//! The order of instructions: equal kinds together.

use super::instructions::Instruction;
use crate::lines::Kind;
use std::collections::{BTreeMap, HashMap, HashSet};
use vi_codegen::program::OperationId;

/// An order in which operands come first and instructions of one kind follow one another: again and again the kind of
/// which most are ready.
pub(super) fn in_runs(all: &[Instruction], inputs: &[OperationId]) -> Vec<usize> {
    let known: HashSet<OperationId> = inputs.iter().copied().collect();
    let mut readers: HashMap<OperationId, Vec<usize>> = HashMap::new();
    let mut waits = vec![0; all.len()];
    let mut ready: BTreeMap<Kind, Vec<usize>> = BTreeMap::new();
    for (at, instruction) in all.iter().enumerate() {
        for id in instruction.operands.iter().filter(|id| !known.contains(id)) {
            readers.entry(*id).or_default().push(at);
            waits[at] += 1;
        }
        if waits[at] == 0 {
            ready.entry(instruction.kind).or_default().push(at);
        }
    }
    let mut order = Vec::with_capacity(all.len());
    while let Some(kind) = ready.iter().max_by_key(|(_, list)| list.len()).map(|(kind, _)| *kind) {
        let mut list = ready.remove(&kind).unwrap_or_default();
        list.sort_unstable();
        for reader in list.iter().flat_map(|at| &all[*at].results).filter_map(|id| readers.get(id)).flatten() {
            waits[*reader] -= 1;
            if waits[*reader] == 0 {
                ready.entry(all[*reader].kind).or_default().push(*reader);
            }
        }
        order.append(&mut list);
    }
    order
}
