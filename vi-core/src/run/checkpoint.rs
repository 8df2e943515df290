//! Checkpoints: the complete data of a run and its system.
//!
//! A [`Checkpoint`] holds a run between two steps. The feature `serde` stores it in any format that keeps numbers
//! exactly (`serde_json` with its feature `float_roundtrip`). After a restart every number and every error of later
//! steps is bit for bit that of the uninterrupted run, on a processor with the same instructions. Errors are not
//! stored: the restarted run meets them again.

use super::Run;
use crate::angles::{self, Turns};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{Memory as _, Method};
use crate::node::Node;
use crate::real::Scalar;
use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;

/// A run between two steps, with its system and rule.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "Y: serde::Serialize, T: crate::real::Real + serde::Serialize",
        deserialize = "Y: serde::Deserialize<'de>, T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Checkpoint<Y, const N: usize, T = f64> {
    system: String,
    /// `None` for the first rule of the system.
    #[cfg_attr(feature = "serde", serde(default))]
    rule: Option<String>,
    /// Names and values, in the order of their declaration.
    parameters: Vec<(String, T)>,
    /// [`Lagrangian::TABLES`].
    tables: u32,
    run: Stored<Y, N, T>,
}

/// The data that a run carries from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "Y: serde::Serialize, T: crate::real::Real + serde::Serialize",
        deserialize = "Y: serde::Deserialize<'de>, T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Stored<Y, const N: usize, T = f64> {
    node: Node<N, T>,
    /// Whole turns of angles; zero for other coordinates, and in files of older versions.
    #[cfg_attr(feature = "serde", serde(default = "Turns::zeros"))]
    turns: Turns<N>,
    h: T,
    memory: Y,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Run<M, S, N, T> {
    /// Stores the data of the run, and the name and parameters of its system. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<M::Memory, N, T> {
        let system = &self.system;
        let named = system.parameters().iter().enumerate();
        Checkpoint {
            system: system.name().to_owned(),
            rule: self.method.facts().rule.map(str::to_owned),
            parameters: named.map(|(index, name)| ((*name).to_owned(), system.parameter(index))).collect(),
            tables: system.tables(),
            run: Stored { node: self.node, turns: self.turns, h: self.h, memory: self.memory.stored() },
        }
    }

    /// Resumes the run of `checkpoint`, bit for bit.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`]
    /// and [`StepError::InvalidInput`] for data that no run of this method can produce;
    /// [`StepError::InconsistentStart`] and [`StepError::DroppedConstraint`] for a node off the constraints.
    pub fn restart(system: S, method: M, checkpoint: Checkpoint<M::Memory, N, T>) -> Result<Self, StepError> {
        let Stored { node, turns, h, memory } = checkpoint.run_of(&system, method.facts().rule)?;
        method.check_length(&system, h)?;
        let t = if node.t.to_f64().is_finite() { node.t } else { T::zero() };
        node.check_finite(t)?;
        angles::check(&system, &node.q, &turns)?;
        method.check(&system, (&node, &memory), h)?;
        Ok(Self { turns, ..Self::resumed(method, system, (node, h, memory)) })
    }
}

impl<Y, const N: usize, T: Scalar> Checkpoint<Y, N, T> {
    /// This checkpoint with the memory that `of` returns for its memory.
    ///
    /// # Errors
    /// The errors of `of`.
    #[doc(hidden)]
    pub fn try_map<Z, E>(self, of: impl FnOnce(Y) -> Result<Z, E>) -> Result<Checkpoint<Z, N, T>, E> {
        let Self { system, rule, parameters, tables, run: Stored { node, turns, h, memory } } = self;
        Ok(Checkpoint { system, rule, parameters, tables, run: Stored { node, turns, h, memory: of(memory)? } })
    }

    /// Returns the stored data, if system, rule, tables and parameters agree.
    fn run_of<S: Lagrangian<N, T>>(self, system: &S, rule: Option<&'static str>) -> Result<Stored<Y, N, T>, StepError> {
        let other =
            |parameter, stored, given| StepError::OtherSystem { system: system.name(), parameter, stored, given };
        let names = self.parameters.iter().map(|(name, _)| name.as_str());
        if self.system != system.name()
            || self.rule.as_deref() != rule
            || self.tables != system.tables()
            || !names.eq(system.parameters().iter().copied())
        {
            return Err(other(None, f64::NAN, f64::NAN));
        }
        for (index, (name, (_, stored))) in system.parameters().iter().zip(&self.parameters).enumerate() {
            let given = system.parameter(index);
            if *stored != given {
                return Err(other(Some(name), stored.to_f64(), given.to_f64()));
            }
        }
        Ok(self.run)
    }
}
