"""Names of coordinates and parameters in Python.

Python's tokenizer normalizes names (NFKC): ϕ, ϵ and µ become φ, ε and μ. A parameter `lambda` becomes `lambda_`.
"""

from __future__ import annotations

import difflib
import keyword
import re
import unicodedata
from collections.abc import Iterable
from typing import Any


def spelled(name: str) -> str:
    """A declared name as Python spells it."""
    name = unicodedata.normalize("NFKC", name)
    return name + "_" if keyword.iskeyword(name) else name


def among(name: str, known: Iterable[str]) -> str:
    """The known name that is meant: Greek letters may be written out, `theta1` for `θ1`."""
    name = unicodedata.normalize("NFKC", name)
    return next((other for other in known if name in (other, _written_out(other))), name)


def _written_out(name: str) -> str:
    return "".join(map(_letter, name))


def _letter(letter: str) -> str:
    greek = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (\w+)", unicodedata.name(letter, ""))
    if greek is None:
        return letter
    return greek[2].lower() if greek[1] == "SMALL" else greek[2].capitalize()


def motion_name(name: str, coordinates: tuple[str, ...], system: str) -> tuple[bool, int]:
    """Whether "x" or "dot(x)" names a velocity, and the index of the coordinate.

    Raises KeyError for another name.
    """
    if not isinstance(name, str):
        raise TypeError(f'give the name of a coordinate of {system}, such as "{coordinates[0]}", not {name!r}')
    inner = re.fullmatch(r"\s*dot\((.*)\)\s*", name)
    found = among((inner[1] if inner else name).strip(), coordinates)
    if found not in coordinates:
        known = ", ".join([*coordinates, *(f"dot({name})" for name in coordinates)])
        hint = _velocity(name, coordinates) or _entry(found, coordinates) or meant(found, coordinates)
        raise KeyError(f"{system} has no coordinate {found!r}{hint}; it has {known}")
    return inner is not None, coordinates.index(found)


def is_plain(text: str) -> bool:
    """Whether a text is a name or an entry, and no other expression."""
    return re.fullmatch(r"[\w.' ]+(\[\w*\])?", text) is not None


def _velocity(name: str, coordinates: tuple[str, ...]) -> str:
    """The velocity that a name of other tools means: `vx`, `x_dot`, `xdot`, `dx`, `ẋ`."""
    plain = unicodedata.normalize("NFD", name).replace("\u0307", "")
    inner = re.fullmatch(r"(?:v_?|d)(.+)|(.+?)_?(?:dot|')", name)
    has_dot = plain != unicodedata.normalize("NFD", name)
    found = among(plain if has_dot else (inner[1] or inner[2]) if inner else "", coordinates)
    return f' (the velocity of {found} is "dot({found})")' if found in coordinates else ""


def _entry(name: str, coordinates: tuple[str, ...]) -> str:
    """The entries of an array of coordinates of which a name gives none: `x`, `x[20]`."""
    array = name.partition("[")[0]
    entries = [other for other in coordinates if other.startswith(array + "[")]
    return f" (the entries of {array} are {entries[0]} to {entries[-1]})" if entries else ""


def meant(name: str, known: Iterable[str]) -> str:
    """` (did you mean …?)` if a known name is close."""
    close = difflib.get_close_matches(name, list(known), n=1)
    return f" (did you mean {close[0]!r}?)" if close else ""


def unknowns(parameters: str | Iterable[str], cls: Any) -> dict[str, tuple[bool, int]]:
    """Whether each unknown is a start value, and its index: in (q, v), or in the numbers of the system."""
    names = [parameters] if isinstance(parameters, str) else list(parameters)
    found: dict[str, tuple[bool, int]] = {}
    for name in names:
        found |= unknowns_of(name, cls)
    if not found:
        raise ValueError("give at least one unknown")
    return found


def unknowns_of(name: str, cls: Any) -> dict[str, tuple[bool, int]]:
    """The unknowns of a name; an array of parameters has several."""
    if not isinstance(name, str):
        raise TypeError(f"unknowns must be names, not {name!r}")
    arrays = {whole: cls._parameter(whole).entries for whole in cls.parameters}
    known = {whole: {entry: (False, index) for entry, index in entries.items()} for whole, entries in arrays.items()}
    known |= {entry: {entry: of} for entries in list(known.values()) for entry, of in entries.items()}
    starts = [*cls.coordinates, *(f"dot({x})" for x in cls.coordinates)]
    known |= {start: {start: (True, index)} for index, start in enumerate(starts)}
    found = among(name, known)
    if found not in known:
        raise ValueError(
            f"{cls.__name__} has no parameter or start value {name!r}{meant(name, known)}"
            f"{': give several as a list' if ',' in name else ''}; "
            f"it has {', '.join([*cls.parameters, *starts])}"
        )
    return known[found]
