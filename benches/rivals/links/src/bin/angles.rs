//! The chains of `../../main.rs` by their angles: fixed and Gauss steps of 7, 18, 30 and 40 rods.
//!
//! In: nothing. Out: a table with the columns of `links.py`. The error is against steps of order 16 with h = 1/200.

use links::{rods, run};
use vi_core::SVector;
use vi_core::motion::Motion;
use vi_core::prelude::*;
use vi_core::stepping::{Convertible, FixedStepping};

const ANGLE: f64 = 0.5;

rods!(Seven, 7);
rods!(Eighteen, 18);
rods!(Thirty, 30);
rods!(Forty, 40);

/// The last mass of a chain with these angles.
fn last<const N: usize>(q: &SVector<f64, N>) -> [f64; 2] {
    [q.map(f64::sin).sum(), -q.map(f64::cos).sum()]
}

fn rows<Y, const N: usize>(system: Y) -> Result<(), StepError>
where
    Y: FixedStepping<N> + Motion<N> + Convertible<N>,
{
    let start = SVector::repeat(ANGLE);
    let (exact, _) = run(system, start, Gauss::<8>, 200)?;
    let exact = last(&exact);
    let show = |name: &str, count: u32, found: Result<(SVector<f64, N>, f64), StepError>| match found {
        Ok((q, seconds)) => {
            let (last, time) = (last(&q), 1e6 * seconds / f64::from(count));
            let error = (last[0] - exact[0]).abs().max((last[1] - exact[1]).abs());
            println!("{N},{name},{},{time:.3},{error:.2e}", 1.0 / f64::from(count));
        }
        Err(failure) => println!("{N},{name},{},,{failure}", 1.0 / f64::from(count)),
    };
    for count in [100, 500, 2000] {
        show("FixedStep", count, run(system, start, FixedStep, count));
    }
    for count in [25, 50] {
        show("Gauss order 8", count, run(system, start, Gauss::<4>, count));
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
