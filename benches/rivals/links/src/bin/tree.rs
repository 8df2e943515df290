//! Binary trees of 7, 15 and 30 rigid bodies on ball joints: the time of a step.
//!
//! In: nothing. Out: a table. Body i hangs at body (i − 1)/2; all bodies start upright and spin.

use vi_core::stepping::Convertible;
use std::time::Instant;
use vi_core::prelude::*;
use vi_core::{SVector};

const H: f64 = 0.002;
const STEPS: u32 = 50;
const REPETITIONS: u32 = 7;

macro_rules! tree {
    ($module:ident, $count:literal, $left:literal, $right:literal) => {
        mod $module {
            vi_core::lagrangian! {
                /// Bodies of the length 1 that hang at the two lower corners of another.
                pub struct Tree {
                    param m = 1.0, g = 9.81;
                    rotation R[$count];
                    coord x[$count][3];
                    let ω[i in 0..$count] = rate(R[i]);
                    let kinetic[i in 0..$count] =
                        m * dot(x[i]) * dot(x[i]) / 2 + m * (ω[i][0]^2 + 2 * ω[i][1]^2 + 3 * ω[i][2]^2) / 40;
                    L = sum(i in 0..$count, kinetic[i] - m * g * x[i][2]);
                    constraint base = x[0] + turn(R[0], [0, 0, 1/2]);
                    constraint left[i in 0..$left] =
                        x[2*i + 1] + turn(R[2*i + 1], [0, 0, 1/2]) - x[i] - turn(R[i], [-1/4, 0, -1/2]);
                    constraint right[i in 0..$right] =
                        x[2*i + 2] + turn(R[2*i + 2], [0, 0, 1/2]) - x[i] - turn(R[i], [1/4, 0, -1/2]);
                }
            }
        }
    };
}
tree!(seven, 7, 3, 3);
tree!(fifteen, 15, 7, 7);
tree!(thirty, 30, 15, 14);

/// Places of the upright bodies, and their velocities: body i spins, and its centre with it if it is the first one.
fn start<const N: usize>() -> [SVector<f64, N>; 2] {
    let bodies = N / 7;
    let [mut q, mut v] = [SVector::<f64, N>::zeros(); 2];
    for i in 0..bodies {
        q[4 * i] = 1.0;
        v.as_mut_slice()[4 * i + 1..][..3].copy_from_slice(&[0.3, 0.2, 0.1]);
        let centre = |of: usize| 4 * bodies + 3 * of;
        if i == 0 {
            q[centre(0) + 2] = -0.5;
        } else {
            let parent = centre((i - 1) / 2);
            let side = if i % 2 == 1 { -0.25 } else { 0.25 };
            let at = [q[parent] + side, q[parent + 1], q[parent + 2] - 1.0];
            q.as_mut_slice()[centre(i)..][..3].copy_from_slice(&at);
        }
    }
    [q, v]
}

fn row<const S: usize, Y, const N: usize>(system: Y) -> Result<(), StepError>
where
    Y: Convertible<N>,
{
    let [q, v] = start::<N>();
    let start = State::projected(&system, 0.0, q, v)?.state;
    let (mut least, mut iterations) = (f64::INFINITY, 0);
    for _ in 0..REPETITIONS {
        let mut run = system.at_state(start).integrate(Gauss::<S>, H)?;
        iterations = 0;
        let begin = Instant::now();
        for _ in 0..STEPS {
            run.step()?;
            iterations += run.iterations();
        }
        least = least.min(begin.elapsed().as_secs_f64() / f64::from(STEPS));
    }
    println!("{},{},{:.1},{:.2}", N / 7, 2 * S, 1e6 * least, f64::from(iterations) / f64::from(STEPS));
    Ok(())
}

fn main() -> Result<(), StepError> {
    println!("bodies,order,microseconds,iterations");
    row::<1, _, 49>(seven::Tree::default())?;
    row::<1, _, 105>(fifteen::Tree::default())?;
    row::<1, _, 210>(thirty::Tree::default())?;
    row::<2, _, 49>(seven::Tree::default())?;
    row::<2, _, 105>(fifteen::Tree::default())?;
    row::<2, _, 210>(thirty::Tree::default())
}
