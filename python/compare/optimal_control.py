"""Optimal control of docs/python/optimal_control.md: its figures, and its table against other tools.

    python optimal_control.py            # prints the table
    python optimal_control.py --figures  # writes the figures into docs/figures

It needs casadi, scipy and matplotlib. opty and crocoddyl are compared if they are installed.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")  # CPU times count every thread.

import importlib.util
import resource
import statistics
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

FIGURES = Path(__file__).resolve().parents[2] / "docs" / "figures"
REPEATS = 5

CartPole = vi.System("""
/// A pole on a cart; the angle a is zero where the pole is upright.
struct CartPole {
    param M = 1.0, m = 0.2, l = 0.5, g = 9.81;
    /// Force on the cart.
    input u = 0.0;
    coord x, a;
    L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 - m * g * l * cos(a);
    force x = u;
}
""")
Acrobot = vi.System("""
/// Two rods with a mass at each end and a motor between them. The angles are zero where the rods hang down.
struct Acrobot {
    param g = 9.81;
    /// Torque of the motor.
    input u = 0.0;
    coord a, b;
    L = dot(a)^2 + dot(b)^2 / 2 + dot(a) * dot(b) * cos(a - b) + g * (2 * cos(a) + cos(b));
    force a = -u;
    force b = u;
}
""")
Mass = vi.System("struct Mass { input u = 0.0; coord x; L = dot(x)^2 / 2; force x = u; }")
Craft = vi.System("""
/// A spacecraft about a planet, with thrust.
struct Craft {
    input ux = 0.0, uy = 0.0;
    coord x, y;
    let r = sqrt(x^2 + y^2);
    L = (dot(x)^2 + dot(y)^2) / 2 + 1 / r;
    force x = ux;
    force y = uy;
}
""")
DURATION = 2.5


def pushes(steps):
    """A force that swings the pole a little."""
    return 2.0 * np.sin(5.0 * np.arange(steps) * DURATION / steps)


def of_cart(x, u, of):
    """The accelerations of the cart and of the pole, derived by hand, with the functions of a module."""
    big, m, length, g = 1.0, 0.2, 0.5, 9.81
    _, a, _, va = x
    sin, cos = of.sin(a), of.cos(a)
    # (M + m) x'' + m l cos(a) a'' = u + m l sin(a) a'^2, cos(a) x'' + l a'' = g sin(a)
    cart = (u + m * length * sin * va**2 - m * g * sin * cos) / (big + m * sin**2)
    return [cart, (g * sin - cos * cart) / length]


def of_acrobot(x, u, of):
    """The same of the acrobot."""
    g = 9.81
    a, b, va, vb = x
    sin, cos = of.sin(a - b), of.cos(a - b)
    # 2 a'' + cos b'' = first, cos a'' + b'' = second
    first, second = -u - sin * vb**2 - 2.0 * g * of.sin(a), u + sin * va**2 - g * of.sin(b)
    return [(first - cos * second) / (2.0 - cos**2), (2.0 * second - cos * first) / (2.0 - cos**2)]


def cart_of_pinocchio(pin):
    model = pin.Model()
    cart = model.addJoint(0, pin.JointModelPX(), pin.SE3.Identity(), "x")
    pole = model.addJoint(cart, pin.JointModelRY(), pin.SE3.Identity(), "a")
    for joint, mass, height in ((cart, 1.0, 0.0), (pole, 0.2, 0.5)):
        model.appendBodyToJoint(
            joint, pin.Inertia(mass, np.array([0.0, 0.0, height]), np.zeros((3, 3))), pin.SE3.Identity()
        )
    return model


def acrobot_of_pinocchio(pin):
    """Its second coordinate is b - a."""
    model = pin.Model()
    upper = model.addJoint(0, pin.JointModelRY(), pin.SE3.Identity(), "a")
    lower = model.addJoint(upper, pin.JointModelRY(), pin.SE3(np.eye(3), np.array([0.0, 0.0, -1.0])), "b")
    for joint in (upper, lower):
        model.appendBodyToJoint(
            joint, pin.Inertia(1.0, np.array([0.0, 0.0, -1.0]), np.zeros((3, 3))), pin.SE3.Identity()
        )
    return model


@dataclass(frozen=True)
class Problem:
    """From rest to rest with one input, at the least integral of u^2 / 2 or in the least time."""

    name: str
    system: Any
    accelerations: Callable
    start: list[float]
    end: list[float]
    guess: Callable
    duration: float
    """The time of the motion, or that of the guess."""
    bound: float | None = None
    """Bound of the input of a problem of least time."""
    pinocchio: Callable | None = None
    """Its model in Pinocchio, the joint of the motor, and its coordinates from those of the system."""
    actuated: int = 0
    relative: Any = None

    @property
    def is_of_time(self):
        return self.bound is not None

    def nodes(self, steps):
        """The motion of the guess, from which every tool starts: rows (q, v)."""
        zero = np.zeros(len(self.start))
        run = self.system(u=self.guess(steps)[0]).integrate(q=self.start, v=zero, h=self.duration / steps)
        rows = [np.concatenate([run.q, run.v])]
        for u in self.guess(steps):
            run.set(u=u).step()
            rows.append(np.concatenate([run.q, run.v]))
        return np.array(rows)


class Found(NamedTuple):
    """What a tool found: its inputs are constant over each step."""

    variables: int
    constraints: int
    iterations: int
    inputs: np.ndarray
    duration: float


def shooting(problem, system, steps, stages):
    zero = np.zeros(len(problem.start))
    kind = {"cost": "u^2 / 2", "duration": problem.duration}
    if problem.is_of_time:
        kind = {"cost": "1", "duration": (0.1, 10.0), "inputs": {"u": (-problem.bound, problem.bound)}}
    found = vi.optimise(
        system, steps=steps, start=(problem.start, zero), end=(problem.end, zero), stages=stages,
        guess={"u": problem.guess(steps), "duration": problem.duration}, **kind,
    )  # fmt: skip
    assert found.success
    states = 2 * len(zero)
    variables = 1 + states * (steps + 1) + steps
    return Found(variables, states * (steps + 1), found.iterations, found["u"], found.t[-1])


def collocation(problem, steps, degree):
    """Gauss-Legendre collocation in CasADi, with exact second derivatives."""
    coordinates = len(problem.start)
    size, free = 2 * coordinates, problem.is_of_time
    c, d, _ = ca.collocation_coeff(ca.collocation_points(degree, "legendre"))
    nodes = problem.nodes(steps)
    duration = ca.SX.sym("T") if free else problem.duration
    h = duration / steps
    x = ca.SX.sym("x0", size)
    variables, guess, rows = [x], [nodes[0]], [x - np.array([*problem.start, *np.zeros(coordinates)])]
    bounds = [np.full(size, np.inf)]
    cost = duration if free else 0.0
    for k in range(steps):
        u, inner = ca.SX.sym(f"u{k}"), ca.SX.sym(f"s{k}", size, degree)
        columns = [ca.vertsplit(inner[:, i]) for i in range(degree)]
        slopes = [ca.vertcat(*of[coordinates:], *problem.accelerations(of, u, ca)) for of in columns]
        rows.append(ca.vec(ca.mtimes(ca.horzcat(x, inner), c) - h * ca.horzcat(*slopes)))
        end = ca.mtimes(ca.horzcat(x, inner), d)
        x = ca.SX.sym(f"x{k + 1}", size)
        rows.append(end - x)
        cost += 0.0 if free else h * u**2 / 2.0
        variables += [u, ca.vec(inner), x]
        guess += [[problem.guess(steps)[k]], np.tile(nodes[k], degree), nodes[k + 1]]
        bounds += [[problem.bound or np.inf], np.full(size * (degree + 1), np.inf)]
    rows.append(x - np.array([*problem.end, *np.zeros(coordinates)]))
    if free:
        variables, guess, bounds = [*variables, duration], [*guess, [problem.duration]], [*bounds, [10.0]]
    program = {"x": ca.vertcat(*variables), "f": cost, "g": ca.vertcat(*rows)}
    options = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-10, "max_iter": 1000}}
    solver = ca.nlpsol("collocation", "ipopt", program, options)
    limits = np.concatenate(bounds)
    found = solver(x0=np.concatenate(guess), lbx=-limits, ubx=limits, lbg=0.0, ubg=0.0)
    assert solver.stats()["success"]
    numbers = np.asarray(found["x"]).ravel()
    inputs = numbers[size :: size * (degree + 1) + 1][:steps]
    count, time = solver.stats()["iter_count"], numbers[-1] if free else problem.duration
    return Found(len(numbers), program["g"].numel(), count, inputs, time)


def opty_of(problem, steps):
    """opty: collocation by midpoints. It compiles its constraints once, and has no second derivatives."""
    import opty
    import sympy as sm

    t, u, h = sm.Symbol("t"), sm.Function("u")(sm.Symbol("t")), sm.Symbol("h")
    size, free = 2 * len(problem.start), problem.is_of_time
    states = [sm.Function(f"x{i}")(t) for i in range(size)]
    slopes = [*states[size // 2 :], *problem.accelerations(states, u, sm)]
    equations = sm.Matrix([of.diff(t) - slope for of, slope in zip(states, slopes, strict=True)])
    ends = ((0, problem.start), (steps, problem.end))
    step = h if free else problem.duration / steps
    conditions = [
        of.func(node * step) - value
        for node, place in ends
        for of, value in zip(states, [*place, *np.zeros(size // 2)], strict=True)
    ]
    if free:
        last = np.zeros(size * (steps + 1) + steps + 2)
        last[-1] = steps
        cost, gradient = (lambda x: steps * x[-1]), (lambda x: last)
    else:
        cost, gradient = opty.create_objective_function(
            sm.Integral(u**2 / 2, t), states, [u], [], steps + 1, step, "midpoint", t
        )
    bounds = {u: (-problem.bound, problem.bound), h: (0.0, 10.0 / steps)} if free else None
    program = opty.Problem(
        cost, gradient, equations, states, steps + 1, step, instance_constraints=conditions, time_symbol=t,
        integration_method="midpoint", bounds=bounds,
    )  # fmt: skip
    for name, value in (("print_level", 0), ("sb", "yes"), ("max_iter", 3000)):
        program.add_option(name, value)
    pushed = problem.guess(steps)
    guess = np.concatenate([problem.nodes(steps).T.ravel(), pushed, pushed[-1:], [problem.duration / steps] * free])

    def solve():
        program.obj_value = []
        numbers, info = program.solve(guess)
        assert info["status"] in (0, 1), info["status_msg"]
        inputs = numbers[size * (steps + 1) :][: steps + 1]
        time = steps * numbers[-1] if free else problem.duration
        means = (inputs[1:] + inputs[:-1]) / 2.0
        return Found(len(numbers), program.num_constraints, len(program.obj_value) - 1, means, time)

    return solve


def crocoddyl_of(problem, steps, weight=1e6):
    """Crocoddyl: FDDP over Runge-Kutta steps of order 4, with a price of the end in place of a condition."""
    import crocoddyl
    import pinocchio as pin

    state = crocoddyl.StateMultibody(problem.pinocchio(pin))
    size = 2 * len(problem.start)
    change = np.eye(size) if problem.relative is None else np.kron(np.eye(2), problem.relative)
    motor = np.zeros((size // 2, 1))
    motor[problem.actuated] = 1.0

    class Motor(crocoddyl.ActuationModelAbstract):
        def __init__(self):
            crocoddyl.ActuationModelAbstract.__init__(self, state, 1)

        def calc(self, data, x, u):
            data.tau = motor @ u

        def calcDiff(self, data, x, u):
            data.dtau_du = motor

        def commands(self, data, x, tau):
            data.u = tau[[problem.actuated]]

    actuation = Motor()
    running, last = (crocoddyl.CostModelSum(state, 1) for _ in range(2))
    running.addCost("u", crocoddyl.CostModelResidual(state, crocoddyl.ResidualModelControl(state, 1)), 1.0)
    place = change @ np.array([*problem.end, *np.zeros(size // 2)])
    last.addCost("end", crocoddyl.CostModelResidual(state, crocoddyl.ResidualModelState(state, place, 1)), weight)
    h, control = problem.duration / steps, crocoddyl.ControlParametrizationModelPolyZero(1)

    def dynamics(costs):
        model = crocoddyl.DifferentialActionModelFreeFwdDynamics(state, actuation, costs)
        # Without an armature release 3.2.1 leaves out gravity.
        model.armature = np.zeros(size // 2)
        return model

    step = crocoddyl.IntegratedActionModelRK(dynamics(running), control, crocoddyl.RKType.four, h)
    end = crocoddyl.IntegratedActionModelEuler(dynamics(last), 0.0)
    guess = problem.nodes(steps) @ change.T

    def solve():
        program = crocoddyl.ShootingProblem(guess[0], [step] * steps, end)
        solver = crocoddyl.SolverFDDP(program)
        inputs = problem.guess(steps)[:, None]
        found = solver.solve(list(guess), list(inputs), 1000, False)
        inputs = np.array(solver.us)[:, 0]
        assert found
        return Found(size * (steps + 1) + steps, size * (steps + 1), solver.iter, inputs, problem.duration)

    return solve


PROBLEMS = [
    Problem(
        "Pole on a cart", CartPole, of_cart, [0.0, np.pi], [0.0, 0.0], pushes, DURATION, pinocchio=cart_of_pinocchio
    ),
    Problem("Least time of a mass", Mass, lambda x, u, of: [u], [0.0], [3.0], np.ones, 2.0, bound=2.0),
    Problem(
        "Acrobot", Acrobot, of_acrobot, [0.0, 0.0], [np.pi, np.pi],
        lambda steps: 3.0 * np.sin(2.2 * np.arange(steps) * 3.0 / steps), 3.0,
        pinocchio=acrobot_of_pinocchio, actuated=1, relative=np.array([[1.0, 0.0], [-1.0, 1.0]]),
    ),
]  # fmt: skip


def missed(problem, found):
    """The distance of the end from its place, by another integrator with a small tolerance."""
    zero = np.zeros(len(problem.start))
    y, h = np.concatenate([problem.start, zero]), found.duration / len(found.inputs)
    for u in found.inputs:
        y = solve_ivp(problem.system(u=u).rhs, (0.0, h), y, "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    return np.linalg.norm(y - np.concatenate([problem.end, zero]))


def cost(problem, found):
    return found.duration if problem.is_of_time else found.duration * np.mean(found.inputs**2) / 2.0


def best(problem):
    """The least cost, in closed form or on a fine mesh."""
    if problem.is_of_time:
        return 2.0 * np.sqrt(problem.end[0] / problem.bound)
    return cost(problem, shooting(problem, problem.system(), 400, 8))


def cpu():
    """CPU time of this process and of the compilers that it has started."""
    used = [resource.getrusage(of) for of in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(of.ru_utime + of.ru_stime for of in used)


def of_text(problem, steps, stages):
    return partial(shooting, problem, problem.system(), steps, stages)


def compiled(problem, steps, stages):
    return partial(shooting, problem, problem.system.native(methods="gauss 4, 8")(), steps, stages)


def of_casadi(problem, steps, degree):
    return partial(collocation, problem, steps, degree)


def tools(problem, steps):
    """Rows of the table: a name, the steps, and what sets the tool up and returns the call that is timed."""
    for stages in (4, 8):
        yield f"`vi.optimise`, text, {stages} stages", steps, partial(of_text, problem, steps, stages)
        yield f"`vi.optimise`, compiled, {stages} stages", steps, partial(compiled, problem, steps, stages)
        yield f"CasADi, collocation of degree {stages}", steps, partial(of_casadi, problem, steps, stages)
    if importlib.util.find_spec("opty"):
        yield "opty, midpoints", 500, partial(opty_of, problem, 500)
    if problem.pinocchio and importlib.util.find_spec("crocoddyl"):
        for count in (steps, 4 * steps):
            yield "Crocoddyl, FDDP", count, partial(crocoddyl_of, problem, count)


def table():
    for name in ("opty", "crocoddyl"):
        if not importlib.util.find_spec(name):
            print(f"{name} is not installed and is left out.", file=sys.stderr)
    for problem, steps in zip(PROBLEMS, (50, 20, 100), strict=True):
        least = best(problem)
        print(f"\n{problem.name}: least cost {least:.6f}\n")
        print(
            "| | steps | variables | constraints | iterations | set-up | CPU time | excess of cost | end, by DOP853 |"
        )
        print("|---|---|---|---|---|---|---|---|---|")
        for name, count, prepare in tools(problem, steps):
            begin = cpu()
            solve = prepare()
            prepared, times = cpu() - begin, []
            for _ in range(REPEATS):
                begin = cpu()
                found = solve()
                times.append(cpu() - begin)
            print(
                f"| {name} | {count} | {found.variables} | {found.constraints} | {found.iterations} "
                f"| {prepared:.1f} s | {1e3 * statistics.median(times):.0f} ms | {cost(problem, found) - least:.1e} "
                f"| {missed(problem, found):.1e} |",
                flush=True,
            )


def swing_figure(plt):
    coarse = vi.optimise(
        CartPole(), steps=25, duration=DURATION, start=([0.0, np.pi], [0.0, 0.0]), end=([0.0, 0.0], [0.0, 0.0]),
        cost="u^2 / 2", guess={"u": pushes(25)},
    )  # fmt: skip
    fine = coarse.again(steps=100)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained")
    x, a = fine["x"], fine["a"]
    for k in range(0, 101, 4):
        shade = plt.cm.viridis(k / 100)
        left.plot([x[k], x[k] + 0.5 * np.sin(a[k])], [0.0, 0.5 * np.cos(a[k])], color=shade, lw=1.2)
        left.plot(x[k] + 0.5 * np.sin(a[k]), 0.5 * np.cos(a[k]), "o", color=shade, ms=4)
    left.axhline(0.0, color="0.6", lw=0.8, zorder=0)
    left.set_aspect("equal")
    left.set(title="the pole, from below (dark) to the top (light)", xlabel="x, m", ylabel="y, m")
    for found, label in ((coarse, "25 steps"), (fine, "100 steps")):
        right.stairs(found["u"], found.t, label=f"{label}, cost {found.cost:.2f}", baseline=None)
    right.set(title="force on the cart", xlabel="t, s", ylabel="u, N")
    right.legend(frameon=False)
    figure.savefig(FIGURES / "optimal-swing-up.svg", metadata={"Date": None})


def transfer_figure(plt):
    end = {"r": 1.5, "x * dot(x) + y * dot(y)": 0.0, "x * dot(y) - y * dot(x)": np.sqrt(1.5)}
    found = vi.optimise(
        Craft(), steps=40, duration=12.0, start=([1.0, 0.0], [0.0, 1.0]), end=end, cost="(ux^2 + uy^2) / 2",
        guess={"ux": 0.0},
    )  # fmt: skip
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    for radius in (1.0, 1.5):
        left.plot(radius * np.cos(turn), radius * np.sin(turn), color="0.8", lw=1.0)
    left.plot(found["x"], found["y"], ".-", ms=4, lw=1.0)
    x, y = found.solution.q[:-1].T
    left.quiver(x, y, found["ux"], found["uy"], color="tab:red", width=0.005, scale=0.12, zorder=3)
    left.plot(0.0, 0.0, "o", color="0.3")
    left.set_aspect("equal")
    left.set(title="orbit and thrust", xlabel="x", ylabel="y")
    right.stairs(np.hypot(found["ux"], found["uy"]), found.t, baseline=None, label="thrust")
    right.set(title="thrust and radius", xlabel="t", ylabel="thrust")
    other = right.twinx()
    other.plot(found.t, found["r"], color="tab:orange", label="radius")
    other.set_ylabel("radius")
    lines = [of.get_legend_handles_labels() for of in (right, other)]
    right.legend(lines[0][0] + lines[1][0], lines[0][1] + lines[1][1], frameon=False, loc="upper left")
    figure.savefig(FIGURES / "optimal-transfer.svg", metadata={"Date": None})


def main():
    if "--figures" not in sys.argv:
        table()
        return
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "optimal", "svg.fonttype": "none"})
    import matplotlib.pyplot as plt

    swing_figure(plt)
    transfer_figure(plt)


if __name__ == "__main__":
    main()
