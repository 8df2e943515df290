//! Every stage of the compiler as text, for users who inspect the compilation of a system.
//!
//! In: the tokens of a `lagrangian!`. Out: the product of one [`Stage`] as text, or the mathematics of the system as an
//! [`Explanation`], in plain text or LaTeX. [`source`] finds the declarations in a file; [`report`] prints a mistake
//! with its line. The macro uses nothing of this.
//!
//! | file | content |
//! |---|---|
//! | `syntax` | the clauses as they were parsed |
//! | `model`, `discrete`, `findings`, `functions` | chapters of the explanation |
//! | `gauss` | a chapter: the equations of a Gauss step |
//! | `loops` | chapters of a large system, and its functions |
//! | `index` | a number in a loop by the user's names |
//! | `explanation` | chapters as text and as LaTeX |
//! | `latex`, `name` | an expression, a symbol in LaTeX |
//! | `unreadable` | text that is not valid Rust |
//! | `program` | the functions, operation by operation |

mod discrete;
mod explanation;
mod findings;
mod functions;
mod gauss;
mod index;
pub mod latex;
mod loops;
mod model;
mod name;
mod program;
pub mod report;
pub mod source;
mod syntax;
pub(crate) mod unreadable;

pub use explanation::{Explanation, Line, Section};

use crate::syntax::parse;
use crate::{Compiled, Derivations, Derived, Loops};
use proc_macro2::TokenStream;
use syn::Result;

/// A stage of the compiler, by its product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The clauses as parsed.
    Syntax,
    /// L and f with all names resolved.
    Model,
    /// L_d, its slot derivatives, the equations of a step.
    Discrete,
    /// The functions as operations.
    Program,
    /// The items that the macro emits.
    Rust,
}

/// The product of a stage as text.
///
/// # Errors
/// The mistakes of the system that the stages up to this one find.
pub fn stage(tokens: TokenStream, stage: Stage) -> Result<String> {
    let system = parse::system(tokens)?;
    if stage == Stage::Syntax {
        return Ok(syntax::text(&system));
    }
    let compiled = Compiled::of(&system)?;
    Ok(match (stage, &compiled) {
        (Stage::Syntax, _) => syntax::text(&system),
        (Stage::Rust, _) => compiled.text()?,
        (Stage::Model, Compiled::Lines(of)) => explanation(of, &[model::sections], &[]).text(),
        (Stage::Discrete, Compiled::Lines(of)) => explanation(of, &[discrete::sections], &[discrete::sections]).text(),
        (Stage::Program, Compiled::Lines(of)) => program::text(of),
        (Stage::Model, Compiled::Loops(of)) => titled(of, loops::model(&system, of)).text(),
        (Stage::Discrete, Compiled::Loops(of)) => titled(of, loops::discrete(of)).text(),
        (Stage::Program, Compiled::Loops(of)) => loops::program(of),
    })
}

/// Properties of a system that integrators require.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Properties {
    /// Whether its motion splits into kicks and drifts: `L = v·M v/2 − V(t, q)` with a constant M, or `H = T(p) + V(t, q)`, and
    /// forces of time and coordinates alone.
    pub is_separable: bool,
    /// Whether its own rule has a step density, which energy-preserving steps of this rule need.
    pub has_step_density: bool,
}

/// The properties of a system that integrators require.
///
/// # Errors
/// The mistakes of the system.
pub fn properties(tokens: TokenStream) -> Result<Properties> {
    let system = parse::system(tokens)?;
    let is_separable = match Compiled::of(&system)? {
        Compiled::Lines(of) => of.own.findings.force_of_position || of.own.findings.canonical_split,
        Compiled::Loops(of) => of.indexed.separable,
    };
    // A written-out rule has a step density.
    let has_step_density = system.rules() > 0 && system.named_rules().first().is_none_or(|rule| rule.step_density);
    Ok(Properties { is_separable, has_step_density })
}

/// The mathematics of a system: L and f, then for each rule the discrete system, findings and costs. Of a large system
/// its recursions and sums in loops, and what follows from their derivatives.
///
/// # Errors
/// The mistakes of the system.
pub fn explain(tokens: TokenStream) -> Result<Explanation> {
    let system = parse::system(tokens)?;
    Ok(match Compiled::of(&system)? {
        Compiled::Lines(of) => {
            let own: [Chapter; 3] = [model::sections, discrete::sections, findings::sections];
            explanation(&of, &own, &[discrete::sections, findings::of_steps])
        }
        Compiled::Loops(of) => {
            let chapters = [loops::model(&system, &of), loops::sums(&of), loops::discrete(&of), loops::findings(&of)];
            titled(&of, chapters.into_iter().flatten().collect())
        }
    })
}

/// The mathematics of a Gauss step with `stages` stages (1 to [`GAUSS_STAGES`]): L and f, then tableau, equations and
/// slots.
///
/// # Errors
/// The mistakes of the system.
pub fn explain_gauss(tokens: TokenStream, stages: usize) -> Result<Explanation> {
    let system = parse::system(tokens)?;
    let stages = stages.clamp(1, GAUSS_STAGES);
    let mut own = match Compiled::of(&system)? {
        Compiled::Lines(derivations) => derivations.own,
        Compiled::Loops(mut of) => {
            let mut sections = loops::model(&system, &of);
            if !of.indexed.model.constraints.is_empty() {
                sections.push(gauss::constrained());
                return Ok(titled(&of, sections));
            }
            sections.extend(gauss::of_loops(&mut of.pool, of.indexed.model.forced, stages));
            return Ok(titled(&of, sections));
        }
    };
    let mut sections = model::sections(&own);
    if own.system.constraints.is_some() {
        sections.push(gauss::constrained());
        return Ok(Explanation { title: own.model.name.to_string(), sections });
    }
    sections.extend(gauss::sections(&mut own, stages));
    Ok(Explanation { title: own.model.name.to_string(), sections })
}

/// Largest number of stages of a Gauss step.
pub const GAUSS_STAGES: usize = 16;

type Chapter = fn(&Derived) -> Vec<Section>;

/// The sections under the default rule, then those under each further rule.
fn explanation(Derivations { own, further }: &Derivations, of_own: &[Chapter], of_further: &[Chapter]) -> Explanation {
    let mut sections: Vec<Section> = of_own.iter().flat_map(|chapter| chapter(own)).collect();
    for derived in further {
        let chapters = of_further.iter().flat_map(|chapter| chapter(derived));
        let head = of_further.first().map(|_| model::further_rule(model::title(&derived.model)));
        sections.extend(head.into_iter().chain(chapters));
    }
    Explanation { title: own.model.name.to_string(), sections }
}

/// Sections of a large system under its name.
fn titled(of: &Loops, sections: Vec<Section>) -> Explanation {
    Explanation { title: of.indexed.model.name.to_string(), sections }
}
