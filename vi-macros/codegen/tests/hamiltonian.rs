//! Systems by H beside the same systems by L: equal functions, and no more operations than the table allows.

use proc_macro2::TokenStream;
use std::collections::BTreeSet;
use vi_codegen::program::{Function, FunctionId};
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::{Compiled, Derivations, inspect, syntax::parse};

/// The operations of the equations of motion at a point, and of those of a midpoint step.
type Counts = [usize; 2];

/// A name, declarations, the lines of H, the lines of L, and their operations.
const PAIRS: [(&str, &str, &str, &str, [Counts; 2]); 14] = [
    (
        "polar coordinates",
        "param m = 1.3, k = 2.0, c = 0.1; coord r, a;",
        "momentum p of r, l of a; H = p^2/(2*m) + l^2/(2*m*r^2) + k*(r - 1)^2/2; force r = -c*p/m;",
        "L = m*(dot(r)^2 + r^2*dot(a)^2)/2 - k*(r - 1)^2/2; force r = -c*dot(r);",
        [[12, 36], [12, 36]],
    ),
    (
        "double pendulum",
        "param m = 1.3, M = 0.7, l = 1.1, d = 0.6, g = 9.8; angle a, b;",
        "momentum p of a, q of b;
         let V = -(m + M)*g*l*cos(a) - M*g*d*cos(b);
         H = (M*d^2*p^2 + (m + M)*l^2*q^2 - 2*M*l*d*p*q*cos(a - b)) / (2*M*l^2*d^2*(m + M*sin(a - b)^2)) + V;",
        "L = (m + M)*l^2*dot(a)^2/2 + M*d^2*dot(b)^2/2 + M*l*d*dot(a)*dot(b)*cos(a - b)
            + (m + M)*g*l*cos(a) + M*g*d*cos(b);",
        [[36, 77], [37, 75]],
    ),
    (
        "magnetic field",
        "param m = 1.3, e = 0.7, B = 1.1; coord r[3]; let A = [-B*r[1]/2, B*r[0]/2, 0], phi = 1/norm(r);",
        "momentum p of r; H = (p - e*A)*(p - e*A)/(2*m) + e*phi;",
        "L = m*dot(r)*dot(r)/2 + e*A*dot(r) - e*phi;",
        [[31, 90], [31, 90]],
    ),
    (
        "magnetic field, multiplied out",
        "param m = 1.3, e = 0.7, B = 1.1; coord x, y;",
        "momentum p of x, q of y; H = (p^2 + q^2)/(2*m) + e*B*(p*y - q*x)/(2*m) + e^2*B^2*(x^2 + y^2)/(8*m);",
        "L = m*(dot(x)^2 + dot(y)^2)/2 + e*B*(x*dot(y) - y*dot(x))/2;",
        [[14, 28], [14, 28]],
    ),
    (
        "rotating frame",
        "param m = 1.3, w = 0.7; coord x, y;",
        "momentum p of x, q of y; H = (p^2 + q^2)/(2*m) + w*(p*y - q*x) - 1/hypot(x, y);",
        "L = m*((dot(x) - w*y)^2 + (dot(y) + w*x)^2)/2 + 1/hypot(x, y);",
        [[20, 62], [26, 69]],
    ),
    (
        "mass that varies in time",
        "param w = 0.7; coord x, y; let m = 2 + sin(w*t);",
        "momentum p of x, q of y; H = p^2/(2*m) + q^2/2 + x*q*cos(t) + x^2*y^2;",
        "L = m*dot(x)^2/2 + (dot(y) - x*cos(t))^2/2 - x^2*y^2;",
        [[18, 47], [17, 49]],
    ),
    (
        "bodies",
        "const N = 3; param m[N] = [1.0, 0.5, 0.1], G = 1.0; coord r[N][3];
         let V = -sum(i in 0..N, j in 0..i, G*m[i]*m[j]/norm(r[i] - r[j]));",
        "momentum p of r; H = sum(i in 0..N, p[i]*p[i]/(2*m[i])) + V;",
        "let v = dot(r); L = sum(i in 0..N, m[i]*v[i]*v[i])/2 - V;",
        [[99, 456], [99, 456]],
    ),
    (
        "bodies in a rotating frame",
        "param m = 1.3, w = 0.7; coord r[2][2]; let V = -m/norm(r[1] - r[0]);",
        "momentum p of r; H = sum(i in 0..2, p[i]*p[i]/(2*m) + w*cross(p[i], r[i])) + V;",
        "let v[i in 0..2] = dot(r[i]) + w*[-r[i][1], r[i][0]]; L = sum(i in 0..2, m*v[i]*v[i]/2) - V;",
        [[47, 151], [55, 159]],
    ),
    (
        "momenta coupled near a point",
        "param m = 1.3; coord x, y; let d = 1 + (x - 1)^2;",
        "momentum p of x, q of y; H = (d*p^2 - 2*m*p*q + 2*d*q^2)/(2*(2*d^2 - m^2)) + x*y;",
        "L = d*dot(x)^2 + m*dot(x)*dot(y) + d*dot(y)^2/2 - x*y;",
        [[19, 47], [19, 47]],
    ),
    (
        "symmetric top",
        "param I = 1.3, J = 0.7, w = 2.0; coord phi, theta, psi;",
        "momentum a of phi, b of theta, c of psi;
         H = b^2/(2*I) + (a - c*cos(theta))^2/(2*I*sin(theta)^2) + c^2/(2*J) + w*cos(theta);",
        "L = I*(dot(theta)^2 + dot(phi)^2*sin(theta)^2)/2 + J*(dot(psi) + dot(phi)*cos(theta))^2/2 - w*cos(theta);",
        [[25, 61], [21, 58]],
    ),
    (
        "numbers that couple five momenta",
        "param m = 1.3; coord q[5];",
        "momentum p of q; H = (sum(i in 0..5, p[i])^2 + p*p)/(2*m) + q*q;",
        "let v = dot(q); L = m*(v*v - (sum(i in 0..5, v[i]))^2/6)/2 - q*q;",
        [[45, 74], [43, 72]],
    ),
    (
        "relativistic particle in a field",
        "param m = 1.3, c = 3.0, e = 0.7, B = 1.1; coord r[2]; let A = [-B*r[1]/2, B*r[0]/2];",
        "momentum p of r; H = c*sqrt(m^2*c^2 + (p - e*A)*(p - e*A)) + r[0]^2;",
        "L = -c*sqrt(m^2*c^2 - m^2*dot(r)*dot(r)) + e*A*dot(r) - r[0]^2;",
        [[44, 64], [44, 64]],
    ),
    (
        "reduced mass, cubic surface",
        "param m = 1.3, M = 0.7; coord x, y; let g = 3*x^2;",
        "momentum p of x, q of y; H = (1/m + 1/M)*q^2/2 + p^2/(2*m*(1 + g^2)) + x^3;",
        "L = m*M/(m + M)*dot(y)^2/2 + m*(1 + g^2)*dot(x)^2/2 - x^3;",
        [[17, 37], [17, 37]],
    ),
    (
        "three coupled momenta",
        "param a = 1.3, b = 2.7; coord x, y, z; let D = a*b^2 - a*cos(x)^2 - b*y^2;",
        "momentum p of x, q of y, s of z;
         H = ((b^2 - cos(x)^2)*p^2 + (a*b - y^2)*s^2 + a*b*q^2 + 2*(cos(x)*y*p*s - b*y*p*q - a*cos(x)*q*s))/(2*D);",
        "L = a*dot(x)^2/2 + b*dot(y)^2/2 + b*dot(z)^2/2 + y*dot(x)*dot(y) + cos(x)*dot(y)*dot(z);",
        [[17, 44], [17, 44]],
    ),
];

fn derived(clauses: &str, lines: &str) -> Derivations {
    derived_freely(clauses, &format!("{lines} discretize midpoint;"))
}

/// The same without a rule.
fn derived_freely(clauses: &str, lines: &str) -> Derivations {
    let tokens: TokenStream = format!("struct System {{ {clauses} {lines} }}").parse().expect("tokens");
    let system = parse::system(tokens).unwrap_or_else(|error| panic!("{lines}: {error}"));
    vi_codegen::derive(&system).unwrap_or_else(|error| panic!("{lines}: {error}"))
}

/// The value of a symbol at a point: the default of a parameter.
fn number(of: &Derivations, symbol: &Symbol, point: f64) -> f64 {
    let place = |index: usize| u32::try_from(index).map_or(0.0, f64::from);
    match symbol {
        Symbol::Parameter { index, .. } => of.own.model.parameters[*index].default,
        Symbol::Continuous(Variable::Coordinate(index)) => 0.5 * (1.7 * place(*index) + 0.9 * point).sin(),
        Symbol::Continuous(Variable::Velocity(index)) => 0.5 * (2.3 * place(*index) - 0.7 * point).cos(),
        _ => point,
    }
}

/// L, L_v and the force at a point.
fn values(of: &Derivations, point: f64) -> Vec<f64> {
    let functions = [FunctionId::Lagrangian, FunctionId::Momentum, FunctionId::Force];
    let functions = functions.iter().filter_map(|id| of.own.program.function(*id));
    let values: Vec<f64> =
        functions.flat_map(|function| function.evaluate(&mut |symbol| number(of, symbol, point))).collect();
    assert!(values.len() > of.own.model.dimension() * if of.own.model.forced { 2 } else { 1 });
    values
}

/// The largest difference of two systems in [`values`] at some points, relative to 1 + their size.
fn difference(left: &Derivations, right: &Derivations) -> f64 {
    let at = |point: f64| {
        let (left, right) = (values(left, point), values(right, point));
        assert_eq!(left.len(), right.len());
        left.into_iter().zip(right).map(|(left, right)| (left - right).abs() / (1.0 + right.abs())).fold(0.0, f64::max)
    };
    [0.1, 1.1, 2.1, 3.1, 4.1].map(at).into_iter().fold(0.0, f64::max)
}

#[test]
fn h_and_l_are_the_same_system() {
    for (name, clauses, h, l, _) in PAIRS {
        let [by_h, by_l] = [h, l].map(|lines| derived(clauses, lines));
        let difference = difference(&by_h, &by_l);
        assert!(difference < 2e-15, "{name}: {difference:e}");
    }
}

#[test]
fn h_costs_about_as_much_as_l() {
    let counts = |of: &Derivations| {
        let operations = |id| of.own.program.function(id).map_or(0, Function::operation_count);
        [FunctionId::Point, FunctionId::MomentumEquation].map(operations)
    };
    for (name, clauses, h, l, pinned) in PAIRS {
        let [by_h, by_l] = [h, l].map(|lines| counts(&derived(clauses, lines)));
        assert_eq!([by_h, by_l], pinned, "{name}");
    }
}

#[test]
fn a_root_of_either_sign_is_transformed() {
    // By hand: v = p/√(p² + k), so that L = v p − √(p² + k) = −k/√(p² + k) with p² + k = k/(1 − v²).
    for (k, v) in [(1.0_f64, 0.5_f64), (-1.0, 1.5)] {
        let of = derived(&format!("param k = {k}; coord x;"), "momentum p of x; H = sqrt(p^2 + k) + x;");
        let function = of.own.program.function(FunctionId::Lagrangian).expect("every function is there");
        let found = function.evaluate(&mut |symbol| match symbol {
            Symbol::Parameter { .. } => k,
            Symbol::Continuous(Variable::Velocity(_)) => v,
            _ => 0.0,
        });
        let wanted = -k / (k / (1.0 - v * v)).sqrt();
        assert!((found[0] - wanted).abs() < 1e-15, "{} instead of {wanted}", found[0]);
    }
}

#[test]
fn a_sum_of_kinetic_and_potential_energy_splits() {
    let findings = |lines: &str| {
        let of = derived("param m = 2; const k = 3; coord x, y[2];", lines).own.findings;
        (of.force_of_position, of.constant_mass)
    };
    let momenta = "momentum p of x, l of y;";
    assert_eq!(findings(&format!("{momenta} H = p^2/(2*m) + l*l/k + cos(x)*y[0]*t;")), (true, true));
    assert_eq!(findings(&format!("{momenta} H = p^2/(2*m) + p*l[0]/9 + l*l/k + x*y*y; force x = m;")), (true, true));
    assert_eq!(findings(&format!("{momenta} H = p^2/(2*m) + l*l/k + x*l[0];")), (false, true));
    assert_eq!(findings(&format!("{momenta} H = p^2/(2*m) + l*l/(k + x^2);")), (false, false));
}

#[test]
fn a_momentum_is_a_name_for_the_derivative_of_l() {
    let [by_h, by_l] = [
        "momentum p of x, l of y; let u = p*x, w[i in 0..2] = l[i]/2; H = p^2/(2*m) + l*l + x*l[0] + u;
         force x = -p*m + w[1]; dissipation = p^2 + w[0]^2; constraint c = l[1] - p;",
        "let p = m*(dot(x) - x), l = [dot(y[0])/2 - x/2, dot(y[1])/2]; L = m*(dot(x) - x)^2/2 + (dot(y[0]) - x)^2/4 + dot(y[1])^2/4;
         force x = -p*m + l[1]/2; dissipation = p^2 + l[0]^2/4; constraint c = l[1] - p;",
    ]
    .map(|lines| derived_freely("param m = 2; coord x, y[2];", lines));
    let difference = difference(&by_h, &by_l);
    assert!(difference < 2e-15, "{difference:e}");
    let constraint = |of: &Derivations| {
        let value = of.own.model.constraints[0].value;
        of.own.pool.evaluate(value, &mut |symbol| number(of, symbol, 0.1)).to_bits()
    };
    assert_eq!(constraint(&by_h), constraint(&by_l));
}

#[test]
fn large_systems_keep_their_loops() {
    let compiled = |lines: &str| {
        let text = format!(
            "#[vi_limit(0)] struct Bodies {{ const N = 5; param G = 1.5, m[N] = [1, 2, 3, 4, 5]; coord r[N][2], s[N];
             let far[i in 0..N] = r[i] * r[i]; {lines} }}"
        );
        let tokens: TokenStream = text.parse().expect("tokens");
        let explained = inspect::explain(tokens.clone()).unwrap_or_else(|error| panic!("{lines}: {error}")).text();
        let system = parse::system(tokens).expect("a right system");
        let is_loops = matches!(Compiled::of(&system), Ok(Compiled::Loops(_)));
        assert!(is_loops, "{explained}");
        explained
    };
    let potential = "sum(i in 0..N, j in 0..i, G*m[i]*m[j]/norm(r[i] - r[j])) - sum(i in 0..N, far[i])";
    let by_h = compiled(&format!(
        "momentum p of r, l of s; let T[i in 0..N] = p[i]*p[i]/(2*m[i]) + l[i]^2/2;
         H = sum(i in 0..N, T[i] + m[i]*s[i]*l[i]) - ({potential}); force s[i in 0..N] = -l[i];"
    ));
    let by_l = compiled(&format!(
        "let v = dot(r), l[i in 0..N] = dot(s[i]) - m[i]*s[i];
         L = sum(i in 0..N, m[i]*v[i]*v[i]/2 + dot(s[i])^2/2 - m[i]*s[i]*dot(s[i]) + m[i]^2*s[i]^2/2) + {potential};
         force s[i in 0..N] = -l[i];"
    ));
    let loops = |text: &str| {
        let lines = text.lines().filter_map(|line| line.trim().strip_prefix("L_"));
        lines.map(|line| line.split_once(" = ").map_or("", |(_, sum)| sum).to_owned()).collect::<BTreeSet<_>>()
    };
    let (by_h, by_l) = (loops(&by_h), loops(&by_l));
    // The order of the factors of one term differs.
    assert_eq!(by_h.len(), 6);
    assert_eq!(by_h.intersection(&by_l).count(), 5, "{by_h:#?} {by_l:#?}");
}
