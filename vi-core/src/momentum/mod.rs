//! The momentum equation `−D2 L_d − f_d⁻ = p0`, the step h given.
//!
//! In: a node, h, and the velocities of the steps before. Out: the velocity v that solves it, every residual measured.
//!
//! | file | what it does |
//! |---|---|
//! | `steps` | steps of one length: predicted, corrected, measured |
//! | `closed_form` | a linear step as one matrix |
//! | `newton` | the equation for Newton's iteration |
//! | `continuation` | the root followed from h = 0 |

pub(crate) mod closed_form;
pub(crate) mod continuation;
pub(crate) mod newton;
pub(crate) mod steps;
