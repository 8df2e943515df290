//! Mistakes with constraints, each at its token with its correction.

use crate::messages::{case, errors};

/// The rest of a correct system in space with parameters.
const REST: &str = "param l = 1, m = 2; coord x, y, z, q[4]; \
                    L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(q) * dot(q)) / 2 - l * z;";

/// One case: a clause before the rest of a correct system.
fn clause(clause: &str, message: &str) {
    case(&format!("{clause} {REST}"), message);
}

/// One case: the expression of a constraint.
fn value(value: &str, message: &str) {
    clause(&format!("constraint c = {value};"), message);
}

#[test]
fn names_and_signs() {
    let named = "this constraint has no name\nhelp: write `constraint rod = x^2 + y^2 - l^2;`: the expression is 0";
    for written in
        ["«=» x^2 + y^2 - l^2", "«x»^2 + y^2 - l^2", "«x»^2 = 1", "«2» * x - y", "«(»x - y)", "«sqrt»(x) = 1"]
    {
        clause(&format!("constraint {written};"), named);
    }
    // The name of a coordinate is the left side of an equation.
    for written in ["«x» = y", "«q»[0] = y", "«q»[i in 0..4] = x - q[i]", "«x» == y"] {
        clause(&format!("constraint {written};"), named);
    }
    let equation = "a constraint is one expression, which is 0\nhelp: write the difference of both sides";
    for written in ["x^2 + y^2 «=» l^2", "x «=»= y", "x «!»= 0"] {
        value(written, equation);
    }
    for written in ["y «>» 0", "y «<»= x"] {
        value(
            written,
            "inequalities are not supported as constraints\nhelp: a constraint is an expression that is 0; write a",
        );
    }
    clause("constraint «c»;", "`c` has no value");
    clause("constraint «c» += x;", named);
    clause("constraint «l» = x - y;", "the name `l` is declared twice");
    clause("let gap = x - y; constraint «gap» = gap;", "the name `gap` is declared twice");
    clause("constraint c = x - y, «c» = x - z;", "the name `c` is declared twice");
    clause("constraint «t» = x - y;", "the name `t` is reserved");
    clause("constraint c[i in 0..2] = q[i] - q[i + 1], «c» = x;", "the name `c` is declared twice");
    clause(
        "constraint c[i in 0..2] = q[i] - q[i + 1], «c»[1] = x;",
        "the constraint `c[1]` is declared twice\nhelp: rename one of them, or give it another index",
    );
    clause("«#»[inline] constraint c = x - y;", "this attribute has no meaning here");
    clause("«constrain» rod = x - y;", "unknown clause `constrain`\nhelp: write `constraint rod = x^2 + y^2 - l^2;`");
    clause("«constrant» rod = x - y;", "unknown clause `constrant`\nhelp: did you mean `constraint`?");
}

#[test]
fn constraints_without_motion() {
    let constant = "the constraint `c` contains no coordinate\nhelp: write an expression of coordinates that is 0";
    for written in ["l - 1", "3", "sin(t)", "l * t - 2", "x - x", "dot(x) - dot(x)"] {
        case(&format!("constraint «c» = {written}; {REST}"), constant);
    }
    clause("constraint «c»[i in 0..3] = l - i;", "the constraint `c[0]` contains no coordinate");
    clause("constraint «c» = [x - y, l];", "the constraint `c[1]` contains no coordinate");
    // Zero by an identity of functions.
    clause("constraint «c» = sin(x)^2 + cos(x)^2 - 1;", "the constraint `c` contains no coordinate");
    let plane = "param l = 1; coord x, y; L = dot(x)^2 + dot(y)^2 - l * y;";
    case(
        &format!("constraint a = x - l, «b» = y * x; {plane}"),
        "2 constraint(s) on 2 coordinate(s) leave no motion\nhelp: write fewer constraints than coordinates",
    );
    case(&format!("constraint «a» = [x - l, y * x, x + y]; {plane}"), "3 constraint(s) on 2 coordinate(s)");
    case("constraint «a» = x - 1; coord x; L = dot(x)^2;", "1 constraint(s) on 1 coordinate(s) leave no motion");
    // What follows from others leaves the motion that they leave.
    let space = "coord x, y, z; L = dot(x)^2 + dot(y)^2 + dot(z)^2;";
    let rolling = "constraint a = dot(x) - y * dot(z), b = dot(y) - x * dot(z)";
    case(
        &format!("{rolling}, «c» = dot(x) + dot(y) - (x + y) * dot(z); {space}"),
        "the constraint `c` follows from those before it\nhelp: remove it",
    );
    case(
        &format!("{rolling}, «c» = 2 * dot(x) - 2 * y * dot(z); {space}"),
        "the constraint `c` repeats `a` up to a factor\nhelp: remove it",
    );
    case(
        &format!("{rolling}, «c» = dot(x) - z * dot(y); {space}"),
        "3 constraint(s) on 3 coordinate(s) leave no motion",
    );
    // A frame of three bars.
    let bars = "coord x, y, u, w; L = dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2; constraint left = x^2 + y^2 - 1;";
    case(
        &format!(
            "param b = 2, c = 1; {bars} constraint right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2, \
             «brace» = u^2 + w^2 - 3 * c;"
        ),
        "4 constraint(s) on 4 coordinate(s) leave no motion",
    );
    // A third crank of a parallelogram follows from the others where they hold.
    let third = "constraint right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2, \
                 middle = ((x + u) / 2 - b / 2)^2 + ((y + w) / 2)^2 - c^2;";
    assert_eq!(errors(&format!("struct System {{ param b = 2, c = 1; {bars} {third} }}")), []);
    case(
        &format!("param b = 2, c = 1; {bars} {third} constraint «again» = 4 - 4 * x^2 - 4 * y^2;"),
        "the constraint `again` repeats `left` up to a factor",
    );
}

#[test]
fn a_planar_linkage_of_bodies_in_space_moves() {
    // Four hinges of five constraints, and three quaternions: 23 constraints on 21 coordinates, and one motion.
    let linkage = "param l[3] = [1.0, 3.0, 2.5], d = 3.2; coord x[3][3]; rotation R[3]; \
        let w[i in 0..3] = rate(R[i]); \
        L = sum(i in 0..3, dot(x[i]) * dot(x[i]) / 2 + w[i] * w[i] / 2 - x[i][1]); \
        let ez = [0, 0, 1], ex = [1, 0, 0], ey = [0, 1, 0]; \
        constraint pin_a = x[0] - turn(R[0], l[0] / 2 * ex); \
        constraint pin_b = x[0] + turn(R[0], l[0] / 2 * ex) - x[1] + turn(R[1], l[1] / 2 * ex); \
        constraint pin_c = x[1] + turn(R[1], l[1] / 2 * ex) - x[2] - turn(R[2], l[2] / 2 * ex); \
        constraint pin_d = x[2] - turn(R[2], l[2] / 2 * ex) - [d, 0, 0]; \
        constraint across_a = [ez * turn(R[0], ex), ez * turn(R[0], ey)]; \
        constraint across_b = [turn(R[0], ez) * turn(R[1], ex), turn(R[0], ez) * turn(R[1], ey)]; \
        constraint across_c = [turn(R[1], ez) * turn(R[2], ex), turn(R[1], ez) * turn(R[2], ey)]; \
        constraint across_d = [ez * turn(R[2], ex), ez * turn(R[2], ey)];";
    assert_eq!(errors(&format!("struct System {{ {linkage} }}")), []);
}

#[test]
fn constraints_that_depend_on_others() {
    let same = |lines: &str| {
        let message =
            "the constraint `b` repeats `a` up to a factor\nhelp: remove it: its reaction would have no unique";
        clause(lines, message);
    };
    same("constraint a = x^2 + y^2 - l^2, «b» = l^2 - x^2 - y^2;");
    same("constraint a = x - l * y; constraint «b» = m * x - m * l * y;");
    same("constraint a = x * dot(y) - y * dot(x), «b» = sin(z) * (y * dot(x) - x * dot(y));");
    same("constraint a = x + y, «b» = sqrt(x + y) - 0 * l;");
    // Of both kinds: `a` holds positions, `b` the same velocities with a factor.
    same("constraint «b» = (x * dot(x) + y * dot(y)) / y, a = x^2 + y^2 - l^2;");
    clause(
        "constraint a = x - y, b = y - z, «c» = z - x + l;",
        "the constraint `c` follows from those before it\nhelp: remove it",
    );
    clause(
        "constraint a[i in 0..3] = q[i] - q[i + 1], «b» = q[3] - q[0];",
        "the constraint `b` follows from those before",
    );
}

#[test]
fn velocities() {
    let linear = "a constraint must be linear in the velocities\nhelp: write terms `a * dot(x)`";
    for written in [
        "«dot»(x)^2 + y",
        "y * dot(x) - «dot»(x) * dot(y)",
        "x + z * dot(y) - «sin»(dot(x))",
        "«norm»(dot(q)) - l",
        "x * dot(y) - («dot»(z)^2 - l)",
        "[x - y, x * dot(y) - «abs»(dot(z))]",
        "-«dot»(x)^3",
        "«1» / dot(x)",
        "«sum»(i in 0..4, dot(q[i])^2)",
    ] {
        value(written, linear);
    }
    clause("let speed = dot(x)^2; constraint c = y - «speed»;", linear);
    clause("fn square(a) = a^2; constraint c = y - «square»(dot(x));", linear);
    clause("constraint c[i in 0..3] = q[i] * dot(x) - «dot»(q[i])^2;", linear);
    value("«dot»(dot(x)) + y", "an expression cannot depend on the acceleration `dot(dot(…))`");
    value("dot(«x» * dot(y))", "an expression cannot depend on the acceleration");
}

#[test]
fn derivatives_of_functions() {
    let derivative = |written: &str, function: &str, help: &str| {
        clause(
            &format!("constraint «c» = {written};"),
            &format!(
                "the constraint `c` is the time derivative of `{function}`\nhelp: constrain that, with its constant as a parameter: {help}"
            ),
        );
    };
    derivative("2 * x * dot(x) + 2 * y * dot(y)", "x^2 + y^2", "`constraint c = x^2 + y^2 - c0;`");
    derivative("dot(x^2 + y^2 - l)", "x^2 + y^2", "");
    derivative("dot(x) - l * dot(y)", "x - l*y", "");
    derivative("dot(x) - l", "x - l*t", "");
    derivative("y * dot(x) + x * dot(y)", "y*x", "");
    derivative("dot(x) * cos(x - l * y) - l * cos(x - l * y) * dot(y)", "sin(x - l*y)", "");
    derivative("dot(sqrt(x) * z^2)", "sqrt(x)*z^2", "");
    derivative("cos(m * t) * dot(x) - m * sin(m * t) * x", "cos(m*t)*x", "");
    // A velocity that an input prescribes has no such function.
    assert_eq!(errors(&format!("struct System {{ input u = 0; constraint c = dot(x) - u; {REST} }}")), []);
    derivative("dot(x) * exp(x * y) * y + dot(y) * exp(x * y) * x", "exp(x*y)", "");
    // Without a closed form, such as that of the length of a road, only the velocity can be constrained.
    let road = "constraint c = r * dot(y) + sqrt(1 + (a * k * sin(k * x))^2) * dot(x);";
    assert_eq!(errors(&format!("struct System {{ param r = 0.5, a = 0.3, k = 1.2; {road} {REST} }}")), []);
    clause(
        "constraint «c»[i in 0..1] = dot(q[i]) - i * dot(x);",
        "the constraint `c[0]` is the time derivative of `q[0]`",
    );
}

#[test]
fn uses_of_constraints() {
    clause(
        "constraint rod = x^2 + y^2 - l^2; force «rod» = 1;",
        "`rod` has a force but is a constraint\nhelp: a force acts on a coordinate: `force x = …;`; the reaction of `rod`",
    );
    let value = "`rod` is a constraint, not a number\nhelp: name its expression with `let`";
    clause("constraint rod = x^2 + y^2 - l^2; force x = -m * «rod»;", value);
    clause("constraint rod = x^2 + y^2 - l^2; let k = «rod»^2; force x = k;", value);
    clause("constraint rod = x^2 + y^2 - l^2; force x = dot(«rod»);", value);
    clause("constraint rod[i in 0..2] = q[i] - x; force x = «rod»[0];", value);
    let reaction =
        "an expression cannot contain a reaction\nhelp: friction that depends on a reaction is not supported";
    clause("constraint rod = x^2 + y^2 - l^2; force x = -«reaction»(rod) * dot(x);", reaction);
    case("coord x, y; constraint rod = x - y^2; L = dot(x)^2 + dot(y)^2 - «reaction»(rod);", reaction);
    let clauses = [
        ("«discretize» midpoint;", "discretize", "remove it: `Gauss::<1>` is the midpoint rule with constraints"),
        ("time_scale = x^2;", "time_scale", "remove it; `Gauss` takes steps in t"),
    ];
    for (written, word, help) in clauses {
        let marked = match word {
            "discretize" => "discretize «midpoint»;".to_owned(),
            word => written.replacen(word, &format!("«{word}»"), 1),
        };
        clause(
            &format!("{marked} constraint rod = x^2 + y^2 - l^2;"),
            &format!("`{word}` is not supported with constraints\nhelp: {help}"),
        );
    }
    clause(
        "discretize { «Ld» = h * L(t0, q0, (q1 - q0) / h); } constraint rod = x - y^2;",
        "`discretize` is not supported with constraints",
    );
    clause("discretize «gauss»; constraint rod = x - y^2;", "`discretize` is not supported with constraints");
}

#[test]
fn masses() {
    let singular = "the mass matrix ∂²L/∂v² is singular for every state";
    // The constraint determines z, and the whole is regular.
    for lines in [
        "constraint c = z - x * y;",
        "constraint c = z - x^2, d = q[1] * dot(z) - x * dot(y);",
        "constraint c = dot(z) * x - dot(y) * q[0];",
    ] {
        let text = format!("coord x, y, z, q[2]; {lines} L = dot(x)^2 + dot(y)^2 + dot(q) * dot(q) - z;");
        assert_eq!(errors(&format!("struct System {{ {text} }}")), [], "{text}");
    }
    case(
        "coord x, y, «z»; constraint c = x - y^2; L = dot(x)^2 + dot(y)^2 - z;",
        &format!("{singular}\nhelp: `z` has no kinetic energy"),
    );
    let allowed =
        format!("{singular}, in a direction that the constraints allow\nhelp: a motion of `x` has no kinetic energy");
    case("coord «x», y, z; constraint c = x + y - z^2; L = (dot(x) + dot(y))^2 + dot(z)^2;", &allowed);
    case("coord «x», y, z; constraint c = dot(z) * x; L = (dot(x) + dot(y))^2 + dot(z)^2;", &allowed);
    case(
        "coord y, z, «x»; constraint c = y - z; L = dot(y)^2 + dot(x) * sin(y);",
        &format!("{singular}\nhelp: `dot(x)` appears"),
    );
    case(
        "coord x, y, «λ»; constraint c = x; L = dot(x)^2 + dot(y)^2 + λ * y;",
        &format!("{singular}\nhelp: `λ` multiplies"),
    );
}

#[test]
fn parameters_and_functions_of_constraints_are_used() {
    let text = "struct System { param a = 1, b[2] = 1; fn s(u) = u^2; coord x, y; let r = s(x) + s(y); \
                constraint c = r - a^2 + b[1]; L = dot(x)^2 + dot(y)^2 - y; }";
    assert_eq!(errors(text), []);
    case(
        "param «a» = 1; coord x, y; constraint c = x - y^2; L = dot(x)^2 + dot(y)^2;",
        "the parameter `a` is never used",
    );
}

#[test]
fn jumps_and_kinks() {
    clause(
        "constraint «c» = y - if x > 0 { x } else { 1 };",
        "the constraint `c` has a jump or a kink where `x` is zero\nhelp: velocities would jump there",
    );
    for kink in ["max(x, 0)", "abs(x)", "abs(x) + x", "sin(y) * sign(x)"] {
        let text = format!("constraint «c» = y - {kink};");
        clause(&text, "the constraint `c` has a jump or a kink where `x` is zero");
    }
    clause("constraint «c» = dot(x) * z - sign(x) * dot(y);", "the constraint `c` has a jump or a kink where `x` is");
    // Not the derivative of x − sign(z) y.
    clause("constraint «c» = dot(x) - sign(z) * dot(y);", "the constraint `c` has a jump or a kink where `z` is zero");
    clause("constraint «c» = dot(x) - if z > l { 2 } else { 1 };", "the constraint `c` has a jump or a kink");
    clause(
        "constraint «c» = dot(x) * z - if x > l { 1 } else { 2 } * dot(y);",
        "the constraint `c` has a jump or a kink",
    );
    clause(
        "table hill(s) = [(0, 0), (1, 1), (2, 0)] linear; constraint «c» = y - hill(x);",
        "the constraint `c` has a kink at each place of the linear table `hill`\nhelp: velocities would jump",
    );
    for smooth in ["y - max(x, 0)^2", "y - abs(x)^3", "y - hill(x)", "dot(y) * z - abs(x) * dot(x)"] {
        let text = format!(
            "struct System {{ table hill(s) = [(0, 0), (1, 1), (2, 0)]; constraint c = {smooth}; force x = hill(x); {REST} }}"
        );
        assert_eq!(errors(&text), [], "{smooth}");
    }
}

#[test]
fn angles_and_derivatives() {
    case(
        "angle θ; coord x; constraint «roll» = x - θ^2; L = dot(x)^2 + dot(θ)^2;",
        "the constraint `roll` is not periodic in the angle `θ`",
    );
    case(
        "angle θ, φ; coord x; constraint «gear»[i in 0..1] = sin(θ) - φ * x; L = dot(x)^2 + dot(θ)^2 + dot(φ)^2;",
        "the constraint `gear` is not periodic in the angle `φ`",
    );
    let text = "struct System { angle θ; coord x, y; constraint blade = sin(θ) * dot(x) - cos(θ) * dot(y); \
                L = dot(x)^2 + dot(y)^2 + dot(θ)^2; }";
    assert_eq!(errors(text), []);
    // A wheel that rolls, modulo its turns.
    assert_eq!(
        errors("struct System { angle θ; coord x; constraint roll = x - 0.3 * θ; L = dot(x)^2 + dot(θ)^2; }"),
        []
    );
    clause("constraint «c» = 0^x - y;", "`pow(0, x) - y` has no derivative with respect to `a coordinate or the time`");
    clause("constraint c = «ln»(-1) * x;", "this expression has no value");
}

#[test]
fn rotations() {
    let rest = "coord x; rotation R, S[2]; L = dot(x)^2 + rate(R) * rate(R) + rate(S[0]) * rate(S[0]) + rate(S[1]) * rate(S[1]);";
    let clause = |clause: &str, message: &str| case(&format!("{clause} {rest}"), message);
    clause("rotation Q «=» 1;", "a coordinate is declared without a value");
    clause("rotation Q[«0»];", "an array cannot have 0 coordinates");
    clause("rotation Q[«65»];", "an array cannot have 65 coordinates");
    clause(
        "torque «x» = [1, 2, 3];",
        "`x` has a torque but is not a rotation\nhelp: a torque acts on a body that `rotation R;`",
    );
    clause("space_torque «Q» = [1, 2, 3];", "`Q` has a torque but is not a rotation");
    clause("torque R = «[»1, 2];", "a vector of 3 is needed here, not a vector of 2");
    clause("torque R = «x»;", "a vector of 3 is needed here, not a number");
    clause("torque «S» = [1, 2, 3];", "`S` is an array of rotations\nhelp: write `torque S[i in 0..8] = [a, b, c];`");
    clause("torque R = [1, 2, 3], «R» = [1, 2, 3];", "a second torque on `R`");
    clause("torque S[«2»] = [1, 2, 3];", "`S[2]` is out of range 0..2");
    clause("constraint «R» = x;", "this constraint has no name");
    clause("constraint «c» = R * R - 1;", "the constraint `c` repeats `R` up to a factor");
    clause("force x = «rate»(x) * [1, 0, 0];", "`rate` takes a rotation, not a number\nhelp: declare `rotation R;`");
    clause(
        "force x = «turn»(R, [1, 2]) * [1, 0, 0];",
        "`turn` takes a rotation and a vector of 3, not a vector of 4 and a vector of 2",
    );
    clause("force x = «turn»(R) * [1, 0, 0];", "`turn` takes 2 arguments, not 1");
    clause("force x = «spin»(S) * [1, 0, 0];", "`spin` takes a rotation, not a 2 × 4 matrix");
    // No inertia at all.
    case("coord x; rotation «R»; L = dot(x)^2 - R[1];", "the mass matrix ∂²L/∂v² is singular for every state");
    // The names of the functions and clauses are free.
    let text = "struct System { param rate = 1, spin = 2, turn = 3, torque = 4, rotation = 5, constraint = 6; coord x; \
                L = dot(x)^2 - rate * spin * turn * torque * rotation * constraint * x; }";
    assert_eq!(errors(text), []);
}
