/// Pendula in a row, driven: what is the same for all of them is a loop.
///
/// Discretized by the rule `midpoint`. What the generator found:
///
/// * Not autonomous: `L` or `f` depends on the time `t`; a force acts
/// * `L = T(v) + U(t, q)` with a constant mass matrix
/// * The step's equation in `v` is nonlinear: its Jacobian `A` depends on `v`, and Newton's iteration gives the step
/// * `A` is tridiagonal, symmetric; solved by elimination from both ends
#[derive(
    ::core::clone::Clone,
    ::core::marker::Copy,
    ::core::fmt::Debug,
    ::core::cmp::PartialEq
)]
#[allow(non_snake_case)]
pub struct Chain<T = ::core::primitive::f64> {
    /// Parameter `m`, 1.2 by default.
    pub m: T,
    /// Parameter `k`, 0.7 by default.
    pub k: T,
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
    use ::core::convert::{identity as system, identity as name, identity as t};
    use ::core::convert::{identity as q, identity as v, identity as q_0_dot};
    use ::core::convert::{identity as q_1_dot, identity as q_2_dot, identity as q_3_dot};
    use ::core::convert::{identity as q_4_dot, identity as q_5_dot, identity as q_6_dot};
    use ::core::convert::{identity as q_7_dot, identity as q_8_dot, identity as q_9_dot};
    use ::core::convert::{identity as q_0, identity as q_1, identity as q_2};
    use ::core::convert::{identity as q_3, identity as q_4, identity as q_5};
    use ::core::convert::{identity as q_6, identity as q_7, identity as q_8};
    use ::core::convert::{identity as q_9, identity as real, identity as s1};
    use ::core::convert::{identity as s2, identity as s3, identity as s4};
    use ::core::convert::{identity as s5, identity as s6, identity as s7};
    use ::core::convert::{identity as s8, identity as s9, identity as s10};
    use ::core::convert::{identity as s11, identity as s12, identity as s13};
    use ::core::convert::{identity as s14, identity as s15, identity as s16};
    use ::core::convert::{identity as s17, identity as s18, identity as s19};
    use ::core::convert::{identity as s20, identity as sin21, identity as cos22};
    use ::core::convert::{identity as cos23, identity as cos24, identity as cos25};
    use ::core::convert::{identity as cos26, identity as cos27, identity as cos28};
    use ::core::convert::{identity as cos29, identity as cos30, identity as cos31};
    use ::core::convert::{identity as s32, identity as s33, identity as sin20};
    use ::core::convert::{identity as cos21, identity as s31, identity as s34};
    use ::core::convert::{identity as s35, identity as cos1, identity as cos2};
    use ::core::convert::{identity as cos3, identity as cos4, identity as cos5};
    use ::core::convert::{identity as cos6, identity as cos7, identity as cos8};
    use ::core::convert::{identity as time, identity as sin10, identity as sin11};
    use ::core::convert::{identity as cos11, identity as sin12, identity as cos12};
    use ::core::convert::{identity as sin13, identity as cos13, identity as sin15};
    use ::core::convert::{identity as cos15, identity as sin16, identity as cos16};
    use ::core::convert::{identity as sin17, identity as cos17, identity as sin18};
    use ::core::convert::{identity as cos18, identity as sin19, identity as cos19};
    use ::core::convert::{identity as cos20, identity as s22, identity as s23};
    use ::core::convert::{identity as s24, identity as s25, identity as s26};
    use ::core::convert::{identity as s27, identity as s28, identity as s29};
    use ::core::convert::{identity as s30, identity as mass, identity as applied};
    use ::core::convert::{identity as a, identity as sin1, identity as i};
    use ::core::convert::{identity as sum, identity as values, identity as value};
    use ::core::convert::{identity as text, identity as interval, identity as t0};
    use ::core::convert::{identity as t1, identity as h, identity as q_0_0};
    use ::core::convert::{identity as q_1_0, identity as q_2_0, identity as q_3_0};
    use ::core::convert::{identity as q_4_0, identity as q_5_0, identity as q_6_0};
    use ::core::convert::{identity as q_7_0, identity as q_8_0, identity as q_9_0};
    use ::core::convert::{identity as q_0_1, identity as q_1_1, identity as q_2_1};
    use ::core::convert::{identity as q_3_1, identity as q_4_1, identity as q_5_1};
    use ::core::convert::{identity as q_6_1, identity as q_7_1, identity as q_8_1};
    use ::core::convert::{identity as q_9_1, identity as t_mid, identity as q_0_mid};
    use ::core::convert::{identity as q_1_mid, identity as q_2_mid, identity as q_3_mid};
    use ::core::convert::{identity as q_4_mid, identity as q_5_mid, identity as q_6_mid};
    use ::core::convert::{identity as q_7_mid, identity as q_8_mid, identity as q_9_mid};
    use ::core::convert::{identity as s21, identity as sin30, identity as cos32};
    use ::core::convert::{identity as cos33, identity as cos34, identity as cos35};
    use ::core::convert::{identity as cos36, identity as cos37, identity as cos38};
    use ::core::convert::{identity as cos39, identity as cos40, identity as s41};
    use ::core::convert::{identity as s42, identity as s43, identity as s44};
    use ::core::convert::{identity as sin22, identity as sin23, identity as sin28};
    use ::core::convert::{identity as sin29, identity as sin27, identity as node};
    use ::core::convert::{
        identity as t0_low, identity as q_0_0_low, identity as q_1_0_low,
    };

    use ::core::convert::{
        identity as q_2_0_low, identity as q_3_0_low, identity as q_4_0_low,
    };

    use ::core::convert::{
        identity as q_5_0_low, identity as q_6_0_low, identity as q_7_0_low,
    };

    use ::core::convert::{
        identity as q_8_0_low, identity as q_9_0_low, identity as p0_q_0,
    };

    use ::core::convert::{identity as p0_q_1, identity as p0_q_2, identity as p0_q_3};
    use ::core::convert::{identity as p0_q_4, identity as p0_q_5, identity as p0_q_6};
    use ::core::convert::{identity as p0_q_7, identity as p0_q_8, identity as p0_q_9};
    use ::core::convert::{
        identity as p0_q_0_low, identity as p0_q_1_low, identity as p0_q_2_low,
    };

    use ::core::convert::{
        identity as p0_q_3_low, identity as p0_q_4_low, identity as p0_q_5_low,
    };

    use ::core::convert::{
        identity as p0_q_6_low, identity as p0_q_7_low, identity as p0_q_8_low,
    };

    use ::core::convert::{identity as p0_q_9_low, identity as sin14, identity as cos14};
    use ::core::convert::{identity as s36, identity as s37, identity as s38};
    use ::core::convert::{identity as s39, identity as s40, identity as s45};
    use ::core::convert::{identity as s46, identity as s47, identity as s48};
    use ::core::convert::{identity as s49, identity as s50, identity as s51};
    use ::core::convert::{identity as s52, identity as s53, identity as s54};
    use ::core::convert::{identity as s55, identity as s56, identity as s57};
    use ::core::convert::{identity as s58, identity as s59, identity as energy0};
    use ::core::convert::{identity as energy0_low, identity as q0, identity as q0_low};
    use ::core::convert::{identity as p0, identity as p0_low, identity as sin2};
    use ::core::convert::{identity as q_mid, identity as s60, identity as s61};
    use ::core::convert::{identity as s62, identity as s63, identity as s64};
    use ::core::convert::{identity as s65, identity as s66, identity as s67};
    use ::core::convert::{identity as s68, identity as s69, identity as s70};
    use ::core::convert::{identity as entries, identity as place, identity as solve};
    use ::core::convert::{identity as s71, identity as momentum, identity as change};
    use ::core::convert::{identity as change_h, identity as systems, identity as index};
    use ::core::convert::identity as rows;
    use ::core::primitive::{bool, f64, str, usize};

    impl ::core::default::Default for Chain<f64> {
        fn default() -> Self {
            Self { m: 1.2, k: 0.7 }
        }
    }

    impl<T: ::vi_core::Real> Chain<T> {
        /// The same system in another kind of number, every parameter rounded to it.
        pub fn from_f64(system: &Chain<f64>) -> Self {
            Self {
                m: T::real(system.m),
                k: T::real(system.k),
            }
        }
    }

    impl<T: ::vi_core::Real> ::vi_core::Parameters<T> for Chain<T> {
        const PARAMETERS: &'static [&'static str] = &["m", "k"];
        fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
            match name {
                "m" => ::core::option::Option::Some(&mut self.m),
                "k" => ::core::option::Option::Some(&mut self.k),
                _ => ::core::option::Option::None,
            }
        }
    }

    impl<T: ::vi_core::Real> ::vi_core::Lagrangian<10, T> for Chain<T> {
        const NAME: &'static str = "Chain";
        const COORDINATES: [&'static str; 10] = [
            "q[0]",
            "q[1]",
            "q[2]",
            "q[3]",
            "q[4]",
            "q[5]",
            "q[6]",
            "q[7]",
            "q[8]",
            "q[9]",
        ];
        const AUTONOMOUS: bool = false;
        const FORCED: bool = true;
        const CYCLIC: [bool; 10] = [
            false, false, false, false, false, false, false, false, false, false,
        ];

        /// `L = m*(dot(q[0])^2 + dot(q[1])^2 + dot(q[2])^2 + dot(q[3])^2 + dot(q[4])^2 + dot(q[5])^2 + dot(q[6])^2 + dot(q[7])^2 + dot(q[8])^2 + dot(q[9])^2)/2 - k*((q[1] - q[0])^4 + (q[2] - q[1])^4 + (q[3] - q[2])^4 + (q[4] - q[3])^4 + (q[5] - q[4])^4 + (q[6] - q[5])^4 + (q[7] - q[6])^4 + (q[8] - q[7])^4 + (q[9] - q[8])^4)/4 + (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1]) + cos(q[2]) + cos(q[3]) + cos(q[4]) + cos(q[5]) …`
        ///
        /// 83 operations.
        #[inline]
        fn lagrangian(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> T {
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q)
                .into();
            let real = T::real;
            let s1 = q_1 - q_0;
            let s2 = s1 * s1;
            let s3 = q_2 - q_1;
            let s4 = s3 * s3;
            let s5 = q_3 - q_2;
            let s6 = s5 * s5;
            let s7 = q_4 - q_3;
            let s8 = s7 * s7;
            let s9 = q_5 - q_4;
            let s10 = s9 * s9;
            let s11 = q_6 - q_5;
            let s12 = s11 * s11;
            let s13 = q_7 - q_6;
            let s14 = s13 * s13;
            let s15 = q_8 - q_7;
            let s16 = s15 * s15;
            let s17 = q_9 - q_8;
            let s18 = s17 * s17;
            let s19 = s2 * s2 + s4 * s4 + s6 * s6 + s8 * s8 + s10 * s10 + s12 * s12;
            let s20 = q_0_dot * q_0_dot + q_1_dot * q_1_dot + q_2_dot * q_2_dot
                + q_3_dot * q_3_dot + q_4_dot * q_4_dot + q_5_dot * q_5_dot;
            let [(sin21, _), (_, cos22), (_, cos23), (_, cos24)] = T::sin_cos_each([
                t,
                q_0,
                q_1,
                q_2,
            ]);
            let [(_, cos25), (_, cos26), (_, cos27), (_, cos28)] = T::sin_cos_each([
                q_3,
                q_4,
                q_5,
                q_6,
            ]);
            let [(_, cos29), (_, cos30), (_, cos31)] = T::sin_cos_each([q_7, q_8, q_9]);
            let s32 = (sin21 * real(0.3333333333333333) + real(1.0))
                * (cos22 + cos23 + cos24 + cos25 + cos26 + cos27 + cos28 + cos29 + cos30
                    + cos31);
            let s33 = self.m
                * (s20 + q_6_dot * q_6_dot + q_7_dot * q_7_dot + q_8_dot * q_8_dot
                    + q_9_dot * q_9_dot) * real(0.5) + s32;
            s33 - self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25)
        }

        /// `v·L_v − L = k*((q[1] - q[0])^4 + (q[2] - q[1])^4 + (q[3] - q[2])^4 + (q[4] - q[3])^4 + (q[5] - q[4])^4 + (q[6] - q[5])^4 + (q[7] - q[6])^4 + (q[8] - q[7])^4 + (q[9] - q[8])^4)/4 - (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1]) + cos(q[2]) + cos(q[3]) + cos(q[4]) + cos(q[5]) + cos(q[6]) + cos(q[7]) + cos(q[8]) + cos(q[9])) + m*dot(q[0])^2/2 + m*dot(q[1])^2/2 + m*dot(q[2])^2/2 + m*dot(q[3])^2/2 + m*dot(q[4])^2/2 + …`
        ///
        /// 101 operations.
        #[inline]
        fn energy(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> T {
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q)
                .into();
            let real = T::real;
            let s1 = q_1 - q_0;
            let s2 = s1 * s1;
            let s3 = q_2 - q_1;
            let s4 = s3 * s3;
            let s5 = q_3 - q_2;
            let s6 = s5 * s5;
            let s7 = q_4 - q_3;
            let s8 = s7 * s7;
            let s9 = q_5 - q_4;
            let s10 = s9 * s9;
            let s11 = q_6 - q_5;
            let s12 = s11 * s11;
            let s13 = q_7 - q_6;
            let s14 = s13 * s13;
            let s15 = q_8 - q_7;
            let s16 = s15 * s15;
            let s17 = q_9 - q_8;
            let s18 = s17 * s17;
            let s19 = s2 * s2 + s4 * s4 + s6 * s6 + s8 * s8 + s10 * s10 + s12 * s12;
            let [(sin20, _), (_, cos21), (_, cos22), (_, cos23)] = T::sin_cos_each([
                t,
                q_0,
                q_1,
                q_2,
            ]);
            let [(_, cos24), (_, cos25), (_, cos26), (_, cos27)] = T::sin_cos_each([
                q_3,
                q_4,
                q_5,
                q_6,
            ]);
            let [(_, cos28), (_, cos29), (_, cos30)] = T::sin_cos_each([q_7, q_8, q_9]);
            let s31 = (sin20 * real(0.3333333333333333) + real(1.0))
                * (cos21 + cos22 + cos23 + cos24 + cos25 + cos26 + cos27 + cos28 + cos29
                    + cos30);
            let s32 = self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25)
                + self.m * (q_0_dot * q_0_dot) * real(0.5);
            let s33 = s32 + self.m * (q_1_dot * q_1_dot) * real(0.5)
                + self.m * (q_2_dot * q_2_dot) * real(0.5)
                + self.m * (q_3_dot * q_3_dot) * real(0.5);
            let s34 = s33 + self.m * (q_4_dot * q_4_dot) * real(0.5)
                + self.m * (q_5_dot * q_5_dot) * real(0.5)
                + self.m * (q_6_dot * q_6_dot) * real(0.5);
            let s35 = s34 + self.m * (q_7_dot * q_7_dot) * real(0.5)
                + self.m * (q_8_dot * q_8_dot) * real(0.5)
                + self.m * (q_9_dot * q_9_dot) * real(0.5);
            s35 - s31
        }

        /// `p_q[0] = m*dot(q[0])`
        ///
        /// `p_q[1] = m*dot(q[1])`
        ///
        /// `p_q[2] = m*dot(q[2])`
        ///
        /// `p_q[3] = m*dot(q[3])`
        ///
        /// `p_q[4] = m*dot(q[4])`
        ///
        /// `p_q[5] = m*dot(q[5])`
        ///
        /// `p_q[6] = m*dot(q[6])`
        ///
        /// `p_q[7] = m*dot(q[7])`
        ///
        /// `p_q[8] = m*dot(q[8])`
        ///
        /// `p_q[9] = m*dot(q[9])`
        ///
        /// 10 operations.
        #[inline]
        fn momentum(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::SVector<T, 10> {
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            ::vi_core::SVector::from([
                self.m * q_0_dot,
                self.m * q_1_dot,
                self.m * q_2_dot,
                self.m * q_3_dot,
                self.m * q_4_dot,
                self.m * q_5_dot,
                self.m * q_6_dot,
                self.m * q_7_dot,
                self.m * q_8_dot,
                self.m * q_9_dot,
            ])
        }

        /// `f_q[0] = k*cos(q[0])`
        ///
        /// `f_q[1] = k*cos(q[1])`
        ///
        /// `f_q[2] = k*cos(q[2])`
        ///
        /// `f_q[3] = k*cos(q[3])`
        ///
        /// `f_q[4] = k*cos(q[4])`
        ///
        /// `f_q[5] = k*cos(q[5])`
        ///
        /// `f_q[6] = k*cos(q[6])`
        ///
        /// `f_q[7] = k*cos(q[7])`
        ///
        /// `f_q[8] = k*cos(q[8])`
        ///
        /// `f_q[9] = 0`
        ///
        /// 18 operations.
        #[inline]
        fn force(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::SVector<T, 10> {
            let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, _]: [T; 10] = (*q).into();
            let real = T::real;
            let [(_, cos1), (_, cos2), (_, cos3), (_, cos4)] = T::sin_cos_each([
                q_0,
                q_1,
                q_2,
                q_3,
            ]);
            let [(_, cos5), (_, cos6), (_, cos7), (_, cos8)] = T::sin_cos_each([
                q_4,
                q_5,
                q_6,
                q_7,
            ]);
            ::vi_core::SVector::from([
                self.k * cos1,
                self.k * cos2,
                self.k * cos3,
                self.k * cos4,
                self.k * cos5,
                self.k * cos6,
                self.k * cos7,
                self.k * cos8,
                self.k * q_8.cos(),
                real(0.0),
            ])
        }

        /// Solves `M a = L_q + f − L_vt − L_vq v`.
        ///
        /// 106 operations.
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::core::result::Result<::vi_core::SVector<T, 10>, ::vi_core::StepError> {
            let time = t;
            let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q)
                .into();
            let real = T::real;
            let s1 = q_1 - q_0;
            let s2 = q_2 - q_1;
            let s3 = q_3 - q_2;
            let s4 = q_4 - q_3;
            let s5 = q_5 - q_4;
            let s6 = q_6 - q_5;
            let s7 = q_7 - q_6;
            let s8 = q_8 - q_7;
            let s9 = q_9 - q_8;
            let [(sin10, _), (sin11, cos11), (sin12, cos12), (sin13, cos13)] = T::sin_cos_each([
                t,
                q_0,
                q_1,
                q_2,
            ]);
            let s14 = sin10 * real(0.3333333333333333) + real(1.0);
            let [(sin15, cos15), (sin16, cos16), (sin17, cos17), (sin18, cos18)] = T::sin_cos_each([
                q_3,
                q_4,
                q_5,
                q_6,
            ]);
            let [(sin19, cos19), (sin20, cos20), (sin21, _)] = T::sin_cos_each([
                q_7,
                q_8,
                q_9,
            ]);
            let s22 = s1 * s1 * s1;
            let s23 = s2 * s2 * s2;
            let s24 = s3 * s3 * s3;
            let s25 = s4 * s4 * s4;
            let s26 = s5 * s5 * s5;
            let s27 = s6 * s6 * s6;
            let s28 = s7 * s7 * s7;
            let s29 = s8 * s8 * s8;
            let s30 = s9 * s9 * s9;
            let mass: ::vi_core::linear::Banded<10, 1, T> = ::vi_core::linear::Banded {
                rows: [
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                    [self.m],
                ],
            };
            let applied: ::vi_core::SVector<T, 10> = ::vi_core::SVector::from([
                self.k * cos11 + self.k * s22 - s14 * sin11,
                self.k * cos12 - self.k * (s22 - s23) - s14 * sin12,
                self.k * cos13 - self.k * (s23 - s24) - s14 * sin13,
                self.k * cos15 - self.k * (s24 - s25) - s14 * sin15,
                self.k * cos16 - self.k * (s25 - s26) - s14 * sin16,
                self.k * cos17 - self.k * (s26 - s27) - s14 * sin17,
                self.k * cos18 - self.k * (s27 - s28) - s14 * sin18,
                self.k * cos19 - self.k * (s28 - s29) - s14 * sin19,
                self.k * cos20 - self.k * (s29 - s30) - s14 * sin20,
                -(self.k * s30 + s14 * sin21),
            ]);
            ::vi_core::linear::acceleration(time, &mass, &applied)
        }

        /// `D = (k*cos(q[0]) + k*(q[1] - q[0])^3 - (sin(t)/3 + 1)*sin(q[0]))*dot(dot(q[0])) - dot(q[0])*(dot(q[0])*(-3*k*(q[1] - q[0])^2 - (sin(t)/3 + 1)*cos(q[0])) - sin(q[0])*cos(t)/3 + 3*k*(q[1] - q[0])^2*dot(q[1])) + dot(q[0])*sin(q[0])*cos(t)/3 + dot(dot(q[1]))*(k*cos(q[1]) - k*(4*(q[1] - q[0])^3 - 4*(q[2] - q[1])^3)/4 - (sin(t)/3 + 1)*sin(q[1])) - dot(q[1])*(3*k*(q[1] - q[0])^2*dot(q[0]) - …`
        ///
        /// 322 operations.
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let a = &self.acceleration(t, q, v)?.data.0[0];
            let v = &(*v).data.0[0];
            let q = &(*q).data.0[0];
            let real = T::real;
            let (sin1, cos1) = t.sin_cos();
            let s2 = sin1 * real(0.3333333333333333) + real(1.0);
            let s3 = self.k * real(3.0);
            let s4: [(T, T); 10] = ::core::array::from_fn(|i| q[i].sin_cos());
            let s5: [T; 9] = ::core::array::from_fn(|i| self.k * s4[i].1);
            let s6: [T; 9] = ::core::array::from_fn(|i| {
                (q[i + 1] - q[i]) * (q[i + 1] - q[i])
            });
            let s7: [T; 9] = ::core::array::from_fn(|i| s6[i] * (q[i + 1] - q[i]));
            let s8: [T; 10] = ::core::array::from_fn(|i| s2 * s4[i].0);
            let s9: [T; 9] = ::core::array::from_fn(|i| self.k * s6[i]);
            let s10: [T; 10] = ::core::array::from_fn(|i| s2 * s4[i].1);
            let s11: [T; 9] = ::core::array::from_fn(|i| s9[i] * v[i + 1] * real(3.0));
            let s12: [T; 10] = ::core::array::from_fn(|i| v[i] * s4[i].0);
            let s13: [T; 9] = ::core::array::from_fn(|i| {
                cos1 * s4[i + 1].0 * real(0.3333333333333333)
            });
            let s14: [T; 9] = ::core::array::from_fn(|i| s9[i] * v[i] * real(3.0));
            let s15: [T; 8] = ::core::array::from_fn(|i| {
                a[i + 1] * (s5[i + 1] - self.k * (s7[i] - s7[i + 1]) - s8[i + 1])
            });
            let s16: [T; 8] = ::core::array::from_fn(|i| {
                v[i + 1]
                    * (s14[i] - v[i + 1] * (s3 * (s6[i] + s6[i + 1]) + s10[i + 1])
                        + s11[i + 1] - s13[i])
            });
            let s17 = (0..8)
                .fold((s5[0] + self.k * s7[0] - s8[0]) * a[0], |sum, i| sum + s15[i])
                - a[9] * (self.k * s7[8] + s8[9])
                + sin1 * (1..10).fold(s4[0].1, |sum, i| sum + s4[i].1)
                    * real(0.3333333333333333)
                - v[0]
                    * (s11[0] - v[0] * (s9[0] * real(3.0) + s10[0])
                        - s4[0].0 * cos1 * real(0.3333333333333333));
            ::core::result::Result::Ok(
                (0..8).fold(s17, |sum, i| sum - s16[i])
                    - v[9] * (s14[8] - v[9] * (s9[8] * real(3.0) + s10[9]) - s13[8])
                    + (1..10).fold(s12[0], |sum, i| sum + s12[i]) * cos1
                        * real(0.3333333333333333),
            )
        }

        /// The first of what L and f are made of that is not finite here.
        ///
        /// 92 operations.
        #[cold]
        fn non_finite(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::core::option::Option<&'static str> {
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q)
                .into();
            let real = T::real;
            let s1 = q_1 - q_0;
            let s2 = s1 * s1;
            let s3 = q_2 - q_1;
            let s4 = s3 * s3;
            let s5 = q_3 - q_2;
            let s6 = s5 * s5;
            let s7 = q_4 - q_3;
            let s8 = s7 * s7;
            let s9 = q_5 - q_4;
            let s10 = s9 * s9;
            let s11 = q_6 - q_5;
            let s12 = s11 * s11;
            let s13 = q_7 - q_6;
            let s14 = s13 * s13;
            let s15 = q_8 - q_7;
            let s16 = s15 * s15;
            let s17 = q_9 - q_8;
            let s18 = s17 * s17;
            let s19 = s2 * s2 + s4 * s4 + s6 * s6 + s8 * s8 + s10 * s10 + s12 * s12;
            let s20 = q_0_dot * q_0_dot + q_1_dot * q_1_dot + q_2_dot * q_2_dot
                + q_3_dot * q_3_dot + q_4_dot * q_4_dot + q_5_dot * q_5_dot;
            let [(sin21, _), (_, cos22), (_, cos23), (_, cos24)] = T::sin_cos_each([
                t,
                q_0,
                q_1,
                q_2,
            ]);
            let [(_, cos25), (_, cos26), (_, cos27), (_, cos28)] = T::sin_cos_each([
                q_3,
                q_4,
                q_5,
                q_6,
            ]);
            let [(_, cos29), (_, cos30), (_, cos31)] = T::sin_cos_each([q_7, q_8, q_9]);
            let s32 = (sin21 * real(0.3333333333333333) + real(1.0))
                * (cos22 + cos23 + cos24 + cos25 + cos26 + cos27 + cos28 + cos29 + cos30
                    + cos31);
            let s33 = self.m
                * (s20 + q_6_dot * q_6_dot + q_7_dot * q_7_dot + q_8_dot * q_8_dot
                    + q_9_dot * q_9_dot) * real(0.5) + s32;
            let values = [
                ("m", self.m),
                ("k", self.k),
                ("q[1]", q_1),
                ("q[0]", q_0),
                ("q[2]", q_2),
                ("q[3]", q_3),
                ("q[4]", q_4),
                ("q[5]", q_5),
                ("q[6]", q_6),
                ("q[7]", q_7),
                ("q[8]", q_8),
                ("q[9]", q_9),
                ("dot(q[0])", q_0_dot),
                ("dot(q[1])", q_1_dot),
                ("dot(q[2])", q_2_dot),
                ("dot(q[3])", q_3_dot),
                ("dot(q[4])", q_4_dot),
                ("dot(q[5])", q_5_dot),
                ("dot(q[6])", q_6_dot),
                ("dot(q[7])", q_7_dot),
                ("dot(q[8])", q_8_dot),
                ("dot(q[9])", q_9_dot),
                ("t", t),
                ("sin(t)", sin21),
                ("cos(q[0])", cos22),
                ("cos(q[1])", cos23),
                ("cos(q[2])", cos24),
                ("cos(q[3])", cos25),
                ("cos(q[4])", cos26),
                ("cos(q[5])", cos27),
                ("cos(q[6])", cos28),
                ("cos(q[7])", cos29),
                ("cos(q[8])", cos30),
                ("cos(q[9])", cos31),
                (
                    "m*(dot(q[0])^2 + dot(q[1])^2 + dot(q[2])^2 + dot(q[3])^2 + dot(q[4])^2 + dot(q[5])^2 + dot(q[6])^2 + dot(q[7])^2 + dot(q[8])^2 + dot(q[9])^2)/2 - k*((q[1] - q[0])^4 + (q[2] - q[1])^4 + (q[3] - q[2])^4 + (q[4] - q[3])^4 + (q[5] - q[4])^4 + (q[6] - q[5])^4 + (q[7] - q[6])^4 + (q[8] - q[7])^4 + (q[9] - q[8])^4)/4 + (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1]) + cos(q[2]) + cos(q[3]) + cos(q[4]) + cos(q[5]) …",
                    s33 - self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25),
                ),
                ("k*cos(q[0])", self.k * cos22),
                ("k*cos(q[1])", self.k * cos23),
                ("k*cos(q[2])", self.k * cos24),
                ("k*cos(q[3])", self.k * cos25),
                ("k*cos(q[4])", self.k * cos26),
                ("k*cos(q[5])", self.k * cos27),
                ("k*cos(q[6])", self.k * cos28),
                ("k*cos(q[7])", self.k * cos29),
                ("k*cos(q[8])", self.k * cos30),
            ];
            values
                .into_iter()
                .find(|(_, value)| !value.is_finite())
                .map(|(text, _)| text)
        }
    }

    impl<T: ::vi_core::Real> ::vi_core::DiscreteLagrangian<10, T> for Chain<T> {
        /// `ld = h*L`
        ///
        /// 106 operations.
        #[inline]
        fn ld(&self, interval: &::vi_core::Interval<10, T>) -> T {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, q_9_1,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let q_9_dot = (q_9_1 - q_9_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let q_9_mid = (q_9_0 + q_9_1) * real(0.5);
            let s1 = q_1_mid - q_0_mid;
            let s2 = s1 * s1;
            let s3 = q_2_mid - q_1_mid;
            let s4 = s3 * s3;
            let s5 = q_3_mid - q_2_mid;
            let s6 = s5 * s5;
            let s7 = q_4_mid - q_3_mid;
            let s8 = s7 * s7;
            let s9 = q_5_mid - q_4_mid;
            let s10 = s9 * s9;
            let s11 = q_6_mid - q_5_mid;
            let s12 = s11 * s11;
            let s13 = q_7_mid - q_6_mid;
            let s14 = s13 * s13;
            let s15 = q_8_mid - q_7_mid;
            let s16 = s15 * s15;
            let s17 = q_9_mid - q_8_mid;
            let s18 = s17 * s17;
            let s19 = s2 * s2 + s4 * s4 + s6 * s6 + s8 * s8 + s10 * s10 + s12 * s12;
            let s20 = q_0_dot * q_0_dot + q_1_dot * q_1_dot + q_2_dot * q_2_dot
                + q_3_dot * q_3_dot + q_4_dot * q_4_dot + q_5_dot * q_5_dot;
            let [(sin21, _), (_, cos22), (_, cos23), (_, cos24)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let [(_, cos25), (_, cos26), (_, cos27), (_, cos28)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(_, cos29), (_, cos30), (_, cos31)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s32 = (sin21 * real(0.3333333333333333) + real(1.0))
                * (cos22 + cos23 + cos24 + cos25 + cos26 + cos27 + cos28 + cos29 + cos30
                    + cos31);
            let s33 = self.m
                * (s20 + q_6_dot * q_6_dot + q_7_dot * q_7_dot + q_8_dot * q_8_dot
                    + q_9_dot * q_9_dot) * real(0.5) + s32;
            h * (s33 - self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25))
        }

        /// `d1_ld = h*L_t/2 - L + L_v_q[0]*v_q[0] + L_v_q[1]*v_q[1] + L_v_q[2]*v_q[2] + L_v_q[3]*v_q[3] + L_v_q[4]*v_q[4] + L_v_q[5]*v_q[5] + L_v_q[6]*v_q[6] + L_v_q[7]*v_q[7] + L_v_q[8]*v_q[8] + L_v_q[9]*v_q[9]`
        ///
        /// 130 operations.
        #[inline]
        fn d1_ld(&self, interval: &::vi_core::Interval<10, T>) -> T {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, q_9_1,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let q_9_dot = (q_9_1 - q_9_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let q_9_mid = (q_9_0 + q_9_1) * real(0.5);
            let s1 = q_1_mid - q_0_mid;
            let s2 = s1 * s1;
            let s3 = q_2_mid - q_1_mid;
            let s4 = s3 * s3;
            let s5 = q_3_mid - q_2_mid;
            let s6 = s5 * s5;
            let s7 = q_4_mid - q_3_mid;
            let s8 = s7 * s7;
            let s9 = q_5_mid - q_4_mid;
            let s10 = s9 * s9;
            let s11 = q_6_mid - q_5_mid;
            let s12 = s11 * s11;
            let s13 = q_7_mid - q_6_mid;
            let s14 = s13 * s13;
            let s15 = q_8_mid - q_7_mid;
            let s16 = s15 * s15;
            let s17 = q_9_mid - q_8_mid;
            let s18 = s17 * s17;
            let s19 = s2 * s2 + s4 * s4 + s6 * s6 + s8 * s8 + s10 * s10 + s12 * s12;
            let s20 = q_0_dot * q_0_dot;
            let s21 = q_1_dot * q_1_dot;
            let s22 = q_2_dot * q_2_dot;
            let s23 = q_3_dot * q_3_dot;
            let s24 = q_4_dot * q_4_dot;
            let s25 = q_5_dot * q_5_dot;
            let s26 = q_6_dot * q_6_dot;
            let s27 = q_7_dot * q_7_dot;
            let s28 = q_8_dot * q_8_dot;
            let s29 = q_9_dot * q_9_dot;
            let [(sin30, cos30), (_, cos31), (_, cos32), (_, cos33)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let [(_, cos34), (_, cos35), (_, cos36), (_, cos37)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(_, cos38), (_, cos39), (_, cos40)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s41 = cos31 + cos32 + cos33 + cos34 + cos35 + cos36 + cos37 + cos38
                + cos39 + cos40;
            let s42 = self.m
                * (s20 + s21 + s22 + s23 + s24 + s25 + s26 + s27 + s28 + s29)
                * real(0.5);
            let s43 = self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25)
                + self.m * s20 + self.m * s21;
            let s44 = s43 + self.m * s22 + self.m * s23 + self.m * s24 + self.m * s25
                + self.m * s26 + self.m * s27;
            s44 + self.m * s28 + self.m * s29 - s42
                - (sin30 * real(0.3333333333333333) + real(1.0)) * s41
                + h * real(0.16666666666666666) * s41 * cos30
        }

        /// `d2_ld_q[0] = h*L_q[0]/2 - L_v_q[0]`
        ///
        /// `d2_ld_q[1] = h*L_q[1]/2 - L_v_q[1]`
        ///
        /// `d2_ld_q[2] = h*L_q[2]/2 - L_v_q[2]`
        ///
        /// `d2_ld_q[3] = h*L_q[3]/2 - L_v_q[3]`
        ///
        /// `d2_ld_q[4] = h*L_q[4]/2 - L_v_q[4]`
        ///
        /// `d2_ld_q[5] = h*L_q[5]/2 - L_v_q[5]`
        ///
        /// `d2_ld_q[6] = h*L_q[6]/2 - L_v_q[6]`
        ///
        /// `d2_ld_q[7] = h*L_q[7]/2 - L_v_q[7]`
        ///
        /// `d2_ld_q[8] = h*L_q[8]/2 - L_v_q[8]`
        ///
        /// `d2_ld_q[9] = h*L_q[9]/2 - L_v_q[9]`
        ///
        /// 140 operations.
        #[inline]
        fn d2_ld(
            &self,
            interval: &::vi_core::Interval<10, T>,
        ) -> ::vi_core::SVector<T, 10> {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, q_9_1,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let q_9_dot = (q_9_1 - q_9_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let q_9_mid = (q_9_0 + q_9_1) * real(0.5);
            let s1 = q_1_mid - q_0_mid;
            let s2 = q_2_mid - q_1_mid;
            let s3 = q_3_mid - q_2_mid;
            let s4 = q_4_mid - q_3_mid;
            let s5 = q_5_mid - q_4_mid;
            let s6 = q_6_mid - q_5_mid;
            let s7 = q_7_mid - q_6_mid;
            let s8 = q_8_mid - q_7_mid;
            let s9 = q_9_mid - q_8_mid;
            let [(sin10, _), (sin11, _), (sin12, _), (sin13, _)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let s14 = sin10 * real(0.3333333333333333) + real(1.0);
            let s15 = s1 * s1 * s1;
            let s16 = h * real(0.5);
            let s17 = s2 * s2 * s2;
            let s18 = s3 * s3 * s3;
            let s19 = s4 * s4 * s4;
            let [(sin20, _), (sin21, _), (sin22, _), (sin23, _)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let s24 = s5 * s5 * s5;
            let s25 = s6 * s6 * s6;
            let s26 = s7 * s7 * s7;
            let s27 = s8 * s8 * s8;
            let [(sin28, _), (sin29, _), (sin30, _)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s31 = s9 * s9 * s9;
            ::vi_core::SVector::from([
                s16 * (self.k * s15 - s14 * sin11) - self.m * q_0_dot,
                -(self.m * q_1_dot) - s16 * (self.k * (s15 - s17) + s14 * sin12),
                -(self.m * q_2_dot) - s16 * (self.k * (s17 - s18) + s14 * sin13),
                -(self.m * q_3_dot) - s16 * (self.k * (s18 - s19) + s14 * sin20),
                -(self.m * q_4_dot) - s16 * (self.k * (s19 - s24) + s14 * sin21),
                -(self.m * q_5_dot) - s16 * (self.k * (s24 - s25) + s14 * sin22),
                -(self.m * q_6_dot) - s16 * (self.k * (s25 - s26) + s14 * sin23),
                -(self.m * q_7_dot) - s16 * (self.k * (s26 - s27) + s14 * sin28),
                -(self.m * q_8_dot) - s16 * (self.k * (s27 - s31) + s14 * sin29),
                -(self.m * q_9_dot) - s16 * (self.k * s31 + s14 * sin30),
            ])
        }

        /// `d3_ld = L + h*L_t/2 - L_v_q[0]*v_q[0] - L_v_q[1]*v_q[1] - L_v_q[2]*v_q[2] - L_v_q[3]*v_q[3] - L_v_q[4]*v_q[4] - L_v_q[5]*v_q[5] - L_v_q[6]*v_q[6] - L_v_q[7]*v_q[7] - L_v_q[8]*v_q[8] - L_v_q[9]*v_q[9]`
        ///
        /// 130 operations.
        #[inline]
        fn d3_ld(&self, interval: &::vi_core::Interval<10, T>) -> T {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, q_9_1,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let q_9_dot = (q_9_1 - q_9_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let q_9_mid = (q_9_0 + q_9_1) * real(0.5);
            let s1 = q_1_mid - q_0_mid;
            let s2 = s1 * s1;
            let s3 = q_2_mid - q_1_mid;
            let s4 = s3 * s3;
            let s5 = q_3_mid - q_2_mid;
            let s6 = s5 * s5;
            let s7 = q_4_mid - q_3_mid;
            let s8 = s7 * s7;
            let s9 = q_5_mid - q_4_mid;
            let s10 = s9 * s9;
            let s11 = q_6_mid - q_5_mid;
            let s12 = s11 * s11;
            let s13 = q_7_mid - q_6_mid;
            let s14 = s13 * s13;
            let s15 = q_8_mid - q_7_mid;
            let s16 = s15 * s15;
            let s17 = q_9_mid - q_8_mid;
            let s18 = s17 * s17;
            let s19 = s2 * s2 + s4 * s4 + s6 * s6 + s8 * s8 + s10 * s10 + s12 * s12;
            let s20 = q_0_dot * q_0_dot;
            let s21 = q_1_dot * q_1_dot;
            let s22 = q_2_dot * q_2_dot;
            let s23 = q_3_dot * q_3_dot;
            let s24 = q_4_dot * q_4_dot;
            let s25 = q_5_dot * q_5_dot;
            let s26 = q_6_dot * q_6_dot;
            let s27 = q_7_dot * q_7_dot;
            let s28 = q_8_dot * q_8_dot;
            let s29 = q_9_dot * q_9_dot;
            let [(sin30, cos30), (_, cos31), (_, cos32), (_, cos33)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let [(_, cos34), (_, cos35), (_, cos36), (_, cos37)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(_, cos38), (_, cos39), (_, cos40)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s41 = cos31 + cos32 + cos33 + cos34 + cos35 + cos36 + cos37 + cos38
                + cos39 + cos40;
            let s42 = self.m
                * (s20 + s21 + s22 + s23 + s24 + s25 + s26 + s27 + s28 + s29)
                * real(0.5);
            let s43 = s42 + (sin30 * real(0.3333333333333333) + real(1.0)) * s41
                - self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25);
            let s44 = s43 - self.m * s20 - self.m * s21 - self.m * s22 - self.m * s23
                - self.m * s24 - self.m * s25;
            s44 - self.m * s26 - self.m * s27 - self.m * s28 - self.m * s29
                + h * real(0.16666666666666666) * s41 * cos30
        }

        /// `d4_ld_q[0] = L_v_q[0] + h*L_q[0]/2`
        ///
        /// `d4_ld_q[1] = L_v_q[1] + h*L_q[1]/2`
        ///
        /// `d4_ld_q[2] = L_v_q[2] + h*L_q[2]/2`
        ///
        /// `d4_ld_q[3] = L_v_q[3] + h*L_q[3]/2`
        ///
        /// `d4_ld_q[4] = L_v_q[4] + h*L_q[4]/2`
        ///
        /// `d4_ld_q[5] = L_v_q[5] + h*L_q[5]/2`
        ///
        /// `d4_ld_q[6] = L_v_q[6] + h*L_q[6]/2`
        ///
        /// `d4_ld_q[7] = L_v_q[7] + h*L_q[7]/2`
        ///
        /// `d4_ld_q[8] = L_v_q[8] + h*L_q[8]/2`
        ///
        /// `d4_ld_q[9] = L_v_q[9] + h*L_q[9]/2`
        ///
        /// 131 operations.
        #[inline]
        fn d4_ld(
            &self,
            interval: &::vi_core::Interval<10, T>,
        ) -> ::vi_core::SVector<T, 10> {
            let t0 = interval.t0;
            let t1 = interval.t1;
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, q_9_1,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let q_9_dot = (q_9_1 - q_9_0) / h;
            let real = T::real;
            let t_mid = (t0 + t1) * real(0.5);
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let q_9_mid = (q_9_0 + q_9_1) * real(0.5);
            let s1 = q_1_mid - q_0_mid;
            let s2 = q_2_mid - q_1_mid;
            let s3 = q_3_mid - q_2_mid;
            let s4 = q_4_mid - q_3_mid;
            let s5 = q_5_mid - q_4_mid;
            let s6 = q_6_mid - q_5_mid;
            let s7 = q_7_mid - q_6_mid;
            let s8 = q_8_mid - q_7_mid;
            let s9 = q_9_mid - q_8_mid;
            let [(sin10, _), (sin11, _), (sin12, _), (sin13, _)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let s14 = sin10 * real(0.3333333333333333) + real(1.0);
            let s15 = s1 * s1 * s1;
            let s16 = s2 * s2 * s2;
            let s17 = s3 * s3 * s3;
            let s18 = s4 * s4 * s4;
            let [(sin19, _), (sin20, _), (sin21, _), (sin22, _)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let s23 = s5 * s5 * s5;
            let s24 = s6 * s6 * s6;
            let s25 = s7 * s7 * s7;
            let s26 = s8 * s8 * s8;
            let [(sin27, _), (sin28, _), (sin29, _)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s30 = s9 * s9 * s9;
            let s31 = h * real(0.5);
            ::vi_core::SVector::from([
                self.m * q_0_dot + s31 * (self.k * s15 - s14 * sin11),
                self.m * q_1_dot - s31 * (self.k * (s15 - s16) + s14 * sin12),
                self.m * q_2_dot - s31 * (self.k * (s16 - s17) + s14 * sin13),
                self.m * q_3_dot - s31 * (self.k * (s17 - s18) + s14 * sin19),
                self.m * q_4_dot - s31 * (self.k * (s18 - s23) + s14 * sin20),
                self.m * q_5_dot - s31 * (self.k * (s23 - s24) + s14 * sin21),
                self.m * q_6_dot - s31 * (self.k * (s24 - s25) + s14 * sin22),
                self.m * q_7_dot - s31 * (self.k * (s25 - s26) + s14 * sin27),
                self.m * q_8_dot - s31 * (self.k * (s26 - s30) + s14 * sin28),
                self.m * q_9_dot - s31 * (self.k * s30 + s14 * sin29),
            ])
        }

        /// `fd_minus_q[0] = h*f_q[0]/2`
        ///
        /// `fd_minus_q[1] = h*f_q[1]/2`
        ///
        /// `fd_minus_q[2] = h*f_q[2]/2`
        ///
        /// `fd_minus_q[3] = h*f_q[3]/2`
        ///
        /// `fd_minus_q[4] = h*f_q[4]/2`
        ///
        /// `fd_minus_q[5] = h*f_q[5]/2`
        ///
        /// `fd_minus_q[6] = h*f_q[6]/2`
        ///
        /// `fd_minus_q[7] = h*f_q[7]/2`
        ///
        /// `fd_minus_q[8] = h*f_q[8]/2`
        ///
        /// `fd_minus_q[9] = 0`
        ///
        /// 38 operations.
        #[inline]
        fn fd_minus(
            &self,
            interval: &::vi_core::Interval<10, T>,
        ) -> ::vi_core::SVector<T, 10> {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, _,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, _,
            ]: [T; 10] = interval.q1.into();
            let real = T::real;
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let [(_, cos1), (_, cos2), (_, cos3), (_, cos4)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                q_2_mid,
                q_3_mid,
            ]);
            let [(_, cos5), (_, cos6), (_, cos7), (_, cos8)] = T::sin_cos_each([
                q_4_mid,
                q_5_mid,
                q_6_mid,
                q_7_mid,
            ]);
            let s9 = self.k * h * real(0.5);
            ::vi_core::SVector::from([
                s9 * cos1,
                s9 * cos2,
                s9 * cos3,
                s9 * cos4,
                s9 * cos5,
                s9 * cos6,
                s9 * cos7,
                s9 * cos8,
                s9 * q_8_mid.cos(),
                real(0.0),
            ])
        }

        /// `fd_plus_q[0] = h*f_q[0]/2`
        ///
        /// `fd_plus_q[1] = h*f_q[1]/2`
        ///
        /// `fd_plus_q[2] = h*f_q[2]/2`
        ///
        /// `fd_plus_q[3] = h*f_q[3]/2`
        ///
        /// `fd_plus_q[4] = h*f_q[4]/2`
        ///
        /// `fd_plus_q[5] = h*f_q[5]/2`
        ///
        /// `fd_plus_q[6] = h*f_q[6]/2`
        ///
        /// `fd_plus_q[7] = h*f_q[7]/2`
        ///
        /// `fd_plus_q[8] = h*f_q[8]/2`
        ///
        /// `fd_plus_q[9] = 0`
        ///
        /// 38 operations.
        #[inline]
        fn fd_plus(
            &self,
            interval: &::vi_core::Interval<10, T>,
        ) -> ::vi_core::SVector<T, 10> {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, _,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, _,
            ]: [T; 10] = interval.q1.into();
            let real = T::real;
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let [(_, cos1), (_, cos2), (_, cos3), (_, cos4)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                q_2_mid,
                q_3_mid,
            ]);
            let [(_, cos5), (_, cos6), (_, cos7), (_, cos8)] = T::sin_cos_each([
                q_4_mid,
                q_5_mid,
                q_6_mid,
                q_7_mid,
            ]);
            let s9 = self.k * h * real(0.5);
            ::vi_core::SVector::from([
                s9 * cos1,
                s9 * cos2,
                s9 * cos3,
                s9 * cos4,
                s9 * cos5,
                s9 * cos6,
                s9 * cos7,
                s9 * cos8,
                s9 * q_8_mid.cos(),
                real(0.0),
            ])
        }

        /// `gd_minus = -h*f_q[0]*v_q[0]/2 - h*f_q[1]*v_q[1]/2 - h*f_q[2]*v_q[2]/2 - h*f_q[3]*v_q[3]/2 - h*f_q[4]*v_q[4]/2 - h*f_q[5]*v_q[5]/2 - h*f_q[6]*v_q[6]/2 - h*f_q[7]*v_q[7]/2 - h*f_q[8]*v_q[8]/2`
        ///
        /// 48 operations.
        #[inline]
        fn gd_minus(&self, interval: &::vi_core::Interval<10, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, _,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, _,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let real = T::real;
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let [(_, cos1), (_, cos2), (_, cos3), (_, cos4)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                q_2_mid,
                q_3_mid,
            ]);
            let [(_, cos5), (_, cos6), (_, cos7), (_, cos8)] = T::sin_cos_each([
                q_4_mid,
                q_5_mid,
                q_6_mid,
                q_7_mid,
            ]);
            let s9 = q_0_dot * cos1 + q_1_dot * cos2 + q_2_dot * cos3 + q_3_dot * cos4
                + q_4_dot * cos5 + q_5_dot * cos6;
            -(self.k * real(0.5) * h
                * (s9 + q_6_dot * cos7 + q_7_dot * cos8 + q_8_dot * q_8_mid.cos()))
        }

        /// `gd_plus = -h*f_q[0]*v_q[0]/2 - h*f_q[1]*v_q[1]/2 - h*f_q[2]*v_q[2]/2 - h*f_q[3]*v_q[3]/2 - h*f_q[4]*v_q[4]/2 - h*f_q[5]*v_q[5]/2 - h*f_q[6]*v_q[6]/2 - h*f_q[7]*v_q[7]/2 - h*f_q[8]*v_q[8]/2`
        ///
        /// 48 operations.
        #[inline]
        fn gd_plus(&self, interval: &::vi_core::Interval<10, T>) -> T {
            let h = interval.t1 - interval.t0;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, _,
            ]: [T; 10] = interval.q0.into();
            let [q_0_1, q_1_1, q_2_1, q_3_1, q_4_1, q_5_1, q_6_1, q_7_1, q_8_1, _,
            ]: [T; 10] = interval.q1.into();
            let q_0_dot = (q_0_1 - q_0_0) / h;
            let q_1_dot = (q_1_1 - q_1_0) / h;
            let q_2_dot = (q_2_1 - q_2_0) / h;
            let q_3_dot = (q_3_1 - q_3_0) / h;
            let q_4_dot = (q_4_1 - q_4_0) / h;
            let q_5_dot = (q_5_1 - q_5_0) / h;
            let q_6_dot = (q_6_1 - q_6_0) / h;
            let q_7_dot = (q_7_1 - q_7_0) / h;
            let q_8_dot = (q_8_1 - q_8_0) / h;
            let real = T::real;
            let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
            let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
            let q_2_mid = (q_2_0 + q_2_1) * real(0.5);
            let q_3_mid = (q_3_0 + q_3_1) * real(0.5);
            let q_4_mid = (q_4_0 + q_4_1) * real(0.5);
            let q_5_mid = (q_5_0 + q_5_1) * real(0.5);
            let q_6_mid = (q_6_0 + q_6_1) * real(0.5);
            let q_7_mid = (q_7_0 + q_7_1) * real(0.5);
            let q_8_mid = (q_8_0 + q_8_1) * real(0.5);
            let [(_, cos1), (_, cos2), (_, cos3), (_, cos4)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                q_2_mid,
                q_3_mid,
            ]);
            let [(_, cos5), (_, cos6), (_, cos7), (_, cos8)] = T::sin_cos_each([
                q_4_mid,
                q_5_mid,
                q_6_mid,
                q_7_mid,
            ]);
            let s9 = q_0_dot * cos1 + q_1_dot * cos2 + q_2_dot * cos3 + q_3_dot * cos4
                + q_4_dot * cos5 + q_5_dot * cos6;
            -(self.k * real(0.5) * h
                * (s9 + q_6_dot * cos7 + q_7_dot * cos8 + q_8_dot * q_8_mid.cos()))
        }
    }

    #[allow(
        clippy::all,
        clippy::pedantic,
        non_snake_case,
        unused_variables,
        unused_parens
    )]
    impl<T: ::vi_core::Real> ::vi_core::Stepping<10, T> for Chain<T> {
        type Jacobian = ::vi_core::linear::Tridiagonal<10, T>;
        const CONSTANT_JACOBIAN: bool = false;
        const SMOOTH: bool = true;
        const PLACE: ::core::option::Option<f64> = ::core::option::Option::Some(0.5f64);

        /// `residual_q[0] = L_v_q[0] - h*f_q[0]/2 - h*L_q[0]/2 - p0_q[0]_low - p0_q[0]`
        ///
        /// `residual_q[1] = L_v_q[1] - h*f_q[1]/2 - h*L_q[1]/2 - p0_q[1]_low - p0_q[1]`
        ///
        /// `residual_q[2] = L_v_q[2] - h*f_q[2]/2 - h*L_q[2]/2 - p0_q[2]_low - p0_q[2]`
        ///
        /// `residual_q[3] = L_v_q[3] - h*f_q[3]/2 - h*L_q[3]/2 - p0_q[3]_low - p0_q[3]`
        ///
        /// `residual_q[4] = L_v_q[4] - h*f_q[4]/2 - h*L_q[4]/2 - p0_q[4]_low - p0_q[4]`
        ///
        /// `residual_q[5] = L_v_q[5] - h*f_q[5]/2 - h*L_q[5]/2 - p0_q[5]_low - p0_q[5]`
        ///
        /// `residual_q[6] = L_v_q[6] - h*f_q[6]/2 - h*L_q[6]/2 - p0_q[6]_low - p0_q[6]`
        ///
        /// `residual_q[7] = L_v_q[7] - h*f_q[7]/2 - h*L_q[7]/2 - p0_q[7]_low - p0_q[7]`
        ///
        /// `residual_q[8] = L_v_q[8] - h*f_q[8]/2 - h*L_q[8]/2 - p0_q[8]_low - p0_q[8]`
        ///
        /// `residual_q[9] = L_v_q[9] - h*L_q[9]/2 - p0_q[9]_low - p0_q[9]`
        ///
        /// 294 operations.
        #[inline]
        fn momentum_equation(
            &self,
            node: &::vi_core::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::MomentumEquation<10, T, Self::Jacobian> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = node.q.into();
            let [q_0_0_low, q_1_0_low, q_2_0_low, q_3_0_low, q_4_0_low, q_5_0_low,
            q_6_0_low, q_7_0_low, q_8_0_low, q_9_0_low]: [T; 10] = node.q_low.into();
            let [p0_q_0, p0_q_1, p0_q_2, p0_q_3, p0_q_4, p0_q_5, p0_q_6, p0_q_7, p0_q_8,
            p0_q_9]: [T; 10] = node.p.into();
            let [p0_q_0_low, p0_q_1_low, p0_q_2_low, p0_q_3_low, p0_q_4_low, p0_q_5_low,
            p0_q_6_low, p0_q_7_low, p0_q_8_low, p0_q_9_low]: [T; 10] = node.p_low.into();
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
            let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
            let q_2_mid = q_2_0 + (s1 * q_2_dot + q_2_0_low);
            let q_3_mid = q_3_0 + (s1 * q_3_dot + q_3_0_low);
            let q_4_mid = q_4_0 + (s1 * q_4_dot + q_4_0_low);
            let q_5_mid = q_5_0 + (s1 * q_5_dot + q_5_0_low);
            let q_6_mid = q_6_0 + (s1 * q_6_dot + q_6_0_low);
            let q_7_mid = q_7_0 + (s1 * q_7_dot + q_7_0_low);
            let q_8_mid = q_8_0 + (s1 * q_8_dot + q_8_0_low);
            let q_9_mid = q_9_0 + (s1 * q_9_dot + q_9_0_low);
            let s2 = q_1_mid - q_0_mid;
            let s3 = q_2_mid - q_1_mid;
            let s4 = q_3_mid - q_2_mid;
            let s5 = q_4_mid - q_3_mid;
            let s6 = q_5_mid - q_4_mid;
            let s7 = q_6_mid - q_5_mid;
            let s8 = q_7_mid - q_6_mid;
            let s9 = q_8_mid - q_7_mid;
            let s10 = q_9_mid - q_8_mid;
            let [(sin11, _), (sin12, cos12), (sin13, cos13), (sin14, cos14)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let s15 = sin11 * real(0.3333333333333333) + real(1.0);
            let [(sin16, cos16), (sin17, cos17), (sin18, cos18), (sin19, cos19)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(sin20, cos20), (sin21, cos21), (sin22, cos22)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s23 = s2 * s2;
            let s24 = s23 * s2;
            let s25 = s3 * s3;
            let s26 = s25 * s3;
            let s27 = s4 * s4;
            let s28 = s27 * s4;
            let s29 = s5 * s5;
            let s30 = s29 * s5;
            let s31 = s6 * s6;
            let s32 = s31 * s6;
            let s33 = s7 * s7;
            let s34 = s33 * s7;
            let s35 = s8 * s8;
            let s36 = s35 * s8;
            let s37 = s9 * s9;
            let s38 = s37 * s9;
            let s39 = s10 * s10;
            let s40 = s39 * s10;
            let s41 = self.k * h * real(0.5);
            let s42 = self.k * s23;
            let s43 = self.k * real(3.0);
            let s44 = self.k * s39;
            let s45 = h * h;
            let s46 = self.k * s45;
            let s47 = s46 * real(0.25);
            let s48 = s45 * real(0.25);
            let s49 = s45 * real(0.75);
            let s50 = -(s42 * s49);
            let s51 = s46 * real(0.75);
            let s52 = -(s51 * s25);
            let s53 = -(s51 * s27);
            let s54 = -(s51 * s29);
            let s55 = -(s51 * s31);
            let s56 = -(s51 * s33);
            let s57 = -(s51 * s35);
            let s58 = -(s51 * s37);
            let s59 = -(s44 * s49);
            ::vi_core::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    self.m * q_0_dot - p0_q_0
                        - (p0_q_0_low + s1 * (self.k * s24 - s15 * sin12) + s41 * cos12),
                    self.m * q_1_dot - p0_q_1
                        - (p0_q_1_low - s1 * (self.k * (s24 - s26) + s15 * sin13)
                            + s41 * cos13),
                    self.m * q_2_dot - p0_q_2
                        - (p0_q_2_low - s1 * (self.k * (s26 - s28) + s15 * sin14)
                            + s41 * cos14),
                    self.m * q_3_dot - p0_q_3
                        - (p0_q_3_low - s1 * (self.k * (s28 - s30) + s15 * sin16)
                            + s41 * cos16),
                    self.m * q_4_dot - p0_q_4
                        - (p0_q_4_low - s1 * (self.k * (s30 - s32) + s15 * sin17)
                            + s41 * cos17),
                    self.m * q_5_dot - p0_q_5
                        - (p0_q_5_low - s1 * (self.k * (s32 - s34) + s15 * sin18)
                            + s41 * cos18),
                    self.m * q_6_dot - p0_q_6
                        - (p0_q_6_low - s1 * (self.k * (s34 - s36) + s15 * sin19)
                            + s41 * cos19),
                    self.m * q_7_dot - p0_q_7
                        - (p0_q_7_low - s1 * (self.k * (s36 - s38) + s15 * sin20)
                            + s41 * cos20),
                    self.m * q_8_dot - p0_q_8
                        - (p0_q_8_low - s1 * (self.k * (s38 - s40) + s15 * sin21)
                            + s41 * cos21),
                    self.m * q_9_dot - p0_q_9
                        - (p0_q_9_low - s1 * (self.k * s40 + s15 * sin22)),
                ]),
                jacobian: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s50, s52, s53, s54, s55, s56, s57, s58, s59],
                    diagonal: [
                        self.m + (s47 * sin12 + s48 * (s42 * real(3.0) + s15 * cos12)),
                        self.m + (s47 * sin13 + s48 * (s43 * (s23 + s25) + s15 * cos13)),
                        self.m + (s47 * sin14 + s48 * (s43 * (s25 + s27) + s15 * cos14)),
                        self.m + (s47 * sin16 + s48 * (s43 * (s27 + s29) + s15 * cos16)),
                        self.m + (s47 * sin17 + s48 * (s43 * (s29 + s31) + s15 * cos17)),
                        self.m + (s47 * sin18 + s48 * (s43 * (s31 + s33) + s15 * cos18)),
                        self.m + (s47 * sin19 + s48 * (s43 * (s33 + s35) + s15 * cos19)),
                        self.m + (s47 * sin20 + s48 * (s43 * (s35 + s37) + s15 * cos20)),
                        self.m + (s47 * sin21 + s48 * (s43 * (s37 + s39) + s15 * cos21)),
                        self.m + s48 * (s44 * real(3.0) + s15 * cos22),
                    ],
                    upper: [s50, s52, s53, s54, s55, s56, s57, s58, s59, T::real(0.0)],
                },
            }
        }

        /// `energy_residual = h*L_t/2 - L - E0_low - E0 + h*v_q[0]*L_q[0]/2 + v_q[0]*p0_q[0]_low + v_q[0]*p0_q[0] + h*v_q[1]*L_q[1]/2 + v_q[1]*p0_q[1]_low + v_q[1]*p0_q[1] + h*v_q[2]*L_q[2]/2 + v_q[2]*p0_q[2]_low + v_q[2]*p0_q[2] + h*v_q[3]*L_q[3]/2 + v_q[3]*p0_q[3]_low + v_q[3]*p0_q[3] + h*v_q[4]*L_q[4]/2 + v_q[4]*p0_q[4]_low + v_q[4]*p0_q[4] + h*v_q[5]*L_q[5]/2 + v_q[5]*p0_q[5]_low + v_q[5]*p0_q[5] + h*v_q[6]*L_q[6]/2 + …`
        ///
        /// 732 operations.
        #[inline(never)]
        fn extended_system(
            &self,
            node: &::vi_core::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::ExtendedSystem<10, T, Self::Jacobian> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let q0 = &node.q.data.0[0];
            let q0_low = &node.q_low.data.0[0];
            let p0 = &node.p.data.0[0];
            let p0_low = &node.p_low.data.0[0];
            let v = &(*v).data.0[0];
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let (sin2, cos2) = t_mid.sin_cos();
            let s3 = sin2 * real(0.3333333333333333) + real(1.0);
            let s4 = self.k * real(3.0);
            let s5 = h * h;
            let s6 = self.k * s5;
            let s7 = s6 * real(0.25);
            let s8 = s5 * real(0.25);
            let s9 = s5 * real(0.75);
            let s10 = s6 * real(0.75);
            let s11 = self.k * real(0.75);
            let s12 = self.k * real(0.25);
            let s13 = self.k * real(1.5);
            let s14 = s13 * v[2];
            let s15 = s13 * v[4];
            let s16 = s13 * v[6];
            let q_mid: [T; 10] = ::core::array::from_fn(|i| {
                q0[i] + (s1 * v[i] + q0_low[i])
            });
            let s17: [T; 10] = ::core::array::from_fn(|i| v[i] * p0_low[i]);
            let s18: [T; 10] = ::core::array::from_fn(|i| v[i] * p0[i]);
            let s19: [T; 9] = ::core::array::from_fn(|i| {
                (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i])
            });
            let s20: [T; 9] = ::core::array::from_fn(|i| s19[i] * s19[i]);
            let s21: [T; 10] = ::core::array::from_fn(|i| v[i] * v[i]);
            let s22: [(T, T); 10] = ::core::array::from_fn(|i| q_mid[i].sin_cos());
            let s23: [T; 9] = ::core::array::from_fn(|i| {
                s19[i] * (q_mid[i + 1] - q_mid[i])
            });
            let s24: [T; 10] = ::core::array::from_fn(|i| s3 * s22[i].0);
            let s25: [T; 8] = ::core::array::from_fn(|i| self.k * (s23[i] - s23[i + 1]));
            let s26: [T; 10] = ::core::array::from_fn(|i| self.m * v[i] - p0[i]);
            let s27: [T; 9] = ::core::array::from_fn(|i| self.k * s22[i].1 * s1);
            let s28: [T; 8] = ::core::array::from_fn(|i| {
                s26[i + 1] - (p0_low[i + 1] - s1 * (s25[i] + s24[i + 1]) + s27[i + 1])
            });
            let s29: [T; 8] = ::core::array::from_fn(|i| {
                v[i + 1] * (s25[i] + s24[i + 1])
            });
            let s30: [T; 10] = ::core::array::from_fn(|i| s3 * s22[i].1);
            let s31: [T; 8] = ::core::array::from_fn(|i| {
                s4 * (s19[i] + s19[i + 1]) + s30[i + 1]
            });
            let s32: [T; 9] = ::core::array::from_fn(|i| s7 * s22[i].0);
            let s33: [T; 8] = ::core::array::from_fn(|i| {
                self.m + (s32[i + 1] + s8 * s31[i])
            });
            let s34: [T; 10] = ::core::array::from_fn(|i| s24[i] * real(0.5));
            let s35: [T; 9] = ::core::array::from_fn(|i| self.k * s22[i].1 * real(0.5));
            let s36: [T; 10] = ::core::array::from_fn(|i| {
                cos2 * s22[i].0 * real(0.08333333333333333)
            });
            let s37: [T; 9] = ::core::array::from_fn(|i| s11 * v[i + 1] * s19[i]);
            let s38: [T; 9] = ::core::array::from_fn(|i| s36[i] + s12 * v[i] * s22[i].0);
            let s39: [T; 8] = ::core::array::from_fn(|i| {
                s25[i] * real(0.5) + s34[i + 1] - s35[i + 1]
            });
            let s40: [T; 9] = ::core::array::from_fn(|i| s11 * v[i] * s19[i]);
            let s41: [T; 8] = ::core::array::from_fn(|i| v[i + 1] * s31[i] * real(0.25));
            let s42: [T; 8] = ::core::array::from_fn(|i| {
                s39[i] + (s38[i + 1] - s40[i] + s41[i] - s37[i + 1]) * h
            });
            let s43: [T; 8] = ::core::array::from_fn(|i| {
                s39[i] + (s40[i] - s41[i] + s37[i + 1] - s36[i + 1]) * h
            });
            let s44: [T; 10] = ::core::array::from_fn(|i| v[i] * s22[i].0);
            let s45 = (1..10).fold(s22[0].1, |sum, i| sum + s22[i].1);
            let s46 = self.k * s23[0];
            let s47 = s46 - s24[0];
            let s48 = self.k * s23[8];
            let s49 = s48 + s24[9];
            let s50 = (1..10).fold(s18[0], |sum, i| sum + s18[i])
                + self.k * (1..9).fold(s20[0], |sum, i| sum + s20[i]) * real(0.25)
                - energy0
                - self.m * (1..10).fold(s21[0], |sum, i| sum + s21[i]) * real(0.5)
                - s3 * s45;
            let s51 = self.k * s19[0];
            let s52 = s51 * real(3.0) + s30[0];
            let s53 = self.k * s19[8];
            let s54 = s53 * real(3.0) + s30[9];
            let s55 = -(s51 * s9);
            let s56 = -(s10 * s19[1]);
            let s57 = -(s10 * s19[2]);
            let s58 = -(s10 * s19[3]);
            let s59 = -(s10 * s19[4]);
            let s60 = -(s10 * s19[5]);
            let s61 = -(s10 * s19[6]);
            let s62 = -(s10 * s19[7]);
            let s63 = -(s53 * s9);
            let s64 = s34[0] - s46 * real(0.5) - s35[0];
            let s65 = v[0] * s52 * real(0.25);
            let s66 = s48 * real(0.5) + s34[9];
            let s67 = v[9] * s54 * real(0.25);
            let s68 = -(s21[0] * s52) - s21[2] * s31[1] - s21[4] * s31[3]
                - s21[6] * s31[5] - s21[9] * s54 - sin2 * s45 * real(0.3333333333333333);
            let s69 = s68 * real(0.25) + (s13 * v[9] * s19[8] - s41[7]) * v[8]
                + (s16 * s19[6] - s41[6] + s13 * v[8] * s19[7]) * v[7];
            let s70 = s69 + (s15 * s19[4] - s41[4] + s16 * s19[5]) * v[5]
                + (s14 * s19[2] - s41[2] + s15 * s19[3]) * v[3];
            ::vi_core::ExtendedSystem {
                momentum: ::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from({
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = s26[0] - (p0_low[0] + s1 * s47 + s27[0]);
                        for i in 0..8 {
                            entries[i + 1] = s28[i];
                        }
                        entries[9] = s26[9] - (p0_low[9] - s1 * s49);
                        entries
                    }),
                    jacobian: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s55,
                            s56,
                            s57,
                            s58,
                            s59,
                            s60,
                            s61,
                            s62,
                            s63,
                        ],
                        diagonal: {
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = self.m + (s32[0] + s8 * s52);
                            for i in 0..8 {
                                entries[i + 1] = s33[i];
                            }
                            entries[9] = self.m + s8 * s54;
                            entries
                        },
                        upper: [
                            s55,
                            s56,
                            s57,
                            s58,
                            s59,
                            s60,
                            s61,
                            s62,
                            s63,
                            T::real(0.0),
                        ],
                    },
                },
                residual_dh: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s64 + (s38[0] + s65 - s37[0]) * h;
                    for i in 0..8 {
                        entries[i + 1] = s42[i];
                    }
                    entries[9] = s66 + (s36[9] - s40[8] + s67) * h;
                    entries
                }),
                energy_residual: s50
                    + ((1..10).fold(s17[0], |sum, i| sum + s17[i]) - energy0_low
                        + s1
                            * ((0..8)
                                .fold(
                                    s45 * cos2 * real(0.3333333333333333) + v[0] * s47,
                                    |sum, i| sum - s29[i],
                                ) - v[9] * s49)),
                energy_dv: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s64 + (s37[0] - s65 - s36[0]) * h;
                    for i in 0..8 {
                        entries[i + 1] = s43[i];
                    }
                    entries[9] = s66 + (s40[8] - s67 - s36[9]) * h;
                    entries
                }),
                energy_dh: s70 + (s13 * v[0] * s19[0] - s41[0] + s14 * s19[1]) * v[1]
                    - (1..10).fold(s44[0], |sum, i| sum + s44[i]) * cos2
                        * real(0.16666666666666666),
            }
        }

        /// Sums of the absolute values of the terms of `residual` and `energy_residual`.
        ///
        /// 846 operations.
        #[cold]
        fn magnitudes(
            &self,
            node: &::vi_core::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::Magnitudes<10, T> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let energy0 = node.energy;
            let q0 = &node.q.data.0[0];
            let q0_low = &node.q_low.data.0[0];
            let p0 = &node.p.data.0[0];
            let v = &(*v).data.0[0];
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let (sin2, cos2) = t_mid.sin_cos();
            let s3 = sin2 * real(0.3333333333333333) + real(1.0);
            let s4 = self.k * real(4.0);
            let s5 = self.k * h;
            let s6 = h * t_mid * cos2;
            let s7 = s5 * real(0.5);
            let s8 = h.abs() * real(0.5);
            let s9 = self.k * real(3.0);
            let s10 = self.k * real(1.5);
            let q_mid: [T; 10] = ::core::array::from_fn(|i| {
                q0[i] + (s1 * v[i] + q0_low[i])
            });
            let s11: [T; 9] = ::core::array::from_fn(|i| {
                (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i])
            });
            let s12: [T; 9] = ::core::array::from_fn(|i| s11[i] * s11[i]);
            let s13: [T; 10] = ::core::array::from_fn(|i| v[i] * v[i]);
            let s14: [(T, T); 10] = ::core::array::from_fn(|i| q_mid[i].sin_cos());
            let s15: [T; 9] = ::core::array::from_fn(|i| {
                s11[i] * (q_mid[i + 1] - q_mid[i])
            });
            let s16: [T; 10] = ::core::array::from_fn(|i| s3 * s14[i].0);
            let s17: [T; 10] = ::core::array::from_fn(|i| s16[i].abs());
            let s18: [T; 10] = ::core::array::from_fn(|i| s3 * s14[i].1);
            let s19: [T; 9] = ::core::array::from_fn(|i| s7 * s14[i].0);
            let s20: [T; 9] = ::core::array::from_fn(|i| {
                (s5 * s14[i].1).abs() * real(0.5)
            });
            let s21: [T; 10] = ::core::array::from_fn(|i| {
                (s6 * s14[i].0).abs() * real(0.16666666666666666)
            });
            let s22: [T; 9] = ::core::array::from_fn(|i| {
                (s5 * q_mid[i + 1] * s11[i]).abs() * real(1.5)
            });
            let s23: [T; 10] = ::core::array::from_fn(|i| {
                p0[i].abs() + (self.m * v[i]).abs()
            });
            let s24: [T; 8] = ::core::array::from_fn(|i| {
                (s4 * (s15[i] - s15[i + 1])).abs() * real(0.25) + s17[i + 1]
            });
            let s25: [T; 8] = ::core::array::from_fn(|i| {
                s9 * (s11[i] + s11[i + 1]) + s18[i + 1]
            });
            let s26: [T; 9] = ::core::array::from_fn(|i| {
                (s5 * q_mid[i] * s11[i]).abs() * real(1.5)
            });
            let s27: [T; 8] = ::core::array::from_fn(|i| {
                s23[i + 1] + s8 * s24[i] + s20[i + 1] + s21[i + 1] + s26[i]
                    + (q_mid[i + 1] * (-(s1 * s25[i]) - s19[i + 1])).abs()
            });
            let s28: [T; 8] = ::core::array::from_fn(|i| s27[i] + s22[i + 1]);
            let s29: [T; 10] = ::core::array::from_fn(|i| (v[i] * p0[i]).abs());
            let s30: [T; 10] = ::core::array::from_fn(|i| s14[i].1.abs());
            let s31: [T; 10] = ::core::array::from_fn(|i| (h * v[i]).abs());
            let s32: [T; 10] = ::core::array::from_fn(|i| v[i] * s14[i].0);
            let s33: [T; 10] = ::core::array::from_fn(|i| {
                cos2 * s14[i].0 * real(0.16666666666666666)
            });
            let s34: [T; 9] = ::core::array::from_fn(|i| s10 * v[i + 1] * s11[i]);
            let s35: [T; 9] = ::core::array::from_fn(|i| s10 * v[i] * s11[i]);
            let s36: [T; 8] = ::core::array::from_fn(|i| {
                q_mid[i + 1]
                    * (self.k * (s15[i] - s15[i + 1]) + s16[i + 1]
                        + (s35[i] - v[i + 1] * s25[i] * real(0.5) + s34[i + 1]
                            - s33[i + 1]) * h)
            });
            let s37: [T; 8] = ::core::array::from_fn(|i| s36[i].abs());
            let s38: [T; 8] = ::core::array::from_fn(|i| {
                s24[i] * s31[i + 1] * real(0.5)
            });
            let s39 = (1..10).fold(s14[0].1, |sum, i| sum + s14[i].1);
            let s40 = self.k * s15[0];
            let s41 = s40.abs() + s17[0];
            let s42 = self.k * s11[0] * real(3.0) + s18[0];
            let s43 = q_mid[8] - q_mid[9];
            let s44 = (self.k * (s43 * s43 * s43)).abs() + s17[9];
            let s45 = self.k * s11[8] * real(3.0) + s18[9];
            let s46 = t_mid
                * (s39 * cos2 * real(0.3333333333333333)
                    + (sin2 * s39 * real(0.16666666666666666)
                        + (1..10).fold(s32[0], |sum, i| sum + s32[i]) * cos2
                            * real(0.16666666666666666)) * h);
            let s47 = (0..10).fold(energy0.abs(), |sum, i| sum + s29[i])
                + self.k.abs() * (1..9).fold(s12[0], |sum, i| sum + s12[i]) * real(0.25)
                + self.m.abs() * (1..10).fold(s13[0], |sum, i| sum + s13[i]) * real(0.5);
            let s48 = (0..8).fold(s47 + s41 * s31[0] * real(0.5), |sum, i| sum + s38[i])
                + s44 * s31[9] * real(0.5) + s46.abs()
                + (q_mid[0]
                    * (s40 - s16[0] + (s33[0] + v[0] * s42 * real(0.5) - s34[0]) * h))
                    .abs();
            let s49 = (0..8).fold(s48, |sum, i| sum + s37[i])
                + (q_mid[9]
                    * (self.k * s15[8] + s16[9]
                        + (s35[8] - v[9] * s45 * real(0.5) - s33[9]) * h))
                    .abs();
            ::vi_core::Magnitudes {
                residual: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s23[0] + s8 * s41 + s20[0] + s21[0]
                        + (q_mid[0] * (-(s1 * s42) - s19[0])).abs() + s22[0];
                    for i in 0..8 {
                        entries[i + 1] = s28[i];
                    }
                    entries[9] = s23[9] + s8 * s44 + s21[9] + s26[8]
                        + (h * q_mid[9] * s45).abs() * real(0.5);
                    entries
                }),
                energy_residual: s49
                    + (sin2.abs() * real(0.3333333333333333)
                        + (h * cos2).abs() * real(0.16666666666666666) + real(1.0))
                        * (1..10).fold(s30[0], |sum, i| sum + s30[i]),
            }
        }

        /// `p1 − p0_q[0] = h*f_q[0] + h*L_q[0]`
        ///
        /// `p1 − p0_q[1] = h*f_q[1] + h*L_q[1]`
        ///
        /// `p1 − p0_q[2] = h*f_q[2] + h*L_q[2]`
        ///
        /// `p1 − p0_q[3] = h*f_q[3] + h*L_q[3]`
        ///
        /// `p1 − p0_q[4] = h*f_q[4] + h*L_q[4]`
        ///
        /// `p1 − p0_q[5] = h*f_q[5] + h*L_q[5]`
        ///
        /// `p1 − p0_q[6] = h*f_q[6] + h*L_q[6]`
        ///
        /// `p1 − p0_q[7] = h*f_q[7] + h*L_q[7]`
        ///
        /// `p1 − p0_q[8] = h*f_q[8] + h*L_q[8]`
        ///
        /// `p1 − p0_q[9] = h*L_q[9]`
        ///
        /// `E1 − E0 = h*f_q[0]*v_q[0] - h*L_t + h*f_q[1]*v_q[1] + h*f_q[2]*v_q[2] + h*f_q[3]*v_q[3] + h*f_q[4]*v_q[4] + h*f_q[5]*v_q[5] + h*f_q[6]*v_q[6] + h*f_q[7]*v_q[7] + h*f_q[8]*v_q[8]`
        ///
        /// 191 operations.
        #[inline(always)]
        fn increment(
            &self,
            node: &::vi_core::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::Increment<10, T> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [q_0_0, q_1_0, q_2_0, q_3_0, q_4_0, q_5_0, q_6_0, q_7_0, q_8_0, q_9_0,
            ]: [T; 10] = node.q.into();
            let [q_0_0_low, q_1_0_low, q_2_0_low, q_3_0_low, q_4_0_low, q_5_0_low,
            q_6_0_low, q_7_0_low, q_8_0_low, q_9_0_low]: [T; 10] = node.q_low.into();
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
            let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
            let q_2_mid = q_2_0 + (s1 * q_2_dot + q_2_0_low);
            let q_3_mid = q_3_0 + (s1 * q_3_dot + q_3_0_low);
            let q_4_mid = q_4_0 + (s1 * q_4_dot + q_4_0_low);
            let q_5_mid = q_5_0 + (s1 * q_5_dot + q_5_0_low);
            let q_6_mid = q_6_0 + (s1 * q_6_dot + q_6_0_low);
            let q_7_mid = q_7_0 + (s1 * q_7_dot + q_7_0_low);
            let q_8_mid = q_8_0 + (s1 * q_8_dot + q_8_0_low);
            let q_9_mid = q_9_0 + (s1 * q_9_dot + q_9_0_low);
            let s2 = q_1_mid - q_0_mid;
            let s3 = q_2_mid - q_1_mid;
            let s4 = q_3_mid - q_2_mid;
            let s5 = q_4_mid - q_3_mid;
            let s6 = q_5_mid - q_4_mid;
            let s7 = q_6_mid - q_5_mid;
            let s8 = q_7_mid - q_6_mid;
            let s9 = q_8_mid - q_7_mid;
            let s10 = q_9_mid - q_8_mid;
            let [(sin11, cos11), (sin12, cos12), (sin13, cos13), (sin14, cos14)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let s15 = sin11 * real(0.3333333333333333) + real(1.0);
            let [(sin16, cos16), (sin17, cos17), (sin18, cos18), (sin19, cos19)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(sin20, cos20), (sin21, cos21), (sin22, cos22)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s23 = s2 * s2 * s2;
            let s24 = s3 * s3 * s3;
            let s25 = s4 * s4 * s4;
            let s26 = s5 * s5 * s5;
            let s27 = s6 * s6 * s6;
            let s28 = s7 * s7 * s7;
            let s29 = s8 * s8 * s8;
            let s30 = s9 * s9 * s9;
            let s31 = s10 * s10 * s10;
            let s32 = self.k * h;
            let s33 = (cos12 + cos13 + cos14 + cos16 + cos17 + cos18 + cos19 + cos20
                + cos21 + cos22) * cos11 * real(0.3333333333333333);
            let s34 = self.k * q_0_dot * cos12 + self.k * q_1_dot * cos13
                + self.k * q_2_dot * cos14 + self.k * q_3_dot * cos16;
            let s35 = s34 + self.k * q_4_dot * cos17 + self.k * q_5_dot * cos18
                + self.k * q_6_dot * cos19 + self.k * q_7_dot * cos20;
            ::vi_core::Increment {
                momentum: ::vi_core::SVector::from([
                    h * (self.k * s23 - s15 * sin12) + s32 * cos12,
                    s32 * cos13 - h * (self.k * (s23 - s24) + s15 * sin13),
                    s32 * cos14 - h * (self.k * (s24 - s25) + s15 * sin14),
                    s32 * cos16 - h * (self.k * (s25 - s26) + s15 * sin16),
                    s32 * cos17 - h * (self.k * (s26 - s27) + s15 * sin17),
                    s32 * cos18 - h * (self.k * (s27 - s28) + s15 * sin18),
                    s32 * cos19 - h * (self.k * (s28 - s29) + s15 * sin19),
                    s32 * cos20 - h * (self.k * (s29 - s30) + s15 * sin20),
                    s32 * cos21 - h * (self.k * (s30 - s31) + s15 * sin21),
                    -(h * (self.k * s31 + s15 * sin22)),
                ]),
                energy: (s35 + self.k * q_8_dot * cos21 - s33) * h,
            }
        }

        /// `p1 − p0_q[0] = h*f_q[0] + h*L_q[0]`
        ///
        /// `p1 − p0_q[1] = h*f_q[1] + h*L_q[1]`
        ///
        /// `p1 − p0_q[2] = h*f_q[2] + h*L_q[2]`
        ///
        /// `p1 − p0_q[3] = h*f_q[3] + h*L_q[3]`
        ///
        /// `p1 − p0_q[4] = h*f_q[4] + h*L_q[4]`
        ///
        /// `p1 − p0_q[5] = h*f_q[5] + h*L_q[5]`
        ///
        /// `p1 − p0_q[6] = h*f_q[6] + h*L_q[6]`
        ///
        /// `p1 − p0_q[7] = h*f_q[7] + h*L_q[7]`
        ///
        /// `p1 − p0_q[8] = h*f_q[8] + h*L_q[8]`
        ///
        /// `p1 − p0_q[9] = h*L_q[9]`
        ///
        /// to first order at `v + dv`.
        ///
        /// 294 operations.
        #[inline]
        fn momentum_step(
            &self,
            node: &::vi_core::Node<10, T>,
            place: &::vi_core::SVector<T, 10>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
            solve: impl ::core::ops::FnOnce(
                &::vi_core::MomentumEquation<10, T, Self::Jacobian>,
            ) -> ::vi_core::SVector<T, 10>,
        ) -> ::vi_core::SVector<T, 10> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let [p0_q_0, p0_q_1, p0_q_2, p0_q_3, p0_q_4, p0_q_5, p0_q_6, p0_q_7, p0_q_8,
            p0_q_9]: [T; 10] = node.p.into();
            let [p0_q_0_low, p0_q_1_low, p0_q_2_low, p0_q_3_low, p0_q_4_low, p0_q_5_low,
            p0_q_6_low, p0_q_7_low, p0_q_8_low, p0_q_9_low]: [T; 10] = node.p_low.into();
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
            let [q_0_mid, q_1_mid, q_2_mid, q_3_mid, q_4_mid, q_5_mid, q_6_mid, q_7_mid,
            q_8_mid, q_9_mid]: [T; 10] = (*place).into();
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let s2 = self.m * real(2.0);
            let s3 = q_1_mid - q_0_mid;
            let s4 = q_2_mid - q_1_mid;
            let s5 = q_3_mid - q_2_mid;
            let s6 = q_4_mid - q_3_mid;
            let s7 = q_5_mid - q_4_mid;
            let s8 = q_6_mid - q_5_mid;
            let s9 = q_7_mid - q_6_mid;
            let s10 = q_8_mid - q_7_mid;
            let s11 = q_9_mid - q_8_mid;
            let [(sin12, _), (sin13, cos13), (sin14, cos14), (sin15, cos15)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let s16 = sin12 * real(0.3333333333333333) + real(1.0);
            let [(sin17, cos17), (sin18, cos18), (sin19, cos19), (sin20, cos20)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(sin21, cos21), (sin22, cos22), (sin23, cos23)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s24 = s3 * s3;
            let s25 = s24 * s3;
            let s26 = self.k * s25 - s16 * sin13;
            let s27 = s4 * s4;
            let s28 = s27 * s4;
            let s29 = self.k * (s25 - s28) + s16 * sin14;
            let s30 = s5 * s5;
            let s31 = s30 * s5;
            let s32 = self.k * (s28 - s31) + s16 * sin15;
            let s33 = s6 * s6;
            let s34 = s33 * s6;
            let s35 = self.k * (s31 - s34) + s16 * sin17;
            let s36 = s7 * s7;
            let s37 = s36 * s7;
            let s38 = self.k * (s34 - s37) + s16 * sin18;
            let s39 = s8 * s8;
            let s40 = s39 * s8;
            let s41 = self.k * (s37 - s40) + s16 * sin19;
            let s42 = s9 * s9;
            let s43 = s42 * s9;
            let s44 = self.k * (s40 - s43) + s16 * sin20;
            let s45 = s10 * s10;
            let s46 = s45 * s10;
            let s47 = self.k * (s43 - s46) + s16 * sin21;
            let s48 = s11 * s11;
            let s49 = s48 * s11;
            let s50 = self.k * (s46 - s49) + s16 * sin22;
            let s51 = self.k * s49 + s16 * sin23;
            let s52 = self.k * h;
            let s53 = s52 * real(0.5);
            let s54 = self.k * s24;
            let s55 = self.k * real(3.0);
            let s56 = self.k * s48;
            let s57 = h * h;
            let s58 = self.k * s57;
            let s59 = s58 * real(0.25);
            let s60 = s57 * real(0.25);
            let s61 = s57 * real(0.75);
            let s62 = -(s54 * s61);
            let s63 = s58 * real(0.75);
            let s64 = -(s63 * s27);
            let s65 = -(s63 * s30);
            let s66 = -(s63 * s33);
            let s67 = -(s63 * s36);
            let s68 = -(s63 * s39);
            let s69 = -(s63 * s42);
            let s70 = -(s63 * s45);
            let s71 = -(s56 * s61);
            let momentum = ::vi_core::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    self.m * q_0_dot - p0_q_0 - (p0_q_0_low + s1 * s26 + s53 * cos13),
                    self.m * q_1_dot - p0_q_1 - (p0_q_1_low - s1 * s29 + s53 * cos14),
                    self.m * q_2_dot - p0_q_2 - (p0_q_2_low - s1 * s32 + s53 * cos15),
                    self.m * q_3_dot - p0_q_3 - (p0_q_3_low - s1 * s35 + s53 * cos17),
                    self.m * q_4_dot - p0_q_4 - (p0_q_4_low - s1 * s38 + s53 * cos18),
                    self.m * q_5_dot - p0_q_5 - (p0_q_5_low - s1 * s41 + s53 * cos19),
                    self.m * q_6_dot - p0_q_6 - (p0_q_6_low - s1 * s44 + s53 * cos20),
                    self.m * q_7_dot - p0_q_7 - (p0_q_7_low - s1 * s47 + s53 * cos21),
                    self.m * q_8_dot - p0_q_8 - (p0_q_8_low - s1 * s50 + s53 * cos22),
                    self.m * q_9_dot - p0_q_9 - (p0_q_9_low - s1 * s51),
                ]),
                jacobian: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s62, s64, s65, s66, s67, s68, s69, s70, s71],
                    diagonal: [
                        self.m + (s59 * sin13 + s60 * (s54 * real(3.0) + s16 * cos13)),
                        self.m + (s59 * sin14 + s60 * (s55 * (s24 + s27) + s16 * cos14)),
                        self.m + (s59 * sin15 + s60 * (s55 * (s27 + s30) + s16 * cos15)),
                        self.m + (s59 * sin17 + s60 * (s55 * (s30 + s33) + s16 * cos17)),
                        self.m + (s59 * sin18 + s60 * (s55 * (s33 + s36) + s16 * cos18)),
                        self.m + (s59 * sin19 + s60 * (s55 * (s36 + s39) + s16 * cos19)),
                        self.m + (s59 * sin20 + s60 * (s55 * (s39 + s42) + s16 * cos20)),
                        self.m + (s59 * sin21 + s60 * (s55 * (s42 + s45) + s16 * cos21)),
                        self.m + (s59 * sin22 + s60 * (s55 * (s45 + s48) + s16 * cos22)),
                        self.m + s60 * (s56 * real(3.0) + s16 * cos23),
                    ],
                    upper: [s62, s64, s65, s66, s67, s68, s69, s70, s71, T::real(0.0)],
                },
            };
            let change: [T; 10] = solve(&momentum).into();
            ::vi_core::SVector::from([
                h * s26 + s52 * cos13
                    + (s2 * change[0] + real(2.0) * momentum.residual[0]),
                s52 * cos14 - h * s29
                    + (s2 * change[1] + real(2.0) * momentum.residual[1]),
                s52 * cos15 - h * s32
                    + (s2 * change[2] + real(2.0) * momentum.residual[2]),
                s52 * cos17 - h * s35
                    + (s2 * change[3] + real(2.0) * momentum.residual[3]),
                s52 * cos18 - h * s38
                    + (s2 * change[4] + real(2.0) * momentum.residual[4]),
                s52 * cos19 - h * s41
                    + (s2 * change[5] + real(2.0) * momentum.residual[5]),
                s52 * cos20 - h * s44
                    + (s2 * change[6] + real(2.0) * momentum.residual[6]),
                s52 * cos21 - h * s47
                    + (s2 * change[7] + real(2.0) * momentum.residual[7]),
                s52 * cos22 - h * s50
                    + (s2 * change[8] + real(2.0) * momentum.residual[8]),
                -(h * s51) + (s2 * change[9] + real(2.0) * momentum.residual[9]),
            ])
        }

        /// `p1 − p0_q[0] = h*f_q[0] + h*L_q[0]`
        ///
        /// `p1 − p0_q[1] = h*f_q[1] + h*L_q[1]`
        ///
        /// `p1 − p0_q[2] = h*f_q[2] + h*L_q[2]`
        ///
        /// `p1 − p0_q[3] = h*f_q[3] + h*L_q[3]`
        ///
        /// `p1 − p0_q[4] = h*f_q[4] + h*L_q[4]`
        ///
        /// `p1 − p0_q[5] = h*f_q[5] + h*L_q[5]`
        ///
        /// `p1 − p0_q[6] = h*f_q[6] + h*L_q[6]`
        ///
        /// `p1 − p0_q[7] = h*f_q[7] + h*L_q[7]`
        ///
        /// `p1 − p0_q[8] = h*f_q[8] + h*L_q[8]`
        ///
        /// `p1 − p0_q[9] = h*L_q[9]`
        ///
        /// `E1 − E0 = h*f_q[0]*v_q[0] - h*L_t + h*f_q[1]*v_q[1] + h*f_q[2]*v_q[2] + h*f_q[3]*v_q[3] + h*f_q[4]*v_q[4] + h*f_q[5]*v_q[5] + h*f_q[6]*v_q[6] + h*f_q[7]*v_q[7] + h*f_q[8]*v_q[8]`
        ///
        /// at `(v + dv, h + dh)`.
        ///
        /// 702 operations.
        #[inline(never)]
        fn extended_step(
            &self,
            node: &::vi_core::Node<10, T>,
            place: &::vi_core::SVector<T, 10>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
            solve: impl ::core::ops::FnOnce(
                &::vi_core::ExtendedSystem<10, T, Self::Jacobian>,
            ) -> (::vi_core::SVector<T, 10>, T),
        ) -> ::vi_core::Increment<10, T> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let energy0 = node.energy;
            let energy0_low = node.energy_low;
            let p0 = &node.p.data.0[0];
            let p0_low = &node.p_low.data.0[0];
            let v = &(*v).data.0[0];
            let q_mid = &(*place).data.0[0];
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let (sin2, cos2) = t_mid.sin_cos();
            let s3 = sin2 * real(0.3333333333333333) + real(1.0);
            let s4 = self.k * real(3.0);
            let s5 = h * h;
            let s6 = self.k * s5;
            let s7 = s6 * real(0.25);
            let s8 = s5 * real(0.25);
            let s9 = s5 * real(0.75);
            let s10 = s6 * real(0.75);
            let s11 = self.k * real(0.75);
            let s12 = self.k * real(0.25);
            let s13 = self.k * real(1.5);
            let s14 = s13 * v[2];
            let s15 = s13 * v[4];
            let s16 = s13 * v[6];
            let s17: [T; 10] = ::core::array::from_fn(|i| v[i] * p0_low[i]);
            let s18: [T; 10] = ::core::array::from_fn(|i| v[i] * p0[i]);
            let s19: [T; 9] = ::core::array::from_fn(|i| {
                (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i])
            });
            let s20: [T; 9] = ::core::array::from_fn(|i| s19[i] * s19[i]);
            let s21: [T; 10] = ::core::array::from_fn(|i| v[i] * v[i]);
            let s22: [(T, T); 10] = ::core::array::from_fn(|i| q_mid[i].sin_cos());
            let s23: [T; 9] = ::core::array::from_fn(|i| {
                s19[i] * (q_mid[i + 1] - q_mid[i])
            });
            let s24: [T; 10] = ::core::array::from_fn(|i| s3 * s22[i].0);
            let s25: [T; 8] = ::core::array::from_fn(|i| self.k * (s23[i] - s23[i + 1]));
            let s26: [T; 10] = ::core::array::from_fn(|i| self.m * v[i] - p0[i]);
            let s27: [T; 9] = ::core::array::from_fn(|i| self.k * s22[i].1 * s1);
            let s28: [T; 8] = ::core::array::from_fn(|i| {
                s26[i + 1] - (p0_low[i + 1] - s1 * (s25[i] + s24[i + 1]) + s27[i + 1])
            });
            let s29: [T; 8] = ::core::array::from_fn(|i| {
                v[i + 1] * (s25[i] + s24[i + 1])
            });
            let s30: [T; 10] = ::core::array::from_fn(|i| s3 * s22[i].1);
            let s31: [T; 8] = ::core::array::from_fn(|i| {
                s4 * (s19[i] + s19[i + 1]) + s30[i + 1]
            });
            let s32: [T; 9] = ::core::array::from_fn(|i| s7 * s22[i].0);
            let s33: [T; 8] = ::core::array::from_fn(|i| {
                self.m + (s32[i + 1] + s8 * s31[i])
            });
            let s34: [T; 10] = ::core::array::from_fn(|i| s24[i] * real(0.5));
            let s35: [T; 9] = ::core::array::from_fn(|i| self.k * s22[i].1 * real(0.5));
            let s36: [T; 10] = ::core::array::from_fn(|i| {
                cos2 * s22[i].0 * real(0.08333333333333333)
            });
            let s37: [T; 9] = ::core::array::from_fn(|i| s11 * v[i + 1] * s19[i]);
            let s38: [T; 9] = ::core::array::from_fn(|i| s36[i] + s12 * v[i] * s22[i].0);
            let s39: [T; 8] = ::core::array::from_fn(|i| {
                s25[i] * real(0.5) + s34[i + 1] - s35[i + 1]
            });
            let s40: [T; 9] = ::core::array::from_fn(|i| s11 * v[i] * s19[i]);
            let s41: [T; 8] = ::core::array::from_fn(|i| v[i + 1] * s31[i] * real(0.25));
            let s42: [T; 8] = ::core::array::from_fn(|i| {
                s39[i] + (s38[i + 1] - s40[i] + s41[i] - s37[i + 1]) * h
            });
            let s43: [T; 8] = ::core::array::from_fn(|i| {
                s39[i] + (s40[i] - s41[i] + s37[i + 1] - s36[i + 1]) * h
            });
            let s44: [T; 10] = ::core::array::from_fn(|i| v[i] * s22[i].0);
            let s45 = (1..10).fold(s22[0].1, |sum, i| sum + s22[i].1);
            let s46 = self.k * s23[0];
            let s47 = s46 - s24[0];
            let s48 = self.k * s23[8];
            let s49 = s48 + s24[9];
            let s50 = (1..10).fold(s18[0], |sum, i| sum + s18[i])
                + self.k * (1..9).fold(s20[0], |sum, i| sum + s20[i]) * real(0.25)
                - energy0
                - self.m * (1..10).fold(s21[0], |sum, i| sum + s21[i]) * real(0.5)
                - s3 * s45;
            let s51 = self.k * s19[0];
            let s52 = s51 * real(3.0) + s30[0];
            let s53 = self.k * s19[8];
            let s54 = s53 * real(3.0) + s30[9];
            let s55 = -(s51 * s9);
            let s56 = -(s10 * s19[1]);
            let s57 = -(s10 * s19[2]);
            let s58 = -(s10 * s19[3]);
            let s59 = -(s10 * s19[4]);
            let s60 = -(s10 * s19[5]);
            let s61 = -(s10 * s19[6]);
            let s62 = -(s10 * s19[7]);
            let s63 = -(s53 * s9);
            let s64 = s34[0] - s46 * real(0.5) - s35[0];
            let s65 = v[0] * s52 * real(0.25);
            let s66 = s48 * real(0.5) + s34[9];
            let s67 = v[9] * s54 * real(0.25);
            let s68 = -(s21[0] * s52) - s21[2] * s31[1] - s21[4] * s31[3]
                - s21[6] * s31[5] - s21[9] * s54 - sin2 * s45 * real(0.3333333333333333);
            let s69 = s68 * real(0.25) + (s13 * v[9] * s19[8] - s41[7]) * v[8]
                + (s16 * s19[6] - s41[6] + s13 * v[8] * s19[7]) * v[7];
            let s70 = s69 + (s15 * s19[4] - s41[4] + s16 * s19[5]) * v[5]
                + (s14 * s19[2] - s41[2] + s15 * s19[3]) * v[3];
            let (change, change_h) = solve(
                &::vi_core::ExtendedSystem {
                    momentum: ::vi_core::MomentumEquation {
                        residual: ::vi_core::SVector::from({
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = s26[0] - (p0_low[0] + s1 * s47 + s27[0]);
                            for i in 0..8 {
                                entries[i + 1] = s28[i];
                            }
                            entries[9] = s26[9] - (p0_low[9] - s1 * s49);
                            entries
                        }),
                        jacobian: ::vi_core::linear::Tridiagonal {
                            lower: [
                                T::real(0.0),
                                s55,
                                s56,
                                s57,
                                s58,
                                s59,
                                s60,
                                s61,
                                s62,
                                s63,
                            ],
                            diagonal: {
                                let mut entries = [T::real(0.0); 10];
                                entries[0] = self.m + (s32[0] + s8 * s52);
                                for i in 0..8 {
                                    entries[i + 1] = s33[i];
                                }
                                entries[9] = self.m + s8 * s54;
                                entries
                            },
                            upper: [
                                s55,
                                s56,
                                s57,
                                s58,
                                s59,
                                s60,
                                s61,
                                s62,
                                s63,
                                T::real(0.0),
                            ],
                        },
                    },
                    residual_dh: ::vi_core::SVector::from({
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = s64 + (s38[0] + s65 - s37[0]) * h;
                        for i in 0..8 {
                            entries[i + 1] = s42[i];
                        }
                        entries[9] = s66 + (s36[9] - s40[8] + s67) * h;
                        entries
                    }),
                    energy_residual: s50
                        + ((1..10).fold(s17[0], |sum, i| sum + s17[i]) - energy0_low
                            + s1
                                * ((0..8)
                                    .fold(
                                        s45 * cos2 * real(0.3333333333333333) + v[0] * s47,
                                        |sum, i| sum - s29[i],
                                    ) - v[9] * s49)),
                    energy_dv: ::vi_core::SVector::from({
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = s64 + (s37[0] - s65 - s36[0]) * h;
                        for i in 0..8 {
                            entries[i + 1] = s43[i];
                        }
                        entries[9] = s66 + (s40[8] - s67 - s36[9]) * h;
                        entries
                    }),
                    energy_dh: s70 + (s13 * v[0] * s19[0] - s41[0] + s14 * s19[1]) * v[1]
                        - (1..10).fold(s44[0], |sum, i| sum + s44[i]) * cos2
                            * real(0.16666666666666666),
                },
            );
            self.increment(
                node,
                h + change_h,
                &(::vi_core::SVector::<T, 10>::from(*v) + change),
            )
        }
    }

    impl ::vi_core::Batch<10> for Chain<f64> {
        type Rows<const W: usize> = Chain<[f64; W]>;
        type In<T: ::vi_core::Real> = Chain<T>;
        fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
            Chain {
                m: ::core::array::from_fn(|index| systems[index].m),
                k: ::core::array::from_fn(|index| systems[index].k),
            }
        }

        #[inline(always)]
        fn pick<T: ::vi_core::Real, const W: usize>(
            rows: &Self::Rows<W>,
            index: usize,
        ) -> Self::In<T> {
            Chain {
                m: T::real(rows.m[index]),
                k: T::real(rows.k[index]),
            }
        }
    }

    impl ::vi_core::check::Checked<10> for Chain<f64> {
        type In<T: ::vi_core::Real> = Chain<T>;
        fn convert<T: ::vi_core::Real>(&self) -> Chain<T> {
            Chain::from_f64(self)
        }
    }
};
