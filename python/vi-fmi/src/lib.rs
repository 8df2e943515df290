//! A system and its run as a co-simulation unit of FMI 3.0.
//!
//! In: a system, its start values, and the description of its run, by [`unit!`]. Out: a dynamic library with the functions of
//! FMI. The Python package writes the crate that calls the macro, and the description of the unit in XML.
//!
//! | module | product |
//! |---|---|
//! | `instance` | one instance: variables by their numbers, steps, copies |
//! | `interface` | the C functions, the only file with `unsafe` |

mod instance;
pub mod interface;

pub use vi_erased;

use vi_erased::{Plan, System};

/// The content of an exported library.
pub struct Unit {
    /// The system.
    pub system: Box<dyn System>,
    /// The start values of its parameters, in the order of their declaration.
    pub parameters: &'static [f64],
    /// The method, and the start values of time, coordinates and velocities.
    pub plan: Plan,
    /// The token of the description that belongs to the library.
    pub token: &'static str,
}

/// Defines the unit of a library: `unit!(Pendulum, { gauss 4 }, [9.81, 1.0], plan, "token")`.
#[macro_export]
macro_rules! unit {
    ($system:ty, $methods:tt, $parameters:expr, $plan:expr, $token:expr) => {
        // The C functions call it by this name.
        #[unsafe(no_mangle)]
        fn variational_unit() -> $crate::Unit {
            let system = $crate::vi_erased::kind!($system, $methods);
            $crate::Unit { system, parameters: &$parameters, plan: $plan, token: $token }
        }
    };
}
