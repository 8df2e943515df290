//! Solvers of the momentum equation `−D2 L_d − f_d⁻ = p0` for a given step h.
//!
//! In: a node, h, and the velocities of the last steps. Out: the velocity v that solves the equation to rounding.
//!
//! | file | contents |
//! |---|---|
//! | `steps` | steps of one length: extrapolated, corrected, checked |
//! | `closed_form` | a linear step as one matrix product |
//! | `newton` | the equation for Newton iteration |
//! | `continuation` | continuation of the root from h = 0 |

pub(crate) mod closed_form;
pub(crate) mod continuation;
pub(crate) mod newton;
pub(crate) mod steps;
