//! The mathematics of a system as a text of sections.
//!
//! In: sections of equations and words, each formula in both notations. Out: plain text, or a standalone LaTeX
//! document.

use super::{latex, name};
use crate::Derived;
use crate::symbol::Symbol;
use vi_expr::{Expr, Pool};

/// The mathematics of a system.
pub struct Explanation {
    /// Name of the system.
    pub title: String,
    /// The sections, in order.
    pub sections: Vec<Section>,
}

/// Equations and words under one heading.
pub struct Section {
    /// The heading, plain words.
    pub title: &'static str,
    /// Its equations and words.
    pub lines: Vec<Line>,
}

/// An equation or words.
pub enum Line {
    /// left = right.
    Equation {
        /// Left side in plain text.
        left: String,
        /// Right side in plain text.
        right: String,
        /// Left side in LaTeX.
        left_latex: String,
        /// Right side in LaTeX.
        right_latex: String,
    },
    /// Words, formulas between backticks.
    Words {
        /// With the user's names.
        text: String,
        /// With names in LaTeX.
        latex: String,
    },
}

impl Line {
    /// The equation that gives an expression a name.
    pub(super) fn equation(derived: &Derived, left: (&str, &str), right: Expr) -> Self {
        Self::equation_in(derived, &derived.pool, left, right)
    }

    /// The equation that gives an expression in another pool a name.
    pub(super) fn equation_in(derived: &Derived, pool: &Pool<Symbol>, left: (&str, &str), right: Expr) -> Self {
        let Derived { model, system, .. } = derived;
        Self::Equation {
            left: left.0.to_owned(),
            right: pool.render(right, &|symbol| system.spell(model, symbol)),
            left_latex: left.1.to_owned(),
            right_latex: latex::expression(pool, right, &|symbol| name::latex(derived, symbol)),
        }
    }

    /// One equation per coordinate, its name as an index.
    pub(super) fn equations(derived: &Derived, left: (&str, &str), right: &[Expr]) -> Vec<Self> {
        let named = right.iter().zip(&derived.model.coordinates);
        named
            .map(|(expr, coordinate)| {
                let text = format!("{}_{}", left.0, coordinate.text());
                let latex = name::indexed(left.1, &[&name::coordinate(coordinate).text()]);
                Self::equation(derived, (&text, &latex), *expr)
            })
            .collect()
    }

    /// The nonzero entries of a matrix, and how many there are.
    pub(super) fn matrix(derived: &Derived, left: (&str, &str), rows: &[Vec<Expr>]) -> Vec<Self> {
        let coordinates = &derived.model.coordinates;
        let mut lines = Vec::new();
        for (row, of) in rows.iter().zip(coordinates) {
            for (entry, by) in row.iter().zip(coordinates) {
                if derived.pool.is_zero(*entry) {
                    continue;
                }
                let text = format!("{}_{},{}", left.0, of.text(), by.text());
                let indices = [name::coordinate(of).text(), name::coordinate(by).text()];
                let latex = name::indexed(left.1, &indices.each_ref().map(String::as_str));
                lines.push(Self::equation(derived, (&text, &latex), *entry));
            }
        }
        lines
    }

    /// Words without names.
    pub(super) fn words(text: impl Into<String>) -> Self {
        let text = text.into();
        Self::Words { latex: text.clone(), text }
    }
}

impl Explanation {
    /// The explanation in plain text.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("{}\n", self.title);
        for Section { title, lines } in &self.sections {
            text.extend(["\n", *title, "\n"]);
            for line in lines {
                match line {
                    Line::Equation { left, right, .. } => text.extend(["    ", left, " = ", right, "\n"]),
                    Line::Words { text: words, .. } => text.extend(["    ", words, "\n"]),
                }
            }
        }
        text
    }

    /// The explanation as a LaTeX document.
    #[must_use]
    pub fn latex(&self) -> String {
        let mut text = format!("{PREAMBLE}\\section*{{{}}}\n", latex::plain(&self.title));
        for Section { title, lines } in &self.sections {
            text.extend(["\n\\subsection*{", &words(title), "}\n"]);
            let mut rest = lines.as_slice();
            while let Some(first) = rest.first() {
                let equations = matches!(first, Line::Equation { .. });
                let alike = |line: &&Line| matches!(line, Line::Equation { .. }) == equations;
                let count = rest.iter().take_while(alike).count();
                let (block, others) = rest.split_at(count);
                text.push_str(&if equations { display(block) } else { list(block) });
                rest = others;
            }
        }
        text + "\n\\end{document}\n"
    }
}

/// The head of a document.
const PREAMBLE: &str = "\\documentclass{article}
\\usepackage[a4paper,landscape,margin=15mm]{geometry}
\\usepackage{amsmath}
\\allowdisplaybreaks
\\begin{document}
";

/// Equations below each other.
fn display(lines: &[Line]) -> String {
    let rows: Vec<String> = lines
        .iter()
        .filter_map(|line| match line {
            Line::Equation { left_latex, right_latex, .. } => Some(format!("    {left_latex} &= {right_latex}")),
            Line::Words { .. } => None,
        })
        .collect();
    format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", rows.join(" \\\\\n"))
}

/// Words as a list.
fn list(lines: &[Line]) -> String {
    let rows = lines.iter().filter_map(|line| match line {
        Line::Words { latex, .. } => Some(format!("    \\item {}\n", words(latex))),
        Line::Equation { .. } => None,
    });
    format!("\\begin{{itemize}}\n{}\\end{{itemize}}\n", rows.collect::<String>())
}

/// Words with formulas between backticks.
fn words(text: &str) -> String {
    let parts = text.split('`').enumerate();
    parts.map(|(place, part)| if place % 2 == 1 { format!("${part}$") } else { latex::plain(part) }).collect()
}
