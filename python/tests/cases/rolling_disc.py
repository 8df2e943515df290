"""sympy#27631: the disc rolling on a plane, by Lagrange, gives wrong equations in a manual.
Right: the equations of a uniform disc, integrated by scipy DOP853 at 1e-13."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

Disc = vi.System("""
/// Disc on a plane: yaw a, lean b, spin c.
struct Disc {
    param m = 2.5, r = 0.4, g = 9.81;
    coord x, y;
    angle a, b, c;
    let wx = dot(b), wy = dot(a) * sin(b) + dot(c), wz = dot(a) * cos(b);
    let z = r * cos(b);
    L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2 + m * r^2 * (wx^2 / 8 + wy^2 / 4 + wz^2 / 8) - m * g * z;
    let lx = [cos(a), sin(a)], ly = [-sin(a) * cos(b), cos(a) * cos(b)];
    constraint roll = [dot(x), dot(y)] - r * (wy * lx - wx * ly);
}
""")
d = Disc()
r, g = 0.4, 9.81


def rhs(t, s):
    _x, _y, q1, q2, _q3, u1, u2, u3 = s
    wx, wy = u2, u1 * np.sin(q2) + u3
    lx, ly = np.array([np.cos(q1), np.sin(q1)]), np.array([-np.sin(q1) * np.cos(q2), np.cos(q1) * np.cos(q2)])
    v = r * (wy * lx - wx * ly)
    return [
        *v,
        u1,
        u2,
        u3,
        -2 * u2 * u3 / np.cos(q2),
        4 * g * np.sin(q2) / (5 * r) + np.sin(2 * q2) * u1**2 / 2 + 6 * np.cos(q2) * u1 * u3 / 5,
        -(10 * np.cos(q2) * u1 - 12 * np.tan(q2) * u3) * u2 / 6,
    ]


s0 = np.array([0.1, -0.2, 0.3, 0.2, 0.0, -0.4, 0.1, 7.0])
q = s0[:5]
v = np.array(rhs(0, s0)[:5])
a = d.acceleration(0.0, q, v)
print("accelerations", np.abs(a[2:] - rhs(0, s0)[5:]).max())
assert np.allclose(a[2:], rhs(0, s0)[5:], atol=1e-11)
ref = solve_ivp(rhs, [0, 5], s0, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
sol = d.integrate(q, v, h=0.005, stages=4).until(5.0)
err = np.abs(sol.q[-1] - ref[:5]).max()
print("t=5 error", err, "energy drift", np.ptp(sol.energy), "residual", sol.residual.max())
assert err < 1e-9 and np.ptp(sol.energy) < 1e-9 and sol.residual.max() < 1e-12
run = d.integrate(q, v, h=0.01, method="energy", stages=2, shift_from=1.0)
e = run.step().discrete_energy if run.shift is None else run.step().shifted_energy
run.until(5.0)
e1 = run.discrete_energy if run.shift is None else run.shifted_energy
print("energy method: kept to", abs(e1 - e), "error", np.abs(run.q - ref[:5]).max())
assert abs(e1 - e) < 1e-11 and np.abs(run.q - ref[:5]).max() < 1e-4
