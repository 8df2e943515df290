//! The energy of the energy-preserving integrator.
//!
//! ```text
//! E(t̄, q̄, v) = (E0 + E1)/2         midpoint rule: E0 and E1 as carried, E by the generated energy
//! E1 = −D3 L_d − g_d⁺               any rule
//! E1 = E0                           no force, no time in L
//! ```
//!
//! Tolerance: the rounding error of E at the midpoint, after one rounding of its arguments; that of the slots at the
//! ends, as in `steps`; and the residual of the solved equations. The last line has no tolerance. The length of a step
//! has the rounding error `δh/h ≈ 4 ε (τ/h)²` (`length`). If that is too large for a run, the check tries 2 h, 4 h, …,
//! up to the system's own time scale.

use super::bounded::{Bounded, exact, once};
use super::comparison::Comparison;
use super::ladder::REACH;
use super::length;
use super::report::{CheckFailure, Report};
use super::sample::SampledMotion;
use super::steps::{SOLVED, SlotValues};
use super::subject::{EnergyChecked, Place, STEPS};
use crate::lagrangian::Lagrangian;
use crate::method::EnergyPreserving;
use crate::node::Node;
use crate::state::State;
use alloc::string::String;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Tests the carried energy of an energy-preserving run against the energy at the midpoints and the slot derivatives.
/// For the midpoint rule.
///
/// # Errors
/// The first energy that differs; a step that does not exist; [`CheckFailure::StepTooSmall`] if rounding determines the
/// step lengths; [`CheckFailure::Vacuous`] if every energy is zero or no momentum changes, so that there is nothing to
/// preserve.
pub fn energy<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let check = Comparison::new(system.name(), "energy");
    let longest = SampledMotion::from(system, place, &check)?.h;
    let (mut h, mut met) = (place.h, String::new());
    loop {
        let rounding = length::at_start(system, place, h);
        // Without any density the integrator returns the error.
        if rounding <= length::COARSE || rounding.is_infinite() {
            let may_be_rounding = rounding.is_finite() && rounding > length::FINE;
            match along_run(system, &Place { h, ..*place }) {
                Err(CheckFailure::Step { error, .. }) if may_be_rounding || h > place.h => met = format!(": {error}"),
                result => return result,
            }
        }
        if 2.0 * h > longest {
            let needed = Some(h * (rounding / length::FINE).sqrt());
            let needed = needed.filter(|needed| met.is_empty() && *needed <= REACH * longest);
            return Err(check.too_small(
                "the length of a step",
                needed,
                format!("steps up to {h:.0e} were tried{met}"),
            ));
        }
        h *= 2.0;
    }
}

fn along_run<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "energy");
    let Place { t, q, v, h } = *place;
    let bounded = system.steps::<Bounded>();
    let mut run = EnergyPreserving::from_midpoint(system, t, q, v, h).map_err(|error| check.step(error))?;
    let first = run.state();
    let mut moved = 0.0_f64;
    for _ in 0..STEPS {
        let (before, carried) = (run.state(), run.node().energy);
        run.step().map_err(|error| check.step(error))?;
        let step = run.last_step();
        let (t, q, v) = step.midpoint;
        let rounding = system.extended_rounding(&Node::new(before, 0.0), step.h, &v);
        // Allowed residual of the solved equations, and rounding error of the end, for the tolerance of the start.
        let left = SOLVED * f64::EPSILON * (rounding.energy_residual + v.abs().dot(&rounding.residual));
        let mean = Bounded { value: f64::midpoint(carried, step.energy), error: left };
        let found = bounded.energy(Bounded::nearest(t), &once(&q), &exact(&v)).of(system.energy(t, &q, &v));
        check.number("energy at the midpoint", found, mean)?;
        let slots = SlotValues::between(system, &before, &State { t: step.t, q: step.q, p: step.p });
        check.number("E1", Bounded { value: step.energy, error: left }, slots.energy_after)?;
        if system.conserves_energy() {
            check.number("E1 - E0", Bounded::exact(step.energy - carried), Bounded::exact(0.0))?;
        }
        moved = moved.max((step.p - first.p).amax());
    }
    if moved == 0.0 {
        return Err(check.vacuous("no momentum changes from this place; choose another place"));
    }
    check.finish(&["energy at the midpoint", "E1"])
}
