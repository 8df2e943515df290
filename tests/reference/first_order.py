"""Gauss steps of systems of first order, L = ϑ(x, y)·ẋ − H(x, y): `first_order.json`, by the equations of the stages.

    pip install mpmath gmpy2 sympy numpy
    python tests/reference/first_order.py > tests/reference/first_order.json

The unknowns of stage i are V_i = ẋ and Y_i = y; docs/mathematics.md, section 11, has the equations. Derivatives are
symbolic. The exact motion is that of 16 stages and a quarter of the step. `first_order_canonical.py` computes all values
a second time, by another way.
"""

import json
import sys

import mpmath
import numpy as np
import sympy as sp
from mpmath import mp, mpf

mp.dps = 60
STAGES = [1, 2, 4, 8]
STEPS = [1, 2, 10]

t, v = sp.symbols("t v")


class System:
    """A system as the language has it, and by symbols: ϑ, H and the force of x and y."""

    def __init__(self, text, x, y, theta, H, start, h, force=None):
        self.text, self.x, self.y, self.start, self.h = text, x, y, start, h
        n = len(x)
        self.n, self.V = n, sp.symbols(f"v0:{n}")
        force = force or [0] * (2 * n)
        L = sum(a * b for a, b in zip(theta, self.V)) - H
        rows = [*theta, H]
        rows += [sp.diff(L, of) + f for of, f in zip([*x, *y], force)]
        rows += [sp.diff(of, by) for of in theta for by in y]
        # dϑ/dt along the motion without the terms of ẏ.
        rows += [sp.diff(of, t) + sum(sp.diff(of, by) * V for by, V in zip(x, self.V)) for of in theta]
        # ẋ of L_y = 0, which is linear in ẋ: its matrix and its right-hand side.
        of_y = rows[2 * n + 1 : 3 * n + 1]
        rows += [sp.diff(of, V) for of in of_y for V in self.V]
        rows += [of.subs({V: 0 for V in self.V}) for of in of_y]
        self.functions = sp.lambdify([t, *x, *y, *self.V], rows, "mpmath", cse=True)

    def at(self, time, x, y, V):
        """ϑ, H, F = L_x + f_x, L_y + f_y, ϑ_y."""
        n, row = self.n, self.functions(time, *x, *y, *V)
        return row[:n], row[n], row[n + 1 : 2 * n + 1], row[2 * n + 1 : 3 * n + 1], row[3 * n + 1 : 3 * n + 1 + n * n]

    def rate(self, time, z):
        """ẋ and ẏ of the motion, from which the iteration of a step starts."""
        n = self.n
        x, y = z[:n], z[n:]
        rest = 3 * n + 1 + n * n + n
        row = self.functions(time, *x, *y, *[mpf(0)] * n)
        V = list(mpmath.lu_solve(mpmath.matrix(n, n) + table(row[rest : rest + n * n], n), -mpmath.matrix(row[rest + n * n :])))
        row = self.functions(time, *x, *y, *V)
        F, slope = row[n + 1 : 2 * n + 1], row[3 * n + 1 + n * n : rest]
        by_y = table(row[3 * n + 1 : 3 * n + 1 + n * n], n)
        return V + list(mpmath.lu_solve(by_y, mpmath.matrix([f - s for f, s in zip(F, slope)])))


def table(entries, n):
    return mpmath.matrix([[mpf(entries[n * i + j]) for j in range(n)] for i in range(n)])


def gauss(s):
    """Nodes, weights and coefficients of Gauss: a and b integrate the powers up to s − 1."""
    nodes = sorted((1 + mpmath.findroot(lambda u: mpmath.legendre(s, u), guess)) / 2 for guess in np.polynomial.legendre.leggauss(s)[0])
    powers = mpmath.matrix(s, s)
    for k in range(s):
        for j in range(s):
            powers[k, j] = nodes[j] ** k
    row = lambda end: list(mpmath.lu_solve(powers, mpmath.matrix([end ** (k + 1) / (k + 1) for k in range(s)])))
    return nodes, row(mpf(1)), [row(c) for c in nodes]


class Steps:
    """Gauss steps of one system and one length."""

    def __init__(self, system, s, h):
        self.system, self.s, self.h = system, s, h
        self.nodes, self.weights, self.coefficients = gauss(s)

    def stages(self, time, x, p, unknowns):
        """The residuals, and F of each stage."""
        n, s, h = self.system.n, self.s, self.h
        V = [unknowns[2 * n * i : 2 * n * i + n] for i in range(s)]
        Y = [unknowns[2 * n * i + n : 2 * n * i + 2 * n] for i in range(s)]
        values = []
        for i in range(s):
            X = [x[k] + h * sum(self.coefficients[i][j] * V[j][k] for j in range(s)) for k in range(n)]
            values.append(self.system.at(time + self.nodes[i] * h, X, Y[i], V[i]))
        rows = []
        for i in range(s):
            theta, _, _, of_y, _ = values[i]
            rows += [theta[k] - p[k] - h * sum(self.coefficients[i][j] * values[j][2][k] for j in range(s)) for k in range(n)]
            rows += of_y
        return rows, [value[2] for value in values], V

    def linearize(self, time, x, p, unknowns):
        """The inverse of the matrix of Newton's iteration in 16 digits, by differences."""
        size, small = len(unknowns), mpf(10) ** -25
        base = self.stages(time, x, p, unknowns)[0]
        matrix = np.zeros((size, size))
        for k in range(size):
            moved = self.stages(time, x, p, [u + small * (j == k) for j, u in enumerate(unknowns)])[0]
            matrix[:, k] = [float((b - a) / small) for a, b in zip(base, moved)]
        return np.linalg.inv(matrix)

    def step(self, time, x, y, p):
        n, s, h = self.system.n, self.s, self.h
        rate = self.system.rate(time, x + y)
        unknowns = sum((rate[:n] + [a + c * h * b for a, b in zip(y, rate[n:])] for c in self.nodes), [])
        inverse = None
        for _ in range(200):
            rows = self.stages(time, x, p, unknowns)[0]
            size = max(abs(row) for row in rows)
            if size < mpf(10) ** -55:
                break
            if inverse is None or size > last / 100:
                inverse = self.linearize(time, x, p, unknowns)
            last = size
            change = inverse @ np.array([float(row / size) for row in rows])
            unknowns = [u - size * mpf(c) for u, c in zip(unknowns, change)]
        else:
            raise ArithmeticError("the stages do not converge")
        _, F, V = self.stages(time, x, p, unknowns)
        b = self.weights
        x = [x[k] + h * sum(b[i] * V[i][k] for i in range(s)) for k in range(n)]
        p = [p[k] + h * sum(b[i] * F[i][k] for i in range(s)) for k in range(n)]
        return x, self.eliminate(time + h, x, p, unknowns[-n:]), p

    def eliminate(self, time, x, p, y):
        """y of ϑ(x, y) = p, by Newton's iteration from a y."""
        n = self.system.n
        for _ in range(100):
            theta, _, _, _, by_y = self.system.at(time, x, y, [mpf(0)] * n)
            change = mpmath.lu_solve(table(by_y, n), mpmath.matrix([a - b for a, b in zip(p, theta)]))
            y = [a + b for a, b in zip(y, change)]
            if max(abs(c) for c in change) < mpf(10) ** -50:
                return y
        raise ArithmeticError("ϑ(x, y) = p has no solution near the last stage")

    def run(self, start, count):
        """(time, x, y, p) at each node."""
        n = self.system.n
        time, x, y = mpf(0), start[:n], start[n:]
        p = self.system.at(time, x, y, [mpf(0)] * n)[0]
        nodes = [(time, x, y, p)]
        for k in range(count):
            x, y, p = self.step(time, x, y, p)
            time = (k + 1) * self.h
            nodes.append((time, x, y, p))
        return nodes


def names(text):
    return sp.symbols(text, real=True)


def vortices():
    x, y = ([sp.Symbol(f"{of}[{a}]", real=True) for a in range(4)] for of in "xy")
    strength = [sp.Rational(5, 4), sp.Rational(-3, 4), sp.Rational(7, 8), sp.Rational(3, 2)]
    pairs = [(a, b) for a in range(4) for b in range(a)]
    H = -sum(strength[a] * strength[b] * sp.log((x[a] - x[b]) ** 2 + (y[a] - y[b]) ** 2) for a, b in pairs) / (4 * sp.pi)
    text = """struct Vortices {
    param G[4] = [1.25, -0.75, 0.875, 1.5];
    coord x[4], y[4];
    let pairs = sum(a in 0..4, b in 0..a, G[a] * G[b] * ln((x[a] - x[b])^2 + (y[a] - y[b])^2));
    L = sum(a in 0..4, G[a] * y[a] * dot(x[a])) + pairs / (4 * pi);
}"""
    start = ["1", "-0.5", "0.25", "-1.25", "0.125", "0.75", "-1", "-0.5"]
    return System(text, x, y, [strength[a] * y[a] for a in range(4)], H, start, "1")


def lotka_volterra():
    x, y = names("x,"), names("y,")
    a, b, c, d = sp.Rational(5, 4), sp.Rational(3, 4), sp.Rational(1, 2), sp.Rational(7, 8)
    # ẋ = x (c y − d), ẏ = y (a − b x): predators x, prey y.
    H = c * y[0] - d * sp.log(y[0]) + b * x[0] - a * sp.log(x[0])
    text = """struct LotkaVolterra {
    param a = 1.25, b = 0.75, c = 0.5, d = 0.875;
    coord x, y;
    L = ln(y) / x * dot(x) - (c * y - d * ln(y) + b * x - a * ln(x));
}"""
    return System(text, x, y, [sp.log(y[0]) / x[0]], H, ["1", "2.5"], "0.125")


def particle(forced):
    x, y = names("x,"), names("y,")
    B, k, E, w = sp.Rational(3, 2), sp.Rational(1, 4), sp.Rational(5, 4), sp.Rational(3, 4)
    X, Y = x[0], y[0]
    # A = ∫ B (1 + k (x² + y²)) dx, with the velocity of y.
    A = B * (X + k * X**3 / 3 + k * X * Y**2)
    phi = E * (sp.cos(X) + sp.sin(w * Y))
    text = """struct {}Particle {{
    param B = 1.5, k = 0.25, E = 1.25, w = 0.75{};
    coord x, y;
    L = B * (x + k * x^3 / 3 + k * x * y^2) * dot(y) - E * (cos(x) + sin(w * y)){};{}
}}"""
    start, h = ["0.5", "0.25"], "0.125"
    if not forced:
        return System(text.format("Massless", "", "", ""), y, x, [A], phi, start[::-1], h)
    # A field that depends on the time, a wave, friction against the drift, and a force across it.
    c, d, g = sp.Rational(1, 8), sp.Rational(1, 2), sp.Rational(1, 16)
    A, phi = A * (1 + d * sp.sin(t)), phi + d * X * sp.cos(t)
    clauses = "\n    force y = -c * dot(y);\n    force x = -g * x;"
    text = f"""struct DrivenParticle {{
    param B = 1.5, k = 0.25, E = 1.25, w = 0.75, c = 0.125, d = 0.5, g = 0.0625;
    coord x, y;
    L = B * (1 + d * sin(t)) * (x + k * x^3 / 3 + k * x * y^2) * dot(y) - E * (cos(x) + sin(w * y)) - d * x * cos(t);{clauses}
}}"""
    return System(text, y, x, [A], phi, start[::-1], h, [-c * sp.Symbol("v0"), -g * X])


def guiding_centre():
    theta, phi, r, u = names("theta phi r u")
    B0, R0, q, mu = sp.Rational(5, 4), sp.Rational(3, 2), sp.Rational(7, 4), sp.Rational(1, 2048)
    R = R0 + r * sp.cos(theta)
    A_theta = B0 * (r**2 / 2 - r**3 * sp.cos(theta) / (3 * R0))
    A_phi = -B0 * r**2 / (2 * q)
    # The toroidal and the poloidal component of B = ∇ × A.
    T, P = B0 * (1 - r * sp.cos(theta) / R0), B0 * r / (q * R)
    B = sp.sqrt(T**2 + P**2)
    b_theta, b_phi = r * P / B, R * T / B
    text = """struct GuidingCentre {
    param B0 = 1.25, R0 = 1.5, q = 1.75, mu = 0.00048828125;
    coord theta, phi, r, u;
    let R = R0 + r * cos(theta);
    let toroidal = B0 * (1 - r * cos(theta) / R0);
    let poloidal = B0 * r / (q * R);
    let B = hypot(toroidal, poloidal);
    let A_theta = B0 * (r^2 / 2 - r^3 * cos(theta) / (3 * R0)), A_phi = -B0 * r^2 / (2 * q);
    L = (A_theta + u * r * poloidal / B) * dot(theta) + (A_phi + u * R * toroidal / B) * dot(phi) - u^2 / 2 - mu * B;
}"""
    return System(
        text, [theta, phi], [r, u], [A_theta + u * b_theta, A_phi + u * b_phi], u**2 / 2 + mu * B, ["0.25", "0", "0.375", "0.015625"], "16"
    )


def wave():
    x, y = names("q,"), names("p,")
    m, a, k, d = sp.Rational(5, 4), sp.Rational(3, 4), sp.Rational(7, 8), sp.Rational(1, 2)
    H = sp.sqrt(m**2 + y[0] ** 2) + y[0] ** 4 / (8 * a) + d * sp.cos(k * x[0]) * y[0] + sp.sin(x[0])
    text = """struct Wave {
    param m = 1.25, a = 0.75, k = 0.875, d = 0.5;
    coord q;
    momentum p of q;
    H = sqrt(m^2 + p^2) + p^4 / (8 * a) + d * cos(k * q) * p + sin(q);
}"""
    return System(text, x, y, list(y), H, ["0.5", "0.75"], "0.125")


def flow():
    x, y = names("a b"), names("p s")
    w, k, c = sp.Rational(5, 4), sp.Rational(3, 4), sp.Rational(1, 8)
    H = y[0] * x[1] - y[1] * (w**2 * sp.sin(x[0]) + c * x[1]) + k * sp.cos(x[0]) * x[1]
    text = """struct Flow {
    param w = 1.25, k = 0.75, c = 0.125;
    coord a, b;
    momentum p of a, s of b;
    H = p * b - s * (w^2 * sin(a) + c * b) + k * cos(a) * b;
}"""
    return System(text, x, y, list(y), H, ["0.5", "0.25", "-0.75", "1"], "0.125")


SYSTEMS = {
    "vortices": vortices,
    "lotka_volterra": lotka_volterra,
    "massless_particle": lambda: particle(False),
    "driven_particle": lambda: particle(True),
    "guiding_centre": guiding_centre,
    "wave": wave,
    "flow": flow,
}


def digits(values):
    return [mpmath.nstr(value, 40) for value in values]


def values(name):
    """The entry of a system in the file."""
    system = SYSTEMS[name]()
    start = [mpf(value) for value in system.start]
    h, n = mpf(system.h), system.n
    steps = {}
    for s in STAGES:
        nodes = Steps(system, s, h).run(start, max(STEPS))
        steps[s] = [{"step": k, "x": digits(nodes[k][1]), "y": digits(nodes[k][2]), "p": digits(nodes[k][3])} for k in STEPS]
    motion = Steps(system, 16, h / 4).run(start, 4 * max(STEPS))
    exact = [{"step": k, "x": digits(motion[4 * k][1]), "y": digits(motion[4 * k][2])} for k in STEPS]
    print(name, file=sys.stderr)
    return {
        "text": system.text,
        "x": [str(of) for of in system.x],
        "y": [str(of) for of in system.y],
        "h": system.h,
        "start": {"x": system.start[:n], "y": system.start[n:]},
        "gauss": steps,
        "exact": exact,
    }


def main():
    about = (
        "first_order.py: Gauss steps of L = ϑ(x, y)·ẋ − H(x, y). x: coordinates whose velocity is in L, y: the others; with H "
        "coordinates and momenta. h, start and parameters are exact in binary. gauss: by the number of stages, x, y and "
        "p = ϑ(x, y) after step k. exact: the motion at the same times. 40 digits; first_order_canonical.py finds them "
        "another way, to 5e-40."
    )
    print(json.dumps({"_about": about} | {name: values(name) for name in SYSTEMS}, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
