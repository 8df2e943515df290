"""Systems as co-simulation units of FMI 3.0.

In: a system, the description of a run, its start. Out: a zip file with the library that cargo builds of them, and its
description in XML. The crate vi-fmi has the C functions. Both number the variables by one list: the time, parameters
and inputs, initial values, outputs.
"""

from __future__ import annotations

import platform
import re
import sys
import uuid
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as xml

from ._arrays import Array
from ._compile import LIBRARY, unit
from ._errors import _invalid
from ._request import Request

if TYPE_CHECKING:
    from ._system import System

_OS = {"win32": "windows", "darwin": "darwin"}.get(sys.platform, "linux")
_MACHINE = {"amd64": "x86_64", "arm64": "aarch64", "i386": "x86", "i686": "x86"}

_WORDS = {
    "fixed": "fixed_2",
    "suzuki-4": "fixed",
    "kahan-li-6": "fixed",
    "kahan-li-8": "fixed",
    "splitting-4": "splitting",
    "splitting-6": "splitting",
}
"""Methods whose name in Rust's macro is another one."""


def write(system: System, path: Path, request: Request, t: float, q: Array, v: Array, verbose: bool) -> Path:
    """Writes the unit of a run of the system from this start.

    Raises CompileError, InvalidInput for steps back in time, and FileNotFoundError for a path without a folder.
    """
    for name, value in (("h", request.h), ("dtau", request.dtau)):
        if value is not None and value < 0.0:
            raise _invalid(name, "positive for an FMU", value)
    if not path.absolute().parent.is_dir():
        raise FileNotFoundError(f"there is no folder {path.parent}")
    definition = system._to_compile()
    last = _last(system, request, t, q, v)
    token = str(uuid.uuid5(uuid.NAMESPACE_OID, definition + last))
    library = unit(definition, last.replace(_TOKEN, token), verbose)
    name = re.sub(r"\W", "_", system._kind.name, flags=re.ASCII)
    machine = platform.machine().lower()
    folder = f"binaries/{_MACHINE.get(machine, machine)}-{_OS}"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("modelDescription.xml", _description(system, name, token, request, t, q, v))
        file.write(library, f"{folder}/{name}{LIBRARY}")
        file.writestr("resources/definition.txt", definition)
    return path


_TOKEN = "the token of this unit"


def _last(system: System, request: Request, t: float, q: Array, v: Array) -> str:
    """The call of the macro that defines the unit, without its token."""
    method, stages, is_transformed = system._kind.integrator(request)
    word = "transformed" if is_transformed else _WORDS.get(method, method)
    built = f"{word} {stages}" if stages else word
    options = {
        "stages": f"Some({stages})" if stages else "None",
        "shift": _shift(request),
        "fallback": str(request.fallback).lower(),
        "dtau": _option(request.dtau),
        "tolerance": _option(request.tolerance),
    }
    fields = ", ".join(f"{name}: {value}" for name, value in options.items())
    h = request.h or request.dtau
    step = "f64::NAN" if h is None else _number(h)
    start = f"PhasePoint {{ t: {_number(t)}, q: vec!{_numbers(q)}, v: vec!{_numbers(v)} }}"
    method = f'<Method as Named>::named("{method}").unwrap()'
    return (
        f"vi_fmi::unit!({system._kind.name}, {{ {built} }}, {_numbers(system._values)}, {{\n"
        "    use vi_fmi::vi_erased::plan::{Method, Named, PhasePoint, Plan, Shift};\n"
        f"    Plan {{ {fields}, ..Plan::new({method}, {step}, {start}) }}\n"
        f'}}, "{_TOKEN}");\n'
    )


def _number(value: float) -> str:
    return repr(float(value))


def _numbers(values: Array) -> str:
    return f"[{', '.join(map(_number, values))}]"


def _option(value: float | None) -> str:
    return "None" if value is None else f"Some({_number(value)})"


def _shift(request: Request) -> str:
    if request.shift_from is not None:
        return f"Some(Shift::Over({_number(request.shift_from)}))"
    return "None" if request.shift is None else f"Some(Shift::Of({_number(request.shift)}))"


def _description(system: System, name: str, token: str, request: Request, t: float, q: Array, v: Array) -> bytes:
    """The description of the unit."""
    from . import __version__

    about = {
        "fmiVersion": "3.0",
        "modelName": system._kind.name,
        "instantiationToken": token,
        "generationTool": f"variational {__version__}",
        **_about(system._kind.about),
    }
    root = xml.Element("fmiModelDescription", about)
    step = {} if request.h is None else {"stepSize": _number(request.h)}
    is_fixed = step and request.method not in ("adaptive", "energy")
    fixed = {"fixedInternalStepSize": step["stepSize"]} if is_fixed else {}
    can = ("canHandleVariableCommunicationStepSize", "canGetAndSetFMUState", "canSerializeFMUState")
    xml.SubElement(root, "CoSimulation", {"modelIdentifier": name, **dict.fromkeys(can, "true"), **fixed})
    xml.SubElement(xml.SubElement(root, "LogCategories"), "Category", {"name": "logStatusError"})
    xml.SubElement(root, "DefaultExperiment", {"startTime": _number(t), **step})
    variables = xml.SubElement(root, "ModelVariables")
    structure = xml.SubElement(root, "ModelStructure")
    outputs = []
    for number, attributes in enumerate(_variables(system, q, v)):
        reference = {"valueReference": str(number)}
        xml.SubElement(variables, "Float64", {**reference, **attributes})
        if attributes["causality"] == "output":
            outputs.append(reference)
    # Between two steps outputs follow from the state: inputs act from the next step on.
    for reference in outputs:
        xml.SubElement(structure, "Output", {**reference, "dependencies": ""})
    for reference in outputs:
        xml.SubElement(structure, "InitialUnknown", reference)
    xml.indent(root)
    return xml.tostring(root, encoding="utf-8", xml_declaration=True)


def _about(text: str) -> dict[str, str]:
    """The attribute of a documentation, if there is one."""
    line = " ".join(text.split())
    return {"description": line} if line else {}


def _variables(system: System, q: Array, v: Array) -> Iterator[dict[str, str]]:
    """The attributes of each variable, in the order of their numbers. A name that two variables have gets a `_`, but
    not that of a parameter or of a coordinate."""
    kind = system._kind
    inputs = set(kind.inputs)
    names = {name for name, _, _ in kind.parameters} | set(kind.coordinates)

    def distinct(name: str) -> str:
        while name in names:
            name += "_"
        names.add(name)
        return name

    yield {"name": distinct("time"), "causality": "independent", "variability": "continuous"}
    for index, (name, _, about) in enumerate(kind.parameters):
        role = ("input", "continuous") if index in inputs else ("parameter", "tunable")
        yield {
            "name": name,
            "causality": role[0],
            "variability": role[1],
            "start": _number(system._values[index]),
            **_about(about),
        }
    for values, label, what in ((q, "{}(0)", "Initial value"), (v, "dot({})(0)", "Initial velocity")):
        for name, value in zip(kind.coordinates, values, strict=True):
            yield {
                "name": distinct(label.format(name)),
                "causality": "parameter",
                "variability": "fixed",
                "start": _number(value),
                "description": f"{what} of {name}",
            }
    outputs = [
        *((name, f"Coordinate {name}") for name in kind.coordinates),
        *((distinct(f"dot({name})"), f"Velocity of {name}") for name in kind.coordinates),
        *((distinct(f"p_{name}"), f"Momentum of {name}") for name in kind.coordinates),
        *((distinct(f"Λ_{name}"), f"Reaction of the constraint {name}") for name in kind.constraints),
        (distinct("energy"), "Energy H"),
    ]
    output = {"causality": "output", "variability": "continuous", "initial": "calculated"}
    for name, about in outputs:
        yield {"name": name, **output, "description": about}
