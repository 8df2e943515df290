//! The facts and functions of a system that its traits provide.

use crate::lines::Lines;
use crate::tables::Tables;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::OnceLock;
use vi_core::lagrangian::Space;
use vi_core::linear::{AnyForm, Block};
use vi_core::table::AnyTable;
use vi_dispatch::Instructions;

macro_rules! functions {
    ($(#[$about:meta])* $all:ident { $($name:ident),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default)]
        pub(crate) struct $all { $(pub(crate) $name: Lines),* }
    };
}

functions!(
    /// The functions of a motion, by the names of the traits. Those that a system does not have are empty.
    Functions {
    lagrangian,
    energy,
    momentum,
    force,
    acceleration,
    point,
    sides,
    applied_force,
    point_derivatives,
    power,
    scaled_point,
    non_finite,
    undefined,
    applied,
    constraints,
    constraint_gradients,
    constraint_rate_derivatives,
    reaction_derivatives,
});

functions!(
    /// The functions of the steps by a rule.
    StepFunctions {
    ld,
    d1_ld,
    d2_ld,
    d3_ld,
    d4_ld,
    fd_minus,
    fd_plus,
    gd_minus,
    gd_plus,
    momentum_equation,
    momentum_residual,
    momentum_derivatives,
    discrete_energy,
    step_density,
    extended_system,
    extended_residual,
    extended_derivatives,
});

/// The equations of a step by a rule.
#[derive(Clone, Debug, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct ByRule {
    pub(crate) jacobian: AnyForm,
    pub(crate) has_constant_jacobian: bool,
    pub(crate) has_closed_form: bool,
    pub(crate) is_inlined: bool,
    pub(crate) functions: StepFunctions,
    /// Whether the equations are too large; then there are no functions.
    pub(crate) is_too_large: bool,
}

/// The columns of the nonzeros of each row, ascending.
pub(crate) type Columns = &'static [&'static [usize]];

/// The constraints of a system. The matrices of such a system store the nonzeros of each row: the index of an entry is
/// its place among these, not its column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constraints {
    /// The names of the constraints, the holonomic ones first.
    pub(crate) names: &'static [&'static str],
    pub(crate) holonomic: usize,
    pub(crate) has_point_masses: bool,
    /// The order of elimination.
    pub(crate) blocks: &'static [Block],
    pub(crate) mass: Columns,
    pub(crate) point_matrix: Columns,
    pub(crate) gradients: Columns,
    pub(crate) rate_derivatives: Columns,
    pub(crate) reaction_derivatives: Columns,
}

/// A call of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Call {
    /// The call as it is written.
    pub(crate) text: &'static str,
    pub(crate) table: &'static AnyTable,
    /// Number of arguments: two for a grid, otherwise one.
    pub(crate) arguments: usize,
}

/// An initial state with its step and its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Step, positive.
    pub h: f64,
    /// Values of parameters that differ from the defaults, by their names.
    pub parameters: Vec<(&'static str, f64)>,
}

/// A system.
#[derive(Clone, Debug)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct Code {
    pub(crate) name: &'static str,
    /// The number of coordinates that are built. Those after the declared ones are at rest.
    pub(crate) size: usize,
    pub(crate) about: &'static str,
    pub(crate) definition: &'static str,
    /// The texts of the files of tables, by their paths.
    pub(crate) files: BTreeMap<PathBuf, String>,
    /// The declared coordinates.
    pub(crate) coordinates: Box<[&'static str]>,
    pub(crate) parameters: &'static [&'static str],
    pub(crate) parameters_about: &'static [&'static str],
    /// The values of the parameters by default.
    pub(crate) defaults: Box<[f64]>,
    pub(crate) inputs: &'static [usize],
    pub(crate) spaces: Box<[Space]>,
    pub(crate) cyclic: Box<[bool]>,
    /// The state of its checks.
    pub(crate) start: Option<Start>,
    /// The expressions whose values `non_finite` computes.
    pub(crate) watched: Box<[&'static str]>,
    /// The calls of tables in L and f, whose arguments `undefined` computes.
    pub(crate) calls: Box<[Call]>,
    pub(crate) tables: Tables,
    pub(crate) digest_of_tables: u32,
    /// The name of a monotone table in L.
    pub(crate) monotone_table: Option<&'static str>,
    pub(crate) is_autonomous: bool,
    pub(crate) is_forced: bool,
    pub(crate) is_separable: bool,
    pub(crate) splits: bool,
    pub(crate) is_quadratic: bool,
    /// For each coordinate, whether L does not contain its velocity; empty unless L is linear in the velocities.
    pub(crate) without_velocity: &'static [bool],
    pub(crate) has_constant_mass: bool,
    pub(crate) is_curvilinear: bool,
    pub(crate) scales_time: bool,
    /// Whether there are fixed steps.
    pub(crate) has_rule: bool,
    /// Whether there are energy-preserving steps of order 2.
    pub(crate) has_step_density: bool,
    /// The constraints; `None` for a free system.
    pub(crate) constraints: Option<Constraints>,
    pub(crate) mass: AnyForm,
    pub(crate) point_matrix: AnyForm,
    pub(crate) functions: Functions,
    pub(crate) instructions: Instructions,
    /// The equations of a step by the rule: the largest part of a code, needed by few methods.
    pub(crate) by_rule: OnceLock<ByRule>,
    /// Derives the equations of a step by the rule.
    pub(crate) derive: fn(&Self) -> ByRule,
}

impl Code {
    /// The equations of a step by the rule, derived at the first call.
    #[inline]
    pub(crate) fn by_rule(&self) -> &ByRule {
        self.by_rule.get_or_init(|| (self.derive)(self))
    }
}
