"""States on constraints."""

from __future__ import annotations

from typing import NamedTuple

from ._arrays import Array
from ._calls import unassignable


@unassignable()
class Projected(NamedTuple):
    """A state on the constraints, and how far it is from the given one; of many states with an axis of M before N."""

    q: Array
    """Coordinates, (N,)."""
    v: Array
    """Velocities, (N,)."""
    moved_q: Array
    """Changes of the coordinates, (N,)."""
    moved_v: Array
    """Changes of the velocities, (N,)."""
