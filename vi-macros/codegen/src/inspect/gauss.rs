//! The equations of a Gauss step of a system: tableau, stages, update, energy, slots.
//!
//! In: a derived system, the number of stages S, and the collocation coefficients at the S Gauss points. Out: sections
//! of an explanation. A stage is written once, with its index i: `x_i` and `x_dot_i` are coordinate and velocity there.
//! Coefficients are exact up to three stages and decimal beyond.

use super::explanation::{Line, Section};
use super::{latex, name};
use crate::Derived;
use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Pool, Rational};

/// Tableau, stages, update and slots of a step with `stages` stages.
pub(super) fn sections(derived: &mut Derived, stages: usize) -> Vec<Section> {
    let tableau = tableau(&mut derived.pool, stages);
    let [places, equations] = equations(derived, stages);
    let update = update(derived, stages);
    let title = "Equations of the stages for positions and velocities: both expressions of the momentum agree";
    let mut sections = vec![
        Section { title: "Gauss points c, weights b, coefficients a", lines: tableau },
        Section { title: "Stage i: time, position, momentum p and force F = L_q + f", lines: places },
        Section { title, lines: equations },
        Section { title: "Update of position and momentum", lines: update },
        Section {
            title: "Discrete Lagrangian, its slot derivatives, forces, powers and energies",
            lines: slots(derived),
        },
    ];
    sections.extend(length(stages));
    sections
}

/// Tableau and equations of a step of a large system, whose L_v and F no expression contains.
pub(super) fn of_loops(pool: &mut Pool<Symbol>, forced: bool, stages: usize) -> Vec<Section> {
    let separator = if stages > 9 { "," } else { "" };
    let force = if forced { "L_q(t_i, q_i, v_i) + f(t_i, q_i, v_i)" } else { "L_q(t_i, q_i, v_i)" };
    let (a, stage) = (format!("a_i{separator}"), "\\sum_{j} a_{ij}");
    let places = vec![
        equation("t_i", "t0 + c_i*h", "t_{i}", "t_{0} + c_{i} h"),
        equation(
            "q_i",
            &format!("q0 + h*({})", sum(stages, &a, "v")),
            "q_{i}",
            &format!("q_{{0}} + h {stage} v_{{j}}"),
        ),
        equation("F_i", force, "F_{i}", force),
    ];
    let equations = vec![equation(
        "L_v(t_i, q_i, v_i)",
        &format!("p0 + h*({})", sum(stages, &a, "F")),
        "L_v(t_i, q_i, v_i)",
        &format!("p_{{0}} + h {stage} F_{{j}}"),
    )];
    let update = vec![
        equation("q1", &format!("q0 + h*({})", sum(stages, "b_", "v")), "q_{1}", "q_{0} + h \\sum_{j} b_{j} v_{j}"),
        equation("p1", &format!("p0 + h*({})", sum(stages, "b_", "F")), "p_{1}", "p_{0} + h \\sum_{j} b_{j} F_{j}"),
    ];
    let mut sections = vec![
        Section { title: "Gauss points c, weights b, coefficients a", lines: tableau(pool, stages) },
        Section { title: "Stage i: time, position and force F, computed in loops", lines: places },
        Section { title: "Equations of the stages for the velocities v_i", lines: equations },
        Section { title: "Update of position and momentum", lines: update },
    ];
    sections.extend(length(stages));
    sections
}

/// The equations of a step with constraints (`docs/mathematics.md`).
pub(super) fn constrained() -> Section {
    let momentum = equation(
        "L_v(t_i, q_i, v_i)",
        "p0 + h*sum_j a_ij*F_j + h*sum_j b_ij*A_j^T*λ_j",
        "L_v(t_i, q_i, v_i)",
        "p_0 + h \\sum_{j} a_{ij} F_{j} + h \\sum_{j} \\hat{a}_{ij} A_{j}^T \\lambda_{j}",
    );
    let projected = equation("p1", "p_minus + A_1^T*μ", "p_1", "p^- + A_1^T \\mu");
    let lines = vec![
        Line::words("At each Gauss point i, with the multipliers λ_j at the Lobatto nodes:"),
        momentum,
        Line::words("g = 0 at each Lobatto node, and A v + a = 0 at each Gauss point of a constraint on velocities."),
        Line::words("At the end of the step, μ follows from A v + a = 0:"),
        projected,
    ];
    Section { title: "Equations of a Gauss step", lines }
}

/// The equation for the length of an energy-preserving step (`docs/theory.md`); `None` beyond three stages, where
/// rounding hides it.
fn length(stages: usize) -> Option<Section> {
    let share = ["1/8", "1/864", "1/288000"].get(stages.checked_sub(1)?)?;
    let order = 2 * stages;
    let excess = equation(
        "H(t0, q0, p0) - E0",
        &format!("h^{order}*D_{stages}*{share} + O(h^{})", order + 1),
        "H(t_0, q_0, p_0) - E_0",
        &format!(
            "C_{{{stages}}} h^{{{order}}} D_{{{stages}}} + O(h^{{{}}}), \\quad C_{{{stages}}} = {share}",
            order + 1
        ),
    );
    let density = equation(
        &format!("D_{stages}"),
        &format!(
            "(d/dtau)^{order} H(t0 + tau, q(tau), p(tau)), tau = 0, with Taylor's polynomials of degree {stages} of the motion"
        ),
        &format!("D_{{{stages}}}"),
        &format!(
            "\\left. \\frac{{d^{{{order}}}}}{{d\\tau^{{{order}}}}} H(t_0 + \\tau, \\pi_q(\\tau), \\pi_p(\\tau)) \\right|_{{\\tau = 0}}, \\quad \\pi \\text{{ of degree }} {stages}"
        ),
    );
    let title = "Length of an energy-preserving step: a root exists if the step density D keeps its sign";
    Some(Section { title, lines: vec![excess, density] })
}

/// The equation `left = right`, in both notations.
fn equation(left: &str, right: &str, left_latex: &str, right_latex: &str) -> Line {
    let [left, right, left_latex, right_latex] = [left, right, left_latex, right_latex].map(str::to_owned);
    Line::Equation { left, right, left_latex, right_latex }
}

/// A number of a tableau.
#[derive(Clone, Copy)]
enum Coefficient {
    /// `whole + part √of`, each a fraction.
    Exact { whole: [i64; 2], part: [i64; 2], of: i64 },
    /// A decimal.
    Decimal(f64),
}

const fn exact(whole: [i64; 2], part: [i64; 2], of: i64) -> Coefficient {
    Coefficient::Exact { whole, part, of }
}

const fn rational(above: i64, below: i64) -> Coefficient {
    exact([above, below], [0, 1], 1)
}

impl Coefficient {
    /// The number in both notations.
    fn text(self, pool: &mut Pool<Symbol>) -> [String; 2] {
        let (whole, part, of) = match self {
            Self::Exact { whole, part, of } => (whole, part, of),
            // Rounding affects the last digits of sums.
            Self::Decimal(value) => return [format!("{value:.14}"), format!("{value:.14}")],
        };
        let root = root(pool, of);
        let irrational = pool.scale(root, &fraction(part));
        let rational = pool.number(fraction(whole));
        let sum = pool.sum(&[rational, irrational]);
        [pool.render(sum, &|_| String::new()), latex::expression(pool, sum, &|_| String::new())]
    }
}

fn fraction([above, below]: [i64; 2]) -> Rational {
    Rational::new(above.into(), below.into())
}

fn root(pool: &mut Pool<Symbol>, of: i64) -> Expr {
    let of = pool.integer(of);
    pool.power(of, &fraction([1, 2]))
}

/// The coefficients, each named.
fn tableau(pool: &mut Pool<Symbol>, stages: usize) -> Vec<Line> {
    let Tableau { c, b, a } = Tableau::of(stages);
    let mut lines = Vec::new();
    let mut add = |name: &str, indices: &[usize], of: Coefficient| {
        let separator = if stages > 9 { "," } else { "" };
        let indices: Vec<String> = indices.iter().map(|index| (index + 1).to_string()).collect();
        let [text, in_latex] = of.text(pool);
        let index = indices.join(separator);
        lines.push(equation(&format!("{name}_{index}"), &text, &format!("{name}_{{{index}}}"), &in_latex));
    };
    for (name, values) in [("c", c), ("b", b)] {
        for (i, value) in values.into_iter().enumerate() {
            add(name, &[i], value);
        }
    }
    for (i, row) in a.into_iter().enumerate() {
        for (j, value) in row.into_iter().enumerate() {
            add("a", &[i, j], value);
        }
    }
    lines
}

/// The coefficients of collocation at the Gauss points on [0, 1].
struct Tableau {
    c: Vec<Coefficient>,
    b: Vec<Coefficient>,
    a: Vec<Vec<Coefficient>>,
}

impl Tableau {
    /// Exact up to three stages (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, II.1.3), decimals beyond.
    fn of(stages: usize) -> Self {
        match stages {
            1 => Self { c: vec![rational(1, 2)], b: vec![rational(1, 1)], a: vec![vec![rational(1, 2)]] },
            2 => Self {
                c: vec![exact([1, 2], [-1, 6], 3), exact([1, 2], [1, 6], 3)],
                b: vec![rational(1, 2); 2],
                a: vec![
                    vec![rational(1, 4), exact([1, 4], [-1, 6], 3)],
                    vec![exact([1, 4], [1, 6], 3), rational(1, 4)],
                ],
            },
            3 => Self {
                c: vec![exact([1, 2], [-1, 10], 15), rational(1, 2), exact([1, 2], [1, 10], 15)],
                b: vec![rational(5, 18), rational(4, 9), rational(5, 18)],
                a: vec![
                    vec![rational(5, 36), exact([2, 9], [-1, 15], 15), exact([5, 36], [-1, 30], 15)],
                    vec![exact([5, 36], [1, 24], 15), rational(2, 9), exact([5, 36], [-1, 24], 15)],
                    vec![exact([5, 36], [1, 30], 15), exact([2, 9], [1, 15], 15), rational(5, 36)],
                ],
            },
            _ => Self::computed(stages),
        }
    }

    /// From Legendre polynomials: `a_ij = b_j (c_i + Σ_k P_k(y_j) (P_{k+1}(x_i) − P_{k−1}(x_i)) / 2)`, k = 1 … S − 1.
    fn computed(stages: usize) -> Self {
        let x: Vec<f64> = (0..stages).map(|i| node(stages, i)).collect();
        let weight = |x: f64| 1.0 / ((1.0 - x * x) * slope(stages, x).powi(2));
        let at: Vec<Vec<f64>> = x.iter().map(|x| polynomials(stages, *x)).collect();
        let integral = |i: usize, j: usize| {
            let sum: f64 = (1..stages).map(|k| at[j][k] * (at[i][k + 1] - at[i][k - 1])).sum();
            weight(x[j]) * ((1.0 + x[i]) + sum) / 2.0
        };
        let row = |i: usize| (0..stages).map(|j| Coefficient::Decimal(integral(i, j))).collect();
        Self {
            c: x.iter().map(|x| Coefficient::Decimal((1.0 + x) / 2.0)).collect(),
            b: x.iter().map(|x| Coefficient::Decimal(weight(*x))).collect(),
            a: (0..stages).map(row).collect(),
        }
    }
}

/// P_0 … P_n at x.
fn polynomials(n: usize, x: f64) -> Vec<f64> {
    let mut values = vec![1.0, x];
    let mut k = 1.0;
    while values.len() <= n {
        let next = ((2.0 * k + 1.0) * x * values[values.len() - 1] - k * values[values.len() - 2]) / (k + 1.0);
        values.push(next);
        k += 1.0;
    }
    values
}

/// P_n'(x), from `(1 − x²) P_n' = n (P_{n−1} − x P_n)`.
#[allow(clippy::cast_precision_loss)]
fn slope(n: usize, x: f64) -> f64 {
    let values = polynomials(n, x);
    n as f64 * (values[n - 1] - x * values[n]) / (1.0 - x * x)
}

/// Root i of P_n, ascending, by Newton iteration from Tricomi's estimate.
#[allow(clippy::cast_precision_loss)]
fn node(n: usize, i: usize) -> f64 {
    let mut x = -(core::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
    for _ in 0..8 {
        x -= polynomials(n, x)[n] / slope(n, x);
    }
    x
}

/// A symbol of L and f at stage i.
fn at_stage(derived: &Derived, symbol: &Symbol) -> String {
    match symbol {
        Symbol::Continuous(Variable::Time) => "t_i".to_owned(),
        Symbol::Continuous(Variable::Coordinate(index)) => format!("{}_i", derived.model.coordinates[*index].text()),
        Symbol::Continuous(Variable::Velocity(index)) => format!("{}_dot_i", derived.model.coordinates[*index].text()),
        _ => derived.system.spell(&derived.model, symbol),
    }
}

/// The equation `left = right` at stage i.
fn at(derived: &Derived, left: &str, left_latex: &str, right: Expr) -> Line {
    let right_text = derived.pool.render(right, &|symbol| at_stage(derived, symbol));
    let right_latex = latex::expression(&derived.pool, right, &|symbol| name::at_stage(derived, symbol, "i"));
    equation(left, &right_text, left_latex, &right_latex)
}

/// The sum over the stages of coefficients times a number: `a_i1*x_dot_1 + a_i2*x_dot_2`.
fn sum(stages: usize, coefficient: &str, of: &str) -> String {
    let terms: Vec<String> = (1..=stages).map(|j| format!("{coefficient}{j}*{of}_{j}")).collect();
    terms.join(" + ")
}

/// A coordinate with its names in plain text and in LaTeX.
struct Named {
    text: String,
    latex: String,
    velocity: String,
    start: [String; 2],
    end: [String; 2],
    momentum: [String; 2],
}

/// The coordinates in order.
fn named(derived: &Derived) -> Vec<Named> {
    let both = |symbol: &Symbol| [derived.system.spell(&derived.model, symbol), name::latex(derived, symbol)];
    let coordinates = derived.model.coordinates.iter().enumerate();
    let each = coordinates.map(|(index, coordinate)| Named {
        text: coordinate.text(),
        latex: name::coordinate(coordinate).text(),
        velocity: name::at_stage(derived, &Symbol::Continuous(Variable::Velocity(index)), "j"),
        start: both(&Symbol::Q0(index)),
        end: both(&Symbol::Q1(index)),
        momentum: both(&Symbol::P0(index)),
    });
    each.collect()
}

/// The stages with L_v and L_q + f there, and the equations that make the momenta agree.
fn equations(derived: &Derived, stages: usize) -> [Vec<Line>; 2] {
    let of = &derived.system.continuous;
    let separator = if stages > 9 { "," } else { "" };
    let a = format!("a_i{separator}");
    let mut places = vec![equation("t_i", "t0 + c_i*h", "t_{i}", "t_{0} + c_{i} h")];
    let mut rates = Vec::new();
    let mut equations = Vec::new();
    for (index, Named { text, latex, velocity, start, momentum, .. }) in named(derived).iter().enumerate() {
        let right = format!("{} + h*({})", start[0], sum(stages, &a, &format!("{text}_dot")));
        let right_latex = format!("{} + h \\sum_{{j}} a_{{ij}} {velocity}", start[1]);
        let place = name::at_stage(derived, &Symbol::Continuous(Variable::Coordinate(index)), "i");
        places.push(equation(&format!("{text}_i"), &right, &place, &right_latex));
        rates.push(at(derived, &format!("p_{text}_i"), &format!("p_{{{latex},i}}"), of.momentum[index]));
        rates.push(at(derived, &format!("F_{text}_i"), &format!("F_{{{latex},i}}"), of.applied_force[index]));
        let right = format!("{} + h*({})", momentum[0], sum(stages, &a, &format!("F_{text}")));
        let right_latex = format!("{} + h \\sum_{{j}} a_{{ij}} F_{{{latex},j}}", momentum[1]);
        equations.push(equation(&format!("p_{text}_i"), &right, &format!("p_{{{latex},i}}"), &right_latex));
    }
    places.extend(rates);
    [places, equations]
}

/// Update of position and momentum after a converged step.
fn update(derived: &Derived, stages: usize) -> Vec<Line> {
    let mut lines = Vec::new();
    for Named { text, latex, velocity, start, end, momentum } in named(derived) {
        let right = format!("{} + h*({})", start[0], sum(stages, "b_", &format!("{text}_dot")));
        lines.push(equation(&end[0], &right, &end[1], &format!("{} + h \\sum_{{j}} b_{{j}} {velocity}", start[1])));
        let right = format!("{} + h*({})", momentum[0], sum(stages, "b_", &format!("F_{text}")));
        let right_latex = format!("{} + h \\sum_{{j}} b_{{j}} F_{{{latex},j}}", momentum[1]);
        lines.push(equation(&format!("p1_{text}"), &right, &format!("p_{{1,{latex}}}"), &right_latex));
    }
    lines
}

/// L, E, L_t and the force at stage i, then L_d and its slots as sums over the stages.
fn slots(derived: &mut Derived) -> Vec<Line> {
    let lagrangian = derived.model.lagrangian;
    let lt = derived.pool.partial_derivative(lagrangian, &Symbol::Continuous(Variable::Time));
    let forces = derived.model.forces.clone();
    let applied = derived.system.continuous.applied_force.clone();
    let lq: Vec<Expr> =
        applied.iter().zip(&forces).map(|(applied, force)| derived.pool.sub(*applied, *force)).collect();
    let derived: &Derived = derived;
    let energy = derived.system.continuous.energy;
    let mut lines = vec![
        at(derived, "L_i", "L_{i}", lagrangian),
        at(derived, "E_i", "E_{i}", energy),
        at(derived, "L_t_i", "L_{t,i}", lt),
    ];
    let coordinates = named(derived);
    for (Named { text, latex, .. }, (lq, force)) in coordinates.iter().zip(lq.iter().zip(&forces)) {
        lines.push(at(derived, &format!("L_{text}_i"), &format!("L_{{{latex},i}}"), *lq));
        if derived.model.forced {
            lines.push(at(derived, &format!("f_{text}_i"), &format!("f_{{{latex},i}}"), *force));
        }
    }
    let mut add = |left: &str, right: &str, left_latex: &str, right_latex: &str| {
        let [right, right_latex] = [format!("sum_i b_i*{right}"), format!("\\sum_{{i}} b_{{i}} {right_latex}")];
        lines.push(equation(left, &right, left_latex, &right_latex));
    };
    add("L_d", "h*L_i", "L_d", "h L_{i}");
    add("D1 L_d", "(E_i + (1 - c_i)*h*L_t_i)", "D_1 L_d", "\\left(E_{i} + (1 - c_{i}) h L_{t,i}\\right)");
    add("D3 L_d", "(c_i*h*L_t_i - E_i)", "D_3 L_d", "\\left(c_{i} h L_{t,i} - E_{i}\\right)");
    let mut work = Vec::new();
    let mut work_latex = Vec::new();
    for (index, Named { text, latex, .. }) in coordinates.iter().enumerate() {
        let velocity = name::at_stage(derived, &Symbol::Continuous(Variable::Velocity(index)), "i");
        work.push(format!("f_{text}_i*{text}_dot_i"));
        work_latex.push(format!("f_{{{latex},i}} {velocity}"));
        add(
            &format!("(D2 L_d)_{text}"),
            &format!("((1 - c_i)*h*L_{text}_i - p_{text}_i)"),
            &format!("(D_2 L_d)_{{{latex}}}"),
            &format!("\\left((1 - c_{{i}}) h L_{{{latex},i}} - p_{{{latex},i}}\\right)"),
        );
        add(
            &format!("(D4 L_d)_{text}"),
            &format!("(c_i*h*L_{text}_i + p_{text}_i)"),
            &format!("(D_4 L_d)_{{{latex}}}"),
            &format!("\\left(c_{{i}} h L_{{{latex},i}} + p_{{{latex},i}}\\right)"),
        );
        if !derived.model.forced {
            continue;
        }
        let force = format!("h*f_{text}_i");
        let force_latex = format!("h f_{{{latex},i}}");
        let left = [format!("(f_d⁻)_{text}"), format!("(f_d^-)_{{{latex}}}")];
        add(&left[0], &format!("(1 - c_i)*{force}"), &left[1], &format!("(1 - c_{{i}}) {force_latex}"));
        let left = [format!("(f_d⁺)_{text}"), format!("(f_d^+)_{{{latex}}}")];
        add(&left[0], &format!("c_i*{force}"), &left[1], &format!("c_{{i}} {force_latex}"));
    }
    if !derived.model.forced {
        lines.push(equation("E0", "D1 L_d", "E_0", "D_1 L_d"));
        lines.push(equation("E1", "-D3 L_d", "E_1", "-D_3 L_d"));
        return lines;
    }
    let [work, work_latex] = [work.join(" + "), work_latex.join(" + ")];
    for (name, name_latex, part) in
        [("g_d⁻", "g_d^-", ["(1 - c_i)", "(1 - c_{i})"]), ("g_d⁺", "g_d^+", ["c_i", "c_{i}"])]
    {
        let right = format!("-sum_i b_i*{}*h*({work})", part[0]);
        let right_latex = format!("-\\sum_{{i}} b_{{i}} {} h \\left({work_latex}\\right)", part[1]);
        lines.push(equation(name, &right, name_latex, &right_latex));
    }
    lines.push(equation("E0", "D1 L_d + g_d⁻", "E_0", "D_1 L_d + g_d^-"));
    lines.push(equation("E1", "-D3 L_d - g_d⁺", "E_1", "-D_3 L_d - g_d^+"));
    lines
}
