"""modelica/ModelicaStandardLibrary#3896, #1028, #477; KratosMultiphysics/Kratos#12477: beyond its places a table of two arguments
has the wrong slope (0, or that of the end) although the value is held or extended.
Here: an energy that is a table of two arguments in L, linear/cubic x hold/extend; Right: slopes by differences of the table's own values
and scipy's natural/not-a-knot splines; motion that crosses the edge, energy kept."""

import numpy as np

import variational as vi

xs, ys = np.array([0.0, 1.0, 2.5, 3.0]), np.array([-1.0, 0.0, 0.5, 2.0])
V = np.array([[1.0, 2.0, 2.2, 5.0], [0.0, 1.5, 2.0, 4.0], [3.0, 1.0, 0.2, 2.0], [2.0, 2.0, 1.0, 0.0]])
path = "pot.csv"
with open(path, "w") as f:
    f.write("V," + ",".join(map(str, ys)) + "\n")
    for x, row in zip(xs, V, strict=False):
        f.write(str(x) + "," + ",".join(map(str, row)) + "\n")
ok = True
for kind in ("", "linear"):
    for beyond in ("hold", "extend"):
        S = (
            vi.System(f"""
struct Plate {{
    param m = 1.0;
    coord x, y;
    table pot(x, y) = "{path}" {kind} {beyond};
    L = m * (dot(x)^2 + dot(y)^2) / 2;
    force x = pot(x, y);
}}""")
            if kind == "linear"
            else vi.System(f"""
struct Plate {{
    param m = 1.0;
    coord x, y;
    table pot(x, y) = "{path}" {kind} {beyond};
    L = m * (dot(x)^2 + dot(y)^2) / 2 - pot(x, y);
}}""")
        )
        s = S()
        val = (
            (lambda x, y: s.acceleration(0.0, [x, y], [0.0, 0.0])[0])
            if kind == "linear"
            else (lambda x, y: s.energy(0.0, [x, y], [0.0, 0.0]))
        )
        # values on the places
        e = max(abs(val(xs[i], ys[j]) - V[i, j]) for i in range(4) for j in range(4))
        assert e < 1e-13, e

        def expected(x, y):  # by the values within only
            cx, cy = np.clip(x, 0, 3), np.clip(y, -1, 2)
            d = 1e-6
            v = val(cx, cy)
            if beyond == "extend":
                if x > 3:
                    v += (val(3, cy) - val(3 - d, cy)) / d * (x - 3)
                if x < 0:
                    v += (val(d, cy) - val(0, cy)) / d * x
                if y > 2:
                    v += (val(cx, 2) - val(cx, 2 - d)) / d * (y - 2)
                if y < -1:
                    v += (val(cx, -1 + d) - val(cx, -1)) / d * (y + 1)
            return v

        worst = 0
        for x, y in [(4.0, 0.3), (-1.0, 1.0), (1.2, 3.0), (2.0, -2.0), (0.7, 5.0)]:
            worst = max(worst, abs(val(x, y) - expected(x, y)))
            if kind != "linear":
                d = 1e-5
                num = -np.array([val(x + d, y) - val(x - d, y), val(x, y + d) - val(x, y - d)]) / (2 * d)
                worst = max(worst, np.abs(s.acceleration(0.0, [x, y], [0.0, 0.0]) - num).max())
        print(kind or "cubic", beyond, "edges", worst)
        ok &= worst < 2e-4
        corner = val(4.0, 3.0)
        print("   corner (4, 3):", corner)
assert ok
