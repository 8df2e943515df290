//! Elimination by blocks, and in the impulses alone, against dense elimination.

use vi_core::lagrangian::Parameters;
use vi_core::linear::{Block, Rectangular};
use vi_core::motion::Motion;
use vi_core::real::Real;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Lagrangian, Starts, State, lagrangian};

lagrangian! {
    /// Six point masses on a chain of rods.
    struct Chain {
        param g = 9.81;
        coord r[6][2];
        constraint rod[0] = r[0] * r[0] - 1;
        constraint rod[i in 1..6] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - 1;
        L = sum(i in 0..6, (i + 1) * dot(r[i]) * dot(r[i]) / 2 - (i + 1) * g * r[i][1]);
    }
}

lagrangian! {
    /// Eight masses on a closed chain; the first one is held by a spring.
    struct Ring {
        coord r[8][2];
        constraint rod[i in 0..7] = (r[i + 1] - r[i]) * (r[i + 1] - r[i]) - 1;
        constraint rod[7] = (r[0] - r[7]) * (r[0] - r[7]) - 1;
        L = sum(i in 0..8, dot(r[i]) * dot(r[i]) / 2 - r[i][1]) - 3 * r[0] * r[0];
    }
}

lagrangian! {
    /// Three bodies: the second and the third hang at the first.
    struct Bodies {
        rotation R[3];
        coord x[3][3];
        constraint base = x[0] + turn(R[0], [0, 0, 1/2]);
        constraint ball[i in 1..3] = x[i] + turn(R[i], [0, 0, 1/2]) - x[0] - turn(R[0], [(2*i - 3)/4, 0, -1/2]);
        L = sum(i in 0..3, dot(x[i]) * dot(x[i]) / 2 + rate(R[i]) * rate(R[i]) / 20 - 9.81 * x[i][2]);
    }
}

lagrangian! {
    /// A slider y = sin x, which turns back at x = π/2, and others behind it.
    struct Cranks {
        coord x, y, z, w;
        constraint slider = y - sin(x), second = z - x * y, third = w - z^2;
        L = (dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(w)^2) / 2 - z;
    }
}

/// A chain of 100 rods.
mod long {
    vi_core::lagrangian! {
        pub(super) struct LongChain {
            param g = 9.81;
            coord r[100][2];
            constraint rod[0] = r[0] * r[0] - 1;
            constraint rod[i in 1..100] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - 1;
            L = sum(i in 0..100, dot(r[i]) * dot(r[i]) / 2 - g * r[i][1]);
        }
    }
}

/// A system without its solver of impulses; if `DENSE`, without its blocks too.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plain<S, const DENSE: bool>(S);

impl<const N: usize, T: Real, S: Lagrangian<N, T>, const DENSE: bool> Lagrangian<N, T> for Plain<S, DENSE> {
    vi_core::forward! { [N T S] self => &self.0; [] lagrangian_facts lagrangian rates }
}

impl<const N: usize, T: Real, S: Motion<N, T>, const DENSE: bool> Motion<N, T> for Plain<S, DENSE> {
    type Kind = S::Kind;
    type Mass = S::Mass;
    type PointMatrix = S::PointMatrix;
    const CONSTANT_MASS: bool = S::CONSTANT_MASS;
    const CONSTRAINTS: &'static [&'static str] = S::CONSTRAINTS;
    const HOLONOMIC: usize = S::HOLONOMIC;
    const BLOCKS: &'static [Block] = if DENSE { &[] } else { S::BLOCKS };

    vi_core::forward! { [N T S] self => &self.0; [] motion reactions }
}

impl<T: Real, S: Parameters<T>, const DENSE: bool> Parameters<T> for Plain<S, DENSE> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        self.0.parameter_mut(name)
    }
}

impl<const N: usize, S: Convertible<N>, const DENSE: bool> Convertible<N> for Plain<S, DENSE> {
    type In<T: Real> = Plain<S::In<T>, DENSE>;

    fn convert<T: Real>(&self) -> Self::In<T> {
        Plain(self.0.convert())
    }
}

/// The state after steps of length 0.02 from a state near this one.
fn end<S, const N: usize, const STAGES: usize>(system: S, near: [[f64; N]; 2], count: u32) -> State<N>
where
    S: Convertible<N>,
{
    let [q, v] = near;
    let start = State::projected(&system, 0.0, q, v).unwrap_or_else(|error| panic!("{error}")).state;
    let run = system.at_state(start).integrate(Gauss::<STAGES>, 0.02);
    let mut run = run.unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..count {
        run.step().unwrap_or_else(|error| panic!("{error}"));
        // Terms cancel inside of the momenta of bodies. Measured: at most 4.9 there, and 1.0 for points.
        assert!(run.residual() <= 16.0, "{}", run.residual());
    }
    run.state()
}

/// Largest difference between steps by blocks and dense steps, relative to the size of the state.
fn difference<S, const N: usize, const STAGES: usize>(system: S, near: [[f64; N]; 2]) -> f64
where
    S: Convertible<N>,
{
    let dense = end::<_, N, STAGES>(Plain::<_, true>(system), near, 50);
    let size = dense.q.amax().max(dense.p.amax());
    let off = |state: State<N>| (state.q - dense.q).amax().max((state.p - dense.p).amax()) / size;
    off(end::<_, N, STAGES>(Plain::<_, false>(system), near, 50)).max(off(end::<_, N, STAGES>(system, near, 50)))
}

fn check<S, const N: usize>(system: S, near: [[f64; N]; 2], bound: f64)
where
    S: Convertible<N>,
{
    assert!(S::BLOCKS.len() > 1, "{:?}", S::BLOCKS);
    let found =
        [difference::<S, N, 1>(system, near), difference::<S, N, 2>(system, near), difference::<S, N, 3>(system, near)];
    println!("{} {found:?}", S::NAME);
    assert!(found.iter().all(|difference| *difference <= bound), "{found:?}");
}

/// Coordinates and velocities of a straight chain that turns.
fn straight<const N: usize>() -> [[f64; N]; 2] {
    let along = |x: f64, y: f64| {
        core::array::from_fn(|i| f64::from(u32::try_from(i / 2 + 1).unwrap_or(0)) * if i % 2 == 0 { x } else { y })
    };
    [along(0.6, -0.8), along(0.08, 0.06)]
}

/// A ring of eight, and velocities that bend it.
fn ring() -> [[f64; 16]; 2] {
    let angle = |i: usize| core::f64::consts::FRAC_PI_4 * f64::from(u32::try_from(i / 2).unwrap_or(0));
    let q = core::array::from_fn(|i| 1.3 * if i % 2 == 0 { angle(i).cos() } else { angle(i).sin() });
    [q, core::array::from_fn(|i| (2.0 * angle(i)).cos() * if i % 2 == 0 { 0.4 } else { -0.3 })]
}

fn bodies() -> [[f64; 21]; 2] {
    let (mut q, mut v) = ([0.0; 21], [0.0; 21]);
    for i in 0..3 {
        // Quaternions near (0.8, 0.6, 0, 0).
        (q[4 * i], q[4 * i + 1], q[4 * i + 2]) = (0.8, 0.6, 0.1 * f64::from(u32::try_from(i).unwrap_or(0)));
        v[4 * i + 2] = 0.5;
    }
    for (i, x) in [[0.0, 0.4, -0.2], [-0.2, 1.3, -0.4], [0.3, 1.3, -0.4]].iter().enumerate() {
        q[12 + 3 * i..15 + 3 * i].copy_from_slice(x);
    }
    [q, v]
}

#[test]
fn blocks_and_dense_elimination_agree() {
    // Measured: at most 3.8e-16 for chain, ring and bodies, 1.5e-16 for the cranks, whose pivot vanishes.
    check(Chain::default(), straight(), 1e-15);
    check(Ring::default(), ring(), 1e-15);
    check(Bodies::default(), bodies(), 2e-15);
    // The pivot of the slider vanishes on the way: at x = π/2 the constraint does not hold x.
    let half = core::f64::consts::FRAC_PI_2;
    check(Cranks::default(), [[half, 1.0, half, half * half], [0.0; 4]], 2e-15);
    check(Cranks::default(), [[half - 0.3, 0.95, 1.2, 1.5], [0.9, 0.3, 0.0, 0.0]], 2e-15);
}

/// The largest constraint over a rounding of its terms.
fn off<S: Motion<N>, const N: usize>(system: &S, state: &State<N>) -> f64 {
    let values = system.constraints(state.t, &state.q);
    let (gradients, _) = system.constraint_gradients(state.t, &state.q);
    values.as_ref().iter().zip(gradients.rows()).fold(0.0, |worst, (value, row)| {
        let terms = row.iter().map(|(column, entry)| (entry * state.q[column]).abs()).sum::<f64>();
        worst.max(value.abs() / (f64::EPSILON * terms))
    })
}

/// The largest constraint of 1000 steps, over a rounding of its terms.
fn worst<S, const N: usize>(system: S, near: [[f64; N]; 2]) -> f64
where
    S: Convertible<N>,
{
    let [q, v] = near;
    let start = State::projected(&system, 0.0, q, v).unwrap_or_else(|error| panic!("{error}")).state;
    let run = system.at_state(start).integrate(Gauss::<1>, 0.01);
    let mut run = run.unwrap_or_else(|error| panic!("{error}"));
    (0..1000).fold(0.0, |worst, _| {
        let state = run.step().unwrap_or_else(|error| panic!("{error}"));
        f64::max(worst, off(&system, &state))
    })
}

#[test]
fn long_chains_and_loops_stay_on_their_constraints() {
    // Matrices of 200 coordinates overflow the stack of a test.
    let on_a_large_stack = std::thread::Builder::new().stack_size(1 << 25).spawn(|| {
        let chain = worst(long::LongChain::default(), straight::<200>());
        (chain, worst(Ring::default(), ring()), worst(Bodies::default(), bodies()))
    });
    let (chain, ring, bodies) = on_a_large_stack.expect("a thread").join().expect("no panic");
    println!("{chain} {ring} {bodies}");
    // Measured: 3.9 and 1.0; bodies 2.7, from eight other starts 1.0 to 3.9: their motion amplifies roundings.
    assert!(chain <= 5.0 && ring <= 2.0 && bodies <= 5.0, "{chain} {ring} {bodies}");
}

#[test]
fn parameters_and_states_reach_the_solver_of_impulses() {
    // Gradients and masses of the last step do not serve a run that went on from elsewhere.
    let [q, v] = straight::<12>();
    let begin = |system: Chain| {
        let start = State::projected(&system, 0.0, q, v).unwrap_or_else(|error| panic!("{error}")).state;
        system.at_state(start).integrate(Gauss::<1>, 0.02).unwrap_or_else(|error| panic!("{error}"))
    };
    let mut run = begin(Chain::default());
    run.step().unwrap_or_else(|error| panic!("{error}"));
    run.set_parameters(|system| system.g = 1.62).unwrap_or_else(|error| panic!("{error}"));
    let state = run.state();
    let mut fresh = Chain { g: 1.62 }.at_state(state).integrate(Gauss::<1>, 0.02).expect("a start");
    let [changed, fresh] = [run.step(), fresh.step()].map(|state| state.unwrap_or_else(|error| panic!("{error}")));
    assert!((changed.q - fresh.q).amax() < 1e-14 && (changed.p - fresh.p).amax() < 1e-13);
    let mut other = begin(Chain::default());
    let start = other.state();
    other.step().unwrap_or_else(|error| panic!("{error}"));
    other.set_state(start).unwrap_or_else(|error| panic!("{error}"));
    let again = other.step().unwrap_or_else(|error| panic!("{error}"));
    let first = begin(Chain::default()).step().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((again.q, again.p), (first.q, first.p));
}
