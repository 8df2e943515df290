//! A system with unreadable coordinates reports only this mistake.
use vi_core::{FixedStep, Starts};

mod broken {
    vi_core::lagrangian! {
        pub struct Oscillator {
            param m = 1.0;
            coords x;
            L = m * dot(x)^2 / 2;
            discretize midpoint;
        }
    }
}

fn main() {
    let system = broken::Oscillator { m: 2.0 };
    let state = vi_core::State::at(&system, 0.0, [1.0], [0.0]);
    let mut run = system.at_state(state).integrate(FixedStep, 0.01).expect("a valid start");
    let _ = run.step();
    let _ = vi_core::EnergyPreserving::from_midpoint(system, 0.0, [1.0], [0.0], 0.1);
}
