//! The systems of the suite: each with parameters other than 1, a start, and the facts that its claims need.
//!
//! Systems without constraints are texts of `vi-tape`, which has every method without compiling it for them. Its tests
//! compare it with compiled systems by every method. Systems with constraints are compiled here.

use vi_core::lagrangian;
use vi_erased::{System, kind};
use vi_systems::RodPendulum;

/// A function of coordinates and momenta.
type Momentum = fn(&[f64], &[f64]) -> f64;

/// A system, and a motion of it.
pub(super) struct Scene {
    pub(super) name: &'static str,
    pub(super) system: fn() -> Box<dyn System>,
    /// Parameters other than the defaults.
    pub(super) parameters: &'static [(&'static str, f64)],
    pub(super) t: f64,
    pub(super) q: &'static [f64],
    pub(super) v: &'static [f64],
    /// A step of moderate length.
    pub(super) h: f64,
    /// Whether its step density keeps its sign, so that energy-preserving steps need no shift.
    pub(super) has_density: bool,
    /// Whether the motion is symplectic: it has no force, and holonomic constraints only.
    pub(super) is_symplectic: bool,
    /// The coordinate whose momentum is constant.
    pub(super) cyclic: Option<usize>,
    /// A quadratic function of coordinates and momenta that is constant.
    pub(super) momentum: Option<Momentum>,
}

/// A system of a text.
fn text(text: &str) -> Box<dyn System> {
    vi_tape::System::parse(text).unwrap_or_else(|mistakes| panic!("{mistakes}")).into_inner()
}

/// Two coupled particles in a potential without symmetry: the motion splits.
const COUPLED: &str = "struct Coupled {
    param m = 1.5, k = 0.75;
    coord x, y;
    L = m / 2 * dot(x)^2 + dot(y)^2 + dot(x) * dot(y) / 2 - k * x^4 / 4 - x^2 * y / 4 - y^4 / 2 - x * y;
    discretize midpoint;
}";

/// The same with forces that depend on the time and have no potential.
const FORCED: &str = "struct Forced {
    param m = 1.5, k = 0.75, w = 1.875, b = 0.25;
    coord x, y;
    L = m / 2 * dot(x)^2 + dot(y)^2 - k * x^4 / 4 - x^2 * y / 4 - y^4 / 2 - x * y;
    force x = sin(w * t) / 2;
    force y = b * sin(x);
    discretize midpoint;
}";

/// Force, time dependence, varying mass and damping together, and a time scale of time and place.
const EVERYTHING: &str = "struct Everything {
    param a = 1.0, c = 0.1, w = 1.0, b = 0.5;
    coord x, y;
    L = (1 + x^2 / 3) * dot(x)^2 / 2 + a * dot(y)^2 / 2 + x * dot(x) * dot(y) / 5 - cos(w * t) * x * y / 4 - x^2 - y^4 / 4;
    force x = -c * dot(x) + sin(t) / 5;
    force y = -c * dot(x) * dot(y);
    time_scale = 1 + b * x^2 / 2 + sin(t) * y / 3;
    discretize midpoint;
}";

/// Kepler's problem, with a time scale.
const KEPLER: &str = "struct Kepler {
    param mu = 1.0;
    coord x, y;
    let r = sqrt(x^2 + y^2);
    L = (dot(x)^2 + dot(y)^2) / 2 + mu / r;
    time_scale = r^(3/2);
    discretize midpoint;
}";

/// A pendulum in space: its azimuth is cyclic, and its mass varies.
const SPHERICAL: &str = "struct Spherical {
    param m = 1.0, l = 1.0, g = 9.81;
    coord a, b;
    L = m * l^2 * (dot(a)^2 + sin(a)^2 * dot(b)^2) / 2 + m * g * l * cos(a);
    discretize midpoint;
}";

/// A pendulum that turns over under a gravity that varies with the time: one angle.
const TURNING: &str = "struct Turning {
    param l = 0.7, e = 0.2;
    angle a;
    L = l^2 * dot(a)^2 / 2 + (1 + e * cos(2 * t)) * l * cos(a);
    discretize midpoint;
}";

/// Four masses on nonlinear springs: more coordinates.
const CHAIN: &str = "struct Chain {
    param m = 0.8, k = 1.2, beta = 0.3;
    coord q[4];
    let r[i in 1..4] = q[i] - q[i - 1];
    L = m * sum(i in 0..4, dot(q[i])^2) / 2 - k * (q[0]^2 + sum(i in 1..4, r[i]^2) + q[3]^2) / 2
        - beta * (q[0]^4 + sum(i in 1..4, r[i]^4) + q[3]^4) / 4;
    discretize midpoint;
}";

/// A particle in a magnetic field: L is linear in a velocity, and not quadratic in the others.
const MAGNETIC: &str = "struct Magnetic {
    param c = 0.2, b = 1.0, k = 0.5;
    coord x, y;
    let squares = dot(x)^2 + dot(y)^2;
    L = squares / 2 + c * squares^2 - b * (y + y^3 / 4) * dot(x) - k * (x^2 + 2 * y^2) / 2;
    discretize midpoint;
}";

/// Three vortices of a plane in a strain that varies with the time, with friction: L is linear in the velocities of y.
const VORTICES: &str = "struct Vortices {
    param k[3] = [1.0, 1.5, -0.7], s = 0.3, w = 1.2, c = 0.05;
    coord y[3], x[3];
    let r2[i in 0..3][j in 0..3] = (x[i] - x[j])^2 + (y[i] - y[j])^2;
    L = sum(i in 0..3, k[i]*x[i]*dot(y[i])) - s*cos(w*t)*sum(i in 0..3, k[i]*x[i]*y[i])
        + k[0]*k[1]*ln(r2[0][1])/2 + k[0]*k[2]*ln(r2[0][2])/2 + k[1]*k[2]*ln(r2[1][2])/2;
    force y[0] = -c*dot(y[0])^3;
}";

/// Predator and prey: momenta that are not linear in the coordinates, and conserve their energy.
const PREDATOR: &str = "struct Predator {
    param α = 0.9, β = 1.3;
    coord a, b;
    L = ln(b)/a*dot(a) - (a - α*ln(a) + b - β*ln(b));
}";

lagrangian! {
    /// A point on a sphere with a blade, on ground that moves: both kinds of constraints, and time dependence.
    struct Skate {
        param m = 1.5, g = 2.0, l = 1.0, k = 0.2;
        coord x, y, z, θ;
        L = m / 2 * (dot(x)^2 + dot(y)^2 + dot(z)^2) + dot(θ)^2 / 2 - g * z + sin(θ) * z / 3;
        constraint sphere = x^2 + y^2 + z^2 - l^2;
        constraint blade = (dot(x) + k * sin(t)) * sin(θ) - dot(y) * cos(θ);
    }
}

/// What most systems have: a start at another time than zero, a density, a symplectic motion.
const FREE: Scene = Scene {
    name: "",
    system: || unreachable!("each scene has its own"),
    parameters: &[],
    t: 0.2,
    q: &[],
    v: &[],
    h: 0.05,
    has_density: true,
    is_symplectic: true,
    cyclic: None,
    momentum: None,
};

/// The systems, those with constraints last.
pub(super) const SCENES: [Scene; 12] = [
    Scene {
        name: "coupled",
        system: || text(COUPLED),
        parameters: &[("m", 1.3), ("k", 0.9)],
        q: &[0.75, -0.25],
        v: &[0.5, 0.875],
        ..FREE
    },
    Scene {
        name: "forced",
        system: || text(FORCED),
        parameters: &[("m", 1.3), ("k", 0.9), ("w", 1.7), ("b", 0.4)],
        q: &[0.75, -0.25],
        v: &[0.5, 0.875],
        is_symplectic: false,
        ..FREE
    },
    Scene {
        name: "everything",
        system: || text(EVERYTHING),
        parameters: &[("a", 1.4), ("c", 0.15), ("w", 1.3), ("b", 0.7)],
        q: &[0.6, 0.9],
        v: &[0.4, -0.3],
        is_symplectic: false,
        ..FREE
    },
    Scene {
        name: "Kepler",
        system: || text(KEPLER),
        parameters: &[("mu", 1.6)],
        q: &[0.6, 0.1],
        v: &[-0.2, 1.9],
        h: 0.015,
        momentum: Some(|q, p| q[0] * p[1] - q[1] * p[0]),
        ..FREE
    },
    Scene {
        name: "spherical",
        system: || text(SPHERICAL),
        parameters: &[("m", 1.2), ("l", 0.9)],
        q: &[1.0, 0.3],
        v: &[0.4, 4.5],
        h: 0.015,
        cyclic: Some(1),
        ..FREE
    },
    Scene {
        name: "turning",
        system: || text(TURNING),
        parameters: &[("l", 0.8), ("e", 0.15)],
        q: &[0.4],
        v: &[3.5],
        has_density: false,
        ..FREE
    },
    Scene {
        name: "magnetic",
        system: || text(MAGNETIC),
        parameters: &[("c", 0.3), ("b", 1.2), ("k", 0.6)],
        q: &[0.9, 0.3],
        v: &[0.4, -0.6],
        ..FREE
    },
    Scene {
        name: "chain",
        system: || text(CHAIN),
        parameters: &[("m", 0.9), ("k", 1.3), ("beta", 0.4)],
        q: &[0.3, 0.7, -0.4, 0.1],
        v: &[0.2, 0.0, 0.5, -0.3],
        ..FREE
    },
    Scene {
        name: "vortices",
        system: || text(VORTICES),
        parameters: &[("s", 0.4), ("w", 1.1), ("c", 0.08)],
        q: &[0.1, 1.2, -0.9, 0.4, -0.3, 0.7],
        v: &[0.0; 6],
        h: 0.012,
        is_symplectic: false,
        ..FREE
    },
    Scene {
        name: "predator",
        system: || text(PREDATOR),
        parameters: &[("α", 0.8), ("β", 1.2)],
        q: &[1.3, 0.6],
        v: &[0.0; 2],
        ..FREE
    },
    Scene {
        name: "rod",
        system: || kind!(RodPendulum, { gauss 1, 2, 3; adaptive 3; energy 1, 2 }),
        parameters: &[("m", 1.3), ("l", 1.25)],
        q: &[0.75, -1.0],
        v: &[0.8, 0.6],
        h: 0.02,
        ..FREE
    },
    Scene {
        name: "skate",
        system: || kind!(Skate, { gauss 1, 2, 3; energy 1, 2 }),
        parameters: &[("g", 2.2), ("m", 1.4), ("k", 0.3)],
        q: &[0.1, 0.6, -0.8, 0.4],
        v: &[1.5, 0.3, 0.2, 0.7],
        h: 0.03,
        is_symplectic: false,
        ..FREE
    },
];
