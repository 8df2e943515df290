use vi_core::rules::{By, Trapezoidal};
use vi_core::{lagrangian, FixedStep, Starts, State};

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
    let _ = system.at_state(start).integrate(FixedStep, 0.1);
    let _ = By::new(&system, Trapezoidal).at_state(start).integrate(FixedStep, 0.1);
}
