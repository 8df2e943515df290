//! The compiler on arbitrary token streams: it may refuse them, and must neither panic nor hang.
//!
//! ```sh
//! cargo install cargo-fuzz
//! cargo +nightly fuzz run expand -- -timeout=1 -runs=1000000
//! ```
//!
//! Every byte of an input is a token of the language, so that most mutations change the system and not its spelling;
//! what is left open is closed at the end. `vi-macros/codegen/tests/arbitrary.rs` does the same without a fuzzer.
#![no_main]

use libfuzzer_sys::fuzz_target;
use proc_macro2::TokenStream;

/// One token for each byte, after the words that start a clause; the last ones open and close.
const TOKENS: [&str; 104] = [
    "midpoint",
    "trapezoidal",
    "Ld",
    "fd_minus",
    "fd_plus",
    "gd_minus",
    "gd_plus",
    "f",
    "h",
    "t",
    "t0",
    "t1",
    "q0",
    "q1",
    "q",
    "x",
    "y",
    "m",
    "k",
    "N",
    "i",
    "j",
    "in",
    "dot",
    "sum",
    "pi",
    "sqrt",
    "exp",
    "ln",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "abs",
    "sign",
    "hypot",
    "pow",
    "self",
    "r#type",
    "+",
    "-",
    "*",
    "/",
    "^",
    "=",
    ";",
    ",",
    "..",
    ":",
    "#",
    "0",
    "1",
    "2",
    "3",
    "7",
    "0.5",
    "1e3",
    "1e-3",
    "1e308",
    "1e400",
    "0x10",
    "2x",
    "256",
    "65536",
    "18446744073709551616",
    "0.1234567890123456789",
    "\"text\"",
    "'c'",
    "dot(x)",
    "dot(x)^2",
    "q[i]",
    "dot(q[i])",
    "sum(i in 0..N, q[i])",
    "coord x;",
    "discretize midpoint;",
    "L = dot(x)^2;",
    "coord q[256];",
    "L = sum(i in 0..256, dot(q[i])^2) +",
    "sum(i in 0..256, q[i])^4",
    "sum(i in 0..20000, 1/(i + 1))",
    "sum(j in 0..i,",
    "let a = x;",
    "let b = a * (x + 7) + sin(a);",
    "let c[i in 0..N] = b * b[i];",
    "const N = 64;",
    "const u = 1e-30;",
    "* (x + sin(x))",
    "^2^2^2^2^2",
    "/3^100000",
    "1e999999999",
    "1_000_000",
    "check { x = 1; h = 0.1; }",
    "(",
    "(",
    "[",
    "{",
    ")",
    ")",
];

/// The text of a system whose body is what the bytes say.
fn text(bytes: &[u8]) -> String {
    let tokens: Vec<&str> = vi_codegen::clause::words().chain(TOKENS).collect();
    let (mut text, mut open) = (String::from("struct S {"), Vec::new());
    for byte in bytes {
        let token = tokens[usize::from(*byte) % tokens.len()];
        text.push(' ');
        match token {
            "(" => open.push(")"),
            "[" => open.push("]"),
            "{" => open.push("}"),
            ")" => {
                text.push_str(open.pop().unwrap_or(";"));
                continue;
            }
            _ => {}
        }
        text.push_str(token);
    }
    while let Some(close) = open.pop() {
        text.push_str(close);
    }
    text.push('}');
    text
}

fuzz_target!(|bytes: &[u8]| {
    if let Ok(tokens) = text(bytes).parse::<TokenStream>() {
        drop(vi_codegen::expand(tokens));
    }
    proc_macro2::extra::invalidate_current_thread_spans();
});
