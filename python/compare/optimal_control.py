"""Optimal control of docs/python/optimal_control.md: its figures, and its table against collocation in CasADi.

    python optimal_control.py            # prints the table
    python optimal_control.py --figures  # writes the figures into docs/figures

It needs casadi, scipy and matplotlib.
"""

import sys
import time
from pathlib import Path

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

FIGURES = Path(__file__).resolve().parents[2] / "docs" / "figures"

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


def shooting(system, steps, stages):
    begin = time.process_time()
    found = vi.optimise(
        system, steps=steps, duration=DURATION, start=([0.0, np.pi], [0.0, 0.0]), end=([0.0, 0.0], [0.0, 0.0]),
        cost="u^2 / 2", guess={"u": pushes(steps)}, stages=stages,
    )  # fmt: skip
    assert found.success
    return 1 + 4 * (steps + 1) + steps, found.iterations, time.process_time() - begin, found.cost, found["u"]


def rate(x, u):
    """The accelerations of the cart and of the pole, derived by hand."""
    big, m, length, g = 1.0, 0.2, 0.5, 9.81
    _, a, vx, va = (x[i] for i in range(4))
    # (M + m) x'' + m l cos(a) a'' = u + m l sin(a) a'^2, cos(a) x'' + l a'' = g sin(a)
    cart = (u + m * length * ca.sin(a) * va**2 - m * g * ca.sin(a) * ca.cos(a)) / (big + m * ca.sin(a) ** 2)
    return ca.vertcat(vx, va, cart, (g * ca.sin(a) - ca.cos(a) * cart) / length)


def collocation(steps, degree):
    """The same problem by Gauss-Legendre collocation, with exact second derivatives."""
    begin = time.process_time()
    h = DURATION / steps
    c, d, _ = ca.collocation_coeff(ca.collocation_points(degree, "legendre"))
    # The first guess is the motion of the pushes, as of the other method.
    run = CartPole(u=pushes(steps)[0]).integrate(q=[0.0, np.pi], h=h)
    nodes = [np.concatenate([run.q, run.v])]
    for push in pushes(steps):
        run.set(u=push).step()
        nodes.append(np.concatenate([run.q, run.v]))
    x = ca.SX.sym("x0", 4)
    variables, guess, rows = [x], [nodes[0]], [x - np.array([0.0, np.pi, 0.0, 0.0])]
    cost = 0.0
    for k in range(steps):
        u, inner = ca.SX.sym(f"u{k}"), ca.SX.sym(f"s{k}", 4, degree)
        slopes = ca.horzcat(*(rate(inner[:, i], u) for i in range(degree)))
        rows.append(ca.vec(ca.mtimes(ca.horzcat(x, inner), c) - h * slopes))
        end = ca.mtimes(ca.horzcat(x, inner), d)
        x = ca.SX.sym(f"x{k + 1}", 4)
        rows.append(end - x)
        cost += h * u**2 / 2.0
        variables += [u, ca.vec(inner), x]
        guess += [[pushes(steps)[k]], np.repeat(nodes[k], degree).reshape(4, degree).T.ravel(), nodes[k + 1]]
    rows.append(x)
    program = {"x": ca.vertcat(*variables), "f": cost, "g": ca.vertcat(*rows)}
    options = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-10, "max_iter": 1000}}
    solver = ca.nlpsol("collocation", "ipopt", program, options)
    found = solver(x0=np.concatenate(guess), lbg=0.0, ubg=0.0)
    assert solver.stats()["success"]
    numbers = np.asarray(found["x"]).ravel()
    inputs = numbers[4 :: 5 + 4 * degree][:steps]
    return len(numbers), solver.stats()["iter_count"], time.process_time() - begin, float(found["f"]), inputs


def missed(inputs):
    """The distance of the end from the top, by another integrator with a small tolerance."""
    y = np.array([0.0, np.pi, 0.0, 0.0])
    h = DURATION / len(inputs)
    for u in inputs:
        y = solve_ivp(CartPole(u=u).rhs, (0.0, h), y, "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    return np.linalg.norm(y)


def table():
    native = CartPole.native(methods="gauss 4, 8")
    rows = []
    for steps in (25, 50):
        for stages in (4, 8):
            kinds = [
                ("text", lambda steps, stages: shooting(CartPole(), steps, stages)),
                ("compiled", lambda steps, stages: shooting(native(), steps, stages)),
                ("CasADi, collocation", collocation),
            ]
            for name, solve in kinds:
                best = min((solve(steps, stages) for _ in range(3)), key=lambda of: of[2])
                rows.append((steps, stages, name, *best))
    print("| steps | stages | | variables | iterations | CPU time | cost | end, by DOP853 |")
    print("|---|---|---|---|---|---|---|---|")
    for steps, stages, name, size, iterations, took, cost, inputs in rows:
        print(
            f"| {steps} | {stages} | {name} | {size} | {iterations} | {1e3 * took:.0f} ms | {cost:.6f} "
            f"| {missed(inputs):.1e} |"
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
