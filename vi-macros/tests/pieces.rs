//! A system in pieces computes what it computes whole, bit by bit.
//!
//! `pieces/pendula.rs` is the expansion in functions of at most 50 operations; it is in the repository to be read. After a
//! change of the compiler, `UPDATE_EXPANDED=1 cargo test -p vi-macros --test pieces` writes it anew.

use vi_core::linear::Matrix;
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, Node, SVector, Stepping};

/// Operations that a function may hold.
const LIMIT: usize = 50;

/// The system, and its text.
macro_rules! system {
    ($($tokens:tt)*) => {
        ::vi_core::lagrangian! { $($tokens)* }
        const TEXT: &str = stringify!($($tokens)*);
    };
}

system! {
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

#[rustfmt::skip]
#[allow(clippy::pedantic, dead_code, unreachable_pub, reason = "the items of a library")]
#[path = "pieces/pendula.rs"]
mod in_pieces;

fn expansion() -> String {
    let system = vi_codegen::syntax::parse::system(TEXT.parse().expect("tokens")).expect("a right system");
    let derived = vi_codegen::derive(system).expect("a right system");
    let vi_codegen::Derived { model, system, program, findings } = &derived;
    vi_codegen::pretty::text(vi_codegen::emit::items(model, system, program, findings, LIMIT)).expect("Rust")
}

#[test]
fn the_documented_pieces_are_todays() {
    let (path, today) = (concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pieces/pendula.rs"), expansion());
    if std::env::var_os("UPDATE_EXPANDED").is_some() {
        std::fs::write(path, &today).expect("the file can be written");
    }
    let documented = std::fs::read_to_string(path).expect("the documented expansion");
    let line = documented.lines().zip(today.lines()).position(|(old, new)| old != new);
    assert!(documented == today, "pendula.rs differs from line {line:?} on; UPDATE_EXPANDED=1 writes it anew");
}

#[test]
fn no_function_is_longer_than_the_limit() {
    let text = expansion();
    let counts = text.lines().filter_map(|line| line.trim().strip_prefix("/// Part ")?.split(' ').nth(3)?.parse().ok());
    let counts: Vec<usize> = counts.collect();
    assert!(counts.len() > 10, "{} pieces", counts.len());
    assert!(counts.iter().all(|count| *count <= LIMIT), "{counts:?}");
}

/// Bits of everything that the functions of a system give at one place.
fn bits<S: Lagrangian<2> + DiscreteLagrangian<2> + Stepping<2>>(system: &S) -> Vec<u64> {
    let (q, v) = (SVector::from([0.3, -0.2]), SVector::from([0.7, 0.1]));
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
    let (magnitudes, increment) = (system.magnitudes(&node, h, &v), system.increment(&node, h, &v));
    let mut numbers = vec![system.lagrangian(t, &q, &v), system.energy(t, &q, &v), extended.energy_residual];
    numbers.extend([system.ld(&interval), system.d1_ld(&interval), system.d3_ld(&interval)]);
    numbers.extend([system.gd_minus(&interval), system.gd_plus(&interval)]);
    numbers.extend([system.step_density(t, &q, &v).expect("a density"), extended.energy_dh]);
    numbers.extend([magnitudes.energy_residual, increment.energy]);
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
        magnitudes.residual,
        increment.momentum,
    ];
    numbers.extend(vectors.iter().flat_map(|vector| vector.iter()));
    numbers.extend(equation.jacobian.dense().iter().chain(extended.momentum.jacobian.dense().iter()));
    numbers.into_iter().map(f64::to_bits).collect()
}

#[test]
fn the_pieces_compute_what_the_whole_does() {
    let (whole, pieces) = (Pendula::default(), in_pieces::Pendula::default());
    assert_eq!(bits(&whole), bits(&pieces));
    // Another parameter is another result: what is compared is no constant.
    assert_ne!(bits(&Pendula { k: 0.8, ..whole }), bits(&pieces));
}
