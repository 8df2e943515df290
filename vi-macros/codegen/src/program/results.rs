//! Results of a function, by name.
//!
//! In: values keyed by [`Output`]. Out: [`Results`]: of expressions during assembly, of operations in a
//! [`Function`](super::Function), of formulas during printing.

/// Declares the functions of a system: the identity, the name in the emitted code, the methods that call it.
macro_rules! functions {
    ($($(#[$meaning:meta])* $id:ident, $name:literal, $methods:ident;)*) => {
        /// A function of a system.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum FunctionId {
            $($(#[$meaning])* $id,)*
        }

        impl FunctionId {
            /// Its name in the emitted code.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$id => $name,)*
                }
            }

            /// The methods that call it.
            pub(crate) fn methods(self) -> Methods {
                match self {
                    $(Self::$id => Methods::$methods,)*
                }
            }
        }
    };
}

functions! {
    /// L.
    Lagrangian, "lagrangian", Every;
    /// v·L_v − L.
    Energy, "energy", Every;
    /// L_v.
    Momentum, "momentum", Every;
    /// f.
    Force, "force", Every;
    /// The mass matrix M and M a.
    Acceleration, "acceleration", Every;
    /// L_v, L_q + f, and M.
    Point, "point", Gauss;
    /// Derivatives of L_v and L_q + f.
    PointDerivatives, "point_derivatives", Gauss;
    /// f·v − L_t.
    Power, "power", Gauss;
    /// M a without reactions.
    Applied, "applied", Gauss;
    /// g of the constraints.
    Constraints, "constraints", Gauss;
    /// A and a of the constraints.
    ConstraintGradients, "constraint_gradients", Gauss;
    /// Derivatives of A v + a.
    ConstraintRateDerivatives, "constraint_rate_derivatives", Gauss;
    /// Σ λ ∂A/∂q.
    ReactionDerivatives, "reaction_derivatives", Gauss;
    /// L_v, L_q + f, M, v·L_v − L, f·v − L_t, and the time scale with its derivatives.
    ScaledPoint, "scaled_point", Transformed;
    /// D.
    StepDensity, "step_density", EnergyPreserving;
    /// The parts of L and f.
    NonFinite, "non_finite", Every;
    /// The arguments of Rust functions and tables.
    Undefined, "undefined", Every;
    /// L_d.
    Ld, "ld", Slots;
    /// ∂L_d/∂t0.
    D1Ld, "d1_ld", Slots;
    /// ∂L_d/∂q0.
    D2Ld, "d2_ld", Slots;
    /// ∂L_d/∂t1.
    D3Ld, "d3_ld", Slots;
    /// ∂L_d/∂q1.
    D4Ld, "d4_ld", Slots;
    /// f_d⁻.
    FdMinus, "fd_minus", Slots;
    /// f_d⁺.
    FdPlus, "fd_plus", Slots;
    /// g_d⁻.
    GdMinus, "gd_minus", Slots;
    /// g_d⁺.
    GdPlus, "gd_plus", Slots;
    /// The momentum row and A.
    MomentumEquation, "momentum_equation", Fixed;
    /// The momentum row, its rounding scale, and p1 − p0.
    MomentumResidual, "momentum_residual", Fixed;
    /// Derivatives of the momentum row and of p1 − p0.
    MomentumDerivatives, "momentum_derivatives", Fixed;
    /// E1.
    DiscreteEnergy, "discrete_energy", Fixed;
    /// The body of a loop of a large system.
    Body, "body", None;
    /// Both rows and their derivatives.
    ExtendedSystem, "extended_system", EnergyPreserving;
    /// Both rows, their rounding scales, p1 − p0 and E1 − E0.
    ExtendedResidual, "extended_residual", EnergyPreserving;
    /// Derivatives of both rows, of p1 − p0 and of E1 − E0.
    ExtendedDerivatives, "extended_derivatives", EnergyPreserving;
}

/// Methods that call the same functions.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Methods {
    /// All methods.
    Every,
    /// Gauss and energy-preserving Gauss steps.
    Gauss,
    /// Gauss steps in transformed time.
    Transformed,
    /// Fixed steps.
    Fixed,
    /// Energy-preserving steps of a rule.
    EnergyPreserving,
    /// None; the trait of the slots has the function.
    Slots,
    /// None; the function is a part of others.
    None,
}

/// A quantity computed by a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Output {
    /// The value of a function that computes one number or one vector.
    Value,
    /// The mass matrix M.
    Mass,
    /// L_v.
    Momentum,
    /// M a, for the acceleration a.
    MassTimesAcceleration,
    /// Ω = ∂L_v/∂q − ∂(L_q + f)/∂v, if L is linear in the velocities.
    Structure,
    /// Ω a.
    StructureTimesAcceleration,
    /// L_q + f.
    AppliedForce,
    /// ∂L_v/∂q.
    MomentumDq,
    /// ∂(L_q + f)/∂q.
    ForceDq,
    /// ∂(L_q + f)/∂v.
    ForceDv,
    /// v·L_v − L.
    Energy,
    /// f·v − L_t.
    Power,
    /// A of the constraints.
    Gradients,
    /// a of the constraints.
    Rates,
    /// ∂(A v + a)/∂q.
    RatesDq,
    /// ∂(A v + a)/∂t.
    RatesDt,
    /// Σ λ ∂A/∂q.
    ReactionDq,
    /// g of dt = g dτ.
    TimeScale,
    /// ∂g/∂q.
    TimeScaleDq,
    /// ∂g/∂t.
    TimeScaleDt,
    /// r, the momentum row.
    Residual,
    /// A = ∂r/∂v.
    Jacobian,
    /// ∂r/∂h.
    ResidualDh,
    /// The sum of the absolute values of the terms of r.
    RoundingScale,
    /// c, the energy row combined with the momentum row.
    EnergyResidual,
    /// ∂c/∂v / h.
    EnergyDv,
    /// ∂c/∂h / h.
    EnergyDh,
    /// The sum of the absolute values of the terms of c.
    EnergyRoundingScale,
    /// p1 − p0.
    MomentumIncrement,
    /// E1 − E0.
    EnergyIncrement,
    /// ∂r/∂q.
    ResidualDq,
    /// ∂c/∂q.
    EnergyDq,
    /// ∂(p1 − p0)/∂q.
    MomentumIncrementDq,
    /// ∂(p1 − p0)/∂v.
    MomentumIncrementDv,
    /// ∂(p1 − p0)/∂h.
    MomentumIncrementDh,
    /// ∂(E1 − E0)/∂q.
    EnergyIncrementDq,
    /// ∂(E1 − E0)/∂v.
    EnergyIncrementDv,
    /// ∂(E1 − E0)/∂h.
    EnergyIncrementDh,
}

/// Quantities as rows: a number has one row of one entry, a vector one row, a matrix several.
#[derive(Clone, Debug)]
pub struct Results<E> {
    quantities: Vec<(Output, Vec<Vec<E>>)>,
}

impl<E> Results<E> {
    /// Creates results from these quantities, in this order.
    pub(super) fn new(quantities: Vec<(Output, Vec<Vec<E>>)>) -> Self {
        Self { quantities }
    }

    /// The rows of a matrix; empty if it is not computed.
    #[must_use]
    pub fn matrix(&self, output: Output) -> &[Vec<E>] {
        self.quantities.iter().find(|(known, _)| *known == output).map_or(&[], |(_, rows)| rows)
    }

    /// The entries of a vector; empty if it is not computed.
    #[must_use]
    pub fn vector(&self, output: Output) -> &[E] {
        self.matrix(output).first().map_or(&[], Vec::as_slice)
    }

    /// A number, if it is computed.
    #[must_use]
    pub fn number(&self, output: Output) -> Option<&E> {
        self.vector(output).first()
    }

    /// The rows of all quantities, in order.
    pub fn rows(&self) -> impl Iterator<Item = &[E]> {
        self.quantities.iter().flat_map(|(_, rows)| rows).map(Vec::as_slice)
    }

    /// All entries, in order.
    pub fn entries(&self) -> impl Iterator<Item = &E> {
        self.rows().flatten()
    }

    /// Maps each entry, under the same names.
    pub(crate) fn map<F>(&self, mut make: impl FnMut(&E) -> F) -> Results<F> {
        let mut made = |rows: &Vec<Vec<E>>| rows.iter().map(|row| row.iter().map(&mut make).collect()).collect();
        Results { quantities: self.quantities.iter().map(|(output, rows)| (*output, made(rows))).collect() }
    }
}
