use vi_core::lagrangian;

lagrangian! {
    pub struct Broken {
        param m = 1.0;
        coord x;
        L = m * dot(x)^2 / 2 - x^2;
        force x = -dot(x);
        discretize { Ld = h * L(t0, q0, (q1 - q0)/h); fd_minus = h * f(t0, q0, (q1 - q0)/h); }
    }
}

fn main() {
    let broken = Broken { m: 2.0, ..Broken::default() };
    println!("{}", broken.m);
}
