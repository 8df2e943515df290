//! Twenty and forty rods and bodies by Gauss steps, against heyoka: the systems of `../../../heyoka_large.py`.
//!
//! In: nothing. Out: a table with the columns of that script but the last. The error is the largest difference of a
//! coordinate from steps of order 16, relative to the largest change of a coordinate.

use links::{rods, run};
use vi_core::SVector;
use vi_core::motion::Motion;
use vi_core::prelude::*;
use vi_core::stepping::{Convertible, FixedStepping};

rods!(Rods20, 20);
rods!(Rods40, 40);

macro_rules! bodies {
    ($name:ident, $count:literal) => {
        lagrangian! {
            /// Bodies of mass 0.4 in space, with G = 1.3.
            struct $name {
                param m = 0.4, G = 1.3;
                coord r[$count][3];
                L = sum(i in 0..$count, m * dot(r[i]) * dot(r[i]) / 2)
                    + sum(i in 0..$count, j in 0..i, G * m^2 / norm(r[i] - r[j]));
                discretize midpoint;
            }
        }
    };
}
bodies!(Bodies20, 20);
bodies!(Bodies40, 40);

/// Near the points of a grid with a distance of 1.5.
fn grid<const N: usize>() -> SVector<f64, N> {
    SVector::from_fn(|index, _| {
        let (body, direction) = (index / 3, index % 3);
        let place = [body % 4, body / 4 % 4, body / 16][direction];
        1.5 * place as f64 + 0.1 * (1.7 * index as f64).sin()
    })
}

fn rows<Y, const N: usize>(name: &str, system: Y, start: SVector<f64, N>) -> Result<(), StepError>
where
    Y: FixedStepping<N> + Motion<N> + Convertible<N>,
{
    let (exact, _) = run(system, start, Gauss::<8>, 100)?;
    let moved = (exact - start).amax();
    let show = |method: &str, count: u32, found: Result<(SVector<f64, N>, f64), StepError>| {
        let of_run = found.map_or_else(
            |failure| format!(",{failure}"),
            |(last, time)| format!("{:.3},{:.1e}", 1e3 * time, (last - exact).amax() / moved),
        );
        println!("{name},{method},{},{of_run}", 1.0 / f64::from(count));
    };
    for count in [100, 1000] {
        show("FixedStep", count, run(system, start, FixedStep, count));
    }
    for count in [5, 10, 20, 40] {
        show("Gauss of order 8", count, run(system, start, Gauss::<4>, count));
    }
    for count in [3, 5, 10, 20, 40] {
        show("Gauss of order 16", count, run(system, start, Gauss::<8>, count));
    }
    Ok(())
}

fn main() -> Result<(), StepError> {
    println!("system,method,setting,milliseconds,error");
    rows("20 rods", Rods20::default(), SVector::repeat(0.5))?;
    rows("40 rods", Rods40::default(), SVector::repeat(0.5))?;
    rows("20 bodies", Bodies20::default(), grid::<60>())?;
    rows("40 bodies", Bodies40::default(), grid::<120>())
}
