//! Correct systems of many kinds, with energies from 1e-18 to 1e34, each with a state and suitable steps.

use vi_core::check::Place;
use vi_core::lagrangian;

lagrangian! {
    /// Heavy symmetric top, Euler angles.
    pub(crate) struct HeavyTop {
        param i1 = 1.0, i3 = 0.4, weight = 2.0;
        coord θ, φ, ψ;
        L = i1 * (dot(θ)^2 + sin(θ)^2 * dot(φ)^2) / 2 + i3 * (dot(ψ) + cos(θ) * dot(φ))^2 / 2 - weight * cos(θ);
        discretize midpoint;
    }
}

lagrangian! {
    /// Toda's ring of eight.
    pub(crate) struct Toda {
        const N = 8;
        param m = 1.1, a = 0.9;
        coord q[N];
        let inner = sum(i in 0..N - 1, exp(a * (q[i] - q[i + 1])));
        L = m * sum(i in 0..N, dot(q[i])^2) / 2 - inner - exp(a * (q[N - 1] - q[0]));
        discretize midpoint;
    }
}

lagrangian! {
    /// Three atoms in the plane with attraction and repulsion.
    pub(crate) struct LennardJones {
        param m = 1.0, ε = 1.0, σ = 1.0;
        coord x[3], y[3];
        let s[i in 0..2] = (σ^2 / ((x[i] - x[i + 1])^2 + (y[i] - y[i + 1])^2))^3;
        let closing = (σ^2 / ((x[0] - x[2])^2 + (y[0] - y[2])^2))^3;
        let potential = sum(i in 0..2, s[i]^2 - s[i]) + closing^2 - closing;
        L = m * sum(i in 0..3, dot(x[i])^2 + dot(y[i])^2) / 2 - 4 * ε * potential;
        discretize midpoint;
    }
}

lagrangian! {
    /// A mass on a stiff spring, in Cartesian coordinates.
    pub(crate) struct SpringPendulum {
        param m = 1.0, k = 400.0, l = 1.0, g = 9.81;
        coord x, y;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - k * (sqrt(x^2 + y^2) - l)^2 / 2 - m * g * y;
        discretize midpoint;
    }
}

lagrangian! {
    /// A triple pendulum.
    pub(crate) struct TriplePendulum {
        param m1 = 1.0, m2 = 0.8, m3 = 0.6, g = 9.81;
        coord a, b, c;
        let x1 = dot(a) * cos(a), y1 = dot(a) * sin(a);
        let x2 = x1 + dot(b) * cos(b), y2 = y1 + dot(b) * sin(b);
        let x3 = x2 + dot(c) * cos(c), y3 = y2 + dot(c) * sin(c);
        let kinetic = (m1 * (x1^2 + y1^2) + m2 * (x2^2 + y2^2) + m3 * (x3^2 + y3^2)) / 2;
        L = kinetic + g * ((m1 + m2 + m3) * cos(a) + (m2 + m3) * cos(b) + m3 * cos(c));
        discretize midpoint;
    }
}

lagrangian! {
    /// Three bodies with mutual gravity, in the plane.
    pub(crate) struct ThreeBodies {
        param G = 1.0, m0 = 1.0, m1 = 1.0, m2 = 1.0;
        coord x[3], y[3];
        let near[i in 0..2] = m1 * (m0 * (1 - i) + m2 * i) / hypot(x[i] - x[i + 1], y[i] - y[i + 1]);
        let far = m0 * m2 / hypot(x[0] - x[2], y[0] - y[2]);
        let square[i in 0..3] = dot(x[i])^2 + dot(y[i])^2;
        L = (m0 * square[0] + m1 * square[1] + m2 * square[2]) / 2 + G * (sum(i in 0..2, near[i]) + far);
        discretize midpoint;
    }
}

lagrangian! {
    /// A stiff and a soft spring.
    pub(crate) struct Stiff {
        param m = 1.0, k = 1e8, soft = 1.0, b = 3e8;
        coord x, y;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - k * (x - y)^2 / 2 - b * (x - y)^4 / 4 - soft * x^4 / 4;
        discretize midpoint;
    }
}

lagrangian! {
    /// A pendulum with friction, driven by a force and at its pivot.
    pub(crate) struct Driven {
        param l = 1.0, g = 9.81, c = 0.2, torque = 1.5, Ω = 2.2, shake = 0.3;
        coord θ;
        L = (l * dot(θ))^2 / 2 + (g + shake * sin(Ω * t)) * l * cos(θ);
        dissipation = c * dot(θ)^2 / 2;
        force θ = torque * cos(Ω * t);
        discretize midpoint;
    }
}

lagrangian! {
    /// Caldirola and Kanai: friction by a growing mass.
    pub(crate) struct GrowingMass {
        param m = 1.3, k = 2.0, c = 0.3;
        coord x, y;
        L = exp(c * t) * (m * (dot(x)^2 + dot(y)^2) / 2 - k * (x^2 + x^2 * y^2 + 2 * y^2) / 2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A bead on the wire y = a x⁴: a position-dependent mass; every energy times 1e9.
    pub(crate) struct Bead {
        param scale = 1e9, m = 0.7, a = 0.8, g = 9.81;
        coord x;
        let slope = 4 * a * x^3;
        L = scale * m * ((1 + slope^2) * dot(x)^2 / 2 - g * a * x^4);
        discretize midpoint;
    }
}

lagrangian! {
    /// A dumb-bell of some micrometres in an optical trap, in metres, kilograms and seconds, with an angle and lengths.
    pub(crate) struct Trapped {
        param m = 1e-12, a = 2e-6, k = 3e-6, width = 1.5e-6, torque = 4e-18;
        coord x, y, θ;
        let depth = k * width^2;
        let place = (x^2 + 2 * y^2) / (2 * width^2);
        L = m * (dot(x)^2 + dot(y)^2) / 2 + m * a^2 * dot(θ)^2 / 2 + depth * exp(-place) + torque * cos(2 * θ - x / width);
        discretize midpoint;
    }
}

lagrangian! {
    /// The Earth about the Sun, in metres, kilograms and seconds.
    pub(crate) struct Earth {
        param m = 5.97e24, GM = 1.327e20;
        coord x, y;
        L = m * (dot(x)^2 + dot(y)^2) / 2 + GM * m / sqrt(x^2 + y^2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A fast particle in a well.
    pub(crate) struct Relativistic {
        param m = 1.0, c = 2.0, k = 1.5;
        coord x, y;
        L = -m * c^2 * sqrt(1 - (dot(x)^2 + dot(y)^2) / c^2) - k * (x^2 + y^2 + x^2 * y) / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// A charge in a magnetic field that grows outward, and in an electric one.
    pub(crate) struct Charge {
        param m = 1.0, B = 1.5, E = 0.3, grow = 0.4;
        coord x, y, z;
        let field = B * (1 + grow * (x^2 + y^2)) / 2;
        L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2 + field * (x * dot(y) - y * dot(x)) - E * z^2 * (1 + x);
        discretize midpoint;
    }
}

lagrangian! {
    /// A projectile: steps are exact.
    pub(crate) struct Thrown {
        param m = 2.0, g = 9.81;
        coord x, z;
        L = m * (dot(x)^2 + dot(z)^2) / 2 - m * g * z;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two coupled oscillators, linear: the step law is exact.
    pub(crate) struct Linear {
        param m = 1.2, k = 3.0, weak = 0.2;
        coord x, y;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - k * (x^2 + y^2) / 2 - weak * (x - y)^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// Eight masses on nonlinear springs with fixed and damped ends, with the explicit rule.
    pub(crate) struct Chain {
        const N = 8;
        param alpha = 0.3, c = 0.1;
        coord q[N];
        let stretch[i in 0..N - 1] = q[i + 1] - q[i];
        let potential = sum(i in 0..N - 1, stretch[i]^2 / 2 + alpha * stretch[i]^3 / 3) + q[0]^2 / 2 + q[N - 1]^2 / 2;
        L = sum(i in 0..N, dot(q[i])^2) / 2 - potential;
        force q[0] = -c * dot(q[0]) + sin(3 * t) / 5;
        discretize trapezoidal;
    }
}

/// A system, a state, and the largest sensible step.
pub(crate) struct Case<S, const N: usize> {
    pub(crate) system: S,
    pub(crate) place: Place<N>,
}

fn case<const N: usize, S: Default>(t: f64, q: [f64; N], v: [f64; N], h: f64) -> Case<S, N> {
    Case { system: S::default(), place: Place { t, q: q.into(), v: v.into(), h } }
}

impl<const N: usize, S> Case<S, N> {
    /// The state with steps from the largest down to 1e-5, and to 1e-5 of the largest.
    pub(crate) fn places(&self) -> Vec<Place<N>> {
        let largest = self.place.h;
        let smallest = 1e-5_f64.min(largest * 1e-5);
        let steps = core::iter::successors(Some(largest), |h| Some(h / 4.0)).take_while(|h| *h > smallest);
        steps.chain([smallest]).map(|h| Place { h, ..self.place }).collect()
    }
}

pub(crate) fn heavy_top() -> Case<HeavyTop, 3> {
    case(0.1, [0.8, 0.2, 0.4], [0.1, 0.6, 5.0], 0.05)
}

pub(crate) fn toda() -> Case<Toda, 8> {
    let q = [0.1, -0.3, 0.2, 0.5, -0.1, 0.0, 0.3, -0.4];
    case(0.0, q, [0.5, 0.1, -0.2, 0.3, 0.0, -0.4, 0.2, -0.5], 0.05)
}

pub(crate) fn lennard_jones() -> Case<LennardJones, 6> {
    case(0.0, [0.0, 1.15, 0.5, 0.0, 0.05, 1.02], [0.1, -0.1, 0.05, 0.0, 0.2, -0.1], 0.005)
}

pub(crate) fn spring_pendulum() -> Case<SpringPendulum, 2> {
    case(0.0, [0.4, -0.9], [0.5, 0.1], 0.005)
}

pub(crate) fn triple_pendulum() -> Case<TriplePendulum, 3> {
    case(0.0, [0.6, 0.4, -0.3], [0.1, -0.2, 0.3], 0.01)
}

pub(crate) fn figure_eight() -> Case<ThreeBodies, 6> {
    let (x, y, vx, vy) = (0.970_004_36, -0.243_087_53, 0.466_203_685, 0.432_365_73);
    case(0.0, [x, 0.0, -x, y, 0.0, -y], [vx, -2.0 * vx, vx, vy, -2.0 * vy, vy], 0.01)
}

pub(crate) fn stiff() -> Case<Stiff, 2> {
    case(0.0, [1.0, 0.9], [0.5, 0.3], 1e-5)
}

pub(crate) fn driven() -> Case<Driven, 1> {
    case(0.3, [0.7], [0.4], 0.02)
}

pub(crate) fn growing_mass() -> Case<GrowingMass, 2> {
    case(0.2, [0.7, -0.4], [0.4, 0.5], 0.05)
}

pub(crate) fn bead() -> Case<Bead, 1> {
    case(0.0, [0.9], [0.2], 0.005)
}

pub(crate) fn trapped() -> Case<Trapped, 3> {
    case(0.0, [0.4e-6, -0.3e-6, 0.6], [0.3e-3, 0.2e-3, 100.0], 2e-5)
}

pub(crate) fn earth() -> Case<Earth, 2> {
    case(0.0, [1.2e11, 0.7e11], [-1.3e4, 2.8e4], 2e5)
}

pub(crate) fn relativistic() -> Case<Relativistic, 2> {
    case(0.0, [0.5, 0.3], [1.2, -0.4], 0.02)
}

pub(crate) fn charge() -> Case<Charge, 3> {
    case(0.0, [0.2, 0.1, 0.5], [0.7, 0.4, 0.1], 0.05)
}

pub(crate) fn thrown() -> Case<Thrown, 2> {
    case(0.0, [0.1, 0.2], [1.0, 3.0], 0.1)
}

pub(crate) fn linear() -> Case<Linear, 2> {
    case(0.0, [0.6, 0.2], [0.1, -0.3], 0.05)
}

pub(crate) fn chain() -> Case<Chain, 8> {
    let q = [0.3, 0.6, 0.8, 0.9, 0.9, 0.8, 0.6, 0.3];
    case(0.2, q, [0.0, 0.1, 0.0, 0.0, -0.2, 0.0, 0.0, 0.1], 0.1)
}

/// A test for each case, with the checks of its energy-preserving steps, or of its fixed steps if it has no others.
macro_rules! each_case {
    ($function:path, $energy:path, $fixed:path) => {
        $crate::many::each_case!($function, $energy:
            heavy_top toda lennard_jones spring_pendulum triple_pendulum figure_eight stiff driven growing_mass bead
            trapped earth relativistic charge thrown linear
        );
        $crate::many::each_case!($function, $fixed: chain);
    };
    ($function:path, $checks:path: $($case:ident)*) => {$(
        #[test]
        fn $case() {
            $function($crate::many::$case(), $checks());
        }
    )*};
}
pub(crate) use each_case;
