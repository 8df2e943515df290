//! The discrete system: L_d and its slots in fields at the points of the rule, and the equations of a step.
//!
//! In: a derived system. Out: sections of an explanation. `L_v_x` is the derivative ∂L/∂v_x at the point of the rule.

use super::explanation::{Line, Section};
use super::name;
use crate::Derived;
use crate::discrete::{Equations, SlotDerivatives};
use crate::model::{DiscreteForces, Point};
use crate::symbol::Symbol;

/// Points, slots, equations of a step.
pub(super) fn sections(derived: &Derived) -> Vec<Section> {
    if derived.system.constraints.is_some() {
        return Vec::new();
    }
    let Some(of) = &derived.system.by_rule else {
        return vec![without_rule()];
    };
    let points = of.slots.points.iter().enumerate().flat_map(|(index, point)| at(derived, index, point)).collect();
    vec![
        Section { title: "Where L and f are evaluated", lines: points },
        Section { title: "Discrete Lagrangian and its slot derivatives", lines: derivatives(derived, &of.slots) },
        forces(derived, &of.slots.forces),
        Section {
            title: "Equations of a step in v and h: residual and its derivatives",
            lines: residual(derived, &of.equations),
        },
        Section {
            title: "Energy row, combined with the residual, and its derivatives over h",
            lines: energy(derived, &of.equations),
        },
        Section { title: "Increments of momentum and energy", lines: increments(derived, &of.equations) },
    ]
}

/// The section of a system without a rule.
pub(super) fn without_rule() -> Section {
    let none = Line::words("None: the system is declared without a rule and takes Gauss steps");
    Section { title: "Discrete Lagrangian", lines: vec![none] }
}

/// The arguments of L and f at a point of the rule.
fn at(derived: &Derived, index: usize, point: &Point) -> Vec<Line> {
    point
        .arguments()
        .map(|(variable, argument)| {
            let symbol = Symbol::AtPoint(index, variable);
            let text = derived.system.spell(&derived.model, &symbol);
            Line::equation(derived, (&text, &name::latex(derived, &symbol)), argument)
        })
        .collect()
}

fn derivatives(derived: &Derived, of: &SlotDerivatives) -> Vec<Line> {
    let mut lines =
        vec![Line::equation(derived, ("L_d", "L_d"), of.ld), Line::equation(derived, ("D1 L_d", "D_1 L_d"), of.d1_ld)];
    lines.extend(Line::equations(derived, ("(D2 L_d)", "(D_2 L_d)"), &of.d2_ld));
    lines.push(Line::equation(derived, ("D3 L_d", "D_3 L_d"), of.d3_ld));
    lines.extend(Line::equations(derived, ("(D4 L_d)", "(D_4 L_d)"), &of.d4_ld));
    lines
}

fn forces(derived: &Derived, of: &DiscreteForces) -> Section {
    let title = "Discrete forces and powers";
    if !derived.model.forced {
        return Section { title, lines: vec![Line::words("None: no force acts")] };
    }
    let mut lines = Line::equations(derived, ("(f_d⁻)", "(f_d^-)"), &of.fd_minus);
    lines.extend(Line::equations(derived, ("(f_d⁺)", "(f_d^+)"), &of.fd_plus));
    lines.push(Line::equation(derived, ("g_d⁻", "g_d^-"), of.gd_minus));
    lines.push(Line::equation(derived, ("g_d⁺", "g_d^+"), of.gd_plus));
    Section { title, lines }
}

fn residual(derived: &Derived, of: &Equations) -> Vec<Line> {
    let mut lines = Line::equations(derived, ("r", "r"), &of.residual);
    lines.extend(Line::matrix(derived, ("A", "A"), &of.residual_dv));
    lines.extend(Line::equations(derived, ("(∂r/∂h)", "(\\partial r/\\partial h)"), &of.residual_dh));
    lines
}

fn energy(derived: &Derived, of: &Equations) -> Vec<Line> {
    let mut lines = vec![Line::equation(derived, ("c", "c"), of.energy_residual)];
    lines.extend(Line::equations(derived, ("(c_v)", "(c_v)"), &of.energy_dv));
    lines.push(Line::equation(derived, ("c_h", "c_{h}"), of.energy_dh));
    lines
}

fn increments(derived: &Derived, of: &Equations) -> Vec<Line> {
    let mut lines = Line::equations(derived, ("(p1 − p0)", "(p_1 - p_0)"), &of.momentum_increment);
    lines.push(Line::equation(derived, ("E1 − E0", "E_1 - E_0"), of.energy_increment));
    lines
}
