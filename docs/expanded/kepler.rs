// `Kepler`: L = dot(x)^2/2 + dot(y)^2/2 + mu/sqrt(x^2 + y^2)
//
// Operation counts by method
//     52  every method: lagrangian 13, energy 13, momentum 0, force 0, acceleration 13, non_finite 13
//     34  Gauss, EnergyPreservingGauss: point 13, point_derivatives 21, power 0
//     29  Gauss in transformed time: scaled_point 29
//     13  Splitting, for each force: point 13
//    168  FixedStep, Composition, Ensemble by the rule `midpoint`: momentum_equation 46, momentum_residual 44, momentum_derivatives 58, discrete_energy 20
//    357  EnergyPreserving by the rule `midpoint`: step_density 39, extended_system 107, extended_residual 96, extended_derivatives 115
//     92  DiscreteLagrangian by the rule `midpoint`: ld 18, d1_ld 17, d2_ld 21, d3_ld 17, d4_ld 19, fd_minus 0, fd_plus 0, gd_minus 0, gd_plus 0

/// Plane Kepler problem, a = −μ r/|r|³.
///
/// Conserved: energy, angular momentum x v_y − y v_x. Started at the pericentre of an orbit of eccentricity e, the
/// energy-preserving integrator runs for e ≤ 0.785 and cannot run for e ≥ √(5/8).
/// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section I.2.
///
/// Discretized by the rule `midpoint`. Properties found by the generator:
///
/// * Autonomous and without a force: the energy is conserved
/// * `L = T(v) + U(t, q)` with a constant mass matrix
/// * The step's equation in `v` is nonlinear: its Jacobian `A` depends on `v`, and Newton's iteration gives the step
/// * `A` is dense, symmetric; solved in closed form
#[derive(
    ::core::clone::Clone,
    ::core::marker::Copy,
    ::core::fmt::Debug,
    ::core::cmp::PartialEq
)]
#[allow(non_snake_case)]
pub struct Kepler<T = ::core::primitive::f64> {
    /// Gravitational parameter.
    ///
    /// Parameter `mu`, 1 by default.
    pub mu: T,
}

#[allow(
    clippy::all,
    clippy::pedantic,
    deprecated,
    non_snake_case,
    unused_imports,
    unused_parens,
    unused_variables
)]
const _: () = {
    impl ::core::default::Default for Kepler<f64> {
        fn default() -> Self {
            Self { mu: 1.0 }
        }
    }

    impl<T: ::vi_core::real::Real> Kepler<T> {
        /// The same system in another kind of number, every parameter rounded to it.
        pub fn convert<U: ::vi_core::real::Real>(&self) -> Kepler<U> {
            Kepler {
                mu: U::real(self.mu.to_f64()),
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T> for Kepler<T> {
        fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
            match name {
                "mu" => ::core::option::Option::Some(&mut self.mu),
                _ => ::core::option::Option::None,
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::Lagrangian<2, T> for Kepler<T> {
        const NAME: &'static str = "Kepler";
        const COORDINATES: [&'static str; 2] = ["x", "y"];
        const AUTONOMOUS: bool = true;
        const FORCED: bool = false;
        const CYCLIC: [bool; 2] = [false, false];
        const PARAMETERS: &'static [&'static str] = &["mu"];
        fn parameter(&self, index: usize) -> T {
            [self.mu][index]
        }

        /// `L = dot(x)^2/2 + dot(y)^2/2 + mu/sqrt(x^2 + y^2)`
        ///
        /// 13 operations.
        #[inline]
        fn lagrangian(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x + y * y;
            x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                + self.mu * (s1.recip() * s1.sqrt())
        }

        /// `v·L_v − L = dot(x)^2/2 + dot(y)^2/2 - mu/sqrt(x^2 + y^2)`
        ///
        /// 13 operations.
        #[inline]
        fn energy(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x + y * y;
            x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                - self.mu * (s1.recip() * s1.sqrt())
        }

        /// `p_x = dot(x)`
        ///
        /// `p_y = dot(y)`
        ///
        /// 0 operations.
        #[inline]
        fn momentum(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::SVector<T, 2> {
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            ::vi_core::SVector::from([x_dot, y_dot])
        }

        /// `f_x = 0`
        ///
        /// `f_y = 0`
        ///
        /// 0 operations.
        #[inline]
        fn force(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::SVector<T, 2> {
            let real = T::real;
            ::vi_core::SVector::from([real(0.0), real(0.0)])
        }

        /// Solves `M a = L_q + f − L_vt − L_vq v`.
        ///
        /// 13 operations.
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<::vi_core::SVector<T, 2>, ::vi_core::StepError> {
            let time = t;
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x + y * y;
            let s2 = s1.recip();
            let s3 = s2 * s2 * s1.sqrt();
            let mass: ::vi_core::linear::Banded<2, 1, T> = ::vi_core::linear::Banded {
                rows: [[real(1.0)], [real(1.0)]],
            };
            let applied: ::vi_core::SVector<T, 2> = ::vi_core::SVector::from([
                -(self.mu * x * s3),
                -(self.mu * y * s3),
            ]);
            ::vi_core::support::acceleration(time, &mass, &applied)
        }

        #[inline]
        fn flow(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            p: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<
            ::vi_core::lagrangian::Flow<2, T>,
            ::vi_core::StepError,
        > {
            let at_rest = ::vi_core::motion::Motion::point(
                self,
                t,
                q,
                &::vi_core::SVector::zeros(),
            );
            let velocity = ::vi_core::support::velocity_by_mass(
                t,
                &at_rest.mass,
                &(p - at_rest.momentum),
            )?;
            let force = ::vi_core::motion::Motion::point(self, t, q, &velocity).force;
            let power = ::vi_core::motion::Motion::power(self, t, q, &velocity);
            ::core::result::Result::Ok(::vi_core::lagrangian::Flow {
                v: velocity,
                force,
                power,
            })
        }

        /// The first part of L and f that is not finite at this state.
        ///
        /// 13 operations.
        #[cold]
        fn non_finite(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::option::Option<&'static str> {
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x + y * y;
            let s2 = self.mu * (s1.recip() * s1.sqrt());
            let values = [
                ("mu", self.mu),
                ("x", x),
                ("y", y),
                ("dot(x)", x_dot),
                ("dot(y)", y_dot),
                ("mu/sqrt(x^2 + y^2)", s2),
                (
                    "dot(x)^2/2 + dot(y)^2/2 + mu/sqrt(x^2 + y^2)",
                    x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5) + s2,
                ),
            ];
            values
                .into_iter()
                .find(|(_, value)| !value.is_finite())
                .map(|(text, _)| text)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::motion::Motion<2, T> for Kepler<T> {
        type Kind = ::vi_core::kind::Free;
        type Mass = ::vi_core::linear::Banded<2, 1, T>;
        type PointMatrix = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        const CONSTANT_MASS: bool = true;
        const SEPARABLE: bool = true;
        const SCALES_TIME: bool = true;

        /// L_v, M, and
        ///
        /// `L_q + f_x = -mu*x/(x^2 + y^2)^(3/2)`
        ///
        /// `L_q + f_y = -mu*y/(x^2 + y^2)^(3/2)`
        ///
        /// 13 operations.
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::motion::Point<2, T, Self::Mass> {
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x + y * y;
            let s2 = s1.recip();
            let s3 = s2 * s2 * s1.sqrt();
            ::vi_core::motion::Point {
                momentum: ::vi_core::SVector::from([x_dot, y_dot]),
                force: ::vi_core::SVector::from([
                    -(self.mu * x * s3),
                    -(self.mu * y * s3),
                ]),
                mass: ::vi_core::linear::Banded {
                    rows: [[real(1.0)], [real(1.0)]],
                },
            }
        }

        /// M = ∂L_v/∂v, ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.
        ///
        /// 21 operations.
        #[inline(always)]
        fn point_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::motion::PointDerivatives<Self::PointMatrix> {
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x;
            let s2 = y * y;
            let s3 = s1 + s2;
            let s4 = s3.recip();
            let s5 = s4 * s4;
            let s6 = s3.sqrt();
            let s7 = s5 * s6;
            let s8 = s5 * s4 * s6;
            let s9 = self.mu * x * y * s8 * real(3.0);
            ::vi_core::motion::PointDerivatives {
                momentum_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[real(0.0), real(0.0), real(0.0), real(0.0)],
                ),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[real(1.0), real(0.0), real(0.0), real(1.0)],
                ),
                force_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[
                        (s1 * s8 * real(3.0) - s7) * self.mu,
                        s9,
                        s9,
                        (s2 * s8 * real(3.0) - s7) * self.mu,
                    ],
                ),
                force_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[real(0.0), real(0.0), real(0.0), real(0.0)],
                ),
            }
        }

        /// `dE/dt = 0`
        ///
        /// 0 operations.
        #[inline]
        fn power(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let real = T::real;
            real(0.0)
        }

        /// The point, its energy, its power, and
        ///
        /// `g = sqrt(x^2 + y^2)^(3/2)`
        ///
        /// 29 operations.
        #[inline(always)]
        fn scaled_point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::motion::ScaledPoint<2, T, Self::Mass> {
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x + y * y;
            let s2 = s1.sqrt();
            let s3 = s1.recip();
            let s4 = s3 * s2;
            let s5 = s2.sqrt();
            let s6 = s3 * s3 * s2;
            ::vi_core::motion::ScaledPoint {
                point: ::vi_core::motion::Point {
                    momentum: ::vi_core::SVector::from([x_dot, y_dot]),
                    force: ::vi_core::SVector::from([
                        -(self.mu * x * s6),
                        -(self.mu * y * s6),
                    ]),
                    mass: ::vi_core::linear::Banded {
                        rows: [[real(1.0)], [real(1.0)]],
                    },
                },
                energy: x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                    - self.mu * s4,
                power: real(0.0),
                g: s2 * s5,
                g_dq: ::vi_core::SVector::from([
                    x * s4 * s5 * real(1.5),
                    y * s4 * s5 * real(1.5),
                ]),
                g_dt: real(0.0),
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::motion::TimeScale<2, T> for Kepler<T> {}
    impl<T: ::vi_core::real::Real> ::vi_core::motion::Separable<2, T> for Kepler<T> {}
    impl ::vi_core::stepping::Convertible<2> for Kepler<f64> {
        type In<T: ::vi_core::real::Real> = Kepler<T>;
        #[inline(always)]
        fn convert<T: ::vi_core::real::Real>(&self) -> Kepler<T> {
            self.convert()
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<2, T> for Kepler<T> {
        /// `ld = h*L`
        ///
        /// 18 operations.
        #[inline]
        fn ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0, y0]: [T; 2] = interval.q0.into();
            let [x1, y1]: [T; 2] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let y_dot = (y1 - y0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            let y_mid = (y0 + y1) * real(0.5);
            let s1 = x_mid * x_mid + y_mid * y_mid;
            h
                * (x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                    + self.mu * (s1.recip() * s1.sqrt()))
        }

        /// `d1_ld = L_v_x*v_x - L + L_v_y*v_y`
        ///
        /// 17 operations.
        #[inline]
        fn d1_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0, y0]: [T; 2] = interval.q0.into();
            let [x1, y1]: [T; 2] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let y_dot = (y1 - y0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            let y_mid = (y0 + y1) * real(0.5);
            let s1 = x_mid * x_mid + y_mid * y_mid;
            x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                - self.mu * (s1.recip() * s1.sqrt())
        }

        /// `d2_ld_x = h*L_x/2 - L_v_x`
        ///
        /// `d2_ld_y = h*L_y/2 - L_v_y`
        ///
        /// 21 operations.
        #[inline]
        fn d2_ld(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let h = interval.t1 - interval.t0;
            let [x0, y0]: [T; 2] = interval.q0.into();
            let [x1, y1]: [T; 2] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let y_dot = (y1 - y0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            let y_mid = (y0 + y1) * real(0.5);
            let s1 = x_mid * x_mid + y_mid * y_mid;
            let s2 = s1.recip();
            let s3 = s2 * s2 * s1.sqrt();
            let s4 = self.mu * h * real(0.5);
            ::vi_core::SVector::from([
                -x_dot - s4 * x_mid * s3,
                -y_dot - s4 * y_mid * s3,
            ])
        }

        /// `d3_ld = L - L_v_x*v_x - L_v_y*v_y`
        ///
        /// 17 operations.
        #[inline]
        fn d3_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0, y0]: [T; 2] = interval.q0.into();
            let [x1, y1]: [T; 2] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let y_dot = (y1 - y0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            let y_mid = (y0 + y1) * real(0.5);
            let s1 = x_mid * x_mid + y_mid * y_mid;
            self.mu * (s1.recip() * s1.sqrt()) - x_dot * x_dot * real(0.5)
                - y_dot * y_dot * real(0.5)
        }

        /// `d4_ld_x = L_v_x + h*L_x/2`
        ///
        /// `d4_ld_y = L_v_y + h*L_y/2`
        ///
        /// 19 operations.
        #[inline]
        fn d4_ld(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let h = interval.t1 - interval.t0;
            let [x0, y0]: [T; 2] = interval.q0.into();
            let [x1, y1]: [T; 2] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let y_dot = (y1 - y0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            let y_mid = (y0 + y1) * real(0.5);
            let s1 = x_mid * x_mid + y_mid * y_mid;
            let s2 = s1.recip();
            let s3 = s2 * s2 * s1.sqrt();
            let s4 = self.mu * h * real(0.5);
            ::vi_core::SVector::from([x_dot - s4 * x_mid * s3, y_dot - s4 * y_mid * s3])
        }

        /// `fd_minus_x = 0`
        ///
        /// `fd_minus_y = 0`
        ///
        /// 0 operations.
        #[inline]
        fn fd_minus(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let real = T::real;
            ::vi_core::SVector::from([real(0.0), real(0.0)])
        }

        /// `fd_plus_x = 0`
        ///
        /// `fd_plus_y = 0`
        ///
        /// 0 operations.
        #[inline]
        fn fd_plus(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let real = T::real;
            ::vi_core::SVector::from([real(0.0), real(0.0)])
        }

        /// `gd_minus = 0`
        ///
        /// 0 operations.
        #[inline]
        fn gd_minus(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let real = T::real;
            real(0.0)
        }

        /// `gd_plus = 0`
        ///
        /// 0 operations.
        #[inline]
        fn gd_plus(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let real = T::real;
            real(0.0)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<2, T>
    for Kepler<T> {
        type Jacobian = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        type StepMatrix = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        const CONSTANT_JACOBIAN: bool = false;
        const INLINED: bool = true;

        /// `residual_x = L_v_x - h*L_x/2 - p0_x_low - p0_x`
        ///
        /// `residual_y = L_v_y - h*L_y/2 - p0_y_low - p0_y`
        ///
        /// 46 operations.
        #[inline(always)]
        fn momentum_equation(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumEquation<2, T, Self::Jacobian> {
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [p0_x, p0_y]: [T; 2] = node.p.into();
            let [p0_x_low, p0_y_low]: [T; 2] = node.p_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid;
            let s3 = y_mid * y_mid;
            let s4 = s2 + s3;
            let s5 = s4.recip();
            let s6 = s5 * s5;
            let s7 = s4.sqrt();
            let s8 = s6 * s7;
            let s9 = self.mu * h * real(0.5);
            let s10 = s6 * s5 * s7;
            let s11 = self.mu * (h * h);
            let s12 = s11 * real(0.25);
            let s13 = -(s11 * real(0.75) * x_mid * y_mid * s10);
            ::vi_core::stepping::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    x_dot - p0_x + (s9 * x_mid * s8 - p0_x_low),
                    y_dot - p0_y + (s9 * y_mid * s8 - p0_y_low),
                ]),
                jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[
                        real(1.0) - s12 * (s2 * s10 * real(3.0) - s8),
                        s13,
                        s13,
                        real(1.0) - s12 * (s3 * s10 * real(3.0) - s8),
                    ],
                ),
            }
        }

        /// The residual, its rounding scale, and
        ///
        /// `p1_x − p0_x = h*L_x`
        ///
        /// `p1_y − p0_y = h*L_y`
        ///
        /// 44 operations.
        #[inline(always)]
        fn momentum_residual(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumResidual<2, T> {
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [p0_x, p0_y]: [T; 2] = node.p.into();
            let [p0_x_low, p0_y_low]: [T; 2] = node.p_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid + y_mid * y_mid;
            let s3 = s2.recip();
            let s4 = s3 * s3 * s2.sqrt();
            let s5 = self.mu * h;
            let s6 = s5 * x_mid * s4;
            let s7 = s5 * y_mid * s4;
            let s8 = s5 * real(0.5);
            ::vi_core::stepping::MomentumResidual {
                residual: ::vi_core::SVector::from([
                    x_dot - p0_x + (s8 * x_mid * s4 - p0_x_low),
                    y_dot - p0_y + (s8 * y_mid * s4 - p0_y_low),
                ]),
                scale: ::vi_core::SVector::from([
                    x_dot.abs() + p0_x.abs() + s6.abs() * real(0.5),
                    y_dot.abs() + p0_y.abs() + s7.abs() * real(0.5),
                ]),
                increment: ::vi_core::SVector::from([-s6, -s7]),
            }
        }

        /// Derivatives of the residual and of `p1 − p0` with respect to the coordinates of the node and v.
        ///
        /// 58 operations.
        #[inline(always)]
        fn momentum_derivatives(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix> {
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid;
            let s3 = y_mid * y_mid;
            let s4 = s2 + s3;
            let s5 = s4.recip();
            let s6 = s5 * s5;
            let s7 = s4.sqrt();
            let s8 = s6 * s7;
            let s9 = s6 * s5 * s7;
            let s10 = s2 * s9 * real(3.0) - s8;
            let s11 = self.mu * (h * h);
            let s12 = s11 * real(0.25);
            let s13 = -(s11 * real(0.75) * x_mid * y_mid * s9);
            let s14 = s3 * s9 * real(3.0) - s8;
            let s15 = self.mu * h;
            let s16 = s15 * real(0.5);
            let s17 = s15 * real(3.0) * x_mid * y_mid * s9;
            let s18 = -(s15 * real(1.5) * x_mid * y_mid * s9);
            let s19 = s11 * real(0.5);
            let s20 = s11 * real(1.5) * x_mid * y_mid * s9;
            ::vi_core::stepping::MomentumDerivatives {
                residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[-(s16 * s10), s18, s18, -(s16 * s14)],
                ),
                residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[real(1.0) - s12 * s10, s13, s13, real(1.0) - s12 * s14],
                ),
                increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[s15 * s10, s17, s17, s15 * s14],
                ),
                increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[s19 * s10, s20, s20, s19 * s14],
                ),
            }
        }

        /// `E1 = L_v_x*v_x - L + L_v_y*v_y`
        ///
        /// 20 operations.
        #[inline(always)]
        fn discrete_energy(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid + y_mid * y_mid;
            x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                - self.mu * (s2.recip() * s2.sqrt())
        }

        /// Bounds the rounding error of the residual by running error analysis.
        #[cold]
        fn momentum_rounding(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::SVector<T, 2> {
            ::vi_core::support::momentum_rounding(
                &self.convert::<::vi_core::real::Rounded>(),
                node,
                h,
                v,
            )
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<2, T>
    for Kepler<T> {
        /// `D = -mu*x*dot(dot(x))/(x^2 + y^2)^(3/2) - dot(x)*(dot(x)*(3*mu*x^2/(x^2 + y^2)^(5/2) - mu/(x^2 + y^2)^(3/2)) + 3*mu*x*y*dot(y)/(x^2 + y^2)^(5/2)) - mu*y*dot(dot(y))/(x^2 + y^2)^(3/2) - dot(y)*(3*mu*x*y*dot(x)/(x^2 + y^2)^(5/2) + dot(y)*(3*mu*y^2/(x^2 + y^2)^(5/2) - mu/(x^2 + y^2)^(3/2)))`
        ///
        /// 39 operations.
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let time = t;
            let [x_ddot, y_ddot]: [T; 2] = ::vi_core::Lagrangian::acceleration(
                    self,
                    t,
                    q,
                    v,
                )?
                .into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let [x, y]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = x * x;
            let s2 = y * y;
            let s3 = s1 + s2;
            let s4 = s3.recip();
            let s5 = s4 * s4;
            let s6 = s3.sqrt();
            let s7 = s5 * s6;
            let s8 = s5 * s4 * s6;
            let s9 = self.mu * x;
            let s10 = s9 * y * s8;
            let s11 = s9 * s7 * x_ddot
                + x_dot
                    * (self.mu * x_dot * (s1 * s8 * real(3.0) - s7)
                        + s10 * y_dot * real(3.0));
            let s12 = s11 + self.mu * y * s7 * y_ddot
                + y_dot
                    * (s10 * x_dot * real(3.0)
                        + self.mu * y_dot * (s2 * s8 * real(3.0) - s7));
            ::vi_core::support::step_density(time, -s12)
        }

        /// `energy_residual = h*v_x*L_x/2 - L - E0_low - E0 + v_x*p0_x_low + v_x*p0_x + h*v_y*L_y/2 + v_y*p0_y_low + v_y*p0_y`
        ///
        /// 107 operations.
        #[inline(always)]
        fn extended_system(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedSystem<2, T, Self::Jacobian> {
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [p0_x, p0_y]: [T; 2] = node.p.into();
            let [p0_x_low, p0_y_low]: [T; 2] = node.p_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid;
            let s3 = y_mid * y_mid;
            let s4 = s2 + s3;
            let s5 = s4.recip();
            let s6 = s4.sqrt();
            let s7 = s5 * s5;
            let s8 = s7 * s6;
            let s9 = self.mu * x_mid * s8;
            let s10 = self.mu * y_mid * s8;
            let s11 = (p0_y - y_dot * real(0.5)) * y_dot
                - (energy0 + self.mu * (s5 * s6)) + (p0_x - x_dot * real(0.5)) * x_dot;
            let s12 = x_dot * p0_x_low + y_dot * p0_y_low - energy0_low
                - self.mu * real(0.5) * h * (x_dot * x_mid * s8 + y_dot * y_mid * s8);
            let s13 = s7 * s5 * s6;
            let s14 = s2 * s13 * real(3.0) - s8;
            let s15 = self.mu * (h * h);
            let s16 = s15 * real(0.25);
            let s17 = -(s15 * real(0.75) * x_mid * y_mid * s13);
            let s18 = s3 * s13 * real(3.0) - s8;
            let s19 = s9 * real(0.5);
            let s20 = self.mu * real(0.75);
            let s21 = self.mu * real(0.25);
            let s22 = s21 * x_dot * s14;
            let s23 = (s20 * y_dot * x_mid * y_mid * s13 + s22) * h;
            let s24 = s10 * real(0.5);
            let s25 = (s20 * x_dot * x_mid * y_mid * s13 + s21 * y_dot * s18) * h;
            ::vi_core::stepping::ExtendedSystem {
                momentum: ::vi_core::stepping::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        x_dot - p0_x + (s9 * s1 - p0_x_low),
                        y_dot - p0_y + (s10 * s1 - p0_y_low),
                    ]),
                    jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[real(1.0) - s16 * s14, s17, s17, real(1.0) - s16 * s18],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s19 - s23, s24 - s25]),
                energy_residual: s11 + s12,
                energy_dv: ::vi_core::SVector::from([s19 + s23, s24 + s25]),
                energy_dh: self.mu * (y_dot * y_dot) * s18 * real(0.25)
                    + (self.mu * real(1.5) * y_dot * x_mid * y_mid * s13 + s22) * x_dot,
            }
        }

        /// Both residuals, their rounding scales, and
        ///
        /// `E1 − E0 = 0`
        ///
        /// 96 operations.
        #[inline(always)]
        fn extended_residual(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedResidual<2, T> {
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [p0_x, p0_y]: [T; 2] = node.p.into();
            let [p0_x_low, p0_y_low]: [T; 2] = node.p_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid + y_mid * y_mid;
            let s3 = s2.recip();
            let s4 = s2.sqrt();
            let s5 = self.mu * (s3 * s4);
            let s6 = s3 * s3 * s4;
            let s7 = self.mu * h;
            let s8 = s7 * x_mid * s6;
            let s9 = s7 * y_mid * s6;
            let s10 = s7 * real(0.5);
            let s11 = x_dot * p0_x_low + y_dot * p0_y_low - energy0_low
                - self.mu * real(0.5) * h * (x_dot * x_mid * s6 + y_dot * y_mid * s6);
            let s12 = x_dot * x_dot * real(0.5) + y_dot * y_dot * real(0.5)
                + energy0.abs() + (x_dot * p0_x).abs() + (y_dot * p0_y).abs();
            ::vi_core::stepping::ExtendedResidual {
                residual: ::vi_core::SVector::from([
                    x_dot - p0_x + (s10 * x_mid * s6 - p0_x_low),
                    y_dot - p0_y + (s10 * y_mid * s6 - p0_y_low),
                ]),
                scale: ::vi_core::SVector::from([
                    x_dot.abs() + p0_x.abs() + s8.abs() * real(0.5),
                    y_dot.abs() + p0_y.abs() + s9.abs() * real(0.5),
                ]),
                energy_residual: (p0_y - y_dot * real(0.5)) * y_dot - (energy0 + s5)
                    + (p0_x - x_dot * real(0.5)) * x_dot + s11,
                energy_scale: s12 + s5.abs()
                    + (s7 * x_dot * x_mid * s6).abs() * real(0.5)
                    + (s7 * y_dot * y_mid * s6).abs() * real(0.5),
                increment: ::vi_core::stepping::Increment {
                    momentum: ::vi_core::SVector::from([-s8, -s9]),
                    energy: real(0.0),
                },
            }
        }

        /// Derivatives of both residuals, `p1 − p0` and `E1 − E0` with respect to the coordinates of the node, v and h.
        ///
        /// 115 operations.
        #[inline(always)]
        fn extended_derivatives(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedDerivatives<
            2,
            T,
            Self::Jacobian,
            Self::StepMatrix,
        > {
            let [x0, y0]: [T; 2] = node.q.into();
            let [x0_low, y0_low]: [T; 2] = node.q_low.into();
            let [x_dot, y_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let y_mid = y0 + (s1 * y_dot + y0_low);
            let s2 = x_mid * x_mid;
            let s3 = y_mid * y_mid;
            let s4 = s2 + s3;
            let s5 = s4.recip();
            let s6 = s5 * s5;
            let s7 = s4.sqrt();
            let s8 = s6 * s7;
            let s9 = self.mu * x_mid * s8;
            let s10 = self.mu * y_mid * s8;
            let s11 = s6 * s5 * s7;
            let s12 = s2 * s11 * real(3.0) - s8;
            let s13 = self.mu * (h * h);
            let s14 = s13 * real(0.25);
            let s15 = -(s13 * real(0.75) * x_mid * y_mid * s11);
            let s16 = s3 * s11 * real(3.0) - s8;
            let s17 = self.mu * h;
            let s18 = s9 * real(0.5);
            let s19 = self.mu * real(0.75);
            let s20 = self.mu * real(0.25);
            let s21 = s20 * x_dot * s12;
            let s22 = (s19 * y_dot * x_mid * y_mid * s11 + s21) * h;
            let s23 = s10 * real(0.5);
            let s24 = (s19 * x_dot * x_mid * y_mid * s11 + s20 * y_dot * s16) * h;
            let s25 = self.mu * real(1.5);
            let s26 = s25 * y_dot * x_mid * y_mid * s11;
            let s27 = s17 * real(0.5);
            let s28 = s17 * real(3.0) * x_mid * y_mid * s11;
            let s29 = -(s17 * real(1.5) * x_mid * y_mid * s11);
            let s30 = s13 * real(0.5);
            let s31 = s13 * real(1.5) * x_mid * y_mid * s11;
            let s32 = self.mu * real(0.5);
            let s33 = (s26 + s32 * x_dot * s12) * h;
            let s34 = (s25 * x_dot * x_mid * y_mid * s11 + s32 * y_dot * s16) * h;
            ::vi_core::stepping::ExtendedDerivatives {
                momentum: ::vi_core::stepping::MomentumDerivatives {
                    residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[-(s27 * s12), s29, s29, -(s27 * s16)],
                    ),
                    residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[real(1.0) - s14 * s12, s15, s15, real(1.0) - s14 * s16],
                    ),
                    increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[s17 * s12, s28, s28, s17 * s16],
                    ),
                    increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[s30 * s12, s31, s31, s30 * s16],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s18 - s22, s23 - s24]),
                increment_dh: ::vi_core::SVector::from([s33 - s9, s34 - s10]),
                energy_dq: ::vi_core::SVector::from([s9 + s33, s10 + s34]),
                energy_dv: ::vi_core::SVector::from([s18 + s22, s23 + s24]),
                energy_dh: self.mu * (y_dot * y_dot) * s16 * real(0.25)
                    + (s26 + s21) * x_dot,
                energy_increment_dq: ::vi_core::SVector::from([real(0.0), real(0.0)]),
                energy_increment_dv: ::vi_core::SVector::from([real(0.0), real(0.0)]),
                energy_increment_dh: real(0.0),
            }
        }

        /// Bounds the rounding errors of both residuals by running error analysis.
        #[cold]
        fn extended_rounding(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::Rounding<2, T> {
            ::vi_core::support::extended_rounding(
                &self.convert::<::vi_core::real::Rounded>(),
                node,
                h,
                v,
            )
        }
    }

    impl ::vi_core::stepping::Discretized<2> for Kepler<f64> {
        type Steps<T: ::vi_core::real::Real> = Kepler<T>;
        #[inline(always)]
        fn steps<T: ::vi_core::real::Real>(&self) -> Kepler<T> {
            self.convert()
        }
    }

    impl ::vi_core::stepping::Batch<2> for Kepler<f64> {
        type Rows<const W: usize> = Kepler<[f64; W]>;
        fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
            Kepler {
                mu: ::core::array::from_fn(|index| systems[index].mu),
            }
        }

        #[inline(always)]
        fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self {
            Kepler { mu: rows.mu[index] }
        }
    }

    /// Declares a function for every name bound above: a binding may shadow it, but not a constant of the surrounding code.
    use ::core::primitive::{bool, f64, str, usize};
    use ::core::convert::{identity as name, identity as index, identity as t};
    use ::core::convert::{identity as q, identity as v, identity as x_dot};
    use ::core::convert::{identity as y_dot, identity as x, identity as y};
    use ::core::convert::{identity as real, identity as s1, identity as time};
    use ::core::convert::{identity as s2, identity as s3, identity as mass};
    use ::core::convert::{identity as applied, identity as p, identity as at_rest};
    use ::core::convert::{identity as velocity, identity as force, identity as power};
    use ::core::convert::{identity as values, identity as value, identity as text};
    use ::core::convert::{identity as s4, identity as s5, identity as s6};
    use ::core::convert::{identity as s7, identity as s8, identity as s9};
    use ::core::convert::{identity as interval, identity as h, identity as x0};
    use ::core::convert::{identity as y0, identity as x1, identity as y1};
    use ::core::convert::{identity as x_mid, identity as y_mid, identity as node};
    use ::core::convert::{identity as x0_low, identity as y0_low, identity as p0_x};
    use ::core::convert::{identity as p0_y, identity as p0_x_low, identity as p0_y_low};
    use ::core::convert::{identity as s10, identity as s11, identity as s12};
    use ::core::convert::{identity as s13, identity as s14, identity as s15};
    use ::core::convert::{identity as s16, identity as s17, identity as s18};
    use ::core::convert::{identity as s19, identity as s20, identity as x_ddot};
    use ::core::convert::{
        identity as y_ddot, identity as energy0, identity as energy0_low,
    };

    use ::core::convert::{identity as s21, identity as s22, identity as s23};
    use ::core::convert::{identity as s24, identity as s25, identity as s26};
    use ::core::convert::{identity as s27, identity as s28, identity as s29};
    use ::core::convert::{identity as s30, identity as s31, identity as s32};
    use ::core::convert::{identity as s33, identity as s34, identity as systems};
    use ::core::convert::identity as rows;
};

/// Checks of [`Kepler`](super::Kepler) at the state of its `check` clause.
#[cfg(test)]
#[allow(clippy::all, clippy::pedantic, deprecated)]
mod kepler_checks {
    fn place() -> ::vi_core::check::Place<2> {
        ::vi_core::check::Place {
            t: 0.0,
            q: [0.6, 0.1].into(),
            v: [-0.2, 1.4].into(),
            h: 0.02,
        }
    }

    #[::core::prelude::v1::test]
    fn derivatives() {
        let checked = ::vi_core::check::derivatives(&super::Kepler::default(), &place());
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn slots() {
        let checked = ::vi_core::check::slots(&super::Kepler::default(), &place());
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn steps() {
        let checked = ::vi_core::check::steps(&super::Kepler::default(), &place());
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn energy_equations() {
        let checked = ::vi_core::check::energy_equations(
            &super::Kepler::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn order() {
        let checked = ::vi_core::check::order(&super::Kepler::default(), &place(), 2);
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn symplecticity() {
        let checked = ::vi_core::check::symplecticity(
            &super::Kepler::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn reversibility() {
        let checked = ::vi_core::check::reversibility(
            &super::Kepler::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn energy() {
        let checked = ::vi_core::check::energy(&super::Kepler::default(), &place());
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn step_law() {
        let checked = ::vi_core::check::step_law(&super::Kepler::default(), &place());
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }
}
