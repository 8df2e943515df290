//! Forwarding of the functions of the system traits: one table of their signatures, from which every wrapper is made.
//!
//! In an implementation for a wrapper of a system `S`, with `N` coordinates, over the numbers `T`, by the rule `R` of S
//! (its own rule by default),
//!
//! ```text
//! forward! { [N T S R] self => &self.system; [#[inline]] motion_facts motion }
//! ```
//!
//! writes all functions of these groups with these attributes. Groups divide a trait where wrappers replace a part of
//! it. Facts are types, constants and the functions that return the constants, which are always inlined. In place of
//! `self => &self.system; [#[inline]]`, the word `stub;` writes functions without a body, for a system with errors.

/// Writes functions that call those of another system; see the source of this module.
#[doc(hidden)]
#[macro_export]
macro_rules! forward {
    ([$n:tt $t:tt $s:tt] $($rest:tt)*) => { $crate::forward! { [$n $t $s $crate::rules::Own] $($rest)* } };
    ($of:tt stub; $($group:ident)+) => { $($crate::forward! { @$group $of (stub) })+ };
    ($of:tt $this:ident => $to:expr; $at:tt $($group:ident)+) => { $($crate::forward! { @$group $of ($this $to, $at) })+ };

    // The continuous system.
    (@lagrangian_facts [$n:tt $t:tt $s:tt $r:ty] ($this:ident $to:expr, $at:tt)) => {
        const INTERPRETED: bool = <$s as $crate::Lagrangian<$n, $t>>::INTERPRETED;

        $crate::forward! { @facts [$s as $crate::Lagrangian<$n, $t>] ($this $to)
            NAME name: &'static str,
            COORDINATES coordinates: [&'static str; $n],
            AUTONOMOUS is_autonomous: bool,
            FORCED is_forced: bool,
            CYCLIC cyclic: [bool; $n],
            SPACES spaces: [$crate::lagrangian::Space; $n],
            PARAMETERS parameters: &'static [&'static str],
            INPUTS inputs: &'static [usize],
            MONOTONE_TABLE monotone_table: Option<&'static str>,
            TABLES tables: u32,
        }
        $crate::forward! { @functions [$s as $crate::Lagrangian<$n, $t>] ($this $to, []) parameter(index: usize) -> $t }
    };
    (@lagrangian [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_state [$n $t] [$s as $crate::Lagrangian<$n, $t>] $by
            lagrangian -> $t,
            energy -> $t,
            momentum -> $crate::SVector<$t, $n>,
            force -> $crate::SVector<$t, $n>,
            non_finite -> ::core::option::Option<&'static str>,
            undefined -> ::core::option::Option<$crate::lagrangian::Undefined>,
        }
    };
    (@rates [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_state [$n $t] [$s as $crate::Lagrangian<$n, $t>] $by
            acceleration -> ::core::result::Result<$crate::SVector<$t, $n>, $crate::StepError>,
            flow -> ::core::result::Result<$crate::lagrangian::Flow<$n, $t>, $crate::StepError>,
        }
    };

    // The equations of motion at a point.
    (@motion_facts [$n:tt $t:tt $s:tt $r:ty] ($this:ident $to:expr, $at:tt)) => {
        type Kind = <$s as $crate::motion::Motion<$n, $t>>::Kind;
        type Mass = <$s as $crate::motion::Motion<$n, $t>>::Mass;
        type PointMatrix = <$s as $crate::motion::Motion<$n, $t>>::PointMatrix;

        $crate::forward! { @facts [$s as $crate::motion::Motion<$n, $t>] ($this $to)
            CONSTANT_MASS has_constant_mass: bool,
            CURVILINEAR is_curvilinear: bool,
            SEPARABLE is_separable: bool,
            SPLITS splits: bool,
            SCALES_TIME scales_time: bool,
            POINT_MASSES has_point_masses: bool,
            WITHOUT_VELOCITY without_velocity: &'static [bool],
            CONSTRAINTS constraint_names: &'static [&'static str],
            HOLONOMIC holonomic: usize,
            BLOCKS blocks: &'static [$crate::linear::Block],
        }
        $crate::forward! { @functions [$s as $crate::motion::Motion<$n, $t>] ($this $to, [#[inline(always)]])
            moving() -> usize
        }
    };
    (@motion [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_state [$n $t] [$s as $crate::motion::Motion<$n, $t>] $by
            point -> $crate::motion::Point<$n, $t, Self::Mass>,
            sides -> $crate::motion::Sides<$n, $t>,
            applied_force -> $crate::SVector<$t, $n>,
            point_derivatives -> $crate::motion::PointDerivatives<Self::PointMatrix>,
            power -> $t,
            scaled_point -> $crate::motion::ScaledPoint<$n, $t, Self::Mass>,
            applied -> $crate::SVector<$t, $n>,
        }
        $crate::forward! { @functions [$s as $crate::motion::Motion<$n, $t>] $by
            sides_and_inverse(
                t: $t,
                q: &$crate::SVector<$t, $n>,
                v: &$crate::SVector<$t, $n>,
                inverse: &mut $crate::nalgebra::SMatrix<$t, $n, $n>
            ) -> $crate::motion::Sides<$n, $t>,
            constraints(t: $t, q: &$crate::SVector<$t, $n>) -> $crate::kind::Multipliers<Self, $n, $t>,
        }
    };
    (@reactions [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @functions [$s as $crate::motion::Motion<$n, $t>] $by
            constraint_gradients(t: $t, q: &$crate::SVector<$t, $n>)
                -> ($crate::kind::Gradients<Self, $n, $t>, $crate::kind::Multipliers<Self, $n, $t>),
            reaction_derivatives(
                t: $t,
                q: &$crate::SVector<$t, $n>,
                multipliers: &$crate::kind::Multipliers<Self, $n, $t>
            ) -> $crate::kind::ReactionMatrix<Self, $n, $t>,
            is_dropped(constraint: usize) -> bool,
        }
        $crate::forward! { @at_state [$n $t] [$s as $crate::motion::Motion<$n, $t>] $by
            constraint_rate_derivatives
                -> ($crate::kind::Gradients<Self, $n, $t>, $crate::kind::Multipliers<Self, $n, $t>),
            broken -> ::core::option::Option<(usize, $t)>,
        }
    };

    // The slots of the discrete system.
    (@slots [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @over_interval [$n $t] [$s as $crate::DiscreteLagrangian<$n, $t, $r>] $by
            ld -> $t,
            d1_ld -> $t,
            d2_ld -> $crate::SVector<$t, $n>,
            d3_ld -> $t,
            d4_ld -> $crate::SVector<$t, $n>,
            fd_minus -> $crate::SVector<$t, $n>,
            fd_plus -> $crate::SVector<$t, $n>,
            gd_minus -> $t,
            gd_plus -> $t,
        }
    };

    // The equations of a step of given length.
    (@fixed_facts [$n:tt $t:tt $s:tt $r:ty] ($this:ident $to:expr, $at:tt)) => {
        type Jacobian = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::Jacobian;
        type StepMatrix = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::StepMatrix;

        $crate::forward! { @facts [$s as $crate::stepping::FixedStepping<$n, $t, $r>] ($this $to)
            CONSTANT_JACOBIAN has_constant_jacobian: bool,
            CLOSED_FORM has_closed_form: bool,
            INLINED is_inlined: bool,
        }
    };
    (@fixed_residuals [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_node [$n $t] [$s as $crate::stepping::FixedStepping<$n, $t, $r>] $by
            momentum_residual -> $crate::stepping::MomentumResidual<$n, $t>,
            momentum_rounding -> $crate::SVector<$t, $n>,
            discrete_energy -> $t,
        }
    };
    (@fixed_matrices [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_node [$n $t] [$s as $crate::stepping::FixedStepping<$n, $t, $r>] $by
            momentum_equation -> $crate::stepping::MomentumEquation<$n, $t, Self::Jacobian>,
            momentum_derivatives -> $crate::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix>,
        }
    };

    // The equations of a step whose length is an unknown.
    (@energy_residuals [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_node [$n $t] [$s as $crate::stepping::EnergyStepping<$n, $t, $r>] $by
            extended_residual -> $crate::stepping::ExtendedResidual<$n, $t>,
            extended_rounding -> $crate::stepping::Rounding<$n, $t>,
        }
        $crate::forward! { @at_state [$n $t] [$s as $crate::stepping::EnergyStepping<$n, $t, $r>] $by
            step_density -> ::core::result::Result<$t, $crate::StepError>,
        }
    };
    (@energy_matrices [$n:tt $t:tt $s:tt $r:ty] $by:tt) => {
        $crate::forward! { @at_node [$n $t] [$s as $crate::stepping::EnergyStepping<$n, $t, $r>] $by
            extended_system -> $crate::stepping::ExtendedSystem<$n, $t, Self::Jacobian>,
            extended_derivatives -> $crate::stepping::ExtendedDerivatives<$n, $t, Self::Jacobian, Self::StepMatrix>,
        }
    };

    // Functions of (t, q, v), of an interval, and of a node with a step and a velocity.
    (@at_state [$n:tt $t:tt] $of:tt $by:tt $($name:ident -> $out:ty),+ $(,)?) => {
        $crate::forward! { @functions $of $by
            $($name(t: $t, q: &$crate::SVector<$t, $n>, v: &$crate::SVector<$t, $n>) -> $out),+
        }
    };
    (@over_interval [$n:tt $t:tt] $of:tt $by:tt $($name:ident -> $out:ty),+ $(,)?) => {
        $crate::forward! { @functions $of $by $($name(interval: &$crate::Interval<$n, $t>) -> $out),+ }
    };
    (@at_node [$n:tt $t:tt] $of:tt $by:tt $($name:ident -> $out:ty),+ $(,)?) => {
        $crate::forward! { @functions $of $by
            $($name(node: &$crate::node::Node<$n, $t>, h: $t, v: &$crate::SVector<$t, $n>) -> $out),+
        }
    };
    (@functions $of:tt (stub) $($name:ident($($argument:ident: $type:ty),*) -> $out:ty),+ $(,)?) => {
        $(fn $name(&self, $(_: $type),*) -> $out {
            loop {}
        })+
    };
    (
        @functions [$s:tt as $trait:path] ($this:ident $to:expr, $at:tt)
        $($name:ident($($argument:ident: $type:ty),*) -> $out:ty),+ $(,)?
    ) => {
        $($crate::forward! { @attributed $at
            fn $name(&$this, $($argument: $type),*) -> $out {
                <$s as $trait>::$name($to, $($argument),*)
            }
        })+
    };
    (@attributed [$($at:tt)*] $($function:tt)+) => { $($at)* $($function)+ };

    // Constants, each with the function that returns it.
    (@facts [$s:tt as $trait:path] ($this:ident $to:expr) $($constant:ident $name:ident: $type:ty),+ $(,)?) => {
        $(const $constant: $type = <$s as $trait>::$constant;
        #[inline(always)]
        fn $name(&$this) -> $type {
            <$s as $trait>::$name($to)
        })+
    };
}
