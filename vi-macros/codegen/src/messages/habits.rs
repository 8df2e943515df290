//! Notation of Rust, of other languages and of mathematics that this language writes differently.

use super::words::{self, CONDITION, GAUSS};
use crate::clause::Defining;
use crate::rules;

catalogue! {
    /// Notation that this language writes differently.
    Habit:

    DoubleStar = "`**` is not an operator", "write `x^2` for a power",
        ["x «*»* 2"];
    PowerOverNumber { exponent: &'static str } =
        "`a^{exponent}/b` is `(a^{exponent}) / b`",
        "write `a^({exponent}/b)` for a root; write a quotient as `(a^{exponent})/b`",
        ["x^«1»/2"] { exponent: "1" }, ["x^«-»1/2"] { exponent: "-1" };
    Bars = "bars do not denote the absolute value", "write `abs(x)`, `norm(v)` for the length of a vector",
        ["«|»q|", "«|»x|", "2«|»x|"];
    Prime =
        "a prime does not denote a derivative",
        "write `dot(x)` for the velocity of `x`; name another quantity `x_1`, for example",
        ["x«'»x", "x«':'»"];
    VelocityByName { name: String, coordinate: String } =
        "unknown name `{name}`", "write `dot({coordinate})`, the velocity of `{coordinate}`",
        ["«xdot»"] { name: "xdot", coordinate: "x" }, ["«x_dot»"] { name: "x_dot", coordinate: "x" },
        ["«dotx»"] { name: "dotx", coordinate: "x" }, ["«dot_x»"] { name: "dot_x", coordinate: "x" },
        ["«vx»"] { name: "vx", coordinate: "x" }, ["«v_x»"] { name: "v_x", coordinate: "x" },
        ["«dx»", "«dx»/2"] { name: "dx", coordinate: "x" }, ["«d_x»"] { name: "d_x", coordinate: "x" },
        ["«ẋ»"] { name: "ẋ", coordinate: "x" }, ["«x\u{307}»"] { name: "x\u{307}", coordinate: "x" },
        ["coord q[2]; L = dot(q[0])^2 + «q_dot»[1]^2;"] { name: "q_dot", coordinate: "q[…]" },
        ["coord θ; L = dot(θ)^2 - «theta_dot»;"] { name: "theta_dot", coordinate: "θ" },
        ["coord θ; L = dot(θ)^2 - «θ_dot»;"] { name: "θ_dot", coordinate: "θ" },
        ["coord θ; L = dot(θ)^2 - «θ\u{307}»;"] { name: "θ\u{307}", coordinate: "θ" },
        ["coord theta; L = dot(theta)^2 - «θ_dot»;"] { name: "θ_dot", coordinate: "theta" };
    Velocity { coordinate: String } =
        "unknown name `v`",
        "write `dot({coordinate})` for the velocity of `{coordinate}`, or name it: `let v = dot({coordinate});`",
        ["«v»"] { coordinate: "q[…]" };
    FunctionInName { name: String, function: String, argument: String } =
        "unknown name `{name}`", "write `{function}({argument})`",
        ["«sinx»"] { name: "sinx", function: "sin", argument: "x" },
        ["«sqrtg» * x"] { name: "sqrtg", function: "sqrt", argument: "g" },
        ["coord θ; L = dot(θ)^2 - «cosθ»;"] { name: "cosθ", function: "cos", argument: "θ" };
    ProductInName { name: String, product: String } = "unknown name `{name}`", "write `{product}` for a product",
        ["«m·x»"] { name: "m·x", product: "m * x" }, ["«mg» * x"] { name: "mg", product: "m * g" },
        ["«mgx»"] { name: "mgx", product: "m * g * x" };
    RuleWithArguments =
        "a rule takes no arguments",
        { format!("write `discretize {};` or `discretize {};`; {GAUSS}", rules::GAUSS, rules::RULES[0].name) },
        ["discretize gauss«(»4);", "discretize order «=» 4;", "discretize gauss «4»;", "discretize Gauss«<»4>;",
         "discretize midpoint«(»h);"];
    RuleWithSign =
        "`discretize` takes names of rules, without `=`", { format!("write `discretize {};`", rules::RULES[0].name) },
        ["discretize «=» midpoint;", "discretize «:» midpoint;"];
    MissingOperator { left: String, right: String, is_number: bool } =
        "an operator is missing between `{left}` and `{right}`",
        {
            match is_number {
                true => words::suffix(left, right),
                false => format!("write `{left} * {right}` for a product"),
            }
        },
        ["check { x = 1 «dot»(x) = 2; h = 1; };"] { left: "1", right: "dot(…)", is_number: true },
        ["2 «x»"] { left: "2", right: "x", is_number: true },
        ["m «g»", "(m «g»)"] { left: "m", right: "g", is_number: false },
        ["x^2 «(»x + 1)"] { left: "2", right: "(…)", is_number: false },
        ["sin(x) «cos»(x)"] { left: "sin(…)", right: "cos(…)", is_number: false },
        ["param g = 9.81 «m»/s^2;"] { left: "9.81", right: "m", is_number: true },
        ["exp(2 «i» * x)"] { left: "2", right: "i", is_number: true },
        ["x * sin(30 «deg»)"] { left: "30", right: "deg", is_number: true };
    FunctionWithoutParentheses { name: String, argument: String } =
        "`{name}` is a function", "write its argument in parentheses: `{name}({argument})`",
        ["sin «x»"] { name: "sin", argument: "x" };
    Method { name: String } =
        "`.{name}(…)`: numbers have no methods",
        {
            match name.as_str() {
                "dot" => "write `a * b` for the inner product, `dot(x)` for the velocity of `x`".to_owned(),
                _ => words::function(name)
                    .unwrap_or_else(|| format!("write it as a function, `{name}(…)`, with all its arguments")),
            }
        },
        ["q.«dot»(q)"] { name: "dot" }, ["q.«cross»(q)"] { name: "cross" }, ["x.«sin»()"] { name: "sin" },
        ["2.0.«sqrt»()"] { name: "sqrt" }, ["(x + 1).«powi»(2)"] { name: "powi" }, ["x.«max»(1)"] { name: "max" };
    Path =
        "an expression cannot contain a path",
        "write `pi` and `sin(x)`; declare a Rust function, as in `fn cl(a) = crate::aero::cl;`, and write `cl(a)`; pass a constant of \
         the surrounding code as a `param`",
        ["f64«:»:consts::PI"];
    Type =
        "a declaration has no type",
        "write `param m = 1.0;`, `coord x;`, `let a = …;`: all numbers have the numeric type of the run",
        ["param m«:» f64 = 1.0;", "coord y«:» f64;", "input u«:» f64 = 1.0;"];
    NumberSuffix { digits: String, suffix: String } =
        "the number `{digits}` is followed directly by `{suffix}`", { words::suffix(digits, suffix) },
        ["«2x»"] { digits: "2", suffix: "x" }, ["param g = «9.81m»/s^2;"] { digits: "9.81", suffix: "m" },
        ["«1_000kg» * x"] { digits: "1000", suffix: "kg" }, ["«1.5e3kg» * x"] { digits: "1.5e3", suffix: "kg" },
        ["exp(«1i» * x)"] { digits: "1", suffix: "i" }, ["x * sin(«30deg»)"] { digits: "30", suffix: "deg" };
    TypeOfNumber { digits: String, name: String } =
        "the number `{digits}` has the type `{name}`", "write `{digits}`: numbers are exact and have no type",
        ["«1.0f64» * x"] { digits: "1.0", name: "f64" }, ["«2_i32» * x"] { digits: "2", name: "i32" },
        ["«2usize» * x"] { digits: "2", name: "usize" };
    Conversion = "numbers need no conversion", "remove `as`; an index is a number, as in `i / 2`",
        ["x «as»  f64"];
    PointWithoutDigits { number: String } =
        "a number needs a digit before its point and before its exponent", "write `{number}`",
        ["1.«e» - 3 * x"] { number: "1.0e-3" }, ["1.«e3» * x"] { number: "1.0e3" }, ["«.»5 * x"] { number: "0.5" };
    Condition = "a comparison is part of an `if`", { CONDITION.to_owned() },
        ["x «>» 0", "x «=»= 1", "x «!»= 1", "x «<»= 1", "x «?» 1 : 2"];
    NoOperator { sign: char } =
        "`{sign}` is not an operator",
        {
            let angles = if *sign == '%' { "; angles need no remainder, since `sin` and `cos` are periodic" } else { "" };
            format!("the operators are `+ - * / ^`{angles}")
        },
        ["x «%» 2"] { sign: '%' }, ["x«!»"] { sign: '!' };
    OtherProduct { sign: &'static str } =
        "`{sign}` is not an operator",
        "write `*`: `M * v`, `v * w` for the inner product; products entry by entry are `a[i] * b[i]`",
        ["M «@» q"] { sign: "@" }, ["q «.»* q"] { sign: ".*" };
    OtherBrackets =
        "only parentheses group an expression",
        "write `(a + b)`; brackets enclose an index or the entries of a vector, braces the lines of a rule or a check",
        ["x + 2 * «[»x + 1]", "force x = 2 * «[»x + 1];", "2 * «{»x + 1}"];
    Field { name: String } =
        "`.{name}`: names have no fields",
        {
            match name.as_str() {
                "T" => "write `transpose(M)`",
                "dot" => "write `dot(x)` for the velocity of `x`",
                _ => "write plain names: `m` for a parameter, `q[0]`, `q[1]` for entries of an array",
            }
            .to_owned()
        },
        ["M.«T»"] { name: "T" }, ["x.«y»"] { name: "y" }, ["x.«dot»"] { name: "dot" };
    Comment = "`#` does not start a comment", "write `// …`",
        ["«#» the mass coord x; L = dot(x)^2 / 2;"];
    DecimalComma =
        "a decimal fraction uses a point, not a comma", "write `1.5`; a comma separates definitions",
        ["param a = 1, «5»;", "L = 0«,»5 * dot(x)^2;", "(1 + 0«,»5)", "check { x = 0, «5»; h = 1; };"];
    FunctionDefinition { name: String } =
        "`{name}(…)`: a function is declared with `fn`",
        "write `fn {name}(a) = …;`, or `let {name} = …;` for an expression without arguments",
        ["let u«(»x) = x;"] { name: "u" };
    Mutable = "`let` names an expression and cannot be mutable", "remove `mut`",
        ["let «mut» u = x;"];
    ColonEquals = "a definition uses `=`", "write `=`",
        ["let y «:»= x;"];
    AddedForce =
        "the force on a coordinate is written once", "write `force x = …;`, with the sum of all forces on `x`",
        ["force x «+»= 1;"];
    InclusiveRange = "a range excludes its end", "write `0..N + 1` for the indices 0 to N",
        ["sum(i in 0«.».=2, i)"];
    IndexBehind =
        "only a name can have an index",
        "write `dot(q[0])` for the velocity of `q[0]`, and name other vectors with `let`, as in `let d = a + b;`, `d[0]`",
        ["(q + r[0])«[»0]", "dot(q)«[»0]", "[1, 2]«[»0]", "dot(x)«[»0]"];
    UnitInBrackets = "a number cannot have a unit", "remove the brackets; use one system of units for all numbers",
        ["9.81 «[»m / s^2] * x", "param a = 1.0 «[»kg];"];
    RangeOf { function: String } =
        "`{function}` does not take a range",
        {
            match function.as_str() {
                "product" | "prod" | "Π" => {
                    "only `sum` takes a range: write the factors one by one, `q[0] * q[1] * q[2]`; of positive ones the product is \
                     `exp(sum(i in 0..8, ln(q[i])))`"
                }
                _ => "only `sum` takes a range, as in `sum(i in 0..8, q[i])`",
            }
            .to_owned()
        },
        ["«product»(i in 0..3, i * x)"] { function: "product" },
        ["sin(«prod»(i in 0..3, i * x))"] { function: "prod" }, ["«max»(i in 0..3, i * x)"] { function: "max" };
    CoordinateWithArguments { name: String } =
        "`{name}` is a coordinate, not a function",
        "write `{name}` for its value at the time `t`, `{name} * (…)` for a product; delays (values at other times) are not \
         supported",
        ["«x»(t - m)", "«x»(0)"] { name: "x" };
    EntryInParentheses { name: String } =
        "`{name}` is an array, not a function", "write an entry as `{name}[0]`; indices start at 0",
        ["«q»(1)", "coord q[2], x; L = dot(x)^2 + dot(q[0])^2 - «q»(1) * x;"] { name: "q" };
    MissingSemicolon { after: String } =
        "`;` is missing after `{after}`", "every clause ends with `;`; entries of one list are separated by `,`",
        ["coord «x» L = dot(x)^2;"] { after: "x" },
        ["L = dot(x)^«2»", "const a = 1, b = «2» coord x; L = dot(x)^2;"] { after: "2" },
        ["let a = (1 + x«)» let b = 2; L = dot(x)^2;"] { after: "(…)" },
        ["let a = «1» L = dot(x)^2;", "discretize { Ld = h * L(t0, q0, (q1 - q0)/h) * «1» };",
         "check { x = «1» y = 2; h = 1; };",
         "param m = «1» input u = 0; coord x; L = m * u * dot(x)^2;"] { after: "1" },
        ["L = dot(x)^2; discretize «midpoint»"] { after: "midpoint" };
    MissingValue { name: String, clause: Option<&'static str> } =
        "`{name}` has no value",
        {
            match clause {
                None if Defining::of(name).is_some_and(|clause| !clause.has_names()) => {
                    format!("write `{name} = …;`, one function for all coordinates")
                }
                None => format!("write `{name} = …`"),
                Some("input") => {
                    format!("write `{name} = 0.0`: an `input` needs a default, its value until a controller sets it")
                }
                Some(_) => format!("write `{name} = 1.0`: a `param` needs a default; its field can override it"),
            }
        },
        ["constraint «c»;", "const «c»;"] { name: "c", clause: "" },
        ["const N = 2; param «m»[2]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;", "param «m»;",
         "param a = 1, «m»;", "param «m» coord x; L = dot(x)^2 / 2;"] { name: "m", clause: "param" },
        ["«dissipation» x = dot(x)^2;"] { name: "dissipation", clause: "" },
        ["coord x; «L»;"] { name: "L", clause: "" },
        ["input «u»;", "input w = 1.0, «u»,  coord x; L = dot(x)^2 / 2;", "input «u»[3];"]
            { name: "u", clause: "input" },
        ["let «y»;"] { name: "y", clause: "" };
    ValueOfCoordinate =
        "a coordinate is declared without a value",
        "write `coord x;`: set the initial value in the `State` of a run, or for checks in `check {{ x = 1; h = 0.01; }}`; declare a constant as a `param`",
        ["rotation R, S[2]; rotation Q «=» 1;", "coord y «=» 1;"];
    ForceWithoutCoordinate =
        "this force names no coordinate", "write the coordinate that it acts on: `force x = …;`, `force q[0] = …;`",
        ["force «=» x;", "force«(»x) = x;", "force dot«(»x) = 1;"];
}

impl Habit {
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
