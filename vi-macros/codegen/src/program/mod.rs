//! The functions of a system as straight-line code.
//!
//! In: a [`Model`](crate::model::Model) and its [`DiscreteSystem`](crate::discrete::DiscreteSystem). Out: a
//! [`Program`]: per emitted function its inputs, the operations with everything shared once, and its results.
//! AFTER THIS no field, no power and no sum is left: only operations of two operands, calls, inputs and constants.

mod angles;
mod assemble;
mod families;
mod lower;
mod magnitude;
mod operations;
mod order;
mod powers;
mod sums;
mod verify;

pub use assemble::program;
pub use families::{Families, Membership};
pub use operations::{Operation, OperationId, Operations};

use vi_expr::Table;

/// What one function computes.
pub struct Function {
    /// Its name in the emitted code.
    pub name: &'static str,
    /// The operations, operands before results.
    pub operations: Operations,
    /// The results, in groups: a number is a group of one, a vector one of N, a matrix N groups (its rows).
    pub results: Vec<Vec<OperationId>>,
}

impl Function {
    /// How often each operation that the results need is read: by others, and as a result.
    pub(crate) fn uses(&self) -> Table<OperationId, usize> {
        let mut uses = Table::default();
        let needed = self.operations.needed(&self.results);
        let operands = needed.into_iter().flat_map(|id| self.operations.get(id).operands());
        for id in operands.chain(self.results.iter().flatten().copied()) {
            *uses.entry(id) += 1;
        }
        uses
    }
}

/// All functions of a system.
pub struct Program {
    /// Functions of `(t, q, v)`.
    pub continuous: Vec<Function>,
    /// Functions of an interval.
    pub slots: Vec<Function>,
    /// Functions of a node and the unknowns `(v, h)`.
    pub step: Vec<Function>,
}

impl Program {
    /// The function of this name.
    #[must_use]
    pub fn function(&self, name: &str) -> Option<&Function> {
        self.functions().find(|function| function.name == name)
    }

    /// All functions, in the order in which they are emitted.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        self.continuous.iter().chain(&self.slots).chain(&self.step)
    }
}
