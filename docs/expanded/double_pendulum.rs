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
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(non_snake_case)]
pub struct DoublePendulum<T = f64> {
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

impl<T: ::vi_core::Real> DoublePendulum<T> {
    /// The same system in another kind of number, every parameter rounded to it.
    #[allow(unused_variables)]
    pub fn from_f64(system: &DoublePendulum<f64>) -> Self {
        Self {
            m1: T::real(system.m1),
            m2: T::real(system.m2),
            l1: T::real(system.l1),
            l2: T::real(system.l2),
            g: T::real(system.g),
        }
    }
}

impl<T: ::vi_core::Real> ::vi_core::Parameters<T> for DoublePendulum<T> {
    const PARAMETERS: &'static [&'static str] = &["m1", "m2", "l1", "l2", "g"];
    fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
        match name {
            "m1" => Some(&mut self.m1),
            "m2" => Some(&mut self.m2),
            "l1" => Some(&mut self.l1),
            "l2" => Some(&mut self.l2),
            "g" => Some(&mut self.g),
            _ => None,
        }
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::Lagrangian<2, T> for DoublePendulum<T> {
    const NAME: &'static str = "DoublePendulum";
    const COORDINATES: [&'static str; 2] = ["θ1", "θ2"];
    const AUTONOMOUS: bool = true;
    const FORCED: bool = false;
    const CYCLIC: [bool; 2] = [false, false];

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
        let s5 = self.m2 * (self.l2 * self.l2) * real(0.5) * (θ2_dot * θ2_dot)
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
        let s5 = self.m2 * (self.l2 * self.l2) * real(0.5) * (θ2_dot * θ2_dot)
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
        let s4 = sin2 * cos3 - cos2 * sin3;
        let s5 = self.m2 * self.l1 * self.l2;
        let s6 = s5 * (cos2 * cos3 + sin2 * sin3);
        let mass: ::vi_core::SMatrix<T, 2, 2> = ::vi_core::SMatrix::from_row_slice(
            &[self.l1 * self.l1 * s1, s6, s6, self.m2 * (self.l2 * self.l2)],
        );
        let applied: ::vi_core::SVector<T, 2> = ::vi_core::SVector::from([
            -(self.l1 * self.g * s1 * sin2 + s5 * (θ2_dot * θ2_dot) * s4),
            s5 * (θ1_dot * θ1_dot) * s4 - self.m2 * self.l2 * self.g * sin3,
        ]);
        ::vi_core::linear::acceleration(time, &mass, &applied)
    }

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
        let [θ1_ddot, θ2_ddot]: [T; 2] = self.acceleration(t, q, v)?.into();
        let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
        let [θ1, θ2]: [T; 2] = (*q).into();
        let [(sin1, cos1), (sin2, cos2)] = T::sin_cos_each([θ1, θ2]);
        let s3 = cos1 * cos2 + sin1 * sin2;
        let s4 = sin1 * cos2 - cos1 * sin2;
        let s5 = self.m2 * self.l1 * self.l2;
        let s6 = s5 * θ1_dot;
        let s7 = s6 * θ2_dot;
        let s8 = s7 * s4;
        let s9 = self.l1 * self.g * (self.m1 + self.m2);
        let s10 = s7 * s3;
        let s11 = self.m2 * self.l2 * self.g;
        let s12 = s5 * θ2_dot * s4 * θ1_ddot;
        let s13 = s6 * s4 * θ2_ddot;
        let s14 = θ2_dot
            * (s12 + s13 + s5 * (θ1_dot * θ1_dot) * θ2_dot * s3
                - θ2_dot * (s10 + s11 * cos2));
        let s15 = θ2_ddot * (s8 - s11 * sin2) - (s8 + s9 * sin1) * θ1_ddot
            - θ1_dot
                * (s6 * (θ2_dot * θ2_dot) * s3 - θ1_dot * (s10 + s9 * cos1) - s12
                    - s13);
        Ok(s15 - s14)
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
        let s5 = self.m2 * (self.l2 * self.l2) * real(0.5) * (θ2_dot * θ2_dot)
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
        values.into_iter().find(|(_, value)| !value.is_finite()).map(|(text, _)| text)
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::DiscreteLagrangian<2, T> for DoublePendulum<T> {
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
        let s5 = self.m2 * (self.l2 * self.l2) * real(0.5) * (θ2_dot * θ2_dot)
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
        let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = self.l1 * self.l1 * s1;
        let s6 = self.m2 * self.l1 * self.l2;
        let s7 = self.m2 * (self.l2 * self.l2);
        let s8 = s6 * θ1_dot;
        let s9 = θ1_dot * (s5 * θ1_dot + s6 * θ2_dot * s4)
            + θ2_dot * (s7 * θ2_dot + s8 * s4) - s5 * real(0.5) * (θ1_dot * θ1_dot);
        let s10 = s9 - s7 * real(0.5) * (θ2_dot * θ2_dot) - s8 * θ2_dot * s4
            - self.l1 * self.g * s1 * cos2;
        s10 - self.m2 * self.l2 * self.g * cos3
    }

    /// `d2_ld_θ1 = h*L_θ1/2 - L_v_θ1`
    ///
    /// `d2_ld_θ2 = h*L_θ2/2 - L_v_θ2`
    ///
    /// 45 operations.
    #[inline]
    fn d2_ld(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
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
        let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = self.l1 * self.l1 * s1;
        let s6 = self.m2 * self.l1 * self.l2;
        let s7 = self.m2 * (self.l2 * self.l2);
        let s8 = s6 * θ1_dot;
        let s9 = s5 * real(0.5) * (θ1_dot * θ1_dot)
            + s7 * real(0.5) * (θ2_dot * θ2_dot) + s8 * θ2_dot * s4
            + self.l1 * self.g * s1 * cos2;
        s9 + self.m2 * self.l2 * self.g * cos3
            - θ1_dot * (s5 * θ1_dot + s6 * θ2_dot * s4)
            - θ2_dot * (s7 * θ2_dot + s8 * s4)
    }

    /// `d4_ld_θ1 = L_v_θ1 + h*L_θ1/2`
    ///
    /// `d4_ld_θ2 = L_v_θ2 + h*L_θ2/2`
    ///
    /// 44 operations.
    #[inline]
    fn d4_ld(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
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
    fn fd_plus(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
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

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::Stepping<2, T> for DoublePendulum<T> {
    type Jacobian = ::vi_core::SMatrix<T, 2, 2>;
    const CONSTANT_JACOBIAN: bool = false;
    const SMOOTH: bool = true;
    const PLACE: f64 = 0.5f64;

    /// `residual_θ1 = L_v_θ1 - h*L_θ1/2 - p0_θ1_low - p0_θ1`
    ///
    /// `residual_θ2 = L_v_θ2 - h*L_θ2/2 - p0_θ2_low - p0_θ2`
    ///
    /// 75 operations.
    #[inline(always)]
    fn momentum_equation(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::MomentumEquation<2, T, Self::Jacobian> {
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
        let [(sin3, cos3), (sin4, cos4)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s5 = cos3 * cos4 + sin3 * sin4;
        let s6 = sin3 * cos4 - cos3 * sin4;
        let s7 = self.m2 * self.l1 * self.l2;
        let s8 = s7 * θ1_dot;
        let s9 = s8 * θ2_dot;
        let s10 = s9 * s6;
        let s11 = self.l1 * self.g * s2;
        let s12 = self.m2 * self.l2 * self.g;
        let s13 = self.l1 * self.l1;
        let s14 = self.m2 * (self.l2 * self.l2);
        let s15 = s9 * s5;
        let s16 = h * h * real(0.25);
        let s17 = s7 * s5;
        let s18 = s7 * real(0.5) * (θ1_dot + θ2_dot) * s6;
        let s19 = s15 * (h * real(0.25));
        ::vi_core::MomentumEquation {
            residual: ::vi_core::SVector::from([
                s13 * s2 * θ1_dot + s7 * θ2_dot * s5 - p0_θ1
                    - (p0_θ1_low - s1 * (s10 + s11 * sin3)),
                s14 * θ2_dot + s8 * s5 - p0_θ2 - (p0_θ2_low + s1 * (s10 - s12 * sin4)),
            ]),
            jacobian: ::vi_core::SMatrix::from_row_slice(
                &[
                    s2 * s13 + s16 * (s15 + s11 * cos3),
                    s17 + (s18 - s19) * h,
                    s17 - (s18 + s19) * h,
                    s14 + s16 * (s15 + s12 * cos4),
                ],
            ),
        }
    }

    /// `energy_residual = h*v_θ1*L_θ1/2 - L - E0_low - E0 + v_θ1*p0_θ1_low + v_θ1*p0_θ1 + h*v_θ2*L_θ2/2 + v_θ2*p0_θ2_low + v_θ2*p0_θ2`
    ///
    /// 133 operations.
    #[inline(always)]
    fn extended_system(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::ExtendedSystem<2, T, Self::Jacobian> {
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
        let [(sin3, cos3), (sin4, cos4)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s5 = cos3 * cos4 + sin3 * sin4;
        let s6 = sin3 * cos4 - cos3 * sin4;
        let s7 = self.m2 * self.l1 * self.l2;
        let s8 = s7 * θ1_dot;
        let s9 = s8 * θ2_dot;
        let s10 = s9 * s6;
        let s11 = self.l1 * self.g * s2;
        let s12 = s11 * sin3;
        let s13 = s10 + s12;
        let s14 = self.m2 * self.l2 * self.g;
        let s15 = s14 * sin4;
        let s16 = s10 - s15;
        let s17 = self.l1 * self.l1;
        let s18 = s17 * s2 * θ1_dot;
        let s19 = s7 * θ2_dot * s5;
        let s20 = self.m2 * (self.l2 * self.l2);
        let s21 = s20 * θ2_dot;
        let s22 = s11 * cos3;
        let s23 = s14 * cos4;
        let s24 = (p0_θ2 - s21 * real(0.5)) * θ2_dot - (energy0 + s22 + s23)
            + (p0_θ1 - s18 * real(0.5) - s19) * θ1_dot;
        let s25 = s9 * s5;
        let s26 = s25 + s22;
        let s27 = s25 + s23;
        let s28 = h * h * real(0.25);
        let s29 = s7 * s5;
        let s30 = s7 * real(0.5);
        let s31 = s30 * (θ1_dot + θ2_dot) * s6;
        let s32 = s25 * (h * real(0.25));
        let s33 = θ2_dot * θ2_dot;
        let s34 = s12 * real(0.5) + s30 * s33 * s6;
        let s35 = s7 * real(0.25);
        let s36 = (s35 * θ1_dot * s33 * s5 - θ1_dot * s26 * real(0.25)) * h;
        let s37 = θ1_dot * θ1_dot;
        let s38 = s30 * s37;
        let s39 = s15 * real(0.5) - s38 * s6;
        let s40 = (s35 * s37 * θ2_dot * s5 - θ2_dot * s27 * real(0.25)) * h;
        ::vi_core::ExtendedSystem {
            momentum: ::vi_core::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    s18 + s19 - p0_θ1 - (p0_θ1_low - s1 * s13),
                    s21 + s8 * s5 - p0_θ2 - (p0_θ2_low + s1 * s16),
                ]),
                jacobian: ::vi_core::SMatrix::from_row_slice(
                    &[
                        s2 * s17 + s28 * s26,
                        s29 + (s31 - s32) * h,
                        s29 - (s31 + s32) * h,
                        s20 + s28 * s27,
                    ],
                ),
            },
            residual_dh: ::vi_core::SVector::from([s34 - s36, s39 - s40]),
            energy_residual: s24
                + (θ1_dot * p0_θ1_low + θ2_dot * p0_θ2_low - energy0_low
                    + s1 * (θ2_dot * s16 - θ1_dot * s13)),
            energy_dv: ::vi_core::SVector::from([s34 + s36, s39 + s40]),
            energy_dh: s38 * s33 * s5 - s37 * s26 * real(0.25) - s33 * s27 * real(0.25),
        }
    }

    /// Sums of the absolute values of the terms of `residual` and `energy_residual`.
    ///
    /// 148 operations.
    #[cold]
    fn magnitudes(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::Magnitudes<2, T> {
        let energy0 = node.energy;
        let [θ1_0, θ2_0]: [T; 2] = node.q.into();
        let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
        let [p0_θ1, p0_θ2]: [T; 2] = node.p.into();
        let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
        let real = T::real;
        let s1 = h * real(0.5);
        let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
        let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
        let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = sin2 * cos3 - cos2 * sin3;
        let s6 = self.m1.abs() + self.m2.abs();
        let s7 = self.l1 * self.l1;
        let s8 = self.m2 * self.l1 * self.l2;
        let s9 = s8 * θ2_dot;
        let s10 = s8 * θ1_dot;
        let s11 = s10 * θ2_dot;
        let s12 = s11 * s5;
        let s13 = s12.abs();
        let s14 = self.l1 * self.g;
        let s15 = s14 * (self.m1 + self.m2);
        let s16 = s15 * sin2;
        let s17 = s13 + s16.abs();
        let s18 = s11 * s4;
        let s19 = s18 + s15 * cos2;
        let s20 = s9 * s5;
        let s21 = s18 * s1;
        let s22 = h.abs() * real(0.5);
        let s23 = p0_θ1.abs() + s6 * (s7 * θ1_dot).abs() + (s9 * s4).abs() + s22 * s17
            + (θ1_mid * (s20 - s1 * s19)).abs();
        let s24 = self.m2 * (self.l2 * self.l2);
        let s25 = self.m2 * self.l2 * self.g;
        let s26 = s25 * sin3;
        let s27 = s13 + s26.abs();
        let s28 = s10 * s5;
        let s29 = s25 * cos3;
        let s30 = s18 + s29;
        let s31 = p0_θ2.abs() + (s24 * θ2_dot).abs() + (s10 * s4).abs() + s22 * s27
            + (θ1_mid * (s28 + s21)).abs();
        let s32 = θ2_dot * θ2_dot;
        let s33 = s8 * real(0.5);
        let s34 = (θ1_mid
            * (s12 + s16 + (s33 * θ1_dot * s32 * s4 - θ1_dot * s19 * real(0.5)) * h))
            .abs();
        let s35 = θ1_dot * θ1_dot;
        let s36 = (θ2_mid
            * (s12 - s26 - (s33 * s35 * θ2_dot * s4 - θ2_dot * s30 * real(0.5)) * h))
            .abs();
        let s37 = energy0.abs() + (θ1_dot * p0_θ1).abs() + (θ2_dot * p0_θ2).abs()
            + s7 * s6 * real(0.5) * s35;
        let s38 = s37 + (s24 * s32).abs() * real(0.5) + s18.abs()
            + s6 * (s14 * cos2).abs() + s29.abs();
        let s39 = s38 + s17 * (h * θ1_dot).abs() * real(0.5)
            + s27 * (h * θ2_dot).abs() * real(0.5) + s34;
        ::vi_core::Magnitudes {
            residual: ::vi_core::SVector::from([
                s23 + (θ2_mid * (s20 - s21)).abs(),
                s31 + (θ2_mid * (s28 + s1 * s30)).abs(),
            ]),
            energy_residual: s39 + s36,
        }
    }

    /// `p1 − p0_θ1 = h*L_θ1`
    ///
    /// `p1 − p0_θ2 = h*L_θ2`
    ///
    /// `E1 − E0 = 0`
    ///
    /// 31 operations.
    #[inline(always)]
    fn increment(
        &self,
        node: &::vi_core::Node<2, T>,
        h: T,
        v: &::vi_core::SVector<T, 2>,
    ) -> ::vi_core::Increment<2, T> {
        let [θ1_0, θ2_0]: [T; 2] = node.q.into();
        let [θ1_0_low, θ2_0_low]: [T; 2] = node.q_low.into();
        let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
        let real = T::real;
        let s1 = h * real(0.5);
        let θ1_mid = θ1_0 + (s1 * θ1_dot + θ1_0_low);
        let θ2_mid = θ2_0 + (s1 * θ2_dot + θ2_0_low);
        let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s4 = self.m2 * self.l1 * self.l2 * θ1_dot * θ2_dot
            * (sin2 * cos3 - cos2 * sin3);
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                -(h * (s4 + self.l1 * self.g * (self.m1 + self.m2) * sin2)),
                h * (s4 - self.m2 * self.l2 * self.g * sin3),
            ]),
            energy: real(0.0),
        }
    }

    /// `p1 − p0_θ1 = h*L_θ1`
    ///
    /// `p1 − p0_θ2 = h*L_θ2`
    ///
    /// and to first order at `v + dv`.
    ///
    /// 86 operations.
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
        let [p0_θ1, p0_θ2]: [T; 2] = node.p.into();
        let [p0_θ1_low, p0_θ2_low]: [T; 2] = node.p_low.into();
        let [θ1_dot, θ2_dot]: [T; 2] = (*v).into();
        let [θ1_mid, θ2_mid]: [T; 2] = (*place).into();
        let real = T::real;
        let s1 = self.m1 + self.m2;
        let [(sin2, cos2), (sin3, cos3)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = sin2 * cos3 - cos2 * sin3;
        let s6 = self.m2 * self.l1 * self.l2;
        let s7 = s6 * θ1_dot;
        let s8 = s7 * θ2_dot;
        let s9 = s8 * s5;
        let s10 = self.l1 * self.g * s1;
        let s11 = s9 + s10 * sin2;
        let s12 = self.m2 * self.l2 * self.g;
        let s13 = s9 - s12 * sin3;
        let s14 = self.l1 * self.l1;
        let s15 = s6 * θ2_dot;
        let s16 = h * real(0.5);
        let s17 = self.m2 * (self.l2 * self.l2);
        let s18 = s8 * s4;
        let s19 = s18 + s10 * cos2;
        let s20 = s18 + s12 * cos3;
        let s21 = h * h * real(0.25);
        let s22 = s6 * s4;
        let s23 = s6 * real(0.5) * (θ1_dot + θ2_dot) * s5;
        let s24 = s18 * (h * real(0.25));
        let s25 = s15 * s5;
        let s26 = s7 * s5;
        let s27 = s18 * s16;
        let change: [T; 2] = solve(
                &::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        s14 * s1 * θ1_dot + s15 * s4 - p0_θ1
                            - (p0_θ1_low - s16 * s11),
                        s17 * θ2_dot + s7 * s4 - p0_θ2 - (p0_θ2_low + s16 * s13),
                    ]),
                    jacobian: ::vi_core::SMatrix::from_row_slice(
                        &[
                            s1 * s14 + s21 * s19,
                            s22 + (s23 - s24) * h,
                            s22 - (s23 + s24) * h,
                            s17 + s21 * s20,
                        ],
                    ),
                },
            )
            .into();
        ::vi_core::SVector::from([
            -(h * s11)
                + (((-s25 - s16 * s19) * h) * change[0] + ((s27 - s26) * h) * change[1]),
            h * s13
                + (((s25 + s27) * h) * change[0] + ((s26 - s16 * s20) * h) * change[1]),
        ])
    }

    /// `p1 − p0_θ1 = h*L_θ1`
    ///
    /// `p1 − p0_θ2 = h*L_θ2`
    ///
    /// `E1 − E0 = 0`
    ///
    /// and to first order at `(v + dv, h + dh)`.
    ///
    /// 163 operations.
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
        let [(sin3, cos3), (sin4, cos4)] = T::sin_cos_each([θ1_mid, θ2_mid]);
        let s5 = cos3 * cos4 + sin3 * sin4;
        let s6 = sin3 * cos4 - cos3 * sin4;
        let s7 = self.m2 * self.l1 * self.l2;
        let s8 = s7 * θ1_dot;
        let s9 = s8 * θ2_dot;
        let s10 = s9 * s6;
        let s11 = self.l1 * self.g * s2;
        let s12 = s11 * sin3;
        let s13 = s10 + s12;
        let s14 = self.m2 * self.l2 * self.g;
        let s15 = s14 * sin4;
        let s16 = s10 - s15;
        let s17 = self.l1 * self.l1;
        let s18 = s17 * s2 * θ1_dot;
        let s19 = s7 * θ2_dot;
        let s20 = s19 * s5;
        let s21 = self.m2 * (self.l2 * self.l2);
        let s22 = s21 * θ2_dot;
        let s23 = s11 * cos3;
        let s24 = s14 * cos4;
        let s25 = (p0_θ2 - s22 * real(0.5)) * θ2_dot - (energy0 + s23 + s24)
            + (p0_θ1 - s18 * real(0.5) - s20) * θ1_dot;
        let s26 = s9 * s5;
        let s27 = s26 + s23;
        let s28 = s26 + s24;
        let s29 = h * h * real(0.25);
        let s30 = s7 * s5;
        let s31 = s7 * real(0.5);
        let s32 = s31 * (θ1_dot + θ2_dot) * s6;
        let s33 = s26 * (h * real(0.25));
        let s34 = θ2_dot * θ2_dot;
        let s35 = s12 * real(0.5) + s31 * s34 * s6;
        let s36 = θ1_dot * s27;
        let s37 = s7 * real(0.25);
        let s38 = (s37 * θ1_dot * s34 * s5 - s36 * real(0.25)) * h;
        let s39 = θ1_dot * θ1_dot;
        let s40 = s31 * s39;
        let s41 = s15 * real(0.5) - s40 * s6;
        let s42 = θ2_dot * s28;
        let s43 = (s37 * s39 * θ2_dot * s5 - s42 * real(0.25)) * h;
        let s44 = s19 * s6;
        let s45 = s8 * s6;
        let s46 = s26 * s1;
        let (change, change_h) = solve(
            &::vi_core::ExtendedSystem {
                momentum: ::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        s18 + s20 - p0_θ1 - (p0_θ1_low - s1 * s13),
                        s22 + s8 * s5 - p0_θ2 - (p0_θ2_low + s1 * s16),
                    ]),
                    jacobian: ::vi_core::SMatrix::from_row_slice(
                        &[
                            s2 * s17 + s29 * s27,
                            s30 + (s32 - s33) * h,
                            s30 - (s32 + s33) * h,
                            s21 + s29 * s28,
                        ],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s35 - s38, s41 - s43]),
                energy_residual: s25
                    + (θ1_dot * p0_θ1_low + θ2_dot * p0_θ2_low - energy0_low
                        + s1 * (θ2_dot * s16 - θ1_dot * s13)),
                energy_dv: ::vi_core::SVector::from([s35 + s38, s41 + s43]),
                energy_dh: s40 * s34 * s5 - s39 * s27 * real(0.25)
                    - s34 * s28 * real(0.25),
            },
        );
        let change: [T; 2] = change.into();
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                -(h * s13)
                    + (((-s44 - s1 * s27) * h) * change[0]
                        + ((s46 - s45) * h) * change[1]
                        + ((s31 * θ1_dot * s34 * s5 - s36 * real(0.5)) * h - s13)
                            * change_h),
                h * s16
                    + (((s44 + s46) * h) * change[0] + ((s45 - s1 * s28) * h) * change[1]
                        + (s16 + (s40 * θ2_dot * s5 - s42 * real(0.5)) * h) * change_h),
            ]),
            energy: real(0.0),
        }
    }
}

#[allow(clippy::all, clippy::pedantic, unused_variables)]
impl ::vi_core::Batch<2> for DoublePendulum<f64> {
    type Rows<const W: usize> = DoublePendulum<[f64; W]>;
    type In<T: ::vi_core::Real> = DoublePendulum<T>;
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
    fn pick<T: ::vi_core::Real, const W: usize>(
        rows: &Self::Rows<W>,
        index: usize,
    ) -> Self::In<T> {
        DoublePendulum {
            m1: T::real(rows.m1[index]),
            m2: T::real(rows.m2[index]),
            l1: T::real(rows.l1[index]),
            l2: T::real(rows.l2[index]),
            g: T::real(rows.g[index]),
        }
    }
}

impl ::vi_core::check::Checked<2> for DoublePendulum<f64> {
    type In<T: ::vi_core::Real> = DoublePendulum<T>;
    fn convert<T: ::vi_core::Real>(&self) -> DoublePendulum<T> {
        DoublePendulum::from_f64(self)
    }
}

/// Checks of [`DoublePendulum`](super::DoublePendulum) at the place that it names.
#[cfg(test)]
#[allow(clippy::all, clippy::pedantic)]
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
