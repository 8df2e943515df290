//! Substitution of symbols.
//!
//! In: an expression and replacements for some symbols. Out: the expression with all of them replaced simultaneously,
//! in canonical form: `(q1 - q0)/h` with `q1 = q0 + h*v` is `v`.

use std::hash::Hash;

use crate::{Expr, Node, Pool, Table};

impl<S: Clone + Eq + Hash> Pool<S> {
    /// `expr` with each symbol replaced by the result of the closure, called once per symbol; `None` keeps the symbol.
    /// Replacements are not substituted again.
    pub fn substitute(&mut self, expr: Expr, map: &mut dyn FnMut(&mut Self, &S) -> Option<Expr>) -> Expr {
        if self.is_exhausted() {
            return Expr::UNDEFINED;
        }
        // Changed nodes only.
        let mut changed: Table<Expr, Expr> = Table::default();
        for node in self.reachable(&[expr]) {
            let shared = self.shared_node(node);
            let new = if let Node::Symbol(symbol) = &*shared {
                map(self, symbol).unwrap_or(node)
            } else if shared.any_child(|child| changed.contains(child)) {
                self.rebuild(&shared, &|child| changed.get(child).copied().unwrap_or(child))
            } else {
                node
            };
            if new != node {
                changed.insert(node, new);
            }
        }
        changed.get(expr).copied().unwrap_or(expr)
    }

    /// `expr` with one of its parts replaced.
    pub fn replace(&mut self, expr: Expr, part: Expr, by: Expr) -> Expr {
        let mut changed: Table<Expr, Expr> = Table::default();
        changed.insert(part, by);
        for node in self.reachable(&[expr]) {
            let shared = self.shared_node(node);
            if node != part && shared.any_child(|child| changed.contains(child)) {
                let new = self.rebuild(&shared, &|child| changed.get(child).copied().unwrap_or(child));
                changed.insert(node, new);
            }
        }
        changed.get(expr).copied().unwrap_or(expr)
    }

    /// The same operation with other operands.
    pub(crate) fn rebuild(&mut self, node: &Node<S>, new: &dyn Fn(Expr) -> Expr) -> Expr {
        match node {
            Node::Number(value) => self.number(value.clone()),
            Node::Pi => self.pi(),
            Node::Symbol(symbol) => self.symbol(symbol.clone()),
            Node::Sum(sum) => {
                let constant = self.number(sum.constant.clone());
                let terms = sum.terms.iter().map(|(term, coefficient)| (new(*term), coefficient.clone()));
                self.combination(terms.chain([(constant, num_traits::One::one())]))
            }
            Node::Product(product) => {
                self.powers(product.factors.iter().map(|(base, exponent)| (new(*base), exponent.clone())))
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Expr> = arguments.iter().map(|argument| new(*argument)).collect();
                self.call(*function, &arguments)
            }
            Node::Opaque(function, arguments) => {
                let arguments = arguments.iter().map(|argument| new(*argument)).collect();
                self.opaque(function.clone(), arguments)
            }
            Node::Select([condition, then, otherwise]) => self.select(new(*condition), new(*then), new(*otherwise)),
        }
    }
}
