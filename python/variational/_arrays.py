"""Arguments as arrays of floats, with messages that name the argument."""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import _invalid

Array = NDArray[np.float64]


def array(value: ArrayLike, name: str) -> Array:
    """The argument as an array of floats.

    Raises TypeError for values that are not real numbers.
    """
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value
    try:
        found = np.asarray(value)
        if found.dtype.kind not in "fiub":
            # Lists of unequal lengths are objects; texts and complex numbers would be converted silently.
            raise TypeError
        return found.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} must be real numbers in a list or an array, not {_shown(value)}") from None


def vector(value: ArrayLike, size: int, name: str, coordinates: tuple[str, ...]) -> Array:
    """The argument as a contiguous vector of this size with finite entries."""
    if isinstance(value, Mapping):
        raise TypeError(f"{name} must be a list in the order {', '.join(coordinates)}, not a dict")
    if isinstance(getattr(value, "q", None), np.ndarray):
        raise TypeError(f"{name} must be a list of numbers, not {type(value).__name__}: write its .q, and its .v for v")
    found = array(value, name)
    if found.shape != (size,):
        if found.ndim == 0 and size == 1:
            found = found.reshape(1)
        else:
            wanted = ", ".join(coordinates)
            raise ValueError(f"{name} must have {size} {_entries(size)} ({wanted}), not the shape {found.shape}")
    finite(found, name)
    return np.ascontiguousarray(found)


def fixed(values: Array) -> Array:
    """The array, which can no longer be written."""
    values.flags.writeable = False
    return values


def finite(values: Array, name: str) -> None:
    """Raises InvalidInput if an entry is infinite or not a number."""
    # For a few entries quicker than numpy.
    if values.ndim == 1 and values.size <= 32 and all(map(math.isfinite, values.tolist())):
        return
    if not np.isfinite(values).all():
        index = tuple(int(i) for i in np.argwhere(~np.isfinite(values))[0])
        place = name + (f"[{', '.join(map(str, index))}]" if index else "")
        raise _invalid(place, "finite", float(values[index]))


def number(value: Any, name: str) -> float:
    """The argument as a finite float."""
    found = real(value, name)
    if not math.isfinite(found):
        raise _invalid(name, "finite", found)
    return found


def real(value: Any, name: str) -> float:
    """The argument as a float."""
    if type(value) is float:
        return value
    try:
        if isinstance(value, (str, bytes, complex)):
            raise TypeError
        if np.ndim(value) != 0:
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} must be a real number, not {_shown(value)}") from None


def count(value: Any, name: str, least: int = 0) -> int:
    """The argument as an integer from `least` to 2⁶⁴ − 1."""
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be an integer, not {_shown(value)}") from None
    if not least <= found < 2**64:
        raise ValueError(f"{name} must be an integer from {least} to 2**64 - 1, not {found}")
    return found


def ordered(times: ArrayLike, h: float) -> Array:
    """The times as an array (K,) in the order of a run with the step h."""
    wanted = array(times, "times")
    if wanted.ndim > 1:
        raise ValueError(f"times must be a list of times, not of shape {wanted.shape}")
    wanted = np.ascontiguousarray(wanted.reshape(-1))
    finite(wanted, "times")
    if np.any(np.diff(wanted) * np.sign(h) < 0.0):
        raise ValueError(f"times must be {'ascending' if h > 0.0 else 'descending, since h is negative'}")
    return wanted


def _entries(count: int) -> str:
    return "entry" if count == 1 else "entries"


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
