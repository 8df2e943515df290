//! A function as instructions over registers, and the interpreter.
//!
//! Instructions of one kind that do not wait for each other follow one another, so that the interpreter selects what to
//! do once for all of them. A product that one operation alone uses is one instruction with that operation; both round.

use core::any::{Any, TypeId};
use core::cell::RefCell;
use vi_core::SVector;
use vi_core::real::Real;
use vi_core::table::AnyTable;
use vi_dispatch::{Instructions, Loop};
use vi_expr::Function as Elementary;

/// The operation of an instruction on the registers a, b and c, or on the constant k.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// a + b
    Add,
    /// a − b
    Subtract,
    /// a·b
    Multiply,
    /// a/b
    Divide,
    /// −a
    Negate,
    /// √a
    SquareRoot,
    /// 1/a
    Reciprocal,
    /// |a|
    Absolute,
    /// a + k
    AddConstant,
    /// a − k
    SubtractConstant,
    /// k − a
    SubtractFromConstant,
    /// a·k
    Scale,
    /// k
    Constant,
    /// sin a, and cos a to a second register
    SineCosine,
    /// A function of a, or of a and b, by the library
    Call(Elementary),
    /// A derivative of a table at a, or at (a, b); the values of a table of parameters begin at b
    Table { of: u16, orders: [u8; 2] },
    /// b if a is positive, else c
    Select,
    /// a, or 0 if b is 0; then this number of its derivatives is 0 too
    ZeroWhere(u8),
    /// a·b + c
    MultiplyAdd,
    /// a·b − c
    MultiplySubtract,
    /// c − a·b
    SubtractProduct,
    /// (a·b)·c
    MultiplyTwice,
}

/// The location of a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    Register(u16),
    Constant(f64),
}

/// An entry of a result that is not the constant 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) row: u16,
    /// The column, or its place among the columns of the row.
    pub(crate) column: u16,
    pub(crate) source: Source,
}

impl Entry {
    /// The number.
    #[inline(always)]
    fn value<T: Real>(&self, registers: &[T]) -> T {
        match self.source {
            Source::Register(register) => registers[register as usize],
            Source::Constant(value) => T::real(value),
        }
    }
}

/// Neighbouring entries of an argument, which the first registers hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Input {
    pub(crate) argument: u8,
    pub(crate) from: u16,
    pub(crate) count: u16,
}

/// A function.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    /// The arguments, in the order of their registers.
    pub(crate) inputs: Box<[Input]>,
    /// Kinds, and how many instructions of each follow one another.
    pub(crate) runs: Box<[(Kind, u16)]>,
    /// For each instruction the register of its result, and a, b, c; the place of a constant is in that of b.
    pub(crate) operands: Box<[[u16; 4]]>,
    pub(crate) constants: Box<[f64]>,
    pub(crate) tables: &'static [AnyTable],
    /// The number of registers.
    pub(crate) registers: usize,
    /// The entries of each quantity, in the order in which the function lists them.
    pub(crate) results: Box<[Box<[Entry]>]>,
}

/// The number of registers that a thread keeps for each type of numbers. Functions with up to 32 registers have them on
/// the stack; to zero more takes as long as a function.
const KEPT: usize = 1024;

/// Registers that do not cross lines of the cache.
#[repr(align(64))]
struct Aligned<T>([T; KEPT]);

thread_local! {
    static REGISTERS: RefCell<Vec<(TypeId, Box<dyn Any>)>> = const { RefCell::new(Vec::new()) };
}

/// Registers with old values.
#[inline(never)]
#[allow(clippy::unnecessary_box_returns, reason = "they are large, and kept in boxes")]
fn taken<T: Real>() -> Box<Aligned<T>> {
    let kept = REGISTERS.with_borrow_mut(|kept| {
        let at = kept.iter().position(|(of, _)| *of == TypeId::of::<T>())?;
        kept.swap_remove(at).1.downcast().ok()
    });
    kept.unwrap_or_else(|| Box::new(Aligned([T::zero(); KEPT])))
}

/// Keeps registers for the next function.
#[inline(never)]
fn keep<T: Real>(registers: Box<Aligned<T>>) {
    REGISTERS.with_borrow_mut(|kept| kept.push((TypeId::of::<T>(), registers)));
}

/// The instructions of a function with their arguments and registers.
struct Execution<'a, T> {
    lines: &'a Lines,
    arguments: &'a [&'a [T]],
    registers: &'a mut [T],
}

impl<T: Real> Loop for Execution<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.lines.execute(self.arguments, self.registers);
    }
}

/// Numbers of at least this size profit from wide vectors: four lanes.
const WIDE: usize = 32;

impl Lines {
    /// Evaluates the function; `read` takes its results from the registers.
    #[inline(always)]
    pub(crate) fn evaluated<T: Real, Y>(
        &self,
        instructions: Instructions,
        arguments: &[&[T]],
        read: impl FnOnce(Results<'_, T>) -> Y,
    ) -> Y {
        let (mut few, mut some, mut many, mut most);
        let mut kept = None;
        let registers: &mut [T] = match self.registers {
            0..=8 => {
                few = [T::zero(); 8];
                &mut few
            }
            9..=16 => {
                some = [T::zero(); 16];
                &mut some
            }
            17..=32 => {
                many = [T::zero(); 32];
                &mut many
            }
            33..=KEPT => &mut kept.insert(taken::<T>()).0,
            count => {
                most = vec![T::zero(); count];
                &mut most
            }
        };
        self.run(instructions, arguments, registers);
        let value = read(Results { lines: self, registers });
        if let Some(kept) = kept {
            keep(kept);
        }
        value
    }

    /// Executes the instructions. One copy of the interpreter for each type of numbers and set of instructions serves all
    /// systems.
    #[inline(never)]
    fn run<T: Real>(&self, instructions: Instructions, arguments: &[&[T]], registers: &mut [T]) {
        let all = Execution { lines: self, arguments, registers };
        if const { size_of::<T>() >= WIDE } { instructions.run(all) } else { vi_dispatch::by_baseline(all) }
    }

    #[inline(always)]
    fn execute<T: Real>(&self, arguments: &[&[T]], r: &mut [T]) {
        let mut first = 0;
        for Input { argument, from, count } in &self.inputs {
            let (from, count) = (usize::from(*from), usize::from(*count));
            r[first..first + count].copy_from_slice(&arguments[usize::from(*argument)][from..from + count]);
            first += count;
        }
        let constants = &*self.constants;
        let mut operands = &*self.operands;
        for (kind, count) in &self.runs {
            let (own, rest) = operands.split_at(usize::from(*count));
            operands = rest;
            macro_rules! each {
                (|$a:ident| $value:expr) => {
                    for [to, $a, _, _] in own {
                        let $a = r[*$a as usize];
                        r[*to as usize] = $value;
                    }
                };
                (|$a:ident, $b:ident| $value:expr) => {
                    for [to, $a, $b, _] in own {
                        let ($a, $b) = (r[*$a as usize], r[*$b as usize]);
                        r[*to as usize] = $value;
                    }
                };
                (|$a:ident, $b:ident, $c:ident| $value:expr) => {
                    for [to, $a, $b, $c] in own {
                        let ($a, $b, $c) = (r[*$a as usize], r[*$b as usize], r[*$c as usize]);
                        r[*to as usize] = $value;
                    }
                };
                (|$a:ident; $k:ident| $value:expr) => {
                    for [to, $a, place, _] in own {
                        let ($a, $k) = (r[*$a as usize], T::real(constants[*place as usize]));
                        r[*to as usize] = $value;
                    }
                };
            }
            match *kind {
                Kind::Add => each!(|a, b| a + b),
                Kind::Subtract => each!(|a, b| a - b),
                Kind::Multiply => each!(|a, b| a * b),
                Kind::Divide => each!(|a, b| a / b),
                Kind::Negate => each!(|a| -a),
                Kind::SquareRoot => each!(|a| a.sqrt()),
                Kind::Reciprocal => each!(|a| a.recip()),
                Kind::Absolute => each!(|a| a.abs()),
                Kind::AddConstant => each!(|a; k| a + k),
                Kind::SubtractConstant => each!(|a; k| a - k),
                Kind::SubtractFromConstant => each!(|a; k| k - a),
                Kind::Scale => each!(|a; k| a * k),
                Kind::Constant => {
                    for [to, _, place, _] in own {
                        r[*to as usize] = T::real(constants[*place as usize]);
                    }
                }
                Kind::SineCosine => {
                    for [sine, a, cosine, _] in own {
                        let (of_sine, of_cosine) = r[*a as usize].sin_cos();
                        r[*sine as usize] = of_sine;
                        r[*cosine as usize] = of_cosine;
                    }
                }
                Kind::Call(of) => each!(|a, b| call(of, &a, &b)),
                Kind::Table { of, orders } => {
                    for [to, a, b, _] in own {
                        r[*to as usize] = table(&self.tables[of as usize], orders, r, [*a, *b].map(usize::from));
                    }
                }
                Kind::Select => each!(|a, b, c| a.if_positive(b, c)),
                Kind::ZeroWhere(derivatives) => each!(|a, b| a.zero_where(b, derivatives)),
                Kind::MultiplyAdd => each!(|a, b, c| a * b + c),
                Kind::MultiplySubtract => each!(|a, b, c| a * b - c),
                Kind::SubtractProduct => each!(|a, b, c| c - a * b),
                Kind::MultiplyTwice => each!(|a, b, c| a * b * c),
            }
        }
    }
}

/// The results of a function.
#[derive(Clone, Copy)]
pub(crate) struct Results<'a, T> {
    lines: &'a Lines,
    registers: &'a [T],
}

impl<'a, T: Real> Results<'a, T> {
    #[inline(always)]
    fn entries(self, quantity: usize) -> &'a [Entry] {
        self.lines.results.get(quantity).map_or(&[], |of| of)
    }

    /// A quantity that is one number.
    #[inline(always)]
    pub(crate) fn number(self, quantity: usize) -> T {
        match self.entries(quantity) {
            [entry, ..] => entry.value(self.registers),
            [] => T::zero(),
        }
    }

    /// A quantity of N numbers.
    #[inline(always)]
    pub(crate) fn vector<const N: usize>(self, quantity: usize) -> SVector<T, N> {
        let mut vector = SVector::zeros();
        self.each(quantity, |_, column, value| vector[column] = value);
        vector
    }

    /// Row, column and value of each entry of a quantity that is not the constant 0.
    #[inline(always)]
    pub(crate) fn each(self, quantity: usize, mut put: impl FnMut(usize, usize, T)) {
        for entry in self.entries(quantity) {
            put(entry.row.into(), entry.column.into(), entry.value(self.registers));
        }
    }
}

/// A derivative of a table: one copy for each type of numbers.
#[inline(never)]
fn table<T: Real>(of: &AnyTable, orders: [u8; 2], registers: &[T], [a, b]: [usize; 2]) -> T {
    let values = &registers[b..b + of.parameters()];
    of.derivative(orders.map(usize::from), [registers[a], registers[b]], values)
}

/// A function by the library: one copy for each type of numbers.
#[inline(never)]
fn call<T: Real>(of: Elementary, a: &T, b: &T) -> T {
    match of {
        Elementary::Exp => a.exp(),
        Elementary::Ln => a.ln(),
        Elementary::Sin => a.sin(),
        Elementary::Cos => a.cos(),
        Elementary::Tan => a.tan(),
        Elementary::Asin => a.asin(),
        Elementary::Acos => a.acos(),
        Elementary::Atan => a.atan(),
        Elementary::Atan2 => a.atan2(*b),
        Elementary::Sinh => a.sinh(),
        Elementary::Cosh => a.cosh(),
        Elementary::Tanh => a.tanh(),
        Elementary::Abs => a.abs(),
        Elementary::Sign => a.sign(),
        Elementary::Hypot => a.hypot(*b),
        Elementary::Pow => a.pow(*b),
    }
}
