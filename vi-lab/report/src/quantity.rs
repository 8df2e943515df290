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
        let coordinates = system.coordinates();
        let place = |name: &str| coordinates.iter().position(|coordinate| *coordinate == name);
        if let Some(index) = place(name) {
            return Ok(Self::Coordinate(index));
        }
        if let Some(index) = name.strip_prefix("v_").and_then(place) {
            return Ok(Self::Velocity(index));
        }
        let parameters: Vec<&str> = system.parameters().iter().map(|(parameter, _)| *parameter).collect();
        match name {
            _ if parameters.contains(&name) => Ok(Self::Parameter(name.to_owned())),
            "h" => Ok(Self::Step),
            _ => {
                let velocities: Vec<String> = coordinates.iter().map(|coordinate| format!("v_{coordinate}")).collect();
                let names = [coordinates.join(", "), velocities.join(", "), parameters.join(", "), "h".to_owned()];
                let names: Vec<&str> = names.iter().map(String::as_str).filter(|names| !names.is_empty()).collect();
                Err(Failure::Input(format!(
                    "there is no quantity `{name}` to vary; the quantities are {}",
                    names.join(", ")
                )))
            }
        }
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
