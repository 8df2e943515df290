use vi_core::{lagrangian, FixedStep, Starts};

lagrangian! {
    pub struct Broken {
        const N = 2;
        param m[N] = 1.0, k[2] = [1.0, 2.0, 3.0], c[3] = 0.1;
        coord q[N];
        let x = k[0] * sin(q[0]);
        L = sum(i in 0..N, m[i] * dot(q[i])^2) - dot(c) + sum(i in 0..3, m[i]);
        force q[0] = -dot(dot(x));
        discretize midpoint;
    }
}

fn main() {
    let broken = Broken { m: [2.0, 1.0], k: [1.0, 2.0], ..Broken::default() };
    println!("{:?} {:?}", broken.m, broken.c[2]);
    let run = broken.at(0.0, [1.0, 0.0], [0.0, 0.0]).integrate(FixedStep, 0.01);
    println!("{:?}", run.map(|mut run| run.step()));
}
