"""Names and expressions along a motion: coordinates, velocities, momenta, and any expression of the language.

In: a name or an expression, and points of a motion. Out: the values there, and their derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._arrays import Array
from ._names import among, motion_name, is_plain

if TYPE_CHECKING:
    from ._system import System


@dataclass(frozen=True)
class Observed:
    """A quantity of the states (q, v, p) of a system."""

    text: str
    """Its name, or its expression."""
    place: int | None
    """Its place in (q, v, p); None for an expression."""
    shape: tuple[int, ...] = ()
    """The shape of a vector or a matrix."""

    def values(self, system: System, t: Array, states: Array, numbers: Array) -> Array:
        """The values (K, …) at K points with the states (q, v, p) of shape (K, 3N), and with the numbers of the system at
        each of them or at all."""
        if self.place is not None:
            return states[:, self.place]
        q, v, _ = np.split(states, 3, axis=1)
        return system._evaluated(self.text, t.shape, (t, q, v), numbers)

    def slopes(
        self, system: System, t: Array, states: Array, numbers: Array, wrt: list[int]
    ) -> tuple[Array, Array, Array]:
        """The derivatives with respect to t (K, …), to the states (K, …, 3N), and to the parameters of these indices
        (K, …, P). Raises ValueError for one that is not finite."""
        if self.place is not None:
            of_states = np.zeros_like(states)
            of_states[:, self.place] = 1.0
            return np.zeros(len(t)), of_states, np.zeros((len(t), len(wrt)))
        q, v, p = np.split(states, 3, axis=1)
        observable = system._observable(self.text, wrt)
        found = observable.values((t.tolist(), q.tolist(), v.tolist()), numbers.tolist())
        slopes = np.array(found).reshape(*t.shape, *observable.shape)
        if not np.isfinite(slopes).all():
            raise ValueError(f"{self.text!r} has no finite derivative along the motion")
        of_t, of_q_and_v, of_parameters = np.split(slopes, [1, 1 + 2 * p.shape[1]], axis=-1)
        of_p = np.zeros((*self.shape, p.shape[1]))
        of_states = np.concatenate([of_q_and_v, np.broadcast_to(of_p, (len(t), *of_p.shape))], axis=-1)
        return of_t[..., 0], of_states, of_parameters


def observed(text: str, cls: type[System]) -> Observed:
    """What a name or an expression means in a system. A momentum is `p_x`.

    Raises KeyError for an unknown name, and ValueError for a wrong expression.
    """
    n = len(cls.coordinates)
    try:
        is_velocity, index = motion_name(text, cls.coordinates, cls.__name__)
    except KeyError as unknown:
        try:
            return Observed(text, None, tuple(cls._observable(text).shape))
        except ValueError as error:
            momentum = among(text.removeprefix("p_"), cls.coordinates)
            if text.startswith("p_") and momentum in cls.coordinates:
                return Observed(f"p_{momentum}", 2 * n + cls.coordinates.index(momentum))
            raise (unknown if is_plain(text) else error) from None
    name = cls.coordinates[index]
    return Observed(f"dot({name})" if is_velocity else name, index + n * is_velocity)
