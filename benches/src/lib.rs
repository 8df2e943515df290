//! The generated steppers and their rivals, each as something that can be run, compared and timed.

pub mod chain;
pub mod contest;
pub mod contests;
pub mod count;
pub mod dense;
pub mod document;
pub mod hand;
pub mod newton;
pub mod pendulum;
pub mod problem;
pub mod rods;
pub mod run;
pub mod time;
