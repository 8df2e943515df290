//! Clauses.
//!
//! In: the tokens of a `lagrangian!`. Out: a [`System`]. An unreadable clause is reported and skipped up to its `;`, or
//! up to the next clause if the `;` is missing, so that later clauses are read too.

use super::function;
use super::tokens::{DEPTH, check_rust, has_bracket, name};
use super::unexpected;
use super::{
    Check, CheckEntry, Constant, Coordinate, Defining, Definition, Discretization, Expression, INSIDE_BRACKETS,
    Indices, Kind, Momentum, Parameter, Rule, Space, System, clause_of,
};
use crate::clause;
use crate::messages::{ConstraintMistake, Errors, Habit, Message, bounded, error, nearest, words};
use num_traits::Zero;
use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::rc::Rc;
use syn::buffer::Cursor;
use syn::ext::IdentExt;
use syn::parse::{ParseStream, Parser};
use syn::punctuated::Punctuated;
use syn::{Attribute, Error, Path, Result, Token, Visibility};
use vi_expr::Rational;

/// Types that the emitted code uses without a path.
const TYPES: [&str; 6] = ["T", "W", "bool", "f64", "str", "usize"];

/// The traits that every system derives or implements.
const DERIVED: [&str; 5] = ["Clone", "Copy", "Debug", "Default", "PartialEq"];

/// Maximum number of tokens of a system.
const TOKENS: usize = 200_000;

/// Maximum number of letters of a name.
const LETTERS: usize = 200;

/// Delimiter pairs around an expression: of the system, of a rule, of an index.
const CLAUSE_DEPTH: usize = 3;

/// Parses a system.
///
/// # Errors
/// Every unreadable clause, at the unexpected token.
pub fn system(tokens: TokenStream) -> Result<System> {
    read(tokens, &mut None).map_err(bounded)
}

/// The readable part of a system with errors: its head and the correct clauses.
#[must_use]
pub fn outline(tokens: TokenStream) -> Option<System> {
    let mut outline = None;
    read(tokens, &mut outline).ok().or(outline)
}

/// Parses a system; after an error, `outline` contains the readable part.
fn read(tokens: TokenStream, outline: &mut Option<System>) -> Result<System> {
    let tokens = if check_size(&tokens)? { with_parentheses(tokens, false) } else { tokens };
    let whole = |input: ParseStream| {
        let (system, errors) = header(input)?;
        match errors.finish(()) {
            Ok(()) => Ok(system),
            Err(error) => {
                *outline = Some(system);
                Err(error)
            }
        }
    };
    whole.parse2(tokens)
}

/// Rejects too many tokens, names of too many letters, and delimiters nested deeper than any valid system has,
/// attributes included, because parsing them recurses. Returns whether some delimiters are invisible.
fn check_size(tokens: &TokenStream) -> Result<bool> {
    let mut open = vec![tokens.clone().into_iter()];
    let (mut count, mut invisible) = (0, false);
    while let Some(innermost) = open.last_mut() {
        let Some(token) = innermost.next() else {
            drop(open.pop());
            continue;
        };
        count += 1;
        if count > TOKENS {
            return Err(error(token.span(), &Message::TooLong { limit: TOKENS }));
        }
        if let TokenTree::Ident(name) = &token
            && name.to_string().chars().count() > LETTERS
        {
            return Err(error(name.span(), &Message::LongName { limit: LETTERS }));
        }
        if let TokenTree::Group(group) = token {
            if open.len() > DEPTH + CLAUSE_DEPTH {
                return Err(error(group.span_open(), &Message::TooDeep { limit: DEPTH }));
            }
            invisible |= group.delimiter() == Delimiter::None;
            open.push(group.stream().into_iter());
        }
    }
    Ok(invisible)
}

/// The attributes here.
fn attributes(input: ParseStream) -> Result<Vec<Attribute>> {
    let mut here = input.cursor();
    while let Some((_, behind)) = here.punct().filter(|(mark, _)| mark.as_char() == '#') {
        let Some((attribute, behind)) = behind.token_tree() else { break };
        check_rust(attribute.into())?;
        here = behind;
    }
    input.call(Attribute::parse_outer)
}

/// A macro wraps its `$a:expr` in invisible delimiters as one operand: inside clauses they become parentheses.
fn with_parentheses(tokens: TokenStream, inside: bool) -> TokenStream {
    let token = |token: TokenTree| {
        let TokenTree::Group(group) = token else { return token };
        let stream = with_parentheses(group.stream(), inside || group.delimiter() == Delimiter::Brace);
        let alone = stream.clone().into_iter().nth(1).is_none();
        let delimiter = match group.delimiter() {
            Delimiter::None if inside && !alone => Delimiter::Parenthesis,
            delimiter => delimiter,
        };
        let mut visible = Group::new(delimiter, stream);
        visible.set_span(group.span());
        TokenTree::Group(visible)
    };
    tokens.into_iter().map(token).collect()
}

/// Parses the lines of a rule given as text; the built-in rules use this.
///
/// # Errors
/// As for a user's rule.
pub fn rule(text: &str) -> Result<Rule> {
    rule_lines.parse_str(text)
}

/// `pub struct Name { … }`
fn header(input: ParseStream) -> Result<(System, Errors)> {
    if input.cursor().ident().is_some_and(|(word, _)| word == "lagrangian") && input.peek2(Token![!]) {
        return Err(error(input.span(), &Message::Wrapped));
    }
    let attributes = attributes(input)?;
    let visibility: Visibility = input.parse()?;
    if !input.peek(Token![struct]) {
        return Err(error(input.span(), &Message::NoStruct));
    }
    input.parse::<Token![struct]>()?;
    let name = name(input)?;
    if TYPES.contains(&name.to_string().as_str()) {
        return Err(error(name.span(), &Message::ReservedType { name: name.to_string() }));
    }
    if !input.peek(syn::token::Brace) {
        return Err(error(input.span(), &Message::Expected { what: "`{` and the clauses of the system" }));
    }
    let body;
    syn::braced!(body in input);
    let mut system = System {
        attributes,
        visibility,
        name,
        constants: Vec::new(),
        parameters: Vec::new(),
        coordinates: Vec::new(),
        momenta: Vec::new(),
        functions: Vec::new(),
        tables: Vec::new(),
        folder: std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default().into(),
        files: BTreeMap::new(),
        definitions: BTreeMap::new(),
        is_constrained: false,
        discretizations: Vec::new(),
        checks: Vec::new(),
    };
    let mut errors = Errors::default();
    if let Err(found) = check_derives(&system.attributes) {
        errors.add(found);
    }
    while !body.is_empty() {
        if let Err(found) = clause(&body, &mut system) {
            errors.add(found);
            if !unexpected::begins_clause(&body) {
                skip_clause(&body);
            }
        }
    }
    if !input.is_empty() {
        errors.at(input.span(), &Message::AfterSystem);
    }
    Ok((system, errors))
}

/// Rejects a derive of a trait that every system implements.
fn check_derives(attributes: &[Attribute]) -> Result<()> {
    let mut errors = Errors::default();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("derive")) {
        // rustc reports an invalid list of paths.
        let Ok(derived) = attribute.parse_args_with(Punctuated::<Path, Token![,]>::parse_terminated) else { continue };
        for name in derived.iter().filter_map(|path| path.segments.last()).map(|segment| &segment.ident) {
            if DERIVED.contains(&name.to_string().as_str()) {
                errors.at(name.span(), &Message::SecondDerive { name: name.to_string() });
            }
        }
    }
    errors.finish(())
}

/// Rejects attributes without effect. Those of a parameter move to its field; clauses cannot be conditional.
fn check_attributes(attributes: &[Attribute], word: &Ident) -> Result<()> {
    let fits = |attribute: &Attribute| {
        let named = |names: &[&str]| names.iter().any(|name| attribute.path().is_ident(name));
        named(&["doc"]) || (word == "param" || word == "input") && !named(&["cfg", "cfg_attr", "derive"])
    };
    match attributes.iter().find(|attribute| !fits(attribute)) {
        Some(attribute) => Err(error(attribute.pound_token.span, &Message::AttributeOfClause)),
        None => Ok(()),
    }
}

/// Skips the tokens up to the end of an unreadable clause.
fn skip_clause(body: ParseStream) {
    while let Ok(token) = body.parse::<TokenTree>() {
        if matches!(&token, TokenTree::Punct(punct) if punct.as_char() == ';') {
            break;
        }
    }
}

fn clause(input: ParseStream, system: &mut System) -> Result<()> {
    if input.peek(Token![#]) && !input.peek2(syn::token::Bracket) {
        return Err(error(input.span(), &Message::Habit(Habit::Comment)));
    }
    let attributes = attributes(input)?;
    let start = input.cursor();
    let Ok(word) = input.call(Ident::parse_any) else {
        return Err(error(input.span(), &Message::Expected { what: "a clause" }));
    };
    if clause::words().any(|first| word == first) {
        check_attributes(&attributes, &word)?;
    }
    match word.to_string().as_str() {
        "const" => list(input, &mut |input| constant(input, &attributes).map(|one| system.constants.push(one)))?,
        "param" | "input" => {
            let is_input = word == "input";
            list(input, &mut |input| parameter(input, is_input, &attributes, &mut system.parameters))?;
        }
        "coord" | "angle" | "rotation" => {
            system.is_constrained |= word == "rotation";
            list(input, &mut |input| coordinate(input, &word).map(|one| system.coordinates.push(one)))?;
            return end_of_names(input, start);
        }
        "momentum" => {
            list(input, &mut |input| momentum(input).map(|one| system.momenta.push(one)))?;
            return end_of_names(input, start);
        }
        "fn" => system.functions.push(Rc::new(function::function(input)?)),
        "table" => system.tables.push(function::table(input)?),
        "force" if input.peek(Token![=]) || input.peek(syn::token::Paren) => {
            return Err(error(input.span(), &Message::Habit(Habit::ForceWithoutCoordinate)));
        }
        "discretize" if input.peek(syn::token::Brace) => {
            let lines;
            syn::braced!(lines in input);
            system.discretizations.push(Discretization::Written(rule_lines(&lines)?));
            if input.peek(Token![,]) {
                return Err(error(input.span(), &Message::WrittenInList));
            }
            if input.peek(Token![;]) {
                input.parse::<Token![;]>()?;
            }
            return Ok(());
        }
        "discretize" => {
            let mut names = Vec::new();
            list(input, &mut |input| rule_name(input).map(|name| names.push(name)))?;
            system.discretizations.push(Discretization::Named(names));
            return end_of_names(input, start);
        }
        "check" => {
            system.checks.push(check(word.span(), input)?);
            if input.peek(Token![;]) {
                input.parse::<Token![;]>()?;
            }
            return Ok(());
        }
        found => {
            let Some(clause) = Defining::of(found) else { return Err(unknown(input, &word, system)) };
            system.is_constrained |= clause == Defining::Constraint;
            let made = system.definitions.entry(clause).or_default();
            let named = if clause == Defining::Constraint { constraint } else { indexed };
            if clause.has_names() {
                list(input, &mut |input| named(input, &attributes).map(|one| made.push(one)))?;
            } else {
                made.push(value_of(word, input, attributes)?);
            }
        }
    }
    semicolon(input, start)
}

/// The error for a word that starts no clause.
fn unknown(input: ParseStream, word: &Ident, system: &System) -> Error {
    let found = word.to_string();
    if found == "extern" {
        // Or its `fn` would start another clause.
        let _: Result<Option<Token![fn]>> = input.parse();
    }
    if let (true, Some(sign)) = (words::is_constraint(&found), inequality(input)) {
        return error(sign, &Message::Constraint(ConstraintMistake::Inequality));
    }
    let near = nearest(&found, clause::words());
    let is_coordinate = system.coordinates.iter().any(|coordinate| coordinate.name == *word);
    let is_defined = input.peek(Token![=]) || input.peek(syn::token::Bracket);
    error(word.span(), &Message::UnknownClause { found, near, is_defined, is_coordinate })
}

/// `midpoint`, in a list of rules
fn rule_name(input: ParseStream) -> Result<Ident> {
    if input.peek(syn::token::Brace) {
        return Err(error(input.span(), &Message::WrittenInList));
    }
    if input.peek(Token![=]) || input.peek(Token![:]) {
        return Err(error(input.span(), &Message::Habit(Habit::RuleWithSign)));
    }
    name(input)
}

/// The lines of a written-out rule.
fn rule_lines(input: ParseStream) -> Result<Rule> {
    let mut rule = Rule { span: input.span(), lines: Vec::new() };
    while !input.is_empty() {
        let start = input.cursor();
        rule.lines.push(definition(input, &[])?);
        semicolon(input, start)?;
    }
    Ok(rule)
}

/// `{ x = 1, dot(x) = 0; h = 0.01; }`
fn check(span: Span, input: ParseStream) -> Result<Check> {
    if !input.peek(syn::token::Brace) {
        return Err(error(input.span(), &Message::Expected { what: "`{` and a place, as in `{ x = 1; h = 0.01; }`" }));
    }
    let inner;
    syn::braced!(inner in input);
    let mut entries = Vec::new();
    while !inner.is_empty() {
        let start = inner.cursor();
        entries.push(entry(&inner)?);
        let comma: Option<Token![,]> = inner.parse()?;
        let semicolon: Option<Token![;]> = inner.parse()?;
        if comma.is_none() && semicolon.is_none() && !inner.is_empty() {
            return Err(unexpected::end_of_definition(&inner, start, "an operator, `,` or `;`"));
        }
        if comma.is_some() && inner.peek(syn::Lit) {
            return Err(error(inner.span(), &Message::Habit(Habit::DecimalComma)));
        }
    }
    Ok(Check { span, entries })
}

/// `x = 1`, `q[i in 0..8] = 1`, `dot(x) = 1` or `dot(q[0]) = 1`
fn entry(input: ParseStream) -> Result<CheckEntry> {
    let velocity = input.peek(syn::Ident) && input.peek2(syn::token::Paren);
    if !velocity {
        return Ok(CheckEntry { velocity, definition: indexed(input, &[])? });
    }
    let dot = name(input)?;
    if dot != "dot" {
        return Err(error(dot.span(), &Message::Expected { what: "a coordinate, `dot(…)`, a parameter, `t` or `h`" }));
    }
    let inner;
    syn::parenthesized!(inner in input);
    let (name, indices) = (name(&inner)?, indices(&inner)?);
    if !inner.is_empty() {
        return Err(error(inner.span(), &Message::Expected { what: "`)`" }));
    }
    Ok(CheckEntry { velocity, definition: Definition { indices, ..value_of(name, input, Vec::new())? } })
}

/// One or more items, separated by commas; a trailing comma is allowed.
fn list(input: ParseStream, one: &mut dyn FnMut(ParseStream) -> Result<()>) -> Result<()> {
    one(input)?;
    while input.peek(Token![,]) {
        input.parse::<Token![,]>()?;
        if input.peek(Token![;]) {
            break;
        }
        if input.peek(syn::Lit) {
            return Err(error(input.span(), &Message::Habit(Habit::DecimalComma)));
        }
        one(input)?;
    }
    Ok(())
}

/// `a = 1`
fn definition(input: ParseStream, attributes: &[Attribute]) -> Result<Definition> {
    value_of(name(input)?, input, attributes.to_vec())
}

/// `a = 1` or `a[3] = [1, 2, 3]`
fn constant(input: ParseStream, attributes: &[Attribute]) -> Result<Constant> {
    let (name, lengths) = (name(input)?, lengths(input)?);
    let Definition { attributes, name, value, .. } = value_of(name, input, attributes.to_vec())?;
    Ok(Constant { attributes, name, lengths, value })
}

/// `a = 1`, `a[i in 0..8] = 1` or `a[0] = 1`
fn indexed(input: ParseStream, attributes: &[Attribute]) -> Result<Definition> {
    let (name, indices) = (name(input)?, indices(input)?);
    Ok(Definition { indices, ..value_of(name, input, attributes.to_vec())? })
}

/// `rod = 1` or `link[i in 1..8] = 1`
fn constraint(input: ParseStream, attributes: &[Attribute]) -> Result<Definition> {
    let mistake = |span: Span, mistake| error(span, &Message::Constraint(mistake));
    let first = input.span();
    // Without a name, the sign is the greater mistake.
    let no_name = |sign: Option<Span>| match sign {
        Some(sign) => mistake(sign, ConstraintMistake::Inequality),
        None => mistake(first, ConstraintMistake::NoName),
    };
    let sign = inequality(input);
    // A keyword of Rust too: its message says that it is reserved.
    if !input.peek(Ident::peek_any) {
        return Err(no_name(sign));
    }
    let (name, indices) = (name(input)?, indices(input)?);
    if input.peek(Token![:]) && !input.peek2(Token![=]) {
        return Err(mistake(input.span(), ConstraintMistake::Colon { name: name.to_string() }));
    }
    let has_value = input.peek(Token![=]) && !input.peek(Token![==]);
    let is_unfinished = input.is_empty() || input.peek(Token![;]) || input.peek(Token![,]) || input.peek(Token![:]);
    if !has_value && !is_unfinished {
        return Err(no_name(sign));
    }
    let definition = Definition { indices, ..value_of(name, input, attributes.to_vec())? };
    if input.peek(Token![=]) || input.peek(Token![!=]) {
        return Err(mistake(input.span(), ConstraintMistake::Equation));
    }
    if input.peek(Token![<]) || input.peek(Token![>]) {
        return Err(mistake(input.span(), ConstraintMistake::Inequality));
    }
    Ok(definition)
}

/// The sign of an inequality between this place and the end of the clause.
fn inequality(input: ParseStream) -> Option<Span> {
    let mut here = input.cursor();
    while let Some((token, behind)) = here.token_tree() {
        match token {
            TokenTree::Punct(mark) if mark.as_char() == ';' => return None,
            TokenTree::Punct(mark) if "<>≤≥".contains(mark.as_char()) => return Some(mark.span()),
            _ => here = behind,
        }
    }
    None
}

/// Pairs of brackets: `[i in 0..8]` or `[0]` each
fn indices(input: ParseStream) -> Result<Vec<Indices>> {
    let mut indices = Vec::new();
    while has_bracket(input, indices.len())? {
        let inner;
        syn::bracketed!(inner in input);
        if !(inner.peek(syn::Ident) && inner.peek2(Token![in])) {
            indices.push(Indices::One(Expression::alone(&inner, 0, INSIDE_BRACKETS)?));
            continue;
        }
        let start = inner.cursor();
        indices.push(Indices::Range(Expression::range(&inner, 0)?));
        if !inner.is_empty() {
            return Err(unexpected::operator(&inner, start, INSIDE_BRACKETS));
        }
    }
    Ok(indices)
}

/// `= 1`
fn value_of(name: Ident, input: ParseStream, attributes: Vec<Attribute>) -> Result<Definition> {
    equals(input, &name, None)?;
    Ok(Definition { attributes, name, indices: Vec::new(), value: Expression::parse(input)? })
}

/// The `=` after a name.
fn equals(input: ParseStream, name: &Ident, clause: Option<&'static str>) -> Result<()> {
    if !input.peek(Token![=]) {
        return Err(unexpected::equals(input, name, clause));
    }
    input.parse::<Token![=]>().map(|_| ())
}

/// `a = 1`, `m[3] = 1` or `m[3] = [1, 2, 3]`. An unreadable default becomes 0, so that the field exists for the
/// surrounding code.
fn parameter(
    input: ParseStream,
    is_input: bool,
    attributes: &[Attribute],
    parameters: &mut Vec<Parameter>,
) -> Result<()> {
    let name = name(input)?;
    let lengths = lengths(input)?;
    let read = equals(input, &name, Some(clause_of(is_input))).and_then(|()| Expression::parse(input));
    let zero = || Expression { span: name.span(), kind: Kind::Number(Rational::zero()) };
    let (default, outcome) = match read {
        Ok(default) => (default, Ok(())),
        Err(error) => (zero(), Err(error)),
    };
    parameters.push(Parameter { attributes: attributes.to_vec(), name, lengths, default, is_input });
    outcome
}

/// `x` or `q[8]`, after the word `coord`, `angle` or `rotation`
fn coordinate(input: ParseStream, word: &Ident) -> Result<Coordinate> {
    let name = name(input)?;
    let space = [Space::Circle, Space::Rotation].into_iter().find(|space| word == space.word()).unwrap_or(Space::Line);
    Ok(Coordinate { name, lengths: lengths(input)?, space })
}

/// `p of q`, after the word `momentum`
fn momentum(input: ParseStream) -> Result<Momentum> {
    let name = name(input)?;
    let span = input.span();
    match input.parse::<Ident>() {
        Ok(word) if word == "of" => Ok(Momentum { name, of: self::name(input)? }),
        _ => Err(error(span, &Message::Expected { what: "`of` and a coordinate, as in `momentum p of q;`" })),
    }
}

/// The lengths of an array, `[8]` or `[8][3]`; none of a number
fn lengths(input: ParseStream) -> Result<Vec<Expression>> {
    let mut lengths = Vec::new();
    while has_bracket(input, lengths.len())? {
        let inner;
        syn::bracketed!(inner in input);
        if inner.peek(syn::Ident) && inner.peek2(Token![in]) {
            return Err(error(inner.span(), &Message::Expected { what: "a length, as in `q[8]`" }));
        }
        lengths.push(Expression::alone(&inner, 0, INSIDE_BRACKETS)?);
    }
    Ok(lengths)
}

/// The end of a clause of expressions that starts at `start`.
fn semicolon(input: ParseStream, start: Cursor) -> Result<()> {
    if input.peek(Token![;]) {
        return input.parse::<Token![;]>().map(|_| ());
    }
    Err(unexpected::end_of_definition(input, start, "an operator or `;`"))
}

/// The end of a clause of names that starts at `start`.
fn end_of_names(input: ParseStream, start: Cursor) -> Result<()> {
    if input.peek(Token![;]) {
        return input.parse::<Token![;]>().map(|_| ());
    }
    Err(unexpected::end_of_names(input, start))
}
