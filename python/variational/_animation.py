"""Animations of motions in a plane."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Array, array, number
from ._calls import unfit

if TYPE_CHECKING:
    from ._solution import Solution
    from ._system import System

_WITHIN = 4
"""Points of a path for each frame, so that it has no corners."""

_MARGIN = 0.08
"""Of the frame, relative to the larger side of the motion."""


def animated(
    solution: Solution,
    points: Callable[[Array], Any] | None,
    trace: int | None,
    fps: float,
    speed: float,
    axes: Any,
) -> Any:
    """The animation; see `Solution.animate`."""
    try:
        import matplotlib.pyplot as plt
        from matplotlib.animation import FuncAnimation
    except ImportError:
        raise ImportError("animate needs matplotlib: pip install matplotlib") from None
    fps, speed = (_positive(value, name) for value, name in ((fps, "fps"), (speed, "speed")))
    if len(solution) < 2:
        raise ValueError("animate needs a solution of two rows or more")
    times = _times(solution.t[0], solution.t[-1], speed / (fps * _WITHIN))
    q = solution.states(times)[0]
    if points is None:
        drawn, trace = _ready(solution.system, q, trace)
    else:
        drawn = _called(points, q)
    if trace is not None and not -drawn.shape[1] <= trace < drawn.shape[1]:
        raise ValueError(f"trace must be the index of one of {drawn.shape[1]} points, not {trace}")
    if axes is None:
        _, axes = plt.subplots(figsize=(5, 5), layout="constrained")
    _frame(axes, drawn)
    path = axes.plot([], [], lw=1, color="tab:orange")[0]
    bars = axes.plot([], [], "o-", lw=2, color="tab:blue")[0]
    clock = axes.text(0.02, 0.98, "", transform=axes.transAxes, va="top")

    def draw(frame: int) -> tuple[Any, ...]:
        now = frame * _WITHIN
        if trace is not None:
            path.set_data(drawn[: now + 1, trace, 0], drawn[: now + 1, trace, 1])
        bars.set_data(drawn[now, :, 0], drawn[now, :, 1])
        clock.set_text(f"t = {times[now]:.2f}")
        return path, bars, clock

    frames = 1 + (len(times) - 1) // _WITHIN
    return FuncAnimation(axes.figure, draw, frames=frames, interval=1000.0 / fps, blit=True)


def _times(start: float, end: float, between: float) -> Array:
    """Times at a constant distance, which begin at the start."""
    count = math.floor(abs(end - start) / between * (1.0 + 1e-12))
    times = start + math.copysign(between, end - start) * np.arange(count + 1)
    return np.clip(times, min(start, end), max(start, end))


def _called(points: Callable[[Array], Any], q: Array) -> Array:
    """The points of each frame, (K, P, 2)."""
    if not callable(points):
        raise TypeError(f"points must be a function of q, not {points!r}")
    if (arguments := unfit(points, 1)) is not None:
        raise TypeError(f"points must be a function of one argument, the coordinates q, not of {arguments}")
    frames = [array(points(row), "the points") for row in q]
    for found in frames:
        if found.ndim != 2 or found.shape[1] != 2 or found.shape != frames[0].shape:
            raise ValueError(
                f"points must return the same number of pairs (x, y) at all times, not the shape {found.shape}"
            )
    return np.array(frames)


def _frame(axes: Any, drawn: Array) -> None:
    """A frame with equal scales, which contains all points."""
    if not np.isfinite(drawn).any(axis=(0, 1)).all():
        raise ValueError("points returns no finite point")
    low, high = (of(drawn, axis=(0, 1)) for of in (np.nanmin, np.nanmax))
    margin = _MARGIN * (float(np.max(high - low)) or 1.0)
    axes.set_aspect("equal")
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)


def _ready(system: System, q: Array, trace: int | None) -> tuple[Array, int | None]:
    """The points of a ready system, and the index of the one whose path is drawn."""
    name = type(system).__name__
    if type(system).__module__ != __package__ or name not in _DRAWINGS:
        raise TypeError(
            f"{name} has no drawing of its own: give points, a function of q that returns pairs (x, y), such as "
            "points=lambda q: [(0.0, 0.0), (np.sin(q[0]), -np.cos(q[0]))]"
        )
    points, traced = _DRAWINGS[name]
    drawn = np.stack([np.broadcast_arrays(*point) for point in points(system, q.T)])
    return np.ascontiguousarray(np.moveaxis(drawn.astype(float), -1, 0)), traced if trace is None else trace


def _hanging(lengths: Any, angles: Array) -> list[Any]:
    """The joints of rods in absolute angles, below a pivot at the origin."""
    lengths = np.asarray(lengths)[:, None]
    x, y = np.cumsum(lengths * np.sin(angles), axis=0), -np.cumsum(lengths * np.cos(angles), axis=0)
    return [(0.0 * x[0], 0.0), *zip(x, y, strict=True)]


def _apart(x: Array, y: Array) -> list[Any]:
    """Points without lines between them: a gap follows each."""
    return [place for pair in zip(x, y, strict=True) for place in (pair, (np.nan * pair[0], np.nan))][:-1]


def _chain(q: Array) -> list[Any]:
    """Joints at (q0, q1), (q2, q3), … below the origin."""
    return [(0.0 * q[0], 0.0), *zip(q[::2], q[1::2], strict=True)]


_DRAWINGS: dict[str, tuple[Callable[[Any, Array], list[Any]], int | None]] = {
    "Pendulum": (lambda s, q: _hanging([s.l], q), None),
    "DoublePendulum": (lambda s, q: _hanging([s.l1, s.l2], q), -1),
    "NPendulum": (lambda s, q: _hanging([s.l] * len(q), q), -1),
    "RodPendulum": (lambda s, q: _chain(q), None),
    "DoubleRodPendulum": (lambda s, q: _chain(q), -1),
    "RodChain": (lambda s, q: _chain(q), -1),
    "FourBar": (lambda s, q: [*_chain(q), (s.d + 0.0 * q[0], 0.0)], 2),
    "SliderCrank": (
        lambda s, q: [(0.0 * q[0], 0.0), (s.r * np.cos(q[0]), s.r * np.sin(q[0])), (q[2], 0.0 * q[2])],
        None,
    ),
    "Kepler": (lambda s, q: _apart(np.array([0.0 * q[0], q[0]]), np.array([0.0 * q[1], q[1]])), 2),
    "ThreeBody": (lambda s, q: _apart(q[:3], q[3:]), None),
}
"""Drawings of ready systems, from the system and q of shape (N, K), and the point whose path is drawn."""


def _positive(value: Any, name: str) -> float:
    found = number(value, name)
    if found <= 0.0:
        raise ValueError(f"{name} must be positive, not {found!r}")
    return found
