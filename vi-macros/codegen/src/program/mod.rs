//! The functions of a system as straight-line code.
//!
//! In: a [`Model`](crate::model::Model) and its [`DiscreteSystem`](crate::discrete::DiscreteSystem). Out: a
//! [`Program`]: per emitted function its inputs, its operations, each shared term once, and its results. It contains
//! binary operations, calls, inputs and constants, and no field, power or sum.

mod angles;
mod assemble;
mod families;
mod lower;
mod lowering;
mod operations;
mod order;
mod powers;
mod results;
mod rounding_scale;
mod sums;
mod vanishing;
mod verify;

pub(crate) use assemble::alone;
pub use assemble::program;
pub use families::{Families, Membership};
pub use operations::{Operation, OperationId, Operations};
pub(crate) use results::Methods;
pub use results::{FunctionId, Output, Results};

use vi_expr::Table;

/// Maximum number of operations of a function that counts as short.
const SHORT: usize = 250;

/// A function of the emitted code.
pub struct Function {
    /// The identity of the function.
    pub id: FunctionId,
    /// The operations, operands before results.
    pub operations: Operations,
    /// The results, each an operation.
    pub results: Results<OperationId>,
}

impl Function {
    /// The operations that the results need, operands before results.
    #[must_use]
    pub fn needed(&self) -> Vec<OperationId> {
        self.operations.needed(self.results.entries())
    }

    /// The number of operations and results that read each needed operation.
    pub(crate) fn uses(&self) -> Table<OperationId, usize> {
        let mut uses = Table::default();
        let operands = self.needed().into_iter().flat_map(|id| self.operations.get(id).operands());
        for id in operands.chain(self.results.entries().copied()) {
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
    /// The function with this identity.
    #[must_use]
    pub fn function(&self, id: FunctionId) -> Option<&Function> {
        self.functions().find(|function| function.id == id)
    }

    /// Whether the functions of a momentum step are short: `FixedStepping::INLINED`.
    #[must_use]
    pub fn has_short_steps(&self) -> bool {
        let is_short = |id| self.function(id).is_none_or(|function| function.operation_count() <= SHORT);
        is_short(FunctionId::MomentumEquation) && is_short(FunctionId::MomentumResidual)
    }

    /// All functions in the order of emission.
    pub fn functions(&self) -> impl Iterator<Item = &Function> + Clone {
        self.continuous.iter().chain(self.by_rule())
    }

    /// The functions that depend on the rule, in the same order.
    pub fn by_rule(&self) -> impl Iterator<Item = &Function> + Clone {
        self.slots.iter().chain(&self.step)
    }
}
