//! The numbers of coordinates that are built.
//!
//! In: a code. Out: its system with every method, type-erased. The compiler instantiates all that is generic over the
//! number of coordinates and the kind here.

use crate::code::Code;
use crate::kinds::Interpreted;
use crate::mistakes::Mistakes;
use crate::tape::Tape;
#[cfg(feature = "complete")]
use vi_core::constrained::Independent;
use vi_core::kind::{Bound, Counted, Free};
use vi_erased::at_rest::without_rest;
use vi_erased::plan::{Built, Method};
use vi_erased::{System, Typed, integrator, integrators};

macro_rules! sizes {
    ($($size:literal),*) => {
        /// The numbers of coordinates that are built, in ascending order. Further coordinates are at rest.
        const SIZES: &[usize] = &[$($size),*];

        /// The system of a code, which has a number of coordinates that is built.
        fn built(code: &'static Code) -> Option<Box<dyn System>> {
            match code.size {
                $(#[cfg(feature = "complete")]
                $size if code.constraints.is_some() => Some(bound::<$size>(code)),
                $size => Some(free::<$size>(code)),)*
                _ => None,
            }
        }
    };
}

#[cfg(not(feature = "wide"))]
sizes!(2, 8);
#[cfg(feature = "wide")]
sizes!(2, 8, 32);

/// The smallest number of coordinates that is built and is at least that of a system of this name, and that of its
/// constraints.
///
/// # Errors
/// More coordinates or constraints than are built.
pub(crate) fn size(name: &str, [coordinates, constraints]: [usize; 2]) -> Result<usize, Mistakes> {
    let most = SIZES.last().copied().unwrap_or_default();
    let (count, of) =
        if coordinates < constraints { (constraints, "constraints") } else { (coordinates, "coordinates") };
    let what = || format!("{count} {of}; a text has {most} at most");
    SIZES.iter().copied().find(|size| *size >= count).ok_or_else(|| Mistakes::compiled(name, &what()))
}

/// The system of a code.
///
/// # Errors
/// More coordinates or parameters than are built.
pub(crate) fn system(code: &'static Code) -> Result<Box<dyn System>, Mistakes> {
    check(code)?;
    let system =
        built(code).ok_or_else(|| Mistakes::compiled(code.name, "a number of coordinates that is not built"))?;
    let declared = code.coordinates.len();
    Ok(if declared < code.size { without_rest(system, declared) } else { system })
}

fn check(code: &Code) -> Result<(), Mistakes> {
    if cfg!(not(feature = "complete")) && code.constraints.is_some() {
        return Err(Mistakes::compiled(code.name, "constraints, which this build leaves out"));
    }
    let (count, most) =
        (code.defaults.len(), if code.constraints.is_some() { Of::<1>::PARAMETERS } else { Free::PARAMETERS });
    if count <= most {
        return Ok(());
    }
    Err(Mistakes::compiled(code.name, &format!("{count} parameters; a text has {most} at most")))
}

/// The kind of up to K constraints.
type Of<const K: usize> = Bound<K, Counted>;

/// The system of N coordinates without constraints, with the methods that it has.
fn free<const N: usize>(code: &'static Code) -> Box<dyn System> {
    #[cfg(feature = "complete")]
    let mut all = integrator::all([
        integrators!(fixed),
        integrators!(splitting),
        integrators!(gauss 4, 8),
        integrators!(adaptive 4, 8),
        integrators!(transformed 4, 8),
        integrators!(energy),
        integrators!(energy 1, 2, 3),
    ]);
    #[cfg(not(feature = "complete"))]
    let mut all = integrator::all([integrators!(fixed_2), integrators!(gauss 4, 8), integrators!(energy)]);
    all.retain(|of| has(code, of.built));
    Box::new(Typed::of(Tape::<N, Free>::new(code), all))
}

/// The system of N coordinates with up to N constraints.
#[cfg(feature = "complete")]
fn bound<const N: usize>(code: &'static Code) -> Box<dyn System> {
    let all = integrator::all([integrators!(gauss 1, 2, 3, 4, 6), integrators!(adaptive 3), integrators!(energy 1, 2)]);
    Box::new(Typed::of(Independent::of(Tape::<N, Of<N>>::new(code)), all))
}

/// Whether a system has this method.
fn has(code: &Code, (method, stages, is_transformed): Built) -> bool {
    match (method, stages) {
        _ if is_transformed => code.scales_time,
        (Method::Energy, None) => code.has_step_density,
        (Method::Splitting4 | Method::Splitting6, _) => code.splits,
        (_, None) => code.has_rule,
        (Method::Gauss, Some(_)) => true,
        (_, Some(_)) => code.without_velocity.is_empty(),
    }
}
