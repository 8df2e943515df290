//! Systems with constraints, from a Lagrangian and constraints alone: dual numbers differentiate them, so that nothing
//! here depends on the generator.

#![allow(clippy::needless_range_loop)] // one index addresses several arrays

use vi_core::kind::Bound;
use vi_core::lagrangian::{Flow, Parameters};
use vi_core::motion::{Motion, Point, PointDerivatives};
use vi_core::nalgebra::SMatrix;
use vi_core::real::{Dual, Real};
use vi_core::stepping::Convertible;
use vi_core::{Lagrangian, SVector, StepError, support};

/// A system of N coordinates with K constraints.
pub(crate) trait Model<const N: usize, const K: usize>: Copy + Send + Sync {
    const NAME: &'static str;
    const COORDINATES: [&'static str; N];
    const CONSTRAINTS: &'static [&'static str];
    const HOLONOMIC: usize = K;
    const AUTONOMOUS: bool = true;
    const CONSTANT_MASS: bool = true;
    fn lagrangian<T: Real>(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    fn force<T: Real>(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> SVector<T, N> {
        SVector::zeros()
    }
    /// g of the holonomic constraints, then A v + a of the others.
    fn constraints<T: Real>(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> [T; K];
}

/// The system of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Auto<M, const K: usize>(pub(crate) M);

type Duals<T, const N: usize> = SVector<Dual<T>, N>;

/// `f` differentiated along one direction of (t, q, v).
fn along<T: Real, const N: usize, R>(
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    [of_t, of_q, of_v]: [&SVector<T, N>; 3],
    f: impl Fn(Dual<T>, &SVector<Dual<T>, N>, &SVector<Dual<T>, N>) -> R,
) -> R {
    let dual = |value: T, slope: T| Dual { value, slope };
    // The slope of the time is the first entry of its direction.
    f(dual(t, of_t[0]), &q.zip_map(of_q, dual), &v.zip_map(of_v, dual))
}

fn unit<T: Real, const N: usize>(k: usize) -> SVector<T, N> {
    SVector::from_fn(|i, _| if i == k { T::one() } else { T::zero() })
}

impl<M, const K: usize> Auto<M, K> {
    fn momentum_of<T: Real, const N: usize>(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>
    where
        M: Model<N, K>,
    {
        let none = SVector::zeros();
        SVector::from_fn(|k, _| along((t, q, v), [&none, &none, &unit(k)], |t, q, v| self.0.lagrangian(t, q, v).slope))
    }

    fn force_of<T: Real, const N: usize>(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>
    where
        M: Model<N, K>,
    {
        let none = SVector::zeros();
        let gradient = SVector::<T, N>::from_fn(|k, _| {
            along((t, q, v), [&none, &unit(k), &none], |t, q, v| self.0.lagrangian(t, q, v).slope)
        });
        gradient + self.0.force(t, q, v)
    }

    /// A v + a of all constraints.
    fn rates<T: Real, const N: usize>(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> [T; K]
    where
        M: Model<N, K>,
    {
        let along_motion = along((t, q, v), [&unit(0), v, &SVector::zeros()], |t, q, v| self.0.constraints(t, q, v));
        let values = self.0.constraints(t, q, v);
        core::array::from_fn(|r| if r < M::HOLONOMIC { along_motion[r].slope } else { values[r] })
    }

    fn gradients_of<T: Real, const N: usize>(&self, t: T, q: &SVector<T, N>) -> [SVector<T, N>; K]
    where
        M: Model<N, K>,
    {
        let none = SVector::zeros();
        let mut rows = [SVector::zeros(); K];
        for k in 0..N {
            let of_q = along((t, q, &none), [&none, &unit(k), &none], |t, q, v| self.0.constraints(t, q, v));
            let of_v = along((t, q, &none), [&none, &none, &unit(k)], |t, q, v| self.0.constraints(t, q, v));
            for r in 0..K {
                rows[r][k] = if r < M::HOLONOMIC { of_q[r].slope } else { of_v[r].slope };
            }
        }
        rows
    }
}

impl<M: Model<N, K>, const N: usize, const K: usize, T: Real> Lagrangian<N, T> for Auto<M, K> {
    const NAME: &'static str = M::NAME;
    const COORDINATES: [&'static str; N] = M::COORDINATES;
    const AUTONOMOUS: bool = M::AUTONOMOUS;
    const FORCED: bool = true;
    const CYCLIC: [bool; N] = [false; N];

    fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        self.0.lagrangian(t, q, v)
    }
    fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        v.dot(&self.momentum_of(t, q, v)) - self.0.lagrangian(t, q, v)
    }
    fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.momentum_of(t, q, v)
    }
    fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.0.force(t, q, v)
    }
    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        support::constrained_acceleration(self, t, q, v)
    }
    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        support::constrained_flow(self, t, q, p)
    }
}

impl<M: Model<N, K>, const N: usize, const K: usize, T: Real> Motion<N, T> for Auto<M, K> {
    type Kind = Bound<K>;
    type Mass = SMatrix<T, N, N>;
    type PointMatrix = SMatrix<T, N, N>;
    const CONSTANT_MASS: bool = M::CONSTANT_MASS;
    const CONSTRAINTS: &'static [&'static str] = M::CONSTRAINTS;
    const HOLONOMIC: usize = M::HOLONOMIC;

    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass> {
        let (momentum, force) = (self.momentum_of(t, q, v), self.force_of(t, q, v));
        Point { momentum, force, mass: self.point_derivatives(t, q, v).mass }
    }
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix> {
        let none = SVector::zeros();
        #[allow(clippy::type_complexity)] // a function of (t, q, v)
        let columns = |of_q: bool, f: &dyn Fn(Dual<T>, &Duals<T, N>, &Duals<T, N>) -> Duals<T, N>| {
            let mut matrix = SMatrix::<T, N, N>::zeros();
            for k in 0..N {
                let direction = if of_q { [&none, &unit(k), &none] } else { [&none, &none, &unit(k)] };
                matrix.set_column(k, &along((t, q, v), direction, f).map(|entry| entry.slope));
            }
            matrix
        };
        PointDerivatives {
            momentum_dq: columns(true, &|t, q, v| self.momentum_of(t, q, v)),
            mass: columns(false, &|t, q, v| self.momentum_of(t, q, v)),
            force_dq: columns(true, &|t, q, v| self.force_of(t, q, v)),
            force_dv: columns(false, &|t, q, v| self.force_of(t, q, v)),
        }
    }
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        let none = SVector::zeros();
        let of_time = along((t, q, v), [&unit(0), &none, &none], |t, q, v| self.0.lagrangian(t, q, v).slope);
        v.dot(&self.0.force(t, q, v)) - of_time
    }
    fn applied(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        let along_motion = along((t, q, v), [&unit(0), v, &SVector::zeros()], |t, q, v| self.momentum_of(t, q, v));
        self.force_of(t, q, v) - along_motion.map(|entry| entry.slope)
    }
    fn constraints(&self, t: T, q: &SVector<T, N>) -> [T; K] {
        let values = self.0.constraints(t, q, &SVector::zeros());
        core::array::from_fn(|r| if r < M::HOLONOMIC { values[r] } else { T::zero() })
    }
    fn constraint_gradients(&self, t: T, q: &SVector<T, N>) -> ([SVector<T, N>; K], [T; K]) {
        (self.gradients_of(t, q), self.rates(t, q, &SVector::zeros()))
    }
    fn constraint_rate_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ([SVector<T, N>; K], [T; K]) {
        let none = SVector::zeros();
        let mut rows = [SVector::zeros(); K];
        for k in 0..N {
            let rates = along((t, q, v), [&none, &unit(k), &none], |t, q, v| self.rates(t, q, v));
            for r in 0..K {
                rows[r][k] = rates[r].slope;
            }
        }
        let of_time = along((t, q, v), [&unit(0), &none, &none], |t, q, v| self.rates(t, q, v));
        (rows, of_time.map(|rate| rate.slope))
    }
    fn reaction_derivatives(&self, t: T, q: &SVector<T, N>, multipliers: &[T; K]) -> [SVector<T, N>; N] {
        let none = SVector::zeros();
        let mut matrix = [SVector::zeros(); N];
        for k in 0..N {
            let rows = along((t, q, &none), [&none, &unit(k), &none], |t, q, _| self.gradients_of(t, q));
            for (row, multiplier) in rows.iter().zip(multipliers) {
                for i in 0..N {
                    matrix[i][k] += row[i].slope * *multiplier;
                }
            }
        }
        matrix
    }
}

impl<M, const K: usize, T: Real> Parameters<T> for Auto<M, K> {
    fn parameter_mut(&mut self, _: &str) -> Option<&mut T> {
        None
    }
}

impl<M: Model<N, K>, const N: usize, const K: usize> Convertible<N> for Auto<M, K> {
    type In<T: Real> = Self;

    fn convert<T: Real>(&self) -> Self {
        *self
    }
}

/// The square of a number.
fn sq<T: Real>(x: T) -> T {
    x * x
}

/// A pendulum of mass 1 and this length; its weight is g.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pendulum {
    pub(crate) length: f64,
    pub(crate) g: f64,
}

pub(crate) const PENDULUM: Auto<Pendulum, 1> = Auto(Pendulum { length: 1.0, g: 9.81 });

impl Model<2, 1> for Pendulum {
    const NAME: &'static str = "Pendulum";
    const COORDINATES: [&'static str; 2] = ["x", "y"];
    const CONSTRAINTS: &'static [&'static str] = &["rod"];
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        (sq(v[0]) + sq(v[1])) * T::real(0.5) - T::real(self.g) * q[1]
    }
    fn constraints<T: Real>(&self, _: T, q: &SVector<T, 2>, _: &SVector<T, 2>) -> [T; 1] {
        [sq(q[0]) + sq(q[1]) - T::real(self.length) * T::real(self.length)]
    }
}

/// Two masses 2 and 1 on rods of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoublePendulum;

impl Model<4, 2> for DoublePendulum {
    const NAME: &'static str = "DoublePendulum";
    const COORDINATES: [&'static str; 4] = ["x1", "y1", "x2", "y2"];
    const CONSTRAINTS: &'static [&'static str] = &["rod[0]", "rod[1]"];
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 4>, v: &SVector<T, 4>) -> T {
        let kinetic = sq(v[0]) + sq(v[1]) + (sq(v[2]) + sq(v[3])) * T::real(0.5);
        kinetic - T::real(9.81) * (T::real(2.0) * q[1] + q[3])
    }
    fn constraints<T: Real>(&self, _: T, q: &SVector<T, 4>, _: &SVector<T, 4>) -> [T; 2] {
        [sq(q[0]) + sq(q[1]) - T::one(), sq(q[2] - q[0]) + sq(q[3] - q[1]) - T::one()]
    }
}

/// A heavy top with a unit quaternion, and the moment of inertia J of (R·Ṙ)².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeavyTop {
    pub(crate) j: f64,
}

impl Model<4, 1> for HeavyTop {
    const NAME: &'static str = "HeavyTop";
    const COORDINATES: [&'static str; 4] = ["a", "b", "c", "d"];
    const CONSTRAINTS: &'static [&'static str] = &["R"];
    const CONSTANT_MASS: bool = false;
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 4>, v: &SVector<T, 4>) -> T {
        let [a, b, c, d] = [q[0], q[1], q[2], q[3]];
        let [av, bv, cv, dv] = [v[0], v[1], v[2], v[3]];
        let two = T::real(2.0);
        let w0 = two * (a * av + b * bv + c * cv + d * dv);
        let w1 = two * (a * bv - b * av - c * dv + d * cv);
        let w2 = two * (a * cv - c * av - d * bv + b * dv);
        let w3 = two * (a * dv - d * av - b * cv + c * bv);
        let kinetic = T::real(self.j) * sq(w0) + sq(w1) + sq(w2) + sq(w3) * T::real(0.5);
        kinetic * T::real(0.5) - two * (sq(a) - sq(b) - sq(c) + sq(d))
    }
    fn constraints<T: Real>(&self, _: T, q: &SVector<T, 4>, _: &SVector<T, 4>) -> [T; 1] {
        [sq(q[0]) + sq(q[1]) + sq(q[2]) + sq(q[3]) - T::one()]
    }
}

/// A pendulum whose pivot moves by sin(6t)/10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Driven;

impl Model<2, 1> for Driven {
    const NAME: &'static str = "Driven";
    const COORDINATES: [&'static str; 2] = ["x", "y"];
    const CONSTRAINTS: &'static [&'static str] = &["rod"];
    const AUTONOMOUS: bool = false;
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        (sq(v[0]) + sq(v[1])) * T::real(0.5) - T::real(9.81) * q[1]
    }
    fn constraints<T: Real>(&self, t: T, q: &SVector<T, 2>, _: &SVector<T, 2>) -> [T; 1] {
        [sq(q[0]) + sq(q[1] - (T::real(6.0) * t).sin() / T::real(10.0)) - T::one()]
    }
}

/// Varying masses, time and forces on a curve that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct General;

impl Model<2, 1> for General {
    const NAME: &'static str = "General";
    const COORDINATES: [&'static str; 2] = ["x", "y"];
    const CONSTRAINTS: &'static [&'static str] = &["curve"];
    const AUTONOMOUS: bool = false;
    const CONSTANT_MASS: bool = false;
    fn lagrangian<T: Real>(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        let [x, y, vx, vy] = [q[0], q[1], v[0], v[1]];
        let n = T::real;
        (n(1.0) + sq(x) / n(2.0)) * sq(vx) / n(2.0)
            + (n(1.0) + sq(y) / n(3.0)) * sq(vy) / n(2.0)
            + x * vx * vy / n(4.0)
            + t.cos() * x * vy / n(3.0)
            - n(2.0) * y
            - x * y * t.sin() / n(2.0)
    }
    fn force<T: Real>(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> SVector<T, 2> {
        let n = T::real;
        SVector::from([-v[0] * sq(q[0]) / n(10.0), -v[1] / n(10.0) + (n(2.0) * t).cos() / n(5.0)])
    }
    fn constraints<T: Real>(&self, t: T, q: &SVector<T, 2>, _: &SVector<T, 2>) -> [T; 1] {
        [sq(q[0]) + sq(q[1]) + q[0] * q[1] * t.sin() / T::real(4.0) - T::one()]
    }
}

/// A sleigh on a knife edge; on a turntable if `turns`, with friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sleigh {
    pub(crate) turns: bool,
}

impl Model<3, 1> for Sleigh {
    const NAME: &'static str = "Sleigh";
    const COORDINATES: [&'static str; 3] = ["x", "y", "θ"];
    const CONSTRAINTS: &'static [&'static str] = &["blade"];
    const HOLONOMIC: usize = 0;
    const AUTONOMOUS: bool = false;
    const CONSTANT_MASS: bool = false;
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 3>, v: &SVector<T, 3>) -> T {
        let (sine, cosine) = q[2].sin_cos();
        let half = T::real(0.5);
        (sq(v[0] - sine * v[2] * half) + sq(v[1] + cosine * v[2] * half)) * half + sq(v[2]) * half
    }
    fn force<T: Real>(&self, _: T, _: &SVector<T, 3>, v: &SVector<T, 3>) -> SVector<T, 3> {
        let friction = if self.turns { T::real(10.0) } else { return SVector::zeros() };
        SVector::from([-v[0] / friction, -v[1] / friction, T::zero()])
    }
    fn constraints<T: Real>(&self, t: T, q: &SVector<T, 3>, v: &SVector<T, 3>) -> [T; 1] {
        let (sine, cosine) = q[2].sin_cos();
        let turn = if self.turns { t.sin() * T::real(0.5) } else { T::zero() };
        [-sine * (v[0] + turn * q[1]) + cosine * (v[1] - turn * q[0])]
    }
}

/// A rolling disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RollingDisk;

impl Model<5, 2> for RollingDisk {
    const NAME: &'static str = "RollingDisk";
    const COORDINATES: [&'static str; 5] = ["x", "y", "φ", "θ", "ψ"];
    const CONSTRAINTS: &'static [&'static str] = &["along", "across"];
    const HOLONOMIC: usize = 0;
    const CONSTANT_MASS: bool = false;
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 5>, v: &SVector<T, 5>) -> T {
        let ((sin_ph, cos_ph), (sin_th, cos_th)) = (q[2].sin_cos(), q[3].sin_cos());
        let [w, u, r] = [v[2], v[3], v[4]];
        let n = T::real;
        let x = v[0] + u * sin_th * sin_ph - w * cos_th * cos_ph;
        let y = v[1] - u * sin_th * cos_ph - w * cos_th * sin_ph;
        let z = u * cos_th;
        (sq(x) + sq(y) + sq(z)) / n(2.0) + (sq(u) + sq(w) * sq(sin_th)) / n(8.0) + sq(r + w * cos_th) / n(4.0)
            - n(9.81) * sin_th
    }
    fn constraints<T: Real>(&self, _: T, q: &SVector<T, 5>, v: &SVector<T, 5>) -> [T; 2] {
        let (sine, cosine) = q[2].sin_cos();
        [v[0] + cosine * v[4], v[1] + sine * v[4]]
    }
}

/// A pendulum in space whose bob slides without side slip: a holonomic and a nonholonomic constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mixed;

impl Model<4, 2> for Mixed {
    const NAME: &'static str = "Mixed";
    const COORDINATES: [&'static str; 4] = ["x", "y", "z", "θ"];
    const CONSTRAINTS: &'static [&'static str] = &["sphere", "blade"];
    const HOLONOMIC: usize = 1;
    fn lagrangian<T: Real>(&self, _: T, q: &SVector<T, 4>, v: &SVector<T, 4>) -> T {
        v.iter().fold(T::zero(), |sum, v| sum + sq(*v)) * T::real(0.5) - T::real(2.0) * q[2]
    }
    fn constraints<T: Real>(&self, _: T, q: &SVector<T, 4>, v: &SVector<T, 4>) -> [T; 2] {
        let (sine, cosine) = q[3].sin_cos();
        [sq(q[0]) + sq(q[1]) + sq(q[2]) - T::one(), sine * v[0] - cosine * v[1]]
    }
}

/// The pendulum with its rod declared twice, in different units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Twice;

impl Model<2, 2> for Twice {
    const NAME: &'static str = "Twice";
    const COORDINATES: [&'static str; 2] = ["x", "y"];
    const CONSTRAINTS: &'static [&'static str] = &["rod", "again"];
    fn lagrangian<T: Real>(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        PENDULUM.0.lagrangian(t, q, v)
    }
    fn constraints<T: Real>(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> [T; 2] {
        let [rod] = PENDULUM.0.constraints(t, q, v);
        [rod, rod * T::real(1e3)]
    }
}
