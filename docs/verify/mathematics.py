"""Statements of docs/mathematics.md."""

import sympy as sp
from mpmath import (acos, cos, exp, findroot, inf, linspace, mp, mpf, odefun, pi, sin, sqrt)
from sympy import Rational as R

from kinds import close, holds, limit, same, statement

PAGE = "mathematics.md"
t0, t1, h, t, c, k, m = sp.symbols("t0 t1 h t c k m", positive=True)


def midpoint(n, lagrangian):
    """L_d of the midpoint rule as a function of its slots, and the substitutions of the midpoint."""
    q0, q1 = sp.symbols(f"q0_:{n}"), sp.symbols(f"q1_:{n}")
    t, q, v = sp.Symbol("t"), sp.symbols(f"q_:{n}"), sp.symbols(f"v_:{n}")
    at = {t: (t0 + t1) / 2}
    at.update({q[i]: (q0[i] + q1[i]) / 2 for i in range(n)})
    at.update({v[i]: (q1[i] - q0[i]) / (t1 - t0) for i in range(n)})
    action = (t1 - t0) * lagrangian(t, q, v).subs(at, simultaneous=True)
    return action, at, (t, q, v), q0, q1


def polynomial(t, q, v):
    """A Lagrangian with every mixed derivative, of two coordinates."""
    x, y = q
    u, w = v
    return (2 + x**2 + t * y) * u**2 / 2 + (1 + x * y) * u * w / 3 + (3 + t**2) * w**2 / 2 + t * x * y * u - x**3 * y + t**2 * y


def force(t, q, v):
    x, y = q
    u, w = v
    return [-u / 3 + t * y, x * w - w**3 / 5]


@statement(
    PAGE,
    "D1 L_d = En + (h/2) L_t      D3 L_d = −En + (h/2) L_t",
    "D2 L_d = (h/2) L_q − P       D4 L_d =  (h/2) L_q + P",
)
def slots_of_the_midpoint_rule(claim):
    action, at, (t, q, v), q0, q1 = midpoint(2, polynomial)
    L, step = polynomial(t, q, v), t1 - t0
    P = [sp.diff(L, x) for x in v]
    En = sum(x * p for x, p in zip(v, P)) - L
    here = lambda expr: claim(expr).subs(at, simultaneous=True)
    h = sp.Symbol("h")
    half = lambda expr: (h / 2 * expr)
    for slot, wanted in [(t0, En + half(sp.diff(L, t))), (t1, -En + half(sp.diff(L, t)))]:
        same(sp.diff(action, slot), here(wanted).subs(h, step))
    for i in range(2):
        same(sp.diff(action, q0[i]), here(half(sp.diff(L, q[i])) - P[i]).subs(h, step))
        same(sp.diff(action, q1[i]), here(half(sp.diff(L, q[i])) + P[i]).subs(h, step))


@statement(PAGE, "p1 = p0 + h (L_q + f)        E1 = E0 − h (L_t − f·v)")
def increments_of_a_step(claim):
    action, at, (t, q, v), q0, q1 = midpoint(2, polynomial)
    L, f, step = polynomial(t, q, v), force(t, q, v), t1 - t0
    here = lambda expr: expr.subs(at, simultaneous=True)
    for i in range(2):
        p0 = -sp.diff(action, q0[i]) - here(step / 2 * f[i])
        p1 = sp.diff(action, q1[i]) + here(step / 2 * f[i])
        same(p1 - p0, here(claim(step * (sp.diff(L, q[i]) + f[i]))))
    power = sum(x * y for x, y in zip(f, v))
    g = here(-step / 2 * power)
    same(-sp.diff(action, t1) - g - (sp.diff(action, t0) + g), here(claim(-step * (sp.diff(L, t) - power))))


def oscillator():
    """Slots of the damped oscillator in its printed notation."""
    action, at, (t, q, v), q0, q1 = midpoint(1, lambda t, q, v: m * v[0] ** 2 / 2 - k * q[0] ** 2 / 2)
    here = lambda expr: expr.subs(at, simultaneous=True)
    return action, here(-(t1 - t0) / 2 * c * v[0]), here((t1 - t0) / 2 * c * v[0] ** 2), q0[0], q1[0]


@statement(PAGE, "`E_k = D3 L_d` | `E_k = −D3 L_d`")
def the_energy_is_minus_d3(claim):
    action, *_, q1 = oscillator()
    same(claim(-sp.diff(action, t1)).subs({k: 0, q1: t1, sp.Symbol("q0_0"): t0}), m / 2)


@statement(PAGE, "`− D3 L_d − g_d⁻` | `−D3 L_d − g_d⁺`".replace("− D3", "−D3"), "`− (c/2)(q_{k+1}−q_k)²/h`")
def energy_of_the_oscillator(claim):
    action, _, g, q0, q1 = oscillator()
    step, q, v = t1 - t0, (q0 + q1) / 2, (q1 - q0) / (t1 - t0)
    same(-sp.diff(action, t1) - g, m * v**2 / 2 + k * q**2 / 2 + claim(-c / 2 * (q1 - q0) ** 2 / step))


@statement(PAGE, "`m (q_{k+1}−q_k)/h … + c (q_{k+1}−q_k)/2`", "`k (h/4)(2q+hv)`")
def momentum_equation_of_the_oscillator(claim):
    action, f, _, q0, q1 = oscillator()
    step, q, v = t1 - t0, *sp.symbols("q v")
    equation = -sp.diff(action, q0) - f
    printed = m * (q1 - q0) / step + k * step * (q0 + q1) / 4 + c * (q1 - q0) / 2
    same(equation, claim(printed))
    in_v = equation.subs({q1: q0 + step * v})
    same(in_v, m * v + claim(k * step / 4 * (2 * q0 + step * v)) + c * step * v / 2)


@statement(PAGE, "`f_L`, `f_L·q̇` | `f_L c_t'`, `f_L·q̇ c_t'`")
def force_in_the_integrated_variation(claim):
    a, s = sp.symbols("a s")
    # The work of a force along q = t² with δq = t, δt = t³, in two parametrizations of 0 < t < 1: t = a, and t = s².
    work = lambda time: (3 * time * time - 3 * time * 2 * time * time**3)
    plain = sp.integrate(work(a), (a, 0, 1))
    same(sp.integrate(claim(work(s**2) * sp.diff(s**2, s)), (s, 0, 1)), plain)


def density(L, f, t, q, v):
    """D by its definition, with derivatives along the motion; and the acceleration."""
    n = len(q)
    mass = sp.Matrix(n, n, lambda i, j: sp.diff(L, v[i], v[j]))
    along = lambda expr, a: sp.diff(expr, t) + sum(sp.diff(expr, q[i]) * v[i] + sp.diff(expr, v[i]) * a[i] for i in range(n))
    rest = sp.Matrix([sp.diff(L, q[i]) + f[i] - sp.diff(L, v[i], t) - sum(sp.diff(L, v[i], q[j]) * v[j] for j in range(n)) for i in range(n)])
    a = mass.LUsolve(rest)
    D = sum(a[i] * (sp.diff(L, q[i]) + f[i]) - v[i] * along(sp.diff(L, q[i]), a) for i in range(n)) - along(sp.diff(L, t), a)
    return D, a


@statement(PAGE, "D = 2 L_q·a − (1,v,a)ᵀ ∇²L (1,v,a)", "D = ∇Vᵀ M⁻¹ ∇V + vᵀ (∇²V) v")
def forms_of_the_density(claim):
    t, q, v = sp.Symbol("t"), sp.symbols("q_:2"), sp.symbols("v_:2")
    L = polynomial(t, q, v)
    D, a = density(L, [0, 0], t, q, v)
    z, y = sp.Matrix([1, *v, *a]), [t, *q, *v]
    hessian = sp.Matrix(5, 5, lambda i, j: sp.diff(L, y[i], y[j]))
    point = {t: R(1, 3), q[0]: R(2, 5), q[1]: R(-3, 7), v[0]: R(5, 4), v[1]: R(2, 3)}
    form = 2 * sum(sp.diff(L, q[i]) * a[i] for i in range(2)) - (z.T * hessian * z)[0]
    same(D.subs(point), claim(form).subs(point))
    V = q[0] ** 4 / 4 - q[0] * q[1] ** 2 + q[1] ** 3 / 3
    M = sp.Matrix([[2, R(1, 2)], [R(1, 2), 1]])
    w = sp.Matrix(v)
    D, _ = density((w.T * M * w)[0] / 2 - V, [0, 0], t, q, v)
    grad = sp.Matrix([sp.diff(V, x) for x in q])
    same(D, claim((grad.T * M.inv() * grad)[0] + (w.T * sp.hessian(V, q) * w)[0]))


def forced_step(h):
    """H − E0 and the determinants of a midpoint step of length h from a fixed node, of a system with a varying mass, a force
    and explicit time: L = (2 + x² + t) v²/2 − x⁴/4 + t x, f = −v/3 + t²."""
    T, X, V = mpf("0.3"), mpf("0.9"), mpf("0.7")
    mass = lambda t, x: 2 + x * x + t
    L = lambda t, x, v: mass(t, x) * v * v / 2 - x**4 / 4 + t * x
    Lt = lambda t, x, v: v * v / 2 + x
    F = lambda t, x, v: x * v * v - x**3 + t - v / 3 + t * t
    f = lambda t, v: -v / 3 + t * t
    P = mass(T, X) * V
    def rows(v, h):
        t, x = T + h / 2, X + h * v / 2
        return (mass(t, x) * v - h / 2 * F(t, x, v), mass(t, x) * v * v - L(t, x, v) + h / 2 * (Lt(t, x, v) - f(t, v) * v))
    v = findroot(lambda v: rows(v, h)[0] - P, V)
    H = P * V - L(T, X, V)
    d = mpf(10) ** -18
    by = lambda i, dv, dh: (rows(v + dv, h + dh)[i] - rows(v - dv, h - dh)[i]) / (2 * d)
    jacobian = [[by(i, d, 0), by(i, 0, d)] for i in (0, 1)]
    t, x, w = sp.Symbol("t"), sp.Symbol("x"), sp.Symbol("w")
    D, _ = density((2 + x**2 + t) * w**2 / 2 - x**4 / 4 + t * x, [-w / 3 + t**2], t, [x], [w])
    D = mpf(sp.N(D.subs({t: R(3, 10), x: R(9, 10), w: R(7, 10)}), 40))
    return H - rows(v, h)[1], jacobian, D, mass(T, X)


@statement(PAGE, "`H(t_k,q_k,p_k) − E_k = h² D/8 + O(h³)`")
def density_determines_the_length(claim):
    *_, D, _ = forced_step(mpf("0.01"))
    # Measured: 5.8e-17.
    limit(lambda h: forced_step(h)[0] / h**2, claim(D / 8), "1e-15")


@statement(PAGE, "the Newton determinant is `−(h/4) det(L_vv) D` to leading order")
def determinant_to_leading_order(claim):
    *_, D, mass = forced_step(mpf("0.01"))
    def found(h):
        (rv, rh), (ev, eh) = forced_step(h)[1]
        return (rv * eh - rh * ev) / h
    # Measured: 2.8e-15.
    limit(found, claim(-mass * D / 4), "5e-14")


@statement(
    PAGE,
    "−(h/4) det(A) (V'·A⁻¹V' + Mv·A⁻¹V''v)        A = M + (h²/4) V''",
    "For one coordinate this is `−(h/4) m D`, with D at the midpoint",
)
def determinant_exactly(claim):
    q, v = sp.symbols("q_:2"), sp.symbols("v_:2")
    M = sp.Matrix([[2, R(1, 2)], [R(1, 2), 1]])
    V = lambda x: x[0] ** 4 / 4 - x[0] * x[1] ** 2 + x[1] ** 3 / 3
    def determinant(M, V, q, v):
        n, w = len(q), sp.Matrix(v)
        middle = {q[i]: q[i] + h * v[i] / 2 for i in range(n)}
        slope = sp.Matrix([sp.diff(V(q), x) for x in q]).subs(middle, simultaneous=True)
        r = M * w + h / 2 * slope
        e = (w.T * M * w)[0] / 2 + V([q[i] + h * v[i] / 2 for i in range(n)])
        rows = [*r, e]
        return sp.Matrix(n + 1, n + 1, lambda i, j: sp.diff(rows[i], [*v, h][j])).det(), slope, middle
    det, slope, middle = determinant(M, V, q, v)
    curvature = sp.hessian(V(q), q).subs(middle, simultaneous=True)
    A = M + h**2 / 4 * curvature
    w = sp.Matrix(v)
    form = -h / 4 * A.det() * ((slope.T * A.inv() * slope)[0] + ((M * w).T * A.inv() * curvature * w)[0])
    for point in ([R(1, 3), R(-2, 7), R(5, 4), R(2, 3), R(1, 10)], [R(-3, 2), R(4, 5), R(1, 6), R(-7, 3), R(3, 4)]):
        at = dict(zip([*q, *v, h], point))
        same(det.subs(at), claim(form).subs(at))
    # One coordinate, with any potential of degree six.
    x, u = sp.Symbol("x"), sp.Symbol("u")
    coefficients = sp.symbols("b_:7")
    well = lambda q: sum(b * q[0] ** i for i, b in enumerate(coefficients))
    det, slope, middle = determinant(sp.Matrix([[m]]), well, [x], [u])
    D = (sp.diff(well([x]), x) ** 2 / m + sp.diff(well([x]), x, 2) * u**2).subs(middle, simultaneous=True)
    same(det, claim(-h / 4 * m * D))


@statement(PAGE, "`H − E = h² D/8` holds exactly at both ends of a step, with D at its midpoint")
def quadratic_lagrangian(claim):
    # L = v·Mv/2 + v·Bq − q·Kq/2 + s·q and any force, here a symbol for each component at the midpoint.
    q, v, F = sp.Matrix(sp.symbols("q_:2")), sp.Matrix(sp.symbols("v_:2")), sp.Matrix(sp.symbols("f_:2"))
    M, B, K, s = sp.Matrix([[2, 1], [1, 3]]), sp.Matrix([[0, 1], [-2, 1]]), sp.Matrix([[4, 1], [1, 2]]), sp.Matrix([1, -2])
    L = lambda q, v: (v.T * M * v)[0] / 2 + (v.T * B * q)[0] - (q.T * K * q)[0] / 2 + (s.T * q)[0]
    P, Lq = M * v + B * q, B.T * v - K * q + s
    slope = Lq + F
    def hamiltonian(q, p):
        velocity = M.inv() * (p - B * q)
        return (p.T * velocity)[0] - L(q, velocity)
    a = M.inv() * (slope - B * v)
    D = (a.T * slope)[0] - (v.T * (B.T * a - K * v))[0]
    En, power = (v.T * P)[0] - L(q, v), (F.T * v)[0]
    start = hamiltonian(q - h * v / 2, P - h * slope / 2) - (En - h / 2 * power)
    end = hamiltonian(q + h * v / 2, P + h * slope / 2) - (En + h / 2 * power)
    same(start, claim(h**2 * D / 8))
    same(end, claim(h**2 * D / 8))


def linear():
    """A linear system with damping, of two coordinates: M, K, C."""
    return sp.Matrix([[2, R(1, 2)], [R(1, 2), 1]]), sp.Matrix([[3, -1], [-1, 2]]), sp.Matrix([[R(1, 3), R(1, 9)], [R(1, 9), R(1, 5)]])


@statement(PAGE, "D = a·Ma + v·Kv        D' = −2 a·Ca")
def density_of_a_damped_motion(claim):
    M, K, C = linear()
    q, v = sp.Matrix(sp.symbols("q_:2")), sp.Matrix(sp.symbols("v_:2"))
    a = M.inv() * (-K * q - C * v)
    jerk = M.inv() * (-K * v - C * a)
    D, _ = density((v.T * M * v)[0] / 2 - (q.T * K * q)[0] / 2, list(-C * v), t, list(q), list(v))
    same(D, claim((a.T * M * a)[0] + (v.T * K * v)[0]))
    same(2 * (a.T * M * jerk)[0] + 2 * (v.T * K * a)[0], claim(-2 * (a.T * C * a)[0]))


@statement(
    PAGE,
    "(h₊ − h) [√(D D₊) (1/h + 1/h₊) + ½ (a₊·Kv − a·Kv₊) − ¼ (a₊·Ca₊ − a·Ca)] = ¼ (h + h₊) (a + a₊)·C(a + a₊)",
    "whenever `h (ω + 3δ) < 4`",
)
def steps_of_a_damped_motion_grow(claim):
    # Two steps that meet at a node, with one value of h² D: rationals and the root that makes it so.
    M, K, C = linear()
    for seed, (h, scale) in enumerate([(R(1, 10), 1), (R(3, 4), 2), (R(2), 1)]):
        q, v = sp.Matrix([R(1, 3) + seed, R(-2, 5)]), sp.Matrix([R(5, 4), R(2, 3) - seed]) * scale
        a = M.inv() * (-K * q - C * v)
        D = (a.T * M * a)[0] + (v.T * K * v)[0]
        node, p = q + h * v / 2, M * v + h / 2 * M * a
        def next_step(g):
            A = M + g / 2 * C + g**2 / 4 * K
            w = A.LUsolve(p - g / 2 * K * node)
            x = node + g * w / 2
            b = M.inv() * (-K * x - C * w)
            return x, w, b
        def excess(g):
            x, w, b = next_step(sp.Float(str(g), 40))
            return mpf(str((sp.Float(str(g), 40) ** 2 * ((b.T * M * b)[0] + (w.T * K * w)[0]) - h**2 * D).evalf(40)))
        g = sp.Float(str(findroot(excess, (mpf(h.p) / h.q, mpf(h.p) / h.q * mpf("1.05")), tol=1e-60, solver="secant")), 40)
        x, w, b = next_step(g)
        E = (b.T * M * b)[0] + (w.T * K * w)[0]
        bracket = sp.sqrt(D * E) * (1 / h + 1 / g) + ((b.T * K * v)[0] - (a.T * K * w)[0]) / 2 - ((b.T * C * b)[0] - (a.T * C * a)[0]) / 4
        both = a + b
        found = (g - h) * bracket
        # Measured: 5.0e-39.
        close(str(found.evalf(40)), claim(mpf(str(((h + g) / 4 * (both.T * C * both)[0]).evalf(40)))), "1e-36")
        # The bound of the proof.
        omega = max(sp.sqrt(value.evalf(40)) for value in (M.inv() * K).eigenvals())
        delta = max(value.evalf(40) for value in (M.inv() * C).eigenvals()) / 2
        holds(abs((b.T * K * v)[0] - (a.T * K * w)[0]) <= omega * sp.sqrt(D * E), "the bound by ω")
        holds(abs((b.T * C * b)[0] - (a.T * C * a)[0]) <= 2 * delta * max(D, E), "the bound by δ")
        holds(h * (omega + 3 * delta) >= 4 or g >= h, "a shorter step")


def damped_run(zeta, h0, dps=20):
    """Lengths and energies of all steps of the oscillator with m = 1, k = 4, from q = 1 at rest with the midpoint start, in v
    and h of each node, until E ≤ 0. The equation of the length is one sign change, found by bisection and secants."""
    mp.dps = dps
    k, c = mpf(4), 4 * mpf(zeta)
    q, v, h = mpf(1), mpf(0), mpf(h0)
    E = k * q * q / 2 - h / 2 * c * v * v
    p, x = v - h / 2 * (k * q + c * v), q + h / 2 * v
    lengths = [h]
    while E > 0:
        def energy(g):
            w = (p - g / 2 * k * x) / (1 + c * g / 2 + k * g * g / 4)
            y = x + g / 2 * w
            return w * w / 2 + k * y * y / 2 + g / 2 * c * w * w, w, y
        # Newton's iteration in h on the discrete energy, which falls from H at h = 0.
        g = h
        for _ in range(200):
            d = g * mpf("1e-7")
            value, slope = energy(g)[0] - E, (energy(g + d)[0] - energy(g - d)[0]) / (2 * d)
            step = value / slope
            g = g - step if 0 < g - step < 4 * g else (2 * g if value > 0 else g / 2)
            if abs(step) < mpf("1e-13") * g:
                break
        _, w, y = energy(g)
        E -= g * c * w * w
        x, p, h = x + g * w, p - g * (k * y + c * w), g
        lengths.append(h)
        if len(lengths) > 10_000:
            break
    return lengths, E


@statement(
    PAGE,
    "So the damped oscillator has `h_k ≈ h0 e^{ζ ω t}`",
    "Its run ends after about `1/(ζ ω h0)` steps",
)
def steps_of_the_damped_oscillator(claim):
    zeta, h0 = mpf("0.1"), mpf("0.05")
    lengths, E = damped_run(zeta, h0)
    predicted = 1 / (zeta * 2 * h0)
    # Measured: 100 steps, of which the last is 3.6 long.
    close(len(lengths) / predicted, claim(mpf(1), by="1/10"), "0.03")
    holds(all(b > a for a, b in zip(lengths, lengths[1:])), "a step that is not longer than the last")
    holds(E <= 0, "the run ended with E > 0")
    # dt/dk = h0 e^(ζ ω t) has the solution t = −ln(1 − ζ ω h0 k)/(ζ ω), which ends at k = 1/(ζ ω h0).
    n, w = sp.symbols("n w", positive=True)
    h0 = sp.Symbol("h0", positive=True)
    time = -sp.log(1 - w * h0 * n) / w
    same(sp.diff(time, n), claim(h0 * sp.exp(w * time)))


@statement(PAGE, "E(h) = v·Mv/2 + q̄·Kq̄/2 + (h/2) v·Cv")
def energy_of_a_step_of_given_length(claim):
    M, K, C = linear()
    q, v = sp.Matrix(sp.symbols("q_:2")), sp.Matrix(sp.symbols("v_:2"))
    # E0 = D1 L_d + g⁻ of the midpoint rule.
    f = -C * v
    En = (v.T * M * v)[0] / 2 + (q.T * K * q)[0] / 2
    same(En - h / 2 * (f.T * v)[0], claim((v.T * M * v)[0] / 2 + (q.T * K * q)[0] / 2 + h / 2 * (v.T * C * v)[0]))
    # It tends to 0 for long steps from a node: q̄ and v are of order 1/h.
    g = sp.Symbol("g", positive=True)
    node, p = sp.Matrix([R(1, 3), R(-2, 5)]), sp.Matrix([R(5, 4), R(2, 3)])
    w = (M + g / 2 * C + g**2 / 4 * K).LUsolve(p - g / 2 * K * node)
    x = node + g / 2 * w
    E = (w.T * M * w)[0] / 2 + (x.T * K * x)[0] / 2 + g / 2 * (w.T * C * w)[0]
    same(sp.limit(sp.simplify(g * E), g, sp.oo), claim(2 * (node.T * C * node)[0]))


@statement(PAGE, "D' = V'''(v,v,v) − 2 a·Ca")
def density_of_a_nonlinear_damped_motion(claim):
    q, v = sp.symbols("q_:2"), sp.symbols("v_:2")
    M, _, C = linear()
    V = q[0] ** 4 / 4 - q[0] * q[1] ** 2 + q[1] ** 3 / 3
    w = sp.Matrix(v)
    grad = sp.Matrix([sp.diff(V, x) for x in q])
    a = M.inv() * (-grad - C * w)
    D = (a.T * M * a)[0] + (w.T * sp.hessian(V, q) * w)[0]
    along = lambda expr: sum(sp.diff(expr, q[i]) * v[i] + sp.diff(expr, v[i]) * a[i] for i in range(2))
    third = sum(sp.diff(V, x, y, z) * v[i] * v[j] * v[l] for i, x in enumerate(q) for j, y in enumerate(q) for l, z in enumerate(q))
    same(along(D), claim(third - 2 * (a.T * C * a)[0]))


def step_of(V1, V2, E, p, q, h, v):
    """One energy-preserving step of L = v²/2 − V: Newton's iteration in (v, h)."""
    V = lambda x: V1(x)
    for _ in range(60):
        x = q + h * v / 2
        slope, curvature = V2(x)
        r, e = v + h / 2 * slope - p, v * v / 2 + V(x) - E
        rv, rh = 1 + h * h / 4 * curvature, slope / 2 + h / 4 * curvature * v
        ev, eh = v + h / 2 * slope, slope * v / 2
        d = rv * eh - rh * ev
        dv, dh = (-r * eh + e * rh) / d, (r * ev - e * rv) / d
        v, h = v + dv, h + dh
        if abs(dh) < mpf(10) ** (5 - mp.dps) * abs(h):
            break
    return v, h


def double_well_run(q0, h0, T):
    """Lengths and densities at the midpoints of the double well from rest, midpoint start."""
    V, dV = (lambda x: (x**4 - x**2) / 2), (lambda x: (2 * x**3 - x, 6 * x**2 - 1))
    D = lambda x, v: dV(x)[0] ** 2 + dV(x)[1] * v * v
    q, v, h, time = mpf(q0), mpf(0), mpf(h0), mpf(0)
    E = V(q)
    rows = [(h, D(q, v))]
    p, q = -h / 2 * dV(q)[0], q
    while time < T:
        for _ in range(4):
            v -= (v + h / 2 * dV(q + h * v / 2)[0] - p) / (1 + h * h / 4 * dV(q + h * v / 2)[1])
        h = h * (rows[-1][1] / D(q + h * v / 2, v)) ** (mpf(1) / 3)
        for _ in range(4):
            v -= (v + h / 2 * dV(q + h * v / 2)[0] - p) / (1 + h * h / 4 * dV(q + h * v / 2)[1])
        v, h = step_of(V, dV, E, p, q, h, v)
        holds(h > 0, "a step backwards")
        x = q + h * v / 2
        rows.append((h, D(x, v)))
        p -= h * dV(x)[0]
        q, time = q + h * v, time + h
    return rows


@statement(PAGE, "Unforced: `h_k D_k^{1/3}` is constant up to O(h²)")
def the_step_law(claim):
    mp.dps = 25
    def deviation(h0):
        rows = double_well_run("0.74", h0, 6)
        value = [h * D ** (mpf(1) / 3) for h, D in rows]
        return max(abs(x / value[0] - 1) for x in value)
    # Measured: 3.97 for half the step, by O(h²) four; O(h) would be two.
    ratio = deviation("0.1") / deviation("0.05")
    close(ratio, claim(mpf(4), by="1/4"), "0.1")


@statement(PAGE, "`(v,h) = (v_{k−1}, −h_{k−1})`, the last interval traversed backwards")
def the_spurious_root(claim):
    t, q, v = sp.Symbol("t"), sp.symbols("q_:2"), sp.symbols("v_:2")
    L, f = polynomial(t, q, v), force(t, q, v)
    P = [sp.diff(L, x) for x in v]
    power = sum(x * y for x, y in zip(f, v))
    En = sum(x * p for x, p in zip(v, P)) - L
    # Momentum and energy of the node after the step (v, h) about the midpoint, and both rows of the step (v, −h) from it.
    # Its midpoint is the same: t1 + (−h)/2 and q1 + (−h) v/2.
    for i in range(2):
        slope = sp.diff(L, q[i]) + f[i]
        same(P[i] - (-h) / 2 * slope, claim(P[i] + h / 2 * slope))
    same(En + (-h) / 2 * (sp.diff(L, t) - power), claim(En - h / 2 * (sp.diff(L, t) - power)))


@statement(PAGE, "the discrete energy oscillates by `h² (D_max − D_min)/12`")
def oscillation_of_fixed_steps(claim):
    mp.dps = 20
    V, dV, ddV = (lambda x: (x**4 - x**2) / 2), (lambda x: 2 * x**3 - x), (lambda x: 6 * x**2 - 1)
    h, q = mpf("0.02"), mpf("0.74")
    p, v = mpf(0), mpf(0)
    energies, densities = [], []
    for _ in range(400):
        for _ in range(5):
            x = q + h * v / 2
            v -= (v + h / 2 * dV(x) - p) / (1 + h * h / 4 * ddV(x))
        x = q + h * v / 2
        energies.append(v * v / 2 + V(x))
        densities.append(dV(x) ** 2 + ddV(x) * v * v)
        q, p = q + h * v, p - h * dV(x)
    found = (max(energies) - min(energies)) / h**2
    # Measured: 7.2e-9, of the next order in h.
    close(found, claim((max(densities) - min(densities)) / 12), "1e-7")


@statement(PAGE, "D differs between `L` and `L + g(t)`")
def explicit_forcing_changes_the_density(claim):
    t, q, v = sp.Symbol("t"), sp.symbols("q_:2"), sp.symbols("v_:2")
    L, g = polynomial(t, q, v), sp.Function("g")(t)
    D, _ = density(L, [0, 0], t, q, v)
    with_g, _ = density(L + g, [0, 0], t, q, v)
    point = {q[0]: R(2, 5), q[1]: R(-3, 7), v[0]: R(5, 4), v[1]: R(2, 3)}
    same((with_g - D).subs(point), claim(-sp.diff(g, t, 2)))


@statement(PAGE, "The nodes lie outside the curve, the midpoints on it")
def the_outer_billiard(claim):
    # The midpoint of two nodes is (q̄, L_v), and their difference is h times (H_p, −H_q) there.
    V, x, v = sp.Function("V"), sp.Symbol("x"), sp.Symbol("v")
    slope = sp.diff(V(x), x)
    q0, q1, p0, p1 = x - h * v / 2, x + h * v / 2, m * v + h / 2 * slope, m * v - h / 2 * slope
    same((p0 + p1) / 2, claim(m * v))
    same((q1 - q0) * slope + (p1 - p0) * v, claim(sp.S.Zero))


@statement(PAGE, "c = v·p0 − L − E0 + (h/2)(L_t + v·L_q)")
def leading_terms_cancel(claim):
    t, q, v, p, E = sp.Symbol("t"), sp.symbols("q_:2"), sp.symbols("v_:2"), sp.symbols("p_:2"), sp.Symbol("E")
    L, f = polynomial(t, q, v), force(t, q, v)
    dot = lambda x, y: sum(a * b for a, b in zip(x, y))
    Lq, P = [sp.diff(L, x) for x in q], [sp.diff(L, x) for x in v]
    r = [P[i] - h / 2 * (Lq[i] + f[i]) - p[i] for i in range(2)]
    e = dot(v, P) - L + h / 2 * (sp.diff(L, t) - dot(f, v)) - E
    same(e - dot(v, r), claim(dot(v, p) - L - E + h / 2 * (sp.diff(L, t) + dot(v, Lq))))


@statement(PAGE, "the Schur complement of A is `−D/4` to leading order")
def the_schur_complement(claim):
    *_, D, _ = forced_step(mpf("0.01"))
    def found(h):
        (rv, rh), (ev, eh) = forced_step(h)[1]
        # (∂e/∂h − v·∂r/∂h)/h − (∂e/∂v − v·A)/h · A⁻¹ · ∂r/∂h, in which v cancels.
        return (eh - ev * rh / rv) / h
    # Measured: 3.5e-16.
    limit(found, claim(-D / 4), "5e-15")


@statement(PAGE, "it is ~1/h in `(v,h)` and ~1/h² in `(q,t)`", "The condition number does not depend on h")
def condition_numbers(claim):
    def conditions(h):
        (rv, rh), (ev, eh) = forced_step(h)[1]
        norm = lambda a, b, c, d: sqrt((a * a + b * b + c * c + d * d + sqrt((a * a + b * b + c * c + d * d) ** 2 - 4 * (a * d - b * c) ** 2)) / 2)
        cond = lambda a, b, c, d: norm(a, b, c, d) ** 2 / abs(a * d - b * c)
        # v = (q1 − q0)/h, at v = 0.7: ∂v/∂q1 = 1/h and ∂v/∂t1 = −v/h.
        v = mpf("0.7")
        in_q = (rv / h, rh - rv * v / h, ev / h, eh - ev * v / h)
        scaled = (rv, rh, (ev - v * rv) / h, (eh - v * rh) / h)
        return [cond(rv, rh, ev, eh), cond(*in_q), cond(*scaled)]
    rows = [conditions(mpf(h)) for h in ("1e-4", "1e-5")]
    for (found, wanted) in zip([rows[1][i] / rows[0][i] for i in range(3)], [10, 100, 1]):
        # Measured: 6.1e-5.
        close(found / wanted, claim(mpf(1), by="1/10"), "1e-3")


@statement(PAGE, "`−h0² (a·Ma/8 + v·V''v/24)`", "every midpoint lies on `H = H0`")
def the_starts(claim):
    # The oscillator with ω = 2 about the middle of an exact interval: E of its chord less H.
    q, v, w = mpf("0.8"), mpf("0.6"), mpf(2)
    at = lambda t: q * cos(w * t) + v / w * sin(w * t)
    def bias(h):
        x, u = (at(h / 2) + at(-h / 2)) / 2, (at(h / 2) - at(-h / 2)) / h
        return (u * u / 2 + w * w * x * x / 2 - v * v / 2 - w * w * q * q / 2) / h**2
    # Measured: 9.0e-12.
    limit(bias, claim(-(w**4 * q * q / 8 + w * w * v * v / 24)), "1e-10", "1e-2")
    # The midpoint start: −D3 − g⁺ of the interval about the initial state.
    t, x, u, n = sp.Symbol("t"), sp.symbols("q_:2"), sp.symbols("v_:2"), 2
    L, f = polynomial(t, x, u), force(t, x, u)
    action, *_ = midpoint(2, polynomial)
    power = sum(a * b for a, b in zip(f, u))
    En = sum(u[i] * sp.diff(L, u[i]) for i in range(n)) - L
    end = {t0: t - h / 2, t1: t + h / 2}
    end.update({sp.Symbol(f"q0_{i}"): x[i] - h / 2 * u[i] for i in range(n)})
    end.update({sp.Symbol(f"q1_{i}"): x[i] + h / 2 * u[i] for i in range(n)})
    same(-sp.diff(action, t1).subs(end, simultaneous=True) + h / 2 * power, claim(En - h / 2 * (sp.diff(L, t) - power)))


def first_zero(acceleration, density, q, v, until, t=0, side=1):
    """The first time at which D of a motion of one coordinate is zero."""
    mp.dps = 15
    y = [mpf(q), mpf(v)]
    dt, time = mpf("0.005"), mpf(t)
    rate = lambda t, y: [y[1], acceleration(t, y[0], y[1])]
    plus = lambda y, k, s: [y[0] + s * k[0], y[1] + s * k[1]]
    last = density(time, *y)
    while time < until:
        k1 = rate(time, y)
        k2 = rate(time + dt / 2, plus(y, k1, dt / 2))
        k3 = rate(time + dt / 2, plus(y, k2, dt / 2))
        k4 = rate(time + dt, plus(y, k3, dt))
        y = [y[i] + dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) for i in (0, 1)]
        time += dt
        now = density(time, *y)
        if now * last < 0:
            return time - dt * now / (now - last)
        last = now
    return inf


@statement(
    PAGE,
    "step 89, t = 1.239; every libration runs",
    "D vanishes at t = 7.982",
    "step 38, t = 0.870 at h0 = 0.02",
)
def runs_end_where_the_density_vanishes(claim):
    pendulum = lambda t, q, v: sin(q) ** 2 + cos(q) * v * v
    # A run ends within its last steps, which are longer than h0. Measured: 0.005 and 0.036.
    close(first_zero(lambda t, q, v: -sin(q), pendulum, 0, "2.1", 3), claim(mpf("1.239"), by="1/10"), "0.03")
    def duffing(t, q, v):
        slope, f = q - q**3, -mpf("0.3") * v + mpf("0.37") * cos(mpf("1.2") * t)
        return (slope + f) ** 2 - v * v * (1 - 3 * q * q)
    acceleration = lambda t, q, v: q - q**3 - mpf("0.3") * v + mpf("0.37") * cos(mpf("1.2") * t)
    close(first_zero(acceleration, duffing, 1, 0, 12), claim(mpf("7.982")), "0.001")
    def parametric(t, q, v):
        g = 1 + mpf("0.5") * cos(2 * t)
        dg, ddg = -sin(2 * t), -2 * cos(2 * t)
        a = -g * sin(q)
        # L_t = g' cos q, L_q = −g sin q, with their derivatives along the motion.
        return a * a - v * (-dg * sin(q) - g * cos(q) * v) - (ddg * cos(q) - dg * sin(q) * v)
    found = first_zero(lambda t, q, v: -(1 + mpf("0.5") * cos(2 * t)) * sin(q), parametric, "0.5", 0, 3)
    close(found, claim(mpf("0.870"), by="1/10"), "0.05")


@statement(PAGE, "impossible for e ≥ √(5/8) = 0.7906")
def eccentricity_of_the_last_orbit(claim):
    def least(e):
        found = inf
        for u in linspace(0, pi, 1001):
            r = 1 - e * cos(u)
            # r·v = e sin u, v² = (1 + e cos u)/(1 − e cos u), with μ = a = 1.
            found = min(found, 1 / r**4 + (1 + e * cos(u)) / r / r**3 - 3 * (e * sin(u)) ** 2 / r**5)
        return found
    mp.dps = 15
    e = findroot(lambda e: least(e), (mpf("0.78"), mpf("0.80")), solver="illinois", tol=1e-12)
    # Measured: 4.1e-7, of the points.
    close(e, claim(sqrt(mpf(5) / 8)), "1e-6")


@statement(PAGE, "`abs(q + h p/2)³ ≥ (27/16) μ h²`")
def fixed_steps_of_kepler(claim):
    # The midpoint x satisfies x (1 + (μ h²/4)/r³) = q + h p/2, so r + (μ h²/4)/r² is its length.
    mu, r = sp.symbols("mu r", positive=True)
    length = r + mu * h**2 / 4 / r**2
    [least] = [x for x in sp.solve(sp.diff(length, r), r) if x.is_positive]
    same(sp.simplify(length.subs(r, least) ** 3), claim(R(27, 16) * mu * h**2))


@statement(PAGE, "the root is unique iff `h < 2/√(−V''_min/m)`")
def unique_root_of_a_fixed_step(claim):
    V, q, v, p = sp.Function("V"), *sp.symbols("q v p")
    r = m * v + h / 2 * sp.diff(V(q), q).subs(q, q + h * v / 2) - p
    slope = sp.Symbol("s", negative=True)
    by_v = (m + h**2 / 4 * slope)
    x = sp.Symbol("x")
    quadratic = m * v + h / 2 * slope * (x + h * v / 2) - p
    same(sp.diff(quadratic, v), by_v)
    [bound] = [root for root in sp.solve(by_v, h) if root.is_positive]
    same(bound, claim(2 / sp.sqrt(-slope / m)))


WEIGHTS = {
    "triple jump": (1.13, lambda: [1 / (2 - mpf(2) ** (mpf(1) / 3))]),
    "Suzuki 4": (3.02, lambda: [1 / (4 - mpf(4) ** (mpf(1) / 3))] * 2),
    "Kahan–Li 6": (2.73, lambda: list(map(mpf, "0.3921614440073141 0.33259913678935943 -0.7062461725576393 0.0822135962935508".split()))),
    "Kahan–Li 8": (3.30, lambda: list(map(mpf, "0.13020248308889007 0.5611629817751084 -0.38947496264484727 0.1588419065551556 -0.39590389413323757 0.1845396409783157 0.25837438768632204 0.2950117236093103".split()))),
}


@statement(PAGE, "unstable from `c h` = 1.13 (triple jump), 3.02 (Suzuki 4), 2.73 (Kahan–Li 6), 3.30 (Kahan–Li 8)")
def damping_and_negative_substeps(claim):
    for name, (limit, weights) in WEIGHTS.items():
        half = weights()
        whole = half + [1 - 2 * sum(half)] + half[::-1]
        def factor(x):
            # The momentum after one composed step with a force −c v, x = c h.
            found = mpf(1)
            for w in whole:
                found *= (1 - w * x / 2) / (1 + w * x / 2)
            return abs(found)
        x = mpf("0.01")
        while factor(x) <= 1:
            x += mpf("0.001")
        # Three digits are printed. Measured: off by 0.005 at most.
        close(x, claim(mpf(str(limit)), by="1/50"), "0.01")


@statement(PAGE, "Verlet at `h ω = √3`, midpoint at `2√3`", "(Verlet, `h = √2`), `a² < b < 2a²` (midpoint, `h = 2`)")
def resonances(claim):
    # A step turns by θ: Verlet cos θ = 1 − (h ω)²/2, the midpoint rule tan(θ/2) = h ω/2.
    for turn, verlet, middle in [(2 * sp.pi / 3, sp.sqrt(3), 2 * sp.sqrt(3)), (sp.pi / 2, sp.sqrt(2), sp.S(2))]:
        same(1 - claim(verlet) ** 2 / 2, sp.cos(turn))
        same(claim(middle) / 2, sp.tan(turn / 2))


@statement(PAGE, "k = 6:  7 u_0 − 21 u_1 + 35 u_2 − 35 u_3 + 21 u_4 − 7 u_5 + u_6")
def prediction(claim):
    x = sp.Symbol("x")
    for degree in range(7):
        u = [x**degree + 3 * x - 1 if degree else sp.S.One for _ in range(degree + 1)]
        nodes = [value.subs(x, -i) for i, value in enumerate(u)]
        extrapolated = sum((-1) ** i * sp.binomial(degree + 1, i + 1) * nodes[i] for i in range(degree + 1))
        same(claim(sp.sympify(extrapolated)), u[0].subs(x, 1))


@statement(PAGE, "a rounding of E changes h by about `4 ε E/(h² D)` of itself")
def rounding_of_the_length(claim):
    D, error, E = sp.symbols("D epsilon E", positive=True)
    # E = H − h² D/8.
    by_h = sp.diff(h**2 * D / 8, h)
    same(error * E / by_h / h, claim(4 * error * E / (h**2 * D)))


@statement(PAGE, "`z' = e/(e d_j − u_i l_j)`, `e = d_i − l_i u_{i−1} z`")
def two_rows_at_a_time(claim):
    pivot, di, dj, li, lj, ui, up = sp.symbols("pivot d_i d_j l_i l_j u_i u_p", positive=True)
    row_i = di - li * up / pivot
    row_j = dj - lj * ui / row_i
    e = di - li * up * (1 / pivot)
    same(claim(e / (e * dj - ui * lj)), 1 / row_j)


@statement(
    PAGE,
    "t' = g        q' = g v        p' = g (L_q + f) − (H − E) ∂g/∂q        E' = g (f·v − L_t) + (H − E) ∂g/∂t",
)
def time_transformation(claim):
    # Hamilton's equations of K = g (H − E) in (t, q; −E, p), for H = p²/(2 μ(t, q)) + V(t, q).
    time, q, p, E = sp.symbols("time q p E")
    g, V, mass = (sp.Function(name)(time, q) for name in ("g", "V", "mu"))
    H = p**2 / (2 * mass) + V
    K = g * (H - E)
    w = p / mass
    L = sp.Symbol("w") ** 2 * mass / 2 - V
    by = lambda x: sp.diff(L, x).subs(sp.Symbol("w"), w)
    same(-sp.diff(K, E), claim(g))
    same(sp.diff(K, p), claim(g * w))
    same(-sp.diff(K, q), claim(g * by(q) - (H - E) * sp.diff(g, q)))
    same(sp.diff(K, time), claim(-g * by(time) + (H - E) * sp.diff(g, time)))


def gauss_nodes(s):
    """The zeros of the Legendre polynomial of degree s on [0, 1]."""
    x = sp.Symbol("x")
    return sorted(sp.solve(sp.legendre(s, 2 * x - 1), x))


def gauss_integrals(s):
    """Integrals of the Lagrange polynomials of the Gauss nodes, from 0 to each of a list of ends."""
    x, nodes = sp.Symbol("x"), gauss_nodes(s)
    basis = [sp.expand(sp.prod([(x - b) / (a - b) for b in nodes if b != a])) for a in nodes]
    return lambda ends: [[sp.integrate(of, (x, 0, end)) for of in basis] for end in ends]


@statement(PAGE, "Gauss satisfies `b_k a_ki + b_i a_ik = b_i b_k`", "Because ã_si = b_i")
def gauss_and_lobatto(claim):
    for s in (1, 2, 3):
        integrals = gauss_integrals(s)
        a, [b] = integrals(gauss_nodes(s)), integrals([1])
        for i in range(s):
            for j in range(s):
                same(b[j] * a[j][i] + b[i] * a[i][j], claim(b[i] * b[j]))


@statement(PAGE, "`D_1 = g² sin² − 2 g w² cos − w⁴`")
def density_of_a_pendulum_with_a_constraint(claim):
    # Unit mass and length, y upwards: position (sin θ, −cos θ), H = v²/2 + g y, constraint (x² + y² − 1)/2.
    g, w, angle, tau = sp.symbols("g w theta tau")
    position, tangent = sp.Matrix([sp.sin(angle), -sp.cos(angle)]), sp.Matrix([sp.cos(angle), sp.sin(angle)])
    gravity = sp.Matrix([0, -g])
    velocity = w * tangent
    multiplier = -((velocity.T * velocity)[0] + (position.T * gravity)[0])
    acceleration = gravity + multiplier * position
    q, p = position + tau * velocity, velocity + tau * acceleration
    second = lambda of: sp.diff(of, tau, 2).subs(tau, 0)
    H = (p.T * p)[0] / 2 + g * q[1]
    # π and Λ g as in the formula for s = 1: (s + 1)/s = 2.
    D = second(H) + 2 * second(multiplier * ((q.T * q)[0] - 1) / 2)
    same(D, claim(g**2 * sp.sin(angle) ** 2 - 2 * g * w**2 * sp.cos(angle) - w**4))


@statement(PAGE, "A free rotor has `sin(turn) = h w`")
def a_free_rotor(claim):
    # One step about its midpoint, from (1, 0) to (cos φ, sin φ), with s = 1: p0 + (h/2) Λ q0 = v, p0 = (0, w).
    turn, w, impulse = sp.symbols("turn w lambda_0", positive=True)
    v = sp.Matrix([(sp.cos(turn) - 1) / h, sp.sin(turn) / h])
    p0 = v - impulse * sp.Matrix([1, 0])
    # Tangent to the circle at the start: the component along (1, 0) is zero, and the other is w.
    same(p0[1].subs(sp.sin(turn), claim(h * w)), w)


@statement(PAGE, "The second derivative of the energy row with respect to v is A, exactly for a constant mass matrix")
def curvature_of_the_energy_row(claim):
    q, v = sp.symbols("q_:2"), sp.symbols("v_:2")
    M = sp.Matrix([[2, R(1, 2)], [R(1, 2), 1]])
    V = lambda x: x[0] ** 4 / 4 - x[0] * x[1] ** 2 + x[1] ** 3 / 3
    w = sp.Matrix(v)
    middle = [q[i] + h * v[i] / 2 for i in range(2)]
    e = (w.T * M * w)[0] / 2 + V(middle)
    slope = sp.Matrix([sp.diff(V(q), x) for x in q]).subs(dict(zip(q, middle)), simultaneous=True)
    A = (M * w + h / 2 * slope).jacobian(v)
    same(sp.hessian(e, v), claim(A))


@statement(PAGE, "L_v(T_i, Q_i, V_i) = p0 + h Σ_k a_ik F_k + h Σ_j â_ij A_jᵀ Λ_j", "With `â_ij = b̃_j (1 − ã_ji/b_i)` this is", "Because ã_si = b_i")
def stages_with_constraints(claim):
    x = sp.Symbol("x")
    for s in (1, 2, 3):
        integrals = gauss_integrals(s)
        a, [b] = integrals(gauss_nodes(s)), integrals([1])
        # The ends and the zeros of the derivative of a Legendre polynomial.
        ends = sorted({sp.S.Zero, sp.S.One, *sp.solve(sp.diff(sp.legendre(s, 2 * x - 1), x), x)})
        at_ends = integrals(ends)
        for i in range(s):
            # What ∂S/∂V_i and the increment of p leave in front of h F_k; in front of h A_jᵀ Λ_j it is â_ij at once.
            for k in range(s):
                same(b[k] - b[k] * a[k][i] / b[i], claim(a[i][k]))
            same(at_ends[s][i], claim(b[i]))


@statement(PAGE, "H − E0(h) = C_s h^2s D_s + …", "D_s = (d/dτ)^2s H(t+τ, π_q, π_p) + (s+1)/s (d/dτ)^2s [Λ·g(t+τ, π_q)]")
def length_of_a_step_with_constraints(claim):
    # A pendulum of unit length and mass, g = 9.81, turned by 0.8 rad with 1.3 rad per unit of time; s = 1.
    g, angle, rate = mpf("9.81"), mpf("0.8"), mpf("1.3")
    position, tangent = (sin(angle), -cos(angle)), (cos(angle), sin(angle))
    p = (rate * tangent[0], rate * tangent[1])
    H = rate**2 / 2 + g * position[1]
    def excess(h):
        def velocity(impulse):
            return p[0] + h / 2 * impulse * position[0], p[1] - h / 2 * g + h / 2 * impulse * position[1]
        def gap(impulse):
            v = velocity(impulse)
            return ((position[0] + h * v[0]) ** 2 + (position[1] + h * v[1]) ** 2 - 1) / h
        v = velocity(findroot(gap, -(rate**2)))
        return H - (v[0] ** 2 + v[1] ** 2) / 2 - g * (position[1] + h / 2 * v[1])
    D = g**2 * sin(angle) ** 2 - 2 * g * rate**2 * cos(angle) - rate**4
    # Measured: 1.7e-12.
    limit(lambda h: excess(h) / h**2, claim(D / 8), "2e-11")


@statement(PAGE, "K_p = ϑ_y⁻ᵀ H_y          K_x = H_x − ϑ_xᵀ K_p", "`y_p = ϑ_y⁻¹` and `y_x = −ϑ_y⁻¹ ϑ_x`")
def momenta_of_a_system_of_first_order(claim):
    x, y, p = sp.Matrix(sp.symbols("x_:2")), sp.Matrix(sp.symbols("y_:2")), sp.Matrix(sp.symbols("p_:2"))
    theta = sp.Matrix([x[0] + y[0] * (1 + x[1] ** 2), x[0] * y[0] + y[1] * (2 + y[0] ** 2)])
    H = x[0] ** 2 * y[1] + x[1] * y[0] ** 2 + y[0] * y[1] ** 2
    first = (p[0] - x[0]) / (1 + x[1] ** 2)
    inverse = {y[0]: first, y[1]: (p[1] - x[0] * first) / (2 + first**2)}
    solved = y.subs(inverse, simultaneous=True)
    K = H.subs(inverse, simultaneous=True)
    # At a point, in exact numbers.
    at = dict(zip(x, [R(1, 2), R(1, 3)])) | dict(zip(y, [R(3, 4), R(2, 5)]))
    at |= dict(zip(p, theta.subs(at)))
    here = lambda of: of.subs(at, simultaneous=True)
    slope = lambda of, by: sp.Matrix([sp.diff(of, z) for z in by])
    by_y, by_x = here(theta.jacobian(y)), here(theta.jacobian(x))
    same(here(solved.jacobian(p)), claim(by_y.inv()))
    same(here(solved.jacobian(x)), claim(-by_y.inv() * by_x))
    of_p = here(slope(K, p))
    same(of_p, claim(by_y.T.inv() * here(slope(H, y))))
    same(here(slope(K, x)), claim(here(slope(H, x)) - by_x.T * of_p))


def first_order_step(s, step, theta, H, x, y, p):
    """A step of L = ϑ(x, y) ẋ − H by the equations of the page; θ and H are expressions in X and Y."""
    X, Y = sp.symbols("X Y")
    parts = [theta, sp.diff(theta, X), sp.diff(theta, Y), sp.diff(H, X), sp.diff(H, Y)]
    at = sp.lambdify((X, Y), parts, "mpmath")
    [b], a = gauss_integrals(s)([1]), gauss_integrals(s)(gauss_nodes(s))
    b, a = [mpf(str(sp.N(w, 50))) for w in b], [[mpf(str(sp.N(w, 50))) for w in row] for row in a]
    def values(V, Y):
        rows = [at(x + step * sum(a[i][j] * V[j] for j in range(s)), Y[i]) for i in range(s)]
        return rows, [row[1] * v - row[3] for row, v in zip(rows, V)]
    def equations(*unknowns):
        V, Y = unknowns[:s], unknowns[s:]
        rows, F = values(V, Y)
        of_x = [rows[i][0] - p - step * sum(a[i][j] * F[j] for j in range(s)) for i in range(s)]
        return of_x + [row[2] * v - row[4] for row, v in zip(rows, V)]
    _, _, by_y, _, H_y = at(x, y)
    unknowns = list(findroot(equations, [H_y / by_y] * s + [y] * s))
    V, Y = unknowns[:s], unknowns[s:]
    F = values(V, Y)[1]
    x, p = x + step * sum(w * v for w, v in zip(b, V)), p + step * sum(w * f for w, f in zip(b, F))
    return x, findroot(lambda y: at(x, y)[0] - p, Y[-1]), p


@statement(
    PAGE,
    "| 16 | 1 | 4.7e-4 | 1.7e-3 | 4.0e-2 | 4.7e-4 |",
    "| 16 | 2 | 8.8e-6 | 5.5e-6 | 8.2e-5 | 8.8e-6 |",
    "both `ln(y)/x ẋ` and `−ln(x)/y ẏ` have the equations `ẋ = x (c y − d)`, `ẏ = y (a − b x)`",
    "`S(x)` of degree two in x: the steps stay the same",
)
def the_gauge(claim):
    mp.dps = 25
    X, Y = sp.symbols("X Y")
    a, b, c, d = R(5, 4), R(3, 4), R(1, 2), R(7, 8)
    H = lambda x, y: c * y - d * sp.log(y) + b * x - a * sp.log(x)
    motion = odefun(lambda t, z: [z[0] * (z[1] / 2 - mpf("0.875")), z[1] * (mpf("1.25") - mpf("0.75") * z[0])], 0, [mpf(1), mpf("2.5")])
    wanted = motion(2)
    def end_of(s, theta, energy, start):
        x, y = start
        p, steps = sp.lambdify((X, Y), theta, "mpmath")(x, y), 16
        for _ in range(steps):
            x, y, p = first_order_step(s, mpf(2) / steps, theta, energy, x, y, p)
        return x, y
    distance = lambda one, other: max(abs(a - b) for a, b in zip(one, other))
    start = mpf(1), mpf("2.5")
    for s, printed in [(1, ["4.7e-4", "1.7e-3", "4.0e-2"]), (2, ["8.8e-6", "5.5e-6", "8.2e-5"])]:
        plain = end_of(s, sp.log(Y) / X, H(X, Y), start)
        exchanged = end_of(s, -sp.log(Y) / X, H(Y, X), start[::-1])[::-1]
        bent = end_of(s, sp.log(Y) / X + X**2, H(X, Y), start)
        for end, digits in zip([plain, exchanged, bent], printed):
            close(distance(end, wanted) / mpf(digits), claim(mpf(1), by="1/5"), "0.05")
        shifted = end_of(s, sp.log(Y) / X + 3 * X, H(X, Y), start)
        for found, same_as in zip(shifted, plain):
            close(found, claim(same_as), "1e-18")
