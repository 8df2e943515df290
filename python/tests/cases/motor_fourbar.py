"""mujoco#172, #2698: a four-bar linkage driven hard by a motor comes apart (equality constraint).
Here: crank-rocker in angles, closed by two constraints, motor torque as an input that grows; Right: ODE in the crank angle
(loop solved by Newton), scipy DOP853."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

F = vi.System("""
struct Motor {
    const N = 3;
    param l[N] = [1.0, 3.0, 2.5], m[N] = [0.5, 1.5, 1.2], d = 3.2, g = 9.81;
    input torque = 0.0;
    angle q[N];
    let x1 = l[0] * cos(q[0]), y1 = l[0] * sin(q[0]);
    let x2 = x1 + l[1] * cos(q[1]), y2 = y1 + l[1] * sin(q[1]);
    let c[0] = [x1 / 2, y1 / 2];
    let c[1] = [(x1 + x2) / 2, (y1 + y2) / 2];
    let c[2] = [d + l[2] * cos(q[2]) / 2, l[2] * sin(q[2]) / 2];
    L = sum(i in 0..N, m[i] * dot(c[i]) * dot(c[i]) / 2 + m[i] * l[i]^2 * dot(q[i])^2 / 24 - m[i] * g * c[i][1]);
    constraint closed = [x2 - d - l[2] * cos(q[2]), y2 - l[2] * sin(q[2])];
    force q[0] = torque;
}
""")
l, m, d, g = np.array([1.0, 3.0, 2.5]), np.array([0.5, 1.5, 1.2]), 3.2, 9.81


def close(a, b, c):
    for _ in range(50):
        r = np.array(
            [
                l[0] * np.cos(a) + l[1] * np.cos(b) - d - l[2] * np.cos(c),
                l[0] * np.sin(a) + l[1] * np.sin(b) - l[2] * np.sin(c),
            ]
        )
        J = np.array([[-l[1] * np.sin(b), l[2] * np.sin(c)], [l[1] * np.cos(b), -l[2] * np.cos(c)]])
        s = np.linalg.solve(J, r)
        b -= s[0]
        c -= s[1]
        if np.abs(s).max() < 1e-15:
            break
    return b, c


def rhs(t, s, torque):
    a, b, c, w = s
    b, c = close(a, b, c)
    J = np.array([[-l[1] * np.sin(b), l[2] * np.sin(c)], [l[1] * np.cos(b), -l[2] * np.cos(c)]])
    k = np.linalg.solve(J, [l[0] * np.sin(a), -l[0] * np.cos(a)])  # b', c' per a'
    v = np.array([1.0, k[0], k[1]]) * w

    # full mass matrix and forces in (a, b, c)
    def kin(q):
        def e(x):
            return np.array([-np.sin(x), np.cos(x)])

        J0 = np.zeros((2, 3))
        J0[:, 0] = l[0] / 2 * e(q[0])
        J1 = np.zeros((2, 3))
        J1[:, 0] = l[0] * e(q[0])
        J1[:, 1] = l[1] / 2 * e(q[1])
        J2 = np.zeros((2, 3))
        J2[:, 2] = l[2] / 2 * e(q[2])
        return J0, J1, J2

    q = np.array([a, b, c])
    Js = kin(q)
    M = sum(m[i] * Js[i].T @ Js[i] for i in range(3)) + np.diag(m * l**2 / 12)

    def u(x):
        return -np.array([np.cos(x), np.sin(x)])

    # accelerations of centres at zero q''
    A0 = l[0] / 2 * u(a) * v[0] ** 2
    A1 = l[0] * u(a) * v[0] ** 2 + l[1] / 2 * u(b) * v[1] ** 2
    A2 = l[2] / 2 * u(c) * v[2] ** 2
    f = -sum(m[i] * Js[i].T @ (A + np.array([0, g])) for i, A in enumerate((A0, A1, A2)))
    f[0] += torque(t)
    G = np.array(
        [
            [-l[0] * np.sin(a), -l[1] * np.sin(b), l[2] * np.sin(c)],
            [l[0] * np.cos(a), l[1] * np.cos(b), -l[2] * np.cos(c)],
        ]
    )
    gam = -(l[0] * u(a) * v[0] ** 2 + l[1] * u(b) * v[1] ** 2 - l[2] * u(c) * v[2] ** 2)
    K = np.block([[M, G.T], [G, np.zeros((2, 2))]])
    acc = np.linalg.solve(K, np.concatenate([f, gam]))
    return [w, v[1], v[2], acc[0]]


a0 = 0.4
b0, c0 = close(a0, 0.9, 1.7)
T = 2.0
n = 400
h = T / n


def torque(t):
    return 4.0 * (1 + np.floor(t / 0.5 + 1e-9))  # 4, 8, 12, 16 Nm


s = np.array([a0, b0, c0, 0.0])
for i in range(4):
    s = solve_ivp(
        lambda t, y: rhs(t, y, lambda _: 4.0 * (i + 1)),
        [0.5 * i, 0.5 * (i + 1)],
        s,
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    ).y[:, -1]
sysm = F()
start = sysm.project([a0, 0.9, 1.7], [0, 0, 0])
print("closed from a guess:", start.q, [a0, b0, c0])
run = sysm.integrate([a0, b0, c0], [0.0, 0.0, 0.0], h=h)


def fb(r):
    r.set(torque=torque(r.t))


fb(run)
sol = run.until(T, callback=fb)
err = np.abs(np.array(run.q) - s[:3]).max()
print("turns of the crank", s[0] / (2 * np.pi), "speed", s[3], "error", err, "residual", sol.residual.max())
assert sol.residual.max() < 1e-12 and err < 1e-5, err
run = sysm.integrate([a0, b0, c0], [0.0, 0.0, 0.0], h=h / 4)
fb(run)
run.until(T, callback=fb)
err4 = np.abs(np.array(run.q) - s[:3]).max()
print("h/4:", err4)
assert err4 < err / 500 or err4 < 1e-9


# Faster: 60, 120, 180, 240 Nm, 26 turns of the crank, up to 240 rad/s.
def fast(t):
    return 60.0 * (1 + np.floor(t / 0.5 + 1e-9))


s = np.array([a0, b0, c0, 0.0])
for i in range(4):
    s = solve_ivp(
        lambda t, y: rhs(t, y, lambda _: 60.0 * (i + 1)),
        [0.5 * i, 0.5 * (i + 1)],
        s,
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    ).y[:, -1]
run = sysm.integrate([a0, b0, c0], [0.0, 0.0, 0.0], h=0.0005)


def fb2(r):
    r.set(torque=fast(r.t))


fb2(run)
sol = run.until(2.0, every=10, callback=fb2)
print(
    "fast: turns",
    s[0] / (2 * np.pi),
    "error",
    np.abs(np.array(run.q) - s[:3]).max(),
    "residual",
    sol.residual.max(),
    "turns counted",
    run.q[0] / (2 * np.pi),
)
