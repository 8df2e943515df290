"""hannorein/rebound#855, #793, #318 and wmpg/WesternMeteorPyLib#99: close encounters between outputs are missed, their minima are wrong.
Here: four planets, events r_ij < R (entry and exit) and d r_ij^2/dt = 0 (the minimum), all pairs at once. Right: DOP853 at 1e-13 with its dense output, refined."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import variational as vi

S = vi.System("""
struct Planets {
    const N = 5;
    param m[N] = [1.0, 1e-4, 1e-4, 1e-4, 1e-4];
    coord r[N][2];
    let v = dot(r);
    L = sum(i in 0..N, m[i] * v[i] * v[i]) / 2 + sum(i in 0..N, j in 0..i, m[i] * m[j] / norm(r[i] - r[j]));
}
""")
N = 5
m = np.array([1.0, 1e-4, 1e-4, 1e-4, 1e-4])
a = np.array([1.0, 1.06, 1.13, 1.21])
ph = np.array([0.0, 1.1, 2.9, 4.4])
r = np.zeros((N, 2))
v = np.zeros((N, 2))
r[1:] = np.stack([a * np.cos(ph), a * np.sin(ph)], 1)
v[1:] = np.stack([-np.sin(ph), np.cos(ph)], 1) / np.sqrt(a)[:, None]
v[0] = -(m[1:, None] * v[1:]).sum(0)


def rhs(t, s):
    r = s[:10].reshape(5, 2)
    d = r[None] - r[:, None]
    r3 = ((d**2).sum(-1) + np.eye(5)) ** 1.5
    return np.concatenate([s[10:], ((m[None, :, None] * d) / r3[..., None]).sum(1).ravel()])


sol = solve_ivp(
    rhs, [0, 18], np.concatenate([r.ravel(), v.ravel()]), method="DOP853", rtol=1e-13, atol=1e-15, dense_output=True
)
Rc = 0.12
pairs = [(i, j) for i in range(1, 5) for j in range(1, i)]


def dist(i, j):
    return lambda q: np.hypot(*(q[2 * i : 2 * i + 2] - q[2 * j : 2 * j + 2])) - Rc


want = []
ts = np.linspace(0, 18, 180001)
Q = sol.sol(ts[::1])[:10].T
for k, (i, j) in enumerate(pairs):
    d = np.hypot(*(Q[:, 2 * i : 2 * i + 2] - Q[:, 2 * j : 2 * j + 2]).T) - Rc
    for n in np.nonzero(d[:-1] * d[1:] < 0)[0]:
        want.append((brentq(lambda t: dist(i, j)(sol.sol(t)[:10]), ts[n], ts[n + 1], xtol=1e-13), k, d[n] < 0))
want.sort()
ev = [(lambda t, q, v, f=dist(i, j): f(q)) for i, j in pairs]
run = S().integrate(r.ravel(), v.ravel(), h=0.03)
found = run.events(ev, until=18.0)
print("crossings", len(found), "right", len(want))
assert len(found) == len(want) and list(found.which) == [k for _, k, _ in want]
err = np.abs(found.t - np.array([t for t, _, _ in want]))
print("largest error of a time", err.max(), "at", found.t[err.argmax()])
assert err.max() < 1e-6
end = sol.sol(18.0)
print("end", np.abs(run.q - end[:10]).max())
mins = [
    (
        lambda t, q, v, i=i, j=j: float(
            (q[2 * i : 2 * i + 2] - q[2 * j : 2 * j + 2]) @ (v[2 * i : 2 * i + 2] - v[2 * j : 2 * j + 2])
        )
    )
    for i, j in pairs
]
for f in mins:
    f.direction = 1
run = S().integrate(r.ravel(), v.ravel(), h=0.03)
found = run.events(mins, until=18.0)
best = min(
    np.hypot(*(q[2 * pairs[k][0] : 2 * pairs[k][0] + 2] - q[2 * pairs[k][1] : 2 * pairs[k][1] + 2]))
    for q, k in zip(found.q, found.which, strict=False)
)
alld = min((np.hypot(*(Q[:, 2 * i : 2 * i + 2] - Q[:, 2 * j : 2 * j + 2]).T).min() for i, j in pairs))
print("closest of all", best, alld)
assert abs(best - alld) < 1e-6
