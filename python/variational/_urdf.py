"""Reads URDF, the robot files of ROS."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from ._mechanism import (
    Body,
    Coupling,
    Inertia,
    Joint,
    Mechanism,
    Place,
    about,
    about_z_to,
    numbers,
    single,
    symmetric,
    unit,
)  # fmt: skip

Element = ElementTree.Element

KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


def read_urdf(root: Element, floating: bool) -> Mechanism:
    """The mechanism of the element `robot`. Its root link rests in the world, or moves freely."""
    found = Mechanism(root.get("name", "Robot"))
    links: dict[str, Element] = {}
    for link in root.findall("link"):
        if _name(link) in links:
            raise ValueError(f"two links have the name {_name(link)!r}")
        links[_name(link)] = link
    if not links:
        raise ValueError("the robot has no link")
    joints = root.findall("joint")
    below: dict[str, list[Element]] = {name: [] for name in links}
    children: set[str] = set()
    for joint in joints:
        parent, child = _ends(joint, links)
        if child in children:
            raise ValueError(f"the link {child!r} is the child of two joints: a URDF is a tree")
        below[parent].append(joint)
        children.add(child)
    roots = [name for name in links if name not in children]
    if len(roots) != 1:
        raise ValueError(f"a robot has one link without a parent, not {', '.join(roots) or 'none'}")

    index: dict[str, int] = {}
    # Links whose joints are still to be followed.
    open_links = [(roots[0], None, Place(), [Joint(f"{roots[0]}_pose", "free")] if floating else [])]
    while open_links:
        name, parent, place, own = open_links.pop()
        index[name] = len(found.bodies)
        found.bodies.append(Body(name, parent, place, own, _inertia(links[name], name)))
        for joint in reversed(below[name]):
            _, child = _ends(joint, links)
            at = _origin(joint.find("origin"), f"the joint {_name(joint)!r}")
            made = _joints(joint, found)
            if made and made[0].kind == "free":
                if name != roots[0] or floating:
                    raise ValueError(f"the joint {_name(joint)!r} is floating: it must hang from the root link at rest")
                at = found.bodies[index[name]].place.then(at)
            open_links.append((child, None if made and made[0].kind == "free" else index[name], at, made))
    if len(index) != len(links):
        raise ValueError(f"the links {', '.join(name for name in links if name not in index)} form a loop")
    _mimics(joints, found)
    _others(root, joints, found)
    return found


def _name(element: Element) -> str:
    name = element.get("name")
    if name is None:
        raise ValueError(f"a {element.tag} has no name")
    return name


def _ends(joint: Element, links: dict[str, Element]) -> tuple[str, str]:
    ends = []
    for tag in ("parent", "child"):
        end = joint.find(tag)
        link = None if end is None else end.get("link")
        if link not in links:
            raise ValueError(f"the {tag} of the joint {_name(joint)!r} is the link {link!r}, which is not there")
        ends.append(link)
    return ends[0], ends[1]


def _origin(element: Element | None, of: str) -> Place:
    if element is None:
        return Place()
    xyz, rpy = numbers(element, "xyz", 3, of) or [0.0] * 3, numbers(element, "rpy", 3, of) or [0.0] * 3
    x, y, z = np.eye(3)
    return Place(np.array(xyz), about(z, rpy[2]) @ about(y, rpy[1]) @ about(x, rpy[0]))


def _inertia(link: Element, name: str) -> Inertia:
    element = link.find("inertial")
    if element is None:
        return Inertia()
    of = f"the inertial of the link {name!r}"
    mass, moments = element.find("mass"), element.find("inertia")
    value = None if mass is None else numbers(mass, "value", 1, of)
    if value is None:
        raise ValueError(f"{of} has no mass")
    keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    entries = [0.0 if moments is None else single(moments, key, of) for key in keys]
    own = Inertia(value[0], np.zeros(3), symmetric(*entries))
    return own.moved(_origin(element.find("origin"), of))


def _joints(element: Element, found: Mechanism) -> list[Joint]:
    name, kind = _name(element), element.get("type")
    of = f"the joint {name!r}"
    if kind not in KINDS:
        raise ValueError(f'{of} has the type "{kind}": the types are {", ".join(KINDS)}')
    if kind == "fixed":
        return []
    dynamics = element.find("dynamics")
    damping = 0.0 if dynamics is None else single(dynamics, "damping", of)
    if kind == "floating":
        return [Joint(name, "free", damping=damping)]
    given = element.find("axis")
    axis = unit((None if given is None else numbers(given, "xyz", 3, of)) or [1.0, 0.0, 0.0], f"the axis of {of}")
    if kind == "planar":
        x, y, _ = about_z_to(axis).T
        kinds = (("x", "slide", x), ("y", "slide", y), ("angle", "hinge", axis))
        return [Joint(f"{name}_{end}", kind, axis, damping=damping) for end, kind, axis in kinds]
    joint = Joint(name, "slide" if kind == "prismatic" else "hinge", axis, damping=damping)
    joint.is_limited = kind == "revolute"
    return [joint]


def _mimics(joints: list[Element], found: Mechanism) -> None:
    known = found.joints()
    for joint in joints:
        mimic = joint.find("mimic")
        if mimic is None:
            continue
        name, of = _name(joint), f"the mimic of the joint {_name(joint)!r}"
        other = mimic.get("joint")
        if other not in known or name not in known:
            raise ValueError(f"{of} names the joint {other!r}, which is not there or does not move")
        polynomial = single(mimic, "offset", of), single(mimic, "multiplier", of, 1.0)
        found.constraints.append(Coupling(f"{name}_mimic", (name, other), polynomial))


def _others(root: Element, joints: list[Element], found: Mechanism) -> None:
    limited = [
        _name(joint) for joint in joints if joint.find("limit") is not None and joint.get("type") != "continuous"
    ]
    rubbing = []
    for joint in joints:
        dynamics = joint.find("dynamics")
        if dynamics is not None and single(dynamics, "friction", f"the joint {_name(joint)!r}"):
            rubbing.append(_name(joint))
    for what, names in (("limits", limited), ("friction", rubbing)):
        if names:
            found.leave_out(f"{what} of {', '.join(names)}")
    if root.findall("transmission"):
        found.leave_out("transmissions")
    if root.findall("mujoco"):
        found.leave_out("settings for MuJoCo")
    if any(link.find("collision") is not None for link in root.findall("link")):
        found.leave_out("contact")
