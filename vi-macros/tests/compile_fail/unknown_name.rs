use vi_core::{lagrangian, FixedStep, Starts};

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
    let run = broken.at(0.0, [1.0], [0.0]).integrate(FixedStep, 0.01);
    println!("{:?}", run.map(|mut run| run.step()));
}
