"""Parameters and start values from measurements, by least squares with exact sensitivities."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, array, finite, fixed, number, ordered, vector
from ._calls import checked_call, unassignable
from ._errors import StepError
from ._names import among, meant, unknowns, unknowns_of
from ._observed import Observed, observed
from ._progress import Report, progress
from ._solution import Solution

if TYPE_CHECKING:
    from ._run import Run
    from ._system import System


class Unidentifiable(ValueError):
    """The measurements do not determine the unknowns.

    `direction` has the changes of the unknowns that together change no residual, relative to the largest of them, and
    `change` the change of the residuals by them, relative to that by each unknown alone.
    """

    __module__ = "variational"

    def __init__(self, message: str, direction: dict[str, float], change: float):
        super().__init__(message)
        self.direction = direction
        self.change = change

    def __reduce__(self) -> Any:
        return (type(self), (str(self), self.direction, self.change))


@unassignable()
@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """The unknowns for which the sum of the squared residuals is least.

    An unknown at a bound has no error: its entries of `errors` and `covariance` are NaN, and those of the others belong
    to its fixed value.
    """

    parameters: dict[str, float]
    """The value of each unknown."""
    errors: dict[str, float]
    """The standard error of each unknown."""
    covariance: Array
    """The covariance of the unknowns in the order of `parameters`, (U, U)."""
    residuals: Array
    """Measured less computed values, (K, C) in the order of `columns`; NaN if there is no measurement."""
    columns: tuple[str, ...]
    """Names of the measured columns."""
    deviation: float
    """The standard deviation of a residual; with `sigma` relative to it, so that about 1 is expected."""
    jacobian: Array
    """Derivatives of the computed values with respect to the unknowns, (K, C, U)."""
    system: System
    """The system with the parameters found."""
    solution: Solution
    """The motion at the times of the measurements."""
    success: bool
    """Whether the iteration converged."""
    message: str
    """Why the iteration ended."""
    evaluations: int
    """How many motions were computed."""

    @property
    def correlation(self) -> Array:
        """The correlations of the unknowns, (U, U)."""
        errors = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.covariance / np.outer(errors, errors)

    def __getitem__(self, name: str) -> float:
        found = among(name, self.parameters)
        if found not in self.parameters:
            raise KeyError(
                f"the fit has no unknown {name!r}{meant(name, self.parameters)}; it has {_listed(self.parameters)}"
            )
        return self.parameters[found]

    def __repr__(self) -> str:
        count = int(np.isfinite(self.residuals).sum())
        width = max(map(len, self.parameters))
        lines = [f"Fit of {type(self.system).__name__} to {count} values of {', '.join(self.columns)}:"]
        for name, value in self.parameters.items():
            lines.append(f"  {name:{width}} = {_with_error(value, self.errors[name])}")
        lines.append(f"standard deviation of the residuals: {self.deviation:.3g}")
        if not self.success:
            lines.append(f"not converged: {self.message}")
        return "\n".join(lines)


@checked_call
def fit(
    system: System,
    data: Any,
    parameters: str | Iterable[str],
    *,
    q: ArrayLike,
    v: ArrayLike | None = None,
    t: float | None = None,
    h: float | None = None,
    tolerance: float | None = None,
    method: str | None = None,
    stages: int | None = None,
    bounds: Mapping[str, Sequence[float]] | None = None,
    sigma: float | Mapping[str, float] | None = None,
) -> Fit:
    """Finds parameters and start values of a system from measurements of its motion, by `scipy.optimize.least_squares`
    with the exact sensitivities of the steps.

    Parameters
    ----------
    system : System
        The system. Its parameters are the first guess of the unknown ones.
    data : dict, DataFrame or array
        Columns "t" with ascending times, and measurements of coordinates "x", velocities "dot(x)", momenta "p_x", and
        expressions of the language that are one number, such as "l * sin(θ)"; NaN if there is none. The column of an
        input has its value from this time to the next. An array (K, 1 + N) has the columns t and all coordinates.
    parameters : list of str
        The unknowns: names of parameters, or of entries such as "m[0]"; a coordinate "x" or a velocity "dot(x)" is its
        value at the start.
    q, v, t : array, array, float
        Coordinates, velocities and time of the start; the first guess of the unknown ones. By default at rest, at the
        first time.
    h, tolerance, method, stages
        As in `integrate`. Steps between two times have equal lengths of at most h.
    bounds : dict
        The least and the greatest value of unknowns: `{"k": (0.0, 10.0)}`.
    sigma : float or dict
        The standard deviation of the measurements, or that of each column. Without it all values have one deviation,
        which is estimated from the residuals.

    With constraints the start is the nearest state on them, as of `System.project`. Unknown entries of it are
    independent ones; the constraints move the others, also if a length changes. Raises Unidentifiable if the
    measurements do not determine the unknowns, and StepError if the motion of the first guess fails. After Ctrl-C the
    attribute `solution` of KeyboardInterrupt has the last motion.
    """
    try:
        from scipy.optimize import least_squares
    except ImportError:
        raise ImportError("fit needs scipy: pip install scipy") from None
    model = _Model(system, data, parameters, q, v, t)
    model.begin(h, tolerance, method, stages)
    names = list(model.unknowns)
    guess = model.guess()
    limits = _bounds({} if bounds is None else bounds, type(system), dict(zip(names, guess.tolist(), strict=True)))
    weights = np.broadcast_to(1.0 / _sigmas(sigma, model.columns), model.measured.shape)
    there = np.isfinite(model.measured)
    if there.sum() < len(names):
        raise ValueError(f"{len(names)} unknowns need as many measurements or more, not {there.sum()}")

    def residuals(unknowns: Array) -> Array:
        try:
            computed = model(unknowns)[0]
        except StepError:
            if np.array_equal(unknowns, guess):
                raise
            # The method takes a shorter step if residuals are not finite.
            return np.full(there.sum(), np.nan)
        return ((computed - model.measured) * weights)[there]

    def jacobian(unknowns: Array) -> Array:
        return (model(unknowns)[1] * weights[..., None])[there]

    # The test of the gradient alone depends on the units.
    options: dict[str, Any] = {"x_scale": "jac", "ftol": 1e-13, "xtol": 1e-13, "gtol": None}
    with progress("motions of the fit", None) as model.report:
        try:
            found = least_squares(residuals, guess, jacobian, limits, **options)
            for _ in range(_MOVES):
                if not model.move(found.x):
                    break
                guess = np.clip(model.guess(), *limits)
                found = least_squares(residuals, guess, jacobian, limits, **options)
        except KeyboardInterrupt as raised:
            raised.solution = model.solution  # type: ignore[attr-defined]
            raise
    values = dict(zip(names, found.x.tolist(), strict=True))
    is_free = found.active_mask == 0
    computed, slopes, end = model(found.x)
    least = _ROUNDING * float(np.linalg.norm((computed * weights)[there]))
    inverse = _inverse(found.jac[:, is_free], {name: values[name] for name in np.array(names)[is_free].tolist()}, least)
    spare = there.sum() - len(names)
    deviation = math.sqrt(2.0 * found.cost / spare) if spare else math.nan
    covariance = np.full((len(names),) * 2, np.nan)
    covariance[np.ix_(is_free, is_free)] = inverse * (deviation**2 if sigma is None else 1.0)
    return Fit(
        values,
        dict(zip(names, np.sqrt(np.diag(covariance)).tolist(), strict=True)),
        fixed(covariance),
        fixed(model.measured - computed),
        model.columns,
        deviation,
        fixed(slopes),
        end.system,
        end,
        bool(found.success),
        found.message,
        model.evaluations,
    )


class _Model:
    """The computed values at the times of the measurements, and their derivatives."""

    def __init__(
        self, system: System, data: Any, parameters: str | Iterable[str], q: ArrayLike, v: ArrayLike | None, t: Any
    ):
        from ._system import System

        if not isinstance(system, System):
            raise TypeError(f"fit needs a system such as vi.Pendulum(), not {system!r}")
        cls, n = type(system), len(system.coordinates)
        self.cls = cls
        self.values = system._values.copy()
        times, self.rows, inputs = _read(data, cls)
        self.t = times[0] if t is None else number(t, "t")
        self.times = ordered(times, 1.0)
        if self.times[0] < self.t:
            raise ValueError(f"the first time of the data, {self.times[0]:g}, is before the start t = {self.t:g}")
        self.columns = tuple(self.rows)
        self.measured = np.column_stack([values for _, values in self.rows.values()])
        self.inputs = inputs
        self.start = np.concatenate(
            [vector(q, n, "q", cls.coordinates), np.zeros(n) if v is None else vector(v, n, "v", cls.coordinates)]
        )
        self.unknowns = unknowns(parameters, cls)
        for name, column in inputs.items():
            if column[0] in [index for is_start, index in self.unknowns.values() if not is_start]:
                raise ValueError(f"{name} is an unknown and a column of the data")
        self.is_parameter = np.array([not is_start for is_start, _ in self.unknowns.values()])
        self.indices = [index for is_start, index in self.unknowns.values() if not is_start]
        self.entries = [index for is_start, index in self.unknowns.values() if is_start]
        self.evaluations = 0
        self.report: Report | None = None
        self._last: tuple[Array, Any] | None = None

    def begin(self, h: float | None, tolerance: float | None, method: str | None, stages: int | None) -> None:
        """Checks the options of a run, and finds the length of its steps."""
        if method == "energy":
            raise ValueError('method="energy" has steps of other lengths, which do not end at the times of the data')
        self.options: dict[str, Any] = {"method": method, "stages": stages}
        self.start = self._on_constraints(self.start, self.values)
        run = self._run(self.start, self.values, h=h, tolerance=tolerance)
        self.h = run.h
        if self.h < 0.0:
            raise ValueError(f"h must be positive, not {self.h!r}")
        self.slope = self._slope(run)
        self._check_entries()

    def _check_entries(self) -> None:
        """Checks that the constraints leave the unknown entries of the start independent."""
        names = [name for name, (is_start, _) in self.unknowns.items() if is_start]
        change = self.slope[self.entries][:, ~self.is_parameter]
        if names and np.abs(change - np.eye(len(names))).max() > _DEPENDENT:
            raise ValueError(
                f"the constraints determine some of {_listed(names)} by the others at the start: leave these out"
            )

    def move(self, unknowns: Array) -> bool:
        """Moves the guess to these unknowns, where the derivatives are exact. False if it is there already, as without
        constraints always."""
        if not self.cls.constraints or np.allclose(unknowns, self.guess(), rtol=_NEAR, atol=1e-3 * _NEAR):
            return False
        self.start, self.values = self._moved(unknowns)
        self.slope = self._slope(self._run(self.start, self.values, h=self.h))
        self._last = None
        return True

    def _moved(self, unknowns: Array) -> tuple[Array, Array]:
        """The start of these unknowns on the constraints, and the numbers of the system."""
        values = self.values.copy()
        values[self.indices] = unknowns[self.is_parameter]
        start = self.start + self.slope @ (unknowns - self.guess())
        start[self.entries] = unknowns[~self.is_parameter]
        return self._on_constraints(start, values), values

    def _on_constraints(self, start: Array, values: Array) -> Array:
        """The start on the constraints that is nearest to this one."""
        if not self.cls.constraints:
            return start
        found = self._system(values, 0).project(*np.split(start, 2), t=self.t)
        return np.concatenate([found.q, found.v])

    def _slope(self, run: Run) -> Array:
        """The derivatives of the start (q, v) with respect to the unknowns, (2N, U). Its unknown entries are these
        unknowns themselves, and the constraints move the others."""
        size, count = len(self.start), len(self.indices)
        if self.cls.constraints:
            columns = run._tangent(self.indices, velocities=[True, True])[:size]
        else:
            columns = np.eye(size, size + count)
        moved, own = columns[:, self.entries], columns[:, size:]
        along = moved @ np.linalg.pinv(moved[self.entries], rcond=_DEPENDENT)
        slope = np.empty((size, len(self.unknowns)))
        slope[:, ~self.is_parameter] = along
        slope[:, self.is_parameter] = own - along @ own[self.entries]
        return slope

    def _run(self, start: Array, values: Array, **options: Any) -> Run:
        q, v = np.split(start, 2)
        return self._system(values, 0).integrate(q, v, t=self.t, **options, **self.options)

    def guess(self) -> Array:
        """The first guess of the unknowns."""
        return np.array(
            [(self.start if is_start else self.values)[index] for is_start, index in self.unknowns.values()]
        )

    def __call__(self, unknowns: Array) -> tuple[Array, Array, Solution]:
        """Values (K, C), derivatives (K, C, U) and the motion. The last ones are kept: scipy asks twice."""
        if self._last is None or not np.array_equal(self._last[0], unknowns):
            self.evaluations += 1
            if self.report is not None:
                self.report(self.evaluations)
            self._last = (unknowns.copy(), self._computed(unknowns))
        return self._last[1]

    @property
    def solution(self) -> Solution | None:
        """The last motion."""
        return None if self._last is None else self._last[1][2]

    def _computed(self, unknowns: Array) -> tuple[Array, Array, Solution]:
        start, values = self._moved(unknowns)
        t, run = self.t, self._run(start, values, h=self.h)
        slope = self._carried(run, self._slope(run), velocities=[True, False])
        rows, outputs = [], []
        for row, end in enumerate(self.times):
            if end > t:
                steps = math.ceil((end - t) / self.h * (1.0 - 1e-9))
                # Inputs change after the row.
                system = self._system(values, max(row - 1, 0))
                run = system.integrate(run.q, p=run.p, t=t, h=(end - t) / steps, **self.options)
                slope = self._carried(run, slope, steps=steps)
                t = end
            rows.append((t, run.q, run.p, run.v, run.energy))
            # Of (q, v, p).
            moved = self._carried(run, slope, velocities=[False, True])
            outputs.append(np.concatenate([moved, slope[len(slope) // 2 :]]))
        t, q, p, v, energy = (np.array(column) for column in zip(*rows, strict=True))
        solution = Solution(self._system(values, 0)._fixed(), t, q, p)
        # With inputs each row has a system of its own.
        solution.__dict__.update(v=fixed(v), energy=fixed(energy))
        solution._values = np.array([self._system(values, row)._values for row in range(len(self.times))])
        at = (solution.system, t, np.concatenate([q, v, p], axis=-1), solution._values)
        computed = [of.values(*at) for of, _ in self.rows.values()]
        slopes = []
        for of, _ in self.rows.values():
            _, of_states, of_parameters = of.slopes(*at, self.indices)
            changes = np.einsum("ks,ksu->ku", of_states, np.array(outputs))
            changes[:, self.is_parameter] += of_parameters
            slopes.append(changes)
        return np.column_stack(computed), np.stack(slopes, axis=1), solution

    def _carried(self, run: Any, slope: Array, **options: Any) -> Array:
        """The derivatives with respect to the unknowns, (2N, U), carried from the node of a run over its steps."""
        columns = run._tangent(self.indices, **options)[: len(self.start)]
        carried = columns[:, : len(self.start)] @ slope
        carried[:, self.is_parameter] += columns[:, len(self.start) :]
        return carried

    def _system(self, values: Array, row: int) -> System:
        """The system from the time of a row on."""
        values = values.copy()
        for index, column in self.inputs.values():
            values[index] = column[row]
        return self.cls._of(values)


def _read(data: Any, cls: Any) -> tuple[Array, dict[str, tuple[Observed, Array]], dict[str, tuple[int, Array]]]:
    """Times, measured columns with what they measure, and columns of inputs with their index."""
    if hasattr(data, "columns") and hasattr(data, "to_dict"):
        columns = {name: data[name].to_numpy() for name in data.columns}
    elif isinstance(data, Mapping):
        columns = dict(data)
    else:
        wanted = 1 + len(cls.coordinates)
        table = array(data, "data")
        if table.ndim != 2 or table.shape[1] != wanted:
            listed = ", ".join(cls.coordinates)
            raise ValueError(
                f"an array of data has the columns t, {listed}, not the shape {table.shape}: give a dict or a "
                "DataFrame with some of them"
            )
        columns = dict(zip(["t", *cls.coordinates], table.T, strict=True))
    if "t" not in columns:
        named = [name for name in columns if str(name).lower() in ("time", "times")]
        hint = f": rename {named[0]!r}" if named else ""
        raise ValueError(f'data has no column "t", the times{hint}')
    times = array(columns.pop("t"), "t")
    if times.ndim != 1 or not len(times):
        raise ValueError(f"the times of the data must be a list, not of shape {times.shape}")
    measured, inputs = {}, {}
    of_inputs = {entry: index for name in cls.inputs for entry, index in cls._parameter(name).entries.items()}
    for name, values in columns.items():
        found = array(values, f"the column {name!r}")
        if found.shape != times.shape:
            raise ValueError(f"the column {name!r} has the shape {found.shape}, and the times {times.shape}")
        if name in of_inputs:
            finite(found, name)
            inputs[name] = (of_inputs[name], found)
            continue
        of = _column(name, cls)
        if np.isinf(found).any():
            finite(found, name)
        measured[of.text] = (of, found)
    if not measured:
        raise ValueError(
            f"data has no column of a coordinate or a velocity; {cls.__name__} has {_listed(cls.coordinates)}"
        )
    return times, measured, inputs


def _column(name: str, cls: Any) -> Observed:
    """What a column measures."""
    try:
        of = observed(name, cls)
    except KeyError as unknown:
        raise KeyError(f"{unknown.args[0]}: leave out the column, or rename it") from None
    except ValueError as error:
        raise ValueError(
            f"the column {name!r} of the data is no quantity of {cls.__name__}: leave it out, or correct it\n{error}"
        ) from None
    if of.shape:
        raise ValueError(f"the column {name!r} has the shape {of.shape} in {cls.__name__}: measure one entry of it")
    return of


def _bounds(bounds: Mapping[str, Sequence[float]], cls: Any, guess: Mapping[str, float]) -> tuple[Array, Array]:
    """The least and the greatest value of each unknown."""
    if not isinstance(bounds, Mapping):
        raise TypeError(f'bounds must be a dict such as {{"{next(iter(guess))}": (0.0, 1.0)}}, not {bounds!r}')
    found = dict.fromkeys(guess, (-math.inf, math.inf))
    for name, pair in bounds.items():
        limits = array(pair, f"the bounds of {name}")
        if limits.shape != (2,) or not limits[0] < limits[1]:
            raise ValueError(f"the bounds of {name} must be two ascending numbers, not {pair!r}")
        for entry in unknowns_of(name, cls):
            if entry not in guess:
                raise ValueError(f"{name!r} of bounds is not an unknown{meant(name, guess)}; they are {_listed(guess)}")
            if not limits[0] <= guess[entry] <= limits[1]:
                raise ValueError(
                    f"the first guess {entry} = {guess[entry]:g} is outside of its bounds "
                    f"{limits[0]:g} to {limits[1]:g}"
                )
            found[entry] = tuple(limits)
    lower, upper = np.array([*found.values()]).T
    return lower, upper


def _sigmas(sigma: float | Mapping[str, float] | None, columns: tuple[str, ...]) -> Array:
    """The standard deviation of each column."""
    if sigma is None:
        return np.ones(len(columns))
    given = sigma if isinstance(sigma, Mapping) else dict.fromkeys(columns, sigma)
    found = {among(name, columns): number(value, f"sigma of {name}") for name, value in given.items()}
    for name in [*found, *columns]:
        if name not in columns:
            raise ValueError(
                f"{name!r} of sigma is no measured column{meant(name, columns)}; they are {_listed(columns)}"
            )
        if not found.get(name, 0.0) > 0.0:
            raise ValueError(f"sigma of {name} must be positive, not {found.get(name)!r}")
    return np.array([found[name] for name in columns])


_DEPENDENT = 1e-8
"""Unknown entries of the start depend on each other if a change by the constraints is relatively smaller."""

_NEAR = 1e-9
"""A guess with constraints is at the unknowns found, relative to them. Derivatives of the start are exact there; far from
the guess they miss the curvature of the constraints."""

_MOVES = 10
"""Moves of the guess to the unknowns found at most. Each leaves the square of the distance of the one before."""

_SINGULAR = 1e-10
"""Derivatives are exact to about 1e-12."""

_ROUNDING = 1e-13
"""Derivatives with respect to the logarithm of an unknown, relative to the computed values."""


def _inverse(jacobian: Array, values: dict[str, float], least: float) -> Array:
    """(JᵀJ)⁻¹. Derivatives with respect to the logarithm of an unknown are zero below `least`.

    Raises Unidentifiable if J has less than full rank to rounding.
    """
    sizes = np.linalg.norm(jacobian, axis=0)
    for (name, value), size in zip(values.items(), sizes, strict=True):
        if size == 0.0 or (value != 0.0 and size * abs(value) < least):
            raise Unidentifiable(
                f"the measurements do not depend on {name}: their derivative is {size:.1e}; "
                "leave it out of the unknowns",
                {name: 1.0},
                0.0,
            )
    _, singular, rows = np.linalg.svd(jacobian / sizes, full_matrices=False)
    if len(singular) and singular[-1] < _SINGULAR:
        share = np.abs(rows[-1]) > 1e-6
        direction = rows[-1] / sizes
        direction = direction / direction[np.argmax(np.abs(rows[-1]))]
        changes = {name: float(d) for name, d, counts in zip(values, direction, share, strict=True) if counts}
        listed = ", ".join(f"{name} by {d:.3g}" for name, d in changes.items())
        raise Unidentifiable(
            f"the measurements do not determine {_listed(changes)} separately: a change of {listed} together "
            f"changes the residuals by {singular[-1]:.1e} times the change by one alone; leave one out, "
            "or measure more",
            changes,
            float(singular[-1]),
        )
    half = (rows.T / singular) / sizes[:, None]
    return half @ half.T


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names)


def _with_error(value: float, error: float) -> str:
    """A value to the second digit of its error."""
    if not math.isfinite(error):
        return f"{value:.6g} (no standard error)"
    if error == 0.0 or value == 0.0:
        return f"{value:.6g} ± {error:.2g}"
    digits = math.floor(math.log10(abs(value))) - math.floor(math.log10(error)) + 2
    return f"{value:#.{min(max(digits, 1), 15)}g} ± {error:#.2g}"
