"""Eight jobs of mechanics by `variational`, scipy, heyoka.py and MuJoCo: lines of code, time, error.

    pip install ./python -r python/compare/requirements.txt
    python python/compare/jobs.py

It prints a table in Markdown. Each program is a function; its lines are those of its body without empty lines and
comments. A time is the best of three runs: texts and expressions that were compiled before are in a cache. What heyoka
or MuJoCo have no means for is left out, as they are if they are not installed. `compare.py` has two jobs more: an
ensemble and a halo orbit.
"""

import inspect
import math
import platform
import sys
import time

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve, least_squares

import variational as vi

try:
    import heyoka as hy
except ImportError:
    hy = None
try:
    import mujoco as mj
except ImportError:
    mj = None

TIGHT = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12}


# 1. The section θ1 = 0, rising, of a double pendulum: the times.


class Section:
    title = "section of a double pendulum"
    measure = "largest error of a time"

    def variational():
        run = vi.DoublePendulum().integrate([1.0, 1.0], h=0.09)
        return run.events(vi.Event("θ1", direction=1), until=20.0).t

    def scipy():
        def f(t, y):
            s, c = math.sin(y[0] - y[1]), math.cos(y[0] - y[1])
            first = -(y[3] ** 2) * s - 19.62 * math.sin(y[0])
            second = y[2] ** 2 * s - 9.81 * math.sin(y[1])
            upper = (first - c * second) / (2.0 - c**2)
            return [y[2], y[3], upper, second - c * upper]

        def rises(t, y):
            return y[0]

        rises.direction = 1
        return solve_ivp(f, (0.0, 20.0), [1.0, 1.0, 0.0, 0.0], events=rises, **TIGHT).t_events[0]

    def heyoka():
        a, b, u, w = hy.make_vars("a", "b", "u", "w")
        s, c = hy.sin(a - b), hy.cos(a - b)
        first = -(w**2) * s - 19.62 * hy.sin(a)
        second = u**2 * s - 9.81 * hy.sin(b)
        upper = (first - c * second) / (2.0 - c**2)
        times = []
        event = hy.nt_event(a, lambda ta, t, sign: times.append(t), direction=hy.event_direction.positive)
        equations = [(a, u), (b, w), (u, upper), (w, second - c * upper)]
        hy.taylor_adaptive(equations, [1.0, 1.0, 0.0, 0.0], tol=1e-15, nt_events=[event]).propagate_until(20.0)
        return times

    def error(found):
        exact = vi.DoublePendulum().integrate([1.0, 1.0], h=0.02).events(vi.Event("θ1", direction=1), until=20.0).t
        return np.abs(np.asarray(found) - exact).max()


# 2. A four-bar linkage whose guess does not close: motion and tension of the crank to t = 5.


class Linkage:
    title = "four-bar linkage from a bad guess"
    measure = "largest residual of the lengths"

    def variational():
        linkage = vi.FourBar()
        start = linkage.assemble([-1.0, 0.5, 4.0, 0.5])
        sol = linkage.integrate(start.q, [0.0] * 4, h=0.01).until(5.0)
        return sol.q, sol.reactions[:, 0]

    def scipy():
        a, b, c, d, g = 1.0, 3.0, 2.5, 3.0, 9.81
        unit, zero = np.eye(2), np.zeros((3, 3))
        M = np.block([[(a + b) / 3 * unit, b / 6 * unit], [b / 6 * unit, (b + c) / 3 * unit]])
        weight = -g / 2 * np.array([0.0, a + b, 0.0, b + c])

        def gaps(q):
            (x1, y1, x2, y2) = q
            return [x1**2 + y1**2 - a**2, (x2 - x1) ** 2 + (y2 - y1) ** 2 - b**2, (x2 - d) ** 2 + y2**2 - c**2]

        def gradients(q, d=d):
            x1, y1, x2, y2 = 2 * np.asarray(q)
            return np.array([[x1, y1, 0, 0], [x1 - x2, y1 - y2, x2 - x1, y2 - y1], [0, 0, x2 - 2 * d, y2]])

        def solved(q, v):
            G = gradients(q)
            return np.linalg.solve(np.block([[M, G.T], [G, zero]]), [*weight, *(-gradients(v, d=0.0) @ v)])

        def nearest(x):
            return [*(M @ (x[:4] - guess) - gradients(x[:4]).T @ x[4:]), *gaps(x[:4])]

        guess = np.array([-1.0, 0.5, 4.0, 0.5])
        q = fsolve(nearest, [*guess, 0.0, 0.0, 0.0], xtol=1e-14)[:4]
        sol = solve_ivp(lambda t, y: [*y[4:], *solved(y[:4], y[4:])[:4]], (0.0, 5.0), [*q, *np.zeros(4)], **TIGHT)
        return sol.y[:4].T, [-solved(y[:4], y[4:])[4] for y in sol.y.T]

    def error(found):
        q = np.asarray(found[0])
        return np.abs(vi.FourBar().residuals(0.0, q, np.zeros_like(q))[:, 0]).max()


# 3. A body that tumbles without torques, of three moments of inertia, to t = 100: the angular momentum in space stays.

SPIN, MOMENTS = [0.1, 2.0, 0.1], [1.0, 2.0, 3.0]


class Tumbling:
    title = "tumbling satellite"
    measure = "change of the angular momentum"

    def variational():
        Body = vi.System("""struct Body { rotation R; let w = rate(R);
            L = (w[0]^2 + 2 * w[1]^2 + 3 * w[2]^2) / 2; }""")
        run = Body().integrate([1.0, 0.0, 0.0, 0.0], [0.0, *(0.5 * np.array(SPIN))], h=0.1, stages=6)
        return run.until(100.0)["turn(R, [w[0], 2 * w[1], 3 * w[2]])"][-1]

    def scipy():
        def product(a, b):
            return np.array([a[0] * b[0] - a[1:] @ b[1:], *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])

        def f(t, y):
            w = y[4:]
            return np.concatenate([product(y[:4], np.array([0.0, *w])) / 2, -np.cross(w, J * w) / J])

        J = np.array(MOMENTS)
        y = solve_ivp(f, (0.0, 100.0), [1.0, 0.0, 0.0, 0.0, *SPIN], **TIGHT).y[:, -1]
        turned = product(product(y[:4], np.array([0.0, *(J * y[4:])])), y[:4] * [1, -1, -1, -1])
        return turned[1:]

    def heyoka():
        a, b, c, d, u, v, w = hy.make_vars("a", "b", "c", "d", "u", "v", "w")
        equations = [
            (a, (-b * u - c * v - d * w) / 2.0),
            (b, (a * u + c * w - d * v) / 2.0),
            (c, (a * v + d * u - b * w) / 2.0),
            (d, (a * w + b * v - c * u) / 2.0),
            (u, (2.0 - 3.0) * v * w / 1.0),
            (v, (3.0 - 1.0) * w * u / 2.0),
            (w, (1.0 - 2.0) * u * v / 3.0),
        ]
        ta = hy.taylor_adaptive(equations, [1.0, 0.0, 0.0, 0.0, *SPIN], tol=1e-15)
        ta.propagate_until(100.0)
        (a, *r), L = ta.state[:4], np.array(MOMENTS) * ta.state[4:]
        return L + 2.0 * a * np.cross(r, L) + 2.0 * np.cross(r, np.cross(r, L))

    def mujoco():
        model = mj.MjModel.from_xml_string("""<mujoco><option integrator="RK4" timestep="0.01" gravity="0 0 0"/>
            <worldbody><body><joint type="ball"/><inertial pos="0 0 0" mass="1" diaginertia="1 2 3"/></body></worldbody>
            </mujoco>""")
        data = mj.MjData(model)
        data.qvel[:] = SPIN
        for _ in range(10_000):
            mj.mj_step(model, data)
        found = np.zeros(3)
        mj.mju_rotVecQuat(found, np.array(MOMENTS) * data.qvel, data.qpos)
        return found

    def error(found):
        return np.abs(np.asarray(found) - np.array(MOMENTS) * SPIN).max()


# 4. An arm of three links whose joints follow sines, by computed torques at 100 Hz to t = 10.


def wanted(t):
    """Angles, rates and accelerations that the arm has to follow."""
    phases = np.array([0.0, 1.0, 2.0])
    return np.sin(t + phases) / 2, np.cos(t + phases) / 2, -np.sin(t + phases) / 2


def corrected(t, q, v):
    """The acceleration of the controller."""
    angle, rate, acceleration = wanted(t)
    return acceleration + 100.0 * (angle - q) + 20.0 * (rate - v)


class Arm:
    title = "arm of three links, computed torque at 100 Hz"
    measure = "error of the last angles"

    def variational(h=0.01):
        Links = vi.System("""struct Links { param g = 9.81; input tau[3] = 0.0; coord q[3];
            let a[k in 0..3] = sum(j in 0..k + 1, q[j]);
            let x[k in 0..3] = sum(j in 0..k + 1, [sin(a[j]), -cos(a[j])]);
            L = sum(k in 0..3, dot(x[k]) * dot(x[k]) / 2 - g * x[k][1]);
            force q[k in 0..3] = tau[k]; }""")

        def control(run):
            a = corrected(run.t, run.q, run.v)
            run.set(tau=links.inverse_dynamics(run.t, run.q, run.v, a))

        links = Links()
        run = links.integrate([0.1, 0.0, 0.0], h=h, stages=4)
        control(run)
        return run.steps(round(10.0 / h), every=round(0.01 / h), callback=control).q[-1]

    def scipy():
        def dynamics(q, v):
            # Of the absolute angles, whose velocities are sums of those of the joints.
            a, w = np.cumsum(q), np.cumsum(v)
            below = 3.0 - np.maximum.outer(range(3), range(3))
            M = below * np.cos(np.subtract.outer(a, a))
            b = (below * np.sin(np.subtract.outer(a, a))) @ w**2 + 9.81 * np.array([3, 2, 1]) * np.sin(a)
            return sums.T @ M @ sums, sums.T @ b

        sums, y, h = np.tri(3), np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0]), 0.01
        for step in range(1000):
            M, b = dynamics(y[:3], y[3:])
            tau = M @ corrected(step * h, y[:3], y[3:]) + b

            def f(t, y, tau=tau):
                M, b = dynamics(y[:3], y[3:])
                return np.concatenate([y[3:], np.linalg.solve(M, tau - b)])

            y = solve_ivp(f, (0.0, h), y, **TIGHT).y[:, -1]
        return y[:3]

    def mujoco():
        link = '<body pos="0 0 {}"><joint axis="0 -1 0"/><inertial pos="0 0 -1" mass="1" diaginertia="1e-9 1e-9 1e-9"/>'
        model = mj.MjModel.from_xml_string(
            '<mujoco><compiler boundinertia="0" balanceinertia="true"/><option integrator="RK4" timestep="0.01"/>'
            f"<worldbody>{link.format(0)}{link.format(-1)}{link.format(-1)}</body></body></body></worldbody></mujoco>"
        )
        data = mj.MjData(model)
        data.qpos[:] = [0.1, 0.0, 0.0]
        for _ in range(1000):
            data.qacc[:] = corrected(data.time, data.qpos, data.qvel)
            mj.mj_inverse(model, data)
            data.qfrc_applied[:] = data.qfrc_inverse
            mj.mj_step(model, data)
        return data.qpos.copy()

    def error(found):
        return np.abs(np.asarray(found) - Arm.variational(h=0.005)).max()


# 5. A satellite about the flattened Earth for a day of 16 orbits (unit of length: radius of the Earth).


class Flattened:
    title = "satellite with J2, 16 orbits"
    measure = "error of the last place"

    def variational(h=0.5):
        Satellite = vi.System("""struct Satellite { param J2 = 1.08263e-3; coord r[3]; let d = norm(r);
            L = dot(r) * dot(r) / 2 + 1 / d - J2 * (3 * r[2]^2 / d^2 - 1) / (2 * d^3); }""")
        return Satellite().integrate([1.1, 0.0, 0.0], [0.0, 0.6, 0.75], h=h).until(120.0).q[-1]

    def scipy():
        def f(t, y):
            x, y_, z, *v = y.tolist()
            d = math.sqrt(x * x + y_ * y_ + z * z)
            flat = 1.5 * 1.08263e-3 / d**5
            side = -1.0 / d**3 + flat * (5.0 * z * z / d**2 - 1.0)
            return [*v, x * side, y_ * side, z * (side - 2.0 * flat)]

        return solve_ivp(f, (0.0, 120.0), [1.1, 0.0, 0.0, 0.0, 0.6, 0.75], **TIGHT).y[:3, -1]

    def heyoka():
        x, y, z, u, v, w = hy.make_vars("x", "y", "z", "u", "v", "w")
        d = hy.sqrt(x**2 + y**2 + z**2)
        L = (u**2 + v**2 + w**2) / 2.0 + 1.0 / d - 1.08263e-3 * (3.0 * z**2 / d**2 - 1.0) / (2.0 * d**3)
        equations = hy.lagrangian(L, [x, y, z], [u, v, w])
        ta = hy.taylor_adaptive(equations, [1.1, 0.0, 0.0, 0.0, 0.6, 0.75], tol=1e-15)
        ta.propagate_until(120.0)
        return ta.state[:3]

    def error(found):
        return np.abs(np.asarray(found) - Flattened.variational(h=0.1)).max()


# 6. Stiffness and damping of an oscillator from 200 values with noise.

TIMES = np.linspace(0.0, 20.0, 200)


def oscillation(k, c):
    """The closed form of m = 1 from x = 1 at rest."""
    w = math.sqrt(k - c * c / 4)
    return np.exp(-c * TIMES / 2) * (np.cos(w * TIMES) + c / (2 * w) * np.sin(w * TIMES))


MEASURED = oscillation(4.3, 0.21) + 0.01 * np.random.default_rng(1).standard_normal(200)


class Fit:
    title = "fit of two parameters"
    measure = "relative error of k and c"

    def variational():
        guess = vi.DampedOscillator(k=4.0, c=0.1)
        found = vi.fit(guess, {"t": TIMES, "x": MEASURED}, ["k", "c"], q=[1.0], h=0.2)
        return [found["k"], found["c"]], found.errors

    def scipy():
        def residuals(p):
            f = lambda t, y: [y[1], -p[0] * y[0] - p[1] * y[1]]  # noqa: E731
            return solve_ivp(f, (0.0, 20.0), [1.0, 0.0], t_eval=TIMES, **TIGHT).y[0] - MEASURED

        found = least_squares(residuals, [4.0, 0.1], x_scale="jac", xtol=1e-12, ftol=1e-12)
        covariance = np.linalg.inv(found.jac.T @ found.jac) * 2 * found.cost / (200 - 2)
        return found.x, np.sqrt(np.diag(covariance))

    def error(found):
        fit = least_squares(lambda p: oscillation(*p) - MEASURED, [4.3, 0.21], x_scale="jac", jac="3-point", xtol=1e-15)
        return np.abs(np.asarray(found[0]) / fit.x - 1.0).max()


# 7. The energy of a pendulum that nearly turns over, for 1000 units of time.


class Energy:
    title = "energy of a pendulum, 1000 units of time"
    measure = "largest change of the energy"

    def variational():
        sol = vi.Pendulum(g=1.0).integrate([3.0], h=0.2).until(1000.0, every=10)
        return sol.energy - sol.energy[0]

    def scipy():
        sol = solve_ivp(lambda t, y: [y[1], -math.sin(y[0])], (0.0, 1000.0), [3.0, 0.0], **TIGHT)
        energy = sol.y[1] ** 2 / 2 - np.cos(sol.y[0])
        return energy - energy[0]

    def heyoka():
        x, v = hy.make_vars("x", "v")
        ta = hy.taylor_adaptive([(x, v), (v, -hy.sin(x))], [3.0, 0.0], tol=1e-15)
        states = ta.propagate_grid(np.linspace(0.0, 1000.0, 500))[-1]
        energy = states[:, 1] ** 2 / 2 - np.cos(states[:, 0])
        return energy - energy[0]

    def mujoco():
        model = mj.MjModel.from_xml_string("""<mujoco><compiler boundinertia="0" balanceinertia="true"/>
            <option integrator="RK4" timestep="0.02" gravity="0 0 -1"><flag energy="enable"/></option><worldbody><body>
            <joint axis="0 -1 0"/><inertial pos="0 0 -1" mass="1" diaginertia="1e-9 1e-9 1e-9"/></body></worldbody>
            </mujoco>""")
        data, energies = mj.MjData(model), []
        data.qpos[0] = 3.0
        for _ in range(50_000):
            mj.mj_step(model, data)
            energies.append(data.energy.sum())
        return np.array(energies) - energies[0]

    def error(found):
        return np.abs(found).max()


# 8. A chain of 25 links that falls from the horizontal, to t = 2.


class Chain:
    title = "chain of 25 links"
    measure = "largest change of the energy over that of the fall"

    def variational():
        Chain = vi.System("""struct Chain { param g = 9.81; coord a[25];
            let x[k in 0..25] = sum(j in 0..k + 1, [sin(a[j]), -cos(a[j])]);
            L = sum(k in 0..25, dot(x[k]) * dot(x[k]) / 2 - g * x[k][1]); }""")
        return Chain().integrate(np.full(25, np.pi / 2), h=0.01, stages=4).until(2.0).energy

    def scipy():
        count = np.arange(25, 0, -1)
        below = np.minimum.outer(count, count)

        def f(t, y):
            a, w = np.split(y, 2)
            d = np.subtract.outer(a, a)
            return np.concatenate(
                [w, np.linalg.solve(below * np.cos(d), -(below * np.sin(d)) @ w**2 - 9.81 * count * np.sin(a))]
            )

        y = solve_ivp(f, (0.0, 2.0), np.concatenate([np.full(25, np.pi / 2), np.zeros(25)]), **TIGHT).y
        kinetic = [
            w @ (below * np.cos(np.subtract.outer(a, a))) @ w / 2 for a, w in zip(y[:25].T, y[25:].T, strict=True)
        ]
        return kinetic - 9.81 * count @ np.cos(y[:25])

    def mujoco():
        link = '<body pos="0 0 -1"><joint axis="0 -1 0"/><inertial pos="0 0 -1" mass="1" diaginertia="1e-9 1e-9 1e-9"/>'
        model = mj.MjModel.from_xml_string(
            '<mujoco><compiler boundinertia="0" balanceinertia="true"/><option integrator="RK4" timestep="0.001">'
            f'<flag energy="enable"/></option><worldbody>{25 * link}{25 * "</body>"}</worldbody></mujoco>'
        )
        data, energies = mj.MjData(model), []
        data.qpos[0] = np.pi / 2
        for _ in range(2000):
            mj.mj_step(model, data)
            energies.append(data.energy.sum())
        return np.array(energies)

    def error(found):
        return np.abs(found - found[0]).max() / (9.81 * 325)


JOBS = [Section, Linkage, Tumbling, Arm, Flattened, Fit, Energy, Chain]
TOOLS = {"variational": vi, "scipy": scipy, "heyoka": hy, "mujoco": mj}


def lines(function):
    """Lines of a function without its head, comments and empty lines."""
    body = inspect.getsource(function).splitlines()[1:]
    return sum(bool(line.strip()) and not line.strip().startswith("#") for line in body)


def shown(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e6:.3g} µs"


def measured(job, program):
    """Lines, time and error of a program."""
    times = []
    for _ in range(3):
        begin = time.perf_counter()
        found = program()
        times.append(time.perf_counter() - begin)
    return f"{lines(program)}, {shown(min(times))}, {job.error(found):.1e}"


def main():
    versions = [f"{name} {tool.__version__}" for name, tool in TOOLS.items() if tool]
    print(f"Python {platform.python_version()}, numpy {np.__version__}, {', '.join(versions)}\n")
    print("| job | error | " + " | ".join(TOOLS) + " |\n|" + "---|" * (2 + len(TOOLS)))
    for job in JOBS:
        if len(sys.argv) < 2 or job.__name__ in sys.argv[1:]:
            cells = [
                measured(job, program) if tool and (program := vars(job).get(name)) else "–"
                for name, tool in TOOLS.items()
            ]
            print(f"| {job.title} | {job.measure} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
