//! Mechanical systems and their runs, type-erased.
//!
//! In: a system that `lagrangian!` declares, and a list of integrators for it ([`kind!`]). Out: a
//! [`System`], and for a [`Plan`] a [`Simulation`]. Both are `Send`, and know neither the type of the system nor its
//! number of coordinates. The compiler instantiates everything generic once per system and integrator, where a program
//! calls [`kind!`]; loops over steps are inside, without virtual calls.
//!
//! | module | product |
//! |---|---|
//! | [`plan`] | the description of a run |
//! | [`start`] | an accurate second node |
//! | [`section`] | events of a run, type-erased |
//! | `control` | mass matrix, linearizations and equilibria, for controllers; feature `derivatives` |
//! | [`simulation`] | a started run: its rows and its queries |
//! | [`erasable`] | requirements on systems and methods |
//! | [`method`] | a method behind a pointer: runs are compiled once for each system |
//! | `run` | a run of such a method |
//! | `derivatives` | tangent vectors, gradients and Lyapunov exponents of runs; feature `derivatives` |
//! | `session` | a run in the hands of a program; feature `sessions` |
//! | [`integrator`] | an integrator that is built for a system |
//! | [`studies`] | exponents, accurate motions, DOP853; feature `studies` |
//! | [`system`] | a system with its parameters |
//! | `shooting` | steps from many nodes with their Jacobians and second derivatives, for optimal control; feature `derivatives` |
//! | [`function`] | smooth functions along a motion |
//! | `transcription` | optimal control as a nonlinear program; feature `derivatives` |
//! | `forward` | functions of wrappers that call the inner system or run |
//! | [`at_rest`] | a system without its coordinates at rest |
//! | [`check`] | whether the options of a plan go together, in words |
//!
//! No module imports one below it in this table.

pub mod at_rest;
pub mod check;
#[cfg(feature = "derivatives")]
pub mod control;
#[cfg(feature = "derivatives")]
mod derivatives;
pub mod erasable;
mod forward;
pub mod function;
pub mod integrator;
pub mod method;
pub mod plan;
mod run;
pub mod section;
#[cfg(feature = "sessions")]
mod session;
#[cfg(feature = "derivatives")]
pub mod shooting;
pub mod simulation;
pub mod start;
#[cfg(feature = "studies")]
pub mod studies;
pub mod system;
#[cfg(feature = "derivatives")]
pub mod transcription;

pub use integrator::Integrator;
pub use plan::{Built, Method, PhasePoint, Plan};
pub use simulation::{Row, Simulation, Steps};
#[cfg(feature = "sessions")]
pub use simulation::{Rows, Session};
pub use system::{System, Typed};

/// A system with its default parameters, and the integrators that are built for it:
/// `kind!(Pendulum, { fixed; gauss 4, 8; energy })`.
///
/// | word | integrator |
/// |---|---|
/// | `fixed` | fixed steps of order 2, and their compositions of order 4, 6, 8 |
/// | `fixed_2` | fixed steps of order 2 only, in half the compile time |
/// | `gauss 4, 8` | Gauss steps of 4 and of 8 stages, which keep constraints |
/// | `adaptive 4, 8` | the same with lengths that follow the motion |
/// | `transformed 4, 8` | Gauss steps in transformed time, for a system with a `time_scale` |
/// | `splitting` | kicks and drifts of order 4 and 6, for a system whose motion splits |
/// | `energy` | energy-preserving steps of order 2 |
/// | `energy 2, 3` | energy-preserving Gauss steps of 2 and of 3 stages, which keep constraints |
///
/// `fixed` and `fixed_2` need a rule, as by the clause `discretize trapezoidal;`, and `energy` without stages one with a
/// step density, as `discretize midpoint;`. A system with constraints has only `gauss`, `adaptive`, and `energy` with
/// stages.
#[macro_export]
macro_rules! kind {
    ($system:ty, { $($method:ident $($stages:literal),*);* $(;)? }) => {
        $crate::system::erased::<$system, _>($crate::integrator::all([
            $($crate::integrators!($method $($stages),*)),*
        ]))
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! integrators {
    (fixed) => {
        $crate::integrator::by_rule()
    };
    (fixed_2) => {
        vec![$crate::integrator::fixed()]
    };
    (splitting) => {
        $crate::integrator::splitting()
    };
    (energy) => {
        vec![$crate::integrator::energy()]
    };
    (gauss $($stages:literal),+) => {
        vec![$($crate::integrator::gauss::<_, _, $stages>()),+]
    };
    (adaptive $($stages:literal),+) => {
        vec![$($crate::integrator::adaptive::<_, _, $stages>()),+]
    };
    (transformed $($stages:literal),+) => {
        vec![$($crate::integrator::transformed::<_, _, $stages>()),+]
    };
    (energy $($stages:literal),+) => {
        vec![$($crate::integrator::energy_gauss::<_, _, $stages>()),+]
    };
}
