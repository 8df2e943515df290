//! Forwarding of trait functions: one table of their signatures beside the traits.
//!
//! In an implementation for a wrapper of a system `S`, with `N` coordinates, over the numbers `T`, by the rule `R` of S
//! (its own rule by default),
//!
//! ```text
//! forward! { [N T S R] self => &self.system; [#[inline]] lagrangian energy momentum }
//! ```
//!
//! writes these functions with these attributes. `lagrangian_constants`, `motion_types` and `stepping_types` write
//! the types and constants of a trait.

/// Writes functions that call those of another system; see the source of this module.
#[doc(hidden)]
#[macro_export]
macro_rules! forward {
    ([$n:tt $t:tt $s:tt] $($rest:tt)*) => { $crate::forward! { [$n $t $s $crate::rules::Own] $($rest)* } };
    ($of:tt $this:ident => $to:expr; $at:tt $($name:ident)+) => { $($crate::forward! { @$name $of ($this) ($to) $at })+ };

    // The shapes: a function of (t, q, v), of an interval, of a node with a step and a velocity.
    (@state [$n:tt $t:tt $s:tt $r:ty] $trait:path, $name:ident -> $out:ty, ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn $name(&$this, t: $t, q: &$crate::SVector<$t, $n>, v: &$crate::SVector<$t, $n>) -> $out {
            <$s as $trait>::$name($to, t, q, v)
        }
    };
    (@interval [$n:tt $t:tt $s:tt $r:ty] $name:ident -> $out:ty, ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn $name(&$this, interval: &$crate::Interval<$n, $t>) -> $out {
            <$s as $crate::DiscreteLagrangian<$n, $t, $r>>::$name($to, interval)
        }
    };
    (@node [$n:tt $t:tt $s:tt $r:ty] $trait:path, $name:ident -> $out:ty, ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn $name(&$this, node: &$crate::node::Node<$n, $t>, h: $t, v: &$crate::SVector<$t, $n>) -> $out {
            <$s as $trait>::$name($to, node, h, v)
        }
    };

    // Facts about the system.
    (@facts ($this:ident) ($to:expr) $trait:path, $s:tt, $($name:ident -> $out:ty),*) => {
        $(#[inline(always)]
        fn $name(&$this) -> $out {
            <$s as $trait>::$name($to)
        })*
    };

    // The continuous system.
    (@lagrangian_constants [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) $at:tt) => {
        const NAME: &'static str = <$s as $crate::Lagrangian<$n, $t>>::NAME;
        const COORDINATES: [&'static str; $n] = <$s as $crate::Lagrangian<$n, $t>>::COORDINATES;
        const AUTONOMOUS: bool = <$s as $crate::Lagrangian<$n, $t>>::AUTONOMOUS;
        const FORCED: bool = <$s as $crate::Lagrangian<$n, $t>>::FORCED;
        const CYCLIC: [bool; $n] = <$s as $crate::Lagrangian<$n, $t>>::CYCLIC;
        const ANGLES: [bool; $n] = <$s as $crate::Lagrangian<$n, $t>>::ANGLES;
        const PARAMETERS: &'static [&'static str] = <$s as $crate::Lagrangian<$n, $t>>::PARAMETERS;
        const INPUTS: &'static [usize] = <$s as $crate::Lagrangian<$n, $t>>::INPUTS;
        const MONOTONE_TABLE: Option<&'static str> = <$s as $crate::Lagrangian<$n, $t>>::MONOTONE_TABLE;
        const TABLES: u32 = <$s as $crate::Lagrangian<$n, $t>>::TABLES;
        const INTERPRETED: bool = <$s as $crate::Lagrangian<$n, $t>>::INTERPRETED;

        $crate::forward! { @facts ($this) ($to) $crate::Lagrangian<$n, $t>, $s,
            name -> &'static str, coordinates -> [&'static str; $n], is_autonomous -> bool, is_forced -> bool,
            cyclic -> [bool; $n], angles -> [bool; $n], parameters -> &'static [&'static str],
            inputs -> &'static [usize], tables -> u32, monotone_table -> Option<&'static str> }

        fn parameter(&$this, index: usize) -> $t {
            <$s as $crate::Lagrangian<$n, $t>>::parameter($to, index)
        }
    };
    (@lagrangian [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, lagrangian -> $t, $($rest)* }
    };
    (@energy [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, energy -> $t, $($rest)* }
    };
    (@momentum [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, momentum -> $crate::SVector<$t, $n>, $($rest)* }
    };
    (@force [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, force -> $crate::SVector<$t, $n>, $($rest)* }
    };
    (@acceleration [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, acceleration -> Result<$crate::SVector<$t, $n>, $crate::StepError>, $($rest)* }
    };
    (@flow [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, flow -> Result<$crate::lagrangian::Flow<$n, $t>, $crate::StepError>, $($rest)* }
    };
    (@non_finite [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, non_finite -> Option<&'static str>, $($rest)* }
    };

    (@undefined [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::Lagrangian<$n, $t>, undefined -> Option<$crate::lagrangian::Undefined>, $($rest)* }
    };

    // The equations of motion at a point.
    (@motion_types [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        type Kind = <$s as $crate::motion::Motion<$n, $t>>::Kind;
        type Mass = <$s as $crate::motion::Motion<$n, $t>>::Mass;
        type PointMatrix = <$s as $crate::motion::Motion<$n, $t>>::PointMatrix;
        const CONSTANT_MASS: bool = <$s as $crate::motion::Motion<$n, $t>>::CONSTANT_MASS;
        const CURVILINEAR: bool = <$s as $crate::motion::Motion<$n, $t>>::CURVILINEAR;
        const SEPARABLE: bool = <$s as $crate::motion::Motion<$n, $t>>::SEPARABLE;
        const SPLITS: bool = <$s as $crate::motion::Motion<$n, $t>>::SPLITS;
        const SCALES_TIME: bool = <$s as $crate::motion::Motion<$n, $t>>::SCALES_TIME;
        const POINT_MASSES: bool = <$s as $crate::motion::Motion<$n, $t>>::POINT_MASSES;
        const WITHOUT_VELOCITY: &'static [bool] = <$s as $crate::motion::Motion<$n, $t>>::WITHOUT_VELOCITY;
        const CONSTRAINTS: &'static [&'static str] = <$s as $crate::motion::Motion<$n, $t>>::CONSTRAINTS;
        const HOLONOMIC: usize = <$s as $crate::motion::Motion<$n, $t>>::HOLONOMIC;
        const BLOCKS: &'static [$crate::linear::Block] = <$s as $crate::motion::Motion<$n, $t>>::BLOCKS;

        $crate::forward! { @motion_facts [$n $t $s $r] $($rest)* }
    };
    (@motion_facts [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) $at:tt) => {
        $crate::forward! { @facts ($this) ($to) $crate::motion::Motion<$n, $t>, $s,
            has_constant_mass -> bool, is_curvilinear -> bool, is_separable -> bool, splits -> bool, scales_time -> bool, has_point_masses -> bool,
            without_velocity -> &'static [bool], moving -> usize, constraint_names -> &'static [&'static str], holonomic -> usize,
            blocks -> &'static [$crate::linear::Block] }
    };
    (@point [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, point -> $crate::motion::Point<$n, $t, Self::Mass>, $($rest)* }
    };
    (@sides [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, sides -> $crate::motion::Sides<$n, $t>, $($rest)* }
    };
    (@applied_force [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, applied_force -> $crate::SVector<$t, $n>, $($rest)* }
    };
    (@point_derivatives [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, point_derivatives -> $crate::motion::PointDerivatives<Self::PointMatrix>, $($rest)* }
    };
    (@power [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, power -> $t, $($rest)* }
    };
    (@scaled_point [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, scaled_point -> $crate::motion::ScaledPoint<$n, $t, Self::Mass>, $($rest)* }
    };

    // The constraints.
    (@applied [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, applied -> $crate::SVector<$t, $n>, $($rest)* }
    };
    (@constraints [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn constraints(&$this, t: $t, q: &$crate::SVector<$t, $n>) -> $crate::kind::Multipliers<Self, $n, $t> {
            <$s as $crate::motion::Motion<$n, $t>>::constraints($to, t, q)
        }
    };
    (@constraint_gradients [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn constraint_gradients(
            &$this,
            t: $t,
            q: &$crate::SVector<$t, $n>,
        ) -> ($crate::kind::Gradients<Self, $n, $t>, $crate::kind::Multipliers<Self, $n, $t>) {
            <$s as $crate::motion::Motion<$n, $t>>::constraint_gradients($to, t, q)
        }
    };
    (@constraint_rate_derivatives [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::motion::Motion<$n, $t>, constraint_rate_derivatives -> ($crate::kind::Gradients<Self, $n, $t>, $crate::kind::Multipliers<Self, $n, $t>), $($rest)* }
    };
    (@reaction_derivatives [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn reaction_derivatives(
            &$this,
            t: $t,
            q: &$crate::SVector<$t, $n>,
            multipliers: &$crate::kind::Multipliers<Self, $n, $t>,
        ) -> $crate::kind::ReactionMatrix<Self, $n, $t> {
            <$s as $crate::motion::Motion<$n, $t>>::reaction_derivatives($to, t, q, multipliers)
        }
    };
    (@dropped_constraints [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) [$($at:tt)*]) => {
        $($at)*
        fn is_dropped(&$this, constraint: usize) -> bool {
            <$s as $crate::motion::Motion<$n, $t>>::is_dropped($to, constraint)
        }
        $($at)*
        fn broken(&$this, t: $t, q: &$crate::SVector<$t, $n>, v: &$crate::SVector<$t, $n>) -> Option<(usize, $t)> {
            <$s as $crate::motion::Motion<$n, $t>>::broken($to, t, q, v)
        }
    };

    // The slots of the discrete system, all nine.
    (@slots [$n:tt $t:tt $s:tt $r:ty] $this:tt $to:tt $at:tt) => {
        $crate::forward! { @interval [$n $t $s $r] ld -> $t, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] d1_ld -> $t, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] d2_ld -> $crate::SVector<$t, $n>, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] d3_ld -> $t, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] d4_ld -> $crate::SVector<$t, $n>, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] fd_minus -> $crate::SVector<$t, $n>, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] fd_plus -> $crate::SVector<$t, $n>, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] gd_minus -> $t, $this $to $at }
        $crate::forward! { @interval [$n $t $s $r] gd_plus -> $t, $this $to $at }
    };

    // The equations of a step, its length given.
    (@stepping_types [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        type Jacobian = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::Jacobian;
        type StepMatrix = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::StepMatrix;
        const CONSTANT_JACOBIAN: bool = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::CONSTANT_JACOBIAN;
        const CLOSED_FORM: bool = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::CLOSED_FORM;
        const INLINED: bool = <$s as $crate::stepping::FixedStepping<$n, $t, $r>>::INLINED;

        $crate::forward! { @stepping_facts [$n $t $s $r] $($rest)* }
    };
    (@stepping_facts [$n:tt $t:tt $s:tt $r:ty] ($this:ident) ($to:expr) $at:tt) => {
        $crate::forward! { @facts ($this) ($to) $crate::stepping::FixedStepping<$n, $t, $r>, $s,
            has_constant_jacobian -> bool, has_closed_form -> bool, is_inlined -> bool }
    };
    (@momentum_equation [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::FixedStepping<$n, $t, $r>, momentum_equation -> $crate::stepping::MomentumEquation<$n, $t, Self::Jacobian>, $($rest)* }
    };
    (@momentum_residual [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::FixedStepping<$n, $t, $r>, momentum_residual -> $crate::stepping::MomentumResidual<$n, $t>, $($rest)* }
    };
    (@momentum_derivatives [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::FixedStepping<$n, $t, $r>, momentum_derivatives -> $crate::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix>, $($rest)* }
    };
    (@momentum_rounding [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::FixedStepping<$n, $t, $r>, momentum_rounding -> $crate::SVector<$t, $n>, $($rest)* }
    };
    (@discrete_energy [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::FixedStepping<$n, $t, $r>, discrete_energy -> $t, $($rest)* }
    };

    // The equations of a step whose length is an unknown.
    (@step_density [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @state [$n $t $s $r] $crate::stepping::EnergyStepping<$n, $t, $r>, step_density -> Result<$t, $crate::StepError>, $($rest)* }
    };
    (@extended_system [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::EnergyStepping<$n, $t, $r>, extended_system -> $crate::stepping::ExtendedSystem<$n, $t, Self::Jacobian>, $($rest)* }
    };
    (@extended_residual [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::EnergyStepping<$n, $t, $r>, extended_residual -> $crate::stepping::ExtendedResidual<$n, $t>, $($rest)* }
    };
    (@extended_derivatives [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::EnergyStepping<$n, $t, $r>, extended_derivatives -> $crate::stepping::ExtendedDerivatives<$n, $t, Self::Jacobian, Self::StepMatrix>, $($rest)* }
    };
    (@extended_rounding [$n:tt $t:tt $s:tt $r:ty] $($rest:tt)*) => {
        $crate::forward! { @node [$n $t $s $r] $crate::stepping::EnergyStepping<$n, $t, $r>, extended_rounding -> $crate::stepping::Rounding<$n, $t>, $($rest)* }
    };
}
