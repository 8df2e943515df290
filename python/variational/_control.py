"""What a controller asks of a system: linearizations and equilibria."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._arrays import Array
from ._calls import unassignable


@unassignable()
@dataclass(frozen=True, eq=False)
class Linearization:
    """A linearization: `value + A @ dx + B @ du` to first order.

    Of a system, x = (q, v) and the value is dx/dt. Of a run, x = (q, p) and the value is x at the end of the next step.
    """

    t: float
    """Time of the point of linearization; of a step, of its start."""
    value: Array
    """The value there, (2N,)."""
    A: Array
    """Derivatives with respect to x, (2N, 2N)."""
    B: Array
    """Derivatives with respect to the inputs, (2N, M), in the order of their declaration."""


@unassignable()
@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A state of rest.

    Small motions about it are `q + directions @ x` with `mass @ x'' + damping @ x' + stiffness @ x = 0`.
    """

    t: float
    """Time."""
    q: Array
    """Coordinates, (N,)."""
    multipliers: Array
    """The multiplier of each constraint, (C,)."""
    directions: Array
    """A basis of the D directions that the constraints allow, (N, D); without constraints the identity."""
    mass: Array
    """The mass matrix along the directions, (D, D)."""
    damping: Array
    """Damping and gyroscopic terms along them, (D, D)."""
    stiffness: Array
    """Stiffness along them, (D, D)."""
    free: tuple[bool, ...]
    """For each coordinate, whether nothing depends on it here. It then has the value of the guess. With constraints,
    whether it changes along a motion along which the forces do not, as the turn of a top about the vertical."""
    residual: float
    """Largest unbalanced force on a coordinate, divided by the bound of its rounding error: a number without a unit.
    Numbers below ten are rounding."""
    rates: NDArray[np.complex128]
    """The 2D rates of small motions exp(rate t), in radians per unit of time. One with a positive real part grows."""

    @property
    def frequencies(self) -> Array:
        """The frequencies of oscillations about it, ascending, in radians per unit of time."""
        return self.rates.imag[self.rates.imag > 0]
