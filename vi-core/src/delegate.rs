//! What a system says of itself, said by what dereferences to it: a reference, a system by another rule, a system whose functions
//! are calls.

use crate::called::Called;
use crate::collocation::{Collocation, Point, PointDerivatives, ScaledPoint, TimeScale};
use crate::discrete::DiscreteLagrangian;
use crate::error::StepError;
use crate::lagrangian::{Flow, Lagrangian, Parameters};
use crate::node::Node;
use crate::real::Real;
use crate::rules::{By, Own, Rule};
use crate::state::Interval;
use crate::stepping::{
    Batch, Convertible, Discretized, EnergyStepping, ExtendedDerivatives, ExtendedResidual, ExtendedSystem,
    FixedStepping, MomentumDerivatives, MomentumEquation, MomentumResidual, Rounding,
};
use nalgebra::SVector;

/// The continuous system of what dereferences to S.
macro_rules! lagrangian {
    ($wrapper:ty $(, $rule:ident)?) => {
        impl<const N: usize, T: Real, S: Lagrangian<N, T>$(, $rule: Rule)?> Lagrangian<N, T> for $wrapper {
            const NAME: &'static str = S::NAME;
            const COORDINATES: [&'static str; N] = S::COORDINATES;
            const AUTONOMOUS: bool = S::AUTONOMOUS;
            const FORCED: bool = S::FORCED;
            const CYCLIC: [bool; N] = S::CYCLIC;
            const PARAMETERS: &'static [&'static str] = S::PARAMETERS;

            fn parameter(&self, index: usize) -> T {
                S::parameter(self, index)
            }

            #[inline]
            fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
                S::lagrangian(self, t, q, v)
            }

            #[inline]
            fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
                S::energy(self, t, q, v)
            }

            #[inline]
            fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
                S::momentum(self, t, q, v)
            }

            #[inline]
            fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
                S::force(self, t, q, v)
            }

            #[inline]
            fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
                S::acceleration(self, t, q, v)
            }

            #[inline]
            fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
                S::flow(self, t, q, p)
            }

            fn non_finite(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<&'static str> {
                S::non_finite(self, t, q, v)
            }
        }
    };
}

/// The equations of motion of what dereferences to S, each function with this attribute.
macro_rules! collocation {
    ($wrapper:ty, #[$attribute:meta] $(, $rule:ident)?) => {
        impl<const N: usize, T: Real, S: Collocation<N, T>$(, $rule: Rule)?> Collocation<N, T> for $wrapper {
            type Mass = S::Mass;
            type PointMatrix = S::PointMatrix;
            const CONSTANT_MASS: bool = S::CONSTANT_MASS;
            const SEPARABLE: bool = S::SEPARABLE;
            const SCALES_TIME: bool = S::SCALES_TIME;

            #[$attribute]
            fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, S::Mass> {
                S::point(self, t, q, v)
            }

            #[$attribute]
            fn point_derivatives(
                &self,
                t: T,
                q: &SVector<T, N>,
                v: &SVector<T, N>,
            ) -> PointDerivatives<S::PointMatrix> {
                S::point_derivatives(self, t, q, v)
            }

            #[inline]
            fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
                S::power(self, t, q, v)
            }

            #[$attribute]
            fn scaled_point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ScaledPoint<N, T, S::Mass> {
                S::scaled_point(self, t, q, v)
            }
        }
    };
}

/// The discrete system of what dereferences to S: its rule `$of_rule` is the rule `$rule` of the wrapper.
macro_rules! discrete {
    ($wrapper:ty, $of_rule:ident as $rule:ident $(, $generic:ident)?) => {
        impl<const N: usize, T: Real, S: DiscreteLagrangian<N, T, $of_rule>$(, $generic: Rule)?>
            DiscreteLagrangian<N, T, $rule> for $wrapper
        {
            #[inline]
            fn ld(&self, interval: &Interval<N, T>) -> T {
                <S as DiscreteLagrangian<N, T, $of_rule>>::ld(self, interval)
            }

            #[inline]
            fn d1_ld(&self, interval: &Interval<N, T>) -> T {
                <S as DiscreteLagrangian<N, T, $of_rule>>::d1_ld(self, interval)
            }

            #[inline]
            fn d2_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
                <S as DiscreteLagrangian<N, T, $of_rule>>::d2_ld(self, interval)
            }

            #[inline]
            fn d3_ld(&self, interval: &Interval<N, T>) -> T {
                <S as DiscreteLagrangian<N, T, $of_rule>>::d3_ld(self, interval)
            }

            #[inline]
            fn d4_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
                <S as DiscreteLagrangian<N, T, $of_rule>>::d4_ld(self, interval)
            }

            #[inline]
            fn fd_minus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
                <S as DiscreteLagrangian<N, T, $of_rule>>::fd_minus(self, interval)
            }

            #[inline]
            fn fd_plus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
                <S as DiscreteLagrangian<N, T, $of_rule>>::fd_plus(self, interval)
            }

            #[inline]
            fn gd_minus(&self, interval: &Interval<N, T>) -> T {
                <S as DiscreteLagrangian<N, T, $of_rule>>::gd_minus(self, interval)
            }

            #[inline]
            fn gd_plus(&self, interval: &Interval<N, T>) -> T {
                <S as DiscreteLagrangian<N, T, $of_rule>>::gd_plus(self, interval)
            }
        }
    };
}

/// The equations of a step of what dereferences to S, by the rule of this name, each function with this attribute.
macro_rules! stepping {
    ($wrapper:ty, $of_rule:ident as $rule:ident, $name:expr, #[$attribute:meta] $(, $generic:ident)?) => {
        impl<const N: usize, T: Real, S: FixedStepping<N, T, $of_rule>$(, $generic: Rule)?> FixedStepping<N, T, $rule>
            for $wrapper
        {
            type Jacobian = S::Jacobian;
            type StepMatrix = S::StepMatrix;
            const RULE: Option<&'static str> = $name;
            const CONSTANT_JACOBIAN: bool = S::CONSTANT_JACOBIAN;
            const CLOSED_FORM: bool = S::CLOSED_FORM;
            const INLINED: bool = S::INLINED;

            #[$attribute]
            fn momentum_equation(
                &self,
                node: &Node<N, T>,
                h: T,
                v: &SVector<T, N>,
            ) -> MomentumEquation<N, T, S::Jacobian> {
                <S as FixedStepping<N, T, $of_rule>>::momentum_equation(self, node, h, v)
            }

            #[$attribute]
            fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
                <S as FixedStepping<N, T, $of_rule>>::momentum_residual(self, node, h, v)
            }

            #[$attribute]
            fn momentum_derivatives(
                &self,
                node: &Node<N, T>,
                h: T,
                v: &SVector<T, N>,
            ) -> MomentumDerivatives<S::Jacobian, S::StepMatrix> {
                <S as FixedStepping<N, T, $of_rule>>::momentum_derivatives(self, node, h, v)
            }

            fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N> {
                <S as FixedStepping<N, T, $of_rule>>::momentum_rounding(self, node, h, v)
            }

            fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T {
                <S as FixedStepping<N, T, $of_rule>>::discrete_energy(self, node, h, v)
            }
        }

        impl<const N: usize, T: Real, S: EnergyStepping<N, T, $of_rule>$(, $generic: Rule)?> EnergyStepping<N, T, $rule>
            for $wrapper
        {
            #[inline]
            fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError> {
                <S as EnergyStepping<N, T, $of_rule>>::step_density(self, t, q, v)
            }

            #[$attribute]
            fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, S::Jacobian> {
                <S as EnergyStepping<N, T, $of_rule>>::extended_system(self, node, h, v)
            }

            #[$attribute]
            fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
                <S as EnergyStepping<N, T, $of_rule>>::extended_residual(self, node, h, v)
            }

            #[$attribute]
            fn extended_derivatives(
                &self,
                node: &Node<N, T>,
                h: T,
                v: &SVector<T, N>,
            ) -> ExtendedDerivatives<N, T, S::Jacobian, S::StepMatrix> {
                <S as EnergyStepping<N, T, $of_rule>>::extended_derivatives(self, node, h, v)
            }

            fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
                <S as EnergyStepping<N, T, $of_rule>>::extended_rounding(self, node, h, v)
            }
        }
    };
}

// A system may be lent as well as given.
lagrangian!(&S);
collocation!(&S, #[inline(always)]);
discrete!(&S, R as R, R);
stepping!(&S, R as R, S::RULE, #[inline(always)], R);

/// The name of a rule; that of the system's own is what the system says.
const fn rule_name(of_rule: Option<&'static str>, of_system: Option<&'static str>) -> Option<&'static str> {
    match of_rule {
        Some(name) => Some(name),
        None => of_system,
    }
}

lagrangian!(By<S, R>, R);
collocation!(By<S, R>, #[inline(always)], R);
discrete!(By<S, R>, R as Own, R);
stepping!(By<S, R>, R as Own, rule_name(R::NAME, S::RULE), #[inline(always)], R);

lagrangian!(Called<S>);
collocation!(Called<S>, #[inline(never)]);
discrete!(Called<S>, Own as Own);
stepping!(Called<S>, Own as Own, S::RULE, #[inline(never)]);

impl<T: Real, S: Parameters<T>, R: Rule> Parameters<T> for By<S, R> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        self.system_mut().parameter_mut(name)
    }
}

impl<T: Real, S: Parameters<T>> Parameters<T> for Called<S> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        self.0.parameter_mut(name)
    }
}

impl<const N: usize, T: Real, S: TimeScale<N, T>> TimeScale<N, T> for &S {}

impl<const N: usize, T: Real, S: TimeScale<N, T>, R: Rule> TimeScale<N, T> for By<S, R> {}

// Whether it has one is asked when a run begins.
impl<const N: usize, T: Real, S: Collocation<N, T>> TimeScale<N, T> for Called<S> {}

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
    // A vector of stages would be taken apart for each call.
    const SIDE_BY_SIDE: bool = false;

    fn convert<T: Real>(&self) -> Self::In<T> {
        Called(self.0.convert())
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
