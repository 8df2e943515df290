//! The clauses `fn` and `table`.
//!
//! ```text
//! fn spring(k, x) = k * x^2 / 2;                     a function of the language
//! fn cl(a) = crate::aero::cl;                        a Rust function, generic over `Number`
//! table drag(v) = "drag.csv" hold;                   columns of a file
//! table lift(a) = [(0, 0.1), (1, 0.3), (2, 0.2)];    points
//! table lift(a in -0.3..0.5) = c;                    values at equal distances, here parameters
//! ```

use super::expression::Expression;
use super::tokens::{check_rust, name};
use super::{INSIDE_LIST, unexpected};
use crate::messages::{FunctionMistake, Message, error};
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use syn::parse::ParseStream;
use syn::{LitStr, Path, Result, Token};

/// A function with its arguments.
pub struct Function {
    /// Its name.
    pub name: Ident,
    /// The names of its arguments.
    pub arguments: Vec<Ident>,
    /// What computes it.
    pub body: Body,
}

/// What computes a function.
pub enum Body {
    /// An expression of its arguments.
    Expression(Expression),
    /// A Rust function.
    Path(Path),
}

/// A table with its arguments.
pub struct Table {
    /// Its name.
    pub name: Ident,
    /// Its arguments, one or two.
    pub arguments: Vec<TableArgument>,
    /// Its values.
    pub data: TableData,
    /// The words after the values: the kind of interpolation, and what holds outside.
    pub words: Vec<Ident>,
}

/// An argument of a table.
pub struct TableArgument {
    /// Its name.
    pub name: Ident,
    /// The first and the last place, for values at equal distances.
    pub range: Option<(Expression, Expression)>,
}

/// The values of a table.
pub enum TableData {
    /// A file of comma-separated values; its path is relative to the manifest of the crate.
    File(LitStr),
    /// `[(0, 0.1), (1, 0.3)]`: places with values.
    Points(Vec<Vec<Expression>>),
    /// `[1, 2, 3]` or `[[1, 2], [3, 4]]`: values at equal distances, row by row.
    Rows(Vec<Vec<Expression>>),
    /// The name of an array of parameters: values at equal distances.
    Parameters(Ident),
}

/// `spring(k, x) = k * x^2 / 2` or `cl(a) = crate::aero::cl`
pub(super) fn function(input: ParseStream) -> Result<Function> {
    let name = name(input)?;
    let inner = arguments(input, &name)?;
    let mut arguments = Vec::new();
    while !inner.is_empty() {
        arguments.push(self::name(&inner)?);
        if inner.peek(Token![:]) {
            return Err(typed(&name, &arguments, inner.span()));
        }
        comma(&inner)?;
    }
    if input.peek(Token![->]) || input.peek(syn::token::Brace) {
        return Err(typed(&name, &arguments, input.span()));
    }
    if arguments.is_empty() {
        return Err(error(name.span(), &Message::Function(FunctionMistake::Arguments { name: name.to_string() })));
    }
    equals(input, &name)?;
    let is_path = input.peek(Token![::]) || input.peek(syn::Ident) && input.peek2(Token![::]) || is_crate(input);
    let body = if is_path {
        check_rust(until_semicolon(input))?;
        Body::Path(input.parse()?)
    } else {
        Body::Expression(Expression::parse(input)?)
    };
    Ok(Function { name, arguments, body })
}

/// The error for types or braces at this place.
fn typed(name: &Ident, arguments: &[Ident], span: Span) -> syn::Error {
    let (name, arguments) = (name.to_string(), arguments.iter().map(Ident::to_string).collect());
    error(span, &Message::Function(FunctionMistake::Typed { name, arguments }))
}

/// `drag(v) = "drag.csv" hold`
pub(super) fn table(input: ParseStream) -> Result<Table> {
    let name = name(input)?;
    let inner = arguments(input, &name)?;
    let mut arguments = Vec::new();
    while !inner.is_empty() {
        arguments.push(table_argument(&inner)?);
        comma(&inner)?;
    }
    equals(input, &name)?;
    let data = if input.peek(LitStr) {
        TableData::File(input.parse()?)
    } else if input.peek(syn::token::Bracket) {
        rows(input)?
    } else if input.peek(syn::Ident) {
        TableData::Parameters(self::name(input)?)
    } else {
        return Err(error(input.span(), &Message::Function(FunctionMistake::Data)));
    };
    let mut words = Vec::new();
    while input.peek(syn::Ident) {
        words.push(self::name(input)?);
    }
    Ok(Table { name, arguments, data, words })
}

/// The tokens up to the end of the clause.
fn until_semicolon(input: ParseStream) -> TokenStream {
    let mut here = input.cursor();
    let rest = core::iter::from_fn(|| {
        let (token, behind) = here.token_tree()?;
        here = behind;
        Some(token)
    });
    rest.take_while(|token| !matches!(token, TokenTree::Punct(mark) if mark.as_char() == ';')).collect()
}

/// Whether the path starts with `crate`, `self` or `super`.
fn is_crate(input: ParseStream) -> bool {
    (input.peek(Token![crate]) || input.peek(Token![self]) || input.peek(Token![super])) && input.peek2(Token![::])
}

/// The tokens between the parentheses after a name.
fn arguments<'a>(input: ParseStream<'a>, name: &Ident) -> Result<syn::parse::ParseBuffer<'a>> {
    if !input.peek(syn::token::Paren) {
        return Err(error(name.span(), &Message::Function(FunctionMistake::Arguments { name: name.to_string() })));
    }
    let inner;
    syn::parenthesized!(inner in input);
    Ok(inner)
}

/// A comma, unless nothing follows.
fn comma(inner: ParseStream) -> Result<()> {
    if inner.is_empty() {
        return Ok(());
    }
    if !inner.peek(Token![,]) {
        return Err(error(inner.span(), &Message::Expected { what: "`,` or `)`" }));
    }
    inner.parse::<Token![,]>().map(|_| ())
}

fn equals(input: ParseStream, name: &Ident) -> Result<()> {
    if !input.peek(Token![=]) {
        return Err(unexpected::equals(input, name, None));
    }
    input.parse::<Token![=]>().map(|_| ())
}

/// `v` or `a in -0.3..0.5`
fn table_argument(inner: ParseStream) -> Result<TableArgument> {
    if inner.peek(syn::Ident) && inner.peek2(Token![in]) {
        let range = Expression::range(inner, 0)?;
        return Ok(TableArgument { name: range.index, range: Some((range.from, range.to)) });
    }
    Ok(TableArgument { name: name(inner)?, range: None })
}

/// `[(0, 0.1), (1, 0.3)]`, `[1, 2, 3]` or `[[1, 2], [3, 4]]`
fn rows(input: ParseStream) -> Result<TableData> {
    let inner;
    syn::bracketed!(inner in input);
    let (mut points, mut rows, mut only) = (Vec::new(), Vec::new(), Vec::new());
    while !inner.is_empty() {
        if inner.peek(syn::token::Paren) {
            let point;
            syn::parenthesized!(point in inner);
            points.push(Expression::list(&point, 1, "an operator, `,` or `)`")?);
        } else if inner.peek(syn::token::Bracket) {
            let row;
            syn::bracketed!(row in inner);
            rows.push(Expression::list(&row, 1, INSIDE_LIST)?);
        } else {
            only.push(Expression::parse(&inner)?);
        }
        let kinds = [!points.is_empty(), !rows.is_empty(), !only.is_empty()];
        if kinds.into_iter().filter(|is_there| *is_there).count() > 1 || !inner.is_empty() && !inner.peek(Token![,]) {
            return Err(error(inner.span(), &Message::Function(FunctionMistake::Data)));
        }
        comma(&inner)?;
    }
    Ok(if !points.is_empty() {
        TableData::Points(points)
    } else if rows.is_empty() {
        TableData::Rows(vec![only])
    } else {
        TableData::Rows(rows)
    })
}
