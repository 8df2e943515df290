use vi_core::rules::{By, Trapezoidal};
use vi_core::{lagrangian, FixedStep, Starts, State};

lagrangian! {
    struct Oscillator {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        discretize midpoint;
    }
}

fn main() {
    let system = Oscillator::default();
    let start = State::at(&system, 0.0, [1.0], [0.0]);
    let _ = By::new(system, Trapezoidal).at_state(start).integrate(FixedStep, 0.1);
}
