//! Texts that are nested without end are refused at a token, and exhaust no stack: that of a thread has 2 MB.

use crate::messages::errors;
use proc_macro2::TokenStream;
use vi_codegen::inspect::{self, Stage};

/// More than any limit, and fewer tokens than a system may have.
const MANY: usize = 4_000;

const PARSED: &str = "this expression is nested deeper than 100 levels\nhelp: name parts of it with `let`";
const CALLED: &str = "in functions that call each other, more than 400 operations and calls are inside each other\nhelp: write the values";

/// The first message, and what is underlined; none if the system is accepted, shown and expanded.
fn first(text: &str) -> Option<(String, String)> {
    let tokens: TokenStream = text.parse().expect("tokens");
    let expanded = vi_codegen::file::expand(tokens.clone()).to_string();
    let found = errors(text).into_iter().next();
    assert_eq!(expanded.contains("compile_error"), found.is_some(), "{text:.200}: {expanded:.200}");
    if found.is_none() {
        inspect::stage(tokens.clone(), Stage::Syntax).expect("the syntax");
        let explanation = inspect::explain(tokens).expect("the mathematics");
        assert!(!explanation.text().is_empty() && !explanation.latex().is_empty());
    }
    found
}

/// Asserts that a text is refused at a token.
#[track_caller]
fn refused(text: &str, token: &str, message: &str) {
    let (found, said) = first(text).unwrap_or_else(|| panic!("accepted: {text:.200}"));
    assert!(said.starts_with(message), "{text:.200}\nsays: {said}");
    assert_eq!(found, token, "{text:.200}\n{said}");
}

/// Asserts that a text is refused where a function calls another.
#[track_caller]
fn called(text: &str) {
    let (found, said) = first(text).unwrap_or_else(|| panic!("accepted: {text:.200}"));
    assert!(said.starts_with(CALLED), "{text:.200}\nsays: {said}");
    assert!(found.starts_with('f') && text.contains(&format!(" {found}(a")), "{text:.200}\n{found}: {said}");
}

#[track_caller]
fn accepted(text: &str) {
    let found = first(text);
    assert_eq!(found, None, "{text:.200}");
}

/// A system with a summand of L inside `count` of these.
fn inside(count: usize, before: &str, after: &str) -> String {
    format!("struct A {{ coord x; L = dot(x)^2 / 2 - {}x{}; }}", before.repeat(count), after.repeat(count))
}

/// Clauses, each made of the previous one.
fn chain(count: usize, clause: impl Fn(usize, usize) -> String) -> String {
    (1..=count).map(|i| clause(i, i - 1)).collect()
}

/// A chain of functions, each with the one before in its body.
fn functions(count: usize, body: &str) -> String {
    let chain = chain(count, |i, before| format!("fn f{i}(a) = {};", body.replace('f', &format!("f{before}"))));
    format!("struct A {{ coord x; fn f0(a) = a^2; {chain} L = dot(x)^2 / 2 - f{count}(x); }}")
}

#[test]
fn expressions_inside_each_other_are_bounded() {
    for (before, after, token) in [
        ("(", ")", "("),
        ("(1 + 2 * ", ")", "("),
        ("sin(1 + 2 * ", ")^2", "("),
        ("[", "]", "["),
        ("if x > 0 { ", " } else { 1 }", "{"),
        ("1 + sum(i in 0..2, ", ")", "("),
        ("-", "", "-"),
        ("2^", "", "2"),
    ] {
        refused(&inside(MANY, before, after), token, PARSED);
    }
    let otherwise = "if x > 0 { 1 } else ".repeat(MANY / 2);
    refused(&format!("struct A {{ coord x; L = dot(x)^2 / 2 - {otherwise} {{ x }}; }}"), "1", PARSED);
    let ranges = chain(MANY, |i, _| format!("i{i} in 0..1, "));
    refused(&format!("struct A {{ coord x; L = dot(x)^2 / 2 - sum({ranges} x); }}"), "0", PARSED);
    // Close below the limit, all stages need no more.
    for (before, after) in [("(", ")"), ("sin(1 + x * ", ")"), ("max(1, 2 + x / ", ")"), ("-", "")] {
        let text = inside(95, before, after);
        let tokens: TokenStream = text.parse().expect("tokens");
        inspect::stage(tokens, Stage::Syntax).expect("the syntax");
        let refused = errors(&text).into_iter().find(|(_, message)| message.contains("nested"));
        assert_eq!(refused, None, "{text}");
    }
}

#[test]
fn functions_that_call_each_other_are_bounded() {
    accepted(&functions(100, "f(a) + 1"));
    for body in ["f(a) + 1", "f(a)", "-2 * f(sin(a))^2", "sum(i in 0..1, j in 0..1, f(a))"] {
        called(&functions(800, body));
    }
    // Each of them at the limit of the parser.
    let deep = format!("{}f(a){}", "sin(1 + 2 * ".repeat(95), ")".repeat(95));
    called(&functions(50, &deep));
    // Twice as many calls in each.
    let said = errors(&functions(90, "f(a) + f(a + 1)"));
    let message = "the system takes more than 56000000 steps of algebra";
    assert!(said.iter().any(|(_, said)| said.starts_with(message)), "{said:?}");
}

#[test]
fn names_made_of_each_other_need_no_stack() {
    let of_names = chain(300, |i, before| format!("let f{i} = abs(f{before} - 1);"));
    let text = format!("struct A {{ coord x; let f0 = x^2; {of_names} L = dot(x)^2 / 2 - f300; }}");
    let explanation = inspect::explain(text.parse().expect("tokens")).expect("the mathematics");
    assert!(!explanation.text().is_empty() && !explanation.latex().is_empty());
    let of_numbers = chain(1000, |i, before| format!("const c{i} = c{before} / 2 + 1;"));
    let text = format!("struct A {{ coord x; const c0 = 1; {of_numbers} L = dot(x)^2 / 2 - c1000 * x; }}");
    assert_eq!(errors(&text), []);
}

#[test]
fn indices_are_bounded() {
    let many = "[0]".repeat(MANY);
    let message = "an array has at most 100 indices\nhelp: use fewer indices";
    refused(&format!("struct A {{ coord x{many}; L = dot(x)^2; }}"), "[", message);
    refused(&format!("struct A {{ coord x; let y{many} = 1; L = dot(x)^2; }}"), "[", message);
    refused(&format!("struct A {{ coord x[1]; L = dot(x{many})^2; }}"), "[", message);
}

#[test]
fn rust_in_a_system_is_bounded() {
    let system = |attribute: &str, path: &str| {
        format!("{attribute} struct A {{ coord x; fn g(a) = {path}; L = dot(x)^2 / 2 - g(x); }}")
    };
    let types = |count: usize| format!("{}b{}", "::<a".repeat(count), ">".repeat(count));
    refused(&system("", &format!("a{}", types(MANY))), "<", PARSED);
    refused(&system("", &format!("a::<{}u8>", "&".repeat(MANY))), "&", PARSED);
    refused(&system(&format!("#[derive(a{})]", types(MANY)), "a::b"), "<", PARSED);
    refused(&system(&format!("#[doc = {}true]", "!".repeat(MANY)), "a::b"), "!", PARSED);
    accepted(&system("#[derive(PartialOrd)]", "a::b::<3>"));
    accepted(&system("", &format!("a{}", "::b".repeat(MANY))));
}
