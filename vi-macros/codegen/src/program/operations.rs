//! Operations: scalar instructions, each computed once.
//!
//! In: requests for operations. Out: a list in which equal operations share one entry and operands come first.

use crate::symbol::Symbol;
use vi_expr::{Distinct, Function, Index, Opaque, Table};

/// The index of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OperationId(u32);

impl OperationId {
    /// The limit on nodes of the pool keeps the number of operations below 2^32.
    fn at(place: usize) -> Self {
        Self(u32::try_from(place).unwrap_or(u32::MAX))
    }
}

impl Index for OperationId {
    fn index(self) -> usize {
        self.0 as usize
    }
}

/// An operation, its operands by index.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operation {
    /// A number, as bits.
    Constant(u64),
    /// A parameter, an argument of the function, or a part of one.
    Input(Symbol),
    /// −a
    Negate(OperationId),
    /// a + b
    Add(OperationId, OperationId),
    /// a − b
    Subtract(OperationId, OperationId),
    /// a·b
    Multiply(OperationId, OperationId),
    /// a/b
    Divide(OperationId, OperationId),
    /// √a
    SquareRoot(OperationId),
    /// 1/a
    Reciprocal(OperationId),
    /// A function of one operand.
    Call(Function, OperationId),
    /// A function of two operands.
    Call2(Function, OperationId, OperationId),
    /// A partial derivative of a function that is known by name.
    Opaque(Opaque, Vec<OperationId>),
    /// b if a is positive, else c; NaN if a is NaN
    Select(OperationId, OperationId, OperationId),
    /// a, or 0 if b is 0; then this number of its derivatives is 0 too
    ZeroWhere(OperationId, OperationId, u8),
}

/// Operations, operands before results.
#[derive(Clone, Default)]
pub struct Operations {
    list: Distinct<Operation>,
    names: Table<OperationId, Symbol>,
}

impl Operations {
    /// Lists the operation once. Folds constants, and removes 0 and 1 if the result is exact.
    pub fn add(&mut self, operation: Operation) -> OperationId {
        if let Some(simple) = self.simplified(&operation) {
            return simple;
        }
        OperationId::at(self.list.insert_full(operation).0)
    }

    /// A number.
    pub fn constant(&mut self, value: f64) -> OperationId {
        self.add(Operation::Constant(value.to_bits()))
    }

    /// The value of an operation that is a number.
    #[must_use]
    pub fn as_constant(&self, id: OperationId) -> Option<f64> {
        match self.get(id) {
            Operation::Constant(bits) => Some(f64::from_bits(*bits)),
            _ => None,
        }
    }

    /// The operation with this index.
    #[must_use]
    pub fn get(&self, id: OperationId) -> &Operation {
        &self.list[id.index()]
    }

    /// The index of a listed operation.
    #[must_use]
    pub fn find(&self, operation: &Operation) -> Option<OperationId> {
        self.list.get_index_of(operation).map(OperationId::at)
    }

    /// Records that the operation is the argument of the rule with this symbol.
    pub fn set_name(&mut self, id: OperationId, name: Symbol) {
        if self.get(id).is_work() && !self.names.contains(id) {
            self.names.insert(id, name);
        }
    }

    /// The symbol recorded for an operation.
    #[must_use]
    pub fn name(&self, id: OperationId) -> Option<&Symbol> {
        self.names.get(id)
    }

    /// The number of listed operations.
    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// All operations with their indices, operands before results.
    pub fn iter(&self) -> impl Iterator<Item = (OperationId, &Operation)> {
        (0..).map(OperationId).zip(&self.list)
    }

    /// The operations that the results need, operands before results.
    #[must_use]
    pub fn needed<'a>(&self, results: impl IntoIterator<Item = &'a OperationId>) -> Vec<OperationId> {
        let mut needed = vec![false; self.list.len()];
        results.into_iter().for_each(|id| needed[id.index()] = true);
        for index in (0..self.list.len()).rev() {
            if needed[index] {
                self.list[index].operands().for_each(|id| needed[id.index()] = true);
            }
        }
        self.iter().map(|(id, _)| id).filter(|id| needed[id.index()]).collect()
    }

    fn negative_product(&mut self, a: OperationId, b: OperationId) -> OperationId {
        let product = self.add(Operation::Multiply(a, b));
        self.add(Operation::Negate(product))
    }

    fn simplified(&mut self, operation: &Operation) -> Option<OperationId> {
        use Operation::{Add, Divide, Multiply, Negate, Subtract};
        let value = |id: &OperationId| self.as_constant(*id);
        match operation {
            Negate(a) => match (value(a), self.get(*a)) {
                (Some(a), _) => Some(self.constant(-a)),
                (_, Negate(inner)) => Some(*inner),
                _ => None,
            },
            Multiply(a, b) => match (value(a), value(b)) {
                (Some(a), Some(b)) => Some(self.constant(a * b)),
                (Some(1.0), _) => Some(*b),
                (_, Some(1.0)) => Some(*a),
                (Some(-1.0), _) => Some(self.add(Negate(*b))),
                (_, Some(-1.0)) => Some(self.add(Negate(*a))),
                // Moves a constant behind: `x * real(0.5)`.
                (Some(_), None) => Some(self.add(Multiply(*b, *a))),
                // Moves the sign outward until a sum absorbs it.
                _ => match (self.get(*a).clone(), self.get(*b).clone()) {
                    (Negate(a), _) => Some(self.negative_product(a, *b)),
                    (_, Negate(b)) => Some(self.negative_product(*a, b)),
                    _ => None,
                },
            },
            Add(a, b) => match (value(a), value(b)) {
                (Some(a), Some(b)) => Some(self.constant(a + b)),
                (Some(0.0), _) => Some(*b),
                (_, Some(0.0)) => Some(*a),
                (Some(_), None) => Some(self.add(Add(*b, *a))),
                (_, Some(b)) if b < 0.0 => {
                    let b = self.constant(-b);
                    Some(self.add(Subtract(*a, b)))
                }
                _ => match (self.get(*a).clone(), self.get(*b).clone()) {
                    (_, Negate(b)) => Some(self.add(Subtract(*a, b))),
                    (Negate(a), _) => Some(self.add(Subtract(*b, a))),
                    _ => None,
                },
            },
            Subtract(a, b) => match (value(a), value(b)) {
                (Some(a), Some(b)) => Some(self.constant(a - b)),
                (_, Some(0.0)) => Some(*a),
                (Some(0.0), _) => Some(self.add(Negate(*b))),
                _ => match self.get(*b).clone() {
                    Negate(b) => Some(self.add(Add(*a, b))),
                    _ => None,
                },
            },
            Divide(a, b) => match (value(a), value(b)) {
                (Some(a), Some(b)) => Some(self.constant(a / b)),
                (Some(1.0), _) => Some(self.add(Operation::Reciprocal(*b))),
                (_, Some(1.0)) => Some(*a),
                _ => None,
            },
            Operation::ZeroWhere(a, b, derivatives) => match self.get(*b) {
                Negate(b) => Some(self.add(Operation::ZeroWhere(*a, *b, *derivatives))),
                _ => None,
            },
            _ => None,
        }
    }
}

impl Operation {
    /// The operands, from left to right.
    pub fn operands(&self) -> impl Iterator<Item = OperationId> + '_ {
        let (first, second) = match self {
            Self::Constant(_) | Self::Input(_) | Self::Opaque(..) => (None, None),
            Self::Negate(a) | Self::SquareRoot(a) | Self::Reciprocal(a) | Self::Call(_, a) => (Some(*a), None),
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Call2(_, a, b)
            | Self::ZeroWhere(a, b, _)
            | Self::Select(a, b, _) => (Some(*a), Some(*b)),
        };
        let others: &[OperationId] = match self {
            Self::Select(_, _, c) => core::slice::from_ref(c),
            Self::Opaque(_, arguments) => arguments,
            _ => &[],
        };
        first.into_iter().chain(second).chain(others.iter().copied())
    }

    /// The operation without its operands.
    pub(super) fn form(&self) -> Self {
        let none = OperationId(0);
        match self {
            Self::Constant(_) | Self::Input(_) => self.clone(),
            Self::Negate(_) => Self::Negate(none),
            Self::Add(..) => Self::Add(none, none),
            Self::Subtract(..) => Self::Subtract(none, none),
            Self::Multiply(..) => Self::Multiply(none, none),
            Self::Divide(..) => Self::Divide(none, none),
            Self::SquareRoot(_) => Self::SquareRoot(none),
            Self::Reciprocal(_) => Self::Reciprocal(none),
            Self::Call(function, _) => Self::Call(*function, none),
            Self::Call2(function, ..) => Self::Call2(*function, none, none),
            Self::ZeroWhere(_, _, derivatives) => Self::ZeroWhere(none, none, *derivatives),
            Self::Opaque(function, _) => Self::Opaque(function.clone(), Vec::new()),
            Self::Select(..) => Self::Select(none, none, none),
        }
    }

    /// Whether the operation takes time: it is no constant and no input.
    #[must_use]
    pub fn is_work(&self) -> bool {
        !matches!(self, Self::Constant(_) | Self::Input(_))
    }

    /// Its cost in additions. A division has four times the latency; a sine is a polynomial.
    #[must_use]
    pub fn cost(&self) -> usize {
        match self {
            Self::Constant(_) | Self::Input(_) => 0,
            Self::Negate(_)
            | Self::Add(..)
            | Self::Subtract(..)
            | Self::Multiply(..)
            | Self::ZeroWhere(..)
            | Self::Select(..) => 1,
            Self::Divide(..) | Self::SquareRoot(_) | Self::Reciprocal(_) => 4,
            Self::Call(..) | Self::Call2(..) | Self::Opaque(..) => 12,
        }
    }
}
