//! Systems by H: the steps of the same systems by L, and of the compiled ones.

use vi_core::lagrangian;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_erased::{System, kind};
use vi_tape::expressions::{Moment, Observable};

lagrangian! {
    /// Pendulum on a spring, in polar coordinates.
    struct Elastic {
        param m = 1.3, k = 20.0, g = 9.81, c = 0.1;
        coord r;
        angle a;
        momentum p of r, l of a;
        H = p^2/(2*m) + l^2/(2*m*r^2) + k*(r - 1)^2/2 - m*g*r*cos(a);
        force r = -c*p/m;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two particles in a magnetic field.
    struct Charged {
        param m[2] = [1.3, 0.8], e = 0.7, B = 1.1;
        coord r[2][2];
        momentum p of r;
        let A[i in 0..2] = [-B*r[i][1]/2, B*r[i][0]/2];
        let u[i in 0..2] = p[i] - e*A[i];
        H = sum(i in 0..2, u[i]*u[i]/(2*m[i])) + e^2/norm(r[1] - r[0]);
        discretize midpoint;
    }
}

/// A system by H and by L, and a start.
struct Case {
    h: &'static str,
    l: &'static str,
    q: &'static [f64],
    v: &'static [f64],
}

const CASES: [Case; 7] = [
    Case {
        h: "param m = 1.3, k = 20.0, g = 9.81, c = 0.1; coord r; angle a; momentum p of r, l of a;
            H = p^2/(2*m) + l^2/(2*m*r^2) + k*(r - 1)^2/2 - m*g*r*cos(a); force r = -c*p/m; discretize midpoint;",
        l:
            "param m = 1.3, k = 20.0, g = 9.81, c = 0.1; coord r; angle a;
            L = m*(dot(r)^2 + r^2*dot(a)^2)/2 - k*(r - 1)^2/2 + m*g*r*cos(a); force r = -c*dot(r); discretize midpoint;",
        q: &[1.3, 0.4],
        v: &[0.1, -0.8],
    },
    Case {
        h: "param m = 1.3, M = 0.7, l = 1.1, d = 0.6, g = 9.8; angle a, b; momentum p of a, q of b;
            H = (M*d^2*p^2 + (m + M)*l^2*q^2 - 2*M*l*d*p*q*cos(a - b)) / (2*M*l^2*d^2*(m + M*sin(a - b)^2))
                - (m + M)*g*l*cos(a) - M*g*d*cos(b); discretize midpoint;",
        l: "param m = 1.3, M = 0.7, l = 1.1, d = 0.6, g = 9.8; angle a, b;
            L = (m + M)*l^2*dot(a)^2/2 + M*d^2*dot(b)^2/2 + M*l*d*dot(a)*dot(b)*cos(a - b)
                + (m + M)*g*l*cos(a) + M*g*d*cos(b); discretize midpoint;",
        q: &[1.0, 0.5],
        v: &[0.0, 0.3],
    },
    Case {
        h: "param m[2] = [1.3, 0.8], e = 0.7, B = 1.1; coord r[2][2]; momentum p of r;
            let A[i in 0..2] = [-B*r[i][1]/2, B*r[i][0]/2]; let u[i in 0..2] = p[i] - e*A[i];
            H = sum(i in 0..2, u[i]*u[i]/(2*m[i])) + e^2/norm(r[1] - r[0]); discretize midpoint;",
        l: "param m[2] = [1.3, 0.8], e = 0.7, B = 1.1; coord r[2][2];
            let A[i in 0..2] = [-B*r[i][1]/2, B*r[i][0]/2], v = dot(r);
            L = sum(i in 0..2, m[i]*v[i]*v[i]/2 + e*A[i]*v[i]) - e^2/norm(r[1] - r[0]); discretize midpoint;",
        q: &[0.5, 0.0, -0.5, 0.2],
        v: &[0.1, 0.4, 0.0, -0.5],
    },
    Case {
        h: "param w = 0.7; coord x, y; momentum p of x, q of y; let m = 2 + sin(w*t);
            H = p^2/(2*m) + q^2/2 + x*q*cos(t) + x^2*y^2; discretize midpoint;",
        l: "param w = 0.7; coord x, y; let m = 2 + sin(w*t);
            L = m*dot(x)^2/2 + (dot(y) - x*cos(t))^2/2 - x^2*y^2; discretize midpoint;",
        q: &[0.9, 0.5],
        v: &[0.1, 0.4],
    },
    Case {
        h: "param k = 1.4; coord x[2]; momentum p of x;
            H = p*p/2 + k*x*x/2 + x[0]^2*x[1] - x[1]^3/3; discretize midpoint;",
        l: "param k = 1.4; coord x[2]; let v = dot(x);
            L = v*v/2 - k*x*x/2 - x[0]^2*x[1] + x[1]^3/3; discretize midpoint;",
        q: &[0.0, 0.1],
        v: &[0.5, 0.0],
    },
    Case {
        h: "param m = 1.3, c = 3.0; coord x, y; momentum p of x, q of y;
            H = c*sqrt(m^2*c^2 + p^2 + q^2) - 1/hypot(x, y); discretize midpoint;",
        l: "param m = 1.3, c = 3.0; coord x, y;
            L = -c*sqrt(m^2*c^2 - m^2*(dot(x)^2 + dot(y)^2)) + 1/hypot(x, y); discretize midpoint;",
        q: &[0.9, 0.5],
        v: &[0.1, 0.4],
    },
    Case {
        h: "param m = 1.3, g = 9.8; coord x, y; momentum p of x, q of y;
            H = (p^2 + q^2)/(2*m) + m*g*y; constraint rod = x^2 + y^2 - 1;",
        l: "param m = 1.3, g = 9.8; coord x, y;
            L = m*(dot(x)^2 + dot(y)^2)/2 - m*g*y; constraint rod = x^2 + y^2 - 1;",
        q: &[0.6, -0.8],
        v: &[0.8, 0.6],
    },
];

const METHODS: [(Method, Option<usize>); 7] = [
    (Method::Fixed, None),
    (Method::Splitting6, None),
    (Method::Energy, None),
    (Method::Gauss, Some(2)),
    (Method::Gauss, Some(4)),
    (Method::Energy, Some(2)),
    (Method::Adaptive, Some(4)),
];

/// Coordinates and momenta after steps of a method; `None` if the system has no such steps.
fn after(system: &dyn System, method: (Method, Option<usize>), [q, v]: [&[f64]; 2]) -> Option<Vec<f64>> {
    let start = PhasePoint { t: 0.3, q: q.to_vec(), v: v.to_vec() };
    let plan = Plan { stages: method.1, ..Plan::new(method.0, 0.01, start) };
    let mut run = system.begin(&plan).ok()?;
    run.advance_by(20).ok()?;
    let row = run.row();
    Some([row.q, row.p, vec![row.t]].concat())
}

fn distance(left: &[f64], right: &[f64]) -> f64 {
    assert_eq!(left.len(), right.len());
    left.iter().zip(right).map(|(left, right)| (left - right).abs()).fold(0.0, f64::max)
}

fn tape(clauses: &str) -> vi_tape::System {
    vi_tape::System::parse(&format!("struct System {{ {clauses} }}")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn steps_by_h_are_those_by_l() {
    let mut taken = 0;
    for Case { h, l, q, v } in CASES {
        let [by_h, by_l] = [h, l].map(tape);
        for method in METHODS {
            let [by_h, by_l] = [&*by_h, &*by_l].map(|system| after(system, method, [q, v]));
            assert_eq!(by_h.is_some(), by_l.is_some(), "{method:?}: {h}");
            let Some((by_h, by_l)) = by_h.zip(by_l) else { continue };
            let off = distance(&by_h, &by_l);
            // Steps that solve for their length multiply roundings.
            let allowed = if method.0.finds_length() { 3e-7 } else { 1e-15 }; // 6.9e-8, 1.1e-16
            assert!(off <= allowed, "{method:?} {off:e}: {h}");
            taken += 1;
        }
    }
    assert!(taken > 30, "{taken}");
}

#[test]
fn a_text_by_h_takes_the_steps_of_the_compiled_system() {
    let elastic = kind!(Elastic, { fixed; gauss 4, 8; energy });
    let charged = kind!(Charged, { fixed; gauss 4, 8; energy });
    for (compiled, Case { q, v, .. }) in [(elastic, &CASES[0]), (charged, &CASES[2])] {
        let tape = vi_tape::System::parse(compiled.definition()).unwrap_or_else(|error| panic!("{error}"));
        for (method, allowed) in
            [((Method::Fixed, None), 0.0), ((Method::Energy, None), 0.0), ((Method::Gauss, Some(4)), 1e-14)]
        {
            let [one, other] = [&*compiled, &*tape].map(|system| after(system, method, [*q, *v]).expect("steps"));
            let off = distance(&one, &other);
            assert!(off <= allowed, "{method:?}: {off:e}");
        }
    }
}

#[test]
fn a_momentum_is_a_name_along_a_motion() {
    let text = kind!(Charged, { fixed }).definition();
    let of = Observable::parse(text, &[], "p[1] * p[1] + l").err().map(|error| error.to_string()).unwrap_or_default();
    assert!(of.contains("unknown name `l`"), "{of}");
    let of = Observable::parse(text, &[], "p[1]").unwrap_or_else(|error| panic!("{error}"));
    let parameters = [1.3, 0.8, 0.7, 1.1];
    let at = Moment {
        t: 0.0,
        q: &[0.5, 0.0, -0.5, 0.2],
        v: &[0.1, 0.4, 0.0, -0.5],
        parameters: &parameters,
        ..Moment::default()
    };
    for (found, wanted) in of.values(&at).into_iter().zip([-0.7 * 1.1 * 0.1, -0.8 * 0.5 - 0.7 * 1.1 * 0.25]) {
        assert!((found - wanted).abs() < 1e-15, "{found} instead of {wanted}");
    }
}
