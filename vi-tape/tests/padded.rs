//! Numbers of coordinates between those that are built: the others are at rest.

use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_erased::section::{Direction, Section, Watch};
use vi_erased::simulation::Row;
use vi_erased::system::Quantity;
use vi_tape::System;

/// A chain of this many masses on springs, each with a quartic term, the last one with friction.
fn chain(size: usize) -> String {
    let last = size - 1;
    format!(
        "struct Chain {{ param k = 1.3; input u = 0.2; coord q[{size}];
            L = sum(i in 0..{size}, dot(q[i])^2) / 2 - k * (q[0]^2 + sum(i in 1..{size}, (q[i] - q[i - 1])^2)) / 2
                - sum(i in 0..{size}, q[i]^4) / 4 + sum(i in 1..{size}, dot(q[i]) * dot(q[i - 1]) * cos(q[i])) / 10;
            force q[{last}] = u - 0.01 * dot(q[{last}]); discretize midpoint; }}"
    )
}

/// The same with further masses that neither move nor act.
fn wide(size: usize, all: usize) -> String {
    let more = all - size;
    chain(size)
        .replace(&format!("coord q[{size}]"), &format!("coord q[{size}], z[{more}]"))
        .replace("L = ", &format!("L = sum(i in 0..{more}, dot(z[i])^2) / 2 + "))
}

#[test]
fn further_coordinates_are_at_rest() {
    let mut met = 0;
    for (size, all) in [(1, 2), (3, 4), (5, 8), (7, 8)] {
        let (narrow, wide) = (System::parse(&chain(size)), System::parse(&wide(size, all)));
        let (narrow, wide) = (narrow.expect("a chain"), wide.expect("a chain"));
        assert_eq!(narrow.coordinates(), wide.coordinates()[..size]);
        assert_eq!(narrow.coordinates().len(), size);
        #[allow(clippy::cast_precision_loss)] // few
        let q: Vec<f64> = (0..size).map(|i| 0.3 - 0.05 * i as f64).collect();
        let v: Vec<f64> = q.iter().map(|q| 0.4 - q).collect();
        let full = |of: &[f64]| [of, &vec![0.0; all - size]].concat();
        for (method, stages) in [
            (Method::Fixed, None),
            (Method::KahanLi6, None),
            (Method::Energy, None),
            (Method::Gauss, Some(4)),
            (Method::Energy, Some(2)),
        ] {
            let plan = |q: &[f64], v: &[f64]| Plan {
                stages,
                ..Plan::new(method, 0.02, PhasePoint { t: 0.0, q: q.to_vec(), v: v.to_vec() })
            };
            let mut run = narrow.begin(&plan(&q, &v)).expect("a start");
            let mut other = wide.begin(&plan(&full(&q), &full(&v))).expect("a start");
            run.advance_by(30).expect("steps");
            other.advance_by(30).expect("steps");
            let [row, of_all] = [run.row(), other.row()];
            let or_zero = Option::<f64>::unwrap_or_default;
            let numbers = |of: &Row| {
                let vectors = of.q.iter().take(size).chain(of.p.iter().take(size)).copied();
                [of.t, of.h, or_zero(of.energy), or_zero(of.discrete_energy)]
                    .into_iter()
                    .chain(vectors)
                    .collect::<Vec<_>>()
            };
            // Sums of L have other terms, which round differently.
            let off = numbers(&row).into_iter().zip(numbers(&of_all)).map(|(one, other)| (one - other).abs());
            let off = off.fold(0.0, f64::max);
            // Lengths of steps multiply roundings: 1.1e-9; the others 1.2e-16.
            let allowed = if method == Method::Energy { 1e-8 } else { 1e-15 };
            assert!(off <= allowed, "{method:?}: {off:e}");
            assert!(of_all.q[size..].iter().chain(&of_all.p[size..]).all(|entry| *entry == 0.0), "they are at rest");
            // Functions of events take the declared coordinates.
            let g = move |_: f64, q: &[f64], v: &[f64]| {
                assert_eq!((q.len(), v.len()), (size, size));
                q[0] - 0.2
            };
            let sections = [Section::Function(Watch::new(g), Direction::Both)];
            run.cross(&sections, 4.0, &mut |found| {
                assert_eq!((found.row.q.len(), found.row.p.len()), (size, size));
                assert!((found.row.q[0] - 0.2).abs() < 1e-12);
                met += 1;
                true
            })
            .expect("a motion");
        }
        let (mut of_few, mut of_all) = (Vec::new(), Vec::new());
        for quantity in [Quantity::Energy, Quantity::Momentum, Quantity::Force, Quantity::Acceleration] {
            of_few.clear();
            of_all.clear();
            narrow.evaluate(quantity, [&[0.0], &q, &v], &mut of_few).expect("a value");
            wide.evaluate(quantity, [&[0.0], &full(&q), &full(&v)], &mut of_all).expect("a value");
            let off = of_few.iter().zip(&of_all).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-15, "{quantity:?}: {off:e}");
            assert_eq!(of_few.len(), if quantity == Quantity::Energy { 1 } else { size });
        }
        assert!(
            narrow.begin(&Plan::new(Method::Gauss, 0.1, PhasePoint { t: 0.0, q: full(&q), v: v.clone() })).is_err()
        );
    }
    assert!(met > 10, "{met}");
}

#[test]
fn messages_name_no_coordinate_at_rest() {
    let text = "struct Steep { coord x; L = dot(x)^2 / 2 - x^40; }";
    let system = System::parse(text).expect("a system");
    let point = PhasePoint { t: 0.0, q: vec![1e9], v: vec![0.0] };
    let refused = system.begin(&Plan { stages: Some(4), ..Plan::new(Method::Gauss, 0.1, point) });
    let failure = refused.and_then(|mut run| run.advance_by(1)).expect_err("an overflow").to_string();
    assert!(failure.ends_with("because `dot(x)^2/2 - x^40` is not"), "{failure}");
}
