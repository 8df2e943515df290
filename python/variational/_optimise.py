"""Optimal control: the inputs of least cost, by direct multiple shooting over exact steps."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, array, count, finite, fixed, number, vector
from ._calls import checked_call, unassignable
from ._errors import StepError, advised  # type: ignore[attr-defined]
from ._names import among, meant
from ._nlp import Indices, Solved, solve
from ._observed import observed
from ._request import checked
from ._solution import Solution

if TYPE_CHECKING:
    from ._system import System

_GAUSS_OF_WORK = np.polynomial.legendre.leggauss(8)
"""Points and weights of the work of a step, of order 16."""
_KINK = re.compile(r"\b(?:abs|sign|max|min|clamp)\b(?=\s*\()")
"""Functions of the language without a derivative somewhere."""
_MISSED = 1e-6
"""The violation from which on conditions do not hold."""


@unassignable()
class EnergyBalance(NamedTuple):
    """The energy of an optimum. `change - work - other` is the error of the steps and of the integrals, unless L has an
    input or the time."""

    change: float
    """Energy at the end less that at the start."""
    work: float
    """Work of the inputs: of the generalized force less the force with zero inputs."""
    other: float
    """Work of the other forces, such as friction."""


@unassignable()
@dataclass(frozen=True, eq=False, repr=False)
class Optimum:
    """The inputs of least cost, and the motion that they cause."""

    solution: Solution
    """The run of these inputs: its K + 1 rows are the nodes."""
    t: Array
    """The times of the nodes, (K + 1,)."""
    u: Array
    """The inputs of each step, (K, M), in the order of `inputs`."""
    inputs: tuple[str, ...]
    """Names of the inputs."""
    cost: float
    """The cost: the integral of `cost` over the steps, plus `final` at the end."""
    iterations: int
    """Iterations of the solver."""
    success: bool
    """Whether the solver found an optimum."""
    status: str
    """The last words of the solver."""
    residual: float
    """The largest violation of a step, of an end or of a bound."""
    worst: str
    """What is violated most, such as "x of end at node 50" or "step 3"."""
    costates: Array
    """Derivatives of the cost with respect to (q, p) at the end of each step, (K, 2N)."""
    multipliers: dict[str, Array]
    """Multipliers of the other conditions by name: one for each node that has the condition. A positive one pushes
    against an upper bound."""
    advice: str
    """What to change if no optimum was found; empty otherwise."""
    _nodes: tuple[Array, Array]
    _problem: dict[str, Any]

    def __getitem__(self, name: str) -> Array:
        """An input by its name, (K,), or an array of them; a coordinate, a velocity or an expression at the nodes,
        (K + 1,)."""
        columns = _columns(name, self.inputs)
        return fixed(self.u[:, columns].copy()) if columns != [] else self.solution[name]

    def __repr__(self) -> str:
        name = type(self.solution.system).__name__
        first = f"Optimum of {name}: cost {self.cost:.8g} in {self.iterations} iterations"
        second = f"{len(self.u)} steps to t = {self.t[-1]:g}, largest residual {self.residual:.1e}"
        if not self.success:
            return f"{first}\n{second}, of {self.worst}\nnot converged: {self.status}\n{self.advice}"
        return f"{first}\n{second}, error of a step {self.errors.max():.1e}"

    @cached_property
    def errors(self) -> Array:
        """The error of the coordinates in each step, by half steps, (K, N)."""
        return fixed(np.array([run.local_error().q for run in self._runs()]))

    @cached_property
    def energy_balance(self) -> EnergyBalance:
        """The change of the energy, and the work of the inputs and of other forces."""
        work = other = 0.0
        for run, h in zip(self._runs(), np.diff(self.t), strict=True):
            driven = run.system
            free = driven.copy().set(**dict.fromkeys(driven.inputs, 0.0))
            for point, weight in zip(*_GAUSS_OF_WORK, strict=True):
                at = run.copy().step((1.0 + point) / 2.0 * h)
                force, rest = driven.force(at.t, at.q, at.v), free.force(at.t, at.q, at.v)
                work += weight / 2.0 * h * float((force - rest) @ at.v)
                other += weight / 2.0 * h * float(rest @ at.v)
        energy = self.solution.energy
        return EnergyBalance(float(energy[-1] - energy[0]), work, other)

    def again(self, **changes: Any) -> Optimum:
        """The same problem with other arguments of `optimise`, from this optimum as the guess: `again(steps=50)`."""
        given = dict(self._problem)
        if "steps" in changes and given["duration"] is None:
            # The times of the nodes were those of the duration.
            given.update(duration=float(self.t[-1] - self.t[0]), t=float(self.t[0]))
        return optimise(**{**given, "guess": self, **changes})

    def refined(self, error: float, rounds: int = 10) -> Optimum:
        """The same problem with steps whose largest error of a coordinate is at most this one: steps with a larger error
        are halved, and the optimum before is the guess, at most so many times.

        Raises ValueError if errors are larger still, or if no optimum is found.
        """
        if not number(error, "error") > 0.0:
            raise ValueError(f"error must be positive, not {error!r}")
        if not self.success:
            raise ValueError(f"this is no optimum to refine: {self.status}")
        found = self
        for _ in range(count(rounds, "rounds", 1)):
            large = found.errors.max(axis=1) > error
            if not large.any():
                return found
            shares = (found.t - found.t[0]) / (found.t[-1] - found.t[0])
            halves = (shares[1:] + shares[:-1])[large] / 2.0
            steps = found.t[0] + (found.t[-1] - found.t[0]) * np.sort(np.concatenate([shares, halves]))
            found = found.again(steps=steps, t=float(found.t[0]))
            if not found.success:
                raise ValueError(f"no optimum with {len(found.u)} steps: {found.status}")
        worst = found.errors.max()
        if worst <= error:
            return found
        raise ValueError(f"after {rounds} rounds {len(found.u)} steps have errors up to {worst:.1e}: give more rounds")

    def _runs(self) -> Any:
        """A run at the start of each step."""
        system, options = self.solution.system, {key: self._problem[key] for key in ("method", "stages")}
        for k, h in enumerate(np.diff(self.t)):
            own = type(system)._of(self.solution._values[k])  # type: ignore[index]
            yield own.integrate(self.solution.q[k], p=self.solution.p[k], t=self.t[k], h=h, **options)


@checked_call
def optimise(
    system: System,
    *,
    steps: int | ArrayLike,
    duration: float | Sequence[float] | None = None,
    start: Any,
    end: Any = None,
    cost: str | None = None,
    final: str | None = None,
    inputs: str | Sequence[str] | Mapping[str, Any] | None = None,
    bounds: Mapping[str, Any] | None = None,
    guess: Any = None,
    t: float | None = None,
    method: str | None = None,
    stages: int | None = None,
    options: Mapping[str, Any] | None = None,
) -> Optimum:
    """Finds the inputs of least cost by direct multiple shooting: the constraints are the steps of the method, whose
    Jacobians are exact. IPOPT of CasADi solves the program.

    Parameters
    ----------
    system : System
        The system. Its parameters, and the inputs that are not in `inputs`, stay constant.
    steps : int or array
        The number K of steps of equal length, or K + 1 ascending times that have the proportions of the steps. The
        inputs are constant over a step.
    duration : float or pair
        The time of all steps; two numbers are the bounds of a free one. By default that of the times in `steps`.
    start, end : pair or dict
        Coordinates and velocities (q, v), or values of some: `{"x": 0.0, "dot(x)": (-1.0, 1.0)}`. A pair is the least
        and the greatest value. Coordinates, velocities, momenta "p_x" and expressions of the language can be given,
        others are free. A list is the values of an array of coordinates: `{"x": [0.0, 1.0, 2.0], "dot(x)": 0.0}`.
    cost : str
        An expression of the language, whose integral is least: `"u^2"`, or `"1"` for the least time. Three Gauss points
        in each step take the integral.
    final : str
        An expression at the end that is added to the cost.
    inputs : list of str or dict
        The inputs to find, and their bounds: `{"u": (-1.0, 1.0)}`. By default all of the system, without bounds.
    bounds : dict
        Bounds of coordinates, velocities and expressions at all nodes: `{"x": (-1.0, 1.0), "x^2 + y^2": (0.1, None)}`.
    guess : dict, Optimum or Solution
        Start of the solver. A dict has inputs, as one number or one for each step, and optionally the "duration": the
        solver starts from the motion with these inputs. By default the coordinates go from start to end on a line,
        without inputs.
    t : float
        The time of the start: by default the first of the times in `steps`, or zero.
    method, stages
        As in `integrate`, for methods whose steps have the given length.
    options : dict
        Options of IPOPT, such as `{"max_iter": 500, "print_level": 5}`.

    Second derivatives are exact for Gauss steps, fixed ones and their compositions without constraints, otherwise
    differences of the exact first ones. If no optimum is found, `success` is False. Raises
    StepError if the motion of the guess fails.
    """
    given = {name: value for name, value in locals().items() if name != "guess"}
    problem = _Problem(system, steps, duration, t, method, stages)
    given["system"] = system.copy()
    problem.set_inputs(inputs)
    problem.set_costs(cost, final)
    for name, of, nodes in (("start", start, [0]), ("end", end, [problem.steps])):
        problem.set_end(name, of, nodes)
    problem.set_bounds(bounds)
    begin = problem.guessed(guess)
    problem.check(begin)
    return _optimum(problem, solve(problem.program, (problem.lower, problem.upper), begin, dict(options or {})), given)


def _optimum(problem: _Problem, found: Solved, given: dict[str, Any]) -> Optimum:
    """The result of a solved problem, with the run of its inputs."""
    n, k = problem.n, problem.steps
    duration, q, p, u = problem.split(found.x)
    t = problem.times(duration)
    values = problem.parameters(np.vstack([u, u[-1:]]))
    cls, options = type(problem.system), {"method": given["method"], "stages": given["stages"]}
    try:
        solution = _replayed(cls, values, t, q[0], p[0], options)
    except StepError:
        if found.success:
            raise
        # Inputs that are no optimum may have no motion: the nodes are all there is.
        solution = _of_nodes(cls, values, t, q, p, options)
    own, most = found.multipliers[2 * n * k :], int(np.argmax(found.violations))
    multipliers: dict[str, Array] = {}
    for row in problem.rows:
        multipliers[row.name] = fixed(own[row.place : row.place + len(row.nodes)].copy())
    return Optimum(
        solution,
        fixed(t),
        fixed(u),
        tuple(problem.names),
        found.cost,
        found.iterations,
        found.success,
        found.status,
        float(found.violations[most]),
        problem.place(most),
        fixed(found.multipliers[: 2 * n * k].reshape(k, 2 * n)),
        multipliers,
        "" if found.success else _advice(problem, found),
        (fixed(q), fixed(p)),
        given,
    )


def _advice(problem: _Problem, found: Solved) -> str:
    """The change that may help if the solver found no optimum."""
    kinks = sorted({of for text in problem.costs for of in _KINK.findall(text)})
    if kinks:
        return f"{', '.join(kinks)} in the cost has a kink: take a square, or sqrt(x^2 + e^2) for abs(x)"
    if found.violations.max() < _MISSED:
        return "the conditions hold, the cost may fall further: give another guess, or options={\"max_iter\": …}"
    bound = ", ".join(f"{name} is at a bound in {places}" for name, places in problem.at_bounds(found.x))
    where = f" ({bound})" if bound else ""
    return f"no motion that keeps the conditions was found{where}: give more time, wider bounds or another guess"


def _replayed(cls: Any, values: Array, t: Array, q: Array, p: Array, options: dict[str, Any]) -> Solution:
    """The run through these times, with numbers of the system for each of its steps."""
    run = cls._of(values[0]).integrate(q, p=p, t=t[0], h=t[1] - t[0], **options)
    rows = [(run.t, run.q, run.p, run.v, run.energy)]
    for row, end in enumerate(t[1:]):
        if row and not np.array_equal(values[row], values[row - 1]):
            changed = np.flatnonzero(values[row] != values[row - 1]).tolist()
            run._run.set_parameters([(index, values[row][index]) for index in changed])
        run.step(end - run.t)
        rows.append((end, run.q, run.p, run.v, run.energy))
    t, q, p, v, energy = (np.array(column) for column in zip(*rows, strict=True))
    return _solution(cls, values, t, q, p, v, energy)


def _of_nodes(cls: Any, values: Array, t: Array, q: Array, p: Array, options: dict[str, Any]) -> Solution:
    """The nodes of a solver that found no optimum. Velocity and energy of a node without motion are NaN."""
    v, energy = np.full_like(q, np.nan), np.full_like(t, np.nan)
    for k in range(len(t)):
        try:
            run = cls._of(values[k]).integrate(q[k], p=p[k], t=t[k], h=1.0, **options)
        except StepError:
            continue
        v[k], energy[k] = run.v, run.energy
    return _solution(cls, values, t, q, p, v, energy)


def _solution(cls: Any, values: Array, t: Array, q: Array, p: Array, v: Array, energy: Array) -> Solution:
    """A solution each row of which has a system of its own."""
    solution = Solution(cls._of(values[0])._fixed(), t, q, p)
    solution.__dict__.update(v=fixed(v), energy=fixed(energy))
    solution._values = values
    return solution


class _Function:
    """A function of the time, the coordinates, the velocities and the inputs: an expression of the language with its
    first and second derivatives."""

    def __init__(self, system: System, text: str, inputs: list[int]):
        value = system._observable(text)
        if value.shape:
            raise ValueError(f"{text!r} must be a number, not of the shape {tuple(value.shape)}")
        slope = system._observable(text, inputs)
        self.orders = [value, slope, system._observable(text, inputs, twice=True)]
        self.coordinates, self.inputs = len(system.coordinates), len(inputs)
        self.is_of_inputs = all(slope.zeros[: 1 + 2 * self.coordinates])
        """Whether it depends on inputs alone."""


class _Condition(NamedTuple):
    """Bounds of a function at some nodes. They have rows of the program from `place` on, behind those of the steps."""

    name: str
    nodes: Indices
    bounds: tuple[float, float]
    velocity: int | None
    """The index of a velocity; None for an expression."""
    place: int


class _Problem:
    """The nonlinear program in the names of a system. Its variables are the duration, then q, p and the inputs of each
    node. The last node has the inputs of the last step."""

    program: Any
    """The steps, the cost and the conditions with their derivatives."""

    def __init__(
        self, system: System, steps: Any, duration: Any, t: float | None, method: str | None, stages: int | None
    ):
        from ._system import System

        if not isinstance(system, System):
            raise TypeError(f"optimise needs a system such as vi.CartPole(), not {system!r}")
        cls = type(system)
        if method in ("energy", "adaptive"):
            raise ValueError(f'method="{method}" finds the lengths of its steps: optimise needs given ones')
        self.system, self.n = system, len(system.coordinates)
        self.shares, first, span = _shares(steps)
        self.t = first if t is None else number(t, "t")
        self.steps = len(self.shares) - 1
        self.duration = _durations(span if duration is None else duration)
        self.request = checked(cls, 1.0, None, None, method, stages, None, None, False)
        self.kind = system._for(self.request)._kind
        self.kind.integrator(self.request)
        self.rows: list[_Condition] = []
        self.velocities = np.zeros(self.n)

    def set_inputs(self, inputs: Any) -> None:
        """The inputs to find, and the layout of the variables."""
        system = self.system
        known: dict[str, dict[str, int]] = {}
        for name in system.inputs:
            known |= {name: system._parameter(name).entries}
            known |= {entry: {entry: index} for entry, index in system._parameter(name).entries.items()}
        if not known:
            raise ValueError(
                f"{type(system).__name__} has no inputs: declare them in the text, as in `input u = 0.0; force x = u;`"
            )
        wanted = system.inputs if inputs is None else [inputs] if isinstance(inputs, str) else inputs
        found: dict[str, tuple[int, tuple[float, float]]] = {}
        for name in wanted:
            meaning = among(name, known)
            if meaning not in known:
                raise ValueError(
                    f"{type(system).__name__} has no input {name!r}{meant(name, known)}; it has "
                    f"{', '.join(system.inputs)}"
                )
            pair = _bounds_of_input(wanted[name], name) if isinstance(wanted, Mapping) else (-math.inf, math.inf)
            found |= {entry: (index, pair) for entry, index in known[meaning].items()}
        self.names = list(found)
        self.indices = [index for index, _ in found.values()]
        self.m = len(found)
        n, m, k = self.n, self.m, self.steps
        each = 2 * n + m
        self.size = 1 + each * k + 2 * n
        places = 1 + each * np.arange(k + 1)[:, None] + np.arange(each)
        places[k, 2 * n :] = places[k - 1, 2 * n :]
        self.places = np.hstack([places, np.zeros((k + 1, 1), dtype=int)])
        self.lower, self.upper = np.full(self.size, -math.inf), np.full(self.size, math.inf)
        self.lower[0], self.upper[0] = self.duration
        for column, (_, pair) in enumerate(found.values()):
            at = self.places[:k, 2 * n + column]
            self.lower[at], self.upper[at] = pair
        self.program = self.kind.transcription(
            system._values, self.request, self.t, self.shares.tolist(), self.duration, self.indices
        )

    def set_costs(self, cost: str | None, final: str | None) -> None:
        if cost is None and final is None:
            raise ValueError('give cost, such as cost="u^2" or cost="1" for the least time, or final')
        self.costs = [text for text in (cost, final) if text is not None]
        if cost is not None:
            self.program.set_cost(_Function(self.system, cost, self.indices))
        if final is not None:
            self.program.set_final_cost(_Function(self.system, final, self.indices))

    def set_end(self, name: str, of: Any, nodes: list[int]) -> None:
        """The conditions of the start or of the end."""
        if of is None:
            return
        coordinates = self.system.coordinates
        if not isinstance(of, Mapping):
            if self.kind.is_first_order:
                raise ValueError(
                    f"L of {type(self.system).__name__} is linear in the velocities, so that the coordinates alone are a "
                    f'state: write {name}={{"{coordinates[0]}": …}}'
                )
            if not isinstance(of, (tuple, list)) or len(of) != 2:
                raise TypeError(f'{name} must be (q, v), or a dict such as {{"{coordinates[0]}": 0.0}}, not {of!r}')
            q, v = (vector(x, self.n, f"{letter} of {name}", coordinates) for x, letter in zip(of, "qv", strict=True))
            if self.system.constraints and name == "start":
                self._fix_start(q, v)
                return
            velocities = {f"dot({x})": value for x, value in zip(coordinates, v, strict=True)}
            of = {**dict(zip(coordinates, q, strict=True)), **velocities}
        for key, value in of.items():
            self._bound(key, value, np.array(nodes), f"{key} of {name}")

    def _fix_start(self, q: Array, v: Array) -> None:
        """The start of a system with constraints: its momenta, because the velocities do not determine them."""
        self.velocities = v
        state = np.concatenate([q, self.system.momentum(self.t, q, v)])
        self.lower[self.places[0, : 2 * self.n]] = self.upper[self.places[0, : 2 * self.n]] = state

    def set_bounds(self, bounds: Any) -> None:
        if bounds is not None and not isinstance(bounds, Mapping):
            first = self.system.coordinates[0]
            raise TypeError(f'bounds must be a dict such as {{"{first}": (-1.0, 1.0)}}, not {bounds!r}')
        for name, pair in (bounds or {}).items():
            if among(name, self.names) in self.names:
                raise ValueError(f"{name} is an input: write its bounds as inputs={{{name!r}: {pair!r}}}")
            self._bound(name, pair, np.arange(self.steps + 1), name)

    def _bound(self, name: str, value: Any, nodes: Indices, title: str) -> None:
        """Bounds of a coordinate or a momentum are those of variables; of anything else, those of rows. Those of an array
        are of its entries."""
        of, n = observed(name, type(self.system)), self.n
        if of.shape:
            for entry, of_entry in _entries(name, value, of.shape):
                self._bound(entry, of_entry, nodes, title.replace(name, entry, 1))
            return
        pair = _pair(value, name)
        if of.place is not None and of.place >= 2 * n and 0 in nodes and self.kind.is_first_order:
            raise ValueError(
                f"{name} follows from the coordinates, because L is linear in the velocities: bound a coordinate, "
                "or an expression of coordinates"
            )
        if of.place is not None and not n <= of.place < 2 * n:
            at = self.places[nodes, of.place if of.place < n else of.place - n]
            self.lower[at] = np.maximum(self.lower[at], pair[0])
            self.upper[at] = np.minimum(self.upper[at], pair[1])
            if (self.lower[at] > self.upper[at]).any():
                raise ValueError(f"the bounds of {name} exclude its value at the start or at the end")
            return
        velocity = None if of.place is None else of.place - n
        if velocity is None:
            self.program.bound(_Function(self.system, name, self.indices), nodes.tolist(), pair)
        else:
            self.program.bound_velocity(velocity, nodes.tolist(), pair)
        place = self.condition_count
        self.rows.append(_Condition(title, nodes, pair, velocity, place))

    # The variables.

    def times(self, duration: float) -> Array:
        return self.t + self.shares * duration

    def split(self, x: Array) -> tuple[float, Array, Array, Array]:
        """The duration, q, p and the inputs."""
        w, n = x[self.places], self.n
        return float(x[0]), w[:, :n].copy(), w[:, n : 2 * n].copy(), w[:-1, 2 * n : -1].copy()

    def joined(self, duration: float, q: Array, p: Array, u: Array) -> Array:
        x = np.empty(self.size)
        x[self.places] = np.column_stack([q, p, np.vstack([u, u[-1:]]), np.full(len(q), duration)])
        return np.clip(x, self.lower, self.upper)

    def parameters(self, u: Array) -> Array:
        """All numbers of the system, for each row of inputs."""
        values = np.tile(self.system._values, (len(u), 1))
        values[:, self.indices] = u
        return values

    # The program.

    @property
    def condition_count(self) -> int:
        """The number of rows behind those of the steps."""
        return sum(len(row.nodes) for row in self.rows)

    def place(self, at: int) -> str:
        """The name of a row, or of a variable behind the rows."""
        n, steps = self.n, 2 * self.n * self.steps
        if at < steps:
            return f"step {at // (2 * n)}"
        for row in self.rows:
            if at < steps + row.place + len(row.nodes):
                return f"{row.name} at node {row.nodes[at - steps - row.place]}"
        node, column = np.argwhere(self.places == at - steps - self.condition_count)[0]
        coordinates = self.system.coordinates
        names = [*coordinates, *(f"p_{x}" for x in coordinates), *self.names]
        return f"{names[column]} at node {node}" if column < len(names) else "the duration"

    def at_bounds(self, x: Array) -> Iterator[tuple[str, str]]:
        """The coordinates and inputs that are at a bound in most nodes or steps, and in how many."""
        at = np.minimum(x - self.lower, self.upper - x) < _MISSED * (1.0 + np.abs(x))
        at &= self.lower < self.upper
        columns = [*range(self.n), *range(2 * self.n, 2 * self.n + len(self.names))]
        for name, column in zip([*self.system.coordinates, *self.names], columns, strict=True):
            places, of = (self.places[:, column], "nodes") if column < self.n else (self.places[:-1, column], "steps")
            if 2 * at[places].sum() > len(places):
                yield name, f"{at[places].sum()} of {len(places)} {of}"

    def check(self, x: Array) -> None:
        """Raises the StepError of a step of the guess, and ValueError for a cost or a condition without a value there."""
        cost, _, conditions, _, error = self.program.evaluate(x)
        if error is not None:
            raise advised(error[1], type(self.system))
        if not math.isfinite(cost):
            raise ValueError("the cost has no finite value along the guess: give another guess, or another cost")
        for row in self.rows:
            first = 2 * self.n * self.steps + row.place
            lost = np.flatnonzero(~np.isfinite(conditions[first : first + len(row.nodes)]))
            if len(lost):
                node = row.nodes[lost[0]]
                raise ValueError(f"{row.name} has no finite value at node {node} of the guess: give another guess")

    # The guess.

    def guessed(self, guess: Any) -> Array:
        """The variables from which the solver starts."""
        if isinstance(guess, Optimum):
            return self._of_rows(guess.t, guess.u, guess.inputs, guess._nodes)
        if isinstance(guess, Solution):
            u = np.column_stack([guess[name] for name in self.names])[:-1]
            return self._of_rows(guess.t, u, self.names, (guess.q, guess.p))
        if guess is not None and not isinstance(guess, Mapping):
            raise TypeError(f"guess must be a dict of inputs, an Optimum or a Solution, not {guess!r}")
        duration = self._duration((guess or {}).get("duration"))
        given = {name: value for name, value in (guess or {}).items() if name != "duration"}
        return self._of_inputs(duration, given) if given else self._line(duration)

    def _duration(self, guess: Any) -> float:
        if guess is not None:
            return number(guess, "the duration of guess")
        if not math.isfinite(self.duration[1]):
            raise ValueError('give a finite greatest duration, or guess={"duration": …}')
        return sum(self.duration) / 2.0

    def _line(self, duration: float) -> Array:
        """Coordinates on a line between the ends, with its velocity."""
        ends = []
        for k, other in ((0, self.steps), (self.steps, 0)):
            at, of_other = self.places[k, : self.n], self.places[other, : self.n]
            there = [_middle(self.lower[place], self.upper[place]) for place in at]
            spare = [_middle(self.lower[place], self.upper[place]) for place in of_other]
            ends.append([a if a is not None else b or 0.0 for a, b in zip(there, spare, strict=True)])
        first, last = np.array(ends)
        q = first + self.shares[:, None] * (last - first)
        v = np.tile((last - first) / duration, (len(q), 1))
        if self.system.constraints:
            q, v = self.system.assemble(q, v, t=self.t)[:2]
        at = self.places[:-1, 2 * self.n : -1]
        u = np.clip(0.0, self.lower[at], self.upper[at])
        return self.joined(duration, q, self._momenta(duration, q, v, u), u)

    def _momenta(self, duration: float, q: Array, v: Array, u: Array) -> Array:
        values, t = self.parameters(np.vstack([u, u[-1:]])), self.times(duration)
        cls = type(self.system)
        return np.array([cls._of(values[k]).momentum(t[k], q[k], v[k]) for k in range(len(q))])

    def _of_inputs(self, duration: float, guess: Mapping[str, Any]) -> Array:
        """The motion of given inputs from the start."""
        u = np.zeros((self.steps, self.m))
        for name, value in guess.items():
            columns = _columns(name, self.names)
            if columns == []:
                raise ValueError(
                    f"{name!r} of guess is not an input to find{meant(name, self.names)}; they are "
                    f"{', '.join(self.names)}"
                )
            numbers = array(value, name)
            finite(numbers, name)
            wanted = u[:, columns].shape
            # One number of each entry of an array, for all steps.
            if numbers.shape not in ((), wanted, wanted[1:]):
                each = f", {wanted[1]} for all steps," if wanted[1:] else ""
                raise ValueError(
                    f"{name} of guess must be a number{each} or one for each step in the shape {wanted}, "
                    f"not {numbers.shape}"
                )
            u[:, columns] = numbers
        q, v = self._start()
        p = self._momenta(duration, q[None], v[None], u[:1])[0]
        options = {"method": self.request.method, "stages": self.request.stages}
        values = self.parameters(np.vstack([u, u[-1:]]))
        run = _replayed(type(self.system), values, self.times(duration), q, p, options)
        return self.joined(duration, run.q, run.p, u)

    def _start(self) -> tuple[Array, Array]:
        """Coordinates and velocities of the start: the middle of their bounds, zero without."""
        at = self.places[0, : self.n]
        q = np.array([_middle(self.lower[place], self.upper[place]) or 0.0 for place in at])
        v = self.velocities.copy()
        for row in self.rows:
            if row.velocity is not None and 0 in row.nodes:
                v[row.velocity] = _middle(*row.bounds) or 0.0
        return q, v

    def _of_rows(self, t: Array, u: Array, names: Sequence[str], nodes: tuple[Array, Array]) -> Array:
        """Another motion, at the same shares of its duration."""
        missing = [name for name in self.names if name not in names]
        if missing:
            raise ValueError(f"the guess has no input {', '.join(missing)}")
        lower, upper = self.duration
        duration = float(np.clip(t[-1] - t[0], lower, upper))
        shares = (t - t[0]) / (t[-1] - t[0])
        q, p = (np.column_stack([np.interp(self.shares, shares, of) for of in column.T]) for column in nodes)
        middles = (self.shares[1:] + self.shares[:-1]) / 2.0
        step = np.clip(np.searchsorted(shares, middles, side="right") - 1, 0, len(u) - 1)
        return self.joined(duration, q, p, u[step][:, [names.index(name) for name in self.names]])


def _columns(name: str, inputs: Sequence[str]) -> int | list[int]:
    """The column of an input, or those of an array of inputs; none of another name."""
    found = among(name, inputs)
    return inputs.index(found) if found in inputs else [k for k, of in enumerate(inputs) if of.startswith(f"{found}[")]


def _shares(steps: Any) -> tuple[Array, float, float | None]:
    """The nodes as shares of the duration, and the start and the duration of given times."""
    if np.ndim(steps) == 0:
        return np.linspace(0.0, 1.0, count(steps, "steps", 1) + 1), 0.0, None
    times = array(steps, "steps")
    finite(times, "steps")
    if times.ndim != 1 or len(times) < 2 or not (np.diff(times) > 0.0).all():
        raise ValueError("steps must be a number of steps, or two or more ascending times")
    span = float(times[-1] - times[0])
    return (times - times[0]) / span, float(times[0]), span


def _durations(duration: Any) -> tuple[float, float]:
    """The least and the greatest duration."""
    if duration is None:
        raise TypeError("give duration: the time of all steps, or the bounds (least, greatest) of a free one")
    lower, upper = _pair(duration, "duration")
    if not 0.0 < lower < math.inf:
        raise ValueError(
            f"duration must be positive, not {duration!r}: the least free one may be small, as in (0.1, 10.0)"
        )
    return lower, upper


def _entries(name: str, value: Any, shape: tuple[int, ...]) -> Iterator[tuple[str, Any]]:
    """The entries of an array, with their values: a list of its shape has one for each, anything else is for all."""
    inner = re.fullmatch(r"\s*(dot\()?\s*(\w+)\s*(\)?)\s*", name)
    if inner is None:
        raise ValueError(f"{name!r} has the shape {shape}: give its entries one by one")
    is_list = isinstance(value, (list, np.ndarray))
    if is_list and np.shape(value)[: len(shape)] != shape:
        raise ValueError(
            f"{name} must be a number, the bounds (least, greatest), or a list of the shape {shape}, not {value!r}"
        )
    for index in np.ndindex(shape):
        entry = f"{inner[1] or ''}{inner[2]}{''.join(f'[{i}]' for i in index)}{inner[3]}"
        of_entry = value
        for i in index if is_list else ():
            of_entry = of_entry[i]
        yield entry, of_entry


def _pair(value: Any, name: str) -> tuple[float, float]:
    """A value, or the least and the greatest one; None is no bound."""
    if value is None or (np.ndim(value) == 0 and not isinstance(value, (tuple, list))):
        found = number(value, name)
        return found, found
    if len(value) != 2:
        raise ValueError(f"the bounds of {name} must be two numbers or None, not {value!r}")
    lower, upper = (other if of is None else float(of) for of, other in zip(value, (-math.inf, math.inf), strict=True))
    if not lower <= upper:
        raise ValueError(f"the bounds of {name} must be ascending, not {value!r}")
    return lower, upper


def _bounds_of_input(value: Any, name: str) -> tuple[float, float]:
    """The bounds of an input, which are a pair: a number would leave nothing to find."""
    if not isinstance(value, (tuple, list)) or len(value) != 2 or any(isinstance(of, (tuple, list)) for of in value):
        entries = f", for each entry {{'{name}[0]': …}}" if isinstance(value, (tuple, list)) else ""
        raise ValueError(
            f"the bounds of the input {name} must be two numbers or None, as in inputs={{{name!r}: (-1.0, 1.0)}}"
            f"{entries}, not {value!r}; set a constant input in the system"
        )
    return _pair(value, name)


def _middle(lower: float, upper: float) -> float | None:
    """The middle of bounds; the only one; None without."""
    finite_ones = [bound for bound in (lower, upper) if math.isfinite(bound)]
    return sum(finite_ones) / len(finite_ones) if finite_ones else None
