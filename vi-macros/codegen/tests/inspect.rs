//! Stages as text, findings, LaTeX, declarations in files, and mistakes with their lines.

use proc_macro2::TokenStream;
use vi_codegen::findings::{Dependence, Findings, Pattern};
use vi_codegen::inspect::{Stage, explain, explain_gauss, latex, report, source, stage};
use vi_codegen::{derive, syntax::parse};
use vi_expr::{Expr, Function, Pool, Rational};

fn tokens(body: &str) -> TokenStream {
    format!("pub struct System {{ {body} }}").parse().expect("tokens of Rust")
}

fn findings(body: &str) -> Findings {
    let system = parse::system(tokens(body)).expect("a system");
    derive(&system).unwrap_or_else(|error| panic!("{body}: {error}")).own.findings
}

fn words(body: &str) -> Vec<String> {
    findings(body).lines(&|index| format!("q{index}"))
}

#[test]
fn an_oscillator_is_linear() {
    let found = findings("param k = 1; coord x; L = dot(x)^2/2 - k*x^2/2; force x = -dot(x); discretize midpoint;");
    assert!(found.autonomous && found.forced && found.separable && found.constant_mass);
    let steps = found.steps.expect("a rule");
    assert!(steps.symmetric);
    assert_eq!((steps.jacobian, steps.pattern, found.cyclic), (Dependence::Step, Pattern::Scalar, vec![]));
}

#[test]
fn a_coordinate_may_scale_the_momentum_of_another() {
    let scales = |kinetic: &str| {
        findings(&format!("coord x, y, z; L = ({kinetic} + dot(z)^2) / 2; discretize midpoint;")).curvilinear
    };
    // p_y = x² y'.
    assert!(scales("dot(x)^2 + x^2*dot(y)^2"));
    assert!(scales("dot(x)^2/x + x^2*dot(y)^2"));
    let polar = words("coord r, φ; L = (dot(r)^2 + r^2*dot(φ)^2) / 2; discretize midpoint;");
    assert!(polar.iter().any(|line| line.contains("forces at the velocities of the momenta")), "{polar:?}");
    // Momenta of both coordinates depend on the other one.
    assert!(!scales("dot(x)^2 + dot(x)*dot(y)*cos(x - y) + dot(y)^2"));
    // The momentum of y has the velocity of x.
    assert!(!scales("dot(x)^2 + dot(x)*dot(y)*cos(x) + dot(y)^2"));
    // A momentum depends on its own coordinate only, or on the time.
    assert!(!scales("(1 + x^2)*dot(x)^2 + dot(y)^2"));
    assert!(!scales("dot(x)^2 + (2 + sin(t))*dot(y)^2"));
    // A constant mass matrix, with a force of the velocities: p_y = y' + x.
    assert!(!scales("dot(x)^2 + dot(y)^2 + 2*x*dot(y)"));
}

#[test]
fn what_the_jacobian_depends_on() {
    let of = |body: &str| findings(body).steps.expect("a rule").jacobian;
    // A = L_vv + …: by hand, 1; 1 + h²/4; 1 + (h²/4) cos of the time; of x_mid, which depends on v.
    assert_eq!(of("coord x; L = dot(x)^2/2; discretize midpoint;"), Dependence::Parameters);
    assert_eq!(of("coord x; L = dot(x)^2/2 - x^2/2; discretize midpoint;"), Dependence::Step);
    assert_eq!(of("coord x; L = dot(x)^2/2 - cos(t)*x^2/2; discretize midpoint;"), Dependence::Node);
    assert_eq!(of("coord x; L = dot(x)^2/2 - x^4/4; discretize midpoint;"), Dependence::Unknown);
    // Störmer–Verlet is explicit for any potential; linear with friction; neither with a position-dependent mass.
    assert_eq!(of("coord x; L = dot(x)^2/2 - x^4/4; discretize trapezoidal;"), Dependence::Parameters);
    assert_eq!(of("coord x; L = dot(x)^2/2 - x^4/4; force x = -dot(x); discretize trapezoidal;"), Dependence::Step);
    assert_eq!(of("coord x; L = (1 + x^2)*dot(x)^2/2; discretize trapezoidal;"), Dependence::Unknown);
}

#[test]
fn a_time_that_cancels_is_no_dependence() {
    let autonomous = |body: &str| findings(body).autonomous;
    // By hand: the factor is 1; the turning frame has the kinetic energy ((x' - w y)² + (y' + w x)²)/2.
    assert!(autonomous("coord x; L = dot(x)^2/2 - (sin(t)^2 + cos(t)^2)*x^2/2; discretize midpoint;"));
    assert!(autonomous(
        "param k = 1; coord x; L = dot(x)^2/2 - k*sin(3*t)^2*x^2 - k*cos(3*t)^2*x^2; discretize midpoint;"
    ));
    assert!(autonomous(
        "coord x; L = dot(x)^2/2 - x^2; force x = -(cosh(t)^2 - sinh(t)^2)*dot(x); discretize midpoint;"
    ));
    let turning = "param w = 1; coord x, y; let X = x*cos(w*t) - y*sin(w*t), Y = x*sin(w*t) + y*cos(w*t); \
                   L = (dot(X)^2 + dot(Y)^2)/2 - x^4; discretize midpoint;";
    assert!(autonomous(turning));
    // The Coriolis force of the frame makes the matrix of a step depend on h, not on the time.
    assert_eq!(findings(&turning.replace("x^4", "x^2")).steps.expect("a rule").jacobian, Dependence::Step);
    for depends in [
        "coord x; L = dot(x)^2/2 - (2*sin(t)^2 + cos(t)^2)*x^2/2; discretize midpoint;",
        "coord x; L = dot(x)^2/2 - (sin(t)^2 + cos(2*t)^2)*x^2/2; discretize midpoint;",
        "coord x; L = dot(x)^2/2 - x^2; force x = (sin(t)^2 - cos(t)^2)*dot(x); discretize midpoint;",
    ] {
        assert!(!autonomous(depends), "{depends}");
    }
    assert!(!autonomous(&turning.replace("x^4", "X^4")));
}

#[test]
fn a_lagrangian_shows_its_hamiltonian() {
    let hamiltonian = |body: &str| {
        let text = explain(tokens(body)).unwrap_or_else(|error| panic!("{body}: {error}")).text();
        text.lines().find_map(|line| line.trim().strip_prefix("H = ").map(str::to_owned))
    };
    let shown = |body: &str| hamiltonian(body).unwrap_or_else(|| panic!("{body}"));
    let polar = "param m = 1, k = 2; coord r, a; L = m*(dot(r)^2 + r^2*dot(a)^2)/2 - k*(r - 1)^2/2;";
    assert_eq!(shown(polar), "k*(r - 1)^2/2 + p_r^2/(2*m) + p_a^2/(2*m*r^2)");
    let field = "param e = 2; coord r[2]; L = dot(r)*dot(r)/2 + e*r[0]*dot(r[1]);";
    assert_eq!(shown(field), "p_r[0]^2/2 + p_r[1]^2/2 - e*r[0]*p_r[1] + e^2*r[0]^2/2");
    let pendulum = "coord a, b; L = dot(a)^2 + dot(b)^2/2 + dot(a)*dot(b)*cos(a - b) + 2*cos(a) + cos(b);";
    assert_eq!(
        shown(pendulum),
        "p_a^2/(2*(2 - cos(a - b)^2)) - 2*cos(a) - cos(b) - cos(a - b)*p_a*p_b/(2 - cos(a - b)^2) + p_b^2/(2 - cos(a - b)^2)"
    );
    // Written by H: the same.
    let back =
        "param m = 1, k = 2; coord r, a; momentum p of r, l of a; H = p^2/(2*m) + l^2/(2*m*r^2) + k*(r - 1)^2/2;";
    assert_eq!(shown(back), "p_r^2/(2*m) + p_a^2/(2*m*r^2) + k*(r - 1)^2/2");
    let latex = explain(tokens(back)).expect("a system").latex();
    assert!(latex.contains("H &= \\frac{p_{r}^{2}}{2 m}"), "{latex}");
    assert_eq!(hamiltonian("coord x; L = dot(x)^4 - x^2;"), None);
}

#[test]
fn findings_in_words() {
    let free = "coord x, y; L = (dot(x)^2 + dot(y)^2)/2 - t*y; discretize midpoint;";
    let wanted = [
        "Not autonomous: `L` depends on the time `t`; no force acts",
        "Cyclic: q0; its momentum is conserved",
        "`L = T(v) + U(t, q)` with a constant mass matrix",
        "The step's equation in `v` is explicit: its Jacobian `A` depends on parameters only and is inverted once per run",
        "`A` is diagonal, symmetric; solved by division",
    ];
    assert_eq!(words(free), wanted);
    let relativistic = words("coord x; L = -sqrt(1 - dot(x)^2) - x^2; force x = sin(t); discretize midpoint;");
    assert_eq!(relativistic[0], "Not autonomous: `L` or `f` depends on the time `t`; a force acts");
    assert_eq!(relativistic[1], "`L = T(v) + U(t, q)`; the mass matrix depends on the velocity");
}

const OSCILLATOR: &str = "param m = 1, k = 4.25; coord x; let v = dot(x);
    L = (m*v^2 - k*x^2)/2; force x = -v; discretize midpoint;";

#[test]
fn the_syntax_equals_the_source() {
    let text = stage(tokens(OSCILLATOR), Stage::Syntax).expect("right");
    let wanted = "struct System {
    param m = 1;
    param k = 17 / 4;
    coord x;
    let v = dot(x);
    L = (m * v^2 - k * x^2) / 2;
    force x = -v;
    discretize midpoint;
}
";
    assert_eq!(text, wanted);
    // The output parses to the same system.
    for body in [
        OSCILLATOR,
        "const N = 3; coord q[N]; let e[i in 0..N] = q[i]^-(1/2)^2; L = -(-dot(q[0]))^2 - 2*(-3)*sum(i in 0..N, (dot(q[i]) - (1 - 2))^2/(2*3)/4);
         dissipation = hypot(dot(q[0]), dot(q[1])); force q[1] = e[0] - (e[1] - e[2]);
         discretize { Ld = h*L(t0, q0, (q1 - q0)/h); }",
        "coord x; L = dot(x)^2/2; time_scale = 1 + x^2;",
    ] {
        let text = stage(tokens(body), Stage::Syntax).expect("right");
        let again: TokenStream = text.parse().expect("tokens");
        assert_eq!(stage(again, Stage::Syntax).expect("right"), text);
        let model = |tokens| stage(tokens, Stage::Model).unwrap_or_else(|error| error.to_string());
        assert_eq!(model(text.parse().expect("tokens")), model(tokens(body)));
    }
}

#[test]
fn the_stages_show_their_products() {
    let text = |stage: Stage| vi_codegen::inspect::stage(tokens(OSCILLATOR), stage).expect("right");
    let holds = |of: Stage, lines: &[&str]| {
        let shown = text(of);
        for line in lines {
            assert!(shown.lines().any(|shown| shown.trim() == *line), "{of:?} lacks `{line}`:\n{shown}");
        }
    };
    // By hand, from the midpoint rule.
    holds(Stage::Model, &["parameter k = 4.25", "f_x = -dot(x)", "p_x = m*dot(x)"]);
    holds(
        Stage::Discrete,
        &[
            "x_mid = x0/2 + x1/2",
            "L_d = h*L",
            "D1 L_d = L_v_x*v_x - L",
            "(D2 L_d)_x = h*L_x/2 - L_v_x",
            "(f_d⁻)_x = h*f_x/2",
            "g_d⁺ = -h*v_x*f_x/2",
            "A_x,x = m + h/2 + k*h^2/4",
            "E1 − E0 = h*v_x*f_x",
        ],
    );
    holds(Stage::Program, &["momentum: 1 operation", "%1 = m * dot(x)", "result %1"]);
    holds(Stage::Rust, &["impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<1, T>"]);
    assert!(text(Stage::Rust).contains("\n        }\n\n        /// `v·L_v − L = "), "items stand apart");
}

#[test]
fn points_are_distinguished() {
    let system = tokens("coord q[2]; L = (dot(q[0])^2 + dot(q[1])^2)/2 - q[0]^2*q[1]^2; discretize trapezoidal;");
    let text = stage(system.clone(), Stage::Discrete).expect("right");
    for line in ["q[1]_at2 = q[1]_1", "(D2 L_d)_q[0] = h*L_q[0]_at1/2 - L_v_q[0]_at1/2 - L_v_q[0]_at2/2"] {
        assert!(text.lines().any(|shown| shown.trim() == line), "{line}\n{text}");
    }
    let latex = explain(system).expect("right").latex();
    assert!(latex.contains("q_{1,(2)} &= q_{1,1}"), "{latex}");
    assert!(latex.contains("\\frac{h {L^{(1)}}_{q_{0}}}{2}"), "{latex}");
}

#[test]
fn an_explanation_is_a_document() {
    let body = "param μ = 1, k_spring = 2; coord θ1, θ2; L = (dot(θ1)^2 + dot(θ2)^2)/2 - μ*cos(θ1) - k_spring*θ2^2;
        force θ1 = -dot(θ1); discretize midpoint;";
    let explanation = explain(tokens(body)).expect("right");
    assert!(explanation.text().contains("\n    (f_d⁺)_θ1 = h*f_θ1/2\n"), "{}", explanation.text());
    let latex = explanation.latex();
    for part in [
        "\\begin{document}",
        "\\frac{\\dot{\\theta}_{1}^{2}}{2}",
        "\\mu \\cos\\left(\\theta_{1}\\right)",
        "k_{\\mathrm{spring}} \\theta_{2}^{2}",
        "\\bar{\\theta}_{1} &= \\frac{\\theta_{1,0}}{2} + \\frac{\\theta_{1,1}}{2}",
        "(f_d^+)_{\\theta_{1}} &= \\frac{h f_{\\theta_{1}}}{2}",
        "\\item step\\_density: ",
        "$A$ is ",
        "\\end{document}",
    ] {
        assert!(latex.contains(part), "{part} is missing in\n{latex}");
    }
    balanced(&latex);
    assert!(latex.is_ascii(), "only what every engine of LaTeX reads");
}

/// Checks that braces, `\left` and `\right`, environments and dollars are paired.
fn balanced(latex: &str) {
    let count = |part: &str| latex.matches(part).count();
    let mut depth = 0_i32;
    for (letter, before) in latex.chars().zip(core::iter::once(' ').chain(latex.chars())) {
        match (letter, before) {
            (_, '\\') => {}
            ('{', _) => depth += 1,
            ('}', _) => depth -= 1,
            _ => {}
        }
        assert!(depth >= 0);
    }
    assert_eq!((depth, count("\\left"), count("\\begin")), (0, count("\\right"), count("\\end")));
    assert_eq!(count("$") % 2, 0);
}

#[test]
fn expressions_in_latex() {
    let mut pool = Pool::new();
    let symbols = ["x", "y", "h"].map(|name| pool.symbol(name));
    let [x, y, h] = symbols;
    let half = Rational::new(1.into(), 2.into());
    let (sum, difference) = (pool.add(x, y), pool.sub(x, y));
    let (square, root) = (pool.mul(sum, sum), pool.power(sum, &half));
    let three_halves = Rational::new((-3).into(), 2.into());
    let two = pool.integer(2);
    let sine = pool.call(Function::Sin, &[sum]);
    let nested = pool.call(Function::Sin, &[sine]);
    let cases: Vec<(Expr, &str)> = vec![
        (pool.number(half.clone()), "\\frac{1}{2}"),
        (pool.number(-half.clone()), "-\\frac{1}{2}"),
        (pool.pi(), "\\pi"),
        (difference, "x - y"),
        (pool.neg(sum), "-x - y"),
        (pool.mul(h, sum), "h \\left(x + y\\right)"),
        (pool.div(sum, h), "\\frac{x + y}{h}"),
        (pool.div(h, sum), "\\frac{h}{x + y}"),
        (square, "\\left(x + y\\right)^{2}"),
        (root, "\\sqrt{x + y}"),
        (pool.power(sum, &three_halves), "\\frac{1}{\\left(x + y\\right)^{3/2}}"),
        (pool.power(x, &Rational::new(1.into(), 3.into())), "\\sqrt[3]{x}"),
        (pool.power(two, &half), "\\sqrt{2}"),
        (sine, "\\sin\\left(x + y\\right)"),
        (pool.mul(sine, sine), "\\sin^{2}\\left(x + y\\right)"),
        (nested, "\\sin\\left(\\sin\\left(x + y\\right)\\right)"),
        (pool.call(Function::Abs, &[difference]), "\\left|x - y\\right|"),
        (pool.call(Function::Atan2, &[y, x]), "\\operatorname{atan2}\\left(y, x\\right)"),
        (pool.call(Function::Pow, &[sum, y]), "\\left(x + y\\right)^{y}"),
        (pool.call(Function::Exp, &[x]), "\\exp\\left(x\\right)"),
    ];
    for (expr, wanted) in cases {
        let latex = latex::expression(&pool, expr, &|symbol: &&str| (*symbol).to_owned());
        assert_eq!(latex, wanted);
        balanced(&latex);
    }
    let product = pool.mul(x, y);
    let third = pool.scale(product, &Rational::new((-2).into(), 3.into()));
    let mixed = pool.add(third, square);
    let name = |symbol: &&str| (*symbol).to_owned();
    assert_eq!(latex::expression(&pool, mixed, &name), "\\left(x + y\\right)^{2} - \\frac{2 x y}{3}");
    // Shared expressions exceed any page: no text of exponential length is built.
    let mut deep = x;
    for _ in 0..60 {
        let sine = pool.call(Function::Sin, &[deep]);
        let product = pool.mul(sine, deep);
        deep = pool.add(product, y);
    }
    assert_eq!(latex::expression(&pool, deep, &name), "\\ldots");
}

#[test]
fn every_rule_of_a_list_is_shown_and_gives_the_operations_that_it_gives_alone() {
    let by = |rules: &str, of| {
        let system = "param a = 2; coord x, y; L = dot(x)^2 + (2 + cos(x)) * dot(y)^2 - a * x * y * sin(t); force x = -dot(x) * y^2;";
        stage(tokens(&format!("{system} discretize {rules};")), of).expect("right")
    };
    let program = by("midpoint, trapezoidal", Stage::Program);
    let (own, further) = program.split_once("\nby the rule trapezoidal\n\n").expect("both rules");
    assert_eq!(own, by("midpoint", Stage::Program));
    assert!(further.starts_with("ld: ") && by("trapezoidal", Stage::Program).ends_with(further), "{further}");
    let discrete = by("trapezoidal, midpoint", Stage::Discrete);
    let (own, further) =
        discrete.split_once("\nThe same system with another rule\n    rule midpoint\n").expect("both rules");
    assert_eq!(own, by("trapezoidal", Stage::Discrete));
    assert!(by("midpoint", Stage::Discrete).ends_with(further), "{further}");
    assert!(by("midpoint, trapezoidal", Stage::Syntax).contains("discretize midpoint, trapezoidal;"));
    let rust = by("midpoint, trapezoidal", Stage::Rust);
    for shown in [
        "/// By the rule `trapezoidal`, as `By::new(system, Trapezoidal)`:",
        "impl ::vi_core::stepping::Discretized<2, ::vi_core::rules::Trapezoidal>",
    ] {
        assert!(rust.contains(shown), "{shown}");
    }
    // Continuous functions are emitted once.
    assert_eq!((rust.matches("fn acceleration").count(), rust.matches("fn d1_ld").count()), (1, 2));
    let system = tokens("coord x; L = dot(x)^2 - x^2; discretize midpoint, trapezoidal;");
    let explained = explain(system).expect("a right system").text();
    assert_eq!(explained.matches("    momentum_residual").count(), 2, "{explained}");
}

#[test]
fn declarations_are_found_wherever_they_stand() {
    let text = "
use vi_core::lagrangian;
lagrangian! { struct A { coord x; L = dot(x)^2; discretize midpoint; } }
mod inner {
    mod deeper { vi_core::lagrangian! { struct B { coord x; L = dot(x)^2; discretize midpoint; } } }
    fn body() {
        lagrangian! { struct C { coord x; L = dot(x)^2; discretize midpoint; } }
        println!(\"{}\", 1);
    }
}
";
    let found = source::declarations(text).expect("Rust");
    let names = found.into_iter().map(|tokens| parse::system(tokens).expect("a system").name.to_string());
    assert_eq!(names.collect::<Vec<_>>(), ["A", "B", "C"]);
    assert!(source::declarations("fn (").is_err());
    // Not in the arguments of other macros.
    for none in
        ["macro_rules! m { () => { lagrangian! { $a } } }", "quote!(lagrangian! {})", "use vi_core::lagrangian;"]
    {
        assert!(source::declarations(none).expect("tokens").is_empty(), "{none}");
    }
    let script = source::declarations("#!/usr/bin/env rust\nlagrangian! { struct A { coord x; } }").expect("tokens");
    assert_eq!(script[0].clone().into_iter().next().expect("a token").span().start().line, 2);
}

#[test]
fn mistakes_are_shown_at_their_places() {
    let text = "// θ before the declaration\nlagrangian! {\n    struct A {\n\tparam mass = 1; coord θ; L = mass * dot(θ)^2 + θ * mas;\n\tforce y = 1;\n        discretize midpoint;\n    }\n}\n";
    let tokens = source::declarations(text).expect("Rust").remove(0);
    let error = stage(tokens, Stage::Rust).expect_err("wrong");
    let wanted = "error: unknown name `mas`
 --> a.rs:4:53
  |
4 | \tparam mass = 1; coord θ; L = mass * dot(θ)^2 + θ * mas;
  | \t                                                   ^^^
  = help: did you mean `mass`?

error: `y` has a force but is not a coordinate
 --> a.rs:5:8
  |
5 | \tforce y = 1;
  | \t      ^
";
    let shown = report::report("a.rs", text, &error);
    assert!(shown.starts_with(wanted), "{shown}");
}

/// For a long line the part around the token is shown.
#[test]
fn a_long_line_is_shown_in_part() {
    let message = |names: usize, wrong: &str| {
        let terms = " + x".repeat(names);
        let text = format!(
            "lagrangian! {{ struct A {{ coord x; L = dot(x)^2{terms} + {wrong}{terms}; discretize midpoint; }} }}"
        );
        let tokens = source::declarations(&text).expect("tokens").remove(0);
        report::report("a.rs", &text, &stage(tokens, Stage::Rust).expect_err("wrong"))
    };
    let shown = message(10_000, "y");
    let (line, carets) = (shown.lines().nth(3).expect("the line"), shown.lines().nth(4).expect("the carets"));
    assert_eq!((line.chars().count(), carets.chars().count()), ("1 | ".len() + 122, "1 | ".len() + 62));
    assert!(line.starts_with("1 | …") && line.ends_with('…') && carets.ends_with(" ^"), "{shown}");
    assert_eq!(line.chars().nth("1 | ".len() + 61), Some('y'));
    // A long token is marked as far as it is visible.
    let shown = message(10_000, &"y".repeat(190));
    assert!(shown.lines().skip(2).all(|line| line.chars().count() <= 127), "{shown}");
    // At the ends of a line nothing is omitted.
    let shown = message(5, "y");
    assert!(!shown.contains('…'), "{shown}");
}

#[test]
fn nesting_is_bounded_in_a_file() {
    let nest = |inner: &str| format!("{}{inner}{}", "(".repeat(12_000), ")".repeat(12_000));
    let system =
        |term: &str| format!("lagrangian! {{ struct A {{ coord x; L = dot(x)^2 + {term}; discretize midpoint; }} }}");
    for tokens in source::declarations(&format!("fn main() {{ {} }}\n{}", nest("1"), system("x"))).expect("tokens") {
        assert!(stage(tokens, Stage::Syntax).is_ok(), "what stands around a system does not matter");
    }
    let text = system(&nest("x"));
    let tokens = source::declarations(&text).expect("tokens").remove(0);
    let shown = report::report("a.rs", &text, &explain(tokens).err().expect("too deep"));
    assert!(shown.starts_with("error: this expression is nested deeper than 100 levels\n --> a.rs:1:"), "{shown}");
}

#[test]
fn the_same_system_gives_the_same_text() {
    for of in [Stage::Syntax, Stage::Model, Stage::Discrete, Stage::Program, Stage::Rust] {
        assert_eq!(stage(tokens(OSCILLATOR), of).expect("right"), stage(tokens(OSCILLATOR), of).expect("right"));
    }
}

#[test]
fn a_gauss_step_is_explained_with_the_equations_of_the_system() {
    let body = "param m = 2; coord x, y; L = m*(1 + x^2)*dot(x)^2/2 + dot(y)^2/2 - y*sin(t); force x = -dot(x); discretize midpoint;";
    let text = explain_gauss(tokens(body), 2).expect("a system").text();
    for line in [
        "c_1 = 1/2 - sqrt(3)/6",
        "a_11 = 1/4",
        "a_12 = 1/4 - sqrt(3)/6",
        "x_i = x0 + h*(a_i1*x_dot_1 + a_i2*x_dot_2)",
        "p_x_i = m*(x_i^2 + 1)*x_dot_i",
        "F_x_i = m*x_i*x_dot_i^2 - x_dot_i",
        "F_y_i = -sin(t_i)",
        "p_x_i = p0_x + h*(a_i1*F_x_1 + a_i2*F_x_2)",
        "p1_y = p0_y + h*(b_1*F_y_1 + b_2*F_y_2)",
        "L_t_i = -y_i*cos(t_i)",
        "L_x_i = m*x_i*x_dot_i^2",
        "(D2 L_d)_x = sum_i b_i*((1 - c_i)*h*L_x_i - p_x_i)",
        "g_d⁺ = -sum_i b_i*c_i*h*(f_x_i*x_dot_i + f_y_i*y_dot_i)",
        "E1 = -D3 L_d - g_d⁺",
        "H(t0, q0, p0) - E0 = h^4*D_2*1/864 + O(h^5)",
    ] {
        assert!(text.lines().any(|shown| shown.trim_start() == line), "{line}: {text}");
    }
    let in_latex = explain_gauss(tokens(body), 2).expect("a system").latex();
    assert!(in_latex.contains("x_{i} &= x_{0} + h \\sum_{j} a_{ij} \\dot{x}_{j}"), "{in_latex}");
    let unforced = explain_gauss(tokens("coord x; L = dot(x)^2/2 - x^2/2; discretize midpoint;"), 1).expect("a system");
    let text = unforced.text();
    assert!(
        text.contains("\n    a_11 = 1/2\n") && text.contains("\n    E1 = -D3 L_d\n") && !text.contains("f_d"),
        "{text}"
    );
}

#[test]
fn the_coefficients_of_a_gauss_step_integrate_polynomials() {
    for stages in 1..=16 {
        let explained = explain_gauss(tokens("coord x; L = dot(x)^2/2 - x^2/2; discretize midpoint;"), stages);
        let text = explained.expect("a system").text();
        let number = |name: &str| {
            let start = format!("    {name} = ");
            let shown =
                text.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{name}: {text}"));
            // `1/2 - sqrt(3)/6`, in any order, or a decimal.
            shown.replace(" - ", " + -").split(" + ").map(term).sum::<f64>()
        };
        let separator = if stages > 9 { "," } else { "" };
        let mut worst = 0.0_f64;
        let powers = |i: usize| number(&format!("c_{i}"));
        for power in 1..=i32::try_from(stages).expect("a few") {
            let exact = 1.0 / f64::from(power);
            let sum: f64 = (1..=stages).map(|j| number(&format!("b_{j}")) * powers(j).powi(power - 1)).sum();
            worst = worst.max((sum - exact).abs());
            for i in 1..=stages {
                let a = |j: usize| number(&format!("a_{i}{separator}{j}"));
                let sum: f64 = (1..=stages).map(|j| a(j) * powers(j).powi(power - 1)).sum();
                worst = worst.max((sum - powers(i).powi(power) * exact).abs());
            }
        }
        println!("{stages} stages: off by {worst:.1e}");
        // Fourteen decimals. Measured: 3.0e-14.
        assert!(worst < 4e-14, "{stages} stages: {worst:e}");
    }
}

/// `5/18`, `-sqrt(15)/10`, `0.25`.
fn term(text: &str) -> f64 {
    let (above, below) = text.split_once('/').unwrap_or((text, "1"));
    let (sign, above) = above.strip_prefix('-').map_or((1.0, above), |rest| (-1.0, rest));
    let root = above.strip_prefix("sqrt(").and_then(|rest| rest.strip_suffix(')'));
    let value = root.map_or_else(|| above.parse(), |of| of.parse::<f64>().map(f64::sqrt));
    sign * value.expect("a number") / below.parse::<f64>().expect("a denominator")
}
