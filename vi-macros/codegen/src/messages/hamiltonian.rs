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
    NoLagrangian =
        "`H` has no Lagrangian in closed form, which constraints need",
        "write an `H` that is quadratic in the momenta, or `c * sqrt(…)` of a quadratic radicand; or write `L = …;`",
        ["coord x, y; momentum p of x, q of y; «H» = p^4 / 4 + q^2; constraint c = x + y;",
         "coord x, y; momentum p of x, l of y; «H» = p^2 + l * x; constraint c = x - y^2;",
         "coord x, y; momentum p of x, l of y; «H» = (p + l)^2 / 2; constraint c = x - y^2;",
         "coord x[5]; momentum p of x; «H» = p * p / 2 + (sum(i in 0..5, p[i]))^2 * x[0]^2; constraint c = x[0] - x[1];"];
}
