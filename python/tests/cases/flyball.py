"""IFToMM benchmark A05, stiff flyball governor (couplers are springs with K = 8e5, C = 4e4). Here by rotations, joints and constraints, and in
angles; Right: three coordinates (symmetric motion), Radau at 1e-11."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

common = """
    param M = 5.0, m = 0.3, S = 3.0, K = 8e5, C = 4e4, r0 = 0.5, g = 9.81, Jshaft = 0.000005, Js = 0.005, Jr = 0.025;
"""
A = vi.System(
    """
struct Angles {"""
    + common
    + """
    coord turn1, a[2], s;
    let u[0] = a[0], u[1] = a[1];
    // rods of length 1 hang from the top of the shaft (height 1); masses at their ends; couplers from their middles to the slider at s
    let len[i in 0..2] = hypot(sin(a[i]) / 2, 1 - cos(a[i]) / 2 - s);
    L = (Jshaft + Js) * dot(turn1)^2 / 2 + S * dot(s)^2 / 2 - S * g * s
        + sum(i in 0..2, (Jr + m / 4 + M) * (dot(a[i])^2 + sin(a[i])^2 * dot(turn1)^2) / 2 + (M + m / 2) * g * cos(a[i]) - K * (len[i] - r0)^2 / 2);
    dissipation = sum(i in 0..2, C * dot(len[i])^2 / 2);
}
""".replace("    let u[0] = a[0], u[1] = a[1];\n", "")
)
M, m, S, K, C, r0, g, J0, Jr = 5.0, 0.3, 3.0, 8e5, 4e4, 0.5, 9.81, 0.005005, 0.025
I = Jr + m / 4 + M
G = (M + m / 2) * g


def rhs(t, y):
    _f, a, s, w, u, v = y
    dx, dy = np.sin(a) / 2, 1 - np.cos(a) / 2 - s
    l = np.hypot(dx, dy)
    la, ls = (dx * np.cos(a) / 2 + dy * np.sin(a) / 2) / l, -dy / l
    T = K * (l - r0) + C * (la * u + ls * v)
    J = J0 + 2 * I * np.sin(a) ** 2
    return [
        w,
        u,
        v,
        -4 * I * np.sin(a) * np.cos(a) * u * w / J,
        np.sin(a) * np.cos(a) * w * w - (G * np.sin(a) + T * la) / I,
        -g - 2 * T * ls / S,
    ]


a0 = np.radians(30.0)
s0 = 1 - np.cos(a0) / 2 - np.sqrt(0.25 - (np.sin(a0) / 2) ** 2)
w0 = 2 * np.pi
y0 = [0.0, a0, s0, w0, 0.0, 0.0]
ref = solve_ivp(rhs, [0, 2], y0, method="Radau", rtol=1e-11, atol=1e-12).y[:, -1]
sys1 = A()
for kw in ({"h": 0.002}, {"h": 0.0005}):
    try:
        sol = sys1.integrate([0.0, a0, a0, s0], [w0, 0.0, 0.0, 0.0], stages=4, **kw).until(2.0)
        got = sol.q[-1]
        print(kw, got, ref[:3], "error", abs(got[0] - ref[0]), abs(got[1] - ref[1]), abs(got[3] - ref[2]))
    except vi.StepError as x:
        print(kw, type(x).__name__, x)
assert abs(got[1] - ref[1]) < 1e-7 and abs(got[3] - ref[2]) < 1e-7
# stiff limit as a constraint: couplers rigid
B = vi.System(
    """
struct Rigid {"""
    + common.replace(", K = 8e5, C = 4e4", "")
    + """
    rotation R;
    coord a[2], s;
    // the shaft turns with R about z; rods in its x-z plane
    let w = spin(R)[2];
    let h = 0;
    L = (Jshaft + Js) * w^2 / 2 + S * dot(s)^2 / 2 - S * g * s
        + sum(i in 0..2, (Jr + m / 4 + M) * (dot(a[i])^2 + sin(a[i])^2 * w^2) / 2 + (M + m / 2) * g * cos(a[i]));
    let axis = turn(R, [0, 0, 1]);
    constraint upright = [axis[0], axis[1]];
    constraint coupler[i in 0..2] = (sin(a[i]) / 2)^2 + (1 - cos(a[i]) / 2 - s)^2 - r0^2;
}
""".replace("    let h = 0;\n", "").replace("let w = spin(R)[2];", "let om = spin(R);\n    let w = om[2];")
)
b = B()
st = b.project([1, 0, 0, 0, a0, a0, s0], [0, 0, 0, w0 / 2, 0, 0, 0])
sol = b.integrate(st.q, st.v, h=0.005).until(2.0)


def rig(t, y):
    # s by a: (s - 1 + cos a/2)^2 = 1/4 - sin^2/4
    _f, a, w, u = y
    # rhombus: couplers and half rods are 1/2: s = 1 - cos a
    J = J0 + 2 * I * np.sin(a) ** 2
    Ma = 2 * I + S * np.sin(a) ** 2
    return [
        w,
        u,
        -4 * I * np.sin(a) * np.cos(a) * u * w / J,
        (
            2 * I * np.sin(a) * np.cos(a) * w * w
            - S * np.sin(a) * np.cos(a) * u * u
            - 2 * G * np.sin(a)
            - S * g * np.sin(a)
        )
        / Ma,
    ]


r = solve_ivp(rig, [0, 2], [0.0, a0, w0, 0.0], method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
ang = 2 * np.arctan2(sol.q[-1, 3], sol.q[-1, 0])
print(
    "rigid: a",
    sol.q[-1, 4],
    r[1],
    "turn",
    (ang - r[0]) / (2 * np.pi),
    "error",
    abs(sol.q[-1, 4] - r[1]),
    "energy",
    np.ptp(sol.energy),
)
assert abs(sol.q[-1, 4] - r[1]) < 1e-8 and abs((ang - r[0]) / (2 * np.pi) - round((ang - r[0]) / (2 * np.pi))) < 1e-8
