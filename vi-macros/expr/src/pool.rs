//! The pool, which stores every expression once.
//!
//! In: canonical nodes from the constructors of this crate. Out: handles; equal nodes have equal handles.
//!
//! A node in the pool never changes, and its children have smaller handles. So every pass is a loop over
//! [`Pool::reachable`] in ascending order, and deep nesting does not exhaust the stack.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::hash::Hash;
use std::sync::Arc;

use num_bigint::BigInt;
use num_traits::{One, Zero};

use crate::ball::Ball;
use crate::effort::{KEPT, MADE};
use crate::{Distinct, Expr, Node, Product, Rational, Table};

/// Owner of expressions over symbols of type `S`.
#[derive(Clone, Debug)]
pub struct Pool<S> {
    nodes: Distinct<Arc<Node<S>>>,
    /// Whether each node has neither symbols nor opaque functions.
    pub(crate) constant: Vec<bool>,
    /// Some node is constant but not an exact number.
    pub(crate) has_irrational: bool,
    /// Some product has the square of a sine or cosine, circular or hyperbolic.
    pub(crate) has_squares: bool,
    /// Values of constant nodes, with their precision in bits.
    pub(crate) balls: RefCell<Table<Expr, (u64, Ball)>>,
    /// Work limit, and the remaining work.
    pub(crate) limit: usize,
    pub(crate) left: Cell<usize>,
}

impl<S: Clone + Eq + Hash> Default for Pool<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// A pool with the three common expressions: 0, 1 and the undefined one. Its work is unlimited.
    #[must_use]
    pub fn new() -> Self {
        let mut pool = Self {
            nodes: Distinct::default(),
            constant: Vec::new(),
            has_irrational: false,
            has_squares: false,
            balls: RefCell::default(),
            limit: usize::MAX,
            left: Cell::new(usize::MAX),
        };
        pool.intern(Node::Number(Rational::zero()));
        pool.intern(Node::Number(Rational::one()));
        pool.intern(Node::Product(Product { factors: vec![(Expr::ZERO, -Rational::one())] }));
        pool.has_irrational = false;
        pool
    }

    /// The number 0.
    #[must_use]
    pub fn zero(&self) -> Expr {
        Expr::ZERO
    }

    /// The number 1.
    #[must_use]
    pub fn one(&self) -> Expr {
        Expr::ONE
    }

    /// The expression without a value, written `1/0`: the result of division by the exact number 0, `ln(0)`, the square
    /// root of a negative number. It is absorbing: every sum, product (even with 0), power, function and derivative of
    /// it is again this expression, so that a mistake cannot disappear. It evaluates to NaN.
    #[must_use]
    pub fn undefined(&self) -> Expr {
        Expr::UNDEFINED
    }

    /// Exact number.
    pub fn number(&mut self, value: Rational) -> Expr {
        self.intern(Node::Number(value))
    }

    /// Exact integer.
    pub fn integer(&mut self, value: i64) -> Expr {
        self.number(Rational::from_integer(BigInt::from(value)))
    }

    /// The circle constant, exact until it is evaluated.
    pub fn pi(&mut self) -> Expr {
        self.intern(Node::Pi)
    }

    /// Symbol.
    pub fn symbol(&mut self, symbol: S) -> Expr {
        self.intern(Node::Symbol(symbol))
    }

    /// The node of a handle.
    ///
    /// # Panics
    /// If the handle is of another, larger pool.
    #[must_use]
    pub fn node(&self, expr: Expr) -> &Node<S> {
        &self.nodes[expr.0]
    }

    /// The value of an exact number.
    #[must_use]
    pub fn as_number(&self, expr: Expr) -> Option<&Rational> {
        match self.node(expr) {
            Node::Number(value) => Some(value),
            _ => None,
        }
    }

    /// Whether the expression is the number 0.
    #[must_use]
    pub fn is_zero(&self, expr: Expr) -> bool {
        expr == Expr::ZERO
    }

    /// Whether the expression is [`Pool::undefined`].
    #[must_use]
    pub fn is_undefined(&self, expr: Expr) -> bool {
        expr == Expr::UNDEFINED
    }

    /// Number of nodes in the pool.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "no pool is empty")]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// All nodes of the given expressions, each once, children before parents.
    #[must_use]
    pub fn reachable(&self, exprs: &[Expr]) -> Vec<Expr> {
        self.visited(exprs, 1)
    }

    /// All nodes of the given expressions as [`Pool::reachable`], for a pass that spends `work` on each operand.
    pub(crate) fn visited(&self, exprs: &[Expr], work: usize) -> Vec<Expr> {
        if self.is_exhausted() {
            return Vec::new();
        }
        let mut open = Open::new(exprs);
        let (mut found, mut operands) = (Vec::new(), 1);
        while let Some(expr) = open.take_newest() {
            found.push(expr);
            let node = self.node(expr);
            operands += 1 + node.operands();
            node.each_child(|child| open.insert(child));
        }
        self.spend(work * operands);
        found.reverse();
        found
    }

    /// The symbols in an expression.
    #[must_use]
    pub fn symbols(&self, expr: Expr) -> BTreeSet<S>
    where
        S: Ord,
    {
        self.symbols_of(&[expr])
    }

    /// The symbols in some expressions.
    #[must_use]
    pub fn symbols_of(&self, exprs: &[Expr]) -> BTreeSet<S>
    where
        S: Ord,
    {
        self.reachable(exprs).into_iter().filter_map(|expr| self.as_symbol(expr)).cloned().collect()
    }

    /// Whether the expression contains a symbol that satisfies `kind`.
    #[must_use]
    pub fn depends_on(&self, expr: Expr, kind: &dyn Fn(&S) -> bool) -> bool {
        self.reachable(&[expr]).into_iter().filter_map(|expr| self.as_symbol(expr)).any(kind)
    }

    /// The symbol, if the expression is one.
    #[must_use]
    pub fn as_symbol(&self, expr: Expr) -> Option<&S> {
        match self.node(expr) {
            Node::Symbol(symbol) => Some(symbol),
            _ => None,
        }
    }

    /// The node, readable while the pool grows.
    pub(crate) fn shared_node(&self, expr: Expr) -> Arc<Node<S>> {
        Arc::clone(&self.nodes[expr.0])
    }

    /// Handle of a node that is already canonical.
    pub(crate) fn intern(&mut self, node: Node<S>) -> Expr {
        let operands = 1 + node.operands();
        self.spend(MADE * operands);
        if self.is_exhausted() {
            return Expr::UNDEFINED;
        }
        if let Some(known) = self.nodes.get_index_of(&node) {
            return Expr(known);
        }
        self.spend(KEPT * operands);
        let constant =
            !matches!(node, Node::Symbol(_) | Node::Opaque(..)) && !node.any_child(|child| !self.constant[child.0]);
        self.constant.push(constant);
        if let Node::Product(product) = &node {
            self.has_squares = self.has_squares || product.factors.iter().any(|factor| self.is_square(factor));
        }
        self.has_irrational |= constant && !matches!(node, Node::Number(_));
        Expr(self.nodes.insert_full(Arc::new(node)).0)
    }
}

/// Expressions still to be visited, newest first. A bitmap with one summary bit per word needs no search and no sort,
/// and finds few expressions as fast in a large pool as in a small one.
struct Open {
    words: Vec<u64>,
    /// Summary: which words have a bit.
    filled: Vec<u64>,
    /// No summary word from here on has a bit.
    end: usize,
}

impl Open {
    fn new(exprs: &[Expr]) -> Self {
        let words = exprs.iter().max().map_or(0, |newest| newest.0 / 64 + 1);
        let end = words.div_ceil(64);
        let mut open = Self { words: vec![0; words], filled: vec![0; end], end };
        for expr in exprs {
            open.insert(*expr);
        }
        open
    }

    /// Adds an expression that is not newer than the initial ones.
    fn insert(&mut self, expr: Expr) {
        let word = expr.0 / 64;
        self.words[word] |= 1 << (expr.0 % 64);
        self.filled[word / 64] |= 1 << (word % 64);
    }

    fn take_newest(&mut self) -> Option<Expr> {
        while self.end > 0 {
            let filled = &mut self.filled[self.end - 1];
            let Some(last) = filled.checked_ilog2() else {
                self.end -= 1;
                continue;
            };
            let place = 64 * (self.end - 1) + last as usize;
            let word = &mut self.words[place];
            if let Some(bit) = word.checked_ilog2() {
                *word ^= 1 << bit;
                return Some(Expr(64 * place + bit as usize));
            }
            *filled ^= 1 << last;
        }
        None
    }
}
