//! Work limits.
//!
//! In: the operations of a pool, in operands that a pass visits, an expression uses, or the pool stores. Out: whether
//! more work is allowed. No clock is involved, so that equal input gives equal results. One unit takes about 20 ns, or
//! 140 ns in an unoptimized build. A stored operand takes about 100 bytes.
//!
//! Beyond the limit a pool creates only the undefined expression, and its passes visit no expression. Its results are
//! meaningless; callers check [`Pool::is_exhausted`] first.

use std::fmt;
use std::hash::Hash;

use crate::{Pool, Rational, number};

/// Cost of evaluating an operand.
pub(crate) const EVALUATED: usize = 3;
/// Cost of an operand of an expression: it is copied, sorted and hashed.
pub(crate) const MADE: usize = 4;
/// Cost of an operand of a new expression.
pub(crate) const KEPT: usize = 12;

/// Cost of an operand in ball arithmetic, besides its bits.
const PRECISE: usize = 100;
/// Cost of a function in ball arithmetic, besides its bits.
const FUNCTION: usize = 1000;

/// A limit that an expression or a pool exceeds.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum TooLarge {
    /// Terms written by one call of [`Pool::expand`], including intermediate ones; a long coefficient counts as
    /// several.
    Terms {
        /// The limit.
        limit: usize,
    },
    /// Work of a pool, in operands.
    Work {
        /// The limit.
        limit: usize,
    },
}

impl fmt::Display for TooLarge {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Terms { limit } => write!(formatter, "multiplying the expression out takes more than {limit} terms"),
            Self::Work { limit } => write!(formatter, "the expressions take more than {limit} steps of algebra"),
        }
    }
}

impl std::error::Error for TooLarge {}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// A pool with a work limit.
    #[must_use]
    pub fn bounded(limit: usize) -> Self {
        let mut pool = Self::new();
        pool.limit = limit;
        pool.left.set(limit);
        pool
    }

    /// Counts work done elsewhere on expressions of this pool.
    pub fn spend(&self, work: usize) {
        self.left.set(self.left.get().saturating_sub(work));
    }

    /// The work so far.
    #[must_use]
    pub fn work(&self) -> usize {
        self.limit - self.left.get()
    }

    /// Runs a computation on this pool without counting its work, such as a check of a result.
    pub fn uncounted<R>(&self, find: impl FnOnce(&Self) -> R) -> R {
        let left = self.left.replace(usize::MAX);
        let balls = self.balls.borrow().clone();
        let found = find(self);
        self.left.set(left);
        self.balls.replace(balls);
        found
    }

    /// Whether the pool has reached its limit.
    #[must_use]
    pub fn is_exhausted(&self) -> bool {
        self.left.get() == 0
    }

    /// Reports an exhausted pool.
    ///
    /// # Errors
    /// [`TooLarge::Work`].
    pub fn within_work(&self) -> Result<(), TooLarge> {
        if self.is_exhausted() { Err(TooLarge::Work { limit: self.limit }) } else { Ok(()) }
    }

    /// Counts sums and products of balls.
    pub(crate) fn spend_on_balls(&self, bits: u64, operands: usize) {
        let words = usize::try_from(bits / 64).unwrap_or(usize::MAX);
        self.spend(operands.saturating_mul(PRECISE + words.saturating_mul(words)));
    }

    /// Counts elementary functions of balls: a series has as many terms as bits, each with quadratic cost.
    pub(crate) fn spend_on_functions(&self, bits: u64, functions: usize) {
        let words = usize::try_from(bits / 64).unwrap_or(usize::MAX);
        self.spend(functions * (FUNCTION + 2 * words.saturating_pow(3)));
    }

    /// Counts an operation with this result: a common divisor has a cost quadratic in the bits.
    pub(crate) fn spend_on(&self, number: &Rational) {
        let bits = number::bits(number);
        if bits > 64 {
            self.spend(usize::try_from(bits.saturating_mul(bits) / 256).unwrap_or(usize::MAX));
        }
    }
}
