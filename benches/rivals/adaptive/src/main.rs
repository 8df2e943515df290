//! `cargo run --release -- work-precision geodesic`, `beam`, `ladder`: against DOP853, whose steps are adaptive.

use adaptive::{Beam, Geodesic, Ladder};

vi_lab::main! {
    sources: ["lib.rs"],
    systems: [
        Geodesic { about: "a geodesic of ten turns", q: [0.0, 10.0, 0.0], v: [1.25, 0.0, 0.04], h: 0.5 },
        Beam { about: "a damped beam", q: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2], v: [0.0; 12], h: 0.001 },
        Ladder { about: "a driven ladder of coils", q: [0.0; 16], v: [0.0; 16], h: 0.02 },
    ],
}
