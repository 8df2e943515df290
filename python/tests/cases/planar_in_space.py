"""jgerstmayr/EXUDYN#39: a planar linkage from bodies in space with hinges has redundant constraints; the Jacobian is singular.
Here: a four-bar of three bodies with `rotation` and four hinges of five constraints (20 + 3 on 21 coordinates: 3 too many).
Right: the planar four-bar (FourBar in angles, constraints 2), itself checked by motor_fourbar.py."""

import numpy as np

import variational as vi


def text(dropped):
    def joint(name, a, b):
        return a, b

    # bodies: 0 crank (1.0), 1 coupler (3.0), 2 rocker (2.5); x is the centre, the body's x axis is along the link, hinge axis z
    pins = {
        "A": "x[0] - turn(R[0], [l[0] / 2, 0, 0])",
        "B": "x[0] + turn(R[0], [l[0] / 2, 0, 0]) - x[1] + turn(R[1], [l[1] / 2, 0, 0])",
        "C": "x[1] + turn(R[1], [l[1] / 2, 0, 0]) - x[2] - turn(R[2], [l[2] / 2, 0, 0])",
        "D": "x[2] - turn(R[2], [l[2] / 2, 0, 0]) - [d, 0, 0]",
    }
    lets, out = [], []
    for n, e in pins.items():
        lets.append(f"let pin{n} = {e};")
        for k in range(3):
            if f"p{n}{k}" not in dropped:
                out.append(f"constraint p{n}{k} = pin{n}[{k}];")
    axes = {"A": ("ez", 0), "B": (0, 1), "C": (1, 2), "D": ("ez", 2)}
    for i in range(3):
        lets += [
            f"let ax{i} = turn(R[{i}], [1, 0, 0]), ay{i} = turn(R[{i}], [0, 1, 0]), az{i} = turn(R[{i}], [0, 0, 1]);"
        ]
    for n, (i, j) in axes.items():
        z = "[0, 0, 1]" if i == "ez" else f"az{i}"
        for k, a in enumerate("xy"):
            if f"h{n}{k}" not in dropped:
                out.append(f"constraint h{n}{k} = {z} * a{a}{j};")
    return (
        "struct Space {\n param l[3] = [1.0, 3.0, 2.5], m[3] = [0.5, 1.5, 1.2], d = 3.2, g = 9.81;\n coord x[3][3];\n rotation R[3];\n"
        + " let w[i in 0..3] = rate(R[i]);\n L = sum(i in 0..3, m[i] * dot(x[i]) * dot(x[i]) / 2 + m[i] * l[i]^2 * (w[i][1]^2 + w[i][2]^2 + w[i][0]^2 / 100) / 24 - m[i] * g * x[i][1]);\n "
        + "\n ".join(lets + out)
        + "\n}"
    )


l = np.array([1.0, 3.0, 2.5])
d = 3.2


def close(a, b, c):
    for _ in range(50):
        r = np.array(
            [
                l[0] * np.cos(a) + l[1] * np.cos(b) - d - l[2] * np.cos(c),
                l[0] * np.sin(a) + l[1] * np.sin(b) - l[2] * np.sin(c),
            ]
        )
        J = np.array([[-l[1] * np.sin(b), l[2] * np.sin(c)], [l[1] * np.cos(b), -l[2] * np.cos(c)]])
        s = np.linalg.solve(J, r)
        b -= s[0]
        c -= s[1]
    return b, c


a0 = 0.4
b0, c0 = close(a0, 0.8, 1.6)
th = np.array([a0, b0, c0])
ends = l[0] * np.array([np.cos(a0), np.sin(a0)])
cen = np.array(
    [
        [*ends / 2, 0],
        [*(ends + l[1] / 2 * np.array([np.cos(b0), np.sin(b0)])), 0],
        [d + l[2] / 2 * np.cos(c0), l[2] / 2 * np.sin(c0), 0],
    ]
)
q0 = np.concatenate([cen.ravel(), np.stack([np.cos(th / 2), 0 * th, 0 * th, np.sin(th / 2)], 1).ravel()])
try:
    S = vi.System(text(set()))
    try:
        S().integrate(q0, np.zeros(21), h=0.01)
        print("the whole text runs")
    except vi.Redundant as e:
        print("Redundant:", e)
except vi.CompileError as e:
    print("refused by counting, although it moves:", str(e).splitlines()[0], "|", str(e).splitlines()[-1])
# Three by hand that follow from the others in a plane: the last hinge keeps two constraints.
S = vi.System(text({"hD0", "hD1", "pD2"}))
run = S().integrate(q0, np.zeros(21), h=0.01)
sol = run.until(1.0)
P = vi.System(open(__file__.replace("planar_in_space", "motor_fourbar")).read().split('"""')[3])
pl = P().integrate(th, np.zeros(3), h=0.005).until(1.0).q[-1]
got = 2 * np.arctan2(sol.q[-1][[12, 16, 20]], sol.q[-1][[9, 13, 17]])
print(
    "angles",
    got,
    pl,
    "error",
    np.abs(np.angle(np.exp(1j * (got - pl)))).max(),
    "out of plane",
    np.abs(sol.q[:, [2, 5, 8]]).max(),
)
assert np.abs(np.angle(np.exp(1j * (got - pl)))).max() < 1e-6
