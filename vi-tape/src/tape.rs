//! A system whose functions are instructions.

use crate::code::{Code, Form};
use crate::lines::Lines;
use crate::matrix::AnyMatrix;
use core::array;
use vi_core::kind::Free;
use vi_core::lagrangian::{Described, Flow, Parameters};
use vi_core::motion::{Motion, Point, PointDerivatives, ScaledPoint, Separable, Sides};
use vi_core::node::Node;
use vi_core::real::{Real, Rounded};
use vi_core::stepping::{
    Convertible, Discretized, EnergyStepping, ExtendedDerivatives, ExtendedResidual, ExtendedSystem, FixedStepping,
    Increment, MomentumDerivatives, MomentumEquation, MomentumResidual, Rounding,
};
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector, StepError, support};

/// The number of parameters that a tape has room for.
pub(crate) const PARAMETERS: usize = 32;

/// A system of N coordinates over the numbers T.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tape<const N: usize, T = f64> {
    code: &'static Code,
    parameters: [T; PARAMETERS],
}

impl<const N: usize> Tape<N> {
    /// The system with its default parameters. Its code has N coordinates, and at most as many parameters as a tape has room for.
    pub(crate) fn new(code: &'static Code) -> Self {
        let mut parameters = [0.0; PARAMETERS];
        parameters.iter_mut().zip(&code.defaults).for_each(|(to, value)| *to = *value);
        Self { code, parameters }
    }
}

impl<const N: usize, T: Real> Tape<N, T> {
    #[inline(always)]
    fn over<U: Real>(&self) -> Tape<N, U> {
        let mut parameters = [U::zero(); PARAMETERS];
        for (to, from) in parameters.iter_mut().zip(&self.parameters[..self.code.defaults.len()]) {
            *to = U::real(from.to_f64());
        }
        Tape { code: self.code, parameters }
    }
}

impl<const N: usize, T: Real> Tape<N, T> {
    /// Evaluates a function of a state.
    #[inline(always)]
    fn at<Y>(&self, lines: &Lines, (t, q, v): (T, &SVector<T, N>, &SVector<T, N>), read: impl FnOnce(&[T]) -> Y) -> Y {
        lines.evaluated(self.code.instructions, &[&[t], q.as_slice(), v.as_slice(), &self.parameters], read)
    }

    /// Evaluates a function of a node, a step and a velocity.
    #[inline(always)]
    fn in_step<Y>(
        &self,
        lines: &Lines,
        (node, h, v): (&Node<N, T>, T, &SVector<T, N>),
        read: impl FnOnce(&[T]) -> Y,
    ) -> Y {
        let numbers = [node.t, node.t_low, node.energy, node.energy_low, h];
        let (q, q_low, p, p_low) = (node.q.as_slice(), node.q_low.as_slice(), node.p.as_slice(), node.p_low.as_slice());
        let arguments = [&numbers, q, v.as_slice(), &self.parameters, q_low, p, p_low];
        lines.evaluated(self.code.instructions, &arguments, read)
    }

    /// Evaluates a function of an interval.
    #[inline(always)]
    fn between<Y>(&self, lines: &Lines, of: &Interval<N, T>, read: impl FnOnce(&[T]) -> Y) -> Y {
        let h = of.t1 - of.t0;
        let v: SVector<T, N> = SVector::from_fn(|i, _| (of.q1[i] - of.q0[i]) / h);
        let arguments = [&[of.t0, of.t1, h], of.q0.as_slice(), v.as_slice(), &self.parameters, of.q1.as_slice()];
        lines.evaluated(self.code.instructions, &arguments, read)
    }
}

#[inline(always)]
fn vector<const N: usize, T: Real>(lines: &Lines, quantity: usize, registers: &[T]) -> SVector<T, N> {
    let mut vector = SVector::zeros();
    for entry in lines.entries(quantity) {
        vector[entry.column as usize] = entry.value(registers);
    }
    vector
}

#[inline(always)]
fn matrix<const N: usize, T: Real>(form: Form, lines: &Lines, quantity: usize, registers: &[T]) -> AnyMatrix<N, T> {
    let mut matrix = AnyMatrix::zeros(form);
    for entry in lines.entries(quantity) {
        matrix.put(entry.row as usize, entry.column as usize, entry.value(registers));
    }
    matrix
}

impl<const N: usize> Described for Tape<N> {
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
}

impl<const N: usize, T: Real> Parameters<T> for Tape<N, T> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        let index = self.code.parameters.iter().position(|known| *known == name)?;
        self.parameters.get_mut(index)
    }
}

macro_rules! of_state {
    ($($name:ident $read:ident -> $out:ty),*) => {$(
        #[inline]
        fn $name(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> $out {
            let lines = &self.code.functions.$name;
            self.at(lines, (t, q, v), |r| read::$read(lines, 0, r))
        }
    )*};
}

mod read {
    pub(super) use super::vector;
    use super::{Lines, Real};

    #[inline(always)]
    pub(super) fn number<T: Real>(lines: &Lines, quantity: usize, registers: &[T]) -> T {
        lines.number(quantity, registers)
    }
}

impl<const N: usize, T: Real> Lagrangian<N, T> for Tape<N, T> {
    // The facts are those of the code: functions return them.
    const NAME: &'static str = "";
    const COORDINATES: [&'static str; N] = [""; N];
    const AUTONOMOUS: bool = false;
    const FORCED: bool = true;
    const CYCLIC: [bool; N] = [false; N];
    const ANGLES: [bool; N] = [true; N];
    const INTERPRETED: bool = true;

    fn name(&self) -> &'static str {
        self.code.name
    }

    fn coordinates(&self) -> [&'static str; N] {
        array::from_fn(|i| self.code.coordinates[i])
    }

    fn is_autonomous(&self) -> bool {
        self.code.is_autonomous
    }

    fn is_forced(&self) -> bool {
        self.code.is_forced
    }

    fn cyclic(&self) -> [bool; N] {
        array::from_fn(|i| self.code.cyclic[i])
    }

    #[inline]
    fn angles(&self) -> [bool; N] {
        array::from_fn(|i| self.code.angles[i])
    }

    fn parameters(&self) -> &'static [&'static str] {
        self.code.parameters
    }

    fn inputs(&self) -> &'static [usize] {
        self.code.inputs
    }

    fn parameter(&self, index: usize) -> T {
        self.parameters[index]
    }

    of_state!(lagrangian number -> T, energy number -> T, momentum vector -> SVector<T, N>, force vector -> SVector<T, N>);

    #[inline]
    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        let lines = &self.code.functions.acceleration;
        let (mass, applied) =
            self.at(lines, (t, q, v), |r| (matrix::<N, T>(self.code.mass, lines, 0, r), vector(lines, 1, r)));
        support::acceleration(t, &mass, &applied)
    }

    #[inline]
    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
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
    fn non_finite(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<&'static str> {
        let mut first = None;
        let lines = &self.code.functions.non_finite;
        self.at(lines, (t, q, v), |r| {
            for entry in lines.entries(0) {
                if first.is_none() && !entry.value(r).is_finite() {
                    first = self.code.watched.get(entry.column as usize).copied();
                }
            }
        });
        first
    }
}

impl<const N: usize, T: Real> Motion<N, T> for Tape<N, T> {
    type Kind = Free;
    type Mass = AnyMatrix<N, T>;
    type PointMatrix = AnyMatrix<N, T>;
    const CONSTANT_MASS: bool = false;

    fn has_constant_mass(&self) -> bool {
        self.code.has_constant_mass
    }

    fn is_separable(&self) -> bool {
        self.code.is_separable
    }

    fn scales_time(&self) -> bool {
        self.code.scales_time
    }

    #[inline(always)]
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, AnyMatrix<N, T>> {
        let lines = &self.code.functions.point;
        self.at(lines, (t, q, v), |r| Point {
            momentum: vector(lines, 0, r),
            force: vector(lines, 1, r),
            mass: matrix(self.code.mass, lines, 2, r),
        })
    }

    #[inline(always)]
    fn sides(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Sides<N, T> {
        let lines = &self.code.functions.sides;
        self.at(lines, (t, q, v), |r| Sides { momentum: vector(lines, 0, r), force: vector(lines, 1, r) })
    }

    #[inline(always)]
    fn applied_force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        let lines = &self.code.functions.applied_force;
        self.at(lines, (t, q, v), |r| vector(lines, 0, r))
    }

    #[inline(always)]
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<AnyMatrix<N, T>> {
        let form = self.code.point_matrix;
        let lines = &self.code.functions.point_derivatives;
        self.at(lines, (t, q, v), |r| PointDerivatives {
            momentum_dq: matrix(form, lines, 0, r),
            mass: matrix(form, lines, 1, r),
            force_dq: matrix(form, lines, 2, r),
            force_dv: matrix(form, lines, 3, r),
        })
    }

    of_state!(power number -> T);

    fn scaled_point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ScaledPoint<N, T, AnyMatrix<N, T>> {
        let lines = &self.code.functions.scaled_point;
        self.at(lines, (t, q, v), |r| ScaledPoint {
            point: Point {
                momentum: vector(lines, 0, r),
                force: vector(lines, 1, r),
                mass: matrix(self.code.mass, lines, 2, r),
            },
            energy: lines.number(3, r),
            power: lines.number(4, r),
            g: lines.number(5, r),
            g_dq: vector(lines, 6, r),
            g_dt: lines.number(7, r),
        })
    }
}

impl<const N: usize, T: Real> Separable<N, T> for Tape<N, T> {}

impl<const N: usize> Convertible<N> for Tape<N> {
    type In<T: Real> = Tape<N, T>;

    #[inline(always)]
    fn convert<T: Real>(&self) -> Tape<N, T> {
        self.over()
    }
}

impl<const N: usize> Discretized<N> for Tape<N> {
    type Steps<T: Real> = Tape<N, T>;

    #[inline(always)]
    fn steps<T: Real>(&self) -> Tape<N, T> {
        self.over()
    }
}

macro_rules! of_interval {
    ($($name:ident $read:ident -> $out:ty),*) => {$(
        #[inline]
        fn $name(&self, interval: &Interval<N, T>) -> $out {
            let lines = &self.code.functions.$name;
            self.between(lines, interval, |r| read::$read(lines, 0, r))
        }
    )*};
}

impl<const N: usize, T: Real> DiscreteLagrangian<N, T> for Tape<N, T> {
    of_interval!(
        ld number -> T, d1_ld number -> T, d2_ld vector -> SVector<T, N>, d3_ld number -> T,
        d4_ld vector -> SVector<T, N>, fd_minus vector -> SVector<T, N>, fd_plus vector -> SVector<T, N>,
        gd_minus number -> T, gd_plus number -> T
    );
}

impl<const N: usize, T: Real> FixedStepping<N, T> for Tape<N, T> {
    type Jacobian = AnyMatrix<N, T>;
    type StepMatrix = AnyMatrix<N, T>;
    const CONSTANT_JACOBIAN: bool = false;

    fn has_constant_jacobian(&self) -> bool {
        self.code.has_constant_jacobian
    }

    fn has_closed_form(&self) -> bool {
        self.code.has_closed_form
    }

    fn is_inlined(&self) -> bool {
        self.code.is_inlined
    }

    #[inline(always)]
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, AnyMatrix<N, T>> {
        let lines = &self.code.functions.momentum_equation;
        self.in_step(lines, (node, h, v), |r| MomentumEquation {
            residual: vector(lines, 0, r),
            jacobian: matrix(self.code.jacobian, lines, 1, r),
        })
    }

    #[inline(always)]
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
        let lines = &self.code.functions.momentum_residual;
        self.in_step(lines, (node, h, v), |r| MomentumResidual {
            residual: vector(lines, 0, r),
            scale: vector(lines, 1, r),
            increment: vector(lines, 2, r),
        })
    }

    #[inline(always)]
    fn momentum_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumDerivatives<AnyMatrix<N, T>, AnyMatrix<N, T>> {
        let lines = &self.code.functions.momentum_derivatives;
        self.in_step(lines, (node, h, v), |r| derivatives(self.code, lines, r))
    }

    #[cold]
    fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N> {
        support::momentum_rounding(&self.over::<Rounded>(), node, h, v)
    }

    #[inline(always)]
    fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T {
        let lines = &self.code.functions.discrete_energy;
        self.in_step(lines, (node, h, v), |r| lines.number(0, r))
    }
}

#[inline(always)]
fn derivatives<const N: usize, T: Real>(
    code: &Code,
    lines: &Lines,
    registers: &[T],
) -> MomentumDerivatives<AnyMatrix<N, T>, AnyMatrix<N, T>> {
    MomentumDerivatives {
        residual_dv: matrix(code.jacobian, lines, 0, registers),
        residual_dq: matrix(Form::Dense, lines, 1, registers),
        increment_dq: matrix(Form::Dense, lines, 2, registers),
        increment_dv: matrix(Form::Dense, lines, 3, registers),
    }
}

impl<const N: usize, T: Real> EnergyStepping<N, T> for Tape<N, T> {
    #[inline]
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError> {
        let a = self.acceleration(t, q, v)?;
        let lines = &self.code.functions.step_density;
        let arguments = &[&[t], q.as_slice(), v.as_slice(), &self.parameters, a.as_slice()];
        lines.evaluated(self.code.instructions, arguments, |r| support::step_density(t, lines.number(0, r)))
    }

    #[inline(always)]
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, AnyMatrix<N, T>> {
        let lines = &self.code.functions.extended_system;
        self.in_step(lines, (node, h, v), |r| ExtendedSystem {
            momentum: MomentumEquation {
                residual: vector(lines, 0, r),
                jacobian: matrix(self.code.jacobian, lines, 1, r),
            },
            residual_dh: vector(lines, 2, r),
            energy_residual: lines.number(3, r),
            energy_dv: vector(lines, 4, r),
            energy_dh: lines.number(5, r),
        })
    }

    #[inline(always)]
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
        let lines = &self.code.functions.extended_residual;
        self.in_step(lines, (node, h, v), |r| ExtendedResidual {
            residual: vector(lines, 0, r),
            scale: vector(lines, 1, r),
            energy_residual: lines.number(2, r),
            energy_scale: lines.number(3, r),
            increment: Increment { momentum: vector(lines, 4, r), energy: lines.number(5, r) },
        })
    }

    #[inline(always)]
    fn extended_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> ExtendedDerivatives<N, T, AnyMatrix<N, T>, AnyMatrix<N, T>> {
        let lines = &self.code.functions.extended_derivatives;
        self.in_step(lines, (node, h, v), |r| ExtendedDerivatives {
            momentum: derivatives(self.code, lines, r),
            residual_dh: vector(lines, 4, r),
            energy_dq: vector(lines, 5, r),
            energy_dv: vector(lines, 6, r),
            energy_dh: lines.number(7, r),
            increment_dh: vector(lines, 8, r),
            energy_increment_dq: vector(lines, 9, r),
            energy_increment_dv: vector(lines, 10, r),
            energy_increment_dh: lines.number(11, r),
        })
    }

    #[cold]
    fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
        support::extended_rounding(&self.over::<Rounded>(), node, h, v)
    }
}
