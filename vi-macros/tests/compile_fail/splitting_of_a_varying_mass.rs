use vi_core::{lagrangian, Splitting, Starts};

lagrangian! {
    struct Slider {
        coord r, θ;
        L = dot(r)^2 / 2 + r^2 * dot(θ)^2 / 2 - r^2;
    }
}

fn main() {
    let _ = Slider::default().at(0.0, [1.0, 0.0], [0.0, 1.0]).integrate(Splitting::BLANES_MOAN_6, 0.1);
}
