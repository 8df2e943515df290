//! The clauses as they were parsed, in the language itself.
//!
//! In: a [`System`] as written. Out: its clauses by kind, with exact numbers and the necessary parentheses.

use crate::messages::bracketed;
use crate::syntax::{
    Body, Comparison, Constant, Definition, Discretization, Expression, Indices, Kind, Operator, Parameter, Range,
    System, Table, TableArgument, TableData,
};
use quote::ToTokens;

/// The clauses of a system.
pub(super) fn text(system: &System) -> String {
    let mut lines = Vec::new();
    lines.extend(system.constants.iter().map(constant));
    lines.extend(system.parameters.iter().map(parameter));
    for coordinate in &system.coordinates {
        lines.push(format!("{} {}{};", coordinate.space.word(), coordinate.name, brackets(&coordinate.lengths)));
    }
    lines.extend(system.momenta.iter().map(|of| format!("momentum {} of {};", of.name, of.of)));
    lines.extend(system.functions.iter().map(|of| {
        let arguments: Vec<String> = of.arguments.iter().map(ToString::to_string).collect();
        let body = match &of.body {
            Body::Expression(body) => expression(body),
            Body::Path(path) => path.to_token_stream().to_string().replace(' ', ""),
        };
        format!("fn {}({}) = {body};", of.name, arguments.join(", "))
    }));
    lines.extend(system.tables.iter().map(table));
    lines.extend(equations(system));
    for discretization in &system.discretizations {
        match discretization {
            Discretization::Named(names) => {
                let names: Vec<String> = names.iter().map(ToString::to_string).collect();
                lines.push(format!("discretize {};", names.join(", ")));
            }
            Discretization::Written(rule) => {
                lines.push("discretize {".to_owned());
                lines.extend(rule.lines.iter().map(|line| format!("    {}", definition(line))));
                lines.push("}".to_owned());
            }
        }
    }
    format!("struct {} {{\n    {}\n}}\n", system.name, lines.join("\n    "))
}

/// The definitions of the named parts, of L, of the forces and of the constraints.
pub(super) fn equations(system: &System) -> Vec<String> {
    let each = system.definitions.iter().flat_map(|(clause, all)| all.iter().map(move |of| (clause, of)));
    each.map(|(clause, of)| {
        let text = definition(of);
        if clause.has_names() { format!("{} {text}", clause.word()) } else { text }
    })
    .collect()
}

fn table(of: &Table) -> String {
    let list = |row: &Vec<Expression>| row.iter().map(expression).collect::<Vec<_>>().join(", ");
    let argument = |argument: &TableArgument| match &argument.range {
        Some((from, to)) => format!("{} in {}..{}", argument.name, expression(from), expression(to)),
        None => argument.name.to_string(),
    };
    let arguments: Vec<String> = of.arguments.iter().map(argument).collect();
    let data = match &of.data {
        TableData::File(path) => format!("{:?}", path.value()),
        TableData::Parameters(name) => name.to_string(),
        TableData::Points(points) => {
            let points: Vec<String> = points.iter().map(|point| format!("({})", list(point))).collect();
            format!("[{}]", points.join(", "))
        }
        TableData::Rows(rows) if rows.len() == 1 => format!("[{}]", list(&rows[0])),
        TableData::Rows(rows) => {
            let rows: Vec<String> = rows.iter().map(|row| format!("[{}]", list(row))).collect();
            format!("[{}]", rows.join(", "))
        }
    };
    let words: Vec<String> = [data].into_iter().chain(of.words.iter().map(ToString::to_string)).collect();
    format!("table {}({}) = {};", of.name, arguments.join(", "), words.join(" "))
}

fn constant(of: &Constant) -> String {
    format!("const {}{} = {};", of.name, brackets(&of.lengths), expression(&of.value))
}

fn parameter(of: &Parameter) -> String {
    format!("{} {}{} = {};", of.clause(), of.name, brackets(&of.lengths), expression(&of.default))
}

/// Indices or lengths, each in brackets of its own.
fn brackets(of: &[Expression]) -> String {
    bracketed(of.iter().map(expression))
}

fn definition(of: &Definition) -> String {
    let one = |indices: &Indices| match indices {
        Indices::Range(indices) => range(indices),
        Indices::One(index) => expression(index),
    };
    let indices = bracketed(of.indices.iter().map(one));
    format!("{}{indices} = {};", of.name, expression(&of.value))
}

fn range(of: &Range) -> String {
    format!("{} in {}..{}", of.index, expression(&of.from), expression(&of.to))
}

/// Binding strength of an expression.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Negative,
    Power,
    Atom,
}

fn expression(of: &Expression) -> String {
    within(of, Binding::Sum)
}

/// The expression, in parentheses if it binds less tightly. The parser bounds the depth.
fn within(of: &Expression, least: Binding) -> String {
    let (binding, text) = written(of);
    if binding < least { format!("({text})") } else { text }
}

fn written(of: &Expression) -> (Binding, String) {
    match &of.kind {
        Kind::Number(value) if value.is_integer() => (Binding::Atom, value.to_string()),
        // It would parse as a quotient.
        Kind::Number(value) => (Binding::Product, format!("{} / {}", value.numer(), value.denom())),
        Kind::Name(name) => (Binding::Atom, name.to_string()),
        Kind::Entry(name, indices) => (Binding::Atom, format!("{name}{}", brackets(indices))),
        Kind::List(entries) => {
            let entries: Vec<String> = entries.iter().map(expression).collect();
            (Binding::Atom, format!("[{}]", entries.join(", ")))
        }
        Kind::Call(name, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(expression).collect();
            (Binding::Atom, format!("{name}({})", arguments.join(", ")))
        }
        Kind::Sum(ranges, summand) => {
            let ranges: Vec<String> = ranges.iter().map(range).collect();
            (Binding::Atom, format!("sum({}, {})", ranges.join(", "), expression(summand)))
        }
        Kind::Negative(operand) => (Binding::Negative, format!("-{}", within(operand, Binding::Negative))),
        Kind::Power(base, exponent) => {
            (Binding::Power, format!("{}^{}", within(base, Binding::Atom), within(exponent, Binding::Negative)))
        }
        Kind::Chain(first, rest) => chain(first, rest),
        Kind::If(comparison, arms) => {
            let [then, otherwise] = &**arms;
            let Comparison { larger, smaller, or_equal, reversed } = &**comparison;
            let (left, sign, right) = if *reversed { (smaller, "<", larger) } else { (larger, ">", smaller) };
            let equal = if *or_equal { "=" } else { "" };
            let condition = format!("{} {sign}{equal} {}", expression(left), expression(right));
            (Binding::Atom, format!("if {condition} {{ {} }} else {{ {} }}", expression(then), expression(otherwise)))
        }
    }
}

fn chain(first: &Expression, rest: &[(Operator, Expression)]) -> (Binding, String) {
    let product = rest.iter().any(|(operator, _)| matches!(operator, Operator::Times | Operator::Over));
    // An operand that is itself a chain of this precedence was written in parentheses.
    let (binding, operand) =
        if product { (Binding::Product, Binding::Negative) } else { (Binding::Sum, Binding::Product) };
    let mut text = within(first, operand);
    for (operator, next) in rest {
        let symbol = match operator {
            Operator::Plus => " + ",
            Operator::Minus => " - ",
            Operator::Times => " * ",
            Operator::Over => " / ",
        };
        text.push_str(symbol);
        text.push_str(&within(next, operand));
    }
    (binding, text)
}
