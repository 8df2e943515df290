"""Systems from text without a compiler of Rust."""

from __future__ import annotations

import contextlib
import copyreg
import threading
import weakref
from pathlib import Path
from typing import Any

from . import _core
from ._binding import class_of
from ._compile import TABLE, CompileError, compile
from ._system import System, SystemType


class _OfText(SystemType):
    """The type of these classes. A pickle of one holds its text."""


def of_text(
    definition: str,
    or_compiled: bool = False,
    module: str = "variational.of_text",
    files: tuple[tuple[str, str], ...] | None = None,
    dropped: tuple[str, ...] = (),
) -> type[System]:
    """The class of the system that a text declares. Equal texts have one class. With `or_compiled` a system that has
    to be compiled is compiled. `files` are paths and texts of the files of its tables; otherwise they are read.
    `dropped` are constraints that follow from the others.

    Raises CompileError.
    """
    if not isinstance(definition, str):
        raise TypeError(
            f"the definition must be a text, not {type(definition).__name__}: System('struct Spring {{ coord x; L = …; }}')"
        )
    if files is None:
        files = files_of(definition)
    key = (definition, files, dropped)
    cls: Any = _known.get(key)
    if cls is None:
        try:
            kind = _core.of_text(definition, list(files), list(dropped))
        except ValueError as mistake:
            raise CompileError(str(mistake)) from None
        except NotImplementedError as reason:
            if or_compiled:
                return compile(definition)
            raise CompileError(str(reason)) from None
        cls = class_of(kind, module, _OfText, dropped)
        cls.definition = definition
        cls._text = (definition, False, module, files, dropped)
        # Another thread may have made it meanwhile.
        with _lock:
            cls = _known.setdefault(key, cls)
    return cls


def files_of(definition: str) -> tuple[tuple[str, str], ...]:
    """Path and text of each file of a table that can be read. The compiler names the others."""
    found = []
    for path in dict.fromkeys(match[2] for match in TABLE.finditer(definition)):
        with contextlib.suppress(OSError, UnicodeDecodeError):
            if Path(path).is_file() and Path(path).stat().st_size <= _LARGEST:
                found.append((path, Path(path).read_text(encoding="utf-8")))
    return tuple(found)


_LARGEST = 16_000_000
"""Largest file of a table, in bytes: that of the compiler."""


_lock = threading.Lock()
# A class that nobody uses any more is dropped.
_known: weakref.WeakValueDictionary[Any, type[System]] = weakref.WeakValueDictionary()


def _pickled(cls: Any) -> Any:
    # A subclass is known by its name. Tables are pickled by their values.
    return (of_text, cls._text) if "_text" in vars(cls) else cls.__qualname__


copyreg.pickle(_OfText, _pickled)
