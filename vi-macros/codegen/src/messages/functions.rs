//! Mistakes with functions, tables and conditions.

use super::words::{CONDITION, did_you_mean};

catalogue! {
    /// A mistake with functions, tables and conditions.
    FunctionMistake:

    Arguments { name: String } =
        "`{name}` is declared without arguments",
        "write its arguments, as in `fn spring(k, x) = k * x^2 / 2;` or `table drag(v) = \"drag.csv\";`; name a value without \
         arguments with `let`",
        ["fn «g»() = 1; coord x; L = dot(x)^2 / 2 - g(x);", "fn «g» = 1; coord x; L = dot(x)^2 / 2 - g(x);",
         "fn «g»: (a) = a;"] { name: "g" };
    Typed { name: String, arguments: Vec<String> } =
        "`{name}` is declared with types or braces",
        { format!("write `fn {name}({}) = …;`: arguments and values are numbers", arguments.join(", ")) },
        ["fn g(a«:» f64) -> f64 { a };", "fn g(a) «-»> f64 { a };", "fn g(a) «{» a };"] { name: "g", arguments: ["a"] };
    Arity { name: String, arguments: Vec<String>, given: usize } =
        { takes(name, arguments.len(), *given) }, { format!("write `{name}({})`", arguments.join(", ")) },
        ["«clamp»(x, 1)"] { name: "clamp", arguments: ["x", "a", "b"], given: 2 },
        ["fn g(a, b) = a * b; coord x; L = dot(x)^2 / 2 - «g»(x);",
         "fn g(a, b) = crate::g; coord x; L = dot(x)^2 / 2 - «g»(x);"] { name: "g", arguments: ["a", "b"], given: 1 };
    TooManyArguments { name: String, limit: usize } =
        "`{name}` has more than {limit} arguments",
        "declare several functions of fewer arguments, or write the expression with `fn` and `let`",
        ["fn «g»(a, b, c, d) = crate::g; coord x; L = dot(x)^2 / 2 - g(x, 1, 2, 3);"] { name: "g", limit: 3 };
    Recursive { name: String } =
        "`{name}` calls itself", "write the expression without recursion; `sum` repeats a term",
        ["fn g(a) = «g»(a - 1) * a; coord x; L = dot(x)^2 / 2 - g(x);",
         "fn g(a) = k(a); fn k(a) = «g»(a); coord x; L = dot(x)^2 / 2 - g(x);"] { name: "g" };
    TooDeep { limit: usize } =
        "in functions that call each other, more than {limit} operations and calls are inside each other",
        "write the values one after the other with `let`, as in `let x[0] = …; let x[i in 1..8] = … x[i - 1] …;`, or a sum with \
         `sum`";
    OfCrate { name: String } =
        "`{name}` is a Rust function, which a text alone does not have",
        "write it in the language, make it a table, or put the system into a crate, `vi-lab new NAME --python`";
    Unused { name: String } = "`{name}` is never used", "use it in `L` or in a force, or remove it",
        ["fn «g»(a) = a; coord x; L = dot(x)^2 / 2;"] { name: "g" };
    Data =
        "these are not the values of a table",
        "write the path of a file, `\"drag.csv\"`, points `[(0, 0.1), (1, 0.3)]`, or values at equal distances, `[0.1, 0.3]` or \
         the name of an array of parameters, with `table drag(v in 0..1) = …;`",
        ["param c[4] = 0; coord x; table g(a) = «3»; L = c[0] * dot(x)^2 / 2 - dot(x)^2 - g(x);"];
    Table { name: String, what: String, help: String } = "the table `{name}` {what}", { help.clone() },
        ["param c[4] = 0; coord x; table «g»(a) = [(0, 1)]; L = c[0] * dot(x)^2 / 2 - dot(x)^2 - g(x);"]
            { name: "g", what: "has 1 value", help: "write at least 2 values for each argument" };
    Word { word: String, near: Option<String> } =
        "unknown kind of table `{word}`",
        { did_you_mean(near.as_ref(), "the words are cubic, quintic, monotone, linear; periodic, hold, extend") },
        ["param c[4] = 0; coord x; table g(a in 0..1) = c «cubci»; L = c[0] * dot(x)^2 / 2 - dot(x)^2 - g(x);"]
            { word: "cubci", near: "cubic" };
    Few { name: String, given: usize } = "`{name}` takes two arguments or more, not {given}", "write `{name}(a, b)`",
        ["«max»(x)"] { name: "max", given: 1 };
    Text =
        "a text is no number",
        "write `table drag(v) = \"drag.csv\";` for the values of a file, and `drag(…)` for one of them",
        ["«\"x\"»", "«\"a\"»"];
    Else = "`if` needs two values in braces", "write `if a > b {{ x }} else {{ y }}`",
        ["«if» x > 0 { x }", "(x^2 «if» x > 0 else 0)"];
    Comparison = "`if` needs one comparison by `>`, `>=`, `<` or `<=`", { CONDITION.to_owned() },
        ["if x «=»= 0 { x } else { 0 }", "if x > 0 «&»& x < 1 { x } else { 0 }", "«if» (x) { x } else { 0 }",
         "if (x > 0 «&»& x < 1) { x } else { 0 }", "if (x > 0) «&»& (x < 1) { x } else { 0 }",
         "«if» x { 1 } else { 2 }"];
    Jump { condition: String } =
        "`L` jumps where `{condition}` is zero",
        "an infinite force would act there: make both sides equal there, as in `if x > 0 {{ k * x^2 / 2 }} else {{ 0 }}` or `sign(x) * x^2`; a \
         `force` may jump, as dry friction does; an event with `set_state` models an impact",
        ["param c = 0.3; coord x, y; «L» = dot(x)^2 + c * dot(y)^2 - if x > 1 { x } else { 0 };"]
            { condition: "x - 1" };
}

/// "`sin` takes 1 argument, not 2".
pub(crate) fn takes(name: &str, count: usize, given: usize) -> String {
    let arguments = if count == 1 { "argument" } else { "arguments" };
    format!("`{name}` takes {count} {arguments}, not {given}")
}
