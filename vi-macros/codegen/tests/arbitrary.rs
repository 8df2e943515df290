//! No input makes the compiler panic or hang: correct systems, mutated token by token, and random token streams.
//! Accepted input expands to Rust of bounded length.
//!
//! The inputs are drawn from a fixed sequence, 250 of them. `VI_INPUTS=1000000 cargo test --release -p vi-codegen
//! --test all arbitrary -- --nocapture` draws more, and names the slowest; `.ci/run nightly` draws 1000.

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

const INPUTS: u64 = 250;

/// Maximum characters of an expansion: work is bounded, and so is the output. Measured: some 5 million.
const LONGEST: usize = 32_000_000;

/// Correct systems, which together use every clause and every form of expression.
const SYSTEMS: [&str; 18] = [
    "struct A { param m = 1, k = 2.5e-1; coord x; let v = dot(x); L = m * v^2 / 2 - k * x^2; force x = -0.1 * v; discretize midpoint; }",
    "pub struct B { const N = 3; param a = N / 2; coord q[N], y; let e[i in 1..N] = q[i] - q[i - 1]; L = sum(i in 0..N, dot(q[i])^2) + dot(y)^2 - a * sum(i in 1..N, e[i]^2 * cos(y)); force q[i in 0..2] = sin(t * i); discretize trapezoidal; }",
    "/// Doc.\n struct C { coord θ, φ; L = (dot(θ)^2 + sin(θ)^2 * dot(φ)^2) / 2 + cos(θ); dissipation = dot(θ)^2 + dot(θ)^4; discretize midpoint; }",
    "struct D { const g = sqrt(2) ^ -3, h = pi / 7; param c = ln(g); coord x; L = exp(x) * dot(x)^2 - c * atan2(x, h) * hypot(x, 1) / tanh(t); discretize midpoint; }",
    "struct E { coord x, y; L = dot(x) * dot(y) - pow(x, y) + abs(x - y); force y = sign(x) * t; discretize { Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h); fd_minus = h * f(t0, q0, q1); fd_plus = 0 * q0; gd_minus = -h^2 * q0 * q1; gd_plus = t1; } }",
    "struct F { param k = 1; coord q[2]; L = dot(q[0])^2 / (1 + q[1]^2)^2 + dot(q[1])^2 / sqrt(1 - k * q[0]) - asin(q[0]) * acos(q[1]); discretize midpoint; }",
    "struct G { coord x; L = -(1 - dot(x)^2)^(1/2) - cosh(x) + sinh(x)^3 / (1 + tan(x))^4; force x = 1 / (2 + cos(t)); discretize trapezoidal; }",
    "struct I { const N = 3; coord q[N]; let a = q[0] + 1; let b[i in 0..N] = a * a * (q[i] + i); L = sum(i in 0..N, dot(q[i])^2) - sum(i in 0..N, sum(j in 0..i, b[i] * b[j]^2))^2 / 3^20; discretize midpoint; }",
    "struct J { const u = 1e-30; coord x, y; let w = sinh(x) * (1 + x)^3 * (2 + y)^(1/3); L = u * dot(x)^2 + dot(y)^2 / u - w * w^2 - sum(i in 1..9, x^i / i); discretize { Ld = h * (L(t0, q0, (q1 - q0)/h) / 3 + 2 * L(t1, q1, (q1 - q0)/h) / 3); } check { x = 0.1; h = 1e-2; } }",
    "struct K { const N = 2; param m[N] = [1, 2.5], l[N + 1] = 0.5, k = 1,; coord q[N]; let x[i in 0..N] = sum(j in 0..i + 1, l[j] * sin(q[j]) + t * l[N]); L = sum(i in 0..N, m[i] * dot(x[i])^2 + dot(q[i])^2) - k * x[1]; force q[0] = -dot(x[0] * x[1]); discretize midpoint, trapezoidal,; }",
    "struct M { const N = 3, s = [1, -2, 3], A[2][2] = [[1, 2], [3, 4]]; param K[2][2] = [[1, 2], [3, 4]], m[N] = s; coord r[N][2], x; let R = [[cos(x), -sin(x)], [sin(x), cos(x)]], p[0] = R * r[0]; let p[i in 1..N] = p[i - 1] + transpose(R) * A * r[i]; L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i])) + dot(x)^2 - sum(i in 0..N, j in 0..i, 1 / norm(r[i] - r[j])) - p[N - 1] * K * p[0]; force r[i in 0..N] = [0, -m[i]]; discretize midpoint; check { r[0] = [1, 2], dot(r[1][0]) = 3, K = A; h = 0.1; } }",
    "struct N { coord q[3], u[2][3]; let d[i in 0..3][j in 0..i] = q[i] - q[j]; let w = cross(u[0], q); L = dot(q) * dot(q) + dot(u[0]) * dot(u[0]) + dot(u[1]) * dot(u[1]) - sum(i in 0..3, j in 0..i, d[i][j]^2) - dot(w) * w * cross([q[0], x_0], [1, q[1]]); let x_0 = 2; force u = [[1, 2, 3], -q]; discretize trapezoidal; }",
    "struct O { param m = 1, k = 2; coord r, a; momentum p of r, l of a; let u = l / r; H = (p^2 + u^2 + p * l * sin(a)) / (2 * m) + k * (r - 1)^2; force r = -p * u; discretize midpoint; }",
    "struct P { const N = 2; param m[N] = 1, B = 3; coord r[N][2], s; momentum p of r, q of s; let A[i in 0..N] = [-B * r[i][1], B * r[i][0]]; H = sum(i in 0..N, (p[i] - A[i]) * (p[i] - A[i]) / (2 * m[i])) + sqrt(4 + q^2) - cos(s * t); constraint c = s - r[0][0]; }",
    "struct Q { param a = 2; coord x, y, z; momentum p of x, q of y, s of z; H = (p^2 * (1 + x^2)^3 + a * q^2 * cos(y)^2 + s^2 / (2 + x)) / (3 + sin(y)^2) + p * q * x + q * s / a + x * s; discretize trapezoidal; }",
    "struct H { const M = 4; coord u[M]; let a[i in 0..M] = sum(j in 0..i + 1, dot(u[j]) * cos(u[j])); L = sum(i in 0..M, a[i]^2 + dot(u[i])^2); discretize midpoint; }",
    "struct R { param J = 2; input u = 0; rotation R; let w = rate(R); L = J * (w * w) / 2; torque R = [u, 0, 0]; space_torque R = -spin(R); }",
    "struct S { input u = 0.5; angle a; coord x; fn f(s) = s^2; table g(s) = [(0, 1), (1, 2)]; time_scale = 1 + x^2; L = (f(dot(x)) + dot(a)^2) / 2 - cos(a); force x = u - g(x); discretize midpoint; }",
];

/// Inserted tokens besides the words that start a clause: the other words of the language, and some others.
const WORDS: &str = "struct of midpoint trapezoidal Ld fd_minus fd_plus gd_minus \
    gd_plus f h t t0 t1 q0 q1 q x y θ i in dot sum pi sqrt exp ln sin cos tan asin acos atan atan2 sinh cosh tanh abs sign \
    hypot pow cross norm transpose self Self r#type _ + - * / ^ = ; , : . .. # ! & 0 1 2 3 7 0.5 1e3 1e-3 1e308 1e400 1e-400 0x10 1f64 2x 100 256 257 \
    1000 20000 65536 4294967296 18446744073709551616 99999999999999999999999999999999999999999999999999 1_0 1e-30 2.5e-200 0.1234567890123456789012345678901234567890 \
    if as for max log xdot e λ time min clamp else 1.5f64 | .. [1,2] [3] m l k \"text\" 'c' b\"b\" true";

/// The next number of a fixed pseudo-random sequence: a linear congruence (Knuth, MMIX).
struct Sequence(u64);

impl Sequence {
    /// A number below `end`.
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let end = u64::try_from(end.max(1)).expect("64 bits");
        usize::try_from((self.0 >> 33) % end).expect("below the end")
    }

    fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }
}

/// The tokens of a text without spans, so that the spans of all texts can be dropped.
fn tokens(text: &str) -> Vec<TokenTree> {
    text.parse::<TokenStream>().expect("tokens").into_iter().map(placeless).collect()
}

fn placeless(mut token: TokenTree) -> TokenTree {
    if let TokenTree::Group(group) = &token {
        token = TokenTree::Group(Group::new(group.delimiter(), group.stream().into_iter().map(placeless).collect()));
    }
    token.set_span(Span::call_site());
    token
}

/// Mutates the tokens: at this level, or inside one of its groups.
fn mutate(tokens: &mut Vec<TokenTree>, words: &[TokenTree], draw: &mut Sequence) {
    let groups: Vec<usize> = (0..tokens.len()).filter(|i| matches!(tokens[*i], TokenTree::Group(_))).collect();
    if !groups.is_empty() && draw.below(8) > 0 {
        let place = *draw.pick(&groups);
        if let TokenTree::Group(group) = &tokens[place] {
            let mut inner: Vec<TokenTree> = group.stream().into_iter().collect();
            mutate(&mut inner, words, draw);
            tokens[place] = TokenTree::Group(Group::new(group.delimiter(), inner.into_iter().collect()));
        }
        return;
    }
    let place = draw.below(tokens.len() + 1);
    let Some(token) = tokens.get(place).cloned() else {
        tokens.push(draw.pick(words).clone());
        return;
    };
    match draw.below(12) {
        0 => drop(tokens.remove(place)),
        1 => tokens.insert(place, token),
        2 => {
            let other = draw.below(tokens.len());
            tokens.swap(place, other);
        }
        3 => tokens[place] = draw.pick(words).clone(),
        // Preserves the grammar: a name for a name, a number for a number, an operator for an operator.
        4..=8 => {
            let alike: Vec<&TokenTree> =
                words.iter().filter(|word| std::mem::discriminant(*word) == std::mem::discriminant(&token)).collect();
            if let Some(word) = alike.get(draw.below(alike.len())) {
                tokens[place] = (*word).clone();
            }
        }
        9 => tokens.insert(place, draw.pick(words).clone()),
        10 => {
            // Repeats a run of tokens elsewhere.
            let run: Vec<TokenTree> = tokens[place..tokens.len().min(place + 1 + draw.below(12))].to_vec();
            let target = draw.below(tokens.len());
            tokens.splice(target..target, run);
        }
        _ => tokens[place] = nested(token, draw),
    }
}

/// The token inside 1 to 200 pairs of delimiters, usually few.
fn nested(mut token: TokenTree, draw: &mut Sequence) -> TokenTree {
    let depth = if draw.below(10) == 0 { draw.below(200) } else { 1 + draw.below(4) };
    let delimiter = *draw.pick(&[Delimiter::Parenthesis, Delimiter::Parenthesis, Delimiter::Bracket, Delimiter::Brace]);
    for _ in 0..depth {
        token = TokenTree::Group(Group::new(delimiter, token.into()));
    }
    token
}

/// Random tokens, in the body of a system or bare.
fn unrelated(words: &[TokenTree], draw: &mut Sequence) -> Vec<TokenTree> {
    let mut some = |length: usize| -> Vec<TokenTree> {
        (0..length)
            .map(|_| {
                let word = draw.pick(words).clone();
                if draw.below(5) == 0 { nested(word, draw) } else { word }
            })
            .collect()
    };
    let inner = some(40);
    if draw.below(4) == 0 {
        return inner;
    }
    let mut system = tokens("struct S");
    system.push(TokenTree::Group(Group::new(Delimiter::Brace, inner.into_iter().collect())));
    system
}

#[test]
fn no_input_makes_the_compiler_panic() {
    let inputs = std::env::var("VI_INPUTS").map_or(INPUTS, |count| count.parse().expect("VI_INPUTS is a count"));
    let systems: Vec<Vec<TokenTree>> = SYSTEMS.iter().map(|text| tokens(text)).collect();
    let clauses: Vec<&str> = vi_codegen::clause::words().collect();
    let is_used = |clause: &&str| SYSTEMS.iter().any(|system| system.split(' ').any(|word| word == *clause));
    assert_eq!(clauses.iter().find(|clause| !is_used(clause)), None, "no system has it");
    let words = tokens(&format!("{} {WORDS}", clauses.join(" ")));
    let mut draw = Sequence(1);
    let (mut accepted, mut over_a_second, mut slowest) = (0, 0, (Duration::ZERO, String::new()));
    for input in 0..inputs {
        let drawn = if draw.below(20) == 0 {
            unrelated(&words, &mut draw)
        } else {
            let mut drawn = draw.pick(&systems).clone();
            (0..=draw.below(3)).for_each(|_| mutate(&mut drawn, &words, &mut draw));
            drawn
        };
        let stream: TokenStream = drawn.into_iter().collect();
        let start = Instant::now();
        let expanded = catch_unwind(AssertUnwindSafe(|| vi_codegen::expand(stream.clone())));
        let spent = start.elapsed();
        let expanded = expanded.unwrap_or_else(|_| panic!("input {input} makes it panic: {stream}"));
        over_a_second += u64::from(spent > Duration::from_secs(1));
        if spent > slowest.0 {
            slowest = (spent, stream.to_string());
        }
        let broken = expanded.to_string().contains("compile_error");
        accepted += u64::from(!broken);
        if !broken {
            let length = expanded.to_string().len();
            assert!(length < LONGEST, "input {input} becomes {length} characters: {stream}");
            assert!(syn::parse2::<syn::File>(expanded).is_ok(), "input {input} becomes no Rust: {stream}");
        }
        if input % 1000 == 999 {
            proc_macro2::extra::invalidate_current_thread_spans();
        }
    }
    println!(
        "{inputs} inputs, {accepted} accepted, {over_a_second} over a second; the slowest: {:?}\n{}",
        slowest.0, slowest.1
    );
    // Measured: 4.6 of 100.
    assert!(accepted * 50 > inputs, "{accepted} of {inputs} accepted: nothing much was tried");
}
