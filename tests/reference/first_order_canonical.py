"""The values of `first_order.json` by another way: `python tests/reference/first_order_canonical.py`.

y is eliminated by hand, y = y(x, p). K(t, x, p) = H(t, x, y(x, p)) is an ordinary Hamiltonian; a Gauss step is collocation
of ẋ = K_p, ṗ = −K_x by fixed-point iteration, with derivatives by central differences in 120 digits. ϑ and H are written
anew. The exact motion is extrapolated from explicit midpoint steps of these equations. The program ends with an error if a
value differs by more than 1e-39.
"""

import json
from pathlib import Path

from mpmath import asinh, cos, exp, hypot, log, mp, mpf, pi, polyroots, sin, sinh, sqrt, taylor, legendre

mp.dps = 120
SMALL = mpf(10) ** -40
G = [mpf(5) / 4, -mpf(3) / 4, mpf(7) / 8, mpf(3) / 2]


class Vortices:
    # p = G y.
    def y(self, t, x, p):
        return [p[a] / G[a] for a in range(4)]

    def p(self, t, x, y):
        return [G[a] * y[a] for a in range(4)]

    def H(self, t, x, y):
        return -sum(G[a] * G[b] * log(hypot(x[a] - x[b], y[a] - y[b])) for a in range(4) for b in range(a + 1, 4)) / (2 * pi)


class LotkaVolterra:
    # p = ln(y)/x.
    def y(self, t, x, p):
        return [exp(p[0] * x[0])]

    def p(self, t, x, y):
        return [log(y[0]) / x[0]]

    def H(self, t, x, y):
        return mpf("0.5") * y[0] - mpf("0.875") * log(y[0]) + mpf("0.75") * x[0] - mpf("1.25") * log(x[0])


class Particle:
    """The method's x is the coordinate y, and its y is x."""

    def __init__(self, forced):
        self.forced = forced

    def field(self, t):
        return mpf("1.5") * (1 + sin(t) / 2 if self.forced else 1)

    def y(self, t, x, p):
        # The real root of X³ + 3 (4 + Y²) X = 12 p/B.
        c = 4 + x[0] ** 2
        return [2 * sqrt(c) * sinh(asinh(6 * p[0] / (self.field(t) * c * sqrt(c))) / 3)]

    def p(self, t, x, y):
        return [self.field(t) * y[0] * (1 + (y[0] ** 2 / 3 + x[0] ** 2) / 4)]

    def H(self, t, x, y):
        drive = y[0] * cos(t) / 2 if self.forced else 0
        return mpf("1.25") * (cos(y[0]) + sin(mpf("0.75") * x[0])) + drive

    def forces(self, x, y, v):
        """The force of the method's x and the force of its y."""
        return [-v[0] / 8], [-y[0] / 16]


class GuidingCentre:
    """ϑ(x, y) = p by Newton's iteration, with derivatives of ϑ by differences."""

    B0, R0, q, mu = mpf("1.25"), mpf("1.5"), mpf("1.75"), mpf(1) / 2048

    def field(self, x, y):
        theta, r = x[0], y[0]
        toroidal, poloidal = self.B0 * (1 - r / self.R0 * cos(theta)), self.B0 * r / self.q / (self.R0 + r * cos(theta))
        return toroidal, poloidal, hypot(toroidal, poloidal)

    def p(self, t, x, y):
        theta, (r, u) = x[0], y
        toroidal, poloidal, B = self.field(x, y)
        potential = self.B0 * r**2 * (mpf(1) / 2 - r * cos(theta) / (3 * self.R0)), -self.B0 * r**2 / (2 * self.q)
        return [potential[0] + u * poloidal * r / B, potential[1] + u * toroidal * (self.R0 + r * cos(theta)) / B]

    def y(self, t, x, p):
        r, u = getattr(self, "near", (mpf("0.375"), mpf("0.015625")))
        for _ in range(60):
            found = self.p(t, x, [r, u])
            by_r = [(a - b) / (2 * SMALL) for a, b in zip(self.p(t, x, [r + SMALL, u]), self.p(t, x, [r - SMALL, u]))]
            by_u = [(a - b) / (2 * SMALL) for a, b in zip(self.p(t, x, [r, u + SMALL]), self.p(t, x, [r, u - SMALL]))]
            miss, det = [a - b for a, b in zip(p, found)], by_r[0] * by_u[1] - by_u[0] * by_r[1]
            change = (miss[0] * by_u[1] - by_u[0] * miss[1]) / det, (by_r[0] * miss[1] - miss[0] * by_r[1]) / det
            r, u = r + change[0], u + change[1]
            if abs(change[0]) + abs(change[1]) < mpf(10) ** -70:
                # One more iteration doubles these digits.
                self.near = r, u
                return [r, u]
        raise ArithmeticError("no y")

    def H(self, t, x, y):
        return y[1] ** 2 / 2 + self.mu * self.field(x, y)[2]


class Wave:
    def y(self, t, x, p):
        return p

    p = y

    def H(self, t, x, y):
        (q,), (p,) = x, y
        return hypot(mpf("1.25"), p) + p**4 / 6 + p * cos(mpf("0.875") * q) / 2 + sin(q)


class Flow(Wave):
    def H(self, t, x, y):
        (a, b), (p, s) = x, y
        return p * b - s * (mpf("1.5625") * sin(a) + b / 8) + mpf("0.75") * b * cos(a)


SYSTEMS = {
    "vortices": Vortices(),
    "lotka_volterra": LotkaVolterra(),
    "massless_particle": Particle(False),
    "driven_particle": Particle(True),
    "guiding_centre": GuidingCentre(),
    "wave": Wave(),
    "flow": Flow(),
}


def slopes(function, point):
    """The gradient of a function of (x, p), by central differences."""
    moved = lambda k, by: function([z + by * (j == k) for j, z in enumerate(point)])
    return [(moved(k, SMALL) - moved(k, -SMALL)) / (2 * SMALL) for k in range(len(point))]


def rates(system, t, z):
    """(ẋ, ṗ) at (x, p)."""
    n = len(z) // 2
    K = lambda z: system.H(t, z[:n], system.y(t, z[:n], z[n:]))
    slope = slopes(K, z)
    x_dot, p_dot = slope[n:], [-of for of in slope[:n]]
    if getattr(system, "forced", False):
        # For one coordinate: ϑ_y ẋ = H_y − f_y, and ṗ = ϑ_x ẋ − H_x + f_x, so that f_y adds −f_y y_p to ẋ and f_y y_x to ṗ.
        x, y = z[:1], system.y(t, z[:1], z[1:])
        y_x, y_p = slopes(lambda z: system.y(t, z[:1], z[1:])[0], z)
        f_y = system.forces(x, y, x_dot)[1][0]
        x_dot = [x_dot[0] - f_y * y_p]
        p_dot = [p_dot[0] + f_y * y_x + system.forces(x, y, x_dot)[0][0]]
    return x_dot + p_dot


def gauss(s):
    """Nodes, weights and coefficients of Gauss, by integrals of Lagrange polynomials."""
    nodes = sorted((1 + root) / 2 for root in polyroots(taylor(lambda u: legendre(s, u), 0, s)[::-1], maxsteps=500, extraprec=2000))
    def integral(j, end):
        powers = [mpf(1)]
        for k in range(s):
            if k != j:
                longer = [mpf(0)] + powers
                powers = [(a - nodes[k] * b) / (nodes[j] - nodes[k]) for a, b in zip(longer, powers + [mpf(0)])]
        return sum(c * end ** (k + 1) / (k + 1) for k, c in enumerate(powers))
    return nodes, [integral(j, 1) for j in range(s)], [[integral(j, c) for j in range(s)] for c in nodes]


def step(system, tableau, t, z, h):
    """The end (x, p) of a step."""
    nodes, weights, coefficients = tableau
    s, size = len(nodes), len(z)
    slope = [rates(system, t, z)] * s
    for _ in range(400):
        stages = [[z[k] + h * sum(row[j] * slope[j][k] for j in range(s)) for k in range(size)] for row in coefficients]
        new = [rates(system, t + c * h, stage) for c, stage in zip(nodes, stages)]
        change = max(abs(a - b) for one, other in zip(slope, new) for a, b in zip(one, other))
        slope = new
        if change < mpf(10) ** -50:
            return [z[k] + h * sum(b * of[k] for b, of in zip(weights, slope)) for k in range(size)]
    raise ArithmeticError("the stages do not converge")


def exact(system, t, z, h):
    """(x, p) after the time h, by the extrapolation of Gragg, Bulirsch and Stoer."""
    rows, last = [], None
    for level in range(1, 60):
        count = 2 * level
        one = h / count
        before, now = z, [a + one * b for a, b in zip(z, rates(system, t, z))]
        for k in range(1, count + 1):
            after = [a + 2 * one * b for a, b in zip(before, rates(system, t + k * one, now))]
            before, now, middle = now, after, before
        # Gragg's smoothing: z(t − one)/4 + z(t)/2 + z(t + one)/4, at the end.
        row = [[(a + 2 * b + c) / 4 for a, b, c in zip(middle, before, now)]]
        for k, previous in enumerate(rows[-1] if rows else []):
            ratio = (mpf(count) / (count - 2 * (k + 1))) ** 2
            row.append([a + (a - b) / (ratio - 1) for a, b in zip(row[k], previous)])
        rows.append(row)
        if last is not None and max(abs(a - b) for a, b in zip(row[-1], last)) < mpf(10) ** -44:
            return row[-1]
        last = row[-1]
    raise ArithmeticError("no convergence")


def main():
    file = json.loads(Path(__file__).with_name("first_order.json").read_text(encoding="utf-8"))
    numbers = lambda row: [mpf(text) for text in row]
    worst = mpf(0)
    for name, system in SYSTEMS.items():
        of = file[name]
        h, x, y = mpf(of["h"]), numbers(of["start"]["x"]), numbers(of["start"]["y"])
        start = x + system.p(mpf(0), x, y)
        n, steps_off, exact_off = len(x), mpf(0), mpf(0)

        def off(t, z, node):
            wanted = numbers(node["x"] + node["y"] + node.get("p", []))
            found = z[:n] + system.y(t, z[:n], z[n:]) + z[n:]
            return max(abs(a - b) for a, b in zip(wanted, found))

        for s, nodes in of["gauss"].items():
            tableau, z, nodes = gauss(int(s)), start, {node["step"]: node for node in nodes}
            for k in range(max(nodes)):
                z = step(system, tableau, k * h, z, h)
                if k + 1 in nodes:
                    steps_off = max(steps_off, off((k + 1) * h, z, nodes[k + 1]))
        z, nodes = start, {node["step"]: node for node in of["exact"]}
        for k in range(max(nodes)):
            z = exact(system, k * h, z, h)
            if k + 1 in nodes:
                exact_off = max(exact_off, off((k + 1) * h, z, nodes[k + 1]))
        print(f"{name}: steps differ by {mp.nstr(steps_off, 2)}, exact motions by {mp.nstr(exact_off, 2)}", flush=True)
        worst = max(worst, steps_off, exact_off)
    assert worst < mpf(10) ** -39, worst


main()
