"""The notebook cell `%%lagrangian`."""

from __future__ import annotations

import sys
from typing import Any


def load_ipython_extension(shell: Any) -> None:
    """`%load_ext variational` adds the cell `%%lagrangian`: a definition, whose class then has its name.

    It is that of `System`. With the methods to build on the first line, `%%lagrangian fixed; gauss 4, 8`, it is that of
    `compile`, as it is for a text that has to be compiled.
    """

    def lagrangian(line: str, cell: str) -> None:
        from ._compile import CompileError, compile
        from ._text import of_text

        try:
            cls = compile(cell, methods=line.strip()) if line.strip() else of_text(cell, or_compiled=True)
        except CompileError as error:
            # A traceback would hide the line of the mistake.
            print(f"CompileError: {error}", file=sys.stderr)
            return
        shell.user_ns[cls.__name__] = cls

    shell.register_magic_function(lagrangian, "cell")
