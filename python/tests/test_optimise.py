"""Optimal control: against closed forms, other solutions and differences."""

import sys

import numpy as np
import pytest

import variational as vi
from variational._optimise import _Problem

pytest.importorskip("casadi")

Mass = vi.System("struct Mass { input u = 0.0; coord x; L = dot(x)^2 / 2; force x = u; }")
Spring = vi.System("""
struct Spring {
    param c = 0.2;
    input u = 0.0;
    coord x;
    L = dot(x)^2 / 2 - x^2 / 2;
    force x = u - c * dot(x);
}
""")
CartPole = vi.System("""
struct CartPole {
    param M = 1.0, m = 0.2, l = 0.5, g = 9.81;
    input u = 0.0;
    coord x, a;
    L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 - m * g * l * cos(a);
    force x = u;
}
""")
Craft = vi.System("""
struct Craft {
    input ux = 0.0, uy = 0.0;
    coord x, y;
    let r = sqrt(x^2 + y^2);
    L = (dot(x)^2 + dot(y)^2) / 2 + 1 / r;
    force x = ux;
    force y = uy;
}
""")
SWING = {
    "duration": 2.5,
    "start": ([0.0, np.pi], [0.0, 0.0]),
    "end": ([0.0, 0.0], [0.0, 0.0]),
    "cost": "u^2 / 2",
    "stages": 4,
}


def pushes(steps):
    return {"u": 2.0 * np.sin(5.0 * np.arange(steps) * 2.5 / steps)}


def test_least_time_of_a_mass():
    # Full force forwards, then backwards: t = 2 √(d / u).
    options = {"duration": (0.1, 10.0), "start": ([0.0], [0.0]), "end": ([3.0], [0.0]), "cost": "1"}
    found = vi.optimise(Mass(), steps=20, inputs={"u": (-2.0, 2.0)}, **options)
    assert found.success and found.residual < 1e-13
    assert abs(found.t[-1] - 2.0 * np.sqrt(1.5)) < 1e-8 and abs(found.cost - found.t[-1]) < 1e-14
    assert np.allclose(found["u"], np.repeat([2.0, -2.0], 10), atol=1e-8) and np.abs(found.u).max() <= 2.0
    # The multipliers are derivatives: dt/dd = 1 / √(d u).
    assert abs(found.costates[0, 0] + 1.0 / np.sqrt(6.0)) < 1e-7
    # A bound of the velocity, which is reached: t = d / v + v / u.
    slow = found.again(steps=42, bounds={"dot(x)": (None, 1.0)})
    assert abs(slow.t[-1] - 3.5) < 1e-7 and slow["dot(x)"].max() <= 1.0 + 1e-12 and found["dot(x)"].max() > 2.0
    assert slow.multipliers["dot(x)"].max() > 0.01 and slow.multipliers["dot(x)"].min() > -1e-8


def test_least_energy_of_a_mass():
    steps, duration, d = 20, 2.0, 1.5
    found = vi.optimise(Mass(), steps=steps, duration=duration, start=([0.0], [0.0]), end=([d], [0.0]), cost="u^2")
    # The discrete problem: the least norm of two conditions.
    h = duration / steps
    left = duration - h * (np.arange(steps) + 0.5)
    exact = np.linalg.lstsq(h * np.array([left, np.ones(steps)]), [d, 0.0], rcond=None)[0]
    assert np.abs(found["u"] - exact).max() < 1e-12 and abs(found.cost - h * exact @ exact) < 1e-12
    # The continuous one: 6 d / T² - 12 d t / T³, and the cost 12 d² / T³.
    t = (found.t[1:] + found.t[:-1]) / 2.0
    assert np.abs(found["u"] - 6.0 * d / duration**2 * (1.0 - 2.0 * t / duration)).max() < 0.01
    assert 0.0 < found.cost - 12.0 * d**2 / duration**3 < 0.01
    assert vi.optimise(**{**found._problem, "steps": 3}).residual < 1e-14


def riccati(h, steps, q, r, last):
    """Gains and cost matrices of a spring by the discrete Riccati equation, whose integrals have three Gauss points."""

    def step(length):
        return Spring().integrate(q=[0.0], h=length).linearization()

    a, b = step(h).A, step(h).B
    both = np.zeros((3, 3))
    for place, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
        part = step((1.0 + place) / 2.0 * h)
        rows = np.hstack([part.A, part.B])
        both += h * weight / 2.0 * rows.T @ q @ rows
    both[2, 2] += h * r
    p, gains, costs = last, [], [last]
    for _ in range(steps):
        total = both + np.hstack([a, b]).T @ p @ np.hstack([a, b])
        gains.append(total[2, :2] / total[2, 2])
        p = total[:2, :2] - np.outer(total[:2, 2], gains[-1])
        costs.append(p)
    return a, b[:, 0], gains[::-1], costs[::-1]


def test_linear_quadratic_regulator():
    steps, duration = 15, 3.0
    found = vi.optimise(
        Spring(), steps=steps, duration=duration, start=([1.0], [-0.5]),
        cost="x^2 + dot(x)^2 / 2 + u^2 / 10", final="3 * x^2 + x * dot(x)",
    )  # fmt: skip
    a, b, gains, costs = riccati(duration / steps, steps, np.diag([1.0, 0.5]), 0.1, np.array([[3.0, 0.5], [0.5, 0.0]]))
    x = np.array([1.0, -0.5])
    assert abs(found.cost - x @ costs[0] @ x) < 1e-10
    for k in range(steps):
        u = -gains[k] @ x
        assert abs(found.u[k, 0] - u) < 1e-8
        x = a @ x + b * u
        # Derivatives of the least cost from here on.
        assert np.abs(found.costates[k] - 2.0 * costs[k + 1] @ x).max() < 1e-8
    assert np.abs([found["x"][-1], found["dot(x)"][-1]] - x).max() < 1e-12


def test_swing_up_of_a_cart_pole():
    found = vi.optimise(CartPole(), steps=25, guess=pushes(25), **SWING)
    # Less friction of discretization than the 18.988022 of `examples/swing_up.rs`, by steps of two stages.
    assert found.success and abs(found.cost - 19.003632) < 1e-6
    assert found.residual < 1e-12 and np.abs(found.solution.q[-1]).max() < 1e-10
    assert found.errors.shape == (25, 2) and 1e-8 < found.errors.max() < 1e-5
    balance = found.energy_balance
    assert abs(balance.change - 0.4 * 0.5 * 9.81) < 1e-12 and abs(balance.change - balance.work) < 1e-5
    # Shorter steps: more freedom and less error, from the optimum as the guess.
    finer = found.again(steps=50, stages=8)
    assert finer.success and finer.iterations < 10 and 0.0 < found.cost - finer.cost < 1.0
    assert finer.errors.max() < 1e-12 and abs(finer.energy_balance.change - finer.energy_balance.work) < 1e-12
    assert finer.energy_balance.other == 0.0


def test_steps_with_large_errors_are_halved():
    found = vi.optimise(CartPole(), steps=25, guess=pushes(25), **SWING)
    limit = 1e-7
    large = found.errors.max(axis=1) > limit
    assert 0 < large.sum() < 25
    finer = found.refined(limit)
    assert finer.success and finer.errors.max() <= limit and 25 + large.sum() <= len(finer.u) < 50
    # Steps with small errors stay.
    assert all(np.abs(finer.t - t).min() < 1e-14 for t in found.t)
    assert finer.cost < found.cost
    assert finer.refined(limit) is finer
    with pytest.raises(ValueError, match="after 1 rounds .* give more rounds"):
        found.refined(1e-11, rounds=1)
    with pytest.raises(ValueError, match="error must be positive"):
        found.refined(0.0)
    # A free duration stays free, and given times have their span.
    options = {"start": ([1.0], [0.0]), "end": ([0.0], [0.0]), "method": "fixed"}
    Hard = vi.System("""
    struct Hard { input u = 0.0; coord x; L = dot(x)^2 / 2 - x^4 / 4; force x = u; discretize midpoint; }
    """)
    fast = vi.optimise(Hard(), steps=8, duration=(0.1, 9.0), cost="1", inputs={"u": (-2.0, 2.0)}, **options)
    finer = fast.refined(3e-4)
    assert len(finer.u) > 8 and 0.0 < abs(finer.t[-1] - fast.t[-1]) < 0.1
    later = vi.optimise(Hard(), steps=np.linspace(1.0, 3.0, 6), cost="u^2", **options).refined(2e-3)
    again = later.again(steps=4)
    assert len(again.u) == 4 and abs(again.t[0] - 1.0) < 1e-15 and abs(again.t[-1] - 3.0) < 1e-14
    assert len(later.u) > 5 and abs(later.t[0] - 1.0) < 1e-15 and abs(later.t[-1] - 3.0) < 1e-14


@pytest.mark.long
def test_swing_up_is_that_of_the_rust_example(warm_cache):
    pole = CartPole.native(methods="gauss 2")()
    found = vi.optimise(pole, steps=25, guess=pushes(25), **{**SWING, "stages": 2})
    # The output of `cargo run --example swing_up`.
    assert abs(found.cost - 18.988022) < 1e-6 and abs(found.u[0, 0] + 5.1633) < 1e-4


def transfer():
    """From a circle of radius 1 to one of radius 1.5, with the least thrust."""
    end = {"r": 1.5, "x * dot(x) + y * dot(y)": 0.0, "x * dot(y) - y * dot(x)": np.sqrt(1.5)}
    return vi.optimise(
        Craft(), steps=40, duration=12.0, start=([1.0, 0.0], [0.0, 1.0]), end=end, cost="(ux^2 + uy^2) / 2",
        guess={"ux": 0.0},
    )  # fmt: skip


def test_transfer_between_circles():
    from scipy.integrate import solve_ivp

    found = transfer()
    assert found.success and found.residual < 1e-9
    assert np.abs(found["r"][[0, -1]] - [1.0, 1.5]).max() < 1e-9
    # The problem does not change by a turn: neither does the angular momentum of nodes and costates.
    (x, y), (vx, vy) = found.solution.q[1:].T, found.solution.p[1:].T
    of_x, of_y, of_vx, of_vy = found.costates.T
    moment = x * of_y - y * of_x + vx * of_vy - vy * of_vx
    assert np.abs(moment).max() < 1e-9  # zero: the angle of the end is free
    # The work of the thrust is the difference of the energies of the circles.
    balance = found.energy_balance
    assert abs(balance.change - (1.0 / 2.0 - 1.0 / 3.0)) < 1e-9 and abs(balance.work - balance.change) < 1e-11
    # Another program arrives at the same place.
    y = np.array([1.0, 0.0, 0.0, 1.0])
    for k in range(40):
        system = Craft(ux=found.u[k, 0], uy=found.u[k, 1])
        y = solve_ivp(system.rhs, (0.0, found.t[1]), y, "DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    assert np.abs(y - np.concatenate([found.solution.q[-1], found.solution.v[-1]])).max() < 1e-9


@pytest.mark.long
def test_swing_up_on_a_rod():
    # The same pendulum in Cartesian coordinates with a constraint, and by its angle.
    Rod = vi.System("""
    struct Rod {
        input u = 0.0;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - y;
        constraint rod = x^2 + y^2 - 1;
        force x = -u * y;
        force y = u * x;
    }
    """)
    Angle = vi.System("struct Angle { input u = 0.0; coord a; L = dot(a)^2 / 2 + cos(a); force a = u; }")
    options = {"steps": 30, "duration": 5.0, "cost": "u^2 / 2"}
    pushes = {"u": 0.3 * np.sign(np.sin(np.arange(30) / 6.0))}
    exact = vi.optimise(Angle(), start=([0.0], [0.0]), end=([np.pi], [0.0]), guess=pushes, **options)
    start, half = ([0.0, -1.0], [0.0, 0.0]), {"u": exact["u"] / 2.0}
    found = vi.optimise(Rod(), start=start, end=([0.0, 1.0], [0.0, 0.0]), guess=half, **options)
    assert found.success and found.residual < 1e-12 and abs(found.cost - exact.cost) < 1e-8
    # To the one side or to the other.
    assert np.abs(np.abs(found.u) - np.abs(exact.u)).max() < 1e-6
    assert np.abs(found["norm([x, y])"] - 1.0).max() < 1e-14 and np.abs(found.solution.q[-1] - [0.0, 1.0]).max() < 1e-11
    # Independent conditions, of which one is an expression.
    fewer = found.again(end={"x": 0.0, "x * dot(y) - y * dot(x)": 0.0})
    assert fewer.iterations < 10 and abs(fewer.cost - exact.cost) < 1e-8


Driven = vi.System("""
struct Driven {
    param c = 0.1;
    input u = 0.0, w[2] = [0.1, -0.2];
    coord x, y;
    L = (1 + x^2 / 4) * dot(x)^2 / 2 + dot(y)^2 / 2 + sin(x) * dot(y) + u * dot(x) / 3 - cos(t) * x * y;
    force x = w[0] - c * dot(x);
    force y = w[1] * x;
}
""")


def test_derivatives_are_those_of_differences():
    # Everything varies: a free duration, an explicit time, an input in a momentum.
    problem = _Problem(Driven(), [0.0, 1.0, 1.5, 3.0], (0.5, 5.0), 0.3, None, 4)
    problem.set_inputs(["u", "w"])
    problem.set_costs("x^2 * dot(y) + u * w[0] + t * w[1]^2", "x * dot(x) + t + u")
    problem.set_end("start", {"x": 0.3, "dot(x)": 0.4}, [0])
    problem.set_end("end", {"x * dot(y) + u": (0.0, 1.0), "t": (0.0, 9.0)}, [3])
    problem.set_bounds({"dot(x) * y + t * w[0]": (-1.0, 1.0), "y": (-1.0, 1.0)})
    random = np.random.default_rng(1)
    x = random.uniform(-0.5, 0.5, problem.size)
    x[0] = 1.1
    program = problem.program
    weights = random.uniform(-1.0, 1.0, len(program.row_bounds()))

    def dense(pattern, entries, height):
        starts, rows = pattern
        found = np.zeros((height, problem.size))
        found[rows, np.repeat(np.arange(problem.size), np.diff(starts))] = entries
        return found

    def gradients(x):
        total, gradient, values, entries, error = program.evaluate(x)
        assert error is None
        return total, gradient, values, dense(program.jacobian_pattern(), entries, len(values))

    _, gradient, _, jacobian = gradients(x)
    half = dense(program.hessian_pattern(), program.hessian(x, 0.7, weights), problem.size)
    hessian = half + half.T - np.diag(np.diag(half))
    assert np.abs(np.tril(half, -1)).max() == 0.0
    for column, change in enumerate(1e-5 * np.eye(problem.size)):
        above, below = gradients(x + change), gradients(x - change)
        slopes = [(a - b) / 2e-5 for a, b in zip(above, below, strict=True)]
        assert abs(slopes[0] - gradient[column]) < 1e-8
        assert np.abs(slopes[2] - jacobian[:, column]).max() < 1e-8
        curvature = 0.7 * slopes[1] + weights @ slopes[3]
        assert np.abs(curvature - hessian[column]).max() < 1e-6


def test_methods_and_nodes():
    # Steps of other lengths, by another method, from the time of the first node on.
    Ruled = vi.System(Spring.definition.replace("coord x;", "coord x; discretize midpoint;", 1))
    times = [1.0, 1.2, 1.6, 2.0, 3.0]
    start, end = {"x": 1.0, "dot(x)": (-0.5, 0.5)}, {"x": 0.0, "dot(x)": 0.0}
    found = vi.optimise(Ruled(), steps=times, start=start, end=end, cost="u^2", method="fixed")
    assert np.allclose(found.t, times, atol=1e-15) and found.success
    assert np.abs(found.solution.q[[0, -1], 0] - [1.0, 0.0]).max() < 1e-12
    # The start moves to the end: no bound holds its velocity, and nothing would be gained by another one.
    assert -0.5 < found["dot(x)"][0] < -0.4 and abs(found.multipliers["dot(x) of start"][0]) < 1e-8
    slower = found.again(start={"x": 1.0, "dot(x)": (-0.3, 0.5)})
    assert abs(slower["dot(x)"][0] + 0.3) < 1e-8 and slower.multipliers["dot(x) of start"][0] < -1e-3


def test_guesses():
    options = {"steps": 10, "start": ([0.0], [0.0]), "end": ([1.0], [0.0]), "cost": "u^2"}
    found = vi.optimise(Mass(), duration=2.0, **options)
    rolled = vi.optimise(Mass(), duration=2.0, guess={"u": found["u"]}, **options)
    again = vi.optimise(Mass(), duration=2.0, guess=found.solution, **options)
    for other in (rolled, again):
        assert np.abs(other.u - found.u).max() < 1e-9
    # A free duration takes all the time that it gets.
    free = vi.optimise(Mass(), duration=(1.0, None), bounds={"t": (None, 3.0)}, guess={"duration": 2.0}, **options)
    assert free.success and abs(free.t[-1] - 3.0) < 1e-6
    # A loop takes the first input of each optimum.
    spring, plan = Spring(), None
    run = spring.integrate(q=[1.0], h=0.2)
    for _ in range(20):
        at = (run.q, run.v)
        if plan is None:
            plan = vi.optimise(spring, steps=10, duration=2.0, start=at, cost="x^2 + dot(x)^2 + u^2 / 100")
        else:
            plan = plan.again(start=at)
        run.set(u=plan.u[0, 0]).step()
    assert abs(run.q[0]) < 0.03 and abs(run.v[0]) < 0.03


def test_an_array_of_inputs():
    Two = vi.System("""
    struct Two {
        input w[2] = 0.0;
        coord q[2];
        L = (dot(q[0])^2 + dot(q[1])^2) / 2;
        force q[0] = w[0];
        force q[1] = w[1];
    }
    """)
    options = {"steps": 8, "duration": 2.0, "start": ([0.0, 0.0], [0.0, 0.0]), "cost": "w[0]^2 + w[1]^2"}
    one = vi.optimise(Mass(), **{**options, "start": ([0.0], [0.0]), "cost": "u^2"}, end={"x": 1.0})
    both = vi.optimise(Two(), **options, end={"q[0]": 1.0, "q[1]": -1.0}, guess={"w": np.ones((8, 2)), "w[1]": 0.0})
    assert both.inputs == ("w[0]", "w[1]") and both["w"].shape == (8, 2) and both["w[0]"].shape == (8,)
    assert np.abs(both["w"] - one["u"][:, None] * [1.0, -1.0]).max() < 1e-9
    # The same by arrays: values of all entries at the end, one bound for all of them, one number of each input.
    again = vi.optimise(Two(), **options, end={"q": [1.0, -1.0]}, bounds={"q": (-2.0, 2.0)}, guess={"w": [1.0, 0.0]})
    assert np.abs(again["w"] - both["w"]).max() < 1e-9
    stops = [{"q": [1.0, -1.0], of: 0.0} for of in ("dot(q)", "dot(q[0])", "p_q[0]", "p_q[1]")]
    at_rest, *halves = (vi.optimise(Two(), **options, end=stop) for stop in stops)
    assert np.abs(at_rest.solution.v[-1]).max() < 1e-12
    for half, stopped, other in zip(halves, (0, 0, 1), (1, 1, 0), strict=True):
        assert np.abs(half["w"][:, stopped] - at_rest["w"][:, stopped]).max() < 1e-9
        assert np.abs(half["w"][:, other] - both["w"][:, other]).max() < 1e-9
    for end, words in (({"q": [1.0]}, r"list of the shape \(2,\)"), ({"q + 1 * q": 0.0}, "entries one by one")):
        with pytest.raises(ValueError, match=words):
            vi.optimise(Two(), **options, end=end)
    # One of them stays as the system has it.
    single = vi.optimise(Two(w=[0.5, 0.0]), **options, end={"q[1]": 1.0}, inputs="w[1]", guess={"w[1]": 1.0})
    assert single.inputs == ("w[1]",) and (single.solution["w[0]"] == 0.5).all()
    assert np.abs(single["w[1]"] - one["u"]).max() < 1e-9


def test_every_method_of_given_length():
    Quartic = vi.System("""
    struct Quartic { input u = 0.0; coord x; L = dot(x)^2 / 2 - x^4 / 4; force x = u; discretize midpoint; }
    """)
    options = {"steps": 20, "duration": 3.0, "start": ([1.0], [0.0]), "end": ([0.0], [0.0]), "cost": "u^2 + x^2"}
    costs = {}
    for method in Quartic._methods:
        if method not in ("energy", "adaptive"):
            found = vi.optimise(Quartic(), method=method, **options)
            assert found.success and found.residual < 1e-12
            costs[method] = found.cost
    assert len(costs) == 7 and abs(costs.pop("fixed") - costs["gauss"]) < 0.01
    assert all(abs(cost - costs["gauss"]) < 1e-5 for cost in costs.values())


def test_what_is_not_found_is_told():
    # The bound of the force is too small for the time.
    options = {
        "duration": 1.0,
        "start": ([0.0], [0.0]),
        "end": ([3.0], [0.0]),
        "cost": "1",
        "options": {"max_iter": 100},
    }
    found = vi.optimise(Mass(), steps=10, inputs={"u": (-1.0, 1.0)}, **options)
    assert not found.success and found.residual > 0.1 and "not converged" in repr(found)
    assert f", of {found.worst}\n" in repr(found)
    assert found.advice == (
        "no motion that keeps the conditions was found (u is at a bound in 10 of 10 steps): "
        "give more time, wider bounds or another guess"
    )
    # A cost with a kink where its least value is.
    kink = vi.optimise(Mass(), steps=10, inputs={"u": (-4.0, 4.0)}, **{**options, "duration": 3.0, "cost": "abs(u)"})
    assert not kink.success and kink.residual < 1e-9
    assert kink.advice == "abs in the cost has a kink: take a square, or sqrt(x^2 + e^2) for abs(x)"
    # Places of the program by name: the unreached end of a mass without force.
    still = vi.optimise(Mass(), steps=2, inputs={"u": (0.0, 1e-9)}, **options)
    assert not still.success and still.worst in ("step 0", "step 1", "dot(x) of end at node 2")
    # Inputs of the second iteration, which no step can follow: the rope would have a negative length.
    Crane = vi.System("""
    struct Crane {
        param M = 1.0, m = 0.5, g = 9.81;
        input F = 0.0, W = 0.0;
        coord x, l, a;
        let X = x + l * sin(a);
        let Y = -l * cos(a);
        L = M * dot(x)^2 / 2 + m * (dot(X)^2 + dot(Y)^2) / 2 - m * g * Y;
        force x = F;
        force l = W;
    }
    """)
    found = vi.optimise(
        Crane(), steps=40, stages=4, duration=(0.5, 10.0), start=([0.0, 1.0, 0.0], np.zeros(3)),
        end=([2.0, 1.0, 0.0], np.zeros(3)), cost="1", inputs={"F": (-5.0, 5.0), "W": (-10.0, 0.0)},
        guess={"W": -4.905, "duration": 3.0}, options={"max_iter": 2},
    )  # fmt: skip
    assert not found.success and "not converged" in repr(found) and found.solution.q.shape == (41, 3)
    assert np.isfinite(found["dot(l)"]).sum() > 30
    with pytest.raises(ValueError, match="no optimum to refine"):
        found.refined(1.0)


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"system": Mass}, TypeError, "needs a system"),
        ({"system": vi.Pendulum()}, ValueError, "has no inputs: declare them"),
        ({"method": "adaptive"}, ValueError, "finds the lengths of its steps"),
        ({"steps": 0}, ValueError, "steps must be an integer from 1"),
        ({"steps": [0.0, 2.0, 1.0]}, ValueError, "ascending times"),
        ({"duration": None}, TypeError, "give duration"),
        ({"duration": -1.0}, ValueError, "duration must be positive"),
        ({"duration": (2.0, 1.0)}, ValueError, "must be ascending"),
        ({"duration": (1.0, None)}, ValueError, "finite greatest duration"),
        ({"cost": None}, ValueError, "give cost"),
        ({"cost": "w^2"}, ValueError, "w"),
        ({"cost": "[u, u]"}, ValueError, "must be a number"),
        ({"inputs": ["w"]}, ValueError, "has no input 'w'"),
        ({"inputs": {"u": 5.0}}, ValueError, "must be two numbers or None, as in inputs={'u': .*set a constant input"),
        ({"inputs": {"u": [(0, 1), (0, 2)]}}, ValueError, "for each entry {'u\\[0\\]': …}"),
        ({"bounds": {"u": (0.0, 1.0)}}, ValueError, "is an input: write its bounds as inputs="),
        ({"bounds": {"x": (0.5, 1.0)}}, ValueError, "exclude its value at the start"),
        ({"bounds": {"x": (0.5,)}}, ValueError, "two numbers or None"),
        ({"start": 0.0}, TypeError, "start must be"),
        ({"guess": 1.0}, TypeError, "guess must be"),
        ({"guess": {"w": 1.0}}, ValueError, "not an input to find"),
        ({"guess": {"u": [1.0]}}, ValueError, "one for each step in the shape"),
        ({"tspan": 1.0}, TypeError, "optimise has no argument"),
    ],
)
def test_wrong_arguments(change, error, words):
    right = {
        "system": Mass(),
        "steps": 5,
        "duration": 1.0,
        "start": ([0.0], [0.0]),
        "end": ([1.0], [0.0]),
        "cost": "u^2",
    }
    with pytest.raises(error, match=words):
        vi.optimise(**{**right, **change})


def test_a_guess_that_fails_is_a_step_error():
    with pytest.raises(vi.StepError):
        vi.optimise(Craft(), steps=5, duration=1.0, start=([0.0, 0.0], [0.0, 1.0]), cost="ux^2 + uy^2")


def test_without_casadi(monkeypatch):
    monkeypatch.setitem(sys.modules, "casadi", None)
    with pytest.raises(ImportError, match="pip install casadi"):
        vi.optimise(Mass(), steps=5, duration=1.0, start=([0.0], [0.0]), cost="u^2")


def test_conditions_without_a_value_are_told():
    mass = vi.System("struct Mass { input u = 0.0; coord x; L = dot(x)^2 / 2; force x = u; }")()
    given = {"steps": 5, "duration": 1.0, "start": ([0.0], [0.0])}
    with pytest.raises(ValueError, match=r"sqrt\(x - 5\) of end has no finite value at node 5 of the guess"):
        vi.optimise(mass, **given, end={"sqrt(x - 5)": 2.0}, cost="u^2")
    with pytest.raises(ValueError, match=r"ln\(x - 3\).* has no finite value at node 0"):
        vi.optimise(mass, **given, bounds={"ln(x - 3)": (0.0, 1.0)}, cost="u^2")
    with pytest.raises(ValueError, match="the cost has no finite value along the guess"):
        vi.optimise(mass, **given, end={"x": 1.0}, cost="ln(x - 2)")
    with pytest.raises(ValueError, match="IPOPT does not take these options"):
        vi.optimise(mass, **given, end={"x": 1.0}, cost="u^2", options={"foo": 1})
