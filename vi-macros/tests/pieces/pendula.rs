/// Two coupled pendula, driven and damped: matrices, forces and sums over all coordinates.
///
/// Discretized by the rule `midpoint`. What the generator found:
///
/// * Not autonomous: `L` or `f` depends on the time `t`; a force acts
/// * The mass matrix depends on the state
/// * The step's equation in `v` is nonlinear: its Jacobian `A` depends on `v`, and Newton's iteration gives the step
/// * `A` is dense, not symmetric; solved in closed form
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(non_snake_case)]
pub struct Pendula<T = f64> {
    /// Parameter `m`, 1.2 by default.
    pub m: T,
    /// Parameter `k`, 0.7 by default.
    pub k: T,
    /// Parameter `b`, 0.1 by default.
    pub b: T,
}

impl ::core::default::Default for Pendula<f64> {
    fn default() -> Self {
        Self { m: 1.2, k: 0.7, b: 0.1 }
    }
}

impl<T: ::vi_core::Real> Pendula<T> {
    /// The same system in another kind of number, every parameter rounded to it.
    #[allow(unused_variables)]
    pub fn from_f64(system: &Pendula<f64>) -> Self {
        Self {
            m: T::real(system.m),
            k: T::real(system.k),
            b: T::real(system.b),
        }
    }
}

impl<T: ::vi_core::Real> ::vi_core::Parameters<T> for Pendula<T> {
    const PARAMETERS: &'static [&'static str] = &["m", "k", "b"];
    fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
        match name {
            "m" => Some(&mut self.m),
            "k" => Some(&mut self.k),
            "b" => Some(&mut self.b),
            _ => None,
        }
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::Lagrangian<2, T> for Pendula<T> {
    const NAME: &'static str = "Pendula";
    const COORDINATES: [&'static str; 2] = ["q[0]", "q[1]"];
    const AUTONOMOUS: bool = false;
    const FORCED: bool = true;
    const CYCLIC: [bool; 2] = [false, false];

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
            - self.k * real(0.5) * (s1 * s1)
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
        let s5 = self.k * real(0.5) * (s1 * s1) + self.m * (q_1_dot * q_1_dot)
            - (sin4 * real(0.3333333333333333) + real(1.0)) * (cos2 + cos3);
        s5
            + (q_1_dot * (cos2 * cos3 + sin2 * sin3) * real(0.25) + self.m * q_0_dot)
                * q_0_dot
    }

    /// `p_q[0] = dot(q[1])*cos(q[0] - q[1])/4 + 2*m*dot(q[0])`
    ///
    /// `p_q[1] = dot(q[0])*cos(q[0] - q[1])/4 + 2*m*dot(q[1])`
    ///
    /// 11 operations.
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
        let s2 = self.m * real(2.0);
        ::vi_core::SVector::from([
            q_1_dot * s1 * real(0.25) + s2 * q_0_dot,
            q_0_dot * s1 * real(0.25) + s2 * q_1_dot,
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
        let mass: ::vi_core::SMatrix<T, 2, 2> = ::vi_core::SMatrix::from_row_slice(
            &[s5, s6, s6, s5],
        );
        let applied: ::vi_core::SVector<T, 2> = ::vi_core::SVector::from([
            -(self.b * q_0_dot + s8 + s4 * sin1 + q_1_dot * q_1_dot * s7 * real(0.25)),
            s8 + q_0_dot * q_0_dot * s7 * real(0.25) - self.b * q_1_dot - s4 * sin2,
        ]);
        ::vi_core::linear::acceleration(time, &mass, &applied)
    }

    /// `D = (-b*dot(q[0]) - dot(q[0])*dot(q[1])*sin(q[0] - q[1])/4 - k*(q[0] - q[1]) - (sin(t)/3 + 1)*sin(q[0]))*dot(dot(q[0])) - dot(q[0])*(dot(q[0])*(-k - dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4 - (sin(t)/3 + 1)*cos(q[0])) - sin(q[0])*cos(t)/3 - dot(q[1])*sin(q[0] - q[1])*dot(dot(q[0]))/4 + dot(q[1])*(k + dot(q[0])*dot(q[1])*cos(q[0] - q[1])/4) - dot(q[0])*sin(q[0] - q[1])*dot(dot(q[1]))/4) + …`
    ///
    /// 78 operations.
    #[inline]
    fn step_density(
        &self,
        t: T,
        q: &::vi_core::SVector<T, 2>,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::core::result::Result<T, ::vi_core::StepError> {
        let [q_0_ddot, q_1_ddot]: [T; 2] = self.acceleration(t, q, v)?.into();
        let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
        let [q_0, q_1]: [T; 2] = (*q).into();
        let real = T::real;
        /// Part 1 of `step_density`: 39 operations.
        #[inline(never)]
        fn step_density_part_1<T: ::vi_core::Real>(
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
                * q_0_ddot + q_0_dot * sin1 * cos3 * real(0.3333333333333333);
            let s9 = q_0_dot * s4;
            let s10 = s8
                + q_1_ddot * (s6 - s7 * sin2 + (s9 * real(0.25) - system.b) * q_1_dot)
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
        fn step_density_part_2<T: ::vi_core::Real>(
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
                    - sin1 * cos3 * real(0.3333333333333333) - s12 - s13);
            let s15 = q_1_dot
                * (s12 + s13 + q_0_dot * s11 - q_1_dot * (s11 + s7 * cos2)
                    - cos3 * sin2 * real(0.3333333333333333));
            let s16 = s10 + sin3 * (cos1 + cos2) * real(0.3333333333333333) - s14 - s15;
            values[0] = s16;
        }
        let system = self;
        let inputs = [t, q_0, q_1, q_0_dot, q_1_dot, q_0_ddot, q_1_ddot];
        let mut values = [T::real(0.0); 11];
        step_density_part_1(system, &inputs, &mut values);
        step_density_part_2(system, &inputs, &mut values);
        Ok(values[0])
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
                s6 - self.k * real(0.5) * (s1 * s1),
            ),
            ("-b*dot(q[0])", -(self.b * q_0_dot)),
            ("-b*dot(q[1])", -(self.b * q_1_dot)),
        ];
        values.into_iter().find(|(_, value)| !value.is_finite()).map(|(text, _)| text)
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::DiscreteLagrangian<2, T> for Pendula<T> {
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
                - self.k * real(0.5) * (s1 * s1))
    }

    /// `d1_ld = h*L_t/2 - L + L_v_q[0]*v_q[0] + L_v_q[1]*v_q[1]`
    ///
    /// 50 operations.
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
        let t_mid = (t0 + t1) * real(0.5);
        let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
        let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
        let s1 = q_0_mid - q_1_mid;
        let [(sin2, cos2), (sin3, cos3), (sin4, cos4)] = T::sin_cos_each([
            q_0_mid,
            q_1_mid,
            t_mid,
        ]);
        let s5 = cos2 * cos3 + sin2 * sin3;
        let s6 = cos2 + cos3;
        let s7 = self.m * real(2.0);
        let s8 = self.k * real(0.5) * (s1 * s1)
            + q_0_dot * (s7 * q_0_dot + q_1_dot * s5 * real(0.25))
            + q_1_dot * (s7 * q_1_dot + q_0_dot * s5 * real(0.25));
        let s9 = s8 - q_0_dot * q_1_dot * s5 * real(0.25)
            - self.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
            - (sin4 * real(0.3333333333333333) + real(1.0)) * s6;
        s9 + h * real(0.16666666666666666) * s6 * cos4
    }

    /// `d2_ld_q[0] = h*L_q[0]/2 - L_v_q[0]`
    ///
    /// `d2_ld_q[1] = h*L_q[1]/2 - L_v_q[1]`
    ///
    /// 44 operations.
    #[inline]
    fn d2_ld(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
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
        let s7 = self.m * real(2.0);
        let s8 = h * real(0.5);
        ::vi_core::SVector::from([
            -(s7 * q_0_dot + q_1_dot * s4 * real(0.25)) - s8 * (s6 + s5 * sin1),
            s8 * (s6 - s5 * sin2) - (s7 * q_1_dot + q_0_dot * s4 * real(0.25)),
        ])
    }

    /// `d3_ld = L + h*L_t/2 - L_v_q[0]*v_q[0] - L_v_q[1]*v_q[1]`
    ///
    /// 50 operations.
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
        let t_mid = (t0 + t1) * real(0.5);
        let q_0_mid = (q_0_0 + q_0_1) * real(0.5);
        let q_1_mid = (q_1_0 + q_1_1) * real(0.5);
        let s1 = q_0_mid - q_1_mid;
        let [(sin2, cos2), (sin3, cos3), (sin4, cos4)] = T::sin_cos_each([
            q_0_mid,
            q_1_mid,
            t_mid,
        ]);
        let s5 = cos2 * cos3 + sin2 * sin3;
        let s6 = cos2 + cos3;
        let s7 = self.m * real(2.0);
        let s8 = q_0_dot * q_1_dot * s5 * real(0.25)
            + self.m * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
            + (sin4 * real(0.3333333333333333) + real(1.0)) * s6;
        let s9 = s8 - self.k * real(0.5) * (s1 * s1)
            - q_0_dot * (s7 * q_0_dot + q_1_dot * s5 * real(0.25))
            - q_1_dot * (s7 * q_1_dot + q_0_dot * s5 * real(0.25));
        s9 + h * real(0.16666666666666666) * s6 * cos4
    }

    /// `d4_ld_q[0] = L_v_q[0] + h*L_q[0]/2`
    ///
    /// `d4_ld_q[1] = L_v_q[1] + h*L_q[1]/2`
    ///
    /// 43 operations.
    #[inline]
    fn d4_ld(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
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
        let s7 = self.m * real(2.0);
        let s8 = h * real(0.5);
        ::vi_core::SVector::from([
            s7 * q_0_dot + q_1_dot * s4 * real(0.25) - s8 * (s6 + s5 * sin1),
            s7 * q_1_dot + q_0_dot * s4 * real(0.25) + s8 * (s6 - s5 * sin2),
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
    fn fd_plus(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
        let h = interval.t1 - interval.t0;
        let [q_0_0, q_1_0]: [T; 2] = interval.q0.into();
        let [q_0_1, q_1_1]: [T; 2] = interval.q1.into();
        let q_0_dot = (q_0_1 - q_0_0) / h;
        let q_1_dot = (q_1_1 - q_1_0) / h;
        let real = T::real;
        let s1 = self.b * h * real(0.5);
        ::vi_core::SVector::from([-(s1 * q_0_dot), -(s1 * q_1_dot)])
    }

    /// `gd_minus = -h*f_q[0]*v_q[0]/2 - h*f_q[1]*v_q[1]/2`
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
        (q_0_dot * q_0_dot + q_1_dot * q_1_dot) * (self.b * real(0.5)) * h
    }

    /// `gd_plus = -h*f_q[0]*v_q[0]/2 - h*f_q[1]*v_q[1]/2`
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
        (q_0_dot * q_0_dot + q_1_dot * q_1_dot) * (self.b * real(0.5)) * h
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::Stepping<2, T> for Pendula<T> {
    type Jacobian = ::vi_core::SMatrix<T, 2, 2>;
    const CONSTANT_JACOBIAN: bool = false;
    const SMOOTH: bool = true;
    const PLACE: f64 = 0.5f64;

    /// `residual_q[0] = L_v_q[0] - h*f_q[0]/2 - h*L_q[0]/2 - p0_q[0]_low - p0_q[0]`
    ///
    /// `residual_q[1] = L_v_q[1] - h*f_q[1]/2 - h*L_q[1]/2 - p0_q[1]_low - p0_q[1]`
    ///
    /// 83 operations.
    #[inline(always)]
    fn momentum_equation(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::MomentumEquation<2, T, Self::Jacobian> {
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
        fn momentum_equation_part_1<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 13],
            values: &mut [T; 17],
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
            let s2 = system.m * real(2.0);
            let [(sin3, cos3), (sin4, cos4), (sin5, _)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s6 = cos3 * cos4 + sin3 * sin4;
            let s7 = system.b * h * real(0.5);
            let s8 = q_0_dot * q_1_dot;
            let s9 = sin3 * cos4 - cos3 * sin4;
            let s10 = s8 * s9 * real(0.25) + system.k * (q_0_mid - q_1_mid);
            let s11 = sin5 * real(0.3333333333333333) + real(1.0);
            let s12 = s2 * q_0_dot + q_1_dot * s6 * real(0.25) - p0_q_0
                + (s7 * q_0_dot - p0_q_0_low + s1 * (s10 + s11 * sin3));
            values[6] = s1;
            values[7] = cos3;
            values[8] = cos4;
            values[9] = sin4;
            values[10] = s6;
            values[11] = s8;
            values[12] = s11;
            values[13] = s9;
            values[14] = s10;
            values[15] = s2;
            values[16] = s7;
            values[0] = s12;
        }
        /// Part 2 of `momentum_equation`: 40 operations.
        #[inline(never)]
        fn momentum_equation_part_2<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 13],
            values: &mut [T; 17],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s1 = values[6];
            let p0_q_1_low = inputs[12];
            let p0_q_1 = inputs[7];
            let cos3 = values[7];
            let cos4 = values[8];
            let sin4 = values[9];
            let s6 = values[10];
            let s8 = values[11];
            let s11 = values[12];
            let s9 = values[13];
            let s10 = values[14];
            let s2 = values[15];
            let s7 = values[16];
            let s13 = system.b * real(0.5);
            let s14 = h * real(0.25);
            let s15 = system.k + s8 * s6 * real(0.25);
            let s16 = s2 + (s13 + s14 * (s15 + s11 * cos3)) * h;
            let s17 = s6 * real(0.25);
            let s18 = (q_0_dot + q_1_dot) * real(0.125) * s9;
            let s19 = s14 * s15;
            let s20 = s17 - (s18 + s19) * h;
            let s21 = s2 * q_1_dot + q_0_dot * s6 * real(0.25) - p0_q_1
                + (s7 * q_1_dot - p0_q_1_low - s1 * (s10 - s11 * sin4));
            let s22 = s17 + (s18 - s19) * h;
            let s23 = s2 + (s13 + s14 * (s15 + s11 * cos4)) * h;
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
        let mut values = [T::real(0.0); 17];
        momentum_equation_part_1(system, &inputs, &mut values);
        momentum_equation_part_2(system, &inputs, &mut values);
        ::vi_core::MomentumEquation {
            residual: ::vi_core::SVector::from([values[0], values[1]]),
            jacobian: ::vi_core::SMatrix::from_row_slice(
                &[values[2], values[3], values[4], values[5]],
            ),
        }
    }

    /// `energy_residual = h*L_t/2 - L - E0_low - E0 + h*v_q[0]*L_q[0]/2 + v_q[0]*p0_q[0]_low + v_q[0]*p0_q[0] + h*v_q[1]*L_q[1]/2 + v_q[1]*p0_q[1]_low + v_q[1]*p0_q[1]`
    ///
    /// 172 operations.
    #[inline(always)]
    fn extended_system(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::ExtendedSystem<2, T, Self::Jacobian> {
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
        /// Part 1 of `extended_system`: 29 operations.
        #[inline(never)]
        fn extended_system_part_1<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 47],
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
            let s2 = system.m * real(2.0);
            let [(sin3, cos3), (sin4, cos4), (sin5, cos5)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s6 = cos3 + cos4;
            let s7 = cos3 * cos4 + sin3 * sin4;
            let s8 = q_1_dot * s7 * real(0.25);
            let s9 = system.b * h * real(0.5);
            let s10 = q_0_dot * q_1_dot;
            let s11 = sin3 * cos4 - cos3 * sin4;
            let s12 = q_0_mid - q_1_mid;
            values[12] = s1;
            values[13] = s12;
            values[14] = cos3;
            values[15] = cos4;
            values[16] = sin3;
            values[17] = sin4;
            values[18] = s7;
            values[19] = s10;
            values[22] = sin5;
            values[24] = s6;
            values[25] = cos5;
            values[26] = s11;
            values[31] = s2;
            values[32] = s8;
            values[33] = s9;
        }
        /// Part 2 of `extended_system`: 27 operations.
        #[inline(never)]
        fn extended_system_part_2<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 47],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let s1 = values[12];
            let p0_q_0_low = inputs[12];
            let p0_q_0 = inputs[6];
            let s12 = values[13];
            let cos3 = values[14];
            let sin3 = values[16];
            let s7 = values[18];
            let s10 = values[19];
            let sin5 = values[22];
            let s11 = values[26];
            let s2 = values[31];
            let s8 = values[32];
            let s9 = values[33];
            let s13 = s10 * s11 * real(0.25) + system.k * s12;
            let s14 = sin5 * real(0.3333333333333333) + real(1.0);
            let s15 = s14 * sin3;
            let s16 = s13 + s15;
            let s17 = s2 * q_0_dot + s8 - p0_q_0
                + (s9 * q_0_dot - p0_q_0_low + s1 * s16);
            let s18 = system.b * real(0.5);
            let s19 = h * real(0.25);
            let s20 = system.k + s10 * s7 * real(0.25);
            let s21 = s20 + s14 * cos3;
            let s22 = s2 + (s18 + s19 * s21) * h;
            values[23] = s14;
            values[27] = s15;
            values[28] = s13;
            values[29] = s16;
            values[0] = s17;
            values[35] = s20;
            values[36] = s21;
            values[38] = s18;
            values[39] = s19;
            values[2] = s22;
        }
        /// Part 3 of `extended_system`: 32 operations.
        #[inline(never)]
        fn extended_system_part_3<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 47],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s12 = values[13];
            let sin3 = values[16];
            let s7 = values[18];
            let cos5 = values[25];
            let s11 = values[26];
            let s15 = values[27];
            let s20 = values[35];
            let s21 = values[36];
            let s18 = values[38];
            let s19 = values[39];
            let s23 = s7 * real(0.25);
            let s24 = (q_0_dot + q_1_dot) * real(0.125) * s11;
            let s25 = s19 * s20;
            let s26 = s23 - (s24 + s25) * h;
            let s27 = system.k * real(0.5);
            let s28 = s27 * s12;
            let s29 = q_1_dot * q_1_dot;
            let s30 = s28 + s15 * real(0.5) + s18 * q_0_dot + s29 * s11 * real(0.125);
            let s31 = sin3 * cos5;
            let s32 = s31 * real(0.08333333333333333);
            let s33 = q_0_dot * s21 * real(0.25);
            let s34 = q_1_dot * s20;
            let s35 = s34 * real(0.25);
            let s36 = s30 + (s32 + s33 - s35) * h;
            let s37 = s30 + (s35 - s33 - s32) * h;
            values[21] = s29;
            values[34] = s27;
            values[40] = s23;
            values[41] = s24;
            values[42] = s25;
            values[4] = s26;
            values[43] = s28;
            values[44] = s31;
            values[45] = s33;
            values[46] = s34;
            values[6] = s36;
            values[9] = s37;
        }
        /// Part 4 of `extended_system`: 50 operations.
        #[inline(never)]
        fn extended_system_part_4<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 47],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s1 = values[12];
            let p0_q_0_low = inputs[12];
            let p0_q_0 = inputs[6];
            let p0_q_1_low = inputs[13];
            let p0_q_1 = inputs[7];
            let energy0_low = inputs[14];
            let energy0 = inputs[8];
            let s12 = values[13];
            let cos4 = values[15];
            let sin4 = values[17];
            let s7 = values[18];
            let s29 = values[21];
            let s14 = values[23];
            let s6 = values[24];
            let cos5 = values[25];
            let s13 = values[28];
            let s16 = values[29];
            let s2 = values[31];
            let s8 = values[32];
            let s9 = values[33];
            let s27 = values[34];
            let s20 = values[35];
            let s18 = values[38];
            let s19 = values[39];
            let s23 = values[40];
            let s24 = values[41];
            let s25 = values[42];
            let s38 = s14 * sin4;
            let s39 = s13 - s38;
            let s40 = q_0_dot * p0_q_0_low + q_1_dot * p0_q_1_low - energy0_low
                + (s6 * cos5 * real(0.16666666666666666) - q_0_dot * s16 * real(0.5)
                    + q_1_dot * s39 * real(0.5)) * h;
            let s41 = s2 * q_1_dot + q_0_dot * s7 * real(0.25) - p0_q_1
                + (s9 * q_1_dot - p0_q_1_low - s1 * s39);
            let s42 = s23 + (s24 - s25) * h;
            let s43 = s20 + s14 * cos4;
            let s44 = s2 + (s18 + s19 * s43) * h;
            let s45 = q_0_dot * q_0_dot;
            let s46 = q_1_dot * p0_q_1 + s27 * (s12 * s12) - energy0
                - system.m * (s45 + s29) - s14 * s6 + (p0_q_0 - s8) * q_0_dot;
            let s47 = s46 + s40;
            values[20] = s45;
            values[30] = s38;
            values[1] = s41;
            values[8] = s47;
            values[37] = s43;
            values[3] = s42;
            values[5] = s44;
        }
        /// Part 5 of `extended_system`: 34 operations.
        #[inline(never)]
        fn extended_system_part_5<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 47],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let sin4 = values[17];
            let s45 = values[20];
            let sin5 = values[22];
            let s6 = values[24];
            let cos5 = values[25];
            let s11 = values[26];
            let s38 = values[30];
            let s20 = values[35];
            let s43 = values[37];
            let s18 = values[38];
            let s28 = values[43];
            let s31 = values[44];
            let s33 = values[45];
            let s34 = values[46];
            let s48 = s38 * real(0.5) + s18 * q_1_dot - s28 - s45 * s11 * real(0.125);
            let s49 = sin4 * cos5;
            let s50 = s49 * real(0.08333333333333333);
            let s51 = q_0_dot * s20 * real(0.25);
            let s52 = q_1_dot * s43 * real(0.25);
            let s53 = (-s52 - s49 * real(0.16666666666666666)) * q_1_dot
                - sin5 * s6 * real(0.08333333333333333)
                + (s34 * real(0.5) - s33 - s31 * real(0.16666666666666666)) * q_0_dot;
            let s54 = s48 + (s50 - s51 + s52) * h;
            let s55 = s48 + (s51 - s52 - s50) * h;
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
        let mut values = [T::real(0.0); 47];
        extended_system_part_1(system, &inputs, &mut values);
        extended_system_part_2(system, &inputs, &mut values);
        extended_system_part_3(system, &inputs, &mut values);
        extended_system_part_4(system, &inputs, &mut values);
        extended_system_part_5(system, &inputs, &mut values);
        ::vi_core::ExtendedSystem {
            momentum: ::vi_core::MomentumEquation {
                residual: ::vi_core::SVector::from([values[0], values[1]]),
                jacobian: ::vi_core::SMatrix::from_row_slice(
                    &[values[2], values[3], values[4], values[5]],
                ),
            },
            residual_dh: ::vi_core::SVector::from([values[6], values[7]]),
            energy_residual: values[8],
            energy_dv: ::vi_core::SVector::from([values[9], values[10]]),
            energy_dh: values[11],
        }
    }

    /// Sums of the absolute values of the terms of `residual` and `energy_residual`.
    ///
    /// 200 operations.
    #[cold]
    fn magnitudes(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::Magnitudes<2, T> {
        let t0 = node.t;
        let t0_low = node.t_low;
        let energy0 = node.energy;
        let [q_0_0, q_1_0]: [T; 2] = node.q.into();
        let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
        let [p0_q_0, p0_q_1]: [T; 2] = node.p.into();
        let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
        let real = T::real;
        /// Part 1 of `magnitudes`: 33 operations.
        #[inline(never)]
        fn magnitudes_part_1<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 12],
            values: &mut [T; 38],
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
            let p0_q_0 = inputs[6];
            let s1 = h * real(0.5);
            let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
            let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
            let t_mid = t0 + (s1 + t0_low);
            let s2 = system.b * h;
            let [(sin3, cos3), (sin4, cos4), (sin5, cos5)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s6 = cos3 + cos4;
            let s7 = cos3 * cos4 + sin3 * sin4;
            let s8 = p0_q_0.abs() + (s2 * q_0_dot).abs() * real(0.5)
                + (system.m * q_0_dot).abs() * real(2.0)
                + (q_1_dot * s7).abs() * real(0.25);
            values[3] = s1;
            values[4] = t_mid;
            values[5] = q_0_mid;
            values[6] = q_1_mid;
            values[7] = s2;
            values[9] = cos3;
            values[10] = cos4;
            values[11] = sin3;
            values[12] = sin4;
            values[13] = s7;
            values[15] = sin5;
            values[17] = s6;
            values[18] = cos5;
            values[28] = s8;
        }
        /// Part 2 of `magnitudes`: 44 operations.
        #[inline(never)]
        fn magnitudes_part_2<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 12],
            values: &mut [T; 38],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let t_mid = values[4];
            let q_0_mid = values[5];
            let q_1_mid = values[6];
            let cos3 = values[9];
            let cos4 = values[10];
            let sin3 = values[11];
            let sin4 = values[12];
            let sin5 = values[15];
            let s6 = values[17];
            let cos5 = values[18];
            let s9 = h.abs() * real(0.5);
            let s10 = q_0_dot * q_1_dot;
            let s11 = sin3 * cos4 - cos3 * sin4;
            let s12 = s10 * s11;
            let s13 = q_0_mid - q_1_mid;
            let s14 = system.k * s13;
            let s15 = s12 * real(0.25) + s14;
            let s16 = s12.abs() * real(0.25) + s14.abs();
            let s17 = sin5 * real(0.3333333333333333) + real(1.0);
            let s18 = s17 * sin3;
            let s19 = s16 + s18.abs();
            let s20 = h * t_mid;
            let s21 = s6 * cos5 * real(0.3333333333333333)
                + (sin5 * s6 * real(0.16666666666666666)
                    + (q_0_dot * sin3 + q_1_dot * sin4) * real(0.16666666666666666)
                        * cos5) * h;
            let s22 = (sin5.abs() * real(0.3333333333333333)
                + (h * cos5).abs() * real(0.16666666666666666) + real(1.0))
                * (cos3.abs() + cos4.abs());
            values[8] = s13;
            values[14] = s10;
            values[16] = s17;
            values[19] = s11;
            values[20] = s18;
            values[22] = s16;
            values[23] = s19;
            values[24] = s20;
            values[27] = s9;
            values[32] = s21;
            values[33] = s15;
            values[35] = s22;
        }
        /// Part 3 of `magnitudes`: 50 operations.
        #[inline(never)]
        fn magnitudes_part_3<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 12],
            values: &mut [T; 38],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s1 = values[3];
            let q_0_mid = values[5];
            let q_1_mid = values[6];
            let p0_q_0 = inputs[6];
            let p0_q_1 = inputs[7];
            let energy0 = inputs[8];
            let s13 = values[8];
            let cos3 = values[9];
            let sin3 = values[11];
            let s7 = values[13];
            let s10 = values[14];
            let s17 = values[16];
            let cos5 = values[18];
            let s11 = values[19];
            let s18 = values[20];
            let s19 = values[23];
            let s20 = values[24];
            let s9 = values[27];
            let s8 = values[28];
            let s15 = values[33];
            let s23 = q_1_dot * s11 * real(0.25);
            let s24 = s10 * s7;
            let s25 = system.k + s24 * real(0.25);
            let s26 = s25 + s17 * cos3;
            let s27 = s15 + s18
                + (q_1_dot * s25 * real(0.5) - q_0_dot * s26 * real(0.5)
                    - sin3 * cos5 * real(0.16666666666666666)) * h;
            let s28 = s8 + s9 * s19
                + (s20 * sin3 * cos5).abs() * real(0.16666666666666666)
                + (q_0_mid * (s23 - s1 * s26)).abs();
            let s29 = s1 * s25;
            let s30 = s28 + (q_1_mid * (s23 - s29)).abs();
            let s31 = energy0.abs() + (q_0_dot * p0_q_0).abs() + (q_1_dot * p0_q_1).abs()
                + s24.abs() * real(0.25) + (system.k * (s13 * s13)).abs() * real(0.5);
            values[25] = s25;
            values[26] = s29;
            values[0] = s30;
            values[34] = s27;
            values[36] = s31;
        }
        /// Part 4 of `magnitudes`: 40 operations.
        #[inline(never)]
        fn magnitudes_part_4<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 12],
            values: &mut [T; 38],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let t_mid = values[4];
            let q_0_mid = values[5];
            let p0_q_1 = inputs[7];
            let s2 = values[7];
            let sin4 = values[12];
            let s7 = values[13];
            let s17 = values[16];
            let s11 = values[19];
            let s16 = values[22];
            let s19 = values[23];
            let s21 = values[32];
            let s27 = values[34];
            let s31 = values[36];
            let s32 = s31 + system.m.abs() * (q_0_dot * q_0_dot + q_1_dot * q_1_dot)
                + s19 * (h * q_0_dot).abs() * real(0.5);
            let s33 = p0_q_1.abs() + (s2 * q_1_dot).abs() * real(0.5)
                + (system.m * q_1_dot).abs() * real(2.0)
                + (q_0_dot * s7).abs() * real(0.25);
            let s34 = s17 * sin4;
            let s35 = s16 + s34.abs();
            let s36 = s32 + s35 * (h * q_1_dot).abs() * real(0.5) + (t_mid * s21).abs()
                + (q_0_mid * s27).abs();
            let s37 = q_0_dot * s11 * real(0.25);
            values[21] = s34;
            values[29] = s35;
            values[30] = s37;
            values[31] = s33;
            values[37] = s36;
        }
        /// Part 5 of `magnitudes`: 33 operations.
        #[inline(never)]
        fn magnitudes_part_5<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 12],
            values: &mut [T; 38],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s1 = values[3];
            let q_0_mid = values[5];
            let q_1_mid = values[6];
            let cos4 = values[10];
            let sin4 = values[12];
            let s17 = values[16];
            let cos5 = values[18];
            let s34 = values[21];
            let s20 = values[24];
            let s25 = values[25];
            let s29 = values[26];
            let s9 = values[27];
            let s35 = values[29];
            let s37 = values[30];
            let s33 = values[31];
            let s15 = values[33];
            let s22 = values[35];
            let s36 = values[37];
            let s38 = s33 + s9 * s35
                + (s20 * sin4 * cos5).abs() * real(0.16666666666666666)
                + (q_0_mid * (s37 + s29)).abs();
            let s39 = s25 + s17 * cos4;
            let s40 = s15 - s34
                + (sin4 * cos5 * real(0.16666666666666666) - q_0_dot * s25 * real(0.5)
                    + q_1_dot * s39 * real(0.5)) * h;
            let s41 = s36 + (q_1_mid * s40).abs() + s22;
            let s42 = s38 + (q_1_mid * (s37 + s1 * s39)).abs();
            values[1] = s42;
            values[2] = s41;
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
        ];
        let mut values = [T::real(0.0); 38];
        magnitudes_part_1(system, &inputs, &mut values);
        magnitudes_part_2(system, &inputs, &mut values);
        magnitudes_part_3(system, &inputs, &mut values);
        magnitudes_part_4(system, &inputs, &mut values);
        magnitudes_part_5(system, &inputs, &mut values);
        ::vi_core::Magnitudes {
            residual: ::vi_core::SVector::from([values[0], values[1]]),
            energy_residual: values[2],
        }
    }

    /// `p1 − p0_q[0] = h*f_q[0] + h*L_q[0]`
    ///
    /// `p1 − p0_q[1] = h*f_q[1] + h*L_q[1]`
    ///
    /// `E1 − E0 = h*f_q[0]*v_q[0] - h*L_t + h*f_q[1]*v_q[1]`
    ///
    /// 49 operations.
    #[inline(always)]
    fn increment(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::Increment<2, T> {
        let t0 = node.t;
        let t0_low = node.t_low;
        let [q_0_0, q_1_0]: [T; 2] = node.q.into();
        let [q_0_0_low, q_1_0_low]: [T; 2] = node.q_low.into();
        let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
        let real = T::real;
        let s1 = h * real(0.5);
        let t_mid = t0 + (s1 + t0_low);
        let q_0_mid = q_0_0 + (s1 * q_0_dot + q_0_0_low);
        let q_1_mid = q_1_0 + (s1 * q_1_dot + q_1_0_low);
        let s2 = self.b * h;
        let [(sin3, cos3), (sin4, cos4), (sin5, cos5)] = T::sin_cos_each([
            t_mid,
            q_0_mid,
            q_1_mid,
        ]);
        let s6 = sin3 * real(0.3333333333333333) + real(1.0);
        let s7 = q_0_dot * q_1_dot * (sin4 * cos5 - cos4 * sin5) * real(0.25)
            + self.k * (q_0_mid - q_1_mid);
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                -(h * (s7 + s6 * sin4)) - s2 * q_0_dot,
                h * (s7 - s6 * sin5) - s2 * q_1_dot,
            ]),
            energy: -(((cos4 + cos5) * cos3 * real(0.3333333333333333)
                + self.b * (q_0_dot * q_0_dot) + self.b * (q_1_dot * q_1_dot)) * h),
        }
    }

    /// `p1 − p0_q[0] = h*f_q[0] + h*L_q[0]`
    ///
    /// `p1 − p0_q[1] = h*f_q[1] + h*L_q[1]`
    ///
    /// and to first order at `v + dv`.
    ///
    /// 102 operations.
    #[inline(always)]
    fn momentum_step(
        &self,
        node: &::vi_core::Node<2, T>,
        place: &::vi_core::SVector<T, 2>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
        solve: impl ::core::ops::FnOnce(
            &::vi_core::MomentumEquation<2, T, Self::Jacobian>,
        ) -> ::vi_core::SVector<T, 2>,
    ) -> ::vi_core::SVector<T, 2> {
        let t0 = node.t;
        let t0_low = node.t_low;
        let [p0_q_0, p0_q_1]: [T; 2] = node.p.into();
        let [p0_q_0_low, p0_q_1_low]: [T; 2] = node.p_low.into();
        let [q_0_dot, q_1_dot]: [T; 2] = (*v).into();
        let [q_0_mid, q_1_mid]: [T; 2] = (*place).into();
        let real = T::real;
        /// Part 1 of `momentum_step`: 37 operations.
        #[inline(never)]
        fn momentum_step_part_1<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 11],
            values: &mut [T; 30],
        ) {
            let real = T::real;
            let h = inputs[1];
            let t0 = inputs[0];
            let q_0_dot = inputs[2];
            let q_1_dot = inputs[3];
            let t0_low = inputs[6];
            let p0_q_0_low = inputs[7];
            let p0_q_0 = inputs[4];
            let q_0_mid = inputs[9];
            let q_1_mid = inputs[10];
            let s1 = h * real(0.5);
            let t_mid = t0 + (s1 + t0_low);
            let s2 = system.m * real(2.0);
            let [(sin3, cos3), (sin4, cos4), (sin5, _)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s6 = cos3 * cos4 + sin3 * sin4;
            let s7 = system.b * h;
            let s8 = s7 * real(0.5);
            let s9 = q_0_dot * q_1_dot;
            let s10 = sin3 * cos4 - cos3 * sin4;
            let s11 = s9 * s10 * real(0.25) + system.k * (q_0_mid - q_1_mid);
            let s12 = sin5 * real(0.3333333333333333) + real(1.0);
            let s13 = s11 + s12 * sin3;
            let s14 = s2 * q_0_dot + q_1_dot * s6 * real(0.25) - p0_q_0
                + (s8 * q_0_dot - p0_q_0_low + s1 * s13);
            values[12] = s1;
            values[13] = s7;
            values[14] = cos3;
            values[15] = cos4;
            values[16] = sin4;
            values[17] = s6;
            values[18] = s9;
            values[19] = s12;
            values[20] = s10;
            values[21] = s11;
            values[22] = s13;
            values[24] = s2;
            values[25] = s8;
            values[0] = s14;
        }
        /// Part 2 of `momentum_step`: 50 operations.
        #[inline(never)]
        fn momentum_step_part_2<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 11],
            values: &mut [T; 30],
        ) {
            let real = T::real;
            let h = inputs[1];
            let q_0_dot = inputs[2];
            let q_1_dot = inputs[3];
            let s1 = values[12];
            let p0_q_1_low = inputs[8];
            let p0_q_1 = inputs[5];
            let s7 = values[13];
            let cos3 = values[14];
            let cos4 = values[15];
            let sin4 = values[16];
            let s6 = values[17];
            let s9 = values[18];
            let s12 = values[19];
            let s10 = values[20];
            let s11 = values[21];
            let s13 = values[22];
            let s2 = values[24];
            let s8 = values[25];
            let s15 = system.b * real(0.5);
            let s16 = h * real(0.25);
            let s17 = system.k + s9 * s6 * real(0.25);
            let s18 = s17 + s12 * cos3;
            let s19 = s2 + (s15 + s16 * s18) * h;
            let s20 = s6 * real(0.25);
            let s21 = (q_0_dot + q_1_dot) * real(0.125) * s10;
            let s22 = s16 * s17;
            let s23 = s20 - (s21 + s22) * h;
            let s24 = -(h * s13) - s7 * q_0_dot;
            let s25 = q_1_dot * s10 * real(0.25);
            let s26 = (-(system.b + s25) - s1 * s18) * h;
            let s27 = s1 * s17;
            let s28 = (s25 + s27) * h;
            let s29 = s11 - s12 * sin4;
            let s30 = s2 * q_1_dot + q_0_dot * s6 * real(0.25) - p0_q_1
                + (s8 * q_1_dot - p0_q_1_low - s1 * s29);
            let s31 = s20 + (s21 - s22) * h;
            let s32 = s17 + s12 * cos4;
            values[23] = s29;
            values[1] = s30;
            values[26] = s32;
            values[27] = s15;
            values[28] = s16;
            values[2] = s19;
            values[3] = s31;
            values[4] = s23;
            values[6] = s24;
            values[8] = s26;
            values[29] = s27;
            values[10] = s28;
        }
        /// Part 3 of `momentum_step`: 15 operations.
        #[inline(never)]
        fn momentum_step_part_3<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 11],
            values: &mut [T; 30],
        ) {
            let real = T::real;
            let h = inputs[1];
            let q_0_dot = inputs[2];
            let q_1_dot = inputs[3];
            let s1 = values[12];
            let s7 = values[13];
            let s10 = values[20];
            let s29 = values[23];
            let s2 = values[24];
            let s32 = values[26];
            let s15 = values[27];
            let s16 = values[28];
            let s27 = values[29];
            let s33 = s2 + (s15 + s16 * s32) * h;
            let s34 = h * s29 - s7 * q_1_dot;
            let s35 = q_0_dot * s10 * real(0.25);
            let s36 = (s27 - s35) * h;
            let s37 = (s35 - system.b - s1 * s32) * h;
            values[5] = s33;
            values[7] = s34;
            values[9] = s36;
            values[11] = s37;
        }
        let system = self;
        let inputs = [
            t0,
            h,
            q_0_dot,
            q_1_dot,
            p0_q_0,
            p0_q_1,
            t0_low,
            p0_q_0_low,
            p0_q_1_low,
            q_0_mid,
            q_1_mid,
        ];
        let mut values = [T::real(0.0); 30];
        momentum_step_part_1(system, &inputs, &mut values);
        momentum_step_part_2(system, &inputs, &mut values);
        momentum_step_part_3(system, &inputs, &mut values);
        let change: [T; 2] = solve(
                &::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([values[0], values[1]]),
                    jacobian: ::vi_core::SMatrix::from_row_slice(
                        &[values[2], values[3], values[4], values[5]],
                    ),
                },
            )
            .into();
        ::vi_core::SVector::from([
            values[6] + ((values[8]) * change[0] + (values[9]) * change[1]),
            values[7] + ((values[10]) * change[0] + (values[11]) * change[1]),
        ])
    }

    /// `p1 − p0_q[0] = h*f_q[0] + h*L_q[0]`
    ///
    /// `p1 − p0_q[1] = h*f_q[1] + h*L_q[1]`
    ///
    /// `E1 − E0 = h*f_q[0]*v_q[0] - h*L_t + h*f_q[1]*v_q[1]`
    ///
    /// and to first order at `(v + dv, h + dh)`.
    ///
    /// 243 operations.
    #[inline(always)]
    fn extended_step(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
        solve: impl ::core::ops::FnOnce(
            &::vi_core::ExtendedSystem<2, T, Self::Jacobian>,
        ) -> (::vi_core::SVector<T, 2>, T),
    ) -> ::vi_core::Increment<2, T> {
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
        /// Part 1 of `extended_step`: 28 operations.
        #[inline(never)]
        fn extended_step_part_1<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
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
            let s2 = system.m * real(2.0);
            let [(sin3, cos3), (sin4, cos4), (sin5, cos5)] = T::sin_cos_each([
                q_0_mid,
                q_1_mid,
                t_mid,
            ]);
            let s6 = cos3 * cos4 + sin3 * sin4;
            let s7 = q_1_dot * s6 * real(0.25);
            let s8 = system.b * h;
            let s9 = s8 * real(0.5);
            let s10 = q_0_dot * q_1_dot;
            let s11 = sin3 * cos4 - cos3 * sin4;
            let s12 = q_0_mid - q_1_mid;
            values[24] = s1;
            values[25] = s8;
            values[26] = s12;
            values[27] = cos3;
            values[28] = cos4;
            values[29] = sin3;
            values[30] = sin4;
            values[31] = s6;
            values[32] = s10;
            values[35] = sin5;
            values[37] = cos5;
            values[38] = s11;
            values[45] = s2;
            values[46] = s7;
            values[47] = s9;
        }
        /// Part 2 of `extended_step`: 27 operations.
        #[inline(never)]
        fn extended_step_part_2<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let s1 = values[24];
            let p0_q_0_low = inputs[12];
            let p0_q_0 = inputs[6];
            let s12 = values[26];
            let cos3 = values[27];
            let sin3 = values[29];
            let s6 = values[31];
            let s10 = values[32];
            let sin5 = values[35];
            let s11 = values[38];
            let s2 = values[45];
            let s7 = values[46];
            let s9 = values[47];
            let s13 = system.k * s12;
            let s14 = s10 * s11 * real(0.25) + s13;
            let s15 = sin5 * real(0.3333333333333333) + real(1.0);
            let s16 = s15 * sin3;
            let s17 = s14 + s16;
            let s18 = s2 * q_0_dot + s7 - p0_q_0
                + (s9 * q_0_dot - p0_q_0_low + s1 * s17);
            let s19 = system.b * real(0.5);
            let s20 = h * real(0.25);
            let s21 = system.k + s10 * s6 * real(0.25);
            let s22 = s21 + s15 * cos3;
            let s23 = s2 + (s19 + s20 * s22) * h;
            values[36] = s15;
            values[39] = s13;
            values[40] = s16;
            values[41] = s14;
            values[42] = s17;
            values[0] = s18;
            values[49] = s21;
            values[50] = s22;
            values[52] = s19;
            values[53] = s20;
            values[2] = s23;
        }
        /// Part 3 of `extended_step`: 36 operations.
        #[inline(never)]
        fn extended_step_part_3<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s8 = values[25];
            let s12 = values[26];
            let sin3 = values[29];
            let s6 = values[31];
            let cos5 = values[37];
            let s11 = values[38];
            let s16 = values[40];
            let s17 = values[42];
            let s21 = values[49];
            let s22 = values[50];
            let s19 = values[52];
            let s20 = values[53];
            let s24 = s6 * real(0.25);
            let s25 = (q_0_dot + q_1_dot) * real(0.125) * s11;
            let s26 = s20 * s21;
            let s27 = s24 - (s25 + s26) * h;
            let s28 = system.k * real(0.5);
            let s29 = s28 * s12;
            let s30 = q_1_dot * q_1_dot;
            let s31 = s29 + s16 * real(0.5) + s19 * q_0_dot + s30 * s11 * real(0.125);
            let s32 = sin3 * cos5;
            let s33 = s32 * real(0.08333333333333333);
            let s34 = q_0_dot * s22;
            let s35 = s34 * real(0.25);
            let s36 = q_1_dot * s21;
            let s37 = s36 * real(0.25);
            let s38 = s31 + (s33 + s35 - s37) * h;
            let s39 = s31 + (s37 - s35 - s33) * h;
            let s40 = -(h * s17) - s8 * q_0_dot;
            values[34] = s30;
            values[48] = s28;
            values[54] = s24;
            values[55] = s25;
            values[56] = s26;
            values[4] = s27;
            values[57] = s29;
            values[58] = s32;
            values[59] = s34;
            values[60] = s35;
            values[61] = s36;
            values[6] = s38;
            values[9] = s39;
            values[12] = s40;
        }
        /// Part 4 of `extended_step`: 47 operations.
        #[inline(never)]
        fn extended_step_part_4<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s1 = values[24];
            let p0_q_1_low = inputs[13];
            let p0_q_1 = inputs[7];
            let cos4 = values[28];
            let sin3 = values[29];
            let sin4 = values[30];
            let s6 = values[31];
            let s15 = values[36];
            let cos5 = values[37];
            let s11 = values[38];
            let s14 = values[41];
            let s2 = values[45];
            let s9 = values[47];
            let s21 = values[49];
            let s22 = values[50];
            let s24 = values[54];
            let s25 = values[55];
            let s26 = values[56];
            let s41 = q_1_dot * s11 * real(0.25);
            let s42 = system.b + s41;
            let s43 = (-s42 - s1 * s22) * h;
            let s44 = s1 * s21;
            let s45 = (s41 + s44) * h;
            let s46 = h * real(0.16666666666666666);
            let s47 = system.b * real(2.0);
            let s48 = (s46 * sin3 * cos5 - s47 * q_0_dot) * h;
            let s49 = q_0_dot * s11 * real(0.25);
            let s50 = (s44 - s49) * h;
            let s51 = s49 - system.b;
            let s52 = s21 + s15 * cos4;
            let s53 = (s51 - s1 * s52) * h;
            let s54 = (s46 * sin4 * cos5 - s47 * q_1_dot) * h;
            let s55 = s15 * sin4;
            let s56 = s14 - s55;
            let s57 = s2 * q_1_dot + q_0_dot * s6 * real(0.25) - p0_q_1
                + (s9 * q_1_dot - p0_q_1_low - s1 * s56);
            let s58 = s24 + (s25 - s26) * h;
            values[43] = s55;
            values[44] = s56;
            values[1] = s57;
            values[51] = s52;
            values[3] = s58;
            values[68] = s42;
            values[15] = s43;
            values[16] = s50;
            values[18] = s45;
            values[69] = s51;
            values[19] = s53;
            values[21] = s48;
            values[22] = s54;
        }
        /// Part 5 of `extended_step`: 50 operations.
        #[inline(never)]
        fn extended_step_part_5<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let s8 = values[25];
            let sin4 = values[30];
            let cos5 = values[37];
            let s11 = values[38];
            let s13 = values[39];
            let s16 = values[40];
            let s55 = values[43];
            let s56 = values[44];
            let s2 = values[45];
            let s21 = values[49];
            let s52 = values[51];
            let s19 = values[52];
            let s20 = values[53];
            let s29 = values[57];
            let s32 = values[58];
            let s34 = values[59];
            let s36 = values[61];
            let s42 = values[68];
            let s51 = values[69];
            let s59 = s2 + (s19 + s20 * s52) * h;
            let s60 = q_0_dot * q_0_dot;
            let s61 = s55 * real(0.5) + s19 * q_1_dot - s29 - s60 * s11 * real(0.125);
            let s62 = sin4 * cos5;
            let s63 = s62 * real(0.08333333333333333);
            let s64 = q_0_dot * s21;
            let s65 = s64 * real(0.25);
            let s66 = q_1_dot * s52;
            let s67 = s66 * real(0.25);
            let s68 = s61 + (s63 - s65 + s67) * h;
            let s69 = s61 + (s65 - s67 - s63) * h;
            let s70 = h * s56 - s8 * q_1_dot;
            let s71 = s36 * real(0.5);
            let s72 = s32 * real(0.16666666666666666);
            let s73 = -(s42 * q_0_dot) - (s13 + s16) + (s71 - s34 * real(0.5) - s72) * h;
            let s74 = s62 * real(0.16666666666666666);
            let s75 = s13 - s55 + s51 * q_1_dot
                + (s64 * real(0.5) - s66 * real(0.5) - s74) * h;
            values[33] = s60;
            values[5] = s59;
            values[62] = s67;
            values[7] = s68;
            values[10] = s69;
            values[64] = s72;
            values[65] = s71;
            values[66] = s74;
            values[13] = s70;
            values[17] = s73;
            values[20] = s75;
        }
        /// Part 6 of `extended_step`: 46 operations.
        #[inline(never)]
        fn extended_step_part_6<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let p0_q_0_low = inputs[12];
            let p0_q_0 = inputs[6];
            let p0_q_1_low = inputs[13];
            let p0_q_1 = inputs[7];
            let energy0_low = inputs[14];
            let energy0 = inputs[8];
            let s12 = values[26];
            let cos3 = values[27];
            let cos4 = values[28];
            let s60 = values[33];
            let s30 = values[34];
            let sin5 = values[35];
            let s15 = values[36];
            let cos5 = values[37];
            let s17 = values[42];
            let s56 = values[44];
            let s7 = values[46];
            let s28 = values[48];
            let s35 = values[60];
            let s67 = values[62];
            let s72 = values[64];
            let s71 = values[65];
            let s74 = values[66];
            let s76 = cos3 + cos4;
            let s77 = q_1_dot * p0_q_1 + s28 * (s12 * s12) - energy0
                - system.m * (s60 + s30) - s15 * s76 + (p0_q_0 - s7) * q_0_dot;
            let s78 = sin5 * s76;
            let s79 = (-s67 - s74) * q_1_dot - s78 * real(0.08333333333333333)
                + (s71 - s35 - s72) * q_0_dot;
            let s80 = s76 * cos5;
            let s81 = q_0_dot * p0_q_0_low + q_1_dot * p0_q_1_low - energy0_low
                + (s80 * real(0.16666666666666666) - q_0_dot * s17 * real(0.5)
                    + q_1_dot * s56 * real(0.5)) * h;
            let s82 = s77 + s81;
            let s83 = s80 * real(0.3333333333333333) + system.b * s60 + system.b * s30;
            let s84 = -(s83 * h);
            values[8] = s82;
            values[63] = s78;
            values[11] = s79;
            values[67] = s83;
            values[14] = s84;
        }
        /// Part 7 of `extended_step`: 9 operations.
        #[inline(never)]
        fn extended_step_part_7<T: ::vi_core::Real>(
            system: &Pendula<T>,
            inputs: &[T; 15],
            values: &mut [T; 70],
        ) {
            let real = T::real;
            let h = inputs[3];
            let q_0_dot = inputs[4];
            let q_1_dot = inputs[5];
            let sin3 = values[29];
            let sin4 = values[30];
            let cos5 = values[37];
            let s78 = values[63];
            let s83 = values[67];
            let s85 = (s78 * real(0.16666666666666666)
                + (q_0_dot * sin3 + q_1_dot * sin4) * real(0.16666666666666666) * cos5)
                * h - s83;
            values[23] = s85;
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
        let mut values = [T::real(0.0); 70];
        extended_step_part_1(system, &inputs, &mut values);
        extended_step_part_2(system, &inputs, &mut values);
        extended_step_part_3(system, &inputs, &mut values);
        extended_step_part_4(system, &inputs, &mut values);
        extended_step_part_5(system, &inputs, &mut values);
        extended_step_part_6(system, &inputs, &mut values);
        extended_step_part_7(system, &inputs, &mut values);
        let (change, change_h) = solve(
            &::vi_core::ExtendedSystem {
                momentum: ::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([values[0], values[1]]),
                    jacobian: ::vi_core::SMatrix::from_row_slice(
                        &[values[2], values[3], values[4], values[5]],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([values[6], values[7]]),
                energy_residual: values[8],
                energy_dv: ::vi_core::SVector::from([values[9], values[10]]),
                energy_dh: values[11],
            },
        );
        let change: [T; 2] = change.into();
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                values[12]
                    + ((values[15]) * change[0] + (values[16]) * change[1]
                        + (values[17]) * change_h),
                values[13]
                    + ((values[18]) * change[0] + (values[19]) * change[1]
                        + (values[20]) * change_h),
            ]),
            energy: values[14]
                + ((values[21]) * change[0] + (values[22]) * change[1]
                    + (values[23]) * change_h),
        }
    }
}

#[allow(clippy::all, clippy::pedantic, unused_variables)]
impl ::vi_core::Batch<2> for Pendula<f64> {
    type Rows<const W: usize> = Pendula<[f64; W]>;
    type In<T: ::vi_core::Real> = Pendula<T>;
    fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
        Pendula {
            m: ::core::array::from_fn(|index| systems[index].m),
            k: ::core::array::from_fn(|index| systems[index].k),
            b: ::core::array::from_fn(|index| systems[index].b),
        }
    }

    #[inline(always)]
    fn pick<T: ::vi_core::Real, const W: usize>(
        rows: &Self::Rows<W>,
        index: usize,
    ) -> Self::In<T> {
        Pendula {
            m: T::real(rows.m[index]),
            k: T::real(rows.k[index]),
            b: T::real(rows.b[index]),
        }
    }
}

impl ::vi_core::check::Checked<2> for Pendula<f64> {
    type In<T: ::vi_core::Real> = Pendula<T>;
    fn convert<T: ::vi_core::Real>(&self) -> Pendula<T> {
        Pendula::from_f64(self)
    }
}
