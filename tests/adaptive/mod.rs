//! Gauss steps whose length follows the motion.

mod irreversible;
mod reversible;
