//! Large systems in loops: their header, their explanation, their functions, and the tests of `check`.

use proc_macro2::TokenStream;
use vi_codegen::inspect::{Stage, explain, explain_gauss, stage};
use vi_codegen::{Compiled, documentation, expand, syntax::parse};

const BODIES: &str = "#[vi_limit(0)] struct Bodies { const N = 5; param G = 1.5, m[N] = [1, 2, 3, 4, 5];
    coord x[N], y[N];
    L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2)) / 2
        + G * sum(i in 0..N, sum(j in 0..i, m[i] * m[j] / hypot(x[i] - x[j], y[i] - y[j])));
    force x[i in 1..N] = -dot(x[i]) / 9; discretize midpoint;
    check { x[i in 0..N] = i, y[i in 0..N] = i^2; h = 0.01; } }";

const LINKS: &str = "#[vi_limit(0)] struct Links { const N = 5; param l = 0.3, g = 9.8; coord q[N];
    let x[0] = l * sin(q[0]); let x[i in 1..N] = x[i - 1] + l * sin(q[i]);
    let y[0] = l * cos(q[0]); let y[i in 1..N] = y[i - 1] + l * cos(q[i]);
    L = sum(i in 0..N, (dot(x[i])^2 + dot(y[i])^2) / 2 + g * y[i]);
    check { q[i in 0..N] = i / 3; h = 0.01; } }";

const WELLS: &str = "#[vi_limit(0)] struct Wells { const N = 5; param c = 0.3; coord x[N], y[2][N], z;
    L = (dot(z)^2 + sum(i in 0..N, dot(x[i])^2 + dot(y[0][i])^2 + dot(y[1][i])^2 - x[i]^4 - c * t * y[0][i]^2 * x[i])) / 2;
    discretize midpoint; }";

const CLOSED: &str = "#[vi_limit(0)] struct Closed { const N = 5; param l = 0.3, g = 9.8, d = 0.2, w = 0.5; coord q[N];
    let x[0] = l * sin(q[0]); let x[i in 1..N] = x[i - 1] + l * sin(q[i]);
    L = sum(i in 0..N, dot(x[i])^2 + dot(q[i])^2 - g * x[i]) / 2;
    constraint up[k in 3..5] = x[k] - k * d;
    constraint rolls = (dot(x[1]) + d) * q[3] - w * dot(q[4]);
    check { q[0] = 1, q[1] = 1, q[2] = 1, q[3] = 1, q[4] = 1; h = 0.01; } }";

fn tokens(text: &str) -> TokenStream {
    text.parse().expect("tokens of Rust")
}

fn has_lines(text: &str, lines: &[&str]) {
    for line in lines {
        assert!(text.lines().any(|shown| shown.trim() == *line), "`{line}` is missing in\n{text}");
    }
}

#[test]
fn a_header_lists_the_functions_of_the_loops() {
    let text = |system| stage(tokens(system), Stage::Rust).expect("right");
    let links = text(LINKS);
    assert!(links.starts_with("// `Links`: L = dot(x[0])^2/2 + dot(y[0])^2/2 + g*y[0] + "), "{links}");
    // Without spaces, which align columns. Operations of a term by hand: a², /2; then m a, without operations.
    let lines: Vec<String> = links.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    for line in ["// 5 2 0 lagrangian_1 term of L: dot(x[0])^2/2", "// 5 1 0 lagrangian_3 term of L: g*y[0]"] {
        assert!(lines.iter().any(|shown| shown == line), "{line}\n{links}");
    }
    let is_recursion = |line: &String| line.contains("y[1] = l*cos(q[1]) + y[0]") && line.starts_with("// 4 ");
    assert!(lines.iter().any(is_recursion), "{links}");
    let bodies = text(BODIES);
    assert!(bodies.contains("-  force_1       term of f_x[1]: -dot(x[1])/9\n"), "{bodies}");
    // The header names functions that are emitted.
    for (text, name) in [(&links, "row_1"), (&links, "row_2"), (&links, "lagrangian_3"), (&bodies, "force_1")] {
        assert!(text.contains(&format!("fn {name}(")) && text.contains(&format!(" {name} ")), "{name}\n{text}");
    }
}

#[test]
fn an_explanation_shows_loops_and_what_follows_from_them() {
    let text = |system| explain(tokens(system)).expect("right").text();
    let bodies = [
        "coordinates x[0] to x[4], y[0] to y[4]",
        "parameter m[0] to m[4] = 1, 2, 3, 4, 5",
        "force x[i in 1..N] = -dot(x[i]) / 9;",
        "L = L_1 + L_2",
        "L_1 = sum(i in 0..5, m[i]*(dot(x[i])^2 + dot(y[i])^2)/2)",
        "f_x[i + 1] += -dot(x[i + 1])/9 for i in 0..4",
        "a = L_vv^-1*(L_q + f - L_vq*v)",
        "r = L_v - h/2*(L_q + f) - p0",
        "A = L_vv + h/2*(L_vq - L_qv - f_v) - h^2/4*(L_qq + f_q)",
        "E1 = v·L_v - L + h/2*f·v",
        "D = a·(L_q + f) - v·d/dt(L_q)",
        "Autonomous; a force acts",
    ];
    has_lines(&text(BODIES), &bodies);
    let links = [
        "dot(y[i + 1]) = dot(y[i]) - l*dot(q[i + 1])*sin(q[i + 1]) for i in 0..4",
        "L_3 = sum(i in 0..5, g*y[i])",
        "None: the system is declared without a rule and takes Gauss steps",
        "The mass matrix does not depend on the velocity",
    ];
    has_lines(&text(LINKS), &links);
    let lossy = LINKS.replace("check {", "dissipation = sum(i in 0..N, l * dot(x[i])^2); check {");
    let lossy = text(&lossy);
    has_lines(&lossy, &["f = -R_v", "R = R_1", "R_1 = sum(i in 0..5, l*dot(x[i])^2)"]);
    let scaled =
        BODIES.replace("force x", "time_scale = 1 / sqrt(1 + sum(i in 0..N, m[i] * x[i]^2 * y[i]^2)); force x");
    let scaled = text(&scaled);
    has_lines(&scaled, &["g = 1/sqrt(g_1)", "g_1 += m[i]*x[i]^2*y[i]^2 for i in 0..5", "g_1 += 1"]);
    let wells = [
        "L_1 = sum(i in 0..16, dot(q_i)^2/2)",
        "L_3 = sum(i in 0..5, -c*t*x[i]*y[0][i]^2/2)",
        "q_k is coordinate k in the order of declaration, from 0; x_k of an array x its number k",
        "E1 = v·L_v - L - h/2*L_t",
        "Cyclic: `y[1][0]` to `y[1][4]`, `z`; their momenta are conserved",
    ];
    has_lines(&text(WELLS), &wells);
    let both = BODIES.replace("discretize midpoint", "discretize midpoint, trapezoidal");
    let trapezoidal = [
        "rule midpoint",
        "rule trapezoidal",
        "L_d = h*L",
        "L_d = h/2*(L(0) + L(1))",
        "r = (L_v(0) + L_v(1))/2 - h/2*(L_q + f)(0) - p0",
        "A = (L_vv(0) + L_vv(1))/2 + h/2*(L_vq(1) - L_qv(0) - f_v(0))",
        "p1 - p0 = h/2*((L_q + f)(0) + (L_q + f)(1))",
        "E1 = v·(L_v(0) + L_v(1))/2 - (L(0) + L(1))/2 + h/2*f(1)·v",
        "By the rule trapezoidal: `A` is dense; solved by elimination with pivoting",
    ];
    has_lines(&text(&both), &trapezoidal);
    let closed = [
        "constraint up[k in 3..5] = x[k] - k * d;",
        "up[i + 3] += x[i + 3] for i in 0..2",
        "rolls += -w*dot(q[4])",
        "L_vv*dv/dt = L_q - L_vq*v + A^T*Λ, with d/dt(A*v + a) = 0",
        "p1 = p_minus + A_1^T*μ",
        "Autonomous; no force acts, but a constraint does work",
        "Constraints on positions: up (2)",
        "Constraints on velocities: rolls",
    ];
    has_lines(&text(CLOSED), &closed);
    has_lines(&stage(tokens(WELLS), Stage::Model).expect("right"), &["rule midpoint", "parameter c = 0.3"]);
    has_lines(&stage(tokens(WELLS), Stage::Discrete).expect("right"), &["L_d = h*L", "p1 - p0 = h*L_q"]);
    let gauss = explain_gauss(tokens(LINKS), 2).expect("right").text();
    has_lines(&gauss, &["a_11 = 1/4", "F_i = L_q(t_i, q_i, v_i)", "p1 = p0 + h*(b_1*F_1 + b_2*F_2)"]);
}

#[test]
fn loops_and_lines_show_the_same_declarations() {
    let declarations = |system: &str| {
        let mut explained = explain(tokens(system)).expect("right");
        explained.sections.truncate(1);
        [explained.text(), explained.latex()]
    };
    for system in [BODIES, WELLS, CLOSED] {
        assert_eq!(declarations(system), declarations(&system.replace("#[vi_limit(0)] ", "")));
    }
}

#[test]
fn two_loops_are_shown_as_a_double_sum() {
    let system = BODIES.replace("N = 5", "N = 8").replace("m[N] = [1, 2, 3, 4, 5]", "m[N] = 2");
    let explained = explain(tokens(&system)).expect("right");
    let wanted =
        "L_2 = sum(i in 0..7, j in 0..7 - i, G*m[i]*m[i + j + 1]/hypot(x[i] - x[i + j + 1], y[i] - y[i + j + 1]))";
    has_lines(&explained.text(), &[wanted, "parameter m[0] to m[7] = each 2"]);
    assert!(explained.latex().contains("\\sum_{i=0}^{6} \\sum_{j=0}^{6 - i} \\frac{G m_{i} m_{i + j + 1}}"));
}

#[test]
fn an_explanation_is_a_document() {
    let trapezoidal = WELLS.replace("discretize midpoint", "discretize trapezoidal");
    for system in [BODIES, LINKS, WELLS, CLOSED, &trapezoidal] {
        for latex in
            [explain(tokens(system)).expect("right").latex(), explain_gauss(tokens(system), 3).expect("right").latex()]
        {
            assert!(latex.is_ascii(), "only what every engine of LaTeX reads: {latex}");
            let count = |part: &str| latex.matches(part).count();
            assert_eq!((count("\\left"), count("\\begin"), count("$") % 2), (count("\\right"), count("\\end"), 0));
        }
    }
    let latex = explain(tokens(LINKS)).expect("right").latex();
    let row = "    y_{i + 1} &= l \\cos\\left(q_{i + 1}\\right) + y_{i}, \\quad i = 0, \\ldots, 3 \\\\\n";
    assert!(latex.contains(row), "{latex}");
}

#[test]
fn functions_are_shown_operation_by_operation() {
    let program = stage(tokens(LINKS), Stage::Program).expect("right");
    let lines = [
        "lagrangian_1, 5 rows",
        "for i in 0..5: L += value, with a0 = dot(x[i])",
        "first derivatives: 2 operations",
        "%1 = a0 * a0",
        "value = %2",
        "d value/d a0 = a0",
        "d² value/d a0 d a0 = 1",
    ];
    has_lines(&program, &lines);
    assert!(program.contains("    for i in 0..4: ") && program.contains("y[i + 1] = value"), "{program}");
    let force = "for i in 0..4: f_x[i + 1] += value, with a0 = dot(x[i + 1])";
    has_lines(&stage(tokens(BODIES), Stage::Program).expect("right"), &[force]);
}

#[test]
fn checks_are_emitted() {
    let checks = |system: &str| {
        let file: syn::File = syn::parse2(expand(tokens(system))).expect("Rust");
        let module = file.items.into_iter().find_map(|item| match item {
            syn::Item::Mod(module) => Some(module),
            _ => None,
        });
        let items = module.expect("a module of tests").content.expect("its items").1;
        let names = items.into_iter().filter_map(|item| match item {
            syn::Item::Fn(function) if !function.attrs.is_empty() => Some(function.sig.ident.to_string()),
            _ => None,
        });
        names.collect::<Vec<_>>()
    };
    let forced = ["derivatives", "slots", "steps", "energy_equations", "order", "reversibility", "energy"];
    assert_eq!(checks(BODIES), forced);
    assert_eq!(checks(LINKS), ["derivatives", "gauss_order", "gauss_symplecticity"]);
    let free =
        WELLS.replace("discretize midpoint;", "discretize midpoint; check { x[i in 0..N] = i, z = 1; h = 0.1; }");
    let all =
        ["derivatives", "slots", "steps", "energy_equations", "order", "momenta", "symplecticity", "reversibility"];
    assert_eq!(checks(&free)[..8], all);
    assert_eq!(checks(&free)[8..], ["energy", "step_law"]);
    assert_eq!(checks(CLOSED), ["derivatives", "constraints", "reaction", "gauss_order"]);
    // Two loops or straight lines: the same tests.
    assert_eq!(checks(&free), checks(&free.replace("#[vi_limit(0)] ", "")));
    assert!(!expand(tokens(WELLS)).to_string().contains("cfg (test)"), "no clause, no tests");
}

#[test]
fn properties_are_documented() {
    let system = parse::system(tokens(BODIES)).expect("a system");
    let Ok(Compiled::Loops(loops)) = Compiled::of(&system) else { panic!("loops") };
    let lines = documentation(&loops.indexed);
    assert_eq!(lines[0], "Autonomous; a force acts");
    let wanted = "Loops: 5 over terms of `L`, 1 over terms of `f`; 3 functions of one row";
    assert!(lines.iter().any(|line| line == wanted), "{lines:?}");
    // Small systems and systems with mistakes take straight lines.
    let system = parse::system(tokens(&BODIES.replace("#[vi_limit(0)]", ""))).expect("a system");
    assert!(matches!(Compiled::of(&system), Ok(Compiled::Lines(_))));
    assert!(Compiled::from_tokens(tokens("#[vi_limit(0)] struct A { coord q[3]; L = p; }")).is_err());
}
