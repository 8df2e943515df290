use vi_core::{ScaledGauss, State, lagrangian};

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
    let _ = ScaledGauss::<_, 1, 4>::new(oscillator, start, 0.1);
}
