//! Systems against rivals with adaptive steps. The last two come from problem sets of others.

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

lagrangian! {
    /// Pleiades, of the Test Set for IVP Solvers: seven bodies in the plane, which pass each other closely.
    pub struct Pleiades {
        param m[7] = [1, 2, 3, 4, 5, 6, 7];
        coord x[7], y[7];
        L = sum(i in 0..7, m[i] * (dot(x[i])^2 + dot(y[i])^2)) / 2
          + sum(i in 0..7, j in 0..i, m[i] * m[j] / sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2));
        discretize midpoint;
    }
}

lagrangian! {
    /// The cart with two poles of Gymnasium's `inverted_double_pendulum.xml`, with MuJoCo's coordinates, masses and inertias.
    pub struct CartDoublePole {
        param cart = 10.471975511965976, pole = 4.198738581522758, J = 0.15497066975016233, l = 0.6;
        param d = 0.05, g = 9.81, gx = 1e-5;
        coord x, a, b;
        let x1 = x + l * sin(a) / 2;
        let y1 = l * cos(a) / 2;
        let x2 = x + l * sin(a) + l * sin(a + b) / 2;
        let y2 = l * cos(a) + l * cos(a + b) / 2;
        L = cart * dot(x)^2 / 2 + pole * (dot(x1)^2 + dot(y1)^2 + dot(x2)^2 + dot(y2)^2) / 2
          + J * (dot(a)^2 + (dot(a) + dot(b))^2) / 2
          - pole * g * (y1 + y2) + gx * (cart * x + pole * (x1 + x2));
        dissipation = d * (dot(x)^2 + dot(a)^2 + dot(b)^2) / 2;
        discretize midpoint;
    }
}
