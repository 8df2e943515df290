//! Each example to the compiler: one message, at the marked token, with the words that the example names.

use super::{ArrayMistake, Character, ConstraintMistake, FunctionMistake, Habit, HamiltonianMistake, Message, words};
use crate::syntax;
use proc_macro2::TokenStream;

/// A system in which a clause is the example.
const SYSTEM: &str = "const N = 3, s = [1, 2]; param l = 1, m = 2, g = 3; coord x, y, z, q[3], r[N][3]; \
    let M = [[x, 1], [2, 3]], ragged[i in 0..N][j in 0..i] = q[j], late[i in 1..N] = q[i]; EXAMPLE \
    L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(q) * dot(q) + sum(i in 0..N, dot(r[i]) * dot(r[i]))) / 2 - g * l * z;";

/// The clauses of an example: all of them, one that ends with `;`, or an expression.
fn clauses(example: &str) -> String {
    if example.replace(['«', '»'], "").split([' ', ';']).any(|word| word == "L" || word == "H") {
        return example.to_owned();
    }
    let clause = if example.ends_with(';') { example.to_owned() } else { format!("let value = {example};") };
    SYSTEM.replace("EXAMPLE", &clause)
}

/// The errors of a system: (token, message).
fn errors(text: &str) -> Vec<(String, String)> {
    let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
    let Err(error) = syntax::parse::system(tokens).and_then(|system| crate::derive(&system)) else {
        return Vec::new();
    };
    let token = |error: &syn::Error| error.span().source_text().unwrap_or_default();
    error.into_iter().map(|error| (token(&error), error.to_string())).collect()
}

/// The errors of an example, unless it has exactly one, at its marked token or at the name of the system, with this
/// text.
fn difference(example: &str, what: &str, help: &str) -> Option<String> {
    let token = example.split_once('«').and_then(|(_, rest)| rest.split_once('»')).map_or("System", |(token, _)| token);
    let found = errors(&format!("struct System {{ {} }}", clauses(example).replace(['«', '»'], "")));
    let wanted = (token.to_owned(), format!("{what}\nhelp: {help}"));
    (found != [wanted]).then(|| format!("{example}\n{found:#?}\nnot {what}\n    {help}"))
}

/// A word of a message, from what an example writes; an empty text is none.
pub(super) fn word<T>(value: impl Word<T>) -> T {
    value.word()
}

pub(super) trait Word<T> {
    fn word(self) -> T;
}

impl<T> Word<T> for T {
    fn word(self) -> T {
        self
    }
}

impl Word<String> for &'static str {
    fn word(self) -> String {
        self.to_owned()
    }
}

impl<T> Word<Option<T>> for &'static str
where
    &'static str: Word<T>,
{
    fn word(self) -> Option<T> {
        (!self.is_empty()).then(|| word(self))
    }
}

impl Word<usize> for i32 {
    fn word(self) -> usize {
        usize::try_from(self).expect("a count")
    }
}

impl Word<i64> for i32 {
    fn word(self) -> i64 {
        i64::from(self)
    }
}

impl<T, W: Word<T>, const N: usize> Word<Vec<T>> for [W; N] {
    fn word(self) -> Vec<T> {
        self.map(word).into()
    }
}

#[test]
fn each_example_has_its_message() {
    let mut wrong = Vec::new();
    macro_rules! compare {
        ($($catalogue:ident)*) => {
            $(for (inputs, message) in $catalogue::examples() {
                let (what, help) = (message.what(), message.help());
                wrong.extend(inputs.iter().filter_map(|example| difference(example, &what, &help)));
            })*
        };
    }
    compare!(Message ArrayMistake ConstraintMistake FunctionMistake Habit HamiltonianMistake);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The only wrong character is the marked one.
#[test]
fn each_wrong_character_has_its_message() {
    use crate::inspect::unreadable::unreadable;

    for (inputs, character) in Character::examples() {
        let [example] = inputs else { panic!("one input: {inputs:?}") };
        let line = example.lines().position(|line| line.contains('«')).expect("a marked character");
        let column = example.lines().nth(line).and_then(|line| line.chars().position(|letter| letter == '«'));
        let (place, message) = unreadable(&example.replace(['«', '»'], "")).expect("a wrong character");
        assert_eq!((place.line, Some(place.column)), (line + 1, column), "{example}");
        assert_eq!(message, Message::Character(character), "{example}");
    }
    for right in ["a { b(c[1]) } // ²", "a { '(' }", "fn f<'a>(a: &'a str) -> &'static str"] {
        assert_eq!(unreadable(right), None);
    }
    for (text, column) in [("L = q'^2 / 2;", 5), ("L = q'' * q;", 5), ("L = x'(t)^2;", 5), ("L = q[0]' - 1;", 8)] {
        let (place, message) = unreadable(text).expect("a prime");
        assert_eq!((place.column, message), (column, Message::Habit(Habit::Prime)), "{text}");
    }
}

/// The words of other languages, as clauses, functions, names and rules.
#[test]
fn each_word_has_its_help() {
    let mut wrong = Vec::new();
    for (table, input, what) in [
        (words::CLAUSES, "«WORD» u = 0.0;", "unknown clause `WORD`"),
        (words::FUNCTIONS, "x.«WORD»()", "`.WORD(…)`: numbers have no methods"),
        (words::NAMES, "«WORD»", "unknown name `WORD`"),
        (words::RULES, "coord x; L = dot(x)^2; discretize «WORD»;", "unknown rule `WORD`"),
    ] {
        for (all, help) in table {
            let message = |word| difference(&input.replace("WORD", word), &what.replace("WORD", word), help);
            wrong.extend(all.split(' ').filter_map(message));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
