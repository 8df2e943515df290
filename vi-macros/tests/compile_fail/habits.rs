use vi_core::{lagrangian, Lagrangian};

lagrangian! {
    pub struct Broken {
        const N = 2;
        param m[N] = 1.0, k: f64 = 2.0;
        coord q[N]
        L = sum(i in 0..N, m[i] q[i]^2);
        force = 9.81 m/s^2;
        discretize midpoint;
    }
}

fn main() {
    let broken = Broken { m: [2.0, 1.0], ..Broken::default() };
    println!("{:?} {:?}", broken.m, Lagrangian::<2>::parameter(&broken, 0));
}
