use vi_core::{lagrangian, Gauss, Starts, State};

lagrangian! {
    struct Oscillator {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        discretize midpoint;
    }
}

fn main() {
    let oscillator = Oscillator::default();
    let start = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let _ = oscillator.at_state(start).integrate(Gauss::<4>.in_transformed_time(), 0.1);
}
