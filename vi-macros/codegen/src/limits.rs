//! How large a system may become.
//!
//! In: the pool of a system, which counts its terms and the work that was done on it. Out: whether both are within bounds, asked by
//! every stage, so that a refusal comes within seconds and is the same everywhere.

use crate::symbol::Symbol;
use vi_expr::{Pool, TooLarge};

/// Coordinates that a system may have.
pub(crate) const COORDINATES: usize = 256;

/// Entries that an array of parameters may have.
pub(crate) const PARAMETERS: usize = 256;

/// Distinct terms that the expressions of one system may have together, those of all stages.
const TERMS: usize = 85_000;

/// Steps of algebra that one system may take, those of all stages: half a second, and 3 to 8 s in a build without optimisation.
pub(crate) const WORK: usize = 56_000_000;

/// Whether a system is still within its size.
pub(crate) fn bounded(pool: &Pool<Symbol>) -> Result<(), TooLarge> {
    pool.within_work()?;
    if pool.len() > TERMS { Err(TooLarge::Terms { limit: TERMS }) } else { Ok(()) }
}
