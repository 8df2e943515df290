//! Work, counted.
//!
//! In: what a pool does, in operands: each one that a pass looks at, that an expression is made of, or that is kept. Out: whether it
//! may do more. No clock is asked, so that the same input always ends in the same way. One unit takes about 20 ns, and 140 ns in a
//! build without optimisation; an operand that is kept takes about 100 bytes.
//! AFTER THIS a pool that has done its work makes nothing but the undefined expression, and its passes see nothing: what it says
//! then means nothing, and whoever uses it asks [`Pool::is_exhausted`] before.

use std::fmt;
use std::hash::Hash;

use crate::{Pool, Rational, number};

/// Of an operand that is evaluated.
pub(crate) const EVALUATED: usize = 3;
/// Of an operand that an expression is made of: it is copied, sorted and hashed.
pub(crate) const MADE: usize = 4;
/// Of an operand of an expression that is new.
pub(crate) const KEPT: usize = 12;

/// Of an operand of ball arithmetic, beside what its bits take.
const PRECISE: usize = 100;
/// Of a function in ball arithmetic, beside what its bits take.
const FUNCTION: usize = 1000;

/// More than an expression, or a pool, may take.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum TooLarge {
    /// Terms: those that one call of [`Pool::expand`] writes, intermediate ones included; long coefficients count as several.
    Terms {
        /// So many are allowed.
        limit: usize,
    },
    /// Work of a pool, in operands.
    Work {
        /// So much is allowed.
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
    /// Pool that does so much work, and no more.
    #[must_use]
    pub fn bounded(limit: usize) -> Self {
        let mut pool = Self::new();
        pool.limit = limit;
        pool.left.set(limit);
        pool
    }

    /// Counts work that is done elsewhere on this pool's expressions.
    pub fn spend(&self, work: usize) {
        self.left.set(self.left.get().saturating_sub(work));
    }

    /// The work done so far.
    #[must_use]
    pub fn work(&self) -> usize {
        self.limit - self.left.get()
    }

    /// What is found out about this pool's expressions without counting work, as a check of what was made may be.
    pub fn uncounted<R>(&self, find: impl FnOnce(&Self) -> R) -> R {
        let left = self.left.replace(usize::MAX);
        let balls = self.balls.borrow().clone();
        let found = find(self);
        self.left.set(left);
        self.balls.replace(balls);
        found
    }

    /// Whether the pool has done all the work that it may do.
    #[must_use]
    pub fn is_exhausted(&self) -> bool {
        self.left.get() == 0
    }

    /// Nothing, or that the pool is exhausted.
    ///
    /// # Errors
    /// [`TooLarge::Work`].
    pub fn within_work(&self) -> Result<(), TooLarge> {
        if self.is_exhausted() { Err(TooLarge::Work { limit: self.limit }) } else { Ok(()) }
    }

    /// Counts sums and products of so many balls.
    pub(crate) fn spend_on_balls(&self, bits: u64, operands: usize) {
        let words = usize::try_from(bits / 64).unwrap_or(usize::MAX);
        self.spend(operands.saturating_mul(PRECISE + words.saturating_mul(words)));
    }

    /// Counts elementary functions of balls: as many terms as the bits say, each of which takes a time of their square.
    pub(crate) fn spend_on_functions(&self, bits: u64, functions: usize) {
        let words = usize::try_from(bits / 64).unwrap_or(usize::MAX);
        self.spend(functions * (FUNCTION + 2 * words.saturating_pow(3)));
    }

    /// Counts an operation whose result is this number: common divisors take a time of the square of its bits.
    pub(crate) fn spend_on(&self, number: &Rational) {
        let bits = number::bits(number);
        if bits > 64 {
            self.spend(usize::try_from(bits.saturating_mul(bits) / 256).unwrap_or(usize::MAX));
        }
    }
}
