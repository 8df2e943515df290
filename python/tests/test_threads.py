"""Threads, signals, forks, memory."""

import contextlib
import gc
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time

import numpy as np
import pytest

import variational as vi


def long_run():
    return vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.01, method="fixed")


def steps_of_a_second():
    """How many steps take about a second here: the gate does not optimize the systems."""
    began = time.perf_counter()
    long_run().steps(20_000, every=20_000)
    return int(20_000 / (time.perf_counter() - began))


def test_python_runs_while_a_run_advances():
    run, count = long_run(), steps_of_a_second()
    worker = threading.Thread(target=lambda: run.steps(count, every=count))
    worker.start()
    ticks = 0
    while worker.is_alive():
        ticks += 1
        time.sleep(0.005)
    worker.join()
    assert ticks > 10


def test_a_run_in_two_threads_is_refused():
    run, count = long_run(), steps_of_a_second()
    worker = threading.Thread(target=lambda: run.steps(count, every=count))
    worker.start()
    time.sleep(0.02)
    for use in (run.step, lambda: run.t, lambda: run.steps(3), run.copy):
        with pytest.raises(RuntimeError, match=r"another thread.*run\.copy\(\)"):
            use()
    worker.join()
    assert run.step().t > 1.0


def test_runs_of_several_threads_are_independent():
    found = [None] * 8

    def work(index):
        found[index] = long_run().steps(20_000, every=20_000).q[-1]

    workers = [threading.Thread(target=work, args=(index,)) for index in range(8)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert all(np.array_equal(q, found[0]) for q in found)


SQUEEZER = {
    "q": [
        -0.06171389001427645,
        0.0,
        0.4552798191630704,
        0.2226683901658859,
        0.48736497954384256,
        -0.2226683901658859,
        1.2305474445498212,
    ],
    "h": 0.005,
    "method": "energy",
    "stages": 2,
    # Steps short enough for its motion are hours over this time.
    "shift_from": 1.0,
}

LONG = {
    "a measured shift": lambda: vi.AndrewsSqueezer().integrate(**SQUEEZER),
    "ensemble of measured shifts": lambda: vi.AndrewsSqueezer().ensemble(**SQUEEZER, until=1.0),
    "steps": lambda: long_run().steps(10**12, every=10**12),
    "until": lambda: long_run().until(1e10, every=10**12),
    "at": lambda: long_run().at([1e10]),
    "events": lambda: long_run().events(vi.Event("x", 100.0), until=1e10),
    "functions": lambda: long_run().events(lambda t, q, v: 1.0, until=1e10),
    "callback": lambda: long_run().until(1e7, callback=lambda run: None),
    "tangent": lambda: long_run().tangent(10**12),
    "gradient": lambda: long_run().gradient(10**12, q=[1.0, 0.0]),
    "ensemble": lambda: vi.Kepler().ensemble(np.tile([0.4, 0.0], (64, 1)), [0.0, 2.0], h=0.01, until=1e10),
    "short steps": lambda: vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=1e-9).step(0.1).at([9.0]),
    "ensemble at": lambda: vi.Kepler().ensemble([0.4, 0.0], [0.0, 2.0], h=0.01, times=[1.0, 1e10]),
}


@contextlib.contextmanager
def ctrl_c():
    """Ctrl-C after 0.3 s of the processor, and again each 2 s: Python drops one that falls into the callback of a weak
    reference."""
    ended = threading.Event()

    def press():
        due = time.process_time() + 0.3
        while not ended.wait(0.01):
            if time.process_time() >= due:
                os.kill(os.getpid(), signal.SIGINT)
                due += 2.0

    presser = threading.Thread(target=press)
    presser.start()
    try:
        yield
    finally:
        ended.set()
        presser.join()


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_it(name):
    began = time.process_time()
    with pytest.raises(KeyboardInterrupt), ctrl_c():
        LONG[name]()
    assert time.process_time() - began < 5.0


def test_ctrl_c_keeps_the_rows_of_a_callback():
    run = long_run()
    with pytest.raises(KeyboardInterrupt) as caught, ctrl_c():
        run.until(1e7, every=1000, callback=lambda run: None)
    rows = caught.value.solution
    assert len(rows) > 10 and rows.t[0] == 0.0 and rows.t[-1] <= run.t
    again = long_run().until(rows.t[-1], every=1000)
    assert np.array_equal(again.q[:-1], rows.q[:-1])


def _child(connection):
    many = vi.Pendulum().ensemble([[1.0], [0.5]], h=0.05, until=1.0)
    connection.send(many.q.tolist())


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_ensembles_in_a_forked_process():
    here = vi.Pendulum().ensemble([[1.0], [0.5]], h=0.05, until=1.0)
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    process = context.Process(target=_child, args=(theirs,))
    process.start()
    assert ours.poll(30)
    assert ours.recv() == here.q.tolist()
    process.join()
    assert process.exitcode == 0


def runs():
    run = vi.Pendulum().integrate([1.0], h=0.05)
    run.steps(3)
    run.events(vi.Event(vi.Pendulum.coordinates[0]), 0.3)
    with contextlib.suppress(vi.InvalidInput):
        run.until(-1.0)


def derivatives():
    run = vi.Pendulum().integrate([1.0], h=0.05)
    run.tangent(2, ["l"], velocities=True)
    run.gradient(until=0.3, q=[1.0], wrt=["l"])
    run.at([0.4]).jacobian("l", of="θ")


def constraints():
    rod = vi.RodPendulum()
    start = rod.project([0.6, -0.7])
    run = rod.integrate(start.q, start.v, h=0.05)
    run.set(g=9.7).steps(2).reactions.sum()


def values():
    sol = vi.Pendulum().integrate([1.0], h=0.05).until(0.1, dense=True)
    sol(0.07)
    sol["m * l * cos(θ)"].sum()
    pickle.loads(pickle.dumps(sol)).energy.sum()


CALLS = [runs, derivatives, constraints, values]


def grown(calls, count):
    """The growth of the memory in this many times four calls."""

    def resident():
        gc.collect()
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")

    for _ in range(500):
        calls()
    before = resident()
    for _ in range(count):
        calls()
    return resident() - before


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("calls", CALLS)
def test_nothing_leaks(calls):
    # Measured: 0. A leak of 250 bytes in each of the four calls would be 1 MB.
    assert grown(calls, 1_000) < 5e5


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("calls", CALLS)
def test_nothing_leaks_in_a_million_calls(calls):
    assert grown(calls, 250_000) < 2e6
