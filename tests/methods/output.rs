//! Output at times, dense output, events.

use super::spoiled::Fault;
use super::structure::kept_energy;
use super::{Case, Node, advance, ensure, fails, holds, largest};
use crate::support::slope;
use vi_erased::section::{Direction, Section, Watch};
use vi_erased::{Rows, Simulation};

/// The nodes of rows of n coordinates.
fn nodes(rows: &Rows, n: usize) -> Vec<Node> {
    let states = rows.q.chunks_exact(n).zip(rows.p.chunks_exact(n));
    rows.t.iter().zip(states).map(|(t, (q, p))| Node { t: *t, q: q.to_vec(), p: p.to_vec() }).collect()
}

/// States at given times have these times, leave the steps of the run as they are, and are those where a run to that time
/// ends.
fn times(case: &Case) -> Result<(), String> {
    let mut run = case.run()?;
    let (start, n) = (Node::of(&*run), run.p().len());
    let times: Vec<f64> = (1..=12).map(|k| start.t + 0.83 * case.h() * f64::from(k)).collect();
    let mut rows = Rows::default();
    run.record_at(&times, &mut rows).map_err(|error| error.to_string())?;
    let states = nodes(&rows, n);
    ensure!(states.iter().map(|state| state.t.to_bits()).eq(times.iter().map(|t| t.to_bits())), "times {:?}", rows.t);
    let mut plain = case.run()?;
    while plain.t() < run.t() {
        advance(&mut *plain, 1)?;
    }
    ensure!(plain.row() == run.row(), "output changes the run: {:?} {:?}", plain.row(), run.row());
    if case.method.keeps_energy {
        ensure!(kept_energy(&*plain)?.to_bits() == kept_energy(&*run)?.to_bits(), "output changes the energy");
    }
    // They are as accurate as nodes, and on the constraints.
    let (mut exact, mut of_nodes, mut of_states) = (case.motion(&start)?, 0.0_f64, 0.0_f64);
    let mut nodes = case.run()?;
    while nodes.t() < run.t() {
        advance(&mut *nodes, 1)?;
        of_nodes = of_nodes.max(exact.to(nodes.t())?.off(&Node::of(&*nodes)));
    }
    for state in &states {
        of_states = of_states.max(exact.to(state.t)?.off(state));
        let residual = case.residual(state).map_err(|error| error.to_string())?;
        // Measured: 8.9e-16.
        ensure!(residual < 4e-15, "the state at {} is off the constraints by {residual:e}", state.t);
    }
    println!("{}: states off by {of_states:.1e}, nodes by {of_nodes:.1e}", case.name());
    ensure!(of_states < 3.0 * of_nodes + 1e-12, "states are off by {of_states:e}, nodes by {of_nodes:e}");
    for state in states.iter().step_by(3) {
        let mut alone = case.run()?;
        let (mut taken, mut rows) = (0, Rows::default());
        let outcome = alone.record(Some(state.t), u64::MAX, 1, &mut taken, &mut rows);
        ensure!(outcome == Ok(true), "a run to {}: {outcome:?}", state.t);
        ensure!(Node::of(&*alone) == *state, "a run to {} ends at {:?}, not {state:?}", state.t, Node::of(&*alone));
        // Each node on the way but the last.
        ensure!(rows.t.len() as u64 + 1 == taken, "{} rows of {taken} steps", rows.t.len());
        // Short of it by a whole step, and then to it.
        let mut other = case.run()?;
        while other.t() < state.t {
            other.advance_to(state.t).map_err(|error| error.to_string())?;
        }
        ensure!(other.t().to_bits() == state.t.to_bits(), "a run to {} ends at {}", state.t, other.t());
        let off = Node::of(&*other).off(state);
        ensure!(off < 1e-13, "steps to {} end off by {off:e}", state.t);
    }
    Ok(())
}

/// Dense output of a step has its ends, and the order of the method between them.
fn dense_output(case: &Case) -> Result<(), String> {
    let mut points = Vec::new();
    // Shorter steps than those of other claims where dense output has a lower order than nodes.
    let longest = case.scene.h * if case.method.built.1.is_some() { 0.7 * case.method.stretch } else { 1.0 };
    for part in [1.0, 0.8, 0.6] {
        let mut run = case.with(part * longest).map_err(|error| error.to_string())?;
        advance(&mut *run, 1)?;
        let before = Node::of(&*run);
        advance(&mut *run, 1)?;
        let after = Node::of(&*run);
        let output = run.step_output(before.t, &before.q, &before.p).map_err(|error| error.to_string())?;
        for node in [&before, &after] {
            let [q, p, _] = output.at(node.t);
            let off = Node { t: node.t, q, p }.off(node);
            ensure!(off < 1e-13, "at the end {} off by {off:e}", node.t);
        }
        let mut exact = case.motion(&before)?;
        let mut worst = 0.0_f64;
        for place in [0.2, 0.37, 0.5, 0.81] {
            let t = before.t + place * (after.t - before.t);
            let [q, p, v] = output.at(t);
            let truth = exact.to(t)?;
            let of_velocity = largest(v.iter().zip(exact.v()).map(|(one, other)| one - other));
            worst = worst.max(Node { t, q, p }.off(&truth)).max(of_velocity * (after.t - before.t));
        }
        points.push((part * longest, worst));
    }
    let found = slope(&case.name(), &points, 0.0);
    let is_rounding = points[0].1 < 1e-10;
    ensure!(
        is_rounding || found > 0.78 * f64::from(case.method.dense),
        "order {found} of {}: {points:?}",
        case.method.dense
    );
    Ok(())
}

/// Functions that the motion of a run crosses: of a coordinate, of a velocity, of the time, and a product.
fn sections(case: &Case, run: &dyn Simulation) -> Result<Vec<Section>, String> {
    let (q, v) = (run.q()[0], run.velocity().map_err(|error| error.to_string())?[0]);
    let product = move |_: f64, now: &[f64], speed: &[f64]| now[0] * speed[0] - 0.99 * q * v;
    Ok(vec![
        Section::Coordinate { index: 0, at: q + 0.1 * case.scene.h * v, direction: Direction::Both },
        Section::Velocity { index: 0, at: v * 0.97, direction: Direction::Both },
        Section::Period { start: run.t(), period: 1.7 * case.h() },
        Section::Function(Watch::new(product), Direction::Both),
    ])
}

/// An event is the end of a step of the last length before its function changes its sign; searches one by one and all at
/// once find the same.
fn events(case: &Case) -> Result<(), String> {
    let run = case.run()?;
    let sections = sections(case, &*run)?;
    let end = run.t() + 12.3 * case.h();
    let mut all = Vec::new();
    let collect = &mut |met: vi_erased::simulation::Met| {
        all.push(met);
        true
    };
    case.run()?.cross(&sections, end, collect).map_err(|error| error.to_string())?;
    ensure!(all.len() > 4, "only {} events", all.len());
    for (index, section) in sections.iter().enumerate() {
        let only = core::slice::from_ref(section);
        let mut run = run.copy();
        let expected: Vec<_> = all.iter().filter(|met| met.events.iter().any(|(of, _)| *of == index)).collect();
        for expected in expected {
            let found = run.next_crossing(only, end).map_err(|error| error.to_string())?;
            let found = found.ok_or_else(|| format!("the event at {} is lost", expected.row.t))?;
            let off = (found.row.t - expected.row.t).abs();
            // The run goes on from each event by another step.
            ensure!(off < 1e-2 * case.h(), "event {index} at {} and {}", found.row.t, expected.row.t);
            ensure!(run.t().to_bits() == found.row.t.to_bits(), "the run is not at its event");
        }
        let rest = run.next_crossing(only, end);
        ensure!(rest == Ok(None), "a further event {index}: {rest:?}");
        ensure!(run.t().to_bits() == end.to_bits(), "a search to {end} ends at {}", run.t());
    }
    // The first event of the coordinate: from the last node before, by bisection of the length of a step.
    let Section::Coordinate { at, .. } = sections[0] else { unreachable!("the first one") };
    let hit = run.copy().next_crossing(&sections[..1], end).map_err(|error| error.to_string())?.ok_or("no event")?;
    let mut before = run.copy();
    loop {
        let mut next = before.copy();
        advance(&mut *next, 1)?;
        if next.t() > hit.row.t {
            break;
        }
        before = next;
    }
    let g = |length: f64| -> Result<(f64, Node), String> {
        let mut run = before.copy();
        run.advance_of(length).map_err(|error| error.to_string())?;
        Ok((run.q()[0] - at, Node::of(&*run)))
    };
    let side = Node::of(&*before).q[0] - at;
    let [mut low, mut high] = [0.0, 1.5 * (hit.row.t - before.t())];
    while high > low * (1.0 + 4.0 * f64::EPSILON) {
        let middle = 0.5 * (low + high);
        if g(middle)?.0 * side > 0.0 { low = middle } else { high = middle }
    }
    let off = (before.t() + low - hit.row.t).abs();
    println!("{}: an event, off by {off:.1e}", case.name());
    // Measured: 2.8e-16.
    ensure!(off < 1e-15, "the event at {} is off by {off:e}", hit.row.t);
    let found = Node { t: hit.row.t, q: hit.row.q, p: hit.row.p };
    let off = g(hit.row.h)?.1.off(&found);
    ensure!(off == 0.0, "the event is not the end of a step of its length: off by {off:e}");
    Ok(())
}

#[test]
fn states_at_times_are_those_of_runs_to_them() {
    holds(times);
    fails(times, "coupled", Fault::Times, |_| true);
    fails(times, "rod", Fault::Times, |_| true);
}

#[test]
fn dense_output_has_its_ends_and_its_order() {
    holds(dense_output);
    fails(dense_output, "coupled", Fault::Dense, |_| true);
}

#[test]
fn events_are_at_the_end_of_their_steps() {
    holds(events);
    fails(events, "coupled", Fault::Event, |_| true);
    fails(events, "coupled", Fault::LostEvent, |_| true);
}
