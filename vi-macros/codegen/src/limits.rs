//! Limits on the size of a system.
//!
//! In: the pool of a system, which counts its terms and the work spent on it. Out: whether both are within bounds.
//! Every stage checks this, so that a rejection comes within seconds and does not depend on the machine.

use crate::symbol::Symbol;
use vi_expr::{Pool, TooLarge};

/// Maximum number of coordinates of a system.
pub(crate) const COORDINATES: usize = 256;

/// Maximum number of entries of an array of parameters.
pub(crate) const PARAMETERS: usize = 256;

/// Maximum number of entries of a constant.
pub(crate) const ENTRIES: usize = 65_536;

/// Maximum number of distinct terms in the expressions of all stages of a system.
const TERMS: usize = 85_000;

/// Maximum work in all stages of a system: half a second, or 3 to 8 s in an unoptimized build.
pub(crate) const WORK: usize = 56_000_000;

/// Operations of second derivatives above which a dense system is large: its derivatives are written as loops. There fixed
/// steps take a tenth longer in loops, and lines build four times as long: 12 links 6.8 s instead of 1.5 s. Below it loops
/// lose more: with 2499 operations, the outer solar system takes 1.5 times as long in fixed steps, 1.7 to 1.9 in `Gauss::<8>`.
pub(crate) const LARGE: usize = 3_000;

/// Fewest coordinates of a large system.
pub(crate) const LARGE_COORDINATES: usize = 12;

/// Whether a system is within its limits.
pub(crate) fn bounded(pool: &Pool<Symbol>) -> Result<(), TooLarge> {
    pool.within_work()?;
    if pool.len() > TERMS { Err(TooLarge::Terms { limit: TERMS }) } else { Ok(()) }
}
