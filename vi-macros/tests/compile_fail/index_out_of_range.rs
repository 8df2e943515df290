use vi_core::lagrangian;

lagrangian! {
    pub struct Broken {
        const N = 8;
        param m = 1.0;
        coord q[N];
        let stretch[i in 0..N] = q[i + 1] - q[i];
        L = m * sum(i in 0..N, dot(q[i])^2) / 2 - sum(i in 0..N, stretch[i]^2);
        discretize midpoint;
    }
}

fn main() {
    let broken = Broken { m: 2.0, ..Broken::default() };
    println!("{}", broken.m);
}
