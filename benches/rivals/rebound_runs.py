"""REBOUND, the N-body code of H. Rein, on the outer solar system over a million days.

Out: rows of integrator, setting, microseconds and error. The error is that of `vi-lab work-precision outer-solar-system
--h 250`: the largest difference of a coordinate or a momentum from the reference at the end, relative to the largest
coordinate, or momentum, on the way. The reference is heyoka in extended precision. The least of seven runs counts.
"""

import time

import numpy as np
import rebound
from heyoka_runs import outer_solar_system

END = 1e6
REPETITIONS = 7
PARTS = 256  # of the time, at whose ends the largest numbers are looked for


def simulation(problem, masses):
    sim = rebound.Simulation()
    sim.G = 2.95912208286e-4
    for body, mass in enumerate(masses):
        place = [problem.q[6 * axis + body] for axis in range(3)]
        speed = [problem.v[6 * axis + body] for axis in range(3)]
        sim.add(m=mass, x=place[0], y=place[1], z=place[2], vx=speed[0], vy=speed[1], vz=speed[2])
    return sim


def saba(sim, h):
    sim.integrator = "saba"
    sim.integrator.type = "10_6_4"
    sim.integrator.safe_mode = 0
    sim.dt = h


def whfast(sim, h):
    sim.integrator = "whfast"
    sim.integrator.corrector = 11
    sim.integrator.safe_mode = 0
    sim.dt = h


def ias15(sim, epsilon):
    sim.integrator = "ias15"
    sim.integrator.epsilon = epsilon
    sim.dt = 10.0


CASES = [(saba, h) for h in (800.0, 400.0, 200.0, 100.0)]
CASES += [(whfast, h) for h in (400.0, 200.0, 100.0, 50.0)]
CASES += [(ias15, epsilon) for epsilon in (1e-5, 1e-7, 1e-9)]


def main():
    problem = outer_solar_system()
    masses = [1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 1 / 1.3e8]
    reference, _ = problem.integrator(1e-19, np.longdouble)
    largest = np.zeros(2)
    for part in range(1, PARTS + 1):
        reference.propagate_until(np.longdouble(END) * part / PARTS)
        largest = np.maximum(largest, [np.abs(numbers).max() for numbers in problem.split(reference.state)])
    exact = problem.split(reference.state)
    for case, setting in CASES:
        seconds = []
        for _ in range(REPETITIONS):
            sim = simulation(problem, masses)
            case(sim, setting)
            begin = time.perf_counter()
            sim.integrate(END, exact_finish_time=1)
            seconds.append(time.perf_counter() - begin)
        q = np.array([[p.x, p.y, p.z] for p in sim.particles]).T.reshape(-1)
        v = np.array([[p.vx, p.vy, p.vz] for p in sim.particles]).T.reshape(-1)
        off = [np.abs(found - true).max() for found, true in zip((q, np.tile(masses, 3) * v), exact)]
        print(f"{case.__name__:8} {setting:8g} {min(seconds) * 1e6:10.0f} µs  {float(max(off / largest)):.1e}")


if __name__ == "__main__":
    main()
