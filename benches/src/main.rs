use std::hint::black_box;
use std::time::Instant;
use vi_benches::hand::{Compensated, Plain, double_well, kepler};
use vi_benches::run::Run;
use vi_core::{FixedStep, State};
use vi_systems::systems::{DoubleWell, Kepler};

fn median(v: &mut Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    v[v.len() / 2]
}

fn race(name: &str, mut rows: Vec<(&str, Box<dyn Run>)>) {
    for (_, r) in &mut rows {
        r.run(1000);
        println!("{:?}", r.state());
    }
    let mut times = vec![vec![]; rows.len()];
    for _ in 0..101 {
        for (i, (_, r)) in rows.iter_mut().enumerate() {
            let s = Instant::now();
            r.run(20000);
            times[i].push(s.elapsed().as_nanos() as f64 / 20000.0);
        }
    }
    for (i, (n, _)) in rows.iter().enumerate() {
        println!("{name} {n}: {:.2} min {:.2}", median(&mut times[i]), times[i][0]);
    }
}

fn main() {
    let tol: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let well = black_box(DoubleWell::default());
    let h = black_box(0.01);
    race(
        "double well",
        vec![
            ("generated", Box::new(FixedStep::new(well, State::at(&well, 0.0, [0.74], [0.0]), h).unwrap())),
            ("plain", Box::new(double_well::Fixed::<Plain>::new(&well, (0.74, 0.0), h, tol))),
            ("compensated", Box::new(double_well::Fixed::<Compensated>::new(&well, (0.74, 0.0), h, tol))),
        ],
    );
    let k = black_box(Kepler::default());
    let (q, v) = ([0.8, 0.0], [0.0, 1.2]);
    race(
        "kepler",
        vec![
            ("generated", Box::new(FixedStep::new(k, State::at(&k, 0.0, q, v), h).unwrap())),
            ("plain", Box::new(kepler::Fixed::<Plain>::new(&k, (q, v), h, tol))),
            ("compensated", Box::new(kepler::Fixed::<Compensated>::new(&k, (q, v), h, tol))),
        ],
    );
}
