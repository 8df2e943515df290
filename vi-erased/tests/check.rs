//! What a plan asks for and no run has, in the words of the command and of Python.

use vi_erased::check::{self, Face};
use vi_erased::plan::{Method, PhasePoint, Plan, Shift, Start};
use vi_erased::{System, kind};
use vi_systems::{Kepler, Pendulum, RodPendulum};

vi_core::lagrangian! {
    /// No rule, and a force of the velocity.
    struct Alone {
        coord x;
        L = dot(x)^2 / 2 - x^4 / 4;
        force x = -dot(x) / 10;
    }
}

vi_core::lagrangian! {
    /// Linear in the velocities, and of kicks and drifts.
    struct Flow {
        coord x, p;
        L = p * dot(x) - cosh(p) - x^4 / 4;
    }
}

fn plan(method: Method) -> Plan {
    Plan::new(method, 0.1, PhasePoint { t: 0.0, q: vec![1.0], v: vec![0.0] })
}

fn with(method: Method, change: fn(&mut Plan)) -> Plan {
    let mut plan = plan(method);
    change(&mut plan);
    plan
}

/// A plan of a system, and what the command and Python say of it.
type Case<'a> = (&'a dyn System, Plan, [&'a str; 2]);

fn assert_messages(cases: &[Case<'_>]) {
    for (system, plan, messages) in cases {
        let refusal = check::integrator(*system, plan.clone()).expect_err(messages[0]);
        assert_eq!([Face::Command, Face::Python].map(|face| refusal.message(face)), *messages);
    }
}

#[test]
fn options_of_other_methods_are_refused() {
    let pendulum = kind!(Pendulum, { fixed; gauss 4, 8; energy; energy 2 });
    let rod = kind!(RodPendulum, { gauss 1, 3; energy 2 });
    assert_messages(&[
        (
            &*pendulum,
            with(Method::Fixed, |plan| plan.start = Start::Points),
            [
                "--start is an option of --method energy: give this method, or leave out --start",
                "start is an option of method=\"energy\": give this method, or leave out start",
            ],
        ),
        (
            &*pendulum,
            with(Method::Gauss, |plan| plan.shift = Some(Shift::Of(1.0))),
            [
                "--shift is an option of --method energy: give this method, or leave out --shift",
                "shift is an option of method=\"energy\": give this method, or leave out shift",
            ],
        ),
        (
            &*pendulum,
            with(Method::Fixed, |plan| plan.fallback = true),
            [
                "--fallback is an option of --method energy: give this method, or leave out --fallback",
                "fallback is an option of method=\"energy\": give this method, or leave out fallback",
            ],
        ),
        (
            &*pendulum,
            with(Method::Fixed, |plan| plan.stages = Some(8)),
            [
                "--stages is an option of --method gauss, --method adaptive or --method energy: give this method, or leave out --stages",
                "stages is an option of method=\"gauss\", method=\"adaptive\" or method=\"energy\": give this method, or leave out stages",
            ],
        ),
        (
            &*pendulum,
            with(Method::Energy, |plan| plan.dtau = Some(0.1)),
            [
                "--dtau is an option of --method gauss: give this method, or leave out --dtau",
                "dtau is an option of method=\"gauss\": give this method, or leave out dtau",
            ],
        ),
        (
            &*pendulum,
            with(Method::Energy, |plan| (plan.start, plan.shift) = (Start::Points, Some(Shift::Over(1.0)))),
            [
                "steps with a shift start from the initial state: leave out --start",
                "steps with a shift start from the initial state: leave out start",
            ],
        ),
        (
            &*rod,
            with(Method::Energy, |plan| plan.start = Start::Midpoint),
            [
                "steps with constraints start from the initial state: leave out --start",
                "steps with constraints start from the initial state: leave out start",
            ],
        ),
    ]);
}

#[test]
fn an_integrator_that_a_system_lacks_is_told_with_those_that_it_has() {
    let pendulum = kind!(Pendulum, { fixed; gauss 4, 8; energy; energy 2 });
    let alone = kind!(Alone, { gauss 4, 8; energy 2 });
    let flow = kind!(Flow, { gauss 4 });
    let rod = kind!(RodPendulum, { gauss 1, 3; energy 2 });
    assert_messages(&[
        (
            &*pendulum,
            with(Method::Gauss, |plan| plan.dtau = Some(0.1)),
            [
                "Pendulum has no time scale: give --h in place of --dtau, or write the clause `time_scale = …;`",
                "Pendulum has no time scale: give h in place of dtau, or write the clause `time_scale = …;`",
            ],
        ),
        (
            &*pendulum,
            with(Method::Energy, |plan| plan.stages = Some(4)),
            [
                "Pendulum has no integrator --method energy --stages 4; --stages may be 2: with more, rounding hides the length",
                "Pendulum has no integrator method=\"energy\", stages=4; stages may be 2: with more, rounding hides the length. The argument methods of compile and of native builds others",
            ],
        ),
        (
            &*pendulum,
            with(Method::Gauss, |plan| plan.stages = Some(5)),
            [
                "Pendulum has no integrator --method gauss --stages 5; --stages may be 4 or 8",
                "Pendulum has no integrator method=\"gauss\", stages=5; stages may be 4 or 8. The argument methods of compile and of native builds others",
            ],
        ),
        (
            &*alone,
            plan(Method::Fixed),
            [
                "Alone has no rule for --method fixed: add `discretize midpoint;` to it, or use --method gauss, or --method energy --stages 2",
                "Alone has no rule for method=\"fixed\": add `discretize midpoint;` to it, or use method=\"gauss\", or method=\"energy\", stages=2",
            ],
        ),
        (
            &*alone,
            plan(Method::Splitting4),
            [
                "--method splitting-4: the motion of `Alone` does not split into kicks and drifts: its mass matrix is not constant, or a force depends on velocities",
                "method=\"splitting-4\": the motion of `Alone` does not split into kicks and drifts: its mass matrix is not constant, or a force depends on velocities",
            ],
        ),
        (
            &*pendulum,
            plan(Method::Splitting4),
            [
                "Pendulum has no integrator --method splitting-4; it has --method fixed, --method suzuki-4, --method kahan-li-6, --method kahan-li-8, --method gauss (--stages 4, 8) or --method energy (--stages 2)",
                "Pendulum has no integrator method=\"splitting-4\"; it has method=\"fixed\", method=\"suzuki-4\", method=\"kahan-li-6\", method=\"kahan-li-8\", method=\"gauss\" (stages=4, 8) or method=\"energy\" (stages=2). The argument methods of compile and of native builds others",
            ],
        ),
        (
            &*flow,
            plan(Method::Splitting6),
            [
                "Flow has no integrator --method splitting-6; it has --method gauss (--stages 4)",
                "Flow has no integrator method=\"splitting-6\"; it has method=\"gauss\" (stages=4). The argument methods of compile and of native builds others",
            ],
        ),
        (
            &*rod,
            plan(Method::KahanLi6),
            [
                "RodPendulum has constraints, which --method kahan-li-6 does not keep: use --method gauss (--stages 1, 3) or --method energy (--stages 2)",
                "RodPendulum has constraints, which method=\"kahan-li-6\" does not keep: use method=\"gauss\" (stages=1, 3) or method=\"energy\" (stages=2)",
            ],
        ),
    ]);
}

#[test]
fn a_plan_gets_the_stages_that_are_built() {
    let stages = |system: &dyn System, method| check::integrator(system, plan(method)).expect("a plan").stages;
    let few = kind!(Kepler, { fixed; gauss 2, 4; energy });
    let rod = kind!(RodPendulum, { gauss 1, 3; energy 2 });
    assert_eq!(
        [Method::Fixed, Method::Gauss, Method::Energy].map(|method| stages(&*few, method)),
        [None, Some(4), None]
    );
    assert_eq!([Method::Gauss, Method::Energy].map(|method| stages(&*rod, method)), [Some(3), Some(2)]);
}

#[test]
fn numbers_of_no_run_are_refused() {
    let system = kind!(Kepler, { gauss 4; transformed 4 });
    let plan = || Plan::new(Method::Gauss, 0.1, PhasePoint { t: 0.0, q: vec![1.0, 0.0], v: vec![0.0, 1.0] });
    let messages = |plan: Plan| check::numbers(&*system, &plan).expect_err("a refusal").message(Face::Command);
    assert_eq!(check::numbers(&*system, &plan()), Ok(()));
    for (wrong, words) in [
        (Plan { q: vec![1.0], ..plan() }, "Kepler has the coordinates x, y: give as many coordinates (--q), not 1"),
        (Plan { p: Some(Vec::new()), ..plan() }, "Kepler has the coordinates x, y: give as many momenta (--p), not 0"),
        (Plan { v: vec![f64::NAN, 0.0], ..plan() }, "the velocities (--v) must be finite, not NaN"),
        (Plan { t: f64::INFINITY, ..plan() }, "the initial time (--t) must be finite, not inf"),
        (Plan { h: 0.0, ..plan() }, "the step (--h) must be finite, not zero and not subnormal, not 0.0"),
        (Plan { h: f64::NAN, ..plan() }, "the step (--h) must be finite, not zero and not subnormal, not NaN"),
        (
            Plan { dtau: Some(0.0), ..plan() },
            "the step in transformed time (--dtau) must be finite, not zero and not subnormal, not 0.0",
        ),
        (Plan { tolerance: Some(0.0), ..plan() }, "the tolerance (--tolerance) must be between an ulp and 1, not 0.0"),
    ] {
        assert_eq!(messages(wrong), words);
    }
    // A length that another number determines may be missing.
    assert_eq!(check::numbers(&*system, &Plan { h: f64::NAN, tolerance: Some(1e-9), ..plan() }), Ok(()));
    assert_eq!(check::numbers(&*system, &Plan { h: f64::NAN, dtau: Some(0.1), ..plan() }), Ok(()));
}
