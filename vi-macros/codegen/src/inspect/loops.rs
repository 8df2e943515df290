//! A large system: its declarations, its recursions and sums in loops, and what follows from their derivatives.
//!
//! In: a system in loops. Out: sections of an explanation, and its functions operation by operation.

use super::explanation::{Line, Section};
use super::index::{self, Both, COUNTERS, affine};
use super::{discrete, functions, gauss, latex, model, name, program, syntax};
use crate::Loops;
use crate::indexed::{self, NamedBody, Quantity};
use crate::indexed::{Affine, Nest, Value};
use crate::model::Model;
use crate::program::Function;
use crate::rules::NamedRule;
use crate::symbol::Symbol;
use crate::syntax::System;
use std::fmt::Write as _;
use vi_expr::Node;

/// Declarations, and L and f as written.
pub(super) fn model(system: &System, of: &Loops) -> Vec<Section> {
    let model = &of.indexed.model;
    let written = syntax::equations(system).into_iter().map(Line::words).collect();
    let title = if model.constraints.is_empty() {
        "Named parts, Lagrangian L and force f, as written"
    } else {
        "Named parts, Lagrangian L, force f and constraints, as written"
    };
    let mut sections = vec![model::declarations(model), Section { title, lines: written }];
    sections.extend(functions::sections(model));
    sections
}

/// Recursions, then L and f as sums.
pub(super) fn sums(of: &Loops) -> Vec<Section> {
    let (mut recursions, mut terms, mut forces, mut constraints) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut losses, mut scale) = (Vec::new(), Vec::new());
    for named in &indexed::named(&of.indexed) {
        match named.quantity {
            Quantity::Entries(_) => recursions.extend(named.nests.iter().flat_map(|nest| entries(of, named, nest))),
            Quantity::Lagrangian => terms.push(term(of, named, "L", terms.len() + 1)),
            Quantity::Dissipation => losses.push(term(of, named, "R", losses.len() + 1)),
            Quantity::Force => forces.extend(named.nests.iter().flat_map(|nest| part(of, named, nest, "f_"))),
            Quantity::Constraint => constraints.extend(named.nests.iter().flat_map(|nest| part(of, named, nest, ""))),
            Quantity::Part => scale.extend(named.nests.iter().flat_map(|nest| part(of, named, nest, ""))),
            Quantity::Scale => scale.extend(whole(of, named)),
        }
    }
    terms.insert(0, numbered("L", terms.len()));
    if !losses.is_empty() {
        losses.insert(0, numbered("R", losses.len()));
        forces.push(line(["f", "-R_v"], ["f", "-R_v"]));
        forces.extend(losses);
    }
    if !has_names(of) {
        terms.push(Line::Words {
            text: "q_k is coordinate k in the order of declaration, from 0; x_k of an array x its number k".to_owned(),
            latex:
                "`q_{k}` is coordinate `k` in the order of declaration, from 0; `x_{k}` of an array `x` its number `k`"
                    .to_owned(),
        });
    }
    let mut sections = Vec::new();
    if !recursions.is_empty() {
        sections.push(Section { title: "Recursions, in the order of evaluation", lines: recursions });
    }
    sections.push(Section { title: "Lagrangian L as sums", lines: terms });
    if !forces.is_empty() {
        sections.push(Section { title: "Force f, the sum of these terms", lines: forces });
    }
    if !constraints.is_empty() {
        sections.push(Section { title: "Constraints, each the sum of these terms, which is 0", lines: constraints });
    }
    if !scale.is_empty() {
        sections.push(Section { title: "Time scale g, with its parts as the sums of these terms", lines: scale });
    }
    sections
}

/// The time scale by its parts.
fn whole(of: &Loops, named: &NamedBody) -> Vec<Line> {
    let letter = || Both { text: "g".to_owned(), latex: "g".to_owned() };
    let rows = named.nests.iter().map(|nest| Row::new(of, named, nest));
    rows.flat_map(|row| named.body.values.iter().map(move |value| equation(letter(), row.value(of, value)))).collect()
}

/// `L = L_1 + … + L_n` with n = `count`, for the letter L.
fn numbered(letter: &str, count: usize) -> Line {
    let sum = |place: &dyn Fn(usize) -> String| {
        (1..=count).map(|index| format!("{letter}_{}", place(index))).collect::<Vec<_>>().join(" + ")
    };
    let (text, latex) = (sum(&|index| index.to_string()), sum(&|index| format!("{{{index}}}")));
    line([letter, &text], [letter, &latex])
}

/// Whether all numbers that loops read have names of the user.
fn has_names(of: &Loops) -> bool {
    indexed::named(&of.indexed).iter().all(|named| {
        named.nests.iter().all(|nest| {
            let Nest::Loops { outer, inner, columns } = nest else { return true };
            let (counters, model) = (index::counters(*outer, *inner), &of.indexed.model);
            named.columns().all(|(column, read)| index::has_name(model, read, columns[column], &counters))
        })
    })
}

fn equation(left: Both, right: Both) -> Line {
    Line::Equation { left: left.text, right: right.text, left_latex: left.latex, right_latex: right.latex }
}

/// The numbers of a row by the counters of its loop.
struct Row {
    /// The numbers that it computes.
    computed: Vec<Both>,
    /// The numbers that it reads.
    reads: Vec<Both>,
}

impl Row {
    /// A table shows its first row.
    fn new(of: &Loops, named: &NamedBody, nest: &Nest) -> Self {
        let (columns, counters) = match nest {
            Nest::Loops { outer, inner, columns } => (columns.clone(), index::counters(*outer, *inner)),
            Nest::Table(rows) => {
                let number = |column: &usize| i64::try_from(*column).unwrap_or(i64::MAX);
                let constant = |column| Affine { constant: number(column), by: [0, 0] };
                (rows.first().into_iter().flatten().map(constant).collect(), vec![[0, 0]])
            }
        };
        let number = |(column, read)| index::read(&of.indexed.model, read, columns[column], &counters);
        let mut computed: Vec<Both> = named.columns().map(number).collect();
        let reads = computed.split_off(named.computed().len());
        Self { computed, reads }
    }

    /// A value of the body.
    fn value(&self, of: &Loops, value: &Value) -> Both {
        let (pool, model) = (&of.pool, &of.indexed.model);
        let text = pool.render(value.expr, &|symbol| match symbol {
            Symbol::Access(place) => self.reads[*place].text.clone(),
            _ => model.spell(symbol),
        });
        let latex = latex::expression(pool, value.expr, &|symbol| match symbol {
            Symbol::Access(place) => self.reads[*place].latex.clone(),
            _ => name::of_model(model, symbol).map_or_else(|| model.spell(symbol), |name| name.text()),
        });
        Both { text, latex }
    }
}

/// The loops of a nest: `i in 0..39, j in 0..i + 1`; none for one row and for a table.
fn ranges(nest: &Nest) -> Vec<(&'static str, Affine)> {
    let Nest::Loops { outer, inner, .. } = nest else { return Vec::new() };
    let constant = |constant: i64| Affine { constant, by: [0, 0] };
    let all = [(COUNTERS[0], constant(*outer)), (COUNTERS[1], *inner)];
    all.into_iter().filter(|(_, end)| *end != constant(1)).collect()
}

/// The loops in the notation of the language.
fn ranges_text(nest: &Nest) -> String {
    let ranges = ranges(nest);
    ranges.iter().map(|(counter, end)| format!("{counter} in 0..{}", affine(*end, "*"))).collect::<Vec<_>>().join(", ")
}

/// The last value of a counter in LaTeX.
fn last(end: Affine) -> String {
    affine(Affine { constant: end.constant - 1, ..end }, " ")
}

/// The range of rows in which an expression holds, written after it: `for i in 0..39`.
fn in_each_row(nest: &Nest) -> Both {
    if let Nest::Table(rows) = nest {
        let (text, count) = ("and more rows of a table, in total", rows.len());
        return Both { text: format!(", {text} {count}"), latex: format!(", \\quad \\text{{{text} {count}}}") };
    }
    let (text, mut latex) = (ranges_text(nest), String::new());
    for (counter, end) in ranges(nest) {
        // Writing to a string cannot fail.
        let _ = write!(latex, ", \\quad {counter} = 0, \\ldots, {}", last(end));
    }
    Both { text: if text.is_empty() { text } else { format!(" for {text}") }, latex }
}

/// Entries of arrays of `let`s, or their rates.
fn entries(of: &Loops, named: &NamedBody, nest: &Nest) -> Vec<Line> {
    let (row, rows) = (Row::new(of, named, nest), in_each_row(nest));
    let values = named.body.values.iter().map(|value| row.value(of, value));
    let entry = |(left, value): (&Both, Both)| {
        equation(left.clone(), Both { text: value.text + &rows.text, latex: value.latex + &rows.latex })
    };
    row.computed.iter().zip(values).map(entry).collect()
}

/// The terms of L with one body.
fn term(of: &Loops, named: &NamedBody, letter: &str, place: usize) -> Line {
    let (mut text, mut latex) = (Vec::new(), Vec::new());
    for nest in named.nests {
        let row = Row::new(of, named, nest);
        for value in &named.body.values {
            let is_sum = matches!(of.pool.node(value.expr), Node::Sum(sum) if sum.as_multiple().is_none());
            let Both { text: in_text, latex: in_latex } = summed(nest, row.value(of, value), is_sum);
            text.push(in_text);
            latex.push(in_latex);
        }
    }
    equation(
        Both { text: format!("{letter}_{place}"), latex: format!("{letter}_{{{place}}}") },
        Both { text: text.join(" + "), latex: latex.join(" + ") },
    )
}

/// The sum of a value over all rows.
fn summed(nest: &Nest, value: Both, is_sum: bool) -> Both {
    if let Nest::Table(_) = nest {
        let rows = in_each_row(nest);
        return Both { text: value.text + &rows.text, latex: value.latex + &rows.latex };
    }
    let ranges = ranges(nest);
    if ranges.is_empty() {
        return value;
    }
    let signs = ranges.iter().map(|(counter, end)| format!("\\sum_{{{counter}=0}}^{{{}}} ", last(*end)));
    let latex = if is_sum { format!("\\left({}\\right)", value.latex) } else { value.latex };
    Both { text: format!("sum({}, {})", ranges_text(nest), value.text), latex: signs.collect::<String>() + &latex }
}

/// Terms of components of f, or of constraints.
fn part(of: &Loops, named: &NamedBody, nest: &Nest, prefix: &str) -> Vec<Line> {
    let (row, rows) = (Row::new(of, named, nest), in_each_row(nest));
    let line = |(on, value): (&Both, &Value)| {
        let value = row.value(of, value);
        Line::Words {
            text: format!("{prefix}{} += {}{}", on.text, value.text, rows.text),
            latex: format!("`{prefix}{{{}}} \\mathrel{{+}}= {}{}`", on.latex, value.latex, rows.latex),
        }
    };
    row.computed.iter().zip(&named.body.values).map(line).collect()
}

/// An equation of text, and of LaTeX.
fn line([text, text_right]: [&str; 2], [latex, latex_right]: [&str; 2]) -> Line {
    let both = |text: &str, latex: &str| Both { text: text.to_owned(), latex: latex.to_owned() };
    equation(both(text, latex), both(text_right, latex_right))
}

/// The functions that `vi_core::indexed` computes from the derivatives of L and f.
pub(super) fn discrete(of: &Loops) -> Vec<Section> {
    let model = &of.indexed.model;
    let sum = if model.forced { "L_q + f" } else { "L_q" };
    let [of_time, of_time_latex] = if of.indexed.autonomous { ["", ""] } else { [" - L_vt", " - L_{vt}"] };
    let motion = vec![
        line(["p", "L_v"], ["p", "L_v"]),
        line(["E", "v·L_v - L"], ["E", "v \\cdot L_v - L"]),
        if model.constraints.is_empty() {
            line(
                ["a", &format!("L_vv^-1*({sum}{of_time} - L_vq*v)")],
                ["a", &format!("L_{{vv}}^{{-1}} ({sum}{of_time_latex} - L_{{vq}} v)")],
            )
        } else {
            line(
                ["L_vv*dv/dt", &format!("{sum}{of_time} - L_vq*v + A^T*Λ, with d/dt(A*v + a) = 0")],
                [
                    "L_{vv} \\, \\dot{v}",
                    &format!(
                        "{sum}{of_time_latex} - L_{{vq}} v + A^T \\Lambda, \\quad \\frac{{d}}{{dt}} (A v + a) = 0"
                    ),
                ],
            )
        },
    ];
    let motion = Section { title: "Motion, from first and second derivatives of L and f", lines: motion };
    if !model.constraints.is_empty() {
        return vec![motion, gauss::constrained()];
    }
    let Some((own, further)) = of.indexed.rules.split_first() else {
        return vec![motion, discrete::without_rule()];
    };
    let mut sections = vec![motion, step(of, own)];
    for rule in further {
        sections.extend([model::further_rule(rule.name), step(of, rule)]);
    }
    sections
}

/// The equations of a step by a rule.
fn step(of: &Loops, rule: &NamedRule) -> Section {
    let mut lines = if rule.at_ends { step_by_ends(of) } else { step_by_midpoint(of) };
    lines.push(Line::words(
        "vi_core::indexed evaluates these equations and their derivatives; they are not written out",
    ));
    let title = if rule.step_density {
        "Step: residual r of the momentum equation, A = dr/dv, discrete energy E1, step density D"
    } else {
        "Step: residual r of the momentum equation, A = dr/dv, discrete energy E1"
    };
    Section { title, lines }
}

fn step_by_midpoint(of: &Loops) -> Vec<Line> {
    let (forced, autonomous) = (of.indexed.model.forced, of.indexed.autonomous);
    let force = if forced { "(L_q + f)" } else { "L_q" };
    let (matrix, matrix_latex) = if forced {
        let latex = "L_{vv} + \\frac{h}{2} (L_{vq} - L_{qv} - f_v) - \\frac{h^{2}}{4} (L_{qq} + f_q)";
        ("L_vv + h/2*(L_vq - L_qv - f_v) - h^2/4*(L_qq + f_q)", latex)
    } else {
        let latex = "L_{vv} + \\frac{h}{2} (L_{vq} - L_{qv}) - \\frac{h^{2}}{4} L_{qq}";
        ("L_vv + h/2*(L_vq - L_qv) - h^2/4*L_qq", latex)
    };
    let (work, work_latex) = match (forced, autonomous) {
        (true, true) => (" + h/2*f·v", " + \\frac{h}{2} f \\cdot v"),
        (true, false) => (" + h/2*(f·v - L_t)", " + \\frac{h}{2} (f \\cdot v - L_t)"),
        (false, true) => ("", ""),
        (false, false) => (" - h/2*L_t", " - \\frac{h}{2} L_t"),
    };
    let [rate, rate_latex] = if autonomous { ["", ""] } else { [" - d/dt(L_t)", " - \\frac{d}{dt} L_t"] };
    let midpoint = "\\frac{t_0 + t_1}{2}, \\frac{q_0 + q_1}{2}, \\frac{q_1 - q_0}{h}";
    vec![
        line(["t, q, v", "(t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h"], ["t, q, v", midpoint]),
        line(["L_d", "h*L"], ["L_d", "h L"]),
        line(["r", &format!("L_v - h/2*{force} - p0")], ["r", &format!("L_v - \\frac{{h}}{{2}} {force} - p_0")]),
        line(["A", matrix], ["A", matrix_latex]),
        line(["p1 - p0", &format!("h*{force}")], ["p_1 - p_0", &format!("h {force}")]),
        line(["E1", &format!("v·L_v - L{work}")], ["E_1", &format!("v \\cdot L_v - L{work_latex}")]),
        line(
            ["D", &format!("a·{force} - v·d/dt(L_q){rate}")],
            ["D", &format!("a \\cdot {force} - v \\cdot \\frac{{d}}{{dt}} L_q{rate_latex}")],
        ),
    ]
}

fn step_by_ends(of: &Loops) -> Vec<Line> {
    let (forced, autonomous) = (of.indexed.model.forced, of.indexed.autonomous);
    let force = |end: u8| if forced { format!("(L_q + f)({end})") } else { format!("L_q({end})") };
    let [before, after] = [force(0), force(1)];
    let [slope, slope_latex] = if forced { [" - f_v(0)", " - f_v(0)"] } else { ["", ""] };
    let (work, work_latex) = match (forced, autonomous) {
        (true, true) => (" + h/2*f(1)·v", " + \\frac{h}{2} f(1) \\cdot v"),
        (true, false) => (" + h/2*(f·v - L_t)(1)", " + \\frac{h}{2} (f \\cdot v - L_t)(1)"),
        (false, true) => ("", ""),
        (false, false) => (" - h/2*L_t(1)", " - \\frac{h}{2} L_t(1)"),
    };
    vec![
        Line::words("X(0) is X at (t0, q0, v), and X(1) is X at (t1, q1, v)"),
        line(["v", "(q1 - q0)/h"], ["v", "\\frac{q_1 - q_0}{h}"]),
        line(["L_d", "h/2*(L(0) + L(1))"], ["L_d", "\\frac{h}{2} (L(0) + L(1))"]),
        line(
            ["r", &format!("(L_v(0) + L_v(1))/2 - h/2*{before} - p0")],
            ["r", &format!("\\frac{{1}}{{2}} (L_v(0) + L_v(1)) - \\frac{{h}}{{2}} {before} - p_0")],
        ),
        line(
            ["A", &format!("(L_vv(0) + L_vv(1))/2 + h/2*(L_vq(1) - L_qv(0){slope})")],
            [
                "A",
                &format!(
                    "\\frac{{1}}{{2}} (L_{{vv}}(0) + L_{{vv}}(1)) + \\frac{{h}}{{2}} (L_{{vq}}(1) - L_{{qv}}(0){slope_latex})"
                ),
            ],
        ),
        line(
            ["p1 - p0", &format!("h/2*({before} + {after})")],
            ["p_1 - p_0", &format!("\\frac{{h}}{{2}} ({before} + {after})")],
        ),
        line(
            ["E1", &format!("v·(L_v(0) + L_v(1))/2 - (L(0) + L(1))/2{work}")],
            [
                "E_1",
                &format!("\\frac{{1}}{{2}} v \\cdot (L_v(0) + L_v(1)) - \\frac{{1}}{{2}} (L(0) + L(1)){work_latex}"),
            ],
        ),
    ]
}

/// Findings, and operation counts of the functions of one row.
pub(super) fn findings(of: &Loops) -> Vec<Section> {
    let text = indexed::documentation(&of.indexed);
    let latex = indexed::properties(&of.indexed, &|coordinate| format!("`{}`", name::coordinate(coordinate).text()));
    let mut lines: Vec<Line> = text.into_iter().zip(latex).map(|(text, latex)| Line::Words { text, latex }).collect();
    for rule in of.indexed.rules.iter().skip(1) {
        let further = indexed::of_steps(&of.indexed, rule);
        lines.extend(further.into_iter().map(|line| Line::words(format!("By the rule {}: {line}", rule.name))));
    }
    let named = indexed::named(&of.indexed);
    let width = named.iter().map(|of| of.name.len()).max().unwrap_or(0);
    let costs = named.iter().map(|of| {
        let (name, rows, first, second) = (&of.name, of.rows(), of.first_operations(), of.second_operations());
        Line::Words {
            text: format!("{name:width$} {:>10} {first:6} {second:>6}", counted(rows, "row")),
            latex: format!("{name}: {}, {first}, {second}", counted(rows, "row")),
        }
    });
    vec![
        Section { title: "Properties found by the generator", lines },
        Section {
            title: "Operations of each function of one row, for first and for second derivatives",
            lines: costs.collect(),
        },
    ]
}

/// The functions of one row, operation by operation, with their loops.
pub(super) fn program(of: &Loops) -> String {
    let functions = indexed::named(&of.indexed);
    functions.iter().map(|named| function(of, named)).collect::<Vec<_>>().join("\n")
}

fn function(of: &Loops, named: &NamedBody) -> String {
    let (body, model) = (named.body, &of.indexed.model);
    let mut text = format!("{}, {}\n", named.name, counted(named.rows(), "row"));
    let is_single = body.values.len() == 1;
    let values =
        (1..=body.values.len()).map(|place| if is_single { "value".to_owned() } else { format!("value{place}") });
    let values: Vec<String> = values.collect();
    for nest in named.nests {
        let row = Row::new(of, named, nest);
        let reads = row.reads.iter().enumerate().map(|(place, read)| format!("a{place} = {}", read.text));
        let computed = |sign: &str, prefix: &str| {
            let each =
                row.computed.iter().zip(&values).map(|(of, value)| format!("{prefix}{} {sign} {value}", of.text));
            each.collect::<Vec<_>>().join(", ")
        };
        let computed = match named.quantity {
            Quantity::Entries(_) => computed("=", ""),
            Quantity::Lagrangian => "L += value".to_owned(),
            Quantity::Dissipation => "R += value".to_owned(),
            Quantity::Scale => "g = value".to_owned(),
            Quantity::Force => computed("+=", "f_"),
            Quantity::Constraint | Quantity::Part => computed("+=", ""),
        };
        let rows = in_each_row(nest).text;
        let rows = rows.strip_prefix(' ').map_or_else(|| "one row".to_owned() + &rows, str::to_owned);
        text.extend(["    ", &rows, ": ", &computed]);
        text.extend(
            reads.enumerate().map(|(place, read)| (if place == 0 { ", with " } else { ", " }).to_owned() + &read),
        );
        text.push('\n');
    }
    let (mut first, mut second) = (Vec::new(), Vec::new());
    for (value, name) in body.values.iter().zip(&values) {
        let slopes: Vec<String> = value.states.iter().map(|place| format!("d {name}/d a{place}")).collect();
        first.extend([name.clone(), format!("d {name}/dt")]);
        first.extend(slopes.clone());
        second.extend(slopes);
        let at = |place: &usize| value.states[*place];
        second.extend(value.pairs.iter().map(|[row, column]| format!("d² {name}/d a{} d a{}", at(row), at(column))));
    }
    text.push_str(&listed(model, "first derivatives", &body.slopes, &first));
    if let Some(curvatures) = &body.curvatures {
        text.push_str(&listed(model, "second derivatives", curvatures, &second));
    }
    text
}

/// `1 row`, `2 rows`.
fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// A function of one row; its results have these labels.
fn listed(model: &Model, title: &str, of: &Function, labels: &[String]) -> String {
    let count = of.operation_count();
    let (operations, results) = program::operations(of, &|symbol| model.spell(symbol));
    let mut text = format!("  {title}: {}\n{operations}", counted(count, "operation"));
    for (label, result) in labels.iter().zip(results.iter().flatten()) {
        text.extend(["    ", label, " = ", result, "\n"]);
    }
    text
}
