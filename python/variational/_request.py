"""Method and options of a run, checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from . import _core
from ._arrays import number, real
from ._errors import _invalid
from ._names import meant

if TYPE_CHECKING:
    from ._system import System

_MOST = 1e6
"""Steps of h over which a shift is measured; the measurement may halve them."""


@dataclass(slots=True)
class Request:
    """Method and options of a run, as `_core` reads them."""

    method: str
    stages: int | None
    h: float | None
    tolerance: float | None
    dtau: float | None
    shift: float | None
    shift_from: float | None
    fallback: bool


def checked(
    cls: type[System],
    h: float | None,
    tolerance: float | None,
    dtau: float | None,
    method: str | None,
    stages: int | None,
    shift: float | None,
    shift_from: float | None,
    fallback: bool,
) -> Request:
    """The options of a run.

    Raises TypeError for arguments of other types, and for two arguments of which one is needed. `_core` checks which
    options go together, and which methods and stages a system has.
    """
    given = [name for name, value in (("h", h), ("tolerance", tolerance), ("dtau", dtau)) if value is not None]
    if not given:
        raise TypeError("give one of h, tolerance and dtau: h=0.05 is a step of this length")
    if len(given) > 1:
        raise TypeError(f"{' and '.join(given)} were given: give one of h, tolerance and dtau")
    # "gauss-lobatto" is the name of "gauss" with constraints in earlier versions.
    if method is None or method == "gauss-lobatto":
        method = "gauss"
    if method not in _core.METHODS:
        known = ", ".join(f'"{name}"' for name in cls._methods)
        close = meant(method, _core.METHODS) if isinstance(method, str) else ""
        close = close or ": leave method out for Gauss steps"
        raise ValueError(f"there is no method {method!r}{close}; {cls.__name__} has {known}")
    if shift is not None and shift_from is not None:
        raise TypeError("give one of shift and shift_from, not both")
    request = Request(
        method=method,
        stages=_stages(stages),
        h=None if h is None else real(h, "h"),
        tolerance=None if tolerance is None else real(tolerance, "tolerance"),
        dtau=None if dtau is None else real(dtau, "dtau"),
        shift=None if shift is None else number(shift, "shift"),
        shift_from=None if shift_from is None else number(shift_from, "shift_from"),
        fallback=bool(fallback),
    )
    if request.shift_from is not None and request.h and not 0.0 < request.shift_from / request.h <= _MOST:
        raise _invalid("shift_from", f"ahead, and at most {_MOST:g} steps of h", request.shift_from)
    return request


def _stages(stages: int | None) -> int | None:
    if stages is None:
        return None
    if isinstance(stages, bool) or not isinstance(stages, (int, np.integer)):
        raise TypeError(f"stages must be an integer, not {stages!r}")
    if stages < 1:
        raise ValueError(f"stages must be at least 1, not {stages}")
    # Larger numbers do not fit into an integer of Rust.
    return min(int(stages), 2**31)
