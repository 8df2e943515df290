//! A system whose functions are instructions.

use crate::code::Code;
use crate::kinds::{Interpreted, matrix};
use crate::lines::{Lines, Results};
use core::array;
use vi_core::kind::{Free, Gradients, Multipliers, ReactionMatrix};
use vi_core::lagrangian::{Described, Flow, Parameters, Space, Undefined};
use vi_core::linear::{AnyForm, AnyMatrix, Block};
use vi_core::motion::{Motion, Point, PointDerivatives, ScaledPoint, Separable, Sides};
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::real::{Real, Rounded};
use vi_core::stepping::{
    Convertible, Discretized, EnergyStepping, ExtendedDerivatives, ExtendedResidual, ExtendedSystem, FixedStepping,
    Increment, MomentumDerivatives, MomentumEquation, MomentumResidual, Rounding,
};
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector, StepError, support};

/// A system of N coordinates over the numbers T, free or with constraints.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tape<const N: usize, K: Interpreted = Free, T: Real = f64> {
    code: &'static Code,
    parameters: K::Parameters<T>,
}

impl<const N: usize, K: Interpreted> Tape<N, K> {
    /// The system with its default parameters. Its code has the size N, and no more parameters than the capacity of a
    /// tape.
    pub(crate) fn new(code: &'static Code) -> Self {
        let mut parameters = K::parameters();
        parameters.as_mut().iter_mut().zip(&code.defaults).for_each(|(to, value)| *to = *value);
        Self { code, parameters }
    }
}

impl<const N: usize, K: Interpreted, T: Real> Tape<N, K, T> {
    #[inline(always)]
    fn over<U: Real>(&self) -> Tape<N, K, U> {
        let mut parameters = K::parameters::<U>();
        for (to, from) in parameters.as_mut().iter_mut().zip(&self.parameters.as_ref()[..self.code.defaults.len()]) {
            *to = U::real(from.to_f64());
        }
        Tape { code: self.code, parameters }
    }
}

impl<const N: usize, K: Interpreted, T: Real> Tape<N, K, T> {
    /// Evaluates a function of a state.
    #[inline(always)]
    fn at<Y>(
        &self,
        lines: &Lines,
        (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
        read: impl FnOnce(Results<'_, T>) -> Y,
    ) -> Y {
        lines.evaluated(self.code.instructions, &[&[t], q.as_slice(), v.as_slice(), self.parameters.as_ref()], read)
    }

    /// The momentum, the first result of a function. Coordinates at rest have the mass 1.
    #[inline(always)]
    fn momentum_of(&self, of: Results<'_, T>, v: &SVector<T, N>) -> SVector<T, N> {
        let mut momentum = of.vector(0);
        for k in self.code.coordinates.len()..N {
            momentum[k] = v[k];
        }
        momentum
    }

    /// Evaluates a function of a node, a step and a velocity.
    #[inline(always)]
    fn in_step<Y>(
        &self,
        lines: &Lines,
        (node, h, v): (&Node<N, T>, T, &SVector<T, N>),
        read: impl FnOnce(Results<'_, T>) -> Y,
    ) -> Y {
        let numbers = [node.t, node.t_low, node.energy, node.energy_low, h];
        let (q, q_low, p, p_low) = (node.q.as_slice(), node.q_low.as_slice(), node.p.as_slice(), node.p_low.as_slice());
        let arguments = [&numbers, q, v.as_slice(), self.parameters.as_ref(), q_low, p, p_low];
        lines.evaluated(self.code.instructions, &arguments, read)
    }

    /// Evaluates a function of an interval.
    #[inline(always)]
    fn between<Y>(&self, lines: &Lines, of: &Interval<N, T>, read: impl FnOnce(Results<'_, T>) -> Y) -> Y {
        let h = of.t1 - of.t0;
        let v: SVector<T, N> = SVector::from_fn(|i, _| (of.q1[i] - of.q0[i]) / h);
        let arguments =
            [&[of.t0, of.t1, h], of.q0.as_slice(), v.as_slice(), self.parameters.as_ref(), of.q1.as_slice()];
        lines.evaluated(self.code.instructions, &arguments, read)
    }
}

impl<const N: usize, K: Interpreted> Described for Tape<N, K> {
    const ABOUT: &'static str = "";
    const PARAMETERS_ABOUT: &'static [&'static str] = &[];
    const DEFINITION: &'static str = "";

    fn about(&self) -> &'static str {
        self.code.about
    }

    fn parameters_about(&self) -> &'static [&'static str] {
        self.code.parameters_about
    }

    fn definition(&self) -> &'static str {
        self.code.definition
    }

    fn has_too_large_rule(&self) -> bool {
        self.code.by_rule().is_too_large
    }
}

impl<const N: usize, K: Interpreted, T: Real> Parameters<T> for Tape<N, K, T> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        let index = self.code.parameters.iter().position(|known| *known == name)?;
        self.parameters.as_mut().get_mut(index)
    }
}

macro_rules! of_state {
    ($($name:ident $read:ident -> $out:ty),*) => {$(
        #[inline]
        fn $name(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> $out {
            let lines = &self.code.functions.$name;
            self.at(lines, (t, q, v), |r| r.$read(0))
        }
    )*};
}

impl<const N: usize, K: Interpreted, T: Real> Lagrangian<N, T> for Tape<N, K, T> {
    // The facts are those of the code: functions return them.
    const NAME: &'static str = "";
    const COORDINATES: [&'static str; N] = [""; N];
    const AUTONOMOUS: bool = false;
    const FORCED: bool = true;
    const CYCLIC: [bool; N] = [false; N];
    const SPACES: [Space; N] = [Space::Circle; N];
    const INTERPRETED: bool = true;

    fn name(&self) -> &'static str {
        self.code.name
    }

    fn coordinates(&self) -> [&'static str; N] {
        array::from_fn(|i| self.code.coordinates.get(i).copied().unwrap_or_default())
    }

    fn is_autonomous(&self) -> bool {
        self.code.is_autonomous
    }

    fn is_forced(&self) -> bool {
        self.code.is_forced
    }

    fn cyclic(&self) -> [bool; N] {
        array::from_fn(|i| self.code.cyclic.get(i).copied().unwrap_or(true))
    }

    #[inline]
    fn spaces(&self) -> [Space; N] {
        array::from_fn(|i| self.code.spaces.get(i).copied().unwrap_or(Space::Line))
    }

    fn parameters(&self) -> &'static [&'static str] {
        self.code.parameters
    }

    fn tables(&self) -> u32 {
        self.code.digest_of_tables
    }

    fn monotone_table(&self) -> Option<&'static str> {
        self.code.monotone_table
    }

    fn inputs(&self) -> &'static [usize] {
        self.code.inputs
    }

    fn parameter(&self, index: usize) -> T {
        self.parameters.as_ref()[index]
    }

    of_state!(lagrangian number -> T, energy number -> T, force vector -> SVector<T, N>);

    #[inline]
    fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.at(&self.code.functions.momentum, (t, q, v), |r| self.momentum_of(r, v))
    }

    #[inline]
    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        if const { K::COUNT > 0 } {
            return support::constrained_acceleration(self, t, q, v);
        }
        let lines = &self.code.functions.acceleration;
        if self.is_first_order() {
            let (structure, applied) = self.at(lines, (t, q, v), |r| {
                let at_rest = |k: usize| if k < self.code.coordinates.len() { T::zero() } else { T::one() };
                let mut structure = SMatrix::from_diagonal(&SVector::from_fn(|k, _| at_rest(k)));
                r.each(0, |row, column, value| structure[(row, column)] = value);
                (structure, r.vector(1))
            });
            return support::acceleration(t, &structure, &applied);
        }
        let (mass, applied) = self.at(lines, (t, q, v), |r| (K::mass(self.code, r, 0), r.vector(1)));
        support::acceleration(t, &mass, &applied)
    }

    #[inline]
    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        if const { K::COUNT > 0 } {
            return support::constrained_flow(self, t, q, p);
        }
        if self.is_first_order() {
            return support::first_order_flow(self, t, q);
        }
        let velocity = if self.code.is_quadratic {
            let at_rest = self.point(t, q, &SVector::zeros());
            support::velocity_by_mass(t, &at_rest.mass, &(p - at_rest.momentum))?
        } else {
            let mass = |v: &SVector<T, N>| self.point(t, q, v).mass;
            support::velocity(self, &self.over::<Rounded>(), mass, (t, q, p))?
        };
        let force = self.sides(t, q, &velocity).force;
        Ok(Flow { v: velocity, force, power: self.power(t, q, &velocity) })
    }

    #[cold]
    fn undefined(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<Undefined> {
        let mut arguments = vec![T::zero(); self.code.calls.iter().map(|call| call.arguments).sum()];
        let lines = &self.code.functions.undefined;
        self.at(lines, (t, q, v), |r| r.each(0, |_, place, value| arguments[place] = value));
        let mut arguments = &*arguments;
        self.code.calls.iter().find_map(|call| {
            let (own, rest) = arguments.split_at(call.arguments);
            arguments = rest;
            call.table.undefined(call.text, [own[0], own[own.len() - 1]])
        })
    }

    #[cold]
    fn non_finite(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<&'static str> {
        let mut first = None;
        let lines = &self.code.functions.non_finite;
        self.at(lines, (t, q, v), |r| {
            r.each(0, |_, watched, value| {
                if first.is_none() && !value.is_finite() {
                    first = self.code.watched.get(watched).copied();
                }
            });
        });
        first
    }
}

impl<const N: usize, K: Interpreted, T: Real> Motion<N, T> for Tape<N, K, T> {
    type Kind = K;
    type Mass = K::Matrix<N, T>;
    type PointMatrix = K::Matrix<N, T>;
    const CONSTANT_MASS: bool = false;

    fn has_constant_mass(&self) -> bool {
        self.code.has_constant_mass
    }

    fn is_curvilinear(&self) -> bool {
        self.code.is_curvilinear
    }

    fn is_separable(&self) -> bool {
        self.code.is_separable
    }

    fn splits(&self) -> bool {
        self.code.splits
    }

    fn scales_time(&self) -> bool {
        self.code.scales_time
    }

    fn has_point_masses(&self) -> bool {
        self.code.constraints.is_some_and(|of| of.has_point_masses)
    }

    fn without_velocity(&self) -> &'static [bool] {
        self.code.without_velocity
    }

    fn moving(&self) -> usize {
        self.code.coordinates.len()
    }

    fn constraint_names(&self) -> &'static [&'static str] {
        self.code.constraints.map_or(&[], |of| of.names)
    }

    fn holonomic(&self) -> usize {
        self.code.constraints.map_or(0, |of| of.holonomic)
    }

    fn blocks(&self) -> &'static [Block] {
        self.code.constraints.map_or(&[], |of| of.blocks)
    }

    #[inline(always)]
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass> {
        let lines = &self.code.functions.point;
        self.at(lines, (t, q, v), |r| Point {
            momentum: self.momentum_of(r, v),
            force: r.vector(1),
            mass: K::mass(self.code, r, 2),
        })
    }

    #[inline(always)]
    fn sides(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Sides<N, T> {
        let lines = &self.code.functions.sides;
        self.at(lines, (t, q, v), |r| Sides { momentum: self.momentum_of(r, v), force: r.vector(1) })
    }

    #[inline(always)]
    fn sides_and_inverse(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        inverse: &mut SMatrix<T, N, N>,
    ) -> Sides<N, T> {
        let lines = &self.code.functions.point;
        self.at(lines, (t, q, v), |r| {
            K::set_inverse_mass(self.code, r, 2, inverse);
            Sides { momentum: self.momentum_of(r, v), force: r.vector(1) }
        })
    }

    #[inline(always)]
    fn applied_force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        let lines = &self.code.functions.applied_force;
        self.at(lines, (t, q, v), |r| r.vector(0))
    }

    #[inline(always)]
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix> {
        let lines = &self.code.functions.point_derivatives;
        self.at(lines, (t, q, v), |r| PointDerivatives {
            momentum_dq: K::point_matrix(self.code, r, (0, 0.0)),
            mass: K::point_matrix(self.code, r, (1, 1.0)),
            force_dq: K::point_matrix(self.code, r, (2, 0.0)),
            force_dv: K::point_matrix(self.code, r, (3, 0.0)),
        })
    }

    of_state!(power number -> T);

    fn scaled_point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ScaledPoint<N, T, Self::Mass> {
        let lines = &self.code.functions.scaled_point;
        self.at(lines, (t, q, v), |r| ScaledPoint {
            point: Point { momentum: self.momentum_of(r, v), force: r.vector(1), mass: K::mass(self.code, r, 2) },
            energy: r.number(3),
            power: r.number(4),
            g: r.number(5),
            g_dq: r.vector(6),
            g_dt: r.number(7),
        })
    }

    fn applied(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        let lines = &self.code.functions.applied;
        self.at(lines, (t, q, v), |r| r.vector(0))
    }

    fn constraints(&self, t: T, q: &SVector<T, N>) -> Multipliers<Self, N, T> {
        let lines = &self.code.functions.constraints;
        self.at(lines, (t, q, &SVector::zeros()), |r| K::multipliers(self.code, r, 0))
    }

    fn constraint_gradients(&self, t: T, q: &SVector<T, N>) -> (Gradients<Self, N, T>, Multipliers<Self, N, T>) {
        let columns = self.code.constraints.map_or(&[][..], |of| of.gradients);
        let lines = &self.code.functions.constraint_gradients;
        self.at(lines, (t, q, &SVector::zeros()), |r| (K::gradients(columns, r, 0), K::multipliers(self.code, r, 1)))
    }

    fn constraint_rate_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
    ) -> (Gradients<Self, N, T>, Multipliers<Self, N, T>) {
        let columns = self.code.constraints.map_or(&[][..], |of| of.rate_derivatives);
        let lines = &self.code.functions.constraint_rate_derivatives;
        self.at(lines, (t, q, v), |r| (K::gradients(columns, r, 0), K::multipliers(self.code, r, 1)))
    }

    fn reaction_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        multipliers: &Multipliers<Self, N, T>,
    ) -> ReactionMatrix<Self, N, T> {
        let columns = self.code.constraints.map_or(&[][..], |of| of.reaction_derivatives);
        let lines = &self.code.functions.reaction_derivatives;
        let arguments = [&[t], q.as_slice(), &[], self.parameters.as_ref(), multipliers.as_ref()];
        lines.evaluated(self.code.instructions, &arguments, |r| K::reaction(columns, r, 0))
    }
}

impl<const N: usize, T: Real> Separable<N, T> for Tape<N, Free, T> {}

impl<const N: usize, K: Interpreted> Convertible<N> for Tape<N, K> {
    type In<T: Real> = Tape<N, K, T>;

    #[inline(always)]
    fn convert<T: Real>(&self) -> Tape<N, K, T> {
        self.over()
    }
}

impl<const N: usize> Discretized<N> for Tape<N> {
    type Steps<T: Real> = Tape<N, Free, T>;

    #[inline(always)]
    fn steps<T: Real>(&self) -> Tape<N, Free, T> {
        self.over()
    }
}

macro_rules! of_interval {
    ($($name:ident $read:ident -> $out:ty),*) => {$(
        #[inline]
        fn $name(&self, interval: &Interval<N, T>) -> $out {
            let lines = &self.code.by_rule().functions.$name;
            self.between(lines, interval, |r| r.$read(0))
        }
    )*};
}

impl<const N: usize, T: Real> DiscreteLagrangian<N, T> for Tape<N, Free, T> {
    of_interval!(
        ld number -> T, d1_ld number -> T, d2_ld vector -> SVector<T, N>, d3_ld number -> T,
        d4_ld vector -> SVector<T, N>, fd_minus vector -> SVector<T, N>, fd_plus vector -> SVector<T, N>,
        gd_minus number -> T, gd_plus number -> T
    );
}

impl<const N: usize, T: Real> FixedStepping<N, T> for Tape<N, Free, T> {
    type Jacobian = AnyMatrix<N, T>;
    type StepMatrix = AnyMatrix<N, T>;
    const CONSTANT_JACOBIAN: bool = false;

    fn has_constant_jacobian(&self) -> bool {
        self.code.by_rule().has_constant_jacobian
    }

    fn has_closed_form(&self) -> bool {
        self.code.by_rule().has_closed_form
    }

    fn is_inlined(&self) -> bool {
        self.code.by_rule().is_inlined
    }

    #[inline(always)]
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, AnyMatrix<N, T>> {
        let lines = &self.code.by_rule().functions.momentum_equation;
        self.in_step(lines, (node, h, v), |r| MomentumEquation {
            residual: r.vector(0),
            jacobian: jacobian(self.code, r, 1),
        })
    }

    #[inline(always)]
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
        let lines = &self.code.by_rule().functions.momentum_residual;
        self.in_step(lines, (node, h, v), |r| MomentumResidual {
            residual: r.vector(0),
            scale: r.vector(1),
            increment: r.vector(2),
        })
    }

    #[inline(always)]
    fn momentum_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumDerivatives<AnyMatrix<N, T>, AnyMatrix<N, T>> {
        let lines = &self.code.by_rule().functions.momentum_derivatives;
        self.in_step(lines, (node, h, v), |r| derivatives(self.code, r))
    }

    #[cold]
    fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N> {
        support::momentum_rounding(&self.over::<Rounded>(), node, h, v)
    }

    #[inline(always)]
    fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T {
        let lines = &self.code.by_rule().functions.discrete_energy;
        self.in_step(lines, (node, h, v), |r| r.number(0))
    }
}

/// The derivative of the momentum equation with respect to the velocities.
#[inline(always)]
fn jacobian<const N: usize, T: Real>(code: &Code, r: Results<'_, T>, quantity: usize) -> AnyMatrix<N, T> {
    matrix(code, code.by_rule().jacobian, r, (quantity, 1.0))
}

#[inline(always)]
fn derivatives<const N: usize, T: Real>(
    code: &Code,
    r: Results<'_, T>,
) -> MomentumDerivatives<AnyMatrix<N, T>, AnyMatrix<N, T>> {
    let dense = |quantity| matrix(code, AnyForm::Dense, r, (quantity, 0.0));
    MomentumDerivatives {
        residual_dv: jacobian(code, r, 0),
        residual_dq: dense(1),
        increment_dq: dense(2),
        increment_dv: dense(3),
    }
}

impl<const N: usize, T: Real> EnergyStepping<N, T> for Tape<N, Free, T> {
    #[inline]
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError> {
        let a = self.acceleration(t, q, v)?;
        let lines = &self.code.by_rule().functions.step_density;
        let arguments = &[&[t], q.as_slice(), v.as_slice(), self.parameters.as_ref(), a.as_slice()];
        lines.evaluated(self.code.instructions, arguments, |r| support::step_density(t, r.number(0)))
    }

    #[inline(always)]
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, AnyMatrix<N, T>> {
        let lines = &self.code.by_rule().functions.extended_system;
        self.in_step(lines, (node, h, v), |r| ExtendedSystem {
            momentum: MomentumEquation { residual: r.vector(0), jacobian: jacobian(self.code, r, 1) },
            residual_dh: r.vector(2),
            energy_residual: r.number(3),
            energy_dv: r.vector(4),
            energy_dh: r.number(5),
        })
    }

    #[inline(always)]
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
        let lines = &self.code.by_rule().functions.extended_residual;
        self.in_step(lines, (node, h, v), |r| ExtendedResidual {
            residual: r.vector(0),
            scale: r.vector(1),
            energy_residual: r.number(2),
            energy_scale: r.number(3),
            increment: Increment { momentum: r.vector(4), energy: r.number(5) },
        })
    }

    #[inline(always)]
    fn extended_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> ExtendedDerivatives<N, T, AnyMatrix<N, T>, AnyMatrix<N, T>> {
        let lines = &self.code.by_rule().functions.extended_derivatives;
        self.in_step(lines, (node, h, v), |r| ExtendedDerivatives {
            momentum: derivatives(self.code, r),
            residual_dh: r.vector(4),
            energy_dq: r.vector(5),
            energy_dv: r.vector(6),
            energy_dh: r.number(7),
            increment_dh: r.vector(8),
            energy_increment_dq: r.vector(9),
            energy_increment_dv: r.vector(10),
            energy_increment_dh: r.number(11),
        })
    }

    #[cold]
    fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
        support::extended_rounding(&self.over::<Rounded>(), node, h, v)
    }
}
