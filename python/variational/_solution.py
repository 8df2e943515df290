"""The rows of a run."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._animation import animated
from ._arrays import Array, array, count, finite, fixed
from ._calls import check_arguments, no_attribute, unassignable
from ._names import among, unknowns
from ._observed import observed

if TYPE_CHECKING:
    from ._errors import StepError
    from ._events import Event
    from ._run import Run
    from ._system import System


_SMOOTH = 2000
"""Points of a plot with dense output."""


@unassignable()
class ByName:
    """Rows whose coordinates and velocities have names."""

    system: System
    t: Array
    q: Array
    v: Any
    _values: Array | None
    """The numbers of the system from each row on, or of each run; None if they are those of `system`."""

    def __getitem__(self, name: str) -> Array:
        """A coordinate, `sol["x"]`, its velocity, `sol["dot(x)"]`, its momentum, `sol["p_x"]`, the value of a parameter
        or an input from each row on, `sol["k"]`, or an expression of the language, such as a `let` or
        `sol["k * x^2 / 2"]`."""
        coordinates, constraints = self.system.coordinates, self.system.constraints
        if not isinstance(name, str):
            raise TypeError(
                f'give the name of a coordinate, such as ["{coordinates[0]}"], not {name!r}: rows are those of the '
                "arrays, such as .q[0]"
            )
        if name not in coordinates:
            whole, _, rest = name.partition("[")
            # Behind an entry an expression goes on.
            is_entry = re.fullmatch(r"[\d\]\[\s]*", rest) is not None
            if is_entry and among(whole, self.system.parameters) in self.system.parameters:
                return self._of_parameter(self.system._parameter(name))
            # The quaternions of a rotation have the name of its constraint.
            if (constraint := name.removeprefix("Λ_")) in constraints and f"{name}[0]" not in coordinates:
                column = constraints.index(constraint)
                raise KeyError(f"{constraint} is a constraint: its reaction is reactions[..., {column}]")
            if name in ("t", "q", "v", "p", "energy", "reactions"):
                raise KeyError(f"{name!r} is no coordinate: it is the attribute .{name}")
        of = observed(name, type(self.system))
        if of.place is not None:
            column, index = divmod(of.place, len(coordinates))
            return (self.q, self.v, self.p)[column][..., index]
        if self._values is None:
            values = self.system._values[None]
        else:
            values = np.repeat(self._values, self.t.size // max(len(self._values), 1), axis=0)
        points = self.system._points(self.t, self.q, self._velocities_from_here())
        return fixed(self.system._evaluated(name, *points, values))

    def as_rotation(self, name: str) -> Any:
        """The orientations of a body as a `scipy.spatial.transform.Rotation`, one for each row. They turn vectors of the
        body into space.

        >>> angles = sol.as_rotation("R").as_euler("ZXZ")

        Needs scipy. Raises ValueError if the system has no rotation of this name; its `rotations` are their names.
        """
        try:
            from scipy.spatial.transform import Rotation
        except ImportError:
            raise ImportError("as_rotation needs scipy: pip install scipy") from None
        known = self.system.rotations
        if name not in known:
            names = ", ".join(f'"{of}"' for of in known)
            raise ValueError(f"name one of the rotations, {names}, not {name!r}" if known else "there is no rotation")
        # The scalar is first here, and last in scipy.
        return Rotation.from_quat(np.roll(self[name], -1, axis=-1))

    def _velocities_from_here(self) -> Array:
        """The velocities from each row on: where a parameter changes, that of the momenta by its new value. `v` has
        those before the change."""
        values = self._values
        if values is None or len(values) != self.t.size or self.t.ndim != 1:
            return self.v
        changed = 1 + np.flatnonzero((values[1:] != values[:-1]).any(axis=1))
        if not len(changed):
            return self.v
        v, system = self.v.copy(), type(self.system)
        for row in changed:
            v[row] = system._of(values[row]).velocity(self.t[row], self.q[row], self.p[row])
        return v

    def _of_parameter(self, parameter: Any) -> Array:
        """The values of a parameter, with the axes of the rows first."""
        values = self.system._values[None] if self._values is None else self._values
        found = values[:, parameter.indices].reshape(-1, *[1] * (self.t.ndim - 1), *parameter.shape)
        return fixed(np.broadcast_to(found, (*self.t.shape, *parameter.shape)))

    def __getattr__(self, name: str) -> Any:
        if hasattr(type(self), name):
            # A property raised the exception.
            return object.__getattribute__(self, name)
        # An object that is being unpickled has no system.
        names = self.__dict__["system"].coordinates if "system" in self.__dict__ else ()
        if (found := among(name, names)) in names:
            raise no_attribute(self, name, f'the coordinate is ["{found}"], its velocity ["dot({found})"]')
        raise no_attribute(self, name)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        # A pickle does not keep which arrays are writable.
        self.system._fixed()
        for values in self.__dict__.values():
            if isinstance(values, np.ndarray):
                fixed(values)

    def __iter__(self) -> NoReturn:
        # `sol["x"]` would otherwise make the rows a sequence of their names.
        raise TypeError("rows are in the arrays .t, .q and .v: write t, q = sol.t, sol.q, or zip(sol.t, sol.q)")


def columns_of(rows: Any) -> Iterator[tuple[str, Array]]:
    """The columns of a table of these rows: t, q, dot(q), p_q, Λ of each constraint, energy, and inputs."""
    yield "t", rows.t
    for label, values in (("{}", rows.q), ("dot({})", rows.v), ("p_{}", rows.p)):
        for index, name in enumerate(rows.system.coordinates):
            yield label.format(name), values[..., index]
    for index, name in enumerate(rows.system.constraints):
        yield f"Λ_{name}", rows.reactions[..., index]
    yield "energy", rows.energy
    for name in rows.system.inputs:
        for entry in rows.system._parameter(name).entries:
            yield entry, rows[entry]


def two_axes(axes: Any) -> Any:
    """The axes of a plot: the given ones, or those of a new figure."""
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise ImportError("plot needs matplotlib: pip install matplotlib") from None
    if axes is None:
        return plt.subplots(2, 1, sharex=True, layout="constrained")[1]
    if len(np.atleast_1d(np.asarray(axes, dtype=object))) != 2:
        raise TypeError(
            f"axes must be two axes of matplotlib, not {axes!r}: draw one coordinate by plot(sol.t, sol[…])"
        )
    return axes


class Solution(ByName):
    """The rows of a run: `t` (K,), `q`, `p`, `v` (K, N), `energy` (K,), and for C constraints `reactions` (K, C).

    `sol["x"]` and `sol["dot(x)"]` are the values of a coordinate and of its velocity, and `sol["u"]` of an input or a
    parameter: that of the steps from each row on, which a callback may change. `sol["m * x^2"]` is the value of an
    expression of the language, also of a `let`. Names and shapes of
    `scipy.integrate.solve_ivp` are there too: `y` = (q, v) of shape (2N, K), `success`, `status`, `message`, and with
    `dense=True` the call `sol(t)`. The arrays cannot be written: velocities and energies follow from q and p.
    """

    p: Array
    error: StepError | None

    def __init__(
        self,
        system: System,
        t: Array,
        q: Array,
        p: Array,
        error: StepError | None = None,
        dense: Any = None,
        again: Callable[[], tuple[Any, Any, Any]] | None = None,
    ):
        vars(self).update(system=system, t=fixed(t), q=fixed(q), p=fixed(p), error=error)
        self._values = None
        self._dense = dense
        self._again = again
        self._start: Run | None = None

    @cached_property
    def v(self) -> Array:
        """Velocities."""
        return fixed(self.system.velocity(self.t, self.q, self.p))

    @cached_property
    def energy(self) -> Array:
        """The energy H."""
        return fixed(np.asarray(self.system._at("hamiltonian", self.t, self.q, self.p, second="p")))

    @cached_property
    def reactions(self) -> Array:
        """The multiplier Λ of each constraint, (K, C) in the order of `system.constraints`."""
        return fixed(self.system.reaction(self.t, self.q, self.p))

    @property
    def residual(self) -> Array:
        """The largest |g| and |A v + a| of the constraints in each row, (K,); zero without constraints."""
        found = np.abs(self.system.residuals(self.t, self.q, self.v))
        return found.max(axis=(-2, -1), initial=0.0)

    @property
    def y(self) -> Array:
        """(q, v), of shape (2N, K) as in scipy."""
        return fixed(np.concatenate([self.q, self.v], axis=-1).T)

    @property
    def success(self) -> bool:
        """Whether the run reached its end."""
        return self.error is None

    @property
    def status(self) -> int:
        """0 if the run reached its end, otherwise -1."""
        return 0 if self.success else -1

    @property
    def message(self) -> str:
        """Why the run ended."""
        return "The run reached its end." if self.error is None else str(self.error)

    @property
    def sol(self) -> Solution | None:
        """The solution itself if it has dense output: scipy's name."""
        return None if self._dense is None and self._again is None else self

    def __call__(self, t: ArrayLike) -> Array:
        """(q, v) at times between the first and the last row: shape (2N,) at one time, (2N, K) at K times."""
        q, _, v = self.states(t)
        return np.concatenate([q, v], axis=-1).T

    def states(self, t: ArrayLike) -> tuple[Array, Array, Array]:
        """q, p and v at times between the first and the last row, by dense output: shape (N,) or (K, N)."""
        if self._dense is None:
            self._dense = self._repeated()
        times = array(t, "t")
        finite(times, "t")
        if times.ndim > 1:
            raise ValueError(f"t must be one time or a list of times, not of shape {times.shape}")
        first, last = sorted((self.t[0], self.t[-1]))
        if times.size and (times.min() < first or times.max() > last):
            outside = float(np.ravel(times)[np.ravel((times < first) | (times > last))][0])
            raise ValueError(f"t = {outside!r} is outside of the solution, from {float(first)!r} to {float(last)!r}")
        if len(self._dense) == 0:
            # A run that took no step.
            q, p, v = (np.repeat(of[:1], times.size, axis=0) for of in (self.q, self.p, self.v))
        else:
            q, p, v = self._dense(np.ascontiguousarray(times.reshape(-1)))
        return (q, p, v) if times.ndim else (q[0], p[0], v[0])

    def _repeated(self) -> Any:
        """The dense output of an unpickled solution, from the same steps."""
        if self._again is None:
            raise ValueError("this solution has no dense output: call until or steps with dense=True")
        rows, _, dense = self._again()
        if not all(map(np.array_equal, rows, (self.t, self.q, self.p))):
            raise ValueError(
                "the dense output of this solution cannot be restored: its steps round differently on this machine; "
                "evaluate it before it is pickled, or run it here"
            )
        return dense

    def jacobian(self, wrt: str | Iterable[str], of: str | Sequence[str] | None = None) -> Array:
        """The derivatives of coordinates and velocities at the times of the rows, which do not vary, exact to rounding.

        wrt names parameters "k", entries "m[0]" and start values "x", "dot(x)"; an array has a column for each entry.
        `of` names a coordinate "x", a velocity "dot(x)", a momentum "p_x", or an expression of the language; by default
        they are all coordinates, then all velocities. The shape is (K, U) for one of them, with the axes of a vector or
        a matrix before the last, and (K, C, U) for several numbers. Velocities of the start are constant when a
        parameter changes. With constraints the start is the nearest state on them.

        Raises ValueError if the solution has no run: those with a callback, of events, and unpickled ones.
        """
        if self._start is None:
            at_events = "; run.tangent(until=t, event=…) has those at an event" if isinstance(self, Events) else ""
            raise ValueError(
                "derivatives need a solution of until, steps or at, without a callback and not unpickled: take it again"
                + at_events
            )
        cls, size = type(self.system), 2 * len(self.system.coordinates)
        varied = unknowns(wrt, cls)
        indices = [index for is_start, index in varied.values() if not is_start]
        parameters = iter(range(size, size + len(indices)))
        chosen = [index if is_start else next(parameters) for is_start, index in varied.values()]
        found = [observed(name, cls) for name in ([of] if isinstance(of, str) else of or ())]
        changes = self._start._tangents_at(indices, self.t)
        if of is None:
            return changes[..., chosen]
        if any(quantity.place is not None and quantity.place >= size for quantity in found):
            of_p = self._start._tangents_at(indices, self.t, False)[:, size // 2 :]
        else:
            of_p = np.zeros((len(self), size // 2, changes.shape[-1]))
        changes = np.concatenate([changes, of_p], axis=1)
        states = np.concatenate([self.q, self.v, self.p], axis=1)
        columns = []
        for quantity in found:
            if quantity.shape and not isinstance(of, str):
                raise ValueError(
                    f"{quantity.text!r} has the shape {quantity.shape}: ask for it alone, or for its entries"
                )
            numbers = self.system._values[None]
            _, of_states, of_parameters = quantity.slopes(self.system, self.t, states, numbers, indices)
            column = np.einsum("k...s,ksd->k...d", of_states, changes)
            column[..., size:] += of_parameters
            columns.append(column[..., chosen])
        return columns[0] if isinstance(of, str) else np.stack(columns, axis=1)

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        name = type(self).__name__
        if not len(self):
            return f"<{name} of {self.system!r}: no rows>"
        failed = "" if self.error is None else f", ended by {type(self.error).__name__}"
        rows = "1 row" if len(self) == 1 else f"{len(self)} rows"
        return f"<{name} of {self.system!r}: {rows}, t = {self.t[0]:g} to {self.t[-1]:g}{failed}>"

    def __getstate__(self) -> dict[str, Any]:
        # Dense output belongs to the compiled module: an unpickled solution takes the steps again when it is called.
        return {**self.__dict__, "_dense": None, "_start": None}

    def to_dataframe(self) -> Any:
        """The rows as a DataFrame of pandas: columns t, q, dot(q), p_q, Λ of each constraint, energy, and inputs."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_dataframe needs pandas: pip install pandas") from None
        return pandas.DataFrame(dict(columns_of(self)))

    def plot(self, axes: Any = None) -> Any:
        """Plots the coordinates and the energy error over time; returns the two axes of matplotlib."""
        axes = two_axes(axes)
        above, below = axes
        # Long steps would show as corners.
        is_smooth = self.sol is not None and len(self)
        t = np.linspace(self.t[0], self.t[-1], _SMOOTH) if is_smooth else self.t
        q = self.states(t)[0] if is_smooth else self.q
        for index, name in enumerate(self.system.coordinates):
            above.plot(t, q[:, index], label=name)
        if len(self.system.coordinates) <= 10:
            above.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        above.set_ylabel("coordinates")
        if len(self):
            below.plot(self.t, self.energy - self.energy[0])
        below.set(xlabel="t", ylabel="H - H(start)")
        return axes

    def animate(
        self,
        points: Callable[[Array], Any] | None = None,
        *,
        trace: int | None = None,
        fps: float = 25.0,
        speed: float = 1.0,
        axes: Any = None,
    ) -> Any:
        """An animation of the motion in a plane, by matplotlib: `sol.animate().save("motion.gif")`.

        It needs dense output, `until(t, dense=True)`: its frames are at a constant distance in time.

        Parameters
        ----------
        points : function
            Of the coordinates q: the points (x, y) that a line joins, such as the joints of a linkage. A point of NaN
            is a gap in the line. Pendulums, chains, linkages and orbits among the ready systems need none.
        trace : int
            Index of a point whose path is drawn.
        fps : float
            Frames in a second.
        speed : float
            Units of time in a second.
        axes : Axes
            The axes to draw in; by default those of a new figure.
        """
        return animated(self, points, trace, fps, speed, axes)


check_arguments(Solution, ["jacobian", "plot", "animate"])


BY_SYSTEM = ("v", "energy", "reactions")
"""Columns that follow from q, p and the parameters."""


class Events(Solution):
    """The events of a run: a row for each, `which` of the given events it is, and whether its function `rising`."""

    which: NDArray[np.intp]
    rising: NDArray[np.bool_]

    def __init__(
        self,
        system: System,
        t: Array,
        q: Array,
        p: Array,
        error: StepError | None,
        which: NDArray[np.intp],
        rising: NDArray[np.bool_],
    ):
        super().__init__(system, t, q, p, error)
        vars(self).update(which=fixed(which), rising=fixed(rising))

    def of(self, index: int) -> Events:
        """The rows of one of the given events, by its index."""
        return self._only(self.which == count(index, "the index of an event"), self.rising)

    def _only(self, rows: NDArray[np.bool_], rising: NDArray[np.bool_]) -> Events:
        found = Events(
            self.system, self.t[rows], self.q[rows], self.p[rows], self.error, self.which[rows], rising[rows]
        )
        found._values = None if self._values is None else self._values[rows]
        vars(found).update({name: fixed(vars(self)[name][rows]) for name in BY_SYSTEM if name in vars(self)})
        return found

    def _directed(self, turns: dict[int, tuple[Event, float]]) -> Events:
        """The rows without those of the wrong direction, for these events with a period."""
        rising, is_wanted = self.rising.copy(), np.ones(len(self), dtype=np.bool_)
        for index, (event, period) in turns.items():
            here = np.flatnonzero(self.which == index)
            # The sine of the search falls at odd numbers of periods.
            turn = np.rint((self[event.of][here] - event.at) / period)
            rising[here] ^= turn % 2.0 == 1.0
            is_wanted[here] = (event.direction == 0) | (rising[here] == (event.direction > 0))
        return self._only(is_wanted, rising)
