use vi_core::lagrangian;

lagrangian! {
    pub struct Broken {
        param m = 1.0;
        coord x;
        let v = dot(m);
        L = m * v^2 / 2 - mm * x^2;
        force x = -c * v;
        discretize midpont;
    }
}

fn main() {
    let broken = Broken { m: 2.0, ..Broken::default() };
    println!("{}", broken.m);
}
