"""Events: instants at which a function of time, coordinates and velocities crosses zero."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from ._arrays import Array, number
from ._names import course


@dataclass(frozen=True)
class Event:
    """A coordinate, or `dot(x)` its velocity, crosses a value: `Event("x", 0.0, direction=+1)`.

    The direction is +1 for rising, -1 for falling, and 0 for both. The search does not call Python.
    """

    of: str
    at: float = 0.0
    direction: float = 0


@dataclass(frozen=True)
class Period:
    """The time is `start` plus a whole number of periods: a stroboscopic section of a driven motion."""

    period: float
    start: float = 0.0


Function = Callable[[float, Array, Array], float]
Watched = Event | Period | str | Function
"""An event, the name of a coordinate that crosses zero, or a function g(t, q, v). As in scipy, a function may have an
attribute `direction`."""


_PERIOD = 4.0
"""Steps in the shortest period: the search looks at eighths of a step."""


def descriptions(events: Watched | Iterable[Watched], cls: Any, h: float) -> list[tuple]:
    """The events as `_core` reads them, for a run with steps of about the length h."""
    if isinstance(events, (Event, Period, str)) or callable(events):
        events = [events]
    try:
        listed = list(events)
    except TypeError:
        raise TypeError(f"events must be an Event, a function g(t, q, v), or a list of them, not {events!r}") from None
    if not listed:
        raise ValueError("give at least one event")
    return [_description(event, cls, _PERIOD * h) for event in listed]


def _description(event: Watched, cls: Any, least: float) -> tuple:
    if isinstance(event, str):
        event = Event(event)
    if isinstance(event, Event):
        is_velocity, index = course(event.of, cls.coordinates, cls.__name__)
        return (is_velocity, index, number(event.at, "at"), _sign(event.direction))
    if isinstance(event, Period):
        period = number(event.period, "period")
        if period <= 0.0:
            raise ValueError(f"the period must be positive, not {period!r}")
        if period < least:
            raise ValueError(f"a period must be at least four steps, here {least:g}: use at(times), or shorter steps")
        return (number(event.start, "start"), period)
    if callable(event):
        return (event, _sign(getattr(event, "direction", 0)))
    raise TypeError(f"an event must be an Event or a function g(t, q, v), not {event!r}")


def _sign(direction: Any) -> int:
    value = number(direction, "direction")
    return (value > 0) - (value < 0)
