//! Lift-off at a reaction of zero, free flight, and a plastic impact onto another constraint.

use vi_core::prelude::{Event, Moment};
use vi_core::{Gauss, Starts, State, lagrangian};

lagrangian! {
    /// A particle on a sphere.
    struct OnSphere {
        param m = 1.3, g = 9.81, r = 2.0;
        coord x, y, z;
        L = m / 2 * (dot(x)^2 + dot(y)^2 + dot(z)^2) - m * g * z;
        constraint sphere = (x^2 + y^2 + z^2 - r^2) / 2;
    }
}

lagrangian! {
    /// The particle in the air.
    struct Free {
        param m = 1.3, g = 9.81;
        coord x, y, z;
        L = m / 2 * (dot(x)^2 + dot(y)^2 + dot(z)^2) - m * g * z;
    }
}

lagrangian! {
    /// The particle on a table that moves up.
    struct OnTable {
        param m = 1.3, g = 9.81, height = -3.0, speed = 0.0;
        coord x, y, z;
        L = m / 2 * (dot(x)^2 + dot(y)^2 + dot(z)^2) - m * g * z;
        constraint table = z - height - speed * t;
    }
}

#[test]
fn a_particle_leaves_a_sphere_flies_and_is_caught() {
    let (sphere, free, table) = (OnSphere::default(), Free::default(), OnTable::default());
    // At rest at a hundredth of a radian from the top, in the plane y = 0.75 x.
    let (sine, cosine) = 0.01_f64.sin_cos();
    let start = [0.8 * 2.0 * sine, 0.6 * 2.0 * sine, 2.0 * cosine];
    let start = State::projected(&sphere, 0.0, start, [0.0; 3]).unwrap_or_else(|failure| panic!("{failure}")).state;
    let mut run = sphere.at_state(start).integrate(Gauss::<4>, 0.02).unwrap_or_else(|failure| panic!("{failure}"));
    // The sphere pushes outwards; the reaction is along the gradient q.
    let off = Event::falling(move |at: &Moment<3>| {
        let state = State::at(&sphere, at.t, at.q, at.v);
        state.reaction(&sphere).map_or(f64::NAN, |[reaction]| reaction)
    });
    let met = run.until_event(off, 10.0).unwrap_or_else(|failure| panic!("{failure}")).expect("lift-off");
    // m v²/r = m g cos φ and v² = 2 g r (cos φ0 − cos φ).
    let height = met.state.q[2] / 2.0;
    println!("lift-off {:e}", height - cosine * 2.0 / 3.0);
    // Measured: 0.
    assert!((height - cosine * 2.0 / 3.0).abs() < 1e-13, "{height}");
    assert!(met.state.reaction(&sphere).expect("regular")[0].abs() < 1e-8);

    // The momenta are those of the free particle.
    let mut flight = free.at_state(met.state).integrate(Gauss::<1>, 0.02).unwrap_or_else(|failure| panic!("{failure}"));
    let landing = Event::smooth_falling(|at| at.q[2] + vi_core::real::Dual::fixed(3.0));
    let met = flight.until_event(landing, 10.0).unwrap_or_else(|failure| panic!("{failure}")).expect("a landing");
    let energy = met.state.energy(&free).expect("regular");
    let initial = start.energy(&sphere).expect("regular");
    assert!((energy - initial).abs() < 1e-10, "{energy} {initial}");

    let caught =
        State::projected(&table, met.state.t, met.state.q, met.v).unwrap_or_else(|failure| panic!("{failure}"));
    let lost = 0.5 * 1.3 * met.v[2] * met.v[2];
    println!("lost {lost} {:e}", caught.energy_lost - lost);
    // Measured: 7.2e-15.
    assert!(lost > 30.0 && (caught.energy_lost - lost).abs() < 3e-14, "{caught:?}");
    // The speed along the table stays.
    assert!((caught.state.p.xy() - met.state.p.xy()).amax() < 1e-14 && caught.state.p[2].abs() < 1e-14);
    let mut slide = table.at_state(caught.state).integrate(Gauss::<1>, 0.02).expect("on the table");
    let state = slide.step().unwrap_or_else(|failure| panic!("{failure}"));
    let [push] = state.reaction(&table).expect("regular");
    assert!((push - 1.3 * 9.81).abs() < 1e-13 && (state.q[2] + 3.0).abs() < 1e-14, "{push} {state:?}");
    // A table that moves up by itself works: ½ m (w² − s²) is lost, with the speeds w before and s after.
    let lift = OnTable { height: -3.0 - 0.5 * met.state.t, speed: 0.5, ..table };
    let caught = State::projected(&lift, met.state.t, met.state.q, met.v).unwrap_or_else(|failure| panic!("{failure}"));
    assert!((caught.energy_lost - lost + 0.5 * 1.3 * 0.25).abs() < 1e-12, "{caught:?}");
}
