//! A system in loops, or in pieces, computes what it computes whole, bit by bit.
//!
//! The attribute `vi_limit` of the struct limits the operations of a function.

use vi_core::linear::Matrix;
use vi_core::node::Node;
use vi_core::stepping::EnergyStepping;
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector};

/// A system whole, and the same system in functions of at most so many operations.
macro_rules! system {
    ($name:ident, $limit:literal, $($tokens:tt)*) => {
        mod $name {
            ::vi_core::lagrangian! { $($tokens)* }
            pub(crate) const CUT: &str = stringify!(#[vi_limit($limit)] $($tokens)*);

            pub(crate) mod cut {
                ::vi_core::lagrangian! { #[vi_limit($limit)] $($tokens)* }
            }
        }
    };
}

system! {
    pendula, 50,
    /// Two coupled pendula, driven and damped: matrices, forces and sums over all coordinates.
    pub struct Pendula {
        const N = 2;
        param m = 1.2, k = 0.7, b = 0.1;
        coord q[N];
        let coupling = dot(q[0]) * dot(q[1]) * cos(q[0] - q[1]) / 4 - k * (q[0] - q[1])^2 / 2;
        L = m * sum(i in 0..N, dot(q[i])^2) + coupling + (1 + sin(t) / 3) * sum(i in 0..N, cos(q[i]));
        dissipation = b * sum(i in 0..N, dot(q[i])^2) / 2;
        discretize midpoint;
    }
}

system! {
    chain, 300,
    /// Pendula in a row, driven: what is the same for all of them is a loop.
    pub struct Chain {
        const N = 10;
        param m = 1.2, k = 0.7;
        coord q[N];
        let springs = k * sum(i in 1..N, (q[i] - q[i - 1])^4) / 4;
        L = m * sum(i in 0..N, dot(q[i])^2) / 2 - springs + (1 + sin(t) / 3) * sum(i in 0..N, cos(q[i]));
        force q[i in 0..N - 1] = k * cos(q[i]);
        discretize midpoint;
    }
}

fn expansion(text: &str) -> String {
    let system = vi_codegen::syntax::parse::system(text.parse().expect("tokens")).expect("a right system");
    let derivations = vi_codegen::derive(&system).expect("a right system");
    vi_codegen::pretty::text(vi_codegen::items(&derivations)).expect("Rust")
}

#[test]
fn no_function_is_longer_than_the_limit() {
    let text = expansion(pendula::CUT);
    let counts = text.lines().filter_map(|line| line.trim().strip_prefix("/// Part ")?.split(' ').nth(3)?.parse().ok());
    let counts: Vec<usize> = counts.collect();
    assert!(counts.len() > 10, "{} pieces", counts.len());
    assert!(counts.iter().all(|count| *count <= 50), "{counts:?}");
    let text = expansion(chain::CUT);
    assert!(!text.contains("vi_limit"));
    let (loops, sums) = (text.matches("for i in 0..").count(), text.matches(".fold(").count());
    assert!(loops > 50 && sums > 10 && !text.contains("/// Part "), "{loops} loops, {sums} sums");
}

/// Bits of everything that the functions of a system give at one place.
fn bits<const N: usize, S>(system: &S) -> Vec<u64>
where
    S: Lagrangian<N> + DiscreteLagrangian<N> + EnergyStepping<N>,
{
    let mut place = -1.0;
    let q: SVector<f64, N> = SVector::from_fn(|_, _| {
        place += 1.0;
        0.3 - 0.5 * place
    });
    let v = q.map(|angle| 1.2 * angle + 0.34);
    let (t, h) = (0.6, 0.05);
    let interval = Interval { t0: t, q0: q, t1: t + h, q1: q + h * v };
    let node = Node {
        t,
        t_low: 1e-17,
        q,
        q_low: 1e-17 * v,
        p: system.momentum(t, &q, &v),
        p_low: 1e-17 * q,
        energy: system.energy(t, &q, &v),
        energy_low: 1e-17,
    };
    let (equation, extended) = (system.momentum_equation(&node, h, &v), system.extended_system(&node, h, &v));
    let (measured, both) = (system.momentum_residual(&node, h, &v), system.extended_residual(&node, h, &v));
    let mut numbers = vec![system.lagrangian(t, &q, &v), system.energy(t, &q, &v), extended.energy_residual];
    numbers.extend([system.ld(&interval), system.d1_ld(&interval), system.d3_ld(&interval)]);
    numbers.extend([system.gd_minus(&interval), system.gd_plus(&interval)]);
    numbers.extend([system.step_density(t, &q, &v).expect("a density"), extended.energy_dh]);
    numbers.extend([both.energy_residual, both.increment.energy]);
    let vectors = [
        system.momentum(t, &q, &v),
        system.force(t, &q, &v),
        system.acceleration(t, &q, &v).expect("an acceleration"),
        system.d2_ld(&interval),
        system.d4_ld(&interval),
        system.fd_minus(&interval),
        system.fd_plus(&interval),
        equation.residual,
        extended.momentum.residual,
        extended.residual_dh,
        extended.energy_dv,
        measured.residual,
        measured.increment,
        both.residual,
        both.increment.momentum,
    ];
    numbers.extend(vectors.iter().flat_map(|vector| vector.iter()));
    numbers.extend(equation.jacobian.dense().iter().chain(extended.momentum.jacobian.dense().iter()));
    numbers.into_iter().map(f64::to_bits).collect()
}

#[test]
fn the_pieces_compute_what_the_whole_does() {
    let (whole, pieces) = (pendula::Pendula::default(), pendula::cut::Pendula::default());
    assert_eq!(bits(&whole), bits(&pieces));
    // Another parameter is another result: what is compared is no constant.
    assert_ne!(bits(&pendula::Pendula { k: 0.8, ..whole }), bits(&pieces));
}

#[test]
fn the_loops_compute_what_the_whole_does() {
    let (whole, loops) = (chain::Chain::default(), chain::cut::Chain::default());
    assert_eq!(bits(&whole), bits(&loops));
    assert_ne!(bits(&chain::Chain { k: 0.8, ..whole }), bits(&loops));
}
