//! Systems with constraints: the steps of the compiled ones.
//!
//! Both eliminate in the same order, so that bits are equal; with a coordinate at rest the order may differ.

use vi_core::StepError;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_erased::system::Quantity;
use vi_erased::{System, kind};
use vi_systems::{
    AndrewsSqueezer, ChaplyginSleigh, DoubleRodPendulum, FourBar, HeavyTop, RodPendulum, RollingBall, RollingDisk,
    SliderCrank,
};

/// A compiled system, and a start.
struct Case {
    system: Box<dyn System>,
    q: Vec<f64>,
    v: Vec<f64>,
    h: f64,
}

macro_rules! cases {
    ($methods:tt: $($system:ident $h:expr;)*) => {
        vec![$({
            let (q, v) = $system::default().start();
            Case { system: kind!($system, $methods), q: q.to_vec(), v: v.to_vec(), h: $h }
        }),*]
    };
}

const METHODS: [(Method, usize); 3] = [(Method::Gauss, 1), (Method::Gauss, 3), (Method::Energy, 2)];
const STEPS: u64 = 20;

/// The largest difference of two lists.
fn off<'a>(one: impl IntoIterator<Item = &'a f64>, other: impl IntoIterator<Item = &'a f64>) -> f64 {
    one.into_iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

#[test]
fn every_method_takes_the_steps_of_the_compiled_system() {
    let mut cases = cases! { { gauss 1, 3; energy 2 }:
        AndrewsSqueezer 2e-5;
        ChaplyginSleigh 0.01;
        DoubleRodPendulum 0.01;
        FourBar 0.01;
        HeavyTop 0.005;
        RodPendulum 0.01;
        RollingBall 0.01;
        RollingDisk 0.01;
        SliderCrank 0.01;
    };
    cases.extend(cases! { { gauss 2, 4, 6; energy 1 }:
        DoubleRodPendulum 0.02;
        RollingDisk 0.02;
    });
    let (mut equal, mut refused) = (0, 0);
    for Case { system, q, v, h } in cases {
        let tape = vi_tape::System::parse(system.definition()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(tape.constraints(), system.constraints());
        assert_eq!((tape.coordinates(), tape.spaces()), (system.coordinates(), system.spaces()));
        assert_eq!(tape.parameters(), system.parameters());
        // One block is a dense matrix, but not beside coordinates at rest: roundings differ, and lengths multiply them.
        let is_one_block = ["FourBar", "SliderCrank"].contains(&tape.name());
        let at = PhasePoint { t: 0.0, q: q.clone(), v: v.clone() };
        for (method, stages, _) in system.integrators() {
            let of = format!("{} {method:?} {stages:?}", system.name());
            let allowed = match method {
                _ if !is_one_block => 0.0,
                Method::Energy => 1e-8, // 7.6e-10
                _ => 1e-13,             // 7.1e-15
            };
            let plan = Plan { stages, ..Plan::new(method, h, at.clone()) };
            let [mut compiled, mut taped] =
                [&*system, &*tape].map(|system| system.begin(&plan).unwrap_or_else(|error| panic!("{of}: {error}")));
            let outcomes = [compiled.advance_by(STEPS), taped.advance_by(STEPS)];
            assert_eq!(outcomes[0].is_ok(), outcomes[1].is_ok(), "{of}");
            refused += u32::from(outcomes[0].is_err());
            let [one, other] = [compiled.row(), taped.row()];
            let moved = off(&one.q, &q);
            assert!(moved > 1e-3, "{of} moves: {moved:e}");
            let found = off(&one.q, &other.q).max(off(&one.p, &other.p)).max((one.t - other.t).abs());
            assert!(found <= allowed, "{of}: {found:e}");
            let [one, other] = [one.constraints, other.constraints].map(|of| of.expect("constraints").reactions);
            let [one, other] =
                [one, other].map(|of| of.into_iter().map(|of| of.expect("a reaction")).collect::<Vec<_>>());
            let found = off(&one, &other);
            assert!(one.len() == tape.constraints().len() && found <= allowed, "{of}: {found:e}");
            equal += u32::from(allowed == 0.0);
        }
    }
    assert!(equal > 26 && refused == 3, "{equal} {refused}");
}

/// A rod of the length 1.3 in a moving frame, and a blade; further free masses fill up the sizes that are built.
fn rod_and_blade(further: usize) -> String {
    let [more, energy] = match further {
        0 => [String::new(), String::new()],
        _ => [format!("z[{further}],"), format!("sum(i in 0..{further}, dot(z[i])^2) / 2 +")],
    };
    format!(
        "struct Both {{
            param m = 1.5; coord {more} x, y; angle theta;
            L = {energy} m * (dot(x)^2 + dot(y)^2) / 2 + 0.7 * dot(theta)^2 / 2 - m * 9.81 * y;
            constraint rod = (x - sin(2 * t) / 5)^2 + y^2 - 1.69;
            constraint blade = dot(theta) * cos(theta) - 0.3 * y * dot(x);
        }}"
    )
}

#[test]
fn coordinates_at_rest_have_no_constraint() {
    let narrow = vi_tape::System::parse(&rod_and_blade(0)).unwrap_or_else(|error| panic!("{error}"));
    let wide = vi_tape::System::parse(&rod_and_blade(1)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(narrow.coordinates(), ["x", "y", "theta"]);
    assert_eq!(narrow.constraints(), ["rod", "blade"]);
    // Velocities that satisfy both: (x - s) (v - s') + y w = 0 and θ' cos θ = 0.3 y v at t = 0, s = 0, s' = 0.4.
    let (q, v) = ([0.5, -1.2, 0.4], [0.7, 0.5 * 0.3 / 1.2, -0.3 * 1.2 * 0.7 / 0.4_f64.cos()]);
    let with = |of: [f64; 3]| [&[0.0][..], &of].concat();
    for (method, stages) in METHODS {
        let plan = |q: Vec<f64>, v: Vec<f64>| Plan {
            stages: Some(stages),
            ..Plan::new(method, 0.01, PhasePoint { t: 0.0, q, v })
        };
        let mut run = narrow.begin(&plan(q.to_vec(), v.to_vec())).expect("a start");
        let mut other = wide.begin(&plan(with(q), with(v))).expect("a start");
        run.advance_by(20).expect("steps");
        other.advance_by(20).expect("steps");
        let [one, other] = [run.row(), other.row()];
        let found = off(&one.q, &other.q[1..]).max(off(&one.p, &other.p[1..]));
        assert!(found < 1e-12, "{method:?}: {found:e}"); // 0
        let [one, other] = [one.constraints, other.constraints].map(|of| of.expect("constraints"));
        assert_eq!((one.reactions.len(), other.reactions.len()), (2, 2));
        assert!(one.residual.expect("a velocity") < 1e-14, "{:?}", one.residual); // 4.5e-16
    }
    let mut values = Vec::new();
    for (quantity, count) in
        [(Quantity::Residuals, 4), (Quantity::Acceleration, 3), (Quantity::ReactionForce, 3), (Quantity::Reaction, 2)]
    {
        values.clear();
        narrow.evaluate(quantity, [&[0.0], &q, &v], &mut values).expect("a value");
        assert_eq!(values.len(), count, "{quantity:?}");
    }
    let guess = PhasePoint { t: 0.0, q: vec![0.6, -1.0, 0.4], v: v.to_vec() };
    let projected = narrow.project(&guess).expect("a point on the rod");
    let [x, y, _] = projected.point.q[..] else { panic!("three coordinates") };
    assert!((x * x + y * y - 1.69).abs() < 1e-14); // 2.2e-16
    let off_rod = Plan::new(Method::Gauss, 0.01, guess);
    assert!(matches!(narrow.begin(&off_rod).err(), Some(vi_core::StepError::InconsistentStart { .. })));
}

/// A coupler on three parallel cranks, two of which would hold it: the third one follows from them.
const CRANKS: &str = "struct Cranks {
    param b = 2.0, c = 1.0, g = 9.81;
    coord x, y, u, w;
    L = (dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2) / 2 - g * (y + w);
    constraint left = x^2 + y^2 - 1, right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2;
    constraint middle = ((x + u) / 2 - b / 2)^2 + ((y + w) / 2)^2 - c^2;
}";

#[test]
fn dropped_constraints_leave_the_motion() {
    let mut all = vi_tape::System::parse(CRANKS).unwrap_or_else(|error| panic!("{error}")).into_inner();
    all.set("g", 5.0);
    let two = CRANKS.replace("c = 1.0, ", "");
    let two = format!("{}}}", two.split("constraint middle").next().expect("the rest"));
    let mut two = vi_tape::System::parse(&two).unwrap_or_else(|error| panic!("{error}")).into_inner();
    two.set("g", 5.0);
    let (sine, cosine) = 0.5_f64.sin_cos();
    let at = PhasePoint { t: 0.0, q: vec![sine, -cosine, 2.0 + sine, -cosine], v: vec![0.0; 4] };
    let kept = all.without(&["middle"]).expect("a constraint");
    assert_eq!((kept.constraints(), kept.parameters()), (all.constraints(), all.parameters()));
    assert!(all.without(&["top"]).is_none() && kind!(RodPendulum, { gauss 1 }).without(&["rod"]).is_none());
    for stages in [1, 3] {
        let plan = Plan { stages: Some(stages), ..Plan::new(Method::Gauss, 0.02, at.clone()) };
        assert!(all.begin(&plan).is_err());
        let [mut run, mut other] = [&kept, &two].map(|of| of.begin(&plan).expect("a start"));
        run.advance_by(50).expect("steps");
        other.advance_by(50).expect("steps");
        let [one, other] = [run.row(), other.row()];
        let found = off(&one.q, &other.q).max(off(&one.p, &other.p));
        assert!(found < 1e-13 && off(&one.q, &at.q) > 0.1, "{stages}: {found:e}"); // 0
        let of = one.constraints.expect("constraints");
        assert!(of.reactions[3] == Some(0.0) && of.residual.expect("a velocity") < 1e-14, "{of:?}");
    }
    // A third crank of another length contradicts the others.
    let mut wrong = kept.copy();
    wrong.set("c", 1.1);
    let refused = wrong.begin(&Plan { stages: Some(1), ..Plan::new(Method::Gauss, 0.02, at) }).err();
    assert!(matches!(refused, Some(StepError::DroppedConstraint { constraint: "middle", .. })), "{refused:?}");
}
