//! What an example of a message cannot say: right systems, several mistakes at once, inputs of any size, text around a
//! system. The examples are in `src/messages`.

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
}

/// The rest of a correct system.
const REST: &str = "coord x; L = dot(x)^2 / 2; discretize midpoint;";

/// A right system.
#[track_caller]
pub(crate) fn accepted(body: &str) {
    assert_eq!(errors(&format!("struct System {{ {body} }}")), [], "{body}");
}

#[test]
fn words_of_clauses_are_names_elsewhere() {
    for body in [
        "coord x, y[2]; param a = 1; time_scale = sqrt(a + x^2 + sum(i in 0..2, y[i]^2) + sin(t)^2); \
         L = (dot(x)^2 + dot(y[0])^2 + dot(y[1])^2) / 2; discretize midpoint;",
        "input u[2] = 0.0, w = 1.0; coord x; L = dot(x)^2 / 2; force x = u[0] + u[1] * w; discretize midpoint;",
        "param input = 1; coord x; L = input * dot(x)^2 / 2; discretize midpoint; check { input = 2; h = 0.1; }",
        "input input = 1; coord x; let control = input^2; L = control * dot(x)^2 / 2; discretize midpoint;",
        "coord input; L = dot(input)^2 / 2 - input; force input = 1; discretize midpoint;",
        "#[allow(dead_code)] input u = 1; coord x; L = dot(x)^2 / 2 - u * x; discretize midpoint;",
        "const input = 1; coord x; L = dot(x)^2 / 2 - 2 * input * x; discretize midpoint;",
    ] {
        accepted(body);
    }
}

#[test]
fn a_time_scale_has_derivatives() {
    let found = errors(&format!("struct System {{ time_scale = 1 + 0^x; {REST} }}"));
    assert!(found[0].1.starts_with("`pow(0, x)` has no derivative with respect to `x`"), "{found:?}");
}

#[test]
fn a_wrong_clause_does_not_hide_the_next() {
    case("coord x; discretize midpoint;", "the system has no Lagrangian");
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
    accepted(body);
    let rule = "coord x; L = dot(x)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h,); }";
    accepted(rule);
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
        accepted(&system(right));
    }
}

#[test]
fn dissipations_of_either_sign_are_accepted() {
    let system = |rayleigh: &str| {
        format!(
            "param c = 0.3, w = 2, K[4] = [2, 1, 1, 2], e = 1e-3, d = -1; coord x, y; let v[i in 0..2] = dot(x) * (1 - i) + dot(y) * i; \
             let drag = c * w * dot(x); L = (1 + c^2 + w^2 + e^2 + d^2 + K[0]) * (dot(x)^2 + dot(y)^2); dissipation = {rayleigh}; discretize midpoint;"
        )
    };
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
        accepted(&system(right));
    }
}

#[test]
fn every_missing_line_of_a_rule_is_reported() {
    let system = |rule: &str| {
        errors(&format!("struct System {{ coord x; L = dot(x)^2 / 2; force x = -x; discretize {{ {rule} }} }}"))
    };
    let missing = system(
        "Ld = h * L(t0, q0, (q1 - q0)/h); fd_minus = h * f(t0, q0, (q1 - q0)/h); fd_plus = 0 * q0; gd_minus = 0;",
    );
    assert_eq!(missing.len(), 1, "{missing:?}");
    assert!(missing[0].1.starts_with("the rule has no line `gd_plus`\nhelp: the system has a force"), "{missing:?}");
    let missing = system("Ld = (q1 - q0) * (q1 - q0) / (2 * h);");
    assert_eq!(missing.len(), 4, "{missing:?}");
    accepted("coord x; L = dot(x)^2 - x^2; discretize { Ld = h * L(t0, q0, (q1 - q0) / (t1 - t0)); }");
}

#[test]
fn every_mistake_of_a_check_is_reported() {
    let system = |check: &str| {
        let rest = "L = sum(i in 0..3, dot(q[i])^2) + a * dot(x)^2; discretize midpoint;";
        format!("const N = 3; param a = 1; coord x, q[N]; {rest} {check}")
    };
    let two = errors(&format!("struct System {{ {} }}", system("check { y = 1; z = 2; }")));
    let diagnostic: Vec<&str> = two.iter().map(|(_, message)| message.lines().next().unwrap_or_default()).collect();
    let nor = |name: &str| format!("`{name}` is neither a coordinate nor a parameter");
    assert_eq!(diagnostic, ["the check has no step".to_owned(), nor("y"), nor("z")]);
}

#[test]
fn a_check_sets_parameters() {
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
        accepted(&system(right));
    }
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
}

#[test]
fn text_around_a_system() {
    let diagnostic = |text: &str| errors(text).into_iter().map(|(_, message)| message).collect::<Vec<_>>().join("; ");
    assert!(diagnostic("").starts_with("expected `struct Name { … }`"), "{}", diagnostic(""));
    assert!(diagnostic("enum A {}").starts_with("expected `struct Name { … }`"));
    assert!(diagnostic("struct A;").starts_with("expected `{` and the clauses"));
    assert!(diagnostic(&format!("struct A {{ {REST} }} struct B;")).starts_with("unexpected text after the system"));
    for (text, token, words) in [
        ("pendulum.txt", "pendulum", "not the name of a file"),
        ("lagrangian! { struct A { coord x; L = dot(x)^2; } }", "lagrangian", "without `lagrangian!` and its braces"),
    ] {
        let (found, said) = errors(text).remove(0);
        assert!(said.contains(words), "{said}");
        assert_eq!(found, token);
    }
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
fn every_clause_has_documentation() {
    accepted(&format!("/// Words.\n coord y; {}", REST.replace("L =", "L = dot(y)^2 +")));
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
    accepted(&format!("{rest} 1_0.5_0e-1_0 * x^2;"));
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

/// Numbers of many digits are short in documentation.
#[test]
fn long_numbers_are_short_in_words() {
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
        accepted(body);
    }
}

/// The rest of a right system in space.
const SPACE: &str = "param l = 1, m = 2; coord x, y, z, q[4]; \
                     L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(q) * dot(q)) / 2 - l * z;";

#[test]
fn constraints_that_leave_a_motion_are_accepted() {
    // A third crank of a parallelogram follows from the others where they hold.
    accepted(
        "param b = 2, c = 1; coord x, y, u, w; L = dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2; \
         constraint left = x^2 + y^2 - 1, right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2, \
         middle = ((x + u) / 2 - b / 2)^2 + ((y + w) / 2)^2 - c^2;",
    );
    // The constraint determines z, and the whole is regular.
    for lines in [
        "constraint c = z - x * y;",
        "constraint c = z - x^2, d = q[1] * dot(z) - x * dot(y);",
        "constraint c = dot(z) * x - dot(y) * q[0];",
    ] {
        accepted(&format!("coord x, y, z, q[2]; {lines} L = dot(x)^2 + dot(y)^2 + dot(q) * dot(q) - z;"));
    }
    for smooth in ["y - max(x, 0)^2", "y - abs(x)^3", "y - hill(x)", "dot(y) * z - abs(x) * dot(x)"] {
        let hill = "table hill(s) = [(0, 0), (1, 1), (2, 0)]; force x = hill(x);";
        accepted(&format!("{hill} constraint c = {smooth}; {SPACE}"));
    }
    // A velocity that an input prescribes is no derivative of a function, the length of a road has no closed form.
    accepted(&format!("input u = 0; constraint c = dot(x) - u; {SPACE}"));
    let road = "constraint c = r * dot(y) + sqrt(1 + (a * k * sin(k * x))^2) * dot(x);";
    accepted(&format!("param r = 0.5, a = 0.3, k = 1.2; {road} {SPACE}"));
    accepted(
        "angle θ; coord x, y; constraint blade = sin(θ) * dot(x) - cos(θ) * dot(y); L = dot(x)^2 + dot(y)^2 + dot(θ)^2;",
    );
    // A wheel that rolls, modulo its turns.
    accepted("angle θ; coord x; constraint roll = x - 0.3 * θ; L = dot(x)^2 + dot(θ)^2;");
    accepted(
        "param a = 1, b[2] = 1; fn s(u) = u^2; coord x, y; let r = s(x) + s(y); constraint c = r - a^2 + b[1]; \
         L = dot(x)^2 + dot(y)^2 - y;",
    );
    // The names of the functions and clauses of rotations are free.
    accepted(
        "param rate = 1, spin = 2, turn = 3, torque = 4, rotation = 5, constraint = 6; coord x; \
         L = dot(x)^2 - rate * spin * turn * torque * rotation * constraint * x;",
    );
}

#[test]
fn a_planar_linkage_of_bodies_in_space_moves() {
    // Four hinges of five constraints, and three quaternions: 23 constraints on 21 coordinates, and one motion.
    let linkage = "param l[3] = [1.0, 3.0, 2.5], d = 3.2; coord x[3][3]; rotation R[3]; \
        let w[i in 0..3] = rate(R[i]); \
        L = sum(i in 0..3, dot(x[i]) * dot(x[i]) / 2 + w[i] * w[i] / 2 - x[i][1]); \
        let ez = [0, 0, 1], ex = [1, 0, 0], ey = [0, 1, 0]; \
        constraint pin_a = x[0] - turn(R[0], l[0] / 2 * ex); \
        constraint pin_b = x[0] + turn(R[0], l[0] / 2 * ex) - x[1] + turn(R[1], l[1] / 2 * ex); \
        constraint pin_c = x[1] + turn(R[1], l[1] / 2 * ex) - x[2] - turn(R[2], l[2] / 2 * ex); \
        constraint pin_d = x[2] - turn(R[2], l[2] / 2 * ex) - [d, 0, 0]; \
        constraint across_a = [ez * turn(R[0], ex), ez * turn(R[0], ey)]; \
        constraint across_b = [turn(R[0], ez) * turn(R[1], ex), turn(R[0], ez) * turn(R[1], ey)]; \
        constraint across_c = [turn(R[1], ez) * turn(R[2], ex), turn(R[1], ez) * turn(R[2], ey)]; \
        constraint across_d = [ez * turn(R[2], ex), ez * turn(R[2], ey)];";
    accepted(linkage);
}

/// A system with a matrix.
fn with_matrix(clause: &str) -> String {
    format!(
        "const N = 3, s = [1, 2]; coord q[N], x; let M = [[x, 1], [2, 3]]; {clause} L = dot(q) * dot(q) + dot(x)^2;"
    )
}

#[test]
fn an_entry_may_use_whole_earlier_rows() {
    accepted(&with_matrix("let y[0] = [x, 1]; let y[i in 1..N] = M * y[i - 1]; force x = y[2] * s;"));
}

/// Arrays that grow too large are refused, within the limit of work.
#[test]
fn sizes_are_bounded() {
    let work = ["the system takes more than", "the expanded system has more than"];
    for large in [
        "let big[i in 0..100000000] = x;",
        "let big[i in 0..600][j in 0..600] = 1; let product = big * big;",
        "let big[0] = [x, 1]; let big[i in 1..1000000000] = M * big[i - 1];",
    ] {
        let found = errors(&format!("struct System {{ {} }}", with_matrix(large)));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(work.iter().any(|start| found[0].1.starts_with(start)), "{found:?}");
    }
}

#[test]
fn a_clause_and_a_parameter_without_a_value_have_their_own_help() {
    case("coord x; «L»; discretize midpoint;", "`L` has no value\nhelp: write `L = …;`, one function");
    case(
        "param «H»; coord x; L = dot(x)^2; discretize midpoint;",
        "`H` has no value\nhelp: write `H = 1.0`: a `param`",
    );
}
