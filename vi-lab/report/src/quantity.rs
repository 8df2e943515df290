//! The quantities that can vary from run to run: a coordinate, a velocity, a parameter, the step.
//!
//! In: the name of a coordinate or a parameter, `v_` plus a coordinate for its velocity, `h`. Out: a [`Quantity`],
//! which sets a system and a plan.

use crate::failure::Failure;
use vi_erased::System;
use vi_erased::plan::Plan;

/// A quantity that varies from run to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Initial coordinate.
    Coordinate(usize),
    /// Initial velocity.
    Velocity(usize),
    /// Parameter of the system.
    Parameter(String),
    /// First step.
    Step,
}

impl Quantity {
    /// The quantity with this name.
    ///
    /// # Errors
    /// [`Failure::Input`] with the existing names.
    pub fn named(system: &dyn System, name: &str) -> Result<Self, Failure> {
        let all = Self::all(system);
        let named = all.iter().find(|(known, _)| known == name);
        named.map(|(_, quantity)| quantity.clone()).ok_or_else(|| {
            let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
            Failure::Input(format!("there is no quantity `{name}` to vary; the quantities are {}", names.join(", ")))
        })
    }

    /// All quantities by name.
    fn all(system: &dyn System) -> Vec<(String, Self)> {
        let coordinates =
            (0..).zip(system.coordinates()).map(|(index, name)| (name.to_owned(), Self::Coordinate(index)));
        let velocities =
            (0..).zip(system.coordinates()).map(|(index, name)| (format!("v_{name}"), Self::Velocity(index)));
        let parameters =
            system.parameters().into_iter().map(|(name, _)| (name.to_owned(), Self::Parameter(name.to_owned())));
        coordinates.chain(velocities).chain(parameters).chain([("h".to_owned(), Self::Step)]).collect()
    }

    /// Sets the quantity in this system and this plan.
    pub fn set(&self, value: f64, system: &mut dyn System, plan: &mut Plan) {
        match self {
            Self::Coordinate(index) => plan.q.iter_mut().skip(*index).take(1).for_each(|q| *q = value),
            Self::Velocity(index) => plan.v.iter_mut().skip(*index).take(1).for_each(|v| *v = value),
            Self::Parameter(name) => {
                system.set(name, value);
            }
            Self::Step => plan.h = value,
        }
    }
}
