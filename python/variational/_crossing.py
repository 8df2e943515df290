"""Derivatives at an event of a momentum or an expression.

In: a run, and the time of its event. Out: the derivatives of the state there, and of the time. The steps know such
derivatives at a fixed time, and at an event of a coordinate or a velocity. Both differ by a multiple of the direction
along which the state moves with the time of the end.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ._arrays import Array
from ._errors import NoDerivative, StepError  # type: ignore[attr-defined]

if TYPE_CHECKING:
    from ._observed import Observed
    from ._run import Run


class Crossing:
    """The event of a run at a time."""

    def __init__(self, run: Run, of: Observed, t: float):
        self.run, self.of, self.t = run, of, t
        self.n = len(run._cls.coordinates)

    def tangent(self, indices: list[int], velocities: bool) -> Array:
        """The derivatives of (q, p, t), or (q, v, t), as of `Run._tangent`. The run ends at the event."""
        fixed = self._both(lambda at_end: self.run.copy()._tangent(indices, t=self.t, velocities=[velocities, at_end]))
        along = self._along()
        self.run._tangent([], t=self.t)
        rate, of_states, of_parameters = self._slopes(indices, along)
        change = of_states @ self._states(fixed)
        change[2 * self.n :] += of_parameters
        return fixed[velocities] - np.outer(along[velocities], change / rate)

    def gradient(self, indices: list[int], slope: Array, velocities: bool) -> Array:
        """The gradient of slope·(q, p, t), or slope·(q, v, t), as of `Run._gradient`. The run ends at the event."""
        along, start = self._along(), self.run.copy()
        found = self.run._gradient(indices, slope, t=self.t, velocities=[velocities, velocities])
        rate, of_states, of_parameters = self._slopes(indices, along)
        of_q_and_v, of_p = np.split(of_states, [2 * self.n])
        for part, at_end in (([*of_q_and_v, 0.0], True), ([*np.zeros(self.n), *of_p, 0.0], False)):
            if np.any(part):
                change = start.copy()._gradient(indices, np.array(part), t=self.t, velocities=[velocities, at_end])
                found = found - slope @ along[velocities] / rate * change
        found[2 * self.n :] -= slope @ along[velocities] / rate * of_parameters
        return found

    def _slopes(self, indices: list[int], along: dict[bool, Array]) -> tuple[float, Array, Array]:
        """The rate of the quantity along the motion, and its derivatives with respect to (q, v, p) and parameters."""
        run = self.run
        states = np.concatenate([run.q, run.v, run.p])[None]
        of_t, of_states, of_parameters = self.of.slopes(
            run.system, np.array([run.t]), states, run.system._values[None], indices
        )
        rate = of_t[0] + of_states[0] @ self._states(along)
        if rate == 0.0:
            message = f"{self.of.text!r} has a derivative along the trajectory that is zero"
            raise NoDerivative(message, message, {"t": self.t, "because": message})
        return rate, of_states[0], of_parameters[0]

    def _along(self) -> dict[bool, Array]:
        """The direction of (q, p, t), and of (q, v, t), with the time of the end: from an event of a coordinate, or else
        of a velocity, at the same time."""
        end = self.run.copy()
        fixed = self._both(lambda at_end: self.run.copy()._tangent([], t=self.t, velocities=[False, at_end]))
        end._run.advance(self.t, None, 1, False)
        fastest = np.argsort(-np.abs(end.v))
        for is_velocity, index in [(kind, int(index)) for kind in (False, True) for index in fastest]:
            event = (is_velocity, index, float((end.v if is_velocity else end.q)[index]), 0)
            run = self.run.copy()
            try:
                moved = {False: run._tangent([], t=self.t, event=event)}
                if abs(run.t - self.t) > _SAME * abs(run.h):
                    # The coordinate had this value before.
                    continue
                moved[True] = self.run.copy()._tangent([], t=self.t, event=event, velocities=[False, True])
            except StepError:
                continue
            change = moved[False][-1]
            if np.any(change):
                return self._both(lambda at_end: (moved[at_end] - fixed[at_end]) @ change / (change @ change))
        message = "no coordinate and no velocity changes at the event"
        raise NoDerivative(message, message, {"t": self.t, "because": message})

    def _states(self, of: dict[bool, Array]) -> Array:
        """The rows of (q, v, p), of those of (q, p, t) and (q, v, t)."""
        return np.concatenate([of[True][: 2 * self.n], of[False][self.n : 2 * self.n]])

    def _both(self, of: Callable[[bool], Array]) -> dict[bool, Array]:
        """A value for momenta, and one for velocities."""
        return {at_end: of(at_end) for at_end in (False, True)}


_SAME = 1e-6
"""Times of events at the same place differ by rounding, in steps."""
