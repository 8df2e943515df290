use std::hint::black_box;
use std::time::Instant;
use vi_benches::hand::{Compensated, Plain, double_well, kepler};
use vi_benches::run::Run;
use vi_core::{FixedStep, State};

fn median(v: &mut Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    v[v.len() / 2]
}

fn race(name: &str, rows: Vec<(&str, Box<dyn Run>)>) { race_(name, rows, if name.starts_with("chain") {100} else {20000}) }
#[allow(non_snake_case)] fn race_(name: &str, mut rows: Vec<(&str, Box<dyn Run>)>, ROUND: usize) {
    for (_, r) in &mut rows {
        r.run(1000);
        let s = r.state(); println!("{:?}", &s[..s.len().min(5)]);
    }
    let mut times = vec![vec![]; rows.len()];
    for _ in 0..31 {
        for (i, (_, r)) in rows.iter_mut().enumerate() {
            let s = Instant::now();
            r.run(ROUND);
            times[i].push(s.elapsed().as_nanos() as f64 / ROUND as f64);
        }
    }
    for (i, (n, _)) in rows.iter().enumerate() {
        println!("{name} {n}: {:.2} min {:.2}", median(&mut times[i]), times[i][0]);
    }
}


use vi_benches::hand::{double_pendulum, chain as hc, oscillator};
use vi_benches::{chain, dense};
use vi_core::EnergyPreserving;
use vi_systems::systems::*;

fn main() {
    let tol: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let well = black_box(DoubleWell::default());
    let h = black_box(0.01);
    race("double well", vec![
        ("generated", Box::new(FixedStep::new(well, State::at(&well, 0.0, [0.74], [0.0]), h).unwrap())),
        ("plain", Box::new(double_well::Fixed::<Plain>::new(&well, (0.74, 0.0), h, tol))),
        ("compensated", Box::new(double_well::Fixed::<Compensated>::new(&well, (0.74, 0.0), h, tol))),
    ]);
    race("double well EP", vec![
        ("generated", Box::new(EnergyPreserving::from_midpoint(well, 0.0, [0.74], [0.0], h).unwrap())),
        ("plain", Box::new(double_well::EnergyPreserving::<Plain>::new(&well, (0.74, 0.0), h, tol))),
        ("compensated", Box::new(double_well::EnergyPreserving::<Compensated>::new(&well, (0.74, 0.0), h, tol))),
    ]);
    let k = black_box(Kepler::default());
    let (q, v) = ([0.8, 0.0], [0.0, 1.2]);
    race("kepler", vec![
        ("generated", Box::new(FixedStep::new(k, State::at(&k, 0.0, q, v), h).unwrap())),
        ("plain", Box::new(kepler::Fixed::<Plain>::new(&k, (q, v), h, tol))),
        ("compensated", Box::new(kepler::Fixed::<Compensated>::new(&k, (q, v), h, tol))),
    ]);
    race("kepler EP", vec![
        ("generated", Box::new(EnergyPreserving::from_midpoint(k, 0.0, q, v, h).unwrap())),
        ("plain", Box::new(kepler::EnergyPreserving::<Plain>::new(&k, (q, v), h, tol))),
        ("compensated", Box::new(kepler::EnergyPreserving::<Compensated>::new(&k, (q, v), h, tol))),
    ]);
    let k = black_box(DoublePendulum::default());
    let (q, v) = ([0.3, 0.2], [0.0, 0.1]);
    race("dp", vec![
        ("generated", Box::new(FixedStep::new(k, State::at(&k, 0.0, q, v), h).unwrap())),
        ("plain", Box::new(double_pendulum::Fixed::<Plain>::new(&k, (q, v), h, tol))),
        ("compensated", Box::new(double_pendulum::Fixed::<Compensated>::new(&k, (q, v), h, tol))),
    ]);
    race("dp EP", vec![
        ("generated", Box::new(EnergyPreserving::from_midpoint(k, 0.0, q, v, h).unwrap())),
        ("plain", Box::new(double_pendulum::EnergyPreserving::<Plain>::new(&k, (q, v), h, tol))),
        ("compensated", Box::new(double_pendulum::EnergyPreserving::<Compensated>::new(&k, (q, v), h, tol))),
    ]);
    let o = black_box(HarmonicOscillator::default());
    race("osc", vec![
        ("generated", Box::new(FixedStep::new(o, State::at(&o, 0.0, [0.8], [0.0]), h).unwrap())),
        ("plain", Box::new(oscillator::Fixed::<Plain>::new(&o, (0.8, 0.0), h))),
        ("compensated", Box::new(oscillator::Fixed::<Compensated>::new(&o, (0.8, 0.0), h))),
    ]);
    let h = black_box(0.1); let tol: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let c = black_box(FpuChain::default());
    let q = chain::lowest_mode::<16>();
    race("chain 16", vec![
        ("generated", Box::new(FixedStep::new(c, State::at(&c, 0.0, q, [0.0; 16]), h).unwrap())),
        ("plain", Box::new(hc::Fixed::<Plain, 16, 17>::new((&c).into(), q, h, tol))),
        ("compensated", Box::new(hc::Fixed::<Compensated, 16, 17>::new((&c).into(), q, h, tol))),
        ("lu", Box::new(dense::Fixed::<16, 17>::new((&c).into(), q, h, tol))),
    ]);
    let c = black_box(chain::LongChain::default());
    let q = chain::lowest_mode::<64>();
    race("chain 64", vec![
        ("generated", Box::new(FixedStep::new(c, State::at(&c, 0.0, q, [0.0; 64]), h).unwrap())),
        ("plain", Box::new(hc::Fixed::<Plain, 64, 65>::new((&c).into(), q, h, tol))),
        ("compensated", Box::new(hc::Fixed::<Compensated, 64, 65>::new((&c).into(), q, h, tol))),
        ("lu", Box::new(dense::Fixed::<64, 65>::new((&c).into(), q, h, tol))),
    ]);
}
