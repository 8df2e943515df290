//! A system that implements [`Indexed`], and the other traits by [`vi_core::indexed`].

use core::ops::Add;
use vi_core::SVector;
use vi_core::error::StepError;
use vi_core::indexed::{self, FirstDerivatives, Indexed};
use vi_core::lagrangian::{Flow, Lagrangian, Parameters};
use vi_core::nalgebra::SMatrix;
use vi_core::real::{Dual, Real};

/// The system `Generated` by hand; the parameters in the order of [`Lagrangian::PARAMETERS`]. With `OPEN = false` it is declared
/// autonomous and without a force, as it is for w = c = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Handwritten<T = f64, const OPEN: bool = true>(pub(super) [T; 7]);

pub(super) type Vector<T> = SVector<T, 6>;
type Square<T> = SMatrix<T, 6, 6>;

// What generated code defines by loops; here by dual numbers.

impl<T: Real, const OPEN: bool> Handwritten<T, OPEN> {
    fn map<U: Real>(&self, convert: impl Fn(T) -> U) -> Handwritten<U, OPEN> {
        Handwritten(self.0.map(convert))
    }

    /// The terms of which L is the sum.
    fn terms(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> [T; 12] {
        let [m0, m1, m2, g, b, w, _] = self.0;
        let [x0, x1, x2, y0, y1, y2]: [T; 6] = (*q).into();
        let [u0, u1, u2, v0, v1, v2]: [T; 6] = (*v).into();
        let kinetic = |mass: T, speed: T| mass * (speed * speed) * T::real(0.5);
        let attraction = |mass: T, x: T, y: T| g * mass / (x * x + y * y).sqrt();
        [
            kinetic(m0, u0),
            kinetic(m1, u1),
            kinetic(m2, u2),
            kinetic(m0, v0),
            kinetic(m1, v1),
            kinetic(m2, v2),
            attraction(m0 * m1, x0 - x1, y0 - y1),
            attraction(m1 * m2, x1 - x2, y1 - y2),
            attraction(m2 * m0, x2 - x0, y2 - y0),
            b * u0 * v1 * x2.sin(),
            b * x1 * v2 * (w * t).cos(),
            -(b * (w * t).sin() * x0 * y2),
        ]
    }

    /// The first two terms of f belong to x0, the third to y1.
    fn force_terms(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> [T; 3] {
        let [.., w, c] = self.0;
        [-(c * v[0] * (T::one() + q[4] * q[4])), c * q[2] * (w * t).cos(), -(c * v[2] * t)]
    }

    /// First derivatives of the sum of `part` of each term.
    fn sums(&self, t: T, q: &Vector<T>, v: &Vector<T>, part: impl Fn(T) -> T) -> FirstDerivatives<6, T> {
        // Without zeros, which would count in bounds of rounding errors.
        let sum = |terms: &[T]| {
            terms.iter().filter(|term| !term.is_zero()).map(|term| part(*term)).reduce(Add::add).unwrap_or_else(T::zero)
        };
        let derivative = |direction: usize| {
            let number = |value: T, index| Dual { value, slope: if index == direction { T::one() } else { T::zero() } };
            let [q, v] = [(q, 0), (v, 6)].map(|(of, base)| Vector::from_fn(|i, _| number(of[i], base + i)));
            sum(&self.dual().terms(number(t, 12), &q, &v).map(|term| term.slope))
        };
        let [dissipation, field, drag] = self.force_terms(t, q, v);
        let mut force = Vector::zeros();
        (force[0], force[4]) = (sum(&[dissipation, field]), sum(&[drag]));
        FirstDerivatives {
            value: sum(&self.terms(t, q, v)),
            dt: derivative(12),
            dq: Vector::from_fn(|i, _| derivative(i)),
            dv: Vector::from_fn(|i, _| derivative(6 + i)),
            force,
        }
    }

    /// First derivatives along a weighted coordinate and velocity.
    fn column(
        &self,
        t: T,
        q: &Vector<T>,
        v: &Vector<T>,
        weights: [T; 2],
        column: usize,
    ) -> FirstDerivatives<6, Dual<T>> {
        let along = |vector: &Vector<T>, weight| {
            let mut dual = vector.map(Dual::fixed);
            dual[column].slope = weight;
            dual
        };
        let [of_q, of_v] = weights;
        self.dual().first_derivatives(Dual::fixed(t), &along(q, of_q), &along(v, of_v))
    }
}

impl<T: Real, const OPEN: bool> Indexed<6, T> for Handwritten<T, OPEN> {
    type Dual = Handwritten<Dual<T>, OPEN>;

    fn dual(&self) -> Self::Dual {
        self.map(Dual::fixed)
    }
    fn first_derivatives(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> FirstDerivatives<6, T> {
        self.sums(t, q, v, |term| term)
    }
    fn measured_derivatives(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> [FirstDerivatives<6, T>; 2] {
        [self.sums(t, q, v, |term| term), self.sums(t, q, v, T::abs)]
    }
    fn second_derivatives(
        &self,
        t: T,
        q: &Vector<T>,
        v: &Vector<T>,
        [of_q, of_v]: [T; 2],
        columns: [T; 2],
    ) -> Square<T> {
        let mut matrix = Square::zeros();
        for j in 0..6 {
            let found = self.column(t, q, v, columns, j);
            matrix.set_column(j, &Vector::from_fn(|i, _| of_v * found.dv[i].slope + of_q * found.dq[i].slope));
        }
        matrix
    }
    fn add_force_derivatives(
        &self,
        t: T,
        q: &Vector<T>,
        v: &Vector<T>,
        weight: T,
        columns: [T; 2],
        matrix: &mut Square<T>,
    ) {
        for j in 0..6 {
            let found = self.column(t, q, v, columns, j);
            for i in 0..6 {
                matrix[(i, j)] += weight * found.force[i].slope;
            }
        }
    }
}

// What generated code defines by one call each.

impl<T: Real, const OPEN: bool> Lagrangian<6, T> for Handwritten<T, OPEN> {
    const NAME: &'static str = "Handwritten";
    const COORDINATES: [&'static str; 6] = ["x0", "x1", "x2", "y0", "y1", "y2"];
    const AUTONOMOUS: bool = !OPEN;
    const FORCED: bool = OPEN;
    const CYCLIC: [bool; 6] = [false; 6];
    const PARAMETERS: &'static [&'static str] = &["m0", "m1", "m2", "g", "b", "w", "c"];

    fn parameter(&self, index: usize) -> T {
        self.0[index]
    }
    fn lagrangian(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> T {
        self.first_derivatives(t, q, v).value
    }
    fn energy(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> T {
        indexed::energy(self, t, q, v)
    }
    fn momentum(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> Vector<T> {
        self.first_derivatives(t, q, v).dv
    }
    fn force(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> Vector<T> {
        self.first_derivatives(t, q, v).force
    }
    fn acceleration(&self, t: T, q: &Vector<T>, v: &Vector<T>) -> Result<Vector<T>, StepError> {
        indexed::acceleration(self, t, q, v)
    }
    fn flow(&self, t: T, q: &Vector<T>, p: &Vector<T>) -> Result<Flow<6, T>, StepError> {
        indexed::flow(self, t, q, p)
    }
}

type Open<T> = Handwritten<T, true>;
type Closed<T> = Handwritten<T, false>;

indexed::system! {
    Open, coordinates(6), constraints(none), mass(dense), time_scale(none);
    rule(Own), points(Midpoint), jacobian(dense), energy_steps(true)
}

indexed::system! {
    Closed, coordinates(6), constraints(none), mass(dense), time_scale(none);
    rule(Own), points(Midpoint), jacobian(dense), energy_steps(true)
}

impl<T: Real, const OPEN: bool> Handwritten<T, OPEN> {
    pub(super) fn convert<U: Real>(&self) -> Handwritten<U, OPEN> {
        self.map(|number| U::real(number.to_f64()))
    }
}

impl<T: Real, const OPEN: bool> Parameters<T> for Handwritten<T, OPEN> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        let index = <Self as Lagrangian<6, T>>::PARAMETERS.iter().position(|of| *of == name)?;
        self.0.get_mut(index)
    }
}
