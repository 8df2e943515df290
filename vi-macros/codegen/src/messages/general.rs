//! Mistakes of any kind: names, constants, lengths, clauses, rules, checks, sizes.

use super::words::{self, did_you_mean};
use super::{
    ArrayMistake, Character, ConstraintMistake, FunctionMistake, Habit, HamiltonianMistake, constraints, functions,
};
use crate::{clause, rules};
use vi_expr::TooLarge;

/// The size at which systems end.
pub(super) const LARGE: &str = "use fewer coordinates or a simpler Lagrangian; terms that repeat, written as `sum(i in 0..N, …)` over arrays, become \
    loops, unless a rule is written out";

/// The functions.
const FUNCTIONS: &str = "the functions are sqrt exp ln sin cos tan asin acos atan atan2 sinh cosh tanh abs sign hypot pow max min clamp sum cross norm \
    transpose, in a rule L f, elsewhere dot; declare others with `fn` or `table`";

/// Help for a range.
const RANGE: &str = "`sum(i in 0..3, q[i])` for the indices 0 to 2";

/// The clauses.
fn clauses() -> String {
    format!("the clauses are {}", clause::words().collect::<Vec<_>>().join(", "))
}

/// Why an expression cannot use a declared name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// Its declaration comes later, or is this one.
    Below,
    /// It is a parameter; the expression is a constant.
    Parameter,
    /// It is a coordinate; the expression is a constant.
    Coordinate,
    /// It is a momentum; the expression is a constant.
    Momentum,
    /// It is a `let`; the expression is a constant.
    Let,
    /// It is a constraint.
    Constraint,
}

/// Why a mass matrix is singular in every state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Singular {
    /// This coordinate contributes nothing to it.
    Massless(String, Massless),
    /// L is homogeneous of degree 1 in the velocities: v·L_v = L, so that M v = 0.
    Homogeneous,
    /// Some directions of motion have no kinetic energy.
    Dependent,
    /// Some directions of motion that the constraints allow have no kinetic energy, with a coordinate that they move.
    Allowed(Option<String>),
}

/// Why a system whose L is linear in the velocities has no steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FirstOrder {
    /// The number of coordinates is odd.
    Odd,
    /// L contains the velocities of more or less than half of the coordinates.
    Halves,
    /// The momenta do not determine the coordinates without a velocity.
    Singular,
    /// It has this clause.
    Clause(&'static str),
    /// The force on this coordinate depends on a velocity that L does not contain.
    Force(String),
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

catalogue! {
    /// A mistake in the input.
    Message (Array(ArrayMistake), Character(Character), Constraint(ConstraintMistake), Function(FunctionMistake), Habit(Habit), Hamiltonian(HamiltonianMistake)):

    Duplicate { name: String } = "the name `{name}` is declared twice", "rename one of them",
        ["sum(i in 0..2, «i» in 0..2, 1)", "sum(i in 0..2, sum(«i» in 0..2, 1))"] { name: "i" },
        ["let w[0] = x; let «w» = 2;", "let w = s; let «w»[2] = 3;"] { name: "w" },
        ["let «q»[3] = x;"] { name: "q" }, ["constraint «l» = x - y;"] { name: "l" },
        ["let gap = x - y; constraint «gap» = gap;"] { name: "gap" },
        ["constraint c = x - y, «c» = x - z;", "constraint c[i in 0..2] = q[i] - q[i + 1], «c» = x;"] { name: "c" },
        ["fn g(a, «a») = a; coord x; L = dot(x)^2 / 2 - g(x, 1);", "param a = 1; input «a» = 1;",
         "param a = 1, «a» = 2; coord x; L = a * dot(x)^2;"] { name: "a" },
        ["fn g(a) = a; coord «g», x; L = dot(x)^2 / 2 - x;"] { name: "g" }, ["sum(«x» in 0..2, 1)"] { name: "x" },
        ["const N = 2; param m[2] = 1, «m» = 2; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"] { name: "m" },
        ["coord x; L = dot(x)^2; discretize { Ld = sum(«q0» in 0..2, 1); }"] { name: "q0" };
    Reserved { name: String } = "the name `{name}` is reserved", { another_name(name) },
        ["constraint «t» = x - y;", "param «t» = 1;"] { name: "t" }, ["param «r#type» = 1;"] { name: "r#type" },
        ["param «L» = 1; coord x; L = dot(x)^2;", "param «L» = 1; coord x; L = dot(x)^2 / L;"] { name: "L" },
        ["param «f» = 1; coord x; L = dot(x)^2; force x = -f;"] { name: "f" }, ["param «sin» = 1;"] { name: "sin" },
        ["param «type» = 1.0;"] { name: "type" }, ["param «async» = 1.0;"] { name: "async" },
        ["param «dyn» = 1.0;"] { name: "dyn" }, ["param «_» = 1.0;"] { name: "_" },
        ["coord «gen»; L = dot(gen)^2;"] { name: "gen" }, ["param «r#gen» = 1;"] { name: "r#gen" };
    ReservedType { name: String } =
        "the name `{name}` is reserved", "generated code uses this type; choose another name";
    SecondDerive { name: String } =
        "every system implements `{name}`", "remove `{name}`; other traits may be derived";
    AttributeOfClause =
        "this attribute has no meaning here",
        "write doc comments before a clause, attributes of the field before a `param` or an `input`, and `#[cfg]` before the `struct`",
        ["«#»[inline] constraint c = x - y;", "«#»[cfg(test)] const a = 1;",
         "/// Words.\n «#»[allow(x)] const a = 1;", "«#»[cfg(test)] coord y;", "/// Words.\n «#»[allow(x)] coord y;",
         "«#»[cfg(test)] let a = 1;", "/// Words.\n «#»[allow(x)] let a = 1;", "«#»[cfg(test)] force x = 1;",
         "/// Words.\n «#»[allow(x)] force x = 1;", "«#»[cfg(test)] dissipation = dot(x)^2;",
         "/// Words.\n «#»[allow(x)] dissipation = dot(x)^2;", "«#»[cfg(test)] check { h = 1; };",
         "/// Words.\n «#»[allow(x)] check { h = 1; };", "«#»[cfg(test)] param a = 1;",
         "«#»[cfg_attr(test, doc = \"\")] param a = 1;", "«#»[derive(Clone)] param a = 1;",
         "«#»[cfg(test)] input u = 0.0;"];
    AttributeOfText =
        "a text alone has no attributes with code",
        "write documentation as `/// text`, and other attributes in a crate of yours, `vi-lab new NAME --python`";
    Unknown { name: String, near: Option<String> } = "unknown name `{name}`", { words::help_for_name(name, near.as_ref()) },
        ["«unknown»[0][1]"] { name: "unknown", near: "" },
        ["let w[0] = x; let w[i in 1..N] = «b»; let w[N] = w[0] + r[0]; force x = w; force q = w + q;",
         "let w = «b»; let u = w + r[0]; force x = u * r[1] * u; force q[0] = norm(w);", "time_scale = 1 + «b»;"]
            { name: "b", near: "" },
        ["«max» * x"] { name: "max", near: "" }, ["fn g(a) = a * «b»; coord x; L = dot(x)^2 / 2 - g(x);",
         "const a = 1; coord q[4]; let e[0] = «b»; L = sum(i in 0..4, dot(q[i])^2 + e[i] * q[i]) + a * dot(q[0]); force q[0] = e;",
         "const a = 1; coord q[«b»]; let e = q[1]; L = sum(i in 0..4, dot(q[i])^2 + e * q[i]) + a * dot(q[0]); force q[0] = e;"]
            { name: "b", near: "" },
        ["coord x; fn a(u) = u * «w»; fn b(w) = a(3) * w; L = dot(x)^2 / 2 - b(x);"] { name: "w", near: "" },
        ["coord q[«M»]; L = 1;"] { name: "M", near: "" }, ["coord x; L = sum(i in 0..5, i * «y» * dot(x)^2);",
         "coord x; L = dot(x)^2 / 2; force x = -x; discretize { Ld = «y» * L(t0, q0, q1); }"] { name: "y", near: "" },
        ["param mass = 1; coord x; L = «mas» * dot(x)^2;"] { name: "mas", near: "mass" },
        ["coord x; L = «g» * dot(x)^2;"] { name: "g", near: "" },
        ["coord x; L = dot(x)^2; discretize { Ld = «q2»; }"] { name: "q2", near: "q0" },
        ["coord θ; L = dot(θ)^2 - «theta»;"] { name: "theta", near: "θ" };
    Absent { name: String, absence: Absence } =
        {
            match absence {
                Absence::Below => format!("`{name}` is not declared before this line"),
                Absence::Parameter => format!("`{name}` is a parameter: it has no value at compile time"),
                Absence::Coordinate => format!("`{name}` is a coordinate: it has no value at compile time"),
                Absence::Momentum => format!("`{name}` is a momentum: it has no value at compile time"),
                Absence::Let => format!("`{name}` is a `let`, which a constant cannot use"),
                Absence::Constraint => ConstraintMistake::Value { name: name.clone() }.what(),
            }
        },
        {
            match absence {
                Absence::Below => "move its declaration up: a `let` or `const` uses earlier declarations only".to_owned(),
                Absence::Constraint => ConstraintMistake::Value { name: name.clone() }.help(),
                _ => "write defaults, `const`s and lengths with numbers and `const`s; name an expression of parameters or coordinates with \
                      `let`, as in `let w = sqrt(k / m);`".to_owned(),
            }
        },
        ["let w[0] = «w»;"] { name: "w", absence: Absence::Below },
        ["param K[2][2] = 1; const m[2] = [1, «K»]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "K", absence: Absence::Parameter },
        ["const N = 2; param m[«x»] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;",
         "const N = 2; param m[2] = [1, «x»]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;",
         "coord x; const a = «x»; L = dot(x)^2;"] { name: "x", absence: Absence::Coordinate },
        ["const N = 2; param m[2] = 1; const a = «m»[0]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", absence: Absence::Parameter },
        ["param k = 1, m = 1, w = sqrt(«k»/2); coord x; L = m * dot(x)^2 - k * w * x^2;"]
            { name: "k", absence: Absence::Parameter },
        ["param a = 1; const b = «a»;"] { name: "a", absence: Absence::Parameter },
        ["param k = «p»; coord x; momentum p of x; H = k * p^2;"] { name: "p", absence: Absence::Momentum },
        ["coord q[«n»]; let n = 3; L = 1;"] { name: "n", absence: Absence::Let },
        ["coord x; let a = «b»; let b = 1; L = a * dot(x)^2;", "coord x; let b = «b»; L = b * dot(x)^2;",
         "coord x; const a = «b», b = 1; L = a * b * dot(x)^2;"] { name: "b", absence: Absence::Below };
    UnknownFunction { name: String, near: Option<String> } =
        "unknown function `{name}`",
        { words::function(name).unwrap_or_else(|| did_you_mean(near.as_ref(), FUNCTIONS)) },
        ["«cbrt»(x)"] { name: "cbrt", near: "" },
        ["«cros»(q, q)"] { name: "cros", near: "cross" }, ["«cosine»(x)"] { name: "cosine", near: "" },
        ["«sinn»(x)"] { name: "sinn", near: "sin" },
        ["coord x; L = dot(x)^2; discretize { Ld = «sine»(h); }"] { name: "sine", near: "sin" },
        ["coord x; L = dot(x)^2; discretize { Ld = «dot»(q0); }"] { name: "dot", near: "" };
    Arity { name: String, takes: usize, given: usize } =
        { functions::takes(name, *takes, *given) },
        {
            match takes {
                1 => format!("write `{name}(a)`"),
                2 => format!("write `{name}(a, b)`"),
                _ => format!("write `{name}(t0, q0, (q1 - q0)/h)`: a time, coordinates, velocities"),
            }
        },
        ["«cross»(q)"] { name: "cross", takes: 2, given: 1 },
        ["rotation R, S[2]; force x = «turn»(R) * [1, 0, 0];"] { name: "turn", takes: 2, given: 1 },
        ["«atan2»(x)"] { name: "atan2", takes: 2, given: 1 }, ["«sin»(x, 1)"] { name: "sin", takes: 1, given: 2 },
        ["«sin»()"] { name: "sin", takes: 1, given: 0 },
        ["coord x; L = dot(x)^2; discretize { Ld = «L»(t0, q0); }"] { name: "L", takes: 3, given: 2 };
    FunctionWithoutArguments { name: String } =
        "`{name}` is a function", "write its argument: `{name}(…)`; a power follows it, `{name}(…)^2`",
        ["«cross»"] { name: "cross" }, ["fn g(a) = a; coord x; L = dot(x)^2 / 2 - «g» * x;"] { name: "g" },
        ["«sum»"] { name: "sum" }, ["«sin»^2(x)", "«sin»", "dot(«sin»)"] { name: "sin" },
        ["coord x; L = dot(x)^2; discretize { Ld = «L»; }"] { name: "L" };
    DotOfConstant { name: String } =
        "`dot({name})`: `{name}` does not change with time",
        "`dot` is the derivative with respect to time: its argument must depend on time or a coordinate",
        ["dot(«s»)"] { name: "s" },
        ["const N = 2; param m[2] = 1; let a = dot(«m»[0]); coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;",
         "coord x; let m[i in 0..2] = i; L = dot(x)^2 * dot(«m»[0]);"] { name: "m" },
        ["dot(«1e150»)"] { name: "1e150" },
        ["param a = 1; const e = 2; let b = a * pi; coord x; L = dot(x)^2 * dot(«a»);"] { name: "a" },
        ["param a = 1; const e = 2; let b = a * pi; coord x; L = dot(x)^2 * dot(«pi»);"] { name: "pi" },
        ["param a = 1; const e = 2; let b = a * pi; coord x; L = dot(x)^2 * dot(«e»);"] { name: "e" },
        ["param a = 1; const e = 2; let b = a * pi; coord x; L = dot(x)^2 * dot(«b»);"] { name: "b" },
        ["param a = 1; const e = 2; let b = a * pi; coord x; L = dot(x)^2 * dot(«2»);"] { name: "2" };
    DotOfOther { name: String } = "`dot({name})`: `{name}` is not a coordinate", "in a check, `dot(…)` takes a coordinate",
        ["check { dot(«l») = 1; h = 1; };"] { name: "l" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { dot(«mass») = 1; h = 1; };"]
            { name: "mass" };
    Acceleration { name: String } =
        "an expression cannot depend on the acceleration `{name}`",
        "use positions, velocities, time and parameters; an inertial term belongs in `L`",
        ["dot(«dot»(q) * q)", "constraint c = dot(«x» * dot(y));",
         "coord x; let v = x + dot(x), w[i in 0..2] = i * dot(x); L = dot(x)^2; force x = dot(«x» * v);",
         "coord x; let v = x + dot(x), w[i in 0..2] = i * dot(x); L = dot(x)^2; force x = dot(«2» * dot(x));"]
            { name: "dot(…)" },
        ["constraint c = «dot»(dot(x)) + y;", "«dot»(dot(x))"] { name: "dot(dot(…))" }, ["«xddot»"] { name: "xddot" },
        ["«ddot»(x)"] { name: "ddot(…)" },
        ["coord x; let v = x + dot(x), w[i in 0..2] = i * dot(x); L = dot(x)^2; force x = dot(«v»);"]
            { name: "dot(v)" },
        ["coord x; momentum p of x; let v = dot(«p»); H = p^2; force x = v;"] { name: "dot(p)" },
        ["coord x; let v = x + dot(x), w[i in 0..2] = i * dot(x); L = dot(x)^2; force x = dot(«w»[1]);"]
            { name: "dot(w[…])" },
        ["coord θ; L = dot(θ)^2; force θ = -«θ_ddot»;"] { name: "θ_ddot" }, ["«ẍ»"] { name: "ẍ" };
    NotConstant { name: String } =
        "the value of `{name}` is not a constant", "use numbers, `pi`, functions and earlier `const`s here",
        ["param c[4] = 0; coord x; table g(a) = [(0, 1), (1, «x»)]; L = c[0] * dot(x)^2 / 2 - dot(x)^2 - g(x);"]
            { name: "g" },
        ["check { x = «l»; h = 1; };"] { name: "x" }, ["check { h = «x»; };"] { name: "h" },
        ["const a = «t»;"] { name: "a" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { mass = «h»; h = 1; };"] { name: "mass" };
    NotFinite { name: String } = "the value of `{name}` is not finite", { NO_VALUE.to_owned() },
        ["param m[2] = 1, K[2][2] = [[1, «exp»(1000)], [1, 2]]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "K" },
        ["param K[2][2] = 1; const m = [1, «exp»(1000)]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;",
         "const N = 2; param m[2] = [1, «exp»(1000)]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"] { name: "m" },
        ["check { x = «exp»(1000); h = 1; };"] { name: "x" }, ["const a = «exp»(1000);"] { name: "a" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { mass = «exp»(1000); h = 1; };"]
            { name: "mass" };
    DivisionByZero = "division by zero", "the denominator is identically zero; check it",
        ["check { x = 1 / «0»; h = 1; };",
         "const a = 1 / «0»;", "coord x; L = dot(x)^2 / («x» - x);", "sin(x / («t» - t))",
         "exp(1 / («ln»(2) + ln(3) - ln(6))) * x", "x^2 / («sqrt»(2) * sqrt(3) - sqrt(6))",
         "coord x; L = dot(x)^2 - x^2; discretize { Ld = h * L(t0, q0, (q1 - q0) / («h» - h)); }",
         "coord x; L = dot(x)^2 - x^2; discretize { Ld = h * L(t0, q0, (q1 - q0) / («t1» - t0 - h)); }",
         "let zero = x - x; time_scale = 1 / «zero»;"];
    NoValue = "this expression has no value", { NO_VALUE.to_owned() },
        ["constraint c = «ln»(-1) * x;", "const a = «ln»(0);",
         "const a = sqrt(2) - 2; param b = «sqrt»(a); coord x; L = b * dot(x)^2;", "sin(«asin»(2))",
         "x * «tan»(pi / 2)", "«0»^-1", "dissipation = «0»^dot(x);", "time_scale = «ln»(x - x);",
         "const a = «ln»(0); coord q[4]; let e[i in 0..4] = a; L = sum(i in 0..4, dot(q[i])^2 + e[i] * q[i]) + a * dot(q[0]); force q[0] = a;"];
    Undecided =
        "more than 4096 bits are needed to round this constant",
        "write it in a form whose terms do not cancel, or as a number",
        ["«sin»(10^2000) * x", "sin(1 + «cos»(10^10^6)) * x"];
    NotInteger = "this must be a constant integer", "use integers, `const`s and indices, as in `q[N - 1]`",
        ["coord q[«1.5»]; L = 1;", "coord q[«pi»]; L = 1;", "q[«x»]", "sum(i in 0..«1»/2, i)",
         "const N = 2; param m[«1.5»] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"];
    Length { given: i64, limit: usize } =
        "an array cannot have {given} coordinates", "a system has 1 to {limit} coordinates",
        ["coord r[100][«3»]; L = 1;"] { given: 300, limit: 256 }, ["coord r[2][«0»]; L = 1;",
         "rotation R, S[2]; rotation Q[«0»];", "coord q[«0»]; L = 1;",
         "const a = 1; coord q[«0»]; let e = q; L = sum(i in 0..4, dot(q[i])^2 + dot(q) * q[i]) + a * dot(q[0]); force q[0] = e;"]
            { given: 0, limit: 256 },
        ["rotation R, S[2]; rotation Q[«65»];"] { given: 65, limit: 256 },
        ["coord q[«1000»]; L = 1;"] { given: 1000, limit: 256 };
    ParametersLength { given: i64, limit: usize } =
        "an array cannot have {given} parameters", "an array of parameters has 1 to {limit} entries",
        ["param m[2] = 1, K[16][«17»] = 1; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"] { given: 272, limit: 256 },
        ["param m[2] = 1, K[2][«0»] = 1; coord x; L = (K[0][0] + m[0]) * dot(x)^2;",
         "const N = 2; param m[«0»] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"] { given: 0, limit: 256 },
        ["param m[2] = 1, K[2][«-»1] = 1; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"] { given: -1, limit: 256 },
        ["const N = 2; param m[«257»] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"] { given: 257, limit: 256 };
    ParameterValues { name: String, length: usize, values: usize } =
        "`{name}` has length {length} but a list of {values} values",
        "write {length} values, or one for all entries: `= 1.0`",
        ["param m[2] = 1, K[2][2] = [[1, 2, «3»], [3, 4, 5]]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "K[0]", length: 2, values: 3 },
        ["param m[2] = 1, K[2][«2»] = [[1], [3]]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "K[0]", length: 2, values: 1 },
        ["param m[2] = 1, K[2][2] = [[1, 2], [3, 4], «[»5, 6]]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "K", length: 2, values: 3 },
        ["param K[2][2] = 1; const m[2] = [1, 2, «3»]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "m", length: 2, values: 3 },
        ["const N = 2; param m[2] = [1, 2, «3», 4]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", length: 2, values: 4 },
        ["const N = 2; param m[«N»] = [1]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", length: 2, values: 1 },
        ["const N = 2; param m[«2»] = []; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", length: 2, values: 0 },
        ["const N = 2; param m[«3»] = [1, 2]; let a = sum(i in 0..9, m[i]); coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", length: 3, values: 2 };
    ParameterWithoutLength { name: String, lengths: String, clause: &'static str } =
        "`{name}` is not an array but has a list of values", "write its length: `{clause} {name}{lengths} = […];`",
        ["param m[2] = 1, «K» = [[1, 2], [3, 4]]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { name: "K", lengths: "[2][2]", clause: "param" },
        ["const N = 2; param «m» = [1, 2]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", lengths: "[2]", clause: "param" },
        ["input «u» = [0, 1];"] { name: "u", lengths: "[2]", clause: "input" };
    IndexRange { name: String, index: i64, first: i64, end: i64 } =
        "`{name}[{index}]` is out of range {first}..{end}",
        {
            if end <= first {
                "this array has no entries".to_owned()
            } else {
                format!("the indices are {first} to {}", end - 1)
            }
        },
        ["r[«3»]"] { name: "r", index: 3, first: 0, end: 3 },
        ["r[1][«3»]"] { name: "r[1]", index: 3, first: 0, end: 3 },
        ["dot(r[0][«-»1])"] { name: "r[0]", index: -1, first: 0, end: 3 },
        ["M[1][«2»]"] { name: "M[1]", index: 2, first: 0, end: 2 },
        ["s[«2»]"] { name: "s", index: 2, first: 0, end: 2 },
        ["ragged[2][«2»]"] { name: "ragged[2]", index: 2, first: 0, end: 2 },
        ["ragged[0][«0»]"] { name: "ragged[0]", index: 0, first: 0, end: 0 },
        ["let w[0] = x; let w[i in 1..N] = w[«i» - 2];"] { name: "w", index: -1, first: 0, end: 1 },
        ["force r[0][i in 0..«4»] = 1;"] { name: "r[0]", index: 3, first: 0, end: 3 },
        ["rotation R, S[2]; torque S[«2»] = [1, 2, 3];"] { name: "S", index: 2, first: 0, end: 2 },
        ["let e[i in 0..N] = q[«i» + 1] - q[i];", "force q[i in 0..«5»] = 1;",
         "check { dot(q[i in 0..«4»]) = 1; h = 1; };"] { name: "q", index: 3, first: 0, end: 3 },
        ["let e[i in 1..N] = q[i]; let d = e[«0»];"] { name: "e", index: 0, first: 1, end: 3 },
        ["q[«-»1]"] { name: "q", index: -1, first: 0, end: 3 },
        ["const N = 4; coord q[N], x; let e[i in 5..6] = 0; let g = e[«-»9223372036854775807]; L = sum(i in 0..N, dot(q[i])^2) + dot(x)^2;"]
            { name: "e", index: -9_223_372_036_854_775_807_i64, first: 5, end: 6 },
        ["const N = 4; coord q[N], x; let e[i in 3..3] = 0; let g = e[«3»]; L = sum(i in 0..N, dot(q[i])^2) + dot(x)^2;"]
            { name: "e", index: 3, first: 3, end: 3 },
        ["force q[«4»] = 1;"] { name: "q", index: 4, first: 0, end: 3 },
        ["const N = 2; param m[2] = 1; let a = m[«2»]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", index: 2, first: 0, end: 2 },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { k[«3»] = 1; h = 1; };",
         "param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { k[i in 0..«4»] = 1; h = 1; };"]
            { name: "k", index: 3, first: 0, end: 3 },
        ["coord x; L = dot(x)^2; discretize { Ld = q0[«1»]; }"] { name: "q0", index: 1, first: 0, end: 1 },
        ["const a = 1; coord q[4]; let e[i in 0..4] = q[«i» + 1]; L = sum(i in 0..4, dot(q[i])^2 + e[i] * q[i]) + a * dot(q[0]); force q[0] = e[1];"]
            { name: "q", index: 4, first: 0, end: 4 };
    BackwardRange { from: i64, to: i64 } =
        "the range {from}..{to} ends before it begins",
        "write the smaller bound first; the second one is not included",
        ["sum(i in 0..2, j in i..«0», 1)"] { from: 1, to: 0 }, ["let e[i in 3..«1»] = 1;"] { from: 3, to: 1 };
    NotArray { name: String } = "`{name}` is not an array", "write `{name}` without an index",
        ["r[1][2][«0»]"] { name: "r[1][2]" }, ["M[0][0][«0»]"] { name: "M[0][0]" },
        ["«x»[0][1]", "«x»[0]", "dot(«x»[0])", "force «x»[0] = 1;", "check { dot(«x»[0]) = 1; h = 1; };"]
            { name: "x" },
        ["force r[0][0][«0»] = 1;"] { name: "r[0][0]" }, ["«N»[0]"] { name: "N" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { «mass»[0] = 1; h = 1; };"]
            { name: "mass" },
        ["coord x; L = dot(x)^2; discretize { Ld = «h»[0]; }"] { name: "h" };
    UnusedParameter { name: String, is_input: bool } =
        { format!("the {} `{name}` is never used", if *is_input { "input" } else { "parameter" }) },
        "use it in `L` or in a force, or remove it",
        ["param «K»[2][2] = 1;"] { name: "K", is_input: false },
        ["param «a» = 1; coord x, y; constraint c = x - y^2; L = dot(x)^2 + dot(y)^2;",
         "param «a» = 1; time_scale = 1 + x^2;", "param «a» = 1;"] { name: "a", is_input: false },
        ["const N = 2; param m[2] = 1, «k»[4] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "k", is_input: false },
        ["input «u» = 0.0;", "input «u»[2] = 0.0;"] { name: "u", is_input: true },
        ["param a = 1, «b» = 2; coord x; L = a * dot(x)^2 + b * x - b * x;"] { name: "b", is_input: false };
    SecondDissipation = "a second `dissipation`", "add them up in one line",
        ["dissipation = dot(x)^2; «dissipation» = dot(x)^2;"];
    NoDissipation =
        "`dissipation` does not depend on any velocity",
        "Rayleigh's function is half the dissipated power, as in `c * dot(x)^2 / 2`",
        ["«dissipation» = x^2;"];
    ConstantDissipation =
        "a term of `dissipation` is linear in velocities: its force is constant",
        "write `c * dot(x)^2 / 2` for viscous friction, `c * abs(dot(x))` for dry friction; a driving force belongs in `force x = …;`",
        ["dissipation = «m» * dot(x);", "dissipation = «-»m * dot(x);",
         "dissipation = m * dot(x)^2 / 2 + «g» * dot(y);", "dissipation = m * dot(x)^2 - «sin»(t) * dot(x);",
         "let drag = m * dot(x); dissipation = dot(y)^2 + «drag»;", "dissipation = «m» * (dot(x) - dot(y));",
         "dissipation = «x» * dot(x);"];
    FeedingDissipation =
        "`dissipation` adds energy: its power `-v * ∂R/∂v` is positive",
        "reverse its sign, as in `c * dot(x)^2 / 2` with a positive `c`; a driving force belongs in `force x = …;`",
        ["dissipation = «-»m * dot(x)^2 / 2;", "dissipation = dot(y)^2 - «m» * dot(x)^2 / 2;",
         "param d = -1; force y = d; dissipation = «d» * dot(x)^2;", "dissipation = «-»1 * (dot(x)^2 + dot(y)^2);",
         "dissipation = «-»abs(dot(x))^3;", "dissipation = «-»sqrt(dot(x)^2 + l^2);",
         "dissipation = «-»exp(x) * dot(x)^4 + m * dot(y)^2;", "dissipation = «-»(dot(x) * dot(y))^2;",
         "dissipation = «-»sum(i in 0..3, dot(q[i])^2);"];
    SecondTimeScale = "a second `time_scale`", "write `time_scale` once",
        ["time_scale = 1 + x^2; «time_scale» = 1;"];
    VelocityIn { name: String, clause: &'static str } =
        "`{clause}` cannot depend on the velocities in `{name}`",
        {
            let momenta = if *clause == "H" { ", momenta" } else { "" };
            format!("use positions{momenta}, time, constants and parameters")
        },
        ["time_scale = 1 + «dot»(x)^2;"] { name: "dot", clause: "time_scale" },
        ["let speed = dot(x)^2; time_scale = 1 + «speed»;"] { name: "speed", clause: "time_scale" },
        ["let e[i in 0..3] = dot(q[i]); time_scale = 1 + «e»[0]^2;"] { name: "e", clause: "time_scale" },
        ["coord x; momentum p of x; let v = p / 2; time_scale = 1 + «v»^2; H = p^2;"] { name: "v", clause: "time_scale" },
        ["coord x; momentum p of x; H = p^2 + «dot»(x);"] { name: "dot", clause: "H" },
        ["coord x; momentum p of x; let v = dot(x); H = p^2 + «v»;"] { name: "v", clause: "H" };
    TimeScaleNotPositive =
        "the time scale is not positive", "dt = g dτ: write a g that is positive in every state of the motion",
        ["time_scale = «0»;", "time_scale = «cos»(pi);"];
    UnusedSlot { name: &'static str } =
        "`Ld` does not depend on `{name}`", "a discrete Lagrangian depends on both ends of its interval",
        ["coord x; L = dot(x)^2 / 2 - x^2; discretize { «Ld» = h * L(t0, q0, q0/h); }"] { name: "q1" },
        ["coord x; L = dot(x)^2 / 2 - x^2; discretize { «Ld» = h * L(t0, q1, q1/h); }"] { name: "q0" },
        ["coord x; L = dot(x)^2 / 2 - x^2; discretize { «Ld» = L(t0, q0, q1 - q0); }"] { name: "t0" };
    MissingLagrangian = "the system has no Lagrangian", "write `L = …;`, kinetic minus potential energy, or `H = …;` with a `momentum`";
    SecondLagrangian = "a second `L`", "write `L` once; name parts of it with `let`",
        ["coord x; L = dot(x)^2; «L» = dot(x)^2;"];
    SecondRule = "a second `discretize`", "write `discretize` once; it may list several rules by their names",
        ["discretize midpoint; discretize «midpoint»;"];
    SecondCheck = "a second `check`", "write `check` once",
        ["check { h = 1; } «check» { h = 1; };"];
    MissingStep = "the check has no step", "end it with the step, as in `h = 0.01;`",
        ["«check» { x = 1; };", "«check» { };"];
    StepNotPositive =
        "the step `h` is not positive", "write a positive step that resolves the motion, as in `h = 0.01;`",
        ["check { h = «0»; };", "check { h = «-»1; };"];
    CheckOfOther { name: String, near: Option<String> } =
        "`{name}` is neither a coordinate nor a parameter",
        {
            let parts = "a check sets coordinates, their `dot(…)`, parameters, the time `t` and the step `h`";
            did_you_mean(near.as_ref(), parts)
        },
        ["coord angle; L = dot(angle)^2; check { «angel» = 1; h = 1; }"] { name: "angel", near: "angle" },
        ["let half = l / 2; check { «mass» = 1; h = 1; };"] { name: "mass", near: "" },
        ["let half = l / 2; check { «N» = 1; h = 1; };"] { name: "N", near: "" },
        ["let half = l / 2; check { «half» = 1; h = 1; };"] { name: "half", near: "" },
        ["check { «h» = 2; h = 1; };"] { name: "h", near: "" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { «mas» = 1; h = 1; };"]
            { name: "mas", near: "mass" };
    SecondEntry { name: String } = "`{name}` is given twice", "set each coordinate, velocity and parameter once",
        ["check { r[0] = [1, 2, 3], «r»[0][0] = 1; h = 1; };"] { name: "r" },
        ["check { x = 1, «x» = 2; h = 1; };", "check { dot(x) = 1; dot(«x») = 2; h = 1; };"] { name: "x" },
        ["check { t = 1; «t» = 2; h = 1; };"] { name: "t" },
        ["check { q[i in 0..N] = i; «q»[0] = 1; h = 1; };"] { name: "q" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { mass = 1, «mass» = 1; h = 1; };"]
            { name: "mass" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { k[1] = 1, «k»[i in 0..3] = i; h = 1; };"]
            { name: "k" };
    MissingCoordinates = "the system has no coordinates", "declare them: `coord x, y;`",
        ["L = 1;"];
    ForceOnOther { name: String, near: Option<String>, coordinate: String } =
        "`{name}` has a force but is not a coordinate",
        { did_you_mean(near.as_ref(), &format!("a force acts on a coordinate: `force {coordinate} = …;`")) },
        ["const N = 2; param m[2] = 1; force «m»[0] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { name: "m", near: "", coordinate: "x" },
        ["coord r[2]; let d = r[0] - r[1]; L = dot(r) * dot(r) / 2 - d^2; force «d» = 1;"]
            { name: "d", near: "", coordinate: "r[0]" },
        ["coord x; L = dot(x)^2; force «y» = 1;"] { name: "y", near: "", coordinate: "x" };
    SecondForce { name: String } = "a second force on `{name}`", "add them up in one line",
        ["force r[0] = q; force «r»[0][1] = 1;"] { name: "r" },
        ["force q[0] = 1; force «q»[i in 0..2] = 1;"] { name: "q" }, ["force x = 1; force «x» = 2;"] { name: "x" };
    NoVelocity =
        "`L` does not depend on any velocity", "write the kinetic energy with `dot(…)`, as in `m * dot(x)^2 / 2`",
        ["coord x; «L» = x^2;"];
    SingularMass { why: Singular } =
        {
            let end = if matches!(why, Singular::Allowed(_)) { ", in a direction that the constraints allow" } else { "" };
            format!("the mass matrix ∂²L/∂v² is singular for every state{end}")
        },
        { kinetic_energy(why) },
        ["coord x, y, «z»; constraint c = x - y^2; L = dot(x)^2 + dot(y)^2 - z;"]
            { why: Singular::Massless("z".to_owned(), Massless::Absent) },
        ["coord «x», y, z; constraint c = x + y - z^2; L = (dot(x) + dot(y))^2 + dot(z)^2;",
         "coord «x», y, z; constraint c = dot(z) * x; L = (dot(x) + dot(y))^2 + dot(z)^2;"]
            { why: Singular::Allowed(Some("x".to_owned())) },
        ["coord y, z, «x»; constraint c = y - z; L = dot(y)^2 + dot(x) * sin(y);",
         "coord «x», y; L = x * dot(x) + dot(y)^2;"] { why: Singular::Massless("x".to_owned(), Massless::Linear) },
        ["coord x, «y», z; L = dot(z)^2 / 2 + x * dot(y);"]
            { why: Singular::Massless("y".to_owned(), Massless::Linear) },
        ["coord x, y, «λ»; constraint c = x; L = dot(x)^2 + dot(y)^2 + λ * y;",
         "coord «λ», x, y; L = (dot(x)^2 + dot(y)^2) / 2 + λ * (x^2 + y^2 - 1);"]
            { why: Singular::Massless("λ".to_owned(), Massless::Multiplier) },
        ["coord x; rotation «R»; L = dot(x)^2 - R[1];"] { why: Singular::Allowed(Some("R[2]".to_owned())) },
        ["coord x, «y»; L = dot(x)^2;",
         "param k = 1; coord x, «y»; L = dot(x)^2 / 2 - k * (x - y)^2 / 2; dissipation = dot(y)^2 / 2;"]
            { why: Singular::Massless("y".to_owned(), Massless::Absent) },
        ["coord x, y; «L» = (dot(x) + dot(y))^2;", "coord x, y; «L» = (dot(x) - dot(y))^2 / 2 - x^2;"]
            { why: Singular::Dependent },
        ["param m = 1, c = 3e8; coord T, x; «L» = -m * c * sqrt(c^2 * dot(T)^2 - dot(x)^2);",
         "coord x, y; «L» = sqrt(dot(x)^2 + dot(y)^2) / y;", "coord x, y; «L» = dot(x)^2 / dot(y) + dot(y) * x;"]
            { why: Singular::Homogeneous };
    FirstOrder { why: FirstOrder } = { of_first_order(why) }, { canonical(why) },
        ["coord x; «L» = x * dot(x);", "coord x, y, z; «L» = x * dot(y) - z^2;"] { why: FirstOrder::Odd },
        ["coord x, y; let s = 1 + x^2 + y^2; «L» = s * (x * dot(y) - y * dot(x)) - cos(x) - sin(y);",
         "coord a, b, c, d; «L» = b * dot(a) - c^2 - d^2;"] { why: FirstOrder::Halves },
        ["coord x, y; «L» = x * dot(x) - y^2;", "coord a, b, c, d; «L» = (c + d) * (dot(a) + dot(b)) - c^2;"]
            { why: FirstOrder::Singular },
        ["coord x, y; L = x * dot(y) - x^2 - y^2; «time_scale» = 1 + x^2;"] { why: FirstOrder::Clause("time_scale") },
        ["coord x, y; L = x * dot(y) - x^2 - y^2; discretize «midpoint»;",
         "coord x; momentum p of x; H = p^4 / 4 + x^2; discretize «midpoint»;"] { why: FirstOrder::Clause("discretize") },
        ["coord x, y; L = x * dot(y) - x^2 - y^2; force «y» = -dot(x);"] { why: FirstOrder::Force("y".to_owned()) };
    UnknownRule { name: String, near: Option<String> } =
        "unknown rule `{name}`",
        {
            let rules = || format!("the rules are {}; {}", rules::list(), words::GAUSS);
            words::rule(name).unwrap_or_else(|| did_you_mean(near.as_ref(), &rules()))
        },
        ["discretize «midpont»;"] { name: "midpont", near: "midpoint" },
        ["discretize «gaus»;"] { name: "gaus", near: "gauss" },
        ["discretize midpoint, «trapzoidal»;"] { name: "trapzoidal", near: "trapezoidal" },
        ["discretize «simpson»;"] { name: "simpson", near: "" };
    RepeatedRule { name: String } = "the rule `{name}` is listed twice", "list each rule once; the first is the default",
        ["discretize gauss, midpoint, «gauss»;"] { name: "gauss" },
        ["discretize midpoint, «midpoint»;"] { name: "midpoint" };
    WrittenInList =
        "a written-out rule cannot appear in a list of names", "write it alone: `discretize {{ … }}`",
        ["discretize midpoint, «{» Ld = h * L(t0, q0, (q1 - q0)/h); };",
         "discretize { Ld = h * L(t0, q0, (q1 - q0)/h); }«,» midpoint;"];
    UnknownSlot { name: String } =
        "a rule has no line `{name}`", "the lines are Ld, fd_minus, fd_plus, gd_minus, gd_plus",
        ["coord x; L = dot(x)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h); «gd» = 0; }"] { name: "gd" };
    MissingSlot { name: &'static str } =
        "the rule has no line `{name}`",
        {
            match *name {
                "Ld" => "write `Ld = …;`",
                _ => "the system has a force: write all lines, or only `Ld`, in terms of `L`",
            }
            .to_owned()
        };
    SecondSlot { name: String } = "a second `{name}` in the rule", "write each line of a rule once",
        ["coord x; L = dot(x)^2; discretize { Ld = h * L(t0, q0, (q1 - q0)/h); «Ld» = h; }"] { name: "Ld" };
    NotInRule { name: String } =
        "a rule cannot depend on `{name}`", "a rule can use t0, t1, h, q0, q1, L, f, constants and parameters",
        ["coord x; L = dot(x)^2; discretize { Ld = «x»; }"] { name: "x" };
    FieldInArgument =
        "`L` or `f` in an argument of `L` or `f`", "write times, coordinates and velocities as their arguments",
        ["coord x; L = dot(x)^2; discretize { Ld = «L»(t0, q0, h * f(t0, q0, q1)); }"];
    Shape { needs: &'static str } =
        "a {needs} is needed here",
        "t0, t1, h and L are numbers; q0, q1 and f are vectors; `*` of two vectors is their dot product",
        ["coord x; L = dot(x)^2; discretize { Ld = L(t0, «t0», q1); }"] { needs: "vector" };
    UnknownClause { found: String, near: Option<String>, is_defined: bool, is_coordinate: bool } =
        "unknown clause `{found}`",
        {
            match words::clause(found) {
                _ if *is_coordinate => words::RUN.to_owned(),
                Some(help) => help,
                None if *is_defined => {
                    let part = format!("write `param {found} = …;` for a parameter, `let {found} = …;` to name a part");
                    did_you_mean(near.as_ref(), &part)
                }
                None => did_you_mean(near.as_ref(), &clauses()),
            }
        },
        ["«constrant» rod = x - y;"]
            { found: "constrant", near: "constraint", is_defined: false, is_coordinate: false },
        ["«parm» a = 1;"] { found: "parm", near: "param", is_defined: false, is_coordinate: false },
        ["«T» = dot(x)^2 / 2;"] { found: "T", near: "", is_defined: true, is_coordinate: false },
        ["«inptu» u = 0.0;"] { found: "inptu", near: "input", is_defined: false, is_coordinate: false },
        ["coord z; «z» = 1;", "coord z; «z»(0) = 1;"] { found: "z", near: "", is_defined: false, is_coordinate: true },
        ["«time_scales» = 1;"] { found: "time_scales", near: "time_scale", is_defined: true, is_coordinate: false };
    Expected { what: &'static str } =
        "expected {what}",
        {
            let form = if what.contains("range") { RANGE } else { "a clause as `name = expression;` and a sum as `a + 2 * b`" };
            format!("write {form}")
        },
        ["sum(i in 0..2, j in 0..i«)»", "sum(i in 0..2 «i»)"] { what: "`,` and what is summed" },
        ["param «,»;", "coord x,«,» y; L = dot(x)^2;", "discretize midpoint, «,»;", "param «1» = 1;"]
            { what: "a name" },
        ["sum(«0»..2, i)"] { what: "a range, as in `i in 0..8`" },
        ["sum(i in 0«,» 2, i)", "sum(i in range(3)«,» i)"] { what: "`..` and the end of the range" },
        ["const N = 2; param m[«i» in 0..2] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { what: "a length, as in `q[8]`" },
        ["check { «sin»(x) = 1; h = 1; };"] { what: "a coordinate, `dot(…)`, a parameter, `t` or `h`" },
        ["check { dot(x «x») = 1; h = 1; };"] { what: "`)`" },
        ["check { x = 1 «{»} h = 1; };"] { what: "an operator, `,` or `;`" },
        ["coord x; L = dot(x)^2; check «;»"] { what: "`{` and a place, as in `{ x = 1; h = 0.01; }`" },
        ["discretize midpoint «trapezoidal»;"] { what: "`,` or `;`" },
        ["«;» coord x; L = dot(x)^2 / 2;"] { what: "a clause" }, ["param a «1»;"] { what: "`=`" },
        ["L = dot(x)^2 «,» x;"] { what: "an operator or `;`" },
        ["L = dot(x)^2 * «;»"] { what: "a number, a name or `(`" }, ["(x«,» x)"] { what: "an operator or `)`" },
        ["hypot(x «;» x)"] { what: "an operator, `,` or `)`" };
    NoStruct =
        "expected `struct Name {{ … }}`",
        "write the text of a system, as `struct Pendulum {{ coord x; L = dot(x)^2 / 2 - x^2; }}`, not the name of a file";
    Wrapped =
        "a system begins inside of `lagrangian! {{ … }}`",
        "write the `struct Name {{ … }}` alone, without `lagrangian!` and its braces";
    NotPeriodic { what: String, angle: String, name: String, ratio: Option<String> } =
        "{what} is not periodic in the angle `{angle}`: it changes when `{angle}` makes a turn of 2π",
        {
            match ratio {
                Some(ratio) => format!(
                    "write its ratio with `const`, as in `const n = 3;` or `const n = 33 / 20;`: with a rational number the \
                     constraint holds modulo whole turns, with the parameter `{ratio}` it does not; or declare `{name}` with `coord`"
                ),
                None => format!(
                    "declare `{name}` with `coord`, or use it in functions of period 2π, as `cos({angle})` and `sin(2 * {angle})`; write a \
                     constant torque as a force, `force {angle} = …;`"
                ),
            }
        },
        ["angle θ; coord x; constraint «roll» = x - θ^2; L = dot(x)^2 + dot(θ)^2;"]
            { what: "the constraint `roll`", angle: "θ", name: "θ", ratio: "" },
        ["angle θ, φ; coord x; constraint «gear»[i in 0..1] = sin(θ) - φ * x; L = dot(x)^2 + dot(θ)^2 + dot(φ)^2;"]
            { what: "the constraint `gear`", angle: "φ", name: "φ", ratio: "" };
    NotDecimal = "not a decimal number", "write integers and decimals, as in `2`, `0.5` or `1.6e-19`",
        ["«0x10»", "«0b11» * x", "«'c'» * x"];
    NumberRange = "this number is outside the range of double precision", "choose other units",
        ["1 / «exp»(exp(exp(10))) * x", "«exp»(-exp(exp(10))) * x",
         "param a = «exp»(-800); coord x; L = a * dot(x)^2;", "check { x = «1e-200» * 1e-200; h = 1; };", "«1e400»",
         "«1e999999999» * x", "«1e-999999999» * x", "«1e99999999999999999999999» * x", "«1e-310» * x", "«1e309» * x"];
    NoDerivative { expression: String, by: String } =
        "`{expression}` has no derivative with respect to `{by}`",
        "its derivative divides by zero, or takes the logarithm of zero or of a negative number, for every state; rewrite the expression",
        ["constraint «c» = 0^x - y;"] { expression: "pow(0, x) - y", by: "a coordinate or the time" },
        ["coord x; «L» = dot(x)^2 / 2 - 0^dot(x);"] { expression: "pow(0, dot(x))", by: "dot(x)" },
        ["coord x; «L» = dot(x)^2 / 2 - 3 * sin(2 * x) * 0^x;"] { expression: "pow(0, x)", by: "x" },
        ["coord x; «L» = dot(x)^2 / 2 - x * (-2)^t;"] { expression: "pow(-2, t)", by: "t" },
        ["coord x; «L» = dot(x)^2 / 2 - x^2 * asin(x / sqrt(x^2));"] { expression: "asin(x/sqrt(x^2))", by: "x" },
        ["coord «x»; L = dot(x)^2 / 2; force x = x + (-1)^dot(x);"] { expression: "pow(-1, dot(x))", by: "dot(x)" };
    CoefficientRange =
        "the equations have a coefficient outside the range of double precision",
        "choose other units, or smaller exponents";
    TooDeep { limit: usize } = "this expression is nested deeper than {limit} levels", "name parts of it with `let`";
    TooLong { limit: usize } =
        "the system is longer than {limit} tokens", "write repeated terms with arrays and `sum`";
    LongName { limit: usize } = "this name is longer than {limit} letters", "choose a shorter one";
    TooManyCoordinates { limit: usize } =
        "the system has more than {limit} coordinates", "use fewer coordinates or a simpler Lagrangian";
    TooLarge { size: TooLarge } =
        {
            match size {
                TooLarge::Terms { limit } => format!("the expanded system has more than {limit} terms"),
                TooLarge::Work { limit } => format!("the system takes more than {limit} steps of algebra"),
            }
        },
        { LARGE.to_owned() },
        ["sum(i in 0..1000000000, «1»)"] { size: TooLarge::Terms { limit: 85_000 } };
    Tangents { arrays: Vec<String>, bytes: usize, most: usize } =
        {
            let tenths = bytes.div_ceil(100_000);
            format!("the tangents of `{}` need {}.{} MB of the stack", arrays.join("`, `"), tenths / 10, tenths % 10)
        },
        "declare at most {most} entries";
    AfterSystem = "unexpected text after the system", "one `lagrangian!` holds one `struct`";
    More { count: usize } = "{count} more mistakes are not shown", "correct those above, and compile again";
    Internal { what: &'static str } =
        "internal error: the operations of `{what}` do not compute its formula", "please report this system";
}

impl Message {
    /// What is wrong, then the correction.
    #[must_use]
    pub fn text(&self) -> String {
        format!("{}\nhelp: {}", self.what(), self.help())
    }
}

/// Help for an expression without a value.
const NO_VALUE: &str = "look for a division by zero, or a root or logarithm of a negative number";

/// Help for a reserved name.
fn another_name(name: &str) -> String {
    match name {
        "t" => "`t` is the time; choose another name".to_owned(),
        "L" | "f" => format!("`{name}` denotes the Lagrangian or the force; choose another name"),
        _ => "choose another name".to_owned(),
    }
}

/// What is wrong with an L that is linear in the velocities.
fn of_first_order(why: &FirstOrder) -> String {
    match why {
        FirstOrder::Odd | FirstOrder::Halves | FirstOrder::Singular => {
            "`L` is linear in the velocities, and has no canonical form".to_owned()
        }
        FirstOrder::Clause(clause) => format!("a system of first order takes no `{clause}`"),
        FirstOrder::Force(name) => format!("the force on `{name}` depends on a velocity that `L` does not contain"),
    }
}

/// What to write instead.
fn canonical(why: &FirstOrder) -> String {
    match why {
        FirstOrder::Odd => "such a system has an even number of coordinates, and the velocities of half of them in `L`, as in \
                            `x * dot(y) - H`; any other motion needs a kinetic energy, as in `m * dot(x)^2 / 2`"
            .to_owned(),
        FirstOrder::Halves => "write `L` with the velocities of half of the coordinates: the time derivative of a function of the \
                               coordinates changes no motion, so that `x * dot(y)` may stand for `(x * dot(y) - y * dot(x)) / 2`"
            .to_owned(),
        FirstOrder::Singular => "each coordinate without a velocity has to be a factor of one, as `x` in `x * dot(y) - H`: `L` does not \
                                 determine the motion"
            .to_owned(),
        FirstOrder::Clause(clause) => format!(
            "remove it, and use `Gauss`: `L` is linear in the velocities, or `H` has no `L` in closed form, and {}",
            if *clause == "discretize" { "a rule would have parasitic steps" } else { "steps have no other time" }
        ),
        FirstOrder::Force(_) => "write it by the velocities in `L`, or by the coordinates".to_owned(),
    }
}

/// Help for a coordinate without kinetic energy.
fn kinetic_energy(why: &Singular) -> String {
    match why {
        Singular::Massless(name, Massless::Multiplier) => {
            format!("`{name}` multiplies a constraint: remove `{name}`, and {}", constraints::NAMED)
        }
        Singular::Massless(name, Massless::Absent) => format!(
            "`{name}` has no kinetic energy, and coordinates without mass are not supported: add a term with `dot({name})^2`, or make \
             `{name}` a `param`"
        ),
        Singular::Massless(name, Massless::Linear) => format!(
            "`dot({name})` appears in `L` only to the first power, which is not kinetic energy: add a term with `dot({name})^2`, or write \
             the kinetic energy of all others by momenta, as `p * dot(z) - p^2 / (2 * m)` with `coord z, p;`"
        ),
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
