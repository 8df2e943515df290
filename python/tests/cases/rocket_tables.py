"""RocketPy-Team/RocketPy#337, #423: thrust curve and mass of a motor from tables, burn-out in the middle of a step; variable mass in L.
Right: scipy DOP853 piecewise between the places of the tables (linear), 1e-12."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

tt = np.array([0.0, 0.2, 1.0, 2.0, 2.4, 2.5])
F = np.array([0.0, 90.0, 60.0, 55.0, 20.0, 0.0])
ve = 1900.0
R = vi.System(
    """
struct Rocket {
    param m0 = 1.6, ve = 1900.0, g = 9.81, cd = 0.004, H = 8000.0, tilt = 0.05;
    coord x, z;
    table thrust(s) = [(0.0, 0), (0.2, 90), (1.0, 60), (2.0, 55), (2.4, 20), (2.5, 0)] linear hold;
    table burnt(s) = [(0.0, 0), (0.2, 9), (1.0, 69), (2.0, 126.5), (2.4, 141.5), (2.5, 142.5)] linear hold;
    input frozen = 0.0;
    // the mass is exact between the places: m0 - impulse/ve with the impulse as a quadratic; the table of it would be linear only
    let V = hypot(dot(x), dot(z));
    let rho = exp(-z / H);
    param M = 1.6;
    L = M * (dot(x)^2 + dot(z)^2) / 2 - M * g * z;
    force x = thrust(t) * sin(tilt) - cd * rho * V * dot(x);
    force z = thrust(t) * cos(tilt) - cd * rho * V * dot(z);
}
""".replace("    input frozen = 0.0;\n", "")
    .replace(
        "    table burnt(s) = [(0.0, 0), (0.2, 9), (1.0, 69), (2.0, 126.5), (2.4, 141.5), (2.5, 142.5)] linear hold;\n",
        "",
    )
    .replace("param m0 = 1.6, ve = 1900.0, g", "param g")
)
r = R(M=1.6)


def rhs(t, y):
    V = np.hypot(y[2], y[3])
    rho = np.exp(-y[1] / 8000.0)
    T = np.interp(t, tt, F)
    return [
        y[2],
        y[3],
        (T * np.sin(0.05) - 0.004 * rho * V * y[2]) / 1.6,
        (T * np.cos(0.05) - 0.004 * rho * V * y[3]) / 1.6 - 9.81,
    ]


y = np.array([0.0, 0.0, 0.0, 10.0])
ends = [0.2, 1.0, 2.0, 2.4, 2.5, 8.0]
t = 0.0
for e in ends:
    y = solve_ivp(rhs, [t, e], y, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    t = e
for kw in ({"h": 0.1}, {"h": 0.03}, {"h": 0.01}):
    end = r.integrate([0.0, 0.0], [0.0, 10.0], stages=4, **kw).until(8.0).q[-1]
    print(kw, np.abs(end - y[:2]).max())
run = r.integrate([0.0, 0.0], [0.0, 10.0], h=0.1, stages=4)
for e in ends:
    run.until(e)
print("steps that end at the places", np.abs(run.q - y[:2]).max())
assert np.abs(run.q - y[:2]).max() < 1e-9
top = run.copy()
ev = r.integrate([0.0, 0.0], [0.0, 10.0], h=0.02, stages=4).next_event(vi.Event("dot(z)", direction=-1), until=30.0)
apo = lambda t, y: y[3]
apo.terminal = True
apo.direction = -1
y = np.array([0.0, 0.0, 0.0, 10.0])
t = 0.0
for e in ends[:-1]:
    y = solve_ivp(rhs, [t, e], y, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    t = e
s = solve_ivp(rhs, [2.5, 30.0], y, method="DOP853", rtol=1e-12, atol=1e-12, events=apo)
print("apogee", ev.t, s.t_events[0])
assert abs(ev.t[0] - s.t_events[0][0]) < 1e-5
# variable mass: momentum is m(t) v, so that the lost mass takes m' v with it: the force needs + dm/dt * v
Vm = vi.System("""
struct Lifter {
    param m0 = 1.6, rate = 0.1, ve = 1900.0, g = 9.81;
    coord z;
    let m = m0 - rate * t;
    L = m * dot(z)^2 / 2 - m * g * z;
    force z = rate * ve - rate * dot(z);
}
""")
end = Vm().integrate([0.0], [0.0], h=0.1, stages=4).until(5.0)
T = 5.0
m1 = 1.6 - 0.5
want = 1900 * (T - 0) - 0  # Tsiolkovsky
vz = 1900 * np.log(1.6 / m1) - 9.81 * T
z = 1900 * (T - (1.6 / 0.1 - T) * np.log(1.6 / m1)) - 9.81 * T * T / 2
print("Tsiolkovsky", end.v[-1, 0] - vz, end.q[-1, 0] - z)
assert abs(end.v[-1, 0] - vz) < 1e-8 and abs(end.q[-1, 0] - z) < 1e-6
