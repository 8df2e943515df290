//! The symbols in the compiler's expressions.
//!
//! One type serves all stages; the symbols show the stage of an expression. A [`Model`](crate::model::Model) contains
//! time, coordinates, velocities and parameters. A rule adds slots and fields. A program contains the evaluation points
//! of fields and no field.

/// A variable of L(t, q, v) and f(t, q, v).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Variable {
    /// Time t.
    Time,
    /// Coordinate q_i.
    Coordinate(usize),
    /// Velocity v_i.
    Velocity(usize),
}

/// A quantity that a rule evaluates as a whole: the Lagrangian, or one component of the force.
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
    /// The variables of differentiation, in ascending order; empty for the quantity itself.
    pub derivatives: Vec<Variable>,
    /// The evaluation point: index into the points of the rule.
    pub point: usize,
}

/// An entry of an array of `let`s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LetEntry {
    /// The array, in the order of declaration.
    pub array: usize,
    /// The number of the entry, row by row.
    pub entry: usize,
}

/// A symbol of the compiler.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Symbol {
    /// Runtime parameter: its index, and the index of the first entry of its array, if any.
    Parameter {
        /// Index among all parameters.
        index: usize,
        /// Index of the first entry of the array.
        array: Option<usize>,
    },
    /// Variable of the continuous system.
    Continuous(Variable),
    /// An entry of an array of `let`s that a large system computes in a loop.
    Let(LetEntry),
    /// The rate of such an entry.
    LetRate(LetEntry),
    /// A number that the body of a loop reads; the index is its place in the list of these numbers.
    Access(usize),
    /// Momentum p_i; appears in a Hamiltonian only.
    Momentum(usize),
    /// Acceleration a_i; appears in the step density only.
    Acceleration(usize),
    /// Multiplier of a constraint; appears in the derivatives of the reaction only.
    Multiplier(usize),
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
    /// Velocity of the step, v = (q1 − q0)/h, component i; with h the unknowns of a step.
    StepVelocity(usize),
    /// Momentum p0 at the start, component i.
    P0(usize),
    /// Discrete energy E0 at the start.
    E0,
    /// The rounding error of a carried quantity: of `T0`, `Q0`, `P0` or `E0`.
    Low(Box<Symbol>),
    /// A field of the rule.
    Field(Field),
    /// Variable of the continuous system, evaluated at a point of the rule.
    AtPoint(usize, Variable),
}

impl Symbol {
    /// Component 0 of the vector of this component, and the index of this component.
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
            Self::Momentum(index) => Some((Self::Momentum(0), *index)),
            Self::StepVelocity(index) => Some((Self::StepVelocity(0), *index)),
            Self::Multiplier(index) => Some((Self::Multiplier(0), *index)),
            Self::Acceleration(index) => Some((Self::Acceleration(0), *index)),
            Self::Continuous(variable) => of_variable(variable).map(|(of, index)| (Self::Continuous(of), index)),
            Self::AtPoint(point, variable) => {
                of_variable(variable).map(|(of, index)| (Self::AtPoint(*point, of), index))
            }
            Self::Low(of) => of.component().map(|(of, index)| (Self::Low(Box::new(of)), index)),
            Self::Parameter { index, array } => {
                array.map(|first| (Self::Parameter { index: first, array: Some(first) }, index - first))
            }
            Self::T0
            | Self::T1
            | Self::Step
            | Self::E0
            | Self::Field(_)
            | Self::Let(_)
            | Self::LetRate(_)
            | Self::Access(_) => None,
        }
    }
}
