"""Mechanical systems: their parameters and functions, and how runs begin."""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import inspect
import math
import os
import sys
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arrays import Array, array, count, finite, fixed, number, vector
from ._calls import check_arguments, no_attribute
from ._constraints import Projected
from ._control import Equilibrium, Linearization
from ._ensemble import Ensemble, ensemble, states
from ._errors import NotAssembled, Singular, StepError, at_row  # type: ignore[attr-defined]
from ._explanation import Explanation
from ._names import among, meant
from ._request import Request, checked
from ._run import Run
from ._solution import Solution


@functools.lru_cache(maxsize=256)
def _observable(
    definition: str, files: tuple[tuple[str, str], ...], expression: str, wrt: tuple[int, ...] | None, twice: bool
) -> _core.Observable:
    """An expression in the names of the system of a text. Each reading keeps some memory, so there is one."""
    return _core.Observable(definition, list(files), expression, None if wrt is None else list(wrt), twice)


_DECLARE = "declare it with `param`, `const`, `coord`, or an earlier `let`"
"""The advice on an unknown name in a text, which an expression cannot follow."""


class Parameter:
    """A parameter of a system. An array is returned as a copy that cannot be written: assign the whole array."""

    def __init__(self, name: str, start: int, shape: tuple[int, ...], default: Any, about: str):
        self.name, self.start, self.shape, self.default = name, start, shape, default
        self.length = math.prod(shape) if shape else None
        self.__doc__ = about or f"Parameter {name}."

    @property
    def indices(self) -> range:
        """Its places among the numbers of the system."""
        return range(self.start, self.start + (1 if self.length is None else self.length))

    @property
    def entries(self) -> dict[str, int]:
        """Its entries by name, `m[0]` or `K[1][2]`, and their places."""
        names = (self.name + "".join(f"[{i}]" for i in index) for index in np.ndindex(self.shape))
        return dict(zip(names, self.indices, strict=True))

    def entry(self, name: str) -> Parameter:
        """One entry of an array as a parameter of its own. Raises TypeError for another name."""
        entries = self.entries
        if self.length is None:
            raise TypeError(f"{self.name} is one number, which has no entry {name!r}")
        if name not in entries:
            names = list(entries)
            raise TypeError(f"{self.name} has no entry {name!r}: its entries are {names[0]} to {names[-1]}")
        index = entries[name]
        return Parameter(name, index, (), self.default[index - self.start], "")

    def __get__(self, system: System | None, owner: type | None = None) -> Any:
        if system is None:
            return self
        if self.length is None:
            return float(system._values[self.start])
        return fixed(system._values[self.start : self.start + self.length].reshape(self.shape).copy())

    def __set__(self, system: System, value: ArrayLike) -> None:
        system._check_writable(f"{self.name}=…")
        numbers = self.numbers(value)
        system._values[self.start : self.start + len(numbers)] = numbers

    def numbers(self, value: ArrayLike) -> Array:
        """A value of this parameter as an array; one number stands for all entries of an array."""
        if self.length is None:
            return np.array([number(value, self.name)])
        found = array(value, self.name)
        if found.shape not in ((), self.shape, (self.length,)):
            wanted = f"{self.length} entries" if len(self.shape) == 1 else f"the shape {self.shape}"
            raise ValueError(f"{self.name} must have {wanted}, not the shape {found.shape}")
        finite(found, self.name)
        return np.broadcast_to(found.reshape(-1) if found.shape else found, (self.length,))


class SystemType(type):
    """The type of the classes of systems. Their parameters belong to systems, not to the class."""

    def __call__(cls, /, *arguments: Any, **parameters: Any) -> Any:
        if cls is not System:
            if arguments:
                names = ", ".join(f"{name}=…" for name in cls.parameters)
                hint = f": give its parameters by name, {names}" if names else ""
                raise TypeError(f"{cls.__name__} takes no positional arguments{hint}")
            return type.__call__(cls, **parameters)
        from ._text import of_text

        if "methods" in parameters:
            raise TypeError("System has every method; methods=… is an argument of vi.compile")
        if len(arguments) != 1 or parameters:
            raise TypeError("System takes the text of a system alone, System('struct Spring { coord x; L = …; }'); ready ones are in vi.systems")
        return of_text(arguments[0])

    def __setattr__(cls, name: str, value: Any) -> None:
        if name in getattr(cls, "parameters", ()):
            raise AttributeError(f"{name} is a parameter of a system, not of its class: write {cls.__name__}({name}=…)")
        # A class that users derive may have attributes of its own.
        if "_kind" in vars(cls) and not name.startswith("_") and not hasattr(cls, name):
            known = ", ".join(cls.parameters) or "none"
            raise AttributeError(
                f"{cls.__name__} has no attribute {name!r}{meant(name, cls.parameters)}; its parameters are {known}, "
                f"which belong to a system: write {cls.__name__}(…)"
            )
        super().__setattr__(name, value)


class System(metaclass=SystemType):
    """A mechanical system with its parameters: the base of the classes of all systems.

    `System(text)` is the class of the system that a text in the language of `lagrangian!` declares. It takes
    milliseconds, needs no compiler, and has every method. A text with Rust functions needs `compile`.

    >>> Spring = System('''
    ... struct Spring {
    ...     param k = 1.0;
    ...     coord x;
    ...     L = dot(x)^2/2 - k*x^2/2;
    ... }
    ... ''')
    >>> Spring(k=4.0).integrate(q=[1.0], h=0.1).until(10.0).q.shape
    (101, 1)

    Raises CompileError for a mistake, with its line.
    """

    __slots__ = ("_values",)
    __hash__ = None  # type: ignore[assignment]

    _kind: ClassVar[Any] = None
    _defaults: ClassVar[Array]
    _methods: ClassVar[tuple[str, ...]] = ()
    _compiled: ClassVar[Future[type[System]] | None] = None
    coordinates: ClassVar[tuple[str, ...]] = ()
    """Names of the coordinates."""
    angles: ClassVar[tuple[str, ...]] = ()
    """Names of those coordinates that are an `angle`."""
    rotations: ClassVar[tuple[str, ...]] = ()
    """Names of the rotations, with four coordinates each; see `as_rotation` of a solution."""
    constraints: ClassVar[tuple[str, ...]] = ()
    """Names of the constraints, holonomic ones first."""
    dropped: ClassVar[tuple[str, ...]] = ()
    """Names of those constraints that follow from the others and have no reaction; see `independent`."""
    parameters: ClassVar[tuple[str, ...]] = ()
    """Names of the parameters."""
    inputs: ClassVar[tuple[str, ...]] = ()
    """Names of the inputs, the parameters that a controller sets."""
    integrators: ClassVar[tuple[tuple[str, int | None, bool], ...]] = ()
    """Method, stages, and whether in transformed time, of each integrator that is built."""
    definition: ClassVar[str] = ""
    """The text of the declaration, as it was written."""

    def __init__(self, **parameters: Any):
        self._values = self._defaults.copy()
        self.set(**parameters)

    def set(self, **parameters: Any) -> System:
        """Sets parameters, and returns the system. If one is wrong, none is set. `set(**{"m[0]": 2.0})` sets one entry of
        an array."""
        self._check_writable(", ".join(f"{name}=…" for name in parameters))
        changes = [(self._parameter(name), value) for name, value in parameters.items()]
        for parameter, numbers in [(parameter, parameter.numbers(value)) for parameter, value in changes]:
            self._values[parameter.start : parameter.start + len(numbers)] = numbers
        return self

    def __getattr__(self, name: str) -> Any:
        if hasattr(type(self), name):
            # A property raised the exception.
            return object.__getattribute__(self, name)
        raise no_attribute(self, name)

    def __setattr__(self, name: str, value: Any) -> None:
        try:
            object.__setattr__(self, name, value)
        except AttributeError:
            if hasattr(type(self), name):
                raise
            raise no_attribute(self, name) from None

    @classmethod
    def native(cls, *, methods: str | None = None, verbose: bool = False, wait: bool = True) -> type[System]:
        """The same system, compiled by `compile`: its steps are two to five times faster. A compiled class returns
        itself, without `methods`.

        With `wait=False` cargo builds in the background, and the class itself is returned. Runs and ensembles that begin
        when the compiled class is ready are its own, if it has their method: their steps differ by rounding, and their
        `system` is of that class. Which one a run is depends on the time it begins: wait, if results have to be the same
        bit for bit."""
        if not hasattr(cls, "_text") and methods is None:
            return cls
        from ._compile import compile

        definition = cls._to_compile()
        if wait or not hasattr(cls, "_text"):
            return compile(definition, methods=methods, verbose=verbose)
        if cls._compiled is None:
            cls._compiled = Future()
            build = functools.partial(compile, definition, methods=methods, verbose=verbose)
            threading.Thread(target=_build, args=(cls._compiled, build, cls.__name__), daemon=True).start()
        return cls

    @classmethod
    def _to_compile(cls) -> str:
        """The definition, if cargo makes the same system of it. Raises CompileError."""
        from ._compile import CompileError
        from ._text import files_of

        _, _, _, files, dropped = getattr(cls, "_text", (None, None, None, (), ()))
        if dropped:
            left_out = ", ".join(dropped)
            raise CompileError(f"{cls.__name__} is without {left_out}: delete these from its text to compile it")
        for path, _ in set(files) - set(files_of(cls.definition)):
            raise CompileError(f"the file {path} of a table changed or is missing: make the system again from its text")
        return cls.definition

    def _for(self, request: Request) -> System:
        """The system that takes the steps of a run: a compiled one, if it is ready and has the method."""
        building = self._compiled
        if building is None or not building.done() or building.exception() is not None:
            return self
        compiled = building.result()
        is_built = self._kind.integrator(request) in compiled.integrators
        return compiled._of(self._values) if is_built else self

    @classmethod
    def _parameter(cls, name: str) -> Parameter:
        """The parameter of this name, or the entry of an array."""
        if not isinstance(name, str):
            raise TypeError(f"the name of a parameter must be a text, not {name!r}")
        whole, bracket, index = name.partition("[")
        whole = among(whole, cls.parameters)
        if (coordinate := among(name, cls.coordinates)) in cls.coordinates and whole not in cls.parameters:
            raise TypeError(
                f"{coordinate} is a coordinate, not a parameter: a run sets it, integrate(q=…) or set_state(q=…)"
            )
        if whole not in cls.parameters:
            known = ", ".join(cls.parameters) or "none"
            raise TypeError(f"{cls.__name__} has no parameter {name!r}{meant(whole, cls.parameters)}; it has {known}")
        parameter: Parameter = getattr(cls, whole)
        return parameter.entry(whole + bracket + index) if bracket else parameter

    def __repr__(self) -> str:
        values = (f"{name}={_shown(getattr(self, name))}" for name in self.parameters)
        dropped = f" without {', '.join(self.dropped)}" if self.dropped else ""
        return f"{type(self).__name__}({', '.join(values)}){dropped}"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, System):
            return NotImplemented
        return type(self) is type(other) and np.array_equal(self._values, other._values)

    def __copy__(self) -> System:
        return type(self)._of(self._values)

    def __deepcopy__(self, memo: Any) -> System:
        return self.__copy__()

    def copy(self) -> System:
        """A system with the same parameters."""
        return self.__copy__()

    def __reduce__(self) -> Any:
        # Classes of texts are pickled with their text; a compiled one is compiled again if it is not in the cache.
        return (_unpickled, (type(self), self.definition, self._values.tolist()))

    def _fixed(self) -> System:
        """The system, whose parameters can no longer be set: the system of a run, or of its rows."""
        fixed(self._values)
        return self

    def _check_writable(self, change: str) -> None:
        """Raises AttributeError for the system of a run or of its rows, on which a change has no effect."""
        if change and not self._values.flags.writeable:
            raise AttributeError(
                f"this system belongs to a run or to its rows, and cannot be changed: run.set({change}) changes the "
                "run from here on, and copy() returns a system of your own"
            )

    @classmethod
    def _of(cls, values: ArrayLike) -> System:
        """The system with these numbers."""
        system = cls.__new__(cls)
        system._values = np.array(values, dtype=np.float64)
        return system

    def lagrangian(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Any:
        """L(t, q, v). q and v have the shape (..., N); leading axes broadcast."""
        return self._at("lagrangian", t, q, v)

    def energy(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Any:
        """The energy v·∂L/∂v − L at (t, q, v)."""
        return self._at("energy", t, q, v)

    def momentum(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """The momenta p = ∂L/∂v at (t, q, v)."""
        return self._at("momentum", t, q, v, self._shape)

    def velocity(self, t: ArrayLike, q: ArrayLike, p: ArrayLike) -> Array:
        """The velocities of the momenta p at (t, q)."""
        return self._at("velocity", t, q, p, self._shape, "p")

    def force(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """The generalized force at (t, q, v)."""
        return self._at("force", t, q, v, self._shape)

    def acceleration(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """The acceleration at (t, q, v). Raises InconsistentStart if (t, q, v) is off the constraints."""
        return self._at("acceleration", t, q, v, self._shape)

    def evaluate(
        self, expression: str, t: ArrayLike | Solution, q: ArrayLike | None = None, v: ArrayLike | None = None
    ) -> Any:
        """An expression of the language at (t, q, v), or along a solution, in the names of the system: its coordinates,
        parameters, `let`s, functions and tables.

        >>> system.evaluate("m * l^2 * dot(θ)", 0.0, [0.3], [1.0])
        >>> system.evaluate("m * l^2 * dot(θ)", sol)

        A vector or a matrix has its axes last. `sol["m * l^2 * dot(θ)"]` is the same with the parameters of the run.
        Raises ValueError for a mistake, with its place.
        """
        if isinstance(t, Solution) and q is None and v is None:
            t, q, v = t.t, t.q, t.v
        if q is None or v is None:
            raise TypeError("evaluate needs t, q and v, or a solution")
        return self._evaluated(expression, *self._points(t, q, v), self._values[None])

    def reaction(self, t: ArrayLike, q: ArrayLike, p: ArrayLike) -> Array:
        """The multiplier Λ of each constraint at (t, q, p), of shape (..., K) in the order of `constraints`."""
        return self._at("reaction", t, q, p, (len(self.constraints),), "p")

    def reaction_force(self, t: ArrayLike, q: ArrayLike, p: ArrayLike) -> Array:
        """The generalized force of all constraints on the coordinates at (t, q, p)."""
        return self._at("reaction_force", t, q, p, self._shape, "p")

    def residuals(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """How far (t, q, v) is off the constraints: g and A v + a of each, of shape (..., 2, K). g of a constraint on
        velocities is 0."""
        return self._at("residuals", t, q, v, (2, len(self.constraints)))

    def project(self, q: ArrayLike, v: ArrayLike | None = None, *, t: float = 0.0) -> Projected:
        """The state on the constraints nearest to (t, q, v) in the metric of the mass matrix, and how far it is.

        q and v of the shape (M, N) are many states.

        Raises NotAssembled if no coordinates are found that satisfy the constraints, Singular if the constraints depend on
        each other on the way. From a far guess it may find another assembly than `assemble`.
        """
        return self._moved(q, v, t, False)

    def assemble(self, q: ArrayLike, v: ArrayLike | None = None, *, t: float = 0.0) -> Projected:
        """A state on the constraints from a far guess (t, q, v), for example of a loop that is not closed, and how far
        it is: that of `project` if there is one, otherwise by a continuation in which all residuals shrink together.

        A linkage may have several assemblies. The guess chooses one, which is not always the nearest. Raises
        NotAssembled with the constraint that stays open, Singular if the constraints depend on each other at the guess.
        """
        return self._moved(q, v, t, True)

    def redundant(self, q: ArrayLike, *, t: float = 0.0) -> tuple[str, ...]:
        """The names of the constraints that follow from the others at coordinates q, which satisfy all of them.

        A run does not start from such a place, because the reactions are not unique: `independent` returns a system
        that does. Raises InconsistentStart for q off the constraints, since other constraints are redundant there:
        `project` moves it.
        """
        q = vector(q, len(self.coordinates), "q", self.coordinates)
        return tuple(self._kind.redundant(self._values, number(t, "t"), q))

    def independent(self, q: ArrayLike, *, t: float = 0.0) -> System:
        """The same system without the constraints that `redundant` names at coordinates q, which satisfy all of them.

        Its motion is the same. Its attribute `dropped` has their names, which `constraints` lists too: they have the
        reaction 0, and every step checks that they hold. DroppedConstraint is raised if they do not follow from the
        others any more, and Singular if the others become dependent: then another subset may be independent.
        InconsistentStart is raised for q off the constraints: `project` moves it. A compiled system becomes one of its
        text.
        """
        dropped = self.redundant(q, t=t)
        if not dropped:
            return self.copy()
        return self._as_text(dropped)

    def _as_text(self, dropped: tuple[str, ...] = ()) -> System:
        """The system of its text, without these constraints."""
        from ._text import of_text

        definition, files = self._read()
        return of_text(definition, files=files, dropped=dropped)._of(self._values)

    def _moved(self, q: ArrayLike, v: ArrayLike | None, t: float, is_far: bool) -> Projected:
        (n,), names, t = self._shape, self.coordinates, number(t, "t")
        v = np.zeros(n) if v is None else v
        if np.ndim(q) == np.ndim(v) == 1:
            q, v = vector(q, n, "q", names), vector(v, n, "v", names)
            try:
                return Projected(*self._kind.project(self._values, t, q, v, is_far))
            except (NotAssembled, Singular):
                if hasattr(type(self), "_text"):
                    raise
                from ._compile import CompileError

                # A compiled system keeps redundant constraints; one with Rust functions has no text alone.
                with contextlib.suppress(CompileError):
                    return self._as_text()._moved(q, v, t, is_far)
                raise
        rows = np.broadcast_arrays(states(q, "q", type(self)), states(v, "v", type(self)))
        found = np.empty((len(rows[0]), 4, n))
        for index, row in enumerate(zip(*rows, strict=True)):
            try:
                found[index] = self._moved(*row, t, is_far)
            except StepError as error:
                raise at_row(error, f"state {index}") from None
        return Projected(*(np.ascontiguousarray(column) for column in found.transpose(1, 0, 2)))

    def mass_matrix(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """The mass matrix M = ∂²L/∂v² at (t, q, v): (..., N, N)."""
        return self._at("mass_matrix", t, q, v, (len(self.coordinates),) * 2)

    def bias(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """The bias b at (t, q, v): along the motion M a + b is 0, or the force of the constraints. Inputs have the
        values that are set."""
        return self._at("bias", t, q, v, self._shape)

    def inverse_dynamics(self, t: ArrayLike, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
        """The force M a + b that has to be added for the acceleration a at (t, q, v)."""
        a = array(a, "a")
        if a.shape[-1:] != self._shape:
            raise ValueError(f"the last axis of a must have length {self._shape[0]}, not the shape {a.shape}")
        return (self.mass_matrix(t, q, v) @ a[..., None])[..., 0] + self.bias(t, q, v)

    def linearization(self, t: float, q: ArrayLike, v: ArrayLike) -> Linearization:
        """The linearization of (q, v) at (t, q, v): derivatives of its rate of change with respect to the state and the
        inputs, exact to rounding. Raises InconsistentStart if (t, q, v) is off the constraints."""
        (n,), names, t = self._shape, self.coordinates, number(t, "t")
        found = self._kind.linearization(self._values, t, vector(q, n, "q", names), vector(v, n, "v", names))
        return Linearization(t, *found)

    def equilibrium(self, guess: ArrayLike, t: float = 0.0) -> Equilibrium:
        """The equilibrium near a guess of the coordinates, with its matrices and frequencies.

        With constraints the guess may be off them. Raises NoEquilibrium if there is none near the guess, FreeMotion if
        equilibria form a family, with constraints Singular.
        """
        t = number(t, "t")
        (q, multipliers), matrices, free, residual, rates = self._kind.equilibrium(
            self._values, t, vector(guess, self._shape[0], "guess", self.coordinates)
        )
        rates = np.array(rates)
        return Equilibrium(t, q, multipliers, *matrices, tuple(free), residual, rates[:, 0] + 1j * rates[:, 1])

    def rhs(self, t: float, y: ArrayLike) -> Array:
        """dy/dt of y = (q, v), for `scipy.integrate.solve_ivp`. y has the shape (2N,) or (2N, K), and may be off the
        constraints, which the stages of a solver leave."""
        n = len(self.coordinates)
        y = array(y, "y")
        if y.shape[:1] != (2 * n,):
            raise ValueError(f"y must have {2 * n} entries, q and v, not the shape {y.shape}")
        acceleration = self._at("extended_acceleration", t, y[:n].T, y[n:].T, self._shape)
        return np.concatenate([y[n:], acceleration.T])

    @property
    def _shape(self) -> tuple[int, ...]:
        """The shape of a vector."""
        return (len(self.coordinates),)

    def _at(
        self, of: str, t: ArrayLike, q: ArrayLike, v: ArrayLike, each: tuple[int, ...] = (), second: str = "v"
    ) -> Any:
        """A function at points, of this shape at each."""
        shape, points = self._points(t, q, v, second)
        try:
            out = self._kind.evaluate(self._values, of, *points)
        except StepError as error:
            raise self._first_failure(of, points, shape) or error from None
        shape += each
        return out.reshape(shape) if shape else float(out[0])

    def _points(
        self, t: ArrayLike, q: ArrayLike, v: ArrayLike, second: str = "v"
    ) -> tuple[tuple[int, ...], tuple[Array, Array, Array]]:
        """The common shape of points, and their times, coordinates and velocities one after the other."""
        n = len(self.coordinates)
        t, q, v = array(t, "t"), array(q, "q"), array(v, second)
        for x, name in ((q, "q"), (v, second)):
            if x.shape[-1:] != (n,):
                names = ", ".join(self.coordinates)
                raise ValueError(f"the last axis of {name} must have length {n} ({names}), not the shape {x.shape}")
        if t.ndim == 0 and q.ndim == 1 and v.ndim == 1:
            return (), (t.reshape(1), np.ascontiguousarray(q)[None], np.ascontiguousarray(v)[None])
        try:
            shape = np.broadcast_shapes(t.shape, q.shape[:-1], v.shape[:-1])
        except ValueError:
            raise ValueError(
                f"t, q and {second} do not broadcast: their shapes are {t.shape}, {q.shape} and {v.shape}"
            ) from None
        times = np.ascontiguousarray(np.broadcast_to(t, shape)).reshape(-1)
        qs, vs = (np.ascontiguousarray(np.broadcast_to(x, (*shape, n))).reshape(-1, n) for x in (q, v))
        return shape, (times, qs, vs)

    def _evaluated(
        self, expression: str, shape: tuple[int, ...], points: tuple[Array, Array, Array], values: Array
    ) -> Any:
        """An expression at points, with the numbers of the system at each of them, or at all."""
        observable = self._observable(expression)
        t, q, v = (numbers.tolist() for numbers in points)
        found = observable.values((t, q, v), values.tolist())
        shape += tuple(observable.shape)
        return np.array(found).reshape(shape) if shape else found[0]

    @classmethod
    def _observable(cls, expression: str, wrt: list[int] | None = None, twice: bool = False) -> _core.Observable:
        """An expression in the names of the system, or its first or second derivatives with respect to t, q, v and the
        parameters of these indices. Raises ValueError for a mistake, with its place."""
        if not isinstance(expression, str):
            raise TypeError(f"an expression is a text, such as 'm * x^2', not {expression!r}")
        try:
            return _observable(*cls._read(), expression, None if wrt is None else tuple(wrt), twice)
        except ValueError as error:
            names = ", ".join([*cls.coordinates, *cls.parameters])
            help = f"the names are {names}, those of the `let`s and functions of the text, `t` and `pi`"
            raise ValueError(str(error).replace(_DECLARE, help)) from None

    @classmethod
    def _read(cls) -> tuple[str, tuple[tuple[str, str], ...]]:
        """The text, with the paths and the texts of the files of its tables."""
        from ._text import files_of

        own: Any = getattr(cls, "_text", None)
        return (own[0], own[3]) if own else (cls.definition, files_of(cls.definition))

    def _first_failure(self, of: str, points: tuple[Array, ...], shape: tuple[int, ...]) -> StepError | None:
        """The exception of the first of many points without a value, which names it; None for a single point."""
        for index in np.ndindex(shape) if shape else ():
            place = int(np.ravel_multi_index(index, shape))
            try:
                self._kind.evaluate(self._values, of, *(values[place : place + 1] for values in points))
            except StepError as error:
                return at_row(error, f"state {index[0] if len(index) == 1 else index}")
        return None

    def integrate(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        *,
        p: ArrayLike | None = None,
        t: float = 0.0,
        h: float | None = None,
        tolerance: float | None = None,
        dtau: float | None = None,
        method: str | None = None,
        stages: int | None = None,
        shift: float | None = None,
        shift_from: float | None = None,
        fallback: bool = False,
    ) -> Run:
        """Starts a run at (t, q, v), or at (t, q, p) with momenta p. Without both it starts at rest.

        Parameters
        ----------
        h : float
            Length of a step; negative steps go back in time. For method="energy" about that of the first step,
            for "adaptive" that of the first step.
        tolerance : float
            In place of h: the largest error of a step, relative to the scale of its motion.
        dtau : float
            In place of h: length of a step in transformed time, for a system with a `time_scale`.
        method : str
            "gauss", the default; "adaptive", Gauss steps whose length follows the forces along the motion; "fixed",
            "suzuki-4", "kahan-li-6", "kahan-li-8" or "energy"; "splitting-4" or "splitting-6" if the mass matrix is
            constant and no force depends on velocities. A system with constraints has "gauss", "adaptive" and "energy".
        stages : int
            Stages of Gauss steps, whose order is twice that number, also with constraints; of energy-preserving steps.
        shift, shift_from : float
            The shift of the step density of energy-preserving steps, or the duration over which it is measured.
        fallback : bool
            Whether to take fixed steps if no energy-preserving step exists.
        """
        n = len(self.coordinates)
        request = checked(type(self), h, tolerance, dtau, method, stages, shift, shift_from, fallback)
        if v is not None and p is not None:
            raise TypeError("give one of v and p, not both")
        q = vector(q, n, "q", self.coordinates)
        v = None if v is None else vector(v, n, "v", self.coordinates)
        p = None if p is None else vector(p, n, "p", self.coordinates)
        if p is None and v is None:
            v = np.zeros(n)
        if request.shift_from is not None and request.tolerance is not None:
            # The length first: the measurement of a shift takes as many steps as its duration has.
            plain = dataclasses.replace(request, shift_from=None)
            h = self._kind.begin(self._values, plain, number(t, "t"), q, v, p).h
            request = checked(type(self), h, None, None, method, stages, None, shift_from, fallback)
        system = self._for(request)
        return Run(type(system), system._kind.begin(system._values, request, number(t, "t"), q, v, p))

    def fmu(
        self,
        path: str | os.PathLike[str],
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        *,
        t: float = 0.0,
        h: float | None = None,
        tolerance: float | None = None,
        dtau: float | None = None,
        method: str | None = None,
        stages: int | None = None,
        shift: float | None = None,
        shift_from: float | None = None,
        fallback: bool = False,
        verbose: bool = False,
    ) -> Path:
        """Writes the system with its run as an FMU, a co-simulation unit of FMI 3.0, for Simulink, FMPy and other
        tools. Returns the path.

        The options are those of `integrate`; q and v are zero if they are not given. The unit has the parameters and
        inputs of the system with their present values, `x(0)` and `dot(x)(0)` as initial coordinates and velocities,
        and the outputs `x`, `dot(x)`, `p_x`, `Λ_c` for a constraint c, and `energy`. A communication step is a call of
        `until`: steps of h, of which the last is shortened to its end. Inputs and parameters change between them.

        It needs cargo, as `compile`. The unit runs on the platform where it was built.

        Raises CompileError.
        """
        from ._fmu import write

        request = checked(type(self), h, tolerance, dtau, method, stages, shift, shift_from, fallback)
        n = len(self.coordinates)
        q = np.zeros(n) if q is None else vector(q, n, "q", self.coordinates)
        v = np.zeros(n) if v is None else vector(v, n, "v", self.coordinates)
        return write(self, Path(path), request, number(t, "t"), q, v, verbose)

    def ensemble(
        self,
        q: ArrayLike,
        v: ArrayLike | None = None,
        *,
        until: float | None = None,
        times: ArrayLike | None = None,
        next_event: Any = None,
        t: float = 0.0,
        h: float | None = None,
        tolerance: float | None = None,
        dtau: float | None = None,
        method: str | None = None,
        stages: int | None = None,
        shift: float | None = None,
        shift_from: float | None = None,
        fallback: bool = False,
        parameters: Mapping[str, ArrayLike] | None = None,
        threads: int | None = None,
    ) -> Ensemble:
        """Many runs on all cores, with the options of `integrate`.

        q and v have the shape (M, N), or (N,) for all runs; `parameters={"l": lengths}` has a value (M,) for each.
        Returns the states at the time `until`, of shape (M, N), or at K times, of shape (M, K, N). With `next_event`, the
        events of `run.next_event`, each run ends at the first of them, whose index is in `which`, or at `until`. A failed
        run has NaN from there on, and its exception in `errors`.
        """
        request = checked(type(self), h, tolerance, dtau, method, stages, shift, shift_from, fallback)
        return ensemble(self, request, q, v, until, times, next_event, number(t, "t"), parameters or {}, threads)

    def explain(self, stages: int | None = None) -> Explanation:
        """The mathematics of the system: L, the discrete Lagrangian, the equations of a step. With stages, those of a
        Gauss step."""
        return Explanation(*_core.explain(self.definition, None if stages is None else count(stages, "stages", 1)))

    def _repr_latex_(self) -> str:
        return self.explain().equations()


check_arguments(System, [name for name, of in vars(System).items() if inspect.isfunction(of) and name[0] != "_"])


def _unpickled(cls: type[System], definition: str, values: list[float]) -> System:
    if cls.definition != definition:
        raise ValueError(f"{cls.__name__} had another definition when it was pickled")
    return cls._of(values)


def _shown(value: Any) -> str:
    return f"{value:g}" if np.ndim(value) == 0 else np.array2string(np.asarray(value), separator=", ")


def _build(building: Future[type[System]], build: Callable[[], type[System]], name: str) -> None:
    """Builds a class in the background. Without it, runs go on by the text."""
    try:
        building.set_result(build())
    except BaseException as error:  # noqa: BLE001 # the future reports it
        building.set_exception(error)
        print(f"variational: {name} was not compiled, and runs by its text: {error}", file=sys.stderr, flush=True)
