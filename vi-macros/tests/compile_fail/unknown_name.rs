use vi_core::{FixedStep, State, lagrangian};

lagrangian! {
    pub struct Broken {
        param m = 1.0, stiffness = 4.0;
        coord x;
        L = m * dot(x)^2 / 2 - stifness * x^2 / 2;
        discretize midpoint;
    }
}

fn main() {
    let broken = Broken { m: 2.0, ..Broken::default() };
    println!("{}", broken.m);
    let run = FixedStep::new(broken, State::at(&broken, 0.0, [1.0], [0.0]), 0.01);
    println!("{:?}", run.map(|mut run| run.step()));
}
