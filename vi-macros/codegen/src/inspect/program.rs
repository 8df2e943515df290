//! The functions of a system, operation by operation.
//!
//! In: a system under each of its rules. Out: per function its operations in order, `%3 = %1 * x_mid`, and its results;
//! then, for each further rule, the functions that depend on it. Inputs and numbers are inlined. A note marks
//! operations that are arguments of the rule.

use super::model;
use crate::program::{Function, Operation, OperationId};
use crate::symbol::Symbol;
use crate::{Derivations, Derived};
use std::collections::BTreeMap;

/// All functions.
pub(super) fn text(Derivations { own, further }: &Derivations) -> String {
    let mut functions: Vec<String> = own.program.functions().map(|of| function(own, of)).collect();
    for derived in further {
        functions.push(format!("by the rule {}\n", model::title(&derived.model)));
        functions.extend(derived.program.by_rule().map(|of| function(derived, of)));
    }
    functions.join("\n")
}

fn function(derived: &Derived, of: &Function) -> String {
    let count = of.operation_count();
    let (operations, results) = operations(of, &|symbol| derived.system.spell(&derived.model, symbol));
    let mut text = format!("{}: {count} operation{}\n{operations}", of.id.name(), if count == 1 { "" } else { "s" });
    for row in results {
        text.extend(["    result ", &row.join(", "), "\n"]);
    }
    text
}

/// The operations in order, and the rows of results.
pub(super) fn operations(of: &Function, spell: &dyn Fn(&Symbol) -> String) -> (String, Vec<Vec<String>>) {
    let mut text = String::new();
    let mut worked = 0;
    let mut names: BTreeMap<OperationId, String> = BTreeMap::new();
    for id in of.needed() {
        let operand = |id: &OperationId| names.get(id).cloned().unwrap_or_default();
        let operation = of.operations.get(id);
        let formula = match operation {
            Operation::Constant(bits) => f64::from_bits(*bits).to_string(),
            Operation::Input(symbol) => spell(symbol),
            Operation::Negate(a) => format!("-{}", operand(a)),
            Operation::Add(a, b) => format!("{} + {}", operand(a), operand(b)),
            Operation::Subtract(a, b) => format!("{} - {}", operand(a), operand(b)),
            Operation::Multiply(a, b) => format!("{} * {}", operand(a), operand(b)),
            Operation::Divide(a, b) => format!("{} / {}", operand(a), operand(b)),
            Operation::SquareRoot(a) => format!("sqrt({})", operand(a)),
            Operation::Reciprocal(a) => format!("1 / {}", operand(a)),
            Operation::Call(called, a) => format!("{}({})", called.name(), operand(a)),
            Operation::Call2(called, a, b) => format!("{}({}, {})", called.name(), operand(a), operand(b)),
            Operation::Opaque(called, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(operand).collect();
                format!("{}({})", called.text(), arguments.join(", "))
            }
            Operation::Select(a, b, c) => {
                format!("if {} > 0 {{ {} }} else {{ {} }}", operand(a), operand(b), operand(c))
            }
            Operation::ZeroWhere(a, b, _) => format!("{}, or 0 where {} = 0", operand(a), operand(b)),
        };
        if operation.is_work() {
            worked += 1;
            let name = format!("%{worked}");
            let note = of.operations.name(id).map(|symbol| format!("    # {}", spell(symbol))).unwrap_or_default();
            text.extend(["    ", &name, " = ", &formula, &note, "\n"]);
            names.insert(id, name);
        } else {
            names.insert(id, formula);
        }
    }
    let row = |row: &[OperationId]| row.iter().map(|id| names.get(id).cloned().unwrap_or_default()).collect();
    let results = of.results.rows().map(row).collect();
    (text, results)
}
