"""Runs: they take steps, and change on the way."""

from __future__ import annotations

import contextlib
import functools
import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, _shown, count, fixed, number, ordered, real, vector
from ._calls import check_arguments, no_attribute, unassignable, unfit
from ._control import Linearization
from ._crossing import Crossing
from ._errors import InconsistentStart, StepError, _invalid, advised  # type: ignore[attr-defined]
from ._events import Event, Period, Watched, descriptions, listed, periodic
from ._names import among, meant
from ._observed import observed
from ._progress import Report, progress
from ._solution import BY_SYSTEM, Events, Solution

if TYPE_CHECKING:
    from ._system import System


@unassignable()
class LocalError(NamedTuple):
    """The error of one step: of the coordinates, and of the velocities times its length."""

    q: Array
    hv: Array


@unassignable()
class ErrorEstimate(NamedTuple):
    """The largest error of a step, relative to the scale of its motion, and what the errors of all steps may add up to."""

    estimate: float
    t: float
    coordinate: str
    sum: float


Look = Callable[["Run", float], tuple[Solution, bool]]
"""Finds rows of a run up to a time, where it leaves the run if they are the last ones."""


def _change(run: Run, name: str) -> str:
    """What to do instead of an assignment to an attribute of a run."""
    if name in ("t", "q", "v", "p"):
        return f"run.{name} cannot be assigned: run.set_state({name}=…) continues from another state"
    if name == "h":
        return "run.h cannot be assigned: run.step(h) takes a step of another length"
    if name in run._cls.parameters:
        return f"a run has no attribute {name!r}: run.set({name}=…) changes the parameter"
    return f"run.{name} cannot be assigned"


@unassignable(_change)
class Run:
    """A run. It holds the last node: time `t`, coordinates `q`, momenta `p`.

    `step`, `steps`, `until`, `at` and `events` continue from there. Its arrays cannot be written: `set_state` continues
    from another state.
    """

    __slots__ = ("_cls", "_run")

    def __init__(self, cls: type[System], run: Any):
        self._cls = cls
        self._run = run

    def __getattr__(self, name: str) -> Any:
        if hasattr(Run, name):
            # A property raised the exception.
            return object.__getattribute__(self, name)
        # A run that is being copied has no class.
        if not name.startswith("_") and name in (names := self._cls.coordinates):
            raise no_attribute(self, name, f"the coordinate is run.q[{names.index(name)}]")
        if not name.startswith("_") and name in self._cls.parameters:
            raise no_attribute(self, name, f"the parameter is run.system.{name}")
        raise no_attribute(self, name)

    def __getitem__(self, name: str) -> Any:
        """A coordinate, a velocity, a momentum, a parameter or an expression at the last node, as of a solution:
        `run["x"]`, `run["m * x^2"]`."""
        return Solution(self.system, np.array([self.t]), self.q[None], self.p[None])[name][0]

    # Otherwise Python would go through a run by numbers.
    __iter__ = None

    @property
    def t(self) -> float:
        """Time of the last node."""
        return self._run.t

    @property
    def q(self) -> Array:
        """Coordinates of the last node."""
        return fixed(self._run.q)

    @property
    def p(self) -> Array:
        """Momenta of the last node."""
        return fixed(self._run.p)

    @property
    def v(self) -> Array:
        """Velocities of the last node."""
        return fixed(self._run.v)

    @property
    def reactions(self) -> Array:
        """The multiplier Λ of each constraint at the last node, in the order of `system.constraints`."""
        return fixed(self.system.reaction(self.t, self.q, self.p))

    @property
    def h(self) -> float:
        """Length of the last step; before the first one the requested length."""
        return self._run.h

    @property
    def energy(self) -> float:
        """The energy H at the last node."""
        return self._run.energy

    @property
    def discrete_energy(self) -> float | None:
        """The discrete energy of the last step; None without such a step.

        Energy-preserving steps keep it: it changes only by the work of forces and moving constraints, and by an
        explicit time. With a shift they keep `shifted_energy` instead.
        """
        return self._run.discrete_energy

    @property
    def shifted_energy(self) -> float | None:
        """The energy that steps with a shift keep; None for other steps. It changes only by the work of forces and
        moving constraints, and by an explicit time."""
        found = self._run.shifted_energy
        return None if found is None else found[0]

    @property
    def shift(self) -> float | None:
        """The shift of the step density; None without a shift."""
        found = self._run.shifted_energy
        return None if found is None else found[1]

    @property
    def system(self) -> System:
        """The system with the present parameters, which cannot be set there: `run.set` changes them."""
        return self._cls._of(self._run.parameters)._fixed()

    def __repr__(self) -> str:
        method, stages, is_transformed = self._run.integrator
        name = method + (f", stages={stages}" if stages else "") + (", transformed time" if is_transformed else "")
        return f"<Run of {self.system!r} by {name}: t = {self.t:g}, h = {self.h:g}>"

    def step(self, h: float | None = None) -> Run:
        """Takes one step, of the length h if given, and returns the run."""
        try:
            self._run.step(None if h is None else real(h, "h"))
        except StepError as error:
            raise advised(error, self._cls) from None
        return self

    def until(
        self,
        t: float,
        every: int = 1,
        *,
        dense: bool = False,
        callback: Callable[[Run], Any] | None = None,
        on_error: str = "raise",
    ) -> Solution:
        """Takes steps to the time t, where the last of them ends.

        Returns the start, each `every`th node, and the end. With `dense=True` the solution is a function of time.
        After each `every`th step it calls `callback(run)`, which may change the run, and which ends it by returning
        True. A row is the state before its callback, with the velocity and the energy of its step.

        A failed step raises StepError, whose attribute `solution` has the rows so far, as has an exception of the
        callback, and KeyboardInterrupt; with `on_error="return"` the solution is returned, and has the StepError as
        `error`. A run that takes longer than two seconds shows its progress, if tqdm is installed.
        """
        if np.ndim(t):
            raise TypeError(f"t must be one time, not {_shown(t)}: at(times) returns the states at several times")
        return self._advance(self._ahead(t, "t"), None, every, dense, callback, on_error)

    def steps(
        self,
        count: int,
        every: int = 1,
        *,
        dense: bool = False,
        callback: Callable[[Run], Any] | None = None,
        on_error: str = "raise",
    ) -> Solution:
        """Takes `count` steps; the rest as `until`."""
        return self._advance(None, _count(count, "the number of steps"), every, dense, callback, on_error)

    def _advance(
        self, end: float | None, steps: int | None, every: int, dense: bool, callback: Any, on_error: str
    ) -> Solution:
        every = _count(every, "every", 1)
        _check_on_error(on_error)
        system = self.system
        if callback is None:
            again, start = self._repeats(end, steps, every) if dense else None, self.copy()
            with progress(self._title) as report:
                (t, q, p), error, polynomials = self._run.advance(end, steps, every, bool(dense), report)
            found = Solution(system, t, q, p, advised(error, self._cls), polynomials, again)
            found._start = start
            return _finished(found, on_error)
        if dense:
            raise ValueError("dense=True and a callback do not go together: the callback may change the motion")
        return _finished(self._called(end, steps, every, callback), on_error)

    def _ahead(self, t: Any, name: str) -> float:
        """A time that the steps lead to."""
        found = number(t, name)
        if (found - self.t) * self.h < 0.0:
            raise _invalid(
                name,
                f"ahead of the run, which is at t = {self.t:g} with h = {self.h:g} (a negative h goes back in time)",
                found,
            )
        return found

    @property
    def _title(self) -> str:
        """The title of a progress bar."""
        return self._cls.__name__

    def _repeats(self, end: float | None, steps: int | None, every: int) -> Callable[[], Any] | None:
        """A function that takes the same steps with dense output from the present state, and that can be pickled; None
        if the state cannot be stored."""
        try:
            start = self.checkpoint()
        except ValueError:
            return None
        return functools.partial(_advanced, start, end, steps, every)

    def _called(
        self, end: float | None, left: int | None, every: int, callback: Callable[[Run], Any], look: Look | None = None
    ) -> Solution:
        """The rows of a run with a callback, which may move it beyond the end: its nodes, or what `look` finds."""
        if not callable(callback):
            raise TypeError(f"callback must be a function of the run, not {callback!r}")
        if (arguments := unfit(callback, 1)) is not None:
            raise TypeError(f"callback must be a function of one argument, the run, not of {arguments}")
        with progress(self._title) as report:
            return self._in_parts(end, left, every, callback, look, report)

    def _in_parts(
        self, end: float | None, left: int | None, every: int, callback: Any, look: Look | None, report: Report | None
    ) -> Solution:
        system, error = self.system, None
        begin, steps = self.t, left
        parts: list[Solution] = []
        # The numbers of the system from each row of a part on.
        values: list[Array] = []
        ahead = 1.0 if end is None else float(np.sign(end - self.t))
        try:
            while True:
                before = self.copy() if look else None
                # At most `every` steps at a time, so that the callback sees each row.
                few = every if left is None else min(every, left)
                (t, q, p), failed, _ = self._run.advance(end, few, few or 1, False)
                error = advised(failed, self._cls)
                if look is None or before is None:
                    # Each part begins with the row that ends the one before.
                    fresh = slice(1 if parts else 0, None)
                    part, is_over = Solution(self.system, t[fresh], q[fresh], p[fresh]), False
                else:
                    part, is_over = look(before, self.t)
                    error = part.error if is_over else part.error or error
                parts.append(part)
                values.append(np.tile(part.system._values, (len(part), 1)))
                if is_over and before is not None:
                    # It has ended at the last row.
                    self._run = before._run
                left = None if left is None else left - few
                if report is not None and steps:
                    report(1.0 - (left or 0) / steps)
                elif report is not None and end is not None and end != begin:
                    report((self.t - begin) / (end - begin))
                if is_over or error is not None or len(t) == 1:
                    break
                is_ended = _is_true(callback(self))
                if look is None:
                    values[-1][-1] = self._run.parameters
                if is_ended or left == 0 or (end is not None and (end - self.t) * ahead <= 0.0):
                    break
        except BaseException as raised:
            # The rows so far, as of a failed step.
            with contextlib.suppress(AttributeError):
                raised.solution = _joined(system, parts, values, None)  # type: ignore[attr-defined]
            raise
        return _joined(system, parts, values, error)

    def at(
        self,
        times: ArrayLike,
        *,
        every: int = 1,
        callback: Callable[[Run], Any] | None = None,
        on_error: str = "raise",
    ) -> Solution:
        """The states at times in the order of the run, as accurate as nodes. The run keeps its own steps.

        It calls `callback(run)` after each `every`th step, as `until` does, and a row is the state before it.
        """
        _check_on_error(on_error)
        wanted = ordered(times, self.h)
        if len(wanted):
            self._ahead(float(wanted[0]), "times[0]")
        if callback is None:
            start = self.copy()
            with progress(self._title) as report:
                (t, q, p), error, _ = self._run.at(wanted, report)
            found = Solution(self.system, t, q, p, advised(error, self._cls))
            found._start = start
            return _finished(found, on_error)
        ahead, done = float(np.sign(self.h)), 0

        def look(before: Run, t: float) -> tuple[Solution, bool]:
            nonlocal done
            here = wanted[done:][(wanted[done:] - t) * ahead <= 0.0]
            done += len(here)
            return before.at(here, on_error="return"), done == len(wanted)

        return _finished(self._called(None, None, _count(every, "every", 1), callback, look), on_error)

    def events(
        self,
        events: Watched | Iterable[Watched],
        until: float,
        *,
        every: int = 1,
        callback: Callable[[Run], Any] | None = None,
        on_error: str = "raise",
    ) -> Events:
        """Takes steps to the time `until`, and returns the events on the way, located to rounding.

        It calls `callback(run)` after each `every`th step, as `until` does.
        """
        return self._events(events, until, False, every, callback, on_error)

    def next_event(
        self,
        events: Watched | Iterable[Watched],
        until: float,
        *,
        every: int = 1,
        callback: Callable[[Run], Any] | None = None,
        on_error: str = "raise",
    ) -> Events:
        """Takes steps to the first event, where the run stops, or to the time `until`: then no row is returned.

        It calls `callback(run)` after each `every`th step, as `until` does.
        """
        return self._events(events, until, True, every, callback, on_error)

    def _events(
        self,
        events: Any,
        until: float,
        is_first: bool,
        every: int,
        callback: Any,
        on_error: str,
        report: Report | None = None,
    ) -> Events:
        _check_on_error(on_error)
        if isinstance(until, (Event, Period, str)) or callable(until):
            raise TypeError("give several events as a list, and until, the time at which the run ends")
        end, events = self._ahead(until, "until"), listed(events)
        if callback is not None:

            def look(before: Run, t: float) -> tuple[Solution, bool]:
                found = before._events(events, t, is_first, 1, None, "return")
                return found, is_first and len(found) > 0

            return _finished(self._called(end, None, _count(every, "every", 1), callback, look), on_error)
        wanted = descriptions(events, self, is_first)
        turns = periodic(events)
        while True:
            with progress(self._title) as own:
                (t, q, p), error, met = self._run.events(wanted, end, is_first, report or own)
            which = np.array([index for index, _ in met], dtype=np.intp)
            rising = np.array([rises for _, rises in met], dtype=np.bool_)
            found = Events(self.system, t, q, p, advised(error, self._cls), which, rising)
            if turns and len(found):
                found = found._directed(turns)
            # The first event may have the other direction.
            if not is_first or len(found) or not len(met) or error is not None:
                return _finished(found, on_error)

    def set(self, **parameters: Any) -> Run:
        """Changes parameters from here on. Coordinates and momenta stay.

        A parameter of a constraint may need another state: then InconsistentStart names the call.
        """
        try:
            self._run.set_parameters(_pairs(self._cls, parameters))
        except InconsistentStart as error:
            changed = ", ".join(f"{name}=…" for name in parameters)
            error.args = (
                f"{error.reason}; set keeps the coordinates and the momenta, which this change does not allow. Project "
                f"them first: at = run.system.copy().set({changed}).project(run.q, run.v, t=run.t), then "
                f"run.set_state(q=at.q, v=at.v, parameters=dict({changed}))",
            )
            raise
        return self

    def set_state(
        self,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        *,
        t: float | None = None,
        p: ArrayLike | None = None,
        parameters: Mapping[str, Any] | None = None,
    ) -> Run:
        """Continues from another state, for example after an impact. What is not given stays; without v the momenta
        stay. `parameters` change with it: another length or place of a constraint needs a state on it."""
        if v is not None and p is not None:
            raise TypeError("give one of v and p, not both")
        names = self._cls.coordinates
        t = self.t if t is None else number(t, "t")
        q = self.q if q is None else vector(q, len(names), "q", names)
        if v is not None:
            system = self.system.copy().set(**(parameters or {}))
            p = system.momentum(t, q, vector(v, len(names), "v", names))
        p = self.p if p is None else vector(p, len(names), "p", names)
        self._run.set_state(t, q, p, _pairs(self._cls, parameters or {}))
        return self

    def tangent(
        self,
        steps: int | None = None,
        wrt: Sequence[str] = (),
        *,
        until: float | None = None,
        event: Event | str | None = None,
        velocities: bool = False,
    ) -> dict[str, Array]:
        """Takes steps, or runs to the time `until`, and returns the derivatives of (q, p) there, exact to rounding.

        The matrices "q" and "p" (2N, N) are with respect to the start; each name in `wrt` adds the derivative with
        respect to this parameter: (2N,), or (2N, K) for an array. The name "h" means the length of the steps, if no
        parameter has it; for method="energy" that of the first step, which determines the kept energy, and not for
        method="adaptive". With `velocities` all are in (q, v): the matrices are "q" and "v", and velocities are
        constant when a parameter changes.

        With an event, a quantity that crosses a value, the run ends at its first time before `until`. A last row then has
        the derivatives of this time. With constraints the start is the nearest state on them, as of `System.project`:
        changes of the coordinates or of a parameter move it.

        Raises ValueError if there is no event before `until`.
        """
        n = len(self._cls.coordinates)
        names, indices = self._wrt(wrt, True)
        options = self._end(steps, until, event)
        if isinstance(crossing := options.get("event"), Crossing):
            columns = crossing.tangent(indices, velocities)
        else:
            with progress(self._title) as report:
                columns = self._tangent(indices, velocities=[velocities, velocities], report=report, **options)
        columns = columns if event is not None else columns[: 2 * n]
        second = "v" if velocities else "p"
        found = {"q": columns[:, :n].copy(), second: columns[:, n : 2 * n].copy()}
        return {**found, **self._split(columns[:, 2 * n :], names)}

    def _end(self, steps: int | None, until: float | None, event: Any) -> dict[str, Any]:
        """The end of differentiated steps."""
        if (steps is None) == (until is None):
            raise TypeError("give one of steps and until")
        if event is not None:
            if until is None:
                raise TypeError("give until with an event: the time up to which it is looked for")
            if not isinstance(event, (Event, str)) or getattr(event, "period", None) is not None:
                raise TypeError(
                    "an event of a derivative must be a coordinate, a velocity, a momentum or an expression that crosses a "
                    f'value, such as vi.Event("{self._cls.coordinates[0]}", 0.0), not {event!r}'
                )
            met = self.copy().next_event(event, until)
            if not len(met):
                raise ValueError(f"there is no event before t = {until:g}")
            t, described = float(met.t[0]), descriptions(event, self, True)[0]
            of = observed(event if isinstance(event, str) else event.of, self._cls)
            return {"t": t, "event": Crossing(self, of, t) if callable(described[0]) else described}
        return {"steps": _count(steps, "the number of steps")} if until is None else {"t": number(until, "until")}

    def _tangent(self, indices: list[int], **options: Any) -> Array:
        """The derivatives of (q, p, t) at the end of steps with respect to (q, p) and these numbers of the system: a
        column for each."""
        with self._advising():
            return self._run.tangent(indices, **options).T

    def _gradient(self, indices: list[int], slope: Array, **options: Any) -> Array:
        """The gradient of slope·(q, p, t) at the end of steps with respect to (q, p) and these numbers of the system."""
        with self._advising():
            return self._run.gradient(indices, slope, **options)

    def _tangents_at(self, indices: list[int], times: Array, velocities: bool = True) -> Array:
        """The derivatives of (q, v), or of (q, p), at these times with respect to (q, v) of the start and these
        parameters: (K, 2N, D)."""
        run = self.copy()
        with run._advising(), progress(run._title) as report:
            found = run._run.tangents_at(indices, times, velocities, report)
        return np.moveaxis(found, 1, 2)[:, : 2 * len(self._cls.coordinates)]

    def lyapunov(self, steps: int, count: int = 1) -> Array:
        """Takes steps, and returns the largest Lyapunov exponents of them, per unit of time, in descending order.

        `count` is at most 2N, less 2 for each constraint on positions and 1 for each on velocities.
        """
        steps = _count(steps, "the number of steps", 1)
        with self._advising(), progress(self._title) as report:
            return self._run.lyapunov(steps, _count(count, "the number of exponents", 1), report)

    def gradient(
        self,
        steps: int | None = None,
        *,
        q: ArrayLike | None = None,
        p: ArrayLike | None = None,
        v: ArrayLike | None = None,
        t: float | None = None,
        wrt: Sequence[str] = (),
        until: float | None = None,
        event: Event | str | None = None,
        velocities: bool = False,
    ) -> dict[str, Array]:
        """Takes steps, or runs to the time `until`, and returns the gradient of a function of the end by one backward
        pass.

        q and p are the derivatives of that function with respect to (q, p) at the end. The result has its gradients
        with respect to "q" and "p" at the start, and to each parameter in `wrt`. With `velocities` all are in (q, v):
        v takes the place of p, the result has "q" and "v", and velocities are constant when a parameter changes. With
        constraints the start is the nearest state on them.

        With an event the run ends there, as that of `tangent` does; t is the derivative of the function with respect
        to this time.
        """
        names_of, n = self._cls.coordinates, len(self._cls.coordinates)
        second, of_second, other = ("v", v, p) if velocities else ("p", p, v)
        if other is not None:
            raise TypeError("v and velocities=True go together: p has derivatives with respect to momenta")
        if t is not None and event is None:
            raise TypeError("t is the derivative with respect to the time of an event: give event")
        if q is None and of_second is None and t is None:
            raise TypeError(f"give q or {second}: the derivatives of the function at the end")
        given = ((q, "q"), (of_second, second))
        parts = [np.zeros(n) if x is None else vector(x, n, name, names_of) for x, name in given]
        slope = np.array([*parts[0], *parts[1], 0.0 if t is None else number(t, "t")])
        names, indices = self._wrt(wrt)
        options = self._end(steps, until, event)
        if isinstance(crossing := options.get("event"), Crossing):
            found = crossing.gradient(indices, slope, velocities)
        else:
            with progress(self._title) as report:
                found = self._gradient(indices, slope, velocities=[velocities, velocities], report=report, **options)
        columns = self._split(found[2 * n :], names)
        return {"q": found[:n].copy(), second: found[n : 2 * n].copy(), **columns}

    @contextlib.contextmanager
    def _advising(self) -> Iterator[None]:
        try:
            yield
        except StepError as error:
            raise advised(error, self._cls) from None

    def _wrt(self, wrt: Sequence[str], has_length: bool = False) -> tuple[list[str], list[int]]:
        """The names, and the indices of their numbers; that of the step length is the number of parameters."""
        names = [wrt] if isinstance(wrt, str) else list(wrt)
        if not all(isinstance(name, str) for name in names):
            raise TypeError(f"wrt must be names of parameters, not {wrt!r}")
        for name in names:
            if not has_length and name == "h" and name not in self._cls.parameters:
                raise TypeError('gradient has no derivative with respect to "h": run.tangent(n, ["h"]) has it')
            if (start := among(name, self._cls.coordinates)) in self._cls.coordinates:
                raise TypeError(
                    f'{start} is no parameter: the derivatives with respect to the start are in the result, as "q"'
                )
        length = range(len(self._cls._defaults), len(self._cls._defaults) + 1)
        is_length = [has_length and name == "h" and name not in self._cls.parameters for name in names]
        if any(is_length) and self._run.integrator[0] == "adaptive":
            raise ValueError(
                'method="adaptive" finds the lengths of its steps: there is no derivative with respect to h'
            )
        named = zip(names, is_length, strict=True)
        indices = [length if own else self._cls._parameter(name).indices for name, own in named]
        return names, [index for of in indices for index in of]

    def _split(self, columns: Array, names: list[str]) -> dict[str, Array]:
        """The last axis by parameters."""
        found, start = {}, 0
        for name in names:
            # The step length is no parameter.
            parameter = self._cls._parameter(name) if name != "h" or name in self._cls.parameters else None
            count = len(parameter.indices) if parameter else 1
            part = columns[..., start : start + count]
            start += count
            found[name] = part.copy() if parameter and parameter.length is not None else part[..., 0].copy()
        return found

    def linearization(self) -> Linearization:
        """The linearization of the next step: derivatives of (q, p) at its end with respect to (q, p) at its start and
        to the inputs, which are constant over the step. The run does not change."""
        return Linearization(self.t, *self._run.linearization())

    def local_error(self) -> LocalError:
        """The error of the next step, by half steps. The run does not change."""
        return LocalError(*self._run.local_error())

    def monitor(self) -> Run:
        """Measures errors of the steps from here on, for `error_estimate`. It changes no bit of them."""
        self._run.monitor()
        return self

    @property
    def error_estimate(self) -> ErrorEstimate | None:
        """The largest error of a step since `monitor()`, relative to the scale of its motion.

        None if no step was measured: those of `step`, `steps` and `until` are, those of `at`, of events and of
        derivatives are not.
        """
        found = self._run.largest_error
        if found is None:
            return None
        estimate, t, index, total = found
        return ErrorEstimate(estimate, t, self._cls.coordinates[index], total)

    def __copy__(self) -> Run:
        return Run(self._cls, self._run.copy())

    def __deepcopy__(self, memo: Any) -> Run:
        return self.__copy__()

    def copy(self) -> Run:
        """The same run once more: both continue alike, bit for bit."""
        return self.__copy__()

    def checkpoint(self) -> bytes:
        """Everything that the run carries, for `pickle.loads`, which restarts it bit for bit."""
        return pickle.dumps(self)

    def __reduce__(self) -> Any:
        return (_restarted, (self.system, self._run.integrator, self._run.checkpoint()))


# Not `step`, which programs call most.
check_arguments(
    Run, ["until", "steps", "at", "events", "next_event", "set", "set_state", "tangent", "gradient", "lyapunov"]
)


def _pairs(cls: type[System], parameters: Mapping[str, Any]) -> list[tuple[int, float]]:
    """Indices and numbers of parameters."""
    changes = [(cls._parameter(name), value) for name, value in parameters.items()]
    pairs = [(parameter.indices, parameter.numbers(value).tolist()) for parameter, value in changes]
    return [pair for indices, values in pairs for pair in zip(indices, values, strict=True)]


def _restarted(system: System, integrator: tuple[str, int | None, bool], stored: str) -> Run:
    return Run(type(system), system._kind.restart(system._values, integrator, stored))


def _advanced(start: bytes, end: float | None, steps: int | None, every: int) -> Any:
    """The rows, the error and the dense output of a stored run."""
    return pickle.loads(start)._run.advance(end, steps, every, True)


def _finished(solution: Any, on_error: str) -> Any:
    """The solution, or its exception: that of a failed step, of a function of an event, or of Ctrl-C."""
    error = solution.error
    if error is None or (on_error == "return" and isinstance(error, StepError)):
        return solution
    with contextlib.suppress(AttributeError):
        error.solution = solution
    raise error


def _is_true(answer: Any) -> bool:
    """Whether a callback returned True: other values, such as the run, do not end it."""
    return isinstance(answer, (bool, np.bool_)) and bool(answer)


def _joined(system: System, parts: list[Solution], values: list[Array], error: Any) -> Solution:
    """The rows of all parts, with the numbers of the system from each row on."""

    def all_of(name: str) -> Any:
        return np.concatenate([getattr(part, name) for part in parts])

    if not parts:
        n = len(system.coordinates)
        return Solution(system, np.zeros(0), np.zeros((0, n)), np.zeros((0, n)), error)
    columns = all_of("t"), all_of("q"), all_of("p"), error
    if isinstance(parts[0], Events):
        joined: Solution = Events(system, *columns, all_of("which"), all_of("rising"))
    else:
        joined = Solution(system, *columns)
    numbers = np.concatenate(values)
    joined._values = None if (numbers == system._values).all() else numbers
    if any(part.system != system for part in parts):
        # Velocity, energy and reactions of each row belong to the parameters of its step.
        vars(joined).update({name: fixed(all_of(name)) for name in BY_SYSTEM})
    return joined


_ON_ERROR = ("raise", "return")


def _check_on_error(on_error: str) -> None:
    if on_error not in _ON_ERROR:
        raise ValueError(f'on_error must be "raise" or "return", not {on_error!r}{meant(str(on_error), _ON_ERROR)}')


_count = count
