//! A system with constraints and a mistake has no other errors, whatever uses it.

use vi_core::prelude::*;

lagrangian! {
    struct Pendulum {
        param l = 1.0;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - 9.81 * y;
        constraint rod = x^2 + y^2 - length^2;
    }
}

fn main() -> Result<(), StepError> {
    let pendulum = Pendulum { l: 2.0 };
    let start = State::projected(&pendulum, 0.0, [1.0, -1.0], [0.0, 0.0])?;
    let mut run = pendulum.at_state(start.state).integrate(Gauss::<2>, 0.01)?;
    run.until(1.0)?;
    let [tension] = run.state().reaction(&pendulum)?;
    println!("{tension}");
    pendulum.at(0.0, [1.0, 0.0], [0.0, 0.0]).integrate(EnergyPreservingGauss::<1>, 0.01)?.step()?;
    Ok(())
}
