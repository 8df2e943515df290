//! The mistakes of a text.

use core::fmt;

/// The mistakes of a text, each with its place and its correction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistakes(pub(crate) String);

impl fmt::Display for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.trim_end())
    }
}

impl core::error::Error for Mistakes {}
