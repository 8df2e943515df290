//! Every name bound by emitted code is first the name of a function, so that no surrounding constant turns a binding
//! into a pattern.

use crate::families;
use std::collections::BTreeSet;
use syn::visit::{self, Visit};
use syn::{File, Item, ItemConst, PatIdent, UseRename};

/// The bound names, and the function names before them.
#[derive(Default)]
struct Names {
    bound: BTreeSet<String>,
    functions: BTreeSet<String>,
}

impl Visit<'_> for Names {
    fn visit_pat_ident(&mut self, pattern: &PatIdent) {
        self.bound.insert(pattern.ident.to_string());
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_use_rename(&mut self, renamed: &UseRename) {
        assert_eq!(renamed.ident, "identity");
        self.functions.insert(renamed.rename.to_string());
    }
}

fn names(system: &str) -> Names {
    let file: File = syn::parse2(vi_codegen::expand(system.parse().expect("tokens"))).expect("Rust");
    let scopes = file.items.iter().filter_map(|item| if let Item::Const(scope) = item { Some(scope) } else { None });
    let scopes: Vec<&ItemConst> = scopes.collect();
    assert_eq!(scopes.len(), 1, "one scope holds all implementations");
    for item in &file.items {
        assert!(!matches!(item, Item::Impl(_)), "an implementation outside the scope");
    }
    let mut names = Names::default();
    names.visit_item_const(scopes[0]);
    names
}

#[test]
fn every_binding_is_a_function_first() {
    let by_hand = [
        // Closed forms, a force, the time, rules of two points, matrices of every form.
        "struct A { param m = 1; coord x; L = m * dot(x)^2 / 2 - x^2; force x = -dot(x) + sin(t); discretize midpoint; }",
        "struct B { coord x, y; L = dot(x)^2 + dot(y)^2 * (2 + sin(t)) - cos(x - y) * tan(x); force y = -x; discretize trapezoidal; }",
        "struct C { coord q[5]; L = sum(i in 0..5, dot(q[i])^2) + sum(i in 0..5, sum(j in 0..i, dot(q[i]) * dot(q[j]) * cos(q[i] - q[j]))) / 9; discretize midpoint; }",
        "struct D { coord q[6]; L = sum(i in 0..6, dot(q[i])^2 * (2 + cos(q[i]))) - hypot(q[0] * q[1], q[2]) - abs(q[4] * q[5]); discretize midpoint; check { h = 1; } }",
        "struct E { coord x; L = dot(x)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h) + (t1 - t0)^2 * q1 * q0; } }",
    ];
    let families = [families::chain(3), families::chain(40), families::pendulum(3), families::pendulum(7)];
    let (mut all, mut in_loops, mut in_pieces) = (0, false, false);
    for system in by_hand.into_iter().map(str::to_owned).chain(families) {
        let Names { bound, functions } = names(&system);
        let missing: Vec<&String> = bound.difference(&functions).collect();
        assert!(missing.is_empty(), "{missing:?} of {system}");
        let unused: Vec<&String> = functions.difference(&bound).collect();
        assert!(unused.is_empty(), "{unused:?} are not bound in {system}");
        in_loops |= bound.contains("i") && bound.contains("sum");
        in_pieces |= bound.contains("inputs");
        all += bound.len();
    }
    assert!(all > 1000 && in_loops && in_pieces, "{all} names");
}
