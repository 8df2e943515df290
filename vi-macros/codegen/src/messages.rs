//! Every message that a user of `lagrangian!` can meet, in one catalogue.
//!
//! In: what a stage found wrong. Out: the text, what is wrong first, then what to do; lower case, no full stop.
//! A stage collects its errors in [`Errors`] and reports them all before the next stage starts.

use crate::habits::{self, Habit};
use crate::rules;
use proc_macro2::Span;
use std::collections::BTreeSet;
use vi_expr::TooLarge;

/// Messages that are shown of one system; a last one counts those after them.
const SHOWN: usize = 30;

/// Where attributes stand.
const ATTRIBUTES: &str = "before a clause stand doc comments, before a `param` attributes of its field; a `#[cfg]` stands before the `struct`";

/// What Rayleigh functions of friction are.
const FRICTION: &str = "write `c * dot(x)^2 / 2` for viscous friction, `c * abs(dot(x))` for dry friction; a driving force belongs in `force x = …;`";

/// What to do about a Rayleigh function that adds energy.
const OTHER_SIGN: &str = "write it with the other sign, as in `c * dot(x)^2 / 2` with a positive `c`; a driving force belongs in `force x = …;`";

/// What to do about an expression without a derivative.
const OTHERWISE: &str = "its derivative divides by zero, or holds the logarithm of zero or of a negative number, for every state; write it otherwise";

/// Why an expression does not see a name that the system declares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// It stands further below, or is being declared.
    Below,
    /// It is a parameter, and the expression a constant.
    Parameter,
    /// It is a coordinate, and the expression a constant.
    Coordinate,
    /// It is a `let`, and the expression a constant.
    Let,
}

impl Absence {
    fn what(self, name: &str) -> String {
        match self {
            Self::Below => format!("`{name}` is not declared before this line"),
            Self::Parameter => format!("`{name}` is a parameter, which has no value until the system runs"),
            Self::Coordinate => format!("`{name}` is a coordinate, which has no value until the system runs"),
            Self::Let => format!("`{name}` is a `let`, which constants do not see"),
        }
    }

    fn help(self) -> String {
        match self {
            Self::Below => "move its declaration up: a `let` sees those above it, and a `const` too",
            Self::Parameter | Self::Coordinate | Self::Let => {
                "defaults, `const`s and lengths are made of numbers and `const`s; what depends on parameters or coordinates is named by \
                 `let`, as in `let w = sqrt(k / m);`"
            }
        }
        .to_owned()
    }
}

/// Why a mass matrix is singular for every state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Singular {
    /// This coordinate adds nothing to it.
    Massless(String, Massless),
    /// L is linear in all velocities: the equations are of first order.
    FirstOrder,
    /// L is homogeneous of degree 1 in the velocities: v·L_v = L, so that M v = 0.
    Homogeneous,
    /// Some directions of motion have no kinetic energy.
    Dependent,
}

/// How a coordinate stands in L that adds nothing to the mass matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Massless {
    /// Its velocity is not there.
    Absent,
    /// Its velocity is there, in the first power alone.
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
    /// A name that the language keeps for itself.
    Reserved { name: String },
    /// A name of the struct that the emitted code uses for something else.
    ReservedType { name: String },
    /// A trait that every system has.
    SecondDerive { name: String },
    /// An attribute that does nothing where it stands.
    AttributeOfClause,
    /// A name that is not declared (or not yet).
    Unknown { name: String, near: Option<String> },
    /// A name that is declared, but not for this expression.
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
    /// `dot(dot(x))`, or a name that reads as an acceleration.
    Acceleration { name: String },
    /// A constant or default that is not made of numbers and constants.
    NotConstant { name: String },
    /// A constant or default that is infinite or not a number.
    NotFinite { name: String },
    /// A division by the exact number zero.
    DivisionByZero,
    /// An expression that has a value nowhere, as `ln(-1)`.
    NoValue,
    /// A constant whose digits cancel further than it is computed.
    Undecided,
    /// A number that has to be an integer.
    NotInteger,
    /// A length of an array out of bounds.
    Length { given: i64, limit: usize },
    /// A length of an array of parameters out of bounds.
    ParametersLength { given: i64, limit: usize },
    /// A list of values that is not as long as its array.
    ParameterValues { name: String, length: usize, values: usize },
    /// A list of values for a parameter that is no array.
    ParameterWithoutLength { name: String, values: usize },
    /// An index out of the range of its array.
    IndexRange { name: String, index: i64, first: i64, end: i64 },
    /// A range that ends before it begins.
    BackwardRange { from: i64, to: i64 },
    /// An index on something that is no array.
    NotArray { name: String },
    /// An array without an index.
    ArrayWithoutIndex { name: String },
    /// A parameter that nothing depends on.
    UnusedParameter { name: String },
    /// A second line `dissipation = …;`.
    SecondDissipation,
    /// A Rayleigh function without velocities.
    NoDissipation,
    /// A term of a Rayleigh function that is linear in the velocities.
    ConstantDissipation,
    /// A Rayleigh function by which the motion gains energy.
    FeedingDissipation,
    /// A second line `time_scale = …;`.
    SecondTimeScale,
    /// A time scale that depends on velocities, by this name.
    VelocityInTimeScale { name: String },
    /// A time scale that is a number, and not a positive one.
    TimeScaleNotPositive,
    /// A slot that L_d does not depend on.
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
    /// A line of a check for a name that is neither a coordinate nor a parameter.
    CheckOfOther { name: String, near: Option<String> },
    /// A second line of a check for one coordinate, velocity or parameter.
    SecondEntry { name: String },
    /// No line `coord …;`.
    MissingCoordinates,
    /// A force on a name that is no coordinate.
    ForceOnOther { name: String, near: Option<String> },
    /// A second force on one coordinate.
    SecondForce { name: String },
    /// L does not depend on any velocity.
    NoVelocity,
    /// The mass matrix has no inverse anywhere.
    SingularMass { why: Singular },
    /// A rule by a name that does not exist.
    UnknownRule { name: String, near: Option<String> },
    /// A rule that a list names twice.
    RepeatedRule { name: String },
    /// A rule written out in a list of rules.
    WrittenInList,
    /// A line of a rule that is no slot of it.
    UnknownSlot { name: String },
    /// A line of a rule that is missing.
    MissingSlot { name: &'static str },
    /// A slot of a rule written twice.
    SecondSlot { name: String },
    /// A name in a rule that changes with the state.
    NotInRule { name: String },
    /// L or f in the arguments of L or f.
    FieldInArgument,
    /// A vector where a rule needs a number, or the reverse.
    Shape { needs: &'static str },
    /// A clause that does not exist.
    UnknownClause { found: String, near: Option<String>, is_defined: bool, is_coordinate: bool },
    /// Anything that the grammar does not allow at this token.
    Expected { what: &'static str },
    /// What is written otherwise in this language.
    Habit(Habit),
    /// A number that is no decimal integer or decimal fraction.
    NotDecimal,
    /// A number out of the range of `f64`.
    NumberRange,
    /// A part of L or of a force without a derivative that the equations need.
    NoDerivative { expression: String, by: String },
    /// A coefficient of the equations that no `f64` holds.
    CoefficientRange,
    /// Parentheses nested too deep.
    TooDeep { limit: usize },
    /// A system of too many tokens.
    TooLong { limit: usize },
    /// A name of too many letters.
    LongName { limit: usize },
    /// More coordinates than a system may have.
    TooManyCoordinates { limit: usize },
    /// A system that grew over a limit.
    TooLarge(TooLarge),
    /// Text after the system.
    AfterSystem,
    /// So many more messages, which are not shown.
    More { count: usize },
    /// A mistake of this compiler, found by checking its own output.
    Internal { what: &'static str },
}

fn did_you_mean(near: Option<&String>, otherwise: &str) -> String {
    near.map_or_else(|| otherwise.to_owned(), |name| format!("did you mean `{name}`?"))
}

/// What to do about a name that is reserved.
fn another_name(name: &str) -> String {
    match name {
        "t" => "`t` is the time; choose another name".to_owned(),
        "L" | "f" => format!("`{name}` stands for the Lagrangian or the force; choose another name"),
        _ => "choose another name".to_owned(),
    }
}

/// What to do about a word that opens no clause; behind one that is defined stands `=`.
fn clause_for(found: &str, near: Option<&String>, is_defined: bool) -> String {
    let clauses = "the clauses are const, param, coord, let, L, force, dissipation, time_scale, discretize, check";
    let part = || if is_defined { format!("write `let {found} = …;` to name a part") } else { clauses.to_owned() };
    habits::clause(found).unwrap_or_else(|| did_you_mean(near, &part()))
}

/// What to write in place of a name that is not declared.
fn name_for(name: &str, near: Option<&String>) -> String {
    let declare = "declare it with `param`, `const` or `coord`, or above with `let`";
    // A lone letter is an index or a name of its own before it is `pi`.
    let near = near.filter(|near| *near != "pi" || name.chars().count() > 1);
    did_you_mean(near, &habits::name(name).unwrap_or_else(|| declare.to_owned()))
}

/// What to write in place of a rule that does not exist.
fn rule_for(name: &str, near: Option<&String>) -> String {
    let rules = || format!("the rules are {}; {}", rules::list(), habits::GAUSS);
    habits::rule(name).unwrap_or_else(|| did_you_mean(near, &rules()))
}

/// A call with so many arguments.
fn with_arguments(name: &str, takes: usize) -> String {
    match takes {
        1 => format!("write `{name}(a)`"),
        2 => format!("write `{name}(a, b)`"),
        _ => format!("write `{name}(t0, q0, (q1 - q0)/h)`: a time, coordinates, velocities"),
    }
}

/// What to do about a direction without kinetic energy.
fn move_with_energy(why: &Singular) -> String {
    match why {
        Singular::Massless(name, Massless::Multiplier) => {
            format!("`{name}` multiplies a constraint; {}", habits::CONSTRAINT)
        }
        Singular::Massless(name, Massless::Absent) => format!(
            "`{name}` has no kinetic energy, and coordinates without mass are not supported: add a term with `dot({name})^2`, or make \
             `{name}` a `param`"
        ),
        Singular::Massless(name, Massless::Linear) => format!(
            "`dot({name})` stands in `L` in the first power alone, which is no kinetic energy: add a term with `dot({name})^2`"
        ),
        Singular::FirstOrder => {
            "`L` is linear in the velocities; systems of first order, dq/dt = f(q), are not supported: every coordinate needs a kinetic \
             energy, as in `m * dot(x)^2 / 2`"
                .to_owned()
        }
        Singular::Homogeneous => {
            "`L` is homogeneous of degree 1 in the velocities, so that its motion has no speed: let the time `t` take the place of one \
             coordinate, as in `-m * c^2 * sqrt(1 - dot(x)^2 / c^2)`"
                .to_owned()
        }
        Singular::Dependent => {
            "every direction of motion needs kinetic energy; remove coordinates that depend on others".to_owned()
        }
    }
}

impl Message {
    /// What is wrong.
    #[must_use]
    pub fn what(&self) -> String {
        match self {
            Self::Duplicate { name } => format!("the name `{name}` is declared twice"),
            Self::Reserved { name } | Self::ReservedType { name } => format!("the name `{name}` is reserved"),
            Self::SecondDerive { name } => format!("every system implements `{name}`"),
            Self::AttributeOfClause => "this attribute has no meaning here".to_owned(),
            Self::Unknown { name, .. } => format!("unknown name `{name}`"),
            Self::Absent { name, absence } => absence.what(name),
            Self::UnknownFunction { name, .. } => format!("unknown function `{name}`"),
            Self::Arity { name, takes, given } => format!("`{name}` takes {takes} argument(s), not {given}"),
            Self::FunctionWithoutArguments { name } => format!("`{name}` is a function"),
            Self::DotOfOther { name } => format!("`dot({name})`: `{name}` is not a coordinate"),
            Self::DotOfConstant { name } => format!("`dot({name})`: `{name}` does not change with time"),
            Self::Acceleration { name } => format!("an expression cannot depend on the acceleration `{name}`"),
            Self::NotConstant { name } => format!("the value of `{name}` is not a constant"),
            Self::NotFinite { name } => format!("the value of `{name}` is not finite"),
            Self::DivisionByZero => "division by zero".to_owned(),
            Self::NoValue => "this expression has no value".to_owned(),
            Self::Undecided => "more than 4096 bits are needed to round this constant".to_owned(),
            Self::NotInteger => "this has to be a constant integer".to_owned(),
            Self::Length { given, .. } => format!("an array of {given} coordinates"),
            Self::ParametersLength { given, .. } => format!("an array of {given} parameters"),
            Self::ParameterValues { name, length, values } => {
                format!("`{name}` has the length {length}, and a list of {values} values")
            }
            Self::ParameterWithoutLength { name, .. } => format!("`{name}` is no array, and has a list of values"),
            Self::IndexRange { name, index, first, end } => format!("`{name}[{index}]` is out of range {first}..{end}"),
            Self::BackwardRange { from, to } => format!("the range {from}..{to} ends before it begins"),
            Self::NotArray { name } => format!("`{name}` is not an array"),
            Self::ArrayWithoutIndex { name } => format!("`{name}` is an array"),
            Self::UnusedParameter { name } => format!("the parameter `{name}` acts on nothing"),
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
            Self::ForceOnOther { name, .. } => format!("a force on `{name}`, which is not a coordinate"),
            Self::SecondForce { name } => format!("a second force on `{name}`"),
            Self::NoVelocity => "`L` does not depend on any velocity".to_owned(),
            Self::SingularMass { .. } => "the mass matrix ∂²L/∂v² is singular for every state".to_owned(),
            Self::UnknownRule { name, .. } => format!("unknown rule `{name}`"),
            Self::RepeatedRule { name } => format!("the rule `{name}` is listed twice"),
            Self::WrittenInList => "a rule that is written out stands in no list".to_owned(),
            Self::UnknownSlot { name } => format!("a rule has no line `{name}`"),
            Self::MissingSlot { name } => format!("the rule has no line `{name}`"),
            Self::SecondSlot { name } => format!("a second `{name}` in the rule"),
            Self::NotInRule { name } => format!("a rule cannot depend on `{name}`"),
            Self::FieldInArgument => "`L` or `f` in an argument of `L` or `f`".to_owned(),
            Self::Shape { needs } => format!("a {needs} is needed here"),
            Self::UnknownClause { found, .. } => format!("unknown clause `{found}`"),
            Self::Expected { what } => format!("expected {what}"),
            Self::Habit(habit) => habit.what(),
            Self::NotDecimal => "not a decimal number".to_owned(),
            Self::NumberRange => "this number is outside the range of `f64`".to_owned(),
            Self::NoDerivative { expression, by } => {
                format!("`{expression}` has no derivative with respect to `{by}`")
            }
            Self::CoefficientRange => "the equations have a coefficient outside the range of `f64`".to_owned(),
            Self::TooDeep { limit } => format!("this expression is nested deeper than {limit} levels"),
            Self::TooLong { limit } => format!("the system is longer than {limit} tokens"),
            Self::LongName { limit } => format!("this name is longer than {limit} letters"),
            Self::TooManyCoordinates { limit } => format!("the system has more than {limit} coordinates"),
            Self::TooLarge(TooLarge::Terms { limit }) => format!("the system grows over {limit} terms"),
            Self::TooLarge(TooLarge::Work { limit }) => format!("the system takes more than {limit} steps of algebra"),
            Self::AfterSystem => "unexpected text after the system".to_owned(),
            Self::More { count } => format!("{count} more mistakes are not shown"),
            Self::Internal { what } => format!("internal error: the operations of `{what}` do not compute its formula"),
        }
    }

    /// What is allowed, and what to do.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::Duplicate { .. } => "rename one of them".to_owned(),
            Self::Reserved { name } => another_name(name),
            Self::ReservedType { .. } => "generated code uses this type; choose another name".to_owned(),
            Self::SecondDerive { name } => format!("remove `{name}`; other traits may be derived"),
            Self::AttributeOfClause => ATTRIBUTES.to_owned(),
            Self::Unknown { name, near } => name_for(name, near.as_ref()),
            Self::Absent { absence, .. } => absence.help(),
            Self::UnknownFunction { name, near } => habits::function(name).unwrap_or_else(|| did_you_mean(
                near.as_ref(),
                "the functions are sqrt exp ln sin cos tan asin acos atan atan2 sinh cosh tanh abs sign hypot pow sum, in a rule L f, elsewhere dot",
            )),
            Self::Arity { name, takes, .. } => with_arguments(name, *takes),
            Self::FunctionWithoutArguments { name } => {
                format!("write its argument: `{name}(…)`; a power stands behind it, `{name}(…)^2`")
            }
            Self::DotOfConstant { .. } => {
                "`dot` takes what depends on the time or on a coordinate; its result is the derivative by time".to_owned()
            }
            Self::DotOfOther { .. } => "a check gives the velocities of coordinates".to_owned(),
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
            Self::ParameterValues { length, .. } => format!("write {length} of them, or one for all: `= 1.0`"),
            Self::ParameterWithoutLength { name, values } => format!("write its length: `param {name}[{values}] = […];`"),
            Self::IndexRange { first, end, .. } if end <= first => "this array has no entries".to_owned(),
            Self::IndexRange { first, end, .. } => format!("the indices are {first} to {}", end - 1),
            Self::BackwardRange { .. } => "write the smaller bound first; the second one is not included".to_owned(),
            Self::NotArray { name } => format!("write `{name}` without an index"),
            Self::ArrayWithoutIndex { name } => format!("write one entry, `{name}[0]`, or a sum over it"),
            Self::UnusedParameter { .. } => "use it in `L` or in a force, or remove it".to_owned(),
            Self::NoDissipation => {
                "Rayleigh's function is half the power that is lost, as in `c * dot(x)^2 / 2`".to_owned()
            }
            Self::ConstantDissipation => FRICTION.to_owned(),
            Self::FeedingDissipation => OTHER_SIGN.to_owned(),
            Self::SecondTimeScale => "write `time_scale` once".to_owned(),
            Self::VelocityInTimeScale { .. } => "use positions, time, constants and parameters".to_owned(),
            Self::TimeScaleNotPositive => "dt = g dτ: g is positive wherever the system moves".to_owned(),
            Self::UnusedSlot { .. } => "a discrete Lagrangian depends on both ends of its interval".to_owned(),
            Self::MissingLagrangian => "write `L = …;`, kinetic minus potential energy".to_owned(),
            Self::SecondLagrangian => "write `L` once; name parts of it with `let`".to_owned(),
            Self::SecondRule => "write `discretize` once; it may list several rules by their names".to_owned(),
            Self::SecondCheck => "write `check` once".to_owned(),
            Self::MissingStep => "end it with the step, as in `h = 0.01;`".to_owned(),
            Self::StepNotPositive => "give a step with which the system moves well, as in `h = 0.01;`".to_owned(),
            Self::CheckOfOther { near, .. } => did_you_mean(
                near.as_ref(),
                "a check gives coordinates, `dot(…)` of them, parameters, the time `t` and the step `h`",
            ),
            Self::SecondEntry { .. } => "give each coordinate, velocity and parameter once".to_owned(),
            Self::MissingCoordinates => "declare them: `coord x, y;`".to_owned(),
            Self::ForceOnOther { near, .. } => {
                did_you_mean(near.as_ref(), "a force acts on a coordinate: `force x = …;`")
            }
            Self::SecondForce { .. } | Self::SecondDissipation => "add them up in one line".to_owned(),
            Self::NoVelocity => "write the kinetic energy with `dot(…)`, as in `m * dot(x)^2 / 2`".to_owned(),
            Self::SingularMass { why } => move_with_energy(why),
            Self::UnknownRule { name, near } => rule_for(name, near.as_ref()),
            Self::RepeatedRule { .. } => "list each rule once; the first is the system's own".to_owned(),
            Self::WrittenInList => "write it alone, `discretize { … }`; a list holds names".to_owned(),
            Self::UnknownSlot { .. } => "the lines are Ld, fd_minus, fd_plus, gd_minus, gd_plus".to_owned(),
            Self::MissingSlot { name } if *name == "Ld" => "write `Ld = …;`".to_owned(),
            Self::MissingSlot { .. } => "the system has a force: write all lines, or `Ld` alone, made of `L`".to_owned(),
            Self::NotInRule { .. } => "a rule knows t0, t1, h, q0, q1, L, f, constants and parameters".to_owned(),
            Self::FieldInArgument => "evaluate both at times, coordinates and velocities".to_owned(),
            Self::SecondSlot { .. } => "write each line of a rule once".to_owned(),
            Self::Shape { .. } => {
                "t0, t1, h and L are numbers; q0, q1 and f are vectors; `*` of two vectors is their dot product"
                    .to_owned()
            }
            Self::UnknownClause { is_coordinate: true, .. } => habits::RUN.to_owned(),
            Self::UnknownClause { found, near, is_defined, .. } => clause_for(found, near.as_ref(), *is_defined),
            Self::Expected { .. } => "a clause reads `name = expression;`, and a sum `a + 2 * b`".to_owned(),
            Self::Habit(habit) => habit.help(),
            Self::NotDecimal => "write integers and decimals, as in `2`, `0.5` or `1.6e-19`".to_owned(),
            Self::NumberRange => "choose other units".to_owned(),
            Self::NoDerivative { .. } => OTHERWISE.to_owned(),
            Self::CoefficientRange => "choose other units, or smaller exponents".to_owned(),
            Self::TooDeep { .. } => "name parts of it with `let`".to_owned(),
            Self::TooLong { .. } => "write what repeats with arrays and `sum`".to_owned(),
            Self::LongName { .. } => "choose a shorter one".to_owned(),
            Self::TooLarge(_) | Self::TooManyCoordinates { .. } => {
                "use fewer coordinates or a simpler Lagrangian".to_owned()
            }
            Self::AfterSystem => "one `lagrangian!` holds one `struct`".to_owned(),
            Self::More { .. } => "correct those above, and compile again".to_owned(),
            Self::Internal { .. } => "please report this system".to_owned(),
        }
    }
}

/// The errors of one stage or of a part of it, in the order in which they were found.
#[derive(Debug, Default)]
pub struct Errors {
    combined: Option<syn::Error>,
    /// What was said.
    texts: BTreeSet<String>,
}

impl Errors {
    /// Adds a message at a token.
    pub fn at(&mut self, span: Span, message: &Message) {
        self.add(error(span, message));
    }

    /// Adds an error made elsewhere.
    pub fn add(&mut self, error: syn::Error) {
        self.texts.insert(error.to_string());
        match &mut self.combined {
            Some(combined) => combined.combine(error),
            None => self.combined = Some(error),
        }
    }

    /// A part of an expression, or nothing and its errors. What was said of another part is not said again.
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

    /// Whether nothing was found.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.combined.is_none()
    }

    /// The product, if nothing was found wrong.
    ///
    /// # Errors
    /// All that was found.
    pub fn finish<P>(self, product: P) -> syn::Result<P> {
        match self.combined {
            Some(error) => Err(error),
            None => Ok(product),
        }
    }
}

/// The first [`SHOWN`] messages of a system, and how many more there are: each is printed with its line of text, which may be long.
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

/// The candidate nearest to a misspelt name, if one is near: at most a third of its letters differ.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    candidates
        .into_iter()
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().max(name.chars().count()).div_ceil(3))
        .filter(|(distance, candidate)| *distance < candidate.chars().count())
        // Of equally near ones that with the longer common beginning: people err at the end of a word.
        .min_by_key(|(distance, candidate)| {
            let beginning = name.chars().zip(candidate.chars()).take_while(|(a, b)| a == b).count();
            (*distance, core::cmp::Reverse(beginning), *candidate)
        })
        .map(|(_, candidate)| candidate.to_owned())
}

/// Levenshtein's distance: insertions, deletions and replacements that turn one name into the other.
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
