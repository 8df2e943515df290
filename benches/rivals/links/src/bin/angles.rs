//! The chains of `../../main.rs` by their angles: fixed and Gauss steps of 7, 18, 30 and 40 rods.
//!
//! In: nothing. Out: a table with the columns of `links.py`. The error is against steps of order 16 with h = 1/200.

use std::time::Instant;
use vi_core::collocation::Collocation;
use vi_core::prelude::*;
use vi_core::stepping::{Convertible, FixedStepping};
use vi_core::{Method, SVector};

const ANGLE: f64 = 0.5;
const REPETITIONS: u32 = 7;

macro_rules! chain {
    ($name:ident, $count:literal) => {
        lagrangian! {
            /// Masses 1 on rods of length 1, by the angles of the rods to the vertical.
            struct $name {
                param g = 9.81;
                coord a[$count];
                let x[0] = sin(a[0]);
                let x[i in 1..$count] = x[i - 1] + sin(a[i]);
                let y[0] = -cos(a[0]);
                let y[i in 1..$count] = y[i - 1] - cos(a[i]);
                L = sum(i in 0..$count, (dot(x[i])^2 + dot(y[i])^2) / 2 - g * y[i]);
                discretize midpoint;
            }
        }
    };
}
chain!(Seven, 7);
chain!(Eighteen, 18);
chain!(Thirty, 30);
chain!(Forty, 40);

/// The last mass after steps of length 1/count to t = 1, and the least time of a step in microseconds.
fn run<M, Y, const N: usize>(system: Y, method: M, count: u32) -> Result<([f64; 2], f64), StepError>
where
    M: Method<Y, N> + Copy,
    Y: FixedStepping<N> + Collocation<N> + Convertible<N>,
{
    let (mut least, mut last) = (f64::INFINITY, [0.0; 2]);
    for _ in 0..REPETITIONS {
        let start = system.at(0.0, SVector::repeat(ANGLE), SVector::zeros());
        let mut run = start.integrate(method, 1.0 / f64::from(count))?;
        let begin = Instant::now();
        for _ in 0..count {
            run.step()?;
        }
        least = least.min(begin.elapsed().as_secs_f64() / f64::from(count));
        let q = run.state().q;
        last = [q.map(f64::sin).sum(), -q.map(f64::cos).sum()];
    }
    Ok((last, 1e6 * least))
}

fn rows<Y, const N: usize>(system: Y) -> Result<(), StepError>
where
    Y: FixedStepping<N> + Collocation<N> + Convertible<N>,
{
    let (exact, _) = run(system, Gauss::<8>, 200)?;
    let show = |name: &str, count: u32, found: Result<([f64; 2], f64), StepError>| match found {
        Ok((last, time)) => {
            let error = (last[0] - exact[0]).abs().max((last[1] - exact[1]).abs());
            println!("{N},{name},{},{time:.3},{error:.2e}", 1.0 / f64::from(count));
        }
        Err(failure) => println!("{N},{name},{},,{failure}", 1.0 / f64::from(count)),
    };
    for count in [100, 500, 2000] {
        show("FixedStep", count, run(system, FixedStep, count));
    }
    for count in [25, 50] {
        show("Gauss order 8", count, run(system, Gauss::<4>, count));
    }
    Ok(())
}

fn main() -> Result<(), StepError> {
    println!("rods,method,h,microseconds,error");
    rows(Seven::default())?;
    rows(Eighteen::default())?;
    rows(Thirty::default())?;
    rows(Forty::default())
}
