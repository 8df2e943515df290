//! The checks of systems with constraints: those of generated systems pass, and each finds what it has to find.

use super::systems::{Auto, PENDULUM, Pendulum};
use vi_core::check::{
    CheckFailure, Place, Report, constraints, derivatives, gauss_order, gauss_symplecticity, reaction,
};
use vi_core::lagrangian::{Flow, Parameters};
use vi_core::motion::Motion;
use vi_core::motion::{Point, PointDerivatives};
use vi_core::real::Real;
use vi_core::stepping::Convertible;
use vi_core::{Lagrangian, SVector, StepError, lagrangian, support};

// Each `check` makes a module of tests.
lagrangian! {
    /// Two rods on a pivot that moves, with friction.
    struct Rods {
        param m = 1.5, g = 9.81, l = 1.0, a = 0.1, c = 0.2;
        coord x, y, u, w;
        L = m / 2 * (1 + x^2 / 4) * (dot(x)^2 + dot(y)^2) + (dot(u)^2 + dot(w)^2) / 2 - g * (m * y + w);
        force u = -c * dot(u);
        constraint upper = x^2 + (y - a * sin(3 * t))^2 - l^2;
        constraint lower = (u - x)^2 + (w - y)^2 - 1;
        check { x = 0.6, y = -0.8, u = 1.2, w = -1.6, dot(x) = 0.8, dot(y) = 0.6, t = 0.1; h = 0.01; }
    }
}

lagrangian! {
    /// A bead on an ellipse, without force and time.
    struct Bead {
        param b = 2.0, g = 9.81;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - g * y;
        constraint ellipse = x^2 + b * y^2 - 1;
        check { x = 0.5, y = -0.7, dot(x) = 0.4; h = 0.01; }
    }
}

lagrangian! {
    /// A sleigh on ice, with a wind that turns.
    struct Sleigh {
        param m = 1.2, e = 0.5, k = 0.3;
        coord x, y, θ;
        L = m / 2 * ((dot(x) - e * sin(θ) * dot(θ))^2 + (dot(y) + e * cos(θ) * dot(θ))^2) + dot(θ)^2 / 2;
        constraint blade = (dot(x) + k * sin(t)) * sin(θ) - dot(y) * cos(θ);
        check { θ = 0.4, dot(x) = 1, dot(y) = 0.4, dot(θ) = 1.3; h = 0.01; }
    }
}

lagrangian! {
    /// A heavy top.
    struct Top {
        param j = 0.5, g = 2.0;
        rotation R;
        let w = rate(R), axis = turn(R, [0, 0, 1]);
        L = (w[0]^2 + w[1]^2 + j * w[2]^2) / 2 - g * axis[2];
        check { R[0] = 0.8, R[1] = 0.4, R[2] = 0.4, R[3] = 0.2, dot(R[0]) = -0.4, dot(R[1]) = 1.8, dot(R[2]) = -2.2, dot(R[3]) = 2.4; h = 0.01; }
    }
}

/// What is wrong in a generated system.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mistake {
    Nothing,
    Momentum,
    Force,
    /// A mass matrix that is not the derivative of the momentum.
    Mass,
    Gradient,
    RateDerivative,
    ReactionDerivative,
    Applied,
}

/// The bead with a mistake of a millionth.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spoiled<T = f64> {
    bead: Bead<T>,
    mistake: Mistake,
}

impl<T: Real> Spoiled<T> {
    fn factor(&self, mistake: Mistake) -> T {
        T::real(if self.mistake == mistake { 1.0 + 1e-6 } else { 1.0 })
    }
}

impl<T: Real> Lagrangian<2, T> for Spoiled<T> {
    const NAME: &'static str = "Spoiled";
    const COORDINATES: [&'static str; 2] = ["x", "y"];
    const AUTONOMOUS: bool = true;
    const FORCED: bool = false;
    const CYCLIC: [bool; 2] = [false; 2];

    fn lagrangian(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        self.bead.lagrangian(t, q, v)
    }
    fn energy(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        self.bead.energy(t, q, v)
    }
    fn force(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> SVector<T, 2> {
        self.bead.force(t, q, v)
    }
    fn momentum(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> SVector<T, 2> {
        self.bead.momentum(t, q, v) * self.factor(Mistake::Momentum)
    }
    fn acceleration(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> Result<SVector<T, 2>, StepError> {
        support::constrained_acceleration(self, t, q, v)
    }
    fn flow(&self, t: T, q: &SVector<T, 2>, p: &SVector<T, 2>) -> Result<Flow<2, T>, StepError> {
        support::constrained_flow(self, t, q, p)
    }
}

impl<T: Real> Motion<2, T> for Spoiled<T> {
    type Kind = vi_core::kind::Bound<1>;
    type Mass = <Bead<T> as Motion<2, T>>::Mass;
    type PointMatrix = <Bead<T> as Motion<2, T>>::PointMatrix;
    const CONSTANT_MASS: bool = true;
    const CONSTRAINTS: &'static [&'static str] = &["ellipse"];
    const HOLONOMIC: usize = 1;

    fn point(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> Point<2, T, Self::Mass> {
        let Point { momentum, force, mass } = self.bead.point(t, q, v);
        Point { momentum, force: force * self.factor(Mistake::Force), mass }
    }
    fn point_derivatives(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> PointDerivatives<Self::PointMatrix> {
        let mut derivatives = self.bead.point_derivatives(t, q, v);
        if self.mistake == Mistake::Mass {
            core::mem::swap(&mut derivatives.mass, &mut derivatives.force_dq);
        }
        derivatives
    }
    fn power(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> T {
        self.bead.power(t, q, v)
    }
    fn applied(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> SVector<T, 2> {
        self.bead.applied(t, q, v) * self.factor(Mistake::Applied)
    }
    fn constraints(&self, t: T, q: &SVector<T, 2>) -> [T; 1] {
        self.bead.constraints(t, q)
    }
    fn constraint_gradients(&self, t: T, q: &SVector<T, 2>) -> ([SVector<T, 2>; 1], [T; 1]) {
        let (rows, rest) = self.bead.constraint_gradients(t, q);
        let mut row = rows.row(0).dense();
        if self.mistake == Mistake::Gradient {
            // No function has this gradient.
            row[0] += q[1] * T::real(1e-6);
        }
        ([row], rest)
    }
    fn constraint_rate_derivatives(&self, t: T, q: &SVector<T, 2>, v: &SVector<T, 2>) -> ([SVector<T, 2>; 1], [T; 1]) {
        let (rows, rest) = self.bead.constraint_rate_derivatives(t, q, v);
        ([rows.row(0).dense() * self.factor(Mistake::RateDerivative)], rest)
    }
    fn reaction_derivatives(&self, t: T, q: &SVector<T, 2>, multipliers: &[T; 1]) -> [SVector<T, 2>; 2] {
        let rows = self.bead.reaction_derivatives(t, q, multipliers);
        [0, 1].map(|row| rows.row(row).dense() * self.factor(Mistake::ReactionDerivative))
    }
}

impl<T: Real> Parameters<T> for Spoiled<T> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        self.bead.parameter_mut(name)
    }
}

impl Convertible<2> for Spoiled {
    type In<T: Real> = Spoiled<T>;

    fn convert<T: Real>(&self) -> Spoiled<T> {
        Spoiled { bead: self.bead.convert(), mistake: self.mistake }
    }
}

#[test]
fn mistakes_are_found() {
    type Check = fn(&Spoiled, &Place<2>) -> Result<Report, CheckFailure>;
    let cases: [(Check, Mistake); 9] = [
        (derivatives, Mistake::Momentum),
        (derivatives, Mistake::Force),
        (derivatives, Mistake::Mass),
        (constraints, Mistake::Gradient),
        (constraints, Mistake::RateDerivative),
        (constraints, Mistake::ReactionDerivative),
        (reaction, Mistake::Applied),
        (reaction, Mistake::RateDerivative),
        (gauss_symplecticity, Mistake::Gradient),
    ];
    for (check, mistake) in cases {
        let bead = Bead::default();
        let right = check(&Spoiled { bead, mistake: Mistake::Nothing }, &place());
        assert!(right.is_ok(), "{right:?}");
        let wrong = check(&Spoiled { bead, mistake }, &place());
        assert!(matches!(wrong, Err(CheckFailure::Differs { .. })), "{mistake:?}: {wrong:?}");
    }
}

fn place() -> Place<2> {
    Place { t: 0.0, q: [0.6, -0.81].into(), v: [0.8, 0.6].into(), h: 0.01 }
}

#[test]
fn reports_have_their_numbers() {
    let bead = Bead::default();
    for report in [
        derivatives(&bead, &place()),
        constraints(&bead, &place()),
        reaction(&bead, &place()),
        gauss_order(&bead, &place()),
        gauss_symplecticity(&bead, &place()),
    ] {
        let report = report.unwrap_or_else(|failure| panic!("{failure}"));
        println!("{report}");
        assert!(report.compared >= 6 && report.worst <= report.tolerance, "{report}");
    }
}

#[test]
fn checks_apply_where_their_property_exists() {
    // `Auto` declares a force, also where it is zero.
    let refused = gauss_symplecticity(&PENDULUM, &place());
    assert!(matches!(refused, Err(CheckFailure::NotApplicable { .. })), "{refused:?}");
    let sleigh = Sleigh::default();
    let at = Place { t: 0.0, q: [0.0, 0.0, 0.4].into(), v: [1.0, 0.4, 1.3].into(), h: 0.01 };
    let refused = gauss_symplecticity(&sleigh, &at);
    assert!(matches!(refused, Err(CheckFailure::NotApplicable { .. })), "{refused:?}");
    // A rotor without weight at rest.
    let still = Place { v: [0.0, 0.0].into(), ..place() };
    let vacuous = reaction(&Auto(Pendulum { length: 1.0, g: 0.0 }), &still);
    assert!(matches!(vacuous, Err(CheckFailure::Vacuous { .. })), "{vacuous:?}");
    // The centre has no nearest place.
    let lost = constraints(&PENDULUM, &Place { q: [0.0, 0.0].into(), ..place() });
    assert!(matches!(lost, Err(CheckFailure::Step { .. })), "{lost:?}");
}
