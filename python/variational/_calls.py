"""Calls in the words of other tools: an unknown argument is reported with the word of this package.

In: the classes whose methods users call. Out: the same methods, which check the names of their arguments first.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any

from ._names import meant

_ELSEWHERE = {
    "h": "dt delta_t deltat step step_size stepsize timestep time_step max_step first_step",
    "until": "t_span tspan t_end tend t_final tfinal t_max tmax t_stop tf duration",
    "t": "t0 t_start tstart start_time",
    "times": "t_eval teval t_grid",
    "tolerance": "rtol atol tol reltol abstol eps accuracy",
    "q": "qpos q0 x0 x position positions coordinates",
    "v": "qvel v0 qdot qd dq xdot velocity velocities",
    "p": "p0 momentum momenta",
    "q and v": "y0 y state",
    "events": "event",
    "dense": "dense_output",
    "method": "solver integrator",
    "stages": "order",
    "steps": "n_steps nsteps num_steps n",
    "parameters": "args params",
    "callback": "callbacks",
}
"""Words of this package, and what scipy, MuJoCo, sympy and others call the same."""

_WORDS = {word: ours for ours, words in _ELSEWHERE.items() for word in words.split()}

_OF_A_RUN = {
    "until": "until(…)",
    "times": "at(…)",
    "events": "events(…) or next_event(…)",
    "dense": "until(…, dense=True)",
    "steps": "steps(…)",
    "callback": "until(…, callback=…)",
}
"""Arguments of other tools that are methods of a run here."""


def unfit(function: Callable[..., Any], count: int) -> str | None:
    """The arguments of a user's function that cannot be called with this many; None if it can."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        # Some functions of C modules have none.
        return None
    try:
        signature.bind(*[None] * count)
    except TypeError:
        return str(signature)
    return None


def check_arguments(cls: type, names: Iterable[str]) -> None:
    """Replaces these methods of a class by ones that check their arguments."""
    for name in names:
        setattr(cls, name, _checking(cls, cls.__dict__[name]))


def _checking(cls: type, function: Callable[..., Any]) -> Callable[..., Any]:
    _, *listed = inspect.signature(function).parameters
    known = frozenset(listed)

    @functools.wraps(function)
    def checked(*arguments: Any, **options: Any) -> Any:
        if not arguments or not isinstance(arguments[0], cls):
            raise TypeError(
                f"{function.__name__} needs a system, not its class: write the parentheses, as in "
                f"vi.Pendulum().{function.__name__}(…), with parameters between them"
            )
        if not options.keys() <= known:
            wrong = next(name for name in options if name not in known)
            raise TypeError(_unknown(function.__name__, wrong, listed, arguments[0]))
        return function(*arguments, **options)

    return checked


def _unknown(method: str, wrong: str, known: list[str], owner: Any) -> str:
    """The message of an argument that a method does not have."""
    what = f"{method} has no argument {wrong!r}"
    ours = wrong if wrong in _OF_A_RUN else _WORDS.get(wrong, "")
    if wrong in getattr(owner, "parameters", ()):
        return f"{what}: it is a parameter, write {type(owner).__name__}({wrong}=…).{method}(…)"
    if ours and all(word in known for word in ours.split(" and ")):
        return f"{what}: write {' and '.join(f'{word}=…' for word in ours.split(' and '))}"
    if ours == "parameters":
        return f"{what}: the parameters belong to the system, as in vi.Pendulum(l=0.5).{method}(…)"
    if ours == "events" and method == "ensemble":
        return f"{what}: an ensemble finds no events; call next_event(…) of single runs"
    if ours in _OF_A_RUN and method == "integrate":
        return f"{what}: call {_OF_A_RUN[ours]} of the run that it returns"
    return f"{what}{meant(wrong, known)}; it has {', '.join(known)}"
