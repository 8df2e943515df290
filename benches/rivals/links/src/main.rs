//! Chains of 7, 30 and 100 rods with constraints, as in `../links.py`: the time of a step, and the error of the last mass at t = 1.
//!
//! In: nothing. Out: a table with the columns of `links.py`. The error is against steps of order 8 with h = 1/400.

use vi_core::stepping::Convertible;
use std::time::Instant;
use vi_core::prelude::*;
use vi_core::{SVector};

const ANGLE: f64 = 0.5;
const REPETITIONS: u32 = 7;

macro_rules! chain {
    ($module:ident, $name:ident, $count:literal) => {
        mod $module {
            vi_core::lagrangian! {
                /// Masses 1 on rods of length 1.
                pub struct $name {
                    param g = 9.81, l = 1.0;
                    coord r[$count][2];
                    L = sum(i in 0..$count, dot(r[i]) * dot(r[i]) / 2 - g * r[i][1]);
                    constraint rod[0] = r[0] * r[0] - l^2;
                    constraint rod[i in 1..$count] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - l^2;
                }
            }
        }
    };
}
chain!(seven, Seven, 7);
chain!(thirty, Thirty, 30);
chain!(hundred, Hundred, 100);

/// The last mass after steps of length 1/count to t = 1, and the least time of a step in microseconds.
fn run<const S: usize, Y, const N: usize>(system: Y, count: u32) -> Result<([f64; 2], f64), StepError>
where
    Y: Convertible<N>,
{
    let number = |i: usize| f64::from(u32::try_from(i / 2 + 1).unwrap_or(0));
    let along = SVector::<f64, N>::from_fn(|i, _| number(i) * if i % 2 == 0 { -ANGLE.sin() } else { -ANGLE.cos() });
    let start = State::projected(&system, 0.0, along, SVector::<f64, N>::zeros())?.state;
    let (mut least, mut last) = (f64::INFINITY, [0.0; 2]);
    for _ in 0..REPETITIONS {
        let mut run = system.at_state(start).integrate(Gauss::<S>, 1.0 / f64::from(count))?;
        let begin = Instant::now();
        for _ in 0..count {
            run.step()?;
        }
        least = least.min(begin.elapsed().as_secs_f64() / f64::from(count));
        last = [run.state().q[N - 2], run.state().q[N - 1]];
    }
    Ok((last, 1e6 * least))
}

fn rows<Y, const N: usize>(system: Y) -> Result<(), StepError>
where
    Y: Convertible<N>,
{
    let (exact, _) = run::<4, Y, N>(system, 400)?;
    let show = |order: u32, count: u32, found: Result<([f64; 2], f64), StepError>| match found {
        Ok((last, time)) => {
            let error = (last[0] - exact[0]).abs().max((last[1] - exact[1]).abs());
            println!("{},Gauss order {order},{},{time:.3},{error:.2e}", N / 2, 1.0 / f64::from(count));
        }
        Err(failure) => println!("{},Gauss order {order},{},,{failure}", N / 2, 1.0 / f64::from(count)),
    };
    for count in [100, 1000, 10_000] {
        show(2, count, run::<1, Y, N>(system, count));
    }
    for count in [25, 50, 100] {
        show(4, count, run::<2, Y, N>(system, count));
        show(6, count, run::<3, Y, N>(system, count));
    }
    Ok(())
}

fn main() -> Result<(), StepError> {
    println!("rods,method,h,microseconds,error");
    rows(seven::Seven::default())?;
    rows(thirty::Thirty::default())?;
    rows(hundred::Hundred::default())
}
