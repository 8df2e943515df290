"""Progress and interruption of long calls."""

import contextlib
import io
import re
import sys
import threading

import numpy as np
import pytest
from test_threads import ctrl_c, long_run

import variational as vi
from variational import _fit, _progress

MANY = np.tile([0.4, 0.0], (64, 1))
TIMES = np.linspace(0.0, 3.0, 31)


def fitted():
    x = vi.HarmonicOscillator(k=2.0).integrate([1.0], h=0.05).at(TIMES)["x"]
    return vi.fit(vi.HarmonicOscillator(), {"t": TIMES, "x": x}, ["k"], q=[1.0], h=0.05)


CALLS = {
    "until": lambda: long_run().until(1500.0, every=1000),
    "steps": lambda: long_run().steps(150_000, every=1000),
    "callback": lambda: long_run().until(50.0, every=100, callback=lambda run: None),
    "steps with a callback": lambda: long_run().steps(5000, every=100, callback=lambda run: None),
    "at": lambda: long_run().at(np.arange(1.0, 1000.0)),
    "events": lambda: long_run().events(vi.Event("x"), until=1500.0),
    "tangent": lambda: long_run().tangent(50_000),
    "gradient": lambda: long_run().gradient(20_000, q=[1.0, 0.0]),
    "lyapunov": lambda: long_run().lyapunov(50_000),
    "ensemble": lambda: vi.Kepler().ensemble(MANY, [0.0, 2.0], h=0.01, until=20.0, threads=1),
    "ensemble to an event": lambda: vi.Kepler().ensemble(
        MANY, [0.0, 2.0], h=0.01, until=1.0, next_event=vi.Event("x"), threads=1
    ),
}


class Terminal(io.StringIO):
    def isatty(self):
        return True


def shown_by(call, stream=Terminal, patience=0.0):
    """What a call writes to a terminal, if it takes longer than no time."""
    pytest.importorskip("tqdm")
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stderr(stream()) as written:
        patch.setattr(_progress, "_PATIENCE", patience)
        call()
    return written.getvalue()


@pytest.mark.parametrize("name", CALLS)
def test_long_calls_show_their_progress(name):
    shown = shown_by(CALLS[name])
    percentages = [int(found) for found in re.findall(r"Kepler: +(\d+)% \|", shown)]
    assert percentages and percentages == sorted(percentages) and percentages[-1] <= 100
    # The bar is gone at the end.
    assert shown.rsplit("\r", 2)[1].strip() == ""


def test_a_fit_shows_its_motions():
    assert re.search(r"motions of the fit: \d+ \[", shown_by(fitted))


def in_a_thread(call):
    worker = threading.Thread(target=call)
    worker.start()
    worker.join()


def test_short_calls_files_and_other_threads_show_nothing(monkeypatch):
    call = CALLS["callback"]
    assert shown_by(call, patience=60.0) == shown_by(call, io.StringIO) == shown_by(lambda: in_a_thread(call)) == ""
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    assert shown_by(call) == ""


def test_progress_changes_no_bit():
    rows = []
    take = lambda: rows.append(long_run().steps(150_000, every=1000))  # noqa: E731
    assert shown_by(take)
    in_a_thread(take)
    assert np.array_equal(rows[0].q, rows[1].q) and np.array_equal(rows[0].p, rows[1].p)


INTERRUPTED = {
    "steps": lambda run: run.steps(10**9, every=1000),
    "until": lambda run: run.until(1e7, every=1000),
    "dense": lambda run: run.steps(10**6, dense=True),
    "at": lambda run: run.at(np.arange(1.0, 1e4)),
    "events": lambda run: run.events(vi.Event("x"), until=1e10),
    "functions": lambda run: run.events(lambda t, q, v: q[0], until=1e10),
    "on_error": lambda run: run.until(1e7, every=1000, on_error="return"),
}


@pytest.mark.parametrize("name", INTERRUPTED)
def test_ctrl_c_keeps_the_rows(name):
    run = long_run()
    with pytest.raises(KeyboardInterrupt) as caught, ctrl_c():
        INTERRUPTED[name](run)
    rows = caught.value.solution
    assert len(rows) > 1 and rows.t[-1] < run.t + 0.02 and np.isfinite(rows.q).all() and not rows.success
    again = long_run()
    if name == "at":
        same = again.at(rows.t)
    elif name in ("events", "functions"):
        same = again.events(vi.Event("x"), until=rows.t[-1] + 0.01)
        # The function of Python has its own rounding.
        assert np.abs(same.t - rows.t).max() < 1e-12
        return
    else:
        same = again.until(rows.t[-1], every=1 if name == "dense" else 1000)
        assert rows.t[-1] == run.t
    assert np.array_equal(same.t, rows.t) and np.array_equal(same.q[:-1], rows.q[:-1])
    # The run goes on.
    t = run.t
    assert run.step().t > t


def test_an_exception_of_an_event_keeps_the_rows():
    def g(t, q, v):
        if t > 5.0:
            raise OSError("the sensor is off")
        return q[0]

    with pytest.raises(OSError, match="sensor") as caught:
        long_run().events(g, until=1e10)
    assert caught.value.solution.t == pytest.approx([0.447175], abs=1e-5)


@pytest.mark.parametrize("event", [None, vi.Event("x", 100.0)])
def test_ctrl_c_keeps_the_runs_of_an_ensemble(event):
    kepler = vi.Kepler()
    with pytest.raises(KeyboardInterrupt) as caught, ctrl_c():
        kepler.ensemble(np.tile([0.4, 0.0], (20_000, 1)), [0.0, 2.0], h=0.01, until=20.0, next_event=event)
    found = caught.value.solution
    is_done = np.isfinite(found.t)
    assert 0 < is_done.sum() < len(found) and not found.success
    assert np.array_equal(is_done, [error is None for error in found.errors])
    assert all(isinstance(error, KeyboardInterrupt) for error in found.errors if error is not None)
    end = kepler.integrate([0.4, 0.0], [0.0, 2.0], h=0.01)
    end.until(20.0)
    assert np.array_equal(found.q[is_done][0], end.q)
    assert np.isnan(found.q[~is_done]).all() and np.isnan(found.energy[~is_done]).all()


def test_ctrl_c_keeps_the_last_motion_of_a_fit(monkeypatch):
    computed, calls = _fit._Model._computed, []

    def interrupted(model, unknowns):
        calls.append(unknowns)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return computed(model, unknowns)

    monkeypatch.setattr(_fit._Model, "_computed", interrupted)
    with pytest.raises(KeyboardInterrupt) as caught:
        fitted()
    assert np.array_equal(caught.value.solution.t, TIMES)
    assert caught.value.solution.system.k == calls[1][0]
