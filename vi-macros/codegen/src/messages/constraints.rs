//! Mistakes with constraints and rotations.

/// Help for a constraint without a name, or in another notation.
pub(crate) const NAMED: &str = "write `constraint rod = x^2 + y^2 - l^2;`: the expression is 0, and `rod` names the constraint and its \
    reaction";

catalogue! {
    /// A mistake with constraints.
    ConstraintMistake:

    NoName = "this constraint has no name", { NAMED.to_owned() },
        ["constraint «=» x^2 + y^2 - l^2;", "constraint «x»^2 + y^2 - l^2;", "constraint «x»^2 = 1;",
         "constraint «2» * x - y;", "constraint «(»x - y);", "constraint «sqrt»(x) = 1;", "constraint «x» = y;",
         "constraint «q»[0] = y;", "constraint «q»[i in 0..4] = x - q[i];", "constraint «x» == y;",
         "constraint «c» += x;", "rotation R, S[2]; constraint «R» = x;"];
    Equation =
        "a constraint is one expression, which is 0",
        "write the difference of both sides, as in `constraint rod = x^2 + y^2 - l^2;`",
        ["constraint c = x^2 + y^2 «=» l^2;", "constraint c = x «=»= y;", "constraint c = x «!»= 0;"];
    Colon { name: String } =
        "a colon does not define a constraint",
        "write `constraint {name} = x^2 + y^2 - l^2;`: the difference of both sides, which is 0";
    Inequality =
        "inequalities are not supported as constraints",
        "a constraint is an expression that is 0; write a stiff spring for a stop, `L = … - k * max(-y, 0)^2 / 2;`, model an impact by an \
         event with `set_state`, or give a bound of optimal control to `vi.optimise`",
        ["constraint c = y «>» 0;", "constraint c = y «<»= x;"];
    Twice { name: String } =
        "the constraint `{name}` is declared twice", "rename one of them, or give it another index",
        ["constraint c[i in 0..2] = q[i] - q[i + 1], «c»[1] = x;"] { name: "c[1]" };
    Constant { name: String } =
        "the constraint `{name}` contains no coordinate",
        "write an expression of coordinates that is 0, as in `constraint rod = x^2 + y^2 - l^2;`",
        ["constraint «c» = l - 1;", "constraint «c» = 3;", "constraint «c» = sin(t);", "constraint «c» = l * t - 2;",
         "constraint «c» = x - x;", "constraint «c» = dot(x) - dot(x);", "constraint «c» = sin(x)^2 + cos(x)^2 - 1;"]
            { name: "c" },
        ["constraint «c»[i in 0..3] = l - i;"] { name: "c[0]" }, ["constraint «c» = [x - y, l];"] { name: "c[1]" };
    TooMany { count: usize, size: usize } =
        "{count} constraint(s) on {size} coordinate(s) leave no motion",
        "write fewer constraints than coordinates, or defaults of the parameters with which the mechanism moves",
        ["constraint a = x - l, «b» = y * x; param l = 1; coord x, y; L = dot(x)^2 + dot(y)^2 - l * y;"]
            { count: 2, size: 2 },
        ["constraint «a» = [x - l, y * x, x + y]; param l = 1; coord x, y; L = dot(x)^2 + dot(y)^2 - l * y;"]
            { count: 3, size: 2 },
        ["constraint «a» = x - 1; coord x; L = dot(x)^2;"] { count: 1, size: 1 },
        ["constraint a = dot(x) - y * dot(z), b = dot(y) - x * dot(z), «c» = dot(x) - z * dot(y); coord x, y, z; L = dot(x)^2 + dot(y)^2 + dot(z)^2;"]
            { count: 3, size: 3 },
        ["param b = 2, c = 1; coord x, y, u, w; L = dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2; constraint left = x^2 + y^2 - 1; constraint right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2, «brace» = u^2 + w^2 - 3 * c;"]
            { count: 4, size: 4 };
    Same { name: String, other: String } =
        "the constraint `{name}` repeats `{other}` up to a factor", "remove it: its reaction would have no unique value",
        ["constraint a = x^2 + y^2 - l^2, «b» = l^2 - x^2 - y^2;",
         "constraint a = x - l * y; constraint «b» = m * x - m * l * y;",
         "constraint a = x * dot(y) - y * dot(x), «b» = sin(z) * (y * dot(x) - x * dot(y));",
         "constraint a = x + y, «b» = sqrt(x + y) - 0 * l;",
         "constraint «b» = (x * dot(x) + y * dot(y)) / y, a = x^2 + y^2 - l^2;"] { name: "b", other: "a" },
        ["constraint a = dot(x) - y * dot(z), b = dot(y) - x * dot(z), «c» = 2 * dot(x) - 2 * y * dot(z);"]
            { name: "c", other: "a" },
        ["param b = 2, c = 1; coord x, y, u, w; L = dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2; constraint left = x^2 + y^2 - 1; constraint right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2, middle = ((x + u) / 2 - b / 2)^2 + ((y + w) / 2)^2 - c^2; constraint «again» = 4 - 4 * x^2 - 4 * y^2;"]
            { name: "again", other: "left" },
        ["rotation R, S[2]; constraint «c» = R * R - 1;"] { name: "c", other: "R" };
    Dependent { name: String } =
        "the constraint `{name}` follows from those before it", "remove it: its reaction would have no unique value",
        ["constraint a = x - y, b = y - z, «c» = z - x + l;",
         "constraint a = dot(x) - y * dot(z), b = dot(y) - x * dot(z), «c» = dot(x) + dot(y) - (x + y) * dot(z);"]
            { name: "c" },
        ["constraint a[i in 0..2] = q[i] - q[i + 1], «b» = q[2] - q[0];"] { name: "b" };
    Nonlinear =
        "a constraint must be linear in the velocities",
        "write terms `a * dot(x)`; constraints with powers, functions or products of velocities are not supported",
        ["constraint c = «dot»(x)^2 + y;", "constraint c = y * dot(x) - «dot»(x) * dot(y);",
         "constraint c = x + z * dot(y) - «sin»(dot(x));", "constraint c = «norm»(dot(q)) - l;",
         "constraint c = x * dot(y) - («dot»(z)^2 - l);", "constraint c = [x - y, x * dot(y) - «abs»(dot(z))];",
         "constraint c = -«dot»(x)^3;", "constraint c = «1» / dot(x);",
         "constraint c = «sum»(i in 0..3, dot(q[i])^2);", "let speed = dot(x)^2; constraint c = y - «speed»;",
         "fn square(a) = a^2; constraint c = y - «square»(dot(x));",
         "constraint c[i in 0..3] = q[i] * dot(x) - «dot»(q[i])^2;"];
    Integrable { name: String, function: String } =
        "the constraint `{name}` is the time derivative of `{function}`",
        "constrain that, with its constant as a parameter: `constraint {name} = {function} - c0;`; a constraint on its velocity would \
         drift",
        ["constraint «c» = 2 * x * dot(x) + 2 * y * dot(y);", "constraint «c» = dot(x^2 + y^2 - l);"]
            { name: "c", function: "x^2 + y^2" },
        ["constraint «c» = dot(x) - l * dot(y);"] { name: "c", function: "x - l*y" },
        ["constraint «c» = dot(x) - l;"] { name: "c", function: "x - l*t" },
        ["constraint «c» = y * dot(x) + x * dot(y);"] { name: "c", function: "x*y" },
        ["constraint «c» = dot(x) * cos(x - l * y) - l * cos(x - l * y) * dot(y);"]
            { name: "c", function: "sin(x - l*y)" },
        ["constraint «c» = dot(sqrt(x) * z^2);"] { name: "c", function: "sqrt(x)*z^2" },
        ["constraint «c» = cos(m * t) * dot(x) - m * sin(m * t) * x;"] { name: "c", function: "x*cos(m*t)" },
        ["constraint «c» = dot(x) * exp(x * y) * y + dot(y) * exp(x * y) * x;"] { name: "c", function: "exp(x*y)" },
        ["constraint «c»[i in 0..1] = dot(q[i]) - i * dot(x);"] { name: "c[0]", function: "q[0]" };
    Jump { name: String, condition: String } =
        "the constraint `{name}` has a jump or a kink where `{condition}` is zero",
        "velocities would jump there: make both expressions and their derivatives equal where the condition changes",
        ["constraint «c» = y - if x > 0 { x } else { 1 };", "constraint «c» = y - max(x, 0);",
         "constraint «c» = y - abs(x);", "constraint «c» = y - abs(x) + x;", "constraint «c» = y - sin(y) * sign(x);",
         "constraint «c» = dot(x) * z - sign(x) * dot(y);"] { name: "c", condition: "x" },
        ["constraint «c» = dot(x) - sign(z) * dot(y);"] { name: "c", condition: "z" },
        ["constraint «c» = dot(x) - if z > l { 2 } else { 1 };"] { name: "c", condition: "z - l" },
        ["constraint «c» = dot(x) * z - if x > l { 1 } else { 2 } * dot(y);"] { name: "c", condition: "x - l" };
    LinearTable { name: String, table: String } =
        "the constraint `{name}` has a kink at each place of the linear table `{table}`",
        "velocities would jump there: make the table `cubic` or `monotone`",
        ["table hill(s) = [(0, 0), (1, 1), (2, 0)] linear; constraint «c» = y - hill(x);"] { name: "c", table: "hill" };
    Force { name: String } =
        "`{name}` has a force but is a constraint",
        "a force acts on a coordinate: `force x = …;`; the reaction of `{name}` follows from the motion",
        ["constraint rod = x^2 + y^2 - l^2; force «rod» = 1;"] { name: "rod" };
    ForceOnRotation { name: String } =
        "`{name}` is a rotation of four components, and this force has three",
        "write `torque {name} = [a, b, c];` for a torque in the axes of the body, `space_torque {name} = [a, b, c];` in the axes of space";
    Value { name: String } =
        "`{name}` is a constraint, not a number",
        "name its expression with `let`, and use that name in both places; its reaction is known after a step only, so friction that \
         depends on it is not supported",
        ["constraint rod = x^2 + y^2 - l^2; force x = -m * «rod»;",
         "constraint rod = x^2 + y^2 - l^2; let k = «rod»^2; force x = k;",
         "constraint rod = x^2 + y^2 - l^2; force x = dot(«rod»);",
         "constraint rod[i in 0..2] = q[i] - x; force x = «rod»[0];"] { name: "rod" };
    Reaction =
        "an expression cannot contain a reaction",
        "friction that depends on a reaction is not supported; a run computes reactions at its states and for events",
        ["constraint rod = x^2 + y^2 - l^2; force x = -«reaction»(rod) * dot(x);",
         "coord x, y; constraint rod = x - y^2; L = dot(x)^2 + dot(y)^2 - «reaction»(rod);"];
    Torque { name: String } =
        "`{name}` has a torque but is not a rotation",
        "a torque acts on a body that `rotation R;` declares; write `force θ = …;` for a coordinate",
        ["rotation R, S[2]; torque «x» = [1, 2, 3];"] { name: "x" },
        ["rotation R, S[2]; space_torque «Q» = [1, 2, 3];"] { name: "Q" };
    TorqueIndex { name: String } =
        "`{name}` is an array of rotations",
        "write `torque {name}[i in 0..8] = [a, b, c];` or `torque {name}[0] = [a, b, c];`",
        ["rotation R, S[2]; torque «S» = [1, 2, 3];"] { name: "S" };
    SecondTorque { name: String } = "a second torque on `{name}`", "add them up in one line",
        ["rotation R, S[2]; torque R = [1, 2, 3], «R» = [1, 2, 3];"] { name: "R" };
    Clause { clause: &'static str } =
        "`{clause}` is not supported with constraints",
        {
            match *clause {
                "discretize" => "remove it: `Gauss::<1>` is the midpoint rule with constraints, `Gauss::<3>` has order 6",
                _ => "remove it; `Gauss` takes steps in t",
            }
            .to_owned()
        },
        ["discretize «midpoint»; constraint rod = x^2 + y^2 - l^2;",
         "discretize { «Ld» = h * L(t0, q0, (q1 - q0) / h); } constraint rod = x - y^2;",
         "discretize «gauss»; constraint rod = x - y^2;"] { clause: "discretize" },
        ["«time_scale» = x^2; constraint rod = x^2 + y^2 - l^2;"] { clause: "time_scale" };
}
