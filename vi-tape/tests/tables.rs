//! Tables of a text: the steps of the compiled system, and files that change.

use std::fs;
use vi_core::lagrangian;
use vi_core::lagrangian::Described as _;
use vi_erased::kind;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_tape::System;

lagrangian! {
    /// Two masses with forces from tables of every kind.
    struct Tabled {
        param m = 1.3;
        param c[5] = [0.1, 0.4, -0.2, 0.3, 0.2];
        coord x, y;
        table well(x) = [(-2, 1.0), (-1, 0.2), (0, 0.0), (0.7, 0.3), (1.5, 0.9), (2, 1.6), (3, 2.0)] quintic extend;
        table valley(x in -2..2, y in -2..2) = [[2, 1, 2, 3], [1, 0.2, 1, 2], [1, 0.3, 0.8, 2], [2, 1, 2, 2.5]] extend;
        table drag(v) = [(-3, -1.2), (-1, -0.3), (0, 0.0), (1, 0.3), (3, 1.2)] monotone hold;
        table wind(t in 0..2) = c periodic;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - well(x) - valley(x, y);
        force x = -drag(dot(x)) / 3;
        force y = wind(t);
        discretize midpoint;
    }
}

#[test]
fn every_method_takes_the_steps_of_the_compiled_system() {
    let compiled = kind!(Tabled, { fixed; gauss 4; energy; energy 1 });
    let tape = System::parse(Tabled::<f64>::DEFINITION).unwrap_or_else(|error| panic!("{error}"));
    let mut moved: f64 = 0.0;
    for (method, stages) in [
        (Method::Fixed, None),
        (Method::KahanLi6, None),
        (Method::Gauss, Some(4)),
        (Method::Energy, None),
        (Method::Energy, Some(1)),
    ] {
        let start = PhasePoint { t: 0.1, q: vec![0.3, -0.4], v: vec![0.9, 0.5] };
        let plan = Plan { stages, ..Plan::new(method, 0.02, start) };
        let [one, other] = [&*compiled, &*tape].map(|system| {
            let mut run = system.begin(&plan).unwrap_or_else(|error| panic!("{method:?}: {error}"));
            run.advance_by(30).unwrap_or_else(|error| panic!("{method:?}: {error}"));
            run.row()
        });
        let pairs = one.q.iter().zip(&other.q).chain(one.p.iter().zip(&other.p)).chain([(&one.t, &other.t)]);
        let off = pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        // Compiled Gauss steps fuse products and sums; steps that solve for their length divide roundings by h² D/8.
        let allowed = match (method, stages) {
            (Method::Energy, _) => 1e-9,
            (Method::Gauss, _) => 1e-14,
            _ => 0.0,
        };
        assert!(off <= allowed, "{method:?} {stages:?}: {off:e}");
        moved = moved.max((one.q[0] - 0.3).abs());
    }
    assert!(moved > 0.2, "{moved}");
}

#[test]
fn a_place_outside_is_named() {
    let text =
        "struct Hill { coord x; table h(x) = [(0, 0), (1, 0.2), (2, 0.1), (3, 0)]; L = dot(x)^2 / 2 - h(x + 1); }";
    let system = System::parse(text).unwrap_or_else(|error| panic!("{error}"));
    let start = PhasePoint { t: 0.0, q: vec![1.5], v: vec![1.0] };
    let mut run = system.begin(&Plan::new(Method::Gauss, 0.1, start)).expect("a start");
    let error = run.advance_by(20).expect_err("the end of the table").to_string();
    assert!(error.contains("h(x + 1)") && error.contains("is given for 0 to 3"), "{error}");
}

#[test]
fn a_file_that_changes_is_another_system() {
    let path = std::env::temp_dir().join(format!("vi-tape-{}.csv", std::process::id()));
    let text = format!(
        "struct Spring {{ coord x; table pull(x) = \"{}\"; L = dot(x)^2 / 2; force x = pull(x); }}",
        path.display().to_string().replace('\\', "/")
    );
    let force = |system: &System| {
        let mut out = Vec::new();
        system.evaluate(vi_erased::system::Quantity::Force, [&[0.0], &[0.5], &[0.0]], &mut out).expect("a force");
        out[0]
    };
    let mut kept = Vec::new();
    for slope in [1.0, 2.0] {
        fs::write(&path, format!("x,f\n0,0\n1,{slope}\n2,{}\n", 2.0 * slope)).expect("a file");
        let system = System::parse(&text).unwrap_or_else(|error| panic!("{error}"));
        assert!((force(&system) - 0.5 * slope).abs() < 1e-15);
        kept.push(system);
    }
    // The first one has its own values, and given texts are taken for files.
    assert!((force(&kept[0]) - 0.5).abs() < 1e-15);
    let given = vec![(path.display().to_string(), "0 0\n1 7\n2 14\n".to_owned())];
    let system = System::of_file("definition", &text, &given).unwrap_or_else(|error| panic!("{error}"));
    assert!((force(&system) - 3.5).abs() < 1e-14);
    fs::remove_file(&path).expect("the file can be removed");
    let missing = System::parse(&text).err().expect("no file").to_string();
    assert!(missing.contains("cannot be read from its file"), "{missing}");
}
