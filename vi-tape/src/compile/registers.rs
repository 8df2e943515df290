//! Registers for results, free again after the last use of their number.

use super::TooMany;
use super::instructions::Instruction;
use crate::lines::Kind;
use std::collections::HashMap;
use vi_codegen::program::OperationId;

/// Instructions with registers.
pub(super) struct Placed {
    /// For each instruction the register of its result, and those of its operands.
    pub(super) operands: Vec<[u16; 4]>,
    /// The number of registers.
    pub(super) registers: usize,
    /// The register of each input and each result.
    pub(super) of: HashMap<OperationId, u16>,
}

/// Registers that are in use, and those that are free again.
#[derive(Default)]
struct Registers {
    free: Vec<u16>,
    count: u16,
}

impl Registers {
    fn take(&mut self) -> Result<u16, TooMany> {
        if let Some(register) = self.free.pop() {
            return Ok(register);
        }
        let register = self.count;
        self.count = register.checked_add(1).ok_or("numbers at once")?;
        Ok(register)
    }
}

/// Places instructions in this order. The inputs have the first registers; the results of the function stay.
pub(super) fn placed(
    all: &[Instruction],
    order: &[usize],
    inputs: &[OperationId],
    results: impl Iterator<Item = OperationId>,
) -> Result<Placed, TooMany> {
    let mut left: HashMap<OperationId, usize> = HashMap::new();
    for id in all.iter().flat_map(|instruction| instruction.operands.iter().copied()).chain(results) {
        *left.entry(id).or_default() += 1;
    }
    let (mut registers, mut of) = (Registers::default(), HashMap::new());
    for id in inputs {
        of.insert(*id, registers.take()?);
    }
    let mut operands = Vec::with_capacity(order.len());
    for instruction in order.iter().map(|at| &all[*at]) {
        let mut places = [0; 4];
        for (place, id) in places[1..].iter_mut().zip(&instruction.operands) {
            *place = *of.get(id).ok_or("operands")?;
        }
        match instruction.kind {
            // The values of a table of parameters, which are neighbouring inputs.
            Kind::Table { .. } if instruction.operands.len() > 2 => {
                let mut values = instruction.operands[1..].iter().map(|id| of.get(id)).zip(places[2]..);
                if !values.all(|(found, wanted)| found == Some(&wanted)) {
                    return Err("kinds of tables");
                }
            }
            Kind::AddConstant | Kind::SubtractConstant | Kind::SubtractFromConstant | Kind::Scale | Kind::Constant => {
                places[2] = instruction.constant;
            }
            Kind::Call(_) if instruction.operands.len() == 1 => places[2] = places[1],
            _ => {}
        }
        for id in &instruction.operands {
            let uses = left.entry(*id).or_default();
            *uses = uses.saturating_sub(1);
            if *uses == 0 {
                registers.free.extend(of.get(id));
            }
        }
        match (instruction.kind, &instruction.results[..]) {
            (Kind::SineCosine, [one]) => {
                let [own, other] = [registers.take()?, registers.take()?];
                registers.free.push(other);
                of.insert(*one, own);
                (places[0], places[2]) = if instruction.constant == 0 { (own, other) } else { (other, own) };
            }
            (_, results) => {
                for (id, place) in results.iter().zip([0, 2]) {
                    places[place] = registers.take()?;
                    of.insert(*id, places[place]);
                }
            }
        }
        operands.push(places);
    }
    Ok(Placed { operands, registers: usize::from(registers.count), of })
}
