//! Tangent vectors against differences of runs, second derivatives and gradients against tangent vectors, linearizations.

use super::spoiled::Fault;
use super::{Case, Node, advance, ensure, fails, holds, largest};
use vi_core::StepError;
use vi_erased::Simulation;
use vi_erased::plan::{self, PhasePoint};
use vi_erased::simulation::{End, Wanted};
use vi_erased::system::Quantity;

/// Steps of a case: few if rounding of an energy visibly changes a length.
fn steps(case: &Case) -> u64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most twelve
    let of_time = (12.0 / case.method.stretch).ceil() as u64;
    if case.method.keeps_energy { 2 } else { of_time }
}

/// The parameters, by their indices.
fn parameters(case: &Case) -> Vec<usize> {
    (0..case.system.parameters().len()).collect()
}

/// Tangent vectors at an end: changes of (q, p, t), or of (q, v, t) with respect to velocities.
fn tangents(case: &Case, end: End<'_>, has_velocities: bool) -> Result<Vec<Vec<f64>>, String> {
    let wanted = Wanted { end, parameters: &parameters(case), has_velocities: [has_velocities; 2] };
    let found = case.run()?.tangent(wanted, &mut || true);
    found.map_err(|error| error.to_string())?.ok_or_else(|| "interrupted".into())
}

/// Moves the coordinates of a node to the nearest ones on the constraints, where its momenta become those of their
/// velocity.
pub(super) fn nearest(case: &Case, node: &mut Node) -> Result<(), StepError> {
    let still = PhasePoint { t: node.t, q: node.q.clone(), v: vec![0.0; node.q.len()] };
    node.q = case.system.project(&still)?.point.q;
    let evaluated = |of: Quantity, second: &[f64]| {
        let mut found = Vec::new();
        case.system.evaluate(of, [&[node.t], &node.q, second], &mut found).map(|()| found)
    };
    node.p = evaluated(Quantity::Momentum, &evaluated(Quantity::Velocity, &node.p)?)?;
    Ok(())
}

/// The node after some steps from a start that is moved along a direction: a coordinate, a momentum or a parameter.
fn moved(case: &Case, start: &Node, direction: usize, by: f64) -> Result<Vec<f64>, String> {
    let (mut start, n) = (start.clone(), start.q.len());
    let mut system = case.system.copy();
    match direction.checked_sub(n) {
        None => start.q[direction] += by,
        Some(index) if index < n => start.p[index] += by,
        Some(index) => {
            let (name, value) = system.parameters()[index - n];
            system.set(name, value + by);
        }
    }
    let moved = case.of_system(system);
    if !case.is_free() || case.system.is_first_order() {
        nearest(&moved, &mut start).map_err(|error| error.to_string())?;
    }
    let mut run = moved.from(case.h(), &start).map_err(|error| error.to_string())?;
    advance(&mut *run, steps(case))?;
    let end = Node::of(&*run);
    Ok([end.numbers(), vec![end.t]].concat())
}

/// Tangent vectors are differences of runs, with constraints of runs from the nearest states on them.
fn tangent(case: &Case) -> Result<(), String> {
    if !case.method.has_tangents() {
        return Ok(());
    }
    let start = Node::of(&*case.run()?);
    let mut worst = 0.0_f64;
    for (direction, found) in tangents(case, End::Steps(steps(case)), false)?.iter().enumerate() {
        // Steps that find their length are linear over small distances only.
        let by = if case.method.keeps_energy { 1e-5 } else { 1e-3 };
        let ends = [1.0, -1.0, 2.0, -2.0].map(|part| moved(case, &start, direction, part * by));
        let [one, minus, two, minus_two] = ends;
        let (one, minus, two, minus_two) = (one?, minus?, two?, minus_two?);
        let difference = |k: usize| (8.0 * (one[k] - minus[k]) - (two[k] - minus_two[k])) / (12.0 * by);
        let off = largest(found.iter().enumerate().map(|(k, found)| found - difference(k)));
        let size = largest(found.iter().copied());
        // A parameter of the time scale does not change other methods.
        // Momenta of a system of first order follow from its coordinates.
        let is_free = direction < if case.system.is_first_order() { start.q.len() } else { 2 * start.q.len() };
        ensure!(size > 1e-4 || !is_free, "direction {direction} changes nothing");
        worst = worst.max(off / (1.0 + size));
    }
    println!("{}: tangent vectors off by {worst:.1e}", case.name());
    // Measured: at most 4.9e-5, and 1.1e-10 by steps of equal length.
    let allowed = if case.method.keeps_energy { 1e-4 } else { 1e-9 };
    ensure!(worst < allowed, "tangent vectors are off by {worst:e}");
    Ok(())
}

/// A gradient, found by one backward pass, is that of tangent vectors, after steps and at a time between two of them.
fn gradient(case: &Case) -> Result<(), String> {
    let mut plain = case.run()?;
    advance(&mut *plain, steps(case) - 1)?;
    let before = plain.t();
    advance(&mut *plain, 1)?;
    let between = before + 0.3 * (plain.t() - before);
    let mut run = case.run()?;
    gradient_at(case, &mut *run, End::Steps(steps(case)), false)?;
    ensure!(Node::of(&*plain) == Node::of(&*run), "a gradient takes other steps");
    let mut run = case.run()?;
    gradient_at(case, &mut *run, End::Time(between), true)?;
    ensure!(run.t().to_bits() == between.to_bits(), "a gradient ends at {} in place of {between}", run.t());
    Ok(())
}

/// [`gradient`] at one end.
fn gradient_at(case: &Case, run: &mut dyn Simulation, end: End<'_>, has_velocities: bool) -> Result<(), String> {
    let n = case.scene.q.len();
    let slope: Vec<f64> = (0..=2 * n).map(|k| 1.0 - 0.3 * f64::from(u8::try_from(k).unwrap_or(0))).collect();
    let wanted = Wanted { end, parameters: &parameters(case), has_velocities: [has_velocities; 2] };
    let found = run.gradient(wanted, &slope, &mut || true).map_err(|error| error.to_string())?;
    let found = found.ok_or("interrupted")?;
    let tangents = tangents(case, end, has_velocities)?;
    let expected = tangents.iter().map(|of| of.iter().zip(&slope).map(|(of, slope)| of * slope).sum::<f64>());
    let size = largest(tangents.iter().flatten().copied()).max(1.0);
    let off = largest(expected.zip(&found).map(|(one, other)| one - other)) / size;
    println!("{}: the gradient is off by {off:.1e}", case.name());
    // A length follows from a difference of energies, which is smaller with more stages. Measured: 3.8e-15, 1.9e-12,
    // 6.8e-8 and 1.5e-4.
    let allowed = match (case.method.keeps_energy, case.method.built.1) {
        (false, _) => 1e-14,
        (true, None | Some(1)) => 1e-11,
        (true, Some(2)) => 2e-7,
        (true, _) => 4e-4,
    };
    ensure!(off < allowed && found.len() == tangents.len(), "the gradient is off by {off:e}");
    Ok(())
}

/// The linearization of the next step is its tangent map, and the run stays.
fn linearization(case: &Case) -> Result<(), String> {
    let mut run = case.run()?;
    // At the start of a run tangent vectors change the energy that it keeps.
    advance(&mut *run, 1)?;
    let (before, found) = (run.row(), run.linearization());
    ensure!(run.row() == before, "a linearization changes the run");
    let found = found.map_err(|error| error.to_string())?;
    let mut next = run.copy();
    advance(&mut *next, 1)?;
    let end = Node::of(&*next).numbers();
    let off = largest(end.iter().zip(&found.value).map(|(one, other)| one - other));
    ensure!(off < 1e-14, "the next node is off by {off:e}");
    let columns =
        run.tangent(Wanted::after(1), &mut || true).map_err(|error| error.to_string())?.ok_or("interrupted")?;
    let n = end.len();
    let entry = |row: usize, column: usize| columns[column][row] - found.a[row * n + column];
    let off = largest((0..n).flat_map(|row| (0..n).map(move |column| (row, column))).map(|(r, c)| entry(r, c)));
    let size = largest(columns.iter().flatten().copied());
    ensure!(off < 1e-11 * size, "the tangent map is off by {off:e} of {size}");
    Ok(())
}

/// Whether a method has exact second derivatives of its steps.
fn has_curvature(method: &super::Method) -> bool {
    use plan::Method::{Fixed, Gauss, KahanLi6, KahanLi8, Suzuki4};
    matches!(method.built, (Fixed | Suzuki4 | KahanLi6 | KahanLi8 | Gauss, _, false))
}

/// The gradient of the weighted end of a run from a start that is moved along a direction: a coordinate, a momentum, a
/// parameter, the length of the step or the time.
fn gradient_of_end(
    case: &Case,
    start: &Node,
    wanted: Wanted<'_>,
    direction: usize,
    by: f64,
) -> Result<Vec<f64>, String> {
    let (mut at, mut h, mut system, n) = (start.clone(), case.h(), case.system.copy(), start.q.len());
    match direction.checked_sub(2 * n) {
        None if direction < n => at.q[direction] += by,
        None => at.p[direction - n] += by,
        Some(index) if index < system.parameters().len() => {
            let (name, value) = system.parameters()[index];
            system.set(name, value + by);
        }
        Some(index) if index == system.parameters().len() => h += by,
        Some(_) => at.t += by,
    }
    let mut run = case.of_system(system).from(h, &at).map_err(|error| error.to_string())?;
    let rows = run.tangent(wanted, &mut || true).map_err(|error| error.to_string())?.ok_or("interrupted")?;
    Ok(rows.iter().map(|row| row.iter().zip(weights(n)).map(|(entry, weight)| entry * weight).sum()).collect())
}

/// Weights of the numbers of an end.
fn weights(n: usize) -> Vec<f64> {
    (0..2 * n).map(|k| 1.0 - 0.3 * f64::from(u8::try_from(k).unwrap_or(0))).collect()
}

/// Second derivatives are differences of tangent vectors, for the methods and systems that have them.
fn curvature(case: &Case) -> Result<(), String> {
    if !case.method.has_tangents() {
        return Ok(());
    }
    let start = Node::of(&*case.run()?);
    let (n, count) = (start.q.len(), case.system.parameters().len());
    // Behind the parameters are the length of the step and the time of the start.
    let parameters: Vec<usize> = (0..count + 2).collect();
    let columns = 2 * n + count + 2;
    for (steps, has_velocities) in [(1, false), (1, true), (0, true)] {
        let wanted =
            Wanted { end: End::Steps(steps), parameters: &parameters, has_velocities: [false, has_velocities] };
        let found = case.run()?.curvature(wanted, &weights(n)).map_err(|error| error.to_string())?;
        let are_exact = case.is_free() && !case.system.is_first_order() && (steps == 0 || has_curvature(case.method));
        ensure!(found.is_some() == are_exact, "second derivatives: {found:?}");
        let Some(found) = found else { continue };
        let mut worst = 0.0_f64;
        for (direction, own) in found.chunks(columns).enumerate() {
            let by = if direction == 2 * n + count { 1e-3 * case.h() } else { 1e-3 };
            let ends = [1.0, -1.0, 2.0, -2.0].map(|part| gradient_of_end(case, &start, wanted, direction, part * by));
            let [one, minus, two, minus_two] = ends;
            let (one, minus, two, minus_two) = (one?, minus?, two?, minus_two?);
            let difference = |k: usize| (8.0 * (one[k] - minus[k]) - (two[k] - minus_two[k])) / (12.0 * by);
            let off = largest(own.iter().enumerate().map(|(k, found)| found - difference(k)));
            worst = worst.max(off / (1.0 + largest(own.iter().copied())));
        }
        println!("{}: second derivatives after {steps} steps are off by {worst:.1e}", case.name());
        // Measured: at most 2.7e-10.
        ensure!(worst < 1e-9, "second derivatives are off by {worst:e}");
    }
    Ok(())
}

#[test]
fn tangent_vectors_are_differences() {
    holds(tangent);
    fails(tangent, "coupled", Fault::Tangent, super::Method::has_tangents);
}

#[test]
fn gradients_are_those_of_tangent_vectors() {
    holds(gradient);
    fails(gradient, "coupled", Fault::Tangent, |_| true);
}

#[test]
fn second_derivatives_are_differences_of_tangent_vectors() {
    holds(curvature);
    fails(curvature, "coupled", Fault::Curvature, has_curvature);
}

#[test]
fn linearizations_are_tangent_maps() {
    holds(linearization);
    fails(linearization, "coupled", Fault::Tangent, |_| true);
}
