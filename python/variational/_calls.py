"""Unknown arguments and attributes: their messages have the word of this package for that of another tool, or a close
name.

In: the classes and functions that users call. Out: the same ones, which check the names of their arguments first.
"""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Iterable
from typing import Any, TypeVar, cast

from ._names import among, meant

_ELSEWHERE = {
    "h": "dt delta_t deltat step step_size stepsize timestep time_step max_step first_step",
    "until": "t_span tspan t_end tend t_final tfinal t_max tmax t_stop tf duration",
    "t": "t0 t_start tstart start_time",
    "times": "t_eval teval t_grid at",
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
    "axes": "ax axis",
    "fps": "frame_rate framerate rate",
    "threads": "n_jobs workers max_workers num_workers processes nthreads n_threads",
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


_ATTRIBUTES = {
    "integrate": "simulate solve run start propagate evolve solve_ivp odeint",
    "until": "integrate simulate solve run propagate evolve propagate_until",
    "at": "propagate_grid sample evaluate",
    "next_event": "event",
    "checkpoint": "save dump",
    "ensemble": "map batch vmap",
    "explain": "equations latex show",
    "to_dataframe": "df dataframe to_df to_pandas to_csv",
    "plot": "show draw",
    "animate": "animation movie",
    "parameters": "params args x popt values best_values",
    "t": "time times ts",
    "q": "qpos position positions states x",
    "v": "qvel qdot qd velocities",
    "p": "momenta momentum",
    "energy": "E H hamiltonian energies",
    "reactions": "multipliers lambdas forces",
    "rates": "eigenvalues eigs poles",
    "frequencies": "omega omegas freqs",
    "covariance": "cov pcov",
    "errors": "stderr perr standard_errors uncertainties",
}
"""Attributes of this package, and what other tools or other classes call the same."""


def no_attribute(owner: Any, name: str, advice: str = "") -> AttributeError:
    """The exception of an attribute that an object does not have, with this advice if it is given."""
    what = f"{type(owner).__name__} has no attribute {name!r}"
    if advice:
        return AttributeError(f"{what}: {advice}", name=name, obj=None)
    if name.startswith("_"):
        return AttributeError(what)
    known = [public for public in dir(type(owner)) if not public.startswith("_")]
    known += [public for public in getattr(owner, "__dict__", ()) if not public.startswith("_")]
    ours = [word for word, theirs in _ATTRIBUTES.items() if word in known and name in theirs.split()]
    spelled = among(name, known)
    if ours:
        hint = f": it is called {ours[0]}"
    else:
        hint = f" (did you mean {spelled!r}?)" if spelled in known else meant(name, known)
    # Of the class: an attribute of the object may be the one that is missing.
    listed = ", ".join(getattr(type(owner), "parameters", ()))
    if not hint and listed:
        hint = f"; its parameters are {listed}"
    # Python adds a name of its own if it knows the object.
    return AttributeError(what + hint, name=name, obj=None)


def _of_a_result(owner: Any, name: str) -> str:
    return (
        f"{type(owner).__name__}.{name} cannot be assigned, because it is a result: keep another value in a variable "
        "of your own; a copy() of an array can be written"
    )


_Class = TypeVar("_Class", bound=type)


def unassignable(message: Callable[[Any, str], str] = _of_a_result) -> Callable[[_Class], _Class]:
    """A decorator of classes whose public attributes cannot be assigned: AttributeError has this message for an object
    and a name, and a hint for an attribute that they do not have. Their `__init__` writes into `vars(self)`, or is that
    of a frozen dataclass."""

    def decorated(cls: _Class) -> _Class:
        def assign(self: Any, name: str, value: Any) -> None:
            if not name.startswith("_"):
                raise AttributeError(message(self, name), name=name, obj=None)
            object.__setattr__(self, name, value)

        def missing(self: Any, name: str) -> Any:
            if hasattr(type(self), name):
                # A property raised the exception.
                return object.__getattribute__(self, name)
            raise no_attribute(self, name)

        cls.__setattr__ = assign  # type: ignore[method-assign, assignment]
        if not hasattr(cls, "__getattr__"):
            cls.__getattr__ = missing  # type: ignore[attr-defined]
        return cls

    return decorated


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
        setattr(cls, name, _checking(cls.__dict__[name], cls))


_Function = TypeVar("_Function", bound=Callable[..., Any])


def checked_call(function: _Function) -> _Function:
    """The function, which checks the names of its arguments first."""
    return cast("_Function", _checking(function, None))


def _checking(function: Callable[..., Any], cls: type | None) -> Callable[..., Any]:
    parameters = inspect.signature(function).parameters
    takes_any = any(of.kind is of.VAR_KEYWORD for of in parameters.values())
    listed = list(parameters)[0 if cls is None else 1 :]
    known = frozenset(listed)
    positional = [name for name, of in parameters.items() if of.kind is of.POSITIONAL_OR_KEYWORD]
    most = math.inf if any(of.kind is of.VAR_POSITIONAL for of in parameters.values()) else len(positional)
    title = function.__name__ if cls is None or function.__name__ != "__init__" else cls.__name__

    @functools.wraps(function)
    def checked(*arguments: Any, **options: Any) -> Any:
        if cls is not None and not (arguments and isinstance(arguments[0], cls)):
            raise TypeError(
                f"{title} needs a system, not its class: write the parentheses, as in "
                f"vi.Pendulum().{title}(…), with parameters between them"
            )
        if not takes_any and not options.keys() <= known:
            wrong = next(name for name in options if name not in known)
            raise TypeError(_unknown(title, wrong, listed, None if cls is None else arguments[0]))
        if len(arguments) > most:
            by_place = " and ".join(positional[0 if cls is None else 1 :]) or "no arguments"
            named = ", ".join(f"{name}=…" for name in listed if name not in positional)
            if takes_any:
                parameters_of = getattr(getattr(arguments[0], "_cls", arguments[0]), "parameters", ())
                named = f"them by name, such as {next(iter(parameters_of), 'k')}=…"
            by_name = f": write {named}" if named else ""
            raise TypeError(f"{title} takes {by_place} by position{by_name}")
        return function(*arguments, **options)

    return checked


def _unknown(method: str, wrong: str, known: list[str], owner: Any) -> str:
    """The message of an argument that a method does not have."""
    what = f"{method} has no argument {wrong!r}"
    ours = wrong if wrong in _OF_A_RUN else _WORDS.get(wrong, "")
    cls = getattr(owner, "_cls", type(owner))
    if (found := among(wrong, getattr(cls, "coordinates", ()))) in getattr(cls, "coordinates", ()) and "q" in known:
        return f"{what}: {found} is a coordinate, write q=[…] in the order {', '.join(cls.coordinates)}"
    if wrong in getattr(owner, "parameters", ()) and method == "ensemble":
        return f'{what}: {wrong} is a parameter, write parameters={{"{wrong}": …}} with a value for each run'
    if wrong in getattr(owner, "parameters", ()):
        return f"{what}: it is a parameter, write {type(owner).__name__}({wrong}=…).{method}(…)"
    if ours and all(word in known for word in ours.split(" and ")):
        return f"{what}: write {' and '.join(f'{word}=…' for word in ours.split(' and '))}"
    if wrong == "terminal" and method == "Event":
        return f"{what}: run.next_event(event, until) stops the run there, run.events(event, until) goes on"
    if wrong in ("p0", "guess", "initial") and method == "fit":
        return f"{what}: the values of the system, q and v are the first guess"
    if ours == method and method in ("until", "steps", "at"):
        return f"{what}: write {known[0]}=…"
    if ours == "parameters":
        return f"{what}: the parameters belong to the system, as in vi.Pendulum(l=0.5).{method}(…)"
    if ours == "events" and method == "ensemble":
        return f"{what}: write next_event=…, at which each run ends"
    if ours in _OF_A_RUN and method == "integrate":
        return f"{what}: call {_OF_A_RUN[ours]} of the run that it returns"
    if ours == "until" and "steps" in known:
        return f"{what}: it takes a number of steps, those of a time are round(time / run.h)"
    if ours in _OF_A_RUN and ours != method and method in ("until", "steps", "at"):
        return f"{what}: call {_OF_A_RUN[ours]} in its place"
    return f"{what}{meant(wrong, known)}; it has {', '.join(known)}"
