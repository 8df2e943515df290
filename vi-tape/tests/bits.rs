//! Every ready system without constraints, by every method: the same steps as the compiled system.
//!
//! Bits are equal where the compiled system rounds every product and sum. With up to three coordinates its Gauss steps
//! fuse them, and steps of unknown length evaluate one stage after another; these differ by roundings. So do systems
//! of one, three or six coordinates, which have others at rest: their matrices are solved in another way.

use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_erased::{System, kind};
use vi_systems::{
    ChargedParticle, DampedOscillator, DoublePendulum, DoubleWell, DoubleWellDuffing, HardDuffing, HarmonicOscillator,
    HenonHeiles, Kepler, NPendulum, ParametricPendulum, Pendulum, RotatingHoop, SphericalPendulum, ThreeBody,
};

/// A compiled system, and a start.
struct Case {
    system: Box<dyn System>,
    q: Vec<f64>,
    v: Vec<f64>,
    h: f64,
}

macro_rules! cases {
    ($($system:ident $q:expr, $v:expr, $h:expr;)*) => {
        vec![$(Case {
            system: kind!($system, { fixed; splitting; gauss 4, 8; energy; energy 1, 2, 3 }),
            q: $q.to_vec(),
            v: $v.to_vec(),
            h: $h,
        }),*]
    };
}

fn cases() -> Vec<Case> {
    let eight = [0.97, -0.97, 0.0, -0.243, 0.243, 0.0];
    let eight_v = [0.466, 0.466, -0.932, 0.432, 0.432, -0.864];
    let mut cases = cases! {
        ChargedParticle [1.0, 0.0, 0.1], [0.0, 1.0, 0.0], 0.01;
        DampedOscillator [1.0], [0.0], 0.01;
        DoublePendulum [1.0, 0.5], [0.0, 0.3], 0.005;
        DoubleWell [0.74], [0.0], 0.01;
        DoubleWellDuffing [0.8], [0.0], 0.01;
        HardDuffing [1.0], [0.1], 0.01;
        HarmonicOscillator [1.0], [0.0], 0.01;
        HenonHeiles [0.0, 0.1], [0.5, 0.0], 0.02;
        NPendulum [0.6, 0.4, 0.2, 0.1], [0.0; 4], 0.005;
        ParametricPendulum [0.5], [0.0], 0.01;
        Pendulum [1.0], [0.0], 0.01;
        RotatingHoop [1.0], [0.2], 0.01;
        SphericalPendulum [0.8, 0.0], [0.0, 4.0], 0.005;
        ThreeBody eight, eight_v, 0.005;
    };
    cases.push(Case {
        system: kind!(Kepler, { fixed; splitting; gauss 4, 8; transformed 4, 8; energy; energy 1, 2, 3 }),
        q: vec![0.4, 0.0],
        v: vec![0.0, 2.0],
        h: 0.005,
    });
    cases
}

const METHODS: [(Method, Option<usize>); 12] = [
    (Method::Fixed, None),
    (Method::Suzuki4, None),
    (Method::KahanLi6, None),
    (Method::KahanLi8, None),
    (Method::Splitting4, None),
    (Method::Splitting6, None),
    (Method::Energy, None),
    (Method::Gauss, Some(4)),
    (Method::Gauss, Some(8)),
    (Method::Energy, Some(1)),
    (Method::Energy, Some(2)),
    (Method::Energy, Some(3)),
];

/// Steps of a run, and how far the states are apart: in the largest coordinate or momentum, at equal numbers of steps.
const STEPS: u64 = 20;

#[test]
fn every_method_takes_the_steps_of_the_compiled_system() {
    let (mut equal, mut compared, mut refused) = (0, 0, 0);
    for Case { system, q, v, h } in cases() {
        let tape = vi_tape::System::parse(system.definition()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(tape.name(), system.name());
        assert_eq!(tape.about(), system.about());
        assert_eq!((tape.coordinates(), tape.spaces()), (system.coordinates(), system.spaces()));
        assert_eq!(tape.parameters(), system.parameters());
        assert_eq!(tape.parameters_about(), system.parameters_about());
        assert_eq!(tape.conserves_energy(), system.conserves_energy());
        for (method, stages) in METHODS {
            let of = format!("{} {method:?} {stages:?}", system.name());
            let start = PhasePoint { t: 0.3, q: q.clone(), v: v.clone() };
            let plan = Plan { stages, ..Plan::new(method, h, start) };
            let (mut compiled, mut taped) = match (system.begin(&plan), tape.begin(&plan)) {
                (Ok(compiled), Ok(taped)) => (compiled, taped),
                (compiled, taped) => {
                    assert_eq!(compiled.err(), taped.err(), "{of}");
                    refused += 1;
                    continue;
                }
            };
            let outcomes = [compiled.advance_by(STEPS), taped.advance_by(STEPS)];
            if let [Err(one), Err(other)] = outcomes {
                assert_eq!(core::mem::discriminant(&one), core::mem::discriminant(&other), "{of}");
                refused += 1;
                continue;
            }
            assert_eq!(outcomes, [Ok(()), Ok(())], "{of}");
            let [one, other] = [compiled.row(), taped.row()];
            let numbers = one.q.iter().zip(&other.q).chain(one.p.iter().zip(&other.p)).chain([(&one.t, &other.t)]);
            let off = numbers.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            let has_equal_bits = match (method, stages) {
                (Method::Energy, Some(_)) => false,
                (Method::Gauss, _) => q.len() == 4,
                _ => [2, 4].contains(&q.len()),
            };
            if has_equal_bits {
                assert!(off == 0.0, "{of}: {off:e}");
                equal += 1;
            }
            compared += 1;
            // Steps that solve for their length divide roundings of the energy by h² D/8.
            let allowed = if method == Method::Energy { 1e-7 } else { 1e-14 }; // 4.1e-8, 2.8e-17 (optimized: 8.9e-16)
            assert!(off <= allowed, "{of}: {off:e}");
        }
    }
    assert!(equal > 25 && compared > 130 && refused > 5, "{equal} {compared} {refused}");
}

#[test]
fn steps_in_transformed_time_follow_the_scale_of_the_text() {
    let compiled = kind!(Kepler, { transformed 4, 8 });
    let tape = vi_tape::System::parse(compiled.definition()).expect("Kepler");
    for stages in [4, 8] {
        let start = PhasePoint { t: 0.0, q: vec![0.4, 0.0], v: vec![0.0, 2.0] };
        let plan = Plan { stages: Some(stages), dtau: Some(0.05), ..Plan::new(Method::Gauss, 0.05, start) };
        let [one, other] = [&*compiled, &*tape].map(|system| {
            let mut run = system.begin(&plan).expect("a start");
            run.advance_by(50).expect("steps");
            run.row()
        });
        assert!((one.t - 50.0 * 0.05).abs() > 0.1, "the time is scaled: {}", one.t);
        let off =
            one.q.iter().zip(&other.q).chain([(&one.t, &other.t)]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 2e-14, "{stages}: {off:e}"); // 3.6e-15
    }
    let pendulum = vi_tape::System::parse(kind!(Pendulum, { fixed_2 }).definition()).expect("the pendulum");
    let plan =
        Plan { dtau: Some(0.05), ..Plan::new(Method::Gauss, 0.05, PhasePoint { t: 0.0, q: vec![1.0], v: vec![0.0] }) };
    assert!(matches!(pendulum.begin(&plan).err(), Some(vi_core::StepError::NoTimeScale { system: "Pendulum" })));
}
