"""Bodies that hang on each other by joints: the common form of the files of robots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from xml.etree import ElementTree

import numpy as np

from ._arrays import Array


@dataclass
class Inertia:
    """Mass, centre of mass, and moments of inertia about it, in the axes of a body."""

    mass: float = 0.0
    center: Array = field(default_factory=lambda: np.zeros(3))
    moments: Array = field(default_factory=lambda: np.zeros((3, 3)))

    def __add__(self, other: Inertia) -> Inertia:
        mass = self.mass + other.mass
        if mass == 0.0:
            return Inertia(0.0, self.center, self.moments + other.moments)
        center = (self.mass * self.center + other.mass * other.center) / mass
        return Inertia(mass, center, self._about(center) + other._about(center))

    def moved(self, place: Place) -> Inertia:
        """The same inertia in the axes in which its body has this place."""
        return Inertia(self.mass, place.point(self.center), place.axes @ self.moments @ place.axes.T)

    def scaled(self, factor: float) -> Inertia:
        return Inertia(self.mass * factor, self.center, self.moments * factor)

    def _about(self, point: Array) -> Array:
        d = self.center - point
        return self.moments + self.mass * (d @ d * np.eye(3) - np.outer(d, d))


@dataclass
class Place:
    """Origin and axes of a body; the axes are the columns."""

    origin: Array = field(default_factory=lambda: np.zeros(3))
    axes: Array = field(default_factory=lambda: np.eye(3))

    def point(self, r: Array) -> Array:
        return self.origin + self.axes @ r

    def then(self, inner: Place) -> Place:
        """The place of what has the place `inner` in this one."""
        return Place(self.point(inner.origin), self.axes @ inner.axes)

    def inverse(self) -> Place:
        return Place(-self.axes.T @ self.origin, self.axes.T)


@dataclass
class Joint:
    """A joint between a body and its parent. Angles are in radians."""

    name: str
    kind: str
    """"hinge", "slide", "ball" or "free"."""
    axis: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    """Unit vector in the axes of the body."""
    pos: Array = field(default_factory=lambda: np.zeros(3))
    """A point of the axis, in the axes of the body."""
    ref: float = 0.0
    """The coordinate in the configuration that the file describes."""
    stiffness: float = 0.0
    spring_ref: float = 0.0
    damping: float = 0.0
    armature: float = 0.0
    is_limited: bool = False


@dataclass
class Body:
    """A body, at a place of its parent."""

    name: str
    parent: int | None
    place: Place
    joints: list[Joint] = field(default_factory=list)
    inertia: Inertia = field(default_factory=Inertia)
    carried: float = 0.0
    """The part of its weight that is compensated."""
    without_inertia: str = ""
    """What has an inertia that the file does not state."""


@dataclass
class Motor:
    """The force gain · (1, length, rate) u + bias · (1, length, rate) along `gear` of a joint. The length is
    gear · coordinate, the rate its velocity."""

    name: str
    joint: str
    gear: tuple[float, ...]
    gain: tuple[float, float, float] = (1.0, 0.0, 0.0)
    bias: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def reads_length(self) -> bool:
        return self.gain[1] != 0.0 or self.bias[1] != 0.0


@dataclass
class Point:
    """Two points of two bodies are one."""

    name: str
    bodies: tuple[int | None, int | None]
    points: tuple[Array, Array]


@dataclass
class Attitude:
    """The axes of the second body are at `axes` in those of the first."""

    name: str
    bodies: tuple[int | None, int | None]
    axes: Array


@dataclass
class Coupling:
    """A coordinate less its ref is a polynomial of another one less its ref."""

    name: str
    joints: tuple[str, str | None]
    coefficients: tuple[float, ...]


@dataclass
class Mechanism:
    """Bodies in an order in which parents come first. A parent None is the world."""

    name: str
    bodies: list[Body] = field(default_factory=list)
    gravity: Array = field(default_factory=lambda: np.array([0.0, 0.0, -9.81]))
    motors: list[Motor] = field(default_factory=list)
    constraints: list[Point | Attitude | Coupling] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    """What the text does not have."""

    def joints(self) -> dict[str, Joint]:
        found: dict[str, Joint] = {}
        for joint in (joint for body in self.bodies for joint in body.joints):
            if joint.name in found:
                raise ValueError(f"two joints have the name {joint.name!r}")
            found[joint.name] = joint
        return found

    def leave_out(self, what: str) -> None:
        """Lists what the text does not have, once."""
        if what not in self.left_out:
            self.left_out.append(what)

    def places(self) -> list[Place]:
        """The places of the bodies in the configuration of the file."""
        found: list[Place] = []
        for body in self.bodies:
            found.append(body.place if body.parent is None else found[body.parent].then(body.place))
        return found


def numbers(
    element: ElementTree.Element | dict[str, str], name: str, counts: int | range, of: str
) -> list[float] | None:
    """The numbers of an attribute; None without it. Raises ValueError if their count is another one."""
    text = element.get(name)
    if text is None:
        return None
    try:
        found = [float(word) for word in text.split()]
    except ValueError:
        raise ValueError(f'{of} has {name}="{text}", which are not numbers') from None
    allowed = [counts] if isinstance(counts, int) else counts
    if len(found) not in allowed or not np.isfinite(found).all():
        wanted = f"{allowed[0]}" if len(allowed) == 1 else f"{allowed[0]} to {allowed[-1]}"
        raise ValueError(f'{of} has {name}="{text}": write {wanted} finite numbers')
    return found


def single(element: ElementTree.Element | dict[str, str], name: str, of: str, usual: float = 0.0) -> float:
    """The one number of an attribute, `usual` without it."""
    return (numbers(element, name, 1, of) or [usual])[0]


def symmetric(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> Array:
    """The symmetric matrix of these entries."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def unit(vector: Sequence[float] | Array, of: str) -> Array:
    """The vector divided by its length."""
    found = np.asarray(vector, dtype=float)
    # Squares of large numbers are not finite.
    size = max(1.0, float(np.abs(found).max()))
    length = float(np.linalg.norm(found / size))
    if length * size < 1e-14:
        raise ValueError(f"{of} has the length 0: write a vector with a direction")
    return found / size / length


def of_quaternion(q: Sequence[float] | Array, of: str) -> Array:
    """The matrix of a quaternion, scalar first; its length need not be 1."""
    return rotation_matrix(unit(q, f"the quaternion of {of}"))


def rotation_matrix(q: Array) -> Array:
    """The matrix of a unit quaternion."""
    w, x, y, z = q
    return np.array([
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ])  # fmt: skip


def about(axis: Array, angle: complex) -> Array:
    """The matrix of the rotation about a unit vector. A complex angle gives derivatives."""
    x, y, z = axis
    crossed = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * crossed + (1.0 - np.cos(angle)) * (crossed @ crossed)


def quaternion_of(axes: Array) -> Array:
    """The unit quaternion of a rotation matrix, with a scalar that is not negative."""
    # The largest of the four numbers is not small.
    xx, yy, zz = np.diag(axes)
    squares = np.array([1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz])
    a, b, c = axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]
    d, e, f = axes[0, 1] + axes[1, 0], axes[0, 2] + axes[2, 0], axes[1, 2] + axes[2, 1]
    rows = np.array([
        [squares[0], a, b, c],
        [a, squares[1], d, e],
        [b, d, squares[2], f],
        [c, e, f, squares[3]],
    ])  # fmt: skip
    found = unit(rows[np.argmax(squares)], "a quaternion")
    return found if found[0] >= 0.0 else -found


def about_z_to(direction: Array) -> Array:
    """The least rotation that turns the axis z to a unit vector."""
    axis = np.cross([0.0, 0.0, 1.0], direction)
    sine = float(np.linalg.norm(axis))
    angle = math.atan2(sine, float(direction[2]))
    return about(axis / sine if sine > 1e-14 else np.array([1.0, 0.0, 0.0]), angle)
