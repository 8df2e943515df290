//! The generated steppers and their rivals, each as something that can be run, compared and timed.

pub mod chain;
pub mod dense;
pub mod hand;
pub mod run;
