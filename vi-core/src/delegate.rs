//! Implementations of the system traits by delegation: for references, for systems by another rule, for systems whose
//! functions are not inlined, and for those of generic code.

use crate::called::{Called, Presumed};
use crate::discrete::DiscreteLagrangian;
use crate::forward;
use crate::kind::Free;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::motion::{Motion, Separable, TimeScale};
use crate::real::Real;
use crate::rules::{By, Own, Rule};
use crate::stepping::{Batch, Convertible, Discretized, EnergyStepping, FixedStepping};

/// Implements the motion traits by the dereferenced system, with this attribute on their functions.
macro_rules! motion {
    ($wrapper:ty, $attribute:tt $(, $rule:ident)?) => {
        impl<const N: usize, T: Real, S: Lagrangian<N, T>$(, $rule: Rule)?> Lagrangian<N, T> for $wrapper {
            forward! { [N T S] self => self; $attribute lagrangian_facts lagrangian rates }
        }

        impl<const N: usize, T: Real, S: Motion<N, T>$(, $rule: Rule)?> Motion<N, T> for $wrapper {
            forward! { [N T S] self => self; $attribute motion_facts motion reactions }
        }
    };
}

/// Implements the step traits by the dereferenced system, with this attribute on their functions: its rule `$of_rule` is
/// the rule `$rule` of the wrapper and has this name.
macro_rules! steps {
    ($wrapper:ty, $of_rule:ident as $rule:ident, $name:expr, $attribute:tt $(, $generic:ident)?) => {
        impl<const N: usize, T: Real, S: DiscreteLagrangian<N, T, $of_rule>$(, $generic: Rule)?>
            DiscreteLagrangian<N, T, $rule> for $wrapper
        {
            forward! { [N T S $of_rule] self => self; $attribute slots }
        }

        impl<const N: usize, T: Real, S: FixedStepping<N, T, $of_rule>$(, $generic: Rule)?> FixedStepping<N, T, $rule>
            for $wrapper
        {
            const RULE: Option<&'static str> = $name;
            forward! { [N T S $of_rule] self => self; $attribute fixed_facts fixed_residuals fixed_matrices }
        }

        impl<const N: usize, T: Real, S: EnergyStepping<N, T, $of_rule>$(, $generic: Rule)?> EnergyStepping<N, T, $rule>
            for $wrapper
        {
            forward! { [N T S $of_rule] self => self; $attribute energy_residuals energy_matrices }
        }
    };
}

// A reference to a system is a system.
motion!(&S, [#[inline(always)]]);
steps!(&S, R as R, S::RULE, [#[inline(always)]], R);

/// The name of a rule; the system itself names its own rule.
const fn rule_name(of_rule: Option<&'static str>, of_system: Option<&'static str>) -> Option<&'static str> {
    match of_rule {
        Some(name) => Some(name),
        None => of_system,
    }
}

motion!(By<S, R>, [#[inline(always)]], R);
steps!(By<S, R>, R as Own, rule_name(R::NAME, S::RULE), [#[inline(always)]], R);

motion!(Presumed<S>, [#[inline(always)]]);

motion!(Called<S>, [#[inline(never)]]);
steps!(Called<S>, Own as Own, S::RULE, [#[inline(never)]]);

impl<T: Real, S: Parameters<T>, R: Rule> Parameters<T> for By<S, R> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        (**self).parameter_mut(name)
    }
}

impl<const N: usize, T: Real, S: TimeScale<N, T>> TimeScale<N, T> for &S {}

impl<const N: usize, T: Real, S: TimeScale<N, T>, R: Rule> TimeScale<N, T> for By<S, R> {}

// Whether a time scale exists is checked when a run begins.
impl<const N: usize, T: Real, S: Motion<N, T, Kind = Free>> TimeScale<N, T> for Called<S> {}

impl<const N: usize, T: Real, S: Separable<N, T>> Separable<N, T> for &S {}

impl<const N: usize, T: Real, S: Separable<N, T>, R: Rule> Separable<N, T> for By<S, R> {}

// Whether the equations have this form is checked when a run begins.
impl<const N: usize, T: Real, S: Motion<N, T, Kind = Free>> Separable<N, T> for Presumed<S> {}

impl<const N: usize, S: Convertible<N>> Convertible<N> for &S {
    type In<T: Real> = S::In<T>;
    const SIDE_BY_SIDE: bool = S::SIDE_BY_SIDE;

    #[inline(always)]
    fn convert<T: Real>(&self) -> Self::In<T> {
        S::convert(self)
    }
}

impl<const N: usize, S: Convertible<N>> Convertible<N> for Called<S> {
    type In<T: Real> = Called<S::In<T>>;
    // Each call would split a vector of stages.
    const SIDE_BY_SIDE: bool = false;

    fn convert<T: Real>(&self) -> Self::In<T> {
        Called(self.0.convert())
    }
}

impl<const N: usize, S: Convertible<N>> Convertible<N> for Presumed<S> {
    type In<T: Real> = Presumed<S::In<T>>;
    const SIDE_BY_SIDE: bool = S::SIDE_BY_SIDE;

    #[inline(always)]
    fn convert<T: Real>(&self) -> Self::In<T> {
        Presumed(self.0.convert())
    }
}

impl<const N: usize, S: Convertible<N>, R: Rule> Convertible<N> for By<S, R> {
    type In<T: Real> = By<S::In<T>, R>;
    const SIDE_BY_SIDE: bool = S::SIDE_BY_SIDE;

    fn convert<T: Real>(&self) -> Self::In<T> {
        By::new(self.system().convert(), self.rule())
    }
}

impl<const N: usize, S: Discretized<N, R>, R: Rule> Discretized<N, R> for &S {
    type Steps<T: Real> = S::Steps<T>;

    #[inline(always)]
    fn steps<T: Real>(&self) -> Self::Steps<T> {
        S::steps(self)
    }
}

impl<const N: usize, S: Discretized<N>> Discretized<N> for Called<S> {
    type Steps<T: Real> = Called<S::Steps<T>>;

    fn steps<T: Real>(&self) -> Self::Steps<T> {
        Called(self.0.steps())
    }
}

impl<const N: usize, S: Discretized<N, R>, R: Rule> Discretized<N> for By<S, R> {
    type Steps<T: Real> = By<S::Steps<T>, R>;

    #[inline(always)]
    fn steps<T: Real>(&self) -> Self::Steps<T> {
        By::new(self.system().steps(), self.rule())
    }
}

impl<const N: usize, S, R: Rule> Batch<N> for By<S, R>
where
    S: Batch<N> + Discretized<N, R>,
{
    type Rows<const W: usize> = (S::Rows<W>, R);

    fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
        (S::rows(&systems.map(|by| *by.system())), systems[0].rule())
    }

    #[inline(always)]
    fn from_rows<const W: usize>((rows, rule): &Self::Rows<W>, index: usize) -> Self {
        By::new(S::from_rows(rows, index), *rule)
    }
}
