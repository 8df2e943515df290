//! `vi-lab lyapunov`: the rates at which neighbouring trajectories diverge.
//!
//! In: the command line. Out: estimates of the largest Lyapunov exponents along one run of Gauss steps, as CSV on
//! standard output. Each output time is twice the previous one, which shows the convergence. The tangent vectors are
//! those of the discrete steps (`vi_core::derivatives`).

use crate::run;
use clap::Args;
use vi_erased::plan::Method;
use vi_report::catalogue::{Catalogue, kebab};
use vi_report::failure::Failure;
use vi_report::input::{count, number};
use vi_report::numbers::short;
use vi_report::terminal::print;

/// The command line of `vi-lab lyapunov`.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns: t, and the exponents λ1, λ2, … averaged up to t, in units of 1/time. A chaotic motion has λ1 > 0. An autonomous system without force has pairs λ and −λ, \
of which one is zero. A negative --h gives the exponents of the motion backwards in time. An estimate differs from its limit by O(1/t) and by the fluctuations of the motion.")]
pub(crate) struct Arguments {
    /// Name of a system (see `vi-lab list`), or a scene file whose name ends in .toml [default: the first system of
    /// this program]
    #[arg(value_name = "SYSTEM|SCENE.toml")]
    target: Option<String>,
    /// Number of exponents, largest first; at most twice the number of coordinates
    #[arg(long, value_name = "K", default_value_t = 2)]
    count: usize,
    /// Step [default: five times the system's]
    #[arg(long, value_name = "H", allow_negative_numbers = true, value_parser = number)]
    h: Option<f64>,
    /// Number of steps, such as 1e6
    #[arg(long, value_name = "N", default_value = "1e5", value_parser = count)]
    steps: u64,
    /// Set a parameter; repeat for several
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Initial coordinates, separated by commas [default: the system's]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    q: Option<Vec<f64>>,
    /// Initial velocities, separated by commas [default: the system's]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    v: Option<Vec<f64>>,
}

/// Steps before the first printed estimate.
const FIRST: u64 = 100;
/// Ratio of the Gauss step to the default step of the system, which is meant for order 2.
const LONGER: f64 = 5.0;

/// Prints the estimates.
///
/// # Errors
/// Wrong input; a failed step, after printing the estimates so far.
pub(crate) fn write(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let Arguments { target, count, h, steps, set, q, v } = arguments;
    let wanted = run::Arguments {
        target: target.clone(),
        method: Some(Method::Gauss),
        h: *h,
        set: set.clone(),
        q: q.clone(),
        v: v.clone(),
        steps: Some(*steps),
        ..run::Arguments::default()
    };
    let (system, mut plan) = run::start(&wanted, catalogue)?;
    if h.is_none() {
        // Gauss steps are longer than steps of order 2.
        plan.h *= LONGER;
    }
    let most = 2 * system.coordinates().len();
    if *count == 0 || *count > most {
        let name = kebab(system.name());
        return Err(Failure::Input(format!("{name} has 1 to {most} exponents (--count), not {count}")));
    }
    let mut exponents = system
        .studies()
        .lyapunov(&plan, *count, system.coordinates().len())
        .map_err(|error| Failure::start(error, &plan))?;
    let names: Vec<String> = (1..=*count).map(|index| format!("λ{index}")).collect();
    print(&format!("t,{}", names.join(",")))?;
    let mut taken = 0;
    let mut next = FIRST;
    while taken < *steps {
        let part = next.min(*steps) - taken;
        exponents.advance(part).map_err(|error| {
            let before = format!("t = {}, q = {:?}, after {taken} steps or more", short(exponents.t()), exponents.q());
            Failure::step(error, &plan, before)
        })?;
        taken += part;
        next *= 2;
        let values: Vec<String> = exponents.exponents().iter().map(|value| format!("{value:.6}")).collect();
        print(&format!("{},{}", short(exponents.t()), values.join(",")))?;
    }
    Ok(())
}
