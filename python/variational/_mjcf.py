"""Reads MJCF, the files of MuJoCo."""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

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
    about_z_to,
    numbers,
    of_quaternion,
    single,
    symmetric,
    unit,
)  # fmt: skip

Element = ElementTree.Element
Attributes = dict[str, str]
Joined = tuple[tuple[int | None, int | None], tuple[Array, Array], Array]
"""Two bodies, the points of them that are one, and the axes of the second in those of the first."""

ACTUATORS = {
    "general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion", "plugin"
}  # fmt: skip
LISTS = {"size", "gear", "gainprm", "biasprm", "damping", "stiffness"}
"""Attributes that may have fewer numbers than those of their default, and then have its last ones."""
SECTIONS = {
    "compiler", "option", "size", "visual", "statistic", "default", "custom", "extension", "asset", "worldbody",
    "contact", "deformable", "equality", "tendon", "actuator", "sensor", "keyframe"
}  # fmt: skip
OF_A_BODY = {"body", "inertial", "joint", "freejoint", "geom", "site", "camera", "light", "plugin"}
JOINT = {
    "name", "class", "type", "group", "pos", "axis", "springdamper", "limited", "actuatorfrclimited", "solreflimit",
    "solimplimit", "solreffriction", "solimpfriction", "stiffness", "range", "actuatorfrcrange", "actuatorgravcomp",
    "margin", "ref", "springref", "armature", "damping", "frictionloss", "user"
}  # fmt: skip
"""Attributes of joints. Others, and elements that are in none of these sets, are listed as unknown."""
WRITTEN_OUT = {"composite", "flexcomp", "replicate", "attach"}
TURNS = {"quat": 4, "axisangle": 4, "xyaxes": 6, "zaxis": 3, "euler": 3}


def read_mjcf(root: Element, folder: Path) -> Mechanism:
    """The mechanism of the element `mujoco`; files that it includes are relative to the folder."""
    return _Reader(root, folder).mechanism


def _included(parent: Element, folder: Path, own: Path, files: set[Path]) -> None:
    """Replaces each `include` by the elements of its file, which is relative to the main file, or to its own. As in
    MuJoCo, a file is included once."""
    children = list(parent)
    for child in children:
        parent.remove(child)
    for child in children:
        if child.tag != "include":
            _included(child, folder, own, files)
            parent.append(child)
            continue
        name = child.get("file")
        if name is None:
            raise ValueError("an include has no file: write <include file=…/>")
        path = next((base / name for base in (folder, own) if (base / name).is_file()), None)
        if path is None:
            raise FileNotFoundError(f"the included file {name} is not in {folder.resolve()}")
        if path.resolve() in files:
            raise ValueError(f"the file {name} is included twice: remove one of its includes")
        files.add(path.resolve())
        try:
            inner = ElementTree.parse(path).getroot()
        except ElementTree.ParseError as error:
            raise ValueError(f"{path} is not XML: {error}") from None
        _included(inner, folder, path.parent, files)
        parent.extend(inner)


class _Reader:
    def __init__(self, root: Element, folder: Path):
        root = copy.deepcopy(root)
        _included(root, folder, folder, set())
        self.root = root
        self.mechanism = Mechanism(root.get("model", "Robot"))
        self.compiler: Attributes = {}
        for element in root.findall("compiler"):
            self.compiler |= element.attrib
        if self.compiler.get("coordinate", "local") != "local":
            raise ValueError('the compiler has coordinate="global": write the file with local coordinates')
        in_degrees = _word(self.compiler, "angle", ("degree", "radian"), "the compiler") == "degree"
        self.radian = math.pi / 180.0 if in_degrees else 1.0
        self.sequence = self.compiler.get("eulerseq", "xyz")
        if not re.fullmatch("[xyzXYZ]{3}", self.sequence):
            raise ValueError(
                f'the compiler has eulerseq="{self.sequence}": write three of the letters x, y, z, X, Y, Z'
            )
        self.classes: dict[str, dict[str, Attributes]] = {"main": {}}
        for element in root.findall("default"):
            self._default(element, "main", self.classes["main"])
        self.names: dict[str, int] = {}
        # Names that bodies and joints without one do not get.
        self.given = {found.get("name") for found in root.iter() if found.tag in ("body", "joint", "freejoint")}
        self.sites: dict[str, tuple[int | None, Place]] = {}
        self.flags: dict[str, str] = {}
        self.limited: list[str] = []
        self.clamped: list[str] = []
        self.rubbing: list[str] = []
        self.groups_off: set[float] = set()
        self.has_contact = False
        self._options()
        for world in root.findall("worldbody"):
            for child, place, cls in self._children(world, Place(), None):
                self._world(child, place, cls)
        self._bounds()
        self._actuators()
        self._equalities()
        self._others()

    # Attributes.

    def _default(self, element: Element, name: str, inherited: dict[str, Attributes]) -> None:
        own = {tag: dict(attributes) for tag, attributes in inherited.items()}
        for child in element:
            if child.tag != "default":
                own[_kind(child.tag)] = _over(child.tag, own, child.attrib)
        for servo in ("position", "velocity"):
            if _is_servo(own.get("general", {}), servo):
                own[servo] = own["general"]
        self.classes[name] = own
        for child in element.findall("default"):
            inner = child.get("class")
            if inner is None:
                raise ValueError("a default inside another one has no name: write <default class=…>")
            if inner in self.classes:
                raise ValueError(f"two defaults have the class {inner!r}")
            self._default(child, inner, own)

    def _attributes(self, element: Element, cls: str | None, kind: str = "") -> Attributes:
        name = element.get("class") or cls or "main"
        if name not in self.classes:
            known = ", ".join(self.classes)
            raise ValueError(f"{_called(element)} has the class {name!r}, which no default declares; there are {known}")
        return _over(element.tag, self.classes[name], element.attrib, kind)

    def _place(self, of: Element | Attributes, name: str) -> Place:
        pos = numbers(of, "pos", 3, name)
        return Place(np.zeros(3) if pos is None else np.array(pos), self._axes(of, name))

    def _axes(self, of: Element | Attributes, name: str) -> Array:
        given = [word for word in TURNS if of.get(word) is not None]
        if len(given) > 1:
            raise ValueError(f"{name} has {' and '.join(given)}: write one of them")
        if not given:
            return np.eye(3)
        values = np.array(numbers(of, given[0], TURNS[given[0]], name))
        if given == ["quat"]:
            return of_quaternion(values, name)
        if given == ["axisangle"]:
            return about(unit(values[:3], f"the axis of {name}"), values[3] * self.radian)
        if given == ["zaxis"]:
            return about_z_to(unit(values, f"zaxis of {name}"))
        if given == ["xyaxes"]:
            x = unit(values[:3], f"xyaxes of {name}")
            y = unit(values[3:] - (values[3:] @ x) * x, f"xyaxes of {name}")
            return np.column_stack([x, y, np.cross(x, y)])
        found = np.eye(3)
        for letter, angle in zip(self.sequence, values, strict=True):
            turn = about(np.eye(3)["xyz".index(letter.lower())], angle * self.radian)
            # Small letters turn about the moving axes, capital letters about the fixed ones.
            found = found @ turn if letter.islower() else turn @ found
        return found

    # Bodies.

    def _options(self) -> None:
        for option in self.root.findall("option"):
            gravity = numbers(option, "gravity", 3, "the option")
            if gravity is not None:
                self.mechanism.gravity = np.array(gravity)
            if any(single(option, name, "the option") for name in ("density", "viscosity")):
                self.mechanism.leave_out("forces of the fluid")
            self.groups_off.update(numbers(option, "actuatorgroupdisable", range(32), "the option") or [])
            for flag in option.findall("flag"):
                self.flags |= flag.attrib
        if self.flags.get("gravity") == "disable":
            self.mechanism.gravity = np.zeros(3)

    def _is_on(self, *flags: str) -> bool:
        return all(self.flags.get(flag) != "disable" for flag in flags)

    def _children(self, element: Element, place: Place, cls: str | None) -> Iterator[tuple[Element, Place, str | None]]:
        """The elements of a body, with the place and the class of the frames around them."""
        for child in element:
            if child.tag in WRITTEN_OUT:
                raise ValueError(f"{_called(child)} has to be written out: mujoco.mj_saveLastXML writes such a file")
            if child.tag == "frame":
                inner = place.then(self._place(child, _called(child)))
                yield from self._children(child, inner, child.get("childclass") or cls)
            elif child.tag in OF_A_BODY:
                yield child, place, cls
            else:
                self.mechanism.leave_out(f"the element <{child.tag}>, which is unknown")

    def _world(self, child: Element, place: Place, cls: str | None) -> None:
        if child.tag == "body":
            self._body(child, None, place, cls)
        elif child.tag == "site":
            self._site(child, None, place, cls)
        elif child.tag == "geom":
            self._collides(self._attributes(child, cls))
        elif child.tag in ("joint", "freejoint", "inertial"):
            raise ValueError(f"the world has {_called(child)}, and does not move: put it into a body")

    def _unnamed(self, wanted: str) -> str:
        """A name for a body or a joint that has none."""
        found, count = wanted, 1
        while found in self.given:
            count += 1
            found = f"{wanted}_{count}"
        self.given.add(found)
        return found

    def _body(self, element: Element, parent: int | None, frame: Place, cls: str | None) -> None:
        index = len(self.mechanism.bodies)
        name = element.get("name") or self._unnamed(f"body{index + 1}")
        of = f"the body {name!r}"
        cls = element.get("childclass") or cls
        body = Body(name, parent, frame.then(self._place(element, of)))
        body.carried = single(element, "gravcomp", of)
        if element.get("mocap") == "true":
            self.mechanism.leave_out(f"the motion of {of}, which rests in the world")
        self.mechanism.bodies.append(body)
        if name in self.names:
            raise ValueError(f"two bodies have the name {name!r}")
        self.names[name] = index
        children = list(self._children(element, Place(), cls))
        joints = [found for found in children if found[0].tag in ("joint", "freejoint")]
        for place, found in enumerate(joints, 1):
            unnamed = f"{name}_joint" + (str(place) if len(joints) > 1 else "")
            body.joints.append(self._joint(*found, unnamed))
        if any(joint.kind == "free" for joint in body.joints) and (self._moves(parent) or len(joints) > 1):
            raise ValueError(
                f"{of} has a free joint, which must be alone: neither {name!r} nor a body above has others"
            )
        self._mass(body, element, children)
        for child, place, inner in children:
            if child.tag == "body":
                self._body(child, index, place, inner)
            elif child.tag == "site":
                self._site(child, index, place, inner)
            elif child.tag == "plugin":
                self.mechanism.leave_out(f"a plugin of {of}")

    def _moves(self, body: int | None) -> bool:
        bodies = self.mechanism.bodies
        return body is not None and (bool(bodies[body].joints) or self._moves(bodies[body].parent))

    def _joint(self, element: Element, frame: Place, cls: str | None, unnamed: str) -> Joint:
        name = element.get("name") or self._unnamed(unnamed)
        of = f"the joint {name!r}"
        if element.tag == "freejoint":
            return Joint(name, "free")
        given = self._attributes(element, cls)
        for attribute in sorted(element.attrib.keys() - JOINT):
            self.mechanism.leave_out(f"{attribute} of {of}, which is unknown")

        def value(attribute: str, unit: float = 1.0) -> float:
            found = numbers(given, attribute, range(1, 4), of) or [0.0]
            if np.any(found[1:]):
                self.mechanism.leave_out(f"the nonlinear {attribute} of {of}")
            return found[0] * unit

        kind = _word(given, "type", ("hinge", "slide", "ball", "free"), of)
        radian = self.radian if kind == "hinge" else 1.0
        joint = Joint(name, kind, damping=value("damping"), armature=value("armature"), stiffness=value("stiffness"))
        axis = numbers(given, "axis", 3, of) or [0.0, 0.0, 1.0]
        joint.axis = frame.axes @ unit(axis, f"the axis of {of}")
        joint.pos = frame.point(np.array(numbers(given, "pos", 3, of) or [0.0, 0.0, 0.0]))
        joint.ref, joint.spring_ref = value("ref", radian), value("springref", radian)
        if not self._is_on("passive", "spring"):
            joint.stiffness = 0.0
        if not self._is_on("passive", "damper"):
            joint.damping = 0.0
        if "springdamper" in given:
            self.mechanism.leave_out(f"springdamper of {of}")
        if "actuatorfrcrange" in given:
            self.mechanism.leave_out(f"the limits of the forces of motors on {of}")
        if joint.armature < 0.0:
            raise ValueError(f"{of} has a negative armature")
        if kind in ("ball", "free") and joint.stiffness:
            self.mechanism.leave_out(f"the stiffness of {of}, which is of the type {kind}")
            joint.stiffness = 0.0
        joint.is_limited = given.get("limited", "auto") == "true" or (
            "range" in given and given.get("limited") != "false"
        )
        if joint.is_limited:
            self.limited.append(name)
        if value("frictionloss"):
            self.rubbing.append(name)
        return joint

    def _site(self, element: Element, body: int | None, frame: Place, cls: str | None) -> None:
        if "name" in element.attrib:
            given = self._attributes(element, cls)
            of = _called(element)
            place = self._place(given, of) if "fromto" not in given else self._fromto(given, of)[0]
            self.sites[element.attrib["name"]] = (body, frame.then(place))

    # Inertia.

    def _mass(self, body: Body, element: Element, children: list[tuple[Element, Place, str | None]]) -> None:
        way = _word(self.compiler, "inertiafromgeom", ("auto", "true", "false"), "the compiler")
        stated = element.find("inertial")
        geoms = Inertia()
        unknown: list[str] = []
        is_from_geoms = way == "true" or (way == "auto" and stated is None)
        for child, place, cls in children:
            if child.tag != "geom":
                continue
            given = self._attributes(child, cls)
            self._collides(given)
            first, last = numbers(self.compiler, "inertiagrouprange", 2, "the compiler") or (0.0, 5.0)
            if is_from_geoms and first <= _whole(given, "group", 0, _called(child)) <= last:
                found = self._geom(given, child, body.name)
                if found is None:
                    unknown.append(_called(child))
                elif found.mass > 0.0:
                    geoms += found.moved(place)
        if is_from_geoms:
            body.inertia = geoms
            if unknown:
                body.without_inertia = ", ".join(unknown)
        elif stated is not None:
            body.inertia = self._stated(stated, f"the inertial of the body {body.name!r}")

    def _stated(self, element: Element, of: str) -> Inertia:
        mass = numbers(element, "mass", 1, of)
        if mass is None:
            raise ValueError(f"{of} has no mass")
        if mass[0] < 0.0:
            raise ValueError(f"{of} has a negative mass")
        diagonal, full = numbers(element, "diaginertia", 3, of), numbers(element, "fullinertia", 6, of)
        if full is not None and any(word in element.attrib for word in ("diaginertia", *TURNS)):
            raise ValueError(f"{of} has fullinertia, which is in the axes of the body: write no other inertia or axes")
        moments = np.diag(diagonal) if diagonal is not None else np.zeros((3, 3))
        if full is not None:
            moments = symmetric(*full)
        return Inertia(mass[0], np.zeros(3), moments).moved(self._place(element, of))

    def _geom(self, given: Attributes, element: Element, body: str) -> Inertia | None:
        """The inertia of a geom, in the axes of its body; None if it has one that the file does not state."""
        of = f"{_called(element)} of the body {body!r}"
        kind = given.get("type", "sphere")
        mass = numbers(given, "mass", 1, of)
        density = single(given, "density", of, 1000.0)
        if kind in ("plane", "hfield") or (mass[0] if mass is not None else density) == 0.0:
            return Inertia()
        if kind in ("mesh", "sdf") or "mesh" in given:
            return None
        if kind not in SOLIDS:
            raise ValueError(f'{of} has the type "{kind}": known are {", ".join(SOLIDS)}, plane and mesh')
        if given.get("shellinertia") == "true":
            self.mechanism.leave_out(f"shellinertia of {of}, which is solid")
        size = [*(numbers(given, "size", range(1, 4), of) or []), 0.0, 0.0, 0.0][:3]
        place = self._place({name: text for name, text in given.items() if name != "fromto"}, of)
        if "fromto" in given:
            if kind == "sphere":
                raise ValueError(f"{of} has fromto, and is a sphere: write its type, such as capsule")
            place, half = self._fromto(given, of)
            size = [size[0], half, 0.0] if kind in ("capsule", "cylinder") else [size[0], size[0], half]
        volume, moments = SOLIDS[kind](*size)
        if volume <= 0.0 or min(size) < 0.0:
            raise ValueError(f"{of} has no volume: write its size")
        amount = mass[0] if mass is not None else density * volume
        if amount < 0.0:
            raise ValueError(f"{of} has a negative mass")
        return Inertia(amount, np.zeros(3), amount * np.diag(moments)).moved(place)

    def _fromto(self, given: Attributes, of: str) -> tuple[Place, float]:
        """The place of a solid along a segment, and half its length."""
        ends = np.array(numbers(given, "fromto", 6, of))
        along = ends[:3] - ends[3:]
        return Place((ends[:3] + ends[3:]) / 2.0, about_z_to(unit(along, f"fromto of {of}"))), float(
            np.linalg.norm(along)
        ) / 2.0

    def _bounds(self) -> None:
        """The changes of masses and moments that the file requests."""
        least_mass, least_moment, total = (
            single(self.compiler, name, "the compiler") for name in ("boundmass", "boundinertia", "settotalmass")
        )
        is_balanced = self.compiler.get("balanceinertia") == "true"
        bodies = [body for body in self.mechanism.bodies if not body.without_inertia]
        for body in bodies:
            inertia = body.inertia
            inertia.mass = max(inertia.mass, least_mass)
            if least_moment or is_balanced:
                moments, axes = np.linalg.eigh(inertia.moments)
                if is_balanced and moments[0] + moments[1] < moments[2]:
                    moments[:] = moments.mean()
                inertia.moments = axes @ np.diag(np.maximum(moments, least_moment)) @ axes.T
        now = sum(body.inertia.mass for body in bodies)
        if total > 0.0 and now > 0.0:
            factor = total / now
            for body in bodies:
                body.inertia = body.inertia.scaled(factor)

    # Motors and constraints.

    def _actuators(self) -> None:
        joints = self.mechanism.joints()
        for section in self.root.findall("actuator"):
            for element in section:
                name = element.get("name") or f"{element.get('joint', 'actuator')}_{element.tag}"
                of = f"the actuator {name!r}"
                given = self._attributes(element, None)
                reason = _left_out(element, given, of)
                is_off = not self._is_on("actuation") or _whole(given, "group", 0, of) in self.groups_off
                if reason or is_off:
                    self.mechanism.leave_out(f"{of} ({reason or 'disabled'})")
                    continue
                joint = joints.get(given["joint"])
                if joint is None:
                    raise ValueError(f"{of} moves the joint {given['joint']!r}, which is not there")
                gear = [*(numbers(given, "gear", range(1, 7), of) or [1.0]), *[0.0] * 5]
                gain, bias = _law(given, of)
                count = {"ball": 3, "free": 6}.get(joint.kind, 1)
                motor = Motor(name, joint.name, tuple(gear[:count]), gain, bias)
                if not (np.any(motor.gear) and np.any((*gain, *bias))):
                    self.mechanism.leave_out(f"{of} (its force is zero)")
                    continue
                if count > 1 and (gain[1:] != (0.0, 0.0) or bias != (0.0, 0.0, 0.0)):
                    self.mechanism.leave_out(
                        f"{of} (its force depends on the motion of a joint of the type {joint.kind})"
                    )
                    continue
                self.mechanism.motors.append(motor)
                for what in ("damping", "armature"):
                    if np.any(numbers(given, what, range(1, 4), of)):
                        self.mechanism.leave_out(f"{what} of {of}")
                if any(f"{of}range" in given or given.get(f"{of}limited") == "true" for of in ("ctrl", "force", "act")):
                    self.clamped.append(name)

    def _equalities(self) -> None:
        self.places = self.mechanism.places()
        for section in self.root.findall("equality"):
            for index, element in enumerate(section, 1):
                name = element.get("name") or f"{element.tag}{index}"
                of = f"the {element.tag} {name!r}"
                given = self._attributes(element, None, "equality")
                if element.tag not in ("connect", "weld", "joint"):
                    self.mechanism.leave_out(f"the equality {name!r} ({element.tag})")
                elif given.get("active") == "false" or not self._is_on("constraint", "equality"):
                    self.mechanism.leave_out(f"{of}, which is not active")
                elif element.tag == "joint":
                    self.mechanism.constraints.append(self._coupling(given, name, of))
                else:
                    self._connect(given, name, of, element.tag == "weld")

    def _coupling(self, given: Attributes, name: str, of: str) -> Coupling:
        joints = self.mechanism.joints()
        pair = (given.get("joint1"), given.get("joint2"))
        for joint in pair:
            if (joint is not None and joint not in joints) or joint is pair[0] is None:
                raise ValueError(f"{of} names the joint {joint!r}, which is not there")
            if joint is not None and joints[joint].kind not in ("hinge", "slide"):
                raise ValueError(f"{of} names the joint {joint!r}: it must be a hinge or a slide")
        polynomial = numbers(given, "polycoef", range(1, 6), of) or [0.0]
        return Coupling(name, pair, tuple(polynomial if len(polynomial) > 1 else [*polynomial, 1.0]))

    def _connect(self, given: Attributes, name: str, of: str, is_weld: bool) -> None:
        """Joins a point of two bodies, and for a weld their axes."""
        if "site1" in given:
            bodies, points, axes = self._at_sites(given, of)
        else:
            bodies, points, axes = self._at_bodies(given, of, is_weld)
        self.mechanism.constraints.append(Point(name, bodies, points))
        if is_weld:
            self.mechanism.constraints.append(Attitude(name, bodies, axes))

    def _at_sites(self, given: Attributes, of: str) -> Joined:
        for site in (given["site1"], given.get("site2")):
            if site not in self.sites:
                raise ValueError(f"{of} names the site {site!r}, which is not there")
        (first, at_first), (second, at_second) = (self.sites[given[site]] for site in ("site1", "site2"))
        return (first, second), (at_first.origin, at_second.origin), at_first.axes @ at_second.axes.T

    def _at_bodies(self, given: Attributes, of: str, is_weld: bool) -> Joined:
        first, second = (self._body_of(given.get(key), of) for key in ("body1", "body2"))
        at_first, at_second = (Place() if body is None else self.places[body] for body in (first, second))
        relative = at_first.inverse().then(at_second)
        anchor = np.array(numbers(given, "anchor", 3, of) or [0.0, 0.0, 0.0])
        if not is_weld:
            return (first, second), (anchor, relative.inverse().point(anchor)), relative.axes
        pose = numbers(given, "relpose", 7, of)
        if pose is not None and np.any(pose[3:]):
            relative = Place(np.array(pose[:3]), of_quaternion(pose[3:], of))
        return (first, second), (relative.point(anchor), anchor), relative.axes

    def _body_of(self, name: str | None, of: str) -> int | None:
        if name in (None, "world"):
            return None
        if name not in self.names:
            raise ValueError(f"{of} names the body {name!r}, which is not there")
        return self.names[name]

    # What is left out.

    def _collides(self, given: Attributes) -> None:
        if any(_whole(given, mask, 1, "a geom") for mask in ("contype", "conaffinity")) and self._is_on(
            "contact", "constraint"
        ):
            self.has_contact = True

    def _others(self) -> None:
        for section in self.root:
            if section.tag not in SECTIONS:
                self.mechanism.leave_out(f"the element <{section.tag}>, which is unknown")
        for tag in ("tendon", "deformable"):
            for section in self.root.findall(tag):
                for element in section:
                    self.mechanism.leave_out(f"the {tag} {element.get('name') or element.tag!r}")
        for body in self.mechanism.bodies:
            if body.without_inertia:
                self.mechanism.leave_out(f"the inertia of {body.without_inertia} of the body {body.name!r}")
        for what, names in (
            ("limits of", self.limited),
            ("limits of the motors", self.clamped),
            ("friction of", self.rubbing),
        ):
            if names:
                self.mechanism.leave_out(f"{what} {', '.join(names)}")
        if self.has_contact:
            self.mechanism.leave_out("contact")


def _kind(tag: str) -> str:
    """Actuators of all kinds share their defaults."""
    return "general" if tag in ACTUATORS else tag


def _called(element: Element) -> str:
    name = element.get("name") or element.get("file")
    return f"the {element.tag} {name!r}" if name else f"a {element.tag}"


def _over(tag: str, defaults: dict[str, Attributes], own: Attributes, kind: str = "") -> Attributes:
    """The attributes of an element of a class; those of an actuator become those of `general`."""
    default = defaults.get(kind or _kind(tag), {})
    found = {**default, **own}
    for word in LISTS & default.keys() & own.keys():
        found[word] = " ".join([*own[word].split(), *default[word].split()[len(own[word].split()) :]])
    if any(word in own for word in TURNS):
        found = {word: text for word, text in found.items() if word in own or word not in TURNS}
    if _kind(tag) != "general":
        return found
    return found | {"kind": tag} | _servo(tag, default if _is_servo(default, tag) else defaults.get(tag, {}), own)


def _is_servo(default: Attributes, tag: str) -> bool:
    """Whether a position or velocity servo inherits these numbers; if not, it has those of an outer class."""
    return default.get("kind") in (tag, "general") and default.get("gaintype", "fixed") == "fixed"


def _servo(tag: str, default: Attributes, own: Attributes) -> Attributes:
    """The law of an actuator in the attributes of `general`."""
    if tag == "general":
        return {}
    law = {"dyntype": "none", "gaintype": "fixed", "biastype": "none", "gainprm": "1 0 0", "biasprm": "0 0 0"}
    if tag not in ("position", "velocity"):
        return law if tag == "motor" else {"dyntype": tag}
    of = f"the {tag} {own['name']!r}" if "name" in own else f"a {tag}"
    before, after = _law(default | {"biastype": "affine"}, of)

    law["biastype"] = "affine"
    if tag == "velocity":
        kv = single(own, "kv", of, before[0])
        return law | {"gainprm": f"{kv} 0 0", "biasprm": f"0 0 {-kv}"}
    kp = single(own, "kp", of, before[0])
    # As in MuJoCo, a positive number is a ratio of the damping.
    rate = -single(own, "kv", of, -single(own, "dampratio", of, after[2]))
    law["dyntype"] = "filterexact" if single(own, "timeconst", of) else default.get("dyntype", "none")
    return law | {"gainprm": f"{kp} 0 0", "biasprm": f"0 {-kp} {rate}"}


def _law(given: Attributes, of: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Gain and bias."""
    gain, bias = (
        [*(numbers(given, name, range(1, 11), of) or usual), 0.0, 0.0][:3]
        for name, usual in (("gainprm", [1.0]), ("biasprm", [0.0]))
    )
    if given.get("gaintype", "fixed") == "fixed":
        gain[1:] = [0.0, 0.0]
    if given.get("biastype", "none") == "none":
        bias = [0.0, 0.0, 0.0]
    return tuple(gain), tuple(bias)


def _left_out(element: Element, given: Attributes, of: str) -> str:
    """Why an actuator is left out; an empty text if it is not."""
    if element.tag not in ("general", "motor", "position", "velocity"):
        return element.tag
    if "joint" not in given:
        return next(
            (f"it moves a {word}" for word in ("tendon", "site", "body", "jointinparent") if word in given), "a crank"
        )
    for name, kinds in (("dyntype", ("none",)), ("gaintype", ("fixed", "affine")), ("biastype", ("none", "affine"))):
        kind = given.get(name, kinds[0])
        if kind not in kinds:
            return "timeconst" if kind == "filterexact" else f"{name} {kind}"
    gain, bias = _law(given, of)
    if bias[2] > 0.0 and gain[0] == -bias[1]:
        return "dampratio"
    return "delay" if single(given, "delay", of) else ""


def _word(given: Attributes, name: str, allowed: tuple[str, ...], of: str) -> str:
    """A word out of some, of which the first is the default."""
    found = given.get(name, allowed[0])
    if found not in allowed:
        raise ValueError(f'{of} has the {name} "{found}": write {", ".join(allowed[:-1])} or {allowed[-1]}')
    return found


def _whole(given: Attributes, name: str, usual: int, of: str) -> int:
    found = single(given, name, of, usual)
    if found != int(found):
        raise ValueError(f'{of} has {name}="{given[name]}": write a whole number')
    return int(found)


def _sphere(r: float, *_: float) -> tuple[float, list[float]]:
    return 4.0 / 3.0 * math.pi * r**3, [0.4 * r * r] * 3


def _capsule(r: float, half: float, _: float) -> tuple[float, list[float]]:
    balls, cylinder = 4.0 / 3.0 * math.pi * r**3, 2.0 * math.pi * r * r * half
    across = cylinder * (r * r / 4.0 + half * half / 3.0) + balls * (0.4 * r * r + half * half + 0.75 * half * r)
    along = cylinder * r * r / 2.0 + balls * 0.4 * r * r
    volume = balls + cylinder
    return volume, [across / volume, across / volume, along / volume] if volume else [0.0] * 3


def _cylinder(r: float, half: float, _: float) -> tuple[float, list[float]]:
    across = r * r / 4.0 + half * half / 3.0
    return 2.0 * math.pi * r * r * half, [across, across, r * r / 2.0]


def _box(a: float, b: float, c: float) -> tuple[float, list[float]]:
    return 8.0 * a * b * c, [(b * b + c * c) / 3.0, (a * a + c * c) / 3.0, (a * a + b * b) / 3.0]


def _ellipsoid(a: float, b: float, c: float) -> tuple[float, list[float]]:
    return 4.0 / 3.0 * math.pi * a * b * c, [(b * b + c * c) / 5.0, (a * a + c * c) / 5.0, (a * a + b * b) / 5.0]


SOLIDS = {"sphere": _sphere, "capsule": _capsule, "cylinder": _cylinder, "box": _box, "ellipsoid": _ellipsoid}
"""Volume, and moments of inertia of the mass 1, by the numbers of `size`."""
