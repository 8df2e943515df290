"""RobotLocomotion/drake#2623, projectchrono/chrono#438, bulletphysics/bullet3#2486: prescribed rotation: what torque does the motor give, what work.
Here: a bead on a wire that is turned at a constant rate, as a constraint that depends on t. Right: r = r0 cosh(w t), force 2 m w r' across the wire,
work = m w^2 (r^2 - r0^2). And the Jacobi integral."""

import numpy as np

import variational as vi

S = vi.System("""
struct Wire {
    param m = 1.5, w = 2.0;
    coord x, y;
    L = m * (dot(x)^2 + dot(y)^2) / 2;
    constraint wire = x * sin(w * t) - y * cos(w * t);
}
""")
s = S()
m, w, r0 = 1.5, 2.0, 0.3
run = s.integrate([r0, 0.0], [0.0, r0 * w], h=0.02, stages=6)
sol = run.until(2.0)
r = r0 * np.cosh(w * sol.t)
want = np.stack([r * np.cos(w * sol.t), r * np.sin(w * sol.t)], 1)
print("error", np.abs(sol.q - want).max())
assert np.abs(sol.q - want).max() < 1e-11
rd = r0 * w * np.sinh(w * sol.t)
print("across", np.abs(sol.reactions[:, 0] + 2 * m * w * rd).max())
assert np.abs(sol.reactions[:, 0] + 2 * m * w * rd).max() < 1e-8
E = sol.energy
print("work", np.abs(E - E[0] - m * w * w * (r * r - r0 * r0)).max())
assert np.abs(E - E[0] - m * w * w * (r * r - r0 * r0)).max() < 1e-9
try:
    run = s.integrate([r0, 0.0], [0.0, r0 * w], h=0.01, method="energy", stages=2, shift_from=1.0)
    run.until(2.0)
    print(
        "energy steps: error",
        np.abs(run.q - want[-1]).max(),
        "discrete energy",
        run.discrete_energy,
        run.shifted_energy,
    )
    assert np.abs(run.q - want[-1]).max() < 1e-4
except vi.StepError as x:
    print("energy steps:", type(x).__name__, str(x)[:300])
try:
    s.integrate([r0, 0.0], [0.0, 0.0], h=0.02)
    raise AssertionError("an inconsistent start was taken")
except vi.InconsistentStart as x:
    print("at rest is refused:", x)


# events in the frame that turns: the bead passes r = 1
def g(t, q, v):
    return np.hypot(*q) - 1.0


ev = s.integrate([r0, 0.0], [0.0, r0 * w], h=0.02, stages=6).next_event(g, until=5.0)
print("event", ev.t[0] - np.arccosh(1 / r0) / w)
assert abs(ev.t[0] - np.arccosh(1 / r0) / w) < 1e-11
