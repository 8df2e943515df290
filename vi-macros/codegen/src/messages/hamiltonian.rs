//! Mistakes of a Hamiltonian and of its momenta.

use super::words::did_you_mean;

catalogue! {
    /// A mistake of `H` or of a `momentum`.
    HamiltonianMistake:

    Both = "the system has an `L` and an `H`", "write one of them: the compiler computes the other",
        ["coord x; momentum p of x; L = dot(x)^2; «H» = p^2;"];
    SecondHamiltonian = "a second `H`", "write `H` once; name parts of it with `let`",
        ["coord x; momentum p of x; H = p^2; «H» = x;"];
    Missing { name: String, of: String } =
        "the momentum `{name}` has no Hamiltonian",
        "write `H = …;`, or remove `momentum {name} of {of};` and write `L = …;` with `dot({of})`",
        ["momentum «p» of x;", "coord x; momentum «p» of x; L = dot(x)^2;"] { name: "p", of: "x" };
    MissingMomentum { name: String } =
        "the coordinate `{name}` has no momentum", "write `momentum p of {name};`: `H` needs a momentum of each coordinate",
        ["coord x, «y»; momentum p of x; H = p^2;", "coord «y»; H = y^2;"] { name: "y" };
    OfOther { name: String, near: Option<String> } =
        "`{name}` has a momentum but is not a coordinate",
        { did_you_mean(near.as_ref(), "a momentum belongs to a coordinate: `coord q; momentum p of q;`") },
        ["param m = 1; coord x; momentum p of «m»; H = p^2 / m;"] { name: "m", near: "" },
        ["coord angle; momentum p of «angel»; H = p^2;"] { name: "angel", near: "angle" };
    OfRotation { name: String } =
        "a rotation has no momentum in `H`", "write `L = …;` for a system with `rotation {name};`, with `rate({name})`",
        ["rotation R; momentum p of «R»; H = p * p;", "rotation «R»; coord x; momentum p of x; H = p^2;"] { name: "R" };
    Second { name: String } =
        "a second momentum of `{name}`", "each coordinate has one momentum; name another quantity with `let`",
        ["coord x; momentum p of x, l of «x»; H = p^2;"] { name: "x" };
    NotQuadratic { name: String } =
        "`H` is not quadratic in `{name}`, so that it has no Lagrangian in closed form",
        "the compiler inverts an `H` that is quadratic in the momenta, and `c * sqrt(…)` of a quadratic radicand; write `L = …;` \
         if you know it",
        ["coord x; momentum p of x; «H» = p^4 / 4 + x^2;", "coord x; momentum p of x; «H» = p^2 / 2 + abs(p);",
         "coord x; momentum p of x; «H» = sqrt(1 + p^2) + p^2;", "coord x; momentum p of x; «H» = cos(p) - x^2;",
         "coord x; momentum p of x; «H» = sqrt(1 + p^2)^3;"] { name: "p" },
        ["coord x, y[2]; momentum p of x, q of y; «H» = p^2 + q[0]^2 + exp(q[1]);"] { name: "q[1]" };
    Linear { name: String } =
        "`H` contains no square of `{name}`, so that the system has no Lagrangian",
        "each momentum needs a quadratic term, as in `{name}^2 / (2 * m)`; the compiler has no methods for equations of first order",
        ["coord x, y; momentum p of x, «l» of y; H = p^2 + l * x;", "coord x, y; momentum p of x, «l» of y; H = p^2 + y^2;",
         "coord x; momentum «l» of x; H = l * x;"] { name: "l" };
    Singular =
        "the matrix ∂²H/∂p² is singular for every state, or nearly so, and has no Lagrangian",
        "each independent momentum needs a quadratic term of its own, as in `p^2 / (2 * m)`",
        ["coord x, y; momentum p of x, l of y; «H» = (p + l)^2 / 2;",
         "coord r[2]; momentum p of r; «H» = norm(p) + r * r;"];
    Coupled { count: usize } =
        "`H` couples {count} momenta by coefficients that are not numbers",
        "the compiler inverts the coefficients of up to 4 momenta; write `L = …;`, whose mass matrix is the inverse",
        ["coord x[5]; momentum p of x; «H» = p * p / 2 + (sum(i in 0..5, p[i]))^2 * x[0]^2;"] { count: 5 };
}
