/// Two coupled pendula, driven and damped: matrices, forces and sums over all coordinates.
///
/// Discretized by the rule `midpoint`. What the generator found:
///
/// * Not autonomous: `L` or `f` depends on the time `t`; a force acts
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
pub struct Pendula<T = ::core::primitive::f64> {
    /// Parameter `m`, 1.2 by default.
    pub m: T,
    /// Parameter `k`, 0.7 by default.
    pub k: T,
    /// Parameter `b`, 0.1 by default.
    pub b: T,
}

/// Every name that is bound below is one of a function first: a binding may shadow that, and no constant from around.
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
    use ::core::convert::{identity as name, identity as index, identity as t};
    use ::core::convert::{identity as q, identity as v, identity as q_0_dot};
    use ::core::convert::{identity as q_1_dot, identity as q_0, identity as q_1};
    use ::core::convert::{identity as real, identity as s1, identity as sin2};
    use ::core::convert::{identity as cos2, identity as sin3, identity as cos3};
    use ::core::convert::{identity as sin4, identity as s5, identity as time};
    use ::core::convert::{identity as sin1, identity as cos1, identity as s4};
    use ::core::convert::{identity as s6, identity as s7, identity as s8};
    use ::core::convert::{identity as mass, identity as applied, identity as q_0_ddot};
    use ::core::convert::{identity as q_1_ddot, identity as system, identity as inputs};
    use ::core::convert::{identity as values, identity as s9, identity as s10};
    use ::core::convert::{identity as s11, identity as s12, identity as s13};
    use ::core::convert::{identity as s14, identity as s15, identity as s16};
    use ::core::convert::{identity as p, identity as at_rest, identity as velocity};
    use ::core::convert::{identity as force, identity as power, identity as value};
    use ::core::convert::{identity as text, identity as interval, identity as t0};
    use ::core::convert::{identity as t1, identity as h, identity as q_0_0};
    use ::core::convert::{identity as q_1_0, identity as q_0_1, identity as q_1_1};
    use ::core::convert::{identity as t_mid, identity as q_0_mid, identity as q_1_mid};
    use ::core::convert::{identity as cos4, identity as node, identity as t0_low};
    use ::core::convert::{
        identity as q_0_0_low, identity as q_1_0_low, identity as p0_q_0,
    };

    use ::core::convert::{
        identity as p0_q_1, identity as p0_q_0_low, identity as p0_q_1_low,
    };

    use ::core::convert::{identity as s17, identity as s18, identity as s19};
    use ::core::convert::{identity as s20, identity as s21, identity as s22};
    use ::core::convert::{identity as s23, identity as s2, identity as sin5};
    use ::core::convert::{identity as s24, identity as s25, identity as s26};
    use ::core::convert::{identity as s27, identity as s3, identity as cos5};
    use ::core::convert::{identity as sin6, identity as cos6, identity as sin7};
    use ::core::convert::{identity as s28, identity as s29, identity as s30};
    use ::core::convert::{identity as s31, identity as s32, identity as s33};
    use ::core::convert::{identity as s34, identity as s35, identity as s36};
    use ::core::convert::{identity as energy0, identity as energy0_low, identity as s37};
    use ::core::convert::{identity as s38, identity as s39, identity as s40};
    use ::core::convert::{identity as s41, identity as s42, identity as s43};
    use ::core::convert::{identity as s44, identity as s45, identity as s46};
    use ::core::convert::{identity as s47, identity as s48, identity as s49};
    use ::core::convert::{identity as s50, identity as s51, identity as s52};
    use ::core::convert::{identity as s53, identity as s54, identity as s55};
    use ::core::convert::{identity as cos7, identity as sin8, identity as cos8};
    use ::core::convert::{identity as s56, identity as s57, identity as s58};
    use ::core::convert::{identity as s59, identity as s60, identity as s61};
    use ::core::convert::{identity as s62, identity as s63, identity as s64};
    use ::core::convert::{identity as s65, identity as s66, identity as s67};
    use ::core::convert::{identity as s68, identity as s69, identity as s70};
    use ::core::convert::{identity as s71, identity as s72, identity as s73};
    use ::core::convert::{identity as s74, identity as s75, identity as s76};
    use ::core::convert::{identity as s77, identity as s78, identity as s79};
    use ::core::convert::{identity as s80, identity as systems, identity as rows};
    use ::core::primitive::{bool, f64, str, usize};

    impl ::core::default::Default for Pendula<f64> {
        fn default() -> Self {
            Self { m: 1.2, k: 0.7, b: 0.1 }
        }
    }

    impl<T: ::vi_core::real::Real> Pendula<T> {
        /// The same system in another kind of number, every parameter rounded to it.
        pub fn convert<U: ::vi_core::real::Real>(&self) -> Pendula<U> {
            Pendula {
                m: U::real(self.m.to_f64()),
                k: U::real(self.k.to_f64()),
                b: U::real(self.b.to_f64()),
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T> for Pendula<T> {
        fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
            match name {
                "m" => ::core::option::Option::Some(&mut self.m),
                "k" => ::core::option::Option::Some(&mut self.k),
                "b" => ::core::option::Option::Some(&mut self.b),
                _ => ::core::option::Option::None,
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::Lagrangian<2, T> for Pendula<T> {
        const NAME: &'static str = "Pendula";
        const COORDINATES: [&'static str; 2] = ["q[0]", "q[1]"];
        const AUTONOMOUS: bool = false;
        const FORCED: bool = true;
        const CYCLIC: [bool; 2] = [false, false];
        const PARAMETERS: &'static [&'static str] = &["m", "k", "b"];
        fn parameter(&self, index: usize) -> T {
            [self.m, self.k, self.b][index]
        }

        /// `L = dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4 - k*(q[0] - q[1])^2/2 + m*(dot(q[0])^2 + dot(q[1])^2) + (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1]))`
        ///
        /// 26 operations.
        #[inline]
        fn lagrangian(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = q_0 - q_1;
            let [(sin2, cos2), (sin3, cos3), (sin4, _)] = T::sin_cos_each([q_0, q_1, t]);
            let s5 = q_0_dot * q_1_dot * (cos2 * cos3 + sin2 * sin3) * real(0.25)
                + self.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot);
            s5 + (sin4 * real(0.3333333333333333) + real(1.0)) * (cos2 + cos3)
                - self.k * (s1 * s1) * real(0.5)
        }

        /// `v·L_v − L = dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4 + k*(q[0] - q[1])^2/2 - (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1])) + m*dot(q[0])^2 + m*dot(q[1])^2`
        ///
        /// 26 operations.
        #[inline]
        fn energy(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = q_0 - q_1;
            let [(sin2, cos2), (sin3, cos3), (sin4, _)] = T::sin_cos_each([q_0, q_1, t]);
            let s5 = self.k * (s1 * s1) * real(0.5) + self.m * (q_1_dot * q_1_dot)
                - (sin4 * real(0.3333333333333333) + real(1.0)) * (cos2 + cos3);
            s5
                + (q_1_dot * (cos2 * cos3 + sin2 * sin3) * real(0.25) + self.m * q_0_dot)
                    * q_0_dot
        }

        /// `p_q[0] = dot(q[1])*cos(q[0] - q[1])/4 + 2*m*dot(q[0])`
        ///
        /// `p_q[1] = dot(q[0])*cos(q[0] - q[1])/4 + 2*m*dot(q[1])`
        ///
        /// 12 operations.
        #[inline]
        fn momentum(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::SVector<T, 2> {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = (q_0 - q_1).cos();
            ::vi_core::SVector::from([
                q_1_dot * s1 * real(0.25) + self.m * q_0_dot * real(2.0),
                q_0_dot * s1 * real(0.25) + self.m * q_1_dot * real(2.0),
            ])
        }

        /// `f_q[0] = -b*dot(q[0])`
        ///
        /// `f_q[1] = -b*dot(q[1])`
        ///
        /// 4 operations.
        #[inline]
        fn force(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::SVector<T, 2> {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            ::vi_core::SVector::from([-(self.b * q_0_dot), -(self.b * q_1_dot)])
        }

        /// Solves `M a = L_q + f − L_vt − L_vq v`.
        ///
        /// 34 operations.
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<::vi_core::SVector<T, 2>, ::vi_core::StepError> {
            let time = t;
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let [(sin1, cos1), (sin2, cos2), (sin3, _)] = T::sin_cos_each([q_0, q_1, t]);
            let s4 = sin3 * real(0.3333333333333333) + real(1.0);
            let s5 = self.m * real(2.0);
            let s6 = (cos1 * cos2 + sin1 * sin2) * real(0.25);
            let s7 = sin1 * cos2 - cos1 * sin2;
            let s8 = self.k * (q_0 - q_1);
            let mass: ::vi_core::nalgebra::SMatrix<T, 2, 2> = ::vi_core::nalgebra::SMatrix::from_row_slice(
                &[s5, s6, s6, s5],
            );
            let applied: ::vi_core::SVector<T, 2> = ::vi_core::SVector::from([
                -(self.b * q_0_dot + s8 + s4 * sin1
                    + q_1_dot * q_1_dot * s7 * real(0.25)),
                s8 + q_0_dot * q_0_dot * s7 * real(0.25) - self.b * q_1_dot - s4 * sin2,
            ]);
            ::vi_core::support::acceleration(time, &mass, &applied)
        }

        /// `D = (-b*dot(q[0]) - dot(q[0])*dot(q[1])*sin(q[0] - q[1])/4 - k*(q[0] - q[1]) - (sin(t)/3 + 1)*sin(q[0]))*dot(dot(q[0])) - dot(q[0])*(dot(q[0])*(-k - dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4 - (sin(t)/3 + 1)*cos(q[0])) - cos(t)*sin(q[0])/3 - dot(q[1])*sin(q[0] - q[1])*dot(dot(q[0]))/4 + dot(q[1])*(k + dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4) - dot(q[0])*sin(q[0] - q[1])*dot(dot(q[1]))/4) + …`
        ///
        /// 78 operations.
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let time = t;
            let [q_0_ddot, q_1_ddot]: [T; 2] = self.acceleration(t, q, v)?.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            /// Part 1 of `step_density`: 39 operations.
            #[inline(never)]
            fn step_density_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 7],
                values: &mut [T; 11],
            ) {
                let real = T::real;
                let q_0_dot = inputs[3];
                let q_1_dot = inputs[4];
                let q_0 = inputs[1];
                let q_1 = inputs[2];
                let t = inputs[0];
                let q_0_ddot = inputs[5];
                let q_1_ddot = inputs[6];
                let [(sin1, cos1), (sin2, cos2), (sin3, cos3)] = T::sin_cos_each([
                    q_0,
                    q_1,
                    t,
                ]);
                let s4 = sin1 * cos2 - cos1 * sin2;
                let s5 = q_1_dot * s4;
                let s6 = system.k * (q_0 - q_1);
                let s7 = sin3 * real(0.3333333333333333) + real(1.0);
                let s8 = (-((system.b + s5 * real(0.25)) * q_0_dot) - (s6 + s7 * sin1))
                    * q_0_ddot + q_0_dot * cos3 * sin1 * real(0.3333333333333333);
                let s9 = q_0_dot * s4;
                let s10 = s8
                    + q_1_ddot
                        * (s6 - s7 * sin2 + (s9 * real(0.25) - system.b) * q_1_dot)
                    + q_1_dot * cos3 * sin2 * real(0.3333333333333333);
                values[1] = cos1;
                values[2] = cos2;
                values[3] = sin1;
                values[4] = sin2;
                values[5] = sin3;
                values[6] = s7;
                values[7] = cos3;
                values[8] = s5;
                values[9] = s9;
                values[10] = s10;
            }
            /// Part 2 of `step_density`: 39 operations.
            #[inline(never)]
            fn step_density_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 7],
                values: &mut [T; 11],
            ) {
                let real = T::real;
                let q_0_dot = inputs[3];
                let q_1_dot = inputs[4];
                let cos1 = values[1];
                let cos2 = values[2];
                let sin1 = values[3];
                let sin2 = values[4];
                let sin3 = values[5];
                let s7 = values[6];
                let cos3 = values[7];
                let s5 = values[8];
                let q_0_ddot = inputs[5];
                let q_1_ddot = inputs[6];
                let s9 = values[9];
                let s10 = values[10];
                let s11 = system.k
                    + q_0_dot * q_1_dot * (cos1 * cos2 + sin1 * sin2) * real(0.25);
                let s12 = s5 * q_0_ddot * real(0.25);
                let s13 = s9 * q_1_ddot * real(0.25);
                let s14 = q_0_dot
                    * (q_1_dot * s11 - q_0_dot * (s11 + s7 * cos1)
                        - cos3 * sin1 * real(0.3333333333333333) - s12 - s13);
                let s15 = q_1_dot
                    * (s12 + s13 + q_0_dot * s11 - q_1_dot * (s11 + s7 * cos2)
                        - cos3 * sin2 * real(0.3333333333333333));
                let s16 = s10 + sin3 * (cos1 + cos2) * real(0.3333333333333333) - s14
                    - s15;
                values[0] = s16;
            }
            let system = self;
            let inputs = [t, q_0, q_1, q_0_dot, q_1_dot, q_0_ddot, q_1_ddot];
            let mut values = [T::real(0.0); 11];
            step_density_part_1(system, &inputs, &mut values);
            step_density_part_2(system, &inputs, &mut values);
            ::vi_core::support::step_density(time, values[0])
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
        /// 30 operations.
        #[cold]
        fn non_finite(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::core::option::Option<&'static str> {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let s1 = q_0 - q_1;
            let [(sin2, cos2), (sin3, cos3), (sin4, _)] = T::sin_cos_each([q_0, q_1, t]);
            let s5 = cos2 * cos3 + sin2 * sin3;
            let s6 = q_0_dot * q_1_dot * s5 * real(0.25)
                + self.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
                + (sin4 * real(0.3333333333333333) + real(1.0)) * (cos2 + cos3);
            let values = [
                ("m", self.m),
                ("k", self.k),
                ("b", self.b),
                ("dot(q[0])", q_0_dot),
                ("dot(q[1])", q_1_dot),
                ("q[0]", q_0),
                ("q[1]", q_1),
                ("cos(q[0] - q[1])", s5),
                ("t", t),
                ("sin(t)", sin4),
                ("cos(q[0])", cos2),
                ("cos(q[1])", cos3),
                (
                    "dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4 - k*(q[0] - q[1])^2/2 + m*(dot(q[0])^2 + dot(q[1])^2) + (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1]))",
                    s6 - self.k * (s1 * s1) * real(0.5),
                ),
                ("-b*dot(q[0])", -(self.b * q_0_dot)),
                ("-b*dot(q[1])", -(self.b * q_1_dot)),
            ];
            values
                .into_iter()
                .find(|(_, value)| !value.is_finite())
                .map(|(text, _)| text)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::collocation::Collocation<2, T>
    for Pendula<T> {
        type Mass = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        type PointMatrix = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        const CONSTANT_MASS: bool = false;
        const SEPARABLE: bool = false;

        /// L_v, M, and
        ///
        /// `L_q + f_q[0] = -b*dot(q[0]) - dot(q[0])*dot(q[1])*sin(q[0] - q[1])/4 - k*(q[0] - q[1]) - (sin(t)/3 + 1)*sin(q[0])`
        ///
        /// `L_q + f_q[1] = dot(q[0])*dot(q[1])*sin(q[0] - q[1])/4 - b*dot(q[1]) + k*(q[0] - q[1]) - (sin(t)/3 + 1)*sin(q[1])`
        ///
        /// 42 operations.
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::collocation::Point<2, T, Self::Mass> {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let [(sin1, cos1), (sin2, cos2), (sin3, _)] = T::sin_cos_each([q_0, q_1, t]);
            let s4 = cos1 * cos2 + sin1 * sin2;
            let s5 = sin3 * real(0.3333333333333333) + real(1.0);
            let s6 = self.m * real(2.0);
            let s7 = s4 * real(0.25);
            let s8 = sin1 * cos2 - cos1 * sin2;
            let s9 = self.k * (q_0 - q_1);
            ::vi_core::collocation::Point {
                momentum: ::vi_core::SVector::from([
                    q_1_dot * s4 * real(0.25) + self.m * q_0_dot * real(2.0),
                    q_0_dot * s4 * real(0.25) + self.m * q_1_dot * real(2.0),
                ]),
                force: ::vi_core::SVector::from([
                    -((self.b + q_1_dot * s8 * real(0.25)) * q_0_dot) - (s9 + s5 * sin1),
                    s9 - s5 * sin2 + (q_0_dot * s8 * real(0.25) - self.b) * q_1_dot,
                ]),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(&[s6, s7, s7, s6]),
            }
        }

        /// M = ∂L_v/∂v, ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.
        ///
        /// 34 operations.
        #[inline(always)]
        fn point_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::collocation::PointDerivatives<Self::PointMatrix> {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let [(sin1, cos1), (sin2, cos2), (sin3, _)] = T::sin_cos_each([q_0, q_1, t]);
            let s4 = cos1 * cos2 + sin1 * sin2;
            let s5 = sin3 * real(0.3333333333333333) + real(1.0);
            let s6 = self.m * real(2.0);
            let s7 = s4 * real(0.25);
            let s8 = sin1 * cos2 - cos1 * sin2;
            let s9 = q_1_dot * s8 * real(0.25);
            let s10 = self.k + q_0_dot * q_1_dot * s4 * real(0.25);
            let s11 = q_0_dot * s8 * real(0.25);
            let s12 = -s11;
            ::vi_core::collocation::PointDerivatives {
                momentum_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[-s9, s9, s12, s11],
                ),
                mass: ::vi_core::nalgebra::SMatrix::from_row_slice(&[s6, s7, s7, s6]),
                force_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[-(s10 + s5 * cos1), s10, s10, -(s10 + s5 * cos2)],
                ),
                force_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[-(self.b + s9), s12, s9, s11 - self.b],
                ),
            }
        }

        /// `dE/dt = -(cos(q[0]) + cos(q[1]))*cos(t)/3 - b*dot(q[0])^2 - b*dot(q[1])^2`
        ///
        /// 13 operations.
        #[inline]
        fn power(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 2>,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let [q_0, q_1]: [T; 2] = (*q).into();
            let real = T::real;
            let [(_, cos1), (_, cos2), (_, cos3)] = T::sin_cos_each([q_0, q_1, t]);
            -((cos1 + cos2) * cos3 * real(0.3333333333333333)
                + self.b * (q_0_dot * q_0_dot) + self.b * (q_1_dot * q_1_dot))
        }
    }

    impl ::vi_core::stepping::Convertible<2> for Pendula<f64> {
        type In<T: ::vi_core::real::Real> = Pendula<T>;
        #[inline(always)]
        fn convert<T: ::vi_core::real::Real>(&self) -> Pendula<T> {
            self.convert()
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<2, T> for Pendula<T> {
        /// `ld = h*L`
        ///
        /// 33 operations.
        #[inline]
        fn ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let s1 = q_0_mid - q_1_mid;
            let [(sin2, cos2), (sin3, cos3), (sin4, _)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s5 = q_0_dot * q_1_dot * (cos2 * cos3 + sin2 * sin3) * real(0.25)
                + self.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot);
            h
                * (s5 + (sin4 * real(0.3333333333333333) + real(1.0)) * (cos2 + cos3)
                    - self.k * (s1 * s1) * real(0.5))
        }

        /// `d1_ld = h*L_t/2 - L + L_v_q[0]*v_q[0] + L_v_q[1]*v_q[1]`
        ///
        /// 51 operations.
        #[inline]
        fn d1_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            /// Part 1 of `d1_ld`: 47 operations.
            #[inline(never)]
            fn d1_ld_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 4],
            ) {
                let real = T::real;
                let t0 = inputs[0];
                let t1 = inputs[3];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_1 = inputs[4];
                let q_1_1 = inputs[5];
                let q_0_dot = inputs[7];
                let q_1_dot = inputs[8];
                let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
                let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
                let t_mid = (t0 + t1) * real(0.5);
                let s1 = q_0_mid - q_1_mid;
                let [(sin2, cos2), (sin3, cos3), (sin4, cos4)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s5 = cos2 * cos3 + sin2 * sin3;
                let s6 = system.k * (s1 * s1) * real(0.5)
                    + q_0_dot
                        * (system.m * q_0_dot * real(2.0) + q_1_dot * s5 * real(0.25))
                    + q_1_dot
                        * (system.m * q_1_dot * real(2.0) + q_0_dot * s5 * real(0.25));
                let s7 = cos2 + cos3;
                let s8 = s6 - q_0_dot * q_1_dot * s5 * real(0.25)
                    - system.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
                    - (sin4 * real(0.3333333333333333) + real(1.0)) * s7;
                values[1] = s7;
                values[2] = cos4;
                values[3] = s8;
            }
            /// Part 2 of `d1_ld`: 4 operations.
            #[inline(never)]
            fn d1_ld_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 4],
            ) {
                let real = T::real;
                let h = inputs[6];
                let s7 = values[1];
                let cos4 = values[2];
                let s8 = values[3];
                let s9 = s8 + h * real(0.16666666666666666) * s7 * cos4;
                values[0] = s9;
            }
            let system = self;
            let inputs = [t0, q_0_0, q_1_0, t1, q_0_1, q_1_1, h, q_0_dot, q_1_dot];
            let mut values = [T::real(0.0); 4];
            d1_ld_part_1(system, &inputs, &mut values);
            d1_ld_part_2(system, &inputs, &mut values);
            values[0]
        }

        /// `d2_ld_q[0] = h*L_q[0]/2 - L_v_q[0]`
        ///
        /// `d2_ld_q[1] = h*L_q[1]/2 - L_v_q[1]`
        ///
        /// 45 operations.
        #[inline]
        fn d2_ld(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let [(sin1, cos1), (sin2, cos2), (sin3, _)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s4 = cos1 * cos2 + sin1 * sin2;
            let s5 = sin3 * real(0.3333333333333333) + real(1.0);
            let s6 = q_0_dot * q_1_dot * (sin1 * cos2 - cos1 * sin2) * real(0.25)
                + self.k * (q_0_mid - q_1_mid);
            let s7 = h * real(0.5);
            ::vi_core::SVector::from([
                -(self.m * q_0_dot * real(2.0) + q_1_dot * s4 * real(0.25))
                    - s7 * (s6 + s5 * sin1),
                s7 * (s6 - s5 * sin2)
                    - (self.m * q_1_dot * real(2.0) + q_0_dot * s4 * real(0.25)),
            ])
        }

        /// `d3_ld = L + h*L_t/2 - L_v_q[0]*v_q[0] - L_v_q[1]*v_q[1]`
        ///
        /// 51 operations.
        #[inline]
        fn d3_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            /// Part 1 of `d3_ld`: 40 operations.
            #[inline(never)]
            fn d3_ld_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 5],
            ) {
                let real = T::real;
                let t0 = inputs[0];
                let t1 = inputs[3];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_1 = inputs[4];
                let q_1_1 = inputs[5];
                let q_0_dot = inputs[7];
                let q_1_dot = inputs[8];
                let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
                let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
                let t_mid = (t0 + t1) * real(0.5);
                let [(sin1, cos1), (sin2, cos2), (sin3, cos3)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s4 = cos1 * cos2 + sin1 * sin2;
                let s5 = cos1 + cos2;
                let s6 = q_0_dot * q_1_dot * s4 * real(0.25)
                    + system.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
                    + (sin3 * real(0.3333333333333333) + real(1.0)) * s5;
                let s7 = q_0_mid - q_1_mid;
                let s8 = s6 - system.k * (s7 * s7) * real(0.5)
                    - q_0_dot
                        * (system.m * q_0_dot * real(2.0) + q_1_dot * s4 * real(0.25));
                values[1] = s4;
                values[2] = s5;
                values[3] = cos3;
                values[4] = s8;
            }
            /// Part 2 of `d3_ld`: 11 operations.
            #[inline(never)]
            fn d3_ld_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 5],
            ) {
                let real = T::real;
                let h = inputs[6];
                let q_0_dot = inputs[7];
                let q_1_dot = inputs[8];
                let s4 = values[1];
                let s5 = values[2];
                let cos3 = values[3];
                let s8 = values[4];
                let s9 = s8
                    - q_1_dot
                        * (system.m * q_1_dot * real(2.0) + q_0_dot * s4 * real(0.25))
                    + h * real(0.16666666666666666) * s5 * cos3;
                values[0] = s9;
            }
            let system = self;
            let inputs = [t0, q_0_0, q_1_0, t1, q_0_1, q_1_1, h, q_0_dot, q_1_dot];
            let mut values = [T::real(0.0); 5];
            d3_ld_part_1(system, &inputs, &mut values);
            d3_ld_part_2(system, &inputs, &mut values);
            values[0]
        }

        /// `d4_ld_q[0] = L_v_q[0] + h*L_q[0]/2`
        ///
        /// `d4_ld_q[1] = L_v_q[1] + h*L_q[1]/2`
        ///
        /// 44 operations.
        #[inline]
        fn d4_ld(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let [(sin1, cos1), (sin2, cos2), (sin3, _)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s4 = cos1 * cos2 + sin1 * sin2;
            let s5 = sin3 * real(0.3333333333333333) + real(1.0);
            let s6 = q_0_dot * q_1_dot * (sin1 * cos2 - cos1 * sin2) * real(0.25)
                + self.k * (q_0_mid - q_1_mid);
            let s7 = h * real(0.5);
            ::vi_core::SVector::from([
                self.m * q_0_dot * real(2.0) + q_1_dot * s4 * real(0.25)
                    - s7 * (s6 + s5 * sin1),
                self.m * q_1_dot * real(2.0) + q_0_dot * s4 * real(0.25)
                    + s7 * (s6 - s5 * sin2),
            ])
        }

        /// `fd_minus_q[0] = h*f_q[0]/2`
        ///
        /// `fd_minus_q[1] = h*f_q[1]/2`
        ///
        /// 6 operations.
        #[inline]
        fn fd_minus(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            let s1 = self.b * h * real(0.5);
            ::vi_core::SVector::from([-(s1 * q_0_dot), -(s1 * q_1_dot)])
        }

        /// `fd_plus_q[0] = h*f_q[0]/2`
        ///
        /// `fd_plus_q[1] = h*f_q[1]/2`
        ///
        /// 6 operations.
        #[inline]
        fn fd_plus(
            &self,
            interval: &::vi_core::Interval<2, T>,
        ) -> ::vi_core::SVector<T, 2> {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            let s1 = self.b * h * real(0.5);
            ::vi_core::SVector::from([-(s1 * q_0_dot), -(s1 * q_1_dot)])
        }

        /// `gd_minus = -h*v_q[0]*f_q[0]/2 - h*v_q[1]*f_q[1]/2`
        ///
        /// 6 operations.
        #[inline]
        fn gd_minus(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            self.b * real(0.5) * h * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
        }

        /// `gd_plus = -h*v_q[0]*f_q[0]/2 - h*v_q[1]*f_q[1]/2`
        ///
        /// 6 operations.
        #[inline]
        fn gd_plus(&self, interval: &::vi_core::Interval<2, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
            let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let real = T::real;
            self.b * real(0.5) * h * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<2, T>
    for Pendula<T> {
        type Jacobian = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        type StepMatrix = ::vi_core::nalgebra::SMatrix<T, 2, 2>;
        const CONSTANT_JACOBIAN: bool = false;
        const INLINED: bool = true;

        /// `residual_q[0] = L_v_q[0] - h*L_q[0]/2 - h*f_q[0]/2 - p0_q[0]_low - p0_q[0]`
        ///
        /// `residual_q[1] = L_v_q[1] - h*L_q[1]/2 - h*f_q[1]/2 - p0_q[1]_low - p0_q[1]`
        ///
        /// 85 operations.
        #[inline(never)]
        fn momentum_equation(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumEquation<2, T, Self::Jacobian> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [p0_q_0, p0_q_1]: [T; 2] = node.p.into();
            let [p0_q_0_low, p0_q_1_low]: [T; 2] = node.p_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `momentum_equation`: 43 operations.
            #[inline(never)]
            fn momentum_equation_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 13],
                values: &mut [T; 16],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[8];
                let q_0_0_low = inputs[9];
                let q_1_0_low = inputs[10];
                let p0_q_0_low = inputs[11];
                let p0_q_0 = inputs[6];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let [(sin2, cos2), (sin3, cos3), (sin4, _)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s5 = cos2 * cos3 + sin2 * sin3;
                let s6 = system.b * h * real(0.5);
                let s7 = q_0_dot * q_1_dot;
                let s8 = sin2 * cos3 - cos2 * sin3;
                let s9 = s7 * s8 * real(0.25) + system.k * (q_0_mid - q_1_mid);
                let s10 = sin4 * real(0.3333333333333333) + real(1.0);
                let s11 = system.m * q_0_dot * real(2.0) + q_1_dot * s5 * real(0.25)
                    - p0_q_0 + (s6 * q_0_dot - p0_q_0_low + s1 * (s9 + s10 * sin2));
                values[6] = s1;
                values[7] = cos2;
                values[8] = cos3;
                values[9] = sin3;
                values[10] = s5;
                values[11] = s7;
                values[12] = s10;
                values[13] = s8;
                values[14] = s9;
                values[15] = s6;
                values[0] = s11;
            }
            /// Part 2 of `momentum_equation`: 42 operations.
            #[inline(never)]
            fn momentum_equation_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 13],
                values: &mut [T; 16],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[6];
                let p0_q_1_low = inputs[12];
                let p0_q_1 = inputs[7];
                let cos2 = values[7];
                let cos3 = values[8];
                let sin3 = values[9];
                let s5 = values[10];
                let s7 = values[11];
                let s10 = values[12];
                let s8 = values[13];
                let s9 = values[14];
                let s6 = values[15];
                let s12 = system.m * real(2.0);
                let s13 = system.b * real(0.5);
                let s14 = h * real(0.25);
                let s15 = system.k + s7 * s5 * real(0.25);
                let s16 = s12 + (s13 + s14 * (s15 + s10 * cos2)) * h;
                let s17 = s5 * real(0.25);
                let s18 = (q_0_dot + q_1_dot) * s8 * real(0.125);
                let s19 = s14 * s15;
                let s20 = s17 - (s18 + s19) * h;
                let s21 = system.m * q_1_dot * real(2.0) + q_0_dot * s5 * real(0.25)
                    - p0_q_1 + (s6 * q_1_dot - p0_q_1_low - s1 * (s9 - s10 * sin3));
                let s22 = s17 + (s18 - s19) * h;
                let s23 = s12 + (s13 + s14 * (s15 + s10 * cos3)) * h;
                values[1] = s21;
                values[2] = s16;
                values[3] = s22;
                values[4] = s20;
                values[5] = s23;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                p0_q_0,
                p0_q_1,
                t0_low,
                q_0_0_low,
                q_1_0_low,
                p0_q_0_low,
                p0_q_1_low,
            ];
            let mut values = [T::real(0.0); 16];
            momentum_equation_part_1(system, &inputs, &mut values);
            momentum_equation_part_2(system, &inputs, &mut values);
            ::vi_core::stepping::MomentumEquation {
                residual: ::vi_core::SVector::from([values[0], values[1]]),
                jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[values[2], values[3], values[4], values[5]],
                ),
            }
        }

        /// The residual, its rounding scale, and
        ///
        /// `p1_q[0] − p0_q[0] = h*L_q[0] + h*f_q[0]`
        ///
        /// `p1_q[1] − p0_q[1] = h*L_q[1] + h*f_q[1]`
        ///
        /// 106 operations.
        #[inline(never)]
        fn momentum_residual(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumResidual<2, T> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [p0_q_0, p0_q_1]: [T; 2] = node.p.into();
            let [p0_q_0_low, p0_q_1_low]: [T; 2] = node.p_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `momentum_residual`: 26 operations.
            #[inline(never)]
            fn momentum_residual_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 13],
                values: &mut [T; 23],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[8];
                let q_0_0_low = inputs[9];
                let q_1_0_low = inputs[10];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let s2 = system.m * q_0_dot;
                let [(sin3, cos3), (sin4, cos4), (sin5, _)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s6 = cos3 * cos4 + sin3 * sin4;
                let s7 = q_1_dot * s6;
                let s8 = system.b * h;
                let s9 = s8 * real(0.5);
                let s10 = q_0_dot * q_1_dot * (sin3 * cos4 - cos3 * sin4);
                values[6] = s1;
                values[7] = q_0_mid;
                values[8] = q_1_mid;
                values[9] = s8;
                values[10] = s2;
                values[11] = sin3;
                values[12] = sin4;
                values[13] = s6;
                values[14] = sin5;
                values[16] = s7;
                values[17] = s10;
                values[19] = s9;
            }
            /// Part 2 of `momentum_residual`: 49 operations.
            #[inline(never)]
            fn momentum_residual_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 13],
                values: &mut [T; 23],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let s1 = values[6];
                let q_0_mid = values[7];
                let q_1_mid = values[8];
                let p0_q_0_low = inputs[11];
                let p0_q_0 = inputs[6];
                let s8 = values[9];
                let s2 = values[10];
                let sin3 = values[11];
                let sin5 = values[14];
                let s7 = values[16];
                let s10 = values[17];
                let s9 = values[19];
                let s11 = s10 * real(0.25) + system.k * (q_0_mid - q_1_mid);
                let s12 = sin5 * real(0.3333333333333333) + real(1.0);
                let s13 = s11 + s12 * sin3;
                let s14 = s2 * real(2.0) + s7 * real(0.25) - p0_q_0
                    + (s9 * q_0_dot - p0_q_0_low + s1 * s13);
                let s15 = s8 * q_0_dot;
                let s16 = h.abs() * real(0.5);
                let s17 = s10.abs() * real(0.25)
                    + system.k.abs() * (q_0_mid.abs() + q_1_mid.abs());
                let s18 = sin5.abs() * real(0.3333333333333333) + real(1.0);
                let s19 = p0_q_0.abs() + s15.abs() * real(0.5) + s2.abs() * real(2.0)
                    + s7.abs() * real(0.25) + s16 * (s17 + s18 * sin3.abs());
                let s20 = -(h * s13) - s15;
                values[15] = s12;
                values[18] = s11;
                values[0] = s14;
                values[4] = s20;
                values[20] = s18;
                values[21] = s17;
                values[22] = s16;
                values[2] = s19;
            }
            /// Part 3 of `momentum_residual`: 31 operations.
            #[inline(never)]
            fn momentum_residual_part_3<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 13],
                values: &mut [T; 23],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[6];
                let p0_q_1_low = inputs[12];
                let p0_q_1 = inputs[7];
                let s8 = values[9];
                let sin4 = values[12];
                let s6 = values[13];
                let s12 = values[15];
                let s11 = values[18];
                let s9 = values[19];
                let s18 = values[20];
                let s17 = values[21];
                let s16 = values[22];
                let s21 = system.m * q_1_dot;
                let s22 = q_0_dot * s6;
                let s23 = s11 - s12 * sin4;
                let s24 = s21 * real(2.0) + s22 * real(0.25) - p0_q_1
                    + (s9 * q_1_dot - p0_q_1_low - s1 * s23);
                let s25 = s8 * q_1_dot;
                let s26 = p0_q_1.abs() + s25.abs() * real(0.5) + s21.abs() * real(2.0)
                    + s22.abs() * real(0.25) + s16 * (s17 + s18 * sin4.abs());
                let s27 = h * s23 - s25;
                values[1] = s24;
                values[5] = s27;
                values[3] = s26;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                p0_q_0,
                p0_q_1,
                t0_low,
                q_0_0_low,
                q_1_0_low,
                p0_q_0_low,
                p0_q_1_low,
            ];
            let mut values = [T::real(0.0); 23];
            momentum_residual_part_1(system, &inputs, &mut values);
            momentum_residual_part_2(system, &inputs, &mut values);
            momentum_residual_part_3(system, &inputs, &mut values);
            ::vi_core::stepping::MomentumResidual {
                residual: ::vi_core::SVector::from([values[0], values[1]]),
                scale: ::vi_core::SVector::from([values[2], values[3]]),
                increment: ::vi_core::SVector::from([values[4], values[5]]),
            }
        }

        /// How the residual and `p1 − p0` change with the coordinates of the node and with v.
        ///
        /// 80 operations.
        #[inline(never)]
        fn momentum_derivatives(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `momentum_derivatives`: 36 operations.
            #[inline(never)]
            fn momentum_derivatives_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 25],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[6];
                let q_0_0_low = inputs[7];
                let q_1_0_low = inputs[8];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let s2 = system.m * real(2.0);
                let s3 = system.b * real(0.5);
                let s4 = h * real(0.25);
                let [(sin5, cos5), (sin6, cos6), (sin7, _)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s8 = cos5 * cos6 + sin5 * sin6;
                let s9 = system.k + q_0_dot * q_1_dot * s8 * real(0.25);
                let s10 = sin7 * real(0.3333333333333333) + real(1.0);
                let s11 = s9 + s10 * cos5;
                let s12 = s2 + (s3 + s4 * s11) * h;
                let s13 = s8 * real(0.25);
                let s14 = sin5 * cos6 - cos5 * sin6;
                values[15] = s1;
                values[16] = cos6;
                values[17] = s10;
                values[18] = s14;
                values[19] = s9;
                values[20] = s11;
                values[21] = s2;
                values[22] = s3;
                values[23] = s4;
                values[0] = s12;
                values[24] = s13;
            }
            /// Part 2 of `momentum_derivatives`: 44 operations.
            #[inline(never)]
            fn momentum_derivatives_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 25],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[15];
                let cos6 = values[16];
                let s10 = values[17];
                let s14 = values[18];
                let s9 = values[19];
                let s11 = values[20];
                let s2 = values[21];
                let s3 = values[22];
                let s4 = values[23];
                let s13 = values[24];
                let s15 = (q_0_dot + q_1_dot) * s14 * real(0.125);
                let s16 = s4 * s9;
                let s17 = s13 - (s15 + s16) * h;
                let s18 = s1 * s11;
                let s19 = q_1_dot * s14 * real(0.25);
                let s20 = s18 - s19;
                let s21 = q_0_dot * s14 * real(0.25);
                let s22 = s1 * s9;
                let s23 = -s21 - s22;
                let s24 = -(h * s11);
                let s25 = h * s9;
                let s26 = (-(system.b + s19) - s18) * h;
                let s27 = (s19 + s22) * h;
                let s28 = s13 + (s15 - s16) * h;
                let s29 = s9 + s10 * cos6;
                let s30 = s2 + (s3 + s4 * s29) * h;
                let s31 = s19 - s22;
                let s32 = s1 * s29;
                let s33 = s21 + s32;
                let s34 = -(h * s29);
                let s35 = (s22 - s21) * h;
                let s36 = (s21 - system.b - s32) * h;
                values[1] = s28;
                values[2] = s17;
                values[3] = s30;
                values[8] = s24;
                values[4] = s20;
                values[9] = s25;
                values[5] = s31;
                values[6] = s23;
                values[10] = s34;
                values[7] = s33;
                values[11] = s26;
                values[12] = s35;
                values[13] = s27;
                values[14] = s36;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                t0_low,
                q_0_0_low,
                q_1_0_low,
            ];
            let mut values = [T::real(0.0); 25];
            momentum_derivatives_part_1(system, &inputs, &mut values);
            momentum_derivatives_part_2(system, &inputs, &mut values);
            ::vi_core::stepping::MomentumDerivatives {
                residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[values[4], values[5], values[6], values[7]],
                ),
                residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[values[0], values[1], values[2], values[3]],
                ),
                increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[values[8], values[9], values[9], values[10]],
                ),
                increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                    &[values[11], values[12], values[13], values[14]],
                ),
            }
        }

        /// `E1 = L_v_q[0]*v_q[0] - L - h*L_t/2 + L_v_q[1]*v_q[1] + h*v_q[0]*f_q[0]/2 + h*v_q[1]*f_q[1]/2`
        ///
        /// 59 operations.
        #[inline(never)]
        fn discrete_energy(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> T {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `discrete_energy`: 50 operations.
            #[inline(never)]
            fn discrete_energy_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 6],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[6];
                let q_0_0_low = inputs[7];
                let q_1_0_low = inputs[8];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let s2 = q_0_mid - q_1_mid;
                let [(sin3, cos3), (sin4, cos4), (sin5, cos5)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s6 = cos3 * cos4 + sin3 * sin4;
                let s7 = system.k * (s2 * s2) * real(0.5)
                    + q_0_dot
                        * (system.m * q_0_dot * real(2.0) + q_1_dot * s6 * real(0.25))
                    + q_1_dot
                        * (system.m * q_1_dot * real(2.0) + q_0_dot * s6 * real(0.25));
                let s8 = q_0_dot * q_0_dot;
                let s9 = q_1_dot * q_1_dot;
                let s10 = cos3 + cos4;
                let s11 = s7 - q_0_dot * q_1_dot * s6 * real(0.25) - system.m * (s8 + s9)
                    - (sin5 * real(0.3333333333333333) + real(1.0)) * s10;
                values[1] = s8;
                values[2] = s9;
                values[3] = s10;
                values[4] = cos5;
                values[5] = s11;
            }
            /// Part 2 of `discrete_energy`: 9 operations.
            #[inline(never)]
            fn discrete_energy_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 6],
            ) {
                let real = T::real;
                let h = inputs[3];
                let s8 = values[1];
                let s9 = values[2];
                let s10 = values[3];
                let cos5 = values[4];
                let s11 = values[5];
                let s12 = system.b * real(0.5);
                let s13 = s11
                    - (s10 * cos5 * real(0.16666666666666666) + s12 * s8 + s12 * s9) * h;
                values[0] = s13;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                t0_low,
                q_0_0_low,
                q_1_0_low,
            ];
            let mut values = [T::real(0.0); 6];
            discrete_energy_part_1(system, &inputs, &mut values);
            discrete_energy_part_2(system, &inputs, &mut values);
            values[0]
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
    for Pendula<T> {
        /// `energy_residual = h*L_t/2 - L - E0_low - E0 + h*v_q[0]*L_q[0]/2 + v_q[0]*p0_q[0]_low + v_q[0]*p0_q[0] + h*v_q[1]*L_q[1]/2 + v_q[1]*p0_q[1]_low + v_q[1]*p0_q[1]`
        ///
        /// 170 operations.
        #[inline(never)]
        fn extended_system(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedSystem<2, T, Self::Jacobian> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [p0_q_0, p0_q_1]: [T; 2] = node.p.into();
            let [p0_q_0_low, p0_q_1_low]: [T; 2] = node.p_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `extended_system`: 27 operations.
            #[inline(never)]
            fn extended_system_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 50],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[9];
                let q_0_0_low = inputs[10];
                let q_1_0_low = inputs[11];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let [(sin2, cos2), (sin3, cos3), (sin4, cos4)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s5 = cos2 + cos3;
                let s6 = cos2 * cos3 + sin2 * sin3;
                let s7 = q_1_dot * s6 * real(0.25);
                let s8 = system.b * q_0_dot;
                let s9 = q_0_dot * q_1_dot;
                let s10 = sin2 * cos3 - cos2 * sin3;
                let s11 = q_0_mid - q_1_mid;
                values[12] = s1;
                values[13] = s11;
                values[14] = cos2;
                values[15] = cos3;
                values[16] = sin2;
                values[17] = sin3;
                values[18] = s6;
                values[19] = s9;
                values[22] = sin4;
                values[24] = s5;
                values[25] = cos4;
                values[26] = s10;
                values[32] = s8;
                values[34] = s7;
            }
            /// Part 2 of `extended_system`: 29 operations.
            #[inline(never)]
            fn extended_system_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 50],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let s1 = values[12];
                let p0_q_0_low = inputs[12];
                let p0_q_0 = inputs[6];
                let s11 = values[13];
                let cos2 = values[14];
                let sin2 = values[16];
                let s6 = values[18];
                let s9 = values[19];
                let sin4 = values[22];
                let s10 = values[26];
                let s8 = values[32];
                let s7 = values[34];
                let s12 = system.k * s11;
                let s13 = s9 * s10 * real(0.25) + s12;
                let s14 = sin4 * real(0.3333333333333333) + real(1.0);
                let s15 = s14 * sin2;
                let s16 = s13 + s15;
                let s17 = system.m * q_0_dot * real(2.0) + s7 - p0_q_0
                    + (s8 * s1 - p0_q_0_low + s1 * s16);
                let s18 = system.m * real(2.0);
                let s19 = system.b * real(0.5);
                let s20 = h * real(0.25);
                let s21 = system.k + s9 * s6 * real(0.25);
                let s22 = s21 + s14 * cos2;
                let s23 = s18 + (s19 + s20 * s22) * h;
                values[23] = s14;
                values[27] = s12;
                values[28] = s15;
                values[29] = s13;
                values[30] = s16;
                values[0] = s17;
                values[37] = s21;
                values[38] = s22;
                values[39] = s18;
                values[40] = s19;
                values[41] = s20;
                values[2] = s23;
            }
            /// Part 3 of `extended_system`: 29 operations.
            #[inline(never)]
            fn extended_system_part_3<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 50],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let sin2 = values[16];
                let s6 = values[18];
                let cos4 = values[25];
                let s10 = values[26];
                let s12 = values[27];
                let s15 = values[28];
                let s8 = values[32];
                let s21 = values[37];
                let s22 = values[38];
                let s20 = values[41];
                let s24 = s6 * real(0.25);
                let s25 = (q_0_dot + q_1_dot) * s10 * real(0.125);
                let s26 = s20 * s21;
                let s27 = s24 - (s25 + s26) * h;
                let s28 = s12 * real(0.5);
                let s29 = q_1_dot * q_1_dot;
                let s30 = s28 + s15 * real(0.5) + s8 * real(0.5)
                    + s29 * s10 * real(0.125);
                let s31 = sin2 * cos4;
                let s32 = s31 * real(0.3333333333333333);
                let s33 = q_0_dot * s22;
                let s34 = q_1_dot * s21;
                let s35 = s30 + s20 * (s32 + s33 - s34);
                let s36 = s30 + s20 * (s34 - s33 - s32);
                values[21] = s29;
                values[42] = s24;
                values[43] = s25;
                values[44] = s26;
                values[4] = s27;
                values[46] = s28;
                values[47] = s31;
                values[48] = s33;
                values[49] = s34;
                values[6] = s35;
                values[9] = s36;
            }
            /// Part 4 of `extended_system`: 47 operations.
            #[inline(never)]
            fn extended_system_part_4<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 50],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[12];
                let p0_q_0_low = inputs[12];
                let p0_q_1_low = inputs[13];
                let p0_q_1 = inputs[7];
                let energy0_low = inputs[14];
                let energy0 = inputs[8];
                let s11 = values[13];
                let cos3 = values[15];
                let sin3 = values[17];
                let s6 = values[18];
                let s29 = values[21];
                let s14 = values[23];
                let s5 = values[24];
                let cos4 = values[25];
                let s13 = values[29];
                let s16 = values[30];
                let s21 = values[37];
                let s18 = values[39];
                let s19 = values[40];
                let s20 = values[41];
                let s24 = values[42];
                let s25 = values[43];
                let s26 = values[44];
                let s37 = system.b * q_1_dot;
                let s38 = s14 * sin3;
                let s39 = s13 - s38;
                let s40 = q_0_dot * p0_q_0_low + q_1_dot * p0_q_1_low - energy0_low
                    + s1
                        * (s5 * cos4 * real(0.3333333333333333) - q_0_dot * s16
                            + q_1_dot * s39);
                let s41 = system.m * q_1_dot * real(2.0) + q_0_dot * s6 * real(0.25)
                    - p0_q_1 + (s37 * s1 - p0_q_1_low - s1 * s39);
                let s42 = s24 + (s25 - s26) * h;
                let s43 = s21 + s14 * cos3;
                let s44 = s18 + (s19 + s20 * s43) * h;
                let s45 = q_0_dot * q_0_dot;
                let s46 = q_1_dot * p0_q_1 + system.k * (s11 * s11) * real(0.5) - energy0
                    - system.m * (s45 + s29) - s14 * s5;
                values[20] = s45;
                values[31] = s38;
                values[33] = s37;
                values[1] = s41;
                values[35] = s46;
                values[36] = s40;
                values[3] = s42;
                values[45] = s43;
                values[5] = s44;
            }
            /// Part 5 of `extended_system`: 38 operations.
            #[inline(never)]
            fn extended_system_part_5<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 50],
            ) {
                let real = T::real;
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let p0_q_0 = inputs[6];
                let sin3 = values[17];
                let s45 = values[20];
                let sin4 = values[22];
                let s5 = values[24];
                let cos4 = values[25];
                let s10 = values[26];
                let s38 = values[31];
                let s37 = values[33];
                let s7 = values[34];
                let s46 = values[35];
                let s40 = values[36];
                let s21 = values[37];
                let s20 = values[41];
                let s43 = values[45];
                let s28 = values[46];
                let s31 = values[47];
                let s33 = values[48];
                let s34 = values[49];
                let s47 = s46 + (p0_q_0 - s7) * q_0_dot + s40;
                let s48 = s38 * real(0.5) + s37 * real(0.5) - s28
                    - s45 * s10 * real(0.125);
                let s49 = sin3 * cos4;
                let s50 = s49 * real(0.3333333333333333);
                let s51 = q_0_dot * s21;
                let s52 = q_1_dot * s43;
                let s53 = (-(s52 * real(0.25)) - s49 * real(0.16666666666666666))
                    * q_1_dot - sin4 * s5 * real(0.08333333333333333)
                    + (s34 * real(0.5) - s33 * real(0.25)
                        - s31 * real(0.16666666666666666)) * q_0_dot;
                let s54 = s48 + s20 * (s50 - s51 + s52);
                let s55 = s48 + s20 * (s51 - s52 - s50);
                values[8] = s47;
                values[7] = s54;
                values[10] = s55;
                values[11] = s53;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                p0_q_0,
                p0_q_1,
                energy0,
                t0_low,
                q_0_0_low,
                q_1_0_low,
                p0_q_0_low,
                p0_q_1_low,
                energy0_low,
            ];
            let mut values = [T::real(0.0); 50];
            extended_system_part_1(system, &inputs, &mut values);
            extended_system_part_2(system, &inputs, &mut values);
            extended_system_part_3(system, &inputs, &mut values);
            extended_system_part_4(system, &inputs, &mut values);
            extended_system_part_5(system, &inputs, &mut values);
            ::vi_core::stepping::ExtendedSystem {
                momentum: ::vi_core::stepping::MomentumEquation {
                    residual: ::vi_core::SVector::from([values[0], values[1]]),
                    jacobian: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[values[2], values[3], values[4], values[5]],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([values[6], values[7]]),
                energy_residual: values[8],
                energy_dv: ::vi_core::SVector::from([values[9], values[10]]),
                energy_dh: values[11],
            }
        }

        /// Both residuals, their rounding scales, and
        ///
        /// `E1 − E0 = h*v_q[0]*f_q[0] - h*L_t + h*v_q[1]*f_q[1]`
        ///
        /// 179 operations.
        #[inline(never)]
        fn extended_residual(
            &self,
            node: &::vi_core::node::Node<2, T>,
            h: T,
            v: &::vi_core::SVector<T, 2>,
        ) -> ::vi_core::stepping::ExtendedResidual<2, T> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [p0_q_0, p0_q_1]: [T; 2] = node.p.into();
            let [p0_q_0_low, p0_q_1_low]: [T; 2] = node.p_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `extended_residual`: 25 operations.
            #[inline(never)]
            fn extended_residual_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 46],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[9];
                let q_0_0_low = inputs[10];
                let q_1_0_low = inputs[11];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let s2 = q_0_dot * q_0_dot;
                let s3 = system.m * q_0_dot;
                let s4 = q_1_dot * q_1_dot;
                let s5 = s2 + s4;
                let [(sin6, cos6), (sin7, cos7), (sin8, cos8)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s9 = cos6 + cos7;
                let s10 = cos6 * cos7 + sin6 * sin7;
                let s11 = q_1_dot * s10;
                let s12 = s11 * real(0.25);
                values[9] = s1;
                values[10] = q_0_mid;
                values[11] = q_1_mid;
                values[13] = s3;
                values[16] = cos6;
                values[17] = cos7;
                values[18] = sin6;
                values[19] = sin7;
                values[20] = s10;
                values[22] = s2;
                values[23] = s4;
                values[24] = s5;
                values[25] = sin8;
                values[27] = s9;
                values[28] = cos8;
                values[29] = s11;
                values[36] = s12;
            }
            /// Part 2 of `extended_residual`: 31 operations.
            #[inline(never)]
            fn extended_residual_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 46],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[9];
                let q_0_mid = values[10];
                let q_1_mid = values[11];
                let p0_q_0_low = inputs[12];
                let p0_q_0 = inputs[6];
                let s3 = values[13];
                let cos6 = values[16];
                let cos7 = values[17];
                let sin6 = values[18];
                let sin7 = values[19];
                let s2 = values[22];
                let s4 = values[23];
                let sin8 = values[25];
                let s9 = values[27];
                let cos8 = values[28];
                let s12 = values[36];
                let s13 = system.b * h;
                let s14 = s13 * real(0.5);
                let s15 = q_0_dot * q_1_dot;
                let s16 = s15 * (sin6 * cos7 - cos6 * sin7);
                let s17 = q_0_mid - q_1_mid;
                let s18 = system.k * s17;
                let s19 = s16 * real(0.25) + s18;
                let s20 = s9 * cos8 * real(0.3333333333333333);
                let s21 = -((s20 + system.b * s2 + system.b * s4) * h);
                let s22 = sin8 * real(0.3333333333333333) + real(1.0);
                let s23 = s19 + s22 * sin6;
                let s24 = s3 * real(2.0) + s12 - p0_q_0
                    + (s14 * q_0_dot - p0_q_0_low + s1 * s23);
                values[12] = s13;
                values[15] = s17;
                values[21] = s15;
                values[26] = s22;
                values[31] = s16;
                values[32] = s18;
                values[33] = s19;
                values[34] = s23;
                values[37] = s14;
                values[0] = s24;
                values[38] = s20;
                values[8] = s21;
            }
            /// Part 3 of `extended_residual`: 32 operations.
            #[inline(never)]
            fn extended_residual_part_3<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 46],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_0_mid = values[10];
                let q_1_mid = values[11];
                let p0_q_0 = inputs[6];
                let s13 = values[12];
                let s3 = values[13];
                let sin6 = values[18];
                let sin8 = values[25];
                let s11 = values[29];
                let s16 = values[31];
                let s23 = values[34];
                let s25 = s13 * q_0_dot;
                let s26 = h.abs() * real(0.5);
                let s27 = q_0_mid.abs() + q_1_mid.abs();
                let s28 = s16.abs() * real(0.25) + system.k.abs() * s27;
                let s29 = sin8.abs() * real(0.3333333333333333);
                let s30 = s29 + real(1.0);
                let s31 = s28 + s30 * sin6.abs();
                let s32 = p0_q_0.abs() + s25.abs() * real(0.5) + s3.abs() * real(2.0)
                    + s11.abs() * real(0.25) + s26 * s31;
                let s33 = -(h * s23) - s25;
                values[6] = s33;
                values[39] = s27;
                values[40] = s29;
                values[41] = s30;
                values[42] = s28;
                values[43] = s31;
                values[44] = s26;
                values[2] = s32;
            }
            /// Part 4 of `extended_residual`: 50 operations.
            #[inline(never)]
            fn extended_residual_part_4<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 46],
            ) {
                let real = T::real;
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[9];
                let p0_q_0_low = inputs[12];
                let p0_q_0 = inputs[6];
                let p0_q_1_low = inputs[13];
                let p0_q_1 = inputs[7];
                let energy0_low = inputs[14];
                let energy0 = inputs[8];
                let s17 = values[15];
                let sin7 = values[19];
                let s10 = values[20];
                let s15 = values[21];
                let s5 = values[24];
                let s22 = values[26];
                let s9 = values[27];
                let s18 = values[32];
                let s19 = values[33];
                let s23 = values[34];
                let s12 = values[36];
                let s14 = values[37];
                let s20 = values[38];
                let s27 = values[39];
                let s34 = system.m * q_1_dot;
                let s35 = q_0_dot * s10;
                let s36 = q_1_dot * p0_q_1;
                let s37 = s36 + system.k * (s17 * s17) * real(0.5) - energy0
                    - system.m * s5 - s22 * s9 + (p0_q_0 - s12) * q_0_dot;
                let s38 = energy0.abs() + (q_0_dot * p0_q_0).abs() + s36.abs()
                    + (s15 * s10).abs() * real(0.25) + s27 * s18.abs();
                let s39 = s19 - s22 * sin7;
                let s40 = s37
                    + (q_0_dot * p0_q_0_low + q_1_dot * p0_q_1_low - energy0_low
                        + s1 * (s20 - q_0_dot * s23 + q_1_dot * s39));
                let s41 = s34 * real(2.0) + s35 * real(0.25) - p0_q_1
                    + (s14 * q_1_dot - p0_q_1_low - s1 * s39);
                values[14] = s34;
                values[30] = s35;
                values[35] = s39;
                values[1] = s41;
                values[4] = s40;
                values[45] = s38;
            }
            /// Part 5 of `extended_residual`: 41 operations.
            #[inline(never)]
            fn extended_residual_part_5<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 15],
                values: &mut [T; 46],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let p0_q_1 = inputs[7];
                let s13 = values[12];
                let s34 = values[14];
                let cos6 = values[16];
                let cos7 = values[17];
                let sin7 = values[19];
                let s5 = values[24];
                let cos8 = values[28];
                let s35 = values[30];
                let s39 = values[35];
                let s29 = values[40];
                let s30 = values[41];
                let s28 = values[42];
                let s31 = values[43];
                let s26 = values[44];
                let s38 = values[45];
                let s42 = s13 * q_1_dot;
                let s43 = s28 + s30 * sin7.abs();
                let s44 = s38 + system.m.abs() * s5
                    + s31 * (h * q_0_dot).abs() * real(0.5)
                    + s43 * (h * q_1_dot).abs() * real(0.5);
                let s45 = s44
                    + (s29 + (h * cos8).abs() * real(0.16666666666666666) + real(1.0))
                        * (cos6.abs() + cos7.abs());
                let s46 = p0_q_1.abs() + s42.abs() * real(0.5) + s34.abs() * real(2.0)
                    + s35.abs() * real(0.25) + s26 * s43;
                let s47 = h * s39 - s42;
                values[7] = s47;
                values[3] = s46;
                values[5] = s45;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                p0_q_0,
                p0_q_1,
                energy0,
                t0_low,
                q_0_0_low,
                q_1_0_low,
                p0_q_0_low,
                p0_q_1_low,
                energy0_low,
            ];
            let mut values = [T::real(0.0); 46];
            extended_residual_part_1(system, &inputs, &mut values);
            extended_residual_part_2(system, &inputs, &mut values);
            extended_residual_part_3(system, &inputs, &mut values);
            extended_residual_part_4(system, &inputs, &mut values);
            extended_residual_part_5(system, &inputs, &mut values);
            ::vi_core::stepping::ExtendedResidual {
                residual: ::vi_core::SVector::from([values[0], values[1]]),
                scale: ::vi_core::SVector::from([values[2], values[3]]),
                energy_residual: values[4],
                energy_scale: values[5],
                increment: ::vi_core::stepping::Increment {
                    momentum: ::vi_core::SVector::from([values[6], values[7]]),
                    energy: values[8],
                },
            }
        }

        /// How both residuals, `p1 − p0` and `E1 − E0` change with the coordinates of the node, v and h.
        ///
        /// 190 operations.
        #[inline(never)]
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
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0]: [T; 2] = node.q.into();
            let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
            let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
            let real = T::real;
            /// Part 1 of `extended_derivatives`: 26 operations.
            #[inline(never)]
            fn extended_derivatives_part_1<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 71],
            ) {
                let real = T::real;
                let h = inputs[3];
                let t0 = inputs[0];
                let q_0_0 = inputs[1];
                let q_1_0 = inputs[2];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let t0_low = inputs[6];
                let q_0_0_low = inputs[7];
                let q_1_0_low = inputs[8];
                let s1 = h * real(0.5);
                let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
                let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
                let t_mid = t0 + (s1 + t0_low);
                let s2 = system.m * real(2.0);
                let s3 = system.b * real(0.5);
                let s4 = h * real(0.25);
                let s5 = q_0_dot * q_1_dot;
                let [(sin6, cos6), (sin7, cos7), (sin8, cos8)] = T::sin_cos_each([
                    q_0_mid,
                    q_1_mid,
                    t_mid,
                ]);
                let s9 = cos6 + cos7;
                let s10 = cos6 * cos7 + sin6 * sin7;
                let s11 = system.k + s5 * s10 * real(0.25);
                values[29] = s1;
                values[30] = q_0_mid;
                values[31] = q_1_mid;
                values[32] = cos6;
                values[33] = cos7;
                values[34] = sin6;
                values[35] = sin7;
                values[36] = s10;
                values[37] = s5;
                values[38] = sin8;
                values[40] = s9;
                values[41] = cos8;
                values[47] = s11;
                values[49] = s2;
                values[50] = s3;
                values[51] = s4;
            }
            /// Part 2 of `extended_derivatives`: 40 operations.
            #[inline(never)]
            fn extended_derivatives_part_2<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 71],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[29];
                let q_0_mid = values[30];
                let q_1_mid = values[31];
                let cos6 = values[32];
                let cos7 = values[33];
                let sin6 = values[34];
                let sin7 = values[35];
                let s10 = values[36];
                let sin8 = values[38];
                let s9 = values[40];
                let s11 = values[47];
                let s2 = values[49];
                let s3 = values[50];
                let s4 = values[51];
                let s12 = sin8 * s9;
                let s13 = sin8 * real(0.3333333333333333) + real(1.0);
                let s14 = s11 + s13 * cos6;
                let s15 = s2 + (s3 + s4 * s14) * h;
                let s16 = s10 * real(0.25);
                let s17 = sin6 * cos7 - cos6 * sin7;
                let s18 = (q_0_dot + q_1_dot) * s17 * real(0.125);
                let s19 = s4 * s11;
                let s20 = s16 - (s18 + s19) * h;
                let s21 = s1 * s14;
                let s22 = q_1_dot * s17 * real(0.25);
                let s23 = s21 - s22;
                let s24 = q_0_dot * s17 * real(0.25);
                let s25 = s1 * s11;
                let s26 = -s24 - s25;
                let s27 = -(h * s14);
                let s28 = h * s11;
                let s29 = system.b + s22;
                let s30 = (-s29 - s21) * h;
                let s31 = (s22 + s25) * h;
                let s32 = system.k * (q_0_mid - q_1_mid);
                values[39] = s13;
                values[42] = s17;
                values[43] = s32;
                values[48] = s14;
                values[0] = s15;
                values[52] = s16;
                values[53] = s18;
                values[54] = s19;
                values[2] = s20;
                values[62] = s12;
                values[8] = s27;
                values[63] = s22;
                values[4] = s23;
                values[9] = s28;
                values[64] = s25;
                values[65] = s24;
                values[6] = s26;
                values[66] = s29;
                values[11] = s30;
                values[13] = s31;
            }
            /// Part 3 of `extended_derivatives`: 50 operations.
            #[inline(never)]
            fn extended_derivatives_part_3<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 71],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[29];
                let cos7 = values[33];
                let sin6 = values[34];
                let s5 = values[37];
                let s13 = values[39];
                let cos8 = values[41];
                let s17 = values[42];
                let s32 = values[43];
                let s11 = values[47];
                let s14 = values[48];
                let s2 = values[49];
                let s3 = values[50];
                let s4 = values[51];
                let s16 = values[52];
                let s18 = values[53];
                let s19 = values[54];
                let s29 = values[66];
                let s33 = s32 * real(0.5);
                let s34 = s13 * sin6;
                let s35 = system.b * q_0_dot;
                let s36 = q_1_dot * q_1_dot;
                let s37 = s33 + s34 * real(0.5) + s35 * real(0.5)
                    + s36 * s17 * real(0.125);
                let s38 = sin6 * cos8;
                let s39 = s38 * real(0.3333333333333333);
                let s40 = q_0_dot * s14;
                let s41 = q_1_dot * s11;
                let s42 = s37 + s4 * (s39 + s40 - s41);
                let s43 = s5 * s17 * real(0.25);
                let s44 = s41 - s40 - s39;
                let s45 = s1 * s44;
                let s46 = s43 + s32 + s34 + s45;
                let s47 = s37 + s4 * s44;
                let s48 = -(s29 * q_0_dot) - (s32 + s34) + s45;
                let s49 = h * real(0.3333333333333333);
                let s50 = s38 * s49;
                let s51 = h * real(0.16666666666666666);
                let s52 = (s38 * s51 - s35 * real(2.0)) * h;
                let s53 = s16 + (s18 - s19) * h;
                let s54 = s11 + s13 * cos7;
                let s55 = s2 + (s3 + s4 * s54) * h;
                values[46] = s36;
                values[1] = s53;
                values[55] = s54;
                values[3] = s55;
                values[56] = s33;
                values[57] = s38;
                values[58] = s40;
                values[59] = s41;
                values[15] = s42;
                values[19] = s47;
                values[68] = s43;
                values[17] = s46;
                values[22] = s48;
                values[69] = s49;
                values[24] = s50;
                values[70] = s51;
                values[26] = s52;
            }
            /// Part 4 of `extended_derivatives`: 36 operations.
            #[inline(never)]
            fn extended_derivatives_part_4<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 71],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[29];
                let sin6 = values[34];
                let sin7 = values[35];
                let s13 = values[39];
                let s9 = values[40];
                let cos8 = values[41];
                let s17 = values[42];
                let s36 = values[46];
                let s54 = values[55];
                let s33 = values[56];
                let s12 = values[62];
                let s22 = values[63];
                let s25 = values[64];
                let s24 = values[65];
                let s56 = s22 - s25;
                let s57 = s1 * s54;
                let s58 = s24 + s57;
                let s59 = -(h * s54);
                let s60 = (s25 - s24) * h;
                let s61 = s24 - system.b;
                let s62 = (s61 - s57) * h;
                let s63 = s13 * sin7;
                let s64 = system.b * q_1_dot;
                let s65 = q_0_dot * q_0_dot;
                let s66 = (s12 * real(0.16666666666666666)
                    + (q_0_dot * sin6 + q_1_dot * sin7) * cos8
                        * real(0.16666666666666666)) * h
                    - (s9 * cos8 * real(0.3333333333333333) + system.b * s65
                        + system.b * s36);
                let s67 = s63 * real(0.5) + s64 * real(0.5) - s33
                    - s65 * s17 * real(0.125);
                let s68 = sin7 * cos8;
                values[44] = s63;
                values[45] = s64;
                values[60] = s67;
                values[61] = s68;
                values[5] = s56;
                values[10] = s59;
                values[7] = s58;
                values[12] = s60;
                values[67] = s61;
                values[14] = s62;
                values[28] = s66;
            }
            /// Part 5 of `extended_derivatives`: 38 operations.
            #[inline(never)]
            fn extended_derivatives_part_5<T: ::vi_core::real::Real>(
                system: &Pendula<T>,
                inputs: &[T; 9],
                values: &mut [T; 71],
            ) {
                let real = T::real;
                let h = inputs[3];
                let q_0_dot = inputs[4];
                let q_1_dot = inputs[5];
                let s1 = values[29];
                let s32 = values[43];
                let s63 = values[44];
                let s64 = values[45];
                let s11 = values[47];
                let s4 = values[51];
                let s54 = values[55];
                let s38 = values[57];
                let s40 = values[58];
                let s41 = values[59];
                let s67 = values[60];
                let s68 = values[61];
                let s12 = values[62];
                let s61 = values[67];
                let s43 = values[68];
                let s49 = values[69];
                let s51 = values[70];
                let s69 = s68 * real(0.3333333333333333);
                let s70 = q_0_dot * s11;
                let s71 = q_1_dot * s54;
                let s72 = (-(s71 * real(0.25)) - s68 * real(0.16666666666666666))
                    * q_1_dot - s12 * real(0.08333333333333333)
                    + (s41 * real(0.5) - s40 * real(0.25)
                        - s38 * real(0.16666666666666666)) * q_0_dot;
                let s73 = s67 + s4 * (s69 - s70 + s71);
                let s74 = s70 - s71 - s69;
                let s75 = s1 * s74;
                let s76 = s63 - s43 - s32 + s75;
                let s77 = s67 + s4 * s74;
                let s78 = s32 - s63 + s61 * q_1_dot + s75;
                let s79 = s68 * s49;
                let s80 = (s68 * s51 - s64 * real(2.0)) * h;
                values[16] = s73;
                values[20] = s77;
                values[21] = s72;
                values[18] = s76;
                values[23] = s78;
                values[25] = s79;
                values[27] = s80;
            }
            let system = self;
            let inputs = [
                t0,
                q_0_0,
                q_1_0,
                h,
                q_0_dot,
                q_1_dot,
                t0_low,
                q_0_0_low,
                q_1_0_low,
            ];
            let mut values = [T::real(0.0); 71];
            extended_derivatives_part_1(system, &inputs, &mut values);
            extended_derivatives_part_2(system, &inputs, &mut values);
            extended_derivatives_part_3(system, &inputs, &mut values);
            extended_derivatives_part_4(system, &inputs, &mut values);
            extended_derivatives_part_5(system, &inputs, &mut values);
            ::vi_core::stepping::ExtendedDerivatives {
                momentum: ::vi_core::stepping::MomentumDerivatives {
                    residual_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[values[4], values[5], values[6], values[7]],
                    ),
                    residual_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[values[0], values[1], values[2], values[3]],
                    ),
                    increment_dq: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[values[8], values[9], values[9], values[10]],
                    ),
                    increment_dv: ::vi_core::nalgebra::SMatrix::from_row_slice(
                        &[values[11], values[12], values[13], values[14]],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([values[15], values[16]]),
                increment_dh: ::vi_core::SVector::from([values[22], values[23]]),
                energy_dq: ::vi_core::SVector::from([values[17], values[18]]),
                energy_dv: ::vi_core::SVector::from([values[19], values[20]]),
                energy_dh: values[21],
                energy_increment_dq: ::vi_core::SVector::from([values[24], values[25]]),
                energy_increment_dv: ::vi_core::SVector::from([values[26], values[27]]),
                energy_increment_dh: values[28],
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

    impl ::vi_core::stepping::Discretized<2> for Pendula<f64> {
        type Steps<T: ::vi_core::real::Real> = Pendula<T>;
        #[inline(always)]
        fn steps<T: ::vi_core::real::Real>(&self) -> Pendula<T> {
            self.convert()
        }
    }

    impl ::vi_core::stepping::Batch<2> for Pendula<f64> {
        type Rows<const W: usize> = Pendula<[f64; W]>;
        fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
            Pendula {
                m: ::core::array::from_fn(|index| systems[index].m),
                k: ::core::array::from_fn(|index| systems[index].k),
                b: ::core::array::from_fn(|index| systems[index].b),
            }
        }

        #[inline(always)]
        fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self {
            Pendula {
                m: rows.m[index],
                k: rows.k[index],
                b: rows.b[index],
            }
        }
    }
};
