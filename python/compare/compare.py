"""`variational` against `scipy.integrate.solve_ivp` and heyoka.py: ten systems, events, an ensemble, a halo orbit.

    pip install ./python -r python/compare/requirements.txt
    python python/compare/compare.py

It prints tables in Markdown. A time is the best of several runs after a warm-up run. Compile times are apart. Digits
are -log10 of the largest error of (q, v) at the end, relative to the largest entry of (q, v). Without heyoka its
columns are empty.
"""

# ruff: noqa: B023 - functions in loops are called at once

import inspect
import math
import os
import platform
import re
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import variational as vi

try:
    import heyoka as hy
except ImportError:
    hy = None

TOLERANCE = 1e-10
SYSTEMS = Path(__file__).parents[2] / "vi-systems" / "src"

# The accelerations, written once for floats and for the expressions of heyoka: f has sin, cos, sqrt.


def pendulum(t, q, v, f):
    return [-f.sin(q[0])]


def double_well(t, q, v, f):
    return [q[0] - 2.0 * q[0] ** 3]


def damped_oscillator(t, q, v, f):
    return [-4.0 * q[0] - 0.04 * v[0]]


def hard_duffing(t, q, v, f):
    return [-q[0] - q[0] ** 3 - 0.1 * v[0] + 0.3 * f.cos(1.2 * t)]


def henon_heiles(t, q, v, f):
    x, y = q
    return [-x - 2.0 * x * y, -y - x**2 + y**2]


def kepler(t, q, v, f):
    x, y = q
    cube = (x**2 + y**2) ** 1.5
    return [-x / cube, -y / cube]


def double_pendulum(t, q, v, f):
    s, c = f.sin(q[0] - q[1]), f.cos(q[0] - q[1])
    first = -(v[1] ** 2) * s - 19.62 * f.sin(q[0])
    second = v[0] ** 2 * s - 9.81 * f.sin(q[1])
    upper = (first - c * second) / (2.0 - c**2)
    return [upper, second - c * upper]


def three_body(t, q, v, f):
    return attraction(q[:3], q[3:], [0.0] * 3, [1.0] * 3)[:6]


def fpu_chain(t, q, v, f):
    r = [q[0]] + [q[i] - q[i - 1] for i in range(1, 16)] + [-q[15]]
    pull = [x + 0.25 * x**2 for x in r]
    return [pull[i + 1] - pull[i] for i in range(16)]


def outer_solar_system(t, q, v, f):
    weights = [2.95912208286e-4 * mass for mass in MASSES]
    return attraction(q[:6], q[6:12], q[12:], weights)


def attraction(x, y, z, weights):
    """Accelerations of bodies that attract each other: all x, then all y, then all z."""
    n = len(x)
    out = [0.0] * (3 * n)
    for i in range(n):
        for j in range(i):
            dx, dy, dz = x[j] - x[i], y[j] - y[i], z[j] - z[i]
            cube = (dx**2 + dy**2 + dz**2) ** 1.5
            for axis, d in enumerate((dx, dy, dz)):
                part = d / cube
                out[axis * n + i] = out[axis * n + i] + weights[j] * part
                out[axis * n + j] = out[axis * n + j] - weights[i] * part
    return out


MASSES = [1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 1 / 1.3e8]
PLANETS = [0.0, -3.5023653, 9.0755314, 8.3101420, 11.4707666, -15.5387357]
PLANETS += [0.0, -3.8169847, -3.0458353, -16.2901086, -25.7294829, -25.2225594]
PLANETS += [0.0, -1.5507963, -1.6483708, -7.2521278, -10.8169456, -3.1902382]
SPEEDS = [0.0, 0.00565429, 0.00168318, 0.00354178, 0.00288930, 0.00276725]
SPEEDS += [0.0, -0.00412490, 0.00483525, 0.00137102, 0.00114527, -0.00170702]
SPEEDS += [0.0, -0.00190589, 0.00192462, 0.00055029, 0.00039677, -0.00136504]
WAVE = [math.sin((i + 1) * math.pi / 17) for i in range(16)]
EIGHT = [0.97000436, -0.97000436, 0.0, -0.24308753, 0.24308753, 0.0]
EIGHT_SPEEDS = [0.46620369, 0.46620369, -0.93240737, 0.43236573, 0.43236573, -0.86473146]

# Class of the system, acceleration, q, v, end.
CASES = [
    ("Pendulum", pendulum, [1.0], [0.0], 100.0),
    ("DoubleWell", double_well, [0.995], [0.0], 100.0),
    ("DampedOscillator", damped_oscillator, [1.0], [0.0], 50.0),
    ("HardDuffing", hard_duffing, [1.0], [0.0], 50.0),
    ("HenonHeiles", henon_heiles, [0.0, 0.1], [0.4, 0.0], 200.0),
    ("Kepler", kepler, [0.4, 0.0], [0.0, 2.0], 20.0 * math.pi),
    ("DoublePendulum", double_pendulum, [1.0, 1.0], [0.0, 0.0], 20.0),
    ("ThreeBody", three_body, EIGHT, EIGHT_SPEEDS, 20.0),
    ("FpuChain", fpu_chain, WAVE, [0.0] * 16, 400.0),
    ("OuterSolarSystem", outer_solar_system, PLANETS, SPEEDS, 40000.0),
]


def best(run, seconds=0.5, fewest=5):
    """The result of a run, and its shortest time of several; the first one does not count."""
    result, times, start = run(), [], time.perf_counter()
    while len(times) < fewest or (time.perf_counter() - start < seconds and len(times) < 200):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return result, min(times)


def digits(found, reference):
    error = np.abs(np.asarray(found) - reference).max() / np.abs(reference).max()
    return 16.0 if error == 0.0 else -math.log10(error)


def rhs(acceleration):
    def f(t, y):
        values = y.tolist()
        n = len(values) // 2
        q, v = values[:n], values[n:]
        return v + acceleration(t, q, v, math)

    return f


def equations(acceleration, n):
    """The equations for heyoka."""
    q, v = ([hy.expression(f"{name}{i}") for i in range(n)] for name in "qv")
    f = SimpleNamespace(sin=hy.sin, cos=hy.cos, sqrt=hy.sqrt)
    return list(zip([*q, *v], [*v, *map(as_expression, acceleration(hy.time, q, v, f))], strict=True))


def as_expression(x):
    return x if isinstance(x, hy.expression) else hy.expression(float(x))


def heyoka_runs(acceleration, y, end, tolerance):
    """The end, the time of a run, and the time to compile."""
    # What was compiled before must not count as compiled now.
    hy.llvm_state.set_diskcache_enabled(False)
    hy.llvm_state.clear_memcache()
    begin = time.perf_counter()
    ta = hy.taylor_adaptive(equations(acceleration, len(y) // 2), y, tol=tolerance)
    compiled = time.perf_counter() - begin

    def run():
        ta.time = 0.0
        ta.state[:] = y
        ta.propagate_until(end)
        return ta.state.copy()

    return (*best(run), compiled)


def lines_of_equations(*functions):
    text = "".join(inspect.getsource(function) for function in functions)
    return sum(bool(line.strip()) and '"""' not in line for line in text.splitlines())


def lines_of_system(name):
    """Lines of the definition of a ready system, without comments, tests, and clauses that Gauss steps do not need."""
    file = SYSTEMS / (re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower() + ".rs")
    text = file.read_text(encoding="utf-8")
    text = re.search(r"pub struct.*?\n    \}\n", text, re.DOTALL)[0]
    text = re.sub(r"check \{.*?\n? *\}\n", "", text, flags=re.DOTALL)
    skipped = ("//", "discretize", "time_scale")
    return sum(bool(line.strip()) and not line.strip().startswith(skipped) for line in text.splitlines())


def shown(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def table(head, rows):
    print("\n| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


def ten_systems():
    print("## Ten systems: digits and time")
    rows, codes = [], []
    for name, acceleration, q, v, end in CASES:
        # Some ready systems are texts.
        system, y = getattr(vi, name).native()(), np.array(q + v)
        begin = time.perf_counter()
        h = system.integrate(q, v, tolerance=TOLERANCE).h
        search = time.perf_counter() - begin
        never = 2**40  # of the nodes only the first and the last are rows
        reference = system.integrate(q, v, h=h / 8).until(end, every=never).y[:, -1]
        row = [name, f"{h:.3g}", shown(search)]
        for step in (h, h / 2):
            sol, seconds = best(lambda: system.integrate(q, v, h=step).until(end, every=never))
            row.append(f"{digits(sol.y[:, -1], reference):.1f}, {shown(seconds)}")
        options = {"method": "DOP853", "rtol": TOLERANCE, "atol": TOLERANCE * 1e-2}
        found, theirs = best(lambda: solve_ivp(rhs(acceleration), (0.0, end), y, **options).y[:, -1])
        row.append(f"{digits(found, reference):.1f}, {shown(theirs)}")
        if hy:
            found, loose, _ = heyoka_runs(acceleration, y, end, TOLERANCE)
            row.append(f"{digits(found, reference):.1f}, {shown(loose)}")
            found, tight, compiled = heyoka_runs(acceleration, y, end, 2.0**-52)
            row += [f"{digits(found, reference):.1f}, {shown(tight)}", shown(compiled)]
        else:
            row += [""] * 3
        rows.append(row)
        used = (acceleration, attraction) if "attraction" in acceleration.__code__.co_names else (acceleration,)
        codes.append([name, str(lines_of_system(name)), str(lines_of_equations(*used))])
    head = ["system", "h", "search of h", "variational, h", "h/2", "DOP853"]
    head += ["heyoka 1e-10", "heyoka 2e-16", "heyoka compiles"]
    table(head, rows)
    print("## Lines of code of a system that is not ready: a Lagrangian with parameters, or accelerations by hand")
    table(["system", "Lagrangian", "accelerations"], codes)


def events():
    print("## Events: zeros of a pendulum from 2 rad to t = 1000")
    end = 1000.0
    period = 4.0 * ellipk(math.sin(1.0) ** 2)
    exact = period * (np.arange(1, 1 + math.floor(end / period * 2 + 0.5)) - 0.5) / 2
    rows = []

    def error(times):
        times = np.asarray(times)
        if len(times) != len(exact):
            return f"{len(times)} of {len(exact)} zeros"
        return f"{np.abs(times - exact).max():.1e}"

    h = vi.Pendulum().integrate([2.0], tolerance=TOLERANCE).h
    for name, step in (("h", h), ("h/2", h / 2)):
        times, seconds = best(lambda: vi.Pendulum().integrate([2.0], h=step).events(vi.Event("θ"), until=end).t)
        rows.append([f"variational, Event, {name}", error(times), shown(seconds)])
    g = lambda t, q, v: q[0]  # noqa: E731
    times, seconds = best(lambda: vi.Pendulum().integrate([2.0], h=h).events(g, until=end).t)
    rows.append(["variational, function, h", error(times), shown(seconds)])

    def theirs():
        zero = lambda t, y: y[0]  # noqa: E731
        options = {"method": "DOP853", "rtol": TOLERANCE, "atol": TOLERANCE * 1e-2, "events": zero}
        return solve_ivp(rhs(pendulum), (0.0, end), [2.0, 0.0], **options).t_events[0]

    times, seconds = best(theirs)
    rows.append(["DOP853", error(times), shown(seconds)])
    if hy:
        for tolerance in (TOLERANCE, 2.0**-52):
            met = []
            system = equations(pendulum, 1)
            event = hy.nt_event(system[0][0], callback=lambda ta, t, sign: met.append(t))
            ta = hy.taylor_adaptive(system, [2.0, 0.0], tol=tolerance, nt_events=[event])

            def run():
                met.clear()
                ta.time = 0.0
                ta.state[:] = [2.0, 0.0]
                ta.propagate_until(end)
                return list(met)

            times, seconds = best(run)
            rows.append([f"heyoka {tolerance:.0e}", error(times), shown(seconds)])
    table(["", "largest error of a time", "time"], rows)


def ensemble():
    count, end = 10_000, 20.0
    print(f"## Ensemble: {count} Kepler orbits of eccentricity 0 to 0.6 to t = {end:g}, {os.cpu_count()} threads")
    e = np.linspace(0.0, 0.6, count)
    q = np.stack([1.0 - e, np.zeros(count)], axis=-1)
    v = np.stack([np.zeros(count), np.sqrt((1.0 + e) / (1.0 - e))], axis=-1)
    # Kepler's equation.
    angle = np.full(count, end)
    for _ in range(50):
        angle -= (angle - e * np.sin(angle) - end) / (1.0 - e * np.cos(angle))
    exact = np.stack([np.cos(angle) - e, np.sqrt(1.0 - e**2) * np.sin(angle)], axis=-1)
    rows = []

    def error(found):
        return f"{np.abs(found - exact).max():.1e}"

    for options in ({"h": 0.3}, {"h": 0.2}, {"h": 0.2, "threads": 1}, {"h": 0.1, "stages": 4}):
        found, seconds = best(lambda: vi.Kepler().ensemble(q, v, until=end, **options).q, 2.0, 3)
        name = ", ".join(f"{key} = {value}" for key, value in options.items())
        rows.append([f"variational, {name}", error(found), shown(seconds)])
    few = np.arange(0, count, 100)
    options = {"method": "DOP853", "rtol": TOLERANCE, "atol": TOLERANCE * 1e-2}
    begin = time.perf_counter()
    found = [solve_ivp(rhs(kepler), (0.0, end), [*q[i], *v[i]], **options).y[:2, -1] for i in few]
    seconds = (time.perf_counter() - begin) * count / len(few)
    rows.append(["DOP853, one thread, from 100 orbits", f"{np.abs(found - exact[few]).max():.1e}", shown(seconds)])
    if hy:
        y = np.concatenate([q, v], axis=-1)
        size = hy.recommended_simd_size()
        system = equations(kepler, 2)
        for tolerance in (TOLERANCE, 2.0**-52):
            ta = hy.taylor_adaptive(system, [0.0] * 4, tol=tolerance)

            def generate(ta, i):
                ta.state[:] = y[i]
                return ta

            def run():
                return np.array([part[0].state[:2] for part in hy.ensemble_propagate_until(ta, end, count, generate)])

            found, seconds = best(run, 0.0, 1)
            rows.append([f"heyoka {tolerance:.0e}", error(found), shown(seconds)])
            batch = hy.taylor_adaptive_batch(system, np.zeros((4, size)), tol=tolerance)
            blocks = np.ascontiguousarray(y.reshape(-1, size, 4).transpose(0, 2, 1))

            def generate_batch(ta, i):
                ta.state[:] = blocks[i]
                return ta

            def run_batches():
                parts = hy.ensemble_propagate_until_batch(batch, end, count // size, generate_batch)
                return np.concatenate([part[0].state[:2].T for part in parts])

            found, seconds = best(run_batches, 1.0, 3)
            rows.append([f"heyoka {tolerance:.0e}, batches of {size}", error(found), shown(seconds)])

            def reuse():
                # One object for all batches, on one thread: the ensembles of heyoka copy it for each.
                parts = []
                for block in blocks:
                    batch.set_time(0.0)
                    batch.state[:] = block
                    batch.propagate_until(end)
                    parts.append(batch.state[:2].T.copy())
                return np.concatenate(parts)

            found, seconds = best(reuse, 1.0, 3)
            rows.append([f"heyoka {tolerance:.0e}, one object, one thread", error(found), shown(seconds)])
    table(["", "largest error of a coordinate", "time"], rows)


MU = 0.0121505856
ROTATING = """
/// The restricted three-body problem, Earth and Moon, in rotating coordinates.
struct RestrictedThreeBody {
    param mu = 0.0121505856;
    coord x, y, z;
    let r1 = sqrt((x + mu)^2 + y^2 + z^2);
    let r2 = sqrt((x - 1 + mu)^2 + y^2 + z^2);
    L = ((dot(x) - y)^2 + (dot(y) + x)^2 + dot(z)^2) / 2 + (1 - mu) / r1 + mu / r2;
}
"""


def rotating(t, q, v, f):
    x, y, z = q
    r1 = ((x + MU) ** 2 + y**2 + z**2) ** 1.5
    r2 = ((x - 1.0 + MU) ** 2 + y**2 + z**2) ** 1.5
    ax = 2.0 * v[1] + x - (1.0 - MU) * (x + MU) / r1 - MU * (x - 1.0 + MU) / r2
    ay = -2.0 * v[0] + y - (1.0 - MU) * y / r1 - MU * y / r2
    return [ax, ay, -(1.0 - MU) * z / r1 - MU * z / r2]


def halo():
    print("## A halo orbit about L1 of Earth and Moon")
    vi.warm(verbose=False)
    begin, before = time.perf_counter(), os.times()
    # The comment makes it a system that was not compiled before.
    system = vi.compile(f"{ROTATING}// {time.time_ns()}", methods="gauss 8")()
    after = os.times()
    cpu = sum(after[i] - before[i] for i in (0, 1, 2, 3))
    compiled = f"{shown(time.perf_counter() - begin)} ({shown(cpu)} CPU)"
    # The orbit crosses y = 0 at right angles: at half a period y = p_x = p_z = 0. Newton's iteration for x, v_y and
    # the period. At the start p_y = v_y + x, so that x changes it too.
    x, z, vy, half, steps = 0.82338, -0.022277556, 0.13418, 1.3715, 16
    begin = time.perf_counter()
    for _ in range(20):
        run = system.integrate([x, 0.0, z], [0.0, vy, 0.0], h=half / steps)
        d = run.tangent(steps)
        a = system.acceleration(run.t, run.q, run.v)
        rate = np.array([*run.v, a[0] - run.v[1], a[1] + run.v[0], a[2]])
        rows = [1, 3, 5]
        residual = np.concatenate([run.q, run.p])[rows]
        matrix = np.column_stack([d["q"][:, 0] + d["p"][:, 1], d["p"][:, 1], rate])[rows]
        change = np.linalg.solve(matrix, -residual)
        x, vy, half = np.array([x, vy, half]) + change
        if np.abs(change).max() < 1e-14:
            break
    corrected = time.perf_counter() - begin
    d = system.integrate([x, 0.0, z], [0.0, vy, 0.0], h=half / steps).tangent(2 * steps)
    multipliers = np.linalg.eigvals(np.hstack([d["q"], d["p"]]))
    print(f"\nx = {x:.15f}, z = {z}, v_y = {vy:.15f}, period {2.0 * half:.12f}")
    sizes = np.abs(multipliers)
    print(f"Newton's iteration with tangents: {shown(corrected)}; largest multiplier {sizes.max():.6f},")
    print(f"product of the largest and the smallest - 1: {sizes.max() * sizes.min() - 1:.1e}")
    q, v, end = [x, 0.0, z], [0.0, vy, 0.0], 2.0 * half
    y = np.array(q + v)
    rows = []

    def row(name, found, seconds, compiled):
        before, after = (system.energy(0.0, state[:3], state[3:]) for state in (y, found))
        gap, energy = np.abs(found - y).max(), abs(after / before - 1.0)
        rows.append([name, f"{gap:.1e}", f"{energy:.1e}", shown(seconds), compiled])

    for steps in (32, 64):
        sol, seconds = best(lambda: system.integrate(q, v, h=end / steps).until(end, every=steps))
        row(f"variational, {steps} steps", sol.y[:, -1], seconds, compiled if steps == 32 else "")
    options = {"method": "DOP853", "rtol": TOLERANCE, "atol": TOLERANCE * 1e-2}
    row("DOP853", *best(lambda: solve_ivp(rhs(rotating), (0.0, end), y, **options).y[:, -1]), "")
    if hy:
        for tolerance in (TOLERANCE, 2.0**-52):
            found, seconds, compile_time = heyoka_runs(rotating, y, end, tolerance)
            row(f"heyoka {tolerance:.0e}", found, seconds, shown(compile_time))
    table(["one period", "gap", "energy error", "time", "compile"], rows)


def main():
    theirs = f"heyoka {hy.__version__}" if hy else "without heyoka (pip install heyoka)"
    print(f"Python {platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}, {theirs}\n")
    for part in (ten_systems, events, ensemble, halo):
        if len(sys.argv) < 2 or part.__name__ in sys.argv[1:]:
            part()


if __name__ == "__main__":
    main()
