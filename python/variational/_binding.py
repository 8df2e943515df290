"""Python classes for the systems of a compiled module."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np

from ._names import spelled
from ._system import Parameter, System

CONTRACT = 7
"""The version of the interface to compiled modules."""


def _bind(
    module: Any, namespace: dict[str, Any] | None = None, name: str | None = None, metaclass: type = type
) -> list[str]:
    """Adds the classes of its systems to a compiled module, or to another namespace; returns their names.

    Raises ImportError for a module of another version.
    """
    if getattr(module, "_contract", None) != CONTRACT:
        raise ImportError(
            f"{module.__name__} was built for another version of variational: build it again, "
            "or install the version that it was built for"
        )
    name = name or module.__name__
    # maturin makes a package `mine` around a module `mine.mine` that has no Python files.
    outer, _, inner = name.rpartition(".")
    name = outer if outer == inner and outer else name
    target = vars(module) if namespace is None else namespace
    classes = [class_of(kind, name, metaclass) for kind in module._kinds]
    target.update({cls.__name__: cls for cls in classes})
    if namespace is None:
        module.__all__ = [cls.__name__ for cls in classes]
    return sorted(cls.__name__ for cls in classes)


def class_of(kind: Any, module: str, metaclass: type = type, dropped: tuple[str, ...] = ()) -> type[System]:
    """The class of a system, of which these constraints are dropped."""
    fields = _parameters(kind)
    signature = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=_type(field))
        for name, field in fields.items()
    ]
    coordinates = _distinct(kind.coordinates)
    members = {
        "__slots__": (),
        "__doc__": _documentation(kind, coordinates, fields, dropped),
        "__module__": module,
        "__signature__": inspect.Signature(signature),
        "_kind": kind,
        "_defaults": np.array([default for _, default, _ in kind.parameters]),
        "coordinates": coordinates,
        "angles": _declared("angle", kind.spaces, coordinates),
        "rotations": tuple(
            name.removesuffix("[0]") for name in _declared("rotation", kind.spaces, coordinates) if name.endswith("[0]")
        ),
        "constraints": tuple(spelled(name) for name in kind.constraints),
        "dropped": tuple(spelled(name) for name in dropped),
        "parameters": tuple(fields),
        "inputs": tuple(name for name, field in fields.items() if field.start in kind.inputs),
        "integrators": tuple(kind.integrators),
        "_methods": tuple(dict.fromkeys(method for method, *_ in kind.integrators)),
        "definition": kind.definition,
        **fields,
    }
    return metaclass(kind.name, (System,), members)


_RESERVED = {"self", "_compiled", "_defaults", "_kind", "_source", "_text", "_values"}
"""Names that a class has for itself."""


def _parameters(kind: Any) -> dict[str, Parameter]:
    """The parameters by their names in Python. `m[0]`, `m[1]`, … are one array."""
    groups: dict[str, list[tuple[int, float, str, str]]] = {}
    for index, (name, default, about) in enumerate(kind.parameters):
        name, _, indices = name.partition("[")
        groups.setdefault(name, []).append((index, default, about, indices))
    fields: dict[str, Parameter] = {}
    for name, entries in groups.items():
        start, default, about, is_array = entries[0]
        # The last entry of a matrix is `K[1][2]`: two rows of three.
        shape = tuple(int(index) + 1 for index in entries[-1][3].rstrip("]").split("][") if index)
        defaults = tuple(default for _, default, _, _ in entries)
        field = spelled(name)
        while hasattr(System, field) or field in fields or field in _RESERVED:
            field += "_"
        fields[field] = Parameter(field, start, shape, defaults if is_array else default, about.strip())
    return fields


def _distinct(names: list[str]) -> tuple[str, ...]:
    """Names as Python spells them. Two that it spells alike differ by a `_`."""
    found: list[str] = []
    for name in map(spelled, names):
        while name in found:
            name += "_"
        found.append(name)
    return tuple(found)


def _declared(word: str, spaces: list[str], coordinates: tuple[str, ...]) -> tuple[str, ...]:
    """The coordinates that a clause with this word declares."""
    return tuple(name for name, space in zip(coordinates, spaces, strict=True) if space == word)


def _documentation(
    kind: Any, coordinates: tuple[str, ...], fields: dict[str, Parameter], dropped: tuple[str, ...]
) -> str:
    about = inspect.cleandoc(kind.about) or f"The system {kind.name}."
    lines = [about, "", f"Coordinates: {', '.join(coordinates)}."]
    if kind.constraints:
        lines += ["", f"Constraints: {', '.join(kind.constraints)}."]
    if dropped:
        lines += ["", f"Dropped, since they follow from the others: {', '.join(dropped)}."]
    if fields:
        lines += ["", "Parameters", "----------"]
    for name, field in fields.items():
        kind_of = "float" if field.length is None else f"array of {' by '.join(map(str, field.shape))}"
        lines.append(f"{name} : {kind_of}, default {field.default}")
        about = inspect.cleandoc(field.__doc__ or "")
        if about != f"Parameter {name}.":
            lines += [f"    {line}".rstrip() for line in about.splitlines()]
    return "\n".join(lines)


def _type(field: Parameter) -> Any:
    return float if field.length is None else tuple[float, ...]
