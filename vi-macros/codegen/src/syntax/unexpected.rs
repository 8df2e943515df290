//! Errors at unexpected tokens.
//!
//! In: the input at the token, and the start of the clause. Out: the error at the wrong token: the correction for a
//! known habit of notation, otherwise what the grammar expects.

use super::{INSIDE_BRACKETS, INSIDE_LIST};
use crate::clause::{CLAUSES, Next};
use crate::messages::{ArrayMistake, FunctionMistake, Habit, Message, error, words};
use proc_macro2::{Delimiter, Span, TokenTree};
use syn::buffer::Cursor;
use syn::parse::ParseStream;
use syn::{Error, Ident, Token};
use vi_expr::Function;

/// Characters of a token shown in a message.
const CHARACTERS: usize = 24;

/// The error for a missing operand: a number, a name or a parenthesis.
pub(super) fn operand(input: ParseStream) -> Error {
    let cursor = input.cursor();
    let point = || cursor.punct().filter(|(punct, _)| punct.as_char() == '.');
    let habit = match cursor.ident() {
        Some((word, _)) if word == "match" => Some(Habit::Condition),
        Some((word, _)) if ["crate", "self", "super"].iter().any(|root| word == root) && input.peek2(Token![::]) => {
            Some(Habit::Path)
        }
        Some((word, behind)) if behind.group(Delimiter::Parenthesis).is_some() => {
            // A keyword of Rust, as `where(…)`.
            if let Some(error) = call(&word) {
                return error;
            }
            None
        }
        Some(_) => None,
        None if input.peek(Token![|]) => Some(Habit::Bars),
        None if input.peek(syn::token::Brace) => Some(Habit::OtherBrackets),
        None if input.peek(Token![..]) || input.peek(Token![:]) => {
            return error(input.span(), &Message::Array(ArrayMistake::Slice));
        }
        None => point()
            .and_then(|(_, behind)| behind.literal())
            .map(|(digits, _)| Habit::PointWithoutDigits { number: format!("0.{}", short(digits.to_string())) }),
    };
    unexpected(input.span(), habit, "a number, a name or `(`")
}

/// The error for a call of a function that other languages have and this one writes without a function.
pub(super) fn call(name: &Ident) -> Option<Error> {
    let name_of = name.to_string();
    words::is_condition(&name_of).then(|| error(name.span(), &Message::UnknownFunction { name: name_of, near: None }))
}

/// The error after an expression that starts at `start`: neither an operator nor its end, which `what` names.
pub(super) fn operator(input: ParseStream, start: Cursor, what: &'static str) -> Error {
    let Some((next, behind)) = input.cursor().token_tree() else {
        return unexpected(input.span(), None, what);
    };
    let previous = previous(input, start);
    if what == INSIDE_BRACKETS {
        let is_slice = input.peek(Token![..]) || input.peek(Token![:]);
        let mistake = if is_slice { Some(ArrayMistake::Slice) } else { None };
        let mistake = if input.peek(Token![,]) { Some(ArrayMistake::IndexComma) } else { mistake };
        if let Some(mistake) = mistake {
            return error(input.span(), &Message::Array(mistake));
        }
    }
    if input.peek(Token![if]) {
        return error(input.span(), &Message::Function(FunctionMistake::Else));
    }
    if what == INSIDE_LIST && !input.peek(Token![..]) {
        let is_row = input.peek(Token![;]);
        let is_entry = matches!(next, TokenTree::Literal(_) | TokenTree::Ident(_)) && previous.is_some();
        if is_row || is_entry {
            return error(input.span(), &Message::Array(ArrayMistake::Separator { is_row }));
        }
    }
    let habit = match &next {
        TokenTree::Punct(punct) => match punct.as_char() {
            '@' => Some(Habit::OtherProduct { sign: "@" }),
            '.' if behind.punct().is_some_and(|(sign, _)| sign.as_char() == '*') => {
                Some(Habit::OtherProduct { sign: ".*" })
            }
            '.' => {
                let (word, habit) = behind_point(behind, previous.as_ref());
                return unexpected(word.unwrap_or_else(|| punct.span()), habit, what);
            }
            '\'' => Some(Habit::Prime),
            '|' => Some(Habit::Bars),
            '=' | '<' | '>' | '?' => Some(Habit::Condition),
            '!' if input.peek(Token![!=]) => Some(Habit::Condition),
            sign @ ('%' | '!') => Some(Habit::NoOperator { sign }),
            ':' if input.peek(Token![::]) => Some(Habit::Path),
            ':' => Some(Habit::Type),
            ',' if behind.literal().is_some() && is_number(previous.as_ref()) && is_one_number(what) => {
                Some(Habit::DecimalComma)
            }
            _ => None,
        },
        TokenTree::Ident(word) if word == "as" => Some(Habit::Conversion),
        TokenTree::Literal(literal) if literal.to_string().starts_with('\'') => Some(Habit::Prime),
        TokenTree::Group(group) if group.delimiter() == Delimiter::Bracket => {
            Some(if is_number(previous.as_ref()) { Habit::UnitInBrackets } else { Habit::IndexBehind })
        }
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => None,
        TokenTree::Ident(_) | TokenTree::Literal(_) | TokenTree::Group(_) => {
            previous.map(|left| missing_operator(&left, &next, behind))
        }
    };
    unexpected(input.span(), habit, what)
}

/// The error at a token: the correction of a habit, or what the grammar expects.
fn unexpected(span: Span, habit: Option<Habit>, what: &'static str) -> Error {
    error(span, &habit.map_or(Message::Expected { what }, Message::Habit))
}

/// The error for a definition that starts at `start` and does not end with `;` or another token named by `what`.
pub(super) fn end_of_definition(input: ParseStream, start: Cursor, what: &'static str) -> Error {
    match previous(input, start) {
        Some(last) if ends(input) => no_semicolon(&last),
        _ => operator(input, start, what),
    }
}

/// The error for a clause of names that starts at `start` and does not end with `;`.
pub(super) fn end_of_names(input: ParseStream, start: Cursor) -> Error {
    let is_coordinates =
        start.ident().is_some_and(|(word, _)| word == "coord" || word == "angle" || word == "rotation");
    let is_rule = start.ident().is_some_and(|(word, _)| word == "discretize");
    let is_argument =
        input.peek(syn::token::Paren) || input.peek(Token![=]) || input.peek(Token![<]) || input.peek(syn::Lit);
    match previous(input, start) {
        Some(last) if ends(input) => no_semicolon(&last),
        _ if is_coordinates && input.peek(Token![=]) => unexpected(input.span(), Some(Habit::ValueOfCoordinate), ""),
        _ if is_rule && is_argument => unexpected(input.span(), Some(Habit::RuleWithArguments), ""),
        _ if input.peek(Token![:]) => unexpected(input.span(), Some(Habit::Type), ""),
        _ => unexpected(input.span(), None, "`,` or `;`"),
    }
}

/// The error for a definition without `=`; `clause` declares a parameter.
pub(super) fn equals(input: ParseStream, name: &Ident, clause: Option<&'static str>) -> Error {
    if input.peek(Token![;]) || input.peek(Token![,]) || ends(input) {
        return error(name.span(), &Message::Habit(Habit::MissingValue { name: name.to_string(), clause }));
    }
    let is_colon_equals = input.peek(Token![:]) && input.peek2(Token![=]);
    let habit = if is_colon_equals {
        Some(Habit::ColonEquals)
    } else if input.peek(Token![:]) {
        Some(Habit::Type)
    } else if input.peek(syn::token::Paren) && name == "dot" {
        Some(Habit::ForceWithoutCoordinate)
    } else if input.peek(syn::token::Paren) {
        Some(Habit::FunctionDefinition { name: name.to_string() })
    } else if input.peek(Token![+=]) || input.peek(Token![-=]) {
        Some(Habit::AddedForce)
    } else {
        None
    };
    unexpected(input.span(), habit, "`=`")
}

/// Whether a word starts a clause here.
pub(super) fn begins_clause(input: ParseStream) -> bool {
    let Some((word, _)) = input.cursor().ident() else { return false };
    match CLAUSES.into_iter().find(|(clause, ..)| word == clause) {
        Some((_, Next::Any, _)) => true,
        Some((_, Next::Name, _)) => input.peek2(syn::Ident),
        Some((_, Next::Equals, _)) => input.peek2(Token![=]),
        None => false,
    }
}

/// Whether the previous definition ends here: at the end, at a clause, or at another definition.
fn ends(input: ParseStream) -> bool {
    input.is_empty() || begins_clause(input) || input.peek(syn::Ident) && input.peek2(Token![=])
}

fn no_semicolon(last: &Previous) -> Error {
    let span = match &last.token {
        TokenTree::Group(group) => group.span_close(),
        other => other.span(),
    };
    error(span, &Message::Habit(Habit::MissingSemicolon { after: last.text() }))
}

/// The tokens before an unexpected token.
struct Previous {
    /// The token directly before.
    token: TokenTree,
    /// The name before that token.
    name: Option<Ident>,
}

impl Previous {
    /// The operand that ends here: `m`, `2`, `m[…]`, `sin(…)`.
    fn text(&self) -> String {
        operand_text(self.name.as_ref(), &self.token)
    }
}

/// Whether a comma between two numbers is a decimal comma: in brackets it separates indices, in a range its ends.
fn is_one_number(what: &str) -> bool {
    what.starts_with("an operator") && !what.ends_with("`]`")
}

/// Whether a number ends before a token.
fn is_number(previous: Option<&Previous>) -> bool {
    previous.is_some_and(|previous| matches!(previous.token, TokenTree::Literal(_)))
}

/// The tokens before the next one, starting at `start`.
fn previous(input: ParseStream, start: Cursor) -> Option<Previous> {
    let mut cursor = start;
    let mut last: Option<Previous> = None;
    while cursor != input.cursor() {
        let (token, behind) = cursor.token_tree()?;
        let name = match last {
            Some(Previous { token: TokenTree::Ident(name), .. }) => Some(name),
            _ => None,
        };
        last = Some(Previous { token, name });
        cursor = behind;
    }
    last
}

/// A name with its brackets or parentheses, or a single token.
fn operand_text(name: Option<&Ident>, token: &TokenTree) -> String {
    match (name, token) {
        (Some(name), TokenTree::Group(_)) => format!("{name}{}", text(token)),
        _ => text(token),
    }
}

/// The habit after a decimal point, with its place: a method call, or an exponent without digits before it.
fn behind_point(behind: Cursor, previous: Option<&Previous>) -> (Option<Span>, Option<Habit>) {
    let Some((mut word, mut behind)) = behind.ident() else { return (None, None) };
    // `np.linalg.norm(…)`: the function is the last name.
    let mut last = (word.clone(), behind);
    while let Some((_, name)) = last.1.punct().filter(|(mark, _)| mark.as_char() == '.')
        && let Some(further) = name.ident()
    {
        last = further;
    }
    if last.1.group(Delimiter::Parenthesis).is_some() {
        (word, behind) = last;
    }
    let text = word.to_string();
    let is_exponent = text.starts_with(['e', 'E']) && text.chars().skip(1).all(|digit| digit.is_ascii_digit());
    if let Some(Previous { token: TokenTree::Literal(digits), .. }) = previous
        && is_exponent
    {
        // `1.e3` has its digits in the word, `1.e-3` after it.
        let sign = behind.punct().filter(|_| text.len() == 1);
        let exponent = sign.as_ref().and_then(|(_, behind)| behind.literal());
        let signed = sign.zip(exponent).map(|((sign, _), (exponent, _))| format!("{}{exponent}", sign.as_char()));
        let number = short(format!("{digits}.0{text}{}", signed.unwrap_or_default()));
        return (Some(word.span()), Some(Habit::PointWithoutDigits { number }));
    }
    let is_method = behind.group(Delimiter::Parenthesis).is_some();
    let habit = if is_method { Habit::Method { name: text } } else { Habit::Field { name: text } };
    (Some(word.span()), Some(habit))
}

/// Two adjacent operands; the tokens `behind` the name on the right may belong to it.
fn missing_operator(left: &Previous, right: &TokenTree, behind: Cursor) -> Habit {
    let group = behind.token_tree().map(|(token, _)| token).filter(|token| matches!(token, TokenTree::Group(_)));
    let right_text = match (right, group) {
        (TokenTree::Ident(name), Some(group)) => operand_text(Some(name), &group),
        _ => text(right),
    };
    match &left.token {
        TokenTree::Ident(name) if is_function(name) => {
            Habit::FunctionWithoutParentheses { name: name.to_string(), argument: right_text }
        }
        token => {
            let is_number = matches!((token, right), (TokenTree::Literal(_), TokenTree::Ident(_)));
            Habit::MissingOperator { left: left.text(), right: right_text, is_number }
        }
    }
}

/// Whether a name is that of a function.
pub(super) fn is_function(name: &Ident) -> bool {
    let name = name.to_string();
    name == "dot" || name == "sqrt" || Function::from_name(&name).is_some()
}

/// The text of a token in a message; a group by its delimiters.
fn text(token: &TokenTree) -> String {
    match token {
        TokenTree::Group(group) => match group.delimiter() {
            Delimiter::Bracket => "[…]".to_owned(),
            Delimiter::Brace => "{…}".to_owned(),
            Delimiter::Parenthesis | Delimiter::None => "(…)".to_owned(),
        },
        other => short(other.to_string()),
    }
}

/// A text, truncated if it is long.
fn short(mut text: String) -> String {
    if let Some((end, _)) = text.char_indices().nth(CHARACTERS) {
        text.truncate(end);
        text.push('…');
    }
    text
}
