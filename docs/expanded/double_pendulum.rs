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
    /// 26 operations.
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
        let (sin1, cos1) = θ1.sin_cos();
        let (sin2, cos2) = θ2.sin_cos();
        let s3 = self.g * cos2
            + (self.l2 * real(0.5) * θ2_dot
                + self.l1 * θ1_dot * (cos1 * cos2 + sin1 * sin2)) * θ2_dot;
        (self.l1 * real(0.5) * (θ1_dot * θ1_dot) + self.g * cos1) * (self.m1 + self.m2)
            * self.l1 + s3 * self.l2 * self.m2
    }

    /// `v·L_v − L = m2*l2^2*dot(θ2)^2/2 + m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) - l1*g*(m1 + m2)*cos(θ1) - m2*l2*g*cos(θ2) + m1*l1^2*dot(θ1)^2/2 + m2*l1^2*dot(θ1)^2/2`
    ///
    /// 31 operations.
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
        let (sin1, cos1) = θ1.sin_cos();
        let (sin2, cos2) = θ2.sin_cos();
        let s3 = θ1_dot * θ1_dot;
        let s4 = (self.l2 * real(0.5) * θ2_dot
            + self.l1 * θ1_dot * (cos1 * cos2 + sin1 * sin2)) * θ2_dot - self.g * cos2;
        (self.m1 * self.l1 * real(0.5) * s3 - self.g * (self.m1 + self.m2) * cos1)
            * self.l1 + (self.l1 * self.l1 * real(0.5) * s3 + s4 * self.l2) * self.m2
    }

    /// `p_θ1 = l1^2*(m1 + m2)*dot(θ1) + m2*l1*l2*dot(θ2)*cos(θ1 - θ2)`
    ///
    /// `p_θ2 = m2*l2^2*dot(θ2) + m2*l1*l2*dot(θ1)*cos(θ1 - θ2)`
    ///
    /// 16 operations.
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
        ::vi_core::SVector::from([
            (self.l1 * (self.m1 + self.m2) * θ1_dot + self.m2 * self.l2 * θ2_dot * s1)
                * self.l1,
            (self.l2 * θ2_dot + self.l1 * θ1_dot * s1) * self.l2 * self.m2,
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
    /// 34 operations.
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
        let (sin2, cos2) = θ1.sin_cos();
        let (sin3, cos3) = θ2.sin_cos();
        let s4 = self.m2 * self.l1 * self.l2 * (cos2 * cos3 + sin2 * sin3);
        let s5 = sin2 * cos3 - cos2 * sin3;
        let mass: ::vi_core::SMatrix<T, 2, 2> = ::vi_core::SMatrix::from_row_slice(
            &[self.l1 * self.l1 * s1, s4, s4, self.m2 * (self.l2 * self.l2)],
        );
        let applied: ::vi_core::SVector<T, 2> = ::vi_core::SVector::from([
            -((self.g * s1 * sin2 + self.m2 * self.l2 * (θ2_dot * θ2_dot) * s5)
                * self.l1),
            (self.l1 * (θ1_dot * θ1_dot) * s5 - self.g * sin3) * self.l2 * self.m2,
        ]);
        ::vi_core::linear::acceleration(time, &mass, &applied)
    }

    /// `D = (-m2*l1*l2*dot(θ1)*dot(θ2)*sin(θ1 - θ2) - l1*g*(m1 + m2)*sin(θ1))*dot(dot(θ1)) - dot(θ1)*(dot(θ1)*(-m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) - l1*g*(m1 + m2)*cos(θ1)) - m2*l1*l2*dot(θ2)*sin(θ1 - θ2)*dot(dot(θ1)) + m2*l1*l2*dot(θ1)*dot(θ2)^2*cos(θ1 - θ2) - m2*l1*l2*dot(θ1)*sin(θ1 - θ2)*dot(dot(θ2))) + dot(dot(θ2))*(m2*l1*l2*dot(θ1)*dot(θ2)*sin(θ1 - θ2) - m2*l2*g*sin(θ2)) - …`
    ///
    /// 65 operations.
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
        let (sin1, cos1) = θ1.sin_cos();
        let (sin2, cos2) = θ2.sin_cos();
        let s3 = cos1 * cos2 + sin1 * sin2;
        let s4 = sin1 * cos2 - cos1 * sin2;
        let s5 = self.g * (self.m1 + self.m2);
        let s6 = self.m2 * self.l2 * θ1_dot * θ2_dot;
        let s7 = self.l1 * θ1_dot * θ2_dot;
        let s8 = s4 * θ2_ddot;
        let s9 = θ2_dot * s4 * θ1_ddot;
        let s10 = ((θ2_dot * θ2_dot * s3 - s8) * θ1_dot - s9) * self.l2 * self.l1
            * self.m2 - θ1_dot * ((s5 * cos1 + s6 * s3) * self.l1);
        let s11 = (s9 + (s8 + θ1_dot * θ2_dot * s3) * θ1_dot) * self.l2 * self.l1
            * self.m2 - θ2_dot * ((s7 * s3 + self.g * cos2) * self.l2 * self.m2);
        let s12 = θ2_ddot * ((s7 * s4 - self.g * sin2) * self.l2 * self.m2)
            - (s5 * sin1 + s6 * s4) * self.l1 * θ1_ddot;
        Ok(s12 - θ1_dot * s10 - θ2_dot * s11)
    }

    /// The first of what L and f are made of that is not finite here.
    ///
    /// 26 operations.
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
        let (sin1, cos1) = θ1.sin_cos();
        let (sin2, cos2) = θ2.sin_cos();
        let s3 = cos1 * cos2 + sin1 * sin2;
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
            ("cos(θ1 - θ2)", s3),
            ("cos(θ1)", cos1),
            ("cos(θ2)", cos2),
            (
                "l1^2*(m1 + m2)*dot(θ1)^2/2 + m2*l2^2*dot(θ2)^2/2 + m2*l1*l2*dot(θ1)*dot(θ2)*cos(θ1 - θ2) + l1*g*(m1 + m2)*cos(θ1) + m2*l2*g*cos(θ2)",
                (self.l1 * real(0.5) * (θ1_dot * θ1_dot) + self.g * cos1)
                    * (self.m1 + self.m2) * self.l1
                    + (self.g * cos2
                        + (self.l2 * real(0.5) * θ2_dot + self.l1 * θ1_dot * s3)
                            * θ2_dot) * self.l2 * self.m2,
            ),
        ];
        values.into_iter().find(|(_, value)| !value.is_finite()).map(|(text, _)| text)
    }
}

#[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
impl<T: ::vi_core::Real> ::vi_core::DiscreteLagrangian<2, T> for DoublePendulum<T> {
    /// `ld = h*L`
    ///
    /// 31 operations.
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
        let (sin1, cos1) = θ1_mid.sin_cos();
        let (sin2, cos2) = θ2_mid.sin_cos();
        let s3 = self.g * cos2
            + (self.l2 * real(0.5) * θ2_dot
                + self.l1 * θ1_dot * (cos1 * cos2 + sin1 * sin2)) * θ2_dot;
        let s4 = (self.l1 * real(0.5) * (θ1_dot * θ1_dot) + self.g * cos1)
            * (self.m1 + self.m2) * self.l1 + s3 * self.l2 * self.m2;
        h * s4
    }

    /// `d1_ld = L_v_θ1*v_θ1 - L + L_v_θ2*v_θ2`
    ///
    /// 46 operations.
    #[inline]
    fn d1_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
        let h = interval.t1 - interval.t0;
        let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
        let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
        let θ1_dot = (θ1_1 - θ1_0) / h;
        let θ2_dot = (θ2_1 - θ2_0) / h;
        let real = T::real;
        let s1 = self.m1 + self.m2;
        let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
        let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
        let (sin2, cos2) = θ1_mid.sin_cos();
        let (sin3, cos3) = θ2_mid.sin_cos();
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = self.l1 * θ1_dot * s4;
        let s6 = θ1_dot
            * ((self.l1 * s1 * θ1_dot + self.m2 * self.l2 * θ2_dot * s4) * self.l1)
            + θ2_dot * ((self.l2 * θ2_dot + s5) * self.l2 * self.m2);
        s6 - (self.l1 * real(0.5) * (θ1_dot * θ1_dot) + self.g * cos2) * s1 * self.l1
            + (-((self.l2 * real(0.5) * θ2_dot + s5) * θ2_dot) - self.g * cos3)
                * self.l2 * self.m2
    }

    /// `d2_ld_θ1 = h*L_θ1/2 - L_v_θ1`
    ///
    /// `d2_ld_θ2 = h*L_θ2/2 - L_v_θ2`
    ///
    /// 47 operations.
    #[inline]
    fn d2_ld(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
        let h = interval.t1 - interval.t0;
        let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
        let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
        let θ1_dot = (θ1_1 - θ1_0) / h;
        let θ2_dot = (θ2_1 - θ2_0) / h;
        let real = T::real;
        let s1 = self.m1 + self.m2;
        let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
        let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
        let (sin2, cos2) = θ1_mid.sin_cos();
        let (sin3, cos3) = θ2_mid.sin_cos();
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = sin2 * cos3 - cos2 * sin3;
        let s6 = self.m2 * self.l2;
        let s7 = h * real(0.5);
        let s8 = self.l1 * θ1_dot;
        ::vi_core::SVector::from([
            -((self.l1 * s1 * θ1_dot + s6 * θ2_dot * s4) * self.l1)
                - s7 * ((s6 * θ1_dot * θ2_dot * s5 + self.g * s1 * sin2) * self.l1),
            s7 * ((s8 * θ2_dot * s5 - self.g * sin3) * self.l2 * self.m2)
                - (self.l2 * θ2_dot + s8 * s4) * self.l2 * self.m2,
        ])
    }

    /// `d3_ld = L - L_v_θ1*v_θ1 - L_v_θ2*v_θ2`
    ///
    /// 45 operations.
    #[inline]
    fn d3_ld(&self, interval: &::vi_core::Interval<2, T>) -> T {
        let h = interval.t1 - interval.t0;
        let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
        let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
        let θ1_dot = (θ1_1 - θ1_0) / h;
        let θ2_dot = (θ2_1 - θ2_0) / h;
        let real = T::real;
        let s1 = self.m1 + self.m2;
        let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
        let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
        let (sin2, cos2) = θ1_mid.sin_cos();
        let (sin3, cos3) = θ2_mid.sin_cos();
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = self.l1 * θ1_dot * s4;
        let s6 = θ1_dot
            * ((self.l1 * s1 * θ1_dot + self.m2 * self.l2 * θ2_dot * s4) * self.l1)
            + θ2_dot * ((self.l2 * θ2_dot + s5) * self.l2 * self.m2);
        (self.l1 * real(0.5) * (θ1_dot * θ1_dot) + self.g * cos2) * s1 * self.l1 - s6
            + (self.g * cos3 + (self.l2 * real(0.5) * θ2_dot + s5) * θ2_dot) * self.l2
                * self.m2
    }

    /// `d4_ld_θ1 = L_v_θ1 + h*L_θ1/2`
    ///
    /// `d4_ld_θ2 = L_v_θ2 + h*L_θ2/2`
    ///
    /// 46 operations.
    #[inline]
    fn d4_ld(&self, interval: &::vi_core::Interval<2, T>) -> ::vi_core::SVector<T, 2> {
        let h = interval.t1 - interval.t0;
        let [θ1_0, θ2_0]: [T; 2] = interval.q0.into();
        let [θ1_1, θ2_1]: [T; 2] = interval.q1.into();
        let θ1_dot = (θ1_1 - θ1_0) / h;
        let θ2_dot = (θ2_1 - θ2_0) / h;
        let real = T::real;
        let s1 = self.m1 + self.m2;
        let θ1_mid = (θ1_0 + θ1_1) * real(0.5);
        let θ2_mid = (θ2_0 + θ2_1) * real(0.5);
        let (sin2, cos2) = θ1_mid.sin_cos();
        let (sin3, cos3) = θ2_mid.sin_cos();
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = sin2 * cos3 - cos2 * sin3;
        let s6 = self.m2 * self.l2;
        let s7 = self.l1 * θ1_dot;
        let s8 = h * real(0.5);
        ::vi_core::SVector::from([
            (self.l1 * s1 * θ1_dot + s6 * θ2_dot * s4) * self.l1
                - s8 * ((s6 * θ1_dot * θ2_dot * s5 + self.g * s1 * sin2) * self.l1),
            (self.l2 * θ2_dot + s7 * s4) * self.l2 * self.m2
                + s8 * ((s7 * θ2_dot * s5 - self.g * sin3) * self.l2 * self.m2),
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
    /// 91 operations.
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
        let s1 = self.m1 + self.m2;
        let s2 = h * real(0.5);
        let θ1_mid = θ1_0 + (s2 * θ1_dot + θ1_0_low);
        let θ2_mid = θ2_0 + (s2 * θ2_dot + θ2_0_low);
        let (sin3, cos3) = θ1_mid.sin_cos();
        let (sin4, cos4) = θ2_mid.sin_cos();
        let s5 = cos3 * cos4 + sin3 * sin4;
        let s6 = self.m2 * self.l1 * self.l2;
        let s7 = self.m2 * self.l2;
        let s8 = sin3 * cos4 - cos3 * sin4;
        let s9 = s7 * θ1_dot * θ2_dot;
        let s10 = self.g * s1;
        let s11 = self.l1 * θ1_dot;
        let s12 = s11 * θ2_dot;
        let s13 = h * h * real(0.25);
        let s14 = s6 * s5;
        let s15 = (θ1_dot + θ2_dot) * real(0.5) * s8 * self.l2 * self.l1 * self.m2;
        let s16 = s6 * h * real(0.25) * θ1_dot * θ2_dot * s5;
        ::vi_core::MomentumEquation {
            residual: ::vi_core::SVector::from([
                (self.l1 * s1 * θ1_dot + s7 * θ2_dot * s5) * self.l1 - p0_θ1
                    - (p0_θ1_low - s2 * ((s9 * s8 + s10 * sin3) * self.l1)),
                (self.l2 * θ2_dot + s11 * s5) * self.l2 * self.m2 - p0_θ2
                    - (p0_θ2_low
                        + s2 * ((s12 * s8 - self.g * sin4) * self.l2 * self.m2)),
            ]),
            jacobian: ::vi_core::SMatrix::from_row_slice(
                &[
                    s1 * (self.l1 * self.l1) + s13 * ((s10 * cos3 + s9 * s5) * self.l1),
                    s14 + (s15 - s16) * h,
                    s14 - (s15 + s16) * h,
                    self.m2 * (self.l2 * self.l2)
                        + s13 * ((s12 * s5 + self.g * cos4) * self.l2 * self.m2),
                ],
            ),
        }
    }

    /// `energy_residual = h*v_θ1*L_θ1/2 - L - E0_low - E0 + v_θ1*p0_θ1_low + v_θ1*p0_θ1 + h*v_θ2*L_θ2/2 + v_θ2*p0_θ2_low + v_θ2*p0_θ2`
    ///
    /// 163 operations.
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
        let s1 = self.m1 + self.m2;
        let s2 = h * real(0.5);
        let θ1_mid = θ1_0 + (s2 * θ1_dot + θ1_0_low);
        let θ2_mid = θ2_0 + (s2 * θ2_dot + θ2_0_low);
        let s3 = θ1_dot * θ1_dot;
        let s4 = θ2_dot * θ2_dot;
        let (sin5, cos5) = θ1_mid.sin_cos();
        let (sin6, cos6) = θ2_mid.sin_cos();
        let s7 = cos5 * cos6 + sin5 * sin6;
        let s8 = self.m2 * self.l1 * self.l2;
        let s9 = self.m2 * self.l2;
        let s10 = sin5 * cos6 - cos5 * sin6;
        let s11 = s9 * θ1_dot * θ2_dot;
        let s12 = self.g * s1;
        let s13 = s12 * sin5;
        let s14 = (s11 * s10 + s13) * self.l1;
        let s15 = self.l1 * θ1_dot;
        let s16 = s15 * θ2_dot;
        let s17 = self.g * sin6;
        let s18 = (s16 * s10 - s17) * self.l2 * self.m2;
        let s19 = s15 * s7;
        let s20 = self.g * cos6;
        let s21 = θ1_dot * p0_θ1 + θ2_dot * p0_θ2 - energy0
            - (self.l1 * real(0.5) * s3 + self.g * cos5) * s1 * self.l1;
        let s22 = (s12 * cos5 + s11 * s7) * self.l1;
        let s23 = (s16 * s7 + s20) * self.l2 * self.m2;
        let s24 = h * h * real(0.25);
        let s25 = s8 * s7;
        let s26 = (θ1_dot + θ2_dot) * real(0.5) * s10 * self.l2 * self.l1 * self.m2;
        let s27 = s8 * h * real(0.25) * θ1_dot * θ2_dot * s7;
        let s28 = (s13 + s9 * s4 * s10) * real(0.5) * self.l1;
        let s29 = (s8 * θ1_dot * s4 * s7 - θ1_dot * s22) * real(0.25) * h;
        let s30 = (s17 - self.l1 * s3 * s10) * real(0.5) * self.l2 * self.m2;
        let s31 = (s8 * s3 * θ2_dot * s7 - θ2_dot * s23) * real(0.25) * h;
        ::vi_core::ExtendedSystem {
            momentum: ::vi_core::MomentumEquation {
                residual: ::vi_core::SVector::from([
                    (self.l1 * s1 * θ1_dot + s9 * θ2_dot * s7) * self.l1 - p0_θ1
                        - (p0_θ1_low - s2 * s14),
                    (self.l2 * θ2_dot + s19) * self.l2 * self.m2 - p0_θ2
                        - (p0_θ2_low + s2 * s18),
                ]),
                jacobian: ::vi_core::SMatrix::from_row_slice(
                    &[
                        s1 * (self.l1 * self.l1) + s24 * s22,
                        s25 + (s26 - s27) * h,
                        s25 - (s26 + s27) * h,
                        self.m2 * (self.l2 * self.l2) + s24 * s23,
                    ],
                ),
            },
            residual_dh: ::vi_core::SVector::from([s28 - s29, s30 - s31]),
            energy_residual: s21
                + (-((self.l2 * real(0.5) * θ2_dot + s19) * θ2_dot) - s20) * self.l2
                    * self.m2
                + (θ1_dot * p0_θ1_low + θ2_dot * p0_θ2_low - energy0_low
                    + (θ2_dot * s18 - θ1_dot * s14) * real(0.5) * h),
            energy_dv: ::vi_core::SVector::from([s28 + s29, s30 + s31]),
            energy_dh: s8 * real(0.5) * s3 * s4 * s7 - s3 * s22 * real(0.25)
                - s4 * s23 * real(0.25),
        }
    }

    /// Sums of the absolute values of the terms of `residual` and `energy_residual`.
    ///
    /// 167 operations.
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
        let s1 = self.m1 + self.m2;
        let s2 = h * real(0.5);
        let θ1_mid = θ1_0 + (s2 * θ1_dot + θ1_0_low);
        let θ2_mid = θ2_0 + (s2 * θ2_dot + θ2_0_low);
        let s3 = self.m2 * (self.l2 * self.l2);
        let s4 = θ2_dot * θ2_dot;
        let (sin5, cos5) = θ1_mid.sin_cos();
        let (sin6, cos6) = θ2_mid.sin_cos();
        let s7 = cos5 * cos6 + sin5 * sin6;
        let s8 = self.m2 * self.l1 * self.l2;
        let s9 = s8 * θ1_dot;
        let s10 = s9 * θ2_dot;
        let s11 = self.l1 * self.g;
        let s12 = self.m2 * self.l2;
        let s13 = s12 * self.g;
        let s14 = s8 * θ2_dot;
        let s15 = sin5 * cos6 - cos5 * sin6;
        let s16 = self.m1.abs() + self.m2.abs();
        let s17 = self.l1 * self.l1;
        let s18 = (s10 * s15).abs();
        let s19 = s18 + (s11 * s1 * sin5).abs();
        let s20 = s14 * s15;
        let s21 = self.g * s1;
        let s22 = s12 * θ1_dot * θ2_dot;
        let s23 = (s21 * cos5 + s22 * s7) * self.l1;
        let s24 = s8 * h * real(0.5) * θ1_dot * θ2_dot * s7;
        let s25 = h.abs() * real(0.5);
        let s26 = p0_θ1.abs() + s16 * (s17 * θ1_dot).abs() + (s14 * s7).abs()
            + s25 * s19 + (θ1_mid * (s20 - s2 * s23)).abs();
        let s27 = s18 + (s13 * sin6).abs();
        let s28 = s9 * s15;
        let s29 = self.l1 * θ1_dot * θ2_dot;
        let s30 = (s29 * s7 + self.g * cos6) * self.l2 * self.m2;
        let s31 = p0_θ2.abs() + (s3 * θ2_dot).abs() + (s9 * s7).abs() + s25 * s27
            + (θ1_mid * (s28 + s24)).abs();
        let s32 = θ1_dot * θ1_dot;
        let s33 = (s22 * s15 + s21 * sin5) * self.l1
            + (s9 * s4 * s7 - θ1_dot * s23) * real(0.5) * h;
        let s34 = (s29 * s15 - self.g * sin6) * self.l2 * self.m2
            - (s8 * s32 * θ2_dot * s7 - θ2_dot * s30) * real(0.5) * h;
        let s35 = energy0.abs() + (θ1_dot * p0_θ1).abs() + (θ2_dot * p0_θ2).abs()
            + (s3 * s4).abs() * real(0.5);
        let s36 = s35 + (s10 * s7).abs() + (s13 * cos6).abs()
            + s19 * (h * θ1_dot).abs() * real(0.5);
        let s37 = s36 + s27 * (h * θ2_dot).abs() * real(0.5) + (θ1_mid * s33).abs()
            + (θ2_mid * s34).abs();
        ::vi_core::Magnitudes {
            residual: ::vi_core::SVector::from([
                s26 + (θ2_mid * (s20 - s24)).abs(),
                s31 + (θ2_mid * (s28 + s2 * s30)).abs(),
            ]),
            energy_residual: s37 + (s17 * real(0.5) * s32 + (s11 * cos5).abs()) * s16,
        }
    }

    /// `p1 − p0_θ1 = h*L_θ1`
    ///
    /// `p1 − p0_θ2 = h*L_θ2`
    ///
    /// `E1 − E0 = 0`
    ///
    /// 33 operations.
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
        let (sin2, cos2) = θ1_mid.sin_cos();
        let (sin3, cos3) = θ2_mid.sin_cos();
        let s4 = sin2 * cos3 - cos2 * sin3;
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                -(h
                    * ((self.m2 * self.l2 * θ1_dot * θ2_dot * s4
                        + self.g * (self.m1 + self.m2) * sin2) * self.l1)),
                h
                    * ((self.l1 * θ1_dot * θ2_dot * s4 - self.g * sin3) * self.l2
                        * self.m2),
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
    /// 107 operations.
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
        let (sin2, cos2) = θ1_mid.sin_cos();
        let (sin3, cos3) = θ2_mid.sin_cos();
        let s4 = cos2 * cos3 + sin2 * sin3;
        let s5 = self.m2 * self.l1 * self.l2;
        let s6 = self.m2 * self.l2;
        let s7 = sin2 * cos3 - cos2 * sin3;
        let s8 = s6 * θ1_dot * θ2_dot;
        let s9 = self.g * s1;
        let s10 = (s8 * s7 + s9 * sin2) * self.l1;
        let s11 = self.l1 * θ1_dot;
        let s12 = s11 * θ2_dot;
        let s13 = (s12 * s7 - self.g * sin3) * self.l2 * self.m2;
        let s14 = h * real(0.5);
        let s15 = (s9 * cos2 + s8 * s4) * self.l1;
        let s16 = (s12 * s4 + self.g * cos3) * self.l2 * self.m2;
        let s17 = h * h * real(0.25);
        let s18 = s5 * h;
        let s19 = s5 * s4;
        let s20 = (θ1_dot + θ2_dot) * real(0.5) * s7 * self.l2 * self.l1 * self.m2;
        let s21 = s18 * real(0.25) * θ1_dot * θ2_dot * s4;
        let s22 = s5 * θ2_dot * s7;
        let s23 = s5 * θ1_dot * s7;
        let s24 = s18 * real(0.5) * θ1_dot * θ2_dot * s4;
        let change: [T; 2] = solve(
                &::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        (self.l1 * s1 * θ1_dot + s6 * θ2_dot * s4) * self.l1 - p0_θ1
                            - (p0_θ1_low - s14 * s10),
                        (self.l2 * θ2_dot + s11 * s4) * self.l2 * self.m2 - p0_θ2
                            - (p0_θ2_low + s14 * s13),
                    ]),
                    jacobian: ::vi_core::SMatrix::from_row_slice(
                        &[
                            s1 * (self.l1 * self.l1) + s17 * s15,
                            s19 + (s20 - s21) * h,
                            s19 - (s20 + s21) * h,
                            self.m2 * (self.l2 * self.l2) + s17 * s16,
                        ],
                    ),
                },
            )
            .into();
        ::vi_core::SVector::from([
            -(h * s10)
                + (((-s22 - s14 * s15) * h) * change[0] + ((s24 - s23) * h) * change[1]),
            h * s13
                + (((s22 + s24) * h) * change[0] + ((s23 - s14 * s16) * h) * change[1]),
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
    /// 190 operations.
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
        let s1 = self.m1 + self.m2;
        let s2 = h * real(0.5);
        let θ1_mid = θ1_0 + (s2 * θ1_dot + θ1_0_low);
        let θ2_mid = θ2_0 + (s2 * θ2_dot + θ2_0_low);
        let s3 = θ1_dot * θ1_dot;
        let s4 = θ2_dot * θ2_dot;
        let (sin5, cos5) = θ1_mid.sin_cos();
        let (sin6, cos6) = θ2_mid.sin_cos();
        let s7 = cos5 * cos6 + sin5 * sin6;
        let s8 = self.m2 * self.l1 * self.l2;
        let s9 = s8 * θ1_dot;
        let s10 = self.m2 * self.l2;
        let s11 = sin5 * cos6 - cos5 * sin6;
        let s12 = s10 * θ1_dot * θ2_dot;
        let s13 = self.g * s1;
        let s14 = s13 * sin5;
        let s15 = (s12 * s11 + s14) * self.l1;
        let s16 = self.l1 * θ1_dot;
        let s17 = s16 * θ2_dot;
        let s18 = self.g * sin6;
        let s19 = (s17 * s11 - s18) * self.l2 * self.m2;
        let s20 = s16 * s7;
        let s21 = self.g * cos6;
        let s22 = θ1_dot * p0_θ1 + θ2_dot * p0_θ2 - energy0
            - (self.l1 * real(0.5) * s3 + self.g * cos5) * s1 * self.l1;
        let s23 = (s13 * cos5 + s12 * s7) * self.l1;
        let s24 = (s17 * s7 + s21) * self.l2 * self.m2;
        let s25 = s8 * h;
        let s26 = h * h * real(0.25);
        let s27 = s8 * s7;
        let s28 = (θ1_dot + θ2_dot) * real(0.5) * s11 * self.l2 * self.l1 * self.m2;
        let s29 = s25 * real(0.25) * θ1_dot * θ2_dot * s7;
        let s30 = (s14 + s10 * s4 * s11) * real(0.5) * self.l1;
        let s31 = s9 * s4 * s7 - θ1_dot * s23;
        let s32 = s31 * real(0.25) * h;
        let s33 = (s18 - self.l1 * s3 * s11) * real(0.5) * self.l2 * self.m2;
        let s34 = s8 * s3 * θ2_dot * s7 - θ2_dot * s24;
        let s35 = s34 * real(0.25) * h;
        let s36 = s8 * θ2_dot * s11;
        let s37 = s9 * s11;
        let s38 = s25 * real(0.5) * θ1_dot * θ2_dot * s7;
        let (change, change_h) = solve(
            &::vi_core::ExtendedSystem {
                momentum: ::vi_core::MomentumEquation {
                    residual: ::vi_core::SVector::from([
                        (self.l1 * s1 * θ1_dot + s10 * θ2_dot * s7) * self.l1 - p0_θ1
                            - (p0_θ1_low - s2 * s15),
                        (self.l2 * θ2_dot + s20) * self.l2 * self.m2 - p0_θ2
                            - (p0_θ2_low + s2 * s19),
                    ]),
                    jacobian: ::vi_core::SMatrix::from_row_slice(
                        &[
                            s1 * (self.l1 * self.l1) + s26 * s23,
                            s27 + (s28 - s29) * h,
                            s27 - (s28 + s29) * h,
                            self.m2 * (self.l2 * self.l2) + s26 * s24,
                        ],
                    ),
                },
                residual_dh: ::vi_core::SVector::from([s30 - s32, s33 - s35]),
                energy_residual: s22
                    + (-((self.l2 * real(0.5) * θ2_dot + s20) * θ2_dot) - s21)
                        * self.l2 * self.m2
                    + (θ1_dot * p0_θ1_low + θ2_dot * p0_θ2_low - energy0_low
                        + (θ2_dot * s19 - θ1_dot * s15) * real(0.5) * h),
                energy_dv: ::vi_core::SVector::from([s30 + s32, s33 + s35]),
                energy_dh: s8 * real(0.5) * s3 * s4 * s7 - s3 * s23 * real(0.25)
                    - s4 * s24 * real(0.25),
            },
        );
        let change: [T; 2] = change.into();
        ::vi_core::Increment {
            momentum: ::vi_core::SVector::from([
                -(h * s15)
                    + (((-s36 - s2 * s23) * h) * change[0]
                        + ((s38 - s37) * h) * change[1]
                        + (s31 * real(0.5) * h - s15) * change_h),
                h * s19
                    + (((s36 + s38) * h) * change[0] + ((s37 - s2 * s24) * h) * change[1]
                        + (s19 + s34 * real(0.5) * h) * change_h),
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
