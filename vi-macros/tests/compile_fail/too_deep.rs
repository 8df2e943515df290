use vi_core::lagrangian;

lagrangian! {
    pub struct Broken {
        param m = 1.0;
        coord x;
        L = m * dot(x)^2 / 2 - ------------------------------------------------------------------------------------------------------------------------x;
        discretize midpoint;
    }
}

fn main() {
    let broken = Broken { m: 2.0, ..Broken::default() };
    println!("{}", broken.m);
}
