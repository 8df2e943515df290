//! `cargo run --release -- work-precision geodesic`: one system by every method and DOP853, whose steps are adaptive.

use adaptive::{Beam, CartDoublePole, Geodesic, Ladder, Pleiades};
use vi_systems::DoubleWell;

const BEAM: [f64; 12] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2];
/// Coordinates x and y, then velocities, of the Test Set for IVP Solvers.
const PLEIADES: [f64; 14] = [3.0, 3.0, -1.0, -3.0, 2.0, -2.0, 2.0, 3.0, -3.0, 2.0, 0.0, 0.0, -4.0, 4.0];
const PLEIADES_V: [f64; 14] = [0.0, 0.0, 0.0, 0.0, 0.0, 1.75, -1.5, 0.0, 0.0, 0.0, -1.25, 1.0, 0.0, 0.0];

vi_lab::main! {
    sources: ["lib.rs"],
    systems: [
        Geodesic { about: "a geodesic of ten turns", q: [0.0, 10.0, 0.0], v: [1.25, 0.0, 0.04], h: 0.5 },
        Beam { about: "a damped beam", q: BEAM, v: [0.0; 12], h: 0.001 },
        Ladder { about: "a driven ladder of coils", q: [0.0; 16], v: [0.0; 16], h: 0.02 },
        Pleiades { about: "seven bodies with close encounters, to t = 3", q: PLEIADES, v: PLEIADES_V, h: 7.5e-4 },
        CartDoublePole { about: "a cart with two falling poles", q: [0.0, 0.1, 0.1], v: [0.0; 3], h: 0.001 },
        // Among the ready systems it is a text, whose steps an interpreter takes.
        DoubleWell { about: "a particle in a double well", q: [0.995], v: [0.0], h: 0.01 },
    ],
}
