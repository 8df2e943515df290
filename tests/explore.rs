//! scratch
mod support;
use support::scenes::*;
use vi_core::*;
fn check<const N: usize, S: Stepping<N> + Copy>(scene: Scene<S, N>) {
    for h in [scene.h, scene.h / 4.0, scene.h / 16.0] {
        let mut run = EnergyPreserving::from_midpoint(scene.system, 0.0, scene.q, scene.v, h).unwrap();
        let mut n = 0;
        let mut it = 0;
        let d0 = run.density();
        let (mut lo, mut hi) = (f64::INFINITY, 0.0_f64);
        let end = loop {
            match run.step() {
                Ok(s) => {
                    n += 1;
                    it += s.iterations;
                    lo = lo.min(s.density / d0);
                    hi = hi.max(s.density / d0);
                }
                Err(e) => break Some(e),
            }
            if n >= 200_000 {
                break None;
            }
        };
        println!(
            "{} h {h} D0 {d0:.3e} D/D0 {lo:.2e} {hi:.2e}: {n} steps t {} mean it {} {end:?}",
            S::NAME,
            run.state().t,
            it as f64 / n as f64
        );
    }
}
each_system!(check);
