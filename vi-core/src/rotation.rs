//! Orientations of bodies: what the coordinates of a `rotation` are for a reader.

use crate::lagrangian::{Lagrangian, Space};
use crate::real::{Real, Scalar};
use crate::state::State;
use nalgebra::{Quaternion, UnitQuaternion};

impl<const N: usize, T: Scalar> State<N, T> {
    /// The orientations of the bodies, one for each `rotation` of the system and each entry of an array of them, in the
    /// order of declaration. They turn vectors of the body into space.
    ///
    /// A quaternion of a run has the length 1 to rounding; another one is divided by its length.
    pub fn orientations<S: Lagrangian<N, T>>(&self, system: &S) -> impl Iterator<Item = UnitQuaternion<f64>> {
        let (spaces, q) = (system.spaces(), self.q.map(Real::to_f64));
        (0..N).filter(move |i| spaces[*i] == Space::Rotation(0)).map(move |i| {
            let [w, x, y, z] = [0, 1, 2, 3].map(|component| q[i + component]);
            UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
        })
    }
}
