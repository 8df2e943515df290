//! Every message of `lagrangian!` to its users, in one catalogue.
//!
//! In: an error found by a stage. Out: its text: the error, then the correction; lower case, no full stop. A stage
//! collects its errors in [`Errors`] and reports them all before the next stage starts.

use crate::arrays::ArrayMistake;
use crate::constraints::{self, ConstraintMistake};
use crate::functions::{self, FunctionMistake};
use crate::habits::{self, Habit, did_you_mean};
use crate::rules;
use proc_macro2::Span;
use std::collections::BTreeSet;
use vi_expr::TooLarge;

/// Messages shown for one system; a last message counts the others.
const SHOWN: usize = 30;

/// Where attributes are allowed.
const ATTRIBUTES: &str = "write doc comments before a clause, attributes of the field before a `param` or an `input`, and `#[cfg]` before the `struct`";

/// Rayleigh functions of friction.
const FRICTION: &str = "write `c * dot(x)^2 / 2` for viscous friction, `c * abs(dot(x))` for dry friction; a driving force belongs in `force x = …;`";

/// Correction of a Rayleigh function that adds energy.
const OTHER_SIGN: &str =
    "reverse its sign, as in `c * dot(x)^2 / 2` with a positive `c`; a driving force belongs in `force x = …;`";

/// The functions.
const FUNCTIONS: &str = "the functions are sqrt exp ln sin cos tan asin acos atan atan2 sinh cosh tanh abs sign hypot pow max min clamp sum cross norm \
    transpose, in a rule L f, elsewhere dot; declare others with `fn` or `table`";

/// What `dot` takes.
const OF_TIME: &str = "`dot` is the derivative with respect to time: its argument must depend on time or a coordinate";

/// Numbers and vectors of a rule.
const IN_RULE: &str = "t0, t1, h and L are numbers; q0, q1 and f are vectors; `*` of two vectors is their dot product";

/// What a check sets.
const IN_CHECK: &str = "a check sets coordinates, their `dot(…)`, parameters, the time `t` and the step `h`";

/// The size at which systems end.
const LARGE: &str = "use fewer coordinates or a simpler Lagrangian; terms that repeat, written as `sum(i in 0..N, …)` over arrays, become \
    loops, unless a rule is written out";

/// Correction of an expression without a derivative.
const NO_DERIVATIVE: &str = "its derivative divides by zero, or takes the logarithm of zero or of a negative number, for every state; rewrite the expression";

/// Why an expression cannot use a declared name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// Its declaration comes later, or is this one.
    Below,
    /// It is a parameter; the expression is a constant.
    Parameter,
    /// It is a coordinate; the expression is a constant.
    Coordinate,
    /// It is a `let`; the expression is a constant.
    Let,
    /// It is a constraint.
    Constraint,
}

impl Absence {
    fn what(self, name: &str) -> String {
        match self {
            Self::Below => format!("`{name}` is not declared before this line"),
            Self::Parameter => format!("`{name}` is a parameter: it has no value at compile time"),
            Self::Coordinate => format!("`{name}` is a coordinate: it has no value at compile time"),
            Self::Let => format!("`{name}` is a `let`, which a constant cannot use"),
            Self::Constraint => ConstraintMistake::Value { name: name.to_owned() }.what(),
        }
    }

    fn help(self, name: &str) -> String {
        match self {
            Self::Constraint => return ConstraintMistake::Value { name: name.to_owned() }.help(),
            Self::Below => "move its declaration up: a `let` or `const` uses earlier declarations only",
            Self::Parameter | Self::Coordinate | Self::Let => {
                "write defaults, `const`s and lengths with numbers and `const`s; name an expression of parameters or coordinates with \
                 `let`, as in `let w = sqrt(k / m);`"
            }
        }
        .to_owned()
    }
}

/// Why a mass matrix is singular in every state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Singular {
    /// This coordinate contributes nothing to it.
    Massless(String, Massless),
    /// L is linear in all velocities: the equations are of first order.
    FirstOrder,
    /// L is homogeneous of degree 1 in the velocities: v·L_v = L, so that M v = 0.
    Homogeneous,
    /// Some directions of motion have no kinetic energy.
    Dependent,
    /// Some directions of motion that the constraints allow have no kinetic energy, with a coordinate that they move.
    Allowed(Option<String>),
}

/// How L depends on a coordinate that contributes nothing to the mass matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Massless {
    /// L does not contain its velocity.
    Absent,
    /// L contains its velocity to the first power only.
    Linear,
    /// It multiplies a function of others.
    Multiplier,
}

/// A mistake in the input. The fields of a variant are the words that its text names.
#[allow(missing_docs)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// Two declarations of one name.
    Duplicate { name: String },
    /// A name reserved by the language.
    Reserved { name: String },
    /// A name of the struct that the emitted code uses for another type.
    ReservedType { name: String },
    /// A trait that every system implements.
    SecondDerive { name: String },
    /// An attribute without effect at this position.
    AttributeOfClause,
    /// An attribute that a text without a crate may not have.
    AttributeOfText,
    /// An undeclared name.
    Unknown { name: String, near: Option<String> },
    /// A declared name that this expression cannot use.
    Absent { name: String, absence: Absence },
    /// A function that the language does not have.
    UnknownFunction { name: String, near: Option<String> },
    /// A call with the wrong number of arguments.
    Arity { name: String, takes: usize, given: usize },
    /// A function used without its arguments.
    FunctionWithoutArguments { name: String },
    /// `dot` of a number, a parameter or a constant.
    DotOfConstant { name: String },
    /// The velocity in a check of something that is not a coordinate.
    DotOfOther { name: String },
    /// `dot(dot(x))`, or a name that denotes an acceleration.
    Acceleration { name: String },
    /// A constant or default that contains more than numbers and constants.
    NotConstant { name: String },
    /// A constant or default that is infinite or not a number.
    NotFinite { name: String },
    /// A division by the exact number zero.
    DivisionByZero,
    /// An expression without a value in any state, such as `ln(-1)`.
    NoValue,
    /// A constant whose digits cancel beyond the working precision.
    Undecided,
    /// A number that must be an integer.
    NotInteger,
    /// A length of an array out of bounds.
    Length { given: i64, limit: usize },
    /// A length of an array of parameters out of bounds.
    ParametersLength { given: i64, limit: usize },
    /// A list of values whose length differs from its array.
    ParameterValues { name: String, length: usize, values: usize },
    /// A list of values for a scalar parameter, with the lengths that it needs: `[3]`.
    ParameterWithoutLength { name: String, lengths: String, clause: &'static str },
    /// An index out of the range of its array.
    IndexRange { name: String, index: i64, first: i64, end: i64 },
    /// A range that ends before it begins.
    BackwardRange { from: i64, to: i64 },
    /// An index on a name that is not an array.
    NotArray { name: String },
    /// A mistake with vectors, matrices and arrays.
    Array(ArrayMistake),
    /// A mistake with constraints.
    Constraint(ConstraintMistake),
    /// An unused parameter.
    UnusedParameter { name: String, is_input: bool },
    /// A second line `dissipation = …;`.
    SecondDissipation,
    /// A Rayleigh function without velocities.
    NoDissipation,
    /// A term of a Rayleigh function that is linear in the velocities.
    ConstantDissipation,
    /// A Rayleigh function that adds energy.
    FeedingDissipation,
    /// A second line `time_scale = …;`.
    SecondTimeScale,
    /// A time scale that depends on velocities through this name.
    VelocityInTimeScale { name: String },
    /// A constant time scale that is not positive.
    TimeScaleNotPositive,
    /// A slot that does not appear in L_d.
    UnusedSlot { name: &'static str },
    /// No line `L = …;`.
    MissingLagrangian,
    /// A second line `L = …;`.
    SecondLagrangian,
    /// A second line `discretize …;`.
    SecondRule,
    /// A second `check { … }`.
    SecondCheck,
    /// A check without `h = …;`.
    MissingStep,
    /// A check with a step that is zero or negative.
    StepNotPositive,
    /// A line of a check that names neither a coordinate nor a parameter.
    CheckOfOther { name: String, near: Option<String> },
    /// A second line of a check for the same coordinate, velocity or parameter.
    SecondEntry { name: String },
    /// No line `coord …;`.
    MissingCoordinates,
    /// A force on a name that is not a coordinate.
    ForceOnOther { name: String, near: Option<String> },
    /// A second force on one coordinate.
    SecondForce { name: String },
    /// L does not depend on any velocity.
    NoVelocity,
    /// The mass matrix is singular in every state.
    SingularMass { why: Singular },
    /// An unknown rule.
    UnknownRule { name: String, near: Option<String> },
    /// A rule that a list names twice.
    RepeatedRule { name: String },
    /// A rule written out in a list of rules.
    WrittenInList,
    /// A line of a rule with an unknown name.
    UnknownSlot { name: String },
    /// A missing line of a rule.
    MissingSlot { name: &'static str },
    /// A slot of a rule written twice.
    SecondSlot { name: String },
    /// A name that depends on the state, in a rule.
    NotInRule { name: String },
    /// L or f in the arguments of L or f.
    FieldInArgument,
    /// A vector where a rule needs a number, or the reverse.
    Shape { needs: &'static str },
    /// An unknown clause.
    UnknownClause { found: String, near: Option<String>, is_defined: bool, is_coordinate: bool },
    /// A token that the grammar does not allow.
    Expected { what: &'static str },
    /// Anything but a `struct` at the beginning.
    NoStruct,
    /// `lagrangian! { … }` in itself.
    Wrapped,
    /// Notation that this language writes differently.
    Habit(Habit),
    /// An expression that changes if an angle makes a turn.
    NotPeriodic { what: String, angle: String, name: String, ratio: Option<String> },
    /// A number that is not a decimal integer or fraction.
    NotDecimal,
    /// A number outside the range of `f64`.
    NumberRange,
    /// A part of L or of a force that has no derivative, which the equations need.
    NoDerivative { expression: String, by: String },
    /// A coefficient of the equations outside the range of `f64`.
    CoefficientRange,
    /// Parentheses nested too deep.
    TooDeep { limit: usize },
    /// A system with too many tokens.
    TooLong { limit: usize },
    /// A name with too many letters.
    LongName { limit: usize },
    /// More coordinates than a system may have.
    TooManyCoordinates { limit: usize },
    /// A system that exceeds a limit.
    TooLarge(TooLarge),
    /// Recursions with more entries than their tangents may have; the arrays, their size, and the entries that
    /// are allowed.
    Tangents { arrays: Vec<String>, bytes: usize, most: usize },
    /// Text after the system.
    AfterSystem,
    /// The number of messages that are not shown.
    More { count: usize },
    /// A mistake with functions, tables and conditions.
    Function(FunctionMistake),
    /// A bug of this compiler, found by checking its own output.
    Internal { what: &'static str },
}

/// Help for a reserved name.
fn another_name(name: &str) -> String {
    match name {
        "t" => "`t` is the time; choose another name".to_owned(),
        "L" | "f" => format!("`{name}` denotes the Lagrangian or the force; choose another name"),
        _ => "choose another name".to_owned(),
    }
}

/// Help for an unknown clause; `is_defined` if `=` follows it.
fn clause_for(found: &str, near: Option<&String>, is_defined: bool) -> String {
    let clauses = "the clauses are const, param, input, coord, angle, rotation, fn, table, let, L, force, torque, space_torque, dissipation, constraint, time_scale, discretize, check";
    let part = || {
        if is_defined {
            format!("write `param {found} = …;` for a parameter, `let {found} = …;` to name a part")
        } else {
            clauses.to_owned()
        }
    };
    habits::clause(found).unwrap_or_else(|| did_you_mean(near, &part()))
}

/// Help for an undeclared name.
fn name_for(name: &str, near: Option<&String>) -> String {
    let declare = "declare it with `param`, `const`, `coord`, or an earlier `let`";
    // A lone letter is rarely a misspelt `pi`.
    let near = near.filter(|near| *near != "pi" || name.chars().count() > 1);
    did_you_mean(near, &habits::name(name).unwrap_or_else(|| declare.to_owned()))
}

/// Help for an unknown rule.
fn rule_for(name: &str, near: Option<&String>) -> String {
    let rules = || format!("the rules are {}; {}", rules::list(), habits::GAUSS);
    habits::rule(name).unwrap_or_else(|| did_you_mean(near, &rules()))
}

/// A call with `takes` arguments.
fn with_arguments(name: &str, takes: usize) -> String {
    match takes {
        1 => format!("write `{name}(a)`"),
        2 => format!("write `{name}(a, b)`"),
        _ => format!("write `{name}(t0, q0, (q1 - q0)/h)`: a time, coordinates, velocities"),
    }
}

/// Help for a coordinate without kinetic energy.
fn kinetic_energy_help(why: &Singular) -> String {
    match why {
        Singular::Massless(name, Massless::Multiplier) => {
            format!("`{name}` multiplies a constraint: remove `{name}`, and {}", constraints::NAMED)
        }
        Singular::Massless(name, Massless::Absent) => format!(
            "`{name}` has no kinetic energy, and coordinates without mass are not supported: add a term with `dot({name})^2`, or make \
             `{name}` a `param`"
        ),
        Singular::Massless(name, Massless::Linear) => format!(
            "`dot({name})` appears in `L` only to the first power, which is not kinetic energy: add a term with `dot({name})^2`"
        ),
        Singular::FirstOrder => {
            "`L` is linear in the velocities; systems of first order, dq/dt = f(q), are not supported: every coordinate needs a kinetic \
             energy, as in `m * dot(x)^2 / 2`"
                .to_owned()
        }
        Singular::Homogeneous => {
            "`L` is homogeneous of degree 1 in the velocities, so the equations do not determine the speed: use the time `t` in place of one \
             coordinate, as in `-m * c^2 * sqrt(1 - dot(x)^2 / c^2)`"
                .to_owned()
        }
        Singular::Allowed(Some(name)) => format!(
            "a motion of `{name}` has no kinetic energy, and no constraint determines it: add a term with `dot({name})^2`, or a constraint"
        ),
        Singular::Allowed(None) | Singular::Dependent => {
            "every direction of motion needs kinetic energy; remove coordinates that depend on others".to_owned()
        }
    }
}

impl Message {
    /// The error.
    #[must_use]
    #[allow(clippy::too_many_lines)] // one for each mistake
    pub fn what(&self) -> String {
        match self {
            Self::Duplicate { name } => format!("the name `{name}` is declared twice"),
            Self::Reserved { name } | Self::ReservedType { name } => format!("the name `{name}` is reserved"),
            Self::SecondDerive { name } => format!("every system implements `{name}`"),
            Self::AttributeOfClause => "this attribute has no meaning here".to_owned(),
            Self::AttributeOfText => "a text alone has no attributes with code".to_owned(),
            Self::Unknown { name, .. } => format!("unknown name `{name}`"),
            Self::Absent { name, absence } => absence.what(name),
            Self::UnknownFunction { name, .. } => format!("unknown function `{name}`"),
            Self::Arity { name, takes, given } => functions::takes(name, *takes, *given),
            Self::FunctionWithoutArguments { name } => format!("`{name}` is a function"),
            Self::DotOfOther { name } => format!("`dot({name})`: `{name}` is not a coordinate"),
            Self::DotOfConstant { name } => format!("`dot({name})`: `{name}` does not change with time"),
            Self::Acceleration { name } => format!("an expression cannot depend on the acceleration `{name}`"),
            Self::NotConstant { name } => format!("the value of `{name}` is not a constant"),
            Self::NotFinite { name } => format!("the value of `{name}` is not finite"),
            Self::DivisionByZero => "division by zero".to_owned(),
            Self::NoValue => "this expression has no value".to_owned(),
            Self::Undecided => "more than 4096 bits are needed to round this constant".to_owned(),
            Self::NotInteger => "this must be a constant integer".to_owned(),
            Self::Length { given, .. } => format!("an array cannot have {given} coordinates"),
            Self::ParametersLength { given, .. } => format!("an array cannot have {given} parameters"),
            Self::ParameterValues { name, length, values } => {
                format!("`{name}` has length {length} but a list of {values} values")
            }
            Self::ParameterWithoutLength { name, .. } => format!("`{name}` is not an array but has a list of values"),
            Self::IndexRange { name, index, first, end } => format!("`{name}[{index}]` is out of range {first}..{end}"),
            Self::BackwardRange { from, to } => format!("the range {from}..{to} ends before it begins"),
            Self::NotArray { name } => format!("`{name}` is not an array"),
            Self::Array(mistake) => mistake.what(),
            Self::Constraint(mistake) => mistake.what(),
            Self::UnusedParameter { name, is_input: true } => format!("the input `{name}` is never used"),
            Self::UnusedParameter { name, .. } => format!("the parameter `{name}` is never used"),
            Self::SecondDissipation => "a second `dissipation`".to_owned(),
            Self::NoDissipation => "`dissipation` does not depend on any velocity".to_owned(),
            Self::ConstantDissipation => {
                "a term of `dissipation` is linear in velocities: its force is constant".to_owned()
            }
            Self::FeedingDissipation => "`dissipation` adds energy: its power `-v * ∂R/∂v` is positive".to_owned(),
            Self::SecondTimeScale => "a second `time_scale`".to_owned(),
            Self::VelocityInTimeScale { name } => format!("a time scale cannot depend on the velocities in `{name}`"),
            Self::TimeScaleNotPositive => "the time scale is not positive".to_owned(),
            Self::UnusedSlot { name } => format!("`Ld` does not depend on `{name}`"),
            Self::MissingLagrangian => "the system has no Lagrangian".to_owned(),
            Self::SecondLagrangian => "a second `L`".to_owned(),
            Self::SecondRule => "a second `discretize`".to_owned(),
            Self::SecondCheck => "a second `check`".to_owned(),
            Self::MissingStep => "the check has no step".to_owned(),
            Self::StepNotPositive => "the step `h` is not positive".to_owned(),
            Self::CheckOfOther { name, .. } => format!("`{name}` is neither a coordinate nor a parameter"),
            Self::SecondEntry { name } => format!("`{name}` is given twice"),
            Self::MissingCoordinates => "the system has no coordinates".to_owned(),
            Self::ForceOnOther { name, .. } => format!("`{name}` has a force but is not a coordinate"),
            Self::SecondForce { name } => format!("a second force on `{name}`"),
            Self::NoVelocity => "`L` does not depend on any velocity".to_owned(),
            Self::SingularMass { why: Singular::Allowed(_) } => {
                "the mass matrix ∂²L/∂v² is singular for every state, in a direction that the constraints allow"
                    .to_owned()
            }
            Self::SingularMass { .. } => "the mass matrix ∂²L/∂v² is singular for every state".to_owned(),
            Self::UnknownRule { name, .. } => format!("unknown rule `{name}`"),
            Self::RepeatedRule { name } => format!("the rule `{name}` is listed twice"),
            Self::WrittenInList => "a written-out rule cannot appear in a list of names".to_owned(),
            Self::UnknownSlot { name } => format!("a rule has no line `{name}`"),
            Self::MissingSlot { name } => format!("the rule has no line `{name}`"),
            Self::SecondSlot { name } => format!("a second `{name}` in the rule"),
            Self::NotInRule { name } => format!("a rule cannot depend on `{name}`"),
            Self::FieldInArgument => "`L` or `f` in an argument of `L` or `f`".to_owned(),
            Self::Shape { needs } => format!("a {needs} is needed here"),
            Self::UnknownClause { found, .. } => format!("unknown clause `{found}`"),
            Self::Expected { what } => format!("expected {what}"),
            Self::NoStruct => "expected `struct Name { … }`".to_owned(),
            Self::Wrapped => "a system begins inside of `lagrangian! { … }`".to_owned(),
            Self::Habit(habit) => habit.what(),
            Self::NotDecimal => "not a decimal number".to_owned(),
            Self::NumberRange => "this number is outside the range of double precision".to_owned(),
            Self::NoDerivative { expression, by } => {
                format!("`{expression}` has no derivative with respect to `{by}`")
            }
            Self::NotPeriodic { what, angle, .. } => {
                format!("{what} is not periodic in the angle `{angle}`: it changes when `{angle}` makes a turn of 2π")
            }
            Self::CoefficientRange => {
                "the equations have a coefficient outside the range of double precision".to_owned()
            }
            Self::TooDeep { limit } => format!("this expression is nested deeper than {limit} levels"),
            Self::TooLong { limit } => format!("the system is longer than {limit} tokens"),
            Self::LongName { limit } => format!("this name is longer than {limit} letters"),
            Self::TooManyCoordinates { limit } => format!("the system has more than {limit} coordinates"),
            Self::TooLarge(TooLarge::Terms { limit }) => format!("the expanded system has more than {limit} terms"),
            Self::Tangents { arrays, bytes, .. } => {
                let tenths = bytes.div_ceil(100_000);
                format!(
                    "the tangents of `{}` need {}.{} MB of the stack",
                    arrays.join("`, `"),
                    tenths / 10,
                    tenths % 10
                )
            }
            Self::TooLarge(TooLarge::Work { limit }) => format!("the system takes more than {limit} steps of algebra"),
            Self::AfterSystem => "unexpected text after the system".to_owned(),
            Self::More { count } => format!("{count} more mistakes are not shown"),
            Self::Function(mistake) => mistake.what(),
            Self::Internal { what } => format!("internal error: the operations of `{what}` do not compute its formula"),
        }
    }

    /// The correction.
    #[must_use]
    #[allow(clippy::too_many_lines)] // one for each mistake
    pub fn help(&self) -> String {
        match self {
            Self::Duplicate { .. } => "rename one of them".to_owned(),
            Self::Reserved { name } => another_name(name),
            Self::ReservedType { .. } => "generated code uses this type; choose another name".to_owned(),
            Self::SecondDerive { name } => format!("remove `{name}`; other traits may be derived"),
            Self::AttributeOfClause => ATTRIBUTES.to_owned(),
            Self::AttributeOfText => "write documentation as `/// text`, and other attributes in a crate of yours, `vi-lab new NAME --python`".to_owned(),
            Self::Unknown { name, near } => name_for(name, near.as_ref()),
            Self::Absent { name, absence } => absence.help(name),
            Self::UnknownFunction { name, near } => {
                habits::function(name).unwrap_or_else(|| did_you_mean(near.as_ref(), FUNCTIONS))
            }
            Self::Arity { name, takes, .. } => with_arguments(name, *takes),
            Self::FunctionWithoutArguments { name } => {
                format!("write its argument: `{name}(…)`; a power follows it, `{name}(…)^2`")
            }
            Self::DotOfConstant { .. } => OF_TIME.to_owned(),
            Self::DotOfOther { .. } => "in a check, `dot(…)` takes a coordinate".to_owned(),
            Self::Acceleration { .. } => {
                "use positions, velocities, time and parameters; an inertial term belongs in `L`".to_owned()
            }
            Self::NotConstant { .. } => "use numbers, `pi`, functions and earlier `const`s here".to_owned(),
            Self::DivisionByZero => "the denominator is identically zero; check it".to_owned(),
            Self::NotFinite { .. } | Self::NoValue => {
                "look for a division by zero, or a root or logarithm of a negative number".to_owned()
            }
            Self::Undecided => "write it in a form whose terms do not cancel, or as a number".to_owned(),
            Self::NotInteger => "use integers, `const`s and indices, as in `q[N - 1]`".to_owned(),
            Self::Length { limit, .. } => format!("a system has 1 to {limit} coordinates"),
            Self::ParametersLength { limit, .. } => format!("an array of parameters has 1 to {limit} entries"),
            Self::ParameterValues { length, .. } => format!("write {length} values, or one for all entries: `= 1.0`"),
            Self::ParameterWithoutLength { name, lengths, clause } => {
                format!("write its length: `{clause} {name}{lengths} = […];`")
            }
            Self::IndexRange { first, end, .. } if end <= first => "this array has no entries".to_owned(),
            Self::IndexRange { first, end, .. } => format!("the indices are {first} to {}", end - 1),
            Self::BackwardRange { .. } => "write the smaller bound first; the second one is not included".to_owned(),
            Self::NotArray { name } => format!("write `{name}` without an index"),
            Self::Array(mistake) => mistake.help(),
            Self::Constraint(mistake) => mistake.help(),
            Self::UnusedParameter { .. } => "use it in `L` or in a force, or remove it".to_owned(),
            Self::NoDissipation => {
                "Rayleigh's function is half the dissipated power, as in `c * dot(x)^2 / 2`".to_owned()
            }
            Self::ConstantDissipation => FRICTION.to_owned(),
            Self::FeedingDissipation => OTHER_SIGN.to_owned(),
            Self::SecondTimeScale => "write `time_scale` once".to_owned(),
            Self::VelocityInTimeScale { .. } => "use positions, time, constants and parameters".to_owned(),
            Self::TimeScaleNotPositive => {
                "dt = g dτ: write a g that is positive in every state of the motion".to_owned()
            }
            Self::UnusedSlot { .. } => "a discrete Lagrangian depends on both ends of its interval".to_owned(),
            Self::MissingLagrangian => "write `L = …;`, kinetic minus potential energy".to_owned(),
            Self::SecondLagrangian => "write `L` once; name parts of it with `let`".to_owned(),
            Self::SecondRule => "write `discretize` once; it may list several rules by their names".to_owned(),
            Self::SecondCheck => "write `check` once".to_owned(),
            Self::MissingStep => "end it with the step, as in `h = 0.01;`".to_owned(),
            Self::StepNotPositive => "write a positive step that resolves the motion, as in `h = 0.01;`".to_owned(),
            Self::CheckOfOther { near, .. } => did_you_mean(near.as_ref(), IN_CHECK),
            Self::SecondEntry { .. } => "set each coordinate, velocity and parameter once".to_owned(),
            Self::MissingCoordinates => "declare them: `coord x, y;`".to_owned(),
            Self::ForceOnOther { near, .. } => {
                did_you_mean(near.as_ref(), "a force acts on a coordinate: `force x = …;`")
            }
            Self::SecondForce { .. } | Self::SecondDissipation => "add them up in one line".to_owned(),
            Self::NoVelocity => "write the kinetic energy with `dot(…)`, as in `m * dot(x)^2 / 2`".to_owned(),
            Self::SingularMass { why } => kinetic_energy_help(why),
            Self::UnknownRule { name, near } => rule_for(name, near.as_ref()),
            Self::RepeatedRule { .. } => "list each rule once; the first is the default".to_owned(),
            Self::WrittenInList => "write it alone: `discretize { … }`".to_owned(),
            Self::UnknownSlot { .. } => "the lines are Ld, fd_minus, fd_plus, gd_minus, gd_plus".to_owned(),
            Self::MissingSlot { name } if *name == "Ld" => "write `Ld = …;`".to_owned(),
            Self::MissingSlot { .. } => {
                "the system has a force: write all lines, or only `Ld`, in terms of `L`".to_owned()
            }
            Self::NotInRule { .. } => "a rule can use t0, t1, h, q0, q1, L, f, constants and parameters".to_owned(),
            Self::FieldInArgument => "write times, coordinates and velocities as their arguments".to_owned(),
            Self::SecondSlot { .. } => "write each line of a rule once".to_owned(),
            Self::Shape { .. } => IN_RULE.to_owned(),
            Self::UnknownClause { is_coordinate: true, .. } => habits::RUN.to_owned(),
            Self::UnknownClause { found, near, is_defined, .. } => clause_for(found, near.as_ref(), *is_defined),
            Self::Expected { .. } => "write a clause as `name = expression;` and a sum as `a + 2 * b`".to_owned(),
            Self::NoStruct => {
                "write the text of a system, as `struct Pendulum { coord x; L = dot(x)^2 / 2 - x^2; }`, not the name of a file".to_owned()
            }
            Self::Wrapped => "write the `struct Name { … }` alone, without `lagrangian!` and its braces".to_owned(),
            Self::Habit(habit) => habit.help(),
            Self::NotDecimal => "write integers and decimals, as in `2`, `0.5` or `1.6e-19`".to_owned(),
            Self::NumberRange => "choose other units".to_owned(),
            Self::NoDerivative { .. } => NO_DERIVATIVE.to_owned(),
            Self::NotPeriodic { name, ratio: Some(ratio), .. } => format!(
                "write its ratio with `const`, as in `const n = 3;` or `const n = 33 / 20;`: with a rational number the \
                 constraint holds modulo whole turns, with the parameter `{ratio}` it does not; or declare `{name}` with `coord`"
            ),
            Self::NotPeriodic { angle, name, .. } => format!(
                "declare `{name}` with `coord`, or use it in functions of period 2π, as `cos({angle})` and `sin(2 * {angle})`; write a \
                 constant torque as a force, `force {angle} = …;`"
            ),
            Self::CoefficientRange => "choose other units, or smaller exponents".to_owned(),
            Self::TooDeep { .. } => "name parts of it with `let`".to_owned(),
            Self::TooLong { .. } => "write repeated terms with arrays and `sum`".to_owned(),
            Self::LongName { .. } => "choose a shorter one".to_owned(),
            Self::TooLarge(_) => LARGE.to_owned(),
            Self::Tangents { most, .. } => format!("declare at most {most} entries"),
            Self::TooManyCoordinates { .. } => "use fewer coordinates or a simpler Lagrangian".to_owned(),
            Self::AfterSystem => "one `lagrangian!` holds one `struct`".to_owned(),
            Self::More { .. } => "correct those above, and compile again".to_owned(),
            Self::Function(mistake) => mistake.help(),
            Self::Internal { .. } => "please report this system".to_owned(),
        }
    }
}

/// The errors of a stage or of a part of it, in the order found.
#[derive(Debug, Default)]
pub struct Errors {
    combined: Option<syn::Error>,
    /// Texts reported so far.
    texts: BTreeSet<String>,
}

impl Errors {
    /// Adds a message at a token.
    pub fn at(&mut self, span: Span, message: &Message) {
        self.add(error(span, message));
    }

    /// Adds an existing error.
    pub fn add(&mut self, error: syn::Error) {
        self.texts.insert(error.to_string());
        match &mut self.combined {
            Some(combined) => combined.combine(error),
            None => self.combined = Some(error),
        }
    }

    /// The part, or `None` after adding its errors. Skips texts that were reported before.
    pub fn keep<P>(&mut self, part: syn::Result<P>) -> Option<P> {
        let error = match part {
            Ok(part) => return Some(part),
            Err(error) => error,
        };
        for one in error {
            if !self.texts.contains(&one.to_string()) {
                self.add(one);
            }
        }
        None
    }

    /// Whether there are no errors.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.combined.is_none()
    }

    /// The product, if there are no errors.
    ///
    /// # Errors
    /// All collected errors.
    pub fn finish<P>(self, product: P) -> syn::Result<P> {
        match self.combined {
            Some(error) => Err(error),
            None => Ok(product),
        }
    }
}

/// Whether errors say that a system is too large.
pub(crate) fn is_too_large(errors: &syn::Error) -> bool {
    errors.clone().into_iter().any(|error| error.to_string().contains(LARGE))
}

/// The first [`SHOWN`] messages of a system and the number of further ones: each prints its source line, which may be
/// long.
#[must_use]
pub(crate) fn bounded(errors: syn::Error) -> syn::Error {
    let count = errors.clone().into_iter().count();
    if count <= SHOWN + 1 {
        return errors;
    }
    let mut first = Errors::default();
    for (index, one) in errors.into_iter().take(SHOWN + 1).enumerate() {
        if index < SHOWN {
            first.add(one);
        } else {
            first.at(one.span(), &Message::More { count: count - SHOWN });
        }
    }
    first.combined.unwrap_or_else(|| error(Span::call_site(), &Message::More { count }))
}

/// One error at a token.
#[must_use]
pub fn error(span: Span, message: &Message) -> syn::Error {
    syn::Error::new(span, format!("{}\nhelp: {}", message.what(), message.help()))
}

/// The candidate nearest to a misspelt name, if at most a third of its letters differ.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    candidates
        .into_iter()
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().max(name.chars().count()).div_ceil(3))
        .filter(|(distance, candidate)| *distance < candidate.chars().count())
        // Ties go to the longer common prefix: typing errors are more frequent at the end of a word.
        .min_by_key(|(distance, candidate)| {
            let beginning = name.chars().zip(candidate.chars()).take_while(|(a, b)| a == b).count();
            (*distance, core::cmp::Reverse(beginning), *candidate)
        })
        .map(|(_, candidate)| candidate.to_owned())
}

/// Levenshtein distance: insertions, deletions and replacements that turn one name into the other.
fn distance(left: &str, right: &str) -> usize {
    let right: Vec<char> = right.chars().collect();
    let mut row: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.chars().enumerate() {
        let mut diagonal = i;
        row[0] = i + 1;
        for (j, b) in right.iter().enumerate() {
            let replaced = diagonal + usize::from(a != *b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[right.len()]
}
