//! Functions, tables and conditions: what they become, and the messages for mistakes.

use crate::messages::{case, errors};
use proc_macro2::TokenStream;
use vi_codegen::syntax;

/// The derived system of a text.
fn derived(text: &str) -> vi_codegen::Derivations {
    let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
    let system = syntax::parse::system(tokens).unwrap_or_else(|error| panic!("{text}: {error}"));
    vi_codegen::derive(&system).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// L of a body, as text.
fn lagrangian(body: &str) -> String {
    let derived = derived(&format!("struct System {{ {body} }}")).own;
    derived.pool.render(derived.model.lagrangian, &|symbol| derived.model.spell(symbol))
}

/// The text of the only error of a body.
fn mistake(body: &str) -> String {
    let found = errors(&format!("struct System {{ {body} }}"));
    let [(_, text)] = &found[..] else { panic!("one mistake in {body}: {found:#?}") };
    text.clone()
}

#[test]
fn functions_of_the_language_are_substituted() {
    let plain = lagrangian("param k = 2; coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - k * (x - y)^2 / 2 - 3 * y^2 / 2;");
    // Arguments shadow names of the system; one function uses another, and a `let`.
    let with = "param k = 2; coord x, y; fn spring(k, x) = k * square(x) / 2; fn square(a) = a^2; let d = x - y; \
                L = (square(dot(x)) + square(dot(y))) / 2 - spring(k, d) - spring(3, y);";
    assert_eq!(lagrangian(with), plain);
    // `dot` inside a function is the derivative of its argument.
    let energy = lagrangian("coord x; fn energy(m, s) = m * dot(s)^2 / 2; L = energy(2, x^2);");
    assert_eq!(energy, lagrangian("coord x; L = dot(x^2)^2;"));
    // An argument of the calling function has its outer meaning in the called one.
    let hidden =
        "param k = 2; coord x, y; fn a(u) = u * y * k; fn b(y, k) = a(y) + k; L = dot(x)^2 + dot(y)^2 - b(x, 3) - y;";
    assert_eq!(lagrangian(hidden), lagrangian("param k = 2; coord x, y; L = dot(x)^2 + dot(y)^2 - x * y * k - 3 - y;"));
    let again = "coord x, y; fn b(y) = c(a(y), y); fn a(u) = u * y; fn c(u, w) = u + 3 * w * y; L = dot(x)^2 + dot(y)^2 - b(x);";
    assert_eq!(lagrangian(again), lagrangian("coord x, y; L = dot(x)^2 + dot(y)^2 - x * y - 3 * x * y;"));
    let scaled = "coord x; fn g(a) = 1 + a^2; L = dot(x)^2 / 2 - x^2; time_scale = g(x);";
    assert_eq!(lagrangian(scaled), lagrangian("coord x; L = dot(x)^2 / 2 - x^2;"));
    let sum = "coord q[3]; fn well(s) = s^4 / 4 - s^2 / 2; L = sum(i in 0..3, dot(q[i])^2 / 2 - well(q[i]));";
    assert!(lagrangian(sum).contains("q[2]^4/4"), "{}", lagrangian(sum));
}

#[test]
fn conditions_select() {
    let text =
        |expression: &str| lagrangian(&format!("param c = 1; coord x, y; L = dot(x)^2 + dot(y)^2 - c - {expression};"));
    let same = |left: &str, right: &str| assert_eq!(text(left), text(right), "{left} is {right}");
    same("max(x, y)^2", "(if x > y { x } else { y })^2");
    same("min(x, y)^2", "(if x < y { x } else { y })^2");
    same("if (x < y) { x^2 } else { y^2 }", "if x < y { x^2 } else { y^2 }");
    same("if (x) < (y) { x^2 } else { y^2 }", "if x < y { x^2 } else { y^2 }");
    same("max(x, y, 2)", "max(max(x, y), 2)");
    same("clamp(x, -1, 1)", "min(max(x, -1), 1)");
    same("if x >= y { x } else { y }", "if y > x { y } else { x }");
    same("if x <= y { x } else { y }", "if x > y { y } else { x }");
    same("if 2 * x > 2 * y { x } else { y }", "max(x, y)");
    same("if 1 > 2 { x } else { y }", "y");
    same("if 2 >= 2 { x } else { y }", "x");
    same("if x > y { x } else { x }", "x");
    same(
        "if x > 1 { (x - 1)^2 } else if x < -1 { (x + 1)^2 } else { 0 }",
        "if x > 1 { (x - 1)^2 } else { if -1 > x { (x + 1)^2 } else { 0 } }",
    );
    assert_eq!(text("max(x, 0)^2 * 3"), "dot(x)^2 - c + dot(y)^2 - 3*(if x > 0 { x } else { 0 })^2");
}

#[test]
fn the_derivative_of_a_condition_is_a_condition() {
    let derived = derived("struct S { coord x; L = dot(x)^2 / 2 - if x > 1 { (x - 1)^3 } else { 0 }; }").own;
    let force = derived.system.continuous.applied_force[0];
    let text = derived.pool.render(force, &|symbol| derived.model.spell(symbol));
    assert_eq!(text, "-(if x - 1 > 0 { 3*(x - 1)^2 } else { 0 })");
}

#[test]
fn declared_names_win() {
    assert_eq!(lagrangian("coord x; fn max(a, b) = a + b; L = dot(x)^2 - max(x, 1);"), "dot(x)^2 - x - 1");
    assert_eq!(
        lagrangian("param table = 1, input = 2; coord x; L = table * dot(x)^2 - input * x;"),
        "table*dot(x)^2 - input*x"
    );
    assert_eq!(lagrangian("param max = 1; coord x; L = max * dot(x)^2;"), "max*dot(x)^2");
}

#[test]
fn functions_of_rust_and_tables_are_opaque() {
    let body = "param c[3] = 1; coord x, y; fn cl(a) = crate::aero::cl; fn cp(a, b) = crate::aero::cp; table lift(a in 0..2) = c; \
                L = dot(x)^2 + dot(y)^2 - cl(x) - cp(x, 2 * y) - lift(x);";
    let own = derived(&format!("struct S {{ {body} }}")).own;
    let spell = |expr| own.pool.render(expr, &|symbol| own.model.spell(symbol));
    assert_eq!(spell(own.model.lagrangian), "dot(x)^2 + dot(y)^2 - cl(x) - cp(x, 2*y) - lift(x)");
    let force = own.system.continuous.applied_force.clone();
    assert_eq!(spell(force[0]), "-cl'(x) - cp^(1,0)(x, 2*y) - lift'(x)");
    assert_eq!(spell(force[1]), "-2*cp^(0,1)(x, 2*y)");
    // A call of a constant is evaluated when the program runs.
    let body = "coord x; fn cl(a) = crate::cl; L = cl(1) * dot(x)^2;";
    assert_eq!(lagrangian(body), "cl(1)*dot(x)^2");
}

/// A comparison of indices is decided where it stands: the other value need not exist.
#[test]
fn conditions_on_indices_are_decided_at_once() {
    let system = |sum: &str| lagrangian(&format!("const N = 3; coord q[N]; L = dot(q) * dot(q) - {sum};"));
    let pairs = system("sum(i in 0..N, j in 0..N, if i < j { 1 / abs(q[i] - q[j]) } else { 0 })");
    assert_eq!(pairs, system("sum(i in 0..N, j in i + 1..N, 1 / abs(q[i] - q[j]))"));
    let first = system("sum(i in 0..N, if i >= 1 { (q[i] - q[i - 1])^2 } else { q[i]^2 })");
    assert_eq!(first, system("(q[0]^2 + sum(i in 1..N, (q[i] - q[i - 1])^2))"));
    assert_eq!(system("if 2 <= 1 { q[7] } else { q[0] }"), system("q[0]"));
    assert_eq!(system("if pi > 3 { q[1] } else { q[0] }"), system("q[1]"));
}

/// An L that jumps is refused; a kink, and a jump of a force, are not.
#[test]
fn a_lagrangian_that_jumps_is_refused() {
    for jumps in [
        "if x > 1 { x } else { 0 }",
        "x * if x > 1 { 1 } else { x^2 + 1 }",
        "if x + y > 3 { 1 } else { 0 }",
        "y * if x > c { 1 } else { 0 }",
        "if x > 1e5 { 1 } else { 0 }",
        "if y > 3 { if x > 0 { 1 } else { 0 } } else { 0 }",
        "1e9 * y^2 + if x > 1 { 1e-3 } else { 0 }",
        // Steps that are no conditions.
        "sign(x)",
        "x * sign(x - c)",
        "cos(y) * sign(x * y)",
        "(1 + sign(x)) * dot(y)^2",
        "abs(x) / x",
        "x / abs(x)",
        "x / sqrt(x^2)",
        "(x^2)^(1/2) / x",
        "sqrt(4 * (x - c)^2) / (x - c)",
        "y * sqrt(x^2 * y^4) / (x * y^2)",
        "(x^2)^(3/2) / x^3",
        "y^2 * abs(x - c) / (x - c)",
        "(1 + sign(x)) / 2 * sqrt(x + 1)",
        // Between borders that are close.
        "if (x - 0.3)^2 < 1e-6 { 1 } else { 0 }",
        "if abs(x - 0.31) < 1e-5 { y } else { 0 }",
        "if (x - 0.3)^2 + (y - 0.2)^2 < 1e-6 { 1 } else { 0 }",
        "if 1e6 * (x - 0.3)^2 + 4 * (y - 200)^2 < 1e-4 { x } else { 0 }",
        "if (x - 0.3)^2 + (y - 0.2)^2 + (dot(x) - 0.7)^2 < 1e-8 { 1 } else { 0 }",
        "if abs(x - 0.3) + abs(y - 0.2) < 1e-4 { 1 } else { 0 }",
        "if max(abs(x - 0.3), abs(y - 0.2)) < 1e-4 { 1 } else { 0 }",
        "if sqrt((x - c)^2 + (y + 2)^2) < 1e-3 { 1 } else { 0 }",
        "if exp(-((x - 0.3)^2 + (y - 0.2)^2) / 1e-6) > 0.5 { 1 } else { 0 }",
        "if 1 / ((x - 0.3)^2 + (y - 0.2)^2) > 1e6 { 1 } else { 0 }",
    ] {
        let message = "`L` jumps where `";
        case(&format!("param c = 0.3; coord x, y; «L» = dot(x)^2 + c * dot(y)^2 - {jumps};"), message);
    }
    for continuous in [
        "if x > 1 { x - 1 } else { 0 }",
        "max(x, y)",
        "if x > 0 { x^1.5 } else { 0 }",
        "(if x > 0 { 1 } else { -1 }) * x",
        "clamp(x, -c, c)",
        "sign(x) * x^2",
        "sign(x) * x",
        "sign(x - c) * sin(x - c)",
        "sign(x * y) * x * y",
        "abs(x)^3",
        "abs(x) / (1 + x^2)",
        "if (x - 0.3)^2 + (y - 0.2)^2 < 1e-6 { ((x - 0.3)^2 + (y - 0.2)^2 - 1e-6)^2 } else { 0 }",
        "max(1e-6 - (x - 0.3)^2 - (y - 0.2)^2, 0)^2",
        "if x^2 + y^2 + 1 > 0 { x } else { y }",
        "abs(x)^3 / x",
        "(x^2)^(3/2) / x",
        "x / sqrt(x^2 + y^2)",
        "c / abs(x)",
        "y / abs(x)^3",
        "abs(x) / y",
        "(1 + sign(x)) / 2 * sqrt(x)",
        "if (x - 0.3)^2 < 1e-6 { (x - 0.3)^2 } else { 1e-6 }",
        "if c > 0.5 { x^2 } else { x^4 }",
        "if x^2 + 1 > 0 { x } else { 0 }",
        "((abs(x) - x) / 2)^(3/2)",
    ] {
        assert!(
            !lagrangian(&format!("param c = 0.3; coord x, y; L = dot(x)^2 + c * dot(y)^2 - {continuous};")).is_empty()
        );
    }
    assert!(!lagrangian("coord x; L = dot(x)^2; force x = if dot(x) > 0 { -1 } else { 1 };").is_empty());
}

#[test]
fn mistakes_in_tables() {
    let of = |table: &str, message: &str| {
        case(&format!("param c[4] = 0; coord x; {table} L = c[0] * dot(x)^2 / 2 - dot(x)^2 - g(x);"), message);
    };
    of("table g(a) = «3»;", "these are not the values of a table\nhelp: write the path of a file");
    of("table g(a) = «\"no such file.csv\"»;", "the table `g` cannot be read from its file\nhelp: `");
    of("table «g»(a) = [(0, 1)];", "the table `g` has 1 value\nhelp: write at least 2 values");
    of(
        "table «g»(a) = [(0, 1), (2, 3), (1, 5)];",
        "the table `g` has the place 1 after 2\nhelp: write the places in ascending order",
    );
    of("table «g»(a) = [(0, 1), (1, 3, 4)];", "the table `g` has no place and value in each point");
    of(
        "table «g»(a in 0..1) = [[0, 1], [1, 2], [2, 4]];",
        "the table `g` has 3 rows of values\nhelp: write points in parentheses, `[(0, 0.1), (1, 0.3)]`",
    );
    of("table g(«a») = [1, 2, 3];", "the table `g` has values without places in `a`\nhelp: write the range");
    of("table g(a in 0..«0») = [1, 2, 3];", "the table `g` has a range that ends before it begins");
    of("table g(a in 0..1) = «d»;", "the table `g` has the values `d`, which is no array of parameters");
    of("table g(«a») = c;", "the table `g` has values without places in `a`");
    of("table g(«a» in 0..1) = [(0, 1), (1, 2)];", "the table `g` has places in its points and a range");
    of(
        "table g(a) = «\"/dev/zero\"»;",
        "the table `g` cannot be read from its file\nhelp: `/dev/zero`: write the path",
    );
    of("table «g»(a in 0..1) = c quintic;", "the table `g` cannot be `quintic`");
    of("table g(a in 0..1) = c «cubci»;", "unknown kind of table `cubci`\nhelp: did you mean `cubic`?");
    of("table g(a in 0..1) = c linear «cubic»;", "the table `g` cannot also be `cubic`");
    of(
        "table «g»(a) = [(0, 1), (1, 2), (2, 3), (3, 5)] periodic;",
        "the table `g` is `periodic`, but its first and last values differ",
    );
    case(
        "param c[5] = [0, 1, 0, -1, 0]; coord x; table «g»(a in 0..4) = c periodic; L = dot(x)^2 / 2 - g(x);",
        "the table `g` is `periodic`, and has its first value again at the end\nhelp: parameters stand for one period",
    );
    of("table g(a) = [(0, 1), (1, «x»)];", "the value of `g` is not a constant");
}

/// A file with this content in a folder of its own.
fn file(name: &str, content: &str) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("vi-tables-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    std::fs::write(&path, content).expect("a file");
    path
}

#[test]
fn files_of_tables() {
    let table = |arguments: &str, name: &str, content: &str| {
        let path = file(name, content);
        let calls = if arguments.contains(',') { "g(x, 0.5)" } else { "g(x)" };
        format!("coord x; table g({arguments}) = {path:?}; L = dot(x)^2 / 2 - {calls};")
    };
    for (name, content) in [
        ("a.csv", "v,drag\n0,0.1\n1,0.3\n"),
        ("b.csv", "0;0.1\r\n1;0.3"),
        ("c.csv", "# measured\n\n0 0.1\n1   0.3\n"),
        ("d.csv", "\u{feff}0\t0.1\n1\t3e-1"),
    ] {
        let own = derived(&format!("struct S {{ {} }}", table("a", name, content))).own;
        let vi_codegen::model::FunctionKind::Table(table) = &own.model.functions[0].kind else { panic!("a table") };
        let wanted = vi_codegen::model::Values::Points { places: vec![0.0, 1.0], values: vec![0.1, 0.3] };
        assert_eq!(table.values, wanted, "{name}");
    }
    let grid = table("a, b", "grid.csv", "x/y,0,1,2\n0,1,2,3\n1,4,5,6\n");
    let own = derived(&format!("struct S {{ {grid} }}")).own;
    let vi_codegen::model::FunctionKind::Table(table_of_grid) = &own.model.functions[0].kind else { panic!("a table") };
    let rows = vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 6.0]];
    let wanted = vi_codegen::model::Values::Grid { places: [vec![0.0, 1.0], vec![0.0, 1.0, 2.0]], rows };
    assert_eq!(table_of_grid.values, wanted);
    for (name, content, message) in [
        ("e.csv", "0,1\n1,2\n2,abc\n", "the table `g` has no finite number in column 2 of line 3 of its file"),
        ("h.csv", "0.O,1\n1,2\n2,3\n", "the table `g` has no finite number in column 1 of line 1 of its file"),
        ("k.csv", "1,\n2,3\n", "the table `g` has no finite number in column 2 of line 1 of its file"),
        ("f.csv", "0,1\n1\n", "the table `g` has 1 columns in line 2 of its file, and 2 before"),
        ("g.csv", "v,drag\n", "the table `g` has no numbers in its file"),
        ("h.csv", "0,1,2\n1,2,3\n", "the table `g` has 3 columns in its file"),
        ("i.csv", "0,1\n1,inf\n", "the table `g` has no finite number in column 2 of line 2 of its file"),
        ("j.csv", "\u{0}PNG", "the table `g` has no numbers in its file"),
        ("k.csv", "0,1\n0,2\n", "the table `g` has the place 0 after 0"),
    ] {
        let text = mistake(&table("a", name, content));
        assert!(text.starts_with(message), "{name}: {text}");
    }
    // What is in a file that is no table stays in it.
    let secret = mistake(&table("a", "secret.csv", "root:x:0\ntoken=hidden\n"));
    assert!(!secret.contains("hidden") && !secret.contains("root"), "{secret}");
    let grid = mistake(&table("a, b", "corner.csv", "x/y,0,one\n0,1,2\n"));
    assert!(grid.starts_with("the table `g` has no finite number in column 3 of line 1"), "{grid}");
}

/// An edited file is another system for a checkpoint.
#[test]
fn tables_have_a_digest() {
    let digest = |content: &str, more: &str| {
        let path = file("digest.csv", content);
        let text = format!("struct S {{ coord x; table g(x) = {path:?}{more}; L = dot(x)^2 / 2 - g(x); }}");
        let code = vi_codegen::expand(text.parse().expect("tokens")).to_string();
        let digest = code.split("const TABLES : :: core :: primitive :: u32 = ").nth(1).expect("a digest");
        digest.split(' ').next().expect("a number").to_owned()
    };
    let first = digest("0,0.1\n1,0.3\n2,0.2\n", "");
    assert_eq!(first, digest("# the same\n0;0.1\n1;0.30\n2;0.2\n", ""));
    for (content, more) in [
        ("0,0.1\n1,0.3\n2,0.20000000000000004\n", ""),
        ("0,0.1\n1.5,0.3\n2,0.2\n", ""),
        ("0,0.1\n1,0.3\n", ""),
        ("0,0.1\n1,0.3\n2,0.2\n", " extend"),
    ] {
        assert_ne!(first, digest(content, more), "{content} {more}");
    }
    let without = "struct S { coord x; L = dot(x)^2 / 2; }".parse().expect("tokens");
    assert!(!vi_codegen::expand(without).to_string().contains("TABLES"));
}

#[test]
fn a_text_alone_has_the_language_only() {
    let said = |text: &str| {
        let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
        let found = syntax::alone::check(&tokens).err().into_iter().flatten();
        let found: Vec<_> = found.map(|error| (error.span().source_text(), error.to_string())).collect();
        assert!(found.len() <= 1, "{text}\n{found:?}");
        found
            .into_iter()
            .next()
            .map_or((String::new(), String::new()), |(token, text)| (token.unwrap_or_default(), text))
    };
    let system = |clause: &str| format!("struct S {{ {clause} coord x; L = dot(x)^2 / 2 - g(x); }}");
    for path in [
        "std::convert::identity",
        "std ::convert::identity",
        "std\n::\nconvert::identity",
        "r#std::convert::identity",
        "::std::convert::identity",
        ":: std::convert::identity",
        "crate::g",
        "self ::g",
        "super::g",
        "std/* */::convert /* */ :: identity",
        "std::convert::identity::<f64>",
    ] {
        let (token, text) = said(&system(&format!("fn g(a) = {path};")));
        assert!(
            text.starts_with("`g` is a Rust function, which a text alone does not have\nhelp: write it in"),
            "{text}"
        );
        assert!(path.contains(&token) && !token.is_empty(), "{path}: {token}");
    }
    for attribute in [
        r#"#[doc = include_str!("/etc/passwd")]"#,
        r#"# [ doc = include_str ! ("/etc/passwd") ]"#,
        r#"#[doc = concat!("a", env!("HOME"))]"#,
        r#"#[cfg_attr(all(), doc = include_str!("/etc/passwd"))]"#,
        "#[cfg(unix)]",
        "#[derive(a::B)]",
        "#[no_mangle]",
        r#"#[doc(alias = "a")]"#,
        r#"#[r#doc = include_str!("a")]"#,
    ] {
        for text in [
            format!("{attribute} {}", system("fn g(a) = a;")),
            format!("/// Text.\n {attribute} {}", system("fn g(a) = a;")),
            system(&format!("fn g(a) = a * k; {attribute} param k = 1;")),
        ] {
            let tokens: TokenStream = text.parse().expect("tokens");
            if syntax::parse::system(tokens).is_ok() {
                let (token, said) = said(&text);
                assert!(
                    said.starts_with("a text alone has no attributes with code\nhelp: write doc"),
                    "{text}\n{said}"
                );
                assert_eq!(token, "[", "{text}");
            }
        }
    }
    for allowed in [
        format!("/// Text with `std::env!`.\n #[derive(PartialOrd)] pub {}", system("/** text */ fn g(a) = a;")),
        system("#[doc = \"text\"] param k = 1; fn g(a) = if a > k { a } else { k };"),
        system("fn g(a) = std + 1;"),
    ] {
        assert_eq!(said(&allowed).1, "", "{allowed}");
    }
}

#[test]
fn a_missing_file_is_sought_where_its_path_starts() {
    let said = |path: &str| mistake(&format!("coord x; table g(a) = \"{path}\"; L = dot(x)^2 / 2 - g(x);"));
    assert!(said("none.csv").ends_with("write a path that starts at the folder of `Cargo.toml`"));
    let absolute = std::env::temp_dir().join("none.csv");
    assert!(said(&absolute.display().to_string()).ends_with("write a path of a file that exists"));
}

#[test]
fn tables_are_explained() {
    let text = "struct S { coord x; fn cl(a) = crate::aero::cl; table V(x) = [(0, 1), (1, 3), (2, 2)] hold; \
                L = dot(x)^2 / 2 - V(x); force x = cl(x); }";
    let tokens: TokenStream = text.parse().expect("tokens");
    let explained = vi_codegen::inspect::explain(tokens).expect("a system").text();
    for line in [
        "cl(a) = crate::aero::cl",
        "table V(x): cubic, 3 values from 0 to 2, hold",
        "1            3 ██████████████████████████████",
    ] {
        assert!(explained.contains(line), "{line}\n{explained}");
    }
    let limit = "`L` has 0 continuous derivatives because of the ends of the table `V`";
    assert!(explained.contains(&limit.replace('`', "")) || explained.contains(limit), "{explained}");
}

#[test]
fn the_smoothness_of_l_is_found() {
    let found = |clauses: &str| {
        let own = derived(&format!("struct S {{ coord x; {clauses} discretize midpoint; }}")).own;
        own.model.smoothness.map(|smoothness| (smoothness.derivatives, smoothness.cause))
    };
    let table = |words: &str| format!("table V(x) = [(0, 1), (1, 3), (2, 2), (3, 1)] {words};");
    assert_eq!(found("L = dot(x)^2 / 2 - cos(x);"), None);
    let of_table = |derivatives| Some((derivatives, "the table `V`".to_owned()));
    assert_eq!(found(&(table("") + "L = dot(x)^2 / 2 - V(x);")), of_table(2));
    assert_eq!(found(&(table("") + "L = dot(x)^2 / 2 - dot(V(x))^2 - x^2;")), of_table(1));
    assert_eq!(found(&(table("") + "L = dot(x)^2 / 2; force x = V(x);")), of_table(3));
    assert_eq!(found(&(table("quintic") + "L = dot(x)^2 / 2 - V(x);")), of_table(4));
    assert_eq!(found(&(table("monotone") + "L = dot(x)^2 / 2 - V(x);")), of_table(1));
    assert_eq!(found(&(table("linear") + "L = dot(x)^2 / 2; force x = V(x);")), of_table(1));
    let of_condition = |derivatives, text: &str| Some((derivatives, format!("the condition `{text} > 0`")));
    assert_eq!(found("L = dot(x)^2 / 2 - max(x, 0);"), of_condition(0, "x"));
    assert_eq!(found("L = dot(x)^2 / 2 - max(x, 0)^2;"), of_condition(1, "x"));
    assert_eq!(found("L = dot(x)^2 / 2 - max(x - 1, 0)^4;"), of_condition(3, "x - 1"));
    assert_eq!(found("L = dot(x)^2 / 2; force x = max(x, 0);"), of_condition(1, "x"));
    assert_eq!(found("L = dot(x)^2 / 2; force x = if x > 0 { 1 } else { -1 };"), of_condition(0, "x"));
}

#[test]
fn a_linear_table_belongs_in_a_force() {
    case(
        "coord x; table V(x) = [(0, 1), (1, 3)] linear; «L» = dot(x)^2 / 2 - V(x);",
        "the table `V` is linear, but `L` needs a continuous slope\nhelp: use it in a force, or make it `cubic` or `monotone`",
    );
}
