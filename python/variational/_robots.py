"""Systems from the files of robots: MJCF of MuJoCo and URDF of ROS."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ._arrays import Array, fixed
from ._mechanism import Mechanism
from ._mechanism_text import Writer
from ._mjcf import read_mjcf
from ._urdf import read_urdf

MOST = 32
"""The most coordinates and constraints of a text."""


class Robot(str):
    """The text of the system of a robot, for `vi.System` and `vi.compile`.

    Coordinates have the names of joints, inputs those of motors.
    """

    __module__ = "variational"

    coordinates: tuple[str, ...]
    """Names of the coordinates."""
    start: Array
    """The coordinates in the configuration that the file describes."""
    left_out: tuple[str, ...]
    """What the file has and the system does not."""

    def __new__(cls, text: str, start: dict[str, float], left_out: tuple[str, ...]) -> Robot:
        robot = super().__new__(cls, text)
        robot.coordinates = tuple(start)
        robot.start = fixed(np.array(list(start.values())))
        robot.left_out = left_out
        return robot

    @property
    def text(self) -> str:
        """The text as a plain str."""
        return str.__str__(self)

    def __getnewargs__(self) -> Any:
        return (self.text, dict(zip(self.coordinates, self.start.tolist(), strict=True)), self.left_out)


def from_mjcf(file: str | os.PathLike[str]) -> Robot:
    """The text of the system that a file of MuJoCo describes, or a text of XML.

    >>> Arm = vi.System(vi.from_mjcf("arm.xml"))

    It has the bodies with their inertias, also those of geoms; joints with springs, damping and armature; gravity;
    the equalities connect, weld and joint as constraints; and motors as inputs. A warning lists what the system leaves
    out, such as contact, limits, friction and tendons.

    Raises ValueError for a file that cannot be read, and for a body that moves without a mass.
    """
    root, folder, called = _opened(file, "mujoco", "from_urdf reads the element robot")
    return _robot(lambda: read_mjcf(root, folder), called)


def from_urdf(file: str | os.PathLike[str], *, floating: bool = False) -> Robot:
    """The text of the system that a URDF describes, a file or a text of XML.

    Its root link rests in the world; with `floating` it moves freely, by the joint `NAME_pose`. Joints that mimic
    others become constraints. A warning lists what the system leaves out. See `from_mjcf`.
    """
    root, _, called = _opened(file, "robot", "from_mjcf reads the element mujoco")
    return _robot(lambda: read_urdf(root, floating), called)


def _opened(file: str | os.PathLike[str], tag: str, other: str) -> tuple[ElementTree.Element, Path, str]:
    """The root of a file, its folder, and what messages call it."""
    if isinstance(file, str):
        file = file.strip("\ufeff \t\r\n")
    is_text = isinstance(file, str) and file.startswith("<")
    called = "the text" if is_text else os.fspath(file)
    try:
        if is_text:
            root, folder = ElementTree.fromstring(str(file)), Path()
        else:
            root, folder = ElementTree.parse(file).getroot(), Path(file).parent
    except FileNotFoundError:
        raise FileNotFoundError(f"there is no file {called} in {Path().resolve()}") from None
    except (ElementTree.ParseError, LookupError) as error:
        raise ValueError(f"{called} is not XML: {error}") from None
    if any("xacro" in element.tag for element in root.iter()):
        raise ValueError(f"{called} has macros: write it out by `xacro FILE > robot.urdf`")
    if root.tag != tag:
        raise ValueError(f"{called} has the root element <{root.tag}>, not <{tag}>: {other}")
    return root, folder, called


def _robot(read: Any, called: str) -> Robot:
    try:
        # Numbers that are too large are found when they are written.
        with np.errstate(over="ignore", invalid="ignore"):
            mechanism: Mechanism = read()
        if not mechanism.joints():
            raise ValueError("no body moves, because no joint does")
        writer = Writer(mechanism)
        text = writer.text()
    except RecursionError:
        raise ValueError(f"{called}: its elements are inside each other too often") from None
    except OverflowError:
        raise ValueError(f"{called}: its numbers are too large: write them in other units") from None
    except ValueError as error:
        raise ValueError(f"{called}: {error}") from None
    start = writer.start()
    notes = []
    if mechanism.left_out:
        notes.append(f"the system leaves out {'; '.join(mechanism.left_out)}")
    if len(start) > MOST:
        notes.append(f"it has {len(start)} coordinates, and vi.System takes at most {MOST}: use vi.compile")
    if notes:
        warnings.warn(f"{called}: {'. '.join(notes)}", stacklevel=3)
    return Robot(text, start, tuple(mechanism.left_out))
