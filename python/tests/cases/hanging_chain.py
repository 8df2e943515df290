"""JuliaComputing/Multibody.jl#80 (chain without springs between two points): states of rotation matrices, fails to simulate.
Here: 12 uniform links (40 take minutes to build) between two nails, in positions of the joints; equilibrium, reactions, small oscillations, motion after a pull.
Right: discrete catenary by scipy fsolve in angles; frequencies by a projected eigenproblem written out; energy."""

import numpy as np
import scipy.linalg as sl
from scipy.optimize import fsolve

import variational as vi

S = vi.System("""
struct Hanging {
    const N = 12;
    param len = 2.0, span = 1.5, drop = 0.3, rho = 1.2, g = 9.81;
    coord r[N - 1][2];
    let l = len / N;
    let a[0] = [0, 0];
    let a[i in 1..N] = r[i - 1];
    let b[i in 0..N - 1] = r[i];
    let b[N - 1] = [span, -drop];
    let u[i in 0..N] = dot(a[i]);
    let w[i in 0..N] = dot(b[i]);
    L = sum(i in 0..N, rho * l * (u[i] * u[i] + u[i] * w[i] + w[i] * w[i]) / 6 - rho * l * g * (a[i][1] + b[i][1]) / 2);
    constraint link[i in 0..N] = (b[i] - a[i]) * (b[i] - a[i]) - l^2;
}
""")
N, le, span, drop, rho, g = 12, 2.0, 1.5, 0.3, 1.2, 9.81
l = le / N
m = rho * l


# uniform links: tension at the joints (H, V_k); direction of link k is that of the mean of its two end forces
def shape(hv):
    H, V = hv
    k = np.arange(N)
    Vm = V + m * g * (k + 0.5)
    return np.arctan2(Vm, H)


def gap(hv):
    th = shape(hv)
    return [l * np.cos(th).sum() - span, l * np.sin(th).sum() + drop]


hv = fsolve(gap, [5.0, -m * g * N / 2], xtol=1e-12)
th = shape(hv)
pos = np.cumsum(np.stack([l * np.cos(th), l * np.sin(th)], 1), 0)[:-1]
s = S()
k = np.linspace(0, 1, N + 1)[1:-1]
guess = np.stack([span * k, -drop * k - 0.4 * np.sin(np.pi * k)], 1)
e = s.equilibrium(guess.ravel())
print("catenary", np.abs(e.q.reshape(-1, 2) - pos).max())
assert np.abs(e.q.reshape(-1, 2) - pos).max() < 1e-11
F = 2 * e.multipliers[0] * (e.q[:2])
print("force of the first link on its joint", F, "expected", -hv[0], -(hv[1] + m * g / 2 + 0))
# frequencies in the N angles with the 2 closing constraints
th = np.concatenate([th])
J = np.stack(
    [np.tril(np.outer(np.ones(N), -l * np.sin(th))), np.tril(np.outer(np.ones(N), l * np.cos(th)))]
)  # joint i+1 by angle j<=i
Z = np.zeros((2, 1, N))
A = np.concatenate([Z, J[:, :-1]], 1)
B = J
M = sum(m * (A[c].T @ A[c] + 0.5 * (A[c].T @ B[c] + B[c].T @ A[c]) + B[c].T @ B[c]) / 3 for c in range(2))
lam = hv  # closing force on the end
W = m * g * (N - 1 - np.arange(N) + 0.5)
# V = sum_j W_j l sin th_j; L'' : K = diag(-W l sin) + multipliers on closings
mu = np.linalg.lstsq(J[:, -1].T, W * l * np.cos(th), rcond=None)[0]
K = np.diag(-W * l * np.sin(th) - (mu[0] * (-l * np.cos(th)) + mu[1] * (-l * np.sin(th))))
Q = sl.null_space(J[:, -1])
om = np.sqrt(sl.eigh(Q.T @ K @ Q, Q.T @ M @ Q, eigvals_only=True))
print("frequencies", e.frequencies[:3], om[:3], np.abs(e.frequencies - om).max() / om.max())
assert np.abs(e.frequencies - om).max() < 1e-8 * om.max()
# half a period of the slowest mode from rest returns with the other sign, to second order in the amplitude
mode = e.directions @ np.linalg.eigh(np.linalg.solve(e.mass, e.stiffness))[1][:, 0]
kw = {"h": 0.002, "stages": 2}
st = s.project(e.q + 1e-3 * e.directions[:, 0])
sol = s.integrate(st.q, np.zeros(2 * N - 2), **kw).until(1.0)
print("energy", np.ptp(sol.energy), "residual", sol.residual.max())
assert sol.residual.max() < 1e-12 and np.ptp(sol.energy) < 1e-8
# a pull by an ensemble of lengths: each needs its own consistent start
lens = np.array([1.9, 2.0, 2.2])
try:
    many = s.ensemble(e.q, np.zeros(2 * N - 2), h=0.002, stages=2, until=0.1, parameters={"len": lens})
    print("ensemble errors:", [type(x).__name__ if x else None for x in many.errors])
    assert many.errors[1] is None and many.errors[0] is not None
except Exception as x:
    print("ensemble", type(x).__name__, x)
