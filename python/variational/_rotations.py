"""Rotations of bodies: unit quaternions, scalar first."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Array, array


def _quaternion(R: ArrayLike) -> Array:
    found = array(R, "R")
    if found.shape[-1:] != (4,):
        raise ValueError(f"the last axis of R must be the 4 entries of a quaternion, not of shape {found.shape}")
    lengths = np.linalg.norm(found, axis=-1)
    # False for NaN.
    if not (abs(lengths - 1.0) < 1e-6).all():
        raise ValueError("R must be unit quaternions: divide them by np.linalg.norm(R, axis=-1, keepdims=True)")
    return found


def rotation_matrix(R: ArrayLike) -> Array:
    """The matrices (..., 3, 3) of unit quaternions R (..., 4). They turn vectors of the body into space.

    >>> rotation_matrix(sol["R"])
    """
    w, *r = np.moveaxis(_quaternion(R), -1, 0)
    x, y, z = r
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_rate(R: ArrayLike, ω: ArrayLike) -> Array:
    """The velocities (..., 4) of unit quaternions R (..., 4) at the angular velocity ω (..., 3) in the axes of the body.

    >>> top.integrate(q=R, v=quaternion_rate(R, [0.0, 0.0, 30.0]), h=0.01)
    """
    R, ω = _quaternion(R), array(ω, "ω")
    if ω.shape[-1:] != (3,):
        raise ValueError(f"the last axis of ω must be the 3 axes of the body, not of shape {ω.shape}")
    try:
        shape = np.broadcast_shapes(R.shape[:-1], ω.shape[:-1])
    except ValueError:
        raise ValueError(f"R and ω do not broadcast: their shapes are {R.shape} and {ω.shape}") from None
    R, ω = np.broadcast_to(R, (*shape, 4)), np.broadcast_to(ω, (*shape, 3))
    w, r = R[..., :1], R[..., 1:]
    scalar = -np.sum(r * ω, axis=-1, keepdims=True)
    return 0.5 * np.concatenate([scalar, w * ω + np.cross(r, ω)], axis=-1)
