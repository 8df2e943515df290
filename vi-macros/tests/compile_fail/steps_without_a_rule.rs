use vi_core::prelude::*;

lagrangian! {
    struct Kepler {
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 + 1 / sqrt(x^2 + y^2);
    }
}

fn main() {
    let kepler = Kepler::default();
    let start = kepler.at(0.0, [0.4, 0.0], [0.0, 2.0]);
    let _ = start.integrate(Gauss::<8>, 0.1);
    let _ = start.integrate(FixedStep, 0.01);
    let _ = start.integrate(EnergyPreserving, 0.01);
    many(kepler);
    slots(kepler);
}

/// As an ensemble asks.
fn many<const N: usize>(_: impl vi_core::stepping::Batch<N>) {}

fn slots<const N: usize>(_: impl vi_core::DiscreteLagrangian<N>) {}
