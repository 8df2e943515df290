//! The energy of the energy-preserving integrator.
//!
//! ```text
//! E(t̄, q̄, v) = (E0 + E1)/2         midpoint rule: E0 and E1 as they are carried, E by the generated energy
//! E1 = −D3 L_d − g_d⁺               any rule
//! E1 = E0                           no force, no time in L
//! ```

use super::comparison::{Comparison, ROUNDING};
use super::report::{CheckFailure, Report};
use super::steps::Between;
use super::{Checked, Place, STEPS};
use crate::{EnergyPreserving, State};

/// The energy carried over a run of the energy-preserving integrator, against the energy at the midpoints and the slot
/// derivatives. For the midpoint rule.
///
/// # Errors
/// The first energy that differs; a step that does not exist; [`CheckFailure::Vacuous`] where every energy is zero or no
/// momentum changes, so that there is nothing to preserve.
pub fn energy<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "energy", ROUNDING);
    let Place { t, q, v, h } = *place;
    let mut run = EnergyPreserving::from_midpoint(system, t, q, v, h).map_err(|error| check.step(error))?;
    let first = run.state();
    let mut moved = 0.0_f64;
    for _ in 0..STEPS {
        let (before, carried) = (run.state(), run.energy());
        let step = run.step().map_err(|error| check.step(error))?;
        let (t, q, v) = step.midpoint;
        let scale = step.p.abs().dot(&v.abs()) + system.lagrangian(t, &q, &v).abs();
        check.number("energy at the midpoint", system.energy(t, &q, &v), f64::midpoint(carried, step.energy), scale)?;
        let between = Between::new(system, &before, &State { t: step.t, q: step.q, p: step.p });
        check.number("E1", step.energy, between.energy_after, between.energy_scale)?;
        if S::AUTONOMOUS && !S::FORCED {
            check.number("E1 - E0", step.energy - carried, 0.0, f64::MIN_POSITIVE)?;
        }
        moved = moved.max((step.p - first.p).amax());
    }
    if moved == 0.0 {
        return Err(check.vacuous("no momentum changes from this place; choose another"));
    }
    check.finish(&["energy at the midpoint", "E1"])
}
