"""Many runs of one system on all cores."""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Array, array, count, finite, fixed, number, ordered
from ._calls import check_arguments
from ._errors import StepError, advised
from ._events import listed
from ._progress import progress
from ._solution import ByName, columns_of, two_axes

if TYPE_CHECKING:
    from ._system import System


class Ensemble(ByName):
    """The states of M runs: `t` (M,), `q`, `p`, `v` (M, N), `energy` (M,), or with an axis of K times after M.

    `errors` has for each run None, or the exception that ended it, which is KeyboardInterrupt after Ctrl-C;
    `parameters` the parameters that differ; `which` the index of the event that ended each run, -1 without an event, or
    None if no event was given.
    """

    p: Array
    errors: list[StepError | None]
    parameters: dict[str, Array]
    which: NDArray[np.intp] | None

    def __init__(
        self,
        system: System,
        t: Array,
        q: Array,
        p: Array,
        errors: list[StepError | None],
        values: Array,
        parameters: dict[str, Array],
        which: NDArray[np.intp] | None = None,
    ):
        vars(self).update(system=system, t=fixed(t), q=fixed(q), p=fixed(p), errors=errors, parameters=parameters)
        vars(self)["which"] = None if which is None else fixed(which)
        self._values = values

    def _evaluate(self, of: str, each: tuple[int, ...] = ()) -> Array:
        out = np.full((*self.t.shape, *each), np.nan)
        many = len(self.errors)
        same = bool((self._values == self._values[:1]).all()) if many else True
        # All runs at once if they have the same parameters, otherwise one by one.
        for rows in [slice(None)] if same else range(many):
            is_there = np.isfinite(self.t[rows])
            if np.any(is_there):
                system = self.system._of(self._values[0 if same else rows])
                found = system._at(of, self.t[rows][is_there], self.q[rows][is_there], self.p[rows][is_there], each)
                part = out[rows]
                if np.ndim(self.t[rows]) == 0:
                    out[rows] = found[0]
                else:
                    part[is_there] = found
        return fixed(out)

    @cached_property
    def v(self) -> Array:
        """Velocities."""
        return self._evaluate("velocity", self.q.shape[-1:])

    @cached_property
    def energy(self) -> Array:
        """The energy H."""
        return self._evaluate("hamiltonian")

    @cached_property
    def reactions(self) -> Array:
        """The multiplier Λ of each constraint, on the last axis in the order of `system.constraints`."""
        return self._evaluate("reaction", (len(self.system.constraints),))

    @property
    def success(self) -> bool:
        """Whether all runs reached their end."""
        return all(error is None for error in self.errors)

    def __len__(self) -> int:
        return len(self.errors)

    def to_dataframe(self) -> Any:
        """The rows as a pandas DataFrame: the parameters that differ, and the columns of a solution. Its index is the
        number of the run, so that `frame.loc[3]` has the times of run 3. A failed run has NaN from its failure on."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_dataframe needs pandas: pip install pandas") from None
        per_run = self.t.size // len(self) if len(self) else 1
        columns: dict[str, Any] = {}
        for name, values in self.parameters.items():
            parameter = type(self.system)._parameter(name)
            # One value may stand for all runs.
            entries = np.broadcast_to(values.reshape(len(values), -1), (len(self), parameter.length or 1))
            for entry, of_runs in zip(parameter.entries, entries.T, strict=True):
                columns[entry] = np.repeat(of_runs, per_run)
        rows = {name: values.reshape(-1) for name, values in columns_of(self)}
        index = pandas.Index(np.repeat(np.arange(len(self)), per_run), name="run")
        return pandas.DataFrame({**columns, **rows}, index=index)

    def plot(self, axes: Any = None) -> Any:
        """Plots the coordinates and the energy of all runs, over time, or over the number of the run if there is one
        time; returns the two axes of matplotlib."""
        axes = two_axes(axes)
        above, below = axes
        is_film = self.t.ndim == 2
        over = self.t.T if is_film else np.arange(len(self))
        style: dict[str, Any] = {"lw": 0.8, "alpha": 0.6} if is_film else {"ls": "", "marker": "."}
        for index, name in enumerate(self.system.coordinates):
            lines = above.plot(over, self.q[..., index].T, color=f"C{index % 10}", **style)
            for line in lines[:1]:
                line.set_label(name)
        if len(self) and len(self.system.coordinates) <= 10:
            above.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        above.set_ylabel("coordinates")
        below.plot(over, self.energy.T, color="tab:blue", **style)
        below.set(xlabel="t" if is_film else "run", ylabel="H")
        return axes

    def __repr__(self) -> str:
        failed = sum(error is not None for error in self.errors)
        return f"<Ensemble of {len(self)} runs of {type(self.system).__name__}, {failed} failed>"


check_arguments(Ensemble, ["plot"])


def ensemble(
    system: System,
    request: Any,
    q: ArrayLike,
    v: ArrayLike | None,
    until: float | None,
    times: ArrayLike | None,
    next_event: Any,
    t: float,
    parameters: Mapping[str, ArrayLike],
    threads: int | None,
) -> Ensemble:
    """Runs many; see `System.ensemble`."""
    cls, n = type(system), len(system.coordinates)
    if not isinstance(parameters, Mapping):
        raise TypeError(f'parameters must be a dict such as {{"l": lengths}}, not {parameters!r}')
    if (until is None) == (times is None):
        raise TypeError("give one of until and times")
    if next_event is not None and until is None:
        raise TypeError("give until with next_event: the time at which a run without an event ends")
    given_states = {"q": states(q, "q", cls), "v": np.zeros(n) if v is None else states(v, "v", cls)}
    given = {}
    for name, value in parameters.items():
        given[name] = (cls._parameter(name), _values(cls._parameter(name), value))
    sizes = {name: len(values) for name, values in given_states.items() if values.ndim == 2}
    sizes |= {name: len(values) for name, (_, values) in given.items() if values.ndim == 2}
    if len(set(sizes.values()) - {1}) > 1:
        listed = ", ".join(f"{name} has {size}" for name, size in sizes.items())
        raise ValueError(f"all must have the same number of runs: {listed}")
    many = next((size for size in sizes.values() if size != 1), 1)
    values = np.tile(system._values, (many, 1))
    for parameter, of in given.values():
        values[:, parameter.start : parameter.start + of.shape[-1]] = of
    rows = {name: np.ascontiguousarray(np.broadcast_to(of, (many, n))) for name, of in given_states.items()}
    end = None if until is None else number(until, "until")
    listed_times = None if times is None else ordered(times, request.h or request.dtau or 1.0).tolist()
    limit = _threads(threads)
    taken, which = system._for(request), None
    if next_event is None:
        with progress(cls.__name__) as report:
            found = taken._kind.ensemble(values, request, t, rows["q"], rows["v"], end, listed_times, limit, report)
        (ts, qs, ps), errors, stopped = found
        errors = [advised(error, cls) for error in errors]
    else:
        starts = (values, rows["q"], rows["v"])
        (ts, qs, ps), errors, which, stopped = _to_events(taken, request, t, starts, end, next_event, limit)
    shape = (many,) if listed_times is None else (many, len(listed_times))
    differing = {
        name: fixed((of[..., 0] if parameter.length is None else of).copy()) for name, (parameter, of) in given.items()
    }
    found = Ensemble(
        system.copy()._fixed(),
        ts.reshape(shape),
        qs.reshape(*shape, n),
        ps.reshape(*shape, n),
        errors,
        values,
        differing,
        which,
    )
    if stopped is not None:
        stopped.solution = found
        raise stopped
    return found


def _to_events(
    system: System, request: Any, t: float, starts: tuple[Array, ...], end: Any, events: Any, threads: int
) -> tuple[tuple[Array, Array, Array], list[StepError | None], NDArray[np.intp], Any]:
    """The end of each run at its first event, or at a time; its exception; the index of the event, or -1; and the
    exception of Ctrl-C."""
    from ._run import Run

    many, n = starts[1].shape
    ts, qs, ps = np.full(many, np.nan), np.full((many, n), np.nan), np.full((many, n), np.nan)
    errors: list[StepError | None] = [None] * many
    which = np.full(many, -1, dtype=np.intp)
    watched, is_stopped = listed(events), threading.Event()

    def stop(part: float) -> None:
        if is_stopped.is_set():
            raise KeyboardInterrupt

    def one(index: int) -> None:
        values, q, v = (of[index] for of in starts)
        try:
            run = Run(type(system), system._kind.begin(values, request, t, q, v, None))
            met = run._events(watched, end, True, 1, None, "raise", stop)
        except StepError as error:
            errors[index] = advised(error, type(system))
            return
        ts[index], qs[index], ps[index] = run.t, run.q, run.p
        which[index] = met.which[0] if len(met) else -1

    stopped: Any = None
    with progress(type(system).__name__) as report, ThreadPoolExecutor(threads) as pool:
        try:
            for done, _ in enumerate(pool.map(one, range(many)), 1):
                if report is not None:
                    report(done / many)
        except BaseException as raised:
            is_stopped.set()
            pool.shutdown(cancel_futures=True)
            if not isinstance(raised, KeyboardInterrupt):
                raise
            stopped = raised
    if stopped is not None:
        errors = [stopped if error is None and np.isnan(t) else error for error, t in zip(errors, ts, strict=True)]
    return (ts, qs, ps), errors, which, stopped


def states(value: ArrayLike, name: str, cls: type[System]) -> Array:
    """States of the shape (M, N), or one of the shape (N,)."""
    found = array(value, name)
    n = len(cls.coordinates)
    if found.ndim not in (1, 2) or found.shape[-1] != n:
        names = ", ".join(cls.coordinates)
        hint = f": {name}[:, None] has it" if n == 1 and found.ndim == 1 else ""
        raise ValueError(f"{name} must have the shape (M, {n}) or ({n},), of {names}, not {found.shape}{hint}")
    finite(found, name)
    return found


def _values(parameter: Any, value: ArrayLike) -> Array:
    """The values of a parameter: (M, 1) for a number, (M, K) for an array; (1, …) for all runs."""
    found = array(value, parameter.name)
    finite(found, parameter.name)
    length = parameter.length or 1
    if parameter.length is None and found.ndim <= 1:
        return found.reshape(-1, 1)
    if parameter.length is not None and found.ndim in (1, 2) and found.shape[-1] == length:
        return found.reshape(-1, length)
    wanted = "(M,)" if parameter.length is None else f"(M, {length})"
    raise ValueError(f"{parameter.name} must have the shape {wanted}, not {found.shape}")


def _threads(threads: int | None) -> int:
    """A number of threads: by default one for each core that this process may use."""
    if threads is not None:
        return min(count(threads, "threads", 1), 1024)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
