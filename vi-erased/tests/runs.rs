//! Erased runs are those of the generic integrators, bit for bit.

use vi_core::{Composition, EnergyPreserving, EnergyPreservingGauss, FixedStep, Gauss, Run, Starts, StepError};
use vi_erased::plan::Shift;
use vi_erased::{Method, PhasePoint, Plan, System, kind};
use vi_systems::{Kepler, Pendulum, RodPendulum};

fn kepler() -> Box<dyn System> {
    kind!(Kepler, { fixed; gauss 4, 8; transformed 8; energy; energy 2 })
}

fn plan(method: Method, h: f64) -> Plan {
    Plan::new(method, h, PhasePoint { t: 0.5, q: vec![0.4, 0.0], v: vec![0.0, 2.0] })
}

#[test]
fn erased_runs_have_the_bits_of_generic_ones() {
    fn same<M: vi_core::Method<Kepler, 2>>(plan: &Plan, mut run: Run<M, Kepler, 2>) {
        let mut erased = kepler().begin(plan).expect("a start");
        for _ in 0..50 {
            erased.advance().expect("a step");
            let state = run.step().expect("a step");
            assert_eq!((erased.t(), &*erased.q(), erased.p()), (state.t, state.q.as_slice(), state.p.as_slice()));
        }
        assert_eq!(erased.energy(), run.energy());
        assert!(erased.evaluations() >= 50);
        // The loop without virtual calls.
        let mut at_once = kepler().begin(plan).expect("a start");
        assert_eq!(at_once.advance_until(f64::INFINITY, 50), Ok(50));
        assert_eq!((at_once.row(), at_once.evaluations()), (erased.row(), erased.evaluations()));
    }
    let start = Kepler::default().at(0.5, [0.4, 0.0], [0.0, 2.0]);
    same(&plan(Method::Fixed, 0.01), start.integrate(FixedStep, 0.01).expect("a start"));
    same(&plan(Method::KahanLi8, 0.05), start.integrate(Composition::KAHAN_LI_8, 0.05).expect("a start"));
    same(&plan(Method::Gauss, 0.1), start.integrate(Gauss::<8>, 0.1).expect("a start"));
    let four = Plan { stages: Some(4), ..plan(Method::Gauss, 0.1) };
    same(&four, start.integrate(Gauss::<4>, 0.1).expect("a start"));
    same(&plan(Method::Energy, 0.01), start.integrate(EnergyPreserving, 0.01).expect("a start"));
    let midpoint = Plan { start: vi_erased::plan::Start::Midpoint, ..plan(Method::Energy, 0.01) };
    let from_the_middle = EnergyPreserving::from_midpoint(Kepler::default(), 0.5, [0.4, 0.0], [0.0, 2.0], 0.01);
    same(&midpoint, from_the_middle.expect("a start"));
}

#[test]
fn runs_with_constraints_have_the_bits_of_generic_ones() {
    let system = kind!(RodPendulum, { gauss 1, 3 });
    assert_eq!(system.constraints(), ["rod"]);
    let typed = RodPendulum::default();
    let (q, v) = typed.start();
    let mut run = typed.at(0.0, q, v).integrate(Gauss::<3>, 0.01).expect("a start");
    let start = PhasePoint { t: 0.0, q: q.to_vec(), v: v.to_vec() };
    let plan = Plan::new(Method::Gauss, 0.01, start.clone());
    let mut erased = system.begin(&plan).expect("a start");
    for _ in 0..50 {
        erased.advance().expect("a step");
        let state = run.step().expect("a step");
        assert_eq!((erased.t(), &*erased.q(), erased.p()), (state.t, state.q.as_slice(), state.p.as_slice()));
        let row = erased.row();
        let constraints = row.constraints.clone().expect("constraints");
        let [reaction] = state.reaction(&typed).expect("a reaction");
        assert_eq!(constraints.reactions, [Some(reaction)]);
        // |g| and |A v + a|, measured: at most 4.4e-16.
        assert!(constraints.residual.is_some_and(|residual| residual < 2e-15), "{constraints:?}");
        let columns = vi_erased::Row::columns(&["x", "y"], system.constraints(), false);
        assert_eq!(columns, ["t", "x", "y", "p_x", "p_y", "Λ_rod", "residual", "H", "E", "h"]);
        assert_eq!(row.entries().count(), columns.len());
    }
    let energies = kind!(RodPendulum, { energy 2 });
    let shifted =
        Plan { stages: Some(2), shift: Some(Shift::Over(3.0)), ..Plan::new(Method::Energy, 0.05, start.clone()) };
    let mut run = typed.at(0.0, q, v).integrate(EnergyPreservingGauss::<2>, 0.05).expect("a start");
    run = run.with_shift_from(3.0).expect("a shift");
    let mut erased = energies.begin(&shifted).expect("a start");
    for _ in 0..50 {
        erased.advance().expect("a step");
        let state = run.step().expect("a step");
        assert_eq!((erased.t(), &*erased.q(), erased.p()), (state.t, state.q.as_slice(), state.p.as_slice()));
        assert_eq!(erased.row().shifted_energy, Some(run.shifted_energy()));
    }
    let refused = |plan: &Plan| system.begin(plan).err();
    assert_eq!(
        refused(&Plan::new(Method::Fixed, 0.01, start)),
        Some(StepError::HasConstraints { system: "RodPendulum" })
    );
    assert!(matches!(refused(&Plan { stages: Some(2), ..plan.clone() }), Some(StepError::InvalidInput { .. })));
    let off = Plan { q: vec![1.0, -0.5], ..plan };
    assert!(matches!(refused(&off), Some(StepError::InconsistentStart { constraint: "rod", .. })));
}

#[test]
fn what_is_not_built_is_refused() {
    let refused = |system: &dyn System, plan: &Plan| system.begin(plan).err().map(|error| error.to_string());
    let stages = Plan { stages: Some(5), ..plan(Method::Gauss, 0.1) };
    let message = refused(&*kepler(), &stages).expect("an error");
    assert_eq!(message, "number of stages must be one that is built, not 5.0");
    let alone = kind!(Kepler, { gauss 8 });
    assert_eq!(alone.begin(&plan(Method::Fixed, 0.1)).err(), Some(StepError::NoRule { system: "Kepler" }));
    let pendulum = kind!(Pendulum, { transformed 8 });
    let short = Plan { dtau: Some(0.1), q: vec![1.0], v: vec![0.0], ..plan(Method::Gauss, 0.1) };
    assert_eq!(pendulum.begin(&short).err(), Some(StepError::NoTimeScale { system: "Pendulum" }));
    let long = Plan { q: vec![1.0; 3], ..plan(Method::Gauss, 0.1) };
    assert!(matches!(kepler().begin(&long).err(), Some(StepError::InvalidInput { .. })));
}

#[test]
fn a_system_tells_its_declaration() {
    let system = kepler();
    assert!(!system.about().is_empty(), "{}", system.about());
    assert!(system.definition().contains("\n    coord x, y;\n    let r = sqrt(x^2 + y^2);\n"), "as it was written");
    assert_eq!(system.coordinates(), ["x", "y"]);
    assert_eq!(system.parameters(), [("mu", 1.0)]);
    assert_eq!(system.parameters_about().len(), 1);
    assert!(system.conserves_energy() && system.has(Method::Energy) && system.integrators().len() == 9);
}

mod verlet {
    vi_core::lagrangian! {
        /// An oscillator by the trapezoidal rule, which has no energy-preserving steps.
        pub(super) struct Verlet {
            coord x;
            L = dot(x)^2 / 2 - x^2 / 2;
            discretize trapezoidal;
        }
    }
}

#[test]
fn a_rule_without_a_step_density_has_fixed_steps() {
    let system = kind!(verlet::Verlet, { fixed_2; gauss 4 });
    let methods: Vec<Method> = system.integrators().into_iter().map(|(method, ..)| method).collect();
    assert_eq!(methods, [Method::Fixed, Method::Gauss]);
}
