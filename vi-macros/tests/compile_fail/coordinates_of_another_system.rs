//! As many numbers as coordinates, in every form.

use vi_core::{lagrangian, EnergyPreserving, State, SVector};

lagrangian! {
    struct Pendulum {
        coord x;
        L = dot(x)^2 / 2 + cos(x);
        discretize midpoint;
    }
}

fn main() {
    let system = Pendulum::default();
    let _ = State::at(&system, 0.0, SVector::from([1.0]), [0.0]);
    let _ = State::at(&system, 0.0, [1.0, 2.0], [0.0]);
    let _ = State::at(&system, 0.0, [1.0], SVector::from([0.0, 1.0]));
    let _ = State::at(&system, 0.0, 1.0, [0.0]);
    let _ = EnergyPreserving::from_midpoint(&system, 0.0, [1.0], [0.0, 2.0], 0.1);
}
