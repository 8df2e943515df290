//! Identifiers for the inputs of a function.
//!
//! In: the symbols that a function reads. Out: identifiers made of the user's names: `x`, `x_dot`, `x0`, `x1`, `p0_x`,
//! `x_mid`. A trailing underscore resolves a clash, so user names cannot collide.

use super::formula::item_name;
use crate::model::Model;
use crate::symbol::{Symbol, Variable};
use proc_macro2::Ident;
use quote::format_ident;
use std::collections::{BTreeMap, BTreeSet};

/// Names of one function.
pub(super) struct Names<'a> {
    model: &'a Model,
    points: usize,
    given: BTreeMap<Symbol, Ident>,
    taken: BTreeSet<String>,
    shared: usize,
}

/// Names used by the printed code itself.
const TAKEN: [&str; 11] =
    ["real", "self", "system", "inputs", "values", "node", "interval", "mass", "applied", "entries", "T"];

impl<'a> Names<'a> {
    /// Names for a function of a system whose rule has `points` points.
    pub(super) fn new(model: &'a Model, points: usize) -> Self {
        let functions = model.functions.iter().map(|function| item_name(&function.name.to_string()).to_string());
        let taken = TAKEN.iter().map(|&name| name.to_owned()).chain(functions).collect();
        Self { model, points, given: BTreeMap::new(), taken, shared: 0 }
    }

    /// The identifier of a symbol; the same for each call.
    pub(super) fn of(&mut self, symbol: &Symbol) -> Ident {
        if let Some(known) = self.given.get(symbol) {
            return known.clone();
        }
        let wanted = self.wanted(symbol);
        let ident = self.free(wanted);
        self.given.insert(symbol.clone(), ident.clone());
        ident
    }

    /// The identifier of the vector with this component 0: `q0`, `p0_low`, `q_mid`.
    pub(super) fn vector(&mut self, symbol: &Symbol) -> Ident {
        let name = self.vector_name(symbol);
        self.free(name)
    }

    fn vector_name(&self, symbol: &Symbol) -> String {
        match symbol {
            Symbol::Q0(_) => "q0".to_owned(),
            Symbol::Q1(_) => "q1".to_owned(),
            Symbol::P0(_) => "p0".to_owned(),
            Symbol::Acceleration(_) => "a".to_owned(),
            Symbol::Multiplier(_) => "lambda".to_owned(),
            Symbol::Low(of) => format!("{}_low", self.vector_name(of)),
            Symbol::AtPoint(point, variable) => {
                let variable = self.vector_name(&Symbol::Continuous(*variable));
                self.at_point(&variable, *point)
            }
            Symbol::Continuous(Variable::Coordinate(_)) => "q".to_owned(),
            Symbol::Parameter { index, .. } => self.model.parameters[*index].name.to_string(),
            // Only velocities remain.
            _ => "v".to_owned(),
        }
    }

    /// `x_mid`; `x_at2` for a rule with several points.
    fn at_point(&self, variable: &str, point: usize) -> String {
        if self.points == 1 { format!("{variable}_mid") } else { format!("{variable}_at{}", point + 1) }
    }

    /// The counter of a loop.
    pub(super) fn counter(&mut self) -> Ident {
        self.free("i".to_owned())
    }

    /// The identifier of the next shared term.
    pub(super) fn next_shared(&mut self) -> Ident {
        self.shared += 1;
        self.free(format!("s{}", self.shared))
    }

    /// The identifiers of sine and cosine of the next shared angle.
    pub(super) fn next_sine(&mut self) -> (Ident, Ident) {
        self.shared += 1;
        (self.free(format!("sin{}", self.shared)), self.free(format!("cos{}", self.shared)))
    }

    /// The identifier of a piece of the function.
    pub(super) fn piece(&mut self, function: &str, number: usize) -> Ident {
        self.free(format!("{function}_part_{number}"))
    }

    fn free(&mut self, mut wanted: String) -> Ident {
        while !self.taken.insert(wanted.clone()) {
            wanted.push('_');
        }
        format_ident!("{wanted}")
    }

    fn wanted(&self, symbol: &Symbol) -> String {
        let coordinate = |index: &usize| self.model.coordinates[*index].ident();
        match symbol {
            Symbol::Parameter { index, .. } => self.model.parameters[*index].ident(),
            Symbol::Continuous(Variable::Time) => "t".to_owned(),
            Symbol::Continuous(Variable::Coordinate(index)) => coordinate(index),
            Symbol::Continuous(Variable::Velocity(index)) | Symbol::StepVelocity(index) => {
                format!("{}_dot", coordinate(index))
            }
            Symbol::Momentum(index) => format!("p_{}", coordinate(index)),
            Symbol::Acceleration(index) => format!("{}_ddot", coordinate(index)),
            Symbol::Multiplier(index) => format!("lambda_{}", self.model.constraints[*index].ident()),
            Symbol::T0 => "t0".to_owned(),
            Symbol::T1 => "t1".to_owned(),
            Symbol::Step => "h".to_owned(),
            Symbol::E0 => "energy0".to_owned(),
            Symbol::Q0(index) => slot(&coordinate(index), 0),
            Symbol::Q1(index) => slot(&coordinate(index), 1),
            Symbol::P0(index) => format!("p0_{}", coordinate(index)),
            Symbol::Low(of) => format!("{}_low", self.wanted(of)),
            Symbol::AtPoint(point, variable) => {
                let variable = self.wanted(&Symbol::Continuous(*variable));
                self.at_point(&variable, *point)
            }
            Symbol::Field(_) => "field".to_owned(),
            Symbol::Access(place) => format!("a{place}"),
            // Loops replace these symbols by array accesses.
            Symbol::Let(_) | Symbol::LetRate(_) => "entry".to_owned(),
        }
    }
}

/// `x0`, `x1`; for a coordinate that ends in a digit `θ1_0`, `θ1_1`.
fn slot(coordinate: &str, end: u8) -> String {
    let separator = if coordinate.ends_with(|last: char| last.is_ascii_digit()) { "_" } else { "" };
    format!("{coordinate}{separator}{end}")
}
