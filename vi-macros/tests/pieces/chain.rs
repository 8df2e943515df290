/// Pendula in a row, driven: what is the same for all of them is a loop.
///
/// Discretized by the rule `midpoint`. What the generator found:
///
/// * Not autonomous: `L` depends on the time `t`; no force acts
/// * `L = T(v) + U(t, q)` with a constant mass matrix
/// * The step's equation in `v` is nonlinear: its Jacobian `A` depends on `v`, and Newton's iteration gives the step
/// * `A` is tridiagonal, symmetric; solved by elimination from both ends
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(non_snake_case)]
pub struct Chain<T = f64> {
    /// Parameter `m`, 1.2 by default.
    pub m: T,
    /// Parameter `k`, 0.7 by default.
    pub k: T,
}

impl ::core::default::Default for Chain<f64> {
    fn default() -> Self {
        Self { m: 1.2, k: 0.7 }
    }
}

impl<T: ::vi_core::Real> Chain<T> {
    /// The same system in another kind of number, every parameter rounded to it.
    #[allow(unused_variables)]
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
            "m" => Some(&mut self.m),
            "k" => Some(&mut self.k),
            _ => None,
        }
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
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
    const FORCED: bool = false;
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
        let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q).into();
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
        let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q).into();
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

    /// `f_q[0] = 0`
    ///
    /// `f_q[1] = 0`
    ///
    /// `f_q[2] = 0`
    ///
    /// `f_q[3] = 0`
    ///
    /// `f_q[4] = 0`
    ///
    /// `f_q[5] = 0`
    ///
    /// `f_q[6] = 0`
    ///
    /// `f_q[7] = 0`
    ///
    /// `f_q[8] = 0`
    ///
    /// `f_q[9] = 0`
    ///
    /// 0 operations.
    #[inline]
    fn force(
        &self,
        t: T,
        q: &::vi_core::SVector<T, 10>,
        v: &::vi_core::SVector<T, 10>,
    ) -> ::vi_core::SVector<T, 10> {
        let real = T::real;
        ::vi_core::SVector::from([
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
        ])
    }

    /// Solves `M a = L_q + f − L_vt − L_vq v`.
    ///
    /// 87 operations.
    #[inline]
    fn acceleration(
        &self,
        t: T,
        q: &::vi_core::SVector<T, 10>,
        v: &::vi_core::SVector<T, 10>,
    ) -> ::core::result::Result<::vi_core::SVector<T, 10>, ::vi_core::StepError> {
        let time = t;
        let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q).into();
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
        let [(sin10, _), (sin11, _), (sin12, _), (sin13, _)] = T::sin_cos_each([
            t,
            q_0,
            q_1,
            q_2,
        ]);
        let s14 = sin10 * real(0.3333333333333333) + real(1.0);
        let s15 = s1 * s1 * s1;
        let s16 = s2 * s2 * s2;
        let s17 = s3 * s3 * s3;
        let s18 = s4 * s4 * s4;
        let [(sin19, _), (sin20, _), (sin21, _), (sin22, _)] = T::sin_cos_each([
            q_3,
            q_4,
            q_5,
            q_6,
        ]);
        let s23 = s5 * s5 * s5;
        let s24 = s6 * s6 * s6;
        let s25 = s7 * s7 * s7;
        let s26 = s8 * s8 * s8;
        let [(sin27, _), (sin28, _), (sin29, _)] = T::sin_cos_each([q_7, q_8, q_9]);
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
            self.k * s15 - s14 * sin11,
            -(self.k * (s15 - s16) + s14 * sin12),
            -(self.k * (s16 - s17) + s14 * sin13),
            -(self.k * (s17 - s18) + s14 * sin19),
            -(self.k * (s18 - s23) + s14 * sin20),
            -(self.k * (s23 - s24) + s14 * sin21),
            -(self.k * (s24 - s25) + s14 * sin22),
            -(self.k * (s25 - s26) + s14 * sin27),
            -(self.k * (s26 - s30) + s14 * sin28),
            -(self.k * s30 + s14 * sin29),
        ]);
        ::vi_core::linear::acceleration(time, &mass, &applied)
    }

    /// `D = (k*(q[1] - q[0])^3 - (sin(t)/3 + 1)*sin(q[0]))*dot(dot(q[0])) - dot(q[0])*(dot(q[0])*(-3*k*(q[1] - q[0])^2 - (sin(t)/3 + 1)*cos(q[0])) - sin(q[0])*cos(t)/3 + 3*k*(q[1] - q[0])^2*dot(q[1])) + dot(q[0])*sin(q[0])*cos(t)/3 + dot(dot(q[1]))*(-k*(4*(q[1] - q[0])^3 - 4*(q[2] - q[1])^3)/4 - (sin(t)/3 + 1)*sin(q[1])) - dot(q[1])*(3*k*(q[1] - q[0])^2*dot(q[0]) - cos(t)*sin(q[1])/3 + …`
    ///
    /// 304 operations.
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
        let s5: [T; 9] = ::core::array::from_fn(|i| {
            (q[i + 1] - q[i]) * (q[i + 1] - q[i])
        });
        let s6: [T; 9] = ::core::array::from_fn(|i| s5[i] * (q[i + 1] - q[i]));
        let s7: [T; 10] = ::core::array::from_fn(|i| s2 * s4[i].0);
        let s8: [T; 9] = ::core::array::from_fn(|i| self.k * s5[i]);
        let s9: [T; 10] = ::core::array::from_fn(|i| s2 * s4[i].1);
        let s10: [T; 9] = ::core::array::from_fn(|i| s8[i] * v[i + 1] * real(3.0));
        let s11: [T; 10] = ::core::array::from_fn(|i| v[i] * s4[i].0);
        let s12: [T; 9] = ::core::array::from_fn(|i| {
            cos1 * s4[i + 1].0 * real(0.3333333333333333)
        });
        let s13: [T; 9] = ::core::array::from_fn(|i| s8[i] * v[i] * real(3.0));
        let s14: [T; 8] = ::core::array::from_fn(|i| {
            a[i + 1] * (self.k * (s6[i] - s6[i + 1]) + s7[i + 1])
        });
        let s15: [T; 8] = ::core::array::from_fn(|i| {
            v[i + 1]
                * (s13[i] - v[i + 1] * (s3 * (s5[i] + s5[i + 1]) + s9[i + 1])
                    + s10[i + 1] - s12[i])
        });
        let s16 = (0..8).fold((self.k * s6[0] - s7[0]) * a[0], |sum, i| sum - s14[i])
            - a[9] * (self.k * s6[8] + s7[9])
            + sin1 * (1..10).fold(s4[0].1, |sum, i| sum + s4[i].1)
                * real(0.3333333333333333)
            - v[0]
                * (s10[0] - v[0] * (s8[0] * real(3.0) + s9[0])
                    - s4[0].0 * cos1 * real(0.3333333333333333));
        Ok(
            (0..8).fold(s16, |sum, i| sum - s15[i])
                - v[9] * (s13[8] - v[9] * (s8[8] * real(3.0) + s9[9]) - s12[8])
                + (1..10).fold(s11[0], |sum, i| sum + s11[i]) * cos1
                    * real(0.3333333333333333),
        )
    }

    /// The first of what L and f are made of that is not finite here.
    ///
    /// 83 operations.
    #[cold]
    fn non_finite(
        &self,
        t: T,
        q: &::vi_core::SVector<T, 10>,
        v: &::vi_core::SVector<T, 10>,
    ) -> ::core::option::Option<&'static str> {
        let [q_0_dot, q_1_dot, q_2_dot, q_3_dot, q_4_dot, q_5_dot, q_6_dot, q_7_dot,
        q_8_dot, q_9_dot]: [T; 10] = (*v).into();
        let [q_0, q_1, q_2, q_3, q_4, q_5, q_6, q_7, q_8, q_9]: [T; 10] = (*q).into();
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
                "m*(dot(q[0])^2 + dot(q[1])^2 + dot(q[2])^2 + dot(q[3])^2 + dot(q[4])^2 + dot(q[5])^2 + dot(q[6])^2 + dot(q[7])^2 + dot(q[8])^2 + dot(q[9])^2)/2 - k*((q[1] - q[0])^4 + (q[2] - q[1])^4 + (q[3] - q[2])^4 + (q[4] - q[3])^4 + (q[5] - q[4])^4 + (q[6] - q[5])^4 + (q[7] - q[6])^4 + (q[8] - q[7])^4 + (q[9] - q[8])^4)/4 + (sin(t)/3 + 1)*(cos(q[0]) + cos(q[1]) + cos(q[2]) + cos(q[3]) + cos(q[4]) + cos(q[5]) + cos(q[6]) + cos(q[7]) + cos(q[8]) + cos(q[9]))",
                s33 - self.k * (s19 + s14 * s14 + s16 * s16 + s18 * s18) * real(0.25),
            ),
        ];
        values.into_iter().find(|(_, value)| !value.is_finite()).map(|(text, _)| text)
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
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
        let s41 = cos31 + cos32 + cos33 + cos34 + cos35 + cos36 + cos37 + cos38 + cos39
            + cos40;
        let s42 = self.m * (s20 + s21 + s22 + s23 + s24 + s25 + s26 + s27 + s28 + s29)
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
    fn d2_ld(&self, interval: &::vi_core::Interval<10, T>) -> ::vi_core::SVector<T, 10> {
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
        let s41 = cos31 + cos32 + cos33 + cos34 + cos35 + cos36 + cos37 + cos38 + cos39
            + cos40;
        let s42 = self.m * (s20 + s21 + s22 + s23 + s24 + s25 + s26 + s27 + s28 + s29)
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
    fn d4_ld(&self, interval: &::vi_core::Interval<10, T>) -> ::vi_core::SVector<T, 10> {
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

    /// `fd_minus_q[0] = 0`
    ///
    /// `fd_minus_q[1] = 0`
    ///
    /// `fd_minus_q[2] = 0`
    ///
    /// `fd_minus_q[3] = 0`
    ///
    /// `fd_minus_q[4] = 0`
    ///
    /// `fd_minus_q[5] = 0`
    ///
    /// `fd_minus_q[6] = 0`
    ///
    /// `fd_minus_q[7] = 0`
    ///
    /// `fd_minus_q[8] = 0`
    ///
    /// `fd_minus_q[9] = 0`
    ///
    /// 0 operations.
    #[inline]
    fn fd_minus(
        &self,
        interval: &::vi_core::Interval<10, T>,
    ) -> ::vi_core::SVector<T, 10> {
        let real = T::real;
        ::vi_core::SVector::from([
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
        ])
    }

    /// `fd_plus_q[0] = 0`
    ///
    /// `fd_plus_q[1] = 0`
    ///
    /// `fd_plus_q[2] = 0`
    ///
    /// `fd_plus_q[3] = 0`
    ///
    /// `fd_plus_q[4] = 0`
    ///
    /// `fd_plus_q[5] = 0`
    ///
    /// `fd_plus_q[6] = 0`
    ///
    /// `fd_plus_q[7] = 0`
    ///
    /// `fd_plus_q[8] = 0`
    ///
    /// `fd_plus_q[9] = 0`
    ///
    /// 0 operations.
    #[inline]
    fn fd_plus(
        &self,
        interval: &::vi_core::Interval<10, T>,
    ) -> ::vi_core::SVector<T, 10> {
        let real = T::real;
        ::vi_core::SVector::from([
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
        ])
    }

    /// `gd_minus = 0`
    ///
    /// 0 operations.
    #[inline]
    fn gd_minus(&self, interval: &::vi_core::Interval<10, T>) -> T {
        let real = T::real;
        real(0.0)
    }

    /// `gd_plus = 0`
    ///
    /// 0 operations.
    #[inline]
    fn gd_plus(&self, interval: &::vi_core::Interval<10, T>) -> T {
        let real = T::real;
        real(0.0)
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::Stepping<10, T> for Chain<T> {
    type Jacobian = ::vi_core::linear::Tridiagonal<10, T>;
    const CONSTANT_JACOBIAN: bool = false;
    const SMOOTH: bool = true;
    const PLACE: f64 = 0.5f64;

    /// `residual_q[0] = L_v_q[0] - h*L_q[0]/2 - p0_q[0]_low - p0_q[0]`
    ///
    /// `residual_q[1] = L_v_q[1] - h*L_q[1]/2 - p0_q[1]_low - p0_q[1]`
    ///
    /// `residual_q[2] = L_v_q[2] - h*L_q[2]/2 - p0_q[2]_low - p0_q[2]`
    ///
    /// `residual_q[3] = L_v_q[3] - h*L_q[3]/2 - p0_q[3]_low - p0_q[3]`
    ///
    /// `residual_q[4] = L_v_q[4] - h*L_q[4]/2 - p0_q[4]_low - p0_q[4]`
    ///
    /// `residual_q[5] = L_v_q[5] - h*L_q[5]/2 - p0_q[5]_low - p0_q[5]`
    ///
    /// `residual_q[6] = L_v_q[6] - h*L_q[6]/2 - p0_q[6]_low - p0_q[6]`
    ///
    /// `residual_q[7] = L_v_q[7] - h*L_q[7]/2 - p0_q[7]_low - p0_q[7]`
    ///
    /// `residual_q[8] = L_v_q[8] - h*L_q[8]/2 - p0_q[8]_low - p0_q[8]`
    ///
    /// `residual_q[9] = L_v_q[9] - h*L_q[9]/2 - p0_q[9]_low - p0_q[9]`
    ///
    /// 255 operations.
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
        let [q_0_0_low, q_1_0_low, q_2_0_low, q_3_0_low, q_4_0_low, q_5_0_low, q_6_0_low,
        q_7_0_low, q_8_0_low, q_9_0_low]: [T; 10] = node.q_low.into();
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
        let s41 = self.k * s23;
        let s42 = self.k * real(3.0);
        let s43 = self.k * s39;
        let s44 = h * h;
        let s45 = s44 * real(0.25);
        let s46 = s44 * real(0.75);
        let s47 = -(s41 * s46);
        let s48 = self.k * s44 * real(0.75);
        let s49 = -(s48 * s25);
        let s50 = -(s48 * s27);
        let s51 = -(s48 * s29);
        let s52 = -(s48 * s31);
        let s53 = -(s48 * s33);
        let s54 = -(s48 * s35);
        let s55 = -(s48 * s37);
        let s56 = -(s43 * s46);
        ::vi_core::MomentumEquation {
            residual: ::vi_core::SVector::from([
                self.m * q_0_dot - p0_q_0
                    - (p0_q_0_low + s1 * (self.k * s24 - s15 * sin12)),
                self.m * q_1_dot - p0_q_1
                    - (p0_q_1_low - s1 * (self.k * (s24 - s26) + s15 * sin13)),
                self.m * q_2_dot - p0_q_2
                    - (p0_q_2_low - s1 * (self.k * (s26 - s28) + s15 * sin14)),
                self.m * q_3_dot - p0_q_3
                    - (p0_q_3_low - s1 * (self.k * (s28 - s30) + s15 * sin16)),
                self.m * q_4_dot - p0_q_4
                    - (p0_q_4_low - s1 * (self.k * (s30 - s32) + s15 * sin17)),
                self.m * q_5_dot - p0_q_5
                    - (p0_q_5_low - s1 * (self.k * (s32 - s34) + s15 * sin18)),
                self.m * q_6_dot - p0_q_6
                    - (p0_q_6_low - s1 * (self.k * (s34 - s36) + s15 * sin19)),
                self.m * q_7_dot - p0_q_7
                    - (p0_q_7_low - s1 * (self.k * (s36 - s38) + s15 * sin20)),
                self.m * q_8_dot - p0_q_8
                    - (p0_q_8_low - s1 * (self.k * (s38 - s40) + s15 * sin21)),
                self.m * q_9_dot - p0_q_9
                    - (p0_q_9_low - s1 * (self.k * s40 + s15 * sin22)),
            ]),
            jacobian: ::vi_core::linear::Tridiagonal {
                lower: [T::real(0.0), s47, s49, s50, s51, s52, s53, s54, s55, s56],
                diagonal: [
                    self.m + s45 * (s41 * real(3.0) + s15 * cos12),
                    self.m + s45 * (s42 * (s23 + s25) + s15 * cos13),
                    self.m + s45 * (s42 * (s25 + s27) + s15 * cos14),
                    self.m + s45 * (s42 * (s27 + s29) + s15 * cos16),
                    self.m + s45 * (s42 * (s29 + s31) + s15 * cos17),
                    self.m + s45 * (s42 * (s31 + s33) + s15 * cos18),
                    self.m + s45 * (s42 * (s33 + s35) + s15 * cos19),
                    self.m + s45 * (s42 * (s35 + s37) + s15 * cos20),
                    self.m + s45 * (s42 * (s37 + s39) + s15 * cos21),
                    self.m + s45 * (s43 * real(3.0) + s15 * cos22),
                ],
                upper: [s47, s49, s50, s51, s52, s53, s54, s55, s56, T::real(0.0)],
            },
        }
    }

    /// `energy_residual = h*L_t/2 - L - E0_low - E0 + h*v_q[0]*L_q[0]/2 + v_q[0]*p0_q[0]_low + v_q[0]*p0_q[0] + h*v_q[1]*L_q[1]/2 + v_q[1]*p0_q[1]_low + v_q[1]*p0_q[1] + h*v_q[2]*L_q[2]/2 + v_q[2]*p0_q[2]_low + v_q[2]*p0_q[2] + h*v_q[3]*L_q[3]/2 + v_q[3]*p0_q[3]_low + v_q[3]*p0_q[3] + h*v_q[4]*L_q[4]/2 + v_q[4]*p0_q[4]_low + v_q[4]*p0_q[4] + h*v_q[5]*L_q[5]/2 + v_q[5]*p0_q[5]_low + v_q[5]*p0_q[5] + h*v_q[6]*L_q[6]/2 + …`
    ///
    /// 640 operations.
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
        let s6 = s5 * real(0.25);
        let s7 = s5 * real(0.75);
        let s8 = self.k * s5 * real(0.75);
        let s9 = self.k * real(0.75);
        let s10 = self.k * real(1.5);
        let s11 = s10 * v[2];
        let s12 = s10 * v[4];
        let s13 = s10 * v[6];
        let q_mid: [T; 10] = ::core::array::from_fn(|i| q0[i] + (s1 * v[i] + q0_low[i]));
        let s14: [T; 10] = ::core::array::from_fn(|i| v[i] * p0_low[i]);
        let s15: [T; 10] = ::core::array::from_fn(|i| v[i] * p0[i]);
        let s16: [T; 9] = ::core::array::from_fn(|i| {
            (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i])
        });
        let s17: [T; 9] = ::core::array::from_fn(|i| s16[i] * s16[i]);
        let s18: [T; 10] = ::core::array::from_fn(|i| v[i] * v[i]);
        let s19: [(T, T); 10] = ::core::array::from_fn(|i| q_mid[i].sin_cos());
        let s20: [T; 9] = ::core::array::from_fn(|i| s16[i] * (q_mid[i + 1] - q_mid[i]));
        let s21: [T; 10] = ::core::array::from_fn(|i| s3 * s19[i].0);
        let s22: [T; 8] = ::core::array::from_fn(|i| self.k * (s20[i] - s20[i + 1]));
        let s23: [T; 10] = ::core::array::from_fn(|i| self.m * v[i] - p0[i]);
        let s24: [T; 8] = ::core::array::from_fn(|i| {
            s23[i + 1] - (p0_low[i + 1] - s1 * (s22[i] + s21[i + 1]))
        });
        let s25: [T; 8] = ::core::array::from_fn(|i| v[i + 1] * (s22[i] + s21[i + 1]));
        let s26: [T; 10] = ::core::array::from_fn(|i| s3 * s19[i].1);
        let s27: [T; 8] = ::core::array::from_fn(|i| {
            s4 * (s16[i] + s16[i + 1]) + s26[i + 1]
        });
        let s28: [T; 8] = ::core::array::from_fn(|i| self.m + s6 * s27[i]);
        let s29: [T; 10] = ::core::array::from_fn(|i| s21[i] * real(0.5));
        let s30: [T; 10] = ::core::array::from_fn(|i| {
            cos2 * s19[i].0 * real(0.08333333333333333)
        });
        let s31: [T; 9] = ::core::array::from_fn(|i| s9 * v[i + 1] * s16[i]);
        let s32: [T; 8] = ::core::array::from_fn(|i| s22[i] * real(0.5) + s29[i + 1]);
        let s33: [T; 9] = ::core::array::from_fn(|i| s9 * v[i] * s16[i]);
        let s34: [T; 8] = ::core::array::from_fn(|i| v[i + 1] * s27[i] * real(0.25));
        let s35: [T; 9] = ::core::array::from_fn(|i| s30[i + 1] - s33[i]);
        let s36: [T; 8] = ::core::array::from_fn(|i| {
            s32[i] + (s35[i] + s34[i] - s31[i + 1]) * h
        });
        let s37: [T; 8] = ::core::array::from_fn(|i| {
            s32[i] + (s33[i] - s34[i] + s31[i + 1] - s30[i + 1]) * h
        });
        let s38: [T; 10] = ::core::array::from_fn(|i| v[i] * s19[i].0);
        let s39 = (1..10).fold(s19[0].1, |sum, i| sum + s19[i].1);
        let s40 = self.k * s20[0];
        let s41 = s40 - s21[0];
        let s42 = self.k * s20[8];
        let s43 = s42 + s21[9];
        let s44 = (1..10).fold(s15[0], |sum, i| sum + s15[i])
            + self.k * (1..9).fold(s17[0], |sum, i| sum + s17[i]) * real(0.25) - energy0
            - self.m * (1..10).fold(s18[0], |sum, i| sum + s18[i]) * real(0.5)
            - s3 * s39;
        let s45 = self.k * s16[0];
        let s46 = s45 * real(3.0) + s26[0];
        let s47 = self.k * s16[8];
        let s48 = s47 * real(3.0) + s26[9];
        let s49 = -(s45 * s7);
        let s50 = -(s8 * s16[1]);
        let s51 = -(s8 * s16[2]);
        let s52 = -(s8 * s16[3]);
        let s53 = -(s8 * s16[4]);
        let s54 = -(s8 * s16[5]);
        let s55 = -(s8 * s16[6]);
        let s56 = -(s8 * s16[7]);
        let s57 = -(s47 * s7);
        let s58 = s29[0] - s40 * real(0.5);
        let s59 = v[0] * s46 * real(0.25);
        let s60 = s42 * real(0.5) + s29[9];
        let s61 = v[9] * s48 * real(0.25);
        let s62 = -(s18[0] * s46) - s18[2] * s27[1] - s18[4] * s27[3] - s18[6] * s27[5]
            - s18[9] * s48 - sin2 * s39 * real(0.3333333333333333);
        let s63 = s62 * real(0.25) + (s10 * v[9] * s16[8] - s34[7]) * v[8]
            + (s13 * s16[6] - s34[6] + s10 * v[8] * s16[7]) * v[7];
        let s64 = s63 + (s12 * s16[4] - s34[4] + s13 * s16[5]) * v[5]
            + (s11 * s16[2] - s34[2] + s12 * s16[3]) * v[3];
        ::vi_core::ExtendedSystem {
            momentum: ::vi_core::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    s23[0] - (p0_low[0] + s1 * s41),
                    s24[0],
                    s24[1],
                    s24[2],
                    s24[3],
                    s24[4],
                    s24[5],
                    s24[6],
                    s24[7],
                    s23[9] - (p0_low[9] - s1 * s43),
                ]),
                jacobian: ::vi_core::linear::Tridiagonal {
                    lower: [T::real(0.0), s49, s50, s51, s52, s53, s54, s55, s56, s57],
                    diagonal: [
                        self.m + s6 * s46,
                        s28[0],
                        s28[1],
                        s28[2],
                        s28[3],
                        s28[4],
                        s28[5],
                        s28[6],
                        s28[7],
                        self.m + s6 * s48,
                    ],
                    upper: [s49, s50, s51, s52, s53, s54, s55, s56, s57, T::real(0.0)],
                },
            },
            residual_dh: ::vi_core::SVector::from([
                s58 + (s30[0] + s59 - s31[0]) * h,
                s36[0],
                s36[1],
                s36[2],
                s36[3],
                s36[4],
                s36[5],
                s36[6],
                s36[7],
                s60 + (s35[8] + s61) * h,
            ]),
            energy_residual: s44
                + ((1..10).fold(s14[0], |sum, i| sum + s14[i]) - energy0_low
                    + s1
                        * ((0..8)
                            .fold(
                                s39 * cos2 * real(0.3333333333333333) + v[0] * s41,
                                |sum, i| sum - s25[i],
                            ) - v[9] * s43)),
            energy_dv: ::vi_core::SVector::from([
                s58 + (s31[0] - s59 - s30[0]) * h,
                s37[0],
                s37[1],
                s37[2],
                s37[3],
                s37[4],
                s37[5],
                s37[6],
                s37[7],
                s60 + (s33[8] - s61 - s30[9]) * h,
            ]),
            energy_dh: s64 + (s10 * v[0] * s16[0] - s34[0] + s11 * s16[1]) * v[1]
                - (1..10).fold(s38[0], |sum, i| sum + s38[i]) * cos2
                    * real(0.16666666666666666),
        }
    }

    /// Sums of the absolute values of the terms of `residual` and `energy_residual`.
    ///
    /// 791 operations.
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
        let s5 = h * t_mid * cos2;
        let s6 = self.k * h;
        let s7 = h.abs() * real(0.5);
        let s8 = self.k * real(3.0);
        let s9 = self.k * real(1.5);
        let q_mid: [T; 10] = ::core::array::from_fn(|i| q0[i] + (s1 * v[i] + q0_low[i]));
        let s10: [T; 9] = ::core::array::from_fn(|i| {
            (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i])
        });
        let s11: [T; 9] = ::core::array::from_fn(|i| s10[i] * s10[i]);
        let s12: [T; 10] = ::core::array::from_fn(|i| v[i] * v[i]);
        let s13: [(T, T); 10] = ::core::array::from_fn(|i| q_mid[i].sin_cos());
        let s14: [T; 9] = ::core::array::from_fn(|i| s10[i] * (q_mid[i + 1] - q_mid[i]));
        let s15: [T; 10] = ::core::array::from_fn(|i| s3 * s13[i].0);
        let s16: [T; 10] = ::core::array::from_fn(|i| s15[i].abs());
        let s17: [T; 10] = ::core::array::from_fn(|i| s3 * s13[i].1);
        let s18: [T; 10] = ::core::array::from_fn(|i| h * q_mid[i]);
        let s19: [T; 10] = ::core::array::from_fn(|i| {
            (s5 * s13[i].0).abs() * real(0.16666666666666666)
        });
        let s20: [T; 9] = ::core::array::from_fn(|i| {
            (s6 * q_mid[i + 1] * s10[i]).abs() * real(1.5)
        });
        let s21: [T; 10] = ::core::array::from_fn(|i| {
            p0[i].abs() + (self.m * v[i]).abs()
        });
        let s22: [T; 8] = ::core::array::from_fn(|i| {
            (s4 * (s14[i] - s14[i + 1])).abs() * real(0.25) + s16[i + 1]
        });
        let s23: [T; 8] = ::core::array::from_fn(|i| {
            s8 * (s10[i] + s10[i + 1]) + s17[i + 1]
        });
        let s24: [T; 9] = ::core::array::from_fn(|i| {
            (s6 * q_mid[i] * s10[i]).abs() * real(1.5)
        });
        let s25: [T; 8] = ::core::array::from_fn(|i| {
            s21[i + 1] + s7 * s22[i] + s19[i + 1] + s24[i]
                + (s18[i + 1] * s23[i]).abs() * real(0.5) + s20[i + 1]
        });
        let s26: [T; 10] = ::core::array::from_fn(|i| (v[i] * p0[i]).abs());
        let s27: [T; 10] = ::core::array::from_fn(|i| s13[i].1.abs());
        let s28: [T; 10] = ::core::array::from_fn(|i| (h * v[i]).abs());
        let s29: [T; 10] = ::core::array::from_fn(|i| v[i] * s13[i].0);
        let s30: [T; 10] = ::core::array::from_fn(|i| {
            cos2 * s13[i].0 * real(0.16666666666666666)
        });
        let s31: [T; 9] = ::core::array::from_fn(|i| s9 * v[i + 1] * s10[i]);
        let s32: [T; 9] = ::core::array::from_fn(|i| s9 * v[i] * s10[i]);
        let s33: [T; 8] = ::core::array::from_fn(|i| {
            q_mid[i + 1]
                * (self.k * (s14[i] - s14[i + 1]) + s15[i + 1]
                    + (s32[i] - v[i + 1] * s23[i] * real(0.5) + s31[i + 1] - s30[i + 1])
                        * h)
        });
        let s34: [T; 8] = ::core::array::from_fn(|i| s33[i].abs());
        let s35: [T; 8] = ::core::array::from_fn(|i| s22[i] * s28[i + 1] * real(0.5));
        let s36 = (1..10).fold(s13[0].1, |sum, i| sum + s13[i].1);
        let s37 = self.k * s14[0];
        let s38 = s37.abs() + s16[0];
        let s39 = self.k * s10[0] * real(3.0) + s17[0];
        let s40 = q_mid[8] - q_mid[9];
        let s41 = (self.k * (s40 * s40 * s40)).abs() + s16[9];
        let s42 = self.k * s10[8] * real(3.0) + s17[9];
        let s43 = t_mid
            * (s36 * cos2 * real(0.3333333333333333)
                + (sin2 * s36 * real(0.16666666666666666)
                    + (1..10).fold(s29[0], |sum, i| sum + s29[i]) * cos2
                        * real(0.16666666666666666)) * h);
        let s44 = (0..10).fold(energy0.abs(), |sum, i| sum + s26[i])
            + self.k.abs() * (1..9).fold(s11[0], |sum, i| sum + s11[i]) * real(0.25)
            + self.m.abs() * (1..10).fold(s12[0], |sum, i| sum + s12[i]) * real(0.5);
        let s45 = (0..8).fold(s44 + s38 * s28[0] * real(0.5), |sum, i| sum + s35[i])
            + s41 * s28[9] * real(0.5) + s43.abs()
            + (q_mid[0]
                * (s37 - s15[0] + (s30[0] + v[0] * s39 * real(0.5) - s31[0]) * h))
                .abs();
        let s46 = (0..8).fold(s45, |sum, i| sum + s34[i])
            + (q_mid[9]
                * (self.k * s14[8] + s15[9]
                    + (s32[8] - v[9] * s42 * real(0.5) - s30[9]) * h))
                .abs();
        ::vi_core::Magnitudes {
            residual: ::vi_core::SVector::from([
                s21[0] + s7 * s38 + s19[0] + (s18[0] * s39).abs() * real(0.5) + s20[0],
                s25[0],
                s25[1],
                s25[2],
                s25[3],
                s25[4],
                s25[5],
                s25[6],
                s25[7],
                s21[9] + s7 * s41 + s19[9] + s24[8] + (s18[9] * s42).abs() * real(0.5),
            ]),
            energy_residual: s46
                + (sin2.abs() * real(0.3333333333333333)
                    + (h * cos2).abs() * real(0.16666666666666666) + real(1.0))
                    * (1..10).fold(s27[0], |sum, i| sum + s27[i]),
        }
    }

    /// `p1 − p0_q[0] = h*L_q[0]`
    ///
    /// `p1 − p0_q[1] = h*L_q[1]`
    ///
    /// `p1 − p0_q[2] = h*L_q[2]`
    ///
    /// `p1 − p0_q[3] = h*L_q[3]`
    ///
    /// `p1 − p0_q[4] = h*L_q[4]`
    ///
    /// `p1 − p0_q[5] = h*L_q[5]`
    ///
    /// `p1 − p0_q[6] = h*L_q[6]`
    ///
    /// `p1 − p0_q[7] = h*L_q[7]`
    ///
    /// `p1 − p0_q[8] = h*L_q[8]`
    ///
    /// `p1 − p0_q[9] = h*L_q[9]`
    ///
    /// `E1 − E0 = -h*L_t`
    ///
    /// 154 operations.
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
        let [q_0_0_low, q_1_0_low, q_2_0_low, q_3_0_low, q_4_0_low, q_5_0_low, q_6_0_low,
        q_7_0_low, q_8_0_low, q_9_0_low]: [T; 10] = node.q_low.into();
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
        let s32 = h * real(0.3333333333333333)
            * (cos12 + cos13 + cos14 + cos16 + cos17 + cos18 + cos19 + cos20 + cos21
                + cos22);
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                h * (self.k * s23 - s15 * sin12),
                -(h * (self.k * (s23 - s24) + s15 * sin13)),
                -(h * (self.k * (s24 - s25) + s15 * sin14)),
                -(h * (self.k * (s25 - s26) + s15 * sin16)),
                -(h * (self.k * (s26 - s27) + s15 * sin17)),
                -(h * (self.k * (s27 - s28) + s15 * sin18)),
                -(h * (self.k * (s28 - s29) + s15 * sin19)),
                -(h * (self.k * (s29 - s30) + s15 * sin20)),
                -(h * (self.k * (s30 - s31) + s15 * sin21)),
                -(h * (self.k * s31 + s15 * sin22)),
            ]),
            energy: -(s32 * cos11),
        }
    }

    /// `p1 − p0_q[0] = h*L_q[0]`
    ///
    /// `p1 − p0_q[1] = h*L_q[1]`
    ///
    /// `p1 − p0_q[2] = h*L_q[2]`
    ///
    /// `p1 − p0_q[3] = h*L_q[3]`
    ///
    /// `p1 − p0_q[4] = h*L_q[4]`
    ///
    /// `p1 − p0_q[5] = h*L_q[5]`
    ///
    /// `p1 − p0_q[6] = h*L_q[6]`
    ///
    /// `p1 − p0_q[7] = h*L_q[7]`
    ///
    /// `p1 − p0_q[8] = h*L_q[8]`
    ///
    /// `p1 − p0_q[9] = h*L_q[9]`
    ///
    /// and to first order at `v + dv`.
    ///
    /// 276 operations.
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
        let s25 = self.k * s24 - s15 * sin12;
        let s26 = s3 * s3;
        let s27 = s26 * s3;
        let s28 = self.k * (s24 - s27) + s15 * sin13;
        let s29 = s4 * s4;
        let s30 = s29 * s4;
        let s31 = self.k * (s27 - s30) + s15 * sin14;
        let s32 = s5 * s5;
        let s33 = s32 * s5;
        let s34 = self.k * (s30 - s33) + s15 * sin16;
        let s35 = s6 * s6;
        let s36 = s35 * s6;
        let s37 = self.k * (s33 - s36) + s15 * sin17;
        let s38 = s7 * s7;
        let s39 = s38 * s7;
        let s40 = self.k * (s36 - s39) + s15 * sin18;
        let s41 = s8 * s8;
        let s42 = s41 * s8;
        let s43 = self.k * (s39 - s42) + s15 * sin19;
        let s44 = s9 * s9;
        let s45 = s44 * s9;
        let s46 = self.k * (s42 - s45) + s15 * sin20;
        let s47 = s10 * s10;
        let s48 = s47 * s10;
        let s49 = self.k * (s45 - s48) + s15 * sin21;
        let s50 = self.k * s48 + s15 * sin22;
        let s51 = self.k * s23;
        let s52 = s51 * real(3.0) + s15 * cos12;
        let s53 = self.k * real(3.0);
        let s54 = s53 * (s23 + s26) + s15 * cos13;
        let s55 = s53 * (s26 + s29) + s15 * cos14;
        let s56 = s53 * (s29 + s32) + s15 * cos16;
        let s57 = s53 * (s32 + s35) + s15 * cos17;
        let s58 = s53 * (s35 + s38) + s15 * cos18;
        let s59 = s53 * (s38 + s41) + s15 * cos19;
        let s60 = s53 * (s41 + s44) + s15 * cos20;
        let s61 = s53 * (s44 + s47) + s15 * cos21;
        let s62 = self.k * s47;
        let s63 = s62 * real(3.0) + s15 * cos22;
        let s64 = h * h;
        let s65 = s64 * real(0.25);
        let s66 = s64 * real(0.75);
        let s67 = -(s51 * s66);
        let s68 = self.k * s64;
        let s69 = s68 * real(0.75);
        let s70 = -(s69 * s26);
        let s71 = -(s69 * s29);
        let s72 = -(s69 * s32);
        let s73 = -(s69 * s35);
        let s74 = -(s69 * s38);
        let s75 = -(s69 * s41);
        let s76 = -(s69 * s44);
        let s77 = -(s62 * s66);
        let s78 = s64 * real(0.5);
        let s79 = s64 * real(1.5);
        let s80 = s51 * s79;
        let s81 = s68 * real(1.5);
        let s82 = s81 * s26;
        let s83 = s81 * s29;
        let s84 = s81 * s32;
        let s85 = s81 * s35;
        let s86 = s81 * s38;
        let s87 = s81 * s41;
        let s88 = s81 * s44;
        let s89 = s62 * s79;
        let change: [T; 10] = solve(
                &::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        self.m * q_0_dot - p0_q_0 - (p0_q_0_low + s1 * s25),
                        self.m * q_1_dot - p0_q_1 - (p0_q_1_low - s1 * s28),
                        self.m * q_2_dot - p0_q_2 - (p0_q_2_low - s1 * s31),
                        self.m * q_3_dot - p0_q_3 - (p0_q_3_low - s1 * s34),
                        self.m * q_4_dot - p0_q_4 - (p0_q_4_low - s1 * s37),
                        self.m * q_5_dot - p0_q_5 - (p0_q_5_low - s1 * s40),
                        self.m * q_6_dot - p0_q_6 - (p0_q_6_low - s1 * s43),
                        self.m * q_7_dot - p0_q_7 - (p0_q_7_low - s1 * s46),
                        self.m * q_8_dot - p0_q_8 - (p0_q_8_low - s1 * s49),
                        self.m * q_9_dot - p0_q_9 - (p0_q_9_low - s1 * s50),
                    ]),
                    jacobian: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s67,
                            s70,
                            s71,
                            s72,
                            s73,
                            s74,
                            s75,
                            s76,
                            s77,
                        ],
                        diagonal: [
                            self.m + s65 * s52,
                            self.m + s65 * s54,
                            self.m + s65 * s55,
                            self.m + s65 * s56,
                            self.m + s65 * s57,
                            self.m + s65 * s58,
                            self.m + s65 * s59,
                            self.m + s65 * s60,
                            self.m + s65 * s61,
                            self.m + s65 * s63,
                        ],
                        upper: [
                            s67,
                            s70,
                            s71,
                            s72,
                            s73,
                            s74,
                            s75,
                            s76,
                            s77,
                            T::real(0.0),
                        ],
                    },
                },
            )
            .into();
        ::vi_core::SVector::from([
            h * s25 + ((-(s78 * s52)) * change[0] + (s80) * change[1]),
            -(h * s28)
                + ((s80) * change[0] + (-(s78 * s54)) * change[1] + (s82) * change[2]),
            -(h * s31)
                + ((s82) * change[1] + (-(s78 * s55)) * change[2] + (s83) * change[3]),
            -(h * s34)
                + ((s83) * change[2] + (-(s78 * s56)) * change[3] + (s84) * change[4]),
            -(h * s37)
                + ((s84) * change[3] + (-(s78 * s57)) * change[4] + (s85) * change[5]),
            -(h * s40)
                + ((s85) * change[4] + (-(s78 * s58)) * change[5] + (s86) * change[6]),
            -(h * s43)
                + ((s86) * change[5] + (-(s78 * s59)) * change[6] + (s87) * change[7]),
            -(h * s46)
                + ((s87) * change[6] + (-(s78 * s60)) * change[7] + (s88) * change[8]),
            -(h * s49)
                + ((s88) * change[7] + (-(s78 * s61)) * change[8] + (s89) * change[9]),
            -(h * s50) + ((s89) * change[8] + (-(s78 * s63)) * change[9]),
        ])
    }

    /// `p1 − p0_q[0] = h*L_q[0]`
    ///
    /// `p1 − p0_q[1] = h*L_q[1]`
    ///
    /// `p1 − p0_q[2] = h*L_q[2]`
    ///
    /// `p1 − p0_q[3] = h*L_q[3]`
    ///
    /// `p1 − p0_q[4] = h*L_q[4]`
    ///
    /// `p1 − p0_q[5] = h*L_q[5]`
    ///
    /// `p1 − p0_q[6] = h*L_q[6]`
    ///
    /// `p1 − p0_q[7] = h*L_q[7]`
    ///
    /// `p1 − p0_q[8] = h*L_q[8]`
    ///
    /// `p1 − p0_q[9] = h*L_q[9]`
    ///
    /// `E1 − E0 = -h*L_t`
    ///
    /// and to first order at `(v + dv, h + dh)`.
    ///
    /// 790 operations.
    #[inline(never)]
    fn extended_step(
        &self,
        node: &::vi_core::Node<10, T>,
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
        let s6 = s5 * real(0.25);
        let s7 = s5 * real(0.75);
        let s8 = self.k * s5;
        let s9 = s8 * real(0.75);
        let s10 = self.k * real(0.75);
        let s11 = self.k * real(1.5);
        let s12 = s5 * real(0.5);
        let s13 = s5 * real(1.5);
        let s14 = s8 * real(1.5);
        let s15 = s5 * real(0.16666666666666666);
        let q_mid: [T; 10] = ::core::array::from_fn(|i| q0[i] + (s1 * v[i] + q0_low[i]));
        let s16: [T; 10] = ::core::array::from_fn(|i| v[i] * p0_low[i]);
        let s17: [T; 10] = ::core::array::from_fn(|i| v[i] * p0[i]);
        let s18: [T; 9] = ::core::array::from_fn(|i| {
            (q_mid[i + 1] - q_mid[i]) * (q_mid[i + 1] - q_mid[i])
        });
        let s19: [T; 9] = ::core::array::from_fn(|i| s18[i] * s18[i]);
        let s20: [T; 10] = ::core::array::from_fn(|i| v[i] * v[i]);
        let s21: [(T, T); 10] = ::core::array::from_fn(|i| q_mid[i].sin_cos());
        let s22: [T; 9] = ::core::array::from_fn(|i| s18[i] * (q_mid[i + 1] - q_mid[i]));
        let s23: [T; 10] = ::core::array::from_fn(|i| s3 * s21[i].0);
        let s24: [T; 8] = ::core::array::from_fn(|i| self.k * (s22[i] - s22[i + 1]));
        let s25: [T; 8] = ::core::array::from_fn(|i| -(h * (s24[i] + s23[i + 1])));
        let s26: [T; 10] = ::core::array::from_fn(|i| self.m * v[i] - p0[i]);
        let s27: [T; 8] = ::core::array::from_fn(|i| {
            s26[i + 1] - (p0_low[i + 1] - s1 * (s24[i] + s23[i + 1]))
        });
        let s28: [T; 8] = ::core::array::from_fn(|i| v[i + 1] * (s24[i] + s23[i + 1]));
        let s29: [T; 10] = ::core::array::from_fn(|i| s3 * s21[i].1);
        let s30: [T; 8] = ::core::array::from_fn(|i| {
            s4 * (s18[i] + s18[i + 1]) + s29[i + 1]
        });
        let s31: [T; 8] = ::core::array::from_fn(|i| self.m + s6 * s30[i]);
        let s32: [T; 10] = ::core::array::from_fn(|i| s23[i] * real(0.5));
        let s33: [T; 10] = ::core::array::from_fn(|i| {
            cos2 * s21[i].0 * real(0.08333333333333333)
        });
        let s34: [T; 9] = ::core::array::from_fn(|i| s10 * v[i + 1] * s18[i]);
        let s35: [T; 8] = ::core::array::from_fn(|i| s24[i] * real(0.5) + s32[i + 1]);
        let s36: [T; 9] = ::core::array::from_fn(|i| s10 * v[i] * s18[i]);
        let s37: [T; 8] = ::core::array::from_fn(|i| v[i + 1] * s30[i] * real(0.25));
        let s38: [T; 9] = ::core::array::from_fn(|i| s33[i + 1] - s36[i]);
        let s39: [T; 8] = ::core::array::from_fn(|i| {
            s35[i] + (s38[i] + s37[i] - s34[i + 1]) * h
        });
        let s40: [T; 8] = ::core::array::from_fn(|i| {
            s35[i] + (s36[i] - s37[i] + s34[i + 1] - s33[i + 1]) * h
        });
        let s41: [T; 10] = ::core::array::from_fn(|i| v[i] * s21[i].0);
        let s42: [T; 9] = ::core::array::from_fn(|i| s11 * v[i] * s18[i]);
        let s43: [T; 9] = ::core::array::from_fn(|i| s11 * v[i + 1] * s18[i]);
        let s44: [T; 10] = ::core::array::from_fn(|i| {
            cos2 * s21[i].0 * real(0.16666666666666666)
        });
        let s45: [T; 8] = ::core::array::from_fn(|i| -(s12 * s30[i]));
        let s46: [T; 8] = ::core::array::from_fn(|i| {
            (s42[i] - v[i + 1] * s30[i] * real(0.5) + s43[i + 1] - s44[i + 1]) * h
                - (s24[i] + s23[i + 1])
        });
        let s47: [T; 10] = ::core::array::from_fn(|i| cos2 * s21[i].0 * s15);
        let s48 = (1..10).fold(s21[0].1, |sum, i| sum + s21[i].1);
        let s49 = s48 * cos2;
        let s50 = self.k * s22[0];
        let s51 = s50 - s23[0];
        let s52 = self.k * s22[8];
        let s53 = s52 + s23[9];
        let s54 = (1..10).fold(s17[0], |sum, i| sum + s17[i])
            + self.k * (1..9).fold(s19[0], |sum, i| sum + s19[i]) * real(0.25) - energy0
            - self.m * (1..10).fold(s20[0], |sum, i| sum + s20[i]) * real(0.5)
            - s3 * s48;
        let s55 = s49 * real(0.3333333333333333);
        let s56 = self.k * s18[0];
        let s57 = s56 * real(3.0) + s29[0];
        let s58 = self.k * s18[8];
        let s59 = s58 * real(3.0) + s29[9];
        let s60 = -(s56 * s7);
        let s61 = -(s9 * s18[1]);
        let s62 = -(s9 * s18[2]);
        let s63 = -(s9 * s18[3]);
        let s64 = -(s9 * s18[4]);
        let s65 = -(s9 * s18[5]);
        let s66 = -(s9 * s18[6]);
        let s67 = -(s9 * s18[7]);
        let s68 = -(s58 * s7);
        let s69 = s32[0] - s50 * real(0.5);
        let s70 = v[0] * s57;
        let s71 = s70 * real(0.25);
        let s72 = s52 * real(0.5) + s32[9];
        let s73 = v[9] * s59;
        let s74 = s73 * real(0.25);
        let s75 = sin2 * s48;
        let s76 = (1..10).fold(s41[0], |sum, i| sum + s41[i]) * cos2
            * real(0.16666666666666666);
        let s77 = -(s20[0] * s57) - s20[2] * s30[1] - s20[4] * s30[3] - s20[6] * s30[5]
            - s20[9] * s59 - s75 * real(0.3333333333333333);
        let s78 = s77 * real(0.25) + (s43[8] - s37[7]) * v[8]
            + (s42[6] - s37[6] + s43[7]) * v[7] + (s42[4] - s37[4] + s43[5]) * v[5];
        let s79 = s56 * s13;
        let s80 = s14 * s18[1];
        let s81 = s14 * s18[2];
        let s82 = s14 * s18[3];
        let s83 = s14 * s18[4];
        let s84 = s14 * s18[5];
        let s85 = s14 * s18[6];
        let s86 = s14 * s18[7];
        let s87 = s58 * s13;
        let (change, change_h) = solve(
            &::vi_core::ExtendedSystem {
                momentum: ::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        s26[0] - (p0_low[0] + s1 * s51),
                        s27[0],
                        s27[1],
                        s27[2],
                        s27[3],
                        s27[4],
                        s27[5],
                        s27[6],
                        s27[7],
                        s26[9] - (p0_low[9] - s1 * s53),
                    ]),
                    jacobian: ::vi_core::linear::Tridiagonal {
                        lower: [
                            T::real(0.0),
                            s60,
                            s61,
                            s62,
                            s63,
                            s64,
                            s65,
                            s66,
                            s67,
                            s68,
                        ],
                        diagonal: [
                            self.m + s6 * s57,
                            s31[0],
                            s31[1],
                            s31[2],
                            s31[3],
                            s31[4],
                            s31[5],
                            s31[6],
                            s31[7],
                            self.m + s6 * s59,
                        ],
                        upper: [
                            s60,
                            s61,
                            s62,
                            s63,
                            s64,
                            s65,
                            s66,
                            s67,
                            s68,
                            T::real(0.0),
                        ],
                    },
                },
                residual_dh: ::vi_core::SVector::from([
                    s69 + (s33[0] + s71 - s34[0]) * h,
                    s39[0],
                    s39[1],
                    s39[2],
                    s39[3],
                    s39[4],
                    s39[5],
                    s39[6],
                    s39[7],
                    s72 + (s38[8] + s74) * h,
                ]),
                energy_residual: s54
                    + ((1..10).fold(s16[0], |sum, i| sum + s16[i]) - energy0_low
                        + s1
                            * ((0..8).fold(s55 + v[0] * s51, |sum, i| sum - s28[i])
                                - v[9] * s53)),
                energy_dv: ::vi_core::SVector::from([
                    s69 + (s34[0] - s71 - s33[0]) * h,
                    s40[0],
                    s40[1],
                    s40[2],
                    s40[3],
                    s40[4],
                    s40[5],
                    s40[6],
                    s40[7],
                    s72 + (s36[8] - s74 - s33[9]) * h,
                ]),
                energy_dh: s78 + (s42[2] - s37[2] + s43[3]) * v[3]
                    + (s42[0] - s37[0] + s43[1]) * v[1] - s76,
            },
        );
        let change: [T; 10] = change.into();
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                h * s51
                    + ((-(s12 * s57)) * change[0] + (s79) * change[1]
                        + (s51 + (s43[0] - s70 * real(0.5) - s44[0]) * h) * change_h),
                s25[0]
                    + ((s79) * change[0] + (s45[0]) * change[1] + (s80) * change[2]
                        + (s46[0]) * change_h),
                s25[1]
                    + ((s80) * change[1] + (s45[1]) * change[2] + (s81) * change[3]
                        + (s46[1]) * change_h),
                s25[2]
                    + ((s81) * change[2] + (s45[2]) * change[3] + (s82) * change[4]
                        + (s46[2]) * change_h),
                s25[3]
                    + ((s82) * change[3] + (s45[3]) * change[4] + (s83) * change[5]
                        + (s46[3]) * change_h),
                s25[4]
                    + ((s83) * change[4] + (s45[4]) * change[5] + (s84) * change[6]
                        + (s46[4]) * change_h),
                s25[5]
                    + ((s84) * change[5] + (s45[5]) * change[6] + (s85) * change[7]
                        + (s46[5]) * change_h),
                s25[6]
                    + ((s85) * change[6] + (s45[6]) * change[7] + (s86) * change[8]
                        + (s46[6]) * change_h),
                s25[7]
                    + ((s86) * change[7] + (s45[7]) * change[8] + (s87) * change[9]
                        + (s46[7]) * change_h),
                -(h * s53)
                    + ((s87) * change[8] + (-(s12 * s59)) * change[9]
                        + ((s42[8] - s73 * real(0.5) - s44[9]) * h - s53) * change_h),
            ]),
            energy: -(s49 * (h * real(0.3333333333333333)))
                + ((s47[0]) * change[0] + (s47[1]) * change[1] + (s47[2]) * change[2]
                    + (s47[3]) * change[3] + (s47[4]) * change[4] + (s47[5]) * change[5]
                    + (s47[6]) * change[6] + (s47[7]) * change[7] + (s47[8]) * change[8]
                    + (s47[9]) * change[9]
                    + ((s75 * real(0.16666666666666666) + s76) * h - s55) * change_h),
        }
    }
}

#[allow(clippy::all, clippy::pedantic, unused_variables)]
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
