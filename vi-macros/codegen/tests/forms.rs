//! The form of the Jacobian A and of the mass matrix M: what is found about a system, and the types that are emitted.

use crate::families;
use vi_codegen::found::Pattern::{self, Banded, Blocks, Dense, Diagonal, Scalar, Tridiagonal};
use vi_codegen::{derive, items, syntax::parse};

/// What is found about A, and the forms that are emitted.
#[derive(Debug, PartialEq)]
struct Forms {
    pattern: Pattern,
    symmetric: bool,
    jacobian: String,
    mass: String,
}

fn forms(pattern: Pattern, symmetric: bool, jacobian: &str, mass: &str) -> Forms {
    Forms { pattern, symmetric, jacobian: jacobian.to_owned(), mass: mass.to_owned() }
}

/// The items of a system without spaces, and its forms.
fn emitted(text: &str) -> (String, Forms) {
    let derivations = derive(&parse::system(text.parse().expect("tokens")).expect("a system"))
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    let rust: String = items(&derivations).to_string().split_whitespace().collect();
    let between = |start: &str, end: &str| {
        let (_, rest) = rust.split_once(start).expect("emitted");
        let form = rest.split_once(end).expect("its end").0;
        form.replace("::vi_core::linear::", "").replace("::vi_core::", "")
    };
    let (jacobian, mass) = (between("typeJacobian=", ";"), between("letmass:", "="));
    let findings = derivations.own.findings.steps.expect("a rule");
    let found = Forms { pattern: findings.pattern, symmetric: findings.symmetric, jacobian, mass };
    (rust, found)
}

/// The forms of the system of these lines.
fn of(body: &str) -> Forms {
    emitted(&format!("pub struct System {{ {body} discretize midpoint; }}")).1
}

/// `size` masses of 1 in the potential `V`, under a force.
fn masses(size: usize, potential: &str, force: &str) -> Forms {
    of(&format!("const N = {size}; coord q[N]; L = sum(i in 0..N, dot(q[i])^2)/2 - ({potential}); {force}"))
}

#[test]
fn neighbours() {
    for length in [4, 5, 16] {
        let (jacobian, mass) = (format!("Tridiagonal<{length},T>"), format!("Banded<{length},1,T>"));
        let (_, found) = emitted(&families::chain(length));
        assert_eq!(found, forms(Tridiagonal, true, &jacobian, &mass));
    }
    // Up to three rows the closed form is used, whatever the pattern.
    assert_eq!(emitted(&families::chain(3)).1, forms(Tridiagonal, true, "nalgebra::SMatrix<T,3,3>", "Banded<3,1,T>"));
    assert_eq!(emitted(&families::chain(2)).1, forms(Dense, true, "nalgebra::SMatrix<T,2,2>", "Banded<2,1,T>"));
    assert_eq!(
        emitted(&families::chain(1)).1,
        forms(Scalar, true, "nalgebra::SMatrix<T,1,1>", "nalgebra::SMatrix<T,1,1>")
    );
    // A force by the right neighbour alone: no matrix is its own transpose, and the place on the left is kept.
    let drawn = masses(4, "0", "force q[i in 0..N - 1] = q[i]*q[i + 1];");
    assert_eq!(drawn, forms(Tridiagonal, false, "Tridiagonal<4,T>", "Banded<4,1,T>"));
    // The chain hangs in its velocities, too.
    let heavy =
        of("const N = 4; coord q[N]; L = dot(q[0])^2 + sum(i in 1..N, (dot(q[i]) - dot(q[i - 1]))^2)/2 - q[0]^2;");
    assert_eq!(heavy, forms(Tridiagonal, true, "Tridiagonal<4,T>", "Tridiagonal<4,T>"));
    // With Störmer–Verlet, whose equation takes the forces at the start only, nothing is beside the diagonal.
    let verlet = families::chain(6).replace("midpoint", "trapezoidal");
    assert_eq!(emitted(&verlet).1, forms(Diagonal, true, "Banded<6,1,T>", "Banded<6,1,T>"));
}

#[test]
fn neighbours_of_neighbours() {
    let potential = "sum(i in 0..N - 2, q[i]*q[i + 1]*q[i + 2])";
    for size in [10, 12] {
        let (jacobian, mass) = (format!("Banded<{size},5,T>"), format!("Banded<{size},1,T>"));
        assert_eq!(masses(size, potential, ""), forms(Banded(2), true, &jacobian, &mass));
    }
    // Less than half of a row is out of the band.
    assert_eq!(masses(9, potential, ""), forms(Dense, true, "Symmetric<9,T>", "Banded<9,1,T>"));
    let drawn = masses(10, potential, "force q[0] = q[2]^2;");
    assert_eq!(drawn, forms(Banded(2), false, "Banded<10,5,T>", "Banded<10,1,T>"));
}

#[test]
fn bodies_that_do_not_touch() {
    // Two pendula of two links, (u, x) and (v, y), and two of one.
    let pair = |x: &str, y: &str| {
        format!("dot({x})^2 + dot({y})^2/2 + dot({x})*dot({y})*cos({x} - {y}) + 2*cos({x}) + cos({y})")
    };
    let text = format!(
        "pub struct System {{ coord u, v, w, x, y, z;
            L = {} + {} + dot(w)^2/2 + cos(w) + dot(z)^2/2 + cos(z); discretize midpoint; }}",
        pair("u", "x"),
        pair("v", "y")
    );
    let (rust, found) = emitted(&text);
    let blocks = Blocks(vec![vec![0, 3], vec![1, 4], vec![2], vec![5]]);
    assert_eq!(found, forms(blocks, false, "Blocks<6,2,T>", "Blocks<6,2,T>"));
    // In momentum_equation, extended_system, and acceleration at least.
    let (all, right) = (rust.matches("members:").count(), rust.matches("members:&[&[0,3],&[1,4],&[2],&[5]]").count());
    assert!(all >= 3 && right == all, "{right} of {all}");
    let three = of("coord x, y, z; L = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2 - x*z^2 - y^4;");
    assert_eq!(three, forms(Blocks(vec![vec![0, 2], vec![1]]), true, "nalgebra::SMatrix<T,3,3>", "Banded<3,1,T>"));
    // One alone among others, one row of two.
    let rest = masses(5, "q[1]*q[2]*q[3]*q[4] + q[0]^4", "force q[2] = -q[1]^2;");
    let blocks = Blocks(vec![vec![0], vec![1, 2, 3, 4]]);
    assert_eq!(rest, forms(blocks, false, "Blocks<5,4,T>", "Banded<5,1,T>"));
    assert_eq!(masses(5, "sum(i in 0..N, q[i]^4)", ""), forms(Diagonal, true, "Banded<5,1,T>", "Banded<5,1,T>"));
}

#[test]
fn bodies_that_all_touch() {
    for size in [4, 5] {
        // A spring between any two.
        let springs = masses(size, "sum(i in 1..N, sum(j in 0..i, (q[i] - q[j])^4))", "");
        assert_eq!(springs, forms(Dense, true, &format!("Symmetric<{size},T>"), &format!("Banded<{size},1,T>")));
        // A mass that depends on the place: A = M + (h/2) (p_q − p_qᵀ) + …
        let pendulum = emitted(&families::pendulum(size)).1;
        assert_eq!(
            pendulum,
            forms(Dense, false, &format!("nalgebra::SMatrix<T,{size},{size}>"), &format!("Symmetric<{size},T>"))
        );
    }
    assert_eq!(
        emitted(&families::pendulum(3)).1,
        forms(Dense, false, "nalgebra::SMatrix<T,3,3>", "nalgebra::SMatrix<T,3,3>")
    );
    // One row that friction draws into.
    let pulled = masses(4, "(q[0] + q[1] + q[2] + q[3])^4", "force q[0] = -dot(q[1]);");
    assert_eq!(pulled, forms(Dense, false, "nalgebra::SMatrix<T,4,4>", "Banded<4,1,T>"));
    // A magnetic field: A = 1 ± (h/2) b beside the diagonal.
    let turning = of("coord x, y; L = (dot(x)^2 + dot(y)^2)/2 + x*dot(y);");
    assert_eq!(turning, forms(Dense, false, "nalgebra::SMatrix<T,2,2>", "Banded<2,1,T>"));
    // A ring closes the corners.
    let ring = masses(4, "sum(i in 0..N - 1, q[i]*q[i + 1]) + q[0]*q[N - 1]", "");
    assert_eq!(ring, forms(Dense, true, "Symmetric<4,T>", "Banded<4,1,T>"));
}
