// `DampedOscillator`: L = m*dot(x)^2/2 - k*x^2/2
//
// Operations of the functions for
//     30  every method: lagrangian 7, energy 7, momentum 1, force 2, acceleration 4, non_finite 9
//     10  Gauss, EnergyPreservingGauss: point 5, point_derivatives 2, power 3
//     77  FixedStep, Composition, Ensemble by the rule `midpoint`: momentum_equation 19, momentum_residual 32, momentum_derivatives 11, discrete_energy 15
//    149  EnergyPreserving by the rule `midpoint`: step_density 7, extended_system 40, extended_residual 65, extended_derivatives 37
//     60  DiscreteLagrangian by the rule `midpoint`: ld 10, d1_ld 9, d2_ld 8, d3_ld 10, d4_ld 7, fd_minus 4, fd_plus 4, gd_minus 4, gd_plus 4

/// Damped harmonic oscillator, m a + c v + k x = 0.
///
/// With ω = √(k/m) and ζ = c/(2 √(k m)), the energy-preserving step grows as h ≈ h0 e^{ζ ω t} and ends after about
/// 1/(ζ ω h0) steps. Source: Sharma, Patil, Woolsey, section 5.2.
///
/// Discretized by the rule `midpoint`. What the generator found:
///
/// * Autonomous; a force acts
/// * `L = T(v) + U(t, q)` with a constant mass matrix
/// * The step's equation in `v` is linear, and the whole step one constant matrix, computed once per run
#[derive(
    ::core::clone::Clone,
    ::core::marker::Copy,
    ::core::fmt::Debug,
    ::core::cmp::PartialEq
)]
#[allow(non_snake_case)]
pub struct DampedOscillator<T = ::core::primitive::f64> {
    /// Mass.
    ///
    /// Parameter `m`, 1 by default.
    pub m: T,
    /// Stiffness.
    ///
    /// Parameter `k`, 4 by default.
    pub k: T,
    /// Damping: the force −c v.
    ///
    /// Parameter `c`, 0.04 by default.
    pub c: T,
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
    impl ::core::default::Default for DampedOscillator<f64> {
        fn default() -> Self {
            Self { m: 1.0, k: 4.0, c: 0.04 }
        }
    }

    impl<T: ::vi_core::real::Real> DampedOscillator<T> {
        /// The same system in another kind of number, every parameter rounded to it.
        pub fn convert<U: ::vi_core::real::Real>(&self) -> DampedOscillator<U> {
            DampedOscillator {
                m: U::real(self.m.to_f64()),
                k: U::real(self.k.to_f64()),
                c: U::real(self.c.to_f64()),
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T>
    for DampedOscillator<T> {
        fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
            match name {
                "m" => ::core::option::Option::Some(&mut self.m),
                "k" => ::core::option::Option::Some(&mut self.k),
                "c" => ::core::option::Option::Some(&mut self.c),
                _ => ::core::option::Option::None,
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::Lagrangian<1, T> for DampedOscillator<T> {
        const NAME: &'static str = "DampedOscillator";
        const COORDINATES: [&'static str; 1] = ["x"];
        const AUTONOMOUS: bool = true;
        const FORCED: bool = true;
        const CYCLIC: [bool; 1] = [false];
        const PARAMETERS: &'static [&'static str] = &["m", "k", "c"];
        fn parameter(&self, index: usize) -> T {
            [self.m, self.k, self.c][index]
        }

        /// `L = m*dot(x)^2/2 - k*x^2/2`
        ///
        /// 7 operations.
        #[inline]
        fn lagrangian(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> T {
            let [x_dot]: [T; 1] = (*v).into();
            let [x]: [T; 1] = (*q).into();
            let real = T::real;
            self.m * (x_dot * x_dot) * real(0.5) - self.k * (x * x) * real(0.5)
        }

        /// `v·L_v − L = m*dot(x)^2/2 + k*x^2/2`
        ///
        /// 7 operations.
        #[inline]
        fn energy(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> T {
            let [x_dot]: [T; 1] = (*v).into();
            let [x]: [T; 1] = (*q).into();
            let real = T::real;
            self.m * (x_dot * x_dot) * real(0.5) + self.k * (x * x) * real(0.5)
        }

        /// `p_x = m*dot(x)`
        ///
        /// 1 operation.
        #[inline]
        fn momentum(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::SVector<T, 1> {
            let [x_dot]: [T; 1] = (*v).into();
            ::vi_core::SVector::from([self.m * x_dot])
        }

        /// `f_x = -c*dot(x)`
        ///
        /// 2 operations.
        #[inline]
        fn force(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::SVector<T, 1> {
            let [x_dot]: [T; 1] = (*v).into();
            ::vi_core::SVector::from([-(self.c * x_dot)])
        }

        /// Solves `M a = L_q + f − L_vt − L_vq v`.
        ///
        /// 4 operations.
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::core::result::Result<::vi_core::SVector<T, 1>, ::vi_core::StepError> {
            let time = t;
            let [x_dot]: [T; 1] = (*v).into();
            let [x]: [T; 1] = (*q).into();
            let mass: ::vi_core::nalgebra::SMatrix<T, 1, 1> = ::vi_core::nalgebra::SMatrix::from_row_slice(
                &[self.m],
            );
            let applied: ::vi_core::SVector<T, 1> = ::vi_core::SVector::from([
                -(self.c * x_dot + self.k * x),
            ]);
            ::vi_core::support::acceleration(time, &mass, &applied)
        }

        #[inline]
        fn flow(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            p: &::vi_core::SVector<T, 1>,
        ) -> ::core::result::Result<
            ::vi_core::lagrangian::Flow<1, T>,
            ::vi_core::StepError,
        > {
            let at_rest = ::vi_core::collocation::Collocation::point(
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
            let force = ::vi_core::collocation::Collocation::point(self, t, q, &velocity)
                .force;
            let power = ::vi_core::collocation::Collocation::power(
                self,
                t,
                q,
                &velocity,
            );
            ::core::result::Result::Ok(::vi_core::lagrangian::Flow {
                v: velocity,
                force,
                power,
            })
        }

        /// The first of what L and f are made of that is not finite here.
        ///
        /// 9 operations.
        #[cold]
        fn non_finite(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::core::option::Option<&'static str> {
            let [x_dot]: [T; 1] = (*v).into();
            let [x]: [T; 1] = (*q).into();
            let real = T::real;
            let values = [
                ("m", self.m),
                ("k", self.k),
                ("c", self.c),
                ("dot(x)", x_dot),
                ("x", x),
                (
                    "m*dot(x)^2/2 - k*x^2/2",
                    self.m * (x_dot * x_dot) * real(0.5) - self.k * (x * x) * real(0.5),
                ),
                ("-c*dot(x)", -(self.c * x_dot)),
            ];
            values
                .into_iter()
                .find(|(_, value)| !value.is_finite())
                .map(|(text, _)| text)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::collocation::Collocation<1, T>
    for DampedOscillator<T> {
        type Mass = ::vi_core::nalgebra::SMatrix<T, 1, 1>;
        type PointMatrix = ::vi_core::nalgebra::SMatrix<T, 1, 1>;
        const CONSTANT_MASS: bool = true;
        const SEPARABLE: bool = false;

        /// L_v, M, and
        ///
        /// `L_q + f_x = -c*dot(x) - k*x`
        ///
        /// 5 operations.
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::collocation::Point<1, T, Self::Mass> {
            let [x_dot]: [T; 1] = (*v).into();
            let [x]: [T; 1] = (*q).into();
            ::vi_core::collocation::Point {
                momentum: ::vi_core::SVector::from([self.m * x_dot]),
                force: ::vi_core::SVector::from([-(self.c * x_dot + self.k * x)]),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(&[self.m]),
            }
        }

        /// M = ∂L_v/∂v, ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.
        ///
        /// 2 operations.
        #[inline(always)]
        fn point_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::collocation::PointDerivatives<Self::PointMatrix> {
            let real = T::real;
            ::vi_core::collocation::PointDerivatives {
                momentum_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(&[real(0.0)]),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(&[self.m]),
                force_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(&[-self.k]),
                force_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(&[-self.c]),
            }
        }

        /// `dE/dt = -c*dot(x)^2`
        ///
        /// 3 operations.
        #[inline]
        fn power(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> T {
            let [x_dot]: [T; 1] = (*v).into();
            -(self.c * (x_dot * x_dot))
        }
    }

    impl ::vi_core::stepping::Convertible<1> for DampedOscillator<f64> {
        type In<T: ::vi_core::real::Real> = DampedOscillator<T>;
        #[inline(always)]
        fn convert<T: ::vi_core::real::Real>(&self) -> DampedOscillator<T> {
            self.convert()
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<1, T>
    for DampedOscillator<T> {
        /// `ld = h*L`
        ///
        /// 10 operations.
        #[inline]
        fn ld(&self, interval: &::vi_core::Interval<1, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            h
                * (self.m * (x_dot * x_dot) * real(0.5)
                    - self.k * (x_mid * x_mid) * real(0.5))
        }

        /// `d1_ld = L_v_x*v_x - L`
        ///
        /// 9 operations.
        #[inline]
        fn d1_ld(&self, interval: &::vi_core::Interval<1, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            self.m * (x_dot * x_dot) * real(0.5) + self.k * (x_mid * x_mid) * real(0.5)
        }

        /// `d2_ld_x = h*L_x/2 - L_v_x`
        ///
        /// 8 operations.
        #[inline]
        fn d2_ld(
            &self,
            interval: &::vi_core::Interval<1, T>,
        ) -> ::vi_core::SVector<T, 1> {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            ::vi_core::SVector::from([
                -(self.m * x_dot) - self.k * h * real(0.5) * x_mid,
            ])
        }

        /// `d3_ld = L - L_v_x*v_x`
        ///
        /// 10 operations.
        #[inline]
        fn d3_ld(&self, interval: &::vi_core::Interval<1, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            -(self.m * (x_dot * x_dot) * real(0.5)
                + self.k * (x_mid * x_mid) * real(0.5))
        }

        /// `d4_ld_x = L_v_x + h*L_x/2`
        ///
        /// 7 operations.
        #[inline]
        fn d4_ld(
            &self,
            interval: &::vi_core::Interval<1, T>,
        ) -> ::vi_core::SVector<T, 1> {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            let x_mid = (x0 + x1) * real(0.5);
            ::vi_core::SVector::from([self.m * x_dot - self.k * h * real(0.5) * x_mid])
        }

        /// `fd_minus_x = h*f_x/2`
        ///
        /// 4 operations.
        #[inline]
        fn fd_minus(
            &self,
            interval: &::vi_core::Interval<1, T>,
        ) -> ::vi_core::SVector<T, 1> {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            ::vi_core::SVector::from([-(self.c * h * real(0.5) * x_dot)])
        }

        /// `fd_plus_x = h*f_x/2`
        ///
        /// 4 operations.
        #[inline]
        fn fd_plus(
            &self,
            interval: &::vi_core::Interval<1, T>,
        ) -> ::vi_core::SVector<T, 1> {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            ::vi_core::SVector::from([-(self.c * h * real(0.5) * x_dot)])
        }

        /// `gd_minus = -h*v_x*f_x/2`
        ///
        /// 4 operations.
        #[inline]
        fn gd_minus(&self, interval: &::vi_core::Interval<1, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            self.c * h * real(0.5) * (x_dot * x_dot)
        }

        /// `gd_plus = -h*v_x*f_x/2`
        ///
        /// 4 operations.
        #[inline]
        fn gd_plus(&self, interval: &::vi_core::Interval<1, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [x0]: [T; 1] = interval.q0.into();
            let [x1]: [T; 1] = interval.q1.into();
            let x_dot = (x1 - x0) / h;
            let real = T::real;
            self.c * h * real(0.5) * (x_dot * x_dot)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<1, T>
    for DampedOscillator<T> {
        type Jacobian = ::vi_core::nalgebra::SMatrix<T, 1, 1>;
        type StepMatrix = ::vi_core::nalgebra::SMatrix<T, 1, 1>;
        const CONSTANT_JACOBIAN: bool = true;
        const CLOSED_FORM: bool = true;
        const INLINED: bool = true;

        /// `residual_x = L_v_x - h*L_x/2 - h*f_x/2 - p0_x_low - p0_x`
        ///
        /// 19 operations.
        #[inline(always)]
        fn momentum_equation(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::MomentumEquation<1, T, Self::Jacobian> {
            let [x0]: [T; 1] = node.q.into();
            let [x0_low]: [T; 1] = node.q_low.into();
            let [p0_x]: [T; 1] = node.p.into();
            let [p0_x_low]: [T; 1] = node.p_low.into();
            let [x_dot]: [T; 1] = (*v).into();
            let real = T::real;
            let x_mid = x0 + (h * real(0.5) * x_dot + x0_low);
            let s1 = self.c * real(0.5);
            ::vi_core::stepping::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    self.m * x_dot - p0_x
                        + ((self.k * real(0.5) * x_mid + s1 * x_dot) * h - p0_x_low),
                ]),
                jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[self.m + (s1 + self.k * h * real(0.25)) * h],
                ),
            }
        }

        /// The residual, its rounding scale, and
        ///
        /// `p1_x − p0_x = h*L_x + h*f_x`
        ///
        /// 32 operations.
        #[inline(always)]
        fn momentum_residual(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::MomentumResidual<1, T> {
            let [x0]: [T; 1] = node.q.into();
            let [x0_low]: [T; 1] = node.q_low.into();
            let [p0_x]: [T; 1] = node.p.into();
            let [p0_x_low]: [T; 1] = node.p_low.into();
            let [x_dot]: [T; 1] = (*v).into();
            let real = T::real;
            let x_mid = x0 + (h * real(0.5) * x_dot + x0_low);
            let s1 = self.m * x_dot;
            ::vi_core::stepping::MomentumResidual {
                residual: ::vi_core::SVector::from([
                    s1 - p0_x
                        + ((self.k * real(0.5) * x_mid + self.c * real(0.5) * x_dot) * h
                            - p0_x_low),
                ]),
                scale: ::vi_core::SVector::from([
                    p0_x.abs() + s1.abs() + (self.c * h * x_dot).abs() * real(0.5)
                        + (self.k * h * x_mid).abs() * real(0.5),
                ]),
                increment: ::vi_core::SVector::from([
                    -((self.k * x_mid + self.c * x_dot) * h),
                ]),
            }
        }

        /// How the residual and `p1 − p0` change with the coordinates of the node and with v.
        ///
        /// 11 operations.
        #[inline(always)]
        fn momentum_derivatives(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix> {
            let real = T::real;
            let s1 = self.k * h;
            let s2 = s1 * real(0.5);
            ::vi_core::stepping::MomentumDerivatives {
                residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(&[s2]),
                residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[self.m + (self.c * real(0.5) + s1 * real(0.25)) * h],
                ),
                increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(&[-s1]),
                increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[(-self.c - s2) * h],
                ),
            }
        }

        /// `E1 = L_v_x*v_x - L + h*v_x*f_x/2`
        ///
        /// 15 operations.
        #[inline(always)]
        fn discrete_energy(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> T {
            let [x0]: [T; 1] = node.q.into();
            let [x0_low]: [T; 1] = node.q_low.into();
            let [x_dot]: [T; 1] = (*v).into();
            let real = T::real;
            let x_mid = x0 + (h * real(0.5) * x_dot + x0_low);
            let s1 = x_dot * x_dot;
            self.m * s1 * real(0.5) + self.k * (x_mid * x_mid) * real(0.5)
                - self.c * h * real(0.5) * s1
        }

        /// What the rounding of the residual is measured in, by running error analysis.
        #[cold]
        fn momentum_rounding(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::SVector<T, 1> {
            ::vi_core::support::momentum_rounding(
                &self.convert::<::vi_core::real::Rounded>(),
                node,
                h,
                v,
            )
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<1, T>
    for DampedOscillator<T> {
        /// `D = (-c*dot(x) - k*x)*dot(dot(x)) + k*dot(x)^2`
        ///
        /// 7 operations.
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 1>,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let time = t;
            let [x_ddot]: [T; 1] = ::vi_core::Lagrangian::acceleration(self, t, q, v)?
                .into();
            let [x_dot]: [T; 1] = (*v).into();
            let [x]: [T; 1] = (*q).into();
            ::vi_core::support::step_density(
                time,
                self.k * (x_dot * x_dot) - (self.c * x_dot + self.k * x) * x_ddot,
            )
        }

        /// `energy_residual = h*v_x*L_x/2 - L - E0_low - E0 + v_x*p0_x_low + v_x*p0_x`
        ///
        /// 40 operations.
        #[inline(always)]
        fn extended_system(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::ExtendedSystem<1, T, Self::Jacobian> {
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [x0]: [T; 1] = node.q.into();
            let [x0_low]: [T; 1] = node.q_low.into();
            let [p0_x]: [T; 1] = node.p.into();
            let [p0_x_low]: [T; 1] = node.p_low.into();
            let [x_dot]: [T; 1] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let x_mid = x0 + (s1 * x_dot + x0_low);
            let s2 = self.k * h * real(0.25);
            let s3 = self.m * x_dot;
            let s4 = self.k * x_mid;
            let s5 = s4 * real(0.5) + self.c * x_dot * real(0.5);
            let s6 = s2 * x_dot;
            ::vi_core::stepping::ExtendedSystem {
                momentum: ::vi_core::stepping::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        s3 - p0_x + (s5 * h - p0_x_low),
                    ]),
                    jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[self.m + (self.c * real(0.5) + s2) * h],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s5 + s6]),
                energy_residual: self.k * (x_mid * x_mid) * real(0.5) - energy0
                    + (p0_x - s3 * real(0.5)) * x_dot
                    + ((p0_x_low - s4 * s1) * x_dot - energy0_low),
                energy_dv: ::vi_core::SVector::from([s5 - s6]),
                energy_dh: -(self.k * (x_dot * x_dot) * real(0.25)),
            }
        }

        /// Both residuals, their rounding scales, and
        ///
        /// `E1 − E0 = h*v_x*f_x`
        ///
        /// 65 operations.
        #[inline(always)]
        fn extended_residual(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::ExtendedResidual<1, T> {
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [x0]: [T; 1] = node.q.into();
            let [x0_low]: [T; 1] = node.q_low.into();
            let [p0_x]: [T; 1] = node.p.into();
            let [p0_x_low]: [T; 1] = node.p_low.into();
            let [x_dot]: [T; 1] = (*v).into();
            let real = T::real;
            let x_mid = x0 + (h * real(0.5) * x_dot + x0_low);
            let s1 = self.m * x_dot;
            let s2 = self.c * h;
            let s3 = x_dot * x_dot;
            let s4 = self.k * (x_mid * x_mid);
            let s5 = self.k * h;
            let s6 = energy0.abs() + (x_dot * p0_x).abs()
                + (self.m * s3).abs() * real(0.5) + s4.abs() * real(0.5);
            ::vi_core::stepping::ExtendedResidual {
                residual: ::vi_core::SVector::from([
                    s1 - p0_x
                        + ((self.k * real(0.5) * x_mid + self.c * real(0.5) * x_dot) * h
                            - p0_x_low),
                ]),
                scale: ::vi_core::SVector::from([
                    p0_x.abs() + s1.abs() + (s2 * x_dot).abs() * real(0.5)
                        + (s5 * x_mid).abs() * real(0.5),
                ]),
                energy_residual: s4 * real(0.5) - energy0
                    + (p0_x - s1 * real(0.5)) * x_dot
                    + ((p0_x_low - s5 * real(0.5) * x_mid) * x_dot - energy0_low),
                energy_scale: s6 + (s5 * x_dot * x_mid).abs() * real(0.5),
                increment: ::vi_core::stepping::Increment {
                    momentum: ::vi_core::SVector::from([
                        -((self.k * x_mid + self.c * x_dot) * h),
                    ]),
                    energy: -(s2 * s3),
                },
            }
        }

        /// How both residuals, `p1 − p0` and `E1 − E0` change with the coordinates of the node, v and h.
        ///
        /// 37 operations.
        #[inline(always)]
        fn extended_derivatives(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::ExtendedDerivatives<
            1,
            T,
            Self::Jacobian,
            Self::StepMatrix,
        > {
            let [x0]: [T; 1] = node.q.into();
            let [x0_low]: [T; 1] = node.q_low.into();
            let [x_dot]: [T; 1] = (*v).into();
            let real = T::real;
            let x_mid = x0 + (h * real(0.5) * x_dot + x0_low);
            let s1 = self.k * h;
            let s2 = s1 * real(0.25);
            let s3 = x_dot * x_dot;
            let s4 = s1 * real(0.5);
            let s5 = self.k * x_mid;
            let s6 = self.c * x_dot;
            let s7 = s5 * real(0.5) + s6 * real(0.5);
            let s8 = s2 * x_dot;
            let s9 = s4 * x_dot;
            ::vi_core::stepping::ExtendedDerivatives {
                momentum: ::vi_core::stepping::MomentumDerivatives {
                    residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(&[s4]),
                    residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[self.m + (self.c * real(0.5) + s2) * h],
                    ),
                    increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(&[-s1]),
                    increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[(-self.c - s4) * h],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s7 + s8]),
                increment_dh: ::vi_core::SVector::from([-(s5 + s6) - s9]),
                energy_dq: ::vi_core::SVector::from([s5 - s9]),
                energy_dv: ::vi_core::SVector::from([s7 - s8]),
                energy_dh: -(self.k * s3 * real(0.25)),
                energy_increment_dq: ::vi_core::SVector::from([real(0.0)]),
                energy_increment_dv: ::vi_core::SVector::from([-(s6 * (h * real(2.0)))]),
                energy_increment_dh: -(self.c * s3),
            }
        }

        /// What the rounding of both residuals is measured in, by running error analysis.
        #[cold]
        fn extended_rounding(
            &self,
            node: &::vi_core::node::Node<1, T>,
            h: T,
            v: &::vi_core::SVector<T, 1>,
        ) -> ::vi_core::stepping::Rounding<1, T> {
            ::vi_core::support::extended_rounding(
                &self.convert::<::vi_core::real::Rounded>(),
                node,
                h,
                v,
            )
        }
    }

    impl ::vi_core::stepping::Discretized<1> for DampedOscillator<f64> {
        type Steps<T: ::vi_core::real::Real> = DampedOscillator<T>;
        #[inline(always)]
        fn steps<T: ::vi_core::real::Real>(&self) -> DampedOscillator<T> {
            self.convert()
        }
    }

    impl ::vi_core::stepping::Batch<1> for DampedOscillator<f64> {
        type Rows<const W: usize> = DampedOscillator<[f64; W]>;
        fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
            DampedOscillator {
                m: ::core::array::from_fn(|index| systems[index].m),
                k: ::core::array::from_fn(|index| systems[index].k),
                c: ::core::array::from_fn(|index| systems[index].c),
            }
        }

        #[inline(always)]
        fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self {
            DampedOscillator {
                m: rows.m[index],
                k: rows.k[index],
                c: rows.c[index],
            }
        }
    }

    /// Every name that is bound above is one of a function first: a binding may shadow that, and no constant from around.
    use ::core::primitive::{bool, f64, str, usize};
    use ::core::convert::{identity as name, identity as index, identity as t};
    use ::core::convert::{identity as q, identity as v, identity as x_dot};
    use ::core::convert::{identity as x, identity as real, identity as time};
    use ::core::convert::{identity as mass, identity as applied, identity as p};
    use ::core::convert::{identity as at_rest, identity as velocity, identity as force};
    use ::core::convert::{identity as power, identity as values, identity as value};
    use ::core::convert::{identity as text, identity as interval, identity as h};
    use ::core::convert::{identity as x0, identity as x1, identity as x_mid};
    use ::core::convert::{identity as node, identity as x0_low, identity as p0_x};
    use ::core::convert::{identity as p0_x_low, identity as s1, identity as s2};
    use ::core::convert::{
        identity as x_ddot, identity as energy0, identity as energy0_low,
    };

    use ::core::convert::{identity as s3, identity as s4, identity as s5};
    use ::core::convert::{identity as s6, identity as s7, identity as s8};
    use ::core::convert::{identity as s9, identity as systems, identity as rows};
};

/// Checks of [`DampedOscillator`](super::DampedOscillator) at the place that it names.
#[cfg(test)]
#[allow(clippy::all, clippy::pedantic, deprecated)]
mod damped_oscillator_checks {
    fn place() -> ::vi_core::check::Place<1> {
        ::vi_core::check::Place {
            t: 0.0,
            q: [0.8].into(),
            v: [0.5].into(),
            h: 0.05,
        }
    }

    #[::core::prelude::v1::test]
    fn derivatives() {
        let checked = ::vi_core::check::derivatives(
            &super::DampedOscillator::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn slots() {
        let checked = ::vi_core::check::slots(
            &super::DampedOscillator::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn steps() {
        let checked = ::vi_core::check::steps(
            &super::DampedOscillator::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn energy_equations() {
        let checked = ::vi_core::check::energy_equations(
            &super::DampedOscillator::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn order() {
        let checked = ::vi_core::check::order(
            &super::DampedOscillator::default(),
            &place(),
            2,
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn reversibility() {
        let checked = ::vi_core::check::reversibility(
            &super::DampedOscillator::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn energy() {
        let checked = ::vi_core::check::energy(
            &super::DampedOscillator::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }
}
