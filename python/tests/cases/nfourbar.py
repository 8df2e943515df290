"""IFToMM benchmark A02, N four-bar mechanism (N = 2): at the horizontal position one degree of freedom becomes N + 1; simulators fail there.
Right: parallelograms move as one pendulum: (sum of inertias) a'' = torque; scipy DOP853. Start upright, B0 at 1 m/s."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

S = vi.System("""
struct Windows {
    const N = 2;
    param l = 1.0, m = 1.0, g = 9.81;
    coord b[N + 1][2];                                    // upper ends of the posts; posts stand at x = 0, l, 2 l
    let post[i in 0..N + 1] = m * (dot(b[i]) * dot(b[i])) / 6 - m * g * b[i][1] / 2;
    let beam[i in 0..N] = m * (dot(b[i]) * dot(b[i]) + dot(b[i]) * dot(b[i + 1]) + dot(b[i + 1]) * dot(b[i + 1])) / 6 - m * g * (b[i][1] + b[i + 1][1]) / 2;
    L = sum(i in 0..N + 1, post[i]) + sum(i in 0..N, beam[i]);
    constraint up[i in 0..N + 1] = (b[i][0] - i * l)^2 + b[i][1]^2 - l^2;
    constraint over[i in 0..N] = (b[i + 1] - b[i]) * (b[i + 1] - b[i]) - l^2;
}
""")
# posts: 3 * m l^2/3, beams: 2 * m l^2 (translation); torque: 3 m g l/2 + 2 m g l
I = 3 / 3 + 2.0
G = 9.81 * (1.5 + 2.0)
ref = solve_ivp(
    lambda t, s: [s[1], G * np.sin(s[0]) / I],
    [0, 10],
    [0.0, 1.0],
    method="DOP853",
    rtol=1e-12,
    atol=1e-12,
    dense_output=True,
)
q = [0.0, 1.0, 1.0, 1.0, 2.0, 1.0]
v = [1.0, 0.0, 1.0, 0.0, 1.0, 0.0]
s = S()
for kw in ({"h": 0.01, "stages": 2}, {"h": 0.01}, {"h": 0.003}, {"h": 0.001}):
    run = s.integrate(q, v, **kw)
    try:
        sol = run.until(10.0)
        a = ref.sol(10.0)[0]
        print(
            kw,
            "end",
            sol.q[-1, :2],
            "right",
            [np.sin(a), np.cos(a)],
            "error",
            np.abs(sol.q[-1, :2] - [np.sin(a), np.cos(a)]).max(),
        )
    except vi.StepError as e:
        a = ref.sol(run.t)[0]
        print(
            kw,
            "stops at t =",
            run.t,
            "angle",
            np.degrees(a),
            type(e).__name__,
            str(e)[:150],
            "| error so far",
            np.abs(run.q[:2] - [np.sin(a), np.cos(a)]).max(),
        )
assert np.abs(sol.q[-1, :2] - [np.sin(ref.sol(10.0)[0]), np.cos(ref.sol(10.0)[0])]).max() < 1e-8
# Combined with events: stop where the posts lie flat, which is the singular position, and go on; and start there.
run = s.integrate(q, v, h=0.01)
for _k in range(4):
    try:
        ev = run.next_event(vi.Event("b[0][1]"), until=10.0)
        if not len(ev):
            break
        print("event", ev.t, run.q[:2])
        a = ref.sol(ev.t[0])[0]
        print("   angle there / 90 deg:", np.degrees(a) / 90)
    except vi.StepError as e:
        print("event search:", type(e).__name__, str(e)[:200], "at t =", run.t)
        break
evs = s.integrate(q, v, h=0.01)
try:
    found = evs.events(vi.Event("b[0][1]"), until=10.0)
    print("events():", found.t)
except vi.StepError as e:
    print("events():", type(e).__name__, str(e)[:200], "t =", evs.t, "rows", len(e.solution))
from scipy.optimize import brentq

want = [
    brentq(lambda t: np.cos(ref.sol(t)[0]), lo, lo + 0.01)
    for lo in np.arange(0, 10, 0.01)
    if np.cos(ref.sol(lo)[0]) * np.cos(ref.sol(lo + 0.01)[0]) < 0
]
print("right times", want)
try:
    r = s.integrate([1.0, 0.0, 2.0, 0.0, 3.0, 0.0], [0.0, -1.0, 0.0, -1.0, 0.0, -1.0], h=0.01)
    r.until(1.0)
    print("start flat runs", r.q)
except vi.StepError as e:
    print("start flat:", type(e).__name__, str(e)[:200])
