"""heyoka, the Taylor integrator of F. Biscani and D. Izzo, on the systems of `vi-lab work-precision`.

In: names of systems. Out: for each a file NAME.csv with the columns of the command's `runs.csv`, and the least time for
each error, to be compared with the table of `vi-lab work-precision NAME`. A run is timed REPETITIONS times, in rounds over
all tolerances. Its code was compiled before. The error is the command's: the largest difference of a coordinate or a momentum
from the reference at the end, relative to the largest coordinate, or momentum, on the way. The reference is heyoka itself in
extended precision.
"""

import sys
import time
from statistics import median

import heyoka as hy
import numpy as np

REPETITIONS = 15
ERRORS = [1e-3, 1e-6, 1e-9, 1e-12]  # of the command's table
TOLERANCES = [10.0 ** (-0.5 * k) for k in range(6, 33)]
STEPS = 4000  # usual steps of the command, up to the end of a run
PARTS = 256  # of the time, at whose ends the largest numbers are looked for


class Problem:
    """Equations q'' = a(q, v), a start, the end of the run, and momenta as a function of q and v."""

    def __init__(self, names, acceleration, q, v, step, momenta=None, equations=None, order=None, published=None):
        self.q, self.v = q, v
        # Coordinates and velocities at the end, by the source of the problem.
        self.published = published
        self.end = STEPS * step
        self.momenta = momenta or (lambda q, v: v)
        # Where coordinates and velocities stand in the state of heyoka.
        self.order = order or list(range(2 * len(q)))
        if equations is None:
            q_symbols = hy.make_vars(*names)
            v_symbols = hy.make_vars(*["v_" + name for name in names])
            q_symbols = [q_symbols] if len(names) == 1 else q_symbols
            v_symbols = [v_symbols] if len(names) == 1 else v_symbols
            accelerations = acceleration(q_symbols, v_symbols)
            equations = list(zip(q_symbols, v_symbols)) + list(zip(v_symbols, accelerations))
        self.equations = equations

    def integrator(self, tolerance, kind=float):
        start = np.empty(len(self.order), dtype=kind)
        start[self.order] = np.array(self.q + self.v, dtype=kind)
        # The code of the reference is short, because it is compiled for longer than it runs.
        compact = kind is not float
        return hy.taylor_adaptive(self.equations, start, tol=kind(tolerance), fp_type=kind, compact_mode=compact), start

    def split(self, state):
        ordered = state[self.order]
        n = len(self.q)
        return ordered[:n], self.momenta(ordered[:n], ordered[n:])


def double_well():
    return Problem(["q"], lambda q, v: [q[0] - 2.0 * q[0] ** 3], [0.995], [0.0], 0.01)


def kepler():
    def acceleration(q, v):
        cube = (q[0] ** 2 + q[1] ** 2) ** (-1.5)
        return [-q[0] * cube, -q[1] * cube]

    return Problem(["x", "y"], acceleration, [0.4, 0.0], [0.0, 2.0], 0.005)


def double_pendulum():
    g = 9.81

    def acceleration(q, v):
        s, c = hy.sin(q[0] - q[1]), hy.cos(q[0] - q[1])
        first = -v[1] ** 2 * s - 2.0 * g * hy.sin(q[0])
        second = v[0] ** 2 * s - g * hy.sin(q[1])
        upper = (first - c * second) / (2.0 - c**2)
        return [upper, second - c * upper]

    def momenta(q, v):
        c = np.cos(q[0] - q[1])
        return np.array([2 * v[0] + c * v[1], v[1] + c * v[0]])

    return Problem(["a", "b"], acceleration, [1.0, 1.0], [0.0, 0.0], 0.005, momenta)


def fpu_chain():
    n = 16
    lowest = [0.184, 0.361, 0.526, 0.674, 0.798, 0.895, 0.962, 0.996]

    def acceleration(q, v):
        stretch = [q[0]] + [q[i] - q[i - 1] for i in range(1, n)] + [-q[n - 1]]
        pull = [r + 0.25 * r**2 for r in stretch]
        return [pull[i + 1] - pull[i] for i in range(n)]

    return Problem([f"q{i}" for i in range(n)], acceleration, lowest + lowest[::-1], [0.0] * n, 0.1)


MASSES = [1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 1 / 1.3e8]
GRAVITY = 2.95912208286e-4


def outer_solar_system():
    q = [0.0, -3.5023653, 9.0755314, 8.3101420, 11.4707666, -15.5387357]
    q += [0.0, -3.8169847, -3.0458353, -16.2901086, -25.7294829, -25.2225594]
    q += [0.0, -1.5507963, -1.6483708, -7.2521278, -10.8169456, -3.1902382]
    v = [0.0, 0.00565429, 0.00168318, 0.00354178, 0.00288930, 0.00276725]
    v += [0.0, -0.00412490, 0.00483525, 0.00137102, 0.00114527, -0.00170702]
    v += [0.0, -0.00190589, 0.00192462, 0.00055029, 0.00039677, -0.00136504]
    equations = hy.model.nbody(6, masses=MASSES, Gconst=GRAVITY)
    # heyoka holds x, y, z, v_x, v_y, v_z of one body after the other.
    order = [6 * body + axis for axis in range(6) for body in range(6)]
    weights = np.tile(MASSES, 3)
    return Problem(None, None, q, v, 10.0, lambda q, v: weights * v, equations, order)


def pleiades():
    """Of the Test Set for IVP Solvers (Mazzia and Magherini, Bari 2008), with its reference solution."""
    n = 7
    q = [3.0, 3.0, -1.0, -3.0, 2.0, -2.0, 2.0, 3.0, -3.0, 2.0, 0.0, 0.0, -4.0, 4.0]
    v = [0.0, 0.0, 0.0, 0.0, 0.0, 1.75, -1.5, 0.0, 0.0, 0.0, -1.25, 1.0, 0.0, 0.0]

    def acceleration(q, v):
        terms = [[] for _ in range(2 * n)]
        for i in range(n):
            for j in range(i):
                x, y = q[i] - q[j], q[n + i] - q[n + j]
                cube = (x**2 + y**2) ** (-1.5)
                for axis, difference in ((0, x * cube), (n, y * cube)):
                    terms[axis + j].append((i + 1.0) * difference)
                    terms[axis + i].append(-(j + 1.0) * difference)
        return [hy.sum(each) for each in terms]

    masses = np.tile(np.arange(1.0, n + 1.0), 2)
    names = [f"{axis}{i}" for axis in "xy" for i in range(n)]
    end_q = [0.3706139143970502, 3.237284092057233, -3.222559032418324, 0.6597091455775310, 0.3425581707156584]
    end_q += [1.562172101400631, -0.7003092922212495, -3.943437585517392, -3.271380973972550, 5.225081843456543]
    end_q += [-2.590612434977470, 1.198213693392275, -0.2429682344935824, 1.091449240428980]
    end_v = [3.417003806314313, 1.354584501625501, -2.590065597810775, 2.025053734714242, -1.155815100160448]
    end_v += [-0.8072988170223021, 0.5952396354208710, -3.741244961234010, 0.3773459685750630, 0.9386858869551073]
    end_v += [0.3667922227200571, -0.3474046353808490, 2.344915448180937, -1.947020434263292]
    return Problem(names, acceleration, q, v, 7.5e-4, lambda q, v: masses * v, published=(end_q, end_v))


def cart_double_pole():
    """Gymnasium's inverted_double_pendulum.xml: equations for x and the angles a, c = a + b from the vertical."""
    cart, pole, inertia, l, d, g, gx = 10.471975511965976, 4.198738581522758, 0.15497066975016233, 0.6, 0.05, 9.81, 1e-5
    m_xx, m_xa, m_xc, m_ac = cart + 2.0 * pole, 1.5 * pole * l, 0.5 * pole * l, 0.5 * pole * l**2
    m_aa, m_cc = inertia + 1.25 * pole * l**2, inertia + 0.25 * pole * l**2

    def acceleration(q, v):
        a, c, va, vc = q[1], q[1] + q[2], v[1], v[1] + v[2]
        sin_a, cos_a, sin_c, cos_c = hy.sin(a), hy.cos(a), hy.sin(c), hy.cos(c)
        xa, xc = m_xa * cos_a, m_xc * cos_c
        ac, turn = m_ac * hy.cos(q[2]), m_ac * hy.sin(q[2])
        x = m_xa * sin_a * va**2 + m_xc * sin_c * vc**2 + gx * m_xx - d * v[0]
        first = turn * vc**2 + g * m_xa * sin_a + gx * xa - d * va + d * v[2]
        second = -turn * va**2 + g * m_xc * sin_c + gx * xc - d * v[2]
        # Elimination of x, then of a.
        aa, ac, cc = m_aa - xa**2 / m_xx, ac - xa * xc / m_xx, m_cc - xc**2 / m_xx
        first, second = first - xa * x / m_xx, second - xc * x / m_xx
        factor = ac / aa
        c_rate = (second - factor * first) / (cc - factor * ac)
        a_rate = (first - ac * c_rate) / aa
        return [(x - xa * a_rate - xc * c_rate) / m_xx, a_rate, c_rate - a_rate]

    def momenta(q, v):
        a, c, va, vc = q[1], q[1] + q[2], v[1], v[1] + v[2]
        xa, xc, ac = m_xa * np.cos(a), m_xc * np.cos(c), m_ac * np.cos(q[2])
        p_c = xc * v[0] + ac * va + m_cc * vc
        return np.array([m_xx * v[0] + xa * va + xc * vc, xa * v[0] + m_aa * va + ac * vc + p_c, p_c])

    # By cart_in_mujoco.py.
    end = [-0.11127611304, 8.5783135478, 10.18513141025], [0.78600544535, -1.0007083402, -12.8093211273]
    return Problem(["x", "a", "b"], acceleration, [0.0, 0.1, 0.1], [0.0] * 3, 0.001, momenta, published=end)


PROBLEMS = {
    "double-well": double_well,
    "kepler": kepler,
    "double-pendulum": double_pendulum,
    "fpu-chain": fpu_chain,
    "outer-solar-system": outer_solar_system,
    "pleiades": pleiades,
    "cart-double-pole": cart_double_pole,
}


class Reference:
    """Coordinates and momenta at the end of a problem, and the largest of each on the way."""

    def __init__(self, problem, end):
        integrator, _ = problem.integrator(1e-19, np.longdouble)
        self.largest = [0.0, 0.0]
        for part in range(1, PARTS + 1):
            integrator.propagate_until(np.longdouble(end) * part / PARTS)
            self.exact = problem.split(integrator.state)
            self.largest = [max(old, np.abs(new).max()) for old, new in zip(self.largest, self.exact)]

    def error(self, found):
        """The error of coordinates and momenta."""
        parts = zip(found, self.exact, self.largest)
        return float(max(np.abs(part - exact).max() / largest for part, exact, largest in parts))


def run(name):
    problem = PROBLEMS[name]()
    reference = Reference(problem, problem.end)
    if problem.published:
        q, v = (np.array(part) for part in problem.published)
        print(f"{name}: the reference is off the published end by {reference.error((q, problem.momenta(q, v))):.1e}")
    runs = [(tolerance, *problem.integrator(tolerance), []) for tolerance in TOLERANCES]
    for _ in range(REPETITIONS):
        for _, integrator, start, seconds in runs:
            # Once unwatched: another run's code was the last one.
            for seen in (False, True):
                integrator.time = 0.0
                integrator.state[:] = start
                begin = time.perf_counter()
                integrator.propagate_until(problem.end)
                if seen:
                    seconds.append(time.perf_counter() - begin)
    prices = dict.fromkeys(ERRORS, np.inf)
    with open(f"{name}.csv", "w") as out:
        out.write('method,setting,error,evaluations,"seconds, least","seconds, median",ended\n')
        for tolerance, integrator, _, seconds in runs:
            error = reference.error(problem.split(integrator.state))
            out.write(f"heyoka,{tolerance:.0e},{error:e},,{min(seconds):.4e},{median(seconds):.4e},\n")
            prices.update({bound: min(prices[bound], *seconds) for bound in ERRORS if error <= bound})
    times = ", ".join(f"{1e6 * least:.3g} µs for {bound:.0e}" for bound, least in prices.items())
    print(f"{name}.csv: q = {problem.q}, t = {problem.end}: {times}")


if __name__ == "__main__":
    for name in sys.argv[1:] or PROBLEMS:
        run(name)
