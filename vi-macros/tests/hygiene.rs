//! Systems in hostile surroundings: constants, types, traits and macros with the names used by emitted code,
//! attributes, functions, macros. Everything compiles without a warning and computes the same as alone.

#![deny(
    warnings,
    missing_docs,
    unused,
    unreachable_pub,
    non_snake_case,
    rust_2018_idioms,
    clippy::all,
    clippy::pedantic
)]
#![allow(non_upper_case_globals, non_camel_case_types, dead_code, reason = "the surroundings")]
#![allow(missing_docs, reason = "a test")]

use vi_core::lagrangian::Parameters;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, SVector, Starts, StepError};

/// A type that no binding may refer to.
macro_rules! constants {
    ($($name:ident)*) => { $(const $name: u8 = 0;)* };
}

/// Positions after some steps of both integrators.
fn run<const N: usize, S: EnergyStepping<N> + Copy>(system: S) -> [SVector<f64, N>; 2] {
    let place = |i: usize| 0.3 + 0.2 * f64::from(u8::try_from(i).expect("few coordinates"));
    let (q, v) = (SVector::from_fn(|i, _| place(i)), SVector::from_fn(|i, _| 0.5 - place(i)));
    let fixed = || -> Result<_, StepError> {
        Ok(system.at(0.0, q, v).integrate(FixedStep, 0.01)?.take(20).last().expect("a step")?.q)
    };
    let energy = || -> Result<_, StepError> {
        Ok(EnergyPreserving::from_midpoint(system, 0.0, q, v, 0.01)?.take(20).last().expect("a step")?.q)
    };
    [fixed().expect("fixed steps"), energy().expect("energy-preserving steps")]
}

/// A system alone, and the same among conflicting names.
macro_rules! alone_and_among {
    ([$($surroundings:tt)*] $($system:tt)*) => {
        mod alone {
            ::vi_core::lagrangian! { $($system)* }
        }
        mod among {
            $($surroundings)*
            ::vi_core::lagrangian! { $($system)* }
        }
    };
}

mod constants {
    alone_and_among! {
        [
            constants! {
                x y t q v x_dot y_dot x_ddot y_ddot real mass applied time x0 y0 x1 y1 x0_low y0_low p0_x p0_y p0_x_low p0_y_low t0
                t0_low x_mid y_mid t_mid energy0 energy0_low s1 s2 s3 s4 s5 s6 s7 s8 s9 s10 s11 s12 s13 s14 s15 s16 s17 s18 s19 s20 s21
                s22 s23 s24 s25 s26 s27 s28 s29 s30 sin1 cos1 sin2 cos2 sin3 cos3 sin4 cos4 sin5 cos5 h node place solve momentum change
                change_h reached interval values value text name system systems index rows inputs entries i sum failure checked
                T W N M identity
            }
            static t1: u8 = 0;
            struct k;
            struct m(u8);
        ]
        pub(crate) struct System {
            param m = 1.5, k = 2, W = 0.1, T = 0.3;
            coord x, y;
            L = m * (dot(x)^2 + dot(y)^2 + cos(x - y) * dot(x) * dot(y) / 2) / 2 - k * (x^2 + sin(y)^2) + T * sin(t) * x;
            force y = -W * dot(y);
            discretize midpoint;
            check { x = 0.3, y = 0.5, dot(y) = 0.2; h = 0.01; }
        }
    }
    #[test]
    fn are_no_patterns() {
        assert_eq!(super::run(alone::System::default()), super::run(among::System::default()));
    }
}

mod constants_of_arrays {
    alone_and_among! {
        [
            constants! {
                q q_0 q_1 q_2 q_3 q_0_dot q_mid v v_mid q0 p0 q0_low p0_low i sum entries s1 s2 s3 s4 s5 s6 s7 s8 s9 s10 s11 s12 s13 s14
                s15 s16 s17 s18 s19 s20 s21 s22 s23 s24 s25 s26 s27 s28 s29 s30 s31 s32 s33 s34 s35 s36 s37 s38 s39 s40 h node place
            }
        ]
        pub(crate) struct System {
            const N = 24;
            coord q[N];
            L = sum(i in 0..N, dot(q[i])^2 / 2 + cos(q[i])) - sum(i in 1..N, (q[i] - q[i - 1])^2 + (q[i] - q[i - 1])^4) / 2;
            discretize midpoint;
        }
    }
    #[test]
    fn are_no_patterns() {
        assert_eq!(super::run(alone::System::default()), super::run(among::System::default()));
    }
}

/// Names in the macro that implements the traits of a system in loops.
mod constants_of_loops {
    alone_and_among! {
        [
            constants! {
                t q v p h node interval multipliers i j real row rows value values slopes curvatures force matrix whole weight weights
                columns dt dq dv first c_q c_v r_q r_v c_qq rounded jacobian identity W N K
            }
            type bool = i8;
            type usize = i8;
            struct str;
        ]
        #[vi_limit(0)]
        pub(crate) struct System {
            const N = 4;
            param m[N] = [1, 2, 3, 4];
            coord q[N];
            L = sum(i in 0..N, m[i] * dot(q[i])^2) / 2 - sum(i in 0..N, sum(j in 0..i, m[i] * (q[i] - q[j])^4));
            time_scale = 1 / sqrt(1 + sum(i in 0..N, q[i]^2));
            force q[i in 0..N] = -dot(q[i]) / 9;
            discretize midpoint, trapezoidal;
        }
    }
    #[test]
    fn are_no_patterns() {
        assert_eq!(super::run(alone::System::default()), super::run(among::System::default()));
    }
}

mod constants_of_constraints {
    use super::{Lagrangian, SVector};

    alone_and_among! {
        [constants! { t q v multipliers real row rows value values weights columns c_q c_v r_q r_v identity }]
        #[vi_limit(0)]
        pub(crate) struct System {
            const N = 4;
            coord q[N];
            L = sum(i in 0..N, dot(q[i])^2 - q[i]^2) / 2;
            constraint held[i in 1..N] = q[i] - q[i - 1] - i;
        }
    }
    #[test]
    fn are_no_patterns() {
        let (q, v) = (SVector::from([0.0, 1.0, 3.0, 6.0]), SVector::from([1.0; 4]));
        let alone = alone::System::default().acceleration(0.0, &q, &v).expect("on the constraints");
        let among = among::System::default().acceleration(0.0, &q, &v).expect("on the constraints");
        assert_eq!(alone, among);
        assert!((alone[0] + 2.5).abs() < 1e-14, "{alone}");
    }
}

mod types {
    alone_and_among! {
        [
            type f64 = i8;
            type bool = i8;
            type usize = i8;
            struct str;
            struct Real;
            enum Hostile { None, Some, Ok, Err }
            use Hostile::*;
            trait Clone {}
            trait Copy {}
            trait Debug {}
            trait Default {}
            trait PartialEq {}
            trait Option {}
            mod core {}
            mod std {}
            mod vi_core_ {}
            fn identity() -> Hostile { if let None | Some = Err { Ok } else { Err } }
            #[allow(unused_macros)]
            macro_rules! panic { () => { compile_error!("the wrong macro") }; }
            #[allow(unused_macros)]
            macro_rules! option_env { () => { compile_error!("the wrong macro") }; }
        ]
        pub(crate) struct System {
            param m = 2;
            coord x, y, z;
            L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2 - sqrt(1 + x^2 + y^2) * cosh(z);
            discretize midpoint;
            check { x = 0.3, y = 0.5, dot(x) = 1, dot(z) = 0.5; h = 0.05; }
        }
    }
    #[test]
    fn are_those_of_core() {
        assert_eq!(super::run(alone::System::default()), super::run(among::System::default()));
    }
}

/// Names of structs that emitted code uses, by path, for other types.
mod names {
    macro_rules! systems {
        ($($name:ident)*) => {
            $(::vi_core::lagrangian! {
                pub(crate) struct $name { param Some = 2, numbers = 1; coord None, Ok; L = Some * (dot(None)^2 + dot(Ok)^2) - numbers * None^2; discretize midpoint; }
            })*
            #[test]
            fn of_structs() {
                $(assert_eq!(super::run($name::default())[0], super::run(Some::default())[0]);)*
            }
        };
    }
    systems! {
        N Some Option Result Vec Clone Copy Debug Default PartialEq Into Real SVector SMatrix Lagrangian EnergyStepping Interval Node Rows In
        Jacobian Parameters Banded core std vi_core x identity union auto raw
    }
}

mod attributes {
    use super::{EnergyStepping, Parameters};

    /// A configured-out item needs no meaning.
    #[cfg(any())]
    mod nothing {}
    ::vi_core::lagrangian! {
        #[cfg(any())]
        pub(crate) struct Chosen { coord x; L = y; }
    }
    ::vi_core::lagrangian! {
        #[cfg(all())]
        #[cfg(not(any()))]
        #[derive(PartialOrd)]
        #[cfg_attr(all(), derive(Eq, Hash))]
        #[doc = "Documented."]
        #[allow(clippy::derive_partial_eq_without_eq)]
        #[must_use]
        #[non_exhaustive]
        #[repr(C)]
        pub(crate) struct Chosen {
            /// Mass.
            #[doc(alias = "inertia")]
            #[allow(non_snake_case)]
            param M = 2;
            /// A coordinate.
            coord x;
            L = M * dot(x)^2 / 2 - 1 / x;
            discretize midpoint;
            check { x = 1, dot(x) = 0.7; h = 0.05; }
        }
    }
    ::vi_core::lagrangian! {
        #[deprecated]
        pub(crate) struct Old { coord x; L = dot(x)^2; discretize midpoint; }
    }

    #[test]
    fn go_over_to_the_struct() {
        fn has<S: Parameters + EnergyStepping<1> + PartialOrd>(_: S) {}
        has(Chosen::default());
        assert_eq!(Chosen::default().partial_cmp(&Chosen { M: 3.0 }), Some(core::cmp::Ordering::Less));
        let [fixed, energy_preserving] = super::run::<1, _>(Chosen::default());
        assert!((fixed - energy_preserving).amax() < 0.1 && fixed[0] > 0.4, "{fixed:?} and {energy_preserving:?}");
    }
}

#[test]
fn a_system_can_be_declared_in_a_function() {
    const x: f64 = 1.0;
    let y = x;
    ::vi_core::lagrangian! {
        struct Local { param y = 1; coord x; L = y * dot(x)^2 / 2 - x^2 / 2; discretize midpoint; }
    }
    let lagrangian = Local { y }.lagrangian(0.0, &SVector::from([2.0]), &SVector::from([3.0]));
    assert!((lagrangian - 2.5).abs() < 1e-15, "{lagrangian}");
}

/// A macro argument is one operand.
#[test]
fn an_expression_of_a_macro_is_one_operand() {
    macro_rules! system {
        ($name:ident, $length:expr, $m:expr, $start:literal, $square:tt, $visibility:vis) => {
            ::vi_core::lagrangian! {
                $visibility struct $name {
                    const N = $length * 2;
                    param m = $m * 2 + $start;
                    coord q[N];
                    L = m * sum(i in 0..N, dot(q[i])^$square) / 2;
                    discretize midpoint;
                }
            }
        };
    }
    system!(Filled, 1 + 1, 1 + 2, 0.5, 2, pub(self));
    let filled = Filled::default();
    assert_eq!(<Filled as Lagrangian<4>>::COORDINATES.len(), 4, "(1 + 1) * 2");
    assert!((filled.m - 6.5).abs() < 1e-15, "(1 + 2) * 2 + 0.5 is {}", filled.m);
}
