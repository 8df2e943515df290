//! Growing families of systems: a chain with interactions of neighbours; a pendulum of many links, by its angles and by
//! positions, and bodies in space, with interactions of all pairs. Each file uses its part.

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

/// Links by the positions of their masses, which are recursions.
pub(crate) fn links(count: usize) -> String {
    format!(
        "pub struct System {{
            const N = {count};
            param m[N] = 1.0, l[N] = 0.3, g = 9.81;
            coord q[N];
            let x[0] = l[0] * sin(q[0]);
            let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
            let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
            L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
            discretize midpoint;
        }}"
    )
}

/// Bodies in space that attract each other.
pub(crate) fn bodies(count: usize) -> String {
    format!(
        "pub struct System {{
            const N = {count};
            param m[N] = 1.0, G = 1.0;
            coord r[N][3];
            L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i]) / 2)
                + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));
            discretize midpoint;
        }}"
    )
}

/// The masses of the chains, and the links of the pendula.
pub(crate) const LENGTHS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
pub(crate) const LINKS: [usize; 7] = [2, 3, 4, 5, 6, 7, 8];
