//! Mistakes with constraints.
//!
//! In: the names and expressions found. Out: a message with the error and its correction.

/// A mistake with constraints. The fields of a variant are the words that its text names.
#[allow(missing_docs)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConstraintMistake {
    /// A constraint without a name.
    NoName,
    /// `constraint rod = a = b;`
    Equation,
    /// `constraint rod: a = b;`
    Colon { name: String },
    /// `constraint floor = y > 0;`
    Inequality,
    /// A constraint declared twice.
    Twice { name: String },
    /// A constraint without a coordinate and a velocity.
    Constant { name: String },
    /// As many constraints as coordinates, or more, which leave no motion.
    TooMany { count: usize, size: usize },
    /// A constraint that is a multiple of an earlier one.
    Same { name: String, other: String },
    /// A constraint that follows from earlier ones.
    Dependent { name: String },
    /// A term that is not linear in the velocities.
    Nonlinear,
    /// A constraint on velocities that is the derivative of this function.
    Integrable { name: String, function: String },
    /// A constraint that has a jump or a kink at the border of this condition.
    Jump { name: String, condition: String },
    /// A constraint with a linear table.
    LinearTable { name: String, table: String },
    /// A force on a constraint.
    Force { name: String },
    /// A force of three components on a rotation.
    ForceOnRotation { name: String },
    /// The name of a constraint in an expression.
    Value { name: String },
    /// `reaction(…)` in an expression.
    Reaction,
    /// A torque on a name that is not a rotation.
    Torque { name: String },
    /// A torque on a whole array of rotations.
    TorqueIndex { name: String },
    /// A second torque on one rotation.
    SecondTorque { name: String },
    /// A clause that a system with constraints cannot have.
    Clause { clause: &'static str },
}

impl ConstraintMistake {
    /// What is wrong.
    #[must_use]
    pub fn what(&self) -> String {
        match self {
            Self::NoName => "this constraint has no name".to_owned(),
            Self::Equation => "a constraint is one expression, which is 0".to_owned(),
            Self::Colon { .. } => "a colon does not define a constraint".to_owned(),
            Self::Inequality => "inequalities are not supported as constraints".to_owned(),
            Self::Twice { name } => format!("the constraint `{name}` is declared twice"),
            Self::Constant { name } => format!("the constraint `{name}` contains no coordinate"),
            Self::TooMany { count, size } => {
                format!("{count} constraint(s) on {size} coordinate(s) leave no motion")
            }
            Self::Same { name, other } => format!("the constraint `{name}` repeats `{other}` up to a factor"),
            Self::Dependent { name } => format!("the constraint `{name}` follows from those before it"),
            Self::Nonlinear => "a constraint must be linear in the velocities".to_owned(),
            Self::Integrable { name, function } => {
                format!("the constraint `{name}` is the time derivative of `{function}`")
            }
            Self::Jump { name, condition } => {
                format!("the constraint `{name}` has a jump or a kink where `{condition}` is zero")
            }
            Self::LinearTable { name, table } => {
                format!("the constraint `{name}` has a kink at each place of the linear table `{table}`")
            }
            Self::Force { name } => format!("`{name}` has a force but is a constraint"),
            Self::ForceOnRotation { name } => {
                format!("`{name}` is a rotation of four components, and this force has three")
            }
            Self::Value { name } => format!("`{name}` is a constraint, not a number"),
            Self::Reaction => "an expression cannot contain a reaction".to_owned(),
            Self::Torque { name } => format!("`{name}` has a torque but is not a rotation"),
            Self::TorqueIndex { name } => format!("`{name}` is an array of rotations"),
            Self::SecondTorque { name } => format!("a second torque on `{name}`"),
            Self::Clause { clause } => format!("`{clause}` is not supported with constraints"),
        }
    }

    /// What to write instead.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::NoName => NAMED.to_owned(),
            Self::Equation => "write the difference of both sides, as in `constraint rod = x^2 + y^2 - l^2;`".to_owned(),
            Self::Colon { name } => {
                format!("write `constraint {name} = x^2 + y^2 - l^2;`: the difference of both sides, which is 0")
            }
            Self::Inequality => {
                "a constraint is an expression that is 0; write a stiff spring for a stop, `L = … - k * max(-y, 0)^2 / 2;`, or model an impact by \
                 an event with `set_state`"
                    .to_owned()
            }
            Self::Twice { .. } => "rename one of them, or give it another index".to_owned(),
            Self::Constant { .. } => {
                "write an expression of coordinates that is 0, as in `constraint rod = x^2 + y^2 - l^2;`".to_owned()
            }
            Self::TooMany { .. } => {
                "write fewer constraints than coordinates, or defaults of the parameters with which the mechanism moves"
                    .to_owned()
            }
            Self::Same { .. } | Self::Dependent { .. } => {
                "remove it: its reaction would have no unique value".to_owned()
            }
            Self::Nonlinear => {
                "write terms `a * dot(x)`; constraints with powers, functions or products of velocities are not supported"
                    .to_owned()
            }
            Self::Integrable { name, function } => format!(
                "constrain that, with its constant as a parameter: `constraint {name} = {function} - c0;`; a constraint on its velocity would \
                 drift"
            ),
            Self::Jump { .. } => {
                "velocities would jump there: make both expressions and their derivatives equal where the condition changes"
                    .to_owned()
            }
            Self::LinearTable { .. } => "velocities would jump there: make the table `cubic` or `monotone`".to_owned(),
            Self::Force { name } => format!(
                "a force acts on a coordinate: `force x = …;`; the reaction of `{name}` follows from the motion"
            ),
            Self::ForceOnRotation { name } => format!(
                "write `torque {name} = [a, b, c];` for a torque in the axes of the body, `space_torque {name} = [a, b, c];` in the axes of space"
            ),
            Self::Value { .. } => {
                "name its expression with `let`, and use that name in both places; its reaction is known after a step only, so friction that \
                 depends on it is not supported"
                    .to_owned()
            }
            Self::Reaction => {
                "friction that depends on a reaction is not supported; a run computes reactions at its states and for events"
                    .to_owned()
            }
            Self::Torque { .. } => "a torque acts on a body that `rotation R;` declares; write `force θ = …;` for a coordinate".to_owned(),
            Self::TorqueIndex { name } => format!("write `torque {name}[i in 0..8] = [a, b, c];` or `torque {name}[0] = [a, b, c];`"),
            Self::SecondTorque { .. } => "add them up in one line".to_owned(),
            Self::Clause { clause: "discretize" } => {
                "remove it: `Gauss::<1>` is the midpoint rule with constraints, `Gauss::<3>` has order 6"
                    .to_owned()
            }
            Self::Clause { .. } => "remove it; `Gauss` takes steps in t".to_owned(),
        }
    }
}

/// Help for a constraint without a name, or in another notation.
pub(crate) const NAMED: &str = "write `constraint rod = x^2 + y^2 - l^2;`: the expression is 0, and `rod` names the constraint and its \
    reaction";
