//! The items of a large system: its primitives in loops, and the traits that `vi_core::indexed` computes from them.
//!
//! In: an [`Indexed`] system. Out: tokens. Each body is a function of the numbers that it reads, with its derivatives:
//!
//! ```text
//! fn lagrangian_1(&self, t: T, a: [T; 3]) -> [T; 4]              value, ∂/∂t, slopes with respect to a[0], a[1], …
//! fn lagrangian_1_curvatures(&self, t: T, a: [T; 3]) -> [T; 5]   slopes, second derivatives
//! ```
//!
//! L_q and L_v follow by one reverse sweep: recursions forward, terms of L, recursions backward. Second derivatives carry
//! a tangent of every coordinate along: rows of N numbers, contiguous, for each entry of a recursion.

mod constraints;
mod first;
mod scale;
mod second;
mod traits;

use super::body::{VelocityFrom, body};
use super::{check, conditions, functions, scope, structure};
use crate::Loops;
use crate::indexed::{
    Affine, Body, Indexed, Nest, Part, Read, Recursion, Sum, Value, documentation, named, needed, of_steps, part_name,
    sum_name,
};
use crate::model::Model;
use crate::program::{Function, Output};
use crate::symbol::Symbol;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeSet;
use vi_expr::Pool;

/// The items of a large system.
#[must_use]
pub fn items(loops: &Loops) -> TokenStream {
    let Loops { pool, indexed: of } = loops;
    let model = &of.model;
    let found = structure::found(model, documentation(of));
    let further = of.rules.iter().skip(1).map(|rule| structure::further(rule, of_steps(of, rule)));
    let structure = structure::declaration(model, &quote!(#found #(#further)*));
    let printer = Printer { of, model };
    let (functions, parameters) = (functions::items(model), structure::parameters(model));
    let (bodies, lagrangian, primitives) = (printer.bodies(pool), printer.lagrangian(), printer.primitives());
    let (constraints, diagonal, system) = (printer.constraints(), printer.diagonal(), printer.system());
    let batch = (!of.rules.is_empty()).then(|| structure::batch(model));
    let implementations = quote! {
        #functions #parameters #bodies #lagrangian #primitives #constraints #diagonal #system #batch
    };
    let conditions: Vec<_> = conditions(&model.attributes).collect();
    let scope = scope::scope(&conditions, &implementations);
    let tests = check::tests_of_loops(of, &conditions);
    quote!(#structure #scope #tests)
}

struct Printer<'a> {
    of: &'a Indexed,
    model: &'a Model,
}

/// A statement of a loop: its body, its name, and the index of a column.
struct Printed<'a> {
    body: &'a Body,
    name: Ident,
    /// The first column of what it reads.
    first: usize,
    place: Columns<'a>,
}

impl Printed<'_> {
    /// The place of a number that it reads in its array.
    fn at(&self, read: usize) -> TokenStream {
        (self.place)(self.first + read)
    }

    /// The numbers of the state that a value reads: the place in the list of these, the array, and the place there.
    fn states<'b>(&'b self, value: &'b Value) -> impl Iterator<Item = (usize, Read, TokenStream)> {
        value.states.iter().enumerate().map(|(place, read)| (place, self.body.reads[*read], self.at(*read)))
    }
}

/// The place of a column of a loop, as an index.
type Columns<'a> = &'a dyn Fn(usize) -> TokenStream;

/// A value that a recursion defines.
struct Defined<'a> {
    value: &'a Value,
    of: Read,
    array: Ident,
    entry: TokenStream,
}

/// To what a derivative with respect to a number of the state is added.
enum Target {
    /// A coordinate or a velocity: the number of the weight.
    Own(usize),
    /// An entry of this array.
    Entry(Ident),
}

impl Printer<'_> {
    fn dimension(&self) -> Literal {
        Literal::usize_unsuffixed(self.model.dimension())
    }

    /// The variable with the entries of an array of `let`s, or with their rates.
    fn array(&self, read: Read) -> Ident {
        match read {
            Read::Let(array) => format_ident!("let_{}", self.model.lets[array].name),
            Read::LetRate(array) => format_ident!("rate_{}", self.model.lets[array].name),
            Read::Coordinate => format_ident!("q"),
            Read::Velocity => format_ident!("v"),
            Read::Number | Read::Constraint => format_ident!("number"),
            Read::Part => format_ident!("parts"),
            Read::Parameter(first) => self.model.parameters[first].name.clone(),
        }
    }

    fn target(&self, read: Read) -> Target {
        match read {
            Read::Coordinate => Target::Own(0),
            Read::Velocity => Target::Own(1),
            _ => Target::Entry(self.array(read)),
        }
    }

    /// The numbers that a body reads.
    fn numbers(&self, of: &Printed) -> TokenStream {
        let numbers = of.body.reads.iter().enumerate().map(|(place, read)| {
            let (array, index) = (self.array(*read), of.at(place));
            if *read == Read::Number {
                return quote!(real((#index) as f64));
            }
            let owner = matches!(read, Read::Parameter(_)).then(|| quote!(self.));
            quote!(#owner #array[#index])
        });
        quote!([#(#numbers),*])
    }

    /// The functions of all bodies.
    fn bodies(&self, pool: &Pool<Symbol>) -> TokenStream {
        let bodies = named(self.of);
        let functions = bodies.iter().map(|of| {
            let row = of.first_row(pool, self.model);
            self.body(&format_ident!("{}", of.name), of.body, &row)
        });
        let name = &self.model.name;
        quote!(impl<T: ::vi_core::real::Real> #name<T> { #(#functions)* })
    }

    /// The functions of a body, which computes `row` in the first row of its loop.
    fn body(&self, name: &Ident, of: &Body, row: &str) -> TokenStream {
        let slopes = format!(" `{row}`, with first derivatives. {} operations.", of.slopes.operation_count());
        let slopes = Self::function(name, (of, &of.slopes), &slopes, self.model);
        let curvatures = of.curvatures.as_ref().map(|curvatures| {
            let count = curvatures.operation_count();
            let documentation = format!(" First and second derivatives of `{name}`. {count} operations.");
            Self::function(&format_ident!("{name}_curvatures"), (of, curvatures), &documentation, self.model)
        });
        quote!(#slopes #curvatures)
    }

    fn function(name: &Ident, (of, function): (&Body, &Function), documentation: &str, model: &Model) -> TokenStream {
        let printed = body(model, function, 1, VelocityFrom::Argument, usize::MAX);
        let results = printed.results.vector(Output::Value);
        let (reads, length) = (Literal::usize_unsuffixed(of.reads.len()), Literal::usize_unsuffixed(results.len()));
        let inputs = (0..of.reads.len())
            .map(|place| printed.inputs.get(&Symbol::Access(place)).map_or_else(|| quote!(_), |name| quote!(#name)));
        let statements = &printed.statements;
        quote! {
            #[doc = #documentation]
            #[inline(always)]
            fn #name(&self, t: T, [#(#inputs),*]: [T; #reads]) -> [T; #length] {
                #statements
                [#(#results),*]
            }
        }
    }

    /// A loop over the instances of a nest; `backward` for the last one first.
    fn looped(nest: &Nest, backward: bool, print: &dyn Fn(Columns) -> TokenStream) -> TokenStream {
        match nest {
            Nest::Loops { outer, inner, columns } => {
                let [i, j] = [quote!(i), quote!(j)];
                let counters = [(*outer > 1).then_some(&i), Some(&j)];
                let inside = print(&|column| affine(columns[column], counters));
                let is_single = *inner == Affine { constant: 1, by: [0, 0] };
                let inside = if is_single {
                    inside
                } else {
                    let end = affine(*inner, counters);
                    quote!(for j in 0..#end { #inside })
                };
                if *outer == 1 {
                    return quote!({ #inside });
                }
                let end = Literal::i64_unsuffixed(*outer);
                let range = if backward { quote!((0..#end).rev()) } else { quote!(0..#end) };
                quote!(for i in #range { #inside })
            }
            Nest::Table(rows) => {
                let (length, width) = (Literal::usize_unsuffixed(rows.len()), Literal::usize_unsuffixed(rows[0].len()));
                let rows = rows.iter().map(|row| {
                    let row = row.iter().copied().map(Literal::usize_unsuffixed);
                    quote!([#(#row),*])
                });
                let inside = print(&|column| {
                    let column = Literal::usize_unsuffixed(column);
                    quote!(row[#column])
                });
                quote! {
                    {
                        const ROWS: [[usize; #width]; #length] = [#(#rows),*];
                        for row in &ROWS { #inside }
                    }
                }
            }
        }
    }

    /// Loops over all terms of these sums.
    fn over_sums(name: &str, sums: &[Sum], first: usize, print: &dyn Fn(&Printed) -> TokenStream) -> TokenStream {
        let mut loops = TokenStream::new();
        for (index, Sum { body, nests }) in sums.iter().enumerate() {
            let name = format_ident!("{}", sum_name(name, index));
            for nest in nests {
                loops.extend(Self::looped(nest, false, &|place| {
                    print(&Printed { body, name: name.clone(), first, place })
                }));
            }
        }
        loops
    }

    /// Adds the values of these sums to the entries of a vector.
    fn summed(&self, name: &str, sums: &[Sum], to: &Ident) -> TokenStream {
        Self::over_sums(name, sums, 1, &|of| {
            let (name, numbers, on) = (&of.name, self.numbers(of), (of.place)(0));
            quote!(#to[#on] += self.#name(t, #numbers)[0];)
        })
    }

    /// Loops over all recursions.
    fn over_recursions(&self, backward: bool, print: &dyn Fn(&Printed, &[Defined]) -> TokenStream) -> TokenStream {
        let mut places: Vec<usize> = (0..self.of.recursions.len()).collect();
        if backward {
            places.reverse();
        }
        let loops = places.into_iter().map(|at| {
            let Recursion { parts, nest } = &self.of.recursions[at];
            Self::looped(nest, backward, &|place| {
                let mut order: Vec<usize> = (0..parts.len()).collect();
                if backward {
                    order.reverse();
                }
                let printed = order.into_iter().map(|index| {
                    let Part { body, of, first } = &parts[index];
                    let name = format_ident!("{}", part_name(parts, at, index));
                    let printed = Printed { body, name, first: first + of.len(), place };
                    let defined = body.values.iter().zip(of).enumerate();
                    let defined: Vec<Defined> = defined
                        .map(|(number, (value, of))| Defined {
                            value,
                            of: *of,
                            array: self.array(*of),
                            entry: place(first + number),
                        })
                        .collect();
                    print(&printed, &defined)
                });
                printed.collect()
            })
        });
        loops.collect()
    }

    /// Zeros for each array of `let`s, under a name with this prefix.
    fn zeros(&self, prefix: &str, zero: &TokenStream) -> TokenStream {
        let parts = self.of.recursions.iter().flat_map(|recursion| &recursion.parts);
        self.zeros_of(prefix, zero, &parts.flat_map(|part| part.of.iter().copied()).collect())
    }

    /// The same for these arrays.
    fn zeros_of(&self, prefix: &str, zero: &TokenStream, arrays: &Arrays) -> TokenStream {
        let zeros = arrays.iter().map(|read| {
            let (Read::Let(array) | Read::LetRate(array)) = *read else { return TokenStream::new() };
            let length = Literal::usize_unsuffixed(self.model.lets[array].definitions.len());
            let name = format_ident!("{prefix}{}", self.array(*read));
            quote!(let mut #name = [#zero; #length];)
        });
        zeros.collect()
    }

    /// The arrays on which these sums depend.
    fn arrays(&self, sums: &[&[Sum]]) -> Arrays {
        needed(&self.of.recursions, sums)
    }

    /// Whether the entries of an array depend on positions and time alone.
    fn is_of_position(&self, array: Read) -> bool {
        let parts = self.of.recursions.iter().flat_map(|recursion| &recursion.parts);
        let values =
            parts.flat_map(|part| part.body.values.iter().zip(&part.of).map(move |(value, of)| (part, value, of)));
        let mut own = values.filter(|(_, _, of)| **of == array);
        matches!(array, Read::Let(_))
            && own.all(|(part, value, _)| {
                value.states.iter().map(|place| part.body.reads[*place]).all(|read| {
                    read == Read::Coordinate || read == array || read.is_entry() && self.is_of_position(read)
                })
            })
    }

    /// The entries of the arrays of `let`s.
    fn entries(&self) -> TokenStream {
        let zeros = self.zeros("", &quote!(real(0.0)));
        let loops = self.over_recursions(false, &|of, defined| {
            let (name, numbers) = (&of.name, self.numbers(of));
            let entries = defined.iter().map(|Defined { value, array, entry, .. }| {
                let place = Literal::usize_unsuffixed(value.first_slope);
                quote!(#array[#entry] = slopes[#place];)
            });
            quote! {
                let slopes = self.#name(t, #numbers);
                #(#entries)*
            }
        });
        quote!(#zeros #loops)
    }

    fn primitives(&self) -> TokenStream {
        let (name, dimension, dual) = (&self.model.name, self.dimension(), structure::dual(self.model));
        let first = self.first_derivatives();
        let (second, force) = (self.second_derivatives(), self.add_force_derivatives());
        let (lost, scale) = (self.dissipation_curvatures(), self.time_scale());
        quote! {
            #lost

            impl<T: ::vi_core::real::Real> ::vi_core::indexed::Indexed<#dimension, T> for #name<T> {
                type Dual = #name<::vi_core::real::Dual<T>>;

                fn dual(&self) -> Self::Dual {
                    #dual
                }

                #first
                #second
                #force
                #scale
            }
        }
    }
}

/// Names of the changes of a coordinate and of a velocity.
const SEEDS: [&str; 2] = ["r_q", "r_v"];
/// Names of the weights of the derivatives with respect to them.
const WEIGHTS: [&str; 2] = ["c_q", "c_v"];
/// Name of the weight of a second derivative with respect to two coordinates.
const BOTH: &str = "c_qq";

/// The arrays of entries on which sums depend.
type Arrays = BTreeSet<Read>;

/// Whether one of these sums reads entries of recursions.
fn reads_entries(sums: &[Sum]) -> bool {
    sums.iter().any(|sum| sum.body.reads_entries())
}

/// The derivative with respect to a number of the state, among the slopes.
fn slope(value: &Value, place: usize) -> TokenStream {
    let place = Literal::usize_unsuffixed(value.first_slope + 2 + place);
    quote!(slopes[#place])
}

/// The same among the curvatures.
fn curvature(value: &Value, place: usize) -> TokenStream {
    let place = Literal::usize_unsuffixed(value.first_curvature + place);
    quote!(curvatures[#place])
}

/// Adds the row `from` times the slope to another row.
fn add_row(value: &Value, place: usize, slope: &TokenStream, to: &TokenStream) -> TokenStream {
    if value.units[place] {
        quote!(::vi_core::indexed::add_row(&mut #to, &from);)
    } else {
        quote!(::vi_core::indexed::add(#slope, &mut #to, &from);)
    }
}

fn name(of: &str) -> Ident {
    format_ident!("{of}")
}

/// A number that changes with the counters, as an index.
fn affine(of: Affine, counters: [Option<&TokenStream>; 2]) -> TokenStream {
    let (mut plus, mut minus) = (Vec::new(), Vec::new());
    for (by, counter) in of.by.into_iter().zip(counters) {
        let Some(counter) = counter.filter(|_| by != 0) else { continue };
        let factor = Literal::i64_unsuffixed(by.abs());
        let term = if by.abs() == 1 { quote!(#counter) } else { quote!(#factor * #counter) };
        if by > 0 { plus.push(term) } else { minus.push(term) }
    }
    if of.constant > 0 || plus.is_empty() {
        let constant = Literal::i64_unsuffixed(of.constant);
        plus.push(quote!(#constant));
    }
    if of.constant < 0 && !plus.is_empty() {
        let constant = Literal::i64_unsuffixed(of.constant.abs());
        minus.push(quote!(#constant));
    }
    quote!(#(#plus)+* #(- #minus)*)
}
