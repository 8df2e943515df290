//! A mass on an elastic rod, damped and driven: a system that is not shipped, from its Lagrangian to a table and a file.
//!
//! `cargo run --release --example elastic_pendulum` prints both integrators side by side and writes
//! `elastic_pendulum.csv`, columns t, r, θ, energy, of the fixed-step run.

use std::error::Error;
use std::fmt::Write;
use vi_core::{EnergyPreserving, FixedStep, Starts, lagrangian};

lagrangian! {
    /// A mass m on a rod of natural length l and stiffness k; r is the length of the rod, θ its angle from below.
    pub struct ElasticPendulum {
        const g = 9.81;
        param m = 1.0, k = 40.0, l = 1.0;
        /// Damping of the rod, and of the pivot.
        param c_r = 0.05, c_θ = 0.02;
        /// A torque on the pivot, and its frequency.
        param torque = 0.1, ω = 2.0;
        coord r, θ;
        let kinetic = m * (dot(r)^2 + r^2 * dot(θ)^2) / 2;
        let potential = k * (r - l)^2 / 2 - m * g * r * cos(θ);
        L = kinetic - potential;
        dissipation = c_r * dot(r)^2 / 2 + c_θ * dot(θ)^2 / 2;
        force θ = torque * cos(ω * t);
        discretize midpoint;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let pendulum = ElasticPendulum::default();
    let (q, v, h) = ([1.4, 0.5], [0.0, 0.0], 0.005);

    // Steps of given length; p is the momentum, and the energy at a node is that of the velocity which belongs to it.
    let mut csv = String::from("t,r,theta,energy\n");
    let mut fixed = pendulum.at(0.0, q, v).integrate(FixedStep, h)?;
    println!("fixed steps\n{:>8} {:>10} {:>10} {:>12}", "t", "r", "θ", "energy");
    for count in 1..=2000 {
        let state = fixed.step()?;
        let (t, energy) = (state.t, state.energy(&pendulum)?);
        writeln!(csv, "{t},{},{},{energy}", state.q[0], state.q[1])?;
        if count % 250 == 0 {
            println!("{t:8.3} {:10.5} {:10.5} {energy:12.6}", state.q[0], state.q[1]);
        }
    }
    std::fs::write("elastic_pendulum.csv", csv)?;

    // Steps that find their own length, as long as there is one: with a force, that may end.
    println!("\nenergy-preserving steps\n{:>8} {:>10} {:>10} {:>12} {:>9}", "t", "r", "θ", "energy", "h");
    let mut run = EnergyPreserving::from_midpoint(pendulum, 0.0, q, v, h)?;
    for (count, step) in run.detailed_steps().take(2000).enumerate() {
        match step {
            Ok(step) if (count + 1) % 250 == 0 => {
                println!("{:8.3} {:10.5} {:10.5} {:12.6} {:9.6}", step.t, step.q[0], step.q[1], step.energy, step.h);
            }
            Ok(_) => {}
            Err(error) => {
                println!("{error}");
                break;
            }
        }
    }
    Ok(())
}
