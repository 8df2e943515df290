//! Runs that leave a table: every method names it, in a step, at the start and after a change.

use crate::systems::{Fields, Potential, UnitMass};
use vi_core::function::Jets;
use vi_core::lagrangian::{Parameters, Undefined};
use vi_core::motion::{Motion, Point, PointDerivatives, TimeScale};
use vi_core::nalgebra::SMatrix;
use vi_core::prelude::*;
use vi_core::real::Real;
use vi_core::stepping::Convertible;
use vi_core::table::Table;
use vi_core::{Lagrangian, SVector};

/// `V = −slope(x)` and the force `−drag(v)`: it runs to the end of the first table, or to that of the second.
#[derive(Clone, Copy)]
struct Slide {
    slope: &'static Table<4, 4>,
    drag: &'static Table<4, 4>,
}

static SHORT: Table<4, 4> = Table::cubic([-1.0, 0.0, 0.5, 1.0], [-0.9, 0.0, 0.55, 1.0]);
static FLAT: Table<4, 4> = Table::cubic([-1.0, 0.0, 0.5, 1.0], [0.0; 4]).hold();
static LONG: Table<4, 4> = Table::cubic([-1.0, 0.0, 0.5, 1.0], [-0.9, 0.0, 0.55, 1.0]).extend();
static SLOW: Table<4, 4> = Table::cubic([-0.5, 0.0, 0.25, 0.75], [-0.05, 0.0, 0.03, 0.1]);

const END_OF_SLOPE: Slide = Slide { slope: &SHORT, drag: &FLAT };
const END_OF_DRAG: Slide = Slide { slope: &LONG, drag: &SLOW };

impl<T: Real> Potential<1, T> for Slide {
    fn fields(&self, _: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> Fields<1, T> {
        let (slope, [by_x], [[by_xx]]) = self.slope.jet_2([q[0]]);
        let (drag, [by_v]) = self.drag.jet_1([v[0]]);
        let fields = Fields::potential(-slope, slope.abs(), SVector::repeat(-by_x), SMatrix::repeat(-by_xx));
        Fields { force: SVector::repeat(-drag), force_v: SMatrix::repeat(-by_v), ..fields }
    }

    fn undefined(&self, q: &SVector<T, 1>, v: &SVector<T, 1>) -> Option<Undefined> {
        self.slope.undefined("slope(x)", [q[0]]).or_else(|| self.drag.undefined("drag(dot(x))", [v[0]]))
    }
}

impl<T: Real> Motion<1, T> for UnitMass<Slide> {
    type Kind = vi_core::kind::Free;
    type Mass = SMatrix<T, 1, 1>;
    type PointMatrix = SMatrix<T, 1, 1>;
    const CONSTANT_MASS: bool = true;
    const SEPARABLE: bool = false;
    const SCALES_TIME: bool = true;

    fn point(&self, t: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> Point<1, T, Self::Mass> {
        let Fields { force, gradient, .. } = self.0.fields(t, q, v);
        Point { momentum: *v, force: force - gradient, mass: SMatrix::identity() }
    }

    fn point_derivatives(&self, t: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> PointDerivatives<Self::Mass> {
        let Fields { force_v, hessian, .. } = self.0.fields(t, q, v);
        PointDerivatives {
            momentum_dq: SMatrix::zeros(),
            mass: SMatrix::identity(),
            force_dq: -hessian,
            force_dv: force_v,
        }
    }

    fn power(&self, t: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> T {
        self.force(t, q, v).dot(v)
    }
}

impl<T: Real> TimeScale<1, T> for UnitMass<Slide> {}

impl<T: Real> Parameters<T> for UnitMass<Slide> {
    fn parameter_mut(&mut self, _: &str) -> Option<&mut T> {
        None
    }
}

impl Convertible<1> for UnitMass<Slide> {
    type In<T: Real> = Self;
    fn convert<T: Real>(&self) -> Self {
        *self
    }
}

/// The failure of a run, which ends within 10 000 steps.
fn failure<M: Method<UnitMass<Slide>, 1>>(slide: Slide, method: M, h: f64) -> StepError {
    let mut run = UnitMass(slide).at(0.0, [0.1], [0.2]).integrate(method, h).unwrap_or_else(|error| panic!("{error}"));
    let error = (0..10_000).find_map(|_| run.step().err()).unwrap_or_else(|| panic!("no failure"));
    assert_eq!(run.step(), Err(error));
    assert!(run.state().q[0].is_finite() && run.state().p[0].is_finite());
    // A longer step from there fails for the same reason.
    let again = run.step_of(run.h() * 1.5).expect_err("still outside");
    assert!(matches!(again, StepError::Undefined { .. }), "{again}");
    error
}

/// Whether an error names the table that is left, with its argument outside of its range, and gives advice.
#[track_caller]
fn assert_named(error: StepError, slide: Slide) {
    let is_short = core::ptr::eq(slide.slope, &raw const SHORT);
    let (name, ends) = if is_short { ("slope(x)", [-1.0, 1.0]) } else { ("drag(dot(x))", [-0.5, 0.75]) };
    let StepError::Undefined { t, function, argument, range } = error else { panic!("{error}") };
    assert!(function == name && range == Some(ends) && t.is_finite(), "{error}");
    assert!(argument > ends[1] && argument < ends[1] + 0.5, "{error}");
    let text = error.to_string();
    assert!(
        text.starts_with(&format!("`{name}` is given for {} to {}, not at {argument}", ends[0], ends[1])),
        "{text}"
    );
    assert!(text.contains("; write `hold` or `extend`"), "{text}");
}

#[test]
fn every_method_names_the_table_that_it_leaves() {
    for slide in [END_OF_SLOPE, END_OF_DRAG] {
        for h in [0.01, 0.1, 0.37] {
            assert_named(failure(slide, FixedStep, h), slide);
            assert_named(failure(slide, Gauss::<1>, h), slide);
            assert_named(failure(slide, Gauss::<3>, h), slide);
            assert_named(failure(slide, Gauss::<8>, h), slide);
            assert_named(failure(slide, Gauss::<2>.in_transformed_time(), h), slide);
            assert_named(failure(slide, Composition::SUZUKI_4, h), slide);
        }
        for h in [0.01, 0.05] {
            assert_named(failure(slide, EnergyPreserving, h), slide);
            assert_named(failure(slide, EnergyPreservingGauss::<2>, h), slide);
        }
    }
}

#[test]
fn a_start_or_a_change_outside_names_the_table() {
    let system = UnitMass(END_OF_SLOPE);
    let outside = State { t: 0.0, q: [1.25].into(), p: [0.2].into() };
    macro_rules! check {
        ($($method:expr),*) => {$(
            let mut run = system.at(0.0, [0.1], [0.2]).integrate($method, 0.01).unwrap_or_else(|error| panic!("{error}"));
            // A fixed step asks for no force before its first step.
            let error = run.set_state(outside).and_then(|()| run.step().map(|_| ())).expect_err("outside");
            assert_named(error, END_OF_SLOPE);
            let start = system.at_state(outside).integrate($method, 0.01).and_then(|mut run| run.step());
            assert_named(start.expect_err("outside"), END_OF_SLOPE);
        )*};
    }
    check!(FixedStep, Gauss::<3>, Gauss::<2>.in_transformed_time(), EnergyPreserving);
    check!(EnergyPreservingGauss::<1>, Composition::SUZUKI_4);
    assert_named(outside.energy(&system).expect_err("outside"), END_OF_SLOPE);
    assert_named(outside.flow(&system).expect_err("outside"), END_OF_SLOPE);
    let fast = State { t: 0.0, q: [0.1].into(), p: [1.0].into() };
    assert_named(fast.flow(&UnitMass(END_OF_DRAG)).expect_err("outside"), END_OF_DRAG);
    // A velocity does not need the force.
    assert_eq!(outside.velocity(&system), Ok([0.2].into()));
}

#[test]
fn a_function_that_is_not_finite_is_named() {
    let error = StepError::Undefined { t: 0.5, function: "cl(a)", argument: 1.7, range: None };
    let text = "`cl(a)` is not finite at 1.7, past t = 0.500000000; return a finite number there, or stop the run before it gets there";
    assert_eq!(error.to_string(), text);
}

/// A system before and after the points of its table have changed.
mod before {
    vi_core::lagrangian! {
        pub(super) struct Well {
            coord x;
            table V(x) = [(-1, 1), (0, 0), (1, 1), (2, 4)] extend;
            L = dot(x)^2 / 2 - V(x);
        }
    }
}

mod after {
    vi_core::lagrangian! {
        pub(super) struct Well {
            coord x;
            table V(x) = [(-1, 1), (0, 0), (1, 1), (2, 4.5)] extend;
            L = dot(x)^2 / 2 - V(x);
        }
    }
}

#[test]
fn a_checkpoint_is_not_resumed_with_other_tables() {
    let mut run = before::Well::default().at(0.0, [0.5], [0.0]).integrate(Gauss::<2>, 0.1).expect("a start");
    run.step().expect("a step");
    let resumed = Run::restart(before::Well::default(), Gauss::<2>, run.checkpoint()).expect("its own system");
    assert_eq!(resumed.state(), run.state());
    let failure = Run::restart(after::Well::default(), Gauss::<2>, run.checkpoint()).err();
    let Some(failure @ StepError::OtherSystem { parameter: None, .. }) = failure else { panic!("{failure:?}") };
    assert!(failure.to_string().contains("tables of other numbers"), "{failure}");
}
