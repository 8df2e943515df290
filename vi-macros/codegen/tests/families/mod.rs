//! Two growing families of systems: a chain with interactions of neighbours, and a pendulum of many links with
//! interactions of all pairs. Each file uses its part.

/// A chain of `length` masses with the springs of Fermi, Pasta, Ulam and Tsingou, its first one fixed to a wall.
pub(crate) fn chain(length: usize) -> String {
    format!(
        "pub struct System {{
            const N = {length};
            param m = 1.0, k = 1.0, alpha = 0.25, beta = 0.1;
            coord q[N];
            let r[i in 1..N] = q[i] - q[i - 1];
            let squares = q[0]^2 + sum(i in 1..N, r[i]^2);
            let cubes = q[0]^3 + sum(i in 1..N, r[i]^3);
            let fourths = q[0]^4 + sum(i in 1..N, r[i]^4);
            let kinetic = m * sum(i in 0..N, dot(q[i])^2) / 2;
            L = kinetic - k * squares / 2 - alpha * cubes / 3 - beta * fourths / 4;
            discretize midpoint;
        }}"
    )
}

/// The pendulum of `links` equal links, in absolute angles.
pub(crate) fn pendulum(links: usize) -> String {
    format!(
        "pub struct System {{
            const N = {links};
            param m = 1.0, l = 1.0, g = 9.81;
            coord a[N];
            let alone = sum(i in 0..N, (N - i) * dot(a[i])^2) / 2;
            let pairs = sum(i in 1..N, (N - i) * sum(j in 0..i, dot(a[i]) * dot(a[j]) * cos(a[i] - a[j])));
            L = m * l^2 * (alone + pairs) + m * g * l * sum(i in 0..N, (N - i) * cos(a[i]));
            discretize midpoint;
        }}"
    )
}

/// The masses of the chains, and the links of the pendula.
pub(crate) const LENGTHS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
pub(crate) const LINKS: [usize; 7] = [2, 3, 4, 5, 6, 7, 8];
