"""Systems from text without a compiler of Rust."""

from __future__ import annotations

import copyreg
import inspect
import threading
import weakref
from typing import Any

from . import _core
from ._binding import class_of
from ._compile import CompileError, compile
from ._system import System, SystemType


class _OfText(SystemType):
    """The type of these classes. A pickle of one holds its text."""


def of_text(definition: str, or_compiled: bool = False, module: str = "variational.of_text") -> type[System]:
    """The class of the system that a text declares. Equal texts have one class. With `or_compiled` a system that has
    to be compiled is compiled.

    Raises CompileError.
    """
    if not isinstance(definition, str):
        raise TypeError(f"the definition must be a text, not {type(definition).__name__}")
    cls: Any = _known.get(definition)
    if cls is None:
        try:
            kind = _core.of_text(definition)
        except ValueError as mistake:
            raise CompileError(str(mistake)) from None
        except NotImplementedError as reason:
            if or_compiled:
                return compile(definition)
            raise CompileError(str(reason)) from None
        cls = class_of(kind, module, _OfText)
        cls.definition = inspect.cleandoc(definition)
        cls._text = definition
        # Another thread may have made it meanwhile.
        with _lock:
            cls = _known.setdefault(definition, cls)
    return cls


_lock = threading.Lock()
# A class that nobody uses any more is dropped.
_known: weakref.WeakValueDictionary[str, type[System]] = weakref.WeakValueDictionary()


def _pickled(cls: Any) -> Any:
    # A subclass is known by its name.
    return (of_text, (cls._text,)) if "_text" in vars(cls) else cls.__qualname__


copyreg.pickle(_OfText, _pickled)
