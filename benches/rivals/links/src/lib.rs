//! Shared code of the binaries: rods described by their angles, and timed runs.

use std::time::Instant;
use vi_core::motion::Motion;
use vi_core::prelude::*;
use vi_core::stepping::{Convertible, FixedStepping};
use vi_core::{Method, SVector};

const REPETITIONS: u32 = 7;

/// Declares a chain of so many rods.
#[macro_export]
macro_rules! rods {
    ($name:ident, $count:literal) => {
        vi_core::lagrangian! {
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
/// The coordinates after `count` steps to t = 1 from rest, and the least time of a run in seconds.
///
/// # Errors
/// The error of the failed step.
pub fn run<M, Y, const N: usize>(
    system: Y,
    start: SVector<f64, N>,
    method: M,
    count: u32,
) -> Result<(SVector<f64, N>, f64), StepError>
where
    M: Method<Y, N> + Copy,
    Y: FixedStepping<N> + Motion<N> + Convertible<N>,
{
    let (mut least, mut last) = (f64::INFINITY, start);
    for _ in 0..REPETITIONS {
        let start = system.at(0.0, start, SVector::zeros());
        let mut run = start.integrate(method, 1.0 / f64::from(count))?;
        let begin = Instant::now();
        for _ in 0..count {
            run.step()?;
        }
        least = least.min(begin.elapsed().as_secs_f64());
        last = run.state().q;
    }
    Ok((last, least))
}
