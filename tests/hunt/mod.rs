//! Searches for accepted steps that do not satisfy their equations, in motions that change suddenly.
//!
//! In: the systems of `sudden` and of the catalogue, from random states with random steps. The residual of each step is
//! recomputed here from the previous node and the accepted velocity. It must be at the floor, row by row:
//!
//! ```text
//! |r_i| ≤ 4 ε s_i        s_i the largest of |p0_i| + |p1_i − p0_i|, the sum of the absolute values of the terms of r_i,
//!                        and the rounding bound of r_i from running error analysis
//! ```
//!
//! and the energy by its own rounding, which for stiff steps is far below that of the rows.
//!
//! The residual reported by the integrator must equal this number. `check::steps`, which runs first, verifies that it
//! is the residual of the slots. A motion may end with a typed error; then another one starts.

mod stages;
mod sudden;

use crate::support::Sequence;
use crate::support::ending::assert_typed;
use crate::support::scenes::Scene;
use vi_core::check::{self, Checked, Place};
use vi_core::node::Node;
use vi_core::stepping::{EnergyStepping, FixedStepping};
use vi_core::{Composition, EnergyPreserving, FixedStep, SVector, Starts, State, lagrangian};

/// Steps of each system by each integrator.
const STEPS: usize = if cfg!(feature = "long") { 40_000 } else { 8000 };
/// Minimum number of motions of each system with each integrator.
const MOTIONS: usize = 16;
/// Maximum number of motions: some states have no step.
const MOST_MOTIONS: usize = 2_000;
/// Maximum residual of a solved row, in roundings. Measured: 3.995, at the acceptance limit.
const FLOOR: f64 = 4.0;

/// Results for one system and integrator.
#[derive(Debug, Default)]
struct SearchResult {
    steps: usize,
    motions: usize,
    /// Steps whose residual exceeds the floor of the first two scales, because its rounding is larger.
    by_analysis: usize,
    worst: f64,
}

impl SearchResult {
    fn add(&mut self, row: &Row) {
        self.by_analysis += usize::from(row.plain > FLOOR);
        self.worst = self.worst.max(row.worst);
    }

    fn finish(&self, name: &str, integrator: &str) {
        println!("{name}, {integrator}: {self:?}");
        assert!(self.worst <= FLOOR, "{name}, {integrator}: {self:?}");
        // The search found steps, and not all residuals are zero.
        assert!(self.steps >= STEPS / 10 && self.worst > 0.1, "{name}, {integrator}: {self:?}");
    }
}

/// The largest residual of a step in roundings.
#[derive(Debug)]
struct Row {
    /// By each of the three scales.
    by: [f64; 3],
    /// With the larger of the first two in each row.
    plain: f64,
    /// With the largest in each row.
    worst: f64,
}

impl Row {
    fn new(rows: impl Iterator<Item = (f64, [f64; 3])>) -> Self {
        let mut row = Self { by: [0.0; 3], plain: 0.0, worst: 0.0 };
        for (residual, scales) in rows {
            let by = scales.map(|scale| if residual == 0.0 { 0.0 } else { residual.abs() / (f64::EPSILON * scale) });
            assert!(by.iter().all(|roundings| !roundings.is_nan()), "{residual:e} by {scales:?}");
            row.by = core::array::from_fn(|scale| row.by[scale].max(by[scale]));
            row.plain = row.plain.max(by[0].min(by[1]));
            row.worst = row.worst.max(by[0].min(by[1]).min(by[2]));
        }
        row
    }

    /// The momentum rows of the step of length h with velocity v from a node.
    fn of_momentum<const N: usize, S: FixedStepping<N>>(
        system: &S,
        node: &Node<N>,
        h: f64,
        v: &SVector<f64, N>,
    ) -> Self {
        let at = system.momentum_residual(node, h, v);
        let analysis = system.momentum_rounding(node, h, v);
        Self::new((0..N).map(|i| {
            let own = node.p[i].abs() + at.increment[i].abs();
            (at.residual[i], [own, at.scale[i], analysis[i]])
        }))
    }

    /// All rows of an energy-preserving step.
    fn of_both<const N: usize, S: EnergyStepping<N>>(system: &S, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> Self {
        let at = system.extended_residual(node, h, v);
        let analysis = system.extended_rounding(node, h, v);
        let momentum = (0..N).map(|i| {
            let own = node.p[i].abs() + at.increment.momentum[i].abs();
            (at.residual[i], [own, at.scale[i], analysis.residual[i]])
        });
        let own = node.energy.abs() + at.increment.energy.abs() + v.component_mul(&node.p).abs().sum();
        let combined = (at.energy_residual, [own, at.energy_scale, analysis.energy_residual]);
        let mut row = Self::new(momentum.chain([combined]));
        // The energy e = D1 L_d + g_d⁻ − E0, relative to its own rounding, or with momentum rows at the first floor: e
        // = c + v·r.
        let kept = (node.energy + at.increment.energy) + node.energy_low;
        let energy = (system.discrete_energy(node, h, v) - kept).abs() / f64::EPSILON;
        let work = v.component_mul(&at.increment.momentum).abs().sum();
        let of_rows = FLOOR * (own + work);
        // A rounding of the terms of L is also one of this evaluation.
        row.worst = row.worst.max(FLOOR * energy / (of_rows + FLOOR * analysis.energy + at.energy_scale));
        row
    }

    /// Whether the reported residual equals this one.
    fn is(&self, reported: f64) -> bool {
        self.by.iter().any(|roundings| (roundings - reported).abs() <= 1e-12 * reported)
    }
}

/// A start near the scene, and a step.
fn start<const N: usize, S: FixedStepping<N>>(scene: &Scene<S, N>, draw: &mut Sequence) -> (State<N>, f64) {
    let mut near = |values: [f64; N]| SVector::from(values.map(|value| value * draw.within(0.7, 1.3)));
    let (q, v) = (near(scene.q), near(scene.v));
    let h = scene.h * 10_f64.powf(draw.within(-1.0, 0.5));
    (State::at(&scene.system, 0.0, q, v), h)
}

/// Takes motions of an integrator until there are enough steps; `motion` takes one and reports each step.
fn hunted<const N: usize, S: FixedStepping<N>>(
    scene: &Scene<S, N>,
    limit: usize,
    mut motion: impl FnMut(State<N>, f64, usize, &mut SearchResult),
) -> SearchResult {
    let (mut found, mut draw) = (SearchResult::default(), Sequence::new(5));
    while found.steps < limit && found.motions < MOST_MOTIONS {
        let (state, h) = start(scene, &mut draw);
        motion(state, h, limit / MOTIONS, &mut found);
        found.motions += 1;
    }
    found
}

fn by_fixed_steps<const N: usize, S: FixedStepping<N>>(scene: &Scene<S, N>) {
    let found = hunted(scene, STEPS, |state, h, steps, found| {
        let Ok(mut run) = scene.system.at_state(state).integrate(FixedStep, h).map_err(assert_typed) else { return };
        for _ in 0..steps {
            let before = *run.node();
            if let Err(error) = run.step() {
                return assert_typed(error);
            }
            let row = Row::of_momentum(&scene.system, &before, h, &run.v());
            assert!(row.is(run.residual()), "{}: {} reported, {row:?}", S::NAME, run.residual());
            found.add(&row);
            found.steps += 1;
        }
    });
    found.finish(S::NAME, "fixed steps");
}

fn by_energy_preserving_steps<const N: usize, S: EnergyStepping<N>>(scene: &Scene<S, N>) {
    let found = hunted(scene, STEPS, |State { t, q, p }, h, steps, found| {
        let Ok(v) = (State { t, q, p }).velocity(&scene.system).map_err(assert_typed) else { return };
        let run = EnergyPreserving::from_midpoint(scene.system, t, q, v, h);
        let Ok(mut run) = run.map_err(assert_typed) else { return };
        for _ in 0..steps {
            let before = *run.node();
            let step = match run.detailed_step() {
                Ok(step) => step,
                Err(error) => return assert_typed(error),
            };
            let row = Row::of_both(&scene.system, &before, run.h(), &run.v());
            assert!(row.is(step.residual), "{}: {} reported, {row:?} {step:?}", S::NAME, step.residual);
            found.add(&row);
            found.steps += 1;
        }
    });
    found.finish(S::NAME, "energy-preserving steps");
}

fn by_substeps<const N: usize, S: FixedStepping<N>>(scene: &Scene<S, N>) {
    for scheme in [Composition::TRIPLE_JUMP_4, Composition::KAHAN_LI_8] {
        let found = hunted(scene, STEPS / scheme.weights.len(), |state, h, steps, found| {
            let run = scene.system.at_state(state).integrate(scheme, h);
            let Ok(mut run) = run.map_err(assert_typed) else { return };
            for _ in 0..steps {
                let mut node = *run.node();
                if let Err(error) = run.step() {
                    return assert_typed(error);
                }
                for (weight, v) in scheme.weights.iter().zip(run.velocities()) {
                    let h = h * weight;
                    found.add(&Row::of_momentum(&scene.system, &node, h, &v));
                    let increment = scene.system.momentum_residual(&node, h, &v).increment;
                    node.advance(h, &v, &increment);
                }
                // The substeps are the accepted ones.
                assert_eq!(node.state(), run.state());
                found.steps += 1;
            }
        });
        let found = SearchResult { steps: found.steps * scheme.weights.len(), ..found };
        found.finish(S::NAME, scheme.name);
    }
}

fn hunt<const N: usize, S: Checked<N> + EnergyStepping<N>>(scene: Scene<S, N>) {
    by_energy_preserving_steps(&scene);
    hunt_fixed_steps(scene);
}

fn hunt_fixed_steps<const N: usize, S: Checked<N>>(scene: Scene<S, N>) {
    let place = Place { t: 0.0, q: scene.q.into(), v: scene.v.into(), h: scene.h / 10.0 };
    check::steps(&scene.system, &place).unwrap_or_else(|failure| panic!("{failure}"));
    by_fixed_steps(&scene);
    by_substeps(&scene);
}

sudden::each_sudden!(hunt, hunt_fixed_steps);

lagrangian! {
    /// A rod modelled as a spring of 10^6 to 10^12 times its weight.
    struct Rod {
        param k = 1e12;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - k * (sqrt(x^2 + y^2) - 1)^2 / 2 - 9.81 * y;
        discretize midpoint;
    }
}

/// The rows of stiff steps are only as accurate as their forces; the energy is more accurate.
#[test]
fn stiff_steps_keep_the_energy() {
    let mut worst = 0.0_f64;
    for exponent in 4..=13 {
        let system = Rod { k: 10_f64.powi(exponent) };
        let run = EnergyPreserving::from_midpoint(system, 0.0, [1.0, 0.0], [0.0, 0.1], 0.01);
        let mut run = run.expect("a start");
        let mut steps = 0;
        while steps < 200 {
            let before = *run.node();
            let step = match run.detailed_step() {
                Ok(step) => step,
                Err(error) => {
                    assert_typed(error);
                    break;
                }
            };
            let row = Row::of_both(&system, &before, run.h(), &run.v());
            assert!(row.worst <= FLOOR && row.is(step.residual), "k = {:e}: {row:?} {step:?}", system.k);
            let (_, q, v) = step.midpoint;
            let energy = v.norm_squared() / 2.0 + system.k * (q.norm() - 1.0).powi(2) / 2.0 + 9.81 * q[1];
            worst = worst.max((energy - step.energy).abs());
            steps += 1;
        }
        // It ends when the rod has swung down and the density vanishes, or when rows and energy no longer converge
        // together.
        assert!(steps >= 5, "k = {:e}: {steps} steps", system.k);
    }
    println!("energies off by {worst:.1e}");
    // Measured: 1.5e-14. Before the energy had its own test: 4.8e-7.
    assert!(worst <= 3e-14, "{worst:e}");
}

mod catalogue {
    crate::support::scenes::each_system!(super::hunt);
}
