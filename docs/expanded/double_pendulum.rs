// `DoublePendulum`: L = l1^2*(m1 + m2)*dot(θ1)^2/2 + m2*l2^2*dot(θ2)^2/2 + m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) + l1*g*(m1 + m2)*cos(θ1) + m2*l2*g*cos(θ2)
//
// Operations of the functions for
//    146  every method: lagrangian 32, energy 32, momentum 17, force 0, acceleration 33, non_finite 32
//     73  Gauss, EnergyPreservingGauss: point 37, point_derivatives 36, power 0
//    286  FixedStep, Composition, Ensemble by the rule `midpoint`: momentum_equation 75, momentum_residual 81, momentum_derivatives 79, discrete_energy 51
//    473  EnergyPreserving by the rule `midpoint`: step_density 56, extended_system 136, extended_residual 140, extended_derivatives 141
//    222  DiscreteLagrangian by the rule `midpoint`: ld 37, d1_ld 48, d2_ld 45, d3_ld 48, d4_ld 44, fd_minus 0, fd_plus 0, gd_minus 0, gd_plus 0

/// Double pendulum in absolute angles; θ1 = θ2 = 0 hangs down.
///
/// The mass matrix depends on the configuration. Released from (2, 2) rad, the energy-preserving step ends at
/// t = 4.025. Source: Landau and Lifshitz, Mechanics, section 5.
///
/// Discretized by the rule `midpoint`. What the generator found:
///
/// * Autonomous and without a force: the energy is conserved
/// * The mass matrix depends on the state
/// * The step's equation in `v` is nonlinear: its Jacobian `A` depends on `v`, and Newton's iteration gives the step
/// * `A` is dense, not symmetric; solved in closed form
#[derive(
    ::core::clone::Clone,
    ::core::marker::Copy,
    ::core::fmt::Debug,
    ::core::cmp::PartialEq
)]
#[allow(non_snake_case)]
pub struct DoublePendulum<T = ::core::primitive::f64> {
    /// Upper mass.
    ///
    /// Parameter `m1`, 1 by default.
    pub m1: T,
    /// Lower mass.
    ///
    /// Parameter `m2`, 1 by default.
    pub m2: T,
    /// Length of the upper rod.
    ///
    /// Parameter `l1`, 1 by default.
    pub l1: T,
    /// Length of the lower rod.
    ///
    /// Parameter `l2`, 1 by default.
    pub l2: T,
    /// Gravity.
    ///
    /// Parameter `g`, 9.81 by default.
    pub g: T,
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
    impl ::core::default::Default for DoublePendulum<f64> {
        fn default() -> Self {
            Self {
                m1: 1.0,
                m2: 1.0,
                l1: 1.0,
                l2: 1.0,
                g: 9.81,
            }
        }
    }

    impl<T: ::vi_core::real::Real> DoublePendulum<T> {
        /// The same system in another kind of number, every parameter rounded to it.
        pub fn convert<U: ::vi_core::real::Real>(&self) -> DoublePendulum<U> {
            DoublePendulum {
                m1: U::real(self.m1.to_f64()),
                m2: U::real(self.m2.to_f64()),
                l1: U::real(self.l1.to_f64()),
                l2: U::real(self.l2.to_f64()),
                g: U::real(self.g.to_f64()),
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T>
    for DoublePendulum<T> {
        fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
            match name {
                "m1" => ::core::option::Option::Some(&mut self.m1),
                "m2" => ::core::option::Option::Some(&mut self.m2),
                "l1" => ::core::option::Option::Some(&mut self.l1),
                "l2" => ::core::option::Option::Some(&mut self.l2),
                "g" => ::core::option::Option::Some(&mut self.g),
                _ => ::core::option::Option::None,
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::Lagrangian<2, T> for DoublePendulum<T> {
        const NAME: &'static str = "DoublePendulum";
        const COORDINATES: [&'static str; 2] = ["θ1", "θ2"];
        const AUTONOMOUS: bool = true;
        const FORCED: bool = false;
        const CYCLIC: [bool; 2] = [false, false];
        const PARAMETERS: &'static [&'static str] = &["m1", "m2", "l1", "l2", "g"];
        fn parameter(&self, index: usize) -> T {
            [self.m1, self.m2, self.l1, self.l2, self.g][index]
        }

        /// `L = l1^2*(m1 + m2)*dot(θ1)^2/2 + m2*l2^2*dot(θ2)^2/2 + m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) + l1*g*(m1 + m2)*cos(θ1) + m2*l2*g*cos(θ2)`
        ///
        /// 32 operations.
        #[inline]
        fn lagrangian(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1, θ2]);
            let s4 = self.l1 * self.l1 * s1 * real(0.5) * θ1_dot
                + self.m2 * self.l1 * self.l2 * θ2_dot * (cos2 * cos3 + sin2 * sin3);
            let s5 = self.m2 * (self.l2 * self.l2) * (θ2_dot * θ2_dot) * real(0.5)
                + self.l1 * self.g * s1 * cos2 + self.m2 * self.l2 * self.g * cos3;
            s5 + s4 * θ1_dot
        }

        /// `v·L_v − L = m2*l2^2*dot(θ2)^2/2 + m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) - l1*g*(m1 + m2)*cos(θ1) - m2*l2*g*cos(θ2) + m1*l1^2*dot(θ1)^2/2 + m2*l1^2*dot(θ1)^2/2`
        ///
        /// 32 operations.
        #[inline]
        fn energy(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1, θ2]);
            let s4 = self.m2 * self.l1 * self.l2 * θ2_dot * (cos2 * cos3 + sin2 * sin3)
                + s1 * (self.l1 * self.l1) * real(0.5) * θ1_dot;
            let s5 = self.m2 * (self.l2 * self.l2) * (θ2_dot * θ2_dot) * real(0.5)
                - self.l1 * self.g * s1 * cos2 - self.m2 * self.l2 * self.g * cos3;
            s5 + s4 * θ1_dot
        }

        /// `p_θ1 = l1^2*(m1 + m2)*dot(θ1) + m2*l1*l2*dot(θ2)*cos(θ1 - θ2)`
        ///
        /// `p_θ2 = m2*l2^2*dot(θ2) + m2*l1*l2*dot(θ1)*cos(θ1 - θ2)`
        ///
        /// 17 operations.
        #[inline]
        fn momentum(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::SVector<T, 2> {
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let s1 = (θ1 - θ2).cos();
            let s2 = self.m2 * self.l1 * self.l2;
            ::vi_core::SVector::from([
                self.l1 * self.l1 * (self.m1 + self.m2) * θ1_dot + s2 * θ2_dot * s1,
                self.m2 * (self.l2 * self.l2) * θ2_dot + s2 * θ1_dot * s1,
            ])
        }

        /// `f_θ1 = 0`
        ///
        /// `f_θ2 = 0`
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
        /// 33 operations.
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<::vi_core::SVector<T, 2>, ::vi_core::StepError> {
            let time = t;
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1, θ2]);
            let s4 = self.m2 * self.l1 * self.l2;
            let s5 = s4 * (cos2 * cos3 + sin2 * sin3);
            let s6 = sin2 * cos3 - cos2 * sin3;
            let mass: ::vi_core::nalgebra::SMatrix<T, 2, 2> = ::vi_core::nalgebra::SMatrix::from_row_slice(
                &[self.l1 * self.l1 * s1, s5, s5, self.m2 * (self.l2 * self.l2)],
            );
            let applied: ::vi_core::SVector<T, 2> = ::vi_core::SVector::from([
                -(self.l1 * self.g * s1 * sin2 + s4 * (θ2_dot * θ2_dot) * s6),
                s4 * (θ1_dot * θ1_dot) * s6 - self.m2 * self.l2 * self.g * sin3,
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
        /// 32 operations.
        #[cold]
        fn non_finite(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::option::Option<&'static str> {
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1, θ2]);
            let s4 = cos2 * cos3 + sin2 * sin3;
            let s5 = self.m2 * (self.l2 * self.l2) * (θ2_dot * θ2_dot) * real(0.5)
                + self.l1 * self.g * s1 * cos2 + self.m2 * self.l2 * self.g * cos3;
            let values = [
                ("m1", self.m1),
                ("m2", self.m2),
                ("l1", self.l1),
                ("l2", self.l2),
                ("g", self.g),
                ("dot(θ1)", θ1_dot),
                ("dot(θ2)", θ2_dot),
                ("θ1", θ1),
                ("θ2", θ2),
                ("cos(θ1 - θ2)", s4),
                ("cos(θ1)", cos2),
                ("cos(θ2)", cos3),
                (
                    "l1^2*(m1 + m2)*dot(θ1)^2/2 + m2*l2^2*dot(θ2)^2/2 + m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) + l1*g*(m1 + m2)*cos(θ1) + m2*l2*g*cos(θ2)",
                    s5
                        + (self.l1 * self.l1 * s1 * real(0.5) * θ1_dot
                            + self.m2 * self.l1 * self.l2 * θ2_dot * s4) * θ1_dot,
                ),
            ];
            values
                .into_iter()
                .find(|(_, value)| !value.is_finite())
                .map(|(text, _)| text)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::collocation::Collocation<2, T>
    for DoublePendulum<T> {
        type Mass = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        type PointMatrix = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        const CONSTANT_MASS: bool = false;
        const SEPARABLE: bool = false;

        /// L_v, M, and
        ///
        /// `L_q + f_θ1 = -m2*l1*l2*dot(θ1)*dot(θ2)*sin(θ1 - θ2) - l1*g*(m1 + m2)*sin(θ1)`
        ///
        /// `L_q + f_θ2 = m2*l1*l2*dot(θ1)*dot(θ2)*sin(θ1 - θ2) - m2*l2*g*sin(θ2)`
        ///
        /// 37 operations.
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::collocation::Point<2, T, Self::Mass> {
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1, θ2]);
            let s4 = cos2 * cos3 + sin2 * sin3;
            let s5 = self.l1 * self.l1 * s1;
            let s6 = self.m2 * self.l1 * self.l2;
            let s7 = s6 * s4;
            let s8 = self.m2 * (self.l2 * self.l2);
            let s9 = s6 * θ1_dot;
            let s10 = s9 * θ2_dot * (sin2 * cos3 - cos2 * sin3);
            ::vi_core::collocation::Point {
                momentum: ::vi_core::SVector::from([
                    s5 * θ1_dot + s6 * θ2_dot * s4,
                    s8 * θ2_dot + s9 * s4,
                ]),
                force: ::vi_core::SVector::from([
                    -(s10 + self.l1 * self.g * s1 * sin2),
                    s10 - self.m2 * self.l2 * self.g * sin3,
                ]),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(&[s5, s7, s7, s8]),
            }
        }

        /// M = ∂L_v/∂v, ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.
        ///
        /// 36 operations.
        #[inline(always)]
        fn point_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::collocation::PointDerivatives<Self::PointMatrix> {
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1, θ2]);
            let s4 = cos2 * cos3 + sin2 * sin3;
            let s5 = self.m2 * self.l1 * self.l2;
            let s6 = s5 * θ1_dot;
            let s7 = s6 * θ2_dot * s4;
            let s8 = s5 * s4;
            let s9 = sin2 * cos3 - cos2 * sin3;
            let s10 = s5 * θ2_dot * s9;
            let s11 = -s10;
            let s12 = s6 * s9;
            let s13 = -s12;
            ::vi_core::collocation::PointDerivatives {
                momentum_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[s11, s10, s13, s12],
                ),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[self.l1 * self.l1 * s1, s8, s8, self.m2 * (self.l2 * self.l2)],
                ),
                force_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[
                        -(s7 + self.l1 * self.g * s1 * cos2),
                        s7,
                        s7,
                        -(s7 + self.m2 * self.l2 * self.g * cos3),
                    ],
                ),
                force_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[s11, s13, s10, s12],
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
    }

    impl ::vi_core::stepping::Convertible<2> for DoublePendulum<f64> {
        type In<T: ::vi_core::real::Real> = DoublePendulum<T>;
        #[inline(always)]
        fn convert<T: ::vi_core::real::Real>(&self) -> DoublePendulum<T> {
            self.convert()
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<2, T>
    for DoublePendulum<T> {
        /// `ld = h*L`
        ///
        /// 37 operations.
        #[inline]
        fn ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
            let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
            let θ1_dot = (θ1_1 - θ1_0) / h;
            let θ2_dot = (θ2_1 - θ2_0) / h;
            let real = T::real;
            let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
            let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s4 = self.l1 * self.l1 * s1 * real(0.5) * θ1_dot
                + self.m2 * self.l1 * self.l2 * θ2_dot * (cos2 * cos3 + sin2 * sin3);
            let s5 = self.m2 * (self.l2 * self.l2) * (θ2_dot * θ2_dot) * real(0.5)
                + self.l1 * self.g * s1 * cos2 + self.m2 * self.l2 * self.g * cos3;
            h * (s5 + s4 * θ1_dot)
        }

        /// `d1_ld = L_v_θ1*v_θ1 - L + L_v_θ2*v_θ2`
        ///
        /// 48 operations.
        #[inline]
        fn d1_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
            let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
            let θ1_dot = (θ1_1 - θ1_0) / h;
            let θ2_dot = (θ2_1 - θ2_0) / h;
            let real = T::real;
            let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
            let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
            let s1 = self.m1 + self.m2;
            let s2 = self.m2 * (self.l2 * self.l2);
            let s3 = self.l1 * self.l1 * s1;
            let [(sin4, cos4), (sin5, cos5)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s6 = cos4 * cos5 + sin4 * sin5;
            let s7 = self.m2 * self.l1 * self.l2;
            let s8 = s7 * θ1_dot;
            let s9 = θ1_dot * (s3 * θ1_dot + s7 * θ2_dot * s6)
                + θ2_dot * (s2 * θ2_dot + s8 * s6)
                - s3 * (θ1_dot * θ1_dot) * real(0.5);
            let s10 = s9 - s2 * (θ2_dot * θ2_dot) * real(0.5) - s8 * θ2_dot * s6
                - self.l1 * self.g * s1 * cos4;
            s10 - self.m2 * self.l2 * self.g * cos5
        }

        /// `d2_ld_θ1 = h*L_θ1/2 - L_v_θ1`
        ///
        /// `d2_ld_θ2 = h*L_θ2/2 - L_v_θ2`
        ///
        /// 45 operations.
        #[inline]
        fn d2_ld(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let h = interval.t1 - interval.t0;
            let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
            let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
            let θ1_dot = (θ1_1 - θ1_0) / h;
            let θ2_dot = (θ2_1 - θ2_0) / h;
            let real = T::real;
            let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
            let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s4 = cos2 * cos3 + sin2 * sin3;
            let s5 = self.m2 * self.l1 * self.l2;
            let s6 = s5 * θ1_dot;
            let s7 = s6 * θ2_dot * (sin2 * cos3 - cos2 * sin3);
            let s8 = h * real(0.5);
            ::vi_core::SVector::from([
                -(self.l1 * self.l1 * s1 * θ1_dot + s5 * θ2_dot * s4)
                    - s8 * (s7 + self.l1 * self.g * s1 * sin2),
                s8 * (s7 - self.m2 * self.l2 * self.g * sin3)
                    - (self.m2 * (self.l2 * self.l2) * θ2_dot + s6 * s4),
            ])
        }

        /// `d3_ld = L - L_v_θ1*v_θ1 - L_v_θ2*v_θ2`
        ///
        /// 48 operations.
        #[inline]
        fn d3_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
            let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
            let θ1_dot = (θ1_1 - θ1_0) / h;
            let θ2_dot = (θ2_1 - θ2_0) / h;
            let real = T::real;
            let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
            let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
            let s1 = self.m1 + self.m2;
            let s2 = self.m2 * (self.l2 * self.l2);
            let s3 = self.l1 * self.l1 * s1;
            let [(sin4, cos4), (sin5, cos5)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s6 = cos4 * cos5 + sin4 * sin5;
            let s7 = self.m2 * self.l1 * self.l2;
            let s8 = s7 * θ1_dot;
            let s9 = s3 * (θ1_dot * θ1_dot) * real(0.5)
                + s2 * (θ2_dot * θ2_dot) * real(0.5) + s8 * θ2_dot * s6
                + self.l1 * self.g * s1 * cos4;
            s9 + self.m2 * self.l2 * self.g * cos5
                - θ1_dot * (s3 * θ1_dot + s7 * θ2_dot * s6)
                - θ2_dot * (s2 * θ2_dot + s8 * s6)
        }

        /// `d4_ld_θ1 = L_v_θ1 + h*L_θ1/2`
        ///
        /// `d4_ld_θ2 = L_v_θ2 + h*L_θ2/2`
        ///
        /// 44 operations.
        #[inline]
        fn d4_ld(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let h = interval.t1 - interval.t0;
            let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
            let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
            let θ1_dot = (θ1_1 - θ1_0) / h;
            let θ2_dot = (θ2_1 - θ2_0) / h;
            let real = T::real;
            let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
            let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
            let s1 = self.m1 + self.m2;
            let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s4 = cos2 * cos3 + sin2 * sin3;
            let s5 = self.m2 * self.l1 * self.l2;
            let s6 = s5 * θ1_dot;
            let s7 = s6 * θ2_dot * (sin2 * cos3 - cos2 * sin3);
            let s8 = h * real(0.5);
            ::vi_core::SVector::from([
                self.l1 * self.l1 * s1 * θ1_dot + s5 * θ2_dot * s4
                    - s8 * (s7 + self.l1 * self.g * s1 * sin2),
                self.m2 * (self.l2 * self.l2) * θ2_dot + s6 * s4
                    + s8 * (s7 - self.m2 * self.l2 * self.g * sin3),
            ])
        }

        /// `fd_minus_θ1 = 0`
        ///
        /// `fd_minus_θ2 = 0`
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

        /// `fd_plus_θ1 = 0`
        ///
        /// `fd_plus_θ2 = 0`
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
    for DoublePendulum<T> {
        type Jacobian = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        type StepMatrix = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        const CONSTANT_JACOBIAN: bool = false;
        const INLINED: bool = true;

        /// `residual_θ1 = L_v_θ1 - h*L_θ1/2 - p0_θ1_low - p0_θ1`
        ///
        /// `residual_θ2 = L_v_θ2 - h*L_θ2/2 - p0_θ2_low - p0_θ2`
        ///
        /// 75 operations.
        #[inline(always)]
        fn momentum_equation(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumEquation<2, T, Self::Jacobian> {
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [p0_θ1, p0_θ2]: [T; 2] = node.p.into();
            let [p0_θ1_low, p0_θ2_low]: [T; 2] = node.p_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let s3 = self.m2 * (self.l2 * self.l2);
            let s4 = self.l1 * self.l1;
            let [(sin5, cos5), (sin6, cos6)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s7 = cos5 * cos6 + sin5 * sin6;
            let s8 = self.m2 * self.l1 * self.l2;
            let s9 = s8 * θ1_dot;
            let s10 = s9 * θ2_dot;
            let s11 = s10 * s7;
            let s12 = self.l1 * self.g * s2;
            let s13 = self.m2 * self.l2 * self.g;
            let s14 = sin5 * cos6 - cos5 * sin6;
            let s15 = s10 * s14;
            let s16 = h * h * real(0.25);
            let s17 = s8 * s7;
            let s18 = s8 * real(0.5) * (θ1_dot + θ2_dot) * s14;
            let s19 = s11 * (h * real(0.25));
            ::vi_core::stepping::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    s4 * s2 * θ1_dot + s8 * θ2_dot * s7 - p0_θ1
                        - (p0_θ1_low - s1 * (s15 + s12 * sin5)),
                    s3 * θ2_dot + s9 * s7 - p0_θ2
                        - (p0_θ2_low + s1 * (s15 - s13 * sin6)),
                ]),
                jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[
                        s2 * s4 + s16 * (s11 + s12 * cos5),
                        s17 + (s18 - s19) * h,
                        s17 - (s18 + s19) * h,
                        s3 + s16 * (s11 + s13 * cos6),
                    ],
                ),
            }
        }

        /// The residual, its rounding scale, and
        ///
        /// `p1_θ1 − p0_θ1 = h*L_θ1`
        ///
        /// `p1_θ2 − p0_θ2 = h*L_θ2`
        ///
        /// 81 operations.
        #[inline(always)]
        fn momentum_residual(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumResidual<2, T> {
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [p0_θ1, p0_θ2]: [T; 2] = node.p.into();
            let [p0_θ1_low, p0_θ2_low]: [T; 2] = node.p_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let s3 = self.m2 * (self.l2 * self.l2) * θ2_dot;
            let [(sin4, cos4), (sin5, cos5)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s6 = cos4 * cos5 + sin4 * sin5;
            let s7 = self.l1 * self.l1;
            let s8 = self.m2 * self.l1 * self.l2;
            let s9 = s8 * θ2_dot * s6;
            let s10 = s8 * θ1_dot;
            let s11 = s10 * s6;
            let s12 = s10 * θ2_dot * (sin4 * cos5 - cos4 * sin5);
            let s13 = self.l1 * self.g;
            let s14 = s12 + s13 * s2 * sin4;
            let s15 = self.m2 * self.l2 * self.g * sin5;
            let s16 = s12 - s15;
            let s17 = self.m1.abs() + self.m2.abs();
            let s18 = s12.abs();
            let s19 = h.abs() * real(0.5);
            ::vi_core::stepping::MomentumResidual {
                residual: ::vi_core::SVector::from([
                    s7 * s2 * θ1_dot + s9 - p0_θ1 - (p0_θ1_low - s1 * s14),
                    s3 + s11 - p0_θ2 - (p0_θ2_low + s1 * s16),
                ]),
                scale: ::vi_core::SVector::from([
                    p0_θ1.abs() + s17 * (s7 * θ1_dot).abs() + s9.abs()
                        + s19 * (s18 + s17 * (s13 * sin4).abs()),
                    p0_θ2.abs() + s3.abs() + s11.abs() + s19 * (s18 + s15.abs()),
                ]),
                increment: ::vi_core::SVector::from([-(h * s14), h * s16]),
            }
        }

        /// How the residual and `p1 − p0` change with the coordinates of the node and with v.
        ///
        /// 79 operations.
        #[inline(always)]
        fn momentum_derivatives(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix> {
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let [(sin3, cos3), (sin4, cos4)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s5 = cos3 * cos4 + sin3 * sin4;
            let s6 = self.m2 * self.l1 * self.l2;
            let s7 = s6 * θ1_dot;
            let s8 = s7 * θ2_dot * s5;
            let s9 = sin3 * cos4 - cos3 * sin4;
            let s10 = s8 + self.l1 * self.g * s2 * cos3;
            let s11 = h * h * real(0.25);
            let s12 = s7 * s9;
            let s13 = s6 * s5;
            let s14 = s6 * θ2_dot * s9;
            let s15 = s6 * real(0.5) * (θ1_dot + θ2_dot) * s9;
            let s16 = s8 * (h * real(0.25));
            let s17 = s8 + self.m2 * self.l2 * self.g * cos4;
            let s18 = s1 * s10;
            let s19 = s8 * h;
            let s20 = s8 * s1;
            let s21 = s1 * s17;
            ::vi_core::stepping::MomentumDerivatives {
                residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[s18 - s14, s14 - s20, -s12 - s20, s12 + s21],
                ),
                residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[
                        s2 * (self.l1 * self.l1) + s11 * s10,
                        s13 + (s15 - s16) * h,
                        s13 - (s15 + s16) * h,
                        self.m2 * (self.l2 * self.l2) + s11 * s17,
                    ],
                ),
                increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[-(h * s10), s19, s19, -(h * s17)],
                ),
                increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[
                        (-s14 - s18) * h,
                        (s20 - s12) * h,
                        (s14 + s20) * h,
                        (s12 - s21) * h,
                    ],
                ),
            }
        }

        /// `E1 = L_v_θ1*v_θ1 - L + L_v_θ2*v_θ2`
        ///
        /// 51 operations.
        #[inline(always)]
        fn discrete_energy(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let s3 = self.m2 * (self.l2 * self.l2);
            let s4 = self.l1 * self.l1 * s2;
            let [(sin5, cos5), (sin6, cos6)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s7 = cos5 * cos6 + sin5 * sin6;
            let s8 = self.m2 * self.l1 * self.l2;
            let s9 = s8 * θ1_dot;
            let s10 = θ1_dot * (s4 * θ1_dot + s8 * θ2_dot * s7)
                + θ2_dot * (s3 * θ2_dot + s9 * s7)
                - s4 * (θ1_dot * θ1_dot) * real(0.5);
            let s11 = s10 - s3 * (θ2_dot * θ2_dot) * real(0.5) - s9 * θ2_dot * s7
                - self.l1 * self.g * s2 * cos5;
            s11 - self.m2 * self.l2 * self.g * cos6
        }

        /// What the rounding of the residual is measured in, by running error analysis.
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
    for DoublePendulum<T> {
        /// `D = (-m2*l1*l2*dot(θ1)*dot(θ2)*sin(θ1 - θ2) - l1*g*(m1 + m2)*sin(θ1))*dot(dot(θ1)) - dot(θ1)*(dot(θ1)*(-m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) - l1*g*(m1 + m2)*cos(θ1)) - m2*l1*l2*dot(θ2)*sin(θ1 - θ2)*dot(dot(θ1)) + m2*l1*l2*dot(θ1)*dot(θ2)^2*cos(θ1 - θ2) - m2*l1*l2*dot(θ1)*sin(θ1 - θ2)*dot(dot(θ2))) + dot(dot(θ2))*(m2*l1*l2*dot(θ1)*dot(θ2)*sin(θ1 - θ2) - m2*l2*g*sin(θ2)) - …`
        ///
        /// 56 operations.
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let time = t;
            let [θ1_ddot, θ2_ddot]: [T; 2] = ::vi_core::Lagrangian::acceleration(
                    self,
                    t,
                    q,
                    v,
                )?
                .into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let [θ1, θ2]: [T; 2] = (*q).into();
            let [(sin1, cos1), (sin2, cos2)] = T::sin_cos_each([θ1, θ2]);
            let s3 = cos1 * cos2 + sin1 * sin2;
            let s4 = self.m2 * self.l1 * self.l2;
            let s5 = s4 * θ1_dot;
            let s6 = s5 * θ2_dot;
            let s7 = s6 * s3;
            let s8 = self.l1 * self.g * (self.m1 + self.m2);
            let s9 = self.m2 * self.l2 * self.g;
            let s10 = sin1 * cos2 - cos1 * sin2;
            let s11 = s6 * s10;
            let s12 = s4 * θ2_dot * s10 * θ1_ddot;
            let s13 = s5 * s10 * θ2_ddot;
            let s14 = θ2_dot
                * (s12 + s13 + s4 * (θ1_dot * θ1_dot) * θ2_dot * s3
                    - θ2_dot * (s7 + s9 * cos2));
            let s15 = θ2_ddot * (s11 - s9 * sin2) - (s11 + s8 * sin1) * θ1_ddot
                - θ1_dot
                    * (s5 * (θ2_dot * θ2_dot) * s3 - θ1_dot * (s7 + s8 * cos1) - s12
                        - s13);
            ::vi_core::support::step_density(time, s15 - s14)
        }

        /// `energy_residual = h*v_θ1*L_θ1/2 - L - E0_low - E0 + v_θ1*p0_θ1_low + v_θ1*p0_θ1 + h*v_θ2*L_θ2/2 + v_θ2*p0_θ2_low + v_θ2*p0_θ2`
        ///
        /// 136 operations.
        #[inline(always)]
        fn extended_system(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedSystem<2, T, Self::Jacobian> {
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [p0_θ1, p0_θ2]: [T; 2] = node.p.into();
            let [p0_θ1_low, p0_θ2_low]: [T; 2] = node.p_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let s3 = self.m2 * (self.l2 * self.l2);
            let s4 = self.l1 * self.l1;
            let s5 = s3 * θ2_dot;
            let s6 = θ1_dot * θ1_dot;
            let s7 = θ2_dot * θ2_dot;
            let [(sin8, cos8), (sin9, cos9)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s10 = cos8 * cos9 + sin8 * sin9;
            let s11 = self.m2 * self.l1 * self.l2;
            let s12 = s11 * θ1_dot;
            let s13 = s12 * θ2_dot;
            let s14 = s13 * s10;
            let s15 = self.l1 * self.g * s2;
            let s16 = s15 * cos8;
            let s17 = self.m2 * self.l2 * self.g;
            let s18 = s17 * cos9;
            let s19 = s4 * s2 * θ1_dot;
            let s20 = s11 * θ2_dot * s10;
            let s21 = sin8 * cos9 - cos8 * sin9;
            let s22 = s13 * s21;
            let s23 = s15 * sin8;
            let s24 = s22 + s23;
            let s25 = s17 * sin9;
            let s26 = s22 - s25;
            let s27 = (p0_θ2 - s5 * real(0.5)) * θ2_dot - (energy0 + s16 + s18)
                + (p0_θ1 - s19 * real(0.5) - s20) * θ1_dot;
            let s28 = s14 + s16;
            let s29 = h * h * real(0.25);
            let s30 = s11 * s10;
            let s31 = s11 * real(0.5) * (θ1_dot + θ2_dot) * s21;
            let s32 = s14 * (h * real(0.25));
            let s33 = s14 + s18;
            let s34 = s23 * real(0.5) + s11 * s7 * s21 * real(0.5);
            let s35 = s11 * real(0.25);
            let s36 = (s35 * θ1_dot * s7 * s10 - θ1_dot * s28 * real(0.25)) * h;
            let s37 = s11 * s6;
            let s38 = s25 * real(0.5) - s37 * s21 * real(0.5);
            let s39 = (s35 * s6 * θ2_dot * s10 - θ2_dot * s33 * real(0.25)) * h;
            ::vi_core::stepping::ExtendedSystem {
                momentum: ::vi_core::stepping::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        s19 + s20 - p0_θ1 - (p0_θ1_low - s1 * s24),
                        s5 + s12 * s10 - p0_θ2 - (p0_θ2_low + s1 * s26),
                    ]),
                    jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[
                            s2 * s4 + s29 * s28,
                            s30 + (s31 - s32) * h,
                            s30 - (s31 + s32) * h,
                            s3 + s29 * s33,
                        ],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s34 - s36, s38 - s39]),
                energy_residual: s27
                    + (θ1_dot * p0_θ1_low + θ2_dot * p0_θ2_low - energy0_low
                        + s1 * (θ2_dot * s26 - θ1_dot * s24)),
                energy_dv: ::vi_core::SVector::from([s34 + s36, s38 + s39]),
                energy_dh: s37 * s7 * s10 * real(0.5) - s6 * s28 * real(0.25)
                    - s7 * s33 * real(0.25),
            }
        }

        /// Both residuals, their rounding scales, and
        ///
        /// `E1 − E0 = 0`
        ///
        /// 140 operations.
        #[inline(always)]
        fn extended_residual(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedResidual<2, T> {
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [p0_θ1, p0_θ2]: [T; 2] = node.p.into();
            let [p0_θ1_low, p0_θ2_low]: [T; 2] = node.p_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let s3 = self.m2 * (self.l2 * self.l2);
            let s4 = s3 * θ2_dot;
            let s5 = self.l1 * self.l1;
            let [(sin6, cos6), (sin7, cos7)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s8 = cos6 * cos7 + sin6 * sin7;
            let s9 = self.m2 * self.l1 * self.l2;
            let s10 = s9 * θ1_dot;
            let s11 = s10 * θ2_dot;
            let s12 = self.l1 * self.g;
            let s13 = s12 * s2;
            let s14 = self.m2 * self.l2 * self.g;
            let s15 = s14 * cos7;
            let s16 = s5 * s2 * θ1_dot;
            let s17 = s9 * θ2_dot * s8;
            let s18 = s10 * s8;
            let s19 = s11 * (sin6 * cos7 - cos6 * sin7);
            let s20 = s19 + s13 * sin6;
            let s21 = s14 * sin7;
            let s22 = s19 - s21;
            let s23 = (p0_θ2 - s4 * real(0.5)) * θ2_dot - (energy0 + s13 * cos6 + s15)
                + (p0_θ1 - s16 * real(0.5) - s17) * θ1_dot;
            let s24 = self.m1.abs() + self.m2.abs();
            let s25 = s19.abs();
            let s26 = s25 + s24 * (s12 * sin6).abs();
            let s27 = h.abs() * real(0.5);
            let s28 = s25 + s21.abs();
            let s29 = energy0.abs() + (θ1_dot * p0_θ1).abs() + (θ2_dot * p0_θ2).abs()
                + s5 * s24 * (θ1_dot * θ1_dot) * real(0.5);
            let s30 = s29 + (s3 * (θ2_dot * θ2_dot)).abs() * real(0.5)
                + (s11 * s8).abs() + s24 * (s12 * cos6).abs();
            ::vi_core::stepping::ExtendedResidual {
                residual: ::vi_core::SVector::from([
                    s16 + s17 - p0_θ1 - (p0_θ1_low - s1 * s20),
                    s4 + s18 - p0_θ2 - (p0_θ2_low + s1 * s22),
                ]),
                scale: ::vi_core::SVector::from([
                    p0_θ1.abs() + s24 * (s5 * θ1_dot).abs() + s17.abs() + s27 * s26,
                    p0_θ2.abs() + s4.abs() + s18.abs() + s27 * s28,
                ]),
                energy_residual: s23
                    + (θ1_dot * p0_θ1_low + θ2_dot * p0_θ2_low - energy0_low
                        + s1 * (θ2_dot * s22 - θ1_dot * s20)),
                energy_scale: s30 + s15.abs() + s26 * (h * θ1_dot).abs() * real(0.5)
                    + s28 * (h * θ2_dot).abs() * real(0.5),
                increment: ::vi_core::stepping::Increment {
                    momentum: ::vi_core::SVector::from([-(h * s20), h * s22]),
                    energy: real(0.0),
                },
            }
        }

        /// How both residuals, `p1 − p0` and `E1 − E0` change with the coordinates of the node, v and h.
        ///
        /// 141 operations.
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
            let [θ1_0, θ2_0]: [T; 2] = node.q.into();
            let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
            let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
            let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
            let s2 = self.m1 + self.m2;
            let [(sin3, cos3), (sin4, cos4)] = T::sin_cos_each([θ1_mid, θ2_mid]);
            let s5 = cos3 * cos4 + sin3 * sin4;
            let s6 = self.m2 * self.l1 * self.l2;
            let s7 = s6 * θ1_dot;
            let s8 = s7 * θ2_dot;
            let s9 = s8 * s5;
            let s10 = self.l1 * self.g * s2;
            let s11 = self.m2 * self.l2 * self.g;
            let s12 = sin3 * cos4 - cos3 * sin4;
            let s13 = s8 * s12;
            let s14 = s10 * sin3;
            let s15 = s11 * sin4;
            let s16 = s9 + s10 * cos3;
            let s17 = h * h * real(0.25);
            let s18 = s7 * s12;
            let s19 = s6 * s5;
            let s20 = s6 * θ2_dot * s12;
            let s21 = s6 * real(0.5);
            let s22 = s21 * (θ1_dot + θ2_dot) * s12;
            let s23 = s9 * (h * real(0.25));
            let s24 = s9 + s11 * cos4;
            let s25 = θ2_dot * θ2_dot;
            let s26 = s14 * real(0.5) + s6 * s25 * s12 * real(0.5);
            let s27 = θ1_dot * s16;
            let s28 = s6 * real(0.25);
            let s29 = (s28 * θ1_dot * s25 * s5 - s27 * real(0.25)) * h;
            let s30 = θ1_dot * θ1_dot;
            let s31 = s6 * s30;
            let s32 = s15 * real(0.5) - s31 * s12 * real(0.5);
            let s33 = θ2_dot * s24;
            let s34 = (s28 * s30 * θ2_dot * s5 - s33 * real(0.25)) * h;
            let s35 = s1 * s16;
            let s36 = s9 * h;
            let s37 = s9 * s1;
            let s38 = s1 * s24;
            let s39 = s13 + s14;
            let s40 = (s21 * θ1_dot * s25 * s5 - s27 * real(0.5)) * h;
            let s41 = (s21 * s30 * θ2_dot * s5 - s33 * real(0.5)) * h;
            ::vi_core::stepping::ExtendedDerivatives {
                momentum: ::vi_core::stepping::MomentumDerivatives {
                    residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[s35 - s20, s20 - s37, -s18 - s37, s18 + s38],
                    ),
                    residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[
                            s2 * (self.l1 * self.l1) + s17 * s16,
                            s19 + (s22 - s23) * h,
                            s19 - (s22 + s23) * h,
                            self.m2 * (self.l2 * self.l2) + s17 * s24,
                        ],
                    ),
                    increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[-(h * s16), s36, s36, -(h * s24)],
                    ),
                    increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[
                            (-s20 - s35) * h,
                            (s37 - s18) * h,
                            (s20 + s37) * h,
                            (s18 - s38) * h,
                        ],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s26 - s29, s32 - s34]),
                increment_dh: ::vi_core::SVector::from([s40 - s39, s13 - s15 + s41]),
                energy_dq: ::vi_core::SVector::from([s39 + s40, s15 - s13 + s41]),
                energy_dv: ::vi_core::SVector::from([s26 + s29, s32 + s34]),
                energy_dh: s31 * s25 * s5 * real(0.5) - s30 * s16 * real(0.25)
                    - s25 * s24 * real(0.25),
                energy_increment_dq: ::vi_core::SVector::from([real(0.0), real(0.0)]),
                energy_increment_dv: ::vi_core::SVector::from([real(0.0), real(0.0)]),
                energy_increment_dh: real(0.0),
            }
        }

        /// What the rounding of both residuals is measured in, by running error analysis.
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

    impl ::vi_core::stepping::Discretized<2> for DoublePendulum<f64> {
        type Steps<T: ::vi_core::real::Real> = DoublePendulum<T>;
        #[inline(always)]
        fn steps<T: ::vi_core::real::Real>(&self) -> DoublePendulum<T> {
            self.convert()
        }
    }

    impl ::vi_core::stepping::Batch<2> for DoublePendulum<f64> {
        type Rows<const W: usize> = DoublePendulum<[f64; W]>;
        fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
            DoublePendulum {
                m1: ::core::array::from_fn(|index| systems[index].m1),
                m2: ::core::array::from_fn(|index| systems[index].m2),
                l1: ::core::array::from_fn(|index| systems[index].l1),
                l2: ::core::array::from_fn(|index| systems[index].l2),
                g: ::core::array::from_fn(|index| systems[index].g),
            }
        }

        #[inline(always)]
        fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self {
            DoublePendulum {
                m1: rows.m1[index],
                m2: rows.m2[index],
                l1: rows.l1[index],
                l2: rows.l2[index],
                g: rows.g[index],
            }
        }
    }

    /// Every name that is bound above is one of a function first: a binding may shadow that, and no constant from around.
    use ::core::primitive::{bool, f64, str, usize};
    use ::core::convert::{identity as name, identity as index, identity as t};
    use ::core::convert::{identity as q, identity as v, identity as θ1_dot};
    use ::core::convert::{identity as θ2_dot, identity as θ1, identity as θ2};
    use ::core::convert::{identity as real, identity as s1, identity as sin2};
    use ::core::convert::{identity as cos2, identity as sin3, identity as cos3};
    use ::core::convert::{identity as s4, identity as s5, identity as s2};
    use ::core::convert::{identity as time, identity as s6, identity as mass};
    use ::core::convert::{identity as applied, identity as p, identity as at_rest};
    use ::core::convert::{identity as velocity, identity as force, identity as power};
    use ::core::convert::{identity as values, identity as value, identity as text};
    use ::core::convert::{identity as s7, identity as s8, identity as s9};
    use ::core::convert::{identity as s10, identity as s11, identity as s12};
    use ::core::convert::{identity as s13, identity as interval, identity as h};
    use ::core::convert::{identity as θ1_0, identity as θ2_0, identity as θ1_1};
    use ::core::convert::{identity as θ2_1, identity as θ1_mid, identity as θ2_mid};
    use ::core::convert::{identity as s3, identity as sin4, identity as cos4};
    use ::core::convert::{identity as sin5, identity as cos5, identity as node};
    use ::core::convert::{
        identity as θ1_0_low, identity as θ2_0_low, identity as p0_θ1,
    };

    use ::core::convert::{
        identity as p0_θ2, identity as p0_θ1_low, identity as p0_θ2_low,
    };

    use ::core::convert::{identity as sin6, identity as cos6, identity as s14};
    use ::core::convert::{identity as s15, identity as s16, identity as s17};
    use ::core::convert::{identity as s18, identity as s19, identity as s20};
    use ::core::convert::{identity as s21, identity as θ1_ddot, identity as θ2_ddot};
    use ::core::convert::{identity as sin1, identity as cos1, identity as energy0};
    use ::core::convert::{identity as energy0_low, identity as sin8, identity as cos8};
    use ::core::convert::{identity as sin9, identity as cos9, identity as s22};
    use ::core::convert::{identity as s23, identity as s24, identity as s25};
    use ::core::convert::{identity as s26, identity as s27, identity as s28};
    use ::core::convert::{identity as s29, identity as s30, identity as s31};
    use ::core::convert::{identity as s32, identity as s33, identity as s34};
    use ::core::convert::{identity as s35, identity as s36, identity as s37};
    use ::core::convert::{identity as s38, identity as s39, identity as sin7};
    use ::core::convert::{identity as cos7, identity as s40, identity as s41};
    use ::core::convert::{identity as systems, identity as rows};
};

/// Checks of [`DoublePendulum`](super::DoublePendulum) at the place that it names.
#[cfg(test)]
#[allow(clippy::all, clippy::pedantic, deprecated)]
mod double_pendulum_checks {
    fn place() -> ::vi_core::check::Place<2> {
        ::vi_core::check::Place {
            t: 0.0,
            q: [0.5, -0.3].into(),
            v: [0.2, 0.1].into(),
            h: 0.01,
        }
    }

    #[::core::prelude::v1::test]
    fn derivatives() {
        let checked = ::vi_core::check::derivatives(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn slots() {
        let checked = ::vi_core::check::slots(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn steps() {
        let checked = ::vi_core::check::steps(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn energy_equations() {
        let checked = ::vi_core::check::energy_equations(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn order() {
        let checked = ::vi_core::check::order(
            &super::DoublePendulum::default(),
            &place(),
            2,
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn symplecticity() {
        let checked = ::vi_core::check::symplecticity(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn reversibility() {
        let checked = ::vi_core::check::reversibility(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn energy() {
        let checked = ::vi_core::check::energy(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }

    #[::core::prelude::v1::test]
    fn step_law() {
        let checked = ::vi_core::check::step_law(
            &super::DoublePendulum::default(),
            &place(),
        );
        if let ::core::result::Result::Err(failure) = checked {
            ::core::panic!("{failure}");
        }
    }
}
