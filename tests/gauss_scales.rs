//! Stages that change by orders of magnitude between iterations, and numbers at the end of their range: a step is a
//! solution or an error.

use vi_core::{Gauss, SVector, Starts, State, StepError, lagrangian};

lagrangian! {
    /// A nearly singular mass at x + y = 0: the first iteration there gives velocities of 1e16.
    struct Narrow {
        param d = 1e-14;
        coord x, y;
        let e = d + (x + y)^2;
        L = (dot(x) + dot(y))^2 / 2 + e * (dot(x) - dot(y))^2 / 2 + (x + y) - 3 * (x - y)^2 / 20;
        discretize midpoint;
    }
}

lagrangian! {
    /// A mass on a spring in polar coordinates: near r = 0 its angle has nearly no mass.
    struct Polar {
        coord r, a;
        L = (dot(r)^2 + r^2 * dot(a)^2) / 2 - 20 * (r - 1)^2 + 3 * r * cos(a);
        discretize midpoint;
    }
}

lagrangian! {
    /// A repulsive pole.
    struct Pole {
        coord x;
        L = dot(x)^2 / 2 - 1 / x;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two coupled oscillators.
    struct Pair {
        coord x, y;
        L = (dot(x)^2 + 2 * dot(y)^2) / 2 - (x^2 + 3 * y^2 + x * y) / 2;
        discretize midpoint;
    }
}

/// The first step from a state.
fn first<S, const N: usize, const STAGES: usize>(
    system: S,
    q: [f64; N],
    v: [f64; N],
    h: f64,
) -> Result<State<N>, StepError>
where
    S: vi_core::motion::Motion<N> + vi_core::stepping::Convertible<N> + vi_core::stepping::FixedStepping<N>,
{
    system.at(0.0, q, v).integrate(Gauss::<STAGES>, h)?.step()
}

#[test]
fn velocities_that_begin_far_too_large_are_solved_for() {
    // x + y = t²/2, and x − y stays zero.
    let state = first::<_, 2, 2>(Narrow::default(), [0.0; 2], [0.0; 2], 0.01).expect("a step");
    let off = (state.q - SVector::from([2.5e-5; 2])).amax();
    println!("off by {off:.1e}");
    // Measured: 0.
    assert!(off < 1e-20, "{off:e}");
    // Neither the fixed-point nor the Newton iteration converges here: a step would be wrong by its own length.
    let lost = [
        first::<_, 2, 2>(Narrow { d: 1e-4 }, [1e-3, -1e-3], [0.0, 1e-3], 10.0),
        first::<_, 2, 2>(
            Polar::default(),
            [2.728_499_530_269_026_6e-6, 0.0],
            [7.933_634_122_580_116e-6, 3.850_773_213_424_05e-6],
            -0.168_518_320_204_492_8,
        ),
    ];
    for outcome in lost {
        assert!(matches!(outcome, Err(StepError::StagesNotConverged { .. })), "{outcome:?}");
    }
}

#[test]
fn stages_beyond_the_range_of_numbers_are_no_solution() {
    // The first iteration exceeds 1e308, where the pole has no force: standing still would solve the sums of the step.
    let outcome = first::<_, 1, 3>(Pole::default(), [1e-150], [1e-3], 1e-3);
    assert!(matches!(outcome, Err(StepError::StagesNotConverged { .. })), "{outcome:?}");
    // The force at the node overflows already: no shorter step helps.
    for x in [1e-160, 0.0] {
        let outcome = first::<_, 1, 1>(Pole::default(), [x], [0.0], 1e-3);
        assert!(matches!(outcome, Err(StepError::NonFinite { .. })), "{outcome:?}");
    }
}

#[test]
fn stages_that_leave_the_range_of_numbers_change_without_end() {
    let (q, v) = crate::gauss_stiff::lowest_mode();
    let system = vi_systems::FpuChain::default();
    let mut run = system.at(0.0, q, v).integrate(Gauss::<8>, 25.0).expect("a valid start");
    let failure = run.find_map(Result::err);
    let Some(StepError::StagesNotConverged { change, contraction, .. }) = failure else {
        panic!("{failure:?}");
    };
    assert!(change.is_infinite() && contraction.is_infinite(), "{change} {contraction}");
}

/// The largest relative difference between a linear step from small numbers and one from large numbers.
fn off<const STAGES: usize>(scale: f64) -> f64 {
    let [q, v] = [[0.7, -0.4], [0.3, 0.9]];
    let large = first::<_, 2, STAGES>(Pair::default(), q, v, 0.3).expect("a step");
    let small = first::<_, 2, STAGES>(Pair::default(), q.map(|q| q * scale), v.map(|v| v * scale), 0.3);
    let small = small.expect("a step");
    [small.q / scale - large.q, small.p / scale - large.p]
        .map(|difference| difference.amax())
        .into_iter()
        .fold(0.0, f64::max)
}

#[test]
fn small_numbers_keep_their_digits() {
    // From 1e-4 to 2.8e-306, where roundings are just above the smallest number.
    let mut worst = 0.0_f64;
    for exponent in [-13, -970, -990, -1000, -1015] {
        let scale = 2.0_f64.powi(exponent);
        worst = [worst, off::<1>(scale), off::<2>(scale), off::<8>(scale)].into_iter().fold(0.0, f64::max);
    }
    println!("off by {worst:.1e}");
    // Measured: 0.
    assert!(worst < 1e-15, "{worst:e}");
}
