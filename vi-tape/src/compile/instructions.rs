//! Operations as instructions: sines with their cosines, products with the operation that alone uses them, constants
//! inside.

use super::TooMany;
use crate::lines::Kind;
use crate::tables::Tables;
use std::collections::{HashMap, HashSet};
use vi_codegen::program::{Function, Operation, OperationId, Operations};
use vi_expr::Function as Elementary;

/// An instruction before it has registers.
pub(super) struct Instruction {
    pub(super) kind: Kind,
    pub(super) results: Vec<OperationId>,
    pub(super) operands: Vec<OperationId>,
    /// The place of a constant; 1 if a sine and cosine has the cosine alone.
    pub(super) constant: u16,
}

/// The constants of a function, each once.
#[derive(Default)]
pub(super) struct Constants {
    values: Vec<f64>,
    places: HashMap<u64, u16>,
}

impl Constants {
    fn place(&mut self, value: f64) -> Result<u16, TooMany> {
        if let Some(place) = self.places.get(&value.to_bits()) {
            return Ok(*place);
        }
        let place = u16::try_from(self.values.len()).map_err(|_| "constants")?;
        self.values.push(value);
        self.places.insert(value.to_bits(), place);
        Ok(place)
    }
}

impl From<Constants> for Box<[f64]> {
    fn from(of: Constants) -> Self {
        of.values.into()
    }
}

/// The instructions of the operations that are needed, operands before results.
pub(super) fn instructions(
    function: &Function,
    needed: &[OperationId],
    results: impl Iterator<Item = OperationId>,
    constants: &mut Constants,
    tables: &Tables,
) -> Result<Vec<Instruction>, TooMany> {
    let operations = &function.operations;
    let mut uses: HashMap<OperationId, usize> = HashMap::new();
    for id in needed.iter().flat_map(|id| operations.get(*id).operands()).chain(results) {
        *uses.entry(id).or_default() += 1;
    }
    let mut joined = Joined::of(operations, needed, &uses);
    let (mut all, mut done, mut loaded) = (Vec::new(), HashSet::new(), HashSet::new());
    for id in needed {
        if !operations.get(*id).is_work() || joined.inner.contains(id) || !done.insert(*id) {
            continue;
        }
        if let Some((kind, operands)) = joined.outer.remove(id) {
            all.push(Instruction { kind, results: vec![*id], operands: operands.into(), constant: 0 });
            continue;
        }
        let instruction =
            alone(operations, *id, (constants, tables), &mut |other| uses.contains_key(&other) && done.insert(other))?;
        for operand in &instruction.operands {
            if let Some(value) = operations.as_constant(*operand).filter(|_| loaded.insert(*operand)) {
                let constant = constants.place(value)?;
                all.push(Instruction { kind: Kind::Constant, results: vec![*operand], operands: Vec::new(), constant });
            }
        }
        all.push(instruction);
    }
    Ok(all)
}

/// The instruction of one operation. `is_joined` takes the cosine of a sine, or the sine of a cosine, if it is needed.
fn alone(
    operations: &Operations,
    id: OperationId,
    (constants, tables): (&mut Constants, &Tables),
    is_joined: &mut dyn FnMut(OperationId) -> bool,
) -> Result<Instruction, TooMany> {
    let operation = operations.get(id);
    let constant = |id: &OperationId| operations.as_constant(*id);
    let with_constant = match operation {
        Operation::Add(a, b) => constant(b).map(|k| (Kind::AddConstant, *a, k)),
        Operation::Multiply(a, b) => constant(b).map(|k| (Kind::Scale, *a, k)),
        Operation::Subtract(a, b) => match (constant(a), constant(b)) {
            (_, Some(k)) => Some((Kind::SubtractConstant, *a, k)),
            (Some(k), _) => Some((Kind::SubtractFromConstant, *b, k)),
            _ => None,
        },
        _ => None,
    };
    if let Some((kind, a, k)) = with_constant {
        return Ok(Instruction { kind, results: vec![id], operands: vec![a], constant: constants.place(k)? });
    }
    let (mut results, mut of_cosine) = (vec![id], 0);
    let kind = match operation {
        Operation::Add(..) => Kind::Add,
        Operation::Subtract(..) => Kind::Subtract,
        Operation::Multiply(..) => Kind::Multiply,
        Operation::Divide(..) => Kind::Divide,
        Operation::Negate(_) => Kind::Negate,
        Operation::SquareRoot(_) => Kind::SquareRoot,
        Operation::Reciprocal(_) => Kind::Reciprocal,
        Operation::ZeroWhere(_, _, derivatives) => Kind::ZeroWhere(*derivatives),
        Operation::Select(..) => Kind::Select,
        Operation::Call(Elementary::Abs, _) => Kind::Absolute,
        Operation::Call(of @ (Elementary::Sin | Elementary::Cos), angle) => {
            let is_sine = *of == Elementary::Sin;
            let other = if is_sine { Elementary::Cos } else { Elementary::Sin };
            match operations.find(&Operation::Call(other, *angle)).filter(|other| is_joined(*other)) {
                Some(other) => results = if is_sine { vec![id, other] } else { vec![other, id] },
                // The other one goes to a free register: a pair is inlined, and a single one would be a call.
                None => of_cosine = u16::from(!is_sine),
            }
            Kind::SineCosine
        }
        Operation::Call(of, _) | Operation::Call2(of, ..) => Kind::Call(*of),
        Operation::Opaque(of, _) => {
            let table = tables.place(&of.name).ok_or("kinds of functions")?;
            Kind::Table { of: table, orders: [of.orders[0], of.orders[1]] }
        }
        Operation::Constant(_) | Operation::Input(_) => return Err("kinds of operations"),
    };
    Ok(Instruction { kind, results, operands: operation.operands().collect(), constant: of_cosine })
}

/// Products that become part of the operation that alone uses them.
#[derive(Default)]
struct Joined {
    inner: HashSet<OperationId>,
    outer: HashMap<OperationId, (Kind, [OperationId; 3])>,
}

impl Joined {
    fn of(operations: &Operations, needed: &[OperationId], uses: &HashMap<OperationId, usize>) -> Self {
        let is_constant = |id: &OperationId| operations.as_constant(*id).is_some();
        let mut joined = Self::default();
        for id in needed {
            let product = |of: &OperationId| match operations.get(*of) {
                Operation::Multiply(a, b) if !is_constant(b) && uses.get(of) == Some(&1) => {
                    (!joined.inner.contains(of) && !joined.outer.contains_key(of)).then_some([*a, *b])
                }
                _ => None,
            };
            let either = |a: &OperationId, b: &OperationId, [first, second]: [Kind; 2]| match (product(b), product(a)) {
                (Some(of), _) => Some((second, of, *a, *b)),
                (None, Some(of)) => Some((first, of, *b, *a)),
                (None, None) => None,
            };
            let found = match operations.get(*id) {
                Operation::Add(a, b) if !is_constant(b) => either(a, b, [Kind::MultiplyAdd; 2]),
                Operation::Subtract(a, b) if !is_constant(a) && !is_constant(b) => {
                    either(a, b, [Kind::MultiplySubtract, Kind::SubtractProduct])
                }
                Operation::Multiply(a, b) if !is_constant(b) => product(a).map(|of| (Kind::MultiplyTwice, of, *b, *a)),
                _ => None,
            };
            if let Some((kind, [a, b], c, inner)) = found {
                joined.inner.insert(inner);
                joined.outer.insert(*id, (kind, [a, b, c]));
            }
        }
        joined
    }
}
