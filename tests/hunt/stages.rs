//! The same search for Gauss steps, including transformed time and energy-preserving steps.
//!
//! In: an accepted step, by its two nodes. Out: the differences of its end and of its preserved energy from the exact
//! solution of its equations from the same node, in roundings. The equations are those of `vi_core::gauss`, solved here
//! by fixed-point iteration in double-double arithmetic with an independent tableau,
//!
//! ```text
//! T' = g    Q' = g V    P' = g (L_q + f) − (H − E) g_q    E' = g (f·V − L_t) + (H − E) g_t        g = 1, no E, in plain time
//! ```
//!
//! A rounding is the rounding bound of their evaluation in `f64` from running error analysis. A step whose stages
//! fixed-point iteration does not find is stiff and not judged here: see `gauss_stiff`.

use crate::support::Sequence;
use crate::support::ending::assert_typed;
use crate::support::scenes::{self, Scene};
use crate::support::twice::Twice;
use vi_core::linear::Matrix;
use vi_core::motion::{Motion, Point, ScaledPoint, TimeScale};
use vi_core::node::Node;
use vi_core::real::{Number, Real, Rounded};
use vi_core::stepping::{Convertible, FixedStepping};
use vi_core::{EnergyPreservingGauss, Gauss, Method, Run, SVector, Starts, State, StepError, lagrangian};

/// Judged steps of each system with each integrator.
const STEPS: usize = 400;
const MOTIONS: usize = 20;
const MOST_MOTIONS: usize = 400;
/// Maximum error of an end or an energy, in roundings. Measured: 0.52, for the charged particle with energy-preserving
/// steps of one stage.
const FLOOR: f64 = 1.0;
/// Maximum reported residual. Measured: 3.95, at the acceptance limit.
const ACCEPTED: f64 = 4.0;

/// The tableau of S stages.
struct Tableau<const S: usize> {
    a: [[Twice; S]; S],
    b: [Twice; S],
    c: [Twice; S],
}

impl<const S: usize> Tableau<S> {
    // A few stages.
    #[allow(clippy::cast_precision_loss)]
    fn new() -> Self {
        let (one, two) = (Twice::real(1.0), Twice::real(2.0));
        // P_S and its derivative at x.
        let legendre = |x: Twice| {
            let (mut before, mut value) = (Twice::real(0.0), one);
            for k in 1..=S {
                let k = Twice::real(k as f64);
                (before, value) = (value, ((two * k - one) * x * value - (k - one) * before) / k);
            }
            (value, Twice::real(S as f64) * (x * value - before) / (x * x - one))
        };
        let [mut b, mut c] = [[one; S]; 2];
        for i in 0..S {
            let guess = -(core::f64::consts::PI * (i as f64 + 0.75) / (S as f64 + 0.5)).cos();
            let mut x = Twice::real(guess);
            for _ in 0..6 {
                let (value, slope) = legendre(x);
                x -= value / slope;
            }
            let slope = legendre(x).1;
            c[i] = (x + one) / two;
            b[i] = one / ((one - x * x) * slope * slope);
        }
        // The basis polynomials are of degree S − 1: the quadrature over [0, c_i] is exact.
        let basis = |j: usize, x: Twice| {
            (0..S).filter(|k| *k != j).fold(one, |product, k| product * (x - c[k]) / (c[j] - c[k]))
        };
        let a = core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..S).fold(Twice::real(0.0), |sum, k| sum + c[i] * b[k] * basis(j, c[i] * c[k])))
        });
        Self { a, b, c }
    }
}

/// A stage with its rates.
#[derive(Clone, Copy)]
struct Stage<const N: usize, T> {
    q: SVector<T, N>,
    v: SVector<T, N>,
    g: T,
    force: SVector<T, N>,
    energy: T,
    /// `v·p − L` there, and the power `f·v − L_t`.
    hamiltonian: T,
    power: T,
}

/// A node with its low parts, in numbers of type T.
struct Start<const N: usize, T> {
    t: T,
    q: SVector<T, N>,
    p: SVector<T, N>,
    energy: T,
}

impl<const N: usize, T: Real> Start<N, T> {
    fn of(node: &Node<N>) -> Self {
        let sum = |high: f64, low: f64| T::real(high) + T::real(low);
        Self {
            t: sum(node.t, node.t_low),
            q: node.q.zip_map(&node.q_low, sum),
            p: node.p.zip_map(&node.p_low, sum),
            energy: sum(node.energy, node.energy_low),
        }
    }
}

/// The stage at (t, q, v), the residual of its momentum with respect to `p`, and M⁻¹ of that; rates are those of
/// transformed or plain time.
fn stage<Y: Motion<N, T>, T: Real, const N: usize>(
    system: &Y,
    is_scaled: bool,
    (t, q, v): (T, SVector<T, N>, SVector<T, N>),
    carried: T,
) -> (Stage<N, T>, Point<N, T, Y::Mass>) {
    let ScaledPoint { point, energy, power, g, g_dq, g_dt } = system.scaled_point(t, &q, &v);
    if !is_scaled {
        let stage = Stage { q, v, g: T::one(), force: point.force, energy: power, hamiltonian: energy, power };
        return (stage, point);
    }
    let excess = energy - carried;
    let force = point.force.zip_map(&g_dq, |force, g_dq| g * force - excess * g_dq);
    (Stage { q, v, g, force, energy: g * power + excess * g_dt, hamiltonian: energy, power }, point)
}

/// The stages of a step of length h, in time or transformed time; `None` if fixed-point iteration does not find them.
fn solved<Y: Motion<N, Twice>, const N: usize, const S: usize>(
    system: &Y,
    tableau: &Tableau<S>,
    start: &Start<N, Twice>,
    (h, is_scaled): (f64, bool),
    v: SVector<f64, N>,
) -> Option<[Stage<N, Twice>; S]> {
    let zero = Twice::real(0.0);
    let first = stage(system, is_scaled, (start.t, start.q, v.map(Twice::real)), start.energy).0;
    let mut stages = [first; S];
    for _ in 0..150 {
        let before = stages;
        // Σ a_ij x_j, from the previous stages.
        let integral = |i: usize, of: &dyn Fn(&Stage<N, Twice>) -> Twice| {
            Twice::real(h) * (0..S).fold(zero, |sum, j| sum + tableau.a[i][j] * of(&before[j]))
        };
        let mut change = 0.0_f64;
        for i in 0..S {
            let t = start.t + if is_scaled { integral(i, &|at| at.g) } else { Twice::real(h) * tableau.c[i] };
            let q = SVector::from_fn(|k, _| start.q[k] + integral(i, &|at| at.g * at.v[k]));
            let p = SVector::from_fn(|k, _| start.p[k] + integral(i, &|at| at.force[k]));
            let carried = start.energy + integral(i, &|at| at.energy);
            let (at, point) = stage(system, is_scaled, (t, q, before[i].v), carried);
            let correction = point.mass.solve_unchecked(&(p - point.momentum));
            let v = at.v + correction;
            stages[i] = Stage { v, ..at };
            let moved = |now: &SVector<Twice, N>, before: &SVector<Twice, N>| {
                let length = now.iter().fold(1e-300, |length: f64, entry| length.max(entry.to_f64().abs()));
                (now - before).iter().fold(0.0, |moved: f64, entry| moved.max(entry.to_f64().abs())) / length
            };
            change = change.max(moved(&v, &before[i].v)).max(moved(&q, &before[i].q));
        }
        if !change.is_finite() {
            return None;
        }
        if change < 1e-26 {
            return Some(stages);
        }
    }
    None
}

/// Results for a step, in roundings.
#[derive(Clone, Copy, Debug, Default)]
struct Off {
    end: f64,
    energy: f64,
}

/// Judges steps of one system.
struct Judge<'a, Y, const N: usize, const S: usize> {
    system: &'a Y,
    tableau: Tableau<S>,
    is_scaled: bool,
    /// `C_s D_*` of energy-preserving steps, whose energy is judged.
    shift: Option<f64>,
}

impl<Y: Convertible<N>, const N: usize, const S: usize> Judge<'_, Y, N, S> {
    /// The difference of a step from its equations; `None` if these are not solved here.
    fn judge(&self, before: &Node<N>, after: &Node<N>, h: f64, v: SVector<f64, N>) -> Option<Off> {
        let exact = self.system.convert::<Twice>();
        let start = Start::<N, Twice>::of(before);
        let stages = solved(&exact, &self.tableau, &start, (h, self.is_scaled), v)?;
        let bounded = self.bounded(before, h, &stages);
        let end = Start::<N, Twice>::of(after);
        let mut off = Off::default();
        let mut row = |found: Twice,
                       start: Twice,
                       of: &dyn Fn(&Stage<N, Twice>) -> Twice,
                       bound: &dyn Fn(&Stage<N, Rounded>) -> Rounded| {
            let sum = (0..S).fold(start, |sum, j| sum + Twice::real(h) * self.tableau.b[j] * of(&stages[j]));
            let weight = |j: usize| Rounded::nearest(h * self.tableau.b[j].to_f64());
            let rounding = (0..S).fold(Rounded::nearest(start.to_f64()), |sum, j| sum + weight(j) * bound(&bounded[j]));
            off.end = off.end.max((found - sum).to_f64().abs() / (f64::EPSILON * rounding.ulps()));
        };
        for k in 0..N {
            row(end.q[k], start.q[k], &|at| at.g * at.v[k], &|at| at.g * at.v[k]);
            row(end.p[k], start.p[k], &|at| at.force[k], &|at| at.force[k]);
        }
        if self.is_scaled {
            row(end.t, start.t, &|at| at.g, &|at| at.g);
            row(end.energy, start.energy, &|at| at.energy, &|at| at.energy);
        }
        if let Some(shift) = self.shift {
            // E0 = Σ b En − h Σ b (1 − c) (f·v − L_t).
            let one = Twice::real(1.0);
            let energy = (0..S).fold(Twice::real(0.0), |sum, j| {
                let (at, b, c) = (&stages[j], self.tableau.b[j], self.tableau.c[j]);
                sum + b * (at.hamiltonian - Twice::real(h) * (one - c) * at.power)
            });
            let added = Twice::real(shift) * (0..2 * S).fold(one, |power, _| power * Twice::real(h));
            let rounding = (0..S).fold(Rounded::nearest(start.energy.to_f64()), |sum, j| {
                let left = h * (1.0 - self.tableau.c[j].to_f64());
                sum + Rounded::nearest(self.tableau.b[j].to_f64())
                    * (bounded[j].hamiltonian - Rounded::nearest(left) * bounded[j].power)
            });
            // Terms of size |v·p| + |En| may cancel: a rounding of them is one.
            let size = stages.iter().fold(0.0, |size: f64, at| size.max(at.hamiltonian.to_f64().abs()));
            let size = size.max(before.p.iter().zip(&v).map(|(p, v)| (p * v).abs()).sum());
            off.energy = (energy - added - start.energy).to_f64().abs() / (f64::EPSILON * rounding.ulps().max(size));
        }
        Some(off)
    }

    /// The stages in numbers with a rounding bound: the sums for positions, the forces there, the resulting velocities,
    /// and the forces again.
    fn bounded(&self, before: &Node<N>, h: f64, stages: &[Stage<N, Twice>; S]) -> [Stage<N, Rounded>; S] {
        let system = self.system.convert::<Rounded>();
        let start = Start::<N, Rounded>::of(before);
        let nearest = |of: &SVector<Twice, N>| of.map(|number| Rounded::nearest(number.to_f64()));
        let noise = |of: Rounded| of - Rounded::exact(of.to_f64());
        let weight = |i: usize, j: usize| Rounded::nearest(h * self.tableau.a[i][j].to_f64());
        let mut velocities: [SVector<Rounded, N>; S] = core::array::from_fn(|i| nearest(&stages[i].v));
        let mut found: [Option<Stage<N, Rounded>>; S] = [None; S];
        for _ in 0..2 {
            let points: [_; S] = core::array::from_fn(|i| {
                let c = self.tableau.c[i].to_f64();
                let q = SVector::from_fn(|k, _| {
                    let rate = |j: usize| Rounded::nearest(stages[j].g.to_f64()) * velocities[j][k];
                    (0..S).fold(start.q[k], |sum, j| sum + weight(i, j) * rate(j))
                });
                let t = if self.is_scaled {
                    (0..S).fold(start.t, |sum, j| sum + weight(i, j) * Rounded::nearest(stages[j].g.to_f64()))
                } else {
                    start.t + Rounded::nearest(h * c)
                };
                let carried = (0..S)
                    .fold(start.energy, |sum, j| sum + weight(i, j) * Rounded::nearest(stages[j].energy.to_f64()));
                stage(&system, self.is_scaled, (t, q, velocities[i]), carried)
            });
            for i in 0..S {
                let missing = SVector::from_fn(|k, _| {
                    (0..S)
                        .fold(start.p[k] - points[i].1.momentum[k], |sum, j| sum + weight(i, j) * points[j].0.force[k])
                });
                let followed: SVector<Rounded, N> = points[i].1.mass.solve_unchecked(&missing);
                velocities[i] = nearest(&stages[i].v).zip_map(&followed, |v, followed| v + noise(followed));
                found[i] = Some(Stage { v: velocities[i], ..points[i].0 });
            }
        }
        found.map(|stage| stage.expect("two rounds"))
    }
}

/// Judges the steps of motions near a scene. `begin` starts a motion; `of` returns the length of its last step, in its
/// own time.
fn hunted<M, Y, const N: usize, const S: usize>(
    scene: &Scene<Y, N>,
    name: &str,
    judge: &Judge<'_, Y, N, S>,
    begin: impl Fn(State<N>, f64) -> Result<Run<M, Y, N>, StepError>,
    of: impl Fn(&Run<M, Y, N>) -> (f64, f64),
) where
    M: Method<Y, N>,
    Y: Convertible<N> + FixedStepping<N>,
{
    let (mut steps, mut motions, mut left_out, mut worst, mut reported) = (0, 0, 0, Off::default(), 0.0_f64);
    let mut draw = Sequence::new(7);
    while steps < STEPS && motions < MOST_MOTIONS {
        motions += 1;
        let mut near = |values: [f64; N]| SVector::from(values.map(|value| value * draw.within(0.8, 1.2)));
        let (q, v) = (near(scene.q), near(scene.v));
        let h = scene.h * 10_f64.powf(draw.within(-0.5, 0.5));
        let mut run = match begin(State::at(&scene.system, 0.0, q, v), h) {
            Ok(run) => run,
            Err(error) => {
                assert_typed(error);
                continue;
            }
        };
        for _ in 0..STEPS / MOTIONS {
            let before = *run.node();
            let Ok(v) = run.velocity().map_err(assert_typed) else { break };
            if let Err(error) = run.step() {
                assert_typed(error);
                break;
            }
            let (h, residual) = of(&run);
            reported = reported.max(residual);
            match judge.judge(&before, run.node(), h, v) {
                Some(off) => {
                    let larger = |a: f64, b: f64| if a > b || a.is_nan() { a } else { b };
                    worst = Off { end: larger(off.end, worst.end), energy: larger(off.energy, worst.energy) };
                    steps += 1;
                }
                None => left_out += 1,
            }
        }
    }
    println!("{}, {name}, {S} stages: {steps} steps, {left_out} left out, {worst:?}, reported {reported:.2}", Y::NAME);
    assert!(worst.end <= FLOOR && worst.energy <= FLOOR, "{}, {name}, {S} stages: {worst:?}", Y::NAME);
    assert!(reported <= ACCEPTED, "{}, {name}, {S} stages: {reported} reported", Y::NAME);
    // The search found steps, and not all differences are zero.
    assert!(
        steps >= STEPS / 4 && left_out <= steps && worst.end > 0.01,
        "{}, {name}: {steps} steps, {worst:?}",
        Y::NAME
    );
}

fn by_gauss_steps<Y: Convertible<N> + FixedStepping<N> + Motion<N>, const N: usize, const S: usize>(
    scene: &Scene<Y, N>,
) {
    let judge = Judge { system: &scene.system, tableau: Tableau::<S>::new(), is_scaled: false, shift: None };
    let begin = |state, h| scene.system.at_state(state).integrate(Gauss::<S>, h);
    hunted(scene, "Gauss steps", &judge, begin, |run| (run.h(), run.residual()));
}

fn by_energy_preserving_steps<Y, const N: usize, const S: usize>(scene: &Scene<Y, N>, constant: f64)
where
    Y: Convertible<N> + FixedStepping<N> + Motion<N>,
{
    // Large enough for steps near the scene, and small enough for the energy to matter.
    let state = State::at(&scene.system, 0.0, scene.q, scene.v);
    let density = vi_core::gauss::step_density::<_, N, S>(&scene.system, &state).expect("a density");
    let shift = 4.0 * density.abs();
    let judge =
        Judge { system: &scene.system, tableau: Tableau::<S>::new(), is_scaled: false, shift: Some(constant * shift) };
    let begin = |state, h| scene.system.at_state(state).integrate(EnergyPreservingGauss::<S>, h)?.with_shift(shift);
    hunted(scene, "energy-preserving Gauss steps", &judge, begin, |run| (run.h(), run.residual()));
}

fn hunt<Y: Convertible<N> + FixedStepping<N> + Motion<N>, const N: usize>(scene: Scene<Y, N>) {
    by_gauss_steps::<_, N, 2>(&scene);
    by_gauss_steps::<_, N, 5>(&scene);
    by_energy_preserving_steps::<_, N, 1>(&scene, 1.0 / 8.0);
    by_energy_preserving_steps::<_, N, 2>(&scene, 1.0 / 864.0);
}

scenes::each_system!(hunt);

/// Systems whose motion changes suddenly.
mod sudden {
    use super::{Convertible, FixedStepping, Motion, Scene, by_gauss_steps};

    fn hunt<Y: Convertible<N> + FixedStepping<N> + Motion<N>, const N: usize>(scene: Scene<Y, N>) {
        by_gauss_steps::<_, N, 3>(&scene);
    }

    crate::hunt::sudden::each_sudden!(hunt, hunt);
}

fn hunt_scaled<Y: Convertible<N> + FixedStepping<N> + TimeScale<N>, const N: usize>(scene: &Scene<Y, N>) {
    fn by<Y: Convertible<N> + FixedStepping<N> + TimeScale<N>, const N: usize, const S: usize>(scene: &Scene<Y, N>) {
        let judge = Judge { system: &scene.system, tableau: Tableau::<S>::new(), is_scaled: true, shift: None };
        let begin = |state, dtau| scene.system.at_state(state).integrate(Gauss::<S>.in_transformed_time(), dtau);
        hunted(scene, "steps in transformed time", &judge, begin, |run| (run.dtau(), run.residual()));
    }
    by::<_, N, 2>(scene);
    by::<_, N, 5>(scene);
}

lagrangian! {
    /// A varying mass, a time-dependent force, and a time scale that depends on everything.
    struct Clocked {
        param m = 1.3, k = 2.1, c = 0.2, b = 0.4;
        coord x, y;
        L = m * (1 + x^2) * dot(x)^2 / 2 + m * dot(y)^2 / 2 + b * x * dot(x) * dot(y) - k * (x^2 + 2 * y^2 + x^2 * y) / 2;
        force x = c * cos(2 * t) - c * dot(x);
        time_scale = 1 / (1 + x^2 + y^2) + sin(t) / 5;
        discretize midpoint;
    }
}

#[test]
fn kepler_in_scaled_time() {
    hunt_scaled(&scenes::kepler());
}

#[test]
fn all_in_scaled_time() {
    hunt_scaled(&Scene { system: Clocked::default(), q: [0.5, -0.3], v: [0.3, 0.6], h: 0.05, span: 1.0 });
}
