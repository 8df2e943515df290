"""The text of a system of bodies and joints, in the language of `lagrangian!`.

All axes are those of the world in the configuration of the file: the matrix of a hinge is then the identity there, and
most axes of joints are coordinate axes. Below a ball or a free joint they are the axes of its body.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ._arrays import Array
from ._mechanism import (
    Attitude,
    Body,
    Coupling,
    Inertia,
    Joint,
    Mechanism,
    Motor,
    Place,
    Point,
    about,
    quaternion_of,
    rotation_matrix,
)  # fmt: skip

WORDS = """
t i pi L f self dot sum sqrt exp ln abs sign sin cos tan asin acos atan atan2 sinh cosh tanh hypot pow max min clamp
cross norm transpose rate spin turn about about_x about_y about_z g T W f64 bool str usize
param coord angle rotation input table force torque space_torque dissipation constraint time_scale discretize check
as async await break const continue crate dyn else enum extern false fn for if impl in let loop match mod move mut pub
ref return static struct super trait true type unsafe use where while abstract become box do final gen macro override
priv try typeof unsized virtual yield union Self
"""
"""Names that a text cannot take, and those that it uses itself."""

PARAMETERS, PARAMETERS_WITH_CONSTRAINTS = 32, 64
"""The most parameters of a text."""

LONGEST = 100
"""The most letters that a name keeps."""

Coordinates = dict[str, Array]
"""The coordinates of each joint, by its name."""

TRIALS = 3
"""Configurations at which zeros are looked for."""

NEWTON = 30
"""The most iterations that close the loops of a mechanism."""

EXPLICIT = '<compiler saveinertial="true"/> and mujoco.mj_saveLastXML write such a file from any model'

STEP = 1e-30
"""The step of complex derivatives, which lose no digits by it."""


class Names:
    """Names of the language that are taken once."""

    def __init__(self) -> None:
        self.taken = set(WORDS.split())

    def new(self, wanted: str, prefix: str = "") -> str:
        name = prefix + _letters(wanted)[:LONGEST]
        if not re.match(r"(?!_$)[^\W\d]", name):
            name = f"q_{name}"
        found, count = name, 1
        while found in self.taken:
            count += 1
            found = f"{name}_{count}"
        self.taken.add(found)
        return found


@dataclass(eq=False)
class Frame:
    """What moves with a joint. It begins at `start` in the axes of the frame before it."""

    before: Frame | None
    joint: Joint
    name: str
    start: Array = field(default_factory=lambda: np.zeros(3))
    axis: Array = field(default_factory=lambda: np.zeros(3))
    axes: Array = field(default_factory=lambda: np.eye(3))
    """Its axes at the identity of a ball joint."""
    coordinate: str = ""
    rotation: str = ""

    @property
    def turning(self) -> Frame:
        """The last frame with axes of its own."""
        return self.before.turning if self.before is not None and self.joint.kind == "slide" else self

    def line(self) -> list[Frame]:
        """This frame and those before it, without the world."""
        return [] if self.before is None else [self, *self.before.line()]

    def place(self, q: Coordinates) -> Place:
        """Origin and axes at these coordinates, which may be complex."""
        if self.before is None:
            return Place()
        at = q[self.joint.name]
        if self.joint.kind == "free":
            return Place(at[:3], rotation_matrix(at[3:]))
        before = self.before.place(q)
        if self.joint.kind == "slide":
            return Place(before.point(self.start + self.axis * (at[0] - self.joint.ref)), before.axes)
        own = self.axes @ rotation_matrix(at) if self.joint.kind == "ball" else about(self.axis, at[0] - self.joint.ref)
        return Place(before.point(self.start), before.axes @ own)


@dataclass
class Spot:
    """A point as a name and a vector in the axes of a frame, whose entries may contain coordinates."""

    name: str
    frame: Frame
    vector: Array
    moving: tuple[tuple[str, Array], ...] = ()

    def is_constant(self) -> bool:
        return not self.name and not self.moving


class Writer:
    """Writes the text of a mechanism."""

    def __init__(self, mechanism: Mechanism):
        self.mechanism = mechanism
        self.names = Names()
        self.world = Frame(None, Joint("world", "fixed"), "world")
        self.frames: list[Frame] = []
        self.bodies: list[tuple[Frame, Place]] = []
        """The frame of each body, and its place there."""
        self.lets: list[str] = []
        self.functions: set[str] = set()
        self.parameters: list[tuple[str, float, str]] = []
        """Name, value and meaning."""
        self.spots: dict[Frame, Spot] = {self.world: Spot("", self.world, np.zeros(3))}
        self.matrices: dict[Frame, str] = {self.world: ""}
        self.rates: dict[Frame, str] = {self.world: ""}
        self.sums: dict[Frame, str] = {}
        self.centres: dict[tuple[object, ...], str] = {}
        self.build()

    # Frames.

    def build(self) -> None:
        """The frames of the joints, and the inertia that moves with each."""
        self.title = self.names.new(
            "".join(word[:1].upper() + word[1:] for word in re.split(r"\W|_", self.mechanism.name)) or "Robot"
        )
        for body in self.mechanism.bodies:
            frame, at = (self.world, Place()) if body.parent is None else self.bodies[body.parent]
            at = at.then(body.place)
            for joint in body.joints:
                name = body.name if joint is body.joints[-1] else joint.name
                frame, at = self._moved(frame, at, joint, name)
            self.bodies.append((frame, at))
        self.by_joint = {frame.joint.name: frame for frame in self.frames}
        self.inertias: dict[Frame, Inertia] = {}
        self.weights: dict[Frame, Inertia] = {}
        for body, (frame, at) in zip(self.mechanism.bodies, self.bodies, strict=True):
            if frame is self.world:
                continue
            own = body.inertia.moved(at)
            self.inertias[frame] = self.inertias.get(frame, Inertia()) + own
            self.weights[frame] = self.weights.get(frame, Inertia()) + Inertia(
                own.mass * (1.0 - body.carried), own.center
            )

    def _moved(self, before: Frame, at: Place, joint: Joint, name: str) -> tuple[Frame, Place]:
        made = Frame(before, joint, name, start=at.point(joint.pos), axis=_clean(at.axes @ joint.axis), axes=at.axes)
        self.frames.append(made)
        made.coordinate = self.names.new(joint.name)
        if joint.kind == "ball":
            made.rotation = made.coordinate
        if joint.kind == "free":
            made.rotation = self.names.new(f"{joint.name}_R")
        if joint.kind == "slide":
            made.start = at.origin
            return made, Place(np.zeros(3), at.axes)
        if joint.kind == "hinge":
            return made, Place(-at.axes @ joint.pos, at.axes)
        return made, Place(np.zeros(3) if joint.kind == "free" else -joint.pos, np.eye(3))

    # Numbers.

    def draws(self) -> list[Coordinates]:
        """Configurations in which nothing is zero by chance."""
        random = np.random.default_rng(57)
        found = []
        for _ in range(TRIALS):
            q = {}
            for frame in self.frames:
                count = {"ball": 4, "free": 7}.get(frame.joint.kind, 1)
                at = random.uniform(0.3, 1.2, count).astype(complex)
                if count > 1:
                    at[-4:] /= np.linalg.norm(at[-4:])
                q[frame.joint.name] = at
            found.append(q)
        return found

    # Expressions.

    def let(self, name: str, prefix: str, value: str) -> str:
        made = self.names.new(name, prefix)
        self.lets.append(f"let {made} = {value};")
        return made

    def about(self, axis: Array, angle: str) -> str:
        """The matrix of a rotation."""
        if np.count_nonzero(axis) == 1:
            at = int(np.argmax(np.abs(axis)))
            self.functions.add("xyz"[at])
            return f"about_{'xyz'[at]}({'' if axis[at] > 0 else '-'}{angle})"
        self.functions.add("n")
        return f"about({_vector(axis)}, {angle})"

    def chain(self, frame: Frame) -> tuple[Frame, Array, list[tuple[str, float]]]:
        """Hinges about one axis add their angles: the frame before them, the axis, and the angles with their signs."""
        joint, before = frame.joint, frame.before.turning
        own = _less(frame.coordinate, joint.ref)
        if before.joint.kind == "hinge":
            base, axis, angles = self.chain(before)
            for sign in (1.0, -1.0):
                if np.allclose(frame.axis, sign * axis, rtol=0.0, atol=1e-15):
                    return base, axis, [*angles, (own, sign)]
        return before, frame.axis, [(own, 1.0)]

    def angle(self, frame: Frame) -> tuple[Frame, Array, str]:
        """The same with the sum of the angles as one name."""
        base, axis, angles = self.chain(frame)
        if len(angles) == 1:
            return base, axis, angles[0][0]
        if frame not in self.sums:
            before = self.angle(frame.before.turning)[2]
            own, sign = angles[-1]
            self.sums[frame] = self.let(frame.name, "a_", _sum([before, own if sign > 0 else f"-{own}"]))
        return base, axis, self.sums[frame]

    def spin(self, frame: Frame) -> tuple[Array, str] | None:
        """Axis and angle of a frame that turns about a fixed axis."""
        frame = frame.turning
        if frame.joint.kind != "hinge":
            return None
        base, axis, angle = self.angle(frame)
        return (axis, _plain(angle)) if base is self.world else None

    def own_matrix(self, frame: Frame) -> str:
        """The rotation of a ball or a free joint, in the axes before it."""
        matrix = f"transpose([{', '.join(f'turn({frame.rotation}, {_vector(axis)})' for axis in np.eye(3))}])"
        axes = np.eye(3) if frame.joint.kind == "free" else _clean(frame.axes)
        return matrix if np.array_equal(axes, np.eye(3)) else f"{_matrix(axes)} * {matrix}"

    def matrix(self, frame: Frame) -> str:
        """The name of the matrix of the axes of a frame; empty for those of the world."""
        frame = frame.turning
        if frame not in self.matrices:
            if frame.joint.kind == "hinge":
                before, axis, angle = self.angle(frame)
                own = self.about(axis, angle)
            else:
                before, own = self.before(frame), self.own_matrix(frame)
            outer = self.matrix(before)
            self.matrices[frame] = self.let(frame.name, "R_", f"{outer} * {own}" if outer else own)
        return self.matrices[frame]

    def before(self, frame: Frame) -> Frame:
        """The frame in whose axes a joint is."""
        return self.world if frame.joint.kind == "free" else frame.before.turning

    def turned(self, frame: Frame, vector: str) -> str:
        """A vector in the axes of a frame, in those of the world."""
        frame = frame.turning
        if frame is self.world:
            return vector
        is_plain = frame.joint.kind == "free" or (frame.rotation and np.array_equal(_clean(frame.axes), np.eye(3)))
        if frame not in self.matrices and is_plain and self.before(frame) is self.world:
            return f"turn({frame.rotation}, {vector})"
        return f"{self.matrix(frame)} * {vector}"

    def spot(self, frame: Frame) -> Spot:
        """The origin of a frame."""
        if frame not in self.spots:
            if frame.joint.kind == "free":
                found = Spot(frame.coordinate, frame, np.zeros(3))
            else:
                is_slide = frame.joint.kind == "slide"
                found = self.further(frame.before, frame.start, is_slide)
                if is_slide:
                    angle = (frame.coordinate, frame.axis)
                    found = Spot(
                        found.name, found.frame, found.vector - frame.joint.ref * frame.axis, (*found.moving, angle)
                    )
            self.spots[frame] = found
        return self.spots[frame]

    def further(self, frame: Frame, vector: Array, is_moving: bool = False) -> Spot:
        """The point of a frame at a vector from its origin; the vector is not zero if it moves."""
        origin, turning = self.spot(frame), frame.turning
        size = max(float(np.abs(origin.vector).max()), float(np.abs(vector).max()))
        if origin.frame is turning:
            return Spot(origin.name, turning, _clean(origin.vector + vector, size), origin.moving)
        if origin.moving or np.any(_clean(origin.vector, size)):
            if not (is_moving or np.any(_clean(vector, size))):
                return origin
            # The constant of a fixed point is no let.
            is_constant = origin.is_constant() and origin.frame is self.world
            name = _vector(origin.vector) if is_constant else self.let(frame.name, "p_", self.point(origin))
            origin = Spot(name, turning, np.zeros(3))
            self.spots[frame] = origin
        return Spot(origin.name, turning, _clean(vector), ())

    def point(self, spot: Spot) -> str:
        """A point in the axes of the world."""
        entries = []
        for place in range(3):
            parts = [_times(axis[place], name) for name, axis in spot.moving if axis[place] != 0.0]
            if spot.vector[place] != 0.0 or not parts:
                parts.append(_number(spot.vector[place]))
            entries.append(_sum(parts))
        if all(entry == "0" for entry in entries):
            return spot.name or "[0, 0, 0]"
        turned = self.turned(spot.frame, f"[{', '.join(entries)}]")
        return f"{spot.name} + {turned}" if spot.name else turned

    def rate(self, frame: Frame) -> str:
        """The angular velocity of a frame in its axes; empty if there is none."""
        frame = frame.turning
        if frame not in self.rates:
            if frame.joint.kind == "hinge":
                before, axis, angle = self.angle(frame)
                own, inner = _scaled(axis, f"dot({_plain(angle)})"), self.about(axis, angle)
            else:
                before, own, inner = self.before(frame), f"rate({frame.rotation})", ""
            outer = self.rate(before)
            if outer:
                inner = inner or self.own_matrix(frame)
                own = f"transpose({inner}) * {outer} + {own}"
            self.rates[frame] = self.let(frame.name, "w_", own)
        return self.rates[frame]

    # Clauses.

    def text(self) -> str:
        """The text, whose parameters become constants if a text can have no more of them."""
        draws = self.draws()
        self.check_inertia()
        inputs = self.inputs()
        kinetic, potential = self.energies(draws)
        springs, damping, armatures = self.springs()
        kinetic, potential = kinetic + armatures, potential + springs
        if not kinetic:
            raise ValueError("the joints turn masses on their axes: write moments of inertia")
        forces, constraints = self.forces(inputs), self.constraints(draws[0])
        is_constrained = bool(constraints) or any(frame.rotation for frame in self.frames)
        lines = [f"/// {_line(self.mechanism.name)}", f"struct {self.title} {{"]
        most = PARAMETERS_WITH_CONSTRAINTS if is_constrained else PARAMETERS
        kept = max(most - len(inputs), 0)
        for place, (name, value, meaning) in enumerate(self.parameters):
            if place == kept:
                lines.append(f"    // Constants: a text has at most {most} parameters.")
            is_kept = place < kept
            lines.append(f"    {'///' if is_kept else '//'} {_line(meaning)}")
            lines.append(f"    {'param' if is_kept else 'const'} {name} = {_number(value)};")
        for name, motor in inputs:
            lines += [f"    /// Input of {_line(motor.name)}.", f"    input {name} = 0;"]
        lines += [f"    {clause}" for clause in self.coordinates()]
        lines += [f"    fn {TURNS[name]};" for name in sorted(self.functions, reverse=True)]
        lines += [f"    {let}" for let in self.lets]
        lines += _long("L", [*kinetic, *(f"-{part}" for part in potential)])
        lines += _long("dissipation", damping) if damping else []
        lines += [f"    {clause}" for clause in (*forces, *constraints)]
        return "\n".join([*lines, "}", ""])

    def parameter(self, name: str, value: float, meaning: str) -> str:
        self.parameters.append((name, value, meaning))
        return name

    def energies(self, draws: list[Coordinates]) -> tuple[list[str], list[str]]:
        """The kinetic energy of the bodies, and their energy in the field of gravity."""
        kinetic, potential = [], []
        gravity = float(np.linalg.norm(self.mechanism.gravity))
        up = -self.mechanism.gravity / gravity if gravity else np.zeros(3)
        for frame, inertia in self.inertias.items():
            weight = self.weights[frame]
            moves = inertia.mass > 0.0 and _is_moved(frame, Place.point, inertia.center, draws)
            is_lifted = weight.mass != 0.0 and _is_moved(frame, lambda at, r: up @ at.point(r), weight.center, draws)
            mass = ""
            if moves or is_lifted:
                if is_lifted and not any(name == "g" for name, *_ in self.parameters):
                    self.parameter("g", gravity, "Gravity.")
                massive = ", ".join(body.name for body in self.carried(frame) if body.inertia.mass > 0.0)
                mass = self.parameter(self.names.new(frame.name, "m_"), inertia.mass, f"Mass of {massive}.")
            if moves:
                centre = self.centre(frame, inertia.center)
                kinetic.append(f"{mass} * dot({centre}) * dot({centre}) / 2")
            kinetic += self.rotational(frame, inertia)
            if is_lifted:
                share = [] if weight.mass == inertia.mass else [_number(weight.mass / inertia.mass)]
                potential.append(" * ".join([*share, mass, "g", self.height(self.centre(frame, weight.center), up)]))
        return kinetic, potential

    def rotational(self, frame: Frame, inertia: Inertia) -> list[str]:
        """The kinetic energy of a rotation about the centre of mass."""
        if not np.any(inertia.moments):
            return []
        fixed = self.spin(frame)
        if fixed is not None:
            axis, angle = fixed
            moment = float(axis @ inertia.moments @ axis)
            return [f"{self.let(frame.name, 'I_', _number(moment))} * dot({angle})^2 / 2"]
        rate = self.rate(frame)
        if not rate:
            return []
        moments = _clean((inertia.moments + inertia.moments.T) / 2.0, float(np.trace(inertia.moments)))
        return [f"{rate} * {self.let(frame.name, 'I_', _matrix(moments))} * {rate} / 2"]

    def springs(self) -> tuple[list[str], list[str], list[str]]:
        """The energy of springs, the dissipation of dampers, and the kinetic energy of armatures."""
        springs, damping, armatures = [], [], []
        for frame in self.frames:
            joint, q = frame.joint, frame.coordinate
            squares = [f"rate({frame.rotation}) * rate({frame.rotation})"] if frame.rotation else [f"dot({q})^2"]
            if joint.kind == "free":
                squares.insert(0, f"dot({q}) * dot({q})")
            if joint.armature:
                armatures += [f"{_number(joint.armature)} * {square} / 2" for square in squares]
            if joint.damping:
                name = self.parameter(self.names.new(joint.name, "c_"), joint.damping, f"Damping of {joint.name}.")
                damping += [f"{name} * {square} / 2" for square in squares]
            if joint.stiffness:
                name = self.parameter(self.names.new(joint.name, "k_"), joint.stiffness, f"Stiffness of {joint.name}.")
                springs.append(f"{name} * {_less(q, joint.spring_ref)}^2 / 2")
        return springs, damping, armatures

    def carried(self, frame: Frame) -> list[Body]:
        """The bodies that move with a frame."""
        pairs = zip(self.mechanism.bodies, self.bodies, strict=True)
        return [body for body, (of, _) in pairs if of is frame]

    def check_inertia(self) -> None:
        """Raises ValueError for a joint that moves no mass, and for a mass or a moment of inertia below zero."""
        for body in self.mechanism.bodies:
            if not np.isfinite([body.inertia.mass, *body.inertia.moments.flat]).all():
                raise ValueError(f"the inertia of the body {body.name!r} is too large: write it in other units")
            moments = np.linalg.eigvalsh(body.inertia.moments)
            if body.inertia.mass < 0.0 or moments[0] < -1e-12 * np.abs(moments).max():
                raise ValueError(
                    f"the body {body.name!r} has the mass {body.inertia.mass:.6g} and the principal moments of inertia "
                    f"{', '.join(f'{moment:.6g}' for moment in moments)}: they must not be negative"
                )
        moved = {frame for frame in self.frames if frame.joint.armature > 0.0}
        for frame, inertia in self.inertias.items():
            if inertia.mass > 0.0 or np.any(inertia.moments):
                moved.update(frame.line())
        for frame in self.frames:
            if frame in moved:
                continue
            unknown = ", ".join(body.without_inertia for body in self.carried(frame) if body.without_inertia)
            message = f"the joint {frame.joint.name!r} moves the body {frame.name!r}, which has no mass"
            if unknown:
                message += f": the inertia of {unknown} is not in the file"
            message += ". Write an inertial with its mass and its inertia"
            raise ValueError(message + (f"; {EXPLICIT}" if unknown else ""))

    def centre(self, frame: Frame, center: Array) -> str:
        key = (frame, *center)
        if key not in self.centres:
            self.centres[key] = self.let(frame.name, "x_", self.point(self.further(frame, center)))
        return self.centres[key]

    def height(self, centre: str, up: Array) -> str:
        up = _clean(up)
        if np.count_nonzero(up) == 1:
            at = int(np.argmax(np.abs(up)))
            return f"{centre}[{at}]" if up[at] > 0.0 else f"(-{centre}[{at}])"
        return f"({_vector(up)} * {centre})"

    def inputs(self) -> list[tuple[str, Motor]]:
        """The motors with the names of their inputs: those of joints are taken."""
        taken = self.names.taken
        motors = self.mechanism.motors
        return [(self.names.new(of.name, "u_" if _letters(of.name) in taken else ""), of) for of in motors]

    def forces(self, inputs: list[tuple[str, Motor]]) -> list[str]:
        on: dict[str, list[str]] = {}
        for name, motor in inputs:
            frame, gear = self.by_joint[motor.joint], np.array(motor.gear)
            if not frame.rotation:
                on.setdefault(f"force {frame.coordinate}", []).extend(_law(motor, name, frame.coordinate))
                continue
            sides = [(f"torque {frame.rotation}", gear[-3:]), (f"force {frame.coordinate}", gear[:-3])]
            for left, part in sides:
                if np.any(part):
                    on.setdefault(left, []).append(_scaled(part, name))
        return [f"{left} = {_sum(parts)};" for left, parts in on.items() if parts]

    def coordinates(self) -> list[str]:
        """Hinges that turn freely are angles; what depends on their turns has no period."""
        lines = []
        counted = {motor.joint for motor in self.mechanism.motors if motor.reads_length()}
        for constraint in self.mechanism.constraints:
            if isinstance(constraint, Coupling):
                counted.update(constraint.joints)
        for frame in self.frames:
            joint, q = frame.joint, frame.coordinate
            if joint.kind == "ball":
                lines.append(f"rotation {q};")
            elif joint.kind == "free":
                lines.append(f"coord {q}[3];")
                lines.append(f"rotation {frame.rotation};")
            elif joint.kind == "hinge" and not (joint.is_limited or joint.stiffness or joint.name in counted):
                lines.append(f"angle {q};")
            else:
                lines.append(f"coord {q};")
        return lines

    def start(self) -> dict[str, float]:
        """The coordinates in the configuration of the file."""
        found: dict[str, float] = {}

        def enter(name: str, values: Array) -> None:
            found.update({f"{name}[{index}]": value for index, value in enumerate(values.tolist())})

        for body, place in zip(self.mechanism.bodies, self.mechanism.places(), strict=True):
            for joint in body.joints:
                frame = self.by_joint[joint.name]
                if joint.kind == "free":
                    enter(frame.coordinate, place.origin)
                    enter(frame.rotation, quaternion_of(place.axes))
                elif joint.kind == "ball":
                    enter(frame.rotation, np.array([1.0, 0.0, 0.0, 0.0]))
                else:
                    found[frame.coordinate] = joint.ref
        return found

    def constraints(self, draw: Coordinates) -> list[str]:
        """The constraints, without entries that follow from those before: a planar loop has two."""
        lines = []
        known = np.empty((0, len(_slopes(lambda _: np.zeros(1), draw, self.frames))))
        values: list[Callable[[Coordinates], Array]] = []
        dropped: list[tuple[str, Callable[[Coordinates], Array]]] = []
        for constraint in self.mechanism.constraints:
            if isinstance(constraint, Coupling):
                lines.append(f"constraint {self.names.new(constraint.name)} = {self.coupling(constraint)};")
                continue
            gap, entries, value = self.gap(constraint)
            kept = []
            for place, row in enumerate(_slopes(value, draw, self.frames).T):
                trial = np.vstack([known, row])
                is_kept = np.linalg.matrix_rank(trial, tol=1e-9 * max(1.0, np.abs(trial).max())) == len(trial)
                entry = partial(lambda q, value, place: value(q)[place : place + 1], value=value, place=place)
                if is_kept:
                    known = trial
                    kept.append(entries[place])
                    values.append(entry)
                else:
                    dropped.append((constraint.name, entry))
            if kept:
                name = f"{constraint.name}_axes" if isinstance(constraint, Attitude) else constraint.name
                let = self.let(name, "gap_", gap)
                kept = [entry.replace("gap", let) for entry in kept]
                whole = f"[{', '.join(kept)}]" if len(kept) > 1 else kept[0]
                lines.append(f"constraint {self.names.new(name)} = {whole};")
        closed = self.closed(values) if dropped else None
        for name, entry in dropped:
            if closed is None:
                what = "which may not close"
            elif (apart := float(np.abs(entry(closed)).max())) > 1e-6:
                what = f"a gap of {apart:.3g} that no joint closes"
            else:
                continue
            self.mechanism.leave_out(f"a part of the constraint {name!r}, {what}")
        return lines

    def closed(self, values: list[Callable[[Coordinates], Array]]) -> Coordinates | None:
        """Coordinates near those of the file at which the values are zero; None if Newton's method finds none."""
        start = self.start()
        q: Coordinates = {}
        for frame in self.frames:
            names = [frame.coordinate]
            if frame.rotation:
                names = [f"{frame.coordinate}[{k}]" for k in range(3)] if frame.joint.kind == "free" else []
                names += [f"{frame.rotation}[{k}]" for k in range(4)]
            q[frame.joint.name] = np.array([start[name] for name in names], dtype=complex)
        for _ in range(NEWTON):
            gaps = np.concatenate([np.empty(0), *(value(q).real for value in values)])
            if not np.any(np.abs(gaps) > 1e-9):
                return q
            slopes = np.hstack([_slopes(value, q, self.frames) for value in values])
            change = np.linalg.lstsq(slopes.T, -gaps, rcond=1e-9)[0]
            for frame in self.frames:
                directions = _directions(frame, q[frame.joint.name])
                q[frame.joint.name] = q[frame.joint.name] + change[: len(directions)] @ directions
                change = change[len(directions) :]
                if frame.rotation:
                    q[frame.joint.name][-4:] /= np.linalg.norm(q[frame.joint.name][-4:])
        return None

    def coupling(self, constraint: Coupling) -> str:
        first, second = constraint.joints
        one = self.by_joint[first]
        parts = [one.coordinate, _number(-one.joint.ref - constraint.coefficients[0])]
        if second is not None:
            other = self.by_joint[second]
            base = _less(other.coordinate, other.joint.ref)
            for power, factor in enumerate(constraint.coefficients[1:], 1):
                if factor:
                    parts.append(_times(-factor, base if power == 1 else f"{base}^{power}"))
        return _sum(parts)

    def gap(self, constraint: Point | Attitude) -> tuple[str, list[str], Callable[[Coordinates], Array]]:
        """A vector or a matrix, its entries that stay zero, and these as a function."""
        sides = [(self.world, Place()) if body is None else self.bodies[body] for body in constraint.bodies]
        (one, at_one), (two, at_two) = sides
        if isinstance(constraint, Point):
            first, second = at_one.point(constraint.points[0]), at_two.point(constraint.points[1])
            left, right = self.point(self.further(one, first)), self.point(self.further(two, second))
            return (
                f"{left} - ({right})",
                ["gap[0]", "gap[1]", "gap[2]"],
                lambda q: one.place(q).point(first) - two.place(q).point(second),
            )
        axes = _clean(at_one.axes @ constraint.axes @ at_two.axes.T)
        left, right = self.matrix(one), self.matrix(two)
        factors = [f"transpose({left})"] * bool(left) + [right] * bool(right)
        if not np.array_equal(axes, np.eye(3)):
            factors.append(_matrix(axes.T))
        return (
            " * ".join(factors),
            ["gap[2][1] - gap[1][2]", "gap[0][2] - gap[2][0]", "gap[1][0] - gap[0][1]"],
            lambda q: _turned_apart(one.place(q).axes, two.place(q).axes, axes),
        )


def _slopes(value: Callable[[Coordinates], Array], q: Coordinates, frames: Sequence[Frame]) -> Array:
    """Derivatives of a vector with respect to velocities of frames, a row for each: of rotations to angular ones."""
    rows = []
    for frame in frames:
        at = q[frame.joint.name]
        for direction in _directions(frame, at):
            rows.append(np.imag(value({**q, frame.joint.name: at + 1j * STEP * direction})) / STEP)
    return np.array(rows)


def _directions(frame: Frame, at: Array) -> Array:
    """The rates of the coordinates of a frame at each of its unit velocities."""
    directions = np.eye(len(at))
    if frame.rotation:
        w, x, y, z = at[-4:].real
        turns = np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]]) / 2.0
        directions = np.vstack([directions[:-4], np.pad(turns, ((0, 0), (len(at) - 4, 0)))])
    return directions


def _is_moved(frame: Frame, value: Callable[[Place, Array], Array], point: Array, draws: list[Coordinates]) -> bool:
    """Whether a value of a point of a frame changes with a coordinate."""
    # One frame at a time, since the first one mostly decides.
    slopes = (_slopes(lambda q: value(frame.place(q), point), q, [one]) for q in draws for one in frame.line())
    return any(np.abs(found).max() > 1e-13 for found in slopes)


def _law(motor: Motor, name: str, q: str) -> list[str]:
    """The force of a motor. Its length is gear q, and its rate gear dot(q)."""
    gear = motor.gear[0]
    parts = []
    for law, factor in ((motor.gain, name), (motor.bias, "")):
        for number, (scale, motion) in zip(law, ((1.0, ""), (gear, q), (gear, f"dot({q})")), strict=True):
            product = " * ".join(word for word in (factor, motion) if word)
            amount = number * scale * gear
            if amount != 0.0:
                parts.append(_times(amount, product) if product else _number(amount))
    return parts


def _letters(name: str) -> str:
    # The language reads one form of letters that look alike.
    return "".join(c if f"_{c}".isidentifier() and c != "·" else "_" for c in unicodedata.normalize("NFKC", name))


def _line(text: str) -> str:
    """A text without ends of lines, for a comment."""
    return " ".join(text.split())


def _clean(values: Array, size: float = 1.0) -> Array:
    """Without the rounding errors of zeros and of ones."""
    values = np.where(np.abs(values) < 2e-15 * max(size, 1e-300), 0.0, values)
    return np.where(np.abs(np.abs(values) - 1.0) < 2e-15, np.sign(values), values)


def _number(value: float) -> str:
    if not math.isfinite(value):
        raise ValueError("its numbers are too large: write them in other units")
    text = f"{value:.15g}"
    return "0" if float(text) == 0.0 else text.removesuffix(".0")


def _vector(values: Iterable[float]) -> str:
    return f"[{', '.join(map(_number, values))}]"


def _matrix(rows: Array) -> str:
    return f"[{', '.join(map(_vector, rows))}]"


def _times(factor: float, name: str) -> str:
    if factor == 1.0:
        return name
    return f"-{name}" if factor == -1.0 else f"{_number(factor)} * {name}"


def _scaled(vector: Array, name: str) -> str:
    return f"[{', '.join(_times(entry, name) if entry else '0' for entry in vector)}]"


def _plain(angle: str) -> str:
    return angle.removeprefix("(").removesuffix(")")


def _less(q: str, value: float) -> str:
    """A coordinate less a number, as a factor."""
    return q if value == 0.0 else f"({_sum([q, _number(-value)])})"


def _sum(parts: Sequence[str]) -> str:
    """A sum with the signs of its parts."""
    text = parts[0] if parts else ""
    for part in parts[1:]:
        if part == "0":
            continue
        if text in ("", "0"):
            text = part
        else:
            text += f" - {part[1:]}" if part.startswith("-") else f" + {part}"
    return text


def _turned_apart(one: Array, two: Array, axes: Array) -> Array:
    """Zero if the second axes are at `axes` in the first ones: the sine of the angle between, along its axis, twice."""
    turn = one.T @ two @ axes.T
    return np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])


def _long(left: str, terms: Sequence[str]) -> list[str]:
    """A sum with a line for each term."""
    signs = (("- ", term[1:]) if term.startswith("-") else ("+ ", term) for term in terms[1:])
    lines = [f"    {left} = {terms[0]}", *(f"        {sign}{term}" for sign, term in signs)]
    lines[-1] += ";"
    return lines


TURNS = {
    "x": "about_x(a) = [[1, 0, 0], [0, cos(a), -sin(a)], [0, sin(a), cos(a)]]",
    "y": "about_y(a) = [[cos(a), 0, sin(a)], [0, 1, 0], [-sin(a), 0, cos(a)]]",
    "z": "about_z(a) = [[cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1]]",
    # n is a unit vector.
    "n": """about(n, a) = cos(a) * [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        + sin(a) * [[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]]
        + (1 - cos(a)) * [n[0] * n, n[1] * n, n[2] * n]""",
}
