"""REBOUND, the N-body code of H. Rein, on the outer solar system over a million days.

Out: rows of integrator, setting, microseconds and error. The error is that of `heyoka_runs.py`, whose reference serves
here too. The least of seven runs counts.
"""

import time

import numpy as np
import rebound
from heyoka_runs import GRAVITY, MASSES, Reference, outer_solar_system

END = 1e6
REPETITIONS = 7


def simulation(problem):
    sim = rebound.Simulation()
    sim.G = GRAVITY
    for body, mass in enumerate(MASSES):
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
    reference = Reference(problem, END)
    for case, setting in CASES:
        seconds = []
        for _ in range(REPETITIONS):
            sim = simulation(problem)
            case(sim, setting)
            begin = time.perf_counter()
            sim.integrate(END, exact_finish_time=1)
            seconds.append(time.perf_counter() - begin)
        q = np.array([[p.x, p.y, p.z] for p in sim.particles]).T.reshape(-1)
        v = np.array([[p.vx, p.vy, p.vz] for p in sim.particles]).T.reshape(-1)
        error = reference.error((q, np.tile(MASSES, 3) * v))
        print(f"{case.__name__:8} {setting:8g} {min(seconds) * 1e6:10.0f} µs  {error:.1e}")


if __name__ == "__main__":
    main()
