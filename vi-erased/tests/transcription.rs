//! Optimal control as a nonlinear program: its derivatives are those of differences, its rows those of runs.

use vi_erased::function::{Function, Points};
use vi_erased::transcription::{Mesh, Pattern, Transcription};
use vi_erased::{Method, Plan, System, kind};
use vi_systems::{ParametricPendulum, RodPendulum};

/// q² v + u sin(t) v² of one coordinate and one input, the parameter 1.
struct Cost;

impl Function for Cost {
    fn at(&self, points: &Points<'_>, order: u8) -> Vec<f64> {
        let count = points.parameters.len() / points.t.len();
        let each = points.t.iter().zip(points.q.iter().zip(points.v)).enumerate();
        let at = each.flat_map(|(k, (t, (q, v)))| {
            let ((sine, cosine), u) = (t.sin_cos(), points.parameters[k * count + 1]);
            match order {
                0 => vec![q * q * v + u * sine * v * v],
                1 => vec![u * cosine * v * v, 2.0 * q * v, q * q + 2.0 * u * sine * v, sine * v * v],
                _ => [
                    [-u * sine * v * v, 0.0, 2.0 * u * cosine * v, cosine * v * v],
                    [0.0, 2.0 * v, 2.0 * q, 0.0],
                    [2.0 * u * cosine * v, 2.0 * q, 2.0 * u * sine, 2.0 * sine * v],
                    [cosine * v * v, 0.0, 2.0 * sine * v, 0.0],
                ]
                .concat(),
            }
        });
        at.collect()
    }
}

/// The entries of a sparse matrix as a dense one, row by row.
fn dense(pattern: &Pattern, entries: &[f64], width: usize) -> Vec<Vec<f64>> {
    let height = pattern.rows.iter().max().map_or(0, |last| last + 1);
    let mut rows = vec![vec![0.0; width]; height];
    for ((row, column), entry) in pattern.places().zip(entries) {
        rows[row][column] = *entry;
    }
    rows
}

/// Everything varies: a free duration, an explicit time, an input in a momentum.
fn problem() -> Transcription {
    let system = kind!(ParametricPendulum, { gauss 4 });
    let mesh = Mesh { start: 0.3, shares: vec![0.0, 0.3, 0.5, 1.0], duration: [0.5, 5.0] };
    let mut of = Transcription::of(&*system, &Plan::anywhere(Method::Gauss, Some(4)), mesh, &[1]).expect("a program");
    of.set_cost(Box::new(Cost));
    of.set_final_cost(Box::new(Cost));
    of.bound_velocity(0, &[0, 3], [0.0, 0.0]);
    of.bound(Box::new(Cost), &[0, 1, 2, 3], [-1.0, 1.0]);
    of
}

#[test]
fn derivatives_are_those_of_differences() {
    let of = problem();
    let size = of.bounds().len();
    let numbers = || core::iter::successors(Some(0.0), |k: &f64| Some(k + 1.0));
    let x: Vec<f64> = numbers().take(size).map(|k| 0.9 + 0.7 * (3.0 * k).sin()).collect();
    let count = of.row_bounds().len();
    assert_eq!((size, count), (1 + 3 * 3 + 2, 6 + 2 + 4));
    let multipliers: Vec<f64> = numbers().take(count).map(|k| (5.0 * k).cos()).collect();
    let here = of.evaluate(&x);
    assert!(here.error.is_none() && here.cost.abs() > 0.1);
    let jacobian = dense(of.jacobian_pattern(), &here.jacobian, size);
    let hessian = dense(of.hessian_pattern(), &of.hessian(&x, 0.7, &multipliers), size);
    for column in 0..size {
        let moved = |by: f64| {
            let mut x = x.clone();
            x[column] += by;
            of.evaluate(&x)
        };
        let (above, below) = (moved(1e-5), moved(-1e-5));
        let difference = |above: f64, below: f64| (above - below) / 2e-5;
        assert!((difference(above.cost, below.cost) - here.gradient[column]).abs() < 1e-8);
        for (row, slopes) in jacobian.iter().enumerate() {
            assert!((difference(above.rows[row], below.rows[row]) - slopes[column]).abs() < 1e-8, "{row} {column}");
        }
        let [above_rows, below_rows] = [&above, &below].map(|of_x| dense(of.jacobian_pattern(), &of_x.jacobian, size));
        for row in 0..=column {
            let weighted = |rows: &[Vec<f64>]| rows.iter().zip(&multipliers).map(|(slope, by)| slope[row] * by).sum();
            let curvature = 0.7 * difference(above.gradient[row], below.gradient[row])
                + difference(weighted(&above_rows), weighted(&below_rows));
            let found = hessian[row][column];
            assert!((curvature - found).abs() < 1e-7, "{row} {column}: {curvature} {found}");
        }
    }
    assert!(hessian.iter().enumerate().all(|(row, entries)| entries[..row].iter().all(|below| *below == 0.0)));
}

#[test]
fn a_run_satisfies_its_steps() {
    let of = problem();
    let x = of.rolled_out(2.0, (&[0.7], &[0.2]), &[0.1, 0.2, 0.3]).expect("a run");
    assert_eq!(x.len(), of.bounds().len());
    assert!(of.evaluate(&x).rows[..6].iter().all(|row| *row == 0.0));
    // The end of the second step is the start of the third one.
    assert_eq!(x[of.place(2, 0)].to_bits(), x[1 + 2 * 3].to_bits());
    assert_eq!([of.place(3, 2), of.place(2, 2), of.place(3, 3)], [1 + 2 * 3 + 2, 1 + 2 * 3 + 2, 0]);
}

#[test]
fn what_has_no_given_steps_is_refused() {
    let system = kind!(ParametricPendulum, { gauss 4; energy 2 });
    let refused = |system: &dyn System, plan: &Plan, mesh: Mesh, inputs: &[usize]| {
        Transcription::of(system, plan, mesh, inputs).err().map(|error| error.to_string()).expect("an error")
    };
    let (gauss, mesh) = (Plan::anywhere(Method::Gauss, Some(4)), || Mesh::even(4, 1.0..=1.0));
    assert!(refused(&*system, &Plan::anywhere(Method::Energy, Some(2)), mesh(), &[1]).contains("given length"));
    assert!(refused(&*system, &gauss, Mesh::even(4, 2.0..=1.0), &[1]).contains("duration"));
    assert!(refused(&*system, &gauss, Mesh { shares: vec![0.0, 0.5], ..mesh() }, &[1]).contains("from 0 to 1"));
    assert!(refused(&*system, &gauss, mesh(), &[99]).contains("index of an input"));
    let rod = kind!(RodPendulum, { gauss 3 });
    assert!(!refused(&*rod, &Plan::anywhere(Method::Fixed, None), mesh(), &[0]).is_empty());
}
