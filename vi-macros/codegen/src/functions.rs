//! Mistakes with functions, tables and conditions.
//!
//! In: the names and numbers found. Out: a message with the error and its correction.

use crate::habits::did_you_mean;

/// A mistake with functions, tables and conditions. The fields of a variant are the words that its text names.
#[allow(missing_docs)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FunctionMistake {
    /// A function or table without arguments in its declaration.
    Arguments { name: String },
    /// A function with types or a body in braces, as in Rust.
    Typed { name: String, arguments: Vec<String> },
    /// A call of a declared function with the wrong number of arguments.
    Arity { name: String, arguments: Vec<String>, given: usize },
    /// A Rust function of more arguments than derivatives are available for.
    TooManyArguments { name: String, limit: usize },
    /// A function of the language that calls itself.
    Recursive { name: String },
    /// Functions that call each other through too many levels.
    TooDeep { limit: usize },
    /// A Rust function in a text without a crate.
    OfCrate { name: String },
    /// An unused function or table.
    Unused { name: String },
    /// A table whose values are none of the allowed forms.
    Data,
    /// A table that cannot be read or used, with the reason and the correction.
    Table { name: String, what: String, help: String },
    /// A word after a table that is no kind of interpolation.
    Word { word: String, near: Option<String> },
    /// A choice of fewer than two numbers.
    Few { name: String, given: usize },
    /// A text where a number is needed.
    Text,
    /// An `if` without both arms.
    Else,
    /// An `if` without a comparison.
    Comparison,
    /// An L that is discontinuous where this expression changes its sign.
    Jump { condition: String },
}

/// "`sin` takes 1 argument, not 2".
pub(crate) fn takes(name: &str, count: usize, given: usize) -> String {
    let arguments = if count == 1 { "argument" } else { "arguments" };
    format!("`{name}` takes {count} {arguments}, not {given}")
}

impl FunctionMistake {
    /// What is wrong.
    #[must_use]
    pub fn what(&self) -> String {
        match self {
            Self::Arguments { name } => format!("`{name}` is declared without arguments"),
            Self::Typed { name, .. } => format!("`{name}` is declared with types or braces"),
            Self::Arity { name, arguments, given } => takes(name, arguments.len(), *given),
            Self::Few { name, given } => format!("`{name}` takes two arguments or more, not {given}"),
            Self::Text => "a text is no number".to_owned(),
            Self::TooManyArguments { name, limit } => format!("`{name}` has more than {limit} arguments"),
            Self::Recursive { name } => format!("`{name}` calls itself"),
            Self::TooDeep { limit } => {
                format!(
                    "in functions that call each other, more than {limit} operations and calls are inside each other"
                )
            }
            Self::OfCrate { name } => format!("`{name}` is a Rust function, which a text alone does not have"),
            Self::Unused { name } => format!("`{name}` is never used"),
            Self::Data => "these are not the values of a table".to_owned(),
            Self::Table { name, what, .. } => format!("the table `{name}` {what}"),
            Self::Word { word, .. } => format!("unknown kind of table `{word}`"),
            Self::Else => "`if` needs two values in braces".to_owned(),
            Self::Comparison => "`if` needs one comparison by `>`, `>=`, `<` or `<=`".to_owned(),
            Self::Jump { condition } => format!("`L` jumps where `{condition}` is zero"),
        }
    }

    /// What to write instead.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::Arguments { .. } => {
                "write its arguments, as in `fn spring(k, x) = k * x^2 / 2;` or `table drag(v) = \"drag.csv\";`; name a value without \
                 arguments with `let`"
                    .to_owned()
            }
            Self::Typed { name, arguments } => {
                format!("write `fn {name}({}) = …;`: arguments and values are numbers", arguments.join(", "))
            }
            Self::Arity { name, arguments, .. } => format!("write `{name}({})`", arguments.join(", ")),
            Self::TooManyArguments { .. } => {
                "declare several functions of fewer arguments, or write the expression with `fn` and `let`".to_owned()
            }
            Self::Recursive { .. } => "write the expression without recursion; `sum` repeats a term".to_owned(),
            Self::TooDeep { .. } => {
                "write the values one after the other with `let`, as in `let x[0] = …; let x[i in 1..8] = … x[i - 1] …;`, or a sum with \
                 `sum`"
                    .to_owned()
            }
            Self::OfCrate { .. } => {
                "write it in the language, make it a table, or put the system into a crate, `vi-lab new NAME --python`".to_owned()
            }
            Self::Unused { .. } => "use it in `L` or in a force, or remove it".to_owned(),
            Self::Data => {
                "write the path of a file, `\"drag.csv\"`, points `[(0, 0.1), (1, 0.3)]`, or values at equal distances, `[0.1, 0.3]` or \
                 the name of an array of parameters, with `table drag(v in 0..1) = …;`"
                    .to_owned()
            }
            Self::Table { help, .. } => help.clone(),
            Self::Word { near, .. } => did_you_mean(
                near.as_ref(),
                "the words are cubic, quintic, monotone, linear; periodic, hold, extend",
            ),
            Self::Few { name, .. } => format!("write `{name}(a, b)`"),
            Self::Text => "write `table drag(v) = \"drag.csv\";` for the values of a file, and `drag(…)` for one of them".to_owned(),
            Self::Else => "write `if a > b { x } else { y }`".to_owned(),
            Self::Comparison => {
                "write `if a > b { x } else { y }`; write an `if` inside another for two conditions".to_owned()
            }
            Self::Jump { .. } => {
                "an infinite force would act there: make both sides equal there, as in `if x > 0 { k * x^2 / 2 } else { 0 }` or `sign(x) * x^2`; a \
                 `force` may jump, as dry friction does; an event with `set_state` models an impact"
                    .to_owned()
            }
        }
    }
}
