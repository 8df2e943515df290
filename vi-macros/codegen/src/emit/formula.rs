//! Operations as formulas.
//!
//! In: an operation and its printed operands. Out: tokens with the parentheses that precedence requires.

use crate::model::Parameter;
use crate::program::{Operation, OperationId};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use vi_expr::Opaque;

/// Maximum number of operations in one line.
pub(super) const LINE: usize = 10;

/// Binding strength of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Negative,
    Atom,
}

/// A printed formula.
#[derive(Clone, Debug)]
pub(super) struct Formula {
    tokens: TokenStream,
    binding: Binding,
    /// Operations written in it.
    pub(super) operations: usize,
}

impl Formula {
    /// A name.
    pub(super) fn name(ident: &Ident) -> Self {
        Self::atom(quote!(#ident), 0)
    }

    /// A parameter of the system.
    pub(super) fn parameter(system: &Ident, parameter: &Parameter) -> Self {
        let place = parameter.place();
        Self::atom(quote!(#system.#place), 0)
    }

    /// A formula that binds as tightly as a name.
    pub(super) fn atom(tokens: TokenStream, operations: usize) -> Self {
        Self { tokens, binding: Binding::Atom, operations }
    }

    fn constant(value: f64) -> Self {
        let value = number(value);
        Self::atom(quote!(real(#value)), 0)
    }

    /// The formula as the right side of a statement.
    pub(super) fn tokens(&self) -> &TokenStream {
        &self.tokens
    }

    /// The formula as the receiver of a method.
    pub(super) fn receiver(&self) -> TokenStream {
        self.within(Binding::Atom)
    }

    /// The formula as an operand, in parentheses if it binds less tightly.
    fn within(&self, binding: Binding) -> TokenStream {
        let tokens = &self.tokens;
        if self.binding >= binding { quote!(#tokens) } else { quote!((#tokens)) }
    }

    /// An operation on formulas.
    pub(super) fn of(operation: &Operation, operand: &mut dyn FnMut(OperationId) -> Self) -> Self {
        use Binding::{Atom, Negative, Product, Sum};
        let mut binary = |a: OperationId, b: OperationId, left: Binding, right: Binding, symbol: TokenStream| {
            let (a, b) = (operand(a), operand(b));
            let (left_tokens, right_tokens) = (a.within(left), b.within(right));
            let tokens = quote!(#left_tokens #symbol #right_tokens);
            Self { tokens, binding: left, operations: a.operations + b.operations + 1 }
        };
        match operation {
            Operation::Constant(bits) => Self::constant(f64::from_bits(*bits)),
            Operation::Add(a, b) => binary(*a, *b, Sum, Product, quote!(+)),
            Operation::Subtract(a, b) => binary(*a, *b, Sum, Product, quote!(-)),
            Operation::Multiply(a, b) => binary(*a, *b, Product, Negative, quote!(*)),
            Operation::Divide(a, b) => binary(*a, *b, Product, Negative, quote!(/)),
            Operation::Negate(a) => {
                let a = operand(*a);
                let inner = a.within(Atom);
                Self { tokens: quote!(-#inner), binding: Negative, operations: a.operations + 1 }
            }
            Operation::SquareRoot(a) => Self::method(&operand(*a), "sqrt", &[]),
            Operation::Reciprocal(a) => Self::method(&operand(*a), "recip", &[]),
            // The methods of `Real` have the names of the functions of the language.
            Operation::Call(function, a) => Self::method(&operand(*a), function.name(), &[]),
            Operation::Call2(function, a, b) => {
                let (a, b) = (operand(*a), operand(*b));
                Self::method(&a, function.name(), &[b])
            }
            Operation::Opaque(function, arguments) => {
                let arguments: Vec<Self> = arguments.iter().map(|argument| operand(*argument)).collect();
                derivative(function, &arguments)
            }
            Operation::Select(a, b, c) => {
                let (a, b, c) = (operand(*a), operand(*b), operand(*c));
                Self::method(&a, "if_positive", &[b, c])
            }
            Operation::ZeroWhere(a, b, derivatives) => {
                let derivatives = Literal::u8_unsuffixed(*derivatives);
                let (a, b) = (operand(*a), operand(*b));
                Self::method(&a, "zero_where", &[b, Self::atom(quote!(#derivatives), 0)])
            }
            // The caller names inputs.
            Operation::Input(_) => Self::constant(f64::NAN),
        }
    }

    fn method(on: &Self, name: &str, arguments: &[Self]) -> Self {
        let (receiver, name) = (on.within(Binding::Atom), format_ident!("{name}"));
        let tokens = arguments.iter().map(Self::tokens);
        let operations = on.operations + arguments.iter().map(|argument| argument.operations).sum::<usize>() + 1;
        Self::atom(quote!(#receiver.#name(#(#tokens),*)), operations)
    }
}

impl Parameter {
    /// Its field in the struct: `k`, or `m[3]`.
    pub(super) fn place(&self) -> TokenStream {
        let name = &self.name;
        let indices = self.indices.iter().copied().map(Literal::usize_unsuffixed);
        quote!(#name #([#indices])*)
    }
}

/// A literal that parses to the same number.
pub(super) fn number(value: f64) -> TokenStream {
    let magnitude = Literal::f64_unsuffixed(value.abs());
    match (value.is_nan(), value.is_infinite(), value.is_sign_negative()) {
        (true, ..) => quote!(f64::NAN),
        (_, true, false) => quote!(f64::INFINITY),
        (_, true, true) => quote!(f64::NEG_INFINITY),
        (_, _, true) => quote!(-#magnitude),
        _ => quote!(#magnitude),
    }
}

/// `[3]`, or in a loop `[i + 3]`.
pub(super) fn index(counter: Option<&Ident>, place: usize) -> TokenStream {
    let number = (place > 0 || counter.is_none()).then(|| Literal::usize_unsuffixed(place));
    let plus = (counter.is_some() && number.is_some()).then(|| quote!(+));
    quote!([#counter #plus #number])
}

/// The number zero.
pub(super) fn zero() -> TokenStream {
    quote!(T::real(0.0))
}

/// A call with derivatives up to an order; further arguments are the values of a table of parameters.
pub(super) fn jet(function: &Opaque, order: usize, arguments: &[Formula]) -> TokenStream {
    let (own, values) = arguments.split_at(function.arity);
    let (name, jet) = (item_name(&function.name), format_ident!("jet_{order}"));
    let own = own.iter().map(Formula::tokens);
    let of = if values.is_empty() {
        quote!(#name)
    } else {
        let values = values.iter().map(Formula::tokens);
        quote!(#name.of(&[#(#values),*]))
    };
    quote!(::vi_core::function::Jets::#jet(&#of, [#(#own),*]))
}

/// One derivative as an expression: `jet_1(…).1[0]`.
fn derivative(function: &Opaque, arguments: &[Formula]) -> Formula {
    let order = function.order();
    let call = jet(function, order, arguments);
    let operations = 1 + arguments.iter().map(|argument| argument.operations).sum::<usize>();
    if order == 0 {
        return Formula::atom(call, operations);
    }
    let part = Literal::usize_unsuffixed(order);
    let indices = slots(function).into_iter().map(Literal::usize_unsuffixed);
    Formula::atom(quote!(#call.#part #([#indices])*), operations)
}

/// The arguments of differentiation in ascending order: 0, 0, 1 for a mixed third derivative.
pub(super) fn slots(function: &Opaque) -> Vec<usize> {
    let each = function.orders.iter().enumerate();
    each.flat_map(|(slot, order)| core::iter::repeat_n(slot, usize::from(*order))).collect()
}

/// The item of a function.
pub(super) fn item_name(name: &str) -> Ident {
    format_ident!("{name}_function")
}
