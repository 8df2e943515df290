//! The properties of a large system that the generator found, in words.

use super::{Indexed, named};
use crate::findings::{
    EXPLICIT, angles_in_words, constrained_energy_in_words, constrained_smoothness_in_words, constraint_names,
    constraints_in_words, cyclic_in_words, derivatives_in_words, energy_in_words,
};
use crate::model::Coordinate;
use crate::rules::NamedRule;

/// The properties of a large system that the generator found, one per line, with formulas between backticks: for the
/// documentation of the struct.
#[must_use]
pub fn documentation(of: &Indexed) -> Vec<String> {
    properties(of, &|coordinate| format!("`{}`", coordinate.text()))
}

/// The same; `name` names a coordinate.
pub(crate) fn properties(of: &Indexed, name: &dyn Fn(&Coordinate) -> String) -> Vec<String> {
    let model = &of.model;
    let is_constrained = !model.constraints.is_empty();
    let energy = if is_constrained {
        constrained_energy_in_words(of.autonomous, model.forced, of.driven)
    } else {
        energy_in_words(of.autonomous, model.forced)
    };
    let mut lines = vec![energy.to_owned()];
    let cyclic: Vec<usize> = (0..model.dimension()).filter(|index| of.cyclic[*index]).collect();
    if !cyclic.is_empty() {
        lines.push(cyclic_in_words(&in_ranges(&model.coordinates, &cyclic, name), cyclic.len()));
    }
    lines.push(if of.separable {
        "`L = T(v) + U(t, q)` with a constant diagonal mass matrix; no force depends on the velocity".to_owned()
    } else if of.has_mass_of_position {
        "The mass matrix does not depend on the velocity".to_owned()
    } else {
        "The mass matrix depends on the velocity".to_owned()
    });
    let smoothness = if is_constrained { constrained_smoothness_in_words } else { derivatives_in_words };
    lines.extend(model.smoothness.as_ref().map(smoothness));
    lines.extend(constraints_in_words(&constraint_names(model)));
    let named = named(of);
    let sums = named.chunk_by(|left, right| left.terms() == right.terms());
    let sums = sums.filter_map(|all| Some((all.iter().map(|body| body.nests.len()).sum(), all[0].terms()?)));
    let loops = [(of.recursions.len(), "recursions")].into_iter().chain(sums);
    let loops = loops.filter(|(count, _)| *count > 0).map(|(count, over)| format!("{count} over {over}"));
    let (loops, functions) = (loops.collect::<Vec<_>>().join(", "), named.len());
    let noun = if functions == 1 { "function" } else { "functions" };
    lines.push(format!("Loops: {loops}; {functions} {noun} of one row"));
    if is_constrained {
        lines.push("The matrix of a step is dense; solved by elimination with pivoting".to_owned());
    }
    if !of.angles().is_empty() {
        lines.push(angles_in_words(&in_ranges(&model.coordinates, &of.angles(), name)));
    }
    lines.extend(of.rules.first().into_iter().flat_map(|rule| of_steps(of, rule)));
    lines
}

/// The properties of the steps by a rule.
pub(crate) fn of_steps(of: &Indexed, rule: &NamedRule) -> Vec<String> {
    if of.is_explicit(rule) {
        return vec![
            format!("The step's equation in `v` is {EXPLICIT}"),
            "`A` is diagonal; solved by division".to_owned(),
        ];
    }
    vec!["`A` is dense; solved by elimination with pivoting".to_owned()]
}

/// The names of coordinates, neighbors in an array as `q[0]` to `q[39]`.
fn in_ranges(coordinates: &[Coordinate], indices: &[usize], name: &dyn Fn(&Coordinate) -> String) -> String {
    let follows =
        |left: &usize, right: &usize| left + 1 == *right && coordinates[*left].name == coordinates[*right].name;
    let range = |of: &[usize]| match of {
        [first, .., last] if of.len() > 2 => format!("{} to {}", name(&coordinates[*first]), name(&coordinates[*last])),
        _ => of.iter().map(|index| name(&coordinates[*index])).collect::<Vec<_>>().join(", "),
    };
    indices.chunk_by(follows).map(range).collect::<Vec<_>>().join(", ")
}
