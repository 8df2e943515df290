"""Events: instants at which a function of time, coordinates and velocities crosses zero."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import Array, _shown, number
from ._calls import check_arguments, unassignable, unfit
from ._observed import Observed, observed


def _refused(event: Any, name: str) -> str:
    """What to do instead of an assignment to an attribute of an event."""
    stop = ", and run.next_event(event, until), which stops the run there" if name == "terminal" else ""
    return f"{name} of an event cannot be assigned: write {type(event).__name__}(…) with it{stop}"


@unassignable(_refused)
@dataclass(frozen=True)
class Event:
    """A coordinate, `dot(x)` its velocity or `p_x` its momentum crosses a value: `Event("x", 0.0, direction=+1)`.

    The direction is +1 for rising, -1 for falling, and 0 for both. The search does not call Python.

    Any expression of the language may cross a value too, `Event("norm(r[0] - r[1])", 0.1)`, in the names of the system:
    coordinates, parameters, `let`s, functions and tables. That search calls Python.

    With a period it crosses the value plus a whole number of periods: `Event("θ", period=2 * np.pi)` is an event in each
    turn of an angle. That search calls Python.
    """

    of: str
    at: float = 0.0
    direction: float = 0
    period: float | None = None


@unassignable(_refused)
@dataclass(frozen=True)
class Period:
    """The time is `start` plus a whole number of periods: a stroboscopic section of a driven motion."""

    period: float
    start: float = 0.0


check_arguments(Event, ["__init__"])
check_arguments(Period, ["__init__"])

Function = Callable[[float, Array, Array], float]
Watched = Event | Period | str | Function
"""An event, a coordinate or an expression that crosses zero, or a function g(t, q, v), whose sign changes at the event.
As in scipy, a function may have an attribute `direction`."""


_PERIOD = 4.0
"""Steps in the shortest period: the search looks at eighths of a step."""


def descriptions(events: Watched | Iterable[Watched], run: Any, is_first: bool) -> list[tuple]:
    """The events as `_core` reads them, for a run; `is_first` if it stops at one."""
    watched = listed(events)
    if not watched:
        raise ValueError("give at least one event")
    return [_description(event, run, f"event {index}", is_first) for index, event in enumerate(watched)]


def listed(events: Watched | Iterable[Watched]) -> list[Watched]:
    """The events as a list."""
    if isinstance(events, (Event, Period, str)) or callable(events):
        return [events]
    try:
        return list(events)
    except TypeError:
        raise TypeError(f"events must be an Event, a function g(t, q, v), or a list of them, not {events!r}") from None


def periodic(events: Watched | Iterable[Watched]) -> dict[int, tuple[Event, float]]:
    """The events with a period, and their periods, by their index. The search finds both directions of them: its
    function changes its own from one period to the next."""
    return {
        index: (event, event.period)
        for index, event in enumerate(listed(events))
        if isinstance(event, Event) and event.period is not None
    }


def _description(event: Watched, run: Any, place: str, is_first: bool) -> tuple:
    cls = run._cls
    if isinstance(event, str):
        event = Event(event)
    if isinstance(event, Event):
        return _crossing(event, run, place)
    if isinstance(event, Period):
        period = number(event.period, "period")
        if period <= 0.0:
            raise ValueError(f"the period must be positive, not {period!r}")
        if period < (least := _PERIOD * abs(run.h)):
            raise ValueError(f"a period must be at least four steps, here {least:g}: use at(times), or shorter steps")
        return (number(event.start, "start"), period)
    if callable(event):
        name = getattr(event, "__name__", "<lambda>")
        name = place if name == "<lambda>" else f"{place}, `{name}`,"
        if (arguments := unfit(event, 3)) is not None:
            raise TypeError(f"{name} must be a function g(t, q, v), not of {arguments}: scipy's y is (q, v)")
        if not is_first and getattr(event, "terminal", False):
            raise ValueError(f"{name} has terminal = {event.terminal!r}: run.next_event(…) stops the run at an event")
        if is_first and getattr(event, "terminal", True) not in (True, 1):
            raise ValueError(
                f"{name} has terminal = {event.terminal!r}: next_event stops the run at the first of its events; "
                "run.events(…) records events on the way, and k calls of next_event find the k-th one"
            )
        return (event, _sign(getattr(event, "direction", 0)), name)
    value = (
        f": a value belongs to its event, as in vi.Event(name, {event!r})" if isinstance(event, (int, float)) else ""
    )
    raise TypeError(f"an event must be an Event or a function g(t, q, v), not {event!r}{value}")


def _crossing(event: Event, run: Any, place: str) -> tuple:
    """The description of a quantity that crosses a value."""
    at, direction, n = number(event.at, "at"), _sign(event.direction), len(run._cls.coordinates)
    try:
        of = observed(event.of, run._cls)
    except ValueError:
        if re.search("[<>=]", event.of) is None:
            raise
        raise ValueError(
            f"{event.of!r} is a condition: write the quantity and the value that it crosses, such as "
            f'vi.Event("{run._cls.coordinates[0]}", 0.1)'
        ) from None
    if of.shape:
        raise ValueError(f"{event.of!r} has the shape {of.shape}: an event needs one number, such as its norm")
    if event.period is None and of.place is not None and of.place < 2 * n:
        return (of.place >= n, of.place % n, at, direction)
    above = _above(of, at, run)
    if event.period is None:
        return (above, direction, place)
    period = number(event.period, "period")
    if period <= 0.0:
        raise ValueError(f"the period of an event must be positive, not {event!r}")
    return (lambda t, q, v: math.sin(math.pi * (above(t, q, v) / period)), 0, place)


def _above(of: Observed, at: float, run: Any) -> Function:
    """A quantity minus a value, with the numbers of a run."""
    system, place, n = run.system, of.place, len(run._cls.coordinates)
    if place is None:
        observable, numbers = system._observable(of.text), [system._values.tolist()]
        return lambda t, q, v: observable.values(([t], [q.tolist()], [v.tolist()]), numbers)[0] - at
    if place < 2 * n:
        return lambda t, q, v: (q if place < n else v)[place % n] - at
    return lambda t, q, v: system.momentum(t, q, v)[place % n] - at


def value(found: Any, name: str) -> float:
    """The value of a function at a state, which is no float: Rust calls this with the name of the event.

    Raises TypeError for what is no real number, and for a truth value, which has no zero.
    """
    if isinstance(found, bool) or (np.ndim(found) == 0 and getattr(found, "dtype", None) == np.bool_):
        raise TypeError(
            f"{name} returned {bool(found)}, the truth of a condition: return a number that changes its sign at the "
            "event, such as q[0] in place of q[0] < 0"
        )
    if found is None:
        raise TypeError(f"{name} returned None: return a number that changes its sign at the event, such as q[0]")
    if isinstance(found, (str, bytes, complex)) or np.ndim(found) != 0:
        shape = f"an array of shape {np.shape(found)}" if isinstance(found, np.ndarray) else _shown(found)
        raise TypeError(f"{name} returned {shape}: return one real number, such as q[0]")
    try:
        return float(found)
    except (TypeError, ValueError):
        raise TypeError(f"{name} returned {_shown(found)}: return one real number, such as q[0]") from None


def _sign(direction: Any) -> int:
    value = number(direction, "direction")
    return (value > 0) - (value < 0)
