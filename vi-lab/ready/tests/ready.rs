//! Every predefined system starts with every method.

use vi_erased::plan::{Method, PhasePoint, Plan};

#[test]
fn every_entry_starts_and_keeps_its_parameters() {
    for mut entry in vi_ready::systems() {
        let size = entry.system.coordinates().len();
        let name = entry.system.name();
        assert_eq!((entry.q.len(), entry.v.len()), (size, size), "{name}");
        for method in [Method::Fixed, Method::KahanLi6, Method::Gauss, Method::Energy] {
            let start = PhasePoint { t: 0.0, q: entry.q.clone(), v: entry.v.clone() };
            let plan = Plan::new(method, entry.h, start);
            let begun = entry.system.begin(&plan);
            let mut run = begun.unwrap_or_else(|error| panic!("{name}: {error}"));
            let first = run.t();
            for _ in 0..10 {
                run.advance().unwrap_or_else(|error| panic!("{name}, {method:?}: {error}"));
            }
            assert!(run.t() > first && run.evaluations() > 0, "{name}");
        }
        for (parameter, value) in entry.system.parameters() {
            assert!(entry.system.set(parameter, value + 1.0), "{name}: {parameter}");
        }
        assert!(!entry.system.set("no such parameter", 1.0));
    }
}
