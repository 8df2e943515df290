//! Systems on which adaptive steps pay, and one on which they do not.

use vi_core::lagrangian;

lagrangian! {
    /// A geodesic about a black hole of mass M, in the equatorial plane, by proper time.
    pub struct Geodesic {
        param M = 1.0;
        coord T, r, φ;
        L = (-(1 - 2 * M / r) * dot(T)^2 + dot(r)^2 / (1 - 2 * M / r) + r^2 * dot(φ)^2) / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// A beam of twelve links with springs and dampers in its joints.
    pub struct Beam {
        param m = 0.1, l = 0.1, k = 8.0, d = 0.02, g = 9.81;
        coord θ[12];
        let x[i in 0..12] = sum(j in 0..i + 1, l * sin(θ[j]));
        let y[i in 0..12] = -sum(j in 0..i + 1, l * cos(θ[j]));
        L = sum(i in 0..12, m * (dot(x[i])^2 + dot(y[i])^2) / 2 - m * g * y[i])
          - k * θ[0]^2 / 2 - sum(i in 0..11, k * (θ[i + 1] - θ[i])^2 / 2);
        dissipation = d * dot(θ[0])^2 / 2 + sum(i in 0..11, d * (dot(θ[i + 1]) - dot(θ[i]))^2 / 2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A driven ladder of sixteen coils with capacitors between them. Coordinates are charges.
    pub struct Ladder {
        param l = 1.3, c = 0.7, r = 0.05, a = 0.8, w = 0.9;
        coord q[16];
        L = sum(i in 0..16, l * dot(q[i])^2 / 2) - q[0]^2 / (2 * c) - sum(i in 0..15, (q[i + 1] - q[i])^2 / (2 * c));
        force q[0] = -r * dot(q[0]) + a * sin(w * t);
        force q[i in 1..16] = -r * dot(q[i]);
        discretize midpoint;
    }
}
