"""Two models of one motion: how far they are apart, and what each costs."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import Array, fixed, number
from ._calls import checked_call, unassignable
from ._run import Run
from ._solution import Solution


@unassignable()
@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """The motions of two models at the same times."""

    t: Array
    """The times, (K,)."""
    columns: tuple[str, ...]
    """Names of the compared coordinates, those of the full model."""
    difference: Array
    """Coordinates of the reduced model less those of the full one, (K, C)."""
    solutions: tuple[Solution, Solution]
    """The motions of the full and of the reduced model."""
    seconds: tuple[float, float]
    """The time that each run took."""
    operations: tuple[int, int]
    """The operations of the equations of motion at one point."""

    @property
    def largest(self) -> dict[str, float]:
        """The largest difference of each coordinate."""
        return dict(zip(self.columns, np.abs(self.difference).max(axis=0).tolist(), strict=True))

    def until(self, tolerance: float) -> float:
        """The first of the times at which a coordinate is off by more than `tolerance`; infinite if there is none."""
        is_off = (np.abs(self.difference) > number(tolerance, "tolerance")).any(axis=1)
        return float(self.t[is_off.argmax()]) if is_off.any() else float("inf")

    def __repr__(self) -> str:
        names = [type(of.system).__name__ for of in self.solutions]
        lines = [f"{names[1]} beside {names[0]}, from t = {self.t[0]:g} to {self.t[-1]:g}:"]
        lines += [f"  {name}: off by up to {most:.3g}" for name, most in self.largest.items()]
        for name, operations, seconds in zip(names, self.operations, self.seconds, strict=True):
            lines.append(f"{name}: {operations} operations at a point, {1e3 * seconds:.3g} ms")
        return "\n".join(lines)

    def plot(self, axes: Any = None) -> Any:
        """Plots the size of each difference over time; returns the axes of matplotlib."""
        import matplotlib.pyplot as plt

        axes = plt.subplots()[1] if axes is None else axes
        for name, values in zip(self.columns, np.abs(self.difference).T, strict=True):
            # Equal values have no logarithm.
            axes.semilogy(self.t, np.where(values > 0.0, values, np.nan), label=name)
        axes.set(xlabel="t", ylabel="difference")
        axes.legend()
        return axes


@checked_call
def compare(
    full: Run, reduced: Run, until: float, *, map: Callable[[Array], Any] | None = None, times: int = 201
) -> Comparison:
    """Runs two models of one motion, and measures how far they are apart: a linkage and its angle, a system with and
    without a term.

    >>> found = compare(rod.integrate(...), pendulum.integrate(...), 5.0, map=lambda q: (sin(q[0]), -cos(q[0])))
    >>> found.largest  # doctest: +SKIP
    {'x': 2.6e-12, 'y': 4.1e-12}

    Parameters
    ----------
    full, reduced : Run
        The runs, at their starts. They stay there.
    until : float
        The end.
    map : function
        The coordinates of the full model from those of the reduced one. By default coordinates with the same name are
        compared.
    times : int
        The number of times, at equal distances from the start to the end.

    Raises StepError if a run fails.
    """
    for run in (full, reduced):
        if not isinstance(run, Run):
            raise TypeError(f"compare takes two runs, system.integrate(…), not {type(run).__name__}")
    if full.t != reduced.t:
        raise ValueError(f"the runs start at different times, {full.t:g} and {reduced.t:g}")
    if not isinstance(times, int) or times < 2:
        raise ValueError(f"times must be a number from 2 on, not {times!r}")
    at = np.linspace(full.t, number(until, "until"), times)
    solutions, seconds = [], []
    for run in (full.copy(), reduced.copy()):
        begun = time.perf_counter()
        solutions.append(run.at(at))
        seconds.append(time.perf_counter() - begun)
    columns, found = _mapped(full, solutions[1], map)
    of_full = solutions[0].q[:, [full.system.coordinates.index(name) for name in columns]]
    operations = [run.system.explain().operations["point"] for run in (full, reduced)]
    return Comparison(
        fixed(at), columns, fixed(found - of_full), tuple(solutions), tuple(seconds), tuple(operations)
    )  # type: ignore[arg-type]


def _mapped(full: Run, reduced: Solution, map: Callable[[Array], Any] | None) -> tuple[tuple[str, ...], Array]:
    """Names of compared coordinates, and their values by the reduced model."""
    names = full.system.coordinates
    if map is None:
        own = reduced.system.coordinates
        common = tuple(name for name in names if name in own)
        if not common:
            raise ValueError(
                f"{type(full.system).__name__} and {type(reduced.system).__name__} have no coordinate in common: give "
                f"map, a function of {', '.join(own)} that returns {', '.join(names)}"
            )
        return common, reduced.q[:, [own.index(name) for name in common]]
    values = np.array([map(q) for q in reduced.q], dtype=float)
    if values.shape != (len(reduced.q), len(names)):
        raise ValueError(
            f"map must return {len(names)} numbers, {', '.join(names)}, not an array of shape {values.shape[1:]}"
        )
    return names, values
