//! The symbols that expressions of the compiler are made of.
//!
//! One type for all stages, so that an expression says by its symbols which stage it belongs to:
//! a [`Model`](crate::model::Model) knows time, coordinates, velocities and parameters; a rule adds the slots and the
//! fields; a program knows the points at which fields are evaluated, and no field any more.

/// A variable of L(t, q, v) and f(t, q, v), by which they are differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// Time t.
    Time,
    /// Coordinate q_i.
    Coordinate(usize),
    /// Velocity v_i.
    Velocity(usize),
}

/// What a rule evaluates without looking inside: the Lagrangian, or one component of the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// L.
    Lagrangian,
    /// f_i.
    Force(usize),
}

/// A partial derivative of a quantity at a point of the rule.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Field {
    /// L or f_i.
    pub quantity: Quantity,
    /// By what it is differentiated, in ascending order; empty: the quantity itself.
    pub derivatives: Vec<Variable>,
    /// Where it is evaluated: index into the points of the rule.
    pub point: usize,
}

/// A symbol of the compiler.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Symbol {
    /// Runtime parameter, by index.
    Parameter(usize),
    /// Variable of the continuous system.
    Continuous(Variable),
    /// Acceleration a_i; appears in the step density only.
    Acceleration(usize),
    /// Slot t0, the time at the start of the interval.
    T0,
    /// Slot q0, component i.
    Q0(usize),
    /// Slot t1.
    T1,
    /// Slot q1, component i.
    Q1(usize),
    /// Step h = t1 − t0.
    Step,
    /// Velocity of the step, v = (q1 − q0)/h, component i: with h the unknown of a step.
    StepVelocity(usize),
    /// Momentum p0 at the start, component i.
    P0(usize),
    /// Discrete energy E0 at the start.
    E0,
    /// What rounding took from a carried quantity: one of `T0`, `Q0`, `P0`, `E0`.
    Low(Box<Symbol>),
    /// A field of the rule.
    Field(Field),
    /// Variable of the continuous system, evaluated at a point of the rule.
    AtPoint(usize, Variable),
}
