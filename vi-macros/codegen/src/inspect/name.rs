//! Symbols in LaTeX.
//!
//! In: a symbol. Out: its name with indices and dots: `\dot{\theta}_{1}` for the velocity of `θ1`, `q_{3}` for `q[3]`,
//! `x_{0}` for a slot, `L_{\dot{x}}` for a field. Trailing digits and the part after an underscore become indices.
//! Greek letters and their English names become commands. Names of several letters are upright.

use crate::Derived;
use crate::model::{Constraint, Coordinate, Model};
use crate::symbol::{Field, Quantity, Symbol, Variable};
use proc_macro2::Ident;

/// A letter, or a word in its place, with indices.
pub(super) struct Name {
    letter: String,
    indices: Vec<String>,
}

impl Name {
    /// The name of a user in LaTeX.
    pub(super) fn of(written: &str) -> Self {
        let written = written.trim_start_matches("r#");
        let (stem, rest) = written.split_once('_').map_or((written, None), |(stem, rest)| (stem, Some(rest)));
        let letters = stem.trim_end_matches(|last: char| last.is_ascii_digit());
        let (letters, digits) = if letters.is_empty() { (stem, "") } else { stem.split_at(letters.len()) };
        let mut indices = Vec::new();
        if !digits.is_empty() {
            indices.push(digits.to_owned());
        }
        let rest = rest.into_iter().flat_map(|rest| rest.split('_')).filter(|part| !part.is_empty());
        indices.extend(
            rest.map(|part| if part.chars().all(|c| c.is_ascii_digit()) { part.to_owned() } else { word(part) }),
        );
        Self { letter: word(letters), indices }
    }

    /// Appends an index.
    pub(super) fn with(mut self, index: impl Into<String>) -> Self {
        self.indices.push(index.into());
        self
    }

    /// Puts an accent over the letter.
    pub(super) fn under(mut self, accent: &str) -> Self {
        self.letter = format!("\\{accent}{{{}}}", self.letter);
        self
    }

    /// The name in LaTeX.
    pub(super) fn text(&self) -> String {
        indexed(&self.letter, &self.indices.iter().map(String::as_str).collect::<Vec<_>>())
    }
}

/// A letter with indices.
pub(super) fn indexed(letter: &str, indices: &[&str]) -> String {
    if indices.is_empty() { letter.to_owned() } else { format!("{letter}_{{{}}}", indices.join(",")) }
}

/// A word: one letter unchanged, Greek letters as commands, other words upright.
fn word(letters: &str) -> String {
    let mut all = letters.chars();
    match (all.next(), all.next()) {
        (Some(only), None) => greek(only).map_or_else(|| only.to_string(), str::to_owned),
        _ if GREEK.iter().any(|(_, command)| command.trim_start_matches('\\') == letters) => format!("\\{letters}"),
        _ => {
            let command =
                |letter: char| greek(letter).map_or_else(|| letter.to_string(), |command| format!("{command} "));
            format!("\\mathrm{{{}}}", letters.chars().map(command).collect::<String>())
        }
    }
}

/// The command of a Greek letter; capitals with a Latin shape are that Latin letter.
pub(super) fn greek(letter: char) -> Option<&'static str> {
    GREEK.iter().find(|(known, _)| *known == letter).map(|(_, command)| *command)
}

const GREEK: [(char, &str); 37] = [
    ('α', "\\alpha"),
    ('β', "\\beta"),
    ('γ', "\\gamma"),
    ('δ', "\\delta"),
    ('ε', "\\varepsilon"),
    ('ϵ', "\\epsilon"),
    ('ζ', "\\zeta"),
    ('η', "\\eta"),
    ('θ', "\\theta"),
    ('ϑ', "\\vartheta"),
    ('ι', "\\iota"),
    ('κ', "\\kappa"),
    ('λ', "\\lambda"),
    ('μ', "\\mu"),
    ('ν', "\\nu"),
    ('ξ', "\\xi"),
    ('π', "\\pi"),
    ('ρ', "\\rho"),
    ('σ', "\\sigma"),
    ('ς', "\\varsigma"),
    ('τ', "\\tau"),
    ('υ', "\\upsilon"),
    ('φ', "\\varphi"),
    ('ϕ', "\\phi"),
    ('χ', "\\chi"),
    ('ψ', "\\psi"),
    ('ω', "\\omega"),
    ('Γ', "\\Gamma"),
    ('Δ', "\\Delta"),
    ('Θ', "\\Theta"),
    ('Λ', "\\Lambda"),
    ('Ξ', "\\Xi"),
    ('Π', "\\Pi"),
    ('Σ', "\\Sigma"),
    ('Φ', "\\Phi"),
    ('Ψ', "\\Psi"),
    ('Ω', "\\Omega"),
];

/// The name of a coordinate.
pub(super) fn coordinate(of: &Coordinate) -> Name {
    entry(&of.name, &of.indices)
}

/// The name of a constraint in LaTeX.
pub(super) fn constraint(of: &Constraint) -> String {
    let name = of.indices.iter().fold(Name::of(&of.name.to_string()), |name, index| name.with(index.to_string()));
    name.text()
}

/// A name with its indices in an array.
fn entry(name: &Ident, indices: &[usize]) -> Name {
    indices.iter().fold(Name::of(&name.to_string()), |name, index| name.with(index.to_string()))
}

/// A symbol in LaTeX.
pub(super) fn latex(derived: &Derived, symbol: &Symbol) -> String {
    named(derived, symbol).text()
}

/// A symbol of L and f at a stage with this index.
pub(super) fn at_stage(derived: &Derived, symbol: &Symbol, stage: &str) -> String {
    let name = named(derived, symbol);
    let name = if matches!(symbol, Symbol::Continuous(_)) { name.with(stage) } else { name };
    name.text()
}

/// A symbol of L and f before discretization; `None` for others.
pub(super) fn of_model(model: &Model, symbol: &Symbol) -> Option<Name> {
    let of = |index: &usize| model.coordinates.get(*index).map_or_else(|| Name::of("q"), coordinate);
    Some(match symbol {
        Symbol::Parameter { index, .. } => {
            model.parameters.get(*index).map_or_else(|| Name::of("a"), |of| entry(&of.name, &of.indices))
        }
        Symbol::Continuous(Variable::Time) => Name::of("t"),
        Symbol::Continuous(Variable::Coordinate(index)) => of(index),
        Symbol::Continuous(Variable::Velocity(index)) => of(index).under("dot"),
        _ => return None,
    })
}

fn named(derived: &Derived, symbol: &Symbol) -> Name {
    if let Some(name) = of_model(&derived.model, symbol) {
        return name;
    }
    let of = |index: &usize| derived.model.coordinates.get(*index).map_or_else(|| Name::of("q"), coordinate);
    match symbol {
        Symbol::Acceleration(index) => of(index).under("ddot"),
        Symbol::Multiplier(index) => {
            let of = derived.model.constraints.get(*index).map(constraint);
            Name::of("lambda").with(of.unwrap_or_default())
        }
        Symbol::Parameter { .. } | Symbol::Continuous(_) | Symbol::Let(_) | Symbol::LetRate(_) | Symbol::Access(_) => {
            Name::of("a")
        }
        Symbol::T0 => Name::of("t0"),
        Symbol::T1 => Name::of("t1"),
        Symbol::Step => Name::of("h"),
        Symbol::E0 => Name::of("E0"),
        Symbol::Q0(index) => of(index).with("0"),
        Symbol::Q1(index) => of(index).with("1"),
        Symbol::Momentum(index) => Name::of("p").with(of(index).text()),
        Symbol::P0(index) => Name::of("p0").with(of(index).text()),
        Symbol::StepVelocity(index) => Name::of("v").with(of(index).text()),
        Symbol::Low(low) => {
            let name = named(derived, low);
            Name { letter: format!("\\delta {}", name.letter), ..name }
        }
        Symbol::AtPoint(point, variable) => {
            let name = named(derived, &Symbol::Continuous(*variable));
            if derived.system.points() == 1 { name.under("bar") } else { name.with(format!("({})", point + 1)) }
        }
        Symbol::Field(field) => self::field(derived, field),
    }
}

/// `L_{\dot{x}}`, `f_{x,\dot{x}}`; `L^{(1)}_{\dot{x}}` in braces if the rule has several points.
fn field(derived: &Derived, Field { quantity, derivatives, point }: &Field) -> Name {
    let by: String = derivatives
        .iter()
        .map(|variable| named(derived, &Symbol::Continuous(*variable)).text())
        .collect::<Vec<_>>()
        .join(" ");
    let (letter, mut indices) = match quantity {
        Quantity::Lagrangian => ("L", Vec::new()),
        Quantity::Force(index) => {
            let component = derived.model.coordinates.get(*index).map(|of| coordinate(of).text());
            ("f", component.into_iter().collect())
        }
    };
    if !by.is_empty() {
        indices.push(by);
    }
    let several = derived.system.points() > 1;
    let letter = if several { format!("{{{letter}^{{({})}}}}", point + 1) } else { letter.to_owned() };
    Name { letter, indices }
}
