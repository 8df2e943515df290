//! Constraints: their kinds, names and order; what is emitted for them; their functions against steps computed with 40
//! digits (`constraints.json`), and against differences.

use std::collections::BTreeMap;
use vi_codegen::program::{FunctionId, OperationId, Output};
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::{Derived, derive, expand, syntax::parse};

/// The system of these lines.
fn derived(body: &str) -> Derived {
    let text = format!("struct System {{ {body} }}");
    let system = parse::system(text.parse().expect("tokens")).unwrap_or_else(|error| panic!("{text}: {error}"));
    derive(&system).unwrap_or_else(|error| panic!("{text}: {error}")).own
}

/// The expansion of these lines, without white space.
fn expanded(body: &str) -> String {
    let text = format!("struct System {{ {body} }}");
    expand(text.parse().expect("tokens")).to_string().split_whitespace().collect()
}

/// Names of the constraints in order, `~` before those on velocities.
fn names(body: &str) -> Vec<String> {
    let Derived { model, .. } = derived(body);
    let mark = |is_holonomic: bool| if is_holonomic { "" } else { "~" };
    model.constraints.iter().map(|of| format!("{}{}", mark(of.is_holonomic), of.text())).collect()
}

/// Numbers of the inputs of a function.
#[derive(Clone)]
struct Inputs {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    multipliers: Vec<f64>,
}

impl Inputs {
    fn of(&self, symbol: &Symbol) -> f64 {
        match symbol {
            Symbol::Continuous(Variable::Time) => self.t,
            Symbol::Continuous(Variable::Coordinate(index)) => self.q[*index],
            Symbol::Continuous(Variable::Velocity(index)) => self.v[*index],
            Symbol::Multiplier(index) => self.multipliers[*index],
            Symbol::Parameter { .. } => 0.7,
            other => panic!("{other:?}"),
        }
    }
}

/// The rows of a quantity of a function.
fn rows(derived: &Derived, id: FunctionId, output: Output, inputs: &Inputs) -> Vec<Vec<f64>> {
    let function = derived.program.function(id).unwrap_or_else(|| panic!("{}", id.name()));
    let values = function.evaluate(&mut |symbol| inputs.of(symbol));
    let values: BTreeMap<OperationId, f64> = function.results.entries().copied().zip(values).collect();
    let row = |row: &Vec<OperationId>| row.iter().map(|id| values[id]).collect();
    function.results.matrix(output).iter().map(row).collect()
}

/// A vector among the quantities of a function.
fn row(derived: &Derived, id: FunctionId, output: Output, inputs: &Inputs) -> Vec<f64> {
    rows(derived, id, output, inputs).into_iter().next().unwrap_or_default()
}

/// A v + a of each constraint.
fn rates(derived: &Derived, at: &Inputs) -> Vec<f64> {
    let gradients = rows(derived, FunctionId::ConstraintGradients, Output::Gradients, at);
    let rests = row(derived, FunctionId::ConstraintGradients, Output::Rates, at);
    let product = |row: &Vec<f64>| row.iter().zip(&at.v).map(|(a, v)| a * v).sum::<f64>();
    gradients.iter().zip(rests).map(|(row, rest)| product(row) + rest).collect()
}

/// Aᵀ times multipliers.
fn reaction(derived: &Derived, at: &Inputs, multipliers: &[f64]) -> Vec<f64> {
    let gradients = rows(derived, FunctionId::ConstraintGradients, Output::Gradients, at);
    (0..at.q.len()).map(|i| gradients.iter().zip(multipliers).map(|(row, factor)| row[i] * factor).sum()).collect()
}

#[test]
fn kinds_names_and_order() {
    let rest = "coord x, y, z, r[3][3], θ; L = dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(θ)^2 + sum(i in 0..3, dot(r[i]) * dot(r[i]));";
    let of = |lines: &str| names(&format!("{lines} {rest}"));
    assert_eq!(of("constraint rod = x^2 + y^2 - 1;"), ["rod"]);
    // Positions first, each kind in order of declaration.
    assert_eq!(
        of("constraint blade = dot(x) * sin(θ) - dot(y) * cos(θ), rod = x^2 + z^2 - 1; constraint rail = z - y^2;"),
        ["rod", "rail", "~blade"]
    );
    // Arrays in pieces, from any index on; entries may be of both kinds.
    assert_eq!(
        of(
            "constraint link[0] = r[0] * r[0] - 1; constraint link[i in 1..3] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - 1;"
        ),
        ["link[0]", "link[1]", "link[2]"]
    );
    assert_eq!(of("constraint pair[i in -1..1] = r[i + 1][0] - r[i + 1][1]^2;"), ["pair[-1]", "pair[0]"]);
    // Vectors and matrices give one constraint for each entry.
    assert_eq!(of("constraint joint = r[0] - r[1];"), ["joint[0]", "joint[1]", "joint[2]"]);
    assert_eq!(of("constraint joint[i in 1..2] = [r[i] * r[0], z - x * y];"), ["joint[1][0]", "joint[1][1]"]);
    assert_eq!(
        of("constraint m = [[x - y, y - z], [z * θ, 1 - r[0][0]]];"),
        ["m[0][0]", "m[0][1]", "m[1][0]", "m[1][1]"]
    );
    assert_eq!(of("constraint both = [dot(x) * y - dot(z), x - z^2];"), ["both[1]", "~both[0]"]);
    // Velocities that cancel leave a constraint on positions.
    assert_eq!(of("constraint c = dot(x) - dot(x) + y - z;"), ["c"]);
    // A product that is linear once expanded.
    assert_eq!(of("constraint c = (dot(x) + z)^2 - dot(x)^2 - dot(y) * x;"), ["~c"]);
    // The names may be those of functions of vectors, and of anything else that is free.
    assert_eq!(of("constraint lambda = x - y, constraints = y - z;"), ["lambda", "constraints"]);
}

#[test]
fn functions_of_both_kinds() {
    let Derived { pool, model, system, .. } = derived(
        "param l = 1, w = 2; coord x, y; constraint blade = y * dot(x) - (x + t) * dot(y) - w * x; \
         L = dot(x)^2 + dot(y)^2 - l * y;",
    );
    let of = system.constraints.expect("the constraints");
    let text = |expr| pool.render(expr, &|symbol| model.spell(symbol));
    assert_eq!(text(of.values[0]), "0");
    assert_eq!([text(of.gradients[0][0]), text(of.gradients[0][1]), text(of.rates[0])], ["y", "-x - t", "-w*x"]);
    assert_eq!([text(of.rates_dq[0][0]), text(of.rates_dq[0][1])], ["-w - dot(y)", "dot(x)"]);
    assert_eq!(text(of.rates_dt[0]), "-dot(y)");
    let reaction: Vec<String> = of.reaction_dq.iter().flatten().map(|entry| text(*entry)).collect();
    assert_eq!(reaction, ["0", "λ_blade", "-λ_blade", "0"]);
    // Time in a constraint, and a reaction on a coordinate that is absent from L.
    assert!(!system.continuous.autonomous);
    assert_eq!(system.continuous.cyclic, [false, false]);
    let Derived { system, .. } =
        derived("coord x, y, z; constraint rod = y^2 + z^2 - 1; L = dot(x)^2 + dot(y)^2 + dot(z)^2 - z;");
    assert!(system.continuous.autonomous);
    assert_eq!(system.continuous.cyclic, [true, false, false]);
}

/// The heavy top of `constraints.json` in the words of the language.
const HEAVY_TOP: &str = "rotation R; let ω = rate(R), axis = turn(R, [0, 0, 1]); \
    L = (ω[0]^2 + ω[1]^2 + ω[2]^2 / 2) / 2 - 2 * axis[2];";

/// The first midpoint step with constraints of a system of `constraints.json`, with the impulses λ and μ.
struct Case {
    name: &'static str,
    body: &'static str,
    h: f64,
    q0: &'static [f64],
    p0: &'static [f64],
    q1: &'static [f64],
    p1: &'static [f64],
    v1: &'static [f64],
    lambda: &'static [f64],
    mu: &'static [f64],
}

/// ```text
/// L_v(t½, q½, v) = p0 + (h/2) F + A0ᵀ λ        p1 = p0 + h F + A0ᵀ λ + A1ᵀ μ = L_v(t1, q1, v1)
/// g(t1, q1) = 0, or A v + a = 0 at the midpoint        A1 v1 + a1 = 0
/// ```
#[test]
fn steps_of_forty_digits_satisfy_the_equations() {
    let mut largest = (0.0_f64, "none");
    let heavy_top = CASES.iter().find(|case| case.name == "heavy_top").expect("the heavy top");
    let by_rotation = Case { name: "heavy top by `rotation`", body: HEAVY_TOP, ..*heavy_top };
    for Case { name, body, h, q0, p0, q1, p1, v1, lambda, mu } in CASES.iter().chain([&by_rotation]) {
        let derived = derived(body);
        let at = |t: f64, q: Vec<f64>, v: Vec<f64>| Inputs { t, q, v, multipliers: lambda.to_vec() };
        let none = vec![f64::NAN; q0.len()];
        let [start, end] = [at(0.0, q0.to_vec(), none), at(*h, q1.to_vec(), v1.to_vec())];
        let mean = q0.iter().zip(*q1).map(|(left, right)| (left + right) / 2.0).collect();
        let v = q0.iter().zip(*q1).map(|(left, right)| (right - left) / h).collect();
        let middle = at(h / 2.0, mean, v);
        let point = |output, at: &Inputs| row(&derived, FunctionId::Point, output, at);
        let (momentum, force) = (point(Output::Momentum, &middle), point(Output::AppliedForce, &middle));
        let (before, after) = (reaction(&derived, &start, lambda), reaction(&derived, &end, mu));
        let mut residuals = Vec::new();
        for i in 0..q0.len() {
            let kicked = p0[i] + before[i];
            residuals.push(kicked + h / 2.0 * force[i] - momentum[i]);
            residuals.push(kicked + h * force[i] + after[i] - p1[i]);
        }
        residuals.extend(point(Output::Momentum, &end).iter().zip(*p1).map(|(momentum, p1)| momentum - p1));
        residuals.extend(rates(&derived, &end));
        residuals.extend(row(&derived, FunctionId::Constraints, Output::Value, &end));
        let moving = rates(&derived, &middle).into_iter().zip(&derived.model.constraints);
        residuals.extend(moving.filter(|(_, of)| !of.is_holonomic).map(|(rate, _)| rate));
        assert_eq!(derived.model.constraints.len(), mu.len(), "{name}");
        for residual in residuals {
            if residual.is_nan() || residual.abs() > largest.0 {
                largest = (residual.abs(), name);
            }
        }
    }
    let (residual, name) = largest;
    println!("largest residual {residual:e} of {name}");
    assert!(residual <= TOLERANCE, "{name}: {residual:e}");
}

#[test]
fn derivatives_are_those_of_the_rates() {
    // Measured 1.7e-9: h² times third derivatives, and rounding over h.
    let (h, mut largest) = (1e-5, 0.0_f64);
    let further = "param a = 0.7; coord x, y, z; fn bump(s) = exp(-s^2) / (1 + s^2); \
                   constraint rail = bump(x - a * t) - z * sin(y), wheel = bump(x * y) * dot(z) - t * z^2 * dot(x) + cos(t * y); \
                   L = dot(x)^2 + dot(y)^2 + dot(z)^2;";
    for body in CASES.iter().map(|case| case.body).chain([further, HEAVY_TOP]) {
        let derived = derived(body);
        let (n, k) = (derived.model.dimension(), derived.model.constraints.len());
        let numbers = |count: usize, from: f64| {
            (0..count).map(|i| (from + 1.7 * f64::from(u32::try_from(i).unwrap_or(0))).sin()).collect()
        };
        let here = Inputs { t: 0.3, q: numbers(n, 0.5), v: numbers(n, 2.5), multipliers: numbers(k, 4.0) };
        let moved = |index: Option<usize>, by: f64| {
            let mut moved = here.clone();
            match index {
                Some(index) => moved.q[index] += by,
                None => moved.t += by,
            }
            moved
        };
        let mut compare = |analytic: f64, [after, before]: [f64; 2], what: &str| {
            let difference = (analytic - (after - before) / (2.0 * h)).abs();
            largest = largest.max(difference);
            assert!(difference <= 2e-9, "{body}: {what} {difference:e}");
        };
        let (id, of) = (FunctionId::ConstraintRateDerivatives, &derived);
        let by_time = row(of, id, Output::RatesDt, &here);
        let sides = [h, -h].map(|by| rates(of, &moved(None, by)));
        (0..k).for_each(|r| compare(by_time[r], [sides[0][r], sides[1][r]], "by t"));
        let by_place = rows(of, id, Output::RatesDq, &here);
        let of_reaction = rows(of, FunctionId::ReactionDerivatives, Output::ReactionDq, &here);
        for j in 0..n {
            let sides = [h, -h].map(|by| rates(of, &moved(Some(j), by)));
            (0..k).for_each(|r| compare(by_place[r][j], [sides[0][r], sides[1][r]], "by q"));
            let sides = [h, -h].map(|by| reaction(of, &moved(Some(j), by), &here.multipliers));
            (0..n).for_each(|i| compare(of_reaction[i][j], [sides[0][i], sides[1][i]], "of the reaction"));
            // A of a constraint on positions is the derivative of g.
            let sides = [h, -h].map(|by| row(of, FunctionId::Constraints, Output::Value, &moved(Some(j), by)));
            let gradients = rows(of, FunctionId::ConstraintGradients, Output::Gradients, &here);
            for r in (0..k).filter(|r| of.model.constraints[*r].is_holonomic) {
                compare(gradients[r][j], [sides[0][r], sides[1][r]], "of g");
            }
        }
    }
    println!("largest difference {largest:e}");
}

#[test]
fn only_methods_with_constraints_take_the_system() {
    let text = expanded("coord x, y; constraint rod = x^2 + y^2 - 1, pull[i in 0..0] = x; L = dot(x)^2 + dot(y)^2;");
    let traits = [
        "::vi_core::Lagrangian<2,T>forSystem<T>",
        "::vi_core::lagrangian::Parameters<T>forSystem<T>",
        "::vi_core::motion::Motion<2,T>forSystem<T>",
        "::vi_core::stepping::Convertible<2>forSystem<f64>",
    ];
    for name in traits {
        assert!(text.contains(name), "{name}: {text}");
    }
    for call in [
        "::vi_core::support::constrained_acceleration::<Self,2,T>(self,t,q,v)",
        "::vi_core::support::constrained_flow(self,t,q,p)",
        "constCONSTRAINTS:&'static[&'staticstr]=&[\"rod\"];constHOLONOMIC:usize=1;",
        "typeKind=::vi_core::kind::Bound<1,::vi_core::kind::Nonzeros<2,1>>;",
        "constGRADIENT_COLUMNS:&'static[&'static[::core::primitive::usize];1]=&[&[0,1]];",
        "constREACTION_COLUMNS:&'static[&'static[::core::primitive::usize];2]=&[&[0],&[1]];",
        "constPOINT_MASSES:bool=true;",
    ] {
        assert!(text.contains(call), "{call}: {text}");
    }
    let others =
        ["kind::Free", "Separable", "FixedStepping", "EnergyStepping", "DiscreteLagrangian", "Discretized", "Batch"];
    let found = |text: &str| others.map(|name| text.contains(name));
    assert_eq!(found(&text), [false; 7]);
    let plain = "coord x, y; L = dot(x)^2 + dot(y)^2; discretize midpoint;";
    assert_eq!(found(&expanded(plain)), [true; 7]);
    assert!(!expanded(plain).contains("onstrain"));
    // Systems with errors have the same traits.
    let broken = expanded("coord x, y; constraint rod = x^2 + y^2 - l^2; L = dot(x)^2 + dot(y)^2;");
    assert!(broken.contains("compile_error") && traits.iter().all(|name| broken.contains(name)), "{broken}");
    // Also if the constraint itself cannot be read.
    let unreadable = expanded("coord x, y; constraint x^2 + y^2 = 1; L = dot(x)^2 + dot(y)^2;");
    assert!(
        unreadable.contains("compile_error") && traits.iter().all(|name| unreadable.contains(name)),
        "{unreadable}"
    );
    assert_eq!(found(&broken), [false; 7]);
}

#[test]
fn a_long_chain_is_written_in_loops() {
    let chain = |count: usize| {
        let text = format!(
            "#[vi_limit(100)] struct Chain {{ const N = {count}; param l = 0.1; coord x[N], y[N]; \
             L = sum(i in 0..N, dot(x[i])^2 + dot(y[i])^2 - 9.81 * y[i]); constraint link[0] = x[0]^2 + y[0]^2 - l^2; \
             constraint link[i in 1..N] = (x[i] - x[i - 1])^2 + (y[i] - y[i - 1])^2 - l^2; }}"
        );
        expand(text.parse().expect("tokens")).to_string().split_whitespace().collect::<String>()
    };
    let function = |text: &str, name: &str| {
        let (_, from) = text.split_once(&format!("fn{name}(")).expect("the function");
        from.split("#[doc").next().expect("its text").to_owned()
    };
    let (short, long) = (chain(30), chain(60));
    for name in ["constraints", "constraint_gradients", "constraint_rate_derivatives", "reaction_derivatives"] {
        let lengths = [&short, &long].map(|text| function(text, name).len());
        println!("{name}: {lengths:?}");
        assert!(lengths[1] < lengths[0] + lengths[0] / 8, "{name}: {lengths:?}");
    }
}

#[test]
fn explanations_show_constraints() {
    let text = "struct Skate { param l = 1; coord x, y, θ; L = dot(x)^2 + dot(y)^2 + dot(θ)^2; \
                constraint blade = sin(θ) * dot(x) - cos(θ) * dot(y) + x; constraint rod[i in 2..3] = x^2 + y^2 - l^2; }";
    let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
    let explained = vi_codegen::inspect::explain(tokens.clone()).expect("a correct system");
    let shown = explained.text();
    for line in [
        "    g_rod[2] = x^2 + y^2 - l^2\n",
        "    A_rod[2],x = 2*x\n",
        "    A_blade,y = -cos(θ)\n",
        "    a_blade = x\n",
        "    Constraints on positions: rod (1)\n",
        "    Constraints on velocities: blade\n",
        "    The derivatives of the momentum rows are constant; coordinates and multipliers form one block of 5\n",
        "Order of elimination, block by block\n",
        "    x, y, θ, λ_rod[2], λ_blade\n",
        "    Autonomous; no force acts, but a constraint does work\n",
        "constraint_gradients",
    ] {
        assert!(shown.contains(line), "{line}: {shown}");
    }
    assert!(!shown.contains("Gauss steps") && !shown.contains("a_rod"), "{shown}");
    assert!(explained.latex().contains("A_{\\mathrm{rod}_{2},x} &= 2 x"), "{}", explained.latex());
    let stages = vi_codegen::inspect::explain_gauss(tokens.clone(), 3).expect("a correct system").text();
    assert!(stages.contains("Equations of a Gauss step"), "{stages}");
    let written = vi_codegen::inspect::stage(tokens.clone(), vi_codegen::inspect::Stage::Syntax).expect("clauses");
    assert!(written.contains("    constraint rod[i in 2..3] = x^2 + y^2 - l^2;\n"), "{written}");
    let rust = vi_codegen::inspect::stage(tokens, vi_codegen::inspect::Stage::Rust).expect("items");
    assert!(rust.contains("  Gauss, EnergyPreservingGauss: point"), "{rust}");
}

/// The value of an expression of a system with the rotation `R` and this head, at R and Ṙ.
fn value(head: &str, expression: &str, [place, moved]: [[f64; 4]; 2]) -> f64 {
    let body = format!("{head} rotation R; let ω = rate(R), value = {expression}; L = dot(R) * dot(R) + value;");
    let Derived { pool, model, .. } = derived(&body);
    let value = |of: &dyn Fn(f64) -> f64| {
        pool.evaluate(model.lagrangian, &mut |symbol| match symbol {
            Symbol::Continuous(Variable::Coordinate(index)) => place[*index],
            Symbol::Continuous(Variable::Velocity(index)) => of(moved[*index]),
            other => panic!("{other:?}"),
        })
    };
    value(&|v| v) - moved.iter().map(|v| v * v).sum::<f64>()
}

#[test]
fn functions_of_rotations() {
    // A turn by 2 a about the axis (2, 3, 6)/7, and a rate of change that keeps its length.
    let (sine, cosine) = 0.4_f64.sin_cos();
    let place = [cosine, sine * 2.0 / 7.0, sine * 3.0 / 7.0, sine * 6.0 / 7.0];
    let rate = [0.3, -0.7, 1.1];
    // Ṙ = R ∘ ω / 2, written out.
    let [a, b, c, d] = place;
    let [x, y, z] = rate;
    let moved = [-b * x - c * y - d * z, a * x + c * z - d * y, a * y + d * x - b * z, a * z + b * y - c * x];
    let moved = moved.map(|entry| entry / 2.0);
    let at = |expression: &str| value("", &format!("({expression}) * ω * ω / (ω * ω)"), [place, moved]);
    let near = |left: f64, right: f64, what: &str| {
        // Measured 5e-16.
        assert!((left - right).abs() <= 1e-15, "{what}: {left} is not {right}");
    };
    // The rotation matrix by Rodrigues' formula, as the columns that unit vectors become.
    let (axis, (sine, cosine)) = ([2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0], 0.8_f64.sin_cos());
    let cross =
        |u: [f64; 3], v: [f64; 3]| [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let turned = |r: [f64; 3]| {
        let (beside, along) = (cross(axis, r), axis.iter().zip(r).map(|(u, r)| u * r).sum::<f64>());
        [0, 1, 2].map(|i: usize| cosine * r[i] + sine * beside[i] + (1.0 - cosine) * along * axis[i])
    };
    let spatial = turned(rate);
    for i in 0..3 {
        let unit = |k: usize| f64::from(u8::from(i == k));
        near(at(&format!("ω * [{}, {}, {}]", unit(0), unit(1), unit(2))), rate[i], "rate");
        near(at(&format!("spin(R) * [{}, {}, {}]", unit(0), unit(1), unit(2))), spatial[i], "spin");
        let arm = turned([0.2, -0.5, 0.9]);
        near(at(&format!("turn(R, [0.2, -0.5, 0.9]) * [{}, {}, {}]", unit(0), unit(1), unit(2))), arm[i], "turn");
        // A point of the body moves with spin × arm.
        let speed = cross(spatial, arm);
        near(
            at(&format!("dot(turn(R, [0.2, -0.5, 0.9])) * [{}, {}, {}]", unit(0), unit(1), unit(2))),
            speed[i],
            "speed",
        );
    }
}

#[test]
fn torques_have_the_power_of_torque_times_angular_velocity() {
    let of = |clause: &str, power: &str| {
        let head =
            format!("rotation R[2]; let ω = rate(R[1]), s = spin(R[1]); L = dot(R[0]) * dot(R[0]) + ω * ω; {clause}");
        let plain = derived(&format!("{head} force R[0] = 0 * R[0];"));
        let forced = derived(&format!(
            "rotation R[2]; let ω = rate(R[1]), s = spin(R[1]); L = dot(R[0]) * dot(R[0]) + ω * ω + {power};"
        ));
        let at = |symbol: &Symbol| match symbol {
            Symbol::Continuous(Variable::Coordinate(index)) => {
                (1.0 + 1.7 * f64::from(u8::try_from(*index).unwrap_or(0))).sin()
            }
            Symbol::Continuous(Variable::Velocity(index)) => {
                (2.0 + 2.9 * f64::from(u8::try_from(*index).unwrap_or(0))).sin()
            }
            other => panic!("{other:?}"),
        };
        let forces = plain.pool.evaluate_all(&plain.model.forces, &mut |symbol| at(symbol));
        let worked: f64 =
            forces.iter().zip(0..).map(|(force, i)| force * at(&Symbol::Continuous(Variable::Velocity(i)))).sum();
        let with = forced.pool.evaluate(forced.model.lagrangian, &mut |symbol| at(symbol));
        let without = plain.pool.evaluate(plain.model.lagrangian, &mut |symbol| at(symbol));
        // Measured below: differences of L, which is about 30, round to 7e-15.
        assert!(
            (worked - (with - without)).abs() <= 1e-14 && worked.abs() > 0.1,
            "{clause}: {worked} {}",
            with - without
        );
    };
    of("torque R[1] = [0.3, -1.2, 2];", "[0.3, -1.2, 2] * ω");
    of("space_torque R[1] = [0.3, -1.2, 2];", "[0.3, -1.2, 2] * s");
    of("torque R[i in 0..2] = i * [1, 2, 3]; space_torque R[1] = [3, 2, 1]; ", "[1, 2, 3] * ω + [3, 2, 1] * s");
    of("torque R[1] = [1, 0, 0] * 2; force R[1] = [1, 2, 3, 4];", "2 * ω[0] + dot(R[1]) * [1, 2, 3, 4]");
}

#[test]
fn rotations_have_unit_constraints_and_regular_masses() {
    assert_eq!(names("coord x; rotation R; L = dot(x)^2 + rate(R) * rate(R);"), ["R"]);
    // A ball that rolls: both kinds; the constraints of rotations come first.
    let ball = "param r = 0.5; coord x, y; rotation R; let s = spin(R); L = (dot(x)^2 + dot(y)^2 + s * s) / 2; \
                constraint roll = [dot(x) - r * s[1], dot(y) + r * s[0]];";
    assert_eq!(names(ball), ["R", "~roll[0]", "~roll[1]"]);
    let chain = "const N = 2; coord x[N][3]; rotation R[N]; \
                 L = sum(i in 0..N, dot(x[i]) * dot(x[i]) + rate(R[i]) * rate(R[i])); \
                 constraint joint = x[0] + turn(R[0], [1, 0, 0]) - x[1] + turn(R[1], [1, 0, 0]);";
    assert_eq!(names(chain), ["R[0]", "R[1]", "joint[0]", "joint[1]", "joint[2]"]);
    // Inertia along R is added where L has none: 2 J (R·Ṙ)² with the mean J of the moments.
    let mass = |body: &str| {
        let Derived { pool, model, system, .. } = derived(body);
        pool.render(system.continuous.mass[0][0], &|symbol| model.spell(symbol))
    };
    assert_eq!(mass("rotation R; L = dot(R) * dot(R) / 2;"), "1");
    let [along, none] = [[0.8, 0.0, 0.6, 0.0], [0.0; 4]];
    let of = |body: &str| {
        let derived = derived(body);
        let at = Inputs { t: 0.0, q: along.to_vec(), v: none.to_vec(), multipliers: vec![0.0] };
        rows(&derived, FunctionId::Point, Output::Mass, &at)
    };
    let mass = of("rotation R; let ω = rate(R); L = (ω[0]^2 + 2 * ω[1]^2 + 3 * ω[2]^2) / 2;");
    let product: Vec<f64> = mass.iter().map(|row| row.iter().zip(along).map(|(m, r)| m * r).sum()).collect();
    // M R = 4 J R with J = 2.
    for (found, wanted) in product.iter().zip(along.map(|entry| 8.0 * entry)) {
        assert!((found - wanted).abs() <= 2e-15, "{product:?}");
    }
}

/// Largest residual, measured 7.1e-15: the heavy top, whose momenta are about 6.
const TOLERANCE: f64 = 8e-15;

const CASES: &[Case] = &[
    Case {
        name: "pendulum",
        body: "coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - 9.81 * y; constraint rod = x^2 + y^2 - 1;",
        h: 0.05,
        q0: &[0.6, -0.8],
        p0: &[0.8, 0.6],
        q1: &[0.633_568_236_943_697, -0.773_686_815_924_929_3],
        p1: &[0.539_621_324_095_123_6, 0.441_893_184_538_049_54],
        v1: &[0.539_621_324_095_123_6, 0.441_893_184_538_049_54],
        lambda: &[-0.107_196_050_938_383_68],
        mu: &[-0.103_969_396_741_178_14],
    },
    Case {
        name: "double_pendulum",
        body: "coord x1, y1, x2, y2; L = dot(x1)^2 + dot(y1)^2 + (dot(x2)^2 + dot(y2)^2) / 2 - 9.81 * (2 * y1 + y2); constraint inner = x1^2 + y1^2 - 1, outer = (x2 - x1)^2 + (y2 - y1)^2 - 1;",
        h: 0.05,
        q0: &[0.6, -0.8, 0.984_615_384_615_384_7, -1.723_076_923_076_923_2],
        p0: &[1.6, 1.2, -0.123_076_923_076_923_08, 0.215_384_615_384_615_4],
        q1: &[0.632_513_514_931_211_8, -0.774_549_322_786_718_2, 0.974_207_533_064_471_4, -1.714_360_579_354_731_2],
        p1: &[0.986_185_824_756_522_2, 0.805_340_401_238_525_6, -0.278_366_755_673_498_94, 0.122_184_994_720_603_89],
        v1: &[0.493_092_912_378_261_1, 0.402_670_200_619_262_8, -0.278_366_755_673_498_94, 0.122_184_994_720_603_89],
        lambda: &[-0.320_449_592_244_059_2, -0.110_604_140_323_744_96],
        mu: &[-0.303_997_059_405_920_76, -0.102_737_714_050_135_99],
    },
    Case {
        name: "heavy_top",
        body: "coord q[4]; let a = q[0], b = q[1], c = q[2], d = q[3]; let w0 = 2 * q * dot(q); let w1 = 2 * (a * dot(b) - b * dot(a) - c * dot(d) + d * dot(c)); let w2 = 2 * (a * dot(c) - c * dot(a) - d * dot(b) + b * dot(d)); let w3 = 2 * (a * dot(d) - d * dot(a) - b * dot(c) + c * dot(b)); L = (w0^2 + w1^2 + w2^2 + w3^2 / 2) / 2 - 2 * (a^2 - b^2 - c^2 + d^2); constraint unit = q * q - 1;",
        h: 0.025,
        q0: &[0.8, 0.4, 0.4, 0.2],
        p0: &[-0.16, 4.32, -5.92, 3.84],
        q1: &[0.786_793_740_234_398_4, 0.442_732_551_192_527_8, 0.342_771_684_911_806_76, 0.259_713_439_130_983_16],
        p1: &[-0.722_126_452_747_435_7, 3.921_223_623_264_526, -6.215_751_618_725_982_5, 3.706_758_081_985_563_4],
        v1: &[-0.648_015_803_622_628_6, 1.597_294_938_657_383_6, -2.350_856_496_828_045_6, 2.342_918_252_918_307_7],
        lambda: &[-0.369_787_030_821_057_4],
        mu: &[-0.369_624_644_317_625_5],
    },
    Case {
        name: "driven_pendulum",
        body: "coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - 9.81 * y; constraint rod = x^2 + (y - sin(6 * t) / 10)^2 - 1;",
        h: 0.05,
        q0: &[0.6, -0.8],
        p0: &[0.8, 1.2],
        q1: &[0.633_776_361_964_161_8, -0.743_964_315_952_215_6],
        p1: &[0.552_366_261_215_846_1, 1.025_780_155_798_285_3],
        v1: &[0.552_366_261_215_846_1, 1.025_780_155_798_285_3],
        lambda: &[-0.103_727_300_597_304_87],
        mu: &[-0.097_164_382_784_563_71],
    },
    Case {
        name: "general",
        body: "coord x, y; L = (1 + x^2 / 2) * dot(x)^2 / 2 + (1 + y^2 / 3) * dot(y)^2 / 2 + x * dot(x) * dot(y) / 4 + cos(t) * x * dot(y) / 3 - 2 * y - x * y * sin(t) / 2; force x = -dot(x) * x^2 / 10, y = -dot(y) / 10 + cos(2 * t) / 5; constraint c = x^2 + y^2 + x * y * sin(t) / 4 - 1;",
        h: 0.05,
        q0: &[0.6, -0.8],
        p0: &[1.06928, 0.99516],
        q1: &[0.640_093_780_200_929_6, -0.772_306_113_132_488_8],
        p1: &[1.012_777_206_052_321_5, 0.999_830_511_980_126_3],
        v1: &[0.767_014_150_792_861_1, 0.553_872_078_569_905_8],
        lambda: &[-0.032_709_772_283_053_38],
        mu: &[-0.032_229_204_355_390_79],
    },
    Case {
        name: "sleigh",
        body: "coord x, y, θ; let w = dot(θ); L = ((dot(x) - sin(θ) * w / 2)^2 + (dot(y) + cos(θ) * w / 2)^2) / 2 + w^2 / 2; constraint blade = -sin(θ) * dot(x) + cos(θ) * dot(y);",
        h: 0.05,
        q0: &[0.0, 0.0, 0.0],
        p0: &[1.0, 1.0, 2.5],
        q1: &[0.052_447_305_321_562_41, 0.002_597_230_547_010_608, 0.098_960_683_739_375_12],
        p1: &[0.995_775_084_653_427_2, 1.082_893_675_638_755_3, 2.448_034_186_968_756_3],
        v1: &[1.092_520_650_448_484_6, 0.108_470_915_031_307_76, 1.958_427_349_575_004_9],
        lambda: &[0.040_340_266_172_307_605],
        mu: &[0.042_762_630_495_619_15],
    },
    Case {
        name: "rolling_disk",
        body: "coord x, y, φ, θ, ψ; let w = dot(φ), u = dot(θ), r = dot(ψ); let X = dot(x) + u * sin(θ) * sin(φ) - w * cos(θ) * cos(φ); let Y = dot(y) - u * sin(θ) * cos(φ) - w * cos(θ) * sin(φ); let Z = u * cos(θ); L = (X^2 + Y^2 + Z^2) / 2 + (u^2 + w^2 * sin(θ)^2) / 8 + (r + w * cos(θ))^2 / 4 - 9.81 * sin(θ); constraint roll = [dot(x) + cos(φ) * r, dot(y) + sin(φ) * r];",
        h: 0.02,
        q0: &[0.0, 0.0, 0.0, 1.2, 0.0],
        p0: &[2.818_821_122_761_663_3, 0.0, -1.423_545_431_251_670_2, 0.0, -1.409_410_561_380_831_7],
        q1: &[
            0.060_007_915_707_762_22,
            0.000_300_559_930_401_585_36,
            0.010_017_259_007_692_755,
            1.199_750_256_462_656_5,
            -0.060_008_668_406_003_3,
        ],
        p1: &[
            2.818_524_266_197_623,
            0.051_510_812_832_296_346,
            -1.424_243_810_442_329,
            -0.031_217_942_167_920_374,
            -1.409_449_421_410_969_6,
        ],
        v1: &[
            3.000_626_583_494_525,
            0.030_059_059_109_177_413,
            0.501_607_983_781_880_5,
            -0.024_974_353_734_336_3,
            -3.000_777_139_443_807,
        ],
        lambda: &[-3.121_591_617_135_696e-5, 0.025_756_510_131_161_817],
        mu: &[-0.000_265_640_647_868_633_4, 0.025_754_302_701_134_53],
    },
    Case {
        name: "turntable_sleigh",
        body: "coord x, y, θ; let w = dot(θ); L = ((dot(x) - sin(θ) * w / 2)^2 + (dot(y) + cos(θ) * w / 2)^2) / 2 + w^2 / 2; force x = -dot(x) / 10, y = -dot(y) / 10; constraint blade = -sin(θ) * (dot(x) + sin(t) / 2 * y) + cos(θ) * (dot(y) - sin(t) / 2 * x);",
        h: 0.05,
        q0: &[0.5, 0.0, 0.0],
        p0: &[1.0, 1.0, 2.5],
        q1: &[0.552_310_222_974_499_3, 0.002_915_953_084_929_35, 0.098_833_036_952_633_49],
        p1: &[0.990_008_847_527_118_8, 1.093_303_560_212_515_4, 2.448_220_973_643_456],
        v1: &[1.086_366_215_316_619_1, 0.121_529_064_005_219_93, 1.953_080_043_220_209_3],
        lambda: &[0.045_588_726_856_247_13],
        mu: &[0.048_241_849_388_594_625],
    },
];
