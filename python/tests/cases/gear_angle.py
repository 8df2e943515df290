"""dartsim/dart#1756, RobotLocomotion/drake#17639: a gear couples two joints; the coupling acts on one of them only, or drifts.
Here: two wheels with a gear ratio 3, both `angle` (they turn for ever), torque on the first, pendulum mass on the second; Right: one coordinate."""

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

text = """
struct Gear {
    param I = [0.2, 1.5][0], J = 1.5, n = 3.0, mgl = 4.0;
    input torque = 2.0;
    KIND a, b;
    L = 0.2 * dot(a)^2 / 2 + J * dot(b)^2 / 2 + mgl * cos(b);
    constraint gear = a - n * b;
    force a = torque;
}
""".replace("I = [0.2, 1.5][0], ", "")
try:
    S = vi.System(text.replace("KIND", "angle"))
    print("angle accepted")
except vi.CompileError as e:
    print("angle:", e)
    S = vi.System(text.replace("KIND", "coord"))
s = S()
I = 0.2 * 9 + 1.5
ref = solve_ivp(
    lambda t, y: [y[1], (3 * 2.0 - 4.0 * np.sin(y[0])) / I],
    [0, 30],
    [0.0, 0.0],
    method="DOP853",
    rtol=1e-12,
    atol=1e-12,
).y[:, -1]
sol = s.integrate([0.0, 0.0], [0.0, 0.0], h=0.01).until(30.0)
print(
    sol.q[-1],
    ref[0] * 3,
    ref[0],
    "error",
    abs(sol.q[-1, 1] - ref[0]),
    "gear",
    abs(sol.q[-1, 0] - 3 * sol.q[-1, 1]),
    "reaction",
    sol.reactions[-1],
)
assert abs(sol.q[-1, 1] - ref[0]) < 1e-6 and abs(sol.q[-1, 0] - 3 * sol.q[-1, 1]) < 1e-10
