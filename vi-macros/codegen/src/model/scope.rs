//! The names that an expression may use, and their meanings.
//!
//! In: the declarations of a system, one by one. Out: the meaning of each name in expressions of the system or in lines
//! of a rule. A name has one meaning, and none before its declaration.

use super::array::Array;
use super::called::Called;
use super::closed::LetArray;
use super::point::Point;
use crate::messages::{Absence, FunctionMistake, Habit, Message, error, nearest, words};
use crate::symbol::{Symbol, Variable};
use proc_macro2::{Ident, Span};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use syn::Result;
use vi_expr::{Expr, Function, Pool};

/// Names reserved by the language, besides its functions.
const RESERVED: [&str; 8] = ["t", "pi", "L", "f", "self", "dot", "sum", "sqrt"];

/// The functions that select one of their arguments.
pub(super) const CHOICES: [&str; 3] = ["max", "min", "clamp"];

/// The functions of vectors and matrices. Their names are not reserved.
pub(super) const OF_VECTORS: [&str; 3] = ["cross", "norm", "transpose"];

/// Cost of comparing two names, besides comparing each pair of their letters.
const COMPARISON: usize = 16;

/// Maximum number of operations, calls and ranges around an expression, in the functions that call each other up to it.
/// One function has at most four of them in each of the 100 levels that the parser allows. They need 1.4 MB of stack in
/// an unoptimized build, and threads have 2 MB.
const NESTING: usize = 400;

/// The names that an expression may use.
pub(super) struct Scope {
    names: BTreeMap<String, Meaning>,
    /// Names that the system declares but that have no meaning yet.
    absent: BTreeMap<String, Absence>,
    /// Points at which the expressions of a rule evaluate L and f.
    points: Vec<Point>,
    /// Indices of the ranges around an expression.
    indices: Vec<String>,
    /// Functions of the language whose bodies are being evaluated, with the places of the calls.
    open: Vec<(String, Span)>,
    /// Arguments of the function whose body is being evaluated, with the meanings that they hide.
    bound: Vec<(String, Option<Meaning>)>,
    /// Declared functions that some expression has called; shared with the scopes of a rule and of a time scale.
    called: Rc<RefCell<BTreeSet<String>>>,
    /// The expressions around the one that is being evaluated, those of calling functions included.
    depth: usize,
    /// The array of `let`s whose entries are being defined.
    growing: Option<Growing>,
    /// Arrays of `let`s whose entries stay symbols; `None` if expressions replace them.
    pub(super) kept: Option<Vec<LetArray>>,
}

/// An array of `let`s whose entries are being defined.
pub(super) struct Growing {
    pub(super) name: String,
    /// The entry as written: `x[i]`.
    pub(super) entry: String,
    /// The indices of the entry.
    pub(super) at: Vec<i64>,
}

/// The meaning of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A parameter, constant, index or `let`, with its expression.
    Number(Expr),
    /// A vector, a matrix, or an array of parameters, constants or `let`s.
    Array(Array),
    /// Time, or a slot of a rule.
    Symbol(Symbol),
    /// π.
    Pi,
    /// A coordinate, by index.
    Coordinate(usize),
    /// An array of coordinates: the index of the first one, and the lengths.
    Coordinates { first: usize, lengths: Vec<usize> },
    /// The coordinates at an end of the interval.
    Vector(Vec<Symbol>),
    /// The function `dot`.
    Dot,
    /// L of time, coordinates and velocities.
    Lagrangian,
    /// f of time, coordinates and velocities, with this number of components.
    Force(usize),
    /// A declared function.
    Function(Called),
    /// A constraint, which has no value.
    Constraint,
    /// A quantity that depends on the state; in a rule it may only appear in arguments of L and f.
    OfState,
    /// A quantity that depends on velocities, which this clause cannot use.
    Moving(&'static str),
    /// A declaration with a reported error: it evaluates to 1, with or without an index.
    Wrong,
}

impl Scope {
    /// The built-in names in expressions of a system.
    pub(super) fn of_system() -> Self {
        let time = Meaning::Symbol(Symbol::Continuous(Variable::Time));
        Self::of([("t", time), ("pi", Meaning::Pi), ("dot", Meaning::Dot)])
    }

    /// The built-in names in the lines of a rule, for a system with `dimension` coordinates.
    pub(super) fn of_rule(dimension: usize) -> Self {
        Self::of([
            ("t0", Meaning::Symbol(Symbol::T0)),
            ("t1", Meaning::Symbol(Symbol::T1)),
            ("h", Meaning::Symbol(Symbol::Step)),
            ("q0", Meaning::Vector((0..dimension).map(Symbol::Q0).collect())),
            ("q1", Meaning::Vector((0..dimension).map(Symbol::Q1).collect())),
            ("pi", Meaning::Pi),
            ("L", Meaning::Lagrangian),
            ("f", Meaning::Force(dimension)),
        ])
    }

    fn of<const N: usize>(names: [(&str, Meaning); N]) -> Self {
        let names = names.into_iter().map(|(name, meaning)| (name.to_owned(), meaning)).collect();
        Self::with_names(names)
    }

    fn with_names(names: BTreeMap<String, Meaning>) -> Self {
        Self {
            names,
            absent: BTreeMap::new(),
            points: Vec::new(),
            indices: Vec::new(),
            open: Vec::new(),
            bound: Vec::new(),
            called: Rc::default(),
            growing: None,
            kept: None,
            depth: 0,
        }
    }

    /// Adds the declarations of a system. Names that already have a meaning keep it, as do numbers of constants and
    /// parameters.
    pub(super) fn with_constants_of(mut self, system: &Self, pool: &Pool<Symbol>) -> Self {
        let is_constant = |expr: &Expr| !pool.depends_on(*expr, &|symbol| !matches!(symbol, Symbol::Parameter { .. }));
        for (name, meaning) in &system.names {
            let meaning = match meaning {
                Meaning::Number(value) if is_constant(value) => meaning.clone(),
                Meaning::Array(array) if !array.any(&|expr| !is_constant(expr)) => meaning.clone(),
                Meaning::Pi | Meaning::Wrong | Meaning::Function(_) => meaning.clone(),
                _ => Meaning::OfState,
            };
            self.names.entry(name.clone()).or_insert(meaning);
        }
        self.called = Rc::clone(&system.called);
        self
    }

    /// The names that a clause without velocities may use.
    pub(super) fn without_velocities(&self, pool: &Pool<Symbol>, clause: &'static str) -> Self {
        let is_velocity = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
        let moves = |expr: &Expr| pool.depends_on(*expr, &is_velocity);
        let meaning = |meaning: &Meaning| match meaning {
            Meaning::Dot => Meaning::Moving(clause),
            Meaning::Number(value) if moves(value) => Meaning::Moving(clause),
            Meaning::Array(array) if array.any(&moves) => Meaning::Moving(clause),
            _ => meaning.clone(),
        };
        let names = self.names.iter().map(|(name, known)| (name.clone(), meaning(known))).collect();
        Self { called: Rc::clone(&self.called), ..Self::with_names(names) }
    }

    /// The name of an array of `let`s whose entries are symbols of an expression.
    pub(super) fn array_in(&self, pool: &Pool<Symbol>, expr: Expr) -> Option<String> {
        pool.symbols(expr).into_iter().find_map(|symbol| match symbol {
            Symbol::Let(entry) | Symbol::LetRate(entry) => Some(self.kept.as_ref()?.get(entry.array)?.name.clone()),
            _ => None,
        })
    }

    /// Gives the momenta their values in all names.
    pub(super) fn substitute_momenta(&mut self, pool: &mut Pool<Symbol>, momenta: &[Expr]) {
        let mut substituted = |expr: &mut Expr| {
            *expr = pool.substitute(*expr, &mut |_, symbol| match symbol {
                Symbol::Momentum(index) => momenta.get(*index).copied(),
                _ => None,
            });
        };
        for meaning in self.names.values_mut() {
            match meaning {
                Meaning::Number(value) => substituted(value),
                Meaning::Array(array) => array.each(&mut substituted),
                _ => {}
            }
        }
        self.kept.iter_mut().flatten().flat_map(|array| &mut array.definitions).for_each(substituted);
    }

    /// The number of an evaluation point; equal points have the same number.
    pub(super) fn point(&mut self, point: Point) -> usize {
        self.points.iter().position(|known| *known == point).unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        })
    }

    /// The evaluation points of L and f.
    pub(super) fn into_points(self) -> Vec<Point> {
        self.points
    }

    /// Registers names that the system declares, and why expressions cannot use them yet.
    pub(super) fn expect<'a>(&mut self, names: impl Iterator<Item = &'a Ident>, absence: Absence) {
        self.absent.extend(names.map(|name| (name.to_string(), absence)));
    }

    /// Why a declared name has no meaning here.
    pub(super) fn absence(&self, name: &str) -> Option<Absence> {
        self.absent.get(name).copied()
    }

    /// Adds a name.
    ///
    /// # Errors
    /// The name is reserved, or declared before.
    pub(super) fn declare(&mut self, name: &Ident, meaning: Meaning) -> Result<()> {
        let text = name.to_string();
        if RESERVED.contains(&text.as_str()) || Function::from_name(&text).is_some() {
            if ["L", "f"].contains(&text.as_str()) {
                // Expressions of a system contain neither `L` nor `f`, so a use refers to this declaration.
                self.names.entry(text.clone()).or_insert(Meaning::Wrong);
            }
            return Err(error(name.span(), &Message::Reserved { name: text }));
        }
        if self.names.contains_key(&text) {
            return Err(error(name.span(), &Message::Duplicate { name: text }));
        }
        self.names.insert(text, meaning);
        Ok(())
    }

    /// Adds the index of a range.
    ///
    /// # Errors
    /// As [`Self::declare`].
    pub(super) fn declare_index(&mut self, name: &Ident, meaning: Meaning) -> Result<()> {
        self.declare(name, meaning)?;
        self.indices.push(name.to_string());
        Ok(())
    }

    /// Removes an index after its range.
    pub(super) fn forget(&mut self, name: &str) {
        self.names.remove(name);
        self.indices.retain(|index| index != name);
    }

    /// Changes or removes the meaning of a name, and returns the previous one.
    pub(super) fn replace(&mut self, name: &str, meaning: Option<Meaning>) -> Option<Meaning> {
        match meaning {
            Some(meaning) => self.names.insert(name.to_owned(), meaning),
            None => self.names.remove(name),
        }
    }

    /// Gives the arguments of a function their meanings, and the names that are arguments of the calling function those
    /// outside of it. Returns what [`Scope::unbind`] needs.
    pub(super) fn bind(&mut self, arguments: Vec<(String, Meaning)>) -> [Vec<(String, Option<Meaning>)>; 2] {
        let of_caller = core::mem::take(&mut self.bound);
        let hidden = self.exchange(of_caller.iter().rev().cloned().collect());
        self.bound = self.exchange(arguments.into_iter().map(|(name, meaning)| (name, Some(meaning))).collect());
        [of_caller, hidden]
    }

    /// Restores the meanings before [`Scope::bind`].
    pub(super) fn unbind(&mut self, [of_caller, hidden]: [Vec<(String, Option<Meaning>)>; 2]) {
        let bound = core::mem::replace(&mut self.bound, of_caller);
        self.exchange(bound.into_iter().rev().collect());
        self.exchange(hidden.into_iter().rev().collect());
    }

    /// Replaces meanings one after the other, and returns those before.
    fn exchange(&mut self, names: Vec<(String, Option<Meaning>)>) -> Vec<(String, Option<Meaning>)> {
        let replaced = names.into_iter().map(|(name, meaning)| {
            let before = self.replace(&name, meaning);
            (name, before)
        });
        replaced.collect()
    }

    /// Begins the body of a function: hides and returns the indices of ranges around the call. `None` if the body is
    /// already being evaluated.
    pub(super) fn enter(&mut self, function: &Ident) -> Option<Vec<(String, Option<Meaning>)>> {
        let name = function.to_string();
        if self.open.iter().any(|(open, _)| *open == name) {
            return None;
        }
        self.open.push((name, function.span()));
        let indices = core::mem::take(&mut self.indices);
        Some(indices.into_iter().map(|index| (index.clone(), self.names.remove(&index))).collect())
    }

    /// Ends the body of a function: shows the indices again.
    pub(super) fn leave(&mut self, indices: Vec<(String, Option<Meaning>)>) {
        self.open.pop();
        for (index, meaning) in indices {
            self.replace(&index, meaning);
            self.indices.push(index);
        }
    }

    /// Begins an expression that is `levels` deeper than those around it.
    ///
    /// # Errors
    /// Functions in the bodies of functions are too deep, at the last call: evaluation recurses.
    pub(super) fn deepen(&mut self, levels: usize, span: Span) -> Result<()> {
        if self.depth + levels > NESTING {
            let call = self.open.last().map_or(span, |(_, call)| *call);
            return Err(error(call, &Message::Function(FunctionMistake::TooDeep { limit: NESTING })));
        }
        self.depth += levels;
        Ok(())
    }

    /// Ends an expression that is `levels` deeper than those around it.
    pub(super) fn rise(&mut self, levels: usize) {
        self.depth -= levels;
    }

    /// Records that an expression has called a declared function.
    pub(super) fn record_call(&mut self, function: &str) {
        self.called.borrow_mut().insert(function.to_owned());
    }

    /// Whether an expression has called a declared function.
    pub(super) fn was_called(&self, function: &str) -> bool {
        self.called.borrow().contains(function)
    }

    /// Changes the meaning of a declared name: the next value of an index.
    pub(super) fn set(&mut self, name: &str, meaning: Meaning) {
        if let Some(known) = self.names.get_mut(name) {
            *known = meaning;
        }
    }

    /// The array with this name, to add entries to it.
    pub(super) fn array_mut(&mut self, name: &str) -> Option<&mut Array> {
        match self.names.get_mut(name) {
            Some(Meaning::Array(array)) => Some(array),
            _ => None,
        }
    }

    /// Sets the array whose entries are being defined.
    pub(super) fn grow(&mut self, growing: Option<Growing>) {
        self.growing = growing;
    }

    /// Sets the indices of the entry that is being defined.
    pub(super) fn grow_at(&mut self, at: Vec<i64>) {
        if let Some(growing) = &mut self.growing {
            growing.at = at;
        }
    }

    /// The entry that is being defined, if it belongs to the array with this name.
    pub(super) fn growing(&self, name: &str) -> Option<&Growing> {
        self.growing.as_ref().filter(|growing| growing.name == name)
    }

    /// What a name stands for.
    pub(super) fn meaning(&self, name: &str) -> Option<&Meaning> {
        self.names.get(name)
    }

    /// Whether a name is a coordinate, or an array of them.
    pub(super) fn is_coordinate(&self, name: &str) -> bool {
        matches!(self.meaning(name), Some(Meaning::Coordinate(_) | Meaning::Coordinates { .. }))
    }

    /// The coordinate in the name of a velocity: `x` of `xdot`, `x_dot`, `dot_x`, `v_x`, `vx`, `dx` and `ẋ`; `q[…]` of
    /// an array.
    pub(super) fn coordinate_of_velocity(&self, name: &str) -> Option<String> {
        let undotted = words::without_dots(name, 1);
        let behind = ["_dot", "dot"].into_iter().filter_map(|ending| name.strip_suffix(ending));
        let before = ["dot_", "dot", "v_", "v", "d_", "d"];
        let before = before.into_iter().filter_map(|beginning| name.strip_prefix(beginning));
        behind.chain(before).chain(undotted.as_deref()).find_map(|stem| self.coordinate(stem))
    }

    /// The coordinate in the name of an acceleration: `x` of `xddot`, `x_ddot`, `x_tt` and `ẍ`.
    pub(super) fn coordinate_of_acceleration(&self, name: &str) -> Option<String> {
        let undotted = words::without_dots(name, 2);
        let behind = ["_ddot", "ddot", "_tt"].into_iter().filter_map(|ending| name.strip_suffix(ending));
        behind.chain(undotted.as_deref()).find_map(|stem| self.coordinate(stem))
    }

    /// The coordinate with this name, Greek letters as such or spelt out; `q[…]` of an array.
    fn coordinate(&self, name: &str) -> Option<String> {
        let other = words::other_alphabet(name);
        [Some(name), other.as_deref()].into_iter().flatten().find_map(|name| match self.meaning(name) {
            Some(Meaning::Coordinate(_)) => Some(name.to_owned()),
            Some(Meaning::Coordinates { .. }) => Some(format!("{name}[…]")),
            _ => None,
        })
    }

    /// The notation behind an undeclared name: a velocity, or a function or product without its signs.
    pub(super) fn habit(&self, name: &str) -> Option<Habit> {
        let text = name.to_owned();
        if let Some(coordinate) = self.coordinate_of_velocity(name) {
            return Some(Habit::VelocityByName { name: text, coordinate });
        }
        if name == "v" {
            return self.first_coordinate().map(|coordinate| Habit::Velocity { coordinate });
        }
        if name.contains('·') {
            return Some(Habit::ProductInName { product: text.replace('·', " * "), name: text });
        }
        let functions = Function::ALL.into_iter().map(Function::name).chain(["sqrt"]);
        let arguments = functions.filter_map(|function| Some((function, name.strip_prefix(function)?)));
        let mut glued = arguments.filter(|(_, argument)| self.is_declared(argument));
        if let Some((function, argument)) = glued.next() {
            let function = function.to_owned();
            return Some(Habit::FunctionInName { name: text, function, argument: argument.to_owned() });
        }
        self.factors(name).map(|factors| Habit::ProductInName { name: text, product: factors.join(" * ") })
    }

    /// The alphabetically first coordinate, for an example.
    fn first_coordinate(&self) -> Option<String> {
        self.names.keys().find_map(|name| self.coordinate(name))
    }

    /// Whether a name was declared; built-in names were not.
    pub(super) fn is_declared(&self, name: &str) -> bool {
        !RESERVED.contains(&name) && self.names.contains_key(name)
    }

    /// Two or more declared one-letter names that form this name, each once: a repetition is a typing error.
    fn factors(&self, name: &str) -> Option<Vec<String>> {
        let letters: Vec<String> = name.chars().map(String::from).collect();
        let is_once = |(before, letter): (usize, &String)| !letters[..before].contains(letter);
        let fits = letters.iter().all(|letter| self.is_declared(letter)) && letters.iter().enumerate().all(is_once);
        (letters.len() > 1 && fits).then_some(letters)
    }

    /// The declared name nearest to a misspelt one.
    pub(super) fn near(&self, pool: &Pool<Symbol>, name: &str) -> Option<String> {
        let is_no_value = |meaning: &Meaning| {
            matches!(meaning, Meaning::OfState | Meaning::Moving(_) | Meaning::Dot | Meaning::Constraint)
        };
        let is_meant = |known: &str| !self.meaning(known).is_some_and(is_no_value);
        let other = words::other_alphabet(name).filter(|other| self.names.contains_key(other) && is_meant(other));
        other.or_else(|| self.near_of(pool, name, is_meant))
    }

    /// The functions of the language, and those of this scope only.
    pub(super) fn functions(&self) -> impl Iterator<Item = &str> + '_ {
        let own = self.names.iter().filter_map(|(name, meaning)| -> Option<&str> {
            match meaning {
                Meaning::Function(_) => Some(name.as_str()),
                Meaning::Dot => Some("dot"),
                Meaning::Lagrangian => Some("L"),
                Meaning::Force(_) => Some("f"),
                _ => None,
            }
        });
        own.chain(Function::ALL.into_iter().map(|function| -> &str { function.name() }))
            .chain(["sqrt", "sum"])
            .chain(CHOICES)
            .chain(OF_VECTORS)
    }

    /// The nearest declared name that satisfies `is_meant`.
    pub(super) fn near_of(&self, pool: &Pool<Symbol>, name: &str, is_meant: impl Fn(&str) -> bool) -> Option<String> {
        pool.spend(self.names.len() * (COMPARISON + name.len() * name.len()));
        let known = self.names.keys().map(String::as_str).filter(|known| is_meant(known));
        if pool.is_exhausted() { None } else { nearest(name, known) }
    }
}
