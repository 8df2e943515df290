//! The symbols that expressions of the compiler are made of.
//!
//! One type for all stages, so that an expression says by its symbols which stage it belongs to:
//! a [`Model`](crate::model::Model) knows time, coordinates, velocities and parameters; a rule adds the slots and the
//! fields; a program knows the points at which fields are evaluated, and no field any more.

/// A variable of L(t, q, v) and f(t, q, v), by which they are differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Variable {
    /// Time t.
    Time,
    /// Coordinate q_i.
    Coordinate(usize),
    /// Velocity v_i.
    Velocity(usize),
}

/// What a rule evaluates without looking inside: the Lagrangian, or one component of the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// L.
    Lagrangian,
    /// f_i.
    Force(usize),
}

/// A partial derivative of a quantity at a point of the rule.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Field {
    /// L or f_i.
    pub quantity: Quantity,
    /// By what it is differentiated, in ascending order; empty: the quantity itself.
    pub derivatives: Vec<Variable>,
    /// Where it is evaluated: index into the points of the rule.
    pub point: usize,
}

/// A symbol of the compiler.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Symbol {
    /// Runtime parameter, by index, and the index of the first one of its array, if it is in one.
    Parameter {
        /// Among all parameters.
        index: usize,
        /// That of the first entry of the array.
        array: Option<usize>,
    },
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

impl Symbol {
    /// The component 0 of the vector that it is a component of, and which it is.
    #[must_use]
    pub fn component(&self) -> Option<(Self, usize)> {
        let of_variable = |variable: &Variable| match variable {
            Variable::Time => None,
            Variable::Coordinate(index) => Some((Variable::Coordinate(0), *index)),
            Variable::Velocity(index) => Some((Variable::Velocity(0), *index)),
        };
        match self {
            Self::Q0(index) => Some((Self::Q0(0), *index)),
            Self::Q1(index) => Some((Self::Q1(0), *index)),
            Self::P0(index) => Some((Self::P0(0), *index)),
            Self::StepVelocity(index) => Some((Self::StepVelocity(0), *index)),
            Self::Acceleration(index) => Some((Self::Acceleration(0), *index)),
            Self::Continuous(variable) => of_variable(variable).map(|(of, index)| (Self::Continuous(of), index)),
            Self::AtPoint(point, variable) => {
                of_variable(variable).map(|(of, index)| (Self::AtPoint(*point, of), index))
            }
            Self::Low(of) => of.component().map(|(of, index)| (Self::Low(Box::new(of)), index)),
            Self::Parameter { index, array } => {
                array.map(|first| (Self::Parameter { index: first, array: Some(first) }, index - first))
            }
            Self::T0 | Self::T1 | Self::Step | Self::E0 | Self::Field(_) => None,
        }
    }
}
