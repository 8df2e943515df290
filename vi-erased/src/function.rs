//! Smooth functions along a motion: what a cost or a condition of optimal control is.

/// K points of a motion, with the numbers of the system at each.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// K times.
    pub t: &'a [f64],
    /// N coordinates of each.
    pub q: &'a [f64],
    /// N velocities of each.
    pub v: &'a [f64],
    /// All parameters of the system for each.
    pub parameters: &'a [f64],
}

/// A function of the time, the coordinates, the velocities and M inputs.
pub trait Function: Send {
    /// The values at K points (order 0), the derivatives with respect to t, q, v and the inputs (order 1, K times
    /// D = 1 + 2N + M numbers), or the second derivatives (order 2, K symmetric matrices of D² numbers). NaN if a value
    /// does not exist.
    fn at(&self, points: &Points<'_>, order: u8) -> Vec<f64>;

    /// Whether the function depends on inputs only.
    fn is_of_inputs(&self) -> bool {
        false
    }
}
