//! Equilibria need evidence: forces that underflow, or vanish far away, are none.

use vi_core::prelude::*;
use vi_core::{SVector, StepError, lagrangian};

lagrangian! {
    /// A molecule of two atoms.
    struct Morse {
        coord x;
        L = dot(x)^2 / 2 - (1 - exp(-x))^2;
    }
}

lagrangian! {
    /// A hill that is flat far outside, and a cart with friction.
    struct Hill {
        param c = 0.3;
        coord x, y, cart;
        L = (dot(x)^2 + dot(y)^2 + dot(cart)^2) / 2 - exp(-(x^2 + y^2));
        force cart = -c * dot(cart);
    }
}

lagrangian! {
    /// A planet.
    struct Planet {
        param mu = 1.3;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 + mu / sqrt(x^2 + y^2);
    }
}

lagrangian! {
    /// The molecule on an inclined line.
    struct Bead {
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - (1 - exp(-x))^2;
        constraint line = y - 0.1 * x;
    }
}

fn is_none<E>(found: &Result<E, StepError>) -> bool {
    matches!(found, Err(StepError::NoEquilibrium { .. } | StepError::FreeMotion { .. } | StepError::Singular { .. }))
}

#[test]
fn forces_that_underflow_are_no_equilibrium() {
    let near = Morse::default().equilibrium(0.0, [0.2]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(near.q[0].abs() < 1e-16 && (near.stiffness[0] - 2.0).abs() < 1e-15, "{near:?}");
    let near = Bead::default().equilibrium(0.0, [0.2, 0.0]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(near.q.amax() < 1e-16 && near.free_motions.is_empty(), "{near:?}");
    for x in [3.0, 100.0, 690.0, 700.0, 720.0, 742.0, 743.5, 744.5, 745.2, 800.0, 1e5] {
        assert!(is_none(&Morse::default().equilibrium(0.0, [x])), "{x}");
        assert!(is_none(&Bead::default().equilibrium(0.0, [x, 0.1 * x])), "{x}");
    }
    let hill = Hill::default();
    let top = hill.equilibrium(0.0, [0.1, -0.2, 7.0]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(top.q[0].abs() + top.q[1].abs() < 1e-15 && top.q[2].to_bits() == 7.0_f64.to_bits(), "{top:?}");
    assert_eq!(top.free(), [false, false, true]);
    for [x, y] in [[3.0, 2.0], [6.0, 1.0], [19.0, 20.0], [27.0, 3.0], [30.0, 0.0], [0.0, -1e3]] {
        assert!(is_none(&hill.equilibrium(0.0, [x, y, 0.0])), "{x} {y}");
    }
}

#[test]
fn an_iteration_that_leaves_its_guess_ends() {
    let guess = SVector::from([1.0, 0.3]);
    let failure = Planet::default().equilibrium(0.0, guess).expect_err("no equilibrium");
    let StepError::NoEquilibrium { force, .. } = failure else { panic!("{failure}") };
    // At a distance of 1e4 at most.
    assert!(force.abs() > 1e-9 && force.abs() < 1.3, "{failure}");
}
