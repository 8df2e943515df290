//! The elementary functions.
//!
//! In: a name. Out: a [`Function`] with its arity, parity and value in floating point. The square root is the power
//! 1/2.

/// Elementary function of one or two real arguments, with its name in the language of systems.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Function {
    /// `e^x`.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Sine of an angle in radians.
    Sin,
    /// Cosine of an angle in radians.
    Cos,
    /// Tangent of an angle in radians.
    Tan,
    /// Inverse sine, in [-π/2, π/2].
    Asin,
    /// Inverse cosine, in [0, π].
    Acos,
    /// Inverse tangent, in (-π/2, π/2).
    Atan,
    /// `atan2(y, x)`: the angle of the point (x, y), in (-π, π].
    Atan2,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Absolute value.
    Abs,
    /// -1, 0 or 1.
    Sign,
    /// `hypot(x, y) = (x^2 + y^2)^(1/2)`.
    Hypot,
    /// `pow(a, b) = a^b` with an exponent that is not an exact number.
    Pow,
}

/// Symmetry of a function of one argument under a change of sign.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(crate) enum Parity {
    /// `f(-x) = f(x)`.
    Even,
    /// `f(-x) = -f(x)`.
    Odd,
    /// Neither.
    None,
}

impl Function {
    /// Every function, in the order of the type.
    pub const ALL: [Self; 16] = [
        Self::Exp,
        Self::Ln,
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Atan2,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Abs,
        Self::Sign,
        Self::Hypot,
        Self::Pow,
    ];

    /// Name in the language of systems.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exp => "exp",
            Self::Ln => "ln",
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Atan2 => "atan2",
            Self::Sinh => "sinh",
            Self::Cosh => "cosh",
            Self::Tanh => "tanh",
            Self::Abs => "abs",
            Self::Sign => "sign",
            Self::Hypot => "hypot",
            Self::Pow => "pow",
        }
    }

    /// Number of arguments, 1 or 2.
    #[must_use]
    pub const fn arity(self) -> usize {
        match self {
            Self::Atan2 | Self::Hypot | Self::Pow => 2,
            _ => 1,
        }
    }

    /// The function with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.name() == name)
    }

    pub(crate) const fn parity(self) -> Parity {
        match self {
            Self::Cos | Self::Cosh | Self::Abs => Parity::Even,
            Self::Sin | Self::Tan | Self::Asin | Self::Atan | Self::Sinh | Self::Tanh | Self::Sign => Parity::Odd,
            _ => Parity::None,
        }
    }

    /// Value in floating point; only functions of two arguments read `second`.
    #[must_use]
    pub fn value(self, first: f64, second: f64) -> f64 {
        match self {
            Self::Exp => first.exp(),
            Self::Ln => first.ln(),
            Self::Sin => first.sin(),
            Self::Cos => first.cos(),
            Self::Tan => first.tan(),
            Self::Asin => first.asin(),
            Self::Acos => first.acos(),
            Self::Atan => first.atan(),
            Self::Atan2 => first.atan2(second),
            Self::Sinh => first.sinh(),
            Self::Cosh => first.cosh(),
            Self::Tanh => first.tanh(),
            Self::Abs => first.abs(),
            // `f64::signum` is 1 at 0.
            Self::Sign if first == 0.0 => 0.0,
            Self::Sign => first.signum(),
            Self::Hypot => first.hypot(second),
            Self::Pow => first.powf(second),
        }
    }
}
