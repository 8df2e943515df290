//! Systems whose motion changes suddenly: a step then differs from the previous ones, and the prediction is wrong.

use crate::support::scenes::Scene;
use vi_core::lagrangian;

lagrangian! {
    /// A weight on a wall with a thickness of a twentieth of its fall. Convex: every step has one root.
    pub(crate) struct Wall {
        param m = 1.0, g = 1.0, k = 50.0;
        coord x;
        L = m * dot(x)^2 / 2 - g * x - exp(-k * x);
        discretize midpoint;
    }
}

lagrangian! {
    /// The same with the trapezoidal rule and friction.
    pub(crate) struct RoughWall {
        param m = 1.3, g = 1.1, k = 50.0, c = 0.05;
        coord x;
        L = m * dot(x)^2 / 2 - g * x - exp(-k * x);
        dissipation = c * dot(x)^2 / 2;
        discretize trapezoidal;
    }
}

lagrangian! {
    /// A weight on a hard atomic core.
    pub(crate) struct HardCore {
        param m = 1.2, g = 0.9, r = 0.1;
        coord x;
        L = m * dot(x)^2 / 2 - g * x - (r / x)^12;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two slopes that join within a hundredth of their length.
    pub(crate) struct Valley {
        param m = 1.0, k = 100.0;
        coord x;
        L = m * dot(x)^2 / 2 - ln(cosh(k * x)) / k;
        discretize midpoint;
    }
}

lagrangian! {
    /// An oscillator in the plane with a bump narrower than a step.
    pub(crate) struct Bump {
        param m = 1.0, k = 1.0, a = 0.1, w = 1e-3;
        coord x, y;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - k * (x^2 + 2 * y^2) / 2 - a * exp(-(x / w)^2);
        discretize midpoint;
    }
}

lagrangian! {
    /// An oscillator in space, with a ball in the middle.
    pub(crate) struct Ball {
        param m = 1.1, k = 1.3, a = 0.7, w = 0.1;
        coord x[3];
        let square = sum(i in 0..3, x[i]^2);
        L = sum(i in 0..3, m * dot(x[i])^2 - k * (i + 1) * x[i]^2) / 2 - a * exp(-square / w^2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A spring pendulum in polar coordinates, whose angle turns by π when the spring is short.
    pub(crate) struct SpringPendulum {
        param m = 1.0, k = 40.0, l = 1.0, g = 9.81;
        coord r, θ;
        L = m * (dot(r)^2 + r^2 * dot(θ)^2) / 2 - k * (r - l)^2 / 2 + m * g * r * cos(θ);
        discretize midpoint;
    }
}

lagrangian! {
    /// A mass that briefly becomes twenty times as large.
    pub(crate) struct Puddle {
        param m = 1.2, a = 20.0, w = 0.05, k = 1.4;
        coord x;
        L = m * (1 + a * exp(-(x / w)^2)) * dot(x)^2 / 2 - k * x^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// An oscillator with occasional kicks.
    pub(crate) struct Hit {
        param m = 1.1, k = 1.7, a = 30.0, w = 200.0;
        coord x;
        L = m * dot(x)^2 / 2 - k * x^2 / 2 + a * x * exp(w * (cos(2 * t) - 1));
        discretize midpoint;
    }
}

lagrangian! {
    /// A spring with nearly dry friction.
    pub(crate) struct Dry {
        param m = 1.3, k = 2.0, c = 0.3, s = 300.0;
        coord x;
        L = m * dot(x)^2 / 2 - k * x^2 / 2;
        force x = -c * tanh(s * dot(x));
        discretize midpoint;
    }
}

lagrangian! {
    /// A particle near the speed of light between two walls.
    pub(crate) struct Relativistic {
        param m = 1.0, k = 20.0;
        coord x;
        L = -m * sqrt(1 - dot(x)^2) - (x / 2)^20 / k;
        discretize midpoint;
    }
}

lagrangian! {
    /// Three atoms on a line.
    pub(crate) struct Atoms {
        param m = 1.2, e = 0.8;
        coord x, y, z;
        let far = (z - x)^-6;
        let left = (y - x)^-6;
        let right = (z - y)^-6;
        L = m * (dot(x)^2 + dot(y)^2 + 2 * dot(z)^2) / 2
          - 4 * e * (left^2 - left + right^2 - right + far^2 - far) - (x^2 + z^2) / 4;
        discretize midpoint;
    }
}

lagrangian! {
    /// Four links in a row, each with a stop.
    pub(crate) struct Stops {
        param m = 1.0, k = 3.0, s = 40.0;
        coord q[5];
        L = sum(i in 0..5, m * dot(q[i])^2) / 2 - k * (q[0]^2 + q[4]^2) / 2
          - sum(i in 0..4, (q[i + 1] - q[i])^2 + exp(s * (abs(q[i + 1] - q[i]) - 1)));
        discretize midpoint;
    }
}

fn scene<S, const N: usize>(system: S, q: [f64; N], v: [f64; N], h: f64) -> Scene<S, N> {
    Scene { system, q, v, h, span: f64::INFINITY }
}

pub(crate) fn wall() -> Scene<Wall, 1> {
    scene(Wall::default(), [1.0], [0.0], 0.01)
}

pub(crate) fn rough_wall() -> Scene<RoughWall, 1> {
    scene(RoughWall::default(), [1.0], [0.3], 0.01)
}

pub(crate) fn hard_core() -> Scene<HardCore, 1> {
    scene(HardCore::default(), [1.0], [0.2], 0.01)
}

pub(crate) fn valley() -> Scene<Valley, 1> {
    scene(Valley::default(), [1.0], [0.3], 0.0317)
}

pub(crate) fn bump() -> Scene<Bump, 2> {
    scene(Bump::default(), [0.9, 0.4], [0.1, 0.7], 0.0317)
}

pub(crate) fn ball() -> Scene<Ball, 3> {
    scene(Ball::default(), [0.5, 0.1, -0.2], [0.1, 0.3, 0.2], 0.0317)
}

pub(crate) fn spring_pendulum() -> Scene<SpringPendulum, 2> {
    scene(SpringPendulum::default(), [0.9, 1.2], [1.0, 0.4], 0.0317)
}

pub(crate) fn near_pole() -> Scene<vi_systems::SphericalPendulum, 2> {
    scene(vi_systems::SphericalPendulum::default(), [1.0, 0.0], [0.0, 1e-3], 0.01)
}

pub(crate) fn puddle() -> Scene<Puddle, 1> {
    scene(Puddle::default(), [1.0], [0.2], 0.02)
}

pub(crate) fn hit() -> Scene<Hit, 1> {
    scene(Hit::default(), [0.4], [0.3], 0.03)
}

pub(crate) fn dry() -> Scene<Dry, 1> {
    scene(Dry::default(), [1.0], [0.5], 0.01)
}

pub(crate) fn relativistic() -> Scene<Relativistic, 1> {
    scene(Relativistic::default(), [0.5], [0.65], 0.02)
}

pub(crate) fn atoms() -> Scene<Atoms, 3> {
    scene(Atoms::default(), [-1.3, 0.1, 1.4], [0.5, 0.3, -0.4], 0.01)
}

pub(crate) fn stops() -> Scene<Stops, 5> {
    scene(Stops::default(), [0.1, 0.5, -0.3, 0.2, 0.4], [1.0, -0.7, 0.4, 0.9, -0.5], 0.01)
}

/// Four rotating links, with functions too long to be inlined.
pub(crate) fn links() -> Scene<vi_systems::NPendulum, 4> {
    scene(vi_systems::NPendulum::default(), [2.0, 1.5, 2.5, -1.0], [0.0, 3.0, -2.0, 5.0], 0.005)
}

/// Sixteen masses and strong springs: the matrix is tridiagonal.
pub(crate) fn chain() -> Scene<vi_systems::FpuChain, 16> {
    let system = vi_systems::FpuChain { beta: 4.0, ..vi_systems::FpuChain::default() };
    let first = |value: f64| core::array::from_fn(|i| if i == 0 { value } else { value * 1e-3 });
    scene(system, first(1.0), first(2.0), 0.05)
}

/// One test for every such system: `check` gets its scene, `fixed` that of a system with fixed steps only.
macro_rules! each_sudden {
    ($check:path, $fixed:path) => {
        $crate::hunt::sudden::each_sudden! { $check:
            wall hard_core valley bump ball spring_pendulum near_pole puddle hit dry relativistic atoms stops links chain
        }
        $crate::hunt::sudden::each_sudden! { $fixed: rough_wall }
    };
    ($check:path: $($system:ident)*) => {$(
        #[test]
        fn $system() {
            $check($crate::hunt::sudden::$system());
        }
    )*};
}
pub(crate) use each_sudden;
