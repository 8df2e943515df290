//! Notation of Rust, of other languages and of mathematics that this language writes differently.
//!
//! In: the notation found. Out: a message with the error and its correction; for a single word, the help only.

use crate::arrays::INVERSE;
use crate::constraints;
use crate::rules;

/// Notation that this language writes differently. The fields of a variant are the words that its text names.
#[allow(missing_docs)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Habit {
    /// `x**2`.
    DoubleStar,
    /// `x^1/2`.
    PowerOverNumber { exponent: &'static str },
    /// `|x|`.
    Bars,
    /// `x'`.
    Prime,
    /// `xdot`, for the velocity of a coordinate.
    VelocityByName { name: String, coordinate: String },
    /// `v`, in a system with this coordinate.
    Velocity { coordinate: String },
    /// `sinx`, with a declared `x`.
    FunctionInName { name: String, function: String, argument: String },
    /// `mg`, with a declared `m` and `g`.
    ProductInName { name: String, product: String },
    /// `discretize gauss(4)`, `discretize order = 4`.
    RuleWithArguments,
    /// `discretize = midpoint`.
    RuleWithSign,
    /// `2 x`, `m g`.
    MissingOperator { left: String, right: String, is_number: bool },
    /// `sin x`.
    FunctionWithoutParentheses { name: String, argument: String },
    /// `x.sin()`.
    Method { name: String },
    /// `f64::consts::PI`.
    Path,
    /// `x: f64`.
    Type,
    /// A number followed by letters.
    NumberSuffix { digits: String, suffix: String },
    /// `1.0f64`.
    TypeOfNumber { digits: String, name: String },
    /// `i as f64`.
    Conversion,
    /// `1.e-3`, `.5`.
    PointWithoutDigits { number: String },
    /// `match`, `a ? b : c`, `a > b` outside an `if`.
    Condition,
    /// `a % b`, `n!`.
    NoOperator { sign: char },
    /// `A @ B`, `a .* b`.
    OtherProduct { sign: &'static str },
    /// `{a + b}`, `2 * [a + b]`.
    OtherBrackets,
    /// `self.m`, `x.dot`.
    Field { name: String },
    /// `# text`.
    Comment,
    /// `param m = 1,5`.
    DecimalComma,
    /// `let f(x) = …`.
    FunctionDefinition { name: String },
    /// `let mut u`.
    Mutable,
    /// `let y := x`.
    ColonEquals,
    /// `force x += …`.
    AddedForce,
    /// `0..=3`.
    InclusiveRange,
    /// `dot(q)[0]`.
    IndexBehind,
    /// `1.0 [kg]`.
    UnitInBrackets,
    /// `product(i in 0..3, q[i])`.
    RangeOf { function: String },
    /// `x(t - 1)`, of a coordinate.
    CoordinateWithArguments { name: String },
    /// `q(1)`, of an array.
    EntryInParentheses { name: String },
    /// A clause, or a line of a rule, without `;` at its end.
    MissingSemicolon { after: String },
    /// A definition without `=`.
    MissingValue { name: String, clause: Option<&'static str> },
    /// `coord x = 1`.
    ValueOfCoordinate,
    /// `force = …`.
    ForceWithoutCoordinate,
}

impl Habit {
    /// What is wrong.
    #[must_use]
    pub fn what(&self) -> String {
        match self {
            Self::DoubleStar => "`**` is not an operator".to_owned(),
            Self::PowerOverNumber { exponent } => format!("`a^{exponent}/b` is `(a^{exponent}) / b`"),
            Self::Bars => "bars do not denote the absolute value".to_owned(),
            Self::Prime => "a prime does not denote a derivative".to_owned(),
            Self::Velocity { .. } => "unknown name `v`".to_owned(),
            Self::VelocityByName { name, .. }
            | Self::FunctionInName { name, .. }
            | Self::ProductInName { name, .. } => format!("unknown name `{name}`"),
            Self::RuleWithArguments => "a rule takes no arguments".to_owned(),
            Self::RuleWithSign => "`discretize` takes names of rules, without `=`".to_owned(),
            Self::MissingOperator { left, right, .. } => {
                format!("an operator is missing between `{left}` and `{right}`")
            }
            Self::FunctionWithoutParentheses { name, .. } => format!("`{name}` is a function"),
            Self::Method { name } => format!("`.{name}(…)`: numbers have no methods"),
            Self::Path => "an expression cannot contain a path".to_owned(),
            Self::Type => "a declaration has no type".to_owned(),
            Self::NumberSuffix { digits, suffix } => {
                format!("the number `{digits}` is followed directly by `{suffix}`")
            }
            Self::TypeOfNumber { digits, name } => format!("the number `{digits}` has the type `{name}`"),
            Self::Conversion => "numbers need no conversion".to_owned(),
            Self::PointWithoutDigits { .. } => {
                "a number needs a digit before its point and before its exponent".to_owned()
            }
            Self::Condition => "a comparison is part of an `if`".to_owned(),
            Self::OtherProduct { sign } => format!("`{sign}` is not an operator"),
            Self::NoOperator { sign } => format!("`{sign}` is not an operator"),
            Self::OtherBrackets => "only parentheses group an expression".to_owned(),
            Self::Field { name } => format!("`.{name}`: names have no fields"),
            Self::Comment => "`#` does not start a comment".to_owned(),
            Self::DecimalComma => "a decimal fraction uses a point, not a comma".to_owned(),
            Self::FunctionDefinition { name } => format!("`{name}(…)`: a function is declared with `fn`"),
            Self::Mutable => "`let` names an expression and cannot be mutable".to_owned(),
            Self::ColonEquals => "a definition uses `=`".to_owned(),
            Self::AddedForce => "the force on a coordinate is written once".to_owned(),
            Self::InclusiveRange => "a range excludes its end".to_owned(),
            Self::IndexBehind => "only a name can have an index".to_owned(),
            Self::UnitInBrackets => "a number cannot have a unit".to_owned(),
            Self::RangeOf { function } => format!("`{function}` does not take a range"),
            Self::EntryInParentheses { name } => format!("`{name}` is an array, not a function"),
            Self::CoordinateWithArguments { name } => format!("`{name}` is a coordinate, not a function"),
            Self::MissingSemicolon { after } => format!("`;` is missing after `{after}`"),
            Self::MissingValue { name, .. } => format!("`{name}` has no value"),
            Self::ValueOfCoordinate => "a coordinate is declared without a value".to_owned(),
            Self::ForceWithoutCoordinate => "this force names no coordinate".to_owned(),
        }
    }

    /// What to write instead.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::DoubleStar => "write `x^2` for a power".to_owned(),
            Self::PowerOverNumber { exponent } => {
                format!("write `a^({exponent}/b)` for a root; write a quotient as `(a^{exponent})/b`")
            }
            Self::Bars => "write `abs(x)`, `norm(v)` for the length of a vector".to_owned(),
            Self::Prime => "write `dot(x)` for the velocity of `x`; name another quantity `x_1`, for example".to_owned(),
            Self::VelocityByName { coordinate, .. } => format!("write `dot({coordinate})`, the velocity of `{coordinate}`"),
            Self::Velocity { coordinate } => {
                format!("write `dot({coordinate})` for the velocity of `{coordinate}`, or name it: `let v = dot({coordinate});`")
            }
            Self::FunctionInName { function, argument, .. } => format!("write `{function}({argument})`"),
            Self::ProductInName { product, .. } => format!("write `{product}` for a product"),
            Self::RuleWithArguments => {
                format!("write `discretize {};` or `discretize {};`; {GAUSS}", rules::GAUSS, rules::RULES[0].name)
            }
            Self::RuleWithSign => format!("write `discretize {};`", rules::RULES[0].name),
            Self::MissingOperator { left, right, is_number: true } => suffix(right)
                .unwrap_or_else(|| format!("write `{left} * {right}` for a product; units are not supported")),
            Self::MissingOperator { left, right, .. } => format!("write `{left} * {right}` for a product"),
            Self::FunctionWithoutParentheses { name, argument } => {
                format!("write its argument in parentheses: `{name}({argument})`")
            }
            Self::Method { name } if name == "dot" => "write `a * b` for the inner product, `dot(x)` for the velocity of `x`".to_owned(),
            Self::Method { name } => function(name)
                .unwrap_or_else(|| format!("write it as a function, `{name}(…)`, with all its arguments")),
            Self::Path => "write `pi` and `sin(x)`; declare a Rust function, as in `fn cl(a) = crate::aero::cl;`, and write `cl(a)`; pass a constant of \
                           the surrounding code as a `param`".to_owned(),
            Self::Type => {
                "write `param m = 1.0;`, `coord x;`, `let a = …;`: all numbers have the numeric type of the run".to_owned()
            }
            Self::NumberSuffix { digits, suffix: word } => suffix(word)
                .unwrap_or_else(|| format!("write `{digits} * {word}` for a product; units are not supported")),
            Self::TypeOfNumber { digits, .. } => format!("write `{digits}`: numbers are exact and have no type"),
            Self::Conversion => "remove `as`; an index is a number, as in `i / 2`".to_owned(),
            Self::PointWithoutDigits { number } => format!("write `{number}`"),
            Self::Condition => CONDITION.to_owned(),
            Self::OtherProduct { .. } => {
                "write `*`: `M * v`, `v * w` for the inner product; products entry by entry are `a[i] * b[i]`".to_owned()
            }
            Self::NoOperator { sign: '%' } => {
                "the operators are `+ - * / ^`; angles need no remainder, since `sin` and `cos` are periodic".to_owned()
            }
            Self::NoOperator { .. } => "the operators are `+ - * / ^`".to_owned(),
            Self::OtherBrackets => "write `(a + b)`; brackets enclose an index or the entries of a vector, braces the lines of a rule or a check".to_owned(),
            Self::Field { name } if name == "T" => "write `transpose(M)`".to_owned(),
            Self::Field { name } if name == "dot" => "write `dot(x)` for the velocity of `x`".to_owned(),
            Self::Field { .. } => "write plain names: `m` for a parameter, `q[0]`, `q[1]` for entries of an array".to_owned(),
            Self::Comment => "write `// …`".to_owned(),
            Self::DecimalComma => "write `1.5`; a comma separates definitions".to_owned(),
            Self::FunctionDefinition { name } => {
                format!("write `fn {name}(a) = …;`, or `let {name} = …;` for an expression without arguments")
            }
            Self::Mutable => "remove `mut`".to_owned(),
            Self::ColonEquals => "write `=`".to_owned(),
            Self::AddedForce => "write `force x = …;`, with the sum of all forces on `x`".to_owned(),
            Self::InclusiveRange => "write `0..N + 1` for the indices 0 to N".to_owned(),
            Self::UnitInBrackets => "remove the brackets; use one system of units for all numbers".to_owned(),
            Self::RangeOf { function } if PRODUCTS.contains(&function.as_str()) => {
                "only `sum` takes a range: write the factors one by one, `q[0] * q[1] * q[2]`; of positive ones the product is \
                 `exp(sum(i in 0..8, ln(q[i])))`"
                    .to_owned()
            }
            Self::RangeOf { .. } => "only `sum` takes a range, as in `sum(i in 0..8, q[i])`".to_owned(),
            Self::EntryInParentheses { name } => format!("write an entry as `{name}[0]`; indices start at 0"),
            Self::CoordinateWithArguments { name } => format!(
                "write `{name}` for its value at the time `t`, `{name} * (…)` for a product; delays (values at other times) are not \
                 supported"
            ),
            Self::IndexBehind => "write `dot(q[0])` for the velocity of `q[0]`, and name other vectors with `let`, as in `let d = a + b;`, `d[0]`".to_owned(),
            Self::MissingSemicolon { .. } => {
                "every clause ends with `;`; entries of one list are separated by `,`".to_owned()
            }
            Self::MissingValue { name, .. } if matches!(name.as_str(), "dissipation" | "time_scale") => {
                format!("write `{name} = …;`, one function for all coordinates")
            }
            Self::MissingValue { name, clause: None } => format!("write `{name} = …`"),
            Self::MissingValue { name, clause: Some("input") } => {
                format!("write `{name} = 0.0`: an `input` needs a default, its value until a controller sets it")
            }
            Self::MissingValue { name, .. } => {
                format!("write `{name} = 1.0`: a `param` needs a default; its field can override it")
            }
            Self::ValueOfCoordinate => {
                "write `coord x;`: set the initial value in the `State` of a run, or for checks in `check { x = 1; h = 0.01; }`; declare a constant as a `param`"
                    .to_owned()
            }
            Self::ForceWithoutCoordinate => {
                "write the coordinate that it acts on: `force x = …;`, `force q[0] = …;`".to_owned()
            }
        }
    }

    /// A number followed by letters, which may be a numeric type of Rust.
    pub(crate) fn of_suffix(digits: &str, suffix: &str) -> Self {
        let (digits, name) = (digits.to_owned(), suffix.trim_start_matches('_').to_owned());
        if TYPES.contains(&name.as_str()) {
            return Self::TypeOfNumber { digits, name };
        }
        Self::NumberSuffix { digits, suffix: suffix.to_owned() }
    }
}

/// Numeric types of Rust.
const TYPES: [&str; 14] =
    ["f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16", "u32", "u64", "u128", "usize"];

/// Products over a range.
const PRODUCTS: [&str; 3] = ["product", "prod", "Π"];

/// Clauses of other languages that declare a constraint.
const OF_CONSTRAINTS: [&str; 8] =
    ["constraints", "constrain", "subject", "holonomic", "nonholonomic", "equation", "equations", "eq"];

/// Whether other languages declare a constraint by a clause of this name.
pub(crate) fn is_constraint(clause: &str) -> bool {
    OF_CONSTRAINTS.contains(&clause)
}

/// Clauses.
const CLAUSES: [(&[&str], &str); 16] = [
    (&["parameter", "parameters", "params"], "write `param a = 1.0;`"),
    (
        &["inputs", "control", "controls", "actuator", "actuators"],
        "write `input u = 0.0;`, a parameter that a controller sets between steps",
    ),
    (&["coordinate", "coordinates", "var", "dof"], "write `coord x, y;`"),
    (&["constant", "constants", "static"], "write `const g = 9.81;`"),
    (&["lagrangian", "Lagrangian", "Lagrange", "Lag"], "write `L = …;`"),
    (&["l"], "write `L = …;` for the Lagrangian, `let l = …;` to name a part"),
    (
        &["H", "hamiltonian", "Hamiltonian"],
        "write the Lagrangian, a function of coordinates and velocities: `L = m * dot(q)^2 / 2 - V;` for `H = p^2 / (2 * m) + V`; \
         Hamiltonians are not supported",
    ),
    (&["rayleigh", "Rayleigh", "damping", "friction"], "write `dissipation = …;`, Rayleigh's function"),
    (&OF_CONSTRAINTS, constraints::NAMED),
    (
        &["for", "while", "loop"],
        "write `force q[i in 0..8] = …;` or `let e[i in 0..8] = …;` for each entry, and `sum(i in 0..8, …)`",
    ),
    (&["if", "match"], CONDITION),
    (
        &["extern", "function", "func", "def", "use"],
        "write `fn cl(a) = crate::aero::cl;` for a Rust function, `fn f(a) = …;` for an expression",
    ),
    (&["interp", "spline", "lookup", "lut", "data"], TABLE),
    (&["order", "stages", "gauss", "method", "integrator", "rule", "scheme"], GAUSS),
    (&["h", "dt", "step", "steps", "until"], RUN),
    (&["initial", "start", "init", "ic"], RUN),
];

/// Functions.
const FUNCTIONS: [(&[&str], &str); 44] = [
    (&["log"], "write `ln(a)` for the natural logarithm, `ln(a) / ln(b)` for the one to the base b"),
    (&["log10"], "write `ln(a) / ln(10)`"),
    (&["log2"], "write `ln(a) / ln(2)`"),
    (&["arcsin"], "write `asin(a)`"),
    (&["arccos"], "write `acos(a)`"),
    (&["arctan", "atg", "arctg"], "write `atan(a)`"),
    (&["arctan2"], "write `atan2(y, x)`"),
    (&["tg"], "write `tan(a)`"),
    (&["cot", "cotan", "ctg"], "write `1 / tan(a)`"),
    (&["sec"], "write `1 / cos(a)`"),
    (&["csc", "cosec"], "write `1 / sin(a)`"),
    (&["sech"], "write `1 / cosh(a)`"),
    (&["csch"], "write `1 / sinh(a)`"),
    (&["coth"], "write `1 / tanh(a)`"),
    (&["sinc"], "write `sin(a) / a`, which has no value at a = 0"),
    (
        &["floor", "ceil", "round", "mod", "fmod"],
        "rounding and remainders are not supported; `sin` and `cos` are periodic without them",
    ),
    (&["asinh", "arsinh", "arcsinh"], "write `ln(a + sqrt(a^2 + 1))`"),
    (&["cbrt"], "write `a^(1/3)`"),
    (&["square", "sqr", "sq"], "write `a^2`"),
    (&["powi", "powf", "power"], "write `a^b`"),
    (&["fabs"], "write `abs(a)` for a number, `norm(v)` for the length of a vector"),
    (&["inv", "inverse", "invert", "solve"], INVERSE),
    (
        &["det", "determinant"],
        "write it out: `M[0][0] * M[1][1] - M[0][1] * M[1][0]`, `cross(M[0], M[1]) * M[2]` for three rows",
    ),
    (&["trace", "tr"], "write `sum(i in 0..3, M[i][i])`"),
    (&["outer"], "write `let M[i in 0..3][j in 0..3] = a[i] * b[j];`"),
    (&["inner", "scalar_product", "dotp", "matmul", "mul"], "write `a * b`, also for vectors and matrices"),
    (&["normalize", "normalized", "unit", "versor"], "write `v / norm(v)`"),
    (&["eye", "identity", "zeros", "ones"], "write the rows: `[[1, 0], [0, 1]]`"),
    (&["diag"], "write the rows: `[[a, 0], [0, b]]`"),
    (
        &["vec", "vector", "Vector", "matrix", "Matrix", "array"],
        "write `[a, b, c]`, and a matrix by its rows, `[[a, b], [c, d]]`",
    ),
    (
        &["length", "len"],
        "write `norm(v)` for the length of a vector; its number of entries is the constant that declares it",
    ),
    (
        &["pitch", "roll", "yaw", "heading", "euler", "euler_angles", "quaternion", "matrix_of", "axis_angle"],
        "of a `rotation R`, `rate(R)` is the angular velocity, `turn(R, [1, 0, 0])` an axis of the body in space, and `R[0]` … `R[3]` the \
         quaternion; or declare angles, `angle ψ, θ, φ;`",
    ),
    (&["sgn", "signum"], "write `sign(a)`"),
    (&["heaviside", "Heaviside", "step", "theta"], "write `if a > 0 { 1 } else { 0 }`"),
    (&["piecewise", "Piecewise", "where", "ifelse", "cond", "select", "switch"], CONDITION),
    (&["interp", "interp1", "interp1d", "interpolate", "spline", "lookup", "lut", "CubicSpline"], TABLE),
    (&["sat", "saturate", "saturation", "clip"], "write `clamp(x, a, b)`"),
    (&["max", "maximum", "fmax"], "write `max(a, b)`"),
    (&["min", "minimum", "fmin"], "write `min(a, b)`"),
    (
        &["rand", "randn", "random", "noise", "normal", "uniform", "wiener"],
        "random numbers are not supported: make the force an `input`, and set it between steps with `set_parameters`",
    ),
    (&["integral", "integrate", "int", "quad"], "integrals are not supported: write the value as a formula"),
    (
        &[
            "erf",
            "erfc",
            "gamma",
            "Gamma",
            "lgamma",
            "digamma",
            "beta",
            "zeta",
            "airy",
            "besselj",
            "bessely",
            "besseli",
            "besselk",
            "besselj0",
            "besselj1",
            "j0",
            "j1",
            "jn",
            "ellipk",
            "ellipe",
            "ellipj",
            "legendre",
            "hypergeom",
            "lambertw",
            "factorial",
        ],
        "special functions are not supported: write an approximation that is accurate in the range of the motion, such as a polynomial",
    ),
    (&["complex", "Complex", "re", "Re", "im", "Im", "real", "imag", "conj", "arg"], COMPLEX),
    (
        &["delay", "delayed", "lag", "history"],
        "delays are not supported: an expression depends on the state at one time only",
    ),
];

/// Whether other languages write a condition by a function of this name.
pub(crate) fn is_condition(name: &str) -> bool {
    FUNCTIONS.iter().any(|(names, help)| *help == CONDITION && names.contains(&name))
}

/// Derivatives with respect to time, which are one function here, and with respect to coordinates.
const DERIVATIVES: [&str; 12] =
    ["diff", "der", "ddt", "d", "D", "derivative", "prime", "grad", "gradient", "partial", "pdiff", "Diff"];

/// Help for complex numbers.
const COMPLEX: &str = "complex numbers are not supported: write the real and the imaginary part as two coordinates, and `exp(i x)` with `cos(x)` and `sin(x)`";

/// Help for angles in degrees.
pub(crate) const DEGREES: &str = "angles are in radians: write `30 * pi / 180` for 30 degrees";

/// Names.
const NAMES: [(&[&str], &str); 9] = [
    (&["π", "PI", "Pi", "M_PI"], "write `pi`"),
    (&["e"], "write `exp(x)` for e^x, `exp(1)` for the number"),
    (&["time"], "write `t`"),
    (
        &["i", "j", "k"],
        "an index needs a range, as in `sum(i in 0..3, q[i])`; otherwise declare it with `param`, `const` or `coord`; complex numbers are not \
         supported",
    ),
    (&["im", "I"], COMPLEX),
    (&["deg", "degree", "degrees"], DEGREES),
    (
        &["p", "momentum"],
        "declare it with `param`, `const` or `coord`; write a momentum in terms of the velocity, as `m * dot(x)`",
    ),
    (&["dt", "ddt"], "write `dot(x)` for the derivative of `x` with respect to time"),
    (&["lambda", "λ", "multiplier"], constraints::NAMED),
];

/// Rules.
const OF_RULES: [(&[&str], &str); 2] = [
    (&["Gauss", "gauss_legendre", "legendre", "collocation", "galerkin", "order", "stages"], GAUSS),
    (
        &["verlet", "Verlet", "leapfrog", "stoermer_verlet", "stormer_verlet", "velocity_verlet"],
        "write `trapezoidal`, which is Störmer–Verlet when `L` is `v·Mv/2 - V(t, q)`",
    ),
];

/// Help on the order of the method.
pub(crate) const GAUSS: &str = "Gauss methods need no clause: every system has their steps, of order 2 S with S stages";

/// Help on the step and the initial state.
pub(crate) const RUN: &str = "set the step and the initial state of a run: `system.at(t, q, v).integrate(FixedStep, h)`; set those of checks in \
    `check { x = 1; h = 0.01; }`";

/// Greek letters and their names.
const GREEK: [(&str, &str); 24] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("iota", "ι"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("omicron", "ο"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("upsilon", "υ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("varphi", "ϕ"),
];

/// Precomposed letters with one and with two dots above.
const DOTTED: [(&str, &str); 2] = [("ȧċėġẋẏżṙṡṗṁṅȯ", "acegxyzrspmno"), ("äëïöüẍÿ", "aeiouxy")];

/// Combining marks that put one and two dots above the letter before them.
const DOTS: [char; 2] = ['\u{307}', '\u{308}'];

/// The name without this number of dots above its last letter; `None` for other numbers.
pub(crate) fn without_dots(name: &str, dots: usize) -> Option<String> {
    let (mark, (dotted, plain)) = DOTS.into_iter().zip(DOTTED).nth(dots.checked_sub(1)?)?;
    if let Some(stem) = name.strip_suffix(mark) {
        return Some(stem.to_owned());
    }
    let last = name.chars().next_back()?;
    let letter = dotted.chars().zip(plain.chars()).find_map(|(dotted, letter)| (dotted == last).then_some(letter))?;
    Some(name.chars().rev().skip(1).collect::<Vec<_>>().into_iter().rev().chain([letter]).collect())
}

/// A Greek letter for its name, or the name for the letter, with the rest of the word.
pub(crate) fn other_alphabet(name: &str) -> Option<String> {
    let pairs = GREEK.into_iter().flat_map(|(word, letter)| [(word, letter), (letter, word)]);
    pairs.into_iter().find_map(|(one, other)| name.strip_prefix(one).map(|rest| format!("{other}{rest}")))
}

/// Help for a condition.
const CONDITION: &str = "write `if a > b { x } else { y }`; write an `if` inside another for two conditions";

/// Help for a table.
const TABLE: &str =
    "write `table drag(v) = \"drag.csv\";` or `table drag(v) = [(0, 0.1), (1, 0.3)];`, and `drag(v)` in an expression";

/// Help for an unknown clause.
pub(crate) fn clause(word: &str) -> Option<String> {
    find(&CLAUSES, word)
}

/// Help for an unknown function.
pub(crate) fn function(name: &str) -> Option<String> {
    if DERIVATIVES.contains(&name) {
        let help = "write `dot(a)` for a derivative with respect to time; the macro differentiates `L` with respect to coordinates, so that a potential \
            `V` enters `L` as `- V`";
        return Some(help.to_owned());
    }
    find(&FUNCTIONS, name)
}

/// Help for letters after a number that are neither a product nor a unit.
fn suffix(letters: &str) -> Option<String> {
    match letters {
        "i" | "j" | "im" => Some(COMPLEX.to_owned()),
        "deg" | "degree" | "degrees" => Some(DEGREES.to_owned()),
        _ => None,
    }
}

/// Help for an unknown rule.
pub(crate) fn rule(name: &str) -> Option<String> {
    find(&OF_RULES, name)
}

/// Help for an unknown name.
pub(crate) fn name(name: &str) -> Option<String> {
    find(&NAMES, name)
}

fn find(table: &[(&[&str], &str)], word: &str) -> Option<String> {
    table.iter().find(|(words, _)| words.contains(&word)).map(|(_, help)| (*help).to_owned())
}

/// Help for an unknown word: the declared one that is near, or else another hint.
pub(crate) fn did_you_mean(near: Option<&String>, otherwise: &str) -> String {
    near.map_or_else(|| otherwise.to_owned(), |name| format!("did you mean `{name}`?"))
}
