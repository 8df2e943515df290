"""sympy#24669: a disc rolls without slip on an uneven road y = a cos(k x); the energy was not constant.
The rolling condition r*phi' + sqrt(1 + f'^2) x' = 0 is integrable, but not in closed form: it has to be a velocity constraint,
or a position constraint with a table. Right: one-coordinate ODE in x, scipy DOP853."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

text = """
struct Street {
    param m = 1.0, r = 0.5, g = 9.81, a = 0.3, k = 1.2;
    coord x, phi;
    fn hill(s) = a * cos(k * s);
    let fp = -a * k * sin(k * x);
    let n = sqrt(1 + fp^2);
    let cx = x - r * fp / n, cy = hill(x) + r / n;
    L = m * (dot(cx)^2 + dot(cy)^2) / 2 + m * r^2 * dot(phi)^2 / 4 - m * g * cy;
    constraint roll = r * dot(phi) + W;
}
"""
# Rolling on a curve: the velocity of the centre is r * omega along the tangent; v_c = s' (1 - r kappa), so the turn is
# phi' = -s'(1/r - kappa)... written by the centre: r * phi' + (cx' + fp cy')/n = 0.
text = text.replace("W", "(dot(cx) + fp * dot(cy)) / n")
m, r, g, a, k = 1.0, 0.5, 9.81, 0.3, 1.2


def geom(x):
    fp, fpp = -a * k * np.sin(k * x), -a * k * k * np.cos(k * x)
    n = np.sqrt(1 + fp * fp)
    return fp, fpp, n


def speed(x):  # speed of the centre per x': d/dx (cx, cy) along the tangent
    _fp, fpp, n = geom(x)
    kappa = fpp / n**3
    return n * (1 - r * kappa)


def height(x):
    _fp, _fpp, n = geom(x)
    return a * np.cos(k * x) + r / n


def rhs(t, s):
    x, v = s
    # L = 3/4 m S(x)^2 v^2 - m g h(x)
    S = speed(x)
    dS = (speed(x + 1e-4) * 8 - speed(x - 1e-4) * 8 - speed(x + 2e-4) + speed(x - 2e-4)) / (12e-4)
    dh = (height(x + 1e-4) * 8 - height(x - 1e-4) * 8 - height(x + 2e-4) + height(x - 2e-4)) / (12e-4)
    return [v, (-m * g * dh - 1.5 * m * S * dS * v * v) / (1.5 * m * S * S)]


ref = solve_ivp(rhs, [0, 4], [0.3, 2.0], method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
try:
    S = vi.System(text)
    print("as written")
except vi.CompileError as e:
    print("refused:", str(e).splitlines()[0], "|", str(e).splitlines()[-1].strip())
    # The way out that no message names: an input in the constraint.
    S = vi.System(
        text.replace("dot(cy)) / n;", "dot(cy)) / n - slip;").replace("coord x", "input slip = 0.0;\n    coord x")
    )
    print("with an input of 0")
s = S()
st = s.project([0.3, 0.0], [2.0, 0.0])
v = np.array([2.0, -speed(0.3) * 2.0 / r])
sol = s.integrate([0.3, 0.0], v, h=0.01).until(4.0)
print(sol.q[-1], ref, abs(sol.q[-1, 0] - ref[0]), np.ptp(sol.energy))
assert abs(sol.q[-1, 0] - ref[0]) < 1e-8
