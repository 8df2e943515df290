//! The 50-digit values of `tests/reference`, read as `f64`.

use serde_json::Value;
use std::path::Path;

/// The contents of a file of `tests/reference`.
pub(crate) fn file(name: &str) -> Value {
    // The tests of the root are in `tests`, the others in `tests/long`.
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("tests/reference"));
    let path = folders.map(|folder| folder.join(name)).find(|path| path.exists());
    let path = path.unwrap_or_else(|| panic!("there is no tests/reference/{name}"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A number, given as a string of 50 digits, as a fraction, or as a number.
pub(crate) fn number(value: &Value) -> f64 {
    let Some(text) = value.as_str() else { return value.as_f64().expect("a number") };
    match text.split_once('/') {
        Some((above, below)) => {
            above.parse::<f64>().expect("a numerator") / below.parse::<f64>().expect("a denominator")
        }
        None => text.parse().expect("a decimal number"),
    }
}

/// A vector, given as a list, or as one number.
pub(crate) fn vector<const N: usize>(value: &Value) -> [f64; N] {
    match value.as_array() {
        Some(list) => {
            assert_eq!(list.len(), N);
            core::array::from_fn(|index| number(&list[index]))
        }
        None => [number(value); N],
    }
}

/// The entries of a list, each with its number of steps.
pub(crate) fn steps(list: &Value) -> Vec<(u32, &Value)> {
    let count = |entry: &Value| entry.get("step").or_else(|| entry.get("steps_after_start")).and_then(Value::as_u64);
    let list = list.as_array().expect("a list of steps");
    let step = |entry| count(entry).and_then(|step| u32::try_from(step).ok()).expect("a step number");
    list.iter().map(|entry| (step(entry), entry)).collect()
}
