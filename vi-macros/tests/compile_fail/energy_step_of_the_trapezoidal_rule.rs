use vi_core::{lagrangian, EnergyPreserving};

lagrangian! {
    struct Oscillator {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        discretize trapezoidal;
    }
}

fn main() {
    let _ = EnergyPreserving::from_midpoint(Oscillator::default(), 0.0, [1.0], [0.0], 0.1);
}
