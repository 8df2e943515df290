//! The clause `angle`: what is emitted, and the message at each clause that is not periodic.
//!
//! Each case is the body of a system with the wrong token between `«` and `»`.

use proc_macro2::TokenStream;
use vi_codegen::syntax;

/// The emitted code, or all errors: (token underlined, message).
fn emitted(body: &str) -> Result<String, Vec<(String, String)>> {
    let text = format!("struct System {{ {} }}", body.replace(['«', '»'], ""));
    let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
    let parsed = syntax::parse::system(tokens.clone()).and_then(|system| vi_codegen::derive(&system)).map(|_| ());
    let token = |error: &syn::Error| error.span().source_text().unwrap_or_default();
    match parsed {
        Ok(()) => Ok(vi_codegen::expand(tokens).to_string()),
        Err(error) => Err(error.into_iter().map(|error| (token(&error), error.to_string())).collect()),
    }
}

/// One case: the marked token is underlined, and the message starts with the given text.
fn case(body: &str, message: &str) {
    let marked = body.split_once('«').and_then(|(_, rest)| rest.split_once('»')).map(|(token, _)| token);
    let found = emitted(body).expect_err(body);
    assert_eq!(found.len(), 1, "{body}\n{found:#?}");
    let (token, diagnostic) = &found[0];
    assert_eq!(Some(token.as_str()), marked, "{body}\n{diagnostic}");
    assert!(diagnostic.starts_with(message) && diagnostic.contains("\nhelp: "), "{body}\nsays: {diagnostic}");
}

/// One case: a summand of L that is not periodic in θ.
fn not_periodic(summand: &str) {
    case(
        &format!(
            "param k = 1, n = 2; angle θ, φ; coord x; «L» = k * (dot(θ)^2 + dot(φ)^2 + dot(x)^2) - n * {summand};"
        ),
        "`L` is not periodic in the angle `θ`: it changes when `θ` makes a turn of 2π\nhelp: declare `θ` with `coord`",
    );
}

/// The constant that says what coordinates are.
fn spaces(of: &[&str]) -> String {
    let each: Vec<String> = of.iter().map(|space| format!(":: vi_core :: lagrangian :: Space :: {space}")).collect();
    format!("const SPACES : [:: vi_core :: lagrangian :: Space ; {}usize] = [{}]", of.len(), each.join(" , "))
}

/// One case: a summand of L that is periodic.
fn periodic(summand: &str) {
    let body =
        format!("param k = 1, n = 2; angle θ, φ; coord x; L = k * (dot(θ)^2 + dot(φ)^2 + dot(x)^2) - n * {summand};");
    let code = emitted(&body).unwrap_or_else(|found| panic!("{body}\n{found:#?}"));
    assert!(code.contains(&spaces(&["Circle", "Circle", "Line"])), "{body}");
}

#[test]
fn summands_without_the_period_are_refused() {
    for summand in [
        "θ^2",
        "1e-3 * (θ - 0.1)^2",
        "θ",
        "t * θ",
        "θ * dot(x)",
        "sin(θ / 2)",
        "cos((θ - φ) / 2)",
        "cos(n * θ)",
        "cos(1.0001 * θ)",
        "(θ - φ)^2",
        "cos(θ) * θ",
        "exp(-θ^2)",
        "tanh(θ)",
        "abs(θ)",
        "sqrt(1 + θ^2)",
        "x * sin(θ + x * θ)",
        "1e-9 * sin(θ / 3)",
        // Narrow peaks: the points of a test miss them.
        "exp(-((θ - 0.31) / 1e-3)^2)",
        "1e3 / (1 + ((θ - 5.1) * 1e6)^2)^8 * 1e-40",
        "max(1 - abs(θ - 0.31) * 1e6, 0)",
        "exp(-((θ - cos(φ) - 3.1) / 1e-3)^2)",
    ] {
        not_periodic(summand);
    }
}

#[test]
fn periodic_summands_are_accepted() {
    for summand in [
        "cos(θ)",
        "sin(2 * θ) * cos(3 * φ)",
        "cos(θ - φ)",
        "cos(12 * θ + φ + x)",
        "x * sin(θ) * dot(x)",
        "dot(θ) * dot(x) * sin(θ)",
        "dot(θ)",
        "cos(θ - t) * x^2",
        "x^2 * t * (2 + n * cos(θ))",
        "abs(sin(θ / 2))",
        "tan(θ)",
        "1e12 * cos(θ)",
        "(1 - cos(θ))^2 / (2 + sin(φ))",
        "exp(cos(θ - φ) + x)",
        "sqrt((x - cos(θ))^2 + sin(θ)^2)",
        "sin(θ + pi / 3)",
        "sin(θ / 2)^2",
        "sin(θ / 2) * cos(θ / 2 - 3 * φ)",
        "sin(θ / 2)^2 * cos(φ / 2)^2",
        "cos((θ - φ) / 2)^4",
        "tan(θ / 2) * x",
        "if cos(θ) > x { cos(θ) - x } else { 0 }",
        "atan2(sin(θ), 2 + cos(θ))",
        "exp(-(sin(θ - 0.31) / 1e-3)^2)",
        "hypot(cos(θ) - x, sin(θ))",
    ] {
        periodic(summand);
    }
}

#[test]
fn forces_dissipation_and_time_scale_are_periodic_too() {
    let force = "the force on `θ` is not periodic in the angle `θ`";
    case("angle θ; L = dot(θ)^2 / 2; force «θ» = -θ;", force);
    case("angle θ; coord x; L = dot(θ)^2 + dot(x)^2; force x = -x, «θ» = -sin(θ / 2);", force);
    case(
        "angle θ; coord x; L = dot(θ)^2 + dot(x)^2; force «x» = -θ;",
        "the force on `x` is not periodic in the angle `θ`",
    );
    case(
        "angle q[3]; L = sum(i in 0..3, dot(q[i])^2); force q[0] = 1; force «q»[i in 1..3] = -q[i];",
        "the force on `q` is not periodic in the angle `q[1]`",
    );
    case(
        "angle θ; L = dot(θ)^2 / 2; «dissipation» = (1 + θ^2) * dot(θ)^2;",
        "the dissipation is not periodic in the angle `θ`",
    );
    case("angle θ; L = dot(θ)^2 / 2; «time_scale» = 1 + θ^2;", "the time scale is not periodic in the angle `θ`");
    let turning = "angle θ; rotation R; L = (rate(R) * rate(R) + dot(θ)^2) / 2;";
    let torque = "the torque on `R` is not periodic in the angle `θ`";
    case(&format!("{turning} torque «R» = [θ, 0, 0];"), torque);
    case(&format!("{turning} space_torque «R» = [0, 1, sin(θ / 2)];"), torque);
    assert!(emitted(&format!("{turning} torque R = [sin(θ), 0, 0];")).is_ok());
    let right = "param T = 1; angle q[3]; L = sum(i in 0..3, dot(q[i])^2) + cos(q[0] - q[1]); force q[i in 0..3] = T - sin(q[i]); \
                 dissipation = (2 + cos(q[0])) * dot(q[0])^2; time_scale = 2 + cos(q[1]);";
    assert!(emitted(right).is_ok_and(|code| code.contains(&spaces(&["Circle"; 3]))));
    // Every wrong clause has its message.
    let both = emitted("angle θ; L = dot(θ)^2 / 2 - θ; force θ = -θ;").expect_err("two clauses");
    assert_eq!(both.len(), 2, "{both:#?}");
}

/// A constraint that is linear in angles with rational factors holds modulo their turns.
#[test]
fn couplings_with_rational_ratios_are_periodic() {
    let system = |gear: &str| {
        format!(
            "const n = 33 / 20, m = 4; param k = 1, c = 2; angle θ, φ; coord x; \
             L = k * (dot(θ)^2 + dot(φ)^2 + c * dot(x)^2); constraint «gear» = {gear};"
        )
    };
    for gear in [
        "θ - φ",
        "θ - 3 * φ",
        "θ - n * φ",
        "2 * θ - m * φ",
        "1.5 * θ + 0.75 * φ - c * x - sin(θ - t)",
        "θ - c * t - x",
        "θ",
    ] {
        let code = emitted(&system(gear)).unwrap_or_else(|found| panic!("{gear}\n{found:#?}"));
        assert!(code.contains(&spaces(&["Circle", "Circle", "Line"])), "{gear}");
    }
    let message =
        "the constraint `gear` is not periodic in the angle `θ`: it changes when `θ` makes a turn of 2π\nhelp: ";
    for (gear, help) in [
        (
            "θ - c * φ",
            "write its ratio with `const`, as in `const n = 3;` or `const n = 33 / 20;`: with a rational number the constraint holds modulo whole turns, with the parameter `c` it does not",
        ),
        ("c * θ - x", "write its ratio with `const`"),
        ("sqrt(2) * θ - x", "declare `θ` with `coord`"),
        ("θ^2 - φ", "declare `θ` with `coord`"),
        ("x * θ - φ", "declare `θ` with `coord`"),
    ] {
        case(&system(gear), &format!("{message}{help}"));
    }
}

#[test]
fn an_angle_is_a_coordinate() {
    // Order of declaration, names and messages are those of `coord`.
    let code = emitted("coord x; angle θ; coord q[2]; L = dot(x)^2 + dot(θ)^2 + dot(q[0])^2 + dot(q[1])^2;");
    let code = code.expect("a correct system");
    assert!(code.contains("[\"x\" , \"θ\" , \"q[0]\" , \"q[1]\"]"), "{code}");
    assert!(code.contains(&spaces(&["Line", "Circle", "Line", "Line"])), "{code}");
    assert!(code.contains("Angles modulo 2π: `θ`"), "{code}");
    case("angle θ «=» 1; L = dot(θ)^2;", "a coordinate is declared without a value");
    case("coord θ; angle «θ»; L = dot(θ)^2;", "the name `θ` is declared twice");
    // The word stays free as a name.
    assert!(emitted("param angle = 1; coord x; L = angle * dot(x)^2;").is_ok());
    assert!(emitted("coord angle; L = dot(angle)^2; force angle = -angle;").is_ok());
}

#[test]
fn except_for_the_flag_the_code_is_that_of_a_coordinate() {
    let body = "param g = 9.81; angle θ; L = dot(θ)^2 / 2 + g * cos(θ); discretize midpoint;";
    let [of_angle, of_coordinate] = [body.to_owned(), body.replace("angle", "coord")].map(|body| emitted(&body));
    let (of_angle, of_coordinate) = (of_angle.expect("an angle"), of_coordinate.expect("a coordinate"));
    assert!(!of_coordinate.contains("SPACES") && !of_coordinate.contains("Angles"));
    let without = of_angle.replace(&format!("{} ; ", spaces(&["Circle"])), "");
    let line = |code: &str| {
        let lines = code.split("# [doc").filter(|part| !part.contains("Angles modulo"));
        lines.map(|part| part.split("DEFINITION").next().unwrap_or(part).to_owned()).collect::<Vec<_>>()
    };
    assert!(of_angle.contains("SPACES"));
    assert_eq!(line(&without), line(&of_coordinate));
}

/// A written rule has to move with an angle: if both ends make a turn, each point of the rule makes it too.
#[test]
fn written_rules_move_with_angles() {
    let system =
        |rule: &str| format!("angle θ; coord x; L = dot(θ)^2 / 2 + dot(x)^2 / 2 + cos(θ) * x; discretize {{ {rule} }}");
    for rule in [
        "«Ld» = h * L((t0 + t1) / 2, (q0 + q1) / 3, (q1 - q0) / h);",
        "«Ld» = h * L(t0, 2 * q0 - q1 / 2, (q1 - q0) / h);",
        "«Ld» = h * L(t0, q0, (q1 - q0 / 2) / h);",
        "«Ld» = h * L(t0, q0, (q1 - q0) / h) + h^3 * q0[0] * q1[0];",
    ] {
        case(&system(rule), "the rule is not periodic in the angle `θ`");
    }
    for rule in [
        "Ld = h * L((t0 + t1) / 2, (q0 + q1) / 2, (q1 - q0) / h);",
        "Ld = h * (L(t0, q0, (q1 - q0) / h) + 2 * L(t1, (q0 + 2 * q1) / 3, (q1 - q0) / h)) / 3 + h^3 * (q1[0] - q0[0])^2;",
        "Ld = h * L(t0, q0, (q1 - q0) / h) + h^3 * q0[1] * q1[1];",
    ] {
        let code = emitted(&system(rule)).unwrap_or_else(|found| panic!("{rule}\n{found:#?}"));
        assert!(code.contains(&spaces(&["Circle", "Line"])), "{rule}");
    }
}
