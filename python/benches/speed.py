"""Times of calls, loops and ensembles: `python benches/speed.py`. The numbers are the shortest of several repeats."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

import variational as vi

STEPS = 200_000


def shortest(work: Callable[[], object], repeats: int = 5) -> float:
    """Seconds of the fastest repeat."""
    times = []
    for _ in range(repeats):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def row(name: str, value: float, unit: str) -> None:
    print(f"| {name} | {value:.3g} {unit} |", flush=True)


def run(**options):
    return vi.Kepler().integrate(q=[0.4, 0.0], v=[0.0, 2.0], **options)


def imports() -> None:
    for module, before in (("numpy", ""), ("variational", "import numpy; ")):
        code = f"import time; {before}t = time.perf_counter(); import {module}; print(time.perf_counter() - t)"
        took = min(float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(5))
        row(f"import {module}", 1e3 * took, "ms")


def steps(name: str, **options) -> None:
    few = STEPS // 20

    def by_step():
        one = run(**options)
        for _ in range(few):
            one.step()

    def by_reading():
        one = run(**options)
        for _ in range(few):
            one.step()
            _ = one.q, one.t

    row(f"{name}: no node kept", 1e9 / STEPS * shortest(lambda: run(**options).steps(STEPS, every=STEPS)), "ns a step")
    row(f"{name}: every node kept", 1e9 / STEPS * shortest(lambda: run(**options).steps(STEPS)), "ns a step")
    row(f"{name}: dense output", 1e9 / few * shortest(lambda: run(**options).steps(few, dense=True)), "ns a step")
    row(f"{name}: Python loop of step()", 1e9 / few * shortest(by_step), "ns a step")
    row(f"{name}: the loop reads q, t", 1e9 / few * shortest(by_reading), "ns a step")


def calls() -> None:
    planet, q, v = vi.Kepler(), np.array([0.4, 0.0]), np.array([0.0, 2.0])
    row("p.energy of a point", 1e3 * shortest(lambda: [planet.energy(0.0, q, v) for _ in range(1000)]), "µs")
    row("p.integrate", 1e3 * shortest(lambda: [planet.integrate(q, v, h=0.1) for _ in range(1000)]), "µs")


def events() -> None:
    stars = vi.HenonHeiles().integrate(q=[0.0, 0.1], v=[0.4, 0.0], h=0.5)
    found = len(stars.copy().events(vi.Event("x"), until=5000.0))
    by_name = shortest(lambda: stars.copy().events(vi.Event("x"), until=5000.0))
    by_function = shortest(lambda: stars.copy().events(lambda t, q, v: q[0], until=5000.0), 2)
    row(f"{found} events in 10 000 steps: Event", 1e3 * by_name, "ms")
    row(f"{found} events in 10 000 steps: function", 1e3 * by_function, "ms")


def ensembles() -> None:
    q = np.column_stack([np.linspace(0.4, 0.9, 10_000), np.zeros(10_000)])
    for threads in (1, 2):
        for method, h in (("gauss", 0.1), ("fixed", 0.005)):
            options = {"h": h, "until": 20.0, "method": method, "threads": threads}
            took = shortest(lambda options=options: vi.Kepler().ensemble(q, [0.0, 1.2], **options), 2)
            row(f"10 000 orbits to t = 20, {method} h = {h}, {threads} threads", took, "s")


def threads() -> None:
    def work():
        run(h=0.01, method="fixed").steps(5_000_000, every=5_000_000)

    def both():
        workers = [threading.Thread(target=work) for _ in range(2)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()

    row("one run of 5 000 000 steps", shortest(work, 2), "s")
    row("two of them in two threads", shortest(both, 2), "s")


def rivals() -> None:
    planet, end = vi.Kepler(), 20 * np.pi
    y = np.array([0.4, 0.0, 0.0, 2.0])

    def scipy():
        return solve_ivp(planet.rhs, (0.0, end), y, method="DOP853", rtol=1e-10, atol=1e-10).y[:, -1]

    def ours():
        return planet.integrate(y[:2], y[2:], h=0.1).until(end, every=10**9).y[:, -1]

    for name, work in (("solve_ivp DOP853, rtol 1e-10", scipy), ("gauss, h = 0.1", ours)):
        error = np.abs(work() - y).max()
        row(f"Kepler, 10 periods: {name}, error {error:.1e}", 1e3 * shortest(work), "ms")


if __name__ == "__main__":
    print("| | |\n|---|---|")
    imports()
    steps("Kepler, fixed", h=0.01, method="fixed")
    steps("Kepler, gauss 8", h=0.1)
    calls()
    events()
    ensembles()
    threads()
    rivals()
