use vi_core::rules::{By, Trapezoidal};
use vi_core::{FixedStep, State, lagrangian};

lagrangian! {
    struct Oscillator {
        coord x;
        L = dot(x)^2 / 2 - y^2 / 2;
        discretize midpoint, trapezoidal, simpson;
    }
}

fn main() {
    let system = Oscillator::default();
    let start = State::at(&system, 0.0, [1.0], [0.0]);
    let _ = FixedStep::new(&system, start, 0.1);
    let _ = FixedStep::new(By::new(&system, Trapezoidal), start, 0.1);
}
