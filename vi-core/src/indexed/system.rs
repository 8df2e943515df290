//! The traits of a large system by one macro, each function by the one of this module with the same name.

/// Implements `Motion` and `Convertible` for a large system, and for each of its rules the traits of a step:
/// `DiscreteLagrangian`, `FixedStepping`, `EnergyStepping` and `Discretized`.
///
/// ```text
/// vi_core::indexed::system! {
///     Bodies, coordinates(12), constraints(none), mass(dense), time_scale(none);
///     rule(Own), points(Midpoint), jacobian(dense), energy_steps(true);
///     rule(Trapezoidal), points(Trapezoidal), jacobian(dense), energy_steps(false)
/// }
/// ```
///
/// `Bodies<T>` implements `Lagrangian` and `Indexed`, and has a function `convert` to another type of numbers.
///
/// | argument | values |
/// |---|---|
/// | `constraints` | `none`; or their number, then the system implements `IndexedConstraints` |
/// | `mass`, `jacobian` | `dense`: from second derivatives; `diagonal`: the constant matrix `mass_diagonal` of the system |
/// | `time_scale` | `none`; `own`: `Indexed::time_scale` of the system |
/// | `rule` | the last argument of the traits |
/// | `points` | the quadrature rule of a step |
/// | `energy_steps` | whether `EnergyStepping` is implemented: only by the midpoint rule |
#[doc(hidden)]
#[macro_export]
macro_rules! indexed_system {
    (
        $system:ident, coordinates($n:literal), constraints($count:tt), mass($mass:ident), time_scale($scale:ident)
        $(; rule($rule:ident), points($points:ident), jacobian($jacobian:ident), energy_steps($energy:ident))*
    ) => {
        #[allow(unused_imports)]
        const _: () = {
            // A binding may shadow a function, but not a constant of the surrounding code.
            use ::core::convert::{
                identity as h, identity as interval, identity as multipliers, identity as node, identity as q,
                identity as t, identity as v,
            };
            use ::core::primitive::{bool, str, usize};

            impl<T: $crate::real::Real> $crate::motion::Motion<$n, T> for $system<T> {
                type PointMatrix = $crate::nalgebra::SMatrix<T, $n, $n>;
                $crate::indexed_system! { @mass $mass $n }
                const SEPARABLE: bool = $crate::indexed_system!(@is_separable $mass $count);
                $crate::indexed_system! { @constraints $count $n }
                $crate::indexed_system! { @scaled_point $scale $mass $n }

                $crate::indexed_system! { @with_mass $n $mass point -> $crate::motion::Point<$n, T, Self::Mass> }
                $crate::indexed_system! { @state $n
                    sides -> $crate::motion::Sides<$n, T>,
                    point_derivatives -> $crate::motion::PointDerivatives<Self::PointMatrix>,
                    power -> T
                }
            }

            impl $crate::stepping::Convertible<$n> for $system<f64> {
                type In<T: $crate::real::Real> = $system<T>;
                const SIDE_BY_SIDE: bool = <Self as $crate::motion::Motion<$n>>::CONSTANT_MASS;

                #[inline(always)]
                fn convert<T: $crate::real::Real>(&self) -> $system<T> {
                    self.convert()
                }
            }

            $crate::indexed_system! { @separable $mass $count $system $n }
            $crate::indexed_system! { @time_scale $scale $system $n }
            $($crate::indexed_system! { @steps $system $n $rule $points $jacobian $energy })*
        };
    };

    // Functions of (t, q, v), and of the mass matrix there.
    (@state $n:literal $($name:ident -> $out:ty),*) => {
        $(fn $name(&self, t: T, q: &$crate::SVector<T, $n>, v: &$crate::SVector<T, $n>) -> $out {
            $crate::indexed::$name(self, t, q, v)
        })*
    };

    (@with_mass $n:literal $mass:ident $name:ident -> $out:ty) => {
        fn $name(&self, t: T, q: &$crate::SVector<T, $n>, v: &$crate::SVector<T, $n>) -> $out {
            $crate::indexed::$name(self, t, q, v, $crate::indexed_system!(@mass_at $mass self t q v))
        }
    };

    // Functions of a step: of an interval by the points of a rule, of a node with (h, v) by them, and of such a node.
    (@interval $n:literal $points:ident $($name:ident -> $out:ty),*) => {
        $(fn $name(&self, interval: &$crate::Interval<$n, T>) -> $out {
            $crate::indexed::$name(self, $crate::rules::$points, interval)
        })*
    };
    (@by_points $n:literal $points:ident $($name:ident -> $out:ty),*) => {
        $(fn $name(&self, node: &$crate::node::Node<$n, T>, h: T, v: &$crate::SVector<T, $n>) -> $out {
            $crate::indexed::$name(self, $crate::rules::$points, node, h, v)
        })*
    };
    (@with_jacobian $n:literal $points:ident $jacobian:ident $($name:ident -> $out:ty),*) => {
        $(fn $name(&self, node: &$crate::node::Node<$n, T>, h: T, v: &$crate::SVector<T, $n>) -> $out {
            $crate::indexed::$name(
                self, $crate::rules::$points, node, h, v,
                $crate::indexed_system!(@jacobian_at $jacobian $points self node h v),
            )
        })*
    };
    (@node $n:literal $($name:ident -> $out:ty),*) => {
        $(fn $name(&self, node: &$crate::node::Node<$n, T>, h: T, v: &$crate::SVector<T, $n>) -> $out {
            $crate::indexed::$name(self, node, h, v)
        })*
    };
    // Rounding-error bounds: the same function over other numbers.
    (@rounding $n:literal $rule:ident $name:ident -> $out:ty) => {
        #[cold]
        fn $name(&self, node: &$crate::node::Node<$n, T>, h: T, v: &$crate::SVector<T, $n>) -> $out {
            $crate::support::$name(
                &$crate::rules::By::new(self.convert::<$crate::real::Rounded>(), $crate::rules::$rule),
                node, h, v,
            )
        }
    };

    (@mass dense $n:literal) => {
        type Mass = $crate::nalgebra::SMatrix<T, $n, $n>;
        const CONSTANT_MASS: bool = false;
    };
    (@mass diagonal $n:literal) => {
        type Mass = $crate::linear::Banded<$n, 1, T>;
        const CONSTANT_MASS: bool = true;
    };
    (@mass_at dense $this:tt $t:tt $q:tt $v:tt) => { $crate::indexed::mass($this, $t, $q, $v) };
    (@mass_at diagonal $this:tt $t:tt $q:tt $v:tt) => { $this.mass_diagonal($t, $q, $v) };

    (@is_separable diagonal none) => { true };
    (@is_separable $mass:ident $count:tt) => { false };
    (@separable diagonal none $system:ident $n:literal) => {
        impl<T: $crate::real::Real> $crate::motion::Separable<$n, T> for $system<T> {}
    };
    (@separable $mass:ident $count:tt $system:ident $n:literal) => {};

    (@constraints none $n:literal) => { type Kind = $crate::kind::Free; };
    (@constraints $count:literal $n:literal) => {
        type Kind = $crate::kind::Bound<$count>;
        const CONSTRAINTS: &'static [&'static str] =
            <Self as $crate::indexed::IndexedConstraints<$n, $count, T>>::CONSTRAINTS;
        const HOLONOMIC: usize = <Self as $crate::indexed::IndexedConstraints<$n, $count, T>>::HOLONOMIC;

        $crate::indexed_system! { @state $n
            applied -> $crate::SVector<T, $n>,
            constraint_rate_derivatives -> ([$crate::SVector<T, $n>; $count], [T; $count])
        }

        fn constraints(&self, t: T, q: &$crate::SVector<T, $n>) -> [T; $count] {
            $crate::indexed::constraints(self, t, q)
        }

        fn constraint_gradients(
            &self,
            t: T,
            q: &$crate::SVector<T, $n>,
        ) -> ([$crate::SVector<T, $n>; $count], [T; $count]) {
            $crate::indexed::constraint_gradients(self, t, q)
        }

        fn reaction_derivatives(
            &self,
            t: T,
            q: &$crate::SVector<T, $n>,
            multipliers: &[T; $count],
        ) -> [$crate::SVector<T, $n>; $n] {
            $crate::indexed::reaction_derivatives(self, t, q, multipliers)
        }
    };

    (@scaled_point none $mass:ident $n:literal) => {};
    (@scaled_point own $mass:ident $n:literal) => {
        const SCALES_TIME: bool = true;

        $crate::indexed_system! { @with_mass $n $mass scaled_point -> $crate::motion::ScaledPoint<$n, T, Self::Mass> }
    };
    (@time_scale none $system:ident $n:literal) => {};
    (@time_scale own $system:ident $n:literal) => {
        impl<T: $crate::real::Real> $crate::motion::TimeScale<$n, T> for $system<T> {}
    };

    (@steps $system:ident $n:literal $rule:ident $points:ident $jacobian:ident $energy:ident) => {
        impl<T: $crate::real::Real> $crate::DiscreteLagrangian<$n, T, $crate::rules::$rule> for $system<T> {
            $crate::indexed_system! { @interval $n $points
                ld -> T, d1_ld -> T, d2_ld -> $crate::SVector<T, $n>, d3_ld -> T, d4_ld -> $crate::SVector<T, $n>,
                fd_minus -> $crate::SVector<T, $n>, fd_plus -> $crate::SVector<T, $n>, gd_minus -> T, gd_plus -> T
            }
        }

        impl<T: $crate::real::Real> $crate::stepping::FixedStepping<$n, T, $crate::rules::$rule> for $system<T> {
            type StepMatrix = $crate::nalgebra::SMatrix<T, $n, $n>;
            $crate::indexed_system! { @jacobian $jacobian $n }
            $crate::indexed_system! { @with_jacobian $n $points $jacobian
                momentum_equation -> $crate::stepping::MomentumEquation<$n, T, Self::Jacobian>,
                momentum_derivatives -> $crate::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix>
            }
            $crate::indexed_system! { @by_points $n $points
                momentum_residual -> $crate::stepping::MomentumResidual<$n, T>, discrete_energy -> T
            }
            $crate::indexed_system! { @rounding $n $rule momentum_rounding -> $crate::SVector<T, $n> }
        }

        $crate::indexed_system! { @energy_steps $energy $system $n $rule }

        impl $crate::stepping::Discretized<$n, $crate::rules::$rule> for $system<f64> {
            type Steps<T: $crate::real::Real> = $system<T>;

            #[inline(always)]
            fn steps<T: $crate::real::Real>(&self) -> $system<T> {
                self.convert()
            }
        }
    };
    (@energy_steps false $system:ident $n:literal $rule:ident) => {};
    (@energy_steps true $system:ident $n:literal $rule:ident) => {
        impl<T: $crate::real::Real> $crate::stepping::EnergyStepping<$n, T, $crate::rules::$rule> for $system<T> {
            $crate::indexed_system! { @state $n step_density -> ::core::result::Result<T, $crate::StepError> }
            $crate::indexed_system! { @node $n
                extended_system -> $crate::stepping::ExtendedSystem<$n, T, Self::Jacobian>,
                extended_residual -> $crate::stepping::ExtendedResidual<$n, T>,
                extended_derivatives ->
                    $crate::stepping::ExtendedDerivatives<$n, T, Self::Jacobian, Self::StepMatrix>
            }
            $crate::indexed_system! { @rounding $n $rule extended_rounding -> $crate::stepping::Rounding<$n, T> }
        }
    };

    (@jacobian dense $n:literal) => {
        type Jacobian = $crate::nalgebra::SMatrix<T, $n, $n>;
        const CONSTANT_JACOBIAN: bool = false;
    };
    (@jacobian diagonal $n:literal) => {
        type Jacobian = $crate::linear::Banded<$n, 1, T>;
        const CONSTANT_JACOBIAN: bool = true;
    };
    (@jacobian_at dense $points:ident $this:tt $node:tt $h:tt $v:tt) => {
        $crate::indexed::jacobian($this, $crate::rules::$points, $node, $h, $v)
    };
    (@jacobian_at diagonal $points:ident $this:tt $node:tt $h:tt $v:tt) => {
        $this.mass_diagonal($node.t, &$node.q, $v)
    };
}
