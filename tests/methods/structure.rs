//! Momenta, symplecticity, preserved energy.

use super::spoiled::Fault;
use super::{Case, Node, advance, ensure, fails, holds, largest};
use vi_erased::simulation::Wanted;

/// A momentum of a cyclic coordinate keeps every bit, and a quadratic one stays to rounding.
fn momenta(case: &Case) -> Result<(), String> {
    if case.scene.cyclic.is_none() && case.scene.momentum.is_none() {
        return Ok(());
    }
    let mut run = case.run()?;
    let start = Node::of(&*run);
    let mut moved = 0.0_f64;
    for step in 0..60 {
        advance(&mut *run, 1)?;
        let node = Node::of(&*run);
        moved = moved.max(node.off(&start));
        if let Some(index) = case.scene.cyclic {
            let [now, before] = [&node, &start].map(|node| node.p[index]);
            ensure!(now.to_bits() == before.to_bits(), "step {step}: {now} instead of {before}");
        }
        if let Some(momentum) = case.scene.momentum {
            let change = (momentum(&node.q, &node.p) / momentum(&start.q, &start.p) - 1.0).abs();
            // Measured: 1.2e-15.
            ensure!(change < 4e-15, "step {step}: a momentum changes by {change:e}");
        }
    }
    ensure!(moved > 0.1, "nothing moves: {moved}");
    Ok(())
}

/// The largest change of a product `uᵀJw` of two tangent vectors of the start, relative to the square of their size at the
/// end.
fn defect(start: &[Vec<f64>], end: &[Vec<f64>]) -> f64 {
    let n = end.len() / 2;
    let product = |a: &[f64], b: &[f64]| (0..n).map(|i| a[i] * b[i + n] - a[i + n] * b[i]).sum::<f64>();
    let size = largest(end.iter().flatten().copied()).max(1.0);
    let each = (0..2 * n).flat_map(|i| (0..2 * n).map(move |j| (i, j)));
    largest(each.map(|(i, j)| product(&end[i], &end[j]) - product(&start[i], &start[j]))) / (size * size)
}

/// Whether tangent vectors are those of steps of given lengths.
fn has_fixed_lengths(method: &super::Method) -> bool {
    method.has_equal_steps() || method.follows_motion()
}

/// Maps from node to node are symplectic, and only those of motions without forces by methods whose steps are equal.
fn symplecticity(case: &Case) -> Result<(), String> {
    // With constraints no coordinate moves alone.
    if !case.is_free() {
        return Ok(());
    }
    let after = |steps: u64| {
        let found = case.run()?.tangent(Wanted::after(steps), &mut || true);
        found.map_err(|error| error.to_string())?.ok_or_else(|| String::from("interrupted"))
    };
    let end = after(20)?;
    let unit = |k: usize| (0..end.len()).map(|i| f64::from(u8::from(i == k))).collect();
    // The momenta of a system of first order follow from its coordinates.
    let start = if case.system.is_first_order() { after(0)? } else { (0..end.len()).map(unit).collect() };
    let (defect, is_symplectic) = (defect(&start, &end), case.scene.is_symplectic && has_fixed_lengths(case.method));
    println!("{}: M'JM - J = {defect:.1e}", case.name());
    // Measured: at most 2.2e-15, and at least 4.9e-4.
    ensure!(if is_symplectic { defect < 5e-15 } else { defect > 1e-4 }, "M'JM - J = {defect:e}");
    Ok(())
}

/// Methods that find their length preserve their energy: for steps of one stage that is H at the midpoint.
fn preserved_energy(case: &Case) -> Result<(), String> {
    if !case.method.keeps_energy || !case.system.conserves_energy() {
        return Ok(());
    }
    let mut run = case.run()?;
    advance(&mut *run, 1)?;
    let first = kept_energy(&*run)?;
    let (mut worst, mut lengths) = (0.0_f64, [f64::INFINITY, 0.0_f64]);
    for _ in 0..60 {
        advance(&mut *run, 1)?;
        ensure!(kept_energy(&*run)?.to_bits() == first.to_bits(), "E is {} after {first}", kept_energy(&*run)?);
        if case.method.built.1.is_none() {
            let (_, energy) = run.sampled_energy().map_err(|error| error.to_string())?;
            worst = worst.max((energy - first).abs());
        }
        lengths = [lengths[0].min(run.h()), lengths[1].max(run.h())];
    }
    println!("{}: E off by {worst:.1e}, steps {lengths:?}", case.name());
    // Measured: 8.7e-15 of 10.
    ensure!(worst < 4e-15 * (1.0 + first.abs()), "H at the midpoints is off by {worst:e}");
    ensure!(lengths[1] > 1.001 * lengths[0], "steps of equal length: {lengths:?}");
    Ok(())
}

/// The energy that a run preserves, with its shift.
pub(super) fn kept_energy(run: &dyn vi_erased::Simulation) -> Result<f64, String> {
    run.shifted_energy().map(|of| of.energy).or_else(|| run.discrete_energy()).ok_or_else(|| "no energy".into())
}

#[test]
fn momenta_are_conserved() {
    holds(momenta);
    fails(momenta, "spherical", Fault::Momenta, |_| true);
    fails(momenta, "Kepler", Fault::Momenta, |_| true);
}

#[test]
fn maps_are_symplectic() {
    holds(symplecticity);
    fails(symplecticity, "chain", Fault::Tangent, has_fixed_lengths);
}

#[test]
fn energies_are_preserved() {
    holds(preserved_energy);
    fails(preserved_energy, "coupled", Fault::Kick, |method| method.keeps_energy);
}
