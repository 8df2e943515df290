//! Words of other languages, each with what to write instead.

use super::arrays::INVERSE;
use super::constraints;

/// Words, separated by spaces, and the help for each of them.
type Table = [(&'static str, &'static str)];

/// Clauses.
pub(super) const CLAUSES: &Table = &[
    ("parameter parameters params", "write `param a = 1.0;`"),
    (
        "inputs control controls actuator actuators",
        "write `input u = 0.0;`, a parameter that a controller sets between steps",
    ),
    ("coordinate coordinates var dof", "write `coord x, y;`"),
    ("constant constants static", "write `const g = 9.81;`"),
    ("lagrangian Lagrangian Lagrange Lag", "write `L = …;`"),
    ("l", "write `L = …;` for the Lagrangian, `let l = …;` to name a part"),
    ("hamiltonian Hamiltonian momenta", "write `momentum p of q;` and `H = …;`, as in `H = p^2 / (2 * m) + V;`"),
    ("rayleigh Rayleigh damping friction", "write `dissipation = …;`, Rayleigh's function"),
    ("constraints constrain subject holonomic nonholonomic equation equations eq", constraints::NAMED),
    (
        "for while loop",
        "write `force q[i in 0..8] = …;` or `let e[i in 0..8] = …;` for each entry, and `sum(i in 0..8, …)`",
    ),
    ("if match", CONDITION),
    (
        "extern function func def use",
        "write `fn cl(a) = crate::aero::cl;` for a Rust function, `fn f(a) = …;` for an expression",
    ),
    ("interp spline lookup lut data", TABLE),
    ("order stages gauss method integrator rule scheme", GAUSS),
    ("h dt step steps until initial start init ic", RUN),
    (
        "cost costs objective final terminal minimize minimise maximize maximise bounds",
        "give costs and bounds to the optimisation: `vi.optimise(system, cost=\"u^2\", bounds={\"x\": (0.0, None)}, …)` in Python, \
         `Transcription::set_cost` in Rust",
    ),
];

/// Functions.
pub(super) const FUNCTIONS: &Table = &[
    (
        "diff der ddt d D derivative prime grad gradient partial pdiff Diff",
        "write `dot(a)` for a derivative with respect to time; the macro differentiates `L` with respect to coordinates, so that a potential \
         `V` enters `L` as `- V`",
    ),
    ("log", "write `ln(a)` for the natural logarithm, `ln(a) / ln(b)` for the one to the base b"),
    ("log10", "write `ln(a) / ln(10)`"),
    ("log2", "write `ln(a) / ln(2)`"),
    ("arcsin", "write `asin(a)`"),
    ("arccos", "write `acos(a)`"),
    ("arctan atg arctg", "write `atan(a)`"),
    ("arctan2", "write `atan2(y, x)`"),
    ("tg", "write `tan(a)`"),
    ("cot cotan ctg", "write `1 / tan(a)`"),
    ("sec", "write `1 / cos(a)`"),
    ("csc cosec", "write `1 / sin(a)`"),
    ("sech", "write `1 / cosh(a)`"),
    ("csch", "write `1 / sinh(a)`"),
    ("coth", "write `1 / tanh(a)`"),
    ("sinc", "write `sin(a) / a`, which has no value at a = 0"),
    (
        "floor ceil round mod fmod",
        "rounding and remainders are not supported; `sin` and `cos` are periodic without them",
    ),
    ("asinh arsinh arcsinh", "write `ln(a + sqrt(a^2 + 1))`"),
    ("cbrt", "write `a^(1/3)`"),
    ("square sqr sq", "write `a^2`"),
    ("powi powf power", "write `a^b`"),
    ("fabs", "write `abs(a)` for a number, `norm(v)` for the length of a vector"),
    ("inv inverse invert solve", INVERSE),
    (
        "det determinant",
        "write it out: `M[0][0] * M[1][1] - M[0][1] * M[1][0]`, `cross(M[0], M[1]) * M[2]` for three rows",
    ),
    ("trace tr", "write `sum(i in 0..3, M[i][i])`"),
    ("outer", "write `let M[i in 0..3][j in 0..3] = a[i] * b[j];`"),
    ("inner scalar_product dotp matmul mul", "write `a * b`, also for vectors and matrices"),
    ("normalize normalized unit versor", "write `v / norm(v)`"),
    ("eye identity zeros ones", "write the rows: `[[1, 0], [0, 1]]`"),
    ("diag", "write the rows: `[[a, 0], [0, b]]`"),
    ("vec vector Vector matrix Matrix array", "write `[a, b, c]`, and a matrix by its rows, `[[a, b], [c, d]]`"),
    (
        "length len",
        "write `norm(v)` for the length of a vector; its number of entries is the constant that declares it",
    ),
    (
        "pitch roll yaw heading euler euler_angles quaternion matrix_of axis_angle",
        "of a `rotation R`, `rate(R)` is the angular velocity, `turn(R, [1, 0, 0])` an axis of the body in space, and `R[0]` … `R[3]` the \
         quaternion; or declare angles, `angle ψ, θ, φ;`",
    ),
    ("sgn signum", "write `sign(a)`"),
    ("heaviside Heaviside step theta", "write `if a > 0 { 1 } else { 0 }`"),
    ("piecewise Piecewise where ifelse cond select switch", CONDITION),
    ("interp interp1 interp1d interpolate spline lookup lut CubicSpline", TABLE),
    ("sat saturate saturation clip", "write `clamp(x, a, b)`"),
    ("max maximum fmax", "write `max(a, b)`"),
    ("min minimum fmin", "write `min(a, b)`"),
    (
        "rand randn random noise normal uniform wiener",
        "random numbers are not supported: make the force an `input`, and set it between steps with `set_parameters`",
    ),
    ("integral integrate int quad", "integrals are not supported: write the value as a formula"),
    (
        "erf erfc gamma Gamma lgamma digamma beta zeta airy besselj bessely besseli besselk besselj0 besselj1 j0 j1 jn \
         ellipk ellipe ellipj legendre hypergeom lambertw factorial",
        "special functions are not supported: write an approximation that is accurate in the range of the motion, such as a polynomial",
    ),
    ("complex Complex re Re im Im real imag conj arg", COMPLEX),
    ("delay delayed lag history", "delays are not supported: an expression depends on the state at one time only"),
];

/// Names.
pub(super) const NAMES: &Table = &[
    ("π PI M_PI", "write `pi`"),
    ("e", "write `exp(x)` for e^x, `exp(1)` for the number"),
    ("time", "write `t`"),
    (
        "i j k",
        "an index needs a range, as in `sum(i in 0..3, q[i])`; otherwise declare it with `param`, `const` or `coord`; complex numbers are not \
         supported",
    ),
    ("im I", COMPLEX),
    ("deg degree degrees", DEGREES),
    (
        "p momentum",
        "declare it with `param`, `const` or `coord`; write a momentum in terms of the velocity, as `m * dot(x)`",
    ),
    ("dt ddt", "write `dot(x)` for the derivative of `x` with respect to time"),
    ("lambda λ multiplier", constraints::NAMED),
];

/// Rules.
pub(super) const RULES: &Table = &[
    ("Gauss gauss_legendre legendre collocation galerkin order stages", GAUSS),
    (
        "verlet Verlet leapfrog stoermer_verlet stormer_verlet velocity_verlet",
        "write `trapezoidal`, which is Störmer–Verlet when `L` is `v·Mv/2 - V(t, q)`",
    ),
];

/// Letters directly behind a number.
const SUFFIXES: &Table = &[("i j im", COMPLEX), ("deg degree degrees", DEGREES)];

/// Help for complex numbers.
const COMPLEX: &str = "complex numbers are not supported: write the real and the imaginary part as two coordinates, and `exp(i x)` with `cos(x)` and `sin(x)`";

/// Help for angles in degrees.
const DEGREES: &str = "angles are in radians: write `30 * pi / 180` for 30 degrees";

/// Help for a condition.
pub(super) const CONDITION: &str = "write `if a > b { x } else { y }`; write an `if` inside another for two conditions";

/// Help for a table.
const TABLE: &str =
    "write `table drag(v) = \"drag.csv\";` or `table drag(v) = [(0, 0.1), (1, 0.3)];`, and `drag(v)` in an expression";

/// Help on the order of the method.
pub(super) const GAUSS: &str = "Gauss methods need no clause: every system has their steps, of order 2 S with S stages";

/// Help on the step and the initial state.
pub(super) const RUN: &str = "set the step and the initial state of a run: `system.at(t, q, v).integrate(FixedStep, h)`; set those of checks in \
    `check { x = 1; h = 0.01; }`";

fn find(table: &Table, word: &str) -> Option<String> {
    table.iter().find(|(words, _)| words.split(' ').any(|one| one == word)).map(|(_, help)| (*help).to_owned())
}

/// Help for an unknown clause.
pub(super) fn clause(word: &str) -> Option<String> {
    find(CLAUSES, word)
}

/// Help for an unknown function.
pub(super) fn function(name: &str) -> Option<String> {
    find(FUNCTIONS, name)
}

/// Help for an unknown rule.
pub(super) fn rule(name: &str) -> Option<String> {
    find(RULES, name)
}

/// Help for letters behind a number.
pub(super) fn suffix(digits: &str, letters: &str) -> String {
    let product = || format!("write `{digits} * {letters}` for a product; units are not supported");
    find(SUFFIXES, letters).unwrap_or_else(product)
}

/// Help for an undeclared name.
pub(super) fn help_for_name(name: &str, near: Option<&String>) -> String {
    let declare = || "declare it with `param`, `const`, `coord`, or an earlier `let`".to_owned();
    // A lone letter is rarely a misspelt `pi`.
    let near = near.filter(|near| *near != "pi" || name.chars().count() > 1);
    did_you_mean(near, &find(NAMES, name).unwrap_or_else(declare))
}

/// Help for an unknown word: the declared one that is near, or else another hint.
pub(super) fn did_you_mean(near: Option<&String>, otherwise: &str) -> String {
    near.map_or_else(|| otherwise.to_owned(), |name| format!("did you mean `{name}`?"))
}

/// Whether other languages declare a constraint by a clause of this name.
pub(crate) fn is_constraint(word: &str) -> bool {
    clause(word).is_some_and(|help| help == constraints::NAMED)
}

/// Whether other languages write a condition by a function of this name.
pub(crate) fn is_condition(name: &str) -> bool {
    function(name).is_some_and(|help| help == CONDITION)
}

/// Help for a mathematical sign.
pub(crate) fn sign(letter: char) -> Option<&'static str> {
    let help = match letter {
        '°' => DEGREES,
        '²' => "write `^2`",
        '³' => "write `^3`",
        '⁰'..='⁹' | '¹' => "write a power with `^`, as in `x^4`",
        '₀'..='₉' => "write an index in its name, `x_1`, or of an array, `q[1]`",
        '½' => "write `1/2`",
        '¼' => "write `1/4`",
        '√' => "write `sqrt(x)`",
        '×' => "write `*`, or `cross(a, b)` of two vectors",
        '∙' | '⋅' | '•' => "write `*`",
        '‖' => "write `norm(v)`",
        '÷' => "write `/`",
        '\u{2212}' | '–' | '—' => "write the hyphen `-`",
        '∂' => "write `dot(x)` for a derivative with respect to time; the macro differentiates `L`",
        '∑' => "write `sum(i in 0..8, …)`",
        '\\' => "write names without a backslash: `theta`, or `θ`",
        '“' | '”' | '’' | '‘' => "remove the quotation marks",
        '\u{a0}' => "write a plain space",
        _ => return None,
    };
    Some(help)
}

/// Greek letters and their names.
const GREEK: &str = "alpha α beta β gamma γ delta δ epsilon ε zeta ζ eta η theta θ iota ι kappa κ lambda λ mu μ nu ν xi ξ \
    omicron ο rho ρ sigma σ tau τ upsilon υ phi φ chi χ psi ψ omega ω varphi ϕ";

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
    let words: Vec<&str> = GREEK.split(' ').collect();
    let pairs = words.chunks_exact(2).flat_map(|pair| [(pair[0], pair[1]), (pair[1], pair[0])]);
    pairs.into_iter().find_map(|(one, other)| name.strip_prefix(one).map(|rest| format!("{other}{rest}")))
}
