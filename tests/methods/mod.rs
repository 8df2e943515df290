//! The conformance suite: properties of every method for every system that it takes.
//!
//! A [`Claim`] is a function of a [`Case`]: a system of [`systems`] with a method of [`METHODS`], behind the traits of
//! `vi-erased`. So a claim is written and compiled once. If a method does not have a property, its entry states this,
//! and the claim asserts it. Every claim also has a test that it fails for runs with a fault (`spoiled`).
//!
//! | module | claims |
//! |---|---|
//! | `motion` | order, energy error, reversal |
//! | `structure` | momenta, symplecticity, preserved energy |
//! | `steps` | latched errors, single steps of any length, refused lengths |
//! | `output` | output at times, dense output, events |
//! | `changes` | checkpoints, changes of parameters and states |
//! | `derivatives` | tangent vectors, second derivatives, gradients, linearizations |
//! | `estimates` | error of a step, monitor |
//! | `accurate` | the motion that they compare with |

mod accurate;
mod changes;
mod derivatives;
mod estimates;
mod motion;
mod output;
mod spoiled;
mod steps;
mod structure;
mod systems;

use accurate::Motion;
use spoiled::Fault;
use systems::{SCENES, Scene};
use vi_core::StepError;
use vi_erased::plan::{self, Built, Shift, Start};
use vi_erased::system::Quantity;
use vi_erased::{PhasePoint, Plan, Simulation, System};

/// A method, and what it promises.
#[derive(Debug)]
struct Method {
    name: &'static str,
    built: Built,
    start: Start,
    order: u32,
    /// Its steps, in those of the scene: long enough to see the order above rounding.
    stretch: f64,
    /// Whether it preserves a discrete energy by the lengths of its steps. If not, its maps are symplectic, unless it
    /// steps in transformed time.
    keeps_energy: bool,
    /// The least order of the error of dense output within one step, in q and h·v.
    dense: u32,
}

impl Method {
    /// Whether steps begin at equal distances in time.
    fn has_equal_steps(&self) -> bool {
        !self.keeps_energy && !self.built.2 && !self.follows_motion()
    }

    /// Whether tangent vectors are differences of its runs. Runs from a midpoint or from two points do not begin at the
    /// start; lengths that follow the motion are held fixed.
    fn has_tangents(&self) -> bool {
        self.start == Start::State && !self.follows_motion()
    }

    /// Whether the lengths of its steps follow the motion.
    fn follows_motion(&self) -> bool {
        self.built.0 == plan::Method::Adaptive
    }
}

const fn equal(name: &'static str, method: plan::Method, [order, dense]: [u32; 2], stretch: f64) -> Method {
    let (built, start) = ((method, None, false), Start::State);
    Method { name, built, start, order, stretch, keeps_energy: false, dense }
}

/// Gauss steps have an order of twice the stages, and dense output is the polynomial of their stages.
const fn gauss(name: &'static str, stages: u32, is_transformed: bool, stretch: f64) -> Method {
    let built = (plan::Method::Gauss, Some(stages as usize), is_transformed);
    let (order, dense) = (2 * stages, stages + 1);
    Method { name, built, start: Start::State, order, stretch, keeps_energy: false, dense }
}

const fn adaptive(name: &'static str, stages: u32, stretch: f64) -> Method {
    let built = (plan::Method::Adaptive, Some(stages as usize), false);
    Method { built, ..gauss(name, stages, false, stretch) }
}

const fn energy(name: &'static str, start: Start) -> Method {
    let built = (plan::Method::Energy, None, false);
    Method { name, built, start, order: 2, stretch: 1.0, keeps_energy: true, dense: 3 }
}

const fn energy_gauss(name: &'static str, stages: u32, stretch: f64) -> Method {
    let built = (plan::Method::Energy, Some(stages as usize), false);
    Method { built, keeps_energy: true, ..gauss(name, stages, false, stretch) }
}

const METHODS: [Method; 21] = [
    equal("fixed", plan::Method::Fixed, [2, 3], 1.0),
    equal("Suzuki 4", plan::Method::Suzuki4, [4, 4], 2.0),
    equal("Kahan–Li 6", plan::Method::KahanLi6, [6, 4], 4.0),
    equal("Kahan–Li 8", plan::Method::KahanLi8, [8, 4], 6.0),
    equal("splitting 4", plan::Method::Splitting4, [4, 4], 2.0),
    equal("splitting 6", plan::Method::Splitting6, [6, 4], 4.0),
    gauss("Gauss 1", 1, false, 1.0),
    gauss("Gauss 2", 2, false, 2.0),
    gauss("Gauss 3", 3, false, 3.0),
    gauss("Gauss 4", 4, false, 5.0),
    gauss("Gauss 8", 8, false, 16.0),
    adaptive("adaptive 3", 3, 3.0),
    adaptive("adaptive 4", 4, 5.0),
    gauss("transformed Gauss 4", 4, true, 6.0),
    gauss("transformed Gauss 8", 8, true, 14.0),
    energy("energy", Start::State),
    energy("energy from the midpoint", Start::Midpoint),
    energy("energy from two points", Start::Points),
    energy_gauss("energy 1", 1, 1.0),
    energy_gauss("energy 2", 2, 2.0),
    energy_gauss("energy 3", 3, 4.0),
];

/// A node of a run.
#[derive(Clone, Debug, PartialEq)]
struct Node {
    t: f64,
    q: Vec<f64>,
    p: Vec<f64>,
}

impl Node {
    fn of(run: &dyn Simulation) -> Self {
        Self { t: run.t(), q: run.q().to_vec(), p: run.p().to_vec() }
    }

    /// The largest difference of coordinates and momenta.
    fn off(&self, other: &Self) -> f64 {
        largest(self.q.iter().zip(&other.q).chain(self.p.iter().zip(&other.p)).map(|(one, other)| one - other))
    }

    /// Coordinates, then momenta.
    fn numbers(&self) -> Vec<f64> {
        [&self.q[..], &self.p].concat()
    }
}

/// The largest absolute value; NaN if there is one.
fn largest(of: impl IntoIterator<Item = f64>) -> f64 {
    of.into_iter().map(f64::abs).fold(0.0, |most, number| if number > most || number.is_nan() { number } else { most })
}

/// A system with a method.
struct Case {
    scene: &'static Scene,
    method: &'static Method,
    system: Box<dyn System>,
    /// The time scale at the start: steps in transformed time have the same Δτ everywhere.
    scale: Option<f64>,
    /// The shift of energy-preserving Gauss steps.
    shift: Option<f64>,
}

/// A property of a case; the error says how it is violated.
type Claim = fn(&Case) -> Result<(), String>;

/// Ends a claim unless a condition holds.
macro_rules! ensure {
    ($holds:expr, $($text:tt)+) => {
        let holds: bool = $holds;
        if !holds {
            return Err(format!($($text)+));
        }
    };
}
use ensure;

impl Case {
    /// Whether the lengths of the steps follow an error: those of a motion without a conserved energy.
    fn follows_error(&self) -> bool {
        self.method.follows_motion() && !self.system.conserves_energy()
    }

    /// The cases of a system.
    fn of(scene: &'static Scene, fault: Option<Fault>) -> Vec<Self> {
        let mut system = (scene.system)();
        for (name, value) in scene.parameters {
            assert!(system.set(name, *value), "{} has no parameter {name}", scene.name);
        }
        let system = match fault {
            Some(fault) => spoiled::system(system, fault),
            None => system,
        };
        let built = system.integrators();
        let has_density = |method: &Method| scene.has_density || method.built != (plan::Method::Energy, None, false);
        let methods = METHODS.iter().filter(|method| built.contains(&method.built) && has_density(method));
        methods.map(|method| Self::new(scene, method, system.copy())).collect()
    }

    fn new(scene: &'static Scene, method: &'static Method, system: Box<dyn System>) -> Self {
        let mut case = Self { scene, method, system, scale: None, shift: None };
        let start = case.start().unwrap_or_else(|error| panic!("{}: {error}", case.name()));
        case.scale = method.built.2.then(|| case.system.time_scale(&start).expect("a time scale"));
        if method.keeps_energy && method.built.1.is_some() {
            let plan = Plan { shift: Some(Shift::Over(100.0 * scene.h)), ..case.plan(case.h(), start, None) };
            let run = case.system.begin(&plan).unwrap_or_else(|error| panic!("{}: {error}", case.name()));
            case.shift = run.shifted_energy().map(|of| of.shift);
        }
        case
    }

    /// The same case with another system.
    fn of_system(&self, system: Box<dyn System>) -> Self {
        Self { system, ..*self }
    }

    fn name(&self) -> String {
        format!("{}, {}", self.scene.name, self.method.name)
    }

    fn is_free(&self) -> bool {
        self.system.constraints().is_empty()
    }

    /// The step of the method.
    fn h(&self) -> f64 {
        self.scene.h * self.method.stretch
    }

    /// The start, on the constraints.
    fn start(&self) -> Result<PhasePoint, StepError> {
        let Scene { t, q, v, .. } = *self.scene;
        Ok(self.system.project(&PhasePoint { t, q: q.to_vec(), v: v.to_vec() })?.point)
    }

    /// A run with steps of length h from the start.
    fn with(&self, h: f64) -> Result<Box<dyn Simulation>, StepError> {
        let start = self.start()?;
        self.begin(h, start, None)
    }

    /// A run with steps of length h from a node.
    fn from(&self, h: f64, node: &Node) -> Result<Box<dyn Simulation>, StepError> {
        let Node { t, q, p } = node.clone();
        let mut v = Vec::new();
        self.system.evaluate(Quantity::Velocity, [&[t], &q, &p], &mut v)?;
        self.begin(h, PhasePoint { t, q, v }, Some(p))
    }

    fn begin(&self, h: f64, at: PhasePoint, p: Option<Vec<f64>>) -> Result<Box<dyn Simulation>, StepError> {
        self.system.begin(&self.plan(h, at, p))
    }

    fn plan(&self, h: f64, at: PhasePoint, p: Option<Vec<f64>>) -> Plan {
        let (method, stages, _) = self.method.built;
        let (dtau, shift) = (self.scale.map(|scale| h / scale), self.shift.map(Shift::Of));
        Plan { start: self.method.start, stages, dtau, shift, p, ..Plan::new(method, h, at) }
    }

    /// The run of most claims.
    fn run(&self) -> Result<Box<dyn Simulation>, String> {
        self.with(self.h()).map_err(|error| error.to_string())
    }

    /// How far a node is off the constraints and their rates; zero without any.
    fn residual(&self, Node { t, q, p }: &Node) -> Result<f64, StepError> {
        let (mut v, mut residuals) = (Vec::new(), Vec::new());
        self.system.evaluate(Quantity::Velocity, [&[*t], q, p], &mut v)?;
        self.system.evaluate(Quantity::Residuals, [&[*t], q, &v], &mut residuals)?;
        Ok(largest(residuals))
    }

    /// The accurate motion from a node.
    fn motion(&self, from: &Node) -> Result<Motion<'_>, String> {
        Motion::new(&*self.system, from, 2.0 * self.scene.h).map_err(|error| error.to_string())
    }
}

/// Advances a run.
fn advance(run: &mut dyn Simulation, steps: u64) -> Result<(), String> {
    run.advance_by(steps).map_err(|error| error.to_string())
}

/// Asserts a claim for every system with every method.
fn holds(claim: Claim) {
    let mut count = 0;
    let mut violations = Vec::new();
    for case in SCENES.iter().flat_map(|scene| Case::of(scene, None)) {
        count += 1;
        if let Err(violation) = claim(&case) {
            violations.push(format!("{}: {violation}", case.name()));
        }
    }
    assert!(violations.is_empty(), "{} of {count}:\n{}", violations.len(), violations.join("\n"));
    assert!(count > 90, "{count} cases");
}

/// Asserts that a claim fails for the runs with a fault of one system, by every method that `is_spoiled` selects.
fn fails(claim: Claim, scene: &str, fault: Fault, is_spoiled: fn(&Method) -> bool) {
    let scene = SCENES.iter().find(|entry| entry.name == scene).expect("a system of the list");
    let cases = Case::of(scene, Some(fault)).into_iter().filter(|case| is_spoiled(case.method));
    let held: Vec<_> = cases.map(|case| (case.name(), claim(&case))).collect();
    assert!(!held.is_empty() && held.iter().all(|(_, held)| held.is_err()), "{fault:?} is not noticed: {held:?}");
}
