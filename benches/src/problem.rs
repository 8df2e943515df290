//! Systems as their Lagrangians alone: what the rivals that differentiate at run time are given.

use num_dual::DualNumCopy;
use vi_systems::{DoublePendulum, DoubleWell, HarmonicOscillator, Kepler};

/// A system of N coordinates.
pub trait Problem<const N: usize>: Clone {
    /// L(q, v), in any kind of number.
    fn lagrangian<D: DualNumCopy<Primitive = f64>>(&self, q: [D; N], v: [D; N]) -> D;
    /// L_q and L_v, by hand: for those who only lack the Jacobian.
    fn gradients(&self, q: [f64; N], v: [f64; N]) -> [[f64; N]; 2];
}

impl Problem<1> for DoubleWell {
    #[inline]
    fn lagrangian<D: DualNumCopy<Primitive = f64>>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        let square = q * q;
        v * v * (self.m / 2.0) - (square * square - square) * 0.5
    }

    #[inline]
    fn gradients(&self, [q]: [f64; 1], [v]: [f64; 1]) -> [[f64; 1]; 2] {
        [[q - 2.0 * q * q * q], [self.m * v]]
    }
}

impl Problem<1> for HarmonicOscillator {
    #[inline]
    fn lagrangian<D: DualNumCopy<Primitive = f64>>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        v * v * (self.m / 2.0) - q * q * (self.k / 2.0)
    }

    #[inline]
    fn gradients(&self, [q]: [f64; 1], [v]: [f64; 1]) -> [[f64; 1]; 2] {
        [[-self.k * q], [self.m * v]]
    }
}

impl Problem<2> for Kepler {
    #[inline]
    fn lagrangian<D: DualNumCopy<Primitive = f64>>(&self, [x, y]: [D; 2], [u, v]: [D; 2]) -> D {
        (u * u + v * v) * 0.5 + (x * x + y * y).sqrt().recip() * self.mu
    }

    #[inline]
    fn gradients(&self, [x, y]: [f64; 2], v: [f64; 2]) -> [[f64; 2]; 2] {
        let square = x * x + y * y;
        let pull = -self.mu / (square * square.sqrt());
        [[pull * x, pull * y], v]
    }
}

impl Problem<2> for DoublePendulum {
    #[inline]
    fn lagrangian<D: DualNumCopy<Primitive = f64>>(&self, [x, y]: [D; 2], [u, v]: [D; 2]) -> D {
        let &Self { m1, m2, l1, l2, g } = self;
        let kinetic = u * u * ((m1 + m2) * l1 * l1 / 2.0) + v * v * (m2 * l2 * l2 / 2.0);
        kinetic + u * v * (x - y).cos() * (m2 * l1 * l2) + x.cos() * ((m1 + m2) * g * l1) + y.cos() * (m2 * g * l2)
    }

    #[inline]
    fn gradients(&self, [x, y]: [f64; 2], [u, v]: [f64; 2]) -> [[f64; 2]; 2] {
        let &Self { m1, m2, l1, l2, g } = self;
        let c = m2 * l1 * l2;
        let (sin, cos) = (x - y).sin_cos();
        let force = [-c * u * v * sin - (m1 + m2) * g * l1 * x.sin(), c * u * v * sin - m2 * g * l2 * y.sin()];
        [force, [(m1 + m2) * l1 * l1 * u + c * v * cos, m2 * l2 * l2 * v + c * u * cos]]
    }
}
