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
    use ::core::convert::{identity as name, identity as index, identity as t};
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
    use ::core::convert::{identity as sum, identity as p, identity as at_rest};
    use ::core::convert::{identity as velocity, identity as force, identity as power};
    use ::core::convert::{identity as values, identity as value, identity as text};
    use ::core::convert::{identity as s36, identity as s37, identity as s38};
    use ::core::convert::{identity as s39, identity as s40, identity as cos9};
    use ::core::convert::{identity as cos10, identity as interval, identity as t0};
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
    use ::core::convert::{identity as s45, identity as s46, identity as s47};
    use ::core::convert::{identity as s48, identity as s49, identity as s50};
    use ::core::convert::{identity as s51, identity as s52, identity as s53};
    use ::core::convert::{identity as s54, identity as s55, identity as s56};
    use ::core::convert::{identity as s57, identity as s58, identity as s59};
    use ::core::convert::{identity as q0, identity as q0_low, identity as p0};
    use ::core::convert::{identity as p0_low, identity as q_mid, identity as entries};
    use ::core::convert::{identity as s60, identity as s61, identity as s62};
    use ::core::convert::{identity as s63, identity as s64, identity as s65};
    use ::core::convert::{identity as s66, identity as s67, identity as s68};
    use ::core::convert::{identity as s69, identity as s70, identity as s71};
    use ::core::convert::{identity as sin31, identity as cos41, identity as energy0};
    use ::core::convert::{identity as energy0_low, identity as sin2, identity as s72};
    use ::core::convert::{identity as s73, identity as s74, identity as s75};
    use ::core::convert::{identity as s76, identity as s77, identity as s78};
    use ::core::convert::{identity as s79, identity as s80, identity as s81};
    use ::core::convert::{identity as s82, identity as s83, identity as s84};
    use ::core::convert::{identity as s85, identity as s86, identity as s87};
    use ::core::convert::{identity as s88, identity as s89, identity as s90};
    use ::core::convert::{identity as s91, identity as s92, identity as s93};
    use ::core::convert::{identity as s94, identity as s95, identity as s96};
    use ::core::convert::{identity as s97, identity as s98, identity as s99};
    use ::core::convert::{identity as s100, identity as s101, identity as s102};
    use ::core::convert::{identity as s103, identity as s104, identity as s105};
    use ::core::convert::{identity as s106, identity as s107, identity as s108};
    use ::core::convert::{identity as s109, identity as s110, identity as s111};
    use ::core::convert::{identity as s112, identity as s113, identity as s114};
    use ::core::convert::{identity as s115, identity as s116, identity as s117};
    use ::core::convert::{identity as s118, identity as s119, identity as s120};
    use ::core::convert::{identity as s121, identity as s122, identity as s123};
    use ::core::convert::{identity as systems, identity as rows};
    use ::core::primitive::{bool, f64, str, usize};

    impl ::core::default::Default for Chain<f64> {
        fn default() -> Self {
            Self { m: 1.2, k: 0.7 }
        }
    }

    impl<T: ::vi_core::real::Real> Chain<T> {
        /// The same system in another kind of number, every parameter rounded to it.
        pub fn convert<U: ::vi_core::real::Real>(&self) -> Chain<U> {
            Chain {
                m: U::real(self.m.to_f64()),
                k: U::real(self.k.to_f64()),
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T> for Chain<T> {
        fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
            match name {
                "m" => ::core::option::Option::Some(&mut self.m),
                "k" => ::core::option::Option::Some(&mut self.k),
                _ => ::core::option::Option::None,
            }
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::Lagrangian<10, T> for Chain<T> {
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
        const PARAMETERS: &'static [&'static str] = &["m", "k"];
        fn parameter(&self, index: usize) -> T {
            [self.m, self.k][index]
        }

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
            ::vi_core::support::acceleration(time, &mass, &applied)
        }

        /// `D = (k*cos(q[0]) + k*(q[1] - q[0])^3 - (sin(t)/3 + 1)*sin(q[0]))*dot(dot(q[0])) - dot(q[0])*(dot(q[0])*(-3*k*(q[1] - q[0])^2 - (sin(t)/3 + 1)*cos(q[0])) - cos(t)*sin(q[0])/3 + 3*k*(q[1] - q[0])^2*dot(q[1])) + dot(q[0])*cos(t)*sin(q[0])/3 + dot(dot(q[1]))*(k*cos(q[1]) - k*(4*(q[1] - q[0])^3 - 4*(q[2] - q[1])^3)/4 - (sin(t)/3 + 1)*sin(q[1])) - dot(q[1])*(3*k*(q[1] - q[0])^2*dot(q[0]) - …`
        ///
        /// 322 operations.
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let time = t;
            let a = &self.acceleration(t, q, v)?.data.0[0];
            let v = &(*v).data.0[0];
            let q = &(*q).data.0[0];
            let real = T::real;
            let (sin1, cos1) = t.sin_cos();
            let s2 = sin1 * real(0.3333333333333333) + real(1.0);
            let s3 = self.k * real(3.0);
            let mut s4 = [(real(0.0), real(0.0)); 10];
            for i in 0..10 {
                s4[i] = q[i].sin_cos();
            }
            let mut s5 = [real(0.0); 9];
            for i in 0..9 {
                s5[i] = self.k * s4[i].1;
            }
            let mut s6 = [real(0.0); 9];
            for i in 0..9 {
                s6[i] = (q[i + 1] - q[i]) * (q[i + 1] - q[i]);
            }
            let mut s7 = [real(0.0); 9];
            for i in 0..9 {
                s7[i] = s6[i] * (q[i + 1] - q[i]);
            }
            let mut s8 = [real(0.0); 10];
            for i in 0..10 {
                s8[i] = s2 * s4[i].0;
            }
            let mut s9 = [real(0.0); 9];
            for i in 0..9 {
                s9[i] = self.k * s6[i];
            }
            let mut s10 = [real(0.0); 10];
            for i in 0..10 {
                s10[i] = s2 * s4[i].1;
            }
            let mut s11 = [real(0.0); 10];
            for i in 0..10 {
                s11[i] = cos1 * s4[i].0 * real(0.3333333333333333);
            }
            let mut s12 = [real(0.0); 9];
            for i in 0..9 {
                s12[i] = s9[i] * v[i + 1] * real(3.0);
            }
            let mut s13 = [real(0.0); 9];
            for i in 0..9 {
                s13[i] = s9[i] * v[i] * real(3.0);
            }
            let mut s14 = [real(0.0); 8];
            for i in 0..8 {
                s14[i] = a[i + 1]
                    * (s5[i + 1] - self.k * (s7[i] - s7[i + 1]) - s8[i + 1]);
            }
            let mut s15 = [real(0.0); 8];
            for i in 0..8 {
                s15[i] = v[i + 1]
                    * (s13[i] - v[i + 1] * (s3 * (s6[i] + s6[i + 1]) + s10[i + 1])
                        + s12[i + 1] - s11[i + 1]);
            }
            let mut s16 = [real(0.0); 10];
            for i in 0..10 {
                s16[i] = v[i] * s4[i].0;
            }
            let s17 = (0..8)
                .fold((s5[0] + self.k * s7[0] - s8[0]) * a[0], |sum, i| sum + s14[i])
                - a[9] * (self.k * s7[8] + s8[9])
                + sin1 * (1..10).fold(s4[0].1, |sum, i| sum + s4[i].1)
                    * real(0.3333333333333333)
                - v[0] * (s12[0] - v[0] * (s9[0] * real(3.0) + s10[0]) - s11[0]);
            ::vi_core::support::step_density(
                time,
                (0..8).fold(s17, |sum, i| sum - s15[i])
                    - v[9] * (s13[8] - v[9] * (s9[8] * real(3.0) + s10[9]) - s11[9])
                    + (1..10).fold(s16[0], |sum, i| sum + s16[i]) * cos1
                        * real(0.3333333333333333),
            )
        }

        #[inline]
        fn flow(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            p: &::vi_core::SVector<T, 10>,
        ) -> ::core::result::Result<
            ::vi_core::lagrangian::Flow<10, T>,
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

    impl<T: ::vi_core::real::Real> ::vi_core::collocation::Collocation<10, T>
    for Chain<T> {
        type Mass = ::vi_core::linear::Banded<10, 1, T>;
        type PointMatrix = ::vi_core::linear::Tridiagonal<10, T>;
        const CONSTANT_MASS: bool = true;
        const SEPARABLE: bool = true;

        /// L_v, M, and
        ///
        /// `L_q + f_q[0] = k*cos(q[0]) + k*(q[1] - q[0])^3 - (sin(t)/3 + 1)*sin(q[0])`
        ///
        /// `L_q + f_q[1] = k*cos(q[1]) - k*(4*(q[1] - q[0])^3 - 4*(q[2] - q[1])^3)/4 - (sin(t)/3 + 1)*sin(q[1])`
        ///
        /// `L_q + f_q[2] = k*cos(q[2]) - k*(4*(q[2] - q[1])^3 - 4*(q[3] - q[2])^3)/4 - (sin(t)/3 + 1)*sin(q[2])`
        ///
        /// `L_q + f_q[3] = k*cos(q[3]) - k*(4*(q[3] - q[2])^3 - 4*(q[4] - q[3])^3)/4 - (sin(t)/3 + 1)*sin(q[3])`
        ///
        /// `L_q + f_q[4] = k*cos(q[4]) - k*(4*(q[4] - q[3])^3 - 4*(q[5] - q[4])^3)/4 - (sin(t)/3 + 1)*sin(q[4])`
        ///
        /// `L_q + f_q[5] = k*cos(q[5]) - k*(4*(q[5] - q[4])^3 - 4*(q[6] - q[5])^3)/4 - (sin(t)/3 + 1)*sin(q[5])`
        ///
        /// `L_q + f_q[6] = k*cos(q[6]) - k*(4*(q[6] - q[5])^3 - 4*(q[7] - q[6])^3)/4 - (sin(t)/3 + 1)*sin(q[6])`
        ///
        /// `L_q + f_q[7] = k*cos(q[7]) - k*(4*(q[7] - q[6])^3 - 4*(q[8] - q[7])^3)/4 - (sin(t)/3 + 1)*sin(q[7])`
        ///
        /// `L_q + f_q[8] = k*cos(q[8]) - k*(4*(q[8] - q[7])^3 - 4*(q[9] - q[8])^3)/4 - (sin(t)/3 + 1)*sin(q[8])`
        ///
        /// `L_q + f_q[9] = -k*(q[9] - q[8])^3 - (sin(t)/3 + 1)*sin(q[9])`
        ///
        /// 116 operations.
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::collocation::Point<10, T, Self::Mass> {
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, q_9_dot]: [T; 10] = (*v).into();
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
            ::vi_core::collocation::Point {
                momentum: ::vi_core::SVector::from([
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
                ]),
                force: ::vi_core::SVector::from([
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
                ]),
                mass: ::vi_core::linear::Banded {
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
                },
            }
        }

        /// M = ∂L_v/∂v, ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.
        ///
        /// 123 operations.
        #[inline(always)]
        fn point_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::collocation::PointDerivatives<Self::PointMatrix> {
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
            let [(sin19, cos19), (sin20, cos20), (_, cos21)] = T::sin_cos_each([
                q_7,
                q_8,
                q_9,
            ]);
            let s22 = s1 * s1;
            let s23 = self.k * s22 * real(3.0);
            let s24 = s2 * s2;
            let s25 = self.k * s24 * real(3.0);
            let s26 = s3 * s3;
            let s27 = self.k * s26 * real(3.0);
            let s28 = s4 * s4;
            let s29 = self.k * s28 * real(3.0);
            let s30 = s5 * s5;
            let s31 = self.k * s30 * real(3.0);
            let s32 = s6 * s6;
            let s33 = self.k * s32 * real(3.0);
            let s34 = s7 * s7;
            let s35 = self.k * s34 * real(3.0);
            let s36 = s8 * s8;
            let s37 = self.k * s36 * real(3.0);
            let s38 = s9 * s9;
            let s39 = self.k * s38 * real(3.0);
            let s40 = self.k * real(3.0);
            ::vi_core::collocation::PointDerivatives {
                momentum_dq: ::vi_core::linear::Tridiagonal {
                    lower: [
                        T::real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                    ],
                    diagonal: [
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                    ],
                    upper: [
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        T::real(0.0),
                    ],
                },
                mass: ::vi_core::linear::Tridiagonal {
                    lower: [
                        T::real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                    ],
                    diagonal: [
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                        self.m,
                    ],
                    upper: [
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        T::real(0.0),
                    ],
                },
                force_dq: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s23, s25, s27, s29, s31, s33, s35, s37, s39],
                    diagonal: [
                        -(s23 + s14 * cos11 + self.k * sin11),
                        -(s40 * (s22 + s24) + s14 * cos12 + self.k * sin12),
                        -(s40 * (s24 + s26) + s14 * cos13 + self.k * sin13),
                        -(s40 * (s26 + s28) + s14 * cos15 + self.k * sin15),
                        -(s40 * (s28 + s30) + s14 * cos16 + self.k * sin16),
                        -(s40 * (s30 + s32) + s14 * cos17 + self.k * sin17),
                        -(s40 * (s32 + s34) + s14 * cos18 + self.k * sin18),
                        -(s40 * (s34 + s36) + s14 * cos19 + self.k * sin19),
                        -(s40 * (s36 + s38) + s14 * cos20 + self.k * sin20),
                        -(s39 + s14 * cos21),
                    ],
                    upper: [s23, s25, s27, s29, s31, s33, s35, s37, s39, T::real(0.0)],
                },
                force_dv: ::vi_core::linear::Tridiagonal {
                    lower: [
                        T::real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                    ],
                    diagonal: [
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                    ],
                    upper: [
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        real(0.0),
                        T::real(0.0),
                    ],
                },
            }
        }

        /// `dE/dt = k*dot(q[0])*cos(q[0]) - (cos(q[0]) + cos(q[1]) + cos(q[2]) + cos(q[3]) + cos(q[4]) + cos(q[5]) + cos(q[6]) + cos(q[7]) + cos(q[8]) + cos(q[9]))*cos(t)/3 + k*dot(q[1])*cos(q[1]) + k*dot(q[2])*cos(q[2]) + k*dot(q[3])*cos(q[3]) + k*dot(q[4])*cos(q[4]) + k*dot(q[5])*cos(q[5]) + k*dot(q[6])*cos(q[6]) + k*dot(q[7])*cos(q[7]) + k*dot(q[8])*cos(q[8])`
        ///
        /// 49 operations.
        #[inline]
        fn power(
            &self,
            t: T,
            q: &::vi_core::SVector<T, 10>,
            v: &::vi_core::SVector<T, 10>,
        ) -> T {
            let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
            q_8_dot, _]: [T; 10] = (*v).into();
            let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q)
                .into();
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
            let [(_, cos9), (_, cos10), (_, cos11)] = T::sin_cos_each([q_8, q_9, t]);
            let s12 = (cos1 + cos2 + cos3 + cos4 + cos5 + cos6 + cos7 + cos8 + cos9
                + cos10) * cos11 * real(0.3333333333333333);
            let s13 = self.k * q_0_dot * cos1 + self.k * q_1_dot * cos2
                + self.k * q_2_dot * cos3 + self.k * q_3_dot * cos4;
            let s14 = s13 + self.k * q_4_dot * cos5 + self.k * q_5_dot * cos6
                + self.k * q_6_dot * cos7 + self.k * q_7_dot * cos8;
            s14 + self.k * q_8_dot * cos9 - s12
        }
    }

    impl ::vi_core::stepping::Convertible<10> for Chain<f64> {
        type In<T: ::vi_core::real::Real> = Chain<T>;
        #[inline(always)]
        fn convert<T: ::vi_core::real::Real>(&self) -> Chain<T> {
            self.convert()
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<10, T> for Chain<T> {
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

        /// `gd_minus = -h*v_q[0]*f_q[0]/2 - h*v_q[1]*f_q[1]/2 - h*v_q[2]*f_q[2]/2 - h*v_q[3]*f_q[3]/2 - h*v_q[4]*f_q[4]/2 - h*v_q[5]*f_q[5]/2 - h*v_q[6]*f_q[6]/2 - h*v_q[7]*f_q[7]/2 - h*v_q[8]*f_q[8]/2`
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

        /// `gd_plus = -h*v_q[0]*f_q[0]/2 - h*v_q[1]*f_q[1]/2 - h*v_q[2]*f_q[2]/2 - h*v_q[3]*f_q[3]/2 - h*v_q[4]*f_q[4]/2 - h*v_q[5]*f_q[5]/2 - h*v_q[6]*f_q[6]/2 - h*v_q[7]*f_q[7]/2 - h*v_q[8]*f_q[8]/2`
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

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<10, T>
    for Chain<T> {
        type Jacobian = ::vi_core::linear::Tridiagonal<10, T>;
        type StepMatrix = ::vi_core::linear::Tridiagonal<10, T>;
        const CONSTANT_JACOBIAN: bool = false;

        /// `residual_q[0] = L_v_q[0] - h*L_q[0]/2 - h*f_q[0]/2 - p0_q[0]_low - p0_q[0]`
        ///
        /// `residual_q[1] = L_v_q[1] - h*L_q[1]/2 - h*f_q[1]/2 - p0_q[1]_low - p0_q[1]`
        ///
        /// `residual_q[2] = L_v_q[2] - h*L_q[2]/2 - h*f_q[2]/2 - p0_q[2]_low - p0_q[2]`
        ///
        /// `residual_q[3] = L_v_q[3] - h*L_q[3]/2 - h*f_q[3]/2 - p0_q[3]_low - p0_q[3]`
        ///
        /// `residual_q[4] = L_v_q[4] - h*L_q[4]/2 - h*f_q[4]/2 - p0_q[4]_low - p0_q[4]`
        ///
        /// `residual_q[5] = L_v_q[5] - h*L_q[5]/2 - h*f_q[5]/2 - p0_q[5]_low - p0_q[5]`
        ///
        /// `residual_q[6] = L_v_q[6] - h*L_q[6]/2 - h*f_q[6]/2 - p0_q[6]_low - p0_q[6]`
        ///
        /// `residual_q[7] = L_v_q[7] - h*L_q[7]/2 - h*f_q[7]/2 - p0_q[7]_low - p0_q[7]`
        ///
        /// `residual_q[8] = L_v_q[8] - h*L_q[8]/2 - h*f_q[8]/2 - p0_q[8]_low - p0_q[8]`
        ///
        /// `residual_q[9] = L_v_q[9] - h*L_q[9]/2 - p0_q[9]_low - p0_q[9]`
        ///
        /// 294 operations.
        #[inline(always)]
        fn momentum_equation(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::MomentumEquation<10, T, Self::Jacobian> {
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
            let s43 = h * h;
            let s44 = self.k * s43;
            let s45 = s43 * real(0.25);
            let s46 = s44 * real(0.25);
            let s47 = s43 * real(0.75);
            let s48 = -(s42 * s47);
            let s49 = self.k * real(3.0);
            let s50 = s44 * real(0.75);
            let s51 = -(s50 * s25);
            let s52 = -(s50 * s27);
            let s53 = -(s50 * s29);
            let s54 = -(s50 * s31);
            let s55 = -(s50 * s33);
            let s56 = -(s50 * s35);
            let s57 = -(s50 * s37);
            let s58 = self.k * s39;
            let s59 = -(s58 * s47);
            ::vi_core::stepping::MomentumEquation {
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
                    lower: [T::real(0.0), s48, s51, s52, s53, s54, s55, s56, s57, s59],
                    diagonal: [
                        self.m + (s46 * sin12 + s45 * (s42 * real(3.0) + s15 * cos12)),
                        self.m + (s46 * sin13 + s45 * (s49 * (s23 + s25) + s15 * cos13)),
                        self.m + (s46 * sin14 + s45 * (s49 * (s25 + s27) + s15 * cos14)),
                        self.m + (s46 * sin16 + s45 * (s49 * (s27 + s29) + s15 * cos16)),
                        self.m + (s46 * sin17 + s45 * (s49 * (s29 + s31) + s15 * cos17)),
                        self.m + (s46 * sin18 + s45 * (s49 * (s31 + s33) + s15 * cos18)),
                        self.m + (s46 * sin19 + s45 * (s49 * (s33 + s35) + s15 * cos19)),
                        self.m + (s46 * sin20 + s45 * (s49 * (s35 + s37) + s15 * cos20)),
                        self.m + (s46 * sin21 + s45 * (s49 * (s37 + s39) + s15 * cos21)),
                        self.m + s45 * (s58 * real(3.0) + s15 * cos22),
                    ],
                    upper: [s48, s51, s52, s53, s54, s55, s56, s57, s59, T::real(0.0)],
                },
            }
        }

        /// The residual, its rounding scale, and
        ///
        /// `p1_q[0] − p0_q[0] = h*L_q[0] + h*f_q[0]`
        ///
        /// `p1_q[1] − p0_q[1] = h*L_q[1] + h*f_q[1]`
        ///
        /// `p1_q[2] − p0_q[2] = h*L_q[2] + h*f_q[2]`
        ///
        /// `p1_q[3] − p0_q[3] = h*L_q[3] + h*f_q[3]`
        ///
        /// `p1_q[4] − p0_q[4] = h*L_q[4] + h*f_q[4]`
        ///
        /// `p1_q[5] − p0_q[5] = h*L_q[5] + h*f_q[5]`
        ///
        /// `p1_q[6] − p0_q[6] = h*L_q[6] + h*f_q[6]`
        ///
        /// `p1_q[7] − p0_q[7] = h*L_q[7] + h*f_q[7]`
        ///
        /// `p1_q[8] − p0_q[8] = h*L_q[8] + h*f_q[8]`
        ///
        /// `p1_q[9] − p0_q[9] = h*L_q[9]`
        ///
        /// 393 operations.
        #[inline(never)]
        fn momentum_residual(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::MomentumResidual<10, T> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let q0 = &node.q.data.0[0];
            let q0_low = &node.q_low.data.0[0];
            let p0 = &node.p.data.0[0];
            let p0_low = &node.p_low.data.0[0];
            let v = &(*v).data.0[0];
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let s2 = t_mid.sin();
            let s3 = s2 * real(0.3333333333333333) + real(1.0);
            let s4 = self.k * h;
            let s5 = s4 * real(0.5);
            let s6 = s2.abs() * real(0.3333333333333333) + real(1.0);
            let s7 = h.abs() * real(0.5);
            let s8 = self.k.abs();
            let mut q_mid = [real(0.0); 10];
            for i in 0..10 {
                q_mid[i] = q0[i] + (s1 * v[i] + q0_low[i]);
            }
            let mut s9 = [(real(0.0), real(0.0)); 10];
            for i in 0..10 {
                s9[i] = q_mid[i].sin_cos();
            }
            let mut s10 = [real(0.0); 9];
            for i in 0..9 {
                s10[i] = (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s11 = [real(0.0); 9];
            for i in 0..9 {
                s11[i] = s10[i] * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s12 = [real(0.0); 10];
            for i in 0..10 {
                s12[i] = s3 * s9[i].0;
            }
            let mut s13 = [real(0.0); 8];
            for i in 0..8 {
                s13[i] = self.k * (s11[i] - s11[i + 1]) + s12[i + 1];
            }
            let mut s14 = [real(0.0); 9];
            for i in 0..9 {
                s14[i] = s4 * s9[i].1;
            }
            let mut s15 = [real(0.0); 10];
            for i in 0..10 {
                s15[i] = self.m * v[i] - p0[i];
            }
            let mut s16 = [real(0.0); 9];
            for i in 0..9 {
                s16[i] = s5 * s9[i].1;
            }
            let mut s17 = [real(0.0); 8];
            for i in 0..8 {
                s17[i] = s15[i + 1] - (p0_low[i + 1] - s1 * s13[i] + s16[i + 1]);
            }
            let mut s18 = [real(0.0); 8];
            for i in 0..8 {
                s18[i] = s14[i + 1] - h * s13[i];
            }
            let mut s19 = [real(0.0); 10];
            for i in 0..10 {
                s19[i] = q_mid[i].abs();
            }
            let mut s20 = [real(0.0); 10];
            for i in 0..10 {
                s20[i] = s6 * s9[i].0.abs();
            }
            let mut s21 = [real(0.0); 9];
            for i in 0..9 {
                s21[i] = s14[i].abs() * real(0.5);
            }
            let mut s22 = [real(0.0); 10];
            for i in 0..10 {
                s22[i] = p0[i].abs() + (self.m * v[i]).abs();
            }
            let mut s23 = [real(0.0); 8];
            for i in 0..8 {
                s23[i] = s19[i + 1] + s19[i + 2];
            }
            let mut s24 = [real(0.0); 8];
            for i in 0..8 {
                s24[i] = s10[i + 1] * s23[i] * real(3.0);
            }
            let s25 = self.k * s11[0] - s12[0];
            let s26 = self.k * s11[8] + s12[9];
            let s27 = s19[1] + s19[0];
            ::vi_core::stepping::MomentumResidual {
                residual: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s15[0] - (p0_low[0] + s1 * s25 + s16[0]);
                    for i in 0..8 {
                        entries[i + 1] = s17[i];
                    }
                    entries[9] = s15[9] - (p0_low[9] - s1 * s26);
                    entries
                }),
                scale: ::vi_core::SVector::from([
                    s22[0] + s7 * (s27 * (self.k * s10[0]).abs() * real(3.0) + s20[0])
                        + s21[0],
                    s22[1] + s7 * (s8 * (s10[0] * s27 * real(3.0) + s24[0]) + s20[1])
                        + s21[1],
                    s22[2] + s7 * (s8 * (s24[0] + s24[1]) + s20[2]) + s21[2],
                    s22[3] + s7 * (s8 * (s24[1] + s24[2]) + s20[3]) + s21[3],
                    s22[4] + s7 * (s8 * (s24[2] + s24[3]) + s20[4]) + s21[4],
                    s22[5] + s7 * (s8 * (s24[3] + s24[4]) + s20[5]) + s21[5],
                    s22[6] + s7 * (s8 * (s24[4] + s24[5]) + s20[6]) + s21[6],
                    s22[7] + s7 * (s8 * (s24[5] + s24[6]) + s20[7]) + s21[7],
                    s22[8] + s7 * (s8 * (s24[6] + s24[7]) + s20[8]) + s21[8],
                    s22[9] + s7 * (s23[7] * (self.k * s10[8]).abs() * real(3.0) + s20[9]),
                ]),
                increment: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = h * s25 + s14[0];
                    for i in 0..8 {
                        entries[i + 1] = s18[i];
                    }
                    entries[9] = -(h * s26);
                    entries
                }),
            }
        }

        /// How the residual and `p1 − p0` change with the coordinates of the node and with v.
        ///
        /// 326 operations.
        #[inline(never)]
        fn momentum_derivatives(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix> {
            let t0 = node.t;
            let t0_low = node.t_low;
            let q0 = &node.q.data.0[0];
            let q0_low = &node.q_low.data.0[0];
            let v = &(*v).data.0[0];
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let s2 = t_mid.sin() * real(0.3333333333333333) + real(1.0);
            let s3 = h * h;
            let s4 = self.k * s3;
            let s5 = s3 * real(0.25);
            let s6 = s4 * real(0.25);
            let s7 = s3 * real(0.75);
            let s8 = self.k * real(3.0);
            let s9 = s4 * real(0.75);
            let s10 = self.k * h;
            let s11 = s10 * real(0.5);
            let s12 = h * real(3.0);
            let s13 = h * real(1.5);
            let s14 = s10 * real(3.0);
            let s15 = s10 * real(1.5);
            let s16 = s3 * real(0.5);
            let s17 = s4 * real(0.5);
            let s18 = s3 * real(1.5);
            let s19 = s4 * real(1.5);
            let mut q_mid = [real(0.0); 10];
            for i in 0..10 {
                q_mid[i] = q0[i] + (s1 * v[i] + q0_low[i]);
            }
            let mut s20 = [(real(0.0), real(0.0)); 10];
            for i in 0..10 {
                s20[i] = q_mid[i].sin_cos();
            }
            let mut s21 = [real(0.0); 9];
            for i in 0..9 {
                s21[i] = (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s22 = [real(0.0); 10];
            for i in 0..10 {
                s22[i] = s2 * s20[i].1;
            }
            let mut s23 = [real(0.0); 9];
            for i in 0..9 {
                s23[i] = s6 * s20[i].0;
            }
            let mut s24 = [real(0.0); 8];
            for i in 0..8 {
                s24[i] = s8 * (s21[i] + s21[i + 1]) + s22[i + 1];
            }
            let mut s25 = [real(0.0); 8];
            for i in 0..8 {
                s25[i] = self.m + (s23[i + 1] + s5 * s24[i]);
            }
            let mut s26 = [real(0.0); 9];
            for i in 0..9 {
                s26[i] = s10 * s20[i].0;
            }
            let mut s27 = [real(0.0); 9];
            for i in 0..9 {
                s27[i] = s11 * s20[i].0;
            }
            let mut s28 = [real(0.0); 8];
            for i in 0..8 {
                s28[i] = s27[i + 1] + s1 * s24[i];
            }
            let mut s29 = [real(0.0); 8];
            for i in 0..8 {
                s29[i] = -(h * s24[i]) - s26[i + 1];
            }
            let mut s30 = [real(0.0); 9];
            for i in 0..9 {
                s30[i] = s17 * s20[i].0;
            }
            let mut s31 = [real(0.0); 8];
            for i in 0..8 {
                s31[i] = -(s16 * s24[i]) - s30[i + 1];
            }
            let s32 = self.k * s21[0];
            let s33 = s32 * real(3.0) + s22[0];
            let s34 = -(s32 * s7);
            let s35 = -(s9 * s21[1]);
            let s36 = -(s9 * s21[2]);
            let s37 = -(s9 * s21[3]);
            let s38 = -(s9 * s21[4]);
            let s39 = -(s9 * s21[5]);
            let s40 = -(s9 * s21[6]);
            let s41 = -(s9 * s21[7]);
            let s42 = self.k * s21[8];
            let s43 = -(s42 * s7);
            let s44 = s42 * real(3.0) + s22[9];
            let s45 = s32 * s12;
            let s46 = -(s32 * s13);
            let s47 = s14 * s21[1];
            let s48 = -(s15 * s21[1]);
            let s49 = s14 * s21[2];
            let s50 = -(s15 * s21[2]);
            let s51 = s14 * s21[3];
            let s52 = -(s15 * s21[3]);
            let s53 = s14 * s21[4];
            let s54 = -(s15 * s21[4]);
            let s55 = s14 * s21[5];
            let s56 = -(s15 * s21[5]);
            let s57 = s14 * s21[6];
            let s58 = -(s15 * s21[6]);
            let s59 = s14 * s21[7];
            let s60 = -(s15 * s21[7]);
            let s61 = s42 * s12;
            let s62 = -(s42 * s13);
            let s63 = s32 * s18;
            let s64 = s19 * s21[1];
            let s65 = s19 * s21[2];
            let s66 = s19 * s21[3];
            let s67 = s19 * s21[4];
            let s68 = s19 * s21[5];
            let s69 = s19 * s21[6];
            let s70 = s19 * s21[7];
            let s71 = s42 * s18;
            ::vi_core::stepping::MomentumDerivatives {
                residual_dq: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s46, s48, s50, s52, s54, s56, s58, s60, s62],
                    diagonal: {
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = s27[0] + s1 * s33;
                        for i in 0..8 {
                            entries[i + 1] = s28[i];
                        }
                        entries[9] = s1 * s44;
                        entries
                    },
                    upper: [s46, s48, s50, s52, s54, s56, s58, s60, s62, T::real(0.0)],
                },
                residual_dv: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s34, s35, s36, s37, s38, s39, s40, s41, s43],
                    diagonal: {
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = self.m + (s23[0] + s5 * s33);
                        for i in 0..8 {
                            entries[i + 1] = s25[i];
                        }
                        entries[9] = self.m + s5 * s44;
                        entries
                    },
                    upper: [s34, s35, s36, s37, s38, s39, s40, s41, s43, T::real(0.0)],
                },
                increment_dq: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s45, s47, s49, s51, s53, s55, s57, s59, s61],
                    diagonal: {
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = -(h * s33) - s26[0];
                        for i in 0..8 {
                            entries[i + 1] = s29[i];
                        }
                        entries[9] = -(h * s44);
                        entries
                    },
                    upper: [s45, s47, s49, s51, s53, s55, s57, s59, s61, T::real(0.0)],
                },
                increment_dv: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s63, s64, s65, s66, s67, s68, s69, s70, s71],
                    diagonal: {
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = -(s16 * s33) - s30[0];
                        for i in 0..8 {
                            entries[i + 1] = s31[i];
                        }
                        entries[9] = -(s16 * s44);
                        entries
                    },
                    upper: [s63, s64, s65, s66, s67, s68, s69, s70, s71, T::real(0.0)],
                },
            }
        }

        /// `E1 = L_v_q[0]*v_q[0] - L - h*L_t/2 + L_v_q[1]*v_q[1] + L_v_q[2]*v_q[2] + L_v_q[3]*v_q[3] + L_v_q[4]*v_q[4] + L_v_q[5]*v_q[5] + L_v_q[6]*v_q[6] + L_v_q[7]*v_q[7] + L_v_q[8]*v_q[8] + L_v_q[9]*v_q[9] + h*v_q[0]*f_q[0]/2 + h*v_q[1]*f_q[1]/2 + h*v_q[2]*f_q[2]/2 + h*v_q[3]*f_q[3]/2 + h*v_q[4]*f_q[4]/2 + h*v_q[5]*f_q[5]/2 + h*v_q[6]*f_q[6]/2 + h*v_q[7]*f_q[7]/2 + h*v_q[8]*f_q[8]/2`
        ///
        /// 169 operations.
        #[inline(always)]
        fn discrete_energy(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> T {
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
            let s3 = s2 * s2;
            let s4 = q_2_mid - q_1_mid;
            let s5 = s4 * s4;
            let s6 = q_3_mid - q_2_mid;
            let s7 = s6 * s6;
            let s8 = q_4_mid - q_3_mid;
            let s9 = s8 * s8;
            let s10 = q_5_mid - q_4_mid;
            let s11 = s10 * s10;
            let s12 = q_6_mid - q_5_mid;
            let s13 = s12 * s12;
            let s14 = q_7_mid - q_6_mid;
            let s15 = s14 * s14;
            let s16 = q_8_mid - q_7_mid;
            let s17 = s16 * s16;
            let s18 = q_9_mid - q_8_mid;
            let s19 = s18 * s18;
            let s20 = s3 * s3 + s5 * s5 + s7 * s7 + s9 * s9 + s11 * s11 + s13 * s13;
            let s21 = q_0_dot * q_0_dot;
            let s22 = q_1_dot * q_1_dot;
            let s23 = q_2_dot * q_2_dot;
            let s24 = q_3_dot * q_3_dot;
            let s25 = q_4_dot * q_4_dot;
            let s26 = q_5_dot * q_5_dot;
            let s27 = q_6_dot * q_6_dot;
            let s28 = q_7_dot * q_7_dot;
            let s29 = q_8_dot * q_8_dot;
            let s30 = q_9_dot * q_9_dot;
            let [(sin31, cos31), (_, cos32), (_, cos33), (_, cos34)] = T::sin_cos_each([
                t_mid,
                q_0_mid,
                q_1_mid,
                q_2_mid,
            ]);
            let [(_, cos35), (_, cos36), (_, cos37), (_, cos38)] = T::sin_cos_each([
                q_3_mid,
                q_4_mid,
                q_5_mid,
                q_6_mid,
            ]);
            let [(_, cos39), (_, cos40), (_, cos41)] = T::sin_cos_each([
                q_7_mid,
                q_8_mid,
                q_9_mid,
            ]);
            let s42 = cos32 + cos33 + cos34 + cos35 + cos36 + cos37 + cos38 + cos39
                + cos40 + cos41;
            let s43 = self.m
                * (s21 + s22 + s23 + s24 + s25 + s26 + s27 + s28 + s29 + s30)
                * real(0.5);
            let s44 = self.k * (s20 + s15 * s15 + s17 * s17 + s19 * s19) * real(0.25)
                + self.m * s21 + self.m * s22;
            let s45 = s44 + self.m * s23 + self.m * s24 + self.m * s25 + self.m * s26
                + self.m * s27 + self.m * s28;
            let s46 = self.k * real(0.5);
            let s47 = s46 * q_0_dot * cos32 + s46 * q_1_dot * cos33
                + s46 * q_2_dot * cos34 + s46 * q_3_dot * cos35;
            let s48 = s47 + s46 * q_4_dot * cos36 + s46 * q_5_dot * cos37
                + s46 * q_6_dot * cos38 + s46 * q_7_dot * cos39;
            s45 + self.m * s29 + self.m * s30 - s43
                - (sin31 * real(0.3333333333333333) + real(1.0)) * s42
                + (s48 + s46 * q_8_dot * cos40 - s42 * cos31 * real(0.16666666666666666))
                    * h
        }

        /// What the rounding of the residual is measured in, by running error analysis.
        #[cold]
        fn momentum_rounding(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::SVector<T, 10> {
            ::vi_core::support::momentum_rounding(
                &self.convert::<::vi_core::real::Rounded>(),
                node,
                h,
                v,
            )
        }
    }

    impl<T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<10, T>
    for Chain<T> {
        /// `energy_residual = h*L_t/2 - L - E0_low - E0 + h*v_q[0]*L_q[0]/2 + v_q[0]*p0_q[0]_low + v_q[0]*p0_q[0] + h*v_q[1]*L_q[1]/2 + v_q[1]*p0_q[1]_low + v_q[1]*p0_q[1] + h*v_q[2]*L_q[2]/2 + v_q[2]*p0_q[2]_low + v_q[2]*p0_q[2] + h*v_q[3]*L_q[3]/2 + v_q[3]*p0_q[3]_low + v_q[3]*p0_q[3] + h*v_q[4]*L_q[4]/2 + v_q[4]*p0_q[4]_low + v_q[4]*p0_q[4] + h*v_q[5]*L_q[5]/2 + v_q[5]*p0_q[5]_low + v_q[5]*p0_q[5] + h*v_q[6]*L_q[6]/2 + …`
        ///
        /// 732 operations.
        #[inline(never)]
        fn extended_system(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::ExtendedSystem<10, T, Self::Jacobian> {
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
            let s4 = h * h;
            let s5 = self.k * s4;
            let s6 = s4 * real(0.25);
            let s7 = s5 * real(0.25);
            let s8 = s4 * real(0.75);
            let s9 = self.k * real(3.0);
            let s10 = s5 * real(0.75);
            let s11 = self.k * real(0.75);
            let s12 = self.k * real(0.25);
            let s13 = self.k * real(1.5);
            let s14 = s13 * v[2];
            let s15 = s13 * v[4];
            let s16 = s13 * v[6];
            let mut q_mid = [real(0.0); 10];
            for i in 0..10 {
                q_mid[i] = q0[i] + (s1 * v[i] + q0_low[i]);
            }
            let mut s17 = [real(0.0); 10];
            for i in 0..10 {
                s17[i] = v[i] * p0_low[i];
            }
            let mut s18 = [real(0.0); 10];
            for i in 0..10 {
                s18[i] = v[i] * p0[i];
            }
            let mut s19 = [real(0.0); 9];
            for i in 0..9 {
                s19[i] = (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s20 = [real(0.0); 9];
            for i in 0..9 {
                s20[i] = s19[i] * s19[i];
            }
            let mut s21 = [real(0.0); 10];
            for i in 0..10 {
                s21[i] = v[i] * v[i];
            }
            let mut s22 = [(real(0.0), real(0.0)); 10];
            for i in 0..10 {
                s22[i] = q_mid[i].sin_cos();
            }
            let mut s23 = [real(0.0); 9];
            for i in 0..9 {
                s23[i] = s19[i] * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s24 = [real(0.0); 10];
            for i in 0..10 {
                s24[i] = s3 * s22[i].0;
            }
            let mut s25 = [real(0.0); 8];
            for i in 0..8 {
                s25[i] = self.k * (s23[i] - s23[i + 1]);
            }
            let mut s26 = [real(0.0); 10];
            for i in 0..10 {
                s26[i] = self.m * v[i] - p0[i];
            }
            let mut s27 = [real(0.0); 9];
            for i in 0..9 {
                s27[i] = self.k * s22[i].1 * s1;
            }
            let mut s28 = [real(0.0); 8];
            for i in 0..8 {
                s28[i] = s26[i + 1]
                    - (p0_low[i + 1] - s1 * (s25[i] + s24[i + 1]) + s27[i + 1]);
            }
            let mut s29 = [real(0.0); 8];
            for i in 0..8 {
                s29[i] = v[i + 1] * (s25[i] + s24[i + 1]);
            }
            let mut s30 = [real(0.0); 10];
            for i in 0..10 {
                s30[i] = s3 * s22[i].1;
            }
            let mut s31 = [real(0.0); 9];
            for i in 0..9 {
                s31[i] = s7 * s22[i].0;
            }
            let mut s32 = [real(0.0); 8];
            for i in 0..8 {
                s32[i] = s9 * (s19[i] + s19[i + 1]) + s30[i + 1];
            }
            let mut s33 = [real(0.0); 8];
            for i in 0..8 {
                s33[i] = self.m + (s31[i + 1] + s6 * s32[i]);
            }
            let mut s34 = [real(0.0); 10];
            for i in 0..10 {
                s34[i] = s24[i] * real(0.5);
            }
            let mut s35 = [real(0.0); 9];
            for i in 0..9 {
                s35[i] = self.k * s22[i].1 * real(0.5);
            }
            let mut s36 = [real(0.0); 10];
            for i in 0..10 {
                s36[i] = cos2 * s22[i].0 * real(0.08333333333333333);
            }
            let mut s37 = [real(0.0); 9];
            for i in 0..9 {
                s37[i] = s11 * v[i + 1] * s19[i];
            }
            let mut s38 = [real(0.0); 9];
            for i in 0..9 {
                s38[i] = s36[i] + s12 * v[i] * s22[i].0;
            }
            let mut s39 = [real(0.0); 8];
            for i in 0..8 {
                s39[i] = s25[i] * real(0.5) + s34[i + 1] - s35[i + 1];
            }
            let mut s40 = [real(0.0); 9];
            for i in 0..9 {
                s40[i] = s11 * v[i] * s19[i];
            }
            let mut s41 = [real(0.0); 8];
            for i in 0..8 {
                s41[i] = v[i + 1] * s32[i] * real(0.25);
            }
            let mut s42 = [real(0.0); 8];
            for i in 0..8 {
                s42[i] = s39[i] + (s38[i + 1] - s40[i] - s37[i + 1] + s41[i]) * h;
            }
            let mut s43 = [real(0.0); 8];
            for i in 0..8 {
                s43[i] = s39[i] + (s40[i] + s37[i + 1] - s41[i] - s36[i + 1]) * h;
            }
            let mut s44 = [real(0.0); 10];
            for i in 0..10 {
                s44[i] = v[i] * s22[i].0;
            }
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
            let s53 = -(s51 * s8);
            let s54 = -(s10 * s19[1]);
            let s55 = -(s10 * s19[2]);
            let s56 = -(s10 * s19[3]);
            let s57 = -(s10 * s19[4]);
            let s58 = -(s10 * s19[5]);
            let s59 = -(s10 * s19[6]);
            let s60 = -(s10 * s19[7]);
            let s61 = self.k * s19[8];
            let s62 = -(s61 * s8);
            let s63 = s61 * real(3.0) + s30[9];
            let s64 = s34[0] - s46 * real(0.5) - s35[0];
            let s65 = v[0] * s52 * real(0.25);
            let s66 = s48 * real(0.5) + s34[9];
            let s67 = v[9] * s63 * real(0.25);
            let s68 = -(s21[0] * s52) - s21[2] * s32[1] - s21[4] * s32[3]
                - s21[6] * s32[5] - s21[9] * s63 - sin2 * s45 * real(0.3333333333333333);
            let s69 = s68 * real(0.25) + (s13 * v[9] * s19[8] - s41[7]) * v[8]
                + (s16 * s19[6] + s13 * v[8] * s19[7] - s41[6]) * v[7];
            let s70 = s69 + (s15 * s19[4] + s16 * s19[5] - s41[4]) * v[5]
                + (s14 * s19[2] + s15 * s19[3] - s41[2]) * v[3];
            ::vi_core::stepping::ExtendedSystem {
                momentum: ::vi_core::stepping::MomentumEquation {
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
                            s53,
                            s54,
                            s55,
                            s56,
                            s57,
                            s58,
                            s59,
                            s60,
                            s62,
                        ],
                        diagonal: {
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = self.m + (s31[0] + s6 * s52);
                            for i in 0..8 {
                                entries[i + 1] = s33[i];
                            }
                            entries[9] = self.m + s6 * s63;
                            entries
                        },
                        upper: [
                            s53,
                            s54,
                            s55,
                            s56,
                            s57,
                            s58,
                            s59,
                            s60,
                            s62,
                            T::real(0.0),
                        ],
                    },
                },
                residual_dh: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s64 + (s38[0] - s37[0] + s65) * h;
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
                energy_dh: s70 + (s13 * v[0] * s19[0] + s14 * s19[1] - s41[0]) * v[1]
                    - (1..10).fold(s44[0], |sum, i| sum + s44[i]) * cos2
                        * real(0.16666666666666666),
            }
        }

        /// Both residuals, their rounding scales, and
        ///
        /// `E1 − E0 = h*v_q[0]*f_q[0] - h*L_t + h*v_q[1]*f_q[1] + h*v_q[2]*f_q[2] + h*v_q[3]*f_q[3] + h*v_q[4]*f_q[4] + h*v_q[5]*f_q[5] + h*v_q[6]*f_q[6] + h*v_q[7]*f_q[7] + h*v_q[8]*f_q[8]`
        ///
        /// 704 operations.
        #[inline(never)]
        fn extended_residual(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::ExtendedResidual<10, T> {
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
            let s4 = self.k * h;
            let s5 = s4 * real(0.5);
            let s6 = sin2.abs() * real(0.3333333333333333);
            let s7 = s6 + real(1.0);
            let s8 = h.abs() * real(0.5);
            let s9 = self.k.abs();
            let mut q_mid = [real(0.0); 10];
            for i in 0..10 {
                q_mid[i] = q0[i] + (s1 * v[i] + q0_low[i]);
            }
            let mut s10 = [real(0.0); 10];
            for i in 0..10 {
                s10[i] = v[i] * p0_low[i];
            }
            let mut s11 = [real(0.0); 10];
            for i in 0..10 {
                s11[i] = v[i] * p0[i];
            }
            let mut s12 = [real(0.0); 9];
            for i in 0..9 {
                s12[i] = (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s13 = [real(0.0); 9];
            for i in 0..9 {
                s13[i] = s12[i] * s12[i];
            }
            let mut s14 = [real(0.0); 10];
            for i in 0..10 {
                s14[i] = v[i] * v[i];
            }
            let mut s15 = [(real(0.0), real(0.0)); 10];
            for i in 0..10 {
                s15[i] = q_mid[i].sin_cos();
            }
            let mut s16 = [real(0.0); 9];
            for i in 0..9 {
                s16[i] = s12[i] * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s17 = [real(0.0); 10];
            for i in 0..10 {
                s17[i] = s3 * s15[i].0;
            }
            let mut s18 = [real(0.0); 8];
            for i in 0..8 {
                s18[i] = self.k * (s16[i] - s16[i + 1]) + s17[i + 1];
            }
            let mut s19 = [real(0.0); 9];
            for i in 0..9 {
                s19[i] = s4 * s15[i].1;
            }
            let mut s20 = [real(0.0); 10];
            for i in 0..10 {
                s20[i] = self.m * v[i] - p0[i];
            }
            let mut s21 = [real(0.0); 9];
            for i in 0..9 {
                s21[i] = s5 * s15[i].1;
            }
            let mut s22 = [real(0.0); 8];
            for i in 0..8 {
                s22[i] = s20[i + 1] - (p0_low[i + 1] - s1 * s18[i] + s21[i + 1]);
            }
            let mut s23 = [real(0.0); 8];
            for i in 0..8 {
                s23[i] = v[i + 1] * s18[i];
            }
            let mut s24 = [real(0.0); 8];
            for i in 0..8 {
                s24[i] = s19[i + 1] - h * s18[i];
            }
            let mut s25 = [real(0.0); 9];
            for i in 0..9 {
                s25[i] = self.k * v[i] * s15[i].1;
            }
            let mut s26 = [real(0.0); 10];
            for i in 0..10 {
                s26[i] = q_mid[i].abs();
            }
            let mut s27 = [real(0.0); 10];
            for i in 0..10 {
                s27[i] = s7 * s15[i].0.abs();
            }
            let mut s28 = [real(0.0); 9];
            for i in 0..9 {
                s28[i] = s19[i].abs() * real(0.5);
            }
            let mut s29 = [real(0.0); 10];
            for i in 0..10 {
                s29[i] = p0[i].abs() + (self.m * v[i]).abs();
            }
            let mut s30 = [real(0.0); 8];
            for i in 0..8 {
                s30[i] = s26[i + 1] + s26[i + 2];
            }
            let mut s31 = [real(0.0); 8];
            for i in 0..8 {
                s31[i] = s12[i + 1] * s30[i] * real(3.0);
            }
            let mut s32 = [real(0.0); 10];
            for i in 0..10 {
                s32[i] = s11[i].abs();
            }
            let mut s33 = [real(0.0); 8];
            for i in 0..8 {
                s33[i] = s30[i]
                    * ((q_mid[i + 1] - q_mid[i + 2]) * (q_mid[i + 1] - q_mid[i + 2])
                        * (q_mid[i + 1] - q_mid[i + 2]))
                        .abs() * real(4.0);
            }
            let mut s34 = [real(0.0); 10];
            for i in 0..10 {
                s34[i] = s15[i].1.abs();
            }
            let mut s35 = [real(0.0); 10];
            for i in 0..10 {
                s35[i] = (h * v[i]).abs();
            }
            let s36 = (1..10).fold(s14[0], |sum, i| sum + s14[i]);
            let s37 = (1..10).fold(s15[0].1, |sum, i| sum + s15[i].1);
            let s38 = self.k * s16[0] - s17[0];
            let s39 = self.k * s16[8] + s17[9];
            let s40 = (1..10).fold(s11[0], |sum, i| sum + s11[i])
                + self.k * (1..9).fold(s13[0], |sum, i| sum + s13[i]) * real(0.25)
                - energy0 - self.m * s36 * real(0.5) - s3 * s37;
            let s41 = s37 * cos2 * real(0.3333333333333333);
            let s42 = s26[1] + s26[0];
            let s43 = s42 * (self.k * s12[0]).abs() * real(3.0) + s27[0];
            let s44 = s9 * (s12[0] * s42 * real(3.0) + s31[0]) + s27[1];
            let s45 = s9 * (s31[0] + s31[1]) + s27[2];
            let s46 = s9 * (s31[1] + s31[2]) + s27[3];
            let s47 = s9 * (s31[2] + s31[3]) + s27[4];
            let s48 = s9 * (s31[3] + s31[4]) + s27[5];
            let s49 = s9 * (s31[4] + s31[5]) + s27[6];
            let s50 = s9 * (s31[5] + s31[6]) + s27[7];
            let s51 = s9 * (s31[6] + s31[7]) + s27[8];
            let s52 = s30[7] * (self.k * s12[8]).abs() * real(3.0) + s27[9];
            let s53 = (0..10).fold(energy0.abs(), |sum, i| sum + s32[i])
                + s9 * (0..8).fold(s42 * s16[0].abs() * real(4.0), |sum, i| sum + s33[i])
                    * real(0.25) + self.m.abs() * s36 * real(0.5)
                + s43 * s35[0] * real(0.5);
            let s54 = s53 + s44 * s35[1] * real(0.5) + s45 * s35[2] * real(0.5)
                + s46 * s35[3] * real(0.5) + s47 * s35[4] * real(0.5);
            let s55 = s54 + s48 * s35[5] * real(0.5) + s49 * s35[6] * real(0.5)
                + s50 * s35[7] * real(0.5) + s51 * s35[8] * real(0.5);
            ::vi_core::stepping::ExtendedResidual {
                residual: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s20[0] - (p0_low[0] + s1 * s38 + s21[0]);
                    for i in 0..8 {
                        entries[i + 1] = s22[i];
                    }
                    entries[9] = s20[9] - (p0_low[9] - s1 * s39);
                    entries
                }),
                scale: ::vi_core::SVector::from([
                    s29[0] + s8 * s43 + s28[0],
                    s29[1] + s8 * s44 + s28[1],
                    s29[2] + s8 * s45 + s28[2],
                    s29[3] + s8 * s46 + s28[3],
                    s29[4] + s8 * s47 + s28[4],
                    s29[5] + s8 * s48 + s28[5],
                    s29[6] + s8 * s49 + s28[6],
                    s29[7] + s8 * s50 + s28[7],
                    s29[8] + s8 * s51 + s28[8],
                    s29[9] + s8 * s52,
                ]),
                energy_residual: s40
                    + ((1..10).fold(s10[0], |sum, i| sum + s10[i]) - energy0_low
                        + s1
                            * ((0..8).fold(s41 + v[0] * s38, |sum, i| sum - s23[i])
                                - v[9] * s39)),
                energy_scale: s55 + s52 * s35[9] * real(0.5)
                    + (s6 + (h * cos2).abs() * real(0.16666666666666666) + real(1.0))
                        * (1..10).fold(s34[0], |sum, i| sum + s34[i]),
                increment: ::vi_core::stepping::Increment {
                    momentum: ::vi_core::SVector::from({
                        let mut entries = [T::real(0.0); 10];
                        entries[0] = h * s38 + s19[0];
                        for i in 0..8 {
                            entries[i + 1] = s24[i];
                        }
                        entries[9] = -(h * s39);
                        entries
                    }),
                    energy: ((1..9).fold(s25[0], |sum, i| sum + s25[i]) - s41) * h,
                },
            }
        }

        /// How both residuals, `p1 − p0` and `E1 − E0` change with the coordinates of the node, v and h.
        ///
        /// 1004 operations.
        #[inline(never)]
        fn extended_derivatives(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::ExtendedDerivatives<
            10,
            T,
            Self::Jacobian,
            Self::StepMatrix,
        > {
            let t0 = node.t;
            let t0_low = node.t_low;
            let q0 = &node.q.data.0[0];
            let q0_low = &node.q_low.data.0[0];
            let v = &(*v).data.0[0];
            let real = T::real;
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let (sin2, cos2) = t_mid.sin_cos();
            let s3 = sin2 * real(0.3333333333333333) + real(1.0);
            let s4 = h * h;
            let s5 = self.k * s4;
            let s6 = s4 * real(0.25);
            let s7 = s5 * real(0.25);
            let s8 = s4 * real(0.75);
            let s9 = self.k * real(3.0);
            let s10 = s5 * real(0.75);
            let s11 = self.k * h;
            let s12 = self.k * real(0.75);
            let s13 = self.k * real(0.25);
            let s14 = self.k * real(0.5);
            let s15 = self.k * real(1.5);
            let s16 = s11 * real(0.5);
            let s17 = h * real(3.0);
            let s18 = h * real(1.5);
            let s19 = s11 * real(3.0);
            let s20 = s11 * real(1.5);
            let s21 = s4 * real(0.5);
            let s22 = s5 * real(0.5);
            let s23 = s4 * real(1.5);
            let s24 = s5 * real(1.5);
            let s25 = cos2 * real(0.3333333333333333);
            let s26 = cos2 * real(0.16666666666666666);
            let mut q_mid = [real(0.0); 10];
            for i in 0..10 {
                q_mid[i] = q0[i] + (s1 * v[i] + q0_low[i]);
            }
            let mut s27 = [(real(0.0), real(0.0)); 10];
            for i in 0..10 {
                s27[i] = q_mid[i].sin_cos();
            }
            let mut s28 = [real(0.0); 9];
            for i in 0..9 {
                s28[i] = (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s29 = [real(0.0); 9];
            for i in 0..9 {
                s29[i] = s28[i] * (q_mid[i + 1] - q_mid[i]);
            }
            let mut s30 = [real(0.0); 10];
            for i in 0..10 {
                s30[i] = s3 * s27[i].0;
            }
            let mut s31 = [real(0.0); 9];
            for i in 0..9 {
                s31[i] = self.k * s27[i].1;
            }
            let mut s32 = [real(0.0); 9];
            for i in 0..9 {
                s32[i] = self.k * v[i] * s27[i].1;
            }
            let mut s33 = [real(0.0); 10];
            for i in 0..10 {
                s33[i] = s3 * s27[i].1;
            }
            let mut s34 = [real(0.0); 9];
            for i in 0..9 {
                s34[i] = s7 * s27[i].0;
            }
            let mut s35 = [real(0.0); 8];
            for i in 0..8 {
                s35[i] = s9 * (s28[i] + s28[i + 1]) + s33[i + 1];
            }
            let mut s36 = [real(0.0); 8];
            for i in 0..8 {
                s36[i] = self.m + (s34[i + 1] + s6 * s35[i]);
            }
            let mut s37 = [real(0.0); 10];
            for i in 0..10 {
                s37[i] = s30[i] * real(0.5);
            }
            let mut s38 = [real(0.0); 9];
            for i in 0..9 {
                s38[i] = s31[i] * real(0.5);
            }
            let mut s39 = [real(0.0); 10];
            for i in 0..10 {
                s39[i] = cos2 * s27[i].0;
            }
            let mut s40 = [real(0.0); 10];
            for i in 0..10 {
                s40[i] = s39[i] * real(0.08333333333333333);
            }
            let mut s41 = [real(0.0); 9];
            for i in 0..9 {
                s41[i] = s12 * v[i + 1] * s28[i];
            }
            let mut s42 = [real(0.0); 9];
            for i in 0..9 {
                s42[i] = s40[i] + s13 * v[i] * s27[i].0;
            }
            let mut s43 = [real(0.0); 8];
            for i in 0..8 {
                s43[i] = s14 * (s29[i] - s29[i + 1]) + s37[i + 1] - s38[i + 1];
            }
            let mut s44 = [real(0.0); 9];
            for i in 0..9 {
                s44[i] = s12 * v[i] * s28[i];
            }
            let mut s45 = [real(0.0); 8];
            for i in 0..8 {
                s45[i] = v[i + 1] * s35[i] * real(0.25);
            }
            let mut s46 = [real(0.0); 8];
            for i in 0..8 {
                s46[i] = s43[i] + (s42[i + 1] - s44[i] - s41[i + 1] + s45[i]) * h;
            }
            let mut s47 = [real(0.0); 8];
            for i in 0..8 {
                s47[i] = s43[i] + (s44[i] + s41[i + 1] - s45[i] - s40[i + 1]) * h;
            }
            let mut s48 = [real(0.0); 10];
            for i in 0..10 {
                s48[i] = v[i] * v[i];
            }
            let mut s49 = [real(0.0); 10];
            for i in 0..10 {
                s49[i] = v[i] * s27[i].0;
            }
            let mut s50 = [real(0.0); 9];
            for i in 0..9 {
                s50[i] = s15 * v[i] * s28[i];
            }
            let mut s51 = [real(0.0); 9];
            for i in 0..9 {
                s51[i] = s15 * v[i + 1] * s28[i];
            }
            let mut s52 = [real(0.0); 8];
            for i in 0..8 {
                s52[i] = s50[i] + s51[i + 1];
            }
            let mut s53 = [real(0.0); 9];
            for i in 0..9 {
                s53[i] = s11 * s27[i].0;
            }
            let mut s54 = [real(0.0); 9];
            for i in 0..9 {
                s54[i] = s16 * s27[i].0;
            }
            let mut s55 = [real(0.0); 8];
            for i in 0..8 {
                s55[i] = s54[i + 1] + s1 * s35[i];
            }
            let mut s56 = [real(0.0); 8];
            for i in 0..8 {
                s56[i] = -(h * s35[i]) - s53[i + 1];
            }
            let mut s57 = [real(0.0); 9];
            for i in 0..9 {
                s57[i] = s22 * s27[i].0;
            }
            let mut s58 = [real(0.0); 8];
            for i in 0..8 {
                s58[i] = -(s21 * s35[i]) - s57[i + 1];
            }
            let mut s59 = [real(0.0); 10];
            for i in 0..10 {
                s59[i] = s39[i] * real(0.16666666666666666);
            }
            let mut s60 = [real(0.0); 8];
            for i in 0..8 {
                s60[i] = self.k * (s29[i] - s29[i + 1]);
            }
            let mut s61 = [real(0.0); 8];
            for i in 0..8 {
                s61[i] = s52[i] - v[i + 1] * s35[i] * real(0.5) - s59[i + 1];
            }
            let mut s62 = [real(0.0); 8];
            for i in 0..8 {
                s62[i] = s60[i] + s30[i + 1] + s61[i] * h;
            }
            let mut s63 = [real(0.0); 9];
            for i in 0..9 {
                s63[i] = s14 * v[i] * s27[i].0;
            }
            let mut s64 = [real(0.0); 8];
            for i in 0..8 {
                s64[i] = s31[i + 1] - s60[i] - s30[i + 1] + (s61[i] - s63[i + 1]) * h;
            }
            let mut s65 = [real(0.0); 9];
            for i in 0..9 {
                s65[i] = (s25 - self.k * v[i]) * s27[i].0 * h;
            }
            let mut s66 = [real(0.0); 9];
            for i in 0..9 {
                s66[i] = (s31[i] + (s26 - self.k * v[i] * real(0.5)) * s27[i].0 * h) * h;
            }
            let mut s67 = [real(0.0); 9];
            for i in 0..9 {
                s67[i] = s14 * s48[i] * s27[i].0;
            }
            let s68 = (1..10).fold(s27[0].1, |sum, i| sum + s27[i].1);
            let s69 = self.k * s29[0];
            let s70 = self.k * s29[8];
            let s71 = self.k * s28[0];
            let s72 = s71 * real(3.0) + s33[0];
            let s73 = -(s71 * s8);
            let s74 = -(s10 * s28[1]);
            let s75 = -(s10 * s28[2]);
            let s76 = -(s10 * s28[3]);
            let s77 = -(s10 * s28[4]);
            let s78 = -(s10 * s28[5]);
            let s79 = -(s10 * s28[6]);
            let s80 = -(s10 * s28[7]);
            let s81 = self.k * s28[8];
            let s82 = -(s81 * s8);
            let s83 = s81 * real(3.0) + s33[9];
            let s84 = s37[0] - s69 * real(0.5) - s38[0];
            let s85 = v[0] * s72;
            let s86 = s85 * real(0.25);
            let s87 = s70 * real(0.5) + s37[9];
            let s88 = v[9] * s83;
            let s89 = s88 * real(0.25);
            let s90 = sin2 * s68;
            let s91 = (1..10).fold(s49[0], |sum, i| sum + s49[i]) * cos2
                * real(0.16666666666666666);
            let s92 = -(s48[0] * s72) - s48[2] * s35[1] - s48[4] * s35[3]
                - s48[6] * s35[5] - s48[9] * s83 - s90 * real(0.3333333333333333);
            let s93 = s92 * real(0.25) + (s51[8] - s45[7]) * v[8]
                + (s52[6] - s45[6]) * v[7] + (s52[4] - s45[4]) * v[5]
                + (s52[2] - s45[2]) * v[3];
            let s94 = s71 * s17;
            let s95 = -(s71 * s18);
            let s96 = s19 * s28[1];
            let s97 = -(s20 * s28[1]);
            let s98 = s19 * s28[2];
            let s99 = -(s20 * s28[2]);
            let s100 = s19 * s28[3];
            let s101 = -(s20 * s28[3]);
            let s102 = s19 * s28[4];
            let s103 = -(s20 * s28[4]);
            let s104 = s19 * s28[5];
            let s105 = -(s20 * s28[5]);
            let s106 = s19 * s28[6];
            let s107 = -(s20 * s28[6]);
            let s108 = s19 * s28[7];
            let s109 = -(s20 * s28[7]);
            let s110 = s81 * s17;
            let s111 = -(s81 * s18);
            let s112 = s71 * s23;
            let s113 = s24 * s28[1];
            let s114 = s24 * s28[2];
            let s115 = s24 * s28[3];
            let s116 = s24 * s28[4];
            let s117 = s24 * s28[5];
            let s118 = s24 * s28[6];
            let s119 = s24 * s28[7];
            let s120 = s81 * s23;
            let s121 = s51[0] - s85 * real(0.5) - s59[0];
            let s122 = s70 + s30[9];
            let s123 = (s50[8] - s88 * real(0.5) - s59[9]) * h;
            ::vi_core::stepping::ExtendedDerivatives {
                momentum: ::vi_core::stepping::MomentumDerivatives {
                    residual_dq: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s95,
                            s97,
                            s99,
                            s101,
                            s103,
                            s105,
                            s107,
                            s109,
                            s111,
                        ],
                        diagonal: {
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = s54[0] + s1 * s72;
                            for i in 0..8 {
                                entries[i + 1] = s55[i];
                            }
                            entries[9] = s1 * s83;
                            entries
                        },
                        upper: [
                            s95,
                            s97,
                            s99,
                            s101,
                            s103,
                            s105,
                            s107,
                            s109,
                            s111,
                            T::real(0.0),
                        ],
                    },
                    residual_dv: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s73,
                            s74,
                            s75,
                            s76,
                            s77,
                            s78,
                            s79,
                            s80,
                            s82,
                        ],
                        diagonal: {
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = self.m + (s34[0] + s6 * s72);
                            for i in 0..8 {
                                entries[i + 1] = s36[i];
                            }
                            entries[9] = self.m + s6 * s83;
                            entries
                        },
                        upper: [
                            s73,
                            s74,
                            s75,
                            s76,
                            s77,
                            s78,
                            s79,
                            s80,
                            s82,
                            T::real(0.0),
                        ],
                    },
                    increment_dq: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s94,
                            s96,
                            s98,
                            s100,
                            s102,
                            s104,
                            s106,
                            s108,
                            s110,
                        ],
                        diagonal: {
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = -(h * s72) - s53[0];
                            for i in 0..8 {
                                entries[i + 1] = s56[i];
                            }
                            entries[9] = -(h * s83);
                            entries
                        },
                        upper: [
                            s94,
                            s96,
                            s98,
                            s100,
                            s102,
                            s104,
                            s106,
                            s108,
                            s110,
                            T::real(0.0),
                        ],
                    },
                    increment_dv: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s112,
                            s113,
                            s114,
                            s115,
                            s116,
                            s117,
                            s118,
                            s119,
                            s120,
                        ],
                        diagonal: {
                            let mut entries = [T::real(0.0); 10];
                            entries[0] = -(s21 * s72) - s57[0];
                            for i in 0..8 {
                                entries[i + 1] = s58[i];
                            }
                            entries[9] = -(s21 * s83);
                            entries
                        },
                        upper: [
                            s112,
                            s113,
                            s114,
                            s115,
                            s116,
                            s117,
                            s118,
                            s119,
                            s120,
                            T::real(0.0),
                        ],
                    },
                },
                residual_dh: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s84 + (s42[0] - s41[0] + s86) * h;
                    for i in 0..8 {
                        entries[i + 1] = s46[i];
                    }
                    entries[9] = s87 + (s40[9] - s44[8] + s89) * h;
                    entries
                }),
                increment_dh: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s69 + s31[0] - s30[0] + (s121 - s63[0]) * h;
                    for i in 0..8 {
                        entries[i + 1] = s64[i];
                    }
                    entries[9] = s123 - s122;
                    entries
                }),
                energy_dq: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s30[0] - s69 + s121 * h;
                    for i in 0..8 {
                        entries[i + 1] = s62[i];
                    }
                    entries[9] = s122 + s123;
                    entries
                }),
                energy_dv: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    entries[0] = s84 + (s41[0] - s86 - s40[0]) * h;
                    for i in 0..8 {
                        entries[i + 1] = s47[i];
                    }
                    entries[9] = s87 + (s44[8] - s89 - s40[9]) * h;
                    entries
                }),
                energy_dh: s93 + (s52[0] - s45[0]) * v[1] - s91,
                energy_increment_dq: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    for i in 0..9 {
                        entries[i] = s65[i];
                    }
                    entries[9] = s39[9] * (h * real(0.3333333333333333));
                    entries
                }),
                energy_increment_dv: ::vi_core::SVector::from({
                    let mut entries = [T::real(0.0); 10];
                    for i in 0..9 {
                        entries[i] = s66[i];
                    }
                    entries[9] = s39[9] * (s4 * real(0.16666666666666666));
                    entries
                }),
                energy_increment_dh: (1..9).fold(s32[0], |sum, i| sum + s32[i])
                    - s68 * cos2 * real(0.3333333333333333)
                    + ((0..9)
                        .fold(s90 * real(0.16666666666666666), |sum, i| sum - s67[i])
                        + s91) * h,
            }
        }

        /// What the rounding of both residuals is measured in, by running error analysis.
        #[cold]
        fn extended_rounding(
            &self,
            node: &::vi_core::node::Node<10, T>,
            h: T,
            v: &::vi_core::SVector<T, 10>,
        ) -> ::vi_core::stepping::Rounding<10, T> {
            ::vi_core::support::extended_rounding(
                &self.convert::<::vi_core::real::Rounded>(),
                node,
                h,
                v,
            )
        }
    }

    impl ::vi_core::stepping::Discretized<10> for Chain<f64> {
        type Steps<T: ::vi_core::real::Real> = Chain<T>;
        #[inline(always)]
        fn steps<T: ::vi_core::real::Real>(&self) -> Chain<T> {
            self.convert()
        }
    }

    impl ::vi_core::stepping::Batch<10> for Chain<f64> {
        type Rows<const W: usize> = Chain<[f64; W]>;
        fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
            Chain {
                m: ::core::array::from_fn(|index| systems[index].m),
                k: ::core::array::from_fn(|index| systems[index].k),
            }
        }

        #[inline(always)]
        fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self {
            Chain {
                m: rows.m[index],
                k: rows.k[index],
            }
        }
    }
};
