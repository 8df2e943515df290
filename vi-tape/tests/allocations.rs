//! Steps of a text allocate nothing once their registers are there.

use allocation_counter::measure;
use vi_erased::plan::{Method, PhasePoint, Plan};

#[test]
fn steps_do_not_allocate() {
    // Its functions need more registers than the stack has.
    let text = "struct Two { param m = 1.2; coord a, b;
        L = m * (dot(a)^2 + dot(b)^2 / 2 + dot(a) * dot(b) * cos(a - b)) + 9.8 * (2 * cos(a) + cos(b)) * (1 + sin(a * b) / 9);
        discretize midpoint; }";
    let system = vi_tape::System::parse(text).expect("a system");
    let (mut first, mut count) = (0, 0);
    for (method, stages) in
        [(Method::Fixed, None), (Method::KahanLi6, None), (Method::Energy, None), (Method::Gauss, Some(4))]
    {
        let start = PhasePoint { t: 0.0, q: vec![0.5, 0.2], v: vec![0.0, 0.1] };
        let mut run = system.begin(&Plan { stages, ..Plan::new(method, 0.01, start) }).expect("a start");
        first += measure(|| assert!(run.advance_by(10).is_ok())).count_total;
        // A call takes the run out of its box, with its buffers: at most 5.
        let later = [200, 400].map(|steps| measure(|| assert!(run.advance_by(steps).is_ok())).count_total);
        assert!(later[0] == later[1] && later[0] <= 5, "{method:?}: {later:?}");
        count += 1;
    }
    assert!(count == 4 && first > 0, "the counter counts: {first}");
}
