//! Every mistake, reported at the smallest wrong token.
//!
//! Each case is the body of a system with the wrong token between `«` and `»`. The compiler must report exactly there,
//! with the given text.

use proc_macro2::TokenStream;
use vi_codegen::syntax;

/// All errors of a text: (token underlined, message).
pub(crate) fn errors(text: &str) -> Vec<(String, String)> {
    let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
    let result = syntax::parse::system(tokens).and_then(|system| vi_codegen::derive(&system)).map(|_| ());
    let Err(error) = result else { return Vec::new() };
    let token = |error: &syn::Error| error.span().source_text().unwrap_or_default();
    error.into_iter().map(|error| (token(&error), error.to_string())).collect()
}

/// One case: the marked token is underlined, and the message starts with the given text.
pub(crate) fn case(body: &str, message: &str) {
    let marked = body.split_once('«').and_then(|(_, rest)| rest.split_once('»')).map(|(token, _)| token);
    let text = format!("struct System {{ {} }}", body.replace(['«', '»'], ""));
    let found = errors(&text);
    let wanted = marked.unwrap_or("System");
    assert_eq!(found.len(), 1, "{text}\n{found:#?}");
    let (token, diagnostic) = &found[0];
    assert_eq!(token, wanted, "{text}\n{diagnostic}");
    assert!(diagnostic.starts_with(message), "{text}\nsays: {diagnostic}\nnot:  {message}");
    assert!(diagnostic.contains("\nhelp: "), "{diagnostic}");
    println!("{text}\n    at `{token}`: {diagnostic}\n");
}

/// One case: a summand of L.
fn says(summand: &str, message: &str) {
    case(&format!("param m = 1, g = 2; coord x; L = m * dot(x)^2 * g - {summand}; discretize midpoint;"), message);
}

/// The rest of a correct system.
const REST: &str = "coord x; L = dot(x)^2 / 2; discretize midpoint;";

/// One case: a clause before the rest of a correct system.
fn clause(clause: &str, message: &str) {
    case(&format!("{clause} {REST}"), message);
}

#[test]
fn names() {
    case("param a = 1, «a» = 2; coord x; L = a * dot(x)^2; discretize midpoint;", "the name `a` is declared twice");
    case(
        "param «t» = 1; coord x; L = dot(x)^2; discretize midpoint;",
        "the name `t` is reserved\nhelp: `t` is the time",
    );
    case("param «L» = 1; coord x; L = dot(x)^2; discretize midpoint;", "the name `L` is reserved");
    case("param «L» = 1; coord x; L = dot(x)^2 / L; discretize midpoint;", "the name `L` is reserved");
    case("param «f» = 1; coord x; L = dot(x)^2; force x = -f; discretize midpoint;", "the name `f` is reserved");
    case("param «sin» = 1; coord x; L = dot(x)^2; discretize midpoint;", "the name `sin` is reserved");
    case(
        "param mass = 1; coord x; L = «mas» * dot(x)^2; discretize midpoint;",
        "unknown name `mas`\nhelp: did you mean `mass`?",
    );
    case("coord x; L = «g» * dot(x)^2; discretize midpoint;", "unknown name `g`\nhelp: declare it");
    let below = "`b` is not declared before this line\nhelp: move its declaration up: a `let` or `const` uses earlier";
    case("coord x; let a = «b»; let b = 1; L = a * dot(x)^2; discretize midpoint;", below);
    case("coord x; let b = «b»; L = b * dot(x)^2; discretize midpoint;", below);
    case("coord x; const a = «b», b = 1; L = a * b * dot(x)^2; discretize midpoint;", below);
    case("coord x; L = dot(x)^2 * «sin»; discretize midpoint;", "`sin` is a function\nhelp: write its argument");
    case("coord x; L = dot(x)^2 * «cosine»(x); discretize midpoint;", "unknown function `cosine`");
    case(
        "coord x; L = dot(x)^2 * «sinn»(x); discretize midpoint;",
        "unknown function `sinn`\nhelp: did you mean `sin`?",
    );
    case("coord x; L = dot(x)^2 * «atan2»(x); discretize midpoint;", "`atan2` takes 2 arguments, not 1");
    case("coord x; L = dot(x)^2 * «sin»(x, 1); discretize midpoint;", "`sin` takes 1 argument, not 2");
    case("coord x; L = dot(x)^2 * «sin»(); discretize midpoint;", "`sin` takes 1 argument, not 0");
}

#[test]
fn time_scales() {
    let rest = |clauses: &str| {
        format!("coord x, y[2]; let speed = dot(x)^2; let e[i in 0..2] = dot(y[i]); {clauses} {OF_THREE}")
    };
    case(
        &rest("time_scale = 1 + «dot»(x)^2;"),
        "a time scale cannot depend on the velocities in `dot`\nhelp: use positions",
    );
    case(&rest("time_scale = 1 + «speed»;"), "a time scale cannot depend on the velocities in `speed`");
    case(&rest("time_scale = 1 + «e»[0]^2;"), "a time scale cannot depend on the velocities in `e`");
    case(&rest("time_scale = «0»;"), "the time scale is not positive");
    case(&rest("time_scale = «cos»(pi);"), "the time scale is not positive");
    case(&rest("time_scale = 1 + x^2; «time_scale» = 1;"), "a second `time_scale`");
    case(&rest("let zero = x - x; time_scale = 1 / «zero»;"), "division by zero");
    case(&rest("time_scale = «ln»(x - x);"), "this expression has no value");
    case(&rest("time_scale = 1 + «z»;"), "unknown name `z`");
    case(&rest("time_scale = 1 + «y»;"), "a number and a vector of 2 cannot be added");
    case(&rest("param «a» = 1; time_scale = 1 + x^2;"), "the parameter `a` is never used");
    case(&rest("«time_scales» = 1;"), "unknown clause `time_scales`\nhelp: did you mean `time_scale`?");
    // A parameter used only there counts as used.
    let accepted = rest("param a = 1; time_scale = sqrt(a + x^2 + sum(i in 0..2, y[i]^2) + sin(t)^2);");
    assert_eq!(errors(&format!("struct System {{ {accepted} }}")), []);
}

/// The rest of a correct system with three coordinates.
const OF_THREE: &str = "L = (dot(x)^2 + dot(y[0])^2 + dot(y[1])^2) / 2; discretize midpoint;";

#[test]
fn inputs() {
    let help = "help: write `u = 0.0`: an `input` needs a default, its value until a controller sets it";
    clause("input «u»;", &format!("`u` has no value\n{help}"));
    clause("input w = 1.0, «u», ", "`u` has no value");
    clause("input «u»[3];", "`u` has no value");
    clause("input «u» = 0.0;", "the input `u` is never used\nhelp: use it in `L` or in a force");
    clause("input «u»[2] = 0.0;", "the input `u` is never used");
    clause(
        "input «u» = [0, 1];",
        "`u` is not an array but has a list of values\nhelp: write its length: `input u[2] = […];`",
    );
    clause("input u«:» f64 = 1.0;", "a declaration has no type");
    clause("param a = 1; input «a» = 1;", "the name `a` is declared twice");
    for word in ["inputs", "control", "controls", "actuator", "actuators"] {
        let help = "write `input u = 0.0;`, a parameter that a controller sets between steps";
        clause(&format!("«{word}» u = 0.0;"), &format!("unknown clause `{word}`\nhelp: {help}"));
    }
    clause("«inptu» u = 0.0;", "unknown clause `inptu`\nhelp: did you mean `input`?");
    clause("«#»[cfg(test)] input u = 0.0;", "this attribute has no meaning here");
    // The clause before it lacks its `;`.
    case("param m = «1» input u = 0; coord x; L = m * u * dot(x)^2; discretize midpoint;", "`;` is missing after `1`");
    // The word starts a clause, and is a name elsewhere.
    for accepted in [
        "input u[2] = 0.0, w = 1.0; coord x; L = dot(x)^2 / 2; force x = u[0] + u[1] * w; discretize midpoint;",
        "param input = 1; coord x; L = input * dot(x)^2 / 2; discretize midpoint; check { input = 2; h = 0.1; }",
        "input input = 1; coord x; let control = input^2; L = control * dot(x)^2 / 2; discretize midpoint;",
        "coord input; L = dot(input)^2 / 2 - input; force input = 1; discretize midpoint;",
        "#[allow(dead_code)] input u = 1; coord x; L = dot(x)^2 / 2 - u * x; discretize midpoint;",
        "const input = 1; coord x; L = dot(x)^2 / 2 - 2 * input * x; discretize midpoint;",
    ] {
        assert_eq!(errors(&format!("struct System {{ {accepted} }}")), [], "{accepted}");
    }
}

#[test]
fn velocities() {
    case("param «a» = 1; coord x; L = dot(x)^2; discretize midpoint;", "the parameter `a` is never used");
    case(
        "param a = 1, «b» = 2; coord x; L = a * dot(x)^2 + b * x - b * x; discretize midpoint;",
        "the parameter `b` is never used",
    );
    for constant in ["a", "pi", "e", "b", "2"] {
        case(
            &format!(
                "param a = 1; const e = 2; let b = a * pi; coord x; L = dot(x)^2 * dot(«{constant}»); discretize midpoint;"
            ),
            &format!(
                "`dot({constant})`: `{constant}` does not change with time\nhelp: `dot` is the derivative with respect to time"
            ),
        );
    }
    case(
        "coord x; let m[i in 0..2] = i; L = dot(x)^2 * dot(«m»[0]); discretize midpoint;",
        "`dot(m)`: `m` does not change with time",
    );
    case(
        "coord x; L = dot(x)^2 * «dot»(x, t); discretize midpoint;",
        "`dot` is the time derivative, of one argument\nhelp: the inner product is `a * b`",
    );
    case("coord x; L = dot(x)^2 * dot(«sin»); discretize midpoint;", "`sin` is a function");
    case("coord q[2]; L = «dot»(q[0])^2 * dot(q); discretize midpoint;", "a number is needed here, not a vector of 2");
    case(
        "coord x; L = dot(x)^2; force x = «dot»(dot(x)); discretize midpoint;",
        "an expression cannot depend on the acceleration",
    );
    for (argument, name) in [("«v»", "v"), ("«w»[1]", "w[…]"), ("«x» * v", "…"), ("2 * dot(x)", "…")] {
        let argument = if argument.contains('«') { argument.to_owned() } else { argument.replace('2', "«2»") };
        case(
            &format!(
                "coord x; let v = x + dot(x), w[i in 0..2] = i * dot(x); L = dot(x)^2; force x = dot({argument}); discretize midpoint;"
            ),
            &format!("an expression cannot depend on the acceleration `dot({name})`"),
        );
    }
    case(
        "coord θ; L = dot(θ)^2; force θ = -«θ_ddot»; discretize midpoint;",
        "an expression cannot depend on the acceleration `θ_ddot`",
    );
    case("coord x; «L» = x^2; discretize midpoint;", "`L` does not depend on any velocity");
    case(
        "coord x, «y»; L = dot(x)^2; discretize midpoint;",
        "the mass matrix ∂²L/∂v² is singular for every state\nhelp: `y` has no kinetic energy",
    );
    case(
        "coord x, y; «L» = (dot(x) + dot(y))^2; discretize midpoint;",
        "the mass matrix ∂²L/∂v² is singular for every state",
    );
    case(
        "coord «x», y; L = x * dot(x) + dot(y)^2; discretize midpoint;",
        "the mass matrix ∂²L/∂v² is singular for every state\nhelp: `dot(x)` appears in `L` only to the first power",
    );
    for first_order in [
        "coord x; «L» = x * dot(x);",
        "param a = 1, b = 2; coord x, y; «L» = (ln(y) / x + y) * dot(x) - (a * x + b * y - ln(x) - 2 * ln(y));",
        "coord x, y; let s = 1 + x^2 + y^2; «L» = s * (x * dot(y) - y * dot(x)) - cos(x) - sin(y);",
    ] {
        case(
            &format!("{first_order} discretize midpoint;"),
            "the mass matrix ∂²L/∂v² is singular for every state\nhelp: `L` is linear in the velocities; systems of first order",
        );
    }
    case(
        "param k = 1; coord x, «y»; L = dot(x)^2 / 2 - k * (x - y)^2 / 2; dissipation = dot(y)^2 / 2; discretize midpoint;",
        "the mass matrix ∂²L/∂v² is singular for every state\nhelp: `y` has no kinetic energy, and coordinates without mass",
    );
    for homogeneous in [
        "param m = 1, c = 3e8; coord T, x; «L» = -m * c * sqrt(c^2 * dot(T)^2 - dot(x)^2);",
        "coord x, y; «L» = sqrt(dot(x)^2 + dot(y)^2) / y;",
        "coord x, y; «L» = dot(x)^2 / dot(y) + dot(y) * x;",
    ] {
        case(
            &format!("{homogeneous} discretize midpoint;"),
            "the mass matrix ∂²L/∂v² is singular for every state\nhelp: `L` is homogeneous of degree 1 in the velocities",
        );
    }
    case(
        "coord x, y; «L» = (dot(x) - dot(y))^2 / 2 - x^2; discretize midpoint;",
        "the mass matrix ∂²L/∂v² is singular for every state\nhelp: every direction of motion needs kinetic energy",
    );
}

/// The message names the expression that has a value but no derivative.
#[test]
fn derivatives_that_do_not_exist() {
    for (summand, diagnostic) in [
        (
            "0^dot(x)",
            "`pow(0, dot(x))` has no derivative with respect to `dot(x)`\nhelp: its derivative divides by zero",
        ),
        ("3 * sin(2 * x) * 0^x", "`pow(0, x)` has no derivative with respect to `x`"),
        ("x * (-2)^t", "`pow(-2, t)` has no derivative with respect to `t`"),
        ("x^2 * asin(x / sqrt(x^2))", "`asin(x/sqrt(x^2))` has no derivative with respect to `x`"),
    ] {
        case(&format!("coord x; «L» = dot(x)^2 / 2 - {summand}; discretize midpoint;"), diagnostic);
    }
    case(
        "coord «x»; L = dot(x)^2 / 2; force x = x + (-1)^dot(x); discretize midpoint;",
        "`pow(-1, dot(x))` has no deriv",
    );
    case(&format!("dissipation = «0»^dot(x); {REST}"), "this expression has no value");
    let time_scale = errors(&format!("struct System {{ time_scale = 1 + 0^x; {REST} }}"));
    assert!(time_scale[0].1.starts_with("`pow(0, x)` has no derivative with respect to `x`"), "{time_scale:?}");
}

#[test]
fn constants() {
    case(
        "param k = 1, m = 1, w = sqrt(«k»/2); coord x; L = m * dot(x)^2 - k * w * x^2; discretize midpoint;",
        "`k` is a parameter: it has no value at compile time\nhelp: write defaults, `const`s and lengths with \
         numbers and `const`s; name an expression of parameters or coordinates with `let`, as in `let w = sqrt(k / m);`",
    );
    case("coord x; const a = «x»; L = dot(x)^2; discretize midpoint;", "`x` is a coordinate: it has no value at");
    case("param a = 1; const b = «a»; coord x; L = dot(x)^2; discretize midpoint;", "`a` is a parameter: it has no");
    case(
        "coord q[«n»]; let n = 3; L = 1; discretize midpoint;",
        "`n` is a `let`, which a constant cannot use\nhelp: write defaults, `const`s and lengths with",
    );
    case("const a = «ln»(0); coord x; L = dot(x)^2; discretize midpoint;", "this expression has no value");
    case("const a = «exp»(1000); coord x; L = dot(x)^2; discretize midpoint;", "the value of `a` is not finite");
    case(
        "const a = sqrt(2) - 2; param b = «sqrt»(a); coord x; L = b * dot(x)^2; discretize midpoint;",
        "this expression has no value",
    );
    case("coord x; L = dot(x)^2 - «sin»(10^2000) * x; discretize midpoint;", "more than 4096 bits are needed to round");
    case("coord x; L = dot(x)^2 - sin(1 + «cos»(10^10^6)) * x; discretize midpoint;", "more than 4096 bits are needed");
    let beyond = "this number is outside the range of double precision\nhelp: choose other units";
    case("coord x; L = dot(x)^2 - 1 / «exp»(exp(exp(10))) * x; discretize midpoint;", beyond);
    case("coord x; L = dot(x)^2 - «exp»(-exp(exp(10))) * x; discretize midpoint;", beyond);
    case("param a = «exp»(-800); coord x; L = a * dot(x)^2; discretize midpoint;", beyond);
    case("coord x; L = dot(x)^2; discretize midpoint; check { x = «1e-200» * 1e-200; h = 1; }", beyond);
    case("coord x; L = dot(x)^2 * sin(«asin»(2)); discretize midpoint;", "this expression has no value");
    case("coord x; L = dot(x)^2 - x * «tan»(pi / 2); discretize midpoint;", "this expression has no value");
    case("const a = 1 / «0»; coord x; L = dot(x)^2; discretize midpoint;", "division by zero");
    case("coord x; L = dot(x)^2 / («x» - x); discretize midpoint;", "division by zero");
    case("coord x; L = dot(x)^2 - sin(x / («t» - t)); discretize midpoint;", "division by zero");
    // Zero to rounding.
    case("coord x; L = dot(x)^2 - exp(1 / («ln»(2) + ln(3) - ln(6))) * x; discretize midpoint;", "division by zero");
    case("coord x; L = dot(x)^2 - x^2 / («sqrt»(2) * sqrt(3) - sqrt(6)); discretize midpoint;", "division by zero");
    let by_rule = |divisor: &str| {
        let ld = format!("h * L(t0, q0, (q1 - q0) / ({divisor}))");
        format!("coord x; L = dot(x)^2 - x^2; discretize {{ Ld = {ld}; }}")
    };
    case(&by_rule("«h» - h"), "division by zero");
    case(&by_rule("«t1» - t0 - h"), "division by zero");
    assert_eq!(errors(&format!("struct System {{ {} }}", by_rule("t1 - t0"))), []);
    case(
        "coord x; L = dot(x)^2; «dissipation» x = dot(x)^2; discretize midpoint;",
        "`dissipation` has no value\nhelp: write `dissipation = …;`, one function for all coordinates",
    );
    case("coord x; L = dot(x)^2 * «0»^-1; discretize midpoint;", "this expression has no value");
    case("const a = «t»; coord x; L = dot(x)^2; discretize midpoint;", "the value of `a` is not a constant");
    case(
        "coord x; L = dot(x)^2 * «2x»; discretize midpoint;",
        "the number `2` is followed directly by `x`\nhelp: write `2 * x`",
    );
    case("coord x; L = dot(x)^2 * «0x10»; discretize midpoint;", "not a decimal number");
    case("coord x; L = dot(x)^2 * «\"a\"»; discretize midpoint;", "a text is no number");
    case(
        "coord x; L = dot(x)^2 * «1e400»; discretize midpoint;",
        "this number is outside the range of double precision",
    );
}

#[test]
fn clauses() {
    case("coord x; discretize midpoint;", "the system has no Lagrangian");
    case("L = 1; discretize midpoint;", "the system has no coordinates");
    case("coord x; L = dot(x)^2; «L» = dot(x)^2; discretize midpoint;", "a second `L`");
    case(
        "coord x; L = dot(x)^2; discretize midpoint; discretize «midpoint»;",
        "a second `discretize`\nhelp: write `discretize` once; it",
    );
    case("coord x; L = dot(x)^2; discretize «midpont»;", "unknown rule `midpont`\nhelp: did you mean `midpoint`?");
    case("coord x; L = dot(x)^2; discretize «gaus»;", "unknown rule `gaus`\nhelp: did you mean `gauss`?");
    case(
        "coord x; L = dot(x)^2; discretize gauss, midpoint, «gauss»;",
        "the rule `gauss` is listed twice\nhelp: list each",
    );
    case("coord x; L = dot(x)^2; discretize midpoint, «trapzoidal»;", "unknown rule `trapzoidal`\nhelp: did you mean");
    case(
        "coord x; L = dot(x)^2; discretize midpoint, «midpoint»;",
        "the rule `midpoint` is listed twice\nhelp: list each",
    );
    let written = "Ld = h * L(t0, q0, (q1 - q0)/h);";
    case(
        &format!("coord x; L = dot(x)^2; discretize midpoint, «{{» {written} }}"),
        "a written-out rule cannot appear in a",
    );
    case(
        &format!("coord x; L = dot(x)^2; discretize {{ {written} }}«,» midpoint;"),
        "a written-out rule cannot appear in a",
    );
    case("coord x; L = dot(x)^2; discretize midpoint, «,»;", "expected a name");
    case("coord x; L = dot(x)^2; discretize midpoint «trapezoidal»;", "expected `,` or `;`");
    let gauss = "Gauss methods need no clause: every system has their steps, of order 2 S with S stages";
    for rule in ["Gauss", "gauss_legendre", "collocation"] {
        case(&format!("coord x; L = dot(x)^2; discretize «{rule}»;"), &format!("unknown rule `{rule}`\nhelp: {gauss}"));
    }
    case(
        "coord x; L = dot(x)^2; discretize «simpson»;",
        &format!("unknown rule `simpson`\nhelp: the rules are gauss, midpoint, trapezoidal; {gauss}"),
    );
    case("coord x; L = dot(x)^2; discretize «verlet»;", "unknown rule `verlet`\nhelp: write `trapezoidal`, which is");
    for arguments in ["gauss«(»4)", "order «=» 4", "gauss «4»", "Gauss«<»4>", "midpoint«(»h)"] {
        case(
            &format!("coord x; L = dot(x)^2; discretize {arguments};"),
            &format!("a rule takes no arguments\nhelp: write `discretize gauss;` or `discretize midpoint;`; {gauss}"),
        );
    }
    for sign in ["=", ":"] {
        case(
            &format!("coord x; L = dot(x)^2; discretize «{sign}» midpoint;"),
            "`discretize` takes names of rules, without `=`\nhelp: write `discretize midpoint;`",
        );
    }
    for clause in ["order", "stages", "method"] {
        case(&format!("{REST} «{clause}» = 4;"), &format!("unknown clause `{clause}`\nhelp: {gauss}"));
    }
    for clause in ["h = 0.01", "initial x = 1", "steps = 100"] {
        let word = clause.split(' ').next().unwrap_or_default();
        case(
            &format!("{REST} {};", clause.replacen(word, &format!("«{word}»"), 1)),
            &format!("unknown clause `{word}`\nhelp: set the step and the initial state of a run: `system.at(t, q, v)"),
        );
    }
    case("coord x; L = dot(x)^2; force «y» = 1; discretize midpoint;", "`y` has a force but is not a coordinate");
    case("coord x; L = dot(x)^2; force x = 1; force «x» = 2; discretize midpoint;", "a second force on `x`");
    case(&format!("«parm» a = 1; {REST}"), "unknown clause `parm`\nhelp: did you mean `param`?");
    case(&format!("«;» {REST}"), "expected a clause");
    case(&format!("param a «1»; {REST}"), "expected `=`");
    case(&format!("param «1» = 1; {REST}"), "expected a name");
    case(&format!("param «r#type» = 1; {REST}"), "the name `r#type` is reserved");
    case("coord x; L = dot(x)^2 «,» x; discretize midpoint;", "expected an operator or `;`");
    case("coord x; L = dot(x)^2 * «;» discretize midpoint;", "expected a number, a name or `(`");
    case("coord x; L = dot(x)^2 * (x«,» x); discretize midpoint;", "expected an operator or `)`");
    case("coord x; L = dot(x)^2 * hypot(x «;» x); discretize midpoint;", "expected an operator, `,` or `)`");
}

/// Names that contain more than one name.
#[test]
fn velocities_functions_and_products_in_a_name() {
    says("«v»", "unknown name `v`\nhelp: write `dot(x)` for the velocity of `x`, or name it: `let v = dot(x);`");
    says("«dx»/2", "unknown name `dx`\nhelp: write `dot(x)`");
    says("x/«dt»", "unknown name `dt`\nhelp: write `dot(x)` for the derivative of `x` with respect to time");
    for function in ["d", "diff", "derivative"] {
        says(
            &format!("«{function}»(x)"),
            &format!(
                "unknown function `{function}`\nhelp: write `dot(a)` for a derivative with respect to time; the macro differentiates `L`"
            ),
        );
    }
    says("«sinx»", "unknown name `sinx`\nhelp: write `sin(x)`");
    says("«sqrtg» * x", "unknown name `sqrtg`\nhelp: write `sqrt(g)`");
    says("«mg» * x", "unknown name `mg`\nhelp: write `m * g` for a product");
    says("«mgx»", "unknown name `mgx`\nhelp: write `m * g * x` for a product");
    let pendulum = |summand: &str| format!("coord θ; L = dot(θ)^2 - {summand}; discretize midpoint;");
    case(&pendulum("«cosθ»"), "unknown name `cosθ`\nhelp: write `cos(θ)`");
    case(&pendulum("«theta_dot»"), "unknown name `theta_dot`\nhelp: write `dot(θ)`, the velocity of `θ`");
    case(&pendulum("«θ_dot»"), "unknown name `θ_dot`\nhelp: write `dot(θ)`");
    case(&pendulum("«θ\u{307}»"), "unknown name `θ\u{307}`\nhelp: write `dot(θ)`");
    case(&pendulum("«theta»"), "unknown name `theta`\nhelp: did you mean `θ`?");
    case(
        "coord theta; L = dot(theta)^2 - «θ_dot»; discretize midpoint;",
        "unknown name `θ_dot`\nhelp: write `dot(theta)`, the velocity of `theta`",
    );
    says("«ẍ»", "an expression cannot depend on the acceleration `ẍ`");
}

/// Operators, fields and brackets of other languages.
#[test]
fn other_operators_fields_and_brackets() {
    says("x.«y»", "`.y`: names have no fields\nhelp: write plain names");
    says("x.«dot»", "`.dot`: names have no fields\nhelp: write `dot(x)` for the velocity of `x`");
    for condition in ["x «>» 0", "x «=»= 1", "x «!»= 1", "x «<»= 1", "x «?» 1 : 2"] {
        says(condition, "a comparison is part of an `if`\nhelp: write `if a > b { x } else { y }`");
    }
    says("x «%» 2", "`%` is not an operator\nhelp: the operators are `+ - * / ^`; angles need no remainder");
    says("x«!»", "`!` is not an operator\nhelp: the operators are `+ - * / ^`");
    says("2 * «[»x + 1]", "only parentheses group an expression\nhelp: write `(a + b)`");
    says("2 * «{»x + 1}", "only parentheses group an expression");
    says("«m·x»", "unknown name `m·x`\nhelp: write `m * x` for a product");
    says("«i» * x", "unknown name `i`\nhelp: an index needs a range, as in `sum(i in 0..3, q[i])`");
}

/// Definitions in the style of other languages.
#[test]
fn other_definitions() {
    clause("const «c»;", "`c` has no value\nhelp: write `c = …`");
    clause("let «y»;", "`y` has no value\nhelp: write `y = …`");
    clause("let y «:»= x;", "a definition uses `=`\nhelp: write `=`");
    clause("let «mut» u = x;", "`let` names an expression and cannot be mutable\nhelp: remove `mut`");
    clause("let u«(»x) = x;", "`u(…)`: a function is declared with `fn`\nhelp: write `fn u(a) = …;`");
    clause("param a = 1, «5»;", "a decimal fraction uses a point, not a comma\nhelp: write `1.5`");
    clause("«#» the mass", "`#` does not start a comment\nhelp: write `// …`");
    clause(
        "force x «+»= 1;",
        "the force on a coordinate is written once\nhelp: write `force x = …;`, with the sum of all forces on `x`",
    );
    clause("force dot«(»x) = 1;", "this force names no coordinate\nhelp: write the coordinate that it acts on");
    clause("coord z; «z» = 1;", "unknown clause `z`\nhelp: set the step and the initial state of a run");
    clause("coord z; «z»(0) = 1;", "unknown clause `z`\nhelp: set the step and the initial state of a run");
    clause("«l» = 1;", "unknown clause `l`\nhelp: write `L = …;` for the Lagrangian, `let l = …;` to name a part");
}

/// Notation of Rust, of other languages and of mathematics.
#[test]
fn habits() {
    says("x.«sin»()", "`.sin(…)`: numbers have no methods\nhelp: write it as a function, `sin(…)`");
    says("2.0.«sqrt»()", "`.sqrt(…)`: numbers have no methods");
    says("(x + 1).«powi»(2)", "`.powi(…)`: numbers have no methods\nhelp: write `a^b`");
    says("x.«max»(1)", "`.max(…)`: numbers have no methods\nhelp: write `max(a, b)`");
    says("x «*»* 2", "`**` is not an operator\nhelp: write `x^2`");
    says("x «as»  f64", "numbers need no conversion\nhelp: remove `as`");
    says("«1.0f64» * x", "the number `1.0` has the type `f64`\nhelp: write `1.0`: numbers are exact");
    says("«2_i32» * x", "the number `2` has the type `i32`\nhelp: write `2`");
    says("«2usize» * x", "the number `2` has the type `usize`\nhelp: write `2`");
    says("1.«e» - 3 * x", "a number needs a digit before its point and before its exponent\nhelp: write `1.0e-3`");
    says("1.«e3» * x", "a number needs a digit before its point and before its exponent\nhelp: write `1.0e3`");
    says("«.»5 * x", "a number needs a digit before its point and before its exponent\nhelp: write `0.5`");
    says(
        "«if» x { 1 } else { 2 }",
        "`if` needs one comparison by `>`, `>=`, `<` or `<=`\nhelp: write `if a > b { x } else { y }`",
    );
    says("«|»x|", "bars do not denote the absolute value\nhelp: write `abs(x)`");
    says("2«|»x|", "bars do not denote the absolute value\nhelp: write `abs(x)`");
    says("x«'»x", "a prime does not denote a derivative\nhelp: write `dot(x)`");
    says("x«':'»", "a prime does not denote a derivative\nhelp: write `dot(x)`");
    says("f64«:»:consts::PI", "an expression cannot contain a path\nhelp: write `pi` and `sin(x)`; declare");
    says("dot(x)«[»0]", "only a name can have an index\nhelp: write `dot(q[0])`");
    says("2 «x»", "an operator is missing between `2` and `x`\nhelp: write `2 * x` for a product; units are not");
    says("m «g»", "an operator is missing between `m` and `g`\nhelp: write `m * g` for a product");
    says("(m «g»)", "an operator is missing between `m` and `g`");
    says("x^2 «(»x + 1)", "an operator is missing between `2` and `(…)`\nhelp: write `2 * (…)` for a product");
    says(
        "sin(x) «cos»(x)",
        "an operator is missing between `sin(…)` and `cos(…)`\nhelp: write `sin(…) * cos(…)` for a",
    );
    says("sin «x»", "`sin` is a function\nhelp: write its argument in parentheses: `sin(x)`");
    says("«sin»^2(x)", "`sin` is a function\nhelp: write its argument: `sin(…)`; a power follows it, `sin(…)^2`");
    says("x^«1»/2", "`a^1/b` is `(a^1) / b`\nhelp: write `a^(1/b)` for a root");
    says("x^«-»1/2", "`a^-1/b` is `(a^-1) / b`\nhelp: write `a^(-1/b)` for a root");
    says("«xdot»", "unknown name `xdot`\nhelp: write `dot(x)`, the velocity of `x`");
    for name in ["x_dot", "dotx", "dot_x", "vx", "v_x", "dx", "d_x", "ẋ", "x\u{307}"] {
        says(&format!("«{name}»"), &format!("unknown name `{name}`\nhelp: write `dot(x)`"));
    }
    says("«xddot»", "an expression cannot depend on the acceleration `xddot`");
    says("«ddot»(x)", "an expression cannot depend on the acceleration `ddot(…)`");
    case(
        "coord q[2]; L = dot(q[0])^2 + «q_dot»[1]^2; discretize midpoint;",
        "unknown name `q_dot`\nhelp: write `dot(q[…])`, the velocity of `q[…]`",
    );
    says("«π»", "unknown name `π`\nhelp: write `pi`");
    says("«e»^x", "unknown name `e`\nhelp: write `exp(x)` for e^x");
    says("«time»", "unknown name `time`\nhelp: write `t`");
    says("«lambda» * x", "unknown name `lambda`\nhelp: write `constraint rod = x^2 + y^2 - l^2;`: the expression is 0");
    for (function, help) in [
        ("fmin", "write `min(a, b)`"),
        ("saturation", "write `clamp(x, a, b)`"),
        ("log", "write `ln(a)` for the natural logarithm"),
        ("arctan", "write `atan(a)`"),
        ("asinh", "write `ln(a + sqrt(a^2 + 1))`"),
        ("cbrt", "write `a^(1/3)`"),
        ("sech", "write `1 / cosh(a)`"),
        ("sinc", "write `sin(a) / a`"),
        ("floor", "rounding and remainders are not supported"),
        ("diff", "write `dot(a)` for a derivative with respect to time"),
    ] {
        says(&format!("«{function}»(x, 1)"), &format!("unknown function `{function}`\nhelp: {help}"));
    }
    clause("param m«:» f64 = 1.0;", "a declaration has no type\nhelp: write `param m = 1.0;`");
    clause("coord y«:» f64;", "a declaration has no type");
    clause("param «m»;", "`m` has no value\nhelp: write `m = 1.0`: a `param` needs a default");
    clause("param a = 1, «m»;", "`m` has no value");
    clause("param «m»", "`m` has no value");
    clause("coord y «=» 1;", "a coordinate is declared without a value\nhelp: write `coord x;`: set the initial value");
    clause(
        "force «=» x;",
        "this force names no coordinate\nhelp: write the coordinate that it acts on: `force x = …;`",
    );
    clause("force«(»x) = x;", "this force names no coordinate");
    clause(
        "param g = 9.81 «m»/s^2;",
        "an operator is missing between `9.81` and `m`\nhelp: write `9.81 * m` for a product; units",
    );
    clause(
        "param g = «9.81m»/s^2;",
        "the number `9.81` is followed directly by `m`\nhelp: write `9.81 * m` for a product; units are not",
    );
    clause(
        "«constraints» x^2 + y^2 = 1;",
        "unknown clause `constraints`\nhelp: write `constraint rod = x^2 + y^2 - l^2;`: the expression is 0",
    );
    clause("«for» i in 0..3 {};", "unknown clause `for`\nhelp: write `force q[i in 0..8] = …;`");
    clause("«parameter» m = 1;", "unknown clause `parameter`\nhelp: write `param a = 1.0;`");
    clause(
        "«T» = dot(x)^2 / 2;",
        "unknown clause `T`\nhelp: write `param T = …;` for a parameter, `let T = …;` to name a part",
    );
    case(
        "coord «λ», x, y; L = (dot(x)^2 + dot(y)^2) / 2 + λ * (x^2 + y^2 - 1); discretize midpoint;",
        "the mass matrix ∂²L/∂v² is singular for every state\nhelp: `λ` multiplies a constraint: remove `λ`, and write `constraint rod = x^2 + y^2 - l^2;`: the expr",
    );
}

/// Features of other tools that this language lacks: the message reports that, or the replacement.
#[test]
fn unsupported_features_are_reported() {
    let delay = "`x` is a coordinate, not a function\nhelp: write `x` for its value at the time `t`, `x * (…)` for a product; delays";
    says("«x»(t - m)", delay);
    says("«x»(0)", delay);
    case(
        "coord q[2], x; L = dot(x)^2 + dot(q[0])^2 - «q»(1) * x; discretize midpoint;",
        "`q` is an array, not a function",
    );
    says("«delay»(x, 1)", "unknown function `delay`\nhelp: delays are not supported");
    says(
        "«product»(i in 0..3, i * x)",
        "`product` does not take a range\nhelp: only `sum` takes a range: write the factors one by one",
    );
    says(
        "sin(«prod»(i in 0..3, i * x))",
        "`prod` does not take a range\nhelp: only `sum` takes a range: write the factors",
    );
    says(
        "«max»(i in 0..3, i * x)",
        "`max` does not take a range\nhelp: only `sum` takes a range, as in `sum(i in 0..8, q[i])`",
    );
    for derivative in ["diff(x^2, x)", "grad(x)", "partial(x, t)"] {
        let name = derivative.split('(').next().unwrap_or_default();
        let help = "write `dot(a)` for a derivative with respect to time; the macro differentiates `L` with respect to coordinates, so that a potential `V`";
        says(&derivative.replacen(name, &format!("«{name}»"), 1), &format!("unknown function `{name}`\nhelp: {help}"));
    }
    for (function, help) in [
        ("randn", "random numbers are not supported: make the force an `input`, and set it between steps"),
        ("noise", "random numbers are not supported"),
        ("integral", "integrals are not supported: write the value as a formula"),
        ("erf", "special functions are not supported: write an approximation"),
        ("besselj", "special functions are not supported"),
        ("Re", "complex numbers are not supported"),
    ] {
        says(&format!("«{function}»()"), &format!("unknown function `{function}`\nhelp: {help}"));
    }
    let complex = "complex numbers are not supported: write the real and the imaginary part as two coordinates";
    says("exp(«im» * x)", &format!("unknown name `im`\nhelp: {complex}"));
    says("exp(«1i» * x)", &format!("the number `1` is followed directly by `i`\nhelp: {complex}"));
    says("exp(2 «i» * x)", &format!("an operator is missing between `2` and `i`\nhelp: {complex}"));
    says(
        "exp(«i» * x)",
        "unknown name `i`\nhelp: an index needs a range, as in `sum(i in 0..3, q[i])`; otherwise declare it with `param`, `const` or \
         `coord`; complex numbers are not supported",
    );
    let degrees = "angles are in radians: write `30 * pi / 180` for 30 degrees";
    says("x * sin(30 «deg»)", &format!("an operator is missing between `30` and `deg`\nhelp: {degrees}"));
    says("x * sin(«30deg»)", &format!("the number `30` is followed directly by `deg`\nhelp: {degrees}"));
    says("x * sin(30 * «degrees»)", &format!("unknown name `degrees`\nhelp: {degrees}"));
    let unit = "a number cannot have a unit\nhelp: remove the brackets; use one system of units";
    says("9.81 «[»m / s^2] * x", unit);
    clause("param a = 1.0 «[»kg];", unit);
    for comma in ["L = 0«,»5 * dot(x)^2;", "L = dot(x)^2 * (1 + 0«,»5);"] {
        case(
            &format!("coord x; {comma} discretize midpoint;"),
            "a decimal fraction uses a point, not a comma\nhelp: write `1.5`",
        );
    }
    case(
        &format!("{REST} check {{ x = 0, «5»; h = 1; }}"),
        "a decimal fraction uses a point, not a comma\nhelp: write `1.5`",
    );
    for name in ["H", "hamiltonian"] {
        case(
            &format!("coord q; «{name}» = p^2 / 2 + q^2 / 2; L = dot(q)^2; discretize midpoint;"),
            &format!(
                "unknown clause `{name}`\nhelp: write the Lagrangian, a function of coordinates and velocities: `L = "
            ),
        );
    }
    says(
        "«p»^2 / 2",
        "unknown name `p`\nhelp: declare it with `param`, `const` or `coord`; write a momentum in terms of",
    );
}

/// Users' attempts, each with its single message and the correction.
#[test]
fn each_mistake_has_its_correction() {
    let assert_help = |text: &str, wanted: &str| {
        let found = errors(&format!("struct System {{ {text} }}"));
        let messages: Vec<&str> = found.iter().map(|(_, message)| message.as_str()).collect();
        let [message] = messages[..] else { panic!("{text}: {messages:#?}") };
        let help = message.split_once("\nhelp: ").map_or("", |(_, help)| help);
        assert!(help.contains(wanted), "{text}\n{message}\nnot: {wanted}");
    };
    for (written, wanted) in [
        ("x.sin()", "`sin(…)`"),
        ("x.powi(2)", "`a^b`"),
        ("x**2", "`x^2`"),
        ("|x|", "`abs(x)`"),
        ("e^x", "`exp(x)`"),
        ("2 x", "`2 * x`"),
        ("2x", "`2 * x`"),
        ("m g", "`m * g`"),
        ("mg", "`m * g`"),
        ("m(x + 1)", "`m * (…)`"),
        ("x^1/2", "`a^(1/b)`"),
        ("xdot", "`dot(x)`"),
        ("x_dot", "`dot(x)`"),
        ("vx", "`dot(x)`"),
        ("v", "`dot(x)`"),
        ("dx", "`dot(x)`"),
        ("ẋ", "`dot(x)`"),
        ("d(x)", "`dot(a)`"),
        ("ddot(x)", "use positions, velocities, time and parameters"),
        ("sinx", "`sin(x)`"),
        ("sin x", "`sin(x)`"),
        ("log(x)", "`ln(a)`"),
        ("arctan(x)", "`atan(a)`"),
        ("interp(x, m, g)", "`table drag(v) = "),
        ("Piecewise(x, 0)", "`if a > b { x } else { y }`"),
        ("cot(x)", "`1 / tan(a)`"),
        ("asinh(x)", "`ln(a + sqrt(a^2 + 1))`"),
        ("π", "`pi`"),
        ("f64::consts::PI", "`pi`"),
        ("1.0f64 * x", "`1.0`"),
        ("1.e-3 * x", "`1.0e-3`"),
        ("x as f64", "remove `as`"),
        ("if x > 0 { x }", "`if a > b { x } else { y }`"),
        ("heaviside(x)", "`if a > 0 { 1 } else { 0 }`"),
        ("crate::aero::cl(x)", "`fn cl(a) = crate::aero::cl;`"),
        ("sum(i in 0..=3, i * x)", "`0..N + 1`"),
        ("lambda * x", "`constraint rod = x^2 + y^2 - l^2;`"),
        ("mm * x", "declare it with `param`, `const`, `coord`, or an earlier `let`"),
        ("gravity * x", "declare it with `param`, `const`, `coord`, or an earlier `let`"),
    ] {
        assert_help(
            &format!("param m = 1, g = 2; coord x; L = m * dot(x)^2 / 2 - g * x - {written}; discretize midpoint;"),
            wanted,
        );
    }
    for (written, wanted) in [
        ("param m: f64 = 1.0;", "`param m = 1.0;`"),
        ("param m;", "`m = 1.0`"),
        ("param m[2];", "`m = 1.0`"),
        ("param k = 4, w = sqrt(k);", "`let w = sqrt(k / m);`"),
        ("param g = 9.81 m/s^2;", "units are not supported"),
        ("coord y = 1;", "`coord x;`"),
        ("force = -x;", "`force x = …;`"),
        ("constraint x^2 = 1;", "`constraint rod = x^2 + y^2 - l^2;`"),
        ("T = dot(x)^2 / 2;", "`let T = …;`"),
        ("let a = 1", "every clause ends with `;`"),
        ("order = 4;", "of order 2 S with S stages"),
        ("h = 0.01;", "`system.at(t, q, v).integrate(FixedStep, h)`"),
    ] {
        assert_help(&format!("{written} {REST}"), wanted);
    }
    for rule in ["Gauss", "gauss(4)", "order = 4", "rk4"] {
        assert_help(&format!("coord x; L = dot(x)^2 / 2; discretize {rule};"), "of order 2 S with S stages");
    }
}

#[test]
fn a_missing_semicolon_is_reported_at_its_place() {
    for (body, after) in [
        ("coord «x» L = dot(x)^2; discretize midpoint;", "x"),
        ("coord x; L = dot(x)^«2» discretize midpoint;", "2"),
        ("const a = 1, b = «2» coord x; L = dot(x)^2; discretize midpoint;", "2"),
        ("coord x; let a = (1 + x«)» let b = 2; L = dot(x)^2; discretize midpoint;", "(…)"),
        ("coord x; let a = «1» L = dot(x)^2; discretize midpoint;", "1"),
        ("coord x; L = dot(x)^2; discretize «midpoint»", "midpoint"),
        ("coord x; L = dot(x)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h) * «1» }", "1"),
    ] {
        case(body, &format!("`;` is missing after `{after}`\nhelp: every clause ends with `;`"));
    }
    // The next clause is parsed.
    let found = errors("struct System { coord x L = 1 +; param a = 1 discretize some thing; }");
    let diagnostic: Vec<&str> = found.iter().map(|(_, message)| message.lines().next().unwrap_or_default()).collect();
    assert_eq!(
        diagnostic,
        [
            "`;` is missing after `x`",
            "expected a number, a name or `(`",
            "`;` is missing after `1`",
            "expected `,` or `;`"
        ]
    );
}

#[test]
fn a_comma_may_end_every_list() {
    let body = "const a = 1, b = 2,; param m = 1, k = 2,; coord x, q[3],; let c = a, e[i in 0..3] = q[i],; \
        L = m * dot(x)^2 + sum(i in 0..3, dot(q[i],)^2,) - k * hypot(x, e[0],); force x = b * c, q[0] = 1,; \
        discretize midpoint, trapezoidal,; check { x = 1, q[0] = 2,; h = 1, }";
    assert_eq!(errors(&format!("struct System {{ {body} }}")), []);
    let rule = "coord x; L = dot(x)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h,); }";
    assert_eq!(errors(&format!("struct System {{ {rule} }}")), []);
    case("param «,»; coord x; L = dot(x)^2; discretize midpoint;", "expected a name");
    case("coord x,«,» y; L = dot(x)^2; discretize midpoint;", "expected a name");
}

#[test]
fn arrays() {
    let system = |line: &str| {
        let rest = "L = sum(i in 0..N, dot(q[i])^2) + dot(x)^2; discretize midpoint;";
        format!("const N = 4; coord q[N], x; {line} {rest}")
    };
    case(
        "coord q[«0»]; L = 1; discretize midpoint;",
        "an array cannot have 0 coordinates\nhelp: a system has 1 to 256",
    );
    case("coord q[«1000»]; L = 1; discretize midpoint;", "an array cannot have 1000 coordinates");
    case("coord q[«1.5»]; L = 1; discretize midpoint;", "this must be a constant integer");
    case("coord q[«pi»]; L = 1; discretize midpoint;", "this must be a constant integer");
    case("coord q[«M»]; L = 1; discretize midpoint;", "unknown name `M`");
    case("coord q[2«,» 2]; L = 1; discretize midpoint;", "an index is one number\nhelp: write each index in brackets");
    case(&system("let e[i in 0..N] = q[«i» + 1] - q[i];"), "`q[4]` is out of range 0..4\nhelp: the indices are 0 to 3");
    case(&system("let e[i in 1..N] = q[i]; let d = e[«0»];"), "`e[0]` is out of range 1..4");
    case(&system("let e = q[«-»1];"), "`q[-1]` is out of range 0..4");
    case(&system("let e = q[«x»];"), "this must be a constant integer");
    case(&system("let e = «x»[0];"), "`x` is not an array");
    case(&system("let e = «N»[0];"), "`N` is not an array");
    case(&system("let e = dot(«x»[0]);"), "`x` is not an array");
    case(&system("let e = «p»[0];"), "unknown name `p`");
    case(&system("let e[i in 3..«1»] = 1;"), "the range 3..1 ends before it begins");
    case(&system("let e = sum(i in 0..«1»/2, i);"), "this must be a constant integer");
    case(&system("let e = sum(«x» in 0..2, 1);"), "the name `x` is declared twice");
    case(&system("let e = sum(i in 0..2, sum(«i» in 0..2, 1));"), "the name `i` is declared twice");
    case(&system("let e = sum(i in 0..2, i) + «i»;"), "unknown name `i`");
    case(&system("let e = sum(«0»..2, i);"), "expected a range");
    case(&system("let e = sum(i in 0«.».=2, i);"), "a range excludes its end\nhelp: write `0..N + 1`");
    case(&system("let e = sum(i in 0«,» 2, i);"), "expected `..` and the end");
    case(&system("let e = sum(i in 0..2 «i»);"), "expected `,` and what is summed");
    case(&system("let e = «sum»;"), "`sum` is a function");
    case(&system("let e = sum(i in 0..1000000000, «1»);"), "the expanded system has more than 85000 terms");
    case(
        &system("let e[i in 5..6] = 0; let g = e[«-»9223372036854775807];"),
        "`e[-9223372036854775807]` is out of range 5..6",
    );
    case(
        &system("let e[i in 3..3] = 0; let g = e[«3»];"),
        "`e[3]` is out of range 3..3\nhelp: this array has no entries",
    );
    case(&system("force q = «1»;"), "a vector of 4 is needed here, not a number\nhelp: write a list, as in");
    case(&system("force «x»[0] = 1;"), "`x` is not an array");
    case(&system("force q[«4»] = 1;"), "`q[4]` is out of range 0..4");
    case(&system("force q[i in 0..«5»] = 1;"), "`q[4]` is out of range 0..4");
    case(&system("force q[0] = 1; force «q»[i in 0..2] = 1;"), "a second force on `q`");
}

#[test]
fn arrays_of_parameters() {
    let system = |parameters: &str| {
        let lagrangian = "L = m[0] * dot(x)^2 / 2 - m[1] * x^2";
        format!("const N = 2; {parameters}; coord x; {lagrangian}; discretize midpoint;")
    };
    for right in [
        "param m[2] = 1.0",
        "param m[N] = [1, N^2]",
        "param a = 2, m[2] = [1, 2,],; let b = a; dissipation = b * dot(x)^2",
        // Unused entries, as in an adjacency matrix.
        "param m[3] = 1",
        "param m[2] = 1, a[9] = 0; let springs = sum(i in 0..3, a[3 * i] * x^2); force x = -springs",
    ] {
        assert_eq!(errors(&format!("struct System {{ {} }}", system(right))), [], "{right}");
    }
    case(
        &system("param m[2] = [1, 2, «3», 4]"),
        "`m` has length 2 but a list of 4 values\nhelp: write 2 values, or one for all entries: `= 1.0`",
    );
    case(&system("param m[«N»] = [1]"), "`m` has length 2 but a list of 1");
    case(&system("param m[«2»] = []"), "`m` has length 2 but a list of 0");
    case(
        &system("param «m» = [1, 2]"),
        "`m` is not an array but has a list of values\nhelp: write its length: `param m[2] = […];`",
    );
    case(
        &system("param m[«0»] = 1"),
        "an array cannot have 0 parameters\nhelp: an array of parameters has 1 to 256 entries",
    );
    case(&system("param m[«257»] = 1"), "an array cannot have 257 parameters");
    case(&system("param m[«1.5»] = 1"), "this must be a constant integer");
    case(&system("param m[«x»] = 1"), "`x` is a coordinate: it has no value");
    case(&system("param m[«i» in 0..2] = 1"), "expected a length, as in `q[8]`");
    case(&system("param m[2«,» 2] = 1"), "an index is one number");
    case(&system("param m[2] = [1 «2»]"), "a `,` is missing between two entries\nhelp: write a vector as `[a, b, c]`");
    case(&system("param m[2] = [[1, 2«;» 3, 4]]"), "`;` does not separate rows\nhelp: write a vector as `[a, b, c]`");
    case(&system("param m[2] = [1, «x»]"), "`x` is a coordinate: it has no value");
    case(&system("param m[2] = [1, «exp»(1000)]"), "the value of `m` is not finite");
    case(&system("param «m»[2]"), "`m` has no value\nhelp: write `m = 1.0`");
    case(&system("param m[2] = 1, «m» = 2"), "the name `m` is declared twice");
    case(&system("param m[2] = 1, «k»[4] = 1"), "the parameter `k` is never used");
    case(&system("param m[2] = 1; let a = m[«2»]"), "`m[2]` is out of range 0..2\nhelp: the indices are 0 to 1");
    case(
        &system("param m[2] = 1; force x = «m»"),
        "a number is needed here, not a vector of 2\nhelp: write one entry, `m[0]`",
    );
    case(&system("param m[2] = 1; let a = dot(«m»[0])"), "`dot(m)`: `m` does not change with time");
    case(&system("param m[2] = 1; const a = «m»[0]"), "`m` is a parameter: it has no value");
    case(&system("param m[2] = 1; force «m»[0] = 1"), "`m` has a force but is not a coordinate");
    // A wrong array is reported once, for any use of it.
    case(&system("param m[«3»] = [1, 2]; let a = sum(i in 0..9, m[i])"), "`m` has length 3");
}

#[test]
fn dissipation() {
    let system = |line: &str| format!("coord x; L = dot(x)^2; {line} discretize midpoint;");
    case(&system("dissipation = dot(x)^2; «dissipation» = dot(x)^2;"), "a second `dissipation`");
    case(&system("«dissipation» = x^2;"), "`dissipation` does not depend on any velocity");
}

/// A power of known sign.
#[test]
fn dissipation_takes_energy() {
    let system = |rayleigh: &str| {
        format!(
            "param c = 0.3, w = 2, K[4] = [2, 1, 1, 2], e = 1e-3, d = -1; coord x, y; let v[i in 0..2] = dot(x) * (1 - i) + dot(y) * i; \
             let drag = c * w * dot(x); L = (1 + c^2 + w^2 + e^2 + d^2 + K[0]) * (dot(x)^2 + dot(y)^2); dissipation = {rayleigh}; discretize midpoint;"
        )
    };
    for linear in [
        "«c» * dot(x)",
        "«-»c * dot(x)",
        "c * dot(x)^2 / 2 + «w» * dot(y)",
        "c * dot(x)^2 - «sin»(t) * dot(x)",
        "dot(y)^2 + «drag»",
        "«c» * (dot(x) - dot(y))",
        "«x» * dot(x)",
    ] {
        case(
            &system(linear),
            "a term of `dissipation` is linear in velocities: its force is constant\nhelp: write `c * dot(x)^2 / 2` for viscous",
        );
    }
    for feeding in [
        "«-»c * dot(x)^2 / 2",
        "dot(y)^2 - «c» * dot(x)^2 / 2",
        "«d» * dot(x)^2",
        "«-»1 * (dot(x)^2 + dot(y)^2)",
        "«-»abs(dot(x))^3",
        "«-»sqrt(dot(x)^2 + e^2)",
        "«-»exp(x) * dot(x)^4 + c * dot(y)^2",
        "«-»(dot(x) * dot(y))^2",
        "«-»sum(i in 0..2, v[i]^2)",
    ] {
        case(&system(feeding), "`dissipation` adds energy: its power `-v * ∂R/∂v` is positive\nhelp: reverse its sign");
    }
    for right in [
        "c * dot(x)^2 / 2",
        "-d * dot(x)^2",
        "c * (dot(x) - dot(y))^2 / 2",
        // Relative to a belt, to a changing wind.
        "c * (dot(x) - w)^2 / 2",
        "c * (dot(x) - w * sin(t))^4",
        "sum(i in 0..2, sum(j in 0..2, K[2 * i + j] * v[i] * v[j])) / 2",
        "c * abs(dot(x)) + abs(dot(y))^3",
        "c * sqrt(dot(x)^2 + e^2)",
        "c * sqrt(dot(x)^2)",
        "c * (dot(x)^2 + dot(y)^2)^(3/4)",
        "c * e * ln(cosh(dot(x) / e))",
        // Van der Pol's function, and others that both add and dissipate energy.
        "c * (x^2 - 1) * dot(x)^2 / 2",
        "c * (1 - x^2) * dot(x)^2 / 2",
        "sin(t) * dot(x)^2",
        "-cos(t) * dot(x)^2",
        "(x^2 - 1e4) * dot(x)^2",
        "c * dot(x) * dot(y)",
        "c * dot(x)^4 - w * dot(x)^2",
        "0 * c * dot(x) + dot(y)^2",
        "c * x^2 * dot(x)^2 / (1 + x^2)",
    ] {
        assert_eq!(errors(&format!("struct System {{ {} }}", system(right))), [], "{right}");
    }
}

#[test]
fn rules() {
    let system = |rule: &str| format!("coord x; L = dot(x)^2 / 2; force x = -x; discretize {{ {rule} }}");
    let ld = "Ld = h * L(t0, q0, (q1 - q0)/h);";
    let forces = "fd_minus = h * f(t0, q0, (q1 - q0)/h); fd_plus = 0 * q0; gd_minus = 0;";
    case(&system(&format!("{ld} {forces} gd_plus = 0; «gd» = 0;")), "a rule has no line `gd`");
    case(&system(&format!("{ld} {forces} gd_plus = 0; «Ld» = h;")), "a second `Ld` in the rule");
    case(&system(&format!("{ld} {forces} gd_plus = «q0»;")), "a number is needed here");
    case(&system(&format!("{ld} {forces} gd_plus = t0 + «q0»;")), "a number and a vector of 1 cannot be added");
    case(&system(&format!("{ld} {forces} gd_plus = «q2»;")), "unknown name `q2`\nhelp: did you mean `q0`?");
    case(&system(&format!("{ld} {forces} gd_plus = «sine»(h);")), "unknown function `sine`\nhelp: did you mean `sin`?");
    case(&system(&format!("{ld} {forces} gd_plus = «dot»(q0);")), "unknown function `dot`");
    case(&system(&format!("{ld} {forces} gd_plus = sin(«q0»);")), "`sin` takes numbers, not a vector of 1");
    case(&system(&format!("{ld} {forces} gd_plus = «x»;")), "a rule cannot depend on `x`\nhelp: a rule can use t0,");
    case(&system(&format!("{ld} {forces} gd_plus = «L»;")), "`L` is a function\nhelp: write its argument");
    case(&system(&format!("{ld} {forces} gd_plus = «h»[0];")), "`h` is not an array");
    case(&system(&format!("{ld} {forces} gd_plus = q0[«1»];")), "`q0[1]` is out of range 0..1");
    case(&system(&format!("{ld} {forces} gd_plus = «sum»(i in 0..2, i * q0);")), "a number is needed here");
    case(&system(&format!("{ld} {forces} gd_plus = sum(«q0» in 0..2, 1);")), "the name `q0` is declared twice");
    case(
        &system(&format!("{ld} {forces} gd_plus = «L»(t0, q0, h * f(t0, q0, q1));")),
        "`L` or `f` in an argument of `L` or `f`",
    );
    case(
        &system(&format!("{ld} {forces} gd_plus = «L»(t0, q0);")),
        "`L` takes 3 arguments, not 2\nhelp: write `L(t0, q0, (q1 - q0)/h)`",
    );
    case(&system(&format!("{ld} {forces} gd_plus = L(«q0», q0, q1);")), "a number is needed here");
    case(&system(&format!("{ld} {forces} gd_plus = L(t0, «t0», q1);")), "a vector is needed here");
    case(&system(&format!("{ld} {forces} gd_plus = h / «q0»;")), "a number is needed here");
    case(&system(&format!("{ld} {forces} gd_plus = h^«q0»;")), "a number is needed here");
    let rule = |ld: &str| format!("coord x; L = dot(x)^2 / 2 - x^2; discretize {{ {ld} }}");
    case(&rule("«Ld» = h * L(t0, q0, q0/h);"), "`Ld` does not depend on `q1`");
    case(&rule("«Ld» = h * L(t0, q1, q1/h);"), "`Ld` does not depend on `q0`");
    case(&rule("«Ld» = L(t0, q0, q1 - q0);"), "`Ld` does not depend on `t0`");
    let missing = errors(&format!("struct System {{ {} }}", system(&format!("{ld} {forces}"))));
    assert_eq!(missing.len(), 1, "{missing:?}");
    assert!(missing[0].1.starts_with("the rule has no line `gd_plus`\nhelp: the system has a force"), "{missing:?}");
    // The work of the force follows from the use of `L` in `Ld`: none.
    // A wrong `Ld` says nothing about the others.
    for (wrong, diagnostic) in
        [("Ld = «y» * L(t0, q0, q1);", "unknown name `y`"), ("Ld = «q0»;", "a number is needed here")]
    {
        case(&system(wrong), diagnostic);
    }
    let missing = errors(&format!("struct System {{ {} }}", system("Ld = (q1 - q0) * (q1 - q0) / (2 * h);")));
    assert_eq!(missing.len(), 4, "{missing:?}");
}

#[test]
fn checks() {
    let system = |check: &str| {
        let rest = "L = sum(i in 0..3, dot(q[i])^2) + a * dot(x)^2; discretize midpoint;";
        format!("const N = 3; param a = 1; coord x, q[N]; {rest} {check}")
    };
    case(&system("check { h = 1; } «check» { h = 1; }"), "a second `check`\nhelp: write `check` once");
    case(&system("«check» { x = 1; }"), "the check has no step\nhelp: end it with the step, as in `h = 0.01;`");
    case(&system("«check» { }"), "the check has no step");
    case(&system("check { h = «0»; }"), "the step `h` is not positive\nhelp: write a positive step");
    case(&system("check { h = «-»1; }"), "the step `h` is not positive");
    case(
        "coord angle; L = dot(angle)^2; discretize midpoint; check { «angel» = 1; h = 1; }",
        "`angel` is neither a coordinate nor a parameter\nhelp: did you mean `angle`?",
    );
    let other = "is neither a coordinate nor a parameter\nhelp: a check sets coordinates, their `dot(…)`, parameters,";
    for name in ["mass", "N", "half"] {
        case(&system(&format!("let half = a / 2; check {{ «{name}» = 1; h = 1; }}")), &format!("`{name}` {other}"));
    }
    case(&system("check { «h» = 2; h = 1; }"), &format!("`h` {other}"));
    case(&system("check { dot(«a») = 1; h = 1; }"), "`dot(a)`: `a` is not a coordinate");
    case(&system("check { «sin»(x) = 1; h = 1; }"), "expected a coordinate, `dot(…)`, a parameter, `t` or `h`");
    case(&system("check { dot(x «x») = 1; h = 1; }"), "expected `)`");
    case(&system("check { x = 1, «x» = 2; h = 1; }"), "`x` is given twice\nhelp: set each coordinate, velocity");
    case(&system("check { dot(x) = 1; dot(«x») = 2; h = 1; }"), "`x` is given twice");
    case(&system("check { t = 1; «t» = 2; h = 1; }"), "`t` is given twice");
    case(&system("check { q[i in 0..N] = i; «q»[0] = 1; h = 1; }"), "`q` is given twice");
    case(&system("check { q = «1»; h = 1; }"), "a vector of 3 is needed here, not a number");
    case(&system("check { dot(«x»[0]) = 1; h = 1; }"), "`x` is not an array");
    case(&system("check { dot(q[i in 0..«4»]) = 1; h = 1; }"), "`q[3]` is out of range 0..3");
    case(&system("check { x = «a»; h = 1; }"), "the value of `x` is not a constant\nhelp: use numbers");
    case(&system("check { x = «exp»(1000); h = 1; }"), "the value of `x` is not finite");
    case(&system("check { x = 1 / «0»; h = 1; }"), "division by zero");
    case(&system("check { h = «x»; }"), "the value of `h` is not a constant");
    case(&system("check { x = 1 «dot»(x) = 2; h = 1; }"), "an operator is missing between `1` and `dot(…)`");
    case(&system("check { x = «1» y = 2; h = 1; }"), "`;` is missing after `1`");
    case(&system("check { x = 1 «{»} h = 1; }"), "expected an operator, `,` or `;`");
    case(&system("check «;»"), "expected `{` and a place");
    let two = errors(&format!("struct System {{ {} }}", system("check { y = 1; z = 2; }")));
    let diagnostic: Vec<&str> = two.iter().map(|(_, message)| message.lines().next().unwrap_or_default()).collect();
    let nor = |name: &str| format!("`{name}` is neither a coordinate nor a parameter");
    assert_eq!(diagnostic, ["the check has no step".to_owned(), nor("y"), nor("z")]);
}

/// Parameters beside coordinates.
#[test]
fn parameters_of_a_check() {
    let system = |check: &str| {
        let parameters = "param mass = 1, h = 2, k[3] = 0";
        let lagrangian = "L = mass * dot(x)^2 - h * sum(i in 0..3, k[i]) * x^2";
        format!("{parameters}; coord x; {lagrangian}; discretize midpoint; check {{ {check} }}")
    };
    for right in [
        "mass = 2, x = 1; h = 1;",
        "h = 3; h = 1;",
        "k[0] = 1, k[i in 1..3] = i; h = 1;",
        "mass = -1; dot(x) = 1; t = 2; h = 1;",
    ] {
        assert_eq!(errors(&format!("struct System {{ {} }}", system(right))), [], "{right}");
    }
    case(&system("«mas» = 1; h = 1;"), "`mas` is neither a coordinate nor a parameter\nhelp: did you mean `mass`?");
    case(
        &system("mass = 1, «mass» = 1; h = 1;"),
        "`mass` is given twice\nhelp: set each coordinate, velocity and param",
    );
    case(&system("k[1] = 1, «k»[i in 0..3] = i; h = 1;"), "`k` is given twice");
    case(&system("k = «1»; h = 1;"), "a vector of 3 is needed here, not a number\nhelp: write a list");
    case(&system("«mass»[0] = 1; h = 1;"), "`mass` is not an array");
    case(&system("k[«3»] = 1; h = 1;"), "`k[3]` is out of range 0..3\nhelp: the indices are 0 to 2");
    case(&system("k[i in 0..«4»] = 1; h = 1;"), "`k[3]` is out of range 0..3");
    case(&system("dot(«mass») = 1; h = 1;"), "`dot(mass)`: `mass` is not a coordinate");
    case(&system("mass = «h»; h = 1;"), "the value of `mass` is not a constant");
    case(&system("mass = «exp»(1000); h = 1;"), "the value of `mass` is not finite");
}

#[test]
fn several_mistakes_are_reported_at_once() {
    let found = errors("struct System { parm a = 1; coord x L = 1; force y 2; }");
    assert_eq!(found.len(), 3, "{found:?}");
    let found = errors("struct System { param t = 1; coord x; L = a * dot(b)^2; force y = c; discretize some; }");
    let diagnostic: Vec<&str> = found.iter().map(|(_, message)| message.lines().next().unwrap_or_default()).collect();
    let wanted = [
        "the name `t` is reserved",
        "unknown name `a`",
        "unknown name `b`",
        "unknown name `c`",
        "`y` has a force but is not a coordinate",
        "unknown rule `some`",
    ];
    assert_eq!(diagnostic, wanted);
}

#[test]
fn every_unknown_name_of_an_expression_is_reported() {
    let text = "struct System { param mass = 1; coord x; L = mas * dot(y)^2 - k * hypot(x, l[m]) / mas + sum(i in 0..n, i * z); \
        force x = a + sin(b)^c - dot(d * x); discretize { Ld = h * L(e, q0, (q1 - u)/h); } check { x = y2 + w; h = 1; } }";
    let found = errors(text);
    let tokens: Vec<&str> = found.iter().map(|(token, _)| token.as_str()).collect();
    assert_eq!(tokens, ["mas", "y", "k", "l", "m", "n", "a", "b", "c", "d", "e", "u", "y2", "w"]);
    for (token, message) in &found {
        let help = if token == "mas" { "did you mean `mass`?" } else { "declare it with" };
        assert!(message.starts_with(&format!("unknown name `{token}`\nhelp: ")), "{message}");
        assert!(token != "mas" || message.ends_with(help), "{message}");
    }
    // In a sum, those of its first term, once.
    case("coord x; L = sum(i in 0..5, i * «y» * dot(x)^2); discretize midpoint;", "unknown name `y`");
}

#[test]
fn uses_of_a_wrong_declaration_report_nothing() {
    let rest = "L = sum(i in 0..4, dot(q[i])^2 + e[i] * q[i]) + a * dot(q[0]); force q[0] = e; discretize midpoint;";
    case(
        &format!("const a = 1; coord q[4]; let e[i in 0..4] = q[«i» + 1]; {}", rest.replace("= e;", "= e[1];")),
        "`q[4]` is out",
    );
    case(&format!("const a = 1; coord q[4]; let e[0] = «b»; {rest}"), "unknown name `b`");
    case(
        &format!("const a = 1; coord q[«0»]; let e = q; {}", rest.replace("e[i]", "dot(q)")),
        "an array cannot have 0 coordinates",
    );
    case(&format!("const a = 1; coord q[«b»]; let e = q[1]; {}", rest.replace("e[i]", "e")), "unknown name `b`");
    case(
        &format!("const a = «ln»(0); coord q[4]; let e[i in 0..4] = a; {}", rest.replace("= e;", "= a;")),
        "this expression has no value",
    );
}

#[test]
fn text_around_a_system() {
    let diagnostic = |text: &str| errors(text).into_iter().map(|(_, message)| message).collect::<Vec<_>>().join("; ");
    assert!(diagnostic("").starts_with("expected `struct Name { … }`"), "{}", diagnostic(""));
    assert!(diagnostic("enum A {}").starts_with("expected `struct Name { … }`"));
    assert!(diagnostic("struct A;").starts_with("expected `{` and the clauses"));
    assert!(diagnostic(&format!("struct A {{ {REST} }} struct B;")).starts_with("unexpected text after the system"));
}

#[test]
fn depth_and_size_are_bounded() {
    let nested = format!("coord x; L = dot(x)^2 + {}x{}; discretize midpoint;", "(".repeat(150), ")".repeat(150));
    let found = errors(&format!("struct System {{ {nested} }}"));
    assert!(found[0].1.starts_with("this expression is nested deeper than 100 levels"), "{found:?}");
    let minus = format!("struct System {{ coord x; L = dot(x)^2 + {}x; discretize midpoint; }}", "-".repeat(150));
    assert!(errors(&minus)[0].1.starts_with("this expression is nested deeper"));
    // A sum of many terms is one level deep, and lets may refer to one another.
    let long = format!("struct System {{ coord x; L = dot(x)^2{}; discretize midpoint; }}", " + x".repeat(5000));
    assert_eq!(errors(&long), []);
    let lets = (1..2000).map(|i| format!("let a{i} = sin(a{}) + x;", i - 1)).collect::<Vec<_>>().concat();
    let chain = format!("struct System {{ coord x; let a0 = x; {lets} L = dot(x)^2 + a1999; discretize midpoint; }}");
    let found = errors(&chain);
    assert!(found.is_empty() || found[0].1.starts_with("the expanded system has more than"), "{:?}", found[0]);
}

#[test]
fn only_the_first_messages_are_shown() {
    for count in [31, 4000, 20_000] {
        let names = |prefix: &'static str| (0..count).map(move |i| format!("{prefix}{i}"));
        let unused = names("a").map(|name| format!("{name} = 1")).collect::<Vec<_>>().join(", ");
        let unknown = names("b").collect::<Vec<_>>().join(" + ");
        let clauses = names("c").map(|name| format!("{name} 1;")).collect::<Vec<_>>().concat();
        for body in [
            format!("param {unused}; {REST}"),
            format!("coord x; L = dot(x)^2 + {unknown}; discretize midpoint;"),
            format!("{REST} {clauses}"),
        ] {
            let found = errors(&format!("struct System {{ {body} }}"));
            let (_, last) = &found[found.len() - 1];
            if count == 31 {
                assert_eq!(found.len(), 31);
                assert!(!last.contains("more mistakes"), "{last}");
                continue;
            }
            let wanted = format!("{} more mistakes are not shown\nhelp: correct those above", count - 30);
            assert!(found.len() == 31 && last.starts_with(&wanted), "{} messages, at last {last}", found.len());
        }
    }
}

#[test]
fn delimiters_around_a_clause_are_bounded_too() {
    for (open, close) in [("(", ")"), ("[", "]"), ("{", "}")] {
        let nest = format!("{}{}", open.repeat(5000), close.repeat(5000));
        for system in [format!("#[doc = {nest}] struct S {{}}"), nest.clone(), format!("struct S {{ coord x{nest}; }}")]
        {
            let found = errors(&system);
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(found[0].1.starts_with("this expression is nested deeper than 100 levels"), "{found:?}");
        }
    }
}

#[test]
fn names_and_attributes_of_a_struct() {
    let diagnostic = |text: &str| errors(text);
    for name in ["T", "W", "f64", "bool", "str", "usize"] {
        let found = diagnostic(&format!("struct {name} {{ {REST} }}"));
        let wanted = format!("the name `{name}` is reserved\nhelp: generated code uses this type; choose another name");
        assert_eq!(found, [(name.to_owned(), wanted)]);
    }
    // Reserved words of one edition or another.
    assert!(diagnostic(&format!("struct gen {{ {REST} }}"))[0].1.starts_with("the name `gen` is reserved"));
    assert!(diagnostic(&format!("struct r#match {{ {REST} }}"))[0].1.starts_with("the name `r#match` is reserved"));
    for word in ["type", "async", "dyn", "_"] {
        let text = format!("param «{word}» = 1.0; coord x; L = dot(x)^2; discretize midpoint;");
        case(&text, &format!("the name `{word}` is reserved\nhelp: choose another name"));
    }
    case("coord «gen»; L = dot(gen)^2; discretize midpoint;", "the name `gen` is reserved\nhelp: choose another name");
    case(&format!("param «r#gen» = 1; {REST}"), "the name `r#gen` is reserved");

    for derived in ["Clone", "Copy", "Debug", "Default", "PartialEq"] {
        let found = diagnostic(&format!("#[derive(PartialOrd, core::any::{derived})] struct System {{ {REST} }}"));
        let wanted =
            format!("every system implements `{derived}`\nhelp: remove `{derived}`; other traits may be derived");
        assert_eq!(found, [(derived.to_owned(), wanted)]);
    }
    for attributes in
        ["#[derive(PartialOrd, Eq)] #[derive(Hash)]", "#[cfg(test)] #[allow(x)] #[doc = \"x\"]", "/// x\n"]
    {
        assert_eq!(
            diagnostic(&format!(
                "{attributes} struct System {{ #[doc(alias = \"a\")] #[allow(b)] param a = 1; coord x; L = a * dot(x)^2; discretize midpoint; }}"
            )),
            []
        );
    }
}

#[test]
fn attributes_of_clauses() {
    for clause in
        ["const a = 1;", "coord y;", "let a = 1;", "force x = 1;", "dissipation = dot(x)^2;", "check { h = 1; }"]
    {
        case(
            &format!("«#»[cfg(test)] {clause} {REST}"),
            "this attribute has no meaning here\nhelp: write doc comments before a clause",
        );
        case(&format!("/// Words.\n «#»[allow(x)] {clause} {REST}"), "this attribute has no meaning here");
    }
    for attribute in ["cfg(test)", "cfg_attr(test, doc = \"\")", "derive(Clone)"] {
        case(&format!("«#»[{attribute}] param a = 1; {REST}"), "this attribute has no meaning here");
    }
    assert_eq!(
        errors(&format!("struct System {{ /// Words.\n coord y; {} }}", REST.replace("L =", "L = dot(y)^2 +"))),
        []
    );
}

/// A system that is configured out needs no meaning; its expansion is absent too.
#[test]
fn conditions_hold_for_all_items() {
    for body in [
        REST,
        "coord x; L = y; discretize midpoint;",
        "nonsense",
        "coord x; L = dot(x)^2; discretize midpoint; check { h = 1; }",
    ] {
        let tokens = format!("#[cfg(a)] #[derive(Eq)] #[cfg(b)] struct System {{ {body} }}").parse().expect("tokens");
        let file: syn::File = syn::parse2(vi_codegen::expand(tokens)).expect("Rust");
        assert!(file.items.len() >= 2);
        for item in file.items {
            let attributes = match item {
                syn::Item::Struct(item) => item.attrs,
                syn::Item::Const(item) => item.attrs,
                syn::Item::Mod(item) => item.attrs,
                _ => panic!("another item of {body}"),
            };
            assert!(attributes.iter().filter(|attribute| attribute.path().is_ident("cfg")).count() >= 2, "{body}");
        }
    }
}

#[test]
fn tokens_names_and_coordinates_are_bounded() {
    let long = format!("«{}»", "x".repeat(201));
    case(&format!("coord {long}; L = 1; discretize midpoint;"), "this name is longer than 200 letters\nhelp: choose");
    case(&format!("coord x; L = dot(x)^2 * {long}; discretize midpoint;"), "this name is longer than 200 letters");
    let many = format!("struct System {{ coord x; L = dot(x)^2{}; discretize midpoint; }}", " + x".repeat(100_000));
    let found = errors(&many);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].1.starts_with("the system is longer than 200000 tokens\nhelp: write repeated terms"), "{found:?}");
    let names = |count: usize| (0..count).map(|i| format!("x{i}")).collect::<Vec<_>>();
    let squares = names(300).iter().map(|name| format!("dot({name})^2")).collect::<Vec<_>>().join(" + ");
    let coordinates = names(300).join(", ").replace("x256", "«x256»");
    case(
        &format!("coord {coordinates}; L = {squares}; discretize midpoint;"),
        "the system has more than 256 coordinates\nhelp: use fewer coordinates",
    );
}

#[test]
fn numbers_of_any_length_are_read() {
    let rest = "coord x; discretize midpoint; L = dot(x)^2 +";
    for number in ["1".repeat(100_000), format!("0x{}", "f".repeat(100_000)), format!("1{}", "_".repeat(100_000))] {
        let found = errors(&format!("struct System {{ {rest} {number} * x; }}"));
        assert_eq!(found.len(), 1);
        let wanted = if number.starts_with("0x") { "not a decimal number" } else { "this number is outside the range" };
        assert!(found[0].1.starts_with(wanted), "{}", found[0].1);
    }
    for number in ["1e999999999", "1e-999999999", "1e99999999999999999999999", "1e-310", "1e309"] {
        case(&format!("{rest} «{number}» * x;"), "this number is outside the range of double precision");
    }
    case(&format!("{rest} «1_000kg» * x;"), "the number `1000` is followed directly by `kg`");
    case(&format!("{rest} «1.5e3kg» * x;"), "the number `1.5e3` is followed directly by `kg`");
    case(&format!("{rest} «0b11» * x;"), "not a decimal number\nhelp: write integers and decimals");
    case(&format!("{rest} «'c'» * x;"), "not a decimal number");
    assert_eq!(errors(&format!("struct System {{ {rest} 1_0.5_0e-1_0 * x^2; }}")), []);
}

#[test]
fn coefficients_are_numbers() {
    let tokens = "struct System { coord x; L = dot(x)^1e308; discretize midpoint; }".parse().expect("tokens");
    let diagnostic = vi_codegen::expand(tokens).to_string();
    assert!(
        diagnostic.contains("the equations have a coefficient outside the range of double precision"),
        "{diagnostic}"
    );
}

/// Numbers of many digits are short in messages and in documentation.
#[test]
fn long_numbers_are_short_in_words() {
    case(
        "coord x; L = dot(x)^2 * dot(«1e150»); discretize midpoint;",
        "`dot(1e150)`: `1e150` does not change with time",
    );
    let text = "struct System { param k = 1e150, c = 0.1e-200; coord x; L = dot(x)^2 - k * 1e150 * x^2 - c * x^4; discretize midpoint; }";
    let diagnostic = vi_codegen::expand(text.parse().expect("tokens")).to_string();
    let words: Vec<&str> = diagnostic.split('"').skip(1).step_by(2).collect();
    for part in ["Parameter `k`, 1e150 by default.", "Parameter `c`, 1e-201 by default.", "1e150*k*x^2"] {
        assert!(words.iter().any(|text| text.contains(part)), "{part}: {words:?}");
    }
    assert!(!words.iter().any(|text| text.contains(&"0".repeat(20))), "{words:?}");
}

#[test]
fn right_systems_pass() {
    for body in [
        "coord q; L = dot(q)^2 / 2 - q^4 / 4; discretize midpoint;",
        "const g = 9.81, twice = 2 * g; param l = 1 / twice; coord θ, φ; L = l * (dot(θ)^2 + dot(φ)^2) - cos(θ); discretize midpoint;",
        "coord h, v, p, real, node, s1, T; L = dot(h)^2 + dot(v)^2 + dot(p)^2 + dot(real)^2 + dot(node)^2 + dot(s1)^2 + dot(T)^2 - h * v * p * real * node * s1 * T; discretize midpoint;",
        "coord x, y; L = dot(x) * dot(y) - x * y; force y = t * dot(x); discretize midpoint;",
        "coord x; L = dot(x)^2 - x^2; force x = t; discretize trapezoidal;",
        "const N = 5; coord θ[N]; let x[i in 0..N] = sum(j in 0..i + 1, dot(θ[j]) * cos(θ[j])); L = sum(i in 0..N, x[i]^2 + dot(θ[i])^2); dissipation = sum(i in 0..N, i * dot(θ[i])^2); force θ[0] = cos(t); discretize midpoint;",
        "coord q[3]; L = sum(i in 0..3, dot(q[i])^2) - sum(i in 3..3, q[i]); force q[i in 1..3] = -q[i - 1]; discretize trapezoidal;",
        "coord x; L = dot(x)^2 / 2; force x = -x; discretize { Ld = h * L(t0, q0, (q1 - q0)/h); }",
        "param θ = 0.5; const h = 3; coord x; L = dot(x)^2 / 2 - x^2; discretize { Ld = h * L(t0 + θ * h, q0 + θ * (q1 - q0), (q1 - q0)/h); }",
        "coord x; let w[i in 0..3] = 1 + 3 * i - i * i; L = dot(x)^2 / 2 - x^2; force x = t; discretize { Ld = h/6 * sum(i in 0..3, (w[i] + i * (2 - i)) * L(t0 + i * h/2, q0 + i * (q1 - q0)/2, (q1 - q0)/h)); }",
        "coord x, y; L = dot(x)^2 + dot(y)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h) - h * sqrt(1 + q0[0]^2) * cos(q1[1] / pi); }",
        "coord h, x; L = dot(h)^2 + dot(x)^2 - h * x; discretize midpoint; check { h = 2, dot(h) = 1; h = 0.01; }",
        "const g = 2; coord x, q[2]; L = dot(x)^2 + sum(i in 0..2, dot(q[i])^2); discretize midpoint; check { x = sqrt(g) * pi, q[i in 0..2] = i, dot(q[i in 0..2]) = -i; t = 1; h = 1e-2 };",
    ] {
        assert_eq!(errors(&format!("struct System {{ {body} }}")), [], "{body}");
    }
}

/// What users of other tools type, and the words of the answer.
#[test]
fn notations_of_other_tools_are_answered() {
    let plane = |clause: &str| format!("coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - y; {clause}");
    let turned = |clause: &str| format!("rotation R; let w = rate(R); {clause}");
    for (body, token, words) in [
        (plane("constraint loop = x^2 + y^2 - 1;"), "loop", "the name `loop` is reserved"),
        ("coord x; L = dot(x)^2 / 2 - where(x > 0, x^2, 0);".to_owned(), "where", "help: write `if a > b { x }"),
        (plane("constraint rod: x^2 + y^2 == 1;"), ":", "help: write `constraint rod = x^2 + y^2 - l^2;`"),
        (plane("constraint floor = y; force x = -abs(floor);"), "floor", "its reaction is known after a step only"),
        (turned("let z = R * [0, 0, 1]; L = w * w / 2 - z[2];"), "[", "help: write `turn(R, v)`"),
        (turned("L = w * w / 2; force R = [0, 0, 1];"), "R", "help: write `torque R = [a, b, c];`"),
        (turned("L = w * w / 2 - pitch(R);"), "pitch", "`rate(R)` is the angular velocity"),
        (plane("equation x^2 + y^2 = 1;"), "equation", "help: write `constraint rod = x^2 + y^2 - l^2;`"),
        ("coord x; let V = if x > 0 then x^2 else 0; L = dot(x)^2 / 2 - V;".to_owned(), "then", "values in braces"),
        ("coord x; L = dot(x)^2 / 2 - if x > 0 and x < 1 { x } else { 0 };".to_owned(), "and", "one comparison by"),
        ("coord r[3]; L = dot(r) * dot(r) / 2 + 1 / np.linalg.norm(r);".to_owned(), "norm", "function, `norm(…)`"),
        (plane("constraint floor = y >= 0;"), ">", "inequalities are not supported as constraints"),
        (plane("constraint y >= 0;"), ">", "a stiff spring for a stop"),
        (plane("constraint 0 <= y;"), "<", "a stiff spring for a stop"),
        (plane("subject to y >= 0;"), ">", "an event with `set_state`"),
        (plane("subject to y = 0;"), "subject", "help: write `constraint rod"),
    ] {
        let found = errors(&format!("struct System {{ {body} }}"));
        let said = found.iter().find(|(_, said)| said.contains(words));
        let (found, _) = said.unwrap_or_else(|| panic!("{body}\n{found:#?}"));
        assert_eq!(found, token, "{body}");
    }
    for (text, token, words) in [
        ("pendulum.txt", "pendulum", "not the name of a file"),
        ("lagrangian! { struct A { coord x; L = dot(x)^2; } }", "lagrangian", "without `lagrangian!` and its braces"),
    ] {
        let (found, said) = errors(text).remove(0);
        assert!(said.contains(words), "{said}");
        assert_eq!(found, token);
    }
}
