"""heyoka on 20 and 40 rods and bodies, the systems of `links/src/bin/large.rs`.

In: nothing. Out: rows with the columns of that program. A run is timed REPETITIONS times. Its code was compiled before, in the
seconds of the last column, or stood in heyoka's cache on the disk. The error is the largest difference of a coordinate from heyoka's own run in extended precision,
relative to the largest change of a coordinate.
"""

import time

import heyoka as hy
import numpy as np

REPETITIONS = 7
TOLERANCES = [1e-3, 1e-6, 1e-9, 1e-12, 2.0**-52]
GRAVITY = 9.81


def rods(count):
    """Masses 1 on rods of length 1. The tensions of the rods solve tridiagonal equations, which takes O(N) operations."""
    a = hy.make_vars(*[f"a{i}" for i in range(count)])
    w = hy.make_vars(*[f"w{i}" for i in range(count)])
    # The rods' directions: cosines and sines of the angles between neighbours.
    cosine = [None] + [hy.cos(a[i] - a[i - 1]) for i in range(1, count)]
    sine = [None] + [hy.sin(a[i] - a[i - 1]) for i in range(1, count)]
    diagonal = [hy.expression(1.0 if i == 0 else 2.0) for i in range(count)]
    right = [w[i] ** 2 + (GRAVITY * hy.cos(a[0]) if i == 0 else 0.0) for i in range(count)]
    for i in reversed(range(count - 1)):
        factor = cosine[i + 1] / diagonal[i + 1]
        diagonal[i] -= factor * cosine[i + 1]
        right[i] += factor * right[i + 1]
    tension = [right[0] / diagonal[0]]
    for i in range(1, count):
        tension.append((right[i] + cosine[i] * tension[i - 1]) / diagonal[i])
    turning = []
    for i in range(count):
        after = tension[i + 1] * sine[i + 1] if i + 1 < count else 0.0
        before = -tension[i - 1] * sine[i] if i > 0 else -GRAVITY * hy.sin(a[0])
        turning.append(after + before)
    start = [0.5] * count + [0.0] * count
    return list(zip(a + w, w + turning)), start, list(range(count))


def bodies(count):
    """Bodies of mass 0.4 with G = 1.3, at rest near the points of a grid with a distance of 1.5."""
    start = []
    for body in range(count):
        for axis, place in enumerate([body % 4, body // 4 % 4, body // 16]):
            start.append(1.5 * place + 0.1 * np.sin(1.7 * (3 * body + axis)))
        start += [0.0] * 3
    coordinates = [6 * body + axis for body in range(count) for axis in range(3)]
    return hy.model.nbody(count, masses=[0.4] * count, Gconst=1.3), start, coordinates


def integrator(equations, start, tolerance, kind=float):
    return hy.taylor_adaptive(equations, np.array(start, dtype=kind), tol=kind(tolerance), fp_type=kind, compact_mode=True)


def rows(name, system, end):
    equations, start, coordinates = system
    exact = integrator(equations, start, 1e-18, np.longdouble)
    exact.propagate_until(np.longdouble(end))
    exact = exact.state[coordinates]
    moved = np.abs(exact - np.array(start)[coordinates]).max()
    for tolerance in TOLERANCES:
        begin = time.perf_counter()
        run = integrator(equations, start, tolerance)
        compiled = time.perf_counter() - begin
        seconds = []
        for _ in range(REPETITIONS):
            run.time = 0.0
            run.state[:] = start
            begin = time.perf_counter()
            run.propagate_until(end)
            seconds.append(time.perf_counter() - begin)
        error = float(np.abs(run.state[coordinates] - exact).max() / moved)
        print(f"{name},heyoka,{tolerance:.0e},{1e3 * min(seconds):.3f},{error:.1e},{compiled:.1f}", flush=True)


if __name__ == "__main__":
    print("system,method,setting,milliseconds,error,compiled")
    for count in (20, 40):
        rows(f"{count} rods", rods(count), 1.0)
    for count in (20, 40):
        rows(f"{count} bodies", bodies(count), 1.0)
