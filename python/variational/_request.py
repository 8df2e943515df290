"""Method and options of a run, checked."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._arrays import number, real
from ._errors import _invalid
from ._names import meant

if TYPE_CHECKING:
    from ._system import System

_MOST = 1e6
"""Steps of h over which a shift is measured; the measurement may halve them."""


_BY_RULE = ("fixed", "suzuki-4", "kahan-li-6", "kahan-li-8")
"""Methods that need a rule."""


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

    Raises TypeError or ValueError for options that do not go together, and InvalidInput for wrong numbers.
    """
    given = [name for name, value in (("h", h), ("tolerance", tolerance), ("dtau", dtau)) if value is not None]
    if not given:
        raise TypeError("give one of h, tolerance and dtau: h=0.05 is a step of this length")
    if len(given) > 1:
        raise TypeError(f"{' and '.join(given)} were given: give one of h, tolerance and dtau")
    # "gauss-lobatto" is the name of "gauss" with constraints in earlier versions.
    if method is None or method == "gauss-lobatto":
        method = "gauss"
    if method not in cls._methods:
        known = ", ".join(f'"{name}"' for name in cls._methods)
        close = meant(method, cls._methods) if isinstance(method, str) else ""
        more = "" if getattr(cls, "_source", None) is None else ". The argument methods of compile builds others"
        why = ", and has constraints, which other methods do not keep" if cls.constraints else ""
        if method in ("splitting-4", "splitting-6") and not cls.constraints:
            why = "; a splitting needs a constant mass matrix and forces without velocities"
        elif method in _BY_RULE and not cls.constraints and "discretize" not in cls.definition:
            why = f"; {method} needs the clause `discretize midpoint;` in the text"
        raise ValueError(f"{cls.__name__} has no method {method!r}{close}; it has {known}{why}{more}")
    if method != "energy" and (shift is not None or shift_from is not None or fallback):
        raise ValueError('shift, shift_from and fallback are options of method="energy"')
    if dtau is not None and method != "gauss":
        raise ValueError(f'dtau is an option of method="gauss": give h or tolerance for method={method!r}')
    if shift is not None and shift_from is not None:
        raise TypeError("give one of shift and shift_from, not both")
    if stages is not None and method not in ("gauss", "adaptive", "energy"):
        raise ValueError(f"method={method!r} has no stages: leave out stages=")
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
    for name, value in (("h", request.h), ("dtau", request.dtau)):
        if value is not None and (value == 0.0 or not math.isfinite(value)):
            raise _invalid(name, "finite and not zero", value)
    if request.tolerance is not None and not 0.0 < request.tolerance < math.inf:
        raise _invalid("tolerance", "positive and finite", request.tolerance)
    if request.shift_from is not None and request.h is not None and not 0.0 < request.shift_from / request.h <= _MOST:
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
